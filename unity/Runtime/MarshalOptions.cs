namespace SuperDeform
{
/// <summary>Options as the library's struct.</summary>
internal static unsafe class MarshalOptions
{
    /// <summary>Null for null.</summary>
    internal static SdefOptions* Options(this MarshalScope scope, Options options)
    {
        if (options == null) return null;
        SdefOptions* native = (SdefOptions*)scope.Alloc(sizeof(SdefOptions));
        // First the library's own defaults, so that a newer library's other options keep theirs.
        SdefError error = Failure.None();
        Failure.Check(Native.sdef_options_init(native, (uint)sizeof(SdefOptions), &error), &error);
        options.Write(native);
        Groups(scope, native, options);
        BoneGroups(scope, native, options);
        RigJoints(scope, native, options);
        return native;
    }

    static void Groups(MarshalScope scope, SdefOptions* native, Options options)
    {
        int count = options.Groups == null ? 0 : options.Groups.Count;
        SdefGroupSettings* groups = (SdefGroupSettings*)scope.Alloc(count * sizeof(SdefGroupSettings));
        for (int i = 0; i < count; i++)
        {
            GroupSettings group = options.Groups[i];
            if (group == null) throw Failure.Argument("Groups[" + i + "] is null: leave it out");
            groups[i].struct_size = (uint)sizeof(SdefGroupSettings);
            groups[i].group = scope.Text(group.Group);
            group.Write(groups + i);
        }
        native->groups = groups;
        native->group_count = (uint)count;
    }

    static void BoneGroups(MarshalScope scope, SdefOptions* native, Options options)
    {
        int count = options.BoneGroups == null ? 0 : options.BoneGroups.Count;
        SdefBoneGroup* groups = (SdefBoneGroup*)scope.Alloc(count * sizeof(SdefBoneGroup));
        for (int i = 0; i < count; i++)
        {
            BoneGroup group = options.BoneGroups[i];
            if (group == null) throw Failure.Argument("BoneGroups[" + i + "] is null: leave it out");
            groups[i].struct_size = (uint)sizeof(SdefBoneGroup);
            groups[i].role = unchecked((uint)group.Role);
            groups[i].group = scope.Text(group.Group);
        }
        native->bone_groups = groups;
        native->bone_group_count = (uint)count;
    }

    static void RigJoints(MarshalScope scope, SdefOptions* native, Options options)
    {
        int count = options.RigJoints == null ? 0 : options.RigJoints.Count;
        SdefGivenJoint* joints = (SdefGivenJoint*)scope.Alloc(count * sizeof(SdefGivenJoint));
        for (int i = 0; i < count; i++)
        {
            GivenJoint joint = options.RigJoints[i];
            joints[i].struct_size = (uint)sizeof(SdefGivenJoint);
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
