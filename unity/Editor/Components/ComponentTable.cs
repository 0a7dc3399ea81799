using System;
using System.Collections.Generic;
using UnityEditor;
using UnityEngine;
using static SuperDeform.Editor.ColliderRules;
using static SuperDeform.Editor.Rules;

namespace SuperDeform.Editor
{
    /// <summary>
    /// What components of other packages hold in lengths and points, by the full name of their class: through their serialized
    /// properties, so that none of those packages is needed to compile this one.
    /// </summary>
    /// <remarks>
    /// Joints move and are not scaled, so all that a component multiplies by its transform's scale changes here. Angles, ratios,
    /// times and curves along a chain stay.
    /// </remarks>
    internal sealed class ComponentTable : ISpringAdapter
    {
        static readonly Dictionary<string, Rule[]> Rows = new Dictionary<string, Rule[]>();

        static ComponentTable()
        {
            VrChatRows.Add(Rows);
            ClothRows.Add(Rows);
            UnityRows.Add(Rows);
            ModularRows.Add(Rows);
        }

        /// <summary>The classes in the table.</summary>
        internal static IEnumerable<string> Types => Rows.Keys;

        /// <summary>What a table holds for a class, or for one that it derives from; null where it is not in the table.</summary>
        static T Find<T>(Dictionary<string, T> table, Component component) where T : class
        {
            for (Type type = component.GetType(); type != null; type = type.BaseType)
            {
                if (table.TryGetValue(type.FullName, out T found)) return found;
            }
            return null;
        }

        public bool Handles(Component copy) => Find(Rows, copy) != null;

        public void AddSprings(Component copy, Springs springs)
        {
            SpringRow row = Find(SpringRow.All, copy);
            if (row != null) row.Add(copy, springs);
        }

        public void Adapt(Component copy, PointMap map)
        {
            using (var properties = new SerializedObject(copy))
            {
                var scope = new PropertyScope(copy, properties, map);
                foreach (Rule rule in Find(Rows, copy))
                {
                    rule(scope);
                }
                properties.ApplyModifiedPropertiesWithoutUndo();
            }
        }
    }

    /// <summary>VRChat's SDK 3 (com.vrchat.avatars 3.7 to 3.10) and the same things of NDMF.</summary>
    internal static class VrChatRows
    {
        const string Dynamics = "VRC.SDK3.Dynamics.", AvatarDescriptor = "VRC.SDK3.Avatars.Components.VRCAvatarDescriptor", View = "ViewPosition";

        // VRCPhysBoneColliderBase.ShapeType, PortableDynamicColliderType; a contact's third shape is a box.
        static readonly int[] IsBall = { 0 }, IsCapsule = { 1 }, IsPlane = { 2 }, IsBox = { 2 };

        internal static void Add(Dictionary<string, Rule[]> rows)
        {
            rows[AvatarDescriptor] = Descriptor();
            rows["VRC.SDK3.Avatars.Components.VRCStation"] = new Rule[0];
            rows["VRC.SDK3.Avatars.Components.VRCHeadChop"] = new Rule[0];
            rows["VRC.Core.PipelineManager"] = new[] { Identity("blueprintId") };
            rows[Dynamics + "PhysBone.Components.VRCPhysBone"] = new[] { InSpaceOf("rootTransform"), ChainLength("radius"), EndPoint("endpointPosition") };
            rows[Dynamics + "PhysBone.Components.VRCPhysBoneCollider"] = new[]
            {
                InSpaceOf("rootTransform"), When("shapeType", IsBall, Ball("position", "radius", "insideBounds")),
                When("shapeType", IsCapsule, Upright("position", "radius", "height", "rotation", "insideBounds")), When("shapeType", IsPlane, Plane("position", "rotation"))
            };
            Rule[] contact =
            {
                InSpaceOf("rootTransform"), When("shapeType", IsBall, Ball("position", "radius")), When("shapeType", IsCapsule, Upright("position", "radius", "height", "rotation")),
                When("shapeType", IsBox, Sides("size", "position")), When("shapeType", IsBox, Point("position"))
            };
            rows[Dynamics + "Contact.Components.VRCContactSender"] = contact;
            rows[Dynamics + "Contact.Components.VRCContactReceiver"] = contact;
            rows[Dynamics + "Constraint.Components.VRCPositionConstraint"] = new[] { RestPosition("PositionAtRest", "TargetTransform"), Length("PositionOffset") };
            var parent = new List<Rule> { RestPosition("PositionAtRest", "TargetTransform") };
            for (int source = 0; source < 16; source++)
            {
                string at = "Sources.source" + source;
                parent.Add(OffsetFrom(at + ".ParentPositionOffset", at + ".SourceTransform"));
            }
            rows[Dynamics + "Constraint.Components.VRCParentConstraint"] = parent.ToArray();
            foreach (string kind in new[] { "Rotation", "Scale", "Aim", "LookAt" })
            {
                rows[Dynamics + "Constraint.Components.VRC" + kind + "Constraint"] = new Rule[0];
            }
            string portable = "nadena.dev.ndmf.multiplatform.components.";
            rows[portable + "PortableDynamicBone"] = new[] { InSpaceOf("m_root"), ChainLength("m_baseRadius.m_value") };
            rows[portable + "PortableDynamicBoneCollider"] = new[]
            {
                InSpaceOf("m_root"), When("m_colliderType", IsBall, Ball("m_positionOffset", "m_radius")),
                When("m_colliderType", IsCapsule, Upright("m_positionOffset", "m_radius", "m_height", "m_rotationOffset")),
                When("m_colliderType", IsPlane, Plane("m_positionOffset", "m_rotationOffset"))
            };
        }

