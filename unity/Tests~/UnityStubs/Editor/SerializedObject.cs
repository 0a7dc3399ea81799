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
        // Takes the value of the property of the same path of another object.
        public void CopyFromSerializedProperty(SerializedProperty prop)
        {
            SerializedProperty own = FindProperty(prop.propertyPath);
            if (own != null) own.CopyFrom(prop);
        }
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
        AnimationCurve, Bounds, Gradient, Quaternion, ExposedReference, FixedBufferSize, Vector2Int, Vector3Int, RectInt, BoundsInt, ManagedReference, Hash128
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
                if (m_Path.EndsWith(".Array.size", StringComparison.Ordinal)) return SerializedPropertyType.ArraySize;
                object value = Value;
                FieldInfo field = Declared();
                bool element = m_Path.EndsWith("]", StringComparison.Ordinal), list = m_Path.EndsWith(".Array", StringComparison.Ordinal);
                if (field != null && !list && IsReference(field) && (element || !typeof(IList).IsAssignableFrom(field.FieldType))) return SerializedPropertyType.ManagedReference;
                Type type = value != null ? value.GetType() : field == null || element ? null : field.FieldType;
                if (value is Object || type != null && typeof(Object).IsAssignableFrom(type) || value == null && element && typeof(Object).IsAssignableFrom(ElementOf(field))) return SerializedPropertyType.ObjectReference;
                if (type == typeof(string)) return SerializedPropertyType.String;
                if (value == null) return SerializedPropertyType.Generic;
                if (value is bool) return SerializedPropertyType.Boolean;
                if (value is float || value is double) return SerializedPropertyType.Float;
                if (type.IsEnum) return SerializedPropertyType.Enum;
                if (type.IsPrimitive) return SerializedPropertyType.Integer;
                if (value is Vector2) return SerializedPropertyType.Vector2;
                if (value is Vector3) return SerializedPropertyType.Vector3;
                if (value is Vector4) return SerializedPropertyType.Vector4;
                if (value is Quaternion) return SerializedPropertyType.Quaternion;
                if (value is Bounds) return SerializedPropertyType.Bounds;
                if (value is AnimationCurve) return SerializedPropertyType.AnimationCurve;
                return SerializedPropertyType.Generic;
            }
        }
        static Type ElementOf(FieldInfo list) { return list == null ? typeof(void) : list.FieldType.IsArray ? list.FieldType.GetElementType() : list.FieldType.IsGenericType ? list.FieldType.GetGenericArguments()[0] : typeof(void); }

        /// The field that holds the value, or the list that holds the element; null for the object itself.
        FieldInfo Declared()
        {
            if (m_Known != null) return m_Known.Field;
            string path = m_Path;
            while (path.EndsWith("]", StringComparison.Ordinal)) path = path.Substring(0, path.LastIndexOf(".Array.data[", StringComparison.Ordinal));
            if (path.EndsWith(".Array", StringComparison.Ordinal)) path = path.Substring(0, path.Length - 6);
            int dot = path.LastIndexOf('.');
            object holder = m_Owner.targetObject;
            if (dot >= 0) new SerializedProperty(m_Owner, path.Substring(0, dot)).Get(out holder);
            return FieldOf(holder, path.Substring(dot + 1));
        }
        static readonly Dictionary<FieldInfo, bool> s_References = new Dictionary<FieldInfo, bool>();
        static bool IsReference(FieldInfo field)
        {
            bool is_;
            if (!s_References.TryGetValue(field, out is_)) s_References.Add(field, is_ = field.IsDefined(typeof(SerializeReference), false));
            return is_;
        }

        /// Numbers of managed references: two properties that show one object have one.
        static readonly System.Runtime.CompilerServices.ConditionalWeakTable<object, object> s_Numbers = new System.Runtime.CompilerServices.ConditionalWeakTable<object, object>();
        static long s_LastNumber;
        public long managedReferenceId { get { return Value == null ? -2 : (long)s_Numbers.GetValue(Value, delegate { return (object)(++s_LastNumber); }); } }

        /// A property that an iterator has come to.
        sealed class Known { public string Path; public FieldInfo Field; public object Value; }
        Known m_Known;

        /// What is directly within a value, as Unity names it: a list holds "Array", that its "size" and "data[0]".
        List<Known> Within(string path, FieldInfo of, object value)
        {
            List<Known> found = new List<Known>();
            if (path.EndsWith(".Array.size", StringComparison.Ordinal) || value == null || path.Length > 0 && value is Object) return found;
            IList items = value as IList;
            if (items != null && !path.EndsWith(".Array", StringComparison.Ordinal)) found.Add(new Known { Path = path + ".Array", Field = of, Value = value });
            else if (items != null)
            {
                found.Add(new Known { Path = path + ".size", Field = of, Value = items.Count });
                for (int item = 0; item < items.Count; item++) found.Add(new Known { Path = path + ".data[" + item + "]", Field = of, Value = items[item] });
            }
            else if (!(value is string) && !value.GetType().IsPrimitive && !value.GetType().IsEnum)
                foreach (FieldInfo field in Fields.Of(value.GetType())) found.Add(new Known { Path = path.Length == 0 ? NameOf(field) : path + "." + NameOf(field), Field = field, Value = field.GetValue(value) });
            return found;
        }

        /// The next property in the order of the fields, those within this one first where wanted.
        readonly Stack<KeyValuePair<List<Known>, int>> m_Rows = new Stack<KeyValuePair<List<Known>, int>>();
        public bool Next(bool enterChildren)
        {
            m_Changed = false;
            if (m_Path.Length > 0 && m_Rows.Count == 0) throw new NotSupportedException("here only an iterator of the whole object goes on");
            if (enterChildren || m_Path.Length == 0)
            {
                List<Known> within = m_Known == null ? Within("", null, m_Owner.targetObject) : Within(m_Path, m_Known.Field, m_Known.Value);
                if (within.Count > 0) return Stand(within, 0);
            }
            while (m_Rows.Count > 0)
            {
                KeyValuePair<List<Known>, int> row = m_Rows.Pop();
                if (row.Value + 1 < row.Key.Count) return Stand(row.Key, row.Value + 1);
            }
            return false;
        }
        bool Stand(List<Known> row, int at)
        {
            m_Rows.Push(new KeyValuePair<List<Known>, int>(row, at));
            m_Known = row[at];
            m_Path = m_Known.Path;
            return true;
        }

        public string propertyPath { get { return m_Path; } }
        // Of an element "data".
        public string name { get { string last = m_Path.Substring(m_Path.LastIndexOf('.') + 1); return last.IndexOf('[') < 0 ? last : last.Substring(0, last.IndexOf('[')); } }
        public SerializedObject serializedObject { get { return m_Owner; } }

        // Unity's own names of engine fields that are called otherwise here.
        static readonly Dictionary<string, string> s_Names = new Dictionary<string, string>
        {
            { "Mesh.m_Readable", "m_IsReadable" }, { "Object.m_HideFlags", "m_ObjectHideFlags" }, { "GameObject.components", "m_Component" },
            { "GameObject.m_Active", "m_IsActive" }, { "GameObject.m_Tag", "m_TagString" }, { "Transform.m_Parent", "m_Father" },
            { "Transform.children", "m_Children" }, { "Transform.m_Position", "m_LocalPosition" }, { "Transform.m_Rotation", "m_LocalRotation" },
            { "Transform.m_Scale", "m_LocalScale" }
        };
        static readonly Dictionary<FieldInfo, string> s_NameOf = new Dictionary<FieldInfo, string>();
        static string NameOf(FieldInfo field)
        {
            string name;
            if (s_NameOf.TryGetValue(field, out name)) return name;
            return s_NameOf[field] = UnityName(field);
        }
        static string UnityName(FieldInfo field)
        {
            string name;
            return Fields.IsEngine(field.DeclaringType) && s_Names.TryGetValue(field.DeclaringType.Name + "." + field.Name, out name) ? name : field.Name;
        }
        static FieldInfo FieldOf(object target, string name)
        {
            return target == null ? null : Array.Find(Fields.Of(target.GetType()), delegate (FieldInfo field) { return NameOf(field) == name; });
        }
        internal bool Exists { get { object value; return Get(out value); } }
        bool Get(out object value)
        {
            value = m_Owner.targetObject;
            bool size = m_Path.EndsWith(".Array.size", StringComparison.Ordinal);
            string whole = size ? m_Path.Substring(0, m_Path.Length - 11) : m_Path.EndsWith(".Array", StringComparison.Ordinal) ? m_Path.Substring(0, m_Path.Length - 6) : m_Path;
            string[] parts = whole.Replace(".Array.data[", "[").Split('.');
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
            if (size) value = ((IList)value).Count;
            return true;
        }
        object Value
        {
            get { object value; if (m_Changed) return m_New; if (m_Known != null) return m_Known.Value; if (!Get(out value)) throw new InvalidOperationException("property '" + m_Path + "' is gone"); return value; }
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

        internal void CopyFrom(SerializedProperty other) { Value = Cloning.Copy(other.Value, null, null, new Dictionary<object, object>()); }
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
        public bool isArray { get { return Value is IList || Value is string; } } // To Unity a text is a list of letters.
        public int arraySize { get { IList list = Value as IList; return list == null ? 0 : list.Count; } }
        public SerializedProperty GetArrayElementAtIndex(int index) { return new SerializedProperty(m_Owner, m_Path + ".Array.data[" + index + "]"); }
        public SerializedProperty FindPropertyRelative(string relativePropertyPath)
        {
            SerializedProperty found = new SerializedProperty(m_Owner, m_Path + "." + relativePropertyPath);
            return found.Exists ? found : null;
        }
    }
}
