using System.Collections.Generic;
using UnityEditor;
using UnityEngine;

namespace SuperDeform.Editor
{
    /// <summary>An avatar as it was, for the case that a change in place does not come to its end.</summary>
    /// <remarks>What a conversion changes comes back: components' values, places of transforms, objects that were added.</remarks>
    internal sealed class AvatarSnapshot
    {
        readonly GameObject root;
        readonly Dictionary<Component, string> values = new Dictionary<Component, string>();
        readonly Dictionary<Transform, KeyValuePair<Vector3, Vector3>> places = new Dictionary<Transform, KeyValuePair<Vector3, Vector3>>();

        internal AvatarSnapshot(GameObject root)
        {
            this.root = root;
            foreach (Component component in root.GetComponentsInChildren<Component>(true))
            {
                Transform transform = component as Transform;
                if (transform != null) places.Add(transform, new KeyValuePair<Vector3, Vector3>(transform.localPosition, transform.localScale));
                // Null where a script is missing.
                else if (component != null) values.Add(component, EditorJsonUtility.ToJson(component));
            }
        }

        internal void Restore()
        {
            foreach (Transform transform in root.GetComponentsInChildren<Transform>(true))
            {
                if (transform != null && !places.ContainsKey(transform)) Object.DestroyImmediate(transform.gameObject);
            }
            foreach (Component component in root.GetComponentsInChildren<Component>(true))
            {
                if (component != null && !(component is Transform) && !values.ContainsKey(component)) Object.DestroyImmediate(component);
            }
            foreach (KeyValuePair<Component, string> kept in values)
            {
                if (kept.Key != null && EditorJsonUtility.ToJson(kept.Key) != kept.Value) EditorJsonUtility.FromJsonOverwrite(kept.Value, kept.Key);
            }
            // Last: an Animator that gets its Avatar back may move its bones.
            foreach (KeyValuePair<Transform, KeyValuePair<Vector3, Vector3>> place in places)
            {
                if (place.Key == null) continue;
                place.Key.localPosition = place.Value.Key;
                place.Key.localScale = place.Value.Value;
            }
        }
    }
}
