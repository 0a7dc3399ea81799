// Renderers, materials, textures and other assets that are only referred to.
using System;
using System.Collections.Generic;
using UnityEngine.Rendering;

namespace UnityEngine
{
    public class Texture : Object { public virtual int width { get; set; } public virtual int height { get; set; } }
    public class Texture2D : Texture
    {
        public Texture2D(int width, int height) { this.width = width; this.height = height; }
        Color32[] m_Pixels;
        public Texture2D(int width, int height, TextureFormat format, bool mipChain) : this(width, height) { }
        public void SetPixels32(Color32[] colors) { m_Pixels = colors; }
        public Color32[] GetPixels32() { return m_Pixels ?? new Color32[width * height]; }
        // Of the pixel that lies there: the graphics card mixes them.
        public void ReadPixels(Rect source, int destX, int destY)
        {
            Texture2D from = RenderTexture.active.Shown;
            Color32[] pixels = from.GetPixels32();
            m_Pixels = new Color32[width * height];
            for (int y = 0; y < height; y++)
                for (int x = 0; x < width; x++)
                    m_Pixels[y * width + x] = pixels[y * from.height / height * from.width + x * from.width / width];
        }
        public static Texture2D whiteTexture { get { return new Texture2D(4, 4); } }
        public static Texture2D grayTexture { get { return new Texture2D(4, 4); } }
    }
    public enum TextureFormat { RGBA32 = 4 }
    public enum RenderTextureFormat { ARGB32 = 0 }
    public enum RenderTextureReadWrite { Default, Linear, sRGB }
    public class RenderTexture : Texture
    {
        internal Texture2D Shown;
        public RenderTexture(int width, int height, int depth) { this.width = width; this.height = height; }
        public static RenderTexture active { get; set; }
        public static RenderTexture GetTemporary(int width, int height, int depthBuffer, RenderTextureFormat format, RenderTextureReadWrite readWrite) { return new RenderTexture(width, height, depthBuffer); }
        public static void ReleaseTemporary(RenderTexture temp) { DestroyImmediate(temp); }
    }
    public class Graphics { public static void Blit(Texture source, RenderTexture dest) { dest.Shown = (Texture2D)source; } }
    public sealed class SystemInfo { public static GraphicsDeviceType graphicsDeviceType { get { return GraphicsDeviceType.Vulkan; } } }
    public sealed class Shader : Object
    {
        static readonly Dictionary<string, Shader> s_Known = new Dictionary<string, Shader>();
        Shader() { }
        public static Shader Find(string name)
        {
            Shader known;
            if (!s_Known.TryGetValue(name, out known)) { s_Known[name] = known = new Shader(); known.m_Name = name; }
            return known;
        }
    }
    public class Material : Object
    {
        Shader m_Shader;
        Color m_Color = Color.white;
        Texture m_Texture;
        Dictionary<string, float> m_Floats = new Dictionary<string, float>();
        Dictionary<string, Vector4> m_Vectors = new Dictionary<string, Vector4>();
        public Material(Shader shader) { m_Shader = shader; }
        public Material(Material source) { m_Shader = source.m_Shader; m_Color = source.m_Color; m_Texture = source.m_Texture; m_Floats = new Dictionary<string, float>(source.m_Floats); m_Vectors = new Dictionary<string, Vector4>(source.m_Vectors); }
        // Shaders declare nothing here: a material has the properties that were set.
        public bool HasProperty(string name) { Alive(); return m_Floats.ContainsKey(name) || m_Vectors.ContainsKey(name) || (name == "_MainTex" && m_Texture != null); }
        public Vector4 GetVector(string name) { Vector4 value; Alive(); return m_Vectors.TryGetValue(name, out value) ? value : new Vector4(0, 0, 0, 0); }
        public void SetVector(string name, Vector4 value) { Alive(); m_Vectors[name] = value; }
        public bool HasFloat(string name) { return HasProperty(name); }
        public float GetFloat(string name) { float value; Alive(); return m_Floats.TryGetValue(name, out value) ? value : 0f; }
        public void SetFloat(string name, float value) { Alive(); m_Floats[name] = value; }
        public Shader shader { get { return m_Shader; } set { m_Shader = value; } }
        public Color color { get { return m_Color; } set { m_Color = value; } }
        public Vector2 mainTextureScale = Vector2.one;
        public Vector2 mainTextureOffset = Vector2.zero;
        public Texture mainTexture { get { return m_Texture; } set { m_Texture = value; } }
    }
    public class TextAsset : Object
    {
        string m_Text;
        public TextAsset() : this("") { }
        public TextAsset(string text) { m_Text = text ?? ""; }
        public string text { get { Alive(); return m_Text; } }
        public byte[] bytes { get { return System.Text.Encoding.UTF8.GetBytes(text); } }
        public override string ToString() { return text; }
    }
    public sealed class Resources
    {
        public static T[] FindObjectsOfTypeAll<T>() where T : Object { return UnityStubs.Registry.All().FindAll(delegate (Object value) { return value is T; }).ConvertAll(delegate (Object value) { return (T)value; }).ToArray(); }
        public static Object[] FindObjectsOfTypeAll(Type type) { return UnityStubs.Registry.All().FindAll(type.IsInstanceOfType).ToArray(); }
    }
    public sealed class AvatarMask : Object { }

