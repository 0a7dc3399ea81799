using System;
using System.Collections.Generic;
using System.Linq;
using nadena.dev.ndmf;
using nadena.dev.ndmf.preview;
using NUnit.Framework;
using SuperDeform.Editor.Ndmf;
using UnityEngine;
using UnityStubs;

namespace SuperDeform.Editor.Tests
{
    /// <summary>NDMF's preview shows what a build makes, of what other plugins' previews show, and the avatar stays as it is.</summary>
    [TestFixture]
    public class NdmfPreviewTests
    {
        const float Height = 1.9f;
        ConversionFigure figure;
        SuperDeformAvatar component;
        IRenderFilter filter;

        [SetUp]
        public void Begin()
        {
            Models.NewProject();
            figure = new ConversionFigure { Turned = true, WithShapes = true }.Make();
            component = figure.Root.AddComponent<SuperDeformAvatar>();
            var settings = new ConversionSettings { Heads = 2.5f };
            GroupTunings.Change(settings, "upper_leg", tuned => tuned.LengthScale = 0.7);
            SettingsText.Give(component, settings);
            NdmfStub.Build<SuperDeformPlugin>(new GameObject("Nobody"));
            filter = NdmfStub.Filters.Single();
        }

        [TearDown]
        public void End()
        {
            NdmfPreviewStub.CloseScene();
        }

        Renderer[] Parts()
        {
            return new Renderer[] { figure.Body, figure.Hair, figure.Hat };
        }

        /// <summary>What a build draws of each part.</summary>
        Dictionary<Renderer, Vector3[]> Built(Action<BuildContext> earlier = null)
        {
            GameObject clone = UnityEngine.Object.Instantiate(figure.Root);
            NdmfStub.Build<SuperDeformPlugin>(clone, earlier);
            var drawn = Parts().ToDictionary(part => part, part => Drawing.Drawn(ConversionTests.Find(clone, part.name).GetComponent<Renderer>(), Matrix4x4.identity));
            UnityEngine.Object.DestroyImmediate(clone);
            return drawn;
        }

        void ShowsWhatIsBuilt(NdmfPreviewStub preview, string when, Action<BuildContext> earlier = null)
        {
            foreach (KeyValuePair<Renderer, Vector3[]> built in Built(earlier))
            {
                Assert.That(Drawing.Apart(built.Value, Drawing.Drawn(preview.Proxy(built.Key), Matrix4x4.identity)), Is.LessThan(1e-5 * Height), when + ": " + built.Key.name);
            }
        }

        [Test]
        public void it_shows_what_a_build_makes_and_changes_nothing()
        {
            string before = Fingerprint.Of(figure.Root);
            figure.Root.transform.position = new Vector3(2, 0, 1);
            figure.Root.transform.rotation = Quaternion.Euler(0, 30, 0);
            string moved = Fingerprint.Of(figure.Root);
            Assert.AreNotEqual(before, moved);
            int objects = UnityEngine.Object.FindObjectsOfType<Transform>().Length;
            using (NdmfPreviewStub preview = NdmfPreviewStub.Of(filter))
            {
                preview.Frame();
                ShowsWhatIsBuilt(preview, "at first");
                // Nothing has changed: nothing is made again.
                Assert.AreEqual("", preview.Frame());
                ShowsWhatIsBuilt(preview, "a frame later");
                Assert.That(Drawing.Apart(Drawing.Drawn(figure.Body, Matrix4x4.identity), Drawing.Drawn(preview.Proxy(figure.Body), Matrix4x4.identity)), Is.GreaterThan(0.1 * Height));
            }
            Assert.AreEqual(moved, Fingerprint.Of(figure.Root));
            Assert.AreEqual(objects, UnityEngine.Object.FindObjectsOfType<Transform>().Length, "nothing is left");
        }

