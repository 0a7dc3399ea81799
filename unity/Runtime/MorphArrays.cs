using System;

namespace SuperDeform
{
/// <summary>
/// A morph target (blend shape): what is added to each vertex of a mesh at weight 1. Each array has 3 floats a vertex,
/// as float[], byte[] or of any struct of 3 floats, for every vertex of the mesh.
/// </summary>
public sealed class MorphArrays
{
    /// <summary>For messages. May be null.</summary>
    public string Name;

    /// <summary>Where the mesh begins in the arrays.</summary>
    public int FirstVertex;

    /// <summary>Model units.</summary>
    public Array Positions;

    /// <summary>May be null.</summary>
    public Array Normals;

    /// <summary>Changes of the direction. May be null.</summary>
    public Array Tangents;
}
}
