using System;
using System.Collections.Generic;
using System.Globalization;
using UnityEditor;
using UnityEngine;

namespace SuperDeform.Editor
{
    /// <summary>What a command line asks a batch to do; the options are listed at BatchConvert.</summary>
    public sealed class BatchArguments
    {
        private const string Prefix = "-superdeform";

        /// <summary>Paths of prefabs, as given.</summary>
        public List<string> Avatars = new List<string>();
        public ConversionSettings Settings = new ConversionSettings();
        /// <summary>Where the report goes; null: nowhere.</summary>
        public string ReportPath;

        private readonly Dictionary<string, string> given =
            new Dictionary<string, string>(StringComparer.OrdinalIgnoreCase);
        private readonly List<string> groups = new List<string>();

        private static readonly string[] known =
        {
            "Avatars", "Heads", "Reference", "Style", "Blend", "Amount", "HeadScale", "HairLength", "FaceSquash",
            "FaceCurve", "Group", "Rig", "Output", "Report", "Language"
        };

        /// <summary>Reads a command line: options that do not begin with -superdeform are somebody else's.</summary>
        /// <exception cref="ArgumentException">An option is unknown, lacks its value or has a wrong one; in one sentence.
        /// </exception>
        public static BatchArguments Read(IList<string> arguments)
        {
            var result = new BatchArguments();
            for (int i = 0; i < arguments.Count; i++)
                if (arguments[i].StartsWith(Prefix, StringComparison.OrdinalIgnoreCase))
                    result.Take(arguments[i], i + 1 < arguments.Count ? arguments[++i] : null);
            result.Understand();
            return result;
        }

        private void Take(string option, string value)
        {
            string name = Array.Find(known, word => Same(Prefix + word, option));
            if (name == null)
                throw Wrong("batch.unknown", option, string.Join(", ", Array.ConvertAll(known, word => Prefix + word)));
            if (value == null || value.StartsWith(Prefix, StringComparison.OrdinalIgnoreCase))
                throw Wrong("batch.no_value", option);
            if (name == "Group")
                groups.Add(value);
            else if (given.ContainsKey(name))
                throw Wrong("batch.twice", option);
            else
                given.Add(name, value);
        }

        private void Understand()
        {
            // First, so that the sentences after it are in the language asked for.
            if (given.ContainsKey("Language"))
                Strings.Language = Word("Language", "en", "ja");
            string avatars;
            if (given.TryGetValue("Avatars", out avatars))
                foreach (string path in avatars.Split(';'))
                    if (path.Trim().Length > 0)
                        Avatars.Add(path.Trim().Replace('\\', '/'));
            if (Avatars.Count == 0)
                throw Wrong("batch.no_avatars");
            Number("Heads", 1.8f, 6, ref Settings.Heads);
            Number("Blend", 0, 1, ref Settings.Blend);
            Number("Amount", 0, 1, ref Settings.Amount);
            Number("HeadScale", 0.1f, 10, ref Settings.HeadScale);
            Number("HairLength", 0, 1, ref Settings.HairLength);
            Number("FaceSquash", -10, 10, ref Settings.FaceSquash);
            if (given.ContainsKey("FaceCurve"))
                Settings.FaceCurve = (FaceCurve)Array.IndexOf(curves, Word("FaceCurve", curves));
            if (given.ContainsKey("Rig"))
                Settings.RigAuto = Word("Rig", "keep", "auto") == "auto";
            string folder;
            if (given.TryGetValue("Output", out folder))
                Settings.OutputFolder = folder.Replace('\\', '/');
            given.TryGetValue("Report", out ReportPath);
            foreach (string group in groups)
                TakeGroup(group);
            TakeStyle();
        }

        // In the order of FaceCurve.
        private static readonly string[] curves = { "f4", "f2", "sphere" };

        // superdeform.h, sdef_style_from_text.
        private static readonly string[] builtIn = { "sd2", "sd2.5", "sd3", "sd4" };

        private void TakeStyle()
        {
            string reference, style;
            given.TryGetValue("Reference", out reference);
            given.TryGetValue("Style", out style);
            if (reference != null && style != null)
                throw Wrong("batch.two_styles", Prefix + "Reference", Prefix + "Style");
            Settings.Source = StyleSource.Heads;
            if (reference != null)
            {
                Settings.Source = StyleSource.ReferenceAvatar;
                Settings.ReferenceAvatar = AssetDatabase.LoadAssetAtPath<GameObject>(reference.Replace('\\', '/'));
                if (Settings.ReferenceAvatar == null)
                    throw Wrong("batch.not_found", reference);
            }
            if (Array.IndexOf(builtIn, style) >= 0)
            {
                Settings.Source = StyleSource.BuiltIn;
                Settings.BuiltInStyle = style;
            }
            else if (style != null)
            {
                Settings.Source = StyleSource.SavedStyle;
                Settings.SavedStyle = AssetDatabase.LoadAssetAtPath<TextAsset>(style.Replace('\\', '/'));
                if (Settings.SavedStyle == null)
                    throw Wrong("batch.style_not_found", style);
            }
        }

        private void TakeGroup(string text)
        {
            int colon = text.IndexOf(':');
            string name = colon < 0 ? "" : text.Substring(0, colon).Trim();
            TunableGroup group = Array.Find(GroupTunings.Groups, known => Same(known.Name, name));
            if (group == null)
                throw Wrong("batch.bad_group", text);
            foreach (string part in text.Substring(colon + 1).Split(','))
            {
                string[] sides = part.Split('=');
                bool thickness = Same(sides[0].Trim(), "thickness");
                float value;
                if (sides.Length != 2 || !(thickness || Same(sides[0].Trim(), "length"))
                    || !TryNumber(sides[1], 0.01f, 100, out value))
                    throw Wrong("batch.bad_group", text);
                GroupTunings.Set(Settings, group.Name, thickness, value);
            }
        }

        private void Number(string name, float low, float high, ref float value)
        {
            string text;
            float number;
            if (!given.TryGetValue(name, out text))
                return;
            if (!TryNumber(text, low, high, out number))
                throw Wrong("batch.bad_number", text, Prefix + name, low, high);
            value = number;
        }

        private static bool TryNumber(string text, float low, float high, out float number)
        {
            return float.TryParse(text.Trim(), NumberStyles.Float, CultureInfo.InvariantCulture, out number)
                && number >= low && number <= high;
        }

        private string Word(string name, params string[] words)
        {
            string word = Array.Find(words, known => Same(known, given[name]));
            if (word == null)
                throw Wrong("batch.bad_word", given[name], Prefix + name, string.Join(", ", words));
            return word;
        }

        private static bool Same(string one, string other)
        {
            return string.Equals(one, other, StringComparison.OrdinalIgnoreCase);
        }

        private static ArgumentException Wrong(string key, params object[] values)
        {
            return new ArgumentException(Strings.Get(key, values));
        }
    }
}
