using System;
using System.Collections.Generic;

namespace SuperDeform.Editor
{
    /// <summary>Bones and bind poses of one renderer.</summary>
    public sealed class Skin
    {
        /// <summary>A joint a bone; -1 where the renderer names no transform.</summary>
        public int[] Joints;

        /// <summary>Mesh space to joint space, a bone.</summary>
        public Affine[] InverseBinds;

        /// <summary>A box around the vertices in mesh space.</summary>
        public Box Bounds;

        /// <summary>Where the renderer stands, as the transforms are.</summary>
        public Affine MeshToModel;

        /// <summary>Mesh space to model space at rest.</summary>
        public Affine Common;

        /// <summary>Joint at rest times bind pose, a bone; all are Common where Uniform.</summary>
        public Affine[] ByBone;

        /// <summary>True where the bones agree.</summary>
        public bool Uniform;
    }

    /// <summary>
    /// The rest pose, read from the bind poses: the pose that the transforms stand in may be another one.
    ///
    /// A vertex v of a skinned mesh stands at the sum of w J B v. At rest the product J B is the same matrix M for all bones
    /// of a skin, "mesh to model", and J = M times the inverse of B.
    /// </summary>
    public sealed class RestPose
    {
        /// <summary>
        /// Two matrices agree where they take a skin's box to the same place, within this share of its size.
        /// </summary>
        const double Agreement = 1e-3;

        /// <summary>Below this share of the size a difference is rounding in 32-bit numbers.</summary>
        const double Rounding = 1e-6;

        /// <summary>
        /// How many bones of a skin are asked for the common matrix; all are asked whether they agree with it.
        /// </summary>
        const int LargestElection = 64;

        /// <summary>Joint space to model space, a joint.</summary>
        public Affine[] Rest;

        /// <summary>True where the transforms stand in another pose.</summary>
        public bool Differs;

        readonly int[] parents;
        readonly Affine[] world;

        RestPose(int[] parents, Affine[] world)
        {
            this.parents = parents;
            this.world = world;
        }

        /// <summary>The pose in which meshes and joints fit together, as the bind poses of all skins tell it.</summary>
        /// <param name="parents">By joint, every parent before its children; -1: none.</param>
        /// <param name="local">By joint: its transform to its parent's space, as it stands.</param>
        /// <param name="world">By joint: its transform to model space, as it stands.</param>
        /// <param name="skins">Common, ByBone and Uniform are filled in.</param>
        public static RestPose OfBindPoses(int[] parents, Affine[] local, Affine[] world, IList<Skin> skins)
        {
            var pose = new RestPose(parents, world);
            Affine?[] ofJoint = new Affine?[parents.Length];
            foreach (Skin skin in skins)
            {
                pose.Place(skin, ofJoint);
            }
            pose.Rest = new Affine[parents.Length];
            for (int joint = 0; joint < parents.Length; joint++)
            {
                if (ofJoint[joint].HasValue) pose.Rest[joint] = ofJoint[joint].Value;
                else if (parents[joint] < 0) pose.Rest[joint] = world[joint];
                else pose.Rest[joint] = pose.Rest[parents[joint]] * local[joint];
            }
            pose.PlaceBones(skins);
            return pose;
        }

        /// <summary>The pose that the transforms stand in as the rest pose. Skins: as in OfBindPoses.</summary>
        public static RestPose Standing(int[] parents, Affine[] world, IList<Skin> skins)
        {
            var pose = new RestPose(parents, world);
            pose.Rest = world;
            foreach (Skin skin in skins)
            {
                skin.Common = Elect(pose.Posed(skin, Usable(skin)), Corners(skin)).Winner;
            }
            pose.PlaceBones(skins);
            return pose;
        }

