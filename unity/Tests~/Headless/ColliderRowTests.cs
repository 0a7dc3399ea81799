using System;
using System.Collections.Generic;
using NUnit.Framework;
using UnityEngine;
using UnityStubs;
using VRC.SDK3.Avatars.Components;
using VRC.SDK3.Dynamics.Contact.Components;
using VRC.SDK3.Dynamics.PhysBone.Components;

namespace SuperDeform.Editor.Tests
{
    /// <summary>
    /// Colliders of springs, seen as their own simulations see them: the ends of a capsule go where the map takes them, and it is
    /// as thick as the mesh around it.
    /// </summary>
    [TestFixture]
    public class ColliderRowTests
    {
        const HumanBodyBones Arm = HumanBodyBones.LeftUpperArm, Leg = HumanBodyBones.RightUpperLeg;
        const float Near = 1e-4f;
        ConversionFigure figure;

        /// <summary>The classes that these tests are for.</summary>
        internal static readonly string[] Types =
        {
            typeof(VRCPhysBoneCollider).FullName, typeof(VRCContactSender).FullName, typeof(VRCContactReceiver).FullName, typeof(VRCAvatarDescriptor).FullName,
            typeof(nadena.dev.ndmf.multiplatform.components.PortableDynamicBoneCollider).FullName,
            typeof(nadena.dev.modular_avatar.core.ModularAvatarGlobalCollider).FullName, typeof(DynamicBoneCollider).FullName,
            typeof(MagicaCloth.MagicaSphereCollider).FullName, typeof(MagicaCloth.MagicaCapsuleCollider).FullName,
            typeof(MagicaCloth2.MagicaSphereCollider).FullName, typeof(MagicaCloth2.MagicaCapsuleCollider).FullName
        };

        /// <summary>Two balls and what is between them, or one ball, in the space of a transform.</summary>
        struct Shape
        {
            internal Vector3 First, Second;
            internal float FirstRadius, SecondRadius;

            internal static Shape Ball(Vector3 middle, float radius)
            {
                return new Shape { First = middle, Second = middle, FirstRadius = radius, SecondRadius = radius };
            }
        }

        static float Cube(PointMap map, Transform frame, Vector3 at)
        {
            Vector3 x = Step(map, frame, at, Vector3.right), y = Step(map, frame, at, Vector3.up), z = Step(map, frame, at, Vector3.forward);
            return (float)Math.Pow(Math.Abs(Vector3.Dot(x, Vector3.Cross(y, z))), 1.0 / 3);
        }

        static Vector3 Step(PointMap map, Transform frame, Vector3 at, Vector3 way)
        {
            return (map.Point(frame, at + way * 1e-3f) - map.Point(frame, at - way * 1e-3f)) / 2e-3f;
        }

        static Shape Wanted(PointMap map, Transform frame, Shape old)
        {
            float growth = old.First == old.Second ? Cube(map, frame, old.First)
                : Mathf.Sqrt(ComponentTableTests.Across(map, frame, old.First, old.First - old.Second) * ComponentTableTests.Across(map, frame, old.Second, old.First - old.Second));
            return new Shape
            {
                First = map.Point(frame, old.First), Second = map.Point(frame, old.Second), FirstRadius = old.FirstRadius * growth,
                SecondRadius = old.SecondRadius * growth
            };
        }

