// Meshes: vertex channels, submeshes, skin and blend shapes, with the length and access rules of Unity's scripting reference.
using System;
using System.Collections.Generic;
using Unity.Collections;
using UnityEngine.Rendering;
using UnityStubs;

namespace UnityEngine
{
    public enum MeshTopology { Triangles = 0, Quads = 2, Lines = 3, LineStrip = 4, Points = 5 }

    [Serializable]
    public struct BoneWeight : IEquatable<BoneWeight>
    {
        float m_Weight0, m_Weight1, m_Weight2, m_Weight3;
        int m_BoneIndex0, m_BoneIndex1, m_BoneIndex2, m_BoneIndex3;
        public float weight0 { get { return m_Weight0; } set { m_Weight0 = value; } }
        public float weight1 { get { return m_Weight1; } set { m_Weight1 = value; } }
        public float weight2 { get { return m_Weight2; } set { m_Weight2 = value; } }
        public float weight3 { get { return m_Weight3; } set { m_Weight3 = value; } }
        public int boneIndex0 { get { return m_BoneIndex0; } set { m_BoneIndex0 = value; } }
        public int boneIndex1 { get { return m_BoneIndex1; } set { m_BoneIndex1 = value; } }
        public int boneIndex2 { get { return m_BoneIndex2; } set { m_BoneIndex2 = value; } }
        public int boneIndex3 { get { return m_BoneIndex3; } set { m_BoneIndex3 = value; } }
        internal float Weight(int slot) { return slot == 0 ? m_Weight0 : slot == 1 ? m_Weight1 : slot == 2 ? m_Weight2 : m_Weight3; }
        internal int Bone(int slot) { return slot == 0 ? m_BoneIndex0 : slot == 1 ? m_BoneIndex1 : slot == 2 ? m_BoneIndex2 : m_BoneIndex3; }
        internal void Set(int slot, int bone, float weight)
        {
            switch (slot)
            {
                case 0: m_BoneIndex0 = bone; m_Weight0 = weight; break;
                case 1: m_BoneIndex1 = bone; m_Weight1 = weight; break;
                case 2: m_BoneIndex2 = bone; m_Weight2 = weight; break;
                default: m_BoneIndex3 = bone; m_Weight3 = weight; break;
            }
        }
        public bool Equals(BoneWeight other)
        {
            for (int slot = 0; slot < 4; slot++) if (Bone(slot) != other.Bone(slot) || Weight(slot) != other.Weight(slot)) return false;
            return true;
        }
    }

    [Serializable]
    public struct BoneWeight1 : IEquatable<BoneWeight1>
    {
        float m_Weight;
        int m_BoneIndex;
        public float weight { get { return m_Weight; } set { m_Weight = value; } }
        public int boneIndex { get { return m_BoneIndex; } set { m_BoneIndex = value; } }
        public bool Equals(BoneWeight1 other) { return m_BoneIndex == other.m_BoneIndex && m_Weight == other.m_Weight; }
    }

    public sealed class Mesh : Object
    {
        sealed class SubMesh { public int[] Indices = new int[0]; public MeshTopology Topology; public int BaseVertex; }
        // As Unity keeps them: only vertices that change, 40 bytes each.
        struct BlendShapeVertex { public Vector3 Vertex, Normal, Tangent; public int Index; }
        sealed class Frame { public float Weight; public BlendShapeVertex[] Changes; }
        sealed class Shape { public string Name; public List<Frame> Frames = new List<Frame>(); }

        Vector3[] m_Vertices = new Vector3[0], m_Normals = new Vector3[0];
        Vector4[] m_Tangents = new Vector4[0];
        Color[] m_Colors = new Color[0];
        Vector4[][] m_Uv = new Vector4[8][];
        int[] m_UvDimension = new int[8];
        List<SubMesh> m_SubMeshes = new List<SubMesh> { new SubMesh() };
        List<Shape> m_Shapes = new List<Shape>();
        Matrix4x4[] m_Bindposes = new Matrix4x4[0];
        byte[] m_BonesPerVertex = new byte[0];
        BoneWeight1[] m_BoneWeights = new BoneWeight1[0];
        Bounds m_Bounds;
        IndexFormat m_IndexFormat;
        bool m_Readable = true;

        public Mesh() { }

        public bool isReadable { get { Alive(); return m_Readable; } internal set { m_Readable = value; } }
        public int vertexCount { get { Alive(); return m_Vertices.Length; } }

