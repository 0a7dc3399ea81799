using System;
using NUnit.Framework;
using UnityEngine;
using UnityStubs;

namespace SuperDeform.Editor.Tests
{
    /// <summary>The preview of real characters stands where their conversion does.</summary>
    [TestFixture]
    public class PreviewModelsTests
    {
        [Test]
        public void quaternius_female_dress() { Check("quaternius_female_dress.glb"); }

        [Test]
        public void kaykit_rogue() { Check("kaykit_rogue.glb"); }

        [Test]
        public void seedsan() { Check("seedsan_vrm1.vrm"); }

        [Test]
        public void godette() { Check("godette.vrm"); }

        [Test]
        public void clothes_are_pushed_anew_when_a_slider_rests()
        {
            if (!Models.Has("kaykit_rogue.glb")) return;
            Model model = Models.Load("kaykit_rogue.glb");
            var settings = new ConversionSettings { Source = StyleSource.BuiltIn };
            using (var session = new PreviewSession(model.Root, settings))
            {
                GroupTunings.Change(settings, "torso", torso => torso.ThicknessScale = 1.3);
                session.Update(settings, true);
                using (var anew = new PreviewSession(model.Root, settings))
                {
                    Assert.That(Most(Shown(anew), Shown(session)), Is.GreaterThan(1e-3f), "pushed anew at every step of a slider");
                    session.Settle();
                    Assert.AreEqual(0, Most(Shown(anew), Shown(session)));
                }
                session.Settle();
                Assert.AreEqual(Repair.On, settings.Options.Repair);
            }
        }

        /// <summary>The window's preview and NDMF's do that by themselves.</summary>
        [Test]
        public void a_preview_that_rests_shows_what_is_converted()
        {
            if (!Models.Has("kaykit_rogue.glb")) return;
            Model model = Models.Load("kaykit_rogue.glb");
            ConverterWindow window = ConverterWindow.Open(null);
            try
            {
                window.Model.SetAvatar(model.Root);
                window.Controller.Tick(1);
                window.Model.Change("torso", () => GroupTunings.Change(window.Model.Settings, "torso", torso => torso.ThicknessScale = 1.3));
                window.Controller.Tick(2);
                Vector3[][] moving = Shown(window.Controller.Preview);
                window.Controller.Tick(3);
                using (var anew = new PreviewSession(model.Root, window.Model.Settings))
                {
                    Assert.That(Most(Shown(anew), moving), Is.GreaterThan(1e-3f));
                    Assert.AreEqual(0, Most(Shown(anew), Shown(window.Controller.Preview)));
                }
            }
            finally
            {
                window.Close();
            }
        }

        static float Most(Vector3[][] one, Vector3[][] other)
        {
            float most = 0;
            for (int mesh = 0; mesh < one.Length; mesh++)
            {
                for (int vertex = 0; vertex < one[mesh].Length; vertex++) most = Mathf.Max(most, (one[mesh][vertex] - other[mesh][vertex]).magnitude);
            }
            return most;
        }

        static Vector3[][] Shown(PreviewSession session)
        {
            return Array.ConvertAll(session.Proxy.GetComponentsInChildren<SkinnedMeshRenderer>(true), shown => shown.sharedMesh.vertices);
        }

        [Test]
        public void makehuman() { Check("makehuman_female_rigged.glb"); }

        [Test]
        public void mannequiny() { Check("gdquest_mannequiny.glb"); }

        static void Check(string file)
        {
            if (!Models.Has(file)) return;
            ulong handles = SuperDeformLibrary.LiveHandles;
            Model model = Models.Load(file);
            var settings = new ConversionSettings { Source = StyleSource.BuiltIn, PlaceInScene = false };
            using (var session = new PreviewSession(model.Root, settings))
            {
                // Posed after reading, as an artist does who looks at a preview.
                Animator animator = model.Root.GetComponent<Animator>();
                if (animator != null && animator.isHuman)
                {
                    foreach (HumanBodyBones bone in new[] { HumanBodyBones.LeftUpperArm, HumanBodyBones.RightLowerLeg })
                    {
                        animator.GetBoneTransform(bone).localRotation *= Quaternion.Euler(15, 5, 10);
                    }
                }
                session.Follow();
                GameObject prefab = Converter.Convert(model.Root, settings, null).Prefab;
                var result = (GameObject)UnityEditor.PrefabUtility.InstantiatePrefab(prefab);
                result.transform.position = model.Root.transform.position;
                result.transform.rotation = model.Root.transform.rotation;
                Renderer[] wanted = Array.FindAll(result.GetComponentsInChildren<Renderer>(true), HasMesh);
                SkinnedMeshRenderer[] shown = session.Proxy.GetComponentsInChildren<SkinnedMeshRenderer>(true);
                Assert.AreEqual(wanted.Length, shown.Length);
                float low = float.PositiveInfinity, high = float.NegativeInfinity, most = 0;
                for (int i = 0; i < wanted.Length; i++)
                {
                    Vector3[] one = World(wanted[i]), other = World(shown[i]);
                    Assert.AreEqual(one.Length, other.Length, wanted[i].name);
                    for (int vertex = 0; vertex < one.Length; vertex++)
                    {
                        low = Mathf.Min(low, one[vertex].y);
                        high = Mathf.Max(high, one[vertex].y);
                        most = Mathf.Max(most, (one[vertex] - other[vertex]).magnitude);
                    }
                }
                Console.WriteLine("{0}: {1:0.0e+0} of the height", file, most / (high - low));
                Assert.That(most, Is.LessThan(1e-5f * (high - low)));
            }
            Assert.AreEqual(handles, SuperDeformLibrary.LiveHandles, "live handles");
        }

        static bool HasMesh(Renderer renderer)
        {
            Mesh mesh = renderer is SkinnedMeshRenderer ? ((SkinnedMeshRenderer)renderer).sharedMesh
                : renderer.GetComponent<MeshFilter>() == null ? null : renderer.GetComponent<MeshFilter>().sharedMesh;
            return mesh != null && mesh.vertexCount > 0;
        }

        static Vector3[] World(Renderer renderer)
        {
            if (renderer is SkinnedMeshRenderer)
            {
                Vector3[] positions, normals;
                Skinning.Drawn((SkinnedMeshRenderer)renderer, Matrix4x4.identity, out positions, out normals);
                return positions;
            }
            Matrix4x4 place = renderer.transform.localToWorldMatrix;
            return Array.ConvertAll(renderer.GetComponent<MeshFilter>().sharedMesh.vertices, place.MultiplyPoint3x4);
        }
    }
}
