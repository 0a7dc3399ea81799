using System;
using System.Collections.Generic;
using UnityEngine;

namespace SuperDeform.Editor
{
    /// <summary>
    /// What becomes of colliders of springs: each is as thick as the mesh around it, and yields to springs that would
    /// start nearer to it than they were, or deeper in.
    /// </summary>
    internal sealed class ColliderMap
    {
        readonly PointMap map;
        readonly Deformer deformer;

        internal readonly Springs Springs = new Springs();

        // Half a percent: what is less would be told as none.
        const double LeastTold = 0.005;

        /// <summary>How many colliders have yielded visibly, and the largest share of a radius.</summary>
        internal int YieldedCount { get; private set; }
        internal double MostYielded { get; private set; }

        /// <summary>Colliders that springs start inside of and did not, and how many do.</summary>
        internal readonly List<KeyValuePair<Transform, int>> Crowded = new List<KeyValuePair<Transform, int>>();

        internal ColliderMap(PointMap map, Deformer deformer)
        {
            this.map = map;
            this.deformer = deformer;
        }

        /// <param name="joint">One that moves with the library's joint of this index.</param>
        /// <param name="named">The component that springs name the collider by; null: none does.</param>
        internal LocalCollider Of(Transform joint, uint index, LocalCollider collider, Component named)
        {
            Affine old = map.OldRest(joint);
            Double3 start = old.Point(Double3.Of(collider.Start));
            Double3 end = collider.Kind == ColliderKind.Plane
                ? old.Inverse.LinearTransposed.Direction(Double3.Of(collider.End)) : old.Point(Double3.Of(collider.End));
            SpringBall[] balls = Balls(named);
            SpringCollider moved = deformer.MapColliders(new[]
            {
                new SpringCollider
                {
                    Kind = collider.Kind, Joint = index, X = start.X, Y = start.Y, Z = start.Z, EndX = end.X, EndY = end.Y, EndZ = end.Z,
                    Radius = collider.Radius * Size(old), Springs = All(balls.Length)
                }
            }, balls)[0];
            Tell(joint, moved);
            return Back(joint, collider, moved, old);
        }

        SpringBall[] Balls(Component named)
        {
            var balls = new List<SpringBall>();
            foreach (Springs.Ball ball in Springs.Of(named))
            {
                int index = map.IndexOf(ball.Joint);
                if (index < 0) continue;
                Double3 middle = map.OldRest(ball.Joint).Point(Double3.Of(ball.Offset));
                double radius = ball.Radius * Size(map.OldRest(ball.MeasuredIn));
                balls.Add(new SpringBall { Joint = (uint)index, X = middle.X, Y = middle.Y, Z = middle.Z, Radius = radius });
            }
            return balls.ToArray();
        }

        static uint[] All(int count)
        {
            uint[] all = new uint[count];
            for (uint index = 0; index < count; index++)
            {
                all[index] = index;
            }
            return all;
        }

        /// <summary>By how much lengths of a joint's space are longer in the root's.</summary>
        static double Size(Affine rest)
        {
            double size = Math.Pow(Math.Abs(rest.Determinant), 1.0 / 3);
            return size > 0 ? size : 1;
        }

        void Tell(Transform joint, SpringCollider moved)
        {
            if (moved.NewlyInside > 0) Crowded.Add(new KeyValuePair<Transform, int>(map.Source(joint), (int)moved.NewlyInside));
            if (moved.Yielded >= LeastTold) YieldedCount++;
            MostYielded = Math.Max(MostYielded, moved.Yielded);
        }

        LocalCollider Back(Transform joint, LocalCollider collider, SpringCollider moved, Affine old)
        {
            Affine rest = map.NewRest(joint), back = rest.Inverse;
            Double3 start = back.Point(new Double3(moved.X, moved.Y, moved.Z)), end = new Double3(moved.EndX, moved.EndY, moved.EndZ);
            // A plane's normal keeps its length.
            end = collider.Kind == ColliderKind.Plane
                ? rest.LinearTransposed.Direction(end).Normalized * Double3.Of(collider.End).Length : back.Point(end);
            double radius = moved.Radius / Size(old);
            if (!start.IsFinite || !end.IsFinite || double.IsNaN(radius) || double.IsInfinity(radius)) return collider;
            return new LocalCollider { Kind = collider.Kind, Start = start.ToVector3(), End = end.ToVector3(), Radius = (float)radius };
        }
    }
}
