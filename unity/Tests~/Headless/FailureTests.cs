// Every failure that an artist can cause: one sentence that names the thing and the way out, a fix where there is one, and nothing left behind.
using System;
using System.Collections.Generic;
using System.Diagnostics;
using System.IO;
using NUnit.Framework;
using UnityEditor;
using UnityEngine;
using UnityStubs;

namespace SuperDeform.Editor.Tests
{
    [TestFixture]
    public class FailureTests
    {
        sealed class State
        {
            readonly string m_Fingerprint;
            readonly string[] m_Files;
            readonly int m_Objects;
            readonly ulong m_Handles;
            readonly GameObject m_Root;
            public State(GameObject root) { m_Root = root; m_Fingerprint = Fingerprint.Of(root); m_Files = StubProject.FilesOnDisk(); m_Objects = Registry.All().FindAll(IsSceneObject).Count; m_Handles = SuperDeformLibrary.LiveHandles; }
            static bool IsSceneObject(UnityEngine.Object value) { return value is GameObject && !EditorUtility.IsPersistent(value); }
            public void StillHolds()
            {
                Assert.AreEqual(m_Fingerprint, Fingerprint.Of(m_Root), "the source changed");
                Assert.AreEqual(m_Files, StubProject.FilesOnDisk(), "files");
                Assert.AreEqual(m_Objects, Registry.All().FindAll(IsSceneObject).Count, "objects in the scene");
                Assert.AreEqual(m_Handles, SuperDeformLibrary.LiveHandles, "handles of the library");
                Assert.AreEqual(0, StubEditor.AssetEditing, "StartAssetEditing without its Stop");
                Assert.That(AssetDatabase.FindAssets("t:Prefab"), Is.Empty);
            }
        }

        static ConversionException Fails(GameObject avatar, string key, params string[] words)
        {
            State state = new State(avatar);
            ConversionException fault = Assert.Throws<ConversionException>(delegate { Converter.Convert(avatar, Models.Settings(), null); });
            Says(fault.Finding, key, words);
            state.StillHolds();
            return fault;
        }

        static void Says(Finding finding, string key, params string[] words)
        {
            Assert.AreEqual(key, finding.Key, finding.Text);
            Console.WriteLine(key + ": " + finding.Text);
            foreach (string word in words) StringAssert.Contains(word, finding.Text);
            Assert.That(Strings.Has(key), "no sentence for " + key);
            Assert.That(finding.Text, Is.Not.StringContaining("{0}"));
            string english = finding.Text;
            foreach (string language in Strings.Languages)
            {
                Strings.Language = language;
                Assert.AreEqual(language == "en", finding.Text == english, language + ": " + finding.Text);
            }
            Strings.Language = "en";
        }

        [Test]
        public void a_mesh_that_is_not_readable_is_named_and_the_fix_makes_it_readable()
        {
            Model model = Models.Load("kaykit_rogue.glb");
            ModelImporter importer = (ModelImporter)AssetImporter.GetAtPath(model.AssetPath);
            importer.isReadable = false;
            importer.SaveAndReimport();
            Mesh mesh = model.Glb.Meshes[0];
            Assert.That(mesh.isReadable, Is.False);
            ConversionException fault = Fails(model.Root, "not_readable", "Read/Write");
            Assert.That(fault.Finding.Fix, Is.Not.Null, "a fix");
            Assert.That(Strings.Has(fault.Finding.FixKey));
            fault.Finding.Fix();
            Assert.That(importer.isReadable && mesh.isReadable);
            Assert.That(Converter.Convert(model.Root, Models.Settings(), null).Prefab != null);
        }

        [Test]
        public void a_mesh_asset_that_is_not_readable_is_made_readable_too()
        {
            Model model = Models.Load("kaykit_rogue.glb");
            Renderer renderer = model.Root.GetComponentInChildren<SkinnedMeshRenderer>();
            Mesh own = UnityEngine.Object.Instantiate(Models.MeshOf(renderer));
            AssetDatabase.CreateAsset(own, "Assets/own.asset");
            ((SkinnedMeshRenderer)renderer).sharedMesh = own;
            StubProject.SetReadable(own, false);
            ConversionException fault = Fails(model.Root, "not_readable", "own");
            fault.Finding.Fix();
            Assert.That(own.isReadable);
            Assert.That(Converter.Convert(model.Root, Models.Settings(), null).Prefab != null);
        }

