using System;
using System.Collections.Generic;
using UnityEngine;

namespace SuperDeform.Editor
{
    /// <summary>
    /// What becomes of an avatar, as arrays that are made once and written anew by each Apply: for a result as for a preview.
    /// </summary>
    public sealed class AvatarResult
    {
        public readonly AvatarData Source;

        public readonly List<RendererResult> Renderers = new List<RendererResult>();

        /// <summary>
        /// By joint of the source: joint space to the root's space, at rest. Joints move, and neither turn nor scale.
        /// </summary>
        public readonly Affine[] Rest;

        /// <summary>
        /// By joint of the source: the transform's local position, in the pose that the avatar stands in.
        /// </summary>
        public readonly Vector3[] LocalPositions;

        /// <summary>
        /// By joint of the source: what was added to LocalPositions; 0 where a transform stays as it is.
        /// </summary>
        public readonly Vector3[] LocalShifts;

        /// <summary>By joint of the library, those of a made rig among them: 3 numbers in the root's space.</summary>
        public double[] JointPositions { get; private set; }

        /// <summary>The lowest vertex before and after, and new over old height; not of what stays at rest.</summary>
        public double OldLow { get; private set; }
        public double NewLow { get; private set; }
        public double HeightRatio { get; private set; }
        internal double OldHeight { get; private set; }

        readonly MeshOutput[] outputs;
        readonly bool atRest;

        /// <param name="source">What is deformed.</param>
        /// <param name="atRest">Vertices stay at rest in the root's space, and nothing is done that only meshes of an avatar need.</param>
        public AvatarResult(AvatarData source, bool atRest)
        {
            Source = source;
            this.atRest = atRest;
            foreach (RendererData renderer in source.Renderers)
            {
                Renderers.Add(new RendererResult(renderer));
            }
            var ordered = new List<MeshOutput>();
            foreach (RendererResult renderer in Renderers)
            {
                ordered.AddRange(renderer.Parts.ConvertAll(part => part.Output));
            }
            outputs = ordered.ToArray();
            Rest = (Affine[])source.Rest.Clone();
            LocalPositions = Array.ConvertAll(source.Joints, joint => joint.localPosition);
            LocalShifts = new Vector3[source.Joints.Length];
            HeightRatio = 1;
        }

        /// <summary>Deforms the avatar into the arrays.</summary>
        /// <param name="deformer">Of the source's character.</param>
        public void Apply(Deformer deformer, ProgressHandler progress)
        {
            deformer.Apply(outputs, progress);
            Take(deformer);
        }

        /// <summary>What is done with what the library has written; what a slider costs here.</summary>
        internal void Take(Deformer deformer)
        {
            int joints = deformer.JointCount;
            if (JointPositions == null || JointPositions.Length != 3 * joints) JointPositions = new double[3 * joints];
            deformer.GetJoints(JointPositions, null);
            foreach (RendererResult renderer in Renderers)
            {
                renderer.Spread();
                if (Source.AsWorn) renderer.Wear();
            }
            MeasureHeight();
            MoveJoints();
            foreach (RendererResult renderer in Renderers)
            {
                if (renderer.Source.Rides) renderer.Ride(Source, Rest);
            }
            if (atRest) return;
            foreach (RendererResult renderer in Renderers)
            {
                if (renderer.Source.Rides) continue;
                int bounds = renderer.Source.BoundsJoint;
                if (bounds < 0) renderer.Measure(Affine.Identity, Affine.Identity);
                else renderer.Measure(Source.Rest[bounds], Rest[bounds]);
                renderer.WriteBindPoses(Source.Rest, Rest);
                renderer.ToMeshSpace(Source.Rest, Rest);
            }
        }

        void MoveJoints()
        {
            if (!Source.Rigged) return;
            for (int joint = 0; joint < Rest.Length; joint++)
            {
                bool fixedRoot = joint == 0 && Source.HoldsRoot;
                if (fixedRoot) continue;
                int pet = Source.PetOf[joint];
                // Parents come first, so that the holder is in its place.
                if (pet >= 0 && pet != joint) Rest[joint] = Rest[pet] * Source.Rest[pet].Inverse * Source.Rest[joint];
                else if (pet == joint) Rest[joint] = PetHolder(joint);
                else Rest[joint] = Source.Rest[joint].At(new Double3(JointPositions[3 * joint], JointPositions[3 * joint + 1], JointPositions[3 * joint + 2]));
            }
            for (int joint = 0; joint < Rest.Length; joint++)
            {
                bool inPet = Source.PetOf[joint] >= 0 && Source.PetOf[joint] != joint;
                Double3 shift = inPet ? new Double3(0, 0, 0) : Shift(joint);
                LocalShifts[joint] = shift.ToVector3();
                LocalPositions[joint] = (Double3.Of(Source.Joints[joint].localPosition) + shift).ToVector3();
            }
        }

        /// <summary>
        /// Where a pet's holder comes to rest, smaller as the avatar is: at the joint that carries it, or in its place on the ground.
        /// </summary>
        Affine PetHolder(int joint)
        {
            var scale = new Affine { M00 = HeightRatio, M11 = HeightRatio, M22 = HeightRatio };
            Double3 old = Source.Rest[joint].Position;
            bool carried = Source.MergedParents[joint] >= 0;
            Double3 place = carried
                ? new Double3(JointPositions[3 * joint], JointPositions[3 * joint + 1], JointPositions[3 * joint + 2])
                : new Double3(old.X * HeightRatio, NewLow + (old.Y - OldLow) * HeightRatio, old.Z * HeightRatio);
            return (scale * Source.Rest[joint]).At(place);
        }

        /// <summary>By how much a joint's transform grows: a pet's holder with the avatar, no other.</summary>
        internal float LocalScale(int joint) => Source.Rigged && Source.PetOf[joint] == joint ? (float)HeightRatio : 1;

        /// <summary>How far a joint moves in its parent's space; 0 where that cannot be told.</summary>
        Double3 Shift(int joint)
        {
            int parent = Source.Parents[joint];
            bool sameParent = parent < 0 || Rest[parent].Equals(Source.Rest[parent]);
            if (sameParent && Rest[joint].Equals(Source.Rest[joint])) return new Double3(0, 0, 0);
            Double3 before = Source.Rest[joint].Position, after = Rest[joint].Position;
            if (parent >= 0)
            {
                before = Source.Rest[parent].Inverse.Point(before);
                after = Rest[parent].Inverse.Point(after);
            }
            Double3 change = after - before;
            return change.IsFinite && change.Length > 1e-12 * before.Length ? change : new Double3(0, 0, 0);
        }

        void MeasureHeight()
        {
            double oldHigh = double.NegativeInfinity, newHigh = double.NegativeInfinity;
            OldLow = NewLow = double.PositiveInfinity;
            foreach (RendererResult renderer in Renderers)
            {
                for (int vertex = 0; vertex < renderer.Positions.Length && !renderer.Source.Rides; vertex++)
                {
                    double old = renderer.Source.ModelVertices[vertex].y, now = renderer.Positions[vertex].y;
                    OldLow = Math.Min(OldLow, old);
                    oldHigh = Math.Max(oldHigh, old);
                    NewLow = Math.Min(NewLow, now);
                    newHigh = Math.Max(newHigh, now);
                }
            }
            OldHeight = oldHigh - OldLow;
            double ratio = (newHigh - NewLow) / OldHeight;
            HeightRatio = ratio > 0 && !double.IsInfinity(ratio) ? ratio : 1;
        }
    }
}