        /// <summary>
        /// Finds where the skin's mesh is at rest, and so the joints that no skin before has placed.
        /// </summary>
        void Place(Skin skin, Affine?[] ofJoint)
        {
            Double3[] corners = Corners(skin);
            List<int> usable = Usable(skin);
            List<Affine> posed = Posed(skin, usable);
            // Joints that an earlier skin has placed bring this skin's mesh to where that one's is.
            var placed = new List<Affine>();
            foreach (int bone in usable)
            {
                Affine? rest = ofJoint[skin.Joints[bone]];
                if (rest.HasValue) placed.Add(rest.Value * skin.InverseBinds[bone]);
            }
            Affine common;
            if (placed.Count > 0)
            {
                common = Elect(placed, corners).Winner;
            }
            else
            {
                Election election = Elect(posed, corners);
                common = election.Share > 0.5 ? election.Winner : Conventional(skin, usable, posed, corners);
            }
            // So that vertices keep their bits.
            if (Agree(common, Affine.Identity, corners, Rounding)) common = Affine.Identity;
            foreach (Affine matrix in posed)
            {
                if (!Agree(matrix, common, corners, Agreement)) Differs = true;
            }
            foreach (int bone in usable)
            {
                int joint = skin.Joints[bone];
                if (!ofJoint[joint].HasValue) ofJoint[joint] = common * skin.InverseBinds[bone].Inverse;
            }
            skin.Common = common;
        }

        void PlaceBones(IList<Skin> skins)
        {
            foreach (Skin skin in skins)
            {
                Double3[] corners = Corners(skin);
                skin.ByBone = new Affine[skin.Joints.Length];
                skin.Uniform = true;
                for (int bone = 0; bone < skin.Joints.Length; bone++)
                {
                    int joint = skin.Joints[bone];
                    skin.ByBone[bone] = joint < 0 ? skin.Common : Rest[joint] * skin.InverseBinds[bone];
                    skin.Uniform &= Agree(skin.ByBone[bone], skin.Common, corners, Rounding);
                }
                for (int bone = 0; skin.Uniform && bone < skin.Joints.Length; bone++)
                {
                    skin.ByBone[bone] = skin.Common;
                }
            }
        }

        static List<int> Usable(Skin skin)
        {
            var usable = new List<int>();
            for (int bone = 0; bone < skin.Joints.Length; bone++)
            {
                if (skin.Joints[bone] >= 0 && skin.InverseBinds[bone].IsInvertible) usable.Add(bone);
            }
            return usable;
        }

        List<Affine> Posed(Skin skin, List<int> usable) => usable.ConvertAll(bone => world[skin.Joints[bone]] * skin.InverseBinds[bone]);

        /// <summary>The corners of the box around the skin's vertices and its joints at rest, in mesh space.</summary>
        static Double3[] Corners(Skin skin)
        {
            Box box = skin.Bounds;
            foreach (Affine bind in skin.InverseBinds)
            {
                if (bind.IsInvertible) box.Add(bind.Inverse.Position);
            }
            if (box.IsEmpty) box.Add(new Double3(0, 0, 0));
            if (box.Size.Length == 0) box.Add(box.Low + new Double3(1, 1, 1));
            Double3[] corners = new Double3[8];
            for (int corner = 0; corner < 8; corner++)
            {
                corners[corner] = new Double3(
                    (corner & 1) == 0 ? box.Low.X : box.High.X,
                    (corner & 2) == 0 ? box.Low.Y : box.High.Y,
                    (corner & 4) == 0 ? box.Low.Z : box.High.Z);
            }
            return corners;
        }

        static bool Agree(Affine one, Affine other, Double3[] corners, double tolerance)
        {
            double size = other.Direction(corners[7] - corners[0]).Length;
            foreach (Double3 corner in corners)
            {
                if (!((one.Point(corner) - other.Point(corner)).Length <= tolerance * size)) return false;
            }
            return true;
        }

        struct Election
        {
            public Affine Winner;
            public double Share;
        }

