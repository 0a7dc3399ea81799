using System;
using System.Collections.Generic;
using System.Globalization;
using UnityEngine;

namespace SuperDeform.Editor
{
    /// <summary>The five sections of the converter window, made from its model: which rows there are, and what they do.</summary>
    internal static class ConverterSections
    {
        internal static List<Section> Of(ConverterModel model) =>
            new List<Section> { Avatar(model), Style(model), TuningSection.Of(model), Preview(model), Report(model) };

        internal static Section New(ConverterModel model, SectionId id) =>
            new Section { Id = id, Title = Strings.Get("section." + id), Open = model.Open[(int)id] };

        // ---- Avatar: which one, and whether it can be converted -----------------------------------------------------

        static Section Avatar(ConverterModel model)
        {
            Section section = New(model, SectionId.Avatar);
            section.Summary = model.Avatar == null ? Strings.Get("avatar.none") : model.Avatar.name;
            section.Rows.Add(new ObjectRow
            {
                Label = Strings.Get("avatar.field"), Tooltip = Strings.Get("avatar.field.tooltip"),
                Type = typeof(GameObject), SceneObjects = true,
                Get = () => model.Avatar, Set = value => model.SetAvatar((GameObject)value)
            });
            if (model.Avatar == null) section.Rows.Add(new TextRow { Label = Strings.Get("avatar.hint") });
            else if (model.Findings.Count == 0) section.Rows.Add(new CheckRow { Severity = Severity.Info, Label = Strings.Get("avatar.ready") });
            foreach (Finding finding in model.Findings)
            {
                section.Rows.Add(Check(model, finding));
            }
            if (model.Avatar != null)
            {
                section.Rows.Add(Toggle("avatar.rig", true, () => model.Settings.RigAuto,
                    value =>
                    {
                        model.Change("undo.rig", () => model.Settings.RigAuto = value);
                        model.Recheck();
                    }));
            }
            if (model.Avatar != null) AddRig(model, section);
            return section;
        }

        // How a rig is made, where one is; folded, since the usual is right for most.
        static void AddRig(ConverterModel model, Section section)
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
            if (!model.RigOpen) return;
            section.Rows.Add(Popup("rig_weights", typeof(BodyWeights), () => (int)options.RigWeights,
                value => model.Change("undo.rig", () => options.RigWeights = (BodyWeights)value)));
            section.Rows.Add(Slider("option.rig_heat", 0.1f, 10, () => (float)options.RigHeat,
                value => model.Change("undo.rig", () => options.RigHeat = value)));
            section.Rows.Add(Slider("option.rig_voxel_resolution", OptionRange.RigVoxelResolution, () => options.RigVoxelResolution,
                value => model.Change("undo.rig", () => options.RigVoxelResolution = (uint)Math.Round(value))));
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

        static readonly string[] presets = { "sd2", "sd2.5", "sd3", "sd4" };
        static readonly float[] presetHeads = { 2, 2.5f, 3, 4 };
        static readonly StyleSource[] others =
            { StyleSource.Heads, StyleSource.ReferenceAvatar, StyleSource.SavedStyle };

        static Section Style(ConverterModel model)
        {
            ConversionSettings settings = model.Settings;
            Section section = New(model, SectionId.Style);
            section.Summary = StyleName(settings);
            section.Rows.Add(new ObjectRow
            {
                Label = Strings.Get("style.settings"), Tooltip = Strings.Get("style.settings.tooltip"),
                Type = typeof(SuperDeformPreset), Get = () => null,
                Set = value =>
                {
                    if (value != null) model.Take((SuperDeformPreset)value);
                }
            });
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
            {
                section.Rows.Add(new ObjectRow
                {
                    Label = Strings.Get("style.reference"), Tooltip = Strings.Get("style.reference.tooltip"),
                    Type = typeof(GameObject), SceneObjects = true, Get = () => settings.ReferenceAvatar,
                    Set = value => model.Change("undo.style", () => settings.ReferenceAvatar = (GameObject)value)
                });
            }
            if (settings.Source == StyleSource.SavedStyle)
            {
                section.Rows.Add(new ObjectRow
                {
                    Label = Strings.Get("style.saved"), Tooltip = Strings.Get("style.saved.tooltip"),
                    Type = typeof(TextAsset), Get = () => settings.SavedStyle,
                    Set = value => model.Change("undo.style", () => settings.SavedStyle = (TextAsset)value)
                });
            }
            bool fromModel = settings.Source == StyleSource.ReferenceAvatar || settings.Source == StyleSource.SavedStyle;
            if (fromModel)
            {
                section.Rows.Add(Slider("style.blend", OptionRange.Blend, () => settings.Blend,
                    value => model.Change("undo.blend", () => settings.Blend = (float)value)));
            }
            if (settings.Source == StyleSource.Heads || fromModel && settings.Blend > 0)
            {
                section.Rows.Add(Slider("style.heads", OptionRange.Heads, () => settings.Heads,
                    value => model.Change("undo.heads", () => settings.Heads = (float)value)));
            }
            if (fromModel)
            {
                section.Rows.Add(new ActionRow
                {
                    Label = Strings.Get("style.save"), Tooltip = Strings.Get("style.save.tooltip"),
                    Enabled = model.HasStyle, Do = model.SaveStyle
                });
            }
            return section;
        }

