using System;
using System.Collections.Generic;
using System.IO;
using nadena.dev.modular_avatar.core;
using nadena.dev.ndmf;
using nadena.dev.ndmf.preview;
using NUnit.Framework;
using SuperDeform.Editor.Ndmf;
using UnityEditor;
using UnityEngine;
using UnityStubs;

namespace SuperDeform.Editor.Tests
{
    /// <summary>An upload is never stopped for what can ride along, and an avatar that cannot be converted is left as it was.</summary>
    [TestFixture]
    public class BuildTests
    {
        const float Height = 1.9f;
        ConversionFigure figure;

        static ConversionSettings Settings()
        {
            return new ConversionSettings { Heads = 2.5f, OutputFolder = "Assets/Out", PlaceInScene = false };
        }

        [SetUp]
        public void Begin()
        {
            Models.NewProject();
            NdmfStub.Refuse = null;
            figure = new ConversionFigure { WithShapes = true }.Make();
        }

        [TearDown]
        public void End()
        {
            NdmfStub.Refuse = null;
        }

        /// <summary>A bought outfit: a humanoid itself, set up with Modular Avatar.</summary>
        SkinnedMeshRenderer Dress()
        {
            SkinnedMeshRenderer coat = Wardrobe.Coat(figure, 0.015f);
            var twins = Wardrobe.Armature(figure.Root, figure.Bones[HumanBodyBones.Hips], name => name + ".coat");
            Wardrobe.Bind(coat, twins);
            Transform outfit = figure.Root.transform.Find("Outfit");
            coat.transform.SetParent(outfit, true);
            Wardrobe.MakeHumanoid(outfit.gameObject, figure.Bones, twins);
            // As Unity does where the avatar has been drawn: from then on the Animator knows its bones, wherever they go.
            outfit.GetComponent<Animator>().GetBoneTransform(HumanBodyBones.Hips);
            var merge = outfit.GetChild(0).gameObject.AddComponent<ModularAvatarMergeArmature>();
            merge.mergeTarget.referencePath = "Armature";
            merge.suffix = ".coat";
            return coat;
        }

        GameObject Built(Action<BuildContext> earlier = null)
        {
            GameObject clone = UnityEngine.Object.Instantiate(figure.Root);
            clone.name = figure.Root.name + "(Clone)";
            SettingsText.Give(clone.AddComponent<SuperDeformAvatar>(), Settings());
            NdmfStub.Build<SuperDeformPlugin>(clone, earlier);
            return clone;
        }

        static string Said()
        {
            return string.Join("\n", NdmfStub.Report);
        }

        [Test]
        public void a_merged_outfit_that_keeps_its_animator_is_no_second_avatar()
        {
            Dress();
            Vector3[] wanted = Drawing.Drawn(Built(), "Coat");
            Assert.That(NdmfStub.Uploads, Said());
            GameObject built = Built(ModularAvatarStub.Process);
            Assert.That(NdmfStub.Uploads, Said());
            Assert.That(built.transform.Find("Outfit").GetComponent<Animator>(), Is.Not.Null);
            Assert.That(built.transform.Find("Outfit/Armature.1"), Is.Null, "its bones are gone");
            Assert.That(Drawing.Apart(wanted, Drawing.Drawn(built, "Coat")), Is.LessThan(1e-3 * Height));
            Assert.That(NdmfStub.Report.FindAll(line => line.Contains("Outfit")), Is.Empty, Said());
        }

        [Test]
        public void an_avatar_that_was_merged_by_hand_converts_and_speaks_for_itself()
        {
            Dress();
            // The avatar lies within an object that is none itself, as when several are kept together.
            var folder = new GameObject("Folder");
            ModularAvatarStub.Process(new BuildContext(figure.Root, null));
            figure.Root.transform.SetParent(folder.transform, false);
            Assert.AreSame(figure.Root.GetComponent<Animator>(), HumanoidRoles.Speaker(folder));
            Assert.That(AvatarChecks.Of(folder).FindAll(finding => finding.Severity == Severity.Error), Is.Empty);
            Assert.That(Converter.Convert(figure.Root, Settings(), null).Prefab, Is.Not.Null);
        }

