// A GLB or VRM file as an importer makes it a hierarchy in Unity.
//
// glTF is right-handed, Unity left-handed: one axis is mirrored. For glTF and VRM 1.0 (the figure looks along +Z) that is X, for VRM 0.x (it looks along -Z) Z,
// as UniVRM does; either way the figure looks along +Z in Unity. Triangles turn round, and V of texture coordinates counts from below.
// A glTF mesh becomes a Mesh with a submesh a primitive; primitives with the same accessors share their vertices, others follow one another.
using System;
using System.Collections.Generic;
using System.IO;
using UnityEngine;

namespace SuperDeform.Tests.Glb
{
    public sealed class GlbAvatar
    {
        public GameObject Root;
        public Transform[] Nodes;                    // by the file's node; null: not in the scene
        public List<Mesh> Meshes = new List<Mesh>();
        public List<Material> Materials = new List<Material>();
        public Dictionary<string, string> Roles = new Dictionary<string, string>(); // Unity's human name -> transform name
        /// The renderers of a node; the primitive's vertices in its Mesh.
        public List<PrimitiveRange> Primitives = new List<PrimitiveRange>();
    }

    public struct PrimitiveRange { public int Node, Primitive, FirstVertex, VertexCount; public Renderer Renderer; public Mesh Mesh; }

    public sealed class GlbLoader
    {
        readonly GlbFile m_File;
        readonly GlbAvatar m_Made = new GlbAvatar();
        readonly bool m_FlipZ;
        readonly Dictionary<string, Mesh> m_Meshes = new Dictionary<string, Mesh>();
        readonly Dictionary<Mesh, List<int[]>> m_Ranges = new Dictionary<Mesh, List<int[]>>();

        GlbLoader(GlbFile file) { m_File = file; m_FlipZ = file.IsVrm0; }

        /// `roles`: VRM 1.0 role -> node name, for files without a humanoid of their own; null: no Avatar then, unless the file is a VRM.
        public static GlbAvatar Load(string path, IDictionary<string, string> roles)
        {
            GlbLoader loader = new GlbLoader(new GlbFile(path));
            loader.MakeNodes(Path.GetFileNameWithoutExtension(path));
            loader.MakeMaterials();
            loader.MakeRenderers();
            loader.MakeAvatar(roles);
            return loader.m_Made;
        }

        Vector3 Flip(Vector3 v) { return m_FlipZ ? new Vector3(v.x, v.y, -v.z) : new Vector3(-v.x, v.y, v.z); }
        Quaternion Flip(Quaternion q) { return m_FlipZ ? new Quaternion(-q.x, -q.y, q.z, q.w) : new Quaternion(q.x, -q.y, -q.z, q.w); }
        Matrix4x4 Flip(Matrix4x4 m)
        {
            Matrix4x4 mirror = Matrix4x4.Scale(m_FlipZ ? new Vector3(1, 1, -1) : new Vector3(-1, 1, 1));
            return mirror * m * mirror;
        }

