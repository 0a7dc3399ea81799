using System;
using System.Collections;
using System.Reflection;

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
            if (one.RigAuto != other.RigAuto || !Same(one.Options, other.Options, field => field.Name.StartsWith("Rig"))) return SettingsChange.Rig;
            if (one.Source != other.Source || one.ReferenceAvatar != other.ReferenceAvatar
                || one.SavedStyle != other.SavedStyle || one.BuiltInStyle != other.BuiltInStyle
                || one.Heads != other.Heads || one.Blend != other.Blend)
            {
                return SettingsChange.Style;
            }
            return Same(one.Options, other.Options, field => true) ? SettingsChange.None : SettingsChange.Options;
        }

        internal static bool SameOptions(ConversionSettings one, ConversionSettings other) => Same(one.Options, other.Options, field => true);

        /// <summary>Whether two objects have the same in those of their fields that are asked for.</summary>
        static bool Same(object one, object other, Predicate<FieldInfo> asked)
        {
            foreach (FieldInfo field in one.GetType().GetFields(BindingFlags.Instance | BindingFlags.Public))
            {
                if (asked(field) && !Same(field.GetValue(one), field.GetValue(other))) return false;
            }
            return true;
        }

        static bool Same(object one, object other)
        {
            if (one == null || other == null) return one == other;
            IList some = one as IList, others = other as IList;
            if (some != null)
            {
                bool same = some.Count == others.Count;
                for (int i = 0; same && i < some.Count; i++)
                {
                    same = Same(some[i], others[i]);
                }
                return same;
            }
            // NaN, which stands for "as found", equals itself.
            return one is string || one.GetType().IsValueType ? one.Equals(other) : Same(one, other, field => true);
        }
    }
}
