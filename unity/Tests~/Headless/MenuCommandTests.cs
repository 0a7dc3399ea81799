// The menu command, as an artist uses it: select an avatar, convert, look at the prefab.
using System;
using System.Collections.Generic;
using NUnit.Framework;
using SuperDeform.Tests.Glb;
using UnityEditor;
using UnityEngine;
using UnityStubs;

namespace SuperDeform.Editor.Tests
{
    [TestFixture]
    public class MenuCommandTests
    {
        const string Command = "GameObject/Super Deform/Convert selected avatar";

        /// Runs the command on an avatar and gives the prefab.
        static GameObject Convert(GameObject avatar)
        {
            Selection.activeGameObject = avatar;
            Assert.That(StubMenu.Execute(Command), "the command refuses '" + avatar.name + "'");
            Assert.That(Log.Of(LogType.Error), Is.Empty);
            string[] found = AssetDatabase.FindAssets("t:Prefab");
            Assert.AreEqual(1, found.Length, "prefabs");
            return AssetDatabase.LoadAssetAtPath<GameObject>(AssetDatabase.GUIDToAssetPath(found[0]));
        }

        [Test]
        public void the_command_is_for_one_humanoid_avatar()
        {
            Model model = Models.Load("kaykit_rogue.glb");
            Selection.activeGameObject = null;
            Assert.AreEqual(false, StubMenu.Validate(Command));
            Selection.activeGameObject = model.Root.transform.GetChild(0).gameObject;
            Assert.AreEqual(false, StubMenu.Validate(Command));
            Selection.objects = new UnityEngine.Object[] { model.Root, new GameObject("other") };
            Assert.AreEqual(false, StubMenu.Validate(Command));
            Selection.activeGameObject = model.Root;
            Assert.AreEqual(true, StubMenu.Validate(Command));
        }

        [Test]
        public void the_command_makes_a_prefab_with_everything_and_leaves_the_source_alone()
        {
            Model model = Models.Load("kaykit_rogue.glb");
            string before = Fingerprint.Of(model.Root);
            LastSettings.Write(new ConversionSettings { Heads = 1.8f });
            GameObject prefab = Convert(model.Root);
            Assert.AreEqual(before, Fingerprint.Of(model.Root), "the source changed");
            CheckPrefab(model.Root, prefab);
        }

        [Test]
        public void undo_takes_the_instance_away_and_leaves_the_assets()
        {
            Model model = Models.Load("kaykit_rogue.glb");
            GameObject prefab = Convert(model.Root);
            GameObject instance = GameObject.Find(prefab.name);
            Assert.That(instance != null, "an instance beside the source");
            Assert.AreSame(prefab, PrefabUtility.GetCorrespondingObjectFromSource(instance));
            Undo.PerformUndo();
            Assert.That(instance == null, "the instance is still there");
            Assert.That(model.Root != null && prefab != null);
            Assert.That(System.IO.File.Exists(AssetDatabase.GetAssetPath(prefab)));
        }

        [Test]
        public void a_bar_shows_the_progress_and_goes_away()
        {
            Model model = Models.Load("kaykit_rogue.glb");
            Settings.BatchMode = false;
            Convert(model.Root);
            Assert.That(Dialogs.Bars.Count, Is.GreaterThan(5));
            Assert.That(Dialogs.BarOpen, Is.False);
            Assert.That(Dialogs.Shown, Is.Empty, "dialogs");
        }

        [Test]
        public void cancel_on_the_bar_stops_and_leaves_nothing()
        {
            Model model = Models.Load("kaykit_rogue.glb");
            string[] before = StubProject.FilesOnDisk();
            string fingerprint = Fingerprint.Of(model.Root);
            Settings.BatchMode = false;
            Dialogs.Cancel = delegate (float fraction) { return fraction > 0.3f; };
            Selection.activeGameObject = model.Root;
            StubMenu.Execute(Command);
            Assert.That(Dialogs.BarOpen, Is.False);
            Assert.AreEqual(before, StubProject.FilesOnDisk());
            Assert.AreEqual(fingerprint, Fingerprint.Of(model.Root));
            Assert.AreEqual(1, model.Root.scene.rootCount, "objects in the scene");
            Assert.That(Log.Of(LogType.Exception), Is.Empty);
        }

