// Reading and writing of animation clips' curves, and controllers as assets.
using System;
using System.Collections.Generic;
using UnityEngine;
using Object = UnityEngine.Object;

namespace UnityEditor
{
    public struct EditorCurveBinding : IEquatable<EditorCurveBinding>
    {
        public string path, propertyName;
        Type m_Type;
        public Type type { get { return m_Type; } set { m_Type = value; } }
        public bool isPPtrCurve { get { return false; } }
        public static EditorCurveBinding FloatCurve(string inPath, Type inType, string inPropertyName) { return new EditorCurveBinding { path = inPath, m_Type = inType, propertyName = inPropertyName }; }
        public bool Equals(EditorCurveBinding other) { return path == other.path && m_Type == other.m_Type && propertyName == other.propertyName; }
        public override bool Equals(object other) { return other is EditorCurveBinding && Equals((EditorCurveBinding)other); }
        public override int GetHashCode() { return (path + ":" + propertyName).GetHashCode(); }
    }

    public class AnimationUtility
    {
        static AnimationClip.Curve Find(AnimationClip clip, EditorCurveBinding binding)
        {
            if (clip == null) throw new NullReferenceException("the clip is null");
            return clip.m_Curves.Find(delegate (AnimationClip.Curve curve) { return curve.Path == binding.path && curve.Type == binding.type && curve.Property == binding.propertyName; });
        }
        public static EditorCurveBinding[] GetCurveBindings(AnimationClip clip) { return clip.m_Curves.ConvertAll(delegate (AnimationClip.Curve curve) { return EditorCurveBinding.FloatCurve(curve.Path, curve.Type, curve.Property); }).ToArray(); }
        public static AnimationCurve GetEditorCurve(AnimationClip clip, EditorCurveBinding binding)
        {
            AnimationClip.Curve found = Find(clip, binding);
            return found == null ? null : new AnimationCurve((Keyframe[])found.Keys.keys.Clone());
        }
        // A clip within a model file is the importer's.
        public static void SetEditorCurve(AnimationClip clip, EditorCurveBinding binding, AnimationCurve curve)
        {
            AnimationClip.Curve found = Find(clip, binding);
            if (AssetDatabase.IsForeignAsset(clip)) throw new InvalidOperationException("the clip '" + clip.name + "' is read-only");
            if (found != null) clip.m_Curves.Remove(found);
            if (curve != null) clip.m_Curves.Add(new AnimationClip.Curve { Path = binding.path, Type = binding.type, Property = binding.propertyName, Keys = new AnimationCurve((Keyframe[])curve.keys.Clone()) });
            AssetDatabase.SetDirty(clip);
        }
    }
}

namespace UnityEditor.Animations
{
    public sealed class AnimatorState : Object { public Motion motion { get; set; } }

    public sealed class AnimatorController : RuntimeAnimatorController
    {
        List<AnimationClip> m_Clips = new List<AnimationClip>();
        public AnimatorState AddMotion(Motion motion) { m_Clips.Add((AnimationClip)motion); return new AnimatorState { motion = motion }; }
        public override AnimationClip[] animationClips { get { return m_Clips.ToArray(); } }
    }
}

namespace UnityEditor
{
    using System.Text;
    using UnityStubs;

    /// An object's values as text; references to other objects are numbers that hold while the editor runs.
    public static class EditorJsonUtility
    {
        static readonly Dictionary<string, object[]> s_Values = new Dictionary<string, object[]>();
        public static string ToJson(object obj) { return ToJson(obj, false); }
        public static string ToJson(object obj, bool prettyPrint)
        {
            if (obj == null) return "";
            Object of = (Object)obj;
            System.Reflection.FieldInfo[] fields = Fields.Of(of.GetType());
            byte[] bytes = Fingerprint.Bytes(new[] { of }, other => ReferenceEquals(other, of) ? null : "instanceID " + other.GetInstanceID());
            string text = "{\"" + of.GetInstanceID() + "\":\"" + Convert.ToBase64String(bytes) + "\"}";
            if (!s_Values.ContainsKey(text)) s_Values.Add(text, Array.ConvertAll(fields, field => Cloning.Copy(field.GetValue(of), null, null, new Dictionary<object, object>())));
            return text;
        }
        public static void FromJsonOverwrite(string json, object objectToOverwrite)
        {
            if (string.IsNullOrEmpty(json)) return;
            Object of = objectToOverwrite as Object;
            if (of == null) throw new ArgumentNullException("objectToOverwrite");
            object[] values = s_Values[json];
            System.Reflection.FieldInfo[] fields = Fields.Of(of.GetType());
            for (int at = 0; at < fields.Length; at++) fields[at].SetValue(of, Cloning.Copy(values[at], null, null, new Dictionary<object, object>()));
        }
    }
}
