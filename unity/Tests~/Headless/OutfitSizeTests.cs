using System;
using System.Collections.Generic;
using nadena.dev.modular_avatar.core;
using nadena.dev.ndmf;
using NUnit.Framework;
using UnityEngine;
using UnityStubs;
using VF.Model;
using VF.Model.Feature;

namespace SuperDeform.Editor.Tests
{
    /// <summary>Outfits that are larger or smaller than the avatar follow as a whole; what follows in part is said.</summary>
    [TestFixture]
    public class OutfitSizeTests
    {
        const float Height = 1.9f;

        [SetUp]
        public void Begin()
        {
            Models.NewProject();
        }

        static ConversionSettings Settings()
        {
            return new ConversionSettings { Heads = 2.5f, OutputFolder = "Assets/Out", PlaceInScene = false };
        }

        sealed class Dressed
        {
            internal ConversionFigure Figure;
            internal SkinnedMeshRenderer Coat;
            internal Transform Outfit;
            internal Dictionary<Transform, Transform> Twins;
        }

        /// <summary>A coat on an armature of its own, scaled around the soles.</summary>
        static Dressed Dress(string how, float scale)
        {
            var dressed = new Dressed { Figure = new ConversionFigure().Make() };
            dressed.Coat = Wardrobe.Coat(dressed.Figure, 0.015f);
            int number = 0;
            Func<string, string> rename = name => how == "names" || how == "Armature Link" ? name + "_coat" : how == "Merge Armature" ? "X" + name : "b" + number++;
            dressed.Twins = Wardrobe.Armature(dressed.Figure.Root, dressed.Figure.Bones[HumanBodyBones.Hips], rename);
            Wardrobe.Bind(dressed.Coat, dressed.Twins);
            dressed.Outfit = dressed.Figure.Root.transform.Find("Outfit");
            Transform hips = dressed.Twins[dressed.Figure.Bones[HumanBodyBones.Hips]];
            if (how == "Merge Armature")
            {
                var merge = dressed.Outfit.GetChild(0).gameObject.AddComponent<ModularAvatarMergeArmature>();
                merge.mergeTarget.referencePath = "Armature";
                merge.prefix = "X";
            }
            else if (how == "Armature Link")
            {
                dressed.Outfit.gameObject.AddComponent<VRCFury>().content = new ArmatureLink { propBone = hips.gameObject, recursive = true };
            }
            else if (how == "own Animator") Wardrobe.MakeHumanoid(dressed.Outfit.gameObject, dressed.Figure.Bones, dressed.Twins);
            dressed.Outfit.localScale = Vector3.one * scale;
            return dressed;
        }

        /// <summary>The coat and the body before and after, in the root's space.</summary>
        static void Deform(GameObject root, out Vector3[] coat, out Vector3[] body, out Vector3[] newCoat, out Vector3[] newBody)
        {
            using (AvatarData data = CharacterReader.Read(root, new ReadOptions()))
            using (Style style = Settings().MakeStyle())
            using (var deformer = new Deformer(data.Character, style, Settings().Options, null))
            {
                var result = new AvatarResult(data, true);
                result.Apply(deformer, null);
                RendererResult ofCoat = result.Renderers.Find(one => one.Source.Renderer.name == "Coat"), ofBody = result.Renderers.Find(one => one.Source.Renderer.name == "Body");
                coat = Drawing.Drawn((Renderer)ofCoat.Source.Renderer, root.transform.worldToLocalMatrix);
                body = ofBody.Source.ModelVertices;
                newCoat = ofCoat.Positions;
                newBody = ofBody.Positions;
            }
        }

        static readonly string[] ways = { "names", "Merge Armature", "Armature Link", "own Animator" };

        /// <summary>The vertices that are not the head's, which grows twice as large as the rest: a coat has none.</summary>
        static Vector3[] BelowHead(Dressed dressed, Vector3[] all)
        {
            BoneWeight[] weights = dressed.Coat.sharedMesh.boneWeights;
            int head = Array.IndexOf(dressed.Coat.bones, dressed.Twins[dressed.Figure.Bones[HumanBodyBones.Head]]);
            int neck = Array.IndexOf(dressed.Coat.bones, dressed.Twins[dressed.Figure.Bones[HumanBodyBones.Neck]]);
            var below = new List<Vector3>();
            for (int vertex = 0; vertex < all.Length; vertex++)
            {
                if (weights[vertex].boneIndex0 != head && weights[vertex].boneIndex0 != neck) below.Add(all[vertex]);
            }
            return below.ToArray();
        }

