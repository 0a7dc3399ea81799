//! Which cells of a grid triangles touch and enclose.
//!
//! Nooruddin and Turk. Simplification and repair of polygonal models using volumetric techniques. TVCG 9(2), 2003
//! (votes of parity). Schwarz and Seidel. Fast parallel surface and solid voxelization on GPUs. SIGGRAPH Asia 2010
//! (the overlap of a triangle and a box).
//!
//! Jacobson, Kavan and Sorkine-Hornung. Robust inside-outside segmentation using generalized winding numbers. SIGGRAPH
//! 2013 (how often a surface goes round a point, however open it is).
//!
//! A cell is enclosed where rays from its middle along the axes leave what counts more often than they enter it: four of the
//! six directions, or three of which two are opposite. So a sleeve is filled that is open at both ends, a jacket that is open
//! in front, and a body whose scalp is left out below its hair. How much more often says how many layers are around it: two
//! for a leg in a skirt. It is enclosed, too, where all six rays meet a wall: so a body is filled that is a hollow skin of two
//! sides, as tools give it that wrap a surface which is open somewhere.

use super::sides::sides;
use super::{MARGIN, Solid};
use crate::geometry::{bounds, triangles_where, weld};
use glam::{DVec3, IVec3};

/// Half the width of a cell, and a little for rounding: surfaces that lie between two cells touch both of them. Seen:
/// at -30 %, vertices move up to 0.003 H; at +30 %, vertices move up to 0.001 H.
const HALF: f64 = 0.5 + 1e-9;
/// Vertices that are this close, in cells, belong together. Seen: ±30 % moves no vertex.
const WELD_TOLERANCE: f64 = 1e-4;
/// Layers around a cell are counted up to this: clothes over clothes over a body.
const MOST_LAYERS: usize = 3;

/// The box of the triangles, of the positions where there are none, without what is no number; empty where there is none.
pub(super) fn extent(positions: &[DVec3], triangles: &[[u32; 3]]) -> (DVec3, DVec3) {
    // Loose points say nothing about how large a figure is, unless there is nothing else.
    let finite = triangles_where(triangles, |vertex| positions[vertex].is_finite());
    let of_triangles = bounds(finite.iter().flatten().map(|&vertex| positions[vertex as usize]));
    let of_points = || bounds(positions.iter().copied().filter(|p| p.is_finite()));
    let extent = if of_triangles.0.is_finite() { of_triangles } else { of_points() };
    if extent.0.is_finite() { extent } else { (DVec3::ZERO, DVec3::ZERO) }
}

/// A triangle in cells, and what there is to say about it.
struct Wall {
    corners: [DVec3; 3],
    is_inward: bool,
    counts: bool,
}

impl Solid {
    /// How many layers of those of `triangles` that `count` accepts are around each cell; 1 for what they touch. `points` in
    /// cells.
    pub(super) fn fill(
        &self,
        points: &[DVec3],
        triangles: &[[u32; 3]],
        count: impl Fn(usize) -> bool,
    ) -> Vec<u8> {
        let walls = walls(points, triangles, count);
        let (low, high) = (IVec3::splat(MARGIN), self.size - 1 - MARGIN);
        let mut touches = vec![false; self.count()];
        let mut layers = self.winding(&walls, true);
        for wall in &walls {
            touched(wall.corners, low, high, |at| {
                let cell = self.index(at);
                touches[cell] = true;
                layers[cell] = layers[cell].max(u8::from(wall.counts));
            });
        }
        // What is hidden on all sides belongs to the body, unless something else encloses it by itself.
        let others = self.winding(&walls, false);
        let between = self.between(&touches);
        for (cell, layers) in layers.iter_mut().enumerate() {
            *layers = (*layers).max(u8::from(between[cell] && !touches[cell] && others[cell] == 0));
        }
        layers
    }

