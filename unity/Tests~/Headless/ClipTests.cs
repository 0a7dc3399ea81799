using System;
using System.Collections.Generic;
using nadena.dev.ndmf;
using NUnit.Framework;
using SuperDeform.Tests.Glb;
using SuperDeform.Editor.Ndmf;
using UnityEditor;
using UnityEditor.Animations;
using UnityEngine;
using UnityStubs;

namespace SuperDeform.Editor.Tests
{
    /// <summary>Clips that set places of bones and lengths of components play on the result as they played on the avatar.</summary>
    [TestFixture]
    public class ClipTests
    {
        const float Height = 1.9f;
        static readonly Vector3 step = new Vector3(0.01f, 0.03f, -0.02f);
        ConversionFigure figure;
        AnimationClip walk;

        [SetUp]
        public void Begin()
        {
            Models.NewProject();
            figure = new ConversionFigure { Turned = true }.Make();
            walk = new AnimationClip { name = "Walk" };
            foreach (Transform bone in figure.Bones.Values)
            {
                for (int axis = 0; axis < 3; axis++)
                {
                    Set(walk, bone, typeof(Transform), "m_LocalPosition." + "xyz"[axis], bone.localPosition[axis], bone.localPosition[axis] + step[axis]);
                }
            }
            StubProject.Import("Assets/Walk.anim", walk);
            Play(figure.Root.GetComponent<Animator>(), walk);
        }

        static ConversionSettings Settings()
        {
            return new ConversionSettings { Source = StyleSource.BuiltIn, BuiltInStyle = "sd2.5", OutputFolder = "Assets/Out", PlaceInScene = false };
        }

        static void Play(Animator animator, params AnimationClip[] clips)
        {
            var controller = new AnimatorController { name = "Moves" };
            foreach (AnimationClip clip in clips) controller.AddMotion(clip);
            StubProject.Import("Assets/Moves.controller", controller);
            animator.runtimeAnimatorController = controller;
        }

        void Set(AnimationClip clip, Transform place, Type type, string property, float first, float second)
        {
            var keys = new[] { new Keyframe(0, first, 0, 2), new Keyframe(1, second, 2, float.PositiveInfinity) };
            AnimationUtility.SetEditorCurve(clip, EditorCurveBinding.FloatCurve(Path(figure.Root.transform, place), type, property), new AnimationCurve(keys));
        }

        static string Path(Transform root, Transform place)
        {
            return place.parent == root ? place.name : Path(root, place.parent) + "/" + place.name;
        }

        static Keyframe[] Keys(AnimationClip clip, string path, Type type, string property)
        {
            return AnimationUtility.GetEditorCurve(clip, EditorCurveBinding.FloatCurve(path, type, property)).keys;
        }

        /// <summary>By how much a step of each bone is to grow: as the command line has it, hips and legs by the legs' length and the rest by the body.</summary>
        Dictionary<HumanBodyBones, double> Wanted(GameObject result)
        {
            var wanted = new Dictionary<HumanBodyBones, double>();
            using (AvatarData data = CharacterReader.Read(figure.Root, new ReadOptions()))
            using (Style style = Settings().MakeStyle())
            using (var deformer = new Deformer(data.Character, style, Settings().Options))
            {
                foreach (KeyValuePair<HumanBodyBones, Transform> bone in figure.Bones)
                {
                    uint joint = (uint)data.IndexOf(bone.Value);
                    Double3 place = data.Rest[joint].Position;
                    var scale = new double[1];
                    deformer.MapPoints(new[] { joint }, new[] { place.X, place.Y, place.Z }, new double[3], scale);
                    wanted.Add(bone.Key, scale[0]);
                }
            }
            Transform[] all = result.GetComponentsInChildren<Transform>();
            double stride = LegLength(bone => Array.Find(all, t => t.name == figure.Bones[bone].name)) / LegLength(bone => figure.Bones[bone]);
            foreach (HumanBodyBones bone in legs) wanted[bone] = stride;
            wanted[HumanBodyBones.Hips] = stride;
            return wanted;
        }

