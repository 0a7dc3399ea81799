using System;
using System.Collections.Generic;
using System.Runtime.InteropServices;

namespace SuperDeform
{
/// <summary>
/// The arrays of meshes and skeletons as the library's structs. How long an array is only this side knows, so it is
/// checked here; what is in it the library checks.
/// </summary>
internal static unsafe class MarshalMeshes
{
    internal static void Fill(this MarshalScope scope, SdefMesh* mesh, MeshArrays arrays, int index)
    {
        var owner = new Owner("mesh", index, arrays == null ? null : arrays.Name);
        if (arrays == null) throw owner.Wrong("it is null: give its arrays");
        int count = VertexCount(arrays, owner);
        if (arrays.FirstVertex < 0) throw owner.Wrong("FirstVertex is " + arrays.FirstVertex + ": give 0 or more");
        mesh->struct_size = (uint)sizeof(SdefMesh);
        mesh->kind = (uint)arrays.Kind;
        mesh->name = scope.Text(arrays.Name);
        mesh->vertex_count = (UIntPtr)(uint)count;
        mesh->positions = Vectors(scope, arrays.Positions, owner, "Positions", 3, arrays.FirstVertex, count);
        mesh->normals = Vectors(scope, arrays.Normals, owner, "Normals", 3, arrays.FirstVertex, count);
        mesh->tangents = Vectors(scope, arrays.Tangents, owner, "Tangents", 4, arrays.FirstVertex, count);
        if (arrays.Luminance != null)
        {
            CheckLength(arrays.Luminance, owner, "Luminance", (long)arrays.FirstVertex + count);
            mesh->luminance = (byte*)scope.Pin(arrays.Luminance, "Luminance") + arrays.FirstVertex;
        }
        mesh->uvs = Vectors(scope, arrays.Uvs, owner, "Uvs", 2, arrays.FirstVertex, count);
        mesh->image = unchecked((uint)arrays.Image);
        FillIndices(scope, mesh, arrays, owner);
        if (arrays.RowStarts != null) FillRows(scope, mesh, arrays, owner, count);
        else if (arrays.Joints != null || arrays.Weights != null) FillFixed(scope, mesh, arrays, owner, count);
    }

    internal static void Fill(this MarshalScope scope, SdefMorphTarget* target, MorphArrays arrays, int mesh, int count)
    {
        var owner = new Owner("morph target of mesh", mesh, arrays.Name);
        target->struct_size = (uint)sizeof(SdefMorphTarget);
        target->name = scope.Text(arrays.Name);
        target->positions = Vectors(scope, arrays.Positions, owner, "Positions", 3, arrays.FirstVertex, count);
        target->normals = Vectors(scope, arrays.Normals, owner, "Normals", 3, arrays.FirstVertex, count);
        target->tangents = Vectors(scope, arrays.Tangents, owner, "Tangents", 3, arrays.FirstVertex, count);
    }

    internal static void Fill(this MarshalScope scope, SdefSkeleton* skeleton, SkeletonArrays arrays)
    {
        var owner = new Owner("skeleton");
        if (arrays.Parents == null) throw owner.Wrong("Parents is null: give one a joint");
        int count = arrays.Parents.Length;
        CheckLength(arrays.Names, owner, "Names", count);
        if (arrays.RestMatrices == null) throw owner.Wrong("RestMatrices is null: give 16 a joint");
        CheckLength(arrays.RestMatrices, owner, "RestMatrices", 16L * count);
        skeleton->struct_size = (uint)sizeof(SdefSkeleton);
        skeleton->joint_count = (UIntPtr)(uint)count;
        skeleton->parents = (int*)scope.Pin(arrays.Parents, "Parents");
        skeleton->rest_matrices = (double*)scope.Pin(arrays.RestMatrices, "RestMatrices");
        skeleton->role_joints = (int*)scope.Pin(arrays.RoleJoints, "RoleJoints");
        skeleton->role_count = arrays.RoleJoints == null ? 0 : (uint)arrays.RoleJoints.Length;
        if (arrays.Names == null) return;
        skeleton->names = (sbyte**)scope.Alloc(count * sizeof(sbyte*));
        for (int joint = 0; joint < count; joint++) skeleton->names[joint] = scope.Text(arrays.Names[joint]);
    }

