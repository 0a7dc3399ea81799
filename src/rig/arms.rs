//! Arms as rays at right angles to them see them, which are finer than cells.

use super::arm_curve::{Arm, ArmCurve};
use super::front_view::FrontView;
use super::silhouette::{GridFrame, RayGrid};
use crate::geometry::median;
use glam::{DVec2, DVec3};

/// The line of an arm is that between these shares of its branch, from the shoulder on: from the first one on it is clear of the
/// trunk.
const LINE_RANGE: (f64, f64) = (0.25, 0.9);
/// An arm less of whose length than this shows from the front is held towards it or away from it.
const SHOWS: f64 = 0.5;
/// Sections along an arm and inside of its branch's end. One is up to 1.4 % of an arm, some 0.006 H: a cell of the solid.
const STATIONS: usize = 120;
/// The shoulder joint lies so many arm radii over the middle of the arm, which hangs from it. Seen: ±30 % moves
/// joints by under 0.0005 H.
const SHOULDER_OVER: f64 = 0.2;
/// A section this much wider than that `WITHIN` further out has trunk in it, for a sleeve widens more slowly, and one
/// this much wider than all that is clear of the trunk.
const TRUNK_WIDENS: f64 = 2.0;
/// What `TRUNK_WIDENS` compares lies this share of the arm's width apart.
const WITHIN: f64 = 0.6;
/// The line of an arm that hangs straight down is taken to run outwards by at least this. Seen: .2 to .3 change no joint.
const STEEPEST: f64 = 0.25;
/// Rays go on beyond the tip by this, in heights, or the last ones would miss it.
const BEYOND_TIP: f64 = 0.015;
/// Rays begin inside of where the branch ends by this share of the arm's length: a branch may end on the upper arm.
const INSIDE: f64 = 0.7;
/// Rays reach this share of the arm's length to either side of the arm: far enough that a trunk is seen to be wider.
const SPAN: f64 = 0.5;
/// Middles are means over so many sections to either side. Seen: ±30 % moves joints by under 0.0005 H.
const SMOOTHED: usize = 3;

/// The arm of a `branch` from rays at right angles to its line: its sections from the tip inwards, up to the armpit, where
/// they have trunk in them or the rays begin. `None` of an arm that the front does not show.
pub fn seen_by_rays(view: &FrontView, branch: &Arm, left: bool) -> Option<Arm> {
    let side = if left { 1.0 } else { -1.0 };
    // Distances from the axis, and heights.
    let flat = |p: DVec3| DVec2::new(side * (p.x - view.axis), p.y);
    let [from, to] = [LINE_RANGE.0, LINE_RANGE.1].map(|share| branch.curve.at_share(share));
    let way = flat(to) - flat(from);
    let along = way.try_normalize().filter(|_| way.length() > SHOWS * from.distance(to))?;
    let through = 0.5 * (flat(from) + flat(to));
    let start = through + along * (branch.pit - through).dot(along);
    let length = (flat(branch.tip) - start).dot(along) + BEYOND_TIP;
    // No further in than the axis.
    let inside = (INSIDE * length).min(start.x / along.x.max(STEEPEST)).max(0.0);
    let cell = (inside + length) / STATIONS as f64;
    if cell.is_nan() || cell <= 0.0 {
        return None;
    }
    // Rows count upwards on both sides.
    let (right, up) = (DVec3::new(side * along.x, along.y, 0.0), DVec3::new(-side * along.y, along.x, 0.0));
    let rows = 2 * (SPAN * length / cell).ceil() as usize;
    let begin = start - along * inside;
    let origin = view.point(left, begin.x, begin.y, 0.0) - up * (0.5 * rows as f64 * cell);
    let frame = GridFrame { origin, right, up, cell, columns: STATIONS, rows };
    let grid = RayGrid::new(view.positions, &view.triangles, frame, view.threads);
    let stations = stations(&grid, ((inside + LINE_RANGE.0 * length) / cell) as usize);
    // The radius is read from the first third.
    let first = stations.first().filter(|_| stations.len() > 2)?;
    let below = DVec2::new(along.y, -along.x);
    let pit = flat(first.centre) + 0.5 * first.width * below;
    let sections = stations.iter().map(|station| (station.centre, station.width + station.depth));
    let curve = ArmCurve::new(sections, SMOOTHED);
    let radius = curve.radius();
    let upper = curve.upper();
    // The shoulder joint lies straight over the armpit.
    let inwards = (flat(upper).x - pit.x) / along.x.max(STEEPEST);
    let shoulder = upper - right * inwards + DVec3::Y * SHOULDER_OVER * radius;
    Some(curve.joints(shoulder, right, pit))
}

