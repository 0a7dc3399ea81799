using System;
using System.Collections.Generic;
using nadena.dev.modular_avatar.core;
using NUnit.Framework;
using UnityEngine;
using UnityStubs;

namespace SuperDeform.Editor.Tests
{
    /// <summary>Outfits with an armature of their own go where the same cloth goes that is bound to the avatar's.</summary>
    [TestFixture]
    public class OutfitTests
    {
        static ConversionSettings Settings()
        {
            return new ConversionSettings { Heads = 2.5f, OutputFolder = "Assets/Out", PlaceInScene = false };
        }

        static Vector3[] Converted(GameObject root, string cloth)
        {
            return Drawing.Drawn(Converter.Convert(root, Settings(), null).Prefab, cloth);
        }

        /// <summary>A person whose hair has a bone's weights all over; the cloth is a second body, one size larger.</summary>
        static ConversionFigure Figure(out SkinnedMeshRenderer coat)
        {
            var figure = new ConversionFigure { Turned = true, WithShapes = true }.Make();
            // Its meshes are in centimetres.
            coat = Wardrobe.Coat(figure, 1.5f);
            return figure;
        }

        static void FitsAsMerged(string how, Action<ConversionFigure, Dictionary<Transform, Transform>> dress, Func<string, string> rename)
        {
            Models.NewProject();
            SkinnedMeshRenderer coat;
            ConversionFigure merged = Figure(out coat);
            Vector3[] wanted = Converted(merged.Root, "Coat");
            Models.NewProject();
            ConversionFigure dressed = Figure(out coat);
            var twins = Wardrobe.Armature(dressed.Root, dressed.Bones[HumanBodyBones.Hips], rename);
            Wardrobe.Bind(coat, twins);
            dress(dressed, twins);
            string before = Fingerprint.Of(dressed.Root);
            double apart = Drawing.Apart(wanted, Converted(dressed.Root, "Coat"));
            Console.WriteLine(how + ": at most " + (apart / 1.9).ToString("0.00E0") + " of the height apart");
            Assert.That(apart, Is.LessThan(1e-3 * 1.9), how);
            Assert.AreEqual(before, Fingerprint.Of(dressed.Root), how);
        }

        static Transform Armature(ConversionFigure figure)
        {
            return figure.Root.transform.Find("Outfit/Armature.1");
        }

        [Test]
        public void joints_of_the_same_name_at_the_same_place_are_twins()
        {
            FitsAsMerged("same names", (figure, twins) => { }, name => name);
        }

        [Test]
        public void joints_with_a_prefix_and_a_suffix_are_twins()
        {
            FitsAsMerged("prefix and suffix", (figure, twins) => { }, name => "Coat_" + name + ".001");
        }

        [Test]
        public void a_humanoid_outfit_is_no_second_avatar_and_its_own_roles_make_twins()
        {
            var letters = new Dictionary<string, string>();
            FitsAsMerged("an Animator of its own", (figure, twins) => Wardrobe.MakeHumanoid(figure.Root.transform.Find("Outfit").gameObject, figure.Bones, twins),
                name => letters[name] = "bone " + letters.Count);
            Assert.That(letters.Count, Is.GreaterThan(15));
        }

        [Test]
        public void modular_avatar_says_which_joints_are_twins_wherever_they_lie()
        {
            FitsAsMerged("Merge Armature", (figure, twins) =>
            {
                var merge = Armature(figure).gameObject.AddComponent<ModularAvatarMergeArmature>();
                merge.mergeTarget.referencePath = "Armature";
                merge.prefix = "X";
                merge.suffix = "Y";
            }, name => "X" + name + "Y");
            Models.NewProject();
            SkinnedMeshRenderer coat;
            ConversionFigure moved = Figure(out coat);
            var copies = Wardrobe.Armature(moved.Root, moved.Bones[HumanBodyBones.Hips], name => "X" + name);
            Wardrobe.Bind(coat, copies);
            copies[moved.Bones[HumanBodyBones.Hips]].position += new Vector3(0, 0.2f, 0);
            var component = Armature(moved).gameObject.AddComponent<ModularAvatarMergeArmature>();
            component.mergeTarget.targetObject = moved.Root.transform.Find("Armature").gameObject;
            component.prefix = "X";
            using (AvatarData data = CharacterReader.Read(moved.Root, new ReadOptions()))
            {
                foreach (KeyValuePair<Transform, Transform> pair in copies)
                {
                    Assert.AreEqual(data.IndexOf(pair.Key), data.Twins[data.IndexOf(pair.Value)], pair.Key.name);
                }
            }
        }

        [Test]
        public void joints_elsewhere_are_no_twins()
        {
            Models.NewProject();
            SkinnedMeshRenderer coat;
            ConversionFigure figure = Figure(out coat);
            var copies = Wardrobe.Armature(figure.Root, figure.Bones[HumanBodyBones.Hips], name => name);
            Wardrobe.Bind(coat, copies);
            figure.Root.transform.Find("Outfit").position = new Vector3(1, 0, 0);
            using (AvatarData data = CharacterReader.Read(figure.Root, new ReadOptions()))
            {
                foreach (Transform copy in copies.Values) Assert.AreEqual(data.IndexOf(copy), data.Twins[data.IndexOf(copy)], copy.name);
            }
        }

