// Measures the memory of a conversion of an avatar with many blend shapes: the peak beyond what the avatar itself takes.
//
//     MemoryBench.exe [VERTICES [SHAPES [SHARE]]]      20000 vertices, 500 shapes, each changing 1.0 of the vertices
//
// memory.sh beside this file builds and runs it. The stand-in keeps shapes as Unity does, 40 bytes for each vertex that one changes.
using System;
using System.Diagnostics;
using System.Globalization;
using System.IO;
using SuperDeform.Editor.Tests;
using UnityEngine;

namespace SuperDeform.Editor.Bench
{
    internal static class MemoryBench
    {
        sealed class Silent : IConversionProgress
        {
            public bool Report(string stage, float fraction) { return true; }
        }

        static double Megabytes(string key)
        {
            foreach (string line in File.ReadAllLines("/proc/self/status"))
            {
                if (line.StartsWith(key, StringComparison.Ordinal))
                {
                    return long.Parse(line.Substring(key.Length + 1).Replace("kB", "").Trim(), CultureInfo.InvariantCulture) / 1024.0;
                }
            }
            throw new InvalidOperationException("there is no " + key);
        }

        static void AddShapes(Mesh mesh, int shapes, double share)
        {
            Vector3[] positions = mesh.vertices, at = new Vector3[positions.Length], turns = new Vector3[positions.Length], tangents = new Vector3[positions.Length];
            int moved = (int)(share * positions.Length);
            for (int shape = 0; shape < shapes; shape++)
            {
                Array.Clear(at, 0, at.Length);
                Array.Clear(turns, 0, turns.Length);
                Array.Clear(tangents, 0, tangents.Length);
                for (int index = 0; index < moved; index++)
                {
                    int vertex = (index + 37 * shape) % positions.Length;
                    at[vertex] = new Vector3(0.001f, 0.0005f * (shape % 7 + 1), 0.001f);
                    turns[vertex] = new Vector3(0, 0.1f, 0);
                    tangents[vertex] = new Vector3(0.1f, 0, 0);
                }
                mesh.AddBlendShapeFrame(shape == 0 ? "Blink" : "Shape" + shape, 100, at, turns, tangents);
            }
        }

        static int Main(string[] arguments)
        {
            int vertices = arguments.Length > 0 ? int.Parse(arguments[0], CultureInfo.InvariantCulture) : 20000;
            int shapes = arguments.Length > 1 ? int.Parse(arguments[1], CultureInfo.InvariantCulture) : 500;
            double share = arguments.Length > 2 ? double.Parse(arguments[2], CultureInfo.InvariantCulture) : 1;
            var figure = new WindowFigure("Bench", vertices, 0, true);
            AddShapes(figure.Body.sharedMesh, shapes, share);
            GC.Collect();
            double before = Megabytes("VmRSS:");
            File.WriteAllText("/proc/self/clear_refs", "5");
            Stopwatch watch = Stopwatch.StartNew();
            ConversionResult done = Converter.ConvertInPlace(figure.Root, new ConversionSettings { Heads = 2.5f }, new Silent());
            Console.WriteLine("{0} vertices, {1} shapes of {2:0%} of them: {3:0} MB with the avatar, {4:0} MB at most: {5:0} MB above, {6:0.0} s, {7} shapes made",
                figure.Body.sharedMesh.vertexCount, shapes, share, before, Megabytes("VmHWM:"), Megabytes("VmHWM:") - before,
                watch.Elapsed.TotalSeconds, figure.Body.sharedMesh.blendShapeCount);
            GC.KeepAlive(done);
            return 0;
        }
    }
}
