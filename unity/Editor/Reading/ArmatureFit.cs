using System;
using System.Collections.Generic;
using UnityEngine;

namespace SuperDeform.Editor
{
    /// <summary>Whether an armature is an outfit's: lies where the avatar's lies, in much the same pose, perhaps larger or smaller.</summary>
    internal sealed class ArmatureFit
    {
        /// <summary>Of fewer joints each must lie at its own place: they do not tell how large the whole is.</summary>
        const int LeastJoints = 3;

        /// <summary>
        /// "The same place" of a joint by itself, as a share of the way from hips to head: 3 cm on a grown-up, about what garments
        /// made for one body differ by.
        /// </summary>
        const double SamePlace = 0.05;

        /// <summary>By how much an outfit may be larger, or smaller, than the avatar: a pet or a doll is smaller than that.</summary>
        const double MostSize = 1.5;

        /// <summary>
        /// How far the middle of an outfit may lie from the avatar's, likewise a share: what is scaled by a third around the soles
        /// lies that far off, and whoever stands beside the avatar farther.
        /// </summary>
        const double Aside = 0.6;

        /// <summary>How far a joint may lie from where the size of the whole puts it: another body's arms may be longer.</summary>
        const double Posed = 0.15;

        readonly AvatarData data;
        readonly double length;

        internal ArmatureFit(AvatarData data, int[] roles)
        {
            this.data = data;
            length = (Place(roles[(int)HumanBodyBones.Head]) - Place(roles[(int)HumanBodyBones.Hips])).Length;
        }

        Double3 Place(int joint) => data.Rest[joint].Position;

        /// <param name="pairs">The armature's joints, and the avatar's that they would be twins of.</param>
        internal bool Lies(List<KeyValuePair<int, int>> pairs)
        {
            if (pairs.Count < LeastJoints) return pairs.TrueForAll(pair => (Place(pair.Key) - Place(pair.Value)).Length <= SamePlace * length);
            Double3 middle = Middle(pairs.ConvertAll(pair => Place(pair.Key))), own = Middle(pairs.ConvertAll(pair => Place(pair.Value)));
            double square = 0, ownSquare = 0;
            foreach (KeyValuePair<int, int> pair in pairs)
            {
                Double3 place = Place(pair.Key) - middle, of = Place(pair.Value) - own;
                square += place.Dot(place);
                ownSquare += of.Dot(of);
            }
            double size = Math.Sqrt(square / ownSquare);
            if (!(size <= MostSize && size >= 1 / MostSize) || (middle - own).Length > Aside * length) return false;
            int fitting = pairs.FindAll(pair => ((Place(pair.Key) - middle) * (1 / size) - (Place(pair.Value) - own)).Length <= Posed * length).Count;
            return 2 * fitting > pairs.Count;
        }

        static Double3 Middle(List<Double3> points)
        {
            var sum = new Double3(0, 0, 0);
            foreach (Double3 point in points)
            {
                sum += point;
            }
            return sum * (1.0 / points.Count);
        }
    }
}