        [Test]
        public void what_hangs_from_a_twin_or_goes_by_a_bone_proxy_goes_with_the_bone()
        {
            Models.NewProject();
            SkinnedMeshRenderer coat;
            ConversionFigure figure = Figure(out coat);
            var twins = Wardrobe.Armature(figure.Root, figure.Bones[HumanBodyBones.Hips], name => name);
            Wardrobe.Bind(coat, twins);
            // The same hat thrice: on the head, on the head's twin, and below the root with a Bone Proxy.
            MeshRenderer onTwin = Hat(figure, twins[figure.Bones[HumanBodyBones.Head]], "OnTwin");
            MeshRenderer proxied = Hat(figure, figure.Root.transform, "Proxied");
            var proxy = proxied.gameObject.AddComponent<ModularAvatarBoneProxy>();
            proxy.boneReference = HumanBodyBones.Head;
            GameObject prefab = Converter.Convert(figure.Root, Settings(), null).Prefab;
            Vector3[] wanted = Drawing.Drawn(prefab, "Hat");
            Assert.That(Drawing.Apart(wanted, Drawing.Drawn(prefab, "OnTwin")), Is.LessThan(1e-3 * 1.9));
            Assert.That(Drawing.Apart(wanted, Drawing.Drawn(prefab, "Proxied")), Is.LessThan(1e-3 * 1.9));
        }

        [Test]
        public void an_empty_object_with_a_bone_proxy_goes_with_the_bone()
        {
            Models.NewProject();
            SkinnedMeshRenderer coat;
            ConversionFigure figure = Figure(out coat);
            // A contact's place above the head, say: held by the head, proxied to it, and held by nothing.
            Transform held = Empty("Held", figure.Bones[HumanBodyBones.Head]), proxied = Empty("Proxied", figure.Root.transform);
            Empty("Free", figure.Root.transform);
            proxied.gameObject.AddComponent<ModularAvatarBoneProxy>().boneReference = HumanBodyBones.Head;
            GameObject prefab = Converter.Convert(figure.Root, Settings(), null).Prefab;
            Vector3 wanted = ConversionTests.Find(prefab, "Held").position;
            Assert.That(Vector3.Distance(held.position, wanted), Is.GreaterThan(0.1f * 1.9f));
            Assert.That(Vector3.Distance(wanted, ConversionTests.Find(prefab, "Proxied").position), Is.LessThan(1e-3f * 1.9f));
            Assert.That(Vector3.Distance(wanted, ConversionTests.Find(prefab, "Free").position), Is.GreaterThan(0.01f * 1.9f));
        }

        static Transform Empty(string name, Transform parent)
        {
            Transform made = new GameObject(name).transform;
            made.SetParent(parent, false);
            made.position = new Vector3(0.1f, 2.2f, 0.2f);
            return made;
        }

        static MeshRenderer Hat(ConversionFigure figure, Transform parent, string name)
        {
            MeshRenderer hat = UnityEngine.Object.Instantiate(figure.Hat, parent);
            hat.name = name;
            hat.transform.position = figure.Hat.transform.position;
            hat.transform.rotation = figure.Hat.transform.rotation;
            // The armature lies in centimetres, its twins in metres.
            float scale = figure.Hat.transform.lossyScale.x / hat.transform.lossyScale.x;
            hat.transform.localScale *= scale;
            return hat;
        }

        [Test]
        public void an_outfit_of_a_real_character_fits()
        {
            const string file = "makehuman_female_vrm1.vrm";
            if (!Models.Has(file)) return;
            foreach (string cloth in new[] { "cloth_tights", "cloth_skirt" })
            {
                Model merged = Models.Load(file);
                float height = Models.Height(merged.Root);
                Vector3[] wanted = Converted(merged.Root, cloth);
                Model dressed = Models.Load(file);
                Transform hips = HumanoidRoles.Of(dressed.Root.GetComponent<Animator>())[0];
                var twins = Wardrobe.Armature(dressed.Root, hips, name => name);
                Wardrobe.Bind(ConversionTests.Find(dressed.Root, cloth).GetComponent<SkinnedMeshRenderer>(), twins);
                double apart = Drawing.Apart(wanted, Converted(dressed.Root, cloth)) / height;
                Console.WriteLine(cloth + ": at most " + apart.ToString("0.00E0") + " of the height apart");
                Assert.That(apart, Is.LessThan(1e-3), cloth);
            }
        }

        [Test]
        public void a_body_on_the_second_armature_is_a_body()
        {
            Models.NewProject();
            var figure = new ConversionFigure().Make();
            var twins = Wardrobe.Armature(figure.Root, figure.Bones[HumanBodyBones.Hips], name => name);
            Wardrobe.Bind(figure.Body, twins);
            Wardrobe.Bind(figure.Hair, twins);
            Assert.That(AvatarChecks.Of(figure.Root).FindAll(finding => finding.Severity == Severity.Error), Is.Empty);
        }

        static Vector3[] Shown(PreviewSession session, string name)
        {
            SkinnedMeshRenderer renderer = Array.Find(session.Proxy.GetComponentsInChildren<SkinnedMeshRenderer>(), one => one.name == name);
            Vector3[] positions, normals;
            Skinning.Drawn(renderer, session.Proxy.transform.worldToLocalMatrix, out positions, out normals);
            return positions;
        }

        [Test]
        public void an_outfit_bends_with_the_body_in_the_preview()
        {
            Models.NewProject();
            SkinnedMeshRenderer coat;
            ConversionFigure figure = Figure(out coat);
            Wardrobe.Bind(coat, Wardrobe.Armature(figure.Root, figure.Bones[HumanBodyBones.Hips], name => name));
            using (var session = new PreviewSession(figure.Root, Settings()))
            {
                session.Pose = PreviewPose.Sits;
                Vector3[] body = Shown(session, "Body"), cloth = Shown(session, "Coat");
                // 1.5 cm larger as it was made, less as it is shown.
                Assert.That(Drawing.Apart(body, cloth), Is.LessThan(0.05));
            }
        }
    }
}
