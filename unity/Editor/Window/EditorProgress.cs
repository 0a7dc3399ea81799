using System;
using UnityEditor;
using UnityEngine;

namespace SuperDeform.Editor
{
    /// <summary>A progress bar of the editor, mostly with a button to cancel; none in batch mode. Dispose takes it away.</summary>
    internal sealed class EditorProgress : IConversionProgress, IDisposable
    {
        readonly string title;
        readonly double from;
        readonly bool cancelable;
        bool shown;

        /// <param name="patience">Seconds without a bar: what takes less shows none.</param>
        /// <param name="cancelable">False where there is no way but on, as in a build.</param>
        internal EditorProgress(string name, double patience = 0, bool cancelable = true)
        {
            this.cancelable = cancelable;
            title = Strings.Get("progress.title", name);
            from = EditorApplication.timeSinceStartup + patience;
        }

        public bool Report(string stageKey, float fraction)
        {
            if (Application.isBatchMode || EditorApplication.timeSinceStartup < from) return true;
            shown = true;
            if (cancelable) return !EditorUtility.DisplayCancelableProgressBar(title, Strings.Get(stageKey), fraction);
            EditorUtility.DisplayProgressBar(title, Strings.Get(stageKey), fraction);
            return true;
        }

        public void Dispose()
        {
            if (shown) EditorUtility.ClearProgressBar();
            shown = false;
        }
    }
}
