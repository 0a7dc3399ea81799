// See README.md for where each member was read. Default methods of interfaces are left out: C# 7.2 knows none.
using System;
using System.Collections.Generic;
using System.Collections.Immutable;
using System.Linq;
using System.Runtime.CompilerServices;
using System.Threading.Tasks;
using UnityEditor.SceneManagement;
using UnityEngine;
using UnityEngine.SceneManagement;
using Object = UnityEngine.Object;

namespace nadena.dev.ndmf.preview
{
    public static class NDMFPreview { public static int DisablePreviewDepth { get; set; } }

    public static class NDMFPreviewSceneManager
    {
        static Scene s_Scene;
        public static Scene GetPreviewScene() { if (!s_Scene.IsValid()) s_Scene = EditorSceneManager.NewPreviewScene(); return s_Scene; }
        internal static bool IsOpen { get { return s_Scene.IsValid(); } }
        internal static void Close() { if (s_Scene.IsValid()) EditorSceneManager.ClosePreviewScene(s_Scene); }
    }

    public sealed class PublishedValue<T>
    {
        public T Value { get; set; }
        public PublishedValue(T value) { Value = value; }
    }

    public sealed class TogglablePreviewNode
    {
        public Func<string> DisplayName { get; private set; }
        public PublishedValue<bool> IsEnabled { get; private set; }
        public static TogglablePreviewNode Create(Func<string> displayName, string qualifiedName = null, bool initialState = true)
        {
            return new TogglablePreviewNode { DisplayName = displayName, IsEnabled = new PublishedValue<bool>(initialState) };
        }
    }

    public sealed class ComputeContext
    {
        /// What was observed: a check whether it is still the same.
        internal readonly List<Func<bool>> Same = new List<Func<bool>>();
        bool m_Invalidated;
        public Action Invalidate { get; private set; }
        public ComputeContext(string description) { Invalidate = () => m_Invalidated = true; }
        public bool IsInvalidated { get { return m_Invalidated || Same.Exists(same => !same()); } }
    }

    public static class ComputeContextQueries
    {
        public static ImmutableList<GameObject> GetAvatarRoots(this ComputeContext ctx)
        {
            return SceneManager.GetActiveScene().GetRootGameObjects().Where(root => root.hideFlags == HideFlags.None && root.GetComponent<Animator>() != null && root.activeInHierarchy).ToImmutableList();
        }
        public static C GetComponent<C>(this ComputeContext ctx, GameObject obj, [CallerFilePath] string callerPath = "", [CallerLineNumber] int callerLine = 0) where C : class
        {
            return obj.GetComponent<C>();
        }
        public static C[] GetComponentsInChildren<C>(this ComputeContext ctx, GameObject obj, bool includeInactive, [CallerFilePath] string callerPath = "", [CallerLineNumber] int callerLine = 0) where C : class
        {
            return obj.GetComponentsInChildren<C>(includeInactive);
        }
        public static T Observe<T>(this ComputeContext ctx, PublishedValue<T> val, [CallerFilePath] string callerPath = "", [CallerLineNumber] int callerLine = 0) where T : IEquatable<T>
        {
            T seen = val.Value;
            ctx.Same.Add(() => seen.Equals(val.Value));
            return seen;
        }
        public static R Observe<T, R>(this ComputeContext ctx, T obj, Func<T, R> extract, Func<R, R, bool> compare = null, [CallerFilePath] string callerPath = "", [CallerLineNumber] int callerLine = 0) where T : Object
        {
            R seen = extract(obj);
            ctx.Same.Add(() => obj != null && (compare == null ? Equals(seen, extract(obj)) : compare(seen, extract(obj))));
            return seen;
        }
    }

    public class RenderGroup
    {
        public ImmutableList<Renderer> Renderers { get; private set; }
        object m_Data;
        public static RenderGroup For(IEnumerable<Renderer> renderers) { return new RenderGroup { Renderers = renderers.ToImmutableList() }; }
        public RenderGroup WithData<T>(T data) { return new RenderGroup { Renderers = Renderers, m_Data = data }; }
        public T GetData<T>() { return (T)m_Data; }
    }

    [Flags]
    public enum RenderAspects { Mesh = 1, Material = 2, Texture = 4, Shapes = 8, Everything = 0x7FFFFFFF }

