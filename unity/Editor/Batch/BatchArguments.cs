using System;
using System.Collections.Generic;
using System.Globalization;
using System.Linq;
using System.Reflection;
using System.Text.RegularExpressions;
using UnityEditor;
using UnityEngine;

namespace SuperDeform.Editor
{
    /// <summary>What a command line asks a batch to do; the options are listed at BatchConvert.</summary>
    public sealed class BatchArguments
    {
        const string Prefix = "-superdeform";

        /// <summary>Paths of prefabs, as given.</summary>
        public List<string> Avatars = new List<string>();
        public ConversionSettings Settings = new ConversionSettings();
        /// <summary>Where the report goes; null: nowhere.</summary>
        public string ReportPath;
        /// <summary>Whether avatars whose licence forbids changes are converted: the person who asks has permission.</summary>
        public bool AllowProhibited;

        readonly Dictionary<string, string> given =
            new Dictionary<string, string>(StringComparer.OrdinalIgnoreCase);
        readonly List<string> groups = new List<string>();

        static readonly string[] own =
        {
            "Avatars", "Heads", "Reference", "Style", "Blend", "Group", "Rig", "Output", "NewCopy", "Report", "AllowProhibited", "Language"
        };

        // The library's options go by the names of their fields. Lists have an option of their own or none, and an avatar
        // is read in Unity's axes whatever is said.
        static readonly FieldInfo[] options = Array.FindAll(typeof(Options).GetFields(), field =>
            (field.FieldType.IsPrimitive || field.FieldType.IsEnum) && field.Name != "RigLeftHanded");

        static readonly string[] known = own.Concat(options.Select(field => field.Name)).ToArray();

        /// <summary>Reads a command line: options that do not begin with -superdeform are somebody else's.</summary>
        /// <exception cref="ArgumentException">An option is unknown, lacks its value or has a wrong one; in one sentence.
        /// </exception>
        public static BatchArguments Read(IList<string> arguments)
        {
            var result = new BatchArguments();
            for (int i = 0; i < arguments.Count; i++)
            {
                if (arguments[i].StartsWith(Prefix, StringComparison.OrdinalIgnoreCase))
                {
                    result.Take(arguments[i], i + 1 < arguments.Count ? arguments[++i] : null);
                }
            }
            result.Understand();
            return result;
        }

        void Take(string option, string value)
        {
            string name = Array.Find(known, word => Same(Prefix + word, option));
            if (name == null) throw Wrong("batch.unknown", option, string.Join(", ", Array.ConvertAll(known, word => Prefix + word)));
            if (value == null || value.StartsWith(Prefix, StringComparison.OrdinalIgnoreCase)) throw Wrong("batch.no_value", option);
            if (name == "Group") groups.Add(value);
            else if (given.ContainsKey(name)) throw Wrong("batch.twice", option);
            else given.Add(name, value);
        }

        void Understand()
        {
            // First, so that the sentences after it are in the language asked for.
            if (given.ContainsKey("Language")) Strings.Language = Word("Language", new List<string>(Strings.Languages).ToArray());
            if (given.TryGetValue("Avatars", out string avatars))
            {
                foreach (string path in avatars.Split(';'))
                {
                    if (path.Trim().Length > 0) Avatars.Add(path.Trim().Replace('\\', '/'));
                }
            }
            if (Avatars.Count == 0) throw Wrong("batch.no_avatars");
            Number("Heads", ref Settings.Heads);
            Number("Blend", ref Settings.Blend);
            foreach (FieldInfo option in options)
            {
                if (given.ContainsKey(option.Name)) option.SetValue(Settings.Options, Value(option.Name, option.FieldType));
            }
            if (given.ContainsKey("Rig")) Settings.RigAuto = Word("Rig", "keep", "auto") == "auto";
            if (given.TryGetValue("Output", out string folder)) Settings.OutputFolder = folder.Replace('\\', '/');
            if (given.ContainsKey("NewCopy")) Settings.NewCopy = Word("NewCopy", "yes", "no") == "yes";
            given.TryGetValue("Report", out ReportPath);
            if (given.ContainsKey("AllowProhibited")) AllowProhibited = Word("AllowProhibited", "yes", "no") == "yes";
            foreach (string group in groups)
            {
                TakeGroup(group);
            }
            TakeStyle();
        }

