using System;

namespace SuperDeform.Editor
{
    /// <summary>A bone group that product mode can tune.</summary>
    public sealed class TunableGroup
    {
        /// <summary>As in GroupSettings.Group.</summary>
        public string Name;
        /// <summary>It has one size: its length and its thickness are the same.</summary>
        public bool IsSize;
        /// <summary>Its length is a distance from the middle of the body, and its thickness the torso's.</summary>
        public bool IsSpread;
    }

    /// <summary>Fine tuning by bone group: reading and writing it in settings.</summary>
    public static class GroupTunings
    {
        /// <summary>The groups, from top to bottom. Fingers go with the hand.</summary>
        public static readonly TunableGroup[] Groups =
        {
            new TunableGroup { Name = "head" },
            new TunableGroup { Name = "neck" },
            new TunableGroup { Name = "torso" },
            new TunableGroup { Name = "shoulder", IsSpread = true },
            new TunableGroup { Name = "upper_arm" },
            new TunableGroup { Name = "lower_arm" },
            new TunableGroup { Name = "hand", IsSize = true },
            new TunableGroup { Name = "hip", IsSpread = true },
            new TunableGroup { Name = "upper_leg" },
            new TunableGroup { Name = "lower_leg" },
            new TunableGroup { Name = "foot", IsSize = true }
        };

        /// <summary>A person's own settings of a group, to be read; all NaN where there are none.</summary>
        public static GroupSettings Of(ConversionSettings settings, string group) => Find(settings, group) ?? new GroupSettings { Group = group };

        /// <summary>Changes a person's own settings of a group; those that set nothing go.</summary>
        public static void Change(ConversionSettings settings, string group, Action<GroupSettings> change)
        {
            GroupSettings own = Find(settings, group);
            if (own == null)
            {
                own = new GroupSettings { Group = group };
                settings.Options.Groups.Add(own);
            }
            change(own);
            settings.Options.Groups.RemoveAll(tuned => tuned.IsEmpty);
        }

        /// <summary>Takes all tuning away.</summary>
        public static void Clear(ConversionSettings settings)
        {
            settings.Options.Groups.Clear();
        }

        /// <summary>How many groups are tuned.</summary>
        public static int Count(ConversionSettings settings) => settings.Options.Groups.FindAll(tuned => !tuned.IsEmpty).Count;

        static GroupSettings Find(ConversionSettings settings, string group) => settings.Options.Groups.Find(tuned => tuned.Group == group);
    }
}