        // In a mesh that is not readable, a getter logs an error and gives nothing; a setter logs and changes nothing.
        bool May(string channel)
        {
            Alive();
            if (m_Readable) return true;
            Debug.LogError("mesh '" + m_Name + "': its " + channel + " are not readable; turn on Read/Write");
            return false;
        }
        T[] Read<T>(T[] data, string channel) { return May(channel) ? (T[])data.Clone() : new T[0]; }
        void ReadTo<T>(T[] data, List<T> list, string channel)
        {
            if (list == null) throw new ArgumentNullException("list", "there is no list to write to");
            list.Clear();
            if (May(channel)) list.AddRange(data);
        }
        // A channel has one element a vertex, or none.
        bool Fit(int length, string channel)
        {
            if (!May(channel)) return false;
            if (length == 0 || length == m_Vertices.Length) return true;
            Debug.LogError("mesh '" + m_Name + "': " + length + " " + channel + " for " + m_Vertices.Length + " vertices");
            return false;
        }
        // Same size as before: written into the array that is there, so that a live preview allocates nothing.
        static void Store<T>(ref T[] channel, T[] source, int start, int length)
        {
            if (channel == null || channel.Length != length) channel = new T[length];
            if (length > 0) Array.Copy(source, start, channel, 0, length);
        }
        static T[] Items<T>(List<T> list) { return list == null ? new T[0] : list.ToArray(); }

        public Vector3[] vertices { get { return Read(m_Vertices, "vertices"); } set { SetVertices(value ?? new Vector3[0]); } }
        public void GetVertices(List<Vector3> vertices) { ReadTo(m_Vertices, vertices, "vertices"); }
        public void SetVertices(List<Vector3> inVertices) { SetVertices(Items(inVertices)); }
        public void SetVertices(List<Vector3> inVertices, int start, int length) { SetVertices(Items(inVertices), start, length); }
        public void SetVertices(Vector3[] inVertices) { SetVertices(inVertices, 0, inVertices == null ? 0 : inVertices.Length); }
        public void SetVertices(Vector3[] inVertices, int start, int length, MeshUpdateFlags flags) { SetVertices(inVertices, start, length); }
        public void SetVertices(Vector3[] inVertices, int start, int length)
        {
            if (!May("vertices")) return;
            Range(inVertices, start, length);
            if (length != m_Vertices.Length)
            {
                foreach (SubMesh part in m_SubMeshes)
                    foreach (int index in part.Indices)
                        if (index + part.BaseVertex >= length)
                        {
                            Debug.LogError("mesh '" + m_Name + "': a triangle uses vertex " + (index + part.BaseVertex) + ", but there would be " + length);
                            return;
                        }
                // What Unity makes of blend shapes whose mesh changes its size is not documented; nobody should build on it.
                if (m_Shapes.Count > 0) throw new NotSupportedException("the number of vertices of mesh '" + m_Name + "' changes from " + m_Vertices.Length + " to " + length + " while it has blend shapes: call ClearBlendShapes first");
                Resize(ref m_Normals, length); Resize(ref m_Tangents, length); Resize(ref m_Colors, length);
                for (int channel = 0; channel < 8; channel++) if (m_Uv[channel] != null) Resize(ref m_Uv[channel], length);
                m_BonesPerVertex = new byte[0]; m_BoneWeights = new BoneWeight1[0];
            }
            Store(ref m_Vertices, inVertices, start, length);
        }
        public void SetVertices<T>(NativeArray<T> inVertices) where T : struct { SetVertices((Vector3[])(object)inVertices.ToArray()); }
        static void Resize<T>(ref T[] channel, int length) { if (channel.Length > 0) Array.Resize(ref channel, length); }
        static void Range(Array array, int start, int length)
        {
            if (array == null && length == 0) return;
            if (array == null) throw new ArgumentNullException("array");
            if (start < 0) throw new ArgumentOutOfRangeException("start", start, "start must be 0 or more");
            if (length < 0) throw new ArgumentOutOfRangeException("length", length, "length must be 0 or more");
            if (start + length > array.Length) throw new ArgumentOutOfRangeException("length", start + length, "start and length go past the array's " + array.Length + " elements");
        }

