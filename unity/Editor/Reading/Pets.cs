using System;
using UnityEngine;

namespace SuperDeform.Editor
{
    /// <summary>Humanoids within an avatar that are neither itself nor its clothes.</summary>
    internal static class Pets
    {
        /// <summary>Fills in PetOf; after Outfits.Find.</summary>
        internal static void Find(AvatarData data)
        {
            data.PetOf = new int[data.Joints.Length];
            for (int joint = 0; joint < data.PetOf.Length; joint++)
            {
                data.PetOf[joint] = -1;
            }
            foreach (Animator animator in HumanoidRoles.Bodies(data.Root))
            {
                int holder = data.IndexOf(animator.transform);
                if (animator == data.Animator || holder < 0 || data.Root.transform.IsChildOf(animator.transform)) continue;
                Transform[] bones = Array.FindAll(HumanoidRoles.Of(animator), bone => bone != null);
                if (Array.Exists(bones, bone => data.Twins[data.IndexOf(bone)] != data.IndexOf(bone) || Array.IndexOf(data.Roles, data.IndexOf(bone)) >= 0)) continue;
                for (int joint = 0; joint < data.Joints.Length; joint++)
                {
                    if (data.PetOf[joint] < 0 && data.Joints[joint].IsChildOf(animator.transform)) data.PetOf[joint] = holder;
                }
            }
        }

        /// <summary>Whether a pet's joints alone move a mesh; before Place or after.</summary>
        internal static bool Moves(AvatarData data, RendererData renderer)
        {
            bool[] used = new bool[data.Joints.Length];
            RendererReader.MarkUsed(renderer, used);
            bool any = false;
            for (int joint = 0; joint < used.Length; joint++)
            {
                if (used[joint] && data.PetOf[joint] < 0) return false;
                any |= used[joint];
            }
            return any;
        }
    }
}
