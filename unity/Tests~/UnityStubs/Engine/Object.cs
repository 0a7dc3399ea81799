// Objects that can be destroyed while references to them remain, as Unity's can.
using System;
using System.Collections.Generic;
using System.Reflection;
using System.Runtime.CompilerServices;
using UnityStubs;

[assembly: InternalsVisibleTo("UnityEditor")]

namespace UnityEngine
{
    [Flags]
    public enum HideFlags
    {
        None = 0, HideInHierarchy = 1, HideInInspector = 2, DontSaveInEditor = 4, NotEditable = 8,
        DontSaveInBuild = 16, DontUnloadUnusedAsset = 32, DontSave = 52, HideAndDontSave = 61
    }

    public class UnityException : SystemException
    {
        public UnityException() { }
        public UnityException(string message) : base(message) { }
    }

    public class MissingReferenceException : SystemException
    {
        public MissingReferenceException(string message) : base(message) { }
    }

    public class MissingComponentException : SystemException
    {
        public MissingComponentException(string message) : base(message) { }
    }

    public class UnassignedReferenceException : SystemException
    {
        public UnassignedReferenceException(string message) : base(message) { }
    }

    public class Object
    {
        [Transient] static int s_Last;
        [Transient] internal int id;
        [Transient] internal bool destroyed;
        [Transient] internal string assetPath; // null: in memory or in a scene
        [Transient] internal long fileNumber; // in the file of a prefab
        internal string m_Name = "";
        HideFlags m_HideFlags;

        public Object() { id = ++s_Last; Registry.Add(this); }

        internal void Renumber() { id = ++s_Last; Registry.Add(this); }

        internal void Alive()
        {
            if (destroyed) throw new MissingReferenceException("this " + GetType().Name + " was destroyed");
        }

        // A component has the name of its game object.
        public string name { get { Alive(); return NameHolder.m_Name; } set { Alive(); NameHolder.m_Name = value ?? ""; } }
        internal virtual Object NameHolder { get { return this; } }
        public HideFlags hideFlags { get { return m_HideFlags; } set { m_HideFlags = value; } }
        public int GetInstanceID() { return id; }
        public override int GetHashCode() { return id; }
        public override bool Equals(object other) { return other == null ? destroyed : ReferenceEquals(this, other); }
        public override string ToString() { return destroyed ? "null" : name + " (" + GetType().FullName + ")"; }
        public static implicit operator bool(Object value) { return !Gone(value); }
        public static bool operator ==(Object a, Object b) { return Gone(a) ? Gone(b) : ReferenceEquals(a, b); }
        public static bool operator !=(Object a, Object b) { return !(a == b); }
        static bool Gone(Object value) { return ReferenceEquals(value, null) || value.destroyed; }

        public static Object Instantiate(Object original)
        {
            if (Gone(original)) throw new ArgumentException("there is nothing to instantiate");
            return Cloning.Clone(original, null, "(Clone)");
        }
        public static Object Instantiate(Object original, Transform parent) { return Instantiate(original, parent, false); }
        public static Object Instantiate(Object original, Transform parent, bool instantiateInWorldSpace)
        {
            // What gets a parent is made in that one's scene.
            int active = SceneManagement.SceneManager.s_Active;
            if (parent != null) SceneManagement.SceneManager.s_Active = parent.gameObject.scene.m_Handle;
            try
            {
                Object copy = Instantiate(original);
                Transform top = copy is GameObject ? ((GameObject)copy).transform : copy is Component ? ((Component)copy).transform : null;
                if (!ReferenceEquals(top, null)) top.SetParent(parent, instantiateInWorldSpace);
                return copy;
            }
            finally { SceneManagement.SceneManager.s_Active = active; }
        }
        public static Object Instantiate(Object original, Vector3 position, Quaternion rotation) { return Instantiate(original, position, rotation, null); }
        public static Object Instantiate(Object original, Vector3 position, Quaternion rotation, Transform parent)
        {
            Object copy = Instantiate(original, parent);
            Transform top = copy is GameObject ? ((GameObject)copy).transform : ((Component)copy).transform;
            top.SetPositionAndRotation(position, rotation);
            return copy;
        }
        public static T Instantiate<T>(T original) where T : Object { return (T)Instantiate((Object)original); }
        public static T Instantiate<T>(T original, Transform parent) where T : Object { return (T)Instantiate((Object)original, parent); }
        public static T Instantiate<T>(T original, Transform parent, bool worldPositionStays) where T : Object { return (T)Instantiate((Object)original, parent, worldPositionStays); }
        public static T Instantiate<T>(T original, Vector3 position, Quaternion rotation) where T : Object { return (T)Instantiate((Object)original, position, rotation); }

