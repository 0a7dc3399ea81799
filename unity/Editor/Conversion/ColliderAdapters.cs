using System;
using UnityEngine;

namespace SuperDeform.Editor
{
    internal sealed class SphereColliderAdapter : IComponentAdapter
    {
        public bool Handles(Component copy) => copy is SphereCollider;

        public void Adapt(Component copy, PointMap map)
        {
            SphereCollider sphere = (SphereCollider)copy;
            Vector3 center = sphere.center;
            sphere.radius *= map.Scale(sphere.transform, center);
            sphere.center = map.Point(sphere.transform, center);
        }
    }

    internal sealed class CapsuleColliderAdapter : IComponentAdapter
    {
        public bool Handles(Component copy) => copy is CapsuleCollider;

        public void Adapt(Component copy, PointMap map)
        {
            CapsuleCollider capsule = (CapsuleCollider)copy;
            Vector3 center = capsule.center;
            float scale = map.Scale(capsule.transform, center);
            // The centres of the two half spheres go their ways; the capsule's axis cannot turn.
            float half = Math.Max(0, capsule.height / 2 - capsule.radius);
            var axis = new Vector3(capsule.direction == 0 ? half : 0, capsule.direction == 1 ? half : 0, capsule.direction == 2 ? half : 0);
            Vector3 low = map.Point(capsule.transform, center - axis), high = map.Point(capsule.transform, center + axis);
            bool round = half == 0;
            var along = new Vector3(capsule.direction == 0 ? 1 : 0, capsule.direction == 1 ? 1 : 0, capsule.direction == 2 ? 1 : 0);
            float across = round ? scale : map.Across(capsule.transform, center, along);
            float height = round ? capsule.height * scale : Vector3.Distance(low, high) + 2 * capsule.radius * across;
            capsule.center = round ? map.Point(capsule.transform, center) : (low + high) * 0.5f;
            capsule.radius *= across;
            capsule.height = height;
        }
    }

    internal sealed class BoxColliderAdapter : IComponentAdapter
    {
        public bool Handles(Component copy) => copy is BoxCollider;

        public void Adapt(Component copy, PointMap map)
        {
            BoxCollider box = (BoxCollider)copy;
            Vector3 center = box.center, size = box.size;
            box.size = new Vector3(
                Length(map, box, center, new Vector3(size.x / 2, 0, 0)),
                Length(map, box, center, new Vector3(0, size.y / 2, 0)),
                Length(map, box, center, new Vector3(0, 0, size.z / 2)));
            box.center = map.Point(box.transform, center);
        }

        static float Length(PointMap map, BoxCollider box, Vector3 center, Vector3 half) =>
            Vector3.Distance(map.Point(box.transform, center - half), map.Point(box.transform, center + half));
    }

    /// <summary>A collider in the shape of a renderer's mesh gets the new mesh.</summary>
    internal sealed class MeshColliderAdapter : IComponentAdapter
    {
        public bool Handles(Component copy) => copy is MeshCollider;

        public void Adapt(Component copy, PointMap map)
        {
            MeshCollider collider = (MeshCollider)copy;
            Mesh mesh = collider.sharedMesh == null ? null : map.MeshOf(collider.sharedMesh);
            if (mesh != null) collider.sharedMesh = mesh;
        }
    }

    internal sealed class CharacterControllerAdapter : IComponentAdapter
    {
        public bool Handles(Component copy) => copy is CharacterController;

        public void Adapt(Component copy, PointMap map)
        {
            CharacterController controller = (CharacterController)copy;
            Vector3 center = controller.center;
            float scale = map.Scale(controller.transform, center);
            controller.center = map.Point(controller.transform, center);
            controller.radius *= scale;
            // Unity refuses a step that is higher than the body, so the lower one comes first.
            controller.stepOffset *= scale;
            controller.height *= scale;
            controller.skinWidth *= scale;
        }
    }

    /// <summary>Cloth may go as far as before, in the new avatar's measure.</summary>
    internal sealed class ClothAdapter : IComponentAdapter
    {
        public bool Handles(Component copy) => copy is Cloth;

        public void Adapt(Component copy, PointMap map)
        {
            Cloth cloth = (Cloth)copy;
            SkinnedMeshRenderer renderer = cloth.GetComponent<SkinnedMeshRenderer>();
            Transform carrier = renderer != null && renderer.rootBone != null ? renderer.rootBone : cloth.transform;
            float scale = map.Scale(carrier, new Vector3(0, 0, 0));
            ClothSkinningCoefficient[] coefficients = cloth.coefficients;
            for (int vertex = 0; vertex < coefficients.Length; vertex++)
            {
                // The largest number stands for "as far as it likes".
                if (coefficients[vertex].maxDistance < float.MaxValue) coefficients[vertex].maxDistance *= scale;
                if (coefficients[vertex].collisionSphereDistance < float.MaxValue) coefficients[vertex].collisionSphereDistance *= scale;
            }
            cloth.coefficients = coefficients;
        }
    }
}
