// The models that the tests convert, as assets of an empty project and an object of its scene.
using System;
using System.Collections.Generic;
using System.IO;
using System.Text;
using SuperDeform.Tests.Glb;
using UnityEngine;
using UnityStubs;
using Object = UnityEngine.Object;

[assembly: System.Runtime.CompilerServices.InternalsVisibleTo("ConvertOnce")]

namespace SuperDeform.Editor.Tests
{
    /// A model in the project: Assets/Models/NAME.fbx holds its meshes, materials and Avatar, and an instance stands in the scene.
    internal sealed class Model
    {
        public string File, AssetPath;
        public GlbAvatar Glb;
        public GameObject Root { get { return Glb.Root; } }
    }

    internal static class Models
    {
        static int s_Projects;

        public static string Repository { get { return Environment.GetEnvironmentVariable("SUPERDEFORM_REPOSITORY") ?? "."; } }
        public static string Out { get { return Environment.GetEnvironmentVariable("SUPERDEFORM_OUT") ?? Path.GetTempPath(); } }

        /// A whole path stays. Null where the file is not there: the models of the second folder are not in the repository.
        public static string Find(string file)
        {
            if (Path.IsPathRooted(file)) return file;
            string models = Environment.GetEnvironmentVariable("SUPERDEFORM_MODELS") ?? Path.Combine(Repository, "../shared/models");
            foreach (string folder in new[] { Path.Combine(Repository, "tests/data"), models })
            {
                if (System.IO.File.Exists(Path.Combine(folder, file))) return Path.GetFullPath(Path.Combine(folder, file));
            }
            return null;
        }

        /// Says so and gives false where a model is not there.
        public static bool Has(string file)
        {
            if (Find(file) != null) return true;
            Console.WriteLine("left out, since " + file + " is not in tests/data nor in SUPERDEFORM_MODELS");
            return false;
        }

        /// Opens an empty project.
        public static string NewProject()
        {
            string folder = Path.Combine(Out, "projects/" + System.Diagnostics.Process.GetCurrentProcess().Id + "_" + ++s_Projects);
            if (Directory.Exists(folder)) Directory.Delete(folder, true);
            StubProject.Open(folder);
            Directory.CreateDirectory(Path.Combine(folder, "Assets/Models"));
            Strings.Language = "en";
            return folder;
        }

        /// Opens an empty project with one model in it.
        public static Model Load(string file)
        {
            NewProject();
            return Add(file);
        }

        public static Model Add(string file)
        {
            Model model = new Model { File = Find(file), AssetPath = "Assets/Models/" + Path.GetFileNameWithoutExtension(file) + ".fbx" };
            model.Glb = GlbLoader.Load(model.File, RolesOf(file));
            Import(model);
            return model;
        }

        /// Makes meshes, materials and Avatar assets of the model's file.
        public static void Import(Model model)
        {
            List<Object> assets = new List<Object>();
            foreach (Mesh mesh in model.Glb.Meshes) assets.Add(mesh);
            foreach (Material material in model.Glb.Materials) assets.Add(material);
            Animator animator = model.Root.GetComponent<Animator>();
            if (animator != null && animator.avatar != null) assets.Add(animator.avatar);
            StubProject.Import(model.AssetPath, assets.ToArray());
            StubEditor.AddModelImporter(model.AssetPath, true);
        }

        /// A post of three bones in a row that look like nothing.
        public static GameObject Post()
        {
            GameObject root = new GameObject("Post");
            Transform[] bones = new Transform[3];
            Mesh mesh = new Mesh();
            mesh.name = "post";
            Vector3[] corners = new Vector3[24];
            BoneWeight[] weights = new BoneWeight[24];
            int[] triangles = new int[6 * 6 * 3];
            int[][] faces = { new[] { 0, 2, 3, 1 }, new[] { 4, 5, 7, 6 }, new[] { 0, 1, 5, 4 }, new[] { 2, 6, 7, 3 }, new[] { 0, 4, 6, 2 }, new[] { 1, 3, 7, 5 } };
            for (int bone = 0; bone < 3; bone++)
            {
                bones[bone] = new GameObject("piece " + bone).transform;
                bones[bone].SetParent(bone == 0 ? root.transform : bones[bone - 1], false);
                bones[bone].localPosition = new Vector3(0, bone == 0 ? 0f : 0.5f, 0);
                for (int corner = 0; corner < 8; corner++)
                {
                    corners[bone * 8 + corner] = new Vector3((corner & 1) * 0.2f - 0.1f, bone * 0.5f + (corner & 2) * 0.25f, (corner & 4) * 0.05f - 0.1f);
                    weights[bone * 8 + corner] = new BoneWeight { boneIndex0 = bone, weight0 = 1f };
                }
                for (int face = 0; face < 6; face++)
                {
                    for (int corner = 0; corner < 6; corner++) triangles[(bone * 6 + face) * 6 + corner] = bone * 8 + faces[face][new[] { 0, 1, 2, 0, 2, 3 }[corner]];
                }
            }
            mesh.vertices = corners;
            mesh.triangles = triangles;
            mesh.boneWeights = weights;
            mesh.bindposes = Array.ConvertAll(bones, delegate (Transform bone) { return bone.worldToLocalMatrix; });
            mesh.RecalculateNormals();
            StubProject.Import("Assets/Models/post.fbx", mesh);
            StubEditor.AddModelImporter("Assets/Models/post.fbx", true);
            SkinnedMeshRenderer renderer = new GameObject("post mesh").AddComponent<SkinnedMeshRenderer>();
            renderer.transform.SetParent(root.transform, false);
            renderer.bones = bones;
            renderer.rootBone = bones[0];
            renderer.sharedMesh = mesh;
            renderer.localBounds = mesh.bounds;
            return root;
        }

