using System;
using System.Collections.Generic;
using UnityEngine;

namespace SuperDeform.Editor
{
    /// <summary>
    /// Where points that move with transforms go: colliders, eyes, viewpoints, the tails of springs.
    ///
    /// Transforms of the source and of the new avatar mean the same. What moves with the root itself, or in an avatar that
    /// came without bones, keeps its place on the ground and grows with the avatar's height.
    /// </summary>
    public sealed class PointMap
    {
        readonly AvatarData source;
        readonly AvatarResult result;
        readonly Deformer deformer;
        readonly Dictionary<Transform, Transform> sourceOf = new Dictionary<Transform, Transform>();
        readonly Dictionary<Transform, Transform> copyOf = new Dictionary<Transform, Transform>();
        readonly Dictionary<Renderer, Mesh> newMeshes = new Dictionary<Renderer, Mesh>();
        readonly List<UnityEngine.Object> assets = new List<UnityEngine.Object>();
        readonly uint[] joints = new uint[1];
        readonly double[] points = new double[3], positions = new double[3], scales = new double[1], jacobian = new double[9];

        /// <param name="copy">The new avatar's root, whose hierarchy is the source's.</param>
        internal PointMap(AvatarData source, AvatarResult result, Deformer deformer, Transform copy)
        {
            this.source = source;
            this.result = result;
            this.deformer = deformer;
            Colliders = new ColliderMap(this, deformer);
            Pair(source.Root.transform, copy);
        }

        internal Deformer Deformer => deformer;

        void Pair(Transform original, Transform copy)
        {
            sourceOf[copy] = original;
            copyOf[original] = copy;
            for (int child = 0; child < original.childCount && child < copy.childCount; child++)
            {
                Pair(original.GetChild(child), copy.GetChild(child));
            }
        }

        /// <summary>New over old height of the avatar; for lengths that belong to all of it.</summary>
        public float HeightRatio => (float)result.HeightRatio;

        /// <summary>
        /// The new avatar's transform that stands for one of the source; one of the new avatar is given back, others are null.
        /// </summary>
        public Transform Joint(Transform sourceOrCopy)
        {
            if (sourceOrCopy == null) return null;
            if (copyOf.TryGetValue(sourceOrCopy, out Transform copy)) return copy;
            return sourceOf.ContainsKey(sourceOrCopy) ? sourceOrCopy : null;
        }

        /// <summary>
        /// The source's transform that stands for one of the new avatar; one of the source is given back, others are null.
        /// </summary>
        public Transform Source(Transform sourceOrCopy)
        {
            if (sourceOrCopy == null) return null;
            if (sourceOf.TryGetValue(sourceOrCopy, out Transform original)) return original;
            return copyOf.ContainsKey(sourceOrCopy) ? sourceOrCopy : null;
        }

        /// <summary>Where a point goes.</summary>
        /// <param name="local">In the joint's space, in the source's units.</param>
        /// <returns>It in the moved joint's space. One of a transform outside the avatar stays.</returns>
        public Vector3 Point(Transform joint, Vector3 local)
        {
            Place(joint, Double3.Of(local));
            var moved = new Double3(positions[0], positions[1], positions[2]);
            Double3 back = NewRest(joint).Inverse.Point(moved);
            return back.IsFinite ? back.ToVector3() : local;
        }

        /// <summary>By how much small things at a point grow: the radius of a collider.</summary>
        public float Scale(Transform joint, Vector3 local)
        {
            Place(joint, Double3.Of(local));
            return double.IsNaN(scales[0]) || double.IsInfinity(scales[0]) ? 1 : (float)scales[0];
        }

        /// <summary>By how much a short way in one direction grows: a capsule's height.</summary>
        /// <param name="direction">In the joint's space, of any length but 0.</param>
        public float Stretch(Transform joint, Vector3 local, Vector3 direction)
        {
            Place(joint, Double3.Of(local));
            double stretch = Stretched(Direction(joint, direction)).Length;
            return stretch > 0 && !double.IsInfinity(stretch) ? (float)stretch : 1;
        }

