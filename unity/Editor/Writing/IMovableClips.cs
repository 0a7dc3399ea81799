using System.Collections.Generic;
using UnityEditor;
using UnityEngine;

namespace SuperDeform.Editor
{
    /// <summary>An animation clip, of which something is written that may be: a copy, or a build's own.</summary>
    internal interface IMovableClip
    {
        string Name { get; }

        IEnumerable<EditorCurveBinding> Curves { get; }

        AnimationCurve Get(EditorCurveBinding binding);

        void Set(EditorCurveBinding binding, AnimationCurve curve);

        /// <summary>The avatar's transform that a path of the clip means; null where there is none.</summary>
        Transform Find(string path);
    }

    /// <summary>The clips that play on an avatar.</summary>
    internal interface IMovableClips
    {
        IList<IMovableClip> Clips { get; }

        /// <summary>Has the avatar play what was written.</summary>
        /// <param name="clips">What places of bones are rewritten by.</param>
        void Finish(PointMap map, ClipMap clips, List<Finding> findings);
    }
}