    public class Renderer : Component
    {
        bool m_Enabled = true, m_Off, m_ReceiveShadows = true;
        Material[] m_Materials = new Material[0];
        ShadowCastingMode m_Shadows = ShadowCastingMode.On;
        Transform m_Anchor;
        LightProbeUsage m_LightProbes = LightProbeUsage.BlendProbes;
        ReflectionProbeUsage m_ReflectionProbes = ReflectionProbeUsage.BlendProbes;
        int m_SortingOrder;
        public bool enabled { get { Alive(); return m_Enabled; } set { Alive(); m_Enabled = value; } }
        public bool forceRenderingOff { get { return m_Off; } set { m_Off = value; } }
        public bool isVisible { get { return m_Enabled && !m_Off; } }
        public bool receiveShadows { get { return m_ReceiveShadows; } set { m_ReceiveShadows = value; } }
        public ShadowCastingMode shadowCastingMode { get { return m_Shadows; } set { m_Shadows = value; } }
        public LightProbeUsage lightProbeUsage { get { return m_LightProbes; } set { m_LightProbes = value; } }
        public ReflectionProbeUsage reflectionProbeUsage { get { return m_ReflectionProbes; } set { m_ReflectionProbes = value; } }
        public Transform probeAnchor { get { return m_Anchor; } set { m_Anchor = value; } }
        public int sortingOrder { get { return m_SortingOrder; } set { m_SortingOrder = value; } }
        public Material[] sharedMaterials { get { Alive(); return (Material[])m_Materials.Clone(); } set { Alive(); m_Materials = value == null ? new Material[0] : (Material[])value.Clone(); } }
        public Material sharedMaterial
        {
            get { Alive(); return m_Materials.Length == 0 ? null : m_Materials[0]; }
            set { Alive(); if (m_Materials.Length == 0) m_Materials = new Material[1]; m_Materials[0] = value; }
        }
        public void GetSharedMaterials(List<Material> m) { m.Clear(); m.AddRange(m_Materials); }
        // Unity leaks an instance of the material for each of these in edit mode and logs an error for it.
        public Material[] materials { get { Debug.LogError("renderer.material makes a copy that nobody destroys in edit mode: use sharedMaterial"); return sharedMaterials; } set { sharedMaterials = value; } }
        public Material material { get { Debug.LogError("renderer.material makes a copy that nobody destroys in edit mode: use sharedMaterial"); return sharedMaterial; } set { sharedMaterial = value; } }
        public Matrix4x4 localToWorldMatrix { get { return transform.localToWorldMatrix; } }
        public Matrix4x4 worldToLocalMatrix { get { return transform.worldToLocalMatrix; } }
        public virtual Bounds bounds { get { return World(LocalBounds, transform.localToWorldMatrix); } }
        internal virtual Bounds LocalBounds { get { return new Bounds(); } }
        internal static Bounds World(Bounds local, Matrix4x4 matrix)
        {
            Bounds box = new Bounds(matrix.MultiplyPoint3x4(local.center), Vector3.zero);
            for (int corner = 0; corner < 8; corner++)
                box.Encapsulate(matrix.MultiplyPoint3x4(local.center + Vector3.Scale(local.extents, new Vector3((corner & 1) * 2 - 1, (corner & 2) - 1, (corner & 4) / 2 - 1))));
            return box;
        }
    }

