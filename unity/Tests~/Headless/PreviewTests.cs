using System;
using System.Collections.Generic;
using NUnit.Framework;
using UnityEngine;
using UnityStubs;

namespace SuperDeform.Editor.Tests
{
    [TestFixture]
    public class PreviewTests
    {
        // 1e-5 of the figure's height of 1.6.
        const float Tolerance = 1.6e-5f;

        WindowFigure figure;
        ConversionSettings settings;
        ulong handles;

        [SetUp]
        public void Begin()
        {
            Models.NewProject();
            handles = SuperDeformLibrary.LiveHandles;
            figure = new WindowFigure("Mika", 4000, 2);
            settings = new ConversionSettings { Source = StyleSource.BuiltIn, PlaceInScene = false };
        }

        [TearDown]
        public void NothingIsLeft()
        {
            Assert.AreEqual(handles, SuperDeformLibrary.LiveHandles, "live handles");
        }

        static Vector3[] World(SkinnedMeshRenderer renderer)
        {
            Vector3[] positions, normals;
            Skinning.Drawn(renderer, Matrix4x4.identity, out positions, out normals);
            return positions;
        }

        static int OfPreviews()
        {
            return Array.FindAll(Resources.FindObjectsOfTypeAll<GameObject>(), Hidden).Length
                + Array.FindAll(Resources.FindObjectsOfTypeAll<Mesh>(), Hidden).Length;
        }

        static bool Hidden(UnityEngine.Object candidate)
        {
            return candidate.hideFlags == HideFlags.HideAndDontSave;
        }

        static SkinnedMeshRenderer Proxy(PreviewSession session, string name)
        {
            return Array.Find(session.Proxy.GetComponentsInChildren<SkinnedMeshRenderer>(true),
                renderer => renderer.name == name);
        }

        static float Distance(Vector3[] one, Vector3[] other)
        {
            Assert.AreEqual(one.Length, other.Length);
            float most = 0;
            for (int i = 0; i < one.Length; i++) most = Mathf.Max(most, (one[i] - other[i]).magnitude);
            return most;
        }

        static Vector3[] Rigid(MeshRenderer renderer)
        {
            return Array.ConvertAll(renderer.GetComponent<MeshFilter>().sharedMesh.vertices,
                vertex => renderer.transform.localToWorldMatrix.MultiplyPoint3x4(vertex));
        }

        // Where the vertices of a conversion stand when its prefab is put where the avatar is.
        Vector3[][] Converted()
        {
            GameObject prefab = Converter.Convert(figure.Root, settings, null).Prefab;
            var instance = (GameObject)UnityEditor.PrefabUtility.InstantiatePrefab(prefab);
            instance.transform.position = figure.Root.transform.position;
            instance.transform.rotation = figure.Root.transform.rotation;
            Vector3[] body = World(instance.GetComponentInChildren<SkinnedMeshRenderer>(true));
            Vector3[] hat = Rigid(instance.GetComponentInChildren<MeshRenderer>(true));
            UnityEngine.Object.DestroyImmediate(instance);
            return new[] { body, hat };
        }

        void SameAsConverted(PreviewSession session)
        {
            Vector3[][] wanted = Converted();
            Assert.That(Distance(wanted[0], World(Proxy(session, "body"))), Is.LessThan(Tolerance), "body");
            Assert.That(Distance(wanted[1], World(Proxy(session, "hat"))), Is.LessThan(Tolerance), "hat");
        }

        [Test]
        public void the_preview_is_what_a_conversion_gives()
        {
            using (var session = new PreviewSession(figure.Root, settings))
            {
                Assert.That(Distance(World(figure.Body), World(Proxy(session, "body"))), Is.GreaterThan(0.1f), "nothing moved");
                SameAsConverted(session);
            }
        }

        [Test]
        public void the_preview_is_what_a_conversion_gives_in_another_pose_and_place()
        {
            figure.Root.transform.position = new Vector3(3, 1, -2);
            figure.Root.transform.rotation = Quaternion.Euler(0, 40, 0);
            figure["LeftUpperArm"].localRotation = Quaternion.Euler(10, 20, 50);
            figure["RightUpperLeg"].localRotation = Quaternion.Euler(-40, 0, 5);
            figure["Head"].localRotation = Quaternion.Euler(0, 30, 0);
            using (var session = new PreviewSession(figure.Root, settings)) SameAsConverted(session);
        }

