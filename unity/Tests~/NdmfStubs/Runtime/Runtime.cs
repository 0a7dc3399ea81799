namespace nadena.dev.ndmf
{
    public interface INDMFEditorOnly { }
}

namespace nadena.dev.ndmf.runtime.components
{
    public sealed class NDMFAvatarRoot : UnityEngine.MonoBehaviour { }
}
