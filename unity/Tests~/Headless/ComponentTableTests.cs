using System;
using System.Collections.Generic;
using NUnit.Framework;
using UnityEditor;
using UnityEngine;
using UnityStubs;

namespace SuperDeform.Editor.Tests
{
    /// <summary>Every row of the table of components, on a made-up component of its name and its serialized fields.</summary>
    [TestFixture]
    public class ComponentTableTests
    {
        sealed class Mark : MonoBehaviour { }

        /// <summary>Asks the map of a conversion while there is one.</summary>
        sealed class Probe : IComponentAdapter
        {
            internal static Action<PointMap> Ask;
            public bool Handles(Component copy) { return copy is Mark; }
            public void Adapt(Component copy, PointMap map) { if (Ask != null) Ask(map); }
        }

        internal static void Ask(Action<PointMap> ask)
        {
            Probe.Ask = ask;
        }

        const HumanBodyBones Arm = HumanBodyBones.LeftUpperArm, Leg = HumanBodyBones.RightUpperLeg;
        ConversionFigure figure;
        readonly HashSet<string> tried = new HashSet<string>();

        internal static ConversionSettings Settings()
        {
            return new ConversionSettings { Heads = 2.5f, OutputFolder = "Assets/Out", PlaceInScene = false };
        }

        void Begin()
        {
            figure = Probed();
        }

        /// <summary>A figure in an empty project whose conversion asks what Ask was given.</summary>
        internal static ConversionFigure Probed()
        {
            Models.NewProject();
            ConversionFigure figure = new ConversionFigure().Make();
            figure.Root.AddComponent<Mark>();
            ComponentAdapters.Register(new Probe());
            return figure;
        }

        static object Get(Component component, string path)
        {
            using (var properties = new SerializedObject(component))
            {
                SerializedProperty property = properties.FindProperty(path);
                Assert.That(property, Is.Not.Null, path);
                if (property.propertyType == SerializedPropertyType.Float) return property.floatValue;
                if (property.propertyType == SerializedPropertyType.Vector3) return property.vector3Value;
                if (property.propertyType == SerializedPropertyType.Vector2) return new Vector3(property.vector2Value.x, property.vector2Value.y, 0);
                if (property.propertyType == SerializedPropertyType.String) return property.stringValue;
                return new Vector3((float)Get(component, path + ".x"), (float)Get(component, path + ".y"), (float)Get(component, path + ".z"));
            }
        }

        // Both by small steps through the map, not by its derivatives.
        internal static float Along(PointMap map, Transform frame, Vector3 at, Vector3 axis)
        {
            Vector3 step = axis.normalized * 1e-3f;
            return Vector3.Distance(map.Point(frame, at + step), map.Point(frame, at - step)) / 2e-3f;
        }

        internal static float Across(PointMap map, Transform frame, Vector3 at, Vector3 axis)
        {
            Vector3 one = Vector3.Cross(axis, new Vector3(0.3f, 0.5f, 0.8f)).normalized;
            Vector3 other = Vector3.Cross(axis.normalized, one);
            Vector3 first = map.Point(frame, at + one * 1e-3f) - map.Point(frame, at - one * 1e-3f);
            Vector3 second = map.Point(frame, at + other * 1e-3f) - map.Point(frame, at - other * 1e-3f);
            Vector3 along = map.Point(frame, at + axis.normalized * 1e-3f) - map.Point(frame, at - axis.normalized * 1e-3f);
            return Mathf.Sqrt(Mathf.Abs(Vector3.Dot(Vector3.Cross(first, second), along.normalized))) / 2e-3f;
        }

        static object Times(object old, float scale)
        {
            return old is float ? (object)((float)old * scale) : (Vector3)old * scale;
        }

