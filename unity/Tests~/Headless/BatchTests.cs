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
    public class BatchTests
    {
        ulong handles;

        [SetUp]
        public void Begin()
        {
            Models.NewProject();
            handles = SuperDeformLibrary.LiveHandles;
        }

        [TearDown]
        public void NothingIsLeft()
        {
            foreach (EditorWindow window in Resources.FindObjectsOfTypeAll<EditorWindow>()) window.Close();
            Assert.AreEqual(handles, SuperDeformLibrary.LiveHandles, "live handles");
            Assert.IsFalse(Dialogs.BarOpen, "a progress bar is open");
            Assert.IsEmpty(Dialogs.Shown, "dialogs");
        }

        // A prefab of a figure; its scene object goes.
        static string Prefab(string name)
        {
            var figure = new WindowFigure(name, 2000);
            string path = "Assets/" + name + ".prefab";
            foreach (MeshFilter filter in figure.Root.GetComponentsInChildren<MeshFilter>(true))
            {
                AssetDatabase.CreateAsset(filter.sharedMesh, "Assets/" + name + "_hat.asset");
            }
            AssetDatabase.CreateAsset(figure.Body.sharedMesh, "Assets/" + name + "_body.asset");
            PrefabUtility.SaveAsPrefabAsset(figure.Root, path);
            UnityEngine.Object.DestroyImmediate(figure.Root);
            return path;
        }

        // A prefab that shows nothing.
        static string Empty(string name)
        {
            var root = new GameObject(name);
            PrefabUtility.SaveAsPrefabAsset(root, "Assets/" + name + ".prefab");
            UnityEngine.Object.DestroyImmediate(root);
            return "Assets/" + name + ".prefab";
        }

        static string Logged()
        {
            return string.Join("\n", Log.Lines.ConvertAll(line => line.Text));
        }

        [Test]
        public void a_command_line_converts_several_prefabs()
        {
            string a = Prefab("A"), b = Prefab("B");
            Assert.AreEqual(0, BatchConvert.Run(new[] { "Unity", "-batchmode", "-superdeformAvatars", a + ";" + b,
                "-superdeformHeads", "3", "-superdeformOutput", "Assets" }));
            StringAssert.Contains("[Super Deform] Assets/A.prefab: ", Logged());
            StringAssert.Contains(" heads after, Assets/B_SD/B_SD.prefab", Logged());
            StringAssert.Contains("2 converted, 0 failed", Logged());
            Assert.IsNotNull(AssetDatabase.LoadAssetAtPath<GameObject>("Assets/A_SD/A_SD.prefab"));
        }

        [Test]
        public void one_that_fails_does_not_stop_the_others_and_is_named()
        {
            string bad = Empty("Empty"), good = Prefab("Good");
            Assert.AreEqual(1, BatchConvert.Run(new[] { "-superdeformAvatars", bad + ";Assets/None.prefab;" + good }));
            StringAssert.Contains("Assets/Empty.prefab failed: " + Strings.Get("no_mesh", "Empty"), Logged());
            StringAssert.Contains("Assets/None.prefab failed: There is no prefab at Assets/None.prefab", Logged());
            StringAssert.Contains("Assets/Good.prefab: ", Logged());
            StringAssert.Contains("1 converted, 2 failed", Logged());
        }

        [Test]
        public void a_wrong_command_line_is_told_and_converts_nothing()
        {
            string a = Prefab("A");
            string[] before = StubProject.FilesOnDisk();
            Assert.AreEqual(2, BatchConvert.Run(new[] { "-superdeformAvatars", a, "-superdeformHeads", "20" }));
            Assert.AreEqual(1, Log.Of(LogType.Error).Count);
            CollectionAssert.AreEqual(before, StubProject.FilesOnDisk());
        }

        [Test]
        public void unity_is_ended_in_batch_mode_alone()
        {
            BatchConvert.Run();
            Assert.AreEqual(2, Dialogs.ExitCode, "the command line of the tests names no avatars");
            Dialogs.ExitCode = null;
            Settings.BatchMode = false;
            BatchConvert.Run();
            Assert.IsNull(Dialogs.ExitCode);
        }

        [Test]
        public void settings_of_the_command_line_reach_the_conversion()
        {
            string a = Prefab("A");
            BatchConvert.Run(new[] { "-superdeformAvatars", a, "-superdeformHeads", "4", "-superdeformOutput", "Assets/Four" });
            BatchConvert.Run(new[] { "-superdeformAvatars", a, "-superdeformHeads", "2", "-superdeformOutput", "Assets/Two" });
            Assert.That(Height("Assets/Four/A_SD/A_SD.prefab"), Is.Not.EqualTo(Height("Assets/Two/A_SD/A_SD.prefab")).Within(0.05f));
        }

        static float Height(string prefab)
        {
            var root = AssetDatabase.LoadAssetAtPath<GameObject>(prefab);
            Assert.IsNotNull(root, prefab);
            Vector3[] positions, normals;
            Skinning.Drawn(root.GetComponentInChildren<SkinnedMeshRenderer>(true), Matrix4x4.identity, out positions, out normals);
            float low = float.PositiveInfinity, high = float.NegativeInfinity;
            foreach (Vector3 position in positions)
            {
                low = Mathf.Min(low, position.y);
                high = Mathf.Max(high, position.y);
            }
            return high - low;
        }

        [Test]
        public void a_style_can_be_a_prefab_or_a_saved_file()
        {
            string a = Prefab("A"), chibi = Prefab("Chibi");
            Assert.AreEqual(0, BatchConvert.Run(new[] { "-superdeformAvatars", a, "-superdeformReference", chibi,
                "-superdeformBlend", "0.5", "-superdeformHeads", "3" }), Logged());
            using (Style style = Style.FromText("sd3")) StubProject.Import("Assets/chibi.json", new TextAsset(style.ToJson()));
            Assert.AreEqual(0, BatchConvert.Run(new[] { "-superdeformAvatars", a, "-superdeformStyle", "Assets/chibi.json" }),
                Logged());
        }

        [Test]
        public void the_report_is_json_with_an_entry_an_avatar()
        {
            string bad = Empty("Bad \"quoted\""), good = Prefab("Good"), path = Path.Combine(Settings.ProjectFolder, "report.json");
            BatchConvert.Run(new[] { "-superdeformAvatars", bad + ";" + good, "-superdeformReport", path });
            var report = new SuperDeform.Tests.Glb.Json(JsonText.Parse(File.ReadAllText(path)));
            Assert.AreEqual(1, report["converted"].Int());
            Assert.AreEqual(1, report["failed"].Int());
            Assert.AreEqual(2, report["avatars"].Count);
            Assert.AreEqual(bad, report["avatars"][0]["avatar"].Text());
            Assert.AreEqual(Strings.Get("no_mesh", "Bad \"quoted\""), report["avatars"][0]["error"].Text());
            Assert.AreEqual("Assets/Good_SD/Good_SD.prefab", report["avatars"][1]["prefab"].Text());
            Assert.That(report["avatars"][1]["report"]["result"]["heads"].Number(), Is.GreaterThan(1));
        }

        [Test]
        public void a_report_that_cannot_be_written_is_told()
        {
            string a = Prefab("A");
            Assert.AreEqual(1, BatchConvert.Run(new[] { "-superdeformAvatars", a, "-superdeformReport", "no/such/folder/report.json" }));
            StringAssert.Contains("The report could not be written to no/such/folder/report.json", Logged());
        }

        [Test]
        public void cancelling_leaves_out_the_rest_and_says_where()
        {
            var avatars = new List<GameObject> { new WindowFigure("A", 2000).Root, new WindowFigure("B", 2000).Root, new WindowFigure("C", 2000).Root };
            var progress = new StopAt(0.5f);
            BatchReport report = BatchConvert.Convert(avatars, new ConversionSettings(), progress);
            Assert.IsTrue(report.Cancelled);
            Assert.AreEqual(2, report.Entries.Count);
            Assert.AreEqual(1, report.Converted);
            StringAssert.StartsWith("B was cancelled", report.Entries[1].Failure);
        }

        sealed class StopAt : IConversionProgress
        {
            readonly float end;
            float last;

            internal StopAt(float end)
            {
                this.end = end;
            }

            public bool Report(string stageKey, float fraction)
            {
                Assert.That(fraction, Is.InRange(last, 1f), "progress never falls");
                last = fraction;
                return fraction < end;
            }
        }

        [Test]
        public void deleted_avatars_are_left_out()
        {
            var figure = new WindowFigure("A", 2000);
            UnityEngine.Object.DestroyImmediate(figure.Root);
            Assert.AreEqual(0, BatchConvert.Convert(new[] { figure.Root, null }, new ConversionSettings()).Entries.Count);
        }

        [Test]
        public void the_window_converts_what_was_selected_with_one_bar()
        {
            Settings.BatchMode = false;
            GameObject a = AssetDatabase.LoadAssetAtPath<GameObject>(Prefab("A")), b = new WindowFigure("B", 2000).Root;
            BatchWindow window = BatchWindow.Open();
            Selection.objects = new UnityEngine.Object[] { a, b, new GameObject("nothing to see") };
            Gui.Press.Add(Strings.Get("batch.add"));
            Draw(window);
            CollectionAssert.AreEqual(new[] { a, b }, window.Avatars);
            Gui.Press.Add(Strings.Get("batch.convert", 2));
            Draw(window);
            StubEditor.Tick();
            Assert.AreEqual("2 converted, 0 failed", window.Lines[window.Lines.Count - 1]);
            Assert.That(Dialogs.Bars.Count, Is.GreaterThan(5));
        }

        static void Draw(EditorWindow window)
        {
            Gui.Pass(() => window.GetType().GetMethod("OnGUI", System.Reflection.BindingFlags.Instance
                | System.Reflection.BindingFlags.NonPublic).Invoke(window, null));
        }
    }
}