        [Test]
        public void an_outfit_of_another_size_follows_the_whole_body()
        {
            // Every vertex and every row for a table; less for a test.
            bool all = Environment.GetEnvironmentVariable("SUPERDEFORM_TABLE") != null;
            Console.WriteLine("scale  how              coat to body before, mean / max       after, mean / max    times, mean / max    as merged");
            foreach (float scale in new[] { 0.9f, 0.95f, 0.97f, 0.98f, 0.985f, 1, 1.02f, 1.05f, 1.1f })
            {
                Models.NewProject();
                Vector3[] coat, body, newCoat, newBody;
                Dressed merged = Dress("Merge Armature", scale);
                ModularAvatarStub.Process(new BuildContext(merged.Figure.Root, null));
                Vector3[] wanted;
                Deform(merged.Figure.Root, out coat, out body, out wanted, out newBody);
                foreach (string how in ways)
                {
                    if (!all && how != "names" && scale != 0.9f && scale != 0.98f && scale != 1.1f) continue;
                    Models.NewProject();
                    Dressed dressed = Dress(how, scale);
                    Deform(dressed.Figure.Root, out coat, out body, out newCoat, out newBody);
                    int[] triangles = dressed.Figure.Body.sharedMesh.triangles;
                    double[] before = Drawing.ToSurface(BelowHead(dressed, coat), body, triangles, all ? 1 : 17);
                    double[] after = Drawing.ToSurface(BelowHead(dressed, newCoat), newBody, triangles, all ? 1 : 17);
                    double asMerged = Drawing.Apart(wanted, newCoat) / Height;
                    Console.WriteLine("{0,-6} {1,-16} {2,12:0.0} / {3,-6:0.0} mm {4,20:0.0} / {5,-6:0.0} mm {6,10:0.00} / {7,-6:0.00} {8,12:0.0E0} H", scale, how,
                        1000 * before[0], 1000 * before[1], 1000 * after[0], 1000 * after[1], after[0] / before[0], after[1] / before[1], asMerged);
                    Assert.That(asMerged, Is.LessThan(1e-4), scale + " " + how + ": as the same coat on the avatar's own joints");
                    Assert.That(after[0], Is.LessThan(1.3 * before[0]), scale + " " + how + ": in the mean");
                    Assert.That(after[1], Is.LessThan(1.3 * before[1]), scale + " " + how + ": at most");
                    Assert.That(AvatarChecks.Of(dressed.Figure.Root).FindAll(finding => finding.Severity != Severity.Info), Is.Empty, scale + " " + how);
                }
            }
        }

        [Test]
        public void an_armature_that_is_far_larger_smaller_or_elsewhere_is_no_outfit()
        {
            foreach (string how in new[] { "names", "own Animator" })
            {
                foreach (string where in new[] { "half", "double", "aside", "above" })
                {
                    Models.NewProject();
                    Dressed dressed = Dress(how, where == "half" ? 0.5f : where == "double" ? 2 : 1);
                    dressed.Outfit.localPosition = where == "aside" ? new Vector3(0.5f, 0, 0) : where == "above" ? new Vector3(0, 0.5f, 0) : Vector3.zero;
                    using (AvatarData data = CharacterReader.Read(dressed.Figure.Root, new ReadOptions()))
                    {
                        foreach (Transform twin in dressed.Twins.Values)
                        {
                            Assert.AreEqual(data.IndexOf(twin), data.Twins[data.IndexOf(twin)], how + ", " + where + ": " + twin.name);
                        }
                    }
                    List<Finding> said = AvatarChecks.Of(dressed.Figure.Root).FindAll(finding => finding.Severity == Severity.Warning);
                    Assert.AreEqual(how == "names" ? "own_bones" : "pet", said[0].Key, how + ", " + where);
                    StringAssert.Contains("Outfit", said[0].Text);
                }
            }
        }

        [Test]
        public void a_prop_with_few_joints_called_like_the_avatars_is_none_of_it_unless_they_lie_there()
        {
            foreach (float aside in new[] { 0, 0.015f, 0.06f, 0.2f })
            {
                Models.NewProject();
                var figure = new ConversionFigure().Make();
                SkinnedMeshRenderer cap = UnityEngine.Object.Instantiate(figure.Hair, figure.Root.transform);
                cap.name = "Cap";
                cap.bones = figure.Hair.bones;
                Transform head = new GameObject("J_Head").transform;
                head.SetParent(new GameObject("CapArmature").transform, false);
                head.parent.SetParent(figure.Root.transform, false);
                head.position = figure.Bones[HumanBodyBones.Head].position + new Vector3(aside, 0, 0);
                Wardrobe.Bind(cap, new Dictionary<Transform, Transform> { { figure.Bones[HumanBodyBones.Head], head } });
                using (AvatarData data = CharacterReader.Read(figure.Root, new ReadOptions()))
                {
                    bool paired = data.Twins[data.IndexOf(head)] == data.IndexOf(figure.Bones[HumanBodyBones.Head]);
                    // 5 % of the 58 cm from hips to head.
                    Assert.AreEqual(aside < 0.029f, paired, aside + " m aside");
                }
            }
        }

