// Components of the full names and with the serialized fields of other packages', as far as the table of components names them.
// Where the names were read: UnityCsReference 2022.3 (Unity), lists of serialized fields in public prefabs (VRChat, Modular
// Avatar 1.18, Avatar Optimizer 1.9, NDMF 1.14), public users of their interfaces (Dynamic Bone, Magica Cloth 1 and 2).
using System;
using System.Collections.Generic;
using UnityEngine;

namespace VRC.SDK3.Avatars.Components
{
    [Serializable]
    public class ColliderConfig
    {
        public Transform transform;
        public float radius = 0.11f, height = 0.3f;
        public Vector3 position = new Vector3(0.01f, 0.05f, 0.02f);
        public Quaternion rotation = Quaternion.Euler(0, 0, 90);
    }

    [Serializable]
    public class EyeLookSettings
    {
        public Transform leftEye, rightEye;
    }

    public class VRCAvatarDescriptor : MonoBehaviour
    {
        public EyeLookSettings customEyeLookSettings = new EyeLookSettings();
        public Vector3 ViewPosition, portraitCameraPositionOffset = new Vector3(0, 1.5f, 1);
        public ColliderConfig collider_head = new ColliderConfig(), collider_torso = new ColliderConfig(), collider_footL = new ColliderConfig(),
            collider_footR = new ColliderConfig(), collider_handL = new ColliderConfig(), collider_handR = new ColliderConfig(),
            collider_fingerIndexL = new ColliderConfig(), collider_fingerMiddleL = new ColliderConfig(), collider_fingerRingL = new ColliderConfig(),
            collider_fingerLittleL = new ColliderConfig(), collider_fingerIndexR = new ColliderConfig(), collider_fingerMiddleR = new ColliderConfig(),
            collider_fingerRingR = new ColliderConfig(), collider_fingerLittleR = new ColliderConfig();
    }

    public class VRCStation : MonoBehaviour { public Transform stationEnterPlayerLocation; public float exitHeight = 1; }
    public class VRCHeadChop : MonoBehaviour { public float globalScaleFactor = 1; public Vector3 size = Vector3.one; }
}

namespace VRC.Core
{
    public class PipelineManager : MonoBehaviour { public string blueprintId = "avtr_1"; }
}

namespace VRC.SDK3.Dynamics.PhysBone.Components
{
    public class VRCPhysBone : MonoBehaviour
    {
        public Transform rootTransform;
        public List<Transform> ignoreTransforms = new List<Transform>();
        public List<VRCPhysBoneCollider> colliders = new List<VRCPhysBoneCollider>();
        public float radius = 0.05f, pull = 0.2f, gravity = 0.1f, maxStretch = 0.3f;
        public Vector3 endpointPosition = new Vector3(0, 0.06f, 0.01f);
    }

    public class VRCPhysBoneCollider : MonoBehaviour
    {
        public Transform rootTransform;
        public int shapeType = 1;
        public bool insideBounds;
        public float radius = 0.05f, height = 0.4f;
        public Vector3 position = new Vector3(0.01f, 0.1f, 0);
        public Quaternion rotation = Quaternion.Euler(0, 0, 90);
    }
}

namespace VRC.SDK3.Dynamics.Contact.Components
{
    public class Contact : MonoBehaviour
    {
        public Transform rootTransform;
        public int shapeType = 1;
        public float radius = 0.05f, height = 0.4f;
        public Vector3 position = new Vector3(0.01f, 0.1f, 0), size = new Vector3(0.1f, 0.2f, 0.3f);
        public Quaternion rotation = Quaternion.identity;
    }
    public class VRCContactSender : Contact { }
    public class VRCContactReceiver : Contact { public float minVelocity = 0.05f; }
}

namespace VRC.SDK3.Dynamics.Constraint.Components
{
    [Serializable]
    public struct VRCConstraintSource { public Transform SourceTransform; public float Weight; public Vector3 ParentPositionOffset, ParentRotationOffset; }

    [Serializable]
    public class VRCConstraintSourceKeyableList { public VRCConstraintSource source0, source1; }

