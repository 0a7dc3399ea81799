using UnityEngine;

namespace SuperDeform.Editor
{
    /// <summary>A collider of springs, in the space of the transform that it moves with.</summary>
    public struct LocalCollider
    {
        public ColliderKind Kind;

        /// <summary>A ball's middle, the middle of a capsule's first end, or a point of a plane.</summary>
        public Vector3 Start;

        /// <summary>The middle of a capsule's other end, or a plane's normal.</summary>
        public Vector3 End;

        /// <summary>Of balls and capsules.</summary>
        public float Radius;
    }
}
