using System;
using System.Collections.Generic;
using System.Linq;
using NUnit.Framework;
using UnityEditor;
using UnityEditor.SceneManagement;
using UnityEngine;
using UnityEngine.SceneManagement;
using UnityStubs;

namespace SuperDeform.Editor.Tests
{
    /// <summary>The preview as an artist expects it: the avatar as it is worn, in its own scene, clicked and painted.</summary>
    [TestFixture]
    public class PreviewInPlaceTests
    {
        ConversionFigure figure;
        ConversionSettings settings;

        [SetUp]
        public void Begin()
        {
            Models.NewProject();
            figure = new ConversionFigure { Turned = true, WithShapes = true }.Make();
            settings = new ConversionSettings { Heads = 2.5f, OutputFolder = "Assets/Out", PlaceInScene = false };
            settings.Options.FaceSquash = 0.5;
        }

        [Test]
        public void blend_shapes_that_are_on_are_shown()
        {
            // One alone: two at once move the face as one after the other, which the library says of its own shapes.
            foreach (float weight in new[] { 100f, 70f, 25f })
            {
                figure.Body.SetBlendShapeWeight(0, weight);
                Vector3[] wanted = Drawing.Drawn(Converter.Convert(figure.Root, settings, null).Prefab, "Body");
                using (var session = new PreviewSession(figure.Root, settings))
                {
                    double apart = Drawing.Apart(wanted, Drawing.Drawn(session.Proxy, "Body"));
                    Console.WriteLine("Smile at " + weight + ": " + (apart / 1.9).ToString("0.0E0") + " of the height from the result");
                    // Between frames the shape is a mean of two, deformed at once here and one by one there.
                    Assert.That(apart, Is.LessThan(weight == 100 ? 1e-5 * 1.9 : 2e-3 * 1.9), weight.ToString());
                }
            }
            figure.Body.SetBlendShapeWeight(0, 0);
            using (var session = new PreviewSession(figure.Root, settings))
            {
                Assert.That(Drawing.Apart(Drawing.Drawn(Converter.Convert(figure.Root, settings, null).Prefab, "Body"), Drawing.Drawn(session.Proxy, "Body")), Is.LessThan(1e-5 * 1.9));
            }
        }

        [Test]
        public void a_weight_between_two_frames_is_shared_by_them()
        {
            Func<float, string> shares = weight => string.Join(" ", RendererReader.FrameShares(figure.Body.sharedMesh, 0, weight)
                .Select(share => share.Key + ":" + share.Value.ToString(System.Globalization.CultureInfo.InvariantCulture)).ToArray());
            // Frames at 50 and 100.
            Assert.AreEqual("0:0.5", shares(25));
            Assert.AreEqual("0:1", shares(50));
            Assert.AreEqual("1:0.5 0:0.5", shares(75));
            Assert.AreEqual("1:1 0:0", shares(100));
            Assert.AreEqual("1:1.5 0:-0.5", shares(125));
        }

        [Test]
        public void a_changed_weight_is_read_anew_once_it_rests()
        {
            var model = new ConverterModel { Avatar = figure.Root, Settings = settings };
            using (var controller = new ConverterController(model))
            {
                controller.Tick(0);
                controller.Tick(1);
                PreviewSession first = controller.Preview;
                figure.Body.SetBlendShapeWeight(0, 100);
                controller.Tick(2);
                Assert.AreSame(first, controller.Preview, "while the slider moves");
                controller.Tick(2.1);
                controller.Tick(2.4);
                Assert.AreNotSame(first, controller.Preview);
                Assert.That(controller.Preview.IsWornOtherwise, Is.False);
                PreviewSession second = controller.Preview;
                controller.Tick(9);
                Assert.AreSame(second, controller.Preview);
            }
        }

        [Test]
        public void it_is_in_the_scene_of_the_avatar_and_so_is_the_result()
        {
            Scene prefabMode = EditorSceneManager.NewPreviewScene();
            SceneManager.MoveGameObjectToScene(figure.Root, prefabMode);
            using (var session = new PreviewSession(figure.Root, settings))
            {
                Assert.AreEqual(prefabMode, session.Proxy.scene);
                foreach (Transform shown in session.Proxy.GetComponentsInChildren<Transform>(true))
                {
                    Assert.AreEqual(prefabMode, shown.gameObject.scene, shown.name);
                }
            }
            settings.PlaceInScene = true;
            Assert.AreEqual(prefabMode, Converter.Convert(figure.Root, settings, null).Instance.scene);
        }

