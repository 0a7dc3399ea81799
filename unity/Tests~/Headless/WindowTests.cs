using System;
using System.Collections.Generic;
using System.IO;
using NUnit.Framework;
using UnityEditor;
using UnityEngine;
using UnityStubs;

namespace SuperDeform.Editor.Tests
{
    [TestFixture]
    public class WindowTests
    {
        WindowFigure figure;
        ulong handles;

        [SetUp]
        public void Begin()
        {
            Models.NewProject();
            handles = SuperDeformLibrary.LiveHandles;
            figure = new WindowFigure("Mika", 3000);
        }

        [TearDown]
        public void NothingIsLeft()
        {
            foreach (ConverterWindow window in Resources.FindObjectsOfTypeAll<ConverterWindow>()) window.Close();
            Assert.AreEqual(handles, SuperDeformLibrary.LiveHandles, "live handles");
            Assert.IsFalse(Dialogs.BarOpen, "a progress bar is open");
        }

        static T Find<T>(ConverterModel model, SectionId section, string key) where T : Row
        {
            string label = Strings.Get(key);
            foreach (Row row in model.Sections[(int)section].Rows)
            {
                if (row is T && row.Label == label) return (T)row;
            }
            throw new AssertionException("there is no " + typeof(T).Name + " \"" + label + "\" in " + section);
        }

        static List<string> Labels(ConverterModel model, SectionId section)
        {
            return model.Sections[(int)section].Rows.ConvertAll(row => row.Label);
        }

        ConverterWindow Open()
        {
            ConverterWindow window = ConverterWindow.Open(null);
            window.Model.SetAvatar(figure.Root);
            return window;
        }

        // The editor's clock stands still in these tests: time is given.
        static void Settle(ConverterWindow window)
        {
            double now = 1e6;
            window.Controller.Tick(now);
            window.Controller.Tick(now + 1);
        }

        static void Tell(ConverterWindow window, string message)
        {
            const System.Reflection.BindingFlags own = System.Reflection.BindingFlags.Instance | System.Reflection.BindingFlags.NonPublic;
            typeof(ConverterWindow).GetMethod(message, own).Invoke(window, null);
        }

        static void Draw(ConverterWindow window)
        {
            Gui.Pass(() => Tell(window, "OnGUI"));
        }

        [Test]
        public void there_are_five_sections_in_their_order()
        {
            var model = new ConverterModel();
            Assert.AreEqual(5, model.Sections.Count);
            for (int i = 0; i < 5; i++)
            {
                Assert.AreEqual((SectionId)i, model.Sections[i].Id);
                StringAssert.StartsWith((i + 1) + "  ", model.Sections[i].Title);
            }
        }

        [Test]
        public void without_an_avatar_nothing_can_be_converted_and_the_window_says_what_to_do()
        {
            var model = new ConverterModel();
            Assert.IsFalse(model.CanConvert);
            CollectionAssert.Contains(Labels(model, SectionId.Avatar), Strings.Get("avatar.hint"));
            Assert.IsFalse(Find<ActionRow>(model, SectionId.Report, "report.convert").Enabled);
            CollectionAssert.Contains(Labels(model, SectionId.Report), Strings.Get("report.no_avatar"));
            bool asked = false;
            model.Converting += () => asked = true;
            model.Convert();
            Assert.IsFalse(asked);
        }

        [Test]
        public void an_error_of_the_checks_stands_with_its_fix_and_stops_the_conversion()
        {
            var model = new ConverterModel();
            StubProject.Import("Assets/Mika.fbx", figure.Body.sharedMesh);
            StubEditor.AddModelImporter("Assets/Mika.fbx", false);
            StubProject.SetReadable(figure.Body.sharedMesh, false);
            model.SetAvatar(figure.Root);
            CheckRow row = (CheckRow)model.Sections[0].Rows.Find(found => found is CheckRow && ((CheckRow)found).Severity == Severity.Error);
            Assert.AreEqual(Strings.Get("fix_readable"), row.FixLabel);
            Assert.IsFalse(model.CanConvert);
            CollectionAssert.Contains(Labels(model, SectionId.Report), Strings.Get("report.not_ready"));
        }

