using System;
using System.Collections.Generic;
using System.Globalization;
using UnityEngine;

namespace SuperDeform.Editor
{
    /// <summary>The five sections of the converter window, made from its model: which rows there are, and what they do.</summary>
    internal static class ConverterSections
    {
        internal static List<Section> Of(ConverterModel model)
        {
            return new List<Section> { Avatar(model), Style(model), FineTuning(model), Preview(model), Report(model) };
        }

        private static Section New(ConverterModel model, SectionId id)
        {
            return new Section { Id = id, Title = Strings.Get("section." + id), Open = model.Open[(int)id] };
        }

        // ---- Avatar: which one, and whether it can be converted -----------------------------------------------------

        private static Section Avatar(ConverterModel model)
        {
            Section section = New(model, SectionId.Avatar);
            section.Summary = model.Avatar == null ? Strings.Get("avatar.none") : model.Avatar.name;
            section.Rows.Add(new ObjectRow
            {
                Label = Strings.Get("avatar.field"), Tooltip = Strings.Get("avatar.field.tooltip"),
                Type = typeof(GameObject), SceneObjects = true,
                Get = () => model.Avatar, Set = value => model.SetAvatar((GameObject)value)
            });
            if (model.Avatar == null)
                section.Rows.Add(new TextRow { Label = Strings.Get("avatar.hint") });
            else if (model.Findings.Count == 0)
                section.Rows.Add(new CheckRow { Severity = Severity.Info, Label = Strings.Get("avatar.ready") });
            foreach (Finding finding in model.Findings)
                section.Rows.Add(Check(model, finding));
            if (model.Avatar != null)
                section.Rows.Add(Toggle("avatar.rig", true, () => model.Settings.RigAuto,
                    value =>
                    {
                        model.Change("undo.rig", () => model.Settings.RigAuto = value);
                        model.Recheck();
                    }));
            if (model.Avatar != null)
                AddRig(model, section);
            return section;
        }

        // How a rig is made, where one is; folded, since the usual is right for most.
        private static void AddRig(ConverterModel model, Section section)
        {
            Options options = model.Settings.Options;
            section.Rows.Add(new FoldoutRow
            {
                Label = Strings.Get("rig.more"), Tooltip = Strings.Get("rig.more.tooltip"), Get = () => model.RigOpen,
                Set = value =>
                {
                    model.RigOpen = value;
                    model.Touch();
                }
            });
            if (!model.RigOpen)
                return;
            section.Rows.Add(Popup("rig_weights", typeof(BodyWeights), () => (int)options.RigWeights,
                value => model.Change("undo.rig", () => options.RigWeights = (BodyWeights)value)));
            section.Rows.Add(Slider("option.rig_heat", 0.1f, 10, () => (float)options.RigHeat,
                value => model.Change("undo.rig", () => options.RigHeat = value)));
            section.Rows.Add(Slider("option.rig_voxel_resolution", OptionRange.RigVoxelResolution, () => options.RigVoxelResolution,
                value => model.Change("undo.rig", () => options.RigVoxelResolution = (uint)Mathf.RoundToInt(value))));
            section.Rows.Add(Popup("rig_garments", typeof(GarmentWeights), () => (int)options.RigGarments,
                value => model.Change("undo.rig", () => options.RigGarments = (GarmentWeights)value)));
            section.Rows.Add(Toggle("option.rig_fingers", true, () => options.RigFingers,
                value => model.Change("undo.rig", () => options.RigFingers = value)));
        }

        internal static CheckRow Check(ConverterModel model, Finding finding)
        {
            var row = new CheckRow { Label = finding.Text, Severity = finding.Severity, Where = finding.Where };
            if (finding.Fix != null)
            {
                row.FixLabel = Strings.Get(string.IsNullOrEmpty(finding.FixKey) ? "fix" : finding.FixKey);
                row.Fix = () =>
                {
                    finding.Fix();
                    model.Recheck();
                };
            }
            else if (finding.Choice != null)
            {
                row.FixLabel = Strings.Get("fix_choose");
                row.Fix = () => model.SetAvatar(finding.Choice);
            }
            return row;
        }

        // ---- Style: what it should become ---------------------------------------------------------------------------

        private static readonly string[] presets = { "sd2", "sd2.5", "sd3", "sd4" };
        private static readonly float[] presetHeads = { 2, 2.5f, 3, 4 };
        private static readonly StyleSource[] others =
            { StyleSource.Heads, StyleSource.ReferenceAvatar, StyleSource.SavedStyle };

