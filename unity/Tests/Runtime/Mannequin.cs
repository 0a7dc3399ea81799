using System;
using System.Collections.Generic;

namespace SuperDeform.Tests
{
/// <summary>
/// A figure of tubes with joints, arms out, about 1.75 high, that looks along +Z with its left at +X: what tests
/// deform. Each part is a tube with caps that hangs from one joint.
/// </summary>
public sealed class Mannequin
{
    public const int Rings = 7, Sides = 12, PartVertices = Rings * Sides + 2, PartIndices = 6 * Sides * Rings;

    static readonly Part[] parts =
    {
        new Part(HumanoidRole.Hips, -1, 0, 0.85, 0, 0, 1.1, 0, 0.15),
        new Part(HumanoidRole.Spine, 0, 0, 1.1, 0, 0, 1.42, 0, 0.16),
        new Part(HumanoidRole.Neck, 1, 0, 1.42, 0, 0, 1.5, 0, 0.05),
        new Part(HumanoidRole.Head, 2, 0, 1.5, 0, 0, 1.75, 0, 0.11),
        new Part(HumanoidRole.LeftUpperArm, 1, 0.18, 1.38, 0, 0.45, 1.38, 0, 0.05),
        new Part(HumanoidRole.LeftLowerArm, 4, 0.45, 1.38, 0, 0.7, 1.38, 0, 0.04),
        new Part(HumanoidRole.LeftHand, 5, 0.7, 1.38, 0, 0.86, 1.38, 0, 0.04),
        new Part(HumanoidRole.RightUpperArm, 1, -0.18, 1.38, 0, -0.45, 1.38, 0, 0.05),
        new Part(HumanoidRole.RightLowerArm, 7, -0.45, 1.38, 0, -0.7, 1.38, 0, 0.04),
        new Part(HumanoidRole.RightHand, 8, -0.7, 1.38, 0, -0.86, 1.38, 0, 0.04),
        new Part(HumanoidRole.LeftUpperLeg, 0, 0.1, 0.85, 0, 0.1, 0.46, 0, 0.08),
        new Part(HumanoidRole.LeftLowerLeg, 10, 0.1, 0.46, 0, 0.1, 0.08, 0, 0.06),
        new Part(HumanoidRole.LeftFoot, 11, 0.1, 0.06, -0.04, 0.1, 0.04, 0.18, 0.04),
        new Part(HumanoidRole.RightUpperLeg, 0, -0.1, 0.85, 0, -0.1, 0.46, 0, 0.08),
        new Part(HumanoidRole.RightLowerLeg, 13, -0.1, 0.46, 0, -0.1, 0.08, 0, 0.06),
        new Part(HumanoidRole.RightFoot, 14, -0.1, 0.06, -0.04, -0.1, 0.04, 0.18, 0.04),
    };

    public readonly SkeletonArrays Skeleton = new SkeletonArrays();
    public readonly Triple[] Positions = new Triple[parts.Length * PartVertices];
    public readonly Triple[] Normals = new Triple[parts.Length * PartVertices];
    public readonly Quadruple[] Tangents = new Quadruple[parts.Length * PartVertices];
    public readonly ushort[] Indices = new ushort[parts.Length * PartIndices];
    public readonly uint[] Joints = new uint[parts.Length * PartVertices];
    public readonly float[] Weights = new float[parts.Length * PartVertices];

    /// <summary>A morph target that moves the head alone.</summary>
    public readonly Triple[] Smile = new Triple[parts.Length * PartVertices];

    public Mannequin()
    {
        Skeleton.Names = new string[parts.Length];
        Skeleton.Parents = new int[parts.Length];
        Skeleton.RestMatrices = new double[16 * parts.Length];
        Skeleton.RoleJoints = new int[55];
        for (int role = 0; role < 55; role++) Skeleton.RoleJoints[role] = -1;
        for (int part = 0; part < parts.Length; part++) Make(part);
    }

    public int VertexCount => Positions.Length;

    public int JointCount => parts.Length;

    /// <summary>The whole figure as one mesh.</summary>
    public MeshArrays Mesh(string name = "figure")
    {
        var mesh = new MeshArrays();
        mesh.Name = name;
        mesh.Kind = MeshKind.Body;
        mesh.Positions = Positions;
        mesh.Normals = Normals;
        mesh.Tangents = Tangents;
        mesh.Indices = Indices;
        mesh.Joints = Joints;
        mesh.Weights = Weights;
        mesh.InfluenceCount = 1;
        return mesh;
    }

    public Character Character()
    {
        var character = new Character();
        character.SetSkeleton(Skeleton);
        character.AddMesh(Mesh());
        return character;
    }

