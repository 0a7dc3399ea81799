using System;
using System.Collections.Generic;

namespace SuperDeform
{
/// <summary>
/// A character: meshes, joints, weights, all in one space (model space) and in rest pose, best with arms out. Units are
/// any, and so are handedness and direction up. Joints come first, then meshes, which name them, then morph targets.
/// Any thread may use it; calls that change it throw <see cref="BusyException"/> beside others.
/// </summary>
public sealed class Character : NativeObject
{
    // By mesh: the library tells vertices of all meshes together only.
    readonly List<int> vertexCounts = new List<int>();

    /// <summary>Makes an empty character.</summary>
    /// <param name="up">3 floats, from the feet to the head, any length but 0; null: (0, 1, 0), or
    /// for a character without a rig another axis along which it stands as people do.</param>
    /// <param name="forward">
    /// 3 floats, the way the face looks; null: found from left and right limbs, as in right-handed axes, so a
    /// left-handed host gives it.
    /// </param>
    public unsafe Character(float[] up = null, float[] forward = null)
    {
        CheckDirection(up, "up");
        CheckDirection(forward, "forward");
        var made = new SdefCharacter();
        SdefError error = Failure.None();
        uint status;
        fixed (float* upwards = up, ahead = forward)
        {
            status = Native.sdef_character_create(upwards, ahead, &made, &error);
        }
        Failure.Check(status, &error);
        Handle = made.id;
    }

    internal SdefCharacter Raw => new SdefCharacter { id = Handle };

    /// <summary>Gives it joints, in place of any that it had. Comes before meshes with weights.</summary>
    /// <exception cref="InvalidInputException">With the joint: a parent that is none, a circle of parents, a number
    /// that is not finite, a role for a joint that is none.</exception>
    public unsafe void SetSkeleton(SkeletonArrays skeleton)
    {
        if (skeleton == null) throw new ArgumentNullException("skeleton");
        using (var scope = new MarshalScope())
        {
            var native = new SdefSkeleton();
            scope.Fill(&native, skeleton);
            SdefError error = Failure.None();
            uint status = Native.sdef_character_set_skeleton(Raw, &native, &error);
            GC.KeepAlive(this);
            Failure.Check(status, &error);
        }
    }

    /// <summary>Adds a mesh and gives its index, counted from 0. A rig made before goes.</summary>
    /// <exception cref="InvalidInputException">With the vertex or triangle: an index, weight or position that cannot
    /// be.</exception>
    public unsafe int AddMesh(MeshArrays mesh)
    {
        if (mesh == null) throw new ArgumentNullException("mesh");
        using (var scope = new MarshalScope())
        {
            var native = new SdefMesh();
            scope.Fill(&native, mesh, vertexCounts.Count);
            uint index = Native.SDEF_NONE;
            SdefError error = Failure.None();
            // Held during the call, so that counts stay in the order of meshes.
            lock (vertexCounts)
            {
                uint status = Native.sdef_character_add_mesh(Raw, &native, &index, &error);
                GC.KeepAlive(this);
                Failure.Check(status, &error);
                vertexCounts.Add((int)native.vertex_count);
            }
            return (int)index;
        }
    }

    /// <summary>Adds an image that meshes show, before these, and gives the number that they name it by.</summary>
    /// <param name="width">Pixels in a row.</param>
    /// <param name="height">Rows.</param>
    /// <param name="pixels">
    /// From black (0) to white (255), as 54 red + 183 green + 19 blue of 256; the row of v = 0 first.
    /// </param>
    public unsafe int AddImage(int width, int height, byte[] pixels)
    {
        if (pixels == null) throw new ArgumentNullException("pixels");
        if (width < 1 || height < 1 || (long)width * height > pixels.Length)
        {
            throw Failure.Argument("an image of " + width + " by " + height + " pixels does not fit " + pixels.Length
                + " bytes: give one a pixel");
        }
        var image = new SdefImage();
        image.struct_size = (uint)sizeof(SdefImage);
        image.width = (uint)width;
        image.height = (uint)height;
        uint number;
        SdefError error = Failure.None();
        uint status;
        fixed (byte* start = pixels)
        {
            image.pixels = start;
            status = Native.sdef_character_add_image(Raw, &image, &number, &error);
        }
        GC.KeepAlive(this);
        Failure.Check(status, &error);
        return (int)number;
    }

    /// <summary>Says where the eyes are, where that cannot be seen in the meshes; in model space.</summary>
    /// <param name="eye">3 numbers: the middle of an eye's opening; null: nothing is known.</param>
    /// <param name="otherEye">Likewise; null: the mirror image of the first.</param>
    /// <param name="halfWidth">Half the width of an opening; 0: not known.</param>
    /// <param name="halfHeight">Half its height; 0: not known.</param>
    /// <exception cref="InvalidInputException">A number that is not finite, or a size below 0.</exception>
    public unsafe void SetFaceHints(double[] eye, double[] otherEye = null, double halfWidth = 0, double halfHeight = 0)
    {
        CheckPlace(eye, "eye");
        CheckPlace(otherEye, "otherEye");
        var hints = new SdefFaceHints();
        hints.struct_size = (uint)sizeof(SdefFaceHints);
        hints.half_width = halfWidth;
        hints.half_height = halfHeight;
        SdefError error = Failure.None();
        uint status;
        fixed (double* one = eye, other = otherEye)
        {
            hints.eye = one;
            hints.other_eye = other;
            status = Native.sdef_character_set_face_hints(Raw, &hints, &error);
        }
        GC.KeepAlive(this);
        Failure.Check(status, &error);
    }

