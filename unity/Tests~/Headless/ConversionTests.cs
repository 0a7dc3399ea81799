using System;
using System.Collections.Generic;
using System.IO;
using NUnit.Framework;
using UnityEditor;
using UnityEngine;
using UnityStubs;

namespace SuperDeform.Editor.Tests
{
    [TestFixture]
    public class ConversionTests
    {
        const double Height = 1.9;

        [SetUp]
        public void Begin()
        {
            // Without a single file, so that whatever is left behind stands out.
            Directory.Delete(Path.Combine(Models.NewProject(), "Assets/Models"));
        }

        static ConversionSettings Settings()
        {
            return new ConversionSettings { Heads = 2.5f, OutputFolder = "Assets/Out", PlaceInScene = false };
        }

        internal static Transform Find(GameObject root, string name)
        {
            Transform found = Array.Find(root.GetComponentsInChildren<Transform>(true), transform => transform.name == name);
            Assert.That(found, Is.Not.Null, name);
            return found;
        }

        [Test]
        public void the_result_is_drawn_where_the_library_puts_it()
        {
            foreach (bool turned in new[] { false, true })
            {
                ConversionFigure figure = new ConversionFigure { Turned = turned }.Make();
                ConversionResult result = DrawsWhatTheLibraryGives(figure.Root, Settings());
                Assert.That(result.Report.Result.Heads, Is.LessThan(result.Report.Target.Heads));
            }
        }

        [Test]
        public void a_turned_and_scaled_armature_changes_nothing()
        {
            // The rings of the tubes lie in planes that profiles cut along: rounding takes the one or the other side of a ring.
            foreach (double profile in new[] { 0.0, 1.0 })
            {
                ConversionSettings settings = Settings();
                settings.Options.Profile = profile;
                ConversionResult plain = Converter.Convert(new ConversionFigure().Make().Root, settings, null);
                ConversionResult turned = Converter.Convert(new ConversionFigure { Turned = true }.Make().Root, settings, null);
                foreach (string name in new[] { "Body", "Hair", "Hat" })
                {
                    Assert.That(Drawing.Apart(Drawing.Drawn(plain.Prefab, name), Drawing.Drawn(turned.Prefab, name)), Is.LessThan((profile == 0 ? 1e-4 : 5e-3) * Height), name);
                }
            }
        }

        [Test]
        public void nothing_of_the_source_changes()
        {
            ConversionFigure figure = new ConversionFigure { Turned = true, WithShapes = true }.Make();
            string before = Fingerprint.Of(figure.Root);
            Converter.Convert(figure.Root, Settings(), null);
            Assert.AreEqual(before, Fingerprint.Of(figure.Root));
        }

        [Test]
        public void an_amount_of_0_gives_every_bit_back()
        {
            ConversionFigure figure = new ConversionFigure { Turned = true, WithShapes = true }.Make();
            ConversionSettings settings = Settings();
            settings.Options.Amount = 0;
            GameObject prefab = Converter.Convert(figure.Root, settings, null).Prefab;
            Mesh old = figure.Body.sharedMesh, made = Find(prefab, "Body").GetComponent<SkinnedMeshRenderer>().sharedMesh;
            Assert.AreNotSame(old, made);
            Assert.AreEqual(old.vertices, made.vertices);
            Assert.AreEqual(old.normals, made.normals);
            Assert.AreEqual(old.tangents, made.tangents);
            Assert.AreEqual(old.bindposes, made.bindposes);
            Assert.AreEqual(Frames(old), Frames(made));
            foreach (Transform bone in figure.Bones.Values) Assert.AreEqual(bone.localPosition, Find(prefab, bone.name).localPosition);
            Assert.AreEqual(0.1f, Find(prefab, "J_Head").GetComponent<SphereCollider>().radius, 1e-6);
        }

        static List<Vector3> Frames(Mesh mesh)
        {
            var all = new List<Vector3>();
            for (int shape = 0; shape < mesh.blendShapeCount; shape++)
            {
                for (int frame = 0; frame < mesh.GetBlendShapeFrameCount(shape); frame++)
                {
                    Vector3[] positions = new Vector3[mesh.vertexCount], normals = new Vector3[mesh.vertexCount], tangents = new Vector3[mesh.vertexCount];
                    mesh.GetBlendShapeFrameVertices(shape, frame, positions, normals, tangents);
                    all.AddRange(positions);
                    all.AddRange(normals);
                    all.AddRange(tangents);
                }
            }
            return all;
        }

