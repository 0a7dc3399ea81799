using System;
using System.Collections.Generic;
using System.IO;
using UnityEditor;
using UnityEngine;

namespace SuperDeform.Editor
{
    /// <summary>
    /// The folder NAME_SD of a result, which is there whole or not at all.
    ///
    /// It holds two files: NAME_SD.prefab, and NAME_SD.asset with everything that the prefab needs, so that nothing of it can be
    /// moved or deleted without the rest. Both are written into a folder beside it, which takes its name at the end; nothing
    /// that was there before is overwritten.
    /// </summary>
    internal sealed class ResultFolder : IDisposable
    {
        readonly string name, parent, unfinished;
        readonly Stack<string> made = new Stack<string>();
        bool kept;

        /// <param name="parent">A folder of the project, which is made where it is missing.</param>
        internal ResultFolder(string parent, string avatarName)
        {
            name = Safe(avatarName) + "_SD";
            this.parent = parent;
            try
            {
                MakeParents(parent);
                unfinished = Create(parent, name + " (unfinished)");
            }
            catch
            {
                Dispose();
                throw;
            }
        }

        /// <summary>The avatar's name without what file systems refuse.</summary>
        static string Safe(string name)
        {
            char[] letters = name.ToCharArray();
            for (int index = 0; index < letters.Length; index++)
            {
                if (letters[index] < ' ' || "/\\:*?\"<>|".IndexOf(letters[index]) >= 0) letters[index] = '_';
            }
            string safe = new string(letters).Trim().TrimEnd('.');
            return safe.Length == 0 ? "Avatar" : safe;
        }

        void MakeParents(string folder)
        {
            if (AssetDatabase.IsValidFolder(folder)) return;
            int slash = folder.LastIndexOf('/');
            if (slash <= 0) throw Refused(folder, null);
            MakeParents(folder.Substring(0, slash));
            Create(folder.Substring(0, slash), folder.Substring(slash + 1));
        }

        string Create(string above, string folder)
        {
            string path;
            try
            {
                path = AssetDatabase.GUIDToAssetPath(AssetDatabase.CreateFolder(above, folder));
            }
            catch (Exception cause)
            {
                throw Refused(above + "/" + folder, cause);
            }
            if (string.IsNullOrEmpty(path)) throw Refused(above + "/" + folder, null);
            made.Push(path);
            return path;
        }

        /// <summary>Writes both files and gives the folder its name.</summary>
        /// <returns>The prefab's path.</returns>
        internal string Save(GameObject copy, SuperDeformPreset container, IList<UnityEngine.Object> assets)
        {
            string containerPath = unfinished + "/" + name + ".asset", prefabPath = unfinished + "/" + name + ".prefab";
            SaveAssets(container, assets, containerPath);
            SavePrefab(copy, prefabPath);
            MadeRecord.Keep(container, new HierarchyPaths(copy), copy, prefabPath, null);
            SaveContainer(container, containerPath);
            string final = AssetDatabase.GenerateUniqueAssetPath(parent + "/" + name);
            string refusal = AssetDatabase.MoveAsset(unfinished, final);
            if (!string.IsNullOrEmpty(refusal)) throw Refused(final, new IOException(refusal));
            kept = true;
            return final + "/" + name + ".prefab";
        }

        static void SaveAssets(UnityEngine.Object container, IList<UnityEngine.Object> assets, string path)
        {
            try
            {
                AssetDatabase.CreateAsset(container, path);
                foreach (UnityEngine.Object asset in assets)
                {
                    AssetDatabase.AddObjectToAsset(asset, container);
                }
            }
            catch (Exception cause)
            {
                throw Refused(path, cause);
            }
            SaveContainer(container, path);
        }

        /// <summary>Writes the file of the assets.</summary>
        internal static void SaveContainer(UnityEngine.Object container, string path)
        {
            try
            {
                AssetDatabase.SaveAssetIfDirty(container);
            }
            catch (Exception cause)
            {
                throw Refused(path, cause);
            }
            if (!IsWritten(path) || !AssetDatabase.Contains(container) || EditorUtility.IsDirty(container)) throw Refused(path, null);
        }

        internal static void SavePrefab(GameObject copy, string path)
        {
            bool success;
            GameObject prefab;
            try
            {
                prefab = PrefabUtility.SaveAsPrefabAsset(copy, path, out success);
            }
            catch (Exception cause)
            {
                throw Refused(path, cause);
            }
            if (!success || prefab == null || !IsWritten(path)) throw Refused(path, null);
        }

        /// <summary>The editor reports a full disk to its console alone, so the file itself is looked at.</summary>
        static bool IsWritten(string path)
        {
            // Folders of packages may be elsewhere on the disk.
            if (!path.StartsWith("Assets/")) return true;
            var file = new FileInfo(Path.Combine(Path.GetDirectoryName(Application.dataPath), path));
            return file.Exists && file.Length > 0;
        }

        static ConversionException Refused(string path, Exception cause)
        {
            string reason = cause == null ? Strings.Get("reason_unknown") : cause.Message;
            return new ConversionException(new Finding("write_refused", Severity.Error, null, path, reason), cause);
        }

        /// <summary>Leaves nothing behind but what Save has kept.</summary>
        public void Dispose()
        {
            while (!kept && made.Count > 0)
            {
                AssetDatabase.DeleteAsset(made.Pop());
            }
        }
    }
}
