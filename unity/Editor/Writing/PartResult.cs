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
            int frames = part.Renderer.Frames.Count;
            if (frames == 0) return;
            int numbers = checked(3 * part.VertexCount * frames);
            Output.MorphTargetCount = frames;
            Output.MorphPositions = new float[numbers];
            if (Array.IndexOf(part.MovesNormals, true) >= 0) Output.MorphNormals = new float[numbers];
            if (Array.IndexOf(part.MovesTangents, true) >= 0) Output.MorphTangents = new float[numbers];
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

        /// <summary>The change of one vertex in one of the packed arrays; 0 where there is none.</summary>
        internal Vector3 Delta(float[] packed, int frame, int vertex)
        {
            if (packed == null) return new Vector3(0, 0, 0);
            int start = 3 * (frame * Part.VertexCount + vertex);
            return new Vector3(packed[start], packed[start + 1], packed[start + 2]);
        }
    }
}