        private static Section Style(ConverterModel model)
        {
            ConversionSettings settings = model.Settings;
            Section section = New(model, SectionId.Style);
            section.Summary = StyleName(settings);
            section.Rows.Add(new ChoiceRow
            {
                Label = Strings.Get("style.presets"), Tooltip = Strings.Get("style.presets.tooltip"),
                Choices = Array.ConvertAll(presetHeads, heads => Strings.Get("style.heads.summary", Short(heads))),
                Get = () => settings.Source == StyleSource.BuiltIn ? Array.IndexOf(presets, settings.BuiltInStyle) : -1,
                Set = value => model.Change("undo.style", () =>
                {
                    settings.Source = StyleSource.BuiltIn;
                    settings.BuiltInStyle = presets[value];
                    settings.Heads = presetHeads[value];
                    // A preset is a whole style; a blend left over from another source would stretch it again.
                    settings.Blend = 0;
                })
            });
            section.Rows.Add(new ChoiceRow
            {
                Label = Strings.Get("style.source"), Tooltip = Strings.Get("style.source.tooltip"),
                Choices = Words("style.source.heads", "style.source.reference", "style.source.saved"),
                Get = () => Array.IndexOf(others, settings.Source),
                Set = value => model.Change("undo.style", () => settings.Source = others[value])
            });
            if (settings.Source == StyleSource.ReferenceAvatar)
                section.Rows.Add(new ObjectRow
                {
                    Label = Strings.Get("style.reference"), Tooltip = Strings.Get("style.reference.tooltip"),
                    Type = typeof(GameObject), SceneObjects = true, Get = () => settings.ReferenceAvatar,
                    Set = value => model.Change("undo.style", () => settings.ReferenceAvatar = (GameObject)value)
                });
            if (settings.Source == StyleSource.SavedStyle)
                section.Rows.Add(new ObjectRow
                {
                    Label = Strings.Get("style.saved"), Tooltip = Strings.Get("style.saved.tooltip"),
                    Type = typeof(TextAsset), Get = () => settings.SavedStyle,
                    Set = value => model.Change("undo.style", () => settings.SavedStyle = (TextAsset)value)
                });
            bool fromModel = settings.Source == StyleSource.ReferenceAvatar || settings.Source == StyleSource.SavedStyle;
            if (fromModel)
                section.Rows.Add(Slider("style.blend", OptionRange.Blend, () => settings.Blend,
                    value => model.Change("undo.blend", () => settings.Blend = value)));
            if (settings.Source == StyleSource.Heads || fromModel && settings.Blend > 0)
                section.Rows.Add(Slider("style.heads", OptionRange.Heads, () => settings.Heads,
                    value => model.Change("undo.heads", () => settings.Heads = value)));
            if (fromModel)
                section.Rows.Add(new ActionRow
                {
                    Label = Strings.Get("style.save"), Tooltip = Strings.Get("style.save.tooltip"),
                    Enabled = model.HasStyle, Do = model.SaveStyle
                });
            return section;
        }

        private static string StyleName(ConversionSettings settings)
        {
            if (settings.Source == StyleSource.Heads || settings.Source == StyleSource.BuiltIn)
                return Strings.Get("style.heads.summary", Short(settings.Heads));
            UnityEngine.Object like = settings.Source == StyleSource.ReferenceAvatar
                ? settings.ReferenceAvatar : (UnityEngine.Object)settings.SavedStyle;
            return like == null ? Strings.Get("style.none") : like.name;
        }

        // ---- Fine tuning: by bone group, and of the head ------------------------------------------------------------

