//! The figure as rays from the front see it: which meshes to look at, where its plane of symmetry is, and its silhouette.

use super::UnitFigure;
use super::silhouette::{GridFrame, RayGrid, runs_of};
use crate::character::MeshKind;
use crate::error::Result;
use crate::geometry::{Bounds, bounds, clusters, median};
use crate::progress::Progress;
use glam::DVec3;

/// Rows of rays over the height of a figure. Seen: at +30 %, joints lie 0.0005 H further off.
pub const ROWS: usize = 400;
/// More columns on either side than this (4 heights) show nothing of a figure. A bound for memory.
const MOST_HALF_COLUMNS: usize = 4 * ROWS;
/// A set of meshes is whole where its feet and its head reach to within these distances of those of all meshes. Seen:
/// ±30 % changes no joint.
const LOW_REACH: f64 = 0.04;
const HIGH_REACH: f64 = 0.12;
/// A figure is in one piece where nearly all rows between feet and head, at least this share, show something. Seen: at
/// +30 %, joints lie 0.003 H further off, eight more by over 0.06 H.
const FILLED_ROWS: f64 = 0.97;
/// A set of meshes is whole where nearly all of it, at least this share, hangs together. Seen: at +30 %, joints lie
/// 0.003 H further off, eight more by over 0.06 H.
const CONNECTED_SHARE: f64 = 0.9;
/// Gaps of so many cells within a row are slits between patches, not air. Seen: ±30 % moves joints by under 0.0005 H.
pub const SLIT: usize = 2;
/// Every so many rows are compared with their mirror image. Seen: ±30 % moves joints by under 0.0005 H.
const AXIS_ROWS: usize = 3;
/// An axis is kept where another one makes no more than this share of the silhouette's mirror image fit better. Seen:
/// ±30 % changes no joint.
const AXIS_GAIN: f64 = 0.004;
/// A figure seen from the front.
pub struct FrontView<'a> {
    /// Vertices of the unit figure.
    pub positions: &'a [DVec3],
    /// The meshes that are looked at.
    pub meshes: Vec<bool>,
    /// The triangles of the meshes that are looked at.
    pub triangles: Vec<[u32; 3]>,
    /// What the rays meet: columns to the left, rows up, an even number of columns about the axis.
    pub grid: RayGrid,
    /// x of the plane of symmetry.
    pub axis: f64,
    /// At most so many threads; 0 means all cores.
    pub threads: usize,
    /// The lowest height that is seen.
    pub low: f64,
    /// The highest.
    pub high: f64,
    /// Runs of filled cells of each row, as half-open ranges of columns, slits bridged.
    pub runs: Vec<Vec<(usize, usize)>>,
}

impl<'a> FrontView<'a> {
    /// Looks at `figure`, whose meshes are of these `kinds`.
    ///
    /// # Errors
    /// `Cancelled`.
    pub fn of(
        figure: &'a UnitFigure,
        kinds: &[MeshKind],
        threads: usize,
        progress: &mut Progress,
    ) -> Result<Self> {
        use MeshKind::*;
        let everything: &[MeshKind] = &[Body, FacePart, Garment, Accessory, Hair, Eye];
        let positions = &figure.positions;
        let of_kinds = |set: &[MeshKind]| figure.triangles_where(|mesh| set.contains(&kinds[mesh]));
        let dressed = of_kinds(&everything[..3]);
        let mut shown = if dressed.is_empty() { everything } else { &everything[..3] };
        let mut triangles = of_kinds(shown);
        let mut grid = front(positions, &triangles, 0.0, threads);
        progress.at(0.3)?;
        // Of a figure in pieces whose kinds were guessed wrong, all pieces are looked at.
        let guessed = figure.kinds.iter().all(Option::is_none);
        let some = triangles.len() < figure.triangles.len();
        if guessed && some && filled_share(&grid) < FILLED_ROWS {
            (shown, triangles) = (everything, figure.triangles.clone());
            grid = front(positions, &triangles, 0.0, threads);
        }
        // Of a body that is whole, what it wears is in the way.
        let bare = of_kinds(&everything[..2]);
        if !bare.is_empty() && bare.len() < triangles.len() {
            let of_bare = front(positions, &bare, 0.0, threads);
            progress.at(0.6)?;
            if is_whole(&of_bare, &Extent::of(&grid)) {
                (shown, triangles, grid) = (&everything[..2], bare, of_bare);
            }
        }
        let meshes = kinds.iter().map(|kind| shown.contains(kind)).collect();
        let axis = axis(&grid);
        let grid = if axis == 0.0 { grid } else { front(positions, &triangles, axis, threads) };
        let Extent { low, high, .. } = Extent::of(&grid);
        let runs = (0..grid.frame.rows).map(|row| runs(&grid, row)).collect();
        progress.at(1.0)?;
        Ok(Self { positions, meshes, triangles, grid, axis, threads, low, high, runs })
    }