        public Vector3[] normals { get { return Read(m_Normals, "normals"); } set { SetNormals(value ?? new Vector3[0]); } }
        public void GetNormals(List<Vector3> normals) { ReadTo(m_Normals, normals, "normals"); }
        public void SetNormals(List<Vector3> inNormals) { SetNormals(Items(inNormals)); }
        public void SetNormals(Vector3[] inNormals) { SetNormals(inNormals, 0, inNormals == null ? 0 : inNormals.Length); }
        public void SetNormals(Vector3[] inNormals, int start, int length, MeshUpdateFlags flags) { SetNormals(inNormals, start, length); }
        public void SetNormals(Vector3[] inNormals, int start, int length) { Range(inNormals, start, length); if (Fit(length, "normals")) Store(ref m_Normals, inNormals, start, length); }
        public void SetNormals<T>(NativeArray<T> inNormals) where T : struct { SetNormals((Vector3[])(object)inNormals.ToArray()); }
        public Vector4[] tangents { get { return Read(m_Tangents, "tangents"); } set { SetTangents(value ?? new Vector4[0]); } }
        public void GetTangents(List<Vector4> tangents) { ReadTo(m_Tangents, tangents, "tangents"); }
        public void SetTangents(List<Vector4> inTangents) { SetTangents(Items(inTangents)); }
        public void SetTangents(Vector4[] inTangents) { SetTangents(inTangents, 0, inTangents == null ? 0 : inTangents.Length); }
        public void SetTangents(Vector4[] inTangents, int start, int length, MeshUpdateFlags flags) { SetTangents(inTangents, start, length); }
        public void SetTangents(Vector4[] inTangents, int start, int length) { Range(inTangents, start, length); if (Fit(length, "tangents")) Store(ref m_Tangents, inTangents, start, length); }
        public void SetTangents<T>(NativeArray<T> inTangents) where T : struct { SetTangents((Vector4[])(object)inTangents.ToArray()); }
        public Color[] colors { get { return Read(m_Colors, "colors"); } set { SetColors(value ?? new Color[0]); } }
        public void GetColors(List<Color> colors) { ReadTo(m_Colors, colors, "colors"); }
        public void SetColors(List<Color> inColors) { SetColors(Items(inColors)); }
        public void SetColors(Color[] inColors) { if (Fit(inColors == null ? 0 : inColors.Length, "colors")) Store(ref m_Colors, inColors, 0, inColors == null ? 0 : inColors.Length); }
        public Color32[] colors32
        {
            get { return May("colors") ? Array.ConvertAll(m_Colors, delegate (Color c) { return (Color32)c; }) : new Color32[0]; }
            set { SetColors(Array.ConvertAll(value ?? new Color32[0], delegate (Color32 c) { return (Color)c; })); }
        }
        public void SetColors(List<Color32> inColors) { colors32 = Items(inColors); }
        public void SetColors(Color32[] inColors) { colors32 = inColors; }

        public Vector2[] uv { get { return Uv(0); } set { SetUVs(0, value); } }
        public Vector2[] uv2 { get { return Uv(1); } set { SetUVs(1, value); } }
        public Vector2[] uv3 { get { return Uv(2); } set { SetUVs(2, value); } }
        public Vector2[] uv4 { get { return Uv(3); } set { SetUVs(3, value); } }
        public Vector2[] uv5 { get { return Uv(4); } set { SetUVs(4, value); } }
        public Vector2[] uv6 { get { return Uv(5); } set { SetUVs(5, value); } }
        public Vector2[] uv7 { get { return Uv(6); } set { SetUVs(6, value); } }
        public Vector2[] uv8 { get { return Uv(7); } set { SetUVs(7, value); } }
        Vector2[] Uv(int channel) { List<Vector2> list = new List<Vector2>(); GetUVs(channel, list); return list.ToArray(); }
        Vector4[] UvOf(int channel)
        {
            if (channel < 0 || channel > 7) throw new ArgumentOutOfRangeException("channel", channel, "UV channels are 0 to 7");
            return May("uv") && m_Uv[channel] != null ? m_Uv[channel] : new Vector4[0];
        }
        public void GetUVs(int channel, List<Vector2> uvs) { uvs.Clear(); foreach (Vector4 v in UvOf(channel)) uvs.Add(new Vector2(v.x, v.y)); }
        public void GetUVs(int channel, List<Vector3> uvs) { uvs.Clear(); foreach (Vector4 v in UvOf(channel)) uvs.Add(new Vector3(v.x, v.y, v.z)); }
        public void GetUVs(int channel, List<Vector4> uvs) { uvs.Clear(); uvs.AddRange(UvOf(channel)); }
        void PutUv(int channel, Vector4[] values, int dimension)
        {
            UvOf(channel);
            if (!Fit(values.Length, "uv" + (channel == 0 ? "" : (channel + 1).ToString()))) return;
            m_Uv[channel] = values.Length == 0 ? null : values;
            m_UvDimension[channel] = values.Length == 0 ? 0 : dimension;
        }
        public void SetUVs(int channel, Vector2[] uvs) { PutUv(channel, Array.ConvertAll(uvs ?? new Vector2[0], delegate (Vector2 v) { return new Vector4(v.x, v.y, 0, 0); }), 2); }
        public void SetUVs(int channel, Vector3[] uvs) { PutUv(channel, Array.ConvertAll(uvs ?? new Vector3[0], delegate (Vector3 v) { return new Vector4(v.x, v.y, v.z, 0); }), 3); }
        public void SetUVs(int channel, Vector4[] uvs) { PutUv(channel, (Vector4[])(uvs ?? new Vector4[0]).Clone(), 4); }
        public void SetUVs(int channel, List<Vector2> uvs) { SetUVs(channel, Items(uvs)); }
        public void SetUVs(int channel, List<Vector3> uvs) { SetUVs(channel, Items(uvs)); }
        public void SetUVs(int channel, List<Vector4> uvs) { SetUVs(channel, Items(uvs)); }

