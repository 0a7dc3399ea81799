using System;
using System.Collections.Generic;
using System.Globalization;
using UnityEngine;

namespace SuperDeform.Editor.WindowPicture
{
    /// <summary>Draws the converter window from its model: the same sections and rows that the editor draws.</summary>
    internal sealed class WindowDrawing
    {
        internal const double Width = 440;
        const double Margin = 12, Label = 128, GroupLabel = 116, RowHeight = 22, Reset = 22, Value = 46;

        readonly Canvas canvas;
        readonly double left;
        double y;

        WindowDrawing(Canvas canvas, double left, double top)
        {
            this.canvas = canvas;
            this.left = left;
            y = top;
        }

        // How deep the row stands below what it is a part of.
        int indent;

        double From { get { return left + Margin + 12 * indent; } }
        double To { get { return left + Width - Margin; } }

        /// <summary>Draws the whole window.</summary>
        /// <returns>Where it ends.</returns>
        internal static double Draw(Canvas canvas, ConverterModel model, double left, double top)
        {
            var drawing = new WindowDrawing(canvas, left, top);
            // What is behind is drawn first, so the height must be known: a dry run tells it.
            var dry = new WindowDrawing(new Canvas(), left, top);
            dry.DrawAll(model);
            canvas.Rectangle(left, top, Width, dry.y - top, Canvas.Background, 4, Canvas.Line);
            drawing.DrawAll(model);
            return drawing.y;
        }

        void DrawAll(ConverterModel model)
        {
            canvas.Rectangle(left, y, Width, 24, Canvas.Line, 4);
            canvas.Rectangle(left + 1, y + 1, 124, 23, Canvas.Background, 3);
            canvas.Text(From, y + 16, Strings.Get("window.title"), Canvas.Words);
            y += 30;
            Buttons(Strings.LanguageNames, Strings.Languages.IndexOf(Strings.Language), To - 260, 260, true);
            y += RowHeight + 2;
            foreach (Section section in model.Sections)
            {
                canvas.Rectangle(left + 1, y, Width - 2, 22, Canvas.Header);
                canvas.Rectangle(left + 1, y, Width - 2, 1, Canvas.Line);
                double x = From, middle = y + 11;
                Arrow(section.Open, x, middle);
                canvas.Text(From + 16, y + 15, section.Title, Canvas.Words, "start", true);
                if (!section.Open) canvas.Text(To, y + 15, section.Summary, Canvas.Faint, "end");
                y += 22;
                if (!section.Open) continue;
                y += 6;
                foreach (Row row in section.Rows) Draw(row);
                y += 8;
            }
            y += 4;
        }

        void Foldout(FoldoutRow row)
        {
            Arrow(row.Get(), From, y + 10);
            canvas.Text(From + 14, y + 15, row.Label, Canvas.Words);
            y += RowHeight;
        }

        void Arrow(bool open, double x, double middle)
        {
            canvas.Path(open ? Path(x, middle - 3, 8, 0, -4, 6) : Path(x + 2, middle - 4, 0, 8, 6, -4), Canvas.Words);
        }

        // A triangle: a point, and the way from it to the second and from there to the third.
        static string Path(double x, double y, double dx1, double dy1, double dx2, double dy2)
        {
            return "M" + Canvas.Number(x) + " " + Canvas.Number(y) + "l" + Canvas.Number(dx1) + " " + Canvas.Number(dy1) + "l"
                + Canvas.Number(dx2) + " " + Canvas.Number(dy2) + "z";
        }