        static readonly HumanBodyBones[] legs =
        {
            HumanBodyBones.LeftUpperLeg, HumanBodyBones.LeftLowerLeg, HumanBodyBones.LeftFoot,
            HumanBodyBones.RightUpperLeg, HumanBodyBones.RightLowerLeg, HumanBodyBones.RightFoot
        };

        static double LegLength(Func<HumanBodyBones, Transform> find)
        {
            double length = 0;
            foreach (int part in new[] { 0, 1, 3, 4 }) length += Vector3.Distance(find(legs[part]).position, find(legs[part + 1]).position);
            return length;
        }

        void Walks(GameObject result, AnimationClip clip)
        {
            Dictionary<HumanBodyBones, double> wanted = Wanted(result);
            // Bones of the figure count in hundredths.
            float unit = 100;
            foreach (KeyValuePair<HumanBodyBones, Transform> bone in figure.Bones)
            {
                Transform now = Array.Find(result.GetComponentsInChildren<Transform>(), t => t.name == bone.Value.name);
                for (int axis = 0; axis < 3; axis++)
                {
                    Keyframe[] keys = Keys(clip, Path(figure.Root.transform, bone.Value), typeof(Transform), "m_LocalPosition." + "xyz"[axis]);
                    Assert.AreEqual(now.localPosition[axis], keys[0].value, 1e-6f * Height * unit, bone.Key + " at rest");
                    Assert.AreEqual(wanted[bone.Key] * step[axis], keys[1].value - keys[0].value, 1e-5f * Height * unit, bone.Key + "'s step");
                    Assert.AreEqual(2 * wanted[bone.Key], keys[0].outTangent, 1e-4, bone.Key + "'s slope");
                    Assert.AreEqual(float.PositiveInfinity, keys[1].outTangent);
                }
            }
        }

        [Test]
        public void a_walk_of_a_generic_character_goes_along([Values(false, true)] bool humanoid)
        {
            if (!humanoid) figure.Root.GetComponent<Animator>().avatar = null;
            ConversionResult result = Converter.Convert(figure.Root, Settings(), null);
            RuntimeAnimatorController moves = result.Prefab.GetComponent<Animator>().runtimeAnimatorController;
            Assert.AreEqual("Moves", moves.name);
            AnimationClip copy = moves.animationClips[0];
            Assert.AreNotSame(walk, copy);
            Assert.That(AssetDatabase.Contains(copy) && AssetDatabase.Contains(moves));
            Walks(result.Prefab, copy);
            Assert.That(result.Findings.Exists(finding => finding.Key == "clips_moved" && finding.Severity == Severity.Info));
            // The avatar and what it plays are as they were.
            Assert.AreEqual(figure.Bones[HumanBodyBones.Head].localPosition.y, Keys(walk, Path(figure.Root.transform, figure.Bones[HumanBodyBones.Head]), typeof(Transform), "m_LocalPosition.y")[0].value);
            Assert.AreSame(walk, figure.Root.GetComponent<Animator>().runtimeAnimatorController.animationClips[0]);
        }

        /// <summary>The places of a clip's tracks by node's name, a key after the other, in Unity's axes.</summary>
        static Dictionary<string, Vector3[]> Tracks(string path)
        {
            var file = new GlbFile(path);
            var tracks = new Dictionary<string, Vector3[]>();
            Json clip = file.Root["animations"][0];
            foreach (Json channel in clip["channels"].Items)
            {
                Assert.AreEqual("translation", channel["target"]["path"].Text());
                double[] numbers = file.Numbers(clip["samplers"][channel["sampler"].Int()]["output"].Int(), out int width);
                var places = new Vector3[numbers.Length / width];
                for (int key = 0; key < places.Length; key++)
                {
                    places[key] = new Vector3(-(float)numbers[3 * key], (float)numbers[3 * key + 1], (float)numbers[3 * key + 2]);
                }
                tracks.Add(file.Root["nodes"][channel["target"]["node"].Int()]["name"].Text(), places);
            }
            return tracks;
        }

