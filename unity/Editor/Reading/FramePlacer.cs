using UnityEngine;

namespace SuperDeform.Editor
{
    /// <summary>What a blend shape changes of a vertex.</summary>
    internal enum Change { Place, Normal, Tangent }

    /// <summary>Brings the frames of a renderer's blend shapes to the avatar's space at rest.</summary>
    internal sealed class FramePlacer
    {
        /// <summary>What the lengths of normals and tangents were multiplied by to be 1 again, by vertex.</summary>
        readonly double[] normalScales, tangentScales;

        readonly bool identity;
        readonly FrameSource frames;

        internal FramePlacer(RendererData renderer)
        {
            identity = renderer.Placements == null && renderer.Placement.Equals(Affine.Identity)
                && renderer.ModelNormals == renderer.Normals && renderer.ModelTangents == renderer.Tangents;
            if (identity) return;
            normalScales = Ones(renderer.Normals == null ? 0 : renderer.Vertices.Length);
            tangentScales = Ones(renderer.Tangents == null ? 0 : renderer.Vertices.Length);
            frames = new FrameSource(renderer);
            Frame frame = frames.At(0);
            for (int vertex = 0; vertex < renderer.Vertices.Length; vertex++)
            {
                if (frames.EachItsOwn) frame = frames.At(vertex);
                if (renderer.Normals != null) frame.Normal(renderer.Normals[vertex], out normalScales[vertex]);
                if (renderer.Tangents != null) frame.Tangent(renderer.Tangents[vertex], out tangentScales[vertex]);
            }
        }

        static double[] Ones(int count)
        {
            double[] ones = new double[count];
            for (int index = 0; index < count; index++)
            {
                ones[index] = 1;
            }
            return ones;
        }

        /// <summary>What is added to each vertex, in the avatar's space; the same array where nothing changes.</summary>
        internal Vector3[] ToModel(Vector3[] deltas, Change change)
        {
            if (identity || deltas == null) return deltas;
            Vector3[] placed = new Vector3[deltas.Length];
            for (int vertex = 0; vertex < deltas.Length; vertex++)
            {
                placed[vertex] = ToModel(deltas[vertex], vertex, change);
            }
            return placed;
        }

        /// <summary>What is added to one vertex, in the avatar's space.</summary>
        internal Vector3 ToModel(Vector3 delta, int vertex, Change change)
        {
            // There is no need of a frame for what is 0.
            if (identity || delta.x == 0 && delta.y == 0 && delta.z == 0) return delta;
            Frame at = frames.At(vertex);
            if (change == Change.Place) return at.Delta(delta, 1);
            return change == Change.Normal ? at.NormalDelta(delta, normalScales[vertex]) : at.Delta(delta, tangentScales[vertex]);
        }

        /// <summary>True where any delta of a part is not 0.</summary>
        internal static bool Changes(Vector3[] deltas, PartData part)
        {
            if (deltas == null) return false;
            for (int vertex = 0; vertex < part.VertexCount; vertex++)
            {
                Vector3 delta = deltas[part.VertexOf(vertex)];
                if (delta.x != 0 || delta.y != 0 || delta.z != 0) return true;
            }
            return false;
        }
    }

    /// <summary>
    /// The map of each vertex of a renderer to the avatar's space, made once where it is the same for all.
    /// </summary>
    internal struct FrameSource
    {
        readonly RendererData renderer;
        readonly Frame common;

        internal FrameSource(RendererData renderer)
        {
            this.renderer = renderer;
            common = new Frame(renderer.Placement);
        }

        internal bool EachItsOwn => renderer.Placements != null;

        internal Frame At(int vertex) => EachItsOwn ? new Frame(renderer.Placements[vertex]) : common;
    }
}