        static readonly string[] places = { "Beside", "Shoulder" };

        [Test]
        public void a_pet_that_is_a_humanoid_rides_along_in_its_own_shape([ValueSource("places")] string where)
        {
            var other = new ConversionFigure().Make();
            Transform pet = other.Root.transform;
            pet.name = "Pet";
            foreach (Renderer renderer in pet.GetComponentsInChildren<Renderer>(true)) renderer.name = "Pet" + renderer.name;
            pet.SetParent(where == "Beside" ? figure.Root.transform : figure.Bones[HumanBodyBones.LeftUpperArm], false);
            pet.localScale = Vector3.one * 0.15f;
            pet.position = where == "Beside" ? new Vector3(0.6f, 0, 0) : new Vector3(-0.18f, 1.52f, 0);
            Vector3[] before = Drawing.Drawn(figure.Root, "PetBody");
            GameObject built = Built();
            Assert.That(NdmfStub.Uploads, Said());
            StringAssert.StartsWith("NonFatal", NdmfStub.Report.Find(line => line.Contains("Pet is a humanoid of its own")), Said());
            Vector3[] after = Drawing.Drawn(built, "PetBody");
            double size, off = Drawing.OffSimilarity(before, after, out size);
            Console.WriteLine(where + ": " + size.ToString("0.00") + " times as large, off its shape by " + (off / Drawing.Extent(before)).ToString("0.0E0") + " of its height");
            Assert.That(off, Is.LessThan(1e-4 * Drawing.Extent(before)));
            Assert.AreEqual(Tall(built) / Tall(figure.Root), size, 1e-3, "it grows as the avatar does");
            // It goes where the shoulder goes that carries it.
            Vector3 shoulder = ConversionTests.Find(built, "J_LeftUpperArm").position, place = ConversionTests.Find(built, "Pet").position;
            if (where == "Shoulder") Assert.That(Vector3.Distance(shoulder, place), Is.LessThan(0.1));
            SettingsText.Give(figure.Root.AddComponent<SuperDeformAvatar>(), Settings());
            using (NdmfPreviewStub preview = NdmfPreviewStub.Of(NdmfStub.Filters[0]))
            {
                preview.Frame();
                var body = ConversionTests.Find(figure.Root, "PetBody").GetComponent<Renderer>();
                Assert.That(Drawing.Apart(after, Drawing.Drawn(preview.Proxy(body), figure.Root.transform.worldToLocalMatrix)), Is.LessThan(1e-5), "NDMF's preview");
            }
            NdmfPreviewStub.CloseScene();
            using (var session = new PreviewSession(figure.Root, Settings()))
            {
                var shown = Array.Find(session.Proxy.GetComponentsInChildren<SkinnedMeshRenderer>(), one => one.name == "PetBody");
                Assert.That(Drawing.Apart(after, Drawing.Drawn(shown, session.Proxy.transform.worldToLocalMatrix)), Is.LessThan(1e-5), "the window's preview");
            }
        }

        /// <summary>How tall the avatar is, without its pet.</summary>
        static double Tall(GameObject avatar)
        {
            var all = new List<Vector3>();
            foreach (string name in new[] { "Body", "Hair", "Hat" }) all.AddRange(Drawing.Drawn(avatar, name));
            return Drawing.Extent(all.ToArray());
        }

        [Test]
        public void a_mesh_that_two_renderers_show_is_registered_once()
        {
            // Eyes are drawn twice, to be seen through hair.
            SkinnedMeshRenderer twice = UnityEngine.Object.Instantiate(figure.Hair, figure.Root.transform);
            twice.name = "Hair again";
            GameObject built = Built();
            Assert.That(NdmfStub.Uploads, Said());
            Mesh made = ConversionTests.Find(built, "Hair").GetComponent<SkinnedMeshRenderer>().sharedMesh;
            Assert.AreSame(made, ConversionTests.Find(built, "Hair again").GetComponent<SkinnedMeshRenderer>().sharedMesh);
            Assert.AreEqual(1, NdmfStub.Replaced.FindAll(pair => pair.Value == made).Count);
        }

