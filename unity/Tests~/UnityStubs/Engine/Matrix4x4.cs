// 4 by 4 matrices, stored column by column: m10 is row 1, column 0, and lies second.
using System;
using System.Runtime.InteropServices;

namespace UnityEngine
{
    [Serializable, StructLayout(LayoutKind.Sequential)]
    public struct Matrix4x4 : IEquatable<Matrix4x4>
    {
        public float m00, m10, m20, m30, m01, m11, m21, m31, m02, m12, m22, m32, m03, m13, m23, m33;

        public Matrix4x4(Vector4 column0, Vector4 column1, Vector4 column2, Vector4 column3)
        {
            m00 = column0.x; m10 = column0.y; m20 = column0.z; m30 = column0.w;
            m01 = column1.x; m11 = column1.y; m21 = column1.z; m31 = column1.w;
            m02 = column2.x; m12 = column2.y; m22 = column2.z; m32 = column2.w;
            m03 = column3.x; m13 = column3.y; m23 = column3.z; m33 = column3.w;
        }
        public static Matrix4x4 zero { get { return new Matrix4x4(); } }
        public static Matrix4x4 identity { get { return Scale(Vector3.one); } }
        public bool isIdentity { get { return Equals(identity); } }

        public float this[int row, int column] { get { return this[row + column * 4]; } set { this[row + column * 4] = value; } }
        public float this[int index]
        {
            get
            {
                switch (index)
                {
                    case 0: return m00; case 1: return m10; case 2: return m20; case 3: return m30;
                    case 4: return m01; case 5: return m11; case 6: return m21; case 7: return m31;
                    case 8: return m02; case 9: return m12; case 10: return m22; case 11: return m32;
                    case 12: return m03; case 13: return m13; case 14: return m23; case 15: return m33;
                }
                throw new IndexOutOfRangeException("Matrix4x4 has no element " + index);
            }
            set
            {
                switch (index)
                {
                    case 0: m00 = value; break; case 1: m10 = value; break; case 2: m20 = value; break; case 3: m30 = value; break;
                    case 4: m01 = value; break; case 5: m11 = value; break; case 6: m21 = value; break; case 7: m31 = value; break;
                    case 8: m02 = value; break; case 9: m12 = value; break; case 10: m22 = value; break; case 11: m32 = value; break;
                    case 12: m03 = value; break; case 13: m13 = value; break; case 14: m23 = value; break; case 15: m33 = value; break;
                    default: throw new IndexOutOfRangeException("Matrix4x4 has no element " + index);
                }
            }
        }
        public Vector4 GetColumn(int column) { return new Vector4(this[0, column], this[1, column], this[2, column], this[3, column]); }
        public Vector4 GetRow(int row) { return new Vector4(this[row, 0], this[row, 1], this[row, 2], this[row, 3]); }
        public Vector3 GetPosition() { return new Vector3(m03, m13, m23); }
        public void SetColumn(int column, Vector4 value) { for (int row = 0; row < 4; row++) this[row, column] = value[row]; }
        public void SetRow(int row, Vector4 value) { for (int column = 0; column < 4; column++) this[row, column] = value[column]; }
        public void SetTRS(Vector3 position, Quaternion rotation, Vector3 scale) { this = TRS(position, rotation, scale); }