    internal static SdefMeshResult* Results(this MarshalScope scope, IList<MeshOutput> outputs)
    {
        int count = outputs.Count;
        SdefMeshResult* results = (SdefMeshResult*)scope.Alloc(checked(count * sizeof(SdefMeshResult)));
        for (int mesh = 0; mesh < count; mesh++) Fill(scope, results + mesh, outputs[mesh], mesh);
        return results;
    }

    static void Fill(MarshalScope scope, SdefMeshResult* result, MeshOutput output, int mesh)
    {
        var owner = new Owner("output", mesh);
        if (output == null) throw owner.Wrong("it is null: give one with null arrays for what is left out");
        int count = output.VertexCount, targets = output.MorphTargetCount;
        if (count < 0 || targets < 0)
        {
            throw owner.Wrong("VertexCount " + count + " and MorphTargetCount " + targets
                + " must be 0 or more");
        }
        result->struct_size = (uint)sizeof(SdefMeshResult);
        result->vertex_capacity = (UIntPtr)(uint)count;
        result->morph_target_capacity = (uint)targets;
        result->positions = Vectors(scope, output.Positions, owner, "Positions", 3, output.FirstVertex, count);
        result->normals = Vectors(scope, output.Normals, owner, "Normals", 3, output.FirstVertex, count);
        result->tangents = Vectors(scope, output.Tangents, owner, "Tangents", 4, output.FirstVertex, count);
        long floats = 3L * count * targets;
        result->morph_positions = Packed(scope, output.MorphPositions, owner, "MorphPositions", floats);
        result->morph_normals = Packed(scope, output.MorphNormals, owner, "MorphNormals", floats);
        result->morph_tangents = Packed(scope, output.MorphTangents, owner, "MorphTangents", floats);
    }

    /// <summary>How many vertices a mesh has.</summary>
    static int VertexCount(MeshArrays arrays, Owner owner)
    {
        if (arrays.VertexCount >= 0) return arrays.VertexCount;
        if (arrays.Positions == null) return 0;
        return (int)Math.Max(0, Bytes(arrays.Positions, owner, "Positions", 3) / 12 - arrays.FirstVertex);
    }

    /// <summary>The address of one vertex of an array, from which on `count` vertices are wanted.</summary>
    internal static float* Vectors(MarshalScope scope, Array array, Owner owner, string name, int floats, int first,
        int count)
    {
        if (array == null) return null;
        long bytes = Bytes(array, owner, name, floats), stride = 4 * floats;
        if (first < 0 || (first + (long)count) * stride > bytes)
        {
            throw owner.Wrong(name + " holds " + bytes / stride + " vertices, but vertices " + first
                + " to " + (first + (long)count - 1)
                + " are asked for: give all of them, or other FirstVertex and VertexCount");
        }
        byte* start = scope.Pin(array, name);
        return start == null ? null : (float*)(start + first * stride);
    }

    // Bytes of an array of vectors.
    static long Bytes(Array array, Owner owner, string name, int floats)
    {
        Type element = array.GetType().GetElementType();
        if (element == typeof(float)) return 4L * array.Length;
        if (element == typeof(byte)) return array.Length;
        if (element.IsValueType && !element.IsPrimitive && !element.IsEnum)
        {
            int size = Marshal.SizeOf(element);
            if (size == 4 * floats) return (long)size * array.Length;
        }
        throw owner.Wrong(name + " is an array of " + element.Name + ": give float[], or structs of " + floats
            + " floats");
    }