        void Draw(Row row)
        {
            string ink = row.Enabled ? Canvas.Words : "#777777";
            double x = From + Label;
            indent = row.Indent;
            if (row is TextRow) Sentence(row.Label, ((TextRow)row).Strong);
            else if (row is CheckRow) Check((CheckRow)row);
            else if (row is ColumnsRow) Columns((ColumnsRow)row);
            else if (row is GroupRow) Group((GroupRow)row);
            else if (row is TableRow) Table((TableRow)row);
            else if (row is FoldoutRow) Foldout((FoldoutRow)row);
            else if (row is ActionRow) Action((ActionRow)row);
            else
            {
                canvas.Text(From, y + 15, Canvas.Cut(row.Label, Label - 4 - 12 * indent), ink);
                double width = To - x;
                if (row is ChoiceRow) Buttons(((ChoiceRow)row).Choices, ((ChoiceRow)row).Get(), x, width, row.Enabled);
                else if (row is ObjectRow) Object((ObjectRow)row, x, width);
                else if (row is PopupRow) Popup((PopupRow)row, x, width);
                else if (row is ToggleRow) Toggle((ToggleRow)row, x);
                else if (row is FieldRow) Field(((FieldRow)row).Get(), x, width);
                else if (row is SliderRow)
                {
                    var slider = (SliderRow)row;
                    Slider(slider, x, width - (slider.Reset == null ? 0 : Reset), ink);
                    if (slider.Reset != null) ResetButton(slider.IsOwn());
                }
                else throw new NotSupportedException("There is no drawing for a " + row.GetType().Name + ".");
                y += RowHeight;
            }
            indent = 0;
        }

        void Sentence(string text, bool strong)
        {
            foreach (string line in Canvas.Wrap(text, To - From))
            {
                canvas.Text(From, y + 15, line, Canvas.Words, "start", strong);
                y += 17;
            }
            y += 3;
        }

        void Check(CheckRow row)
        {
            double fix = row.Fix == null ? 0 : Canvas.Width(row.FixLabel) + 20, show = row.Where == null ? 0 : 52;
            double buttons = fix + show;
            List<string> lines = Canvas.Wrap(row.Label, To - From - 40 - buttons);
            double height = Math.Max(24, 16 * lines.Count + 8);
            canvas.Rectangle(From, y, To - From - buttons, height, Canvas.Box, 3, Canvas.Line);
            string colour = row.Severity == Severity.Error ? "#d9534f" : row.Severity == Severity.Warning ? "#e0b040" : "#5b9bd5";
            string sign = row.Severity == Severity.Info ? "i" : "!";
            canvas.Circle(From + 14, y + height / 2, 8, colour);
            canvas.Text(From + 14, y + height / 2 + 4, sign, "#202020", "middle", true);
            for (int i = 0; i < lines.Count; i++) canvas.Text(From + 28, y + (height - 16 * lines.Count) / 2 + 12 + 16 * i, lines[i], Canvas.Words);
            double x = To - buttons + 4;
            if (row.Fix != null) Button(row.FixLabel, x, fix - 4, 21, true, false);
            if (row.Where != null) Button(Strings.Get("show"), x + fix, show - 4, 21, true, false);
            y += height + 3;
        }

        void Button(string text, double x, double width, double height, bool enabled, bool pressed)
        {
            canvas.Rectangle(x, y, width, height, pressed ? Canvas.Pressed : enabled ? Canvas.Button : "#464646", 3, Canvas.Line);
            canvas.Text(x + width / 2, y + height / 2 + 4, Canvas.Cut(text, width - 4),
                pressed ? Canvas.Bright : enabled ? Canvas.Words : "#777777", "middle");
        }

        void Buttons(string[] texts, int down, double x, double width, bool enabled)
        {
            for (int i = 0; i < texts.Length; i++) Button(texts[i], x + i * width / texts.Length, width / texts.Length, 19, enabled, i == down);
        }

        void Field(string text, double x, double width)
        {
            canvas.Rectangle(x, y, width, 19, Canvas.Field, 3, Canvas.Line);
            canvas.Text(x + 6, y + 14, Canvas.Cut(text, width - 12), Canvas.Words);
        }

