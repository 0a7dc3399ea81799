using System.Collections.Generic;
using UnityEditor;
using UnityEngine;

namespace SuperDeform.Editor
{
    /// <summary>Names for the objects and components of a hierarchy that hold from one conversion to the next.</summary>
    /// <remarks>
    /// "Armature#0/Hips#0" is the first Hips below the first Armature; "Armature#0|UnityEngine.BoxCollider#1" its second box
    /// collider. The root is "".
    /// </remarks>
    internal sealed class HierarchyPaths
    {
        readonly Dictionary<string, Object> byName = new Dictionary<string, Object>();
        readonly Dictionary<Object, string> byObject = new Dictionary<Object, string>();

        internal HierarchyPaths(GameObject root)
        {
            Add("", root.transform);
        }

        void Add(string path, Transform transform)
        {
            Name(path, transform.gameObject);
            var counts = new Dictionary<string, int>();
            foreach (Component component in transform.GetComponents<Component>())
            {
                // Null where a script is missing.
                if (component != null) Name(path + "|" + Numbered(counts, component.GetType().FullName), component);
            }
            counts.Clear();
            for (int child = 0; child < transform.childCount; child++)
            {
                string name = Numbered(counts, transform.GetChild(child).name);
                Add(path.Length == 0 ? name : path + "/" + name, transform.GetChild(child));
            }
        }

        static string Numbered(Dictionary<string, int> counts, string name)
        {
            counts.TryGetValue(name, out int count);
            counts[name] = count + 1;
            return name + "#" + count;
        }

        void Name(string name, Object thing)
        {
            byName[name] = thing;
            byObject[thing] = name;
        }

        internal IEnumerable<KeyValuePair<string, Object>> All => byName;

        /// <summary>The object or component of a name; null where there is none.</summary>
        internal Object Find(string name) => name != null && byName.TryGetValue(name, out Object found) ? found : null;

        /// <summary>The name of an object or component; null for what is not of the hierarchy.</summary>
        internal string NameOf(Object thing) => thing != null && byObject.TryGetValue(thing, out string name) ? name : null;

        /// <summary>Puts others in the place of objects that a thing refers to.</summary>
        /// <param name="other">What to refer to instead; null leaves the reference as it is.</param>
        internal static void Redirect(Object thing, System.Func<Object, Object> other)
        {
            // Where a transform hangs is no reference of its own, and it has no others.
            if (thing is Transform || thing is GameObject) return;
            using (var properties = new SerializedObject(thing))
            {
                PropertyWalk.Each(properties, property => property.propertyPath != "m_GameObject" && property.propertyPath != "m_Script", property =>
                {
                    if (property.propertyType != SerializedPropertyType.ObjectReference) return;
                    Object now = property.objectReferenceValue, then = now == null ? null : other(now);
                    if (then != null && then != now) property.objectReferenceValue = then;
                });
                properties.ApplyModifiedPropertiesWithoutUndo();
            }
        }
    }
}
