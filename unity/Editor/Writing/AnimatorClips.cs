using System.Collections.Generic;
using UnityEditor;
using UnityEngine;

namespace SuperDeform.Editor
{
    /// <summary>
    /// The clips of an avatar's Animators. What is written goes into copies, which override controllers play in place of the clips that
    /// the controllers name; neither controllers nor clips of the project change.
    /// </summary>
    internal sealed class AnimatorClips : IMovableClips
    {
        readonly GameObject avatar;
        readonly List<CopiedClip> clips = new List<CopiedClip>();

        internal AnimatorClips(GameObject avatar)
        {
            this.avatar = avatar;
            foreach (Animator animator in avatar.GetComponentsInChildren<Animator>(true))
            {
                if (animator.runtimeAnimatorController != null) AddAll(animator, animator.runtimeAnimatorController.animationClips);
            }
        }

        void AddAll(Animator animator, AnimationClip[] given)
        {
            foreach (AnimationClip clip in given)
            {
                bool known = clip == null || clips.Exists(other => other.Original == clip && other.Player == animator);
                if (!known) clips.Add(new CopiedClip(clip, animator));
            }
        }

        public IList<IMovableClip> Clips => clips.ConvertAll(clip => (IMovableClip)clip);

        public void Finish(PointMap map, ClipMap written, List<Finding> findings)
        {
            foreach (Animator animator in avatar.GetComponentsInChildren<Animator>(true))
            {
                List<CopiedClip> own = clips.FindAll(clip => clip.Player == animator && clip.Copy != null);
                if (own.Count == 0) continue;
                own.ForEach(clip => map.AddAsset(clip.Copy));
                animator.runtimeAnimatorController = Override(animator.runtimeAnimatorController, own);
                map.AddAsset(animator.runtimeAnimatorController);
            }
            int count = clips.FindAll(clip => clip.Copy != null).Count;
            if (count > 0) findings.Add(new Finding("clips_moved", Severity.Info, null, count));
            ReportLeft(written, findings);
        }

        static AnimatorOverrideController Override(RuntimeAnimatorController given, List<CopiedClip> own)
        {
            AnimatorOverrideController old = given as AnimatorOverrideController;
            RuntimeAnimatorController plain = old == null ? given : old.runtimeAnimatorController;
            var made = new AnimatorOverrideController(plain) { name = given.name };
            var pairs = new List<KeyValuePair<AnimationClip, AnimationClip>>();
            (old != null ? old : made).GetOverrides(pairs);
            for (int pair = 0; pair < pairs.Count; pair++)
            {
                AnimationClip played = pairs[pair].Value != null ? pairs[pair].Value : pairs[pair].Key;
                CopiedClip copied = own.Find(clip => clip.Original == played);
                pairs[pair] = new KeyValuePair<AnimationClip, AnimationClip>(pairs[pair].Key, copied == null ? pairs[pair].Value : copied.Copy);
            }
            made.ApplyOverrides(pairs);
            return made;
        }

        /// <summary>Names the clips that other components play: only who wrote those knows how.</summary>
        void ReportLeft(ClipMap written, List<Finding> findings)
        {
            var said = new HashSet<AnimationClip>();
            foreach (Component component in avatar.GetComponentsInChildren<Component>(true))
            {
                if (component == null || component is Animator || component is Transform) continue;
                foreach (AnimationClip clip in PlayedBy(component))
                {
                    if (clip == null || !said.Add(clip) || !written.Concerns(new CopiedClip(clip, avatar.transform))) continue;
                    findings.Add(new Finding("clip_left", Severity.Warning, clip, clip.name, component.name, component.GetType().Name));
                }
            }
        }

        static IEnumerable<AnimationClip> PlayedBy(Component component)
        {
            var played = new List<AnimationClip>();
            using (var serialized = new SerializedObject(component))
            {
                PropertyWalk.Each(serialized, property => true, property =>
                {
                    if (property.propertyType != SerializedPropertyType.ObjectReference) return;
                    AnimationClip clip = property.objectReferenceValue as AnimationClip;
                    RuntimeAnimatorController controller = property.objectReferenceValue as RuntimeAnimatorController;
                    if (clip != null) played.Add(clip);
                    if (controller != null) played.AddRange(controller.animationClips);
                });
            }
            return played;
        }

        /// <summary>A clip of the project, and its copy once something of it is written.</summary>
        sealed class CopiedClip : IMovableClip
        {
            internal readonly AnimationClip Original;
            internal readonly Component Player;

            internal CopiedClip(AnimationClip original, Component player)
            {
                Original = original;
                Player = player;
            }

            internal AnimationClip Copy { get; private set; }

            public string Name => Original.name;

            public IEnumerable<EditorCurveBinding> Curves => AnimationUtility.GetCurveBindings(Original);

            public AnimationCurve Get(EditorCurveBinding binding) => AnimationUtility.GetEditorCurve(Original, binding);

            public void Set(EditorCurveBinding binding, AnimationCurve curve)
            {
                if (Copy == null)
                {
                    Copy = Object.Instantiate(Original);
                    Copy.name = Original.name;
                }
                AnimationUtility.SetEditorCurve(Copy, binding, curve);
            }

            public Transform Find(string path) => path.Length == 0 ? Player.transform : Player.transform.Find(path);
        }
    }
}
