using System.Collections.Generic;
using UnityEngine;

namespace SuperDeform.Editor
{
    /// <summary>
    /// Outlines whose width is a length, not a share of the picture, keep their look on a smaller figure: the new avatar gets
    /// copies of such materials, with a width in proportion to its height.
    /// </summary>
    internal static class Outlines
    {
        // MToon, in both versions of VRM. The mode: 0 none, 1 a width in the world, 2 a width on the screen.
        const string Mode = "_OutlineWidthMode", Width = "_OutlineWidth";

        internal static void Scale(GameObject copy, PointMap map)
        {
            if (map.HeightRatio == 1f) return;
            Dictionary<Material, Material> scaled = new Dictionary<Material, Material>();
            foreach (Renderer renderer in copy.GetComponentsInChildren<Renderer>(true))
            {
                Material[] materials = renderer.sharedMaterials;
                bool changed = false;
                for (int slot = 0; slot < materials.Length; slot++)
                {
                    if (!HasWidth(materials[slot])) continue;
                    materials[slot] = Scaled(materials[slot], scaled, map);
                    changed = true;
                }
                if (changed) renderer.sharedMaterials = materials;
            }
        }

        static bool HasWidth(Material material)
        {
            return material != null && material.HasProperty(Mode) && material.HasProperty(Width)
                && material.GetFloat(Mode) == 1f && material.GetFloat(Width) > 0f;
        }

        static Material Scaled(Material material, Dictionary<Material, Material> scaled, PointMap map)
        {
            Material copy;
            if (scaled.TryGetValue(material, out copy)) return copy;
            copy = Object.Instantiate(material);
            // Expressions find their materials by name.
            copy.name = material.name;
            copy.SetFloat(Width, material.GetFloat(Width) * map.HeightRatio);
            map.AddAsset(copy);
            scaled.Add(material, copy);
            return copy;
        }
    }
}
