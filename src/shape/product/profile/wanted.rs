//! Which profile a style wants, and how much of it the options take.

use super::canonical::{canonical, canonical_strength};
use super::cuts::BodyFrame;
use super::{Profile, Strengths};
use crate::character::bones::Group;
use crate::options::{GroupSettings, Options, Stage};
use crate::shape::product::part_settings::PartGroups;
use crate::shape::style::Style;

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
