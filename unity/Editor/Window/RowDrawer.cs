using System;
using UnityEditor;
using UnityEngine;

namespace SuperDeform.Editor
{
    /// <summary>Draws rows with IMGUI.</summary>
    internal static class RowDrawer
    {
        const float GroupLabel = 116;
        const float ButtonWidth = 64;
        const float ResetWidth = 24;

        /// <summary>A section with a title that folds it, for an Inspector.</summary>
        internal static void Draw(Section section, ConverterModel model)
        {
            bool open = EditorGUILayout.Foldout(section.Open, section.Title, true);
            if (open != section.Open) section.Open = model.Open[(int)section.Id] = open;
            if (!open) return;
            EditorGUI.indentLevel++;
            foreach (Row row in section.Rows)
            {
                Draw(row);
            }
            EditorGUI.indentLevel--;
        }

        internal static void Draw(Row row)
        {
            EditorGUI.BeginDisabledGroup(!row.Enabled);
            EditorGUI.indentLevel += row.Indent;
            var label = new GUIContent(row.Label, row.Tooltip);
            if (row is TextRow) EditorGUILayout.LabelField(label, ((TextRow)row).Strong ? EditorStyles.boldLabel : EditorStyles.wordWrappedLabel);
            else if (row is CheckRow) Check((CheckRow)row);
            else if (row is ObjectRow) Object((ObjectRow)row, label);
            else if (row is ChoiceRow) Choice((ChoiceRow)row, label);
            else if (row is PopupRow) Popup((PopupRow)row, label);
            else if (row is SliderRow) Slider((SliderRow)row, label);
            else if (row is ColumnsRow) Columns((ColumnsRow)row, label);
            else if (row is GroupRow) Group((GroupRow)row, label);
            else if (row is ToggleRow) Toggle((ToggleRow)row, label);
            else if (row is FoldoutRow) Foldout((FoldoutRow)row, label);
            else if (row is TableRow) Table((TableRow)row);
            else if (row is FieldRow) Field((FieldRow)row, label);
            else if (row is ActionRow) Action((ActionRow)row, label);
            EditorGUI.indentLevel -= row.Indent;
            EditorGUI.EndDisabledGroup();
        }

        static void Check(CheckRow row)
        {
            EditorGUILayout.BeginHorizontal();
            MessageType type = row.Severity == Severity.Error ? MessageType.Error
                : row.Severity == Severity.Warning ? MessageType.Warning : MessageType.Info;
            EditorGUILayout.HelpBox(row.Label, type);
            if (row.Fix != null && GUILayout.Button(row.FixLabel, GUILayout.MinWidth(ButtonWidth), GUILayout.ExpandWidth(false)))
            {
                // Importing while a window draws ends its drawing.
                EditorApplication.delayCall += () => row.Fix();
            }
            if (row.Where != null && GUILayout.Button(Strings.Get("show"), GUILayout.ExpandWidth(false))) EditorGUIUtility.PingObject(row.Where);
            EditorGUILayout.EndHorizontal();
        }

        static void Object(ObjectRow row, GUIContent label)
        {
            EditorGUI.BeginChangeCheck();
            UnityEngine.Object value = EditorGUILayout.ObjectField(label, row.Get(), row.Type, row.SceneObjects);
            if (EditorGUI.EndChangeCheck()) row.Set(value);
        }

        static void Choice(ChoiceRow row, GUIContent label)
        {
            EditorGUILayout.BeginHorizontal();
            EditorGUILayout.LabelField(label, GUILayout.Width(EditorGUIUtility.labelWidth));
            EditorGUI.BeginChangeCheck();
            int value = GUILayout.Toolbar(row.Get(), row.Choices);
            if (EditorGUI.EndChangeCheck() && value >= 0) row.Set(value);
            EditorGUILayout.EndHorizontal();
        }

        static void Popup(PopupRow row, GUIContent label)
        {
            EditorGUI.BeginChangeCheck();
            int value = EditorGUILayout.Popup(label, row.Get(), Array.ConvertAll(row.Choices, text => new GUIContent(text)));
            if (EditorGUI.EndChangeCheck()) row.Set(value);
        }

        static void Slider(SliderRow row, GUIContent label)
        {
            EditorGUILayout.BeginHorizontal();
            EditorGUI.BeginChangeCheck();
            float value = EditorGUILayout.Slider(label, row.Get(), row.Low, row.High);
            if (EditorGUI.EndChangeCheck()) row.Set(value);
            if (row.Reset != null) Reset(row.IsOwn(), row.Reset);
            EditorGUILayout.EndHorizontal();
        }

