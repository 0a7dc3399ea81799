using System;
using System.Collections.Generic;
using UnityEditor;
using UnityEditor.SceneManagement;
using UnityEngine;

namespace SuperDeform.Editor
{
    /// <summary>Makes a super-deformed avatar of another: a new prefab, and nothing of the source changed.</summary>
    public static class Converter
    {
        /// <summary>Converts one avatar: all or nothing.</summary>
        /// <param name="avatar">Its root, an object of a scene or a prefab.</param>
        /// <param name="progress">Null for none.</param>
        /// <remarks>
        /// Shows no dialog. Where the avatar stands in a scene and the settings want it, an instance of the result is
        /// put beside it, which Undo takes away; the assets stay.
        /// </remarks>
        /// <exception cref="ConversionException">It cannot be done, and why; nothing is left behind.</exception>
        public static ConversionResult Convert(GameObject avatar, ConversionSettings settings, IConversionProgress progress) =>
            Convert(avatar, settings, progress, false);

        /// <summary>The same.</summary>
        /// <param name="replaceDoubtful">
        /// A result that may be another avatar's, which stood in the same place, is brought up to date too: a person has said so. Else
        /// there is a new one.
        /// </param>
        internal static ConversionResult Convert(GameObject avatar, ConversionSettings settings, IConversionProgress progress, bool replaceDoubtful)
        {
            return Run(avatar, settings, new StageProgress(progress),
                (source, deformer, given, findings, stages) => Finish(source, deformer, given, findings, stages, replaceDoubtful));
        }

        /// <summary>The earlier result that a conversion would bring up to date; null where it makes a new one.</summary>
        internal static ResultUpdate Earlier(GameObject avatar, ConversionSettings settings) =>
            avatar == null || settings.NewCopy ? null : ResultUpdate.Find(new SourceIdentity(avatar), FolderOf(settings));

        /// <summary>Converts an avatar itself, which a build step may do to its own copy: nothing is saved.</summary>
        /// <param name="avatar">The root of an object of a scene that nobody else needs as it was.</param>
        /// <returns>Assets and Replaced say what was made and what it stands for; there is no prefab.</returns>
        /// <exception cref="ConversionException">It cannot be done, and why. The avatar is as it was.</exception>
        public static ConversionResult ConvertInPlace(GameObject avatar, ConversionSettings settings, IConversionProgress progress) =>
            ConvertInPlace(avatar, settings, progress, null, done => { });

        /// <summary>The same.</summary>
        /// <param name="clips">What plays on the avatar; null for the clips of its Animators.</param>
        /// <param name="keep">What is to be done with the result before it counts: what that throws undoes all.</param>
        internal static ConversionResult ConvertInPlace(GameObject avatar, ConversionSettings settings, IConversionProgress progress, IMovableClips clips,
            Action<ConversionResult> keep)
        {
            return Run(avatar, settings, new StageProgress(progress),
                (source, deformer, given, findings, stages) => FinishInPlace(source, deformer, findings, stages, clips, keep));
        }

        delegate ConversionResult Ending(AvatarData source, Deformer deformer, ConversionSettings settings, List<Finding> findings, StageProgress stages);

        static ConversionResult Run(GameObject avatar, ConversionSettings settings, StageProgress stages, Ending ending)
        {
            if (settings == null) throw new ArgumentNullException("settings");
            try
            {
                stages.Begin(ConversionStage.Reading);
                List<Finding> findings = AvatarChecks.Of(avatar, settings.RigAuto);
                if (findings.Count > 0 && findings[0].Severity == Severity.Error) throw new ConversionException(findings[0]);
                var reading = new ReadOptions
                {
                    WithMorphs = true,
                    RigAuto = settings.RigAuto,
                    RigOptions = settings.Options,
                    RigProgress = stages.Within(ConversionStage.Rigging)
                };
                using (AvatarData source = CharacterReader.Read(avatar, reading))
                {
                    stages.Begin(ConversionStage.Measuring);
                    using (Style style = settings.MakeStyle())
                    using (var deformer = new Deformer(source.Character, style, settings.Options, stages.Part(ConversionStage.Deforming, 0f, 0.5f)))
                    {
                        return ending(source, deformer, settings, findings, stages);
                    }
                }
            }
            catch (Exception cause)
            {
                throw ConversionException.From(cause, avatar);
            }
        }

