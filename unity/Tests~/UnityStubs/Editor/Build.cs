// What is asked and told before a player is built.
using System;
using System.Collections.Generic;
using UnityEditor.Build;

namespace UnityEditor
{
    public enum BuildTarget { StandaloneOSX = 2, StandaloneWindows = 5, iOS = 9, Android = 13, StandaloneWindows64 = 19, WebGL = 20, StandaloneLinux64 = 24 }
    public enum BuildTargetGroup { Unknown = 0, Standalone = 1, iOS = 4, Android = 7, WebGL = 13 }
    public class BuildPipeline
    {
        public static BuildTargetGroup GetBuildTargetGroup(BuildTarget platform)
        {
            switch (platform)
            {
                case BuildTarget.iOS: return BuildTargetGroup.iOS;
                case BuildTarget.Android: return BuildTargetGroup.Android;
                case BuildTarget.WebGL: return BuildTargetGroup.WebGL;
                default: return BuildTargetGroup.Standalone;
            }
        }
    }
    public sealed class PlayerSettings
    {
        static readonly Dictionary<string, string> s_Defines = new Dictionary<string, string>();
        public static string GetScriptingDefineSymbols(NamedBuildTarget buildTarget) { string found; return s_Defines.TryGetValue(buildTarget.TargetName, out found) ? found : ""; }
        public static void SetScriptingDefineSymbols(NamedBuildTarget buildTarget, string defines) { s_Defines[buildTarget.TargetName] = defines; }
    }
    public sealed class PluginImporter : AssetImporter
    {
        internal static readonly List<KeyValuePair<BuildTarget, PluginImporter>> Known = new List<KeyValuePair<BuildTarget, PluginImporter>>();
        public static PluginImporter[] GetImporters(BuildTarget platform) { return Known.FindAll(pair => pair.Key == platform).ConvertAll(pair => pair.Value).ToArray(); }
    }
}

namespace UnityEditor.Build
{
    public readonly struct NamedBuildTarget
    {
        public string TargetName { get; }
        NamedBuildTarget(string name) { TargetName = name; }
        public static NamedBuildTarget FromBuildTargetGroup(BuildTargetGroup buildTargetGroup) { return new NamedBuildTarget(buildTargetGroup.ToString()); }
    }
    public class BuildFailedException : Exception { public BuildFailedException(string message) : base(message) { } }
    public interface IOrderedCallback { int callbackOrder { get; } }
    public interface IPreprocessBuildWithReport : IOrderedCallback { void OnPreprocessBuild(Reporting.BuildReport report); }
}

namespace UnityEditor.Build.Reporting
{
    public struct BuildSummary { public BuildTarget platform { get; internal set; } }
    public sealed class BuildReport : UnityEngine.Object
    {
        public BuildSummary summary { get; internal set; }
        internal BuildReport() { }
    }
}

namespace UnityStubs
{
    /// Builds that tests begin.
    public static class StubBuild
    {
        public static UnityEditor.Build.Reporting.BuildReport Of(UnityEditor.BuildTarget target)
        {
            return new UnityEditor.Build.Reporting.BuildReport { summary = new UnityEditor.Build.Reporting.BuildSummary { platform = target } };
        }
        public static void AddPlugin(UnityEditor.BuildTarget target, string path)
        {
            UnityEditor.PluginImporter.Known.Add(new KeyValuePair<UnityEditor.BuildTarget, UnityEditor.PluginImporter>(target, new UnityEditor.PluginImporter { m_Path = path }));
        }
    }
}
