//! The cotangent Laplacian of a triangle mesh, and sparse symmetric positive definite systems: the only file that knows
//! faer.
//!
//! Pinkall and Polthier. Computing discrete minimal surfaces and their conjugates. Experimental Mathematics 2(1), 1993.

use super::{Rows, by_number};
use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::llt::factor::LltRegularization;
use faer::sparse::linalg::cholesky::{
    CholeskySymbolicParams, LltRef, SymbolicCholesky, SymmetricOrdering, factorize_symbolic_cholesky,
};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMat};
use faer::{Conj, MatMut, Par, Side, Spec};
use glam::DVec3;
use std::sync::Arc;

/// The largest cotangent of a triangle. A sharper needle counts as a whole so much less that its largest cotangent is
/// this one: its corners are one point as far as heat can tell, and beside larger numbers those of its neighbours would
/// drown in rounding. Scaled as a whole, because clamped one by one the cotangents would not stay positive
/// semi-definite. Seen: ±30 % moves no vertex.
const LARGEST_COTANGENT: f64 = 1e5;

/// Triangles whose area is below this share of their longest side's square have none: nothing but rounding is left of
/// their angles. Seen: ±30 % moves no vertex.
const LEAST_AREA: f64 = 1e-12;

/// Right-hand sides that are solved for together: a fixed number, so that threads and memory change no bit. Time alone.
pub const COLUMNS: usize = 4;

/// A symmetric matrix in the making: entries may come in any order and add up.
#[derive(Clone, Debug, Default)]
pub struct Laplacian {
    /// Off-diagonal entries (row, column, value), row > column, one a pair: -(cot a + cot b) / 2 where the mesh is a
    /// manifold, the sum over all triangles at the edge elsewhere. In order of rows, then columns.
    pub off_diagonal: Vec<(u32, u32, f64)>,
    /// The diagonal: the negated sum of each row's other entries, so that rows sum to 0.
    pub diagonal: Vec<f64>,
    /// A third of the area of each vertex's triangles.
    pub areas: Vec<f64>,
}

/// The cotangents at a triangle's corners, and its area; `None` where it has no area.
fn cotangents([a, b, c]: [DVec3; 3]) -> Option<([f64; 3], f64)> {
    let (ab, bc, ca) = (b - a, c - b, a - c);
    let double_area = ab.cross(bc).length();
    let longest = ab.length_squared().max(bc.length_squared()).max(ca.length_squared());
    // Also where either is not a number.
    if !(double_area > LEAST_AREA * longest && longest.is_finite()) {
        return None;
    }
    let cotangents = [-ab.dot(ca), -bc.dot(ab), -ca.dot(bc)].map(|dot| dot / double_area);
    let largest = cotangents.iter().fold(LARGEST_COTANGENT, |largest, x| largest.max(x.abs()));
    Some((cotangents.map(|x| x * (LARGEST_COTANGENT / largest)), 0.5 * double_area))
}

/// Whether a triangle has an area, as far as the Laplacian can tell.
pub fn has_area(corners: [DVec3; 3]) -> bool {
    cotangents(corners).is_some()
}

/// The positive semi-definite cotangent Laplacian of `triangles` over `positions`.
///
/// Triangles without an area (or with corners that coincide) are left out. Edges may have any number of triangles. All
/// numbers are finite as long as the squares of the coordinates are; a cotangent is at most 1e5.
///
/// O(triangles).
///
/// # Panics
/// A triangle uses a vertex that is not there.
pub fn cotangent_laplacian(positions: &[DVec3], triangles: &[[u32; 3]]) -> Laplacian {
    let mut diagonal = vec![0.0; positions.len()];
    let mut areas = vec![0.0; positions.len()];
    let mut halves = Vec::with_capacity(3 * triangles.len());
    for corners in triangles {
        let Some((cotangents, area)) = cotangents(corners.map(|vertex| positions[vertex as usize])) else {
            continue;
        };
        for corner in 0..3 {
            let (one, two) = (corners[(corner + 1) % 3], corners[(corner + 2) % 3]);
            let half = 0.5 * cotangents[corner];
            halves.push((one.max(two), one.min(two), -half));
            diagonal[one as usize] += half;
            diagonal[two as usize] += half;
            areas[corners[corner] as usize] += area / 3.0;
        }
    }
    Laplacian { off_diagonal: sum_entries(positions.len(), halves.iter().copied()), diagonal, areas }
}

