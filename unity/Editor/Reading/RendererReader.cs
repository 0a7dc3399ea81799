using System;
using System.Collections.Generic;
using Unity.Collections;
using UnityEngine;

namespace SuperDeform.Editor
{
    /// <summary>Reads one renderer: its mesh, its bones, its blend shapes.</summary>
    internal static class RendererReader
    {
        /// <summary>The mesh that a renderer shows; null for empty meshes and for renderers of other things.</summary>
        internal static Mesh MeshOf(Renderer renderer)
        {
            SkinnedMeshRenderer skinned = renderer as SkinnedMeshRenderer;
            MeshFilter filter = renderer is MeshRenderer ? renderer.GetComponent<MeshFilter>() : null;
            Mesh mesh = skinned != null ? skinned.sharedMesh : filter != null ? filter.sharedMesh : null;
            return mesh == null || mesh.vertexCount == 0 || mesh.subMeshCount == 0 ? null : mesh;
        }

        /// <summary>True where a transform moves the renderer's mesh.</summary>
        internal static bool Uses(Renderer renderer, Transform transform)
        {
            SkinnedMeshRenderer skinned = renderer as SkinnedMeshRenderer;
            if (skinned == null || skinned.bones.Length == 0) return Carrier(renderer) == transform;
            if (Array.IndexOf(skinned.bones, transform) >= 0) return true;
            return renderer.transform == transform && skinned.sharedMesh != null && skinned.sharedMesh.GetBonesPerVertex().Length == 0;
        }

        /// <summary>The transform that carries a mesh without bones.</summary>
        static Transform Carrier(Renderer renderer)
        {
            SkinnedMeshRenderer skinned = renderer as SkinnedMeshRenderer;
            // Unity draws skinned renderers in the space of their root bone.
            bool rooted = skinned != null && skinned.bones.Length == 0 && skinned.rootBone != null;
            return rooted ? skinned.rootBone : renderer.transform;
        }

        /// <summary>Reads bones, bind poses and weights.</summary>
        /// <param name="world">By joint, as the transforms stand.</param>
        internal static void ReadSkin(RendererData renderer, AvatarData data, Affine[] world)
        {
            SkinnedMeshRenderer skinned = renderer.Renderer as SkinnedMeshRenderer;
            Transform carrier = Carrier(renderer.Renderer);
            renderer.Joint = data.IndexOf(carrier);
            renderer.BoundsJoint = data.IndexOf(skinned != null && skinned.rootBone != null ? skinned.rootBone : renderer.Renderer.transform);
            if (skinned == null || skinned.bones.Length == 0) return;
            Transform[] bones = skinned.bones;
            Matrix4x4[] binds = renderer.Mesh.bindposes;
            var skin = new Skin
            {
                Joints = new int[bones.Length],
                InverseBinds = new Affine[bones.Length],
                Bounds = Box.Around(renderer.Vertices)
            };
            int own = data.IndexOf(renderer.Renderer.transform);
            skin.MeshToModel = own < 0 ? Affine.Identity : world[own];
            for (int bone = 0; bone < bones.Length; bone++)
            {
                skin.Joints[bone] = data.IndexOf(bones[bone]);
                skin.InverseBinds[bone] = bone < binds.Length ? Affine.Of(binds[bone]) : Affine.Identity;
            }
            if (ReadWeights(renderer, skin)) renderer.Skin = skin;
        }

        /// <summary>A transform that moves a renderer's mesh from outside of the avatar; null where none does.</summary>
        internal static Transform MoverOutside(Renderer renderer, Transform root)
        {
            SkinnedMeshRenderer skinned = renderer as SkinnedMeshRenderer;
            Transform[] movers = skinned == null || skinned.bones.Length == 0 ? new[] { Carrier(renderer) } : skinned.bones;
            return Array.Find(movers, mover => mover != null && !mover.IsChildOf(root));
        }

