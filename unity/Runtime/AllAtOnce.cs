using System;
using System.Collections.Generic;

namespace SuperDeform
{
/// <summary>Everything at once, for hosts that keep nothing.</summary>
public static class AllAtOnce
{
    /// <summary>Deforms meshes in one call. Morph targets go through <see cref="Deformer"/> alone.</summary>
    /// <param name="up">As for a <see cref="Character"/>.</param>
    /// <param name="forward">As for a <see cref="Character"/>.</param>
    /// <param name="skeleton">Null: a rig is made.</param>
    /// <param name="meshes">Read before anything is written, so results may go where they came from.</param>
    /// <param name="style">What they should become.</param>
    /// <param name="options">Null: the defaults.</param>
    /// <param name="outputs">One for each mesh.</param>
    /// <param name="progress">May be null.</param>
    public static unsafe void SuperDeform(float[] up, float[] forward, SkeletonArrays skeleton,
        IList<MeshArrays> meshes, Style style, Options options, IList<MeshOutput> outputs,
        ProgressHandler progress = null)
    {
        if (meshes == null) throw new ArgumentNullException("meshes");
        if (style == null) throw new ArgumentNullException("style");
        if (outputs == null) throw new ArgumentNullException("outputs");
        Character.CheckDirection(up, "up");
        Character.CheckDirection(forward, "forward");
        int count = meshes.Count;
        if (outputs.Count != count) throw Failure.Argument("there are " + outputs.Count + " outputs for " + count + " meshes: give one each");
        using (var scope = new MarshalScope())
        using (ProgressCall call = ProgressCall.Of(progress))
        {
            var joints = new SdefSkeleton();
            if (skeleton != null) scope.Fill(&joints, skeleton);
            SdefMesh* inputs = (SdefMesh*)scope.Alloc(checked(count * sizeof(SdefMesh)));
            for (int mesh = 0; mesh < count; mesh++) scope.Fill(inputs + mesh, meshes[mesh], mesh);
            SdefMeshResult* results = scope.Results(outputs);
            SdefError error = Failure.None();
            uint status = Native.sdef_super_deform((float*)scope.Pin(up, "up"), (float*)scope.Pin(forward, "forward"),
                skeleton == null ? null : &joints, inputs, (UIntPtr)(uint)count, style.Raw, scope.Options(options),
                results, call.Callback, call.User, &error);
            GC.KeepAlive(style);
            call.Check(status, &error);
        }
    }
}
}
