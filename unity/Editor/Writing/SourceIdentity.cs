using System.Collections.Generic;
using UnityEditor;
using UnityEditor.SceneManagement;
using UnityEngine;

namespace SuperDeform.Editor
{
    /// <summary>How surely a result is one of an avatar.</summary>
    internal enum SourceMatch
    {
        /// <summary>It is another avatar's.</summary>
        None,

        /// <summary>It was made of what stood in the same place of the same scene, perhaps of another avatar.</summary>
        Place,

        /// <summary>It was made of this one.</summary>
        Same
    }

    /// <summary>What an avatar is known by, from one conversion to the next.</summary>
    /// <remarks>
    /// An asset by its file, and its place in it; in Prefab Mode it is the prefab's file. An object of a scene by Unity's own number of
    /// it, which there is once it has been saved with its scene; while the editor runs by its instance, too; and by its place in the
    /// scene, which another one may take.
    /// </remarks>
    internal sealed class SourceIdentity
    {
        const string Session = "SuperDeform.Session", Asset = "asset ", Number = "object ", Instance = "instance ", Place = "place ";

        readonly List<string> names = new List<string>();

        /// <summary>Where it is, for a person to read: a file, and the way to it in there.</summary>
        internal string Where { get; private set; }

        internal SourceIdentity(GameObject avatar)
        {
            PrefabStage stage = PrefabStageUtility.GetPrefabStage(avatar);
            if (EditorUtility.IsPersistent(avatar) || stage != null)
            {
                string file = stage == null ? AssetDatabase.GetAssetPath(avatar) : stage.assetPath;
                string inside = PathOf(avatar.transform, stage == null ? avatar.transform.root : stage.prefabContentsRoot.transform);
                names.Add(Asset + AssetDatabase.AssetPathToGUID(file) + inside);
                Where = file + inside;
                return;
            }
            string scene = avatar.scene.path, place = PathOf(avatar.transform, null);
            GlobalObjectId number = GlobalObjectId.GetGlobalObjectIdSlow(avatar);
            // 0: it has none yet, and all that have none are alike.
            if (number.identifierType != 0 && number.targetObjectId != 0) names.Add(Number + number);
            names.Add(Instance + ThisSession() + " " + InstanceOf(avatar));
            if (!string.IsNullOrEmpty(scene)) names.Add(Place + AssetDatabase.AssetPathToGUID(scene) + place);
            Where = (string.IsNullOrEmpty(scene) ? avatar.scene.name : scene) + place;
        }

        /// <summary>The way down to a transform, each name with its number among its like: "/Room/Mika", "/Room/Mika#1".</summary>
        /// <param name="root">Where the way begins; null: with the root of the scene.</param>
        static string PathOf(Transform transform, Transform root)
        {
            if (transform == root) return "";
            int number = 0;
            foreach (GameObject other in SiblingsOf(transform))
            {
                if (other == transform.gameObject) break;
                if (other.name == transform.name) number++;
            }
            string above = transform.parent == null ? "" : PathOf(transform.parent, root);
            return above + "/" + transform.name + (number == 0 ? "" : "#" + number);
        }

        static IEnumerable<GameObject> SiblingsOf(Transform transform)
        {
            if (transform.parent == null) return transform.gameObject.scene.GetRootGameObjects();
            var siblings = new List<GameObject>();
            for (int child = 0; child < transform.parent.childCount; child++)
            {
                siblings.Add(transform.parent.GetChild(child).gameObject);
            }
            return siblings;
        }

        /// <summary>The number of an object while the editor runs.</summary>
        static string InstanceOf(GameObject avatar)
        {
#if UNITY_6000_5_OR_NEWER
            return avatar.GetEntityId().ToString();
#else
            return avatar.GetInstanceID().ToString();
#endif
        }

        /// <summary>A name for the time until the editor is closed: instances have other numbers afterwards.</summary>
        static string ThisSession()
        {
            string session = SessionState.GetString(Session, "");
            if (session.Length == 0) SessionState.SetString(Session, session = System.Guid.NewGuid().ToString("N"));
            return session;
        }

        /// <summary>As a result keeps it.</summary>
        public override string ToString() => string.Join("\n", names.ToArray());

        /// <param name="kept">What ToString gave when a result was made.</param>
        internal SourceMatch Matches(string kept)
        {
            var others = new List<string>((kept ?? "").Split('\n'));
            List<string> same = names.FindAll(others.Contains);
            if (same.Exists(name => !name.StartsWith(Place))) return SourceMatch.Same;
            if (same.Count == 0) return SourceMatch.None;
            // Another object of this session, or of another number, has come into the place.
            return SourceMatch.Place;
        }
    }
}
