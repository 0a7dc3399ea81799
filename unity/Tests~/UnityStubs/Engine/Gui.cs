// Immediate-mode GUI that draws nothing: what is drawn is recorded, and a test presses buttons by their text.
using System;
using System.Collections.Generic;
using UnityStubs;

namespace UnityEngine
{
    public enum FontStyle { Normal, Bold, Italic, BoldAndItalic }
    public enum TextAnchor { UpperLeft, UpperCenter, UpperRight, MiddleLeft, MiddleCenter, MiddleRight, LowerLeft, LowerCenter, LowerRight }
    public enum TextClipping { Overflow, Clip }
    public enum ScaleMode { StretchToFill, ScaleAndCrop, ScaleToFit }
    public enum EventType { MouseDown = 0, MouseUp = 1, MouseMove = 2, MouseDrag = 3, KeyDown = 4, KeyUp = 5, ScrollWheel = 6, Repaint = 7, Layout = 8, DragUpdated = 9, DragPerform = 10, Ignore = 11, Used = 12, ValidateCommand = 13, ExecuteCommand = 14, DragExited = 15, ContextClick = 16 }
    public enum KeyCode { None = 0, Return = 13, Escape = 27, Space = 32, Delete = 127 }
    public enum FocusType { Keyboard = 1, Passive = 2 }

    public class Event
    {
        public static Event current { get; set; }
        public EventType type { get; set; }
        public Vector2 mousePosition { get; set; }
        public Vector2 delta { get; set; }
        public int button { get; set; }
        public KeyCode keyCode { get; set; }
        public string commandName { get; set; }
        public void Use() { type = EventType.Used; }
    }
    [Serializable]
    public class GUIContent
    {
        public static GUIContent none = new GUIContent("");
        public string text { get; set; }
        public string tooltip { get; set; }
        public Texture image { get; set; }
        public GUIContent() : this("") { }
        public GUIContent(string text) { this.text = text; tooltip = ""; }
        public GUIContent(string text, string tooltip) { this.text = text; this.tooltip = tooltip; }
        public GUIContent(Texture image) : this("") { this.image = image; }
        public GUIContent(string text, Texture image) : this(text) { this.image = image; }
        public GUIContent(string text, Texture image, string tooltip) : this(text, tooltip) { this.image = image; }
        public GUIContent(Texture image, string tooltip) : this("", tooltip) { this.image = image; }
        public GUIContent(GUIContent source) : this(source.text, source.image, source.tooltip) { }
    }
    [Serializable] public sealed class GUIStyleState { public Color textColor { get; set; } public Texture2D background { get; set; } }
    [Serializable]
    public sealed class GUIStyle
    {
        public static GUIStyle none { get { return new GUIStyle(); } }
        public GUIStyle() { normal = new GUIStyleState(); hover = new GUIStyleState(); active = new GUIStyleState(); focused = new GUIStyleState(); padding = new RectOffset(); margin = new RectOffset(); name = ""; }
        public GUIStyle(GUIStyle other) : this()
        {
            if (other == null) throw new ArgumentNullException("other");
            name = other.name; fontStyle = other.fontStyle; fontSize = other.fontSize; wordWrap = other.wordWrap; alignment = other.alignment; richText = other.richText; normal.textColor = other.normal.textColor; fixedWidth = other.fixedWidth; fixedHeight = other.fixedHeight;
        }
        public string name { get; set; }
        public FontStyle fontStyle { get; set; }
        public int fontSize { get; set; }
        public bool wordWrap { get; set; }
        public bool richText { get; set; }
        public bool stretchWidth { get; set; }
        public TextAnchor alignment { get; set; }
        public TextClipping clipping { get; set; }
        public GUIStyleState normal { get; set; }
        public GUIStyleState hover { get; set; }
        public GUIStyleState active { get; set; }
        public GUIStyleState focused { get; set; }
        public RectOffset padding { get; set; }
        public RectOffset margin { get; set; }
        public float fixedWidth { get; set; }
        public float fixedHeight { get; set; }
        public Vector2 CalcSize(GUIContent content) { return new Vector2((content.text ?? "").Length * 7f, 18f); }
        public float CalcHeight(GUIContent content, float width) { return 18f; }
        public static implicit operator GUIStyle(string name) { GUIStyle style = new GUIStyle(); style.name = name; return style; }
    }
    public class GUISkin : ScriptableObject { public GUIStyle box = new GUIStyle(), label = new GUIStyle(), button = new GUIStyle(), textField = new GUIStyle(), toggle = new GUIStyle(); }
    public sealed class GUILayoutOption { internal string Kind = ""; internal float Value; }
    public sealed class ExitGUIException : Exception { }

