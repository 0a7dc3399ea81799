using System;
using System.Collections.Generic;
using System.Threading;
using NUnit.Framework;

namespace SuperDeform.Tests
{
[TestFixture]
public sealed class DeformerTests
{
    readonly Mannequin figure = new Mannequin();
    Character character;
    Style style;
    Deformer deformer;

    [SetUp]
    public void Make()
    {
        character = figure.Character();
        style = Style.FromHeads(2.5);
        deformer = new Deformer(character, style);
    }

    [TearDown]
    public void Destroy()
    {
        deformer.Dispose();
        style.Dispose();
        character.Dispose();
    }

    [Test]
    public void One_call_gives_the_same_bits()
    {
        MeshOutput expected = Mannequin.Output(figure.VertexCount), output = Mannequin.Output(figure.VertexCount);
        deformer.Apply(new[] { expected });
        AllAtOnce.SuperDeform(null, null, figure.Skeleton, new[] { figure.Mesh() }, style, null, new[] { output });
        Assert.AreEqual(Bits((Triple[])expected.Positions), Bits((Triple[])output.Positions));
        Assert.AreEqual(Bits((Triple[])expected.Normals), Bits((Triple[])output.Normals));
        Assert.AreEqual(expected.Tangents, output.Tangents);
        Assert.AreNotEqual(Bits(figure.Positions), Bits((Triple[])output.Positions));
    }

    [Test]
    public void Morph_targets_that_the_character_was_not_given_come_out_as_those_that_it_was()
    {
        using (Character smiling = figure.Character())
        {
            smiling.AddMorphTarget(0, figure.SmileTarget());
            using (var expected = new Deformer(smiling, style))
            {
                MeshOutput output = Mannequin.Output(figure.VertexCount, 1);
                expected.Apply(new[] { output });
                var vertices = new List<uint>();
                var deltas = new List<Triple>();
                for (int vertex = 0; vertex < figure.VertexCount; vertex++)
                {
                    Triple delta = figure.Smile[vertex];
                    if (delta.X == 0 && delta.Y == 0 && delta.Z == 0) continue;
                    vertices.Add((uint)vertex);
                    deltas.Add(delta);
                }
                Assert.Greater(vertices.Count, 0);
                Triple[] mapped = deltas.ToArray();
                deformer.MapMorphTargets(0, new[] { (uint)vertices.Count }, vertices.ToArray(), mapped);
                for (int at = 0; at < mapped.Length; at++)
                {
                    int start = 3 * (int)vertices[at];
                    Assert.AreEqual(output.MorphPositions[start], mapped[at].X);
                    Assert.AreEqual(output.MorphPositions[start + 1], mapped[at].Y);
                    Assert.AreEqual(output.MorphPositions[start + 2], mapped[at].Z);
                }
                Assert.AreNotEqual(Bits(deltas.ToArray()), Bits(mapped));
                Thrown.Invalid(Status.BadArgument, () => deformer.MapMorphTargets(0, new[] { 9u }, vertices.GetRange(0, 3).ToArray(), mapped));
                Thrown.Invalid(Status.BadArgument, () => deformer.MapMorphTargets(7, new[] { 1u }, new[] { 1u }, mapped));
            }
        }
        Assert.IsTrue(Character.ReadsMorphTarget("vrc.blink"));
        Assert.IsFalse(Character.ReadsMorphTarget("smile"));
        Assert.IsFalse(Character.ReadsMorphTarget(null));
    }

    [Test]
    public void One_call_may_write_where_it_read_and_reports_progress()
    {
        MeshOutput expected = Mannequin.Output(figure.VertexCount);
        deformer.Apply(new[] { expected });
        var own = new Mannequin();
        var output = new MeshOutput { Positions = own.Positions, VertexCount = own.VertexCount };
        float last = 0;
        AllAtOnce.SuperDeform(new float[] { 0, 1, 0 }, new float[] { 0, 0, 1 }, own.Skeleton, new[] { own.Mesh() }, style,
            new Options { ThreadCount = 1 }, new[] { output }, fraction =>
            {
                last = fraction;
                return true;
            });
        Assert.AreEqual(Bits((Triple[])expected.Positions), Bits(own.Positions));
        Assert.AreEqual(1f, last);
        Thrown.Invalid(Status.BadArgument, () => AllAtOnce.SuperDeform(null, null, own.Skeleton, new[] { own.Mesh() },
            style, null, new MeshOutput[0]));
    }

