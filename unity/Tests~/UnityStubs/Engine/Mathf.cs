// Single-precision mathematics with the names of UnityEngine.Mathf.
using System;

namespace UnityEngine
{
    public struct Mathf
    {
        public const float PI = (float)Math.PI;
        public const float Infinity = float.PositiveInfinity;
        public const float NegativeInfinity = float.NegativeInfinity;
        public const float Deg2Rad = PI * 2f / 360f;
        public const float Rad2Deg = 1f / Deg2Rad;
        public static readonly float Epsilon = float.Epsilon;

        public static float Sin(float value) { return (float)Math.Sin(value); }
        public static float Cos(float value) { return (float)Math.Cos(value); }
        public static float Tan(float value) { return (float)Math.Tan(value); }
        public static float Asin(float value) { return (float)Math.Asin(value); }
        public static float Acos(float value) { return (float)Math.Acos(value); }
        public static float Atan(float value) { return (float)Math.Atan(value); }
        public static float Atan2(float y, float x) { return (float)Math.Atan2(y, x); }
        public static float Sqrt(float value) { return (float)Math.Sqrt(value); }
        public static float Pow(float value, float power) { return (float)Math.Pow(value, power); }
        public static float Exp(float power) { return (float)Math.Exp(power); }
        public static float Log(float value) { return (float)Math.Log(value); }
        public static float Log(float value, float radix) { return (float)Math.Log(value, radix); }
        public static float Log10(float value) { return (float)Math.Log10(value); }
        public static float Abs(float value) { return Math.Abs(value); }
        public static int Abs(int value) { return Math.Abs(value); }
        public static float Sign(float value) { return value >= 0f ? 1f : -1f; }
        public static float Floor(float value) { return (float)Math.Floor(value); }
        public static float Ceil(float value) { return (float)Math.Ceiling(value); }
        public static float Round(float value) { return (float)Math.Round(value); }
        public static int FloorToInt(float value) { return (int)Math.Floor(value); }
        public static int CeilToInt(float value) { return (int)Math.Ceiling(value); }
        public static int RoundToInt(float value) { return (int)Math.Round(value); }
        public static float Min(float a, float b) { return a < b ? a : b; }
        public static int Min(int a, int b) { return a < b ? a : b; }
        public static float Max(float a, float b) { return a > b ? a : b; }
        public static int Max(int a, int b) { return a > b ? a : b; }
        public static float Min(params float[] values) { float least = values.Length == 0 ? 0 : values[0]; foreach (float v in values) least = Min(least, v); return least; }
        public static float Max(params float[] values) { float most = values.Length == 0 ? 0 : values[0]; foreach (float v in values) most = Max(most, v); return most; }
        public static int Min(params int[] values) { int least = values.Length == 0 ? 0 : values[0]; foreach (int v in values) least = Min(least, v); return least; }
        public static int Max(params int[] values) { int most = values.Length == 0 ? 0 : values[0]; foreach (int v in values) most = Max(most, v); return most; }
        public static float Clamp(float value, float min, float max) { return value < min ? min : value > max ? max : value; }
        public static int Clamp(int value, int min, int max) { return value < min ? min : value > max ? max : value; }
        public static float Clamp01(float value) { return Clamp(value, 0f, 1f); }
        public static float Lerp(float a, float b, float t) { return a + (b - a) * Clamp01(t); }
        public static float LerpUnclamped(float a, float b, float t) { return a + (b - a) * t; }
        public static float InverseLerp(float a, float b, float value) { return a == b ? 0f : Clamp01((value - a) / (b - a)); }
        public static float Repeat(float t, float length) { return Clamp(t - Floor(t / length) * length, 0f, length); }
        public static float PingPong(float t, float length) { t = Repeat(t, length * 2f); return length - Abs(t - length); }
        public static float DeltaAngle(float current, float target) { float delta = Repeat(target - current, 360f); return delta > 180f ? delta - 360f : delta; }
        public static float MoveTowards(float current, float target, float step) { return Abs(target - current) <= step ? target : current + Sign(target - current) * step; }
        public static float SmoothStep(float from, float to, float t) { t = Clamp01(t); t = -2f * t * t * t + 3f * t * t; return to * t + from * (1f - t); }
        public static bool Approximately(float a, float b) { return Abs(b - a) < Max(1e-6f * Max(Abs(a), Abs(b)), Epsilon * 8f); }
        public static bool IsPowerOfTwo(int value) { return (value & (value - 1)) == 0; }
        public static int NextPowerOfTwo(int value) { int power = 1; while (power < value) power <<= 1; return power; }
    }
}
