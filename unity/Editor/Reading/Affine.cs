using System;
using UnityEngine;

namespace SuperDeform.Editor
{
    /// <summary>
    /// An affine map in 64 bits: three rows of a 4 by 4 matrix whose last row is 0 0 0 1.
    ///
    /// Unity's own matrices have 32 bits, too few for the chain of a deep hierarchy and its inverse.
    /// </summary>
    public struct Affine : IEquatable<Affine>
    {
        public double M00, M01, M02, M03;
        public double M10, M11, M12, M13;
        public double M20, M21, M22, M23;

        public static readonly Affine Identity = new Affine { M00 = 1, M11 = 1, M22 = 1 };

        public static Affine Of(Matrix4x4 m)
        {
            return new Affine
            {
                M00 = m.m00, M01 = m.m01, M02 = m.m02, M03 = m.m03,
                M10 = m.m10, M11 = m.m11, M12 = m.m12, M13 = m.m13,
                M20 = m.m20, M21 = m.m21, M22 = m.m22, M23 = m.m23
            };
        }

        /// <summary>The map of a transform to its parent's space.</summary>
        public static Affine Local(Transform transform) => Of(transform.localPosition, transform.localRotation, transform.localScale);

        /// <summary>Scale, then rotation, then translation. A rotation of length 0 turns nothing.</summary>
        public static Affine Of(Vector3 position, Quaternion rotation, Vector3 scale)
        {
            double x = rotation.x, y = rotation.y, z = rotation.z, w = rotation.w;
            double square = x * x + y * y + z * z + w * w;
            double s = square > 0 ? 2 / square : 0;
            return new Affine
            {
                M00 = (1 - s * (y * y + z * z)) * scale.x,
                M01 = s * (x * y - w * z) * scale.y,
                M02 = s * (x * z + w * y) * scale.z,
                M03 = position.x,
                M10 = s * (x * y + w * z) * scale.x,
                M11 = (1 - s * (x * x + z * z)) * scale.y,
                M12 = s * (y * z - w * x) * scale.z,
                M13 = position.y,
                M20 = s * (x * z - w * y) * scale.x,
                M21 = s * (y * z + w * x) * scale.y,
                M22 = (1 - s * (x * x + y * y)) * scale.z,
                M23 = position.z
            };
        }

        public static Affine Translation(Double3 by) => Identity.At(by);

        /// <summary>Writes 16 numbers, column by column, as the library has them.</summary>
        public void ToColumns(double[] numbers, int start)
        {
            numbers[start] = M00;
            numbers[start + 1] = M10;
            numbers[start + 2] = M20;
            numbers[start + 3] = 0;
            numbers[start + 4] = M01;
            numbers[start + 5] = M11;
            numbers[start + 6] = M21;
            numbers[start + 7] = 0;
            numbers[start + 8] = M02;
            numbers[start + 9] = M12;
            numbers[start + 10] = M22;
            numbers[start + 11] = 0;
            numbers[start + 12] = M03;
            numbers[start + 13] = M13;
            numbers[start + 14] = M23;
            numbers[start + 15] = 1;
        }

        public Matrix4x4 ToMatrix4x4()
        {
            Matrix4x4 m = Matrix4x4.identity;
            m.m00 = (float)M00;
            m.m01 = (float)M01;
            m.m02 = (float)M02;
            m.m03 = (float)M03;
            m.m10 = (float)M10;
            m.m11 = (float)M11;
            m.m12 = (float)M12;
            m.m13 = (float)M13;
            m.m20 = (float)M20;
            m.m21 = (float)M21;
            m.m22 = (float)M22;
            m.m23 = (float)M23;
            return m;
        }

        /// <summary>Where the origin goes.</summary>
        public Double3 Position => new Double3(M03, M13, M23);

        /// <summary>The same map, but for where the origin goes.</summary>
        public Affine At(Double3 position)
        {
            Affine moved = this;
            moved.M03 = position.X;
            moved.M13 = position.Y;
            moved.M23 = position.Z;
            return moved;
        }

        public Double3 Point(Double3 p)
        {
            return new Double3(
                M00 * p.X + M01 * p.Y + M02 * p.Z + M03,
                M10 * p.X + M11 * p.Y + M12 * p.Z + M13,
                M20 * p.X + M21 * p.Y + M22 * p.Z + M23);
        }

        public Double3 Direction(Double3 d)
        {
            return new Double3(
                M00 * d.X + M01 * d.Y + M02 * d.Z,
                M10 * d.X + M11 * d.Y + M12 * d.Z,
                M20 * d.X + M21 * d.Y + M22 * d.Z);
        }

        public double Determinant
        {
            get
            {
                return M00 * (M11 * M22 - M12 * M21) - M01 * (M10 * M22 - M12 * M20) + M02 * (M10 * M21 - M11 * M20);
            }
        }