        [Test]
        public void a_setting_is_taken_without_reading_the_avatar_again()
        {
            using (NdmfPreviewStub preview = NdmfPreviewStub.Of(filter))
            {
                preview.Frame();
                IRenderFilterNode node = preview.Node;
                ConversionSettings settings = SettingsText.Of(component);
                settings.Options.HeadScale = 1.2;
                SettingsText.Give(component, settings);
                Assert.AreEqual("refreshed", preview.Frame());
                ShowsWhatIsBuilt(preview, "another head");
                settings.Heads = 3;
                SettingsText.Give(component, settings);
                Assert.AreEqual("refreshed", preview.Frame());
                ShowsWhatIsBuilt(preview, "another style");
                Assert.AreSame(node, preview.Node);
                settings.RigAuto = true;
                SettingsText.Give(component, settings);
                Assert.AreEqual("instantiated", preview.Frame());
            }
        }

        [Test]
        public void clothes_are_pushed_anew_when_settings_rest()
        {
            if (!Models.Has("kaykit_rogue.glb")) return;
            GameObject root = Models.Load("kaykit_rogue.glb").Root;
            UnityEngine.Object.DestroyImmediate(component);
            component = root.AddComponent<SuperDeformAvatar>();
            var settings = new ConversionSettings { Source = StyleSource.BuiltIn };
            SettingsText.Give(component, settings);
            Renderer[] parts = root.GetComponentsInChildren<Renderer>();
            using (NdmfPreviewStub preview = NdmfPreviewStub.Of(filter))
            {
                preview.Frame();
                GroupTunings.Change(settings, "torso", torso => torso.ThicknessScale = 1.3);
                SettingsText.Give(component, settings);
                Assert.AreEqual("refreshed", preview.Frame());
                Vector3[][] moving = Array.ConvertAll(parts, part => Drawing.Drawn(preview.Proxy(part), Matrix4x4.identity));
                StubEditor.Tick();
                System.Threading.Thread.Sleep(300);
                StubEditor.Tick();
                Assert.AreEqual("", preview.Frame());
                GameObject clone = UnityEngine.Object.Instantiate(root);
                NdmfStub.Build<SuperDeformPlugin>(clone);
                double between = 0;
                for (int part = 0; part < parts.Length; part++)
                {
                    Vector3[] shown = Drawing.Drawn(preview.Proxy(parts[part]), Matrix4x4.identity);
                    between = Math.Max(between, Drawing.Apart(moving[part], shown));
                    Vector3[] built = Drawing.Drawn(ConversionTests.Find(clone, parts[part].name).GetComponent<Renderer>(), Matrix4x4.identity);
                    Assert.That(Drawing.Apart(built, shown), Is.LessThan(1e-5 * Height), parts[part].name);
                }
                Assert.That(between, Is.GreaterThan(1e-3));
            }
            Assert.That(UnityEditor.EditorApplication.update, Is.Null, "nobody waits any more");
        }

        [Test]
        public void it_stands_as_the_avatar_stands()
        {
            using (NdmfPreviewStub preview = NdmfPreviewStub.Of(filter))
            {
                preview.Frame();
                figure.Bones[HumanBodyBones.LeftUpperArm].localRotation *= Quaternion.Euler(0, 0, 40);
                figure.Root.transform.position = new Vector3(0, 0, 3);
                Assert.AreEqual("", preview.Frame());
                ShowsWhatIsBuilt(preview, "posed and moved");
            }
        }

        [Test]
        public void blend_shapes_that_are_on_are_shown_once_they_rest()
        {
            using (NdmfPreviewStub preview = NdmfPreviewStub.Of(filter))
            {
                preview.Frame();
                Vector3[] before = Drawing.Drawn(preview.Proxy(figure.Body), Matrix4x4.identity);
                foreach (float weight in new[] { 50f, 100f })
                {
                    figure.Body.SetBlendShapeWeight(1, weight);
                    Assert.AreEqual("refreshed", preview.Frame(), "a slider goes on");
                    StubEditor.Tick();
                    Assert.AreEqual("", preview.Frame());
                }
                System.Threading.Thread.Sleep(300);
                StubEditor.Tick();
                Assert.AreEqual("instantiated", preview.Frame());
                ShowsWhatIsBuilt(preview, "Breathe");
                Assert.That(Drawing.Apart(before, Drawing.Drawn(preview.Proxy(figure.Body), Matrix4x4.identity)), Is.GreaterThan(1e-3));
                figure.Body.SetBlendShapeWeight(1, 0);
                preview.Frame();
            }
            Assert.That(UnityEditor.EditorApplication.update, Is.Null, "nobody waits any more");
        }

