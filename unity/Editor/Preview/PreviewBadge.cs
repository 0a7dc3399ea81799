using UnityEditor;
using UnityEngine;

namespace SuperDeform.Editor
{
    /// <summary>What says in the Scene view that an avatar is shown as it will be, not as it is.</summary>
    internal static class PreviewBadge
    {
        /// <param name="before">The avatar as it is stands there for comparison.</param>
        internal static void Draw(SceneView view, PreviewSession preview)
        {
            Handles.BeginGUI();
            GUI.Box(new Rect(8, 8, 216, 24), GUIContent.none);
            GUI.Label(new Rect(14, 11, 140, 18), Strings.Get(preview.ShowBefore ? "badge.before" : "badge.after"));
            bool frame = GUI.Button(new Rect(154, 10, 66, 20), new GUIContent(Strings.Get("badge.frame"), Strings.Get("badge.frame.tooltip")));
            Handles.EndGUI();
            if (frame)
                view.Frame(preview.Bounds, false);
        }
    }
}
