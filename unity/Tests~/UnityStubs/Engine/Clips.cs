// Animation clips and what plays them.
using System;
using System.Collections.Generic;

namespace UnityEngine
{
    public class Motion : Object { }

    public sealed class AnimationClip : Motion
    {
        internal sealed class Curve
        {
            public string Path, Property;
            public Type Type;
            public AnimationCurve Keys;
        }
        internal List<Curve> m_Curves = new List<Curve>();
        bool m_Legacy, m_Human;
        public bool legacy { get { return m_Legacy; } set { m_Legacy = value; } }
        public bool humanMotion { get { return m_Human; } internal set { m_Human = value; } }
        public float length { get { float end = 0f; foreach (Curve curve in m_Curves) foreach (Keyframe key in curve.Keys.keys) end = Mathf.Max(end, key.time); return end; } }
        public void ClearCurves() { m_Curves.Clear(); }
    }

    public abstract class RuntimeAnimatorController : Object
    {
        public abstract AnimationClip[] animationClips { get; }
    }

    // The clips of another controller, some of them others.
    public class AnimatorOverrideController : RuntimeAnimatorController
    {
        RuntimeAnimatorController m_Controller;
        List<AnimationClip> m_Originals = new List<AnimationClip>(), m_Overrides = new List<AnimationClip>();
        public AnimatorOverrideController() { }
        public AnimatorOverrideController(RuntimeAnimatorController controller) { runtimeAnimatorController = controller; }
        public RuntimeAnimatorController runtimeAnimatorController
        {
            get { return m_Controller; }
            set
            {
                m_Controller = value;
                m_Originals.Clear(); m_Overrides.Clear();
                if (value == null) return;
                foreach (AnimationClip clip in value.animationClips) if (!m_Originals.Contains(clip)) { m_Originals.Add(clip); m_Overrides.Add(null); }
            }
        }
        public int overridesCount { get { return m_Originals.Count; } }
        public void GetOverrides(List<KeyValuePair<AnimationClip, AnimationClip>> overrides)
        {
            if (overrides == null) throw new ArgumentNullException("overrides");
            overrides.Clear();
            for (int at = 0; at < m_Originals.Count; at++) overrides.Add(new KeyValuePair<AnimationClip, AnimationClip>(m_Originals[at], m_Overrides[at]));
        }
        public void ApplyOverrides(IList<KeyValuePair<AnimationClip, AnimationClip>> overrides)
        {
            if (overrides == null) throw new ArgumentNullException("overrides");
            foreach (KeyValuePair<AnimationClip, AnimationClip> pair in overrides)
            {
                int at = m_Originals.IndexOf(pair.Key);
                if (at >= 0) m_Overrides[at] = pair.Value;
            }
        }
        public override AnimationClip[] animationClips
        {
            get
            {
                AnimationClip[] clips = m_Originals.ToArray();
                for (int at = 0; at < clips.Length; at++) if (m_Overrides[at] != null) clips[at] = m_Overrides[at];
                return clips;
            }
        }
    }
}