        // superdeform.h, sdef_style_from_text.
        static readonly string[] builtIn = { "sd2", "sd2.5", "sd3", "sd4" };

        void TakeStyle()
        {
            given.TryGetValue("Reference", out string reference);
            given.TryGetValue("Style", out string style);
            if (reference != null && style != null) throw Wrong("batch.two_styles", Prefix + "Reference", Prefix + "Style");
            Settings.Source = StyleSource.Heads;
            if (reference != null)
            {
                Settings.Source = StyleSource.ReferenceAvatar;
                Settings.ReferenceAvatar = AssetDatabase.LoadAssetAtPath<GameObject>(reference.Replace('\\', '/'));
                if (Settings.ReferenceAvatar == null) throw Wrong("batch.not_found", reference);
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
                if (Settings.SavedStyle == null) throw Wrong("batch.style_not_found", style);
            }
        }

        void TakeGroup(string text)
        {
            int colon = text.IndexOf(':');
            string name = colon < 0 ? "" : text.Substring(0, colon).Trim();
            TunableGroup group = Array.Find(GroupTunings.Groups, known => Same(known.Name, name));
            if (group == null) throw Wrong("batch.bad_group", text);
            foreach (string part in text.Substring(colon + 1).Split(','))
            {
                string[] sides = part.Split('=');
                FieldInfo field = Array.Find(numbers, number => Same(WordOf(number), sides[0].Trim()));
                if (sides.Length != 2 || field == null || !TryNumber(sides[1], OptionRange.Of(field.Name), out double value))
                {
                    throw Wrong("batch.bad_group", text);
                }
                GroupTunings.Change(Settings, group.Name, tuned => field.SetValue(tuned, value));
            }
        }

        static readonly FieldInfo[] numbers =
            Array.FindAll(typeof(GroupSettings).GetFields(), field => field.FieldType == typeof(double));

        // As the command line of the library has it: LengthScale is length, LengthTransfer is length_transfer.
        static string WordOf(FieldInfo number)
        {
            return Regex.Replace(number.Name, "Scale$", "").Aggregate("", (word, letter) =>
                word + (char.IsUpper(letter) && word.Length > 0 ? "_" : "") + char.ToLowerInvariant(letter));
        }

        void Number(string name, ref float value)
        {
            if (given.ContainsKey(name)) value = (float)Value(name, typeof(float));
        }

        object Value(string name, Type type)
        {
            if (type == typeof(bool)) return Word(name, "yes", "no") == "yes";
            if (type.IsEnum) return Enum.Parse(type, Word(name, Array.ConvertAll(Enum.GetNames(type), word => word.ToLowerInvariant())), true);
            OptionRange range = OptionRange.Of(name);
            if (!TryNumber(given[name], range, out double number) || type == typeof(uint) && number != Math.Floor(number))
            {
                throw Wrong("batch.bad_number", given[name], Prefix + name, range.Low, range.High);
            }
            return Convert.ChangeType(number, type, CultureInfo.InvariantCulture);
        }

        static bool TryNumber(string text, OptionRange range, out double number)
        {
            return double.TryParse(text.Trim(), NumberStyles.Float, CultureInfo.InvariantCulture, out number)
                && range.Contains(number);
        }

        string Word(string name, params string[] words)
        {
            string word = Array.Find(words, known => Same(known, given[name]));
            if (word == null) throw Wrong("batch.bad_word", given[name], Prefix + name, string.Join(", ", words));
            return word;
        }

        static bool Same(string one, string other) => string.Equals(one, other, StringComparison.OrdinalIgnoreCase);

        static ArgumentException Wrong(string key, params object[] values) => new ArgumentException(Strings.Get(key, values));
    }
}