        /// <summary>
        /// Reads all influences of all vertices; false where the mesh has none. A vertex without any goes to the first bone.
        /// </summary>
        static bool ReadWeights(RendererData renderer, Skin skin)
        {
            int vertexCount = renderer.Vertices.Length;
            NativeArray<byte> counts = renderer.Mesh.GetBonesPerVertex();
            if (counts.Length != vertexCount) return false;
            NativeArray<BoneWeight1> all = renderer.Mesh.GetAllBoneWeights();
            int spare = Math.Max(0, Array.FindIndex(skin.Joints, joint => joint >= 0));
            if (skin.Joints[spare] < 0)
            {
                renderer.Unmoved = vertexCount;
                return false;
            }
            uint[] starts = new uint[vertexCount + 1];
            var bones = new List<uint>(all.Length);
            var weights = new List<float>(all.Length);
            int next = 0;
            for (int vertex = 0; vertex < vertexCount; vertex++)
            {
                bool lost = false;
                for (int end = next + counts[vertex]; next < end; next++)
                {
                    BoneWeight1 influence = all[next];
                    int bone = influence.boneIndex;
                    bool known = bone >= 0 && bone < skin.Joints.Length && skin.Joints[bone] >= 0;
                    lost |= !known && influence.weight > 0f;
                    if (!known || influence.weight == 0f) continue;
                    bones.Add((uint)bone);
                    weights.Add(influence.weight);
                }
                if (weights.Count == starts[vertex])
                {
                    bones.Add((uint)spare);
                    weights.Add(1f);
                }
                if (lost) renderer.Unmoved++;
                starts[vertex + 1] = (uint)weights.Count;
            }
            renderer.RowStarts = starts;
            renderer.RowWeights = weights.ToArray();
            // Bones for now; joints from Place on.
            renderer.RowJoints = bones.ToArray();
            return true;
        }

        /// <summary>How many vertices some joints move, counting shares; before Place.</summary>
        internal static double Held(RendererData renderer, bool[] byJoint)
        {
            if (renderer.Skin == null) return renderer.Joint >= 0 && byJoint[renderer.Joint] ? renderer.Vertices.Length : 0;
            double held = 0;
            for (int row = 0; row < renderer.RowJoints.Length; row++)
            {
                int joint = renderer.Skin.Joints[renderer.RowJoints[row]];
                if (joint >= 0 && byJoint[joint]) held += renderer.RowWeights[row];
            }
            return held;
        }

        /// <summary>Marks the joints that move vertices of a renderer.</summary>
        internal static void MarkUsed(RendererData renderer, bool[] byJoint)
        {
            if (renderer.Skin == null)
            {
                if (renderer.Joint >= 0) byJoint[renderer.Joint] = true;
                return;
            }
            bool placed = renderer.ModelVertices != null;
            foreach (uint row in renderer.RowJoints)
            {
                int joint = placed ? (int)row : renderer.Skin.Joints[row];
                if (joint >= 0) byJoint[joint] = true;
            }
        }

        /// <summary>Brings the mesh to the avatar's space at rest.</summary>
        /// <param name="rest">By joint.</param>
        internal static void Place(RendererData renderer, Affine[] rest)
        {
            Vector3[] normals = renderer.Mesh.normals;
            Vector4[] tangents = renderer.Mesh.tangents;
            int count = renderer.Vertices.Length;
            renderer.Normals = normals.Length == count ? normals : null;
            renderer.Tangents = tangents.Length == count ? tangents : null;
            Skin skin = renderer.Skin;
            if (skin == null)
            {
                renderer.Placement = rest[renderer.Joint];
            }
            else
            {
                renderer.Placement = skin.Common;
                if (!skin.Uniform) renderer.Placements = Blend(renderer, skin);
                for (int row = 0; row < renderer.RowJoints.Length; row++)
                {
                    renderer.RowJoints[row] = (uint)skin.Joints[renderer.RowJoints[row]];
                }
            }
            bool plain = renderer.Placements == null && renderer.Placement.Equals(Affine.Identity);
            var frames = new FrameSource(renderer);
            renderer.ModelVertices = plain ? renderer.Vertices : new Vector3[count];
            renderer.ModelNormals = plain && AreUnit(renderer.Normals) ? renderer.Normals : renderer.Normals == null ? null : new Vector3[count];
            renderer.ModelTangents = plain && AreUnit(renderer.Tangents) ? renderer.Tangents : renderer.Tangents == null ? null : new Vector4[count];
            bool ownNormals = renderer.ModelNormals != renderer.Normals, ownTangents = renderer.ModelTangents != renderer.Tangents;
            if (plain && !ownNormals && !ownTangents) return;
            double scale;
            Frame frame = frames.At(0);
            for (int vertex = 0; vertex < count; vertex++)
            {
                if (frames.EachItsOwn) frame = frames.At(vertex);
                if (!plain) renderer.ModelVertices[vertex] = frame.Point(renderer.Vertices[vertex]);
                if (ownNormals) renderer.ModelNormals[vertex] = frame.Normal(renderer.Normals[vertex], out scale);
                if (ownTangents) renderer.ModelTangents[vertex] = frame.Tangent(renderer.Tangents[vertex], out scale);
            }
        }

