namespace SuperDeform.Editor
{
    /// <summary>A bone group that product mode can tune.</summary>
    public sealed class TunableGroup
    {
        /// <summary>As in GroupTuning.Group.</summary>
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

        /// <summary>A person's own scale of a group; NaN where there is none.</summary>
        public static float Get(ConversionSettings settings, string group, bool thickness)
        {
            GroupTuning tuning = Find(settings, group);
            return tuning == null ? float.NaN : thickness ? tuning.ThicknessScale : tuning.LengthScale;
        }

        /// <summary>Sets a person's own scale of a group; NaN takes it away.</summary>
        public static void Set(ConversionSettings settings, string group, bool thickness, float scale)
        {
            GroupTuning tuning = Find(settings, group);
            if (tuning == null)
            {
                tuning = new GroupTuning { Group = group };
                settings.Groups.Add(tuning);
            }
            if (thickness)
                tuning.ThicknessScale = scale;
            else
                tuning.LengthScale = scale;
            settings.Groups.RemoveAll(IsEmpty);
        }

        /// <summary>Takes all tuning away.</summary>
        public static void Clear(ConversionSettings settings)
        {
            settings.Groups.Clear();
        }

        /// <summary>How many groups are tuned.</summary>
        public static int Count(ConversionSettings settings)
        {
            return settings.Groups.FindAll(tuning => !IsEmpty(tuning)).Count;
        }

        private static GroupTuning Find(ConversionSettings settings, string group)
        {
            return settings.Groups.Find(tuning => tuning.Group == group);
        }

        private static bool IsEmpty(GroupTuning tuning)
        {
            return float.IsNaN(tuning.LengthScale) && float.IsNaN(tuning.ThicknessScale)
                && float.IsNaN(tuning.LengthTransfer) && float.IsNaN(tuning.ThicknessTransfer);
        }
    }
}
