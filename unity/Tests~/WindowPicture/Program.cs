using System;
using System.IO;

namespace SuperDeform.Editor.WindowPicture
{
    /// <summary>Draws the pictures of the window into a folder: draw.sh runs it.</summary>
    internal static class Program
    {
        static int Main(string[] arguments)
        {
            if (arguments.Length != 1)
            {
                Console.Error.WriteLine("WindowPicture FOLDER");
                return 2;
            }
            string folder = Path.GetFullPath(arguments[0]);
            foreach (string file in Picture.Files) File.WriteAllText(Path.Combine(folder, file), Picture.Draw(file));
            return 0;
        }
    }
}
