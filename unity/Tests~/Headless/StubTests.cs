// The stand-ins behave as Unity documents; what the other tests say rests on these.
using System;
using System.Collections.Generic;
using System.IO;
using NUnit.Framework;
using Unity.Collections;
using UnityEditor;
using UnityEngine;
using UnityStubs;
using Object = UnityEngine.Object;

namespace SuperDeform.Editor.Tests
{
    [TestFixture]
    public class StubTests
    {
        [SetUp] public void Begin() { Models.NewProject(); }

        static Mesh Triangle()
        {
            Mesh mesh = new Mesh();
            mesh.name = "triangle";
            mesh.vertices = new[] { Vector3.zero, Vector3.right, Vector3.up };
            mesh.triangles = new[] { 0, 1, 2 };
            return mesh;
        }

        static void Near(Vector3 expected, Vector3 actual) { Assert.That((expected - actual).magnitude, Is.LessThan(1e-5f), actual.ToString("F6") + " is not " + expected.ToString("F6")); }

        [Test]
        public void a_destroyed_object_equals_null_and_its_members_throw()
        {
            GameObject owner = new GameObject("owner");
            Light light = owner.AddComponent<Light>();
            Transform child = new GameObject("child").transform;
            child.SetParent(owner.transform);
            Object.DestroyImmediate(owner);
            Assert.That(owner == null && light == null && child == null && !owner);
            Assert.That((object)owner, Is.Not.SameAs(null));
            Assert.Throws<MissingReferenceException>(delegate { child.localPosition = Vector3.one; });
        }

        [Test]
        public void a_copy_refers_to_its_own_parts_and_to_the_same_assets()
        {
            GameObject root = new GameObject("root");
            Transform bone = new GameObject("bone").transform, outside = new GameObject("outside").transform;
            bone.SetParent(root.transform);
            SkinnedMeshRenderer renderer = root.AddComponent<SkinnedMeshRenderer>();
            renderer.bones = new[] { bone, outside };
            renderer.sharedMesh = Triangle();
            GameObject copy = Object.Instantiate(root);
            Assert.AreEqual("root(Clone)", copy.name);
            SkinnedMeshRenderer twin = copy.GetComponent<SkinnedMeshRenderer>();
            Assert.AreSame(copy.transform.GetChild(0), twin.bones[0]);
            Assert.AreSame(outside, twin.bones[1]);
            Assert.AreSame(renderer.sharedMesh, twin.sharedMesh);
            copy.transform.GetChild(0).localPosition = Vector3.one;
            Near(Vector3.zero, bone.localPosition);
        }

        [Test]
        public void a_copied_mesh_shares_nothing()
        {
            Mesh mesh = Triangle();
            mesh.AddBlendShapeFrame("smile", 100f, new Vector3[3], null, null);
            Mesh copy = Object.Instantiate(mesh);
            copy.vertices = new[] { Vector3.one, Vector3.one, Vector3.one };
            copy.ClearBlendShapes();
            Near(Vector3.right, mesh.vertices[1]);
            Assert.AreEqual(1, mesh.blendShapeCount);
        }

        [Test]
        public void a_mesh_that_is_not_readable_gives_nothing_and_logs_an_error()
        {
            Mesh mesh = Triangle();
            mesh.UploadMeshData(true);
            Assert.That(mesh.isReadable, Is.False);
            Assert.That(mesh.vertices, Is.Empty);
            mesh.vertices = new[] { Vector3.one, Vector3.one, Vector3.one };
            Assert.AreEqual(3, mesh.vertexCount);
            Assert.AreEqual(2, Log.Of(LogType.Error).Count);
        }

