//! How much each part shrinks (product mode): from proportions to scales.
//!
//! Lengths are transferred as in §V-B3: all are measured in heads, so that with L' = `head_scale` L the result has the
//! reference's proportions. Widths are judged against the head's width, not its height. Bounds keep what the paper's
//! linear maps cannot carry (shins that fold into rings, hands larger than the face); every bound that acts is warned of.

use super::anatomy::Proportions;
use super::groups::PartGroups;
use super::scales::{HeadScale, PartCoefficients, Scale};
use crate::error::{Result, Warning};
use crate::face::rows::{CHILD_SKULL, CHILD_SKULL_DEPTH};
use crate::geometry::ROUNDING;
use crate::options::table::HEAD_SCALE;
use crate::options::{Options, Stage};

/// The head grows at most this much more in width than in height: as far as the style's head is wider. D28. Seen: even so
/// heads are .76 as wide, by their height, as the KayKit rogue's; less turns fewer triangles over.
pub const HEAD_WIDTH: f64 = 1.12;
/// As [`HEAD_WIDTH`], in depth; a style that does not know its depth gets all of it. D28. Seen: 30 % more folds collars
/// (228 triangles).
pub const HEAD_DEPTH: f64 = 1.05;
/// The neck keeps this much more thickness than the torso. D27. Seen: a thinner neck folds at its border.
const NECK_THICKNESS: f64 = 1.1;
/// `head_scale` at which the bounds act in full; at 1 they do not act at all. Paper, V-B1: alpha_head; D27.
const FULL_HEAD_SCALE: f64 = HEAD_SCALE;
/// Length of the neck between these, in new heads. D27. Seen: references have .14 to .16; the upper one cuts a baby's
/// .28, which makes necks .039 H longer; the lower never acts.
const NECK: (f64, f64) = (0.03, 0.19);
/// The neck may grow this much more than the head. D27, for targets without a neck. Seen: 30 % less acts on one of 14.
const NECK_GROWTH: f64 = 1.5;
/// Length of the neck in a style for N heads, in new heads. D27. Seen: the upper one acts on long necks.
const NECK_FOR_HEADS: (f64, f64) = (0.05, 0.14);
/// The neck's largest share of all below the head in a style for N heads: a guard that would act below 1.5 heads.
const NECK_SHARE_FOR_HEADS: f64 = 0.3;
/// How far head widths may differ before thicknesses stop following. D27. Seen: the lower one acts on a mannequin with
/// an egg for a head (.059 H), the upper on none.
const THICKNESS_PER_HEAD_WIDTH: (f64, f64) = (0.6, 1.25);
/// No part may become this many times stubbier. D27. Seen: without it a mannequin's thighs become discs, and shins fold
/// into rings.
const STUBBIEST: f64 = 2.6;
/// No limb may become shorter than this share of itself, however slim it gets. D27. Seen: [`STUBBIEST`] acts first on
/// all pairs but one.
const SHORTEST_LIMB: f64 = 0.18;
/// The torso may be this much slimmer than it is short. D27. Seen: acts on no adult; 30 % more does on what is
/// super-deformed already.
const TORSO_SLIMMEST: f64 = 0.9;
/// Arms may be this much slimmer than the torso. D27. Seen: without it arms like godette's get up to .028 H thinner.
const ARM_SLIMMEST: f64 = 1.2;
/// Legs may be this much slimmer than the torso. D27. Seen: without it legs like KayKit's get up to .020 H thinner.
const LEG_SLIMMEST: f64 = 1.38;
/// Limbs may be this much thicker than the torso. D27. Seen: hardly acts, [`LIMB_THICKEST_ON_SLIM_TORSO`] is reached
/// first.
const LIMB_THICKEST: f64 = 1.2;
/// Limbs may be this thick, as a scale, where the torso is slimmer. D27. Seen: without it arms like KayKit's get up to
/// .036 H thicker.
const LIMB_THICKEST_ON_SLIM_TORSO: f64 = 0.95;
/// The two segments of a limb stay within this of their geometric mean. D27. Seen: acts on one pair; with both alike
/// (1) forearms lose up to .042 H of what the reference gives them.
const SEGMENT_SPREAD: f64 = 1.15;
/// Hands against the lower arm's thickness. D27. Seen: the lower one acts on all 14 with KayKit, whose mitts would make
/// hands .044 H smaller.
const HAND_PER_ARM: (f64, f64) = (0.9, 1.35);
/// Feet against the lower leg's thickness. D27. Seen: the lower one acts on 9 of 14, the upper on one.
const FOOT_PER_LEG: (f64, f64) = (1.0, 1.4);
/// Where the style knows no hand, it is this much larger than the lower arm is thick. Found by looking: hands of the
/// limb's own scale look like sticks' ends.
const HAND_WITHOUT_STYLE: f64 = 0.1;
/// As [`HAND_WITHOUT_STYLE`], for the foot and the lower leg.
const FOOT_WITHOUT_STYLE: f64 = 0.2;
/// Longest hand, in new heads. D27. Seen: acts on all 14 with a baby, whose hands would be .069 H longer.
const LONGEST_HAND: f64 = 0.34;
/// Longest foot, in new heads. D27. Seen: acts on 12 of 14 with a baby (.035 H).
const LONGEST_FOOT: f64 = 0.6;
/// The leg above the ankle is at least this share of the whole leg: for ankle joints near the hip, of which none was
/// seen.
const SHORTEST_SHANK: f64 = 0.05;
/// The foot may take at least this share of the new leg's height. D27. Seen: acts on 5 of 14 with KayKit; without it
/// feet get up to .034 H smaller.
const ROOM_FOR_FOOT: f64 = 0.35;
/// Where the legs cannot be as short as the reference's, the torso makes up for it, down to this share of its own. D27.
/// Seen: at 1 the 14 miss KayKit's head count by 4 % more in the mean.
const TORSO_AFTER_LEGS: f64 = 0.8;
/// In a style for N heads the torso shrinks this much less than the whole. D27, found by looking. Seen: 30 % move the
/// crotch by .11 H.
const TORSO_FOR_HEADS: f64 = 1.1;
/// As [`TORSO_FOR_HEADS`], for arms. D27, found by looking.
const ARM_FOR_HEADS: f64 = 1.05;
/// In a style for N heads thicknesses shrink by this factor of the root. D27. Seen: less turns triangles over (193 at
/// 30 %).
const THICKNESS_FOR_HEADS: f64 = 0.78;
/// A bound that changes a value by less than this share of it is not warned of: no eye sees it.
const BOUND_WARNED_ABOVE: f64 = 1e-3;
/// A number of heads that misses by less than this is not warned of: no eye sees it.
const HEADS_WARNED_ABOVE: f64 = 0.005;

