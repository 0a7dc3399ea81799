// Which fields of an object Unity would serialize, and what is done with them: copies, fingerprints.
//
// Our own engine classes keep all their state in fields, so all of those count; in other classes a field counts by Unity's rules
// (docs.unity3d.com, "Script serialization"): public or [SerializeField], not static, const, readonly or [NonSerialized], of a serializable type.
using System;
using System.Collections;
using System.Collections.Generic;
using System.IO;
using System.Reflection;
using System.Runtime.CompilerServices;
using System.Runtime.Serialization;
using System.Security.Cryptography;
using UnityEngine;
using Object = UnityEngine.Object;

namespace UnityStubs
{
    public static class Fields
    {
        static readonly Dictionary<Type, FieldInfo[]> s_Fields = new Dictionary<Type, FieldInfo[]>();
        internal static readonly HashSet<string> EngineAssemblies = new HashSet<string> { "UnityEngine", "UnityEditor", "mscorlib", "System", "System.Core" };

        internal static bool IsEngine(Type type) { return EngineAssemblies.Contains(type.Assembly.GetName().Name); }

        public static FieldInfo[] Of(Type type)
        {
            lock (s_Fields)
            {
                FieldInfo[] fields;
                if (s_Fields.TryGetValue(type, out fields)) return fields;
                List<FieldInfo> found = new List<FieldInfo>();
                for (Type at = type; at != null && at != typeof(object) && at != typeof(ValueType); at = at.BaseType)
                    foreach (FieldInfo field in at.GetFields(BindingFlags.Instance | BindingFlags.Public | BindingFlags.NonPublic | BindingFlags.DeclaredOnly))
                        if (Counts(field, at)) found.Add(field);
                found.Sort(delegate (FieldInfo a, FieldInfo b) { int order = string.CompareOrdinal(a.DeclaringType.FullName, b.DeclaringType.FullName); return order != 0 ? order : a.MetadataToken.CompareTo(b.MetadataToken); });
                return s_Fields[type] = found.ToArray();
            }
        }

        static bool Counts(FieldInfo field, Type owner)
        {
            if (field.IsDefined(typeof(TransientAttribute), false) || typeof(Delegate).IsAssignableFrom(field.FieldType)) return false;
            if (IsEngine(owner)) return true;
            if (field.IsInitOnly || field.IsNotSerialized) return false;
            // "Script serialization": a managed reference may be of any class that is none of Unity's objects, null or shared.
            if (field.IsDefined(typeof(SerializeReference), false)) return !typeof(Object).IsAssignableFrom(field.FieldType);
            return (field.IsPublic || field.IsDefined(typeof(SerializeField), false)) && Serializable(field.FieldType, true);
        }

        static bool Serializable(Type type, bool lists)
        {
            if (type.IsPrimitive || type.IsEnum || type == typeof(string) || typeof(Object).IsAssignableFrom(type)) return true;
            if (type.IsArray) return lists && type.GetArrayRank() == 1 && Serializable(type.GetElementType(), false);
            if (type.IsGenericType) return lists && type.GetGenericTypeDefinition() == typeof(List<>) && Serializable(type.GetGenericArguments()[0], false);
            return type.IsSerializable && !type.IsAbstract && type.Assembly.GetName().Name != "mscorlib";
        }

        /// Plain data: may be copied by assignment.
        internal static bool IsPlain(Type type)
        {
            if (type.IsPrimitive || type.IsEnum || type == typeof(string) || type == typeof(decimal)) return true;
            if (!type.IsValueType) return false;
            foreach (FieldInfo field in type.GetFields(BindingFlags.Instance | BindingFlags.Public | BindingFlags.NonPublic))
                if (!IsPlain(field.FieldType)) return false;
            return true;
        }
    }

    public static class Cloning
    {
        public delegate Object Remap(Object reference);

        /// A copy of a game object with everything below it, of the game object of a component, or of one asset.
        internal static Object Clone(Object original, Remap outside, string suffix)
        {
            original.Alive();
            GameObject owner = original is GameObject ? (GameObject)original : original is Component ? ((Component)original).gameObject : null;
            Dictionary<Object, Object> made = new Dictionary<Object, Object>(ByReference.Instance);
            if (ReferenceEquals(owner, null))
            {
                Object copy = Make(original.GetType());
                made[original] = copy;
                CopyFields(original, copy, made, outside);
                copy.m_Name = original.m_Name + suffix;
                if (copy is ScriptableObject) { Messages.Send(copy, "Awake"); Messages.Send(copy, "OnEnable"); }
                return copy;
            }
            GameObject top = Shell(owner, null, made);
            foreach (KeyValuePair<Object, Object> pair in new List<KeyValuePair<Object, Object>>(made)) CopyFields(pair.Key, pair.Value, made, outside);
            top.transform.m_Parent = null;
            top.m_Name = owner.m_Name + suffix;
            Changes.Of(top);
            return made[original];
        }

