using System;
using System.Collections.Generic;
using UnityEditor;
using UnityEngine;

namespace SuperDeform.Editor
{
    /// <summary>
    /// Rewrites what animation clips say in lengths: the places of transforms, and numbers of components that change with the body.
    /// </summary>
    /// <remarks>
    /// How far a key lies from the rest is scaled, and the rest is the new one: by the legs' length for the hips, for what does not
    /// hang from them, such as a root that travels, and for legs; by the body around it for what moves within the body, such as a jaw.
    /// So does the command line, which turns hips, knees and ankles besides where soles would leave the floor: in Unity that is the
    /// work of foot IK.
    /// </remarks>
    internal sealed class ClipMap
    {
        // Legs shorter, or hips lower, than this share of the height tell nothing of a step's length.
        const double Least = 1e-3;

        static readonly HumanBodyBones[][] Legs =
        {
            new[] { HumanBodyBones.LeftUpperLeg, HumanBodyBones.LeftLowerLeg, HumanBodyBones.LeftFoot },
            new[] { HumanBodyBones.RightUpperLeg, HumanBodyBones.RightLowerLeg, HumanBodyBones.RightFoot }
        };

        readonly AvatarData source;
        readonly AvatarResult result;
        readonly PointMap map;
        readonly int[] roles;

        // What carries hips and legs; -1: nothing is known to.
        readonly int hips;
        readonly bool[] ofLeg;
        readonly double stride;

        /// <summary>By component of the copy and name of a number: what it was.</summary>
        readonly Dictionary<KeyValuePair<Component, string>, float> before = new Dictionary<KeyValuePair<Component, string>, float>();

        internal ClipMap(AvatarData source, AvatarResult result, PointMap map)
        {
            this.source = source;
            this.result = result;
            this.map = map;
            roles = Roles(source);
            ofLeg = new bool[source.Joints.Length];
            foreach (HumanBodyBones[] leg in Legs)
            {
                foreach (HumanBodyBones part in leg)
                {
                    for (int joint = roles[(int)part]; joint >= 0; joint = source.Parents[joint])
                    {
                        ofLeg[joint] = true;
                    }
                }
            }
            hips = roles[(int)HumanBodyBones.Hips];
            for (int joint = hips; joint >= 0; joint = source.Parents[joint])
            {
                if (!Array.TrueForAll(Legs, leg => roles[(int)leg[0]] < 0 || IsBelow(roles[(int)leg[0]], joint))) continue;
                hips = joint;
                break;
            }
            stride = Stride();
        }

        /// <summary>By HumanBodyBones: the joint that the library knows as that; -1: none.</summary>
        static int[] Roles(AvatarData source)
        {
            int[] roles = new int[HumanoidRoles.Count];
            HumanoidRole[] known = source.Rigged ? source.Character.GetJoints().Roles : new HumanoidRole[0];
            for (int role = 0; role < roles.Length; role++)
            {
                int joint = Array.IndexOf(known, (HumanoidRole)role);
                roles[role] = joint < source.Joints.Length ? joint : -1;
            }
            return roles;
        }

        /// <summary>New over old length of the legs; of the hips' height where there are no two whole legs, of the avatar's without hips.</summary>
        double Stride()
        {
            double old = LegLength(source.Rest), now = LegLength(result.Rest);
            if (!(old > 0) && hips >= 0)
            {
                old = source.Rest[hips].Position.Y - result.OldLow;
                now = result.Rest[hips].Position.Y - result.NewLow;
            }
            return old > Least * result.OldHeight && now > 0 ? now / old : result.HeightRatio;
        }

        double LegLength(Affine[] rest)
        {
            double length = 0;
            foreach (HumanBodyBones[] leg in Legs)
            {
                int[] joints = Array.ConvertAll(leg, part => roles[(int)part]);
                if (Array.IndexOf(joints, -1) >= 0) return 0;
                length += (rest[joints[0]].Position - rest[joints[1]].Position).Length + (rest[joints[1]].Position - rest[joints[2]].Position).Length;
            }
            return length / Legs.Length;
        }

        bool IsBelow(int joint, int above)
        {
            for (; joint >= 0; joint = source.MergedParents[joint])
            {
                if (joint == above) return true;
            }
            return false;
        }

        /// <summary>Remembers the numbers of components that clips set, before they change.</summary>
        internal void Remember(IEnumerable<IMovableClip> clips)
        {
            foreach (IMovableClip clip in clips)
            {
                foreach (EditorCurveBinding curve in clip.Curves)
                {
                    Component component = ComponentOf(clip, curve);
                    if (component == null) continue;
                    using (var serialized = new SerializedObject(component))
                    {
                        SerializedProperty number = NumberOf(serialized, curve);
                        if (number != null) before[new KeyValuePair<Component, string>(component, curve.propertyName)] = number.floatValue;
                    }
                }
            }
        }