    /// The cells that lie between walls along each of the three axes.
    fn between(&self, walls: &[bool]) -> Vec<bool> {
        let mut between = vec![true; walls.len()];
        for axis in [IVec3::X, IVec3::Y, IVec3::Z] {
            let (step, length) = (self.stride(axis) as usize, self.size.dot(axis) as usize);
            for line in 0..walls.len() / length {
                let first = line % step + line / step * (step * length);
                let line = || (0..length).map(|k| first + k * step);
                let before = line().take_while(|&cell| !walls[cell]);
                let beyond = line().rev().take_while(|&cell| !walls[cell]);
                before.chain(beyond).for_each(|cell| between[cell] = false);
            }
        }
        between
    }

    /// How many layers of those walls are around each cell that count, or that do not.
    fn winding(&self, walls: &[Wall], count: bool) -> Vec<u8> {
        let mut layers = vec![0u8; self.count()];
        let own = || walls.iter().filter(|wall| wall.counts == count);
        let (low, high) = bounds(own().flat_map(|wall| wall.corners));
        if !low.is_finite() {
            return layers;
        }
        // A wall half a cell behind the last cell that is nearest to one is crossed too.
        let (low, high) = (self.nearest(low), self.nearest(high) + 1);
        let lengths = (high - low + 1).to_array();
        let strides = [1, lengths[0] as usize, (lengths[0] * lengths[1]) as usize];
        let cell_count = strides[2] * lengths[2] as usize;
        // By number of layers, a bit for each direction in which there are so many.
        let mut votes = vec![[0u8; MOST_LAYERS]; cell_count];
        // Between each cell and the one before it: how often a ray leaves more than it enters.
        let mut crossings = vec![0i16; cell_count];
        for axis in 0..3 {
            crossings.fill(0);
            let mut is_crossed = vec![false; cell_count / lengths[axis] as usize];
            let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
            for wall in own() {
                let corners = wall.corners.map(|p| p - low.as_dvec3()).map(|p| [p[u], p[v], p[axis]]);
                crossed(corners, [lengths[u], lengths[v]], |i, j, depth, leaves| {
                    let first = depth.ceil().max(0.0) as usize;
                    if first < lengths[axis] as usize {
                        let line = i as usize * strides[u] + j as usize * strides[v];
                        is_crossed[(j * lengths[u] + i) as usize] = true;
                        let sum = &mut crossings[line + first * strides[axis]];
                        *sum = sum.saturating_add(if leaves == wall.is_inward { -1 } else { 1 });
                    }
                });
            }
            for line in (0..is_crossed.len()).filter(|&line| is_crossed[line]) {
                let (i, j) = (line % lengths[u] as usize, line / lengths[u] as usize);
                let start = i * strides[u] + j * strides[v];
                let line = (0..lengths[axis] as usize).map(|k| start + k * strides[axis]);
                let mut beyond: i32 = line.clone().map(|at| i32::from(crossings[at])).sum();
                let mut before = 0;
                for at in line {
                    // Backwards, what leaves enters.
                    before -= i32::from(crossings[at]);
                    beyond -= i32::from(crossings[at]);
                    for (layer, votes) in (1..).zip(&mut votes[at]) {
                        *votes |= u8::from(before >= layer) << (2 * axis)
                            | u8::from(beyond >= layer) << (2 * axis + 1);
                    }
                }
            }
        }
        for (row, votes) in votes.chunks(strides[1]).enumerate() {
            let (y, z) = (row as i32 % lengths[1], row as i32 / lengths[1]);
            let first = self.index(low + IVec3::new(0, y, z));
            for (layers, votes) in layers[first..].iter_mut().zip(votes) {
                *layers = votes.iter().take_while(|&&votes| encloses(votes)).count() as u8;
            }
        }
        layers
    }
}

/// True of four directions of six, or of three of which two are opposite.
fn encloses(directions: u8) -> bool {
    let has_opposite = directions & directions >> 1 & 0b01_01_01 != 0;
    directions.count_ones() >= 4 || directions.count_ones() == 3 && has_opposite
}