        [Test]
        public void a_mesh_that_a_script_imports_has_no_fix_that_would_not_last()
        {
            Model model = Models.Load("kaykit_rogue.glb");
            StubEditor.AddScriptedImporter(model.AssetPath);
            StubProject.SetReadable(model.Glb.Meshes[0], false);
            ConversionException fault = Fails(model.Root, "not_readable", "Read/Write");
            Assert.That(fault.Finding.Fix, Is.Null);
        }

        [Test]
        public void nothing_chosen_is_said()
        {
            Models.NewProject();
            ConversionException fault = Assert.Throws<ConversionException>(delegate { Converter.Convert(null, Models.Settings(), null); });
            Says(fault.Finding, "no_avatar");
        }

        [Test]
        public void an_object_without_meshes_is_said()
        {
            Models.NewProject();
            Fails(new GameObject("Empty"), "no_mesh", "Empty");
        }

        [Test]
        public void bones_without_an_animator_and_without_known_names_are_no_humanoid()
        {
            Models.NewProject();
            Fails(Models.Post(), "no_animator_no_humanoid", "Post", "Humanoid");
        }

        [Test]
        public void without_an_animator_known_names_are_enough_and_that_is_said()
        {
            Model model = Models.Load("quaternius_female_dress.glb");
            Assert.That(model.Root.GetComponent<Animator>() == null);
            List<Finding> findings = AvatarChecks.Of(model.Root);
            Finding said = findings.Find(delegate (Finding finding) { return finding.Key == "no_animator"; });
            Assert.That(said, Is.Not.Null, string.Join("\n", findings.ConvertAll(delegate (Finding f) { return f.Text; }).ToArray()));
            Says(said, "no_animator", model.Root.name);
            Assert.AreEqual(Severity.Warning, said.Severity);
            ConversionResult result = Converter.Convert(model.Root, Models.Settings(), null);
            Assert.That(result.Prefab.GetComponent<Animator>() == null);
        }

        [Test]
        public void a_generic_avatar_with_unknown_names_is_no_humanoid()
        {
            Models.NewProject();
            GameObject post = Models.Post();
            post.AddComponent<Animator>().avatar = AvatarBuilder.BuildGenericAvatar(post, "");
            ConversionException fault = Fails(post, "not_humanoid", "Post", "Humanoid");
            Assert.That(fault.Finding.Fix, Is.Not.Null, "the importer can make it a humanoid");
            fault.Finding.Fix();
            Assert.AreEqual(ModelImporterAnimationType.Human, ((ModelImporter)AssetImporter.GetAtPath("Assets/Models/post.fbx")).animationType);
        }

        [Test]
        public void a_generic_avatar_whose_bones_look_like_a_body_is_converted_and_that_is_said()
        {
            Model model = Models.Load("kaykit_rogue.glb");
            model.Root.GetComponent<Animator>().avatar = AvatarBuilder.BuildGenericAvatar(model.Root, "");
            int number = 0;
            foreach (Transform at in model.Root.GetComponentsInChildren<Transform>(true)) if (at != model.Root.transform && at.GetComponent<Renderer>() == null) at.name = "bone" + ++number;
            List<Finding> findings = AvatarChecks.Of(model.Root);
            Assert.That(findings.Exists(delegate (Finding finding) { return finding.Severity == Severity.Error; }), Is.False, string.Join("\n", findings.ConvertAll(delegate (Finding f) { return f.Text; }).ToArray()));
            Says(findings.Find(delegate (Finding finding) { return finding.Key == "generic"; }), "generic", model.Root.name, "Humanoid");
            Assert.That(Converter.Convert(model.Root, Models.Settings(), null).Prefab != null);
        }

