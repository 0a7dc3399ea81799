//! A figure as voxels: what its surface touches and what it encloses, however open, patched or flipped the surface is.
//!
//! Nooruddin and Turk. Simplification and repair of polygonal models using volumetric techniques. TVCG 9(2), 2003
//! (votes of parity). Schwarz and Seidel. Fast parallel surface and solid voxelization on GPUs. SIGGRAPH Asia 2010
//! (the overlap of a triangle and a box).

use crate::geometry::{bounds, components, weld};
use glam::{DVec3, IVec3};

/// The slot of a cell that is outside.
pub const OUTSIDE: u32 = u32::MAX;

/// Layers of empty cells around the figure, so that neither its surface nor its neighbours reach the grid's end. Seen:
/// ±30 % moves no vertex.
const PADDING: i32 = 2;
/// Half the width of a voxel, and a little for rounding: surfaces that lie between two voxels touch both of them. Seen:
/// at -30 %, vertices move up to 0.003 H; at +30 %, vertices move up to 0.001 H.
const HALF: f64 = 0.5 + 1e-9;
/// A component's inside is looked for until boxes of so many grids were searched, the largest surfaces first. Seen:
/// ±30 % moves no vertex.
const SEARCH_BUDGET: usize = 64;
/// Vertices that are this close, in voxels, belong together. Seen: ±30 % moves no vertex.
const WELD_TOLERANCE: f64 = 1e-4;
/// Fewer triangles enclose nothing: a tetrahedron has four. Seen: ±30 % moves no vertex.
const LEAST_TRIANGLES: usize = 4;

/// The voxels of a figure that are not outside it, in a grid whose middle voxel is centred on the middle of the figure's
/// bounding box: a symmetric figure has a symmetric volume, and its plane of symmetry goes through voxels, not between
/// them.
#[derive(Clone, Debug)]
pub struct Volume {
    /// Cells along each axis, odd.
    pub size: IVec3,
    /// For each cell of the grid, x running fastest, the voxel's slot, or `OUTSIDE`.
    pub slots: Vec<u32>,
    /// For each slot its cell.
    pub cells: Vec<u32>,
    /// The length of a voxel's edge.
    pub edge: f64,
    centre: DVec3,
    low: DVec3,
    high: DVec3,
}

impl Volume {
    /// The volume of `triangles` between `positions`, with `resolution` voxels along the longest side.
    ///
    /// A voxel is in the volume where a triangle touches it; where it cannot be reached from outside; or where rays from
    /// its middle along the axes cross one component, or all of them together, an odd number of times in at least four of
    /// the six directions, or in three of which two are opposite: so a sleeve is filled, though it is open at both ends,
    /// and so is a jacket that is open in front. Every vertex has its voxel, a vertex of no triangle as well.
    ///
    /// Where there are no finite positions the volume is empty.
    pub fn new(positions: &[DVec3], triangles: &[[u32; 3]], resolution: usize) -> Self {
        let mut volume = Self::grid(positions, triangles, resolution);
        let points: Vec<DVec3> = positions.iter().map(|&p| volume.to_grid(p)).collect();
        let finite = |triangle: &&[u32; 3]| triangle.iter().all(|&v| positions[v as usize].is_finite());
        let triangles: Vec<[u32; 3]> = triangles.iter().filter(finite).copied().collect();
        let mut is_in = vec![false; volume.slots.len()];
        for &p in &points {
            is_in[volume.cell(nearest(p))] = true;
        }
        for triangle in &triangles {
            let corners = triangle.map(|vertex| points[vertex as usize]);
            touched(corners, |at| is_in[volume.cell(at)] = true);
        }
        let mut inside = volume.enclosed(&is_in);
        volume.vote(&points, &triangles, &mut inside);
        for (is_in, inside) in is_in.iter_mut().zip(inside) {
            *is_in |= inside;
        }
        for (cell, _) in is_in.iter().enumerate().filter(|&(_, &is_in)| is_in) {
            volume.slots[cell] = volume.cells.len() as u32;
            volume.cells.push(cell as u32);
        }
        volume
    }

