//! Long hair (§VII): what the paper shortens by hand in a modelling program.
//!
//! Hair grows with the head, so hair that ended at the hips would end below the soles. Below the chin its height
//! follows the body instead: hair that ended at the hips still does. It narrows from the head's scale towards the
//! body's, and nowhere becomes broader than it is at the chin: hair that spreads over the shoulders of an adult would
//! stand out like a skirt from a child's.

use crate::shape::part_weights::smoothstep;
use glam::{DMat3, DVec3};

/// The slope of the height's map at the chin, against the mean slope: 1 would be straight, 2 would come to rest at
/// the tips.
const FIRST_SLOPE: f64 = 1.5;
/// Tips are at least this wide, as a scale of the original.
const NARROWEST_TIP: f64 = 0.6;
/// Heights at which outline and widths are kept, from the chin to the tips.
const KNOTS: usize = 17;
/// The share of the hair's vertices at a height that its outline holds.
const OUTLINE_QUANTILE: f64 = 0.95;

/// How far hair reaches from the head's axis, below the chin.
#[derive(Clone, Debug, PartialEq)]
pub struct HairOutline {
    /// Chin to the lowest hair.
    pub depth: f64,
    /// Reach in x and z at `KNOTS` heights from the chin down.
    reach: Vec<[f64; 2]>,
}

impl HairOutline {
    /// The outline of `points` about the vertical axis through `axis`, below the height of `axis`, which is the chin;
    /// `None` where no point lies below.
    pub fn of(points: impl Iterator<Item = DVec3>, axis: DVec3) -> Option<Self> {
        let from_axis: Vec<DVec3> = points.map(|p| p - axis).collect();
        let depth = from_axis.iter().map(|p| -p.y).fold(0.0, f64::max);
        if depth <= 0.0 {
            return None;
        }
        let step = depth / (KNOTS - 1) as f64;
        let quantile = |mut values: Vec<f64>| {
            values.sort_by(f64::total_cmp);
            values.get((OUTLINE_QUANTILE * values.len() as f64) as usize).copied()
        };
        let mut reach: Vec<[f64; 2]> = Vec::with_capacity(KNOTS);
        for knot in 0..KNOTS {
            let near = from_axis.iter().filter(|p| (-p.y / step - knot as f64).abs() <= 1.0);
            let x = quantile(near.clone().map(|p| p.x.abs()).collect());
            let z = quantile(near.map(|p| p.z.abs()).collect());
            // A height without vertices reaches as far as the one above.
            let above = reach.last().copied().unwrap_or([0.0; 2]);
            reach.push([x.unwrap_or(above[0]), z.unwrap_or(above[1])]);
        }
        Some(Self { depth, reach })
    }
}

/// Where hair below the chin goes.
#[derive(Clone, Debug, PartialEq)]
pub struct HairMap {
    /// The head's axis at the chin, before and after.
    axis: [DVec3; 2],
    /// Chin to the lowest hair, before.
    depth: f64,
    /// Slope of the height at the chin, and the mean slope down to the tips.
    slopes: [f64; 2],
    /// Scale of x and z at `KNOTS` heights from the chin down.
    widths: Vec<[f64; 2]>,
}

impl HairMap {
    /// Hair of `outline` ends at height `new_bottom`.
    ///
    /// - `axis`: the head's axis at the chin, before and after.
    /// - `head`: the head's scales: height, width, depth.
    /// - `body_girth`: the body's thickness scale.
    pub fn new(
        outline: &HairOutline,
        axis: [DVec3; 2],
        new_bottom: f64,
        head: [f64; 3],
        body_girth: f64,
    ) -> Self {
        let depth = outline.depth;
        let mean = (axis[1].y - new_bottom) / depth;
        let first = head[0].min(FIRST_SLOPE * mean);
        let tip = body_girth.max(NARROWEST_TIP).min(head[1]);
        let mut map = Self { axis, depth, slopes: [first, mean], widths: Vec::new() };
        let scales: Vec<[f64; 2]> = (0..KNOTS)
            .map(|knot| {
                let d = depth * knot as f64 / (KNOTS - 1) as f64;
                // Of the mapped depth: of the unmapped one, short hair flares.
                let fraction = smoothstep(map.drop(d) / (mean * depth));
                [1, 2].map(|side| {
                    let scale = head[side] + (tip.min(head[side]) - head[side]) * fraction;
                    let at_chin = head[side] * outline.reach[0][side - 1];
                    let reach = outline.reach[knot][side - 1];
                    if reach * scale > at_chin && reach > 0.0 { at_chin / reach } else { scale }
                })
            })
            .collect();
        // Smoothed, with both ends kept: the first joins the head.
        map.widths = (0..KNOTS)
            .map(|knot| {
                if knot == 0 || knot == KNOTS - 1 {
                    return scales[knot];
                }
                [0, 1].map(|side| {
                    (scales[knot - 1][side] + 2.0 * scales[knot][side] + scales[knot + 1][side]) / 4.0
                })
            })
            .collect();
        map
    }

    /// How far below the new chin a point ends that was `d` below the chin.
    fn drop(&self, d: f64) -> f64 {
        let [first, mean] = self.slopes;
        first * d + (mean - first) * d * d / self.depth
    }

    /// Where the point `p` below the chin goes, and the Jacobian there.
    pub fn map(&self, p: DVec3) -> (DVec3, DMat3) {
        let from = p - self.axis[0];
        let d = -from.y;
        let [first, mean] = self.slopes;
        let slope = first + 2.0 * (mean - first) * d / self.depth;
        let at = (d / self.depth).clamp(0.0, 1.0) * (KNOTS - 1) as f64;
        let knot = (at as usize).min(KNOTS - 2);
        let [upper, lower] = [self.widths[knot], self.widths[knot + 1]];
        let width = [0, 1].map(|side| upper[side] + (lower[side] - upper[side]) * (at - knot as f64));
        // Per unit of y, which grows against d.
        let knots_per_length = (KNOTS - 1) as f64 / self.depth;
        let by_y = [0, 1]
            .map(|side| if d < self.depth { (upper[side] - lower[side]) * knots_per_length } else { 0.0 });
        let to = self.axis[1] + DVec3::new(width[0] * from.x, -self.drop(d), width[1] * from.z);
        let jacobian = DMat3::from_cols(
            DVec3::new(width[0], 0.0, 0.0),
            DVec3::new(by_y[0] * from.x, slope, by_y[1] * from.z),
            DVec3::new(0.0, 0.0, width[1]),
        );
        (to, jacobian)
    }
}
