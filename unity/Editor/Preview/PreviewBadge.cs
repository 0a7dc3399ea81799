using UnityEditor;
using UnityEngine;

namespace SuperDeform.Editor
{
    /// <summary>What says in the Scene view that an avatar is shown as it will be, not as it is.</summary>
    internal static class PreviewBadge
    {
        const float Width = 216;

        /// <param name="before">The avatar as it is stands there for comparison.</param>
        internal static void Draw(SceneView view, PreviewSession preview)
        {
            // In the middle: tools lie in the corners.
            float left = Mathf.Max(0, 0.5f * (view.position.width - Width));
            Handles.BeginGUI();
            GUI.Box(new Rect(left, 8, Width, 24), GUIContent.none);
            GUI.Label(new Rect(left + 6, 11, 140, 18), Strings.Get(preview.ShowBefore ? "badge.before" : "badge.after"));
            bool frame = GUI.Button(new Rect(left + 146, 10, 66, 20), new GUIContent(Strings.Get("badge.frame"), Strings.Get("badge.frame.tooltip")));
            Handles.EndGUI();
            if (frame) view.Frame(preview.Bounds, false);
        }
    }
}
