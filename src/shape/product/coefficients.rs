//! How much each part shrinks (product mode): from proportions to scales.
//!
//! Lengths are transferred as in §V-B3: all are measured in heads, so that with L' = `head_scale` L the result has the
//! reference's proportions. Every part has one thickness, from which the profile's slices go on. Bounds keep what the paper's
//! linear maps cannot carry (limbs that are stubs, feet larger than the leg); every bound on a length that acts is warned of.

use super::anatomy::Proportions;
use super::part_settings::PartGroups;
use super::scales::{HeadScale, PartCoefficients, Scale};
use crate::error::{Result, Warning};
use crate::face::rows::{CHILD_SKULL, CHILD_SKULL_DEPTH};
use crate::geometry::ROUNDING;
use crate::options::table::HEAD_SCALE;
use crate::options::{Options, Stage};

/// A target that has this much more heads than the style, as a share of the style's, takes all of it; one that has as few or
/// fewer has nothing to lose, and keeps the body that its artist gave it.
const HEADS_LOST: f64 = 0.2;
/// The head grows at most this much more in width than in height: as far as the style's head is wider. D28. Seen: even so
/// heads are .76 as wide, by their height, as the KayKit rogue's; less turns fewer triangles over.
pub const HEAD_WIDTH: f64 = 1.12;
/// As [`HEAD_WIDTH`], in depth; a style that does not know its depth gets all of it. D28. Seen: 30 % more folds collars
/// (228 triangles).
pub const HEAD_DEPTH: f64 = 1.05;
/// `head_scale` at which the bounds act in full; at 1 they do not act at all. Paper, V-B1: alpha_head; D27.
const FULL_HEAD_SCALE: f64 = HEAD_SCALE;
/// Length of the neck between these, in new heads. D27. Seen: references have .14 to .16; the upper one cuts a baby's
/// .28, which makes necks .039 H longer; the lower never acts.
const NECK: (f64, f64) = (0.03, 0.19);
/// The neck may grow this much more than the head. D27, for targets without a neck. Seen: 30 % less acts on one of 14.
const NECK_GROWTH: f64 = 1.5;
/// No limb may become shorter than this share of itself: less is a stub that nothing bends in. D27. Seen: acts on the legs of
/// six of seven adults made like the KayKit rogue, whose legs are .15 to .22 of theirs.
const SHORTEST_LIMB: f64 = 0.22;
/// The foot may take at least this share of the new leg's height. D27. Seen: acts on 5 of 14 with KayKit; without it
/// feet get up to .034 H smaller.
const ROOM_FOR_FOOT: f64 = 0.35;
/// In a style for N heads torso and arms shrink this much less than the whole. D27, found by looking. Seen: 30 % move the
/// crotch by .11 H.
const TRUNK_FOR_HEADS: f64 = 1.1;
/// A bound that changes a value by less than this share of it is not warned of: no eye sees it.
const BOUND_WARNED_ABOVE: f64 = 1e-3;
/// A number of heads that misses by less than this is not warned of: no eye sees it.
const HEADS_WARNED_ABOVE: f64 = 0.005;

/// How much of a style a figure of `before` heads takes that gets `after`: see `HEADS_LOST`.
pub fn lost(before: f64, after: f64) -> f64 {
    ((before / after - 1.0) / HEADS_LOST).clamp(0.0, 1.0)
}

/// What the result should be like.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Goal<'a> {
    /// Like a reference.
    Reference(&'a Proportions),
    /// So many heads tall, everything else after the target.
    Heads(f64),
    /// Limbs like a reference's, on a head and a trunk that are one and stay as they are.
    Limbs(&'a Proportions),
}

impl<'a> Goal<'a> {
    /// How many heads tall the result should be.
    pub fn heads(&self) -> f64 {
        match self {
            Goal::Heads(heads) => *heads,
            Goal::Reference(reference) | Goal::Limbs(reference) => reference.heads(),
        }
    }

    /// What it should be like.
    fn reference(&self) -> Option<&'a Proportions> {
        match self {
            Goal::Heads(_) => None,
            Goal::Reference(reference) | Goal::Limbs(reference) => Some(reference),
        }
    }
}

/// A bound that acted: on what, from which value, to which.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Bounded {
    what: &'static str,
    from: f64,
    to: f64,
}

impl Bounded {
    /// True for lengths that make a figure taller or shorter.
    fn is_of_height(&self) -> bool {
        ["neck", "torso length", "leg length", "foot"].contains(&self.what)
    }
}

