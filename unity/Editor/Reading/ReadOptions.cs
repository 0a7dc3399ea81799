using System.Collections.Generic;
using UnityEngine;

namespace SuperDeform.Editor
{
    /// <summary>How an avatar is read.</summary>
    public sealed class ReadOptions
    {
        /// <summary>Reads blend shapes too: needed for a result, not for a preview or a measurement.</summary>
        public bool WithMorphs;

        /// <summary>
        /// Reads the blend shapes that are on as one, by their weights: the avatar as it is worn, for a preview.
        /// </summary>
        public bool AsWorn;

        /// <summary>
        /// By renderer of the avatar, the one whose mesh, materials and blend shapes are read instead; others are read themselves,
        /// and all if this is null.
        /// </summary>
        public Dictionary<Renderer, Renderer> Shown;

        /// <summary>Makes a rig even where the avatar has one, and takes rigs that show no humanoid.</summary>
        public bool RigAuto;

        /// <summary>How a rig is made where one is; null for the defaults.</summary>
        public Options RigOptions;

        /// <summary>Hears how far the making of a rig is; null for none.</summary>
        public ProgressHandler RigProgress;
    }
}
