using System;
using System.Collections.Generic;
using UnityEngine;

namespace SuperDeform.Editor
{
    /// <summary>What is to be known of clothes, and of what else hangs on an avatar with bones of its own.</summary>
    internal static class OutfitChecks
    {
        /// <summary>More names of joints than these are counted.</summary>
        const int Named = 4;

        /// <param name="data">With Twins and MergedParents.</param>
        /// <param name="roles">By HumanBodyBones: the avatar's joint, or -1.</param>
        internal static void Check(AvatarData data, int[] roles, List<Finding> findings)
        {
            Pets.Find(data);
            List<Animator> humanoids = HumanoidRoles.Bodies(data.Root);
            humanoids.Remove(data.Animator);
            foreach (Animator animator in humanoids)
            {
                int holder = data.IndexOf(animator.transform);
                if (holder >= 0 && data.PetOf[holder] == holder) findings.Add(new Finding("pet", Severity.Warning, animator, animator.name, data.Root.name));
            }
            bool[] ofBody = Outfits.OfBody(data, roles), moving = MovingSkins(data);
            var left = new Dictionary<Transform, List<int>>();
            var paired = new HashSet<Transform>();
            for (int joint = 0; joint < data.Joints.Length; joint++)
            {
                if (ofBody[joint] || data.PetOf[joint] >= 0) continue;
                if (data.Twins[joint] != joint) paired.Add(Holder(data, joint, ofBody));
                else if (moving[joint] && !GoesWithBody(data, joint, ofBody)) ListOf(left, Holder(data, joint, ofBody)).Add(joint);
            }
            foreach (Transform holder in paired)
            {
                Animator own = humanoids.Find(animator => animator.transform == holder || animator.transform.IsChildOf(holder));
                if (own != null && !left.ContainsKey(holder)) findings.Add(new Finding("outfit", Severity.Info, own, own.name, data.Root.name));
            }
            foreach (KeyValuePair<Transform, List<int>> pair in left)
            {
                Transform holder = pair.Key;
                if (paired.Contains(holder)) findings.Add(new Finding("outfit_partly", Severity.Warning, holder, holder.name, data.Root.name, Names(data, pair.Value)));
                else findings.Add(new Finding("own_bones", Severity.Warning, holder, holder.name, data.Root.name, Names(data, pair.Value)));
            }
        }

        /// <summary>By joint, whether it moves vertices of a skinned mesh.</summary>
        static bool[] MovingSkins(AvatarData data)
        {
            bool[] moving = new bool[data.Joints.Length];
            foreach (RendererData renderer in data.Renderers)
            {
                if (renderer.Skin != null) RendererReader.MarkUsed(renderer, moving);
            }
            return moving;
        }

        /// <summary>The object that holds an outfit: the highest above a joint that is not the body's.</summary>
        static Transform Holder(AvatarData data, int joint, bool[] ofBody)
        {
            while (data.Parents[joint] >= 0 && !ofBody[data.Parents[joint]])
            {
                joint = data.Parents[joint];
            }
            return data.Joints[joint];
        }

        static bool GoesWithBody(AvatarData data, int joint, bool[] ofBody)
        {
            int steps = 0;
            for (; joint >= 0 && steps <= data.Joints.Length; joint = data.MergedParents[joint], steps++)
            {
                if (ofBody[joint]) return true;
            }
            return false;
        }

        static List<int> ListOf(Dictionary<Transform, List<int>> lists, Transform holder)
        {
            if (!lists.TryGetValue(holder, out List<int> list)) lists.Add(holder, list = new List<int>());
            return list;
        }

        static string Names(AvatarData data, List<int> joints)
        {
            List<string> names = joints.ConvertAll(joint => data.Joints[joint].name);
            string first = string.Join(", ", names.GetRange(0, Math.Min(Named, names.Count)).ToArray());
            return names.Count <= Named ? first : Strings.Get("names_more", first, names.Count - Named);
        }
    }
}