        public static ConversionSettings Settings()
        {
            return new ConversionSettings { Heads = 2.5f };
        }

        /// VRM 1.0 role -> node name, for files that do not say; null for VRM files and for those that cannot be humanoids in Unity.
        public static Dictionary<string, string> RolesOf(string file)
        {
            file = Path.GetFileName(file);
            if (file.EndsWith(".vrm")) return null;
            if (file.StartsWith("kaykit")) return Sided("hips hips spine spine chest chest head head", "UpperArm upperarm LowerArm lowerarm Hand hand UpperLeg upperleg LowerLeg lowerleg Foot foot Toes toes", ".l", ".r", "");
            // Its feet hang from the root beside the legs, which no humanoid Avatar allows: its joints are told by their names.
            if (file.StartsWith("quaternius_female")) return null;
            if (file.StartsWith("makehuman_female_rigged"))
            {
                const string m = "mixamorig:";
                return Sided("hips " + m + "Hips spine " + m + "Spine chest " + m + "Spine1 upperChest " + m + "Spine2 neck " + m + "Neck head " + m + "Head",
                    "Shoulder Shoulder UpperArm Arm LowerArm ForeArm Hand Hand UpperLeg UpLeg LowerLeg Leg Foot Foot Toes ToeBase", "Left", "Right", m);
            }
            if (file.StartsWith("gdquest"))
            {
                return Sided("hips pelvis spine spine_01 chest spine_02 neck neck_01 head head",
                    "Shoulder clavicle UpperArm upperarm LowerArm lowerarm Hand hand UpperLeg thigh LowerLeg calf Foot foot Toes ball", ".l", ".r", "");
            }
            throw new ArgumentException("no roles are known for " + file);
        }

        static Dictionary<string, string> Sided(string middle, string sides, string left, string right, string prefix)
        {
            Dictionary<string, string> roles = new Dictionary<string, string>();
            string[] words = middle.Split(' ');
            for (int at = 0; at < words.Length; at += 2) roles[words[at]] = words[at + 1];
            words = sides.Split(' ');
            for (int at = 0; at < words.Length; at += 2)
            {
                roles["left" + words[at]] = prefix == "" ? words[at + 1] + left : prefix + left + words[at + 1];
                roles["right" + words[at]] = prefix == "" ? words[at + 1] + right : prefix + right + words[at + 1];
            }
            return roles;
        }

        public static string Json(IDictionary<string, string> roles)
        {
            StringBuilder text = new StringBuilder("{");
            foreach (KeyValuePair<string, string> pair in roles) text.Append(text.Length > 1 ? ",\n" : "\n").Append('"').Append(pair.Key).Append("\": \"").Append(pair.Value).Append('"');
            return text.Append("\n}\n").ToString();
        }

        /// Every renderer's vertices and normals in the root's space, as drawn.
        public static void Drawn(Renderer renderer, Transform root, out Vector3[] positions, out Vector3[] normals)
        {
            SkinnedMeshRenderer skinned = renderer as SkinnedMeshRenderer;
            if (skinned != null) { Skinning.Drawn(skinned, root.worldToLocalMatrix, out positions, out normals); return; }
            Mesh mesh = renderer.GetComponent<MeshFilter>().sharedMesh;
            Matrix4x4 to = root.worldToLocalMatrix * renderer.transform.localToWorldMatrix, turn = to.inverse.transpose;
            positions = Array.ConvertAll(mesh.vertices, to.MultiplyPoint3x4);
            normals = Array.ConvertAll(mesh.normals, delegate (Vector3 n) { return turn.MultiplyVector(n).normalized; });
            if (normals.Length == 0) normals = null;
        }

        public static float Height(GameObject root)
        {
            float low = float.MaxValue, high = float.MinValue;
            foreach (Renderer renderer in root.GetComponentsInChildren<Renderer>(true))
            {
                Vector3[] positions, normals;
                Drawn(renderer, root.transform, out positions, out normals);
                foreach (Vector3 p in positions) { low = Math.Min(low, p.y); high = Math.Max(high, p.y); }
            }
            return high - low;
        }

        public static Mesh MeshOf(Renderer renderer)
        {
            SkinnedMeshRenderer skinned = renderer as SkinnedMeshRenderer;
            return skinned != null ? skinned.sharedMesh : renderer.GetComponent<MeshFilter>().sharedMesh;
        }
    }
}
