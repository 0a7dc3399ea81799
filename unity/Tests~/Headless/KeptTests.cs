// What the deformation has nothing to do with comes through as it was.
using System;
using System.Collections.Generic;
using NUnit.Framework;
using Unity.Collections;
using UnityEditor;
using UnityEngine;
using UnityEngine.Rendering;
using UnityStubs;

namespace SuperDeform.Editor.Tests
{
    /// A script of somebody else's, with references into the avatar and out of it.
    public class Keeper : MonoBehaviour
    {
        public Transform Bone;
        public List<Renderer> Renderers = new List<Renderer>();
        public GameObject Outside;
        public Material Asset;
        public string Words = "";
        [SerializeField] float m_Hidden = 1f;
        public float Hidden { get { return m_Hidden; } set { m_Hidden = value; } }
    }

    [TestFixture]
    public class KeptTests
    {
        static SkinnedMeshRenderer Named(GameObject root, string name)
        {
            return Array.Find(root.GetComponentsInChildren<SkinnedMeshRenderer>(true), delegate (SkinnedMeshRenderer at) { return at.name == name; });
        }

        [Test]
        public void all_channels_of_a_mesh_with_six_bones_a_vertex_and_quads()
        {
            Model model = Models.Load("kaykit_rogue.glb");
            Mesh mesh = Named(model.Root, "Rogue_Body").sharedMesh;
            int count = mesh.vertexCount;
            List<Vector4> wide = new List<Vector4>();
            Vector4[] tangents = new Vector4[count];
            Color32[] colors = new Color32[count];
            Vector3[] normals = mesh.normals;
            for (int vertex = 0; vertex < count; vertex++)
            {
                wide.Add(new Vector4(vertex, 0.5f, -vertex, 2f));
                Vector3 across = Vector3.Cross(normals[vertex], Mathf.Abs(normals[vertex].y) < 0.9f ? Vector3.up : Vector3.right).normalized;
                tangents[vertex] = new Vector4(across.x, across.y, across.z, vertex % 2 == 0 ? 1f : -1f);
                colors[vertex] = new Color32((byte)vertex, (byte)(vertex >> 8), 7, 255);
            }
            mesh.SetUVs(2, wide);
            mesh.SetUVs(7, wide);
            mesh.tangents = tangents;
            mesh.colors32 = colors;
            mesh.indexFormat = IndexFormat.UInt32;
            int[] corners = mesh.GetIndices(0);
            mesh.subMeshCount = 2;
            mesh.SetIndices(new[] { corners[0], corners[1], corners[2], corners[2] }, MeshTopology.Quads, 1);
            // Six bones each: the first vertex's own, and five with a little.
            byte[] six = new byte[count];
            List<BoneWeight1> rows = new List<BoneWeight1>();
            BoneWeight[] own = mesh.boneWeights;
            for (int vertex = 0; vertex < count; vertex++)
            {
                six[vertex] = 6;
                for (int slot = 0; slot < 6; slot++) rows.Add(new BoneWeight1 { boneIndex = slot == 0 ? own[vertex].boneIndex0 : (own[vertex].boneIndex0 + slot) % mesh.bindposes.Length, weight = slot == 0 ? 0.9f : 0.02f });
            }
            using (NativeArray<byte> counts = new NativeArray<byte>(six, Allocator.Temp))
            using (NativeArray<BoneWeight1> weights = new NativeArray<BoneWeight1>(rows.ToArray(), Allocator.Temp)) mesh.SetBoneWeights(counts, weights);

            Mesh made = Named(Converter.Convert(model.Root, new ConversionSettings { Heads = 1.8f }, null).Prefab, "Rogue_Body").sharedMesh;
            List<Vector4> read = new List<Vector4>();
            foreach (int channel in new[] { 2, 7 }) { made.GetUVs(channel, read); Assert.AreEqual(wide, read, "UV channel " + channel); }
            Assert.AreEqual(4, made.GetVertexAttributeDimension(VertexAttribute.TexCoord2));
            Assert.AreEqual(mesh.uv, made.uv);
            Assert.AreEqual(colors, made.colors32);
            Assert.AreEqual(IndexFormat.UInt32, made.indexFormat);
            Assert.AreEqual(MeshTopology.Quads, made.GetTopology(1));
            Assert.AreEqual(mesh.GetIndices(1), made.GetIndices(1));
            Assert.AreEqual(six, made.GetBonesPerVertex().ToArray());
            Assert.AreEqual(mesh.GetAllBoneWeights().ToArray(), made.GetAllBoneWeights().ToArray());
            Assert.AreEqual(mesh.name, made.name);
            Vector4[] turned = made.tangents;
            Vector3[] straight = made.normals;
            int changed = 0;
            for (int vertex = 0; vertex < count; vertex++)
            {
                Assert.AreEqual(tangents[vertex].w, turned[vertex].w, "handedness of tangent " + vertex);
                Assert.AreEqual(1f, ((Vector3)turned[vertex]).magnitude, 1e-4f, "length of tangent " + vertex);
                Assert.AreEqual(1f, straight[vertex].magnitude, 1e-4f, "length of normal " + vertex);
                Assert.AreEqual(0f, Vector3.Dot(turned[vertex], straight[vertex]), 1e-3f, "tangent " + vertex + " leans out of the surface");
                if (((Vector3)turned[vertex] - (Vector3)tangents[vertex]).magnitude > 1e-3f) changed++;
            }
            Assert.That(changed, Is.GreaterThan(10), "tangents that turned");
        }