        [Test]
        public void every_kind_of_change_gives_what_a_new_preview_gives()
        {
            var changes = new List<Action>
            {
                () => settings.Options.FaceSquash = 0.3f,
                () => settings.Options.FaceCurve = FaceCurve.Sphere,
                () => GroupTunings.Change(settings, "upper_leg", leg => leg.LengthScale = 0.7),
                () => GroupTunings.Change(settings, "torso", torso => torso.ThicknessScale = 1.1),
                () => settings.Options.FaceSquash = float.NaN,
                () => settings.Options.Amount = 0.5f,
                () => settings.Options.HeadScale = 1.2f,
                () => settings.BuiltInStyle = "sd3",
                () => { settings.Source = StyleSource.Heads; settings.Heads = 3; },
                () => GroupTunings.Clear(settings)
            };
            using (var session = new PreviewSession(figure.Root, settings))
            {
                foreach (Action change in changes)
                {
                    Vector3[] before = Proxy(session, "body").sharedMesh.vertices;
                    change();
                    session.Update(settings);
                    Vector3[] after = Proxy(session, "body").sharedMesh.vertices;
                    Assert.That(Distance(before, after), Is.GreaterThan(0), "change " + changes.IndexOf(change) + " did nothing");
                    using (var anew = new PreviewSession(figure.Root, settings))
                    {
                        Assert.AreEqual(Proxy(anew, "body").sharedMesh.vertices, after, "change " + changes.IndexOf(change));
                        Assert.AreEqual(Proxy(anew, "body").sharedMesh.normals, Proxy(session, "body").sharedMesh.normals);
                        Assert.AreEqual(Proxy(anew, "body").sharedMesh.bindposes, Proxy(session, "body").sharedMesh.bindposes);
                        anew.ShowBefore = true;
                    }
                }
            }
        }

        [Test]
        public void an_amount_of_0_is_the_avatar_as_it_stands()
        {
            figure["LeftUpperArm"].localRotation = Quaternion.Euler(0, 0, 60);
            settings.Options.Amount = 0;
            settings.Options.FaceSquash = 0;
            using (var session = new PreviewSession(figure.Root, settings))
            {
                Assert.That(Distance(World(figure.Body), World(Proxy(session, "body"))), Is.LessThan(Tolerance));
                Assert.That(Distance(Rigid(figure.Hat), World(Proxy(session, "hat"))), Is.LessThan(Tolerance));
            }
        }

        [Test]
        public void the_proxy_has_no_blend_shapes_and_is_never_saved()
        {
            using (var session = new PreviewSession(figure.Root, settings))
            {
                Assert.AreEqual(2, figure.Body.sharedMesh.blendShapeCount);
                foreach (Transform part in session.Proxy.GetComponentsInChildren<Transform>(true))
                {
                    Assert.AreEqual(HideFlags.HideAndDontSave, part.gameObject.hideFlags, part.name);
                }
                foreach (SkinnedMeshRenderer renderer in session.Proxy.GetComponentsInChildren<SkinnedMeshRenderer>(true))
                {
                    Assert.AreEqual(0, renderer.sharedMesh.blendShapeCount);
                    Assert.AreEqual(HideFlags.HideAndDontSave, renderer.sharedMesh.hideFlags);
                    Assert.AreNotSame(figure.Body.sharedMesh, renderer.sharedMesh);
                }
            }
        }

        [Test]
        public void the_avatar_is_hidden_only_while_the_result_is_in_its_place()
        {
            var session = new PreviewSession(figure.Root, settings);
            Assert.IsTrue(figure.Body.forceRenderingOff && figure.Hat.forceRenderingOff);
            Assert.IsTrue(Proxy(session, "body").enabled);
            session.ShowBefore = true;
            Assert.IsFalse(figure.Body.forceRenderingOff || figure.Hat.forceRenderingOff);
            Assert.IsFalse(Proxy(session, "body").enabled);
            session.ShowBefore = false;
            session.Beside = true;
            Assert.IsFalse(figure.Body.forceRenderingOff);
            Assert.IsTrue(Proxy(session, "body").enabled);
            session.Beside = false;
            Assert.IsTrue(figure.Body.forceRenderingOff);
            session.Dispose();
            Assert.IsFalse(figure.Body.forceRenderingOff || figure.Hat.forceRenderingOff);
        }

