using System;
using System.Collections.Generic;
using nadena.dev.ndmf;
using nadena.dev.ndmf.preview;
using NUnit.Framework;
using SuperDeform.Editor.Ndmf;
using UnityEditor;
using UnityEngine;
using UnityStubs;

namespace SuperDeform.Editor.Tests
{
    /// <summary>The component on an avatar, and what a build by NDMF makes of it.</summary>
    [TestFixture]
    public class NdmfTests
    {
        ConversionFigure figure;
        SuperDeformAvatar component;

        [SetUp]
        public void Begin()
        {
            Models.NewProject();
            figure = new ConversionFigure { Turned = true, WithShapes = true }.Make();
            component = figure.Root.AddComponent<SuperDeformAvatar>();
            SettingsText.Give(component, Settings());
        }

        static ConversionSettings Settings()
        {
            var settings = new ConversionSettings { Heads = 3, OutputFolder = "Assets/Out", PlaceInScene = false };
            settings.Options.HeadScale = 1.2;
            GroupTunings.Change(settings, "upper_leg", tuned => tuned.LengthScale = 0.7);
            return settings;
        }

        static GameObject Clone(GameObject avatar)
        {
            GameObject clone = UnityEngine.Object.Instantiate(avatar);
            clone.name = avatar.name + "(Clone)";
            return clone;
        }

        [Test]
        public void the_pass_runs_after_outfits_are_merged_and_before_the_floor_is_measured()
        {
            string order = NdmfStub.Build<SuperDeformPlugin>(new GameObject("Nobody"));
            Assert.AreEqual("Transforming after nadena.dev.modular-avatar, net.rs64.tex-trans-tool before "
                + "nadena.dev.modular-avatar.late-transform-stages, net.narazaka.vrchat.floor_adjuster", order);
            Assert.That(typeof(SuperDeformPlugin).IsDefined(typeof(RunsOnAllPlatforms), false));
            Assert.AreEqual(typeof(SuperDeformPlugin), ((ExportsPlugin)typeof(SuperDeformPlugin).Assembly.GetCustomAttributes(typeof(ExportsPlugin), false)[0]).PluginType);
        }

        [Test]
        public void a_build_gives_what_the_converter_gives()
        {
            figure.Root.AddComponent<VRC.Core.PipelineManager>();
            var phys = figure.Bones[HumanBodyBones.Head].gameObject.AddComponent<VRC.SDK3.Dynamics.PhysBone.Components.VRCPhysBone>();
            string before = Fingerprint.Of(figure.Root);
            GameObject prefab = Converter.Convert(figure.Root, Settings(), null).Prefab;
            GameObject clone = Clone(figure.Root);
            Avatar old = clone.GetComponent<Animator>().avatar;
            NdmfStub.Build<SuperDeformPlugin>(clone);
            Assert.That(NdmfStub.Report.FindAll(line => line.StartsWith("Error") || line.StartsWith("Internal")), Is.Empty);
            Assert.AreEqual(before, Fingerprint.Of(figure.Root));
            foreach (string name in new[] { "Body", "Hair", "Hat" })
            {
                Assert.AreEqual(Drawing.Drawn(prefab, name), Drawing.Drawn(clone, name), name);
                Mesh made = Models.MeshOf(ConversionTests.Find(clone, name).GetComponent<Renderer>());
                Assert.That(NdmfStub.Saved.Contains(made), name);
                Assert.That(NdmfStub.Replaced.Exists(pair => pair.Value == made && pair.Key == Models.MeshOf(ConversionTests.Find(figure.Root, name).GetComponent<Renderer>())), name);
            }
            foreach (Transform bone in figure.Bones.Values)
            {
                Assert.AreEqual(ConversionTests.Find(prefab, bone.name).localPosition, ConversionTests.Find(clone, bone.name).localPosition, bone.name);
            }
            Avatar avatar = clone.GetComponent<Animator>().avatar, saved = prefab.GetComponent<Animator>().avatar;
            Assert.AreNotSame(old, avatar);
            Assert.That(NdmfStub.Saved.Contains(avatar));
            for (int bone = 0; bone < saved.humanDescription.skeleton.Length; bone++)
            {
                Assert.AreEqual(saved.humanDescription.skeleton[bone].position, avatar.humanDescription.skeleton[bone].position);
            }
            Assert.AreEqual("avtr_1", clone.GetComponent<VRC.Core.PipelineManager>().blueprintId, "the same avatar to the server");
            Assert.AreEqual("", prefab.GetComponent<VRC.Core.PipelineManager>().blueprintId, "another avatar");
            var made2 = clone.GetComponentInChildren<VRC.SDK3.Dynamics.PhysBone.Components.VRCPhysBone>();
            Assert.AreEqual(prefab.GetComponentInChildren<VRC.SDK3.Dynamics.PhysBone.Components.VRCPhysBone>().radius, made2.radius);
            Assert.AreNotEqual(phys.radius, made2.radius);
            Assert.That(clone.GetComponent<SuperDeformAvatar>(), Is.Null);
        }

