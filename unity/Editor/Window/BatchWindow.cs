using System.Collections.Generic;
using UnityEditor;
using UnityEngine;

namespace SuperDeform.Editor
{
    /// <summary>Tools > Super Deform > Batch...: a list of avatars, and a button that converts them all.</summary>
    public sealed class BatchWindow : EditorWindow
    {
        [SerializeField] List<GameObject> avatars = new List<GameObject>();
        [SerializeField] List<string> lines = new List<string>();
        [SerializeField] Vector2 scroll;

        public static BatchWindow Open()
        {
            BatchWindow window = GetWindow<BatchWindow>();
            window.Show();
            return window;
        }

        /// <summary>What will be converted.</summary>
        public IList<GameObject> Avatars => avatars;

        /// <summary>What the last batch said.</summary>
        public IList<string> Lines => lines;

        /// <summary>Adds avatars that are not yet in the list: objects that show anything.</summary>
        public void Add(IEnumerable<GameObject> candidates)
        {
            Undo.RecordObject(this, Strings.Get("undo.batch"));
            foreach (GameObject candidate in candidates)
            {
                if (candidate != null && candidate.GetComponentInChildren<Renderer>(true) != null && !avatars.Contains(candidate))
                {
                    avatars.Add(candidate);
                }
            }
        }

        /// <summary>Draws an avatar of the list; false where it is to go.</summary>
        static bool Listed(GameObject avatar)
        {
            EditorGUILayout.BeginHorizontal();
            EditorGUILayout.LabelField(avatar == null ? "-" : avatar.name);
            bool goes = GUILayout.Button(new GUIContent("\u00d7", Strings.Get("batch.remove")), GUILayout.Width(24));
            EditorGUILayout.EndHorizontal();
            return !goes;
        }

        /// <summary>Avatars that are dropped anywhere on the window join the list.</summary>
        void AcceptDrops()
        {
            EventType now = Event.current == null ? EventType.Ignore : Event.current.type;
            if (now != EventType.DragUpdated && now != EventType.DragPerform) return;
            var dropped = new List<GameObject>();
            foreach (Object one in DragAndDrop.objectReferences)
            {
                if (one is GameObject) dropped.Add((GameObject)one);
            }
            if (dropped.Count == 0) return;
            DragAndDrop.visualMode = DragAndDropVisualMode.Copy;
            if (now == EventType.DragPerform)
            {
                DragAndDrop.AcceptDrag();
                Add(dropped);
            }
            Event.current.Use();
        }

        /// <summary>Converts all, with the settings of the converter window.</summary>
        public BatchReport Convert()
        {
            BatchReport report;
            using (var progress = new EditorProgress(Strings.Get("batch.avatars")))
            {
                report = BatchConvert.Convert(avatars, ConverterWindow.LastSettings(), progress);
            }
            lines = report.Lines();
            Repaint();
            return report;
        }

        void OnEnable()
        {
            titleContent = WindowTitle.Of("batch.title");
            minSize = new Vector2(360, 240);
        }

        void OnGUI()
        {
            scroll = EditorGUILayout.BeginScrollView(scroll);
            EditorGUILayout.LabelField(Strings.Get("batch.avatars"), EditorStyles.boldLabel);
            if (avatars.Count == 0) EditorGUILayout.LabelField(Strings.Get("batch.empty"), EditorStyles.wordWrappedLabel);
            for (int i = 0; i < avatars.Count; i++)
            {
                if (!Listed(avatars[i]))
                {
                    Undo.RecordObject(this, Strings.Get("undo.batch"));
                    avatars.RemoveAt(i--);
                }
            }
            AcceptDrops();
            EditorGUILayout.BeginHorizontal();
            if (GUILayout.Button(Strings.Get("batch.add"))) Add(Selection.gameObjects);
            if (GUILayout.Button(Strings.Get("batch.clear")))
            {
                Undo.RecordObject(this, Strings.Get("undo.batch"));
                avatars.Clear();
                lines.Clear();
            }
            EditorGUILayout.EndHorizontal();
            EditorGUILayout.Space();
            EditorGUILayout.LabelField(Strings.Get("batch.settings"), EditorStyles.wordWrappedLabel);
            if (GUILayout.Button(Strings.Get("batch.settings.open"))) MenuItems.OpenConverter();
            EditorGUI.BeginDisabledGroup(avatars.Count == 0);
            if (GUILayout.Button(Strings.Get("batch.convert", avatars.Count), GUILayout.Height(32))) EditorApplication.delayCall += () => Convert();
            EditorGUI.EndDisabledGroup();
            foreach (string line in lines)
            {
                EditorGUILayout.LabelField(line, EditorStyles.wordWrappedLabel);
            }
            EditorGUILayout.EndScrollView();
        }
    }
}
