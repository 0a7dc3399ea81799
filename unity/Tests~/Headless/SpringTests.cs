using System;
using System.Collections.Generic;
using NUnit.Framework;
using UnityEngine;
using VRC.SDK3.Dynamics.PhysBone.Components;

namespace SuperDeform.Editor.Tests
{
    /// <summary>Springs start no nearer to a collider, and no deeper in it, than they were: it yields to those that name it, by a fifth at most.</summary>
    [TestFixture]
    public class SpringTests
    {
        const HumanBodyBones Carrier = HumanBodyBones.Hips;
        ConversionFigure figure;
        Transform root, end, left;

        /// <summary>
        /// A tail that hangs from a foot; its end comes nearer to the hips, whose collider it just does not touch.
        /// </summary>
        void Begin()
        {
            figure = ComponentTableTests.Probed();
            root = new GameObject("TailRoot").transform;
            root.SetParent(figure.Bones[HumanBodyBones.LeftUpperLeg], false);
            end = new GameObject("TailEnd").transform;
            end.SetParent(root, false);
            end.position = new Vector3(-0.1f, 0.5f, 0);
            left = new GameObject("LeftOut").transform;
            left.SetParent(root, false);
            left.position = figure.Bones[Carrier].position + new Vector3(0, -0.3f, 0);
        }

        const float Ball = 0.02f;

        float Reach(Vector3 point)
        {
            return Vector3.Distance(figure.Bones[Carrier].position, point) - Ball - 0.002f;
        }

        /// <summary>Converts with a sphere around the hips' joint.</summary>
        /// <param name="add">Adds collider and spring; gives the collider.</param>
        /// <returns>The radius that came out over the one that no spring has touched.</returns>
        float Yield(Func<float, Component> add, Func<Component, float> radius, Vector3 to, float ball = Ball, bool yields = true)
        {
            Component collider = add(Reach(to));
            float free = 0, room = 0;
            // Until the spring touches: below 0 for a large one, which is inside from the start.
            float apart = Ball + 0.002f - ball;
            ComponentTableTests.Ask(map =>
            {
                Transform hips = figure.Bones[Carrier];
                free = Reach(to) * map.Scale(hips, Vector3.zero);
                // Model space is the world: the root stands at its origin.
                Vector3 from = hips.position + Sum(map, hips), at = end.position + Sum(map, end);
                room = Vector3.Distance(from, at) - (ball + apart) * map.Scale(end, Vector3.zero);
            });
            ConversionResult result = Converter.Convert(figure.Root, ComponentTableTests.Settings(), null);
            ComponentTableTests.Ask(null);
            var made = (Component)result.Prefab.GetComponentInChildren(collider.GetType(), true);
            float found = radius(made);
            if (yields)
            {
                Assert.That(room, Is.LessThan(0.99f * free), "the spring would start nearer");
                Assert.AreEqual(Math.Max(room, 0.8f * free), found, 1e-4, "it is as far, or has yielded a fifth");
                Assert.That(result.Findings.Exists(finding => finding.Key == "collider_yields"));
            }
            return found / free;
        }

        // Nothing turns or scales in this figure: local shifts add up.
        static Vector3 Sum(PointMap map, Transform joint)
        {
            Vector3 sum = Vector3.zero;
            for (Transform at = joint; at != null; at = at.parent) sum += map.Shift(at);
            return sum;
        }

        Component PhysBone(float reach, Action<VRCPhysBone> more = null)
        {
            var collider = figure.Bones[Carrier].gameObject.AddComponent<VRCPhysBoneCollider>();
            collider.shapeType = 0;
            collider.radius = reach;
            collider.position = Vector3.zero;
            var bone = figure.Root.AddComponent<VRCPhysBone>();
            bone.rootTransform = root;
            bone.radius = Ball;
            bone.endpointPosition = Vector3.zero;
            bone.ignoreTransforms.Add(left);
            bone.colliders.Add(collider);
            if (more != null) more(bone);
            return collider;
        }

        static float Radius(Component collider)
        {
            return ((VRCPhysBoneCollider)collider).radius;
        }

        [Test]
        public void a_collider_of_phys_bones_yields_to_those_that_name_it()
        {
            Begin();
            Assert.That(Yield(reach => PhysBone(reach), Radius, end.position), Is.LessThan(0.99f));
            Begin();
            Assert.AreEqual(1, Yield(reach => PhysBone(reach, bone => bone.colliders.Clear()), Radius, end.position, yields: false), 1e-4, "nobody names it");
            Begin();
            Assert.AreEqual(1, Yield(reach => PhysBone(reach, bone => bone.ignoreTransforms.Add(end)), Radius, end.position, yields: false), 1e-4, "the end is left out");
            Begin();
            Yield(reach => PhysBone(reach, bone => bone.radius = 3 * Ball), Radius, end.position, 3 * Ball);
        }

        [Test]
        public void the_end_point_of_a_phys_bone_is_the_end_of_its_last_bone()
        {
            Begin();
            Vector3 tip = end.position;
            Vector3 local = root.InverseTransformPoint(tip);
            UnityEngine.Object.DestroyImmediate(left.gameObject);
            UnityEngine.Object.DestroyImmediate(end.gameObject);
            float yielded = Yield(reach => PhysBone(reach, bone =>
            {
                bone.ignoreTransforms.Clear();
                bone.endpointPosition = local;
            }), Radius, tip, yields: false);
            Assert.That(yielded, Is.InRange(0.8f - 1e-4f, 0.99f));
        }