    public MorphArrays SmileTarget() => new MorphArrays { Name = "smile", Positions = Smile };

    /// <summary>Room for what comes out of one mesh.</summary>
    public static MeshOutput Output(int vertices, int targets = 0)
    {
        var output = new MeshOutput();
        output.VertexCount = vertices;
        output.MorphTargetCount = targets;
        output.Positions = new Triple[vertices];
        output.Normals = new Triple[vertices];
        output.Tangents = new Quadruple[vertices];
        if (targets > 0) output.MorphPositions = new float[3 * vertices * targets];
        return output;
    }

    void Make(int part)
    {
        Part from = parts[part];
        Skeleton.Names[part] = from.Role.ToString();
        Skeleton.Parents[part] = from.Parent;
        Skeleton.RoleJoints[(int)from.Role] = part;
        for (int i = 0; i < 4; i++) Skeleton.RestMatrices[16 * part + 5 * i] = 1;
        for (int i = 0; i < 3; i++) Skeleton.RestMatrices[16 * part + 12 + i] = from.Start[i];
        // The tube runs along the axis on which it is longest.
        int axis = 0;
        for (int i = 1; i < 3; i++)
        {
            if (Math.Abs(from.End[i] - from.Start[i]) > Math.Abs(from.End[axis] - from.Start[axis])) axis = i;
        }
        bool rises = from.End[axis] > from.Start[axis];
        for (int vertex = 0; vertex < PartVertices; vertex++) MakeVertex(part, vertex, axis, rises ? 1 : -1);
        MakeTriangles(part, rises);
    }

    void MakeVertex(int part, int vertex, int axis, float sign)
    {
        Part from = parts[part];
        int at = part * PartVertices + vertex, across = (axis + 1) % 3, along = (axis + 2) % 3;
        bool cap = vertex >= Rings * Sides;
        int ring = cap ? (vertex == PartVertices - 1 ? Rings - 1 : 0) : vertex / Sides;
        double share = ring / (double)(Rings - 1), angle = 2 * Math.PI * (vertex % Sides) / Sides;
        float[] position = new float[3], normal = new float[3], tangent = new float[3];
        for (int i = 0; i < 3; i++) position[i] = (float)(from.Start[i] + share * (from.End[i] - from.Start[i]));
        if (cap)
        {
            normal[axis] = ring == 0 ? -sign : sign;
            tangent[across] = 1;
        }
        else
        {
            normal[across] = (float)Math.Cos(angle);
            normal[along] = (float)Math.Sin(angle);
            position[across] += (float)from.Radius * normal[across];
            position[along] += (float)from.Radius * normal[along];
            tangent[axis] = 1;
        }
        Positions[at] = new Triple(position[0], position[1], position[2]);
        Normals[at] = new Triple(normal[0], normal[1], normal[2]);
        Tangents[at] = new Quadruple { X = tangent[0], Y = tangent[1], Z = tangent[2], W = 1 };
        Joints[at] = (uint)part;
        Weights[at] = 1;
        if (from.Role == HumanoidRole.Head) Smile[at] = new Triple(0, 0, (float)(0.01 * share));
    }

    void MakeTriangles(int part, bool rises)
    {
        int first = part * PartVertices, bottom = first + Rings * Sides, top = bottom + 1;
        var corners = new List<int>();
        for (int side = 0; side < Sides; side++)
        {
            int next = (side + 1) % Sides, last = first + (Rings - 1) * Sides;
            corners.AddRange(new[] { bottom, first + next, first + side, top, last + side, last + next });
            for (int ring = 0; ring + 1 < Rings; ring++)
            {
                int low = first + ring * Sides, high = low + Sides;
                corners.AddRange(new[] { low + side, low + next, high + next, low + side, high + next, high + side });
            }
        }
        for (int i = 0; i < corners.Count; i += 3)
        {
            // Outward whichever way the tube runs.
            int at = part * PartIndices + i;
            Indices[at] = (ushort)corners[i];
            Indices[at + 1] = (ushort)corners[rises ? i + 1 : i + 2];
            Indices[at + 2] = (ushort)corners[rises ? i + 2 : i + 1];
        }
    }

    sealed class Part
    {
        public readonly HumanoidRole Role;
        public readonly int Parent;
        public readonly double[] Start, End;
        public readonly double Radius;

        public Part(HumanoidRole role, int parent, double x, double y, double z, double endX, double endY, double endZ,
            double radius)
        {
            Role = role;
            Parent = parent;
            Start = new[] { x, y, z };
            End = new[] { endX, endY, endZ };
            Radius = radius;
        }
    }
}
}