        [Test]
        public void batch_mode_shows_neither_dialog_nor_bar()
        {
            Model model = Models.Load("kaykit_rogue.glb");
            Convert(model.Root); // a dialog would throw
            Assert.That(Dialogs.Bars, Is.Empty);
        }

        /// 12 renderers, 50 blend shapes, 132 bones.
        [Test]
        public void an_avatar_of_12_renderers_with_50_blend_shapes_keeps_all_of_it()
        {
            if (!Models.Has("seedsan_vrm1.vrm")) return;
            Models.NewProject();
            Model model = new Model { File = Models.Find("seedsan_vrm1.vrm"), AssetPath = "Assets/Models/seedsan.fbx" };
            model.Glb = GlbLoader.Load(model.File, null);
            SplitRenderers.Into(model, 12, 50);
            Models.Import(model);
            Assert.AreEqual(12, model.Root.GetComponentsInChildren<SkinnedMeshRenderer>(true).Length);
            string before = Fingerprint.Of(model.Root);
            GameObject prefab = Convert(model.Root);
            Assert.AreEqual(before, Fingerprint.Of(model.Root), "the source changed");
            int shapes = CheckPrefab(model.Root, prefab);
            Assert.AreEqual(50, shapes);
        }

        /// All renderers, shapes, bones and materials; bind poses that fit; files that hold everything. Gives the number of blend shapes.
        internal static int CheckPrefab(GameObject source, GameObject prefab)
        {
            Assert.That(EditorUtility.IsPersistent(prefab));
            Renderer[] old = source.GetComponentsInChildren<Renderer>(true), made = prefab.GetComponentsInChildren<Renderer>(true);
            Assert.AreEqual(old.Length, made.Length, "renderers");
            float height = Models.Height(source);
            int shapes = 0;
            for (int at = 0; at < old.Length; at++)
            {
                Mesh a = Models.MeshOf(old[at]), b = Models.MeshOf(made[at]);
                Assert.AreEqual(old[at].name, made[at].name);
                Assert.That(b != null && AssetDatabase.Contains(b), "the mesh of " + made[at].name + " is no asset");
                Assert.AreNotSame(a, b, "the mesh of " + made[at].name + " is the source's");
                Assert.AreEqual(old[at].sharedMaterials, made[at].sharedMaterials);
                CheckMesh(a, b);
                SkinnedMeshRenderer before = old[at] as SkinnedMeshRenderer, after = made[at] as SkinnedMeshRenderer;
                if (before == null) continue;
                CheckBones(before, after, prefab, height);
                shapes += CheckShapes(a, b);
            }
            CheckAvatar(source, prefab);
            Assert.AreEqual(source.GetComponentsInChildren<Component>(true).Length, prefab.GetComponentsInChildren<Component>(true).Length, "components");
            return shapes;
        }

        static void CheckMesh(Mesh a, Mesh b)
        {
            Assert.AreEqual(a.vertexCount, b.vertexCount, b.name);
            Assert.AreEqual(a.subMeshCount, b.subMeshCount, b.name);
            for (int part = 0; part < a.subMeshCount; part++) Assert.AreEqual(a.GetIndices(part), b.GetIndices(part), b.name + ": triangles");
            Assert.AreEqual(a.uv, b.uv, b.name + ": UVs");
            Assert.AreEqual(a.colors, b.colors, b.name + ": colours");
            Assert.AreEqual(a.indexFormat, b.indexFormat);
            Assert.AreEqual(a.normals.Length, b.normals.Length);
            Assert.AreEqual(a.tangents.Length, b.tangents.Length);
            Assert.That(b.bounds.size.magnitude, Is.GreaterThan(0f));
            foreach (Vector3 p in b.vertices) Assert.That(b.bounds.SqrDistance(p), Is.LessThan(1e-8f), b.name + ": bounds");
        }