    static void FillIndices(MarshalScope scope, SdefMesh* mesh, MeshArrays arrays, Owner owner)
    {
        if (arrays.Indices == null)
        {
            if (arrays.IndexCount <= 0) return;
            throw owner.Wrong("Indices is null, but IndexCount is " + arrays.IndexCount);
        }
        Type element = arrays.Indices.GetType().GetElementType();
        int size;
        if (element == typeof(ushort)) size = 2;
        else if (element == typeof(uint) || element == typeof(int)) size = 4;
        else if (element == typeof(byte)) size = 1;
        else throw owner.Wrong("Indices is an array of " + element.Name
            + ": give ushort[], uint[], int[] or byte[]");
        int first = arrays.FirstIndex, length = arrays.Indices.Length;
        int count = arrays.IndexCount >= 0 ? arrays.IndexCount : length - first;
        if (first < 0 || count < 0 || first + (long)count > length)
        {
            throw owner.Wrong("Indices holds " + length + " numbers, but FirstIndex is " + first
                + " and IndexCount " + count + ": name a part of them");
        }
        byte* start = scope.Pin(arrays.Indices, "Indices");
        mesh->indices = start == null ? null : start + (long)first * size;
        mesh->index_count = (UIntPtr)(uint)count;
        mesh->index_type = size == 4 ? Native.SDEF_TYPE_U32
            : size == 2 ? Native.SDEF_TYPE_U16 : Native.SDEF_TYPE_U8;
    }

    static void FillFixed(MarshalScope scope, SdefMesh* mesh, MeshArrays arrays, Owner owner, int count)
    {
        int each = arrays.InfluenceCount;
        if (each < 1) throw owner.Wrong("InfluenceCount is " + each
            + ": say how many joints and weights each vertex has, or give RowStarts");
        long first = (long)arrays.FirstVertex * each, end = first + (long)count * each;
        CheckWeights(arrays, owner, end);
        mesh->influence_count = (UIntPtr)(uint)each;
        Weights(scope, mesh, arrays, first);
    }

    static void FillRows(MarshalScope scope, SdefMesh* mesh, MeshArrays arrays, Owner owner, int count)
    {
        uint[] rows = arrays.RowStarts;
        int first = arrays.FirstVertex;
        if (first < 0 || first + (long)count + 1 > rows.Length)
        {
            throw owner.Wrong("RowStarts holds " + rows.Length + " numbers, but vertices " + first + " to "
                + (first + (long)count - 1) + " need " + (first + (long)count + 1));
        }
        uint start = rows[first], end = rows[first + count];
        if (end < start) throw owner.Wrong("RowStarts falls from " + start + " to " + end + ": it must rise");
        CheckWeights(arrays, owner, end);
        mesh->influence_count = (UIntPtr)(end - start);
        Weights(scope, mesh, arrays, start);
        if (first == 0 && start == 0)
        {
            mesh->row_starts = (uint*)scope.Pin(rows, "RowStarts");
            return;
        }
        // The library's rows rise from 0: those of a slice are counted anew.
        uint* own = (uint*)scope.Alloc(checked((count + 1) * sizeof(uint)));
        for (int vertex = 0; vertex <= count; vertex++) own[vertex] = unchecked(rows[first + vertex] - start);
        mesh->row_starts = own;
    }

    static void CheckWeights(MeshArrays arrays, Owner owner, long needed)
    {
        if (arrays.Joints == null || arrays.Weights == null)
        {
            throw owner.Wrong((arrays.Joints == null ? "Joints" : "Weights")
                + " is null, but the other is not: give both or neither");
        }
        CheckLength(arrays.Joints, owner, "Joints", needed);
        CheckLength(arrays.Weights, owner, "Weights", needed);
    }

    static void Weights(MarshalScope scope, SdefMesh* mesh, MeshArrays arrays, long first)
    {
        uint* joints = (uint*)scope.Pin(arrays.Joints, "Joints");
        float* weights = (float*)scope.Pin(arrays.Weights, "Weights");
        if (joints == null) return;
        mesh->joints = joints + first;
        mesh->weights = weights + first;
    }

    static float* Packed(MarshalScope scope, float[] array, Owner owner, string name, long needed)
    {
        CheckLength(array, owner, name, needed);
        return (float*)scope.Pin(array, name);
    }

    static void CheckLength(Array array, Owner owner, string name, long needed)
    {
        if (array == null || array.Length >= needed) return;
        throw owner.Wrong(name + " holds " + array.Length + " elements, but " + needed
            + " are needed");
    }
}
}
