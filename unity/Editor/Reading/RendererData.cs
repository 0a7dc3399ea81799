using System.Collections.Generic;
using UnityEngine;

namespace SuperDeform.Editor
{
    /// <summary>One renderer of an avatar and what its mesh holds.</summary>
    public sealed class RendererData
    {
        public Renderer Renderer;

        /// <summary>The one whose mesh, materials and blend shapes are read: itself, or what stands for it in a preview.</summary>
        public Renderer Shown;

        /// <summary>The avatar's own mesh, or what is shown for it; never changed.</summary>
        public Mesh Mesh;

        /// <summary>
        /// The joint that carries the mesh where Skin is null; -1 where the avatar comes without joints.
        /// </summary>
        public int Joint;

        /// <summary>Bones and bind poses; null for a mesh that one joint carries.</summary>
        public Skin Skin;

        /// <summary>Mesh space, one a vertex; Normals and Tangents null where the mesh has none.</summary>
        public Vector3[] Vertices, Normals;
        public Vector4[] Tangents;

        /// <summary>The same at rest in the avatar's space; the same arrays where Placement is the identity.</summary>
        public Vector3[] ModelVertices, ModelNormals;
        public Vector4[] ModelTangents;

        /// <summary>Mesh space to the avatar's space at rest, where it is the same for all vertices.</summary>
        public Affine Placement;

        /// <summary>By vertex, where bones are bound in different poses; else null.</summary>
        public Affine[] Placements;

        /// <summary>
        /// Weights as rows: vertex v has RowStarts[v] to RowStarts[v + 1] - 1. Joints are the avatar's.
        /// </summary>
        public uint[] RowStarts, RowJoints;
        public float[] RowWeights;

        /// <summary>How many vertices bones should move that are missing.</summary>
        internal int Unmoved;

        /// <summary>All frames of all blend shapes, in order; empty where blend shapes were not read.</summary>
        public readonly List<BlendFrame> Frames = new List<BlendFrame>();

        /// <summary>What the blend shapes that are on add together; null where they were not asked for, or none is on.</summary>
        public BlendDeltas Worn;

        public readonly List<PartData> Parts = new List<PartData>();

        /// <summary>True for a pet's mesh: it stays as it is, and goes where its bones go.</summary>
        public bool Rides;

        /// <summary>The joint in whose space Unity keeps the renderer's bounds; -1: the avatar's root.</summary>
        public int BoundsJoint;
    }
}