        // At rest every bone of a vertex takes it to the same place: matrix x bind pose is one matrix for the whole mesh.
        static void CheckBones(SkinnedMeshRenderer before, SkinnedMeshRenderer after, GameObject prefab, float height)
        {
            Transform[] bones = after.bones;
            Assert.AreEqual(before.bones.Length, bones.Length, "bones of " + after.name);
            foreach (Transform bone in bones) Assert.That(bone != null && bone.IsChildOf(prefab.transform), "a bone of " + after.name + " is outside the prefab");
            for (int at = 0; at < bones.Length; at++) Assert.AreEqual(before.bones[at].name, bones[at].name);
            Assert.That(after.rootBone != null && after.rootBone.IsChildOf(prefab.transform));
            Mesh mesh = after.sharedMesh;
            Matrix4x4[] binds = mesh.bindposes;
            Assert.AreEqual(bones.Length, binds.Length);
            byte[] counts = mesh.GetBonesPerVertex().ToArray();
            BoneWeight1[] weights = mesh.GetAllBoneWeights().ToArray();
            BoneWeight1[] sourceWeights = before.sharedMesh.GetAllBoneWeights().ToArray();
            Assert.AreEqual(sourceWeights, weights, "weights of " + after.name);
            Vector3[] vertices = mesh.vertices;
            Matrix4x4[] skin = new Matrix4x4[binds.Length];
            for (int bone = 0; bone < binds.Length; bone++) skin[bone] = prefab.transform.worldToLocalMatrix * bones[bone].localToWorldMatrix * binds[bone];
            Matrix4x4 common = skin[weights[0].boneIndex];
            float far = 0f;
            int slot = 0;
            for (int vertex = 0; vertex < vertices.Length; vertex++)
            {
                Assert.That(counts[vertex], Is.GreaterThan(0));
                for (int end = slot + counts[vertex]; slot < end; slot++)
                {
                    far = Math.Max(far, (skin[weights[slot].boneIndex].MultiplyPoint3x4(vertices[vertex]) - common.MultiplyPoint3x4(vertices[vertex])).magnitude / height);
                }
            }
            Assert.That(far, Is.LessThan(1e-5f), after.name + ": skinning the rest pose does not give the mesh");
            // The renderer's box holds what it draws.
            Vector3[] drawn, normals;
            Skinning.Drawn(after, after.rootBone.worldToLocalMatrix, out drawn, out normals);
            foreach (Vector3 p in drawn) Assert.That(Mathf.Sqrt(after.localBounds.SqrDistance(p)) * after.rootBone.lossyScale.magnitude, Is.LessThan(1e-4f * height), after.name + ": local bounds");
        }

        static int CheckShapes(Mesh a, Mesh b)
        {
            Assert.AreEqual(a.blendShapeCount, b.blendShapeCount, b.name);
            Vector3[] p = new Vector3[a.vertexCount], q = new Vector3[a.vertexCount], n = new Vector3[a.vertexCount], m = new Vector3[a.vertexCount];
            for (int shape = 0; shape < a.blendShapeCount; shape++)
            {
                Assert.AreEqual(a.GetBlendShapeName(shape), b.GetBlendShapeName(shape));
                Assert.AreEqual(a.GetBlendShapeFrameCount(shape), b.GetBlendShapeFrameCount(shape));
                for (int frame = 0; frame < a.GetBlendShapeFrameCount(shape); frame++)
                {
                    Assert.AreEqual(a.GetBlendShapeFrameWeight(shape, frame), b.GetBlendShapeFrameWeight(shape, frame));
                    a.GetBlendShapeFrameVertices(shape, frame, p, n, null);
                    b.GetBlendShapeFrameVertices(shape, frame, q, m, null);
                    double before = 0, after = 0;
                    bool same = true;
                    for (int vertex = 0; vertex < p.Length; vertex++)
                    {
                        before += p[vertex].magnitude; after += q[vertex].magnitude;
                        if (p[vertex].magnitude == 0f) Assert.That(q[vertex].magnitude, Is.EqualTo(0f), "a vertex that did not move moves");
                        same &= p[vertex].Equals(q[vertex]);
                    }
                    // Deltas go with the part that they move: a figure of 2.5 heads neither loses nor blows up what a shape does.
                    if (before > 0) Assert.That(after / before, Is.InRange(0.1, 10.0), a.GetBlendShapeName(shape));
                    if (before > 0) Assert.That(same, Is.False, a.GetBlendShapeName(shape) + " was not transformed");
                }
            }
            return a.blendShapeCount;
        }

