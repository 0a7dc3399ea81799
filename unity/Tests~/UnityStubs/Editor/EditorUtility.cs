// Dialogs, progress bars, preferences, importers and the editor's own events.
using System;
using System.Collections.Generic;
using System.Reflection;
using UnityEngine;
using UnityStubs;
using Object = UnityEngine.Object;

namespace UnityEditor
{
    public enum MessageType { None, Info, Warning, Error }
    public enum DialogOptOutDecisionType { ForThisMachine, ForThisSession }

    public class EditorUtility
    {
        public static bool IsPersistent(Object target) { return target != null && target.assetPath != null; }
        public static void SetDirty(Object target) { if (target == null) throw new ArgumentNullException("target"); AssetDatabase.SetDirty(target); }
        public static bool IsDirty(Object target) { AssetDatabase.File file; return IsPersistent(target) && AssetDatabase.Files.TryGetValue(target.assetPath, out file) && file.Dirty; }
        public static void ClearDirty(Object target) { AssetDatabase.File file; if (IsPersistent(target) && AssetDatabase.Files.TryGetValue(target.assetPath, out file)) file.Dirty = false; }
        public static Object InstanceIDToObject(int instanceID) { return Registry.Find(instanceID); }
        // Every serialized field; the name too, and for a component all but its place.
        public static void CopySerialized(Object source, Object dest)
        {
            if (source == null || dest == null) throw new ArgumentNullException(source == null ? "source" : "dest");
            if (source.GetType() != dest.GetType()) throw new ArgumentException("source is a " + source.GetType().Name + ", dest a " + dest.GetType().Name);
            GameObject owner = dest is Component ? ((Component)dest).gameObject : null;
            Cloning.CopyFields(source, dest, null, null);
            if (owner != null) ((Component)dest).m_GameObject = owner;
            SetDirty(dest);
        }
        public static void CopySerializedIfDifferent(Object source, Object dest) { CopySerialized(source, dest); }
        public static void CopySerializedManagedFieldsOnly(object source, object dest) { foreach (FieldInfo field in Fields.Of(source.GetType())) field.SetValue(dest, field.GetValue(source)); }

        public static void DisplayProgressBar(string title, string info, float progress) { Dialogs.Show(title, info, progress); }
        public static bool DisplayCancelableProgressBar(string title, string info, float progress) { Dialogs.Show(title, info, progress); return Dialogs.Cancel != null && Dialogs.Cancel(progress); }
        public static void ClearProgressBar() { Dialogs.BarOpen = false; }
        public static bool DisplayDialog(string title, string message, string ok) { return DisplayDialog(title, message, ok, ""); }
        public static bool DisplayDialog(string title, string message, string ok, string cancel) { return Dialogs.Ask(title, message) != 1; }
        public static bool DisplayDialog(string title, string message, string ok, string cancel, DialogOptOutDecisionType dialogOptOutDecisionType, string dialogOptOutDecisionStorageKey) { return DisplayDialog(title, message, ok, cancel); }
        public static int DisplayDialogComplex(string title, string message, string ok, string cancel, string alt) { return Dialogs.Ask(title, message); }
        public static string SaveFilePanel(string title, string directory, string defaultName, string extension) { return Dialogs.Panel(title); }
        public static string SaveFilePanelInProject(string title, string defaultName, string extension, string message) { return Dialogs.Panel(title); }
        public static string SaveFilePanelInProject(string title, string defaultName, string extension, string message, string path) { return Dialogs.Panel(title); }
        public static string OpenFilePanel(string title, string directory, string extension) { return Dialogs.Panel(title); }
        public static string OpenFolderPanel(string title, string folder, string defaultName) { return Dialogs.Panel(title); }
        public static string SaveFolderPanel(string title, string folder, string defaultName) { return Dialogs.Panel(title); }
        public static void RevealInFinder(string path) { Dialogs.Revealed.Add(path); }
        public static void FocusProjectWindow() { }
        public static void UnloadUnusedAssetsImmediate() { }
        public static string FormatBytes(long bytes) { return bytes + " B"; }
        public static GameObject CreateGameObjectWithHideFlags(string name, HideFlags flags, params Type[] components) { return new GameObject(name, flags, components ?? new Type[0]); }
    }

