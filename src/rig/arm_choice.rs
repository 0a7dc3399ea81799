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
/// Shoulders are each other's image to within this, in heights.
const APART: f64 = 0.03;
/// The two arms are as long as each other to within this, as a logarithm.
const UNEVEN: f64 = 0.15;
/// An arm passes a joint that is given within this distance, in heights.
const PASSES: f64 = 0.02;
/// What it costs an arm that cannot be: at most for each given joint that it passes by more than `PASSES`, as for each of a side
/// without an arm, and where all of it lies in the air.
const IMPOSSIBLE: f64 = 20.0;
/// No one surprise counts for more than this.
const MOST: f64 = 9.0;
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
        let more = more + passes.map(|off| (off * off).min(IMPOSSIBLE)).sum::<f64>();
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
        cost += IMPOSSIBLE * outside as f64 / (2 * SAMPLES) as f64;
        Candidate { arm, cost }
    }

    /// What is odd about a left and a right arm.
    pub fn cost(&self, pair: [Option<&Candidate>; 2]) -> f64 {
        let none = |side: usize| NO_ARM + IMPOSSIBLE * self.given[side].iter().flatten().count() as f64;
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

fn surprise(deviation: f64) -> f64 {
    (deviation * deviation).min(MOST)
}

/// From the shoulder joint to the tip.
fn length(arm: &Arm) -> f64 {
    arm.shoulder.distance(arm.elbow) + arm.elbow.distance(arm.wrist) + arm.wrist.distance(arm.tip)
}
