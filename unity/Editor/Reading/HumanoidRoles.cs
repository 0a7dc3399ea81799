using System;
using System.Collections.Generic;
using UnityEngine;

namespace SuperDeform.Editor
{
    /// <summary>Which transforms play which parts of a human body, as an Animator's Avatar says it.</summary>
    public static class HumanoidRoles
    {
        /// <summary>How many roles there are.</summary>
        public const int Count = 55;

        /// <summary>Roles without which nothing can be deformed.</summary>
        public static readonly HumanBodyBones[] Required =
        {
            HumanBodyBones.Hips, HumanBodyBones.Head, HumanBodyBones.LeftUpperLeg, HumanBodyBones.RightUpperLeg,
            HumanBodyBones.LeftUpperArm, HumanBodyBones.RightUpperArm
        };

        /// <summary>True where an animator has a humanoid Avatar that Unity can use.</summary>
        public static bool IsHumanoid(Animator animator) =>
            animator != null && animator.avatar != null && animator.avatar.isValid && animator.avatar.isHuman;

        /// <summary>
        /// The animator that speaks for an avatar: the root's own, else the only humanoid one below; null where there is none.
        /// </summary>
        public static Animator Speaker(GameObject root)
        {
            Animator own = root.GetComponent<Animator>();
            if (IsHumanoid(own)) return own;
            List<Animator> below = Bodies(root);
            return below.Count == 1 ? below[0] : own;
        }

        /// <summary>
        /// The humanoid animators of an object and below it whose bones move a mesh. One whose bones are gone, as a build leaves it
        /// on an outfit that it has merged, moves nothing and is none.
        /// </summary>
        internal static List<Animator> Bodies(GameObject root)
        {
            var moving = new HashSet<Transform>();
            foreach (Renderer renderer in root.GetComponentsInChildren<Renderer>(true))
            {
                SkinnedMeshRenderer skinned = renderer as SkinnedMeshRenderer;
                if (RendererReader.MeshOf(renderer) != null) moving.UnionWith(skinned == null ? new[] { renderer.transform } : skinned.bones);
            }
            Animator[] humanoids = Array.FindAll(root.GetComponentsInChildren<Animator>(true), IsHumanoid);
            return new List<Animator>(humanoids).FindAll(animator => Moves(animator, moving));
        }

        static bool Moves(Animator animator, HashSet<Transform> moving)
        {
            Transform hips = Of(animator)[(int)HumanBodyBones.Hips];
            return hips != null && Array.Exists(hips.GetComponentsInChildren<Transform>(true), moving.Contains);
        }

        /// <summary>
        /// By role, the transform that plays it, or null; all null where the animator has no humanoid Avatar.
        /// </summary>
        public static Transform[] Of(Animator animator)
        {
            Transform[] roles = new Transform[Count];
            if (!IsHumanoid(animator)) return roles;
            Dictionary<string, Transform> byName = ByName(animator);
            HumanBone[] human = animator.avatar.humanDescription.human ?? new HumanBone[0];
            for (int role = 0; role < Count; role++)
            {
                Transform known = animator.GetBoneTransform((HumanBodyBones)role);
                // An Animator goes on naming bones that a build has hung elsewhere.
                if (known != null && known.IsChildOf(animator.transform)) roles[role] = known;
                // Animators of prefabs and of inactive objects may not know their bones yet.
                if (roles[role] != null) continue;
                string humanName = HumanTrait.BoneName[role];
                foreach (HumanBone bone in human)
                {
                    if (bone.humanName == humanName && byName.TryGetValue(bone.boneName, out Transform named)) roles[role] = named;
                }
            }
            return roles;
        }

        /// <summary>
        /// Transforms below an animator by their names; of several the first that is not another humanoid's, as outfits are.
        /// </summary>
        static Dictionary<string, Transform> ByName(Animator animator)
        {
            Dictionary<string, Transform> own = new Dictionary<string, Transform>(), others = new Dictionary<string, Transform>();
            foreach (Transform transform in animator.GetComponentsInChildren<Transform>(true))
            {
                Animator[] above = transform.GetComponentsInParent<Animator>(true);
                Dictionary<string, Transform> byName = Array.Find(above, IsHumanoid) == animator ? own : others;
                if (!byName.ContainsKey(transform.name)) byName.Add(transform.name, transform);
            }
            foreach (KeyValuePair<string, Transform> other in others)
            {
                if (!own.ContainsKey(other.Key)) own.Add(other.Key, other.Value);
            }
            return own;
        }

        /// <summary>The first required role that no joint plays; null where all are there.</summary>
        /// <param name="has">Whether a joint plays a role.</param>
        public static HumanBodyBones? Missing(Func<int, bool> has)
        {
            foreach (HumanBodyBones role in Required)
            {
                if (!has((int)role)) return role;
            }
            return null;
        }
    }
}
