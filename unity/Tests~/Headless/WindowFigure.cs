using System.Collections.Generic;
using UnityEngine;

namespace SuperDeform.Editor.Tests
{
    /// <summary>A person made of ellipsoids, with named bones, skinned: an avatar of any number of vertices.</summary>
    /// <remarks>1.6 tall, faces +Z, arms out. Half of the body is one submesh and half the other, ring by ring, so that neither
    /// has its vertices side by side; a hat hangs from the head without a skin; the body has blend shapes.</remarks>
    internal sealed class WindowFigure
    {
        struct Limb
        {
            internal string Bone;
            internal Vector3 From, To;
            internal float Radius;
        }

        readonly Dictionary<string, Transform> bones = new Dictionary<string, Transform>();
        readonly List<Limb> limbs = new List<Limb>();

        internal GameObject Root { get; private set; }
        internal SkinnedMeshRenderer Body { get; private set; }
        internal MeshRenderer Hat { get; private set; }

        internal Transform this[string bone] { get { return bones[bone]; } }

        /// <param name="vertices">About how many vertices the body has; exactly, where exact.</param>
        internal WindowFigure(string name, int vertices, int blendShapes = 0, bool exact = false)
        {
            Root = new GameObject(name);
            Bone("Hips", null, 0, 0.9f, 0);
            Bone("Spine", "Hips", 0, 1.0f, 0);
            Bone("Chest", "Spine", 0, 1.15f, 0);
            Bone("Neck", "Chest", 0, 1.36f, 0);
            Bone("Head", "Neck", 0, 1.42f, 0);
            foreach (string side in new[] { "Left", "Right" })
            {
                // Unity is left-handed: a figure that faces +Z has its left at -X.
                float x = side == "Left" ? -1 : 1;
                Bone(side + "UpperLeg", "Hips", 0.09f * x, 0.86f, 0);
                Bone(side + "LowerLeg", side + "UpperLeg", 0.09f * x, 0.48f, 0);
                Bone(side + "Foot", side + "LowerLeg", 0.09f * x, 0.09f, 0);
                Bone(side + "Toes", side + "Foot", 0.09f * x, 0.03f, 0.12f);
                Bone(side + "Shoulder", "Chest", 0.05f * x, 1.32f, 0);
                Bone(side + "UpperArm", side + "Shoulder", 0.17f * x, 1.32f, 0);
                Bone(side + "LowerArm", side + "UpperArm", 0.42f * x, 1.32f, 0);
                Bone(side + "Hand", side + "LowerArm", 0.65f * x, 1.32f, 0);
                Add(side + "UpperLeg", 0.09f * x, 0.9f, 0, 0.09f * x, 0.46f, 0, 0.075f);
                Add(side + "LowerLeg", 0.09f * x, 0.52f, 0, 0.09f * x, 0.05f, 0, 0.055f);
                Add(side + "Foot", 0.09f * x, 0.04f, -0.07f, 0.09f * x, 0.04f, 0.17f, 0.04f);
                Add(side + "UpperArm", 0.12f * x, 1.32f, 0, 0.44f * x, 1.32f, 0, 0.05f);
                Add(side + "LowerArm", 0.40f * x, 1.32f, 0, 0.67f * x, 1.32f, 0, 0.04f);
                Add(side + "Hand", 0.63f * x, 1.32f, 0, 0.80f * x, 1.32f, 0, 0.035f);
            }
            Add("Hips", 0, 0.78f, 0, 0, 1.06f, 0, 0.15f);
            Add("Spine", 0, 0.94f, 0, 0, 1.22f, 0, 0.14f);
            Add("Chest", 0, 1.06f, 0, 0, 1.4f, 0, 0.16f);
            Add("Neck", 0, 1.3f, 0, 0, 1.46f, 0, 0.055f);
            Add("Head", 0, 1.38f, 0.01f, 0, 1.6f, 0.01f, 0.095f);
            MakeBody(vertices, blendShapes, exact);
            MakeHat();
        }

        void Bone(string name, string parent, float x, float y, float z)
        {
            Transform bone = new GameObject(name).transform;
            bone.SetParent(parent == null ? Root.transform : bones[parent], false);
            bone.position = Root.transform.position + new Vector3(x, y, z);
            bones.Add(name, bone);
        }

        void Add(string bone, float x1, float y1, float z1, float x2, float y2, float z2, float radius)
        {
            limbs.Add(new Limb { Bone = bone, From = new Vector3(x1, y1, z1), To = new Vector3(x2, y2, z2), Radius = radius });
        }