        /// <summary>One property: "path: rule [argument...]"; what it must become.</summary>
        static object Wanted(PointMap map, Component component, Transform frame, string[] words)
        {
            object old = Get(component, words[0]);
            Vector3 at = words.Length > 2 && words[2] != "-" ? (Vector3)Get(component, words[2]) : Vector3.zero;
            Vector3 axis = words.Length > 3 ? new Vector3(words[3] == "x" ? 1 : 0, words[3] == "y" ? 1 : 0, words[3] == "z" ? 1 : 0) : Vector3.zero;
            switch (words[1])
            {
                case "stays": return old;
                case "point": return map.Point(frame, (Vector3)old);
                case "length": return Times(old, map.Scale(frame, at));
                case "along": return Times(old, Along(map, frame, at, axis));
                case "across": return Times(old, Across(map, frame, at, axis));
                case "sides":
                    Vector3 size = (Vector3)old;
                    return new Vector3(size.x * Along(map, frame, at, Vector3.right), size.y * Along(map, frame, at, Vector3.up), size.z * Along(map, frame, at, Vector3.forward));
                case "chain":
                    float sum = 0;
                    Transform[] chain = frame.GetComponentsInChildren<Transform>(true);
                    foreach (Transform joint in chain) sum += map.Scale(joint, Vector3.zero);
                    return Times(old, sum / chain.Length);
                case "end": return map.Point(Last(frame), (Vector3)old);
                case "endlength": return Times(old, map.Scale(Last(frame), Vector3.zero));
                case "rest": return (Vector3)old + (map.Joint(frame).localPosition - map.Source(frame).localPosition) + map.Shift(frame);
                case "empty": return "";
            }
            throw new ArgumentException(words[1]);
        }

        static Transform Last(Transform chain)
        {
            return chain.childCount == 0 ? chain : Last(chain.GetChild(0));
        }

        /// <summary>Puts a component on the arm, converts, and compares each property with what it must become.</summary>
        void Row(Type type, Action<Component> set, Func<Component, Transform> frame, params string[] properties)
        {
            Begin();
            Component component = figure.Bones[Arm].gameObject.AddComponent(type);
            if (set != null) set(component);
            string before = Fingerprint.Of(figure.Root);
            var wanted = new List<object>();
            Probe.Ask = map =>
            {
                Transform from = frame == null ? component.transform : frame(component);
                foreach (string property in properties) wanted.Add(Wanted(map, component, from, property.Split(' ')));
            };
            GameObject prefab = Converter.Convert(figure.Root, Settings(), null).Prefab;
            Component made = Array.Find(prefab.GetComponentsInChildren<Component>(true), one => one.GetType() == type);
            for (int i = 0; i < properties.Length; i++)
            {
                string[] words = properties[i].Split(' ');
                object now = Get(made, words[0]), old = Get(component, words[0]);
                string name = type.Name + " " + properties[i];
                if (now is float) Assert.AreEqual((float)wanted[i], (float)now, 1e-3f * Math.Abs((float)old), name);
                else if (now is Vector3)
                {
                    Assert.That(Vector3.Distance((Vector3)wanted[i], (Vector3)now), Is.LessThan(1e-3f * ((Vector3)old).magnitude + 1e-6f), name);
                }
                else Assert.AreEqual(wanted[i], now, name);
                if (words[1] == "stays") Assert.AreEqual(old, now, name);
                else Assert.AreNotEqual(old, now, name);
            }
            Assert.AreEqual(before, Fingerprint.Of(figure.Root), type.Name + " of the source");
            tried.Add(type.FullName);
        }

        [Test]
        public void every_row_changes_what_it_says()
        {
            try
            {
                VrChat();
                Portable();
                DynamicBones();
                MagicaCloth();
                Engine();
            }
            finally
            {
                Probe.Ask = null;
            }
            tried.UnionWith(ColliderRowTests.Types);
            foreach (string type in ComponentTable.Types) Assert.That(tried.Contains(type), "no made-up component stands for " + type);
        }

