using NUnit.Framework;

namespace SuperDeform.Tests
{
[TestFixture]
public sealed class NameTests
{
    [Test]
    public void A_mesh_with_a_Japanese_name_is_named_in_errors()
    {
        var figure = new Mannequin();
        figure.Positions[3].X = float.PositiveInfinity;
        using (var character = new Character())
        {
            character.SetSkeleton(figure.Skeleton);
            Thrown.Says(Thrown.Invalid(Status.BadInput, () => character.AddMesh(figure.Mesh("体/肌"))), "体/肌");
        }
    }

    [Test]
    public void A_message_is_cut_between_characters()
    {
        var figure = new Mannequin();
        figure.Positions[3].X = float.NaN;
        using (var character = new Character())
        {
            character.SetSkeleton(figure.Skeleton);
            for (int padding = 0; padding < 3; padding++)
            {
                string name = new string('a', padding) + new string('髪', 300);
                MeshArrays mesh = figure.Mesh(name);
                InvalidInputException exception = Thrown.Invalid(Status.BadInput, () => character.AddMesh(mesh));
                Assert.IsFalse(exception.Message.Contains("\uFFFD"), exception.Message);
                Thrown.Says(exception, "髪髪髪");
            }
        }
    }

    [Test]
    public void A_group_of_your_own_keeps_its_Japanese_name()
    {
        var options = new Options();
        options.BoneGroups.Add(new BoneGroup { Role = HumanoidRole.LeftHand, Group = "手袋" });
        options.Mode = Mode.Paper;
        using (Character character = new Mannequin().Character())
        using (Style style = Style.Measure(character, "ちびキャラ", options))
        using (var deformer = new Deformer(character, style, options))
        {
            bool found = false;
            foreach (Group group in deformer.GetGroups()) found = found || group.Name == "手袋";
            Assert.IsTrue(found, "the group 手袋 is not among the groups");
            Assert.IsTrue(style.ToJson().Contains("ちびキャラ"), style.ToJson());
        }
    }

    [Test]
    public void A_group_that_nobody_knows_is_named()
    {
        var options = new Options();
        options.Groups.Add(new GroupSettings { Group = "尻尾", LengthScale = 2 });
        using (Character character = new Mannequin().Character())
        using (Style style = Style.FromHeads(2.5))
        {
            Thrown.Says(Thrown.Invalid(Status.BadOption, () => new Deformer(character, style, options)), "尻尾");
        }
    }

    [Test]
    public void Warnings_are_taken_apart_and_keep_Japanese_text()
    {
        System.Collections.Generic.IList<Warning> warnings = Warning.Parse("joint_by_ratio: 頭: 推定\nother: b\n");
        Assert.AreEqual(2, warnings.Count);
        Assert.AreEqual("joint_by_ratio", warnings[0].Code);
        Assert.AreEqual("頭: 推定", warnings[0].Text);
        Assert.AreEqual("other: b", warnings[1].ToString());
        Assert.AreEqual(0, Warning.Parse("").Count);
    }

    [Test]
    public void Names_may_be_null()
    {
        var figure = new Mannequin();
        figure.Skeleton.Names[2] = null;
        MeshArrays mesh = figure.Mesh(null);
        using (var character = new Character())
        {
            character.SetSkeleton(figure.Skeleton);
            figure.Skeleton.Names = null;
            character.SetSkeleton(figure.Skeleton);
            Assert.AreEqual(0, character.AddMesh(mesh));
            character.AddMorphTarget(0, new MorphArrays { Positions = figure.Smile });
            Assert.AreEqual(1, character.Info.MorphTargetCount);
        }
    }
}
}
