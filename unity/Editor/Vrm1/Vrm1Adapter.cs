using UniVRM10;
using UnityEditor;
using UnityEngine;

namespace SuperDeform.Editor.Vrm1
{
    /// <summary>What UniVRM 1.0 holds in lengths: joints of springs, their colliders, the origin of look-at.</summary>
    /// <remarks>
    /// Written for the fields of UniVRM 0.123 to 0.131. A spring's step is stiffness and gravity in metres: only scaled with
    /// the joint it swings the same. Drag, directions, angles and the names in expressions stay.
    /// </remarks>
    public sealed class Vrm1Adapter : IComponentAdapter
    {
        [InitializeOnLoadMethod]
        private static void Register()
        {
            ComponentAdapters.Register(new Vrm1Adapter());
        }

        /// <summary>True for VRM10SpringBoneJoint, VRM10SpringBoneCollider and Vrm10Instance.</summary>
        public bool Handles(Component copy)
        {
            return copy is VRM10SpringBoneJoint || copy is VRM10SpringBoneCollider || copy is Vrm10Instance;
        }

        /// <summary>Brings one component of the new avatar from the old lengths to the new ones.</summary>
        public void Adapt(Component copy, PointMap map)
        {
            if (copy is Vrm10Instance)
                AdaptLookAt((Vrm10Instance)copy, map);
            else if (map.Joint(copy.transform) == null)
                return;
            else if (copy is VRM10SpringBoneJoint)
                AdaptJoint((VRM10SpringBoneJoint)copy, map);
            else
                AdaptCollider((VRM10SpringBoneCollider)copy, map);
        }

        private static void AdaptJoint(VRM10SpringBoneJoint joint, PointMap map)
        {
            float scale = map.Scale(joint.transform, Vector3.zero);
            joint.m_jointRadius *= scale;
            joint.m_stiffnessForce *= scale;
            joint.m_gravityPower *= scale;
        }

        private static void AdaptCollider(VRM10SpringBoneCollider collider, PointMap map)
        {
            Transform joint = collider.transform;
            float scale = map.Scale(joint, collider.Offset);
            switch (collider.ColliderType)
            {
                case VRM10SpringBoneColliderTypes.Plane:
                    collider.Normal = map.Normal(joint, collider.Offset, collider.Normal);
                    break;
                case VRM10SpringBoneColliderTypes.Capsule:
                case VRM10SpringBoneColliderTypes.CapsuleInside:
                    Vector3 axis = collider.Tail - collider.Offset;
                    // Without length it is a sphere; one radius for both ends.
                    scale = axis == Vector3.zero
                        ? Mathf.Sqrt(scale * map.Scale(joint, collider.Tail))
                        : Mathf.Sqrt(map.Across(joint, collider.Offset, axis) * map.Across(joint, collider.Tail, axis));
                    collider.Tail = map.Point(joint, collider.Tail);
                    collider.Radius *= scale;
                    break;
                default:
                    collider.Radius *= scale;
                    break;
            }
            collider.Offset = map.Point(joint, collider.Offset);
        }

        // The settings of look-at lie in an asset that the old avatar uses too: the new one gets its own.
        private static void AdaptLookAt(Vrm10Instance instance, PointMap map)
        {
            Transform head = Head(instance);
            if (instance.Vrm == null || instance.Vrm.LookAt == null || head == null || map.Joint(head) == null)
                return;
            VRM10Object own = Object.Instantiate(instance.Vrm);
            own.name = instance.Vrm.name;
            own.Prefab = null;
            own.LookAt.OffsetFromHead = map.Point(head, own.LookAt.OffsetFromHead);
            map.AddAsset(own);
            instance.Vrm = own;
        }

        private static Transform Head(Vrm10Instance instance)
        {
            return HumanoidRoles.Of(instance.GetComponent<Animator>())[(int)HumanBodyBones.Head];
        }
    }
}
