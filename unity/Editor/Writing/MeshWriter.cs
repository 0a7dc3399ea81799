using UnityEngine;

namespace SuperDeform.Editor
{
    /// <summary>
    /// Makes the mesh that shows a result: the source's copy, so that texture coordinates, colours, submeshes and weights stay,
    /// with new vertices, bind poses and blend shapes.
    /// </summary>
    internal static class MeshWriter
    {
        /// <param name="progress">Told of the blend shapes, which take longest; false ends all.</param>
        /// <exception cref="ConversionException">It was cancelled.</exception>
        internal static Mesh Make(RendererResult result, PointMap map, ProgressHandler progress)
        {
            RendererData source = result.Source;
            Mesh mesh = Object.Instantiate(source.Mesh);
            try
            {
                mesh.name = source.Mesh.name;
                // The copies of what they were would lie in memory beside what they become.
                mesh.ClearBlendShapes();
                Write(mesh, result);
                if (source.Frames.Count > 0) new ShapeWriter(result, map.Deformer, source.Frames).Write(mesh, progress);
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
            var bounds = new Bounds();
            bounds.SetMinMax(low.ToVector3(), high.ToVector3());
            return bounds;
        }

        static Double3 Margin(Double3 margin) =>
            new Double3(System.Math.Max(0, margin.X), System.Math.Max(0, margin.Y), System.Math.Max(0, margin.Z));
    }
}
