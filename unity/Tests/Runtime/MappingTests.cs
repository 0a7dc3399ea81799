using System;
using System.Reflection;
using NUnit.Framework;

namespace SuperDeform.Tests
{
/// <summary>Every number of the library's structs arrives under its own name.</summary>
[TestFixture]
public sealed class MappingTests
{
    [Test]
    public void Style_numbers_there_and_back()
    {
        object native = Filled(typeof(SdefStyleNumbers));
        var numbers = new StyleNumbers((SdefStyleNumbers)native);
        Assert.AreEqual(24, AssertNames(native, numbers));
        Assert.AreEqual(24, AssertNames(numbers.ToNative(), numbers));
    }

    [Test]
    public void Figures()
    {
        object native = Filled(typeof(SdefFigure));
        Assert.AreEqual(8, AssertNames(native, new Figure((SdefFigure)native)));
    }

    [Test]
    public void Reports()
    {
        SdefReport native = (SdefReport)Filled(typeof(SdefReport));
        Figure[] figures = { new Figure(), new Figure(), new Figure() };
        for (int i = 0; i < 3; i++) figures[i].Height = 101 + i;
        var report = new Report(native, figures[0], figures[1], figures[2]);
        Assert.AreEqual(4, AssertNames(native, report));
        Assert.AreEqual(101.0, report.Target.Height);
        Assert.AreEqual(102.0, report.Reference.Height);
        Assert.AreEqual(103.0, report.Result.Height);
    }

    [Test]
    public void Character_infos()
    {
        object native = Filled(typeof(SdefCharacterInfo));
        Assert.AreEqual(7, AssertNames(native, new CharacterInfo((SdefCharacterInfo)native)));
    }

    [Test]
    public unsafe void Groups()
    {
        SdefGroup native = (SdefGroup)Filled(typeof(SdefGroup));
        native.name[0] = (sbyte)'a';
        var group = new Group(&native);
        Assert.AreEqual("a", group.Name);
        Assert.AreEqual(6, AssertNames(native, group));
    }

    // A struct whose plain numbers are 1, 2, 3 and so on.
    static object Filled(Type type)
    {
        object native = Activator.CreateInstance(type);
        int next = 1;
        foreach (FieldInfo field in type.GetFields())
        {
            if (field.FieldType.IsPrimitive) field.SetValue(native, Convert.ChangeType(next++, field.FieldType));
        }
        return native;
    }

    // Compares each number that has a field or property of its name, and says how many there were.
    static int AssertNames(object native, object given)
    {
        int compared = 0;
        foreach (FieldInfo field in native.GetType().GetFields())
        {
            if (!field.FieldType.IsPrimitive || field.Name == "struct_size" || field.Name == "reserved") continue;
            string name = "";
            foreach (string word in field.Name.Split('_')) name += char.ToUpperInvariant(word[0]) + word.Substring(1);
            FieldInfo to = given.GetType().GetField(name);
            PropertyInfo property = given.GetType().GetProperty(name);
            Assert.IsTrue(to != null || property != null, given.GetType().Name + " has no " + name);
            object value = to != null ? to.GetValue(given) : property.GetValue(given, null);
            object expected = field.GetValue(native);
            if (value is bool) Assert.AreEqual((uint)expected != 0, value, name);
            else Assert.AreEqual(Convert.ToDouble(expected), Convert.ToDouble(value), name);
            compared++;
        }
        return compared;
    }
}
}