        public static Matrix4x4 Translate(Vector3 v) { Matrix4x4 m = identity; m.m03 = v.x; m.m13 = v.y; m.m23 = v.z; return m; }
        public static Matrix4x4 Scale(Vector3 v) { Matrix4x4 m = new Matrix4x4(); m.m00 = v.x; m.m11 = v.y; m.m22 = v.z; m.m33 = 1f; return m; }
        public static Matrix4x4 Rotate(Quaternion q)
        {
            float x = q.x * 2f, y = q.y * 2f, z = q.z * 2f;
            Matrix4x4 m = identity;
            m.m00 = 1f - (q.y * y + q.z * z); m.m10 = q.x * y + q.w * z; m.m20 = q.x * z - q.w * y;
            m.m01 = q.x * y - q.w * z; m.m11 = 1f - (q.x * x + q.z * z); m.m21 = q.y * z + q.w * x;
            m.m02 = q.x * z + q.w * y; m.m12 = q.y * z - q.w * x; m.m22 = 1f - (q.x * x + q.y * y);
            return m;
        }
        public static Matrix4x4 TRS(Vector3 position, Quaternion rotation, Vector3 scale)
        {
            Matrix4x4 m = Rotate(rotation);
            m.m00 *= scale.x; m.m10 *= scale.x; m.m20 *= scale.x;
            m.m01 *= scale.y; m.m11 *= scale.y; m.m21 *= scale.y;
            m.m02 *= scale.z; m.m12 *= scale.z; m.m22 *= scale.z;
            m.m03 = position.x; m.m13 = position.y; m.m23 = position.z;
            return m;
        }
        public Matrix4x4 transpose { get { Matrix4x4 t = new Matrix4x4(); for (int row = 0; row < 4; row++) for (int column = 0; column < 4; column++) t[column, row] = this[row, column]; return t; } }
        public static Matrix4x4 Transpose(Matrix4x4 m) { return m.transpose; }

        public float determinant { get { double d; Invert(out d); return (float)d; } }
        public static float Determinant(Matrix4x4 m) { return m.determinant; }
        // A matrix that cannot be inverted gives zeros.
        public Matrix4x4 inverse { get { double d; return Invert(out d); } }
        public static Matrix4x4 Inverse(Matrix4x4 m) { return m.inverse; }