        public bool HasVertexAttribute(VertexAttribute attribute) { return GetVertexAttributeDimension(attribute) > 0; }
        public int GetVertexAttributeDimension(VertexAttribute attribute)
        {
            Alive();
            switch (attribute)
            {
                case VertexAttribute.Position: return m_Vertices.Length > 0 ? 3 : 0;
                case VertexAttribute.Normal: return m_Normals.Length > 0 ? 3 : 0;
                case VertexAttribute.Tangent: return m_Tangents.Length > 0 ? 4 : 0;
                case VertexAttribute.Color: return m_Colors.Length > 0 ? 4 : 0;
                case VertexAttribute.BlendWeight:
                case VertexAttribute.BlendIndices: return m_BoneWeights.Length > 0 ? 4 : 0;
                default: return m_UvDimension[(int)attribute - (int)VertexAttribute.TexCoord0];
            }
        }

        public IndexFormat indexFormat { get { Alive(); return m_IndexFormat; } set { Alive(); m_IndexFormat = value; } }
        public int subMeshCount
        {
            get { Alive(); return m_SubMeshes.Count; }
            set
            {
                if (value < 0) { Debug.LogError("Mesh.subMeshCount can't be negative"); return; }
                while (m_SubMeshes.Count > value) m_SubMeshes.RemoveAt(m_SubMeshes.Count - 1);
                while (m_SubMeshes.Count < value) m_SubMeshes.Add(new SubMesh());
            }
        }
        SubMesh Part(int submesh)
        {
            if (submesh < 0 || submesh >= m_SubMeshes.Count) throw new IndexOutOfRangeException("mesh '" + m_Name + "' has no submesh " + submesh + ": it has " + m_SubMeshes.Count);
            return m_SubMeshes[submesh];
        }
        public int[] triangles
        {
            get
            {
                if (!May("triangles")) return new int[0];
                List<int> all = new List<int>();
                for (int part = 0; part < m_SubMeshes.Count; part++) if (m_SubMeshes[part].Topology == MeshTopology.Triangles) all.AddRange(GetIndices(part));
                return all.ToArray();
            }
            set { if (!May("triangles")) return; subMeshCount = 1; SetTriangles(value ?? new int[0], 0); }
        }
        public int[] GetTriangles(int submesh) { return GetTriangles(submesh, true); }
        public int[] GetTriangles(int submesh, bool applyBaseVertex) { return Part(submesh).Topology == MeshTopology.Triangles ? GetIndices(submesh, applyBaseVertex) : new int[0]; }
        public void GetTriangles(List<int> triangles, int submesh) { triangles.Clear(); triangles.AddRange(GetTriangles(submesh)); }
        public void SetTriangles(int[] triangles, int submesh) { SetIndices(triangles, MeshTopology.Triangles, submesh, true, 0); }
        public void SetTriangles(int[] triangles, int submesh, bool calculateBounds) { SetIndices(triangles, MeshTopology.Triangles, submesh, calculateBounds, 0); }
        public void SetTriangles(int[] triangles, int submesh, bool calculateBounds, int baseVertex) { SetIndices(triangles, MeshTopology.Triangles, submesh, calculateBounds, baseVertex); }
        public void SetTriangles(List<int> triangles, int submesh) { SetTriangles(Items(triangles), submesh); }
        public void SetTriangles(List<int> triangles, int submesh, bool calculateBounds) { SetTriangles(Items(triangles), submesh, calculateBounds); }
        public int[] GetIndices(int submesh) { return GetIndices(submesh, true); }
        public int[] GetIndices(int submesh, bool applyBaseVertex)
        {
            SubMesh part = Part(submesh);
            if (!May("indices")) return new int[0];
            int[] indices = (int[])part.Indices.Clone();
            if (applyBaseVertex && part.BaseVertex != 0) for (int at = 0; at < indices.Length; at++) indices[at] += part.BaseVertex;
            return indices;
        }
        public void GetIndices(List<int> indices, int submesh) { indices.Clear(); indices.AddRange(GetIndices(submesh)); }
        public void GetIndices(List<int> indices, int submesh, bool applyBaseVertex) { indices.Clear(); indices.AddRange(GetIndices(submesh, applyBaseVertex)); }
        public void GetIndices(List<ushort> indices, int submesh) { indices.Clear(); foreach (int index in GetIndices(submesh)) indices.Add((ushort)index); }
        public void SetIndices(List<int> indices, MeshTopology topology, int submesh) { SetIndices(Items(indices), topology, submesh); }
        public void SetIndices(ushort[] indices, MeshTopology topology, int submesh) { SetIndices(Array.ConvertAll(indices, delegate (ushort at) { return (int)at; }), topology, submesh); }
        public void SetIndices(int[] indices, MeshTopology topology, int submesh) { SetIndices(indices, topology, submesh, true, 0); }
        public void SetIndices(int[] indices, MeshTopology topology, int submesh, bool calculateBounds) { SetIndices(indices, topology, submesh, calculateBounds, 0); }
        public void SetIndices(int[] indices, MeshTopology topology, int submesh, bool calculateBounds, int baseVertex)
        {
            SubMesh part = Part(submesh);
            if (!May("indices")) return;
            indices = indices ?? new int[0];
            if (topology == MeshTopology.Triangles && indices.Length % 3 != 0) { Debug.LogError("mesh '" + m_Name + "': " + indices.Length + " corners make no whole triangles"); return; }
            foreach (int index in indices)
            {
                if (index < 0 || index + baseVertex < 0 || index + baseVertex >= m_Vertices.Length)
                {
                    Debug.LogError("mesh '" + m_Name + "': index " + index + ", but there are " + m_Vertices.Length + " vertices");
                    return;
                }
                if (m_IndexFormat == IndexFormat.UInt16 && index > 65535)
                {
                    Debug.LogError("mesh '" + m_Name + "': index " + index + " does not fit 16 bits; set indexFormat to UInt32");
                    return;
                }
            }
            part.Indices = (int[])indices.Clone();
            part.Topology = topology;
            part.BaseVertex = baseVertex;
            if (calculateBounds) RecalculateBounds();
        }
        public MeshTopology GetTopology(int submesh) { return Part(submesh).Topology; }
        public uint GetIndexCount(int submesh) { return (uint)Part(submesh).Indices.Length; }
        public uint GetBaseVertex(int submesh) { return (uint)Part(submesh).BaseVertex; }
        public uint GetIndexStart(int submesh)
        {
            Part(submesh);
            uint start = 0;
            for (int part = 0; part < submesh; part++) start += (uint)m_SubMeshes[part].Indices.Length;
            return start;
        }
        public SubMeshDescriptor GetSubMesh(int index)
        {
            SubMesh part = Part(index);
            SubMeshDescriptor told = new SubMeshDescriptor((int)GetIndexStart(index), part.Indices.Length, part.Topology);
            told.baseVertex = part.BaseVertex;
            if (part.Indices.Length == 0) return told;
            int first = int.MaxValue, last = 0;
            foreach (int at in part.Indices) { first = Math.Min(first, at + part.BaseVertex); last = Math.Max(last, at + part.BaseVertex); }
            told.firstVertex = first;
            told.vertexCount = last - first + 1;
            told.bounds = BoundsOf(m_Vertices, first, told.vertexCount);
            return told;
        }