    /// The grid alone, without a voxel in it.
    pub fn grid(positions: &[DVec3], triangles: &[[u32; 3]], resolution: usize) -> Self {
        let finite = |triangle: &&[u32; 3]| triangle.iter().all(|&v| positions[v as usize].is_finite());
        // Loose points say nothing about how large a figure is, unless there is nothing else.
        let corners = triangles.iter().filter(finite).flatten();
        let (mut low, mut high) = bounds(corners.map(|&vertex| positions[vertex as usize]));
        if !low.is_finite() {
            (low, high) = bounds(positions.iter().copied().filter(|p| p.is_finite()));
        }
        if !low.is_finite() {
            (low, high) = (DVec3::ZERO, DVec3::ZERO);
        }
        let centre = low + (high - low) / 2.0;
        let edge = (high - low).max_element() / resolution as f64;
        let edge = if edge.is_normal() { edge } else { 1.0 };
        let half = ((high - low) / (2.0 * edge) - 0.5).ceil().max(DVec3::ZERO).as_ivec3() + PADDING;
        let size = 2 * half + 1;
        let cell_count = size.as_i64vec3().element_product() as usize;
        Self { size, slots: vec![OUTSIDE; cell_count], cells: Vec::new(), edge, centre, low, high }
    }

    /// `p` in voxels: the middle of a voxel has whole numbers. What lies beyond the figure is moved to its bounding box;
    /// what is no number, to the middle.
    pub fn to_grid(&self, p: DVec3) -> DVec3 {
        let p = if p.is_finite() { p.clamp(self.low, self.high) } else { self.centre };
        self.to_grid_free(p)
    }

    /// As [`Self::to_grid`], but what lies beyond the figure stays there.
    pub fn to_grid_free(&self, p: DVec3) -> DVec3 {
        (p - self.centre) / self.edge + (self.size / 2).as_dvec3()
    }

    /// The number of the cell at `at`, which lies in the grid.
    pub fn cell(&self, at: IVec3) -> usize {
        (at.x + self.size.x * (at.y + self.size.y * at.z)) as usize
    }

    /// The voxel at `at`, or `OUTSIDE`.
    pub fn slot(&self, at: IVec3) -> u32 {
        if at.cmplt(IVec3::ZERO).any() || at.cmpge(self.size).any() {
            return OUTSIDE;
        }
        self.slots[self.cell(at)]
    }

    /// The place of a cell in the grid.
    pub fn place(&self, cell: u32) -> IVec3 {
        let cell = cell as i32;
        IVec3::new(cell % self.size.x, cell / self.size.x % self.size.y, cell / (self.size.x * self.size.y))
    }

    /// How far the cell at an offset is in memory.
    pub fn stride(&self, offset: IVec3) -> isize {
        let size = self.size;
        (offset.x + size.x * (offset.y + size.y * offset.z)) as isize
    }

    /// The cells that cannot be reached from the grid's end through faces of cells that are not in `surface`.
    fn enclosed(&self, surface: &[bool]) -> Vec<bool> {
        let mut unreached = vec![true; surface.len()];
        let strides = [IVec3::X, IVec3::Y, IVec3::Z].map(|axis| self.stride(axis));
        let mut open = vec![0u32];
        unreached[0] = false;
        while let Some(cell) = open.pop() {
            let at = self.place(cell).to_array();
            for axis in 0..3 {
                for step in [-1, 1] {
                    if !(0..self.size[axis]).contains(&(at[axis] + step)) {
                        continue;
                    }
                    let next = (cell as isize + step as isize * strides[axis]) as usize;
                    if unreached[next] && !surface[next] {
                        unreached[next] = false;
                        open.push(next as u32);
                    }
                }
            }
        }
        unreached
    }

    /// Marks what components enclose by the votes of their parity, each by itself and all together.
    fn vote(&self, points: &[DVec3], triangles: &[[u32; 3]], inside: &mut [bool]) {
        let all: Vec<u32> = (0..triangles.len() as u32).collect();
        self.vote_on(points, triangles, &all, inside);
        // Shells over shells are even together, so each has a vote of its own; pieces of one patched surface are odd
        // together only.
        let weld = weld(points, WELD_TOLERANCE);
        let components = components(triangles, &weld);
        let component_of = |triangle: u32| {
            components[weld.representative[triangles[triangle as usize][0] as usize] as usize]
        };
        let mut order = all;
        order.sort_by_key(|&triangle| component_of(triangle));
        let area = |triangle: u32| {
            let [a, b, c] = triangles[triangle as usize].map(|vertex| points[vertex as usize]);
            (b - a).cross(c - a).length()
        };
        let mut pieces: Vec<(f64, &[u32])> = order
            .chunk_by(|&one, &other| component_of(one) == component_of(other))
            .filter(|piece| piece.len() >= LEAST_TRIANGLES && piece.len() < triangles.len())
            .map(|piece| (piece.iter().map(|&triangle| area(triangle)).sum(), piece))
            .collect();
        pieces.sort_by(|one, other| other.0.total_cmp(&one.0));
        let mut budget = SEARCH_BUDGET.saturating_mul(self.slots.len());
        for (_, piece) in pieces {
            let (low, high) = self.box_of(points, triangles, piece);
            let Some(left) = budget.checked_sub((high - low + 1).as_i64vec3().element_product() as usize)
            else {
                break;
            };
            budget = left;
            self.vote_on(points, triangles, piece, inside);
        }
    }

