using System.IO;
using NUnit.Framework;
using SuperDeform.Editor.WindowPicture;

namespace SuperDeform.Editor.Tests
{
    [TestFixture]
    public class WindowPictureTests
    {
        [Test]
        public void every_label_fits_in_every_language()
        {
            foreach (string file in Picture.Files) StringAssert.DoesNotContain("\u2026", Picture.Draw(file), file + " cuts a text short: find a shorter one");
        }

        [Test]
        public void the_pictures_of_the_documentation_are_what_the_window_is()
        {
            foreach (string file in Picture.Files)
            {
                string path = Path.Combine(Models.Repository, "unity/Documentation~/" + file);
                Assert.AreEqual(File.ReadAllText(path), Picture.Draw(file),
                    file + " is another one: look at it, then run unity/Tests~/WindowPicture/draw.sh");
            }
        }
    }
}
