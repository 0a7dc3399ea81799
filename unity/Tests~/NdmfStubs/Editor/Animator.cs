// NDMF's copies of an avatar's animation clips. See README.md for where each member was read.
using System;
using System.Collections.Generic;
using System.Linq;
using UnityEditor;
using UnityEngine;

namespace nadena.dev.ndmf.animator
{
    public abstract class VirtualNode
    {
        internal abstract IEnumerable<VirtualNode> Children { get; }
        public IEnumerable<VirtualNode> AllReachableNodes() { return new[] { this }.Concat(Children.SelectMany(child => child.AllReachableNodes())); }
    }

    public class VirtualAnimatorController : VirtualNode
    {
        internal readonly List<VirtualClip> Clips = new List<VirtualClip>();
        internal override IEnumerable<VirtualNode> Children { get { return Clips; } }
    }

    public class VirtualClip : VirtualNode
    {
        readonly AnimationClip m_Clip;
        readonly Dictionary<EditorCurveBinding, AnimationCurve> m_Changed = new Dictionary<EditorCurveBinding, AnimationCurve>();
        internal VirtualClip(AnimationClip clip, bool marker) { m_Clip = clip; IsMarkerClip = marker; Name = clip.name; }
        internal override IEnumerable<VirtualNode> Children { get { return new VirtualNode[0]; } }
        public string Name { get; set; }
        /// A clip of the platform's own, which stays as it is.
        public bool IsMarkerClip { get; private set; }
        public IEnumerable<EditorCurveBinding> GetFloatCurveBindings() { return AnimationUtility.GetCurveBindings(m_Clip); }
        public AnimationCurve GetFloatCurve(EditorCurveBinding binding) { AnimationCurve changed; return m_Changed.TryGetValue(binding, out changed) ? changed : AnimationUtility.GetEditorCurve(m_Clip, binding); }
        public void SetFloatCurve(EditorCurveBinding binding, AnimationCurve curve) { if (!IsMarkerClip) m_Changed[binding] = curve; }
        internal AnimationClip Commit()
        {
            if (IsMarkerClip || m_Changed.Count == 0) return m_Clip;
            AnimationClip made = UnityEngine.Object.Instantiate(m_Clip);
            made.name = m_Clip.name;
            foreach (var pair in m_Changed) AnimationUtility.SetEditorCurve(made, pair.Key, pair.Value);
            return made;
        }
    }

    /// The controllers of an avatar's animators, and, as its platform knows them, those of its descriptor.
    public sealed class VirtualControllerContext : IExtensionContext
    {
        readonly Dictionary<Animator, VirtualAnimatorController> m_Controllers = new Dictionary<Animator, VirtualAnimatorController>();
        public IEnumerable<VirtualAnimatorController> GetAllControllers() { return m_Controllers.Values; }
        public void OnActivate(BuildContext context)
        {
            foreach (Animator animator in context.AvatarRootObject.GetComponentsInChildren<Animator>(true))
            {
                if (animator.runtimeAnimatorController == null) continue;
                VirtualAnimatorController made = new VirtualAnimatorController();
                foreach (AnimationClip clip in animator.runtimeAnimatorController.animationClips) made.Clips.Add(new VirtualClip(clip, clip.name.StartsWith("proxy_")));
                m_Controllers.Add(animator, made);
            }
        }
        public void OnDeactivate(BuildContext context)
        {
            foreach (var pair in m_Controllers)
            {
                var controller = new UnityEditor.Animations.AnimatorController();
                foreach (VirtualClip clip in pair.Value.Clips) controller.AddMotion(clip.Commit());
                pair.Key.runtimeAnimatorController = controller;
            }
        }
    }

    /// Objects by the paths that they had when this was made, wherever they are now.
    public sealed class ObjectPathRemapper
    {
        readonly Dictionary<string, Transform> m_Objects = new Dictionary<string, Transform>();
        internal ObjectPathRemapper(Transform root) { Add(root, ""); }
        void Add(Transform at, string path)
        {
            if (!m_Objects.ContainsKey(path)) m_Objects.Add(path, at);
            foreach (Transform child in at) Add(child, path.Length == 0 ? child.name : path + "/" + child.name);
        }
        public GameObject GetObjectForPath(string path) { Transform found; return m_Objects.TryGetValue(path, out found) && found != null ? found.gameObject : null; }
    }

    [DependsOnContext(typeof(VirtualControllerContext))]
    public sealed class AnimatorServicesContext : IExtensionContext
    {
        public VirtualControllerContext ControllerContext { get; private set; }
        public ObjectPathRemapper ObjectPathRemapper { get; private set; }
        public void OnActivate(BuildContext context)
        {
            ControllerContext = context.Extension<VirtualControllerContext>();
            ObjectPathRemapper = new ObjectPathRemapper(context.AvatarRootTransform);
        }
        public void OnDeactivate(BuildContext context) { ControllerContext = null; ObjectPathRemapper = null; }
    }
}
