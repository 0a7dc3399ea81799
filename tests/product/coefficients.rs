//! `coefficients.rs`: scales against numbers worked by hand.

use std::collections::BTreeMap;
use superdeform::internals::shape::product::anatomy::{Anatomy, Proportions};
use superdeform::internals::shape::product::coefficients::{Goal, heads_of, lost, part_coefficients};
use superdeform::internals::shape::product::part_settings::PartGroups;
use superdeform::internals::shape::product::scales::{PartCoefficients, Scale};
use superdeform::{GroupSettings, Options, Stage, Warning};

use crate::people::Person;
use superdeform::internals::shape::figure::Figure;

/// 7.8 heads.
fn tall() -> Proportions {
    Proportions {
        head_length: 0.2,
        head_half_width: 0.08,
        head_half_depth: Some(0.09),
        neck: 0.06,
        torso: 0.5,
        arm: 0.5,
        leg: 0.8,
        ankle_height: 0.08,
        hand: Some(0.18),
        foot: Some(0.24),
        torso_half_width: Some(0.15),
        upper_arm_radius: Some(0.05),
        lower_arm_radius: Some(0.04),
        upper_leg_radius: Some(0.08),
        lower_leg_radius: Some(0.05),
    }
}

/// 2.6 heads.
fn small() -> Proportions {
    Proportions {
        head_length: 0.4,
        head_half_width: 0.2,
        head_half_depth: Some(0.2),
        neck: 0.04,
        torso: 0.3,
        arm: 0.28,
        leg: 0.3,
        ankle_height: 0.05,
        hand: Some(0.1),
        foot: Some(0.15),
        torso_half_width: Some(0.14),
        upper_arm_radius: Some(0.05),
        lower_arm_radius: Some(0.048),
        upper_leg_radius: Some(0.07),
        lower_leg_radius: Some(0.06),
    }
}

/// All of the goal.
fn solved(target: &Proportions, goal: Goal, options: &Options) -> (PartCoefficients, Vec<Warning>) {
    let (scales, limits) =
        part_coefficients(target, goal, 1.0, 0.0, options, &PartGroups::default()).unwrap();
    let warnings = limits.warnings(heads_of(target, &scales), goal.heads());
    (scales, warnings)
}

/// Within the sixth digit, as the numbers below are written.
fn assert_near(what: &str, found: f64, expected: f64) {
    assert!(
        (found - expected).abs() <= 2e-6 * expected.abs().max(1.0),
        "{what}: {found} instead of {expected}"
    );
}

fn assert_scale(what: &str, found: Scale, length: f64, thickness: f64) {
    assert_near(&format!("length of {what}"), found.length, length);
    assert_near(&format!("thickness of {what}"), found.thickness, thickness);
}

fn codes(warnings: &[Warning]) -> Vec<&str> {
    warnings.iter().map(|warning| warning.code).collect()
}

#[test]
fn a_figure_made_like_itself_with_its_own_head_keeps_every_scale() {
    let options = Options { head_scale: 1.0, ..Options::default() };
    for target in [tall(), small()] {
        let (scales, warnings) = solved(&target, Goal::Reference(&target), &options);
        assert_eq!(warnings, []);
        assert_scale("neck", scales.neck, 1.0, 1.0);
        assert_scale("torso", scales.torso, 1.0, 1.0);
        for (what, scale) in [
            ("upper arm", scales.upper_arm),
            ("lower arm", scales.lower_arm),
            ("upper leg", scales.upper_leg),
            ("lower leg", scales.lower_leg),
        ] {
            assert_scale(what, scale, 1.0, 1.0);
        }
        let head = scales.head;
        assert_eq!((head.height, head.width, head.depth), (1.0, 1.0, 1.0));
        assert_near("hand", scales.hand, 1.0);
        assert_near("foot", scales.foot, 1.0);
    }
}

#[test]
fn without_limits_all_lengths_in_heads_are_the_references() {
    let options = Options { limits: false, ..Options::default() };
    let (scales, warnings) = solved(&tall(), Goal::Reference(&small()), &options);
    assert_eq!(warnings, []);
    // The new head is 1.5 * 0.2 = 0.3 long, so the reference's lengths count 0.3 / 0.4 = 0.75 of theirs. Its width grows
    // 1.12 times as much: (1.12 * 0.08 / 0.2) / (0.2 / 0.4) = 0.896 of the reference's, and thicknesses with it.
    assert_near("head's height", scales.head.height, 1.5);
    assert_near("head's width", scales.head.width, 1.68);
    assert_near("head's depth", scales.head.depth, 1.575);
    // 0.75 * 0.04 / 0.06; as thick as the torso.
    assert_scale("neck", scales.neck, 0.5, trunk_thickness());
    // 0.75 * 0.3 / 0.5, and the root of that.
    assert_scale("torso", scales.torso, 0.45, trunk_thickness());
    assert_near("shoulders", scales.shoulder_spread, trunk_thickness());
    assert_near("hips", scales.hip_spread, trunk_thickness());
    assert_scale("upper arm", scales.upper_arm, 0.42, trunk_thickness());
    assert_scale("lower arm", scales.lower_arm, 0.42, trunk_thickness());
    assert_near("hand", scales.hand, 0.075 / 0.18);
    assert_near("foot", scales.foot, 0.46875);
    // (0.225 - 0.08 * 0.46875) / 0.72: what the foot takes is not the leg's.
    assert_scale("upper leg", scales.upper_leg, 0.1875 / 0.72, legs_thickness());
    assert_scale("lower leg", scales.lower_leg, 0.1875 / 0.72, legs_thickness());
    assert_near("heads", heads_of(&tall(), &scales), 2.6);
}

