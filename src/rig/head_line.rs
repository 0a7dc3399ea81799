//! The middle line: neck, chin and head above the shoulders, spine below them.

use super::front_view::FrontView;
use crate::geometry::{
    CHIN_BAND, CHIN_BY_RATIO, CHIN_STEP, ROUNDING, StepSearch, deepest_step, lowest, median,
};
use std::ops::Range;

/// A neck is narrower than this share of what is below it and of what is above it.
const NECK_NARROWS: f64 = 0.75;
/// The chin's rays start and end at these shares of the way from shoulders to crown (D25). Seen: ±30 % moves joints by
/// under 0.0005 H.
const CHIN_RANGE: (f64, f64) = (-0.05, 0.55);
/// The middle's depth is a median over this share of half the width. Seen: ±30 % moves joints by under 0.0005 H.
const MIDDLE_REACH: f64 = 0.6;
/// The middle's depth is read within no less and no more than this of the axis, in heights: a tail is narrower, arms are
/// outside. Seen: ±30 % moves joints by under 0.0005 H.
const MIDDLE_RANGE: (f64, f64) = (0.005, 0.08);

/// A crown lies at least this far over the shoulders, in heights: nothing divides by less. Seen: ±30 % changes no
/// joint.
const LEAST_HEAD: f64 = 0.02;
/// The chin's rays run within this share of the face's width, but no further from the axis than that, in heights (D25).
/// Seen: ±30 % moves joints by under 0.0005 H.
const CHIN_WITHIN: (f64, f64) = (0.08, 0.03);
/// The middle's depth is a median over this many rows to either side.
const MIDDLE_ROWS: i64 = 4;

/// Heights of the middle line above the shoulders.
#[derive(Clone, Copy, Debug)]
pub struct HeadLine {
    /// Where the neck is narrowest.
    pub neck: f64,
    /// The underside of the face.
    pub chin: f64,
    /// How far forward the chin is.
    pub chin_z: f64,
    /// The top of the head.
    pub crown: f64,
    /// True where there is a narrow place between shoulders and head.
    pub neck_seen: bool,
}

/// Looks for neck, chin and crown above `shoulder_line`.
pub fn head_line(view: &FrontView, shoulder_line: f64) -> HeadLine {
    let crown = view.high.max(shoulder_line + LEAST_HEAD);
    let span = crown - shoulder_line;
    let seen = neck(view, shoulder_line..shoulder_line + 0.5 * span);
    let neck = seen.unwrap_or(shoulder_line + 0.5 * CHIN_BY_RATIO * span);
    let chin = chin(view, shoulder_line, crown).unwrap_or(shoulder_line + CHIN_BY_RATIO * span);
    let chin_z = view.depth(view.grid.row(chin), CHIN_WITHIN.1).map_or(0.0, |(_, front)| front);
    HeadLine { neck, chin, chin_z, crown, neck_seen: seen.is_some() }
}

/// The narrowest place between two heights, where there is one: the row that is slimmest beside what is below it from the first one
/// on, and beside all that is above it. What is tied on a head is narrow too, but further up.
pub fn neck(view: &FrontView, heights: Range<f64>) -> Option<f64> {
    let first = view.grid.row(heights.start);
    let widths: Vec<f64> = (first..view.grid.row(view.high)).map(|row| view.half_width(row)).collect();
    let most = |widths: &[f64]| widths.iter().copied().fold(0.0, f64::max);
    let share =
        |index: usize| widths[index] / most(&widths[..index]).min(most(&widths[index + 1..])).max(1e-6);
    let rows = (0..widths.len()).map(|index| (index, view.grid.y(first + index)));
    let slim = rows.filter(|&(index, y)| widths[index] > 0.0 && y < heights.end);
    let shares: Vec<(f64, f64)> = slim.map(|(index, y)| (y, share(index))).collect();
    let is_slim = shares.iter().any(|&(_, share)| share < NECK_NARROWS);
    lowest(&shares).filter(|_| is_slim)
}

/// The deepest step back of the front profile, downwards.
fn chin(view: &FrontView, shoulder_line: f64, crown: f64) -> Option<f64> {
    let span = crown - shoulder_line;
    let low = view.grid.row(shoulder_line + CHIN_RANGE.0 * span);
    let high = view.grid.row(shoulder_line + CHIN_RANGE.1 * span);
    let face = (low..=high).map(|row| view.half_width(row)).fold(0.0, f64::max);
    let depths: Vec<Option<f64>> = (low..=high)
        .map(|row| view.depth(row, (CHIN_WITHIN.0 * 2.0 * face).min(CHIN_WITHIN.1)).map(|(_, front)| front))
        .collect();
    let band = ((CHIN_BAND * span / view.cell()).round() as usize).max(2);
    let search = StepSearch { band, least: CHIN_STEP * span, tie: ROUNDING, span: 1.0 };
    deepest_step(&depths, &search, |row| view.grid.y(low + row) - 0.5 * view.cell())
}

/// Depth of the middle of the trunk and half of its depth, smoothed over some rows.
pub fn middle(view: &FrontView, y: f64) -> (f64, f64) {
    let row = view.grid.row(y) as i64;
    let (mut middles, mut halves): (Vec<f64>, Vec<f64>) = (row - MIDDLE_ROWS..=row + MIDDLE_ROWS)
        .filter_map(|row| {
            let row = row.clamp(0, view.grid.frame.rows as i64 - 1) as usize;
            let reach = (MIDDLE_REACH * view.half_width(row)).clamp(MIDDLE_RANGE.0, MIDDLE_RANGE.1);
            view.depth(row, reach).map(|(back, front)| (0.5 * (back + front), 0.5 * (front - back)))
        })
        .unzip();
    (median(&mut middles), median(&mut halves))
}
