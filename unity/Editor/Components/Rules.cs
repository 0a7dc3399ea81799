using System;
using UnityEditor;
using UnityEngine;

namespace SuperDeform.Editor
{
    /// <summary>How one serialized property of a component changes.</summary>
    internal delegate void Rule(PropertyScope scope);

    /// <summary>The ways in which properties change. In paths "[*]" stands for every element of a list.</summary>
    internal static class Rules
    {
        /// <summary>Points of the rules after it are in the space of the transform at the first of the paths where one is set.</summary>
        internal static Rule InSpaceOf(params string[] paths)
        {
            return scope =>
            {
                scope.Frame = scope.Component.transform;
                string set = Array.Find(paths, path => scope.TransformAt(path) != null);
                if (set != null) scope.Frame = scope.TransformAt(set);
            };
        }

        /// <summary>A rule for some values of an enumeration alone.</summary>
        internal static Rule When(string path, int[] values, Rule rule)
        {
            return scope =>
            {
                SerializedProperty property = scope.At(path);
                if (property == null) return;
                int value = property.propertyType == SerializedPropertyType.Boolean ? (property.boolValue ? 1 : 0) : property.intValue;
                if (Array.IndexOf(values, value) >= 0) rule(scope);
            };
        }

        /// <summary>A point goes where the surface around it goes.</summary>
        internal static Rule Point(string path)
        {
            return scope =>
            {
                foreach (string each in scope.Expand(path))
                {
                    if (scope.At(each) != null) scope.SetVector(each, scope.Map.Point(scope.Frame, scope.VectorAt(each, Vector3.zero)));
                }
            };
        }

        /// <summary>
        /// A length in no direction, or a vector of lengths: by the local scale at a point, the frame's origin by default.
        /// </summary>
        internal static Rule Length(string path, string at = null)
        {
            return scope =>
            {
                float scale = scope.Map.Scale(scope.Frame, scope.VectorAt(at, Vector3.zero));
                foreach (string each in scope.Expand(path))
                {
                    scope.Multiply(each, scale);
                }
            };
        }

        /// <summary>A length that belongs to a chain of joints: by the mean scale of the frame and all below it.</summary>
        internal static Rule ChainLength(string path) => scope => scope.Multiply(path, ChainScale(scope));

        static float ChainScale(PropertyScope scope)
        {
            double sum = 0;
            int count = 0;
            foreach (Transform joint in scope.Frame.GetComponentsInChildren<Transform>(true))
            {
                sum += scope.Map.Scale(joint, Vector3.zero);
                count++;
            }
            return (float)(sum / count);
        }

        /// <summary>An offset from the chain's last joint, in that joint's space.</summary>
        internal static Rule EndPoint(string path)
        {
            return scope =>
            {
                Vector3 end = scope.VectorAt(path, Vector3.zero);
                if (end.sqrMagnitude > 0) scope.SetVector(path, scope.Map.Point(Leaf(scope.Frame), end));
            };
        }

        /// <summary>An offset from the chain's last joint, in the component's own axes: its length alone changes.</summary>
        internal static Rule EndLength(string path) => scope => scope.Multiply(path, scope.Map.Scale(Leaf(scope.Frame), Vector3.zero));

        static Transform Leaf(Transform chain)
        {
            while (chain.childCount > 0)
            {
                chain = chain.GetChild(0);
            }
            return chain;
        }

        /// <summary>A box's sides: the distances between the middles of opposite faces.</summary>
        internal static Rule Sides(string path, string center)
        {
            return scope =>
            {
                foreach (string each in scope.Expand(path))
                {
                    if (scope.At(each) == null) continue;
                    scope.SetVector(each, SidesOf(scope, scope.VectorAt(Sibling(each, path, center), Vector3.zero), scope.VectorAt(each, Vector3.zero)));
                }
            };
        }