        [Test]
        public void a_blend_shape_at_full_weight_is_the_deformed_face()
        {
            // Deforming the figure with the shape baked into its vertices must give what the shape gives on the result.
            ConversionFigure figure = new ConversionFigure { Turned = true, WithShapes = true }.Make();
            ConversionSettings settings = Settings();
            settings.Options.FaceSquash = 0.5f;
            GameObject prefab = Converter.Convert(figure.Root, settings, null).Prefab;
            var body = Find(prefab, "Body").GetComponent<SkinnedMeshRenderer>();
            Vector3[] rest = Drawing.Drawn(prefab, "Body");
            using (AvatarData data = CharacterReader.Read(figure.Root, new ReadOptions { WithMorphs = true }))
            using (Style style = settings.MakeStyle())
            using (var deformer = new Deformer(data.Character, style, settings.Options, null))
            {
                RendererData renderer = data.Renderers.Find(r => r.Renderer == figure.Body);
                Assert.AreEqual(3, renderer.Frames.Count);
                Assert.AreEqual(2, body.sharedMesh.blendShapeCount);
                Assert.AreEqual(2, body.sharedMesh.GetBlendShapeFrameCount(0));
                Assert.AreEqual(50f, body.sharedMesh.GetBlendShapeFrameWeight(0, 0));
                Vector3[] written = new Vector3[rest.Length], none = new Vector3[rest.Length];
                body.sharedMesh.GetBlendShapeFrameVertices(0, 1, written, none, null);
                Affine toModel = renderer.Placement;
                BlendDeltas given = BlendDeltas.Of(rest.Length);
                given.Read(renderer.Mesh, renderer.Frames[1]);
                int moved = 0;
                for (int vertex = 0; vertex < rest.Length; vertex++)
                {
                    Vector3 delta = toModel.Direction(Double3.Of(given.Positions[vertex])).ToVector3();
                    Vector3 now = toModel.Direction(Double3.Of(written[vertex])).ToVector3();
                    if (delta == Vector3.zero)
                    {
                        Assert.AreEqual(Vector3.zero, written[vertex]);
                        continue;
                    }
                    // A head that grows moves its shapes further: the same way, in the head's measure.
                    moved++;
                    Assert.That(Vector3.Dot(now.normalized, delta.normalized), Is.GreaterThan(0.7f));
                    Assert.That(now.magnitude, Is.InRange(0.3f * delta.magnitude, 4f * delta.magnitude));
                }
                Assert.That(moved, Is.GreaterThan(50));
            }
        }

        [Test]
        public void the_prefab_holds_what_the_source_held()
        {
            ConversionFigure figure = new ConversionFigure { WithShapes = true }.Make();
            ConversionResult result = Converter.Convert(figure.Root, Settings(), null);
            Mesh old = figure.Body.sharedMesh;
            var body = Find(result.Prefab, "Body").GetComponent<SkinnedMeshRenderer>();
            Assert.AreEqual("Assets/Out/Mika_SD/Mika_SD.prefab", result.PrefabPath);
            Assert.AreEqual(old.uv, body.sharedMesh.uv);
            Assert.AreEqual(old.GetIndices(1), body.sharedMesh.GetIndices(1));
            Assert.AreEqual(old.GetAllBoneWeights().ToArray(), body.sharedMesh.GetAllBoneWeights().ToArray());
            Assert.AreEqual(old.name, body.sharedMesh.name);
            Assert.AreEqual(Array.ConvertAll(figure.Body.sharedMaterials, m => m.name), Array.ConvertAll(body.sharedMaterials, m => m.name));
            Assert.AreEqual(figure.Body.bones.Length, body.bones.Length);
            foreach (Transform bone in body.bones) Assert.That(bone.IsChildOf(result.Prefab.transform), bone.name);
            Assert.AreEqual("Assets/Out/Mika_SD/Mika_SD.asset", AssetDatabase.GetAssetPath(body.sharedMesh));
            var preset = AssetDatabase.LoadAssetAtPath<SuperDeformPreset>("Assets/Out/Mika_SD/Mika_SD.asset");
            Assert.AreEqual(2.5f, preset.Settings.Heads);
            // Nothing of the work is left in the scene.
            Assert.That(GameObject.Find("Mika_SD"), Is.Null);
        }

        [Test]
        public void the_avatar_knows_the_new_bones()
        {
            ConversionFigure figure = new ConversionFigure { Turned = true }.Make();
            GameObject prefab = Converter.Convert(figure.Root, Settings(), null).Prefab;
            Avatar avatar = prefab.GetComponent<Animator>().avatar, old = figure.Root.GetComponent<Animator>().avatar;
            Assert.AreNotSame(old, avatar);
            Assert.That(avatar.isValid && avatar.isHuman);
            Assert.AreEqual(old.humanDescription.human.Length, avatar.humanDescription.human.Length);
            Assert.AreEqual(0.25f, avatar.humanDescription.upperArmTwist);
            foreach (SkeletonBone bone in avatar.humanDescription.skeleton)
            {
                if (bone.name != prefab.name)
                {
                    Assert.That(Vector3.Distance(bone.position, Find(prefab, bone.name).localPosition), Is.LessThan(1e-4), bone.name);
                }
            }
            Assert.AreSame(Find(prefab, "J_Head"), prefab.GetComponent<Animator>().GetBoneTransform(HumanBodyBones.Head));
        }

