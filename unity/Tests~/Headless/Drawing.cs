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
    }
}