        [Test]
        public void an_avatar_without_the_component_stays_as_it_is()
        {
            UnityEngine.Object.DestroyImmediate(component);
            GameObject clone = Clone(figure.Root);
            // NDMF marks what it builds.
            clone.AddComponent<nadena.dev.ndmf.runtime.components.NDMFAvatarRoot>();
            string before = Fingerprint.Of(clone);
            NdmfStub.Build<SuperDeformPlugin>(clone);
            Assert.AreEqual(before, Fingerprint.Of(clone));
        }

        [Test]
        public void what_cannot_be_done_stands_in_the_report_and_the_component_goes()
        {
            figure.Root.transform.Find("Armature").rotation = Quaternion.Euler(0, 0, 90);
            foreach (SkinnedMeshRenderer renderer in figure.Root.GetComponentsInChildren<SkinnedMeshRenderer>())
            {
                UnityEngine.Object.DestroyImmediate(renderer.gameObject);
            }
            UnityEngine.Object.DestroyImmediate(figure.Hat.gameObject);
            GameObject clone = Clone(figure.Root);
            NdmfStub.Build<SuperDeformPlugin>(clone);
            Assert.AreEqual(1, NdmfStub.Report.Count);
            StringAssert.StartsWith("Error: Super Deform: ", NdmfStub.Report[0]);
            StringAssert.Contains("shows no mesh", NdmfStub.Report[0]);
            Assert.That(clone.GetComponent<SuperDeformAvatar>(), Is.Null);
        }

        [Test]
        public void warnings_stand_in_the_report()
        {
            figure.Bones[HumanBodyBones.Head].gameObject.AddComponent<SomebodyElse.Tail>();
            NdmfStub.Build<SuperDeformPlugin>(Clone(figure.Root));
            StringAssert.StartsWith("NonFatal: Super Deform: Tail on J_Head", NdmfStub.Report.Find(line => line.Contains("Tail")));
        }

        [Test]
        public void a_component_below_the_root_is_refused()
        {
            UnityEngine.Object.DestroyImmediate(component);
            figure.Body.gameObject.AddComponent<SuperDeformAvatar>();
            NdmfStub.Build<SuperDeformPlugin>(Clone(figure.Root));
            Assert.AreEqual(1, NdmfStub.Report.Count);
            StringAssert.Contains("Body", NdmfStub.Report[0]);
        }

