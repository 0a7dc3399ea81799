// Modular Avatar's components by their serialized fields, and what a build makes of them; read in the source of
// github.com/bdunderscore/modular-avatar 1.18 (Runtime/*.cs, Editor/MergeArmatureHook.cs, MeshRetargeter.cs, ScaleAdjusterPass.cs,
// BoneProxyProcessor.cs): an outfit's bones hang from the avatar's and most are gone, its own Animator stays.
using System;
using System.Collections.Generic;
using nadena.dev.ndmf;
using UnityEditor;
using UnityEngine;
using VRC.SDK3.Dynamics.PhysBone.Components;

namespace nadena.dev.modular_avatar.core
{
    [Serializable]
    public class AvatarObjectReference
    {
        public string referencePath = "";
        public GameObject targetObject;
    }

    public class AvatarTagComponent : MonoBehaviour { }

    public class ModularAvatarMergeArmature : AvatarTagComponent
    {
        public AvatarObjectReference mergeTarget = new AvatarObjectReference();
        public string prefix = "", suffix = "";
        public bool mangleNames = true;
    }

    public class ModularAvatarBoneProxy : AvatarTagComponent
    {
        public HumanBodyBones boneReference = HumanBodyBones.LastBone;
        public string subPath = "";
        public int attachmentMode;
    }

    public class ModularAvatarScaleAdjuster : AvatarTagComponent
    {
        [SerializeField] internal Vector3 m_Scale = Vector3.one;
    }

    public class ModularAvatarPBBlocker : AvatarTagComponent { }

    /// <summary>What stands before this package's pass in a build.</summary>
    public static class ModularAvatarStub
    {
        public static void Process(BuildContext context)
        {
            GameObject avatar = context.AvatarRootObject;
            AdjustScales(avatar);
            var merged = new HashSet<Transform>();
            foreach (var config in avatar.GetComponentsInChildren<ModularAvatarMergeArmature>(true))
            {
                GameObject target = config.mergeTarget.targetObject ?? Found(avatar, config.mergeTarget.referencePath);
                if (target != null) Merge(config, config.transform, target.transform, true, merged);
            }
            foreach (var config in avatar.GetComponentsInChildren<ModularAvatarMergeArmature>(true)) UnityEngine.Object.DestroyImmediate(config);
            Retain(avatar, merged);
            foreach (var renderer in avatar.GetComponentsInChildren<SkinnedMeshRenderer>(true)) Retarget(renderer, merged);
            Remove(merged);
            Attach(avatar);
        }

        static GameObject Found(GameObject avatar, string path)
        {
            Transform found = string.IsNullOrEmpty(path) ? null : path == "$$$AVATAR_ROOT$$$" ? avatar.transform : avatar.transform.Find(path);
            return found == null ? null : found.gameObject;
        }

        /// <summary>A scaled joint moves its meshes through a child; what hangs from it stays.</summary>
        static void AdjustScales(GameObject avatar)
        {
            var proxies = new Dictionary<Transform, Transform>();
            foreach (var adjuster in avatar.GetComponentsInChildren<ModularAvatarScaleAdjuster>(true))
            {
                Transform proxy = new GameObject("ScaleProxy").transform;
                proxy.SetParent(adjuster.transform, false);
                proxy.localScale = adjuster.m_Scale;
                proxies.Add(adjuster.transform, proxy);
                UnityEngine.Object.DestroyImmediate(adjuster);
            }
            foreach (var renderer in avatar.GetComponentsInChildren<SkinnedMeshRenderer>(true))
            {
                renderer.bones = Array.ConvertAll(renderer.bones, bone => bone != null && proxies.ContainsKey(bone) ? proxies[bone] : bone);
            }
        }

        static void Merge(ModularAvatarMergeArmature config, Transform source, Transform target, bool zip, HashSet<Transform> merged)
        {
            if (PrefabUtility.IsPartOfAnyPrefab(source)) throw new Exception("Cannot merge prefab instances or prefab assets");
            source.SetParent(target, true);
            if (config.mangleNames) source.name += "$" + Guid.NewGuid();
            if (source.GetComponent<ModularAvatarPBBlocker>() == null) source.gameObject.AddComponent<ModularAvatarPBBlocker>();
            if (!zip) return;
            // What swings or is constrained by itself is no duplicate, and what hangs from it stays below it.
            if (Array.Exists(source.GetComponents<Component>(), component => component.GetType().Name.EndsWith("Constraint"))) return;
            VRCPhysBone own = ChainOf(source);
            if (own == null || IsSimilar(source, target, own.ignoreTransforms)) merged.Add(source);
            foreach (Transform child in ChildrenOf(source))
            {
                if (child.GetComponent<ModularAvatarMergeArmature>() != null) continue;
                if (own != null && !merged.Contains(source) && !own.ignoreTransforms.Contains(child)) continue;
                string name = child.name, prefix = config.prefix, suffix = config.suffix;
                bool fits = name.StartsWith(prefix) && name.EndsWith(suffix) && name.Length > prefix.Length + suffix.Length;
                Transform twin = fits ? target.Find(name.Substring(prefix.Length, name.Length - prefix.Length - suffix.Length)) : null;
                Merge(config, child, twin ?? source, twin != null, merged);
            }
        }

