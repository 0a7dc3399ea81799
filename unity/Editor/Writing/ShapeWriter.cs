using System;
using System.Collections.Generic;
using UnityEngine;

namespace SuperDeform.Editor
{
    /// <summary>
    /// Writes the blend shapes of one renderer: read from its mesh, mapped and written some at a time, where they change something.
    /// A face with 500 shapes holds more numbers than all else of an avatar together.
    /// </summary>
    internal sealed class ShapeWriter
    {
        /// <summary>
        /// Changed vertices at a time, 76 bytes each here and as many in the library. Four times as many take as long: each call
        /// costs as much as the mesh has vertices, which is little beside so many.
        /// </summary>
        const int Most = 1 << 16;

        readonly RendererResult result;
        readonly Deformer deformer;
        readonly List<BlendFrame> frames;
        readonly FramePlacer placer;
        readonly BlendDeltas deltas;
        readonly List<Changes> parts;

        internal ShapeWriter(RendererResult result, Deformer deformer, List<BlendFrame> frames)
        {
            this.result = result;
            this.deformer = deformer;
            this.frames = frames;
            placer = new FramePlacer(result.Source);
            deltas = BlendDeltas.Of(result.Source.Vertices.Length);
            parts = result.Parts.ConvertAll(part => new Changes(part.Part));
        }

        /// <param name="mesh">Without blend shapes; receives them.</param>
        internal void Write(Mesh mesh, ProgressHandler progress)
        {
            for (int first = 0, end; first < frames.Count; first = end)
            {
                parts.ForEach(part => part.Clear());
                for (end = first; end < frames.Count && HasRoom(); end++)
                {
                    deltas.Read(result.Source.Mesh, frames[end]);
                    parts.ForEach(part => part.Add(deltas, result.Source, placer));
                }
                parts.ForEach(part => part.Map(deformer));
                for (int frame = first; frame < end; frame++)
                {
                    Add(mesh, frames[frame], frame - first);
                }
                if (!progress((float)end / frames.Count)) throw new ConversionException(new Finding("cancelled", Severity.Info, null));
            }
        }

        bool HasRoom()
        {
            int count = 0;
            foreach (Changes part in parts)
            {
                count += part.Count;
            }
            return count == 0 || count + result.Source.Vertices.Length <= Most;
        }

        void Add(Mesh mesh, BlendFrame frame, int index)
        {
            Array.Clear(deltas.Positions, 0, deltas.Positions.Length);
            Array.Clear(deltas.Normals, 0, deltas.Normals.Length);
            Array.Clear(deltas.Tangents, 0, deltas.Tangents.Length);
            bool turns = false, twists = false;
            foreach (Changes part in parts)
            {
                turns |= part.Write(index, Change.Normal, deltas.Normals, result, placer);
                twists |= part.Write(index, Change.Tangent, deltas.Tangents, result, placer);
                part.Write(index, Change.Place, deltas.Positions, result, placer);
            }
            mesh.AddBlendShapeFrame(frame.ShapeName, frame.Weight, deltas.Positions, turns ? deltas.Normals : null, twists ? deltas.Tangents : null);
        }

        /// <summary>What some frames change of one part.</summary>
        sealed class Changes
        {
            readonly PartData part;
            readonly List<int> ends = new List<int>();
            readonly bool[] any = new bool[3];
            uint[] vertices = new uint[0];

            /// <summary>By Change: what the source's shapes add, in mesh space; and what is mapped in place, in the avatar's.</summary>
            readonly Vector3[][] given = { new Vector3[0], new Vector3[0], new Vector3[0] }, mapped = { new Vector3[0], new Vector3[0], new Vector3[0] };

            internal Changes(PartData part)
            {
                this.part = part;
            }

            internal int Count { get; private set; }

            internal void Clear()
            {
                Count = 0;
                ends.Clear();
                Array.Clear(any, 0, any.Length);
            }

            internal void Add(BlendDeltas deltas, RendererData renderer, FramePlacer placer)
            {
                for (int vertex = 0; vertex < part.VertexCount; vertex++)
                {
                    int place = part.VertexOf(vertex);
                    Vector3 none = new Vector3(0, 0, 0), moves = deltas.Positions[place];
                    // What has no normals itself can have no changes of them.
                    Vector3 turns = renderer.Normals == null ? none : deltas.Normals[place];
                    Vector3 twists = renderer.Tangents == null ? none : deltas.Tangents[place];
                    if (IsNone(moves) && IsNone(turns) && IsNone(twists)) continue;
                    if (Count == vertices.Length) Grow();
                    vertices[Count] = (uint)vertex;
                    Put(Change.Place, moves, place, placer);
                    Put(Change.Normal, turns, place, placer);
                    Put(Change.Tangent, twists, place, placer);
                    Count++;
                }
                ends.Add(Count);
            }

            void Grow()
            {
                int length = Math.Max(4 * Count, 1024) / 2;
                Array.Resize(ref vertices, length);
                for (int change = 0; change < 3; change++)
                {
                    Array.Resize(ref given[change], length);
                    Array.Resize(ref mapped[change], length);
                }
            }

            void Put(Change change, Vector3 delta, int place, FramePlacer placer)
            {
                any[(int)change] |= !IsNone(delta);
                given[(int)change][Count] = delta;
                mapped[(int)change][Count] = placer.ToModel(delta, place, change);
            }

            internal void Map(Deformer deformer)
            {
                if (Count == 0) return;
                uint[] counts = new uint[ends.Count];
                for (int frame = 0; frame < counts.Length; frame++)
                {
                    counts[frame] = (uint)(ends[frame] - Begin(frame));
                }
                deformer.MapMorphTargets(part.Index, counts, vertices, mapped[0], any[1] ? mapped[1] : null, any[2] ? mapped[2] : null);
            }

            int Begin(int frame) => frame == 0 ? 0 : ends[frame - 1];

            /// <summary>Writes what one frame changes to an array by vertex of the mesh.</summary>
            /// <returns>Whether the source's changes anything so.</returns>
            internal bool Write(int frame, Change change, Vector3[] into, RendererResult result, FramePlacer placer)
            {
                Vector3[] before = given[(int)change], after = mapped[(int)change];
                bool found = false;
                for (int at = Begin(frame); at < ends[frame] && any[(int)change]; at++)
                {
                    if (IsNone(before[at])) continue;
                    found = true;
                    int place = part.VertexOf((int)vertices[at]);
                    into[place] = result.ToMesh(after[at], place, change, before[at], placer.ToModel(before[at], place, change));
                }
                return found;
            }

            static bool IsNone(Vector3 delta) => delta.x == 0 && delta.y == 0 && delta.z == 0;
        }
    }
}