        private static Section FineTuning(ConverterModel model)
        {
            ConversionSettings settings = model.Settings;
            Options options = settings.Options;
            Section section = New(model, SectionId.FineTuning);
            int own = GroupTunings.Count(settings);
            section.Summary = own == 0 ? "" : Strings.Get("tune.summary", own);
            section.Rows.Add(Slider("option.amount", OptionRange.Amount, () => (float)options.Amount,
                value => model.Change("undo.tune", () => options.Amount = value)));
            section.Rows.Add(Slider("option.head_scale", 0.5f, 2.5f, () => (float)options.HeadScale,
                value => model.Change("undo.tune", () => options.HeadScale = value)));
            section.Rows.Add(Slider("option.profile", OptionRange.Profile, () => (float)options.Profile,
                value => model.Change("undo.tune", () => options.Profile = value)));
            section.Rows.Add(Slider("option.hair_length", OptionRange.HairLength, () => (float)options.HairLength,
                value => model.Change("undo.tune", () => options.HairLength = value)));
            section.Rows.Add(Toggle("option.height.keep", true, () => options.Height == 0,
                value => model.Change("undo.tune", () => options.Height = value ? 0 : double.NaN)));
            SliderRow height = Slider("option.height", 0.2f, 3, () => options.Height > 0 ? (float)options.Height : model.HeightFound,
                value => model.Change("undo.tune", () => options.Height = value));
            height.IsOwn = () => options.Height > 0;
            height.Reset = () => model.Change("undo.tune", () => options.Height = double.NaN);
            section.Rows.Add(height);
            SliderRow face = Slider("option.face_squash", 0, 1.5f,
                () => double.IsNaN(options.FaceSquash) ? (float)OptionDefaults.FaceSquash : (float)options.FaceSquash,
                value => model.Change("undo.face", () => options.FaceSquash = value));
            face.IsOwn = () => !double.IsNaN(options.FaceSquash);
            face.Reset = () => model.Change("undo.face", () => options.FaceSquash = double.NaN);
            section.Rows.Add(face);
            section.Rows.Add(Slider("option.youth", OptionRange.Youth, () => (float)options.Youth,
                value => model.Change("undo.face", () => options.Youth = value)));
            section.Rows.Add(Slider("option.youth_eye", OptionRange.YouthEye, () => (float)options.YouthEye,
                value => model.Change("undo.face", () => options.YouthEye = value)));
            section.Rows.Add(Slider("option.youth_lower", OptionRange.YouthLower, () => (float)options.YouthLower,
                value => model.Change("undo.face", () => options.YouthLower = value)));
            section.Rows.Add(Slider("option.youth_nose", OptionRange.YouthNose, () => (float)options.YouthNose,
                value => model.Change("undo.face", () => options.YouthNose = value)));
            section.Rows.Add(Slider("option.youth_cheek", OptionRange.YouthCheek, () => (float)options.YouthCheek,
                value => model.Change("undo.face", () => options.YouthCheek = value)));
            section.Rows.Add(Slider("option.youth_jaw", OptionRange.YouthJaw, () => (float)options.YouthJaw,
                value => model.Change("undo.face", () => options.YouthJaw = value)));
            section.Rows.Add(Slider("option.youth_skull", OptionRange.YouthSkull, () => (float)options.YouthSkull,
                value => model.Change("undo.face", () => options.YouthSkull = value)));
            section.Rows.Add(Slider("option.youth_ear", OptionRange.YouthEar, () => (float)options.YouthEar,
                value => model.Change("undo.face", () => options.YouthEar = value)));
            section.Rows.Add(Slider("option.smile", OptionRange.Smile, () => (float)options.Smile,
                value => model.Change("undo.face", () => options.Smile = value)));
            section.Rows.Add(Slider("option.seat", OptionRange.Seat, () => (float)options.Seat,
                value => model.Change("undo.face", () => options.Seat = value)));
            section.Rows.Add(Slider("option.hair_lay", OptionRange.HairLay, () => (float)options.HairLay,
                value => model.Change("undo.face", () => options.HairLay = value)));
            section.Rows.Add(Popup("face_curve", typeof(FaceCurve), () => (int)options.FaceCurve,
                value => model.Change("undo.face", () => options.FaceCurve = (FaceCurve)value)));
            section.Rows.Add(new TextRow { Label = Strings.Get("tune.groups"), Strong = true });
            section.Rows.Add(new ColumnsRow
            {
                Label = Strings.Get("report.group"), Columns = Words("option.length_scale", "option.thickness_scale")
            });
            foreach (TunableGroup group in GroupTunings.Groups)
                section.Rows.Add(GroupOf(model, group));
            section.Rows.Add(new ActionRow
            {
                Label = Strings.Get("tune.reset"), Enabled = own > 0,
                Do = () => model.Change("undo.reset", () => GroupTunings.Clear(settings))
            });
            return section;
        }

