using System;
using UnityEngine;

namespace SuperDeform.Editor
{
    /// <summary>
    /// An affine map with what it does to directions and normals.
    ///
    /// A normal goes by the inverse transposed and gets length 1 again; the change of a normal goes the same way, with the
    /// same factor.
    /// </summary>
    public struct Frame
    {
        readonly Affine matrix;
        readonly Affine normals;

        /// <summary>True where nothing changes, bit for bit.</summary>
        public readonly bool IsIdentity;

        public Frame(Affine matrix)
        {
            this.matrix = matrix;
            normals = matrix.Inverse.LinearTransposed;
            IsIdentity = matrix.Equals(Affine.Identity);
        }

        public Vector3 Point(Vector3 point) => matrix.Point(Double3.Of(point)).ToVector3();

        /// <summary>Maps a displacement, times scale; one of 0 stays exactly 0.</summary>
        public Vector3 Delta(Vector3 delta, double scale) => Scaled(matrix, delta, scale);

        /// <summary>Maps the change of a normal whose length was multiplied by scale.</summary>
        public Vector3 NormalDelta(Vector3 delta, double scale) => Scaled(normals, delta, scale);

        Vector3 Scaled(Affine linear, Vector3 delta, double scale)
        {
            if (IsIdentity && scale == 1 || delta.x == 0 && delta.y == 0 && delta.z == 0) return delta;
            return (linear.Direction(Double3.Of(delta)) * scale).ToVector3();
        }

        /// <summary>Maps a unit normal; scale: what its length was multiplied by to be 1 again.</summary>
        public Vector3 Normal(Vector3 normal, out double scale) => Unit(normals, normal, out scale);

        /// <summary>
        /// Maps a unit tangent, the handedness kept; scale: what its length was multiplied by to be 1 again.
        /// </summary>
        public Vector4 Tangent(Vector4 tangent, out double scale)
        {
            Vector3 unit = Unit(matrix, new Vector3(tangent.x, tangent.y, tangent.z), out scale);
            return new Vector4(unit.x, unit.y, unit.z, tangent.w);
        }

        Vector3 Unit(Affine linear, Vector3 direction, out double scale)
        {
            scale = 1;
            Double3 wide = Double3.Of(direction);
            // Unit but for rounding: left as it is, bit for bit.
            if (IsIdentity && Math.Abs(wide.Dot(wide) - 1) < 1e-4) return direction;
            Double3 mapped = linear.Direction(wide);
            double length = mapped.Length;
            if (!(length > 0) || double.IsInfinity(length)) return direction;
            scale = 1 / length;
            return (mapped * scale).ToVector3();
        }
    }
}