    /// The first and the last cell along each axis that the triangles of `piece` can touch.
    fn box_of(&self, points: &[DVec3], triangles: &[[u32; 3]], piece: &[u32]) -> (IVec3, IVec3) {
        let corners = piece.iter().flat_map(|&triangle| triangles[triangle as usize]);
        let (low, high) = bounds(corners.map(|vertex| points[vertex as usize]));
        (nearest(low), nearest(high))
    }

    /// Marks the cells that the triangles of `piece` together enclose.
    fn vote_on(&self, points: &[DVec3], triangles: &[[u32; 3]], piece: &[u32], inside: &mut [bool]) {
        if piece.is_empty() {
            return;
        }
        let (low, high) = self.box_of(points, triangles, piece);
        let size = high - low + 1;
        // What is two voxels thick is all surface.
        if size.min_element() < 3 {
            return;
        }
        let strides = [1, size.x as usize, (size.x * size.y) as usize];
        let lengths = size.to_array().map(|length| length as usize);
        // Of each cell: for each axis whether the number of crossings between its middle and that of the cell before is
        // odd.
        let mut crossings = vec![0u8; lengths.iter().product()];
        for &triangle in piece {
            let corners = triangles[triangle as usize].map(|vertex| points[vertex as usize] - low.as_dvec3());
            for axis in 0..3 {
                let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
                crossed(corners.map(|p| [p[u], p[v], p[axis]]), |i, j, depth| {
                    let first = depth.ceil().max(0.0) as usize;
                    if (0..size[u]).contains(&i) && (0..size[v]).contains(&j) && first < lengths[axis] {
                        let line = i as usize * strides[u] + j as usize * strides[v];
                        crossings[line + first * strides[axis]] ^= 1 << axis;
                    }
                });
            }
        }
        // The low bits count votes; the fourth bit is set where two are opposite.
        let mut votes = vec![0u8; crossings.len()];
        for axis in 0..3 {
            let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
            for j in 0..lengths[v] {
                for i in 0..lengths[u] {
                    let line = i * strides[u] + j * strides[v];
                    let on_line = (0..lengths[axis]).map(|k| line + k * strides[axis]);
                    let total = on_line.clone().fold(0, |total, at| total ^ (crossings[at] >> axis & 1));
                    let mut before = 0;
                    for at in on_line {
                        before ^= crossings[at] >> axis & 1;
                        let after = total ^ before;
                        votes[at] = (votes[at] + before + after) | ((before & after) << 3);
                    }
                }
            }
        }
        let mut at = 0;
        for z in 0..size.z {
            for y in 0..size.y {
                let row = self.cell(low + IVec3::new(0, y, z));
                for cell in &mut inside[row..row + lengths[0]] {
                    let vote = votes[at];
                    *cell |= vote & 7 >= 4 || vote == 8 + 3;
                    at += 1;
                }
            }
        }
    }
}

/// The cell around `p`, in voxels.
pub fn nearest(p: DVec3) -> IVec3 {
    p.round().as_ivec3()
}