        [Test]
        public void a_fix_makes_the_window_look_again()
        {
            var model = new ConverterModel();
            model.SetAvatar(figure.Root);
            bool mended = false;
            var finding = new Finding("not_readable", Severity.Error, null, "a", "b").WithFix("fix_readable", () => mended = true);
            IList<Finding> before = model.Findings;
            ConverterSections.Check(model, finding).Fix();
            Assert.IsTrue(mended);
            Assert.AreNotSame(before, model.Findings);
        }

        [Test]
        public void a_preset_is_a_built_in_style_of_so_many_heads()
        {
            var model = new ConverterModel();
            ChoiceRow presets = Find<ChoiceRow>(model, SectionId.Style, "style.presets");
            Assert.AreEqual("2 heads 2.5 heads 3 heads 4 heads", string.Join(" ", presets.Choices));
            Assert.AreEqual(1, presets.Get());
            model.Settings.Blend = 0.5f;
            presets.Set(3);
            Assert.AreEqual(StyleSource.BuiltIn, model.Settings.Source);
            Assert.AreEqual("sd4", model.Settings.BuiltInStyle);
            Assert.AreEqual(4, model.Settings.Heads);
            Assert.AreEqual(0, model.Settings.Blend);
            Assert.AreEqual(-1, Find<ChoiceRow>(model, SectionId.Style, "style.source").Get());
        }

        [Test]
        public void each_source_of_a_style_shows_its_own_field()
        {
            var model = new ConverterModel();
            Find<ChoiceRow>(model, SectionId.Style, "style.source").Set(0);
            Assert.AreEqual(StyleSource.Heads, model.Settings.Source);
            Find<SliderRow>(model, SectionId.Style, "style.heads").Set(3.25f);
            Assert.AreEqual("3.25 heads", model.Sections[1].Summary);
            Find<ChoiceRow>(model, SectionId.Style, "style.source").Set(1);
            Assert.IsFalse(model.HasStyle);
            Assert.IsFalse(Find<ActionRow>(model, SectionId.Style, "style.save").Enabled);
            CollectionAssert.DoesNotContain(Labels(model, SectionId.Style), Strings.Get("style.heads"));
            Find<ObjectRow>(model, SectionId.Style, "style.reference").Set(figure.Root);
            Assert.IsTrue(model.HasStyle);
            Find<SliderRow>(model, SectionId.Style, "style.blend").Set(0.5f);
            Find<SliderRow>(model, SectionId.Style, "style.heads");
            Find<ChoiceRow>(model, SectionId.Style, "style.source").Set(2);
            Assert.AreEqual(typeof(TextAsset), Find<ObjectRow>(model, SectionId.Style, "style.saved").Type);
        }

        [Test]
        public void a_group_shows_what_the_style_found_until_it_is_moved_and_again_after_a_reset()
        {
            ConverterWindow window = Open();
            Settle(window);
            ConverterModel model = window.Model;
            Group found = Array.Find(model.Numbers.Groups, group => group.Name == "upper_leg");
            GroupRow row = (GroupRow)model.Sections[2].Rows.Find(candidate => candidate.Label == Strings.Get("group.upper_leg"));
            Assert.AreEqual((float)found.LengthScale, row.Sliders[0].Get());
            Assert.AreEqual((float)found.ThicknessScale, row.Sliders[1].Get());
            Assert.IsFalse(row.IsOwn);
            row.Sliders[0].Set(0.5f);
            Assert.AreEqual(0.5f, row.Sliders[0].Get());
            Assert.IsTrue(row.IsOwn);
            Assert.AreEqual("1 changed", model.Sections[2].Summary);
            row.Reset();
            Assert.AreEqual((float)found.LengthScale, row.Sliders[0].Get());
            Assert.AreEqual("", model.Sections[2].Summary);
        }

