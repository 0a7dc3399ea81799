//! How much each of the fifteen parts shrinks (product mode): from proportions wanted to scales.
//!
//! Lengths are transferred as in §V-B3: all are measured in heads, so that with L' = `head_scale` L the result has the
//! reference's proportions. Widths are judged against the head's width, not its height. Bounds keep what the paper's
//! linear maps cannot carry (shins that fold into rings, hands larger than the face); every bound that acts is told.

use super::anatomy::Proportions;
use crate::character::bones::Group;
use crate::error::{Error, ErrorKind, Result, Warning};
use crate::options::{GroupSettings, Options, Stage};
use crate::shape::Coefficient;
use std::collections::BTreeMap;

/// The head grows this much more in width and depth than in height.
pub const HEAD_WIDTH: f64 = 1.12;
/// See [`HEAD_WIDTH`].
pub const HEAD_DEPTH: f64 = 1.05;
/// The neck keeps this much more girth than the trunk.
const NECK_GIRTH: f64 = 1.1;
/// `head_scale` at which the bounds act in full; at 1 they do not act at all.
const FULL_HEAD_SCALE: f64 = 1.5;
/// Length of the neck between these, in new heads.
const NECK: (f64, f64) = (0.03, 0.19);
/// The neck may grow this much more than the head.
const NECK_GROWTH: f64 = 1.5;
/// Length of the neck in a style for N heads, in new heads.
const NECK_FOR_HEADS: (f64, f64) = (0.05, 0.14);
/// How far head widths may differ before girths stop following.
const GIRTH_PER_HEAD_WIDTH: (f64, f64) = (0.6, 1.25);
/// No part may become this many times stubbier.
const STUBBIEST: f64 = 2.6;
/// No limb may become shorter than this part of itself.
const SHORTEST_LIMB: f64 = 0.18;
/// Arms (legs) may be this much slimmer than the trunk.
const ARM_SLIMMEST: f64 = 1.2;
const LEG_SLIMMEST: f64 = 1.38;
/// Limbs may be this much thicker than the trunk.
const LIMB_THICKEST: f64 = 1.2;
/// The two segments of a limb stay within this of their geometric mean.
const SEGMENT_SPREAD: f64 = 1.15;
/// Hands (feet) against the lower arm's (leg's) girth.
const HAND_PER_ARM: (f64, f64) = (0.9, 1.35);
const FOOT_PER_LEG: (f64, f64) = (1.0, 1.4);
/// Longest hand and foot, in new heads.
const LONGEST_HAND: f64 = 0.34;
const LONGEST_FOOT: f64 = 0.6;
/// Where the legs cannot be as short as the reference's, the torso makes up for it, down to this part of its own.
const TORSO_AFTER_LEGS: f64 = 0.8;
/// A style for N heads: torso and arms shrink this much less than the whole, girths by this factor of the root.
const TORSO_FOR_HEADS: f64 = 1.1;
const ARM_FOR_HEADS: f64 = 1.05;
const GIRTH_FOR_HEADS: f64 = 0.78;

/// The scales of all parts; 1 leaves a part as it is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PartCoefficients {
    /// Head: height, width, depth.
    pub head: [f64; 3],
    /// How much of the way the head moves back over the chest, 0 to 1.
    pub head_seat: f64,
    /// Neck: length, girth.
    pub neck: [f64; 2],
    /// Trunk: length, girth.
    pub trunk: [f64; 2],
    /// How far the shoulder joints (hip joints) stand from the middle.
    pub shoulder_spread: f64,
    /// See `shoulder_spread`.
    pub hip_spread: f64,
    /// Length and girth of upper arm, lower arm, upper leg, lower leg.
    pub limbs: [[f64; 2]; 4],
    /// Size of the hands.
    pub hand: f64,
    /// Size of the feet.
    pub foot: f64,
}

