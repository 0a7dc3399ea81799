// Assets of a project folder: objects in memory, each file on disk written through StubDisk.
//
// A file holds the bytes of its objects; a reference to an object that is in no file is written, and afterwards kept, as null, as Unity does.
using System;
using System.Collections.Generic;
using System.IO;
using System.Security.Cryptography;
using System.Text;
using UnityEngine;
using UnityStubs;
using Object = UnityEngine.Object;

namespace UnityEditor
{
    [Flags] public enum ImportAssetOptions { Default = 0, ForceUpdate = 1, ForceSynchronousImport = 8, ImportRecursive = 256, DontDownloadFromCacheServer = 8192 }
    public enum RemoveAssetOptions { MoveAssetToTrash = 0, DeleteAssets = 2 }

    public static class AssetDatabase
    {
        internal sealed class File
        {
            public Object Main;
            public readonly List<Object> Subs = new List<Object>();
            public bool Dirty;
            // What was destroyed is in the file no more.
            public IEnumerable<Object> All { get { Subs.RemoveAll(delegate (Object sub) { return sub == null; }); yield return Main; foreach (Object sub in Subs) yield return sub; } }
        }
        internal static readonly Dictionary<string, File> Files = new Dictionary<string, File>();
        static readonly HashSet<Object> s_Dirty = new HashSet<Object>();
        static int s_Editing;

        static string Disk(string path) { return Path.Combine(Settings.ProjectFolder, path); }
        internal static bool InProject(string path)
        {
            return !string.IsNullOrEmpty(path) && (path == "Assets" || path.StartsWith("Assets/") || path.StartsWith("Packages/")) && !path.Contains("//") && !path.EndsWith("/") && path.IndexOf('\\') < 0 && !path.Contains("..");
        }
        static string Folder(string path) { int slash = path.LastIndexOf('/'); return slash < 0 ? "" : path.Substring(0, slash); }

        public static bool Contains(Object obj) { return obj != null && obj.assetPath != null; }
        public static bool IsMainAsset(Object obj) { File file; return Contains(obj) && Files.TryGetValue(obj.assetPath, out file) && ReferenceEquals(file.Main, obj); }
        public static bool IsSubAsset(Object obj) { return Contains(obj) && !IsMainAsset(obj); }
        public static bool IsForeignAsset(Object obj) { return Contains(obj) && AssetImporter.GetAtPath(obj.assetPath) is ModelImporter; }
        public static bool IsNativeAsset(Object obj) { return Contains(obj) && !IsForeignAsset(obj); }
        public static string GetAssetPath(Object obj) { return Contains(obj) ? obj.assetPath : ""; }
        public static string GetAssetPath(int instanceID) { return GetAssetPath(Registry.Find(instanceID)); }