        [Test]
        public void every_slider_changes_what_it_says_within_its_bounds()
        {
            var model = new ConverterModel { RigOpen = true };
            model.SetAvatar(figure.Root);
            var rows = new List<Row>(model.Sections[0].Rows);
            rows.AddRange(model.Sections[2].Rows);
            int seen = 0;
            foreach (Row row in rows)
            {
                var sliders = new List<SliderRow>();
                if (row is SliderRow) sliders.Add((SliderRow)row);
                if (row is GroupRow) sliders.AddRange(Array.FindAll(((GroupRow)row).Sliders, slider => slider != null));
                foreach (SliderRow slider in sliders)
                {
                    foreach (float value in new[] { slider.Low, slider.High })
                    {
                        slider.Set(value);
                        Assert.AreEqual(value, slider.Get(), row.Label);
                        seen++;
                    }
                }
            }
            Assert.That(seen, Is.GreaterThan(40));
            // The library takes the bounds of all of them.
            using (var session = new PreviewSession(figure.Root, model.Settings)) Assert.IsTrue(session.IsAlive);
        }

        [Test]
        public void how_a_new_rig_is_made_unfolds_and_is_set()
        {
            var model = new ConverterModel();
            model.SetAvatar(figure.Root);
            CollectionAssert.DoesNotContain(Labels(model, SectionId.Avatar), Strings.Get("option.rig_heat"));
            Find<FoldoutRow>(model, SectionId.Avatar, "rig.more").Set(true);
            Assert.IsTrue(Find<FoldoutRow>(model, SectionId.Avatar, "rig.more").Get());
            Find<PopupRow>(model, SectionId.Avatar, "option.rig_weights").Set(2);
            Find<PopupRow>(model, SectionId.Avatar, "option.rig_garments").Set(1);
            Find<SliderRow>(model, SectionId.Avatar, "option.rig_heat").Set(2);
            Find<SliderRow>(model, SectionId.Avatar, "option.rig_voxel_resolution").Set(64.2f);
            Find<ToggleRow>(model, SectionId.Avatar, "option.rig_fingers").Set(false);
            Options options = model.Settings.Options;
            Assert.AreEqual(BodyWeights.Volume, options.RigWeights);
            Assert.AreEqual(GarmentWeights.Nearest, options.RigGarments);
            Assert.AreEqual(2.0, options.RigHeat);
            Assert.AreEqual(64u, options.RigVoxelResolution);
            Assert.IsFalse(options.RigFingers);
            foreach (PopupRow row in model.Sections[0].Rows.FindAll(found => found is PopupRow)) Assert.AreEqual(3, row.Choices.Length, row.Label);
        }

        [Test]
        public void resetting_takes_all_fine_tuning_of_parts_away()
        {
            var model = new ConverterModel();
            GroupTunings.Change(model.Settings, "head", head => head.LengthScale = 1.2);
            model.Touch();
            ActionRow reset = Find<ActionRow>(model, SectionId.FineTuning, "tune.reset");
            Assert.IsTrue(reset.Enabled);
            reset.Do();
            Assert.AreEqual(0, GroupTunings.Count(model.Settings));
            Assert.IsFalse(Find<ActionRow>(model, SectionId.FineTuning, "tune.reset").Enabled);
        }

        [Test]
        public void the_preview_follows_the_model()
        {
            ConverterWindow window = Open();
            Assert.IsNull(window.Controller.Preview);
            Settle(window);
            PreviewSession session = window.Controller.Preview;
            Assert.IsTrue(session.IsAlive);
            Find<ChoiceRow>(window.Model, SectionId.Preview, "preview.show").Set(0);
            Settle(window);
            Assert.AreSame(session, window.Controller.Preview);
            Assert.IsTrue(session.ShowBefore);
            Find<ToggleRow>(window.Model, SectionId.Preview, "preview.live").Set(false);
            Settle(window);
            Assert.IsNull(window.Controller.Preview);
            Assert.IsFalse(session.IsAlive);
        }