    public class GUI
    {
        public static bool enabled = true;
        public static bool changed;
        public static Color color = Color.white, backgroundColor = Color.white, contentColor = Color.white;
        public static GUISkin skin = new GUISkin();
        public static string tooltip { get { return ""; } }
        public static void Label(Rect position, string text) { Gui.Draw("Label", text); }
        public static void Label(Rect position, string text, GUIStyle style) { Gui.Draw("Label", text); }
        public static void Label(Rect position, GUIContent content) { Gui.Draw("Label", content); }
        public static void Label(Rect position, GUIContent content, GUIStyle style) { Gui.Draw("Label", content); }
        public static void Box(Rect position, string text) { Gui.Draw("Box", text); }
        public static void Box(Rect position, GUIContent content) { Gui.Draw("Box", content); }
        public static void Box(Rect position, GUIContent content, GUIStyle style) { Gui.Draw("Box", content); }
        public static void DrawTexture(Rect position, Texture image) { Gui.Draw("Texture", ""); }
        public static void DrawTexture(Rect position, Texture image, ScaleMode scaleMode) { Gui.Draw("Texture", ""); }
        public static void DrawTexture(Rect position, Texture image, ScaleMode scaleMode, bool alphaBlend) { Gui.Draw("Texture", ""); }
        public static bool Button(Rect position, string text) { return Gui.Pressed("Button", text); }
        public static bool Button(Rect position, GUIContent content) { return Gui.Pressed("Button", content); }
        public static bool Button(Rect position, GUIContent content, GUIStyle style) { return Gui.Pressed("Button", content); }
        public static bool Toggle(Rect position, bool value, string text) { return Gui.Value("Toggle", text, value); }
        public static float HorizontalSlider(Rect position, float value, float left, float right) { return Gui.Value("Slider", "", value); }
        public abstract class Scope : IDisposable
        {
            protected abstract void CloseScope();
            public void Dispose() { CloseScope(); }
        }
        public static void FocusControl(string name) { }
        public static void SetNextControlName(string name) { }
    }
    public class GUIUtility
    {
        public static int hotControl { get; set; }
        public static int keyboardControl { get; set; }
        public static string systemCopyBuffer { get; set; }
        public static int GetControlID(FocusType focus) { return 1; }
        public static int GetControlID(int hint, FocusType focus) { return 1; }
        public static void ExitGUI() { throw new ExitGUIException(); }
    }
    public class GUILayoutUtility
    {
        public static Rect GetRect(float width, float height) { return new Rect(0, 0, width, height); }
        public static Rect GetRect(float width, float height, params GUILayoutOption[] options) { return new Rect(0, 0, width, height); }
        public static Rect GetRect(float minWidth, float maxWidth, float minHeight, float maxHeight) { return new Rect(0, 0, maxWidth, maxHeight); }
        public static Rect GetRect(GUIContent content, GUIStyle style) { return new Rect(0, 0, 100, 18); }
        public static Rect GetRect(GUIContent content, GUIStyle style, params GUILayoutOption[] options) { return new Rect(0, 0, 100, 18); }
        public static Rect GetLastRect() { return new Rect(0, 0, 100, 18); }
        public static Rect GetAspectRect(float aspect) { return new Rect(0, 0, 100 * aspect, 100); }
    }
    public class GUILayout
    {
        public static GUILayoutOption Width(float width) { return new GUILayoutOption { Kind = "Width", Value = width }; }
        public static GUILayoutOption MinWidth(float width) { return new GUILayoutOption { Kind = "MinWidth", Value = width }; }
        public static GUILayoutOption MaxWidth(float width) { return new GUILayoutOption(); }
        public static GUILayoutOption Height(float height) { return new GUILayoutOption(); }
        public static GUILayoutOption MinHeight(float height) { return new GUILayoutOption(); }
        public static GUILayoutOption MaxHeight(float height) { return new GUILayoutOption(); }
        public static GUILayoutOption ExpandWidth(bool expand) { return new GUILayoutOption(); }
        public static GUILayoutOption ExpandHeight(bool expand) { return new GUILayoutOption(); }
        public static void Space(float pixels) { Gui.Take(pixels); }
        public static void FlexibleSpace() { }
        public static void BeginHorizontal(params GUILayoutOption[] options) { Gui.Begin("Horizontal"); }
        public static void BeginHorizontal(GUIStyle style, params GUILayoutOption[] options) { Gui.Begin("Horizontal"); }
        public static void EndHorizontal() { Gui.End("Horizontal"); }
        public static void BeginVertical(params GUILayoutOption[] options) { Gui.Begin("Vertical"); }
        public static void BeginVertical(GUIStyle style, params GUILayoutOption[] options) { Gui.Begin("Vertical"); }
        public static void EndVertical() { Gui.End("Vertical"); }
        public static Vector2 BeginScrollView(Vector2 scroll, params GUILayoutOption[] options) { Gui.Begin("ScrollView"); return scroll; }
        public static Vector2 BeginScrollView(Vector2 scroll, GUIStyle style, params GUILayoutOption[] options) { Gui.Begin("ScrollView"); return scroll; }
        public static void EndScrollView() { Gui.End("ScrollView"); }
        public static void BeginArea(Rect area) { Gui.Begin("Area"); }
        public static void EndArea() { Gui.End("Area"); }
        public static void Label(string text, params GUILayoutOption[] options) { Gui.Draw("Label", text); }
        public static void Label(GUIContent content, params GUILayoutOption[] options) { Gui.Draw("Label", content); }
        public static void Label(Texture image, params GUILayoutOption[] options) { Gui.Draw("Label", ""); }
        public static void Label(string text, GUIStyle style, params GUILayoutOption[] options) { Gui.Draw("Label", text); }
        public static void Label(GUIContent content, GUIStyle style, params GUILayoutOption[] options) { Gui.Draw("Label", content); }
        public static void Box(string text, params GUILayoutOption[] options) { Gui.Draw("Box", text); }
        public static void Box(GUIContent content, params GUILayoutOption[] options) { Gui.Draw("Box", content); }
        public static bool Button(string text, params GUILayoutOption[] options) { Gui.Measure(text, false, false, options); return Gui.Pressed("Button", text); }
        public static bool Button(GUIContent content, params GUILayoutOption[] options) { Gui.Measure(content.text, false, false, options); return Gui.Pressed("Button", content); }
        public static bool Button(string text, GUIStyle style, params GUILayoutOption[] options) { return Gui.Pressed("Button", text); }
        public static bool Button(GUIContent content, GUIStyle style, params GUILayoutOption[] options) { return Gui.Pressed("Button", content); }
        public static bool Toggle(bool value, string text, params GUILayoutOption[] options) { return Gui.Value("Toggle", text, value); }
        public static bool Toggle(bool value, GUIContent content, params GUILayoutOption[] options) { return Gui.Value("Toggle", content.text, value); }
        public static bool Toggle(bool value, string text, GUIStyle style, params GUILayoutOption[] options) { return Gui.Value("Toggle", text, value); }
        public static bool Toggle(bool value, GUIContent content, GUIStyle style, params GUILayoutOption[] options) { return Gui.Value("Toggle", content.text, value); }
        public static int Toolbar(int selected, string[] texts, params GUILayoutOption[] options) { return Gui.Choice("Toolbar", selected, texts); }
        public static int Toolbar(int selected, string[] texts, GUIStyle style, params GUILayoutOption[] options) { return Gui.Choice("Toolbar", selected, texts); }
        public static int SelectionGrid(int selected, string[] texts, int xCount, params GUILayoutOption[] options) { return Gui.Choice("SelectionGrid", selected, texts); }
        public static float HorizontalSlider(float value, float left, float right, params GUILayoutOption[] options) { return Gui.Value("Slider", "", value); }
        public static string TextField(string text, params GUILayoutOption[] options) { return Gui.Value("TextField", "", text); }
        public static string TextArea(string text, params GUILayoutOption[] options) { return Gui.Value("TextArea", "", text); }
        public class HorizontalScope : GUI.Scope { public HorizontalScope(params GUILayoutOption[] options) { Gui.Begin("Horizontal"); } public HorizontalScope(GUIStyle style, params GUILayoutOption[] options) { Gui.Begin("Horizontal"); } protected override void CloseScope() { Gui.End("Horizontal"); } }
        public class VerticalScope : GUI.Scope { public VerticalScope(params GUILayoutOption[] options) { Gui.Begin("Vertical"); } public VerticalScope(GUIStyle style, params GUILayoutOption[] options) { Gui.Begin("Vertical"); } protected override void CloseScope() { Gui.End("Vertical"); } }
    }
}