/// The finite triangles, each once where a mesh has it twice: once for either side, or in two materials.
fn walls(points: &[DVec3], triangles: &[[u32; 3]], count: impl Fn(usize) -> bool) -> Vec<Wall> {
    let weld = weld(points, WELD_TOLERANCE);
    let mut sorted: Vec<([u32; 3], bool, u32)> = (0u32..)
        .zip(triangles)
        .filter(|(_, corners)| corners.iter().all(|&vertex| points[vertex as usize].is_finite()))
        .map(|(index, &corners)| {
            let mut welded = weld.triangle(corners);
            welded.sort_unstable();
            (welded, !count(index as usize), index)
        })
        .collect();
    sorted.sort_unstable();
    sorted.dedup_by_key(|&mut (welded, ..)| welded);
    sorted.sort_unstable_by_key(|&(.., index)| index);
    let welded: Vec<[u32; 3]> =
        sorted.iter().map(|&(.., index)| weld.triangle(triangles[index as usize])).collect();
    let first = weld.first_vertices();
    let places: Vec<DVec3> = first.iter().map(|&vertex| points[vertex as usize]).collect();
    let sides = sides(&places, &welded);
    sorted
        .iter()
        .zip(sides)
        .map(|(&(_, is_other, index), side)| Wall {
            corners: triangles[index as usize].map(|vertex| points[vertex as usize]),
            is_inward: side.is_inward,
            counts: !is_other,
        })
        .collect()
}