        [Test]
        public void a_walk_is_the_command_lines()
        {
            // What Tests~/Glb/walk.py made of the rogue.
            string walking = System.IO.Path.Combine(Models.Out, "kaykit_walk.glb"), made = ExampleTests.RunExample(walking, "--heads 2");
            if (made == null) return;
            Model model = Models.Load(walking);
            // A Generic character: its joints are known by their names.
            model.Root.AddComponent<Animator>();
            var clip = new AnimationClip { name = "Walk" };
            Dictionary<string, Vector3[]> tracks = Tracks(walking), wanted = Tracks(made);
            var places = new Dictionary<string, string>();
            foreach (string name in tracks.Keys)
            {
                Transform joint = ConversionTests.Find(model.Root, name);
                places.Add(name, Path(model.Root.transform, joint));
                for (int axis = 0; axis < 3; axis++)
                {
                    AnimationUtility.SetEditorCurve(clip, EditorCurveBinding.FloatCurve(places[name], typeof(Transform), "m_LocalPosition." + "xyz"[axis]),
                        new AnimationCurve(new Keyframe(0, tracks[name][0][axis]), new Keyframe(1, tracks[name][1][axis])));
                }
            }
            StubProject.Import("Assets/Walk.anim", clip);
            Play(model.Root.GetComponent<Animator>(), clip);
            ConversionResult result = Converter.Convert(model.Root, new ConversionSettings { Heads = 2, PlaceInScene = false }, null);
            AnimationClip copy = result.Prefab.GetComponent<Animator>().runtimeAnimatorController.animationClips[0];
            GameObject mine = UnityEngine.Object.Instantiate(result.Prefab), theirs = GlbLoader.Load(made, null).Root;
            double height = Models.Height(model.Root), far = 0, moved = 0;
            foreach (int key in new[] { 0, 1 })
            {
                foreach (string name in tracks.Keys)
                {
                    Transform joint = ConversionTests.Find(mine, name);
                    Vector3 at = joint.localPosition;
                    for (int axis = 0; axis < 3; axis++)
                    {
                        at[axis] = Keys(copy, places[name], typeof(Transform), "m_LocalPosition." + "xyz"[axis])[key].value;
                    }
                    moved = Math.Max(moved, Vector3.Distance(at, joint.localPosition));
                    joint.localPosition = at;
                    ConversionTests.Find(theirs, name).localPosition = wanted[name][key];
                }
                foreach (string name in tracks.Keys)
                {
                    Vector3 one = mine.transform.InverseTransformPoint(ConversionTests.Find(mine, name).position);
                    far = Math.Max(far, Vector3.Distance(one, theirs.transform.InverseTransformPoint(ConversionTests.Find(theirs, name).position)));
                }
            }
            Console.WriteLine("{0} joints: {1:0.0E0} of the height off the command line's, moved by {2:0.00}", tracks.Count, far / height, moved / height);
            Assert.That(moved, Is.GreaterThan(0.1 * height));
            Assert.That(far, Is.LessThan(1e-4 * height));
        }

        [Test]
        public void a_clip_that_another_overrides_is_the_one_that_goes_along()
        {
            Animator animator = figure.Root.GetComponent<Animator>();
            var stand = new AnimationClip { name = "Stand" };
            StubProject.Import("Assets/Stand.anim", stand);
            Play(animator, stand);
            var given = new AnimatorOverrideController(animator.runtimeAnimatorController) { name = "Mine" };
            given.ApplyOverrides(new[] { new KeyValuePair<AnimationClip, AnimationClip>(stand, walk) });
            StubProject.Import("Assets/Mine.overrideController", given);
            animator.runtimeAnimatorController = given;
            ConversionResult result = Converter.Convert(figure.Root, Settings(), null);
            var made = (AnimatorOverrideController)result.Prefab.GetComponent<Animator>().runtimeAnimatorController;
            Assert.IsInstanceOf<AnimatorController>(made.runtimeAnimatorController);
            Walks(result.Prefab, made.animationClips[0]);
        }