    /// Kind 0: null, what cannot be referred to lastingly, such as an object of a scene that was never saved or of a prefab that is
    /// edited; 1: an object of a file, 2: an object of a scene.
    public struct GlobalObjectId
    {
        public int identifierType { get; private set; }
        public GUID assetGUID { get; private set; }
        public ulong targetObjectId { get; private set; }
        public ulong targetPrefabId { get { return 0; } }
        public static GlobalObjectId GetGlobalObjectIdSlow(Object targetObject)
        {
            if (targetObject == null) return new GlobalObjectId();
            ulong own = (ulong)targetObject.GetInstanceID();
            if (EditorUtility.IsPersistent(targetObject)) return new GlobalObjectId { identifierType = 1, assetGUID = new GUID(AssetDatabase.AssetPathToGUID(targetObject.assetPath)), targetObjectId = own };
            GameObject owner = targetObject as GameObject ?? (targetObject as Component == null ? null : ((Component)targetObject).gameObject);
            string scene = owner == null ? "" : owner.scene.path;
            return scene.Length == 0 ? new GlobalObjectId() : new GlobalObjectId { identifierType = 2, assetGUID = new GUID(AssetDatabase.AssetPathToGUID(scene)), targetObjectId = own };
        }
        public override string ToString() { return "GlobalObjectId_V1-" + identifierType + "-" + (assetGUID.Empty() ? new string('0', 32) : assetGUID.ToString()) + "-" + targetObjectId + "-0"; }
    }

    public sealed class GameObjectUtility
    {
        public static int GetMonoBehavioursWithMissingScriptCount(GameObject go) { return go.components.FindAll(delegate (Component component) { return component is MissingScript; }).Count; }
        public static int RemoveMonoBehavioursWithMissingScript(GameObject go)
        {
            int count = GetMonoBehavioursWithMissingScriptCount(go);
            foreach (Component component in go.components.ToArray()) if (component is MissingScript) component.OnDestroyed();
            return count;
        }
        public static string GetUniqueNameForSibling(Transform parent, string name)
        {
            string tried = name;
            for (int number = 1; parent != null && parent.children.Exists(delegate (Transform child) { return child.name == tried; }); number++) tried = name + " (" + number + ")";
            return tried;
        }
        public static void SetParentAndAlign(GameObject child, GameObject parent) { if (parent != null) { child.transform.SetParent(parent.transform, false); child.layer = parent.layer; } }
    }

    public class EditorGUIUtility
    {
        public static float labelWidth = 150f, fieldWidth = 50f;
        public static bool wideMode = true;
        public static float singleLineHeight { get { return 18f; } }
        public static float standardVerticalSpacing { get { return 2f; } }
        public static float currentViewWidth { get { return Gui.Width; } }
        public static float pixelsPerPoint { get { return 1f; } }
        public static bool isProSkin { get { return true; } }
        public static GUIContent IconContent(string name) { return new GUIContent("", (Texture)null, name); }
        public static GUIContent IconContent(string name, string text) { return new GUIContent(text); }
        public static void PingObject(Object obj) { Dialogs.Pinged = obj; }
        public static Texture2D FindTexture(string name) { return null; }
        public static GUIContent ObjectContent(Object obj, Type type) { return new GUIContent(obj == null ? "None" : obj.name); }
        public static void AddCursorRect(Rect position, MouseCursor mouse) { }
        public static string systemCopyBuffer { get; set; }
        public static int GetObjectPickerControlID() { return 0; }
        public static Object GetObjectPickerObject() { return null; }
    }
    public enum MouseCursor { Arrow, Text, ResizeVertical, ResizeHorizontal, Link, SlideArrow, Orbit = 17, Pan = 13 }

    public class EditorPrefs
    {
        internal static readonly Dictionary<string, object> Values = new Dictionary<string, object>();
        static T Get<T>(string key, T otherwise) { object value; return Values.TryGetValue(key, out value) && value is T ? (T)value : otherwise; }
        public static bool GetBool(string key) { return Get(key, false); }
        public static bool GetBool(string key, bool defaultValue) { return Get(key, defaultValue); }
        public static void SetBool(string key, bool value) { Values[key] = value; }
        public static int GetInt(string key) { return Get(key, 0); }
        public static int GetInt(string key, int defaultValue) { return Get(key, defaultValue); }
        public static void SetInt(string key, int value) { Values[key] = value; }
        public static float GetFloat(string key) { return Get(key, 0f); }
        public static float GetFloat(string key, float defaultValue) { return Get(key, defaultValue); }
        public static void SetFloat(string key, float value) { Values[key] = value; }
        public static string GetString(string key) { return Get(key, ""); }
        public static string GetString(string key, string defaultValue) { return Get(key, defaultValue); }
        public static void SetString(string key, string value) { Values[key] = value; }
        public static bool HasKey(string key) { return Values.ContainsKey(key); }
        public static void DeleteKey(string key) { Values.Remove(key); }
        public static void DeleteAll() { Values.Clear(); }
    }
    public class SessionState
    {
        static readonly Dictionary<string, object> s_Values = new Dictionary<string, object>();
        static T Get<T>(string key, T otherwise) { object value; return s_Values.TryGetValue(key, out value) && value is T ? (T)value : otherwise; }
        public static bool GetBool(string key, bool defaultValue) { return Get(key, defaultValue); }
        public static void SetBool(string key, bool value) { s_Values[key] = value; }
        public static int GetInt(string key, int defaultValue) { return Get(key, defaultValue); }
        public static void SetInt(string key, int value) { s_Values[key] = value; }
        public static float GetFloat(string key, float defaultValue) { return Get(key, defaultValue); }
        public static void SetFloat(string key, float value) { s_Values[key] = value; }
        public static string GetString(string key, string defaultValue) { return Get(key, defaultValue); }
        public static void SetString(string key, string value) { s_Values[key] = value; }
        public static void EraseString(string key) { s_Values.Remove(key); }
    }

