using System;
using System.Collections.Generic;
using System.Text.RegularExpressions;
using UnityEditor;
using UnityEngine;

namespace SuperDeform.Editor
{
    /// <summary>Components that nobody adapts and that look as if they held lengths: said one by one, to be checked by hand.</summary>
    internal static class Unlisted
    {
        /// <summary>More than these are counted, not named.</summary>
        const int Named = 30;

        /// <summary>What properties that are lengths are called.</summary>
        static readonly Regex Length = new Regex("radius|length|height|width|distance|thickness|offset|center|extent|anchor|position|size",
            RegexOptions.IgnoreCase);

        /// <summary>Adds findings about components of the new avatar; they show the source's objects.</summary>
        internal static void Report(IList<Component> left, PointMap map, List<Finding> findings)
        {
            int said = 0, more = 0;
            foreach (Component component in left)
            {
                string lengths = LengthsOf(component);
                if (lengths == null) continue;
                if (said++ >= Named) more++;
                else findings.Add(new Finding("not_adapted", Severity.Warning, map.Source(component.transform), component.name, component.GetType().Name, lengths));
            }
            if (more > 0) findings.Add(new Finding("not_adapted_more", Severity.Warning, null, more));
        }

        /// <summary>The names of a script's properties that look like lengths; null where there are none.</summary>
        internal static string LengthsOf(Component component)
        {
            if (!(component is MonoBehaviour)) return null;
            var names = new List<string>();
            using (var properties = new SerializedObject(component))
            {
                SerializedProperty property = properties.GetIterator();
                for (bool enter = true; property.Next(enter);)
                {
                    // Lists would be said once for each element, and curves hold ratios.
                    enter = property.propertyType == SerializedPropertyType.Generic && !property.isArray;
                    if (IsLength(property) && !names.Contains(property.name)) names.Add(property.name);
                }
            }
            return names.Count == 0 ? null : string.Join(", ", names.ToArray());
        }

        static bool IsLength(SerializedProperty property)
        {
            switch (property.propertyType)
            {
                case SerializedPropertyType.Float:
                    return property.floatValue != 0f && Length.IsMatch(property.name);
                case SerializedPropertyType.Vector2:
                    return property.vector2Value != new Vector2(0, 0) && Length.IsMatch(property.name);
                case SerializedPropertyType.Vector3:
                    return property.vector3Value != new Vector3(0, 0, 0) && Length.IsMatch(property.name);
                default:
                    return false;
            }
        }
    }
}
