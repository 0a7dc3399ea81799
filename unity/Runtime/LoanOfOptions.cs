namespace SuperDeform
{
/// <summary>Options as the library's struct.</summary>
internal static unsafe class LoanOfOptions
{
    /// <summary>Null for null.</summary>
    internal static SdefOptions* Options(this Loan loan, Options options)
    {
        if (options == null) return null;
        SdefOptions* native = (SdefOptions*)loan.Room(sizeof(SdefOptions));
        // First the library's own defaults, so that only what is named here is ours.
        SdefError error = Failure.None();
        Failure.Check(Native.sdef_options_init(native, (uint)sizeof(SdefOptions), &error), &error);
        native->thread_count = options.ThreadCount;
        native->mode = (uint)options.Mode;
        native->stage = (uint)options.Stage;
        native->rays = options.Rays;
        native->limits = options.Limits ? 1u : 0u;
        native->head_scale = options.HeadScale;
        native->amount = options.Amount;
        native->hair_length = options.HairLength;
        native->face_squash = options.FaceSquash;
        native->face_curve = (uint)options.FaceCurve;
        native->rig_weights = (uint)options.RigWeights;
        native->rig_garments = (uint)options.RigGarments;
        native->rig_voxel_resolution = options.RigVoxelResolution;
        native->rig_fingers = options.RigFingers ? 1u : 0u;
        native->rig_chin_segment = options.RigChinSegment ? 1u : 0u;
        native->rig_heat = options.RigHeat;
        native->rig_left_handed = options.RigLeftHanded ? 1u : 0u;
        Groups(loan, native, options);
        BoneGroups(loan, native, options);
        RigJoints(loan, native, options);
        return native;
    }

    private static void Groups(Loan loan, SdefOptions* native, Options options)
    {
        int count = options.Groups == null ? 0 : options.Groups.Count;
        SdefGroupSettings* groups = (SdefGroupSettings*)loan.Room(count * sizeof(SdefGroupSettings));
        for (int i = 0; i < count; i++)
        {
            GroupSettings group = options.Groups[i];
            if (group == null) throw Failure.Argument("Groups[" + i + "] is null: leave it out");
            groups[i].group = loan.Text(group.Group);
            groups[i].length_scale = group.LengthScale;
            groups[i].thickness_scale = group.ThicknessScale;
            groups[i].length_transfer = group.LengthTransfer;
            groups[i].thickness_transfer = group.ThicknessTransfer;
        }
        native->groups = groups;
        native->group_count = (uint)count;
    }

    private static void BoneGroups(Loan loan, SdefOptions* native, Options options)
    {
        int count = options.BoneGroups == null ? 0 : options.BoneGroups.Count;
        SdefBoneGroup* groups = (SdefBoneGroup*)loan.Room(count * sizeof(SdefBoneGroup));
        for (int i = 0; i < count; i++)
        {
            BoneGroup group = options.BoneGroups[i];
            if (group == null) throw Failure.Argument("BoneGroups[" + i + "] is null: leave it out");
            groups[i].role = unchecked((uint)group.Role);
            groups[i].group = loan.Text(group.Group);
        }
        native->bone_groups = groups;
        native->bone_group_count = (uint)count;
    }

    private static void RigJoints(Loan loan, SdefOptions* native, Options options)
    {
        int count = options.RigJoints == null ? 0 : options.RigJoints.Count;
        SdefGivenJoint* joints = (SdefGivenJoint*)loan.Room(count * sizeof(SdefGivenJoint));
        for (int i = 0; i < count; i++)
        {
            GivenJoint joint = options.RigJoints[i];
            joints[i].role = unchecked((uint)joint.Role);
            joints[i].x = joint.X;
            joints[i].y = joint.Y;
            joints[i].z = joint.Z;
        }
        native->rig_joints = joints;
        native->rig_joint_count = (uint)count;
    }
}
}
