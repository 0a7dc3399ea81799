// Prefabs: a saved copy of a hierarchy. A reference to an object that is neither in the hierarchy nor in a file becomes null in the prefab.
using System;
using System.Collections.Generic;
using UnityEngine;
using UnityStubs;
using Object = UnityEngine.Object;

namespace UnityEditor
{
    public enum PrefabAssetType { NotAPrefab, Regular, Model, Variant, MissingAsset }
    public enum PrefabInstanceStatus { NotAPrefab, Connected, MissingAsset }
    public enum PrefabUnpackMode { OutermostRoot, Completely }
    public enum InteractionMode { AutomatedAction, UserAction }

    public sealed class PrefabUtility
    {
        // Instance objects and the asset objects they were made from.
        static readonly Dictionary<Object, Object> s_Sources = new Dictionary<Object, Object>();
        static readonly HashSet<GameObject> s_Roots = new HashSet<GameObject>();

        public static GameObject SaveAsPrefabAsset(GameObject instanceRoot, string assetPath) { bool success; return SaveAsPrefabAsset(instanceRoot, assetPath, out success); }
        public static GameObject SaveAsPrefabAsset(GameObject instanceRoot, string assetPath, out bool success)
        {
            success = false;
            if (instanceRoot == null) throw new ArgumentNullException("instanceRoot");
            if (EditorUtility.IsPersistent(instanceRoot)) throw new ArgumentException("Can't save a Prefab from an object that is an asset: '" + instanceRoot.name + "'", "instanceRoot");
            if (IsPartOfPrefabInstance(instanceRoot) && !IsOutermostPrefabInstanceRoot(instanceRoot)) throw new ArgumentException("'" + instanceRoot.name + "' is inside a Prefab instance: unpack it first, or save its root", "instanceRoot");
            if (string.IsNullOrEmpty(assetPath)) throw new ArgumentException("The path is empty", "assetPath");
            if (!assetPath.EndsWith(".prefab", StringComparison.OrdinalIgnoreCase)) throw new ArgumentException("'" + assetPath + "' does not end in .prefab", "assetPath");
            if (!AssetDatabase.InProject(assetPath)) throw new ArgumentException("'" + assetPath + "' is not in the project", "assetPath");
            string folder = assetPath.Substring(0, assetPath.LastIndexOf('/'));
            if (!AssetDatabase.IsValidFolder(folder)) throw new ArgumentException("The folder '" + folder + "' does not exist", "assetPath");
            foreach (Transform at in instanceRoot.GetComponentsInChildren<Transform>(true))
                if (GameObjectUtility.GetMonoBehavioursWithMissingScriptCount(at.gameObject) > 0)
                {
                    Debug.LogError("Saving Prefab to '" + assetPath + "' failed: '" + at.name + "' has a missing script.");
                    return null;
                }
            Dictionary<Object, Object> made = new Dictionary<Object, Object>(ByReference.Instance);
            GameObject asset = Cloning.CloneHierarchy(instanceRoot, delegate (Object reference) { return reference != null && reference.assetPath != null ? reference : null; }, made);
            asset.m_Name = System.IO.Path.GetFileNameWithoutExtension(assetPath);
            AssetDatabase.SetPath(asset, assetPath);
            AssetDatabase.File file = new AssetDatabase.File { Main = asset };
            string fault = AssetDatabase.Write(assetPath, file, asset);
            if (fault != null)
            {
                Debug.LogError("Saving Prefab to '" + assetPath + "' failed: " + fault);
                AssetDatabase.SetPath(asset, null);
                Object.DestroyImmediate(asset);
                return null;
            }
            AssetDatabase.File old;
            AssetDatabase.Files.TryGetValue(assetPath, out old);
            Number(asset, old == null ? null : old.Main as GameObject);
            if (old != null)
            {
                // Instances stay instances; what they look like changes in Unity alone.
                foreach (GameObject instance in s_Roots) { Object source; if (instance != null && s_Sources.TryGetValue(instance, out source) && ReferenceEquals(source, old.Main)) Link(instance, asset); }
                AssetDatabase.SetPath(old.Main, null);
                Object.DestroyImmediate(old.Main);
            }
            AssetDatabase.Files[assetPath] = file;
            success = true;
            return asset;
        }
        // Objects and components keep their numbers in the file where names are the same; others get new ones.
        static long s_LastNumber = 100;
        static void Number(GameObject made, GameObject old)
        {
            made.fileNumber = old == null ? ++s_LastNumber : old.fileNumber;
            List<Component> known = old == null ? new List<Component>() : new List<Component>(old.components);
            foreach (Component component in made.components)
            {
                Component twin = known.Find(delegate (Component other) { return other.GetType() == component.GetType(); });
                known.Remove(twin);
                component.fileNumber = twin == null ? ++s_LastNumber : twin.fileNumber;
            }
            List<Transform> rows = old == null ? new List<Transform>() : new List<Transform>(old.transform.children);
            foreach (Transform child in made.transform.children)
            {
                Transform twin = rows.Find(delegate (Transform other) { return other.name == child.name; });
                rows.Remove(twin);
                Number(child.gameObject, twin == null ? null : twin.gameObject);
            }
        }
        public static GameObject SaveAsPrefabAssetAndConnect(GameObject instanceRoot, string assetPath, InteractionMode action) { bool success; return SaveAsPrefabAssetAndConnect(instanceRoot, assetPath, action, out success); }
        public static GameObject SaveAsPrefabAssetAndConnect(GameObject instanceRoot, string assetPath, InteractionMode action, out bool success)
        {
            GameObject asset = SaveAsPrefabAsset(instanceRoot, assetPath, out success);
            if (success) Connect(instanceRoot, asset);
            return asset;
        }
        static void Connect(GameObject instance, GameObject asset) { s_Roots.Add(instance); Link(instance, asset); }
        static void Link(GameObject instance, GameObject asset)
        {
            s_Sources[instance] = asset;
            for (int at = 0; at < instance.components.Count && at < asset.components.Count; at++) s_Sources[instance.components[at]] = asset.components[at];
            Transform a = (Transform)instance.components[0], b = (Transform)asset.components[0];
            for (int child = 0; child < a.children.Count && child < b.children.Count; child++) Link(a.children[child].m_GameObject, b.children[child].m_GameObject);
        }
        public static Object InstantiatePrefab(Object assetComponentOrGameObject) { return InstantiatePrefab(assetComponentOrGameObject, (Transform)null); }
        public static Object InstantiatePrefab(Object assetComponentOrGameObject, Transform parent)
        {
            if (assetComponentOrGameObject == null) throw new ArgumentNullException("assetComponentOrGameObject");
            if (!EditorUtility.IsPersistent(assetComponentOrGameObject)) return null; // Only assets can be instantiated so.
            GameObject asset = assetComponentOrGameObject as GameObject ?? ((Component)assetComponentOrGameObject).gameObject;
            GameObject copy = (GameObject)Object.Instantiate((Object)asset);
            copy.name = asset.name;
            if (parent != null) copy.transform.SetParent(parent, false);
            Connect(copy, asset);
            return copy;
        }
        public static Object InstantiatePrefab(Object assetComponentOrGameObject, UnityEngine.SceneManagement.Scene destinationScene)
        {
            GameObject copy = (GameObject)InstantiatePrefab(assetComponentOrGameObject);
            if (copy != null) UnityEngine.SceneManagement.SceneManager.MoveGameObjectToScene(copy, destinationScene);
            return copy;
        }
        public static bool IsPartOfPrefabAsset(Object componentOrGameObject) { return EditorUtility.IsPersistent(componentOrGameObject) && (componentOrGameObject is GameObject || componentOrGameObject is Component); }
        public static bool IsPartOfPrefabInstance(Object componentOrGameObject) { return componentOrGameObject != null && s_Sources.ContainsKey(componentOrGameObject); }
        public static bool IsPartOfAnyPrefab(Object componentOrGameObject) { return IsPartOfPrefabAsset(componentOrGameObject) || IsPartOfPrefabInstance(componentOrGameObject); }
        public static bool IsPartOfModelPrefab(Object componentOrGameObject) { return GetPrefabAssetType(componentOrGameObject) == PrefabAssetType.Model; }
        public static bool IsAnyPrefabInstanceRoot(GameObject gameObject) { return s_Roots.Contains(gameObject); }
        public static bool IsOutermostPrefabInstanceRoot(GameObject gameObject) { return s_Roots.Contains(gameObject) && (gameObject.transform.parent == null || GetNearestPrefabInstanceRoot(gameObject.transform.parent) == null); }
        public static PrefabAssetType GetPrefabAssetType(Object componentOrGameObject)
        {
            if (!IsPartOfAnyPrefab(componentOrGameObject)) return PrefabAssetType.NotAPrefab;
            Object asset = IsPartOfPrefabAsset(componentOrGameObject) ? componentOrGameObject : s_Sources[componentOrGameObject];
            if (asset == null) return PrefabAssetType.MissingAsset;
            return AssetImporter.GetAtPath(asset.assetPath) is ModelImporter ? PrefabAssetType.Model : PrefabAssetType.Regular;
        }
        public static PrefabInstanceStatus GetPrefabInstanceStatus(Object componentOrGameObject) { return !IsPartOfPrefabInstance(componentOrGameObject) ? PrefabInstanceStatus.NotAPrefab : s_Sources[componentOrGameObject] == null ? PrefabInstanceStatus.MissingAsset : PrefabInstanceStatus.Connected; }
        public static T GetCorrespondingObjectFromSource<T>(T componentOrGameObject) where T : Object
        {
            Object source;
            return componentOrGameObject != null && s_Sources.TryGetValue(componentOrGameObject, out source) ? (T)source : null;
        }
        public static T GetCorrespondingObjectFromOriginalSource<T>(T componentOrGameObject) where T : Object { return GetCorrespondingObjectFromSource(componentOrGameObject); }
        public static string GetPrefabAssetPathOfNearestInstanceRoot(Object instanceComponentOrGameObject)
        {
            GameObject root = GetNearestPrefabInstanceRoot(instanceComponentOrGameObject);
            return root == null ? "" : AssetDatabase.GetAssetPath(s_Sources[root]);
        }
        public static GameObject GetNearestPrefabInstanceRoot(Object componentOrGameObject)
        {
            GameObject owner = componentOrGameObject as GameObject ?? (componentOrGameObject as Component == null ? null : ((Component)componentOrGameObject).gameObject);
            for (Transform at = owner == null ? null : owner.transform; at != null; at = at.parent) if (s_Roots.Contains(at.gameObject)) return at.gameObject;
            return null;
        }
        public static GameObject GetOutermostPrefabInstanceRoot(Object componentOrGameObject)
        {
            GameObject found = null;
            for (GameObject root = GetNearestPrefabInstanceRoot(componentOrGameObject); root != null; root = root.transform.parent == null ? null : GetNearestPrefabInstanceRoot(root.transform.parent)) found = root;
            return found;
        }
        public static void UnpackPrefabInstance(GameObject instanceRoot, PrefabUnpackMode unpackMode, InteractionMode action)
        {
            if (!s_Roots.Remove(instanceRoot)) throw new ArgumentException("'" + instanceRoot.name + "' is not the root of a Prefab instance");
            foreach (Transform at in instanceRoot.GetComponentsInChildren<Transform>(true)) { s_Sources.Remove(at.gameObject); foreach (Component component in at.gameObject.components) s_Sources.Remove(component); }
        }
        public static void RecordPrefabInstancePropertyModifications(Object targetObject) { if (targetObject == null) throw new ArgumentNullException("targetObject"); }
        public static GameObject LoadPrefabContents(string assetPath)
        {
            GameObject asset = AssetDatabase.LoadAssetAtPath<GameObject>(assetPath);
            if (asset == null) throw new ArgumentException("there is no prefab at '" + assetPath + "'");
            GameObject copy = Object.Instantiate(asset);
            copy.name = asset.name;
            UnityEngine.SceneManagement.SceneManager.MoveGameObjectToScene(copy, SceneManagement.EditorSceneManager.NewPreviewScene());
            return copy;
        }
        public static void UnloadPrefabContents(GameObject contentsRoot)
        {
            if (contentsRoot == null) throw new ArgumentNullException("contentsRoot");
            if (!SceneManagement.EditorSceneManager.ClosePreviewScene(contentsRoot.scene)) throw new ArgumentException("'" + contentsRoot.name + "' was not loaded by LoadPrefabContents", "contentsRoot");
        }
    }
}

