using UnityEditor;
using UnityEngine;

namespace SuperDeform.Editor
{
    /// <summary>The commands of the package in Unity's menus.</summary>
    public static class MenuItems
    {
        const string Convert = "GameObject/Super Deform/Convert selected avatar";

        [MenuItem("Tools/Super Deform/Converter...", false, 0)]
        public static void OpenConverter()
        {
            ConverterWindow.Open(Selection.activeGameObject);
        }

        [MenuItem("Tools/Super Deform/Batch...", false, 1)]
        public static void OpenBatch()
        {
            BatchWindow.Open();
        }

        /// <summary>Converts the selected avatar with the settings of the converter window, at once.</summary>
        [MenuItem(Convert, false, 30)]
        public static void ConvertSelected()
        {
            GameObject avatar = Selection.activeGameObject;
            if (avatar == null)
            {
                Debug.LogWarning("[Super Deform] " + Strings.Get("menu.select"));
                return;
            }
            using (var progress = new EditorProgress(avatar.name))
            {
                BatchReport report = BatchConvert.Convert(new[] { avatar }, ConverterWindow.LastSettings(), progress);
                foreach (string line in report.Lines())
                {
                    if (report.Failed > 0) Debug.LogError("[Super Deform] " + line, avatar);
                    else Debug.Log("[Super Deform] " + line, avatar);
                }
                if (report.Failed == 0) EditorGUIUtility.PingObject(report.Entries[0].Result.Prefab);
            }
        }

        const string SetUp = "GameObject/Super Deform/Set up for build (NDMF)";

        /// <summary>Gives the selected avatar the component that a build converts it by, with the settings of the converter window.</summary>
        [MenuItem(SetUp, false, 31)]
        public static void SetUpSelected()
        {
            GameObject avatar = Selection.activeGameObject;
            if (avatar == null)
            {
                Debug.LogWarning("[Super Deform] " + Strings.Get("menu.select"));
                return;
            }
            SuperDeformAvatar component = avatar.GetComponent<SuperDeformAvatar>();
            if (component == null)
            {
                component = Undo.AddComponent<SuperDeformAvatar>(avatar);
                SettingsText.Give(component, ConverterWindow.LastSettings());
            }
            EditorGUIUtility.PingObject(component);
            if (!SuperDeformAvatarEditor.HasNdmf) Debug.LogWarning("[Super Deform] " + Strings.Get("component.no_ndmf"), avatar);
        }

        [MenuItem(SetUp, true)]
        public static bool CanSetUpSelected() => CanConvertSelected();

        /// <summary>Whether the command is for what is selected: one object with a humanoid Animator.</summary>
        [MenuItem(Convert, true)]
        public static bool CanConvertSelected() => Selection.gameObjects.Length == 1 && IsHumanoid(Selection.activeGameObject);

        internal static bool IsHumanoid(GameObject candidate) => candidate != null && HumanoidRoles.IsHumanoid(candidate.GetComponent<Animator>());
    }
}
