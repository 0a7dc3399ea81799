// See README.md for where each member was read.
using System;
using System.Collections;
using System.Collections.Generic;
using nadena.dev.ndmf.fluent;
using nadena.dev.ndmf.localization;
using nadena.dev.ndmf.preview;
using nadena.dev.ndmf.runtime.components;
using UnityEditor;
using UnityEngine;
using Object = UnityEngine.Object;

namespace nadena.dev.ndmf
{
    [AttributeUsage(AttributeTargets.Assembly, AllowMultiple = true)]
    public sealed class ExportsPlugin : Attribute
    {
        public Type PluginType { get; private set; }
        public ExportsPlugin(Type pluginType) { PluginType = pluginType; }
    }

    [AttributeUsage(AttributeTargets.Class)]
    public sealed class RunsOnAllPlatforms : Attribute { }

    public sealed class BuildPhase
    {
        public static readonly BuildPhase Resolving = new BuildPhase(), Generating = new BuildPhase(), Transforming = new BuildPhase(), Optimizing = new BuildPhase();
    }

    public abstract class PluginBase
    {
        public abstract string QualifiedName { get; }
        public abstract string DisplayName { get; }
    }

    public abstract class Plugin<T> : PluginBase where T : Plugin<T>, new()
    {
        public override string QualifiedName { get { return typeof(T).FullName; } }
        public override string DisplayName { get { return QualifiedName; } }
        protected abstract void Configure();
        protected Sequence InPhase(BuildPhase phase) { Sequence sequence = new Sequence { Phase = phase }; NdmfStub.Sequences.Add(sequence); return sequence; }
        internal void Begin() { Configure(); }
    }

    public interface IAssetSaver { void SaveAsset(Object asset); }

    public interface IExtensionContext
    {
        void OnActivate(BuildContext context);
        void OnDeactivate(BuildContext context);
    }

    [AttributeUsage(AttributeTargets.Class)]
    public sealed class DependsOnContext : Attribute { internal readonly Type Other; public DependsOnContext(Type t) { Other = t; } }

    public sealed class BuildContext
    {
        // Nothing is saved twice, and what is an asset already not at all.
        sealed class Saver : IAssetSaver
        {
            public void SaveAsset(Object asset)
            {
                if (NdmfStub.Refuse != null) NdmfStub.Refuse(asset);
                if (asset != null && !EditorUtility.IsPersistent(asset) && !NdmfStub.Saved.Contains(asset)) NdmfStub.Saved.Add(asset);
            }
        }
        readonly Dictionary<Type, IExtensionContext> m_Active = new Dictionary<Type, IExtensionContext>();
        public GameObject AvatarRootObject { get; private set; }
        public Transform AvatarRootTransform { get { return AvatarRootObject.transform; } }
        public IAssetSaver AssetSaver { get; private set; }
        public BuildContext(GameObject obj, string assetRootPath)
        {
            if (obj.GetComponent<NDMFAvatarRoot>() == null) obj.AddComponent<NDMFAvatarRoot>();
            ObjectRegistry.Begin();
            if (obj.CompareTag("EditorOnly")) throw new Exception("Can't process an avatar whose root object is marked as EditorOnly");
            AvatarRootObject = obj;
            AssetSaver = new Saver();
            foreach (Transform at in obj.GetComponentsInChildren<Transform>(true))
                if (PrefabUtility.IsPartOfAnyPrefab(at)) throw new Exception("Can't process an avatar that contains prefab instances/assets");
            foreach (Transform at in obj.GetComponentsInChildren<Transform>(true))
            {
                ObjectRegistry.GetReference(at.gameObject);
                foreach (Component component in at.GetComponents<Component>()) if (component != null) ObjectRegistry.GetReference(component);
            }
        }
        public T Extension<T>() where T : IExtensionContext
        {
            IExtensionContext found;
            if (!m_Active.TryGetValue(typeof(T), out found)) throw new Exception("Extension " + typeof(T) + " not active");
            return (T)found;
        }
        internal void Activate(Type type)
        {
            if (m_Active.ContainsKey(type)) return;
            foreach (DependsOnContext needs in type.GetCustomAttributes(typeof(DependsOnContext), false)) Activate(needs.Other);
            IExtensionContext made = (IExtensionContext)Activator.CreateInstance(type);
            made.OnActivate(this);
            m_Active.Add(type, made);
        }
        internal void Finish()
        {
            foreach (IExtensionContext context in m_Active.Values) context.OnDeactivate(this);
            m_Active.Clear();
        }
    }

