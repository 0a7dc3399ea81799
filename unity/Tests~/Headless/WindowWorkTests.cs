using System;
using System.Collections.Generic;
using NUnit.Framework;
using UnityEditor;
using UnityEngine;
using UnityStubs;

namespace SuperDeform.Editor.Tests
{
    /// <summary>What makes work with the window go on: sliders at any width, ways back, settings as files, lists.</summary>
    [TestFixture]
    public class WindowWorkTests
    {
        ConversionFigure figure;
        ConverterWindow window;

        [SetUp]
        public void Begin()
        {
            Models.NewProject();
            Gui.Width = 440;
            figure = new ConversionFigure().Make();
            window = ConverterWindow.Open(figure.Root);
            for (int i = 0; i < window.Model.Open.Length; i++) window.Model.Open[i] = true;
            window.Model.Settings.OutputFolder = "Assets/Out";
            window.Model.Touch();
        }

        [TearDown]
        public void End()
        {
            Gui.Width = 440;
            window.Close();
        }

        void Draw()
        {
            Gui.Pass(() => typeof(ConverterWindow).GetMethod("OnGUI", System.Reflection.BindingFlags.Instance | System.Reflection.BindingFlags.NonPublic).Invoke(window, null));
        }

        List<SliderRow> Sliders()
        {
            var sliders = new List<SliderRow>();
            foreach (Row row in window.Model.Sections[(int)SectionId.FineTuning].Rows)
            {
                if (row is SliderRow) sliders.Add((SliderRow)row);
            }
            return sliders;
        }

        SliderRow Slider(string key)
        {
            return Sliders().Find(row => row.Label == Strings.Get(key));
        }

        [Test]
        public void every_slider_has_its_bar_at_every_width_of_the_window()
        {
            for (int width = (int)window.minSize.x; width <= 900; width += 10)
            {
                Gui.Width = width;
                Draw();
                Assert.That(Gui.Sliders, Is.GreaterThan(30));
                Assert.That(Gui.Barless, Is.Empty, "at " + width);
            }
        }

        [Test]
        public void every_option_of_the_body_and_the_face_has_a_slider_with_a_way_back()
        {
            foreach (string option in new[]
            {
                "amount", "head_scale", "profile", "hair_length", "height", "face_squash", "youth", "youth_eye", "youth_lower", "youth_nose",
                "youth_cheek", "youth_jaw", "youth_skull", "youth_ear", "smile", "seat", "hair_lay"
            })
            {
                SliderRow row = Slider("option." + option);
                Assert.That(row, Is.Not.Null, option);
                Assert.That(row.IsOwn(), Is.False, option);
                float usual = row.Get();
                row.Set(usual + 0.25f * (row.High - row.Low) <= row.High ? usual + 0.25f * (row.High - row.Low) : row.Low);
                row = Slider("option." + option);
                Assert.That(row.IsOwn(), option);
                row.Reset();
                Assert.AreEqual(usual, Slider("option." + option).Get(), 1e-6, option);
                Assert.That(Slider("option." + option).IsOwn(), Is.False, option);
            }
        }

        [Test]
        public void a_head_of_1_is_the_styles_own()
        {
            SliderRow head = Slider("option.head_scale");
            Assert.AreEqual(1, head.Get(), 1e-6);
            head.Set(1.2f);
            // The library counts from the paper's 1.5.
            Assert.AreEqual(1.8, window.Model.Settings.Options.HeadScale, 1e-6);
        }

        [Test]
        public void all_tuning_goes_back_at_once()
        {
            foreach (SliderRow row in Sliders()) row.Set(row.Low + 0.4f * (row.High - row.Low));
            GroupTunings.Change(window.Model.Settings, "hip", tuned => tuned.LengthScale = 0.8);
            window.Model.Settings.Options.RigVoxelResolution = 64;
            window.Model.Touch();
            ((ActionRow)window.Model.Sections[(int)SectionId.FineTuning].Rows.Find(row => row.Label == Strings.Get("tune.reset"))).Do();
            foreach (SliderRow row in Sliders()) Assert.That(row.IsOwn(), Is.False, row.Label);
            Assert.AreEqual(0, GroupTunings.Count(window.Model.Settings));
            Assert.AreEqual(64, window.Model.Settings.Options.RigVoxelResolution, "what a new rig is made by stays");
        }

        [Test]
        public void what_is_undone_can_be_done_again_and_the_preview_follows()
        {
            Undo.ClearAll();
            window.Controller.Tick(0);
            Undo.IncrementCurrentGroup();
            Slider("option.amount").Set(0.5f);
            Undo.IncrementCurrentGroup();
            Slider("option.head_scale").Set(1.2f);
            window.Controller.Tick(1);
            Vector3[] both = Shown();
            Undo.PerformUndo();
            window.Controller.Tick(2);
            Assert.AreEqual(1, Slider("option.head_scale").Get(), 1e-6);
            Assert.AreEqual(0.5f, Slider("option.amount").Get());
            Vector3[] one = Shown();
            Assert.AreNotEqual(both, one);
            Undo.PerformRedo();
            window.Controller.Tick(3);
            Assert.AreEqual(1.2f, Slider("option.head_scale").Get(), 1e-6);
            Assert.AreEqual(both, Shown());
            Undo.PerformUndo();
            Undo.PerformUndo();
            Assert.AreEqual(1, Slider("option.amount").Get());
        }

        Vector3[] Shown()
        {
            return Array.Find(window.Controller.Preview.Proxy.GetComponentsInChildren<SkinnedMeshRenderer>(true), one => one.name == "Body").sharedMesh.vertices;
        }

