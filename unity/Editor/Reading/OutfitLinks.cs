using System;
using System.Collections.Generic;
using UnityEditor;
using UnityEngine;

namespace SuperDeform.Editor
{
    /// <summary>What a component says of an outfit: one of its joints stands for one of the avatar's, and those below likewise.</summary>
    internal sealed class OutfitLink
    {
        /// <summary>The outfit's, and the avatar's; never null.</summary>
        internal Transform From, To;

        /// <summary>
        /// What an outfit's joint is called to be the one of a name below the avatar's; null where it is that of no joint.
        /// </summary>
        internal Func<string, string> NameOf;

        /// <summary>False where From alone hangs from To.</summary>
        internal bool Recursive = true;
    }

    /// <summary>Reads the components by which build steps merge outfits: Modular Avatar's and VRCFury's.</summary>
    internal static class OutfitLinks
    {
        internal const string MergeArmature = "nadena.dev.modular_avatar.core.ModularAvatarMergeArmature";
        const string VrcFury = "VF.Model.VRCFury";

        /// <param name="bone">The transform that plays a role; null: none.</param>
        internal static List<OutfitLink> Of(GameObject root, Func<int, Transform> bone)
        {
            var links = new List<OutfitLink>();
            foreach (Component component in root.GetComponentsInChildren<Component>(true))
            {
                string type = component == null ? null : Serialized.TypeOf(component);
                if (type != MergeArmature && type != VrcFury) continue;
                using (var properties = new SerializedObject(component))
                {
                    OutfitLink link = type == MergeArmature ? OfModularAvatar(component, properties, root.transform) : OfVrcFury(properties, root.transform, bone);
                    if (link != null && link.From != null && link.To != null) links.Add(link);
                }
            }
            return links;
        }

        /// <summary>Children are mapped that are called prefix + name + suffix.</summary>
        static OutfitLink OfModularAvatar(Component component, SerializedObject properties, Transform root)
        {
            string prefix = Serialized.TextAt(properties, "prefix") ?? "", suffix = Serialized.TextAt(properties, "suffix") ?? "";
            Transform target = Serialized.TransformAt(properties, "mergeTarget.targetObject");
            string path = Serialized.TextAt(properties, "mergeTarget.referencePath");
            if (target == null && !string.IsNullOrEmpty(path)) target = path == "$$$AVATAR_ROOT$$$" ? root : root.Find(path);
            return new OutfitLink { From = component.transform, To = target, NameOf = name => Between(name, prefix, suffix) };
        }

        /// <summary>What stands between a prefix and a suffix; null where they do not fit.</summary>
        internal static string Between(string name, string prefix, string suffix)
        {
            bool fits = name.Length > prefix.Length + suffix.Length && name.StartsWith(prefix, StringComparison.Ordinal) && name.EndsWith(suffix, StringComparison.Ordinal);
            return fits ? name.Substring(prefix.Length, name.Length - prefix.Length - suffix.Length) : null;
        }

        /// <summary>Armature Link: what the outfit's first joint has in its name beyond the avatar's is left out of all names.</summary>
        static OutfitLink OfVrcFury(SerializedObject properties, Transform root, Func<int, Transform> bone)
        {
            // Its features are managed references; no other one has such a list.
            Transform from = Serialized.TransformAt(properties, "content.propBone");
            SerializedProperty targets = properties.FindProperty("content.linkTo");
            Transform to = null;
            for (int index = 0; targets != null && index < targets.arraySize && to == null; index++)
            {
                to = Target(properties, "content.linkTo.Array.data[" + index + "].", root, bone);
            }
            if (from == null || to == null) return null;
            string extra = Serialized.TextAt(properties, "content.removeBoneSuffix") ?? "";
            if (extra.Trim().Length == 0 && from.name != to.name && from.name.Contains(to.name)) extra = from.name.Replace(to.name, "");
            return new OutfitLink
            {
                From = from, To = to, Recursive = Serialized.BoolAt(properties, "content.recursive", false),
                NameOf = name => extra.Trim().Length == 0 ? name : name.Replace(extra, "")
            };
        }

        /// <summary>A bone, an object, or the avatar itself, and from there a path.</summary>
        static Transform Target(SerializedObject properties, string at, Transform root, Func<int, Transform> bone)
        {
            Transform target = root;
            if (Serialized.BoolAt(properties, at + "useBone", true)) target = bone(Serialized.IntAt(properties, at + "bone", 0));
            else if (Serialized.BoolAt(properties, at + "useObj", false)) target = Serialized.TransformAt(properties, at + "obj");
            string offset = Serialized.TextAt(properties, at + "offset");
            bool inside = target != null && target.IsChildOf(root);
            return !inside ? null : string.IsNullOrEmpty(offset) ? target : target.Find(offset);
        }
    }
}
