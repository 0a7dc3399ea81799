using System;

namespace SuperDeform
{
/// <summary>The native library as a whole.</summary>
public static class SuperDeformLibrary
{
    /// <summary>The version of this package, which is the version of the native library that belongs to it.</summary>
    public const string Version = "1.0.0-rc.1";

    /// <summary>The command that builds the native library into the package, in a checkout of the repository.</summary>
    public const string BuildCommand = "bash .ci/unity_package --plugins";

    static volatile bool found;

    /// <summary>How many native objects there are that nobody has destroyed, of all kinds and threads.</summary>
    public static ulong LiveHandles
    {
        get
        {
            Check();
            return Native.sdef_live_handles();
        }
    }

    /// <summary>
    /// Looks for the native library and compares its version with this package's. Every class does so at first use;
    /// after a success it costs nothing.
    /// </summary>
    /// <exception cref="LibraryMissingException">There is none, or none for this machine.</exception>
    /// <exception cref="LibraryVersionException">It is of another version.</exception>
    public static void Check()
    {
        if (found) return;
        uint version;
        try
        {
            version = Native.sdef_abi_version();
        }
        catch (DllNotFoundException missing)
        {
            throw new LibraryMissingException(MissingSentence, missing);
        }
        catch (BadImageFormatException wrongMachine)
        {
            throw new LibraryMissingException(MissingSentence, wrongMachine);
        }
        catch (EntryPointNotFoundException older)
        {
            throw new LibraryVersionException(VersionSentence("an unknown version"), older);
        }
        CheckVersion(version);
        found = true;
    }

    /// <summary>The release of the native library that is loaded, such as 1.0.0-rc.1.</summary>
    public static unsafe string NativeVersion
    {
        get
        {
            Check();
            return Text.Of(Native.sdef_version());
        }
    }

    /// <summary>The name of a status as C has it, such as SDEF_STATUS_BUSY.</summary>
    public static unsafe string StatusName(Status status)
    {
        Check();
        return Text.Of(Native.sdef_status_name((uint)status));
    }

    internal static void CheckVersion(uint version)
    {
        if (version == Native.SDEF_ABI_VERSION) return;
        throw new LibraryVersionException(VersionSentence("version " + version));
    }

    static string MissingSentence
    {
        get
        {
#if UNITY_EDITOR || !UNITY_5_3_OR_NEWER
            return "The native library superdeform is not there or not for this machine (64 bits): install this package "
                + "from the release file superdeform-" + Version + ".tgz (Package Manager, Add package from tarball), or "
                + "build the library in a checkout of the repository with: " + BuildCommand;
#else
            return "The native library superdeform is not in this player: add the library for its system to the project's "
                + "Assets/Plugins folder and tick that system in its import settings (the define SUPERDEFORM_RUNTIME "
                + "asks for it)";
#endif
        }
    }

    static string VersionSentence(string loaded)
    {
        return "The native library superdeform has " + loaded + " of its interface, but this package needs version "
            + Native.SDEF_ABI_VERSION + ": restart the editor if an older library is still loaded; if that does not "
            + "help, install the package anew from the release file superdeform-" + Version + ".tgz";
    }
}
}
