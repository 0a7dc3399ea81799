//! `scales.rs`: what a user sets, and the report's scales by group.

use std::collections::BTreeMap;
use superdeform::internals::shape::group::Coefficient;
use superdeform::internals::shape::product::part_settings::PartGroups;
use superdeform::internals::shape::product::scales::{HeadScale, PartCoefficients, Scale};
use superdeform::{ErrorKind, GroupSettings};

fn scale(length: f64, thickness: f64) -> Scale {
    Scale { length, thickness }
}

/// A scale of its own for every part.
fn scales() -> PartCoefficients {
    PartCoefficients {
        head: HeadScale { height: 1.5, width: 1.6, depth: 1.2 },
        neck: scale(0.5, 0.75),
        torso: scale(0.6, 0.8),
        shoulder_spread: 0.7,
        hip_spread: 0.65,
        upper_arm: scale(0.4, 0.45),
        lower_arm: scale(0.42, 0.47),
        upper_leg: scale(0.3, 0.35),
        lower_leg: scale(0.32, 0.37),
        hand: 0.9,
        foot: 0.95,
    }
}

fn set(settings: &[(&str, GroupSettings)]) -> PartCoefficients {
    let settings: BTreeMap<String, GroupSettings> =
        settings.iter().map(|(name, settings)| (name.to_string(), *settings)).collect();
    let mut changed = scales();
    changed.apply_settings(&settings, &PartGroups::default()).unwrap();
    changed
}

/// The same scales but for the last digit.
fn assert_same(what: &str, found: PartCoefficients, expected: PartCoefficients) {
    let numbers = |scales: PartCoefficients| {
        let HeadScale { height, width, depth } = scales.head;
        let parts = [
            scales.neck,
            scales.torso,
            scales.upper_arm,
            scales.lower_arm,
            scales.upper_leg,
            scales.lower_leg,
        ];
        let mut numbers = vec![height, width, depth, scales.shoulder_spread, scales.hip_spread];
        numbers.extend([scales.hand, scales.foot]);
        numbers.extend(parts.iter().flat_map(|scale| [scale.length, scale.thickness]));
        numbers
    };
    let off =
        numbers(found).into_iter().zip(numbers(expected)).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    assert!(off < 1e-12, "{what}: {found:?} instead of {expected:?}");
}

fn length(scale: f64) -> GroupSettings {
    GroupSettings { length_scale: Some(scale), ..GroupSettings::default() }
}

fn thickness(scale: f64) -> GroupSettings {
    GroupSettings { thickness_scale: Some(scale), ..GroupSettings::default() }
}

#[test]
fn what_is_set_takes_the_place_of_what_was_found_and_of_nothing_else() {
    let was = scales();
    for (name, expected) in [
        ("neck", PartCoefficients { neck: scale(2.0, 0.75), ..was }),
        ("torso", PartCoefficients { torso: scale(2.0, 0.8), ..was }),
        ("shoulder", PartCoefficients { shoulder_spread: 2.0, ..was }),
        ("hip", PartCoefficients { hip_spread: 2.0, ..was }),
        ("upper_arm", PartCoefficients { upper_arm: scale(2.0, 0.45), ..was }),
        ("lower_arm", PartCoefficients { lower_arm: scale(2.0, 0.47), ..was }),
        ("upper_leg", PartCoefficients { upper_leg: scale(2.0, 0.35), ..was }),
        ("lower_leg", PartCoefficients { lower_leg: scale(2.0, 0.37), ..was }),
        ("hand", PartCoefficients { hand: 2.0, ..was }),
        ("finger", PartCoefficients { hand: 2.0, ..was }),
        ("foot", PartCoefficients { foot: 2.0, ..was }),
        ("head", PartCoefficients { head: HeadScale { height: 2.0, ..was.head }, ..was }),
    ] {
        assert_same(name, set(&[(name, length(2.0))]), expected);
    }
    assert_same(
        "torso",
        set(&[("torso", thickness(2.0))]),
        PartCoefficients { torso: scale(0.6, 2.0), ..was },
    );
    assert_same("foot", set(&[("foot", thickness(2.0))]), PartCoefficients { foot: 2.0, ..was });
}

