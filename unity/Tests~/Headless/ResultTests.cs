using System;
using System.Collections.Generic;
using System.IO;
using nadena.dev.ndmf;
using NUnit.Framework;
using SuperDeform.Editor.Ndmf;
using UnityEditor;
using UnityEditor.SceneManagement;
using UnityEngine;
using UnityStubs;
using VF.Model;
using VF.Model.Feature;
using VRC.SDK3.Dynamics.PhysBone.Components;

namespace SuperDeform.Editor.Tests
{
    /// <summary>Results know what they were made of, and keep what a person has done to them.</summary>
    [TestFixture]
    public class ResultTests
    {
        [SetUp]
        public void Begin()
        {
            Models.NewProject();
        }

        static ConversionSettings Settings()
        {
            return new ConversionSettings { Heads = 2.5f, OutputFolder = "Assets/Out", PlaceInScene = false };
        }

        static string Converted(GameObject avatar)
        {
            return Converter.Convert(avatar, Settings(), null).PrefabPath;
        }

        /// <summary>As when the editor is closed and opened: instances have other numbers.</summary>
        static void RestartEditor()
        {
            SessionState.SetString("SuperDeform.Session", "");
        }

        static void Edit(string path, Action<GameObject> change)
        {
            GameObject contents = PrefabUtility.LoadPrefabContents(path);
            change(contents);
            PrefabUtility.SaveAsPrefabAsset(contents, path);
            PrefabUtility.UnloadPrefabContents(contents);
        }

        /// <summary>Meshes, Avatar and prefab as files of the project.</summary>
        static GameObject AsAsset(ConversionFigure figure, string path)
        {
            StubProject.Import(path + ".fbx", figure.Body.sharedMesh, figure.Hair.sharedMesh, figure.Hat.GetComponent<MeshFilter>().sharedMesh, figure.Root.GetComponent<Animator>().avatar);
            return PrefabUtility.SaveAsPrefabAsset(figure.Root, path + ".prefab");
        }

        static List<Transform> Named(GameObject root, string name)
        {
            return new List<Transform>(Array.FindAll(root.GetComponentsInChildren<Transform>(true), one => one.name == name));
        }

        [Test]
        public void what_a_person_renamed_or_deleted_stays_so()
        {
            ConversionFigure figure = new ConversionFigure().Make();
            figure.Bones[HumanBodyBones.Chest].gameObject.AddComponent<VRCPhysBone>();
            string path = Converted(figure.Root);
            Edit(path, contents =>
            {
                ConversionTests.Find(contents, "Body").name = "Skin";
                UnityEngine.Object.DestroyImmediate(ConversionTests.Find(contents, "Hat").gameObject);
                UnityEngine.Object.DestroyImmediate(ConversionTests.Find(contents, "J_Chest").GetComponent<VRCPhysBone>());
            });
            for (int time = 0; time < 3; time++)
            {
                GameObject prefab = Converter.Convert(figure.Root, Settings(), null).Prefab;
                Assert.AreEqual(1, Named(prefab, "Skin").Count);
                Assert.AreEqual(0, Named(prefab, "Body").Count);
                Assert.That(Named(prefab, "Skin")[0].GetComponent<SkinnedMeshRenderer>().sharedMesh, Is.Not.Null);
                Assert.AreEqual(0, Named(prefab, "Hat").Count);
                Assert.That(ConversionTests.Find(prefab, "J_Chest").GetComponent<VRCPhysBone>(), Is.Null);
                Assert.AreEqual(1, Named(prefab, "Hair").Count);
            }
        }