        /// As Clone, and tells which object became which.
        internal static GameObject CloneHierarchy(GameObject original, Remap outside, Dictionary<Object, Object> made)
        {
            GameObject top = Shell(original, null, made);
            foreach (KeyValuePair<Object, Object> pair in new List<KeyValuePair<Object, Object>>(made)) CopyFields(pair.Key, pair.Value, made, outside);
            top.transform.m_Parent = null;
            return top;
        }

        static GameObject Shell(GameObject original, Transform parent, Dictionary<Object, Object> made)
        {
            GameObject copy = (GameObject)Make(typeof(GameObject));
            copy.components = new List<Component>();
            made[original] = copy;
            foreach (Component component in original.components)
            {
                Component twin = (Component)Make(component.GetType());
                twin.m_GameObject = copy;
                copy.components.Add(twin);
                made[component] = twin;
            }
            copy.transform.children = new List<Transform>();
            copy.transform.m_Parent = parent;
            if (!ReferenceEquals(parent, null)) parent.children.Add(copy.transform);
            copy.m_Scene = ReferenceEquals(parent, null) ? UnityEngine.SceneManagement.SceneManager.GetActiveScene() : parent.gameObject.scene;
            foreach (Transform child in original.transform.children) Shell(child.gameObject, copy.transform, made);
            return copy;
        }

        internal static Object Make(Type type)
        {
            if (!Fields.IsEngine(type)) return (Object)Activator.CreateInstance(type, true);
            Object raw = (Object)FormatterServices.GetUninitializedObject(type);
            raw.Renumber();
            return raw;
        }

        internal static void CopyFields(object from, object to, Dictionary<Object, Object> made, Remap outside)
        {
            Dictionary<object, object> shared = new Dictionary<object, object>(ByReference.Instance);
            foreach (FieldInfo field in Fields.Of(from.GetType())) field.SetValue(to, Copy(field.GetValue(from), made, outside, shared));
        }

        internal static object Copy(object value, Dictionary<Object, Object> made, Remap outside, Dictionary<object, object> shared)
        {
            if (value == null) return null;
            Object reference = value as Object;
            if (!ReferenceEquals(reference, null))
            {
                Object twin;
                if (made != null && made.TryGetValue(reference, out twin)) return twin;
                return outside == null ? reference : outside(reference);
            }
            Type type = value.GetType();
            if (Fields.IsPlain(type) || value is Type) return value;
            object known;
            if (!type.IsValueType && shared.TryGetValue(value, out known)) return known;
            Array array = value as Array;
            if (array != null)
            {
                Array twin = (Array)array.Clone();
                shared[value] = twin;
                if (!Fields.IsPlain(type.GetElementType()))
                    for (int at = 0; at < twin.Length; at++) twin.SetValue(Copy(twin.GetValue(at), made, outside, shared), at);
                return twin;
            }
            if (type.IsGenericType && type.GetGenericTypeDefinition() == typeof(List<>))
            {
                IList twin = (IList)Activator.CreateInstance(type);
                shared[value] = twin;
                foreach (object item in (IList)value) twin.Add(Copy(item, made, outside, shared));
                return twin;
            }
            if (type.IsGenericType && type.GetGenericTypeDefinition() == typeof(Dictionary<,>))
            {
                IDictionary twin = (IDictionary)Activator.CreateInstance(type);
                shared[value] = twin;
                foreach (DictionaryEntry entry in (IDictionary)value) twin.Add(Copy(entry.Key, made, outside, shared), Copy(entry.Value, made, outside, shared));
                return twin;
            }
            object fresh = FormatterServices.GetUninitializedObject(type);
            if (!type.IsValueType) shared[value] = fresh;
            foreach (FieldInfo field in Fields.Of(type)) field.SetValue(fresh, Copy(field.GetValue(value), made, outside, shared));
            return fresh;
        }
    }

    internal sealed class ByReference : IEqualityComparer<object>, IEqualityComparer<Object>
    {
        public static readonly ByReference Instance = new ByReference();
        bool IEqualityComparer<object>.Equals(object a, object b) { return ReferenceEquals(a, b); }
        int IEqualityComparer<object>.GetHashCode(object value) { return RuntimeHelpers.GetHashCode(value); }
        bool IEqualityComparer<Object>.Equals(Object a, Object b) { return ReferenceEquals(a, b); }
        int IEqualityComparer<Object>.GetHashCode(Object value) { return RuntimeHelpers.GetHashCode(value); }
    }

    /// The bytes of an object and of everything it refers to: the same before and after if nothing was changed.
    public static class Fingerprint
    {
        public static string Of(params Object[] roots)
        {
            using (MemoryStream stream = new MemoryStream())
            using (BinaryWriter writer = new BinaryWriter(stream))
            {
                Writer state = new Writer(writer, null);
                foreach (Object root in roots) state.Value(root);
                state.Drain();
                writer.Flush();
                using (SHA256 hash = SHA256.Create())
                    return BitConverter.ToString(hash.ComputeHash(stream.GetBuffer(), 0, (int)stream.Length)).Replace("-", "").ToLowerInvariant();
            }
        }