        public Matrix4x4[] bindposes { get { Alive(); return (Matrix4x4[])m_Bindposes.Clone(); } set { Alive(); m_Bindposes = value == null ? new Matrix4x4[0] : (Matrix4x4[])value.Clone(); } }
        public void GetBindposes(List<Matrix4x4> bindposes) { bindposes.Clear(); bindposes.AddRange(m_Bindposes); }

        public NativeArray<byte> GetBonesPerVertex() { return NativeArray<byte>.View(Read(m_BonesPerVertex, "bone weights")); }
        public NativeArray<BoneWeight1> GetAllBoneWeights() { return NativeArray<BoneWeight1>.View(Read(m_BoneWeights, "bone weights")); }

        // Documented: as many counts as vertices, as many weights as the counts' sum, each vertex's weights descending; zeros are
        // left out, and at least 16 bits of a weight are kept: here, just those.
        public void SetBoneWeights(NativeArray<byte> bonesPerVertex, NativeArray<BoneWeight1> weights)
        {
            if (!May("bone weights")) return;
            if (bonesPerVertex.Length != m_Vertices.Length && !(bonesPerVertex.Length == 0 && weights.Length == 0))
                throw new ArgumentException("bonesPerVertex has " + bonesPerVertex.Length + " elements; the mesh has " + m_Vertices.Length + " vertices", "bonesPerVertex");
            int sum = 0;
            foreach (byte count in bonesPerVertex) sum += count;
            if (sum != weights.Length) throw new ArgumentException("bonesPerVertex sums to " + sum + "; there are " + weights.Length + " weights", "weights");
            BoneWeight1[] stored = weights.ToArray();
            List<BoneWeight1> kept = new List<BoneWeight1>(stored.Length);
            byte[] counts = bonesPerVertex.ToArray();
            int at = 0;
            for (int vertex = 0; vertex < bonesPerVertex.Length; vertex++)
            {
                float last = float.PositiveInfinity;
                int end = at + bonesPerVertex[vertex];
                for (; at < end; at++)
                {
                    float weight = stored[at].weight;
                    if (!(weight >= 0f)) throw new ArgumentException("vertex " + vertex + " has weight " + weight + ": weights must be 0 or more", "weights");
                    if (weight > last) throw new ArgumentException("the weights of vertex " + vertex + " rise from " + last + " to " + weight + ": they must descend", "weights");
                    if (stored[at].boneIndex < 0) throw new ArgumentException("vertex " + vertex + " names bone " + stored[at].boneIndex, "weights");
                    last = weight;
                    stored[at].weight = (float)(Math.Round(Math.Min(weight, 1f) * 65535.0) / 65535.0);
                    if (weight > 0f) kept.Add(stored[at]); else counts[vertex]--;
                }
            }
            m_BonesPerVertex = counts;
            m_BoneWeights = kept.ToArray();
        }
        public BoneWeight[] boneWeights
        {
            // The four greatest of each vertex, made to sum to 1.
            get
            {
                if (!May("bone weights")) return new BoneWeight[0];
                BoneWeight[] all = new BoneWeight[m_BonesPerVertex.Length];
                int at = 0;
                for (int vertex = 0; vertex < all.Length; vertex++)
                {
                    int count = m_BonesPerVertex[vertex], used = Math.Min(count, 4);
                    float sum = 0f;
                    for (int slot = 0; slot < used; slot++) sum += m_BoneWeights[at + slot].weight;
                    for (int slot = 0; slot < used; slot++) all[vertex].Set(slot, m_BoneWeights[at + slot].boneIndex, count > 4 && sum > 0f ? m_BoneWeights[at + slot].weight / sum : m_BoneWeights[at + slot].weight);
                    at += count;
                }
                return all;
            }
            set
            {
                if (!May("bone weights")) return;
                if (value == null) value = new BoneWeight[0];
                if (value.Length != 0 && value.Length != m_Vertices.Length) { Debug.LogError("mesh '" + m_Name + "': " + value.Length + " bone weights for " + m_Vertices.Length + " vertices"); return; }
                List<BoneWeight1> weights = new List<BoneWeight1>();
                byte[] counts = new byte[value.Length];
                for (int vertex = 0; vertex < value.Length; vertex++)
                {
                    List<BoneWeight1> row = new List<BoneWeight1>();
                    for (int slot = 0; slot < 4; slot++)
                    {
                        if (value[vertex].Weight(slot) <= 0f) continue;
                        BoneWeight1 one = new BoneWeight1(); one.boneIndex = value[vertex].Bone(slot); one.weight = value[vertex].Weight(slot);
                        int place = row.Count;
                        while (place > 0 && row[place - 1].weight < one.weight) place--;
                        row.Insert(place, one);
                    }
                    counts[vertex] = (byte)row.Count;
                    weights.AddRange(row);
                }
                m_BonesPerVertex = counts;
                m_BoneWeights = weights.ToArray();
            }
        }

