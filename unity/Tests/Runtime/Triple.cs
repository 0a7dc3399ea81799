namespace SuperDeform.Tests
{
/// <summary>A vector as engines have it: three floats and nothing else.</summary>
public struct Triple
{
    public float X, Y, Z;

    public Triple(float x, float y, float z)
    {
        X = x;
        Y = y;
        Z = z;
    }
}

/// <summary>Four floats.</summary>
public struct Quadruple
{
    public float X, Y, Z, W;
}
}