/// Calls `mark` with every cell that the triangle touches, in voxels.
fn touched(corners: [DVec3; 3], mut mark: impl FnMut(IVec3)) {
    let [a, b, c] = corners;
    let low = (a.min(b).min(c) - HALF).ceil().as_ivec3();
    let high = (a.max(b).max(c) + HALF).floor().as_ivec3();
    let normal = (b - a).cross(c - a);
    // Half-planes of the three projections, each moved outwards by half a voxel: n . p + offset >= 0.
    let mut edges = [[(0.0, 0.0, 0.0); 3]; 3];
    for (axis, edges) in edges.iter_mut().enumerate() {
        let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
        let turn = if normal[axis] < 0.0 { -1.0 } else { 1.0 };
        for (edge, (from, to)) in edges.iter_mut().zip([(a, b), (b, c), (c, a)]) {
            let (nu, nv) = (turn * (from[v] - to[v]), turn * (to[u] - from[u]));
            *edge = (nu, nv, HALF * (nu.abs() + nv.abs()) - nu * from[u] - nv * from[v]);
        }
    }
    let reach = HALF * normal.abs().element_sum();
    let is_over =
        |axis: usize, u: f64, v: f64| edges[axis].iter().all(|&(nu, nv, o)| nu * u + nv * v + o >= 0.0);
    for z in low.z..=high.z {
        for y in low.y..=high.y {
            if !is_over(0, f64::from(y), f64::from(z)) {
                continue;
            }
            for x in low.x..=high.x {
                let at = IVec3::new(x, y, z);
                let p = at.as_dvec3();
                if normal.dot(p - a).abs() <= reach && is_over(1, p.z, p.x) && is_over(2, p.x, p.y) {
                    mark(at);
                }
            }
        }
    }
}