        [Test]
        public void a_click_on_it_selects_what_it_stands_for()
        {
            using (var session = new PreviewSession(figure.Root, settings))
            {
                GameObject shown = Array.Find(session.Proxy.GetComponentsInChildren<SkinnedMeshRenderer>(true), one => one.name == "Hair").gameObject;
                Selection.activeGameObject = shown;
                Assert.AreSame(figure.Hair.gameObject, Selection.activeGameObject);
                Selection.activeGameObject = session.Proxy;
                Assert.AreSame(figure.Root, Selection.activeGameObject);
                // A rectangle around all of it.
                GameObject body = Array.Find(session.Proxy.GetComponentsInChildren<SkinnedMeshRenderer>(true), one => one.name == "Body").gameObject;
                Selection.objects = new UnityEngine.Object[] { shown, body, figure.Hair.gameObject };
                CollectionAssert.AreEqual(new[] { figure.Hair.gameObject, figure.Body.gameObject }, Selection.objects);
                var other = new GameObject("Other");
                Selection.activeGameObject = other;
                Assert.AreSame(other, Selection.activeGameObject);
            }
            Assert.That(Selection.selectionChanged, Is.Null);
        }

        [Test]
        public void parts_that_are_switched_and_painted_are_followed()
        {
            using (var session = new PreviewSession(figure.Root, settings))
            {
                Func<string, SkinnedMeshRenderer> shown = name => Array.Find(session.Proxy.GetComponentsInChildren<SkinnedMeshRenderer>(true), one => one.name == name);
                Assert.That(session.Follow(), Is.False);
                figure.Hair.enabled = false;
                figure.Hat.gameObject.SetActive(false);
                Assert.That(session.Follow());
                Assert.That(shown("Hair").enabled || shown("Hat").enabled, Is.False);
                Assert.That(shown("Body").enabled);
                figure.Hair.enabled = true;
                SceneVisibilityManager.instance.Hide(figure.Body.gameObject, false);
                Assert.That(session.Follow());
                Assert.That(shown("Hair").enabled && !shown("Body").enabled);
                SceneVisibilityManager.instance.Show(figure.Body.gameObject, false);
                var paint = new Material(Shader.Find("Standard"));
                figure.Hair.sharedMaterials = new[] { paint };
                Assert.That(session.Follow());
                Assert.AreSame(paint, shown("Hair").sharedMaterial);
                Assert.That(session.Follow(), Is.False);
                Assert.That(figure.Hair.forceRenderingOff && figure.Body.forceRenderingOff);
            }
            Assert.That(figure.Hair.forceRenderingOff || figure.Body.forceRenderingOff || figure.Hat.forceRenderingOff, Is.False);
        }

        [Test]
        public void the_scene_view_says_that_a_preview_is_on_and_frames_it()
        {
            var view = ScriptableObject.CreateInstance<SceneView>();
            var model = new ConverterModel { Avatar = figure.Root, Settings = settings };
            using (var controller = new ConverterController(model))
            {
                controller.Tick(0);
                Gui.Pass(() => StubEditor.DrawScene(view));
                Assert.That(Gui.Drawn.Exists(line => line.Contains(Strings.Get("badge.after"))));
                Gui.Press.Add(Strings.Get("badge.frame"));
                Gui.Pass(() => StubEditor.DrawScene(view));
                Assert.That(StubEditor.Framed(view).HasValue);
                model.ShowBefore = true;
                model.Touch();
                controller.Tick(1);
                Gui.Pass(() => StubEditor.DrawScene(view));
                Assert.That(Gui.Drawn.Exists(line => line.Contains(Strings.Get("badge.before"))));
                controller.Resting = true;
                controller.Tick(2);
                Assert.That(controller.Preview, Is.Null, "behind another tab");
                Gui.Pass(() => StubEditor.DrawScene(view));
                Assert.That(Gui.Drawn, Is.Empty);
                controller.Resting = false;
                controller.Tick(3);
                Assert.That(controller.Preview, Is.Not.Null);
            }
            Gui.Pass(() => StubEditor.DrawScene(view));
            Assert.That(Gui.Drawn, Is.Empty);
        }
    }
}