namespace UnityEditor.SceneManagement
{
    using UnityEngine.SceneManagement;

    public sealed class EditorSceneManager : SceneManager
    {
        public static Scene NewPreviewScene() { Scene made = new Scene(); made.m_Handle = ++s_Last; s_Open.Add(made.m_Handle); s_Preview.Add(made.m_Handle); return made; }
        public static bool ClosePreviewScene(Scene scene)
        {
            if (!s_Preview.Contains(scene.m_Handle) || !s_Open.Contains(scene.m_Handle)) return false;
            foreach (GameObject root in scene.GetRootGameObjects()) Object.DestroyImmediate(root);
            s_Open.Remove(scene.m_Handle);
            s_Preview.Remove(scene.m_Handle);
            return true;
        }
        public static bool IsPreviewScene(Scene scene) { return s_Preview.Contains(scene.m_Handle); }
        public static bool MarkSceneDirty(Scene scene) { if (!scene.IsValid()) return false; if (!s_Preview.Contains(scene.m_Handle)) s_Dirty.Add(scene.m_Handle); return true; }
        public static void MarkAllScenesDirty() { foreach (int scene in s_Open) if (!s_Preview.Contains(scene)) s_Dirty.Add(scene); }
        public static bool SaveScene(Scene scene, string dstScenePath = "", bool saveAsCopy = false)
        {
            string path = dstScenePath.Length > 0 ? dstScenePath : scene.path;
            if (!scene.IsValid() || path.Length == 0 || s_Preview.Contains(scene.m_Handle)) return false;
            StubDisk.Write(System.IO.Path.Combine(Settings.ProjectFolder, path), new byte[] { 1 });
            s_Paths[scene.m_Handle] = path;
            s_Dirty.Remove(scene.m_Handle);
            return true;
        }
    }

