//! Horizontal slices of a solid, and how deep their cells lie.

use super::Solid;
use crate::geometry::Groups;
use glam::IVec3;
use std::ops::Range;

/// Cells this nearly as deep as the deepest are the core of a limb.
const CORE: f64 = 0.7;

/// Two lobes of a slice are one where the neck between them is this share of their radius.
const ONE: f64 = 0.8;

/// How deep the cells of a horizontal slice lie.
pub struct Slice {
    /// Cells along x, odd, the axis through the middle one.
    pub columns: usize,
    /// Cells along z.
    pub depths: usize,
    /// How far each cell is from the nearest empty one, in heights.
    pub depth: Vec<f64>,
    /// The side of a cell.
    pub cell: f64,
    /// The middle of its first cells along z.
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

impl Solid {
    /// A horizontal slice within `reach` of the axis: for each cell with so many layers around it how far it is from the nearest
    /// one without, in heights.
    pub fn slice(&self, row: i32, reach: f64, layers: u8) -> Slice {
        let half = ((reach / self.cell).round() as i32).min(self.size.x / 2);
        let first = self.size.x / 2 - half;
        let (columns, depths) = (2 * half + 1, self.size.z);
        let cells = (0..depths).flat_map(|z| (first..first + columns).map(move |x| IVec3::new(x, row, z)));
        let large = |at: IVec3| if self.layers(at) >= layers { f32::MAX } else { 0.0 };
        let mut squares: Vec<f32> = cells.map(large).collect();
        let (columns, depths) = (columns as usize, depths as usize);
        distances(&mut squares, columns, depths);
        let depth = squares.into_iter().map(|square| f64::from(square).sqrt() * self.cell).collect();
        Slice { columns, depths, depth, cell: self.cell, low_z: self.low.z }
    }
}

impl Lobes {
    /// False where the neck between them is about as thick as they are: thighs that touch are still two.
    pub fn are_two(&self) -> bool {
        self.neck < ONE
    }

    /// True where both lie over those of the slice below.
    pub fn go_on(&self, below: &Self) -> bool {
        let goes_on = |(one, other): (&Lobe, &Lobe)| (one.x - other.x).hypot(one.z - other.z) < other.radius;
        self.sides.iter().zip(&below.sides).all(goes_on)
    }
}

impl Slice {
    /// The lobes on either side of the axis; `None` where a side is empty.
    pub fn lobes(&self) -> Option<Lobes> {
        let half = self.columns / 2;
        let (of_right, of_left) = (0..half, half + 1..self.columns);
        let left = self.deepest(of_left.clone())?;
        let right = self.deepest(of_right.clone())?;
        let radius = self.depth_at(left).min(self.depth_at(right));
        let sides = [self.lobe(left, of_left), self.lobe(right, of_right)];
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
            let aside = |(x, _): (usize, usize)| x.abs_diff(half);
            self.depth_at(a).total_cmp(&self.depth_at(b)).then(aside(a).cmp(&aside(b))).then(b.cmp(&a))
        })?;
        (self.depth_at(best) > 0.0).then_some(best)
    }

    /// The lobe around its deepest cell: the middle of the cells beside it that are nearly as deep.
    fn lobe(&self, deepest: (usize, usize), columns: Range<usize>) -> Lobe {
        let radius = self.depth_at(deepest);
        let reach = (radius / self.cell).ceil() as usize;
        let near = |at: usize, all: &Range<usize>| {
            at.saturating_sub(reach).max(all.start)..(at + reach + 1).min(all.end)
        };
        let (across, along) = (near(deepest.0, &columns), near(deepest.1, &(0..self.depths)));
        let cells = along.flat_map(|z| across.clone().map(move |x| (x, z)));
        let (x, z): (Vec<usize>, Vec<usize>) = cells.filter(|&at| self.depth_at(at) >= CORE * radius).unzip();
        let mean = |places: Vec<usize>| places.iter().sum::<usize>() as f64 / places.len() as f64;
        let x = (mean(x) - (self.columns / 2) as f64).abs() * self.cell;
        Lobe { x, z: self.low_z + mean(z) * self.cell, radius }
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
    // Where each line starts, how far apart its places are, and how many it has.
    let along_rows = (0..rows).map(|row| (row * columns, 1, columns));
    let along_columns = (0..columns).map(|column| (column, columns, rows));
    let mut line = Vec::with_capacity(columns.max(rows));
    for (start, step, count) in along_rows.chain(along_columns) {
        line.clear();
        line.extend((0..count).map(|index| squares[start + index * step]));
        lower_envelope(&line, |index, value| squares[start + index * step] = value);
    }
}

/// The least of the parabolas over all places of a line.
fn lower_envelope(line: &[f32], mut put: impl FnMut(usize, f32)) {
    if line.iter().all(|&value| value == 0.0) {
        return;
    }
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
