using System;
using System.Collections.Generic;
using Unity.Collections;
using UnityEngine;
using UnityStubs;

namespace SuperDeform.Editor.Tests
{
    /// <summary>
    /// A person made of tubes, 1.8 m tall, in T pose: body of two materials, hair, a hat that hangs from the head, colliders.
    /// </summary>
    internal sealed class ConversionFigure
    {
        /// <summary>Armature and meshes as many exporters leave them: lying on the back, in centimetres.</summary>
        public bool Turned;

        /// <summary>The body gets blend shapes.</summary>
        public bool WithShapes;

        public GameObject Root;
        public SkinnedMeshRenderer Body, Hair;
        public MeshRenderer Hat;
        public readonly Dictionary<HumanBodyBones, Transform> Bones = new Dictionary<HumanBodyBones, Transform>();

        static readonly object[][] joints =
        {
            new object[] { HumanBodyBones.Hips, null, 0f, 1f, 0f, 0.13f },
            new object[] { HumanBodyBones.Spine, HumanBodyBones.Hips, 0f, 1.1f, 0f, 0.12f },
            new object[] { HumanBodyBones.Chest, HumanBodyBones.Spine, 0f, 1.25f, 0f, 0.14f },
            new object[] { HumanBodyBones.Neck, HumanBodyBones.Chest, 0f, 1.5f, 0f, 0.05f },
            new object[] { HumanBodyBones.Head, HumanBodyBones.Neck, 0f, 1.58f, 0f, 0.1f },
            new object[] { HumanBodyBones.LeftUpperLeg, HumanBodyBones.Hips, -0.1f, 0.95f, 0f, 0.08f },
            new object[] { HumanBodyBones.LeftLowerLeg, HumanBodyBones.LeftUpperLeg, -0.1f, 0.5f, 0f, 0.06f },
            new object[] { HumanBodyBones.LeftFoot, HumanBodyBones.LeftLowerLeg, -0.1f, 0.08f, 0f, 0.04f },
            new object[] { HumanBodyBones.LeftToes, HumanBodyBones.LeftFoot, -0.1f, 0.03f, 0.14f, 0.03f },
            new object[] { HumanBodyBones.LeftUpperArm, HumanBodyBones.Chest, -0.18f, 1.45f, 0f, 0.05f },
            new object[] { HumanBodyBones.LeftLowerArm, HumanBodyBones.LeftUpperArm, -0.45f, 1.45f, 0f, 0.04f },
            new object[] { HumanBodyBones.LeftHand, HumanBodyBones.LeftLowerArm, -0.7f, 1.45f, 0f, 0.03f }
        };

        static readonly Dictionary<HumanBodyBones, Vector3> ends = new Dictionary<HumanBodyBones, Vector3>
        {
            { HumanBodyBones.Head, new Vector3(0, 1.8f, 0) }, { HumanBodyBones.LeftToes, new Vector3(-0.1f, 0.03f, 0.2f) },
            { HumanBodyBones.RightToes, new Vector3(0.1f, 0.03f, 0.2f) }, { HumanBodyBones.LeftHand, new Vector3(-0.85f, 1.45f, 0) },
            { HumanBodyBones.RightHand, new Vector3(0.85f, 1.45f, 0) }
        };

        public ConversionFigure Make()
        {
            Root = new GameObject("Mika");
            Transform armature = new GameObject("Armature").transform;
            armature.SetParent(Root.transform, false);
            if (Turned)
            {
                armature.localRotation = Quaternion.Euler(-90, 0, 0);
                armature.localScale = Vector3.one * 0.01f;
            }
            foreach (object[] joint in All())
            {
                var role = (HumanBodyBones)joint[0];
                Transform bone = new GameObject("J_" + role).transform;
                bone.SetParent(joint[1] == null ? armature : Bones[(HumanBodyBones)joint[1]], false);
                bone.position = Place(joint);
                if (Turned) bone.rotation = Quaternion.Euler(10, 20, 30);
                Bones[role] = bone;
            }
            Body = Skinned("Body", new[] { "Skin", "Trousers" }, IsLeg, true);
            Hair = Skinned("Hair", new[] { "Hair" }, null, false);
            Hat = AddHat();
            AddColliders();
            AddAnimator();
            return this;
        }