        /// <summary>Converts a figure with one component on its arm.</summary>
        /// <param name="frame">In whose space the shape is; null: the component's own.</param>
        /// <param name="turns">Whether the ends go where they should exactly; else their distance and middle do.</param>
        void Check<T>(string what, Action<T> set, HumanBodyBones frame, Func<T, Shape> shape, bool turns, Action<T, T> more = null) where T : Component
        {
            figure = ComponentTableTests.Probed();
            T component = figure.Bones[Arm].gameObject.AddComponent<T>();
            set(component);
            string before = Fingerprint.Of(figure.Root);
            Shape wanted = new Shape(), old = shape(component);
            ComponentTableTests.Ask(map => wanted = Wanted(map, figure.Bones[frame], old));
            GameObject prefab = Converter.Convert(figure.Root, ComponentTableTests.Settings(), null).Prefab;
            ComponentTableTests.Ask(null);
            T made = prefab.GetComponentInChildren<T>();
            Shape found = shape(made);
            what = typeof(T).Name + ", " + what;
            Assert.AreEqual(wanted.FirstRadius, found.FirstRadius, 1e-3f * old.FirstRadius, what + ": radius");
            Assert.AreEqual(wanted.SecondRadius, found.SecondRadius, 1e-3f * old.SecondRadius, what + ": other radius");
            Assert.That(Math.Abs(found.FirstRadius - old.FirstRadius), Is.GreaterThan(0.01f * old.FirstRadius), what + " has changed");
            Assert.AreEqual(Vector3.Distance(wanted.First, wanted.Second), Vector3.Distance(found.First, found.Second), Near, what + ": length");
            if (turns)
            {
                Assert.That(Vector3.Distance(wanted.First, found.First), Is.LessThan(Near), what + ": first end");
                Assert.That(Vector3.Distance(wanted.Second, found.Second), Is.LessThan(Near), what + ": other end");
            }
            else
            {
                Assert.That(Vector3.Distance(wanted.First + wanted.Second, found.First + found.Second), Is.LessThan(2 * Near), what + ": middle");
            }
            if (more != null) more(component, made);
            Assert.AreEqual(before, Fingerprint.Of(figure.Root), what + ": the source");
        }

        // Heights of VRChat, Modular Avatar and NDMF are from tip to tip, along Y.
        static Shape Upright(Vector3 position, Quaternion rotation, float radius, float height)
        {
            Vector3 half = rotation * Vector3.up * Math.Max(0, height / 2 - radius);
            return new Shape { First = position + half, Second = position - half, FirstRadius = radius, SecondRadius = radius };
        }

        [Test]
        public void colliders_of_phys_bones()
        {
            Action<VRCPhysBoneCollider> onLeg = c => c.rootTransform = figure.Bones[Leg];
            Check<VRCPhysBoneCollider>("capsule", onLeg, Leg, c => Upright(c.position, c.rotation, c.radius, c.height), true);
            Check<VRCPhysBoneCollider>("short capsule", c =>
            {
                onLeg(c);
                c.height = 0.06f;
            }, Leg, c => Upright(c.position, c.rotation, c.radius, c.height), true, (old, made) => Assert.AreEqual(old.height * made.radius / old.radius, made.height, 1e-5));
            Check<VRCPhysBoneCollider>("sphere", c =>
            {
                onLeg(c);
                c.shapeType = 0;
            }, Leg, c => Shape.Ball(c.position, c.radius), true, (old, made) =>
            {
                Assert.AreEqual(old.height, made.height, "of a sphere it is nothing");
                Assert.AreEqual(old.rotation, made.rotation);
            });
        }

        [Test]
        public void a_plane_turns_with_what_lies_in_it()
        {
            figure = ComponentTableTests.Probed();
            var plane = figure.Bones[Leg].gameObject.AddComponent<VRCPhysBoneCollider>();
            plane.shapeType = 2;
            plane.position = new Vector3(0.05f, -0.2f, 0);
            plane.rotation = Quaternion.Euler(20, 0, 40);
            Vector3 normal = plane.rotation * Vector3.up, one = Vector3.Cross(normal, Vector3.right).normalized, other = Vector3.Cross(normal, one);
            Vector3 wanted = Vector3.zero, at = Vector3.zero;
            ComponentTableTests.Ask(map =>
            {
                at = map.Point(plane.transform, plane.position);
                wanted = Vector3.Cross(Step(map, plane.transform, plane.position, one), Step(map, plane.transform, plane.position, other)).normalized;
            });
            var made = Converter.Convert(figure.Root, ComponentTableTests.Settings(), null).Prefab.GetComponentInChildren<VRCPhysBoneCollider>();
            ComponentTableTests.Ask(null);
            Assert.That(Vector3.Distance(at, made.position), Is.LessThan(Near));
            Assert.That(Math.Abs(Vector3.Dot(wanted, (made.rotation * Vector3.up).normalized)), Is.GreaterThan(1 - 1e-5f));
            Assert.That(Vector3.Dot(wanted.normalized, normal), Is.Not.EqualTo(1).Within(1e-3f), "it has turned");
            Assert.AreEqual(plane.radius, made.radius);
        }

