// Vectors of two, three and four floats, laid out as Unity lays them out.
using System;
using System.Globalization;
using System.Runtime.InteropServices;

namespace UnityEngine
{
    internal static class Text
    {
        public static string Of(string format, params float[] values)
        {
            string[] words = new string[values.Length];
            for (int at = 0; at < values.Length; at++)
                words[at] = values[at].ToString(string.IsNullOrEmpty(format) ? "F2" : format, CultureInfo.InvariantCulture);
            return "(" + string.Join(", ", words) + ")";
        }
    }

    [Serializable, StructLayout(LayoutKind.Sequential)]
    public struct Vector2 : IEquatable<Vector2>
    {
        public float x, y;
        public const float kEpsilon = 0.00001f;
        public Vector2(float x, float y) { this.x = x; this.y = y; }
        public static Vector2 zero { get { return new Vector2(0, 0); } }
        public static Vector2 one { get { return new Vector2(1, 1); } }
        public static Vector2 up { get { return new Vector2(0, 1); } }
        public static Vector2 down { get { return new Vector2(0, -1); } }
        public static Vector2 left { get { return new Vector2(-1, 0); } }
        public static Vector2 right { get { return new Vector2(1, 0); } }
        public float this[int index]
        {
            get { if (index == 0) return x; if (index == 1) return y; throw new IndexOutOfRangeException("Vector2 has no component " + index); }
            set { if (index == 0) x = value; else if (index == 1) y = value; else throw new IndexOutOfRangeException("Vector2 has no component " + index); }
        }
        public float magnitude { get { return Mathf.Sqrt(sqrMagnitude); } }
        public float sqrMagnitude { get { return x * x + y * y; } }
        public Vector2 normalized { get { float m = magnitude; return m > 1e-5f ? this / m : zero; } }
        public void Set(float newX, float newY) { x = newX; y = newY; }
        public void Normalize() { this = normalized; }
        public static float Dot(Vector2 a, Vector2 b) { return a.x * b.x + a.y * b.y; }
        public static float Distance(Vector2 a, Vector2 b) { return (a - b).magnitude; }
        public static float Angle(Vector2 a, Vector2 b) { return Vector3.Angle(a, b); }
        public static Vector2 Lerp(Vector2 a, Vector2 b, float t) { return a + (b - a) * Mathf.Clamp01(t); }
        public static Vector2 Min(Vector2 a, Vector2 b) { return new Vector2(Mathf.Min(a.x, b.x), Mathf.Min(a.y, b.y)); }
        public static Vector2 Max(Vector2 a, Vector2 b) { return new Vector2(Mathf.Max(a.x, b.x), Mathf.Max(a.y, b.y)); }
        public static Vector2 Scale(Vector2 a, Vector2 b) { return new Vector2(a.x * b.x, a.y * b.y); }
        public static Vector2 operator +(Vector2 a, Vector2 b) { return new Vector2(a.x + b.x, a.y + b.y); }
        public static Vector2 operator -(Vector2 a, Vector2 b) { return new Vector2(a.x - b.x, a.y - b.y); }
        public static Vector2 operator -(Vector2 a) { return new Vector2(-a.x, -a.y); }
        public static Vector2 operator *(Vector2 a, float s) { return new Vector2(a.x * s, a.y * s); }
        public static Vector2 operator *(float s, Vector2 a) { return a * s; }
        public static Vector2 operator *(Vector2 a, Vector2 b) { return Scale(a, b); }
        public static Vector2 operator /(Vector2 a, float s) { return new Vector2(a.x / s, a.y / s); }
        public static bool operator ==(Vector2 a, Vector2 b) { return (a - b).sqrMagnitude < 9.99999944E-11f; }
        public static bool operator !=(Vector2 a, Vector2 b) { return !(a == b); }
        public static implicit operator Vector2(Vector3 v) { return new Vector2(v.x, v.y); }
        public static implicit operator Vector3(Vector2 v) { return new Vector3(v.x, v.y, 0); }
        public bool Equals(Vector2 other) { return x == other.x && y == other.y; }
        public override bool Equals(object other) { return other is Vector2 && Equals((Vector2)other); }
        public override int GetHashCode() { return x.GetHashCode() ^ (y.GetHashCode() << 2); }
        public override string ToString() { return Text.Of(null, x, y); }
        public string ToString(string format) { return Text.Of(format, x, y); }
    }