#[test]
fn a_heads_width_and_depth_keep_their_ratio() {
    let head = set(&[("head", thickness(0.8))]).head;
    assert_eq!((head.height, head.width), (1.5, 0.8));
    assert!((head.depth - 0.6).abs() < 1e-12, "{head:?}");
}

#[test]
fn a_transfer_goes_so_much_of_the_way_from_one() {
    let half = GroupSettings {
        length_transfer: Some(0.5),
        thickness_transfer: Some(0.25),
        ..GroupSettings::default()
    };
    let upper_leg = set(&[("upper_leg", half)]).upper_leg;
    assert!((upper_leg.length - 0.65).abs() < 1e-12, "{upper_leg:?}");
    assert!((upper_leg.thickness - 0.8375).abs() < 1e-12, "{upper_leg:?}");
    let none = GroupSettings { length_transfer: Some(0.0), ..GroupSettings::default() };
    assert_eq!(set(&[("foot", none)]).foot, 1.0);
    // A scale that is set leaves nothing to transfer.
    let both = GroupSettings { length_transfer: Some(0.0), ..length(0.7) };
    assert_eq!(set(&[("upper_leg", both)]).upper_leg.length, 0.7);
}

#[test]
fn hands_and_fingers_are_one_part_and_the_hand_has_the_last_word() {
    assert_eq!(set(&[("hand", length(0.5)), ("finger", length(2.0))]).hand, 0.5);
}

#[test]
fn lengths_only_keeps_lengths_and_head() {
    let was = scales();
    let expected = PartCoefficients {
        neck: scale(0.5, 1.0),
        torso: scale(0.6, 1.0),
        shoulder_spread: 1.0,
        hip_spread: 1.0,
        upper_arm: scale(0.4, 1.0),
        lower_arm: scale(0.42, 1.0),
        upper_leg: scale(0.3, 1.0),
        lower_leg: scale(0.32, 1.0),
        ..was
    };
    assert_eq!(was.lengths_only(), expected);
}

#[test]
fn the_report_gives_the_mean_of_a_groups_parts() {
    use superdeform::Role::*;
    let groups = PartGroups::default();
    let found = scales().by_group(&groups);
    let coefficient =
        |length: f64, thickness: f64| Coefficient { length_scale: length, thickness_scale: thickness };
    assert_eq!(found.len(), 12);
    assert_eq!(found["upper_leg"], coefficient(0.3, 0.35));
    assert_eq!(found["head"], coefficient(1.5, 1.6));
    assert_eq!(found["shoulder"], coefficient(0.7, 0.8));
    assert_eq!(found["hip"], coefficient(0.65, 0.8));
    assert_eq!(found["finger"], coefficient(0.9, 0.9));
    let own = [LeftLowerLeg, RightLowerLeg, LeftFoot, RightFoot].map(|role| (role, "legs".to_string()));
    let all = superdeform::Role::all().collect();
    let (groups, _) = PartGroups::of(&all, &own.into_iter().collect());
    let legs = scales().by_group(&groups)["legs"];
    assert!(
        (legs.length_scale - 0.31).abs() < 1e-12 && (legs.thickness_scale - 0.36).abs() < 1e-12,
        "{legs:?}"
    );
}

#[test]
fn a_scale_that_is_no_number_is_refused_by_its_group() {
    assert_eq!(scales().validate(), Ok(()));
    for broken in [
        PartCoefficients { lower_leg: scale(f64::NAN, 1.0), ..scales() },
        PartCoefficients { lower_leg: scale(1.0, f64::INFINITY), ..scales() },
    ] {
        let error = broken.validate().unwrap_err();
        assert_eq!(error.kind, ErrorKind::NoGeometry);
        assert!(
            error.message.contains("lower_leg") || error.message.contains("lower leg"),
            "{}",
            error.message
        );
    }
}