        // Cofactors of 2 by 2 blocks, in double precision.
        Matrix4x4 Invert(out double determinant)
        {
            double a = m00, b = m01, c = m02, d = m03, e = m10, f = m11, g = m12, h = m13, i = m20, j = m21, k = m22, l = m23, m = m30, n = m31, o = m32, p = m33;
            double s0 = a * f - e * b, s1 = a * g - e * c, s2 = a * h - e * d, s3 = b * g - f * c, s4 = b * h - f * d, s5 = c * h - g * d;
            double c5 = k * p - o * l, c4 = j * p - n * l, c3 = j * o - n * k, c2 = i * p - m * l, c1 = i * o - m * k, c0 = i * n - m * j;
            determinant = s0 * c5 - s1 * c4 + s2 * c3 + s3 * c2 - s4 * c1 + s5 * c0;
            Matrix4x4 r = new Matrix4x4();
            if (determinant == 0.0) return r;
            double t = 1.0 / determinant;
            r.m00 = (float)((f * c5 - g * c4 + h * c3) * t); r.m01 = (float)((-b * c5 + c * c4 - d * c3) * t);
            r.m02 = (float)((n * s5 - o * s4 + p * s3) * t); r.m03 = (float)((-j * s5 + k * s4 - l * s3) * t);
            r.m10 = (float)((-e * c5 + g * c2 - h * c1) * t); r.m11 = (float)((a * c5 - c * c2 + d * c1) * t);
            r.m12 = (float)((-m * s5 + o * s2 - p * s1) * t); r.m13 = (float)((i * s5 - k * s2 + l * s1) * t);
            r.m20 = (float)((e * c4 - f * c2 + h * c0) * t); r.m21 = (float)((-a * c4 + b * c2 - d * c0) * t);
            r.m22 = (float)((m * s4 - n * s2 + p * s0) * t); r.m23 = (float)((-i * s4 + j * s2 - l * s0) * t);
            r.m30 = (float)((-e * c3 + f * c1 - g * c0) * t); r.m31 = (float)((a * c3 - b * c1 + c * c0) * t);
            r.m32 = (float)((-m * s3 + n * s1 - o * s0) * t); r.m33 = (float)((i * s3 - j * s1 + k * s0) * t);
            return r;
        }
        public Vector3 MultiplyPoint(Vector3 v)
        {
            float w = m30 * v.x + m31 * v.y + m32 * v.z + m33;
            return MultiplyPoint3x4(v) * (1f / w);
        }
        public Vector3 MultiplyPoint3x4(Vector3 v) { return new Vector3(m00 * v.x + m01 * v.y + m02 * v.z + m03, m10 * v.x + m11 * v.y + m12 * v.z + m13, m20 * v.x + m21 * v.y + m22 * v.z + m23); }
        public Vector3 MultiplyVector(Vector3 v) { return new Vector3(m00 * v.x + m01 * v.y + m02 * v.z, m10 * v.x + m11 * v.y + m12 * v.z, m20 * v.x + m21 * v.y + m22 * v.z); }
        // Columns' lengths; a mirrored matrix has its first scale negative.
        public Vector3 lossyScale
        {
            get
            {
                Vector3 a = GetColumn(0), b = GetColumn(1), c = GetColumn(2);
                float sign = Vector3.Dot(Vector3.Cross(a, b), c) < 0f ? -1f : 1f;
                return new Vector3(a.magnitude * sign, b.magnitude, c.magnitude);
            }
        }
        public Quaternion rotation
        {
            get
            {
                Vector3 s = lossyScale;
                if (s.x == 0f || s.y == 0f || s.z == 0f) return Quaternion.identity;
                return Quaternion.FromAxes((Vector3)GetColumn(0) / s.x, (Vector3)GetColumn(1) / s.y, (Vector3)GetColumn(2) / s.z);
            }
        }
        public bool ValidTRS()
        {
            Vector3 a = GetColumn(0), b = GetColumn(1), c = GetColumn(2);
            return m30 == 0f && m31 == 0f && m32 == 0f && m33 == 1f && Mathf.Abs(Vector3.Dot(a.normalized, b.normalized)) < 1e-3f
                && Mathf.Abs(Vector3.Dot(b.normalized, c.normalized)) < 1e-3f && Mathf.Abs(Vector3.Dot(c.normalized, a.normalized)) < 1e-3f;
        }
        public static Matrix4x4 operator *(Matrix4x4 a, Matrix4x4 b)
        {
            return new Matrix4x4(a * b.GetColumn(0), a * b.GetColumn(1), a * b.GetColumn(2), a * b.GetColumn(3));
        }
        public static Vector4 operator *(Matrix4x4 a, Vector4 v)
        {
            return new Vector4(a.m00 * v.x + a.m01 * v.y + a.m02 * v.z + a.m03 * v.w, a.m10 * v.x + a.m11 * v.y + a.m12 * v.z + a.m13 * v.w,
                a.m20 * v.x + a.m21 * v.y + a.m22 * v.z + a.m23 * v.w, a.m30 * v.x + a.m31 * v.y + a.m32 * v.z + a.m33 * v.w);
        }
        public static bool operator ==(Matrix4x4 a, Matrix4x4 b) { for (int column = 0; column < 4; column++) if (a.GetColumn(column) != b.GetColumn(column)) return false; return true; }
        public static bool operator !=(Matrix4x4 a, Matrix4x4 b) { return !(a == b); }
        public bool Equals(Matrix4x4 other) { for (int at = 0; at < 16; at++) if (this[at] != other[at]) return false; return true; }
        public override bool Equals(object other) { return other is Matrix4x4 && Equals((Matrix4x4)other); }
        public override int GetHashCode() { int hash = 17; for (int at = 0; at < 16; at++) hash = hash * 31 + this[at].GetHashCode(); return hash; }
        public override string ToString() { return Text.Of("F5", m00, m01, m02, m03) + Text.Of("F5", m10, m11, m12, m13) + Text.Of("F5", m20, m21, m22, m23) + Text.Of("F5", m30, m31, m32, m33); }
    }
}
