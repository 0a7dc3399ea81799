using System;
using System.Collections.Generic;

namespace SuperDeform
{
/// <summary>
/// Everything that can be set; each call reads what concerns it. Null stands for the defaults. What is one number stands in
/// Native.g.cs.
/// </summary>
[Serializable]
public sealed partial class Options
{
    /// <summary>Threads to use, up to 1024; 0 (default): all cores.</summary>
    public uint ThreadCount;

    /// <summary>Default <see cref="SuperDeform.Mode.Product"/>.</summary>
    public Mode Mode = Mode.Product;

    /// <summary>Stop after it; default <see cref="SuperDeform.Stage.Face"/>, which is everything.</summary>
    public Stage Stage = Stage.Face;

    /// <summary>Rays around a sample of a bone, 3 to 4096; 0 (default): the mode's own, 48 or 12.</summary>
    public uint Rays;

    /// <summary>Bounds what product mode may do to a body (default).</summary>
    public bool Limits = OptionDefaults.Limits;

    /// <summary>
    /// How much younger the face gets, -10 to 10 (bounded where it would fold); 0 leaves it; NaN (default): 0.8 in
    /// product mode where a face is found, 0 in paper mode.
    /// </summary>
    public double FaceSquash = double.NaN;

    /// <summary>
    /// How tall the result is, in the character's units, grown or shrunk as a whole about the ground; 0: as tall as the
    /// character was; NaN (default): as the style makes it.
    /// </summary>
    public double Height = double.NaN;

    /// <summary>Clothes that were outside of the body and would end inside; default On; product mode alone.</summary>
    public Repair Repair = Repair.On;

    /// <summary>Default <see cref="SuperDeform.FaceCurve.F4"/>.</summary>
    public FaceCurve FaceCurve = FaceCurve.F4;

    /// <summary>Settings by bone group. May be null.</summary>
    public List<GroupSettings> Groups = new List<GroupSettings>();

    /// <summary>Bone groups of your own. May be null.</summary>
    public List<BoneGroup> BoneGroups = new List<BoneGroup>();

    /// <summary>Rig: how the weights of the body are made; default Auto.</summary>
    public BodyWeights RigWeights = BodyWeights.Auto;

    /// <summary>Rig: how the weights of clothes are made; default Robust.</summary>
    public GarmentWeights RigGarments = GarmentWeights.Robust;

    /// <summary>Rig: voxels along the longest side of the volume, 16 to 512; default 128.</summary>
    public uint RigVoxelResolution = OptionDefaults.RigVoxelResolution;

    /// <summary>Rig: looks for fingers (default).</summary>
    public bool RigFingers = OptionDefaults.RigFingers;

    /// <summary>Rig: how sharp weights by heat are, 0.01 to 1000; default 1.</summary>
    public double RigHeat = OptionDefaults.RigHeat;

    /// <summary>Rig: tells left from right in left-handed axes, Unity's; default false.</summary>
    public bool RigLeftHanded = OptionDefaults.RigLeftHanded;

    /// <summary>Rig: joints that are known; the rest is found. May be null.</summary>
    public List<GivenJoint> RigJoints = new List<GivenJoint>();

    /// <summary>A copy that shares nothing with this one.</summary>
    public Options Clone()
    {
        Options copy = (Options)MemberwiseClone();
        if (Groups != null) copy.Groups = Groups.ConvertAll(group => group == null ? null : group.Clone());
        if (BoneGroups != null) copy.BoneGroups = BoneGroups.ConvertAll(bone => bone == null ? null : bone.Clone());
        if (RigJoints != null) copy.RigJoints = new List<GivenJoint>(RigJoints);
        return copy;
    }

    /// <summary>Fills the library's struct in, but for the lists.</summary>
    internal unsafe void Write(SdefOptions* native)
    {
        WriteNumbers(native);
        native->thread_count = ThreadCount;
        native->mode = (uint)Mode;
        native->stage = (uint)Stage;
        native->rays = Rays;
        native->limits = Limits ? 1u : 0u;
        native->face_squash = FaceSquash;
        native->height = Height;
        native->repair = (uint)Repair;
        native->face_curve = (uint)FaceCurve;
        native->rig_weights = (uint)RigWeights;
        native->rig_garments = (uint)RigGarments;
        native->rig_voxel_resolution = RigVoxelResolution;
        native->rig_fingers = RigFingers ? 1u : 0u;
        native->rig_heat = RigHeat;
        native->rig_left_handed = RigLeftHanded ? 1u : 0u;
    }
}

/// <summary>Settings of one bone group; NaN in any number (default) leaves the measured or the default value.</summary>
[Serializable]
public sealed class GroupSettings
{
    /// <summary>
    /// head, neck, torso, shoulder, upper_arm, lower_arm, hand, finger, hip, upper_leg, lower_leg, foot, or a name of
    /// your own from <see cref="Options.BoneGroups"/>.
    /// </summary>
    public string Group;

    /// <summary>1 keeps the length of the group's bones; 0.01 to 10.</summary>
    public double LengthScale = double.NaN;

    /// <summary>1 keeps the thickness; 0.01 to 10.</summary>
    public double ThicknessScale = double.NaN;

    /// <summary>0 keeps the target's length, 1 takes all of the reference's.</summary>
    public double LengthTransfer = double.NaN;

    /// <summary>0 keeps the target's thickness, 1 takes all of the reference's.</summary>
    public double ThicknessTransfer = double.NaN;

    /// <summary>Whether it sets nothing.</summary>
    public bool IsEmpty
    {
        get
        {
            return double.IsNaN(LengthScale) && double.IsNaN(ThicknessScale) && double.IsNaN(LengthTransfer)
                && double.IsNaN(ThicknessTransfer);
        }
    }

    /// <summary>A copy.</summary>
    public GroupSettings Clone() => (GroupSettings)MemberwiseClone();

    /// <summary>Fills the library's struct in, but for the name.</summary>
    internal unsafe void Write(SdefGroupSettings* native)
    {
        native->length_scale = LengthScale;
        native->thickness_scale = ThicknessScale;
        native->length_transfer = LengthTransfer;
        native->thickness_transfer = ThicknessTransfer;
    }
}

/// <summary>A bone in a group of your own.</summary>
[Serializable]
public sealed class BoneGroup
{
    /// <summary>The role at the end of the bone: LeftLowerLeg is the left thigh.</summary>
    public HumanoidRole Role;

    /// <summary>The group's name.</summary>
    public string Group;

    /// <summary>A copy.</summary>
    public BoneGroup Clone() => (BoneGroup)MemberwiseClone();
}

/// <summary>Where a joint is known to be, for making a rig.</summary>
[Serializable]
public struct GivenJoint
{
    public GivenJoint(HumanoidRole role, double x, double y, double z)
    {
        Role = role;
        X = x;
        Y = y;
        Z = z;
    }

    public HumanoidRole Role;

    /// <summary>Model space.</summary>
    public double X;

    /// <summary>Model space.</summary>
    public double Y;

    /// <summary>Model space.</summary>
    public double Z;
}
}
