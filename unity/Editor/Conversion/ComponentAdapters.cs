using System;
using System.Collections.Generic;
using UnityEngine;

namespace SuperDeform.Editor
{
    /// <summary>Brings what a component says in lengths and points to the new proportions.</summary>
    public interface IComponentAdapter
    {
        /// <summary>True for components that Adapt is for.</summary>
        bool Handles(Component copy);

        /// <summary>Brings one component from the old lengths to the new ones.</summary>
        /// <param name="copy">Of the new avatar; it still holds what the source's holds.</param>
        /// <param name="map">Where points go, and by how much lengths grow.</param>
        void Adapt(Component copy, PointMap map);
    }

    /// <summary>Who adapts which components. All others are copied as they are.</summary>
    public static class ComponentAdapters
    {
        static readonly List<IComponentAdapter> Adapters = new List<IComponentAdapter>
        {
            new SphereColliderAdapter(),
            new CapsuleColliderAdapter(),
            new BoxColliderAdapter(),
            new MeshColliderAdapter(),
            new CharacterControllerAdapter(),
            new ClothAdapter(),
            new ComponentTable()
        };

        /// <summary>
        /// Adds an adapter; it comes before those that are there. One of a type that is there takes that one's place.
        /// </summary>
        public static void Register(IComponentAdapter adapter)
        {
            if (adapter == null) throw new ArgumentNullException("adapter");
            Adapters.RemoveAll(other => other.GetType() == adapter.GetType());
            Adapters.Insert(0, adapter);
        }

        /// <summary>The adapter for a component; null where there is none.</summary>
        public static IComponentAdapter For(Component copy)
        {
            foreach (IComponentAdapter adapter in Adapters)
            {
                if (adapter.Handles(copy)) return adapter;
            }
            return null;
        }
    }
}
