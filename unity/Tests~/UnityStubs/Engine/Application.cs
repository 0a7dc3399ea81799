// The application, its log and its scenes.
using System;
using System.Collections.Generic;
using UnityEngine.SceneManagement;
using UnityStubs;

namespace UnityEngine
{
    public enum LogType { Error, Assert, Warning, Log, Exception }
    public enum RuntimePlatform { OSXEditor = 0, WindowsEditor = 7, LinuxEditor = 16 }
    public enum SystemLanguage
    {
        Afrikaans, Arabic, Basque, Belarusian, Bulgarian, Catalan, Chinese, Czech, Danish, Dutch, English, Estonian, Faroese, Finnish, French, German, Greek, Hebrew,
        Hungarian, Icelandic, Indonesian, Italian, Japanese, Korean, Latvian, Lithuanian, Norwegian, Polish, Portuguese, Romanian, Russian, SerboCroatian, Slovak,
        Slovenian, Spanish, Swedish, Thai, Turkish, Ukrainian, Vietnamese, ChineseSimplified, ChineseTraditional, Unknown
    }

    public static class Application
    {
        public delegate void LogCallback(string condition, string stackTrace, LogType type);
        public static event LogCallback logMessageReceived;
        public static bool isBatchMode { get { return Settings.BatchMode; } }
        public static bool isPlaying { get { return false; } }
        public static bool isEditor { get { return true; } }
        public static string dataPath { get { return Settings.ProjectFolder + "/Assets"; } }
        public static string temporaryCachePath { get { return System.IO.Path.GetTempPath(); } }
        public static string persistentDataPath { get { return System.IO.Path.GetTempPath(); } }
        public static string unityVersion { get { return "2021.3.45f1"; } }
        public static RuntimePlatform platform { get { return RuntimePlatform.LinuxEditor; } }
        public static SystemLanguage systemLanguage { get { return Settings.Language; } }
        public static void OpenURL(string url) { Log.Add(LogType.Log, "open " + url); }
        internal static void Raise(string text, LogType type) { LogCallback listeners = logMessageReceived; if (listeners != null) listeners(text, "", type); }
    }

    public static class Debug
    {
        public static void Log(object message) { Write(LogType.Log, message); }
        public static void Log(object message, Object context) { Write(LogType.Log, message); }
        public static void LogFormat(string format, params object[] values) { Write(LogType.Log, string.Format(format, values)); }
        public static void LogWarning(object message) { Write(LogType.Warning, message); }
        public static void LogWarning(object message, Object context) { Write(LogType.Warning, message); }
        public static void LogWarningFormat(string format, params object[] values) { Write(LogType.Warning, string.Format(format, values)); }
        public static void LogError(object message) { Write(LogType.Error, message); }
        public static void LogError(object message, Object context) { Write(LogType.Error, message); }
        public static void LogErrorFormat(string format, params object[] values) { Write(LogType.Error, string.Format(format, values)); }
        public static void LogException(Exception exception) { Write(LogType.Exception, exception); }
        public static void LogException(Exception exception, Object context) { Write(LogType.Exception, exception); }
        public static void Assert(bool condition) { if (!condition) Write(LogType.Assert, "Assertion failed"); }
        public static void Assert(bool condition, object message) { if (!condition) Write(LogType.Assert, message); }
        static void Write(LogType type, object message)
        {
            string text = message == null ? "Null" : message.ToString();
            UnityStubs.Log.Add(type, text);
            Application.Raise(text, type);
        }
    }

    public static class Time
    {
        public static float realtimeSinceStartup { get { return (float)Clock.Seconds; } }
        public static double realtimeSinceStartupAsDouble { get { return Clock.Seconds; } }
        public static float time { get { return realtimeSinceStartup; } }
        public static float deltaTime { get { return 1f / 60f; } }
    }
}

namespace UnityEngine.SceneManagement
{
    public struct Scene : IEquatable<Scene>
    {
        internal int m_Handle;
        public int handle { get { return m_Handle; } }
        public string name { get { return m_Handle == 0 ? null : path.Length > 0 ? System.IO.Path.GetFileNameWithoutExtension(path) : m_Handle == 1 ? "" : "Scene " + m_Handle; } }
        // Empty until the scene is saved.
        public string path { get { string path; return SceneManager.s_Paths.TryGetValue(m_Handle, out path) ? path : ""; } }
        public bool IsValid() { return m_Handle != 0 && SceneManager.s_Open.Contains(m_Handle); }
        public bool isLoaded { get { return IsValid(); } }
        public bool isDirty { get { return SceneManager.s_Dirty.Contains(m_Handle); } }
        public int rootCount { get { return GetRootGameObjects().Length; } }
        public GameObject[] GetRootGameObjects()
        {
            List<GameObject> roots = new List<GameObject>();
            foreach (Object value in Registry.All())
            {
                GameObject at = value as GameObject;
                if (!ReferenceEquals(at, null) && at.assetPath == null && ReferenceEquals(at.transform.m_Parent, null) && at.m_Scene.m_Handle == m_Handle) roots.Add(at);
            }
            return roots.ToArray();
        }
        public bool Equals(Scene other) { return m_Handle == other.m_Handle; }
        public override bool Equals(object other) { return other is Scene && Equals((Scene)other); }
        public override int GetHashCode() { return m_Handle; }
        public static bool operator ==(Scene a, Scene b) { return a.m_Handle == b.m_Handle; }
        public static bool operator !=(Scene a, Scene b) { return a.m_Handle != b.m_Handle; }
    }

