using System;
using UnityEngine;

namespace SuperDeform.Editor
{
    /// <summary>
    /// How far a pose is from both a T and an A pose: arms out to the side, level or up to 60 degrees down, elbows bent by 30
    /// at most, legs within 25 degrees of straight down.
    /// </summary>
    public struct PoseMeasure
    {
        /// <summary>Above this many degrees a pose is far from a T or A pose.</summary>
        public const double Limit = 20;

        /// <summary>Below this many degrees one pose is no better than another.</summary>
        public const double Clearly = 10;

        const double LowestArm = 60, BentElbow = 30, WidestLeg = 25;

        /// <summary>The largest angle of a limb to where it may be; 0 where the joints are not known.</summary>
        public double Degrees;

        /// <summary>The joint at the beginning of that limb.</summary>
        public HumanBodyBones Limb;

        /// <param name="roles">By HumanBodyBones: a joint, or -1.</param>
        /// <param name="rest">By joint, in a space where up is +Y.</param>
        public static PoseMeasure Of(int[] roles, Affine[] rest)
        {
            Double3 right = Facing.Up.Cross(Facing.Of(roles, rest));
            var worst = new PoseMeasure { Limb = HumanBodyBones.LeftUpperArm };
            worst.Arm(roles, rest, HumanBodyBones.LeftUpperArm, HumanBodyBones.LeftLowerArm, HumanBodyBones.LeftHand, right * -1);
            worst.Arm(roles, rest, HumanBodyBones.RightUpperArm, HumanBodyBones.RightLowerArm, HumanBodyBones.RightHand, right);
            worst.Leg(roles, rest, HumanBodyBones.LeftUpperLeg, HumanBodyBones.LeftLowerLeg);
            worst.Leg(roles, rest, HumanBodyBones.RightUpperLeg, HumanBodyBones.RightLowerLeg);
            return worst;
        }

        void Arm(int[] roles, Affine[] rest, HumanBodyBones upper, HumanBodyBones lower, HumanBodyBones hand, Double3 outward)
        {
            Take(upper, ArmAngle(Direction(roles, rest, upper, lower), outward));
            Take(lower, ArmAngle(Direction(roles, rest, lower, hand), outward) - BentElbow);
        }

        void Leg(int[] roles, Affine[] rest, HumanBodyBones upper, HumanBodyBones lower)
        {
            Double3? leg = Direction(roles, rest, upper, lower);
            if (leg.HasValue) Take(upper, Angle(leg.Value, Facing.Up * -1) - WidestLeg);
        }

        void Take(HumanBodyBones limb, double degrees)
        {
            if (!(degrees > Degrees)) return;
            Degrees = degrees;
            Limb = limb;
        }

        static double ArmAngle(Double3? arm, Double3 outward)
        {
            if (!arm.HasValue) return 0;
            double down = Math.Atan2(-arm.Value.Y, arm.Value.Dot(outward)) * 180 / Math.PI;
            // Of an arm that points inwards the nearest place is the lowest, or the level one where it points up, too.
            double nearest = down < -90 ? 0 : Math.Min(Math.Max(down, 0), LowestArm);
            double angle = nearest * Math.PI / 180;
            return Angle(arm.Value, outward * Math.Cos(angle) - Facing.Up * Math.Sin(angle));
        }

        static Double3? Direction(int[] roles, Affine[] rest, HumanBodyBones from, HumanBodyBones to)
        {
            int start = roles[(int)from], end = roles[(int)to];
            if (start < 0 || end < 0) return null;
            Double3 direction = rest[end].Position - rest[start].Position;
            return direction.Length > 0 ? direction.Normalized : (Double3?)null;
        }

        static double Angle(Double3 one, Double3 other) => Math.Acos(Math.Max(-1, Math.Min(1, one.Dot(other)))) * 180 / Math.PI;
    }
}
