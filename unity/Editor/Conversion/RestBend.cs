using System;
using UnityEngine;

namespace SuperDeform.Editor
{
    /// <summary>How far gravity bends the bones of a chain of springs, before and after; with less of it they hang as they did.</summary>
    /// <remarks>
    /// Gravity and stiffness, r to 1 and at an angle a, balance where the bone is bent by atan(r sin a / (1 + r cos a)). At
    /// the angle b, r' bends it as far where r' (sin b + r sin(b - a)) = r sin a.
    /// </remarks>
    public sealed class RestBend
    {
        readonly PointMap map;
        double before, after;

        /// <summary>No bone yet.</summary>
        public RestBend(PointMap map)
        {
            this.map = map;
        }

        /// <summary>Adds the bone from one transform to another; one without stiffness hangs straight down anyway.</summary>
        /// <param name="down">Which way gravity pulls, in the avatar's space.</param>
        public void Add(Transform from, Transform to, float stiffness, float gravity, Vector3 down)
        {
            if (map.IndexOf(from) < 0 || map.IndexOf(to) < 0) return;
            double a = Angle(Between(map.OldRest(from), map.OldRest(to)), Double3.Of(down));
            double b = Angle(Between(map.NewRest(from), map.NewRest(to)), Double3.Of(down));
            double turned = Math.Sin(b) + gravity / (double)stiffness * Math.Sin(b - a);
            if (double.IsNaN(turned) || double.IsInfinity(turned)) return;
            before += Math.Sin(a);
            after += turned;
        }

        /// <summary>The share of gravity with which they bend at rest as far as they did, in the mean; at most 1.</summary>
        public float GravityKept => before < after ? (float)(before / after) : 1;

        static Double3 Between(Affine from, Affine to) => to.Point(new Double3()) - from.Point(new Double3());

        static double Angle(Double3 bone, Double3 down) => Math.Atan2(bone.Cross(down).Length, bone.Dot(down));
    }
}
