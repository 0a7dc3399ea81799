using System;
using NUnit.Framework;
using UnityEngine;
using UnityStubs;

namespace SuperDeform.Editor.Tests
{
    /// <summary>Where vertices are drawn, and how far that is from elsewhere.</summary>
    internal static class Drawing
    {
        /// <summary>The vertices of a renderer in a space.</summary>
        internal static Vector3[] Drawn(Renderer renderer, Matrix4x4 space)
        {
            var skinned = renderer as SkinnedMeshRenderer;
            if (skinned == null)
            {
                return Array.ConvertAll(renderer.GetComponent<MeshFilter>().sharedMesh.vertices, p => (space * renderer.transform.localToWorldMatrix).MultiplyPoint3x4(p));
            }
            Vector3[] positions, normals;
            Skinning.Drawn(skinned, space, out positions, out normals);
            return positions;
        }

        /// <summary>The vertices of the renderer of a name, in the root's space.</summary>
        internal static Vector3[] Drawn(GameObject root, string name)
        {
            Renderer renderer = Array.Find(root.GetComponentsInChildren<Renderer>(true), one => one.name == name);
            Assert.That(renderer, Is.Not.Null, name);
            return Drawn(renderer, root.transform.worldToLocalMatrix);
        }

        /// <summary>The greatest distance between points of the same number.</summary>
        internal static double Apart(Vector3[] one, Vector3[] other)
        {
            Assert.AreEqual(one.Length, other.Length);
            double most = 0;
            for (int i = 0; i < one.Length; i++) most = Math.Max(most, Vector3.Distance(one[i], other[i]));
            return most;
        }

        /// <summary>How far points lie from where a scale and a shift take others, at most: 0 where both have one shape.</summary>
        internal static double OffSimilarity(Vector3[] before, Vector3[] after, out double size)
        {
            Vector3 from = Middle(before), to = Middle(after);
            double product = 0, square = 0, most = 0;
            for (int i = 0; i < before.Length; i++)
            {
                product += Vector3.Dot(before[i] - from, after[i] - to);
                square += (before[i] - from).sqrMagnitude;
            }
            size = product / square;
            for (int i = 0; i < before.Length; i++) most = Math.Max(most, (after[i] - to - (before[i] - from) * (float)size).magnitude);
            return most;
        }

        /// <summary>How far points lie from a surface: in the mean, and at most; of every so manyth point.</summary>
        internal static double[] ToSurface(Vector3[] points, Vector3[] corners, int[] triangles, int step)
        {
            double sum = 0, most = 0;
            int count = 0;
            for (int i = 0; i < points.Length; i += step)
            {
                double nearest = double.PositiveInfinity;
                for (int t = 0; t < triangles.Length; t += 3)
                {
                    nearest = Math.Min(nearest, ToTriangle(points[i], corners[triangles[t]], corners[triangles[t + 1]], corners[triangles[t + 2]]));
                }
                nearest = Math.Sqrt(nearest);
                sum += nearest;
                most = Math.Max(most, nearest);
                count++;
            }
            return new[] { sum / count, most };
        }

        /// <summary>The square of the distance of a point from a triangle (Ericson, Real-Time Collision Detection, 5.1.5).</summary>
        static float ToTriangle(Vector3 p, Vector3 a, Vector3 b, Vector3 c)
        {
            Vector3 ab = b - a, ac = c - a, ap = p - a;
            float d1 = Vector3.Dot(ab, ap), d2 = Vector3.Dot(ac, ap);
            if (d1 <= 0 && d2 <= 0) return ap.sqrMagnitude;
            Vector3 bp = p - b;
            float d3 = Vector3.Dot(ab, bp), d4 = Vector3.Dot(ac, bp);
            if (d3 >= 0 && d4 <= d3) return bp.sqrMagnitude;
            float vc = d1 * d4 - d3 * d2;
            if (vc <= 0 && d1 >= 0 && d3 <= 0) return (ap - ab * (d1 / (d1 - d3))).sqrMagnitude;
            Vector3 cp = p - c;
            float d5 = Vector3.Dot(ab, cp), d6 = Vector3.Dot(ac, cp);
            if (d6 >= 0 && d5 <= d6) return cp.sqrMagnitude;
            float vb = d5 * d2 - d1 * d6;
            if (vb <= 0 && d2 >= 0 && d6 <= 0) return (ap - ac * (d2 / (d2 - d6))).sqrMagnitude;
            float va = d3 * d6 - d5 * d4;
            if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) return (bp - (c - b) * ((d4 - d3) / (d4 - d3 + d5 - d6))).sqrMagnitude;
            float scale = 1 / (va + vb + vc);
            return (ap - ab * (vb * scale) - ac * (vc * scale)).sqrMagnitude;
        }

        static Vector3 Middle(Vector3[] points)
        {
            Vector3 sum = Vector3.zero;
            foreach (Vector3 point in points) sum += point;
            return sum / points.Length;
        }

        /// <summary>How tall points are together.</summary>
        internal static double Extent(Vector3[] points)
        {
            double low = double.PositiveInfinity, high = double.NegativeInfinity;
            foreach (Vector3 point in points)
            {
                low = Math.Min(low, point.y);
                high = Math.Max(high, point.y);
            }
            return high - low;
        }
    }
}
