using System;
using System.Collections.Generic;
using System.IO;
using System.Text.RegularExpressions;
using NUnit.Framework;

namespace SuperDeform.Editor.Tests
{
    [TestFixture]
    public class StringsTests
    {
        static readonly Regex gap = new Regex(@"\{(\d+)\}");

        [TearDown]
        public void English()
        {
            Strings.Language = "en";
        }

        static Dictionary<string, string> Texts(string language)
        {
            var texts = new Dictionary<string, string>();
            foreach (KeyValuePair<string, string> text in FlatJson.Read(File.ReadAllText(Strings.FileOf(language)))) texts.Add(text.Key, text.Value);
            return texts;
        }

        static string Gaps(string text)
        {
            var found = new SortedSet<string>();
            foreach (Match match in gap.Matches(text)) found.Add(match.Groups[1].Value);
            return string.Join(" ", found);
        }

        static string Folder()
        {
            return Path.GetDirectoryName(Path.GetDirectoryName(Strings.FileOf("en")));
        }

        [Test]
        public void every_language_has_the_same_keys_with_the_same_gaps()
        {
            Dictionary<string, string> english = Texts("en");
            Assert.That(english.Count, Is.GreaterThan(50));
            foreach (string language in Strings.Languages)
            {
                Dictionary<string, string> other = Texts(language);
                CollectionAssert.AreEquivalent(english.Keys, other.Keys, language);
                foreach (KeyValuePair<string, string> text in english)
                {
                    Assert.AreEqual(Gaps(text.Value), Gaps(other[text.Key]), language + " " + text.Key);
                    Assert.That(other[text.Key].Trim(), Is.Not.Empty, language + " " + text.Key);
                }
            }
        }

        [Test]
        public void gaps_count_from_0_without_holes_and_braces_are_only_gaps()
        {
            foreach (string language in Strings.Languages)
            {
                foreach (KeyValuePair<string, string> text in Texts(language))
                {
                    string[] gaps = Gaps(text.Value).Split(new[] { ' ' }, StringSplitOptions.RemoveEmptyEntries);
                    for (int i = 0; i < gaps.Length; i++) Assert.AreEqual(i.ToString(), gaps[i], language + " " + text.Key);
                    Assert.That(gap.Replace(text.Value, ""), Is.Not.StringMatching("[{}]"), language + " " + text.Key);
                }
            }
        }

        [Test]
        public void japanese_texts_are_japanese()
        {
            Dictionary<string, string> english = Texts("en");
            var letters = new Regex("[A-Za-z]");
            foreach (KeyValuePair<string, string> text in Texts("ja"))
            {
                // Names stay, and so do sentences whose gaps say everything.
                if (letters.IsMatch(gap.Replace(text.Value, "").Replace("Super Deform", "").Replace("f2", "")))
                {
                    Assert.AreNotEqual(english[text.Key], text.Value, text.Key);
                }
            }
        }

        [Test]
        public void every_key_that_the_code_names_has_a_text()
        {
            Dictionary<string, string> english = Texts("en");
            var call = new Regex(@"(?:Strings\.(?:Get|Has)|new Finding)\(""([^""]+)""\s*[,)]");
            int found = 0;
            foreach (string file in Directory.GetFiles(Folder(), "*.cs", SearchOption.AllDirectories))
            {
                foreach (Match match in call.Matches(File.ReadAllText(file)))
                {
                    found++;
                    Assert.That(english.ContainsKey(match.Groups[1].Value), Path.GetFileName(file) + " names the key "
                        + match.Groups[1].Value + ", which has no text");
                }
            }
            Assert.That(found, Is.GreaterThan(20));
        }

        [Test]
        public void every_warning_of_the_library_has_a_text_and_no_other_has()
        {
            var call = new Regex(@"Warning::new\(\s*""([a-z_]+)""");
            var codes = new HashSet<string>();
            foreach (string file in Directory.GetFiles(Path.Combine(Models.Repository, "src"), "*.rs", SearchOption.AllDirectories))
            {
                foreach (Match match in call.Matches(File.ReadAllText(file))) codes.Add("warning." + match.Groups[1].Value);
            }
            Assert.That(codes.Count, Is.GreaterThan(10));
            var texts = new HashSet<string>();
            foreach (string key in Texts("en").Keys)
            {
                if (key.StartsWith("warning.")) texts.Add(key);
            }
            CollectionAssert.AreEquivalent(codes, texts);
        }