        [Test]
        public void the_result_is_measured_once_when_settings_rest()
        {
            ConverterWindow window = Open();
            Assert.IsTrue(window.Controller.Tick(10));
            Assert.IsNull(window.Model.Numbers);
            Assert.IsFalse(window.Controller.Tick(10.1));
            Assert.IsNull(window.Model.Numbers);
            Assert.IsTrue(window.Controller.Tick(10.5));
            Assert.IsNotNull(window.Model.Numbers);
            Assert.IsFalse(window.Controller.Tick(11));
        }

        [Test]
        public void a_style_that_cannot_be_is_told_and_mending_it_brings_the_preview_back()
        {
            ConverterWindow window = Open();
            Settle(window);
            window.Model.Change("undo.style", () =>
            {
                window.Model.Settings.Source = StyleSource.SavedStyle;
                window.Model.Settings.SavedStyle = new TextAsset("{ this is no style }");
            });
            Settle(window);
            Assert.IsNull(window.Controller.Preview);
            Assert.AreEqual("library_says", window.Model.PreviewFailure.Key);
            Assert.That(window.Model.Sections[4].Rows.Exists(row => row is CheckRow && ((CheckRow)row).Severity == Severity.Error));
            window.Model.Change("undo.style", () => window.Model.Settings.Source = StyleSource.BuiltIn);
            Settle(window);
            Assert.IsNull(window.Model.PreviewFailure);
            Assert.IsNotNull(window.Controller.Preview);
        }

        [Test]
        public void another_avatar_gets_another_preview_and_the_first_is_seen_again()
        {
            ConverterWindow window = Open();
            Settle(window);
            var other = new WindowFigure("Yuki", 3000);
            window.Model.SetAvatar(other.Root);
            Settle(window);
            Assert.IsFalse(figure.Body.forceRenderingOff);
            Assert.IsTrue(other.Body.forceRenderingOff);
        }

        [Test]
        public void a_deleted_avatar_is_no_fault()
        {
            ConverterWindow window = Open();
            Settle(window);
            UnityEngine.Object.DestroyImmediate(figure.Root);
            window.Model.Touch();
            Settle(window);
            Assert.IsNull(window.Controller.Preview);
            Assert.IsFalse(window.Model.CanConvert);
            Draw(window);
        }

        [Test]
        public void changes_can_be_undone_and_the_preview_follows()
        {
            ConverterWindow window = Open();
            Settle(window);
            // Unity does so with every press of the mouse.
            Undo.IncrementCurrentGroup();
            Find<ChoiceRow>(window.Model, SectionId.Style, "style.presets").Set(3);
            Settle(window);
            Assert.AreEqual("sd4", window.Model.Settings.BuiltInStyle);
            double after = window.Model.Numbers.Report.Result.Heads;
            Undo.PerformUndo();
            Assert.AreSame(figure.Root, window.Model.Avatar);
            Assert.AreEqual("sd2.5", window.Model.Settings.BuiltInStyle);
            Settle(window);
            Assert.AreNotEqual(after, window.Model.Numbers.Report.Result.Heads);
            // Still connected: presses count.
            Find<ToggleRow>(window.Model, SectionId.Preview, "preview.live").Set(false);
            Settle(window);
            Assert.IsNull(window.Controller.Preview);
        }

        [Test]
        public void the_preview_ends_before_scripts_reload_before_play_mode_and_on_closing()
        {
            ConverterWindow window = Open();
            Settle(window);
            StubEditor.ReloadScripts();
            Assert.IsFalse(figure.Body.forceRenderingOff, "reload");
            Assert.AreEqual(handles, SuperDeformLibrary.LiveHandles, "reload");
            window.Close();
            window = Open();
            Settle(window);
            Assert.IsTrue(figure.Body.forceRenderingOff);
            StubEditor.ChangePlayMode(PlayModeStateChange.ExitingEditMode);
            Assert.IsFalse(figure.Body.forceRenderingOff, "play mode");
            Draw(window);
            StringAssert.Contains(Strings.Get("window.rests"), string.Join("\n", Gui.Drawn));
            StubEditor.ChangePlayMode(PlayModeStateChange.EnteredEditMode);
            Settle(window);
            Assert.IsTrue(figure.Body.forceRenderingOff, "back from play mode");
            window.Close();
            Assert.IsFalse(figure.Body.forceRenderingOff, "closing");
        }