        /// <summary>Brings an instance that hangs below a scaled object to the world's measure, in which an avatar's viewpoint is given.</summary>
        internal static void Hang(GameObject instance)
        {
            Vector3 above = instance.transform.parent.lossyScale;
            foreach (Component component in instance.GetComponents<Component>())
            {
                if (component == null || component.GetType().FullName != AvatarDescriptor) continue;
                using (var properties = new SerializedObject(component))
                {
                    SerializedProperty view = properties.FindProperty(View);
                    if (view == null) continue;
                    view.vector3Value = Vector3.Scale(view.vector3Value, above);
                    properties.ApplyModifiedPropertiesWithoutUndo();
                }
            }
        }

        static Rule[] Descriptor()
        {
            var rules = new List<Rule> { Viewpoint(View), Length("portraitCameraPositionOffset") };
            var parts = new List<string> { "head", "torso", "footL", "footR", "handL", "handR" };
            foreach (string finger in new[] { "Index", "Middle", "Ring", "Little" })
            {
                parts.Add("finger" + finger + "L");
                parts.Add("finger" + finger + "R");
            }
            foreach (string part in parts)
            {
                string at = "collider_" + part + ".";
                rules.Add(InSpaceOf(at + "transform"));
                rules.Add(Upright(at + "position", at + "radius", at + "height", at + "rotation"));
            }
            return rules.ToArray();
        }
    }

    /// <summary>Dynamic Bone; Magica Cloth 1 and 2.</summary>
    internal static class ClothRows
    {
        internal static void Add(Dictionary<string, Rule[]> rows)
        {
            rows["DynamicBone"] = new[]
            {
                InSpaceOf("m_Root", "m_Roots.Array.data[0]"), ChainLength("m_Radius"), ChainLength("m_Gravity"), ChainLength("m_Force"), EndLength("m_EndOffset")
            };
            rows["DynamicBoneCollider"] = new[] { Along("m_Center", Axis("m_Direction"), "m_Height", "m_Radius", "m_Radius2", "m_Bound") };
            rows["DynamicBonePlaneCollider"] = new[] { Point("m_Center") };
            AddFirst(rows);
            AddSecond(rows);
        }

        static void AddFirst(Dictionary<string, Rule[]> rows)
        {
            const string space = "MagicaCloth.";
            rows[space + "MagicaSphereCollider"] = new[] { Ball("center", "radius") };
            rows[space + "MagicaCapsuleCollider"] = new[] { HalfAlong("center", Axis("axis"), "length", "startRadius", "endRadius") };
            rows[space + "MagicaPlaneCollider"] = new[] { Point("center") };
            // Their rest shape is an asset that only their own Create button makes: see NeedsCreate.
            var cloth = new List<Rule>();
            foreach (string bezier in new[]
            {
                "radius", "clampPositionLength", "penetrationConnectDistance", "penetrationDistance", "penetrationRadius"
            })
            {
                cloth.Add(Length("clothParams." + bezier + ".startValue"));
                cloth.Add(Length("clothParams." + bezier + ".endValue"));
            }
            foreach (string number in new[] { "nearDistanceLength", "springRadius", "maxVolumeLength", "teleportDistance" })
            {
                cloth.Add(Length("clothParams." + number));
            }
            foreach (string name in NeedsCreate)
            {
                rows[name] = cloth.ToArray();
            }
        }

        /// <summary>Components whose baked data must be made anew by hand.</summary>
        internal static readonly string[] NeedsCreate =
        {
            "MagicaCloth.MagicaBoneCloth", "MagicaCloth.MagicaBoneSpring", "MagicaCloth.MagicaMeshCloth", "MagicaCloth.MagicaMeshSpring"
        };

        static void AddSecond(Dictionary<string, Rule[]> rows)
        {
            const string space = "MagicaCloth2.";
            rows[space + "MagicaSphereCollider"] = new[] { Ball("center", "size.x") };
            // Two radii and a length.
            rows[space + "MagicaCapsuleCollider"] = new[]
            {
                Along("center", Axis("direction", "reverseDirection"), "size.z", "size.x", "size.y", null, "radiusSeparation", "alignedOnCenter")
            };
            rows[space + "MagicaPlaneCollider"] = new[] { Point("center") };
            const string at = "serializeData.";
            rows[space + "MagicaCloth"] = new[]
            {
                Length(at + "radius.value"), Length(at + "motionConstraint.maxDistance.value"), Length(at + "motionConstraint.backstopRadius"),
                Length(at + "motionConstraint.backstopDistance.value"), Length(at + "colliderCollisionConstraint.limitDistance.value"),
                Length(at + "selfCollisionConstraint.surfaceThickness.value"), Length("serializeData2.selectionData.maxConnectionDistance"),
                Point("serializeData2.selectionData.positions[*]")
            };
        }
    }

