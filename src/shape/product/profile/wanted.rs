//! Which profile a style wants, and how much of it the options take: a reference's, or, where there is none, what a body of so
//! many heads is like: a chibi's, not a small adult's.

use super::curve::monotone_cubic;
use super::cuts::BodyFrame;
use super::{
    ARM_STATIONS, ArmProfile, LEG_STATIONS, LegProfile, Profile, Row, STATIONS, Strengths, TORSO_STATIONS,
    TorsoProfile, stations,
};
use crate::character::bones::Group;
use crate::geometry::smoothstep;
use crate::options::{GroupSettings, Options, Stage};
use crate::shape::product::part_settings::PartGroups;
use crate::shape::style::Style;

/// Up to so many heads a style's profile is taken in full; towards the second number less of it, and from the third on none:
/// a slim man stays slimmer than a stout one.
///
/// Up to 3.4: bodies of 2.5 heads at less than full strength are lollipops. From 4.5 on .7 of the way, as artists' figures of
/// that height differ among themselves.
const STRENGTH: [(f64, f64); 3] = [(2.5, 1.0), (3.4, 0.7), (4.5, 0.7)];
const NONE_FROM: f64 = 7.0;

/// A body by hand: five knots a row.
struct Known {
    heads: f64,
    torso: [[f64; 5]; 3],
    leg_outward: f64,
    leg: [f64; 5],
    arm: [f64; 5],
    hand: [f64; 3],
    foot: [f64; 5],
    /// Neck, shoulder, length of the arm.
    lengths: [f64; 3],
}

/// Bodies without tunics and shorts: of 2.2 heads after KayKit's adventurers (rogue, barbarian), but that a trunk goes over into
/// its legs, where theirs stands on two posts, and narrows to the shoulders, and that feet fill trousers' cuffs; of 4.5 after
/// MakeHuman's baby, and between Godette and the baby; smoothed by hand. In head lengths.
const KNOWN: [Known; 3] = [
    Known {
        heads: 2.2,
        torso: [
            [0.345, 0.375, 0.37, 0.335, 0.28],
            [0.22, 0.28, 0.305, 0.285, 0.25],
            [0.0, 0.015, 0.025, 0.02, 0.01],
        ],
        leg_outward: 0.18,
        leg: [0.14, 0.132, 0.124, 0.115, 0.115],
        arm: [0.12, 0.112, 0.105, 0.108, 0.112],
        hand: [0.19, 0.115, 0.105],
        foot: [0.29, 0.12, 0.135, 0.18, 0.16],
        lengths: [0.14, 0.21, 0.56],
    },
    Known {
        heads: 3.4,
        torso: [
            [0.45, 0.43, 0.40, 0.37, 0.34],
            [0.31, 0.32, 0.31, 0.29, 0.27],
            [0.02, 0.05, 0.08, 0.07, 0.04],
        ],
        leg_outward: 0.25,
        leg: [0.17, 0.15, 0.135, 0.125, 0.115],
        arm: [0.13, 0.115, 0.10, 0.095, 0.085],
        hand: [0.35, 0.125, 0.09],
        foot: [0.39, 0.12, 0.115, 0.30, 0.155],
        lengths: [0.14, 0.32, 0.90],
    },
    Known {
        heads: 4.5,
        torso: [
            [0.52, 0.48, 0.46, 0.45, 0.44],
            [0.33, 0.37, 0.38, 0.36, 0.34],
            [0.04, 0.07, 0.10, 0.08, 0.04],
        ],
        leg_outward: 0.30,
        leg: [0.24, 0.21, 0.18, 0.15, 0.11],
        arm: [0.17, 0.16, 0.14, 0.12, 0.09],
        hand: [0.48, 0.165, 0.105],
        foot: [0.49, 0.15, 0.135, 0.40, 0.133],
        lengths: [0.15, 0.45, 1.33],
    },
];

/// How a body without shorts and tunic widens towards the crotch, from the middle slices of trunk and leg to those next to it, and how
/// far its trunk stands off its legs there: across, forward.
pub(super) struct Bare {
    pub torso_flares: [f64; 2],
    pub leg_flare: f64,
    pub steps: [f64; 2],
}

/// That of 3.4 heads is one.
pub(super) const BARE: Bare = {
    let Known { torso: [breadth, depth, _], leg_outward, leg, .. } = KNOWN[1];
    Bare {
        torso_flares: [breadth[0] / breadth[2], depth[0] / depth[2]],
        leg_flare: leg[0] / leg[2],
        steps: [breadth[0] / (leg_outward + leg[0]), depth[0] / leg[0]],
    }
};

/// The profile that `style` and `options` ask for, and how much of it; `None` where they ask for none.
///
/// `lost`: how much of the style the target takes.
pub fn profile_of(style: &Style, options: &Options, lost: f64) -> Option<(Profile, f64)> {
    let (wanted, share) = wanted_of(style)?;
    let share = share * lost * options.profile;
    (share > 0.0 && options.stage != Stage::Length).then_some((wanted, share))
}

/// The profile that `style` wants, and how much of it: all of a reference's, of a body of so many heads what figures of that
/// height have in common. `None` where the style says nothing of a body.
pub fn wanted_of(style: &Style) -> Option<(Profile, f64)> {
    let asked = match style {
        Style::Heads(asked) => *asked,
        Style::Shape(shape) => match &shape.profile {
            Some(profile) => return Some((profile.clone(), 1.0)),
            None => shape.heads()?,
        },
    };
    Some((canonical(asked), canonical_strength(asked)))
}