        void Object(ObjectRow row, double x, double width)
        {
            UnityEngine.Object value = row.Get();
            // What Unity writes into an empty field: "None (Game Object)".
            string type = System.Text.RegularExpressions.Regex.Replace(row.Type.Name, "(?<=[a-z])(?=[A-Z])", " ");
            Field(value == null ? "None (" + type + ")" : value.name, x, width);
            canvas.Circle(x + width - 11, y + 9.5, 5.5, Canvas.Knob);
            canvas.Circle(x + width - 11, y + 9.5, 4, Canvas.Field);
            canvas.Circle(x + width - 11, y + 9.5, 1.5, Canvas.Knob);
        }

        void Popup(PopupRow row, double x, double width)
        {
            canvas.Rectangle(x, y, width, 19, Canvas.Button, 3, Canvas.Line);
            canvas.Text(x + 8, y + 14, row.Choices[row.Get()], Canvas.Words);
            canvas.Path(Path(x + width - 16, y + 7, 8, 0, -4, 6), Canvas.Words);
        }

        void Toggle(ToggleRow row, double x)
        {
            canvas.Rectangle(x, y + 2, 15, 15, Canvas.Field, 3, Canvas.Line);
            if (row.Get())
            {
                canvas.Path("M" + Canvas.Number(x + 3) + " " + Canvas.Number(y + 9) + "l2 -2l3 3l5 -6l2 2l-7 8z",
                    row.Enabled ? Canvas.Words : "#777777");
            }
        }

        void Slider(SliderRow row, double x, double width, string ink)
        {
            float value = row.Get();
            double track = width - Value - 6;
            double at = (Mathf.Clamp(value, row.Low, row.High) - row.Low) / (row.High - row.Low);
            canvas.Rectangle(x + 5, y + 9, track - 10, 2, Canvas.Track);
            canvas.Circle(x + 5 + at * (track - 10), y + 10, 5.5, row.IsOwn() ? "#7fb0e6" : Canvas.Knob);
            canvas.Rectangle(x + track + 6, y, Value, 19, Canvas.Field, 3, Canvas.Line);
            canvas.Text(x + track + 11, y + 14, value.ToString("0.##", CultureInfo.InvariantCulture), ink);
        }

        void ResetButton(bool enabled)
        {
            Button("\u21ba", To - Reset + 3, Reset - 3, 19, enabled, false);
        }

        double GroupColumn { get { return (To - From - GroupLabel - Reset) / 2; } }

        void Columns(ColumnsRow row)
        {
            canvas.Text(From, y + 15, row.Label, Canvas.Faint);
            for (int i = 0; i < row.Columns.Length; i++) canvas.Text(From + GroupLabel + i * GroupColumn + 5, y + 15, row.Columns[i], Canvas.Faint);
            y += RowHeight;
        }

        void Group(GroupRow row)
        {
            canvas.Text(From, y + 15, Canvas.Cut(row.Label, GroupLabel - 4), Canvas.Words, "start", row.IsOwn);
            for (int i = 0; i < row.Sliders.Length; i++)
            {
                if (row.Sliders[i] != null) Slider(row.Sliders[i], From + GroupLabel + i * GroupColumn, GroupColumn - 6, Canvas.Words);
            }
            ResetButton(row.IsOwn);
            y += RowHeight;
        }

        void Table(TableRow row)
        {
            double column = (To - From) / row.Columns.Length;
            for (int i = 0; i < row.Columns.Length; i++) canvas.Text(From + i * column, y + 14, row.Columns[i], Canvas.Faint);
            y += 18;
            foreach (string[] cells in row.Cells)
            {
                canvas.Rectangle(From, y, To - From, 1, "#303030");
                for (int i = 0; i < cells.Length; i++) canvas.Text(From + i * column, y + 14, cells[i], Canvas.Words);
                y += 18;
            }
            y += 6;
        }

        void Action(ActionRow row)
        {
            y += 2;
            double height = row.Main ? 34 : 21;
            Button(row.Label, From, To - From, height, row.Enabled, row.Main && row.Enabled);
            y += height + 5;
        }
    }
}
