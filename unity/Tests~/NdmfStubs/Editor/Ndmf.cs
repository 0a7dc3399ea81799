// See README.md for where each member was read.
using System;
using System.Collections.Generic;
using nadena.dev.ndmf.fluent;
using nadena.dev.ndmf.localization;
using nadena.dev.ndmf.preview;
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

    public sealed class BuildContext
    {
        sealed class Saver : IAssetSaver { public void SaveAsset(Object asset) { NdmfStub.Saved.Add(asset); } }
        public GameObject AvatarRootObject { get; private set; }
        public IAssetSaver AssetSaver { get; private set; }
        public BuildContext(GameObject obj, string assetRootPath) { AvatarRootObject = obj; AssetSaver = new Saver(); }
    }

    public sealed class ObjectRegistry
    {
        public static void RegisterReplacedObject(Object oldObject, Object newObject) { NdmfStub.Replaced.Add(new KeyValuePair<Object, Object>(oldObject, newObject)); }
    }

    public enum ErrorSeverity { Information, NonFatal, Error, InternalError }

    public sealed class ErrorReport
    {
        // As the real one: every argument is turned into text, and objects are references.
        public static void ReportError(Localizer localizer, ErrorSeverity severity, string key, params object[] args)
        {
            string[] texts = Array.ConvertAll(args, argument => argument.ToString());
            NdmfStub.Report.Add(severity + ": " + localizer.Get(key) + ": " + string.Format(localizer.Get(key + ":description"), texts));
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
        internal InlinePass Pass;
        public Sequence BeforePlugin(string qualifiedName, string sourceFile = "", int sourceLine = 0) { Before.Add(qualifiedName); return this; }
        public Sequence AfterPlugin(string qualifiedName, string sourceFile = "", int sourceLine = 0) { After.Add(qualifiedName); return this; }
        public DeclaringPass Run(string displayName, InlinePass inlinePass, string sourceFile = "", int sourceLine = 0) { Pass = inlinePass; return new DeclaringPass(); }
    }
}

namespace nadena.dev.ndmf.localization
{
    public class Localizer
    {
        readonly Dictionary<string, Func<string, string>> m_Languages = new Dictionary<string, Func<string, string>>();
        readonly string m_Default;
        public Localizer(string defaultLanguage, Func<List<ValueTuple<string, Func<string, string>>>> lookup)
        {
            m_Default = defaultLanguage;
            foreach (var pair in lookup()) m_Languages.Add(System.Globalization.CultureInfo.GetCultureInfo(pair.Item1).Name, pair.Item2);
        }
        internal string Get(string key)
        {
            string text = m_Languages[m_Default](key);
            if (text == null || text == key) throw new InvalidOperationException("no text for " + key);
            return text;
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

        /// Runs a plugin's passes on a clone; gives the phases and constraints as text.
        public static string Build<T>(GameObject clone) where T : Plugin<T>, new()
        {
            Saved.Clear(); Replaced.Clear(); Report.Clear(); Sequences.Clear(); Filters.Clear();
            new T().Begin();
            string said = "";
            foreach (Sequence sequence in Sequences)
            {
                said += (sequence.Phase == BuildPhase.Transforming ? "Transforming" : "?") + " after " + string.Join(", ", sequence.After) + " before " + string.Join(", ", sequence.Before);
                sequence.Pass(new BuildContext(clone, null));
            }
            return said;
        }
    }
}
