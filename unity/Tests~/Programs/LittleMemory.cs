using System;

namespace SuperDeform.Tests
{
/// <summary>
/// A mesh that fits into memory once but not twice: run with limited memory. Says which exception comes and that the
/// library goes on.
/// </summary>
public static class LittleMemory
{
    public static void Main()
    {
        using (Character character = new Character())
        {
            try
            {
                // Zeros that the system has promised and not yet given.
                character.AddMesh(new MeshArrays { Positions = new float[3 * 60000000] });
            }
            catch (SuperDeformException exception)
            {
                Console.WriteLine(exception.GetType().Name + " " + exception.Status + ": " + exception.Message);
            }
            character.AddMesh(new MeshArrays { Positions = new float[3] });
            Console.WriteLine(character.Info.VertexCount);
        }
    }
}
}
