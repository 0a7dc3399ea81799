// Help and what the Package Manager knows of a package.
using System;
using System.Collections.Generic;
using System.Linq;
using UnityEngine;
using Object = UnityEngine.Object;

namespace UnityEditor
{
    /// Of .unitypackage files; the Package Manager's has the same name.
    public struct PackageInfo { public string packagePath, jsonInfo, iconURL; }

    public class Help
    {
        /// As Unity does (Editor/Mono/Help.cs): the attribute's address as it stands, and no other help for a class that is not Unity's own.
        public static string GetHelpURLForObject(Object obj)
        {
            if (obj == null) return "";
            HelpURLAttribute help = obj.GetType().GetCustomAttributes(typeof(HelpURLAttribute), true).Cast<HelpURLAttribute>().FirstOrDefault();
            return help == null ? "" : help.URL;
        }

        public static bool HasHelpForObject(Object obj) { return !string.IsNullOrEmpty(GetHelpURLForObject(obj)); }
        public static void ShowHelpForObject(Object obj) { if (HasHelpForObject(obj)) BrowseURL(GetHelpURLForObject(obj)); }

        public static void BrowseURL(string url)
        {
            if (string.IsNullOrEmpty(url)) return;
            UnityStubs.Browser.Opened.Add(Uri.IsWellFormedUriString(url, UriKind.Absolute) ? url : "file://" + url);
        }
    }
}

namespace UnityEditor.AssetImporters
{
    public abstract class ScriptedImporter : AssetImporter { }
}

namespace UnityEditor.PackageManager
{
    public class PackageInfo
    {
        public string name { get; internal set; }
        public string documentationUrl { get; internal set; }

        /// Null where no package holds the path, as in a project that has the sources below Assets.
        public static PackageInfo FindForAssetPath(string assetPath)
        {
            if (string.IsNullOrEmpty(assetPath)) throw new ArgumentException("Asset path cannot be null or empty.", "assetPath");
            return UnityStubs.Browser.Packages.FirstOrDefault(package => assetPath.StartsWith("Packages/" + package.name + "/", StringComparison.Ordinal));
        }
    }
}

namespace UnityStubs
{
    public static class Browser
    {
        public static readonly List<string> Opened = new List<string>();
        internal static readonly List<UnityEditor.PackageManager.PackageInfo> Packages = new List<UnityEditor.PackageManager.PackageInfo>();

        public static void Reset()
        {
            Opened.Clear();
            Packages.Clear();
        }

        public static void Install(string name, string documentationUrl)
        {
            Packages.Add(new UnityEditor.PackageManager.PackageInfo { name = name, documentationUrl = documentationUrl });
        }
    }
}
