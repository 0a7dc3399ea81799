using System.Collections.Generic;
using nadena.dev.ndmf;
using nadena.dev.ndmf.animator;
using UnityEditor;
using UnityEngine;

namespace SuperDeform.Editor.Ndmf
{
    /// <summary>The clips of a build: NDMF's copies of all that the avatar's platform plays.</summary>
    internal sealed class BuildClips : IMovableClips
    {
        readonly List<BuildClip> clips = new List<BuildClip>();

        internal BuildClips(BuildContext context)
        {
            AnimatorServicesContext services = context.Extension<AnimatorServicesContext>();
            var known = new HashSet<VirtualNode>();
            foreach (VirtualAnimatorController controller in services.ControllerContext.GetAllControllers())
            {
                foreach (VirtualNode node in controller.AllReachableNodes())
                {
                    if (node is VirtualClip clip && !clip.IsMarkerClip && known.Add(node)) clips.Add(new BuildClip(clip, services.ObjectPathRemapper));
                }
            }
        }

        public IList<IMovableClip> Clips => clips.ConvertAll(clip => (IMovableClip)clip);

        public void Finish(PointMap map, ClipMap written, List<Finding> findings)
        {
        }

        /// <summary>Gives NDMF what was written, once nothing else can fail any more.</summary>
        internal void Commit()
        {
            clips.ForEach(clip => clip.Commit());
        }

        sealed class BuildClip : IMovableClip
        {
            readonly VirtualClip clip;
            readonly ObjectPathRemapper paths;
            readonly Dictionary<EditorCurveBinding, AnimationCurve> written = new Dictionary<EditorCurveBinding, AnimationCurve>();

            internal BuildClip(VirtualClip clip, ObjectPathRemapper paths)
            {
                this.clip = clip;
                this.paths = paths;
            }

            public string Name => clip.Name;

            public IEnumerable<EditorCurveBinding> Curves => clip.GetFloatCurveBindings();

            public AnimationCurve Get(EditorCurveBinding binding) => clip.GetFloatCurve(binding);

            public void Set(EditorCurveBinding binding, AnimationCurve curve)
            {
                written[binding] = curve;
            }

            public Transform Find(string path)
            {
                GameObject found = paths.GetObjectForPath(path);
                return found == null ? null : found.transform;
            }

            internal void Commit()
            {
                foreach (KeyValuePair<EditorCurveBinding, AnimationCurve> pair in written)
                {
                    clip.SetFloatCurve(pair.Key, pair.Value);
                }
            }
        }
    }
}
