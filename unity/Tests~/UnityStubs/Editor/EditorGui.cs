// The editor's GUI calls and windows; nothing is drawn, see Gui.
using System;
using System.Collections.Generic;
using UnityEngine;
using UnityStubs;
using Object = UnityEngine.Object;

namespace UnityEditor
{
    public class EditorGUI
    {
        static readonly Stack<bool> s_Changed = new Stack<bool>(), s_Enabled = new Stack<bool>();
        static int s_Indent;
        public static int indentLevel { get { return s_Indent; } set { s_Indent = value; Gui.Indent = () => 15f * s_Indent; } }
        public static bool showMixedValue;
        public static void BeginChangeCheck() { s_Changed.Push(GUI.changed); GUI.changed = false; }
        public static bool EndChangeCheck() { bool now = GUI.changed; GUI.changed = s_Changed.Pop() | now; return now; }
        public static void BeginDisabledGroup(bool disabled) { s_Enabled.Push(GUI.enabled); GUI.enabled &= !disabled; }
        public static void EndDisabledGroup() { GUI.enabled = s_Enabled.Pop(); }
        public static void LabelField(Rect position, string label) { Gui.Draw("LabelField", label); }
        public static void LabelField(Rect position, string label, GUIStyle style) { Gui.Draw("LabelField", label); }
        public static void LabelField(Rect position, GUIContent label) { Gui.Draw("LabelField", label); }
        public static void LabelField(Rect position, GUIContent label, GUIStyle style) { Gui.Draw("LabelField", label); }
        public static void HelpBox(Rect position, string message, MessageType type) { Gui.Draw("HelpBox " + type, message); }
        public static void DrawRect(Rect rect, Color color) { Gui.Draw("Rect", ""); }
        public static void ProgressBar(Rect position, float value, string text) { Gui.Draw("ProgressBar", text); }
        public static float Slider(Rect position, float value, float leftValue, float rightValue) { return Gui.Value("Slider", "", value); }
        public static float Slider(Rect position, string label, float value, float leftValue, float rightValue) { return Gui.Value("Slider", label, value); }
        public static float Slider(Rect position, GUIContent label, float value, float leftValue, float rightValue) { return Gui.Value("Slider", label.text, value); }
        public static bool Toggle(Rect position, bool value) { return Gui.Value("Toggle", "", value); }
        public static bool Foldout(Rect position, bool foldout, string content, bool toggleOnLabelClick) { return Gui.Value("Foldout", content, foldout); }
        public static Object ObjectField(Rect position, Object obj, Type objType, bool allowSceneObjects) { return Gui.Value("ObjectField", "", obj); }
        public static Object ObjectField(Rect position, string label, Object obj, Type objType, bool allowSceneObjects) { return Gui.Value("ObjectField", label, obj); }
        public class DisabledScope : GUI.Scope { public DisabledScope(bool disabled) { BeginDisabledGroup(disabled); } protected override void CloseScope() { EndDisabledGroup(); } }
        public struct DisabledGroupScope : IDisposable { public DisabledGroupScope(bool disabled) { BeginDisabledGroup(disabled); } public void Dispose() { EndDisabledGroup(); } }
        public class ChangeCheckScope : GUI.Scope { public bool changed { get { return GUI.changed; } } public ChangeCheckScope() { BeginChangeCheck(); } protected override void CloseScope() { EndChangeCheck(); } }
        public class IndentLevelScope : GUI.Scope { readonly int m_By; public IndentLevelScope() : this(1) { } public IndentLevelScope(int increment) { m_By = increment; indentLevel += increment; } protected override void CloseScope() { indentLevel -= m_By; } }
    }