        [Test]
        public void bones_that_are_gone_are_said_with_how_many_vertices_they_move([Values(false, true)] bool all)
        {
            Models.NewProject();
            ConversionFigure figure = new ConversionFigure().Make();
            Transform[] bones = figure.Body.bones;
            int hand = Array.IndexOf(bones, figure.Bones[HumanBodyBones.LeftHand]), moved = 0;
            foreach (BoneWeight weight in figure.Body.sharedMesh.boneWeights)
            {
                bool by = weight.boneIndex0 == hand && weight.weight0 > 0 || weight.boneIndex1 == hand && weight.weight1 > 0;
                if (by || weight.boneIndex2 == hand && weight.weight2 > 0 || weight.boneIndex3 == hand && weight.weight3 > 0) moved++;
            }
            SkinnedMeshRenderer torn = all ? figure.Hair : figure.Body;
            if (all) torn.bones = new Transform[torn.bones.Length];
            else
            {
                bones[hand] = null;
                torn.bones = bones;
                Assert.That(moved, Is.GreaterThan(3));
            }
            string before = Fingerprint.Of(figure.Root);
            List<Finding> said = AvatarChecks.Of(figure.Root).FindAll(finding => finding.Severity != Severity.Info);
            Assert.AreEqual(1, said.Count, string.Join("\n", said.ConvertAll(finding => finding.Text).ToArray()));
            Says(said[0], "bones_missing", torn.name, (all ? torn.sharedMesh.vertexCount : moved).ToString());
            Assert.That(Converter.Convert(figure.Root, new ConversionSettings { Heads = 2.5f, PlaceInScene = false }, null).Prefab, Is.Not.Null);
            Assert.AreEqual(before, Fingerprint.Of(figure.Root));
        }

        [Test]
        public void hidden_bones_are_said_and_the_fix_shows_them()
        {
            Model model = Models.Load("kaykit_rogue.glb");
            ModelImporter importer = (ModelImporter)AssetImporter.GetAtPath(model.AssetPath);
            importer.optimizeGameObjects = true;
            StubEditor.SetOptimized(model.Root.GetComponent<Animator>(), true);
            ConversionException fault = Fails(model.Root, "bones_hidden", "Optimize Game Objects");
            fault.Finding.Fix();
            Assert.That(importer.optimizeGameObjects, Is.False);
        }

        [Test]
        public void a_pose_far_from_t_and_a_is_measured_and_the_fix_stands_it_up_and_undo_puts_it_back()
        {
            Model model = Models.Load("kaykit_rogue.glb");
            // The binding's pose is what counts, so the arms are bound where they are lowered to.
            Animator animator = model.Root.GetComponent<Animator>();
            Transform arm = animator.GetBoneTransform(HumanBodyBones.LeftUpperArm);
            Quaternion stood = arm.localRotation;
            arm.rotation = Quaternion.AngleAxis(80f, Vector3.up) * arm.rotation;
            Rebind(model.Root);
            Quaternion lowered = arm.localRotation;
            Finding said = AvatarChecks.Of(model.Root).Find(delegate (Finding finding) { return finding.Key == "pose_far"; });
            Assert.That(said, Is.Not.Null, "no word about the pose");
            Says(said, "pose_far", model.Root.name, arm.name, "degrees");
            Assert.AreEqual(Severity.Warning, said.Severity);
            Assert.That(System.Convert.ToDouble(said.Values[1]), Is.InRange(15.0, 90.0));
            Assert.That(said.Fix, Is.Not.Null);
            said.Fix();
            Assert.That(Quaternion.Angle(stood, arm.localRotation), Is.LessThan(0.1f));
            Undo.PerformUndo();
            Assert.That(Quaternion.Angle(lowered, arm.localRotation), Is.LessThan(0.1f));
        }

        /// New bind poses for how the hierarchy stands now, and vertices skinned into it.
        static void Rebind(GameObject root)
        {
            foreach (SkinnedMeshRenderer renderer in root.GetComponentsInChildren<SkinnedMeshRenderer>())
            {
                Vector3[] positions, normals;
                Skinning.Drawn(renderer, renderer.transform.worldToLocalMatrix, out positions, out normals);
                Mesh mesh = renderer.sharedMesh;
                mesh.vertices = positions;
                mesh.normals = normals;
                mesh.bindposes = Array.ConvertAll(renderer.bones, delegate (Transform bone) { return bone.worldToLocalMatrix * renderer.transform.localToWorldMatrix; });
            }
        }