        static void CheckAvatar(GameObject source, GameObject prefab)
        {
            Animator before = source.GetComponent<Animator>(), after = prefab.GetComponent<Animator>();
            Assert.That(after.avatar != null && after.avatar.isValid && after.avatar.isHuman, "Avatar");
            Assert.AreNotSame(before.avatar, after.avatar);
            Assert.That(AssetDatabase.Contains(after.avatar), "the Avatar is no asset");
            for (HumanBodyBones bone = 0; bone < HumanBodyBones.LastBone; bone++)
            {
                Transform a = before.GetBoneTransform(bone), b = after.GetBoneTransform(bone);
                Assert.AreEqual(a == null, b == null, bone.ToString());
                if (a != null) Assert.AreEqual(a.name, b.name);
            }
            // Transforms keep their places in the tree; the Avatar's skeleton stands as the prefab does.
            Transform[] all = source.GetComponentsInChildren<Transform>(true), twins = prefab.GetComponentsInChildren<Transform>(true);
            Assert.AreEqual(all.Length, twins.Length);
            Dictionary<string, SkeletonBone> skeleton = new Dictionary<string, SkeletonBone>();
            foreach (SkeletonBone bone in after.avatar.humanDescription.skeleton) skeleton[bone.name] = bone;
            int moved = 0;
            for (int at = 1; at < all.Length; at++)
            {
                Assert.AreEqual(all[at].name, twins[at].name);
                if (at > 1 && all[at].parent != source.transform) Assert.AreEqual(all[at].parent.name, twins[at].parent.name);
                if (all[at].localPosition != twins[at].localPosition) moved++;
                SkeletonBone bone;
                if (skeleton.TryGetValue(twins[at].name, out bone)) Assert.That((bone.position - twins[at].localPosition).magnitude, Is.LessThan(1e-4f), "skeleton bone " + bone.name);
            }
            Assert.That(moved, Is.GreaterThan(10), "joints that moved");
        }
    }

    /// Makes many renderers of the few that a file has, and blend shapes where it has none.
    internal static class SplitRenderers
    {
        public static void Into(Model model, int rendererCount, int shapeCount)
        {
            // Submeshes are dealt out in order; each renderer gets a mesh with just the vertices that it draws.
            List<SkinnedMeshRenderer> sources = new List<SkinnedMeshRenderer>(model.Root.GetComponentsInChildren<SkinnedMeshRenderer>(true));
            int total = 0, least = sources.Count;
            foreach (SkinnedMeshRenderer source in sources) total += source.sharedMesh.subMeshCount;
            model.Glb.Meshes.Clear();
            int left = rendererCount;
            foreach (SkinnedMeshRenderer source in sources)
            {
                Mesh whole = source.sharedMesh;
                int pieces = Math.Max(1, Math.Min(whole.subMeshCount, left - --least));
                if (least == 0) pieces = left;
                if (pieces > whole.subMeshCount) throw new InvalidOperationException("too few submeshes for " + rendererCount + " renderers");
                left -= pieces;
                for (int piece = 0; piece < pieces; piece++)
                {
                    int from = whole.subMeshCount * piece / pieces, to = whole.subMeshCount * (piece + 1) / pieces;
                    Mesh part = Part(whole, from, to);
                    part.name = whole.name + (pieces > 1 ? "_" + piece : "");
                    model.Glb.Meshes.Add(part);
                    SkinnedMeshRenderer into = source;
                    if (piece > 0)
                    {
                        GameObject made = new GameObject(source.name + " part " + piece);
                        made.transform.SetParent(source.transform.parent, false);
                        into = made.AddComponent<SkinnedMeshRenderer>();
                        into.bones = source.bones;
                        into.rootBone = source.rootBone;
                        into.localBounds = source.localBounds;
                    }
                    Material[] materials = new Material[to - from];
                    Array.Copy(source.sharedMaterials, from, materials, 0, to - from);
                    if (piece == pieces - 1) { into.sharedMaterials = materials; into.sharedMesh = part; }
                    else { into.sharedMesh = part; if (piece > 0) into.sharedMaterials = materials; else s_Later[into] = materials; }
                }
            }
            foreach (KeyValuePair<SkinnedMeshRenderer, Material[]> pair in s_Later) pair.Key.sharedMaterials = pair.Value;
            s_Later.Clear();
            AddShapes(model.Glb.Meshes.Find(delegate (Mesh mesh) { return mesh.name.StartsWith("head"); }), shapeCount);
        }

