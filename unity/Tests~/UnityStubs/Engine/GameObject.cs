// Game objects, components and the transforms that make hierarchies of them.
using System;
using System.Collections;
using System.Collections.Generic;
using UnityEngine.SceneManagement;
using UnityStubs;

namespace UnityEngine
{
    public enum Space { World, Self }

    public sealed class GameObject : Object
    {
        internal List<Component> components = new List<Component>();
        [Transient] internal Scene m_Scene;
        bool m_Active = true;
        int m_Layer;
        string m_Tag = "Untagged";
        bool m_Static;

        public GameObject() : this("New Game Object") { }
        public GameObject(string name) : this(name, new Type[0]) { }
        public GameObject(string name, params Type[] types) : this(name, HideFlags.None, types) { }
        internal GameObject(string name, HideFlags flags, Type[] types)
        {
            m_Name = name ?? "";
            m_Scene = SceneManager.GetActiveScene();
            Transform made = new Transform();
            made.m_GameObject = this;
            components.Add(made);
            hideFlags = flags;
            Changes.Of(this);
            foreach (Type type in types) AddComponent(type);
        }

        public GameObject gameObject { get { Alive(); return this; } }
        public Transform transform { get { Alive(); return (Transform)components[0]; } }
        public bool activeSelf { get { Alive(); return m_Active; } }
        public bool activeInHierarchy { get { Alive(); for (Transform at = transform; !ReferenceEquals(at, null); at = at.m_Parent) if (!at.gameObject.m_Active) return false; return assetPath == null; } }
        public void SetActive(bool value) { Alive(); m_Active = value; }
        public int layer { get { Alive(); return m_Layer; } set { if (value < 0 || value > 31) Debug.LogError("layers are 0 to 31, not " + value); else m_Layer = value; } }
        public string tag { get { Alive(); return m_Tag; } set { m_Tag = value; } }
        public bool isStatic { get { return m_Static; } set { m_Static = value; } }
        public bool CompareTag(string tag) { return m_Tag == tag; }
        public Scene scene { get { Alive(); return assetPath != null ? new Scene() : transform.root.gameObject.m_Scene; } }

        public T AddComponent<T>() where T : Component { return (T)AddComponent(typeof(T)); }
        public Component AddComponent(Type type)
        {
            Alive();
            if (type == null || type.IsAbstract || !typeof(Component).IsAssignableFrom(type) || type == typeof(Transform))
            {
                Debug.LogError("'" + (type == null ? "null" : type.Name) + "' is no component that can be added");
                return null;
            }
            foreach (RequireComponent need in type.GetCustomAttributes(typeof(RequireComponent), true))
                foreach (Type other in new[] { need.m_Type0, need.m_Type1, need.m_Type2 })
                    if (other != null && GetComponent(other) == null) AddComponent(other);
            if (OnlyOne(type) && GetComponent(OnlyOneOf(type)) != null)
            {
                Debug.LogError("'" + name + "' has a " + type.Name + " already, and may have only one");
                return null;
            }
            Component made = (Component)Activator.CreateInstance(type, true);
            made.m_GameObject = this;
            made.m_Name = "";
            components.Add(made);
            if (assetPath == null) Changes.Of(this);
            return made;
        }
        static bool OnlyOne(Type type) { return type.IsDefined(typeof(DisallowMultipleComponent), true); }
        static Type OnlyOneOf(Type type)
        {
            while (type.BaseType.IsDefined(typeof(DisallowMultipleComponent), true)) type = type.BaseType;
            return type;
        }

