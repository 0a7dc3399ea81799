//! A grid of parallel rays and all that they meet: the body's silhouette, its depth, and what lies inside of it.

use crate::geometry::{Rows, by_number};
use crate::parallel;
use glam::DVec3;

/// More hits than this are no figure's. Seen: ±30 % changes no joint.
const MOST_HITS: f64 = 6e6;
/// Things that lie further apart than this share of a limb's thickness are not the same limb. Seen: ±30 % moves joints
/// by under 0.0005 H.
const LIMB_GAP: f64 = 0.35;

/// The plane that a grid of rays starts from, and how fine the grid is.
#[derive(Clone, Copy, Debug)]
pub struct GridFrame {
    /// The corner of the grid: where column 0, row 0 begins.
    pub origin: DVec3,
    /// The way columns count; of length 1.
    pub right: DVec3,
    /// The way rows count; of length 1, at right angles to `right`.
    pub up: DVec3,
    /// The side of a cell.
    pub cell: f64,
    /// How many columns there are.
    pub columns: usize,
    /// How many rows there are.
    pub rows: usize,
}

/// All that a grid of parallel rays meets. The rays run through the middles of the cells, along `right` × `up`.
#[derive(Clone, Debug)]
pub struct RayGrid {
    /// Where the grid stands.
    pub frame: GridFrame,
    /// By cell, depths along `right` × `up`, ascending, and whether the ray leaves there.
    hits: Rows<(f32, bool)>,
}

impl RayGrid {
    /// Casts the rays of `frame` at `triangles`.
    ///
    /// Each triangle looks for the rays that it meets, which for parallel rays is the same as each ray looking for its
    /// triangles and needs no tree. A ray through an edge meets one of the two triangles.
    ///
    /// `threads`: at most so many; 0 means all cores.
    ///
    /// O(triangles + hits · log hits of a ray).
    pub fn new(positions: &[DVec3], triangles: &[[u32; 3]], frame: GridFrame, threads: usize) -> Self {
        // A body meets a ray a few times. A heap of large triangles would fill the memory: of that, some must do.
        let cells = (frame.columns * frame.rows) as f64;
        let along = frame.right.cross(frame.up);
        let expected: f64 = triangles
            .iter()
            .map(|corners| {
                let [a, b, c] = corners.map(|vertex| positions[vertex as usize]);
                let cells_met = 0.5 * (b - a).cross(c - a).dot(along).abs() / (frame.cell * frame.cell);
                if cells_met.is_finite() { cells_met.min(cells) } else { cells }
            })
            .sum();
        let step = (expected / MOST_HITS).ceil().max(1.0) as usize;
        let count = triangles.len().div_ceil(step);
        let shares = count.div_ceil(parallel::FEW).clamp(1, 64);
        let share = count.div_ceil(shares).max(1);
        let hits = parallel::collect(threads, count.div_ceil(share), 1, |index| {
            let of_share = triangles.iter().step_by(step).skip(index * share).take(share);
            Self::meet(positions, of_share, &frame)
        });
        Self::sorted(frame, hits)
    }

