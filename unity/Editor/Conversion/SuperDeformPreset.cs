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
    }
}