        [Test]
        public void channels_and_indices_of_wrong_lengths_are_refused()
        {
            Mesh mesh = Triangle();
            mesh.normals = new Vector3[2];
            Assert.That(mesh.normals, Is.Empty);
            mesh.SetTriangles(new[] { 0, 1, 3 }, 0);
            Assert.AreEqual(new[] { 0, 1, 2 }, mesh.triangles);
            Assert.AreEqual(2, Log.Of(LogType.Error).Count);
            Mesh big = new Mesh();
            big.vertices = new Vector3[70000];
            big.SetTriangles(new[] { 0, 1, 69999 }, 0);
            Assert.AreEqual(0, big.triangles.Length, "16 bits are the default");
            big.indexFormat = UnityEngine.Rendering.IndexFormat.UInt32;
            big.SetTriangles(new[] { 0, 1, 69999 }, 0);
            Assert.AreEqual(3, big.triangles.Length);
        }

        [Test]
        public void blend_shape_frames_have_full_length_and_rising_weights()
        {
            Mesh mesh = Triangle();
            Assert.Throws<ArgumentException>(delegate { mesh.AddBlendShapeFrame("a", 100f, new Vector3[2], null, null); });
            Assert.Throws<ArgumentException>(delegate { mesh.AddBlendShapeFrame("a", 100f, new Vector3[3], new Vector3[4], null); });
            mesh.AddBlendShapeFrame("a", 50f, new Vector3[3], null, null);
            Assert.Throws<ArgumentException>(delegate { mesh.AddBlendShapeFrame("a", 50f, new Vector3[3], null, null); });
            mesh.AddBlendShapeFrame("a", 100f, new[] { Vector3.up, Vector3.up, Vector3.up }, null, null);
            Assert.AreEqual(1, mesh.blendShapeCount);
            Assert.AreEqual(2, mesh.GetBlendShapeFrameCount(0));
            Vector3[] deltas = new Vector3[3];
            mesh.GetBlendShapeFrameVertices(0, 1, deltas, null, null);
            Near(Vector3.up, deltas[2]);
            Assert.Throws<ArgumentException>(delegate { mesh.GetBlendShapeFrameVertices(0, 1, new Vector3[5], null, null); });
        }

        static void SetWeights(Mesh mesh, byte[] counts, params float[] weights)
        {
            BoneWeight1[] all = Array.ConvertAll(weights, delegate (float weight) { return new BoneWeight1 { weight = weight }; });
            using (NativeArray<byte> bones = new NativeArray<byte>(counts, Allocator.Temp))
            using (NativeArray<BoneWeight1> rows = new NativeArray<BoneWeight1>(all, Allocator.Temp)) mesh.SetBoneWeights(bones, rows);
        }

        [Test]
        public void bone_weights_descend_fit_their_counts_and_keep_16_bits()
        {
            Mesh mesh = Triangle();
            Assert.Throws<ArgumentException>(delegate { SetWeights(mesh, new byte[] { 1, 1 }, 1f, 1f); });
            Assert.Throws<ArgumentException>(delegate { SetWeights(mesh, new byte[] { 1, 1, 2 }, 1f, 1f, 1f); });
            Assert.Throws<ArgumentException>(delegate { SetWeights(mesh, new byte[] { 2, 1, 1 }, 0.3f, 0.7f, 1f, 1f); });
            SetWeights(mesh, new byte[] { 2, 1, 3 }, 0.7f, 0.3f, 1f, 1f, 0f, 0f);
            Assert.AreEqual(new byte[] { 2, 1, 1 }, mesh.GetBonesPerVertex().ToArray(), "zeros are left out");
            Assert.AreEqual(0.7f, mesh.GetAllBoneWeights()[0].weight, 1.0 / 65535);
            Assert.AreEqual(0.3f, mesh.boneWeights[0].weight1, 1.0 / 65535);
        }

        [Test]
        public void skinning_bakes_what_the_bones_say()
        {
            GameObject root = new GameObject("root");
            root.transform.localPosition = new Vector3(5, 0, 0);
            Transform bone = new GameObject("bone").transform;
            bone.SetParent(root.transform, false);
            Mesh mesh = Triangle();
            SetWeights(mesh, new byte[] { 1, 1, 1 }, 1f, 1f, 1f);
            mesh.bindposes = new[] { bone.worldToLocalMatrix * root.transform.localToWorldMatrix };
            SkinnedMeshRenderer renderer = root.AddComponent<SkinnedMeshRenderer>();
            renderer.bones = new[] { bone };
            renderer.sharedMesh = mesh;
            bone.localRotation = Quaternion.Euler(0, 0, 90);
            bone.localScale = new Vector3(2, 2, 2);
            Mesh baked = new Mesh();
            renderer.BakeMesh(baked, true);
            Near(new Vector3(0, 2, 0), baked.vertices[1]);
            Near(new Vector3(-2, 0, 0), baked.vertices[2]);
        }

