using UnityEditor;
using UnityEngine;

namespace SuperDeform.Editor
{
    /// <summary>
    /// The Inspector of a Super Deform Avatar: style and fine tuning as in the window, a preview while it is looked at, and a
    /// button that makes a prefab. The avatar changes at build time alone.
    /// </summary>
    [CustomEditor(typeof(SuperDeformAvatar))]
    public sealed class SuperDeformAvatarEditor : UnityEditor.Editor
    {
        /// <summary>Whether NDMF is in the project, which runs the component in a build.</summary>
        internal static bool HasNdmf
        {
#if SUPERDEFORM_NDMF
            get { return true; }
#else
            get { return false; }
#endif
        }

        ConverterModel model;
        ConverterController controller;

        SuperDeformAvatar Component => (SuperDeformAvatar)target;

        internal ConverterModel Model => model;

        internal ConverterController Controller => controller;

        void OnEnable()
        {
            if (target == null || EditorApplication.isPlayingOrWillChangePlaymode) return;
            model = new ConverterModel { Avatar = Component.gameObject, Settings = SettingsText.Of(Component), PreviewOn = false };
            model.Changing += Record;
            model.Changed += Keep;
            controller = new ConverterController(model);
            EditorApplication.update += Tick;
            Undo.undoRedoPerformed += ReadAgain;
            AssemblyReloadEvents.beforeAssemblyReload += OnDisable;
        }

        void OnDisable()
        {
            if (controller == null) return;
            EditorApplication.update -= Tick;
            Undo.undoRedoPerformed -= ReadAgain;
            AssemblyReloadEvents.beforeAssemblyReload -= OnDisable;
            controller.Dispose();
            controller = null;
            model = null;
        }

        void Record(string name)
        {
            Undo.RecordObject(Component, name);
        }

        void Keep()
        {
            if (SettingsText.Write(SettingsText.Of(Component)) == SettingsText.Write(model.Settings)
                && Component.ReferenceAvatar == model.Settings.ReferenceAvatar && Component.SavedStyle == model.Settings.SavedStyle)
            {
                return;
            }
            SettingsText.Give(Component, model.Settings);
            EditorUtility.SetDirty(Component);
        }

        void ReadAgain()
        {
            if (target == null || model == null) return;
            model.Settings = SettingsText.Of(Component);
            model.Recheck();
            Repaint();
        }

        void Tick()
        {
            if (controller == null || !controller.Tick(EditorApplication.timeSinceStartup)) return;
            Repaint();
            SceneView.RepaintAll();
        }

        public override void OnInspectorGUI()
        {
            if (model == null) return;
            EditorGUILayout.HelpBox(Strings.Get(HasNdmf ? "component.built" : "component.no_ndmf"), MessageType.Info);
            foreach (Finding finding in model.Findings)
            {
                RowDrawer.Draw(ConverterSections.Check(model, finding));
            }
            foreach (Section section in model.Sections)
            {
                if (section.Id == SectionId.Style || section.Id == SectionId.FineTuning || section.Id == SectionId.Preview)
                {
                    RowDrawer.Draw(section, model);
                }
            }
            if (model.Failure != null) RowDrawer.Draw(ConverterSections.Check(model, model.Failure));
            if (model.Earlier != null) RowDrawer.Draw(ConverterSections.Replaces(model.Earlier));
            EditorGUI.BeginDisabledGroup(!model.CanConvert);
            if (GUILayout.Button(new GUIContent(Strings.Get("component.convert"), Strings.Get("report.convert.tooltip")), GUILayout.Height(32)))
            {
                EditorApplication.delayCall += Convert;
            }
            EditorGUI.EndDisabledGroup();
        }

        void Convert()
        {
            if (controller == null) return;
            using (var progress = new EditorProgress(Component.name))
            {
                if (controller.Convert(progress)) EditorGUIUtility.PingObject(model.Result.Prefab);
            }
            Repaint();
        }
    }
}