        public int blendShapeCount { get { Alive(); return m_Shapes.Count; } }
        Shape ShapeAt(int index)
        {
            Alive();
            if (index < 0 || index >= m_Shapes.Count) throw new IndexOutOfRangeException("Blend shape index " + index + " is out of range: the mesh has " + m_Shapes.Count);
            return m_Shapes[index];
        }
        Frame FrameAt(int shape, int frame)
        {
            Shape of = ShapeAt(shape);
            if (frame < 0 || frame >= of.Frames.Count) throw new IndexOutOfRangeException("Blend shape frame index " + frame + " is out of range: '" + of.Name + "' has " + of.Frames.Count);
            return of.Frames[frame];
        }
        public string GetBlendShapeName(int shapeIndex) { return ShapeAt(shapeIndex).Name; }
        public int GetBlendShapeIndex(string blendShapeName) { Alive(); return m_Shapes.FindIndex(delegate (Shape shape) { return shape.Name == blendShapeName; }); }
        public int GetBlendShapeFrameCount(int shapeIndex) { return ShapeAt(shapeIndex).Frames.Count; }
        public float GetBlendShapeFrameWeight(int shapeIndex, int frameIndex) { return FrameAt(shapeIndex, frameIndex).Weight; }
        public void GetBlendShapeFrameVertices(int shapeIndex, int frameIndex, Vector3[] deltaVertices, Vector3[] deltaNormals, Vector3[] deltaTangents)
        {
            Frame frame = FrameAt(shapeIndex, frameIndex);
            Ready(deltaVertices, "deltaVertices"); Ready(deltaNormals, "deltaNormals"); Ready(deltaTangents, "deltaTangents");
            foreach (BlendShapeVertex change in frame.Changes)
            {
                if (deltaVertices != null) deltaVertices[change.Index] = change.Vertex;
                if (deltaNormals != null) deltaNormals[change.Index] = change.Normal;
                if (deltaTangents != null) deltaTangents[change.Index] = change.Tangent;
            }
        }
        void Ready(Vector3[] to, string argument)
        {
            if (to == null) return;
            if (to.Length != m_Vertices.Length) throw new ArgumentException(argument + " has " + to.Length + " elements; the mesh has " + m_Vertices.Length + " vertices", argument);
            Array.Clear(to, 0, to.Length);
        }
        public void AddBlendShapeFrame(string shapeName, float frameWeight, Vector3[] deltaVertices, Vector3[] deltaNormals, Vector3[] deltaTangents)
        {
            if (!May("blend shapes")) return;
            if (string.IsNullOrEmpty(shapeName)) throw new ArgumentException("a blend shape needs a name", "shapeName");
            if (deltaVertices == null) throw new ArgumentNullException("deltaVertices");
            foreach (Vector3[] deltas in new[] { deltaVertices, deltaNormals, deltaTangents })
                if (deltas != null && deltas.Length != m_Vertices.Length) throw new ArgumentException("blend shape '" + shapeName + "' has " + deltas.Length + " deltas; the mesh has " + m_Vertices.Length + " vertices");
            Shape shape = m_Shapes.Find(delegate (Shape known) { return known.Name == shapeName; });
            if (shape == null) m_Shapes.Add(shape = new Shape { Name = shapeName });
            else if (shape.Frames[shape.Frames.Count - 1].Weight >= frameWeight)
                throw new ArgumentException("frame weight " + frameWeight + " of blend shape '" + shapeName + "' does not exceed the last one, " + shape.Frames[shape.Frames.Count - 1].Weight, "frameWeight");
            shape.Frames.Add(new Frame { Weight = frameWeight, Changes = Changes(deltaVertices, deltaNormals, deltaTangents) });
        }
        BlendShapeVertex[] Changes(Vector3[] vertices, Vector3[] normals, Vector3[] tangents)
        {
            int count = 0;
            for (int vertex = 0; vertex < m_Vertices.Length; vertex++)
                if (IsChange(vertices, vertex) || IsChange(normals, vertex) || IsChange(tangents, vertex)) count++;
            BlendShapeVertex[] changes = new BlendShapeVertex[count];
            for (int vertex = 0, at = 0; vertex < m_Vertices.Length; vertex++)
                if (IsChange(vertices, vertex) || IsChange(normals, vertex) || IsChange(tangents, vertex))
                    changes[at++] = new BlendShapeVertex { Index = vertex, Vertex = vertices[vertex], Normal = normals == null ? Vector3.zero : normals[vertex], Tangent = tangents == null ? Vector3.zero : tangents[vertex] };
            return changes;
        }
        // Not by ==, which lets small ones pass as none; what is no number is kept.
        static bool IsChange(Vector3[] deltas, int vertex)
        {
            return deltas != null && !(deltas[vertex].x == 0 && deltas[vertex].y == 0 && deltas[vertex].z == 0);
        }
        public void ClearBlendShapes()
        {
            if (!May("blend shapes")) return;
            long changes = 0;
            foreach (Shape shape in m_Shapes) foreach (Frame frame in shape.Frames) changes += frame.Changes.Length;
            m_Shapes.Clear();
            // Unity keeps them outside of what is collected by and by: they are gone at once.
            if (changes > 1 << 20) GC.Collect();
        }

