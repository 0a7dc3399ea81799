using System;
using System.Collections.Generic;
using UnityEditor;
using UnityEngine;
using Object = UnityEngine.Object;

namespace SuperDeform.Editor
{
    /// <summary>
    /// Serialized properties of components whose classes are not known here: other packages', which need not be installed.
    /// </summary>
    internal static class Serialized
    {
        /// <summary>A component's class with its namespace, such as "UnityEngine.Light".</summary>
        internal static string TypeOf(Component component) => component.GetType().FullName;

        /// <summary>The text at a path; null where there is none.</summary>
        internal static string TextAt(SerializedObject component, string path)
        {
            SerializedProperty property = component.FindProperty(path);
            return property == null ? null : property.stringValue;
        }

        /// <summary>The number at a path; other where there is none.</summary>
        internal static int IntAt(SerializedObject component, string path, int other)
        {
            SerializedProperty property = component.FindProperty(path);
            return property == null ? other : property.intValue;
        }

        /// <summary>Whether the switch at a path is on; other where there is none.</summary>
        internal static bool BoolAt(SerializedObject component, string path, bool other)
        {
            SerializedProperty property = component.FindProperty(path);
            return property == null ? other : property.boolValue;
        }

        /// <summary>The transform that the object at a path is or hangs on; null where there is none.</summary>
        internal static Transform TransformAt(SerializedObject component, string path)
        {
            SerializedProperty property = component.FindProperty(path);
            Object value = property == null ? null : property.objectReferenceValue;
            GameObject holder = value as GameObject;
            Component part = value as Component;
            return holder != null ? holder.transform : part != null ? part.transform : null;
        }

        /// <summary>The transforms at a path, where "[*]" stands for every element of a list; those that are not set are left out.</summary>
        internal static List<Transform> TransformsAt(SerializedObject component, string path) =>
            Expand(component, path).ConvertAll(each => TransformAt(component, each)).FindAll(transform => transform != null);

        /// <summary>The same for components.</summary>
        internal static List<Component> ComponentsAt(SerializedObject component, string path) =>
            Expand(component, path).ConvertAll(each => component.FindProperty(each).objectReferenceValue as Component).FindAll(found => found != null);

        /// <summary>Paths with a number for each element in place of "[*]"; the path itself where it has none.</summary>
        internal static List<string> Expand(SerializedObject component, string path)
        {
            var paths = new List<string>();
            int star = path.IndexOf("[*]", StringComparison.Ordinal);
            if (star < 0)
            {
                paths.Add(path);
                return paths;
            }
            SerializedProperty array = component.FindProperty(path.Substring(0, star));
            for (int index = 0; array != null && index < array.arraySize; index++)
            {
                paths.AddRange(Expand(component, path.Substring(0, star) + ".Array.data[" + index + "]" + path.Substring(star + 3)));
            }
            return paths;
        }
    }
}
