//! Painted brows: the line of the darkest skin above the eyes.
//!
//! Brows that fall towards the nose make an adult's stern look; enlarged eyes make it a cross one. Geometry alone cannot
//! tell it, and lifting every brow makes neutral faces sad: so it is read from how bright the skin is.

use super::eyes::Pair;
use super::head::{Head, quantile};
use crate::geometry::mean;
use glam::DVec2;

/// Both brows' line: where its inner and outer ends are, in distance from the middle and height, head lengths.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Brows {
    /// Half the eyes' distance aside.
    pub inner: DVec2,
    /// 1.3 of it.
    pub outer: DVec2,
}

/// Columns that are looked at, in half distances of the eyes, and how far apart they are.
const COLUMNS: (f64, f64, f64) = (0.30, 1.50, 0.006);
/// Rows that are looked at: above the upper lid, above the eyes, and how far apart they are.
const ROWS: (f64, f64, f64) = (0.025, 0.16, 0.004);
/// A brow is darker than its column's median by at least this part of that: of dark skin and of light.
const CONTRAST: f64 = 0.18;
/// Fewer columns with a brow are no brow.
const LEAST_COLUMNS: usize = 6;
/// Where the line's ends are, in half distances of the eyes.
const ENDS: (f64, f64) = (0.5, 1.3);
/// A column further from the line than two median errors and this is left out.
const OUTLIER: f64 = 0.006;

/// The line of the brows, left and right together; `None` where nobody knows how bright the skin is, or none is seen.
pub fn brows(head: &Head, pair: Pair) -> Option<Brows> {
    let d = pair.half_distance;
    let (first, last) = (pair.height + pair.half_height + ROWS.0, pair.height + ROWS.1);
    let (columns, rows) =
        (((COLUMNS.1 - COLUMNS.0) * d / COLUMNS.2) as usize, ((last - first) / ROWS.2).max(0.0) as usize);
    let reach = COLUMNS.1 * d + COLUMNS.2;
    let view =
        head.front_view(DVec2::new(-reach, first - ROWS.2), DVec2::new(reach, last + ROWS.2), ROWS.2 / 2.0);
    let place = |column: usize, row: usize| {
        DVec2::new(COLUMNS.0 * d + COLUMNS.2 * column as f64, first + ROWS.2 * row as f64)
    };
    let bright = |p: DVec2| head.shade(head.bare[view.triangle_at(p)?], p);
    // One value for both sides, so that light from one of them does not tilt the line.
    let of_both = |p: DVec2| Some(0.5 * (bright(p)? + bright(DVec2::new(-p.x, p.y))?));
    let in_column = |column: usize| (0..rows).map(|row| of_both(place(column, row))).collect();
    let grid: Vec<Vec<Option<f64>>> = (0..columns).map(in_column).collect();
    let blurred = |column: usize, row: usize| {
        let columns = column.saturating_sub(1)..(column + 2).min(columns);
        let rows = row.saturating_sub(2)..(row + 3).min(rows);
        mean(grid[columns].iter().flat_map(|column| &column[rows.clone()]).flatten().copied())
    };
    // The darkest row of each column that has a brow: distance from the middle, height, contrast.
    let darkest = |column: usize| {
        let values: Vec<(usize, f64)> =
            (0..rows).filter_map(|row| Some((row, blurred(column, row)?))).collect();
        let mut all: Vec<f64> = values.iter().map(|&(_, value)| value).collect();
        let median = quantile(&mut all, 0.5)?;
        let &(row, darkest) = values.iter().min_by(|a, b| a.1.total_cmp(&b.1))?;
        let contrast = 1.0 - darkest / median.max(1e-9);
        let DVec2 { x, y } = place(column, row);
        (contrast > CONTRAST).then_some((x, y, contrast))
    };
    let mut dark: Vec<(f64, f64, f64)> = (0..columns).filter_map(darkest).collect();
    let line = fit(&dark)?;
    let error = |&(x, y, _): &(f64, f64, f64)| (y - line.0 - line.1 * x).abs();
    let mut errors: Vec<f64> = dark.iter().map(error).collect();
    let limit = 2.0 * quantile(&mut errors, 0.5)? + OUTLIER;
    dark.retain(|point| error(point) <= limit);
    let (offset, slope) = fit(&dark)?;
    let at = |share: f64| DVec2::new(share * d, offset + slope * share * d);
    Some(Brows { inner: at(ENDS.0), outer: at(ENDS.1) })
}

/// The line through (x, y), weighted: offset and slope.
fn fit(points: &[(f64, f64, f64)]) -> Option<(f64, f64)> {
    if points.len() < LEAST_COLUMNS {
        return None;
    }
    let total: f64 = points.iter().map(|&(_, _, weight)| weight).sum();
    let mean = |of: &dyn Fn(f64, f64) -> f64| -> f64 {
        points.iter().map(|&(x, y, weight)| weight * of(x, y)).sum::<f64>() / total
    };
    let (x, y) = (mean(&|x, _| x), mean(&|_, y| y));
    let spread = mean(&|at, _| (at - x) * (at - x));
    let slope = mean(&|at, height| (at - x) * (height - y)) / spread;
    (spread > 0.0).then_some((y - slope * x, slope))
}
