//! Arms: followed from the fingertips inwards to the armpit.

use super::front_view::{Stance, median};
use super::silhouette::{GridFrame, RayGrid, lowest};
use glam::{DVec2, DVec3};

/// An arm's column of cells that reaches lower than the arm by so many of its thicknesses belongs to the trunk.
const PIT_DROP: f64 = 0.8;
/// Where the trunk begins, its side reaches down from the arm by this part of the way to the crotch, ...
const TRUNK_DROP: f64 = 0.3;
/// ... within this distance: a cuff or a thick sleeve does not.
const TRUNK_WITHIN: f64 = 0.04;
/// The part of an arm, from the tip, to which its line is fitted.
const LINE_RANGE: (f64, f64) = (0.25, 0.9);
/// Sections along an arm.
const STATIONS: usize = 120;
/// The wrist is looked for between these parts of the way from shoulder to tip.
const WRIST_RANGE: (f64, f64) = (0.55, 0.88);
/// The wrist where none is seen.
const WRIST_BY_RATIO: f64 = 0.74;
/// The elbow lies at this part of the way from shoulder to wrist.
const ELBOW_PART: f64 = 0.53;
/// The elbow of an arm that is bent by more than this part of its length lies where the bend is.
const BENT: f64 = 0.05;
/// The shoulder joint lies straight over a point this many arm radii outside of the armpit, ...
const SHOULDER_OUT: f64 = 0.4;
/// ... and so many over the middle of the arm, which hangs from it.
const SHOULDER_OVER: f64 = 0.2;
/// Following starts at this part of the arm, where it is clear of the trunk.
const CLEAR: f64 = 0.25;
/// A section this much wider than the arm has trunk in it.
const TRUNK_WIDENS: f64 = 1.7;
/// A section this much deeper than the arm has something else in it.
const THING_DEEPENS: f64 = 4.0;

/// One arm.
pub struct Arm {
    /// The shoulder joint.
    pub shoulder: DVec3,
    /// The elbow.
    pub elbow: DVec3,
    /// The wrist.
    pub wrist: DVec3,
    /// The end of the hand.
    pub tip: DVec3,
    /// The armpit: where the arm's lower side meets the trunk.
    pub pit: DVec2,
    /// The arm's radius near the shoulder.
    pub radius: f64,
    /// True where an arm was seen to end at a trunk.
    pub pit_seen: bool,
    /// True where a wrist was seen.
    pub wrist_seen: bool,
}

