using System;
using UnityEditor;
using UnityEngine;

namespace SuperDeform.Editor
{
    /// <summary>A progress bar of the editor with a button to cancel; none in batch mode. Dispose takes it away.</summary>
    internal sealed class EditorProgress : IConversionProgress, IDisposable
    {
        private readonly string title;
        private bool shown;

        internal EditorProgress(string name)
        {
            title = Strings.Get("progress.title", name);
        }

        public bool Report(string stageKey, float fraction)
        {
            if (Application.isBatchMode)
                return true;
            shown = true;
            return !EditorUtility.DisplayCancelableProgressBar(title, Strings.Get(stageKey), fraction);
        }

        public void Dispose()
        {
            if (shown)
                EditorUtility.ClearProgressBar();
            shown = false;
        }
    }
}
