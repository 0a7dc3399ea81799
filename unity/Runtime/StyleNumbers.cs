namespace SuperDeform
{
/// <summary>
/// A style as plain numbers, in the units of its model; NaN (default): not known. Product mode transfers what is from
/// <see cref="HeadHalfWidth"/> on, paper mode the bones.
/// </summary>
public sealed class StyleNumbers
{
    /// <summary>How many heads tall; what is read of a style for N heads, else only given.</summary>
    public double Heads = double.NaN;

    /// <summary>Head joint to head top, above 0.</summary>
    public double BoneHeadLength = double.NaN;

    /// <summary>Height of a landmark along up, model space.</summary>
    public double Crown = double.NaN;

    /// <summary>Height.</summary>
    public double Chin = double.NaN;

    /// <summary>Height.</summary>
    public double ShoulderLine = double.NaN;

    /// <summary>Height.</summary>
    public double Crotch = double.NaN;

    /// <summary>Height.</summary>
    public double Sole = double.NaN;

    /// <summary>Chin to crown.</summary>
    public double HeadLength = double.NaN;

    /// <summary>Half the head's width.</summary>
    public double HeadHalfWidth = double.NaN;

    /// <summary>Shoulder line to chin.</summary>
    public double Neck = double.NaN;

    /// <summary>Crotch to shoulder line.</summary>
    public double Torso = double.NaN;

    /// <summary>Shoulder to wrist.</summary>
    public double Arm = double.NaN;

    /// <summary>Sole to crotch.</summary>
    public double Leg = double.NaN;

    /// <summary>Sole to ankle.</summary>
    public double AnkleHeight = double.NaN;

    /// <summary>Wrist to finger tips.</summary>
    public double Hand = double.NaN;

    /// <summary>Heel to toe.</summary>
    public double Foot = double.NaN;

    /// <summary>Median half width of the torso.</summary>
    public double TorsoHalfWidth = double.NaN;

    /// <summary>Mean distance of the surface to the bone.</summary>
    public double UpperArmRadius = double.NaN;

    /// <summary>Likewise.</summary>
    public double LowerArmRadius = double.NaN;

    /// <summary>Likewise.</summary>
    public double UpperLegRadius = double.NaN;

    /// <summary>Likewise.</summary>
    public double LowerLegRadius = double.NaN;

    /// <summary>The eyes' height above the chin over HeadLength, 0 to 1.</summary>
    public double EyeHeight = double.NaN;

    /// <summary>Square root of half an eye's width by half its height, over HeadLength, 0 to 0.5.</summary>
    public double EyeSize = double.NaN;

    /// <summary>Half the head's depth.</summary>
    public double HeadHalfDepth = double.NaN;

    public StyleNumbers() { }

    internal StyleNumbers(SdefStyleNumbers native)
    {
        Heads = native.heads;
        BoneHeadLength = native.bone_head_length;
        Crown = native.crown;
        Chin = native.chin;
        ShoulderLine = native.shoulder_line;
        Crotch = native.crotch;
        Sole = native.sole;
        HeadLength = native.head_length;
        HeadHalfWidth = native.head_half_width;
        Neck = native.neck;
        Torso = native.torso;
        Arm = native.arm;
        Leg = native.leg;
        AnkleHeight = native.ankle_height;
        Hand = native.hand;
        Foot = native.foot;
        TorsoHalfWidth = native.torso_half_width;
        UpperArmRadius = native.upper_arm_radius;
        LowerArmRadius = native.lower_arm_radius;
        UpperLegRadius = native.upper_leg_radius;
        LowerLegRadius = native.lower_leg_radius;
        EyeHeight = native.eye_height;
        EyeSize = native.eye_size;
        HeadHalfDepth = native.head_half_depth;
    }

    internal unsafe SdefStyleNumbers ToNative()
    {
        var native = new SdefStyleNumbers();
        native.struct_size = (uint)sizeof(SdefStyleNumbers);
        native.heads = Heads;
        native.bone_head_length = BoneHeadLength;
        native.crown = Crown;
        native.chin = Chin;
        native.shoulder_line = ShoulderLine;
        native.crotch = Crotch;
        native.sole = Sole;
        native.head_length = HeadLength;
        native.head_half_width = HeadHalfWidth;
        native.neck = Neck;
        native.torso = Torso;
        native.arm = Arm;
        native.leg = Leg;
        native.ankle_height = AnkleHeight;
        native.hand = Hand;
        native.foot = Foot;
        native.torso_half_width = TorsoHalfWidth;
        native.upper_arm_radius = UpperArmRadius;
        native.lower_arm_radius = LowerArmRadius;
        native.upper_leg_radius = UpperLegRadius;
        native.lower_leg_radius = LowerLegRadius;
        native.eye_height = EyeHeight;
        native.eye_size = EyeSize;
        native.head_half_depth = HeadHalfDepth;
        return native;
    }
}

/// <summary>One bone of a measured body.</summary>
public struct Bone
{
    /// <summary>The role at its end, or <see cref="HumanoidRole.HeadTop"/>.</summary>
    public HumanoidRole End;

    /// <summary>0 or more.</summary>
    public double Length;

    /// <summary>Mean distance of the surface, above 0; NaN: not known.</summary>
    public double Radius;
}
}