/// The root of the torso's length.
fn trunk_thickness() -> f64 {
    0.45_f64.sqrt()
}

/// The root of 0.225 / 0.8.
fn legs_thickness() -> f64 {
    0.28125_f64.sqrt()
}

/// Torso and leg are to be 0.075 long each, 0.1 of heads that are 0.3 where the reference's are 0.4; the foot has 0.35 of the leg's.
fn both_short() -> f64 {
    (0.075 + 0.075 - 0.02625) / (0.5 + 0.72)
}

#[test]
fn the_limits_keep_a_body_sound_and_say_so() {
    let reference = Proportions { leg: 0.24, ..small() };
    let (scales, warnings) = solved(&tall(), Goal::Reference(&reference), &Options::default());
    assert_scale("arm", scales.upper_arm, 0.42, trunk_thickness());
    // The root of what is asked for, 0.18 / 0.8; feet of 0.46875 would be slimmer.
    let thickness = 0.225_f64.sqrt();
    assert_near("legs", scales.upper_leg.thickness, thickness);
    assert_near("foot", scales.foot, thickness);
    // Hands of 0.417 would be slimmer than the arm.
    assert_near("hand", scales.hand, trunk_thickness());
    // Legs of 0.18 less the foot's height, over 0.72, are less than 0.22; the torso gives the rest.
    assert_near("leg", scales.upper_leg.length, 0.22);
    assert_near("lower leg", scales.lower_leg.length, 0.22);
    assert_scale(
        "torso",
        scales.torso,
        0.45 - (0.22 * 0.72 + 0.08 * thickness - 0.18) / 0.5,
        trunk_thickness(),
    );
    assert_near("heads", heads_of(&tall(), &scales), 2.45);
    assert_eq!(codes(&warnings), ["coefficient_limited"]);
    assert!(warnings[0].message.contains("leg length 0.197 to 0.220"), "{}", warnings[0].message);
}