        public Bounds bounds { get { Alive(); return m_Bounds; } set { Alive(); m_Bounds = value; } }
        public void RecalculateBounds() { if (May("vertices")) m_Bounds = BoundsOf(m_Vertices, 0, m_Vertices.Length); }
        public void RecalculateBounds(MeshUpdateFlags flags) { RecalculateBounds(); }
        static Bounds BoundsOf(Vector3[] points, int first, int count)
        {
            if (count == 0) return new Bounds();
            Vector3 low = points[first], high = low;
            for (int at = first + 1; at < first + count; at++) { low = Vector3.Min(low, points[at]); high = Vector3.Max(high, points[at]); }
            Bounds box = new Bounds(); box.SetMinMax(low, high); return box;
        }
        public void RecalculateNormals()
        {
            if (!May("normals")) return;
            Vector3[] sums = new Vector3[m_Vertices.Length];
            int[] corners = triangles;
            for (int at = 0; at + 2 < corners.Length; at += 3)
            {
                Vector3 a = m_Vertices[corners[at]], face = Vector3.Cross(m_Vertices[corners[at + 1]] - a, m_Vertices[corners[at + 2]] - a);
                for (int corner = 0; corner < 3; corner++) sums[corners[at + corner]] += face;
            }
            for (int vertex = 0; vertex < sums.Length; vertex++) sums[vertex] = sums[vertex].sqrMagnitude > 0f ? sums[vertex] / sums[vertex].magnitude : Vector3.zero;
            m_Normals = sums;
        }
        public void RecalculateNormals(MeshUpdateFlags flags) { RecalculateNormals(); }
        public void MarkDynamic() { Alive(); }
        public void MarkModified() { Alive(); }
        public void UploadMeshData(bool markNoLongerReadable) { Alive(); if (markNoLongerReadable) m_Readable = false; }
        public void Clear() { Clear(true); }
        public void Clear(bool keepVertexLayout)
        {
            if (!May("vertices")) return;
            m_Vertices = new Vector3[0]; m_Normals = new Vector3[0]; m_Tangents = new Vector4[0]; m_Colors = new Color[0];
            m_Uv = new Vector4[8][]; m_UvDimension = new int[8];
            m_SubMeshes = new List<SubMesh> { new SubMesh() };
            m_Shapes = new List<Shape>();
            m_Bindposes = new Matrix4x4[0]; m_BonesPerVertex = new byte[0]; m_BoneWeights = new BoneWeight1[0];
            m_Bounds = new Bounds();
        }
    }
}

