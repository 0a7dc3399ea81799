namespace SuperDeform.Editor
{
    /// <summary>One progress over all stages of a conversion.</summary>
    internal sealed class StageProgress
    {
        static readonly string[] Stages =
        {
            ConversionStage.Reading, ConversionStage.Rigging, ConversionStage.Measuring, ConversionStage.Deforming,
            ConversionStage.Reporting, ConversionStage.Writing, ConversionStage.Saving
        };

        /// <summary>Where each stage begins; the last ends at 1.</summary>
        static readonly float[] Begins = { 0f, 0.1f, 0.35f, 0.45f, 0.75f, 0.85f, 0.95f, 1f };

        readonly IConversionProgress progress;

        /// <param name="progress">Null for none.</param>
        internal StageProgress(IConversionProgress progress)
        {
            this.progress = progress;
        }

        /// <summary>Begins a stage; throws where the person has cancelled.</summary>
        internal void Begin(string stage)
        {
            if (!Report(stage, 0f)) throw new ConversionException(new Finding("cancelled", Severity.Info, null));
        }

        /// <summary>The end of everything; nothing can be cancelled any more.</summary>
        internal void End()
        {
            if (progress != null) progress.Report(ConversionStage.Saving, 1f);
        }

        /// <summary>A handler for what the library does within a stage.</summary>
        internal ProgressHandler Within(string stage) => Part(stage, 0f, 1f);

        /// <summary>The same for a part of a stage.</summary>
        internal ProgressHandler Part(string stage, float from, float to) => fraction => Report(stage, from + (to - from) * fraction);

        bool Report(string stage, float fraction)
        {
            if (progress == null) return true;
            int index = System.Array.IndexOf(Stages, stage);
            return progress.Report(stage, Begins[index] + (Begins[index + 1] - Begins[index]) * fraction);
        }
    }
}