        static SerializedProperty NumberOf(SerializedObject serialized, EditorCurveBinding curve)
        {
            SerializedProperty number = serialized.FindProperty(curve.propertyName);
            return number != null && number.propertyType == SerializedPropertyType.Float ? number : null;
        }

        static Component ComponentOf(IMovableClip clip, EditorCurveBinding curve)
        {
            if (curve.type == null || curve.type == typeof(Transform) || !typeof(Component).IsAssignableFrom(curve.type)) return null;
            Transform place = clip.Find(curve.path);
            return place == null ? null : place.GetComponent(curve.type);
        }

        /// <summary>Writes what changes of a clip.</summary>
        /// <returns>How many of its curves.</returns>
        internal int Write(IMovableClip clip)
        {
            int written = 0;
            foreach (EditorCurveBinding curve in new List<EditorCurveBinding>(clip.Curves))
            {
                if (!Change(clip, curve, out double factor, out double shift)) continue;
                AnimationCurve keys = clip.Get(curve);
                if (keys == null) continue;
                clip.Set(curve, Changed(keys, (float)factor, (float)shift));
                written++;
            }
            return written;
        }

        /// <summary>Whether a clip holds what Write changes.</summary>
        internal bool Concerns(IMovableClip clip)
        {
            foreach (EditorCurveBinding curve in clip.Curves)
            {
                if (Change(clip, curve, out double factor, out double shift)) return true;
            }
            return false;
        }

        /// <summary>What the numbers of a curve are multiplied by, and what is added then; false where they stay.</summary>
        bool Change(IMovableClip clip, EditorCurveBinding curve, out double factor, out double shift)
        {
            factor = 1;
            shift = 0;
            if (!source.Rigged) return false;
            int axis = curve.propertyName.Length > 2 && curve.propertyName[curve.propertyName.Length - 2] == '.' ? "xyz".IndexOf(curve.propertyName[curve.propertyName.Length - 1]) : -1;
            bool place = curve.type == typeof(Transform) && axis >= 0 && curve.propertyName.StartsWith("m_LocalPosition.", StringComparison.Ordinal);
            if (place) OfPlace(clip.Find(curve.path), axis, ref factor, ref shift);
            else OfNumber(clip, curve, axis >= 0, ref factor, ref shift);
            return factor != 1 || shift != 0;
        }

        void OfPlace(Transform transform, int axis, ref double factor, ref double shift)
        {
            if (transform == null) return;
            int joint = source.IndexOf(map.Source(transform));
            if (joint < 0)
            {
                if (map.Source(transform) == source.Root.transform) factor = stride;
                return;
            }
            bool inPet = source.PetOf[joint] >= 0 && source.PetOf[joint] != joint;
            if (inPet) return;
            int body = source.Twins[joint];
            bool within = hips >= 0 && body != hips && IsBelow(body, hips) && !ofLeg[body];
            factor = within ? map.Scale(source.Joints[joint], new Vector3(0, 0, 0)) : stride;
            int parent = source.Parents[joint];
            Double3 rest = source.Rest[joint].Position;
            if (parent >= 0) rest = source.Rest[parent].Inverse.Point(rest);
            shift = result.LocalShifts[joint][axis] + rest.ToVector3()[axis] * (1 - factor);
        }

        void OfNumber(IMovableClip clip, EditorCurveBinding curve, bool ofPoint, ref double factor, ref double shift)
        {
            Component component = ComponentOf(clip, curve);
            if (component == null || !before.TryGetValue(new KeyValuePair<Component, string>(component, curve.propertyName), out float old)) return;
            using (var serialized = new SerializedObject(component))
            {
                float now = NumberOf(serialized, curve).floatValue;
                if (now == old) return;
                factor = !ofPoint && old != 0 ? now / (double)old : map.Scale(component.transform, new Vector3(0, 0, 0));
                shift = now - factor * old;
            }
        }

        static AnimationCurve Changed(AnimationCurve curve, float factor, float shift)
        {
            Keyframe[] keys = curve.keys;
            for (int key = 0; key < keys.Length; key++)
            {
                keys[key].value = keys[key].value * factor + shift;
                // Of a step they are infinite, and stay so.
                keys[key].inTangent *= factor;
                keys[key].outTangent *= factor;
            }
            return new AnimationCurve(keys) { preWrapMode = curve.preWrapMode, postWrapMode = curve.postWrapMode };
        }
    }
}