        public Component GetComponent(Type type) { Alive(); foreach (Component component in components) if (type.IsInstanceOfType(component) && !(component is MissingScript)) return component; return null; }
        public Component GetComponent(string type) { Alive(); foreach (Component component in components) if (component.GetType().Name == type) return component; return null; }
        public T GetComponent<T>() { Alive(); foreach (Component component in components) if (component is T && !(component is MissingScript)) return (T)(object)component; return default(T); }
        public bool TryGetComponent<T>(out T component) { component = GetComponent<T>(); return component != null; }
        public bool TryGetComponent(Type type, out Component component) { component = GetComponent(type); return component != null; }
        public T[] GetComponents<T>() { List<T> found = new List<T>(); GetComponents(found); return found.ToArray(); }
        public void GetComponents<T>(List<T> results) { Alive(); results.Clear(); Own(results); }
        // A component whose script is missing is a null among the components of all scripts.
        void Own<T>(List<T> found)
        {
            foreach (Component component in components)
            {
                if (component is MissingScript) { if (typeof(T).IsAssignableFrom(typeof(MonoBehaviour))) found.Add(default(T)); }
                else if (component is T) found.Add((T)(object)component);
            }
        }
        public Component[] GetComponents(Type type) { return GetComponents<Component>().Filter(type); }
        public T GetComponentInChildren<T>() { return GetComponentInChildren<T>(false); }
        public T GetComponentInChildren<T>(bool includeInactive) { T[] all = GetComponentsInChildren<T>(includeInactive); return all.Length == 0 ? default(T) : all[0]; }
        public Component GetComponentInChildren(Type type) { Component[] all = GetComponentsInChildren(type, false); return all.Length == 0 ? null : all[0]; }
        public Component GetComponentInChildren(Type type, bool includeInactive) { Component[] all = GetComponentsInChildren(type, includeInactive); return all.Length == 0 ? null : all[0]; }
        public T[] GetComponentsInChildren<T>() { return GetComponentsInChildren<T>(false); }
        public T[] GetComponentsInChildren<T>(bool includeInactive) { List<T> found = new List<T>(); Collect(this, includeInactive, found); return found.ToArray(); }
        public void GetComponentsInChildren<T>(List<T> results) { results.Clear(); Collect(this, false, results); }
        public void GetComponentsInChildren<T>(bool includeInactive, List<T> results) { results.Clear(); Collect(this, includeInactive, results); }
        public Component[] GetComponentsInChildren(Type type) { return GetComponentsInChildren(type, false); }
        public Component[] GetComponentsInChildren(Type type, bool includeInactive) { return GetComponentsInChildren<Component>(includeInactive).Filter(type); }
        static void Collect<T>(GameObject at, bool includeInactive, List<T> found)
        {
            at.Alive();
            // An asset is in no scene, and yet its components are found; only a switched-off branch is left out.
            if (!includeInactive && !at.m_Active) return;
            at.Own(found);
            foreach (Transform child in at.transform.children) Collect(child.gameObject, includeInactive, found);
        }
        public T GetComponentInParent<T>() { return GetComponentInParent<T>(false); }
        public T GetComponentInParent<T>(bool includeInactive) { T[] all = GetComponentsInParent<T>(includeInactive); return all.Length == 0 ? default(T) : all[0]; }
        public Component GetComponentInParent(Type type) { Component[] all = GetComponentsInParent<Component>(false).Filter(type); return all.Length == 0 ? null : all[0]; }
        public T[] GetComponentsInParent<T>() { return GetComponentsInParent<T>(false); }
        public T[] GetComponentsInParent<T>(bool includeInactive)
        {
            List<T> found = new List<T>();
            for (Transform at = transform; !ReferenceEquals(at, null); at = at.m_Parent)
                if (includeInactive || at.gameObject.activeInHierarchy) found.AddRange(at.gameObject.GetComponents<T>());
            return found.ToArray();
        }
        public static GameObject Find(string name)
        {
            foreach (Object value in Registry.All()) if (value is GameObject && value.assetPath == null && value.m_Name == name && ((GameObject)value).activeInHierarchy) return (GameObject)value;
            return null;
        }
        internal override void OnDestroyed()
        {
            Transform own = transform;
            if (assetPath == null) Changes.Of(this);
            foreach (Transform child in own.children.ToArray()) child.gameObject.OnDestroyed();
            foreach (Component component in components.ToArray()) { if (component is MonoBehaviour) Messages.Send(component, "OnDestroy"); component.Mark(); }
            if (!ReferenceEquals(own.m_Parent, null)) own.m_Parent.children.Remove(own);
            Mark();
        }
    }

