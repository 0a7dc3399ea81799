using System.Collections.Generic;
using UnityEngine;

namespace SuperDeform.Editor
{
    /// <summary>
    /// Cuts a mesh into the library's meshes: submeshes that share no vertices are meshes of their own, since a kind (hair,
    /// clothes, skin) goes by material.
    /// </summary>
    internal static class SubmeshParts
    {
        /// <summary>
        /// The parts of a mesh; each vertex is in one of them.
        ///
        /// Vertices that no triangle uses are of the part of the vertex before them, so that they move along.
        /// </summary>
        internal static List<PartData> Of(RendererData renderer)
        {
            Mesh mesh = renderer.Mesh;
            int vertexCount = renderer.Vertices.Length;
            int[][] triangles = new int[mesh.subMeshCount][];
            int[] partOf = new int[vertexCount];
            for (int vertex = 0; vertex < vertexCount; vertex++)
            {
                partOf[vertex] = -1;
            }
            int[] same = new int[mesh.subMeshCount];
            for (int submesh = 0; submesh < mesh.subMeshCount; submesh++)
            {
                same[submesh] = submesh;
                int[] corners = mesh.GetIndices(submesh);
                foreach (int vertex in corners)
                {
                    if (partOf[vertex] < 0) partOf[vertex] = submesh;
                    Join(same, partOf[vertex], submesh);
                }
                triangles[submesh] = Triangles(corners, mesh.GetTopology(submesh));
            }
            int current = Find(same, FirstUsed(partOf));
            for (int vertex = 0; vertex < vertexCount; vertex++)
            {
                if (partOf[vertex] >= 0) current = Find(same, partOf[vertex]);
                partOf[vertex] = current;
            }
            return Cut(renderer, partOf, same, triangles);
        }

        static int FirstUsed(int[] partOf)
        {
            foreach (int part in partOf)
            {
                if (part >= 0) return part;
            }
            return 0;
        }

        static List<PartData> Cut(RendererData renderer, int[] partOf, int[] same, int[][] triangles)
        {
            var parts = new List<PartData>();
            int[] placeOf = new int[partOf.Length];
            for (int submesh = 0; submesh < triangles.Length; submesh++)
            {
                if (Find(same, submesh) != submesh) continue;
                var vertices = new List<int>();
                for (int vertex = 0; vertex < partOf.Length; vertex++)
                {
                    if (partOf[vertex] != submesh) continue;
                    placeOf[vertex] = vertices.Count;
                    vertices.Add(vertex);
                }
                if (vertices.Count == 0) continue;
                Material material = MostSeen(renderer, same, triangles, submesh);
                bool contiguous = vertices[vertices.Count - 1] - vertices[0] == vertices.Count - 1;
                parts.Add(new PartData
                {
                    Renderer = renderer,
                    Name = renderer.Renderer.name + "/" + renderer.Mesh.name + "/" + (material == null ? "" : material.name),
                    Material = material,
                    FirstVertex = vertices[0],
                    VertexCount = vertices.Count,
                    Vertices = contiguous ? null : vertices.ToArray(),
                    Indices = Indices(same, triangles, submesh, placeOf)
                });
            }
            return parts;
        }

        static int[] Indices(int[] same, int[][] triangles, int part, int[] placeOf)
        {
            var indices = new List<int>();
            for (int submesh = part; submesh < triangles.Length; submesh++)
            {
                if (Find(same, submesh) != part) continue;
                foreach (int vertex in triangles[submesh])
                {
                    indices.Add(placeOf[vertex]);
                }
            }
            return indices.ToArray();
        }

        /// <summary>The material of the submesh with the most triangles stands for all; null where there is none.</summary>
        static Material MostSeen(RendererData renderer, int[] same, int[][] triangles, int part)
        {
            int largest = part;
            for (int submesh = part; submesh < triangles.Length; submesh++)
            {
                if (Find(same, submesh) == part && triangles[submesh].Length > triangles[largest].Length) largest = submesh;
            }
            Material[] materials = renderer.Shown.sharedMaterials;
            return largest < materials.Length ? materials[largest] : null;
        }

        static int Find(int[] same, int submesh)
        {
            while (same[submesh] != submesh)
            {
                submesh = same[submesh];
            }
            return submesh;
        }

        /// <summary>The lower number stands for both.</summary>
        static void Join(int[] same, int one, int other)
        {
            one = Find(same, one);
            other = Find(same, other);
            if (one < other) same[other] = one;
            else same[one] = other;
        }

        /// <summary>Corners as triangles: quads are cut in two, lines and points have none.</summary>
        static int[] Triangles(int[] corners, MeshTopology topology)
        {
            if (topology == MeshTopology.Triangles) return corners;
            if (topology != MeshTopology.Quads) return new int[0];
            int[] triangles = new int[corners.Length / 4 * 6];
            for (int quad = 0; quad < corners.Length / 4; quad++)
            {
                int from = 4 * quad, to = 6 * quad;
                triangles[to] = corners[from];
                triangles[to + 1] = corners[from + 1];
                triangles[to + 2] = corners[from + 2];
                triangles[to + 3] = corners[from];
                triangles[to + 4] = corners[from + 2];
                triangles[to + 5] = corners[from + 3];
            }
            return triangles;
        }
    }
}