    [Serializable, StructLayout(LayoutKind.Sequential)]
    public struct Vector3 : IEquatable<Vector3>
    {
        public float x, y, z;
        public const float kEpsilon = 0.00001f;
        public Vector3(float x, float y, float z) { this.x = x; this.y = y; this.z = z; }
        public Vector3(float x, float y) { this.x = x; this.y = y; z = 0; }
        public static Vector3 zero { get { return new Vector3(0, 0, 0); } }
        public static Vector3 one { get { return new Vector3(1, 1, 1); } }
        public static Vector3 up { get { return new Vector3(0, 1, 0); } }
        public static Vector3 down { get { return new Vector3(0, -1, 0); } }
        public static Vector3 left { get { return new Vector3(-1, 0, 0); } }
        public static Vector3 right { get { return new Vector3(1, 0, 0); } }
        public static Vector3 forward { get { return new Vector3(0, 0, 1); } }
        public static Vector3 back { get { return new Vector3(0, 0, -1); } }
        public static Vector3 positiveInfinity { get { return new Vector3(Mathf.Infinity, Mathf.Infinity, Mathf.Infinity); } }
        public static Vector3 negativeInfinity { get { return new Vector3(Mathf.NegativeInfinity, Mathf.NegativeInfinity, Mathf.NegativeInfinity); } }
        public float this[int index]
        {
            get { if (index == 0) return x; if (index == 1) return y; if (index == 2) return z; throw new IndexOutOfRangeException("Vector3 has no component " + index); }
            set { if (index == 0) x = value; else if (index == 1) y = value; else if (index == 2) z = value; else throw new IndexOutOfRangeException("Vector3 has no component " + index); }
        }
        public float magnitude { get { return Mathf.Sqrt(sqrMagnitude); } }
        public float sqrMagnitude { get { return x * x + y * y + z * z; } }
        public Vector3 normalized { get { return Normalize(this); } }
        public void Set(float newX, float newY, float newZ) { x = newX; y = newY; z = newZ; }
        public void Normalize() { this = Normalize(this); }
        public void Scale(Vector3 scale) { x *= scale.x; y *= scale.y; z *= scale.z; }
        // Shorter than 1e-5 counts as no direction at all.
        public static Vector3 Normalize(Vector3 v) { float m = v.magnitude; return m > 1e-5f ? v / m : zero; }
        public static float Magnitude(Vector3 v) { return v.magnitude; }
        public static float SqrMagnitude(Vector3 v) { return v.sqrMagnitude; }
        public static float Dot(Vector3 a, Vector3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
        public static Vector3 Cross(Vector3 a, Vector3 b) { return new Vector3(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x); }
        public static float Distance(Vector3 a, Vector3 b) { return (a - b).magnitude; }
        public static float Angle(Vector3 from, Vector3 to)
        {
            float product = Mathf.Sqrt(from.sqrMagnitude * to.sqrMagnitude);
            return product < 1e-15f ? 0f : Mathf.Acos(Mathf.Clamp(Dot(from, to) / product, -1f, 1f)) * Mathf.Rad2Deg;
        }
        public static float SignedAngle(Vector3 from, Vector3 to, Vector3 axis) { return Angle(from, to) * Mathf.Sign(Dot(axis, Cross(from, to))); }
        public static Vector3 Lerp(Vector3 a, Vector3 b, float t) { return a + (b - a) * Mathf.Clamp01(t); }
        public static Vector3 LerpUnclamped(Vector3 a, Vector3 b, float t) { return a + (b - a) * t; }
        public static Vector3 Scale(Vector3 a, Vector3 b) { return new Vector3(a.x * b.x, a.y * b.y, a.z * b.z); }
        public static Vector3 Min(Vector3 a, Vector3 b) { return new Vector3(Mathf.Min(a.x, b.x), Mathf.Min(a.y, b.y), Mathf.Min(a.z, b.z)); }
        public static Vector3 Max(Vector3 a, Vector3 b) { return new Vector3(Mathf.Max(a.x, b.x), Mathf.Max(a.y, b.y), Mathf.Max(a.z, b.z)); }
        public static Vector3 Project(Vector3 v, Vector3 onNormal) { float s = onNormal.sqrMagnitude; return s < 1e-15f ? zero : onNormal * (Dot(v, onNormal) / s); }
        public static Vector3 ProjectOnPlane(Vector3 v, Vector3 normal) { return v - Project(v, normal); }
        public static Vector3 Reflect(Vector3 direction, Vector3 normal) { return direction - normal * (2f * Dot(normal, direction)); }
        public static Vector3 MoveTowards(Vector3 current, Vector3 target, float step) { Vector3 to = target - current; float m = to.magnitude; return m <= step || m == 0f ? target : current + to / m * step; }
        public static Vector3 ClampMagnitude(Vector3 v, float maximum) { return v.sqrMagnitude > maximum * maximum ? v.normalized * maximum : v; }
        public static Vector3 operator +(Vector3 a, Vector3 b) { return new Vector3(a.x + b.x, a.y + b.y, a.z + b.z); }
        public static Vector3 operator -(Vector3 a, Vector3 b) { return new Vector3(a.x - b.x, a.y - b.y, a.z - b.z); }
        public static Vector3 operator -(Vector3 a) { return new Vector3(-a.x, -a.y, -a.z); }
        public static Vector3 operator *(Vector3 a, float s) { return new Vector3(a.x * s, a.y * s, a.z * s); }
        public static Vector3 operator *(float s, Vector3 a) { return a * s; }
        public static Vector3 operator /(Vector3 a, float s) { return new Vector3(a.x / s, a.y / s, a.z / s); }
        public static bool operator ==(Vector3 a, Vector3 b) { return (a - b).sqrMagnitude < 9.99999944E-11f; }
        public static bool operator !=(Vector3 a, Vector3 b) { return !(a == b); }
        public bool Equals(Vector3 other) { return x == other.x && y == other.y && z == other.z; }
        public override bool Equals(object other) { return other is Vector3 && Equals((Vector3)other); }
        public override int GetHashCode() { return x.GetHashCode() ^ (y.GetHashCode() << 2) ^ (z.GetHashCode() >> 2); }
        public override string ToString() { return Text.Of(null, x, y, z); }
        public string ToString(string format) { return Text.Of(format, x, y, z); }
    }

