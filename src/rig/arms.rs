//! Arms: followed from the fingertips inwards to the armpit.

use super::arm_curve::{Arm, ArmCurve};
use super::front_view::FrontView;
use super::head_line::middle;
use super::silhouette::{GridFrame, RayGrid};
use crate::geometry::{ROUNDING, median};
use glam::{DVec2, DVec3};
use std::ops::Range;

/// An arm's column of cells that reaches lower than the arm by so many of its thicknesses belongs to the trunk. Seen:
/// at +30 %, joints lie 0.0005 H further off.
const PIT_DROP: f64 = 0.8;
/// Where the trunk begins, its side reaches down from the arm by this share of the way to the crotch. Seen: ±30 %
/// changes no joint.
const TRUNK_DROP: f64 = 0.3;
/// The trunk's side reaches down from the arm by at least so many heights: a hand that hangs beside the crotch is no trunk.
const LEAST_DROP: f64 = 0.06;
/// The trunk's side reaches down by `TRUNK_DROP` within this distance of where the trunk begins, in heights: that of a
/// cuff or a thick sleeve does not. Seen: ±30 % changes no joint.
const TRUNK_WITHIN: f64 = 0.04;
/// The share of an arm, from the tip, to which its line is fitted. Seen: ±30 % moves joints by under 0.0005 H.
const LINE_RANGE: (f64, f64) = (0.25, 0.9);
/// Sections along an arm. One is 0.8 % of an arm, some 0.003 H: a tenth of what joints are off in the mean.
const STATIONS: usize = 120;
/// The shoulder joint lies straight over a point this many arm radii outside of the armpit. Seen: at -30 %, four fewer
/// joints off by over 0.06 H.
const SHOULDER_OUT: f64 = 0.4;
/// The shoulder joint lies so many arm radii over the middle of the arm, which hangs from it. Seen: ±30 % moves
/// joints by under 0.0005 H.
const SHOULDER_OVER: f64 = 0.2;
/// Following starts at this share of the arm, where it is clear of the trunk. Seen: ±30 % moves joints by under
/// 0.0005 H.
const CLEAR: f64 = 0.25;
/// A section this much wider than the arm has trunk in it. Seen: ±30 % moves joints by under 0.0005 H.
const TRUNK_WIDENS: f64 = 1.7;
/// An arm that runs forward by more than this, of what it runs aside, is held forward.
const FORWARD: f64 = 0.4;

/// Where no armpit is seen the arm begins at this distance from the axis. Seen: ±30 % changes no joint.
const PIT_BY_RATIO: f64 = 0.1;
/// The line of an arm that hangs straight down is taken to run outwards by at least this. Seen: .2 to .3 change no joint.
const STEEPEST: f64 = 0.25;
/// Rays go on beyond the tip, or the last ones would miss it. Seen: at -30 %, joints lie 0.030 H further off, 58 more
/// by over 0.06 H, 37 more good joints doubted.
const BEYOND_TIP: f64 = 1.02;
/// Rays begin inside of the armpit by this share of the arm's length. Seen: ±30 % moves joints by under 0.0005 H.
const INSIDE_OF_PIT: f64 = 0.25;
/// Rays reach this share of the arm's length to either side of the arm. Seen: ±30 % moves joints by under 0.0005 H.
const SPAN: f64 = 0.35;
/// Fewer columns, or sections, are no arm. Seen: ±30 % changes no joint.
const LEAST_STATIONS: usize = 12;
/// Middles are means over so many sections to either side. Seen: ±30 % moves joints by under 0.0005 H.
const SMOOTHED: usize = 3;

