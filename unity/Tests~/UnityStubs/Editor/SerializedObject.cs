// Serialized objects: properties by path over the fields of an object, "a.b" and "a.Array.data[0]".
using System;
using System.Collections;
using System.Collections.Generic;
using System.Reflection;
using UnityEngine;
using UnityStubs;
using Object = UnityEngine.Object;

namespace UnityEditor
{
    public class SerializedObject : IDisposable
    {
        readonly Object[] m_Targets;
        internal readonly List<Action> Pending = new List<Action>();
        public SerializedObject(Object obj) : this(new[] { obj }) { }
        public SerializedObject(Object[] objs)
        {
            foreach (Object value in objs) if (value == null) throw new ArgumentException("Object at index 0 is null");
            m_Targets = objs;
        }
        public Object targetObject { get { return m_Targets[0]; } }
        public Object[] targetObjects { get { return m_Targets; } }
        public bool hasModifiedProperties { get { return Pending.Count > 0; } }
        public SerializedProperty FindProperty(string propertyPath)
        {
            SerializedProperty found = new SerializedProperty(this, propertyPath);
            return found.Exists ? found : null;
        }
        // Stands before the first property, as Unity's does.
        public SerializedProperty GetIterator() { return new SerializedProperty(this, ""); }
        public void Update() { Pending.Clear(); }
        public void UpdateIfRequiredOrScript() { Update(); }
        public bool ApplyModifiedProperties() { if (Pending.Count == 0) return false; Undo.RecordObject(targetObject, null); return ApplyModifiedPropertiesWithoutUndo(); }
        public bool ApplyModifiedPropertiesWithoutUndo()
        {
            if (Pending.Count == 0) return false;
            foreach (Action change in Pending) change();
            Pending.Clear();
            AssetDatabase.SetDirty(targetObject);
            return true;
        }
        public void Dispose() { }
    }

    public enum SerializedPropertyType
    {
        Generic = -1, Integer, Boolean, Float, String, Color, ObjectReference, LayerMask, Enum, Vector2, Vector3, Vector4, Rect, ArraySize, Character,
        AnimationCurve, Bounds, Gradient, Quaternion
    }

    public class SerializedProperty
    {
        readonly SerializedObject m_Owner;
        string m_Path;
        object m_New;
        bool m_Changed;
        internal SerializedProperty(SerializedObject owner, string path) { m_Owner = owner; m_Path = path; }

        public SerializedPropertyType propertyType
        {
            get
            {
                object value = Value;
                if (value is Object) return SerializedPropertyType.ObjectReference;
                if (value == null) return SerializedPropertyType.Generic;
                if (value is bool) return SerializedPropertyType.Boolean;
                if (value is float || value is double) return SerializedPropertyType.Float;
                if (value is string) return SerializedPropertyType.String;
                if (value.GetType().IsEnum) return SerializedPropertyType.Enum;
                if (value.GetType().IsPrimitive) return SerializedPropertyType.Integer;
                if (value is Vector2) return SerializedPropertyType.Vector2;
                if (value is Vector3) return SerializedPropertyType.Vector3;
                if (value is Vector4) return SerializedPropertyType.Vector4;
                if (value is Quaternion) return SerializedPropertyType.Quaternion;
                if (value is Bounds) return SerializedPropertyType.Bounds;
                return SerializedPropertyType.Generic;
            }
        }

        /// The next property in the order of the fields, those within this one first where wanted.
        public bool Next(bool enterChildren)
        {
            m_Changed = false;
            object value = m_Owner.targetObject;
            if (m_Path.Length > 0) Get(out value);
            IList items = value as IList;
            if (enterChildren && items != null && items.Count > 0 && m_Path.Length > 0) { m_Path += ".Array.data[0]"; return true; }
            if (enterChildren && value != null && (m_Path.Length == 0 || !(value is Object) && !(value is IList) && !(value is string) && !value.GetType().IsPrimitive && !value.GetType().IsEnum))
            {
                FieldInfo[] fields = Fields.Of(value.GetType());
                if (fields.Length > 0) { m_Path = m_Path.Length == 0 ? fields[0].Name : m_Path + "." + fields[0].Name; return true; }
            }
            for (string path = m_Path; path.Length > 0;)
            {
                int dot = path.LastIndexOf('.');
                string above = dot < 0 ? "" : path.Substring(0, dot);
                int open = path.LastIndexOf(".Array.data[", StringComparison.Ordinal);
                if (open >= 0 && open == path.Length - path.Substring(open).Length && path.IndexOf(']', open) == path.Length - 1)
                {
                    // An element: the next one, or what comes after the list.
                    object list;
                    string whole = path.Substring(0, open);
                    int next = int.Parse(path.Substring(open + 12).TrimEnd(']')) + 1;
                    new SerializedProperty(m_Owner, whole).Get(out list);
                    if (next < ((IList)list).Count) { m_Path = whole + ".Array.data[" + next + "]"; return true; }
                    path = whole;
                    continue;
                }
                object holder = m_Owner.targetObject;
                if (above.Length > 0) new SerializedProperty(m_Owner, above).Get(out holder);
                FieldInfo[] fields = Fields.Of(holder.GetType());
                int at = Array.FindIndex(fields, field => field.Name == path.Substring(dot + 1));
                if (at + 1 < fields.Length) { m_Path = (above.Length == 0 ? "" : above + ".") + fields[at + 1].Name; return true; }
                path = above;
            }
            return false;
        }

