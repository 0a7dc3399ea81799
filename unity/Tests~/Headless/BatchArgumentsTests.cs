using System;
using NUnit.Framework;

namespace SuperDeform.Editor.Tests
{
    [TestFixture]
    public class BatchArgumentsTests
    {
        [SetUp]
        public void English()
        {
            Strings.Language = "en";
        }

        static BatchArguments Read(params string[] arguments)
        {
            return BatchArguments.Read(arguments);
        }

        static void Refused(string sentence, params string[] arguments)
        {
            Assert.That(() => BatchArguments.Read(arguments), Throws.ArgumentException.With.Message.Contains(sentence));
        }

        [Test]
        public void a_command_line_of_unity_is_read_around_its_own_options()
        {
            BatchArguments read = Read("/opt/Unity", "-batchmode", "-projectPath", "/home/mika/game", "-executeMethod",
                "SuperDeform.Editor.BatchConvert.Run", "-superdeformAvatars", "Assets/A.prefab; Assets\\B.prefab;",
                "-superdeformHeads", "3.5", "-logFile", "-");
            CollectionAssert.AreEqual(new[] { "Assets/A.prefab", "Assets/B.prefab" }, read.Avatars);
            Assert.AreEqual(StyleSource.Heads, read.Settings.Source);
            Assert.AreEqual(3.5f, read.Settings.Heads);
            Assert.IsNull(read.ReportPath);
        }

        [Test]
        public void every_setting_can_be_given_in_any_case_of_letters()
        {
            ConversionSettings settings = Read("-SUPERDEFORMAVATARS", "A.prefab", "-superdeformblend", "0.25",
                "-superdeformAmount", "0.5", "-superdeformHeadScale", "2", "-superdeformHairLength", "0",
                "-superdeformFaceSquash", "-0.5", "-superdeformFaceCurve", "SPHERE", "-superdeformRig", "auto",
                "-superdeformOutput", "Assets/Chibis").Settings;
            Assert.AreEqual(0.25f, settings.Blend);
            Assert.AreEqual(0.5f, settings.Options.Amount);
            Assert.AreEqual(2f, settings.Options.HeadScale);
            Assert.AreEqual(0f, settings.Options.HairLength);
            Assert.AreEqual(-0.5f, settings.Options.FaceSquash);
            Assert.AreEqual(FaceCurve.Sphere, settings.Options.FaceCurve);
            Assert.IsTrue(settings.RigAuto);
            Assert.AreEqual("Assets/Chibis", settings.OutputFolder);
        }

        [Test]
        public void every_option_of_the_library_has_a_name_here()
        {
            Options options = Read("-superdeformAvatars", "A.prefab", "-superdeformMode", "paper", "-superdeformLimits", "no",
                "-superdeformRays", "24", "-superdeformRigWeights", "volume", "-superdeformRigVoxelResolution", "64",
                "-superdeformRigFingers", "no", "-superdeformRigHeat", "0.5").Settings.Options;
            Assert.AreEqual(Mode.Paper, options.Mode);
            Assert.IsFalse(options.Limits);
            Assert.AreEqual(24u, options.Rays);
            Assert.AreEqual(BodyWeights.Volume, options.RigWeights);
            Assert.AreEqual(64u, options.RigVoxelResolution);
            Assert.IsFalse(options.RigFingers);
            Assert.AreEqual(0.5, options.RigHeat);
            Refused("24.5 is no number from 3 to 4096", "-superdeformAvatars", "A", "-superdeformRays", "24.5");
            Refused("yes, no", "-superdeformAvatars", "A", "-superdeformLimits", "perhaps");
        }

        [Test]
        public void what_is_not_given_is_as_usual()
        {
            ConversionSettings settings = Read("-superdeformAvatars", "A.prefab").Settings, usual = new ConversionSettings();
            Assert.AreEqual(SettingsChange.None, SettingsChanges.Between(usual, settings));
            Assert.IsTrue(string.IsNullOrEmpty(settings.OutputFolder));
        }