        static IEnumerable<object[]> All()
        {
            foreach (object[] joint in joints) yield return joint;
            foreach (object[] joint in joints)
            {
                if (!joint[0].ToString().StartsWith("Left")) continue;
                var mirrored = (object[])joint.Clone();
                mirrored[0] = Other((HumanBodyBones)joint[0]);
                if (joint[1].ToString().StartsWith("Left")) mirrored[1] = Other((HumanBodyBones)joint[1]);
                mirrored[2] = -(float)joint[2];
                yield return mirrored;
            }
        }

        static HumanBodyBones Other(HumanBodyBones left)
        {
            return (HumanBodyBones)Enum.Parse(typeof(HumanBodyBones), left.ToString().Replace("Left", "Right"));
        }

        static Vector3 Place(object[] joint)
        {
            return new Vector3((float)joint[2], (float)joint[3], (float)joint[4]);
        }

        static bool IsLeg(HumanBodyBones role)
        {
            return role.ToString().Contains("Leg");
        }

        /// <summary>Tubes around the bones; hair is a cap around the head.</summary>
        SkinnedMeshRenderer Skinned(string name, string[] materials, Predicate<HumanBodyBones> second, bool body)
        {
            var positions = new List<Vector3>();
            var triangles = new List<List<int>> { new List<int>(), new List<int>() };
            var weights = new List<KeyValuePair<int, int>>();
            var names = new List<HumanBodyBones>(Bones.Keys);
            foreach (int part in new[] { 0, 1 })
            {
                foreach (object[] joint in All())
                {
                    var role = (HumanBodyBones)joint[0];
                    bool isSecond = second != null && second(role);
                    if (isSecond != (part == 1) || !body && role != HumanBodyBones.Head) continue;
                    Vector3 from = Place(joint), to = End(role);
                    float radius = (float)joint[5] * (body ? 1 : 1.15f);
                    Tube(positions, triangles[part], from, to, radius);
                    while (weights.Count < positions.Count)
                    {
                        weights.Add(new KeyValuePair<int, int>(names.IndexOf(role), joint[1] == null ? 0 : names.IndexOf((HumanBodyBones)joint[1])));
                    }
                }
            }
            return Show(name, materials, positions, triangles, weights, names, body);
        }

        static Vector3 End(HumanBodyBones role)
        {
            if (ends.ContainsKey(role)) return ends[role];
            object[] self = null;
            foreach (object[] joint in All())
            {
                if ((HumanBodyBones)joint[0] == role) self = joint;
                else if (joint[1] != null && (HumanBodyBones)joint[1] == role && Mathf.Approximately((float)joint[2], self == null ? 0 : (float)self[2]))
                {
                    return Place(joint);
                }
            }
            foreach (object[] joint in All())
            {
                if (joint[1] != null && (HumanBodyBones)joint[1] == role) return Place(joint);
            }
            throw new InvalidOperationException(role.ToString());
        }

        static void Tube(List<Vector3> positions, List<int> triangles, Vector3 from, Vector3 to, float radius)
        {
            const int Sides = 12, Rings = 8;
            Quaternion turn = Quaternion.FromToRotation(Vector3.up, (to - from).normalized);
            int first = positions.Count;
            for (int ring = 0; ring <= Rings; ring++)
            {
                for (int side = 0; side < Sides; side++)
                {
                    float angle = side * 2 * Mathf.PI / Sides;
                    // Ends are closed: the first and last ring are points.
                    float width = ring == 0 || ring == Rings ? 0 : radius;
                    float along = ring <= 1 ? 0 : ring >= Rings - 1 ? 1 : (ring - 1f) / (Rings - 2);
                    positions.Add(Vector3.Lerp(from, to, along) + turn * new Vector3(Mathf.Cos(angle) * width, 0, Mathf.Sin(angle) * width));
                }
            }
            for (int ring = 0; ring < Rings; ring++)
            {
                for (int side = 0; side < Sides; side++)
                {
                    int next = (side + 1) % Sides, a = first + ring * Sides + side, b = first + ring * Sides + next, c = a + Sides, d = b + Sides;
                    triangles.AddRange(new[] { a, c, b, b, c, d });
                }
            }
        }