    public enum PlayModeStateChange { EnteredEditMode, ExitingEditMode, EnteredPlayMode, ExitingPlayMode }
    public class EditorApplication
    {
        public delegate void CallbackFunction();
        public static CallbackFunction update, delayCall;
        public static event Action quitting;
        public static event Action hierarchyChanged;
        public static event Action projectChanged;
        public static event Action<PlayModeStateChange> playModeStateChanged;
        public static double timeSinceStartup { get { return Time.realtimeSinceStartupAsDouble; } }
        public static bool isPlaying { get; set; }
        public static bool isPlayingOrWillChangePlaymode { get { return isPlaying; } }
        public static bool isCompiling { get { return false; } }
        public static bool isUpdating { get { return false; } }
        public static string applicationContentsPath { get { return "/opt/unity/Editor/Data"; } }
        public static void Exit(int returnValue) { Dialogs.ExitCode = returnValue; }
        public static void Beep() { }
        public static void QueuePlayerLoopUpdate() { }
        public static void RepaintHierarchyWindow() { }
        public static bool ExecuteMenuItem(string menuItemPath) { return StubMenu.Execute(menuItemPath); }
        internal static void Raise(PlayModeStateChange change) { if (playModeStateChanged != null) playModeStateChanged(change); }
        internal static void RaiseQuitting() { if (quitting != null) quitting(); if (hierarchyChanged != null) hierarchyChanged(); if (projectChanged != null) projectChanged(); }
    }
    public class AssemblyReloadEvents
    {
        public delegate void AssemblyReloadCallback();
        public static event AssemblyReloadCallback beforeAssemblyReload;
        public static event AssemblyReloadCallback afterAssemblyReload;
        internal static void Raise() { if (beforeAssemblyReload != null) beforeAssemblyReload(); if (afterAssemblyReload != null) afterAssemblyReload(); }
    }

    [AttributeUsage(AttributeTargets.Method, AllowMultiple = true)]
    public sealed class MenuItem : Attribute
    {
        public string menuItem;
        public bool validate;
        public int priority;
        public MenuItem(string itemName) : this(itemName, false) { }
        public MenuItem(string itemName, bool isValidateFunction) : this(itemName, isValidateFunction, 1000) { }
        public MenuItem(string itemName, bool isValidateFunction, int priority) { menuItem = itemName; validate = isValidateFunction; this.priority = priority; }
    }
    public sealed class MenuCommand
    {
        public Object context;
        public int userData;
        public MenuCommand(Object inContext) { context = inContext; }
        public MenuCommand(Object inContext, int inUserData) { context = inContext; userData = inUserData; }
    }
    public class Menu
    {
        public static void SetChecked(string menuPath, bool isChecked) { }
        public static bool GetChecked(string menuPath) { return false; }
    }
    [AttributeUsage(AttributeTargets.Class)] public sealed class InitializeOnLoadAttribute : Attribute { }
    [AttributeUsage(AttributeTargets.Method)] public sealed class InitializeOnLoadMethodAttribute : Attribute { }
    [AttributeUsage(AttributeTargets.Class)] public sealed class CustomEditor : Attribute { public CustomEditor(Type inspectedType) { } }
    [AttributeUsage(AttributeTargets.Class)] public sealed class CanEditMultipleObjects : Attribute { }

