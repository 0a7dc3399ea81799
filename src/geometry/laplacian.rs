//! The cotangent Laplacian of a triangle mesh, and sparse symmetric positive definite systems: the only file that knows
//! faer.

use glam::DVec3;

/// A symmetric matrix in the making: entries may come in any order and add up.
#[derive(Clone, Debug, Default)]
pub struct Laplacian {
    /// Off-diagonal entries (row, column, value), row > column, one a pair: -(cot a + cot b) / 2 where the mesh is a
    /// manifold, the sum over all triangles at the edge elsewhere.
    pub off_diagonal: Vec<(u32, u32, f64)>,
    /// The diagonal: the negated sum of each row's other entries, so that rows sum to 0.
    pub diagonal: Vec<f64>,
    /// A third of the area of each vertex's triangles.
    pub areas: Vec<f64>,
}

/// The positive semi-definite cotangent Laplacian of `triangles` over `positions`.
///
/// Triangles without an area (or with corners that coincide) are left out.
pub fn cotangent_laplacian(_positions: &[DVec3], _triangles: &[[u32; 3]]) -> Laplacian {
    unimplemented!()
}

/// The Cholesky factor of a sparse symmetric positive definite matrix.
#[derive(Debug)]
pub struct Cholesky {}

impl Cholesky {
    /// Factors the matrix with the given diagonal and strictly lower entries (row > column; repeated ones add up).
    /// `None` where it is not positive definite.
    pub fn new(_diagonal: &[f64], _lower: &[(u32, u32, f64)]) -> Option<Self> {
        unimplemented!()
    }

    /// Solves for `column_count` right-hand sides that stand one after the other in `columns`, in place.
    pub fn solve(&self, _columns: &mut [f64], _column_count: usize) {
        unimplemented!()
    }
}
