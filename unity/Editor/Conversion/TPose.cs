using System.Collections.Generic;
using UnityEditor;
using UnityEngine;

namespace SuperDeform.Editor
{
    /// <summary>Puts an avatar into the T pose that its Avatar asset remembers.</summary>
    internal static class TPose
    {
        /// <summary>True for avatars of a scene whose Avatar knows a pose.</summary>
        internal static bool CanStand(AvatarData data) =>
            HumanoidRoles.IsHumanoid(data.Animator) && !EditorUtility.IsPersistent(data.Root) && Pose(data).Count > 0;

        /// <summary>Turns the bones; Undo turns them back.</summary>
        internal static void Stand(AvatarData data)
        {
            foreach (KeyValuePair<Transform, Quaternion> turn in Pose(data))
            {
                Undo.RecordObject(turn.Key, Strings.Get("fix_pose"));
                turn.Key.localRotation = turn.Value;
            }
        }

        static Dictionary<Transform, Quaternion> Pose(AvatarData data)
        {
            var byName = new Dictionary<string, SkeletonBone>();
            foreach (SkeletonBone bone in data.Animator.avatar.humanDescription.skeleton ?? new SkeletonBone[0])
            {
                byName[bone.name] = bone;
            }
            var pose = new Dictionary<Transform, Quaternion>();
            foreach (int joint in data.Roles)
            {
                if (joint >= 0 && byName.TryGetValue(data.Joints[joint].name, out SkeletonBone bone)) pose[data.Joints[joint]] = bone.rotation;
            }
            return pose;
        }
    }
}
