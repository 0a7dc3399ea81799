using System.Collections.Generic;
using UnityEngine;
using UnityEngine.Rendering;

namespace SuperDeform.Editor
{
    /// <summary>
    /// What materials show, as the library wants it: how bright their main textures are. By this it sees painted irises and
    /// brows. Without a graphics device nothing is read, and these stay as they are.
    /// </summary>
    internal sealed class PaintedSurfaces
    {
        /// <summary>The library keeps no more pixels a side.</summary>
        const int LongestSide = 512;

        readonly Character character;
        readonly Dictionary<Texture, int> images = new Dictionary<Texture, int>();
        readonly Dictionary<RendererData, Vector2[]> allUvs = new Dictionary<RendererData, Vector2[]>();

        internal PaintedSurfaces(Character character)
        {
            this.character = character;
        }

        /// <summary>Tells the library's mesh of a part what the part shows.</summary>
        internal void Show(PartData part, MeshArrays mesh)
        {
            Texture texture = Shown(part.Material);
            Vector2[] uvs = UvsOf(part.Renderer);
            if (texture == null || uvs == null) return;
            int image = ImageOf(texture);
            if (image == 0) return;
            mesh.Image = image;
            mesh.Uvs = part.Gather(Moved(uvs, part.Material.mainTextureScale, part.Material.mainTextureOffset));
        }

        static Texture Shown(Material material)
        {
            // Unity complains of a main texture that the shader has no place for.
            bool has = material != null && (material.HasProperty("_MainTex") || material.HasProperty("_BaseMap"));
            return has ? material.mainTexture : null;
        }

        Vector2[] UvsOf(RendererData renderer)
        {
            if (!allUvs.TryGetValue(renderer, out Vector2[] uvs))
            {
                uvs = renderer.Mesh.uv;
                allUvs[renderer] = uvs = uvs.Length == renderer.Vertices.Length ? uvs : null;
            }
            return uvs;
        }

        static Vector2[] Moved(Vector2[] uvs, Vector2 scale, Vector2 offset)
        {
            if (scale == Vector2.one && offset == Vector2.zero) return uvs;
            return System.Array.ConvertAll(uvs, uv => new Vector2(scale.x * uv.x + offset.x, scale.y * uv.y + offset.y));
        }

        /// <summary>The number of a texture in the library, handed over once; 0 where it cannot be read.</summary>
        int ImageOf(Texture texture)
        {
            if (images.TryGetValue(texture, out int number)) return number;
            byte[] pixels = Brightness(texture, out int width, out int height);
            if (pixels != null) number = character.AddImage(width, height, pixels);
            images[texture] = number;
            return number;
        }

        /// <summary>A small copy of a texture in grey, the row of v = 0 first; imported textures may not be readable, so the
        /// graphics card makes it.</summary>
        static byte[] Brightness(Texture texture, out int width, out int height)
        {
            int longest = Mathf.Max(texture.width, texture.height, 1);
            float scale = Mathf.Min(1f, LongestSide / (float)longest);
            width = Mathf.Max(1, Mathf.RoundToInt(texture.width * scale));
            height = Mathf.Max(1, Mathf.RoundToInt(texture.height * scale));
            if (SystemInfo.graphicsDeviceType == GraphicsDeviceType.Null) return null;
            RenderTexture before = RenderTexture.active;
            RenderTexture small = RenderTexture.GetTemporary(width, height, 0, RenderTextureFormat.ARGB32, RenderTextureReadWrite.sRGB);
            var copy = new Texture2D(width, height, TextureFormat.RGBA32, false);
            try
            {
                Graphics.Blit(texture, small);
                RenderTexture.active = small;
                copy.ReadPixels(new Rect(0, 0, width, height), 0, 0);
                Color32[] colours = copy.GetPixels32();
                return System.Array.ConvertAll(colours, c => (byte)((54 * c.r + 183 * c.g + 19 * c.b) / 256));
            }
            finally
            {
                RenderTexture.active = before;
                RenderTexture.ReleaseTemporary(small);
                Object.DestroyImmediate(copy);
            }
        }
    }
}