        static void Columns(ColumnsRow row, GUIContent label)
        {
            // Below each other every slider says itself what it is.
            if (IsNarrow(row.Columns.Length)) return;
            EditorGUILayout.BeginHorizontal();
            EditorGUILayout.LabelField(label, EditorStyles.boldLabel, GUILayout.Width(GroupLabel));
            foreach (string column in row.Columns)
            {
                EditorGUILayout.LabelField(column, EditorStyles.miniLabel, GUILayout.MinWidth(40));
            }
            GUILayout.Space(ResetWidth);
            EditorGUILayout.EndHorizontal();
        }

        /// <summary>
        /// Unity draws no slider, only its number, where there are less than 105 points for both: 50 for the slider, 5 between, 50
        /// for the number (EditorGUI.DoSlider). In a narrow window the sliders of a group stand below each other.
        /// </summary>
        internal const float LeastSlider = 105;

        // Margins, the scroll bar and the indent of a section.
        const float Aside = 48;

        internal static bool IsNarrow(int columns) =>
            (EditorGUIUtility.currentViewWidth - GroupLabel - ResetWidth - Aside) / columns < LeastSlider + 4;

        static void Group(GroupRow row, GUIContent label)
        {
            if (IsNarrow(row.Sliders.Length))
            {
                Stacked(row, label);
                return;
            }
            EditorGUILayout.BeginHorizontal();
            EditorGUILayout.LabelField(label, row.IsOwn ? EditorStyles.boldLabel : EditorStyles.label, GUILayout.Width(GroupLabel));
            foreach (SliderRow slider in row.Sliders)
            {
                if (slider != null) BareSlider(slider);
                else EditorGUILayout.LabelField("", GUILayout.MinWidth(40));
            }
            Reset(row.IsOwn, row.Reset);
            EditorGUILayout.EndHorizontal();
        }

        static void Stacked(GroupRow row, GUIContent label)
        {
            EditorGUILayout.LabelField(label, row.IsOwn ? EditorStyles.boldLabel : EditorStyles.label);
            EditorGUI.indentLevel++;
            foreach (SliderRow slider in row.Sliders)
            {
                if (slider != null) Slider(slider, new GUIContent(slider.Label, slider.Tooltip));
            }
            EditorGUI.indentLevel--;
        }

        static void BareSlider(SliderRow row)
        {
            // An indent would take from the slider what the grid has given it.
            int indent = EditorGUI.indentLevel;
            EditorGUI.indentLevel = 0;
            EditorGUI.BeginChangeCheck();
            float value = EditorGUILayout.Slider(row.Get(), row.Low, row.High, GUILayout.MinWidth(LeastSlider));
            if (EditorGUI.EndChangeCheck()) row.Set(value);
            EditorGUI.indentLevel = indent;
        }

        static void Reset(bool possible, Action reset)
        {
            EditorGUI.BeginDisabledGroup(!possible);
            if (GUILayout.Button(new GUIContent("\u21ba", Strings.Get("tune.reset.one")), GUILayout.Width(ResetWidth))) reset();
            EditorGUI.EndDisabledGroup();
        }

        static void Toggle(ToggleRow row, GUIContent label)
        {
            EditorGUI.BeginChangeCheck();
            bool value = EditorGUILayout.Toggle(label, row.Get());
            if (EditorGUI.EndChangeCheck()) row.Set(value);
        }

        static void Foldout(FoldoutRow row, GUIContent label)
        {
            bool open = EditorGUILayout.Foldout(row.Get(), label, true);
            if (open != row.Get()) row.Set(open);
        }

        static void Table(TableRow row)
        {
            Cells(row.Columns, EditorStyles.miniLabel);
            foreach (string[] cells in row.Cells)
            {
                Cells(cells, EditorStyles.label);
            }
        }

        static void Cells(string[] cells, GUIStyle style)
        {
            EditorGUILayout.BeginHorizontal();
            foreach (string cell in cells)
            {
                EditorGUILayout.LabelField(cell, style, GUILayout.MinWidth(40));
            }
            EditorGUILayout.EndHorizontal();
        }

        static void Field(FieldRow row, GUIContent label)
        {
            EditorGUI.BeginChangeCheck();
            string value = EditorGUILayout.TextField(label, row.Get());
            if (EditorGUI.EndChangeCheck()) row.Set(value);
        }

        static void Action(ActionRow row, GUIContent label)
        {
            Color before = GUI.backgroundColor;
            if (row.Main) GUI.backgroundColor = new Color(0.55f, 0.8f, 1);
            bool pressed = row.Main ? GUILayout.Button(label, GUILayout.Height(32)) : GUILayout.Button(label);
            GUI.backgroundColor = before;
            if (pressed) row.Do();
        }
    }
}
