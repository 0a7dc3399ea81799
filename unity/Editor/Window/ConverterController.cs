using System;
using System.IO;
using UnityEditor;
using UnityEngine;

namespace SuperDeform.Editor
{
    /// <summary>What happens behind the converter window: the preview follows the model, and buttons do their work.</summary>
    /// <remarks>The window, which draws, calls Tick on every update of the editor; tests call it too.</remarks>
    public sealed class ConverterController : IDisposable
    {
        // How long settings rest, in seconds, before what takes longer than a frame: measuring the result, reading the avatar.
        internal const double Rest = 0.25;

        readonly ConverterModel model;
        PreviewSession preview;
        bool stale = true;
        bool measured;
        double changedAt;
        bool resting, wornOtherwise;

        public ConverterController(ConverterModel model)
        {
            this.model = model;
            model.Changed += MarkStale;
            SceneView.duringSceneGui += DrawBadge;
        }

        /// <summary>What the Scene view shows; null where there is no preview.</summary>
        public PreviewSession Preview => preview;

        /// <summary>While nobody can see the window there is no preview: the avatar is seen as it is.</summary>
        public bool Resting
        {
            get { return resting; }
            set
            {
                stale |= resting != value;
                resting = value;
            }
        }

        void DrawBadge(SceneView view)
        {
            if (preview != null && preview.IsAlive) PreviewBadge.Draw(view, preview);
        }

        /// <summary>Brings the preview up to the model, and measures once settings rest.</summary>
        /// <param name="now">Seconds, as EditorApplication.timeSinceStartup.</param>
        /// <returns>Whether something on the screen has changed.</returns>
        public bool Tick(double now)
        {
            if (preview != null && !preview.IsAlive)
            {
                // The avatar was deleted, or its scene was closed.
                Drop();
                stale = true;
            }
            if (preview != null && preview.IsWornOtherwise != wornOtherwise)
            {
                // A slider of a blend shape moves: when it rests, the avatar is read anew.
                wornOtherwise = !wornOtherwise;
                changedAt = now;
            }
            if (preview != null && wornOtherwise && now - changedAt >= Rest)
            {
                Drop();
                stale = true;
            }
            if (stale)
            {
                stale = false;
                wornOtherwise = false;
                measured = false;
                changedAt = now;
                Follow();
                return true;
            }
            if (preview != null && preview.Follow()) return true;
            if (preview == null || measured || now - changedAt < Rest) return false;
            measured = true;
            Measure();
            return true;
        }

        void Follow()
        {
            if (resting || !model.PreviewOn || !model.CanConvert)
            {
                Drop();
                model.SetPreviewFailure(null);
                return;
            }
            try
            {
                if (preview != null && !preview.Fits(model.Avatar, model.Settings)) Drop();
                if (preview != null) preview.Update(model.Settings, true);
                else
                {
                    using (var progress = new EditorProgress(model.Avatar.name, 1))
                    {
                        preview = new PreviewSession(model.Avatar, model.Settings, progress);
                    }
                }
                preview.ShowBefore = model.ShowBefore;
                preview.Beside = model.Beside;
                preview.Pose = model.Pose;
                model.SetPreviewFailure(null);
            }
            catch (Exception fault)
            {
                Drop();
                model.SetPreviewFailure(Reason(fault));
            }
        }

        void Measure()
        {
            try
            {
                preview.Settle();
                model.SetNumbers(preview.Measure());
            }
            catch (Exception fault)
            {
                model.SetPreviewFailure(Reason(fault));
            }
        }

        /// <summary>Makes the prefab; what went wrong is told by the model.</summary>
        /// <returns>Whether there is a prefab.</returns>
        public bool Convert(IConversionProgress progress)
        {
            // The avatar is to be seen, and copied, as it is.
            Drop();
            stale = true;
            try
            {
                ConversionSettings settings = model.Settings;
                if (!MayReplace(ref settings, out bool replace)) return false;
                model.SetResult(Converter.Convert(model.Avatar, settings, progress, replace));
                return true;
            }
            catch (Exception fault)
            {
                model.SetFailure(Reason(fault));
                return false;
            }
        }

        /// <summary>Asks where a result may be another avatar's, that stood in the same place.</summary>
        /// <param name="settings">Those for a new copy, where that is what the person wants.</param>
        /// <returns>Whether to go on.</returns>
        bool MayReplace(ref ConversionSettings settings, out bool replace)
        {
            replace = false;
            ResultUpdate earlier = Converter.Earlier(model.Avatar, settings);
            if (earlier == null || earlier.Match == SourceMatch.Same || Application.isBatchMode) return true;
            int answer = EditorUtility.DisplayDialogComplex(Strings.Get("window.title"),
                Strings.Get("ask_replace", earlier.PrefabPath, earlier.MadeFrom, model.Avatar.name),
                Strings.Get("ask_replace.replace"), Strings.Get("ask_replace.cancel"), Strings.Get("report.new_copy"));
            replace = answer == 0;
            if (answer != 2) return replace;
            settings = settings.Clone();
            settings.NewCopy = true;
            return true;
        }

        /// <summary>Saves the style as a file that can be chosen as a saved style.</summary>
        /// <param name="path">From the project's folder, such as Assets/chibi.json.</param>
        public void SaveStyle(string path)
        {
            try
            {
                using (Style style = model.Settings.MakeStyle())
                {
                    File.WriteAllText(path, style.ToJson());
                }
                AssetDatabase.ImportAsset(path);
            }
            catch (Exception fault)
            {
                model.SetFailure(Reason(fault));
            }
        }

        /// <summary>Saves the settings as a file that can be taken again; one that is there is changed.</summary>
        /// <param name="path">From the project's folder, such as Assets/chibi.asset.</param>
        public void SavePreset(string path)
        {
            try
            {
                SuperDeformPreset preset = AssetDatabase.LoadAssetAtPath<SuperDeformPreset>(path);
                bool isNew = preset == null;
                if (isNew) preset = ScriptableObject.CreateInstance<SuperDeformPreset>();
                preset.Settings = model.Settings.Clone();
                if (isNew) AssetDatabase.CreateAsset(preset, path);
                EditorUtility.SetDirty(preset);
                AssetDatabase.SaveAssetIfDirty(preset);
            }
            catch (Exception fault)
            {
                model.SetFailure(Reason(fault));
            }
        }

        Finding Reason(Exception fault)
        {
            Finding reason = ConversionException.From(fault, model.Avatar).Finding;
            // A reason that nobody foresaw: where it came from is worth a report.
            if (reason.Key == "failed") Debug.LogException(fault);
            return reason;
        }

        void MarkStale()
        {
            stale = true;
        }

        void Drop()
        {
            if (preview != null) preview.Dispose();
            preview = null;
        }

        /// <summary>Ends the preview: the avatar is seen again as it is.</summary>
        public void Dispose()
        {
            model.Changed -= MarkStale;
            SceneView.duringSceneGui -= DrawBadge;
            Drop();
        }
    }
}