        public static void CreateAsset(Object asset, string path)
        {
            if (asset == null) throw new ArgumentNullException("asset");
            path = (path ?? "").Replace('\\', '/');
            if (!InProject(path)) throw new UnityException("Creating asset at path " + path + " failed: it is not in the project's Assets folder.");
            if (Contains(asset)) throw new UnityException("the " + asset.GetType().Name + " '" + asset.name + "' is an asset already, at '" + asset.assetPath + "'");
            if (asset is GameObject || asset is Component) throw new UnityException("Creating asset at path " + path + " failed: game objects are saved with PrefabUtility.");
            if (Path.GetExtension(path).Length == 0) throw new UnityException("Creating asset at path " + path + " failed: the path has no extension.");
            if (!IsValidFolder(Folder(path))) throw new UnityException("Creating asset at path " + path + " failed: parent directory '" + Folder(path) + "' does not exist.");
            if ((asset.hideFlags & HideFlags.DontSaveInEditor) != 0) throw new UnityException("Creating asset at path " + path + " failed: the object is marked not to be saved.");
            File file = new File { Main = asset };
            string fault = Write(path, file, asset);
            if (fault != null) throw new UnityException("Creating asset at path " + path + " failed: " + fault);
            File old;
            if (Files.TryGetValue(path, out old)) foreach (Object gone in old.All) if (!ReferenceEquals(gone, asset)) Forget(gone);
            Files[path] = file;
            asset.m_Name = Path.GetFileNameWithoutExtension(path);
            asset.assetPath = path;
        }
        public static void AddObjectToAsset(Object objectToAdd, Object assetObject)
        {
            if (assetObject == null || !Contains(assetObject)) throw new UnityException("the object to add to is no asset");
            AddObjectToAsset(objectToAdd, assetObject.assetPath);
        }
        public static void AddObjectToAsset(Object objectToAdd, string path)
        {
            if (objectToAdd == null) throw new ArgumentNullException("objectToAdd");
            File file;
            if (!Files.TryGetValue(path, out file)) throw new UnityException("there is no asset at '" + path + "' to add to");
            if (Contains(objectToAdd)) throw new UnityException("the " + objectToAdd.GetType().Name + " '" + objectToAdd.name + "' is an asset already, at '" + objectToAdd.assetPath + "'");
            if (objectToAdd is GameObject || objectToAdd is Component) throw new UnityException("game objects are saved with PrefabUtility");
            objectToAdd.assetPath = path;
            file.Subs.Add(objectToAdd);
            file.Dirty = true;
        }
        public static void RemoveObjectFromAsset(Object objectToRemove)
        {
            if (!Contains(objectToRemove)) return;
            Files[objectToRemove.assetPath].Subs.Remove(objectToRemove);
            Files[objectToRemove.assetPath].Dirty = true;
            objectToRemove.assetPath = null;
        }
        internal static void SetDirty(Object value) { File file; if (Contains(value) && Files.TryGetValue(value.assetPath, out file)) file.Dirty = true; }
        // A file that cannot be written stays dirty, and an error is logged.
        public static void SaveAssets() { foreach (string path in new List<string>(Files.Keys)) Save(path); }
        public static void SaveAssetIfDirty(Object obj) { if (Contains(obj)) Save(obj.assetPath); }
        static void Save(string path)
        {
            File file = Files[path];
            if (!file.Dirty) return;
            string fault = Write(path, file, null);
            if (fault == null) file.Dirty = false;
            else Debug.LogError("Saving " + path + " failed: " + fault);
        }

        // Null on success. `beginning`: an object that becomes an asset of this file only if the writing succeeds.
        internal static string Write(string path, File file, Object beginning)
        {
            HashSet<Object> inside = new HashSet<Object>();
            foreach (Object value in file.All)
            {
                inside.Add(value);
                GameObject top = value as GameObject;
                if (ReferenceEquals(top, null)) continue;
                foreach (Transform at in top.GetComponentsInChildren<Transform>(true)) { inside.Add(at.gameObject); foreach (Component component in at.gameObject.components) inside.Add(component); }
            }
            byte[] bytes = Fingerprint.Bytes(file.All, delegate (Object reference)
            {
                if (inside.Contains(reference)) return null;
                return reference.assetPath == null ? "null" : "asset " + reference.assetPath + " " + reference.m_Name;
            });
            try
            {
                StubDisk.Write(Disk(path), bytes);
                string meta = Disk(path) + ".meta";
                if (!System.IO.File.Exists(meta)) StubDisk.Write(meta, Encoding.UTF8.GetBytes("fileFormatVersion: 2\nguid: " + Guid(path) + "\n"));
                return null;
            }
            catch (IOException fault) { return fault.Message; }
        }
        static string Guid(string path)
        {
            using (MD5 hash = MD5.Create()) return BitConverter.ToString(hash.ComputeHash(Encoding.UTF8.GetBytes(path))).Replace("-", "").ToLowerInvariant();
        }
        static void Forget(Object gone)
        {
            gone.assetPath = null;
            if (gone is GameObject) { foreach (Transform at in ((GameObject)gone).GetComponentsInChildren<Transform>(true)) { at.gameObject.assetPath = null; foreach (Component component in at.gameObject.components) component.assetPath = null; } }
            gone.OnDestroyed();
        }