        void MakeBody(int count, int blendShapes, bool exact)
        {
            int rings = Mathf.Max(4, (int)Mathf.Sqrt(count / (2f * limbs.Count))), around = 2 * rings;
            var names = new List<string>(bones.Keys);
            var positions = new List<Vector3>();
            var normals = new List<Vector3>();
            var weights = new List<BoneWeight>();
            var triangles = new[] { new List<int>(), new List<int>() };
            foreach (Limb limb in limbs)
            {
                Vector3 axis = limb.To - limb.From, middle = (limb.From + limb.To) * 0.5f;
                Vector3 side = Vector3.Cross(axis, Mathf.Abs(axis.x) > Mathf.Abs(axis.y) ? Vector3.up : Vector3.right).normalized;
                Vector3 other = Vector3.Cross(axis, side).normalized;
                int first = positions.Count;
                for (int ring = 0; ring < rings; ring++)
                {
                    for (int step = 0; step < around; step++)
                    {
                        float tilt = Mathf.PI * (ring + 0.5f) / rings, turn = 2 * Mathf.PI * step / around;
                        Vector3 out1 = side * Mathf.Cos(turn) + other * Mathf.Sin(turn);
                        positions.Add(middle - axis * (0.5f * Mathf.Cos(tilt)) + out1 * (limb.Radius * Mathf.Sin(tilt)));
                        normals.Add((out1 * (Mathf.Sin(tilt) / limb.Radius)
                            - axis * (2 * Mathf.Cos(tilt) / axis.sqrMagnitude)).normalized);
                        weights.Add(new BoneWeight { boneIndex0 = names.IndexOf(limb.Bone), weight0 = 1 });
                    }
                }
                int half = limbs.IndexOf(limb) % 2;
                for (int ring = 0; ring + 1 < rings; ring++)
                {
                    for (int step = 0; step < around; step++)
                    {
                        int a = first + ring * around + step, b = first + ring * around + (step + 1) % around;
                        triangles[half].AddRange(new[] { a, a + around, b, b, a + around, b + around });
                    }
                }
                for (int step = 2; step < around; step++)
                {
                    triangles[half].AddRange(new[] { first, first + step - 1, first + step });
                    int last = first + (rings - 1) * around;
                    triangles[half].AddRange(new[] { last, last + step, last + step - 1 });
                }
            }
            // Small triangles of their own on the chest fill up to the number asked for.
            while (exact && positions.Count < count)
            {
                int at = positions.Count;
                positions.Add(new Vector3(0.01f * Mathf.Sin(at), 1.25f + 0.01f * Mathf.Cos(at), 0.17f));
                normals.Add(Vector3.forward);
                weights.Add(new BoneWeight { boneIndex0 = names.IndexOf("Chest"), weight0 = 1 });
                if (at % 3 == 2) triangles[0].AddRange(new[] { at - 2, at - 1, at });
            }
            var mesh = new Mesh { name = "body", indexFormat = UnityEngine.Rendering.IndexFormat.UInt32 };
            mesh.vertices = positions.ToArray();
            mesh.normals = normals.ToArray();
            mesh.boneWeights = weights.ToArray();
            mesh.subMeshCount = 2;
            mesh.SetTriangles(triangles[0].ToArray(), 0);
            mesh.SetTriangles(triangles[1].ToArray(), 1);
            mesh.bindposes = System.Array.ConvertAll(names.ToArray(),
                name => bones[name].worldToLocalMatrix * Root.transform.localToWorldMatrix);
            for (int shape = 0; shape < blendShapes; shape++)
            {
                var deltas = new Vector3[positions.Count];
                for (int i = 0; i < deltas.Length; i++) deltas[i] = positions[i].y > 1.45f ? normals[i] * (0.001f * (shape + 1)) : Vector3.zero;
                mesh.AddBlendShapeFrame("shape" + shape, 100, deltas, null, null);
            }
            var holder = new GameObject("body");
            holder.transform.SetParent(Root.transform, false);
            Body = holder.AddComponent<SkinnedMeshRenderer>();
            Body.sharedMesh = mesh;
            Body.bones = names.ConvertAll(name => bones[name]).ToArray();
            Body.rootBone = bones["Hips"];
        }

        void MakeHat()
        {
            var mesh = new Mesh { name = "hat" };
            mesh.vertices = new[] { new Vector3(-0.1f, 0.2f, -0.1f), new Vector3(0.1f, 0.2f, -0.1f), new Vector3(0, 0.2f, 0.12f),
                new Vector3(0, 0.35f, 0) };
            mesh.triangles = new[] { 0, 1, 2, 0, 3, 1, 1, 3, 2, 2, 3, 0 };
            mesh.RecalculateNormals();
            var holder = new GameObject("hat");
            holder.transform.SetParent(bones["Head"], false);
            holder.AddComponent<MeshFilter>().sharedMesh = mesh;
            Hat = holder.AddComponent<MeshRenderer>();
        }
    }
}
