using System;
using UnityEditor;
using UnityEngine;

namespace SuperDeform.Editor
{
    /// <summary>Tools > Super Deform > Converter...: draws the sections of a ConverterModel and passes on what is pressed.</summary>
    public sealed class ConverterWindow : EditorWindow
    {
        [SerializeField] ConverterModel model = new ConverterModel();
        [SerializeField] Vector2 scroll;
        // A window that a layout restores goes on with what it shows.
        [SerializeField] bool opened;
        // Unity would keep private fields when scripts reload, and make an empty object of none.
        [NonSerialized] ConverterController controller;
        [NonSerialized] ConverterModel connected;
        static ConverterWindow open;

        /// <summary>Shows the window.</summary>
        /// <param name="avatar">What to convert; null, or an object that is no humanoid: as before.</param>
        public static ConverterWindow Open(GameObject avatar)
        {
            ConverterWindow window = GetWindow<ConverterWindow>();
            window.Show();
            if (MenuItems.IsHumanoid(avatar)) window.model.SetAvatar(avatar);
            return window;
        }

        /// <summary>The settings of the open window, else those that it was closed with: what commands without a window work by.</summary>
        public static ConversionSettings LastSettings() => open == null ? SuperDeform.Editor.LastSettings.Read() : open.model.Settings.Clone();

        public ConverterModel Model => model;

        /// <summary>What happens behind the window; null while it is closed.</summary>
        public ConverterController Controller => controller;

        void OnEnable()
        {
            open = this;
            if (!opened) model.Settings = SuperDeform.Editor.LastSettings.Read();
            opened = true;
            titleContent = WindowTitle.Of("window.title");
            minSize = new Vector2(360, 300);
            Connect();
            EditorApplication.update += Tick;
            Undo.undoRedoPerformed += AfterUndo;
            // Native objects outlive the scripts that made them.
            AssemblyReloadEvents.beforeAssemblyReload += Disconnect;
            EditorApplication.playModeStateChanged += FollowPlayMode;
        }

        void OnDisable()
        {
            EditorApplication.update -= Tick;
            Undo.undoRedoPerformed -= AfterUndo;
            AssemblyReloadEvents.beforeAssemblyReload -= Disconnect;
            EditorApplication.playModeStateChanged -= FollowPlayMode;
            Disconnect();
            if (open == this) open = null;
        }

        void Connect()
        {
            Disconnect();
            // The preview belongs to the scene that is edited; FollowPlayMode comes back when that is.
            if (EditorApplication.isPlayingOrWillChangePlaymode) return;
            connected = model;
            connected.Changing += RecordUndo;
            connected.Converting += ConvertSoon;
            connected.SavingStyle += SaveStyleSoon;
            connected.SavingPreset += SavePresetSoon;
            controller = new ConverterController(connected);
        }

        void Disconnect()
        {
            if (connected == null) return;
            SuperDeform.Editor.LastSettings.Write(connected.Settings);
            connected.Changing -= RecordUndo;
            connected.Converting -= ConvertSoon;
            connected.SavingStyle -= SaveStyleSoon;
            connected.SavingPreset -= SavePresetSoon;
            controller.Dispose();
            controller = null;
            connected = null;
        }

        void AfterUndo()
        {
            // Undo may put another object in the place of one that it restores.
            if (connected != null && connected != model) Connect();
            model.Recheck();
            Repaint();
        }

        void FollowPlayMode(PlayModeStateChange change)
        {
            if (change == PlayModeStateChange.ExitingEditMode) Disconnect();
            else if (change == PlayModeStateChange.EnteredEditMode) Connect();
        }

        void OnBecameVisible()
        {
            if (controller != null) controller.Resting = false;
        }

        // Another tab lies over it, or it is closed.
        void OnBecameInvisible()
        {
            if (controller != null) controller.Resting = true;
        }

        void OnFocus()
        {
            // An import setting may have been mended elsewhere.
            model.Recheck();
        }

        void Tick()
        {
            if (controller == null || !controller.Tick(EditorApplication.timeSinceStartup)) return;
            Repaint();
            SceneView.RepaintAll();
        }

        void RecordUndo(string name)
        {
            Undo.RecordObject(this, name);
        }

        // Dialogs and progress bars end the drawing of a window that they are called from: later, then.
        void ConvertSoon()
        {
            EditorApplication.delayCall += Convert;
        }

        void SaveStyleSoon()
        {
            EditorApplication.delayCall += SaveStyle;
        }

        void SavePresetSoon()
        {
            EditorApplication.delayCall += SavePreset;
        }

        void SavePreset()
        {
            string path = EditorUtility.SaveFilePanelInProject(Strings.Get("style.keep.title"), "chibi", "asset", "");
            if (!string.IsNullOrEmpty(path) && controller != null) controller.SavePreset(path);
            Repaint();
        }

        void Convert()
        {
            if (controller == null || model.Avatar == null) return;
            SuperDeform.Editor.LastSettings.Write(model.Settings);
            using (var progress = new EditorProgress(model.Avatar.name))
            {
                if (controller.Convert(progress)) EditorGUIUtility.PingObject(model.Result.Prefab);
            }
            Repaint();
        }

        void SaveStyle()
        {
            string path = EditorUtility.SaveFilePanelInProject(Strings.Get("style.save.title"), "chibi", "json", "");
            if (!string.IsNullOrEmpty(path) && controller != null) controller.SaveStyle(path);
            Repaint();
        }

        void OnGUI()
        {
            DrawLanguage();
            if (connected == null) EditorGUILayout.HelpBox(Strings.Get("window.rests"), MessageType.Info);
            EditorGUI.BeginDisabledGroup(connected == null);
            scroll = EditorGUILayout.BeginScrollView(scroll);
            // A press makes new sections; this pass ends with the old ones, as IMGUI wants.
            foreach (Section section in model.Sections)
            {
                DrawSection(section);
            }
            EditorGUILayout.EndScrollView();
            EditorGUI.EndDisabledGroup();
        }

        void DrawSection(Section section)
        {
            string title = section.Open || section.Summary.Length == 0
                ? section.Title : section.Title + "    " + section.Summary;
            bool now = EditorGUILayout.BeginFoldoutHeaderGroup(section.Open, title);
            if (now != section.Open) section.Open = model.Open[(int)section.Id] = now;
            if (section.Open)
            {
                EditorGUI.indentLevel++;
                foreach (Row row in section.Rows)
                {
                    RowDrawer.Draw(row);
                }
                EditorGUI.indentLevel--;
                EditorGUILayout.Space();
            }
            EditorGUILayout.EndFoldoutHeaderGroup();
        }

        void DrawLanguage()
        {
            int now = Strings.Languages.IndexOf(Strings.Language);
            EditorGUILayout.BeginHorizontal();
            GUILayout.FlexibleSpace();
            int chosen = GUILayout.Toolbar(now, Strings.LanguageNames);
            EditorGUILayout.EndHorizontal();
            if (chosen != now) Strings.Language = Strings.Languages[chosen];
        }
    }
}
