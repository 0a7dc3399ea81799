namespace SuperDeform.Editor
{
    /// <summary>What a conversion tells while it runs; called on the caller's thread.</summary>
    public interface IConversionProgress
    {
        /// <summary>What part of the work is done.</summary>
        /// <param name="stageKey">The key of the stage's name, one of ConversionStage.</param>
        /// <param name="fraction">Of the whole conversion, 0 to 1, never falling.</param>
        /// <returns>True to go on, false to cancel.</returns>
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
