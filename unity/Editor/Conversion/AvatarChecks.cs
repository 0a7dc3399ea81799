using System;
using System.Collections.Generic;
using UnityEditor;
using UnityEngine;

namespace SuperDeform.Editor
{
    /// <summary>What is to be known about an avatar before it is converted.</summary>
    public static class AvatarChecks
    {
        static readonly List<Action<GameObject, List<Finding>>> More = new List<Action<GameObject, List<Finding>>>();

        /// <summary>Adds a check, such as one of a platform's limits: it adds findings to the list.</summary>
        public static void Register(Action<GameObject, List<Finding>> check)
        {
            if (check == null) throw new ArgumentNullException("check");
            More.RemoveAll(other => other.Method == check.Method);
            More.Add(check);
        }

        /// <summary>
        /// What is to be known about an avatar; empty where all is well. Errors first, and with one of them a conversion fails.
        /// </summary>
        public static List<Finding> Of(GameObject avatar) => Of(avatar, false);

        /// <summary>The same.</summary>
        /// <param name="rigAuto">A rig will be made, so that no humanoid is needed.</param>
        public static List<Finding> Of(GameObject avatar, bool rigAuto)
        {
            var findings = new List<Finding>();
            bool library = CheckLibrary(findings);
            if (avatar == null)
            {
                findings.Add(new Finding("no_avatar", Severity.Error, null));
                return findings;
            }
            CheckAvatars(avatar, findings);
            CheckBones(avatar, findings);
            if (CheckMeshes(avatar, findings)) CheckSkeleton(avatar, rigAuto, library, findings);
            Licences.Check(avatar, findings);
            foreach (Action<GameObject, List<Finding>> check in More)
            {
                check(avatar, findings);
            }
            // Stable: within one severity they stay in order.
            List<Finding> sorted = findings.FindAll(finding => finding.Severity == Severity.Error);
            sorted.AddRange(findings.FindAll(finding => finding.Severity == Severity.Warning));
            sorted.AddRange(findings.FindAll(finding => finding.Severity == Severity.Info));
            return sorted;
        }

        static bool CheckLibrary(List<Finding> findings)
        {
            try
            {
                SuperDeformLibrary.Check();
                return true;
            }
            catch (SuperDeformException cause)
            {
                findings.Add(ConversionException.From(cause, null).Finding);
                return false;
            }
        }

        static void CheckAvatars(GameObject avatar, List<Finding> findings)
        {
            bool ownIsOne = HumanoidRoles.IsHumanoid(avatar.GetComponent<Animator>());
            List<Animator> humanoids = HumanoidRoles.Bodies(avatar);
            // Below a humanoid they may be outfits: see OutfitChecks.
            if (!ownIsOne && humanoids.Count > 1)
            {
                findings.Add(new Finding("two_avatars", Severity.Error, humanoids[1], avatar.name, humanoids[0].name).WithChoice(humanoids[0].gameObject));
            }
            Transform parent = avatar.transform.parent;
            Animator above = parent == null ? null : parent.GetComponentInParent<Animator>();
            if (HumanoidRoles.IsHumanoid(above))
            {
                // A part of an avatar, or an avatar within another.
                string key = ownIsOne ? "inside_avatar" : "part_of_avatar";
                findings.Add(new Finding(key, Severity.Error, above, avatar.name, above.name).WithChoice(ownIsOne ? null : above.gameObject));
            }
        }

        /// <summary>Avatars whose transforms the importer has taken away ("Optimize Game Objects").</summary>
        static void CheckBones(GameObject avatar, List<Finding> findings)
        {
            Animator animator = HumanoidRoles.Speaker(avatar);
            if (animator == null || animator.avatar == null || animator.hasTransformHierarchy) return;
            var finding = new Finding("bones_hidden", Severity.Error, animator, avatar.name);
            ModelImporter importer = ImporterOf(animator.avatar);
            if (importer != null)
            {
                finding.WithFix("fix_bones_hidden", () =>
                {
                    importer.optimizeGameObjects = false;
                    importer.SaveAndReimport();
                });
            }
            findings.Add(finding);
        }

        static bool CheckMeshes(GameObject avatar, List<Finding> findings)
        {
            bool any = false, readable = true;
            var known = new HashSet<Mesh>();
            foreach (Renderer renderer in avatar.GetComponentsInChildren<Renderer>(true))
            {
                Mesh mesh = RendererReader.MeshOf(renderer);
                if (mesh == null) continue;
                any = true;
                if (mesh.isReadable || !known.Add(mesh)) continue;
                readable = false;
                findings.Add(Readability.NotReadable(mesh, renderer));
            }
            if (!any) findings.Add(new Finding("no_mesh", Severity.Error, avatar, avatar.name));
            return any && readable;
        }