    public sealed class ObjectReference
    {
        public Object Object { get; private set; }
        internal ObjectReference(Object of) { Object = of; }
        public override string ToString() { return Object == null ? "<missing>" : Object.name; }
    }

    /// Which object stands for which of the avatar's own. One that has a reference of its own can no longer be said to stand for another.
    public sealed class ObjectRegistry
    {
        static readonly Dictionary<Object, ObjectReference> s_References = new Dictionary<Object, ObjectReference>();
        internal static void Begin() { s_References.Clear(); NdmfStub.Replaced.Clear(); }
        public static ObjectReference GetReference(Object obj)
        {
            if (obj == null) return null;
            ObjectReference found;
            if (!s_References.TryGetValue(obj, out found)) s_References.Add(obj, found = new ObjectReference(obj));
            return found;
        }
        public static ObjectReference RegisterReplacedObject(Object oldObject, Object newObject)
        {
            ObjectReference old = GetReference(oldObject);
            if (!TryRegisterReplacedObject(old, newObject)) throw new ArgumentException("RegisterReplacedObject must be called before GetReference is called on the new object");
            return old;
        }
        public static bool TryRegisterReplacedObject(ObjectReference oldObject, Object newObject)
        {
            if (oldObject == null) throw new NullReferenceException("oldObject must not be null");
            if (newObject == null) throw new NullReferenceException("newObject must not be null");
            if (s_References.ContainsKey(newObject)) return false;
            s_References.Add(newObject, oldObject);
            NdmfStub.Replaced.Add(new KeyValuePair<Object, Object>(oldObject.Object, newObject));
            return true;
        }
    }

    public enum ErrorSeverity { Information, NonFatal, Error, InternalError }

    public sealed class ErrorReport
    {
        public static void ReportError(Localizer localizer, ErrorSeverity severity, string key, params object[] args)
        {
            List<string> texts = new List<string>();
            Add(args, texts);
            NdmfStub.Report.Add(severity + ": " + Put(localizer.Get(key), texts) + ": " + Put(localizer.Get(key + ":description"), texts));
        }
        // Every argument is turned into text; objects are references too.
        static void Add(IEnumerable args, List<string> texts)
        {
            foreach (object argument in args)
            {
                Object thing = argument as Object;
                if (argument == null) texts.Add("<missing>");
                else if (argument is string) texts.Add((string)argument);
                else if (!ReferenceEquals(thing, null)) texts.Add(ObjectRegistry.GetReference(thing).ToString());
                else if (argument is IEnumerable) Add((IEnumerable)argument, texts);
                else texts.Add(argument.ToString());
            }
        }
        // {0} to {9}; what there is nothing for stays, and nothing else is special.
        static string Put(string text, List<string> texts)
        {
            return System.Text.RegularExpressions.Regex.Replace(text, "\\{([0-9])\\}", match => { int at = match.Groups[1].Value[0] - '0'; return at < texts.Count ? texts[at] : match.Value; });
        }
    }
}

namespace nadena.dev.ndmf.fluent
{
    public delegate void InlinePass(BuildContext context);
    public sealed class DeclaringPass { public DeclaringPass PreviewingWith(params IRenderFilter[] filters) { NdmfStub.Filters.AddRange(filters); return this; } }
    public sealed class Sequence
    {
        internal BuildPhase Phase;
        internal readonly List<string> Before = new List<string>(), After = new List<string>();
        internal readonly List<Type> Needs = new List<Type>();
        internal readonly List<KeyValuePair<InlinePass, Type[]>> Passes = new List<KeyValuePair<InlinePass, Type[]>>();
        public Sequence BeforePlugin(string qualifiedName, string sourceFile = "", int sourceLine = 0) { Before.Add(qualifiedName); return this; }
        public Sequence AfterPlugin(string qualifiedName, string sourceFile = "", int sourceLine = 0) { After.Add(qualifiedName); return this; }
        public void WithRequiredExtension(Type extension, Action<Sequence> action)
        {
            Needs.Add(extension);
            try { action(this); }
            finally { Needs.Remove(extension); }
        }
        public DeclaringPass Run(string displayName, InlinePass inlinePass, string sourceFile = "", int sourceLine = 0)
        {
            Passes.Add(new KeyValuePair<InlinePass, Type[]>(inlinePass, Needs.ToArray()));
            return new DeclaringPass();
        }
    }
}

