using System;
using System.Collections.Generic;
using UnityEditor;

namespace SuperDeform.Editor
{
    /// <summary>Goes through all serialized properties of an object, those within managed references too, each once.</summary>
    internal static class PropertyWalk
    {
        /// <param name="enter">Whether a property is looked at, with all within it.</param>
        /// <param name="visit">Is called for each, before those within it; may change its value.</param>
        internal static void Each(SerializedObject properties, Predicate<SerializedProperty> enter, Action<SerializedProperty> visit)
        {
            var references = new HashSet<long>();
            SerializedProperty property = properties.GetIterator();
            bool inside = true;
            while (property.Next(inside))
            {
                inside = enter(property);
                if (!inside) continue;
                visit(property);
                inside = HasMore(property, references);
            }
        }

        static bool HasMore(SerializedProperty property, HashSet<long> references)
        {
            switch (property.propertyType)
            {
                // Managed references may name each other in a circle.
                case SerializedPropertyType.ManagedReference:
                    return references.Add(property.managedReferenceId);
                case SerializedPropertyType.String:
                case SerializedPropertyType.ObjectReference:
                    return false;
                default:
                    return true;
            }
        }
    }
}
