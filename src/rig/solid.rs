//! A figure as cells that are filled, and how deep each of them lies: what limbs are found from where rays see too much.

use crate::geometry::Groups;
use glam::DVec3;
use std::collections::VecDeque;
use std::ops::Range;

/// Cells over the height of a figure: one is 0.006 H, a fifth of the least limb.
pub const CELLS: f64 = 160.0;
/// The same where it is only asked whether limbs show at all.
pub const FEW_CELLS: f64 = 80.0;
/// A figure as broad and deep as high takes larger cells, so that there are no more than this, of 160 a height: time and memory. A person in
/// T-pose takes 2 million, one with arms forward 3.
const MOST_CELLS: f64 = 5e6;
/// What lies further from the axis than this, in heights, is no limb: a bound for memory.
const REACH: f64 = 1.0;
/// Empty cells around the figure, so that all of them hang together.
const MARGIN: usize = 2;
/// Points on a triangle are no further apart than this share of a cell: no cell between three of them is missed.
const STEP: f64 = 0.45;
/// Cells this nearly as deep as the deepest are the core of a limb.
const CORE: f64 = 0.7;
/// More steps along a side than this go beyond the grid.
const MOST_STEPS: f64 = 1500.0;

/// Points on a way are no further apart than this share of a cell: air that is two cells wide has two of them at least.
const AIR_STEP: f64 = 0.7;

/// The state of a cell that can be reached from outside.
const OUTSIDE: u8 = 2;

/// Cells of a grid, filled where nothing from outside gets to.
#[derive(Debug, Default)]
pub struct Solid {
    /// Cells along x, y and z.
    pub size: [usize; 3],
    /// The corner of the first cell.
    pub low: DVec3,
    /// The side of a cell.
    pub cell: f64,
    /// 0 enclosed, 1 surface, 2 outside: by cell.
    state: Vec<u8>,
}

impl Solid {
    /// The solid of `triangles`, of which a figure about 1 high consists whose axis is at x = `axis`.
    ///
    /// A cell is filled that a triangle touches, and one that is enclosed; what is open to one side is not.
    ///
    /// `cells`: over the height.
    ///
    /// O(area + cells).
    pub fn new(positions: &[DVec3], triangles: &[[u32; 3]], axis: f64, cells: f64) -> Self {
        let middle = DVec3::new(axis, 0.0, 0.0);
        let (mut low, mut high) = (DVec3::ZERO, DVec3::Y);
        for corners in triangles {
            for &vertex in corners {
                let p = positions[vertex as usize] - middle;
                low = low.min(p);
                high = high.max(p);
            }
        }
        // As far to one side as to the other: mirror images fall on cells that are mirror images.
        let reach = low.abs().max(high.abs()).min(DVec3::splat(REACH));
        let most = MOST_CELLS * (cells / CELLS).powi(3);
        let cell = (4.0 * reach.x * reach.z / most).cbrt().max(1.0 / cells);
        let count = |reach: f64| 2 * ((reach / cell).ceil() as usize + MARGIN);
        let size = [count(reach.x), (1.0 / cell).ceil() as usize + 2 * MARGIN, count(reach.z)];
        let low = middle - cell * DVec3::new(0.5 * size[0] as f64, MARGIN as f64, 0.5 * size[2] as f64);
        let mut solid = Self { size, low, cell, state: Vec::new() };
        let mut state = vec![0u8; size[0] * size[1] * size[2]];
        for corners in triangles {
            let [a, b, c] = corners.map(|vertex| (positions[vertex as usize] - low) / cell);
            let longest = a.distance(b).max(b.distance(c)).max(c.distance(a));
            if !longest.is_finite() {
                continue;
            }
            let steps = (longest / STEP).ceil().clamp(1.0, MOST_STEPS) as usize;
            let (along, across) = ((b - a) / steps as f64, (c - a) / steps as f64);
            for i in 0..=steps {
                for j in 0..=steps - i {
                    if let Some(index) = solid.index_at(a + i as f64 * along + j as f64 * across) {
                        state[index] = 1;
                    }
                }
            }
        }
        state[0] = OUTSIDE;
        // First in, first out: only the rim of what is known waits.
        let mut rim = VecDeque::from([0u32]);
        let (row, layer) = (size[0], size[0] * size[1]);
        while let Some(index) = rim.pop_front() {
            let index = index as usize;
            let (x, y, z) = (index % row, index / row % size[1], index / layer);
            for (is_there, next) in [
                (x > 0, index.wrapping_sub(1)),
                (x + 1 < size[0], index + 1),
                (y > 0, index.wrapping_sub(row)),
                (y + 1 < size[1], index + row),
                (z > 0, index.wrapping_sub(layer)),
                (z + 1 < size[2], index + layer),
            ] {
                if is_there && state[next] == 0 {
                    state[next] = OUTSIDE;
                    rim.push_back(next as u32);
                }
            }
        }
        solid.state = state;
        solid
    }

