using System;
using System.Reflection;

namespace SuperDeform
{
/// <summary>The least and the greatest value of an option; an option goes by the name of its field.</summary>
public struct OptionRange
{
    public static readonly OptionRange Rays = new OptionRange(3, 4096);
    public static readonly OptionRange HeadScale = new OptionRange(0.1, 10);
    public static readonly OptionRange Amount = new OptionRange(0, 1);
    public static readonly OptionRange HairLength = new OptionRange(0, 1);
    public static readonly OptionRange FaceSquash = new OptionRange(-10, 10);
    public static readonly OptionRange ThreadCount = new OptionRange(0, 1024);
    public static readonly OptionRange LengthScale = new OptionRange(0.01, 100);
    public static readonly OptionRange ThicknessScale = new OptionRange(0.01, 100);
    public static readonly OptionRange LengthTransfer = new OptionRange(-10, 10);
    public static readonly OptionRange ThicknessTransfer = new OptionRange(-10, 10);
    public static readonly OptionRange RigVoxelResolution = new OptionRange(16, 512);
    public static readonly OptionRange RigHeat = new OptionRange(0.01, 1000);
    public static readonly OptionRange Heads = new OptionRange(1.8, 6);

    public readonly double Low;

    public readonly double High;

    public OptionRange(double low, double high)
    {
        Low = low;
        High = high;
    }

    /// <summary>Whether a value may be.</summary>
    public bool Contains(double value)
    {
        return value >= Low && value <= High;
    }

    /// <summary>The range of a number of <see cref="Options"/> or <see cref="GroupSettings"/>, by its name.</summary>
    /// <exception cref="ArgumentException">There is no such number.</exception>
    public static OptionRange Of(string field)
    {
        FieldInfo range = typeof(OptionRange).GetField(field, BindingFlags.Static | BindingFlags.Public);
        if (range == null) throw new ArgumentException("there is no number " + field + " among the options");
        return (OptionRange)range.GetValue(null);
    }
}
/// <summary>What an option is unless it is set; NaN and 0 stand for what the mode has.</summary>
public static class OptionDefaults
{
    public const uint Rays = 48;
    public const bool Limits = true;
    public const double HeadScale = 1.5;
    public const double Amount = 1;
    public const double HairLength = 1;
    public const double FaceSquash = 0.8;
    public const uint ThreadCount = 0;
    public const uint RigVoxelResolution = 128;
    public const bool RigFingers = true;
    public const double RigHeat = 1;
    public const bool RigLeftHanded = false;
}
}
