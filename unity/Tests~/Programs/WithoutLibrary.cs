using System;

namespace SuperDeform.Tests
{
/// <summary>
/// What is said where the library is missing or another one: run without it, and with others of its name.
/// </summary>
public static class WithoutLibrary
{
    public static void Main()
    {
        Say(SuperDeformLibrary.Check);
        // A second time, in a constructor: nothing is taken for checked.
        Say(() => new Character());
        Say(() => Style.FromHeads(2.5));
        GC.Collect();
        GC.WaitForPendingFinalizers();
        Console.WriteLine("and goes on");
    }

    static void Say(Action call)
    {
        try
        {
            call();
            Console.WriteLine("nothing");
        }
        catch (SuperDeformException exception)
        {
            Console.WriteLine(exception.GetType().Name + ": " + exception.Message);
        }
    }
}
}
