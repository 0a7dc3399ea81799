// Animators, avatars and the making of a humanoid avatar from a description.
using System;
using System.Collections.Generic;

namespace UnityEngine
{
    public enum HumanBodyBones
    {
        Hips = 0, LeftUpperLeg, RightUpperLeg, LeftLowerLeg, RightLowerLeg, LeftFoot, RightFoot, Spine, Chest, Neck, Head, LeftShoulder, RightShoulder,
        LeftUpperArm, RightUpperArm, LeftLowerArm, RightLowerArm, LeftHand, RightHand, LeftToes, RightToes, LeftEye, RightEye, Jaw,
        LeftThumbProximal, LeftThumbIntermediate, LeftThumbDistal, LeftIndexProximal, LeftIndexIntermediate, LeftIndexDistal,
        LeftMiddleProximal, LeftMiddleIntermediate, LeftMiddleDistal, LeftRingProximal, LeftRingIntermediate, LeftRingDistal,
        LeftLittleProximal, LeftLittleIntermediate, LeftLittleDistal,
        RightThumbProximal, RightThumbIntermediate, RightThumbDistal, RightIndexProximal, RightIndexIntermediate, RightIndexDistal,
        RightMiddleProximal, RightMiddleIntermediate, RightMiddleDistal, RightRingProximal, RightRingIntermediate, RightRingDistal,
        RightLittleProximal, RightLittleIntermediate, RightLittleDistal, UpperChest, LastBone
    }

    public class HumanTrait
    {
        static readonly string[] s_Names = MakeNames();
        // The parent that counts when every optional bone is there.
        static readonly int[] s_Parents = MakeParents();

        public static int BoneCount { get { return (int)HumanBodyBones.LastBone; } }
        // "LeftUpperLeg", but "Left Thumb Proximal": the fingers' names have blanks.
        public static string[] BoneName { get { return (string[])s_Names.Clone(); } }
        public static bool RequiredBone(int i)
        {
            switch ((HumanBodyBones)i)
            {
                case HumanBodyBones.Hips: case HumanBodyBones.Spine: case HumanBodyBones.Head:
                case HumanBodyBones.LeftUpperLeg: case HumanBodyBones.LeftLowerLeg: case HumanBodyBones.LeftFoot:
                case HumanBodyBones.RightUpperLeg: case HumanBodyBones.RightLowerLeg: case HumanBodyBones.RightFoot:
                case HumanBodyBones.LeftUpperArm: case HumanBodyBones.LeftLowerArm: case HumanBodyBones.LeftHand:
                case HumanBodyBones.RightUpperArm: case HumanBodyBones.RightLowerArm: case HumanBodyBones.RightHand:
                    return true;
            }
            return false;
        }
        public static int RequiredBoneCount { get { int count = 0; for (int bone = 0; bone < BoneCount; bone++) if (RequiredBone(bone)) count++; return count; } }
        public static int GetParentBone(int i) { return i < 0 || i >= BoneCount ? -1 : s_Parents[i]; }

        static string[] MakeNames()
        {
            string[] names = new string[(int)HumanBodyBones.LastBone];
            for (int bone = 0; bone < names.Length; bone++)
            {
                string name = ((HumanBodyBones)bone).ToString();
                bool finger = bone >= (int)HumanBodyBones.LeftThumbProximal && bone <= (int)HumanBodyBones.RightLittleDistal;
                names[bone] = finger ? System.Text.RegularExpressions.Regex.Replace(name, "(?<!^)([A-Z])", " $1") : name;
            }
            return names;
        }
        static int[] MakeParents()
        {
            int[] parents = new int[(int)HumanBodyBones.LastBone];
            for (int bone = 0; bone < parents.Length; bone++) parents[bone] = (int)ParentOf((HumanBodyBones)bone);
            parents[0] = -1;
            return parents;
        }
        static HumanBodyBones ParentOf(HumanBodyBones bone)
        {
            string name = bone.ToString();
            string side = name.StartsWith("Left") ? "Left" : name.StartsWith("Right") ? "Right" : "";
            switch (name.Substring(side.Length))
            {
                case "UpperLeg": return HumanBodyBones.Hips;
                case "LowerLeg": return Named(side + "UpperLeg");
                case "Foot": return Named(side + "LowerLeg");
                case "Toes": return Named(side + "Foot");
                case "Chest": return HumanBodyBones.Spine;
                case "UpperChest": return HumanBodyBones.Chest;
                case "Neck": case "Shoulder": return HumanBodyBones.UpperChest;
                case "Head": return HumanBodyBones.Neck;
                case "Eye": case "Jaw": return HumanBodyBones.Head;
                case "UpperArm": return Named(side + "Shoulder");
                case "LowerArm": return Named(side + "UpperArm");
                case "Hand": return Named(side + "LowerArm");
            }
            if (name.EndsWith("Proximal")) return Named(side + "Hand");
            if (name.EndsWith("Intermediate")) return Named(name.Replace("Intermediate", "Proximal"));
            if (name.EndsWith("Distal")) return Named(name.Replace("Distal", "Intermediate"));
            return HumanBodyBones.Hips;
        }
        static HumanBodyBones Named(string name) { return (HumanBodyBones)Enum.Parse(typeof(HumanBodyBones), name); }
    }

