using System;
using System.Collections.Generic;
using UnityEngine;

namespace SuperDeform.Editor
{
    /// <summary>An avatar as the library sees it: everything in the space of the avatar's root, at rest.</summary>
    public sealed class AvatarData : IDisposable
    {
        public GameObject Root;

        /// <summary>The animator with the humanoid Avatar, on the root or below; null where there is none.</summary>
        public Animator Animator;

        /// <summary>
        /// All transforms below the root, every parent before its children; the root itself comes first where a mesh hangs
        /// from it.
        /// </summary>
        public Transform[] Joints;

        /// <summary>By joint: its parent; -1 for children of the root.</summary>
        public int[] Parents;

        /// <summary>
        /// By joint: the joint of the body that it moves with, where an outfit brings an armature of its own; else itself.
        /// </summary>
        public int[] Twins;

        /// <summary>
        /// By joint: its parent as a build will have it, with outfits merged and accessories under their bones; in any order.
        /// </summary>
        public int[] MergedParents;

        /// <summary>
        /// By joint: the joint that holds the pet that it is of, a humanoid that is neither the avatar nor an outfit; else -1. A pet
        /// keeps its shape, and grows with the avatar's height.
        /// </summary>
        public int[] PetOf;

        /// <summary>By joint: its transform to its parent's space, as it stands.</summary>
        public Affine[] Local;

        /// <summary>By joint: joint space to the root's space, at rest.</summary>
        public Affine[] Rest;

        /// <summary>
        /// By HumanBodyBones: the joint that the avatar says plays the role; -1 where it does not say.
        /// </summary>
        public int[] Roles;

        /// <summary>In the order of the hierarchy.</summary>
        public readonly List<RendererData> Renderers = new List<RendererData>();

        /// <summary>The library's meshes, in the library's order.</summary>
        public readonly List<PartData> Parts = new List<PartData>();

        /// <summary>Ready for a deformer.</summary>
        public Character Character;

        /// <summary>
        /// False where the avatar came without bones: its joints are then all of a made rig, and none of Joints.
        /// </summary>
        public bool Rigged;

        /// <summary>True where the library has made a rig.</summary>
        public bool RigMade;

        /// <summary>True where blend shapes that are on were read as one frame, which belongs to what is shown.</summary>
        public bool AsWorn;

        /// <summary>Warnings and notes about the avatar.</summary>
        public readonly List<Finding> Findings = new List<Finding>();

        internal readonly Dictionary<Transform, int> JointOf = new Dictionary<Transform, int>();

        /// <summary>True where the root is the first of Joints. It never moves.</summary>
        public bool HoldsRoot => Joints.Length > 0 && Joints[0] == Root.transform;

        /// <summary>
        /// The joint that a transform is; -1 for the root where it is none, and for what is not below the root.
        /// </summary>
        public int IndexOf(Transform transform) => transform != null && JointOf.TryGetValue(transform, out int joint) ? joint : -1;

        public void Dispose()
        {
            if (Character != null) Character.Dispose();
        }
    }
}