/// What the result should be like.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Goal<'a> {
    /// Like a reference.
    Reference(&'a Proportions),
    /// So many heads tall, everything else after the target.
    Heads(f64),
}

impl Goal<'_> {
    /// How many heads tall the result should be.
    pub fn heads(&self) -> f64 {
        match self {
            Goal::Heads(heads) => *heads,
            Goal::Reference(reference) => reference.heads(),
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
    fn apply(&mut self, what: &'static str, value: f64, low: f64, high: f64) -> f64 {
        let bounded = value + self.strictness * (value.max(low).min(high.max(low)) - value);
        if (bounded - value).abs() > BOUND_WARNED_ABOVE * value.abs() {
            // Two bounds on one thing are one warning.
            match self.acted.iter_mut().find(|known| known.what == what) {
                Some(known) => known.to = bounded,
                None => self.acted.push(Bounded { what, from: value, to: bounded }),
            }
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
    torso_thickness: Option<f64>,
    /// Upper arm, lower arm.
    arm_thickness: [Option<f64>; 2],
    /// Upper leg, lower leg.
    leg_thickness: [Option<f64>; 2],
}

impl Asked {
    /// The proportions of `reference`, for a head of length `head` that grows `width_factor` more in width.
    fn of_reference(
        target: &Proportions,
        reference: &Proportions,
        head: f64,
        width_factor: f64,
        strictness: f64,
    ) -> Self {
        let unit = head / reference.head_length;
        let head_widths = (width_factor * target.head_half_width / target.head_length)
            / (reference.head_half_width / reference.head_length);
        let (least, most) = THICKNESS_PER_HEAD_WIDTH;
        // Judging thickness against head width is no bound worth a warning.
        let thinness = Bounds { strictness, acted: Vec::new() }.apply("thickness", head_widths, least, most);
        let thickness = |ours: Option<f64>, theirs: Option<f64>| match (ours, theirs) {
            (Some(ours), Some(theirs)) => Some(theirs * unit * thinness / ours),
            _ => None,
        };
        Self {
            neck: reference.neck * unit,
            torso: reference.torso * unit,
            arm: reference.arm * unit,
            leg: reference.leg * unit,
            hand: reference.hand.map(|hand| hand * unit),
            foot: reference.foot.map(|foot| foot * unit),
            torso_thickness: thickness(target.torso_half_width, reference.torso_half_width),
            arm_thickness: [
                thickness(target.upper_arm_radius, reference.upper_arm_radius),
                thickness(target.lower_arm_radius, reference.lower_arm_radius),
            ],
            leg_thickness: [
                thickness(target.upper_leg_radius, reference.upper_leg_radius),
                thickness(target.lower_leg_radius, reference.lower_leg_radius),
            ],
        }
    }

    /// So many heads of length `head`, the rest after the target.
    fn of_heads(target: &Proportions, heads: f64, head: f64, head_scale: f64) -> Self {
        let below = target.neck + target.torso + target.leg;
        let shrink = (heads - 1.0) * target.head_length / below;
        let neck = (shrink * target.neck * head_scale)
            .clamp(NECK_FOR_HEADS.0 * head, NECK_FOR_HEADS.1 * head)
            .min(NECK_SHARE_FOR_HEADS * (heads - 1.0) * head);
        let torso = TORSO_FOR_HEADS * shrink * head_scale * target.torso;
        let thickness = Some(THICKNESS_FOR_HEADS * shrink.sqrt() * head_scale);
        Self {
            neck,
            torso,
            arm: ARM_FOR_HEADS * shrink * head_scale * target.arm,
            leg: (heads - 1.0) * head - neck - torso,
            hand: None,
            foot: None,
            torso_thickness: thickness,
            arm_thickness: [thickness; 2],
            leg_thickness: [thickness; 2],
        }
    }
}

/// The bounds that acted on [`part_coefficients`], and the number of heads that came out beside the one asked for.
#[derive(Clone, Debug, PartialEq)]
pub struct Limits {
    acted: Vec<Bounded>,
    heads: f64,
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
    /// - `heads`, `asked`: the head count that came out, and the one wanted.
    /// - `replaced`: thicknesses and sizes that something else sets afterwards, by their names in the warnings. Their bounds are
    ///   not warned of.
    pub fn warnings(&self, heads: f64, asked: f64, replaced: &[&str]) -> Vec<Warning> {
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
        let kept = list(&|bounded| !replaced.contains(&bounded.what));
        if !kept.is_empty() {
            let message = format!("limited to keep the shape sound: {kept}");
            warnings.push(Warning::new("coefficient_limited", message));
        }
        warnings
    }
}

/// The scales that make `target` like `goal`, and the bounds that acted.
///
/// `groups`: which group's settings each part follows.
///
/// # Errors
/// `ErrorKind::BadOption` for an unknown group; `NoGeometry` for a group of no extent.
pub fn part_coefficients(
    target: &Proportions,
    goal: Goal,
    options: &Options,
    groups: &PartGroups,
) -> Result<(PartCoefficients, Limits)> {
    let mut solver = Solver::new(target, goal, options);
    let asked = solver.asked();
    let (torso, leg) = solver.solve_neck(&asked);
    solver.solve_torso(torso, asked.torso_thickness);
    solver.solve_limb_thickness(&asked);
    solver.solve_arms(asked.arm);
    solver.solve_hands(asked.hand);
    solver.solve_feet(asked.foot);
    solver.solve_legs(leg);
    let Solver { mut scales, bounds, .. } = solver;
    scales.apply_settings(&options.groups, groups)?;
    if options.stage == Stage::Length {
        scales = scales.lengths_only();
    }
    scales.validate()?;
    let limits = Limits { acted: bounds.acted, heads: heads_of(target, &scales), asked: goal.heads() };
    Ok((scales, limits))
}

/// How much more a head grows in width than in height: as the style's is wider for its length, up to [`HEAD_WIDTH`].
fn wider(target: &Proportions, goal: Goal) -> f64 {
    let wanted = match goal {
        Goal::Reference(reference) => reference.head_width(),
        Goal::Heads(_) => CHILD_SKULL,
    };
    (wanted / target.head_width()).clamp(1.0, HEAD_WIDTH)
}

/// The same in depth, up to [`HEAD_DEPTH`].
fn deeper(target: &Proportions, goal: Goal) -> f64 {
    let wanted = match goal {
        Goal::Reference(reference) => reference.head_depth(),
        Goal::Heads(_) => Some(CHILD_SKULL_DEPTH),
    };
    match (wanted, target.head_depth()) {
        (Some(wanted), Some(own)) => (wanted / own).clamp(1.0, HEAD_DEPTH),
        _ => HEAD_DEPTH,
    }
}

/// The scales found so far, part after part; the order is that of the warnings.
struct Solver<'a> {
    target: &'a Proportions,
    goal: Goal<'a>,
    head_scale: f64,
    /// The new head's length.
    head: f64,
    /// 0 for a head that keeps its size, 1 for one that grows by [`FULL_HEAD_SCALE`].
    growth: f64,
    bounds: Bounds,
    scales: PartCoefficients,
}

impl<'a> Solver<'a> {
    fn new(target: &'a Proportions, goal: Goal<'a>, options: &Options) -> Self {
        let head_scale = options.head_scale;
        let growth = ((head_scale - 1.0) / (FULL_HEAD_SCALE - 1.0)).clamp(0.0, 1.0);
        let head = HeadScale {
            height: head_scale,
            width: (1.0 + (wider(target, goal) - 1.0) * growth) * head_scale,
            depth: (1.0 + (deeper(target, goal) - 1.0) * growth) * head_scale,
        };
        Self {
            target,
            goal,
            head_scale,
            head: head_scale * target.head_length,
            growth,
            bounds: Bounds { strictness: if options.limits { growth } else { 0.0 }, acted: Vec::new() },
            scales: PartCoefficients { head, hair_taming: growth, ..PartCoefficients::IDENTITY },
        }
    }

    fn asked(&self) -> Asked {
        match self.goal {
            Goal::Reference(reference) => {
                let width_factor = self.scales.head.width / self.head_scale;
                Asked::of_reference(self.target, reference, self.head, width_factor, self.bounds.strictness)
            }
            Goal::Heads(heads) => Asked::of_heads(self.target, heads, self.head, self.head_scale),
        }
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

    /// The torso, and with it the neck's thickness and where the limbs begin.
    fn solve_torso(&mut self, torso: f64, asked: Option<f64>) {
        let (bounds, scales) = (&mut self.bounds, &mut self.scales);
        // Nothing grows more than the head: a body that is as stubby as the style, or stubbier, keeps its proportions.
        let length = bounds.apply("torso length", torso / self.target.torso, 0.0, self.head_scale);
        let least = TORSO_SLIMMEST * length;
        let thickness =
            bounds.apply("torso thickness", asked.unwrap_or(length.sqrt()), least, least.max(1.0));
        let length = bounds.apply("torso length", length, thickness / STUBBIEST, f64::INFINITY);
        scales.torso = Scale { length, thickness };
        scales.neck.thickness = (1.0 + (NECK_THICKNESS - 1.0) * self.growth) * thickness;
        scales.shoulder_spread = thickness;
        scales.hip_spread = thickness;
    }

    fn solve_limb_thickness(&mut self, asked: &Asked) {
        let names = ["upper_arm thickness", "lower_arm thickness"];
        let [upper, lower] = self.segments(names, asked.arm_thickness, ARM_SLIMMEST);
        self.scales.upper_arm.thickness = upper;
        self.scales.lower_arm.thickness = lower;
        let names = ["upper_leg thickness", "lower_leg thickness"];
        let [upper, lower] = self.segments(names, asked.leg_thickness, LEG_SLIMMEST);
        self.scales.upper_leg.thickness = upper;
        self.scales.lower_leg.thickness = lower;
    }

    /// The thickness of both segments of a limb: near the torso's, and near each other.
    fn segments(&mut self, names: [&'static str; 2], asked: [Option<f64>; 2], slimmest: f64) -> [f64; 2] {
        let torso = self.scales.torso.thickness;
        let thickest = (LIMB_THICKEST * torso).min(torso.max(LIMB_THICKEST_ON_SLIM_TORSO));
        let pair = [0, 1].map(|segment| {
            let thickness = asked[segment].unwrap_or(torso);
            self.bounds.apply(names[segment], thickness, torso / slimmest, thickest)
        });
        let mean = (pair[0] * pair[1]).sqrt();
        [0, 1].map(|segment| {
            let (least, most) = (mean / SEGMENT_SPREAD, mean * SEGMENT_SPREAD);
            self.bounds.apply(names[segment], pair[segment], least, most)
        })
    }

    fn solve_arms(&mut self, arm: f64) {
        let least = shortest(self.scales.upper_arm, self.scales.lower_arm);
        let length = self.bounds.apply("arm length", arm / self.target.arm, least, self.head_scale);
        self.scales.upper_arm.length = length;
        self.scales.lower_arm.length = length;
    }

    fn solve_hands(&mut self, asked: Option<f64>) {
        let (own, thickness) = (self.target.hand, self.scales.lower_arm.thickness);
        let without = (1.0 + HAND_WITHOUT_STYLE * self.growth) * thickness;
        self.scales.hand = self.extremity("hand", own, asked, without, thickness, HAND_PER_ARM, LONGEST_HAND);
    }

    fn solve_feet(&mut self, asked: Option<f64>) {
        let (own, thickness) = (self.target.foot, self.scales.lower_leg.thickness);
        let without = (1.0 + FOOT_WITHOUT_STYLE * self.growth) * thickness;
        self.scales.foot = self.extremity("foot", own, asked, without, thickness, FOOT_PER_LEG, LONGEST_FOOT);
    }

    /// The size of hands or feet: `own` and `asked` lengths, `without` where one is not known.
    #[allow(clippy::too_many_arguments)]
    fn extremity(
        &mut self,
        what: &'static str,
        own: Option<f64>,
        asked: Option<f64>,
        without: f64,
        thickness: f64,
        per_thickness: (f64, f64),
        longest: f64,
    ) -> f64 {
        let size = asked.zip(own).map_or(without, |(asked, own)| asked / own);
        let (least, most) = (per_thickness.0 * thickness, per_thickness.1 * thickness);
        let size = self.bounds.apply(what, size, least, most.min(self.head_scale));
        match own {
            Some(own) => self.bounds.apply(what, size, 0.0, longest * self.head / own),
            None => size,
        }
    }

    /// The legs: what the foot takes up is no longer the leg's. A foot that would leave the leg no length is made
    /// smaller first.
    fn solve_legs(&mut self, leg: f64) {
        let (target, bounds, scales) = (self.target, &mut self.bounds, &mut self.scales);
        let shank = (target.leg - target.ankle_height).max(SHORTEST_SHANK * target.leg);
        if target.ankle_height > 0.0 {
            let room = (leg - SHORTEST_LIMB * shank).max(ROOM_FOR_FOOT * leg);
            scales.foot = bounds.apply("foot", scales.foot, 0.0, room / target.ankle_height);
        }
        let length = (leg - target.ankle_height * scales.foot) / shank;
        let torso_thickness = scales.torso.thickness;
        if let Goal::Heads(_) = self.goal {
            // The total is what was asked for: slimmer legs may be shorter before the bound on stubbiness acts.
            let slimmest = torso_thickness / LEG_SLIMMEST;
            for thickness in [&mut scales.upper_leg.thickness, &mut scales.lower_leg.thickness] {
                *thickness = thickness.min((STUBBIEST * length).max(slimmest.min(*thickness)));
            }
        }
        let least = shortest(scales.upper_leg, scales.lower_leg);
        let length = bounds.apply("leg length", length, least, self.head_scale);
        // What the legs could not give, the torso gives: all of it where a number of heads is asked for.
        let excess = length * shank + target.ankle_height * scales.foot - leg;
        if excess > ROUNDING * leg {
            let shortest = match self.goal {
                Goal::Heads(_) => 0.0,
                Goal::Reference(_) => TORSO_AFTER_LEGS * scales.torso.length,
            };
            let torso = (scales.torso.length - bounds.strictness * excess / target.torso).max(shortest);
            scales.torso.length =
                bounds.apply("torso length", torso, torso_thickness / STUBBIEST, f64::INFINITY);
        }
        scales.upper_leg.length = length;
        scales.lower_leg.length = length;
    }
}

/// The least length of a limb of these two segments.
fn shortest(upper: Scale, lower: Scale) -> f64 {
    (upper.thickness.max(lower.thickness) / STUBBIEST).max(SHORTEST_LIMB)
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
