using System;
using System.Collections.Generic;
using UnityEngine;

namespace SuperDeform.Editor
{
    /// <summary>
    /// Reads an avatar into the library: all transforms below its root as joints, all meshes at rest, in the root's space.
    ///
    /// The rest pose is the one that the meshes were bound in, as their bind poses tell; where that is far from a T or A pose
    /// and the avatar stands in one, it is the one that it stands in.
    /// </summary>
    public static class CharacterReader
    {
        static readonly float[] Up = { 0, 1, 0 };

        /// <summary>Reads an avatar; nothing of it is changed.</summary>
        /// <param name="avatar">The root, an object of a scene or a prefab.</param>
        /// <param name="options">What is read, and what is done where there is no rig.</param>
        /// <returns>A character that is ready for a deformer, with a rig that was made where there was none.</returns>
        /// <exception cref="ConversionException">It cannot be read; the finding says why and often mends it.</exception>
        public static AvatarData Read(GameObject avatar, ReadOptions options)
        {
            if (avatar == null) throw new ConversionException(new Finding("no_avatar", Severity.Error, null));
            var data = new AvatarData { Root = avatar, AsWorn = options.AsWorn && !options.WithMorphs };
            try
            {
                SuperDeformLibrary.Check();
                data.Animator = HumanoidRoles.Speaker(avatar);
                ReadRenderers(data, options.Shown);
                ReadJoints(data);
                ReadSkins(data);
                ReadPose(data);
                // What is hidden by a scale of 0 stays as it is: there is no way back from a point.
                data.Renderers.RemoveAll(renderer => renderer.Skin == null && !data.Rest[renderer.Joint].IsInvertible);
                foreach (RendererData renderer in data.Renderers)
                {
                    RendererReader.Place(renderer, data.Rest);
                    if (options.WithMorphs) RendererReader.ReadFrames(renderer);
                    else if (data.AsWorn) RendererReader.ReadWorn(renderer);
                    renderer.Parts.AddRange(SubmeshParts.Of(renderer));
                    data.Parts.AddRange(renderer.Parts);
                }
                MakeCharacter(data, options);
                return data;
            }
            catch (Exception cause)
            {
                data.Dispose();
                throw ConversionException.From(cause, avatar);
            }
        }

        /// <summary>
        /// The joints of an avatar at rest and the roles that they play, without its meshes; for checks.
        /// </summary>
        internal static AvatarData ReadSkeleton(GameObject avatar)
        {
            var data = new AvatarData { Root = avatar, Animator = HumanoidRoles.Speaker(avatar) };
            ReadRenderers(data, null);
            ReadJoints(data);
            ReadSkins(data);
            ReadPose(data);
            return data;
        }

        static void ReadRenderers(AvatarData data, Dictionary<Renderer, Renderer> shown)
        {
            foreach (Renderer renderer in data.Root.GetComponentsInChildren<Renderer>(true))
            {
                if (shown == null || !shown.TryGetValue(renderer, out Renderer instead) || instead == null) instead = renderer;
                Mesh mesh = RendererReader.MeshOf(instead);
                if (mesh == null) continue;
                Transform outside = RendererReader.MoverOutside(renderer, data.Root.transform);
                if (outside != null)
                {
                    data.Findings.Add(new Finding("bone_outside", Severity.Warning, renderer, renderer.name, outside.name, data.Root.name));
                    continue;
                }
                if (!mesh.isReadable) throw new ConversionException(Readability.NotReadable(mesh, renderer));
                data.Renderers.Add(new RendererData { Renderer = renderer, Shown = instead, Mesh = mesh, Vertices = mesh.vertices });
            }
            if (data.Renderers.Count == 0) throw new ConversionException(new Finding("no_mesh", Severity.Error, data.Root, data.Root.name));
        }

        static void ReadJoints(AvatarData data)
        {
            var joints = new List<Transform>(data.Root.GetComponentsInChildren<Transform>(true));
            bool rootUsed = data.Renderers.Exists(renderer => RendererReader.Uses(renderer.Renderer, data.Root.transform));
            if (!rootUsed) joints.Remove(data.Root.transform);
            data.Joints = joints.ToArray();
            for (int joint = 0; joint < joints.Count; joint++)
            {
                data.JointOf[joints[joint]] = joint;
            }
            data.Parents = new int[joints.Count];
            data.Local = new Affine[joints.Count];
            for (int joint = 0; joint < joints.Count; joint++)
            {
                bool isRoot = joints[joint] == data.Root.transform;
                data.Parents[joint] = isRoot ? -1 : data.IndexOf(joints[joint].parent);
                data.Local[joint] = isRoot ? Affine.Identity : Affine.Local(joints[joint]);
            }
            Transform[] roles = HumanoidRoles.Of(data.Animator);
            data.Roles = new int[HumanoidRoles.Count];
            for (int role = 0; role < roles.Length; role++)
            {
                data.Roles[role] = data.IndexOf(roles[role]);
            }
        }

        static void ReadSkins(AvatarData data)
        {
            Affine[] world = World(data);
            foreach (RendererData renderer in data.Renderers)
            {
                RendererReader.ReadSkin(renderer, data, world);
            }
        }

        static void ReadPose(AvatarData data)
        {
            Affine[] world = World(data);
            var skins = new List<Skin>();
            foreach (RendererData renderer in data.Renderers)
            {
                if (renderer.Skin != null) skins.Add(renderer.Skin);
            }
            RestPose bound = RestPose.OfBindPoses(data.Parents, data.Local, world, skins);
            data.Rest = bound.Rest;
            if (!bound.Differs) return;
            double boundAngle = PoseMeasure.Of(data.Roles, bound.Rest).Degrees;
            double standingAngle = PoseMeasure.Of(data.Roles, world).Degrees;
            if (boundAngle > PoseMeasure.Limit && standingAngle < boundAngle - PoseMeasure.Clearly)
            {
                data.Rest = RestPose.Standing(data.Parents, world, skins).Rest;
                return;
            }
            data.Findings.Add(new Finding("pose_not_rest", Severity.Info, data.Root, data.Root.name));
        }