/// Finds one arm above `floor` (height); `most` is how far from the axis it can reach. `None` where nothing sticks out.
pub fn find_arm(stance: &Stance, left: bool, crotch: f64, floor: f64, most: f64) -> Option<Arm> {
    let half = stance.half_columns();
    let cell = stance.cell();
    // The runs of each column, upwards.
    let column_runs = |steps: usize| -> Vec<(usize, usize)> {
        let column = stance.column(left, steps);
        let mut runs: Vec<(usize, usize)> = Vec::new();
        for row in (0..stance.grid.frame.rows).filter(|&row| stance.grid.is_filled(column, row)) {
            match runs.last_mut() {
                Some(run) if row <= run.1 + 1 => run.1 = row + 1,
                _ => runs.push((row, row + 1)),
            }
        }
        runs
    };
    let floor_row = stance.grid.row(floor);
    let outermost = (0..half.min(((most / cell).ceil() as usize).saturating_add(1)))
        .rev()
        .find(|&steps| column_runs(steps).iter().any(|run| run.1 > floor_row))?;
    let mut run = *column_runs(outermost).iter().rev().find(|run| run.1 > floor_row)?;
    // Inwards, column by column.
    let mut path: Vec<(usize, (usize, usize))> = vec![(outermost, run)];
    let mut pit = None;
    let inwards = |steps: usize, run: (usize, usize)| {
        let middle = 0.5 * (run.0 + run.1) as f64;
        column_runs(steps).into_iter().min_by(|a, b| {
            let off = |run: &(usize, usize)| {
                let (low, high) = (run.0 as f64, run.1 as f64);
                (low - middle).max(middle - high).max(0.0)
            };
            off(a).total_cmp(&off(b)).then(b.1.cmp(&a.1))
        })
    };
    let crotch_row = crotch / cell;
    let reaches_down = |steps: usize, from: f64, run: (usize, usize)| {
        let within = (TRUNK_WITHIN / cell) as usize;
        (steps.saturating_sub(within)..=steps).any(|steps| {
            inwards(steps, (from as usize, run.1))
                .is_some_and(|run| (run.0 as f64) < from - TRUNK_DROP * (from - crotch_row))
        })
    };
    for steps in (0..outermost).rev() {
        let next = inwards(steps, run)?;
        // A drop of the lower side below where the arm has run so far.
        if path.len() >= 12 {
            let (low, thickness) = lower_side(&path, steps);
            if (next.0 as f64) < low - PIT_DROP * thickness && reaches_down(steps, low, next) {
                pit = Some(steps + 1);
                break;
            }
        }
        path.push((steps, next));
        run = next;
    }
    let pit_seen = pit.is_some();
    let pit_steps = pit.unwrap_or(((0.1 / cell) as usize).min(outermost.saturating_sub(1)));
    path.retain(|&(steps, _)| steps >= pit_steps);
    let length = path.len();
    if length < 8 {
        return None;
    }
    let fitted: Vec<DVec2> = path
        [(LINE_RANGE.0 * length as f64) as usize..((LINE_RANGE.1 * length as f64) as usize).max(4)]
        .iter()
        .map(|&(steps, run)| DVec2::new(stance.distance(steps), 0.5 * (run.0 + run.1) as f64 * cell))
        .collect();
    let (through, slope) = fit(&fitted);
    let along = DVec2::new(1.0, slope).normalize();
    let pit_row = path.last().map_or(0, |&(_, run)| run.0);
    let pit = DVec2::new(pit_steps as f64 * cell, pit_row as f64 * cell);
    sections(stance, left, through, along, pit, stance.distance(outermost), pit_seen)
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

/// The filled rows of a column that are nearest to `middle`, single empty ones bridged.
fn nearest_run(grid: &RayGrid, column: usize, middle: usize) -> Option<(usize, usize)> {
    let mut runs: Vec<(usize, usize)> = Vec::new();
    for row in (0..grid.frame.rows).filter(|&row| grid.is_filled(column, row)) {
        match runs.last_mut() {
            Some(run) if row <= run.1 + 1 => run.1 = row + 1,
            _ => runs.push((row, row + 1)),
        }
    }
    runs.into_iter().min_by_key(|run| run.0.saturating_sub(middle).max((middle + 1).saturating_sub(run.1)))
}

/// A section at right angles to the arm.
#[derive(Clone, Copy)]
struct Station {
    centre: DVec3,
    width: f64,
    depth: f64,
}

/// Rays at right angles to the arm's line, and the joints that they show.
fn sections(
    stance: &Stance,
    left: bool,
    through: DVec2,
    along: DVec2,
    pit: DVec2,
    reach: f64,
    pit_seen: bool,
) -> Option<Arm> {
    let sign = if left { 1.0 } else { -1.0 };
    let place = |p: DVec2| DVec3::new(stance.axis + sign * p.x, p.y, 0.0);
    // The foot of the pit on the line, and of the tip.
    let start = through + along * (pit - through).dot(along);
    let length = ((reach - start.x) / along.x.max(0.2)) * 1.02;
    if length.is_nan() || length <= 1e-3 {
        return None;
    }
    // Some way inside of the pit as well.
    let inside = 0.25 * length;
    let cell = (length + inside) / STATIONS as f64;
    let span = 0.35 * length;
    let rows = 2 * (span / cell).ceil() as usize;
    let right = DVec3::new(sign * along.x, along.y, 0.0);
    // Rows count upwards on both sides.
    let up = DVec3::new(-sign * along.y, along.x, 0.0);
    let origin = place(start - along * inside) - up * (0.5 * rows as f64 * cell);
    let frame = GridFrame { origin, right, up, cell, columns: STATIONS, rows };
    let grid = RayGrid::new(stance.positions, &stance.triangles, frame, stance.threads);
    let depth_sign = right.cross(up).z.signum();
    let first = (inside / cell).round() as usize;
    let mut stations: Vec<Option<Station>> = vec![None; STATIONS];
    let clear = first + (CLEAR * (STATIONS - first) as f64) as usize;
    let follow = |column: usize, middle: usize| -> Option<(usize, Station)> {
        let (begin, end) = nearest_run(&grid, column, middle)?;
        let off = begin.saturating_sub(middle).max((middle + 1).saturating_sub(end));
        if off as f64 * cell > 0.12 * length {
            return None;
        }
        let (back, front) = grid.limb((begin..end).map(|row| (column, row)))?;
        let at = origin + right * ((column as f64 + 0.5) * cell) + up * (0.5 * (begin + end) as f64 * cell);
        let station = Station {
            centre: at.with_z(depth_sign * 0.5 * (back + front)),
            width: (end - begin) as f64 * cell,
            depth: front - back,
        };
        Some(((begin + end) / 2, station))
    };
    let mut middle = rows / 2;
    for (column, slot) in stations.iter_mut().enumerate().skip(clear) {
        if let Some((next, station)) = follow(column, middle) {
            middle = next;
            *slot = Some(station);
        }
    }
    let usual = median(&mut stations.iter().flatten().map(|s| s.width).collect::<Vec<_>>());
    let mut middle = rows / 2;
    for column in (first..clear).rev() {
        match follow(column, middle) {
            Some((next, station)) if station.width <= TRUNK_WIDENS * usual => {
                middle = next;
                stations[column] = Some(station);
            }
            _ => break,
        }
    }
    // A thing in the hand that points forward is no arm.
    let deepest = THING_DEEPENS * median(&mut stations.iter().flatten().map(|s| s.depth).collect::<Vec<_>>());
    for station in &mut stations {
        *station = station.filter(|station| station.depth <= deepest);
    }
    let first = (first..STATIONS).find(|&column| stations[column].is_some())?;
    let last = (first..STATIONS).rev().find(|&column| stations[column].is_some())?;
    let known: Vec<Station> = (first..=last).filter_map(|column| stations[column]).collect();
    if known.len() < 12 {
        return None;
    }
    // How far along the curve of the centres each section is: arms may bend towards the front.
    let smooth: Vec<DVec3> = (0..known.len())
        .map(|index| {
            let (from, to) = (index.saturating_sub(3), (index + 4).min(known.len()));
            known[from..to].iter().map(|s| s.centre).sum::<DVec3>() / (to - from) as f64
        })
        .collect();
    let mut arc = vec![0.0];
    for pair in smooth.windows(2) {
        arc.push(arc[arc.len() - 1] + pair[0].distance(pair[1]));
    }
    let whole = arc[arc.len() - 1];
    let at_arc = |wanted: f64| -> DVec3 {
        if wanted <= 0.0 {
            // Inside of the pit the arm goes on as it begins.
            let next = (known.len() / 6).max(1);
            let way = (smooth[0] - smooth[next]).normalize_or_zero();
            return smooth[0] + way * -wanted;
        }
        let index = arc.partition_point(|&a| a < wanted).clamp(1, arc.len() - 1);
        let part = (wanted - arc[index - 1]) / (arc[index] - arc[index - 1]).max(1e-12);
        smooth[index - 1].lerp(smooth[index], part.clamp(0.0, 1.0))
    };
    let near: Vec<&Station> = known[known.len() / 10..known.len() / 3].iter().collect();
    let radius = 0.25 * median(&mut near.iter().map(|s| s.width + s.depth).collect::<Vec<_>>());
    // The arm's line through its upper part, to over the armpit.
    let upper = &smooth[known.len() / 20..(known.len() / 4).max(1)];
    let upper = upper.iter().sum::<DVec3>() / upper.len().max(1) as f64;
    let out = pit.x + SHOULDER_OUT * radius;
    let inwards = ((upper.x - stance.axis).abs() - out) / along.x.max(0.3);
    let shoulder = upper - right * inwards + DVec3::Y * SHOULDER_OVER * radius;
    let shoulder_arc = -smooth[0].distance(shoulder) * (shoulder - smooth[0]).dot(-right).signum();
    let way = |part: f64| shoulder_arc + part * (whole - shoulder_arc);
    // The wrist: the slimmest section before the hand.
    let girth: Vec<f64> = (0..known.len())
        .map(|index| {
            let (from, to) = (index.saturating_sub(1), (index + 2).min(known.len()));
            known[from..to].iter().map(|s| s.width + s.depth).sum::<f64>() / (to - from) as f64
        })
        .collect();
    let range: Vec<usize> = (0..known.len())
        .filter(|&index| arc[index] >= way(WRIST_RANGE.0) && arc[index] <= way(WRIST_RANGE.1))
        .collect();
    let girths: Vec<(f64, f64)> = range.iter().map(|&index| (arc[index], girth[index])).collect();
    let slim = lowest(&girths).map(|at| {
        let index = arc.partition_point(|&a| a < at).min(known.len() - 1);
        (at, index)
    });
    let mut wrist_arc = way(WRIST_BY_RATIO);
    let mut wrist_seen = false;
    if let Some((at, slim)) = slim {
        let hand = girth[slim..].iter().copied().fold(0.0, f64::max);
        let arm = girth[..slim].iter().copied().fold(0.0, f64::max);
        if hand > 1.12 * girth[slim] && arm > 1.05 * girth[slim] && at < way(WRIST_RANGE.1) - 0.01 {
            wrist_arc = at;
            wrist_seen = true;
        }
    }
    let wrist = at_arc(wrist_arc);
    let mut elbow = at_arc(shoulder_arc + ELBOW_PART * (wrist_arc - shoulder_arc));
    // The bend of a bent arm.
    let chord = wrist - shoulder;
    let off = |p: DVec3| (p - shoulder).reject_from(chord).length();
    let bend = (0..known.len())
        .filter(|&index| {
            let part = (arc[index] - shoulder_arc) / (wrist_arc - shoulder_arc);
            (0.35..=0.7).contains(&part)
        })
        .max_by(|&a, &b| off(smooth[a]).total_cmp(&off(smooth[b])).then(b.cmp(&a)));
    if let Some(bend) = bend
        && chord.length() > 0.0
        && off(smooth[bend]) > BENT * chord.length()
    {
        elbow = smooth[bend];
    }
    let tip = smooth[smooth.len() - 1];
    Some(Arm { shoulder, elbow, wrist, tip, pit, radius, pit_seen, wrist_seen })
}
