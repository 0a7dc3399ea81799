using System;
using System.Collections.Generic;
using UnityEngine;

namespace SuperDeform.Editor
{
    /// <summary>
    /// Gives an avatar that came without bones the rig that the library has made: transforms, weights, an Animator with an
    /// Avatar.
    /// </summary>
    internal static class MadeRig
    {
        /// <summary>What most platforms read of a vertex.</summary>
        const int Influences = 4;

        /// <summary>The object that holds the bones.</summary>
        const string Holder = "Armature";

        internal static void Add(GameObject copy, PointMap map, AvatarData source, AvatarResult result)
        {
            Joints joints = source.Character.GetJoints();
            HumanoidRole[] roles = joints.Roles;
            Transform[] bones = AddBones(copy.transform, joints, roles, result.JointPositions);
            foreach (RendererResult renderer in result.Renderers)
            {
                Mesh mesh = map.MeshFor(renderer.Source.Renderer);
                Weigh(mesh, renderer, source, result.JointPositions);
                Show(mesh, map.CopyOf(renderer.Source.Renderer.transform), bones, roles, renderer, result.JointPositions);
            }
            AddAvatar(copy, map, source, joints, roles, result.JointPositions);
        }

        static string NameOf(HumanoidRole[] roles, int joint) => roles[joint] == HumanoidRole.None ? "Bone" + joint : roles[joint].ToString();

        internal static Double3 Place(double[] positions, int joint) =>
            new Double3(positions[3 * joint], positions[3 * joint + 1], positions[3 * joint + 2]);

        /// <summary>Where a joint is in its parent's space; made joints neither turn nor scale.</summary>
        static Vector3 Local(Joints joints, double[] positions, int joint)
        {
            int parent = joints.Parents[joint];
            Double3 place = Place(positions, joint);
            return (parent < 0 ? place : place - Place(positions, parent)).ToVector3();
        }

        static Transform[] AddBones(Transform root, Joints joints, HumanoidRole[] roles, double[] positions)
        {
            Transform holder = new GameObject(Holder).transform;
            holder.SetParent(root, false);
            Transform[] bones = new Transform[joints.Count];
            for (int joint = 0; joint < joints.Count; joint++)
            {
                bones[joint] = new GameObject(NameOf(roles, joint)).transform;
            }
            for (int joint = 0; joint < joints.Count; joint++)
            {
                int parent = joints.Parents[joint];
                bones[joint].SetParent(parent < 0 ? holder : bones[parent], false);
                bones[joint].localPosition = Local(joints, positions, joint);
            }
            return bones;
        }

        /// <summary>Weights and bind poses.</summary>
        static void Weigh(Mesh mesh, RendererResult renderer, AvatarData source, double[] positions)
        {
            // SetBoneWeights would round them to 16 bits.
            BoneWeight[] weights = new BoneWeight[renderer.Positions.Length];
            foreach (PartData part in renderer.Source.Parts)
            {
                uint[] bones = new uint[Influences * part.VertexCount];
                float[] shares = new float[bones.Length];
                source.Character.GetWeights(source.Parts.IndexOf(part), Influences, bones, shares);
                for (int vertex = 0; vertex < part.VertexCount; vertex++)
                {
                    int first = Influences * vertex;
                    weights[part.VertexOf(vertex)] = new BoneWeight
                    {
                        boneIndex0 = (int)bones[first],
                        boneIndex1 = (int)bones[first + 1],
                        boneIndex2 = (int)bones[first + 2],
                        boneIndex3 = (int)bones[first + 3],
                        weight0 = shares[first],
                        weight1 = shares[first + 1],
                        weight2 = shares[first + 2],
                        weight3 = shares[first + 3]
                    };
                }
            }
            mesh.boneWeights = weights;
            Affine placement = renderer.Source.Placement;
            Matrix4x4[] binds = new Matrix4x4[positions.Length / 3];
            for (int joint = 0; joint < binds.Length; joint++)
            {
                binds[joint] = (Affine.Translation(Place(positions, joint) * -1) * placement).ToMatrix4x4();
            }
            mesh.bindposes = binds;
        }