/// The bounds, and those that acted.
struct Bounds {
    /// 0 leaves every value, 1 enforces every bound.
    strictness: f64,
    acted: Vec<Bounded>,
}

impl Bounds {
    /// `value` within `low` and `high`, without a word: for what slices go on from.
    fn within(&self, value: f64, low: f64, high: f64) -> f64 {
        value + self.strictness * (value.max(low).min(high.max(low)) - value)
    }

    fn apply(&mut self, what: &'static str, value: f64, low: f64, high: f64) -> f64 {
        let bounded = self.within(value, low, high);
        if (bounded - value).abs() > BOUND_WARNED_ABOVE * value.abs() {
            self.acted.push(Bounded { what, from: value, to: bounded });
        }
        bounded
    }
}

/// What the goal asks for: lengths in the target's units, thicknesses as scales; `None` where it does not say.
struct Asked {
    neck: f64,
    torso: f64,
    arm: f64,
    leg: f64,
    hand: Option<f64>,
    foot: Option<f64>,
}

impl Asked {
    /// The proportions of `reference`, for a head of length `head`.
    fn of_reference(reference: &Proportions, head: f64) -> Self {
        let unit = head / reference.head_length;
        Self {
            neck: reference.neck * unit,
            torso: reference.torso * unit,
            arm: reference.arm * unit,
            leg: reference.leg * unit,
            hand: reference.hand.map(|hand| hand * unit),
            foot: reference.foot.map(|foot| foot * unit),
        }
    }

    /// So many heads of length `head`, the rest after the target, but that torso and arms are `trunk` times as long.
    fn of_heads(target: &Proportions, heads: f64, head: f64, trunk: f64) -> Self {
        let below = (heads - 1.0) * head;
        let shrink = below / (target.neck + target.torso + target.leg);
        let (neck, torso) = (shrink * target.neck, trunk * shrink * target.torso);
        Self {
            neck,
            torso,
            arm: trunk * shrink * target.arm,
            leg: below - neck - torso,
            hand: None,
            foot: None,
        }
    }

    /// Lengths from these (0) to those of `style` (1), and what else the style says.
    fn towards(self, style: Self, share: f64) -> Self {
        let mix = |own: f64, style: f64| own + share * (style - own);
        Self {
            neck: mix(self.neck, style.neck),
            torso: mix(self.torso, style.torso),
            arm: mix(self.arm, style.arm),
            leg: mix(self.leg, style.leg),
            ..style
        }
    }
}

/// The bounds that acted on [`part_coefficients`], and the number of heads that came out beside the one asked for.
#[derive(Clone, Debug, PartialEq)]
pub struct Limits {
    acted: Vec<Bounded>,
    /// How many heads tall the figure becomes, by the lengths of its parts.
    pub heads: f64,
    asked: f64,
}

impl Limits {
    /// True where bounds keep the figure from the number of heads.
    pub fn act_on_heads(&self) -> bool {
        (self.heads / self.asked - 1.0).abs() > HEADS_WARNED_ABOVE
            && self.acted.iter().any(Bounded::is_of_height)
    }

    /// Warnings that name every bound that acted: `heads_limited`, `coefficient_limited`.
    ///
    /// `heads`, `asked`: the head count that came out, and the one wanted.
    pub fn warnings(&self, heads: f64, asked: f64) -> Vec<Warning> {
        let list = |chosen: &dyn Fn(&Bounded) -> bool| {
            let chosen = self.acted.iter().filter(|bounded| chosen(bounded));
            let item = |Bounded { what, from, to }: &Bounded| format!("{what} {from:.3} to {to:.3}");
            chosen.map(item).collect::<Vec<_>>().join(", ")
        };
        let mut warnings = Vec::new();
        if self.act_on_heads() && (heads / asked - 1.0).abs() > HEADS_WARNED_ABOVE {
            let of_height = list(&Bounded::is_of_height);
            let message = format!("{heads:.2} heads instead of {asked:.2}: limited {of_height}");
            warnings.push(Warning::new("heads_limited", message));
        }
        if !self.acted.is_empty() {
            let message = format!("limited to keep the shape sound: {}", list(&|_| true));
            warnings.push(Warning::new("coefficient_limited", message));
        }
        warnings
    }
}