        [Test]
        public void other_components_and_their_references()
        {
            Model model = Models.Load("kaykit_rogue.glb");
            GameObject outside = new GameObject("outside");
            Transform head = model.Root.GetComponent<Animator>().GetBoneTransform(HumanBodyBones.Head);
            Keeper keeper = head.gameObject.AddComponent<Keeper>();
            keeper.Bone = head.parent;
            keeper.Renderers.Add(Named(model.Root, "Rogue_Body"));
            keeper.Outside = outside;
            keeper.Asset = model.Glb.Materials[0];
            keeper.Words = "覚えて";
            keeper.Hidden = 5f;
            Light light = new GameObject("lamp").AddComponent<Light>();
            light.transform.SetParent(head, false);
            light.intensity = 3f;
            light.enabled = false;
            light.gameObject.SetActive(false);
            light.gameObject.layer = 5;
            light.gameObject.tag = "EditorOnly";
            Renderer cape = Array.Find(model.Root.GetComponentsInChildren<Renderer>(true), delegate (Renderer at) { return at.name == "Rogue_Cape"; });
            cape.enabled = false;
            cape.shadowCastingMode = ShadowCastingMode.TwoSided;
            cape.probeAnchor = head;

            ConversionResult result = Converter.Convert(model.Root, new ConversionSettings { Heads = 4f }, null);
            GameObject prefab = result.Prefab;
            Keeper kept = prefab.GetComponentInChildren<Keeper>(true);
            Assert.That(kept.Bone != null && kept.Bone.IsChildOf(prefab.transform) && kept.Bone.name == head.parent.name);
            Assert.That(kept.Renderers[0] != null && kept.Renderers[0].transform.IsChildOf(prefab.transform));
            Assert.That(kept.Outside == null, "a prefab cannot name an object of the scene");
            Assert.AreSame(keeper.Asset, kept.Asset);
            Assert.AreEqual("覚えて", kept.Words);
            Assert.AreEqual(5f, kept.Hidden);
            Light lamp = prefab.GetComponentInChildren<Light>(true);
            Assert.AreEqual(3f, lamp.intensity);
            Assert.That(!lamp.enabled && !lamp.gameObject.activeSelf && lamp.gameObject.layer == 5 && lamp.gameObject.tag == "EditorOnly");
            Renderer same = Array.Find(prefab.GetComponentsInChildren<Renderer>(true), delegate (Renderer at) { return at.name == "Rogue_Cape"; });
            Assert.That(!same.enabled && same.shadowCastingMode == ShadowCastingMode.TwoSided);
            Assert.AreEqual(head.name, same.probeAnchor.name);
            Assert.That(same.probeAnchor.IsChildOf(prefab.transform));
            Assert.That(model.Root.GetComponentInChildren<Keeper>(true).Outside == outside, "the source keeps its own");
        }

        [Test]
        public void what_is_written_is_whole_and_names_only_assets()
        {
            Model model = Models.Load("kaykit_rogue.glb");
            ConversionResult result = Converter.Convert(model.Root, Models.Settings(), null);
            string folder = System.IO.Path.GetDirectoryName(result.PrefabPath);
            foreach (string path in StubProject.FilesOnDisk())
            {
                if (path.StartsWith(folder) && System.IO.File.Exists(path)) Assert.That(new System.IO.FileInfo(path).Length, Is.GreaterThan(0), path);
            }
            foreach (Renderer renderer in result.Prefab.GetComponentsInChildren<Renderer>(true))
            {
                StringAssert.StartsWith(folder, AssetDatabase.GetAssetPath(Models.MeshOf(renderer)));
            }
            StringAssert.StartsWith(folder, AssetDatabase.GetAssetPath(result.Prefab.GetComponent<Animator>().avatar));
            Assert.That(EditorUtility.IsDirty(result.Prefab.GetComponent<Animator>().avatar), Is.False, "not saved");
            string json = result.ReportJson;
            StringAssert.Contains("\"heads\"", json);
            Assert.That(JsonText.Parse(json), Is.InstanceOf<Dictionary<string, object>>());
        }

        [Test]
        public void a_prefab_of_the_project_is_converted_as_it_lies_there()
        {
            Model model = Models.Load("kaykit_rogue.glb");
            GameObject source = PrefabUtility.SaveAsPrefabAsset(model.Root, "Assets/Models/Rogue.prefab");
            UnityEngine.Object.DestroyImmediate(model.Root);
            string before = Fingerprint.Of(source);
            ConversionResult result = Converter.Convert(source, new ConversionSettings { Heads = 1.8f }, null);
            Assert.AreEqual("Assets/Models/Rogue_SD/Rogue_SD.prefab", result.PrefabPath.Replace('\\', '/'));
            Assert.That(result.Instance == null, "no instance: nothing stands in a scene");
            Assert.AreEqual(before, Fingerprint.Of(source));
            Assert.AreEqual(0, UnityEngine.SceneManagement.SceneManager.GetActiveScene().rootCount, "objects left in the scene");
            MenuCommandTests.CheckPrefab(source, result.Prefab);
        }

        [Test]
        public void no_native_object_is_left()
        {
            Model model = Models.Load("kaykit_rogue.glb");
            ulong before = SuperDeformLibrary.LiveHandles;
            for (int run = 0; run < 3; run++) Converter.Convert(model.Root, Models.Settings(), null);
            Assert.AreEqual(before, SuperDeformLibrary.LiveHandles);
        }
    }
}
