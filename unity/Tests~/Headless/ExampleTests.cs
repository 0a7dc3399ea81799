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
        // Shares of the figure's height; normals are directions. Where slices of a profile meet, a normal turns with the slope of
        // the map, which rounding of places by 1e-7 changes by 2e-4.
        const float Tolerance = 1e-5f, NormalTolerance = 4e-4f;

        /// What the command line writes, or null where there is no such program.
        internal static string RunExample(string file, string more)
        {
            string example = Environment.GetEnvironmentVariable("SUPERDEFORM_EXAMPLE");
            if (string.IsNullOrEmpty(example)) { Console.WriteLine("left out, since SUPERDEFORM_EXAMPLE names no program"); return null; }
            string folder = Path.Combine(Models.Out, "example");
            Directory.CreateDirectory(folder);
            string made = Path.Combine(folder, Path.GetFileNameWithoutExtension(file) + "_sd" + Path.GetExtension(file));
            string arguments = "\"" + Models.Find(file) + "\" " + more + " -o \"" + made + "\"";
            IDictionary<string, string> roles = Models.RolesOf(file);
            if (roles != null)
            {
                string map = Path.Combine(folder, Path.GetFileName(file) + ".roles.json");
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

        static void Compare(string file) { Compare(file, "--heads 2.5", null); }

        /// arguments: the command line's; settings: makes the same of new settings
        /// coarser, turned: how many times the tolerance is allowed, of places and of normals
        static void Compare(string file, string arguments, Action<ConversionSettings> settings, int coarser = 1, int turned = 1)
        {
            if (!Models.Has(file)) return;
            string made = RunExample(file, arguments);
            if (made == null) return;
            Model model = Models.Load(file);
            float height = Models.Height(model.Root);
            ConversionSettings chosen = Models.Settings();
            if (settings != null) settings(chosen);
            ConversionResult result = Converter.Convert(model.Root, chosen, null);
            Assert.That(result.Prefab != null, "a prefab");
            // Roles only tell which joints are which; the written file may be loaded without them.
            GlbAvatar expected = GlbLoader.Load(made, null);
            GameObject actual = UnityEngine.Object.Instantiate(result.Prefab);

            float joint = 0f, position = 0f, normal = 0f, delta = 0f, moved = 0f;
            int corners = 0, shapes = 0;
            Dictionary<string, Transform> placed = new Dictionary<string, Transform>();
            foreach (Transform at in actual.GetComponentsInChildren<Transform>(true)) placed[at.name] = at;
            for (int node = 0; node < expected.Nodes.Length; node++)
            {
                if (expected.Nodes[node] == null) continue;
                Transform twin = placed[expected.Nodes[node].name];
                Vector3 there = expected.Root.transform.InverseTransformPoint(expected.Nodes[node].position), here = actual.transform.InverseTransformPoint(twin.position);
                joint = Math.Max(joint, (there - here).magnitude / height);
            }
            // Primitives that shared their vertices in the file may have their own in the written one.
            Assert.AreEqual(model.Glb.Primitives.Count, expected.Primitives.Count, "primitives");
            for (int at = 0; at < expected.Primitives.Count; at++)
            {
                PrimitiveRange range = expected.Primitives[at], source = model.Glb.Primitives[at];
                                Renderer twin = placed[range.Renderer.name].GetComponent<Renderer>();
                Vector3[] p, n, q, m, before, unused;
                Draw(range.Renderer, expected.Root, range, out p, out n);
                Draw(twin, actual, source, out q, out m);
                Draw(source.Renderer, model.Root, source, out before, out unused);
                Assert.AreEqual(p.Length, q.Length, "triangles of " + range.Renderer.name);
                moved = Math.Max(moved, Farthest(before, q) / height);
                corners += p.Length;
                float gap = Farthest(p, q) / height;
                if (gap > Tolerance) Console.WriteLine(range.Renderer.name + ", submesh " + range.Primitive + ": positions differ by " + gap + " of the height");
                position = Math.Max(position, gap);
                if (n != null) normal = Math.Max(normal, Farthest(n, m));
                SkinnedMeshRenderer first = range.Renderer as SkinnedMeshRenderer, second = twin as SkinnedMeshRenderer;
                if (first == null) continue;
                Assert.AreEqual(first.sharedMesh.blendShapeCount, second.sharedMesh.blendShapeCount, "blend shapes of " + range.Renderer.name);
                for (int shape = 0; shape < first.sharedMesh.blendShapeCount; shape++)
                {
                    Assert.AreEqual(first.sharedMesh.GetBlendShapeName(shape), second.sharedMesh.GetBlendShapeName(shape));
                    first.SetBlendShapeWeight(shape, 100f); second.SetBlendShapeWeight(shape, 100f);
                    Draw(first, expected.Root, range, out p, out n);
                    Draw(second, actual, source, out q, out m);
                    delta = Math.Max(delta, Farthest(p, q) / height);

                    first.SetBlendShapeWeight(shape, 0f); second.SetBlendShapeWeight(shape, 0f);
                    shapes++;
                }
            }
            Console.WriteLine(string.Format(System.Globalization.CultureInfo.InvariantCulture,
                "{0}: {1} corners of triangles, {2} blend shapes; greatest difference in shares of the height: joints {3:e1}, positions {4:e1}, with blend shapes {5:e1}; normals {6:e1}; vertices moved by up to {7:f3}",
                file, corners, shapes, joint, position, delta, normal, moved));
            Assert.That(moved, Is.GreaterThan(0.02f), "nothing was deformed");
            Assert.That(corners, Is.GreaterThan(500));
            Assert.That(joint, Is.LessThan(Tolerance), "joints");
            Assert.That(position, Is.LessThan(coarser * Tolerance), "positions");
            Assert.That(delta, Is.LessThan(Tolerance), "blend shapes");
            Assert.That(normal, Is.LessThan(turned * NormalTolerance), "normals");
        }

        /// The corners of a primitive's triangles: of vertices that several primitives share, each draws its own.
        static void Draw(Renderer renderer, GameObject root, PrimitiveRange range, out Vector3[] positions, out Vector3[] normals)
        {
            Vector3[] all, turned;
            Models.Drawn(renderer, root.transform, out all, out turned);
            int[] corners = Models.MeshOf(renderer).GetIndices(range.Primitive);
            positions = Array.ConvertAll(corners, delegate (int vertex) { return all[vertex]; });
            normals = turned == null ? null : Array.ConvertAll(corners, delegate (int vertex) { return turned[vertex]; });
        }

        internal static float Farthest(Vector3[] a, Vector3[] b)
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
        [Test] public void a_rogue_of_rigid_and_skinned_parts_comes_out_as_the_command_line_makes_him() { Compare("kaykit_rogue.glb", "--heads 1.8", delegate (ConversionSettings settings) { settings.Heads = 1.8f; }); }
        // Slivers of her clothes, whose sides nearly cancel, turn by up to 4.9e-3 where places differ by last digits.
        [Test]
        public void a_vrm_1_avatar_comes_out_as_the_command_line_makes_it()
        {
            Compare("seedsan_vrm1.vrm", "--heads 2.5 --repair 0", settings => settings.Options.Repair = Repair.Off, 1, 16);
        }

        // Whether a corner of her coat counts as inside turns on the last bits of its place: 1.2e-5 and 1.2e-3.
        [Test]
        public void clothes_are_pushed_out_as_the_command_line_does_it()
        {
            Compare("seedsan_vrm1.vrm", "--heads 2.5", null, 4, 16);
        }

        [Test] public void a_vrm_0_avatar_with_expressions_comes_out_as_the_command_line_makes_it() 
        {
            if (!Models.Has("godette.vrm")) return;
            // Its body, logo and backpack name the same accessors.
            Directory.CreateDirectory(Path.Combine(Models.Out, "example"));
            string own = Path.Combine(Models.Out, "example/godette.vrm");
            OwnVertices.Write(Models.Find("godette.vrm"), own);
            Compare(own);
        }

        [Test] public void a_closed_body_with_separate_clothes_comes_out_as_the_command_line_makes_it() { Compare("makehuman_female_rigged.glb"); }
        [Test] public void a_figure_that_stands_in_another_pose_than_its_bind_pose_comes_out_as_the_command_line_makes_it() { Compare("gdquest_mannequiny.glb"); }

        [Test]
        public void another_avatar_as_the_style_gives_what_it_gives_on_the_command_line()
        {
            string map = Path.Combine(Models.Out, "reference.roles.json");
            File.WriteAllText(map, Models.Json(Models.RolesOf("kaykit_rogue.glb")));
            Compare("quaternius_female_dress.glb", "\"" + Models.Find("kaykit_rogue.glb") + "\" --reference-humanoid \"" + map + "\"", delegate (ConversionSettings settings)
            {
                settings.Source = StyleSource.ReferenceAvatar;
                settings.ReferenceAvatar = Models.Add("kaykit_rogue.glb").Root;
            });
        }

        [Test]
        public void tuning_gives_what_it_gives_on_the_command_line()
        {
            Compare("quaternius_female_dress.glb", "--heads 3 --head-scale 1.3 --face-squash 0.4 --face-curve f2 --amount 0.8 --hair-length 0.5 --group upper_leg:length=0.6,thickness=0.9 --group hand:thickness=1.4", delegate (ConversionSettings settings)
            {
                settings.Heads = 3f;
                settings.Options.HeadScale = 1.3f;
                settings.Options.FaceSquash = 0.4f;
                settings.Options.FaceCurve = FaceCurve.F2;
                settings.Options.Amount = 0.8f;
                settings.Options.HairLength = 0.5f;
                settings.Options.Groups.Add(new GroupSettings { Group = "upper_leg", LengthScale = 0.6f, ThicknessScale = 0.9f });
                settings.Options.Groups.Add(new GroupSettings { Group = "hand", ThicknessScale = 1.4f });
            });
        }
    }
}
