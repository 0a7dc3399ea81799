using System.Collections.Generic;
using UnityEditor;
using UnityEngine;
using VRM;

namespace SuperDeform.Editor.Vrm0
{
    /// <summary>What UniVRM 0.x holds in lengths: spring bones, their colliders, the viewpoint.</summary>
    /// <remarks>
    /// Written for the fields of UniVRM 0.68 to 0.131. A spring's step is stiffness and gravity in metres: only scaled with
    /// the chain it swings the same. Gravity gives way where chains stand off further than they did. Drag, directions and the
    /// angles of look-at stay.
    /// </remarks>
    public sealed class Vrm0Adapter : ISpringAdapter
    {
        [InitializeOnLoadMethod]
        static void Register()
        {
            ComponentAdapters.Register(new Vrm0Adapter());
        }

        /// <summary>True for VRMSpringBone, VRMSpringBoneColliderGroup and VRMFirstPerson.</summary>
        public bool Handles(Component copy) => copy is VRMSpringBone || copy is VRMSpringBoneColliderGroup || copy is VRMFirstPerson;

        /// <summary>Brings one component of the new avatar from the old lengths to the new ones.</summary>
        public void Adapt(Component copy, PointMap map)
        {
            if (copy is VRMSpringBone) AdaptSpring((VRMSpringBone)copy, map);
            else if (copy is VRMSpringBoneColliderGroup) AdaptColliders((VRMSpringBoneColliderGroup)copy, map);
            else AdaptViewpoint((VRMFirstPerson)copy, map);
        }

        /// <summary>Adds the ends of a spring's bones: the joints of its chains but the first of each, which is the end of none.</summary>
        public void AddSprings(Component copy, Springs springs)
        {
            VRMSpringBone spring = copy as VRMSpringBone;
            if (spring == null || spring.ColliderGroups == null) return;
            foreach (Transform joint in JointsOf(spring))
            {
                if (!spring.RootBones.Contains(joint))
                {
                    foreach (VRMSpringBoneColliderGroup group in spring.ColliderGroups)
                    {
                        springs.Add(group, joint, Vector3.zero, spring.m_hitRadius, joint);
                    }
                }
            }
        }

        static HashSet<Transform> JointsOf(VRMSpringBone spring)
        {
            var joints = new HashSet<Transform>();
            foreach (Transform root in spring.RootBones)
            {
                if (root != null) joints.UnionWith(root.GetComponentsInChildren<Transform>(true));
            }
            return joints;
        }

        // One set of numbers for several chains: the mean scale of all their joints.
        static void AdaptSpring(VRMSpringBone spring, PointMap map)
        {
            double sum = 0;
            int count = 0;
            var bend = new RestBend(map);
            HashSet<Transform> joints = JointsOf(spring);
            foreach (Transform joint in joints)
            {
                if (map.Joint(joint) == null) continue;
                if (joints.Contains(joint.parent)) bend.Add(joint.parent, joint, spring.m_stiffnessForce, spring.m_gravityPower, spring.m_gravityDir);
                sum += map.Scale(joint, Vector3.zero);
                count++;
            }
            if (count == 0) return;
            float scale = (float)(sum / count);
            spring.m_hitRadius *= scale;
            spring.m_stiffnessForce *= scale;
            spring.m_gravityPower *= scale * bend.GravityKept;
        }

        static void AdaptColliders(VRMSpringBoneColliderGroup group, PointMap map)
        {
            if (group.Colliders == null || map.Joint(group.transform) == null) return;
            foreach (VRMSpringBoneColliderGroup.SphereCollider collider in group.Colliders)
            {
                LocalCollider moved = map.Collider(group.transform, new LocalCollider { Start = collider.Offset, Radius = collider.Radius }, group);
                collider.Offset = moved.Start;
                collider.Radius = moved.Radius;
            }
        }

        static void AdaptViewpoint(VRMFirstPerson viewpoint, PointMap map)
        {
            Transform bone = viewpoint.FirstPersonBone;
            if (bone != null && map.Joint(bone) != null) viewpoint.FirstPersonOffset = map.Point(bone, viewpoint.FirstPersonOffset);
        }
    }
}