        static ConversionResult Finish(AvatarData source, Deformer deformer, ConversionSettings settings, List<Finding> findings, StageProgress stages,
            bool replaceDoubtful)
        {
            ConversionResult done = Deform(source, deformer, findings, stages, out AvatarResult result);
            ResultUpdate update = Earlier(source.Root, settings);
            if (update != null && update.Match != SourceMatch.Same && !replaceDoubtful) update = null;
            if (update != null)
            {
                Save(source, result, deformer, settings, update.Save, done, stages);
            }
            else
            {
                using (var folder = new ResultFolder(ParentFolder(source.Root, settings), source.Root.name))
                {
                    Save(source, result, deformer, settings, folder.Save, done, stages);
                }
            }
            done.Updated = update != null;
            if (settings.PlaceInScene && !EditorUtility.IsPersistent(source.Root)) Place(source, result, done);
            stages.End();
            return done;
        }

        static ConversionResult FinishInPlace(AvatarData source, Deformer deformer, List<Finding> findings, StageProgress stages, IMovableClips clips,
            Action<ConversionResult> keep)
        {
            ConversionResult done = Deform(source, deformer, findings, stages, out AvatarResult result);
            var map = new PointMap(source, result, deformer, source.Root.transform) { SameAvatar = true };
            var before = new AvatarSnapshot(source.Root);
            try
            {
                CharacterWriter.Write(source.Root, map, source, result, done.Findings, stages.Within(ConversionStage.Writing), clips ?? new AnimatorClips(source.Root));
                done.Assets.AddRange(map.Assets);
                done.Replaced.AddRange(map.Replaced);
                keep(done);
            }
            catch
            {
                before.Restore();
                foreach (UnityEngine.Object asset in map.Assets)
                {
                    if (asset != null && !EditorUtility.IsPersistent(asset)) UnityEngine.Object.DestroyImmediate(asset);
                }
                throw;
            }
            stages.End();
            return done;
        }

        static ConversionResult Deform(AvatarData source, Deformer deformer, List<Finding> findings, StageProgress stages, out AvatarResult result)
        {
            result = new AvatarResult(source, false);
            result.Apply(deformer, stages.Part(ConversionStage.Deforming, 0.5f, 1f));
            stages.Begin(ConversionStage.Reporting);
            var done = new ConversionResult
            {
                Report = deformer.GetReport(),
                ReportJson = deformer.GetReportJson(),
                Findings = findings
            };
            foreach (Warning warning in deformer.Warnings)
            {
                Finding said = LibraryWarnings.Of(warning, source.Root);
                // Two of a kind, about two parts, are one sentence in the editor's language.
                if (!done.Findings.Exists(known => known.Text == said.Text)) done.Findings.Add(said);
            }
            stages.Begin(ConversionStage.Writing);
            return done;
        }

        /// <returns>The prefab's path.</returns>
        delegate string Saving(GameObject copy, SuperDeformPreset container, IList<UnityEngine.Object> assets);