        static bool AreUnit(Vector3[] vectors)
        {
            if (vectors == null) return true;
            foreach (Vector3 v in vectors)
            {
                if (!(Math.Abs((double)v.x * v.x + (double)v.y * v.y + (double)v.z * v.z - 1) < 1e-4)) return false;
            }
            return true;
        }

        static bool AreUnit(Vector4[] vectors)
        {
            if (vectors == null) return true;
            foreach (Vector4 v in vectors)
            {
                if (!(Math.Abs((double)v.x * v.x + (double)v.y * v.y + (double)v.z * v.z - 1) < 1e-4)) return false;
            }
            return true;
        }

        /// <summary>The matrix of each vertex, where bones are bound in different poses.</summary>
        static Affine[] Blend(RendererData renderer, Skin skin)
        {
            Affine[] placements = new Affine[renderer.Vertices.Length];
            for (int vertex = 0; vertex < placements.Length; vertex++)
            {
                uint from = renderer.RowStarts[vertex], to = renderer.RowStarts[vertex + 1];
                double sum = 0;
                for (uint row = from; row < to; row++)
                {
                    sum += renderer.RowWeights[row];
                }
                var blended = new Affine();
                for (uint row = from; row < to; row++)
                {
                    blended.Add(ref skin.ByBone[renderer.RowJoints[row]], renderer.RowWeights[row] / sum);
                }
                placements[vertex] = Math.Abs(blended.Determinant) > 1e-30 ? blended : skin.Common;
            }
            return placements;
        }

        /// <summary>Gives the library's mesh the weights of a part.</summary>
        /// <param name="twins">By joint, the one whose weights they are; null: each its own.</param>
        internal static void GiveWeights(PartData part, MeshArrays mesh, int[] twins)
        {
            TakeWeights(part, mesh);
            if (twins == null || !Array.Exists(mesh.Joints, joint => twins[joint] != joint)) return;
            // The renderer's own rows stay: they name its bones.
            mesh.Joints = Array.ConvertAll(mesh.Joints, joint => (uint)twins[joint]);
        }

        static void TakeWeights(PartData part, MeshArrays mesh)
        {
            RendererData renderer = part.Renderer;
            if (renderer.Skin == null)
            {
                mesh.InfluenceCount = 1;
                mesh.Joints = new uint[part.Start + part.VertexCount];
                mesh.Weights = new float[mesh.Joints.Length];
                for (int vertex = part.Start; vertex < mesh.Joints.Length; vertex++)
                {
                    mesh.Joints[vertex] = (uint)renderer.Joint;
                    mesh.Weights[vertex] = 1f;
                }
            }
            else if (part.Vertices == null)
            {
                mesh.RowStarts = renderer.RowStarts;
                mesh.Joints = renderer.RowJoints;
                mesh.Weights = renderer.RowWeights;
            }
            else
            {
                GatherRows(part, mesh);
            }
        }

