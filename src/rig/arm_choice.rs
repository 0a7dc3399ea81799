//! Which of several arms a body has: what all bodies obey, as a cost of a pair.

use super::arm_curve::Arm;
use super::front_view::image;
use super::solid::Solid;
use glam::DVec3;

/// From shoulder to fingertips, as a share of the shoulder's height (Winter, table 4.1: .44 of .818 H; figures of two heads
/// have the same share of what is below their chin), and what is no surprise, as a logarithm.
const LENGTH: (f64, f64) = (0.54, 0.3);
/// From the middle to the shoulder joint, as a share of the shoulder's height (the same table: .129 of .818 H).
const HALF_WIDTH: (f64, f64) = (0.155, 0.4);
/// The arm's radius as a share of its length (upper arms are .16 of their arm's length around: .026 of it, and stouter in
/// stylised figures).
const RADIUS: (f64, f64) = (0.07, 0.6);
/// How far up from crotch to neck shoulders are (.818 - .48 of .87 - .48 H), and what is no surprise.
const HEIGHT: (f64, f64) = (0.86, 0.15);
/// How far beside the way from shoulder to wrist an elbow is no surprise, as a share of the arm's length: an arm bent by 60
/// degrees.
const BENT: f64 = 0.2;
/// Shoulders are each other's image to within this, in heights.
const APART: f64 = 0.03;
/// The two arms are as long as each other to within this, as a logarithm.
const UNEVEN: f64 = 0.15;
/// Hands as long to within this, as a logarithm, are alike.
const UNEVEN_HANDS: f64 = 0.25;
/// An arm passes a joint that is given within this distance, in heights.
const PASSES: f64 = 0.02;
/// What each given joint costs at most that an arm passes by more than `PASSES`, and what each costs a side without an arm.
const PASSES_BY: f64 = 20.0;
/// No one surprise counts for more than this.
const MOST: f64 = 9.0;
/// What an arm costs whose wrist is not seen.
const NO_WRIST: f64 = 1.0;
/// What an arm costs all of which lies in the air.
const IN_AIR: f64 = 20.0;
/// An elbow or a wrist in something this many times as thick as the arm, all around, such as a head, is too deep; each
/// costs the second, half of `IN_AIR`.
const DEEP: (f64, f64) = (2.2, 10.0);
/// What a side without an arm costs.
const NO_ARM: f64 = 14.0;
/// Rays are finer than cells: what they see goes before what costs less by no more than this.
pub const FINER: f64 = 0.5;
/// A shoulder that is the image of the other one is a guess, and agrees with it for that reason alone.
pub const IMAGE: f64 = 2.0;
/// An arm is looked at in so many places.
const SAMPLES: usize = 12;

/// The body that arms belong to.
pub struct Body<'a> {
    /// It, in cells.
    pub solid: &'a Solid,
    /// x of the plane of symmetry.
    pub axis: f64,
    /// Height of the soles.
    pub low: f64,
    /// Height of the crotch.
    pub crotch: f64,
    /// Height of the neck.
    pub neck: Option<f64>,
    /// Joints of the left and the right arm that are given: shoulder, elbow, wrist.
    pub given: [[Option<DVec3>; 3]; 2],
}

/// An arm that may be, and what it costs by itself.
#[derive(Clone)]
pub struct Candidate {
    /// The arm.
    pub arm: Arm,
    /// What is odd about it.
    pub cost: f64,
}

