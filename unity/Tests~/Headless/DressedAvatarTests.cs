using System;
using System.Collections.Generic;
using nadena.dev.modular_avatar.core;
using nadena.dev.ndmf;
using nadena.dev.ndmf.preview;
using NUnit.Framework;
using SuperDeform.Editor.Ndmf;
using UnityEditor;
using UnityEngine;
using UnityStubs;
using VRC.SDK3.Avatars.Components;
using VRC.SDK3.Dynamics.Contact.Components;
using VRC.SDK3.Dynamics.PhysBone.Components;

namespace SuperDeform.Editor.Tests
{
    /// <summary>
    /// A made-up avatar as artists have them, through each of the four ways to convert: body with a shrink shape at 100, two
    /// outfits with armatures of their own, PhysBones, colliders, contacts, descriptor, lilToon's outlines.
    /// </summary>
    [TestFixture]
    public class DressedAvatarTests
    {
        const float Height = 1.9f, Thick = 0.015f;
        ConversionFigure figure;
        Vector3[] wantedCoat, wantedHair;
        Dictionary<string, double[]> before, wantedLengths;
        float ratio;

        static ConversionSettings Settings()
        {
            return new ConversionSettings { Source = StyleSource.BuiltIn, BuiltInStyle = "sd2.5", OutputFolder = "Assets/Out", PlaceInScene = false };
        }

        [SetUp]
        public void Begin()
        {
            Models.NewProject();
            ComponentTableTests.Ask(null);
            // What the same clothes do on the avatar's own armature.
            var merged = new ConversionFigure { WithShapes = true }.Make();
            Wardrobe.Coat(merged, Thick);
            AddComponents(merged);
            ConversionResult wanted = Converter.Convert(merged.Root, Settings(), null);
            wantedCoat = Drawing.Drawn(wanted.Prefab, "Coat");
            wantedHair = Drawing.Drawn(wanted.Prefab, "Hair");
            wantedLengths = Lengths(wanted.Prefab);
            ratio = (float)(wanted.Report.Result.Height / wanted.Report.Target.Height);

            Models.NewProject();
            figure = new ConversionFigure { WithShapes = true }.Make();
            Transform hips = figure.Bones[HumanBodyBones.Hips];
            SkinnedMeshRenderer coat = Wardrobe.Coat(figure, Thick);
            // One outfit set up with Modular Avatar, one as it was bought: a humanoid with names of its own.
            var first = Wardrobe.Armature(figure.Root, hips, name => name + ".coat");
            Wardrobe.Bind(coat, first);
            Transform outfit = figure.Root.transform.Find("Outfit");
            outfit.name = "CoatOutfit";
            var merge = outfit.GetChild(0).gameObject.AddComponent<ModularAvatarMergeArmature>();
            merge.mergeTarget.referencePath = "Armature";
            merge.suffix = ".coat";
            int number = 0;
            var second = Wardrobe.Armature(figure.Root, hips, name => "bone" + number++);
            Wardrobe.Bind(figure.Hair, second);
            Wardrobe.MakeHumanoid(figure.Root.transform.Find("Outfit").gameObject, figure.Bones, second);
            figure.Body.SetBlendShapeWeight(1, 100);
            AddComponents(figure);
            before = Lengths(figure.Root);
        }

