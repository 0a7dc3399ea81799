//! Depth maps: the foremost surface seen along an axis, on a regular grid.

use crate::geometry::whole::{ceil, floor};
use glam::{DVec2, DVec3};

/// No triangle is seen.
const NOTHING: u32 = u32::MAX;

/// The foremost surface seen from one side, in parallel projection.
#[derive(Clone, Debug)]
pub struct DepthMap {
    low: DVec2,
    step: f64,
    columns: usize,
    rows: usize,
    depths: Vec<f64>,
    triangles: Vec<u32>,
}

/// Where a depth map looks: a rectangle of its plane, cut into squares.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Window {
    /// Its lower left corner.
    pub low: DVec2,
    /// Its upper right corner.
    pub high: DVec2,
    /// The squares' width.
    pub step: f64,
}

impl DepthMap {
    /// What is seen in `window` of `triangles` between `points`, whose z grows towards the eye.
    ///
    /// A square shows what its middle shows; one without a surface shows nothing. Where two surfaces are equally near,
    /// the first one counts.
    ///
    /// O(triangles + squares they cover).
    pub fn new(points: &[DVec3], triangles: &[[u32; 3]], window: Window) -> Self {
        let Window { low, high, step } = window;
        let [columns, rows] = ((high - low) / step).to_array().map(|count| count.round().max(1.0) as usize);
        // In the window's middle, so that a mirrored window has the mirrored squares.
        let low = 0.5 * (low + high - step * DVec2::new(columns as f64, rows as f64));
        let count = columns * rows;
        let (depths, seen) = (vec![f64::NEG_INFINITY; count], vec![NOTHING; count]);
        Self { low, step, columns, rows, depths, triangles: seen }.with(points, triangles)
    }

    /// The same with more triangles, which are numbered anew.
    pub fn with(mut self, points: &[DVec3], triangles: &[[u32; 3]]) -> Self {
        for (index, corners) in triangles.iter().enumerate() {
            self.draw(index as u32, corners.map(|corner| points[corner as usize]));
        }
        self
    }

    fn draw(&mut self, triangle: u32, [a, b, c]: [DVec3; 3]) {
        let double_area = (b - a).truncate().perp_dot((c - a).truncate());
        if double_area == 0.0 || !double_area.is_finite() {
            return;
        }
        let (least, most) = (a.min(b).min(c), a.max(b).max(c));
        // Squares whose middle lies within, at least.
        let range = |least: f64, most: f64, low: f64, count: usize| {
            let first = ceil((least - low) / self.step - 0.5).max(0.0) as usize;
            let end = floor((most - low) / self.step - 0.5) + 1.0;
            first..(end.max(0.0) as usize).min(count)
        };
        let columns = range(least.x, most.x, self.low.x, self.columns);
        let rows = range(least.y, most.y, self.low.y, self.rows);
        for row in rows {
            for column in columns.clone() {
                let square = row * self.columns + column;
                // It lies behind what is seen, wherever it meets the square.
                if most.z <= self.depths[square] {
                    continue;
                }
                let p = self.middle(column, row);
                let to_b = (b.truncate() - p).perp_dot(c.truncate() - p) / double_area;
                let to_c = (c.truncate() - p).perp_dot(a.truncate() - p) / double_area;
                let shares = DVec3::new(to_b, to_c, 1.0 - to_b - to_c);
                // A hair's breadth more, so that nothing is seen through an edge.
                if shares.min_element() < -1e-9 {
                    continue;
                }
                let depth = shares.dot(DVec3::new(a.z, b.z, c.z));
                if depth > self.depths[square] {
                    self.depths[square] = depth;
                    self.triangles[square] = triangle;
                }
            }
        }
    }

    /// How many squares there are from left to right.
    pub fn columns(&self) -> usize {
        self.columns
    }

    /// How many squares there are from below upwards.
    pub fn rows(&self) -> usize {
        self.rows
    }

    /// All squares, by column and row, row after row.
    pub fn squares(&self) -> impl Iterator<Item = (usize, usize)> + use<> {
        let columns = self.columns;
        (0..self.rows).flat_map(move |row| (0..columns).map(move |column| (column, row)))
    }

    /// The middle of a square.
    pub fn middle(&self, column: usize, row: usize) -> DVec2 {
        self.low + self.step * DVec2::new(column as f64 + 0.5, row as f64 + 0.5)
    }

    /// The row around height `y`, within the window's.
    pub fn row(&self, y: f64) -> usize {
        (((y - self.low.y) / self.step).max(0.0) as usize).min(self.rows - 1)
    }

    /// The depth that a square shows.
    pub fn depth(&self, column: usize, row: usize) -> Option<f64> {
        let depth = self.depths[row * self.columns + column];
        (depth > f64::NEG_INFINITY).then_some(depth)
    }

    /// The triangle that a square shows, as given.
    pub fn triangle(&self, column: usize, row: usize) -> Option<usize> {
        let triangle = self.triangles[row * self.columns + column];
        (triangle != NOTHING).then_some(triangle as usize)
    }

    /// How far from x = 0 `row` shows a depth that `counts` accepts; 0 where it shows none.
    pub fn reach(&self, row: usize, counts: impl Fn(f64) -> bool) -> f64 {
        let seen = (0..self.columns).filter(|&column| self.depth(column, row).is_some_and(&counts));
        seen.map(|column| self.middle(column, row).x.abs()).fold(0.0, f64::max)
    }

    /// The depth that the square around `p` shows, where it lies in the window.
    pub fn depth_at(&self, p: DVec2) -> Option<f64> {
        self.square(p).and_then(|(column, row)| self.depth(column, row))
    }

    /// The triangle that the square around `p` shows, as given.
    pub fn triangle_at(&self, p: DVec2) -> Option<usize> {
        self.square(p).and_then(|(column, row)| self.triangle(column, row))
    }

    fn square(&self, p: DVec2) -> Option<(usize, usize)> {
        let [x, y] = ((p - self.low) / self.step).to_array();
        let is_within = x >= 0.0 && y >= 0.0 && x < self.columns as f64 && y < self.rows as f64;
        is_within.then_some((x as usize, y as usize))
    }
}
