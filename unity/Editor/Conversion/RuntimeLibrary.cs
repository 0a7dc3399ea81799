using System;
using System.IO;
using UnityEditor;
using UnityEditor.Build;
using UnityEditor.Build.Reporting;

namespace SuperDeform.Editor
{
    /// <summary>
    /// Players hold nothing of this package but for who defines SUPERDEFORM_RUNTIME: then the native library for the player's
    /// system must be there, and a build without it ends with a sentence, not with the linker's.
    /// </summary>
    internal sealed class RuntimeLibrary : IPreprocessBuildWithReport
    {
        internal const string Define = "SUPERDEFORM_RUNTIME";

        public int callbackOrder => 0;

        /// <exception cref="BuildFailedException">The define is set, and no library for the system is in the build.</exception>
        public void OnPreprocessBuild(BuildReport report)
        {
            BuildTarget target = report.summary.platform;
            NamedBuildTarget named = NamedBuildTarget.FromBuildTargetGroup(BuildPipeline.GetBuildTargetGroup(target));
            bool defined = Array.IndexOf(PlayerSettings.GetScriptingDefineSymbols(named).Split(';'), Define) >= 0;
            if (!defined) return;
            string file = FileFor(target);
            foreach (PluginImporter importer in PluginImporter.GetImporters(target))
            {
                if (Path.GetFileName(importer.assetPath) == file) return;
            }
            throw new BuildFailedException(Strings.Get("runtime_library_missing", Define, file, target));
        }

        /// <summary>iOS and the web link a static library into the player; others load one.</summary>
        internal static string FileFor(BuildTarget target)
        {
            switch (target)
            {
                case BuildTarget.iOS:
                case BuildTarget.WebGL:
                    return "libsuperdeform.a";
                case BuildTarget.StandaloneWindows:
                case BuildTarget.StandaloneWindows64:
                    return "superdeform.dll";
                case BuildTarget.StandaloneOSX:
                    return "libsuperdeform.dylib";
                default:
                    return "libsuperdeform.so";
            }
        }
    }
}