/// Finds one arm that reaches aside. `None` where nothing sticks out.
///
/// - `crotch`: its height.
/// - `heights`: hands end above the first; what is above the second is head, hair and hat.
/// - `most`: how far from the axis an arm can reach.
pub fn find_arm(view: &FrontView, left: bool, crotch: f64, heights: &Range<f64>, most: f64) -> Option<Arm> {
    let cell = view.cell();
    let (floor_row, ceiling_row) = (view.grid.row(heights.start), (heights.end / cell).ceil() as usize);
    let runs = |steps: usize| {
        let all = view.grid.runs_of_column(view.column(left, steps)).into_iter();
        all.filter(move |run| run.0 < ceiling_row).map(move |(low, high)| (low, high.min(ceiling_row)))
    };
    let columns = view.half_columns().min(((most / cell).ceil() as usize).saturating_add(1));
    let (outermost, run) = (0..columns)
        .rev()
        .find_map(|steps| runs(steps).rev().find(|run| run.1 > floor_row).map(|run| (steps, run)))?;
    // Inwards, column by column.
    let mut path: Vec<(usize, (usize, usize))> = vec![(outermost, run)];
    let mut pit = None;
    let inwards = |steps: usize, run: (usize, usize)| {
        let middle = 0.5 * (run.0 + run.1) as f64;
        let off = |run: &(usize, usize)| (run.0 as f64 - middle).max(middle - run.1 as f64).max(0.0);
        runs(steps).min_by(|a, b| off(a).total_cmp(&off(b)).then(b.1.cmp(&a.1)))
    };
    let crotch_row = crotch / cell;
    let reaches_down = |steps: usize, from: f64, run: (usize, usize)| {
        let within = (TRUNK_WITHIN / cell) as usize;
        (steps.saturating_sub(within)..=steps).any(|steps| {
            inwards(steps, (from as usize, run.1)).is_some_and(|run| {
                (run.0 as f64) < from - (TRUNK_DROP * (from - crotch_row)).max(LEAST_DROP / cell)
            })
        })
    };
    for steps in (0..outermost).rev() {
        let next = inwards(steps, path[path.len() - 1].1)?;
        // A drop of the lower side below where the arm has run so far.
        if path.len() >= LEAST_STATIONS {
            let (low, thickness) = lower_side(&path, steps);
            if (next.0 as f64) < low - PIT_DROP * thickness && reaches_down(steps, low, next) {
                pit = Some(steps + 1);
                break;
            }
        }
        path.push((steps, next));
    }
    let pit_seen = pit.is_some();
    let pit_steps = pit.unwrap_or(((PIT_BY_RATIO / cell) as usize).min(outermost.saturating_sub(1)));
    path.retain(|&(steps, _)| steps >= pit_steps);
    let length = path.len();
    if length < LEAST_STATIONS {
        return None;
    }
    let fitted: Vec<DVec2> = path
        [(LINE_RANGE.0 * length as f64) as usize..(LINE_RANGE.1 * length as f64) as usize]
        .iter()
        .map(|&(steps, run)| DVec2::new(view.distance(steps), 0.5 * (run.0 + run.1) as f64 * cell))
        .collect();
    let (through, slope) = fit(&fitted);
    let along = DVec2::new(1.0, slope).normalize();
    let pit = DVec2::new(pit_steps as f64 * cell, path[length - 1].1.0 as f64 * cell);
    // The foot of the pit on the line, and of the tip.
    let start = through + along * (pit - through).dot(along);
    let length = (view.distance(outermost) - start.x) / along.x.max(STEEPEST);
    joints(view, left, &ArmLine { along, pit, start, length }, pit_seen)
}

/// Where the lower side of the arm would be at `steps`, in rows, and how thick the arm is there.
fn lower_side(path: &[(usize, (usize, usize))], steps: usize) -> (f64, f64) {
    // The inner half of what has been followed: the hand does not count.
    let inner = &path[path.len() / 2..];
    let mut thickness: Vec<f64> = inner.iter().map(|(_, run)| (run.1 - run.0) as f64).collect();
    let points: Vec<DVec2> =
        inner.iter().map(|&(steps, run)| DVec2::new(steps as f64, run.0 as f64)).collect();
    let (through, slope) = fit(&points);
    (through.y + slope * (steps as f64 - through.x), median(&mut thickness))
}

