using System;
using System.Collections.Generic;
using System.Globalization;
using System.IO;
using System.Runtime.CompilerServices;
using System.Text.RegularExpressions;
using UnityEditor;
using UnityEngine;

namespace SuperDeform.Editor
{
    /// <summary>What the package says to people, in their language.</summary>
    /// <remarks>
    /// The texts stand in one file a language beside this one, <c>en.json</c> and so on: an object from keys to
    /// texts, in which {0}, {1} stand for values. All have the same keys. English answers where another language cannot.
    /// </remarks>
    public static class Strings
    {
        const string Chosen = "SuperDeform.Language";
        static readonly string[] languages = { "en", "ja", "ko", "zh" };

        /// <summary>What each language calls itself, in the order of Languages.</summary>
        internal static readonly string[] LanguageNames = { "English", "日本語", "한국어", "简体中文" };

        static readonly Dictionary<string, Dictionary<string, string>> read =
            new Dictionary<string, Dictionary<string, string>>();
        static string language;

        /// <summary>The languages there are: "en", "ja", "ko", "zh" (simplified Chinese).</summary>
        public static IList<string> Languages => Array.AsReadOnly(languages);

        /// <summary>The language in use. At first the one chosen last, else the system's, else "en".</summary>
        /// <exception cref="ArgumentException">There is no such language.</exception>
        public static string Language
        {
            get
            {
                if (language == null)
                {
                    string own = OfSystem(Application.systemLanguage);
                    string chosen = EditorPrefs.GetString(Chosen, own);
                    language = Array.IndexOf(languages, chosen) >= 0 ? chosen : own;
                }
                return language;
            }
            set
            {
                if (Array.IndexOf(languages, value) < 0)
                {
                    throw new ArgumentException("There is no language " + value + ": use one of "
                        + string.Join(", ", languages) + ".");
                }
                language = value;
                EditorPrefs.SetString(Chosen, value);
            }
        }

        /// <summary>Uses a language of another tool, by its code, such as "ja-JP" or "zh-Hans"; one that there is no text in: English.</summary>
        internal static void Follow(string code)
        {
            string own = code.Length < 2 ? "en" : code.Substring(0, 2).ToLowerInvariant();
            // Simplified Chinese is what there is.
            bool other = code.StartsWith("zh-Hant", StringComparison.OrdinalIgnoreCase) || code.StartsWith("zh-TW", StringComparison.OrdinalIgnoreCase);
            Language = Array.IndexOf(languages, own) >= 0 && !other ? own : "en";
        }

        static string OfSystem(SystemLanguage system)
        {
            switch (system)
            {
                case SystemLanguage.Japanese: return "ja";
                case SystemLanguage.Korean: return "ko";
                case SystemLanguage.Chinese:
                case SystemLanguage.ChineseSimplified: return "zh";
                default: return "en";
            }
        }

        /// <summary>The text of a key, with the values put in; numbers are written with a point in every language.</summary>
        /// <returns>The key itself, and the values after it, where no language has it: nothing is lost.</returns>
        public static string Get(string key, params object[] values)
        {
            if (!Of(Language).TryGetValue(key, out string text) && !Of("en").TryGetValue(key, out text))
            {
                return values == null || values.Length == 0 ? key : key + ": " + string.Join(", ", values);
            }
            try
            {
                return values == null || values.Length == 0
                    ? text : string.Format(CultureInfo.InvariantCulture, text, values);
            }
            catch (FormatException)
            {
                return text;
            }
        }

        /// <summary>A sentence of the library with the name that the window has for what it is about.</summary>
        /// <remarks>
        /// It ends with a field of the library's: "head scale is 20: give a number from 0.1 to 10 (head_scale)". What has no
        /// name in the window is left out.
        /// </remarks>
        public static string OfLibrary(string sentence)
        {
            Match field = Regex.Match(sentence, @" \(([a-z_]+)(, or [a-z_]+)?\)$");
            if (!field.Success) return sentence;
            string key = "option." + field.Groups[1].Value;
            string label = Has(key) ? " (" + Get(key) + ")" : key.Contains("_") ? "" : field.Value;
            return sentence.Substring(0, field.Index) + label;
        }

        /// <summary>Whether English has a text for a key.</summary>
        public static bool Has(string key) => Of("en").ContainsKey(key);

        static Dictionary<string, string> Of(string language)
        {
            if (read.TryGetValue(language, out Dictionary<string, string> texts)) return texts;
            texts = new Dictionary<string, string>();
            // A file that cannot be read must not take the window down with it: then keys are shown.
            try
            {
                foreach (KeyValuePair<string, string> text in FlatJson.Read(File.ReadAllText(FileOf(language))))
                {
                    texts.Add(text.Key, text.Value);
                }
            }
            catch (Exception wrong)
            {
                Debug.LogWarning("Super Deform: the texts in " + FileOf(language) + " cannot be read: " + wrong.Message);
            }
            read.Add(language, texts);
            return texts;
        }

        /// <summary>Where the texts of a language are: in the package, or beside this file where it was compiled.</summary>
        internal static string FileOf(string language)
        {
            // Unity maps this virtual path to wherever the package lies (manual: Accessing package assets).
            string inPackage = Path.GetFullPath("Packages/com.superdeform.converter/Editor/Localization/" + language
                + ".json");
            return File.Exists(inPackage) ? inPackage : Path.Combine(Path.GetDirectoryName(ThisFile()), language + ".json");
        }

        static string ThisFile([CallerFilePath] string path = "") => path;
    }
}