        public static bool DeleteAsset(string path)
        {
            if (!InProject(path) || path == "Assets") return false;
            bool there = System.IO.File.Exists(Disk(path)) || Directory.Exists(Disk(path));
            foreach (string known in new List<string>(Files.Keys))
                if (known == path || known.StartsWith(path + "/"))
                {
                    foreach (Object gone in new List<Object>(Files[known].All)) Forget(gone);
                    Files.Remove(known);
                }
            if (System.IO.File.Exists(Disk(path))) System.IO.File.Delete(Disk(path));
            if (Directory.Exists(Disk(path))) Directory.Delete(Disk(path), true);
            if (System.IO.File.Exists(Disk(path) + ".meta")) System.IO.File.Delete(Disk(path) + ".meta");
            return there;
        }
        public static bool DeleteAssets(string[] paths, List<string> outFailedPaths)
        {
            foreach (string path in paths) if (!DeleteAsset(path)) outFailedPaths.Add(path);
            return outFailedPaths.Count == 0;
        }
        public static bool MoveAssetToTrash(string path) { return DeleteAsset(path); }
        public static string ValidateMoveAsset(string oldPath, string newPath)
        {
            if (!Exists(oldPath)) return "there is no asset at '" + oldPath + "'";
            if (!InProject(newPath) || !IsValidFolder(Folder(newPath))) return "the folder of '" + newPath + "' does not exist";
            return Exists(newPath) ? "there is an asset at '" + newPath + "' already" : "";
        }
        public static string MoveAsset(string oldPath, string newPath)
        {
            string fault = ValidateMoveAsset(oldPath, newPath);
            if (fault != "") return fault;
            try { StubDisk.Check(Disk(newPath)); }
            catch (IOException refused) { return refused.Message; }
            if (Directory.Exists(Disk(oldPath))) Directory.Move(Disk(oldPath), Disk(newPath)); else System.IO.File.Move(Disk(oldPath), Disk(newPath));
            if (System.IO.File.Exists(Disk(oldPath) + ".meta")) System.IO.File.Move(Disk(oldPath) + ".meta", Disk(newPath) + ".meta");
            foreach (string known in new List<string>(Files.Keys))
            {
                if (known != oldPath && !known.StartsWith(oldPath + "/")) continue;
                File file = Files[known];
                string moved = newPath + known.Substring(oldPath.Length);
                Files.Remove(known);
                Files[moved] = file;
                foreach (Object value in file.All) SetPath(value, moved);
                if (known == oldPath) file.Main.m_Name = Path.GetFileNameWithoutExtension(newPath);
            }
            return "";
        }
        internal static void SetPath(Object value, string path)
        {
            value.assetPath = path;
            GameObject top = value as GameObject;
            if (ReferenceEquals(top, null)) return;
            foreach (Component component in top.components) component.assetPath = path;
            foreach (Transform child in ((Transform)top.components[0]).children) SetPath(child.m_GameObject, path);
        }
        public static string RenameAsset(string path, string newName) { return MoveAsset(path, Folder(path) + "/" + newName + Path.GetExtension(path)); }
        public static bool CopyAsset(string path, string newPath)
        {
            File file;
            if (!Files.TryGetValue(path, out file) || file.Main is GameObject || Exists(newPath)) return false;
            CreateAsset(Object.Instantiate(file.Main), newPath);
            return true;
        }

        internal static bool Exists(string path) { return Files.ContainsKey(path) || System.IO.File.Exists(Disk(path)) || Directory.Exists(Disk(path)); }
        public static bool IsValidFolder(string path) { return InProject(path) && Directory.Exists(Disk(path)); }
        public static string CreateFolder(string parentFolder, string newFolderName)
        {
            if (!IsValidFolder(parentFolder) || string.IsNullOrEmpty(newFolderName) || newFolderName.IndexOfAny(new[] { '/', '\\', ':', '*', '?', '"', '<', '>', '|' }) >= 0)
            {
                Debug.LogError("Creating folder '" + newFolderName + "' in '" + parentFolder + "' failed.");
                return "";
            }
            string path = parentFolder + "/" + newFolderName;
            if (Exists(path)) path = GenerateUniqueAssetPath(path);
            try { StubDisk.Check(Disk(path)); Directory.CreateDirectory(Disk(path)); }
            catch (Exception fault)
            {
                if (!(fault is IOException) && !(fault is UnauthorizedAccessException)) throw;
                Debug.LogError("Creating folder '" + path + "' failed: " + fault.Message);
                return "";
            }
            return AssetPathToGUID(path);
        }
        public static string[] GetSubFolders(string path)
        {
            List<string> found = new List<string>();
            foreach (string folder in Directory.GetDirectories(Disk(path))) found.Add(path + "/" + Path.GetFileName(folder));
            return found.ToArray();
        }
        // "Assets/A.asset", then "Assets/A 1.asset"; nothing where the folder does not exist.
        public static string GenerateUniqueAssetPath(string path)
        {
            path = path.Replace('\\', '/');
            if (!IsValidFolder(Folder(path))) return "";
            if (!Exists(path)) return path;
            string stem = path.Substring(0, path.Length - Path.GetExtension(path).Length);
            for (int number = 1; ; number++)
            {
                string tried = stem + " " + number + Path.GetExtension(path);
                if (!Exists(tried)) return tried;
            }
        }
        public static string AssetPathToGUID(string path) { if (!Exists(path)) return ""; s_Guids[Guid(path)] = path; return Guid(path); }
        public static GUID GUIDFromAssetPath(string path) { return new GUID(AssetPathToGUID(path)); }
        static readonly Dictionary<string, string> s_Guids = new Dictionary<string, string>();
        public static string GUIDToAssetPath(string guid)
        {
            string path;
            return guid != null && s_Guids.TryGetValue(guid, out path) && Exists(path) ? path : "";
        }
        public static string GUIDToAssetPath(GUID guid) { return GUIDToAssetPath(guid.ToString()); }
        public static bool TryGetGUIDAndLocalFileIdentifier(Object obj, out string guid, out long localId)
        {
            guid = Contains(obj) ? AssetPathToGUID(obj.assetPath) : "";
            localId = Contains(obj) ? obj.fileNumber != 0 ? obj.fileNumber : obj.id : 0;
            return guid != "";
        }