        static void CheckSkeleton(GameObject avatar, bool rigAuto, bool library, List<Finding> findings)
        {
            AvatarData data;
            try
            {
                data = CharacterReader.ReadSkeleton(avatar);
            }
            catch (ConversionException cause)
            {
                findings.Add(cause.Finding);
                return;
            }
            foreach (RendererData renderer in data.Renderers.FindAll(renderer => renderer.Unmoved > 0))
            {
                findings.Add(new Finding("bones_missing", Severity.Warning, renderer.Renderer, renderer.Renderer.name, renderer.Unmoved));
            }
            bool skinned = data.Renderers.Exists(renderer => renderer.Skin != null);
            int[] roles = library ? GuessedRoles.Of(data, false) : data.Roles;
            findings.AddRange(data.Findings);
            HumanBodyBones? missing = HumanoidRoles.Missing(role => roles[role] >= 0);
            if (!HumanoidRoles.IsHumanoid(data.Animator)) CheckHumanoid(data, skinned, rigAuto, missing, findings);
            if (missing != null) return;
            Outfits.Find(data, roles);
            OutfitChecks.Check(data, roles, findings);
            CheckBody(data, roles, findings);
            CheckPose(data, roles, findings);
        }

        static void CheckHumanoid(AvatarData data, bool skinned, bool rigAuto, HumanBodyBones? missing, List<Finding> findings)
        {
            if (!skinned && missing != null)
            {
                // Nothing tells where its head is but the way that its root stands.
                bool lies = (data.Root.transform.rotation * Vector3.up).y < 0.5f;
                findings.Add(new Finding(lies ? "not_upright" : "rig_will_be_made", lies ? Severity.Error : Severity.Info, data.Root, data.Root.name));
                return;
            }
            if (missing != null)
            {
                findings.Add(NotHumanoid(data, missing.Value, rigAuto ? Severity.Info : Severity.Error));
                return;
            }
            // Its joints are known by their names.
            string key = data.Animator == null ? "no_animator" : "generic";
            findings.Add(WithHumanoidFix(new Finding(key, Severity.Warning, data.Root, data.Root.name), data));
        }

        /// <summary>An avatar with bones that show no human body.</summary>
        internal static Finding NotHumanoid(AvatarData data, HumanBodyBones missing, Severity severity)
        {
            string key = severity == Severity.Info ? "rig_instead" : data.Animator == null ? "no_animator_no_humanoid" : "not_humanoid";
            return WithHumanoidFix(new Finding(key, severity, data.Root, data.Root.name, HumanTrait.BoneName[(int)missing]), data);
        }

        static Finding WithHumanoidFix(Finding finding, AvatarData data)
        {
            ModelImporter importer = null;
            foreach (RendererData renderer in data.Renderers)
            {
                if (importer == null && renderer.Skin != null) importer = ImporterOf(renderer.Mesh);
            }
            if (importer == null) return finding;
            return finding.WithFix("fix_humanoid", () =>
            {
                importer.animationType = ModelImporterAnimationType.Human;
                importer.avatarSetup = ModelImporterAvatarSetup.CreateFromThisModel;
                importer.SaveAndReimport();
            });
        }

        static ModelImporter ImporterOf(UnityEngine.Object asset)
        {
            string path = AssetDatabase.GetAssetPath(asset);
            return string.IsNullOrEmpty(path) ? null : AssetImporter.GetAtPath(path) as ModelImporter;
        }

        /// <summary>Is there a mesh that hips or limbs move?</summary>
        static void CheckBody(AvatarData data, int[] roles, List<Finding> findings)
        {
            HumanBodyBones[] limbs = { HumanBodyBones.LeftUpperArm, HumanBodyBones.RightUpperArm, HumanBodyBones.LeftUpperLeg, HumanBodyBones.RightUpperLeg };
            bool[] ofBody = new bool[data.Joints.Length];
            for (int joint = 0; joint < ofBody.Length; joint++)
            {
                int parent = data.Parents[joint];
                ofBody[joint] = Array.Exists(limbs, limb => roles[(int)limb] == joint) || parent >= 0 && ofBody[parent];
            }
            ofBody[roles[(int)HumanBodyBones.Hips]] = true;
            for (int joint = 0; joint < ofBody.Length; joint++)
            {
                ofBody[joint] |= ofBody[data.Twins[joint]];
            }
            double held = 0, all = 0;
            foreach (RendererData renderer in data.Renderers)
            {
                all += renderer.Vertices.Length;
                held += RendererReader.Held(renderer, ofBody);
            }
            // A head's mesh may reach a little way down.
            if (held < 0.01 * all) findings.Add(new Finding("no_body_mesh", Severity.Error, data.Root, data.Root.name));
        }

        static void CheckPose(AvatarData data, int[] roles, List<Finding> findings)
        {
            Double3 up = data.Rest[roles[(int)HumanBodyBones.Head]].Position - data.Rest[roles[(int)HumanBodyBones.Hips]].Position;
            if (!(up.Y > 0.5 * up.Length))
            {
                findings.Add(new Finding("not_upright", Severity.Error, data.Root, data.Root.name));
                return;
            }
            PoseMeasure pose = PoseMeasure.Of(roles, data.Rest);
            if (!(pose.Degrees > PoseMeasure.Limit)) return;
            Transform limb = data.Joints[roles[(int)pose.Limb]];
            var finding = new Finding("pose_far", Severity.Warning, limb, data.Root.name, Math.Round(pose.Degrees), limb.name);
            if (TPose.CanStand(data)) finding.WithFix("fix_pose", () => TPose.Stand(data));
            findings.Add(finding);
        }
    }
}