        [Test]
        public void transforms_compose_and_keep_their_place_under_a_new_parent()
        {
            Transform parent = new GameObject("parent").transform, child = new GameObject("child").transform;
            parent.localPosition = new Vector3(1, 2, 3);
            parent.localRotation = Quaternion.Euler(0, 90, 0);
            parent.localScale = new Vector3(2, 2, 2);
            child.position = new Vector3(4, 5, 6);
            child.SetParent(parent);
            Near(new Vector3(4, 5, 6), child.position);
            Near(new Vector3(0.5f, 0.5f, 0.5f), child.localScale);
            // +Z of the parent points to +X of the world.
            Near(new Vector3(3, 2, 3), parent.TransformPoint(Vector3.forward));
            Near(Vector3.forward, parent.InverseTransformPoint(new Vector3(3, 2, 3)));
            Near(new Vector3(10, 20, 30), Quaternion.Euler(10, 20, 30).eulerAngles);
            Near(new Vector3(2, 3, 4), Matrix4x4.TRS(Vector3.one, Quaternion.Euler(1, 2, 3), new Vector3(2, 3, 4)).lossyScale);
            Matrix4x4 odd = Matrix4x4.TRS(Vector3.one, Quaternion.Euler(1, 2, 3), new Vector3(2, -3, 4));
            Near(new Vector3(7, 8, 9), (odd * odd.inverse).MultiplyPoint(new Vector3(7, 8, 9)));
        }

        static HumanDescription Describe(GameObject root, Dictionary<string, string> bones)
        {
            List<SkeletonBone> skeleton = new List<SkeletonBone>();
            foreach (Transform at in root.GetComponentsInChildren<Transform>()) skeleton.Add(new SkeletonBone { name = at.name, position = at.localPosition, rotation = at.localRotation, scale = at.localScale });
            List<HumanBone> human = new List<HumanBone>();
            foreach (KeyValuePair<string, string> pair in bones) human.Add(new HumanBone { humanName = pair.Key, boneName = pair.Value });
            return new HumanDescription { human = human.ToArray(), skeleton = skeleton.ToArray() };
        }

        [Test]
        public void an_avatar_needs_its_required_bones_in_the_right_order_under_unique_names()
        {
            string[] chain = { "Hips", "Spine", "Head", "LeftUpperLeg", "LeftLowerLeg", "LeftFoot", "RightUpperLeg", "RightLowerLeg", "RightFoot", "LeftUpperArm", "LeftLowerArm", "LeftHand", "RightUpperArm", "RightLowerArm", "RightHand" };
            string[] parents = { null, "Hips", "Spine", "Hips", "LeftUpperLeg", "LeftLowerLeg", "Hips", "RightUpperLeg", "RightLowerLeg", "Spine", "LeftUpperArm", "LeftLowerArm", "Spine", "RightUpperArm", "RightLowerArm" };
            GameObject root = new GameObject("figure");
            Dictionary<string, Transform> made = new Dictionary<string, Transform>();
            Dictionary<string, string> map = new Dictionary<string, string>();
            for (int at = 0; at < chain.Length; at++)
            {
                Transform bone = made[chain[at]] = new GameObject("b_" + chain[at]).transform;
                bone.SetParent(parents[at] == null ? root.transform : made[parents[at]], false);
                bone.localPosition = new Vector3(0.1f * (at + 1), 0.2f, 0);
                map[chain[at]] = bone.name;
            }
            Assert.AreEqual(chain.Length, HumanTrait.RequiredBoneCount);
            Assert.AreEqual("Left Thumb Proximal", HumanTrait.BoneName[(int)HumanBodyBones.LeftThumbProximal]);
            Assert.AreEqual(54, (int)HumanBodyBones.UpperChest);
            Avatar good = AvatarBuilder.BuildHumanAvatar(root, Describe(root, map));
            Assert.That(good.isValid && good.isHuman);
            Animator animator = root.AddComponent<Animator>();
            Assert.Throws<InvalidOperationException>(delegate { animator.GetBoneTransform(HumanBodyBones.Head); });
            animator.avatar = good;
            Assert.AreSame(made["LeftFoot"], animator.GetBoneTransform(HumanBodyBones.LeftFoot));
            Assert.That(animator.GetBoneTransform(HumanBodyBones.Jaw) == null);

            Dictionary<string, string> without = new Dictionary<string, string>(map);
            without.Remove("LeftHand");
            Assert.That(AvatarBuilder.BuildHumanAvatar(root, Describe(root, without)).isValid, Is.False, "a required bone is missing");
            made["LeftFoot"].SetParent(root.transform, true);
            Assert.That(AvatarBuilder.BuildHumanAvatar(root, Describe(root, map)).isValid, Is.False, "a foot beside its leg");
            made["LeftFoot"].SetParent(made["LeftLowerLeg"], true);
            new GameObject("b_Head").transform.SetParent(root.transform, false);
            Assert.That(AvatarBuilder.BuildHumanAvatar(root, Describe(root, map)).isValid, Is.False, "two transforms of one name");
        }