namespace UnityStubs
{
    /// What was drawn, and what the user does next: `Press` holds texts of buttons, `Enter` values by label.
    public static class Gui
    {
        public static readonly List<string> Drawn = new List<string>();
        public static readonly HashSet<string> Press = new HashSet<string>();
        public static readonly Dictionary<string, object> Enter = new Dictionary<string, object>();
        static readonly Stack<string> s_Open = new Stack<string>();

        /// How wide the window is, and the sliders of the last pass that were too narrow to be drawn: their numbers alone were.
        public static float Width = 440;
        public static readonly List<string> Barless = new List<string>();
        public static int Sliders;
        // UnityCsReference 2021.3, EditorGUI.DoSlider: the bar is drawn where there is room for 50 + 5 + 50 points after the label.
        const float Least = 105;
        static readonly Stack<List<Control>> s_Rows = new Stack<List<Control>>();
        static float s_Taken;
        internal static Func<float> Indent = () => 0f;
        sealed class Control { public string Name; public float Fixed = -1, Least; public bool Slider, Labelled; public float Indent; }

        internal static void Take(float pixels) { s_Taken += s_Rows.Count > 0 ? pixels : 0; }
        internal static void Measure(string name, bool slider, bool labelled, UnityEngine.GUILayoutOption[] options)
        {
            Control control = new Control { Name = name, Slider = slider, Labelled = labelled, Indent = Indent() };
            foreach (UnityEngine.GUILayoutOption option in options ?? new UnityEngine.GUILayoutOption[0])
            {
                if (option.Kind == "Width") control.Fixed = option.Value;
                if (option.Kind == "MinWidth") control.Least = option.Value;
            }
            if (s_Rows.Count > 0) s_Rows.Peek().Add(control);
            else Place(new List<Control> { control });
        }
        // Fixed widths first; what is left is shared evenly, as flexible controls of one kind share it.
        static void Place(List<Control> row)
        {
            float left = Width - 24 - s_Taken;
            int flexible = 0;
            foreach (Control control in row) { if (control.Fixed >= 0) left -= control.Fixed + 4; else flexible++; }
            foreach (Control control in row)
            {
                if (!control.Slider) continue;
                Sliders++;
                float width = control.Fixed >= 0 ? control.Fixed : left / flexible - 4;
                if (control.Labelled) width -= Math.Max(120, Width * 0.45f - 40);
                if (width - control.Indent < Least) Barless.Add(control.Name + " " + width);
            }
        }