    internal static class ComponentArrays
    {
        public static Component[] Filter(this Component[] all, Type type)
        {
            Component[] found = Array.FindAll(all, delegate (Component component) { return type.IsInstanceOfType(component); });
            Component[] typed = typeof(Component).IsAssignableFrom(type) ? (Component[])Array.CreateInstance(type, found.Length) : new Component[found.Length];
            Array.Copy(found, typed, found.Length);
            return typed;
        }
    }

    public class Component : Object
    {
        internal GameObject m_GameObject;
        internal override Object NameHolder { get { return ReferenceEquals(m_GameObject, null) ? (Object)this : m_GameObject; } }
        public GameObject gameObject { get { Alive(); return m_GameObject; } }
        public Transform transform { get { Alive(); return m_GameObject.transform; } }
        public string tag { get { return gameObject.tag; } set { gameObject.tag = value; } }
        public bool CompareTag(string tag) { return gameObject.CompareTag(tag); }
        public T GetComponent<T>() { return gameObject.GetComponent<T>(); }
        public Component GetComponent(Type type) { return gameObject.GetComponent(type); }
        public bool TryGetComponent<T>(out T component) { return gameObject.TryGetComponent(out component); }
        public T[] GetComponents<T>() { return gameObject.GetComponents<T>(); }
        public void GetComponents<T>(List<T> results) { gameObject.GetComponents(results); }
        public Component[] GetComponents(Type type) { return gameObject.GetComponents(type); }
        public T GetComponentInChildren<T>() { return gameObject.GetComponentInChildren<T>(); }
        public T GetComponentInChildren<T>(bool includeInactive) { return gameObject.GetComponentInChildren<T>(includeInactive); }
        public T[] GetComponentsInChildren<T>() { return gameObject.GetComponentsInChildren<T>(); }
        public T[] GetComponentsInChildren<T>(bool includeInactive) { return gameObject.GetComponentsInChildren<T>(includeInactive); }
        public void GetComponentsInChildren<T>(bool includeInactive, List<T> results) { gameObject.GetComponentsInChildren(includeInactive, results); }
        public Component[] GetComponentsInChildren(Type type, bool includeInactive) { return gameObject.GetComponentsInChildren(type, includeInactive); }
        public T GetComponentInParent<T>() { return gameObject.GetComponentInParent<T>(); }
        public T[] GetComponentsInParent<T>() { return gameObject.GetComponentsInParent<T>(); }
        public T[] GetComponentsInParent<T>(bool includeInactive) { return gameObject.GetComponentsInParent<T>(includeInactive); }
        internal override void OnDestroyed()
        {
            if (this is MonoBehaviour) Messages.Send(this, "OnDestroy");
            if (!ReferenceEquals(m_GameObject, null)) m_GameObject.components.Remove(this);
            Mark();
        }
    }

    public class Behaviour : Component
    {
        bool m_Enabled = true;
        public bool enabled { get { Alive(); return m_Enabled; } set { Alive(); m_Enabled = value; } }
        public bool isActiveAndEnabled { get { return enabled && gameObject.activeInHierarchy; } }
    }

    public class MonoBehaviour : Behaviour
    {
        public static void print(object message) { Debug.Log(message); }
    }

    internal sealed class MissingScript : MonoBehaviour { }

    [DisallowMultipleComponent]
    public class Transform : Component, IEnumerable
    {
        internal Transform m_Parent;
        internal List<Transform> children = new List<Transform>();
        Vector3 m_Position;
        Quaternion m_Rotation = Quaternion.identity;
        Vector3 m_Scale = Vector3.one;
        [Transient] bool m_Changed = true;

        internal Transform() { }