        /// <summary>By joint: its transform to the root's space, as it stands.</summary>
        static Affine[] World(AvatarData data)
        {
            Affine[] world = new Affine[data.Joints.Length];
            for (int joint = 0; joint < world.Length; joint++)
            {
                int parent = data.Parents[joint];
                world[joint] = parent < 0 ? data.Local[joint] : world[parent] * data.Local[joint];
            }
            return world;
        }

        static void MakeCharacter(AvatarData data, ReadOptions options)
        {
            bool skinned = data.Renderers.Exists(renderer => renderer.Skin != null);
            int[] roles = GuessedRoles.Of(data, true);
            HumanBodyBones? missing = HumanoidRoles.Missing(role => roles[role] >= 0);
            // Transforms that only hold meshes may be called like joints.
            data.Rigged = skinned || missing == null;
            data.RigMade = options.RigAuto || missing != null;
            if (missing != null && skinned && !options.RigAuto)
            {
                throw new ConversionException(AvatarChecks.NotHumanoid(data, missing.Value, Severity.Error));
            }
            Double3 forward = data.Rigged ? Facing.Of(roles, data.Rest) : new Double3(0, 0, 1);
            data.Character = new Character(Up, new[] { (float)forward.X, (float)forward.Y, (float)forward.Z });
            Outfits.Find(data, roles);
            Pets.Find(data);
            foreach (RendererData renderer in data.Renderers)
            {
                renderer.Rides = Pets.Moves(data, renderer);
                if (renderer.Rides) renderer.Parts.Clear();
            }
            data.Parts.RemoveAll(part => part.Renderer.Rides);
            for (int part = 0; part < data.Parts.Count; part++)
            {
                data.Parts[part].Index = part;
            }
            if (data.Rigged) data.Character.SetSkeleton(Skeleton(data, EyeBones.Added(data, roles)));
            AddMeshes(data);
            AddMorphTargets(data);
            if (!data.RigMade) return;
            Options rig = options.RigOptions == null ? new Options() : options.RigOptions.Clone();
            rig.RigLeftHanded = true;
            data.Character.Rig(rig, options.RigProgress);
        }

        static SkeletonArrays Skeleton(AvatarData data, int[] roles)
        {
            var skeleton = new SkeletonArrays
            {
                Names = Array.ConvertAll(data.Joints, joint => joint.name),
                Parents = data.MergedParents,
                RestMatrices = new double[16 * data.Joints.Length],
                RoleJoints = roles
            };
            for (int joint = 0; joint < data.Joints.Length; joint++)
            {
                data.Rest[joint].ToColumns(skeleton.RestMatrices, 16 * joint);
            }
            return skeleton;
        }

        static void AddMeshes(AvatarData data)
        {
            var surfaces = new PaintedSurfaces(data.Character);
            foreach (PartData part in data.Parts)
            {
                RendererData renderer = part.Renderer;
                var mesh = new MeshArrays
                {
                    Name = part.Name,
                    FirstVertex = part.Start,
                    VertexCount = part.VertexCount,
                    Positions = part.Gather(renderer.ModelVertices),
                    Normals = part.Gather(renderer.ModelNormals),
                    Tangents = part.Gather(renderer.ModelTangents),
                    Indices = part.Indices
                };
                surfaces.Show(part, mesh);
                if (data.Rigged) RendererReader.GiveWeights(part, mesh, data.Twins);
                data.Character.AddMesh(mesh);
            }
        }

        /// <summary>Gives the character what is worn, and the blend shapes that say something of it; others cross when they are written.</summary>
        static void AddMorphTargets(AvatarData data)
        {
            foreach (RendererData renderer in data.Renderers)
            {
                if (renderer.Worn != null) AddWorn(data, renderer);
                List<BlendFrame> read = renderer.Frames.FindAll(frame => Character.ReadsMorphTarget(frame.ShapeName));
                if (read.Count == 0 || renderer.Parts.Count == 0) continue;
                var placer = new FramePlacer(renderer);
                BlendDeltas deltas = BlendDeltas.Of(renderer.Vertices.Length);
                foreach (BlendFrame frame in read)
                {
                    deltas.Read(renderer.Mesh, frame);
                    Vector3[] positions = placer.ToModel(deltas.Positions, Change.Place);
                    renderer.Parts.ForEach(part => AddTarget(data, part, frame.ShapeName, positions, null));
                }
            }
        }

        static void AddWorn(AvatarData data, RendererData renderer)
        {
            var placer = new FramePlacer(renderer);
            Vector3[] positions = placer.ToModel(renderer.Worn.Positions, Change.Place), normals = placer.ToModel(renderer.Worn.Normals, Change.Normal);
            foreach (PartData part in renderer.Parts)
            {
                part.WornMoves = FramePlacer.Changes(positions, part);
                part.WornTurns = FramePlacer.Changes(normals, part);
                AddTarget(data, part, "as worn", positions, part.WornTurns ? normals : null);
            }
        }

        static void AddTarget(AvatarData data, PartData part, string name, Vector3[] positions, Vector3[] normals)
        {
            data.Character.AddMorphTarget(part.Index, new MorphArrays
            {
                Name = name, FirstVertex = part.Start, Positions = part.Gather(positions), Normals = part.Gather(normals)
            });
        }
    }
}
