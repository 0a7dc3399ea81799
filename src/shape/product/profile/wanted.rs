//! Which profile a style wants, and how much of it the options take.

use super::canonical::{canonical, canonical_strength};
use super::measure::BodyFrame;
use super::{ARM_STATIONS, LEG_STATIONS, Profile, Strengths, stations};
use crate::character::bones::Group;
use crate::geometry::smoothstep;
use crate::options::{GroupSettings, Options};
use crate::shape::product::groups::PartGroups;
use crate::shape::style::Style;

/// A target this much taller than a style without a profile, in heads, takes all of the style's: what has so few heads already
/// keeps the body that its artist gave it.
const TALLER: f64 = 1.5;

/// The profile that `style` wants of a target of `heads` heads, and how much of it: all of a reference's, of a body of so many
/// heads what figures of that height have in common. `None` where the style says nothing of a body.
pub fn wanted_of(style: &Style, heads: f64) -> Option<(Profile, f64)> {
    let asked = match style {
        Style::Heads(asked) => *asked,
        Style::Shape(shape) => match &shape.profile {
            Some(profile) => return Some((profile.clone(), 1.0)),
            None => shape.heads()?,
        },
    };
    let taller = smoothstep((heads / asked - 1.0) / (TALLER - 1.0));
    Some((canonical(asked), canonical_strength(asked) * taller))
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
    let row = |ends: (f64, f64), middle: f64, upper: Group, lower: Group| {
        stations(ends).map(|t| thickness(if t < middle { upper } else { lower }))
    };
    Strengths {
        torso: thickness(Group::Torso),
        leg: row(LEG_STATIONS, frame.knee(), Group::UpperLeg, Group::LowerLeg),
        arm: row(ARM_STATIONS, frame.elbow(), Group::UpperArm, Group::LowerArm),
        hand: size(Group::Hand),
        foot: size(Group::Foot),
        neck: thickness(Group::Neck),
        spread: length(Group::Hip),
        arm_length: length(Group::UpperArm).min(length(Group::LowerArm)),
        is_limited: options.limits,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_small_already_keeps_its_body() {
        let style = Style::Heads(2.5);
        let share = |heads: f64| wanted_of(&style, heads).unwrap().1;
        assert_eq!((share(2.0), share(2.5), share(3.75), share(7.0)), (0.0, 0.0, 1.0, 1.0));
        assert!((share(3.125) - 0.5).abs() < 1e-12);
    }
}