    public class MeshRenderer : Renderer
    {
        internal override Bounds LocalBounds { get { MeshFilter filter = GetComponent<MeshFilter>(); return filter == null || filter.sharedMesh == null ? new Bounds() : filter.sharedMesh.bounds; } }
    }

    public sealed class MeshFilter : Component
    {
        Mesh m_Mesh;
        public Mesh sharedMesh { get { Alive(); return m_Mesh; } set { Alive(); m_Mesh = value; } }
        public Mesh mesh
        {
            get { Debug.LogError("MeshFilter.mesh makes a copy that nobody destroys in edit mode: use sharedMesh"); return m_Mesh; }
            set { m_Mesh = value; }
        }
    }

    public enum SkinQuality { Auto = 0, Bone1 = 1, Bone2 = 2, Bone4 = 4 }

    public class SkinnedMeshRenderer : Renderer
    {
        Mesh m_Mesh;
        Transform[] m_Bones = new Transform[0];
        Transform m_RootBone;
        Bounds m_LocalBounds;
        float[] m_ShapeWeights = new float[0];
        SkinQuality m_Quality;
        bool m_UpdateOffscreen, m_MotionVectors = true;
        public Mesh sharedMesh { get { Alive(); return m_Mesh; } set { Alive(); m_Mesh = value; } }
        public Transform[] bones { get { Alive(); return (Transform[])m_Bones.Clone(); } set { Alive(); if (value == null || value.Length != m_Bones.Length) m_Bones = new Transform[value == null ? 0 : value.Length]; if (value != null) Array.Copy(value, m_Bones, value.Length); } }
        public Transform rootBone { get { Alive(); return m_RootBone; } set { Alive(); m_RootBone = value; } }
        public Bounds localBounds { get { Alive(); return m_LocalBounds; } set { Alive(); m_LocalBounds = value; } }
        public SkinQuality quality { get { return m_Quality; } set { m_Quality = value; } }
        public bool updateWhenOffscreen { get { return m_UpdateOffscreen; } set { m_UpdateOffscreen = value; } }
        public bool skinnedMotionVectors { get { return m_MotionVectors; } set { m_MotionVectors = value; } }
        internal override Bounds LocalBounds { get { return m_LocalBounds; } }
        public override Bounds bounds { get { return World(m_LocalBounds, (m_RootBone == null ? transform : m_RootBone).localToWorldMatrix); } }
        void Inside(int index)
        {
            Alive();
            int count = m_Mesh == null ? 0 : m_Mesh.blendShapeCount;
            if (index < 0 || index >= count) throw new IndexOutOfRangeException("Blend shape index " + index + " is out of range: the mesh has " + count);
        }
        public float GetBlendShapeWeight(int index) { Inside(index); return index < m_ShapeWeights.Length ? m_ShapeWeights[index] : 0f; }
        public void SetBlendShapeWeight(int index, float value)
        {
            Inside(index);
            if (index >= m_ShapeWeights.Length) Array.Resize(ref m_ShapeWeights, index + 1);
            m_ShapeWeights[index] = value;
        }
        public void BakeMesh(Mesh mesh) { BakeMesh(mesh, false); }
        // Vertices as drawn, in the renderer's own space; without useScale, in its position and rotation alone.
        public void BakeMesh(Mesh mesh, bool useScale)
        {
            Alive();
            if (mesh == null) throw new ArgumentNullException("mesh");
            if (m_Mesh == null) return;
            Matrix4x4 world = useScale ? transform.localToWorldMatrix : Matrix4x4.TRS(transform.position, transform.rotation, Vector3.one);
            Vector3[] positions, normals;
            UnityStubs.Skinning.Drawn(this, world.inverse, out positions, out normals);
            mesh.Clear();
            mesh.indexFormat = m_Mesh.indexFormat;
            mesh.vertices = positions;
            if (normals != null) mesh.normals = normals;
            mesh.subMeshCount = m_Mesh.subMeshCount;
            for (int part = 0; part < m_Mesh.subMeshCount; part++) mesh.SetIndices(m_Mesh.GetIndices(part), m_Mesh.GetTopology(part), part);
            mesh.bounds = m_LocalBounds;
        }
    }

