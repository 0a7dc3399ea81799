using System;
using System.Collections.Generic;
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
            Assert.That(GroupTunings.Of(settings, "head").LengthScale, Is.NaN);
            GroupTunings.Change(settings, "head", head => head.ThicknessScale = 0.75);
            Assert.That(GroupTunings.Of(settings, "head").LengthScale, Is.NaN);
            Assert.AreEqual(0.75, GroupTunings.Of(settings, "head").ThicknessScale);
            Assert.AreEqual(1, GroupTunings.Count(settings));
        }

        [Test]
        public void a_tuning_taken_away_leaves_nothing()
        {
            var settings = new ConversionSettings();
            GroupTunings.Change(settings, "foot", foot => foot.LengthScale = 2);
            GroupTunings.Change(settings, "hand", hand => hand.LengthScale = 2);
            GroupTunings.Change(settings, "foot", foot => foot.LengthScale = double.NaN);
            Assert.AreEqual(1, settings.Options.Groups.Count);
            GroupTunings.Clear(settings);
            Assert.AreEqual(0, settings.Options.Groups.Count);
        }

        [Test]
        public void a_tuning_keeps_transfers_that_were_set_elsewhere()
        {
            var settings = new ConversionSettings();
            settings.Options.Groups.Add(new GroupSettings { Group = "neck", LengthTransfer = 0.5f });
            GroupTunings.Change(settings, "neck", neck => neck.LengthScale = 1);
            GroupTunings.Change(settings, "neck", neck => neck.LengthScale = double.NaN);
            Assert.AreEqual(0.5f, settings.Options.Groups[0].LengthTransfer);
        }

        [Test]
        public void every_tunable_group_is_one_that_the_library_takes()
        {
            // superdeform.h, SdefGroupSettings.group; fingers go with the hand.
            string[] all = ("head, neck, torso, shoulder, upper_arm, lower_arm, hand, hip, upper_leg, lower_leg, foot")
                .Replace(" ", "").Split(',');
            CollectionAssert.AreEquivalent(all, System.Array.ConvertAll(GroupTunings.Groups, group => group.Name));
        }

        static SettingsChange After(System.Action<ConversionSettings> change)
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
            Assert.AreEqual(SettingsChange.Options, After(settings => settings.Options.Amount = 0.5f));
            Assert.AreEqual(SettingsChange.Options, After(settings => settings.Options.HairLength = 0.5f));
            Assert.AreEqual(SettingsChange.Options, After(settings => settings.Options.HeadScale = 1));
            Assert.AreEqual(SettingsChange.Options, After(settings => settings.Options.FaceSquash = 0));
            Assert.AreEqual(SettingsChange.Options, After(settings => settings.Options.FaceCurve = FaceCurve.Sphere));
            Assert.AreEqual(SettingsChange.Options, After(settings => GroupTunings.Change(settings, "hip", hip => hip.LengthScale = 0.9)));
        }

        [Test]
        public void the_style_and_the_rig_come_before_all_else()
        {
            Assert.AreEqual(SettingsChange.Style, After(settings => settings.Source = StyleSource.BuiltIn));
            Assert.AreEqual(SettingsChange.Style, After(settings => settings.BuiltInStyle = "sd4"));
            Assert.AreEqual(SettingsChange.Style, After(settings => settings.Heads = 3));
            Assert.AreEqual(SettingsChange.Style, After(settings => { settings.Blend = 1; settings.Options.FaceSquash = 0; }));
            Assert.AreEqual(SettingsChange.Rig, After(settings => { settings.RigAuto = true; settings.Heads = 3; }));
            Assert.AreEqual(SettingsChange.Rig, After(settings => settings.Options.RigFingers = false));
            Assert.AreEqual(SettingsChange.Rig, After(settings => settings.Options.RigJoints.Add(new GivenJoint())));
        }

        [Test]
        public void the_library_takes_both_ends_of_every_slider()
        {
            Models.NewProject();
            var model = new ConverterModel { Avatar = new ConversionFigure().Make().Root, RigOpen = true };
            model.Settings.Source = StyleSource.Heads;
            using (AvatarData avatar = CharacterReader.Read(model.Avatar, new ReadOptions()))
            using (Style style = Style.FromText("sd2.5"))
            using (var deformer = new Deformer(avatar.Character, style, model.Settings.Options))
            {
                int count = Sliders(model).Count;
                Assert.That(count, Is.GreaterThan(30));
                for (int slider = 0; slider < count; slider++)
                {
                    foreach (bool high in new[] { false, true })
                    {
                        ConversionSettings before = model.Settings.Clone();
                        SliderRow row = Sliders(model)[slider];
                        row.Set(high ? row.High : row.Low);
                        Assert.DoesNotThrow(() => deformer.SetOptions(model.Settings.Options), row.Label);
                        Assert.DoesNotThrow(() => model.Settings.MakeStyle().Dispose(), row.Label);
                        model.Settings = before;
                        model.Touch();
                    }
                }
            }
        }

        static List<SliderRow> Sliders(ConverterModel model)
        {
            var sliders = new List<SliderRow>();
            foreach (Section section in model.Sections)
            {
                foreach (Row row in section.Rows)
                {
                    if (row is SliderRow) sliders.Add((SliderRow)row);
                    if (row is GroupRow) sliders.AddRange(Array.FindAll(((GroupRow)row).Sliders, slider => slider != null));
                }
            }
            return sliders;
        }

        [Test]
        public void a_slider_gives_the_number_that_it_shows()
        {
            var model = new ConverterModel();
            model.Settings.Source = StyleSource.Heads;
            SliderRow heads = Sliders(model).Find(row => row.Label == Strings.Get("style.heads"));
            heads.Set(1.8f);
            using (Style style = model.Settings.MakeStyle()) Assert.AreEqual(1.8, style.Numbers.Heads);
            SliderRow amount = Sliders(model).Find(row => row.Label == Strings.Get("option.amount"));
            amount.Set(0.7f);
            Assert.AreEqual(0.7, model.Settings.Options.Amount);
            StringAssert.Contains("Options.Amount = 0.7\n", SettingsText.Write(model.Settings));
        }
    }
}
