using System.Collections.Generic;
using UnityEditor;
using UnityEngine;

namespace SuperDeform.Editor
{
    /// <summary>One component while its serialized properties are brought to the new proportions.</summary>
    /// <remarks>A property that this version of the component does not have is passed over.</remarks>
    internal sealed class PropertyScope
    {
        internal readonly PointMap Map;
        internal readonly Component Component;
        readonly SerializedObject properties;

        /// <summary>The transform in whose space points are given: the component's own until a rule names another.</summary>
        internal Transform Frame;

        internal PropertyScope(Component component, SerializedObject properties, PointMap map)
        {
            Component = component;
            this.properties = properties;
            Map = map;
            Frame = component.transform;
        }

        /// <summary>The property at a path; null where there is none.</summary>
        internal SerializedProperty At(string path) => properties.FindProperty(path);

        /// <summary>The transform at a path; null where there is none, or one outside the avatar.</summary>
        internal Transform TransformAt(string path)
        {
            Transform found = Serialized.TransformAt(properties, path);
            return found == null || Map.Source(found) == null ? null : found;
        }

        /// <summary>Paths with a number for each element in place of "[*]"; the path itself where it has none.</summary>
        internal List<string> Expand(string path) => Serialized.Expand(properties, path);

        /// <summary>A vector of three: one of Unity's, or any value of x, y and z; other where there is none.</summary>
        internal Vector3 VectorAt(string path, Vector3 other)
        {
            SerializedProperty property = path == null ? null : At(path);
            if (property == null) return other;
            if (property.propertyType == SerializedPropertyType.Vector3) return property.vector3Value;
            SerializedProperty x = At(path + ".x"), y = At(path + ".y"), z = At(path + ".z");
            return x == null || y == null || z == null ? other : new Vector3(x.floatValue, y.floatValue, z.floatValue);
        }

        internal void SetVector(string path, Vector3 value)
        {
            SerializedProperty property = At(path);
            if (property.propertyType == SerializedPropertyType.Vector3)
            {
                property.vector3Value = value;
                return;
            }
            At(path + ".x").floatValue = value.x;
            At(path + ".y").floatValue = value.y;
            At(path + ".z").floatValue = value.z;
        }

        /// <summary>A number; other where there is none, or the path is null.</summary>
        internal float FloatAt(string path, float other)
        {
            SerializedProperty property = path == null ? null : At(path);
            return property == null ? other : property.floatValue;
        }

        /// <summary>Sets a number, where there is one.</summary>
        internal void SetFloat(string path, float value)
        {
            SerializedProperty property = At(path);
            if (property != null) property.floatValue = value;
        }

        /// <summary>Whether a switch is on, or an enumeration is not at its first word; other where there is none, or the path is null.</summary>
        internal bool IsOn(string path, bool other = false)
        {
            SerializedProperty property = path == null ? null : At(path);
            if (property == null) return other;
            return property.propertyType == SerializedPropertyType.Boolean ? property.boolValue : property.intValue != 0;
        }

        /// <summary>A rotation; none where there is none.</summary>
        internal Quaternion TurnAt(string path)
        {
            SerializedProperty property = At(path);
            return property == null ? Quaternion.identity : property.quaternionValue;
        }

        /// <summary>Sets a rotation, where there is one.</summary>
        internal void SetTurn(string path, Quaternion value)
        {
            SerializedProperty property = At(path);
            if (property != null) property.quaternionValue = value;
        }

        /// <summary>Multiplies a number, or each number of a vector.</summary>
        internal void Multiply(string path, float scale)
        {
            SerializedProperty property = path == null ? null : At(path);
            if (property == null) return;
            switch (property.propertyType)
            {
                case SerializedPropertyType.Float:
                    property.floatValue *= scale;
                    break;
                case SerializedPropertyType.Vector2:
                    property.vector2Value *= scale;
                    break;
                default:
                    SetVector(path, VectorAt(path, Vector3.zero) * scale);
                    break;
            }
        }
    }
}
