using UnityEngine;

namespace SuperDeform.Editor
{
    /// <summary>Transforms that stand for the avatar's: the same hierarchy, names, rotations and scales, moved joints.</summary>
    internal sealed class ProxySkeleton
    {
        private readonly AvatarData avatar;
        private readonly Transform[] joints;
        private readonly Matrix4x4[] inverses;

        internal Transform Root { get; private set; }

        internal ProxySkeleton(AvatarData avatar)
        {
            this.avatar = avatar;
            Root = new GameObject(avatar.Root.name + " (preview)") { hideFlags = HideFlags.HideAndDontSave }.transform;
            joints = new Transform[avatar.Joints.Length];
            inverses = new Matrix4x4[joints.Length];
            for (int joint = 0; joint < joints.Length; joint++)
            {
                Transform source = avatar.Joints[joint];
                if (source == avatar.Root.transform)
                {
                    joints[joint] = Root;
                    continue;
                }
                joints[joint] = new GameObject(source.name) { hideFlags = HideFlags.HideAndDontSave }.transform;
                joints[joint].SetParent(Of(avatar.Parents[joint]), false);
                joints[joint].localScale = source.localScale;
            }
            Stand();
        }

        /// <summary>The transform that stands for a joint; the root for -1.</summary>
        internal Transform Of(int joint)
        {
            return joint < 0 ? Root : joints[joint];
        }

        /// <summary>Model space to joint space at rest, as moved; the identity for -1.</summary>
        internal Matrix4x4 InverseRest(int joint)
        {
            return joint < 0 ? Matrix4x4.identity : inverses[joint];
        }

        /// <summary>Brings the joints to their new places. Without garbage.</summary>
        internal void Move(AvatarResult result)
        {
            for (int joint = 0; joint < joints.Length; joint++)
            {
                if (joints[joint] != Root)
                    joints[joint].localPosition = result.LocalPositions[joint];
                inverses[joint] = result.Rest[joint].Inverse.ToMatrix4x4();
            }
        }

        /// <summary>Takes the rotations in which the avatar stands.</summary>
        internal void Stand()
        {
            for (int joint = 0; joint < joints.Length; joint++)
                if (joints[joint] != Root && avatar.Joints[joint] != null)
                    joints[joint].localRotation = avatar.Joints[joint].localRotation;
        }

        internal void Destroy()
        {
            if (Root != null)
                Object.DestroyImmediate(Root.gameObject);
        }
    }
}
