namespace nadena.dev.ndmf
{
    public interface INDMFEditorOnly { }
}