#[test]
fn each_limit_acts_where_it_should() {
    type Change = fn(&mut Proportions, &mut Proportions);
    type Read = fn(&PartCoefficients) -> f64;
    let cases: &[(&str, Change, Read, f64)] = &[
        // 0.75 * 0.2 / 0.3 is half a head; 0.19 of the head's 0.3, over 0.06.
        ("a neck's longest", |_, r| r.neck = 0.2, |s| s.neck.length, 0.19 * 0.3 / 0.06),
        // What the neck leaves, (0.6 - 0.057) / 0.45 of what was asked, torso and legs share.
        ("the torso under it", |_, r| r.neck = 0.2, |s| s.torso.length, 0.225 * 0.543 / 0.45 / 0.5),
        (
            "the legs under it",
            |_, r| r.neck = 0.2,
            |s| s.upper_leg.length,
            (0.2715 - 0.08 * (0.2715_f64 / 0.8).sqrt()) / 0.72,
        ),
        ("a neck's shortest", |_, r| r.neck = 0.004, |s| s.neck.length, 0.03 * 0.3 / 0.06),
        // 1.5 times what the target has in heads: 0.075.
        ("a neck's growth", |t, _| t.neck = 0.01, |s| s.neck.length, 0.075 * 0.3 / 0.01),
        // It grows no more than the head.
        ("the torso's longest", |_, r| (r.torso, r.leg) = (1.5, 1.2), |s| s.torso.length, 1.5),
        ("an arm's shortest", |_, r| r.arm = 0.05, |s| s.upper_arm.length, 0.22),
        ("an arm's longest", |_, r| r.arm = 3.0, |s| s.lower_arm.length, 1.5),
        ("a short leg's thickness", |_, r| r.leg = 0.1, |s| s.lower_leg.thickness, 0.22_f64.sqrt()),
        // As the limb is thick where one is not known.
        ("hands without a style", |_, r| r.hand = None, |s| s.hand, trunk_thickness()),
        ("unknown hands", |t, _| t.hand = None, |s| s.hand, trunk_thickness()),
        ("unknown feet", |t, _| t.foot = None, |s| s.foot, legs_thickness()),
        // Half-way, as factors, from the limb's thickness to the head's growth.
        (
            "large hands",
            |t, r| (t.hand, r.hand) = (Some(0.05), Some(0.4)),
            |s| s.hand,
            (trunk_thickness() * 1.5).sqrt(),
        ),
        (
            "large feet",
            |t, r| (t.foot, r.foot) = (Some(0.05), Some(0.4)),
            |s| s.foot,
            (legs_thickness() * 1.5).sqrt(),
        ),
        // 0.225 less 0.22 of the shank's 0.5, over 0.3.
        ("high ankles", |t, _| t.ankle_height = 0.3, |s| s.foot, 0.115 / 0.3),
        // 0.35 of the new leg's 0.075, over 0.08.
        ("feet of short legs", |_, r| r.leg = 0.1, |s| s.foot, 0.02625 / 0.08),
        // 0.075 was asked of leg and foot.
        (
            "a torso over short legs",
            |_, r| r.leg = 0.1,
            |s| s.torso.length,
            0.45 - (0.22 * 0.72 + 0.02625 - 0.075) / 0.5,
        ),
        // Legs of 0.22 would leave no torso.
        (
            "a short torso over short legs",
            |_, r| (r.torso, r.leg) = (0.1, 0.1),
            |s| s.torso.length,
            both_short(),
        ),
        ("short legs under it", |_, r| (r.torso, r.leg) = (0.1, 0.1), |s| s.upper_leg.length, both_short()),
    ];
    for (what, change, read, expected) in cases {
        let (mut target, mut reference) = (tall(), small());
        change(&mut target, &mut reference);
        let (scales, _) = solved(&target, Goal::Reference(&reference), &Options::default());
        assert_near(what, read(&scales), *expected);
    }
}

#[test]
fn long_legs_of_so_many_heads_take_no_more_than_all_of_a_torso() {
    // 0.8 heads of 0.3 for 0.06, 0.05 and 1.4: the legs' 0.22 are more than that.
    let target = Proportions { torso: 0.05, leg: 1.4, ..tall() };
    let (scales, _) = solved(&target, Goal::Heads(1.8), &Options::default());
    assert_near("leg", scales.upper_leg.length, 0.22);
    assert_near("torso", scales.torso.length, 0.0);
}

#[test]
fn heads_that_grow_half_as_much_are_limited_half_as_much() {
    let options = Options { head_scale: 1.25, ..Options::default() };
    let reference = Proportions { neck: 0.2, ..small() };
    let (scales, _) = solved(&tall(), Goal::Reference(&reference), &options);
    assert_near("width", scales.head.width, 1.06 * 1.25);
    assert_near("depth", scales.head.depth, 1.025 * 1.25);
    // Asked for half a head, bounded to 0.19: half-way between, of the new head's 0.25.
    assert_near("neck", scales.neck.length, 0.345 * 0.25 / 0.06);
}

#[test]
fn a_number_of_heads_is_reached_after_the_targets_own_build() {
    let (scales, warnings) = solved(&tall(), Goal::Heads(3.0), &Options::default());
    // Two heads of 0.2 below the chin where there were 1.36.
    let shrink: f64 = 0.4 / 1.36;
    // The root of the torso's length.
    let thickness = (1.1 * shrink * 1.5).sqrt();
    assert_scale("neck", scales.neck, shrink * 1.5, thickness);
    assert_scale("torso", scales.torso, 1.1 * shrink * 1.5, thickness);
    assert_scale("upper arm", scales.upper_arm, 1.1 * shrink * 1.5, thickness);
    assert_scale("lower arm", scales.lower_arm, 1.1 * shrink * 1.5, thickness);
    let leg = 0.6 - shrink * 1.5 * (0.06 + 1.1 * 0.5);
    let of_leg = (leg / 0.8).sqrt();
    assert_near("foot", scales.foot, of_leg);
    assert_near("hand", scales.hand, thickness);
    assert_scale("upper leg", scales.upper_leg, (leg - 0.08 * of_leg) / 0.72, of_leg);
    assert_scale("lower leg", scales.lower_leg, (leg - 0.08 * of_leg) / 0.72, of_leg);
    assert_near("heads", heads_of(&tall(), &scales), 3.0);
    assert_eq!(warnings, []);
}

