using System;
using UnityEngine;

namespace SuperDeform.Editor
{
    /// <summary>
    /// How far a pose is from both a T and an A pose: arms out to the side, level or up to 60 degrees down, legs down and at
    /// most 25 degrees apart from that.
    /// </summary>
    public struct PoseMeasure
    {
        /// <summary>Above this many degrees a pose is far from a T or A pose.</summary>
        public const double Limit = 20;

        /// <summary>Below this many degrees one pose is no better than another.</summary>
        public const double Clearly = 10;

        const double LowestArm = 60, WidestLeg = 25;

        /// <summary>The largest angle of a limb to where it may be; 0 where the joints are not known.</summary>
        public double Degrees;

        /// <summary>The joint at the beginning of that limb.</summary>
        public HumanBodyBones Limb;

        /// <summary>
        /// roles: by HumanBodyBones, a joint or -1
        /// rest: by joint, in a space where up is +Y and forward +Z
        /// </summary>
        public static PoseMeasure Of(int[] roles, Affine[] rest)
        {
            PoseMeasure worst = new PoseMeasure { Limb = HumanBodyBones.LeftUpperArm };
            worst.Arm(roles, rest, HumanBodyBones.LeftUpperArm, HumanBodyBones.LeftLowerArm, HumanBodyBones.LeftHand, -1);
            worst.Arm(roles, rest, HumanBodyBones.RightUpperArm, HumanBodyBones.RightLowerArm, HumanBodyBones.RightHand, 1);
            worst.Leg(roles, rest, HumanBodyBones.LeftUpperLeg, HumanBodyBones.LeftLowerLeg);
            worst.Leg(roles, rest, HumanBodyBones.RightUpperLeg, HumanBodyBones.RightLowerLeg);
            return worst;
        }

        void Arm(int[] roles, Affine[] rest, HumanBodyBones upper, HumanBodyBones lower, HumanBodyBones hand, double side)
        {
            Take(upper, ArmAngle(Direction(roles, rest, upper, lower), side));
            Take(lower, ArmAngle(Direction(roles, rest, lower, hand), side));
        }

        void Leg(int[] roles, Affine[] rest, HumanBodyBones upper, HumanBodyBones lower)
        {
            Double3? leg = Direction(roles, rest, upper, lower);
            if (leg.HasValue) Take(upper, Math.Max(0, Angle(leg.Value, new Double3(0, -1, 0)) - WidestLeg));
        }

        void Take(HumanBodyBones limb, double degrees)
        {
            if (!(degrees > Degrees)) return;
            Degrees = degrees;
            Limb = limb;
        }

        static double ArmAngle(Double3? arm, double side)
        {
            if (!arm.HasValue) return 0;
            double down = Math.Atan2(-arm.Value.Y, arm.Value.X * side) * 180 / Math.PI;
            double nearest = Math.Min(Math.Max(down, 0), LowestArm) * Math.PI / 180;
            // An arm that points inwards is nearer to the lowest place, or to the level one where it points up.
            if (down < -90) nearest = 0;
            return Angle(arm.Value, new Double3(side * Math.Cos(nearest), -Math.Sin(nearest), 0));
        }

        static Double3? Direction(int[] roles, Affine[] rest, HumanBodyBones from, HumanBodyBones to)
        {
            int start = roles[(int)from], end = roles[(int)to];
            if (start < 0 || end < 0) return null;
            Double3 direction = rest[end].Position - rest[start].Position;
            return direction.Length > 0 ? direction.Normalized : (Double3?)null;
        }

        static double Angle(Double3 one, Double3 other)
        {
            return Math.Acos(Math.Max(-1, Math.Min(1, one.Dot(other)))) * 180 / Math.PI;
        }
    }
}
