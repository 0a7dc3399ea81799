namespace SuperDeform
{
/// <summary>One bone group: what is done to it, and how large it is; NaN where not known.</summary>
public sealed class Group
{
    internal unsafe Group(SdefGroup* native)
    {
        Name = Text.Of(native->name);
        LengthScale = native->length_scale;
        ThicknessScale = native->thickness_scale;
        TargetLength = native->target_length;
        TargetRadius = native->target_radius;
        ReferenceLength = native->reference_length;
        ReferenceRadius = native->reference_radius;
    }

    /// <summary>As in <see cref="GroupSettings.Group"/>; longer names of your own are cut.</summary>
    public string Name { get; private set; }

    /// <summary>1 keeps the length of the group's bones.</summary>
    public double LengthScale { get; private set; }

    /// <summary>1 keeps the thickness.</summary>
    public double ThicknessScale { get; private set; }

    /// <summary>Sum over the character's bones, left and right.</summary>
    public double TargetLength { get; private set; }

    /// <summary>Mean distance of the surface.</summary>
    public double TargetRadius { get; private set; }

    /// <summary>The style's, in its own units.</summary>
    public double ReferenceLength { get; private set; }

    /// <summary>The style's, in its own units.</summary>
    public double ReferenceRadius { get; private set; }
}
}
