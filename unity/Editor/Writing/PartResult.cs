using System;
using UnityEngine;

namespace SuperDeform.Editor
{
    /// <summary>Where the library writes what becomes of one part.</summary>
    internal sealed class PartResult
    {
        internal readonly PartData Part;
        internal readonly MeshOutput Output;
        readonly RendererResult renderer;

        internal PartResult(PartData part, RendererResult renderer)
        {
            Part = part;
            this.renderer = renderer;
            bool aside = part.Vertices != null;
            Output = new MeshOutput
            {
                FirstVertex = part.Start,
                VertexCount = part.VertexCount,
                Positions = aside ? new Vector3[part.VertexCount] : renderer.Positions,
                Normals = renderer.Normals != null && aside ? new Vector3[part.VertexCount] : renderer.Normals,
                Tangents = renderer.Tangents != null && aside ? new Vector4[part.VertexCount] : renderer.Tangents
            };
            if (part.Renderer.Worn == null) return;
            Output.MorphTargetCount = 1;
            Output.MorphPositions = new float[3 * part.VertexCount];
            if (part.WornTurns) Output.MorphNormals = new float[3 * part.VertexCount];
        }

        /// <summary>Brings vertices that do not lie side by side to their places.</summary>
        internal void Spread()
        {
            if (Part.Vertices == null) return;
            Spread((Vector3[])Output.Positions, renderer.Positions);
            if (renderer.Normals != null) Spread((Vector3[])Output.Normals, renderer.Normals);
            if (renderer.Tangents != null) Spread((Vector4[])Output.Tangents, renderer.Tangents);
        }

        void Spread<T>(T[] from, T[] to) where T : struct
        {
            int[] places = Part.Vertices;
            for (int vertex = 0; vertex < places.Length; vertex++)
            {
                to[places[vertex]] = from[vertex];
            }
        }

        /// <summary>What is worn of one vertex, in one of the packed arrays.</summary>
        internal static Vector3 Worn(float[] packed, int vertex) => new Vector3(packed[3 * vertex], packed[3 * vertex + 1], packed[3 * vertex + 2]);
    }
}
