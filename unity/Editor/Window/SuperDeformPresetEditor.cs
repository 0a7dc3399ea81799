using UnityEditor;
using UnityEngine;

namespace SuperDeform.Editor
{
    /// <summary>The Inspector of saved settings: the rows of the window instead of raw numbers, of which NaN is one.</summary>
    [CustomEditor(typeof(SuperDeformPreset))]
    public sealed class SuperDeformPresetEditor : UnityEditor.Editor
    {
        ConverterModel model;

        SuperDeformPreset Preset => (SuperDeformPreset)target;

        internal ConverterModel Model => model;

        void OnEnable()
        {
            if (target == null) return;
            model = new ConverterModel();
            ReadAgain();
            model.Changing += Record;
            model.Changed += Keep;
            Undo.undoRedoPerformed += ReadAgain;
        }

        void OnDisable()
        {
            Undo.undoRedoPerformed -= ReadAgain;
        }

        void Record(string name)
        {
            Undo.RecordObject(Preset, name);
        }

        void Keep()
        {
            Preset.Settings = model.Settings.Clone();
            EditorUtility.SetDirty(Preset);
        }

        void ReadAgain()
        {
            if (target == null) return;
            model.Settings = Preset.Settings.Clone();
            model.Open[(int)SectionId.FineTuning] = true;
            model.Touched();
            Repaint();
        }

        public override void OnInspectorGUI()
        {
            if (model == null) return;
            if (GUILayout.Button(Strings.Get("preset.use"))) ConverterWindow.Open(null).Model.Take(Preset);
            foreach (Section section in model.Sections)
            {
                if (section.Id == SectionId.Style || section.Id == SectionId.FineTuning) RowDrawer.Draw(section, model);
            }
        }
    }
}
