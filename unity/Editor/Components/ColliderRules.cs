using System;
using UnityEditor;
using UnityEngine;

namespace SuperDeform.Editor
{
    /// <summary>The ways in which colliders of springs change; what else is round, such as contacts, changes alike.</summary>
    internal static class ColliderRules
    {
        static readonly Vector3 Up = new Vector3(0, 1, 0);

        /// <param name="inside">Where it says whether springs are kept inside; null: they are kept out.</param>
        internal static Rule Ball(string center, string radius, string inside = null)
        {
            return scope =>
            {
                Vector3 at = scope.VectorAt(center, Vector3.zero);
                var moved = new Capsule(at, at, scope.FloatAt(radius, 0), 0).Moved(scope, scope.IsOn(inside));
                scope.Multiply(radius, moved.Growth);
                scope.SetVector(center, moved.Middle);
            };
        }

        /// <summary>A plane whose normal is Y, turned by a rotation.</summary>
        internal static Rule Plane(string center, string rotation)
        {
            return scope =>
            {
                Quaternion turn = scope.TurnAt(rotation);
                var plane = new LocalCollider { Kind = ColliderKind.Plane, Start = scope.VectorAt(center, Vector3.zero), End = turn * Up };
                LocalCollider moved = scope.Map.Collider(scope.Frame, plane, scope.Component);
                scope.SetVector(center, moved.Start);
                scope.SetTurn(rotation, Quaternion.FromToRotation(plane.End, moved.End) * turn);
            };
        }

        /// <summary>A capsule along Y, turned by a rotation; its height is from tip to tip.</summary>
        internal static Rule Upright(string center, string radius, string height, string rotation, string inside = null)
        {
            return scope =>
            {
                Quaternion turn = scope.TurnAt(rotation);
                float round = scope.FloatAt(radius, 0);
                Capsule old = Capsule.Around(scope.VectorAt(center, Vector3.zero), turn * Up, scope.FloatAt(height, 0), round, round);
                Capsule moved = old.Moved(scope, scope.IsOn(inside));
                scope.Multiply(radius, moved.Growth);
                scope.SetVector(center, moved.Middle);
                if (old.IsBall)
                {
                    scope.Multiply(height, moved.Growth);
                    return;
                }
                scope.SetFloat(height, moved.Length);
                scope.SetTurn(rotation, Quaternion.FromToRotation(old.Way, moved.Way) * turn);
            };
        }

        /// <summary>A capsule along one of the frame's axes, which cannot turn; its length is from tip to tip.</summary>
        /// <param name="otherRadius">Of the end on the axis's negative side; where it is no positive number, the other end's counts.</param>
        /// <param name="inside">Where it says whether springs are kept inside; null: they are kept out.</param>
        /// <param name="separate">Where it says whether the other radius counts; null: it does.</param>
        /// <param name="aligned">Where it says whether it lies around its centre or begins there; null: it lies around it.</param>
        internal static Rule Along(string center, Func<PropertyScope, Vector3> axis, string length, string radius, string otherRadius,
            string inside = null, string separate = null, string aligned = null)
        {
            return scope =>
            {
                float one = scope.FloatAt(radius, 0), other = scope.FloatAt(otherRadius, 0);
                if (!(other > 0) || !scope.IsOn(separate, true)) other = one;
                bool around = scope.IsOn(aligned, true);
                Vector3 at = scope.VectorAt(center, Vector3.zero), way = axis(scope);
                Capsule old = around
                    ? Capsule.Around(at, way, scope.FloatAt(length, 0), one, other)
                    : new Capsule(at, at - way * Math.Max(0, scope.FloatAt(length, 0) - one - other), one, other);
                Capsule moved = old.Moved(scope, scope.IsOn(inside));
                scope.Multiply(radius, moved.Growth);
                scope.Multiply(otherRadius, moved.Growth);
                // The axis stays, so the middle goes where it should, and the ends nearly do.
                float ahead = around ? (one - other) * moved.Growth / 2 : moved.Apart / 2;
                scope.SetVector(center, old.IsBall ? moved.Middle : moved.Middle + way * ahead);
                if (old.IsBall) scope.Multiply(length, moved.Growth);
                else scope.SetFloat(length, moved.Length);
            };
        }

        /// <summary>The same, where the length is from the centre to the middle of either end.</summary>
        internal static Rule HalfAlong(string center, Func<PropertyScope, Vector3> axis, string length, string radius, string otherRadius)
        {
            return scope =>
            {
                Vector3 at = scope.VectorAt(center, Vector3.zero), half = axis(scope) * scope.FloatAt(length, 0);
                var moved = new Capsule(at + half, at - half, scope.FloatAt(radius, 0), scope.FloatAt(otherRadius, 0)).Moved(scope, false);
                scope.Multiply(radius, moved.Growth);
                scope.Multiply(otherRadius, moved.Growth);
                scope.SetVector(center, moved.Middle);
                scope.SetFloat(length, moved.Apart / 2);
            };
        }
    }

    /// <summary>Two balls and what lies between them; or one, where they are in the same place.</summary>
    internal struct Capsule
    {
        /// <summary>The middles of the balls.</summary>
        internal readonly Vector3 First, Second;

        /// <summary>By how much the radii have grown; 1 before Moved.</summary>
        internal float Growth { get; private set; }

        readonly float radius, otherRadius;

        internal Capsule(Vector3 first, Vector3 second, float radius, float otherRadius)
        {
            First = first;
            Second = second;
            this.radius = radius;
            this.otherRadius = otherRadius;
            Growth = 1;
        }

        /// <summary>One of a length from tip to tip; one that is too short for its radii is the larger ball.</summary>
        internal static Capsule Around(Vector3 center, Vector3 axis, float length, float radius, float otherRadius)
        {
            float half = length / 2, most = Math.Max(radius, otherRadius);
            if (half <= most) return new Capsule(center, center, most, most);
            return new Capsule(center + axis * (half - radius), center - axis * (half - otherRadius), radius, otherRadius);
        }

        internal bool IsBall => First == Second;

        /// <summary>The direction from the second ball to the first.</summary>
        internal Vector3 Way => (First - Second).normalized;

        /// <summary>From tip to tip.</summary>
        internal float Length => Apart + radius + otherRadius;

        /// <summary>From the middle of one ball to that of the other.</summary>
        internal float Apart => Vector3.Distance(First, Second);

        /// <summary>Half-way between the middles of the balls.</summary>
        internal Vector3 Middle => (First + Second) * 0.5f;

        /// <summary>What becomes of it in the frame of a component; both radii grow alike.</summary>
        internal Capsule Moved(PropertyScope scope, bool inside)
        {
            float most = Math.Max(radius, otherRadius);
            LocalCollider moved = scope.Map.Collider(scope.Frame, new LocalCollider
            {
                Kind = IsBall ? (inside ? ColliderKind.InsideSphere : ColliderKind.Sphere) : inside ? ColliderKind.InsideCapsule : ColliderKind.Capsule,
                Start = First, End = Second, Radius = most
            }, scope.Component);
            float growth = most > 0 ? moved.Radius / most : 1;
            return new Capsule(moved.Start, IsBall ? moved.Start : moved.End, radius * growth, otherRadius * growth) { Growth = growth };
        }
    }
}
