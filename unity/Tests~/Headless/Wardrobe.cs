using System;
using System.Collections.Generic;
using UnityEngine;

namespace SuperDeform.Editor.Tests
{
    /// <summary>Dresses an avatar as artists do: the outfit below its root, with a copy of its armature.</summary>
    internal static class Wardrobe
    {
        /// <summary>A coat: the body once more, one size larger, on the avatar's own armature.</summary>
        /// <param name="thick">How far it stands off the body, in the mesh's units.</param>
        internal static SkinnedMeshRenderer Coat(ConversionFigure figure, float thick)
        {
            SkinnedMeshRenderer coat = UnityEngine.Object.Instantiate(figure.Body, figure.Root.transform);
            coat.name = "Coat";
            coat.bones = figure.Body.bones;
            coat.rootBone = figure.Body.rootBone;
            Mesh mesh = UnityEngine.Object.Instantiate(figure.Body.sharedMesh);
            Vector3[] vertices = mesh.vertices, normals = mesh.normals;
            for (int i = 0; i < vertices.Length; i++) vertices[i] += normals[i] * thick;
            mesh.vertices = vertices;
            mesh.name = "CoatMesh";
            coat.sharedMesh = mesh;
            return coat;
        }

        /// <summary>A copy of an armature's joints alone, called otherwise, below Outfit/Armature.1.</summary>
        internal static Dictionary<Transform, Transform> Armature(GameObject root, Transform hips, Func<string, string> rename)
        {
            Transform outfit = new GameObject("Outfit").transform, armature = new GameObject("Armature.1").transform;
            outfit.SetParent(root.transform, false);
            armature.SetParent(outfit, false);
            var twins = new Dictionary<Transform, Transform>();
            Copy(hips, armature, rename, twins);
            return twins;
        }

        static void Copy(Transform joint, Transform parent, Func<string, string> rename, Dictionary<Transform, Transform> twins)
        {
            if (joint.GetComponent<Renderer>() != null) return;
            Transform twin = new GameObject(rename(joint.name)).transform;
            twin.SetParent(parent, false);
            twin.position = joint.position;
            twin.rotation = joint.rotation;
            twins[joint] = twin;
            foreach (Transform child in Children(joint)) Copy(child, twin, rename, twins);
        }

        static List<Transform> Children(Transform joint)
        {
            var children = new List<Transform>();
            for (int child = 0; child < joint.childCount; child++) children.Add(joint.GetChild(child));
            return children;
        }

        /// <summary>Binds a renderer's mesh to the twins, in the pose that it is bound in.</summary>
        internal static void Bind(SkinnedMeshRenderer cloth, Dictionary<Transform, Transform> twins)
        {
            Transform[] old = cloth.bones;
            Transform[] bones = Array.ConvertAll(old, bone => twins.ContainsKey(bone) ? twins[bone] : bone);
            Mesh mesh = UnityEngine.Object.Instantiate(cloth.sharedMesh);
            mesh.name = cloth.sharedMesh.name;
            Matrix4x4[] binds = mesh.bindposes;
            for (int bone = 0; bone < bones.Length; bone++) binds[bone] = bones[bone].worldToLocalMatrix * old[bone].localToWorldMatrix * binds[bone];
            mesh.bindposes = binds;
            cloth.sharedMesh = mesh;
            cloth.bones = bones;
            if (cloth.rootBone != null && twins.ContainsKey(cloth.rootBone)) cloth.rootBone = twins[cloth.rootBone];
        }

        /// <summary>Makes an outfit a humanoid of its own, as a model's importer does.</summary>
        /// <param name="twins">By bone, the outfit's; null: the bones themselves.</param>
        internal static void MakeHumanoid(GameObject outfit, Dictionary<HumanBodyBones, Transform> bones, Dictionary<Transform, Transform> twins)
        {
            var skeleton = new List<SkeletonBone>();
            foreach (Transform at in outfit.GetComponentsInChildren<Transform>(true))
            {
                skeleton.Add(new SkeletonBone { name = at.name, position = at.localPosition, rotation = at.localRotation, scale = at.localScale });
            }
            var human = new List<HumanBone>();
            foreach (KeyValuePair<HumanBodyBones, Transform> bone in bones)
            {
                human.Add(new HumanBone { humanName = HumanTrait.BoneName[(int)bone.Key], boneName = (twins == null ? bone.Value : twins[bone.Value]).name, limit = new HumanLimit { useDefaultValues = true } });
            }
            outfit.AddComponent<Animator>().avatar = AvatarBuilder.BuildHumanAvatar(outfit, new HumanDescription { human = human.ToArray(), skeleton = skeleton.ToArray() });
        }
    }
}