        void VrChat()
        {
            Func<Component, Transform> leg = component => figure.Bones[Leg];
            Row(typeof(VRC.Core.PipelineManager), null, null, "blueprintId empty");
            Row(typeof(VRC.SDK3.Avatars.Components.VRCStation), null, null, "exitHeight stays");
            Row(typeof(VRC.SDK3.Avatars.Components.VRCHeadChop), null, null, "size stays");
            Row(typeof(VRC.SDK3.Dynamics.PhysBone.Components.VRCPhysBone), c => ((VRC.SDK3.Dynamics.PhysBone.Components.VRCPhysBone)c).rootTransform = figure.Bones[Leg],
                leg, "radius chain", "endpointPosition end", "pull stays", "gravity stays", "maxStretch stays");
            Row(typeof(VRC.SDK3.Dynamics.Constraint.Components.VRCPositionConstraint), c => ((VRC.SDK3.Dynamics.Constraint.Components.VRCPositionConstraint)c).PositionAtRest = c.transform.localPosition,
                null, "PositionAtRest rest", "PositionOffset length");
            Row(typeof(VRC.SDK3.Dynamics.Constraint.Components.VRCParentConstraint), c =>
            {
                var constraint = (VRC.SDK3.Dynamics.Constraint.Components.VRCParentConstraint)c;
                constraint.Sources.source1 = new VRC.SDK3.Dynamics.Constraint.Components.VRCConstraintSource { SourceTransform = figure.Bones[Leg], ParentPositionOffset = new Vector3(0.1f, 0.2f, 0) };
            }, leg, "Sources.source1.ParentPositionOffset point", "Sources.source0.ParentPositionOffset stays");
            foreach (string kind in new[] { "Rotation", "Scale", "Aim", "LookAt" })
            {
                Row(typeof(VRC.SDK3.Dynamics.Constraint.Components.Turning).Assembly.GetType("VRC.SDK3.Dynamics.Constraint.Components.VRC" + kind + "Constraint"), null, null,
                    "RotationOffset stays", "ScaleOffset stays", "size stays");
            }
        }

        void Portable()
        {
            Row(typeof(nadena.dev.ndmf.multiplatform.components.PortableDynamicBone), null, null, "m_baseRadius.m_value chain");
            Row(typeof(Anatawa12.AvatarOptimizer.RemoveMeshInBox), null, null,
                "boxes.Array.data[0].size sides boxes.Array.data[0].center", "boxes.Array.data[1].size sides boxes.Array.data[1].center",
                "boxes.Array.data[0].center point", "boxes.Array.data[1].center point");
            Row(typeof(Anatawa12.AvatarOptimizer.MergePhysBone), null, null, "radiusConfig.value length", "endpointPositionConfig.value length");
            Row(typeof(Anatawa12.AvatarOptimizer.ReplaceEndBoneWithEndpointPosition), null, null, "overridePosition end");
        }

        void DynamicBones()
        {
            Row(typeof(DynamicBone), c => ((DynamicBone)c).m_Root = figure.Bones[Leg], component => figure.Bones[Leg],
                "m_Radius chain", "m_Gravity chain", "m_Force chain", "m_EndOffset endlength", "m_EndLength stays");
            Row(typeof(DynamicBone), c => ((DynamicBone)c).m_Roots.Add(figure.Bones[Leg]), component => figure.Bones[Leg], "m_Radius chain", "m_EndOffset endlength");
            Row(typeof(DynamicBonePlaneCollider), null, null, "m_Center point");
        }

