using System;
using UnityEngine;

namespace SuperDeform.Editor
{
    /// <summary>
    /// An avatar that is read and measured once, and deformed again when settings change: a slider costs what the library has to
    /// do again, and a deformation into arrays that are kept.
    /// </summary>
    internal sealed class PreviewFigure : IDisposable
    {
        readonly PreviewStyle style = new PreviewStyle();
        Deformer deformer;
        bool pushedEarlier;

        internal AvatarData Avatar { get; private set; }

        internal AvatarResult Result { get; private set; }

        /// <summary>What Result was made by.</summary>
        internal ConversionSettings Shown { get; private set; }

        internal Deformer Deformer => deformer;

        /// <param name="reading">With AsWorn.</param>
        /// <param name="atRest">Whether vertices stay at rest in the root's space, which saves the way back to each mesh's.</param>
        /// <param name="progress">May be null.</param>
        /// <exception cref="ConversionException">The avatar cannot be read or deformed, and why.</exception>
        internal PreviewFigure(GameObject avatar, ConversionSettings settings, ReadOptions reading, bool atRest, ProgressHandler progress)
        {
            try
            {
                Avatar = CharacterReader.Read(avatar, reading);
                Deform(settings, SettingsChange.Style, false, progress);
                Result = new AvatarResult(Avatar, atRest);
                Result.Apply(deformer, null);
            }
            catch (Exception cause)
            {
                Dispose();
                throw ConversionException.From(cause, avatar);
            }
        }

        /// <summary>Brings the result up to settings; only what depends on the change is done again.</summary>
        /// <param name="moving">Whether a slider moves: clothes stay pushed as they were, until Settle.</param>
        /// <returns>Whether anything had changed.</returns>
        /// <exception cref="ConversionException">They cannot be; the result stays as it was.</exception>
        internal bool Update(ConversionSettings settings, bool moving)
        {
            SettingsChange change = SettingsChanges.Between(Shown, settings);
            if (change == SettingsChange.None) return false;
            return Change(settings, change, moving);
        }

        /// <summary>Pushes clothes anew where they stayed as they were.</summary>
        /// <returns>Whether they had.</returns>
        /// <exception cref="ConversionException">They cannot be; the result stays as it was.</exception>
        internal bool Settle() => pushedEarlier && Change(Shown, SettingsChange.Options, false);

        bool Change(ConversionSettings settings, SettingsChange change, bool moving)
        {
            if (change == SettingsChange.Rig) throw new InvalidOperationException("Another rig needs the avatar to be read anew.");
            try
            {
                Deform(settings, change, moving, null);
                Result.Apply(deformer, null);
                return true;
            }
            catch (Exception cause)
            {
                throw ConversionException.From(cause, Avatar.Root);
            }
        }

        void Deform(ConversionSettings settings, SettingsChange change, bool moving, ProgressHandler progress)
        {
            bool asEarlier = moving && change == SettingsChange.Options && settings.Options.Repair == Repair.On;
            if (change == SettingsChange.Options)
            {
                Options options = settings.Options.Clone();
                if (asEarlier) options.Repair = Repair.Kept;
                deformer.SetOptions(options, null);
            }
            else
            {
                using (Style wanted = style.Make(settings))
                {
                    // A slider of the style: the character is not measured again. With other options it is made anew, so that what fails
                    // leaves nothing half changed.
                    if (deformer != null && !pushedEarlier && SettingsChanges.SameOptions(Shown, settings))
                    {
                        deformer.SetStyle(wanted);
                        Shown = settings.Clone();
                        return;
                    }
                    var made = new Deformer(Avatar.Character, wanted, settings.Options, progress);
                    if (deformer != null) deformer.Dispose();
                    deformer = made;
                }
            }
            pushedEarlier = asEarlier;
            Shown = settings.Clone();
        }

        public void Dispose()
        {
            if (deformer != null) deformer.Dispose();
            style.Dispose();
            if (Avatar != null) Avatar.Dispose();
        }
    }
}
