using UnityEditor;
using UnityEditor.AssetImporters;
using UnityEngine;

namespace SuperDeform.Editor
{
    /// <summary>Meshes that Unity keeps to the graphics card alone, and how they become readable.</summary>
    internal static class Readability
    {
        internal static Finding NotReadable(Mesh mesh, UnityEngine.Object where)
        {
            var finding = new Finding("not_readable", Severity.Error, where, mesh.name, where.name);
            return CanMend(mesh) ? finding.WithFix("fix_readable", () => Mend(mesh)) : finding;
        }

        static bool CanMend(Mesh mesh)
        {
            string path = AssetDatabase.GetAssetPath(mesh);
            AssetImporter importer = AssetImporter.GetAtPath(path);
            // What is set on a mesh that a script has imported, such as UniVRM's, lasts until the next import.
            return !string.IsNullOrEmpty(path) && (importer is ModelImporter || path.StartsWith("Assets/") && !(importer is ScriptedImporter));
        }

        static void Mend(Mesh mesh)
        {
            ModelImporter importer = AssetImporter.GetAtPath(AssetDatabase.GetAssetPath(mesh)) as ModelImporter;
            if (importer != null)
            {
                importer.isReadable = true;
                importer.SaveAndReimport();
                return;
            }
            // A mesh asset of its own, or within a prefab.
            var asset = new SerializedObject(mesh);
            asset.FindProperty("m_IsReadable").boolValue = true;
            asset.ApplyModifiedPropertiesWithoutUndo();
            AssetDatabase.SaveAssetIfDirty(mesh);
        }
    }
}
