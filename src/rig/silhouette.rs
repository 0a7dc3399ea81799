//! A grid of parallel rays and all that they meet: the body's silhouette, its depth, and what lies inside of it.

use glam::DVec3;

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
    /// Where each cell's hits start; one more than there are cells.
    starts: Vec<u32>,
    /// Depths along `right` × `up`, ascending in each cell.
    depths: Vec<f32>,
}

impl RayGrid {
    /// Casts the rays of `frame` at `triangles`.
    ///
    /// Each triangle looks for the rays that it meets, which for parallel rays is the same as each ray looking for its
    /// triangles and needs no tree. A ray through an edge meets one of the two triangles.
    ///
    /// O(triangles + hits · log hits of a ray).
    pub fn new(positions: &[DVec3], triangles: &[[u32; 3]], frame: GridFrame) -> Self {
        let along = frame.right.cross(frame.up);
        let mut hits: Vec<(u32, f32)> = Vec::new();
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
                let first = left.max(0.0).ceil();
                let last = right.min(columns);
                let mut x = first;
                while x < last {
                    let u = ((x - a.x) * (c.y - a.y) - (y - a.y) * (c.x - a.x)) / double_area;
                    let v = ((b.x - a.x) * (y - a.y) - (b.y - a.y) * (x - a.x)) / double_area;
                    let depth = (a.z + u * (b.z - a.z) + v * (c.z - a.z)).clamp(low.z, high.z);
                    hits.push(((row * frame.columns + x as usize) as u32, depth as f32));
                    x += 1.0;
                }
            }
        }
        let cell_count = frame.columns * frame.rows;
        let mut starts = vec![0u32; cell_count + 1];
        for &(cell, _) in &hits {
            starts[cell as usize + 1] += 1;
        }
        for cell in 0..cell_count {
            starts[cell + 1] += starts[cell];
        }
        let mut next = starts.clone();
        let mut depths = vec![0.0; hits.len()];
        for (cell, depth) in hits {
            depths[next[cell as usize] as usize] = depth;
            next[cell as usize] += 1;
        }
        for cell in 0..cell_count {
            depths[starts[cell] as usize..starts[cell + 1] as usize].sort_unstable_by(f32::total_cmp);
        }
        Self { frame, starts, depths }
    }

    /// The depths at which the ray of a cell meets something, ascending.
    pub fn hits(&self, column: usize, row: usize) -> &[f32] {
        let cell = row * self.frame.columns + column;
        &self.depths[self.starts[cell] as usize..self.starts[cell + 1] as usize]
    }

    /// True where the ray of a cell meets something.
    pub fn is_filled(&self, column: usize, row: usize) -> bool {
        !self.hits(column, row).is_empty()
    }

    /// The first and the last depth of a cell.
    pub fn depth(&self, column: usize, row: usize) -> Option<(f64, f64)> {
        let hits = self.hits(column, row);
        Some((f64::from(*hits.first()?), f64::from(*hits.last()?)))
    }

    /// How far along `right` a column's rays run.
    pub fn x(&self, column: usize) -> f64 {
        self.frame.origin.dot(self.frame.right) + (column as f64 + 0.5) * self.frame.cell
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
