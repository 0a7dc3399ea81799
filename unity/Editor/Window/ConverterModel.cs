using System;
using System.Collections.Generic;
using UnityEngine;

namespace SuperDeform.Editor
{
    /// <summary>What the converter window knows: its settings, what was found out, and its five sections as data.</summary>
    /// <remarks>
    /// It draws nothing. ConverterWindow draws the sections with IMGUI, the tool WindowPicture draws them for the
    /// documentation, and tests press the buttons. Public fields are kept when scripts reload; the rest is found again.
    /// </remarks>
    [Serializable]
    public sealed class ConverterModel
    {
        public GameObject Avatar;
        public ConversionSettings Settings = new ConversionSettings { Source = StyleSource.BuiltIn };
        /// <summary>Whether the Scene view shows the result while settings change.</summary>
        public bool PreviewOn = true;
        /// <summary>Shows the avatar as it is, in place of the result.</summary>
        public bool ShowBefore;
        /// <summary>Shows the result beside the avatar, not in its place.</summary>
        public bool Beside;
        public PreviewPose Pose = PreviewPose.AsItStands;
        /// <summary>Whether each section is unfolded, in their order.</summary>
        public bool[] Open = { true, true, false, true, true };
        /// <summary>Whether the settings of a new rig are unfolded.</summary>
        public bool RigOpen;
        /// <summary>Whether what is good to know, and wants nothing done, is unfolded.</summary>
        public bool NotesOpen;
        /// <summary>Whether each group of the fine tuning is unfolded, in their order.</summary>
        public bool[] TuningOpen = { true, true, true, true };

        [NonSerialized] List<Section> sections;
        [NonSerialized] List<Finding> findings;
        [NonSerialized] Finding failure, previewFailure;
        [NonSerialized] PreviewNumbers numbers;
        [NonSerialized] ConversionResult result;
        [NonSerialized] ResultUpdate earlier;
        [NonSerialized] bool earlierKnown;
        [NonSerialized] string language;

        /// <summary>Comes before a change, with words for the Undo menu.</summary>
        public event Action<string> Changing;

        /// <summary>Comes after a change.</summary>
        public event Action Changed;

        /// <summary>Comes when the button to convert is pressed.</summary>
        public event Action Converting;

        /// <summary>Comes when a measured style is to be saved as a file.</summary>
        public event Action SavingStyle;

        /// <summary>The five sections, in their order; made anew after a change.</summary>
        public IList<Section> Sections
        {
            get
            {
                if (sections == null || language != Strings.Language)
                {
                    language = Strings.Language;
                    sections = ConverterSections.Of(this);
                }
                return sections;
            }
        }

        /// <summary>What AvatarChecks says of the avatar; empty without one.</summary>
        public IList<Finding> Findings
        {
            get
            {
                if (findings == null) findings = Avatar == null ? new List<Finding>() : AvatarChecks.Of(Avatar, Settings.RigAuto);
                return findings;
            }
        }

        /// <summary>The result that a conversion would bring up to date; null where it would make a new one.</summary>
        internal ResultUpdate Earlier
        {
            get
            {
                if (!earlierKnown) earlier = Converter.Earlier(Avatar, Settings);
                earlierKnown = true;
                return earlier;
            }
        }

        /// <summary>Looks for the earlier result anew.</summary>
        internal void ForgetEarlier()
        {
            earlierKnown = false;
            Touched();
        }

        /// <summary>Why the last conversion failed; null where it did not, and after a change.</summary>
        public Finding Failure => failure;

        /// <summary>Why there is no preview; null where there is one, or none is wanted.</summary>
        public Finding PreviewFailure => previewFailure;

        /// <summary>What the preview measured; null before it has.</summary>
        public PreviewNumbers Numbers => numbers;

        /// <summary>What the last conversion made; null before.</summary>
        public ConversionResult Result => result;

        /// <summary>Whether all is there that a conversion needs.</summary>
        public bool CanConvert
        {
            get
            {
                if (Avatar == null || !HasStyle) return false;
                foreach (Finding finding in Findings)
                {
                    if (finding.Severity == Severity.Error) return false;
                }
                return true;
            }
        }

        /// <summary>Whether the chosen source of the style has been filled in.</summary>
        public bool HasStyle
        {
            get
            {
                switch (Settings.Source)
                {
                    case StyleSource.ReferenceAvatar: return Settings.ReferenceAvatar != null;
                    case StyleSource.SavedStyle: return Settings.SavedStyle != null;
                    default: return true;
                }
            }
        }

        /// <summary>Makes a change that can be undone.</summary>
        /// <param name="key">Key of the words for the Undo menu.</param>
        public void Change(string key, Action change)
        {
            if (Changing != null) Changing(Strings.Get(key));
            change();
            failure = null;
            Touch();
        }

        /// <summary>Takes another avatar, and forgets what was found about the one before.</summary>
        public void SetAvatar(GameObject avatar)
        {
            if (avatar == Avatar) return;
            Change("undo.avatar", () => Avatar = avatar);
            result = null;
            numbers = null;
            previewFailure = null;
            Recheck();
        }

        /// <summary>Looks at the avatar again: it may have changed.</summary>
        public void Recheck()
        {
            findings = null;
            earlierKnown = false;
            Touch();
        }

        /// <summary>Takes what the preview measured; null for none.</summary>
        public void SetNumbers(PreviewNumbers measured)
        {
            numbers = measured;
            sections = null;
        }

        /// <summary>Takes the reason why there is no preview; null for none.</summary>
        public void SetPreviewFailure(Finding reason)
        {
            previewFailure = reason;
            if (reason != null) numbers = null;
            sections = null;
        }

        /// <summary>Takes the reason why a conversion failed; null for none.</summary>
        public void SetFailure(Finding reason)
        {
            failure = reason;
            sections = null;
        }

        /// <summary>Takes what a conversion made.</summary>
        public void SetResult(ConversionResult made)
        {
            result = made;
            failure = null;
            ForgetEarlier();
        }

        /// <summary>The scale of a bone group that the style asks for; 1 before there is a preview.</summary>
        internal float ScaleFound(string group, bool thickness)
        {
            if (numbers != null)
            {
                foreach (Group found in numbers.Groups)
                {
                    if (found.Name == group)
                    {
                        double scale = thickness ? found.ThicknessScale : found.LengthScale;
                        return double.IsNaN(scale) ? 1 : (float)scale;
                    }
                }
            }
            return 1;
        }

        /// <summary>How tall the result is; 1 before there is a preview.</summary>
        internal float HeightFound => numbers == null ? 1 : (float)numbers.Report.Result.Height;

        /// <summary>Asks for the conversion.</summary>
        public void Convert()
        {
            if (CanConvert && Converting != null) Converting();
        }

        /// <summary>Comes when the settings are to be saved as a file.</summary>
        public event Action SavingPreset;

        internal void SavePreset()
        {
            if (SavingPreset != null) SavingPreset();
        }

        /// <summary>Takes the settings of a file; the avatar stays.</summary>
        public void Take(SuperDeformPreset preset)
        {
            Change("undo.preset", () => Settings = preset.Settings.Clone());
            Recheck();
        }

        internal void SaveStyle()
        {
            if (SavingStyle != null) SavingStyle();
        }

        /// <summary>Makes the sections anew, without saying that anything has changed.</summary>
        internal void Touched()
        {
            sections = null;
        }

        /// <summary>Says that something is no longer as it was, for instance after Undo.</summary>
        public void Touch()
        {
            sections = null;
            if (Changed != null) Changed();
        }
    }
}