/// The entries by row and then column, one a pair; those of one pair are added in the order given.
fn sum_entries(
    row_count: usize,
    entries: impl Iterator<Item = (u32, u32, f64)> + Clone,
) -> Vec<(u32, u32, f64)> {
    let mut rows = by_number(row_count, entries.map(|(row, column, value)| (row, (column, value))));
    let mut summed: Vec<(u32, u32, f64)> = Vec::with_capacity(rows.things.len() / 2 + 1);
    for row in 0..row_count {
        let entries = rows.of_mut(row);
        entries.sort_by_key(|&(column, _)| column);
        for same in entries.chunk_by(|one, other| one.0 == other.0) {
            let sum = same[1..].iter().fold(same[0].1, |sum, entry| sum + entry.1);
            summed.push((row as u32, same[0].0, sum));
        }
    }
    summed
}

/// A sparse symmetric matrix apart from its diagonal, made ready to be factored with one diagonal or several.
#[derive(Clone, Debug)]
pub struct Symbolic(Arc<Pattern>);

#[derive(Debug)]
struct Pattern {
    /// The upper triangle by columns; the diagonal is the last entry of each.
    upper: SymbolicSparseColMat<u32>,
    /// Its values, 0 on the diagonal.
    values: Vec<f64>,
    factor: SymbolicCholesky<u32>,
}

impl Symbolic {
    /// Orders and analyses the matrix of `size` rows with the given strictly lower entries (row > column; repeated ones
    /// add up).
    ///
    /// `None` where the factor would have more than 2^31 entries, or an entry is not below the diagonal.
    pub fn new(size: usize, lower: &[(u32, u32, f64)]) -> Option<Self> {
        if lower.iter().any(|&(row, column, _)| row <= column || row as usize >= size) {
            return None;
        }
        // A row of the lower triangle is a column of the upper one, and the diagonal comes last in both.
        let diagonal = (0..size as u32).map(|row| (row, row, 0.0));
        let entries = sum_entries(size, lower.iter().copied().chain(diagonal));
        if i32::try_from(entries.len()).is_err() {
            return None;
        }
        let by_column = entries.iter().map(|&(column, row, value)| (column, (row, value)));
        let Rows { starts, things } = by_number(size, by_column);
        let (rows, values) = things.into_iter().unzip();
        let upper = SymbolicSparseColMat::new_checked(size, size, starts, None, rows);
        let (ordering, how) = (SymmetricOrdering::Amd, CholeskySymbolicParams::default());
        let factor = factorize_symbolic_cholesky(upper.as_ref(), Side::Upper, ordering, how).ok()?;
        Some(Self(Arc::new(Pattern { upper, values, factor })))
    }

    /// The number of rows.
    pub fn size(&self) -> usize {
        self.0.upper.ncols()
    }
}

/// The Cholesky factor of a sparse symmetric positive definite matrix.
#[derive(Debug)]
pub struct Cholesky {
    symbolic: Symbolic,
    values: Vec<f64>,
}

impl Cholesky {
    /// Factors the matrix with the given diagonal and strictly lower entries (row > column; repeated ones add up).
    /// `None` where it is not positive definite.
    pub fn new(diagonal: &[f64], lower: &[(u32, u32, f64)]) -> Option<Self> {
        Self::with(&Symbolic::new(diagonal.len(), lower)?, diagonal)
    }

    /// Factors the matrix with the given diagonal. `None` where it is not positive definite.
    ///
    /// # Panics
    /// `diagonal` has not as many entries as the matrix has rows.
    pub fn with(symbolic: &Symbolic, diagonal: &[f64]) -> Option<Self> {
        let pattern = &*symbolic.0;
        assert_eq!(diagonal.len(), symbolic.size(), "a diagonal has one entry for each row");
        let mut entries = pattern.values.clone();
        for (&end, &value) in pattern.upper.col_ptr()[1..].iter().zip(diagonal) {
            entries[end as usize - 1] = value;
        }
        let factor = &pattern.factor;
        let matrix = SparseColMatRef::new(pattern.upper.as_ref(), &entries);
        let (regularization, how) = (LltRegularization::default(), Spec::default());
        let mut memory = MemBuffer::new(factor.factorize_numeric_llt_scratch::<f64>(Par::Seq, how));
        let memory = MemStack::new(&mut memory);
        let mut values = vec![0.0; factor.len_val()];
        factor
            .factorize_numeric_llt(&mut values, matrix, Side::Upper, regularization, Par::Seq, memory, how)
            .ok()?;
        // Comparisons with what is not a number pass unseen.
        let is_finite = values.iter().all(|value| value.is_finite());
        is_finite.then(|| Self { symbolic: symbolic.clone(), values })
    }