    public class AssetImporter : Object
    {
        internal static readonly Dictionary<string, AssetImporter> All = new Dictionary<string, AssetImporter>();
        internal string m_Path;
        public string assetPath { get { return m_Path; } }
        public string userData { get; set; }
        public static AssetImporter GetAtPath(string path) { AssetImporter found; return path != null && All.TryGetValue(path, out found) ? found : null; }
        public void SaveAndReimport() { StubDisk.Check(System.IO.Path.Combine(Settings.ProjectFolder, m_Path)); Reimport(); }
        internal virtual void Reimport() { }
    }
    public enum ModelImporterAnimationType { None, Legacy, Generic, Human }
    public enum ModelImporterAvatarSetup { NoAvatar, CreateFromThisModel, CopyFromOther }
    public class ModelImporter : AssetImporter
    {
        public bool isReadable { get; set; }
        public bool optimizeGameObjects { get; set; }
        public ModelImporterAnimationType animationType { get; set; }
        public ModelImporterAvatarSetup avatarSetup { get; set; }
        public HumanDescription humanDescription { get; set; }
        public Avatar sourceAvatar { get; set; }
        internal override void Reimport()
        {
            foreach (Object value in AssetDatabase.LoadAllAssetsAtPath(m_Path)) if (value is Mesh) ((Mesh)value).isReadable = isReadable;
        }
    }

    public class Progress
    {
        public enum Status { Running, Succeeded, Failed, Canceled, Paused }
        [Flags] public enum Options { None = 0, Sticky = 1, Indefinite = 2, Synchronous = 4, Managed = 8, Unmanaged = 16 }
        static int s_Last;
        internal static readonly Dictionary<int, float> Running = new Dictionary<int, float>();
        public static int Start(string name, string description = null, Options options = Options.None, int parentId = -1) { Running[++s_Last] = 0f; return s_Last; }
        public static void Report(int id, float progress) { if (Running.ContainsKey(id)) Running[id] = progress; }
        public static void Report(int id, float progress, string description) { Report(id, progress); }
        public static void Finish(int id, Status status = Status.Succeeded) { Running.Remove(id); }
        public static int Remove(int id) { Running.Remove(id); return id; }
        public static bool Exists(int id) { return Running.ContainsKey(id); }
        public static void RegisterCancelCallback(int id, Func<bool> callback) { }
        public static void UnregisterCancelCallback(int id) { }
    }
}

namespace UnityEditorInternal
{
    public class ComponentUtility
    {
        static Component s_Copied;
        public static bool CopyComponent(Component component) { s_Copied = component; return component != null; }
        public static bool PasteComponentAsNew(GameObject go)
        {
            if (s_Copied == null) return false;
            Component made = go.AddComponent(s_Copied.GetType());
            if (made == null) return false;
            UnityEditor.EditorUtility.CopySerialized(s_Copied, made);
            return true;
        }
        public static bool PasteComponentValues(Component component)
        {
            if (s_Copied == null || s_Copied.GetType() != component.GetType()) return false;
            UnityEditor.EditorUtility.CopySerialized(s_Copied, component);
            return true;
        }
        public static bool MoveComponentUp(Component component) { return Move(component, -1); }
        public static bool MoveComponentDown(Component component) { return Move(component, 1); }
        static bool Move(Component component, int by)
        {
            List<Component> row = component.gameObject.components;
            int at = row.IndexOf(component), to = at + by;
            if (to < 1 || to >= row.Count) return false;
            row.RemoveAt(at); row.Insert(to, component);
            return true;
        }
    }
}

namespace UnityStubs
{
    using UnityEditor;

    /// Dialogs and progress bars as a test sees and answers them. In batch mode a dialog throws: a build machine has nobody to answer.
    public static class Dialogs
    {
        public static readonly List<string> Shown = new List<string>(), Bars = new List<string>(), Revealed = new List<string>();
        public static readonly Queue<int> Answers = new Queue<int>();   // 0 ok, 1 cancel, 2 the third button; empty: ok
        public static readonly Queue<string> Paths = new Queue<string>(); // answers of file panels; empty: cancelled
        public static Func<float, bool> Cancel;                          // true at this fraction: the user presses Cancel
        public static bool BarOpen;
        public static int? ExitCode;
        public static Object Pinged;

        public static void Reset() { Shown.Clear(); Bars.Clear(); Revealed.Clear(); Answers.Clear(); Paths.Clear(); Cancel = null; BarOpen = false; ExitCode = null; Pinged = null; }
        internal static int Ask(string title, string message)
        {
            if (Application.isBatchMode) throw new InvalidOperationException("dialog in batch mode: " + title + ": " + message);
            Shown.Add(title + ": " + message);
            return Answers.Count == 0 ? 0 : Answers.Dequeue();
        }
        internal static string Panel(string title)
        {
            if (Application.isBatchMode) throw new InvalidOperationException("file panel in batch mode: " + title);
            Shown.Add(title);
            return Paths.Count == 0 ? "" : Paths.Dequeue();
        }
        internal static void Show(string title, string info, float progress) { BarOpen = true; Bars.Add(title + ": " + info + " " + progress.ToString("F3", System.Globalization.CultureInfo.InvariantCulture)); }
    }