        public string propertyPath { get { return m_Path; } }
        public string name { get { return m_Path.Substring(m_Path.LastIndexOf('.') + 1); } }
        public SerializedObject serializedObject { get { return m_Owner; } }

        // Unity's own names of engine fields that are called otherwise here.
        static string FieldName(object target, string name)
        {
            if (target is Mesh && name == "m_IsReadable") return "m_Readable";
            return name;
        }
        static FieldInfo FieldOf(object target, string name)
        {
            if (target == null) return null;
            name = FieldName(target, name);
            return Array.Find(Fields.Of(target.GetType()), delegate (FieldInfo field) { return field.Name == name; });
        }
        internal bool Exists { get { object value; return Get(out value); } }
        bool Get(out object value)
        {
            value = m_Owner.targetObject;
            string[] parts = m_Path.Replace(".Array.data[", "[").Split('.');
            foreach (string part in parts)
            {
                string name = part;
                int bracket = part.IndexOf('['), index = -1;
                if (bracket >= 0) { name = part.Substring(0, bracket); index = int.Parse(part.Substring(bracket + 1).TrimEnd(']')); }
                FieldInfo field = FieldOf(value, name);
                if (field == null) return false;
                value = field.GetValue(value);
                if (index < 0) continue;
                IList list = value as IList;
                if (list == null || index >= list.Count) return false;
                value = list[index];
            }
            return true;
        }
        object Value
        {
            get { object value; if (m_Changed) return m_New; if (!Get(out value)) throw new InvalidOperationException("property '" + m_Path + "' is gone"); return value; }
            set { string path = m_Path; m_New = value; m_Changed = true; m_Owner.Pending.Add(delegate { Assign(m_Owner.targetObject, path.Replace(".Array.data[", "[").Split('.'), 0, value); m_Changed = false; }); }
        }
        static object Assign(object target, string[] parts, int at, object value)
        {
            string part = parts[at];
            int bracket = part.IndexOf('[');
            FieldInfo field = FieldOf(target, bracket < 0 ? part : part.Substring(0, bracket));
            object held = field.GetValue(target);
            if (bracket < 0) field.SetValue(target, at == parts.Length - 1 ? Fit(value, field.FieldType) : Assign(held, parts, at + 1, value));
            else
            {
                int index = int.Parse(part.Substring(bracket + 1).TrimEnd(']'));
                IList list = (IList)held;
                list[index] = at == parts.Length - 1 ? Fit(value, list[index] == null ? typeof(object) : list[index].GetType()) : Assign(list[index], parts, at + 1, value);
                field.SetValue(target, list);
            }
            return target;
        }
        static object Fit(object value, Type type) { return value is IConvertible && !type.IsInstanceOfType(value) ? (type.IsEnum ? Enum.ToObject(type, value) : Convert.ChangeType(value, type)) : value; }

        public bool boolValue { get { return Convert.ToBoolean(Value); } set { Value = value; } }
        public int intValue { get { return Convert.ToInt32(Value); } set { Value = value; } }
        public float floatValue { get { return Convert.ToSingle(Value); } set { Value = value; } }
        public string stringValue { get { return (string)Value; } set { Value = value; } }
        public string[] enumNames { get { return Enum.GetNames(Value.GetType()); } }
        public int enumValueIndex { get { return Convert.ToInt32(Value); } set { Value = value; } }
        public Vector2 vector2Value { get { return (Vector2)Value; } set { Value = value; } }
        public Vector4 vector4Value { get { return (Vector4)Value; } set { Value = value; } }
        public Quaternion quaternionValue { get { return (Quaternion)Value; } set { Value = value; } }
        public Vector3 vector3Value { get { return (Vector3)Value; } set { Value = value; } }
        public Object objectReferenceValue { get { return Value as Object; } set { Value = value; } }
        public bool isArray { get { return Value is IList; } }
        public int arraySize { get { IList list = Value as IList; return list == null ? 0 : list.Count; } }
        public SerializedProperty GetArrayElementAtIndex(int index) { return new SerializedProperty(m_Owner, m_Path + ".Array.data[" + index + "]"); }
        public SerializedProperty FindPropertyRelative(string relativePropertyPath)
        {
            SerializedProperty found = new SerializedProperty(m_Owner, m_Path + "." + relativePropertyPath);
            return found.Exists ? found : null;
        }
    }
}
