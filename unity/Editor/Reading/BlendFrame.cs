using UnityEngine;

namespace SuperDeform.Editor
{
    /// <summary>One frame of a blend shape: what is added to each vertex of a mesh at the frame's weight.</summary>
    public sealed class BlendFrame
    {
        public string ShapeName;

        /// <summary>The weight at which the frame counts in full; 100 for most.</summary>
        public float Weight;

        /// <summary>Mesh space.</summary>
        public Vector3[] Positions;

        /// <summary>Null where all are 0: Unity does not tell apart what was left out.</summary>
        public Vector3[] Normals;

        /// <summary>Likewise.</summary>
        public Vector3[] Tangents;
    }
}
