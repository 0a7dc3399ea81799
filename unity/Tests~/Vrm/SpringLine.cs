using System;
using System.Collections.Generic;
using System.Globalization;
using System.IO;
using System.Linq;
using UnityEngine;

namespace SuperDeform.Editor.Tests
{
    /// <summary>One line of springs.py: a kind, a joint (or several), numbers.</summary>
    internal sealed class SpringLine
    {
        public string Kind, Joint, Shape;

        /// <summary>Of a spring of VRM 0.x: the joints of the groups of colliders that it keeps out of, or "-".</summary>
        public string Groups;
        public float[] Numbers;

        public static List<SpringLine> Read(string path)
        {
            return File.ReadAllLines(path).Select(text => Of(text.Split(' '))).ToList();
        }

        static SpringLine Of(string[] words)
        {
            var line = new SpringLine { Kind = words[0] };
            int at = 1;
            if (line.Kind != "look-at") line.Joint = words[at++];
            if (line.Kind == "collider") line.Shape = words[at++];
            if (line.Kind == "spring") line.Groups = words[at++];
            line.Numbers = words.Skip(at).Select(word => float.Parse(word, CultureInfo.InvariantCulture)).ToArray();
            return line;
        }

        public Vector3 Vector(int first)
        {
            return new Vector3(Numbers[first], Numbers[first + 1], Numbers[first + 2]);
        }

        /// <summary>The radius of a collider.</summary>
        public float Last { get { return Numbers[Numbers.Length - 1]; } }
    }
}
