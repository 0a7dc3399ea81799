//! Long hair (§VII): what the paper shortens by hand in a modelling program.
//!
//! Hair grows with the head, so hair that ended at the hips would end below the soles. Below the chin its height
//! follows the body instead: hair that ended at the hips still does, and it narrows from the head's width towards
//! the body's.

use crate::shape::part_weights::smoothstep;
use glam::{DMat3, DVec3};

/// The slope of the height's map at the chin, against the mean slope: 1 would be straight, 2 would come to rest at
/// the tips.
const FIRST_SLOPE: f64 = 1.5;
/// Tips are at least this wide, as a scale of the original.
const NARROWEST_TIP: f64 = 0.6;

/// Where hair below the chin goes.
#[derive(Clone, Debug, PartialEq)]
pub struct HairMap {
    /// The chin before and after: above it hair moves with the head.
    pub chin: [f64; 2],
    /// Chin to the lowest hair, before.
    pub depth: f64,
    /// Slope of the height at the chin, and the mean slope down to the tips.
    pub slopes: [f64; 2],
    /// What stays in place horizontally, before and after: the head's axis.
    pub axis: [DVec3; 2],
    /// Width and depth scale at the chin.
    pub head_width: [f64; 2],
    /// Width and depth scale at the tips.
    pub tip_width: f64,
}

impl HairMap {
    /// Hair that ended at height `bottom` ends at `new_bottom`.
    ///
    /// - `chin`, `axis`: before and after.
    /// - `head`: the head's scales: height, width, depth.
    /// - `body_girth`: the trunk's thickness scale.
    pub fn new(
        chin: [f64; 2],
        bottom: f64,
        new_bottom: f64,
        axis: [DVec3; 2],
        head: [f64; 3],
        body_girth: f64,
    ) -> Self {
        let depth = chin[0] - bottom;
        let mean = (chin[1] - new_bottom) / depth;
        Self {
            chin,
            depth,
            slopes: [head[0].min(FIRST_SLOPE * mean), mean],
            axis,
            head_width: [head[1], head[2]],
            tip_width: body_girth.max(NARROWEST_TIP).min(head[1]),
        }
    }

    /// Where the point `p` below the chin goes, and the Jacobian there.
    pub fn map(&self, p: DVec3) -> (DVec3, DMat3) {
        let d = self.chin[0] - p.y;
        let [first, mean] = self.slopes;
        let drop = first * d + (mean - first) * d * d / self.depth;
        let slope = first + 2.0 * (mean - first) * d / self.depth;
        let total = (mean * self.depth).max(1e-30);
        let t = (drop / total).clamp(0.0, 1.0);
        let fraction = smoothstep(t);
        let fraction_slope = if t > 0.0 && t < 1.0 {
            6.0 * t * (1.0 - t) / total
        } else {
            0.0
        };
        let width = self
            .head_width
            .map(|width| width + (self.tip_width - width) * fraction);
        // Widths change with the drop, and the drop grows downwards.
        let width_by_y = self
            .head_width
            .map(|width| -(self.tip_width - width) * fraction_slope * slope);
        let from = p - self.axis[0];
        let to = DVec3::new(
            self.axis[1].x + width[0] * from.x,
            self.chin[1] - drop,
            self.axis[1].z + width[1] * from.z,
        );
        let jacobian = DMat3::from_cols(
            DVec3::new(width[0], 0.0, 0.0),
            DVec3::new(width_by_y[0] * from.x, slope, width_by_y[1] * from.z),
            DVec3::new(0.0, 0.0, width[1]),
        );
        (to, jacobian)
    }
}
