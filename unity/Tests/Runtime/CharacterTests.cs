using System.Collections.Generic;
using NUnit.Framework;

namespace SuperDeform.Tests
{
[TestFixture]
public sealed class CharacterTests
{
    [Test]
    public void It_counts_what_it_holds()
    {
        var figure = new Mannequin();
        using (Character character = figure.Character())
        {
            character.AddMorphTarget(0, figure.SmileTarget());
            CharacterInfo info = character.Info;
            Assert.AreEqual(1, info.MeshCount);
            Assert.AreEqual(figure.JointCount, info.JointCount);
            Assert.AreEqual(figure.JointCount, info.OwnJointCount);
            Assert.AreEqual(1, info.MorphTargetCount);
            Assert.IsFalse(info.RigMade);
            Assert.AreEqual(figure.VertexCount, info.VertexCount);
            Assert.AreEqual(figure.Indices.Length / 3, info.TriangleCount);
        }
    }

    [Test]
    public void Images_are_numbered_and_meshes_show_them()
    {
        var figure = new Mannequin();
        using (Character character = figure.Character())
        {
            Assert.AreEqual(1, character.AddImage(2, 1, new byte[] { 0, 255 }));
            Assert.AreEqual(2, character.AddImage(1, 1, new byte[] { 9 }));
            MeshArrays mesh = figure.Mesh();
            mesh.Image = 2;
            mesh.Uvs = new float[2 * figure.VertexCount];
            character.AddMesh(mesh);
            mesh.Image = 3;
            Thrown.Says(Thrown.Invalid(Status.BadArgument, () => character.AddMesh(mesh)), "3");
            mesh.Image = 0;
            mesh.Uvs = null;
            mesh.Luminance = new byte[figure.VertexCount - 1];
            Thrown.Says(Thrown.Invalid(Status.BadArgument, () => character.AddMesh(mesh)), "Luminance");
            Thrown.Says(Thrown.Invalid(Status.BadArgument, () => character.AddImage(2, 2, new byte[3])), "3");
        }
    }

    [Test]
    public void Hints_are_places()
    {
        using (Character character = new Mannequin().Character())
        {
            character.SetFaceHints(new[] { 0.03, 1.6, 0.1 });
            character.SetFaceHints(null);
            Thrown.Says(Thrown.Invalid(Status.BadInput, () => character.SetFaceHints(new[] { double.NaN, 1, 0 })), "NaN");
            Thrown.Says(Thrown.Invalid(Status.BadArgument, () => character.SetFaceHints(new double[2])), "2");
        }
    }

    [Test]
    public void Its_joints_come_back_as_given()
    {
        var figure = new Mannequin();
        using (Character character = figure.Character())
        {
            Joints joints = character.GetJoints();
            Assert.AreEqual(figure.JointCount, joints.Count);
            Assert.AreEqual(figure.Skeleton.Parents, joints.Parents);
            Assert.AreEqual(figure.Skeleton.RestMatrices, joints.RestMatrices);
            for (int joint = 0; joint < joints.Count; joint++)
            {
                Assert.AreEqual(figure.Skeleton.Names[joint], joints.Roles[joint].ToString());
                Assert.AreEqual(1.0, joints.Confidence[joint]);
            }
        }
    }

    [Test]
    public void A_joint_without_a_role_has_none()
    {
        var figure = new Mannequin();
        SkeletonArrays skeleton = figure.Skeleton;
        int tail = figure.JointCount;
        System.Array.Resize(ref skeleton.Parents, tail + 1);
        System.Array.Resize(ref skeleton.Names, tail + 1);
        System.Array.Resize(ref skeleton.RestMatrices, 16 * (tail + 1));
        skeleton.Names[tail] = "Tail";
        for (int i = 0; i < 4; i++) skeleton.RestMatrices[16 * tail + 5 * i] = 1;
        using (Character character = figure.Character())
        {
            Assert.AreEqual(HumanoidRole.None, character.GetJoints().Roles[tail]);
        }
    }