        static void AddComponents(ConversionFigure figure)
        {
            var left = new GameObject("LeftEye").transform;
            var right = new GameObject("RightEye").transform;
            left.SetParent(figure.Bones[HumanBodyBones.Head], false);
            right.SetParent(figure.Bones[HumanBodyBones.Head], false);
            left.position = new Vector3(-0.03f, 1.7f, 0.08f);
            right.position = new Vector3(0.03f, 1.7f, 0.08f);
            var descriptor = figure.Root.AddComponent<VRCAvatarDescriptor>();
            descriptor.ViewPosition = new Vector3(0, 1.7f, 0.08f);
            descriptor.collider_head.transform = figure.Bones[HumanBodyBones.Head];
            figure.Root.AddComponent<VRC.Core.PipelineManager>();
            figure.Bones[HumanBodyBones.Head].gameObject.AddComponent<VRCPhysBone>();
            figure.Bones[HumanBodyBones.Chest].gameObject.AddComponent<VRCPhysBoneCollider>();
            figure.Bones[HumanBodyBones.LeftHand].gameObject.AddComponent<VRCContactSender>();
            figure.Bones[HumanBodyBones.RightHand].gameObject.AddComponent<VRCContactReceiver>();
            var paint = new Material(Shader.Find("lilToon")) { name = "Skin lil" };
            paint.SetFloat("_OutlineWidth", 0.08f);
            StubProject.Import("Assets/Skin lil.mat", paint);
            figure.Body.sharedMaterials = new[] { paint, paint };
        }

        /// <summary>Every number of the components of the table, by component and path.</summary>
        static Dictionary<string, double[]> Lengths(GameObject root)
        {
            var types = new HashSet<string>(ComponentTable.Types);
            var found = new Dictionary<string, double[]>();
            foreach (Component component in root.GetComponentsInChildren<Component>(true))
            {
                if (!types.Contains(component.GetType().FullName)) continue;
                using (var properties = new SerializedObject(component))
                {
                    SerializedProperty property = properties.GetIterator();
                    while (property.Next(property.propertyPath.Length == 0 || property.propertyType == SerializedPropertyType.Generic))
                    {
                        double[] numbers = Numbers(property);
                        if (numbers != null) found.Add(component.GetType().Name + "." + property.propertyPath, numbers);
                    }
                }
            }
            return found;
        }

        static double[] Numbers(SerializedProperty property)
        {
            switch (property.propertyType)
            {
                case SerializedPropertyType.Float: return new double[] { property.floatValue };
                case SerializedPropertyType.Vector3: return new double[] { property.vector3Value.x, property.vector3Value.y, property.vector3Value.z };
                case SerializedPropertyType.Quaternion:
                    Quaternion turn = property.quaternionValue;
                    return new double[] { turn.x, turn.y, turn.z, turn.w };
                default: return null;
            }
        }

        void IsDressed(GameObject result, string how)
        {
            double coat = Drawing.Apart(wantedCoat, Drawing.Drawn(result, "Coat")), hair = Drawing.Apart(wantedHair, Drawing.Drawn(result, "Hair"));
            Vector3 eyes = (ConversionTests.Find(result, "LeftEye").position + ConversionTests.Find(result, "RightEye").position) * 0.5f - result.transform.position;
            float view = Vector3.Distance(eyes, result.GetComponent<VRCAvatarDescriptor>().ViewPosition);
            Console.WriteLine(how + ": coat " + (coat / Height).ToString("0.0E0") + ", hair " + (hair / Height).ToString("0.0E0") + ", view " + (view / Height).ToString("0.0E0") + " of the height off");
            Assert.That(coat, Is.LessThan(1e-3 * Height), how);
            Assert.That(hair, Is.LessThan(1e-3 * Height), how);
            Assert.That(view, Is.LessThan(2e-3f * Height), how);
            Assert.AreEqual(0.08f * ratio, ConversionTests.Find(result, "Body").GetComponent<SkinnedMeshRenderer>().sharedMaterial.GetFloat("_OutlineWidth"), 1e-3, how);
            Assert.AreEqual(100, ConversionTests.Find(result, "Body").GetComponent<SkinnedMeshRenderer>().GetBlendShapeWeight(1), how);
            // As on the avatar whose clothes are merged; that each number is what it should be, the table's own tests say.
            Dictionary<string, double[]> lengths = Lengths(result);
            CollectionAssert.AreEquivalent(wantedLengths.Keys, lengths.Keys, how);
            foreach (string name in wantedLengths.Keys)
            {
                for (int i = 0; i < wantedLengths[name].Length; i++)
                {
                    Assert.AreEqual(wantedLengths[name][i], lengths[name][i], 1e-4, how + ": " + name);
                }
            }
            foreach (string changed in new[] { "VRCPhysBone.radius", "VRCPhysBone.endpointPosition", "VRCPhysBoneCollider.radius", "VRCPhysBoneCollider.height",
                "VRCContactSender.radius", "VRCContactReceiver.position", "VRCAvatarDescriptor.collider_head.radius", "VRCAvatarDescriptor.ViewPosition" })
            {
                CollectionAssert.AreNotEqual(before[changed], lengths[changed], how + ": " + changed);
            }
        }