        [Test]
        public void groups_are_tuned_one_option_a_group()
        {
            ConversionSettings settings = Read("-superdeformAvatars", "A.prefab", "-superdeformGroup",
                "upper_leg:length=0.4,thickness=0.8", "-superdeformGroup", "HEAD: thickness = 1.2,length_transfer=0.5").Settings;
            Assert.AreEqual(0.4, GroupTunings.Of(settings, "upper_leg").LengthScale);
            Assert.AreEqual(0.8, GroupTunings.Of(settings, "upper_leg").ThicknessScale);
            Assert.AreEqual(1.2, GroupTunings.Of(settings, "head").ThicknessScale);
            Assert.AreEqual(0.5, GroupTunings.Of(settings, "head").LengthTransfer);
            Assert.That(GroupTunings.Of(settings, "head").LengthScale, Is.NaN);
        }

        [Test]
        public void numbers_have_a_point_on_a_german_machine_too()
        {
            System.Globalization.CultureInfo before = System.Threading.Thread.CurrentThread.CurrentCulture;
            try
            {
                System.Threading.Thread.CurrentThread.CurrentCulture = new System.Globalization.CultureInfo("de-DE");
                Assert.AreEqual(2.5f, Read("-superdeformAvatars", "A", "-superdeformHeads", "2.5").Settings.Heads);
            }
            finally
            {
                System.Threading.Thread.CurrentThread.CurrentCulture = before;
            }
        }

        [Test]
        public void nothing_to_convert_is_refused_with_an_example()
        {
            Refused("Assets/A.prefab;Assets/B.prefab");
            Refused("name prefabs", "-superdeformAvatars", " ; ");
        }

        [Test]
        public void an_unknown_option_is_refused_with_those_there_are()
        {
            Refused("There is no option -superdeformHead. There are: -superdeformAvatars, -superdeformHeads",
                "-superdeformAvatars", "A", "-superdeformHead", "2.5");
        }

        [Test]
        public void an_option_without_its_value_or_said_twice_is_refused()
        {
            Refused("-superdeformAvatars needs a value", "-superdeformAvatars");
            Refused("-superdeformAvatars needs a value", "-superdeformAvatars", "-superdeformHeads", "2");
            Refused("-superdeformHeads stands here twice", "-superdeformHeads", "2", "-superdeformHeads", "3");
        }

        [Test]
        public void numbers_that_cannot_be_are_refused_with_their_range()
        {
            Refused("9 is no number from 1.8 to 6, which the option -superdeformHeads needs", "-superdeformAvatars", "A",
                "-superdeformHeads", "9");
            foreach (string text in new[] { "two", "NaN", "Infinity", "2,5", "" })
            {
                Refused("-superdeformHeads needs", "-superdeformAvatars", "A", "-superdeformHeads", text);
            }
        }

        [Test]
        public void words_and_groups_that_cannot_be_are_refused()
        {
            Refused("f4, f2, sphere", "-superdeformAvatars", "A", "-superdeformFaceCurve", "round");
            Refused("keep, auto", "-superdeformAvatars", "A", "-superdeformRig", "yes");
            foreach (string text in new[] { "tail:length=1", "head", "head:", "head:length", "head:length=x", "head:width=1",
                "head:length=0", "head:length=1=2" })
            {
                Refused("upper_leg:length=0.4", "-superdeformAvatars", "A", "-superdeformGroup", text);
            }
        }

        [Test]
        public void a_style_can_be_a_built_in_one()
        {
            ConversionSettings settings = Read("-superdeformAvatars", "A", "-superdeformStyle", "sd3").Settings;
            Assert.AreEqual(StyleSource.BuiltIn, settings.Source);
            Assert.AreEqual("sd3", settings.BuiltInStyle);
        }

        [Test]
        public void a_style_that_is_not_there_or_is_two_is_refused()
        {
            Refused("no prefab at Assets/None.prefab", "-superdeformAvatars", "A", "-superdeformReference", "Assets/None.prefab");
            Refused("no style Assets/none.json", "-superdeformAvatars", "A", "-superdeformStyle", "Assets/none.json");
            Refused("-superdeformReference and -superdeformStyle both", "-superdeformAvatars", "A", "-superdeformReference",
                "B", "-superdeformStyle", "C");
        }

        [Test]
        public void sentences_come_in_the_language_asked_for()
        {
            Refused("変換するものがありません", "-superdeformLanguage", "ja");
        }
    }
}
