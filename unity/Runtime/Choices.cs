namespace SuperDeform
{
/// <summary>How a body is taken apart: SDEF_MODE_*.</summary>
public enum Mode : uint
{
    /// <summary>15 parts that meet at landmarks of the body: what most want.</summary>
    Product = 0,
    /// <summary>The chain of bones of the paper (Wang et al., Body-shape Transfer), literally.</summary>
    Paper = 1,
}

/// <summary>The stage after which a deformation stops: SDEF_STAGE_*.</summary>
public enum Stage : uint
{
    /// <summary>Lengths only.</summary>
    Length = 0,
    /// <summary>Lengths and thickness.</summary>
    Thickness = 1,
    /// <summary>Everything.</summary>
    Face = 2,
}

/// <summary>How a face is squashed: SDEF_FACE_CURVE_*.</summary>
public enum FaceCurve : uint
{
    /// <summary>The paper's choice (Eq. 13).</summary>
    F4 = 0,
    /// <summary>Eq. 12.</summary>
    F2 = 1,
    /// <summary>The sphere approximation of Shen et al.</summary>
    Sphere = 2,
}

/// <summary>Clothes that were outside of the body and would end inside: SDEF_REPAIR_*.</summary>
public enum Repair : uint
{
    /// <summary>They may end inside.</summary>
    Off = 0,
    /// <summary>They are pushed out.</summary>
    On = 1,
    /// <summary>As they were pushed last, or as On where nothing was pushed yet: for while a slider moves.</summary>
    Kept = 2,
}

/// <summary>How the weights of a body are made where it has no rig: SDEF_WEIGHTS_*.</summary>
public enum BodyWeights : uint
{
    /// <summary>Heat where the body allows it, else the volume.</summary>
    Auto = 0,
    /// <summary>Heat equilibrium on the surface (Baran and Popovic); for closed bodies.</summary>
    Heat = 1,
    /// <summary>Distances through voxels (Dionne and de Lasa); for open and patched bodies.</summary>
    Volume = 2,
}

/// <summary>How the weights of clothes are made where they have none: SDEF_GARMENTS_*.</summary>
public enum GarmentWeights : uint
{
    /// <summary>Close points of the body with like normals, the rest filled in smoothly.</summary>
    Robust = 0,
    /// <summary>The closest point of the body, whatever it is.</summary>
    Nearest = 1,
    /// <summary>Heat on the clothes themselves.</summary>
    Heat = 2,
}
}