    public sealed class EditorGUILayout
    {
        public static void LabelField(string label, params GUILayoutOption[] options) { Gui.Measure("label", false, false, options); Gui.Draw("LabelField", label); }
        public static void LabelField(string label, GUIStyle style, params GUILayoutOption[] options) { Gui.Measure("label", false, false, options); Gui.Draw("LabelField", label); }
        public static void LabelField(string label, string label2, params GUILayoutOption[] options) { Gui.Draw("LabelField", label + ": " + label2); }
        public static void LabelField(string label, string label2, GUIStyle style, params GUILayoutOption[] options) { Gui.Draw("LabelField", label + ": " + label2); }
        public static void LabelField(GUIContent label, params GUILayoutOption[] options) { Gui.Measure("label", false, false, options); Gui.Draw("LabelField", label); }
        public static void LabelField(GUIContent label, GUIStyle style, params GUILayoutOption[] options) { Gui.Measure("label", false, false, options); Gui.Draw("LabelField", label); }
        public static void LabelField(GUIContent label, GUIContent label2, params GUILayoutOption[] options) { Gui.Draw("LabelField", label.text + ": " + label2.text); }
        public static void SelectableLabel(string text, params GUILayoutOption[] options) { Gui.Draw("SelectableLabel", text); }
        public static void SelectableLabel(string text, GUIStyle style, params GUILayoutOption[] options) { Gui.Draw("SelectableLabel", text); }
        public static void PrefixLabel(string label) { Gui.Draw("PrefixLabel", label); }
        public static void PrefixLabel(GUIContent label) { Gui.Draw("PrefixLabel", label); }
        public static void HelpBox(string message, MessageType type) { Gui.Draw("HelpBox " + type, message); }
        public static void HelpBox(string message, MessageType type, bool wide) { Gui.Draw("HelpBox " + type, message); }
        public static float Slider(float value, float leftValue, float rightValue, params GUILayoutOption[] options) { Gui.Measure("", true, false, options); return Gui.Value("Slider", "", value); }
        public static float Slider(string label, float value, float leftValue, float rightValue, params GUILayoutOption[] options) { Gui.Measure(label, true, true, options); return Gui.Value("Slider", label, value); }
        public static float Slider(GUIContent label, float value, float leftValue, float rightValue, params GUILayoutOption[] options) { Gui.Measure(label.text, true, true, options); return Gui.Value("Slider", label.text, value); }
        public static int IntSlider(string label, int value, int leftValue, int rightValue, params GUILayoutOption[] options) { return Gui.Value("IntSlider", label, value); }
        public static int IntSlider(GUIContent label, int value, int leftValue, int rightValue, params GUILayoutOption[] options) { return Gui.Value("IntSlider", label.text, value); }
        public static float FloatField(float value, params GUILayoutOption[] options) { return Gui.Value("FloatField", "", value); }
        public static float FloatField(string label, float value, params GUILayoutOption[] options) { return Gui.Value("FloatField", label, value); }
        public static float FloatField(GUIContent label, float value, params GUILayoutOption[] options) { return Gui.Value("FloatField", label.text, value); }
        public static int IntField(string label, int value, params GUILayoutOption[] options) { return Gui.Value("IntField", label, value); }
        public static bool Toggle(bool value, params GUILayoutOption[] options) { return Gui.Value("Toggle", "", value); }
        public static bool Toggle(string label, bool value, params GUILayoutOption[] options) { return Gui.Value("Toggle", label, value); }
        public static bool Toggle(GUIContent label, bool value, params GUILayoutOption[] options) { return Gui.Value("Toggle", label.text, value); }
        public static bool ToggleLeft(string label, bool value, params GUILayoutOption[] options) { return Gui.Value("Toggle", label, value); }
        public static bool ToggleLeft(GUIContent label, bool value, params GUILayoutOption[] options) { return Gui.Value("Toggle", label.text, value); }
        public static int Popup(int selectedIndex, string[] displayedOptions, params GUILayoutOption[] options) { return Gui.Value("Popup", "", selectedIndex); }
        public static int Popup(string label, int selectedIndex, string[] displayedOptions, params GUILayoutOption[] options) { return Gui.Value("Popup", label, selectedIndex); }
        public static int Popup(GUIContent label, int selectedIndex, string[] displayedOptions, params GUILayoutOption[] options) { return Gui.Value("Popup", label.text, selectedIndex); }
        public static int Popup(GUIContent label, int selectedIndex, GUIContent[] displayedOptions, params GUILayoutOption[] options) { return Gui.Value("Popup", label.text, selectedIndex); }
        public static Enum EnumPopup(string label, Enum selected, params GUILayoutOption[] options) { return Gui.Value("Popup", label, selected); }
        public static Enum EnumPopup(GUIContent label, Enum selected, params GUILayoutOption[] options) { return Gui.Value("Popup", label.text, selected); }
        public static string TextField(string text, params GUILayoutOption[] options) { return Gui.Value("TextField", "", text); }
        public static string TextField(string label, string text, params GUILayoutOption[] options) { return Gui.Value("TextField", label, text); }
        public static string TextField(GUIContent label, string text, params GUILayoutOption[] options) { return Gui.Value("TextField", label.text, text); }
        public static string TextArea(string text, params GUILayoutOption[] options) { return Gui.Value("TextArea", "", text); }
        public static Object ObjectField(Object obj, Type objType, bool allowSceneObjects, params GUILayoutOption[] options) { return Gui.Value("ObjectField", "", obj); }
        public static Object ObjectField(string label, Object obj, Type objType, bool allowSceneObjects, params GUILayoutOption[] options) { return Gui.Value("ObjectField", label, obj); }
        public static Object ObjectField(GUIContent label, Object obj, Type objType, bool allowSceneObjects, params GUILayoutOption[] options) { return Gui.Value("ObjectField", label.text, obj); }
        public static bool PropertyField(SerializedProperty property, params GUILayoutOption[] options) { return false; }
        public static bool PropertyField(SerializedProperty property, GUIContent label, params GUILayoutOption[] options) { return false; }
        public static bool Foldout(bool foldout, string content) { return Gui.Value("Foldout", content, foldout); }
        public static bool Foldout(bool foldout, string content, bool toggleOnLabelClick) { return Gui.Value("Foldout", content, foldout); }
        public static bool Foldout(bool foldout, string content, bool toggleOnLabelClick, GUIStyle style) { return Gui.Value("Foldout", content, foldout); }
        public static bool Foldout(bool foldout, GUIContent content, bool toggleOnLabelClick) { return Gui.Value("Foldout", content.text, foldout); }
        public static bool BeginFoldoutHeaderGroup(bool foldout, string content) { Gui.Begin("FoldoutHeaderGroup"); return Gui.Value("Foldout", content, foldout); }
        public static bool BeginFoldoutHeaderGroup(bool foldout, GUIContent content) { return BeginFoldoutHeaderGroup(foldout, content.text); }
        public static void EndFoldoutHeaderGroup() { Gui.End("FoldoutHeaderGroup"); }
        public static Rect BeginHorizontal(params GUILayoutOption[] options) { Gui.Begin("Horizontal"); return new Rect(); }
        public static Rect BeginHorizontal(GUIStyle style, params GUILayoutOption[] options) { Gui.Begin("Horizontal"); return new Rect(); }
        public static void EndHorizontal() { Gui.End("Horizontal"); }
        public static Rect BeginVertical(params GUILayoutOption[] options) { Gui.Begin("Vertical"); return new Rect(); }
        public static Rect BeginVertical(GUIStyle style, params GUILayoutOption[] options) { Gui.Begin("Vertical"); return new Rect(); }
        public static void EndVertical() { Gui.End("Vertical"); }
        public static Vector2 BeginScrollView(Vector2 scrollPosition, params GUILayoutOption[] options) { Gui.Begin("ScrollView"); return scrollPosition; }
        public static Vector2 BeginScrollView(Vector2 scrollPosition, GUIStyle style, params GUILayoutOption[] options) { Gui.Begin("ScrollView"); return scrollPosition; }
        public static void EndScrollView() { Gui.End("ScrollView"); }
        public static void Space() { }
        public static void Space(float width) { }
        public static void Space(float width, bool expand) { }
        public static void Separator() { }
        public static Rect GetControlRect(params GUILayoutOption[] options) { return new Rect(0, 0, 100, 18); }
        public static Rect GetControlRect(bool hasLabel, params GUILayoutOption[] options) { return new Rect(0, 0, 100, 18); }
        public static Rect GetControlRect(bool hasLabel, float height, params GUILayoutOption[] options) { return new Rect(0, 0, 100, height); }
        public class HorizontalScope : GUI.Scope { public Rect rect { get { return new Rect(); } } public HorizontalScope(params GUILayoutOption[] options) { Gui.Begin("Horizontal"); } public HorizontalScope(GUIStyle style, params GUILayoutOption[] options) { Gui.Begin("Horizontal"); } protected override void CloseScope() { Gui.End("Horizontal"); } }
        public class VerticalScope : GUI.Scope { public Rect rect { get { return new Rect(); } } public VerticalScope(params GUILayoutOption[] options) { Gui.Begin("Vertical"); } public VerticalScope(GUIStyle style, params GUILayoutOption[] options) { Gui.Begin("Vertical"); } protected override void CloseScope() { Gui.End("Vertical"); } }
        public class ScrollViewScope : GUI.Scope { public Vector2 scrollPosition { get; private set; } public ScrollViewScope(Vector2 scrollPosition, params GUILayoutOption[] options) { this.scrollPosition = scrollPosition; Gui.Begin("ScrollView"); } protected override void CloseScope() { Gui.End("ScrollView"); } }
    }