        static void Save(AvatarData source, AvatarResult result, Deformer deformer, ConversionSettings settings, Saving save, ConversionResult done, StageProgress stages)
        {
            var scratch = new ScratchScene();
            GameObject copy = scratch.Copy(source.Root);
            var map = new PointMap(source, result, deformer, copy.transform);
            SuperDeformPreset preset = ScriptableObject.CreateInstance<SuperDeformPreset>();
            bool saved = false;
            try
            {
                copy.name = source.Root.name + "_SD";
                if (!EditorUtility.IsPersistent(source.Root))
                {
                    copy.transform.localPosition = new Vector3(0, 0, 0);
                    copy.transform.localRotation = Quaternion.identity;
                }
                CharacterWriter.Write(copy, map, source, result, done.Findings, stages.Within(ConversionStage.Writing), new AnimatorClips(copy));
                // A build would deform the result once more.
                foreach (SuperDeformAvatar component in copy.GetComponentsInChildren<SuperDeformAvatar>(true))
                {
                    UnityEngine.Object.DestroyImmediate(component);
                }
                preset.Settings = settings.Clone();
                // An asset cannot name objects of a scene.
                if (preset.Settings.ReferenceAvatar != null && !EditorUtility.IsPersistent(preset.Settings.ReferenceAvatar)) preset.Settings.ReferenceAvatar = null;
                stages.Begin(ConversionStage.Saving);
                var identity = new SourceIdentity(source.Root);
                preset.Avatar = identity.ToString();
                preset.MadeFrom = identity.Where;
                done.PrefabPath = save(copy, preset, map.Assets);
                done.Prefab = AssetDatabase.LoadAssetAtPath<GameObject>(done.PrefabPath);
                saved = true;
            }
            finally
            {
                scratch.Dispose();
                map.Assets.Add(preset);
                foreach (UnityEngine.Object asset in map.Assets)
                {
                    // Of a folder that was not finished even what is an asset goes, with its file.
                    if (asset != null && !saved && !AssetDatabase.Contains(asset)) UnityEngine.Object.DestroyImmediate(asset);
                }
                if (saved && !AssetDatabase.Contains(preset)) UnityEngine.Object.DestroyImmediate(preset);
            }
        }

        /// <summary>The settings' folder, else that of the avatar's own asset, else "Assets".</summary>
        static string ParentFolder(GameObject avatar, ConversionSettings settings)
        {
            string folder = FolderOf(settings);
            if (folder.Length > 0)
            {
                bool inProject = folder == "Assets" || folder.StartsWith("Assets/") || folder.StartsWith("Packages/");
                if (!inProject) throw new ConversionException(new Finding("folder_outside", Severity.Error, null, folder));
                return folder;
            }
            string path = AssetDatabase.GetAssetPath(avatar);
            int slash = string.IsNullOrEmpty(path) ? -1 : path.LastIndexOf('/');
            return slash > 0 && path.StartsWith("Assets/") ? path.Substring(0, slash) : "Assets";
        }

        static string FolderOf(ConversionSettings settings) => (settings.OutputFolder ?? "").Replace('\\', '/').Trim().TrimEnd('/');

        /// <summary>The instance of a prefab in the source's scene; null where there is none.</summary>
        static GameObject InstanceOf(GameObject prefab, GameObject source)
        {
            foreach (GameObject root in source.scene.GetRootGameObjects())
            {
                foreach (Transform transform in root.GetComponentsInChildren<Transform>(true))
                {
                    if (PrefabUtility.GetCorrespondingObjectFromSource(transform.gameObject) == prefab) return transform.gameObject;
                }
            }
            return null;
        }

        static void Place(AvatarData source, AvatarResult result, ConversionResult done)
        {
            done.Instance = InstanceOf(done.Prefab, source.Root);
            if (done.Instance != null) return;
            // A prefab that is edited has one root: beside it nothing is shown or saved, and below it all becomes a part of it.
            if (PrefabStageUtility.GetPrefabStage(source.Root) == null) done.Instance = PlaceBeside(source, done.Prefab, result);
            else done.Findings.Add(new Finding("not_placed", Severity.Info, done.Prefab, done.PrefabPath));
        }

        /// <summary>An instance of the result, to the right of the source, as a child of the same object.</summary>
        static GameObject PlaceBeside(AvatarData source, GameObject prefab, AvatarResult result)
        {
            GameObject instance = (GameObject)PrefabUtility.InstantiatePrefab(prefab, source.Root.scene);
            Undo.RegisterCreatedObjectUndo(instance, Strings.Get("undo_convert"));
            var box = new Box();
            foreach (RendererData renderer in source.Renderers)
            {
                Box of = Box.Around(renderer.ModelVertices);
                box.Add(of.Low);
                box.Add(of.High);
            }
            Transform original = source.Root.transform, placed = instance.transform;
            placed.SetParent(original.parent, false);
            var aside = new Vector3((float)box.Size.X * original.localScale.x, 0, 0);
            placed.localRotation = original.localRotation;
            placed.localPosition = original.localPosition + original.localRotation * aside;
            if (placed.parent != null && placed.parent.lossyScale != Vector3.one) VrChatRows.Hang(instance);
            return instance;
        }
    }
}