    public enum LightType { Spot = 0, Directional = 1, Point = 2, Area = 3 }
    public sealed class Light : Behaviour // Serialized as Unity names it.
    {
        float m_Range = 10f, m_Intensity = 1f, m_CookieSize = 10f;
        // m_CookieSize until 6000.0, m_CookieSize2D from 6000.7 on; here both, to see both.
        Vector2 m_AreaSize = new Vector2(1, 2), m_CookieSize2D = new Vector2(10, 5);
        LightType m_Type = LightType.Point;
        Color m_Color = Color.white;
        public float range { get { return m_Range; } set { m_Range = value; } }
        public float intensity { get { return m_Intensity; } set { m_Intensity = value; } }
        public LightType type { get { return m_Type; } set { m_Type = value; } }
        public Color color { get { return m_Color; } set { m_Color = value; } }
    }
    public enum CameraClearFlags { Skybox = 1, SolidColor = 2, Depth = 3, Nothing = 4 }
    public sealed class Camera : Behaviour
    {
        public float fieldOfView { get; set; }
        public float nearClipPlane { get; set; }
        public float farClipPlane { get; set; }
        public bool orthographic { get; set; }
        public float orthographicSize { get; set; }
        public Color backgroundColor { get; set; }
        public CameraClearFlags clearFlags { get; set; }
        public int cullingMask { get; set; }
        public RenderTexture targetTexture { get; set; }
        public void Render() { }
    }
}

namespace UnityStubs
{
    /// Skinning by the definition: the sum of weight x bone's world matrix x bind pose x vertex, blend shapes first.
    public static class Skinning
    {
        public static void Drawn(UnityEngine.SkinnedMeshRenderer renderer, UnityEngine.Matrix4x4 space, out UnityEngine.Vector3[] positions, out UnityEngine.Vector3[] normals)
        {
            UnityEngine.Mesh mesh = renderer.sharedMesh;
            positions = mesh.vertices;
            normals = mesh.normals;
            if (normals.Length == 0) normals = null;
            UnityEngine.Vector3[] moved = new UnityEngine.Vector3[positions.Length], turned = new UnityEngine.Vector3[positions.Length];
            for (int shape = 0; shape < mesh.blendShapeCount; shape++)
            {
                float weight = renderer.GetBlendShapeWeight(shape);
                if (weight == 0f) continue;
                int last = mesh.GetBlendShapeFrameCount(shape) - 1;
                mesh.GetBlendShapeFrameVertices(shape, last, moved, turned, null);
                float part = weight / mesh.GetBlendShapeFrameWeight(shape, last);
                for (int vertex = 0; vertex < positions.Length; vertex++) { positions[vertex] += moved[vertex] * part; if (normals != null) normals[vertex] += turned[vertex] * part; }
            }
            UnityEngine.Transform[] bones = renderer.bones;
            UnityEngine.Matrix4x4[] binds = mesh.bindposes, skin = new UnityEngine.Matrix4x4[binds.Length];
            for (int bone = 0; bone < binds.Length; bone++)
                skin[bone] = bone < bones.Length && bones[bone] != null ? space * bones[bone].localToWorldMatrix * binds[bone] : new UnityEngine.Matrix4x4();
            UnityEngine.Matrix4x4 rigid = space * renderer.transform.localToWorldMatrix;
            byte[] counts = mesh.GetBonesPerVertex().ToArray();
            UnityEngine.BoneWeight1[] weights = mesh.GetAllBoneWeights().ToArray();
            int at = 0;
            for (int vertex = 0; vertex < positions.Length; vertex++)
            {
                UnityEngine.Matrix4x4 sum = rigid;
                if (counts.Length > 0)
                {
                    sum = new UnityEngine.Matrix4x4();
                    for (int end = at + counts[vertex]; at < end; at++)
                        for (int element = 0; element < 16; element++) sum[element] += skin[weights[at].boneIndex][element] * weights[at].weight;
                }
                positions[vertex] = sum.MultiplyPoint3x4(positions[vertex]);
                if (normals != null) normals[vertex] = sum.inverse.transpose.MultiplyVector(normals[vertex]).normalized;
            }
        }
    }
}
