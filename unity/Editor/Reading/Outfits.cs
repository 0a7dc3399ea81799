using System;
using System.Collections.Generic;
using UnityEditor;
using UnityEngine;

namespace SuperDeform.Editor
{
    /// <summary>
    /// Clothes and accessories that hang on the avatar by a build step only: outfits with an armature of their own, whose
    /// joints are twins of the avatar's, and objects that a component puts under a bone.
    /// </summary>
    /// <remarks>
    /// Twins are found as Modular Avatar's Merge Armature or VRCFury's Armature Link maps them where such a component is there, else
    /// by roles of the outfit's own humanoid Animator, else by name: prefix + name + suffix. An armature is judged as a whole: where
    /// most of it lies as the avatar's does, but for its size, all its joints are twins, wherever each lies.
    /// </remarks>
    internal static class Outfits
    {
        const string BoneProxy = "nadena.dev.modular_avatar.core.ModularAvatarBoneProxy";
        const string ParentConstraint = "UnityEngine.Animations.ParentConstraint";
        const string VrcParentConstraint = "VRC.SDK3.Dynamics.Constraint.Components.VRCParentConstraint";

        /// <summary>Fills in Twins and MergedParents.</summary>
        /// <param name="roles">By HumanBodyBones: the avatar's joint, or -1.</param>
        internal static void Find(AvatarData data, int[] roles)
        {
            int count = data.Joints.Length;
            data.Twins = new int[count];
            for (int joint = 0; joint < count; joint++)
            {
                data.Twins[joint] = joint;
            }
            data.MergedParents = (int[])data.Parents.Clone();
            if (HumanoidRoles.Missing(role => roles[role] >= 0) != null) return;
            var pairing = new Pairing(data, roles);
            List<OutfitLink> links = OutfitLinks.Of(data.Root, role => role >= 0 && role < HumanoidRoles.Count && roles[role] >= 0 ? data.Joints[roles[role]] : null);
            pairing.Linked(links);
            pairing.Animators();
            pairing.Names();
            for (int joint = 0; joint < count; joint++)
            {
                // A twin hangs from its base, at no distance; whatever else hangs from the twin goes with it.
                if (data.Twins[joint] != joint) data.MergedParents[joint] = data.Twins[joint];
            }
            pairing.Attached(links);
        }

        sealed class Pairing
        {
            readonly AvatarData data;
            readonly int[] roles;
            readonly bool[] ofBody, carries, linked;
            readonly ArmatureFit fit;

            internal Pairing(AvatarData data, int[] roles)
            {
                this.data = data;
                this.roles = roles;
                fit = new ArmatureFit(data, roles);
                ofBody = OfBody(data, roles);
                linked = new bool[data.Joints.Length];
                // Joints that move a mesh, and what those hang from; controls of a rig move none.
                carries = new bool[data.Joints.Length];
                foreach (RendererData renderer in data.Renderers)
                {
                    RendererReader.MarkUsed(renderer, carries);
                }
                for (int joint = carries.Length - 1; joint >= 0; joint--)
                {
                    if (carries[joint] && data.Parents[joint] >= 0) carries[data.Parents[joint]] = true;
                }
            }

            /// <summary>What components say, wherever it stands.</summary>
            internal void Linked(List<OutfitLink> links)
            {
                foreach (OutfitLink link in links)
                {
                    int from = data.IndexOf(link.From), to = data.IndexOf(link.To);
                    if (from < 0 || to < 0 && link.To != data.Root.transform || !link.Recursive) continue;
                    // The first object stands for its target, which is often no bone.
                    Pair(from, to);
                    linked[from] = true;
                    WalkLinked(link.From, link.To, link.NameOf);
                }
            }

            void WalkLinked(Transform outfit, Transform avatar, Func<string, string> nameOf)
            {
                for (int index = 0; index < outfit.childCount; index++)
                {
                    Transform child = outfit.GetChild(index);
                    int joint = data.IndexOf(child);
                    // An armature within has a target of its own; the body's joints are nobody's twins.
                    if (joint < 0 || ofBody[joint] || Has(child, OutfitLinks.MergeArmature)) continue;
                    linked[joint] = true;
                    string name = nameOf(child.name);
                    Transform twin = string.IsNullOrEmpty(name) ? null : avatar.Find(name);
                    if (twin != null && Pair(joint, data.IndexOf(twin))) WalkLinked(child, twin, nameOf);
                }
            }

            /// <summary>Outfits that are humanoids themselves, as many are sold: their Avatar names their bones.</summary>
            internal void Animators()
            {
                foreach (Animator animator in data.Root.GetComponentsInChildren<Animator>(true))
                {
                    if (animator == data.Animator || !HumanoidRoles.IsHumanoid(animator)) continue;
                    Transform[] own = HumanoidRoles.Of(animator);
                    var pairs = new List<KeyValuePair<int, int>>();
                    for (int role = 0; role < own.Length; role++)
                    {
                        int joint = data.IndexOf(own[role]);
                        if (joint >= 0 && roles[role] >= 0 && IsFree(joint)) pairs.Add(new KeyValuePair<int, int>(joint, roles[role]));
                    }
                    if (fit.Lies(pairs)) PairAll(pairs);
                }
            }

