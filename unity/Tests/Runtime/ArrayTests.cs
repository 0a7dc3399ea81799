using System;
using NUnit.Framework;

namespace SuperDeform.Tests
{
/// <summary>The same mesh in every form in which its arrays may come.</summary>
[TestFixture]
public sealed class ArrayTests
{
    static readonly Mannequin figure = new Mannequin();

    [Test]
    public void Structs_floats_and_bytes_are_the_same()
    {
        MeshOutput expected = Deformed(figure.Mesh(), Mannequin.Output(figure.VertexCount));
        MeshArrays mesh = figure.Mesh();
        mesh.Positions = Floats(figure.Positions);
        mesh.Normals = Floats(figure.Normals);
        MeshOutput output = Deformed(mesh, new MeshOutput { VertexCount = figure.VertexCount,
            Positions = new float[3 * figure.VertexCount], Tangents = new float[4 * figure.VertexCount] });
        Assert.AreEqual(Floats((Triple[])expected.Positions), output.Positions);

        float[] positions = (float[])mesh.Positions;
        byte[] bytes = new byte[4 * positions.Length];
        Buffer.BlockCopy(positions, 0, bytes, 0, bytes.Length);
        mesh.Positions = bytes;
        var bytesOut = new MeshOutput { VertexCount = figure.VertexCount, Positions = new byte[bytes.Length] };
        Deformed(mesh, bytesOut);
        float[] back = new float[positions.Length];
        Buffer.BlockCopy(bytesOut.Positions, 0, back, 0, bytes.Length);
        Assert.AreEqual(output.Positions, back);
    }

    [Test]
    public void Indices_of_every_width_are_the_same()
    {
        MeshOutput expected = Deformed(figure.Mesh(), Mannequin.Output(figure.VertexCount));
        foreach (Array indices in new Array[] { Array.ConvertAll(figure.Indices, i => (uint)i),
            Array.ConvertAll(figure.Indices, i => (int)i) })
        {
            MeshArrays mesh = figure.Mesh();
            mesh.Indices = indices;
            AssertSame(expected, Deformed(mesh, Mannequin.Output(figure.VertexCount)));
        }
        using (var character = new Character())
        {
            character.AddMesh(new MeshArrays { Positions = new Triple[3], Indices = new byte[] { 0, 1, 2 } });
            Assert.AreEqual(1, character.Info.TriangleCount);
        }
    }

    [Test]
    public void Rows_of_weights_and_a_fixed_number_are_the_same()
    {
        MeshOutput expected = Deformed(figure.Mesh(), Mannequin.Output(figure.VertexCount));
        AssertSame(expected, Deformed(InRows(figure.Mesh()), Mannequin.Output(figure.VertexCount)));
    }

    [Test]
    public void Slices_of_shared_arrays_are_meshes()
    {
        AssertSlices(mesh => mesh);
    }

    [Test]
    public void Slices_of_rows_are_meshes()
    {
        AssertSlices(InRows);
    }

    [Test]
    public void Rows_of_a_slice_are_its_own_where_those_before_it_are_empty()
    {
        var mesh = new MeshArrays { Positions = new Triple[5], FirstVertex = 2, VertexCount = 3,
            RowStarts = new uint[] { 0, 0, 0, 1, 2, 3 }, Joints = new uint[] { 3, 4, 5 },
            Weights = new[] { 1f, 1f, 1f } };
        using (var character = new Character())
        {
            character.SetSkeleton(figure.Skeleton);
            character.AddMesh(mesh);
            uint[] joints = new uint[3];
            character.GetWeights(0, 1, joints, new float[3]);
            Assert.AreEqual(mesh.Joints, joints);
        }
    }

    [Test]
    public void A_slice_writes_its_own_part_alone()
    {
        const int before = 5, after = 3;
        MeshOutput expected = Deformed(figure.Mesh(), Mannequin.Output(figure.VertexCount));
        MeshOutput output = Mannequin.Output(before + figure.VertexCount + after);
        output.FirstVertex = before;
        output.VertexCount = figure.VertexCount;
        var untouched = new Triple(-1, -2, -3);
        Triple[] positions = (Triple[])output.Positions;
        for (int i = 0; i < positions.Length; i++) positions[i] = untouched;
        Deformed(figure.Mesh(), output);
        for (int i = 0; i < positions.Length; i++)
        {
            bool inside = i >= before && i < before + figure.VertexCount;
            Triple wanted = inside ? ((Triple[])expected.Positions)[i - before] : untouched;
            Assert.AreEqual(wanted, positions[i], "vertex " + i);
        }
    }

