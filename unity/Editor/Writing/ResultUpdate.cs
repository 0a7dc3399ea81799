using System;
using System.Collections.Generic;
using System.IO;
using UnityEditor;
using UnityEngine;

namespace SuperDeform.Editor
{
    /// <summary>
    /// An earlier result of the same avatar, which a conversion brings up to date: the same files with the same GUIDs, so that
    /// whatever refers to it still does. What a person has added to it, renamed, deleted or set stays.
    /// </summary>
    internal sealed class ResultUpdate
    {
        readonly string containerPath;

        /// <summary>The prefab's path.</summary>
        internal readonly string PrefabPath;

        /// <summary>Where the avatar that it was made of is, or was.</summary>
        internal readonly string MadeFrom;

        /// <summary>Whether it is surely of the same avatar, or of one that stood in the same place.</summary>
        internal readonly SourceMatch Match;

        ResultUpdate(string containerPath, string madeFrom, SourceMatch match)
        {
            this.containerPath = containerPath;
            PrefabPath = Path.ChangeExtension(containerPath, ".prefab");
            MadeFrom = madeFrom;
            Match = match;
        }

        /// <summary>The last result of an avatar, a sure one rather than a doubtful; null where there is none.</summary>
        /// <param name="folder">Only results in this folder; empty: wherever they were moved to.</param>
        internal static ResultUpdate Find(SourceIdentity avatar, string folder)
        {
            ResultUpdate best = null;
            DateTime newest = DateTime.MinValue;
            foreach (string guid in AssetDatabase.FindAssets("t:SuperDeformPreset"))
            {
                string path = AssetDatabase.GUIDToAssetPath(guid);
                SuperDeformPreset preset = AssetDatabase.LoadAssetAtPath<SuperDeformPreset>(path);
                if (preset == null || preset.Made.Count == 0 || folder.Length > 0 && Above(Above(path)) != folder) continue;
                SourceMatch match = avatar.Matches(preset.Avatar);
                if (match == SourceMatch.None || best != null && match < best.Match) continue;
                var update = new ResultUpdate(path, preset.MadeFrom, match);
                DateTime written = File.GetLastWriteTimeUtc(Path.GetFullPath(path));
                bool later = best == null || match > best.Match || written > newest;
                if (!later || AssetDatabase.LoadAssetAtPath<GameObject>(update.PrefabPath) == null) continue;
                best = update;
                newest = written;
            }
            return best;
        }

        static string Above(string path)
        {
            int slash = path.LastIndexOf('/');
            return slash < 0 ? "" : path.Substring(0, slash);
        }

        /// <summary>Writes both files anew; where that fails they are as before.</summary>
        /// <param name="assets">What the copy needs; those that stand for an old one are destroyed, and the old ones changed.</param>
        /// <returns>The prefab's path.</returns>
        internal string Save(GameObject copy, SuperDeformPreset preset, IList<UnityEngine.Object> assets)
        {
            byte[] container = Bytes(containerPath), prefab = Bytes(PrefabPath);
            try
            {
                SuperDeformPreset old = AssetDatabase.LoadAssetAtPath<SuperDeformPreset>(containerPath);
                Dictionary<UnityEngine.Object, UnityEngine.Object> kept = Exchange(old, assets);
                foreach (Component component in copy.GetComponentsInChildren<Component>(true))
                {
                    if (component != null) HierarchyPaths.Redirect(component, asset => kept.ContainsKey(asset) ? kept[asset] : null);
                }
                foreach (UnityEngine.Object asset in kept.Keys)
                {
                    UnityEngine.Object.DestroyImmediate(asset);
                }
                var changes = new PersonsChanges(old.Made, copy);
                changes.Apply(AssetDatabase.LoadAssetAtPath<GameObject>(PrefabPath));
                old.Settings = preset.Settings;
                old.Avatar = preset.Avatar;
                old.MadeFrom = preset.MadeFrom;
                EditorUtility.SetDirty(old);
                ResultFolder.SaveContainer(old, containerPath);
                ResultFolder.SavePrefab(copy, PrefabPath);
                MadeRecord.Keep(old, changes.MadePaths, copy, PrefabPath, changes);
                ResultFolder.SaveContainer(old, containerPath);
                return PrefabPath;
            }
            catch
            {
                Restore(containerPath, container);
                Restore(PrefabPath, prefab);
                throw;
            }
        }

        static byte[] Bytes(string path)
        {
            string file = Path.Combine(Path.GetDirectoryName(Application.dataPath), path);
            return File.Exists(file) ? File.ReadAllBytes(file) : null;
        }

        static void Restore(string path, byte[] bytes)
        {
            try
            {
                if (bytes == null) return;
                File.WriteAllBytes(Path.Combine(Path.GetDirectoryName(Application.dataPath), path), bytes);
                AssetDatabase.ImportAsset(path, ImportAssetOptions.ForceUpdate);
            }
            catch (IOException refused)
            {
                // The reason for the failure itself is what is thrown on.
                Debug.LogWarning("[Super Deform] " + Strings.Get("write_refused", path, refused.Message));
            }
        }

        /// <summary>Puts new assets into old ones of the same kind and name, so that references to those hold.</summary>
        /// <returns>By new asset, the old one that holds it now.</returns>
        static Dictionary<UnityEngine.Object, UnityEngine.Object> Exchange(SuperDeformPreset container, IList<UnityEngine.Object> assets)
        {
            var kept = new Dictionary<UnityEngine.Object, UnityEngine.Object>();
            var old = new List<UnityEngine.Object>(AssetDatabase.LoadAllAssetRepresentationsAtPath(AssetDatabase.GetAssetPath(container)));
            foreach (UnityEngine.Object asset in assets)
            {
                UnityEngine.Object twin = old.Find(other => other != null && other.GetType() == asset.GetType() && other.name == asset.name);
                if (twin == null)
                {
                    AssetDatabase.AddObjectToAsset(asset, container);
                    continue;
                }
                old.Remove(twin);
                EditorUtility.CopySerialized(asset, twin);
                kept.Add(asset, twin);
            }
            foreach (UnityEngine.Object gone in old)
            {
                if (gone != null) UnityEngine.Object.DestroyImmediate(gone, true);
            }
            return kept;
        }
    }
}