    /// Solves for `column_count` right-hand sides that stand one after the other in `columns`, in place.
    ///
    /// Each column's solution has the same bits, however many are solved for at once.
    ///
    /// # Panics
    /// `columns` has not `column_count` times as many entries as the matrix has rows.
    pub fn solve(&self, columns: &mut [f64], column_count: usize) {
        let size = self.symbolic.size();
        assert_eq!(columns.len(), size * column_count, "each column has one entry for each row");
        if size == 0 {
            return;
        }
        let factor = &self.symbolic.0.factor;
        for block in columns.chunks_mut(COLUMNS * size) {
            let count = block.len() / size;
            let mut memory = MemBuffer::new(factor.solve_in_place_scratch::<f64>(count, Par::Seq));
            let memory = MemStack::new(&mut memory);
            let block = MatMut::from_column_major_slice_mut(block, size, count);
            LltRef::new(factor, &self.values).solve_in_place_with_conj(Conj::No, block, Par::Seq, memory);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A grid of `side` by `side` vertices with a hump, each square halved.
    fn hump(side: u32) -> (Vec<DVec3>, Vec<[u32; 3]>) {
        let positions = (0..side * side)
            .map(|i| {
                let (x, y) = (f64::from(i % side), f64::from(i / side));
                DVec3::new(x, y, (0.7 * x).sin() * (0.4 * y).cos())
            })
            .collect();
        let corners = (0..side - 1).flat_map(|y| (0..side - 1).map(move |x| y * side + x));
        let triangles =
            corners.flat_map(|i| [[i, i + 1, i + side], [i + 1, i + side + 1, i + side]]).collect();
        (positions, triangles)
    }

    fn times(laplacian: &Laplacian, x: &[f64]) -> Vec<f64> {
        let mut y: Vec<f64> = x.iter().zip(&laplacian.diagonal).map(|(x, d)| x * d).collect();
        for &(row, column, value) in &laplacian.off_diagonal {
            y[row as usize] += value * x[column as usize];
            y[column as usize] += value * x[row as usize];
        }
        y
    }

    #[test]
    fn an_equilateral_triangle_has_cotangents_of_one_over_the_root_of_three() {
        let corners = [DVec3::ZERO, DVec3::X, DVec3::new(0.5, 0.75_f64.sqrt(), 0.0)];
        let laplacian = cotangent_laplacian(&corners, &[[0, 1, 2]]);
        let half = 0.5 / 3.0_f64.sqrt();
        assert_eq!(laplacian.off_diagonal.len(), 3);
        for (&(row, column, value), pair) in laplacian.off_diagonal.iter().zip([(1, 0), (2, 0), (2, 1)]) {
            assert_eq!((row, column), pair);
            assert!((value + half).abs() < 1e-15);
        }
        for vertex in 0..3 {
            assert!((laplacian.diagonal[vertex] - 2.0 * half).abs() < 1e-15);
            assert!((laplacian.areas[vertex] - 0.75_f64.sqrt() / 6.0).abs() < 1e-15);
        }
    }

    #[test]
    fn linear_functions_on_a_plane_have_no_laplacian_inside() {
        let (mut positions, triangles) = hump(7);
        for (i, p) in positions.iter_mut().enumerate() {
            // Irregular, and with obtuse triangles.
            *p = DVec3::new(p.x + 0.3 * (i as f64).sin(), p.y + 0.3 * (i as f64 * 1.7).cos(), 0.0);
        }
        let laplacian = cotangent_laplacian(&positions, &triangles);
        let linear: Vec<f64> = positions.iter().map(|p| 2.0 * p.x - 3.0 * p.y + 1.0).collect();
        let residual = times(&laplacian, &linear);
        for y in 1..6 {
            for x in 1..6 {
                assert!(residual[y * 7 + x].abs() < 1e-12, "{x} {y}");
            }
        }
    }

    #[test]
    fn energies_are_never_negative_and_constants_have_none() {
        let (mut positions, mut triangles) = hump(9);
        // Needles, caps, and an edge with four triangles.
        positions[40] = positions[41] + DVec3::splat(1e-9);
        positions[20] = positions[19].lerp(positions[21], 0.5) + DVec3::Z * 1e-8;
        triangles.extend([[0, 1, 50], [0, 1, 60], [5, 5, 6], [7, 8, 8]]);
        let laplacian = cotangent_laplacian(&positions, &triangles);
        assert!(laplacian.diagonal.iter().chain(&laplacian.areas).all(|x| x.is_finite()));
        let scale = laplacian.diagonal.iter().fold(0.0_f64, |most, x| most.max(*x));
        assert!(scale < 1e7);
        assert!(times(&laplacian, &[1.0; 81]).iter().all(|y| y.abs() < 1e-15 * 100.0 * scale));
        for seed in 0..200 {
            let x: Vec<f64> = (0..81).map(|i| f64::from(i * (seed + 3)).sin()).collect();
            let energy: f64 = x.iter().zip(times(&laplacian, &x)).map(|(x, y)| x * y).sum();
            assert!(energy > 0.0, "{seed}");
        }
    }

    #[test]
    fn a_system_is_solved_for_any_number_of_columns_and_diagonals() {
        for side in [2, 9, 40] {
            let (positions, triangles) = hump(side);
            let laplacian = cotangent_laplacian(&positions, &triangles);
            let size = positions.len();
            let symbolic = Symbolic::new(size, &laplacian.off_diagonal).unwrap();
            for share in [0.01, 1.0, 100.0] {
                let added: Vec<f64> = laplacian.areas.iter().map(|area| share * area).collect();
                let diagonal: Vec<f64> = laplacian.diagonal.iter().zip(&added).map(|(d, a)| d + a).collect();
                let cholesky = Cholesky::with(&symbolic, &diagonal).unwrap();
                let wanted: Vec<f64> = (0..19 * size).map(|i| (i as f64 * 0.37).sin()).collect();
                let mut columns = Vec::new();
                for x in wanted.chunks(size) {
                    let y = times(&laplacian, x);
                    columns.extend(y.iter().zip(x.iter().zip(&added)).map(|(y, (x, a))| y + x * a));
                }
                let mut alone = columns[5 * size..6 * size].to_vec();
                cholesky.solve(&mut columns, 19);
                for (found, wanted) in columns.iter().zip(&wanted) {
                    assert!((found - wanted).abs() < 1e-9, "{found} {wanted}");
                }
                cholesky.solve(&mut alone, 1);
                assert!(alone == columns[5 * size..6 * size]);
            }
        }
    }

    #[test]
    fn repeated_entries_add_up_in_any_order() {
        // 4 1 0; 1 3 2; 0 2 5
        let lower = [(2, 1, 0.5), (1, 0, 1.0), (2, 1, 1.5)];
        let cholesky = Cholesky::new(&[4.0, 3.0, 5.0], &lower).unwrap();
        let mut x = [6.0, 13.0, 19.0];
        cholesky.solve(&mut x, 1);
        for (x, wanted) in x.iter().zip([1.0, 2.0, 3.0]) {
            assert!((x - wanted).abs() < 1e-14);
        }
    }

    #[test]
    fn what_is_not_positive_definite_has_no_factor() {
        assert!(Cholesky::new(&[1.0, 1.0], &[(1, 0, 2.0)]).is_none());
        assert!(Cholesky::new(&[0.0], &[]).is_none());
        assert!(Cholesky::new(&[f64::NAN, 1.0], &[(1, 0, 0.5)]).is_none());
        assert!(Cholesky::new(&[1.0, 1.0], &[(1, 0, f64::INFINITY)]).is_none());
        assert!(Cholesky::new(&[1.0, 1.0], &[(1, 1, 1.0)]).is_none());
        assert!(Cholesky::new(&[1.0, 1.0], &[(2, 1, 1.0)]).is_none());
    }

    #[test]
    fn nothing_is_solved_for_nothing() {
        Cholesky::new(&[], &[]).unwrap().solve(&mut [], 5);
        Cholesky::new(&[2.0], &[]).unwrap().solve(&mut [], 0);
        let nothing = cotangent_laplacian(&[], &[]);
        assert!(nothing.off_diagonal.is_empty() && nothing.diagonal.is_empty() && nothing.areas.is_empty());
    }
}