    [Test]
    public void Amount_0_gives_the_original_back()
    {
        deformer.SetOptions(new Options { Amount = 0, FaceSquash = 0 });
        MeshOutput output = Mannequin.Output(figure.VertexCount);
        deformer.Apply(new[] { output });
        Triple[] positions = (Triple[])output.Positions;
        for (int i = 0; i < positions.Length; i++)
        {
            Assert.AreEqual(figure.Positions[i].X, positions[i].X, 1e-5f);
            Assert.AreEqual(figure.Positions[i].Y, positions[i].Y, 1e-5f);
            Assert.AreEqual(figure.Positions[i].Z, positions[i].Z, 1e-5f);
        }
    }

    [Test]
    public void Options_set_later_give_what_options_set_first_give()
    {
        var options = new Options { HeadScale = 1.1, HairLength = 0.5, FaceSquash = 0.3, FaceCurve = FaceCurve.F2 };
        options.Groups.Add(new GroupSettings { Group = "hand", LengthScale = 1.2, ThicknessScale = 1.3 });
        MeshOutput expected = Mannequin.Output(figure.VertexCount), output = Mannequin.Output(figure.VertexCount);
        using (var other = new Deformer(character, style, options)) other.Apply(new[] { expected });
        deformer.SetOptions(options);
        deformer.Apply(new[] { output });
        Assert.AreEqual(Bits((Triple[])expected.Positions), Bits((Triple[])output.Positions));
    }

    [Test]
    public void A_change_of_the_face_gives_what_a_new_deformer_gives()
    {
        MeshOutput expected = Mannequin.Output(figure.VertexCount), output = Mannequin.Output(figure.VertexCount);
        var options = new Options { FaceSquash = 0.25, FaceCurve = FaceCurve.F2 };
        using (var other = new Deformer(character, style, options))
        {
            other.Apply(new[] { expected });
        }
        deformer.SetOptions(options);
        deformer.Apply(new[] { output });
        Assert.AreEqual(Bits((Triple[])expected.Positions), Bits((Triple[])output.Positions));
        Thrown.Invalid(Status.BadArgument, () => deformer.SetOptions(new Options { FaceCurve = (FaceCurve)9 }));
        Thrown.Invalid(Status.BadOption, () => deformer.SetOptions(new Options { FaceSquash = 11 }));
    }

    [Test]
    public void A_style_set_later_gives_what_a_new_deformer_gives()
    {
        MeshOutput expected = Mannequin.Output(figure.VertexCount), output = Mannequin.Output(figure.VertexCount);
        using (Style taller = Style.FromHeads(4))
        {
            using (var other = new Deformer(character, taller, null)) other.Apply(new[] { expected });
            deformer.SetStyle(taller);
        }
        deformer.Apply(new[] { output });
        Assert.AreEqual(Bits((Triple[])expected.Positions), Bits((Triple[])output.Positions));
        Assert.Throws<ArgumentNullException>(() => deformer.SetStyle(null));
    }

    [Test]
    public void It_keeps_what_it_needs()
    {
        MeshOutput expected = Mannequin.Output(figure.VertexCount), output = Mannequin.Output(figure.VertexCount);
        deformer.Apply(new[] { expected });
        character.Dispose();
        style.Dispose();
        deformer.Apply(new[] { output });
        Assert.AreEqual(Bits((Triple[])expected.Positions), Bits((Triple[])output.Positions));
    }

