using System;
using System.Collections.Generic;
using UnityEditor;
using UnityEngine;

namespace SuperDeform.Editor
{
    /// <summary>
    /// Makes the new avatar: a copy of the source with moved transforms, new meshes, adapted components and a new Avatar.
    /// </summary>
    internal static class CharacterWriter
    {
        /// <summary>Makes a copy of the source what the result says.</summary>
        /// <param name="copy">An instance of the source.</param>
        /// <param name="map">Receives as assets the new meshes, the Avatar, and what adapters make.</param>
        /// <param name="findings">Receives warnings and notes.</param>
        /// <param name="progress">Told of the blend shapes.</param>
        /// <param name="clips">What plays on the copy.</param>
        internal static void Write(GameObject copy, PointMap map, AvatarData source, AvatarResult result, List<Finding> findings, ProgressHandler progress,
            IMovableClips clips)
        {
            RemoveMissingScripts(copy, source, findings);
            List<RendererResult> renderers = result.Renderers.FindAll(renderer => !renderer.Source.Rides);
            var made = new Dictionary<RendererResult, Mesh>();
            int shapes = 0, done = 0;
            renderers.ForEach(renderer => shapes += renderer.Source.Frames.Count);
            foreach (RendererResult renderer in renderers)
            {
                Mesh mesh = source.Rigged ? Shared(renderer, made) : null;
                if (mesh == null)
                {
                    int before = done, own = renderer.Source.Frames.Count;
                    mesh = MeshWriter.Make(renderer, map, fraction => progress((before + fraction * own) / shapes));
                    made.Add(renderer, mesh);
                }
                done += renderer.Source.Frames.Count;
                map.Remember(renderer.Source.Renderer, mesh);
            }
            var written = new ClipMap(source, result, map);
            written.Remember(clips.Clips);
            // Before any mesh changes hands: adapters may ask for the old one.
            Adapt(copy, map, findings);
            for (int joint = 0; joint < source.Joints.Length; joint++)
            {
                Vector3 shift = result.LocalShifts[joint];
                if (shift.x == 0 && shift.y == 0 && shift.z == 0) continue;
                map.CopyOf(source.Joints[joint]).localPosition = result.LocalPositions[joint];
            }
            for (int joint = 0; joint < source.Joints.Length; joint++)
            {
                if (result.LocalScale(joint) != 1) map.CopyOf(source.Joints[joint]).localScale *= result.LocalScale(joint);
            }
            Outlines.Scale(copy, map, findings);
            if (source.Rigged)
            {
                foreach (RendererResult renderer in renderers)
                {
                    Show(renderer, map);
                }
                HumanoidAvatar.Rebuild(map, source, result);
            }
            else
            {
                MadeRig.Add(copy, map, source, result);
            }
            foreach (IMovableClip clip in clips.Clips)
            {
                written.Write(clip);
            }
            clips.Finish(map, written, findings);
        }

        /// <summary>The mesh of another renderer that shows the same; null where there is none.</summary>
        static Mesh Shared(RendererResult renderer, Dictionary<RendererResult, Mesh> made)
        {
            foreach (KeyValuePair<RendererResult, Mesh> other in made)
            {
                if (renderer.IsLike(other.Key)) return other.Value;
            }
            return null;
        }

        /// <summary>Unity saves no prefab of objects whose scripts are missing.</summary>
        static void RemoveMissingScripts(GameObject copy, AvatarData source, List<Finding> findings)
        {
            int removed = 0;
            foreach (Transform transform in copy.GetComponentsInChildren<Transform>(true))
            {
                removed += GameObjectUtility.RemoveMonoBehavioursWithMissingScript(transform.gameObject);
            }
            if (removed > 0) findings.Add(new Finding("missing_scripts", Severity.Warning, source.Root, source.Root.name, removed));
        }

        static void Show(RendererResult renderer, PointMap map)
        {
            Renderer original = renderer.Source.Renderer;
            Transform place = map.CopyOf(original.transform);
            Mesh mesh = map.MeshFor(original);
            if (!(original is SkinnedMeshRenderer))
            {
                place.GetComponent<MeshFilter>().sharedMesh = mesh;
                return;
            }
            SkinnedMeshRenderer skinned = place.GetComponent<SkinnedMeshRenderer>();
            Bounds bounds = skinned.localBounds;
            skinned.sharedMesh = mesh;
            skinned.localBounds = MeshWriter.NewBounds(bounds, renderer);
        }

        static void Adapt(GameObject copy, PointMap map, List<Finding> findings)
        {
            var left = new List<Component>();
            // Null where a script is missing.
            Component[] components = Array.FindAll(copy.GetComponentsInChildren<Component>(true), component => component != null);
            // Before any adapter changes a radius.
            foreach (Component component in components)
            {
                if (ComponentAdapters.For(component) is ISpringAdapter adapter) Try(component, findings, () => adapter.AddSprings(component, map.Colliders.Springs));
            }
            foreach (Component component in components)
            {
                IComponentAdapter adapter = ComponentAdapters.For(component);
                if (adapter == null)
                {
                    left.Add(component);
                    continue;
                }
                if (Array.IndexOf(ClothRows.NeedsCreate, component.GetType().FullName) >= 0)
                {
                    findings.Add(new Finding("needs_create", Severity.Warning, map.Source(component.transform), component.name, component.GetType().Name));
                }
                Try(component, findings, () => adapter.Adapt(component, map));
            }
            Unlisted.Report(left, map, findings);
            ReportColliders(map.Colliders, findings);
        }

        /// <summary>Lets an adapter do its work, which may be anybody's; what it throws becomes a finding.</summary>
        static void Try(Component component, List<Finding> findings, Action work)
        {
            try
            {
                work();
            }
            catch (Exception cause)
            {
                findings.Add(new Finding("adapter_failed", Severity.Warning, null, component.GetType().Name, component.name, cause.Message));
            }
        }

        static void ReportColliders(ColliderMap colliders, List<Finding> findings)
        {
            foreach (KeyValuePair<Transform, int> crowded in colliders.Crowded)
            {
                findings.Add(new Finding("spring_in_collider", Severity.Warning, crowded.Key, crowded.Value, crowded.Key.name));
            }
            if (colliders.YieldedCount == 0) return;
            double percent = Math.Ceiling(100 * colliders.MostYielded);
            findings.Add(new Finding("collider_yields", Severity.Info, null, colliders.YieldedCount, percent));
        }
    }
}
