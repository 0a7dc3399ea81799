using System;
using System.Collections.Generic;
using UnityEditor;
using UnityEditorInternal;
using UnityEngine;
using Object = UnityEngine.Object;

namespace SuperDeform.Editor
{
    /// <summary>What a person has done to a result since it was made, done again to a new one.</summary>
    /// <remarks>
    /// Objects and components are known by their numbers in the prefab's file, so that a renamed one is no new one. Values count as
    /// a person's where they are no longer as they were made.
    /// </remarks>
    internal sealed class PersonsChanges
    {
        readonly HierarchyPaths now;
        readonly Dictionary<string, MadeThing> madeByPath = new Dictionary<string, MadeThing>();
        readonly Dictionary<long, string> pathByNumber = new Dictionary<long, string>();

        /// <summary>By object of the old prefab, the one of the new avatar that stands for it.</summary>
        readonly Dictionary<Object, Object> standIns = new Dictionary<Object, Object>();

        /// <summary>By path of a thing and property in which a person's value stays, what was made.</summary>
        readonly Dictionary<string, Dictionary<int, int>> instead = new Dictionary<string, Dictionary<int, int>>();

        /// <param name="made">What was made then.</param>
        /// <param name="copy">The new avatar, as it was made now.</param>
        internal PersonsChanges(IList<MadeThing> made, GameObject copy)
        {
            now = new HierarchyPaths(copy);
            foreach (MadeThing thing in made)
            {
                madeByPath[thing.Path] = thing;
                if (thing.Number != 0) pathByNumber[thing.Number] = thing.Path;
            }
        }

        /// <summary>By property of a thing in which a person's value stays, what was made; null where there is none.</summary>
        internal Dictionary<int, int> MadeValues(string path) => instead.TryGetValue(path, out Dictionary<int, int> values) ? values : null;

        /// <summary>By thing of the new avatar, the path that it was made under.</summary>
        internal HierarchyPaths MadePaths => now;

        internal void Apply(GameObject old)
        {
            var left = new HashSet<string>();
            Pair(old.transform, left);
            var brought = new List<Component>();
            Bring(old.transform, brought);
            foreach (KeyValuePair<Object, Object> pair in new List<KeyValuePair<Object, Object>>(standIns))
            {
                KeepValues(pair.Key, pair.Value);
            }
            foreach (Component component in brought)
            {
                HierarchyPaths.Redirect(component, StandIn);
            }
            Delete(left);
        }

        Object StandIn(Object old) => standIns.TryGetValue(old, out Object found) ? found : null;

        /// <summary>The path that a thing of the old prefab was made under; null where it is a person's own.</summary>
        string MadePath(Object thing) => pathByNumber.TryGetValue(MadeThing.NumberOf(thing), out string path) ? path : null;

        void Pair(Transform old, HashSet<string> left)
        {
            string path = MadePath(old.gameObject);
            GameObject twin = path == null ? null : now.Find(path) as GameObject;
            if (path != null) left.Add(path);
            if (twin != null)
            {
                standIns[old.gameObject] = twin;
                if (old.parent != null && twin.transform.parent != null && twin.name != old.name && old.name != NameIn(path)) twin.name = old.name;
            }
            foreach (Component component in old.GetComponents<Component>())
            {
                string name = component == null ? null : MadePath(component);
                if (name == null) continue;
                left.Add(name);
                Object other = now.Find(name);
                if (other != null) standIns[component] = other;
            }
            for (int child = 0; child < old.childCount; child++)
            {
                Pair(old.GetChild(child), left);
            }
        }

        /// <summary>The name that an object was made with: the last of its path, without its number.</summary>
        static string NameIn(string path)
        {
            string last = path.Substring(path.LastIndexOf('/') + 1);
            return last.Substring(0, Math.Max(0, last.LastIndexOf('#')));
        }

        /// <summary>Brings over what a person has added.</summary>
        void Bring(Transform old, List<Component> brought)
        {
            GameObject place = StandIn(old.gameObject) as GameObject;
            // What was made then and is no more had its reason in the source.
            if (place == null) return;
            foreach (Component component in old.GetComponents<Component>())
            {
                if (component == null || MadePath(component) != null || !ComponentUtility.CopyComponent(component)) continue;
                if (!ComponentUtility.PasteComponentAsNew(place)) continue;
                Component[] all = place.GetComponents<Component>();
                brought.Add(all[all.Length - 1]);
                standIns[component] = all[all.Length - 1];
            }
            for (int child = 0; child < old.childCount; child++)
            {
                Transform one = old.GetChild(child);
                if (MadePath(one.gameObject) != null)
                {
                    Bring(one, brought);
                    continue;
                }
                GameObject added = Object.Instantiate(one.gameObject, place.transform);
                added.name = one.name;
                PairAdded(one, added.transform);
                brought.AddRange(Array.FindAll(added.GetComponentsInChildren<Component>(true), component => component != null && !(component is Transform)));
            }
        }

        void PairAdded(Transform old, Transform added)
        {
            standIns[old.gameObject] = added.gameObject;
            Component[] before = old.GetComponents<Component>(), after = added.GetComponents<Component>();
            for (int index = 0; index < before.Length && index < after.Length; index++)
            {
                if (before[index] != null) standIns[before[index]] = after[index];
            }
            for (int child = 0; child < old.childCount && child < added.childCount; child++)
            {
                PairAdded(old.GetChild(child), added.GetChild(child));
            }
        }

        /// <summary>Gives a thing the values that a person has set.</summary>
        void KeepValues(Object old, Object made)
        {
            string path = MadePath(old);
            if (path == null || !madeByPath.TryGetValue(path, out MadeThing then) || old.GetType() != made.GetType()) return;
            using (var from = new SerializedObject(old))
            using (var to = new SerializedObject(made))
            {
                var values = new Dictionary<int, int>();
                List<string> changed = then.ChangedIn(old, MadePath, values);
                if (changed.Count == 0) return;
                instead.Add(path, values);
                foreach (string property in changed)
                {
                    SerializedProperty value = from.FindProperty(property);
                    if (value != null) to.CopyFromSerializedProperty(value);
                }
                to.ApplyModifiedPropertiesWithoutUndo();
            }
            HierarchyPaths.Redirect(made, StandIn);
        }

        /// <summary>Takes away what a person has deleted.</summary>
        /// <param name="left">Paths of what was made then and is still there.</param>
        void Delete(HashSet<string> left)
        {
            foreach (KeyValuePair<string, MadeThing> thing in madeByPath)
            {
                bool isGone = thing.Value.Deleted || thing.Value.Number != 0 && !left.Contains(thing.Key);
                if (!isGone || thing.Key.Length == 0) continue;
                Object gone = now.Find(thing.Key);
                // A transform goes with its object.
                if (gone != null && !(gone is Transform)) Object.DestroyImmediate(gone);
            }
        }
    }
}
