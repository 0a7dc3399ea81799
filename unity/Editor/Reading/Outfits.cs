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
    /// Twins are found as Modular Avatar's Merge Armature maps them where that component is there, else by roles of the
    /// outfit's own humanoid Animator, else by name and place: prefix + name + suffix, at the same place.
    /// </remarks>
    internal static class Outfits
    {
        const string MergeArmature = "nadena.dev.modular_avatar.core.ModularAvatarMergeArmature";
        const string BoneProxy = "nadena.dev.modular_avatar.core.ModularAvatarBoneProxy";
        const string ParentConstraint = "UnityEngine.Animations.ParentConstraint";
        const string VrcParentConstraint = "VRC.SDK3.Dynamics.Constraint.Components.VRCParentConstraint";

        /// <summary>
        /// "The same place", as a share of the way from hips to head: 3 cm on a grown-up, about what garments made for one
        /// body differ by. Other joints of the same name are farther away.
        /// </summary>
        const double SamePlace = 0.05;

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
            Pairing pairing = new Pairing(data, roles);
            pairing.MergeArmatures();
            pairing.Animators();
            pairing.Names();
            for (int joint = 0; joint < count; joint++)
            {
                // A twin hangs from its base, at no distance; whatever else hangs from the twin goes with it.
                if (data.Twins[joint] != joint) data.MergedParents[joint] = data.Twins[joint];
            }
            pairing.Attached();
        }

        sealed class Pairing
        {
            readonly AvatarData data;
            readonly int[] roles;
            readonly bool[] ofBody, carries;
            readonly double near;

            internal Pairing(AvatarData data, int[] roles)
            {
                this.data = data;
                this.roles = roles;
                int hips = roles[(int)HumanBodyBones.Hips];
                near = SamePlace * (Place(roles[(int)HumanBodyBones.Head]) - Place(hips)).Length;
                // The body: joints with roles, what hangs from them, and what they hang from.
                ofBody = new bool[data.Joints.Length];
                for (int joint = 0; joint < ofBody.Length; joint++)
                {
                    ofBody[joint] = Array.IndexOf(roles, joint) >= 0 || data.Parents[joint] >= 0 && ofBody[data.Parents[joint]];
                }
                for (int joint = hips; joint >= 0; joint = data.Parents[joint])
                {
                    ofBody[joint] = true;
                }
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

            Double3 Place(int joint)
            {
                return data.Rest[joint].Position;
            }

            bool IsNear(int one, int other)
            {
                return (Place(one) - Place(other)).Length <= near;
            }

            /// <summary>What Modular Avatar will merge, wherever it stands: its own rule.</summary>
            internal void MergeArmatures()
            {
                foreach (Component component in All(MergeArmature))
                {
                    using (SerializedObject properties = new SerializedObject(component))
                    {
                        Transform target = Target(properties);
                        int from = data.IndexOf(component.transform), to = data.IndexOf(target);
                        if (from < 0 || target == null || to < 0 && target != data.Root.transform) continue;
                        string prefix = Serialized.TextAt(properties, "prefix") ?? "", suffix = Serialized.TextAt(properties, "suffix") ?? "";
                        // The component's own object stands for the target, which is often no bone.
                        if (to >= 0 && ofBody[to]) data.Twins[from] = to;
                        Walk(component.transform, target, prefix, suffix, false);
                    }
                }
            }

            Transform Target(SerializedObject properties)
            {
                Transform direct = Serialized.TransformAt(properties, "mergeTarget.targetObject");
                if (direct != null) return direct;
                string path = Serialized.TextAt(properties, "mergeTarget.referencePath");
                if (string.IsNullOrEmpty(path)) return null;
                return path == "$$$AVATAR_ROOT$$$" ? data.Root.transform : data.Root.transform.Find(path);
            }

            /// <summary>Outfits that are humanoids themselves, as many are sold: their Avatar names their bones.</summary>
            internal void Animators()
            {
                foreach (Animator animator in data.Root.GetComponentsInChildren<Animator>(true))
                {
                    if (animator == data.Animator || !HumanoidRoles.IsHumanoid(animator)) continue;
                    Transform[] own = HumanoidRoles.Of(animator);
                    for (int role = 0; role < own.Length; role++)
                    {
                        int joint = data.IndexOf(own[role]);
                        if (joint >= 0 && roles[role] >= 0) Pair(joint, roles[role], true);
                    }
                }
            }

            /// <summary>Joints that are called like the avatar's and lie where those lie, and what hangs from them.</summary>
            internal void Names()
            {
                for (int joint = 0; joint < data.Joints.Length; joint++)
                {
                    if (ofBody[joint] || !carries[joint]) continue;
                    int twin = data.Twins[joint];
                    if (twin == joint) twin = Namesake(joint);
                    if (twin < 0) continue;
                    string name = data.Joints[joint].name, of = data.Joints[twin].name;
                    int at = name.IndexOf(of, StringComparison.Ordinal);
                    Pair(joint, twin, true);
                    if (at < 0) Walk(data.Joints[joint], data.Joints[twin], "", "", true);
                    else Walk(data.Joints[joint], data.Joints[twin], name.Substring(0, at), name.Substring(at + of.Length), true);
                }
            }

            /// <summary>The joint with a role whose name is in this one's, at its place; -1: none.</summary>
            int Namesake(int joint)
            {
                int best = -1;
                foreach (int role in roles)
                {
                    if (role < 0 || !IsNear(joint, role) || data.Joints[joint].name.IndexOf(data.Joints[role].name, StringComparison.Ordinal) < 0) continue;
                    if (best < 0 || data.Joints[role].name.Length > data.Joints[best].name.Length) best = role;
                }
                return best;
            }

            /// <summary>Pairs children with children, down both hierarchies.</summary>
            void Walk(Transform outfit, Transform avatar, string prefix, string suffix, bool placed)
            {
                for (int index = 0; index < outfit.childCount; index++)
                {
                    Transform child = outfit.GetChild(index);
                    int joint = data.IndexOf(child);
                    // An armature within has a target of its own; the body's joints are nobody's twins.
                    if (joint < 0 || ofBody[joint] || Has(child, MergeArmature)) continue;
                    string name = child.name;
                    bool fits = name.Length > prefix.Length + suffix.Length && name.StartsWith(prefix, StringComparison.Ordinal)
                        && name.EndsWith(suffix, StringComparison.Ordinal);
                    if (!fits) continue;
                    Transform twin = avatar.Find(name.Substring(prefix.Length, name.Length - prefix.Length - suffix.Length));
                    if (twin != null && Pair(joint, data.IndexOf(twin), placed)) Walk(child, twin, prefix, suffix, placed);
                }
            }

            /// <summary>True where they are paired, now or before.</summary>
            bool Pair(int joint, int twin, bool placed)
            {
                if (twin < 0 || ofBody[joint] || !ofBody[twin] || placed && !IsNear(joint, twin)) return data.Twins[joint] == twin && twin != joint;
                if (data.Twins[joint] == joint) data.Twins[joint] = twin;
                return data.Twins[joint] == twin;
            }

            /// <summary>Objects that a component carries along with a bone hang from that bone.</summary>
            internal void Attached()
            {
                foreach (Component component in data.Root.GetComponentsInChildren<Component>(true))
                {
                    if (component == null) continue;
                    int joint = data.IndexOf(component.transform), bone = Bone(component);
                    if (joint < 0 || bone < 0 || ofBody[joint] || data.Twins[joint] != joint || IsBelow(bone, joint)) continue;
                    data.MergedParents[joint] = bone;
                }
            }

            /// <summary>The joint that a component puts its object under; -1: none.</summary>
            int Bone(Component component)
            {
                string type = Serialized.TypeOf(component);
                if (type != BoneProxy && type != ParentConstraint && type != VrcParentConstraint) return -1;
                using (SerializedObject properties = new SerializedObject(component))
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

            List<Component> All(string type)
            {
                List<Component> found = new List<Component>();
                foreach (Component component in data.Root.GetComponentsInChildren<Component>(true))
                {
                    if (component != null && Serialized.TypeOf(component) == type) found.Add(component);
                }
                return found;
            }

            static bool Has(Transform transform, string type)
            {
                return Array.Exists(transform.GetComponents<Component>(), component => component != null && Serialized.TypeOf(component) == type);
            }
        }
    }
}
