namespace SuperDeform
{
/// <summary>The joints of a character: own ones first, then those of a made rig, parents in any order.</summary>
public sealed class Joints
{
    internal Joints(int count)
    {
        Parents = new int[count];
        Roles = new HumanoidRole[count];
        RestMatrices = new double[16 * count];
        Confidence = new double[count];
    }

    public int Count => Parents.Length;

    /// <summary>By joint: its parent, or -1.</summary>
    public int[] Parents { get; private set; }

    /// <summary>By joint: as given, guessed or made, or None.</summary>
    public HumanoidRole[] Roles { get; private set; }

    /// <summary>16 a joint, column by column: joint space to model space, at rest.</summary>
    public double[] RestMatrices { get; private set; }

    /// <summary>
    /// By joint, 0 to 1; below 0.5 a made joint was placed by ratio or is doubtful; 1 for given and own joints.
    /// </summary>
    public double[] Confidence { get; private set; }
}
}