        [Test]
        public void a_prefab_loses_references_to_what_is_no_asset()
        {
            GameObject root = new GameObject("thing");
            MeshFilter filter = root.AddComponent<MeshFilter>();
            filter.sharedMesh = Triangle();
            bool success;
            GameObject prefab = PrefabUtility.SaveAsPrefabAsset(root, "Assets/thing.prefab", out success);
            Assert.That(success && File.Exists("Assets/thing.prefab") && File.Exists("Assets/thing.prefab.meta"));
            Assert.That(prefab.GetComponent<MeshFilter>().sharedMesh == null);
            AssetDatabase.CreateAsset(filter.sharedMesh, "Assets/triangle.asset");
            prefab = PrefabUtility.SaveAsPrefabAsset(root, "Assets/thing.prefab", out success);
            Assert.AreSame(filter.sharedMesh, prefab.GetComponent<MeshFilter>().sharedMesh);
            GameObject instance = (GameObject)PrefabUtility.InstantiatePrefab(prefab);
            Assert.AreEqual("thing", instance.name);
            Assert.AreSame(prefab, PrefabUtility.GetCorrespondingObjectFromSource(instance));
            Assert.Throws<ArgumentException>(delegate { PrefabUtility.SaveAsPrefabAsset(root, "Assets/nowhere/thing.prefab"); });
            Assert.Throws<ArgumentException>(delegate { PrefabUtility.SaveAsPrefabAsset(root, "Assets/thing.asset"); });
        }

        [Test]
        public void assets_stand_in_folders_under_unique_paths_and_only_once()
        {
            Mesh mesh = Triangle();
            Assert.Throws<UnityException>(delegate { AssetDatabase.CreateAsset(mesh, "Assets/none/mesh.asset"); });
            Assert.Throws<UnityException>(delegate { AssetDatabase.CreateAsset(mesh, "/elsewhere/mesh.asset"); });
            string folder = AssetDatabase.GUIDToAssetPath(AssetDatabase.CreateFolder("Assets", "folder"));
            Assert.AreEqual("Assets/folder", folder);
            AssetDatabase.CreateAsset(mesh, "Assets/folder/mesh.asset");
            Assert.Throws<UnityException>(delegate { AssetDatabase.CreateAsset(mesh, "Assets/other.asset"); });
            Assert.AreEqual("Assets/folder/mesh 1.asset", AssetDatabase.GenerateUniqueAssetPath("Assets/folder/mesh.asset"));
            Mesh second = Triangle();
            AssetDatabase.AddObjectToAsset(second, mesh);
            Assert.That(AssetDatabase.IsSubAsset(second) && AssetDatabase.IsMainAsset(mesh));
            Assert.AreEqual("", AssetDatabase.MoveAsset("Assets/folder", "Assets/moved"));
            Assert.AreSame(mesh, AssetDatabase.LoadAssetAtPath<Mesh>("Assets/moved/mesh.asset"));
            Object.DestroyImmediate(mesh);
            Assert.That(mesh != null, "an asset is not destroyed by mistake");
            Assert.That(AssetDatabase.DeleteAsset("Assets/moved"));
            Assert.That(mesh == null && second == null && !Directory.Exists("Assets/moved"));
        }

