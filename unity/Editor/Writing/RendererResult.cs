using System;
using System.Collections.Generic;
using UnityEngine;

namespace SuperDeform.Editor
{
    /// <summary>
    /// What becomes of one renderer. The arrays are made once and written anew by each AvatarResult.Apply.
    /// </summary>
    public sealed class RendererResult
    {
        public readonly RendererData Source;

        /// <summary>
        /// One a vertex, in mesh space (in the root's where it stays at rest); Normals and Tangents null where the mesh has none.
        /// </summary>
        public readonly Vector3[] Positions, Normals;
        public readonly Vector4[] Tangents;

        /// <summary>Mesh space to bone space, a bone; null for a mesh that one joint carries.</summary>
        public readonly Matrix4x4[] BindPoses;

        internal readonly List<PartResult> Parts = new List<PartResult>();

        /// <summary>
        /// The boxes around all vertices in the space that Unity keeps the bounds in, before and after.
        /// </summary>
        internal Box OldBox, NewBox;

        // The way back to mesh space, for the frames of blend shapes.
        BackFrames back;
        bool sameWay;
        readonly double[] normalScales, tangentScales;
        readonly bool[] normalKept, tangentKept;

        internal RendererResult(RendererData source)
        {
            Source = source;
            int count = source.Vertices.Length;
            Positions = new Vector3[count];
            Normals = source.Normals == null ? null : new Vector3[count];
            Tangents = source.Tangents == null ? null : new Vector4[count];
            if (source.Skin != null) BindPoses = Array.ConvertAll(source.Skin.InverseBinds, bind => bind.ToMatrix4x4());
            foreach (PartData part in source.Parts)
            {
                Parts.Add(new PartResult(part, this));
            }
            if (source.Frames.Count == 0) return;
            normalScales = new double[count];
            tangentScales = new double[count];
            normalKept = new bool[count];
            tangentKept = new bool[count];
        }

        /// <summary>
        /// Brings what the library wrote to its places; all vertices are then at rest in the avatar's space.
        /// </summary>
        internal void Spread()
        {
            foreach (PartResult part in Parts)
            {
                part.Spread();
            }
        }

        /// <summary>Adds what is worn, where the source was read so.</summary>
        internal void Wear()
        {
            if (Source.Worn == null) return;
            foreach (PartResult part in Parts)
            {
                if (!part.Part.WornMoves) continue;
                bool turns = Normals != null && part.Output.MorphNormals != null;
                for (int vertex = 0; vertex < part.Part.VertexCount; vertex++)
                {
                    int place = part.Part.VertexOf(vertex);
                    Positions[place] += PartResult.Worn(part.Output.MorphPositions, vertex);
                    if (turns) Normals[place] = (Normals[place] + PartResult.Worn(part.Output.MorphNormals, vertex)).normalized;
                }
            }
        }

        /// <summary>Brings a mesh that rides along to where its pet is, in the avatar's space.</summary>
        internal void Ride(AvatarData avatar, Affine[] newRest)
        {
            int pet = avatar.PetOf[Source.Skin == null ? Source.Joint : Array.Find(Source.Skin.Joints, joint => joint >= 0 && avatar.PetOf[joint] >= 0)];
            Affine way = newRest[pet] * avatar.Rest[pet].Inverse;
            for (int vertex = 0; vertex < Positions.Length; vertex++)
            {
                Positions[vertex] = way.Point(Double3.Of(Source.ModelVertices[vertex])).ToVector3();
            }
            if (Normals != null) Array.Copy(Source.ModelNormals, Normals, Normals.Length);
            if (Tangents != null) Array.Copy(Source.ModelTangents, Tangents, Tangents.Length);
        }

        /// <summary>Measures the boxes before and after.</summary>
        /// <param name="oldJoint">The joint that the bounds are kept in, at rest, before.</param>
        /// <param name="newJoint">The same, after.</param>
        internal void Measure(Affine oldJoint, Affine newJoint)
        {
            OldBox = Box.Around(Source.ModelVertices, oldJoint.Inverse);
            NewBox = Box.Around(Positions, newJoint.Inverse);
        }

        /// <summary>Brings vertices from the avatar's space to mesh space. What has not changed keeps its bits.</summary>
        /// <param name="oldRest">By joint: where it rests before.</param>
        /// <param name="newRest">By joint: where it rests after.</param>
        internal void ToMeshSpace(Affine[] oldRest, Affine[] newRest)
        {
            sameWay = Source.Skin != null || newRest[Source.Joint].Equals(oldRest[Source.Joint]);
            back = new BackFrames(Source, sameWay ? Source.Placement : newRest[Source.Joint]);
            bool plain = sameWay && back.IsIdentity;
            bool plainNormals = plain && normalScales == null && Source.ModelNormals == Source.Normals;
            bool plainTangents = plain && normalScales == null && Source.ModelTangents == Source.Tangents;
            if (plain && plainNormals && plainTangents) return;
            Frame frame = back.At(0);
            for (int vertex = 0; vertex < Positions.Length; vertex++)
            {
                if (back.EachItsOwn) frame = back.At(vertex);
                if (!plain) Positions[vertex] = Point(ref frame, vertex);
                if (Normals != null && !plainNormals) Normals[vertex] = Normal(ref frame, vertex);
                if (Tangents != null && !plainTangents) Tangents[vertex] = Tangent(ref frame, vertex);
            }
        }

