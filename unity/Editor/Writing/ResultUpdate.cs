using System;
using System.Collections.Generic;
using System.IO;
using UnityEditor;
using UnityEditorInternal;
using UnityEngine;

namespace SuperDeform.Editor
{
    /// <summary>
    /// An earlier result of the same avatar, which a conversion brings up to date: the same files with the same GUIDs, so that
    /// whatever refers to it still does. Objects and components that a person has added to it stay.
    /// </summary>
    internal sealed class ResultUpdate
    {
        readonly string containerPath, prefabPath;

        ResultUpdate(string containerPath)
        {
            this.containerPath = containerPath;
            prefabPath = Path.ChangeExtension(containerPath, ".prefab");
        }

        /// <summary>What an avatar is known by: its asset, the prefab that it is an instance of, or its place in a scene.</summary>
        internal static string IdentityOf(GameObject avatar)
        {
            UnityEngine.Object asset = EditorUtility.IsPersistent(avatar) ? avatar : PrefabUtility.GetCorrespondingObjectFromOriginalSource(avatar);
            if (asset != null) return AssetDatabase.AssetPathToGUID(AssetDatabase.GetAssetPath(asset)) + "/" + avatar.name;
            return GlobalObjectId.GetGlobalObjectIdSlow(avatar).ToString();
        }

        /// <summary>The last result of an avatar; null where there is none.</summary>
        /// <param name="folder">Only results in this folder; empty: wherever they were moved to.</param>
        internal static ResultUpdate Find(string identity, string folder)
        {
            foreach (string guid in AssetDatabase.FindAssets("t:SuperDeformPreset"))
            {
                string path = AssetDatabase.GUIDToAssetPath(guid);
                SuperDeformPreset preset = AssetDatabase.LoadAssetAtPath<SuperDeformPreset>(path);
                if (preset == null || preset.Made.Count == 0 || preset.Avatar != identity) continue;
                if (folder.Length > 0 && Above(Above(path)) != folder) continue;
                ResultUpdate update = new ResultUpdate(path);
                if (AssetDatabase.LoadAssetAtPath<GameObject>(update.prefabPath) != null) return update;
            }
            return null;
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
            byte[] container = Bytes(containerPath), prefab = Bytes(prefabPath);
            try
            {
                SuperDeformPreset old = AssetDatabase.LoadAssetAtPath<SuperDeformPreset>(containerPath);
                Additions(copy, old.Made);
                Dictionary<UnityEngine.Object, UnityEngine.Object> kept = Exchange(old, assets);
                foreach (Component component in copy.GetComponentsInChildren<Component>(true))
                {
                    if (component != null) HierarchyPaths.Redirect(component, asset => kept.ContainsKey(asset) ? kept[asset] : null);
                }
                foreach (UnityEngine.Object asset in kept.Keys)
                {
                    UnityEngine.Object.DestroyImmediate(asset);
                }
                old.Settings = preset.Settings;
                old.Made = preset.Made;
                EditorUtility.SetDirty(old);
                ResultFolder.SaveContainer(old, containerPath);
                ResultFolder.SavePrefab(copy, prefabPath);
                return prefabPath;
            }
            catch
            {
                Restore(containerPath, container);
                Restore(prefabPath, prefab);
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
            Dictionary<UnityEngine.Object, UnityEngine.Object> kept = new Dictionary<UnityEngine.Object, UnityEngine.Object>();
            List<UnityEngine.Object> old = new List<UnityEngine.Object>(AssetDatabase.LoadAllAssetRepresentationsAtPath(AssetDatabase.GetAssetPath(container)));
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

        /// <summary>Brings over what the old prefab holds beyond what was made then.</summary>
        void Additions(GameObject copy, IList<string> made)
        {
            GameObject contents = PrefabUtility.LoadPrefabContents(prefabPath);
            try
            {
                HashSet<string> known = new HashSet<string>(made);
                HierarchyPaths before = new HierarchyPaths(contents), now = new HierarchyPaths(copy);
                List<Component> brought = new List<Component>();
                Bring(contents.transform, known, before, now, brought);
                HierarchyPaths after = new HierarchyPaths(copy);
                foreach (Component component in brought)
                {
                    HierarchyPaths.Redirect(component, thing => after.Find(before.NameOf(thing)));
                }
            }
            finally
            {
                PrefabUtility.UnloadPrefabContents(contents);
            }
        }

        static void Bring(Transform from, HashSet<string> known, HierarchyPaths before, HierarchyPaths now, List<Component> brought)
        {
            GameObject place = now.Find(before.NameOf(from.gameObject)) as GameObject;
            // What was made then and is no more had its reason in the source.
            if (place == null) return;
            foreach (Component component in from.GetComponents<Component>())
            {
                string name = before.NameOf(component);
                if (name == null || known.Contains(name) || !ComponentUtility.CopyComponent(component)) continue;
                if (!ComponentUtility.PasteComponentAsNew(place)) continue;
                Component[] all = place.GetComponents<Component>();
                brought.Add(all[all.Length - 1]);
            }
            for (int child = 0; child < from.childCount; child++)
            {
                Transform one = from.GetChild(child);
                if (known.Contains(before.NameOf(one.gameObject)))
                {
                    Bring(one, known, before, now, brought);
                    continue;
                }
                GameObject added = UnityEngine.Object.Instantiate(one.gameObject, place.transform);
                added.name = one.name;
                brought.AddRange(added.GetComponentsInChildren<Component>(true));
            }
        }
    }
}
