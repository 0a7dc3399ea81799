using System.Collections.Generic;
using System.IO;
using System.Linq;
using NUnit.Framework;
using SuperDeform.Tests.Glb;
using UniVRM10;
using UnityEditor;
using UnityEngine;
using VRM;

namespace SuperDeform.Editor.Tests
{
    /// <summary>A VRM file in the stand-in of Unity, with the components that UniVRM would add, and its conversion.</summary>
    internal sealed class VrmAvatar
    {
        public readonly GameObject Root;
        /// <summary>What the file says, and what the example program's result says.</summary>
        public readonly List<SpringLine> Before, After;
        public readonly VRM10Object Asset;

        VrmAvatar(string name)
        {
            Root = GlbLoader.Load(Lines(name, ".vrm"), null).Root;
            Before = SpringLine.Read(Lines(name, ".txt"));
            After = SpringLine.Read(Lines(name, "_sd.txt"));
            Asset = ScriptableObject.CreateInstance<VRM10Object>();
        }

        static string Lines(string name, string tail)
        {
            return Path.Combine(System.Environment.GetEnvironmentVariable("SUPERDEFORM_VRM"), name + tail);
        }

        public static bool Exists(string name)
        {
            return File.Exists(Lines(name, ".vrm"));
        }

        public IEnumerable<SpringLine> Old(string kind) { return Before.Where(line => line.Kind == kind); }

        public IEnumerable<SpringLine> New(string kind) { return After.Where(line => line.Kind == kind); }

        public Transform Find(string name)
        {
            return Find(Root, name);
        }

        public static Transform Find(GameObject root, string name)
        {
            Transform found = root.GetComponentsInChildren<Transform>(true).FirstOrDefault(node => node.name == name);
            Assert.IsNotNull(found, root.name + " has no " + name);
            return found;
        }

        /// <summary>With the components of UniVRM 1.0.</summary>
        public static VrmAvatar Vrm1(string name)
        {
            var avatar = new VrmAvatar(name);
            foreach (SpringLine line in avatar.Old("joint"))
            {
                var joint = avatar.Find(line.Joint).gameObject.AddComponent<VRM10SpringBoneJoint>();
                joint.m_jointRadius = line.Numbers[0];
                joint.m_stiffnessForce = line.Numbers[1];
                joint.m_gravityPower = line.Numbers[2];
            }
            foreach (SpringLine line in avatar.Old("collider"))
            {
                var collider = avatar.Find(line.Joint).gameObject.AddComponent<VRM10SpringBoneCollider>();
                collider.ColliderType = Types[line.Shape];
                collider.Offset = line.Vector(0);
                collider.Tail = line.Vector(3);
                collider.Normal = line.Vector(6);
                collider.Radius = line.Last;
            }
            avatar.Asset.LookAt.OffsetFromHead = avatar.Old("look-at").Single().Vector(0);
            StubProjectAsset("Assets/" + name + ".asset", avatar.Asset);
            var instance = avatar.Root.AddComponent<Vrm10Instance>();
            instance.Vrm = avatar.Asset;
            var group = avatar.Root.AddComponent<VRM10SpringBoneColliderGroup>();
            group.Colliders.AddRange(avatar.Root.GetComponentsInChildren<VRM10SpringBoneCollider>(true));
            instance.SpringBone.ColliderGroups.Add(group);
            foreach (SpringLine line in avatar.Old("chain"))
            {
                var spring = new Vrm10InstanceSpringBone.Spring(line.Joint);
                spring.ColliderGroups.Add(group);
                spring.Joints.AddRange(line.Joint.Split(',').Select(joint => avatar.Find(joint).GetComponent<VRM10SpringBoneJoint>()));
                instance.SpringBone.Springs.Add(spring);
            }
            return avatar;
        }

        static void StubProjectAsset(string path, Object asset)
        {
            AssetDatabase.CreateAsset(asset, path);
        }

        static readonly Dictionary<string, VRM10SpringBoneColliderTypes> Types =
            new Dictionary<string, VRM10SpringBoneColliderTypes>
            {
                { "sphere", VRM10SpringBoneColliderTypes.Sphere }, { "capsule", VRM10SpringBoneColliderTypes.Capsule },
                { "plane", VRM10SpringBoneColliderTypes.Plane },
                { "sphere-inside", VRM10SpringBoneColliderTypes.SphereInside },
                { "capsule-inside", VRM10SpringBoneColliderTypes.CapsuleInside },
            };

        /// <summary>With the components of UniVRM 0.x: springs and viewpoint on objects of their own, as its importer does.
        /// </summary>
        public static VrmAvatar Vrm0(string name)
        {
            var avatar = new VrmAvatar(name);
            foreach (IGrouping<string, SpringLine> lines in avatar.Old("group-collider").GroupBy(line => line.Joint))
            {
                avatar.Find(lines.Key).gameObject.AddComponent<VRMSpringBoneColliderGroup>().Colliders =
                    lines.Select(Sphere).ToArray();
            }
            var secondary = new GameObject("springs");
            secondary.transform.SetParent(avatar.Root.transform, false);
            foreach (SpringLine line in avatar.Old("spring"))
            {
                avatar.AddSpring(secondary, line.Joint.Split(','), line.Numbers).ColliderGroups = line.Groups.Split(',').Where(joint => joint != "-")
                    .Select(joint => avatar.Find(joint).GetComponent<VRMSpringBoneColliderGroup>()).ToArray();
            }
            foreach (SpringLine line in avatar.Old("viewpoint"))
            {
                var viewpoint = avatar.Root.AddComponent<VRMFirstPerson>();
                viewpoint.FirstPersonBone = avatar.Find(line.Joint);
                viewpoint.FirstPersonOffset = line.Vector(0);
            }
            return avatar;
        }

        public VRMSpringBone AddSpring(GameObject holder, IEnumerable<string> roots, float[] numbers)
        {
            var spring = holder.AddComponent<VRMSpringBone>();
            spring.RootBones = roots.Select(Find).ToList();
            spring.m_hitRadius = numbers[0];
            spring.m_stiffnessForce = numbers[1];
            spring.m_gravityPower = numbers[2];
            return spring;
        }

        public static VRMSpringBoneColliderGroup.SphereCollider Sphere(SpringLine line)
        {
            return new VRMSpringBoneColliderGroup.SphereCollider { Offset = line.Vector(0), Radius = line.Last };
        }

        /// <summary>What the last conversion said.</summary>
        public List<Finding> Findings;

        /// <summary>The prefab at 1.8 heads, as the example program was asked: the rogue is a stubby one already.</summary>
        public GameObject Convert(params GroupSettings[] groups)
        {
            var settings = new ConversionSettings { Heads = 1.8f, OutputFolder = "Assets/Results" };
            settings.Options.Groups.AddRange(groups);
            ConversionResult result = Converter.Convert(Root, settings, null);
            Findings = result.Findings;
            return result.Prefab;
        }
    }
}