        void MakeNodes(string name)
        {
            Json nodes = m_File.Root["nodes"];
            m_Made.Root = new GameObject(name);
            m_Made.Nodes = new Transform[nodes.Count];
            HashSet<string> taken = new HashSet<string> { name };
            Json scene = m_File.Root["scenes"][m_File.Root["scene"].Int(0)];
            foreach (Json root in scene["nodes"].Items) MakeNode(root.Int(), m_Made.Root.transform, taken);
            // Joints count wherever they are.
            foreach (Json skin in m_File.Root["skins"].Items)
            {
                foreach (Json joint in skin["joints"].Items)
                {
                    int top = joint.Int();
                    if (m_Made.Nodes[top] != null) continue;
                    for (int above = ParentOf(top); above >= 0; above = ParentOf(above)) top = above;
                    if (m_Made.Nodes[top] == null) MakeNode(top, m_Made.Root.transform, taken);
                }
            }
        }
        int ParentOf(int node)
        {
            Json nodes = m_File.Root["nodes"];
            for (int other = 0; other < nodes.Count; other++) foreach (Json child in nodes[other]["children"].Items) if (child.Int() == node) return other;
            return -1;
        }
        // Names are made unique, since an Avatar finds its bones by name.
        void MakeNode(int index, Transform parent, HashSet<string> taken)
        {
            Json node = m_File.Root["nodes"][index];
            string wanted = node["name"].Text("node_" + index), name = wanted;
            for (int number = 1; !taken.Add(name); number++) name = wanted + "_" + number;
            Transform made = new GameObject(name).transform;
            made.SetParent(parent, false);
            m_Made.Nodes[index] = made;
            if (node["matrix"].Count == 16)
            {
                float[] numbers = node["matrix"].Floats();
                Matrix4x4 matrix = new Matrix4x4();
                for (int at = 0; at < 16; at++) matrix[at] = numbers[at];
                matrix = Flip(matrix);
                made.localPosition = matrix.GetPosition(); made.localRotation = matrix.rotation; made.localScale = matrix.lossyScale;
            }
            else
            {
                float[] t = node["translation"].Floats(), r = node["rotation"].Floats(), s = node["scale"].Floats();
                if (t.Length == 3) made.localPosition = Flip(new Vector3(t[0], t[1], t[2]));
                if (r.Length == 4) made.localRotation = Flip(new Quaternion(r[0], r[1], r[2], r[3]));
                if (s.Length == 3) made.localScale = new Vector3(s[0], s[1], s[2]);
            }
            foreach (Json child in node["children"].Items) MakeNode(child.Int(), made, taken);
        }

        void MakeMaterials()
        {
            Json materials = m_File.Root["materials"];
            for (int at = 0; at < materials.Count; at++)
            {
                Material made = new Material(Shader.Find("Standard"));
                made.name = materials[at]["name"].Text("material_" + at);
                m_Made.Materials.Add(made);
            }
        }

        void MakeRenderers()
        {
            Json nodes = m_File.Root["nodes"], meshes = m_File.Root["meshes"];
            for (int index = 0; index < nodes.Count; index++)
            {
                if (!nodes[index]["mesh"].Exists || m_Made.Nodes[index] == null) continue;
                int meshIndex = nodes[index]["mesh"].Int(), skinIndex = nodes[index]["skin"].Int();
                Json json = meshes[meshIndex];
                Mesh mesh = MeshOf(meshIndex, skinIndex);
                GameObject owner = m_Made.Nodes[index].gameObject;
                Renderer renderer;
                if (skinIndex >= 0 || mesh.blendShapeCount > 0)
                {
                    SkinnedMeshRenderer skinned = owner.AddComponent<SkinnedMeshRenderer>();
                    skinned.sharedMesh = mesh;
                    if (skinIndex >= 0)
                    {
                        Json joints = m_File.Root["skins"][skinIndex]["joints"];
                        Transform[] bones = new Transform[joints.Count];
                        for (int at = 0; at < bones.Length; at++) bones[at] = m_Made.Nodes[joints[at].Int()];
                        skinned.bones = bones;
                        int skeleton = m_File.Root["skins"][skinIndex]["skeleton"].Int();
                        skinned.rootBone = skeleton >= 0 ? m_Made.Nodes[skeleton] : bones[0];
                        // Bounds stand in the root bone's space.
                        skinned.localBounds = Within(skinned, skinned.rootBone.worldToLocalMatrix);
                    }
                    else skinned.localBounds = mesh.bounds;
                    renderer = skinned;
                }
                else
                {
                    owner.AddComponent<MeshFilter>().sharedMesh = mesh;
                    renderer = owner.AddComponent<MeshRenderer>();
                }
                List<Material> materials = new List<Material>();
                foreach (Json primitive in json["primitives"].Items)
                {
                    int material = primitive["material"].Int();
                    materials.Add(material >= 0 && material < m_Made.Materials.Count ? m_Made.Materials[material] : null);
                }
                renderer.sharedMaterials = materials.ToArray();
                List<int[]> ranges = m_Ranges[mesh];
                for (int primitive = 0; primitive < ranges.Count; primitive++)
                {
                    m_Made.Primitives.Add(new PrimitiveRange { Node = index, Primitive = primitive, FirstVertex = ranges[primitive][0], VertexCount = ranges[primitive][1], Renderer = renderer, Mesh = mesh });
                }
            }
        }

