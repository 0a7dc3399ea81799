//! Curves through slices: lines through what was measured, and tables of curves that are read together.

use super::{Row, STATIONS};
use crate::geometry::median;
use crate::geometry::whole::floor;
use crate::shape::product::part::TINY;

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

/// The monotone cubic through `knots` at `places`, which rise, at `x`; constant beyond the ends.
///
/// Fritsch and Carlson. Monotone piecewise cubic interpolation. SIAM Journal on Numerical Analysis 17(2), 1980; slopes as
/// Fritsch and Butland's weighted harmonic means.
pub fn monotone_cubic(places: &[f64], knots: &[f64], x: f64) -> f64 {
    let last = places.len() - 1;
    if x <= places[0] || last == 0 {
        return knots[0];
    }
    if x >= places[last] {
        return knots[last];
    }
    let at = places.partition_point(|&place| place <= x).clamp(1, last) - 1;
    let step = |at: usize| places[at + 1] - places[at];
    let rise = |at: usize| (knots[at + 1] - knots[at]) / step(at);
    let slope = |knot: usize| {
        if knot == 0 || knot == last {
            // One-sided, of three points, kept from overshooting.
            let (near, far) = if knot == 0 { (0, 1) } else { (last - 1, last.saturating_sub(2)) };
            if last == 1 {
                return rise(0);
            }
            let end = ((2.0 * step(near) + step(far)) * rise(near) - step(near) * rise(far))
                / (step(near) + step(far));
            return if end * rise(near) <= 0.0 {
                0.0
            } else if rise(near) * rise(far) <= 0.0 && end.abs() > 3.0 * rise(near).abs() {
                3.0 * rise(near)
            } else {
                end
            };
        }
        let (before, after) = (rise(knot - 1), rise(knot));
        if before * after <= 0.0 {
            return 0.0;
        }
        let (one, other) = (2.0 * step(knot) + step(knot - 1), step(knot) + 2.0 * step(knot - 1));
        (one + other) / (one / before + other / after)
    };
    let (h, t) = (step(at), (x - places[at]) / step(at));
    let (a, b) = (slope(at) * h, slope(at + 1) * h);
    let (t2, t3) = (t * t, t * t * t);
    (2.0 * t3 - 3.0 * t2 + 1.0) * knots[at]
        + (t3 - 2.0 * t2 + t) * a
        + (3.0 * t2 - 2.0 * t3) * knots[at + 1]
        + (t3 - t2) * b
}

/// Where [`bell`] ends, in widths.
const BELL_ENDS: f64 = 3.0;

/// The weight of what lies `away` from the middle, in widths: the triweight, which ends three of its standard deviations away. Rows
/// lie by parts of these widths, so one lies there to the last digit: with a step it would count or not.
pub fn bell(away: f64) -> f64 {
    let near = (1.0 - (away / BELL_ENDS).powi(2)).max(0.0);
    near * near * near
}

/// So far apart, in widths, means are taken that rows between them lie between: they differ by 2e-3 of what a bell takes away.
const MEANS_APART: f64 = 0.125;

