using UnityEngine;

namespace SuperDeform.Editor
{
    /// <summary>Which way an avatar stands and looks, in the space of its root.</summary>
    public static class Facing
    {
        public static readonly Double3 Up = new Double3(0, 1, 0);

        /// <summary>
        /// The way it looks: level, and at right angles to the line between right and left limbs; +Z where those are not
        /// known.
        /// </summary>
        /// <param name="roles">By HumanBodyBones: a joint, or -1.</param>
        /// <param name="rest">By joint.</param>
        public static Double3 Of(int[] roles, Affine[] rest)
        {
            Double3 left = Leftward(roles, rest, HumanBodyBones.LeftUpperArm, HumanBodyBones.RightUpperArm)
                + Leftward(roles, rest, HumanBodyBones.LeftUpperLeg, HumanBodyBones.RightUpperLeg);
            // Unity's axes are left-handed.
            Double3 forward = Up.Cross(left).Normalized;
            return forward.IsFinite && forward.Length > 0 ? forward : new Double3(0, 0, 1);
        }

        static Double3 Leftward(int[] roles, Affine[] rest, HumanBodyBones left, HumanBodyBones right)
        {
            int one = roles[(int)left], other = roles[(int)right];
            if (one < 0 || other < 0) return new Double3(0, 0, 0);
            Double3 across = rest[one].Position - rest[other].Position;
            return new Double3(across.X, 0, across.Z).Normalized;
        }
    }
}
