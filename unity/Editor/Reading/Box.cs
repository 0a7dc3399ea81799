using System;
using UnityEngine;

namespace SuperDeform.Editor
{
    /// <summary>An axis-aligned box around points; empty until one is added.</summary>
    public struct Box
    {
        public Double3 Low, High;
        bool filled;

        public bool IsEmpty => !filled;

        public Double3 Size => High - Low;

        /// <summary>Points that are not finite are left out.</summary>
        public void Add(Double3 point)
        {
            if (!point.IsFinite) return;
            if (!filled)
            {
                Low = High = point;
                filled = true;
                return;
            }
            Low = new Double3(Math.Min(Low.X, point.X), Math.Min(Low.Y, point.Y), Math.Min(Low.Z, point.Z));
            High = new Double3(Math.Max(High.X, point.X), Math.Max(High.Y, point.Y), Math.Max(High.Z, point.Z));
        }

        public static Box Around(Vector3[] points) => Around(points, Affine.Identity);

        /// <summary>The box of points that a matrix has mapped.</summary>
        public static Box Around(Vector3[] points, Affine matrix)
        {
            var box = new Box();
            foreach (Vector3 point in points)
            {
                box.Add(matrix.Point(Double3.Of(point)));
            }
            return box;
        }
    }
}
