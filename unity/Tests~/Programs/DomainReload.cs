using System;
using System.Collections.Generic;

namespace SuperDeform.Tests
{
/// <summary>
/// An editor's reload of scripts: a domain that keeps objects until its end is unloaded, and the native library stays.
/// Says how many native objects there are before, meanwhile and after.
/// </summary>
public sealed class DomainReload : MarshalByRefObject
{
    static readonly List<NativeObject> kept = new List<NativeObject>();

    public static void Main()
    {
        SuperDeformLibrary.Check();
        ulong before = SuperDeformLibrary.LiveHandles;
        AppDomain domain = AppDomain.CreateDomain("scripts");
        DomainReload other = (DomainReload)domain.CreateInstanceAndUnwrap(typeof(DomainReload).Assembly.FullName,
            typeof(DomainReload).FullName);
        other.Keep();
        ulong meanwhile = SuperDeformLibrary.LiveHandles;
        AppDomain.Unload(domain);
        Console.WriteLine(before + " " + meanwhile + " " + SuperDeformLibrary.LiveHandles);
    }

    public void Keep()
    {
        for (int i = 0; i < 10; i++)
        {
            kept.Add(new Character());
            kept.Add(Style.FromHeads(2.5));
        }
    }
}
}