        /// Waves of a few millimetres; every third with normals, the first in two frames.
        public static void AddShapes(Mesh head, int shapeCount)
        {
            Vector3[] places = head.vertices;
            for (int shape = 0; shape < shapeCount; shape++)
            {
                Vector3[] deltas = new Vector3[places.Length], turned = shape % 3 == 0 ? new Vector3[places.Length] : null;
                for (int vertex = 0; vertex < deltas.Length; vertex++)
                {
                    if ((vertex + shape) % 4 == 0) continue;
                    Vector3 p = places[vertex] * 40f;
                    deltas[vertex] = new Vector3(Mathf.Sin(p.y + shape), Mathf.Cos(p.x - shape), Mathf.Sin(p.z * 2f + shape)) * 0.004f;
                    if (turned != null) turned[vertex] = new Vector3(Mathf.Cos(p.y), 0f, Mathf.Sin(p.x)) * 0.1f;
                }
                if (shape == 0) head.AddBlendShapeFrame("shape 0", 50f, deltas, turned, null);
                if (shape == 0) deltas = Array.ConvertAll(deltas, delegate (Vector3 v) { return v * 1.5f; });
                head.AddBlendShapeFrame("shape " + shape, 100f, deltas, turned, null);
            }
        }
        static readonly Dictionary<SkinnedMeshRenderer, Material[]> s_Later = new Dictionary<SkinnedMeshRenderer, Material[]>();

        static Mesh Part(Mesh whole, int from, int to)
        {
            Dictionary<int, int> renumbered = new Dictionary<int, int>();
            List<int> kept = new List<int>();
            List<int[]> corners = new List<int[]>();
            for (int part = from; part < to; part++)
            {
                corners.Add(Array.ConvertAll(whole.GetIndices(part), delegate (int vertex)
                {
                    int index;
                    if (!renumbered.TryGetValue(vertex, out index)) { renumbered[vertex] = index = kept.Count; kept.Add(vertex); }
                    return index;
                }));
            }
            Mesh made = new Mesh();
            made.indexFormat = whole.indexFormat;
            made.vertices = Pick(whole.vertices, kept);
            if (whole.normals.Length > 0) made.normals = Pick(whole.normals, kept);
            if (whole.tangents.Length > 0) made.tangents = Pick(whole.tangents, kept);
            if (whole.uv.Length > 0) made.uv = Pick(whole.uv, kept);
            made.boneWeights = Pick(whole.boneWeights, kept);
            made.bindposes = whole.bindposes;
            made.subMeshCount = corners.Count;
            for (int part = 0; part < corners.Count; part++) made.SetTriangles(corners[part], part);
            return made;
        }
        static T[] Pick<T>(T[] from, List<int> kept) { return kept.ConvertAll(delegate (int vertex) { return from[vertex]; }).ToArray(); }
    }
}