        [Test]
        public void behind_another_tab_the_avatar_is_seen_as_it_is()
        {
            ConverterWindow window = Open();
            Settle(window);
            Assert.IsTrue(figure.Body.forceRenderingOff);
            Tell(window, "OnBecameInvisible");
            Settle(window);
            Assert.IsFalse(figure.Body.forceRenderingOff, "another tab lies over it");
            Tell(window, "OnBecameVisible");
            Settle(window);
            Assert.IsTrue(figure.Body.forceRenderingOff, "in front again");
        }

        [Test]
        public void the_button_makes_a_prefab_and_shows_it()
        {
            Settings.BatchMode = false;
            ConverterWindow window = Open();
            Settle(window);
            Gui.Press.Add(Strings.Get("report.convert"));
            Draw(window);
            Assert.IsNull(window.Model.Result, "while the window draws");
            StubEditor.Tick();
            Assert.IsNotNull(window.Model.Result.Prefab);
            Assert.AreSame(window.Model.Result.Prefab, Dialogs.Pinged);
            foreach (Renderer renderer in window.Model.Result.Prefab.GetComponentsInChildren<Renderer>(true))
            {
                Assert.IsFalse(renderer.forceRenderingOff, "hidden by the preview: " + renderer.name);
            }
            Assert.That(Dialogs.Bars.Count, Is.GreaterThan(3));
            Assert.IsFalse(Dialogs.BarOpen);
            Assert.IsEmpty(Dialogs.Shown, "dialogs");
            CollectionAssert.Contains(Labels(window.Model, SectionId.Report), "Created " + window.Model.Result.PrefabPath);
        }

        [Test]
        public void cancelling_leaves_no_bar_no_files_and_says_so()
        {
            Settings.BatchMode = false;
            ConverterWindow window = Open();
            Settle(window);
            string[] before = StubProject.FilesOnDisk();
            Dialogs.Cancel = fraction => fraction > 0.3f;
            window.Model.Convert();
            StubEditor.Tick();
            Assert.IsNull(window.Model.Result);
            Assert.AreEqual("cancelled", window.Model.Failure.Key);
            Assert.IsFalse(Dialogs.BarOpen);
            CollectionAssert.AreEqual(before, StubProject.FilesOnDisk());
        }

        [Test]
        public void a_failure_of_the_disk_is_told_without_a_dialog_and_the_bar_goes()
        {
            Settings.BatchMode = false;
            ConverterWindow window = Open();
            Settle(window);
            StubDisk.FailAfterBytes = 1000;
            window.Model.Convert();
            StubEditor.Tick();
            Assert.AreEqual("write_refused", window.Model.Failure.Key);
            Assert.IsFalse(Dialogs.BarOpen);
            Assert.IsEmpty(Dialogs.Shown);
        }

        [Test]
        public void a_reference_can_be_saved_as_a_style_and_used_again()
        {
            Settings.BatchMode = false;
            ConverterWindow window = Open();
            window.Model.Change("undo.style", () =>
            {
                window.Model.Settings.Source = StyleSource.ReferenceAvatar;
                window.Model.Settings.ReferenceAvatar = new WindowFigure("Chibi", 2000).Root;
            });
            Dialogs.Paths.Enqueue("Assets/chibi.json");
            Find<ActionRow>(window.Model, SectionId.Style, "style.save").Do();
            StubEditor.Tick();
            string json = File.ReadAllText(Path.Combine(Settings.ProjectFolder, "Assets/chibi.json"));
            using (Style style = Style.FromText(json)) Assert.That(style.Numbers.Heads, Is.GreaterThan(1));
        }