        [Test]
        public void a_full_or_refusing_disk_fails_as_unity_fails()
        {
            StubDisk.FailAfterBytes = 10;
            Assert.Throws<UnityException>(delegate { AssetDatabase.CreateAsset(Triangle(), "Assets/mesh.asset"); });
            bool success;
            Assert.That(PrefabUtility.SaveAsPrefabAsset(new GameObject("a"), "Assets/a.prefab", out success) == null && !success);
            StubDisk.Reset();
            Mesh kept = Triangle();
            AssetDatabase.CreateAsset(kept, "Assets/kept.asset");
            StubDisk.Refuse = delegate (string path) { return path.EndsWith("kept.asset"); };
            AssetDatabase.AddObjectToAsset(Triangle(), kept);
            Log.Clear();
            AssetDatabase.SaveAssets();
            Assert.AreEqual(1, Log.Of(LogType.Error).Count, "an error in the console and no exception");
            Assert.That(EditorUtility.IsDirty(kept));
            Assert.That(File.Exists("Assets/a.prefab"), Is.False);
        }

        [Serializable] public class Saved { public float Amount = float.NaN; public List<string> Names = new List<string>(); public int[] Numbers; [NonSerialized] public int Skipped = 3; [SerializeField] int m_Hidden = 1; public int Hidden { get { return m_Hidden; } set { m_Hidden = value; } } }

        [Test]
        public void json_holds_the_serialized_fields()
        {
            Saved settings = new Saved { Amount = 0.25f, Numbers = new[] { 1, 2 }, Skipped = 9, Hidden = 7 };
            settings.Names.Add("日本語 \"x\"");
            string json = JsonUtility.ToJson(settings);
            StringAssert.DoesNotContain("Skipped", json);
            Saved read = JsonUtility.FromJson<Saved>(json);
            Assert.AreEqual(0.25f, read.Amount);
            Assert.AreEqual(settings.Names, read.Names);
            Assert.AreEqual(settings.Numbers, read.Numbers);
            Assert.AreEqual(7, read.Hidden);
            Assert.AreEqual(3, read.Skipped);
        }

        [Test]
        public void undo_restores_what_was_recorded_and_removes_what_was_created()
        {
            Transform place = new GameObject("place").transform;
            Undo.RecordObject(place, "move");
            place.localPosition = Vector3.one;
            Undo.IncrementCurrentGroup();
            GameObject made = new GameObject("made");
            Undo.RegisterCreatedObjectUndo(made, "make");
            Undo.PerformUndo();
            Assert.That(made == null);
            Near(Vector3.one, place.localPosition);
            Undo.PerformUndo();
            Near(Vector3.zero, place.localPosition);
        }

        [Test]
        public void a_fingerprint_sees_every_change_and_nothing_else()
        {
            GameObject root = new GameObject("root");
            SkinnedMeshRenderer renderer = root.AddComponent<SkinnedMeshRenderer>();
            Mesh mesh = renderer.sharedMesh = Triangle();
            mesh.AddBlendShapeFrame("smile", 100f, new Vector3[3], null, null);
            string before = Fingerprint.Of(root);
            Object.Instantiate(root);
            Vector3[] read = mesh.vertices;
            read[0] = Vector3.one;
            Assert.AreEqual(before, Fingerprint.Of(root));
            mesh.vertices = read;
            string moved = Fingerprint.Of(root);
            Assert.AreNotEqual(before, moved);
            renderer.SetBlendShapeWeight(0, 1f);
            Assert.AreNotEqual(moved, Fingerprint.Of(root));
        }
    }
}
