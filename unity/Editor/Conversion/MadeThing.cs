using System;
using System.Collections.Generic;
using UnityEditor;
using Object = UnityEngine.Object;

namespace SuperDeform.Editor
{
    /// <summary>One object or component of a result as it was made: its name, its number in the prefab's file, its values.</summary>
    [Serializable]
    public sealed class MadeThing
    {
        /// <summary>As HierarchyPaths has it.</summary>
        public string Path;

        /// <summary>In the prefab's file; 0 where it is not there.</summary>
        public long Number;

        /// <summary>A person has deleted it: it stays away.</summary>
        public bool Deleted;

        /// <summary>By property, in the order in which Unity shows them: its path and its value, as two numbers that stand for them.</summary>
        public int[] Values = new int[0];

        /// <summary>An object's number in its file; 0 where it has none.</summary>
        internal static long NumberOf(Object thing) =>
            AssetDatabase.TryGetGUIDAndLocalFileIdentifier(thing, out string guid, out long number) ? number : 0;

        /// <summary>A record of a thing as it is.</summary>
        /// <param name="pathOf">The path that a thing of the avatar was made under; null for others.</param>
        /// <param name="instead">By property in which a person's value has stayed, what was made; null: there are none.</param>
        internal static MadeThing Of(Object thing, string path, Func<Object, string> pathOf, Dictionary<int, int> instead)
        {
            var values = new List<int>();
            foreach (KeyValuePair<string, int> value in ValuesOf(thing, pathOf))
            {
                int property = HashOf(value.Key), made;
                values.Add(property);
                values.Add(instead != null && instead.TryGetValue(property, out made) ? made : value.Value);
            }
            return new MadeThing { Path = path, Values = values.ToArray() };
        }

        /// <summary>By property, as two numbers that stand for it and its value.</summary>
        Dictionary<int, int> Recorded()
        {
            var recorded = new Dictionary<int, int>();
            for (int index = 0; index + 1 < Values.Length; index += 2)
            {
                recorded[Values[index]] = Values[index + 1];
            }
            return recorded;
        }

        /// <summary>The properties whose values are no longer as recorded; a list as a whole.</summary>
        /// <param name="made">Receives, by property, what was recorded of those.</param>
        internal List<string> ChangedIn(Object thing, Func<Object, string> pathOf, Dictionary<int, int> made)
        {
            Dictionary<int, int> then = Recorded();
            var changed = new List<string>();
            foreach (KeyValuePair<string, int> value in ValuesOf(thing, pathOf))
            {
                int before, property = HashOf(value.Key);
                bool known = then.TryGetValue(property, out before), list = value.Key.Contains(".Array.");
                // What an update of the component's package has brought is nobody's.
                if (known ? before == value.Value : !list) continue;
                if (known) made[property] = before;
                string whole = list ? value.Key.Substring(0, value.Key.IndexOf(".Array.", StringComparison.Ordinal)) : value.Key;
                if (!changed.Contains(whole)) changed.Add(whole);
            }
            return changed;
        }

        // Names, and where things hang, are no values; and what Unity reckons by itself is nobody's.
        static readonly HashSet<string> Left = new HashSet<string>
        {
            "m_ObjectHideFlags", "m_CorrespondingSourceObject", "m_PrefabInstance", "m_PrefabAsset", "m_GameObject", "m_Component", "m_Name", "m_Script",
            "m_Father", "m_Children", "m_RootOrder", "m_LocalEulerAnglesHint", "m_EditorClassIdentifier", "m_EditorHideFlags", "references"
        };

        static List<KeyValuePair<string, int>> ValuesOf(Object thing, Func<Object, string> pathOf)
        {
            var values = new List<KeyValuePair<string, int>>();
            using (var properties = new SerializedObject(thing))
            {
                PropertyWalk.Each(properties, property => !Left.Contains(property.propertyPath), property =>
                {
                    if (TryValue(property, pathOf, out int value)) values.Add(new KeyValuePair<string, int>(property.propertyPath, value));
                });
            }
            return values;
        }

        static bool TryValue(SerializedProperty property, Func<Object, string> pathOf, out int value)
        {
            value = 0;
            switch (property.propertyType)
            {
                case SerializedPropertyType.Integer:
                case SerializedPropertyType.Enum:
                case SerializedPropertyType.LayerMask:
                case SerializedPropertyType.ArraySize:
                    value = property.intValue;
                    return true;
                case SerializedPropertyType.Boolean:
                    value = property.boolValue ? 1 : 0;
                    return true;
                case SerializedPropertyType.Float:
                    value = property.floatValue.GetHashCode();
                    return true;
                case SerializedPropertyType.String:
                    value = HashOf(property.stringValue);
                    return true;
                case SerializedPropertyType.ObjectReference:
                    value = HashOf(NameOf(property.objectReferenceValue, pathOf));
                    return true;
                default:
                    return false;
            }
        }

        static string NameOf(Object thing, Func<Object, string> pathOf)
        {
            if (thing == null) return "";
            string path = pathOf(thing), guid;
            if (path != null) return path;
            return AssetDatabase.TryGetGUIDAndLocalFileIdentifier(thing, out guid, out long number) ? guid + number : thing.GetType().Name + thing.name;
        }

        /// <summary>The same in every session, which GetHashCode is not.</summary>
        static int HashOf(string text)
        {
            uint hash = 2166136261;
            foreach (char letter in text ?? "")
            {
                hash = unchecked((hash ^ letter) * 16777619);
            }
            return unchecked((int)hash);
        }
    }
}
