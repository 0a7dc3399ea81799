//! Smooth lines through measured slices.

use super::{Row, STATIONS};
use crate::geometry::median;

/// How much the curvature of a line counts beside its distance from what was measured.
const CURVATURE: f64 = 0.02 * (STATIONS * STATIONS) as f64;
/// How much its slope does: enough to carry a line on where nothing was measured.
const SLOPE: f64 = 0.001;
/// Rounds in which slices that lie off weigh less.
const ROUNDS: usize = 3;
/// A slice this far off weighs half (ln of a width, or head lengths): at least this, or so many times the usual distance.
const OFF: (f64, f64) = (0.04, 1.5);
/// Fewer measured slices than this make no line.
const FEWEST: usize = 3;

/// A line through `measured` that belts, hems and cuffs hardly move; what is no finite number was not measured. `None` for fewer
/// than 3 slices, and for numbers whose squares are none.
///
/// It minimises the sum of W (z - y)^2 + .02 K^2 |D2 z|^2 + .001 |D1 z|^2 for K slices, and again with W = 1 / (1 + (r / s)^2)
/// for what is left, r = y - z.
pub fn smooth(measured: &Row) -> Option<Row> {
    let is_known = |y: &f64| y.is_finite();
    if measured.iter().filter(|y| is_known(y)).count() < FEWEST {
        return None;
    }
    let mut weights = measured.map(|y| if is_known(&y) { 1.0 } else { 0.0 });
    let mut line = fit(measured, &weights);
    for _ in 0..ROUNDS {
        let mut off: Vec<f64> =
            (0..STATIONS).map(|at| (measured[at] - line[at]).abs()).filter(is_known).collect();
        if off.len() < FEWEST {
            return None;
        }
        let far = (OFF.1 * median(&mut off)).max(OFF.0);
        for at in (0..STATIONS).filter(|&at| is_known(&measured[at])) {
            let r = (measured[at] - line[at]) / far;
            weights[at] = 1.0 / (1.0 + r * r);
        }
        line = fit(measured, &weights);
    }
    line.iter().all(|y| y.is_finite()).then_some(line)
}

/// As [`smooth`], of lengths above 0, by their logarithms.
pub fn smooth_lengths(measured: &Row) -> Option<Row> {
    smooth(&measured.map(f64::ln)).map(|line| line.map(f64::exp))
}

/// The line for one set of weights: its normal equations, of five diagonals, solved by elimination.
fn fit(measured: &Row, weights: &Row) -> Row {
    let mut matrix = [[0.0; STATIONS]; STATIONS];
    let mut right = [0.0; STATIONS];
    for at in 0..STATIONS {
        matrix[at][at] = weights[at];
        if weights[at] > 0.0 {
            right[at] = weights[at] * measured[at];
        }
    }
    let mut add = |at: usize, differences: &[f64], weight: f64| {
        for (i, a) in differences.iter().enumerate() {
            for (j, b) in differences.iter().enumerate() {
                matrix[at + i][at + j] += weight * a * b;
            }
        }
    };
    (0..STATIONS - 1).for_each(|at| add(at, &[-1.0, 1.0], SLOPE));
    (0..STATIONS - 2).for_each(|at| add(at, &[1.0, -2.0, 1.0], CURVATURE));
    // Symmetric and positive definite: no pivots needed.
    for pivot in 0..STATIONS {
        for row in pivot + 1..(pivot + 3).min(STATIONS) {
            let factor = matrix[row][pivot] / matrix[pivot][pivot];
            let above = matrix[pivot];
            for (below, above) in matrix[row].iter_mut().zip(above).skip(pivot).take(3) {
                *below -= factor * above;
            }
            right[row] -= factor * right[pivot];
        }
    }
    for row in (0..STATIONS).rev() {
        for column in row + 1..(row + 3).min(STATIONS) {
            right[row] -= matrix[row][column] * right[column];
        }
        right[row] /= matrix[row][row];
    }
    right
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_straight_line_stays_and_carries_on() {
        let line: Row = std::array::from_fn(|at| 1.0 + 0.1 * at as f64);
        let mut gaps = line;
        for at in [0, 5, 6, 12] {
            gaps[at] = f64::NAN;
        }
        let smoothed = smooth(&gaps).unwrap();
        for at in 0..STATIONS {
            // The slope counts a little, so a line's ends are drawn together a little.
            assert!((smoothed[at] - line[at]).abs() < 2e-3, "{at}: {}", smoothed[at]);
        }
    }

    #[test]
    fn a_belt_hardly_shows() {
        let mut belted = [0.4f64; STATIONS];
        belted[4] = 0.5;
        let smoothed = smooth_lengths(&belted).unwrap();
        // A quadratic fit would give the belt a quarter; weighed down it has next to nothing.
        assert!(smoothed.iter().all(|&half| (half / 0.4 - 1.0).abs() < 0.02), "{smoothed:?}");
    }

    #[test]
    fn two_slices_are_no_line() {
        let mut few = [f64::NAN; STATIONS];
        few[3] = 1.0;
        few[9] = 2.0;
        assert_eq!(smooth(&few), None);
    }

    #[test]
    fn what_is_out_of_range_makes_no_line() {
        let mut wild = [1.0; STATIONS];
        wild[2] = f64::INFINITY;
        wild[7] = f64::NAN;
        assert!(smooth(&wild).unwrap().iter().all(|&y| (y - 1.0).abs() < 1e-9));
        assert_eq!(smooth_lengths(&[0.0; STATIONS]), None);
        for huge in [1e300, -1e308] {
            assert!(smooth(&wild.map(|y| y * huge)).is_none_or(|line| line.iter().all(|y| y.is_finite())));
        }
    }
}