    [Test]
    public void Its_weights_come_back_largest_first()
    {
        var figure = new Mannequin();
        MeshArrays mesh = figure.Mesh();
        mesh.InfluenceCount = 2;
        mesh.Joints = new uint[2 * figure.VertexCount];
        mesh.Weights = new float[2 * figure.VertexCount];
        for (int vertex = 0; vertex < figure.VertexCount; vertex++)
        {
            mesh.Joints[2 * vertex] = 4;
            mesh.Joints[2 * vertex + 1] = 9;
            mesh.Weights[2 * vertex] = 1;
            mesh.Weights[2 * vertex + 1] = 3;
        }
        using (var character = new Character())
        {
            character.SetSkeleton(figure.Skeleton);
            character.AddMesh(mesh);
            uint[] joints = new uint[3 * figure.VertexCount];
            float[] weights = new float[3 * figure.VertexCount];
            character.GetWeights(0, 3, joints, weights);
            for (int vertex = 0; vertex < figure.VertexCount; vertex++)
            {
                Assert.AreEqual(new uint[] { 9, 4, 0 }, new[] { joints[3 * vertex], joints[3 * vertex + 1],
                    joints[3 * vertex + 2] });
                Assert.AreEqual(new[] { 0.75f, 0.25f, 0f }, new[] { weights[3 * vertex], weights[3 * vertex + 1],
                    weights[3 * vertex + 2] });
            }
            Thrown.Invalid(Status.BufferTooSmall, () => character.GetWeights(0, 4, joints, weights));
            Thrown.Invalid(Status.BadArgument, () => character.GetWeights(1, 1, joints, weights));
            Thrown.Invalid(Status.BadArgument, () => character.GetWeights(0, -1, joints, weights));
        }
    }

    [Test]
    public void A_rig_is_made_where_there_is_none_and_has_warnings()
    {
        var figure = new Mannequin();
        MeshArrays mesh = figure.Mesh();
        mesh.Joints = null;
        mesh.Weights = null;
        var options = new Options { RigVoxelResolution = 32, RigFingers = false };
        var head = new Triple(0, 1.5f, 0);
        options.RigJoints.Add(new GivenJoint(HumanoidRole.Head, head.X, head.Y, head.Z));
        using (var character = new Character(new float[] { 0, 1, 0 }, new float[] { 0, 0, 1 }))
        {
            character.AddMesh(mesh);
            character.Rig(options);
            CharacterInfo info = character.Info;
            Assert.IsTrue(info.RigMade);
            Assert.AreEqual(0, info.OwnJointCount);
            Joints joints = character.GetJoints();
            int given = System.Array.IndexOf(joints.Roles, HumanoidRole.Head);
            Assert.AreEqual(head.Y, joints.RestMatrices[16 * given + 13], 1e-6);
            Assert.AreEqual(1.0, joints.Confidence[given]);
            uint[] by = new uint[4 * figure.VertexCount];
            float[] weights = new float[4 * figure.VertexCount];
            character.GetWeights(0, 4, by, weights);
            for (int vertex = 0; vertex < figure.VertexCount; vertex++)
            {
                Assert.AreEqual(1f, weights[4 * vertex] + weights[4 * vertex + 1] + weights[4 * vertex + 2]
                    + weights[4 * vertex + 3], 1e-5f);
            }
            // Separate tubes are not a body whose joints can all be seen.
            IList<Warning> warnings = character.Warnings;
            Assert.IsTrue(warnings.Count > 0, "no warnings");
            foreach (Warning warning in warnings)
            {
                StringAssert.IsMatch("^[a-z_]+$", warning.Code);
                Assert.IsTrue(warning.Text.Length > 10, warning.ToString());
            }
        }
    }

    [Test]
    public void A_character_whose_rig_is_its_own_has_no_warnings()
    {
        using (Character character = new Mannequin().Character()) Assert.AreEqual(0, character.Warnings.Count);
    }

    [Test]
    public void Directions_are_three_numbers()
    {
        Thrown.Says(Thrown.Invalid(Status.BadArgument, () => new Character(new float[2])), "up", "2");
        Thrown.Says(Thrown.Invalid(Status.BadArgument, () => new Character(null, new float[4])), "forward", "4");
        Thrown.Invalid(Status.BadInput, () => new Character(new float[3]));
    }

    [Test]
    public void A_morph_target_of_a_mesh_that_is_none_is_refused()
    {
        var figure = new Mannequin();
        using (Character character = figure.Character())
        {
            MorphArrays target = figure.SmileTarget();
            Thrown.Says(Thrown.Invalid(Status.BadArgument, () => character.AddMorphTarget(1, target)), "1");
            Thrown.Says(Thrown.Invalid(Status.BadArgument, () => character.AddMorphTarget(-1, target)), "-1");
        }
    }
}
}