        [Test]
        public void settings_are_saved_and_loaded_as_files()
        {
            window.Model.Settings.Heads = 3.5f;
            window.Model.Settings.Source = StyleSource.Heads;
            Slider("option.amount").Set(0.5f);
            window.Controller.SavePreset("Assets/mine.asset");
            var preset = AssetDatabase.LoadAssetAtPath<SuperDeformPreset>("Assets/mine.asset");
            Slider("option.amount").Set(1);
            Assert.AreEqual(0.5, preset.Settings.Options.Amount);
            var load = (ObjectRow)window.Model.Sections[(int)SectionId.Style].Rows.Find(row => row.Label == Strings.Get("style.settings"));
            load.Set(preset);
            Assert.AreEqual(0.5, window.Model.Settings.Options.Amount);
            Assert.AreEqual(3.5f, window.Model.Settings.Heads);
            Assert.AreSame(figure.Root, window.Model.Avatar);
            Slider("option.amount").Set(0.25f);
            Assert.AreEqual(0.5, preset.Settings.Options.Amount, "the file is changed by its own Inspector alone");
            window.Controller.SavePreset("Assets/mine.asset");
            Assert.AreSame(preset, AssetDatabase.LoadAssetAtPath<SuperDeformPreset>("Assets/mine.asset"));
            Assert.AreEqual(0.25, preset.Settings.Options.Amount);
        }

        [Test]
        public void the_settings_of_a_result_can_be_loaded_too()
        {
            window.Model.Settings.Options.Amount = 0.75;
            ConversionResult result = Converter.Convert(figure.Root, window.Model.Settings, null);
            var preset = AssetDatabase.LoadAssetAtPath<SuperDeformPreset>(System.IO.Path.ChangeExtension(result.PrefabPath, ".asset"));
            window.Model.Settings.Options.Amount = 1;
            window.Model.Take(preset);
            Assert.AreEqual(0.75, window.Model.Settings.Options.Amount);
        }

        [Test]
        public void a_presets_inspector_shows_rows_and_no_raw_numbers()
        {
            window.Controller.SavePreset("Assets/mine.asset");
            var preset = AssetDatabase.LoadAssetAtPath<SuperDeformPreset>("Assets/mine.asset");
            var inspector = (SuperDeformPresetEditor)UnityEditor.Editor.CreateEditor(preset, typeof(SuperDeformPresetEditor));
            Gui.Pass(inspector.OnInspectorGUI);
            Assert.That(Gui.Drawn.Exists(line => line.Contains(Strings.Get("option.amount"))));
            Assert.That(Gui.Drawn.Exists(line => line.Contains("NaN")), Is.False);
            var amount = (SliderRow)inspector.Model.Sections[(int)SectionId.FineTuning].Rows.Find(row => row.Label == Strings.Get("option.amount"));
            amount.Set(0.3f);
            Assert.AreEqual(0.3, preset.Settings.Options.Amount, 1e-6);
            Gui.Press.Add(Strings.Get("preset.use"));
            Gui.Pass(inspector.OnInspectorGUI);
            Assert.AreEqual(0.3, window.Model.Settings.Options.Amount, 1e-6);
            UnityEngine.Object.DestroyImmediate(inspector);
        }

        [Test]
        public void the_avatar_that_a_finding_names_is_chosen_by_its_button()
        {
            window.Model.SetAvatar(figure.Body.gameObject);
            var check = (CheckRow)window.Model.Sections[(int)SectionId.Avatar].Rows.Find(row => row is CheckRow && ((CheckRow)row).FixLabel == Strings.Get("fix_choose"));
            check.Fix();
            Assert.AreSame(figure.Root, window.Model.Avatar);
        }

        [Test]
        public void avatars_are_dropped_onto_the_batch_and_taken_off_one_by_one()
        {
            BatchWindow batch = BatchWindow.Open();
            GameObject other = new ConversionFigure().Make().Root;
            Action draw = () => Gui.Pass(() => typeof(BatchWindow).GetMethod("OnGUI", System.Reflection.BindingFlags.Instance | System.Reflection.BindingFlags.NonPublic).Invoke(batch, null));
            DragAndDrop.objectReferences = new UnityEngine.Object[] { figure.Root, other, figure.Body.sharedMesh };
            Event.current = new Event { type = EventType.DragUpdated };
            draw();
            Assert.AreEqual(0, batch.Avatars.Count);
            Assert.AreEqual(DragAndDropVisualMode.Copy, DragAndDrop.visualMode);
            Event.current = new Event { type = EventType.DragPerform };
            draw();
            CollectionAssert.AreEqual(new[] { figure.Root, other }, batch.Avatars);
            Event.current = null;
            Gui.Press.Add("\u00d7");
            draw();
            CollectionAssert.AreEqual(new[] { other }, batch.Avatars);
            batch.Close();
        }

        [Test]
        public void warnings_of_the_library_are_said_in_the_editors_language()
        {
            Finding warned = LibraryWarnings.Of(new ConversionWarning("open_body", "an English sentence").Made, null);
            Assert.AreEqual("warning.open_body", warned.Key);
            string english = warned.Text;
            Strings.Language = "ja";
            Assert.AreNotEqual(english, warned.Text);
            Strings.Language = "en";
            StringAssert.Contains("tail", LibraryWarnings.Of(new ConversionWarning("new_one", "something of the tail").Made, null).Text);
        }

        sealed class ConversionWarning
        {
            internal readonly Warning Made;

            internal ConversionWarning(string code, string text)
            {
                Made = (Warning)typeof(Warning).GetConstructor(System.Reflection.BindingFlags.Instance | System.Reflection.BindingFlags.NonPublic | System.Reflection.BindingFlags.Public,
                    null, new[] { typeof(string), typeof(string) }, null).Invoke(new object[] { code, text });
            }
        }
    }
}