        [Test]
        public void every_text_is_named_by_the_code_or_made_of_names_that_are()
        {
            string code = "";
            foreach (string file in Directory.GetFiles(Folder(), "*.cs", SearchOption.AllDirectories)) code += File.ReadAllText(file);
            // Keys that code puts together: section.Avatar, group.head, warning.open_body, option.face_curve.f4, style.heads.tooltip.
            var made = new Regex(@"^(section|group|warning|option)\.|\.tooltip$");
            foreach (string key in Texts("en").Keys)
            {
                if (!made.IsMatch(key)) Assert.That(code.Contains("\"" + key + "\""), "nothing uses the text " + key);
            }
        }

        [Test]
        public void a_text_comes_in_the_language_chosen_and_the_choice_is_kept()
        {
            Strings.Language = "ja";
            Assert.AreEqual("2.5頭身", Strings.Get("style.heads.summary", 2.5));
            Assert.AreEqual("ja", UnityEditor.EditorPrefs.GetString("SuperDeform.Language", ""));
            Strings.Language = "en";
            Assert.AreEqual("2.5 heads", Strings.Get("style.heads.summary", 2.5));
        }

        [Test]
        public void the_library_names_an_option_by_its_field_and_the_window_by_its_label()
        {
            Strings.Language = "en";
            Assert.AreEqual("head scale is 20: give less (Head size)", Strings.OfLibrary("head scale is 20: give less (head_scale)"));
            Assert.AreEqual("no joint", Strings.OfLibrary("no joint (role_joints, or sdef_character_rig)"));
            Assert.AreEqual("hair (of 3 meshes)", Strings.OfLibrary("hair (of 3 meshes)"));
            Assert.AreEqual("product mode alone (mode)", Strings.OfLibrary("product mode alone (mode)"));
            Strings.Language = "ja";
            Assert.AreEqual("x (頭の大きさ)", Strings.OfLibrary("x (head_scale)"));
            Strings.Language = "en";
        }

        [Test]
        public void numbers_have_a_point_in_every_culture()
        {
            System.Globalization.CultureInfo before = System.Threading.Thread.CurrentThread.CurrentCulture;
            try
            {
                System.Threading.Thread.CurrentThread.CurrentCulture = new System.Globalization.CultureInfo("de-DE");
                Assert.AreEqual("2.5 heads", Strings.Get("style.heads.summary", 2.5));
            }
            finally
            {
                System.Threading.Thread.CurrentThread.CurrentCulture = before;
            }
        }

        [Test]
        public void a_key_without_a_text_is_shown_with_its_values()
        {
            Assert.AreEqual("no_such_key", Strings.Get("no_such_key"));
            Assert.AreEqual("no_such_key: 1, two", Strings.Get("no_such_key", 1, "two"));
            Assert.IsFalse(Strings.Has("no_such_key"));
        }

        [Test]
        public void a_language_that_is_none_is_refused()
        {
            Assert.That(() => Strings.Language = "tlh", Throws.ArgumentException.With.Message.Contains("en, ja"));
        }

        [Test]
        public void a_file_of_texts_is_read_as_json_says()
        {
            List<KeyValuePair<string, string>> members =
                FlatJson.Read("\uFEFF { \"a\" : \"x\\n\\\"y\\\\ \\u65e5\" ,\r\n\"b\":\"\" } ");
            Assert.AreEqual(2, members.Count);
            Assert.AreEqual("x\n\"y\\ 日", members[0].Value);
            Assert.AreEqual("", members[1].Value);
            Assert.AreEqual(0, FlatJson.Read("{}").Count);
        }

        [Test]
        public void what_is_wrong_with_a_file_of_texts_is_told_with_its_place()
        {
            string[] wrong =
            {
                "", "{", "[]", "{\"a\"}", "{\"a\":1}", "{\"a\":\"b\",}", "{\"a\":\"b\"} x", "{\"a\":\"\\q\"}", "{\"a\":\"\\u12\"}",
                "{\"a\":\"b", "{\"a\":\"b\nc\"}"
            };
            foreach (string text in wrong)
            {
                Assert.That(() => FlatJson.Read(text), Throws.TypeOf<FormatException>().With.Message.StartsWith("line "), text);
            }
            Assert.That(() => FlatJson.Read("{\"a\": \"b\",\n \"a\": \"c\"}"),
                Throws.TypeOf<FormatException>().With.Message.Contains("line 2").And.Message.Contains("second time"));
        }

        [Test]
        public void a_quoted_text_reads_back()
        {
            string text = "Mika \"ミカ\"\\\t\u0001/";
            Assert.AreEqual(text, FlatJson.Read("{\"a\":" + FlatJson.Quote(text) + "}")[0].Value);
            Assert.AreEqual("\"\"", FlatJson.Quote(null));
        }
    }
}
