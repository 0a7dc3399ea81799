// One conversion in a process of its own: prints the finding's key, its sentence, and what was left behind.
using System;
using SuperDeform.Editor;
using SuperDeform.Editor.Tests;
using UnityStubs;

internal static class ConvertOnce
{
    static int Main()
    {
        Model model = Models.Load("kaykit_rogue.glb");
        string before = Fingerprint.Of(model.Root);
        string[] files = StubProject.FilesOnDisk();
        try
        {
            Converter.Convert(model.Root, Models.Settings(), null);
            Console.WriteLine("converted");
        }
        catch (ConversionException fault)
        {
            Console.WriteLine(fault.Finding.Key);
            Console.WriteLine(fault.Message);
        }
        bool untouched = before == Fingerprint.Of(model.Root) && string.Join("\n", files) == string.Join("\n", StubProject.FilesOnDisk());
        Console.WriteLine(untouched ? "source unchanged, no files" : "something was left behind");
        return 0;
    }
}