        public Vector3 localPosition { get { Alive(); return m_Position; } set { Alive(); Finite(value); m_Position = value; m_Changed = true; } }
        public Quaternion localRotation { get { Alive(); return m_Rotation; } set { Alive(); m_Rotation = Quaternion.Normalize(value); m_Changed = true; } }
        public Vector3 localScale { get { Alive(); return m_Scale; } set { Alive(); Finite(value); m_Scale = value; m_Changed = true; } }
        public Vector3 localEulerAngles { get { return localRotation.eulerAngles; } set { localRotation = Quaternion.Euler(value); } }
        public Vector3 eulerAngles { get { return rotation.eulerAngles; } set { rotation = Quaternion.Euler(value); } }
        public bool hasChanged { get { return m_Changed; } set { m_Changed = value; } }
        static void Finite(Vector3 v)
        {
            float sum = v.x + v.y + v.z;
            if (float.IsNaN(sum) || float.IsInfinity(sum)) throw new ArgumentException("transform: " + v + " is not finite");
        }

        public Matrix4x4 localToWorldMatrix
        {
            get
            {
                Alive();
                Matrix4x4 own = Matrix4x4.TRS(m_Position, m_Rotation, m_Scale);
                return ReferenceEquals(m_Parent, null) ? own : m_Parent.localToWorldMatrix * own;
            }
        }
        public Matrix4x4 worldToLocalMatrix { get { return localToWorldMatrix.inverse; } }
        public Vector3 position
        {
            get { Alive(); return ReferenceEquals(m_Parent, null) ? m_Position : m_Parent.localToWorldMatrix.MultiplyPoint3x4(m_Position); }
            set { localPosition = ReferenceEquals(m_Parent, null) ? value : m_Parent.worldToLocalMatrix.MultiplyPoint3x4(value); }
        }
        public Quaternion rotation
        {
            get { Alive(); return ReferenceEquals(m_Parent, null) ? m_Rotation : Quaternion.Normalize(m_Parent.rotation * m_Rotation); }
            set { localRotation = ReferenceEquals(m_Parent, null) ? value : Quaternion.Inverse(m_Parent.rotation) * value; }
        }
        // What the world matrix scales along the axes of the world rotation: exact unless a rotated child has an unevenly scaled parent.
        public Vector3 lossyScale
        {
            get
            {
                Matrix4x4 own = Matrix4x4.Rotate(Quaternion.Inverse(rotation)) * localToWorldMatrix;
                return new Vector3(own.m00, own.m11, own.m22);
            }
        }
        public Vector3 right { get { return rotation * Vector3.right; } }
        public Vector3 up { get { return rotation * Vector3.up; } set { rotation = Quaternion.FromToRotation(Vector3.up, value); } }
        public Vector3 forward { get { return rotation * Vector3.forward; } set { rotation = Quaternion.LookRotation(value); } }
        public void SetPositionAndRotation(Vector3 position, Quaternion rotation) { this.rotation = rotation; this.position = position; }
        public void Translate(Vector3 by) { position += rotation * by; }
        public void Translate(Vector3 by, Space relativeTo) { position += relativeTo == Space.World ? by : rotation * by; }
        public void Rotate(Vector3 degrees) { localRotation = localRotation * Quaternion.Euler(degrees); }
        public void Rotate(float x, float y, float z) { Rotate(new Vector3(x, y, z)); }
        public void Rotate(Vector3 axis, float degrees) { localRotation = localRotation * Quaternion.AngleAxis(degrees, axis); }
        public void LookAt(Vector3 target) { rotation = Quaternion.LookRotation(target - position); }
        public Vector3 TransformPoint(Vector3 point) { return localToWorldMatrix.MultiplyPoint3x4(point); }
        public Vector3 TransformPoint(float x, float y, float z) { return TransformPoint(new Vector3(x, y, z)); }
        public Vector3 InverseTransformPoint(Vector3 point) { return worldToLocalMatrix.MultiplyPoint3x4(point); }
        public Vector3 TransformVector(Vector3 v) { return localToWorldMatrix.MultiplyVector(v); }
        public Vector3 InverseTransformVector(Vector3 v) { return worldToLocalMatrix.MultiplyVector(v); }
        public Vector3 TransformDirection(Vector3 v) { return rotation * v; }
        public Vector3 InverseTransformDirection(Vector3 v) { return Quaternion.Inverse(rotation) * v; }