    public sealed class EditorStyles
    {
        static readonly Dictionary<string, GUIStyle> s_Styles = new Dictionary<string, GUIStyle>();
        static GUIStyle Style(string name) { GUIStyle style; if (!s_Styles.TryGetValue(name, out style)) s_Styles[name] = style = name; return style; }
        public static GUIStyle label { get { return Style("label"); } }
        public static GUIStyle boldLabel { get { return Style("boldLabel"); } }
        public static GUIStyle miniLabel { get { return Style("miniLabel"); } }
        public static GUIStyle miniBoldLabel { get { return Style("miniBoldLabel"); } }
        public static GUIStyle largeLabel { get { return Style("largeLabel"); } }
        public static GUIStyle linkLabel { get { return Style("linkLabel"); } }
        public static GUIStyle centeredGreyMiniLabel { get { return Style("centeredGreyMiniLabel"); } }
        public static GUIStyle wordWrappedLabel { get { return Style("wordWrappedLabel"); } }
        public static GUIStyle wordWrappedMiniLabel { get { return Style("wordWrappedMiniLabel"); } }
        public static GUIStyle helpBox { get { return Style("helpBox"); } }
        public static GUIStyle foldout { get { return Style("foldout"); } }
        public static GUIStyle foldoutHeader { get { return Style("foldoutHeader"); } }
        public static GUIStyle miniButton { get { return Style("miniButton"); } }
        public static GUIStyle miniButtonLeft { get { return Style("miniButtonLeft"); } }
        public static GUIStyle miniButtonMid { get { return Style("miniButtonMid"); } }
        public static GUIStyle miniButtonRight { get { return Style("miniButtonRight"); } }
        public static GUIStyle toolbar { get { return Style("toolbar"); } }
        public static GUIStyle toolbarButton { get { return Style("toolbarButton"); } }
        public static GUIStyle toolbarDropDown { get { return Style("toolbarDropDown"); } }
        public static GUIStyle popup { get { return Style("popup"); } }
        public static GUIStyle textField { get { return Style("textField"); } }
        public static GUIStyle textArea { get { return Style("textArea"); } }
        public static GUIStyle toggle { get { return Style("toggle"); } }
        public static GUIStyle numberField { get { return Style("numberField"); } }
        public static GUIStyle objectField { get { return Style("objectField"); } }
    }

