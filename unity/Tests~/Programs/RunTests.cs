using System;
using System.Reflection;
using NUnit.Framework;

namespace SuperDeform.Tests
{
/// <summary>
/// Runs every test of this assembly where NUnit's own runner does not start, as on CoreCLR. Ends with how many passed
/// and failed.
/// </summary>
public static class RunTests
{
    static int passed, failed;

    public static int Main()
    {
        Console.WriteLine(Environment.Version + " " + typeof(object).Assembly.GetName().Name);
        foreach (Type type in typeof(RunTests).Assembly.GetTypes())
        {
            if (type.IsDefined(typeof(TestFixtureAttribute), false)) Run(type);
        }
        Console.WriteLine(passed + " passed, " + failed + " failed");
        return failed == 0 ? 0 : 1;
    }

    static void Run(Type type)
    {
        object fixture = Activator.CreateInstance(type);
        foreach (MethodInfo method in type.GetMethods())
        {
            if (!method.IsDefined(typeof(TestAttribute), false)) continue;
            string name = type.Name + "." + method.Name;
            try
            {
                try
                {
                    Each(fixture, typeof(SetUpAttribute));
                    method.Invoke(fixture, null);
                }
                finally
                {
                    Each(fixture, typeof(TearDownAttribute));
                }
                passed++;
            }
            catch (TargetInvocationException exception)
            {
                if (exception.InnerException is IgnoreException)
                {
                    Console.WriteLine("skipped: " + name + ": " + exception.InnerException.Message);
                    continue;
                }
                Console.WriteLine("FAILED: " + name + "\n" + exception.InnerException);
                failed++;
            }
        }
    }

    static void Each(object fixture, Type attribute)
    {
        foreach (MethodInfo method in fixture.GetType().GetMethods())
        {
            if (method.IsDefined(attribute, false)) method.Invoke(fixture, null);
        }
    }
}
}