        public static Object LoadMainAssetAtPath(string assetPath)
        {
            File file;
            if (assetPath != null && Files.TryGetValue(assetPath, out file)) return file.Main;
            string disk = assetPath == null ? "" : Disk(assetPath);
            string kind = Path.GetExtension(disk).ToLowerInvariant();
            if ((kind != ".json" && kind != ".txt" && kind != ".bytes") || !System.IO.File.Exists(disk)) return null;
            TextAsset text = new TextAsset(System.IO.File.ReadAllText(disk));
            text.m_Name = Path.GetFileNameWithoutExtension(disk);
            text.assetPath = assetPath;
            Files[assetPath] = new File { Main = text };
            return text;
        }
        public static T LoadAssetAtPath<T>(string assetPath) where T : Object { return (T)LoadAssetAtPath(assetPath, typeof(T)); }
        public static Object LoadAssetAtPath(string assetPath, Type type)
        {
            foreach (Object value in LoadAllAssetsAtPath(assetPath)) if (type.IsInstanceOfType(value)) return value;
            return null;
        }
        public static Object[] LoadAllAssetsAtPath(string assetPath)
        {
            Object main = LoadMainAssetAtPath(assetPath);
            if (main == null) return new Object[0];
            List<Object> all = new List<Object>(Files[assetPath].All);
            GameObject top = main as GameObject;
            if (top != null)
                foreach (Transform at in top.GetComponentsInChildren<Transform>(true)) { if (at.gameObject != top) all.Add(at.gameObject); foreach (Component component in at.gameObject.components) all.Add(component); }
            return all.ToArray();
        }
        public static Object[] LoadAllAssetRepresentationsAtPath(string assetPath) { File file; return Files.TryGetValue(assetPath, out file) ? file.Subs.FindAll(delegate (Object sub) { return sub != null; }).ToArray() : new Object[0]; }
        public static Type GetMainAssetTypeAtPath(string assetPath) { Object main = LoadMainAssetAtPath(assetPath); return main == null ? null : main.GetType(); }
        // "t:Type" and words of the name.
        public static string[] FindAssets(string filter) { return FindAssets(filter, null); }
        public static string[] FindAssets(string filter, string[] searchInFolders)
        {
            List<string> found = new List<string>();
            foreach (KeyValuePair<string, File> pair in Files)
            {
                bool fits = searchInFolders == null || Array.Exists(searchInFolders, delegate (string folder) { return pair.Key.StartsWith(folder + "/"); });
                foreach (string word in (filter ?? "").Split(new[] { ' ' }, StringSplitOptions.RemoveEmptyEntries))
                    fits &= word.StartsWith("t:") ? IsNamed(pair.Value.Main.GetType(), word.Substring(2)) : pair.Value.Main.m_Name.IndexOf(word, StringComparison.OrdinalIgnoreCase) >= 0;
                if (fits) found.Add(AssetPathToGUID(pair.Key));
            }
            return found.ToArray();
        }
        static bool IsNamed(Type type, string name)
        {
            if (name.Equals("Prefab", StringComparison.OrdinalIgnoreCase)) return type == typeof(GameObject);
            for (; type != null; type = type.BaseType) if (type.Name.Equals(name, StringComparison.OrdinalIgnoreCase)) return true;
            return false;
        }
        public static string[] GetDependencies(string pathName) { return new[] { pathName }; }
        public static void ImportAsset(string path) { ImportAsset(path, ImportAssetOptions.Default); }
        public static void ImportAsset(string path, ImportAssetOptions options) { if (Files.ContainsKey(path)) Save(path); }
        public static void Refresh() { Refresh(ImportAssetOptions.Default); }
        public static void Refresh(ImportAssetOptions options) { }
        public static void StartAssetEditing() { s_Editing++; }
        public static void StopAssetEditing()
        {
            if (s_Editing == 0) { Debug.LogError("StopAssetEditing without StartAssetEditing"); return; }
            s_Editing--;
        }
        internal static int Editing { get { return s_Editing; } set { s_Editing = value; } }
        public static bool IsOpenForEdit(Object assetObject) { return true; }
        public static bool IsOpenForEdit(string assetOrMetaFilePath) { return true; }
    }

