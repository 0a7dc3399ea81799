using NUnit.Framework;

namespace SuperDeform.Tests
{
[TestFixture]
public sealed class OptionsTests
{
    [Test]
    public unsafe void The_defaults_are_the_librarys()
    {
        SdefOptions expected = new SdefOptions();
        Assert.AreEqual(0u, Native.sdef_options_init(&expected, (uint)sizeof(SdefOptions), null));
        using (Loan loan = new Loan())
        {
            SdefOptions* given = loan.Options(new Options());
            // No number is one of many: any will do.
            Assert.IsTrue(double.IsNaN(expected.face_squash) && double.IsNaN(given->face_squash));
            expected.face_squash = given->face_squash = 0;
            given->groups = null;
            given->bone_groups = null;
            given->rig_joints = null;
            byte* left = (byte*)&expected, right = (byte*)given;
            for (int i = 0; i < sizeof(SdefOptions); i++) Assert.AreEqual(left[i], right[i], "byte " + i);
        }
    }

    [Test]
    public unsafe void Every_field_arrives()
    {
        Options options = new Options();
        options.ThreadCount = 3;
        options.Mode = Mode.Paper;
        options.Stage = Stage.Thickness;
        options.Rays = 24;
        options.Limits = false;
        options.HeadScale = 1.25;
        options.Amount = 0.5;
        options.HairLength = 0.75;
        options.FaceSquash = -1;
        options.FaceCurve = FaceCurve.Sphere;
        options.RigWeights = BodyWeights.Volume;
        options.RigGarments = GarmentWeights.Nearest;
        options.RigVoxelResolution = 64;
        options.RigFingers = false;
        options.RigChinSegment = false;
        options.RigHeat = 2.5;
        options.RigLeftHanded = true;
        options.Groups.Add(new GroupSettings { Group = "head", LengthScale = 2, ThicknessScale = 3, LengthTransfer = 4,
            ThicknessTransfer = 5 });
        options.BoneGroups.Add(new BoneGroup { Role = HumanoidRole.LeftHand, Group = "手" });
        options.RigJoints.Add(new GivenJoint(HumanoidRole.Head, 1, 2, 3));
        using (Loan loan = new Loan())
        {
            SdefOptions* given = loan.Options(options);
            Assert.AreEqual(3u, given->thread_count);
            Assert.AreEqual(Native.SDEF_MODE_PAPER, given->mode);
            Assert.AreEqual(Native.SDEF_STAGE_THICKNESS, given->stage);
            Assert.AreEqual(24u, given->rays);
            Assert.AreEqual(0u, given->limits);
            Assert.AreEqual(1.25, given->head_scale);
            Assert.AreEqual(0.5, given->amount);
            Assert.AreEqual(0.75, given->hair_length);
            Assert.AreEqual(-1.0, given->face_squash);
            Assert.AreEqual(Native.SDEF_FACE_CURVE_SPHERE, given->face_curve);
            Assert.AreEqual(Native.SDEF_WEIGHTS_VOLUME, given->rig_weights);
            Assert.AreEqual(Native.SDEF_GARMENTS_NEAREST, given->rig_garments);
            Assert.AreEqual(64u, given->rig_voxel_resolution);
            Assert.AreEqual(0u, given->rig_fingers);
            Assert.AreEqual(0u, given->rig_chin_segment);
            Assert.AreEqual(2.5, given->rig_heat);
            Assert.AreEqual(1u, given->rig_left_handed);
            Assert.AreEqual(1u, given->group_count);
            Assert.AreEqual("head", Text.Of(given->groups->group));
            Assert.AreEqual(2.0, given->groups->length_scale);
            Assert.AreEqual(3.0, given->groups->thickness_scale);
            Assert.AreEqual(4.0, given->groups->length_transfer);
            Assert.AreEqual(5.0, given->groups->thickness_transfer);
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
    public void Lists_may_be_null_and_so_may_the_options()
    {
        Mannequin figure = new Mannequin();
        Options options = new Options { Groups = null, BoneGroups = null, RigJoints = null };
        using (Character character = figure.Character())
        using (Style style = Style.FromHeads(2.5))
        using (Deformer with = new Deformer(character, style, options))
        using (Deformer without = new Deformer(character, style))
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
        Options options = new Options();
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
