using System;
using System.Collections.Generic;
using UnityEditor;
using UnityEngine;

namespace SuperDeform.Editor
{
    /// <summary>Shows what an avatar becomes, in the Scene view, while settings change. The avatar is never changed.</summary>
    /// <remarks>
    /// The avatar is read and measured once. A slider then costs what the library has to do again, a deformation into arrays
    /// that are kept, and handing those to the proxy's meshes. Blend shapes that are on take part as they were at the start. The
    /// proxy is never saved, and Dispose takes it away: on closing, before scripts reload, and before play mode.
    /// </remarks>
    public sealed class PreviewSession : IDisposable
    {
        readonly PreviewFigure figure;
        readonly List<ProxyRenderer> renderers = new List<ProxyRenderer>();
        readonly List<Renderer> hidden = new List<Renderer>();
        readonly int[] jointOf;
        ProxySkeleton skeleton;
        bool showBefore, beside;
        PreviewPose pose;
        Matrix4x4 placedAt;
        readonly List<float> worn = new List<float>();
        bool counted;
        float width;

        AvatarData Avatar => figure.Avatar;

        /// <summary>Comes with true when a preview begins to be shown, with false when it ends.</summary>
        public static event Action<bool> Shown;

        /// <summary>Reads the avatar and shows the result in its place.</summary>
        /// <param name="progress">Hears how far it is, which takes long where a rig is made; null for none.</param>
        /// <exception cref="ConversionException">It cannot be done, and why.</exception>
        public PreviewSession(GameObject avatar, ConversionSettings settings, IConversionProgress progress = null)
        {
            try
            {
                var reading = new ReadOptions
                {
                    AsWorn = true, RigAuto = settings.RigAuto, RigOptions = settings.Options,
                    RigProgress = Part(progress, ConversionStage.Rigging, 0, 0.7f)
                };
                figure = new PreviewFigure(avatar, settings, reading, true, Part(progress, ConversionStage.Deforming, 0.7f, 1));
                jointOf = JointsByRole(Avatar);
                Weights(worn);
                skeleton = new ProxySkeleton(Avatar);
                foreach (RendererResult renderer in figure.Result.Renderers)
                {
                    if (IsShown(renderer.Source)) renderers.Add(new ProxyRenderer(Avatar, renderer, skeleton));
                }
                Show();
                Place();
                ApplyVisibility();
                Selection.selectionChanged += SelectOriginal;
                counted = true;
                if (Shown != null) Shown(true);
            }
            catch (Exception cause)
            {
                Dispose();
                throw ConversionException.From(cause, avatar);
            }
        }

        static bool IsShown(RendererData data) => data.Parts.Count > 0 || data.Rides;

        /// <summary>The root of what is shown.</summary>
        public GameObject Proxy => skeleton == null || skeleton.Root == null ? null : skeleton.Root.gameObject;

        /// <summary>Whether the avatar and the proxy are still there.</summary>
        public bool IsAlive => Avatar.Root != null && Proxy != null;

        /// <summary>Whether this session is for an avatar and its rig.</summary>
        public bool Fits(GameObject candidate, ConversionSettings settings) =>
            IsAlive && candidate == Avatar.Root && settings.RigAuto == figure.Shown.RigAuto;

        /// <summary>Brings the proxy up to the settings; only what depends on the change is done again.</summary>
        /// <param name="moving">Whether a slider moves: clothes stay pushed as they were, which is faster, until Settle.</param>
        /// <exception cref="ConversionException">They cannot be; the proxy stays as it was.</exception>
        public void Update(ConversionSettings settings, bool moving = false)
        {
            if (figure.Update(settings, moving)) Show();
        }

        /// <summary>After updates with moving: pushes clothes out of the body as it is now.</summary>
        /// <exception cref="ConversionException">They cannot be; the proxy stays as it was.</exception>
        public void Settle()
        {
            if (figure.Settle()) Show();
        }

        void Show()
        {
            skeleton.Move(figure.Result);
            Stand();
            foreach (ProxyRenderer renderer in renderers)
            {
                renderer.Show(skeleton);
            }
        }

        /// <summary>Measures the result. Takes longer than a frame: for when settings rest.</summary>
        public PreviewNumbers Measure()
        {
            return new PreviewNumbers
            {
                Report = figure.Deformer.GetReport(), Groups = figure.Deformer.GetGroups(), Warnings = figure.Deformer.Warnings
            };
        }

        /// <summary>Shows the avatar as it is, in place of the result.</summary>
        public bool ShowBefore
        {
            get { return showBefore; }
            set
            {
                showBefore = value;
                ApplyVisibility();
            }
        }

        /// <summary>Shows the result to the avatar's right, and the avatar as well.</summary>
        public bool Beside
        {
            get { return beside; }
            set
            {
                if (beside == value) return;
                beside = value;
                Place();
                ApplyVisibility();
            }
        }

        /// <summary>How the proxy stands. An avatar without bones stands as it does.</summary>
        public PreviewPose Pose
        {
            get { return pose; }
            set
            {
                if (pose == value) return;
                pose = value;
                Stand();
            }
        }

        void Stand()
        {
            skeleton.Stand(figure.Result);
            if (Avatar.Rigged) PreviewPoses.Take(pose, skeleton, jointOf, Avatar.Twins);
        }

        /// <summary>The weights of all blend shapes. Without garbage.</summary>
        void Weights(List<float> weights)
        {
            weights.Clear();
            foreach (RendererData data in Avatar.Renderers)
            {
                SkinnedMeshRenderer skinned = data.Renderer as SkinnedMeshRenderer;
                for (int shape = 0; skinned != null && shape < data.Mesh.blendShapeCount; shape++)
                {
                    weights.Add(skinned.GetBlendShapeWeight(shape));
                }
            }
        }