        [Test]
        public void colliders_follow_what_they_are_around()
        {
            ConversionFigure figure = new ConversionFigure().Make();
            ConversionResult result = Converter.Convert(figure.Root, Settings(), null);
            double height = result.Report.Result.Height / result.Report.Target.Height;
            var sphere = Find(result.Prefab, "J_Head").GetComponent<SphereCollider>();
            Vector3 center = sphere.transform.TransformPoint(sphere.center);
            Vector3[] hair = Drawing.Drawn(result.Prefab, "Hair");
            var box = new Bounds(hair[0], Vector3.zero);
            foreach (Vector3 p in hair) box.Encapsulate(p);
            Assert.That(Vector3.Distance(box.center, center), Is.LessThan(0.2f * box.extents.y));
            Assert.That(sphere.radius, Is.InRange(0.6f * box.extents.x, 1.2f * box.extents.x));
            var controller = result.Prefab.GetComponent<CharacterController>();
            Assert.AreEqual(1.8 * height, controller.height, 1e-3);
            Assert.AreEqual(0.9 * height, controller.center.y, 0.02);
            var capsule = Find(result.Prefab, "J_LeftUpperLeg").GetComponent<CapsuleCollider>();
            Assert.That(capsule.height, Is.LessThan(0.45f));
        }

        [Test]
        public void bounds_hold_the_new_mesh()
        {
            ConversionFigure figure = new ConversionFigure { Turned = true }.Make();
            GameObject prefab = Converter.Convert(figure.Root, Settings(), null).Prefab;
            var body = Find(prefab, "Body").GetComponent<SkinnedMeshRenderer>();
            Matrix4x4 toBone = body.rootBone.worldToLocalMatrix * prefab.transform.localToWorldMatrix;
            Bounds wide = body.localBounds;
            wide.Expand(1e-3f * wide.size.magnitude);
            foreach (Vector3 p in Drawing.Drawn(prefab, "Body")) Assert.That(wide.Contains(toBone.MultiplyPoint3x4(p)));
        }

        [Test]
        public void an_instance_stands_beside_the_source_until_undone()
        {
            ConversionFigure figure = new ConversionFigure().Make();
            ConversionSettings settings = Settings();
            settings.PlaceInScene = true;
            GameObject instance = Converter.Convert(figure.Root, settings, null).Instance;
            Assert.That(instance, Is.Not.Null);
            Assert.That(instance.transform.localPosition.x, Is.GreaterThan(1));
            Undo.PerformUndo();
            Assert.That(instance == null);
            Assert.That(File.Exists("Assets/Out/Mika_SD/Mika_SD.prefab"));
        }

        [Test]
        public void outlines_of_a_width_in_the_world_shrink_with_the_figure()
        {
            ConversionFigure figure = new ConversionFigure().Make();
            Material[] skin = figure.Body.sharedMaterials, hair = figure.Hair.sharedMaterials;
            foreach (Material material in new[] { skin[0], skin[1], hair[0] })
            {
                material.SetFloat("_OutlineWidthMode", material == skin[1] ? 2 : 1);
                material.SetFloat("_OutlineWidth", 0.4f);
            }
            figure.Hat.sharedMaterials = new[] { skin[0] };
            ConversionResult result = Converter.Convert(figure.Root, Settings(), null);
            Material[] made = Find(result.Prefab, "Body").GetComponent<Renderer>().sharedMaterials;
            double ratio = result.Report.Result.Height / result.Report.Target.Height;
            Assert.AreEqual(0.4 * ratio, made[0].GetFloat("_OutlineWidth"), 1e-4);
            Assert.AreEqual(skin[0].name, made[0].name);
            Assert.AreEqual(0.4f, skin[0].GetFloat("_OutlineWidth"));
            Assert.AreSame(skin[1], made[1]);
            Assert.AreSame(made[0], Find(result.Prefab, "Hat").GetComponent<Renderer>().sharedMaterial);
        }

        [Test]
        public void missing_scripts_are_left_out_and_that_is_said()
        {
            ConversionFigure figure = new ConversionFigure().Make();
            StubEditor.AddMissingScript(figure.Bones[HumanBodyBones.Head].gameObject);
            ConversionResult result = Converter.Convert(figure.Root, Settings(), null);
            Assert.That(result.Findings.Exists(finding => finding.Key == "missing_scripts" && (int)finding.Values[1] == 1));
            Assert.AreEqual(1, GameObjectUtility.GetMonoBehavioursWithMissingScriptCount(figure.Bones[HumanBodyBones.Head].gameObject));
        }

        [Test]
        public void what_is_hidden_by_a_scale_of_0_stays_as_it_is()
        {
            ConversionFigure figure = new ConversionFigure().Make();
            figure.Hat.transform.localScale = Vector3.zero;
            Mesh hat = figure.Hat.GetComponent<MeshFilter>().sharedMesh;
            AssetDatabase.CreateAsset(hat, "Assets/Hat.asset");
            GameObject prefab = Converter.Convert(figure.Root, Settings(), null).Prefab;
            Assert.AreSame(hat, Find(prefab, "Hat").GetComponent<MeshFilter>().sharedMesh);
            Assert.That(Find(prefab, "Hat").localScale == Vector3.zero);
        }

