using System;
using UnityEditor;
using UnityEditor.SceneManagement;
using UnityEngine;
using UnityEngine.SceneManagement;

namespace SuperDeform.Editor
{
    /// <summary>A scene of its own for what is made on the way to a file: nobody's scene changes by it.</summary>
    internal sealed class ScratchScene : IDisposable
    {
        readonly Scene scene;
        readonly GameObject holder;

        internal ScratchScene()
        {
            scene = EditorSceneManager.NewPreviewScene();
            holder = EditorUtility.CreateGameObjectWithHideFlags("Super Deform", HideFlags.HideAndDontSave);
            SceneManager.MoveGameObjectToScene(holder, scene);
        }

        /// <summary>A copy of an object, at the same place in its parent's space.</summary>
        internal GameObject Copy(GameObject original)
        {
            // With a parent it is made in the parent's scene.
            return UnityEngine.Object.Instantiate(original, holder.transform, false);
        }

        public void Dispose()
        {
            EditorSceneManager.ClosePreviewScene(scene);
        }
    }
}