        static string StyleName(ConversionSettings settings)
        {
            if (settings.Source == StyleSource.Heads || settings.Source == StyleSource.BuiltIn)
            {
                return Strings.Get("style.heads.summary", Short(settings.Heads));
            }
            UnityEngine.Object like = settings.Source == StyleSource.ReferenceAvatar
                ? settings.ReferenceAvatar : (UnityEngine.Object)settings.SavedStyle;
            return like == null ? Strings.Get("style.none") : like.name;
        }

        // ---- Preview: in the Scene view -----------------------------------------------------------------------------

        static Section Preview(ConverterModel model)
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

        static Section Report(ConverterModel model)
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
                AddNotes(model, section, new List<Warning>(numbers.Warnings).ConvertAll(warning => LibraryWarnings.Of(warning, null)));
            }
            else section.Rows.Add(new TextRow { Label = Strings.Get("report.none") });
            if (model.PreviewFailure != null) section.Rows.Add(Check(model, model.PreviewFailure));
            if (model.Failure != null && (model.PreviewFailure == null || model.PreviewFailure.Text != model.Failure.Text))
            {
                section.Rows.Add(Check(model, model.Failure));
            }
            section.Rows.Add(new FieldRow
            {
                Label = Strings.Get("report.folder"), Tooltip = Strings.Get("report.folder.tooltip"),
                Get = () => model.Settings.OutputFolder ?? "",
                Set = value =>
                {
                    model.Change("undo.folder", () => model.Settings.OutputFolder = value);
                    model.ForgetEarlier();
                }
            });
            section.Rows.Add(Toggle("report.new_copy", true, () => model.Settings.NewCopy,
                value =>
                {
                    model.Change("undo.folder", () => model.Settings.NewCopy = value);
                    model.ForgetEarlier();
                }));
            section.Rows.Add(Toggle("report.place", true, () => model.Settings.PlaceInScene,
                value => model.Change("undo.folder", () => model.Settings.PlaceInScene = value)));
            section.Rows.Add(new ActionRow
            {
                Label = Strings.Get("style.keep"), Tooltip = Strings.Get("style.keep.tooltip"), Do = model.SavePreset
            });
            if (model.Earlier != null) section.Rows.Add(Replaces(model.Earlier));
            section.Rows.Add(new ActionRow
            {
                Label = Strings.Get("report.convert"), Tooltip = Strings.Get("report.convert.tooltip"), Main = true,
                Enabled = model.CanConvert, Do = model.Convert
            });
            if (!model.CanConvert) section.Rows.Add(new TextRow { Label = Strings.Get(Missing(model)) });
            if (model.Result != null)
            {
                section.Rows.Add(new CheckRow
                {
                    Severity = Severity.Info, Label = Strings.Get(model.Result.Updated ? "report.updated" : "report.made", model.Result.PrefabPath),
                    Where = model.Result.Prefab
                });
                AddNotes(model, section, model.Result.Findings.FindAll(finding => IsNews(model, finding)));
            }
            return section;
        }

        // Warnings as they are; what is good to know, and wants nothing done, folded below their number.
        static void AddNotes(ConverterModel model, Section section, List<Finding> findings)
        {
            var notes = new List<CheckRow>();
            foreach (Finding finding in findings)
            {
                CheckRow said = Check(model, finding);
                // Two of a kind, about two parts, are one sentence in the editor's language.
                bool known = section.Rows.Exists(row => row is CheckRow && row.Label == said.Label) || notes.Exists(row => row.Label == said.Label);
                if (known) continue;
                if (finding.Severity == Severity.Info && finding.Fix == null) notes.Add(said);
                else section.Rows.Add(said);
            }
            if (notes.Count == 0) return;
            section.Rows.Add(new FoldoutRow
            {
                Label = Strings.Get(notes.Count == 1 ? "report.note" : "report.notes", notes.Count), Tooltip = Strings.Get("report.notes.tooltip"),
                Get = () => model.NotesOpen,
                Set = value =>
                {
                    model.NotesOpen = value;
                    model.Touch();
                }
            });
            if (model.NotesOpen) section.Rows.AddRange(notes.ConvertAll(note => (Row)note));
        }

        // What will be no more as it is, before the button is pressed.
        internal static CheckRow Replaces(ResultUpdate earlier)
        {
            bool same = earlier.Match == SourceMatch.Same;
            return new CheckRow
            {
                Severity = same ? Severity.Info : Severity.Warning,
                Label = Strings.Get(same ? "report.replaces" : "report.replaces_perhaps", earlier.PrefabPath, earlier.MadeFrom),
                Where = UnityEditor.AssetDatabase.LoadAssetAtPath<GameObject>(earlier.PrefabPath)
            };
        }

        // What the checks of the avatar or the preview say already is not said again.
        static bool IsNews(ConverterModel model, Finding finding)
        {
            if (LibraryWarnings.IsOne(finding)) return model.Numbers == null;
            foreach (Finding known in model.Findings)
            {
                if (known.Text == finding.Text) return false;
            }
            return true;
        }

        static string Missing(ConverterModel model) =>
            model.Avatar == null ? "report.no_avatar" : model.HasStyle ? "report.not_ready" : "report.no_style";

        static string Heads(PreviewNumbers numbers) =>
            Strings.Get("report.heads", OneDigit(numbers.Report.Target.Heads), OneDigit(numbers.Report.Result.Heads));

        static TableRow Groups(PreviewNumbers numbers)
        {
            var table = new TableRow { Columns = Words("report.group", "report.length", "report.thickness") };
            foreach (TunableGroup group in GroupTunings.Groups)
            {
                foreach (Group found in numbers.Groups)
                {
                    if (found.Name == group.Name)
                    {
                        table.Cells.Add(new[]
                        {
                            TuningSection.NameOf(group), Percent(found.LengthScale),
                            group.IsSpread || group.IsSize ? "" : Percent(found.ThicknessScale)
                        });
                    }
                }
            }
            return table;
        }

        // ---- Small things -------------------------------------------------------------------------------------------

        internal static string[] Words(params string[] keys) => Array.ConvertAll(keys, key => Strings.Get(key));

        static string Short(double value) => value.ToString("0.##", CultureInfo.InvariantCulture);

        static string TwoDigits(double value) => value.ToString("0.00", CultureInfo.InvariantCulture);

        static string OneDigit(double value) => value.ToString("0.0", CultureInfo.InvariantCulture);

        static string Percent(double value) => double.IsNaN(value) ? "" : (100 * value).ToString("0", CultureInfo.InvariantCulture) + " %";

        // An option of the library that is one of some words.
        internal static PopupRow Popup(string option, Type words, Func<int> get, Action<int> set)
        {
            string key = "option." + option;
            return new PopupRow
            {
                Label = Strings.Get(key), Tooltip = Strings.Get(key + ".tooltip"), Get = get, Set = set,
                Choices = Array.ConvertAll(Enum.GetNames(words), word => Strings.Get(key + "." + word.ToLowerInvariant()))
            };
        }

        internal static SliderRow Slider(string key, OptionRange range, Func<float> get, Action<double> set) =>
            Slider(key, (float)range.Low, (float)range.High, get, set);

        internal static SliderRow Slider(string key, float low, float high, Func<float> get, Action<double> set)
        {
            return new SliderRow
            {
                Label = Strings.Get(key), Tooltip = Strings.Get(key + ".tooltip"), Low = low, High = high,
                Get = get, Set = value => set(Exact.Of(value)), IsOwn = () => false
            };
        }

        internal static ToggleRow Toggle(string key, bool enabled, Func<bool> get, Action<bool> set)
        {
            return new ToggleRow
            {
                Label = Strings.Get(key), Tooltip = Strings.Get(key + ".tooltip"), Enabled = enabled, Get = get, Set = set
            };
        }
    }
}
