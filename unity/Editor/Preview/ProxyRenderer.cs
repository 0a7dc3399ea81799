using System.Collections.Generic;
using UnityEngine;

namespace SuperDeform.Editor
{
    /// <summary>A renderer that stands for one of the avatar's: the same look, vertices that follow the deformer.</summary>
    /// <remarks>
    /// Its vertices are in the space of the avatar's root at rest, which is what the library gives; so the bind pose of a
    /// bone is the inverse of its rest matrix there. A mesh that hangs from one joint gets that joint as its only bone.
    /// It has no blend shapes: nothing that a slider moves takes time for them.
    /// </remarks>
    internal sealed class ProxyRenderer
    {
        private readonly RendererData source;
        private readonly int[] joints;
        private readonly Mesh mesh;
        private readonly Vector3[] vertices, normals;
        private readonly Vector4[] tangents;
        private readonly Matrix4x4[] bindPoses;
        private readonly List<Gathered> gathered = new List<Gathered>();
        private readonly SkinnedMeshRenderer renderer;

        // A part whose vertices do not lie side by side: it is deformed apart, then put in its places.
        private struct Gathered
        {
            internal int[] Places;
            internal Vector3[] Vertices, Normals;
            internal Vector4[] Tangents;
        }

        /// <param name="outputs">Receives where the library writes the parts of this renderer, by part.</param>
        internal ProxyRenderer(AvatarData avatar, RendererData source, ProxySkeleton skeleton, MeshOutput[] outputs)
        {
            this.source = source;
            vertices = (Vector3[])source.ModelVertices.Clone();
            normals = source.ModelNormals == null ? null : (Vector3[])source.ModelNormals.Clone();
            tangents = source.ModelTangents == null ? null : (Vector4[])source.ModelTangents.Clone();
            foreach (PartData part in source.Parts)
                outputs[avatar.Parts.IndexOf(part)] = Output(part);

            mesh = Object.Instantiate(source.Mesh);
            mesh.name = source.Mesh.name + " (preview)";
            mesh.hideFlags = HideFlags.HideAndDontSave;
            mesh.ClearBlendShapes();
            mesh.MarkDynamic();
            // A made rig has bones that the hierarchy lacks: then the mesh stands as it is.
            joints = avatar.RigMade || source.Skin == null ? new[] { avatar.RigMade ? -1 : source.Joint } : source.Skin.Joints;
            if (joints.Length == 0)
                joints = new[] { -1 };
            if (avatar.RigMade || source.Skin == null || source.Skin.Joints.Length == 0)
                mesh.boneWeights = WholeWeights(vertices.Length);
            bindPoses = new Matrix4x4[joints.Length];

            var holder = new GameObject(source.Renderer.name) { hideFlags = HideFlags.HideAndDontSave };
            holder.layer = source.Renderer.gameObject.layer;
            holder.transform.SetParent(skeleton.Root, false);
            renderer = holder.AddComponent<SkinnedMeshRenderer>();
            renderer.sharedMesh = mesh;
            renderer.sharedMaterials = source.Renderer.sharedMaterials;
            renderer.rootBone = skeleton.Root;
            var bones = new Transform[joints.Length];
            for (int bone = 0; bone < bones.Length; bone++)
                bones[bone] = skeleton.Of(joints[bone]);
            renderer.bones = bones;
            renderer.localBounds = Around(vertices);
        }

        private MeshOutput Output(PartData part)
        {
            if (part.Vertices == null)
                return new MeshOutput
                {
                    FirstVertex = part.FirstVertex, VertexCount = part.VertexCount,
                    Positions = vertices, Normals = normals, Tangents = tangents
                };
            var apart = new Gathered
            {
                Places = part.Vertices,
                Vertices = new Vector3[part.VertexCount],
                Normals = normals == null ? null : new Vector3[part.VertexCount],
                Tangents = tangents == null ? null : new Vector4[part.VertexCount]
            };
            gathered.Add(apart);
            return new MeshOutput
            {
                VertexCount = part.VertexCount,
                Positions = apart.Vertices, Normals = apart.Normals, Tangents = apart.Tangents
            };
        }

        /// <summary>Shows what the library has written. Without garbage.</summary>
        internal void Show(ProxySkeleton skeleton)
        {
            for (int i = 0; i < gathered.Count; i++)
                Scatter(gathered[i]);
            mesh.SetVertices(vertices);
            if (normals != null)
                mesh.SetNormals(normals);
            if (tangents != null)
                mesh.SetTangents(tangents);
            for (int bone = 0; bone < bindPoses.Length; bone++)
                bindPoses[bone] = skeleton.InverseRest(joints[bone]);
            mesh.bindposes = bindPoses;
        }

        private void Scatter(Gathered part)
        {
            for (int i = 0; i < part.Places.Length; i++)
            {
                int place = part.Places[i];
                vertices[place] = part.Vertices[i];
                if (normals != null)
                    normals[place] = part.Normals[i];
                if (tangents != null)
                    tangents[place] = part.Tangents[i];
            }
        }

        /// <summary>Whether it is to be seen, where the avatar's renderer is.</summary>
        internal bool Visible
        {
            set
            {
                renderer.enabled = value && source.Renderer != null && source.Renderer.enabled
                    && source.Renderer.gameObject.activeInHierarchy;
            }
        }

        /// <summary>Materials may be exchanged while the preview is there.</summary>
        internal void FollowLook()
        {
            if (source.Renderer != null)
                renderer.sharedMaterials = source.Renderer.sharedMaterials;
        }

        internal void Destroy()
        {
            // The object goes with the skeleton's root; a mesh belongs to nobody.
            if (mesh != null)
                Object.DestroyImmediate(mesh);
        }

        private static BoneWeight[] WholeWeights(int count)
        {
            var weights = new BoneWeight[count];
            for (int i = 0; i < count; i++)
                weights[i].weight0 = 1;
            return weights;
        }

        // Twice the mesh's size: what a slider does stays inside, and Unity does not cull it.
        private static Bounds Around(Vector3[] points)
        {
            var bounds = new Bounds(points.Length > 0 ? points[0] : Vector3.zero, Vector3.zero);
            foreach (Vector3 point in points)
                bounds.Encapsulate(point);
            bounds.Expand(bounds.size.magnitude);
            return bounds;
        }
    }
}