    public class EditorWindow : ScriptableObject
    {
        static readonly Dictionary<Type, EditorWindow> s_Open = new Dictionary<Type, EditorWindow>();
        public GUIContent titleContent { get; set; }
        public Vector2 minSize { get; set; }
        public Vector2 maxSize { get; set; }
        public Rect position { get; set; }
        public bool wantsMouseMove { get; set; }
        public bool autoRepaintOnSceneChange { get; set; }
        public bool hasFocus { get { return ReferenceEquals(focusedWindow, this); } }
        public bool docked { get { return false; } }
        public static EditorWindow focusedWindow { get; private set; }
        public EditorWindow() { titleContent = new GUIContent(GetType().Name); position = new Rect(0, 0, 400, 700); }
        public static T GetWindow<T>() where T : EditorWindow { return GetWindow<T>(false, null, true); }
        public static T GetWindow<T>(string title) where T : EditorWindow { return GetWindow<T>(false, title, true); }
        public static T GetWindow<T>(bool utility) where T : EditorWindow { return GetWindow<T>(utility, null, true); }
        public static T GetWindow<T>(bool utility, string title) where T : EditorWindow { return GetWindow<T>(utility, title, true); }
        public static T GetWindow<T>(bool utility, string title, bool focus) where T : EditorWindow
        {
            EditorWindow open;
            if (!s_Open.TryGetValue(typeof(T), out open) || open == null) s_Open[typeof(T)] = open = CreateInstance<T>();
            if (title != null) open.titleContent = new GUIContent(title);
            focusedWindow = open;
            return (T)open;
        }
        public static T CreateWindow<T>() where T : EditorWindow { return CreateInstance<T>(); }
        public static bool HasOpenInstances<T>() where T : Object { EditorWindow open; return s_Open.TryGetValue(typeof(T), out open) && open != null; }
        public void Show() { s_Open[GetType()] = this; }
        internal static void CloseAll() { foreach (EditorWindow window in new List<EditorWindow>(s_Open.Values)) if (window != null) window.Close(); s_Open.Clear(); focusedWindow = null; }
        public void ShowUtility() { Show(); }
        public void Focus() { focusedWindow = this; }
        public void Repaint() { }
        public void Close() { s_Open.Remove(GetType()); if (ReferenceEquals(focusedWindow, this)) focusedWindow = null; DestroyImmediate(this); }
        public void ShowNotification(GUIContent notification) { Gui.Draw("Notification", notification); }
        public void RemoveNotification() { }
    }

