//! Hair that hangs before the eyes parts like a curtain (D30).
//!
//! A head that grows takes a curtain of hair with it, and what an adult's face showed between the strands is gone. The
//! strands go round the head, each to the side that it is on, until the eyes are free.

use super::long_hair::{ANGLES, Axis, Polar, PolarMap};
use crate::face::dual::step;
use glam::DVec3;
use std::f64::consts::{PI, TAU};

/// Hair is parted where it covers more than this share of both eyes' openings.
const COVERED: f64 = 0.3;
/// A strand that has more than this share of its vertices on its other side is no strand of one side: a wig in one piece
/// cannot part.
const OTHER_SIDE: f64 = 0.25;
/// How far beyond the eyes' outer corners hair opens, in their half widths and in head lengths.
const BEYOND: (f64, f64) = (0.15, 0.02);
/// Hair further back than this, in radians from the front, stays: 115 degrees.
const STAYS: f64 = 2.007;
/// The parting: nothing opens there; above the eyes by the second number it is all open.
const PARTING: (f64, f64) = (0.90, 0.10);
/// Below the chin it closes again by the first share, within the second number.
const CLOSES: (f64, f64) = (0.35, 0.35);

/// What parts, and how far; in head lengths about the head's axis.
#[derive(Clone, Debug)]
pub struct Curtain {
    axis: Axis,
    map: PolarMap,
    /// How far it opens to each side at the eyes, in radians.
    opens: f64,
    /// The eyes' upper end.
    eyes: f64,
}

/// The eyes that should be seen: height, half distance, half width, half height of an opening.
#[derive(Clone, Copy, Debug)]
pub struct Openings {
    /// ye, d, a, b, in head lengths.
    pub height: f64,
    /// See `height`.
    pub half_distance: f64,
    /// See `height`.
    pub half_width: f64,
    /// See `height`.
    pub half_height: f64,
}

/// To which side each strand goes, 1 for the left; `None` where hair need not or cannot part.
///
/// `strands`: the points of each, in head lengths from the middle of the chin.
pub fn sides(strands: &[Vec<DVec3>], covered: f64) -> Option<Vec<f64>> {
    let lowest = strands.iter().flatten().map(|p| p.y).fold(f64::INFINITY, f64::min);
    if covered <= COVERED || lowest > 0.0 {
        return None;
    }
    let side = |strand: &Vec<DVec3>| {
        let left = strand.iter().filter(|p| p.x > 0.0).count() as f64 / strand.len().max(1) as f64;
        let is_before_face = strand.iter().any(|p| p.z > 0.0 && p.y < PARTING.0);
        let is_two_sided = left.min(1.0 - left) > OTHER_SIDE && is_before_face;
        (!is_two_sided).then_some(if left > 0.5 { 1.0 } else { -1.0 })
    };
    strands.iter().map(side).collect()
}

impl Curtain {
    /// Opens hair at `points` before `eyes`.
    ///
    /// `axis`: the head's own.
    pub fn new(points: &[DVec3], axis: Axis, eyes: Openings) -> Self {
        let map = PolarMap::of(points.iter().map(|&p| axis.polar(p)));
        let beside = |turn: f64| {
            map.at(Polar {
                angle: (turn / TAU * ANGLES as f64 + 0.5).rem_euclid(ANGLES as f64),
                height: eyes.height,
                radius: 0.0,
            })
        };
        let reach = 0.5 * (beside(0.5) + beside(-0.5));
        let aside = eyes.half_distance + (1.0 + BEYOND.0) * eyes.half_width + BEYOND.1;
        let opens = (aside / reach.max(1e-9)).min(0.95).asin();
        Self { axis, map, opens, eyes: eyes.height + eyes.half_height }
    }

    /// Where a point of a strand of this side goes, as far as `amount` says.
    pub fn place(&self, p: DVec3, side: f64, amount: f64) -> DVec3 {
        let at = self.axis.polar(p);
        let turn = side * wrapped((at.angle - 0.5) / ANGLES as f64 * TAU);
        if turn.abs() >= STAYS {
            return p;
        }
        let rises = step((PARTING.0 - at.height) / (PARTING.0 - self.eyes - PARTING.1).max(0.05));
        let closes = 1.0 - CLOSES.0 * step(-at.height / CLOSES.1);
        let open = amount * self.opens * rises * closes;
        let new_turn = open + turn * (STAYS - open) / STAYS;
        let angle = |turn: f64| (side * turn / TAU * ANGLES as f64 + 0.5).rem_euclid(ANGLES as f64);
        let from = self.map.at(Polar { angle: angle(turn), ..at });
        let to = self.map.at(Polar { angle: angle(new_turn), ..at });
        let radius = at.radius * self.axis.frame.length * if from > 0.0 { to / from } else { 1.0 };
        let (sin, cos) = (side * new_turn).sin_cos();
        DVec3::new(self.axis.middle[0] + radius * sin, p.y, self.axis.middle[1] + radius * cos)
    }
}

/// An angle from -PI to PI.
fn wrapped(turn: f64) -> f64 {
    if turn > PI { turn - TAU } else { turn }
}
