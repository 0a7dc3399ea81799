using System;
using System.Collections.Generic;

namespace SuperDeform.Editor
{
    /// <summary>The five parts of the window, from top to bottom.</summary>
    public enum SectionId { Avatar, Style, FineTuning, Preview, Report }

    /// <summary>A part of the window that folds: a title and rows.</summary>
    public sealed class Section
    {
        public SectionId Id;
        public string Title;
        /// <summary>What is most worth knowing while it is folded; may be empty.</summary>
        public string Summary = "";
        public bool Open;
        public List<Row> Rows = new List<Row>();
    }

    /// <summary>One line of the window, as data: what it says, shows and changes, and nothing of how it is drawn.</summary>
    public abstract class Row
    {
        public string Label = "";
        public string Tooltip = "";
        public bool Enabled = true;
        /// <summary>How deep it stands below what it is a part of.</summary>
        public int Indent;
    }

    /// <summary>A sentence.</summary>
    public sealed class TextRow : Row
    {
        public bool Strong;
    }

    /// <summary>Something found out about the avatar or the result, and what mends it.</summary>
    public sealed class CheckRow : Row
    {
        public Severity Severity;
        /// <summary>The button's text; null: there is no button.</summary>
        public string FixLabel;
        public Action Fix;
        /// <summary>What the finding is about, to be shown on a click; may be null.</summary>
        public UnityEngine.Object Where;
    }

    /// <summary>A field for an object of the scene or the project.</summary>
    public sealed class ObjectRow : Row
    {
        public Type Type;
        public bool SceneObjects;
        public Func<UnityEngine.Object> Get;
        public Action<UnityEngine.Object> Set;
    }

    /// <summary>Buttons of which one may be down; Get gives -1 where none is.</summary>
    public sealed class ChoiceRow : Row
    {
        public string[] Choices;
        public Func<int> Get;
        public Action<int> Set;
    }

    /// <summary>A list of which one is chosen.</summary>
    public sealed class PopupRow : Row
    {
        public string[] Choices;
        public Func<int> Get;
        public Action<int> Set;
    }

    /// <summary>A number within bounds.</summary>
    public sealed class SliderRow : Row
    {
        public float Low;
        public float High = 1;
        public Func<float> Get;
        public Action<float> Set;
        /// <summary>Whether the number is the person's own; false: it is what was found or is usual.</summary>
        public Func<bool> IsOwn;
        /// <summary>Gives the number back to what was found; null: there is no way back.</summary>
        public Action Reset;
    }

    /// <summary>Titles of the columns of the group rows below it.</summary>
    public sealed class ColumnsRow : Row
    {
        public string[] Columns;
    }

    /// <summary>The sliders of one bone group, left and right together, as many as there are columns; null leaves one empty.</summary>
    public sealed class GroupRow : Row
    {
        public SliderRow[] Sliders;

        /// <summary>Whether a person has set any of them.</summary>
        public bool IsOwn => Array.Exists(Sliders, slider => slider != null && slider.IsOwn());

        /// <summary>Takes back what a person has set.</summary>
        public void Reset()
        {
            foreach (SliderRow slider in Sliders)
            {
                if (slider != null) slider.Reset();
            }
        }
    }

    /// <summary>Yes or no.</summary>
    public sealed class ToggleRow : Row
    {
        public Func<bool> Get;
        public Action<bool> Set;
    }

    /// <summary>A title that shows or hides the rows after it.</summary>
    public sealed class FoldoutRow : Row
    {
        public Func<bool> Get;
        public Action<bool> Set;
    }

    /// <summary>Numbers in columns; the first column is words.</summary>
    public sealed class TableRow : Row
    {
        public string[] Columns;
        public List<string[]> Cells = new List<string[]>();
    }

    /// <summary>A text that can be typed.</summary>
    public sealed class FieldRow : Row
    {
        public Func<string> Get;
        public Action<string> Set;
    }

    /// <summary>A button.</summary>
    public sealed class ActionRow : Row
    {
        public Action Do;
        /// <summary>The one that the window is there for.</summary>
        public bool Main;
    }
}