        [Test]
        public void contacts_change_by_their_shape()
        {
            foreach (int shape in new[] { 0, 1, 2 })
            {
                Action<Contact> set = c =>
                {
                    c.rootTransform = figure.Bones[Leg];
                    c.shapeType = shape;
                };
                if (shape == 0) Check<VRCContactSender>("sphere", set, Leg, c => Shape.Ball(c.position, c.radius), true);
                if (shape == 1) Check<VRCContactReceiver>("capsule", set, Leg, c => Upright(c.position, c.rotation, c.radius, c.height), true);
            }
            figure = ComponentTableTests.Probed();
            var box = figure.Bones[Leg].gameObject.AddComponent<VRCContactReceiver>();
            box.shapeType = 2;
            Vector3 at = Vector3.zero, size = Vector3.zero;
            ComponentTableTests.Ask(map =>
            {
                at = map.Point(box.transform, box.position);
                for (int axis = 0; axis < 3; axis++)
                {
                    Vector3 way = Vector3.zero;
                    way[axis] = 1;
                    size[axis] = box.size[axis] * Step(map, box.transform, box.position, way).magnitude;
                }
            });
            var made = Converter.Convert(figure.Root, ComponentTableTests.Settings(), null).Prefab.GetComponentInChildren<VRCContactReceiver>();
            ComponentTableTests.Ask(null);
            Assert.That(Vector3.Distance(at, made.position), Is.LessThan(Near));
            Assert.That(Vector3.Distance(size, made.size), Is.LessThan(Near * 3));
            Assert.That(Vector3.Distance(box.size, made.size), Is.GreaterThan(0.01f));
            Assert.AreEqual(box.radius, made.radius);
        }

        [Test]
        public void every_collider_of_the_avatar_descriptor()
        {
            foreach (string part in new[] { "head", "torso", "footL", "footR", "handL", "handR", "fingerIndexL", "fingerMiddleL", "fingerRingL", "fingerLittleL",
                "fingerIndexR", "fingerMiddleR", "fingerRingR", "fingerLittleR" })
            {
                Func<VRCAvatarDescriptor, ColliderConfig> of = c => (ColliderConfig)c.GetType().GetField("collider_" + part).GetValue(c);
                Check<VRCAvatarDescriptor>(part, c => of(c).transform = figure.Bones[Leg], Leg,
                    c => Upright(of(c).position, of(c).rotation, of(c).radius, of(c).height), true);
            }
        }

        [Test]
        public void colliders_of_ndmf_and_modular_avatar()
        {
            foreach (int type in new[] { 0, 1 })
            {
                Check<nadena.dev.ndmf.multiplatform.components.PortableDynamicBoneCollider>("type " + type, c => c.m_colliderType = type, Arm,
                    c => type == 0 ? Shape.Ball(c.m_positionOffset, c.m_radius) : Upright(c.m_positionOffset, c.m_rotationOffset, c.m_radius, c.m_height), true);
            }
            Check<nadena.dev.modular_avatar.core.ModularAvatarGlobalCollider>("capsule", c => c.m_rootTransform.targetObject = figure.Bones[Leg].gameObject, Leg,
                c => Upright(c.m_position, c.m_rotation, c.m_radius, c.m_height), true);
        }

