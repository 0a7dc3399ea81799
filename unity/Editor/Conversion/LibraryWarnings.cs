using System;
using UnityEngine;

namespace SuperDeform.Editor
{
    /// <summary>What the library warns of, in the editor's language: by its code, with its own sentence where that says more.</summary>
    internal static class LibraryWarnings
    {
        const string Prefix = "warning.", Other = "library_notes";

        // Good to know, but nothing need be done about it.
        static readonly string[] harmless = { "coefficient_limited", "crown_with_hair", "hair_shortened", "kind_guessed" };

        /// <param name="where">What it is about; may be null.</param>
        internal static Finding Of(Warning warning, UnityEngine.Object where)
        {
            string key = Prefix + warning.Code;
            Severity severity = Array.IndexOf(harmless, warning.Code) >= 0 ? Severity.Info : Severity.Warning;
            return new Finding(Strings.Has(key) ? key : Other, severity, where, Strings.OfLibrary(warning.Text));
        }

        /// <summary>Whether a finding is a warning of the library.</summary>
        internal static bool IsOne(Finding finding)
        {
            return finding.Key == Other || finding.Key.StartsWith(Prefix, StringComparison.Ordinal);
        }
    }
}
