using System;
using UnityEngine;

namespace SuperDeform.Editor
{
    /// <summary>The roles of joints whose avatar does not tell them: the library's guess from names and shape.</summary>
    internal static class GuessedRoles
    {
        /// <summary>
        /// By HumanBodyBones: the joint that the avatar says or the library guesses to play the role; -1 where neither does.
        /// </summary>
        /// <param name="data">Where the library guesses something odd, its findings say so.</param>
        /// <param name="withMeshes">The meshes are placed: feet and noses help to tell front from back.</param>
        internal static int[] Of(AvatarData data, bool withMeshes)
        {
            if (HumanoidRoles.Missing(role => data.Roles[role] >= 0) == null) return data.Roles;
            // The library tells left from right as in right-handed axes, so it is shown Unity's world in a mirror.
            using (var mirrored = new Character(new float[] { 0, 1, 0 }, null))
            {
                mirrored.SetSkeleton(Mirrored(data));
                foreach (PartData part in data.Parts)
                {
                    if (withMeshes) mirrored.AddMesh(Mirrored(part));
                }
                HumanoidRole[] found = mirrored.GetJoints().Roles;
                int[] roles = new int[HumanoidRoles.Count];
                for (int role = 0; role < roles.Length; role++)
                {
                    roles[role] = Array.IndexOf(found, (HumanoidRole)role);
                }
                // Of joints that make no body nobody wants to know.
                if (HumanoidRoles.Missing(role => roles[role] >= 0) != null) return roles;
                foreach (Warning warning in mirrored.Warnings)
                {
                    data.Findings.Add(LibraryWarnings.Of(warning, data.Root));
                }
                return roles;
            }
        }

        static SkeletonArrays Mirrored(AvatarData data)
        {
            var skeleton = new SkeletonArrays
            {
                Names = Array.ConvertAll(data.Joints, joint => joint.name),
                Parents = data.Parents,
                RestMatrices = new double[16 * data.Joints.Length],
                RoleJoints = data.Roles
            };
            for (int joint = 0; joint < data.Joints.Length; joint++)
            {
                // Places tell roles; axes do not.
                Double3 place = data.Rest[joint].Position;
                Affine.Translation(new Double3(-place.X, place.Y, place.Z)).ToColumns(skeleton.RestMatrices, 16 * joint);
            }
            return skeleton;
        }

        static MeshArrays Mirrored(PartData part)
        {
            var mesh = new MeshArrays
            {
                Name = part.Name,
                FirstVertex = part.Start,
                VertexCount = part.VertexCount,
                Positions = Array.ConvertAll(part.Gather(part.Renderer.ModelVertices), p => new Vector3(-p.x, p.y, p.z)),
                Indices = part.Indices
            };
            RendererReader.GiveWeights(part, mesh, null);
            return mesh;
        }
    }
}