    [Test]
    public void Morph_targets_come_out_packed_from_slices()
    {
        using (var character = new Character())
        using (Style style = Style.FromHeads(2.5))
        {
            character.SetSkeleton(figure.Skeleton);
            int first = 3 * Mannequin.PartVertices;
            AddParts(character, 0, 3, mesh => mesh);
            int head = AddParts(character, 3, 1, mesh => mesh);
            AddParts(character, 4, figure.JointCount - 4, mesh => mesh);
            MorphArrays smile = figure.SmileTarget();
            smile.FirstVertex = first;
            character.AddMorphTarget(head, smile);
            smile.Normals = figure.Smile;
            smile.Tangents = figure.Smile;
            character.AddMorphTarget(head, smile);
            using (var deformer = new Deformer(character, style))
            {
                int floats = 3 * Mannequin.PartVertices;
                var output = new MeshOutput { VertexCount = Mannequin.PartVertices, MorphTargetCount = 2,
                    MorphPositions = new float[2 * floats], MorphNormals = new float[2 * floats],
                    MorphTangents = new float[2 * floats] };
                deformer.Apply(new[] { new MeshOutput(), output, new MeshOutput() });
                bool moved = false;
                for (int i = 0; i < floats; i++)
                {
                    Assert.AreEqual(output.MorphPositions[i], output.MorphPositions[floats + i],
                        "the targets are the same");
                    Assert.AreEqual(0f, output.MorphNormals[i], "the first target came without normals");
                    moved = moved || output.MorphPositions[i] != 0;
                }
                Assert.IsTrue(moved, "the smile moves nothing");
                int caps = Mannequin.Rings * Mannequin.Sides;
                Assert.AreEqual(0f, output.MorphPositions[3 * caps + 2], "where the smile is 0, it stays 0");
            }
        }
    }

    [Test]
    public void Arrays_that_are_too_short_are_named()
    {
        int count = figure.VertexCount;
        AssertRefused(mesh => mesh.Normals = new Triple[count - 1], "figure", "Normals", "0 to " + (count - 1));
        AssertRefused(mesh => mesh.Tangents = new float[4 * count - 1], "Tangents");
        AssertRefused(mesh => mesh.VertexCount = count + 1, "Positions");
        AssertRefused(mesh => mesh.FirstVertex = 1, "Indices", "triangle");
        AssertRefused(mesh => mesh.FirstVertex = -1, "FirstVertex", "-1");
        AssertRefused(mesh => mesh.Weights = new float[count - 1], "Weights", count.ToString());
        AssertRefused(mesh => mesh.Joints = new uint[count - 1], "Joints", count.ToString());
        AssertRefused(mesh => mesh.InfluenceCount = 0, "InfluenceCount");
        AssertRefused(mesh => mesh.Weights = null, "Weights", "null");
        AssertRefused(mesh => mesh.RowStarts = new uint[count], "RowStarts", (count + 1).ToString());
        uint[] far = new uint[count + 1], falling = new uint[count + 1];
        far[count] = uint.MaxValue;
        falling[0] = 1;
        AssertRefused(mesh => mesh.RowStarts = far, "Joints");
        AssertRefused(mesh => mesh.RowStarts = falling, "RowStarts", "falls");
        AssertRefused(mesh => mesh.IndexCount = mesh.Indices.Length + 3, "Indices", "IndexCount");
        AssertRefused(mesh => mesh.FirstIndex = -3, "Indices", "-3");
        AssertRefused(mesh => mesh.FirstIndex = mesh.Indices.Length + 3, "Indices", "FirstIndex");
        AssertRefused(mesh => { mesh.Indices = null; mesh.IndexCount = 3; }, "Indices", "null");
    }

    [Test]
    public void Morph_targets_that_are_too_short_are_named_with_their_mesh()
    {
        using (Character character = figure.Character())
        {
            var target = new MorphArrays { Name = "笑顔", Positions = new Triple[figure.VertexCount - 1] };
            InvalidInputException exception = Thrown.Invalid(Status.BadArgument,
                () => character.AddMorphTarget(0, target));
            Thrown.Says(exception, "mesh 0", "笑顔", "Positions");
            Assert.AreEqual(0, exception.Mesh);
            target.Positions = figure.Smile;
            target.Normals = new float[3];
            Thrown.Says(Thrown.Invalid(Status.BadArgument, () => character.AddMorphTarget(0, target)), "Normals");
            Assert.AreEqual(0, character.Info.MorphTargetCount);
        }
    }