    [Serializable]
    public struct HumanLimit
    {
        Vector3 m_Min, m_Max, m_Center;
        float m_AxisLength;
        int m_UseDefaultValues;
        public bool useDefaultValues { get { return m_UseDefaultValues != 0; } set { m_UseDefaultValues = value ? 1 : 0; } }
        public Vector3 min { get { return m_Min; } set { m_Min = value; } }
        public Vector3 max { get { return m_Max; } set { m_Max = value; } }
        public Vector3 center { get { return m_Center; } set { m_Center = value; } }
        public float axisLength { get { return m_AxisLength; } set { m_AxisLength = value; } }
    }
    [Serializable]
    public struct HumanBone
    {
        string m_BoneName, m_HumanName;
        public HumanLimit limit;
        public string boneName { get { return m_BoneName; } set { m_BoneName = value; } }
        public string humanName { get { return m_HumanName; } set { m_HumanName = value; } }
    }
    [Serializable]
    public struct SkeletonBone
    {
        public string name;
        public Vector3 position;
        public Quaternion rotation;
        public Vector3 scale;
    }
    [Serializable]
    public struct HumanDescription
    {
        public HumanBone[] human;
        public SkeletonBone[] skeleton;
        float m_UpperArmTwist, m_LowerArmTwist, m_UpperLegTwist, m_LowerLegTwist, m_ArmStretch, m_LegStretch, m_FeetSpacing;
        bool m_HasTranslationDoF;
        public float upperArmTwist { get { return m_UpperArmTwist; } set { m_UpperArmTwist = value; } }
        public float lowerArmTwist { get { return m_LowerArmTwist; } set { m_LowerArmTwist = value; } }
        public float upperLegTwist { get { return m_UpperLegTwist; } set { m_UpperLegTwist = value; } }
        public float lowerLegTwist { get { return m_LowerLegTwist; } set { m_LowerLegTwist = value; } }
        public float armStretch { get { return m_ArmStretch; } set { m_ArmStretch = value; } }
        public float legStretch { get { return m_LegStretch; } set { m_LegStretch = value; } }
        public float feetSpacing { get { return m_FeetSpacing; } set { m_FeetSpacing = value; } }
        public bool hasTranslationDoF { get { return m_HasTranslationDoF; } set { m_HasTranslationDoF = value; } }
    }

    public class Avatar : Object
    {
        internal bool m_Valid, m_Human;
        internal HumanDescription m_Description;
        // By name of a bone, the way to it from the animator when the Avatar was built: that is what it is found by.
        internal Dictionary<string, string> m_Paths = new Dictionary<string, string>();
        internal Avatar() { }
        public bool isValid { get { Alive(); return m_Valid; } }
        public bool isHuman { get { Alive(); return m_Valid && m_Human; } }
        public HumanDescription humanDescription
        {
            get
            {
                Alive();
                HumanDescription copy = m_Description; // Its arrays are the caller's own.
                copy.human = copy.human == null ? new HumanBone[0] : (HumanBone[])copy.human.Clone();
                copy.skeleton = copy.skeleton == null ? new SkeletonBone[0] : (SkeletonBone[])copy.skeleton.Clone();
                return copy;
            }
        }
    }

