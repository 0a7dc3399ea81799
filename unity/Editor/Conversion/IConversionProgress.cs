namespace SuperDeform.Editor
{
    /// <summary>What a conversion tells while it runs; called on the caller's thread.</summary>
    public interface IConversionProgress
    {
        /// <summary>
        /// stageKey: the key of the stage's name, one of ConversionStage
        /// fraction: of the whole conversion, 0 to 1, never falling
        /// Gives true to go on, false to cancel.
        /// </summary>
        bool Report(string stageKey, float fraction);
    }

    /// <summary>The keys of the stages, in their order.</summary>
    public static class ConversionStage
    {
        public const string Reading = "stage_reading";
        public const string Rigging = "stage_rigging";
        public const string Measuring = "stage_measuring";
        public const string Deforming = "stage_deforming";
        public const string Reporting = "stage_reporting";
        public const string Writing = "stage_writing";
        public const string Saving = "stage_saving";
    }
}
