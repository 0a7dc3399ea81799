using UnityEditor;
using UnityEngine;

namespace SuperDeform.Editor
{
    /// <summary>
    /// Serialized properties of components whose classes are not known here: other packages', which need not be installed.
    /// </summary>
    internal static class Serialized
    {
        /// <summary>A component's class with its namespace, such as "UnityEngine.Light".</summary>
        internal static string TypeOf(Component component)
        {
            return component.GetType().FullName;
        }

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

        /// <summary>The transform that the object at a path is or hangs on; null where there is none.</summary>
        internal static Transform TransformAt(SerializedObject component, string path)
        {
            SerializedProperty property = component.FindProperty(path);
            Object value = property == null ? null : property.objectReferenceValue;
            GameObject holder = value as GameObject;
            Component part = value as Component;
            return holder != null ? holder.transform : part != null ? part.transform : null;
        }
    }
}