        Vector3 Point(ref Frame frame, int vertex)
        {
            bool kept = sameWay && Same(Positions[vertex], Source.ModelVertices[vertex]);
            return kept ? Source.Vertices[vertex] : frame.Point(Positions[vertex]);
        }

        Vector3 Normal(ref Frame frame, int vertex)
        {
            Vector3 normal = frame.Normal(Normals[vertex], out double scale);
            bool kept = sameWay && Same(Normals[vertex], Source.ModelNormals[vertex]);
            if (normalScales != null)
            {
                normalScales[vertex] = scale;
                normalKept[vertex] = kept;
            }
            return kept ? Source.Normals[vertex] : normal;
        }

        Vector4 Tangent(ref Frame frame, int vertex)
        {
            Vector4 given = Tangents[vertex], before = Source.ModelTangents[vertex];
            Vector4 tangent = frame.Tangent(given, out double scale);
            bool kept = sameWay && given.x == before.x && given.y == before.y && given.z == before.z && given.w == before.w;
            if (tangentScales != null)
            {
                tangentScales[vertex] = scale;
                tangentKept[vertex] = kept;
            }
            return kept ? Source.Tangents[vertex] : tangent;
        }

        static bool Same(Vector3 one, Vector3 other) => one.x == other.x && one.y == other.y && one.z == other.z;

        /// <summary>What a blend shape adds to one vertex, in mesh space, after ToMeshSpace. What has not changed keeps its bits.</summary>
        /// <param name="delta">In the avatar's space.</param>
        /// <param name="given">What the source's shape adds, in mesh space.</param>
        /// <param name="placed">The same in the avatar's space.</param>
        internal Vector3 ToMesh(Vector3 delta, int vertex, Change change, Vector3 given, Vector3 placed)
        {
            if (back.IsIdentity && change == Change.Place) return delta;
            bool steady = change == Change.Place || (change == Change.Normal ? normalKept[vertex] : tangentKept[vertex]);
            if (sameWay && steady && Same(delta, placed)) return given;
            Frame frame = back.At(vertex);
            if (change == Change.Place) return frame.Delta(delta, 1);
            return change == Change.Normal ? frame.NormalDelta(delta, normalScales[vertex]) : frame.Delta(delta, tangentScales[vertex]);
        }

        /// <summary>
        /// Bind poses for moved joints: joint times bind pose stays what it was, so that all weights keep their meaning.
        /// </summary>
        internal void WriteBindPoses(Affine[] oldRest, Affine[] newRest)
        {
            Skin skin = Source.Skin;
            if (skin == null) return;
            for (int bone = 0; bone < skin.Joints.Length; bone++)
            {
                int joint = skin.Joints[bone];
                if (joint < 0) continue;
                bool moved = !newRest[joint].Equals(oldRest[joint]) && newRest[joint].Determinant != 0;
                BindPoses[bone] = (moved ? newRest[joint].Inverse * skin.ByBone[bone] : skin.InverseBinds[bone]).ToMatrix4x4();
            }
        }

        /// <summary>
        /// True where another renderer of the same mesh came out the same, so that both can show one mesh.
        /// </summary>
        internal bool IsLike(RendererResult other)
        {
            if (other.Source.Mesh != Source.Mesh || other.Parts.Count != Parts.Count) return false;
            if (!Equal(BindPoses, other.BindPoses) || !Equal(Positions, other.Positions)) return false;
            if (!Equal(Normals, other.Normals) || !Equal(Tangents, other.Tangents)) return false;
            // What lay and lies in one place has the same shapes.
            return Equal(Source.ModelVertices, other.Source.ModelVertices);
        }

        static bool Equal<T>(T[] one, T[] other) where T : struct, IEquatable<T>
        {
            if (one == null || other == null) return one == other;
            if (one.Length != other.Length) return false;
            for (int index = 0; index < one.Length; index++)
            {
                if (!one[index].Equals(other[index])) return false;
            }
            return true;
        }
    }

    /// <summary>
    /// The map of each vertex of a renderer back to mesh space, made once where it is the same for all.
    /// </summary>
    internal struct BackFrames
    {
        readonly RendererData renderer;
        readonly Frame common;

        /// <param name="placement">Mesh space to the avatar's space, where it is the same for all vertices.</param>
        internal BackFrames(RendererData renderer, Affine placement)
        {
            this.renderer = renderer;
            common = new Frame(placement.Equals(Affine.Identity) ? placement : placement.Inverse);
        }

        internal bool EachItsOwn => renderer.Placements != null;

        internal bool IsIdentity => !EachItsOwn && common.IsIdentity;

        internal Frame At(int vertex) => EachItsOwn ? new Frame(renderer.Placements[vertex].Inverse) : common;
    }
}