    public class VRCPositionConstraint : MonoBehaviour
    {
        public Transform TargetTransform;
        public Vector3 PositionAtRest, PositionOffset = new Vector3(0.1f, 0, 0);
    }
    public class VRCParentConstraint : MonoBehaviour
    {
        public Transform TargetTransform;
        public Vector3 PositionAtRest;
        public VRCConstraintSourceKeyableList Sources = new VRCConstraintSourceKeyableList();
    }
    public class Turning : MonoBehaviour { public Vector3 RotationOffset = new Vector3(1, 2, 3), ScaleOffset = Vector3.one; public float size = 1; }
    public class VRCRotationConstraint : Turning { }
    public class VRCScaleConstraint : Turning { }
    public class VRCAimConstraint : Turning { }
    public class VRCLookAtConstraint : Turning { }
}

namespace nadena.dev.ndmf.multiplatform.components
{
    [Serializable] public class Overridable { public float m_value = 0.05f; }
    public class PortableDynamicBone : MonoBehaviour { public Transform m_root; public Overridable m_baseRadius = new Overridable(); }
    public class PortableDynamicBoneCollider : MonoBehaviour
    {
        public Transform m_root;
        public int m_colliderType = 1;
        public float m_radius = 0.05f, m_height = 0.3f;
        public Vector3 m_positionOffset = new Vector3(0, 0.1f, 0);
        public Quaternion m_rotationOffset = Quaternion.identity;
    }
}

namespace nadena.dev.modular_avatar.core
{
    public class ModularAvatarGlobalCollider : MonoBehaviour
    {
        public AvatarObjectReference m_rootTransform = new AvatarObjectReference();
        public float m_radius = 0.05f, m_height = 0.3f;
        public Vector3 m_position = new Vector3(0, 0.1f, 0);
        public Quaternion m_rotation = Quaternion.identity;
    }
}

namespace Anatawa12.AvatarOptimizer
{
    [Serializable] public struct BoundingBox { public Vector3 center, size; public Quaternion rotation; }
    public class RemoveMeshInBox : MonoBehaviour
    {
        public BoundingBox[] boxes =
        {
            new BoundingBox { center = new Vector3(0, 0.1f, 0), size = new Vector3(0.1f, 0.2f, 0.3f) },
            new BoundingBox { center = new Vector3(0.1f, 0, 0), size = new Vector3(0.3f, 0.2f, 0.1f) }
        };
    }
    [Serializable] public class FloatConfig { public float value = 0.05f; }
    [Serializable] public class VectorConfig { public Vector3 value = new Vector3(0, 0.05f, 0); }
    public class MergePhysBone : MonoBehaviour { public FloatConfig radiusConfig = new FloatConfig(); public VectorConfig endpointPositionConfig = new VectorConfig(); }
    public class ReplaceEndBoneWithEndpointPosition : MonoBehaviour { public Vector3 overridePosition = new Vector3(0, 0.05f, 0); }
}

public class DynamicBone : MonoBehaviour
{
    public Transform m_Root;
    public List<Transform> m_Roots = new List<Transform>(), m_Exclusions = new List<Transform>();
    public List<DynamicBoneCollider> m_Colliders = new List<DynamicBoneCollider>();
    public float m_Radius = 0.05f, m_EndLength = 0.5f;
    public Vector3 m_EndOffset = new Vector3(0, 0.05f, 0), m_Gravity = new Vector3(0, -0.01f, 0), m_Force = new Vector3(0, 0, 0.01f);
}
public class DynamicBoneCollider : MonoBehaviour
{
    public int m_Direction = 2, m_Bound;
    public float m_Radius = 0.05f, m_Radius2 = 0.06f, m_Height = 0.3f;
    public Vector3 m_Center = new Vector3(0.01f, 0.1f, 0);
}
public class DynamicBonePlaneCollider : MonoBehaviour { public Vector3 m_Center = new Vector3(0, 0.1f, 0); }