        [Test]
        public void everything_is_drawn_in_every_language()
        {
            ConverterWindow window = Open();
            for (int section = 0; section < 5; section++) window.Model.Open[section] = true;
            window.Model.Touch();
            Settle(window);
            foreach (string language in Strings.Languages)
            {
                Strings.Language = language;
                Draw(window);
                string drawn = string.Join("\n", Gui.Drawn);
                foreach (Section section in window.Model.Sections)
                {
                    StringAssert.Contains(section.Title, drawn);
                    foreach (Row row in section.Rows)
                    {
                        if (row.Label.Length > 0 && !(row is TableRow)) StringAssert.Contains(row.Label, drawn);
                    }
                }
            }
        }

        [Test]
        public void folding_a_section_hides_its_rows_and_shows_its_summary()
        {
            ConverterWindow window = Open();
            Draw(window);
            string title = window.Model.Sections[1].Title;
            window.Model.Open[1] = false;
            window.Model.Touch();
            Draw(window);
            string drawn = string.Join("\n", Gui.Drawn);
            StringAssert.Contains(title + "    2.5 heads", drawn);
            StringAssert.DoesNotContain(Strings.Get("style.presets"), drawn);
        }

        [Test]
        public void the_language_can_be_changed_in_the_window()
        {
            ConverterWindow window = Open();
            Gui.Press.Add("日本語");
            Draw(window);
            Assert.AreEqual("ja", Strings.Language);
            Assert.AreEqual("1  アバター", window.Model.Sections[0].Title);
        }

        [Test]
        public void the_menu_opens_the_window_with_the_selected_humanoid()
        {
            Assert.IsTrue(StubMenu.Execute("Tools/Super Deform/Converter..."));
            Assert.AreEqual(1, Resources.FindObjectsOfTypeAll<ConverterWindow>().Length);
            Assert.IsTrue(StubMenu.Execute("Tools/Super Deform/Converter..."));
            Assert.AreEqual(1, Resources.FindObjectsOfTypeAll<ConverterWindow>().Length);
            Assert.IsTrue(StubMenu.Execute("Tools/Super Deform/Batch..."));
        }

        [Test]
        public void the_command_of_the_hierarchy_is_for_one_humanoid()
        {
            const string command = "GameObject/Super Deform/Convert selected avatar";
            Assert.AreEqual(false, StubMenu.Validate(command));
            Selection.activeGameObject = figure.Root;
            Assert.AreEqual(false, StubMenu.Validate(command), "no Animator");
        }

        [Test]
        public void settings_stay_with_the_project_when_the_window_is_closed()
        {
            Assert.AreEqual("sd2.5", ConverterWindow.LastSettings().BuiltInStyle);
            var saved = new TextAsset("{}") { name = "chibi" };
            StubProject.Import("Assets/chibi.json", saved);
            ConverterWindow window = Open();
            window.Model.Change("undo.heads", () =>
            {
                ConversionSettings settings = window.Model.Settings;
                settings.BuiltInStyle = "sd4";
                settings.Options.HeadScale = 1.7;
                GroupTunings.Change(settings, "head", head => head.LengthScale = 1.2);
                settings.SavedStyle = saved;
                settings.ReferenceAvatar = figure.Root;
            });
            Assert.AreEqual("sd4", ConverterWindow.LastSettings().BuiltInStyle);
            window.Close();
            ConversionSettings closed = ConverterWindow.LastSettings();
            window = Open();
            foreach (ConversionSettings kept in new[] { closed, window.Model.Settings })
            {
                Assert.AreEqual("sd4", kept.BuiltInStyle);
                Assert.AreEqual(1.7, kept.Options.HeadScale);
                Assert.AreEqual(1.2, GroupTunings.Of(kept, "head").LengthScale);
                Assert.AreSame(saved, kept.SavedStyle);
                // No file can name an object of a scene.
                Assert.IsNull(kept.ReferenceAvatar);
            }
            window.Close();
            // Another project has its own.
            Models.NewProject();
            Assert.AreEqual("sd2.5", SuperDeform.Editor.LastSettings.Read().BuiltInStyle);
        }