        static Vector3 SidesOf(PropertyScope scope, Vector3 center, Vector3 size)
        {
            return new Vector3(
                size.x * scope.Map.Stretch(scope.Frame, center, new Vector3(1, 0, 0)),
                size.y * scope.Map.Stretch(scope.Frame, center, new Vector3(0, 1, 0)),
                size.z * scope.Map.Stretch(scope.Frame, center, new Vector3(0, 0, 1)));
        }

        /// <summary>The path of the same element: "a[*].b" for "a[*].c" at "a.Array.data[2].c".</summary>
        static string Sibling(string expanded, string pattern, string other)
        {
            int star = pattern.IndexOf("[*]", StringComparison.Ordinal);
            if (star < 0) return other;
            int close = expanded.IndexOf(']', star);
            return expanded.Substring(0, close + 1) + other.Substring(star + 3);
        }

        /// <summary>The axis that an enumeration of X, Y, Z names.</summary>
        /// <param name="reversed">Where it says whether it is the negative axis; null: it is not.</param>
        internal static Func<PropertyScope, Vector3> Axis(string path, string reversed = null)
        {
            return scope =>
            {
                SerializedProperty property = scope.At(path);
                int axis = property == null ? 1 : property.intValue;
                float way = scope.IsOn(reversed) ? -1 : 1;
                return new Vector3(axis == 0 ? way : 0, axis == 1 ? way : 0, axis == 2 ? way : 0);
            };
        }

        /// <summary>A curve over time whose numbers are lengths: its factors change, its shape stays.</summary>
        internal static Rule Curve(string path)
        {
            return scope =>
            {
                float scale = scope.Map.Scale(scope.Frame, Vector3.zero);
                scope.Multiply(path + ".scalar", scale);
                scope.Multiply(path + ".minScalar", scale);
            };
        }

        /// <summary>The local position that a transform has at rest: it moves as the transform moves.</summary>
        internal static Rule RestPosition(string path, string transform = null)
        {
            return scope =>
            {
                Transform moved = transform == null ? null : scope.TransformAt(transform);
                if (scope.At(path) != null) scope.SetVector(path, scope.VectorAt(path, Vector3.zero) + scope.Map.Shift(moved ?? scope.Component.transform));
            };
        }

        /// <summary>Where the component's object lies, seen from each of the sources that it follows.</summary>
        internal static Rule OffsetFrom(string offset, string source)
        {
            return scope =>
            {
                Transform from = scope.TransformAt(source);
                if (from != null && scope.At(offset) != null) scope.SetVector(offset, scope.Map.Point(from, scope.VectorAt(offset, Vector3.zero)));
            };
        }

        /// <summary>The same for lists of offsets and of sources, element by element.</summary>
        internal static Rule OffsetsFrom(string offsets, string sources, string transform)
        {
            return scope =>
            {
                SerializedProperty list = scope.At(offsets);
                for (int index = 0; list != null && index < list.arraySize; index++)
                {
                    string element = ".Array.data[" + index + "]";
                    OffsetFrom(offsets + element, sources + element + "." + transform)(scope);
                }
            };
        }

        /// <summary>A point of the head in the root's axes and in the world's measure, such as an avatar's viewpoint.</summary>
        internal static Rule Viewpoint(string path)
        {
            return scope =>
            {
                if (scope.At(path) == null) return;
                // A copy does not hang where its source hangs.
                Transform copy = scope.Component.transform, source = scope.Map.Source(copy) ?? copy;
                Vector3 size = source.lossyScale, view = scope.VectorAt(path, Vector3.zero);
                Vector3 moved = scope.Map.HeadPoint(new Vector3(view.x / size.x, view.y / size.y, view.z / size.z));
                scope.SetVector(path, Vector3.Scale(moved, copy.lossyScale));
            };
        }

        /// <summary>What stands for the avatar on a server: a saved copy is another avatar, a build's is the same.</summary>
        internal static Rule Identity(string path)
        {
            return scope =>
            {
                SerializedProperty property = scope.At(path);
                if (property != null && !scope.Map.SameAvatar) property.stringValue = "";
            };
        }
    }
}
