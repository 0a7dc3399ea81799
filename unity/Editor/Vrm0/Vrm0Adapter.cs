using System.Collections.Generic;
using UnityEditor;
using UnityEngine;
using VRM;

namespace SuperDeform.Editor.Vrm0
{
    /// <summary>What UniVRM 0.x holds in lengths: spring bones, their colliders, the viewpoint.</summary>
    /// <remarks>
    /// Written for the fields of UniVRM 0.68 to 0.131. A spring's step is stiffness and gravity in metres: only scaled with
    /// the chain it swings the same. Drag, directions and the angles of look-at stay.
    /// </remarks>
    public sealed class Vrm0Adapter : IComponentAdapter
    {
        [InitializeOnLoadMethod]
        private static void Register()
        {
            ComponentAdapters.Register(new Vrm0Adapter());
        }

        /// <summary>True for VRMSpringBone, VRMSpringBoneColliderGroup and VRMFirstPerson.</summary>
        public bool Handles(Component copy)
        {
            return copy is VRMSpringBone || copy is VRMSpringBoneColliderGroup || copy is VRMFirstPerson;
        }

        /// <summary>Brings one component of the new avatar from the old lengths to the new ones.</summary>
        public void Adapt(Component copy, PointMap map)
        {
            if (copy is VRMSpringBone)
                AdaptSpring((VRMSpringBone)copy, map);
            else if (copy is VRMSpringBoneColliderGroup)
                AdaptColliders((VRMSpringBoneColliderGroup)copy, map);
            else
                AdaptViewpoint((VRMFirstPerson)copy, map);
        }

        // One set of numbers for several chains: the mean scale of all their joints.
        private static void AdaptSpring(VRMSpringBone spring, PointMap map)
        {
            var joints = new HashSet<Transform>();
            foreach (Transform root in spring.RootBones)
            {
                if (root != null)
                    joints.UnionWith(root.GetComponentsInChildren<Transform>(true));
            }
            double sum = 0;
            int count = 0;
            foreach (Transform joint in joints)
            {
                if (map.Joint(joint) == null)
                    continue;
                sum += map.Scale(joint, Vector3.zero);
                count++;
            }
            if (count == 0)
                return;
            float scale = (float)(sum / count);
            spring.m_hitRadius *= scale;
            spring.m_stiffnessForce *= scale;
            spring.m_gravityPower *= scale;
        }

        private static void AdaptColliders(VRMSpringBoneColliderGroup group, PointMap map)
        {
            if (group.Colliders == null || map.Joint(group.transform) == null)
                return;
            foreach (VRMSpringBoneColliderGroup.SphereCollider collider in group.Colliders)
            {
                float scale = map.Scale(group.transform, collider.Offset);
                collider.Offset = map.Point(group.transform, collider.Offset);
                collider.Radius *= scale;
            }
        }

        private static void AdaptViewpoint(VRMFirstPerson viewpoint, PointMap map)
        {
            Transform bone = viewpoint.FirstPersonBone;
            if (bone != null && map.Joint(bone) != null)
                viewpoint.FirstPersonOffset = map.Point(bone, viewpoint.FirstPersonOffset);
        }
    }
}