        [Test]
        public void a_new_copy_overwrites_nothing()
        {
            ConversionFigure figure = new ConversionFigure().Make();
            ConversionSettings settings = Settings();
            settings.NewCopy = true;
            string first = Converter.Convert(figure.Root, settings, null).PrefabPath;
            byte[] bytes = File.ReadAllBytes(first);
            ConversionResult second = Converter.Convert(figure.Root, settings, null);
            Assert.AreNotEqual(first, second.PrefabPath);
            Assert.That(second.Updated, Is.False);
            Assert.AreEqual(bytes, File.ReadAllBytes(first));
        }

        [Test]
        public void converting_again_brings_the_same_files_up_to_date()
        {
            ConversionFigure figure = new ConversionFigure { WithShapes = true }.Make();
            ConversionSettings settings = Settings();
            settings.PlaceInScene = true;
            ConversionResult first = Converter.Convert(figure.Root, settings, null);
            string prefab = AssetDatabase.AssetPathToGUID(first.PrefabPath), container = Path.ChangeExtension(first.PrefabPath, ".asset");
            Mesh mesh = Find(first.Prefab, "Body").GetComponent<SkinnedMeshRenderer>().sharedMesh;
            Avatar avatar = first.Prefab.GetComponent<Animator>().avatar;
            Vector3[] before = mesh.vertices;
            string[] files = StubProject.FilesOnDisk();
            settings.Heads = 3.5f;
            ConversionResult second = Converter.Convert(figure.Root, settings, null);
            Assert.That(second.Updated);
            Assert.AreEqual(first.PrefabPath, second.PrefabPath);
            Assert.AreEqual(prefab, AssetDatabase.AssetPathToGUID(second.PrefabPath));
            Assert.AreEqual(files, StubProject.FilesOnDisk());
            Assert.AreSame(mesh, Find(second.Prefab, "Body").GetComponent<SkinnedMeshRenderer>().sharedMesh, "the mesh that others may refer to");
            Assert.AreSame(avatar, second.Prefab.GetComponent<Animator>().avatar);
            Assert.AreNotEqual(before, mesh.vertices);
            Assert.AreSame(first.Instance, second.Instance, "no second instance");
            Assert.AreEqual(3.5f, AssetDatabase.LoadAssetAtPath<SuperDeformPreset>(container).Settings.Heads);
            settings.NewCopy = true;
            Assert.AreEqual(Drawing.Drawn(Converter.Convert(figure.Root, settings, null).Prefab, "Body"), Drawing.Drawn(second.Prefab, "Body"), "as a new copy");
        }

        [Test]
        public void what_a_person_has_added_to_a_result_stays()
        {
            ConversionFigure figure = new ConversionFigure().Make();
            string path = Converter.Convert(figure.Root, Settings(), null).PrefabPath;
            GameObject contents = PrefabUtility.LoadPrefabContents(path);
            Transform head = Find(contents, "J_Head");
            var crown = new GameObject("Crown").transform;
            crown.SetParent(head, false);
            crown.localPosition = new Vector3(0, 0.3f, 0);
            crown.gameObject.AddComponent<VRC.SDK3.Dynamics.PhysBone.Components.VRCPhysBoneCollider>().rootTransform = head;
            var bone = Find(contents, "J_LeftHand").gameObject.AddComponent<VRC.SDK3.Dynamics.PhysBone.Components.VRCPhysBone>();
            bone.rootTransform = crown;
            bone.radius = 0.123f;
            PrefabUtility.SaveAsPrefabAsset(contents, path);
            PrefabUtility.UnloadPrefabContents(contents);
            // A new thing of the source comes, and what went goes.
            new GameObject("Ribbon").transform.SetParent(figure.Bones[HumanBodyBones.Chest], false);
            UnityEngine.Object.DestroyImmediate(figure.Hat.gameObject);
            for (int time = 0; time < 2; time++)
            {
                GameObject prefab = Converter.Convert(figure.Root, Settings(), null).Prefab;
                Assert.AreEqual(1, Array.FindAll(prefab.GetComponentsInChildren<Transform>(true), one => one.name == "Crown").Length);
                Transform stays = Find(prefab, "Crown");
                Assert.AreEqual("J_Head", stays.parent.name);
                Assert.AreEqual(0.3f, stays.localPosition.y);
                Assert.AreSame(stays.parent, stays.GetComponent<VRC.SDK3.Dynamics.PhysBone.Components.VRCPhysBoneCollider>().rootTransform);
                var hand = Find(prefab, "J_LeftHand").GetComponents<VRC.SDK3.Dynamics.PhysBone.Components.VRCPhysBone>();
                Assert.AreEqual(1, hand.Length);
                Assert.AreEqual(0.123f, hand[0].radius);
                Assert.AreSame(stays, hand[0].rootTransform);
                Assert.That(Find(prefab, "Ribbon"), Is.Not.Null);
                Assert.That(Array.Exists(prefab.GetComponentsInChildren<Transform>(true), one => one.name == "Hat"), Is.False);
            }
        }