    /// <summary>Unity's own components that no adapter of this package knows.</summary>
    internal static class UnityRows
    {
        internal static void Add(Dictionary<string, Rule[]> rows)
        {
            const string constraint = "UnityEngine.Animations.";
            rows[constraint + "ParentConstraint"] = new[]
            {
                RestPosition("m_TranslationAtRest"), OffsetsFrom("m_TranslationOffsets", "m_Sources", "sourceTransform")
            };
            rows[constraint + "PositionConstraint"] = new[] { RestPosition("m_TranslationAtRest"), Length("m_TranslationOffset") };
            foreach (string kind in new[] { "RotationConstraint", "ScaleConstraint", "AimConstraint", "LookAtConstraint" })
            {
                rows[constraint + kind] = new Rule[0];
            }
            AddJoints(rows);
            rows["UnityEngine.LODGroup"] = new[] { Length("m_Size"), Point("m_LocalReferencePoint") };
            rows["UnityEngine.Light"] = new[] { Length("m_Range"), Length("m_AreaSize"), Length("m_CookieSize"), Length("m_CookieSize2D") };
            rows["UnityEngine.LineRenderer"] = new[]
            {
                Length("m_Parameters.widthMultiplier"), When("m_UseWorldSpace", new[] { 0 }, Point("m_Positions[*]"))
            };
            rows["UnityEngine.TrailRenderer"] = new[] { Length("m_Parameters.widthMultiplier"), Length("m_MinVertexDistance") };
            rows["UnityEngine.WheelCollider"] = new[] { Length("m_Radius", "m_Center"), Length("m_SuspensionDistance"), Length("m_ForceAppPointDistance"), Point("m_Center") };
            rows["UnityEngine.ParticleSystem"] = Particles();
            // How far a voice carries is a choice, and no length of the body.
            rows["UnityEngine.AudioSource"] = new Rule[0];
        }

        static void AddJoints(Dictionary<string, Rule[]> rows)
        {
            Rule[] anchors =
            {
                Point("m_Anchor"),
                When("m_AutoConfigureConnectedAnchor", new[] { 0 }, OffsetFrom("m_ConnectedAnchor", "m_ConnectedBody"))
            };
            foreach (string kind in new[] { "CharacterJoint", "FixedJoint", "HingeJoint", "SpringJoint", "ConfigurableJoint" })
            {
                var rules = new List<Rule>(anchors);
                foreach (string length in new[] { "m_MinDistance", "m_MaxDistance", "m_LinearLimit.limit", "m_TargetPosition", "m_ProjectionDistance" })
                {
                    rules.Add(Length(length));
                }
                rows["UnityEngine." + kind] = rules.ToArray();
            }
        }

        // ParticleSystemShapeType: Box, Mesh, BoxShell, BoxEdge, Rectangle have their size in the scale; others in radius and length.
        static readonly int[] sizedByScale = { 5, 6, 15, 16, 18 };

        static Rule[] Particles()
        {
            var rules = new List<Rule>();
            foreach (string curve in new[]
            {
                "InitialModule.startSize", "InitialModule.startSizeY", "InitialModule.startSizeZ", "InitialModule.startSpeed",
                "InitialModule.gravityModifier", "VelocityModule.x", "VelocityModule.y", "VelocityModule.z",
                "ForceModule.x", "ForceModule.y", "ForceModule.z", "NoiseModule.strength", "NoiseModule.strengthY", "NoiseModule.strengthZ"
            })
            {
                rules.Add(Curve(curve));
            }
            foreach (string length in new[]
            {
                "ShapeModule.radius.value", "ShapeModule.length", "ShapeModule.donutRadius", "ShapeModule.m_MeshNormalOffset", "ShapeModule.m_Position"
            })
            {
                rules.Add(Length(length));
            }
            rules.Add(When("ShapeModule.type", sizedByScale, Length("ShapeModule.m_Scale")));
            return rules.ToArray();
        }
    }

    /// <summary>Modular Avatar and Avatar Optimizer: what they do at build time, they do to the new avatar.</summary>
    internal static class ModularRows
    {
        internal static void Add(Dictionary<string, Rule[]> rows)
        {
            const string modular = "nadena.dev.modular_avatar.core.", optimizer = "Anatawa12.AvatarOptimizer.";
            rows[modular + "ModularAvatarGlobalCollider"] = new[]
            {
                InSpaceOf("m_rootTransform.targetObject"), Upright("m_position", "m_radius", "m_height", "m_rotation")
            };
            rows[optimizer + "RemoveMeshInBox"] = new[] { Sides("boxes[*].size", "boxes[*].center"), Point("boxes[*].center") };
            rows[optimizer + "MergePhysBone"] = new[] { Length("radiusConfig.value"), Length("endpointPositionConfig.value") };
            rows[optimizer + "ReplaceEndBoneWithEndpointPosition"] = new[] { EndPoint("overridePosition") };
        }
    }
}