        static List<Transform> ChildrenOf(Transform parent)
        {
            var children = new List<Transform>();
            foreach (Transform child in parent) children.Add(child);
            return children;
        }

        /// <summary>The PhysBone whose chain begins at a bone.</summary>
        static VRCPhysBone ChainOf(Transform bone)
        {
            return Array.Find(bone.root.GetComponentsInChildren<VRCPhysBone>(true), one => (one.rootTransform ?? one.transform) == bone);
        }

        /// <summary>Whether a chain lies within 1 mm of the target's, as far as the names are the same.</summary>
        static bool IsSimilar(Transform bone, Transform target, List<Transform> left)
        {
            if ((bone.position - target.position).sqrMagnitude > 1e-6f) return false;
            return ChildrenOf(bone).TrueForAll(child => left.Contains(child) || target.Find(child.name) == null || IsSimilar(child, target.Find(child.name), left));
        }

        /// <summary>What PhysBones, colliders, contacts and constraints name or are on stays, and root bones that lie elsewhere.</summary>
        static void Retain(GameObject avatar, HashSet<Transform> merged)
        {
            foreach (var renderer in avatar.GetComponentsInChildren<SkinnedMeshRenderer>(true))
            {
                Transform root = renderer.rootBone;
                if (root == null || root.parent == null) continue;
                bool elsewhere = (root.parent.position - root.position).sqrMagnitude > 1e-6f;
                if (elsewhere || Vector3.Dot(root.parent.localScale.normalized, root.localScale.normalized) < 0.9999f) merged.Remove(root);
            }
            foreach (Component component in avatar.GetComponentsInChildren<Component>(true))
            {
                string type = component == null ? "" : component.GetType().Name;
                if (!type.StartsWith("VRC") && !type.EndsWith("Constraint")) continue;
                // Those of dynamics get their own object for their root where they have none.
                if (type.StartsWith("VRCPhysBone") || type.StartsWith("VRCContact")) merged.Remove(component.transform);
                using (var properties = new SerializedObject(component))
                {
                    SerializedProperty property = properties.GetIterator();
                    while (property.Next(property.propertyPath.Length == 0 || property.propertyType != SerializedPropertyType.String))
                    {
                        if (property.propertyType == SerializedPropertyType.ObjectReference && property.name != "m_GameObject")
                        {
                            var named = property.objectReferenceValue as Transform;
                            var other = property.objectReferenceValue as GameObject;
                            if (other != null) named = other.transform;
                            if (named != null) merged.Remove(named);
                        }
                    }
                }
            }
        }

        static Transform Kept(Transform bone, HashSet<Transform> merged)
        {
            while (bone != null && merged.Contains(bone)) bone = bone.parent;
            return bone;
        }

        static void Retarget(SkinnedMeshRenderer renderer, HashSet<Transform> merged)
        {
            Transform[] bones = renderer.bones;
            if (!Array.Exists(bones, bone => bone != null && merged.Contains(bone)) && !merged.Contains(renderer.rootBone)) return;
            Mesh mesh = UnityEngine.Object.Instantiate(renderer.sharedMesh);
            mesh.name = "RETARGETED__" + renderer.sharedMesh.name;
            ObjectRegistry.RegisterReplacedObject(renderer.sharedMesh, mesh);
            Matrix4x4[] binds = mesh.bindposes;
            for (int i = 0; i < bones.Length && i < binds.Length; i++)
            {
                Transform kept = Kept(bones[i], merged);
                if (kept == null || kept == bones[i]) continue;
                binds[i] = kept.worldToLocalMatrix * bones[i].localToWorldMatrix * binds[i];
                bones[i] = kept;
            }
            mesh.bindposes = binds;
            renderer.bones = bones;
            renderer.sharedMesh = mesh;
            Transform scale = renderer.rootBone ?? renderer.transform, rootBone = Kept(renderer.rootBone, merged) ?? renderer.transform;
            Vector3 was = scale.lossyScale, now = rootBone.lossyScale;
            Bounds bounds = renderer.localBounds;
            bounds.extents = new Vector3(bounds.extents.x * was.x / now.x, bounds.extents.y * was.y / now.y, bounds.extents.z * was.z / now.z);
            bounds.center = rootBone.InverseTransformPoint(scale.TransformPoint(bounds.center));
            renderer.localBounds = bounds;
            renderer.rootBone = rootBone;
        }

        static void Remove(HashSet<Transform> merged)
        {
            foreach (Transform bone in merged)
            {
                if (Array.Exists(bone.GetComponents<Component>(), component => !(component is Transform) && !(component is AvatarTagComponent)))
                {
                    continue;
                }
                Transform above = Kept(bone, merged);
                foreach (Transform child in ChildrenOf(bone)) child.SetParent(above, true);
                UnityEngine.Object.DestroyImmediate(bone.gameObject);
            }
        }

        static void Attach(GameObject avatar)
        {
            Animator animator = avatar.GetComponent<Animator>();
            foreach (var proxy in avatar.GetComponentsInChildren<ModularAvatarBoneProxy>(true))
            {
                Transform bone = animator.GetBoneTransform(proxy.boneReference);
                if (bone != null) proxy.transform.SetParent(string.IsNullOrEmpty(proxy.subPath) ? bone : bone.Find(proxy.subPath) ?? bone, true);
                UnityEngine.Object.DestroyImmediate(proxy);
            }
        }
    }
}