/// Calls `mark` with every cell from `first` to `last` that the triangle touches.
fn touched(corners: [DVec3; 3], first: IVec3, last: IVec3, mut mark: impl FnMut(IVec3)) {
    let [a, b, c] = corners;
    let low = (a.min(b).min(c) - HALF).ceil().as_ivec3().max(first);
    let high = (a.max(b).max(c) + HALF).floor().as_ivec3().min(last);
    let normal = (b - a).cross(c - a);
    // Half-planes of the three projections, each moved outwards by half a cell: n . p + offset >= 0.
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

/// Calls `cross` with every line (u, v) of whole numbers from 0 up to `ends` that crosses the triangle (u, v, depth), its
/// depth there, and whether the triangle faces towards greater depths.
///
/// A line through an edge or a corner crosses exactly one of the triangles of a closed fan: it counts as if moved by an
/// infinitely small amount along u, and by less along v.
fn crossed(corners: [[f64; 3]; 3], ends: [i32; 2], mut cross: impl FnMut(i32, i32, f64, bool)) {
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
    let range = |axis: usize| least(axis).max(0)..=most(axis).min(ends[axis] - 1);
    for j in range(1) {
        for i in range(0) {
            let (u, v) = (f64::from(i), f64::from(j));
            let (of_a, left_a) = side(b, c, u, v);
            let (of_b, left_b) = side(c, a, u, v);
            let (of_c, left_c) = side(a, b, u, v);
            if left_a != left_b || left_b != left_c {
                continue;
            }
            let sum = of_a + of_b + of_c;
            if sum != 0.0 {
                cross(i, j, (of_a * a[2] + of_b * b[2] + of_c * c[2]) / sum, left_a);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::Voxels;
    use super::*;
    use crate::geometry::NONE;
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

    /// A tube of radius `radius` about y from 0 to 1, open at both ends.
    fn tube(radius: f64) -> (Vec<DVec3>, Vec<[u32; 3]>) {
        let rings = 20;
        let (mut positions, mut triangles) = (Vec::new(), Vec::new());
        for ring in 0..rings {
            for side in 0..24 {
                let (sin, cos) = (TAU * f64::from(side) / 24.0).sin_cos();
                positions.push(DVec3::new(
                    radius * cos,
                    f64::from(ring) / f64::from(rings - 1),
                    radius * sin,
                ));
            }
        }
        for ring in 1..rings as u32 {
            for side in 0..24 {
                let [a, b] = [side, (side + 1) % 24].map(|side| 24 * (ring - 1) + side);
                triangles.extend([[a, b, b + 24], [a, b + 24, a + 24]]);
            }
        }
        (positions, triangles)
    }

    fn count(solid: &Solid, choose: impl Fn(DVec3) -> bool) -> usize {
        let cells = (0..solid.layers.len()).filter(|&cell| solid.layers[cell] > 0);
        cells.filter(|&cell| choose(solid.place(cell).as_dvec3())).count()
    }

    /// Cells within .19 of (0, .5, 0) beside those of a ball.
    fn ball_share(solid: &Solid) -> f64 {
        let middle = solid.to_cells(DVec3::new(0.0, 0.5, 0.0));
        let radius = 0.19 / solid.cell;
        count(solid, |p| p.distance(middle) < radius) as f64
            / (4.0 / 3.0 * std::f64::consts::PI * radius.powi(3))
    }

    #[test]
    fn a_box_is_filled_and_nothing_beyond_it() {
        let (positions, triangles) = cube(DVec3::ZERO, DVec3::new(1.0, 0.5, 0.25));
        let solid = Solid::of_body(&positions, &triangles, 32).unwrap();
        // 32 cells long, centred on a cell: 31 whole ones and half of one at either end; 16 and 8 likewise.
        assert_eq!(count(&solid, |_| true), 33 * 17 * 9);
    }

    #[test]
    fn a_tube_open_at_both_ends_is_filled() {
        let (positions, mut triangles) = tube(0.2);
        let solid = Solid::of_body(&positions, &triangles, 64).unwrap();
        assert!((ball_share(&solid) - 1.0).abs() < 0.02, "{}", ball_share(&solid));
        // Any flipped triangles, and the same triangles twice, once for either side, change nothing; a second shell
        // around the first is another layer.
        let mut flipped = triangles.clone();
        flipped.iter_mut().step_by(3).for_each(|corners| corners.swap(0, 1));
        assert_eq!(Solid::of_body(&positions, &flipped, 64).unwrap().layers, solid.layers);
        let mut doubled = triangles.clone();
        doubled.extend(triangles.iter().map(|&[a, b, c]| [a, c, b]));
        assert_eq!(Solid::of_body(&positions, &doubled, 64).unwrap().layers, solid.layers);
        let mut shells = positions.clone();
        shells.extend(positions.iter().map(|p| DVec3::new(1.5 * p.x, p.y, 1.5 * p.z)));
        let count = positions.len() as u32;
        triangles.extend(triangles.clone().into_iter().map(|corners| corners.map(|vertex| vertex + count)));
        let both = Solid::of_body(&shells, &triangles, 64).unwrap();
        let layers = |x: f64| both.layers(both.to_cells(DVec3::new(x, 0.5, 0.0)).round().as_ivec3());
        assert_eq!([0.0, 0.25, 0.31].map(layers), [2, 1, 0]);
    }

    /// A ball that is a hollow skin of two sides, with a hole on top, through which its inside is outside.
    #[test]
    fn a_hollow_skin_with_a_hole_is_filled_but_below_the_hole() {
        let (hole, turns) = (0.2_f64.asin(), 40);
        let polar = |turn: usize| hole + (std::f64::consts::PI - hole) * turn as f64 / f64::from(turns);
        let outer = (0..=turns as usize).map(|turn| (0.4, polar(turn)));
        let inner = (0..=turns as usize).rev().map(|turn| (0.37, polar(turn)));
        let profile: Vec<(f64, f64)> = outer.chain(inner).collect();
        let (mut positions, mut triangles) = (Vec::new(), Vec::new());
        for (row, &(radius, polar)) in profile.iter().enumerate() {
            for side in 0..48 {
                let (sin, cos) = (TAU * f64::from(side) / 48.0).sin_cos();
                let across = radius * polar.sin();
                positions.push(DVec3::new(across * cos, 0.5 + radius * polar.cos(), across * sin));
                let corner = |row: usize, side: u32| (row % profile.len()) as u32 * 48 + side % 48;
                let [a, b, c, d] =
                    [(0, 0), (0, 1), (1, 1), (1, 0)].map(|(down, on)| corner(row + down, side as u32 + on));
                triangles.extend([[a, b, c], [a, c, d]]);
            }
        }
        let solid = Solid::new(&positions, &triangles, |_| true, 0.0, 80.0).unwrap();
        // The hole is .2 * .37 wide to its rim, and up to a cell narrower between cells that touch that: such a column holds
        // 1 - (1 - (r / .19)^2)^1.5 of a ball of radius .19, .15 to .22.
        assert!((0.77..0.86).contains(&ball_share(&solid)), "{}", ball_share(&solid));
        assert!(!solid.is_in(DVec3::new(0.0, 0.5, 0.0)), "what is below the hole is filled");
        let beside = |x: f64| solid.is_in(DVec3::new(x, 0.5, 0.0));
        assert!([-0.3, -0.12, 0.12, 0.3].into_iter().all(beside), "what is beside the hole is not");
    }

    #[test]
    fn what_does_not_count_is_a_wall_alone() {
        // A tube open at both ends, and a box over its upper end.
        let (mut positions, mut triangles) = tube(0.2);
        let (own, first) = (triangles.len(), positions.len() as u32);
        let (corners, faces) = cube(DVec3::new(-0.3, 0.8, -0.3), DVec3::new(0.3, 1.1, 0.3));
        positions.extend(corners);
        triangles.extend(faces.into_iter().map(|corners| corners.map(|vertex| vertex + first)));
        let solid = Solid::new(&positions, &triangles, |triangle| triangle < own, 0.0, 64.0).unwrap();
        assert!((ball_share(&solid) - 1.0).abs() < 0.02, "{}", ball_share(&solid));
        assert!(!solid.is_in(DVec3::new(0.25, 0.9, 0.25)), "the box is filled");
        assert!(solid.is_in(DVec3::new(0.0, 0.9, 0.0)), "the tube is not filled in the box");
    }

    #[test]
    fn a_line_through_an_edge_crosses_once() {
        // A fan around a corner that lies on a line.
        let rim = [[-2.0, -2.0], [3.0, -1.0], [2.0, 3.0], [-1.0, 2.0]].map(|[u, v]| [u + 4.0, v + 4.0]);
        let mut total = 0;
        for i in 0..4 {
            let [a, b] = [rim[i], rim[(i + 1) % 4]].map(|[u, v]| [u, v, 1.0]);
            crossed([[4.0, 4.0, 1.0], a, b], [9, 9], |i, j, depth, leaves| {
                assert!((depth - 1.0).abs() < 1e-12 && leaves);
                total += usize::from((i, j) == (4, 4));
            });
        }
        assert_eq!(total, 1);
    }

    #[test]
    fn a_slanted_triangle_touches_every_cell_it_passes() {
        let corners = [DVec3::new(0.3, 0.2, 0.1), DVec3::new(9.7, 3.1, 5.5), DVec3::new(2.2, 8.8, 7.3)];
        let mut marked = std::collections::BTreeSet::new();
        touched(corners, IVec3::splat(-1), IVec3::splat(20), |at| {
            marked.insert(at.to_array());
        });
        let mut sampled = std::collections::BTreeSet::new();
        for i in 0..=300 {
            for j in 0..=300 - i {
                let [u, v] = [f64::from(i) / 300.0, f64::from(j) / 300.0];
                let p = (1.0 - u - v) * corners[0] + u * corners[1] + v * corners[2];
                sampled.insert(p.round().as_ivec3().to_array());
            }
        }
        assert!(sampled.is_subset(&marked));
        // Those that are touched at an edge only are missed by samples: few.
        assert!(marked.len() <= sampled.len() + sampled.len() / 10, "{} {}", marked.len(), sampled.len());
    }

    #[test]
    fn degenerate_figures_have_a_cell_for_each_vertex() {
        let point = Solid::of_body(&[DVec3::ONE; 3], &[[0, 1, 2]], 64).unwrap();
        assert_eq!(count(&point, |_| true), 1);
        assert_eq!(count(&Solid::of_body(&[], &[], 64).unwrap(), |_| true), 0);
        let loose = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::splat(1e30), DVec3::NAN];
        let voxels = Voxels::of(Solid::of_body(&loose, &[[0, 1, 2]], 16).unwrap());
        for p in loose {
            assert_ne!(voxels.slot(voxels.solid.nearest(voxels.solid.to_cells(p))), NONE, "{p}");
        }
    }
}