/// Weighted means along `rows`, by a [`bell`] `sigma` wide: rows lie at `places`, which rise, or all fall where a chain is turned
/// over, and each counts for as much of the way as is its own.
pub fn smoothed<const N: usize>(rows: &[[f64; N]], places: &[f64], sigma: f64) -> Vec<[f64; N]> {
    let last = rows.len() - 1;
    let own = |row: usize| {
        let (before, after) = (row.saturating_sub(1), (row + 1).min(last));
        // An end counts for as much to both sides.
        ((places[after] - places[before]).abs() / (after - before).max(1) as f64).max(TINY)
    };
    let ways: Vec<f64> = (0..rows.len()).map(own).collect();
    let mut first = 0;
    let mut mean = |row: usize| {
        let away = |near: usize| (places[near] - places[row]).abs() / sigma;
        while away(first) > BELL_ENDS {
            first += 1;
        }
        let (mut sum, mut total) = ([0.0; N], 0.0);
        for near in (first..rows.len()).take_while(|&near| away(near) <= BELL_ENDS) {
            let weight = ways[near] * bell(away(near));
            sum.iter_mut().zip(&rows[near]).for_each(|(sum, value)| *sum += weight * value);
            total += weight;
        }
        sum.map(|sum| sum / total)
    };
    let (mut all, mut known) = (vec![mean(0)], 0);
    for row in 1..=last {
        if row == last || (places[row + 1] - places[known]).abs() > MEANS_APART * sigma {
            let (before, after) = (all[known], mean(row));
            all.extend((known + 1..row).map(|between| {
                let t = (between - known) as f64 / (row - known) as f64;
                std::array::from_fn(|at| (1.0 - t) * before[at] + t * after[at])
            }));
            all.push(after);
            known = row;
        }
    }
    all
}

/// `N` functions of one place, sampled at even steps; between the samples cubic, with a slope that has no jumps; constant
/// beyond the ends.
#[derive(Clone, Debug, PartialEq)]
pub struct Table<const N: usize> {
    start: f64,
    step: f64,
    rows: Vec<[f64; N]>,
}

impl<const N: usize> Table<N> {
    /// `functions` from `start` to `end` in `count` samples, at least 2.
    pub fn sample(start: f64, end: f64, count: usize, functions: impl Fn(f64) -> [f64; N]) -> Self {
        let step = (end - start) / (count - 1) as f64;
        Self { start, step, rows: (0..count).map(|row| functions(start + step * row as f64)).collect() }
    }

    /// The same functions without what is shorter than `sigma`, where samples come to lie at `places`: see [`smoothed`].
    pub fn smoothed(&self, sigma: f64, place: impl Fn(f64) -> f64) -> Self {
        let places: Vec<f64> =
            (0..self.rows.len()).map(|row| place(self.start + self.step * row as f64)).collect();
        Self { rows: smoothed(&self.rows, &places, sigma), ..*self }
    }

    /// The functions around `x`.
    #[inline(always)]
    pub fn at(&self, x: f64) -> Reading<'_, N> {
        let last = self.rows.len() - 1;
        let place = (x - self.start) / self.step;
        // NaN is at no place, and takes the first row.
        let (row, t) = if place.is_nan() || place <= 0.0 {
            (0, 0.0)
        } else if place >= last as f64 {
            (last - 1, 1.0)
        } else {
            (place as usize, place - floor(place))
        };
        // At the ends the slope is 0, as beyond them.
        let before = if row == 0 { 1 } else { row - 1 };
        let after = if row + 1 == last { row } else { row + 2 };
        Reading { rows: [before, row, row + 1, after].map(|row| &self.rows[row]), t, step: self.step }
    }
}

/// The functions of a [`Table`] around one place.
#[derive(Clone, Copy, Debug)]
pub struct Reading<'a, const N: usize> {
    rows: [&'a [f64; N]; 4],
    /// From the second row (0) to the third.
    t: f64,
    step: f64,
}