    public class SceneView : EditorWindow
    {
        public static event Action<SceneView> duringSceneGui;
        public static SceneView lastActiveSceneView { get; internal set; }
        public Camera camera { get { return null; } }
        public Vector3 pivot { get; set; }
        /// Draws a view, as Unity does on its repaints.
        internal static void Draw(SceneView view) { if (duringSceneGui != null) duringSceneGui(view); }
        internal Bounds? Framed;
        public static void RepaintAll() { if (lastActiveSceneView != null && duringSceneGui != null) duringSceneGui(lastActiveSceneView); }
        public bool FrameSelected() { return true; }
        public bool Frame(Bounds bounds) { return true; }
        public bool Frame(Bounds bounds, bool instant) { Framed = bounds; return true; }
    }

    public class Editor : ScriptableObject
    {
        public Object target { get; internal set; }
        public Object[] targets { get { return new[] { target }; } }
        public SerializedObject serializedObject { get { return new SerializedObject(target); } }
        public virtual void OnInspectorGUI() { }
        public bool DrawDefaultInspector() { return false; }
        public void Repaint() { }
        // OnEnable comes when the target is set.
        public static Editor CreateEditor(Object targetObject, Type editorType)
        {
            Editor made = (Editor)Activator.CreateInstance(editorType, true);
            made.target = targetObject;
            Messages.Send(made, "OnEnable");
            return made;
        }
    }

