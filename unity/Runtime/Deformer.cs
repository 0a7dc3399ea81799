using System;
using System.Collections.Generic;
using System.Threading;

namespace SuperDeform
{
/// <summary>
/// A character together with the deformation that gives it a style: made once, applied as often as something changes.
/// It keeps what it needs of the character and the style, which may be disposed of before it. Any thread may use it.
/// </summary>
public sealed class Deformer : NativeObject
{
    // Kept from one Apply to the next, so that a slider leaves no garbage.
    MarshalScope spare;

    /// <summary>Makes the deformation.</summary>
    /// <param name="character">With a skeleton or a made rig.</param>
    /// <param name="style">What it should become.</param>
    /// <param name="options">What begins with Rig is not read; null: the defaults.</param>
    /// <param name="progress">May be null.</param>
    /// <exception cref="NotHumanoidException">Required joints are missing.</exception>
    /// <exception cref="InvalidInputException">An option, the style or the meshes cannot be.</exception>
    public unsafe Deformer(Character character, Style style, Options options = null, ProgressHandler progress = null)
    {
        if (character == null) throw new ArgumentNullException("character");
        if (style == null) throw new ArgumentNullException("style");
        using (var scope = new MarshalScope())
        using (ProgressCall call = ProgressCall.Of(progress))
        {
            var made = new SdefDeformer();
            SdefError error = Failure.None();
            uint status = Native.sdef_deformer_create(character.Raw, style.Raw, scope.Options(options), call.Callback,
                call.User, &made, &error);
            GC.KeepAlive(character);
            GC.KeepAlive(style);
            Handle = made.id;
            call.Check(status, &error);
        }
    }

    SdefDeformer Raw => new SdefDeformer { id = Handle };

    /// <summary>
    /// Changes the options, with the same results as a new deformer and for less: only what depends on the change is done
    /// again. After an exception everything is as it was.
    /// </summary>
    public unsafe void SetOptions(Options options, ProgressHandler progress = null)
    {
        using (var scope = new MarshalScope())
        using (ProgressCall call = ProgressCall.Of(progress))
        {
            SdefError error = Failure.None();
            uint status = Native.sdef_deformer_set_options(Raw, scope.Options(options), call.Callback, call.User,
                &error);
            GC.KeepAlive(this);
            call.Check(status, &error);
        }
    }

    /// <summary>
    /// Changes the style, with the same results as a new deformer and for less: the character is not measured again. After an
    /// exception everything is as it was.
    /// </summary>
    public unsafe void SetStyle(Style style, ProgressHandler progress = null)
    {
        if (style == null) throw new ArgumentNullException("style");
        using (ProgressCall call = ProgressCall.Of(progress))
        {
            SdefError error = Failure.None();
            uint status = Native.sdef_deformer_set_style(Raw, style.Raw, call.Callback, call.User, &error);
            GC.KeepAlive(style);
            GC.KeepAlive(this);
            call.Check(status, &error);
        }
    }

    /// <summary>
    /// Deforms the meshes into the given arrays, in place and without garbage. Nothing is written where it throws.
    /// </summary>
    /// <param name="outputs">One for each mesh of the character, in their order.</param>
    /// <param name="progress">May be null.</param>
    public unsafe void Apply(IList<MeshOutput> outputs, ProgressHandler progress = null)
    {
        if (outputs == null) throw new ArgumentNullException("outputs");
        MarshalScope scope = Interlocked.Exchange(ref spare, null) ?? new MarshalScope();
        try
        {
            int count = outputs.Count;
            SdefMeshResult* results = scope.Results(outputs);
            using (ProgressCall call = ProgressCall.Of(progress))
            {
                SdefError error = Failure.None();
                uint status = Native.sdef_deformer_apply(Raw, results, (UIntPtr)(uint)count, call.Callback, call.User,
                    &error);
                GC.KeepAlive(this);
                call.Check(status, &error);
            }
        }
        finally
        {
            scope.Dispose();
            spare = scope;
        }
    }

