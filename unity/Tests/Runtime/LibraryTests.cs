using System;
using NUnit.Framework;

namespace SuperDeform.Tests
{
[TestFixture]
public sealed class LibraryTests
{
    [Test]
    public void The_library_is_there_and_of_this_version()
    {
        SuperDeformLibrary.Check();
        Assert.AreEqual(Native.SDEF_ABI_VERSION, Native.sdef_abi_version());
        Assert.AreEqual(SuperDeformLibrary.Version, SuperDeformLibrary.NativeVersion);
    }

    [Test]
    public void Another_version_says_to_restart_the_editor()
    {
        LibraryVersionException exception = Thrown.With<LibraryVersionException>(Status.Internal,
            () => SuperDeformLibrary.CheckVersion(Native.SDEF_ABI_VERSION + 1));
        Thrown.Says(exception, "version 2", "version 1", "restart the editor",
            "superdeform-" + SuperDeformLibrary.Version + ".tgz");
    }

    [Test]
    public void Every_status_has_the_name_that_C_gives_it()
    {
        foreach (Status status in Enum.GetValues(typeof(Status)))
        {
            string name = SuperDeformLibrary.StatusName(status);
            Assert.AreEqual("SDEF_STATUS_" + status.ToString().ToUpperInvariant(), name.Replace("_", "").Replace(
                "SDEFSTATUS", "SDEF_STATUS_"));
            Assert.AreEqual((uint)status, typeof(Native).GetField(name, Everything).GetRawConstantValue());
        }
        Assert.AreEqual("unknown status", SuperDeformLibrary.StatusName((Status)13));
    }

    [Test]
    public void Numbers_that_choose_are_those_of_C()
    {
        AssertNumbers(typeof(MeshKind), "SDEF_MESH_");
        AssertNumbers(typeof(Mode), "SDEF_MODE_");
        AssertNumbers(typeof(Stage), "SDEF_STAGE_");
        AssertNumbers(typeof(FaceCurve), "SDEF_FACE_CURVE_");
        AssertNumbers(typeof(Repair), "SDEF_REPAIR_");
        AssertNumbers(typeof(BodyWeights), "SDEF_WEIGHTS_");
        AssertNumbers(typeof(GarmentWeights), "SDEF_GARMENTS_");
    }

    [Test]
    public void Roles_are_those_of_C_with_the_thumbs_joints_under_the_engines_names()
    {
        Assert.AreEqual(Native.SDEF_BONE_HEAD_TOP, (uint)HumanoidRole.HeadTop);
        Assert.AreEqual(Native.SDEF_NONE, unchecked((uint)HumanoidRole.None));
        int roles = 0;
        foreach (HumanoidRole role in Enum.GetValues(typeof(HumanoidRole)))
        {
            if (role == HumanoidRole.None || role == HumanoidRole.HeadTop) continue;
            string name = role.ToString();
            if (name.Contains("Thumb")) name = name.Replace("Proximal", "Metacarpal").Replace("Intermediate", "Proximal");
            Assert.AreEqual((uint)role, Number("SDEF_ROLE_", name), role.ToString());
            roles++;
        }
        Assert.AreEqual(Native.SDEF_ROLE_COUNT, (uint)roles);
    }

    const System.Reflection.BindingFlags Everything = System.Reflection.BindingFlags.Static
        | System.Reflection.BindingFlags.NonPublic | System.Reflection.BindingFlags.Public;

    static void AssertNumbers(Type type, string prefix)
    {
        int inC = 0;
        foreach (System.Reflection.FieldInfo field in typeof(Native).GetFields(Everything))
        {
            if (field.Name.StartsWith(prefix, StringComparison.Ordinal)) inC++;
        }
        Assert.AreEqual(inC, Enum.GetValues(type).Length, type.Name);
        foreach (object value in Enum.GetValues(type))
        {
            Assert.AreEqual((uint)value, Number(prefix, value.ToString()), value.ToString());
        }
    }

    // The constant of C whose name without underscores is the given one.
    static uint Number(string prefix, string name)
    {
        foreach (System.Reflection.FieldInfo field in typeof(Native).GetFields(Everything))
        {
            if (!field.Name.StartsWith(prefix, StringComparison.Ordinal)) continue;
            if (field.Name.Substring(prefix.Length).Replace("_", "") == name.ToUpperInvariant()) return (uint)field.GetRawConstantValue();
        }
        throw new ArgumentException("C has no " + prefix + "* for " + name);
    }
}
}