        SkinnedMeshRenderer Show(string name, string[] materials, List<Vector3> positions, List<List<int>> triangles,
            List<KeyValuePair<int, int>> weights, List<HumanBodyBones> names, bool body)
        {
            var holder = new GameObject(name);
            holder.transform.SetParent(Root.transform, false);
            var renderer = holder.AddComponent<SkinnedMeshRenderer>();
            if (Turned)
            {
                holder.transform.localRotation = Quaternion.Euler(-90, 0, 0);
                holder.transform.localScale = Vector3.one * 0.01f;
            }
            Matrix4x4 toMesh = holder.transform.worldToLocalMatrix;
            var mesh = new Mesh { name = name + "Mesh" };
            mesh.vertices = positions.ConvertAll(p => toMesh.MultiplyPoint3x4(p)).ToArray();
            mesh.normals = positions.ConvertAll(p => toMesh.MultiplyVector(Outward(p)).normalized).ToArray();
            mesh.tangents = positions.ConvertAll(p => Tangent(toMesh, p)).ToArray();
            mesh.uv = positions.ConvertAll(p => new Vector2(p.x, p.y)).ToArray();
            mesh.subMeshCount = materials.Length;
            for (int part = 0; part < materials.Length; part++) mesh.SetTriangles(triangles[part].ToArray(), part);
            SetWeights(mesh, positions, weights, names);
            var bones = names.ConvertAll(role => Bones[role]);
            mesh.bindposes = bones.ConvertAll(bone => bone.worldToLocalMatrix * holder.transform.localToWorldMatrix).ToArray();
            if (WithShapes && body) AddShapes(mesh, positions, toMesh);
            mesh.RecalculateBounds();
            renderer.sharedMesh = mesh;
            renderer.bones = bones.ToArray();
            renderer.rootBone = Bones[HumanBodyBones.Hips];
            renderer.sharedMaterials = Array.ConvertAll(materials, Material);
            return renderer;
        }

        /// <summary>An asset of the project: a prefab keeps nothing else.</summary>
        static Material Material(string name)
        {
            var material = new Material(Shader.Find("Standard")) { name = name };
            StubProject.Import("Assets/" + name + ".mat", material);
            return material;
        }

        static Vector3 Outward(Vector3 p)
        {
            return new Vector3(p.x, 0.1f, p.z).normalized;
        }

        static Vector4 Tangent(Matrix4x4 toMesh, Vector3 p)
        {
            Vector3 tangent = toMesh.MultiplyVector(Vector3.Cross(Outward(p), Vector3.right)).normalized;
            return new Vector4(tangent.x, tangent.y, tangent.z, -1);
        }

        /// <summary>At the beginning of a bone 2 of 5 are the parent's: fifths keep their sum in 16 bits.</summary>
        static void SetWeights(Mesh mesh, List<Vector3> positions, List<KeyValuePair<int, int>> weights, List<HumanBodyBones> names)
        {
            var counts = new byte[positions.Count];
            var all = new List<BoneWeight1>();
            for (int vertex = 0; vertex < positions.Count; vertex++)
            {
                bool near = vertex % 108 < 24;
                counts[vertex] = (byte)(near ? 2 : 1);
                all.Add(new BoneWeight1 { boneIndex = weights[vertex].Key, weight = near ? 0.6f : 1 });
                if (near) all.Add(new BoneWeight1 { boneIndex = weights[vertex].Value, weight = 0.4f });
            }
            using (var native = new NativeArray<byte>(counts, Allocator.Temp))
            using (var flat = new NativeArray<BoneWeight1>(all.ToArray(), Allocator.Temp)) mesh.SetBoneWeights(native, flat);
        }