    /// <summary>How many joints there are, in the order of <see cref="Character.GetJoints"/>.</summary>
    public unsafe int JointCount
    {
        get
        {
            UIntPtr count = UIntPtr.Zero;
            SdefError error = Failure.None();
            uint status = Native.sdef_deformer_get_joints(Raw, null, null, UIntPtr.Zero, &count, &error);
            GC.KeepAlive(this);
            Failure.Check(status, &error);
            return (int)count;
        }
    }

    /// <summary>
    /// Gives the joints where they are now. They move, and neither turn nor scale: the new rest matrix is the old one
    /// with this translation.
    /// </summary>
    /// <param name="positions">Receives 3 a joint, model space; may be null.</param>
    /// <param name="inverseBinds">Receives 16 a joint, model space to joint space; may be null.</param>
    public unsafe void GetJoints(double[] positions, double[] inverseBinds)
    {
        uint capacity = uint.MaxValue;
        if (positions != null) capacity = (uint)positions.Length / 3;
        if (inverseBinds != null) capacity = Math.Min(capacity, (uint)inverseBinds.Length / 16);
        UIntPtr count = UIntPtr.Zero;
        SdefError error = Failure.None();
        uint status;
        fixed (double* positionsOut = positions, bindsOut = inverseBinds)
        {
            status = Native.sdef_deformer_get_joints(Raw, positionsOut, bindsOut, (UIntPtr)capacity, &count, &error);
        }
        GC.KeepAlive(this);
        Failure.Check(status, &error);
    }

    /// <summary>Maps points that move with joints: colliders, eyes, viewpoints, the tails of springs.</summary>
    /// <param name="joints">The joint that each point moves with.</param>
    /// <param name="points">3 a point, model space.</param>
    /// <param name="positions">Receives 3 a point, model space; may be null.</param>
    /// <param name="scales">Receives one a point: by how much small things there grow; may be null.</param>
    /// <param name="jacobians">
    /// Receives 9 a point, column by column: how directions and lengths there change; may be null.
    /// </param>
    /// <exception cref="InvalidInputException">With the point as the element.</exception>
    public unsafe void MapPoints(uint[] joints, double[] points, double[] positions, double[] scales = null,
        double[] jacobians = null)
    {
        if (joints == null) throw new ArgumentNullException("joints");
        if (points == null) throw new ArgumentNullException("points");
        CheckPoints(points, "points", joints.Length, 3);
        CheckPoints(positions, "positions", joints.Length, 3);
        CheckPoints(scales, "scales", joints.Length, 1);
        CheckPoints(jacobians, "jacobians", joints.Length, 9);
        SdefError error = Failure.None();
        uint status;
        fixed (uint* jointsIn = joints)
        fixed (double* pointsIn = points, positionsOut = positions, scalesOut = scales, jacobiansOut = jacobians)
        {
            status = Native.sdef_deformer_map_points(Raw, jointsIn, pointsIn, (UIntPtr)(uint)joints.Length,
                positionsOut, scalesOut, jacobiansOut, &error);
        }
        GC.KeepAlive(this);
        Failure.Check(status, &error);
    }