        [Test]
        public void a_mesh_with_a_bone_outside_of_the_avatar_stays_as_it_is()
        {
            var elsewhere = new GameObject("Elsewhere").transform;
            Transform[] bones = figure.Hair.bones;
            bones[bones.Length - 1] = elsewhere;
            figure.Hair.bones = bones;
            Mesh mesh = figure.Hair.sharedMesh;
            GameObject built = Built();
            Assert.That(NdmfStub.Uploads, Said());
            StringAssert.Contains("Elsewhere", NdmfStub.Report.Find(line => line.StartsWith("NonFatal") && line.Contains("Hair is moved by")));
            Assert.AreSame(mesh, ConversionTests.Find(built, "Hair").GetComponent<SkinnedMeshRenderer>().sharedMesh);
            Assert.AreNotSame(figure.Body.sharedMesh, ConversionTests.Find(built, "Body").GetComponent<SkinnedMeshRenderer>().sharedMesh);
        }

        [Test]
        public void what_fails_unforeseen_is_one_sentence_and_leaves_the_avatar_as_it_was()
        {
            figure.Bones[HumanBodyBones.Head].gameObject.AddComponent<VRC.SDK3.Dynamics.PhysBone.Components.VRCPhysBone>();
            Dress();
            int assets = 0;
            Built(context => NdmfStub.Refuse = asset => assets++);
            Assert.That(assets, Is.GreaterThan(3));
            // The disk is full at the first asset, at one in the middle, at the last.
            foreach (int limit in new[] { 0, assets / 2, assets - 1 })
            {
                GameObject clone = UnityEngine.Object.Instantiate(figure.Root);
                SettingsText.Give(clone.AddComponent<SuperDeformAvatar>(), Settings());
                int saved = 0;
                string before = null;
                NdmfStub.Build<SuperDeformPlugin>(clone, context =>
                {
                    before = Fingerprint.Of(WithoutComponent(clone));
                    NdmfStub.Refuse = asset =>
                    {
                        if (saved++ == limit) throw new IOException("there is not enough space on the disk");
                    };
                });
                NdmfStub.Refuse = null;
                Assert.AreEqual(1, NdmfStub.Report.Count, Said());
                StringAssert.StartsWith("Error: Super Deform: The avatar was not changed", NdmfStub.Report[0]);
                StringAssert.Contains("not enough space", NdmfStub.Report[0]);
                Assert.AreEqual(before, Fingerprint.Of(WithoutComponent(clone)), "after " + limit + " assets");
                Assert.That(clone.GetComponent<SuperDeformAvatar>(), Is.Null);
            }
        }

        /// <summary>A copy without this package's component, which goes in any case.</summary>
        static GameObject WithoutComponent(GameObject avatar)
        {
            GameObject copy = UnityEngine.Object.Instantiate(avatar);
            UnityEngine.Object.DestroyImmediate(copy.GetComponent<SuperDeformAvatar>());
            return copy;
        }

        [Test]
        public void a_person_who_waits_for_a_build_sees_how_far_it_is()
        {
            Settings_BatchMode(false);
            Built();
            Assert.That(Dialogs.Bars.Count, Is.GreaterThan(5));
            Assert.That(Dialogs.BarOpen, Is.False);
        }

        static void Settings_BatchMode(bool batch)
        {
            UnityStubs.Settings.BatchMode = batch;
        }

        [Test]
        public void a_scaled_joint_of_modular_avatar_keeps_its_scale()
        {
            figure.Bones[HumanBodyBones.Head].gameObject.AddComponent<ModularAvatarScaleAdjuster>().m_Scale = Vector3.one * 1.2f;
            GameObject built = Built(ModularAvatarStub.Process);
            Assert.That(NdmfStub.Uploads, Said());
            Transform proxy = ConversionTests.Find(built, "ScaleProxy");
            Assert.AreEqual(1.2f, proxy.lossyScale.x, 1e-5f);
            Assert.AreSame(ConversionTests.Find(built, "J_Head"), proxy.parent);
        }
    }
}