        [Test]
        public void what_somebody_else_hid_stays_hidden()
        {
            figure.Hat.forceRenderingOff = true;
            figure.Body.enabled = false;
            using (var session = new PreviewSession(figure.Root, settings)) Assert.IsFalse(Proxy(session, "body").enabled);
            Assert.IsTrue(figure.Hat.forceRenderingOff);
            Assert.IsFalse(figure.Body.forceRenderingOff);
        }

        [Test]
        public void beside_stands_clear_of_the_avatar()
        {
            using (var session = new PreviewSession(figure.Root, settings) { Beside = true })
            {
                float right = float.NegativeInfinity, left = float.PositiveInfinity;
                foreach (Vector3 vertex in World(figure.Body)) right = Mathf.Max(right, vertex.x);
                foreach (Vector3 vertex in World(Proxy(session, "body"))) left = Mathf.Min(left, vertex.x);
                Assert.That(left, Is.GreaterThan(right));
            }
        }

        [Test]
        public void a_sitting_preview_has_its_knees_before_its_hips_and_stands_up_again()
        {
            using (var session = new PreviewSession(figure.Root, settings))
            {
                Vector3[] standing = World(Proxy(session, "body"));
                session.Pose = PreviewPose.Sits;
                Transform hips = session.Proxy.transform.Find("Hips"), knee = hips.Find("LeftUpperLeg/LeftLowerLeg");
                Transform foot = knee.Find("LeftFoot");
                Assert.That(knee.position.z - hips.position.z, Is.GreaterThan(Mathf.Abs(knee.position.y - hips.Find("LeftUpperLeg").position.y)));
                Assert.That(foot.position.y, Is.LessThan(knee.position.y));
                Assert.That(Distance(standing, World(Proxy(session, "body"))), Is.GreaterThan(0.05f));
                session.Pose = PreviewPose.AsItStands;
                Assert.That(Distance(standing, World(Proxy(session, "body"))), Is.LessThan(Tolerance));
            }
        }

        [Test]
        public void walking_puts_one_foot_before_the_other_and_the_arms_down()
        {
            using (var session = new PreviewSession(figure.Root, settings) { Pose = PreviewPose.Walks })
            {
                Transform hips = session.Proxy.transform.Find("Hips");
                Assert.That(hips.Find("LeftUpperLeg/LeftLowerLeg/LeftFoot").position.z,
                    Is.GreaterThan(hips.Find("RightUpperLeg/RightLowerLeg/RightFoot").position.z + 0.05f));
                Transform arm = hips.Find("Spine/Chest/LeftShoulder/LeftUpperArm");
                Assert.That(arm.Find("LeftLowerArm").position.y, Is.LessThan(arm.position.y));
            }
        }

        [Test]
        public void the_preview_follows_an_avatar_that_is_moved_and_posed()
        {
            using (var session = new PreviewSession(figure.Root, settings))
            {
                Assert.IsFalse(session.Follow());
                figure.Root.transform.position = new Vector3(0, 0, 5);
                figure["RightUpperArm"].localRotation = Quaternion.Euler(0, 0, -60);
                figure["Hips"].localPosition += new Vector3(0, 0.05f, 0);
                Assert.IsTrue(session.Follow());
                Assert.IsFalse(session.Follow());
                SameAsConverted(session);
            }
        }

        [Test]
        public void a_preview_that_is_cancelled_leaves_nothing()
        {
            var progress = new Refusal();
            var reason = Assert.Throws<ConversionException>(() => new PreviewSession(figure.Root, settings, progress));
            Assert.IsTrue(reason.Cancelled);
            Assert.AreEqual(0, OfPreviews());
            Assert.IsFalse(figure.Body.forceRenderingOff);
        }

        sealed class Refusal : IConversionProgress
        {
            public bool Report(string stageKey, float fraction)
            {
                return false;
            }
        }