    /// <summary>
    /// Maps colliders of springs: their points go as MapPoints has it, and they are as thick as the mesh around them, a capsule
    /// across its axis. One that a spring would start nearer to than it was, or deeper in, yields by a fifth of its radius at
    /// most. Distances count for the spring's size, and no further than its own radius.
    /// </summary>
    /// <param name="springs">What colliders may name; null for none.</param>
    /// <exception cref="InvalidInputException">With the collider, or the spring, as the element.</exception>
    public unsafe SpringCollider[] MapColliders(SpringCollider[] colliders, SpringBall[] springs = null)
    {
        if (colliders == null) throw new ArgumentNullException("colliders");
        SpringCollider[] results = (SpringCollider[])colliders.Clone();
        SdefCollider[] native = new SdefCollider[colliders.Length];
        SdefSpringBall[] balls = Array.ConvertAll(springs ?? new SpringBall[0], ball => new SdefSpringBall
        {
            struct_size = (uint)sizeof(SdefSpringBall), joint = ball.Joint, x = ball.X, y = ball.Y, z = ball.Z, radius = ball.Radius
        });
        var named = new List<uint>();
        foreach (SpringCollider collider in colliders) named.AddRange(collider.Springs ?? new uint[0]);
        uint[] all = named.ToArray();
        SdefError error = Failure.None();
        uint status;
        fixed (SdefCollider* items = native)
        fixed (SdefSpringBall* ballsIn = balls)
        fixed (uint* names = all)
        {
            uint* next = names;
            for (int i = 0; i < colliders.Length; i++)
            {
                SpringCollider from = colliders[i];
                int count = from.Springs == null ? 0 : from.Springs.Length;
                items[i] = new SdefCollider
                {
                    struct_size = (uint)sizeof(SdefCollider), kind = (uint)from.Kind, joint = from.Joint, spring_count = (uint)count,
                    springs = count == 0 ? null : next, x = from.X, y = from.Y, z = from.Z,
                    end_x = from.EndX, end_y = from.EndY, end_z = from.EndZ, radius = from.Radius
                };
                next += count;
            }
            status = Native.sdef_deformer_map_colliders(Raw, items, (UIntPtr)(uint)native.Length, ballsIn, (UIntPtr)(uint)balls.Length, items, &error);
        }
        GC.KeepAlive(this);
        Failure.Check(status, &error);
        for (int i = 0; i < results.Length; i++)
        {
            SdefCollider to = native[i];
            results[i].X = to.x;
            results[i].Y = to.y;
            results[i].Z = to.z;
            results[i].EndX = to.end_x;
            results[i].EndY = to.end_y;
            results[i].EndZ = to.end_z;
            results[i].Radius = to.radius;
            results[i].Yielded = to.yielded;
            results[i].NewlyInside = to.newly_inside;
        }
        return results;
    }

    /// <summary>
    /// Maps morph targets of a mesh where they change something, in place: those that the character was not given too, with the
    /// results that Apply has. For more targets than there is memory for all of them at once. Arrays may be longer than is needed.
    /// </summary>
    /// <param name="mesh">The mesh that they are of.</param>
    /// <param name="vertexCounts">How many vertices each target changes.</param>
    /// <param name="vertices">Those of each target, ascending, one target after the other.</param>
    /// <param name="positions">3 floats for each of these: what is added at weight 1. float[], or any struct of 3 floats.</param>
    /// <param name="normals">Likewise; may be null.</param>
    /// <param name="tangents">Likewise.</param>
    /// <exception cref="InvalidInputException">With the vertex that the mesh has not, or whose change is no number.</exception>
    public unsafe void MapMorphTargets(int mesh, uint[] vertexCounts, uint[] vertices, Array positions, Array normals = null,
        Array tangents = null)
    {
        if (vertexCounts == null) throw new ArgumentNullException("vertexCounts");
        long sum = 0;
        foreach (uint count in vertexCounts) sum += count;
        int given = vertices == null ? 0 : vertices.Length;
        if (sum > given) throw Failure.Argument("vertices holds " + given + " numbers, but vertexCounts are " + sum + " together");
        var owner = new Owner("morph targets of mesh", mesh);
        if (positions == null && sum > 0) throw owner.Wrong("Positions is null: give 3 floats for each of vertices");
        using (var scope = new MarshalScope())
        {
            SdefError error = Failure.None();
            uint status = Native.sdef_deformer_map_morph_targets(Raw, unchecked((uint)mesh), (uint*)scope.Pin(vertexCounts, "vertexCounts"),
                (UIntPtr)(uint)vertexCounts.Length, (uint*)scope.Pin(vertices, "vertices"),
                MarshalMeshes.Vectors(scope, positions, owner, "Positions", 3, 0, (int)sum),
                MarshalMeshes.Vectors(scope, normals, owner, "Normals", 3, 0, (int)sum),
                MarshalMeshes.Vectors(scope, tangents, owner, "Tangents", 3, 0, (int)sum), &error);
            GC.KeepAlive(this);
            Failure.Check(status, &error);
        }
    }

