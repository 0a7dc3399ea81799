//! `part.rs`: which part a role moves, and weights by part.

use crate::tubes::mirrored;
use superdeform::Role::{self, *};
use superdeform::internals::shape::product::part::{PART_COUNT, Part, add, fold_to_parts};

#[test]
fn a_joint_moves_the_part_that_it_lies_in() {
    for (roles, part) in [
        (&[Hips, Spine, Chest, UpperChest, LeftShoulder, RightShoulder][..], Part::Torso),
        (&[Neck], Part::Neck),
        (&[Head, Jaw, LeftEye, RightEye], Part::Head),
        (&[LeftUpperArm], Part::LeftUpperArm),
        (&[LeftLowerArm], Part::LeftLowerArm),
        (&[LeftHand, LeftThumbMetacarpal, LeftIndexProximal, LeftLittleDistal], Part::LeftHand),
        (&[RightHand, RightThumbDistal, RightRingIntermediate], Part::RightHand),
        (&[RightUpperArm], Part::RightUpperArm),
        (&[RightLowerArm], Part::RightLowerArm),
        (&[LeftUpperLeg], Part::LeftUpperLeg),
        (&[LeftLowerLeg], Part::LeftLowerLeg),
        (&[LeftFoot, LeftToes], Part::LeftFoot),
        (&[RightUpperLeg], Part::RightUpperLeg),
        (&[RightLowerLeg], Part::RightLowerLeg),
        (&[RightFoot, RightToes], Part::RightFoot),
    ] {
        for &role in roles {
            assert_eq!(Part::of(role), part, "{role}");
        }
    }
}

#[test]
fn the_other_side_of_a_role_moves_the_other_side_of_the_part() {
    for role in Role::all() {
        let (part, other) = (Part::of(role) as usize, Part::of(role.mirrored()) as usize);
        assert_eq!(other, mirrored(part), "{role}");
    }
}

#[test]
fn weights_of_roles_add_up_by_part() {
    let parts = fold_to_parts(&[(Spine, 0.25), (LeftShoulder, 0.125), (LeftUpperArm, 0.5), (Neck, 0.125)]);
    let mut expected = [0.0; PART_COUNT];
    expected[Part::Torso as usize] = 0.375;
    expected[Part::Neck as usize] = 0.125;
    expected[Part::LeftUpperArm as usize] = 0.5;
    assert_eq!(parts, expected);
}

#[test]
fn a_part_alone_has_all_the_weight_and_rows_add_by_their_factor() {
    let mut sum = Part::Hair.alone();
    assert_eq!((sum[Part::Hair as usize], sum.iter().sum::<f32>()), (1.0, 1.0));
    add(&mut sum, &Part::Torso.alone(), 0.5);
    add(&mut sum, &Part::Hair.alone(), -0.25);
    assert_eq!((sum[Part::Hair as usize], sum[Part::Torso as usize]), (0.75, 0.5));
    assert_eq!(sum.iter().sum::<f32>(), 1.25);
}
