using System.Collections.Generic;
using UnityEngine;

namespace SuperDeform.Editor
{
    /// <summary>One mesh of the library: the vertices of one submesh, or of several that share vertices.</summary>
    public sealed class PartData
    {
        /// <summary>"object/mesh/material", from which the library guesses what it is.</summary>
        public string Name;

        public RendererData Renderer;

        /// <summary>Which of the library's meshes it is.</summary>
        internal int Index;

        /// <summary>What most of its triangles show; may be null.</summary>
        public Material Material;

        /// <summary>
        /// The mesh's vertices FirstVertex to FirstVertex + VertexCount - 1, where Vertices is null.
        /// </summary>
        public int FirstVertex;

        public int VertexCount;

        /// <summary>The mesh's vertices, rising, where they do not lie side by side.</summary>
        public int[] Vertices;

        /// <summary>Triangles; FirstVertex, or the first of Vertices, counts as 0.</summary>
        public int[] Indices;

        /// <summary>Whether what is worn changes a place, a normal of this part.</summary>
        internal bool WornMoves, WornTurns;

        /// <summary>
        /// What an array by vertex of the mesh holds of this part: the array itself where the vertices lie side by side.
        /// </summary>
        internal T[] Gather<T>(T[] whole)
        {
            if (whole == null || Vertices == null) return whole;
            T[] part = new T[VertexCount];
            for (int vertex = 0; vertex < VertexCount; vertex++)
            {
                part[vertex] = whole[Vertices[vertex]];
            }
            return part;
        }

        /// <summary>Where this part begins in what Gather gives.</summary>
        internal int Start => Vertices == null ? FirstVertex : 0;

        /// <summary>The mesh's vertex that a vertex of this part is.</summary>
        internal int VertexOf(int vertex) => Vertices == null ? FirstVertex + vertex : Vertices[vertex];
    }
}