        [Test]
        public void a_name_within_a_name_is_not_mistaken()
        {
            var figure = new ConversionFigure().Make();
            // As Mixamo has it: Spine, Spine1; and an arm within an upper arm.
            figure.Bones[HumanBodyBones.Spine].name = "Spine";
            figure.Bones[HumanBodyBones.Chest].name = "Spine1";
            figure.Bones[HumanBodyBones.LeftUpperArm].name = "Arm.L";
            figure.Bones[HumanBodyBones.LeftLowerArm].name = "ForeArm.L";
            UnityEngine.Object.DestroyImmediate(figure.Root.GetComponent<Animator>());
            Wardrobe.MakeHumanoid(figure.Root, figure.Bones, null);
            SkinnedMeshRenderer coat = Wardrobe.Coat(figure, 0.015f);
            foreach (Func<string, string> rename in new Func<string, string>[] { name => name, name => "Coat_" + name, name => name + "1" })
            {
                Transform old = figure.Root.transform.Find("Outfit");
                if (old != null) UnityEngine.Object.DestroyImmediate(old.gameObject);
                coat.bones = figure.Body.bones;
                coat.sharedMesh.bindposes = figure.Body.sharedMesh.bindposes;
                var twins = Wardrobe.Armature(figure.Root, figure.Bones[HumanBodyBones.Hips], rename);
                Wardrobe.Bind(coat, twins);
                using (AvatarData data = CharacterReader.Read(figure.Root, new ReadOptions()))
                {
                    foreach (KeyValuePair<Transform, Transform> pair in twins)
                    {
                        Assert.AreEqual(pair.Key.name, data.Joints[data.Twins[data.IndexOf(pair.Value)]].name, pair.Value.name);
                    }
                }
            }
        }

        [Test]
        public void of_a_name_within_a_name_the_longer_one_counts_where_nothing_else_tells()
        {
            var figure = new ConversionFigure().Make();
            figure.Bones[HumanBodyBones.LeftUpperArm].name = "Arm.L";
            figure.Bones[HumanBodyBones.LeftLowerArm].name = "ForeArm.L";
            UnityEngine.Object.DestroyImmediate(figure.Root.GetComponent<Animator>());
            Wardrobe.MakeHumanoid(figure.Root, figure.Bones, null);
            // A bracelet: one joint alone, which "Arm.L" with "My_Fore" before it would be as well as "ForeArm.L" with "My_".
            Transform bracelet = new GameObject("My_ForeArm.L").transform;
            bracelet.SetParent(figure.Root.transform, false);
            bracelet.position = figure.Bones[HumanBodyBones.LeftLowerArm].position;
            SkinnedMeshRenderer ring = UnityEngine.Object.Instantiate(figure.Hair, figure.Root.transform);
            ring.name = "Ring";
            ring.bones = figure.Hair.bones;
            Wardrobe.Bind(ring, new Dictionary<Transform, Transform> { { figure.Bones[HumanBodyBones.Head], bracelet } });
            using (AvatarData data = CharacterReader.Read(figure.Root, new ReadOptions()))
            {
                Assert.AreEqual("ForeArm.L", data.Joints[data.Twins[data.IndexOf(bracelet)]].name);
            }
        }

        [Test]
        public void joints_that_do_not_follow_are_named()
        {
            Dressed dressed = Dress("names", 1);
            // The arms hang from elsewhere, and are called otherwise.
            Transform arm = dressed.Twins[dressed.Figure.Bones[HumanBodyBones.LeftUpperArm]];
            arm.name = "Sleeve";
            dressed.Twins[dressed.Figure.Bones[HumanBodyBones.LeftLowerArm]].name = "Cuff";
            dressed.Twins[dressed.Figure.Bones[HumanBodyBones.LeftHand]].name = "Lace";
            arm.SetParent(dressed.Outfit, true);
            Finding said = AvatarChecks.Of(dressed.Figure.Root).Find(finding => finding.Severity == Severity.Warning);
            Assert.AreEqual("outfit_partly", said.Key);
            StringAssert.Contains("Sleeve, Cuff, Lace", said.Text);
            foreach (string language in Strings.Languages)
            {
                Strings.Language = language;
                StringAssert.Contains("Sleeve, Cuff, Lace", said.Text);
                StringAssert.Contains("Outfit", said.Text);
            }
            Strings.Language = "en";
        }

        [Test]
        public void a_link_to_one_bone_carries_and_pairs_nothing()
        {
            Dressed dressed = Dress("own Animator", 1);
            UnityEngine.Object.DestroyImmediate(dressed.Outfit.GetComponent<Animator>());
            Transform hips = dressed.Twins[dressed.Figure.Bones[HumanBodyBones.Hips]];
            dressed.Outfit.gameObject.AddComponent<VRCFury>().content = new ArmatureLink
            {
                propBone = hips.gameObject, linkTo = new List<ArmatureLink.LinkTo> { new ArmatureLink.LinkTo { bone = HumanBodyBones.Head } }
            };
            using (AvatarData data = CharacterReader.Read(dressed.Figure.Root, new ReadOptions()))
            {
                Assert.AreEqual(data.IndexOf(hips), data.Twins[data.IndexOf(hips)]);
                Assert.AreEqual(data.IndexOf(dressed.Figure.Bones[HumanBodyBones.Head]), data.MergedParents[data.IndexOf(hips)]);
            }
        }
    }
}
