using UnityEngine;

namespace SuperDeform
{
    /// <summary>
    /// Marks an avatar that a build turns into its super-deformed version, and says how. The avatar itself never changes.
    /// </summary>
    /// <remarks>
    /// It is on objects of scenes, so its assembly is in players too; the settings are text there, since the classes behind them
    /// are the editor's. A build by NDMF takes the component away; in other players it does nothing.
    /// </remarks>
    [AddComponentMenu("Super Deform/Super Deform Avatar")]
    [DisallowMultipleComponent]
    [Manual]
#if SUPERDEFORM_NDMF
    public sealed class SuperDeformAvatar : MonoBehaviour, nadena.dev.ndmf.INDMFEditorOnly
#else
    public sealed class SuperDeformAvatar : MonoBehaviour
#endif
    {
        [SerializeField] string settings = "";
        [SerializeField] GameObject referenceAvatar;
        [SerializeField] TextAsset savedStyle;

        /// <summary>The settings, one in a line: name and value; what is not named is as usual.</summary>
        public string Settings
        {
            get { return settings; }
            set { settings = value ?? ""; }
        }

        /// <summary>The avatar to be like, where the settings say so.</summary>
        public GameObject ReferenceAvatar
        {
            get { return referenceAvatar; }
            set { referenceAvatar = value; }
        }

        /// <summary>A style's file, where the settings say so.</summary>
        public TextAsset SavedStyle
        {
            get { return savedStyle; }
            set { savedStyle = value; }
        }
    }
}
