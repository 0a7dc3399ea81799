using System.Collections.Generic;
using System.IO;
using System.Linq;
using System.Reflection;
using NUnit.Framework;
using SuperDeform.Editor.Vrm0;
using SuperDeform.Editor.Vrm1;
using UniVRM10;
using UnityEditor;
using UnityEngine;
using UnityStubs;
using VRM;

namespace SuperDeform.Editor.Tests
{
    /// <summary>Springs, colliders and viewpoints of the new avatar are those that the example program writes.</summary>
    [TestFixture]
    public class VrmTests
    {
        // Of the avatar's height (about 1.5): what the task of the conversion allows.
        const float Near = 1.5e-5f;

        [SetUp]
        public void EmptyProject()
        {
            string folder = Path.Combine(System.Environment.GetEnvironmentVariable("SUPERDEFORM_VRM"), "project");
            if (Directory.Exists(folder)) Directory.Delete(folder, true);
            StubProject.Open(folder);
            ComponentAdapters.Register(new Vrm0Adapter());
            ComponentAdapters.Register(new Vrm1Adapter());
        }

        static void Same(Vector3 expected, Vector3 found, string what)
        {
            Assert.That((expected - found).magnitude, Is.LessThan(Near * System.Math.Max(1, expected.magnitude)),
                what + ": " + expected.ToString("F6") + " wanted, found " + found.ToString("F6"));
        }

        static void Same(float expected, float found, string what)
        {
            Assert.AreEqual(expected, found, Near * System.Math.Max(1, System.Math.Abs(expected)), what);
        }

        [Test]
        public void unity_registers_both_adapters_when_it_loads()
        {
            foreach (System.Type type in new[] { typeof(Vrm0Adapter), typeof(Vrm1Adapter) })
            {
                MethodInfo method = type.GetMethod("Register", BindingFlags.Static | BindingFlags.NonPublic);
                Assert.IsNotNull(method, type.Name);
                Assert.IsTrue(method.IsDefined(typeof(InitializeOnLoadMethodAttribute), false), type.Name);
                method.Invoke(null, null);
            }
        }

        [Test]
        public void joints_of_vrm_1_take_the_scale_where_they_are()
        {
            VrmAvatar avatar = VrmAvatar.Vrm1("rogue");
            GameObject prefab = avatar.Convert();
            Assert.AreEqual(10, avatar.New("joint").Count());
            foreach (SpringLine line in avatar.New("joint"))
            {
                var joint = VrmAvatar.Find(prefab, line.Joint).GetComponent<VRM10SpringBoneJoint>();
                Same(line.Numbers[0], joint.m_jointRadius, line.Joint + ", radius");
                Same(line.Numbers[1], joint.m_stiffnessForce, line.Joint + ", stiffness");
                Same(line.Numbers[2], joint.m_gravityPower, line.Joint + ", gravity");
                Assert.AreEqual(0.4f, joint.m_dragForce);
            }
        }

        [Test]
        public void colliders_of_vrm_1_move_and_grow_in_every_shape()
        {
            VrmAvatar avatar = VrmAvatar.Vrm1("rogue");
            GameObject prefab = avatar.Convert();
            var used = new Dictionary<string, int>();
            foreach (SpringLine line in avatar.New("collider"))
            {
                int place;
                used.TryGetValue(line.Joint, out place);
                used[line.Joint] = place + 1;
                var collider = VrmAvatar.Find(prefab, line.Joint).GetComponents<VRM10SpringBoneCollider>()[place];
                Same(line.Vector(0), collider.Offset, line.Joint + " " + line.Shape + ", offset");
                Same(line.Last, collider.Radius, line.Joint + " " + line.Shape + ", radius");
                if (line.Shape.StartsWith("capsule")) Same(line.Vector(3), collider.Tail, line.Joint + " " + line.Shape + ", tail");
                if (line.Shape == "plane") Same(line.Vector(6), collider.Normal, line.Joint + ", normal");
            }
            Assert.AreEqual(8, used.Values.Sum());
        }

