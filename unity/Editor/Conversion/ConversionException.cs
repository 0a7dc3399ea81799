using System;

namespace SuperDeform.Editor
{
    /// <summary>
    /// A conversion that ended without a result, for a reason that an artist can read and often mend. Nothing is left behind.
    /// </summary>
    public sealed class ConversionException : Exception
    {
        /// <summary>The reason.</summary>
        public Finding Finding { get; private set; }

        /// <summary>True where the person asked to stop: nothing went wrong.</summary>
        public bool Cancelled => Finding.Key == "cancelled";

        public ConversionException(Finding finding) : base(finding.Text)
        {
            Finding = finding;
        }

        public ConversionException(Finding finding, Exception cause) : base(finding.Text, cause)
        {
            Finding = finding;
        }

        /// <summary>The reason behind what the library or the editor threw.</summary>
        /// <param name="where">What was being converted; may be null.</param>
        public static ConversionException From(Exception cause, UnityEngine.Object where)
        {
            if (cause is ConversionException known) return known;
            string key = "failed";
            if (cause is CancelledException) return new ConversionException(new Finding("cancelled", Severity.Info, where), cause);
            Finding tooNew = cause is LibraryMissingException ? LibraryFile.TooNew() : null;
            if (tooNew != null) return new ConversionException(tooNew, cause);
            if (cause is LibraryMissingException) key = "library_missing";
            else if (cause is LibraryVersionException) key = "library_version";
            else if (cause is SuperDeformException) key = "library_says";
            // A fault of this package, perhaps: where it happened helps to mend it.
            else UnityEngine.Debug.LogException(cause, where);
            bool ofFile = cause is LibraryMissingException || cause is LibraryVersionException;
            string value = ofFile ? SuperDeformLibrary.Version : Strings.OfLibrary(cause.Message);
            return new ConversionException(new Finding(key, Severity.Error, where, value, SuperDeformLibrary.BuildCommand), cause);
        }
    }
}
