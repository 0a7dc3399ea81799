using System.Collections.Generic;
using UnityEngine;

namespace SuperDeform.Editor
{
    /// <summary>
    /// Settings as an asset: to be kept, shared, and used again. Each result carries those that made it.
    /// </summary>
    [CreateAssetMenu(fileName = "SuperDeformPreset", menuName = "Super Deform Preset")]
    [Manual]
    public sealed class SuperDeformPreset : ScriptableObject
    {
        public ConversionSettings Settings = new ConversionSettings();

        /// <summary>Of a result: what the avatar that it was made of is known by, so that it is found again.</summary>
        [HideInInspector] public string Avatar = "";

        /// <summary>Of a result: where that avatar is, for a person to read.</summary>
        [HideInInspector] public string MadeFrom = "";

        /// <summary>Of a result: all objects and components as they were made; others, and other values, are a person's own.</summary>
        [HideInInspector] public List<MadeThing> Made = new List<MadeThing>();
    }
}
