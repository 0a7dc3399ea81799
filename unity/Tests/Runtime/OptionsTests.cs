using System;
using System.Collections.Generic;
using System.Reflection;
using NUnit.Framework;

namespace SuperDeform.Tests
{
[TestFixture]
public sealed class OptionsTests
{
    [Test]
    public unsafe void The_defaults_are_the_librarys()
    {
        var expected = new SdefOptions();
        Assert.AreEqual(0u, Native.sdef_options_init(&expected, (uint)sizeof(SdefOptions), null));
        using (var scope = new MarshalScope())
        {
            SdefOptions* given = scope.Options(new Options());
            // No number is one of many: any will do.
            Assert.IsTrue(double.IsNaN(expected.face_squash) && double.IsNaN(given->face_squash));
            expected.face_squash = given->face_squash = 0;
            Assert.IsTrue(double.IsNaN(expected.height) && double.IsNaN(given->height));
            expected.height = given->height = 0;
            given->groups = null;
            given->bone_groups = null;
            given->rig_joints = null;
            byte* left = (byte*)&expected, right = (byte*)given;
            for (int i = 0; i < sizeof(SdefOptions); i++) Assert.AreEqual(left[i], right[i], "byte " + i);
        }
    }

    // Numbers of a struct of the library's: not its size, pointers and how much they point to.
    static IEnumerable<FieldInfo> Numbers(Type type)
    {
        foreach (FieldInfo field in type.GetFields(BindingFlags.Instance | BindingFlags.Public | BindingFlags.NonPublic))
        {
            FieldInfo list = type.GetField(field.Name.Replace("_count", "s"));
            bool counts = list != null && list.FieldType.IsPointer;
            if (!field.FieldType.IsPointer && !counts && field.Name != "struct_size" && field.Name != "reserved") yield return field;
        }
    }

    // The field that C# has for one of the library's: HeadScale for head_scale.
    static FieldInfo Field(Type type, string name)
    {
        string own = "";
        foreach (string word in name.Split('_')) own += char.ToUpperInvariant(word[0]) + word.Substring(1);
        FieldInfo field = type.GetField(own);
        Assert.IsNotNull(field, type.Name + " has no field " + own);
        return field;
    }

    // Another value than the default for each field; gives what the library is to see.
    static Dictionary<FieldInfo, object> Change(object options, Type native)
    {
        var expected = new Dictionary<FieldInfo, object>();
        foreach (FieldInfo number in Numbers(native))
        {
            FieldInfo field = Field(options.GetType(), number.Name);
            object value = 3u + expected.Count;
            if (field.FieldType == typeof(bool)) value = !(bool)field.GetValue(options);
            else if (field.FieldType == typeof(double)) value = 0.25 + expected.Count;
            else if (field.FieldType.IsEnum)
            {
                Array values = Enum.GetValues(field.FieldType);
                int usual = Array.IndexOf(values, field.GetValue(options));
                value = values.GetValue((usual + 1) % values.Length);
            }
            field.SetValue(options, Convert.ChangeType(value, field.FieldType));
            expected.Add(number, value is double ? value : Convert.ToUInt32(value));
        }
        return expected;
    }

    [Test]
    public unsafe void Every_field_arrives()
    {
        var options = new Options();
        var head = new GroupSettings { Group = "head" };
        options.Groups.Add(head);
        options.BoneGroups.Add(new BoneGroup { Role = HumanoidRole.LeftHand, Group = "手" });
        options.RigJoints.Add(new GivenJoint(HumanoidRole.Head, 1, 2, 3));
        Dictionary<FieldInfo, object> expected = Change(options, typeof(SdefOptions));
        Dictionary<FieldInfo, object> expectedOfHead = Change(head, typeof(SdefGroupSettings));
        Assert.IsTrue(expected.Count >= 15 && expectedOfHead.Count >= 4);
        using (var scope = new MarshalScope())
        {
            SdefOptions* given = scope.Options(options);
            foreach (KeyValuePair<FieldInfo, object> number in expected)
            {
                Assert.AreEqual(number.Value, number.Key.GetValue(*given), number.Key.Name);
            }
            Assert.AreEqual(1u, given->group_count);
            Assert.AreEqual("head", Text.Of(given->groups->group));
            foreach (KeyValuePair<FieldInfo, object> number in expectedOfHead)
            {
                Assert.AreEqual(number.Value, number.Key.GetValue(*given->groups), number.Key.Name);
            }
            Assert.AreEqual(1u, given->bone_group_count);
            Assert.AreEqual(Native.SDEF_ROLE_LEFT_HAND, given->bone_groups->role);
            Assert.AreEqual("手", Text.Of(given->bone_groups->group));
            Assert.AreEqual(1u, given->rig_joint_count);
            Assert.AreEqual(Native.SDEF_ROLE_HEAD, given->rig_joints->role);
            Assert.AreEqual(1.0, given->rig_joints->x);
            Assert.AreEqual(2.0, given->rig_joints->y);
            Assert.AreEqual(3.0, given->rig_joints->z);
        }
    }

    [Test]
    public void A_copy_shares_nothing()
    {
        var options = new Options { HeadScale = 1.25 };
        options.Groups.Add(new GroupSettings { Group = "head", LengthScale = 2 });
        options.BoneGroups.Add(new BoneGroup { Role = HumanoidRole.LeftHand, Group = "own" });
        options.RigJoints.Add(new GivenJoint(HumanoidRole.Head, 1, 2, 3));
        Options copy = options.Clone();
        Assert.AreEqual(1.25, copy.HeadScale);
        copy.Groups[0].LengthScale = 3;
        copy.BoneGroups[0].Group = "other";
        copy.RigJoints.Clear();
        Assert.AreEqual(2.0, options.Groups[0].LengthScale);
        Assert.AreEqual("own", options.BoneGroups[0].Group);
        Assert.AreEqual(1, options.RigJoints.Count);
        Assert.IsNull(new Options { Groups = null }.Clone().Groups);
    }

    [Test]
    public void Lists_may_be_null_and_so_may_the_options()
    {
        var figure = new Mannequin();
        var options = new Options { Groups = null, BoneGroups = null, RigJoints = null };
        using (Character character = figure.Character())
        using (Style style = Style.FromHeads(2.5))
        using (var with = new Deformer(character, style, options))
        using (var without = new Deformer(character, style))
        {
            MeshOutput first = Mannequin.Output(figure.VertexCount), second = Mannequin.Output(figure.VertexCount);
            with.Apply(new[] { first });
            without.Apply(new[] { second });
            Assert.AreEqual(first.Positions, second.Positions);
        }
    }

    [Test]
    public void An_empty_place_in_a_list_is_named()
    {
        var options = new Options();
        options.Groups.Add(null);
        InvalidInputException exception = Thrown.Invalid(Status.BadArgument, () =>
        {
            using (Character character = new Mannequin().Character())
            using (Style.Measure(character, null, options)) { }
        });
        Thrown.Says(exception, "Groups[0]");
    }
}
}
