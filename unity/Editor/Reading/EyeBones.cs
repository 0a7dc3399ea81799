using UnityEditor;
using UnityEngine;

namespace SuperDeform.Editor
{
    /// <summary>Eye bones that the humanoid Avatar does not name, as components of avatars know them.</summary>
    internal static class EyeBones
    {
        /// <summary>Types of components, and where they hold the left and the right eye.</summary>
        static readonly string[][] Holders =
        {
            new[] { "VRCAvatarDescriptor", "customEyeLookSettings.leftEye", "customEyeLookSettings.rightEye" },
            new[] { "VRMLookAtBoneApplyer", "LeftEye.Transform", "RightEye.Transform" }
        };

        /// <summary>The roles with eyes in place of those that are not known.</summary>
        /// <param name="roles">By HumanBodyBones; stays as it is.</param>
        internal static int[] Added(AvatarData data, int[] roles)
        {
            if (roles[(int)HumanBodyBones.LeftEye] >= 0 || roles[(int)HumanBodyBones.RightEye] >= 0) return roles;
            foreach (MonoBehaviour holder in data.Root.GetComponentsInChildren<MonoBehaviour>(true))
            {
                // A script that is missing is null.
                if (holder == null) continue;
                string[] paths = System.Array.Find(Holders, known => known[0] == holder.GetType().Name);
                if (paths == null) continue;
                int left = JointAt(data, holder, paths[1]), right = JointAt(data, holder, paths[2]);
                bool free = System.Array.IndexOf(roles, left) < 0 && System.Array.IndexOf(roles, right) < 0;
                if (left < 0 || right < 0 || left == right || !free) continue;
                int[] added = (int[])roles.Clone();
                added[(int)HumanBodyBones.LeftEye] = left;
                added[(int)HumanBodyBones.RightEye] = right;
                return added;
            }
            return roles;
        }

        static int JointAt(AvatarData data, MonoBehaviour holder, string path)
        {
            SerializedProperty property = new SerializedObject(holder).FindProperty(path);
            return property == null ? -1 : data.IndexOf(property.objectReferenceValue as Transform);
        }
    }
}