        static void Show(Mesh mesh, Transform place, Transform[] bones, HumanoidRole[] roles, RendererResult renderer, double[] positions)
        {
            SkinnedMeshRenderer skinned = place.GetComponent<SkinnedMeshRenderer>();
            if (skinned == null) skinned = Replace(place);
            int hips = Math.Max(0, Array.IndexOf(roles, HumanoidRole.Hips));
            skinned.sharedMesh = mesh;
            skinned.bones = bones;
            skinned.rootBone = bones[hips];
            Box box = Box.Around(renderer.Positions, Affine.Translation(Place(positions, hips) * -1) * renderer.Source.Placement);
            var bounds = new Bounds();
            bounds.SetMinMax(box.Low.ToVector3(), box.High.ToVector3());
            skinned.localBounds = bounds;
        }

        /// <summary>A skinned renderer in the place of a plain one.</summary>
        static SkinnedMeshRenderer Replace(Transform place)
        {
            MeshRenderer plain = place.GetComponent<MeshRenderer>();
            Material[] materials = plain.sharedMaterials;
            bool enabled = plain.enabled, receiveShadows = plain.receiveShadows;
            UnityEngine.Rendering.ShadowCastingMode shadows = plain.shadowCastingMode;
            UnityEngine.Rendering.LightProbeUsage lightProbes = plain.lightProbeUsage;
            UnityEngine.Rendering.ReflectionProbeUsage reflectionProbes = plain.reflectionProbeUsage;
            Transform anchor = plain.probeAnchor;
            UnityEngine.Object.DestroyImmediate(plain);
            UnityEngine.Object.DestroyImmediate(place.GetComponent<MeshFilter>());
            SkinnedMeshRenderer skinned = place.gameObject.AddComponent<SkinnedMeshRenderer>();
            skinned.sharedMaterials = materials;
            skinned.enabled = enabled;
            skinned.receiveShadows = receiveShadows;
            skinned.shadowCastingMode = shadows;
            skinned.lightProbeUsage = lightProbes;
            skinned.reflectionProbeUsage = reflectionProbes;
            skinned.probeAnchor = anchor;
            return skinned;
        }

        static void AddAvatar(GameObject copy, PointMap map, AvatarData source, Joints joints, HumanoidRole[] roles, double[] positions)
        {
            int[] jointOf = new int[HumanoidRoles.Count];
            for (int role = 0; role < jointOf.Length; role++)
            {
                jointOf[role] = Array.IndexOf(roles, (HumanoidRole)role);
            }
            var nodes = new List<AvatarNode>
            {
                new AvatarNode { Name = Holder, Parent = -1, Rotation = Quaternion.identity, Scale = new Vector3(1, 1, 1) }
            };
            var nodeOf = new Dictionary<int, int>();
            Quaternion[] turns = Straightening.Turns(joints.Parents, jointOf, positions);
            foreach (int joint in Straightening.ParentsFirst(joints.Parents))
            {
                int parent = joints.Parents[joint];
                nodeOf[joint] = nodes.Count;
                nodes.Add(new AvatarNode
                {
                    Name = NameOf(roles, joint),
                    Parent = parent < 0 ? 0 : nodeOf[parent],
                    Position = Local(joints, positions, joint),
                    Rotation = parent < 0 ? turns[joint] : Quaternion.Inverse(turns[parent]) * turns[joint],
                    Scale = new Vector3(1, 1, 1)
                });
            }
            var description = new HumanDescription
            {
                human = HumanoidAvatar.Human(jointOf, joint => NameOf(roles, joint)),
                upperArmTwist = 0.5f,
                lowerArmTwist = 0.5f,
                upperLegTwist = 0.5f,
                lowerLegTwist = 0.5f,
                armStretch = 0.05f,
                legStretch = 0.05f
            };
            Animator animator = copy.GetComponent<Animator>();
            if (animator == null) animator = copy.AddComponent<Animator>();
            animator.avatar = HumanoidAvatar.Build(copy.name, nodes, description, source);
            animator.avatar.name = copy.name;
            map.AddAsset(animator.avatar);
        }
    }
}