/// A line through points, by least squares: a point of it and its slope.
fn fit(points: &[DVec2]) -> (DVec2, f64) {
    let count = points.len().max(1) as f64;
    let mean = points.iter().sum::<DVec2>() / count;
    let (mut xx, mut xy) = (0.0, 0.0);
    for p in points {
        xx += (p.x - mean.x).powi(2);
        xy += (p.x - mean.x) * (p.y - mean.y);
    }
    (mean, if xx > 0.0 { xy / xx } else { 0.0 })
}

/// The line of an arm as seen from the front: distances from the axis, and heights.
struct ArmLine {
    /// Its way to the hand, of length 1.
    along: DVec2,
    /// The armpit.
    pit: DVec2,
    /// The foot of the armpit on it.
    start: DVec2,
    /// From there to the tip.
    length: f64,
}

/// A section at right angles to an arm.
struct Station {
    centre: DVec3,
    /// In the plane of the view.
    width: f64,
    depth: f64,
}

/// Where rays at right angles to an arm's line start, and the column over the armpit; `None` where the arm has no length.
fn ray_frame(view: &FrontView, left: bool, line: &ArmLine) -> Option<(GridFrame, usize)> {
    let sign = if left { 1.0 } else { -1.0 };
    let length = line.length * BEYOND_TIP;
    if length.is_nan() || length <= ROUNDING {
        return None;
    }
    let inside = INSIDE_OF_PIT * length;
    let cell = (length + inside) / STATIONS as f64;
    let rows = 2 * (SPAN * length / cell).ceil() as usize;
    let right = DVec3::new(sign * line.along.x, line.along.y, 0.0);
    // Rows count upwards on both sides.
    let up = DVec3::new(-sign * line.along.y, line.along.x, 0.0);
    let begin = line.start - line.along * inside;
    let origin = view.point(left, begin.x, begin.y, 0.0) - up * (0.5 * rows as f64 * cell);
    let frame = GridFrame { origin, right, up, cell, columns: STATIONS, rows };
    Some((frame, (inside / cell).round() as usize))
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

/// The arm's sections from the shoulder to the tip, followed both ways from where it is clear of the trunk.
fn stations(grid: &RayGrid, first: usize) -> Vec<Station> {
    let clear = first + (CLEAR * (STATIONS - first) as f64) as usize;
    let mut middle = grid.frame.rows / 2;
    let outwards: Vec<Station> =
        (clear..STATIONS).filter_map(|column| station(grid, column, &mut middle)).collect();
    let usual = median(&mut outwards.iter().map(|s| s.width).collect::<Vec<_>>());
    let mut middle = grid.frame.rows / 2;
    let inwards = (first..clear).rev().map_while(|column| station(grid, column, &mut middle));
    let mut stations: Vec<Station> = inwards.take_while(|s| s.width <= TRUNK_WIDENS * usual).collect();
    stations.reverse();
    stations.extend(outwards);
    stations
}

/// The joints that rays at right angles to the arm's line show.
fn joints(view: &FrontView, left: bool, line: &ArmLine, pit_seen: bool) -> Option<Arm> {
    let (frame, first) = ray_frame(view, left, line)?;
    let grid = RayGrid::new(view.positions, &view.triangles, frame, view.threads);
    let stations = stations(&grid, first);
    if stations.len() < LEAST_STATIONS {
        return None;
    }
    let sections = stations.iter().map(|station| (station.centre, station.width + station.depth));
    let curve = ArmCurve::new(sections, SMOOTHED);
    let radius = curve.radius();
    let upper = curve.upper();
    let out = line.pit.x + SHOULDER_OUT * radius;
    let inwards = ((upper.x - view.axis).abs() - out) / line.along.x.max(STEEPEST);
    let mut shoulder = upper - frame.right * inwards + DVec3::Y * SHOULDER_OVER * radius;
    let (ahead, trunk) = (curve.ahead(frame.right), middle(view, shoulder.y).0);
    if ahead > FORWARD {
        // An arm held forward begins in the depth of the trunk's middle.
        shoulder.z = (upper.z - ahead * inwards).max(trunk.min(upper.z));
    }
    Some(curve.joints(shoulder, frame.right, line.pit, pit_seen))
}