    [Test]
    public void Arrays_of_other_things_are_named()
    {
        AssertRefused(mesh => mesh.Positions = new double[3], "Positions", "Double");
        AssertRefused(mesh => mesh.Positions = new Quadruple[figure.VertexCount], "Positions", "Quadruple");
        AssertRefused(mesh => mesh.Positions = new string[3], "Positions", "String");
        AssertRefused(mesh => mesh.Indices = new short[3], "Indices", "Int16");
    }

    [Test]
    public void Indices_count_from_the_first_vertex()
    {
        MeshArrays mesh = figure.Mesh();
        mesh.FirstVertex = Mannequin.PartVertices;
        using (var character = new Character())
        {
            character.SetSkeleton(figure.Skeleton);
            // The last part's triangles reach beyond the slice.
            InvalidInputException exception = Thrown.Invalid(Status.BadInput, () => character.AddMesh(mesh));
            Thrown.Says(exception, "triangle", "figure");
        }
    }

    [Test]
    public void A_mesh_without_vertices_is_a_mesh()
    {
        using (var character = new Character())
        {
            Assert.AreEqual(0, character.AddMesh(new MeshArrays()));
            var empty = new MeshArrays { Positions = new Triple[0], Indices = new ushort[0] };
            Assert.AreEqual(1, character.AddMesh(empty));
            Assert.AreEqual(2, character.Info.MeshCount);
        }
    }

    [Test]
    public void Skeletons_that_are_too_short_are_named()
    {
        double[] matrices = new double[16 * figure.JointCount - 1];
        AssertSkeletonRefused(skeleton => skeleton.RestMatrices = matrices, "RestMatrices");
        AssertSkeletonRefused(skeleton => skeleton.RestMatrices = null, "RestMatrices");
        AssertSkeletonRefused(skeleton => skeleton.Parents = null, "Parents");
        AssertSkeletonRefused(skeleton => skeleton.Names = new string[1], "Names");
        AssertSkeletonRefused(skeleton => skeleton.RoleJoints = new int[56], "role");
    }

    [Test]
    public void Outputs_that_are_too_short_are_named_with_their_mesh()
    {
        using (Character character = figure.Character())
        using (Style style = Style.FromHeads(2.5))
        using (var deformer = new Deformer(character, style))
        {
            MeshOutput output = Mannequin.Output(figure.VertexCount);
            output.Normals = new Triple[3];
            InvalidInputException exception = Thrown.Invalid(Status.BadArgument,
                () => deformer.Apply(new[] { output }));
            Thrown.Says(exception, "output 0", "Normals");
            Assert.AreEqual(0, exception.Mesh);
            output = Mannequin.Output(figure.VertexCount);
            output.FirstVertex = 1;
            Thrown.Says(Thrown.Invalid(Status.BadArgument, () => deformer.Apply(new[] { output })), "Positions");
            output.FirstVertex = 0;
            output.VertexCount = -1;
            Thrown.Says(Thrown.Invalid(Status.BadArgument, () => deformer.Apply(new[] { output })), "VertexCount -1");
            Thrown.Says(Thrown.Invalid(Status.BadArgument, () => deformer.Apply(new MeshOutput[1])), "output 0",
                "null");
            Thrown.Invalid(Status.BadArgument, () => deformer.Apply(new MeshOutput[0]));
            output = new MeshOutput { VertexCount = figure.VertexCount, MorphTargetCount = 1,
                MorphPositions = new float[3] };
            Thrown.Says(Thrown.Invalid(Status.BadArgument, () => deformer.Apply(new[] { output })), "MorphPositions");
        }
    }

    // The figure in three slices of the same arrays.
    static void AssertSlices(Func<MeshArrays, MeshArrays> form)
    {
        MeshOutput expected = Deformed(figure.Mesh(), Mannequin.Output(figure.VertexCount));
        MeshOutput shared = Mannequin.Output(figure.VertexCount);
        using (var character = new Character())
        using (Style style = Style.FromHeads(2.5))
        {
            character.SetSkeleton(figure.Skeleton);
            int[] cuts = { 0, 3, 9, figure.JointCount };
            MeshOutput[] outputs = new MeshOutput[3];
            for (int slice = 0; slice < 3; slice++)
            {
                AddParts(character, cuts[slice], cuts[slice + 1] - cuts[slice], form);
                outputs[slice] = new MeshOutput { Positions = shared.Positions, Normals = shared.Normals,
                    Tangents = shared.Tangents, FirstVertex = cuts[slice] * Mannequin.PartVertices,
                    VertexCount = (cuts[slice + 1] - cuts[slice]) * Mannequin.PartVertices };
            }
            using (var deformer = new Deformer(character, style)) deformer.Apply(outputs);
        }
        // Measured over the meshes of the body one after the other, so the same but for the order of sums.
        AssertClose((Triple[])expected.Positions, (Triple[])shared.Positions);
        AssertClose((Triple[])expected.Normals, (Triple[])shared.Normals);
    }