    /// The side of a cell.
    pub fn cell(&self) -> f64 {
        self.grid.frame.cell
    }

    /// How many columns there are on either side of the axis.
    pub fn half_columns(&self) -> usize {
        self.grid.frame.columns / 2
    }

    /// The column that lies `steps` cells from the axis on one side.
    pub fn column(&self, left: bool, steps: usize) -> usize {
        let half = self.half_columns();
        let steps = steps.min(half - 1);
        if left { half + steps } else { half - 1 - steps }
    }

    /// How far from the axis the rays of that column run.
    pub fn distance(&self, steps: usize) -> f64 {
        (steps as f64 + 0.5) * self.cell()
    }

    /// What of a run of columns lies on one side, as steps from the axis.
    pub fn steps(&self, left: bool, (start, end): (usize, usize)) -> Option<(usize, usize)> {
        let half = self.half_columns();
        let (start, end) = if left {
            (start.max(half) - half, end.max(half) - half)
        } else {
            (half - end.min(half), half - start.min(half))
        };
        (start < end).then_some((start, end))
    }

    /// The runs of a row on one side, as half-open ranges of steps from the axis, nearest first; a run across the axis is
    /// cut there.
    pub fn side_runs(&self, left: bool, row: usize) -> Vec<(usize, usize)> {
        let on_side = self.runs[row].iter().filter_map(|&run| self.steps(left, run));
        let mut runs: Vec<(usize, usize)> = on_side.collect();
        runs.sort_unstable();
        runs
    }

    /// Half the width of what stands on the axis in a row: the lesser of both sides, so that a thing on one side counts
    /// for nothing. 0 where the axis is in the air.
    pub fn half_width(&self, row: usize) -> f64 {
        let side = |left: bool| {
            let runs = self.side_runs(left, row);
            runs.first().filter(|run| run.0 <= SLIT).map_or(0, |run| run.1)
        };
        side(true).min(side(false)) as f64 * self.cell()
    }

    /// Median of the front, and of the back, over the columns within `reach` of the axis.
    pub fn depth(&self, row: usize, reach: f64) -> Option<(f64, f64)> {
        let steps = ((reach / self.cell()) as usize).clamp(1, self.half_columns());
        let half = self.half_columns();
        let (mut back, mut front): (Vec<f64>, Vec<f64>) =
            (half - steps..half + steps).filter_map(|column| self.grid.thickest(column, row)).unzip();
        (!back.is_empty()).then(|| (median(&mut back), median(&mut front)))
    }

    /// A point of the unit figure from a distance to the axis on one side.
    pub fn point(&self, left: bool, distance: f64, y: f64, z: f64) -> DVec3 {
        DVec3::new(if left { self.axis + distance } else { self.axis - distance }, y, z)
    }
}

/// The mirror image of a point in the plane at x = `axis`.
pub fn image(p: DVec3, axis: f64) -> DVec3 {
    DVec3::new(2.0 * axis - p.x, p.y, p.z)
}

fn front(positions: &[DVec3], triangles: &[[u32; 3]], axis: f64, threads: usize) -> RayGrid {
    let cell = 1.0 / ROWS as f64;
    let reach = triangles
        .iter()
        .flatten()
        .map(|&vertex| (positions[vertex as usize].x - axis).abs())
        .filter(|reach| reach.is_finite())
        .fold(0.0, f64::max);
    // A sheet may be any number of times as wide as it is high.
    let half = ((reach / cell).ceil() as usize).saturating_add(2).min(MOST_HALF_COLUMNS);
    let frame = GridFrame {
        origin: DVec3::X * (axis - half as f64 * cell),
        right: DVec3::X,
        up: DVec3::Y,
        cell,
        columns: 2 * half,
        rows: ROWS,
    };
    RayGrid::new(positions, triangles, frame, threads)
}

struct Extent {
    low: f64,
    high: f64,
}

impl Extent {
    fn of(grid: &RayGrid) -> Self {
        let corners = all_runs(grid).flat_map(|(row, (start, end))| [(start, row), (end, row + 1)]);
        let (low, high) = bounds(corners.map(|(x, y)| DVec3::new(x as f64, y as f64, 0.0)));
        if low.y > high.y {
            return Self { low: 0.0, high: 1.0 };
        }
        let cell = grid.frame.cell;
        Self { low: low.y * cell, high: high.y * cell }
    }
}