impl<const N: usize> Reading<'_, N> {
    /// The functions' values.
    #[inline(always)]
    pub fn values(&self) -> [f64; N] {
        let (t, t2, t3) = (self.t, self.t * self.t, self.t * self.t * self.t);
        self.mixed([2.0 * t3 - 3.0 * t2 + 1.0, t3 - 2.0 * t2 + t, 3.0 * t2 - 2.0 * t3, t3 - t2])
    }

    /// Their slopes.
    #[inline(always)]
    pub fn slopes(&self) -> [f64; N] {
        let (t, t2) = (self.t, self.t * self.t);
        self.mixed([6.0 * (t2 - t), 3.0 * t2 - 4.0 * t + 1.0, 6.0 * (t - t2), 3.0 * t2 - 2.0 * t])
            .map(|slope| slope / self.step)
    }

    /// The two rows beside the place and the slopes there, by these shares.
    #[inline(always)]
    fn mixed(&self, by: [f64; 4]) -> [f64; N] {
        let [before, from, to, after] = self.rows;
        std::array::from_fn(|function| {
            let a = 0.5 * (to[function] - before[function]);
            let b = 0.5 * (after[function] - from[function]);
            by[0] * from[function] + by[1] * a + by[2] * to[function] + by[3] * b
        })
    }
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

    #[test]
    fn wide_bells_take_means_apart_and_places_may_fall() {
        let count = 400;
        let places: Vec<f64> = (0..count).map(|row| 0.003 * f64::from(row)).collect();
        // A step, of which a bell makes its own integral.
        let rows: Vec<[f64; 1]> = places.iter().map(|&place| [if place < 0.6 { 1.0 } else { 0.0 }]).collect();
        let smooth = smoothed(&rows, &places, 0.16);
        for (row, [value]) in smooth.iter().enumerate().filter(|(row, _)| (120..280).contains(row)) {
            let weights = places.iter().map(|place| bell((place - places[row]) / 0.16));
            let all: f64 = weights.clone().sum();
            let before: f64 = weights.zip(&rows).map(|(weight, row)| weight * row[0]).sum();
            assert!((value - before / all).abs() < 2e-3, "{row}: {value} instead of {}", before / all);
        }
        let falling: Vec<f64> = places.iter().map(|place| -place).collect();
        assert_eq!(smoothed(&rows, &falling, 0.16), smooth);
    }

    #[test]
    fn the_cubic_is_monotone_meets_its_knots_and_stays_beyond_them() {
        let (places, knots) = ([0.0, 1.0, 1.5, 4.0], [1.0, 1.0, 3.0, 3.5]);
        for (place, knot) in places.iter().zip(knots) {
            assert!((monotone_cubic(&places, &knots, *place) - knot).abs() < 1e-12);
        }
        let mut last = 1.0;
        for index in -10..60 {
            let y = monotone_cubic(&places, &knots, 0.1 * f64::from(index));
            assert!(y >= last - 1e-12, "{index}");
            last = y;
        }
        assert_eq!(monotone_cubic(&places, &knots, -3.0), 1.0);
        assert_eq!(monotone_cubic(&places, &knots, 9.0), 3.5);
        // A straight line is met everywhere.
        assert!((monotone_cubic(&[0.0, 1.0, 3.0], &[0.0, 2.0, 6.0], 2.2) - 4.4).abs() < 1e-12);
    }

    #[test]
    fn slopes_of_a_table_are_its_values_slopes() {
        let table = Table::sample(-1.0, 2.0, 40, |x| [x.sin(), x * x, 3.0]);
        for index in -15..30 {
            let x = 0.083 * f64::from(index);
            let slopes = table.at(x).slopes();
            let h = 1e-6;
            let (high, low) = (table.at(x + h).values(), table.at(x - h).values());
            for function in 0..3 {
                let wanted = (high[function] - low[function]) / (2.0 * h);
                assert!((slopes[function] - wanted).abs() < 1e-5, "{x} {function}");
            }
            // In the first and the last step the curve goes over to the constant beyond: up to 4/27 of a step off.
            let step = 3.0 / 39.0;
            let off = if (-1.0 + step..2.0 - step).contains(&x) { 1e-3 } else { 4.0 / 27.0 * step };
            assert!((table.at(x).values()[0] - x.clamp(-1.0, 2.0).sin()).abs() < off, "{x}");
        }
        assert_eq!(table.at(f64::NAN).values(), table.at(-9.0).values());
    }

    #[test]
    fn smoothing_keeps_lines_and_flattens_waves() {
        let table = Table::sample(0.0, 4.0, 401, |x| [2.0 * x, (20.0 * x).sin()]).smoothed(0.2, |x| x);
        let values = table.at(2.0).values();
        assert!((values[0] - 4.0).abs() < 1e-9 && values[1].abs() < 1e-2);
    }
}
