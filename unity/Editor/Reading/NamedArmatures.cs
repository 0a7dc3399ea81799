using System;
using System.Collections.Generic;
using UnityEngine;

namespace SuperDeform.Editor
{
    /// <summary>Armatures beside the avatar's whose joints are called like joints that play roles: prefix + name + suffix.</summary>
    internal static class NamedArmatures
    {
        /// <summary>
        /// By armature, its joints and the avatar's that they are called like, where the order down both hierarchies is the same.
        /// </summary>
        /// <param name="roles">By HumanBodyBones: the avatar's joint, or -1.</param>
        /// <param name="asked">Which joints may be twins.</param>
        internal static List<List<KeyValuePair<int, int>>> Of(AvatarData data, int[] roles, Func<int, bool> asked)
        {
            var namesakes = new Dictionary<int, List<int>>();
            var votes = new Dictionary<string, int>();
            for (int joint = 0; joint < data.Joints.Length; joint++)
            {
                if (!asked(joint)) continue;
                List<int> found = Namesakes(data, roles, joint);
                if (found.Count > 0) namesakes.Add(joint, found);
                foreach (int role in found)
                {
                    string affix = Affix(data, joint, role);
                    votes.TryGetValue(affix, out int count);
                    votes[affix] = count + 1;
                }
            }
            return Grouped(data, namesakes, (joint, role) => votes[Affix(data, joint, role)]);
        }

        /// <summary>The joints with roles whose names are in a joint's.</summary>
        static List<int> Namesakes(AvatarData data, int[] roles, int joint)
        {
            var found = new List<int>();
            foreach (int role in roles)
            {
                bool named = role >= 0 && data.Joints[joint].name.IndexOf(data.Joints[role].name, StringComparison.Ordinal) >= 0;
                if (named && !found.Contains(role)) found.Add(role);
            }
            return found;
        }

        /// <summary>What a name has before and after the avatar's, with a sign between that no name has.</summary>
        static string Affix(AvatarData data, int joint, int role)
        {
            string name = data.Joints[joint].name, of = data.Joints[role].name;
            int at = name.IndexOf(of, StringComparison.Ordinal);
            return name.Substring(0, at) + "\n" + name.Substring(at + of.Length);
        }

        static List<List<KeyValuePair<int, int>>> Grouped(AvatarData data, Dictionary<int, List<int>> namesakes, Func<int, int, int> votes)
        {
            var armatures = new List<List<KeyValuePair<int, int>>>();
            var armatureOf = new Dictionary<int, List<KeyValuePair<int, int>>>();
            var chosen = new Dictionary<int, int>();
            // In the order of the hierarchy: parents come first.
            for (int joint = 0; joint < data.Joints.Length; joint++)
            {
                if (!namesakes.TryGetValue(joint, out List<int> found)) continue;
                // What most of all are called like; of a name within a name the longer one.
                int best = found[0];
                foreach (int role in found)
                {
                    int more = votes(joint, role) - votes(joint, best);
                    if (more > 0 || more == 0 && data.Joints[role].name.Length > data.Joints[best].name.Length) best = role;
                }
                int above = data.Parents[joint];
                while (above >= 0 && !chosen.ContainsKey(above))
                {
                    above = data.Parents[above];
                }
                bool same = above >= 0 && data.Joints[best].IsChildOf(data.Joints[chosen[above]]);
                List<KeyValuePair<int, int>> armature = same ? armatureOf[above] : new List<KeyValuePair<int, int>>();
                if (!same) armatures.Add(armature);
                armature.Add(new KeyValuePair<int, int>(joint, best));
                armatureOf[joint] = armature;
                chosen[joint] = best;
            }
            return armatures;
        }
    }
}