        [Test]
        public void an_avatar_without_a_body_mesh_is_said()
        {
            Model model = Models.Load("kaykit_rogue.glb");
            foreach (Renderer renderer in model.Root.GetComponentsInChildren<Renderer>(true))
            {
                if (renderer.name != "Rogue_Head") UnityEngine.Object.DestroyImmediate(renderer.gameObject);
            }
            Fails(model.Root, "no_body_mesh", model.Root.name);
        }

        [Test]
        public void a_second_avatar_inside_rides_along_and_is_none_to_convert_there()
        {
            Model model = Models.Load("kaykit_rogue.glb"), other = Models.Add("kaykit_rogue.glb");
            other.Root.name = "Guest";
            other.Root.transform.SetParent(model.Root.transform, false);
            other.Root.transform.localPosition = new Vector3(1, 0, 0);
            Says(AvatarChecks.Of(model.Root).Find(finding => finding.Key == "pet"), "pet", other.Root.name, model.Root.name);
            // An object that holds two, and is neither.
            GameObject both = new GameObject("Both");
            Model third = Models.Add("kaykit_rogue.glb");
            third.Root.transform.SetParent(both.transform, false);
            Model fourth = Models.Add("kaykit_rogue.glb");
            fourth.Root.transform.SetParent(both.transform, false);
            Fails(both, "two_avatars", "Both", third.Root.name);
            ConversionException fault = Assert.Throws<ConversionException>(delegate { Converter.Convert(other.Root, Models.Settings(), null); });
            Says(fault.Finding, "inside_avatar", other.Root.name, model.Root.name);
        }

        [Test]
        public void a_cancelled_conversion_leaves_nothing_wherever_it_is_stopped()
        {
            Model model = Models.Load("kaykit_rogue.glb");
            State state = new State(model.Root);
            ConversionSettings settings = Models.Settings();
            settings.PlaceInScene = false;
            int reports;
            {
                Counting counting = new Counting(int.MaxValue);
                ConversionResult done = Converter.Convert(model.Root, settings, counting);
                reports = counting.Calls;
                AssetDatabase.DeleteAsset(Path.GetDirectoryName(done.PrefabPath));
            }
            state.StillHolds();
            Assert.That(reports, Is.GreaterThan(8));
            // The last report says that all is done.
            for (int stop = 1; stop < reports; stop += Math.Max(1, reports / 8))
            {
                ConversionException fault = Assert.Throws<ConversionException>(delegate { Converter.Convert(model.Root, settings, new Counting(stop)); }, "stopped at report " + stop);
                Assert.That(fault.Cancelled);
                if (stop == 1) Says(fault.Finding, "cancelled");
                state.StillHolds();
            }
        }

        sealed class Counting : IConversionProgress
        {
            readonly int m_Last;
            public int Calls;
            float m_Before;
            public Counting(int last) { m_Last = last; }
            public bool Report(string stageKey, float fraction)
            {
                Assert.That(Strings.Has(stageKey), "no words for the stage " + stageKey);
                Assert.That(fraction, Is.InRange(m_Before, 1f), "the bar goes back");
                m_Before = fraction;
                return ++Calls < m_Last;
            }
        }

        [Test]
        public void a_full_disk_leaves_nothing_half_written_wherever_it_fills()
        {
            Model model = Models.Load("kaykit_rogue.glb");
            ConversionSettings settings = Models.Settings();
            State state = new State(model.Root);
            StubDisk.Written = 0;
            ConversionResult done = Converter.Convert(model.Root, settings, null);
            long need = StubDisk.Written;
            Undo.PerformUndo();
            AssetDatabase.DeleteAsset(Path.GetDirectoryName(done.PrefabPath));
            state.StillHolds();
            foreach (long space in new[] { 0L, 60L, need / 4, need / 2, need - need / 10, need - 50 })
            {
                StubDisk.FailAfterBytes = space;
                ConversionException fault = Assert.Throws<ConversionException>(delegate { Converter.Convert(model.Root, settings, null); }, space + " of " + need + " bytes");
                StubDisk.FailAfterBytes = null;
                Says(fault.Finding, "write_refused", "_SD", "free space");
                state.StillHolds();
            }
        }