        [Test]
        public void dispose_leaves_nothing_of_the_preview()
        {
            var session = new PreviewSession(figure.Root, settings);
            // The body's and the hat's mesh, the root, and the transforms below the avatar's.
            Assert.That(OfPreviews(), Is.GreaterThan(20));
            session.Dispose();
            session.Dispose();
            Assert.AreEqual(0, OfPreviews());
            Assert.IsNull(session.Proxy);
            Assert.IsFalse(session.IsAlive);
        }

        [Test]
        public void a_preview_that_cannot_be_leaves_nothing_and_says_why()
        {
            settings.Source = StyleSource.ReferenceAvatar;
            var reason = Assert.Throws<ConversionException>(() => new PreviewSession(figure.Root, settings));
            Assert.AreEqual("no_reference", reason.Finding.Key);
            Assert.AreEqual(0, OfPreviews());
            Assert.IsFalse(figure.Body.forceRenderingOff);
        }

        [Test]
        public void a_deleted_avatar_ends_the_preview_quietly()
        {
            var session = new PreviewSession(figure.Root, settings);
            UnityEngine.Object.DestroyImmediate(figure.Root);
            Assert.IsFalse(session.IsAlive);
            session.Dispose();
        }

        [Test]
        public void a_refused_setting_leaves_the_preview_as_it_was()
        {
            using (var session = new PreviewSession(figure.Root, settings))
            {
                Vector3[] before = Proxy(session, "body").sharedMesh.vertices;
                settings.Options.HeadScale = 1000;
                ConversionException refused = Assert.Throws<ConversionException>(() => session.Update(settings));
                StringAssert.Contains("(Head size)", refused.Message);
                Assert.AreEqual(before, Proxy(session, "body").sharedMesh.vertices);
                settings.Options.HeadScale = OptionDefaults.HeadScale;
                session.Update(settings);
                Assert.AreEqual(before, Proxy(session, "body").sharedMesh.vertices);
            }
        }

        [Test]
        public void a_reference_avatar_is_measured_once_and_blended()
        {
            var chibi = new WindowFigure("Chibi", 2000);
            chibi["Head"].localScale = Vector3.one;
            settings.Source = StyleSource.ReferenceAvatar;
            settings.ReferenceAvatar = chibi.Root;
            using (var session = new PreviewSession(figure.Root, settings))
            {
                // Were it measured again it would throw: it is no avatar any more.
                UnityEngine.Object.DestroyImmediate(chibi.Body.gameObject);
                Vector3[] before = Proxy(session, "body").sharedMesh.vertices;
                settings.Blend = 0.5f;
                settings.Heads = 3;
                session.Update(settings);
                Assert.That(Distance(before, Proxy(session, "body").sharedMesh.vertices), Is.GreaterThan(0.01f));
            }
        }

        [Test]
        public void the_numbers_are_those_of_the_conversion()
        {
            using (var session = new PreviewSession(figure.Root, settings))
            {
                PreviewNumbers numbers = session.Measure();
                Report wanted = Converter.Convert(figure.Root, settings, null).Report;
                Assert.AreEqual(wanted.Result.Heads, numbers.Report.Result.Heads);
                Assert.AreEqual(wanted.Target.Height, numbers.Report.Target.Height);
                Assert.That(numbers.Groups.Length, Is.GreaterThan(10));
            }
        }

        [Test]
        public void a_slider_leaves_next_to_no_garbage()
        {
            // The arrays of 20,000 vertices alone would be half a megabyte a frame.
            var large = new WindowFigure("Large", 20000, 3);
            using (var session = new PreviewSession(large.Root, settings))
            {
                settings.Options.FaceSquash = 0.1f;
                session.Update(settings);
                GC.Collect();
                int collections = GC.CollectionCount(0);
                long before = GC.GetTotalMemory(true);
                for (int frame = 0; frame < 20; frame++)
                {
                    settings.Options.FaceSquash = 0.2f + 0.01f * frame;
                    session.Update(settings);
                }
                long grown = GC.GetTotalMemory(false) - before;
                Assert.That(grown / 20, Is.LessThan(40000), "bytes a frame, with " + (GC.CollectionCount(0) - collections)
                    + " collections");
            }
        }
    }
}