namespace UnityEngine.Rendering
{
    public enum GraphicsDeviceType { Null = 4, Vulkan = 21 }
    public enum IndexFormat { UInt16 = 0, UInt32 = 1 }
    [Flags] public enum MeshUpdateFlags { Default = 0, DontValidateIndices = 1, DontResetBoneBounds = 2, DontNotifyMeshUsers = 4, DontRecalculateBounds = 8 }
    public enum VertexAttribute { Position = 0, Normal, Tangent, Color, TexCoord0, TexCoord1, TexCoord2, TexCoord3, TexCoord4, TexCoord5, TexCoord6, TexCoord7, BlendWeight, BlendIndices }
    public struct SubMeshDescriptor
    {
        public SubMeshDescriptor(int indexStart, int indexCount) : this(indexStart, indexCount, MeshTopology.Triangles) { }
        public SubMeshDescriptor(int indexStart, int indexCount, MeshTopology topology) : this() { this.indexStart = indexStart; this.indexCount = indexCount; this.topology = topology; }
        public Bounds bounds { get; set; }
        public MeshTopology topology { get; set; }
        public int indexStart { get; set; }
        public int indexCount { get; set; }
        public int baseVertex { get; set; }
        public int firstVertex { get; set; }
        public int vertexCount { get; set; }
    }
    public enum ShadowCastingMode { Off, On, TwoSided, ShadowsOnly }
    public enum LightProbeUsage { Off = 0, BlendProbes = 1, UseProxyVolume = 2, CustomProvided = 4 }
    public enum ReflectionProbeUsage { Off, BlendProbes, BlendProbesAndSkybox, Simple }
}
