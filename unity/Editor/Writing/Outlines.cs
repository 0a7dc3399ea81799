using System.Collections.Generic;
using UnityEngine;

namespace SuperDeform.Editor
{
    /// <summary>
    /// Outlines and fur whose width is a length, not a share of the picture, keep their look on a smaller figure: the new avatar
    /// gets copies of such materials, with a width in proportion to its height.
    /// </summary>
    /// <remarks>
    /// MToon of VRM 0.x and lilToon count in centimetres, MToon of VRM 1.0 in metres, Poiyomi in hundredths of a metre: all are
    /// multiplied.
    /// </remarks>
    internal static class Outlines
    {
        // MToon alone has a mode: 0 none, 1 a width in the world, 2 a width on the screen.
        const string Mode = "_OutlineWidthMode", Width = "_OutlineWidth";

        // Poiyomi. A locked material has its numbers in a shader of its own.
        const string PoiyomiWidth = "_LineWidth", PoiyomiOn = "_EnableOutlines", Locked = "Hidden/Locked/";

        // lilToon: a direction, and a length as its fourth number.
        const string Fur = "_FurVector";

        /// <param name="findings">Receives materials whose width cannot be changed.</param>
        internal static void Scale(GameObject copy, PointMap map, List<Finding> findings)
        {
            if (map.HeightRatio == 1f) return;
            var scaled = new Dictionary<Material, Material>();
            foreach (Renderer renderer in copy.GetComponentsInChildren<Renderer>(true))
            {
                Material[] materials = renderer.sharedMaterials;
                bool changed = false;
                for (int slot = 0; slot < materials.Length; slot++)
                {
                    if (materials[slot] == null) continue;
                    Material made = Scaled(materials[slot], scaled, map, findings);
                    changed |= made != materials[slot];
                    materials[slot] = made;
                }
                if (changed) renderer.sharedMaterials = materials;
            }
        }

        /// <summary>A copy with other widths; the material itself where it has none.</summary>
        static Material Scaled(Material material, Dictionary<Material, Material> scaled, PointMap map, List<Finding> findings)
        {
            if (scaled.TryGetValue(material, out Material copy)) return copy;
            List<string> widths = Widths(material);
            bool fur = HasFur(material);
            if (widths.Contains(PoiyomiWidth) && material.shader != null && material.shader.name.StartsWith(Locked, System.StringComparison.Ordinal))
            {
                findings.Add(new Finding("locked_material", Severity.Warning, material, material.name));
                widths.Remove(PoiyomiWidth);
            }
            scaled.Add(material, material);
            if (widths.Count == 0 && !fur) return material;
            copy = Object.Instantiate(material);
            // Expressions find their materials by name.
            copy.name = material.name;
            foreach (string width in widths)
            {
                copy.SetFloat(width, material.GetFloat(width) * map.HeightRatio);
            }
            if (fur)
            {
                Vector4 vector = material.GetVector(Fur);
                copy.SetVector(Fur, new Vector4(vector.x, vector.y, vector.z, vector.w * map.HeightRatio));
            }
            map.Replace(material, copy);
            scaled[material] = copy;
            return copy;
        }

        /// <summary>The properties that are lengths and not 0.</summary>
        static List<string> Widths(Material material)
        {
            var widths = new List<string>();
            bool inWorld = !material.HasProperty(Mode) || material.GetFloat(Mode) == 1f;
            if (inWorld && IsPositive(material, Width)) widths.Add(Width);
            bool drawn = !material.HasProperty(PoiyomiOn) || material.GetFloat(PoiyomiOn) != 0f;
            if (drawn && IsPositive(material, PoiyomiWidth)) widths.Add(PoiyomiWidth);
            return widths;
        }

        static bool IsPositive(Material material, string property) => material.HasProperty(property) && material.GetFloat(property) > 0f;

        static bool HasFur(Material material) =>
            material.HasProperty(Fur) && material.shader != null && material.shader.name.Contains("Fur") && material.GetVector(Fur).w > 0f;
    }
}