    /// <summary>Adds a morph target to a mesh, after those that it has.</summary>
    /// <exception cref="InvalidInputException">With the vertex that is not finite; or no such mesh.</exception>
    public unsafe void AddMorphTarget(int mesh, MorphArrays target)
    {
        if (target == null) throw new ArgumentNullException("target");
        int count;
        lock (vertexCounts)
        {
            if (mesh < 0 || mesh >= vertexCounts.Count)
            {
                throw Failure.Argument("there is no mesh " + mesh + ": the character has " + vertexCounts.Count);
            }
            count = vertexCounts[mesh];
        }
        using (var scope = new MarshalScope())
        {
            var native = new SdefMorphTarget();
            scope.Fill(&native, target, mesh, count);
            SdefError error = Failure.None();
            uint status = Native.sdef_character_add_morph_target(Raw, (uint)mesh, &native, &error);
            GC.KeepAlive(this);
            Failure.Check(status, &error);
        }
    }

    /// <summary>
    /// Whether morph targets of this name say something of the character, as blinks say where the eyes open: these are added to
    /// it. All others can go through <see cref="Deformer.MapMorphTargets"/> alone, which needs less memory.
    /// </summary>
    public static unsafe bool ReadsMorphTarget(string name)
    {
        using (var scope = new MarshalScope()) return Native.sdef_morph_target_is_read(scope.Text(name)) != 0;
    }

    /// <summary>What it holds.</summary>
    public unsafe CharacterInfo Info
    {
        get
        {
            var info = new SdefCharacterInfo();
            info.struct_size = (uint)sizeof(SdefCharacterInfo);
            SdefError error = Failure.None();
            uint status = Native.sdef_character_get_info(Raw, &info, &error);
            GC.KeepAlive(this);
            Failure.Check(status, &error);
            return new CharacterInfo(info);
        }
    }

    /// <summary>The joints: own ones first, then those of a made rig.</summary>
    public unsafe Joints GetJoints()
    {
        var joints = new Joints(Info.JointCount);
        SdefError error = Failure.None();
        uint status;
        UIntPtr count;
        fixed (int* parents = joints.Parents)
        fixed (HumanoidRole* roles = joints.Roles)
        fixed (double* matrices = joints.RestMatrices, confidence = joints.Confidence)
        {
            status = Native.sdef_character_get_joints(Raw, parents, (uint*)roles, matrices, confidence,
                (UIntPtr)(uint)joints.Count, &count, &error);
        }
        GC.KeepAlive(this);
        Failure.Check(status, &error);
        return joints;
    }

    /// <summary>Gives the weights that animate one mesh: those of a made rig, else its own.</summary>
    /// <param name="mesh">Its index.</param>
    /// <param name="influences">
    /// Joints a vertex, 1 to 255: the largest weights, largest first, scaled to sum 1; what a vertex has no use for is
    /// joint 0 with weight 0.
    /// </param>
    /// <param name="joints">Receives `influences` numbers a vertex.</param>
    /// <param name="weights">Likewise.</param>
    /// <exception cref="InvalidInputException">The mesh has no weights, or an array is too small.</exception>
    public unsafe void GetWeights(int mesh, int influences, uint[] joints, float[] weights)
    {
        if (joints == null) throw new ArgumentNullException("joints");
        if (weights == null) throw new ArgumentNullException("weights");
        uint each = influences < 0 ? 0 : (uint)influences;
        uint capacity = each == 0 ? 0 : (uint)Math.Min(joints.Length, weights.Length) / each;
        SdefError error = Failure.None();
        uint status;
        fixed (uint* jointsOut = joints)
        fixed (float* weightsOut = weights)
        {
            status = Native.sdef_character_get_weights(Raw, unchecked((uint)mesh), each, jointsOut, weightsOut,
                (UIntPtr)capacity, &error);
        }
        GC.KeepAlive(this);
        Failure.Check(status, &error);
    }

    /// <summary>
    /// Finds joints and weights for a character without a rig, in place of any that was made before. Its own joints
    /// stay, come first and ride along; its own weights are not used. Takes seconds.
    /// </summary>
    /// <param name="options">ThreadCount and what begins with Rig are read; null: the defaults.</param>
    /// <param name="progress">May be null.</param>
    public unsafe void Rig(Options options = null, ProgressHandler progress = null)
    {
        using (var scope = new MarshalScope())
        using (ProgressCall call = ProgressCall.Of(progress))
        {
            SdefError error = Failure.None();
            uint status = Native.sdef_character_rig(Raw, scope.Options(options), call.Callback, call.User, &error);
            GC.KeepAlive(this);
            call.Check(status, &error);
        }
    }

    /// <summary>Warnings about the rig and the roles; empty where there are none.</summary>
    public IList<Warning> Warnings
    {
        get
        {
            IList<Warning> warnings = Warning.Of(Handle);
            GC.KeepAlive(this);
            return warnings;
        }
    }

    static void CheckPlace(double[] place, string name)
    {
        if (place != null && place.Length != 3) throw Failure.Argument(name + " holds " + place.Length + " numbers: give 3, or null");
    }

    internal static void CheckDirection(float[] direction, string name)
    {
        if (direction != null && direction.Length != 3) throw Failure.Argument(name + " holds " + direction.Length + " numbers: give 3, or null");
    }
}
}
