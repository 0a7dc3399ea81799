using System;

namespace SuperDeform
{
/// <summary>
/// The arrays of one mesh, in rest pose and model space. They are read during the call that they are given to, and
/// neither copied nor kept.
/// Arrays of vectors are float[], byte[] or of any struct of 3 (tangents: 4) floats, such as Unity's Vector3[].
/// Several meshes may be slices of the same arrays: this one has <see cref="VertexCount"/> vertices from
/// <see cref="FirstVertex"/> on, in all arrays that go by vertex, weights among them.
/// </summary>
public sealed class MeshArrays
{
    /// <summary>
    /// For messages, and for guessing the kind, as in "node/mesh/material", of which the last that says one counts. May
    /// be null.
    /// </summary>
    public string Name;

    /// <summary>What it is of a character.</summary>
    public MeshKind Kind;

    /// <summary>Where the mesh begins in the arrays; indices count from there as 0.</summary>
    public int FirstVertex;

    /// <summary>Vertices; -1 (default): all from <see cref="FirstVertex"/> on.</summary>
    public int VertexCount = -1;

    /// <summary>3 floats a vertex, model units.</summary>
    public Array Positions;

    /// <summary>3 floats a vertex, unit length. May be null.</summary>
    public Array Normals;

    /// <summary>4 floats a vertex: a unit vector and the handedness. May be null.</summary>
    public Array Tangents;

    /// <summary>3 vertices a triangle: ushort[], uint[], int[] or byte[].</summary>
    public Array Indices;

    /// <summary>Where the mesh begins in <see cref="Indices"/>.</summary>
    public int FirstIndex;

    /// <summary>3 times the triangles; -1 (default): all from <see cref="FirstIndex"/> on.</summary>
    public int IndexCount = -1;

    /// <summary>
    /// Vertex v has the joints and weights RowStarts[v] to RowStarts[v + 1] - 1, so it has one number more than there
    /// are vertices, in a slice too: FirstVertex + VertexCount + 1 or more. Null: each vertex has
    /// <see cref="InfluenceCount"/>.
    /// </summary>
    public uint[] RowStarts;

    /// <summary>Indices of joints. Null, with <see cref="Weights"/>: the mesh has no rig, or waits for one.</summary>
    public uint[] Joints;

    /// <summary>A weight, 0 or more, for each of <see cref="Joints"/>; a vertex's are scaled to sum 1.</summary>
    public float[] Weights;

    /// <summary>
    /// How bright the surface is, from black (0) to white (255) as screens show it: by this, or by <see cref="Uvs"/> and
    /// <see cref="Image"/>, the face step sees painted irises and brows. May be null.
    /// </summary>
    public byte[] Luminance;

    /// <summary>2 floats a vertex, (0, 0) at the image's first pixel: float[], or any struct of 2 floats. May be null.</summary>
    public Array Uvs;

    /// <summary>What <see cref="Character.AddImage"/> gave for the image that the mesh shows, or 0.</summary>
    public int Image;

    /// <summary>Joints a vertex where <see cref="RowStarts"/> is null.</summary>
    public int InfluenceCount;
}
}
