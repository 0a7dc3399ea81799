//! Cloth weights from the nearest body surface (§IV-B, Fig. 4e).

use super::{GarmentWeights, Weighted};
use crate::character::Weights;
use crate::geometry::Surface;
use glam::DVec3;

/// A surface whose weights are known.
pub struct Source<'a> {
    /// The surface, made of `positions` and `triangles`.
    pub surface: &'a Surface,
    /// Its vertices.
    pub positions: &'a [DVec3],
    /// Its triangles.
    pub triangles: &'a [[u32; 3]],
    /// A row for each of `positions`.
    pub weights: &'a Weights,
}

/// Weights of a garment's `positions` after those of the body under it.
///
/// All in one space in which the figure is about 1 high. `manner` is `Robust` or `Nearest`.
pub fn transfer_weights(
    _source: &Source,
    _positions: &[DVec3],
    _triangles: &[[u32; 3]],
    _manner: GarmentWeights,
    _thread_count: usize,
) -> Weighted {
    unimplemented!()
}

/// Weights of a thing that keeps its shape.
pub fn rigid_weights(_source: &Source, _positions: &[DVec3], _triangles: &[[u32; 3]]) -> Weighted {
    unimplemented!()
}
