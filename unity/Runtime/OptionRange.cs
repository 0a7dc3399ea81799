using System;
using System.Reflection;

namespace SuperDeform
{
// The numbers are in Native.g.cs, by the names of the fields of Options and GroupSettings.
public partial struct OptionRange
{
    public readonly double Low;

    public readonly double High;

    public OptionRange(double low, double high)
    {
        Low = low;
        High = high;
    }

    /// <summary>Whether a value may be.</summary>
    public bool Contains(double value) => value >= Low && value <= High;

    /// <summary>The range of a number of <see cref="Options"/> or <see cref="GroupSettings"/>, by its name.</summary>
    /// <exception cref="ArgumentException">There is no such number.</exception>
    public static OptionRange Of(string field)
    {
        FieldInfo range = typeof(OptionRange).GetField(field, BindingFlags.Static | BindingFlags.Public);
        if (range == null) throw new ArgumentException("there is no number " + field + " among the options");
        return (OptionRange)range.GetValue(null);
    }
}
}
