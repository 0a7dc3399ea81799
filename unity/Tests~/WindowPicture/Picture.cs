using SuperDeform.Editor.Tests;
using UnityStubs;

namespace SuperDeform.Editor.WindowPicture
{
    /// <summary>The picture of the converter window in the documentation: a character of tests/data in it, two sliders moved.
    /// </summary>
    internal static class Picture
    {
        internal static readonly string[] Files = { "window.svg", "window.ja.svg", "window.ko.svg", "window.zh.svg" };

        /// <summary>Draws the window in one language.</summary>
        /// <param name="file">One of Files.</param>
        internal static string Draw(string file)
        {
            Model character = Models.Load("quaternius_female_dress.glb");
            character.Root.name = "Mika";
            string[] parts = file.Split('.');
            Strings.Language = parts.Length == 3 ? parts[1] : "en";
            try
            {
                var model = new ConverterModel();
                for (int section = 0; section < model.Open.Length; section++) model.Open[section] = true;
                model.SetAvatar(character.Root);
                GroupTunings.Change(model.Settings, "upper_arm", arm => arm.ThicknessScale = 0.8);
                GroupTunings.Change(model.Settings, "hand", hand => hand.LengthScale = 0.9);
                using (var controller = new ConverterController(model))
                {
                    controller.Tick(0);
                    controller.Tick(1);
                    var canvas = new Canvas();
                    double height = WindowDrawing.Draw(canvas, model, 8, 8) + 8;
                    return canvas.Finish(WindowDrawing.Width + 16, height);
                }
            }
            finally
            {
                Strings.Language = "en";
                StubProject.Reset();
            }
        }
    }
}