        [Test]
        public void what_other_plugins_show_is_deformed()
        {
            // A plugin that cuts the first half of the triangles away, and their vertices.
            var cut = new Dictionary<Mesh, Mesh>();
            Func<Mesh, Mesh> before = mesh =>
            {
                if (mesh != figure.Body.sharedMesh) return mesh;
                Mesh made;
                if (!cut.TryGetValue(mesh, out made))
                {
                    made = UnityEngine.Object.Instantiate(mesh);
                    Vector3[] vertices = mesh.vertices;
                    made.vertices = Array.ConvertAll(vertices, p => p * 0.99f);
                    made.subMeshCount = 1;
                    cut.Add(mesh, made);
                }
                return made;
            };
            using (NdmfPreviewStub preview = NdmfPreviewStub.Of(filter, before))
            {
                preview.Frame();
                Mesh shown = ((SkinnedMeshRenderer)preview.Proxy(figure.Body)).sharedMesh;
                Assert.AreEqual(1, shown.subMeshCount);
                Mesh own = figure.Body.sharedMesh;
                figure.Body.sharedMesh = before(own);
                ShowsWhatIsBuilt(preview, "cut");
                figure.Body.sharedMesh = own;
            }
        }

        [Test]
        public void a_mesh_that_another_plugin_shows_by_and_by_is_deformed_too()
        {
            Mesh instead = null;
            using (NdmfPreviewStub preview = NdmfPreviewStub.Of(filter, mesh => instead != null && mesh == figure.Body.sharedMesh ? instead : mesh))
            {
                preview.Frame();
                Assert.AreEqual("", preview.Frame());
                // A shape is switched on that hides what clothes cover.
                instead = UnityEngine.Object.Instantiate(figure.Body.sharedMesh);
                instead.vertices = Array.ConvertAll(instead.vertices, p => p * 0.98f);
                Assert.AreEqual("instantiated", preview.Frame());
                Mesh own = figure.Body.sharedMesh;
                figure.Body.sharedMesh = instead;
                ShowsWhatIsBuilt(preview, "shown since");
                figure.Body.sharedMesh = own;
            }
        }

        [Test]
        public void bones_of_another_plugin_are_taken_along()
        {
            // Modular Avatar's Scale Adjuster: in a build a scaled child of the bone, in its preview a bone of its own for each.
            Transform head = figure.Bones[HumanBodyBones.Head];
            var adjuster = head.gameObject.AddComponent<nadena.dev.modular_avatar.core.ModularAvatarScaleAdjuster>();
            adjuster.m_Scale = new Vector3(1.2f, 1.1f, 1.3f);
            var shadows = new Dictionary<Transform, Transform>();
            bool on = true;
            Action<Renderer, Renderer> earlier = (original, proxy) =>
            {
                var skinned = proxy as SkinnedMeshRenderer;
                if (skinned == null || !on) return;
                skinned.bones = Array.ConvertAll(((SkinnedMeshRenderer)original).bones, bone =>
                {
                    Transform shadow;
                    if (!shadows.TryGetValue(bone, out shadow))
                    {
                        shadows.Add(bone, shadow = UnityEditor.EditorUtility.CreateGameObjectWithHideFlags(bone.name, HideFlags.DontSave).transform);
                    }
                    shadow.position = bone.position;
                    shadow.rotation = bone.rotation;
                    Vector3 size = bone.lossyScale;
                    shadow.localScale = bone == head ? Vector3.Scale(size, adjuster.m_Scale) : size;
                    return shadow;
                });
            };
            using (NdmfPreviewStub preview = NdmfPreviewStub.Of(filter, null, earlier))
            {
                preview.Frame();
                ShowsWhatIsBuilt(preview, "scaled", nadena.dev.modular_avatar.core.ModularAvatarStub.Process);
                // It is adjusted while it is looked at, and the avatar moves.
                adjuster.m_Scale = Vector3.one * 0.8f;
                figure.Root.transform.position = new Vector3(1, 0, 2);
                figure.Bones[HumanBodyBones.Neck].localRotation *= Quaternion.Euler(0, 20, 0);
                Assert.AreEqual("", preview.Frame());
                ShowsWhatIsBuilt(preview, "scaled otherwise", nadena.dev.modular_avatar.core.ModularAvatarStub.Process);
                on = false;
                component.Settings += "\n";
                Assert.AreEqual("instantiated", preview.Frame());
            }
            foreach (Transform shadow in shadows.Values) UnityEngine.Object.DestroyImmediate(shadow.gameObject);
        }

