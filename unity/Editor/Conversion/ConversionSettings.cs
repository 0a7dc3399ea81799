using System;
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

        /// <summary>What the library is asked for: head, hair and face, bone groups, and how a rig is made.</summary>
        public Options Options = new Options();

        /// <summary>Makes a rig even where the avatar has one, and takes avatars that are no humanoids.</summary>
        public bool RigAuto;

        /// <summary>
        /// A folder of the project, such as "Assets/Chibi"; empty: the folder of the avatar's own asset, or "Assets".
        /// </summary>
        public string OutputFolder = "";

        /// <summary>Puts an instance of the result beside an avatar that stands in a scene.</summary>
        public bool PlaceInScene = true;

        /// <summary>
        /// Makes another result even where there is one of the same avatar; else that one is brought up to date.
        /// </summary>
        public bool NewCopy;

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
                using (Style stretched = Style.FromHeads(Exact.Of(Heads), source))
                {
                    style = Style.Blend(source, stretched, Exact.Of(Blend));
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
                        return Style.Measure(reference.Character, ReferenceAvatar.name, Options);
                    }
                case StyleSource.SavedStyle:
                    if (SavedStyle == null) throw Missing("no_saved_style");
                    return Style.FromText(SavedStyle.text);
                case StyleSource.BuiltIn:
                    return Style.FromText(BuiltInStyle);
                default:
                    return Style.FromHeads(Exact.Of(Heads));
            }
        }

        static ConversionException Missing(string key) => new ConversionException(new Finding(key, Severity.Error, null));

        /// <summary>A copy that shares nothing with this one but the assets that both name.</summary>
        public ConversionSettings Clone()
        {
            ConversionSettings copy = (ConversionSettings)MemberwiseClone();
            copy.Options = Options.Clone();
            return copy;
        }
    }
}
