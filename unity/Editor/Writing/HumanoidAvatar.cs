using System;
using System.Collections.Generic;
using UnityEditor;
using UnityEngine;

namespace SuperDeform.Editor
{
    /// <summary>
    /// Builds the Avatar of the new proportions. With the old one, an Animator would put the old bone lengths back.
    /// </summary>
    internal static class HumanoidAvatar
    {
        /// <summary>
        /// Gives the new avatar's animator an Avatar like the source's, with moved bones; nothing where that has none.
        /// </summary>
        internal static void Rebuild(PointMap map, AvatarData source, AvatarResult result)
        {
            if (!HumanoidRoles.IsHumanoid(source.Animator)) return;
            HumanDescription description = source.Animator.avatar.humanDescription;
            List<int> joints = BodyJoints(source);
            var nodes = new List<AvatarNode>();
            foreach (int joint in joints)
            {
                nodes.Add(Node(joint, joints, source, result, description));
            }
            var names = new HashSet<string>(nodes.ConvertAll(node => node.Name));
            HumanBone[] human = Array.FindAll(description.human ?? new HumanBone[0], bone => names.Contains(bone.boneName));
            description.human = human.Length > 0 ? human : Human(source.Roles, joint => source.Joints[joint].name);
            Animator animator = map.CopyOf(source.Animator.transform).GetComponent<Animator>();
            Avatar old = source.Animator.avatar, made = Build(animator.name, nodes, description, source);
            made.name = old.name;
            animator.avatar = made;
            // An Animator that takes an Avatar may put its bones where that says; the pose that the avatar stands in stays.
            for (int joint = 0; joint < source.Joints.Length; joint++)
            {
                bool moved = !result.LocalShifts[joint].Equals(Vector3.zero);
                if (moved) map.CopyOf(source.Joints[joint]).localPosition = result.LocalPositions[joint];
            }
            map.Replace(old, made);
        }

        /// <summary>
        /// The joints that play roles, and what they hang from up to the animator; parents first.
        ///
        /// No others: clothes often bring joints of the same names, and the Avatar goes by names.
        /// </summary>
        static List<int> BodyJoints(AvatarData source)
        {
            var joints = new SortedDictionary<int, bool>();
            foreach (int role in source.Roles)
            {
                for (int joint = role; joint >= 0 && source.Joints[joint] != source.Animator.transform; joint = source.Parents[joint])
                {
                    joints[joint] = true;
                }
            }
            // Joints stand in the order of the hierarchy, so that rising numbers are parents first.
            return new List<int>(joints.Keys);
        }

        /// <summary>A joint as the old Avatar remembers it, moved.</summary>
        static AvatarNode Node(int joint, List<int> joints, AvatarData source, AvatarResult result, HumanDescription description)
        {
            Transform transform = source.Joints[joint];
            Vector3 shift = result.LocalShifts[joint];
            var node = new AvatarNode
            {
                Name = transform.name,
                Parent = joints.IndexOf(source.Parents[joint]),
                Position = result.LocalPositions[joint],
                Rotation = transform.localRotation,
                Scale = transform.localScale
            };
            SkeletonBone[] skeleton = description.skeleton ?? new SkeletonBone[0];
            int known = Array.FindIndex(skeleton, bone => bone.name == node.Name);
            if (known >= 0)
            {
                node.Position = skeleton[known].position + shift;
                node.Rotation = skeleton[known].rotation;
                node.Scale = skeleton[known].scale;
            }
            return node;
        }

        /// <summary>The roles as Unity's list of human bones.</summary>
        internal static HumanBone[] Human(int[] roles, Func<int, string> nameOf)
        {
            var human = new List<HumanBone>();
            for (int role = 0; role < roles.Length; role++)
            {
                if (roles[role] < 0) continue;
                human.Add(new HumanBone
                {
                    humanName = HumanTrait.BoneName[role],
                    boneName = nameOf(roles[role]),
                    limit = new HumanLimit { useDefaultValues = true }
                });
            }
            return human.ToArray();
        }

        /// <summary>An Avatar for a hierarchy of nodes.</summary>
        /// <param name="description">Its skeleton is that of the nodes afterwards.</param>
        /// <exception cref="ConversionException">Unity refuses it.</exception>
        internal static Avatar Build(string rootName, List<AvatarNode> nodes, HumanDescription description, AvatarData source)
        {
            var skeleton = new List<SkeletonBone>
            {
                new SkeletonBone { name = rootName, position = new Vector3(0, 0, 0), rotation = Quaternion.identity, scale = new Vector3(1, 1, 1) }
            };
            // Unity builds an Avatar for a hierarchy; this one holds nothing but the body, and belongs to no scene that would be saved.
            GameObject body = EditorUtility.CreateGameObjectWithHideFlags(rootName, HideFlags.HideAndDontSave);
            try
            {
                var transforms = new List<Transform>();
                foreach (AvatarNode node in nodes)
                {
                    Transform transform = EditorUtility.CreateGameObjectWithHideFlags(node.Name, HideFlags.HideAndDontSave).transform;
                    transform.SetParent(node.Parent < 0 ? body.transform : transforms[node.Parent], false);
                    transform.localPosition = node.Position;
                    transform.localRotation = node.Rotation;
                    transform.localScale = node.Scale;
                    transforms.Add(transform);
                    skeleton.Add(new SkeletonBone { name = node.Name, position = node.Position, rotation = node.Rotation, scale = node.Scale });
                }
                description.skeleton = skeleton.ToArray();
                Avatar avatar = AvatarBuilder.BuildHumanAvatar(body, description);
                if (avatar != null && avatar.isValid && avatar.isHuman) return avatar;
                if (avatar != null) UnityEngine.Object.DestroyImmediate(avatar);
                throw new ConversionException(new Finding("avatar_refused", Severity.Error, source.Root, source.Root.name));
            }
            finally
            {
                UnityEngine.Object.DestroyImmediate(body);
            }
        }
    }
}