    [Test]
    public void Joints_move_and_their_inverse_binds_follow()
    {
        int count = deformer.JointCount;
        Assert.AreEqual(figure.JointCount, count);
        double[] positions = new double[3 * count], binds = new double[16 * count];
        deformer.GetJoints(positions, binds);
        for (int joint = 0; joint < count; joint++)
        {
            // The figure's joints do not turn, so the inverse is the translation back.
            for (int i = 0; i < 3; i++) Assert.AreEqual(-positions[3 * joint + i], binds[16 * joint + 12 + i], 1e-12);
            for (int i = 0; i < 4; i++) Assert.AreEqual(1.0, binds[16 * joint + 5 * i]);
        }
        int head = figure.Skeleton.RoleJoints[(int)HumanoidRole.Head];
        Assert.IsTrue(positions[3 * head + 1] < 1.4, "the head stays at " + positions[3 * head + 1]);
        deformer.GetJoints(positions, null);
        deformer.GetJoints(null, binds);
        Thrown.Invalid(Status.BufferTooSmall, () => deformer.GetJoints(new double[3], null));
        Thrown.Invalid(Status.BufferTooSmall, () => deformer.GetJoints(positions, new double[16]));
    }

    [Test]
    public void Points_go_where_the_joints_go()
    {
        int count = figure.JointCount;
        uint[] joints = new uint[count];
        double[] points = new double[3 * count], positions = new double[3 * count], expected = new double[3 * count];
        double[] scales = new double[count], jacobians = new double[9 * count];
        for (int joint = 0; joint < count; joint++)
        {
            joints[joint] = (uint)joint;
            for (int i = 0; i < 3; i++) points[3 * joint + i] = figure.Skeleton.RestMatrices[16 * joint + 12 + i];
        }
        deformer.MapPoints(joints, points, positions, scales, jacobians);
        deformer.GetJoints(expected, null);
        for (int i = 0; i < 3 * count; i++) Assert.AreEqual(expected[i], positions[i], 1e-9, "number " + i);
        foreach (double scale in scales) Assert.IsTrue(scale > 0 && scale < 10, scale.ToString());
        double[] again = new double[3 * count];
        deformer.MapPoints(joints, points, again);
        Assert.AreEqual(positions, again);
        deformer.MapPoints(new uint[0], new double[0], new double[0]);
        joints[5] = 99;
        Assert.AreEqual(5, Thrown.Invalid(Status.BadInput, () => deformer.MapPoints(joints, points, again)).Element);
        double[] few = new double[3];
        Thrown.Says(Thrown.Invalid(Status.BadArgument, () => deformer.MapPoints(joints, points, few)), "positions");
        Thrown.Says(Thrown.Invalid(Status.BadArgument, () => deformer.MapPoints(joints, few, again)), "points");
    }

