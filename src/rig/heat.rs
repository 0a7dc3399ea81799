//! Body weights by heat equilibrium (Baran and Popović, reference 11).

use super::{WeightBone, Weighted};
use glam::DVec3;

/// What heat can be told.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HeatOptions {
    /// c, above 0.
    pub heat: f64,
    /// Threads to use; 0 means all cores.
    pub thread_count: usize,
}

/// Weights of all `positions` to the joints of `bones`.
///
/// Positions and bones are in one space in which the figure is about 1 high.
pub fn heat_weights(
    _positions: &[DVec3],
    _triangles: &[[u32; 3]],
    _bones: &[WeightBone],
    _options: &HeatOptions,
) -> Weighted {
    unimplemented!()
}
