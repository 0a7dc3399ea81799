//! Body weights through a voxel volume, for open bodies (Dionne and de Lasa, reference 14).

use super::{WeightBone, Weighted};
use glam::DVec3;

/// What the volume can be told.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VoxelOptions {
    /// Voxels along the longest side.
    pub resolution: usize,
    /// How fast weights fall off, 0..1.
    pub falloff: f64,
    /// Threads to use; 0 means all cores.
    pub thread_count: usize,
}

/// Weights of all `positions` to the joints of `bones`.
///
/// Positions and bones are in one space in which the figure is about 1 high.
pub fn voxel_weights(
    _positions: &[DVec3],
    _triangles: &[[u32; 3]],
    _bones: &[WeightBone],
    _options: &VoxelOptions,
) -> Weighted {
    unimplemented!()
}

/// Why heat would be poor on this body: a sentence for a person; `None` where heat does well.
pub fn heat_would_be_poor(
    _positions: &[DVec3],
    _triangles: &[[u32; 3]],
    _bones: &[WeightBone],
) -> Option<String> {
    unimplemented!()
}
