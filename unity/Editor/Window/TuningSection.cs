using System;
using System.Collections.Generic;

namespace SuperDeform.Editor
{
    /// <summary>The section for fine tuning: what changes most, then body, head and face, hair, hands and feet.</summary>
    internal static class TuningSection
    {
        static readonly Options usual = new Options();

        /// <summary>By group of sliders: its name, what it begins with, and the bone groups in it.</summary>
        static readonly Part[] parts =
        {
            new Part("tune.body", Body, "neck", "torso", "shoulder", "upper_arm", "lower_arm", "hip", "upper_leg", "lower_leg"),
            new Part("tune.face", Face, "head"), new Part("tune.hair", Hair), new Part("tune.ends", model => new List<Row>(), "hand", "foot")
        };

        struct Part
        {
            internal readonly string Key;
            internal readonly Func<ConverterModel, List<Row>> Rows;
            internal readonly string[] Groups;

            internal Part(string key, Func<ConverterModel, List<Row>> rows, params string[] groups)
            {
                Key = key;
                Rows = rows;
                Groups = groups;
            }
        }

        internal static Section Of(ConverterModel model)
        {
            ConversionSettings settings = model.Settings;
            Section section = ConverterSections.New(model, SectionId.FineTuning);
            List<Row> rows = section.Rows;
            // The two that change most stand first.
            rows.Add(HeadSize(model));
            rows.Add(Youth(model));
            for (int part = 0; part < parts.Length; part++)
            {
                AddPart(model, rows, part);
            }
            int own = GroupTunings.Count(settings) + Settings(model).FindAll(row => row.IsOwn()).Count;
            section.Summary = own == 0 ? "" : Strings.Get("tune.summary", own);
            rows.Add(new ActionRow
            {
                Label = Strings.Get("tune.reset"), Enabled = own > 0, Do = () => model.Change("undo.reset", () => Clear(settings))
            });
            return section;
        }

        static void AddPart(ConverterModel model, List<Row> rows, int index)
        {
            Part part = parts[index];
            rows.Add(new FoldoutRow
            {
                Label = Strings.Get(part.Key), Get = () => model.TuningOpen[index],
                Set = value =>
                {
                    model.TuningOpen[index] = value;
                    model.Touch();
                }
            });
            if (!model.TuningOpen[index]) return;
            int first = rows.Count;
            rows.AddRange(part.Rows(model));
            if (part.Groups.Length > 0)
            {
                rows.Add(new ColumnsRow { Label = Strings.Get("report.group"), Columns = ConverterSections.Words("option.length_scale", "option.thickness_scale") });
            }
            foreach (TunableGroup group in GroupTunings.Groups)
            {
                if (Array.IndexOf(part.Groups, group.Name) >= 0) rows.Add(GroupOf(model, group));
            }
            for (int row = first; row < rows.Count; row++)
            {
                rows[row].Indent++;
            }
        }

        /// <summary>All sliders but those of bone groups, folded or not.</summary>
        static List<SliderRow> Settings(ConverterModel model)
        {
            var rows = new List<Row> { HeadSize(model), Youth(model) };
            Array.ForEach(parts, part => rows.AddRange(part.Rows(model)));
            return rows.FindAll(row => row is SliderRow).ConvertAll(row => (SliderRow)row);
        }

        static SliderRow Youth(ConverterModel model) =>
            Number(model, "option.youth", OptionRange.Youth, options => options.Youth, (options, value) => options.Youth = value, 1, "undo.face");

        static List<Row> Body(ConverterModel model)
        {
            Options options = model.Settings.Options;
            var rows = new List<Row>
            {
                Number(model, "option.amount", OptionRange.Amount, o => o.Amount, (o, value) => o.Amount = value),
                Number(model, "option.profile", OptionRange.Profile, o => o.Profile, (o, value) => o.Profile = value)
            };
            AddHeight(model, rows);
            rows.Add(ConverterSections.Toggle("option.repair", true, () => options.Repair != Repair.Off,
                value => model.Change("undo.tune", () => options.Repair = value ? Repair.On : Repair.Off)));
            return rows;
        }

        static List<Row> Hair(ConverterModel model)
        {
            return new List<Row>
            {
                Number(model, "option.hair_length", OptionRange.HairLength, o => o.HairLength, (o, value) => o.HairLength = value),
                Number(model, "option.hair_lay", OptionRange.HairLay, o => o.HairLay, (o, value) => o.HairLay = value, 1, "undo.face")
            };
        }

        /// <summary>All tuning as the style says it; what a new rig is made by, and where the style comes from, stay.</summary>
        static void Clear(ConversionSettings settings)
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
        static SliderRow Number(ConverterModel model, string key, OptionRange range, Func<Options, double> get, Action<Options, double> set,
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
        static SliderRow HeadSize(ConverterModel model)
        {
            double factor = OptionDefaults.HeadScale;
            return Number(model, "option.head_scale", new OptionRange(0.4 * factor, 1.8 * factor), options => options.HeadScale,
                (options, value) => options.HeadScale = value, factor);
        }

        static void AddHeight(ConverterModel model, List<Row> rows)
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

        // What Youth is made of, and what else there is of head and face.
        static List<Row> Face(ConverterModel model)
        {
            Options options = model.Settings.Options;
            var rows = new List<Row>();
            Action<string, OptionRange, Func<Options, double>, Action<Options, double>> add =
                (name, range, get, set) => rows.Add(Number(model, "option." + name, range, get, set, 1, "undo.face"));
            add("youth_eye", OptionRange.YouthEye, o => o.YouthEye, (o, value) => o.YouthEye = value);
            add("youth_lower", OptionRange.YouthLower, o => o.YouthLower, (o, value) => o.YouthLower = value);
            add("youth_nose", OptionRange.YouthNose, o => o.YouthNose, (o, value) => o.YouthNose = value);
            add("youth_cheek", OptionRange.YouthCheek, o => o.YouthCheek, (o, value) => o.YouthCheek = value);
            add("youth_jaw", OptionRange.YouthJaw, o => o.YouthJaw, (o, value) => o.YouthJaw = value);
            add("youth_skull", OptionRange.YouthSkull, o => o.YouthSkull, (o, value) => o.YouthSkull = value);
            add("youth_ear", OptionRange.YouthEar, o => o.YouthEar, (o, value) => o.YouthEar = value);
            rows.Insert(0, new TextRow { Label = Strings.Get("tune.youth") });
            for (int row = 1; row < rows.Count; row++)
            {
                rows[row].Indent++;
            }
            add("smile", OptionRange.Smile, o => o.Smile, (o, value) => o.Smile = value);
            SliderRow squash = ConverterSections.Slider("option.face_squash", 0, 1.5f,
                () => double.IsNaN(options.FaceSquash) ? (float)OptionDefaults.FaceSquash : (float)options.FaceSquash,
                value => model.Change("undo.face", () => options.FaceSquash = value));
            squash.IsOwn = () => !double.IsNaN(options.FaceSquash);
            squash.Reset = () => model.Change("undo.face", () => options.FaceSquash = double.NaN);
            rows.Add(squash);
            rows.Add(ConverterSections.Popup("face_curve", typeof(FaceCurve), () => (int)options.FaceCurve,
                value => model.Change("undo.face", () => options.FaceCurve = (FaceCurve)value)));
            add("seat", OptionRange.Seat, o => o.Seat, (o, value) => o.Seat = value);
            return rows;
        }

        static GroupRow GroupOf(ConverterModel model, TunableGroup group)
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
        static SliderRow GroupSlider(ConverterModel model, string group, string key, Func<float> found,
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