        static void GatherRows(PartData part, MeshArrays mesh)
        {
            RendererData renderer = part.Renderer;
            var joints = new List<uint>();
            var weights = new List<float>();
            mesh.RowStarts = new uint[part.VertexCount + 1];
            for (int vertex = 0; vertex < part.VertexCount; vertex++)
            {
                int source = part.Vertices[vertex];
                for (uint row = renderer.RowStarts[source]; row < renderer.RowStarts[source + 1]; row++)
                {
                    joints.Add(renderer.RowJoints[row]);
                    weights.Add(renderer.RowWeights[row]);
                }
                mesh.RowStarts[vertex + 1] = (uint)weights.Count;
            }
            mesh.Joints = joints.ToArray();
            mesh.Weights = weights.ToArray();
        }

        /// <summary>Lists all frames of all blend shapes.</summary>
        internal static void ReadFrames(RendererData renderer)
        {
            Mesh mesh = renderer.Mesh;
            for (int shape = 0; shape < mesh.blendShapeCount; shape++)
            {
                for (int frame = 0; frame < mesh.GetBlendShapeFrameCount(shape); frame++)
                {
                    float weight = mesh.GetBlendShapeFrameWeight(shape, frame);
                    renderer.Frames.Add(new BlendFrame { ShapeName = mesh.GetBlendShapeName(shape), Shape = shape, Frame = frame, Weight = weight });
                }
            }
        }

        /// <summary>Reads the blend shapes that are on, as one; none where all are off.</summary>
        internal static void ReadWorn(RendererData renderer)
        {
            SkinnedMeshRenderer skinned = renderer.Shown as SkinnedMeshRenderer;
            if (skinned == null) return;
            int count = renderer.Vertices.Length;
            Vector3[] positions = null, normals = null, places = null, turns = null, tangents = null;
            for (int shape = 0; shape < renderer.Mesh.blendShapeCount; shape++)
            {
                float weight = skinned.GetBlendShapeWeight(shape);
                if (weight == 0f) continue;
                if (positions == null)
                {
                    positions = new Vector3[count];
                    normals = new Vector3[count];
                    places = new Vector3[count];
                    turns = new Vector3[count];
                    tangents = new Vector3[count];
                }
                foreach (KeyValuePair<int, float> part in FrameShares(renderer.Mesh, shape, weight))
                {
                    renderer.Mesh.GetBlendShapeFrameVertices(shape, part.Key, places, turns, tangents);
                    for (int vertex = 0; vertex < count; vertex++)
                    {
                        positions[vertex] += places[vertex] * part.Value;
                        normals[vertex] += turns[vertex] * part.Value;
                    }
                }
            }
            if (positions == null) return;
            renderer.Worn = new BlendDeltas { Positions = positions, Normals = renderer.Normals != null && Any(normals) ? normals : null };
        }

        /// <summary>
        /// The frames of a shape that a weight lies between, and how much of each it is; beyond the ends it goes on in a line, as
        /// Unity does where weights are not clamped.
        /// </summary>
        internal static List<KeyValuePair<int, float>> FrameShares(Mesh mesh, int shape, float weight)
        {
            var shares = new List<KeyValuePair<int, float>>();
            int last = mesh.GetBlendShapeFrameCount(shape) - 1, frame = 0;
            while (frame < last && weight > mesh.GetBlendShapeFrameWeight(shape, frame))
            {
                frame++;
            }
            float high = mesh.GetBlendShapeFrameWeight(shape, frame), low = frame == 0 ? 0 : mesh.GetBlendShapeFrameWeight(shape, frame - 1);
            float along = high == low ? 1 : (weight - low) / (high - low);
            shares.Add(new KeyValuePair<int, float>(frame, along));
            if (frame > 0) shares.Add(new KeyValuePair<int, float>(frame - 1, 1 - along));
            return shares;
        }

        static bool Any(Vector3[] deltas)
        {
            foreach (Vector3 delta in deltas)
            {
                if (delta.x != 0 || delta.y != 0 || delta.z != 0) return true;
            }
            return false;
        }
    }
}