    public class AvatarBuilder
    {
        // A description that does not suit the hierarchy logs an error and gives an avatar that is not valid.
        public static Avatar BuildHumanAvatar(GameObject go, HumanDescription humanDescription)
        {
            if (go == null) throw new NullReferenceException("AvatarBuilder: the game object is null");
            Avatar made = new Avatar();
            made.m_Description = humanDescription;
            made.m_Description.human = humanDescription.human == null ? new HumanBone[0] : (HumanBone[])humanDescription.human.Clone();
            made.m_Description.skeleton = humanDescription.skeleton == null ? new SkeletonBone[0] : (SkeletonBone[])humanDescription.skeleton.Clone();
            string fault = Fault(go, made.m_Description);
            if (fault != null) { Debug.LogError("AvatarBuilder '" + go.name + "': " + fault); return made; }
            foreach (HumanBone bone in made.m_Description.human)
                foreach (Transform at in go.GetComponentsInChildren<Transform>(true)) if (at.name == bone.boneName && !made.m_Paths.ContainsKey(bone.boneName)) made.m_Paths.Add(bone.boneName, PathOf(at, go.transform));
            made.m_Valid = made.m_Human = true;
            return made;
        }
        static string PathOf(Transform at, Transform root) { return at.parent == root ? at.name : PathOf(at.parent, root) + "/" + at.name; }
        public static Avatar BuildGenericAvatar(GameObject go, string rootMotionTransformName)
        {
            if (go == null) throw new NullReferenceException("AvatarBuilder: the game object is null");
            Avatar made = new Avatar();
            made.m_Valid = true;
            return made;
        }

        static string Fault(GameObject go, HumanDescription description)
        {
            Dictionary<string, List<Transform>> byName = new Dictionary<string, List<Transform>>();
            foreach (Transform at in go.GetComponentsInChildren<Transform>(true))
            {
                List<Transform> same;
                if (!byName.TryGetValue(at.name, out same)) byName[at.name] = same = new List<Transform>();
                same.Add(at);
            }
            Dictionary<string, SkeletonBone> skeleton = new Dictionary<string, SkeletonBone>();
            foreach (SkeletonBone bone in description.skeleton)
            {
                if (skeleton.ContainsKey(bone.name)) return "the skeleton names '" + bone.name + "' twice";
                if (!byName.ContainsKey(bone.name)) return "skeleton bone '" + bone.name + "' is not in the hierarchy";
                Quaternion q = bone.rotation;
                if (Mathf.Abs(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w - 1f) > 1e-3f) return "the rotation of skeleton bone '" + bone.name + "' is not a unit quaternion";
                skeleton[bone.name] = bone;
            }
            string[] names = HumanTrait.BoneName;
            Transform[] mapped = new Transform[names.Length];
            Dictionary<string, string> owner = new Dictionary<string, string>();
            foreach (HumanBone bone in description.human)
            {
                int role = Array.IndexOf(names, bone.humanName);
                if (role < 0) return "'" + bone.humanName + "' is no human bone";
                if (mapped[role] != null) return "human bone '" + bone.humanName + "' is mapped twice";
                List<Transform> found;
                if (string.IsNullOrEmpty(bone.boneName) || !byName.TryGetValue(bone.boneName, out found)) return "transform '" + bone.boneName + "' for human bone '" + bone.humanName + "' not found";
                if (found.Count > 1) return "transform name '" + bone.boneName + "' for human bone '" + bone.humanName + "' is ambiguous: " + found.Count + " transforms have it";
                if (owner.ContainsKey(bone.boneName)) return "transform '" + bone.boneName + "' is mapped to '" + owner[bone.boneName] + "' and to '" + bone.humanName + "'";
                if (!skeleton.ContainsKey(bone.boneName)) return "transform '" + bone.boneName + "' of human bone '" + bone.humanName + "' is not in the skeleton";
                owner[bone.boneName] = bone.humanName;
                mapped[role] = found[0];
            }
            for (int role = 0; role < mapped.Length; role++)
            {
                if (mapped[role] == null) { if (HumanTrait.RequiredBone(role)) return "required human bone '" + names[role] + "' not found"; continue; }
                int parent = HumanTrait.GetParentBone(role);
                while (parent >= 0 && mapped[parent] == null) parent = HumanTrait.GetParentBone(parent);
                if (parent >= 0 && (mapped[role] == mapped[parent] || !mapped[role].IsChildOf(mapped[parent])))
                    return "transform '" + mapped[role].name + "' of '" + names[role] + "' is not below '" + mapped[parent].name + "' of '" + names[parent] + "'";
                for (Transform at = mapped[role].parent; at != null && at != go.transform; at = at.parent)
                    if (!skeleton.ContainsKey(at.name)) return "transform '" + at.name + "', above '" + mapped[role].name + "', is not in the skeleton";
                if (parent >= 0)
                {
                    Vector3 offset = Vector3.zero;
                    for (Transform at = mapped[role]; at != mapped[parent]; at = at.parent) offset += skeleton[at.name].position;
                    if (offset.magnitude == 0f) return "human bone '" + names[role] + "' has no length: it lies at '" + names[parent] + "'";
                }
            }
            return null;
        }
    }

