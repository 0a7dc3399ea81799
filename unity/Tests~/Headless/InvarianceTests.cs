// What makes no difference to how the result looks.
using System;
using System.Collections.Generic;
using NUnit.Framework;
using UnityEditor;
using UnityEngine;
using UnityStubs;

namespace SuperDeform.Editor.Tests
{
    [TestFixture]
    public class InvarianceTests
    {
        const float Tolerance = 1e-5f; // of the height

        sealed class Look
        {
            public readonly List<Vector3[]> Positions = new List<Vector3[]>(), Normals = new List<Vector3[]>();

            /// As drawn in the root's space, renderer after renderer, then once for each blend shape.
            public Look(GameObject root)
            {
                foreach (Renderer renderer in root.GetComponentsInChildren<Renderer>(true))
                {
                    SkinnedMeshRenderer skinned = renderer as SkinnedMeshRenderer;
                    float[] weights = new float[skinned == null ? 0 : skinned.sharedMesh.blendShapeCount];
                    for (int shape = 0; shape < weights.Length; shape++) { weights[shape] = skinned.GetBlendShapeWeight(shape); skinned.SetBlendShapeWeight(shape, 0f); }
                    Add(renderer, root);
                    for (int shape = 0; shape < weights.Length; shape++)
                    {
                        skinned.SetBlendShapeWeight(shape, 100f);
                        Add(renderer, root);
                        skinned.SetBlendShapeWeight(shape, 0f);
                    }
                    for (int shape = 0; shape < weights.Length; shape++) skinned.SetBlendShapeWeight(shape, weights[shape]);
                }
            }
            void Add(Renderer renderer, GameObject root)
            {
                Vector3[] positions, normals;
                Models.Drawn(renderer, root.transform, out positions, out normals);
                Positions.Add(positions); Normals.Add(normals);
            }
        }

        /// The look of the result, and what the source looked like. `change` is made to the source before.
        static Look Convert(Action<Model> change, out Look before, out float height)
        {
            Model model = Models.Load("kaykit_rogue.glb");
            foreach (SkinnedMeshRenderer renderer in model.Root.GetComponentsInChildren<SkinnedMeshRenderer>(true))
            {
                if (renderer.name == "Rogue_Head") SplitRenderers.AddShapes(renderer.sharedMesh, 4);
            }
            if (change != null) change(model);
            before = new Look(model.Root);
            height = Models.Height(model.Root);
            ConversionResult result = Converter.Convert(model.Root, new ConversionSettings { Heads = 4f }, null);
            return new Look(UnityEngine.Object.Instantiate(result.Prefab));
        }

        static void MakesNoDifference(Action<Model> change)
        {
            Look plain, changed;
            float height, otherHeight;
            Look expected = Convert(null, out plain, out height), actual = Convert(change, out changed, out otherHeight);
            Same(plain, changed, height, "the source already looks different: ");
            Same(expected, actual, height, "");
        }

        static void Same(Look one, Look two, float height, string what)
        {
            Assert.AreEqual(one.Positions.Count, two.Positions.Count);
            for (int at = 0; at < one.Positions.Count; at++)
            {
                Assert.That(ExampleTests.Farthest(one.Positions[at], two.Positions[at]) / height, Is.LessThan(Tolerance), what + "positions, look " + at);
                Assert.That(ExampleTests.Farthest(one.Normals[at], two.Normals[at]), Is.LessThan(1e-3f), what + "normals, look " + at);
            }
        }

        [Test]
        public void the_space_that_a_mesh_is_kept_in()
        {
            // As with armatures in centimetres that lie on their backs.
            Matrix4x4 to = Matrix4x4.TRS(new Vector3(0.1f, 0.2f, 0.3f), Quaternion.Euler(-90f, 20f, 0f), new Vector3(2.5f, 2.5f, 2.5f));
            MakesNoDifference(delegate (Model model)
            {
                foreach (Mesh mesh in model.Glb.Meshes)
                {
                    if (mesh.bindposes.Length == 0) continue;
                    mesh.vertices = Array.ConvertAll(mesh.vertices, to.MultiplyPoint3x4);
                    mesh.normals = Array.ConvertAll(mesh.normals, delegate (Vector3 n) { return to.MultiplyVector(n).normalized; });
                    mesh.bindposes = Array.ConvertAll(mesh.bindposes, delegate (Matrix4x4 bind) { return bind * to.inverse; });
                    mesh.RecalculateBounds();
                    Turn(mesh, to);
                }
            });
        }

