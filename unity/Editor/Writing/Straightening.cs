using System.Collections.Generic;
using UnityEngine;

namespace SuperDeform.Editor
{
    /// <summary>A made rig in T pose: what an Avatar takes for the pose in which all muscles rest.</summary>
    internal static class Straightening
    {
        internal static List<int> ParentsFirst(int[] parents)
        {
            var order = new List<int>();
            for (int joint = 0; joint < parents.Length; joint++)
            {
                int place = order.Count;
                for (int above = joint; above >= 0 && !order.Contains(above); above = parents[above])
                {
                    order.Insert(place, above);
                }
            }
            return order;
        }

        /// <summary>
        /// By joint, how it turns from the pose of the mesh to a T pose: arms level, legs down, hands and feet along.
        /// </summary>
        internal static Quaternion[] Turns(int[] parents, int[] roles, double[] positions)
        {
            Quaternion[] turns = new Quaternion[parents.Length];
            Vector3 left = new Vector3(-1, 0, 0), right = new Vector3(1, 0, 0), down = new Vector3(0, -1, 0);
            var limbs = new Dictionary<int, Quaternion>();
            Straighten(limbs, roles, positions, HumanoidRole.LeftUpperArm, HumanoidRole.LeftLowerArm, left);
            Straighten(limbs, roles, positions, HumanoidRole.LeftLowerArm, HumanoidRole.LeftHand, left);
            Straighten(limbs, roles, positions, HumanoidRole.RightUpperArm, HumanoidRole.RightLowerArm, right);
            Straighten(limbs, roles, positions, HumanoidRole.RightLowerArm, HumanoidRole.RightHand, right);
            Straighten(limbs, roles, positions, HumanoidRole.LeftUpperLeg, HumanoidRole.LeftLowerLeg, down);
            Straighten(limbs, roles, positions, HumanoidRole.LeftLowerLeg, HumanoidRole.LeftFoot, down);
            Straighten(limbs, roles, positions, HumanoidRole.RightUpperLeg, HumanoidRole.RightLowerLeg, down);
            Straighten(limbs, roles, positions, HumanoidRole.RightLowerLeg, HumanoidRole.RightFoot, down);
            Level(limbs, roles, HumanoidRole.LeftFoot);
            Level(limbs, roles, HumanoidRole.RightFoot);
            foreach (int joint in ParentsFirst(parents))
            {
                int parent = parents[joint];
                if (!limbs.TryGetValue(joint, out Quaternion turn)) turn = parent < 0 ? Quaternion.identity : turns[parent];
                turns[joint] = turn;
            }
            return turns;
        }

        static void Straighten(Dictionary<int, Quaternion> turns, int[] roles, double[] positions, HumanoidRole from, HumanoidRole to, Vector3 direction)
        {
            int start = roles[(int)from], end = roles[(int)to];
            if (start < 0 || end < 0) return;
            Double3 bone = MadeRig.Place(positions, end) - MadeRig.Place(positions, start);
            if (bone.Length > 0) turns[start] = Quaternion.FromToRotation(bone.Normalized.ToVector3(), direction);
        }

        /// <summary>Feet stand on the ground in both poses.</summary>
        static void Level(Dictionary<int, Quaternion> turns, int[] roles, HumanoidRole foot)
        {
            if (roles[(int)foot] >= 0) turns[roles[(int)foot]] = Quaternion.identity;
        }
    }
}
