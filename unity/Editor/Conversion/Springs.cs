using System.Collections.Generic;
using UnityEngine;

namespace SuperDeform.Editor
{
    /// <summary>An adapter of components that are springs: says, before anything changes, which colliders they keep out of.</summary>
    public interface ISpringAdapter : IComponentAdapter
    {
        /// <param name="copy">A component of the new avatar that Handles is true for; it still holds what the source's holds.</param>
        /// <param name="springs">Receives its balls.</param>
        void AddSprings(Component copy, Springs springs);
    }

    /// <summary>
    /// The balls that springs keep out of colliders, one around the end of each bone: a collider that one of them would
    /// start nearer to than it was, or deeper in, yields.
    /// </summary>
    public sealed class Springs
    {
        internal struct Ball
        {
            internal Transform Joint, MeasuredIn;
            internal Vector3 Offset;
            internal float Radius;
        }

        static readonly Ball[] None = new Ball[0];

        readonly Dictionary<Component, List<Ball>> byCollider = new Dictionary<Component, List<Ball>>();

        /// <summary>Adds a ball that keeps out of a collider.</summary>
        /// <param name="collider">The component that holds the collider, of the new avatar; null: nothing is added.</param>
        /// <param name="joint">The joint at the end of the bone; null: nothing is added.</param>
        /// <param name="offset">The ball's middle, in the joint's space.</param>
        /// <param name="radius">In the units of measuredIn.</param>
        /// <param name="measuredIn">The transform whose scale multiplies the radius.</param>
        public void Add(Component collider, Transform joint, Vector3 offset, float radius, Transform measuredIn)
        {
            if (collider == null || joint == null) return;
            if (!byCollider.TryGetValue(collider, out List<Ball> balls)) byCollider.Add(collider, balls = new List<Ball>());
            balls.Add(new Ball { Joint = joint, Offset = offset, Radius = radius, MeasuredIn = measuredIn });
        }

        /// <summary>The balls that keep out of the colliders of a component; empty where no spring names it.</summary>
        internal IList<Ball> Of(Component collider) =>
            collider != null && byCollider.TryGetValue(collider, out List<Ball> balls) ? (IList<Ball>)balls : None;
    }
}