        static void Turn(Mesh mesh, Matrix4x4 to)
        {
            List<KeyValuePair<string, float>> frames = new List<KeyValuePair<string, float>>();
            List<Vector3[][]> deltas = new List<Vector3[][]>();
            for (int shape = 0; shape < mesh.blendShapeCount; shape++)
            {
                for (int frame = 0; frame < mesh.GetBlendShapeFrameCount(shape); frame++)
                {
                    Vector3[] p = new Vector3[mesh.vertexCount], n = new Vector3[mesh.vertexCount];
                    mesh.GetBlendShapeFrameVertices(shape, frame, p, n, null);
                    frames.Add(new KeyValuePair<string, float>(mesh.GetBlendShapeName(shape), mesh.GetBlendShapeFrameWeight(shape, frame)));
                    deltas.Add(new[] { Array.ConvertAll(p, to.MultiplyVector), Array.ConvertAll(n, delegate (Vector3 v) { return to.MultiplyVector(v) / 2.5f; }) });
                }
            }
            mesh.ClearBlendShapes();
            for (int at = 0; at < frames.Count; at++) mesh.AddBlendShapeFrame(frames[at].Key, frames[at].Value, deltas[at][0], deltas[at][1], null);
        }

        [Test]
        public void where_the_avatar_stands_and_how_its_parent_is_scaled()
        {
            MakesNoDifference(delegate (Model model)
            {
                Transform stage = new GameObject("stage").transform;
                stage.localPosition = new Vector3(10, -3, 2);
                stage.localScale = new Vector3(0.5f, 0.5f, 0.5f);
                model.Root.transform.SetParent(stage, false);
                model.Root.transform.localPosition = new Vector3(-4, 1, 7);
                model.Root.transform.localRotation = Quaternion.Euler(0, 130, 0);
            });
        }

        [Test]
        public void the_order_of_the_objects_in_the_hierarchy()
        {
            // Renderers keep their order, so that the looks can be compared.
            MakesNoDifference(delegate (Model model)
            {
                foreach (Transform at in model.Root.GetComponentsInChildren<Transform>(true))
                {
                    if (at.parent != null && at.GetComponentInChildren<Renderer>(true) == null) at.SetAsFirstSibling();
                }
            });
        }

        [Test]
        public void whether_the_animator_knows_its_bones_yet()
        {
            MakesNoDifference(delegate { Settings.AnimatorsKnowTheirBones = false; });
        }

        [Test]
        public void whether_the_avatar_is_switched_on()
        {
            MakesNoDifference(delegate (Model model) { model.Root.SetActive(false); });
        }

        [Test]
        public void a_blend_shape_that_is_turned_up_a_bit()
        {
            Look plain, unused;
            float height;
            Look expected = Convert(null, out plain, out height);
            Look actual = Convert(delegate (Model model)
            {
                foreach (SkinnedMeshRenderer renderer in model.Root.GetComponentsInChildren<SkinnedMeshRenderer>(true))
                {
                    if (renderer.sharedMesh.blendShapeCount > 0) renderer.SetBlendShapeWeight(1, 70f);
                }
            }, out unused, out height);
            // The mesh is deformed without it, and the renderer keeps it.
            Same(expected, actual, height, "");
            GameObject prefab = AssetDatabase.LoadAssetAtPath<GameObject>(AssetDatabase.GUIDToAssetPath(AssetDatabase.FindAssets("t:Prefab")[0]));
            SkinnedMeshRenderer head = Array.Find(prefab.GetComponentsInChildren<SkinnedMeshRenderer>(true), delegate (SkinnedMeshRenderer at) { return at.sharedMesh.blendShapeCount > 0; });
            Assert.AreEqual(70f, head.GetBlendShapeWeight(1));
        }
    }
}
