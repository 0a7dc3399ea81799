// Colliders and joints: plain data here.
using System;

namespace UnityEngine
{
    public class PhysicMaterial : Object { }
    public class Collider : Component
    {
        bool m_Enabled = true, m_Trigger;
        PhysicMaterial m_Material;
        public bool enabled { get { return m_Enabled; } set { m_Enabled = value; } }
        public bool isTrigger { get { return m_Trigger; } set { m_Trigger = value; } }
        public PhysicMaterial sharedMaterial { get { return m_Material; } set { m_Material = value; } }
    }
    public class SphereCollider : Collider
    {
        Vector3 m_Center;
        float m_Radius = 0.5f;
        public Vector3 center { get { Alive(); return m_Center; } set { m_Center = value; } }
        public float radius { get { Alive(); return m_Radius; } set { m_Radius = value; } }
    }
    public class CapsuleCollider : Collider
    {
        Vector3 m_Center;
        float m_Radius = 0.5f, m_Height = 2f;
        int m_Direction = 1;
        public Vector3 center { get { Alive(); return m_Center; } set { m_Center = value; } }
        public float radius { get { return m_Radius; } set { m_Radius = value; } }
        public float height { get { return m_Height; } set { m_Height = value; } }
        public int direction { get { return m_Direction; } set { m_Direction = value; } }
    }
    public class BoxCollider : Collider
    {
        Vector3 m_Center, m_Size = Vector3.one;
        public Vector3 center { get { Alive(); return m_Center; } set { m_Center = value; } }
        public Vector3 size { get { return m_Size; } set { m_Size = value; } }
    }
    public class MeshCollider : Collider
    {
        Mesh m_Mesh;
        bool m_Convex;
        public Mesh sharedMesh { get { return m_Mesh; } set { m_Mesh = value; } }
        public bool convex { get { return m_Convex; } set { m_Convex = value; } }
    }
    public class CharacterController : Collider
    {
        Vector3 m_Center;
        float m_Radius = 0.5f, m_Height = 2f, m_Step = 0.3f, m_Skin = 0.08f;
        public Vector3 center { get { return m_Center; } set { m_Center = value; } }
        public float radius { get { return m_Radius; } set { m_Radius = value; } }
        public float height { get { return m_Height; } set { m_Height = value; } }
        public float stepOffset { get { return m_Step; } set { m_Step = value; } }
        public float skinWidth { get { return m_Skin; } set { m_Skin = value; } }
    }
    public sealed class Rigidbody : Component
    {
        float m_Mass = 1f;
        bool m_Kinematic;
        public float mass { get { return m_Mass; } set { m_Mass = value; } }
        public bool isKinematic { get { return m_Kinematic; } set { m_Kinematic = value; } }
    }
    [Serializable]
    public struct ClothSphereColliderPair
    {
        public SphereCollider first { get; set; }
        public SphereCollider second { get; set; }
        public ClothSphereColliderPair(SphereCollider a, SphereCollider b) : this() { first = a; second = b; }
    }
    [Serializable]
    public struct ClothSkinningCoefficient { public float maxDistance, collisionSphereDistance; }
    public sealed class Cloth : Component
    {
        ClothSkinningCoefficient[] m_Coefficients = new ClothSkinningCoefficient[0];
        CapsuleCollider[] m_Capsules = new CapsuleCollider[0];
        ClothSphereColliderPair[] m_Spheres = new ClothSphereColliderPair[0];
        public bool enabled { get; set; }
        public ClothSkinningCoefficient[] coefficients { get { return (ClothSkinningCoefficient[])m_Coefficients.Clone(); } set { m_Coefficients = value; } }
        public CapsuleCollider[] capsuleColliders { get { return (CapsuleCollider[])m_Capsules.Clone(); } set { m_Capsules = value; } }
        public ClothSphereColliderPair[] sphereColliders { get { return (ClothSphereColliderPair[])m_Spheres.Clone(); } set { m_Spheres = value; } }
    }
}
