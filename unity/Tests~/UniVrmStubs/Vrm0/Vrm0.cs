// Names and shapes of what the adapter touches of UniVRM 0.x, so that it compiles and runs without UniVRM.
// Read in vrm-c/UniVRM (MIT), Assets/VRM/Runtime, at 83b63ea (VRMSpringBone), 56bf73f (VRMSpringBoneColliderGroup) and
// 07311ec (VRMFirstPerson); the fields are the same since 0.68. VRMMeta, VRMMetaObject: 17b0958; LicenseType: the words of the
// specification of VRM 0.x.

using System.Collections.Generic;
using UnityEngine;

namespace VRM
{
    public sealed class VRMSpringBone : MonoBehaviour
    {
        public string m_comment;
        public float m_stiffnessForce = 1.0f;
        public float m_gravityPower;
        public Vector3 m_gravityDir = new Vector3(0, -1.0f, 0);
        public float m_dragForce = 0.4f;
        public Transform m_center;
        public List<Transform> RootBones = new List<Transform>();
        public float m_hitRadius = 0.02f;
        public VRMSpringBoneColliderGroup[] ColliderGroups;
    }

    public class VRMSpringBoneColliderGroup : MonoBehaviour
    {
        [System.Serializable]
        public class SphereCollider
        {
            public Vector3 Offset;
            public float Radius;
        }

        public SphereCollider[] Colliders = { new SphereCollider { Radius = 0.1f } };
    }

    public class VRMFirstPerson : MonoBehaviour
    {
        public Transform FirstPersonBone;
        public Vector3 FirstPersonOffset;
    }

    public enum LicenseType
    {
        Redistribution_Prohibited, CC0, CC_BY, CC_BY_NC, CC_BY_SA, CC_BY_NC_SA, CC_BY_ND, CC_BY_NC_ND, Other
    }

    public class VRMMetaObject : ScriptableObject
    {
        public string OtherPermissionUrl;
        public LicenseType LicenseType;
        public string OtherLicenseUrl;
    }

    public class VRMMeta : MonoBehaviour
    {
        public VRMMetaObject Meta;
    }

    public class VRMLookAtBoneApplyer : MonoBehaviour
    {
    }
}