        /// One pass of drawing: fails where a group is left open or closed by another's end.
        public static void Pass(Action draw)
        {
            Drawn.Clear();
            Barless.Clear();
            Sliders = 0;
            s_Rows.Clear();
            s_Open.Clear();
            draw();
            if (s_Open.Count > 0) throw new InvalidOperationException("GUI: Begin" + s_Open.Peek() + " has no End");
        }
        internal static void Begin(string group)
        {
            s_Open.Push(group);
            if (group != "Horizontal") return;
            s_Rows.Push(new List<Control>());
            s_Taken = 0;
        }
        internal static void End(string group)
        {
            if (s_Open.Count == 0 || s_Open.Peek() != group) throw new InvalidOperationException("GUI: End" + group + " closes " + (s_Open.Count == 0 ? "nothing" : s_Open.Peek()));
            s_Open.Pop();
            if (group != "Horizontal") return;
            List<Control> row = s_Rows.Pop();
            Place(row);
            s_Taken = 0;
        }
        internal static void Draw(string control, string text) { Drawn.Add(control + (UnityEngine.GUI.enabled ? "" : " (disabled)") + ": " + text); }
        internal static void Draw(string control, UnityEngine.GUIContent content) { Draw(control, content == null ? "" : content.text); }
        internal static bool Pressed(string control, UnityEngine.GUIContent content) { return Pressed(control, content.text); }
        internal static bool Pressed(string control, string text) { Draw(control, text); return UnityEngine.GUI.enabled && Press.Remove(text); }
        internal static T Value<T>(string control, string label, T value)
        {
            Draw(control, label + " = " + value);
            object entered;
            if (!UnityEngine.GUI.enabled || !Enter.TryGetValue(label ?? "", out entered)) return value;
            Enter.Remove(label ?? "");
            UnityEngine.GUI.changed = true;
            return (T)entered;
        }
        internal static int Choice(string control, int selected, string[] texts)
        {
            Draw(control, string.Join("|", texts));
            for (int at = 0; at < texts.Length; at++) if (UnityEngine.GUI.enabled && Press.Remove(texts[at])) { UnityEngine.GUI.changed |= at != selected; return at; }
            return selected;
        }
    }
}
