using System.Collections.Generic;
using UnityEditor;
using UnityEngine;

namespace SuperDeform.Editor
{
    /// <summary>A renderer that stands for one of the avatar's: the same look, vertices that follow the deformer.</summary>
    /// <remarks>
    /// Its vertices are in the space of the avatar's root at rest, as the library gives them; so the bind pose of a bone is
    /// the inverse of its rest matrix there. A mesh that hangs from one joint gets that joint as its only bone. Blend
    /// shapes that are on are in the vertices.
    /// </remarks>
    internal sealed class ProxyRenderer
    {
        readonly RendererResult result;
        readonly int[] joints;
        readonly Mesh mesh;
        readonly Matrix4x4[] bindPoses;
        readonly SkinnedMeshRenderer renderer;
        readonly List<Material> now = new List<Material>(), before = new List<Material>();

        internal ProxyRenderer(AvatarData avatar, RendererResult result, ProxySkeleton skeleton)
        {
            this.result = result;
            RendererData source = result.Source;
            mesh = Object.Instantiate(source.Mesh);
            mesh.name = source.Mesh.name + " (preview)";
            mesh.hideFlags = HideFlags.HideAndDontSave;
            mesh.ClearBlendShapes();
            mesh.MarkDynamic();
            bool skinned = avatar.Rigged && source.Skin != null && source.Skin.Joints.Length > 0;
            // An avatar without bones gets them in the result alone: here its meshes hang from the root.
            joints = skinned ? source.Skin.Joints : new[] { avatar.Rigged && source.Skin == null ? source.Joint : -1 };
            bindPoses = new Matrix4x4[joints.Length];
            if (!skinned)
            {
                mesh.boneWeights = WholeWeights(mesh.vertexCount);
                mesh.bindposes = bindPoses;
            }

            GameObject holder = EditorUtility.CreateGameObjectWithHideFlags(source.Renderer.name, HideFlags.HideAndDontSave);
            holder.layer = source.Renderer.gameObject.layer;
            holder.transform.SetParent(skeleton.Root, false);
            renderer = holder.AddComponent<SkinnedMeshRenderer>();
            renderer.sharedMesh = mesh;
            renderer.sharedMaterials = source.Renderer.sharedMaterials;
            renderer.rootBone = skeleton.Root;
            var bones = new Transform[joints.Length];
            for (int bone = 0; bone < bones.Length; bone++)
            {
                bones[bone] = skeleton.Of(joints[bone]);
            }
            renderer.bones = bones;
            renderer.localBounds = Around(source.ModelVertices);
        }

        /// <summary>Shows what the library has written. Without garbage.</summary>
        internal void Show(ProxySkeleton skeleton)
        {
            mesh.SetVertices(result.Positions);
            if (result.Normals != null) mesh.SetNormals(result.Normals);
            if (result.Tangents != null) mesh.SetTangents(result.Tangents);
            for (int bone = 0; bone < bindPoses.Length; bone++)
            {
                bindPoses[bone] = skeleton.InverseRest(joints[bone]);
            }
            mesh.bindposes = bindPoses;
        }

        /// <summary>The avatar's renderer; null once it was deleted.</summary>
        internal Renderer Original => result.Source.Renderer;

        /// <summary>Whether an object is the one that it is shown by.</summary>
        internal bool IsOn(GameObject shown) => renderer.gameObject == shown && Original != null;

        /// <summary>Whether it is to be seen, where the avatar's renderer is.</summary>
        internal bool Visible
        {
            set { renderer.enabled = value && IsOriginalSeen; }
        }

        // The eye in the Hierarchy hides an object in the Scene view alone.
        bool IsOriginalSeen
        {
            get
            {
                return Original != null && Original.enabled && Original.gameObject.activeInHierarchy
                    && !SceneVisibilityManager.instance.IsHidden(Original.gameObject);
            }
        }

        /// <summary>Follows the avatar's renderer: seen or not, and its materials. Without garbage.</summary>
        /// <returns>Whether anything had changed.</returns>
        internal bool Follow(bool visible)
        {
            bool seen = visible && IsOriginalSeen, changed = renderer.enabled != seen;
            renderer.enabled = seen;
            if (Original == null) return changed;
            Original.GetSharedMaterials(now);
            renderer.GetSharedMaterials(before);
            bool same = now.Count == before.Count;
            for (int slot = 0; same && slot < now.Count; slot++)
            {
                same = now[slot] == before[slot];
            }
            if (same) return changed;
            renderer.sharedMaterials = now.ToArray();
            return true;
        }

        internal void Destroy()
        {
            // The object goes with the skeleton's root; a mesh belongs to nobody.
            if (mesh != null) Object.DestroyImmediate(mesh);
        }

        static BoneWeight[] WholeWeights(int count)
        {
            var weights = new BoneWeight[count];
            for (int i = 0; i < count; i++)
            {
                weights[i].weight0 = 1;
            }
            return weights;
        }

        // Well beyond the mesh: what a slider does stays inside, and Unity does not cull it.
        static Bounds Around(Vector3[] points)
        {
            var bounds = new Bounds(points.Length > 0 ? points[0] : Vector3.zero, Vector3.zero);
            foreach (Vector3 point in points)
            {
                bounds.Encapsulate(point);
            }
            bounds.Expand(bounds.size.magnitude);
            return bounds;
        }
    }
}