/// The scales that make `target` like `goal`, and the bounds that acted.
///
/// - `lost`: how much of the goal the target takes, 0 for its number of heads alone to 1.
/// - `sliced`: how much of the legs' thickness slices give them, 0 to 1.
/// - `groups`: which group's settings each part follows.
///
/// # Errors
/// `ErrorKind::BadOption` for an unknown group; `NoGeometry` for a group of no extent.
pub fn part_coefficients(
    target: &Proportions,
    goal: Goal,
    lost: f64,
    sliced: f64,
    options: &Options,
    groups: &PartGroups,
) -> Result<(PartCoefficients, Limits)> {
    let (mut scales, acted) = match goal {
        Goal::Limbs(reference) => (short_limbs(target, reference), Vec::new()),
        Goal::Reference(_) | Goal::Heads(_) => Solver::new(target, goal, lost, options).solved(sliced),
    };
    scales.apply_settings(&options.groups, groups)?;
    if options.stage == Stage::Length {
        scales = scales.lengths_only();
    }
    scales.validate()?;
    let limits = Limits { acted, heads: heads_of(target, &scales), asked: goal.heads() };
    Ok((scales, limits))
}

/// Arms and legs as long for all that is above the legs as the reference's, but none longer than it is; nothing else changes.
fn short_limbs(target: &Proportions, reference: &Proportions) -> PartCoefficients {
    let above = |of: &Proportions| of.head_length + of.neck + of.torso;
    let unit = above(target) / above(reference);
    let leg = (unit * reference.leg - target.ankle_height) / (target.leg - target.ankle_height);
    let limb = |length: f64| Scale { length: length.clamp(SHORTEST_LIMB, 1.0), thickness: 1.0 };
    let (arm, leg) = (limb(unit * reference.arm / target.arm), limb(leg));
    PartCoefficients {
        upper_arm: arm,
        lower_arm: arm,
        upper_leg: leg,
        lower_leg: leg,
        ..PartCoefficients::IDENTITY
    }
}

/// How much more a head grows in width than in height: as the style's is wider for its length, up to [`HEAD_WIDTH`].
fn wider(target: &Proportions, goal: Goal) -> f64 {
    let wanted = goal.reference().map_or(CHILD_SKULL, Proportions::head_width);
    (wanted / target.head_width()).clamp(1.0, HEAD_WIDTH)
}

/// The same in depth, up to [`HEAD_DEPTH`].
fn deeper(target: &Proportions, goal: Goal) -> f64 {
    let wanted = goal.reference().map_or(Some(CHILD_SKULL_DEPTH), Proportions::head_depth);
    let grows = wanted.zip(target.head_depth()).map(|(wanted, own)| wanted / own);
    grows.map_or(HEAD_DEPTH, |grows| grows.clamp(1.0, HEAD_DEPTH))
}

/// The scales found so far, part after part; the order is that of the warnings.
struct Solver<'a> {
    target: &'a Proportions,
    goal: Goal<'a>,
    lost: f64,
    /// The new head's length.
    head: f64,
    bounds: Bounds,
    scales: PartCoefficients,
}

impl<'a> Solver<'a> {
    fn new(target: &'a Proportions, goal: Goal<'a>, lost: f64, options: &Options) -> Self {
        let head_scale = 1.0 + lost * (options.head_scale - 1.0);
        let growth = ((head_scale - 1.0) / (FULL_HEAD_SCALE - 1.0)).clamp(0.0, 1.0);
        let head = HeadScale {
            height: head_scale,
            width: (1.0 + (wider(target, goal) - 1.0) * growth) * head_scale,
            depth: (1.0 + (deeper(target, goal) - 1.0) * growth) * head_scale,
        };
        Self {
            target,
            goal,
            lost,
            head: head_scale * target.head_length,
            bounds: Bounds { strictness: if options.limits { growth } else { 0.0 }, acted: Vec::new() },
            scales: PartCoefficients { head, ..PartCoefficients::IDENTITY },
        }
    }

    /// All scales, and the bounds that acted.
    fn solved(mut self, sliced: f64) -> (PartCoefficients, Vec<Bounded>) {
        let asked = self.asked();
        let (target, most) = (self.target, self.scales.head.height);
        let (torso, leg) = self.solve_neck(&asked);
        // Nothing grows more than the head: a body that is as stubby as the style, or stubbier, keeps its proportions.
        self.scales.torso.length = self.bounds.apply("torso length", torso / target.torso, 0.0, most);
        self.solve_thickness(leg, sliced);
        let arm = self.bounds.apply("arm length", asked.arm / target.arm, SHORTEST_LIMB, most);
        (self.scales.upper_arm.length, self.scales.lower_arm.length) = (arm, arm);
        self.scales.hand = self.extremity(target.hand, asked.hand, self.scales.lower_arm.thickness);
        self.scales.foot = self.extremity(target.foot, asked.foot, self.root(leg));
        self.solve_legs(leg);
        (self.scales, self.bounds.acted)
    }

