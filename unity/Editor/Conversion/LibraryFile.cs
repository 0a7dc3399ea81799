using System;
using System.IO;
using System.Runtime.InteropServices;
using System.Text;
using System.Text.RegularExpressions;

namespace SuperDeform.Editor
{
    /// <summary>
    /// Why Linux does not load the native library that lies in the package: the editor says no more than that it is not there.
    /// </summary>
    internal static class LibraryFile
    {
        const string InPackage = "Packages/com.superdeform.converter/Plugins/x86_64/libsuperdeform.so";

        /// <summary>
        /// The sentence for a library that wants a newer C library than the system's; null where that is not the reason.
        /// </summary>
        internal static Finding TooNew()
        {
            string path = Path.GetFullPath(InPackage);
            Version system = SystemVersion();
            if (system == null || !File.Exists(path)) return null;
            return TooNew(File.ReadAllBytes(path), system);
        }

        /// <summary>The same for a library's bytes and the version of the system's C library.</summary>
        internal static Finding TooNew(byte[] library, Version system)
        {
            Version needed = Needed(library);
            return needed > system ? new Finding("library_too_new", Severity.Error, null, needed, system) : null;
        }

        /// <summary>The newest version of glibc whose functions a library names; 0.0 where it names none.</summary>
        internal static Version Needed(byte[] library)
        {
            var newest = new Version(0, 0);
            foreach (Match name in Regex.Matches(Encoding.GetEncoding(28591).GetString(library), @"GLIBC_(\d{1,3}\.\d{1,3})"))
            {
                var version = new Version(name.Groups[1].Value);
                if (version > newest) newest = version;
            }
            return newest;
        }

        /// <summary>The version of glibc; null on systems that have none.</summary>
        internal static Version SystemVersion()
        {
            try
            {
                return new Version(Marshal.PtrToStringAnsi(gnu_get_libc_version()));
            }
            catch (Exception)
            {
                // Windows, macOS, and Linux with another C library.
                return null;
            }
        }

        [DllImport("libc.so.6")]
        static extern IntPtr gnu_get_libc_version();
    }
}