        /// The bytes of one file's objects; a reference out of it is written as what `outside` says.
        internal static byte[] Bytes(IEnumerable<Object> objects, Func<Object, string> outside)
        {
            using (MemoryStream stream = new MemoryStream())
            using (BinaryWriter writer = new BinaryWriter(stream))
            {
                Writer state = new Writer(writer, outside);
                foreach (Object value in objects) state.Value(value);
                state.Drain();
                writer.Flush();
                return stream.ToArray();
            }
        }

        sealed class Writer
        {
            readonly BinaryWriter m_Out;
            readonly Func<Object, string> m_Outside;
            readonly Dictionary<object, int> m_Known = new Dictionary<object, int>(ByReference.Instance);
            readonly Queue<Object> m_Pending = new Queue<Object>();

            public Writer(BinaryWriter writer, Func<Object, string> outside) { m_Out = writer; m_Outside = outside; }

            public void Drain()
            {
                while (m_Pending.Count > 0)
                {
                    Object next = m_Pending.Dequeue();
                    m_Out.Write(m_Known[next]);
                    m_Out.Write(next.GetType().FullName);
                    foreach (FieldInfo field in Fields.Of(next.GetType())) { m_Out.Write(field.Name); Value(field.GetValue(next)); }
                }
            }

            public void Value(object value)
            {
                Object reference = value as Object;
                if (value == null || (!ReferenceEquals(reference, null) && reference.destroyed)) { m_Out.Write("null"); return; }
                Type type = value.GetType();
                int number;
                if (!type.IsValueType && type != typeof(string) && m_Known.TryGetValue(value, out number)) { m_Out.Write("#"); m_Out.Write(number); return; }
                if (!ReferenceEquals(reference, null))
                {
                    string elsewhere = m_Outside == null ? null : m_Outside(reference);
                    if (elsewhere != null) { m_Out.Write(elsewhere); return; }
                    m_Known[value] = m_Known.Count;
                    m_Out.Write("object"); m_Out.Write(m_Known[value]);
                    m_Pending.Enqueue(reference);
                    return;
                }
                if (!type.IsValueType && type != typeof(string)) m_Known[value] = m_Known.Count;
                Array array = value as Array;
                if (array != null)
                {
                    Type element = type.GetElementType();
                    m_Out.Write(array.Length);
                    if (element.IsPrimitive && element != typeof(bool) && element != typeof(char))
                    {
                        byte[] bytes = new byte[Buffer.ByteLength(array)];
                        Buffer.BlockCopy(array, 0, bytes, 0, bytes.Length);
                        m_Out.Write(bytes);
                    }
                    else if (element.IsValueType && Fields.IsPlain(element) && element.StructureIsBlittable()) m_Out.Write(Blittable.Bytes(array));
                    else foreach (object item in array) Value(item);
                    return;
                }
                if (value is string) m_Out.Write((string)value);
                else if (value is Type) m_Out.Write(((Type)value).FullName);
                else if (value is float) m_Out.Write((float)value);
                else if (value is double) m_Out.Write((double)value);
                else if (value is bool) m_Out.Write((bool)value);
                else if (value is char) m_Out.Write((char)value);
                else if (value is ulong) m_Out.Write((ulong)value);
                else if (type.IsPrimitive || type.IsEnum) m_Out.Write(Convert.ToInt64(value));
                else if (value is IDictionary)
                    foreach (DictionaryEntry entry in (IDictionary)value) { Value(entry.Key); Value(entry.Value); }
                else if (value is IList)
                {
                    m_Out.Write(((IList)value).Count);
                    foreach (object item in (IList)value) Value(item);
                }
                else foreach (FieldInfo field in Fields.Of(type)) { m_Out.Write(field.Name); Value(field.GetValue(value)); }
            }
        }
    }

    internal static class Blittable
    {
        public static bool StructureIsBlittable(this Type type)
        {
            if (type == typeof(bool) || type == typeof(char) || type == typeof(decimal) || !type.IsValueType) return false;
            if (type.IsPrimitive || type.IsEnum) return true;
            foreach (FieldInfo field in type.GetFields(BindingFlags.Instance | BindingFlags.Public | BindingFlags.NonPublic))
                if (!StructureIsBlittable(field.FieldType)) return false;
            return true;
        }

        public static byte[] Bytes(Array array)
        {
            int size = System.Runtime.InteropServices.Marshal.SizeOf(array.GetType().GetElementType());
            byte[] bytes = new byte[size * array.Length];
            System.Runtime.InteropServices.GCHandle pin = System.Runtime.InteropServices.GCHandle.Alloc(array, System.Runtime.InteropServices.GCHandleType.Pinned);
            try { if (bytes.Length > 0) System.Runtime.InteropServices.Marshal.Copy(pin.AddrOfPinnedObject(), bytes, 0, bytes.Length); }
            finally { pin.Free(); }
            return bytes;
        }
    }
}
