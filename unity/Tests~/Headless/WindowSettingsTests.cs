using NUnit.Framework;

namespace SuperDeform.Editor.Tests
{
    [TestFixture]
    public class WindowSettingsTests
    {
        [Test]
        public void a_group_has_no_tuning_until_it_is_set()
        {
            var settings = new ConversionSettings();
            Assert.That(GroupTunings.Get(settings, "head", false), Is.NaN);
            GroupTunings.Set(settings, "head", true, 0.75f);
            Assert.That(GroupTunings.Get(settings, "head", false), Is.NaN);
            Assert.AreEqual(0.75f, GroupTunings.Get(settings, "head", true));
            Assert.AreEqual(1, GroupTunings.Count(settings));
        }

        [Test]
        public void a_tuning_taken_away_leaves_nothing()
        {
            var settings = new ConversionSettings();
            GroupTunings.Set(settings, "foot", false, 2);
            GroupTunings.Set(settings, "hand", false, 2);
            GroupTunings.Set(settings, "foot", false, float.NaN);
            Assert.AreEqual(1, settings.Groups.Count);
            GroupTunings.Clear(settings);
            Assert.AreEqual(0, settings.Groups.Count);
        }

        [Test]
        public void a_tuning_keeps_transfers_that_were_set_elsewhere()
        {
            var settings = new ConversionSettings();
            settings.Groups.Add(new GroupTuning { Group = "neck", LengthTransfer = 0.5f });
            GroupTunings.Set(settings, "neck", false, 1);
            GroupTunings.Set(settings, "neck", false, float.NaN);
            Assert.AreEqual(0.5f, settings.Groups[0].LengthTransfer);
        }

        [Test]
        public void every_tunable_group_is_one_that_the_library_takes()
        {
            // superdeform.h, SdefGroupSettings.group; fingers go with the hand.
            string[] all = ("head, neck, torso, shoulder, upper_arm, lower_arm, hand, hip, upper_leg, lower_leg, foot")
                .Replace(" ", "").Split(',');
            CollectionAssert.AreEquivalent(all, System.Array.ConvertAll(GroupTunings.Groups, group => group.Name));
        }

        private static SettingsChange After(System.Action<ConversionSettings> change)
        {
            var before = new ConversionSettings();
            ConversionSettings after = before.Clone();
            change(after);
            return SettingsChanges.Between(before, after);
        }

        [Test]
        public void the_same_settings_change_nothing_though_nan_is_no_number()
        {
            Assert.AreEqual(SettingsChange.None, After(settings => { }));
            Assert.AreEqual(SettingsChange.None, After(settings => settings.OutputFolder = "Assets/Elsewhere"));
        }

        [Test]
        public void what_the_options_say_leaves_the_style()
        {
            Assert.AreEqual(SettingsChange.Options, After(settings => settings.Amount = 0.5f));
            Assert.AreEqual(SettingsChange.Options, After(settings => settings.HairLength = 0.5f));
            Assert.AreEqual(SettingsChange.Options, After(settings => settings.HeadScale = 1));
            Assert.AreEqual(SettingsChange.Options, After(settings => settings.FaceSquash = 0));
            Assert.AreEqual(SettingsChange.Options, After(settings => settings.FaceCurve = FaceCurve.Sphere));
            Assert.AreEqual(SettingsChange.Options, After(settings => GroupTunings.Set(settings, "hip", false, 0.9f)));
        }

        [Test]
        public void the_style_and_the_rig_come_before_all_else()
        {
            Assert.AreEqual(SettingsChange.Style, After(settings => settings.Source = StyleSource.BuiltIn));
            Assert.AreEqual(SettingsChange.Style, After(settings => settings.BuiltInStyle = "sd4"));
            Assert.AreEqual(SettingsChange.Style, After(settings => settings.Heads = 3));
            Assert.AreEqual(SettingsChange.Style, After(settings => { settings.Blend = 1; settings.FaceSquash = 0; }));
            Assert.AreEqual(SettingsChange.Rig, After(settings => { settings.RigAuto = true; settings.Heads = 3; }));
        }
    }
}