        private static GroupRow GroupOf(ConverterModel model, TunableGroup group)
        {
            string length = group.IsSize ? "tune.size" : group.IsSpread ? "tune.spread" : "option.length_scale";
            return new GroupRow
            {
                Label = NameOf(group),
                Sliders = new[]
                {
                    GroupSlider(model, group.Name, length, () => model.ScaleFound(group.Name, false),
                        tuned => tuned.LengthScale, (tuned, value) => tuned.LengthScale = value),
                    group.IsSize || group.IsSpread ? null
                        : GroupSlider(model, group.Name, "option.thickness_scale", () => model.ScaleFound(group.Name, true),
                            tuned => tuned.ThicknessScale, (tuned, value) => tuned.ThicknessScale = value)
                }
            };
        }

        private static string NameOf(TunableGroup group)
        {
            string name = Strings.Get("group." + group.Name);
            return group.IsSize ? Strings.Get("group.size", name) : group.IsSpread ? Strings.Get("group.spread", name) : name;
        }

        // found: what it is until a person sets it.
        private static SliderRow GroupSlider(ConverterModel model, string group, string key, Func<float> found,
            Func<GroupSettings, double> get, Action<GroupSettings, double> change)
        {
            Func<double> own = () => get(GroupTunings.Of(model.Settings, group));
            Action<double> set = value => model.Change("undo.tune",
                () => GroupTunings.Change(model.Settings, group, tuned => change(tuned, value)));
            SliderRow row = Slider(key, 0.1f, 2, () => double.IsNaN(own()) ? found() : (float)own(), value => set(value));
            row.IsOwn = () => !double.IsNaN(own());
            row.Reset = () => set(double.NaN);
            return row;
        }

        // ---- Preview: in the Scene view -----------------------------------------------------------------------------

        private static Section Preview(ConverterModel model)
        {
            Section section = New(model, SectionId.Preview);
            section.Summary = Strings.Get(model.PreviewOn ? "preview.on" : "preview.off");
            section.Rows.Add(Toggle("preview.live", true, () => model.PreviewOn,
                value => model.Change("undo.preview", () => model.PreviewOn = value)));
            section.Rows.Add(new ChoiceRow
            {
                Label = Strings.Get("preview.show"), Tooltip = Strings.Get("preview.show.tooltip"),
                Enabled = model.PreviewOn, Choices = Words("preview.before", "preview.after"),
                Get = () => model.ShowBefore ? 0 : 1,
                Set = value => model.Change("undo.preview", () => model.ShowBefore = value == 0)
            });
            section.Rows.Add(Toggle("preview.beside", model.PreviewOn && !model.ShowBefore, () => model.Beside,
                value => model.Change("undo.preview", () => model.Beside = value)));
            section.Rows.Add(new ChoiceRow
            {
                Label = Strings.Get("preview.pose"), Tooltip = Strings.Get("preview.pose.tooltip"),
                Enabled = model.PreviewOn && !model.ShowBefore,
                Choices = Words("preview.pose.stands", "preview.pose.walks", "preview.pose.sits"),
                Get = () => (int)model.Pose,
                Set = value => model.Change("undo.preview", () => model.Pose = (PreviewPose)value)
            });
            return section;
        }

        // ---- Report, and the button that converts -------------------------------------------------------------------

        private static Section Report(ConverterModel model)
        {
            Section section = New(model, SectionId.Report);
            PreviewNumbers numbers = model.Numbers;
            if (numbers != null)
            {
                section.Summary = Heads(numbers);
                section.Rows.Add(new TextRow { Strong = true, Label = Heads(numbers) });
                section.Rows.Add(new TextRow
                {
                    Label = Strings.Get("report.height", TwoDigits(numbers.Report.Target.Height),
                        TwoDigits(numbers.Report.Result.Height))
                });
                section.Rows.Add(Groups(numbers));
                foreach (Warning warning in numbers.Warnings)
                    section.Rows.Add(Warned(warning));
            }
            else
                section.Rows.Add(new TextRow { Label = Strings.Get("report.none") });
            if (model.PreviewFailure != null)
                section.Rows.Add(Check(model, model.PreviewFailure));
            if (model.Failure != null && (model.PreviewFailure == null || model.PreviewFailure.Text != model.Failure.Text))
                section.Rows.Add(Check(model, model.Failure));
            section.Rows.Add(new FieldRow
            {
                Label = Strings.Get("report.folder"), Tooltip = Strings.Get("report.folder.tooltip"),
                Get = () => model.Settings.OutputFolder ?? "",
                Set = value => model.Change("undo.folder", () => model.Settings.OutputFolder = value)
            });
            section.Rows.Add(new ActionRow
            {
                Label = Strings.Get("report.convert"), Tooltip = Strings.Get("report.convert.tooltip"), Main = true,
                Enabled = model.CanConvert, Do = model.Convert
            });
            if (!model.CanConvert)
                section.Rows.Add(new TextRow { Label = Strings.Get(Missing(model)) });
            if (model.Result != null)
            {
                section.Rows.Add(new CheckRow
                {
                    Severity = Severity.Info, Label = Strings.Get("report.made", model.Result.PrefabPath),
                    Where = model.Result.Prefab
                });
                foreach (Finding finding in model.Result.Findings)
                    if (IsNews(model, finding))
                        section.Rows.Add(Check(model, finding));
            }
            return section;
        }

