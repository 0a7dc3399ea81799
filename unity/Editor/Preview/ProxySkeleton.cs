using UnityEngine;

namespace SuperDeform.Editor
{
    /// <summary>Transforms that stand for the avatar's: the same hierarchy, names, rotations and scales, moved joints.</summary>
    internal sealed class ProxySkeleton
    {
        private readonly AvatarData avatar;
        private readonly Transform[] joints;
        private readonly Double3[] standing, restBefore;
        private readonly double[] positions;
        private readonly Matrix4x4[] inverses;

        internal Transform Root { get; private set; }

        internal ProxySkeleton(AvatarData avatar)
        {
            this.avatar = avatar;
            var root = new GameObject(avatar.Root.name + " (preview)") { hideFlags = HideFlags.HideAndDontSave };
            Root = root.transform;
            int count = avatar.Joints.Length;
            joints = new Transform[count];
            standing = new Double3[count];
            restBefore = new Double3[count];
            for (int joint = 0; joint < count; joint++)
            {
                if (joint == 0 && avatar.HoldsRoot)
                {
                    joints[joint] = Root;
                    continue;
                }
                Transform source = avatar.Joints[joint];
                var copy = new GameObject(source.name) { hideFlags = HideFlags.HideAndDontSave };
                joints[joint] = copy.transform;
                joints[joint].SetParent(Of(avatar.Parents[joint]), false);
                joints[joint].localRotation = source.localRotation;
                joints[joint].localScale = source.localScale;
                standing[joint] = avatar.Local[joint].Position;
                restBefore[joint] = LocalRest(joint, avatar.Rest[joint].Position, ParentPosition(joint));
            }
            // A made rig adds joints, which come after the avatar's own.
            int all = avatar.Character.Info.JointCount;
            positions = new double[3 * all];
            inverses = new Matrix4x4[count];
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

        /// <summary>Takes the joints from the deformer. Without garbage.</summary>
        internal void Move(Deformer deformer)
        {
            // An avatar without bones has transforms that are no joints of the library: they stay.
            if (!avatar.Rigged)
                return;
            deformer.GetJoints(positions, null);
            for (int joint = 0; joint < joints.Length; joint++)
            {
                if (joints[joint] == Root)
                {
                    inverses[joint] = Matrix4x4.identity;
                    continue;
                }
                Double3 moved = Moved(joint);
                int parent = avatar.Parents[joint];
                Double3 local = LocalRest(joint, moved, parent < 0 ? new Double3(0, 0, 0) : Moved(parent));
                // The avatar may stand in another pose than at rest: what it moves by is kept.
                Vector3 place = (standing[joint] + local - restBefore[joint]).ToVector3();
                joints[joint].localPosition = place;
                inverses[joint] = avatar.Rest[joint].At(moved).Inverse.ToMatrix4x4();
            }
        }

        private Double3 Moved(int joint)
        {
            return new Double3(positions[3 * joint], positions[3 * joint + 1], positions[3 * joint + 2]);
        }

        private Double3 ParentPosition(int joint)
        {
            int parent = avatar.Parents[joint];
            return parent < 0 ? new Double3(0, 0, 0) : avatar.Rest[parent].Position;
        }

        // Where a joint is in its parent's space at rest. Joints neither turn nor scale, so the parent's axes are as before.
        private Double3 LocalRest(int joint, Double3 position, Double3 parentPosition)
        {
            int parent = avatar.Parents[joint];
            if (parent < 0)
                return position;
            // A parent of scale 0 shows its children nowhere: they may be anywhere.
            Affine axes = avatar.Rest[parent].At(parentPosition);
            return axes.IsInvertible ? axes.Inverse.Point(position) : new Double3(0, 0, 0);
        }

        /// <summary>The rotations in which the avatar stands.</summary>
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
