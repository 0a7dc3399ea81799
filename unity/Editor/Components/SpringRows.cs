using System.Collections.Generic;
using UnityEditor;
using UnityEngine;

namespace SuperDeform.Editor
{
    /// <summary>Where components that are springs hold their chains, their radius and the colliders that they keep out of.</summary>
    internal sealed class SpringRow
    {
        /// <summary>The joints at the beginning of chains.</summary>
        internal string[] Roots = new string[0];

        /// <summary>Joints that are left out with all below them; null: none.</summary>
        internal string Left;

        /// <summary>The radius; curves along the chain, 1 at most, are left out.</summary>
        internal string Radius;

        /// <summary>
        /// Whether the scale of the root multiplies the radius, and the component's own object is the root where none is set; else
        /// the scale is the object's, and there is no chain without a root.
        /// </summary>
        internal bool ByRoot;

        internal string Colliders;

        /// <summary>The point, in the space of the last joint, where the last bone ends; null: springs end at the last joint.</summary>
        internal string End;

        internal static readonly Dictionary<string, SpringRow> All = new Dictionary<string, SpringRow>
        {
            {
                "VRC.SDK3.Dynamics.PhysBone.Components.VRCPhysBone", new SpringRow
                {
                    Roots = new[] { "rootTransform" }, Left = "ignoreTransforms[*]", Radius = "radius", ByRoot = true, Colliders = "colliders[*]",
                    End = "endpointPosition"
                }
            },
            {
                "DynamicBone", new SpringRow
                {
                    Roots = new[] { "m_Root", "m_Roots[*]" }, Left = "m_Exclusions[*]", Radius = "m_Radius", Colliders = "m_Colliders[*]"
                }
            },
            { "MagicaCloth.MagicaBoneCloth", Magica("clothTarget.rootList[*]", "clothParams.radius.startValue", "teamData.colliderList[*]") },
            { "MagicaCloth.MagicaBoneSpring", Magica("clothTarget.rootList[*]", "clothParams.radius.startValue", "teamData.colliderList[*]") },
            {
                "MagicaCloth2.MagicaCloth",
                Magica("serializeData.rootBones[*]", "serializeData.radius.value", "serializeData.colliderCollisionConstraint.colliderList[*]")
            }
        };

        static SpringRow Magica(string roots, string radius, string colliders) =>
            new SpringRow { Roots = new[] { roots }, Radius = radius, Colliders = colliders };

        /// <summary>Adds the balls of a component.</summary>
        internal void Add(Component component, Springs springs)
        {
            using (var properties = new SerializedObject(component))
            {
                List<Component> colliders = Serialized.ComponentsAt(properties, Colliders);
                if (colliders.Count == 0) return;
                HashSet<Transform> left = Left == null ? new HashSet<Transform>() : new HashSet<Transform>(Serialized.TransformsAt(properties, Left));
                SerializedProperty radius = properties.FindProperty(Radius), end = End == null ? null : properties.FindProperty(End);
                Vector3 endAt = end == null ? Vector3.zero : end.vector3Value;
                foreach (Transform root in RootsOf(component, properties))
                {
                    var balls = new Balls
                    {
                        Springs = springs, Colliders = colliders, Left = left, End = endAt, Radius = radius == null ? 0 : radius.floatValue,
                        MeasuredIn = ByRoot ? root : component.transform
                    };
                    balls.AddBelow(root);
                }
            }
        }

        List<Transform> RootsOf(Component component, SerializedObject properties)
        {
            var roots = new List<Transform>();
            foreach (string path in Roots)
            {
                foreach (Transform root in Serialized.TransformsAt(properties, path))
                {
                    if (!roots.Contains(root)) roots.Add(root);
                }
            }
            if (roots.Count == 0 && ByRoot) roots.Add(component.transform);
            return roots;
        }

        sealed class Balls
        {
            internal Springs Springs;
            internal List<Component> Colliders;
            internal HashSet<Transform> Left;
            internal Vector3 End;
            internal float Radius;
            internal Transform MeasuredIn;

            /// <summary>One at each joint below a joint, where the bone before it ends, and one at the end of the last.</summary>
            internal void AddBelow(Transform joint)
            {
                bool last = true;
                for (int child = 0; child < joint.childCount; child++)
                {
                    Transform next = joint.GetChild(child);
                    if (Left.Contains(next)) continue;
                    last = false;
                    Add(next, Vector3.zero);
                    AddBelow(next);
                }
                if (last && End.sqrMagnitude > 0) Add(joint, End);
            }

            void Add(Transform joint, Vector3 offset)
            {
                foreach (Component collider in Colliders)
                {
                    Springs.Add(collider, joint, offset, Radius, MeasuredIn);
                }
            }
        }
    }
}