        /// <summary>
        /// The matrix that most agree with, number by number the median of those, and the share that agree.
        /// </summary>
        static Election Elect(List<Affine> matrices, Double3[] corners)
        {
            if (matrices.Count == 0) return new Election { Winner = Affine.Identity };
            int step = Math.Max(1, (matrices.Count + LargestElection - 1) / LargestElection);
            var best = new List<Affine>();
            Affine winner = matrices[0];
            for (int candidate = 0; candidate < matrices.Count; candidate += step)
            {
                Affine chosen = matrices[candidate];
                List<Affine> voters = matrices.FindAll(matrix => Agree(matrix, chosen, corners, Agreement));
                if (voters.Count <= best.Count) continue;
                best = voters;
                winner = chosen;
            }
            double[] values = new double[best.Count];
            for (int entry = 0; best.Count > 0 && entry < 12; entry++)
            {
                for (int voter = 0; voter < values.Length; voter++)
                {
                    values[voter] = best[voter][entry];
                }
                Array.Sort(values);
                winner[entry] = values[values.Length / 2];
            }
            return new Election { Winner = winner, Share = best.Count / (double)matrices.Count };
        }

        /// <summary>
        /// Where the transforms are posed: what takes the mesh to model space by the conventions of exporters, the one that
        /// most bones agree with, or else the first that lets the figure stand as the posed one does.
        /// </summary>
        Affine Conventional(Skin skin, List<int> usable, List<Affine> posed, Double3[] corners)
        {
            var ofSkin = new HashSet<int>(skin.Joints);
            var candidates = new List<Affine> { skin.MeshToModel, Affine.Identity };
            for (int index = 0; index < usable.Count && candidates.Count < 10; index++)
            {
                int parent = parents[skin.Joints[usable[index]]];
                if (parent < 0 || !ofSkin.Contains(parent)) candidates.Add(posed[index]);
            }
            Affine best = Affine.Identity;
            double most = 0;
            foreach (Affine candidate in candidates)
            {
                Affine chosen = candidate;
                double share = posed.FindAll(matrix => Agree(matrix, chosen, corners, Agreement)).Count / (double)Math.Max(1, posed.Count);
                if (share < 0.25 || share < most) continue;
                most = share;
                best = candidate;
            }
            if (most > 0) return best;
            List<Double3> bindPlaces = usable.ConvertAll(bone => skin.InverseBinds[bone].Inverse.Position);
            List<Double3> places = usable.ConvertAll(bone => world[skin.Joints[bone]].Position);
            double mostAlike = double.NegativeInfinity;
            foreach (Affine candidate in candidates)
            {
                Affine chosen = candidate;
                double likeness = Likeness(bindPlaces.ConvertAll(place => chosen.Point(place)), places);
                if (likeness >= 0.6) return candidate;
                if (likeness < mostAlike) continue;
                mostAlike = likeness;
                best = candidate;
            }
            return best;
        }

        /// <summary>
        /// 1 where two sets of points are the same but for where they are, 0 where one has nothing of the other; less where
        /// one is more than three times as large.
        /// </summary>
        static double Likeness(List<Double3> places, List<Double3> others)
        {
            Double3 middle = Mean(places), otherMiddle = Mean(others);
            double product = 0, square = 0, otherSquare = 0;
            for (int index = 0; index < places.Count; index++)
            {
                Double3 place = places[index] - middle, other = others[index] - otherMiddle;
                product += place.Dot(other);
                square += place.Dot(place);
                otherSquare += other.Dot(other);
            }
            if (square <= 0 || otherSquare <= 0) return 0;
            double ratio = Math.Sqrt(square / otherSquare);
            double oversize = Math.Max(1, Math.Max(ratio, 1 / ratio) / 3);
            return product / Math.Sqrt(square * otherSquare) / oversize;
        }

        static Double3 Mean(List<Double3> points)
        {
            var sum = new Double3(0, 0, 0);
            foreach (Double3 point in points)
            {
                sum += point;
            }
            return sum * (1.0 / Math.Max(1, points.Count));
        }
    }
}