    [Serializable, StructLayout(LayoutKind.Sequential)]
    public struct Vector4 : IEquatable<Vector4>
    {
        public float x, y, z, w;
        public Vector4(float x, float y, float z, float w) { this.x = x; this.y = y; this.z = z; this.w = w; }
        public Vector4(float x, float y, float z) : this(x, y, z, 0) { }
        public Vector4(float x, float y) : this(x, y, 0, 0) { }
        public static Vector4 zero { get { return new Vector4(0, 0, 0, 0); } }
        public static Vector4 one { get { return new Vector4(1, 1, 1, 1); } }
        public float this[int index]
        {
            get { switch (index) { case 0: return x; case 1: return y; case 2: return z; case 3: return w; } throw new IndexOutOfRangeException("Vector4 has no component " + index); }
            set { switch (index) { case 0: x = value; break; case 1: y = value; break; case 2: z = value; break; case 3: w = value; break; default: throw new IndexOutOfRangeException("Vector4 has no component " + index); } }
        }
        public float magnitude { get { return Mathf.Sqrt(sqrMagnitude); } }
        public float sqrMagnitude { get { return Dot(this, this); } }
        public Vector4 normalized { get { float m = magnitude; return m > 1e-5f ? this / m : zero; } }
        public static float Dot(Vector4 a, Vector4 b) { return a.x * b.x + a.y * b.y + a.z * b.z + a.w * b.w; }
        public static Vector4 Lerp(Vector4 a, Vector4 b, float t) { return a + (b - a) * Mathf.Clamp01(t); }
        public static float Distance(Vector4 a, Vector4 b) { return (a - b).magnitude; }
        public static Vector4 operator +(Vector4 a, Vector4 b) { return new Vector4(a.x + b.x, a.y + b.y, a.z + b.z, a.w + b.w); }
        public static Vector4 operator -(Vector4 a, Vector4 b) { return new Vector4(a.x - b.x, a.y - b.y, a.z - b.z, a.w - b.w); }
        public static Vector4 operator -(Vector4 a) { return new Vector4(-a.x, -a.y, -a.z, -a.w); }
        public static Vector4 operator *(Vector4 a, float s) { return new Vector4(a.x * s, a.y * s, a.z * s, a.w * s); }
        public static Vector4 operator *(float s, Vector4 a) { return a * s; }
        public static Vector4 operator /(Vector4 a, float s) { return new Vector4(a.x / s, a.y / s, a.z / s, a.w / s); }
        public static bool operator ==(Vector4 a, Vector4 b) { return (a - b).sqrMagnitude < 9.99999944E-11f; }
        public static bool operator !=(Vector4 a, Vector4 b) { return !(a == b); }
        public static implicit operator Vector4(Vector3 v) { return new Vector4(v.x, v.y, v.z, 0); }
        public static implicit operator Vector3(Vector4 v) { return new Vector3(v.x, v.y, v.z); }
        public static implicit operator Vector4(Vector2 v) { return new Vector4(v.x, v.y, 0, 0); }
        public static implicit operator Vector2(Vector4 v) { return new Vector2(v.x, v.y); }
        public bool Equals(Vector4 other) { return x == other.x && y == other.y && z == other.z && w == other.w; }
        public override bool Equals(object other) { return other is Vector4 && Equals((Vector4)other); }
        public override int GetHashCode() { return x.GetHashCode() ^ (y.GetHashCode() << 2) ^ (z.GetHashCode() >> 2) ^ (w.GetHashCode() >> 1); }
        public override string ToString() { return Text.Of(null, x, y, z, w); }
        public string ToString(string format) { return Text.Of(format, x, y, z, w); }
    }

    [Serializable, StructLayout(LayoutKind.Sequential)]
    public struct Vector2Int
    {
        public int x, y;
        public Vector2Int(int x, int y) { this.x = x; this.y = y; }
    }

    [Serializable, StructLayout(LayoutKind.Sequential)]
    public struct Vector3Int
    {
        public int x, y, z;
        public Vector3Int(int x, int y, int z) { this.x = x; this.y = y; this.z = z; }
    }
}