        [Test]
        public void another_avatar_of_the_same_name_gets_its_own_result()
        {
            string first = Converter.Convert(new ConversionFigure().Make().Root, Settings(), null).PrefabPath;
            string second = Converter.Convert(new ConversionFigure().Make().Root, Settings(), null).PrefabPath;
            Assert.AreNotEqual(first, second);
        }

        [Test]
        public void an_update_that_cannot_be_written_leaves_the_files_as_they_were()
        {
            ConversionFigure figure = new ConversionFigure().Make();
            string path = Converter.Convert(figure.Root, Settings(), null).PrefabPath, container = Path.ChangeExtension(path, ".asset");
            byte[] prefab = File.ReadAllBytes(path), assets = File.ReadAllBytes(container);
            foreach (string ending in new[] { ".prefab", ".asset" })
            {
                int writes = 0;
                StubDisk.Refuse = delegate (string file)
                {
                    if (!file.EndsWith(ending) || writes++ > 0) return false;
                    // What a disk does that is full: the file is begun.
                    File.WriteAllText(file, "half");
                    return true;
                };
                ConversionSettings other = Settings();
                other.Heads = 4;
                Assert.Throws<ConversionException>(() => Converter.Convert(figure.Root, other, null));
                StubDisk.Refuse = null;
                Assert.AreEqual(prefab, File.ReadAllBytes(path), ending);
                Assert.AreEqual(assets.Length, File.ReadAllBytes(container).Length, ending);
            }
        }

        [Test]
        public void a_refused_write_leaves_nothing()
        {
            ConversionFigure figure = new ConversionFigure().Make();
            foreach (string ending in new[] { ".prefab", ".asset", "Out" })
            {
                StubDisk.Refuse = path => path.EndsWith(ending);
                Refused(figure);
            }
            StubDisk.Refuse = null;
            Converter.Convert(figure.Root, Settings(), null);
        }

        [Test]
        public void a_full_disk_leaves_nothing()
        {
            ConversionFigure figure = new ConversionFigure().Make();
            Converter.Convert(figure.Root, Settings(), null);
            long whole = StubDisk.Written;
            Assert.That(AssetDatabase.DeleteAsset("Assets/Out"));
            for (int share = 0; share < 10; share++)
            {
                StubDisk.FailAfterBytes = whole * share / 10;
                Refused(figure);
            }
        }

        /// <summary>All objects that are not destroyed.</summary>
        static HashSet<int> Objects()
        {
            return new HashSet<int>(Registry.All().ConvertAll(value => value.GetInstanceID()));
        }

        static void Refused(ConversionFigure figure)
        {
            HashSet<int> objects = Objects();
            var refused = Assert.Throws<ConversionException>(() => Converter.Convert(figure.Root, Settings(), null));
            Assert.AreEqual("write_refused", refused.Finding.Key);
            Assert.AreEqual(new string[0], StubProject.FilesOnDisk());
            Assert.That(Objects(), Is.SubsetOf(objects));
        }

        sealed class Stops : IConversionProgress
        {
            public int After;
            public readonly List<string> Stages = new List<string>();
            float last;

            public bool Report(string stageKey, float fraction)
            {
                Assert.That(fraction, Is.InRange(last, 1f));
                last = fraction;
                if (!Stages.Contains(stageKey)) Stages.Add(stageKey);
                return After-- > 0;
            }
        }

        [Test]
        public void cancelling_at_any_time_leaves_nothing()
        {
            ConversionFigure figure = new ConversionFigure().Make();
            var whole = new Stops { After = int.MaxValue };
            Converter.Convert(figure.Root, Settings(), whole);
            Assert.That(AssetDatabase.DeleteAsset("Assets/Out"));
            int calls = int.MaxValue - whole.After;
            HashSet<int> objects = Objects();
            // The last call only says that all is done.
            for (int after = 0; after < calls - 1; after += 1 + calls / 12)
            {
                var cancelled = Assert.Throws<ConversionException>(() => Converter.Convert(figure.Root, Settings(), new Stops { After = after }));
                Assert.That(cancelled.Cancelled, after.ToString());
                Assert.AreEqual(new string[0], StubProject.FilesOnDisk());
                Assert.That(Objects(), Is.SubsetOf(objects));
            }
        }

        [Test]
        public void renderers_of_one_mesh_share_the_new_one_where_they_come_out_the_same()
        {
            ConversionFigure figure = new ConversionFigure().Make();
            GameObject twin = UnityEngine.Object.Instantiate(figure.Hair.gameObject, figure.Root.transform);
            twin.name = "Hair twin";
            GameObject second = UnityEngine.Object.Instantiate(figure.Hat.gameObject, figure.Bones[HumanBodyBones.LeftHand]);
            second.name = "Hat in hand";
            twin.GetComponent<SkinnedMeshRenderer>().bones = figure.Hair.bones;
            GameObject prefab = Converter.Convert(figure.Root, Settings(), null).Prefab;
            Assert.AreSame(Find(prefab, "Hair").GetComponent<SkinnedMeshRenderer>().sharedMesh, Find(prefab, "Hair twin").GetComponent<SkinnedMeshRenderer>().sharedMesh);
            Assert.AreNotSame(Find(prefab, "Hat").GetComponent<MeshFilter>().sharedMesh, Find(prefab, "Hat in hand").GetComponent<MeshFilter>().sharedMesh);
        }

