namespace SuperDeform
{
/// <summary>All joints of a character, those without a humanoid role too.</summary>
public sealed class SkeletonArrays
{
    /// <summary>By joint, for messages and for guessing roles. May be null, and so may each.</summary>
    public string[] Names;

    /// <summary>By joint: its parent, or -1; in any order.</summary>
    public int[] Parents;

    /// <summary>16 a joint, column by column: joint space to model space, at rest.</summary>
    public double[] RestMatrices;

    /// <summary>
    /// By <see cref="HumanoidRole"/>: the joint that plays it, or -1. Up to 55; roles that are left out are guessed
    /// where required ones are missing. May be null.
    /// </summary>
    public int[] RoleJoints;
}
}