        void MagicaCloth()
        {
            Row(typeof(MagicaCloth.MagicaPlaneCollider), null, null, "center point");
            foreach (Type cloth in new[] { typeof(MagicaCloth.MagicaBoneCloth), typeof(MagicaCloth.MagicaBoneSpring), typeof(MagicaCloth.MagicaMeshCloth), typeof(MagicaCloth.MagicaMeshSpring) })
            {
                var properties = new List<string> { "clothParams.mass stays", "clothParams.radius.curveValue stays" };
                foreach (string bezier in new[] { "radius", "clampPositionLength", "penetrationConnectDistance", "penetrationDistance", "penetrationRadius" })
                {
                    properties.AddRange(new[] { "clothParams." + bezier + ".startValue length", "clothParams." + bezier + ".endValue length" });
                }
                foreach (string number in new[] { "nearDistanceLength", "springRadius", "maxVolumeLength", "teleportDistance" })
                {
                    properties.Add("clothParams." + number + " length");
                }
                Row(cloth, null, null, properties.ToArray());
            }
            Row(typeof(MagicaCloth2.MagicaPlaneCollider), null, null, "center point");
            Row(typeof(MagicaCloth2.MagicaCloth), null, null, "serializeData.radius.value length", "serializeData.motionConstraint.maxDistance.value length",
                "serializeData.motionConstraint.backstopRadius length", "serializeData.motionConstraint.backstopDistance.value length",
                "serializeData.colliderCollisionConstraint.limitDistance.value length", "serializeData.selfCollisionConstraint.surfaceThickness.value length",
                "serializeData2.selectionData.maxConnectionDistance length", "serializeData2.selectionData.positions.Array.data[0] point",
                "serializeData2.selectionData.positions.Array.data[1] point", "serializeData.gravity stays");
        }

        void Engine()
        {
            Row(typeof(UnityEngine.Animations.PositionConstraint), c => ((UnityEngine.Animations.PositionConstraint)c).m_TranslationAtRest = c.transform.localPosition,
                null, "m_TranslationAtRest rest", "m_TranslationOffset length");
            Row(typeof(UnityEngine.Animations.ParentConstraint), c =>
            {
                var constraint = (UnityEngine.Animations.ParentConstraint)c;
                constraint.m_TranslationOffsets.Add(new Vector3(0.1f, 0.2f, 0));
                constraint.m_Sources.Add(new UnityEngine.Animations.ConstraintSource { sourceTransform = figure.Bones[Leg], weight = 1 });
            }, component => figure.Bones[Leg], "m_TranslationOffsets.Array.data[0] point");
            foreach (Type turned in new[] { typeof(UnityEngine.Animations.RotationConstraint), typeof(UnityEngine.Animations.ScaleConstraint),
                typeof(UnityEngine.Animations.AimConstraint), typeof(UnityEngine.Animations.LookAtConstraint) })
            {
                Row(turned, null, null, "m_RotationOffset stays", "m_ScaleOffset stays", "m_Position stays");
            }
            foreach (Type joint in new[] { typeof(CharacterJoint), typeof(FixedJoint), typeof(HingeJoint), typeof(SpringJoint), typeof(ConfigurableJoint) })
            {
                var properties = new List<string> { "m_Anchor point" };
                if (joint == typeof(SpringJoint)) properties.AddRange(new[] { "m_MinDistance length", "m_MaxDistance length", "m_Spring stays" });
                if (joint == typeof(ConfigurableJoint)) properties.AddRange(new[] { "m_LinearLimit.limit length", "m_TargetPosition length", "m_ProjectionDistance length" });
                Row(joint, null, null, properties.ToArray());
                Row(joint, c => ((Joint)c).m_ConnectedBody = figure.Bones[Leg].gameObject.AddComponent<Rigidbody>(), component => figure.Bones[Leg], "m_ConnectedAnchor point");
                Row(joint, c =>
                {
                    ((Joint)c).m_ConnectedBody = figure.Bones[Leg].gameObject.AddComponent<Rigidbody>();
                    ((Joint)c).m_AutoConfigureConnectedAnchor = true;
                }, component => figure.Bones[Leg], "m_ConnectedAnchor stays");
            }
            Row(typeof(LODGroup), null, null, "m_Size length", "m_LocalReferencePoint point");
            Row(typeof(Light), null, null, "m_Range length", "m_AreaSize length", "m_CookieSize length", "m_CookieSize2D length");
            Row(typeof(LineRenderer), null, null, "m_Parameters.widthMultiplier length", "m_Positions.Array.data[0] point", "m_Positions.Array.data[1] point");
            Row(typeof(LineRenderer), c => ((LineRenderer)c).m_UseWorldSpace = true, null, "m_Parameters.widthMultiplier length", "m_Positions.Array.data[0] stays");
            Row(typeof(TrailRenderer), null, null, "m_Parameters.widthMultiplier length", "m_MinVertexDistance length", "m_Time stays");
            Row(typeof(WheelCollider), null, null, "m_Radius length m_Center", "m_SuspensionDistance length", "m_ForceAppPointDistance length", "m_Center point");
            Row(typeof(AudioSource), null, null, "MinDistance stays", "MaxDistance stays");
            var particles = new List<string> { "InitialModule.startLifetime.scalar stays", "ShapeModule.angle stays", "ShapeModule.m_Rotation stays", "ShapeModule.m_Scale length" };
            foreach (string curve in new[] { "InitialModule.startSize", "InitialModule.startSizeY", "InitialModule.startSizeZ", "InitialModule.startSpeed", "InitialModule.gravityModifier",
                "VelocityModule.x", "VelocityModule.y", "VelocityModule.z", "ForceModule.x", "ForceModule.y", "ForceModule.z", "NoiseModule.strength", "NoiseModule.strengthY", "NoiseModule.strengthZ" })
            {
                particles.AddRange(new[] { curve + ".scalar length", curve + ".minScalar length" });
            }
            foreach (string length in new[] { "radius.value", "length", "donutRadius", "m_MeshNormalOffset", "m_Position" })
            {
                particles.Add("ShapeModule." + length + " length");
            }
            Row(typeof(ParticleSystem), null, null, particles.ToArray());
            // A cone's size is its radius; its scale multiplies that.
            Row(typeof(ParticleSystem), c => ((ParticleSystem)c).ShapeModule.type = 4, null, "ShapeModule.m_Scale stays");
        }

