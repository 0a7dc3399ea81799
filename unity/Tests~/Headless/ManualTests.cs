using System;
using System.IO;
using NUnit.Framework;
using UnityEditor;
using UnityEngine;
using UnityStubs;

namespace SuperDeform.Editor.Tests
{
    [TestFixture]
    public class ManualTests
    {
        const string Package = "com.superdeform.converter";
        string language;

        [SetUp]
        public void Begin()
        {
            language = Strings.Language;
            Browser.Reset();
            StubEditor.LoadScripts();
        }

        [TearDown]
        public void End()
        {
            Strings.Language = language;
            Browser.Reset();
        }

        static string HelpOf<T>() where T : Component
        {
            return Help.GetHelpURLForObject(new GameObject("Avatar").AddComponent<T>());
        }

        [Test]
        public void the_question_mark_opens_the_page_of_the_language_in_the_package()
        {
            foreach (string code in Strings.Languages)
            {
                Strings.Language = code;
                var address = new Uri(HelpOf<SuperDeformAvatar>());
                Assert.AreEqual(Uri.UriSchemeFile, address.Scheme, code);
                string path = address.LocalPath, start = "/Packages/" + Package + "/";
                Assert.IsTrue(path.Contains(start), path);
                string file = Path.Combine(Environment.GetEnvironmentVariable("SUPERDEFORM_REPOSITORY"), "unity", path.Substring(path.IndexOf(start) + start.Length));
                Assert.IsTrue(File.Exists(file), file);
                Assert.AreEqual(code == "en", file.EndsWith("/superdeform.md"), file);
            }
        }

        [Test]
        public void a_released_package_names_a_page_of_the_web_and_the_question_mark_opens_that()
        {
            Browser.Install(Package, "https://example.com/blob/v1/unity/Documentation~/superdeform.md");
            Strings.Language = "ja";
            Assert.AreEqual("https://example.com/blob/v1/unity/Documentation~/superdeform.ja.md", HelpOf<SuperDeformAvatar>());
            Strings.Language = "en";
            Assert.AreEqual("https://example.com/blob/v1/unity/Documentation~/superdeform.md",
                Help.GetHelpURLForObject(ScriptableObject.CreateInstance<SuperDeformPreset>()));
        }

        [Test]
        public void what_opens_is_an_address_that_a_system_knows()
        {
            // What is none would be opened as file://Packages/..., which is nowhere.
            Help.ShowHelpForObject(new GameObject("Avatar").AddComponent<SuperDeformAvatar>());
            Assert.AreEqual(1, Browser.Opened.Count);
            Assert.IsTrue(Uri.IsWellFormedUriString(Browser.Opened[0], UriKind.Absolute), Browser.Opened[0]);
        }
    }
}