    /// The index of the cell around a point given in cells.
    fn index_at(&self, p: DVec3) -> Option<usize> {
        let inside = p.min_element() >= 0.0 && (0..3).all(|axis| p[axis] < self.size[axis] as f64);
        inside.then(|| self.index([p.x as usize, p.y as usize, p.z as usize]))
    }

    /// The index of a cell.
    pub fn index(&self, [x, y, z]: [usize; 3]) -> usize {
        (z * self.size[1] + y) * self.size[0] + x
    }

    /// True where a cell is filled.
    pub fn is_filled(&self, at: [usize; 3]) -> bool {
        self.holds(self.index(at))
    }

    /// True where the cell of an index is filled.
    pub fn holds(&self, index: usize) -> bool {
        self.state[index] != OUTSIDE
    }

    /// The middle of the cell of an index.
    pub fn middle_of(&self, index: usize) -> DVec3 {
        let row = self.size[0];
        self.middle([index % row, index / row % self.size[1], index / (row * self.size[1])])
    }

    /// True where a point lies in a filled cell.
    pub fn is_in(&self, p: DVec3) -> bool {
        self.index_at((p - self.low) / self.cell).is_some_and(|index| self.holds(index))
    }

    /// How much of the way from one point to another lies outside, in its units.
    pub fn air(&self, from: DVec3, to: DVec3) -> f64 {
        let length = from.distance(to);
        let steps = (length / (AIR_STEP * self.cell)).ceil().clamp(1.0, MOST_STEPS);
        let is_air = |step: f64| !self.is_in(from.lerp(to, (step + 0.5) / steps));
        let count = (0..steps as usize).filter(|&step| is_air(step as f64)).count();
        length * count as f64 / steps
    }

    /// The middle of a cell.
    pub fn middle(&self, [x, y, z]: [usize; 3]) -> DVec3 {
        self.low + (DVec3::new(x as f64, y as f64, z as f64) + 0.5) * self.cell
    }

    /// The row of cells at a height, clamped to the grid.
    pub fn row(&self, y: f64) -> usize {
        ((y - self.low.y) / self.cell).clamp(0.0, self.size[1] as f64 - 1.0) as usize
    }

    /// A horizontal slice within `reach` of the axis: for each cell how far it is from the nearest empty one, in heights.
    pub fn slice(&self, row: usize, reach: f64) -> Slice {
        let half = ((reach / self.cell).ceil() as usize).min(self.size[0] / 2);
        let first = self.size[0] / 2 - half;
        let (columns, depths) = (2 * half, self.size[2]);
        let mut squares = vec![0.0f32; columns * depths];
        for z in 0..depths {
            for x in 0..columns {
                let is_filled = self.is_filled([first + x, row, z]);
                squares[z * columns + x] = if is_filled { f32::MAX } else { 0.0 };
            }
        }
        distances(&mut squares, columns, depths);
        let depth = squares.into_iter().map(|square| f64::from(square).sqrt() * self.cell).collect();
        Slice { columns, depths, depth, cell: self.cell, low_z: self.low.z }
    }
}

/// How deep the cells of a horizontal slice lie.
pub struct Slice {
    /// Cells along x, the axis in their middle.
    pub columns: usize,
    /// Cells along z.
    pub depths: usize,
    /// How far each cell is from the nearest empty one, in heights.
    pub depth: Vec<f64>,
    /// The side of a cell.
    pub cell: f64,
    /// Where its first cells begin along z.
    pub low_z: f64,
}

/// One of two lobes of a slice: what a leg looks like from above.
#[derive(Clone, Copy, Debug)]
pub struct Lobe {
    /// How far its middle is from the axis.
    pub x: f64,
    /// Depth of its middle.
    pub z: f64,
    /// How deep its deepest cell lies: half of the lesser width.
    pub radius: f64,
}

/// Two lobes of a slice.
#[derive(Clone, Copy, Debug)]
pub struct Lobes {
    /// Left and right.
    pub sides: [Lobe; 2],
    /// How deep the neck between them is, as a share of the lesser radius: 0 where there is air, 1 where they are one.
    pub neck: f64,
}

impl Slice {
    /// The lobes on either side of the axis; `None` where a side is empty.
    pub fn lobes(&self) -> Option<Lobes> {
        let half = self.columns / 2;
        let left = self.deepest(half..self.columns)?;
        let right = self.deepest(0..half)?;
        let radius = self.depth_at(left).min(self.depth_at(right));
        let sides = [self.lobe(left, half..self.columns), self.lobe(right, 0..half)];
        Some(Lobes { sides, neck: self.neck(left, right) / radius })
    }

    /// How much of it is filled, in squared heights.
    pub fn area(&self) -> f64 {
        self.depth.iter().filter(|&&depth| depth > 0.0).count() as f64 * self.cell * self.cell
    }

    fn depth_at(&self, (x, z): (usize, usize)) -> f64 {
        self.depth[z * self.columns + x]
    }