        [Test]
        public void capsules_boxes_and_cloth_change_in_each_of_their_lengths()
        {
            Row(typeof(CapsuleCollider), component =>
            {
                var capsule = (CapsuleCollider)component;
                capsule.center = new Vector3(0.02f, -0.1f, 0);
                capsule.radius = 0.05f;
                capsule.height = 0.3f;
            }, null, "m_Radius across m_Center y");
            Begin();
            Transform arm = figure.Bones[Arm];
            var box = arm.gameObject.AddComponent<BoxCollider>();
            box.center = new Vector3(-0.1f, 0, 0.01f);
            box.size = new Vector3(0.2f, 0.1f, 0.15f);
            var cloth = figure.Body.gameObject.AddComponent<Cloth>();
            cloth.coefficients = new[]
            {
                new ClothSkinningCoefficient { maxDistance = 0.1f, collisionSphereDistance = 0.2f },
                new ClothSkinningCoefficient { maxDistance = float.MaxValue, collisionSphereDistance = float.MaxValue }
            };
            Vector3 wanted = Vector3.zero;
            float scale = 0;
            Probe.Ask = map =>
            {
                for (int axis = 0; axis < 3; axis++)
                {
                    Vector3 half = Vector3.zero;
                    half[axis] = box.size[axis] / 2;
                    wanted[axis] = Vector3.Distance(map.Point(arm, box.center + half), map.Point(arm, box.center - half));
                }
                scale = map.Scale(figure.Body.rootBone, Vector3.zero);
            };
            GameObject prefab = Converter.Convert(figure.Root, Settings(), null).Prefab;
            Probe.Ask = null;
            Vector3 size = prefab.GetComponentInChildren<BoxCollider>().size;
            for (int axis = 0; axis < 3; axis++)
            {
                Assert.AreEqual(wanted[axis], size[axis], 1e-5, "axis " + axis);
                Assert.That(Mathf.Abs(size[axis] - box.size[axis]), Is.GreaterThan(0.005f), "axis " + axis);
            }
            ClothSkinningCoefficient[] coefficients = prefab.GetComponentInChildren<Cloth>().coefficients;
            Assert.AreEqual(0.1f * scale, coefficients[0].maxDistance, 1e-6);
            Assert.AreEqual(0.2f * scale, coefficients[0].collisionSphereDistance, 1e-6);
            Assert.That(scale, Is.LessThan(0.95f));
            Assert.AreEqual(float.MaxValue, coefficients[1].maxDistance);
            Assert.AreEqual(float.MaxValue, coefficients[1].collisionSphereDistance);
        }