        [Test]
        public void what_sets_no_lengths_is_played_as_it_is()
        {
            Animator animator = figure.Root.GetComponent<Animator>();
            var nod = new AnimationClip { name = "Nod" };
            Set(nod, figure.Bones[HumanBodyBones.Head], typeof(Transform), "localEulerAnglesRaw.x", 0, 20);
            StubProject.Import("Assets/Nod.anim", nod);
            Play(animator, nod);
            ConversionResult result = Converter.Convert(figure.Root, Settings(), null);
            Assert.AreSame(animator.runtimeAnimatorController, result.Prefab.GetComponent<Animator>().runtimeAnimatorController);
            Assert.That(!result.Findings.Exists(finding => finding.Key.StartsWith("clip")));
        }

        [Test]
        public void lengths_of_components_grow_as_the_components_do()
        {
            Transform head = figure.Bones[HumanBodyBones.Head];
            var puff = new AnimationClip { name = "Puff" };
            Set(puff, head, typeof(SphereCollider), "m_Radius", 0.1f, 0.3f);
            StubProject.Import("Assets/Puff.anim", puff);
            Play(figure.Root.GetComponent<Animator>(), puff);
            ConversionResult result = Converter.Convert(figure.Root, Settings(), null);
            float now = result.Prefab.GetComponentInChildren<SphereCollider>().radius;
            Assert.AreNotEqual(0.1f, now);
            Keyframe[] keys = Keys(result.Prefab.GetComponent<Animator>().runtimeAnimatorController.animationClips[0], Path(figure.Root.transform, head), typeof(SphereCollider), "m_Radius");
            Assert.AreEqual(now, keys[0].value, 1e-6f);
            Assert.AreEqual(3 * now, keys[1].value, 1e-5f);
        }

        /// <summary>Plays clips in a way that nobody here knows.</summary>
        sealed class Player : MonoBehaviour
        {
            public RuntimeAnimatorController Layer;
        }

        [Test]
        public void a_clip_that_cannot_be_exchanged_is_named()
        {
            Animator animator = figure.Root.GetComponent<Animator>();
            figure.Root.AddComponent<Player>().Layer = animator.runtimeAnimatorController;
            ConversionResult result = Converter.Convert(figure.Root, Settings(), null);
            Finding left = result.Findings.Find(finding => finding.Key == "clip_left");
            Assert.That(left != null && left.Severity == Severity.Warning && left.Text.Contains("Walk") && left.Text.Contains("Player"));
        }

        static string Build(GameObject clone)
        {
            return NdmfStub.Build<SuperDeformPlugin>(clone);
        }

        [Test]
        public void a_build_writes_the_clips_that_the_platform_plays()
        {
            SettingsText.Give(figure.Root.AddComponent<SuperDeformAvatar>(), Settings());
            GameObject clone = UnityEngine.Object.Instantiate(figure.Root);
            Build(clone);
            Assert.That(NdmfStub.Uploads, string.Join("\n", NdmfStub.Report.ToArray()));
            RuntimeAnimatorController moves = clone.GetComponent<Animator>().runtimeAnimatorController;
            Assert.IsInstanceOf<AnimatorController>(moves);
            Walks(clone, moves.animationClips[0]);
        }

        [Test]
        public void a_build_that_fails_leaves_the_clips_as_they_were()
        {
            SettingsText.Give(figure.Root.AddComponent<SuperDeformAvatar>(), Settings());
            GameObject clone = UnityEngine.Object.Instantiate(figure.Root);
            NdmfStub.Refuse = asset => { throw new System.IO.IOException("The disk is full."); };
            try
            {
                Build(clone);
            }
            finally
            {
                NdmfStub.Refuse = null;
            }
            Assert.That(!NdmfStub.Uploads);
            Assert.AreSame(walk, clone.GetComponent<Animator>().runtimeAnimatorController.animationClips[0]);
        }
    }
}