    /// Menu commands of all loaded assemblies, found by their attribute as the editor finds them.
    public static class StubMenu
    {
        public static List<string> All()
        {
            List<string> paths = new List<string>();
            foreach (KeyValuePair<MenuItem, MethodInfo> pair in Methods()) if (!pair.Key.validate) paths.Add(pair.Key.menuItem);
            return paths;
        }
        /// Null: there is no validation function.
        public static bool? Validate(string path) { object answer = Call(path, true); return answer == null ? (bool?)null : (bool)answer; }
        /// False: no such command, or its validation refuses.
        public static bool Execute(string path)
        {
            if (!All().Contains(path) || Validate(path) == false) return false;
            Call(path, false);
            return true;
        }
        static object Call(string path, bool validate)
        {
            foreach (KeyValuePair<MenuItem, MethodInfo> pair in Methods())
            {
                if (pair.Key.menuItem != path || pair.Key.validate != validate) continue;
                object[] arguments = pair.Value.GetParameters().Length == 0 ? null : new object[] { new MenuCommand(Selection.activeObject) };
                try { return pair.Value.Invoke(null, arguments); }
                catch (TargetInvocationException failure) { throw failure.InnerException; }
            }
            return null;
        }
        static IEnumerable<KeyValuePair<MenuItem, MethodInfo>> Methods()
        {
            foreach (Type type in Editors())
                foreach (MethodInfo method in type.GetMethods(BindingFlags.Static | BindingFlags.Public | BindingFlags.NonPublic | BindingFlags.DeclaredOnly))
                    foreach (MenuItem item in method.GetCustomAttributes(typeof(MenuItem), false)) yield return new KeyValuePair<MenuItem, MethodInfo>(item, method);
        }
        internal static IEnumerable<Type> Editors()
        {
            foreach (Assembly assembly in AppDomain.CurrentDomain.GetAssemblies())
                if (Array.Exists(assembly.GetReferencedAssemblies(), delegate (AssemblyName name) { return name.Name == "UnityEditor"; }))
                    foreach (Type type in assembly.GetTypes()) yield return type;
        }
    }

    /// What the editor does around scripts.
    public static class StubEditor
    {
        public static void DrawScene(SceneView view) { SceneView.Draw(view); }
        public static Bounds? Framed(SceneView view) { return view.Framed; }
        /// Runs every [InitializeOnLoadMethod] of the loaded assemblies.
        public static void LoadScripts()
        {
            foreach (Type type in StubMenu.Editors())
                foreach (MethodInfo method in type.GetMethods(BindingFlags.Static | BindingFlags.Public | BindingFlags.NonPublic | BindingFlags.DeclaredOnly))
                    if (method.IsDefined(typeof(InitializeOnLoadMethodAttribute), false)) method.Invoke(null, null);
        }
        public static void ReloadScripts() { AssemblyReloadEvents.Raise(); }
        public static void Tick() { EditorApplication.CallbackFunction update = EditorApplication.update, later = EditorApplication.delayCall; EditorApplication.delayCall = null; if (later != null) later(); if (update != null) update(); }
        public static void ChangePlayMode(PlayModeStateChange change) { EditorApplication.Raise(change); }
        /// A component whose script is gone.
        public static void AddMissingScript(GameObject owner) { owner.AddComponent(typeof(MissingScript)); }
        /// As an importer with "Optimize Game Objects" leaves it.
        public static void SetOptimized(Animator animator, bool optimized) { animator.hasTransformHierarchy = !optimized; }
        public static int UndoSteps { get { return Undo.StepCount; } }
        public static int AssetEditing { get { return AssetDatabase.Editing; } }
        public static int RunningProgress { get { return Progress.Running.Count; } }
        /// An importer written in C#, such as UniVRM's: its assets are sub-assets of the file, and made anew by each import.
        public static void AddScriptedImporter(string path) { AssetImporter.All[path] = new SomeImporter { m_Path = path }; }
        sealed class SomeImporter : UnityEditor.AssetImporters.ScriptedImporter { }
        /// A model file's importer: its meshes are sub-assets of the file.
        public static ModelImporter AddModelImporter(string path, bool readable)
        {
            ModelImporter made = new ModelImporter { m_Path = path, isReadable = readable, animationType = ModelImporterAnimationType.Human, avatarSetup = ModelImporterAvatarSetup.CreateFromThisModel };
            AssetImporter.All[path] = made;
            return made;
        }
    }
}
