namespace SuperDeform
{
/// <summary>What a character holds.</summary>
public sealed class CharacterInfo
{
    internal CharacterInfo(SdefCharacterInfo native)
    {
        MeshCount = (int)native.mesh_count;
        JointCount = (int)native.joint_count;
        OwnJointCount = (int)native.own_joint_count;
        MorphTargetCount = (int)native.morph_target_count;
        RigMade = native.rig_made != 0;
        VertexCount = (long)native.vertex_count;
        TriangleCount = (long)native.triangle_count;
    }

    public int MeshCount { get; private set; }

    /// <summary>Joints, those of a made rig among them.</summary>
    public int JointCount { get; private set; }

    /// <summary>Joints that came with the character: the first ones.</summary>
    public int OwnJointCount { get; private set; }

    /// <summary>Of all meshes.</summary>
    public int MorphTargetCount { get; private set; }

    /// <summary>Whether <see cref="Character.Rig"/> has made a rig.</summary>
    public bool RigMade { get; private set; }

    /// <summary>Of all meshes.</summary>
    public long VertexCount { get; private set; }

    /// <summary>Of all meshes.</summary>
    public long TriangleCount { get; private set; }
}
}