    public struct GUID
    {
        readonly string m_Text;
        public GUID(string hexRepresentation) { m_Text = hexRepresentation; }
        public bool Empty() { return string.IsNullOrEmpty(m_Text); }
        public override string ToString() { return m_Text ?? ""; }
    }
}

namespace UnityStubs
{
    using UnityEditor;

    /// The disk of the project: a test can make it full or refuse paths. A refused write leaves no file, a full disk none either: Unity writes beside the file and renames.
    public static class StubDisk
    {
        /// Bytes that may still be written; null: any number.
        public static long? FailAfterBytes;
        /// True for a full path that must not be written.
        public static Predicate<string> Refuse;
        public static long Written;

        public static void Reset() { FailAfterBytes = null; Refuse = null; Written = 0; }
        internal static void Check(string path) { if (Refuse != null && Refuse(path)) throw new IOException("access to the path is denied"); }
        internal static void Write(string path, byte[] bytes)
        {
            Check(path);
            if (FailAfterBytes.HasValue)
            {
                if (FailAfterBytes.Value < bytes.Length) { FailAfterBytes = 0; throw new IOException("there is not enough space on the disk"); }
                FailAfterBytes -= bytes.Length;
            }
            Written += bytes.Length;
            try { File.WriteAllBytes(path, bytes); }
            catch (UnauthorizedAccessException fault) { throw new IOException(fault.Message); }
        }
    }

    /// An empty project in a folder of its own.
    public static class StubProject
    {
        public static void Open(string folder)
        {
            Directory.CreateDirectory(Path.Combine(folder, "Assets"));
            Settings.ProjectFolder = folder;
            Directory.SetCurrentDirectory(folder); // Unity's working folder is the project: relative file paths are looked up from there.
            Reset();
        }

        /// Closes the windows and forgets assets, scene objects, undo steps, preferences, the log and all settings; files stay.
        public static void Reset()
        {
            EditorWindow.CloseAll();
            StubStage.Close();
            EditorApplication.delayCall = null;
            EditorPrefs.DeleteAll();
            AssetImporter.All.Clear();
            GUI.enabled = true;
            GUI.changed = false;
            foreach (Object value in Registry.All())
            {
                GameObject top = value as GameObject;
                if (top != null && top.assetPath == null && top.transform.parent == null) Object.DestroyImmediate(top);
            }
            AssetDatabase.Files.Clear();
            AssetDatabase.Editing = 0;
            StubDisk.Reset();
            Undo.ClearAll();
            Selection.objects = new Object[0];
            Dialogs.Reset();
            Log.Clear();
            StubScenes.Reset();
            Settings.BatchMode = true;
            Settings.AnimatorsKnowTheirBones = true;
            Settings.Language = SystemLanguage.English;
            Gui.Drawn.Clear(); Gui.Press.Clear(); Gui.Enter.Clear();
        }

        /// Makes an object an asset as an importer does: its file exists already or is nobody's business.
        public static void Import(string path, params Object[] objects)
        {
            AssetDatabase.File file = new AssetDatabase.File { Main = objects[0] };
            for (int at = 1; at < objects.Length; at++) file.Subs.Add(objects[at]);
            AssetDatabase.Files[path] = file;
            foreach (Object value in objects) AssetDatabase.SetPath(value, path);
        }

        /// Every file below Assets, metas too, sorted, relative to the project.
        public static string[] FilesOnDisk()
        {
            string[] all = Directory.GetFileSystemEntries(Path.Combine(Settings.ProjectFolder, "Assets"), "*", SearchOption.AllDirectories);
            for (int at = 0; at < all.Length; at++) all[at] = all[at].Substring(Settings.ProjectFolder.Length + 1);
            Array.Sort(all, StringComparer.Ordinal);
            return all;
        }

        public static void SetReadable(Mesh mesh, bool readable) { mesh.isReadable = readable; }
    }
}
