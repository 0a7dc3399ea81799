using UnityEngine;

namespace SuperDeform.Editor
{
    /// <summary>How the preview stands.</summary>
    public enum PreviewPose { AsItStands, Walks, Sits }

    /// <summary>Bends a proxy skeleton: limbs are turned to point a given way, so that any rest pose will do.</summary>
    internal static class PreviewPoses
    {
        struct Limb
        {
            internal HumanoidRole From, To;
            /// <summary>Where it points, in the space of the avatar's root: right, up, forward.</summary>
            internal Vector3 Way;

            internal Limb(HumanoidRole from, HumanoidRole to, float right, float up, float forward)
            {
                From = from;
                To = to;
                Way = new Vector3(right, up, forward);
            }
        }

        // Parents before children.
        static readonly Limb[] walks =
        {
            new Limb(HumanoidRole.LeftUpperLeg, HumanoidRole.LeftLowerLeg, -0.05f, -1, 0.5f),
            new Limb(HumanoidRole.LeftLowerLeg, HumanoidRole.LeftFoot, 0, -1, 0.2f),
            new Limb(HumanoidRole.RightUpperLeg, HumanoidRole.RightLowerLeg, 0.05f, -1, -0.35f),
            new Limb(HumanoidRole.RightLowerLeg, HumanoidRole.RightFoot, 0, -1, -0.8f),
            new Limb(HumanoidRole.LeftUpperArm, HumanoidRole.LeftLowerArm, -0.35f, -1, -0.4f),
            new Limb(HumanoidRole.LeftLowerArm, HumanoidRole.LeftHand, -0.25f, -1, -0.1f),
            new Limb(HumanoidRole.RightUpperArm, HumanoidRole.RightLowerArm, 0.35f, -1, 0.4f),
            new Limb(HumanoidRole.RightLowerArm, HumanoidRole.RightHand, 0.25f, -1, 0.8f)
        };

        static readonly Limb[] sits =
        {
            new Limb(HumanoidRole.LeftUpperLeg, HumanoidRole.LeftLowerLeg, -0.12f, -0.1f, 1),
            new Limb(HumanoidRole.LeftLowerLeg, HumanoidRole.LeftFoot, 0, -1, 0),
            new Limb(HumanoidRole.RightUpperLeg, HumanoidRole.RightLowerLeg, 0.12f, -0.1f, 1),
            new Limb(HumanoidRole.RightLowerLeg, HumanoidRole.RightFoot, 0, -1, 0),
            new Limb(HumanoidRole.LeftUpperArm, HumanoidRole.LeftLowerArm, -0.3f, -1, 0.2f),
            new Limb(HumanoidRole.LeftLowerArm, HumanoidRole.LeftHand, -0.1f, -0.7f, 0.7f),
            new Limb(HumanoidRole.RightUpperArm, HumanoidRole.RightLowerArm, 0.3f, -1, 0.2f),
            new Limb(HumanoidRole.RightLowerArm, HumanoidRole.RightHand, 0.1f, -0.7f, 0.7f)
        };

        /// <param name="jointOf">By role, the joint; -1: none, and its limb stays.</param>
        /// <param name="twins">By joint: the joint of the body that it moves with, or itself.</param>
        internal static void Take(PreviewPose pose, ProxySkeleton skeleton, int[] jointOf, int[] twins)
        {
            if (pose == PreviewPose.AsItStands) return;
            Matrix4x4[] from = System.Array.ConvertAll(twins, twin => skeleton.Of(twin).worldToLocalMatrix);
            Quaternion[] before = System.Array.ConvertAll(twins, twin => skeleton.Of(twin).rotation);
            Vector3[] places = new Vector3[twins.Length];
            Quaternion[] turns = new Quaternion[twins.Length];
            for (int joint = 0; joint < twins.Length; joint++)
            {
                places[joint] = from[joint].MultiplyPoint3x4(skeleton.Of(joint).position);
                turns[joint] = Quaternion.Inverse(before[joint]) * skeleton.Of(joint).rotation;
            }
            Bend(pose, skeleton, jointOf);
            // Parents come first, so that what a parent does to a child is overwritten.
            for (int joint = 0; joint < twins.Length; joint++)
            {
                if (twins[joint] != joint)
                {
                    Transform twin = skeleton.Of(twins[joint]);
                    skeleton.Of(joint).position = twin.localToWorldMatrix.MultiplyPoint3x4(places[joint]);
                    skeleton.Of(joint).rotation = twin.rotation * turns[joint];
                }
            }
        }

        static void Bend(PreviewPose pose, ProxySkeleton skeleton, int[] jointOf)
        {
            foreach (Limb limb in pose == PreviewPose.Walks ? walks : sits)
            {
                int from = jointOf[(int)limb.From], to = jointOf[(int)limb.To];
                if (from < 0 || to < 0) continue;
                Transform joint = skeleton.Of(from);
                Vector3 now = skeleton.Of(to).position - joint.position;
                Vector3 wanted = skeleton.Root.rotation * limb.Way;
                joint.rotation = Quaternion.FromToRotation(now, wanted) * joint.rotation;
            }
        }
    }
}