    /// <summary>What is done to each bone group.</summary>
    public unsafe Group[] GetGroups()
    {
        UIntPtr count = UIntPtr.Zero;
        SdefError error = Failure.None();
        uint status = Native.sdef_deformer_get_groups(Raw, null, UIntPtr.Zero, &count, &error);
        Failure.Check(status, &error);
        SdefGroup[] native = new SdefGroup[(int)count];
        Group[] groups = new Group[native.Length];
        fixed (SdefGroup* start = native)
        {
            if (native.Length > 0) start->struct_size = (uint)sizeof(SdefGroup);
            status = Native.sdef_deformer_get_groups(Raw, start, count, &count, &error);
            GC.KeepAlive(this);
            Failure.Check(status, &error);
            for (int i = 0; i < groups.Length; i++) groups[i] = new Group(start + i);
        }
        return groups;
    }

    /// <summary>
    /// Measures the result, as the first <see cref="GetReport"/> after a change does, and says how far it is; after it that
    /// is for free.
    /// </summary>
    /// <exception cref="InvalidInputException">NoGeometry where the result is too flat to be measured.</exception>
    public unsafe void Measure(ProgressHandler progress = null)
    {
        using (ProgressCall call = ProgressCall.Of(progress))
        {
            SdefError error = Failure.None();
            uint status = Native.sdef_deformer_measure(Raw, call.Callback, call.User, &error);
            GC.KeepAlive(this);
            call.Check(status, &error);
        }
    }

    /// <summary>
    /// Measures the result. The first call after a change takes as long as an apply and a measurement together.
    /// </summary>
    /// <exception cref="InvalidInputException">NoGeometry where the result is too flat to be measured.</exception>
    public unsafe Report GetReport()
    {
        var report = new SdefReport();
        report.struct_size = (uint)sizeof(SdefReport);
        SdefError error = Failure.None();
        uint status = Native.sdef_deformer_get_report(Raw, &report, null, UIntPtr.Zero, null, &error);
        GC.KeepAlive(this);
        Failure.Check(status, &error);
        return new Report(report, GetFigure(Native.SDEF_FIGURE_TARGET), GetFigure(Native.SDEF_FIGURE_REFERENCE),
            GetFigure(Native.SDEF_FIGURE_RESULT));
    }

    unsafe Figure GetFigure(uint which)
    {
        var figure = new SdefFigure();
        figure.struct_size = (uint)sizeof(SdefFigure);
        SdefError error = Failure.None();
        uint status = Native.sdef_deformer_get_figure(Raw, which, &figure, &error);
        GC.KeepAlive(this);
        Failure.Check(status, &error);
        return new Figure(figure);
    }

    /// <summary>The report as JSON text: numbers by group and role, times, warnings.</summary>
    public unsafe string GetReportJson()
    {
        SdefDeformer raw = Raw;
        string json = Text.Read((text, capacity, size, error) =>
            Native.sdef_deformer_get_report(raw, null, text, capacity, size, error));
        GC.KeepAlive(this);
        return json;
    }

    /// <summary>Warnings about the deformation and all before it; empty where there are none.</summary>
    public IList<Warning> Warnings
    {
        get
        {
            IList<Warning> warnings = Warning.Of(Handle);
            GC.KeepAlive(this);
            return warnings;
        }
    }

    static void CheckPoints(double[] array, string name, int count, int each)
    {
        if (array == null || array.Length >= (long)each * count) return;
        throw Failure.Argument(name + " holds " + array.Length + " numbers, but " + count + " points need "
            + (long)each * count);
    }
}
}