namespace MagicaCloth
{
    public class MagicaSphereCollider : MonoBehaviour { public float radius = 0.05f; public Vector3 center = new Vector3(0, 0.1f, 0); }
    public class MagicaCapsuleCollider : MonoBehaviour { public int axis; public float length = 0.1f, startRadius = 0.05f, endRadius = 0.06f; public Vector3 center = new Vector3(0, 0.1f, 0); }
    public class MagicaPlaneCollider : MonoBehaviour { public Vector3 center = new Vector3(0, 0.1f, 0); }
    [Serializable] public class BezierParam { public float startValue = 0.05f, endValue = 0.03f, curveValue = 0.5f; }
    [Serializable]
    public class ClothParams
    {
        public BezierParam radius = new BezierParam(), clampPositionLength = new BezierParam(), penetrationConnectDistance = new BezierParam(),
            penetrationDistance = new BezierParam(), penetrationRadius = new BezierParam();
        public float nearDistanceLength = 0.1f, springRadius = 0.1f, maxVolumeLength = 0.1f, teleportDistance = 0.2f, mass = 3;
    }
    [Serializable] public class ClothTarget { public List<Transform> rootList = new List<Transform>(); }
    [Serializable] public class TeamData { public List<MonoBehaviour> colliderList = new List<MonoBehaviour>(); }
    public class MagicaBoneCloth : MonoBehaviour
    {
        public ClothParams clothParams = new ClothParams();
        public ClothTarget clothTarget = new ClothTarget();
        public TeamData teamData = new TeamData();
    }
    public class MagicaBoneSpring : MagicaBoneCloth { }
    public class MagicaMeshCloth : MonoBehaviour { public ClothParams clothParams = new ClothParams(); }
    public class MagicaMeshSpring : MonoBehaviour { public ClothParams clothParams = new ClothParams(); }
}

namespace MagicaCloth2
{
    [Serializable] public struct float3 { public float x, y, z; public float3(float x, float y, float z) { this.x = x; this.y = y; this.z = z; } }
    public class ColliderComponent : MonoBehaviour { public int direction = 1; public Vector3 center = new Vector3(0, 0.1f, 0), size = new Vector3(0.05f, 0.06f, 0.3f); }
    public class MagicaSphereCollider : ColliderComponent { }
    public class MagicaCapsuleCollider : ColliderComponent { public bool reverseDirection, radiusSeparation = true, alignedOnCenter = true; }
    public class MagicaPlaneCollider : ColliderComponent { }
    [Serializable] public class CurveSerializeData { public float value = 0.05f; public bool useCurve; }
    [Serializable] public class MotionConstraint { public CurveSerializeData maxDistance = new CurveSerializeData(), backstopDistance = new CurveSerializeData(); public float backstopRadius = 2; }
    [Serializable]
    public class ColliderConstraint
    {
        public CurveSerializeData limitDistance = new CurveSerializeData();
        public List<ColliderComponent> colliderList = new List<ColliderComponent>();
    }
    [Serializable] public class SelfConstraint { public CurveSerializeData surfaceThickness = new CurveSerializeData(); }
    [Serializable]
    public class ClothSerializeData
    {
        public List<Transform> rootBones = new List<Transform>();
        public CurveSerializeData radius = new CurveSerializeData();
        public MotionConstraint motionConstraint = new MotionConstraint();
        public ColliderConstraint colliderCollisionConstraint = new ColliderConstraint();
        public SelfConstraint selfCollisionConstraint = new SelfConstraint();
        public float gravity = 5;
    }
    [Serializable] public class SelectionData { public float3[] positions = { new float3(0, 0.1f, 0), new float3(0.1f, 0, 0.05f) }; public float maxConnectionDistance = 0.05f; }
    [Serializable] public class ClothSerializeData2 { public SelectionData selectionData = new SelectionData(); }
    public class MagicaCloth : MonoBehaviour { public ClothSerializeData serializeData = new ClothSerializeData(); public ClothSerializeData2 serializeData2 = new ClothSerializeData2(); }
}

namespace UnityEngine.Animations
{
    [Serializable] public struct ConstraintSource { public Transform sourceTransform; public float weight; }
    public class PositionConstraint : MonoBehaviour
    {
        [SerializeField] internal Vector3 m_TranslationAtRest, m_TranslationOffset = new Vector3(0.1f, 0, 0);
        [SerializeField] internal List<ConstraintSource> m_Sources = new List<ConstraintSource>();
    }
    public class ParentConstraint : MonoBehaviour
    {
        [SerializeField] internal Vector3 m_TranslationAtRest;
        [SerializeField] internal List<Vector3> m_TranslationOffsets = new List<Vector3>();
        [SerializeField] internal List<ConstraintSource> m_Sources = new List<ConstraintSource>();
    }
    public class Turned : MonoBehaviour { [SerializeField] internal Vector3 m_RotationOffset = new Vector3(1, 2, 3), m_ScaleOffset = Vector3.one, m_Position = Vector3.one; }
    public class RotationConstraint : Turned { }
    public class ScaleConstraint : Turned { }
    public class AimConstraint : Turned { }
    public class LookAtConstraint : Turned { }
}