        /// <summary>The figure as meshes alone: no bones, no animator.</summary>
        static GameObject Unrigged(ConversionFigure figure)
        {
            var root = new GameObject("Statue");
            foreach (SkinnedMeshRenderer skinned in new[] { figure.Body, figure.Hair })
            {
                var holder = new GameObject(skinned.name);
                holder.transform.SetParent(root.transform, false);
                holder.transform.localRotation = skinned.transform.localRotation;
                holder.transform.localScale = skinned.transform.localScale;
                Mesh mesh = UnityEngine.Object.Instantiate(skinned.sharedMesh);
                mesh.boneWeights = new BoneWeight[0];
                mesh.bindposes = new Matrix4x4[0];
                holder.AddComponent<MeshFilter>().sharedMesh = mesh;
                holder.AddComponent<MeshRenderer>().sharedMaterials = skinned.sharedMaterials;
            }
            UnityEngine.Object.DestroyImmediate(figure.Root);
            return root;
        }

        [Test]
        public void an_avatar_without_bones_gets_a_rig_that_holds_it()
        {
            GameObject statue = Unrigged(new ConversionFigure { Turned = true }.Make());
            string before = Fingerprint.Of(statue);
            ConversionResult result = DrawsWhatTheLibraryGives(statue, Settings());
            Assert.AreEqual(before, Fingerprint.Of(statue));
            Assert.That(result.Findings.Exists(finding => finding.Key == "rig_will_be_made"));
            Assert.That(result.Report.RigMade);
            var body = Find(result.Prefab, "Body").GetComponent<SkinnedMeshRenderer>();
            Assert.That(body.GetComponent<MeshFilter>() == null && body.GetComponent<MeshRenderer>() == null);
            Assert.AreEqual(2, body.sharedMaterials.Length);
            Assert.AreSame(Find(result.Prefab, "Hips"), body.rootBone);
            foreach (byte count in body.sharedMesh.GetBonesPerVertex()) Assert.That(count, Is.InRange(1, 4));
            var animator = result.Prefab.GetComponent<Animator>();
            Assert.That(animator.avatar.isValid && animator.avatar.isHuman);
            Assert.AreSame(Find(result.Prefab, "LeftUpperArm"), animator.GetBoneTransform(HumanBodyBones.LeftUpperArm));
            // A made rig is that of a person: the left arm is on the left.
            Assert.That(Find(result.Prefab, "LeftLowerArm").position.x, Is.LessThan(Find(result.Prefab, "LeftUpperArm").position.x));
            Assert.That(Find(result.Prefab, "LeftUpperArm").position.x, Is.LessThan(Find(result.Prefab, "RightUpperArm").position.x));
        }

        [Test]
        public void the_avatar_of_a_made_rig_stands_in_t_pose()
        {
            ConversionFigure figure = new ConversionFigure().Make();
            // Arms 45 degrees down, bound so.
            GameObject statue = Unrigged(figure);
            foreach (MeshFilter filter in statue.GetComponentsInChildren<MeshFilter>())
            {
                filter.sharedMesh.vertices = Array.ConvertAll(filter.sharedMesh.vertices, Lowered);
            }
            GameObject prefab = Converter.Convert(statue, Settings(), null).Prefab;
            var turned = new Dictionary<string, Quaternion>();
            var places = new Dictionary<string, Vector3>();
            foreach (SkeletonBone bone in prefab.GetComponent<Animator>().avatar.humanDescription.skeleton)
            {
                Transform transform = bone.name == prefab.name ? prefab.transform : Find(prefab, bone.name);
                bool root = transform == prefab.transform;
                turned[bone.name] = root ? Quaternion.identity : turned[transform.parent.name] * bone.rotation;
                places[bone.name] = root ? Vector3.zero : places[transform.parent.name] + turned[transform.parent.name] * bone.position;
            }
            foreach (string side in new[] { "Left", "Right" })
            {
                Vector3 arm = places[side + "Hand"] - places[side + "UpperArm"], leg = places[side + "Foot"] - places[side + "UpperLeg"];
                Assert.That(Vector3.Angle(arm, side == "Left" ? Vector3.left : Vector3.right), Is.LessThan(1f), side + " arm");
                Assert.That(Vector3.Angle(leg, Vector3.down), Is.LessThan(1f), side + " leg");
            }
            // The transforms themselves stay in the pose of the mesh.
            Vector3 stands = Find(prefab, "LeftHand").position - Find(prefab, "LeftUpperArm").position;
            Assert.That(Vector3.Angle(stands, Vector3.left), Is.InRange(30f, 60f));
        }