        [Test]
        public void settings_come_back_from_their_text()
        {
            ConversionSettings settings = Settings();
            settings.Options.FaceSquash = 0.25;
            settings.Options.Height = double.NaN;
            settings.Options.RigJoints.Add(new GivenJoint { Role = HumanoidRole.Head });
            settings.RigAuto = true;
            settings.BuiltInStyle = "sd4";
            string text = SettingsText.Write(settings);
            ConversionSettings back = SettingsText.Read(text);
            Assert.AreEqual(text, SettingsText.Write(back));
            Assert.AreEqual(1.2, back.Options.HeadScale);
            Assert.AreEqual(0.7, GroupTunings.Of(back, "upper_leg").LengthScale);
            Assert.That(double.IsNaN(GroupTunings.Of(back, "upper_leg").ThicknessScale));
            Assert.That(double.IsNaN(back.Options.Height));
            Assert.AreEqual(HumanoidRole.Head, back.Options.RigJoints[0].Role);
            StringAssert.Contains("Options.HeadScale = 1.2\n", text);
            StringAssert.DoesNotContain("HairLength", text);
            Assert.AreEqual("", SettingsText.Write(SettingsText.Read("")));
            // What another version says is passed over.
            ConversionSettings other = SettingsText.Read("Options.NoSuch = 3\nNothing\nHeads = many\nOptions.HeadScale.X = 2\nOptions.Groups.7.LengthScale = 1\nBlend = 0.5\n");
            Assert.AreEqual(0.5f, other.Blend);
            Assert.AreEqual(0, other.Options.Groups.Count);
        }

        [Test]
        public void the_inspector_changes_the_component_alone_and_can_be_undone()
        {
            var inspector = (SuperDeformAvatarEditor)UnityEditor.Editor.CreateEditor(component, typeof(SuperDeformAvatarEditor));
            string avatar = Fingerprint.Of(figure.Body.sharedMesh);
            Gui.Pass(inspector.OnInspectorGUI);
            Assert.That(Gui.Drawn.Exists(line => line.Contains(Strings.Get("component.no_ndmf"))));
            string before = component.Settings;
            var sections = inspector.Model.Sections;
            var amount = (SliderRow)sections[(int)SectionId.FineTuning].Rows.Find(row => row.Label == Strings.Get("option.amount"));
            amount.Set(0.5f);
            Assert.AreEqual(0.5, SettingsText.Of(component).Options.Amount);
            Undo.PerformUndo();
            Assert.AreEqual(before, component.Settings);
            Assert.AreEqual(1, inspector.Model.Settings.Options.Amount);
            // Unity does so when scripts have loaded.
            SuperDeformPlugin.YieldToPreview();
            inspector.Model.PreviewOn = true;
            inspector.Model.Touch();
            StubEditor.Tick();
            Assert.That(inspector.Controller.Preview, Is.Not.Null);
            Assert.AreEqual(1, NDMFPreview.DisablePreviewDepth, "NDMF's own previews rest");
            UnityEngine.Object.DestroyImmediate(inspector);
            Assert.AreEqual(0, NDMFPreview.DisablePreviewDepth);
            Assert.AreEqual(avatar, Fingerprint.Of(figure.Body.sharedMesh));
            Assert.That(figure.Body.forceRenderingOff, Is.False);
        }

        [Test]
        public void the_inspector_makes_a_prefab_too()
        {
            var inspector = (SuperDeformAvatarEditor)UnityEditor.Editor.CreateEditor(component, typeof(SuperDeformAvatarEditor));
            Gui.Press.Add(Strings.Get("component.convert"));
            Gui.Pass(inspector.OnInspectorGUI);
            StubEditor.Tick();
            Assert.That(inspector.Model.Result, Is.Not.Null, inspector.Model.Failure == null ? "" : inspector.Model.Failure.Text);
            UnityEngine.Object.DestroyImmediate(inspector);
        }

        [Test]
        public void the_language_of_ndmf_is_followed()
        {
            try
            {
                NdmfLanguage.Follow();
                foreach (string[] pair in new[] { new[] { "ja-JP", "ja" }, new[] { "ko-KR", "ko" }, new[] { "zh-Hans", "zh" }, new[] { "zh-Hant", "en" }, new[] { "de-DE", "en" }, new[] { "en-US", "en" } })
                {
                    nadena.dev.ndmf.localization.LanguagePrefs.Language = pair[0];
                    Assert.AreEqual(pair[1], Strings.Language, pair[0]);
                }
            }
            finally
            {
                nadena.dev.ndmf.localization.LanguagePrefs.Language = "en-us";
                Strings.Language = "en";
            }
        }
    }
}