    static int AddParts(Character character, int part, int count, Func<MeshArrays, MeshArrays> form)
    {
        MeshArrays mesh = form(figure.Mesh());
        mesh.FirstVertex = part * Mannequin.PartVertices;
        mesh.VertexCount = count * Mannequin.PartVertices;
        mesh.FirstIndex = part * Mannequin.PartIndices;
        mesh.IndexCount = count * Mannequin.PartIndices;
        // Indices count from the slice's first vertex.
        ushort[] indices = (ushort[])figure.Indices.Clone();
        for (int i = mesh.FirstIndex; i < mesh.FirstIndex + mesh.IndexCount; i++)
        {
            indices[i] = (ushort)(indices[i] - mesh.FirstVertex);
        }
        mesh.Indices = indices;
        return character.AddMesh(mesh);
    }

    // With a second joint of weight 0 for every other vertex, so that rows differ in length.
    static MeshArrays InRows(MeshArrays mesh)
    {
        uint[] starts = new uint[figure.VertexCount + 1];
        var joints = new System.Collections.Generic.List<uint>();
        var weights = new System.Collections.Generic.List<float>();
        for (int vertex = 0; vertex < figure.VertexCount; vertex++)
        {
            joints.Add(figure.Joints[vertex]);
            weights.Add(figure.Weights[vertex]);
            if (vertex % 2 == 1)
            {
                joints.Add(0);
                weights.Add(0);
            }
            starts[vertex + 1] = (uint)joints.Count;
        }
        mesh.RowStarts = starts;
        mesh.Joints = joints.ToArray();
        mesh.Weights = weights.ToArray();
        mesh.InfluenceCount = 0;
        return mesh;
    }

    static MeshOutput Deformed(MeshArrays mesh, MeshOutput output)
    {
        using (var character = new Character())
        using (Style style = Style.FromHeads(2.5))
        {
            character.SetSkeleton(figure.Skeleton);
            if (output.Tangents == null) mesh.Tangents = null;
            character.AddMesh(mesh);
            using (var deformer = new Deformer(character, style)) deformer.Apply(new[] { output });
        }
        return output;
    }

    static void AssertRefused(Action<MeshArrays> spoil, params string[] words)
    {
        MeshArrays mesh = figure.Mesh();
        spoil(mesh);
        using (var character = new Character())
        {
            character.SetSkeleton(figure.Skeleton);
            try
            {
                character.AddMesh(mesh);
            }
            catch (InvalidInputException exception)
            {
                bool ours = exception.Status == Status.BadArgument;
                Assert.IsTrue(ours || exception.Status == Status.BadInput, exception.Status.ToString());
                Thrown.Says(exception, ours ? words : new[] { "triangle" });
                Assert.AreEqual(0, exception.Mesh);
                Assert.AreEqual(0, character.Info.MeshCount);
                return;
            }
            Assert.Fail("a mesh with a wrong " + words[0] + " was taken");
        }
    }

    static void AssertSkeletonRefused(Action<SkeletonArrays> spoil, string word)
    {
        SkeletonArrays skeleton = new Mannequin().Skeleton;
        spoil(skeleton);
        using (var character = new Character())
        {
            Thrown.Says(Thrown.Invalid(Status.BadArgument, () => character.SetSkeleton(skeleton)), word);
        }
    }

    static void AssertSame(MeshOutput expected, MeshOutput output)
    {
        Assert.AreEqual(expected.Positions, output.Positions);
        Assert.AreEqual(expected.Normals, output.Normals);
        Assert.AreEqual(expected.Tangents, output.Tangents);
    }

    static void AssertClose(Triple[] expected, Triple[] given)
    {
        float[] left = Floats(expected), right = Floats(given);
        Assert.AreEqual(left.Length, right.Length);
        for (int i = 0; i < left.Length; i++) Assert.AreEqual(left[i], right[i], 1e-5f, "number " + i);
    }

    static float[] Floats(Triple[] vectors)
    {
        float[] floats = new float[3 * vectors.Length];
        for (int i = 0; i < vectors.Length; i++)
        {
            floats[3 * i] = vectors[i].X;
            floats[3 * i + 1] = vectors[i].Y;
            floats[3 * i + 2] = vectors[i].Z;
        }
        return floats;
    }
}
}