        [Test]
        public void values_that_a_person_set_stay_and_others_follow_the_settings()
        {
            ConversionFigure figure = new ConversionFigure { WithShapes = true }.Make();
            figure.Root.AddComponent<VRC.Core.PipelineManager>();
            var phys = figure.Bones[HumanBodyBones.LeftUpperLeg].gameObject.AddComponent<VRCPhysBone>();
            var glitter = new Material(Shader.Find("Standard")) { name = "Glitter" };
            StubProject.Import("Assets/Glitter.mat", glitter);
            ConversionResult first = Converter.Convert(figure.Root, Settings(), null);
            Assert.AreEqual("", first.Prefab.GetComponent<VRC.Core.PipelineManager>().blueprintId);
            float radius = first.Prefab.GetComponentInChildren<VRCPhysBone>().radius;
            Edit(first.PrefabPath, contents =>
            {
                contents.GetComponent<VRC.Core.PipelineManager>().blueprintId = "avtr_of_the_result";
                var bone = contents.GetComponentInChildren<VRCPhysBone>();
                bone.pull = 0.9f;
                bone.ignoreTransforms.Add(ConversionTests.Find(contents, "Hat"));
                ConversionTests.Find(contents, "Hair").gameObject.SetActive(false);
                SkinnedMeshRenderer body = ConversionTests.Find(contents, "Body").GetComponent<SkinnedMeshRenderer>();
                body.SetBlendShapeWeight(0, 40);
                body.sharedMaterials = new[] { glitter, body.sharedMaterials[1] };
            });
            ConversionSettings taller = Settings();
            taller.Heads = 4;
            // Also those of the source that nobody set on the result.
            phys.gravity = 0.7f;
            for (int time = 0; time < 2; time++)
            {
                GameObject prefab = Converter.Convert(figure.Root, taller, null).Prefab;
                Assert.AreEqual("avtr_of_the_result", prefab.GetComponent<VRC.Core.PipelineManager>().blueprintId);
                var bone = prefab.GetComponentInChildren<VRCPhysBone>();
                Assert.AreEqual(0.9f, bone.pull);
                Assert.AreSame(ConversionTests.Find(prefab, "Hat"), bone.ignoreTransforms[0]);
                Assert.That(ConversionTests.Find(prefab, "Hair").gameObject.activeSelf, Is.False);
                SkinnedMeshRenderer body = ConversionTests.Find(prefab, "Body").GetComponent<SkinnedMeshRenderer>();
                Assert.AreEqual(40, body.GetBlendShapeWeight(0));
                Assert.AreSame(glitter, body.sharedMaterials[0]);
                Assert.AreEqual(0.7f, bone.gravity, "of the source");
                Assert.AreNotEqual(radius, bone.radius, "of the settings");
            }
        }

        [Test]
        public void references_in_managed_references_of_what_was_added_lead_to_the_new_result()
        {
            ConversionFigure figure = new ConversionFigure().Make();
            string path = Converted(figure.Root);
            Edit(path, contents =>
            {
                var toggle = new Toggle();
                toggle.objects.Add(ConversionTests.Find(contents, "Hair").gameObject);
                toggle.other = toggle;
                contents.AddComponent<VRCFury>().content = toggle;
            });
            for (int time = 0; time < 2; time++)
            {
                GameObject prefab = Converter.Convert(figure.Root, Settings(), null).Prefab;
                var toggle = (Toggle)prefab.GetComponent<VRCFury>().content;
                Assert.AreSame(ConversionTests.Find(prefab, "Hair").gameObject, toggle.objects[0]);
                Assert.AreSame(toggle, toggle.other);
            }
        }

        [Test]
        public void meshes_that_nothing_shows_any_more_leave_the_file()
        {
            ConversionFigure figure = new ConversionFigure().Make();
            string container = Path.ChangeExtension(Converted(figure.Root), ".asset");
            Assert.That(Array.Exists(AssetDatabase.LoadAllAssetRepresentationsAtPath(container), asset => asset.name == "HatMesh"));
            UnityEngine.Object.DestroyImmediate(figure.Hat.gameObject);
            Converted(figure.Root);
            UnityEngine.Object[] left = AssetDatabase.LoadAllAssetRepresentationsAtPath(container);
            Assert.That(Array.Exists(left, asset => asset.name == "HatMesh"), Is.False);
            Assert.That(Array.Exists(left, asset => asset.name == "BodyMesh"));
        }

        [Test]
        public void the_result_of_a_component_is_not_deformed_again()
        {
            ConversionFigure figure = new ConversionFigure().Make();
            SettingsText.Give(figure.Root.AddComponent<SuperDeformAvatar>(), Settings());
            GameObject prefab = Converter.Convert(figure.Root, Settings(), null).Prefab;
            Assert.That(prefab.GetComponentsInChildren<SuperDeformAvatar>(true), Is.Empty);
            Assert.That(figure.Root.GetComponent<SuperDeformAvatar>(), Is.Not.Null, "the source keeps it");
            GameObject uploaded = UnityEngine.Object.Instantiate(prefab);
            NdmfStub.Build<SuperDeformPlugin>(uploaded);
            Assert.AreEqual(Drawing.Drawn(prefab, "Body"), Drawing.Drawn(uploaded, "Body"));
        }

        [Test]
        public void two_of_a_name_have_a_result_each_in_a_scene_that_was_never_saved()
        {
            GameObject one = new ConversionFigure().Make().Root, other = new ConversionFigure().Make().Root;
            string first = Converted(one), second = Converted(other);
            Assert.AreNotEqual(first, second);
            Assert.AreEqual(first, Converted(one));
            Assert.AreEqual(second, Converted(other));
            one.name = "Renamed";
            one.transform.SetParent(new GameObject("Folder").transform, false);
            Assert.AreEqual(first, Converted(one), "it is the same one");
        }