namespace UnityEngine
{
    [Serializable] public struct SoftJointLimit { public float limit; }
    public class Joint : Component
    {
        [SerializeField] internal Rigidbody m_ConnectedBody;
        [SerializeField] internal Vector3 m_Anchor = new Vector3(0, 0.1f, 0), m_ConnectedAnchor = new Vector3(0.1f, 0, 0);
        [SerializeField] internal bool m_AutoConfigureConnectedAnchor;
    }
    public class CharacterJoint : Joint { }
    public class FixedJoint : Joint { }
    public class HingeJoint : Joint { }
    public class SpringJoint : Joint { [SerializeField] internal float m_MinDistance = 0.1f, m_MaxDistance = 0.2f, m_Spring = 10; }
    public class ConfigurableJoint : Joint
    {
        [SerializeField] internal SoftJointLimit m_LinearLimit = new SoftJointLimit { limit = 0.1f };
        [SerializeField] internal Vector3 m_TargetPosition = new Vector3(0.1f, 0, 0);
        [SerializeField] internal float m_ProjectionDistance = 0.1f;
    }
    public class LODGroup : Component { [SerializeField] internal float m_Size = 1.8f; [SerializeField] internal Vector3 m_LocalReferencePoint = new Vector3(0, 0.9f, 0); }
    [Serializable] public class LineParameters { public float widthMultiplier = 0.1f; }
    public class LineRenderer : MonoBehaviour
    {
        [SerializeField] internal LineParameters m_Parameters = new LineParameters();
        [SerializeField] internal Vector3[] m_Positions = { new Vector3(0, 0.1f, 0), new Vector3(0, 0, 0.1f) };
        [SerializeField] internal bool m_UseWorldSpace;
    }
    public class TrailRenderer : MonoBehaviour
    {
        [SerializeField] internal LineParameters m_Parameters = new LineParameters();
        [SerializeField] internal float m_MinVertexDistance = 0.1f, m_Time = 5;
    }
    public class WheelCollider : Collider
    {
        [SerializeField] internal Vector3 m_Center = new Vector3(0, 0.1f, 0);
        [SerializeField] internal float m_Radius = 0.2f, m_SuspensionDistance = 0.1f, m_ForceAppPointDistance = 0.05f;
    }
    public class AudioSource : Component { [SerializeField] internal float MinDistance = 1, MaxDistance = 10; }
    [Serializable] public class MinMaxCurve { public float scalar = 1, minScalar = 0.5f; }
    [Serializable] public class MultiModeParameter { public float value = 1, spread = 0.5f; }
    [Serializable]
    public class InitialModule
    {
        public MinMaxCurve startSize = new MinMaxCurve(), startSizeY = new MinMaxCurve(), startSizeZ = new MinMaxCurve(), startSpeed = new MinMaxCurve(),
            gravityModifier = new MinMaxCurve(), startLifetime = new MinMaxCurve();
    }
    [Serializable] public class AxesModule { public MinMaxCurve x = new MinMaxCurve(), y = new MinMaxCurve(), z = new MinMaxCurve(); }
    [Serializable] public class NoiseModule { public MinMaxCurve strength = new MinMaxCurve(), strengthY = new MinMaxCurve(), strengthZ = new MinMaxCurve(); }
    [Serializable]
    public class ShapeModule
    {
        public int type = 5;
        public MultiModeParameter radius = new MultiModeParameter();
        public float length = 5, donutRadius = 0.2f, m_MeshNormalOffset = 0.1f, angle = 25;
        public Vector3 m_Position = new Vector3(0, 0.1f, 0), m_Scale = new Vector3(1, 2, 3), m_Rotation = new Vector3(10, 0, 0);
    }
    public class ParticleSystem : Component
    {
        [SerializeField] internal InitialModule InitialModule = new InitialModule();
        [SerializeField] internal AxesModule VelocityModule = new AxesModule(), ForceModule = new AxesModule();
        [SerializeField] internal NoiseModule NoiseModule = new NoiseModule();
        [SerializeField] internal ShapeModule ShapeModule = new ShapeModule();
    }
}

namespace SomebodyElse
{
    /// <summary>What no table knows: one looks like a length, the other does not.</summary>
    public class Tail : MonoBehaviour { public float tailRadius = 0.1f, speed = 3; public Vector3 restOffset = new Vector3(0, 1, 0); }
    public class Blinker : MonoBehaviour { public float interval = 3; public int size = 2; }
}
