using System;
using System.Collections.Generic;
using System.Threading;
using NUnit.Framework;

namespace SuperDeform.Tests
{
[TestFixture]
public sealed class ProgressTests
{
    readonly Mannequin figure = new Mannequin();
    Character character;
    Style style;

    [SetUp]
    public void Make()
    {
        character = figure.Character();
        style = Style.FromHeads(2.5);
    }

    [TearDown]
    public void Destroy()
    {
        style.Dispose();
        character.Dispose();
    }

    [Test]
    public void It_rises_to_1_on_the_calling_thread()
    {
        var fractions = new List<float>();
        int other = 0, own = Thread.CurrentThread.ManagedThreadId;
        ProgressHandler progress = fraction =>
        {
            if (Thread.CurrentThread.ManagedThreadId != own) other++;
            fractions.Add(fraction);
            return true;
        };
        using (var deformer = new Deformer(character, style, null, progress))
        {
            AssertRises(fractions);
            deformer.SetOptions(new Options { HeadScale = 1.2 }, progress);
            AssertRises(fractions);
            deformer.Apply(new[] { Mannequin.Output(figure.VertexCount) }, progress);
            AssertRises(fractions);
        }
        using (Character bare = Bare())
        {
            bare.Rig(new Options { RigVoxelResolution = 16 }, progress);
            AssertRises(fractions);
        }
        Assert.AreEqual(0, other, "calls on other threads");
    }

    [Test]
    public void False_cancels_and_leaves_everything_as_it_was()
    {
        ulong before = SuperDeformLibrary.LiveHandles;
        Thrown.With<CancelledException>(Status.Cancelled,
            () => new Deformer(character, style, null, fraction => false));
        Assert.IsTrue(SuperDeformLibrary.LiveHandles <= before, "handles were left");
        using (var deformer = new Deformer(character, style))
        {
            MeshOutput expected = Mannequin.Output(figure.VertexCount), output = Mannequin.Output(figure.VertexCount);
            deformer.Apply(new[] { expected });
            Thrown.With<CancelledException>(Status.Cancelled,
                () => deformer.SetOptions(new Options { HeadScale = 1.2 }, fraction => false));
            Thrown.With<CancelledException>(Status.Cancelled,
                () => deformer.Apply(new[] { output }, fraction => false));
            Assert.AreEqual(new Triple[figure.VertexCount], output.Positions, "something was written");
            deformer.Apply(new[] { output });
            Assert.AreEqual(expected.Positions, output.Positions);
        }
        using (Character bare = Bare())
        {
            Thrown.With<CancelledException>(Status.Cancelled, () => bare.Rig(null, fraction => false));
            Assert.IsFalse(bare.Info.RigMade);
        }
    }

    [Test]
    public void What_a_handler_throws_comes_out_of_the_call()
    {
        ulong before = SuperDeformLibrary.LiveHandles;
        var own = new ArgumentException("the window was closed: 窓");
        ProgressHandler throws = fraction => { throw own; };
        AssertThrows(own, () => new Deformer(character, style, null, throws));
        Assert.IsTrue(SuperDeformLibrary.LiveHandles <= before, "handles were left");
        using (var deformer = new Deformer(character, style))
        {
            AssertThrows(own, () => deformer.SetOptions(null, throws));
            AssertThrows(own, () => deformer.Apply(new[] { Mannequin.Output(figure.VertexCount) }, throws));
            deformer.Apply(new[] { Mannequin.Output(figure.VertexCount) }, fraction => true);
        }
        using (Character bare = Bare()) AssertThrows(own, () => bare.Rig(null, throws));
        AssertThrows(own, () => AllAtOnce.SuperDeform(null, null, figure.Skeleton, new[] { figure.Mesh() }, style, null,
            new[] { Mannequin.Output(figure.VertexCount) }, throws));
    }

    [Test]
    public void A_change_from_within_a_call_is_busy()
    {
        using (var deformer = new Deformer(character, style))
        {
            var options = new Options { HeadScale = 1.2 };
            Thrown.With<BusyException>(Status.Busy, () => deformer.SetOptions(options, fraction =>
            {
                deformer.SetOptions(null);
                return true;
            }));
        }
    }

    [Test]
    public void A_call_within_a_call_has_a_handler_of_its_own()
    {
        int inner = 0, outer = 0;
        using (var deformer = new Deformer(character, style, null, fraction =>
        {
            outer++;
            using (new Deformer(character, style, null, again =>
            {
                inner++;
                return true;
            })) { }
            return true;
        }))
        {
            Assert.IsTrue(outer > 0 && inner >= outer, outer + " outer and " + inner + " inner calls");
        }
    }

    [Test]
    public void A_collection_during_a_call_does_no_harm()
    {
        using (var deformer = new Deformer(character, style, null, Collect))
        {
            deformer.Apply(new[] { Mannequin.Output(figure.VertexCount) }, Collect);
        }
    }

    [Test]
    public void What_is_disposed_of_during_its_own_call_goes_after_it()
    {
        ulong before = SuperDeformLibrary.LiveHandles;
        var deformer = new Deformer(character, style);
        MeshOutput output = Mannequin.Output(figure.VertexCount);
        deformer.Apply(new[] { output }, fraction =>
        {
            deformer.Dispose();
            return true;
        });
        Assert.IsTrue(SuperDeformLibrary.LiveHandles <= before, "handles were left");
        Assert.AreNotEqual(new Triple[figure.VertexCount], output.Positions);
    }

    static bool Collect(float fraction)
    {
        GC.Collect();
        GC.WaitForPendingFinalizers();
        return true;
    }

    Character Bare()
    {
        MeshArrays mesh = figure.Mesh();
        mesh.Joints = null;
        mesh.Weights = null;
        var bare = new Character(null, new float[] { 0, 0, 1 });
        bare.AddMesh(mesh);
        return bare;
    }

    static void AssertRises(List<float> fractions)
    {
        Assert.IsTrue(fractions.Count > 0, "no progress was reported");
        for (int i = 1; i < fractions.Count; i++) Assert.IsTrue(fractions[i] >= fractions[i - 1]);
        Assert.IsTrue(fractions[0] >= 0);
        Assert.AreEqual(1f, fractions[fractions.Count - 1]);
        fractions.Clear();
    }

    static void AssertThrows(Exception expected, Action call)
    {
        try
        {
            call();
        }
        catch (Exception exception)
        {
            Assert.AreSame(expected, exception);
            return;
        }
        Assert.Fail("nothing was thrown");
    }
}
}
