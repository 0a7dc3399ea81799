using System;
using System.IO;
using UnityEditor;
using PackageInfo = UnityEditor.PackageManager.PackageInfo;

namespace SuperDeform.Editor
{
    /// <summary>Where the manual is.</summary>
    internal static class Manual
    {
        const string Package = "Packages/com.superdeform.converter/";

        [InitializeOnLoadMethod]
        static void Tell()
        {
            ManualAttribute.Address = () => Address(PackageInfo.FindForAssetPath(Package + "package.json")?.documentationUrl, Strings.Language);
        }

        /// <summary>The page in a language: of the web where the package names one, as released ones do, else the file in the package.</summary>
        /// <param name="documentation">The address of the English page, superdeform.md; may be null.</param>
        internal static string Address(string documentation, string language)
        {
            string page = language == "en" ? "superdeform.md" : "superdeform." + language + ".md";
            if (!string.IsNullOrEmpty(documentation)) return documentation.Replace("superdeform.md", page);
            // Unity maps this virtual path to wherever the package lies (manual: Accessing package assets).
            return new Uri(Path.GetFullPath(Package + "Documentation~/" + page)).AbsoluteUri;
        }

        /// <summary>Opens it.</summary>
        [MenuItem("Tools/Super Deform/Manual", false, 20)]
        static void Open()
        {
            Help.BrowseURL(ManualAttribute.Address());
        }
    }
}