        /// <summary>Smile has two frames and changes normals; Breathe moves the chest alone.</summary>
        static void AddShapes(Mesh mesh, List<Vector3> positions, Matrix4x4 toMesh)
        {
            Vector3[] smile = positions.ConvertAll(p => toMesh.MultiplyVector(p.y > 1.6f ? new Vector3(0, 0.02f, 0.01f) : Vector3.zero)).ToArray();
            Vector3[] turned = positions.ConvertAll(p => toMesh.MultiplyVector(p.y > 1.6f ? new Vector3(0, 0.1f, 0) : Vector3.zero).normalized * 0.1f).ToArray();
            Vector3[] breathe = positions.ConvertAll(p => toMesh.MultiplyVector(p.y > 1.25f && p.y < 1.4f ? new Vector3(0, 0, 0.02f) : Vector3.zero)).ToArray();
            mesh.AddBlendShapeFrame("Smile", 50, Array.ConvertAll(smile, d => d * 0.4f), null, null);
            mesh.AddBlendShapeFrame("Smile", 100, smile, turned, null);
            mesh.AddBlendShapeFrame("Breathe", 100, breathe, null, null);
        }

        MeshRenderer AddHat()
        {
            var holder = new GameObject("Hat");
            holder.transform.SetParent(Bones[HumanBodyBones.Head], false);
            holder.transform.position = new Vector3(0, 1.82f, 0);
            var mesh = new Mesh { name = "HatMesh" };
            var positions = new List<Vector3>();
            var triangles = new List<int>();
            Tube(positions, triangles, new Vector3(0, 1.8f, 0), new Vector3(0, 1.9f, 0), 0.08f);
            mesh.vertices = positions.ConvertAll(p => holder.transform.InverseTransformPoint(p)).ToArray();
            mesh.SetTriangles(triangles.ToArray(), 0);
            mesh.RecalculateBounds();
            holder.AddComponent<MeshFilter>().sharedMesh = mesh;
            var renderer = holder.AddComponent<MeshRenderer>();
            renderer.sharedMaterials = new[] { Material("Hat") };
            return renderer;
        }

        void AddColliders()
        {
            var sphere = Bones[HumanBodyBones.Head].gameObject.AddComponent<SphereCollider>();
            sphere.center = Bones[HumanBodyBones.Head].InverseTransformPoint(new Vector3(0, 1.7f, 0));
            sphere.radius = 0.1f;
            var capsule = Bones[HumanBodyBones.LeftUpperLeg].gameObject.AddComponent<CapsuleCollider>();
            capsule.direction = 1;
            capsule.center = Bones[HumanBodyBones.LeftUpperLeg].InverseTransformPoint(new Vector3(-0.1f, 0.72f, 0));
            capsule.radius = 0.08f;
            capsule.height = 0.45f;
            var controller = Root.AddComponent<CharacterController>();
            controller.center = new Vector3(0, 0.9f, 0);
            controller.height = 1.8f;
            controller.radius = 0.2f;
        }

        void AddAnimator()
        {
            var skeleton = new List<SkeletonBone>();
            foreach (Transform transform in Root.GetComponentsInChildren<Transform>(true))
            {
                skeleton.Add(new SkeletonBone
                {
                    name = transform.name, position = transform.localPosition, rotation = transform.localRotation, scale = transform.localScale
                });
            }
            var human = new List<HumanBone>();
            foreach (KeyValuePair<HumanBodyBones, Transform> bone in Bones)
            {
                human.Add(new HumanBone
                {
                    humanName = HumanTrait.BoneName[(int)bone.Key], boneName = bone.Value.name, limit = new HumanLimit { useDefaultValues = true }
                });
            }
            var description = new HumanDescription { human = human.ToArray(), skeleton = skeleton.ToArray(), upperArmTwist = 0.25f };
            Avatar avatar = AvatarBuilder.BuildHumanAvatar(Root, description);
            avatar.name = "MikaAvatar";
            Root.AddComponent<Animator>().avatar = avatar;
        }
    }
}
