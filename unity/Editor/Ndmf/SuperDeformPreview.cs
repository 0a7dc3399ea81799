using System;
using System.Collections.Generic;
using System.Collections.Immutable;
using System.Linq;
using System.Threading.Tasks;
using nadena.dev.ndmf.preview;
using UnityEditor;
using UnityEngine;
using UnityEngine.SceneManagement;

namespace SuperDeform.Editor.Ndmf
{
    /// <summary>What NDMF shows of avatars with a Super Deform Avatar component while they are edited: what a build makes of them.</summary>
    /// <remarks>
    /// It stands behind the filters of other plugins, and deforms what those show: bodies whose covered parts are cut away, for
    /// instance. Outfits that a build merges follow as twins, as everywhere.
    /// </remarks>
    internal sealed class SuperDeformPreview : IRenderFilter
    {
        static readonly TogglablePreviewNode onOff = TogglablePreviewNode.Create(() => "Super Deform", "com.superdeform.converter/preview", true);

        /// <summary>The switch in NDMF's list of previews.</summary>
        public IEnumerable<TogglablePreviewNode> GetPreviewControlNodes() => new[] { onOff };

        public bool IsEnabled(ComputeContext context) => context.Observe(onOff.IsEnabled);

        /// <summary>The whole avatar counts, with what is switched off.</summary>
        public bool StrictRenderGroup => true;

        public bool CanEnableRenderers => false;

        public ImmutableList<RenderGroup> GetTargetGroups(ComputeContext context)
        {
            var groups = new List<RenderGroup>();
            foreach (GameObject root in context.GetAvatarRoots())
            {
                SuperDeformAvatar component = context.GetComponent<SuperDeformAvatar>(root);
                if (component == null) continue;
                Renderer[] renderers = Array.FindAll(context.GetComponentsInChildren<Renderer>(root, true), renderer => RendererReader.MeshOf(renderer) != null);
                if (renderers.Length == 0) continue;
                // The one that tells how to compare came with 1.13; there the same object is the same.
#pragma warning disable 618
                groups.Add(RenderGroup.For(renderers).WithData(component));
#pragma warning restore 618
            }
            return groups.ToImmutableList();
        }

        public Task<IRenderFilterNode> Instantiate(RenderGroup group, IEnumerable<(Renderer, Renderer)> proxyPairs, ComputeContext context)
        {
            SuperDeformAvatar component = group.GetData<SuperDeformAvatar>();
            return Task.FromResult<IRenderFilterNode>(new SuperDeformPreviewNode(component, proxyPairs.ToList(), context));
        }
    }

    /// <summary>One avatar in NDMF's preview. One that cannot be deformed is shown as it is: a build says why.</summary>
    internal sealed class SuperDeformPreviewNode : IRenderFilterNode
    {
        readonly SuperDeformAvatar component;
        readonly PreviewFigure figure;
        readonly ProxySkeleton skeleton;
        readonly Dictionary<Renderer, ShownMesh> meshes = new Dictionary<Renderer, ShownMesh>();
        ComputeContext context;
        double changedAt;
        bool hasRested;

        /// <summary>One renderer's mesh and bones.</summary>
        sealed class ShownMesh
        {
            /// <summary>Null where the proxy's own is shown.</summary>
            internal Mesh Mesh;

            /// <summary>Of a skinned renderer; null for one that hangs from one joint.</summary>
            internal Transform[] Bones;

            /// <summary>The bones that the proxy comes with: the renderer's own, or those of a filter before this one.</summary>
            internal Transform[] Given;

            /// <summary>Bones of a filter before this one.</summary>
            internal readonly List<CarriedBone> Carried = new List<CarriedBone>();

            /// <summary>The transform that stands for the renderer's own.</summary>
            internal Transform Holder;

            internal Transform RootBone;
            internal Bounds Bounds;
        }

        /// <summary>A bone of another filter, which stands beside the avatar's own: scaled, for instance.</summary>
        struct CarriedBone
        {
            internal Transform Original, Given, Shown;
        }

        // Proxies without a skin whose place was changed: NDMF sets it again only where it hangs them elsewhere.
        readonly HashSet<Transform> placed = new HashSet<Transform>();

        public RenderAspects WhatChanged => RenderAspects.Mesh | RenderAspects.Shapes;