        static Bounds Within(SkinnedMeshRenderer renderer, Matrix4x4 space)
        {
            Vector3[] positions, normals;
            UnityStubs.Skinning.Drawn(renderer, space, out positions, out normals);
            Bounds box = new Bounds(positions[0], Vector3.zero);
            foreach (Vector3 p in positions) box.Encapsulate(p);
            return box;
        }

        // Bind poses belong to the Mesh, so a glTF mesh under two skins becomes two.
        Mesh MeshOf(int meshIndex, int skinIndex)
        {
            Mesh mesh;
            string key = meshIndex + "|" + skinIndex;
            if (m_Meshes.TryGetValue(key, out mesh)) return mesh;
            Json json = m_File.Root["meshes"][meshIndex], primitives = json["primitives"];
            List<int[]> ranges = new List<int[]>();
            List<Vector3> positions = new List<Vector3>(), normals = new List<Vector3>();
            List<Vector4> tangents = new List<Vector4>();
            List<Vector2>[] uvs = { new List<Vector2>(), new List<Vector2>() };
            List<Color> colors = new List<Color>();
            List<List<BoneWeight1>> rows = new List<List<BoneWeight1>>();
            List<int> starters = new List<int>(); // primitives that brought vertices
            bool anyNormals = false, anyTangents = false, anyColors = false, anyUv0 = false, anyUv1 = false;
            for (int at = 0; at < primitives.Count; at++)
            {
                Json attributes = primitives[at]["attributes"];
                int twin = starters.FindIndex(delegate (int other) { return SameAttributes(primitives[other], primitives[at]); });
                if (twin >= 0) { ranges.Add(ranges[starters[twin]]); continue; }
                int first = positions.Count;
                foreach (Vector4 v in Vectors(attributes["POSITION"])) positions.Add(Flip((Vector3)v));
                int count = positions.Count - first;
                anyNormals |= attributes["NORMAL"].Exists; anyTangents |= attributes["TANGENT"].Exists; anyColors |= attributes["COLOR_0"].Exists;
                anyUv0 |= attributes["TEXCOORD_0"].Exists; anyUv1 |= attributes["TEXCOORD_1"].Exists;
                foreach (Vector4 v in Vectors(attributes["NORMAL"])) normals.Add(Flip((Vector3)v));
                foreach (Vector4 v in Vectors(attributes["TANGENT"])) { Vector3 t = Flip((Vector3)v); tangents.Add(new Vector4(t.x, t.y, t.z, v.w)); }
                foreach (Vector4 v in Vectors(attributes["COLOR_0"])) colors.Add(v);
                for (int set = 0; set < 2; set++) foreach (Vector4 v in Vectors(attributes["TEXCOORD_" + set])) uvs[set].Add(new Vector2(v.x, 1f - v.y));
                Pad(normals, positions.Count); Pad(tangents, positions.Count); Pad(colors, positions.Count); Pad(uvs[0], positions.Count); Pad(uvs[1], positions.Count);
                if (skinIndex >= 0) AddRows(attributes, count, rows);
                starters.Add(at);
                ranges.Add(new[] { first, count });
            }
            mesh = new Mesh();
            mesh.name = json["name"].Text("mesh_" + meshIndex);
            if (positions.Count > 65535) mesh.indexFormat = UnityEngine.Rendering.IndexFormat.UInt32;
            mesh.SetVertices(positions);
            if (anyNormals) mesh.SetNormals(normals);
            if (anyTangents) mesh.SetTangents(tangents);
            if (anyColors) mesh.SetColors(colors);
            if (anyUv0) mesh.SetUVs(0, uvs[0]);
            if (anyUv1) mesh.SetUVs(1, uvs[1]);
            mesh.subMeshCount = primitives.Count;
            for (int at = 0; at < primitives.Count; at++) mesh.SetIndices(Corners(primitives[at], ranges[at][1]), MeshTopology.Triangles, at, false, ranges[at][0]);
            mesh.RecalculateBounds();
            if (skinIndex >= 0) Skin(mesh, m_File.Root["skins"][skinIndex], rows);
            AddShapes(mesh, json, starters, ranges, anyNormals, anyTangents);
            m_Meshes[key] = mesh;
            m_Ranges[mesh] = ranges;
            m_Made.Meshes.Add(mesh);
            return mesh;
        }