        /// <summary>By how much short ways across a direction grow, in the mean: a capsule's radius.</summary>
        public float Across(Transform joint, Vector3 local, Vector3 direction)
        {
            Place(joint, Double3.Of(local));
            Double3 axis = Direction(joint, direction);
            // How volume grows over how the axis does: the area of a section across where the axis comes to lie.
            double volume = Stretched(new Double3(1, 0, 0)).Dot(Stretched(new Double3(0, 1, 0)).Cross(Stretched(new Double3(0, 0, 1))));
            double area = Math.Abs(volume) / Stretched(axis).Length;
            return area > 0 && !double.IsInfinity(area) ? (float)Math.Sqrt(area) : 1;
        }

        /// <summary>
        /// What becomes of a collider of springs: as thick as the mesh around it, a capsule across its axis, and up to a fifth
        /// thinner where a spring would newly start inside of it.
        /// </summary>
        /// <param name="joint">The transform that it moves with, and in whose space it is given and comes back.</param>
        /// <param name="named">The component that springs name it by; null: none does.</param>
        public LocalCollider Collider(Transform joint, LocalCollider collider, Component named)
        {
            int index = IndexOf(joint);
            if (index >= 0) return Colliders.Of(joint, (uint)index, collider, named);
            bool plane = collider.Kind == ColliderKind.Plane;
            return new LocalCollider
            {
                Kind = collider.Kind,
                Start = Point(joint, collider.Start),
                End = plane ? Normal(joint, collider.Start, collider.End) : Point(joint, collider.End),
                Radius = collider.Radius * Scale(joint, collider.Start)
            };
        }

        internal readonly ColliderMap Colliders;

        /// <summary>Where a point of the head goes, such as the point between the eyes; both in the root's space.</summary>
        public Vector3 HeadPoint(Vector3 point)
        {
            int head = source.Roles[(int)HumanBodyBones.Head];
            Transform joint = head < 0 ? source.Root.transform : source.Joints[head];
            Place(joint, OldRest(joint).Inverse.Point(Double3.Of(point)));
            return new Double3(positions[0], positions[1], positions[2]).ToVector3();
        }

        /// <summary>How far a transform moves in its parent's space.</summary>
        public Vector3 Shift(Transform joint)
        {
            int index = source.IndexOf(Source(joint));
            return index < 0 ? Vector3.zero : result.LocalShifts[index];
        }

        /// <summary>
        /// True where the source itself becomes the new avatar, as in a build: it is still the same one to servers.
        /// </summary>
        public bool SameAvatar { get; internal set; }

        /// <summary>A direction of a joint's space in the root's space, of length 1.</summary>
        Double3 Direction(Transform joint, Vector3 direction) => OldRest(joint).Direction(Double3.Of(direction)).Normalized;

        Double3 Stretched(Double3 unit)
        {
            return new Double3(
                jacobian[0] * unit.X + jacobian[3] * unit.Y + jacobian[6] * unit.Z,
                jacobian[1] * unit.X + jacobian[4] * unit.Y + jacobian[7] * unit.Z,
                jacobian[2] * unit.X + jacobian[5] * unit.Y + jacobian[8] * unit.Z);
        }

        /// <summary>The new normal of a small plane, in the moved joint's space; it keeps its length.</summary>
        public Vector3 Normal(Transform joint, Vector3 local, Vector3 normal)
        {
            Place(joint, Double3.Of(local));
            var stretch = new Affine
            {
                M00 = jacobian[0], M10 = jacobian[1], M20 = jacobian[2],
                M01 = jacobian[3], M11 = jacobian[4], M21 = jacobian[5],
                M02 = jacobian[6], M12 = jacobian[7], M22 = jacobian[8]
            };
            Affine axes = OldRest(joint);
            Double3 old = Double3.Of(normal);
            Double3 model = axes.Inverse.LinearTransposed.Direction(old);
            Double3 turned = axes.LinearTransposed.Direction(stretch.Inverse.LinearTransposed.Direction(model)).Normalized * old.Length;
            return turned.IsFinite && turned.Length > 0 ? turned.ToVector3() : normal;
        }

