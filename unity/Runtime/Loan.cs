using System;
using System.Collections.Generic;
using System.Runtime.InteropServices;
using System.Text;

namespace SuperDeform
{
/// <summary>
/// What the library gets for one call: arrays that stay where they are, and texts and structs in memory of our own. All
/// of it goes back with <see cref="Dispose"/>, after which the loan may be used again.
/// </summary>
internal sealed unsafe class Loan : IDisposable
{
    private readonly List<GCHandle> pins = new List<GCHandle>();
    private readonly List<IntPtr> rooms = new List<IntPtr>();

    /// <summary>The address of an array's first element; null for null and for an empty array.</summary>
    internal byte* Pin(Array array, string name)
    {
        if (array == null || array.Length == 0) return null;
        GCHandle pin;
        try
        {
            pin = GCHandle.Alloc(array, GCHandleType.Pinned);
        }
        catch (ArgumentException)
        {
            throw Failure.Argument(name + " is an array of " + array.GetType().GetElementType().Name
                + ", which holds more than plain numbers: give numbers or structs of numbers");
        }
        pins.Add(pin);
        return (byte*)pin.AddrOfPinnedObject();
    }

    /// <summary>Zeroed memory.</summary>
    internal void* Room(int bytes)
    {
        IntPtr room = Marshal.AllocHGlobal(Math.Max(bytes, 1));
        rooms.Add(room);
        byte* start = (byte*)room;
        for (int i = 0; i < bytes; i++) start[i] = 0;
        return start;
    }

    /// <summary>A terminated text in UTF-8; null for null.</summary>
    internal sbyte* Text(string text)
    {
        if (text == null) return null;
        byte[] bytes = Encoding.UTF8.GetBytes(text);
        sbyte* room = (sbyte*)Room(bytes.Length + 1);
        Marshal.Copy(bytes, 0, (IntPtr)room, bytes.Length);
        return room;
    }

    public void Dispose()
    {
        foreach (GCHandle pin in pins) pin.Free();
        foreach (IntPtr room in rooms) Marshal.FreeHGlobal(room);
        pins.Clear();
        rooms.Clear();
    }
}
}
