using System;
using System.Collections.Generic;
using UnityEngine;

namespace SuperDeform.Editor
{
    /// <summary>Where the style comes from.</summary>
    public enum StyleSource
    {
        /// <summary>So many heads; everything else after the avatar itself.</summary>
        Heads,

        /// <summary>Another avatar, which is measured.</summary>
        ReferenceAvatar,

        /// <summary>A saved style: the JSON text that Style.ToJson gave.</summary>
        SavedStyle,

        /// <summary>A built-in style, by name.</summary>
        BuiltIn
    }

    /// <summary>Fine tuning of one bone group, left and right together. NaN leaves the measured value.</summary>
    [Serializable]
    public sealed class GroupTuning
    {
        /// <summary>
        /// head, neck, torso, shoulder, upper_arm, lower_arm, hand, finger, hip, upper_leg, lower_leg or foot.
        /// </summary>
        public string Group;

        /// <summary>1 keeps the length, 0.5 halves it; 0.01 to 100.</summary>
        public float LengthScale = float.NaN;

        /// <summary>1 keeps the girth; 0.01 to 100.</summary>
        public float ThicknessScale = float.NaN;

        /// <summary>0 keeps the avatar's length, 1 takes all of the style's; -10 to 10.</summary>
        public float LengthTransfer = float.NaN;

        /// <summary>0 keeps the avatar's girth, 1 takes all of the style's; -10 to 10.</summary>
        public float ThicknessTransfer = float.NaN;
    }

    /// <summary>Everything that can be set for a conversion; the window, batches and the preview share it.</summary>
    [Serializable]
    public sealed class ConversionSettings
    {
        public StyleSource Source = StyleSource.Heads;

        /// <summary>The avatar to be like; for StyleSource.ReferenceAvatar.</summary>
        public GameObject ReferenceAvatar;

        /// <summary>The style's JSON text; for StyleSource.SavedStyle.</summary>
        public TextAsset SavedStyle;

        /// <summary>"sd2", "sd2.5", "sd3" or "sd4"; for StyleSource.BuiltIn.</summary>
        public string BuiltInStyle = "sd2.5";

        /// <summary>How many heads tall, 1.8 to 6; for StyleSource.Heads, and what Blend goes to.</summary>
        public float Heads = 2.5f;

        /// <summary>
        /// From the source's style (0) to the same style stretched or shortened to Heads (1); not for StyleSource.Heads.
        /// </summary>
        public float Blend;

        /// <summary>Fine tuning; groups that are missing keep what was measured.</summary>
        public List<GroupTuning> Groups = new List<GroupTuning>();

        /// <summary>How much younger the face gets, -10 to 10; 0 leaves it, NaN is the library's choice.</summary>
        public float FaceSquash = float.NaN;

        public FaceCurve FaceCurve = FaceCurve.F4;

        /// <summary>0 gives the avatar back as it is, 1 the style.</summary>
        public float Amount = 1f;

        /// <summary>Hair below the chin: 1 ends where it ended on the body, 0 at the chin.</summary>
        public float HairLength = 1f;

        /// <summary>Size of the head against what the style says, 0.1 to 10.</summary>
        public float HeadScale = 1.5f;

        /// <summary>Makes a rig even where the avatar has one, and takes avatars that are no humanoids.</summary>
        public bool RigAuto;

        /// <summary>
        /// A folder of the project, such as "Assets/Chibi"; empty: the folder of the avatar's own asset, or "Assets".
        /// </summary>
        public string OutputFolder = "";

        /// <summary>Puts an instance of the result beside an avatar that stands in a scene.</summary>
        public bool PlaceInScene = true;

        /// <summary>
        /// The style that these settings describe; the caller disposes it.
        ///
        /// Measures the reference avatar where that is the source. Throws ConversionException.
        /// </summary>
        public Style MakeStyle()
        {
            Style style = null;
            try
            {
                style = SourceStyle();
                if (Source == StyleSource.Heads || Blend == 0f) return style;
                using (Style source = style)
                using (Style stretched = Style.FromHeads(Heads, source))
                {
                    style = Style.Blend(source, stretched, Blend);
                }
                return style;
            }
            catch (Exception cause)
            {
                if (style != null) style.Dispose();
                throw ConversionException.From(cause, ReferenceAvatar);
            }
        }

        Style SourceStyle()
        {
            switch (Source)
            {
                case StyleSource.ReferenceAvatar:
                    if (ReferenceAvatar == null) throw Missing("no_reference");
                    using (AvatarData reference = CharacterReader.Read(ReferenceAvatar, new ReadOptions()))
                    {
                        return Style.Measure(reference.Character, ReferenceAvatar.name, MakeOptions());
                    }
                case StyleSource.SavedStyle:
                    if (SavedStyle == null) throw Missing("no_saved_style");
                    return Style.FromText(SavedStyle.text);
                case StyleSource.BuiltIn:
                    return Style.FromText(BuiltInStyle);
                default:
                    return Style.FromHeads(Heads);
            }
        }

        static ConversionException Missing(string key)
        {
            return new ConversionException(new Finding(key, Severity.Error, null));
        }

        /// <summary>The library's options that these settings describe.</summary>
        public Options MakeOptions()
        {
            Options options = new Options
            {
                HeadScale = HeadScale,
                Amount = Amount,
                HairLength = HairLength,
                FaceSquash = FaceSquash,
                FaceCurve = FaceCurve
            };
            foreach (GroupTuning tuning in Groups)
            {
                options.Groups.Add(new GroupSettings
                {
                    Group = tuning.Group,
                    LengthScale = tuning.LengthScale,
                    ThicknessScale = tuning.ThicknessScale,
                    LengthTransfer = tuning.LengthTransfer,
                    ThicknessTransfer = tuning.ThicknessTransfer
                });
            }
            return options;
        }

        /// <summary>A copy that shares nothing with this one but the assets that both name.</summary>
        public ConversionSettings Clone()
        {
            ConversionSettings copy = (ConversionSettings)MemberwiseClone();
            copy.Groups = new List<GroupTuning>();
            foreach (GroupTuning tuning in Groups)
            {
                copy.Groups.Add(new GroupTuning
                {
                    Group = tuning.Group,
                    LengthScale = tuning.LengthScale,
                    ThicknessScale = tuning.ThicknessScale,
                    LengthTransfer = tuning.LengthTransfer,
                    ThicknessTransfer = tuning.ThicknessTransfer
                });
            }
            return copy;
        }
    }
}