        /// <summary>Radii are measured in the object that holds the springs, which is larger here.</summary>
        Component Dynamic(float reach, float ball)
        {
            var collider = figure.Bones[Carrier].gameObject.AddComponent<DynamicBoneCollider>();
            collider.m_Center = Vector3.zero;
            collider.m_Radius = reach;
            collider.m_Radius2 = collider.m_Height = 0;
            Transform holder = new GameObject("Chains").transform;
            holder.SetParent(figure.Root.transform, false);
            holder.localScale = new Vector3(4, 4, 4);
            var bone = holder.gameObject.AddComponent<DynamicBone>();
            bone.m_Roots.Add(root);
            bone.m_Exclusions.Add(left);
            bone.m_Radius = ball / 4;
            bone.m_Colliders.Add(collider);
            return collider;
        }

        [Test]
        public void colliders_of_dynamic_bone_and_magica_cloth_yield_too()
        {
            Begin();
            Yield(reach => Dynamic(reach, Ball), collider => ((DynamicBoneCollider)collider).m_Radius, end.position);
            Begin();
            Yield(reach => Dynamic(reach, 3 * Ball), collider => ((DynamicBoneCollider)collider).m_Radius, end.position, 3 * Ball);

            Begin();
            UnityEngine.Object.DestroyImmediate(left.gameObject);
            Yield(reach =>
            {
                var collider = figure.Bones[Carrier].gameObject.AddComponent<MagicaCloth.MagicaSphereCollider>();
                collider.center = Vector3.zero;
                collider.radius = reach;
                var cloth = figure.Root.AddComponent<MagicaCloth.MagicaBoneCloth>();
                cloth.clothTarget.rootList.Add(root);
                cloth.clothParams.radius.startValue = Ball;
                cloth.teamData.colliderList.Add(collider);
                return collider;
            }, collider => ((MagicaCloth.MagicaSphereCollider)collider).radius, end.position);

            Begin();
            UnityEngine.Object.DestroyImmediate(left.gameObject);
            Yield(reach =>
            {
                var collider = figure.Bones[Carrier].gameObject.AddComponent<MagicaCloth2.MagicaSphereCollider>();
                collider.center = Vector3.zero;
                collider.size.x = reach;
                var cloth = figure.Root.AddComponent<MagicaCloth2.MagicaCloth>();
                cloth.serializeData.rootBones.Add(root);
                cloth.serializeData.radius.value = Ball;
                cloth.serializeData.colliderCollisionConstraint.colliderList.Add(collider);
                return collider;
            }, collider => ((MagicaCloth2.MagicaSphereCollider)collider).size.x, end.position);
        }

        [Test]
        public void cloth_of_a_mesh_has_no_chain()
        {
            Begin();
            Assert.AreEqual(1, Yield(reach =>
            {
                var collider = figure.Bones[Carrier].gameObject.AddComponent<MagicaCloth2.MagicaSphereCollider>();
                collider.center = Vector3.zero;
                collider.size.x = reach;
                root.gameObject.AddComponent<MagicaCloth2.MagicaCloth>().serializeData.colliderCollisionConstraint.colliderList.Add(collider);
                return collider;
            }, collider => ((MagicaCloth2.MagicaSphereCollider)collider).size.x, end.position, yields: false), 1e-4);
        }

        [Test]
        public void a_collider_that_keeps_springs_in_grows()
        {
            foreach (bool inside in new[] { true, false })
            {
                figure = ComponentTableTests.Probed();
                Transform head = figure.Bones[HumanBodyBones.Head], chest = figure.Bones[HumanBodyBones.Chest];
                var tip = new GameObject("Tip").transform;
                tip.SetParent(head, false);
                tip.position = new Vector3(0, 1.75f, 0);
                float reach = Vector3.Distance(chest.position, tip.position) + Ball + 0.002f, free = 0, wanted = 0;
                var collider = chest.gameObject.AddComponent<VRCPhysBoneCollider>();
                collider.shapeType = 0;
                collider.radius = reach;
                collider.position = Vector3.zero;
                collider.insideBounds = inside;
                var bone = head.gameObject.AddComponent<VRCPhysBone>();
                bone.radius = Ball;
                bone.endpointPosition = Vector3.zero;
                foreach (Transform child in head)
                {
                    if (child != tip) bone.ignoreTransforms.Add(child);
                }
                bone.colliders.Add(collider);
                ComponentTableTests.Ask(map =>
                {
                    free = reach * map.Scale(chest, Vector3.zero);
                    wanted = Vector3.Distance(chest.position + Sum(map, chest), tip.position + Sum(map, tip)) + (Ball + 0.002f) * map.Scale(tip, Vector3.zero);
                });
                var made = Converter.Convert(figure.Root, ComponentTableTests.Settings(), null).Prefab.GetComponentInChildren<VRCPhysBoneCollider>();
                ComponentTableTests.Ask(null);
                Assert.That(wanted, Is.GreaterThan(1.01f * free), "the head outgrows the chest");
                Assert.AreEqual(inside ? Math.Min(wanted, 1.2f * free) : free, made.radius, 1e-4, "inside: " + inside);
            }
        }
    }
}
