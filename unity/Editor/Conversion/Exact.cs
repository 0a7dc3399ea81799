namespace SuperDeform.Editor
{
    /// <summary>Numbers of 32 bits, as sliders and assets have them, for the library's of 64.</summary>
    internal static class Exact
    {
        /// <summary>
        /// The number that a value is written as: 1.8, not 1.7999999523, which is below the least that the library takes.
        /// </summary>
        internal static double Of(float value) => float.IsNaN(value) || float.IsInfinity(value) ? value : (double)(decimal)value;
    }
}
