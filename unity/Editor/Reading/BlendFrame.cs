using UnityEngine;

namespace SuperDeform.Editor
{
    /// <summary>One frame of a blend shape; what it changes is read from the mesh when it is needed, so that it takes no memory.</summary>
    public struct BlendFrame
    {
        public string ShapeName;

        /// <summary>Which of the mesh's blend shapes, and which of its frames.</summary>
        public int Shape, Frame;

        /// <summary>The weight at which the frame counts in full; 100 for most.</summary>
        public float Weight;
    }

    /// <summary>What a blend shape, or several at their weights, adds to each vertex of a mesh: mesh space.</summary>
    public sealed class BlendDeltas
    {
        public Vector3[] Positions;

        /// <summary>Null where there are none.</summary>
        public Vector3[] Normals;

        /// <summary>Likewise.</summary>
        public Vector3[] Tangents;

        /// <summary>With all three, which are written anew by each Read.</summary>
        internal static BlendDeltas Of(int vertices) =>
            new BlendDeltas { Positions = new Vector3[vertices], Normals = new Vector3[vertices], Tangents = new Vector3[vertices] };

        internal void Read(Mesh mesh, BlendFrame frame)
        {
            mesh.GetBlendShapeFrameVertices(frame.Shape, frame.Frame, Positions, Normals, Tangents);
        }
    }
}