/// Calls `cross` with every line (u, v) of whole numbers that crosses the triangle (u, v, depth), and its depth there.
///
/// A line through an edge or a corner crosses exactly one of the triangles of a closed fan: it counts as if moved by an
/// infinitely small amount along u, and by less along v.
fn crossed(corners: [[f64; 3]; 3], mut cross: impl FnMut(i32, i32, f64)) {
    let least = |axis: usize| corners.iter().map(|p| p[axis]).fold(f64::INFINITY, f64::min).ceil() as i32;
    let most = |axis: usize| corners.iter().map(|p| p[axis]).fold(f64::NEG_INFINITY, f64::max).floor() as i32;
    // Twice the area of (from, to, p), with its sign where it is 0; computed alike from both sides of an edge.
    let side = |from: [f64; 3], to: [f64; 3], u: f64, v: f64| -> (f64, bool) {
        let is_swapped = (to[0], to[1]) < (from[0], from[1]);
        let (a, b) = if is_swapped { (to, from) } else { (from, to) };
        let area = (b[0] - a[0]) * (v - a[1]) - (b[1] - a[1]) * (u - a[0]);
        let is_left = if area != 0.0 {
            area > 0.0
        } else if b[1] != a[1] {
            b[1] < a[1]
        } else {
            b[0] > a[0]
        };
        if is_swapped { (-area, !is_left) } else { (area, is_left) }
    };
    let [a, b, c] = corners;
    let (us, vs) = (least(0)..=most(0), least(1)..=most(1));
    for j in vs {
        for i in us.clone() {
            let (u, v) = (f64::from(i), f64::from(j));
            let (of_a, left_a) = side(b, c, u, v);
            let (of_b, left_b) = side(c, a, u, v);
            let (of_c, left_c) = side(a, b, u, v);
            if left_a != left_b || left_b != left_c {
                continue;
            }
            let sum = of_a + of_b + of_c;
            if sum != 0.0 {
                cross(i, j, (of_a * a[2] + of_b * b[2] + of_c * c[2]) / sum);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    /// A box of 12 triangles.
    fn cube(low: DVec3, high: DVec3) -> (Vec<DVec3>, Vec<[u32; 3]>) {
        let corner = |i: u32| {
            let pick = |bit: u32, axis: usize| if i >> bit & 1 == 1 { high[axis] } else { low[axis] };
            DVec3::new(pick(0, 0), pick(1, 1), pick(2, 2))
        };
        let faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
        let triangles = faces.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
        ((0..8).map(corner).collect(), triangles)
    }

    fn count(volume: &Volume, choose: impl Fn(DVec3) -> bool) -> usize {
        volume.cells.iter().filter(|&&cell| choose(volume.place(cell).as_dvec3())).count()
    }

    #[test]
    fn a_box_is_filled_and_nothing_beyond_it() {
        let (positions, triangles) = cube(DVec3::ZERO, DVec3::new(1.0, 0.5, 0.25));
        let volume = Volume::new(&positions, &triangles, 32);
        // 32 voxels long, centred on a voxel: 31 whole ones and half of one at either end; 16 and 8 likewise.
        assert_eq!(volume.cells.len(), 33 * 17 * 9);
    }

    #[test]
    fn a_tube_open_at_both_ends_is_filled() {
        let rings = 20;
        let mut positions = Vec::new();
        let mut triangles = Vec::new();
        for ring in 0..rings {
            for side in 0..24 {
                let (sin, cos) = (TAU * f64::from(side) / 24.0).sin_cos();
                positions.push(DVec3::new(0.2 * cos, f64::from(ring) / f64::from(rings - 1), 0.2 * sin));
            }
        }
        for ring in 1..rings as u32 {
            for side in 0..24 {
                let [a, b] = [side, (side + 1) % 24].map(|side| 24 * (ring - 1) + side);
                triangles.extend([[a, b, b + 24], [a, b + 24, a + 24]]);
            }
        }
        let volume = Volume::new(&positions, &triangles, 64);
        let middle = volume.to_grid(DVec3::new(0.0, 0.5, 0.0));
        let full = count(&volume, |p| (p - middle).length() < 0.19 * 64.0);
        let ball = 4.0 / 3.0 * std::f64::consts::PI * (0.19f64 * 64.0).powi(3);
        assert!((full as f64 / ball - 1.0).abs() < 0.02, "{full} of {ball}");
        // Any flipped triangles, and a second shell around the first, change nothing.
        let mut flipped = triangles.clone();
        flipped.iter_mut().step_by(3).for_each(|corners| corners.swap(0, 1));
        assert_eq!(Volume::new(&positions, &flipped, 64).cells, volume.cells);
        let mut shells = positions.clone();
        shells.extend(positions.iter().map(|p| DVec3::new(1.5 * p.x, p.y, 1.5 * p.z)));
        let count = positions.len() as u32;
        triangles.extend(triangles.clone().into_iter().map(|corners| corners.map(|vertex| vertex + count)));
        let both = Volume::new(&shells, &triangles, 64);
        let middle = both.to_grid(DVec3::new(0.0, 0.5, 0.0));
        assert_ne!(both.slot(nearest(middle)), OUTSIDE);
        assert_ne!(both.slot(nearest(middle + DVec3::X * 0.25 * 64.0)), OUTSIDE);
    }

    #[test]
    fn a_line_through_an_edge_crosses_once() {
        // A fan around a corner that lies on a line.
        let rim = [[-2.0, -2.0], [3.0, -1.0], [2.0, 3.0], [-1.0, 2.0]];
        let mut total = 0;
        for i in 0..4 {
            let [a, b] = [rim[i], rim[(i + 1) % 4]].map(|[u, v]| [u, v, 1.0]);
            crossed([[0.0, 0.0, 1.0], a, b], |i, j, depth| {
                assert!((depth - 1.0).abs() < 1e-12);
                total += usize::from((i, j) == (0, 0));
            });
        }
        assert_eq!(total, 1);
    }

    #[test]
    fn a_slanted_triangle_touches_every_voxel_it_passes() {
        let corners = [DVec3::new(0.3, 0.2, 0.1), DVec3::new(9.7, 3.1, 5.5), DVec3::new(2.2, 8.8, 7.3)];
        let mut marked = std::collections::BTreeSet::new();
        touched(corners, |at| {
            marked.insert(at.to_array());
        });
        let mut sampled = std::collections::BTreeSet::new();
        for i in 0..=300 {
            for j in 0..=300 - i {
                let [u, v] = [f64::from(i) / 300.0, f64::from(j) / 300.0];
                let p = (1.0 - u - v) * corners[0] + u * corners[1] + v * corners[2];
                sampled.insert(nearest(p).to_array());
            }
        }
        assert!(sampled.is_subset(&marked));
        // Those that are touched at an edge only are missed by samples: few.
        assert!(marked.len() <= sampled.len() + sampled.len() / 10, "{} {}", marked.len(), sampled.len());
    }

    #[test]
    fn degenerate_figures_have_a_voxel_for_each_vertex() {
        let point = Volume::new(&[DVec3::ONE; 3], &[[0, 1, 2]], 64);
        assert_eq!(point.cells.len(), 1);
        assert!(Volume::new(&[], &[], 64).cells.is_empty());
        let loose = Volume::new(&[DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::splat(1e30)], &[[0, 1, 2]], 16);
        let at = loose.to_grid(DVec3::splat(1e30));
        assert_ne!(loose.slot(nearest(at)), OUTSIDE);
        let odd = Volume::new(&[DVec3::ZERO, DVec3::X, DVec3::NAN], &[[0, 1, 2]], 16);
        assert!(!odd.cells.is_empty());
    }
}