        static Vector3 Lowered(Vector3 p)
        {
            float beyond = Mathf.Abs(p.x) - 0.18f;
            if (p.y < 1.3f || beyond <= 0) return p;
            var shoulder = new Vector3(0.18f * Mathf.Sign(p.x), 1.45f, 0);
            return shoulder + Quaternion.AngleAxis(-45 * Mathf.Sign(p.x), Vector3.forward) * (p - shoulder);
        }

        [Test]
        public void a_new_rig_is_made_for_a_rigged_avatar_where_it_is_wanted()
        {
            ConversionFigure figure = new ConversionFigure { Turned = true }.Make();
            ConversionSettings settings = Settings();
            settings.RigAuto = true;
            ConversionResult result = Converter.Convert(figure.Root, settings, null);
            Assert.That(result.Report.RigMade);
            // Its own bones ride along, and hold the meshes as before.
            Assert.AreEqual(figure.Root.GetComponentsInChildren<Transform>(true).Length, result.Prefab.GetComponentsInChildren<Transform>(true).Length);
            Assert.That(Find(result.Prefab, "J_Head").position.y, Is.LessThan(figure.Bones[HumanBodyBones.Head].position.y));
        }

        [Test]
        public void an_avatar_in_another_pose_comes_out_in_that_pose()
        {
            ConversionFigure figure = new ConversionFigure().Make();
            GameObject plain = Converter.Convert(figure.Root, Settings(), null).Prefab;
            Quaternion lowered = Quaternion.AngleAxis(70, Vector3.forward);
            figure.Bones[HumanBodyBones.LeftUpperArm].localRotation = lowered;
            ConversionSettings settings = Settings();
            settings.NewCopy = true;
            ConversionResult posed = Converter.Convert(figure.Root, settings, null);
            Assert.That(posed.Findings.Exists(finding => finding.Key == "pose_not_rest"));
            Assert.AreEqual(lowered, Find(posed.Prefab, "J_LeftUpperArm").localRotation);
            Assert.That(Drawing.Apart(Find(plain, "Body").GetComponent<SkinnedMeshRenderer>().sharedMesh.vertices, Find(posed.Prefab, "Body").GetComponent<SkinnedMeshRenderer>().sharedMesh.vertices), Is.LessThan(1e-5 * Height));
        }

        [Test]
        public void an_avatar_that_was_bound_with_its_arms_down_is_read_as_it_stands()
        {
            ConversionFigure figure = new ConversionFigure().Make();
            Transform arm = figure.Bones[HumanBodyBones.LeftUpperArm];
            // Bound with the arm down, as the mesh has it; then stood up again.
            arm.localRotation = Quaternion.AngleAxis(89, Vector3.forward);
            Vector3[] down = Drawing.Drawn(figure.Root, "Body");
            figure.Body.sharedMesh.vertices = down;
            figure.Body.sharedMesh.bindposes = Array.ConvertAll(figure.Body.bones, bone => bone.worldToLocalMatrix);
            figure.Hair.sharedMesh.bindposes = Array.ConvertAll(figure.Hair.bones, bone => bone.worldToLocalMatrix);
            Assert.That(AvatarChecks.Of(figure.Root).Exists(finding => finding.Key == "pose_far"));
            arm.localRotation = Quaternion.identity;
            Assert.That(AvatarChecks.Of(figure.Root).Exists(finding => finding.Key == "pose_far"), Is.False);
            DrawsWhatTheLibraryGives(figure.Root, Settings());
        }

        /// <summary>Converts, and compares what is drawn with what the library gives for the avatar.</summary>
        static ConversionResult DrawsWhatTheLibraryGives(GameObject avatar, ConversionSettings settings)
        {
            ConversionResult result = Converter.Convert(avatar, settings, null);
            using (AvatarData data = CharacterReader.Read(avatar, new ReadOptions { RigAuto = settings.RigAuto }))
            using (Style style = settings.MakeStyle())
            using (var deformer = new Deformer(data.Character, style, settings.Options, null))
            {
                var expected = new AvatarResult(data, true);
                expected.Apply(deformer, null);
                foreach (RendererResult renderer in expected.Renderers)
                {
                    Assert.That(Drawing.Apart(renderer.Positions, Drawing.Drawn(result.Prefab, renderer.Source.Renderer.name)), Is.LessThan(1e-5 * Height), renderer.Source.Renderer.name);
                }
            }
            return result;
        }