    /// Cell, depth and whether the ray leaves, of all that some triangles meet.
    fn meet<'a>(
        positions: &[DVec3],
        triangles: impl Iterator<Item = &'a [u32; 3]>,
        frame: &GridFrame,
    ) -> Vec<(u32, f32, bool)> {
        let along = frame.right.cross(frame.up);
        let mut hits = Vec::new();
        let (columns, rows) = (frame.columns as f64, frame.rows as f64);
        for corners in triangles {
            // In cells, so that rays stand at whole numbers.
            let [a, b, c] = corners.map(|vertex| {
                let p = positions[vertex as usize] - frame.origin;
                DVec3::new(
                    p.dot(frame.right) / frame.cell - 0.5,
                    p.dot(frame.up) / frame.cell - 0.5,
                    p.dot(along),
                )
            });
            let (low, high) = (a.min(b).min(c), a.max(b).max(c));
            if !(low.is_finite() && high.is_finite())
                || high.x < 0.0
                || high.y < 0.0
                || low.x > columns - 1.0
                || low.y > rows - 1.0
            {
                continue;
            }
            let double_area = (b - a).truncate().perp_dot((c - a).truncate());
            if double_area == 0.0 {
                continue;
            }
            // Edges always run from the lesser to the greater end, so that two triangles compute the same line.
            let first_row = low.y.max(0.0).ceil() as usize;
            let last_row = high.y.min(rows - 1.0).floor() as usize;
            for row in first_row..=last_row {
                let y = row as f64;
                let (mut left, mut right) = (f64::INFINITY, f64::NEG_INFINITY);
                for (p, q) in [(a, b), (b, c), (c, a)] {
                    let (p, q) = if (p.y, p.x) <= (q.y, q.x) { (p, q) } else { (q, p) };
                    // Half open along up, as well: each crossing counts once.
                    if p.y <= y && y < q.y {
                        let x = p.x + (q.x - p.x) * ((y - p.y) / (q.y - p.y));
                        left = left.min(x);
                        right = right.max(x);
                    }
                }
                if right.is_nan() || left >= right {
                    continue;
                }
                for column in left.max(0.0).ceil() as usize..right.min(columns).ceil() as usize {
                    let x = column as f64;
                    let u = ((x - a.x) * (c.y - a.y) - (y - a.y) * (c.x - a.x)) / double_area;
                    let v = ((b.x - a.x) * (y - a.y) - (b.y - a.y) * (x - a.x)) / double_area;
                    let depth = (a.z + u * (b.z - a.z) + v * (c.z - a.z)).clamp(low.z, high.z);
                    let cell = (row * frame.columns + column) as u32;
                    hits.push((cell, depth as f32, double_area > 0.0));
                }
            }
        }
        hits
    }

    fn sorted(frame: GridFrame, found: Vec<Vec<(u32, f32, bool)>>) -> Self {
        let cell_count = frame.columns * frame.rows;
        let found = found.iter().flatten().map(|&(cell, depth, leaves)| (cell, (depth, leaves)));
        let mut hits = by_number(cell_count, found);
        // A mesh may be wound the other way round: of rays that meet two things, most enter first.
        let mut as_wound = 0;
        for cell in 0..cell_count {
            let hits = hits.of_mut(cell);
            hits.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
            if let [(_, first), (_, second)] = *hits
                && first != second
            {
                as_wound += if second { 1 } else { -1 };
            }
        }
        if as_wound < 0 {
            hits.things.iter_mut().for_each(|hit| hit.1 = !hit.1);
        }
        Self { frame, hits }
    }

    /// The depths at which the ray of a cell meets something, ascending, and whether it leaves there.
    pub fn hits(&self, column: usize, row: usize) -> &[(f32, bool)] {
        self.hits.of(row * self.frame.columns + column)
    }

    /// True where the ray of a cell meets something.
    pub fn is_filled(&self, column: usize, row: usize) -> bool {
        !self.hits(column, row).is_empty()
    }

    /// The filled rows of a column, upwards, single empty ones bridged.
    pub fn runs_of_column(&self, column: usize) -> Vec<(usize, usize)> {
        runs_of((0..self.frame.rows).filter(|&row| self.is_filled(column, row)), 1)
    }

    /// The first and the last depth of a cell.
    pub fn depth(&self, column: usize, row: usize) -> Option<(f64, f64)> {
        let hits = self.hits(column, row);
        Some((f64::from(hits.first()?.0), f64::from(hits.last()?.0)))
    }

    /// Where the ray of a cell is inside of the thickest thing that stands apart from others, whatever is in that thing.
    /// Its first and last depth where rays do not leave as often as they enter.
    pub fn thickest(&self, column: usize, row: usize) -> Option<(f64, f64)> {
        let mut best: Option<(f64, f64)> = None;
        let (mut inside, mut back) = (0i32, 0.0);
        for &(depth, leaves) in self.hits(column, row) {
            let depth = f64::from(depth);
            if inside == 0 {
                back = depth;
            }
            inside += if leaves { -1 } else { 1 };
            if inside < 0 {
                return self.depth(column, row);
            }
            if inside == 0 && best.is_none_or(|(low, high)| depth - back > high - low) {
                best = Some((back, depth));
            }
        }
        if inside == 0 { best } else { self.depth(column, row) }
    }

    /// Back and front of the limb that some cells show: of the thickest thing that rays enter and leave with nothing
    /// between, and of all that lies beside it within a share of its thickness (fingers).
    pub fn limb(&self, cells: impl Iterator<Item = (usize, usize)>) -> Option<(f64, f64)> {
        let mut found: Vec<(f64, f64)> = Vec::new();
        for (column, row) in cells {
            let before = found.len();
            let pairs = self.hits(column, row).windows(2).filter(|pair| !pair[0].1 && pair[1].1);
            found.extend(pairs.map(|pair| (f64::from(pair[0].0), f64::from(pair[1].0))));
            if found.len() == before {
                found.extend(self.depth(column, row));
            }
        }
        let thickest = found.iter().copied().max_by(|a, b| (a.1 - a.0).total_cmp(&(b.1 - b.0)))?;
        let reach = LIMB_GAP * (thickest.1 - thickest.0);
        found.sort_unstable_by(|a, b| a.0.total_cmp(&b.0));
        let ahead = found.iter().filter(|one| one.1 >= thickest.0);
        let front = ahead
            .fold(thickest.1, |front, one| if one.0 <= front + reach { front.max(one.1) } else { front });
        found.sort_unstable_by(|a, b| b.1.total_cmp(&a.1));
        let behind = found.iter().filter(|one| one.0 <= thickest.1);
        let back =
            behind.fold(thickest.0, |back, one| if one.1 >= back - reach { back.min(one.0) } else { back });
        Some((back, front))
    }

    /// How far along `up` a row's rays run.
    pub fn y(&self, row: usize) -> f64 {
        self.frame.origin.dot(self.frame.up) + (row as f64 + 0.5) * self.frame.cell
    }

    /// The row whose rays run nearest to a distance along `up`, clamped to the grid.
    pub fn row(&self, y: f64) -> usize {
        let row = ((y - self.frame.origin.dot(self.frame.up)) / self.frame.cell).floor();
        row.clamp(0.0, self.frame.rows as f64 - 1.0) as usize
    }

    /// The column whose rays run nearest to a distance along `right`, clamped to the grid.
    pub fn column(&self, x: f64) -> usize {
        let column = ((x - self.frame.origin.dot(self.frame.right)) / self.frame.cell).floor();
        column.clamp(0.0, self.frame.columns as f64 - 1.0) as usize
    }
}

/// The half-open runs of some ascending numbers, gaps of up to `bridged` bridged.
pub fn runs_of(filled: impl Iterator<Item = usize>, bridged: usize) -> Vec<(usize, usize)> {
    let mut runs: Vec<(usize, usize)> = Vec::new();
    for at in filled {
        match runs.last_mut() {
            Some(run) if at <= run.1 + bridged => run.1 = at + 1,
            _ => runs.push((at, at + 1)),
        }
    }
    runs
}