        [Test]
        public void colliders_of_vrm_1_yield_to_springs_and_what_is_too_deep_is_told()
        {
            VrmAvatar avatar = VrmAvatar.Vrm1("rogue");
            avatar.Convert();
            Assert.AreEqual(1, avatar.Findings.Count(finding => finding.Key == "collider_yields"));
            VrmAvatar stout = VrmAvatar.Vrm1("rogue");
            stout.Convert(new GroupSettings { Group = "torso", ThicknessScale = 1.25f });
            Finding deep = stout.Findings.Single(finding => finding.Key == "spring_in_collider");
            Assert.AreSame(stout.Find("hips"), deep.Where);
            // Without springs they are as thick as the mesh: those that yield are thicker.
            float yielding = avatar.New("collider").Where(line => line.Joint == "spine" && line.Shape == "sphere").Single().Last;
            VrmAvatar free = VrmAvatar.Vrm1("rogue");
            free.Root.GetComponent<Vrm10Instance>().SpringBone.Springs.Clear();
            VRM10SpringBoneCollider whole = VrmAvatar.Find(free.Convert(), "spine").GetComponents<VRM10SpringBoneCollider>()[1];
            // By a fifth at most, but for rounding.
            Assert.That(yielding, Is.InRange(0.79999f * whole.Radius, 0.99f * whole.Radius));
            Assert.That(free.Findings.Exists(finding => finding.Key == "collider_yields" || finding.Key == "spring_in_collider"), Is.False);
        }

        [Test]
        public void the_new_avatar_of_vrm_1_has_look_at_settings_of_its_own()
        {
            VrmAvatar avatar = VrmAvatar.Vrm1("rogue");
            GameObject prefab = avatar.Convert();
            VRM10Object own = prefab.GetComponent<Vrm10Instance>().Vrm;
            Same(avatar.New("look-at").Single().Vector(0), own.LookAt.OffsetFromHead, "look-at");
            Assert.AreNotSame(avatar.Asset, own);
            StringAssert.StartsWith("Assets/Results/", AssetDatabase.GetAssetPath(own));
            Same(avatar.Old("look-at").Single().Vector(0), avatar.Asset.LookAt.OffsetFromHead, "the old one's");
        }

        [Test]
        public void nothing_of_a_vrm_1_source_changes()
        {
            VrmAvatar avatar = VrmAvatar.Vrm1("rogue");
            avatar.Convert();
            Assert.AreSame(avatar.Asset, avatar.Root.GetComponent<Vrm10Instance>().Vrm);
            foreach (SpringLine line in avatar.Old("joint"))
            {
                Assert.AreEqual(line.Numbers[0],
                    avatar.Find(line.Joint).GetComponent<VRM10SpringBoneJoint>().m_jointRadius, line.Joint);
            }
            Assert.AreEqual(avatar.Old("collider").Select(line => line.Last).Sum(),
                avatar.Root.GetComponentsInChildren<VRM10SpringBoneCollider>(true).Select(one => one.Radius).Sum(), 1e-6);
        }

        // A chain's joints are the joint and all below it; the lines of VRM 1.0 name just these.
        [Test]
        public void a_spring_of_vrm_0_takes_the_mean_scale_of_all_its_joints()
        {
            VrmAvatar avatar = VrmAvatar.Vrm0("rogue");
            var holder = new GameObject("more springs");
            holder.transform.SetParent(avatar.Root.transform, false);
            avatar.AddSpring(holder, new[] { "upperarm.l", "head", "upperleg.r" }, new[] { 0.02f, 2f, 0.5f });
            var scales = avatar.Old("joint").Zip(avatar.New("joint"), (old, made) => made.Numbers[1] / old.Numbers[1]);
            float mean = scales.Average();
            float before = MeanBend(avatar.Root, avatar, 0.5f / 2f);
            GameObject prefab = avatar.Convert();
            var spring = VrmAvatar.Find(prefab, "more springs").GetComponent<VRMSpringBone>();
            Assert.That(mean, Is.Not.EqualTo(1).Within(0.02));
            Same(0.02f * mean, spring.m_hitRadius, "radius");
            Same(2f * mean, spring.m_stiffnessForce, "stiffness");
            Assert.AreEqual(0.4f, spring.m_dragForce);
            // Gravity gives way: the chains hang as they did, in the mean, but that bends of different bones do not quite grow alike.
            Assert.That(MeanBend(prefab, avatar, 0.5f / 2f), Is.GreaterThan(1.02f * before));
            Assert.That(MeanBend(prefab, avatar, spring.m_gravityPower / spring.m_stiffnessForce), Is.EqualTo(before).Within(0.02 * before));
        }

