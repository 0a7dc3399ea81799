//! Hair that hangs before the eyes parts like a curtain (D30).
//!
//! A head that grows takes a curtain of hair with it, and what an adult's face showed between the strands is gone. The
//! strands go round the head, each to the side that it is on, until the eyes are free.

use crate::face::dual::step;
use crate::face::eyes::Pair;
use crate::face::head::quantile;
use glam::DVec3;

/// Hair is parted where it covers more than this share of both eyes' openings.
const COVERED: f64 = 0.3;
/// A strand that has more than this share of its places on its other side is no strand of one side: a wig in one piece
/// cannot part.
const OTHER_SIDE: f64 = 0.25;
/// How far beyond the eyes' outer corners hair opens, in their half widths and in head lengths.
const BEYOND: (f64, f64) = (0.15, 0.02);
/// Hair further back than this, in radians from the front, stays: 115 degrees.
const STAYS: f64 = 2.007;
/// The parting: nothing opens there; above the eyes by the second number it is all open.
const PARTING: (f64, f64) = (0.90, 0.10);
/// How far above and below the eyes hair is looked at, in head lengths, and the share of its places that it reaches no further than.
const LOOKED_AT: (f64, f64) = (0.15, 0.95);

/// Where hair goes that parts; in head lengths from the middle of the chin.
#[derive(Clone, Debug)]
pub struct Parting {
    /// The head's axis.
    middle: DVec3,
    /// How far hair reaches from it at the eyes, to the side and to the front.
    reach: DVec3,
    /// How far it opens to each side at the eyes, in radians.
    opens: f64,
    /// The eyes' upper end.
    eyes: f64,
}

/// To which side each place goes, 1 for the left; `None` where hair need not or cannot part.
///
/// `points`: in head lengths from the middle of the chin; `pieces`: the number of each one's connected piece, below that of points.
pub fn sides(points: &[DVec3], pieces: &[u32], covered: f64) -> Option<Vec<f64>> {
    let lowest = points.iter().map(|p| p.y).fold(f64::INFINITY, f64::min);
    if covered <= COVERED || lowest > 0.0 {
        return None;
    }
    let mut left = vec![(0.0, 0.0); points.len()];
    let mut is_before_face = vec![false; points.len()];
    for (p, &piece) in points.iter().zip(pieces) {
        let (on_left, all) = &mut left[piece as usize];
        *on_left += if p.x > 0.0 { 1.0 } else { 0.0 };
        *all += 1.0;
        is_before_face[piece as usize] |= p.z > 0.0 && p.y < PARTING.0;
    }
    let side = |&piece: &u32| {
        let (on_left, all) = left[piece as usize];
        let left: f64 = on_left / all;
        let is_two_sided = left.min(1.0 - left) > OTHER_SIDE && is_before_face[piece as usize];
        (!is_two_sided).then_some(if left > 0.5 { 1.0 } else { -1.0 })
    };
    pieces.iter().map(side).collect()
}

impl Parting {
    /// Opens hair at `points` before `eyes`, which should be seen, about the axis through `middle`.
    pub fn new(points: &[DVec3], middle: DVec3, eyes: Pair) -> Self {
        let beside = |p: &&DVec3| (p.y - eyes.height).abs() < LOOKED_AT.0;
        let reach = |of: &dyn Fn(DVec3) -> f64| {
            let mut all: Vec<f64> = points.iter().filter(beside).map(|&p| of(p - middle)).collect();
            quantile(&mut all, LOOKED_AT.1).map_or(1.0, |reach| reach.max(1e-9))
        };
        let reach = DVec3::new(reach(&|p| p.x.abs()), 1.0, reach(&|p| p.z));
        let aside = eyes.half_distance + (1.0 + BEYOND.0) * eyes.half_width + BEYOND.1;
        let opens = (aside / reach.x).min(0.95).asin();
        Self { middle, reach, opens, eyes: eyes.height + eyes.half_height }
    }

    /// Where a point of a strand of this side goes, as far as `amount` says.
    pub fn place(&self, p: DVec3, side: f64, amount: f64) -> DVec3 {
        let from = (p - self.middle) / self.reach;
        let turn = side * from.x.atan2(from.z);
        if turn.abs() >= STAYS {
            return p;
        }
        let rises = step((PARTING.0 - p.y) / (PARTING.0 - self.eyes - PARTING.1).max(0.05));
        let open = amount * self.opens * rises;
        let (sin, cos) = (side * (open + turn * (STAYS - open) / STAYS)).sin_cos();
        let radius = from.x.hypot(from.z);
        (self.middle + self.reach * DVec3::new(radius * sin, 0.0, radius * cos)).with_y(p.y)
    }
}