/// How much of the wanted profile each chain takes: `share` of it, what a group's `thickness_transfer` says of that, and
/// nothing where a thickness is set.
pub fn strengths(share: f64, options: &Options, groups: &PartGroups, frame: &BodyFrame) -> Strengths {
    let settings = |kind: Group| options.groups.get(groups.name(kind)).copied().unwrap_or_default();
    let part = |set: Option<f64>, transfer: Option<f64>| match set {
        Some(_) => 0.0,
        None => share * transfer.unwrap_or(1.0),
    };
    let thickness = |kind: Group| {
        let GroupSettings { thickness_scale, thickness_transfer, .. } = settings(kind);
        part(thickness_scale, thickness_transfer)
    };
    let length = |kind: Group| {
        let GroupSettings { length_scale, length_transfer, .. } = settings(kind);
        part(length_scale, length_transfer)
    };
    // Hands and feet are one size: one setting is for all of it.
    let size = |kind: Group| {
        let it = settings(kind);
        part(it.length_scale.or(it.thickness_scale), it.length_transfer.or(it.thickness_transfer))
    };
    Strengths {
        torso: thickness(Group::Torso),
        leg: frame.leg_row([Group::UpperLeg, Group::LowerLeg].map(thickness)),
        arm: frame.arm_row([Group::UpperArm, Group::LowerArm].map(thickness)),
        hand: size(Group::Hand),
        foot: size(Group::Foot),
        neck: thickness(Group::Neck),
        spread: length(Group::Hip),
        arm_length: length(Group::UpperArm).min(length(Group::LowerArm)),
        is_limited: options.limits,
    }
}

/// The profile of a body of `heads` heads; one of fewer than all that are known is the first of them, smaller under its head.
pub fn canonical(heads: f64) -> Profile {
    let at = KNOWN.iter().rposition(|known| known.heads <= heads).unwrap_or(0).min(KNOWN.len() - 2);
    let (low, high) = (&KNOWN[at], &KNOWN[at + 1]);
    let t = ((heads - low.heads) / (high.heads - low.heads)).clamp(0.0, 1.0);
    // All of it is as much smaller as what is left below the head.
    let mix = |a: f64, b: f64| ((heads - 1.0) / (low.heads - 1.0)).min(1.0) * (a + t * (b - a));
    let row = |ends: (f64, f64), read: &dyn Fn(&Known) -> [f64; 5]| -> Row {
        let places: [f64; 5] = std::array::from_fn(|knot| ends.0 + (ends.1 - ends.0) * knot as f64 / 4.0);
        let (a, b) = (read(low), read(high));
        let knots: [f64; 5] = std::array::from_fn(|knot| mix(a[knot], b[knot]));
        stations(ends).map(|t| monotone_cubic(&places, &knots, t))
    };
    let torso = |which: usize| row(TORSO_STATIONS, &|known| known.torso[which]);
    let leg = row(LEG_STATIONS, &|known| known.leg);
    let arm = row(ARM_STATIONS, &|known| known.arm);
    Profile {
        torso: Some(TorsoProfile { breadth: torso(0), depth: torso(1), forward: torso(2) }),
        leg: Some(LegProfile {
            outward: [mix(low.leg_outward, high.leg_outward); STATIONS],
            breadth: leg,
            depth: leg,
            forward: [0.0; STATIONS],
        }),
        arm: Some(ArmProfile { breadth: arm, depth: arm }),
        skirt: None,
        hand: Some(std::array::from_fn(|which| mix(low.hand[which], high.hand[which]))),
        foot: Some(std::array::from_fn(|which| mix(low.foot[which], high.foot[which]))),
        neck: Some(mix(low.lengths[0], high.lengths[0])),
        shoulder: mix(low.lengths[1], high.lengths[1]),
        arm_length: mix(low.lengths[2], high.lengths[2]),
    }
}

/// How much of [`canonical`] a style of `heads` heads takes.
pub fn canonical_strength(heads: f64) -> f64 {
    let [(_, _), (_, _), (last, least)] = STRENGTH;
    if heads > last {
        return least * (1.0 - smoothstep((heads - last) / (NONE_FROM - last)));
    }
    let places = STRENGTH.map(|(heads, _)| heads);
    monotone_cubic(&places, &STRENGTH.map(|(_, strength)| strength), heads)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn known_bodies_are_met_and_between_them_all_is_between_and_below_them_smaller() {
        let bottom = |heads: f64| canonical(heads).torso.unwrap().breadth[0];
        assert_eq!((bottom(2.2), bottom(4.5), bottom(9.0)), (0.345, 0.52, 0.52));
        assert!((bottom(2.8) - 0.3975).abs() < 1e-12);
        // Half as much below the head.
        assert!((bottom(1.6) - 0.1725).abs() < 1e-12);
        let hand = canonical(3.95).hand.unwrap();
        assert!((hand[0] - 0.415).abs() < 1e-12, "{hand:?}");
    }

    #[test]
    fn small_figures_take_all_of_it_and_adults_nothing() {
        assert_eq!(canonical_strength(1.8), 1.0);
        assert_eq!(canonical_strength(2.5), 1.0);
        assert!((canonical_strength(4.0) - 0.7).abs() < 1e-12);
        assert_eq!(canonical_strength(7.0), 0.0);
    }
}