    public interface IRenderFilter
    {
        bool CanEnableRenderers { get; }
        bool StrictRenderGroup { get; }
        ImmutableList<RenderGroup> GetTargetGroups(ComputeContext context);
        Task<IRenderFilterNode> Instantiate(RenderGroup group, IEnumerable<(Renderer, Renderer)> proxyPairs, ComputeContext context);
        bool IsEnabled(ComputeContext context);
        IEnumerable<TogglablePreviewNode> GetPreviewControlNodes();
    }

    public interface IRenderFilterNode : IDisposable
    {
        RenderAspects WhatChanged { get; }
        Task<IRenderFilterNode> Refresh(IEnumerable<(Renderer, Renderer)> proxyPairs, ComputeContext context, RenderAspects updatedAspects);
        void OnFrame(Renderer original, Renderer proxy);
        void OnFrameGroup();
    }

    /// What tests see of a preview: one filter, on one avatar, behind what another filter does to the proxies' meshes.
    public sealed class NdmfPreviewStub : IDisposable
    {
        readonly IRenderFilter m_Filter;
        readonly Func<Mesh, Mesh> m_Before;
        readonly Action<Renderer, Renderer> m_Earlier;
        readonly Dictionary<Transform, Transform> m_Shadows = new Dictionary<Transform, Transform>();
        readonly Dictionary<Renderer, Mesh> m_Meshes = new Dictionary<Renderer, Mesh>();
        readonly Dictionary<Renderer, Renderer> m_Proxies = new Dictionary<Renderer, Renderer>();
        readonly RenderGroup m_Group;
        readonly Dictionary<Renderer, float[]> m_Weights = new Dictionary<Renderer, float[]>();
        ComputeContext m_Context;
        public IRenderFilterNode Node { get; private set; }

        /// Null where the filter is for no avatar, or off.
        /// <param name="before">What another filter, before this one, makes of a mesh.</param>
        /// <param name="earlier">What it does to an original's proxy in each frame.</param>
        public static NdmfPreviewStub Of(IRenderFilter filter, Func<Mesh, Mesh> before = null, Action<Renderer, Renderer> earlier = null)
        {
            ComputeContext context = new ComputeContext("groups");
            if (!filter.IsEnabled(context)) return null;
            ImmutableList<RenderGroup> groups = filter.GetTargetGroups(context);
            return groups.Count == 0 ? null : new NdmfPreviewStub(filter, groups[0], before ?? (mesh => mesh), earlier ?? ((original, proxy) => { }));
        }

        NdmfPreviewStub(IRenderFilter filter, RenderGroup group, Func<Mesh, Mesh> before, Action<Renderer, Renderer> earlier)
        {
            m_Filter = filter; m_Group = group; m_Before = before; m_Earlier = earlier;
            foreach (Renderer original in group.Renderers)
            {
                GameObject holder = UnityEditor.EditorUtility.CreateGameObjectWithHideFlags("Proxy renderer for " + original.gameObject.name, HideFlags.DontSave);
                SceneManager.MoveGameObjectToScene(holder, NDMFPreviewSceneManager.GetPreviewScene());
                if (original is MeshRenderer) holder.AddComponent<MeshFilter>();
                m_Proxies[original] = original is SkinnedMeshRenderer ? (Renderer)holder.AddComponent<SkinnedMeshRenderer>() : holder.AddComponent<MeshRenderer>();
            }
            Reset();
            Make();
        }

        public Renderer Proxy(Renderer original) { return m_Proxies[original]; }
        IEnumerable<(Renderer, Renderer)> Pairs { get { return m_Group.Renderers.Select(original => (original, m_Proxies[original])); } }
        void Make() { m_Context = new ComputeContext("node"); Node = m_Filter.Instantiate(m_Group, Pairs, m_Context).Result; }

        // What stands for a transform and those above it in the preview's scene, as ShadowBoneManager has it.
        Transform Shadow(Transform original)
        {
            Transform shadow;
            if (!m_Shadows.TryGetValue(original, out shadow) || shadow == null)
            {
                m_Shadows[original] = shadow = UnityEditor.EditorUtility.CreateGameObjectWithHideFlags(original.name, HideFlags.DontSave).transform;
                SceneManager.MoveGameObjectToScene(shadow.gameObject, NDMFPreviewSceneManager.GetPreviewScene());
                if (original.parent != null) shadow.SetParent(Shadow(original.parent), false);
            }
            else if (original.parent != null) Shadow(original.parent);
            shadow.localPosition = original.localPosition;
            shadow.localRotation = original.localRotation;
            shadow.localScale = original.localScale;
            return shadow;
        }

