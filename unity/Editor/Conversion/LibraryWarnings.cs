using System;
using System.Text.RegularExpressions;
using UnityEngine;

namespace SuperDeform.Editor
{
    /// <summary>What the library warns of, in the editor's language: by its code; in its own words where there are none for that.</summary>
    internal static class LibraryWarnings
    {
        const string Prefix = "warning.", Other = "library_notes";

        // Good to know, but nothing need be done about it.
        static readonly string[] harmless =
        {
            "coefficient_limited", "crown_with_hair", "face_squash_clamped", "group_missing", "hair_shortened", "heads_limited", "joint_by_ratio", "kind_guessed",
            "radius_missing"
        };

        // A text may name as many numbers of the library's own sentence, in their order.
        const int MostNumbers = 2;

        /// <param name="where">What it is about; may be null.</param>
        internal static Finding Of(Warning warning, UnityEngine.Object where)
        {
            string key = Prefix + warning.Code;
            Severity severity = Array.IndexOf(harmless, warning.Code) >= 0 ? Severity.Info : Severity.Warning;
            if (!Strings.Has(key)) return new Finding(Other, severity, where, Strings.OfLibrary(warning.Text));
            MatchCollection numbers = Regex.Matches(warning.Text, @"\d+(\.\d+)?");
            object[] values = new object[MostNumbers];
            for (int number = 0; number < MostNumbers; number++)
            {
                values[number] = number < numbers.Count ? numbers[number].Value : "?";
            }
            return new Finding(key, severity, where, values);
        }

        /// <summary>Whether a finding is a warning of the library.</summary>
        internal static bool IsOne(Finding finding) => finding.Key == Other || finding.Key.StartsWith(Prefix, StringComparison.Ordinal);
    }
}
