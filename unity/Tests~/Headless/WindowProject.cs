using System;
using System.IO;
using UnityStubs;

namespace SuperDeform.Editor.Tests
{
    /// <summary>An empty project in a folder of its own, and English.</summary>
    internal static class WindowProject
    {
        internal static void Open()
        {
            string folder = Path.Combine(Path.GetTempPath(), "superdeform-window-" + Guid.NewGuid().ToString("N"));
            StubProject.Open(folder);
            AppDomain.CurrentDomain.ProcessExit += (sender, ending) =>
            {
                if (Directory.Exists(folder))
                    Directory.Delete(folder, true);
            };
            Strings.Language = "en";
        }
    }
}