    public enum AnimatorCullingMode { AlwaysAnimate, CullUpdateTransforms, CullCompletely }
    public enum AnimatorUpdateMode { Normal, AnimatePhysics, UnscaledTime }

    [DisallowMultipleComponent]
    public class Animator : Behaviour
    {
        Avatar m_Avatar;
        RuntimeAnimatorController m_Controller;
        bool m_RootMotion, m_Optimized;
        AnimatorCullingMode m_Culling = AnimatorCullingMode.CullUpdateTransforms;
        AnimatorUpdateMode m_Update;
        // Bones that were asked for stay known until the next Avatar, wherever they hang by then.
        [UnityStubs.Transient] Dictionary<HumanBodyBones, Transform> m_Bound;
        public Avatar avatar { get { Alive(); return m_Avatar; } set { Alive(); m_Avatar = value; m_Bound = null; } }
        public RuntimeAnimatorController runtimeAnimatorController { get { return m_Controller; } set { m_Controller = value; } }
        public bool isHuman { get { Alive(); return m_Avatar != null && m_Avatar.isHuman; } }
        public bool applyRootMotion { get { return m_RootMotion; } set { m_RootMotion = value; } }
        public AnimatorCullingMode cullingMode { get { return m_Culling; } set { m_Culling = value; } }
        public AnimatorUpdateMode updateMode { get { return m_Update; } set { m_Update = value; } }
        // False where the importer folded the bones away ("Optimize Game Objects").
        public bool hasTransformHierarchy { get { Alive(); return !m_Optimized; } internal set { m_Optimized = !value; } }
        public bool isInitialized { get { return gameObject.activeInHierarchy; } }
        public float humanScale { get { return 1f; } }
        public void Rebind() { Alive(); m_Bound = null; }
        public void Update(float deltaTime) { Alive(); }
        public Transform GetBoneTransform(HumanBodyBones humanBoneId)
        {
            Alive();
            if (humanBoneId < 0 || humanBoneId >= HumanBodyBones.LastBone) throw new IndexOutOfRangeException("humanBoneId must be between 0 and " + HumanBodyBones.LastBone);
            if (m_Avatar == null) throw new InvalidOperationException("The Animator of '" + name + "' has no Avatar");
            if (!m_Avatar.isValid) throw new InvalidOperationException("The Avatar of '" + name + "' is not valid");
            if (!m_Avatar.isHuman) throw new InvalidOperationException("The Avatar of '" + name + "' is not humanoid");
            if (!UnityStubs.Settings.AnimatorsKnowTheirBones) return null;
            Transform bound;
            if (m_Bound != null && m_Bound.TryGetValue(humanBoneId, out bound) && bound != null) return bound;
            string human = HumanTrait.BoneName[(int)humanBoneId];
            foreach (HumanBone bone in m_Avatar.m_Description.human)
            {
                if (bone.humanName != human) continue;
                Transform found = transform.Find(m_Avatar.m_Paths[bone.boneName]);
                if (found == null) return null;
                if (m_Bound == null) m_Bound = new Dictionary<HumanBodyBones, Transform>();
                return m_Bound[humanBoneId] = found;
            }
            return null;
        }
    }
    public sealed class Animation : Behaviour { }
}