        /// <summary>The map back; what comes of one without is not finite.</summary>
        public Affine Inverse
        {
            get
            {
                double d = 1 / Determinant;
                var inverse = new Affine
                {
                    M00 = (M11 * M22 - M12 * M21) * d, M01 = (M02 * M21 - M01 * M22) * d, M02 = (M01 * M12 - M02 * M11) * d,
                    M10 = (M12 * M20 - M10 * M22) * d, M11 = (M00 * M22 - M02 * M20) * d, M12 = (M02 * M10 - M00 * M12) * d,
                    M20 = (M10 * M21 - M11 * M20) * d, M21 = (M01 * M20 - M00 * M21) * d, M22 = (M00 * M11 - M01 * M10) * d
                };
                Double3 origin = inverse.Direction(Position);
                return inverse.At(origin * -1);
            }
        }

        /// <summary>The linear part, transposed; for normals, of an inverse.</summary>
        public Affine LinearTransposed
        {
            get
            {
                return new Affine
                {
                    M00 = M00, M01 = M10, M02 = M20,
                    M10 = M01, M11 = M11, M12 = M21,
                    M20 = M02, M21 = M12, M22 = M22
                };
            }
        }

        public bool IsFinite
        {
            get
            {
                double sum = M00 + M01 + M02 + M03 + M10 + M11 + M12 + M13 + M20 + M21 + M22 + M23;
                return !double.IsNaN(sum) && !double.IsInfinity(sum);
            }
        }

        /// <summary>True where there is a way back in numbers.</summary>
        public bool IsInvertible => IsFinite && Math.Abs(Determinant) > 1e-30 && Inverse.IsFinite;

        /// <summary>First b, then a.</summary>
        public static Affine operator *(Affine a, Affine b)
        {
            return new Affine
            {
                M00 = a.M00 * b.M00 + a.M01 * b.M10 + a.M02 * b.M20,
                M01 = a.M00 * b.M01 + a.M01 * b.M11 + a.M02 * b.M21,
                M02 = a.M00 * b.M02 + a.M01 * b.M12 + a.M02 * b.M22,
                M03 = a.M00 * b.M03 + a.M01 * b.M13 + a.M02 * b.M23 + a.M03,
                M10 = a.M10 * b.M00 + a.M11 * b.M10 + a.M12 * b.M20,
                M11 = a.M10 * b.M01 + a.M11 * b.M11 + a.M12 * b.M21,
                M12 = a.M10 * b.M02 + a.M11 * b.M12 + a.M12 * b.M22,
                M13 = a.M10 * b.M03 + a.M11 * b.M13 + a.M12 * b.M23 + a.M13,
                M20 = a.M20 * b.M00 + a.M21 * b.M10 + a.M22 * b.M20,
                M21 = a.M20 * b.M01 + a.M21 * b.M11 + a.M22 * b.M21,
                M22 = a.M20 * b.M02 + a.M21 * b.M12 + a.M22 * b.M22,
                M23 = a.M20 * b.M03 + a.M21 * b.M13 + a.M22 * b.M23 + a.M23
            };
        }

        /// <summary>Adds another map times a weight, number by number: what skinning blends.</summary>
        public void Add(ref Affine other, double weight)
        {
            M00 += other.M00 * weight;
            M01 += other.M01 * weight;
            M02 += other.M02 * weight;
            M03 += other.M03 * weight;
            M10 += other.M10 * weight;
            M11 += other.M11 * weight;
            M12 += other.M12 * weight;
            M13 += other.M13 * weight;
            M20 += other.M20 * weight;
            M21 += other.M21 * weight;
            M22 += other.M22 * weight;
            M23 += other.M23 * weight;
        }

        /// <summary>The numbers row by row.</summary>
        public double this[int index]
        {
            get
            {
                switch (index)
                {
                    case 0: return M00;
                    case 1: return M01;
                    case 2: return M02;
                    case 3: return M03;
                    case 4: return M10;
                    case 5: return M11;
                    case 6: return M12;
                    case 7: return M13;
                    case 8: return M20;
                    case 9: return M21;
                    case 10: return M22;
                    default: return M23;
                }
            }
            set
            {
                switch (index)
                {
                    case 0: M00 = value; break;
                    case 1: M01 = value; break;
                    case 2: M02 = value; break;
                    case 3: M03 = value; break;
                    case 4: M10 = value; break;
                    case 5: M11 = value; break;
                    case 6: M12 = value; break;
                    case 7: M13 = value; break;
                    case 8: M20 = value; break;
                    case 9: M21 = value; break;
                    case 10: M22 = value; break;
                    default: M23 = value; break;
                }
            }
        }

        public bool Equals(Affine other)
        {
            return M00 == other.M00 && M01 == other.M01 && M02 == other.M02 && M03 == other.M03
                && M10 == other.M10 && M11 == other.M11 && M12 == other.M12 && M13 == other.M13
                && M20 == other.M20 && M21 == other.M21 && M22 == other.M22 && M23 == other.M23;
        }

        public override bool Equals(object other) => other is Affine && Equals((Affine)other);

        public override int GetHashCode() => M03.GetHashCode() ^ M13.GetHashCode() ^ M23.GetHashCode() ^ M00.GetHashCode();
    }
}