impl PartCoefficients {
    /// Leaves everything as it is.
    pub const IDENTITY: Self = Self {
        head: [1.0; 3],
        head_seat: 0.0,
        neck: [1.0; 2],
        trunk: [1.0; 2],
        shoulder_spread: 1.0,
        hip_spread: 1.0,
        limbs: [[1.0; 2]; 4],
        hand: 1.0,
        foot: 1.0,
    };

    /// By bone group, for the report.
    pub fn by_group(&self) -> BTreeMap<String, Coefficient> {
        let group = |name: &str, [length_scale, thickness_scale]: [f64; 2]| {
            (name.to_string(), Coefficient { length_scale, thickness_scale })
        };
        BTreeMap::from([
            group("head", [self.head[0], self.head[1]]),
            group("neck", self.neck),
            group("torso", self.trunk),
            group("shoulder", [self.shoulder_spread, self.trunk[1]]),
            group("upper_arm", self.limbs[0]),
            group("lower_arm", self.limbs[1]),
            group("hand", [self.hand; 2]),
            group("finger", [self.hand; 2]),
            group("hip", [self.hip_spread, self.trunk[1]]),
            group("upper_leg", self.limbs[2]),
            group("lower_leg", self.limbs[3]),
            group("foot", [self.foot; 2]),
        ])
    }
}

/// What the result should be like.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Wanted<'a> {
    /// Like a reference.
    Reference(&'a Proportions),
    /// So many heads tall, everything else after the target.
    Heads(f64),
}