        // Outside play mode Unity refuses Destroy and names DestroyImmediate; nothing here is ever in play mode.
        public static void Destroy(Object value) { Debug.LogError("Destroy is for play mode: use DestroyImmediate"); }
        public static void Destroy(Object value, float delay) { Destroy(value); }
        public static void DestroyImmediate(Object value) { DestroyImmediate(value, false); }
        public static void DestroyImmediate(Object value, bool allowDestroyingAssets)
        {
            if (Gone(value)) return;
            if (value.assetPath != null && !allowDestroyingAssets) { Debug.LogError("'" + value.name + "' is an asset, which is only destroyed when that is allowed"); return; }
            if (value is Transform) { Debug.LogError("the Transform of '" + value.name + "' cannot be destroyed alone"); return; }
            value.OnDestroyed();
        }
        internal virtual void OnDestroyed() { Mark(); }
        internal void Mark() { destroyed = true; Registry.Remove(this); }

        public static void DontDestroyOnLoad(Object value) { }
        public static T FindObjectOfType<T>() where T : Object { T[] all = FindObjectsOfType<T>(); return all.Length == 0 ? null : all[0]; }
        public static T[] FindObjectsOfType<T>() where T : Object { return FindObjectsOfType<T>(false); }
        public static T[] FindObjectsOfType<T>(bool includeInactive) where T : Object
        {
            List<T> found = new List<T>();
            foreach (Object value in Registry.All())
            {
                GameObject owner = value is GameObject ? (GameObject)value : value is Component ? ((Component)value).gameObject : null;
                if (value is T && !ReferenceEquals(owner, null) && value.assetPath == null && (includeInactive || owner.activeInHierarchy)) found.Add((T)value);
            }
            return found.ToArray();
        }
    }

    public class ScriptableObject : Object
    {
        public static T CreateInstance<T>() where T : ScriptableObject { return (T)CreateInstance(typeof(T)); }
        public static ScriptableObject CreateInstance(Type type)
        {
            ScriptableObject made = (ScriptableObject)Activator.CreateInstance(type, true);
            Messages.Send(made, "Awake");
            Messages.Send(made, "OnEnable");
            return made;
        }
        internal override void OnDestroyed() { Messages.Send(this, "OnDisable"); Messages.Send(this, "OnDestroy"); Mark(); }
    }
}

namespace UnityStubs
{
    /// Not copied, not saved, not part of a fingerprint.
    [AttributeUsage(AttributeTargets.Field)]
    internal sealed class TransientAttribute : Attribute { }

    /// Every object that was made and not destroyed. Game objects are held, as a scene holds them; other objects live while somebody refers to them.
    public static class Registry
    {
        static readonly HashSet<UnityEngine.Object> s_Held = new HashSet<UnityEngine.Object>();
        static readonly Dictionary<int, WeakReference> s_Alive = new Dictionary<int, WeakReference>();

        internal static void Add(UnityEngine.Object value) { lock (s_Alive) { s_Alive[value.id] = new WeakReference(value); if (value is UnityEngine.GameObject) s_Held.Add(value); } }
        internal static void Remove(UnityEngine.Object value) { lock (s_Alive) { s_Alive.Remove(value.id); s_Held.Remove(value); } }
        public static UnityEngine.Object Find(int id)
        {
            WeakReference reference;
            lock (s_Alive) return s_Alive.TryGetValue(id, out reference) ? (UnityEngine.Object)reference.Target : null;
        }
        public static List<UnityEngine.Object> All()
        {
            List<UnityEngine.Object> all = new List<UnityEngine.Object>();
            lock (s_Alive)
                foreach (WeakReference reference in s_Alive.Values)
                {
                    UnityEngine.Object value = (UnityEngine.Object)reference.Target;
                    if (!ReferenceEquals(value, null) && !value.destroyed) all.Add(value);
                }
            all.Sort(delegate (UnityEngine.Object a, UnityEngine.Object b) { return a.id.CompareTo(b.id); });
            return all;
        }
    }

    /// Calls the methods that Unity finds by name.
    internal static class Messages
    {
        public static void Send(object target, string method)
        {
            for (Type type = target.GetType(); type != null && type.Assembly != typeof(Messages).Assembly; type = type.BaseType)
            {
                MethodInfo found = type.GetMethod(method, BindingFlags.Instance | BindingFlags.Public | BindingFlags.NonPublic | BindingFlags.DeclaredOnly, null, Type.EmptyTypes, null);
                if (found == null) continue;
                try { found.Invoke(target, null); }
                catch (TargetInvocationException failure) { UnityEngine.Debug.LogException(failure.InnerException); }
                return;
            }
        }
    }
}