    /// A prefab that is edited by itself. Its scene shows and saves what hangs from one root, and nothing beside that.
    public sealed class PrefabStage
    {
        internal static PrefabStage s_Current;
        internal GameObject m_Root;
        public GameObject prefabContentsRoot { get { return m_Root; } }
        public string assetPath { get; internal set; }
        public Scene scene { get { return m_Root.scene; } }
        public bool IsPartOfPrefabContents(GameObject gameObject) { return gameObject != null && gameObject.transform.IsChildOf(m_Root.transform); }
    }
    public sealed class PrefabStageUtility
    {
        public static PrefabStage GetCurrentPrefabStage() { return PrefabStage.s_Current; }
        public static PrefabStage GetPrefabStage(GameObject gameObject)
        {
            PrefabStage stage = PrefabStage.s_Current;
            return stage != null && stage.m_Root != null && gameObject.scene == stage.scene ? stage : null;
        }
        public static PrefabStage OpenPrefab(string prefabAssetPath)
        {
            StubStage.Close();
            GameObject contents = PrefabUtility.LoadPrefabContents(prefabAssetPath);
            return PrefabStage.s_Current = new PrefabStage { m_Root = contents, assetPath = prefabAssetPath };
        }
    }
}

namespace UnityStubs
{
    using UnityEditor.SceneManagement;

