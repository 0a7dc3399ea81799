using System.Collections.Generic;

namespace SuperDeform.Editor
{
    /// <summary>How much of a preview a change of settings makes old.</summary>
    internal enum SettingsChange
    {
        /// <summary>Nothing.</summary>
        None,
        /// <summary>What the library's options say.</summary>
        Options,
        /// <summary>The style, and all that follows from it.</summary>
        Style,
        /// <summary>The rig, and all that follows from it.</summary>
        Rig
    }

    internal static class SettingsChanges
    {
        internal static SettingsChange Between(ConversionSettings one, ConversionSettings other)
        {
            if (one.RigAuto != other.RigAuto)
                return SettingsChange.Rig;
            if (one.Source != other.Source || one.ReferenceAvatar != other.ReferenceAvatar
                || one.SavedStyle != other.SavedStyle || one.BuiltInStyle != other.BuiltInStyle
                || one.Heads != other.Heads || one.Blend != other.Blend)
                return SettingsChange.Style;
            return one.Amount == other.Amount && one.HairLength == other.HairLength && one.HeadScale == other.HeadScale
                && Same(one.FaceSquash, other.FaceSquash) && one.FaceCurve == other.FaceCurve
                && Same(one.Groups, other.Groups)
                ? SettingsChange.None : SettingsChange.Options;
        }

        private static bool Same(List<GroupTuning> one, List<GroupTuning> other)
        {
            if (one.Count != other.Count)
                return false;
            for (int i = 0; i < one.Count; i++)
                if (one[i].Group != other[i].Group || !Same(one[i].LengthScale, other[i].LengthScale)
                    || !Same(one[i].ThicknessScale, other[i].ThicknessScale)
                    || !Same(one[i].LengthTransfer, other[i].LengthTransfer)
                    || !Same(one[i].ThicknessTransfer, other[i].ThicknessTransfer))
                    return false;
            return true;
        }

        // NaN, which stands for "as found", equals itself.
        private static bool Same(float one, float other)
        {
            return one.Equals(other);
        }
    }
}