    public class SceneManager
    {
        internal static readonly HashSet<int> s_Open = new HashSet<int> { 1 };
        internal static readonly HashSet<int> s_Dirty = new HashSet<int>();
        // Scenes of the editor's own, such as those of prefabs that are edited: never saved, never dirty for the user.
        internal static readonly HashSet<int> s_Preview = new HashSet<int>();
        internal static readonly Dictionary<int, string> s_Paths = new Dictionary<int, string>();
        internal static int s_Last = 1, s_Active = 1;
        static List<int> Loaded { get { List<int> all = new List<int>(s_Open); all.RemoveAll(s_Preview.Contains); all.Sort(); return all; } }
        public static int sceneCount { get { return Loaded.Count; } }
        public static Scene GetActiveScene() { Scene scene = new Scene(); scene.m_Handle = s_Active; return scene; }
        public static bool SetActiveScene(Scene scene) { if (!scene.IsValid()) throw new ArgumentException("The scene is not loaded"); s_Active = scene.m_Handle; return true; }
        public static Scene GetSceneAt(int index) { Scene scene = new Scene(); scene.m_Handle = Loaded[index]; return scene; }
        public static void MoveGameObjectToScene(GameObject value, Scene scene)
        {
            if (value.transform.parent != null) throw new ArgumentException("Gameobject is not a root in a scene");
            if (!scene.IsValid()) throw new ArgumentException("The scene is not valid");
            UnityStubs.Changes.Of(value);
            value.m_Scene = scene;
            UnityStubs.Changes.Of(value);
        }
    }
}

namespace UnityStubs
{
    using UnityEngine;

    /// What a test sets about the machine the editor pretends to run on.
    public static class Settings
    {
        public static bool BatchMode = true;
        /// False: GetBoneTransform gives null, as Unity does under some conditions in the editor (github.com/vrm-c/UniVRM/pull/1603).
        public static bool AnimatorsKnowTheirBones = true;
        public static SystemLanguage Language = SystemLanguage.English;
        public static string ProjectFolder = System.IO.Directory.GetCurrentDirectory();
    }

    /// What EditorApplication.hierarchyChanged hears of, and what makes a scene ask to be saved: objects made, destroyed, hung elsewhere,
    /// components added. Where the reference is silent it counts: an object that is marked not to be saved dirties no scene only if it
    /// was marked when it was made (EditorUtility.CreateGameObjectWithHideFlags).
    public static class Changes
    {
        public static int Hierarchy;

        internal static void Of(GameObject changed)
        {
            Hierarchy++;
            if ((changed.transform.root.gameObject.hideFlags & HideFlags.DontSaveInEditor) != 0) return;
            int scene = changed.scene.m_Handle;
            if (scene != 0 && !UnityEngine.SceneManagement.SceneManager.s_Preview.Contains(scene)) UnityEngine.SceneManagement.SceneManager.s_Dirty.Add(scene);
        }
    }

    /// What was logged, oldest first.
    public static class Log
    {
        public struct Line { public LogType Type; public string Text; public override string ToString() { return Type + ": " + Text; } }
        public static readonly List<Line> Lines = new List<Line>();
        internal static void Add(LogType type, string text)
        {
            Line line = new Line(); line.Type = type; line.Text = text;
            lock (Lines) Lines.Add(line);
        }
        public static List<string> Of(LogType type)
        {
            List<string> found = new List<string>();
            lock (Lines) foreach (Line line in Lines) if (line.Type == type) found.Add(line.Text);
            return found;
        }
        public static void Clear() { lock (Lines) Lines.Clear(); }
    }

    internal static class Clock
    {
        static readonly System.Diagnostics.Stopwatch s_Watch = System.Diagnostics.Stopwatch.StartNew();
        public static double Seconds { get { return s_Watch.Elapsed.TotalSeconds; } }
    }
}
