using NUnit.Framework;

namespace SuperDeform.Tests
{
[TestFixture]
public sealed class StyleTests
{
    [Test]
    public void A_style_of_so_many_heads_makes_so_many()
    {
        using (Character character = new Mannequin().Character())
        using (Style style = Style.FromHeads(3))
        using (var deformer = new Deformer(character, style))
        {
            Report report = deformer.GetReport();
            Assert.AreEqual(3, report.Result.Heads, 0.15);
            Assert.IsTrue(report.Target.Heads > 5, report.Target.Heads.ToString());
            Assert.IsTrue(double.IsNaN(report.Reference.Heads));
        }
    }

    [Test]
    public void Built_in_styles_are_between_2_and_4_heads()
    {
        string[] names = { "sd2", "sd2.5", "sd3", "sd4" };
        double[] heads = { 2, 2.5, 3, 4 };
        for (int i = 0; i < names.Length; i++)
        {
            using (Style style = Style.FromText(names[i]))
            {
                Assert.AreEqual(heads[i], style.Numbers.Heads, 1e-9, names[i]);
            }
        }
    }

    [Test]
    public void A_measured_style_comes_back_from_its_JSON_and_from_its_numbers()
    {
        using (Character character = new Mannequin().Character())
        using (Style measured = Style.Measure(character, "figure"))
        using (Style read = Style.FromText(measured.ToJson()))
        using (Style made = Style.FromNumbers("figure", measured.Numbers, measured.Bones))
        {
            Assert.AreEqual(measured.ToJson(), read.ToJson());
            AssertNumbers(measured.Numbers, read.Numbers);
            AssertNumbers(measured.Numbers, made.Numbers);
            Assert.IsTrue(measured.Bones.Length > 10);
            Assert.AreEqual(HumanoidRole.HeadTop, measured.Bones[measured.Bones.Length - 1].End);
            Assert.AreEqual(measured.Bones, made.Bones);
            Assert.AreEqual(0.27, Length(measured, HumanoidRole.LeftLowerArm), 0.01);
        }
    }

    [Test]
    public void Numbers_measure_the_figure()
    {
        using (Character character = new Mannequin().Character())
        using (Style measured = Style.Measure(character))
        {
            StyleNumbers numbers = measured.Numbers;
            Assert.AreEqual(1.75, numbers.Crown, 0.02);
            Assert.AreEqual(0.0, numbers.Sole, 0.05);
            Assert.AreEqual(numbers.Crown - numbers.Chin, numbers.HeadLength, 1e-6);
            Assert.AreEqual(0.05, numbers.UpperArmRadius, 0.005);
            Assert.AreEqual(0.08, numbers.UpperLegRadius, 0.008);
        }
    }

    [Test]
    public void A_style_in_between_has_the_heads_in_between()
    {
        using (Style small = Style.FromText("sd2"))
        using (Style large = Style.FromText("sd4"))
        using (Style between = Style.Blend(small, large, 0.5))
        using (Style like = Style.FromHeads(3, between))
        {
            Assert.AreEqual(3, between.Numbers.Heads, 1e-6);
            Assert.AreEqual(3, like.Numbers.Heads, 1e-6);
        }
    }

    [Test]
    public void Styles_without_what_is_asked_of_them_say_so()
    {
        using (Style heads = Style.FromHeads(2.5))
        using (Style saved = Style.FromText("sd3"))
        {
            Thrown.Invalid(Status.BadStyle, () => heads.ToJson());
            Thrown.Invalid(Status.BadStyle, () => Style.Blend(heads, saved, 0.5));
            Assert.AreEqual(0, heads.Bones.Length);
        }
        Thrown.Says(Thrown.Invalid(Status.BadOption, () => Style.FromHeads(40)), "40");
        Thrown.Invalid(Status.BadStyle, () => Style.FromNumbers(null, new StyleNumbers { HeadLength = -1 }));
        Thrown.Invalid(Status.BadStyle, () => Style.FromText("{\"名前\": 1}"));
        Thrown.Invalid(Status.BadStyle, () => Style.FromText(""));
    }

    static double Length(Style style, HumanoidRole end)
    {
        foreach (Bone bone in style.Bones)
        {
            if (bone.End == end) return bone.Length;
        }
        return double.NaN;
    }

    static void AssertNumbers(StyleNumbers expected, StyleNumbers given)
    {
        System.Reflection.FieldInfo[] fields = typeof(StyleNumbers).GetFields();
        Assert.AreEqual(24, fields.Length);
        foreach (System.Reflection.FieldInfo field in fields)
        {
            Assert.AreEqual(field.GetValue(expected), field.GetValue(given), field.Name);
        }
    }
}
}