    [Test]
    public void Colliders_go_where_their_points_go_and_yield_to_springs()
    {
        uint head = (uint)figure.Skeleton.RoleJoints[(int)HumanoidRole.Head];
        double[] at = new double[3], positions = new double[3], scales = new double[1];
        for (int i = 0; i < 3; i++) at[i] = figure.Skeleton.RestMatrices[16 * head + 12 + i];
        deformer.MapPoints(new[] { head }, at, positions, scales);
        var sphere = new SpringCollider { Kind = ColliderKind.Sphere, Joint = head, X = at[0], Y = at[1], Z = at[2], Radius = 0.05 };
        SpringCollider moved = deformer.MapColliders(new[] { sphere })[0];
        Assert.AreEqual(positions[0], moved.X, 1e-12);
        Assert.AreEqual(positions[1], moved.Y, 1e-12);
        Assert.AreEqual(positions[2], moved.Z, 1e-12);
        Assert.AreEqual(0.05 * scales[0], moved.Radius, 1e-9);
        Assert.AreEqual(0.0, moved.Yielded);
        // A capsule of the head's two ends; a plane keeps the length of its normal.
        var capsule = new SpringCollider { Kind = ColliderKind.Capsule, Joint = head, X = at[0], Y = at[1], Z = at[2], EndX = at[0], EndY = at[1] + 0.1, EndZ = at[2], Radius = 0.05 };
        var plane = new SpringCollider { Kind = ColliderKind.Plane, Joint = head, X = at[0], Y = at[1], Z = at[2], EndX = 0, EndY = 2, EndZ = 0 };
        // A spring that does not move with the head: the head grows into it.
        var ball = new SpringBall { Joint = 0, X = at[0] + 0.0601, Y = at[1], Z = at[2], Radius = 0.01 };
        sphere.Springs = new uint[] { 0 };
        SpringCollider[] all = deformer.MapColliders(new[] { capsule, plane, sphere }, new[] { ball });
        double[] top = { at[0], at[1] + 0.1, at[2] }, end = new double[3];
        deformer.MapPoints(new[] { head }, top, end);
        Assert.AreEqual(end[1], all[0].EndY, 1e-12);
        Assert.IsTrue(all[0].Radius > 0);
        Assert.AreEqual(2.0, all[1].EndY, 1e-9);
        Assert.IsTrue(all[2].Yielded >= 0 && all[2].Yielded <= 0.2, all[2].Yielded.ToString());
        Assert.AreEqual(moved.Radius * (1 - all[2].Yielded), all[2].Radius, 1e-9);
        Assert.AreEqual(0, deformer.MapColliders(new SpringCollider[0]).Length);
        plane.Joint = 99;
        Assert.AreEqual(1, Thrown.Invalid(Status.BadInput, () => deformer.MapColliders(new[] { capsule, plane })).Element);
        ball.Joint = 99;
        Assert.AreEqual(0, Thrown.Invalid(Status.BadInput, () => deformer.MapColliders(new[] { sphere }, new[] { ball })).Element);
    }

    [Test]
    public void A_job_system_of_the_hosts_does_the_work_and_gives_the_same_bits()
    {
        double[] before = new double[3 * figure.JointCount], after = new double[3 * figure.JointCount];
        int runs = 0;
        using (Style style = Style.FromHeads(3))
        {
            using (var own = new Deformer(character, style)) own.GetJoints(before, null);
            using (new JobScope((count, task) =>
            {
                System.Threading.Interlocked.Increment(ref runs);
                System.Threading.Tasks.Parallel.For(0, count, task);
            }))
            {
                using (var hosts = new Deformer(character, style)) hosts.GetJoints(after, null);
                // A rig is work enough for several threads.
                using (Character rigged = figure.Character()) rigged.Rig(new Options { ThreadCount = 4 });
            }
            Assert.AreEqual(before, after);
            Assert.IsTrue(runs > 0, "the runner was never called");
            int once = runs;
            using (var own = new Deformer(character, style)) own.GetJoints(after, null);
            Assert.AreEqual(once, runs, "after its end");
            // What a runner leaves out is done all the same, and what it throws comes out.
            var lazy = new JobScope((count, task) => { throw new NotSupportedException("no jobs today"); });
            using (Character rigged = figure.Character()) rigged.Rig(new Options { ThreadCount = 4 });
            Assert.Throws<NotSupportedException>(() => lazy.Dispose());
            lazy.Dispose();
            Assert.Throws<ArgumentNullException>(() => new JobScope(null));
        }
    }

    [Test]
    public void Groups_have_names_scales_and_sizes()
    {
        var options = new Options();
        options.Groups.Add(new GroupSettings { Group = "lower_arm", ThicknessScale = 1.25 });
        deformer.SetOptions(options);
        var groups = new Dictionary<string, Group>();
        foreach (Group group in deformer.GetGroups()) groups.Add(group.Name, group);
        Assert.AreEqual(1.25, groups["lower_arm"].ThicknessScale, 1e-9);
        // Both lower arms of the figure, elbow to wrist.
        Assert.AreEqual(2 * 0.25, groups["lower_arm"].TargetLength, 0.02);
        Assert.AreEqual(0.04, groups["lower_arm"].TargetRadius, 0.004);
        Assert.IsTrue(double.IsNaN(groups["lower_arm"].ReferenceLength), "a style of N heads has no lengths");
        Assert.IsTrue(groups["upper_leg"].LengthScale < 1, groups["upper_leg"].LengthScale.ToString());
    }