    public sealed class GenericMenu
    {
        public delegate void MenuFunction();
        public delegate void MenuFunction2(object userData);
        public void AddItem(GUIContent content, bool on, MenuFunction func) { }
        public void AddItem(GUIContent content, bool on, MenuFunction2 func, object userData) { }
        public void AddDisabledItem(GUIContent content) { }
        public void AddSeparator(string path) { }
        public void ShowAsContext() { }
        public void DropDown(Rect position) { }
    }
    public enum DragAndDropVisualMode { None = 0, Copy = 1, Link = 2, Move = 16, Generic = 4, Rejected = 32 }
    public class DragAndDrop
    {
        public static Object[] objectReferences { get; set; }
        public static string[] paths { get; set; }
        public static DragAndDropVisualMode visualMode { get; set; }
        public static void AcceptDrag() { }
    }

    public class PreviewRenderUtility
    {
        readonly GameObject m_Camera = EditorUtility.CreateGameObjectWithHideFlags("Preview Camera", HideFlags.HideAndDontSave, typeof(Camera));
        readonly List<GameObject> m_Added = new List<GameObject>();
        public PreviewRenderUtility() : this(false) { }
        public PreviewRenderUtility(bool renderFullScene) { lights = new[] { EditorUtility.CreateGameObjectWithHideFlags("Light", HideFlags.HideAndDontSave, typeof(Light)).GetComponent<Light>(), EditorUtility.CreateGameObjectWithHideFlags("Light", HideFlags.HideAndDontSave, typeof(Light)).GetComponent<Light>() }; }
        public Camera camera { get { return m_Camera.GetComponent<Camera>(); } }
        public Light[] lights { get; private set; }
        public Color ambientColor { get; set; }
        public float cameraFieldOfView { get; set; }
        public void AddSingleGO(GameObject go) { m_Added.Add(go); }
        public GameObject InstantiatePrefabInScene(GameObject prefab) { GameObject made = Object.Instantiate(prefab); m_Added.Add(made); return made; }
        public void BeginPreview(Rect r, GUIStyle previewBackground) { }
        public Texture EndPreview() { return new Texture2D(4, 4); }
        public void EndAndDrawPreview(Rect r) { }
        public void Render() { }
        public void Render(bool allowScriptableRenderPipeline) { }
        public void Render(bool allowScriptableRenderPipeline, bool updatefov) { }
        // What was added is destroyed with the preview's scene.
        public void Cleanup()
        {
            foreach (GameObject added in m_Added) if (added != null) Object.DestroyImmediate(added);
            foreach (Light light in lights) if (light != null) Object.DestroyImmediate(light.gameObject);
            if (m_Camera != null) Object.DestroyImmediate(m_Camera);
        }
    }

    // Hidden by the eye in the Hierarchy.
    public sealed class SceneVisibilityManager
    {
        public static readonly SceneVisibilityManager instance = new SceneVisibilityManager();
        readonly HashSet<GameObject> m_Hidden = new HashSet<GameObject>();
        public bool IsHidden(GameObject gameObject, bool includeDescendants = false) { return m_Hidden.Contains(gameObject); }
        public void Hide(GameObject gameObject, bool includeDescendants) { m_Hidden.Add(gameObject); }
        public void Show(GameObject gameObject, bool includeDescendants) { m_Hidden.Remove(gameObject); }
    }

    public sealed class Handles
    {
        public static Color color { get; set; }
        public static Matrix4x4 matrix { get; set; }
        public static void DrawLine(Vector3 p1, Vector3 p2) { }
        public static void DrawWireCube(Vector3 center, Vector3 size) { }
        public static void Label(Vector3 position, string text) { Gui.Draw("Label", text); }
        public static void BeginGUI() { }
        public static void EndGUI() { }
    }
}