namespace nadena.dev.ndmf.localization
{
    public sealed class Localizer
    {
        readonly Dictionary<string, Func<string, string>> m_Languages = new Dictionary<string, Func<string, string>>(StringComparer.OrdinalIgnoreCase);
        readonly string m_Default;
        public Localizer(string defaultLanguage, Func<List<ValueTuple<string, Func<string, string>>>> lookup)
        {
            m_Default = defaultLanguage;
            foreach (var pair in lookup()) m_Languages.Add(System.Globalization.CultureInfo.GetCultureInfo(pair.Item1).Name, pair.Item2);
        }
        internal string Get(string key)
        {
            Func<string, string> own;
            string text = m_Languages.TryGetValue(LanguagePrefs.Language, out own) ? own(key) : null;
            text = text ?? m_Languages[m_Default](key);
            if (text == null || text == key) throw new InvalidOperationException("no text for " + key);
            return text;
        }
    }

    public static class LanguagePrefs
    {
        static string s_Language = "en-us";
        static readonly List<Action> s_Callbacks = new List<Action>();
        public static string Language
        {
            get { return s_Language; }
            set
            {
                value = value.ToLowerInvariant();
                if (value == s_Language) return;
                s_Language = value;
                foreach (Action callback in s_Callbacks.ToArray()) callback();
            }
        }
        // Held as long as the handle lives.
        public static void RegisterLanguageChangeCallback<T>(T handle, Action<T> callback) where T : class
        {
            WeakReference<T> held = new WeakReference<T>(handle);
            s_Callbacks.Add(() => { T alive; if (held.TryGetTarget(out alive)) callback(alive); });
        }
    }
}

namespace nadena.dev.ndmf
{
    /// What tests see of a build.
    public static class NdmfStub
    {
        public static readonly List<Object> Saved = new List<Object>();
        public static readonly List<KeyValuePair<Object, Object>> Replaced = new List<KeyValuePair<Object, Object>>();
        public static readonly List<string> Report = new List<string>();
        internal static readonly List<Sequence> Sequences = new List<Sequence>();

        /// What stands for the passes in a preview.
        public static readonly List<IRenderFilter> Filters = new List<IRenderFilter>();

        /// May throw where an asset is to be saved, as a full disk does.
        public static Action<Object> Refuse;

        /// Whether the avatar could be uploaded.
        public static bool Uploads { get { return !Report.Exists(line => line.StartsWith("Error") || line.StartsWith("InternalError")); } }

        /// Runs a plugin's passes on a clone, after what an earlier plugin does; gives the phases and constraints as text. What a pass throws stands in the report.
        public static string Build<T>(GameObject clone, Action<BuildContext> earlier = null) where T : Plugin<T>, new()
        {
            Saved.Clear(); Report.Clear(); Sequences.Clear(); Filters.Clear();
            new T().Begin();
            string said = "";
            BuildContext context = new BuildContext(clone, null);
            if (earlier != null) earlier(context);
            foreach (Sequence sequence in Sequences)
            {
                said += (sequence.Phase == BuildPhase.Transforming ? "Transforming" : "?") + " after " + string.Join(", ", sequence.After) + " before " + string.Join(", ", sequence.Before);
                foreach (KeyValuePair<InlinePass, Type[]> pass in sequence.Passes)
                    try
                    {
                        foreach (Type extension in pass.Value) context.Activate(extension);
                        pass.Key(context);
                    }
                    catch (Exception fault) { Report.Add("InternalError: " + fault.GetType().Name + ": " + fault.Message); }
            }
            context.Finish();
            return said;
        }
    }
}
