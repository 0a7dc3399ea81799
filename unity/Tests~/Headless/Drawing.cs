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
                return Array.ConvertAll(renderer.GetComponent<MeshFilter>().sharedMesh.vertices, p => (space * renderer.transform.localToWorldMatrix).MultiplyPoint3x4(p));
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
            for (int i = 0; i < one.Length; i++)
                most = Math.Max(most, Vector3.Distance(one[i], other[i]));
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
            for (int i = 0; i < before.Length; i++)
                most = Math.Max(most, (after[i] - to - (before[i] - from) * (float)size).magnitude);
            return most;
        }

        private static Vector3 Middle(Vector3[] points)
        {
            Vector3 sum = Vector3.zero;
            foreach (Vector3 point in points)
                sum += point;
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
