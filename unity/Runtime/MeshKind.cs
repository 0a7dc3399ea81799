namespace SuperDeform
{
/// <summary>What a mesh is of a character: the numbers of SDEF_MESH_*.</summary>
public enum MeshKind : uint
{
    /// <summary>Guessed from the name; else body, or what making a rig sees in it.</summary>
    Unknown = 0,
    /// <summary>Skin, or skin fused with clothes.</summary>
    Body = 1,
    /// <summary>Clothes.</summary>
    Garment = 2,
    /// <summary>Hair of the head.</summary>
    Hair = 3,
    /// <summary>Brows, lashes, teeth, tongue: what follows the face.</summary>
    FacePart = 4,
    /// <summary>Hats, glasses, bags, weapons: what keeps its shape.</summary>
    Accessory = 5,
    /// <summary>Eyeballs, irises, pupils: face parts that keep their shape.</summary>
    Eye = 6,
}
}