/// A section at right angles to an arm.
struct Station {
    centre: DVec3,
    /// In the plane of the view.
    width: f64,
    depth: f64,
}

/// The section of a column that is nearest to a row, which becomes its own middle one.
fn station(grid: &RayGrid, column: usize, middle: &mut usize) -> Option<Station> {
    let GridFrame { origin, right, up, cell, .. } = grid.frame;
    let off =
        |&(begin, end): &(usize, usize)| begin.saturating_sub(*middle).max((*middle + 1).saturating_sub(end));
    let (begin, end) = grid.runs_of_column(column).into_iter().min_by_key(off)?;
    let (back, front) = grid.limb((begin..end).map(|row| (column, row)))?;
    *middle = (begin + end) / 2;
    let at = origin + right * ((column as f64 + 0.5) * cell) + up * (0.5 * (begin + end) as f64 * cell);
    // Depths count along z or against it.
    let centre = at.with_z(right.cross(up).z.signum() * 0.5 * (back + front));
    Some(Station { centre, width: (end - begin) as f64 * cell, depth: front - back })
}

/// The arm's sections from the armpit to the tip, followed both ways from the column where it is clear of the trunk.
fn stations(grid: &RayGrid, clear: usize) -> Vec<Station> {
    let mut middle = grid.frame.rows / 2;
    let mut stations: Vec<Station> =
        (clear..STATIONS).filter_map(|column| station(grid, column, &mut middle)).collect();
    stations.reverse();
    let mut widths: Vec<f64> = stations.iter().map(|s| s.width).collect();
    let (usual, widest) = (median(&mut widths), widths.iter().copied().fold(0.0, f64::max));
    let apart = ((WITHIN * usual / grid.frame.cell).round() as usize).max(1);
    let mut middle = grid.frame.rows / 2;
    for column in (0..clear).rev() {
        let Some(section) = station(grid, column, &mut middle) else { break };
        let outer = stations.get(stations.len().saturating_sub(apart)).map_or(widest, |s| s.width);
        if section.width > TRUNK_WIDENS * outer.min(widest) {
            break;
        }
        stations.push(section);
    }
    stations.reverse();
    stations
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Front and back of what is so far from the line y = 0, at places along x.
    fn sheets(outline: &[(f64, f64)]) -> (Vec<DVec3>, Vec<[u32; 3]>) {
        let corners = |&(x, half): &(f64, f64)| {
            [(-1.0, -1.0), (1.0, -1.0), (-1.0, 1.0), (1.0, 1.0)]
                .map(|(y, z)| DVec3::new(x, y * half, 0.03 * z))
        };
        let positions = outline.iter().flat_map(corners).collect();
        let quads = (0..outline.len() as u32 - 1).map(|at| 4 * at);
        let triangles = quads.flat_map(|at| {
            let [low, high, next_low, next_high] = [at, at + 1, at + 4, at + 5];
            let back = [[low, high, next_low], [next_low, high, next_high]];
            back.into_iter().flat_map(|[a, b, c]| [[a, b, c], [c + 2, b + 2, a + 2]])
        });
        (positions, triangles.collect())
    }

    #[test]
    fn a_sleeve_that_widens_is_no_trunk() {
        // A forearm, a sleeve that is two and a half times as wide where it ends, and a trunk.
        let outline = [(0.6, 0.02), (0.35, 0.02), (0.15, 0.05), (0.149, 0.28), (0.0, 0.28)];
        let (positions, triangles) = sheets(&outline);
        let (cell, columns) = (0.005, STATIONS);
        let frame =
            GridFrame { origin: DVec3::Y * -0.3, right: DVec3::X, up: DVec3::Y, cell, columns, rows: 120 };
        let grid = RayGrid::new(&positions, &triangles, frame, 1);
        let first = stations(&grid, 60).first().map(|station| (station.centre.x, station.width)).unwrap();
        // The outermost whole column of the sleeve, as wide as the sleeve is in its middle.
        assert!((first.0 - 0.1525).abs() < 1e-9, "{first:?}");
        assert!((first.1 - 2.0 * (0.05 - 0.15 * 0.0025)).abs() < 2.0 * cell, "{first:?}");
    }
}
