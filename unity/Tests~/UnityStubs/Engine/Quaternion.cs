// Rotations. Euler angles are applied about z, then x, then y, as Unity documents.
using System;
using System.Runtime.InteropServices;

namespace UnityEngine
{
    [Serializable, StructLayout(LayoutKind.Sequential)]
    public struct Quaternion : IEquatable<Quaternion>
    {
        public float x, y, z, w;
        public const float kEpsilon = 0.000001f;
        public Quaternion(float x, float y, float z, float w) { this.x = x; this.y = y; this.z = z; this.w = w; }
        public static Quaternion identity { get { return new Quaternion(0, 0, 0, 1); } }
        public float this[int index]
        {
            get { switch (index) { case 0: return x; case 1: return y; case 2: return z; case 3: return w; } throw new IndexOutOfRangeException("Quaternion has no component " + index); }
            set { switch (index) { case 0: x = value; break; case 1: y = value; break; case 2: z = value; break; case 3: w = value; break; default: throw new IndexOutOfRangeException("Quaternion has no component " + index); } }
        }
        public Quaternion normalized { get { return Normalize(this); } }
        public void Normalize() { this = Normalize(this); }
        public void Set(float newX, float newY, float newZ, float newW) { x = newX; y = newY; z = newZ; w = newW; }
        public static Quaternion Normalize(Quaternion q)
        {
            double length = Math.Sqrt((double)q.x * q.x + (double)q.y * q.y + (double)q.z * q.z + (double)q.w * q.w);
            return length < 1e-12 ? identity : new Quaternion((float)(q.x / length), (float)(q.y / length), (float)(q.z / length), (float)(q.w / length));
        }
        public static float Dot(Quaternion a, Quaternion b) { return a.x * b.x + a.y * b.y + a.z * b.z + a.w * b.w; }
        public static Quaternion Inverse(Quaternion q) { return new Quaternion(-q.x, -q.y, -q.z, q.w); }
        public static float Angle(Quaternion a, Quaternion b) { float dot = Mathf.Min(Mathf.Abs(Dot(a, b)), 1f); return dot > 1f - kEpsilon ? 0f : Mathf.Acos(dot) * 2f * Mathf.Rad2Deg; }
        public static Quaternion AngleAxis(float degrees, Vector3 axis)
        {
            if (axis.sqrMagnitude == 0f) return identity;
            axis = axis / axis.magnitude;
            float half = degrees * Mathf.Deg2Rad * 0.5f, sine = Mathf.Sin(half);
            return new Quaternion(axis.x * sine, axis.y * sine, axis.z * sine, Mathf.Cos(half));
        }
        public void ToAngleAxis(out float degrees, out Vector3 axis)
        {
            Quaternion q = Normalize(this);
            degrees = 2f * Mathf.Acos(Mathf.Clamp(q.w, -1f, 1f)) * Mathf.Rad2Deg;
            float sine = Mathf.Sqrt(Mathf.Max(0f, 1f - q.w * q.w));
            axis = sine < 1e-6f ? Vector3.right : new Vector3(q.x, q.y, q.z) / sine;
        }
        public static Quaternion Euler(float x, float y, float z) { return AngleAxis(y, Vector3.up) * AngleAxis(x, Vector3.right) * AngleAxis(z, Vector3.forward); }
        public static Quaternion Euler(Vector3 degrees) { return Euler(degrees.x, degrees.y, degrees.z); }
        public Vector3 eulerAngles
        {
            get
            {
                Quaternion q = Normalize(this);
                float sine = Mathf.Clamp(2f * (q.w * q.x - q.y * q.z), -1f, 1f);
                Vector3 degrees;
                if (Mathf.Abs(sine) > 0.999999f) // Looking straight up or down: the roll is put into y.
                    degrees = new Vector3(Mathf.Asin(sine), 2f * Mathf.Atan2(q.y, q.w), 0f);
                else
                    degrees = new Vector3(Mathf.Asin(sine), Mathf.Atan2(2f * (q.w * q.y + q.x * q.z), 1f - 2f * (q.x * q.x + q.y * q.y)), Mathf.Atan2(2f * (q.w * q.z + q.x * q.y), 1f - 2f * (q.x * q.x + q.z * q.z)));
                degrees *= Mathf.Rad2Deg;
                return new Vector3(Mathf.Repeat(degrees.x, 360f), Mathf.Repeat(degrees.y, 360f), Mathf.Repeat(degrees.z, 360f));
            }
            set { this = Euler(value); }
        }
        public static Quaternion FromToRotation(Vector3 from, Vector3 to)
        {
            from = from.normalized; to = to.normalized;
            float dot = Vector3.Dot(from, to);
            if (dot < -0.999999f)
            {
                Vector3 axis = Vector3.Cross(Vector3.right, from);
                return AngleAxis(180f, axis.sqrMagnitude < 1e-6f ? Vector3.Cross(Vector3.up, from) : axis);
            }
            Vector3 cross = Vector3.Cross(from, to);
            return Normalize(new Quaternion(cross.x, cross.y, cross.z, 1f + dot));
        }
        public static Quaternion LookRotation(Vector3 forward) { return LookRotation(forward, Vector3.up); }
        public static Quaternion LookRotation(Vector3 forward, Vector3 upwards)
        {
            Vector3 z = forward.normalized;
            if (z == Vector3.zero) return identity;
            Vector3 x = Vector3.Cross(upwards, z).normalized;
            if (x == Vector3.zero) return FromToRotation(Vector3.forward, z);
            return FromAxes(x, Vector3.Cross(z, x), z);
        }
        internal static Quaternion FromAxes(Vector3 a, Vector3 b, Vector3 c)
        {
            float trace = a.x + b.y + c.z;
            if (trace > 0f) { float s = Mathf.Sqrt(trace + 1f) * 2f; return Normalize(new Quaternion((b.z - c.y) / s, (c.x - a.z) / s, (a.y - b.x) / s, s / 4f)); }
            if (a.x > b.y && a.x > c.z) { float s = Mathf.Sqrt(1f + a.x - b.y - c.z) * 2f; return Normalize(new Quaternion(s / 4f, (b.x + a.y) / s, (c.x + a.z) / s, (b.z - c.y) / s)); }
            if (b.y > c.z) { float s = Mathf.Sqrt(1f + b.y - a.x - c.z) * 2f; return Normalize(new Quaternion((b.x + a.y) / s, s / 4f, (c.y + b.z) / s, (c.x - a.z) / s)); }
            { float s = Mathf.Sqrt(1f + c.z - a.x - b.y) * 2f; return Normalize(new Quaternion((c.x + a.z) / s, (c.y + b.z) / s, s / 4f, (a.y - b.x) / s)); }
        }
        public static Quaternion Lerp(Quaternion a, Quaternion b, float t)
        {
            t = Mathf.Clamp01(t);
            float sign = Dot(a, b) < 0f ? -1f : 1f;
            return Normalize(new Quaternion(a.x + (b.x * sign - a.x) * t, a.y + (b.y * sign - a.y) * t, a.z + (b.z * sign - a.z) * t, a.w + (b.w * sign - a.w) * t));
        }
        public static Quaternion Slerp(Quaternion a, Quaternion b, float t)
        {
            t = Mathf.Clamp01(t);
            float dot = Dot(a, b), sign = dot < 0f ? -1f : 1f;
            dot *= sign;
            if (dot > 0.9995f) return Lerp(a, b, t);
            float angle = Mathf.Acos(dot), p = Mathf.Sin((1f - t) * angle) / Mathf.Sin(angle), q = sign * Mathf.Sin(t * angle) / Mathf.Sin(angle);
            return new Quaternion(a.x * p + b.x * q, a.y * p + b.y * q, a.z * p + b.z * q, a.w * p + b.w * q);
        }
        public static Quaternion RotateTowards(Quaternion from, Quaternion to, float degrees) { float angle = Angle(from, to); return angle == 0f ? to : Slerp(from, to, Mathf.Min(1f, degrees / angle)); }
        public static Quaternion operator *(Quaternion a, Quaternion b)
        {
            return new Quaternion(a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y, a.w * b.y + a.y * b.w + a.z * b.x - a.x * b.z,
                a.w * b.z + a.z * b.w + a.x * b.y - a.y * b.x, a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z);
        }
        public static Vector3 operator *(Quaternion q, Vector3 v)
        {
            Vector3 u = new Vector3(q.x, q.y, q.z), t = Vector3.Cross(u, v) * 2f;
            return v + t * q.w + Vector3.Cross(u, t);
        }
        public static bool operator ==(Quaternion a, Quaternion b) { return Dot(a, b) > 1f - kEpsilon; }
        public static bool operator !=(Quaternion a, Quaternion b) { return !(a == b); }
        public bool Equals(Quaternion other) { return x == other.x && y == other.y && z == other.z && w == other.w; }
        public override bool Equals(object other) { return other is Quaternion && Equals((Quaternion)other); }
        public override int GetHashCode() { return x.GetHashCode() ^ (y.GetHashCode() << 2) ^ (z.GetHashCode() >> 2) ^ (w.GetHashCode() >> 1); }
        public override string ToString() { return Text.Of("F5", x, y, z, w); }
        public string ToString(string format) { return Text.Of(format, x, y, z, w); }
    }
}