        [Test]
        public void it_comes_out_dressed_by_the_window_the_menu_a_batch_and_a_build()
        {
            string source = Fingerprint.Of(figure.Root);
            var findings = AvatarChecks.Of(figure.Root);
            Assert.That(findings.FindAll(finding => finding.Severity == Severity.Error), Is.Empty);
            Assert.That(findings.Exists(finding => finding.Key == "outfit"));

            ConverterWindow window = ConverterWindow.Open(figure.Root);
            window.Model.Settings = Settings();
            window.Model.Touch();
            window.Model.Convert();
            StubEditor.Tick();
            Assert.That(window.Model.Failure, Is.Null, window.Model.Failure == null ? "" : window.Model.Failure.Text);
            string path = window.Model.Result.PrefabPath, guid = AssetDatabase.AssetPathToGUID(path);
            IsDressed(window.Model.Result.Prefab, "window");

            Selection.activeGameObject = figure.Root;
            Assert.That(MenuItems.CanConvertSelected());
            MenuItems.ConvertSelected();
            IsDressed(AssetDatabase.LoadAssetAtPath<GameObject>(path), "menu command, a second time");
            window.Close();

            BatchReport report = BatchConvert.Convert(new[] { figure.Root }, Settings());
            Assert.AreEqual(0, report.Failed);
            Assert.AreEqual(path, report.Entries[0].Result.PrefabPath);
            Assert.That(report.Entries[0].Result.Updated);
            Assert.AreEqual(guid, AssetDatabase.AssetPathToGUID(path), "the same prefab to whatever refers to it");
            IsDressed(report.Entries[0].Result.Prefab, "batch, a third time");

            // Before outfits are merged, as where another tool merges them later, and after.
            foreach (Action<BuildContext> merge in new Action<BuildContext>[] { null, ModularAvatarStub.Process })
            {
                GameObject clone = UnityEngine.Object.Instantiate(figure.Root);
                SettingsText.Give(clone.AddComponent<SuperDeformAvatar>(), Settings());
                NdmfStub.Build<SuperDeformPlugin>(clone, merge);
                Assert.That(NdmfStub.Uploads, string.Join("\n", NdmfStub.Report));
                IsDressed(clone, merge == null ? "NDMF" : "NDMF, after Modular Avatar");
                Assert.AreEqual("avtr_1", clone.GetComponent<VRC.Core.PipelineManager>().blueprintId);
            }
            Assert.AreEqual(source, Fingerprint.Of(figure.Root), "the source");

            SettingsText.Give(figure.Root.AddComponent<SuperDeformAvatar>(), Settings());
            using (NdmfPreviewStub preview = NdmfPreviewStub.Of(NdmfStub.Filters[0]))
            {
                preview.Frame();
                var coat = ConversionTests.Find(figure.Root, "Coat").GetComponent<Renderer>();
                Vector3[] shown = Drawing.Drawn(preview.Proxy(coat), figure.Root.transform.worldToLocalMatrix);
                Assert.That(Drawing.Apart(wantedCoat, shown), Is.LessThan(1e-3 * Height), "NDMF's preview");
            }
            NdmfPreviewStub.CloseScene();
        }
    }
}