        /// <summary>
        /// The mesh that stands for the one that a renderer of the source or the new avatar showed; null where there is none.
        /// </summary>
        public Mesh MeshOf(Mesh old)
        {
            foreach (KeyValuePair<Renderer, Mesh> made in newMeshes)
            {
                if (RendererReader.MeshOf(made.Key) == old) return made.Value;
            }
            return null;
        }

        /// <summary>
        /// Keeps an asset that an adapter has made beside the new meshes, and destroys it where the conversion fails.
        /// </summary>
        public void AddAsset(UnityEngine.Object asset)
        {
            if (asset == null) throw new ArgumentNullException("asset");
            if (!assets.Contains(asset)) assets.Add(asset);
        }

        internal List<UnityEngine.Object> Assets => assets;

        /// <summary>What was replaced, and what it was replaced with: each new one once, however many renderers show it.</summary>
        internal readonly List<KeyValuePair<UnityEngine.Object, UnityEngine.Object>> Replaced = new List<KeyValuePair<UnityEngine.Object, UnityEngine.Object>>();

        /// <summary>Keeps an asset that stands for an old one.</summary>
        internal void Replace(UnityEngine.Object old, UnityEngine.Object made)
        {
            AddAsset(made);
            if (!Replaced.Exists(pair => pair.Value == made)) Replaced.Add(new KeyValuePair<UnityEngine.Object, UnityEngine.Object>(old, made));
        }

        internal void Remember(Renderer original, Mesh made)
        {
            newMeshes[original] = made;
            Replace(RendererReader.MeshOf(original), made);
        }

        /// <summary>The mesh that was made for a renderer of the source.</summary>
        internal Mesh MeshFor(Renderer original) => newMeshes[original];

        internal Transform CopyOf(Transform original) => copyOf[original];

        /// <summary>The library's joint that a transform is; -1 for what keeps its place on the ground.</summary>
        internal int IndexOf(Transform joint)
        {
            int index = source.Rigged ? source.IndexOf(Source(joint)) : -1;
            return index == 0 && source.HoldsRoot || IsOfPet(index) ? -1 : index;
        }

        bool IsOfPet(int index) => index >= 0 && source.PetOf[index] >= 0;

        internal Affine OldRest(Transform joint)
        {
            int index = source.IndexOf(Source(joint));
            return index < 0 ? Affine.Identity : source.Rest[index];
        }

        internal Affine NewRest(Transform joint)
        {
            int index = source.IndexOf(Source(joint));
            return index < 0 ? Affine.Identity : result.Rest[index];
        }

        /// <summary>Fills positions, scales and jacobian, in the root's space.</summary>
        void Place(Transform joint, Double3 local)
        {
            Double3 model = OldRest(joint).Point(local);
            int index = IndexOf(joint);
            if (source.Rigged && IsOfPet(source.IndexOf(Source(joint))))
            {
                // It grows by its transform, and in its own space nothing changes.
                Double3 place = NewRest(joint).Point(local);
                positions[0] = place.X;
                positions[1] = place.Y;
                positions[2] = place.Z;
                scales[0] = 1;
                Array.Clear(jacobian, 0, 9);
                jacobian[0] = jacobian[4] = jacobian[8] = 1;
                return;
            }
            if (index < 0)
            {
                bool outside = Source(joint) == null;
                double ratio = outside ? 1 : result.HeightRatio, oldLow = outside ? 0 : result.OldLow, newLow = outside ? 0 : result.NewLow;
                positions[0] = model.X * ratio;
                positions[1] = newLow + (model.Y - oldLow) * ratio;
                positions[2] = model.Z * ratio;
                scales[0] = ratio;
                Array.Clear(jacobian, 0, 9);
                jacobian[0] = jacobian[4] = jacobian[8] = ratio;
                return;
            }
            joints[0] = (uint)index;
            points[0] = model.X;
            points[1] = model.Y;
            points[2] = model.Z;
            deformer.MapPoints(joints, points, positions, scales, jacobian);
        }
    }
}
