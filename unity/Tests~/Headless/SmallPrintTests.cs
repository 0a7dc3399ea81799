using System;
using System.Collections.Generic;
using NUnit.Framework;
using UnityEditor;
using UnityEngine;
using UnityStubs;

namespace SuperDeform.Editor.Tests
{
    /// <summary>What nobody looks at until it is wrong: limits of muscles, margins of bounds, normals of worn shapes, quads.</summary>
    [TestFixture]
    public class SmallPrintTests
    {
        [SetUp]
        public void Begin()
        {
            Models.NewProject();
        }

        static ConversionSettings Settings()
        {
            return new ConversionSettings { Source = StyleSource.BuiltIn, BuiltInStyle = "sd2.5", OutputFolder = "Assets/Out", PlaceInScene = false };
        }

        [Test]
        public void limits_of_muscles_stay_as_they_were_set()
        {
            ConversionFigure figure = new ConversionFigure().Make();
            Animator animator = figure.Root.GetComponent<Animator>();
            HumanDescription given = animator.avatar.humanDescription;
            HumanBone[] bones = given.human;
            int elbow = Array.FindIndex(bones, bone => bone.humanName == "LeftLowerArm");
            bones[elbow].limit = new HumanLimit
            {
                useDefaultValues = false, min = new Vector3(-10, -20, -30), max = new Vector3(11, 22, 33), center = new Vector3(1, 2, 3), axisLength = 0.5f
            };
            given.human = bones;
            given.armStretch = 0.07f;
            given.legStretch = 0.08f;
            given.feetSpacing = 0.09f;
            given.lowerLegTwist = 0.4f;
            animator.avatar = AvatarBuilder.BuildHumanAvatar(figure.Root, given);
            HumanDescription made = Converter.Convert(figure.Root, Settings(), null).Prefab.GetComponent<Animator>().avatar.humanDescription;
            foreach (HumanBone bone in made.human)
            {
                HumanBone before = Array.Find(bones, other => other.humanName == bone.humanName);
                Assert.AreEqual(before.boneName, bone.boneName);
                Assert.AreEqual(before.limit.useDefaultValues, bone.limit.useDefaultValues, bone.humanName);
                Assert.AreEqual(before.limit.min, bone.limit.min);
                Assert.AreEqual(before.limit.max, bone.limit.max);
                Assert.AreEqual(before.limit.center, bone.limit.center);
                Assert.AreEqual(before.limit.axisLength, bone.limit.axisLength);
            }
            Assert.AreEqual(new[] { 0.07f, 0.08f, 0.09f, 0.4f }, new[] { made.armStretch, made.legStretch, made.feetSpacing, made.lowerLegTwist });
        }

        static Bounds Tight(SkinnedMeshRenderer renderer)
        {
            Vector3[] drawn = Drawing.Drawn(renderer, renderer.rootBone.worldToLocalMatrix);
            var box = new Bounds(drawn[0], Vector3.zero);
            foreach (Vector3 p in drawn) box.Encapsulate(p);
            return box;
        }

        [Test]
        public void margins_of_bounds_shrink_with_what_they_are_around()
        {
            ConversionFigure figure = new ConversionFigure().Make();
            Bounds before = Tight(figure.Body), wide = before;
            wide.Expand(1);
            figure.Body.localBounds = wide;
            GameObject prefab = Converter.Convert(figure.Root, Settings(), null).Prefab;
            var body = Array.Find(prefab.GetComponentsInChildren<SkinnedMeshRenderer>(true), renderer => renderer.name == "Body");
            Bounds after = Tight(body);
            float margin = 0.5f * after.size.magnitude / before.size.magnitude;
            Assert.That(margin, Is.LessThan(0.45f));
            for (int axis = 0; axis < 3; axis++)
            {
                Assert.AreEqual(margin, after.min[axis] - body.localBounds.min[axis], 1e-3f);
                Assert.AreEqual(margin, body.localBounds.max[axis] - after.max[axis], 1e-3f);
            }
        }