        // How far gravity bends the bones of the chains where it balances a stiffness of 1, in degrees.
        static float MeanBend(GameObject root, VrmAvatar avatar, float gravity)
        {
            string[] joints = avatar.Old("joint").Select(line => line.Joint).ToArray();
            var bends = new List<float>();
            foreach (Transform joint in joints.Select(name => VrmAvatar.Find(root, name)))
            {
                if (!joints.Contains(joint.parent.name)) continue;
                Vector3 bone = (joint.position - joint.parent.position).normalized;
                bends.Add(Vector3.Angle(bone, bone + gravity * Vector3.down));
            }
            Assert.AreEqual(7, bends.Count);
            return bends.Average();
        }

        [Test]
        public void a_sphere_of_vrm_0_moves_as_one_of_vrm_1()
        {
            VrmAvatar avatar = VrmAvatar.Vrm0("rogue");
            string[] joints = { "head", "hand.r" };
            foreach (string joint in joints)
            {
                avatar.Find(joint).gameObject.AddComponent<VRMSpringBoneColliderGroup>().Colliders =
                    avatar.Old("collider").Where(line => line.Joint == joint).Select(VrmAvatar.Sphere).ToArray();
            }
            GameObject prefab = avatar.Convert();
            foreach (string joint in joints)
            {
                SpringLine[] lines = avatar.New("collider").Where(line => line.Joint == joint).ToArray();
                var group = VrmAvatar.Find(prefab, joint).GetComponent<VRMSpringBoneColliderGroup>();
                Assert.AreEqual(lines.Length, group.Colliders.Length);
                for (int place = 0; place < lines.Length; place++)
                {
                    Same(lines[place].Vector(0), group.Colliders[place].Offset, joint + ", offset");
                    Same(lines[place].Last, group.Colliders[place].Radius, joint + ", radius");
                }
                SpringLine first = avatar.Old("collider").First(line => line.Joint == joint);
                Assert.AreEqual(first.Last,
                    avatar.Find(joint).GetComponent<VRMSpringBoneColliderGroup>().Colliders[0].Radius, "the source's");
            }
        }

        [Test]
        public void what_hangs_from_nothing_of_the_avatar_stays()
        {
            VrmAvatar avatar = VrmAvatar.Vrm0("rogue");
            var holder = new GameObject("empty");
            holder.transform.SetParent(avatar.Root.transform, false);
            avatar.AddSpring(holder, new string[0], new[] { 0.02f, 2f, 0.5f });
            avatar.Root.AddComponent<VRMFirstPerson>().FirstPersonOffset = new Vector3(0, 0.06f, 0);
            GameObject prefab = avatar.Convert();
            Assert.AreEqual(0.02f, VrmAvatar.Find(prefab, "empty").GetComponent<VRMSpringBone>().m_hitRadius);
            Assert.AreEqual(0.06f, prefab.GetComponent<VRMFirstPerson>().FirstPersonOffset.y);
        }

        [Test]
        public void godette_swings_as_the_example_program_says()
        {
            if (!VrmAvatar.Exists("godette")) Assert.Ignore("godette.vrm is not in SUPERDEFORM_MODELS, or there is no example program");
            VrmAvatar avatar = VrmAvatar.Vrm0("godette");
            GameObject prefab = avatar.Convert();

            VRMSpringBone[] springs = prefab.GetComponentsInChildren<VRMSpringBone>(true);
            SpringLine[] lines = avatar.New("spring").ToArray();
            Assert.AreEqual(3, lines.Length);
            for (int place = 0; place < lines.Length; place++)
            {
                Same(lines[place].Numbers[0], springs[place].m_hitRadius, lines[place].Joint + ", radius");
                Same(lines[place].Numbers[1], springs[place].m_stiffnessForce, lines[place].Joint + ", stiffness");
                Same(lines[place].Numbers[2], springs[place].m_gravityPower, lines[place].Joint + ", gravity");
            }

            foreach (IGrouping<string, SpringLine> group in avatar.New("group-collider").GroupBy(line => line.Joint))
            {
                var colliders = VrmAvatar.Find(prefab, group.Key).GetComponent<VRMSpringBoneColliderGroup>().Colliders;
                Assert.AreEqual(2, colliders.Length);
                for (int place = 0; place < colliders.Length; place++)
                {
                    Same(group.ElementAt(place).Vector(0), colliders[place].Offset, group.Key + ", offset");
                    Same(group.ElementAt(place).Last, colliders[place].Radius, group.Key + ", radius");
                }
            }

            SpringLine eyes = avatar.New("viewpoint").Single();
            Same(eyes.Vector(0), prefab.GetComponent<VRMFirstPerson>().FirstPersonOffset, "viewpoint");
        }
    }
}