        /// <summary>Whether blend shapes are on that were not at the start, or otherwise: what is shown is another face.</summary>
        public bool IsWornOtherwise
        {
            get
            {
                int at = 0;
                foreach (RendererData data in Avatar.Renderers)
                {
                    SkinnedMeshRenderer skinned = data.Renderer as SkinnedMeshRenderer;
                    for (int shape = 0; skinned != null && shape < data.Mesh.blendShapeCount; shape++, at++)
                    {
                        if (at >= worn.Count || worn[at] != skinned.GetBlendShapeWeight(shape)) return true;
                    }
                }
                return false;
            }
        }

        /// <summary>The avatar's object that one of the proxy's stands for; null for others.</summary>
        public GameObject OriginalOf(GameObject shown)
        {
            if (shown == null || Proxy == null || !shown.transform.IsChildOf(Proxy.transform)) return null;
            foreach (ProxyRenderer renderer in renderers)
            {
                if (renderer.IsOn(shown)) return renderer.Original.gameObject;
            }
            return Avatar.Root;
        }

        /// <summary>
        /// A click on the proxy, or a rectangle around it, selects what it stands for: the proxy itself is nothing that can be changed.
        /// </summary>
        void SelectOriginal()
        {
            UnityEngine.Object[] selected = Selection.objects;
            if (!Array.Exists(selected, one => OriginalOf(one as GameObject) != null)) return;
            var originals = new List<UnityEngine.Object>();
            foreach (UnityEngine.Object one in selected)
            {
                UnityEngine.Object original = OriginalOf(one as GameObject) ?? one;
                if (!originals.Contains(original)) originals.Add(original);
            }
            Selection.objects = originals.ToArray();
        }

        /// <summary>Where the avatar is, as it is shown.</summary>
        public Bounds Bounds
        {
            get
            {
                bool any = false;
                var bounds = new Bounds(Avatar.Root.transform.position, Vector3.zero);
                foreach (RendererData data in Avatar.Renderers)
                {
                    if (data.Renderer != null)
                    {
                        if (any) bounds.Encapsulate(data.Renderer.bounds);
                        else bounds = data.Renderer.bounds;
                        any = true;
                    }
                }
                return bounds;
            }
        }

        /// <summary>
        /// Follows the avatar, which may have been moved, posed, painted otherwise, or had parts switched on and off.
        /// </summary>
        /// <returns>Whether it had been.</returns>
        public bool Follow()
        {
            bool changed = false;
            foreach (ProxyRenderer renderer in renderers)
            {
                changed |= renderer.Follow(!showBefore);
            }
            if (changed && !showBefore && !beside) Hide();
            bool placed = !placedAt.Equals(Avatar.Root.transform.localToWorldMatrix), posed = skeleton.HasMoved();
            if (placed) Place();
            if (posed) Stand();
            return changed || placed || posed;
        }

        void Place()
        {
            Transform root = Avatar.Root.transform;
            placedAt = root.localToWorldMatrix;
            Vector3 aside = beside ? root.right * (1.2f * Width() * root.lossyScale.x) : Vector3.zero;
            skeleton.Place(root, aside);
        }

        float Width()
        {
            if (width > 0) return width;
            float low = 0, high = 0;
            foreach (RendererData renderer in Avatar.Renderers)
            {
                foreach (Vector3 vertex in renderer.ModelVertices)
                {
                    low = Mathf.Min(low, vertex.x);
                    high = Mathf.Max(high, vertex.x);
                }
            }
            return width = high - low;
        }

        void ApplyVisibility()
        {
            foreach (ProxyRenderer renderer in renderers)
            {
                renderer.Visible = !showBefore;
            }
            if (showBefore || beside) Unhide();
            else Hide();
        }

        // forceRenderingOff is not saved and is no change of the object: nothing of the avatar is left different.
        void Hide()
        {
            foreach (RendererData data in Avatar.Renderers)
            {
                if (data.Renderer != null && IsShown(data) && !data.Renderer.forceRenderingOff)
                {
                    data.Renderer.forceRenderingOff = true;
                    hidden.Add(data.Renderer);
                }
            }
        }

        void Unhide()
        {
            foreach (Renderer renderer in hidden)
            {
                if (renderer != null) renderer.forceRenderingOff = false;
            }
            hidden.Clear();
        }

        static ProgressHandler Part(IConversionProgress progress, string stage, float from, float to) =>
            progress == null ? (ProgressHandler)null : fraction => progress.Report(stage, from + (to - from) * fraction);

        static int[] JointsByRole(AvatarData avatar)
        {
            var joints = new int[55];
            for (int role = 0; role < joints.Length; role++)
            {
                joints[role] = -1;
            }
            if (!avatar.Rigged) return joints;
            // Guessed roles too, not only those that the avatar says.
            HumanoidRole[] roles = avatar.Character.GetJoints().Roles;
            for (int joint = 0; joint < avatar.Joints.Length; joint++)
            {
                if (roles[joint] >= 0 && (int)roles[joint] < joints.Length) joints[(int)roles[joint]] = joint;
            }
            return joints;
        }

        public void Dispose()
        {
            Selection.selectionChanged -= SelectOriginal;
            if (counted && Shown != null) Shown(false);
            counted = false;
            Unhide();
            foreach (ProxyRenderer renderer in renderers)
            {
                renderer.Destroy();
            }
            renderers.Clear();
            if (skeleton != null) skeleton.Destroy();
            skeleton = null;
            if (figure != null) figure.Dispose();
        }
    }
}