        [Test]
        public void normals_of_what_is_worn_are_those_of_the_result()
        {
            ConversionFigure figure = new ConversionFigure { Turned = true, WithShapes = true }.Make();
            figure.Body.SetBlendShapeWeight(0, 100);
            Vector3[] wanted = Normals(Converter.Convert(figure.Root, Settings(), null).Prefab);
            using (var session = new PreviewSession(figure.Root, Settings()))
            {
                Vector3[] shown = Normals(session.Proxy);
                for (int vertex = 0; vertex < wanted.Length; vertex++)
                {
                    Assert.That(Vector3.Distance(wanted[vertex], shown[vertex]), Is.LessThan(1e-3f), "vertex " + vertex);
                }
            }
            figure.Body.SetBlendShapeWeight(0, 0);
            Assert.That(Drawing.Apart(wanted, Normals(Converter.Convert(figure.Root, Settings(), null).Prefab)), Is.GreaterThan(0.02));
        }

        static Vector3[] Normals(GameObject root)
        {
            Vector3[] positions, normals;
            var body = Array.Find(root.GetComponentsInChildren<SkinnedMeshRenderer>(true), renderer => renderer.name == "Body");
            Skinning.Drawn(body, root.transform.worldToLocalMatrix, out positions, out normals);
            return Array.ConvertAll(normals, normal => normal.normalized);
        }

        [Test]
        public void a_quad_is_two_triangles_that_cover_it()
        {
            var mesh = new Mesh { name = "M", vertices = new[] { new Vector3(0, 0, 0), new Vector3(2, 0, 0), new Vector3(2, 3, 0), new Vector3(0, 3, 0), new Vector3(0, 4, 0), new Vector3(2, 4, 0) } };
            mesh.SetIndices(new[] { 0, 1, 2, 3, 3, 2, 5, 4 }, MeshTopology.Quads, 0);
            var holder = new GameObject("H");
            holder.AddComponent<MeshFilter>().sharedMesh = mesh;
            var shown = holder.AddComponent<MeshRenderer>();
            shown.sharedMaterials = new[] { new Material(Shader.Find("Standard")) };
            PartData part = SubmeshParts.Of(new RendererData { Renderer = shown, Shown = shown, Mesh = mesh, Vertices = mesh.vertices })[0];
            var areas = new List<float>();
            for (int corner = 0; corner < part.Indices.Length; corner += 3)
            {
                Vector3 a = mesh.vertices[part.Indices[corner]], b = mesh.vertices[part.Indices[corner + 1]], c = mesh.vertices[part.Indices[corner + 2]];
                areas.Add(Vector3.Cross(b - a, c - a).z / 2);
            }
            // All in the direction of their quads: 2 by 3, and 2 by 1.
            Assert.AreEqual(new[] { 3f, 3f, 1f, 1f }, areas.ToArray());
        }

        [Test]
        public void a_point_of_something_outside_the_avatar_stays()
        {
            ConversionFigure figure = new ConversionFigure().Make();
            Transform outside = new GameObject("Lamp").transform;
            outside.position = new Vector3(1, 2, 3);
            using (AvatarData data = CharacterReader.Read(figure.Root, new ReadOptions()))
            using (Style style = Settings().MakeStyle())
            using (var deformer = new Deformer(data.Character, style, Settings().Options))
            {
                var result = new AvatarResult(data, false);
                result.Apply(deformer, null);
                var map = new PointMap(data, result, deformer, figure.Root.transform);
                Assert.That(map.HeightRatio, Is.LessThan(0.95f));
                Assert.AreEqual(new Vector3(0.5f, 0.25f, 4), map.Point(outside, new Vector3(0.5f, 0.25f, 4)));
                Assert.AreEqual(1f, map.Scale(outside, new Vector3(0.5f, 0.25f, 4)));
            }
        }
    }
}
