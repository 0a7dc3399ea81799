// Boxes, rectangles, rays, planes and colours.
using System;

namespace UnityEngine
{
    [Serializable]
    public struct Bounds : IEquatable<Bounds>
    {
        Vector3 m_Center, m_Extents;
        public Bounds(Vector3 center, Vector3 size) { m_Center = center; m_Extents = size * 0.5f; }
        public Vector3 center { get { return m_Center; } set { m_Center = value; } }
        public Vector3 extents { get { return m_Extents; } set { m_Extents = value; } }
        public Vector3 size { get { return m_Extents * 2f; } set { m_Extents = value * 0.5f; } }
        public Vector3 min { get { return center - extents; } set { SetMinMax(value, max); } }
        public Vector3 max { get { return center + extents; } set { SetMinMax(min, value); } }
        public void SetMinMax(Vector3 min, Vector3 max) { extents = (max - min) * 0.5f; center = min + extents; }
        public void Encapsulate(Vector3 point) { SetMinMax(Vector3.Min(min, point), Vector3.Max(max, point)); }
        public void Encapsulate(Bounds other) { Encapsulate(other.min); Encapsulate(other.max); }
        public void Expand(float amount) { extents += Vector3.one * (amount * 0.5f); }
        public void Expand(Vector3 amount) { extents += amount * 0.5f; }
        public bool Contains(Vector3 p) { Vector3 a = min, b = max; return p.x >= a.x && p.x <= b.x && p.y >= a.y && p.y <= b.y && p.z >= a.z && p.z <= b.z; }
        public bool Intersects(Bounds other) { Vector3 a = min, b = max, c = other.min, d = other.max; return a.x <= d.x && b.x >= c.x && a.y <= d.y && b.y >= c.y && a.z <= d.z && b.z >= c.z; }
        public Vector3 ClosestPoint(Vector3 p) { return Vector3.Max(min, Vector3.Min(max, p)); }
        public float SqrDistance(Vector3 p) { return (ClosestPoint(p) - p).sqrMagnitude; }
        public static bool operator ==(Bounds a, Bounds b) { return a.center == b.center && a.extents == b.extents; }
        public static bool operator !=(Bounds a, Bounds b) { return !(a == b); }
        public bool Equals(Bounds other) { return center.Equals(other.center) && extents.Equals(other.extents); }
        public override bool Equals(object other) { return other is Bounds && Equals((Bounds)other); }
        public override int GetHashCode() { return center.GetHashCode() ^ (extents.GetHashCode() << 2); }
        public override string ToString() { return "Center: " + center + ", Extents: " + extents; }
    }

    [Serializable]
    public struct Rect
    {
        public float x { get; set; }
        public float y { get; set; }
        public float width { get; set; }
        public float height { get; set; }
        public Rect(float x, float y, float width, float height) : this() { this.x = x; this.y = y; this.width = width; this.height = height; }
        public Rect(Vector2 position, Vector2 size) : this(position.x, position.y, size.x, size.y) { }
        public Rect(Rect source) : this(source.x, source.y, source.width, source.height) { }
        public static Rect zero { get { return new Rect(); } }
        public static Rect MinMaxRect(float xmin, float ymin, float xmax, float ymax) { return new Rect(xmin, ymin, xmax - xmin, ymax - ymin); }
        public float xMin { get { return x; } set { width += x - value; x = value; } }
        public float yMin { get { return y; } set { height += y - value; y = value; } }
        public float xMax { get { return x + width; } set { width = value - x; } }
        public float yMax { get { return y + height; } set { height = value - y; } }
        public Vector2 position { get { return new Vector2(x, y); } set { x = value.x; y = value.y; } }
        public Vector2 size { get { return new Vector2(width, height); } set { width = value.x; height = value.y; } }
        public Vector2 center { get { return new Vector2(x + width / 2f, y + height / 2f); } set { x = value.x - width / 2f; y = value.y - height / 2f; } }
        public Vector2 min { get { return position; } }
        public Vector2 max { get { return new Vector2(xMax, yMax); } }
        public bool Contains(Vector2 p) { return p.x >= x && p.x < xMax && p.y >= y && p.y < yMax; }
        public bool Contains(Vector3 p) { return Contains((Vector2)p); }
        public bool Overlaps(Rect other) { return other.xMax > xMin && other.xMin < xMax && other.yMax > yMin && other.yMin < yMax; }
        public static bool operator ==(Rect a, Rect b) { return a.x == b.x && a.y == b.y && a.width == b.width && a.height == b.height; }
        public static bool operator !=(Rect a, Rect b) { return !(a == b); }
        public override bool Equals(object other) { return other is Rect && this == (Rect)other; }
        public override int GetHashCode() { return position.GetHashCode() ^ (size.GetHashCode() << 2); }
        public override string ToString() { return Text.Of(null, x, y, width, height); }
    }

    [Serializable]
    public class RectOffset
    {
        public int left, right, top, bottom;
        public RectOffset() { }
        public RectOffset(int left, int right, int top, int bottom) { this.left = left; this.right = right; this.top = top; this.bottom = bottom; }
        public int horizontal { get { return left + right; } }
        public int vertical { get { return top + bottom; } }
    }

    public struct Ray
    {
        public Vector3 origin, direction;
        public Ray(Vector3 origin, Vector3 direction) { this.origin = origin; this.direction = direction.normalized; }
        public Vector3 GetPoint(float distance) { return origin + direction * distance; }
    }

    public struct Plane
    {
        public Vector3 normal { get; set; }
        public float distance { get; set; }
        public Plane(Vector3 normal, Vector3 point) : this() { this.normal = normal.normalized; distance = -Vector3.Dot(this.normal, point); }
        public float GetDistanceToPoint(Vector3 point) { return Vector3.Dot(normal, point) + distance; }
    }

