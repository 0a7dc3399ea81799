using System.Collections.Generic;
using UniVRM10;
using UnityEditor;
using UnityEngine;

namespace SuperDeform.Editor.Vrm1
{
    /// <summary>What UniVRM 1.0 holds in lengths: joints of springs, their colliders, the origin of look-at.</summary>
    /// <remarks>
    /// Written for the fields of UniVRM 0.123 to 0.131. A spring's step is stiffness and gravity in metres: only scaled with
    /// the joint it swings the same. Gravity gives way where a chain stands off further than it did. Drag, directions, angles and
    /// the names in expressions stay.
    /// </remarks>
    public sealed class Vrm1Adapter : ISpringAdapter
    {
        [InitializeOnLoadMethod]
        static void Register()
        {
            ComponentAdapters.Register(new Vrm1Adapter());
        }

        /// <summary>True for VRM10SpringBoneJoint, VRM10SpringBoneCollider and Vrm10Instance.</summary>
        public bool Handles(Component copy) => copy is VRM10SpringBoneJoint || copy is VRM10SpringBoneCollider || copy is Vrm10Instance;

        /// <summary>Brings one component of the new avatar from the old lengths to the new ones.</summary>
        public void Adapt(Component copy, PointMap map)
        {
            if (copy is Vrm10Instance)
            {
                AdaptLookAt((Vrm10Instance)copy, map);
                AdaptGravity((Vrm10Instance)copy, map);
            }
            else if (map.Joint(copy.transform) == null) return;
            else if (copy is VRM10SpringBoneJoint) AdaptJoint((VRM10SpringBoneJoint)copy, map);
            else AdaptCollider((VRM10SpringBoneCollider)copy, map);
        }

        /// <summary>Adds the ends of an avatar's spring bones: each joint, with the radius of the one before it.</summary>
        public void AddSprings(Component copy, Springs springs)
        {
            Vrm10Instance instance = copy as Vrm10Instance;
            if (instance == null || instance.SpringBone == null) return;
            foreach (Vrm10InstanceSpringBone.Spring spring in instance.SpringBone.Springs)
            {
                foreach (VRM10SpringBoneCollider collider in CollidersOf(spring))
                {
                    for (int end = 1; end < spring.Joints.Count; end++)
                    {
                        if (spring.Joints[end - 1] != null && spring.Joints[end] != null)
                        {
                            Transform joint = spring.Joints[end].transform;
                            springs.Add(collider, joint, Vector3.zero, spring.Joints[end - 1].m_jointRadius, joint);
                        }
                    }
                }
            }
        }

        // A collider may be in several groups.
        static HashSet<VRM10SpringBoneCollider> CollidersOf(Vrm10InstanceSpringBone.Spring spring)
        {
            var colliders = new HashSet<VRM10SpringBoneCollider>();
            foreach (VRM10SpringBoneColliderGroup group in spring.ColliderGroups)
            {
                if (group != null) colliders.UnionWith(group.Colliders);
            }
            return colliders;
        }

        static void AdaptJoint(VRM10SpringBoneJoint joint, PointMap map)
        {
            float scale = map.Scale(joint.transform, Vector3.zero);
            joint.m_jointRadius *= scale;
            joint.m_stiffnessForce *= scale;
            joint.m_gravityPower *= scale;
        }

        // Of whole chains. A joint's gravity over its stiffness is what it was, whether it has been scaled yet or not.
        static void AdaptGravity(Vrm10Instance instance, PointMap map)
        {
            if (instance.SpringBone == null) return;
            foreach (Vrm10InstanceSpringBone.Spring spring in instance.SpringBone.Springs)
            {
                List<VRM10SpringBoneJoint> joints = spring.Joints.FindAll(joint => joint != null);
                var bend = new RestBend(map);
                for (int end = 1; end < joints.Count; end++)
                {
                    VRM10SpringBoneJoint joint = joints[end - 1];
                    bend.Add(joint.transform, joints[end].transform, joint.m_stiffnessForce, joint.m_gravityPower, joint.m_gravityDir);
                }
                foreach (VRM10SpringBoneJoint joint in joints) joint.m_gravityPower *= bend.GravityKept;
            }
        }

        static void AdaptCollider(VRM10SpringBoneCollider collider, PointMap map)
        {
            bool plane = collider.ColliderType == VRM10SpringBoneColliderTypes.Plane;
            LocalCollider moved = map.Collider(collider.transform, new LocalCollider
            {
                Kind = Kinds[collider.ColliderType], Start = collider.Offset, End = plane ? collider.Normal : collider.Tail, Radius = collider.Radius
            }, collider);
            collider.Offset = moved.Start;
            collider.Radius = moved.Radius;
            if (plane) collider.Normal = moved.End;
            else if (collider.ColliderType == VRM10SpringBoneColliderTypes.Capsule || collider.ColliderType == VRM10SpringBoneColliderTypes.CapsuleInside)
            {
                collider.Tail = moved.End;
            }
        }

        static readonly Dictionary<VRM10SpringBoneColliderTypes, ColliderKind> Kinds = new Dictionary<VRM10SpringBoneColliderTypes, ColliderKind>
        {
            { VRM10SpringBoneColliderTypes.Sphere, ColliderKind.Sphere }, { VRM10SpringBoneColliderTypes.Capsule, ColliderKind.Capsule },
            { VRM10SpringBoneColliderTypes.Plane, ColliderKind.Plane }, { VRM10SpringBoneColliderTypes.SphereInside, ColliderKind.InsideSphere },
            { VRM10SpringBoneColliderTypes.CapsuleInside, ColliderKind.InsideCapsule }
        };

        // The settings of look-at lie in an asset that the old avatar uses too: the new one gets its own.
        static void AdaptLookAt(Vrm10Instance instance, PointMap map)
        {
            Transform head = Head(instance);
            if (instance.Vrm == null || instance.Vrm.LookAt == null || head == null || map.Joint(head) == null) return;
            VRM10Object own = Object.Instantiate(instance.Vrm);
            own.name = instance.Vrm.name;
            own.Prefab = null;
            own.LookAt.OffsetFromHead = map.Point(head, own.LookAt.OffsetFromHead);
            map.AddAsset(own);
            instance.Vrm = own;
        }

        static Transform Head(Vrm10Instance instance) => HumanoidRoles.Of(instance.GetComponent<Animator>())[(int)HumanBodyBones.Head];
    }
}
