using System;
using NUnit.Framework;

namespace SuperDeform.Tests
{
[TestFixture]
public sealed class ErrorTests
{
    [Test]
    public void Each_status_has_its_class()
    {
        AssertClass(typeof(InvalidInputException), Status.BadArgument, Status.BadInput, Status.BadOption,
            Status.BadStyle, Status.NoGeometry, Status.BufferTooSmall);
        AssertClass(typeof(NotHumanoidException), Status.NoHumanoid);
        AssertClass(typeof(BusyException), Status.Busy);
        AssertClass(typeof(CancelledException), Status.Cancelled);
        AssertClass(typeof(LibraryFaultException), Status.Internal);
        AssertClass(typeof(SuperDeformException), Status.BadHandle, Status.OutOfMemory);
    }

    [Test]
    public void A_constant_that_is_none_is_a_bad_argument()
    {
        MeshArrays mesh = new Mannequin().Mesh();
        mesh.Kind = (MeshKind)99;
        using (var character = new Character())
        {
            Thrown.Says(Thrown.Invalid(Status.BadArgument, () => character.AddMesh(mesh)), "99");
        }
    }

    [Test]
    public void A_position_that_is_not_finite_is_named_with_its_mesh_and_vertex()
    {
        var figure = new Mannequin();
        figure.Positions[7].Y = float.NaN;
        using (var character = new Character())
        {
            character.SetSkeleton(figure.Skeleton);
            MeshArrays mesh = figure.Mesh("skin");
            InvalidInputException exception = Thrown.Invalid(Status.BadInput, () => character.AddMesh(mesh));
            Assert.AreEqual(7, exception.Element);
            Assert.AreEqual(0, exception.Mesh);
            Thrown.Says(exception, "skin", "7");
        }
    }

    [Test]
    public void An_error_without_a_mesh_or_element_has_minus_one()
    {
        InvalidInputException exception = Thrown.Invalid(Status.BadStyle, () => Style.FromText("sd9"));
        Assert.AreEqual(-1, exception.Mesh);
        Assert.AreEqual(-1, exception.Element);
        Thrown.Says(exception, "sd9");
    }

    [Test]
    public void An_option_out_of_its_range_is_named()
    {
        using (Character character = new Mannequin().Character())
        using (Style style = Style.FromHeads(2.5))
        {
            InvalidInputException exception = Thrown.Invalid(Status.BadOption,
                () => new Deformer(character, style, new Options { HeadScale = 1000 }));
            Thrown.Says(exception, "head_scale", "1000");
        }
    }

    [Test]
    public void A_character_without_roles_is_no_humanoid()
    {
        using (var character = new Character())
        using (Style style = Style.FromHeads(2.5))
        {
            MeshArrays mesh = new Mannequin().Mesh();
            mesh.Joints = null;
            mesh.Weights = null;
            character.AddMesh(mesh);
            Thrown.With<NotHumanoidException>(Status.NoHumanoid, () => new Deformer(character, style));
        }
    }

    [Test]
    public void A_character_without_triangles_has_no_geometry()
    {
        using (var character = new Character())
        {
            Thrown.Invalid(Status.NoGeometry, () => character.Rig());
        }
    }

    [Test]
    public void An_output_that_is_too_small_is_named_with_its_mesh()
    {
        var figure = new Mannequin();
        using (Character character = figure.Character())
        using (Style style = Style.FromHeads(2.5))
        using (var deformer = new Deformer(character, style))
        {
            InvalidInputException exception = Thrown.Invalid(Status.BufferTooSmall,
                () => deformer.Apply(new[] { Mannequin.Output(figure.VertexCount - 1) }));
            Assert.AreEqual(0, exception.Mesh);
        }
    }

    [Test]
    public void A_handle_that_was_destroyed_elsewhere_is_a_bad_handle()
    {
        using (var character = new Character())
        {
            ulong own = character.Handle;
            character.Handle = own + (1ul << 60);
            try
            {
                Thrown.With<SuperDeformException>(Status.BadHandle, () => character.Rig());
            }
            finally
            {
                character.Handle = own;
            }
        }
    }

    [Test]
    public void What_was_disposed_of_says_its_name()
    {
        var figure = new Mannequin();
        Character character = figure.Character();
        Style style = Style.FromHeads(2.5);
        var deformer = new Deformer(character, style);
        Assert.IsFalse(deformer.IsDisposed);
        foreach (NativeObject made in new NativeObject[] { character, style, deformer })
        {
            made.Dispose();
            made.Dispose();
            Assert.IsTrue(made.IsDisposed);
        }
        AssertDisposed("Character", () => character.Info.ToString());
        AssertDisposed("Style", () => style.ToJson());
        AssertDisposed("Deformer", () => deformer.GetReport());
    }

    [Test]
    public void Null_is_refused_by_name()
    {
        using (var character = new Character())
        {
            AssertNull("mesh", () => character.AddMesh(null));
            AssertNull("skeleton", () => character.SetSkeleton(null));
            AssertNull("text", () => Style.FromText(null));
            AssertNull("style", () => new Deformer(character, null));
        }
    }

    static void AssertNull(string name, TestDelegate call)
    {
        Assert.AreEqual(name, Assert.Throws<ArgumentNullException>(call).ParamName);
    }

    static void AssertClass(Type type, params Status[] statuses)
    {
        foreach (Status status in statuses)
        {
            SuperDeformException exception = Failure.Of(status, "a sentence", -1, -1);
            Assert.AreEqual(type, exception.GetType(), status.ToString());
            Assert.AreEqual(status, exception.Status);
            Assert.AreEqual("a sentence", exception.Message);
        }
    }

    static void AssertDisposed(string name, Action call)
    {
        try
        {
            call();
        }
        catch (ObjectDisposedException exception)
        {
            Assert.AreEqual(name, exception.ObjectName);
            return;
        }
        Assert.Fail(name + " was used after it was disposed of");
    }
}
}