    [Test]
    public void The_report_is_numbers_and_the_same_numbers_as_JSON()
    {
        float far = 0;
        deformer.Measure(fraction =>
        {
            Assert.IsTrue(fraction >= far, fraction + " after " + far);
            far = fraction;
            return true;
        });
        Assert.AreEqual(1, far);
        Report report = deformer.GetReport();
        Assert.IsFalse(report.RigMade);
        Assert.AreEqual(1.75, report.Target.Height, 0.05);
        Assert.IsTrue(report.Result.Height < report.Target.Height);
        Assert.AreEqual(0, report.UnreachedVertices);
        Dictionary<string, object> json = (Dictionary<string, object>)Json.Read(deformer.GetReportJson());
        Dictionary<string, object> result = (Dictionary<string, object>)json["result"];
        Assert.AreEqual(report.Result.Heads, (double)result["heads"], 1e-9);
        Assert.AreEqual(report.Result.Height, (double)result["height"], 1e-9);
    }

    [Test]
    public void Warnings_are_a_list()
    {
        deformer.SetOptions(new Options { FaceSquash = 10 });
        IList<Warning> warnings = deformer.Warnings;
        bool found = false;
        foreach (Warning warning in warnings) found = found || warning.Code == "face_squash_clamped";
        Assert.IsTrue(found, "no word of a face that was squashed too far among " + warnings.Count + " warnings");
    }

    [Test]
    public void Applying_leaves_no_garbage()
    {
        MeshOutput[] outputs = { Mannequin.Output(figure.VertexCount) };
        for (int i = 0; i < 3; i++) deformer.Apply(outputs);
        // Not in every library that this compiles against.
        System.Reflection.MethodInfo counter = typeof(GC).GetMethod("GetAllocatedBytesForCurrentThread");
        if (counter == null) Assert.Ignore("this runtime does not count what is allocated");
        Func<long> allocated = (Func<long>)Delegate.CreateDelegate(typeof(Func<long>), counter);
        const int times = 200;
        long before = allocated();
        for (int i = 0; i < times; i++) deformer.Apply(outputs);
        long bytes = allocated() - before;
        Assert.IsTrue(bytes < 1000, bytes + " bytes for " + times + " times " + figure.VertexCount + " vertices");
    }

    [Test]
    public void Threads_may_share_it()
    {
        MeshOutput expected = Mannequin.Output(figure.VertexCount);
        deformer.Apply(new[] { expected });
        Exception failed = null;
        Thread[] threads = new Thread[4];
        for (int i = 0; i < threads.Length; i++)
        {
            threads[i] = new Thread(() =>
            {
                try
                {
                    MeshOutput output = Mannequin.Output(figure.VertexCount);
                    for (int time = 0; time < 20; time++)
                    {
                        deformer.Apply(new[] { output });
                        Assert.AreEqual(Bits((Triple[])expected.Positions), Bits((Triple[])output.Positions));
                    }
                }
                catch (Exception exception)
                {
                    failed = exception;
                }
            });
            threads[i].Start();
        }
        foreach (Thread thread in threads) thread.Join();
        Assert.IsNull(failed, failed == null ? "" : failed.ToString());
    }

    static int[] Bits(Triple[] vectors)
    {
        int[] bits = new int[3 * vectors.Length];
        for (int i = 0; i < vectors.Length; i++)
        {
            bits[3 * i] = BitConverter.ToInt32(BitConverter.GetBytes(vectors[i].X), 0);
            bits[3 * i + 1] = BitConverter.ToInt32(BitConverter.GetBytes(vectors[i].Y), 0);
            bits[3 * i + 2] = BitConverter.ToInt32(BitConverter.GetBytes(vectors[i].Z), 0);
        }
        return bits;
    }
}
}