        [Test]
        public void an_avatar_of_a_saved_scene_is_known_after_a_restart()
        {
            GameObject one = new ConversionFigure().Make().Root, other = new ConversionFigure().Make().Root;
            StubScenes.Save("Assets/Room.unity");
            string first = Converted(one), second = Converted(other);
            Assert.AreNotEqual(first, second);
            RestartEditor();
            one.name = "Renamed";
            Assert.AreEqual(first, Converted(one));
            Assert.AreEqual(second, Converted(other));
            string made = AssetDatabase.LoadAssetAtPath<SuperDeformPreset>(Path.ChangeExtension(second, ".asset")).MadeFrom;
            Assert.AreEqual("Assets/Room.unity/Mika", made);
        }

        [Test]
        public void what_stands_where_another_avatar_stood_overwrites_nothing_without_asking()
        {
            ConversionFigure old = new ConversionFigure().Make();
            StubScenes.Save("Assets/Room.unity");
            string first = Converted(old.Root);
            byte[] bytes = File.ReadAllBytes(first);
            UnityEngine.Object.DestroyImmediate(old.Root);
            RestartEditor();
            GameObject next = new ConversionFigure { WithShapes = true }.Make().Root;
            Assert.AreEqual(SourceMatch.Place, Converter.Earlier(next, Settings()).Match);
            string second = Converted(next);
            Assert.AreNotEqual(first, second, "nobody can be asked");
            Assert.AreEqual(bytes, File.ReadAllBytes(first));
            AssetDatabase.DeleteAsset(Path.GetDirectoryName(second));

            UnityStubs.Settings.BatchMode = false;
            ConverterWindow window = ConverterWindow.Open(next);
            window.Model.Settings = Settings();
            window.Model.Recheck();
            Row said = window.Model.Sections[(int)SectionId.Report].Rows.Find(row => row is CheckRow && row.Label.Contains(first));
            Assert.AreEqual(Severity.Warning, ((CheckRow)said).Severity);
            StringAssert.Contains("Assets/Room.unity/Mika", said.Label);
            Dialogs.Answers.Enqueue(1);
            window.Model.Convert();
            StubEditor.Tick();
            Assert.That(window.Model.Result, Is.Null, "cancelled");
            Assert.AreEqual(bytes, File.ReadAllBytes(first));
            Dialogs.Answers.Enqueue(2);
            window.Model.Convert();
            StubEditor.Tick();
            Assert.AreNotEqual(first, window.Model.Result.PrefabPath, "a new copy");
            AssetDatabase.DeleteAsset(Path.GetDirectoryName(window.Model.Result.PrefabPath));
            Dialogs.Answers.Enqueue(0);
            window.Model.Convert();
            StubEditor.Tick();
            Assert.AreEqual(first, window.Model.Result.PrefabPath, "replaced");
            Assert.AreEqual(3, Dialogs.Shown.Count);
            // By now it is this one's.
            window.Model.Convert();
            StubEditor.Tick();
            Assert.AreEqual(first, window.Model.Result.PrefabPath);
            Assert.AreEqual(3, Dialogs.Shown.Count);
            window.Close();
        }

        [Test]
        public void the_window_and_the_inspector_name_what_will_be_brought_up_to_date()
        {
            ConversionFigure figure = new ConversionFigure().Make();
            var model = new ConverterModel { Avatar = figure.Root, Settings = Settings() };
            Predicate<Row> says = row => row is CheckRow && row.Label.Contains("Mika_SD.prefab");
            Assert.That(model.Sections[(int)SectionId.Report].Rows.Exists(says), Is.False);
            Converted(figure.Root);
            model.Recheck();
            List<Row> rows = model.Sections[(int)SectionId.Report].Rows;
            int at = rows.FindIndex(says);
            Assert.That(at, Is.GreaterThanOrEqualTo(0));
            Assert.That(((ActionRow)rows[at + 1]).Main, "just above the button");
            ((ToggleRow)rows.Find(row => row.Label == Strings.Get("report.new_copy"))).Set(true);
            Assert.That(model.Sections[(int)SectionId.Report].Rows.Exists(says), Is.False);
            SettingsText.Give(figure.Root.AddComponent<SuperDeformAvatar>(), Settings());
            var inspector = (SuperDeformAvatarEditor)UnityEditor.Editor.CreateEditor(figure.Root.GetComponent<SuperDeformAvatar>(), typeof(SuperDeformAvatarEditor));
            Gui.Pass(inspector.OnInspectorGUI);
            Assert.That(Gui.Drawn.Exists(line => line.Contains("Mika_SD.prefab")));
            UnityEngine.Object.DestroyImmediate(inspector);
        }