        [Test]
        public void a_collider_in_the_shape_of_a_renderers_mesh_gets_the_new_mesh()
        {
            Begin();
            Mesh hat = figure.Hat.GetComponent<MeshFilter>().sharedMesh, other = UnityEngine.Object.Instantiate(hat);
            AssetDatabase.CreateAsset(other, "Assets/Other.asset");
            figure.Hat.gameObject.AddComponent<MeshCollider>().sharedMesh = hat;
            figure.Bones[Arm].gameObject.AddComponent<MeshCollider>().sharedMesh = other;
            figure.Bones[Leg].gameObject.AddComponent<MeshCollider>();
            Probe.Ask = null;
            GameObject prefab = Converter.Convert(figure.Root, Settings(), null).Prefab;
            Transform shown = ConversionTests.Find(prefab, "Hat");
            Assert.AreNotSame(hat, shown.GetComponent<MeshFilter>().sharedMesh);
            Assert.AreSame(shown.GetComponent<MeshFilter>().sharedMesh, shown.GetComponent<MeshCollider>().sharedMesh);
            Assert.AreSame(other, ConversionTests.Find(prefab, figure.Bones[Arm].name).GetComponent<MeshCollider>().sharedMesh, "of no renderer");
            Assert.That(ConversionTests.Find(prefab, figure.Bones[Leg].name).GetComponent<MeshCollider>().sharedMesh, Is.Null);
        }

        [TestCase(1f, 1f)]
        [TestCase(2f, 1f)]
        [TestCase(1f, 0.5f)]
        [TestCase(1.5f, 2f)]
        public void the_viewpoint_stays_between_the_eyes(float size, float above)
        {
            Begin();
            Transform left = new GameObject("LeftEye").transform, right = new GameObject("RightEye").transform, parent = new GameObject("Above").transform;
            left.SetParent(figure.Bones[HumanBodyBones.Head], false);
            right.SetParent(figure.Bones[HumanBodyBones.Head], false);
            left.position = new Vector3(-0.03f, 1.7f, 0.08f);
            right.position = new Vector3(0.03f, 1.7f, 0.08f);
            var descriptor = figure.Root.AddComponent<VRC.SDK3.Avatars.Components.VRCAvatarDescriptor>();
            parent.localScale = Vector3.one * above;
            figure.Root.transform.SetParent(parent, false);
            figure.Root.transform.localScale = Vector3.one * size;
            figure.Root.transform.position = new Vector3(3, 0, 1);
            descriptor.ViewPosition = (left.position + right.position) * 0.5f - figure.Root.transform.position;
            ConversionSettings settings = Settings();
            settings.PlaceInScene = true;
            ConversionResult done = Converter.Convert(figure.Root, settings, null);
            foreach (GameObject made in new[] { done.Prefab, done.Instance })
            {
                Vector3 between = (ConversionTests.Find(made, "LeftEye").position + ConversionTests.Find(made, "RightEye").position) * 0.5f - made.transform.position;
                Vector3 view = made.GetComponent<VRC.SDK3.Avatars.Components.VRCAvatarDescriptor>().ViewPosition;
                Assert.That(Vector3.Distance(between, view), Is.LessThan(2e-3f * 1.9f * size), made.name);
            }
            Assert.AreSame(parent, done.Instance.transform.parent);
            Converter.ConvertInPlace(figure.Root, Settings(), null);
            Assert.That(Vector3.Distance((left.position + right.position) * 0.5f - figure.Root.transform.position, descriptor.ViewPosition), Is.LessThan(2e-3f * 1.9f * size * above));
        }

