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
            if (AssetDatabase.Files.TryGetValue(assetPath, out old))
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
        public static void UnloadPrefabContents(GameObject contentsRoot) { if (contentsRoot == null) throw new ArgumentNullException("contentsRoot"); Object.DestroyImmediate(contentsRoot); }
    }
}

namespace UnityEditor.SceneManagement
{
    using UnityEngine.SceneManagement;

    public sealed class EditorSceneManager : SceneManager
    {
        public static Scene NewPreviewScene() { Scene made = new Scene(); made.m_Handle = ++s_Last; s_Open.Add(made.m_Handle); return made; }
        public static bool ClosePreviewScene(Scene scene)
        {
            if (!s_Open.Remove(scene.m_Handle)) return false;
            foreach (GameObject root in scene.GetRootGameObjects()) Object.DestroyImmediate(root);
            return true;
        }
        public static bool IsPreviewScene(Scene scene) { return scene.m_Handle > 1; }
        public static bool MarkSceneDirty(Scene scene) { if (!scene.IsValid()) return false; s_Dirty.Add(scene.m_Handle); return true; }
        public static void MarkAllScenesDirty() { s_Dirty.Add(1); }
    }
    public sealed class PrefabStage { public GameObject prefabContentsRoot { get { return null; } } public string assetPath { get { return ""; } } }
    public sealed class PrefabStageUtility
    {
        public static PrefabStage GetCurrentPrefabStage() { return null; }
        public static PrefabStage GetPrefabStage(GameObject gameObject) { return null; }
    }
}