        [Test]
        public void in_prefab_mode_nothing_is_placed_and_the_prefab_is_what_it_is_known_by()
        {
            ConversionFigure figure = new ConversionFigure().Make();
            AsAsset(figure, "Assets/Mika");
            UnityEngine.Object.DestroyImmediate(figure.Root);
            ConversionSettings settings = Settings();
            string path = Converter.Convert(AssetDatabase.LoadAssetAtPath<GameObject>("Assets/Mika.prefab"), settings, null).PrefabPath;
            PrefabStage stage = PrefabStageUtility.OpenPrefab("Assets/Mika.prefab");
            settings.PlaceInScene = true;
            ConversionResult result = Converter.Convert(stage.prefabContentsRoot, settings, null);
            Assert.AreEqual(path, result.PrefabPath);
            Assert.That(result.Updated);
            Assert.That(result.Instance, Is.Null);
            Assert.That(result.Findings.Exists(finding => finding.Key == "not_placed"));
            Assert.AreEqual(1, stage.scene.GetRootGameObjects().Length);
            Assert.AreEqual(1, Named(stage.prefabContentsRoot, "Body").Count);
            // An avatar below the root of another prefab is known by its way there.
            var room = new GameObject("Room");
            var inside = new ConversionFigure().Make();
            AsAsset(inside, "Assets/Inside");
            inside.Root.transform.SetParent(room.transform, false);
            PrefabUtility.SaveAsPrefabAsset(room, "Assets/Room.prefab");
            stage = PrefabStageUtility.OpenPrefab("Assets/Room.prefab");
            GameObject below = stage.prefabContentsRoot.transform.Find("Mika").gameObject;
            ConversionResult other = Converter.Convert(below, settings, null);
            Assert.AreNotEqual(path, other.PrefabPath);
            Assert.AreEqual(1, stage.prefabContentsRoot.transform.childCount);
            Assert.AreEqual(other.PrefabPath, Converter.Convert(below, settings, null).PrefabPath);
        }

        [Test]
        public void an_instance_stands_clear_of_an_avatar_that_is_scaled()
        {
            foreach (float scale in new[] { 0.5f, 1, 3 })
            {
                Models.NewProject();
                ConversionFigure figure = new ConversionFigure().Make();
                figure.Root.transform.localScale = Vector3.one * scale;
                figure.Root.transform.rotation = Quaternion.Euler(0, 40, 0);
                ConversionSettings settings = Settings();
                settings.PlaceInScene = true;
                GameObject instance = Converter.Convert(figure.Root, settings, null).Instance;
                Matrix4x4 space = Matrix4x4.Rotate(Quaternion.Inverse(figure.Root.transform.rotation));
                float right = float.MinValue, left = float.MaxValue;
                foreach (Vector3 p in Drawing.Drawn(figure.Body, space)) right = Math.Max(right, p.x);
                foreach (Vector3 p in Drawing.Drawn(ConversionTests.Find(instance, "Body").GetComponent<Renderer>(), space))
                {
                    left = Math.Min(left, p.x);
                }
                Assert.That(left, Is.GreaterThan(right), "scale " + scale);
                Assert.That(left - right, Is.LessThan(2 * scale), "and near");
            }
        }

        [Test]
        public void looking_and_converting_assets_asks_nobody_to_save_a_scene()
        {
            ConversionFigure figure = new ConversionFigure { WithShapes = true }.Make();
            AsAsset(figure, "Assets/Mika");
            StubScenes.Save("Assets/Room.unity");
            using (var session = new PreviewSession(figure.Root, Settings()))
            {
                session.Beside = true;
                session.Pose = PreviewPose.Walks;
                session.Update(new ConversionSettings { Heads = 3 });
                Assert.That(StubScenes.IsDirty, Is.False, "the window's preview");
            }
            Assert.That(StubScenes.IsDirty, Is.False, "the end of the window's preview");
            SettingsText.Give(figure.Root.AddComponent<SuperDeformAvatar>(), Settings());
            StubScenes.Save("Assets/Room.unity");
            AvatarChecks.Of(figure.Root);
            Assert.That(StubScenes.IsDirty, Is.False, "checks");
            Converter.Convert(AssetDatabase.LoadAssetAtPath<GameObject>("Assets/Mika.prefab"), Settings(), null);
            Assert.That(StubScenes.IsDirty, Is.False, "converting an asset");
            ConversionSettings placing = Settings();
            placing.PlaceInScene = true;
            Converter.Convert(figure.Root, placing, null);
            Assert.That(StubScenes.IsDirty, "an instance was put there");
        }
    }
}
