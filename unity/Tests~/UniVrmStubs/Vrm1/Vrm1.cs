// Names and shapes of what the adapter touches of UniVRM 1.0, so that it compiles and runs without UniVRM.
// Read in vrm-c/UniVRM (MIT), Assets/VRM10/Runtime/Components, 0.128.2: VRM10SpringBoneJoint, VRM10SpringBoneCollider,
// VRM10SpringBoneColliderGroup, Vrm10Instance, Vrm10InstanceSpringBone, VRM10Object, VRM10ObjectLookAt, VRM10ObjectMeta; ModificationType (there of UniGLTF) has
// the words of the specification.

using System;
using System.Collections.Generic;
using UnityEngine;

namespace UniVRM10
{
    public class VRM10SpringBoneJoint : MonoBehaviour
    {
        public float m_stiffnessForce = 1.0f;
        public float m_gravityPower = 0;
        public Vector3 m_gravityDir = new Vector3(0, -1.0f, 0);
        public float m_dragForce = 0.4f;
        public float m_jointRadius = 0.02f;
    }

    public enum VRM10SpringBoneColliderTypes
    {
        Sphere,
        Capsule,
        Plane,
        SphereInside,
        CapsuleInside,
    }

    public class VRM10SpringBoneCollider : MonoBehaviour
    {
        public VRM10SpringBoneColliderTypes ColliderType;
        public Vector3 Offset;
        public float Radius;
        public Vector3 Tail;
        public Vector3 Normal = Vector3.up;
    }

    [Serializable]
    public class VRM10ObjectLookAt
    {
        public Vector3 OffsetFromHead = new Vector3(0, 0.06f, 0);
    }

    public class PrefabRelatedScriptableObject : ScriptableObject
    {
        public GameObject Prefab { set; get; }
    }

    public enum ModificationType
    {
        prohibited,
        allowModification,
        allowModificationRedistribution,
    }

    [Serializable]
    public class VRM10ObjectMeta
    {
        public ModificationType Modification = ModificationType.allowModificationRedistribution;
        public string OtherLicenseUrl;
    }

    public class VRM10Object : PrefabRelatedScriptableObject
    {
        public VRM10ObjectMeta Meta = new VRM10ObjectMeta();
        public VRM10ObjectLookAt LookAt = new VRM10ObjectLookAt();
    }

    public class VRM10SpringBoneColliderGroup : MonoBehaviour
    {
        public List<VRM10SpringBoneCollider> Colliders = new List<VRM10SpringBoneCollider>();
    }

    [Serializable]
    public sealed class Vrm10InstanceSpringBone
    {
        public List<VRM10SpringBoneColliderGroup> ColliderGroups = new List<VRM10SpringBoneColliderGroup>();

        [Serializable]
        public class Spring
        {
            public string Name;
            public List<VRM10SpringBoneColliderGroup> ColliderGroups = new List<VRM10SpringBoneColliderGroup>();
            public List<VRM10SpringBoneJoint> Joints = new List<VRM10SpringBoneJoint>();

            public Spring(string name)
            {
                Name = name;
            }
        }

        public List<Spring> Springs = new List<Spring>();
    }

    public class Vrm10Instance : MonoBehaviour
    {
        public VRM10Object Vrm;
        public Vrm10InstanceSpringBone SpringBone = new Vrm10InstanceSpringBone();
    }
}