        [Test]
        public void an_avatar_inside_another_object_may_be_turned_and_scaled_there()
        {
            ConversionFigure figure = new ConversionFigure { WithShapes = true }.Make();
            ConversionResult alone = Converter.Convert(figure.Root, Settings(), null);
            var wrapper = new GameObject("Wrapper");
            figure.Root.transform.SetParent(wrapper.transform, false);
            figure.Root.transform.localRotation = Quaternion.AngleAxis(150, Vector3.up);
            figure.Root.transform.localScale = Vector3.one * 2;
            figure.Root.transform.localPosition = new Vector3(3, 0, 1);
            ConversionResult result = DrawsWhatTheLibraryGives(wrapper, Settings());
            Assert.AreEqual(alone.Report.Result.Heads, result.Report.Result.Heads, 0.01);
            Transform inside = Find(result.Prefab, "Mika");
            Assert.That(inside.GetComponent<Animator>().avatar.isHuman);
            // The same shape, in the space of the object that was turned.
            Matrix4x4 back = inside.worldToLocalMatrix * result.Prefab.transform.localToWorldMatrix;
            Vector3[] there = Array.ConvertAll(Drawing.Drawn(result.Prefab, "Body"), p => back.MultiplyPoint3x4(p));
            Assert.That(Drawing.Apart(Drawing.Drawn(alone.Prefab, "Body"), there), Is.LessThan(2e-3 * Height));
        }

        [Test]
        public void bones_without_names_are_told_by_their_shape_and_the_face_is_in_front()
        {
            GameObject named = Converter.Convert(new ConversionFigure().Make().Root, Settings(), null).Prefab;
            ConversionFigure figure = new ConversionFigure().Make();
            UnityEngine.Object.DestroyImmediate(figure.Root.GetComponent<Animator>());
            int number = 0;
            foreach (Transform bone in figure.Bones.Values) bone.name = "b" + number++;
            ConversionResult result = Converter.Convert(figure.Root, Settings(), null);
            Assert.That(result.Findings.Exists(finding => finding.Key == "no_animator"));
            Assert.That(Drawing.Apart(Drawing.Drawn(named, "Body"), Drawing.Drawn(result.Prefab, "Body")), Is.LessThan(1e-3 * Height));
        }

        [Test]
        public void submeshes_are_told_apart_where_they_share_no_vertex()
        {
            var mesh = new Mesh { name = "M" };
            mesh.vertices = new Vector3[10];
            mesh.subMeshCount = 4;
            mesh.SetTriangles(new[] { 1, 2, 3 }, 0);
            mesh.SetTriangles(new[] { 4, 6, 8 }, 1);
            mesh.SetTriangles(new[] { 5, 7, 9, 5, 9, 7 }, 2);
            mesh.SetTriangles(new[] { 3, 2, 1 }, 3);
            var holder = new GameObject("H");
            holder.AddComponent<MeshFilter>().sharedMesh = mesh;
            var shown = holder.AddComponent<MeshRenderer>();
            shown.sharedMaterials = Array.ConvertAll(new[] { "a", "b", "c" }, name => new Material(Shader.Find("Standard")) { name = name });
            List<PartData> parts = SubmeshParts.Of(new RendererData { Renderer = shown, Shown = shown, Mesh = mesh, Vertices = mesh.vertices });
            Assert.AreEqual(new[] { "H/M/a", "H/M/b", "H/M/c" }, parts.ConvertAll(part => part.Name).ToArray());
            // The first two share all vertices with the fourth; vertex 0 goes with what follows it.
            Assert.AreEqual(new[] { 0, 4 }, new[] { parts[0].FirstVertex, parts[0].VertexCount });
            Assert.AreEqual(new[] { 1, 2, 3, 3, 2, 1 }, parts[0].Indices);
            Assert.AreEqual(new[] { 4, 6, 8 }, parts[1].Vertices);
            Assert.AreEqual(new[] { 0, 1, 2 }, parts[1].Indices);
            Assert.AreEqual(new[] { 5, 7, 9 }, parts[2].Vertices);
            Assert.AreEqual(new[] { 0, 1, 2, 0, 2, 1 }, parts[2].Indices);
        }

        [Test]
        public void poses_are_measured_against_t_and_a()
        {
            Assert.AreEqual(0, Angle(0, 0), 1e-4);
            Assert.AreEqual(0, Angle(60, 0), 1e-4);
            Assert.AreEqual(25, Angle(85, 0), 1e-3);
            Assert.AreEqual(40, Angle(-40, 0), 1e-3);
            // The way the figure looks makes no difference.
            Assert.AreEqual(25, Angle(85, 130), 1e-3);
        }

        /// <summary>What is measured with both arms so many degrees down, seen from another side.</summary>
        static double Angle(double down, double turned)
        {
            int[] roles = new int[HumanoidRoles.Count];
            for (int role = 0; role < roles.Length; role++) roles[role] = -1;
            var places = new List<Affine>();
            double x = Math.Cos(down * Math.PI / 180), y = -Math.Sin(down * Math.PI / 180);
            for (int side = -1; side <= 1; side += 2)
            {
                for (int joint = 0; joint < 3; joint++)
                {
                    var role = (HumanBodyBones)((int)HumanBodyBones.LeftUpperArm + 2 * joint + (side + 1) / 2);
                    roles[(int)role] = places.Count;
                    double a = turned * Math.PI / 180, across = side * (0.2 + 0.3 * joint * x);
                    places.Add(Affine.Translation(new Double3(across * Math.Cos(a), 1.4 + 0.3 * joint * y, across * Math.Sin(a))));
                }
            }
            return PoseMeasure.Of(roles, places.ToArray()).Degrees;
        }
    }
}