    /// Prefab Mode as a person uses it.
    public static class StubStage
    {
        /// Saves the prefab: what hangs from its root.
        public static void Save() { UnityEditor.PrefabUtility.SaveAsPrefabAsset(PrefabStage.s_Current.m_Root, PrefabStage.s_Current.assetPath); }
        public static void Close()
        {
            PrefabStage stage = PrefabStage.s_Current;
            PrefabStage.s_Current = null;
            if (stage != null && stage.m_Root != null) EditorSceneManager.ClosePreviewScene(stage.scene);
        }
    }

    public static class StubScenes
    {
        public static bool IsDirty { get { return UnityEngine.SceneManagement.SceneManager.GetActiveScene().isDirty; } }
        /// Gives the active scene a file.
        public static void Save(string path) { EditorSceneManager.SaveScene(UnityEngine.SceneManagement.SceneManager.GetActiveScene(), path); }
        internal static void Reset()
        {
            StubStage.Close();
            EditorSceneManagerStub.Reset();
        }
    }
}

namespace UnityEditor.SceneManagement
{
    internal sealed class EditorSceneManagerStub : UnityEngine.SceneManagement.SceneManager
    {
        internal static void Reset() { s_Dirty.Clear(); s_Paths.Clear(); s_Active = 1; UnityStubs.Changes.Hierarchy = 0; }
    }
}