        [Test]
        public void what_is_not_in_the_table_is_listed_object_by_object()
        {
            Begin();
            figure.Bones[Arm].gameObject.AddComponent<SomebodyElse.Tail>();
            figure.Bones[Leg].gameObject.AddComponent<SomebodyElse.Tail>();
            figure.Bones[Leg].gameObject.AddComponent<SomebodyElse.Blinker>();
            figure.Bones[Leg].gameObject.AddComponent<MagicaCloth.MagicaBoneCloth>();
            Probe.Ask = null;
            ConversionResult result = Converter.Convert(figure.Root, Settings(), null);
            List<Finding> left = result.Findings.FindAll(finding => finding.Key == "not_adapted");
            Assert.AreEqual(2, left.Count);
            foreach (HumanBodyBones bone in new[] { Arm, Leg })
            {
                Finding said = left.Find(finding => finding.Where == figure.Bones[bone]);
                Assert.That(said, Is.Not.Null, bone.ToString());
                foreach (string word in new[] { figure.Bones[bone].name, "Tail", "tailRadius", "restOffset" }) StringAssert.Contains(word, said.Text);
                StringAssert.DoesNotContain("speed", said.Text);
            }
            Finding baked = result.Findings.Find(finding => finding.Key == "needs_create");
            Assert.AreSame(figure.Bones[Leg], baked.Where);
        }

        [Test]
        public void many_of_them_are_counted()
        {
            Begin();
            for (int i = 0; i < 40; i++) figure.Bones[Arm].gameObject.AddComponent<SomebodyElse.Tail>();
            Probe.Ask = null;
            ConversionResult result = Converter.Convert(figure.Root, Settings(), null);
            Assert.AreEqual(30, result.Findings.FindAll(finding => finding.Key == "not_adapted").Count);
            StringAssert.Contains("10", result.Findings.Find(finding => finding.Key == "not_adapted_more").Text);
        }

        static Material Painted(string shader, string property, float value)
        {
            var material = new Material(Shader.Find("Standard")) { name = shader.Replace('/', ' ') };
            material.shader.name = "Standard";
            material.shader = UnityEngine.Object.Instantiate(material.shader);
            material.shader.name = shader;
            material.SetFloat(property, value);
            StubProject.Import("Assets/" + material.name + ".mat", material);
            return material;
        }

        [Test]
        public void outlines_and_fur_that_are_lengths_shrink_with_the_figure()
        {
            Begin();
            Probe.Ask = null;
            Material lil = Painted("Hidden/lilToonOutline", "_OutlineWidth", 0.08f), poiyomi = Painted(".poiyomi/Toon", "_LineWidth", 1);
            Material off = Painted(".poiyomi/Off", "_LineWidth", 1), locked = Painted("Hidden/Locked/.poiyomi/Toon", "_LineWidth", 1), screen = Painted("MToon", "_OutlineWidth", 0.5f);
            Material fur = Painted("Hidden/lilToonFur", "_Other", 1);
            poiyomi.SetFloat("_EnableOutlines", 1);
            off.SetFloat("_EnableOutlines", 0);
            screen.SetFloat("_OutlineWidthMode", 2);
            fur.SetVector("_FurVector", new Vector4(0, 0, 1, 0.02f));
            figure.Body.sharedMaterials = new[] { lil, poiyomi, off, locked, screen, fur };
            ConversionResult result = Converter.Convert(figure.Root, Settings(), null);
            Material[] made = ConversionTests.Find(result.Prefab, "Body").GetComponent<SkinnedMeshRenderer>().sharedMaterials;
            float ratio = (float)(result.Report.Result.Height / result.Report.Target.Height);
            Assert.AreEqual(0.08f * ratio, made[0].GetFloat("_OutlineWidth"), 1e-3);
            Assert.AreEqual(ratio, made[1].GetFloat("_LineWidth"), 1e-2);
            Assert.AreSame(off, made[2]);
            Assert.AreSame(locked, made[3]);
            Assert.AreSame(screen, made[4]);
            Assert.AreEqual(0.02f * ratio, made[5].GetVector("_FurVector").w, 1e-4);
            Assert.AreEqual(1, made[5].GetVector("_FurVector").z);
            Assert.AreSame(locked, result.Findings.Find(finding => finding.Key == "locked_material").Where);
            Assert.AreEqual(0.08f, lil.GetFloat("_OutlineWidth"));
        }
    }
}