            /// <summary>Joints that are called like the avatar's, armature by armature, and what hangs from twins.</summary>
            internal void Names()
            {
                foreach (List<KeyValuePair<int, int>> armature in NamedArmatures.Of(data, roles, joint => carries[joint] && IsFree(joint)))
                {
                    if (fit.Lies(armature)) PairAll(armature);
                }
                for (int joint = 0; joint < data.Joints.Length; joint++)
                {
                    // What a component says of an armature is all that a build merges of it.
                    if (data.Twins[joint] != joint && !linked[joint]) WalkNames(joint);
                }
            }

            /// <summary>Pairs the children of a twin that are called as the avatar's joint's are, such as a twist bone's or a toe's.</summary>
            void WalkNames(int joint)
            {
                Transform outfit = data.Joints[joint], avatar = data.Joints[data.Twins[joint]];
                int at = outfit.name.IndexOf(avatar.name, StringComparison.Ordinal);
                string prefix = at < 0 ? "" : outfit.name.Substring(0, at), suffix = at < 0 ? "" : outfit.name.Substring(at + avatar.name.Length);
                for (int index = 0; index < outfit.childCount; index++)
                {
                    int child = data.IndexOf(outfit.GetChild(index));
                    string name = child < 0 || !IsFree(child) ? null : OutfitLinks.Between(data.Joints[child].name, prefix, suffix);
                    Transform twin = name == null ? null : avatar.Find(name);
                    if (twin != null) Pair(child, data.IndexOf(twin));
                }
            }

            bool IsFree(int joint) => !ofBody[joint] && !linked[joint] && data.Twins[joint] == joint;

            void PairAll(List<KeyValuePair<int, int>> pairs)
            {
                foreach (KeyValuePair<int, int> pair in pairs)
                {
                    Pair(pair.Key, pair.Value);
                }
            }

            /// <summary>True where they are paired, now or before.</summary>
            bool Pair(int joint, int twin)
            {
                if (twin >= 0 && !ofBody[joint] && ofBody[twin] && data.Twins[joint] == joint) data.Twins[joint] = twin;
                return data.Twins[joint] == twin && twin != joint;
            }

            /// <summary>Objects that a component carries along with a bone hang from that bone.</summary>
            internal void Attached(List<OutfitLink> links)
            {
                foreach (OutfitLink link in links)
                {
                    if (!link.Recursive) Attach(data.IndexOf(link.From), data.IndexOf(link.To));
                }
                foreach (Component component in data.Root.GetComponentsInChildren<Component>(true))
                {
                    if (component != null) Attach(data.IndexOf(component.transform), Bone(component));
                }
            }

            void Attach(int joint, int bone)
            {
                if (joint < 0 || bone < 0 || ofBody[joint] || data.Twins[joint] != joint || IsBelow(bone, joint)) return;
                data.MergedParents[joint] = bone;
            }

            /// <summary>The joint that a component puts its object under; -1: none.</summary>
            int Bone(Component component)
            {
                string type = Serialized.TypeOf(component);
                if (type != BoneProxy && type != ParentConstraint && type != VrcParentConstraint) return -1;
                using (var properties = new SerializedObject(component))
                {
                    if (type == ParentConstraint) return data.IndexOf(Serialized.TransformAt(properties, "m_Sources.Array.data[0].sourceTransform"));
                    if (type == VrcParentConstraint) return data.IndexOf(Serialized.TransformAt(properties, "Sources.source0.SourceTransform"));
                    int role = Serialized.IntAt(properties, "boneReference", HumanoidRoles.Count);
                    if (role < 0 || role >= HumanoidRoles.Count || roles[role] < 0) return -1;
                    string path = Serialized.TextAt(properties, "subPath");
                    Transform bone = data.Joints[roles[role]];
                    return data.IndexOf(string.IsNullOrEmpty(path) ? bone : bone.Find(path) ?? bone);
                }
            }

            bool IsBelow(int joint, int ancestor)
            {
                int steps = 0;
                for (; joint >= 0 && steps <= data.Joints.Length; joint = data.MergedParents[joint], steps++)
                {
                    if (joint == ancestor) return true;
                }
                return false;
            }

            static bool Has(Transform transform, string type) =>
                Array.Exists(transform.GetComponents<Component>(), component => component != null && Serialized.TypeOf(component) == type);
        }

        /// <summary>By joint, whether it is the body's: one with a role, what hangs from those, and what they hang from.</summary>
        internal static bool[] OfBody(AvatarData data, int[] roles)
        {
            bool[] ofBody = new bool[data.Joints.Length];
            for (int joint = 0; joint < ofBody.Length; joint++)
            {
                ofBody[joint] = Array.IndexOf(roles, joint) >= 0 || data.Parents[joint] >= 0 && ofBody[data.Parents[joint]];
            }
            for (int joint = roles[(int)HumanBodyBones.Hips]; joint >= 0; joint = data.Parents[joint])
            {
                ofBody[joint] = true;
            }
            return ofBody;
        }
    }
}
