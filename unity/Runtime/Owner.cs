namespace SuperDeform
{
/// <summary>Whose array is meant, for messages; a word is made of it only where one is needed.</summary>
internal struct Owner
{
    readonly string kind, name;

    internal Owner(string kind, int index = -1, string name = null)
    {
        this.kind = kind;
        this.name = name;
        Index = index;
    }

    /// <summary>The mesh, or -1.</summary>
    internal int Index { get; private set; }

    public override string ToString()
    {
        string text = Index < 0 ? kind : kind + " " + Index;
        return string.IsNullOrEmpty(name) ? text : text + " (" + name + ")";
    }

    internal InvalidInputException Wrong(string sentence) => new InvalidInputException(Status.BadArgument, ToString() + ": " + sentence, Index);
}
}