        // As DynamicBoneCollider prepares itself: ends at half the height less each radius; a second radius that is 0 or close is none.
        static Shape Seen(DynamicBoneCollider c)
        {
            float half = c.m_Height / 2, one = c.m_Radius, other = c.m_Radius2 > 0 && Math.Abs(c.m_Radius - c.m_Radius2) >= 0.01f ? c.m_Radius2 : c.m_Radius;
            if (half - Math.Max(one, other) <= 0) return Shape.Ball(c.m_Center, Math.Max(one, other));
            Vector3 axis = new Vector3(c.m_Direction == 0 ? 1 : 0, c.m_Direction == 1 ? 1 : 0, c.m_Direction == 2 ? 1 : 0);
            return new Shape { First = c.m_Center + axis * (half - one), Second = c.m_Center - axis * (half - other), FirstRadius = one, SecondRadius = other };
        }

        [Test]
        public void colliders_of_dynamic_bone()
        {
            for (int direction = 0; direction < 3; direction++)
            {
                Check<DynamicBoneCollider>("direction " + direction, c =>
                {
                    c.m_Direction = direction;
                    c.m_Radius2 = 0;
                }, Arm, Seen, false, (old, made) => Assert.AreEqual(0, made.m_Radius2));
            }
            Check<DynamicBoneCollider>("two radii", c => c.m_Radius2 = 0.09f, Arm, Seen, false);
            Check<DynamicBoneCollider>("ball", c =>
            {
                c.m_Height = 0;
                c.m_Radius2 = 0;
            }, Arm, Seen, true);
        }

        // As Magica Cloth 1 has it: the length is from the centre to each end's middle.
        static Shape Seen(MagicaCloth.MagicaCapsuleCollider c)
        {
            Vector3 half = new Vector3(c.axis == 0 ? 1 : 0, c.axis == 1 ? 1 : 0, c.axis == 2 ? 1 : 0) * c.length;
            return new Shape { First = c.center + half, Second = c.center - half, FirstRadius = c.startRadius, SecondRadius = c.endRadius };
        }

        // And 2: from tip to tip, around the centre or from it; backwards or not; with one radius or two.
        static Shape Seen(MagicaCloth2.MagicaCapsuleCollider c)
        {
            float one = c.size.x, other = c.radiusSeparation ? c.size.y : c.size.x;
            Vector3 axis = new Vector3(c.direction == 0 ? 1 : 0, c.direction == 1 ? 1 : 0, c.direction == 2 ? 1 : 0) * (c.reverseDirection ? -1 : 1);
            float start = c.alignedOnCenter ? Math.Max(0, c.size.z / 2 - one) : 0;
            float end = c.alignedOnCenter ? Math.Max(0, c.size.z / 2 - other) : Math.Max(0, c.size.z - one - other);
            return new Shape { First = c.center + axis * start, Second = c.center - axis * end, FirstRadius = one, SecondRadius = other };
        }

        [Test]
        public void colliders_of_magica_cloth()
        {
            Check<MagicaCloth.MagicaSphereCollider>("sphere", c => { }, Arm, c => Shape.Ball(c.center, c.radius), true);
            Check<MagicaCloth2.MagicaSphereCollider>("sphere", c => { }, Arm, c => Shape.Ball(c.center, c.size.x), true);
            for (int direction = 0; direction < 3; direction++)
            {
                Check<MagicaCloth.MagicaCapsuleCollider>("direction " + direction, c => c.axis = direction, Arm, Seen, false);
                Check<MagicaCloth2.MagicaCapsuleCollider>("direction " + direction, c => c.direction = direction, Arm, Seen, false);
            }
            Check<MagicaCloth2.MagicaCapsuleCollider>("from its centre", c => c.alignedOnCenter = false, Arm, Seen, false);
            Check<MagicaCloth2.MagicaCapsuleCollider>("backwards", c =>
            {
                c.reverseDirection = true;
                c.alignedOnCenter = false;
            }, Arm, Seen, false);
            Check<MagicaCloth2.MagicaCapsuleCollider>("one radius", c => c.radiusSeparation = false, Arm, Seen, false,
                (old, made) => Assert.AreEqual(made.size.x / old.size.x, made.size.y / old.size.y, 1e-4, "the other is ready to be switched on"));
        }
    }
}