fn is_whole(grid: &RayGrid, all: &Extent) -> bool {
    let own = Extent::of(grid);
    let reaches = own.low <= all.low + LOW_REACH && own.high >= all.high - HIGH_REACH;
    reaches && connected_share(grid) >= CONNECTED_SHARE
}

/// The share of the rows between the lowest and the highest that show something.
fn filled_share(grid: &RayGrid) -> f64 {
    let own = Extent::of(grid);
    let (first, last) = (grid.row(own.low), grid.row(own.high - 0.5 * grid.frame.cell));
    let filled = (first..=last).filter(|&row| !runs(grid, row).is_empty()).count();
    filled as f64 / (last - first + 1) as f64
}

/// The share of the silhouette that its largest piece has, where gaps of a slit are bridged.
fn connected_share(grid: &RayGrid) -> f64 {
    // Boxes from each run's first cell to what a slit parts from its last one: rows along x, in whose order they are compared.
    let around = |(row, (start, end)): (usize, (usize, usize))| {
        let low = DVec3::new(row as f64, start as f64, 0.0);
        (low, low + DVec3::new((SLIT + 1) as f64, (end - start + SLIT) as f64, 0.0))
    };
    let boxes: Vec<Bounds> = all_runs(grid).map(around).collect();
    let mut counts = vec![0usize; boxes.len()];
    for ((row, (start, end)), piece) in all_runs(grid).zip(clusters(&boxes, |_, _| true)) {
        counts[piece] += (start..end).filter(|&column| grid.is_filled(column, row)).count();
    }
    let all = counts.iter().sum::<usize>().max(1);
    counts.into_iter().max().unwrap_or(0) as f64 / all as f64
}

/// The runs of all rows, each with its row.
fn all_runs(grid: &RayGrid) -> impl Iterator<Item = (usize, (usize, usize))> {
    (0..grid.frame.rows).flat_map(|row| runs(grid, row).into_iter().map(move |run| (row, run)))
}

fn runs(grid: &RayGrid, row: usize) -> Vec<(usize, usize)> {
    runs_of((0..grid.frame.columns).filter(|&column| grid.is_filled(column, row)), SLIT)
}

/// The axis about which most of the silhouette is its own mirror image.
fn axis(grid: &RayGrid) -> f64 {
    let columns = grid.frame.columns;
    let rows: Vec<Vec<(usize, usize)>> =
        (0..grid.frame.rows).step_by(AXIS_ROWS).map(|row| runs(grid, row)).collect();
    let area: usize = rows.iter().flatten().map(|run| run.1 - run.0).sum();
    if area == 0 {
        return 0.0;
    }
    // Every two runs of a row, of which one may be the other's image.
    let pairs =
        rows.iter().flat_map(|runs| runs.iter().flat_map(|one| runs.iter().map(move |other| (one, other))));
    // `sum` is the sum of two columns that are each other's image: [start, end) has the image (sum - end, sum - start].
    let overlap = |sum: usize| {
        let shared = |(one, other): (&(usize, usize), &(usize, usize))| {
            let start = (sum + 1).saturating_sub(other.1).max(one.0);
            (sum + 1).saturating_sub(other.0).min(one.1).saturating_sub(start)
        };
        pairs.clone().map(shared).sum::<usize>() as f64 / area as f64
    };
    let middle = columns - 1;
    let scores: Vec<f64> = (0..2 * columns - 1).map(overlap).collect();
    // From the middle outwards, so that the nearer of two equal axes counts.
    let outwards = (1..=middle).flat_map(|distance| [middle - distance, middle + distance]);
    let better = |best: usize, sum: usize| if scores[sum] > scores[best] + 1e-12 { sum } else { best };
    let best = outwards.fold(middle, better);
    if scores[middle] >= scores[best] - AXIS_GAIN {
        return 0.0;
    }
    // A parabola through the best and its neighbours.
    let value = |sum: usize| scores.get(sum).copied().unwrap_or(0.0);
    let (before, after) = (value(best.wrapping_sub(1)), value(best + 1));
    let bend = before - 2.0 * scores[best] + after;
    let shift = if bend < 0.0 { (0.5 * (before - after) / bend).clamp(-0.5, 0.5) } else { 0.0 };
    0.5 * (best as f64 + shift - middle as f64) * grid.frame.cell
}