    /// The deepest cell of some columns; of equal ones that furthest from the axis, so that a bar has its lobes at its
    /// ends.
    fn deepest(&self, columns: Range<usize>) -> Option<(usize, usize)> {
        let half = self.columns / 2;
        let cells = (0..self.depths).flat_map(|z| columns.clone().map(move |x| (x, z)));
        let best = cells.max_by(|&a, &b| {
            let aside = |(x, _): (usize, usize)| (2 * x + 1).abs_diff(2 * half);
            self.depth_at(a).total_cmp(&self.depth_at(b)).then(aside(a).cmp(&aside(b))).then(b.cmp(&a))
        })?;
        (self.depth_at(best) > 0.0).then_some(best)
    }

    /// The lobe around its deepest cell: the middle of the cells beside it that are nearly as deep.
    fn lobe(&self, deepest: (usize, usize), columns: Range<usize>) -> Lobe {
        let radius = self.depth_at(deepest);
        let (mut sum, mut count) = ((0.0, 0.0), 0.0);
        let reach = (radius / self.cell).ceil() as usize;
        for z in deepest.1.saturating_sub(reach)..(deepest.1 + reach + 1).min(self.depths) {
            let near = deepest.0.saturating_sub(reach).max(columns.start);
            for x in near..(deepest.0 + reach + 1).min(columns.end) {
                if self.depth_at((x, z)) >= CORE * radius {
                    sum = (sum.0 + x as f64 + 0.5, sum.1 + z as f64 + 0.5);
                    count += 1.0;
                }
            }
        }
        let x = (sum.0 / count - 0.5 * self.columns as f64).abs() * self.cell;
        Lobe { x, z: self.low_z + sum.1 / count * self.cell, radius }
    }

    /// The depth at which two cells come to hang together, from the deepest cells down.
    fn neck(&self, one: (usize, usize), other: (usize, usize)) -> f64 {
        let columns = self.columns;
        let index = |at: (usize, usize)| at.1 * columns + at.0;
        let mut order: Vec<usize> = (0..self.depth.len()).filter(|&cell| self.depth[cell] > 0.0).collect();
        order.sort_unstable_by(|&a, &b| self.depth[b].total_cmp(&self.depth[a]).then(a.cmp(&b)));
        let (a, b) = (index(one), index(other));
        let mut groups = Groups::new(self.depth.len());
        let mut is_in = vec![false; self.depth.len()];
        for cell in order {
            is_in[cell] = true;
            let (x, z) = (cell % columns, cell / columns);
            let around = [
                (x > 0, cell.wrapping_sub(1)),
                (x + 1 < columns, cell + 1),
                (z > 0, cell.wrapping_sub(columns)),
                (z + 1 < self.depths, cell + columns),
            ];
            for (is_there, next) in around {
                if is_there && is_in[next] {
                    groups.join(cell, next);
                }
            }
            // What is not in yet is in a group of its own.
            if groups.least(a) == groups.least(b) {
                return self.depth[cell];
            }
        }
        0.0
    }
}

/// Squares of distances to the nearest 0, in cells, of a plane whose other values are large.
///
/// Felzenszwalb and Huttenlocher. Distance transforms of sampled functions. Theory of Computing 8, 2012.
fn distances(squares: &mut [f32], columns: usize, rows: usize) {
    let mut line = vec![0.0f32; columns.max(rows)];
    for row in 0..rows {
        let row = &mut squares[row * columns..(row + 1) * columns];
        line[..columns].copy_from_slice(row);
        lower_envelope(&line[..columns], |index, value| row[index] = value);
    }
    for column in 0..columns {
        for row in 0..rows {
            line[row] = squares[row * columns + column];
        }
        lower_envelope(&line[..rows], |index, value| squares[index * columns + column] = value);
    }
}

/// The least of the parabolas over all places of a line.
fn lower_envelope(line: &[f32], mut put: impl FnMut(usize, f32)) {
    // Where each parabola begins to be the least.
    let mut least: Vec<(usize, f32)> = Vec::with_capacity(line.len());
    for (at, &value) in line.iter().enumerate() {
        if value == f32::MAX {
            continue;
        }
        let mut begins = f32::NEG_INFINITY;
        while let Some(&(other, from)) = least.last() {
            let (p, q) = (at as f32, other as f32);
            begins = ((value + p * p) - (line[other] + q * q)) / (2.0 * (p - q));
            if begins > from {
                break;
            }
            least.pop();
            begins = f32::NEG_INFINITY;
        }
        least.push((at, begins));
    }
    let mut current = 0;
    for index in 0..line.len() {
        while current + 1 < least.len() && least[current + 1].1 < index as f32 {
            current += 1;
        }
        let value = least.get(current).map_or(f32::MAX, |&(at, _)| {
            let off = index as f32 - at as f32;
            off * off + line[at]
        });
        put(index, value);
    }
}
