using UnityEditor;
using UnityEngine;
using UnityEngine.SceneManagement;

namespace SuperDeform.Editor
{
    /// <summary>Transforms that stand for the avatar's: the same hierarchy, names, rotations and scales, moved joints.</summary>
    internal sealed class ProxySkeleton
    {
        readonly AvatarData avatar;
        readonly Transform[] joints;
        readonly Matrix4x4[] inverses;
        readonly Vector3[] places;
        readonly Quaternion[] turns;

        internal Transform Root { get; private set; }

        internal ProxySkeleton(AvatarData avatar)
        {
            this.avatar = avatar;
            // Hidden from the start: what is hidden later has changed the scene by then.
            Root = EditorUtility.CreateGameObjectWithHideFlags(avatar.Root.name + " (preview)", HideFlags.HideAndDontSave).transform;
            // The scene of the avatar, which need not be the active one; the view of a prefab shows its own alone.
            if (avatar.Root.scene.IsValid()) SceneManager.MoveGameObjectToScene(Root.gameObject, avatar.Root.scene);
            joints = new Transform[avatar.Joints.Length];
            inverses = new Matrix4x4[joints.Length];
            places = new Vector3[joints.Length];
            turns = new Quaternion[joints.Length];
            for (int joint = 0; joint < joints.Length; joint++)
            {
                Transform source = avatar.Joints[joint];
                if (source == avatar.Root.transform)
                {
                    joints[joint] = Root;
                    continue;
                }
                joints[joint] = EditorUtility.CreateGameObjectWithHideFlags(source.name, HideFlags.HideAndDontSave).transform;
                joints[joint].SetParent(Of(avatar.Parents[joint]), false);
                joints[joint].localScale = source.localScale;
            }
        }

        /// <summary>Stands where a root stands, some way aside in the world.</summary>
        internal void Place(Transform root, Vector3 aside)
        {
            Root.position = root.position + aside;
            Root.rotation = root.rotation;
            Root.localScale = root.lossyScale;
        }

        /// <summary>The transform that stands for a joint; the root for -1.</summary>
        internal Transform Of(int joint) => joint < 0 ? Root : joints[joint];

        /// <summary>Model space to joint space at rest, as moved; the identity for -1.</summary>
        internal Matrix4x4 InverseRest(int joint) => joint < 0 ? Matrix4x4.identity : inverses[joint];

        /// <summary>Takes the joints' rest pose for the bind poses. Without garbage.</summary>
        internal void Move(AvatarResult result)
        {
            for (int joint = 0; joint < joints.Length; joint++)
            {
                inverses[joint] = result.Rest[joint].Inverse.ToMatrix4x4();
            }
        }

        /// <summary>Whether the avatar stands otherwise than at the last Stand. Without garbage.</summary>
        internal bool HasMoved()
        {
            for (int joint = 0; joint < joints.Length; joint++)
            {
                Transform source = avatar.Joints[joint];
                // Against what was read, not against the copy, whose rotation Unity normalizes.
                if (source != null && joints[joint] != Root
                    && !(source.localPosition.Equals(places[joint]) && source.localRotation.Equals(turns[joint])))
                {
                    return true;
                }
            }
            return false;
        }

        /// <summary>Stands as the avatar stands now, each joint moved by what the result says.</summary>
        internal void Stand(AvatarResult result)
        {
            for (int joint = 0; joint < joints.Length; joint++)
            {
                Transform source = avatar.Joints[joint];
                if (source == null || joints[joint] == Root) continue;
                places[joint] = source.localPosition;
                turns[joint] = source.localRotation;
                joints[joint].localPosition = places[joint] + result.LocalShifts[joint];
                joints[joint].localRotation = turns[joint];
                joints[joint].localScale = source.localScale * result.LocalScale(joint);
            }
        }

        internal void Destroy()
        {
            if (Root != null) Object.DestroyImmediate(Root.gameObject);
        }
    }
}