        static bool SameAttributes(Json a, Json b)
        {
            foreach (string key in a["attributes"].Keys) if (a["attributes"][key].Int() != b["attributes"][key].Int(-2)) return false;
            return new List<string>(a["attributes"].Keys).Count == new List<string>(b["attributes"].Keys).Count && a["targets"].Count == b["targets"].Count;
        }
        static void Pad<T>(List<T> list, int count) { while (list.Count < count) list.Add(default(T)); }
        IEnumerable<Vector4> Vectors(Json accessor)
        {
            if (!accessor.Exists) yield break;
            int components;
            double[] numbers = m_File.Numbers(accessor.Int(), out components);
            for (int at = 0; at < numbers.Length; at += components)
            {
                yield return new Vector4((float)numbers[at], (float)numbers[at + 1], components > 2 ? (float)numbers[at + 2] : 0f, components > 3 ? (float)numbers[at + 3] : 1f);
            }
        }

        // Fans and strips become single triangles; each turns round.
        int[] Corners(Json primitive, int vertexCount)
        {
            int[] listed;
            if (primitive["indices"].Exists) listed = m_File.Integers(primitive["indices"].Int());
            else { listed = new int[vertexCount]; for (int at = 0; at < vertexCount; at++) listed[at] = at; }
            int mode = primitive["mode"].Int(4);
            List<int> corners = new List<int>();
            if (mode == 4) for (int at = 0; at + 2 < listed.Length; at += 3) { corners.Add(listed[at]); corners.Add(listed[at + 2]); corners.Add(listed[at + 1]); }
            if (mode == 5) for (int at = 0; at + 2 < listed.Length; at++) { corners.Add(listed[at]); corners.Add(listed[at + (at % 2 == 0 ? 2 : 1)]); corners.Add(listed[at + (at % 2 == 0 ? 1 : 2)]); }
            if (mode == 6) for (int at = 1; at + 1 < listed.Length; at++) { corners.Add(listed[0]); corners.Add(listed[at + 1]); corners.Add(listed[at]); }
            return corners.ToArray();
        }

        void AddRows(Json attributes, int count, List<List<BoneWeight1>> rows)
        {
            int first = rows.Count;
            for (int vertex = 0; vertex < count; vertex++) rows.Add(new List<BoneWeight1>());
            for (int set = 0; attributes["JOINTS_" + set].Exists; set++)
            {
                int[] joints = m_File.Integers(attributes["JOINTS_" + set].Int());
                int components;
                double[] weights = m_File.Numbers(attributes["WEIGHTS_" + set].Int(), out components);
                for (int at = 0; at < weights.Length; at++)
                {
                    if (weights[at] <= 0) continue;
                    BoneWeight1 one = new BoneWeight1(); one.boneIndex = joints[at]; one.weight = (float)weights[at];
                    rows[first + at / 4].Add(one);
                }
            }
        }