        [Test]
        public void settings_that_cannot_be_kept_are_said_and_nothing_else_fails()
        {
            System.IO.File.WriteAllText(System.IO.Path.Combine(System.IO.Path.GetDirectoryName(Application.dataPath), "UserSettings"), "in the way");
            LogAssertion(() => SuperDeform.Editor.LastSettings.Write(new ConversionSettings { Heads = 3 }));
            Assert.AreEqual("sd2.5", SuperDeform.Editor.LastSettings.Read().BuiltInStyle);
        }

        static void LogAssertion(Action work)
        {
            Log.Clear();
            work();
            Assert.That(Log.Lines.Exists(line => line.Text.Contains("The settings could not be kept")));
            Log.Clear();
        }

        [Test]
        public void sliders_stand_in_groups_with_those_that_change_most_first()
        {
            var model = new ConverterModel();
            List<Row> rows = model.Sections[(int)SectionId.FineTuning].Rows;
            Assert.AreEqual(new[] { Strings.Get("option.head_scale"), Strings.Get("option.youth") }, new[] { rows[0].Label, rows[1].Label });
            Assert.AreEqual(new[] { "Body", "Head and face", "Hair", "Hands and feet" }, rows.FindAll(row => row is FoldoutRow).ConvertAll(row => row.Label).ToArray());
            Assert.AreEqual(1, rows.FindAll(row => row.Label == Strings.Get("option.youth")).Count);
            // What Youth is made of stands below it, deeper than the rest of the face.
            int eyes = rows.FindIndex(row => row.Label == Strings.Get("option.youth_eye")), smile = rows.FindIndex(row => row.Label == Strings.Get("option.smile"));
            Assert.That(rows[eyes].Indent > rows[smile].Indent && rows[smile].Indent > 0);
            model.Change("undo.tune", () => model.Settings.Options.HairLay = 0.2);
            Assert.AreEqual("1 changed", model.Sections[2].Summary);
            int before = model.Sections[2].Rows.Count;
            ((FoldoutRow)model.Sections[2].Rows.Find(row => row.Label == "Hair")).Set(false);
            Assert.AreEqual(before - 2, model.Sections[2].Rows.Count);
            // What is folded counts all the same.
            Assert.AreEqual("1 changed", model.Sections[2].Summary);
        }

        [Test]
        public void what_wants_nothing_done_is_folded_below_its_number()
        {
            var model = new ConverterModel { Avatar = figure.Root };
            model.SetResult(new ConversionResult
            {
                PrefabPath = "Assets/A.prefab",
                Findings = new List<Finding>
                {
                    new Finding("missing_scripts", Severity.Warning, null, "A", 1), new Finding("collider_yields", Severity.Info, null, 1, 2),
                    new Finding("pose_not_rest", Severity.Info, null, "A"), new Finding("collider_yields", Severity.Info, null, 1, 2)
                }
            });
            Func<List<Row>> rows = () => model.Sections[(int)SectionId.Report].Rows;
            Assert.That(rows().Exists(row => row is CheckRow && row.Label.Contains("missing scripts")));
            Assert.That(!rows().Exists(row => row.Label.Contains("yield")));
            var notes = (FoldoutRow)rows().Find(row => row.Label == "2 notes");
            Assert.IsFalse(notes.Get());
            notes.Set(true);
            Assert.AreEqual(1, rows().FindAll(row => row.Label.Contains("yield")).Count);
        }

        [Test]
        public void one_command_sets_an_avatar_up_for_builds_by_the_settings_of_the_window()
        {
            ConverterWindow window = Open();
            GameObject avatar = new ConversionFigure().Make().Root;
            window.Model.Change("undo.heads", () => window.Model.Settings.BuiltInStyle = "sd4");
            Selection.activeGameObject = avatar;
            Assert.IsTrue(MenuItems.CanSetUpSelected());
            MenuItems.SetUpSelected();
            MenuItems.SetUpSelected();
            Assert.AreEqual(1, avatar.GetComponents<SuperDeformAvatar>().Length);
            Assert.AreEqual("sd4", SettingsText.Of(avatar.GetComponent<SuperDeformAvatar>()).BuiltInStyle);
            Undo.PerformUndo();
            Assert.IsNull(avatar.GetComponent<SuperDeformAvatar>());
        }
    }
}