    [Serializable]
    public struct Color : IEquatable<Color>
    {
        public float r, g, b, a;
        public Color(float r, float g, float b, float a) { this.r = r; this.g = g; this.b = b; this.a = a; }
        public Color(float r, float g, float b) : this(r, g, b, 1f) { }
        public static Color white { get { return new Color(1, 1, 1); } }
        public static Color black { get { return new Color(0, 0, 0); } }
        public static Color clear { get { return new Color(0, 0, 0, 0); } }
        public static Color red { get { return new Color(1, 0, 0); } }
        public static Color green { get { return new Color(0, 1, 0); } }
        public static Color blue { get { return new Color(0, 0, 1); } }
        public static Color yellow { get { return new Color(1, 0.92f, 0.016f); } }
        public static Color cyan { get { return new Color(0, 1, 1); } }
        public static Color magenta { get { return new Color(1, 0, 1); } }
        public static Color gray { get { return new Color(0.5f, 0.5f, 0.5f); } }
        public static Color grey { get { return gray; } }
        public static Color Lerp(Color p, Color q, float t) { t = Mathf.Clamp01(t); return new Color(p.r + (q.r - p.r) * t, p.g + (q.g - p.g) * t, p.b + (q.b - p.b) * t, p.a + (q.a - p.a) * t); }
        public static Color operator *(Color p, Color q) { return new Color(p.r * q.r, p.g * q.g, p.b * q.b, p.a * q.a); }
        public static Color operator *(Color p, float s) { return new Color(p.r * s, p.g * s, p.b * s, p.a * s); }
        public static bool operator ==(Color p, Color q) { return (Vector4)p == (Vector4)q; }
        public static bool operator !=(Color p, Color q) { return !(p == q); }
        public static implicit operator Vector4(Color c) { return new Vector4(c.r, c.g, c.b, c.a); }
        public static implicit operator Color(Vector4 v) { return new Color(v.x, v.y, v.z, v.w); }
        public bool Equals(Color other) { return ((Vector4)this).Equals((Vector4)other); }
        public override bool Equals(object other) { return other is Color && Equals((Color)other); }
        public override int GetHashCode() { return ((Vector4)this).GetHashCode(); }
        public override string ToString() { return "RGBA" + Text.Of("F3", r, g, b, a); }
    }

    [Serializable]
    public struct Color32
    {
        public byte r, g, b, a;
        public Color32(byte r, byte g, byte b, byte a) { this.r = r; this.g = g; this.b = b; this.a = a; }
        static byte Unit(float v) { return (byte)Mathf.Round(Mathf.Clamp01(v) * 255f); }
        public static implicit operator Color32(Color c) { return new Color32(Unit(c.r), Unit(c.g), Unit(c.b), Unit(c.a)); }
        public static implicit operator Color(Color32 c) { return new Color(c.r / 255f, c.g / 255f, c.b / 255f, c.a / 255f); }
        public override string ToString() { return "RGBA(" + r + ", " + g + ", " + b + ", " + a + ")"; }
    }

    [Serializable]
    public struct LayerMask
    {
        int m_Mask;
        public int value { get { return m_Mask; } set { m_Mask = value; } }
        public static implicit operator int(LayerMask mask) { return mask.m_Mask; }
        public static implicit operator LayerMask(int value) { LayerMask mask = new LayerMask(); mask.m_Mask = value; return mask; }
    }

    [Serializable]
    public struct Keyframe
    {
        public float time, value, inTangent, outTangent;
        public Keyframe(float time, float value) { this.time = time; this.value = value; inTangent = outTangent = 0; }
        public Keyframe(float time, float value, float inTangent, float outTangent) { this.time = time; this.value = value; this.inTangent = inTangent; this.outTangent = outTangent; }
    }

    public enum WrapMode { Default = 0, Once = 1, Clamp = 1, Loop = 2, PingPong = 4, ClampForever = 8 }

    [Serializable]
    public class AnimationCurve
    {
        Keyframe[] m_Keys = new Keyframe[0];
        // A copy: what is changed in it is only taken when it is set again.
        public Keyframe[] keys { get { return (Keyframe[])m_Keys.Clone(); } set { m_Keys = value == null ? new Keyframe[0] : (Keyframe[])value.Clone(); } }
        public AnimationCurve(params Keyframe[] keys) { this.keys = keys; }
        public AnimationCurve() { }
        public int length { get { return m_Keys.Length; } }
        public WrapMode preWrapMode { get; set; }
        public WrapMode postWrapMode { get; set; }
        public static AnimationCurve Linear(float timeStart, float valueStart, float timeEnd, float valueEnd)
        {
            float slope = timeStart == timeEnd ? 0f : (valueEnd - valueStart) / (timeEnd - timeStart);
            return new AnimationCurve(new Keyframe(timeStart, valueStart, slope, slope), new Keyframe(timeEnd, valueEnd, slope, slope));
        }
        // Cubic Hermite between keys, constant outside.
        public float Evaluate(float time)
        {
            if (m_Keys.Length == 0) return 0f;
            if (time <= m_Keys[0].time) return m_Keys[0].value;
            for (int at = 1; at < m_Keys.Length; at++)
            {
                Keyframe p = m_Keys[at - 1], q = m_Keys[at];
                if (time > q.time) continue;
                float span = q.time - p.time, t = span == 0f ? 1f : (time - p.time) / span, t2 = t * t, t3 = t2 * t;
                return (2 * t3 - 3 * t2 + 1) * p.value + (t3 - 2 * t2 + t) * span * p.outTangent + (-2 * t3 + 3 * t2) * q.value + (t3 - t2) * span * q.inTangent;
            }
            return m_Keys[m_Keys.Length - 1].value;
        }
    }
}
