using UnityEngine;

namespace SuperDeform.Editor
{
    /// <summary>One transform of the hierarchy that a humanoid Avatar is built for, in T pose.</summary>
    internal sealed class AvatarNode
    {
        internal string Name;

        /// <summary>The node that it hangs from; -1: the animator's own transform.</summary>
        internal int Parent;

        internal Vector3 Position;
        internal Quaternion Rotation;
        internal Vector3 Scale;
    }
}
