using System.Collections.Generic;
using UnityEngine;

namespace SuperDeform.Editor
{
    /// <summary>
    /// Settings as an asset: to be kept, shared, and used again. Each result carries those that made it.
    /// </summary>
    [CreateAssetMenu(fileName = "SuperDeformPreset", menuName = "Super Deform Preset")]
    public sealed class SuperDeformPreset : ScriptableObject
    {
        public ConversionSettings Settings = new ConversionSettings();

        /// <summary>Of a result: the avatar that it was made of, so that it is found again.</summary>
        [HideInInspector] public string Avatar = "";

        /// <summary>Of a result: the names of all objects and components that were made; others are a person's own.</summary>
        [HideInInspector] public List<string> Made = new List<string>();
    }
}