        public Transform parent { get { Alive(); return m_Parent; } set { SetParent(value, true); } }
        public Transform root { get { Alive(); Transform at = this; while (!ReferenceEquals(at.m_Parent, null)) at = at.m_Parent; return at; } }
        public int childCount { get { Alive(); return children.Count; } }
        public int hierarchyCount { get { int count = 1; foreach (Transform child in children) count += child.hierarchyCount; return count; } }
        public Transform GetChild(int index)
        {
            Alive();
            if (index < 0 || index >= children.Count) throw new UnityException("'" + name + "' has no child " + index);
            return children[index];
        }
        public void SetParent(Transform parent) { SetParent(parent, true); }
        public void SetParent(Transform parent, bool worldPositionStays)
        {
            Alive();
            if (parent != null && parent.IsChildOf(this)) { Debug.LogError("'" + name + "' cannot hang from itself or from its children"); return; }
            if (gameObject.assetPath != null) { Debug.LogError("'" + name + "' is part of a prefab asset: its parent cannot be set"); return; }
            Matrix4x4 world = localToWorldMatrix;
            Quaternion turned = rotation;
            Scene scene = gameObject.scene;
            if (!ReferenceEquals(m_Parent, parent == null ? null : parent)) Changes.Of(gameObject);
            if (!ReferenceEquals(m_Parent, null)) m_Parent.children.Remove(this);
            m_Parent = parent == null ? null : parent;
            if (!ReferenceEquals(m_Parent, null)) m_Parent.children.Add(this); else gameObject.m_Scene = scene;
            if (!worldPositionStays) return;
            Matrix4x4 local = ReferenceEquals(m_Parent, null) ? world : m_Parent.worldToLocalMatrix * world;
            m_Position = local.GetPosition();
            rotation = turned;
            Matrix4x4 left = Matrix4x4.Rotate(Quaternion.Inverse(m_Rotation)) * local;
            m_Scale = new Vector3(left.m00, left.m11, left.m22);
        }
        public void DetachChildren() { foreach (Transform child in children.ToArray()) child.SetParent(null, true); }
        public bool IsChildOf(Transform other) { Alive(); for (Transform at = this; !ReferenceEquals(at, null); at = at.m_Parent) if (ReferenceEquals(at, other)) return true; return false; }
        public int GetSiblingIndex() { return ReferenceEquals(m_Parent, null) ? 0 : m_Parent.children.IndexOf(this); }
        public void SetSiblingIndex(int index) { if (ReferenceEquals(m_Parent, null)) return; List<Transform> row = m_Parent.children; row.Remove(this); row.Insert(Mathf.Clamp(index, 0, row.Count), this); }
        public void SetAsFirstSibling() { SetSiblingIndex(0); }
        public void SetAsLastSibling() { SetSiblingIndex(int.MaxValue); }
        // A name, or a path of names with slashes, from the direct children on.
        public Transform Find(string path)
        {
            Alive();
            if (path == null) throw new ArgumentNullException("path");
            if (path.Length == 0) return this;
            foreach (Transform child in children) if (child.name == path) return child;
            int slash = path.IndexOf('/');
            if (slash < 0) return null;
            string first = path.Substring(0, slash);
            foreach (Transform child in children)
                if (child.name == first) { Transform found = child.Find(path.Substring(slash + 1)); if (!ReferenceEquals(found, null)) return found; }
            return null;
        }
        public IEnumerator GetEnumerator() { return children.ToArray().GetEnumerator(); }
    }
}