        // What ProxyObjectController.OnPreFrame does: each frame begins with the original's state.
        RenderAspects Reset()
        {
            RenderAspects changed = 0;
            foreach (KeyValuePair<Renderer, Renderer> pair in m_Proxies)
            {
                MeshFilter filter = pair.Key.GetComponent<MeshFilter>();
                Mesh mesh = m_Before(pair.Key is SkinnedMeshRenderer ? ((SkinnedMeshRenderer)pair.Key).sharedMesh : filter.sharedMesh), known;
                if (m_Meshes.TryGetValue(pair.Key, out known) && known != mesh) changed |= RenderAspects.Mesh;
                m_Meshes[pair.Key] = mesh;
            }
            foreach (KeyValuePair<Renderer, Renderer> pair in m_Proxies)
            {
                SkinnedMeshRenderer original = pair.Key as SkinnedMeshRenderer, proxy = pair.Value as SkinnedMeshRenderer;
                pair.Value.sharedMaterials = pair.Key.sharedMaterials;
                pair.Value.enabled = pair.Key.enabled && pair.Key.gameObject.activeInHierarchy;
                if (original == null)
                {
                    pair.Value.GetComponent<MeshFilter>().sharedMesh = m_Meshes[pair.Key];
                    Transform shadow = Shadow(pair.Key.transform), hung = pair.Value.transform;
                    if (hung.parent != shadow)
                    {
                        hung.SetParent(shadow, false);
                        hung.localPosition = Vector3.zero;
                        hung.localRotation = Quaternion.identity;
                        hung.localScale = Vector3.one;
                    }
                    m_Earlier(pair.Key, pair.Value);
                    continue;
                }
                proxy.sharedMesh = m_Meshes[pair.Key];
                proxy.bones = original.bones;
                proxy.rootBone = original.rootBone != null ? original.rootBone : original.transform;
                proxy.localBounds = original.localBounds;
                proxy.transform.position = original.transform.position;
                proxy.transform.rotation = original.transform.rotation;
                float[] weights = new float[proxy.sharedMesh.blendShapeCount], old;
                for (int shape = 0; shape < weights.Length; shape++) proxy.SetBlendShapeWeight(shape, weights[shape] = original.GetBlendShapeWeight(shape));
                if (m_Weights.TryGetValue(original, out old) && !old.SequenceEqual(weights)) changed |= RenderAspects.Shapes;
                m_Weights[original] = weights;
                m_Earlier(pair.Key, pair.Value);
            }
            return changed;
        }

        /// One frame; gives what was made anew: "", "refreshed" or "instantiated".
        public string Frame()
        {
            string done = "";
            RenderAspects changed = Reset();
            if (changed != 0 || m_Context.IsInvalidated)
            {
                ComputeContext context = new ComputeContext("node (refresh)");
                IRenderFilterNode next = Node.Refresh(Pairs, context, changed).Result;
                done = next == null ? "instantiated" : "refreshed";
                if (next == null) { IRenderFilterNode old = Node; Make(); old.Dispose(); }
                else { Node = next; m_Context = context; }
            }
            Node.OnFrameGroup();
            foreach (KeyValuePair<Renderer, Renderer> pair in m_Proxies) Node.OnFrame(pair.Key, pair.Value);
            return done;
        }

        public static void CloseScene() { NDMFPreviewSceneManager.Close(); }
        public void Dispose()
        {
            bool open = NDMFPreviewSceneManager.IsOpen;
            Node.Dispose();
            foreach (Renderer proxy in m_Proxies.Values)
            {
                if (proxy == null && open) throw new InvalidOperationException("Proxy object was destroyed improperly!");
                if (proxy != null) Object.DestroyImmediate(proxy.gameObject);
            }
            foreach (Transform shadow in m_Shadows.Values) if (shadow != null) Object.DestroyImmediate(shadow.gameObject);
        }
    }
}
