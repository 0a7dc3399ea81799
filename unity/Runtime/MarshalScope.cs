using System;
using System.Collections.Generic;
using System.Runtime.InteropServices;
using System.Text;

namespace SuperDeform
{
/// <summary>
/// What the library gets for one call: pinned arrays, and texts and structs in unmanaged memory. <see cref="Dispose"/>
/// unpins and frees all of it, after which the scope may be used again.
/// </summary>
internal sealed unsafe class MarshalScope : IDisposable
{
    readonly List<GCHandle> pins = new List<GCHandle>();
    readonly List<IntPtr> blocks = new List<IntPtr>();

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
    internal void* Alloc(int bytes)
    {
        IntPtr block = Marshal.AllocHGlobal(Math.Max(bytes, 1));
        blocks.Add(block);
        byte* start = (byte*)block;
        for (int i = 0; i < bytes; i++) start[i] = 0;
        return start;
    }

    /// <summary>A terminated text in UTF-8; null for null.</summary>
    internal sbyte* Text(string text)
    {
        if (text == null) return null;
        byte[] bytes = Encoding.UTF8.GetBytes(text);
        sbyte* copy = (sbyte*)Alloc(bytes.Length + 1);
        Marshal.Copy(bytes, 0, (IntPtr)copy, bytes.Length);
        return copy;
    }

    public void Dispose()
    {
        foreach (GCHandle pin in pins) pin.Free();
        foreach (IntPtr block in blocks) Marshal.FreeHGlobal(block);
        pins.Clear();
        blocks.Clear();
    }
}
}
