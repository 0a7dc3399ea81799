using UnityEngine;

namespace SuperDeform.Editor
{
    /// <summary>Brings the frames of a renderer's blend shapes to the avatar's space at rest.</summary>
    internal sealed class FramePlacer
    {
        readonly RendererData renderer;

        /// <summary>What the lengths of normals and tangents were multiplied by to be 1 again, by vertex.</summary>
        readonly double[] normalScales, tangentScales;

        readonly bool identity;

        internal FramePlacer(RendererData renderer)
        {
            this.renderer = renderer;
            if (renderer.Frames.Count == 0) return;
            identity = renderer.Placements == null && renderer.Placement.Equals(Affine.Identity)
                && renderer.ModelNormals == renderer.Normals && renderer.ModelTangents == renderer.Tangents;
            if (identity) return;
            normalScales = Ones(renderer.Normals == null ? 0 : renderer.Vertices.Length);
            tangentScales = Ones(renderer.Tangents == null ? 0 : renderer.Vertices.Length);
            FrameSource frames = new FrameSource(renderer);
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

        /// <summary>The frame itself where nothing changes.</summary>
        internal BlendFrame ToModel(BlendFrame frame)
        {
            if (identity) return frame;
            BlendFrame placed = new BlendFrame
            {
                ShapeName = frame.ShapeName,
                Weight = frame.Weight,
                Positions = new Vector3[frame.Positions.Length],
                Normals = frame.Normals == null ? null : new Vector3[frame.Positions.Length],
                Tangents = frame.Tangents == null ? null : new Vector3[frame.Positions.Length]
            };
            FrameSource frames = new FrameSource(renderer);
            Frame at = frames.At(0);
            for (int vertex = 0; vertex < frame.Positions.Length; vertex++)
            {
                if (frames.EachItsOwn) at = frames.At(vertex);
                placed.Positions[vertex] = at.Delta(frame.Positions[vertex], 1);
                if (placed.Normals != null) placed.Normals[vertex] = at.NormalDelta(frame.Normals[vertex], normalScales[vertex]);
                if (placed.Tangents != null) placed.Tangents[vertex] = at.Delta(frame.Tangents[vertex], tangentScales[vertex]);
            }
            return placed;
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

        internal bool EachItsOwn
        {
            get { return renderer.Placements != null; }
        }

        internal Frame At(int vertex)
        {
            return EachItsOwn ? new Frame(renderer.Placements[vertex]) : common;
        }
    }
}
