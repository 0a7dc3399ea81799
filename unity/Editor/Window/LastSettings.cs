using System;
using System.IO;
using UnityEditor;
using UnityEngine;

namespace SuperDeform.Editor
{
    /// <summary>
    /// The settings that a person worked by last, kept with the project and out of version control: a window that is opened again, the
    /// menu command and the batch go on with them.
    /// </summary>
    internal static class LastSettings
    {
        const string Reference = "ReferenceAvatar", Style = "SavedStyle";

        static string File => Path.Combine(Path.GetDirectoryName(Application.dataPath), "UserSettings/SuperDeform.txt");

        /// <summary>The usual ones where there are none yet, or they cannot be read.</summary>
        internal static ConversionSettings Read()
        {
            string text = "";
            try
            {
                if (System.IO.File.Exists(File)) text = System.IO.File.ReadAllText(File);
            }
            catch (Exception cause)
            {
                if (!(cause is IOException) && !(cause is UnauthorizedAccessException)) throw;
                Debug.LogWarning("[Super Deform] " + Strings.Get("error.settings_file", File, cause.Message));
            }
            ConversionSettings settings = SettingsText.Read(text);
            settings.ReferenceAvatar = Asset<GameObject>(text, Reference);
            settings.SavedStyle = Asset<TextAsset>(text, Style);
            return settings;
        }

        /// <summary>An object of a scene is not kept: no file can name it.</summary>
        internal static void Write(ConversionSettings settings)
        {
            string text = SettingsText.Write(settings) + Line(Reference, settings.ReferenceAvatar) + Line(Style, settings.SavedStyle);
            try
            {
                if (System.IO.File.Exists(File) && System.IO.File.ReadAllText(File) == text) return;
                Directory.CreateDirectory(Path.GetDirectoryName(File));
                System.IO.File.WriteAllText(File, text);
            }
            catch (Exception cause)
            {
                if (!(cause is IOException) && !(cause is UnauthorizedAccessException)) throw;
                Debug.LogWarning("[Super Deform] " + Strings.Get("error.settings_file", File, cause.Message));
            }
        }

        static string Line(string name, UnityEngine.Object asset)
        {
            string path = asset == null ? "" : AssetDatabase.GetAssetPath(asset);
            return string.IsNullOrEmpty(path) ? "" : name + " = " + AssetDatabase.AssetPathToGUID(path) + "\n";
        }

        static T Asset<T>(string text, string name) where T : UnityEngine.Object
        {
            foreach (string line in text.Split('\n'))
            {
                if (!line.StartsWith(name + " = ", StringComparison.Ordinal)) continue;
                string path = AssetDatabase.GUIDToAssetPath(line.Substring(name.Length + 3).Trim());
                if (!string.IsNullOrEmpty(path)) return AssetDatabase.LoadAssetAtPath<T>(path);
            }
            return null;
        }
    }
}
