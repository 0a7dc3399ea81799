using UnityEditor;
using UnityEngine;

namespace SuperDeform.Editor
{
    /// <summary>What stands on the tabs of the package's windows.</summary>
    internal static class WindowTitle
    {
        const string Icon = "Packages/com.superdeform.converter/Editor/Icons/SuperDeform.png";

        /// <param name="key">Of the text.</param>
        internal static GUIContent Of(string key) => new GUIContent(Strings.Get(key), AssetDatabase.LoadAssetAtPath<Texture2D>(Icon));
    }
}
