using UnityEditor;
using UnityEngine;

namespace SuperDeform.Editor
{
    /// <summary>The Inspector of saved settings: the rows of the window instead of raw numbers, of which NaN is one.</summary>
    [CustomEditor(typeof(SuperDeformPreset))]
    public sealed class SuperDeformPresetEditor : UnityEditor.Editor
    {
        private ConverterModel model;

        private SuperDeformPreset Preset { get { return (SuperDeformPreset)target; } }

        internal ConverterModel Model { get { return model; } }

        private void OnEnable()
        {
            if (target == null)
                return;
            model = new ConverterModel();
            ReadAgain();
            model.Changing += Record;
            model.Changed += Keep;
            Undo.undoRedoPerformed += ReadAgain;
        }

        private void OnDisable()
        {
            Undo.undoRedoPerformed -= ReadAgain;
        }

        private void Record(string name)
        {
            Undo.RecordObject(Preset, name);
        }

        private void Keep()
        {
            Preset.Settings = model.Settings.Clone();
            EditorUtility.SetDirty(Preset);
        }

        private void ReadAgain()
        {
            if (target == null)
                return;
            model.Settings = Preset.Settings.Clone();
            model.Open[(int)SectionId.FineTuning] = true;
            model.Touched();
            Repaint();
        }

        public override void OnInspectorGUI()
        {
            if (model == null)
                return;
            if (GUILayout.Button(Strings.Get("preset.use")))
                ConverterWindow.Open(null).Model.Take(Preset);
            foreach (Section section in model.Sections)
                if (section.Id == SectionId.Style || section.Id == SectionId.FineTuning)
                    RowDrawer.Draw(section, model);
        }
    }
}