impl Body<'_> {
    /// What is odd about an arm by itself, and `more` for the way it was found.
    pub fn candidate(&self, arm: Arm, left: bool, more: f64) -> Candidate {
        let given = self.given[usize::from(!left)];
        let passes = given.into_iter().flatten().map(|p| arm.curve.nearest(p).1 / PASSES);
        let more = more + passes.map(|off| (off * off).min(PASSES_BY)).sum::<f64>();
        let arm = arm.with_given(given);
        let height = (arm.shoulder.y - self.low).max(1e-3);
        let length = length(&arm).max(1e-3);
        let log = |value: f64, (usual, spread): (f64, f64)| surprise((value.max(1e-6) / usual).ln() / spread);
        let mut cost = log(length / height, LENGTH)
            + log((arm.shoulder.x - self.axis).abs() / height, HALF_WIDTH)
            + log(arm.radius / length, RADIUS)
            + more;
        if let Some(neck) = self.neck {
            let share = (arm.shoulder.y - self.crotch) / (neck - self.crotch).max(1e-3);
            cost += surprise((share - HEIGHT.0) / HEIGHT.1);
        }
        let chain = [arm.shoulder, arm.elbow, arm.wrist];
        let outside = chain
            .windows(2)
            .flat_map(|pair| (0..SAMPLES).map(|i| pair[0].lerp(pair[1], i as f64 / SAMPLES as f64)))
            .filter(|&p| !self.solid.is_in(p))
            .count();
        // Arms are held straight enough for a rig, or bent at the elbow, not beside it.
        let off =
            (arm.elbow - arm.shoulder).reject_from((arm.wrist - arm.shoulder).normalize_or_zero()).length();
        cost += surprise(off / (BENT * length));
        cost += IN_AIR * outside as f64 / (2 * SAMPLES) as f64;
        let deep = [arm.elbow, arm.wrist].into_iter().filter(|&p| self.is_deep(p, DEEP.0 * arm.radius));
        cost += DEEP.1 * deep.count() as f64;
        cost += if arm.wrist_seen { 0.0 } else { NO_WRIST };
        Candidate { arm, cost }
    }

    /// True where all is filled around a point, at a distance.
    fn is_deep(&self, p: DVec3, distance: f64) -> bool {
        let corners = (0..8).map(|corner| {
            let sign = |bit: usize| if corner >> bit & 1 == 0 { -1.0 } else { 1.0 };
            DVec3::new(sign(0), sign(1), sign(2)) / 3.0f64.sqrt()
        });
        let faces = DVec3::AXES.into_iter().flat_map(|axis| [axis, -axis]);
        corners.chain(faces).all(|way| self.solid.is_in(p + distance * way))
    }

    /// What is odd about a left and a right arm.
    pub fn cost(&self, pair: [Option<&Candidate>; 2]) -> f64 {
        let none = |side: usize| NO_ARM + PASSES_BY * self.given[side].iter().flatten().count() as f64;
        let own = |side: usize| pair[side].map_or_else(|| none(side), |one| one.cost);
        let mut cost = own(0) + own(1);
        if let [Some(left), Some(right)] = pair {
            cost += surprise(left.arm.shoulder.distance(image(right.arm.shoulder, self.axis)) / APART);
            cost += surprise((length(&left.arm) / length(&right.arm).max(1e-6)).max(1e-6).ln() / UNEVEN);
        }
        cost
    }

    /// The arm with the image of the other one's shoulder in place of its own.
    pub fn with_shoulder_of(&self, arm: &Arm, other: &Arm) -> Arm {
        let shoulder = image(other.shoulder, self.axis);
        let elbow = shoulder.lerp(arm.wrist, other.elbow_share());
        Arm { shoulder, elbow, pit: other.pit, radius: other.radius, ..arm.clone() }
    }
}

/// Gives both arms hands of one length, as far as they are not `given`.
///
/// Where one wrist does not show, its hand is as long as the other one; where neither does, or hands are uneven, both are in doubt.
pub fn even_hands(arms: [Option<Arm>; 2], given: [bool; 2]) -> [Option<Arm>; 2] {
    let [Some(left), Some(right)] = &arms else { return arms };
    let is_even =
        |one: &Arm, other: &Arm| (hand(one) / hand(other).max(1e-9)).max(1e-9).ln().abs() <= UNEVEN_HANDS;
    let beside = |arm: &Arm, other: &Arm| {
        Some(if arm.wrist_seen && is_even(arm, other) { arm.clone() } else { with_hand_of(arm, other) })
    };
    // A hand that is given tells how long the other one is, else one that shows.
    let tells = if given == [false, false] { [left.wrist_seen, right.wrist_seen] } else { given };
    match tells {
        [true, false] => [Some(left.clone()), beside(right, left)],
        [false, true] => [beside(left, right), Some(right.clone())],
        [true, true] if given[0] || is_even(left, right) => arms,
        [true, true] | [false, false] => arms.map(|arm| Some(Arm { wrist_seen: false, ..arm? })),
    }
}

/// How long a hand is.
fn hand(arm: &Arm) -> f64 {
    arm.tip.distance(arm.wrist)
}

/// The arm with a hand as long as the other one's.
fn with_hand_of(arm: &Arm, other: &Arm) -> Arm {
    let wrist = arm.tip + (arm.elbow - arm.tip).clamp_length(hand(other), hand(other));
    // Halfway: the elbow was found between shoulder and wrist.
    let elbow = arm.elbow + 0.5 * (wrist - arm.wrist);
    Arm { wrist, elbow, wrist_seen: true, ..arm.clone() }
}

fn surprise(deviation: f64) -> f64 {
    (deviation * deviation).min(MOST)
}

/// From the shoulder joint to the tip.
fn length(arm: &Arm) -> f64 {
    arm.shoulder.distance(arm.elbow) + arm.elbow.distance(arm.wrist) + arm.wrist.distance(arm.tip)
}