        internal SuperDeformPreviewNode(SuperDeformAvatar component, List<(Renderer, Renderer)> pairs, ComputeContext context)
        {
            this.component = component;
            this.context = context;
            ConversionSettings settings = Observed(component, context);
            try
            {
                var reading = new ReadOptions { AsWorn = true, RigAuto = settings.RigAuto, RigOptions = settings.Options, Shown = pairs.ToDictionary(pair => pair.Item1, pair => pair.Item2) };
                figure = new PreviewFigure(component.gameObject, settings, reading, false, null);
                skeleton = new ProxySkeleton(figure.Avatar);
                // NDMF empties this scene before scripts reload and before play mode.
                Scene scene = NDMFPreviewSceneManager.GetPreviewScene();
                if (scene.IsValid()) SceneManager.MoveGameObjectToScene(skeleton.Root.gameObject, scene);
                foreach (RendererResult renderer in figure.Result.Renderers)
                {
                    meshes.Add(renderer.Source.Renderer, Made(renderer, BonesOf(reading.Shown, renderer.Source.Renderer)));
                }
                Follow();
            }
            catch (ConversionException)
            {
                Dispose();
                meshes.Clear();
                figure = null;
                skeleton = null;
            }
        }

        static ConversionSettings Observed(SuperDeformAvatar component, ComputeContext context)
        {
            context.Observe(component, one => one.Settings);
            context.Observe(component, one => one.ReferenceAvatar);
            context.Observe(component, one => one.SavedStyle);
            return SettingsText.Of(component);
        }

        static Transform[] BonesOf(Dictionary<Renderer, Renderer> proxies, Renderer original)
        {
            SkinnedMeshRenderer skinned = (proxies.TryGetValue(original, out Renderer proxy) ? proxy : original) as SkinnedMeshRenderer;
            return skinned == null ? null : skinned.bones;
        }

        ShownMesh Made(RendererResult renderer, Transform[] given)
        {
            RendererData source = renderer.Source;
            SkinnedMeshRenderer skinned = source.Renderer as SkinnedMeshRenderer;
            Transform holder = source.Renderer.transform;
            var shown = new ShownMesh { Holder = skeleton.Of(figure.Avatar.IndexOf(holder)) };
            // A pet's mesh stays as it is.
            if (source.Rides) shown.Bounds = skinned == null ? new Bounds() : skinned.localBounds;
            else
            {
                shown.Mesh = UnityEngine.Object.Instantiate(source.Mesh);
                shown.Mesh.name = source.Mesh.name;
                // Those that are on are in the vertices.
                shown.Mesh.ClearBlendShapes();
                Write(shown, renderer);
            }
            if (skinned == null) return shown;
            Transform[] bones = skinned.bones;
            shown.Given = given;
            shown.Bones = new Transform[bones.Length];
            for (int bone = 0; bone < bones.Length; bone++)
            {
                Transform other = given.Length == bones.Length ? given[bone] : bones[bone];
                Transform joint = bones[bone] == null ? null : skeleton.Of(figure.Avatar.IndexOf(bones[bone]));
                shown.Bones[bone] = joint == null || other == null || other == bones[bone] ? joint : Carried(shown, bones[bone], other, joint);
            }
            shown.RootBone = skinned.rootBone == null ? shown.Holder : skeleton.Of(figure.Avatar.IndexOf(skinned.rootBone));
            return shown;
        }

        static Transform Carried(ShownMesh shown, Transform original, Transform given, Transform joint)
        {
            Transform made = EditorUtility.CreateGameObjectWithHideFlags(given.name, HideFlags.HideAndDontSave).transform;
            made.SetParent(joint, false);
            shown.Carried.Add(new CarriedBone { Original = original, Given = given, Shown = made });
            return made;
        }

        static void Write(ShownMesh shown, RendererResult renderer)
        {
            MeshWriter.Write(shown.Mesh, renderer);
            SkinnedMeshRenderer skinned = renderer.Source.Renderer as SkinnedMeshRenderer;
            if (skinned != null) shown.Bounds = MeshWriter.NewBounds(skinned.localBounds, renderer);
        }

        /// <summary>
        /// Takes new settings without reading the avatar again. Where blend shapes or a renderer change, it is read when that rests: a
        /// slider of a shape moves on meanwhile.
        /// </summary>
        public Task<IRenderFilterNode> Refresh(IEnumerable<(Renderer, Renderer)> proxyPairs, ComputeContext context, RenderAspects updatedAspects)
        {
            bool same = (updatedAspects & RenderAspects.Mesh) == 0 && !hasRested;
            if (!same || !HaveSameBones(proxyPairs) || figure == null || component == null || skeleton.Root == null)
            {
                return Task.FromResult<IRenderFilterNode>(null);
            }
            this.context = context;
            if ((updatedAspects & RenderAspects.Shapes) != 0) WhenRested(ReadAnew);
            ConversionSettings settings = Observed(component, context);
            try
            {
                if (SettingsChanges.Between(figure.Shown, settings) == SettingsChange.Rig) return Task.FromResult<IRenderFilterNode>(null);
                if (figure.Update(settings, true))
                {
                    WriteAll();
                    WhenRested(Settle);
                }
                skeleton.Stand(figure.Result);
            }
            catch (ConversionException)
            {
                return Task.FromResult<IRenderFilterNode>(null);
            }
            return Task.FromResult<IRenderFilterNode>(this);
        }

