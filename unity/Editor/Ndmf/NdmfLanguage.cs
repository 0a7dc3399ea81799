using nadena.dev.ndmf.localization;
using UnityEditor;

namespace SuperDeform.Editor.Ndmf
{
    /// <summary>Where NDMF is in the project its language is that of all its tools, and so of this one.</summary>
    internal sealed class NdmfLanguage
    {
        // NDMF calls back as long as this lives.
        static readonly NdmfLanguage follower = new NdmfLanguage();

        [InitializeOnLoadMethod]
        internal static void Follow()
        {
            LanguagePrefs.RegisterLanguageChangeCallback(follower, one => Strings.Follow(LanguagePrefs.Language));
            Strings.Follow(LanguagePrefs.Language);
        }
    }
}