        void Skin(Mesh mesh, Json skin, List<List<BoneWeight1>> rows)
        {
            int joints = skin["joints"].Count;
            Matrix4x4[] binds = new Matrix4x4[joints];
            for (int at = 0; at < joints; at++) binds[at] = Matrix4x4.identity;
            if (skin["inverseBindMatrices"].Exists)
            {
                int components;
                double[] numbers = m_File.Numbers(skin["inverseBindMatrices"].Int(), out components);
                for (int joint = 0; joint < joints; joint++)
                {
                    for (int element = 0; element < 16; element++) binds[joint][element] = (float)numbers[joint * 16 + element];
                    binds[joint] = Flip(binds[joint]);
                }
            }
            mesh.bindposes = binds;
            // Four a vertex, as importers give them: the greatest, made to sum to 1.
            BoneWeight[] four = new BoneWeight[rows.Count];
            for (int vertex = 0; vertex < four.Length; vertex++)
            {
                List<BoneWeight1> row = rows[vertex];
                row.Sort(delegate (BoneWeight1 a, BoneWeight1 b) { return b.weight.CompareTo(a.weight); });
                float sum = 0f;
                for (int slot = 0; slot < Math.Min(4, row.Count); slot++) sum += row[slot].weight;
                BoneWeight one = new BoneWeight();
                for (int slot = 0; slot < Math.Min(4, row.Count); slot++)
                {
                    float weight = row[slot].weight / sum;
                    switch (slot)
                    {
                        case 0: one.boneIndex0 = row[slot].boneIndex; one.weight0 = weight; break;
                        case 1: one.boneIndex1 = row[slot].boneIndex; one.weight1 = weight; break;
                        case 2: one.boneIndex2 = row[slot].boneIndex; one.weight2 = weight; break;
                        default: one.boneIndex3 = row[slot].boneIndex; one.weight3 = weight; break;
                    }
                }
                four[vertex] = one;
            }
            mesh.boneWeights = four;
        }

        void AddShapes(Mesh mesh, Json json, List<int> starters, List<int[]> ranges, bool normals, bool tangents)
        {
            int count = 0;
            foreach (int starter in starters) count = Math.Max(count, json["primitives"][starter]["targets"].Count);
            HashSet<string> taken = new HashSet<string>();
            for (int target = 0; target < count; target++)
            {
                Vector3[][] deltas = { new Vector3[mesh.vertexCount], normals ? new Vector3[mesh.vertexCount] : null, tangents ? new Vector3[mesh.vertexCount] : null };
                string[] keys = { "POSITION", "NORMAL", "TANGENT" };
                foreach (int starter in starters)
                {
                    for (int key = 0; key < 3; key++)
                    {
                        if (deltas[key] == null) continue;
                        int vertex = ranges[starter][0];
                        foreach (Vector4 v in Vectors(json["primitives"][starter]["targets"][target][keys[key]])) deltas[key][vertex++] = Flip((Vector3)v);
                    }
                }
                Json names = json["extras"]["targetNames"];
                if (!names.Exists) names = json["primitives"][starters[0]]["extras"]["targetNames"];
                string wanted = names[target].Text("");
                if (wanted == "") wanted = "shape_" + target;
                string name = wanted;
                for (int number = 1; !taken.Add(name); number++) name = wanted + "_" + number;
                mesh.AddBlendShapeFrame(name, 100f, deltas[0], deltas[1], deltas[2]);
            }
        }

        void MakeAvatar(IDictionary<string, string> given)
        {
            Dictionary<string, Transform> roles = new Dictionary<string, Transform>();
            Json vrm1 = m_File.Root["extensions"]["VRMC_vrm"]["humanoid"]["humanBones"], vrm0 = m_File.Root["extensions"]["VRM"]["humanoid"]["humanBones"];
            if (vrm1.Exists) foreach (string role in vrm1.Keys) roles[Humanoid.UnityName(role, true)] = m_Made.Nodes[vrm1[role]["node"].Int()];
            else if (vrm0.Exists) foreach (Json bone in vrm0.Items) { if (bone["node"].Int() >= 0) roles[Humanoid.UnityName(bone["bone"].Text(), false)] = m_Made.Nodes[bone["node"].Int()]; }
            else if (given != null)
            {
                bool metacarpal = given.ContainsKey("leftThumbMetacarpal") || given.ContainsKey("rightThumbMetacarpal");
                foreach (KeyValuePair<string, string> pair in given) roles[Humanoid.UnityName(pair.Key, metacarpal)] = Named(pair.Value);
            }
            if (roles.Count == 0) return;
            Humanoid.Give(m_Made.Root, roles);
            foreach (KeyValuePair<string, Transform> pair in roles) m_Made.Roles[pair.Key] = pair.Value.name;
        }
        Transform Named(string name)
        {
            foreach (Transform node in m_Made.Nodes) if (node != null && node.name == name) return node;
            throw new InvalidDataException(m_File.Name + " has no node '" + name + "'");
        }
    }
}