        [Test]
        public void a_refused_write_leaves_nothing_half_written()
        {
            Model model = Models.Load("kaykit_rogue.glb");
            State state = new State(model.Root);
            foreach (string refused in new[] { ".prefab", ".asset", "_SD", "Assets" })
            {
                StubDisk.Refuse = delegate (string path) { return path.Contains(refused); };
                ConversionException fault = Assert.Throws<ConversionException>(delegate { Converter.Convert(model.Root, Models.Settings(), null); }, refused);
                StubDisk.Refuse = null;
                Says(fault.Finding, "write_refused");
                state.StillHolds();
            }
        }

        [Test]
        public void a_folder_outside_the_project_is_said()
        {
            Model model = Models.Load("kaykit_rogue.glb");
            State state = new State(model.Root);
            ConversionSettings settings = Models.Settings();
            settings.OutputFolder = "/elsewhere/chibis";
            ConversionException fault = Assert.Throws<ConversionException>(delegate { Converter.Convert(model.Root, settings, null); });
            Says(fault.Finding, "folder_outside", "/elsewhere/chibis", "Assets");
            state.StillHolds();
        }

        [Test]
        public void a_missing_reference_and_a_missing_saved_style_are_said()
        {
            Model model = Models.Load("kaykit_rogue.glb");
            State state = new State(model.Root);
            foreach (KeyValuePair<StyleSource, string> pair in new Dictionary<StyleSource, string> { { StyleSource.ReferenceAvatar, "no_reference" }, { StyleSource.SavedStyle, "no_saved_style" } })
            {
                ConversionSettings settings = Models.Settings();
                settings.Source = pair.Key;
                ConversionException fault = Assert.Throws<ConversionException>(delegate { Converter.Convert(model.Root, settings, null); });
                Says(fault.Finding, pair.Value);
                state.StillHolds();
            }
        }

        // The library is looked up once a process, so these two need processes of their own.
        static string RunWithLibrary(string folder)
        {
            string program = Path.Combine(Models.Out, "ConvertOnce.exe");
            ProcessStartInfo start = new ProcessStartInfo("mono", "\"" + program + "\" \"" + Models.Find("kaykit_rogue.glb") + "\"") { UseShellExecute = false, RedirectStandardOutput = true, RedirectStandardError = true, WorkingDirectory = Models.Out };
            start.EnvironmentVariables["LD_LIBRARY_PATH"] = folder;
            using (Process process = Process.Start(start))
            {
                string said = process.StandardOutput.ReadToEnd();
                string wrong = process.StandardError.ReadToEnd();
                process.WaitForExit();
                Assert.AreEqual(0, process.ExitCode, said + wrong);
                return said;
            }
        }

        [Test]
        public void a_missing_library_is_said_with_the_way_to_get_it()
        {
            string folder = Path.Combine(Models.Out, "no_library");
            Directory.CreateDirectory(folder);
            string said = RunWithLibrary(folder);
            Console.WriteLine(said);
            StringAssert.Contains("library_missing", said);
            StringAssert.Contains("superdeform-", said);
            StringAssert.Contains(SuperDeformLibrary.BuildCommand, said);
            StringAssert.Contains("source unchanged, no files", said);
        }

        [Test]
        public void a_library_of_another_version_is_said_with_what_to_do()
        {
            string folder = Path.Combine(Models.Out, "other_library");
            Assert.That(File.Exists(Path.Combine(folder, "libsuperdeform.so")), "the script makes a library of another version");
            string said = RunWithLibrary(folder);
            Console.WriteLine(said);
            StringAssert.Contains("library_version", said);
            StringAssert.Contains("estart", said);
            StringAssert.Contains("source unchanged, no files", said);
        }
    }
}
