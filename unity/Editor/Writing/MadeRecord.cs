using System.Collections.Generic;
using UnityEditor;
using UnityEngine;

namespace SuperDeform.Editor
{
    /// <summary>Writes into a result's container what the result is like as it was made, for the next conversion to tell what a person has done to it since.</summary>
    internal static class MadeRecord
    {
        /// <summary>After the prefab was saved, which numbers its things.</summary>
        /// <param name="paths">Of the new avatar, before a person's changes were brought over.</param>
        /// <param name="copy">The new avatar, as it was saved.</param>
        /// <param name="changes">A person's changes that were brought over; null: none.</param>
        internal static void Keep(SuperDeformPreset container, HierarchyPaths paths, GameObject copy, string prefabPath, PersonsChanges changes)
        {
            var saved = new Dictionary<Object, Object>();
            Pair(copy.transform, AssetDatabase.LoadAssetAtPath<GameObject>(prefabPath).transform, saved);
            var savedPaths = new Dictionary<Object, string>();
            foreach (KeyValuePair<string, Object> thing in paths.All)
            {
                if (thing.Value != null && saved.TryGetValue(thing.Value, out Object there)) savedPaths[there] = thing.Key;
            }
            System.Func<Object, string> pathOf = thing =>
            {
                return savedPaths.TryGetValue(thing, out string path) ? path : null;
            };
            container.Made.Clear();
            foreach (KeyValuePair<string, Object> thing in paths.All)
            {
                if (thing.Value != null && saved.TryGetValue(thing.Value, out Object there))
                {
                    MadeThing made = MadeThing.Of(there, thing.Key, pathOf, changes == null ? null : changes.MadeValues(thing.Key));
                    made.Number = MadeThing.NumberOf(there);
                    container.Made.Add(made);
                }
                // What a person has deleted stays deleted.
                else container.Made.Add(new MadeThing { Path = thing.Key, Deleted = true });
            }
            EditorUtility.SetDirty(container);
        }

        /// <summary>By thing of a hierarchy, the one of its saved copy.</summary>
        static void Pair(Transform one, Transform saved, Dictionary<Object, Object> pairs)
        {
            pairs[one.gameObject] = saved.gameObject;
            Component[] components = one.GetComponents<Component>(), others = saved.GetComponents<Component>();
            for (int index = 0; index < components.Length && index < others.Length; index++)
            {
                if (components[index] != null) pairs[components[index]] = others[index];
            }
            for (int child = 0; child < one.childCount && child < saved.childCount; child++)
            {
                Pair(one.GetChild(child), saved.GetChild(child), pairs);
            }
        }
    }
}