        [Test]
        public void a_thousand_frames_leave_no_garbage_and_change_no_hierarchy()
        {
            using (NdmfPreviewStub preview = NdmfPreviewStub.Of(filter))
            {
                preview.Frame();
                preview.Frame();
                int changes = Changes.Hierarchy;
                for (int frame = 0; frame < 1000; frame++) preview.Frame();
                Assert.AreEqual(changes, Changes.Hierarchy, "with what NDMF itself does");
                // This package's share of a frame alone, with an avatar that moves.
                Renderer[] originals = Parts(), proxies = Array.ConvertAll(Parts(), preview.Proxy);
                IRenderFilterNode node = preview.Node;
                Transform arm = figure.Bones[HumanBodyBones.LeftUpperArm];
                for (int warm = 0; warm < 2; warm++)
                {
                    long before = GC.GetTotalMemory(true);
                    int collections = GC.CollectionCount(0);
                    for (int frame = 0; frame < 1000; frame++)
                    {
                        figure.Root.transform.localPosition = new Vector3(0.001f * frame, 0, 0);
                        arm.localRotation = new Quaternion(0, 0, 0.001f * frame, 1);
                        node.OnFrameGroup();
                        for (int part = 0; part < originals.Length; part++) node.OnFrame(originals[part], proxies[part]);
                    }
                    long grown = GC.GetTotalMemory(false) - before;
                    Console.WriteLine(grown + " bytes in 1000 frames");
                    if (warm > 0)
                    {
                        Assert.That(grown, Is.LessThan(20000), "20 bytes a frame are less than any object");
                        Assert.AreEqual(collections, GC.CollectionCount(0));
                    }
                }
                Assert.AreEqual(changes, Changes.Hierarchy);
            }
        }

        [Test]
        public void it_is_for_avatars_with_the_component_and_can_be_switched_off()
        {
            Assert.That(filter.StrictRenderGroup, "the whole avatar counts");
            TogglablePreviewNode onOff = filter.GetPreviewControlNodes().Single();
            onOff.IsEnabled.Value = false;
            Assert.That(NdmfPreviewStub.Of(filter), Is.Null);
            onOff.IsEnabled.Value = true;
            UnityEngine.Object.DestroyImmediate(component);
            Assert.That(NdmfPreviewStub.Of(filter), Is.Null);
        }

        [Test]
        public void what_cannot_be_deformed_is_shown_as_it_is()
        {
            component.Settings = "Source = SavedStyle\n";
            using (NdmfPreviewStub preview = NdmfPreviewStub.Of(filter))
            {
                preview.Frame();
                foreach (Renderer part in Parts())
                {
                    Assert.That(Drawing.Apart(Drawing.Drawn(part, Matrix4x4.identity), Drawing.Drawn(preview.Proxy(part), Matrix4x4.identity)), Is.LessThan(1e-5 * Height), part.name);
                }
                component.Settings = "Source = Heads\n";
                Assert.AreEqual("instantiated", preview.Frame());
                ShowsWhatIsBuilt(preview, "mended");
            }
        }

        [Test]
        public void an_emptied_scene_is_no_fault()
        {
            using (NdmfPreviewStub preview = NdmfPreviewStub.Of(filter))
            {
                preview.Frame();
                IRenderFilterNode node = preview.Node;
                Renderer[] proxies = Array.ConvertAll(Parts(), preview.Proxy);
                NdmfPreviewStub.CloseScene();
                node.OnFrameGroup();
                for (int part = 0; part < proxies.Length; part++) node.OnFrame(Parts()[part], proxies[part]);
            }
        }
    }
}
