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
    /// How far a key lies from the rest is scaled, and the rest is the new one: by the hips' height for the hips and for what does not
    /// hang from them, such as a root that travels; by the body around it for what moves within the body, such as a jaw.
    /// </remarks>
    internal sealed class ClipMap
    {
        // Hips lower than this share of the height tell nothing of a step's length.
        const double LeastHips = 1e-3;

        readonly AvatarData source;
        readonly AvatarResult result;
        readonly PointMap map;
        readonly int hips;
        readonly double hipRatio;

        /// <summary>By component of the copy and name of a number: what it was.</summary>
        readonly Dictionary<KeyValuePair<Component, string>, float> before = new Dictionary<KeyValuePair<Component, string>, float>();

        internal ClipMap(AvatarData source, AvatarResult result, PointMap map)
        {
            this.source = source;
            this.result = result;
            this.map = map;
            hips = source.Rigged ? Array.IndexOf(source.Character.GetJoints().Roles, HumanoidRole.Hips) : -1;
            hipRatio = hips < 0 || hips >= source.Joints.Length ? result.HeightRatio : HipRatio();
        }

        double HipRatio()
        {
            double old = source.Rest[hips].Position.Y - result.OldLow, now = result.Rest[hips].Position.Y - result.NewLow;
            return old > LeastHips * result.OldHeight && now > 0 ? now / old : result.HeightRatio;
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
                if (map.Source(transform) == source.Root.transform) factor = hipRatio;
                return;
            }
            bool inPet = source.PetOf[joint] >= 0 && source.PetOf[joint] != joint;
            if (inPet) return;
            factor = BelowHips(joint) ? map.Scale(source.Joints[joint], new Vector3(0, 0, 0)) : hipRatio;
            int parent = source.Parents[joint];
            Double3 rest = source.Rest[joint].Position;
            if (parent >= 0) rest = source.Rest[parent].Inverse.Point(rest);
            shift = result.LocalShifts[joint][axis] + rest.ToVector3()[axis] * (1 - factor);
        }

        bool BelowHips(int joint)
        {
            if (source.Twins[joint] == hips) return false;
            for (int above = source.MergedParents[joint]; above >= 0; above = source.MergedParents[above])
            {
                if (above == hips) return true;
            }
            return false;
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
