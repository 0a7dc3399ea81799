using System;
using UnityEngine;

namespace SuperDeform.Editor
{
    /// <summary>
    /// A point or direction in 64 bits: a change of space there and back leaves a vertex where it was.
    /// </summary>
    public struct Double3
    {
        public double X, Y, Z;

        public Double3(double x, double y, double z)
        {
            X = x;
            Y = y;
            Z = z;
        }

        public static Double3 Of(Vector3 vector) => new Double3(vector.x, vector.y, vector.z);

        public Vector3 ToVector3() => new Vector3((float)X, (float)Y, (float)Z);

        public double Length => Math.Sqrt(Dot(this));

        public double Dot(Double3 other) => X * other.X + Y * other.Y + Z * other.Z;

        public Double3 Cross(Double3 other) => new Double3(Y * other.Z - Z * other.Y, Z * other.X - X * other.Z, X * other.Y - Y * other.X);

        /// <summary>The direction alone; 0 stays 0.</summary>
        public Double3 Normalized
        {
            get
            {
                double length = Length;
                return length > 0 ? this * (1 / length) : this;
            }
        }

        public bool IsFinite => !double.IsNaN(X + Y + Z) && !double.IsInfinity(X + Y + Z);

        public static Double3 operator +(Double3 one, Double3 other)
        {
            return new Double3(one.X + other.X, one.Y + other.Y, one.Z + other.Z);
        }

        public static Double3 operator -(Double3 one, Double3 other)
        {
            return new Double3(one.X - other.X, one.Y - other.Y, one.Z - other.Z);
        }

        public static Double3 operator *(Double3 one, double factor)
        {
            return new Double3(one.X * factor, one.Y * factor, one.Z * factor);
        }
    }
}