    fn asked(&self) -> Asked {
        let of_heads = |trunk: f64| Asked::of_heads(self.target, self.goal.heads(), self.head, trunk);
        let Some(reference) = self.goal.reference() else {
            return of_heads(1.0 + self.lost * (TRUNK_FOR_HEADS - 1.0));
        };
        of_heads(1.0).towards(Asked::of_reference(reference, self.head), self.lost)
    }

    /// From what a part has without a style to what the style gives it.
    fn towards(&self, own: f64, style: f64) -> f64 {
        own + self.lost * (style - own)
    }

    /// The neck's length. What it may not take, torso and legs do, so that the number of heads stays: their lengths.
    fn solve_neck(&mut self, asked: &Asked) -> (f64, f64) {
        let below = asked.neck + asked.torso + asked.leg;
        let longest = (NECK_GROWTH * self.target.neck / self.target.head_length).clamp(NECK.0, NECK.1);
        let neck = self.bounds.apply("neck", asked.neck / self.head, NECK.0, longest) * self.head;
        self.scales.neck.length = neck / self.target.neck.max(ROUNDING * self.target.head_length);
        let rest = (below - neck) / (asked.torso + asked.leg);
        (asked.torso * rest, asked.leg * rest)
    }

    /// The thickness that slices go on from: the root of the torso's length, or that length where it grows. All parts have it, so
    /// that they agree where they meet; but legs have the root of their own length as far as no slice goes on from there.
    ///
    /// `leg`: how long legs are to be.
    fn solve_thickness(&mut self, leg: f64, sliced: f64) {
        let length = self.scales.torso.length;
        let thickness = length.max(length.sqrt());
        let root = self.root(leg);
        let leg = root * (thickness / root).powf(sliced);
        let scales = &mut self.scales;
        for part in [&mut scales.torso, &mut scales.neck, &mut scales.upper_arm, &mut scales.lower_arm] {
            part.thickness = thickness;
        }
        (scales.upper_leg.thickness, scales.lower_leg.thickness) = (leg, leg);
        (scales.shoulder_spread, scales.hip_spread) = (thickness, thickness);
    }

    /// How thick legs become that are to be `leg` long, where nothing else says so.
    fn root(&self, leg: f64) -> f64 {
        (leg / self.target.leg).max(SHORTEST_LIMB).sqrt()
    }

    /// The size of hands or feet of length `own`: not slimmer than the limb, which becomes `least` as thick, nor nearer to the head's
    /// growth than to that; as the limb where one is not known.
    fn extremity(&self, own: Option<f64>, asked: Option<f64>, least: f64) -> f64 {
        match asked.zip(own) {
            Some((asked, own)) => {
                let bounded =
                    self.bounds.within(asked / own, least, (least * self.scales.head.height).sqrt());
                self.towards(least, bounded)
            }
            None => least,
        }
    }

    /// The legs: what the foot takes up is no longer the leg's. A foot that would leave the leg no length is made
    /// smaller first.
    fn solve_legs(&mut self, leg: f64) {
        let (target, bounds, scales) = (self.target, &mut self.bounds, &mut self.scales);
        let shank = target.leg - target.ankle_height;
        if target.ankle_height > 0.0 {
            let room = (leg - SHORTEST_LIMB * shank).max(ROOM_FOR_FOOT * leg);
            scales.foot = bounds.apply("foot", scales.foot, 0.0, room / target.ankle_height);
        }
        let left = leg - target.ankle_height * scales.foot;
        // Legs that are to be a style's stubs take no more from the torso than leaves it as long for itself as they are.
        let both = (scales.torso.length * target.torso + left) / (target.torso + shank);
        let least = self.goal.reference().map_or(SHORTEST_LIMB, |_| both.min(SHORTEST_LIMB));
        let length = bounds.apply("leg length", left / shank, least, scales.head.height);
        // What the legs could not give, the torso gives.
        let excess = length * shank + target.ankle_height * scales.foot - leg;
        if excess > ROUNDING * leg {
            scales.torso.length = (scales.torso.length - bounds.strictness * excess / target.torso).max(0.0);
        }
        (scales.upper_leg.length, scales.lower_leg.length) = (length, length);
    }
}

/// How many heads tall a figure of proportions `target` becomes.
pub fn heads_of(target: &Proportions, scales: &PartCoefficients) -> f64 {
    let head = scales.head.height * target.head_length;
    1.0 + (scales.neck.length * target.neck
        + scales.torso.length * target.torso
        + scales.lower_leg.length * (target.leg - target.ankle_height)
        + scales.foot * target.ankle_height)
        / head
}
