namespace SuperDeform
{
/// <summary>What a collider of springs is.</summary>
public enum ColliderKind
{
    /// <summary>A ball around the first point.</summary>
    Sphere = 0,

    /// <summary>Round, from the first point to the second.</summary>
    Capsule = 1,

    /// <summary>Through the first point; the second is its normal, which points to where springs may be.</summary>
    Plane = 2,

    /// <summary>A sphere that springs are kept inside of.</summary>
    InsideSphere = 3,

    /// <summary>A capsule that springs are kept inside of.</summary>
    InsideCapsule = 4
}

/// <summary>A collider of springs; lengths and points in model space.</summary>
public struct SpringCollider
{
    public ColliderKind Kind;

    /// <summary>The joint that it moves with.</summary>
    public uint Joint;

    /// <summary>The springs that it is for: indices into the call's springs; null: none.</summary>
    public uint[] Springs;

    /// <summary>The first point.</summary>
    public double X, Y, Z;

    /// <summary>The second point, or the normal.</summary>
    public double EndX, EndY, EndZ;

    /// <summary>Of spheres and capsules.</summary>
    public double Radius;

    /// <summary>Of a result: the share of its radius that it yields to springs, 0 to 0.2.</summary>
    public double Yielded;

    /// <summary>Of a result: springs that start inside and did not.</summary>
    public uint NewlyInside;
}

/// <summary>The ball that a spring keeps out of colliders, at the end of its bone; model space.</summary>
public struct SpringBall
{
    /// <summary>The joint at the end of the bone.</summary>
    public uint Joint;

    /// <summary>Its middle.</summary>
    public double X, Y, Z;

    public double Radius;
}
}
