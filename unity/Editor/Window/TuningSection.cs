using System;
using System.Collections.Generic;

namespace SuperDeform.Editor
{
    /// <summary>The section for fine tuning: head, hair, height and face, then the bone groups.</summary>
    internal static class TuningSection
    {
        private static readonly Options usual = new Options();

        internal static Section Of(ConverterModel model)
        {
            ConversionSettings settings = model.Settings;
            Section section = ConverterSections.New(model, SectionId.FineTuning);
            List<Row> rows = section.Rows;
            rows.Add(Number(model, "option.amount", OptionRange.Amount, options => options.Amount, (options, value) => options.Amount = value));
            rows.Add(HeadSize(model));
            rows.Add(Number(model, "option.profile", OptionRange.Profile, options => options.Profile, (options, value) => options.Profile = value));
            rows.Add(Number(model, "option.hair_length", OptionRange.HairLength, options => options.HairLength, (options, value) => options.HairLength = value));
            AddHeight(model, rows);
            AddFace(model, rows);
            rows.Add(ConverterSections.Toggle("option.repair", true, () => settings.Options.Repair != Repair.Off,
                value => model.Change("undo.tune", () => settings.Options.Repair = value ? Repair.On : Repair.Off)));
            int own = GroupTunings.Count(settings) + rows.FindAll(row => row is SliderRow && ((SliderRow)row).IsOwn()).Count;
            section.Summary = own == 0 ? "" : Strings.Get("tune.summary", own);
            rows.Add(new TextRow { Label = Strings.Get("tune.groups"), Strong = true });
            rows.Add(new ColumnsRow
            {
                Label = Strings.Get("report.group"), Columns = ConverterSections.Words("option.length_scale", "option.thickness_scale")
            });
            foreach (TunableGroup group in GroupTunings.Groups)
                rows.Add(GroupOf(model, group));
            rows.Add(new ActionRow
            {
                Label = Strings.Get("tune.reset"), Enabled = own > 0, Do = () => model.Change("undo.reset", () => Clear(settings))
            });
            return section;
        }

        /// <summary>All tuning as the style says it; what a new rig is made by, and where the style comes from, stay.</summary>
        private static void Clear(ConversionSettings settings)
        {
            GroupTunings.Clear(settings);
            Options options = settings.Options;
            options.ResetNumbers();
            options.FaceSquash = usual.FaceSquash;
            options.Height = usual.Height;
            options.Repair = usual.Repair;
            options.FaceCurve = usual.FaceCurve;
        }

        /// <summary>A slider of the library's options, which goes back to the usual number.</summary>
        private static SliderRow Number(ConverterModel model, string key, OptionRange range, Func<Options, double> get, Action<Options, double> set,
            double factor = 1, string undo = "undo.tune")
        {
            Options options = model.Settings.Options;
            SliderRow row = ConverterSections.Slider(key, (float)(range.Low / factor), (float)(range.High / factor), () => (float)(get(options) / factor),
                value => model.Change(undo, () => set(options, value * factor)));
            row.IsOwn = () => !get(options).Equals(get(usual));
            row.Reset = () => model.Change(undo, () => set(options, get(usual)));
            return row;
        }

        // A head of the style's own size is the usual number of the library, the paper's 1.5: here it is 1.
        private static SliderRow HeadSize(ConverterModel model)
        {
            double factor = OptionDefaults.HeadScale;
            return Number(model, "option.head_scale", new OptionRange(0.4 * factor, 1.8 * factor), options => options.HeadScale,
                (options, value) => options.HeadScale = value, factor);
        }

        private static void AddHeight(ConverterModel model, List<Row> rows)
        {
            Options options = model.Settings.Options;
            rows.Add(ConverterSections.Toggle("option.height.keep", true, () => options.Height == 0,
                value => model.Change("undo.tune", () => options.Height = value ? 0 : double.NaN)));
            SliderRow height = ConverterSections.Slider("option.height", 0.2f, 3, () => options.Height > 0 ? (float)options.Height : model.HeightFound,
                value => model.Change("undo.tune", () => options.Height = value));
            height.IsOwn = () => options.Height > 0;
            height.Reset = () => model.Change("undo.tune", () => options.Height = double.NaN);
            rows.Add(height);
        }

        private static void AddFace(ConverterModel model, List<Row> rows)
        {
            Options options = model.Settings.Options;
            SliderRow face = ConverterSections.Slider("option.face_squash", 0, 1.5f,
                () => double.IsNaN(options.FaceSquash) ? (float)OptionDefaults.FaceSquash : (float)options.FaceSquash,
                value => model.Change("undo.face", () => options.FaceSquash = value));
            face.IsOwn = () => !double.IsNaN(options.FaceSquash);
            face.Reset = () => model.Change("undo.face", () => options.FaceSquash = double.NaN);
            rows.Add(face);
            Action<string, OptionRange, Func<Options, double>, Action<Options, double>> add =
                (name, range, get, set) => rows.Add(Number(model, "option." + name, range, get, set, 1, "undo.face"));
            add("youth", OptionRange.Youth, o => o.Youth, (o, value) => o.Youth = value);
            add("youth_eye", OptionRange.YouthEye, o => o.YouthEye, (o, value) => o.YouthEye = value);
            add("youth_lower", OptionRange.YouthLower, o => o.YouthLower, (o, value) => o.YouthLower = value);
            add("youth_nose", OptionRange.YouthNose, o => o.YouthNose, (o, value) => o.YouthNose = value);
            add("youth_cheek", OptionRange.YouthCheek, o => o.YouthCheek, (o, value) => o.YouthCheek = value);
            add("youth_jaw", OptionRange.YouthJaw, o => o.YouthJaw, (o, value) => o.YouthJaw = value);
            add("youth_skull", OptionRange.YouthSkull, o => o.YouthSkull, (o, value) => o.YouthSkull = value);
            add("youth_ear", OptionRange.YouthEar, o => o.YouthEar, (o, value) => o.YouthEar = value);
            add("smile", OptionRange.Smile, o => o.Smile, (o, value) => o.Smile = value);
            add("seat", OptionRange.Seat, o => o.Seat, (o, value) => o.Seat = value);
            add("hair_lay", OptionRange.HairLay, o => o.HairLay, (o, value) => o.HairLay = value);
            rows.Add(ConverterSections.Popup("face_curve", typeof(FaceCurve), () => (int)options.FaceCurve,
                value => model.Change("undo.face", () => options.FaceCurve = (FaceCurve)value)));
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

        internal static string NameOf(TunableGroup group)
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
            SliderRow row = ConverterSections.Slider(key, 0.1f, 2, () => double.IsNaN(own()) ? found() : (float)own(), value => set(value));
            row.IsOwn = () => !double.IsNaN(own());
            row.Reset = () => set(double.NaN);
            return row;
        }
    }
}