        /// <summary>Whether filters before this one give the bones that they gave.</summary>
        bool HaveSameBones(IEnumerable<(Renderer, Renderer)> proxyPairs)
        {
            foreach ((Renderer, Renderer) pair in proxyPairs)
            {
                SkinnedMeshRenderer skinned = pair.Item2 as SkinnedMeshRenderer;
                if (skinned != null && meshes.TryGetValue(pair.Item1, out ShownMesh shown) && !skinned.bones.SequenceEqual(shown.Given)) return false;
            }
            return true;
        }

        void WriteAll()
        {
            foreach (RendererResult renderer in figure.Result.Renderers)
            {
                if (!renderer.Source.Rides) Write(meshes[renderer.Source.Renderer], renderer);
            }
        }

        /// <summary>Has a step tried in every round of the editor; it waits until nothing has changed for a while.</summary>
        void WhenRested(EditorApplication.CallbackFunction step)
        {
            changedAt = EditorApplication.timeSinceStartup;
            EditorApplication.update -= step;
            EditorApplication.update += step;
        }

        bool Moves => EditorApplication.timeSinceStartup - changedAt < ConverterController.Rest;

        void ReadAnew()
        {
            if (Moves) return;
            EditorApplication.update -= ReadAnew;
            hasRested = true;
            context.Invalidate();
        }

        /// <summary>Pushes clothes out of the body as it is now.</summary>
        void Settle()
        {
            if (Moves) return;
            EditorApplication.update -= Settle;
            try
            {
                if (skeleton.Root == null || !figure.Settle()) return;
                WriteAll();
                SceneView.RepaintAll();
            }
            catch (ConversionException)
            {
                // A build says why. What is shown stays.
            }
        }

        public void OnFrameGroup()
        {
            if (figure != null && component != null && skeleton.Root != null) Follow();
        }

        void Follow()
        {
            skeleton.Place(figure.Avatar.Root.transform, Vector3.zero);
            if (skeleton.HasMoved()) skeleton.Stand(figure.Result);
            foreach (ShownMesh shown in meshes.Values)
            {
                foreach (CarriedBone bone in shown.Carried)
                {
                    if (bone.Original != null && bone.Given != null) Stand(bone);
                }
            }
        }

        /// <summary>A bone of another filter stands beside the moved joint as it stands beside the avatar's.</summary>
        static void Stand(CarriedBone bone)
        {
            Matrix4x4 beside = bone.Original.worldToLocalMatrix * bone.Given.localToWorldMatrix;
            bone.Shown.localPosition = new Vector3(beside.m03, beside.m13, beside.m23);
            bone.Shown.localRotation = beside.rotation;
            bone.Shown.localScale = beside.lossyScale;
        }

        /// <summary>
        /// Each frame begins with the original's mesh and bones. Nothing is hung elsewhere: that would be a change of the hierarchy, of
        /// which the whole editor hears.
        /// </summary>
        public void OnFrame(Renderer original, Renderer proxy)
        {
            // NDMF may have emptied its scene.
            if (figure == null || skeleton.Root == null || proxy == null || !meshes.TryGetValue(original, out ShownMesh shown)) return;
            SkinnedMeshRenderer skinned = proxy as SkinnedMeshRenderer;
            if (skinned == null)
            {
                if (shown.Mesh != null) proxy.GetComponent<MeshFilter>().sharedMesh = shown.Mesh;
                Place(proxy.transform, shown.Holder);
                return;
            }
            if (shown.Mesh != null) skinned.sharedMesh = shown.Mesh;
            skinned.bones = shown.Bones;
            skinned.rootBone = shown.RootBone;
            skinned.localBounds = shown.Bounds;
        }

        /// <summary>Puts a proxy where a joint is, whatever it hangs from.</summary>
        void Place(Transform proxy, Transform joint)
        {
            Vector3 size = joint.lossyScale, above = proxy.parent == null ? Vector3.one : proxy.parent.lossyScale;
            proxy.position = joint.position;
            proxy.rotation = joint.rotation;
            proxy.localScale = new Vector3(size.x / above.x, size.y / above.y, size.z / above.z);
            placed.Add(proxy);
        }

        /// <summary>Gives NDMF its proxies back where it had put them.</summary>
        void Release()
        {
            foreach (Transform proxy in placed)
            {
                if (proxy == null) continue;
                proxy.localPosition = Vector3.zero;
                proxy.localRotation = Quaternion.identity;
                proxy.localScale = Vector3.one;
            }
            placed.Clear();
        }

        public void Dispose()
        {
            EditorApplication.update -= ReadAnew;
            EditorApplication.update -= Settle;
            Release();
            foreach (ShownMesh shown in meshes.Values)
            {
                if (shown.Mesh != null) UnityEngine.Object.DestroyImmediate(shown.Mesh);
            }
            if (skeleton != null) skeleton.Destroy();
            if (figure != null) figure.Dispose();
        }
    }
}