#[test]
fn the_number_of_heads_is_reached_or_warned_of() {
    for person in [Person::adult(), Person::chibi()] {
        let target = Anatomy::of(&Figure::of(&person.build()).unwrap()).proportions;
        for heads in [1.8, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0] {
            let (scales, warnings) = solved(&target, Goal::Heads(heads), &Options::default());
            let off = (heads_of(&target, &scales) / heads - 1.0).abs();
            assert_eq!(off > 0.005, codes(&warnings).contains(&"heads_limited"), "{heads}: off by {off}");
            // Legs give way last: whoever has more than three heads gets them.
            assert!(heads < 3.0 || person != Person::adult() || off < 1e-9, "{heads}: off by {off}");
        }
    }
}

#[test]
fn the_first_stage_leaves_every_thickness() {
    let options = Options { stage: Stage::Length, ..Options::default() };
    let (all, _) = solved(&tall(), Goal::Reference(&small()), &Options::default());
    let (scales, _) = solved(&tall(), Goal::Reference(&small()), &options);
    assert_eq!(scales, all.lengths_only());
    assert_eq!([scales.torso, scales.upper_arm].map(|scale| scale.thickness), [1.0, 1.0]);
}

#[test]
fn what_a_user_sets_stands_beside_the_limits() {
    let settings = GroupSettings { length_scale: Some(0.05), ..GroupSettings::default() };
    let options =
        Options { groups: BTreeMap::from([("upper_leg".to_string(), settings)]), ..Options::default() };
    let (scales, _) = solved(&tall(), Goal::Reference(&small()), &options);
    assert_eq!(scales.upper_leg.length, 0.05);
    // 0.225 less the foot's height.
    assert_near("lower leg", scales.lower_leg.length, (0.225 - 0.08 * legs_thickness()) / 0.72);
}

/// As [`solved`], so much of it.
fn partly(target: &Proportions, goal: Goal, lost: f64) -> PartCoefficients {
    part_coefficients(target, goal, lost, 0.0, &Options::default(), &PartGroups::default()).unwrap().0
}

#[test]
fn a_style_is_taken_as_far_as_the_figure_loses_heads() {
    assert_eq!([lost(2.3, 2.5), lost(2.5, 2.5), lost(3.1, 2.5), lost(7.0, 2.5)], [0.0, 0.0, 1.0, 1.0]);
    assert_near("half", lost(2.75, 2.5), 0.5);
    assert_near("all", lost(3.0, 2.5), 1.0);
}

#[test]
fn a_figure_that_loses_no_heads_keeps_every_scale() {
    // As many heads, and otherwise another body.
    let other = Proportions {
        torso: 0.2,
        leg: 0.4,
        arm: 0.5,
        torso_half_width: Some(0.3),
        foot: Some(0.3),
        ..small()
    };
    assert_near("heads", other.heads(), small().heads());
    for goal in [Goal::Reference(&other), Goal::Heads(small().heads())] {
        let scales = partly(&small(), goal, 0.0);
        for (_, coefficient) in scales.by_group(&PartGroups::default()) {
            assert_near("length", coefficient.length_scale, 1.0);
            assert_near("thickness", coefficient.thickness_scale, 1.0);
        }
        assert_eq!(scales.head.depth, 1.0);
    }
}

#[test]
fn what_loses_some_heads_gets_the_number_and_some_of_the_style() {
    let target = Proportions { head_length: 0.35, ..small() };
    let goal = Goal::Reference(&Proportions { torso: 0.32, leg: 0.28, ..small() });
    let [none, half, all] = [0.0, 0.5, 1.0].map(|lost| partly(&target, goal, lost));
    for scales in [&none, &half, &all] {
        assert_near("heads", heads_of(&target, scales), 2.6);
    }
    let torso = |scales: &PartCoefficients| scales.torso.length / scales.head.height;
    assert_near("torso", torso(&half), 0.5 * (torso(&none) + torso(&all)));
    assert_eq!([none.head.height, half.head.height, all.head.height], [1.0, 1.25, 1.5]);
}

#[test]
fn a_mascot_gets_limbs_for_its_trunk() {
    // All above the legs is 0.76 and 0.74 high, so the reference's lengths count 1.027 of theirs.
    let scales = partly(&tall(), Goal::Limbs(&small()), 0.0);
    let unit = 0.76 / 0.74;
    assert_scale("arm", scales.upper_arm, unit * 0.28 / 0.5, 1.0);
    assert_scale("leg", scales.lower_leg, (unit * 0.3 - 0.08) / 0.72, 1.0);
    let limbs = |scale: PartCoefficients| PartCoefficients {
        upper_arm: Scale::IDENTITY,
        lower_arm: Scale::IDENTITY,
        upper_leg: Scale::IDENTITY,
        lower_leg: Scale::IDENTITY,
        ..scale
    };
    assert_eq!(limbs(scales), PartCoefficients::IDENTITY);
    // Nothing becomes longer.
    assert_eq!(partly(&small(), Goal::Limbs(&tall()), 0.0), PartCoefficients::IDENTITY);
}
