using UnityEngine;

namespace SuperDeform.Editor
{
    /// <summary>
    /// Makes the mesh that shows a result: the source's copy, so that texture coordinates, colours, submeshes and weights stay,
    /// with new vertices, bind poses and blend shapes.
    /// </summary>
    internal static class MeshWriter
    {
        internal static Mesh Make(RendererResult result)
        {
            RendererData source = result.Source;
            Mesh mesh = Object.Instantiate(source.Mesh);
            try
            {
                mesh.name = source.Mesh.name;
                Write(mesh, result);
                if (source.Frames.Count > 0) WriteFrames(mesh, result);
                return mesh;
            }
            catch
            {
                Object.DestroyImmediate(mesh);
                throw;
            }
        }

        /// <summary>Gives a mesh new vertices and bind poses.</summary>
        internal static void Write(Mesh mesh, RendererResult result)
        {
            mesh.vertices = result.Positions;
            if (result.Normals != null) mesh.normals = result.Normals;
            if (result.Tangents != null) mesh.tangents = result.Tangents;
            if (result.BindPoses != null) mesh.bindposes = result.BindPoses;
            mesh.RecalculateBounds();
        }

        static void WriteFrames(Mesh mesh, RendererResult result)
        {
            RendererData source = result.Source;
            int count = source.Vertices.Length;
            // Unity copies what it is given, so that all frames share these.
            BlendFrame written = new BlendFrame { Positions = new Vector3[count], Normals = new Vector3[count], Tangents = new Vector3[count] };
            FramePlacer placer = new FramePlacer(source);
            mesh.ClearBlendShapes();
            for (int index = 0; index < source.Frames.Count; index++)
            {
                BlendFrame frame = source.Frames[index];
                result.WriteFrame(index, placer.ToModel(frame), written);
                mesh.AddBlendShapeFrame(frame.ShapeName, frame.Weight, written.Positions,
                    frame.Normals == null ? null : written.Normals, frame.Tangents == null ? null : written.Tangents);
            }
        }

        /// <summary>
        /// The bounds of a renderer: they keep the margins that they had around the vertices, in proportion.
        /// </summary>
        internal static Bounds NewBounds(Bounds old, RendererResult result)
        {
            if (result.OldBox.IsEmpty || result.NewBox.IsEmpty) return old;
            Double3 oldSize = result.OldBox.Size, newSize = result.NewBox.Size;
            double ratio = oldSize.Length > 0 ? newSize.Length / oldSize.Length : 1;
            Double3 min = Double3.Of(old.min), max = Double3.Of(old.max);
            Double3 low = result.NewBox.Low - Margin(result.OldBox.Low - min) * ratio;
            Double3 high = result.NewBox.High + Margin(max - result.OldBox.High) * ratio;
            Bounds bounds = new Bounds();
            bounds.SetMinMax(low.ToVector3(), high.ToVector3());
            return bounds;
        }

        static Double3 Margin(Double3 margin)
        {
            return new Double3(System.Math.Max(0, margin.X), System.Math.Max(0, margin.Y), System.Math.Max(0, margin.Z));
        }
    }
}
