// The prefab against what the command line makes of the same file with the same settings.
using System;
using System.Collections.Generic;
using System.Diagnostics;
using System.IO;
using NUnit.Framework;
using SuperDeform.Tests.Glb;
using UnityEditor;
using UnityEngine;
using UnityStubs;

namespace SuperDeform.Editor.Tests
{
    [TestFixture]
    public class ExampleTests
    {
        // Shares of the figure's height; normals are directions.
        const float Tolerance = 1e-5f, NormalTolerance = 1e-4f;

        /// What the command line writes, or null where there is no such program.
        static string RunExample(string file)
        {
            string example = Environment.GetEnvironmentVariable("SUPERDEFORM_EXAMPLE");
            if (string.IsNullOrEmpty(example)) { Console.WriteLine("left out, since SUPERDEFORM_EXAMPLE names no program"); return null; }
            string folder = Path.Combine(Models.Out, "example");
            Directory.CreateDirectory(folder);
            string made = Path.Combine(folder, Path.GetFileNameWithoutExtension(file) + "_sd" + Path.GetExtension(file));
            string arguments = "\"" + Models.Find(file) + "\" --heads 2.5 -o \"" + made + "\"";
            IDictionary<string, string> roles = Models.RolesOf(file);
            if (roles != null)
            {
                string map = Path.Combine(folder, file + ".roles.json");
                File.WriteAllText(map, Models.Json(roles));
                arguments += " --humanoid \"" + map + "\"";
            }
            ProcessStartInfo start = new ProcessStartInfo(example, arguments) { UseShellExecute = false, RedirectStandardError = true, RedirectStandardOutput = true };
            using (Process process = Process.Start(start))
            {
                string said = process.StandardError.ReadToEnd() + process.StandardOutput.ReadToEnd();
                process.WaitForExit();
                Assert.AreEqual(0, process.ExitCode, "the command line on " + file + ": " + said);
            }
            return made;
        }

        static void Compare(string file)
        {
            if (!Models.Has(file)) return;
            string made = RunExample(file);
            if (made == null) return;
            Model model = Models.Load(file);
            float height = Models.Height(model.Root);
            ConversionResult result = Converter.Convert(model.Root, Models.Settings(), null);
            Assert.That(result.Prefab != null, "a prefab");
            // Roles only tell which joints are which; the written file may be loaded without them.
            GlbAvatar expected = GlbLoader.Load(made, null);
            GameObject actual = UnityEngine.Object.Instantiate(result.Prefab);

            float joint = 0f, position = 0f, normal = 0f, delta = 0f;
            int vertices = 0, shapes = 0;
            Dictionary<string, Transform> placed = new Dictionary<string, Transform>();
            foreach (Transform at in actual.GetComponentsInChildren<Transform>(true)) placed[at.name] = at;
            for (int node = 0; node < expected.Nodes.Length; node++)
            {
                if (expected.Nodes[node] == null) continue;
                Transform twin = placed[expected.Nodes[node].name];
                Vector3 there = expected.Root.transform.InverseTransformPoint(expected.Nodes[node].position), here = actual.transform.InverseTransformPoint(twin.position);
                joint = Math.Max(joint, (there - here).magnitude / height);
            }
            Dictionary<Renderer, int> offsets = new Dictionary<Renderer, int>();
            HashSet<Renderer> done = new HashSet<Renderer>();
            foreach (PrimitiveRange range in expected.Primitives)
            {
                if (!done.Add(range.Renderer)) continue;
                Renderer twin = placed[range.Renderer.name].GetComponent<Renderer>();
                Vector3[] p, n, q, m;
                Models.Drawn(range.Renderer, expected.Root.transform, out p, out n);
                Models.Drawn(twin, actual.transform, out q, out m);
                Assert.AreEqual(p.Length, q.Length, "vertices of " + range.Renderer.name);
                vertices += p.Length;
                position = Math.Max(position, Farthest(p, q) / height);
                if (n != null) normal = Math.Max(normal, Farthest(n, m));
                SkinnedMeshRenderer first = range.Renderer as SkinnedMeshRenderer, second = twin as SkinnedMeshRenderer;
                if (first == null) continue;
                Assert.AreEqual(first.sharedMesh.blendShapeCount, second.sharedMesh.blendShapeCount, "blend shapes of " + range.Renderer.name);
                for (int shape = 0; shape < first.sharedMesh.blendShapeCount; shape++)
                {
                    Assert.AreEqual(first.sharedMesh.GetBlendShapeName(shape), second.sharedMesh.GetBlendShapeName(shape));
                    first.SetBlendShapeWeight(shape, 100f); second.SetBlendShapeWeight(shape, 100f);
                    Vector3[] moved, unused, moved2;
                    Models.Drawn(first, expected.Root.transform, out moved, out unused);
                    Models.Drawn(second, actual.transform, out moved2, out unused);
                    delta = Math.Max(delta, Farthest(moved, moved2) / height);
                    first.SetBlendShapeWeight(shape, 0f); second.SetBlendShapeWeight(shape, 0f);
                    shapes++;
                }
            }
            Console.WriteLine(string.Format(System.Globalization.CultureInfo.InvariantCulture,
                "{0}: {1} vertices, {2} blend shapes; greatest difference in shares of the height: joints {3:e1}, positions {4:e1}, with blend shapes {5:e1}; normals {6:e1}",
                file, vertices, shapes, joint, position, delta, normal));
            Assert.That(vertices, Is.GreaterThan(500));
            Assert.That(joint, Is.LessThan(Tolerance), "joints");
            Assert.That(position, Is.LessThan(Tolerance), "positions");
            Assert.That(delta, Is.LessThan(Tolerance), "blend shapes");
            Assert.That(normal, Is.LessThan(NormalTolerance), "normals");
        }

        static float Farthest(Vector3[] a, Vector3[] b)
        {
            float far = 0f;
            for (int at = 0; at < a.Length; at++)
            {
                float gap = (a[at] - b[at]).magnitude;
                if (!(gap <= far)) far = gap; // NaN counts as far
            }
            return far;
        }

        [Test] public void a_woman_in_a_dress_comes_out_as_the_command_line_makes_her() { Compare("quaternius_female_dress.glb"); }
        [Test] public void a_rogue_of_rigid_and_skinned_parts_comes_out_as_the_command_line_makes_him() { Compare("kaykit_rogue.glb"); }
        [Test] public void a_vrm_1_avatar_comes_out_as_the_command_line_makes_it() { Compare("seedsan_vrm1.vrm"); }
        [Test] public void a_vrm_0_avatar_with_expressions_comes_out_as_the_command_line_makes_it() { Compare("godette.vrm"); }
        [Test] public void a_closed_body_with_separate_clothes_comes_out_as_the_command_line_makes_it() { Compare("makehuman_female_rigged.glb"); }
        [Test] public void a_figure_that_stands_in_another_pose_than_its_bind_pose_comes_out_as_the_command_line_makes_it() { Compare("gdquest_mannequiny.glb"); }
    }
}
