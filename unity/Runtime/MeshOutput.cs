using System;

namespace SuperDeform
{
/// <summary>
/// Where the results of one mesh go. Arrays that are null are left out; those that the mesh was given without
/// (normals, tangents, morph targets) must be null. The same arrays may be used again for the next call, and several
/// meshes may write into slices of the same arrays.
/// </summary>
public sealed class MeshOutput
{
    /// <summary>Where the mesh begins in positions, normals and tangents.</summary>
    public int FirstVertex;

    /// <summary>Vertices of the mesh.</summary>
    public int VertexCount;

    /// <summary>Morph targets that the morph arrays have room for.</summary>
    public int MorphTargetCount;

    /// <summary>3 floats a vertex: float[], byte[] or of any struct of 3 floats.</summary>
    public Array Positions;

    /// <summary>3 floats a vertex, unit length.</summary>
    public Array Normals;

    /// <summary>4 floats a vertex, the handedness kept.</summary>
    public Array Tangents;

    /// <summary>3 floats a vertex, all <see cref="VertexCount"/> vertices of one target after the other.</summary>
    public float[] MorphPositions;

    /// <summary>Likewise; 0 for targets that were given without.</summary>
    public float[] MorphNormals;

    /// <summary>Likewise.</summary>
    public float[] MorphTangents;
}
}