/// Bounds that acted: what was bounded, from which value, to which.
struct Bounds {
    strictness: f64,
    acted: Vec<(&'static str, f64, f64)>,
}

impl Bounds {
    fn apply(&mut self, what: &'static str, value: f64, low: f64, high: f64) -> f64 {
        let bounded = value + self.strictness * (value.max(low).min(high.max(low)) - value);
        if (bounded - value).abs() > 1e-3 * value.abs() {
            // Two bounds on one thing are told as one.
            match self.acted.iter_mut().find(|(known, _, _)| *known == what) {
                Some((_, _, to)) => *to = bounded,
                None => self.acted.push((what, value, bounded)),
            }
        }
        bounded
    }
}

/// The scales that make `target` like `wanted`, and warnings that name every bound that acted.
///
/// # Errors
/// `ErrorKind::BadOption` for an unknown group, or for a group of no extent.
pub fn part_coefficients(
    target: &Proportions,
    wanted: Wanted,
    options: &Options,
) -> Result<(PartCoefficients, Vec<Warning>)> {
    let head_scale = options.head_scale;
    let growth = ((head_scale - 1.0) / (FULL_HEAD_SCALE - 1.0)).clamp(0.0, 1.0);
    let width_factor = 1.0 + (HEAD_WIDTH - 1.0) * growth;
    let depth_factor = 1.0 + (HEAD_DEPTH - 1.0) * growth;
    let neck_girth = 1.0 + (NECK_GIRTH - 1.0) * growth;
    let strictness = if options.limits { growth } else { 0.0 };
    let mut bounds = Bounds { strictness, acted: Vec::new() };
    let head = head_scale * target.head_length;

    // Everything in new heads, and girths as absolute scales.
    let (neck, torso, arm, leg, hand, foot, girths);
    match wanted {
        Wanted::Reference(reference) => {
            let unit = head / reference.head_length;
            let head_widths = (width_factor * target.head_half_width / target.head_length)
                / (reference.head_half_width / reference.head_length);
            let thinness = bounds.apply("girth", head_widths, GIRTH_PER_HEAD_WIDTH.0, GIRTH_PER_HEAD_WIDTH.1);
            // Judging girth against head width is no bound worth telling a person.
            bounds.acted.clear();
            let girth = |ours: Option<f64>, theirs: Option<f64>| match (ours, theirs) {
                (Some(ours), Some(theirs)) => Some(theirs * unit * thinness / ours),
                _ => None,
            };
            neck = reference.neck * unit;
            torso = reference.torso * unit;
            arm = reference.arm * unit;
            leg = reference.leg * unit;
            hand = reference.hand.map(|hand| hand * unit);
            foot = reference.foot.map(|foot| foot * unit);
            girths = [
                girth(target.trunk_half_width, reference.trunk_half_width),
                girth(target.upper_arm_radius, reference.upper_arm_radius),
                girth(target.lower_arm_radius, reference.lower_arm_radius),
                girth(target.upper_leg_radius, reference.upper_leg_radius),
                girth(target.lower_leg_radius, reference.lower_leg_radius),
            ];
        }
        Wanted::Heads(heads) => {
            let below = target.neck + target.torso + target.leg;
            let shrink = (heads - 1.0) * target.head_length / below;
            neck = (shrink * target.neck * head_scale)
                .clamp(NECK_FOR_HEADS.0 * head, NECK_FOR_HEADS.1 * head)
                .min(0.3 * (heads - 1.0) * head);
            torso = TORSO_FOR_HEADS * shrink * head_scale * target.torso;
            arm = ARM_FOR_HEADS * shrink * head_scale * target.arm;
            leg = (heads - 1.0) * head - neck - torso;
            hand = None;
            foot = None;
            girths = [Some(GIRTH_FOR_HEADS * shrink.sqrt() * head_scale); 5];
        }
    }

    let below = neck + torso + leg;
    let mut result = PartCoefficients::IDENTITY;
    result.head = [head_scale, width_factor * head_scale, depth_factor * head_scale];
    result.head_seat = growth;

    // The neck.
    let longest = (NECK_GROWTH * target.neck / target.head_length).clamp(NECK.0, NECK.1);
    let neck = bounds.apply("neck", neck / head, NECK.0, longest) * head;
    result.neck[0] = neck / target.neck.max(1e-6 * target.head_length);
    // What the neck may not take, torso and legs do, so that the number of heads stays.
    let rest = (below - neck) / (torso + leg);
    let (torso, leg) = (torso * rest, leg * rest);

    // The trunk.
    // Nothing grows more than the head: a body that is as stubby as the style, or stubbier, keeps its proportions.
    let length = bounds.apply("torso length", torso / target.torso, 0.0, head_scale);
    let girth = girths[0].unwrap_or(length.sqrt());
    let girth = bounds.apply("torso thickness", girth, 0.9 * length, 1.0f64.max(0.9 * length));
    result.trunk = [bounds.apply("torso length", length, girth / STUBBIEST, f64::INFINITY), girth];
    result.neck[1] = neck_girth * girth;
    let trunk_girth = result.trunk[1];
    result.shoulder_spread = trunk_girth;
    result.hip_spread = trunk_girth;

    // The arms.
    let thickest = (LIMB_THICKEST * trunk_girth).min(trunk_girth.max(0.95));
    let names = ["upper_arm thickness", "lower_arm thickness", "upper_leg thickness", "lower_leg thickness"];
    for (limb, slimmest) in [(0, ARM_SLIMMEST), (2, LEG_SLIMMEST)] {
        let mut pair = [0, 1].map(|segment| {
            let girth = girths[1 + limb + segment].unwrap_or(trunk_girth);
            bounds.apply(names[limb + segment], girth, trunk_girth / slimmest, thickest)
        });
        let mean = (pair[0] * pair[1]).sqrt();
        for (segment, girth) in pair.iter_mut().enumerate() {
            *girth =
                bounds.apply(names[limb + segment], *girth, mean / SEGMENT_SPREAD, mean * SEGMENT_SPREAD);
            result.limbs[limb + segment][1] = *girth;
        }
    }
    let stubbiest = |limb: usize, result: &PartCoefficients| {
        (result.limbs[limb][1].max(result.limbs[limb + 1][1]) / STUBBIEST).max(SHORTEST_LIMB)
    };
    let length = bounds.apply("arm length", arm / target.arm, stubbiest(0, &result), head_scale);
    result.limbs[0][0] = length;
    result.limbs[1][0] = length;

    // Hands and feet.
    let size = match (hand, target.hand) {
        (Some(wanted), Some(own)) => wanted / own,
        _ => (1.0 + 0.1 * growth) * result.limbs[1][1],
    };
    let girth = result.limbs[1][1];
    let size = bounds.apply("hand", size, HAND_PER_ARM.0 * girth, (HAND_PER_ARM.1 * girth).min(head_scale));
    result.hand = match target.hand {
        Some(own) => bounds.apply("hand", size, 0.0, LONGEST_HAND * head / own),
        None => size,
    };
    let size = match (foot, target.foot) {
        (Some(wanted), Some(own)) => wanted / own,
        _ => (1.0 + 0.2 * growth) * result.limbs[3][1],
    };
    let girth = result.limbs[3][1];
    let size = bounds.apply("foot", size, FOOT_PER_LEG.0 * girth, (FOOT_PER_LEG.1 * girth).min(head_scale));
    result.foot = match target.foot {
        Some(own) => bounds.apply("foot", size, 0.0, LONGEST_FOOT * head / own),
        None => size,
    };

    // The legs: what the foot takes up is no longer the leg's. A foot that would leave the leg no length is
    // made smaller first.
    let shank = (target.leg - target.ankle_height).max(0.05 * target.leg);
    if target.ankle_height > 0.0 {
        let room = (leg - SHORTEST_LIMB * shank).max(0.35 * leg);
        result.foot = bounds.apply("foot", result.foot, 0.0, room / target.ankle_height);
    }
    let leg_length = |foot: f64| (leg - target.ankle_height * foot) / shank;
    let mut length = leg_length(result.foot);
    if let Wanted::Heads(_) = wanted {
        // The total is what was asked for: slimmer legs may be shorter before the bound on stubbiness acts.
        let slimmest = trunk_girth / LEG_SLIMMEST;
        for limb in [2, 3] {
            let girth = result.limbs[limb][1];
            result.limbs[limb][1] = girth.min((STUBBIEST * length).max(slimmest.min(girth)));
        }
    }
    length = bounds.apply("leg length", length, stubbiest(2, &result), head_scale);
    // What the legs could not give, the torso gives: all of it where a number of heads is asked for.
    let excess = length * shank + target.ankle_height * result.foot - leg;
    if excess > 1e-6 * leg {
        let shortest = match wanted {
            Wanted::Heads(_) => 0.0,
            Wanted::Reference(_) => TORSO_AFTER_LEGS * result.trunk[0],
        };
        let torso = (result.trunk[0] - strictness * excess / target.torso).max(shortest);
        result.trunk[0] = bounds.apply("torso length", torso, trunk_girth / STUBBIEST, f64::INFINITY);
    }
    result.limbs[2][0] = length;
    result.limbs[3][0] = length;

    apply_settings(&mut result, &options.groups)?;
    if options.stage == Stage::Length {
        result.trunk[1] = 1.0;
        result.neck[1] = 1.0;
        result.shoulder_spread = 1.0;
        result.hip_spread = 1.0;
        result.limbs.iter_mut().for_each(|limb| limb[1] = 1.0);
    }
    let scales = result.by_group();
    if let Some((name, scale)) = scales
        .iter()
        .find(|(_, scale)| !(scale.length_scale.is_finite() && scale.thickness_scale.is_finite()))
    {
        return Err(Error::new(
            ErrorKind::NoGeometry,
            format!(
                "no scale can be found for the group {name} ({} and {} came out): check that the joints of both \
                 characters lie inside their meshes and not on one another",
                scale.length_scale, scale.thickness_scale
            ),
        ));
    }
    Ok((result, warnings(target, wanted, &result, head, &bounds)))
}

/// How many heads tall a figure of proportions `target` becomes.
pub fn heads_of(target: &Proportions, coefficients: &PartCoefficients) -> f64 {
    let head = coefficients.head[0] * target.head_length;
    1.0 + (coefficients.neck[0] * target.neck
        + coefficients.trunk[0] * target.torso
        + coefficients.limbs[3][0] * (target.leg - target.ankle_height)
        + coefficients.foot * target.ankle_height)
        / head
}

fn warnings(
    target: &Proportions,
    wanted: Wanted,
    result: &PartCoefficients,
    head: f64,
    bounds: &Bounds,
) -> Vec<Warning> {
    let mut warnings = Vec::new();
    let lengths = ["neck", "torso length", "leg length", "foot"];
    let list = |acted: &[&(&'static str, f64, f64)]| {
        let items: Vec<String> =
            acted.iter().map(|(what, from, to)| format!("{what} {from:.3} to {to:.3}")).collect();
        items.join(", ")
    };
    let asked = match wanted {
        Wanted::Heads(heads) => heads,
        Wanted::Reference(reference) => {
            1.0 + (reference.neck + reference.torso + reference.leg) / reference.head_length
        }
    };
    let got = heads_of(target, result);
    let _ = head;
    let of_height: Vec<_> = bounds.acted.iter().filter(|(what, _, _)| lengths.contains(what)).collect();
    if (got / asked - 1.0).abs() > 0.005 && !of_height.is_empty() {
        warnings.push(Warning::new(
            "heads_limited",
            format!("{got:.2} heads instead of {asked:.2}: limited {}", list(&of_height)),
        ));
    }
    if !bounds.acted.is_empty() {
        warnings.push(Warning::new(
            "coefficient_limited",
            format!("limited to keep the shape sound: {}", list(&bounds.acted.iter().collect::<Vec<_>>())),
        ));
    }
    warnings
}

/// Puts a user's settings in place of what was found.
fn apply_settings(result: &mut PartCoefficients, groups: &BTreeMap<String, GroupSettings>) -> Result<()> {
    let blend = |found: f64, set: Option<f64>, transfer: Option<f64>| {
        set.unwrap_or_else(|| 1.0 + transfer.unwrap_or(1.0) * (found - 1.0))
    };
    for (name, settings) in groups {
        let pair = |found: [f64; 2]| {
            [
                blend(found[0], settings.length_scale, settings.length_transfer),
                blend(found[1], settings.thickness_scale, settings.thickness_transfer),
            ]
        };
        let size = |found: f64| {
            let set = settings.length_scale.or(settings.thickness_scale);
            blend(found, set, settings.length_transfer.or(settings.thickness_transfer))
        };
        match name.as_str() {
            "head" => {
                let [height, width] = pair([result.head[0], result.head[1]]);
                result.head[2] *= width / result.head[1];
                result.head[0] = height;
                result.head[1] = width;
            }
            "neck" => result.neck = pair(result.neck),
            "torso" => result.trunk = pair(result.trunk),
            "shoulder" => result.shoulder_spread = pair([result.shoulder_spread, 1.0])[0],
            "hip" => result.hip_spread = pair([result.hip_spread, 1.0])[0],
            "upper_arm" => result.limbs[0] = pair(result.limbs[0]),
            "lower_arm" => result.limbs[1] = pair(result.limbs[1]),
            "upper_leg" => result.limbs[2] = pair(result.limbs[2]),
            "lower_leg" => result.limbs[3] = pair(result.limbs[3]),
            "hand" | "finger" => result.hand = size(result.hand),
            "foot" => result.foot = size(result.foot),
            unknown => {
                return Err(Error::new(
                    ErrorKind::BadOption,
                    format!(
                        "there is no bone group {unknown}: name one of {}",
                        Group::ALL.map(Group::name).join(", ")
                    ),
                ));
            }
        }
    }
    Ok(())
}
