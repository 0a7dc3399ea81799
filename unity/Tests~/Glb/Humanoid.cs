// Humanoid avatars of loaded hierarchies, and what is known about the roles of the test models.
using System;
using System.Collections.Generic;
using System.IO;
using UnityEngine;

namespace SuperDeform.Tests.Glb
{
    public static class Humanoid
    {
        /// Unity's human name of a role: "leftUpperLeg" is "LeftUpperLeg", "leftIndexProximal" "Left Index Proximal".
        /// `vrm1`: thumbs are called Metacarpal, Proximal, Distal; else Proximal, Intermediate, Distal as in Unity.
        public static string UnityName(string role, bool vrm1)
        {
            if (vrm1 && role.Contains("Thumb")) role = role.Replace("ThumbProximal", "ThumbIntermediate").Replace("ThumbMetacarpal", "ThumbProximal");
            int index = (int)(HumanBodyBones)Enum.Parse(typeof(HumanBodyBones), role, true);
            return HumanTrait.BoneName[index];
        }

        /// Adds an Animator with a humanoid Avatar whose pose is how the hierarchy stands now.
        public static Animator Give(GameObject root, IDictionary<string, Transform> roles)
        {
            List<SkeletonBone> skeleton = new List<SkeletonBone>();
            foreach (Transform at in root.GetComponentsInChildren<Transform>(true))
            {
                skeleton.Add(new SkeletonBone { name = at.name, position = at.localPosition, rotation = at.localRotation, scale = at.localScale });
            }
            List<HumanBone> human = new List<HumanBone>();
            foreach (KeyValuePair<string, Transform> pair in roles)
            {
                HumanBone bone = new HumanBone { humanName = pair.Key, boneName = pair.Value.name };
                bone.limit.useDefaultValues = true;
                human.Add(bone);
            }
            HumanDescription description = new HumanDescription { human = human.ToArray(), skeleton = skeleton.ToArray(), upperArmTwist = 0.5f, lowerArmTwist = 0.5f, upperLegTwist = 0.5f, lowerLegTwist = 0.5f, armStretch = 0.05f, legStretch = 0.05f };
            Avatar avatar = AvatarBuilder.BuildHumanAvatar(root, description);
            avatar.name = root.name + "Avatar";
            if (!avatar.isValid) throw new InvalidDataException("the humanoid of " + root.name + " is not valid: " + string.Join("; ", UnityStubs.Log.Of(LogType.Error).ToArray()));
            Animator animator = root.GetComponent<Animator>() ?? root.AddComponent<Animator>();
            animator.avatar = avatar;
            return animator;
        }
    }
}