        // What the checks of the avatar or the preview say already is not said again.
        private static bool IsNews(ConverterModel model, Finding finding)
        {
            if (finding.Key == "library_notes")
                return model.Numbers == null;
            foreach (Finding known in model.Findings)
                if (known.Text == finding.Text)
                    return false;
            return true;
        }

        private static string Missing(ConverterModel model)
        {
            return model.Avatar == null ? "report.no_avatar" : model.HasStyle ? "report.not_ready" : "report.no_style";
        }

        private static string Heads(PreviewNumbers numbers)
        {
            return Strings.Get("report.heads", OneDigit(numbers.Report.Target.Heads), OneDigit(numbers.Report.Result.Heads));
        }

        private static TableRow Groups(PreviewNumbers numbers)
        {
            var table = new TableRow { Columns = Words("report.group", "report.length", "report.thickness") };
            foreach (TunableGroup group in GroupTunings.Groups)
                foreach (Group found in numbers.Groups)
                    if (found.Name == group.Name)
                        table.Cells.Add(new[]
                        {
                            NameOf(group), Percent(found.LengthScale),
                            group.IsSpread || group.IsSize ? "" : Percent(found.ThicknessScale)
                        });
            return table;
        }

        // Codes of the library for what a person may like to know, but need not do anything about.
        private static readonly string[] harmless = { "coefficient_limited", "crown_with_hair", "hair_shortened", "kind_guessed" };

        /// <summary>What the library warns of, in words for people; its own sentence where there are none.</summary>
        private static CheckRow Warned(Warning warning)
        {
            string key = "warning." + warning.Code, sentence = Strings.OfLibrary(warning.Text);
            return new CheckRow
            {
                Label = Strings.Has(key) ? Strings.Get(key, sentence) : sentence,
                Severity = Array.IndexOf(harmless, warning.Code) >= 0 ? Severity.Info : Severity.Warning
            };
        }

        // ---- Small things -------------------------------------------------------------------------------------------

        private static string[] Words(params string[] keys)
        {
            return Array.ConvertAll(keys, key => Strings.Get(key));
        }

        private static string Short(double value)
        {
            return value.ToString("0.##", CultureInfo.InvariantCulture);
        }

        private static string TwoDigits(double value)
        {
            return value.ToString("0.00", CultureInfo.InvariantCulture);
        }

        private static string OneDigit(double value)
        {
            return value.ToString("0.0", CultureInfo.InvariantCulture);
        }

        private static string Percent(double value)
        {
            return double.IsNaN(value) ? "" : (100 * value).ToString("0", CultureInfo.InvariantCulture) + " %";
        }

        // An option of the library that is one of some words.
        private static PopupRow Popup(string option, Type words, Func<int> get, Action<int> set)
        {
            string key = "option." + option;
            return new PopupRow
            {
                Label = Strings.Get(key), Tooltip = Strings.Get(key + ".tooltip"), Get = get, Set = set,
                Choices = Array.ConvertAll(Enum.GetNames(words), word => Strings.Get(key + "." + word.ToLowerInvariant()))
            };
        }

        private static SliderRow Slider(string key, OptionRange range, Func<float> get, Action<float> set)
        {
            return Slider(key, (float)range.Low, (float)range.High, get, set);
        }

        private static SliderRow Slider(string key, float low, float high, Func<float> get, Action<float> set)
        {
            return new SliderRow
            {
                Label = Strings.Get(key), Tooltip = Strings.Get(key + ".tooltip"), Low = low, High = high,
                Get = get, Set = set, IsOwn = () => false
            };
        }

        private static ToggleRow Toggle(string key, bool enabled, Func<bool> get, Action<bool> set)
        {
            return new ToggleRow
            {
                Label = Strings.Get(key), Tooltip = Strings.Get(key + ".tooltip"), Enabled = enabled, Get = get, Set = set
            };
        }
    }
}
