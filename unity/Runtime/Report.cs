namespace SuperDeform
{
/// <summary>What was measured on a body, in its units; heights are along up. NaN: not known.</summary>
public struct Figure
{
    internal Figure(SdefFigure native)
    {
        Height = native.height;
        HeadLength = native.head_length;
        Heads = native.heads;
        Crown = native.crown;
        Chin = native.chin;
        ShoulderLine = native.shoulder_line;
        Crotch = native.crotch;
        Sole = native.sole;
    }

    /// <summary>Extent of all meshes along up.</summary>
    public double Height;

    /// <summary>Chin to crown (product mode), head joint to head top (paper mode).</summary>
    public double HeadLength;

    /// <summary>Crown to sole over crown to chin.</summary>
    public double Heads;

    /// <summary>Height.</summary>
    public double Crown;

    /// <summary>Height.</summary>
    public double Chin;

    /// <summary>Height.</summary>
    public double ShoulderLine;

    /// <summary>Height.</summary>
    public double Crotch;

    /// <summary>Height.</summary>
    public double Sole;
}

/// <summary>The numbers of a run.</summary>
public sealed class Report
{
    internal Report(SdefReport native, Figure target, Figure reference, Figure result)
    {
        RigMade = native.rig_made != 0;
        Target = target;
        Reference = reference;
        Result = result;
        HeadRatio = native.head_ratio;
        UnreachedVertices = (long)native.unreached_vertices;
        FallbackVertices = (long)native.fallback_vertices;
    }

    /// <summary>Whether the rig was made, or was the character's own.</summary>
    public bool RigMade { get; private set; }

    /// <summary>The character before.</summary>
    public Figure Target { get; private set; }

    /// <summary>The style; NaN throughout for a style of N heads.</summary>
    public Figure Reference { get; private set; }

    /// <summary>Measured anew on what comes out.</summary>
    public Figure Result { get; private set; }

    /// <summary>Head of the target over head of the style, times HeadScale (product mode).</summary>
    public double HeadRatio { get; private set; }

    /// <summary>Vertices that the rig left without weights.</summary>
    public long UnreachedVertices { get; private set; }

    /// <summary>Vertices that were weighted by another rule than the chosen one.</summary>
    public long FallbackVertices { get; private set; }
}
}
