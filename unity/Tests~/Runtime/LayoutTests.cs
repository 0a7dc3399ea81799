using System;
using System.Collections.Generic;
using System.IO;
using System.Reflection;
using System.Runtime.InteropServices;
using NUnit.Framework;

namespace SuperDeform.Tests
{
/// <summary>
/// The structs of the generated imports against what a C compiler makes of superdeform.h: a file of lines such as
/// "SdefError 528" and "SdefError.status 4", named by SUPERDEFORM_LAYOUT.
/// </summary>
[TestFixture]
public sealed class LayoutTests
{
    const BindingFlags Fields = BindingFlags.Instance | BindingFlags.Public | BindingFlags.NonPublic;

    [Test]
    public void Every_struct_has_the_size_that_C_gives_it()
    {
        int structs = 0;
        foreach (KeyValuePair<string, int> line in InC())
        {
            if (line.Key.Contains(".")) continue;
            Type type = Struct(line.Key);
            Assert.AreEqual(line.Value, Marshal.SizeOf(type), line.Key);
            // What pinning hands over is the managed form: the way from one element of an array to the next.
            Array two = Array.CreateInstance(type, 2);
            GCHandle pin = GCHandle.Alloc(two, GCHandleType.Pinned);
            long stride = (long)Marshal.UnsafeAddrOfPinnedArrayElement(two, 1) - (long)pin.AddrOfPinnedObject();
            pin.Free();
            Assert.AreEqual(line.Value, stride, line.Key);
            structs++;
        }
        Assert.IsTrue(structs >= 17, "only " + structs + " structs");
    }

    [Test]
    public void Every_field_is_where_C_has_it()
    {
        Dictionary<string, int> inC = InC();
        int fields = 0;
        foreach (KeyValuePair<string, int> line in inC)
        {
            string[] name = line.Key.Split('.');
            if (name.Length < 2) continue;
            Assert.AreEqual(line.Value, (int)Marshal.OffsetOf(Struct(name[0]), name[1]), line.Key);
            fields++;
        }
        Assert.IsTrue(fields >= 100, "only " + fields + " fields");
    }

    [Test]
    public void There_is_no_struct_or_field_that_C_has_not()
    {
        Dictionary<string, int> inC = InC();
        foreach (Type type in typeof(Native).Assembly.GetTypes())
        {
            if (!type.IsValueType || !type.Name.StartsWith("Sdef", StringComparison.Ordinal)) continue;
            Assert.IsTrue(inC.ContainsKey(type.Name), type.Name);
            foreach (FieldInfo field in type.GetFields(Fields))
            {
                Assert.IsTrue(inC.ContainsKey(type.Name + "." + field.Name), type.Name + "." + field.Name);
            }
        }
    }

    static Type Struct(string name)
    {
        Type type = typeof(Native).Assembly.GetType("SuperDeform." + name);
        Assert.IsNotNull(type, name + " is not in Native.g.cs");
        return type;
    }

    static Dictionary<string, int> InC()
    {
        Dictionary<string, int> lines = new Dictionary<string, int>();
        foreach (string line in File.ReadAllLines(Environment.GetEnvironmentVariable("SUPERDEFORM_LAYOUT")))
        {
            lines.Add(line.Split(' ')[0], int.Parse(line.Split(' ')[1]));
        }
        return lines;
    }
}
}
