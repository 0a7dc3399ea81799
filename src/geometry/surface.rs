//! Rays and closest points on a mesh. The only files that know obvhs, which builds the tree of boxes.
//!
//! Woop, Benthin and Wald. Watertight ray/triangle intersection. JCGT 2(1), 2013.
//! Ericson. Real-time collision detection. 2005, §5.1.5 (closest point on a triangle).
//!
//! A character is symmetric, and the rays of §V-A start in its plane of symmetry, so they run exactly along
//! edges and through vertices. Such rays must not slip between triangles: the triangle test is watertight, and
//! the boxes are padded, because the tree keeps them in single precision.

mod box_tree;
mod wide;

pub use box_tree::Tree;

use super::bounds;
use glam::{BVec4A, DVec3, Vec3A, Vec4};
use obvhs::BvhBuildParams;
use obvhs::aabb::Aabb;
use obvhs::bvh2::Bvh2;
use obvhs::bvh2::leaf_collapser::collapse;
use obvhs::bvh2::reinsertion::ReinsertionOptimizer;
use obvhs::ploc::PlocBuilder;
use wide::{Child, LANES, Node, Slopes};

/// Padding of the boxes, in units of the scene's largest extent: above the rounding of single precision. Seen: ±30 %
/// moves no vertex.
const BOX_PADDING: f32 = 1e-6;

/// Triangles whose height is below this, in units of the scene's largest extent, are degenerate. Seen: ±30 % moves no
/// vertex.
const LEAST_HEIGHT: f64 = 1e-15;

/// Where a ray meets a triangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// The ray's parameter: the point is `origin + t * direction`.
    pub t: f64,
    /// Index of the triangle as given.
    pub triangle: usize,
    /// Barycentric coordinate of the triangle's second corner.
    pub u: f64,
    /// Barycentric coordinate of the triangle's third corner.
    pub v: f64,
    /// True where the ray meets the side from which the corners run counter-clockwise.
    pub front: bool,
}

/// The point of a surface that is closest to some point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Closest {
    /// The closest point.
    pub point: DVec3,
    /// How far away it is.
    pub distance: f64,
    /// Index of its triangle as given.
    pub triangle: usize,
    /// Its barycentric coordinates there: at least 0, sum 1.
    pub barycentric: [f64; 3],
}

/// The square of the distance to a triangle, its index as given, its closest point and where that is; normalised.
type Near = (f64, u32, DVec3, [f64; 3]);

/// Triangles ready for rays and closest points.
///
/// Coordinates are normalised to the unit box inside, so that nothing depends on the model's unit.
#[derive(Clone, Debug, Default)]
pub struct Surface {
    nodes: Vec<Node>,
    /// Normalised corners, in the order of the tree's leaves.
    corners: Vec<[DVec3; 3]>,
    /// The triangle's index as given, in the same order.
    triangles: Vec<u32>,
    centre: DVec3,
    /// Model units to the unit box.
    scale: f64,
}

/// The tree of boxes: the steps of obvhs' `build_bvh2`, which also looks at a clock that not every system has.
fn tree_over(boxes: &[Aabb], how: &BvhBuildParams) -> Bvh2 {
    let (count, depth) = (boxes.len(), how.search_depth_threshold);
    let order = (0..count as u32).collect();
    let mut builder = PlocBuilder::with_capacity(count);
    let mut tree = builder.build(how.ploc_search_distance, boxes, order, how.sort_precision, depth);
    let mut optimizer = ReinsertionOptimizer::default();
    let share = how.reinsertion_batch_ratio;
    optimizer.run(&mut tree, share, None);
    collapse(&mut tree, how.max_prims_per_leaf.clamp(1, 255), how.collapse_traversal_cost);
    optimizer.run(&mut tree, share * how.post_collapse_reinsertion_batch_ratio_multiplier, None);
    tree
}

impl Surface {
    /// As [`Surface::new`], for more queries than there are triangles: takes twice as long to make, and a fifth less to ask. What
    /// is found is the same.
    pub fn for_many(positions: &[DVec3], triangles: &[[u32; 3]]) -> Self {
        Self::with(positions, triangles, BvhBuildParams::fast_build())
    }

    /// A surface of `triangles` between `positions`.
    ///
    /// Degenerate triangles (no area, or a corner that is not finite) are left out. A surface may be empty: nothing
    /// meets it.
    ///
    /// O(triangles · log triangles).
    ///
    /// # Panics
    /// A triangle uses a vertex that is not there.
    pub fn new(positions: &[DVec3], triangles: &[[u32; 3]]) -> Self {
        Self::with(positions, triangles, BvhBuildParams::fastest_build())
    }

    fn with(positions: &[DVec3], triangles: &[[u32; 3]], parameters: BvhBuildParams) -> Self {
        let Some((centre, scale)) = unit_box(positions, triangles) else { return Self::default() };
        let mut kept = Vec::with_capacity(triangles.len());
        let mut boxes = Vec::with_capacity(triangles.len());
        for (triangle, corners) in triangles.iter().enumerate() {
            let corners = corners.map(|vertex| (positions[vertex as usize] - centre) * scale);
            if has_area(&corners) {
                boxes.push(padded_box(&corners));
                kept.push((triangle as u32, corners));
            }
        }
        if kept.is_empty() {
            return Self::default();
        }
        let tree = tree_over(&boxes, &parameters);
        drop(boxes);
        let order = || tree.primitive_indices.iter().map(|&index| &kept[index as usize]);
        let triangles = order().map(|&(triangle, _)| triangle).collect();
        let corners = order().map(|&(_, corners)| corners).collect();
        Self { nodes: wide::widened(&tree.nodes), corners, triangles, centre, scale }
    }

    /// True where there is nothing to meet.
    pub fn is_empty(&self) -> bool {
        self.corners.is_empty()
    }

    /// The number of triangles that are not degenerate.
    pub fn triangle_count(&self) -> usize {
        self.corners.len()
    }

    /// The nearest hit of either side with `0 <= t <= t_max`; `t` counts in lengths of `direction`, which may have any
    /// length. `t_max` may be infinite.
    pub fn first_hit(&self, origin: DVec3, direction: DVec3, t_max: f64) -> Option<Hit> {
        let mut best: Option<Hit> = None;
        self.for_each_hit(origin, direction, t_max, false, |hit| {
            if best.is_none_or(|other| (hit.t, hit.triangle) < (other.t, other.triangle)) {
                best = Some(hit);
            }
            best.map_or(t_max, |hit| hit.t)
        });
        best
    }

    /// Whether anything is met with `0 <= t <= t_max`: as [`Surface::first_hit`], but any hit will do.
    pub fn is_hit(&self, origin: DVec3, direction: DVec3, t_max: f64) -> bool {
        let mut is_hit = false;
        self.for_each_hit(origin, direction, t_max, false, |_| {
            is_hit = true;
            f64::NEG_INFINITY
        });
        is_hit
    }

    /// All hits of either side with `t >= 0`, nearest first.
    ///
    /// A ray through an edge or a vertex meets what it would meet if it ran a little beside: a crossing is one hit, and
    /// where it touches an outline it has no hit or two. So in a closed mesh hits enter as often as they leave.
    pub fn all_hits(&self, origin: DVec3, direction: DVec3) -> Vec<Hit> {
        let mut hits = Vec::new();
        self.for_each_hit(origin, direction, f64::INFINITY, true, |hit| {
            hits.push(hit);
            f64::INFINITY
        });
        hits.sort_by(|a, b| a.t.total_cmp(&b.t).then(a.triangle.cmp(&b.triangle)));
        hits
    }

    /// The point of the surface closest to `p`, and its triangle (the first one where several are equally near).
    /// `None` for an empty surface.
    pub fn closest_point(&self, p: DVec3) -> Option<Closest> {
        self.closest_from(p, None)
    }

    fn closest_from(&self, p: DVec3, guess: Option<u32>) -> Option<Closest> {
        let p = self.searched(p)?;
        let nowhere = (f64::INFINITY, u32::MAX, DVec3::ZERO, [0.0; 3]);
        let guessed = guess.map_or(nowhere, |slot| self.nearest_of(slot as usize, p));
        let mut best = guessed;
        self.walk_near(p, best.0, |slot| {
            let found = self.nearest_of(slot, p);
            if (found.0, found.1) < (best.0, best.1) {
                best = found;
            }
            best.0
        });
        // Two sheets in one place, as of tubes that meet, would take turns by last digits.
        let is_as_near = guess.is_some() && guessed.0 <= best.0 * (1.0 + f64::from(f32::EPSILON));
        Some(self.closest(if is_as_near { guessed } else { best }))
    }

    /// Whether any point of the surface is within `reach` of `p`; false for an empty surface.
    pub fn is_within(&self, p: DVec3, reach: f64) -> bool {
        let mut is_within = false;
        self.visit_within(p, reach, |_| {
            is_within = true;
            false
        });
        is_within
    }

    /// Fills `found` with the closest point of every triangle within `reach` of `p`, nearest first, by triangle where
    /// they are equally near; empty for an empty surface.
    pub fn points_within(&self, p: DVec3, reach: f64, found: &mut Vec<Closest>) {
        found.clear();
        self.visit_within(p, reach, |closest| {
            found.push(closest);
            true
        });
        found.sort_unstable_by(|a, b| a.distance.total_cmp(&b.distance).then(a.triangle.cmp(&b.triangle)));
    }

    /// Calls `visit` for the closest point of every triangle within `reach` of `p`, the nearest boxes first, until it says
    /// false.
    fn visit_within(&self, p: DVec3, reach: f64, mut visit: impl FnMut(Closest) -> bool) {
        let Some(p) = self.searched(p) else { return };
        let limit = reach * self.scale;
        let (square, mut goes_on) = (limit * limit, true);
        self.walk_near(p, square, |slot| {
            let near = self.nearest_of(slot, p);
            goes_on = goes_on && (near.0.sqrt() > limit || visit(self.closest(near)));
            if goes_on { square } else { f64::NEG_INFINITY }
        });
    }

    /// `p` in the unit box; `None` where nothing is near it.
    fn searched(&self, p: DVec3) -> Option<DVec3> {
        (!self.is_empty() && p.is_finite()).then(|| (p - self.centre) * self.scale)
    }

    /// The point of the triangle in `slot` that is closest to a normalised `p`.
    #[inline(always)]
    fn nearest_of(&self, slot: usize, p: DVec3) -> Near {
        let (point, barycentric) = closest_on_triangle(p, &self.corners[slot]);
        (p.distance_squared(point), self.triangles[slot], point, barycentric)
    }

    /// The same in the model's units.
    fn closest(&self, (square, triangle, point, barycentric): Near) -> Closest {
        Closest {
            point: point / self.scale + self.centre,
            distance: square.sqrt() / self.scale,
            triangle: triangle as usize,
            barycentric,
        }
    }

    /// Calls `visit` for the slots of boxes that are no further from a normalised `p` than the root of `limit`, the nearest
    /// first, where `visit` returns the new limit.
    #[inline(always)]
    fn walk_near(&self, p: DVec3, limit: f64, mut visit: impl FnMut(usize) -> f64) {
        // What is further away than the limit is not even put down.
        let single = |limit: f64| (limit as f32).next_up();
        let boxes = |node: &Node, limit: f32| {
            let squares = node.squares(p);
            (squares, node.is_there() & squares.cmple(Vec4::splat(limit)))
        };
        self.walk(single(limit), boxes, |slot| single(visit(slot)));
    }

    /// Calls `visit` for the slots of boxes that are no further away than `limit`, the nearest first, where `visit` returns the
    /// new limit. `boxes`: how far away those of a node are, and which of them are near enough.
    #[inline(always)]
    fn walk(
        &self,
        mut limit: f32,
        boxes: impl Fn(&Node, f32) -> (Vec4, BVec4A),
        mut visit: impl FnMut(usize) -> f32,
    ) {
        let mut stack = Stack::new();
        stack.push(ROOT, 0.0);
        while let Some((child, distance)) = stack.pop() {
            if distance > limit {
                continue;
            }
            if child.count == 0 {
                let node = &self.nodes[child.first as usize];
                let (distances, are_near) = boxes(node, limit);
                stack.push_all(&node.children, distances, are_near);
            }
            for slot in child.first..child.first + child.count {
                limit = visit(slot as usize);
            }
        }
    }

    /// Calls `visit` for every hit with `0 <= t <= t_max`, where `visit` returns the new `t_max`; nearer boxes first.
    ///
    /// `every_crossing`: a crossing is one hit, as [`Surface::all_hits`] says.
    fn for_each_hit(
        &self,
        origin: DVec3,
        direction: DVec3,
        mut t_max: f64,
        every_crossing: bool,
        mut visit: impl FnMut(Hit) -> f64,
    ) {
        if self.is_empty() {
            return;
        }
        let Some(ray) = Ray::new((origin - self.centre) * self.scale, direction * self.scale) else {
            return;
        };
        let Some(line) = Line::new(&ray, &self.nodes[0]) else {
            return;
        };
        let mut way = line.way_to(t_max);
        let boxes = |node: &Node, way: f32| node.enters(&line.slopes, way);
        self.walk(way, boxes, |slot| {
            let hit = ray.meets(&self.corners[slot], self.triangles[slot], every_crossing);
            if let Some(hit) = hit.filter(|hit| hit.t <= t_max) {
                t_max = visit(hit);
                way = line.way_to(t_max);
            }
            way
        });
    }
}

/// What all boxes are in.
const ROOT: Child = Child { first: 0, count: 0 };

/// Middle of the box around `triangles`, and what takes its longest side to 1; `None` where they have no extent.
fn unit_box(positions: &[DVec3], triangles: &[[u32; 3]]) -> Option<(DVec3, f64)> {
    let corners_of = |triangle: &[u32; 3]| triangle.map(|vertex| positions[vertex as usize]);
    let (low, high) = bounds(triangles.iter().map(corners_of).filter(is_finite).flatten());
    let extent = (high - low).max_element();
    (extent.is_finite() && extent > 0.0).then(|| (0.5 * (low + high), 1.0 / extent))
}

fn is_finite([a, b, c]: &[DVec3; 3]) -> bool {
    a.is_finite() && b.is_finite() && c.is_finite()
}

/// True where normalised corners make a triangle.
fn has_area(corners: &[DVec3; 3]) -> bool {
    let [a, b, c] = *corners;
    let longest = (b - a).length().max((c - a).length()).max((c - b).length());
    let double_area = (b - a).cross(c - a).length();
    is_finite(corners) && double_area > LEAST_HEIGHT * longest
}

/// The box around normalised corners.
fn padded_box(&[a, b, c]: &[DVec3; 3]) -> Aabb {
    let single = |p: DVec3| Vec3A::new(p.x as f32, p.y as f32, p.z as f32);
    let padding = Vec3A::splat(BOX_PADDING);
    Aabb::new(single(a.min(b).min(c)) - padding, single(a.max(b).max(c)) + padding)
}

/// A ray made ready: the axes permuted so that z is the direction's largest one, sheared to look along z.
struct Ray {
    origin: DVec3,
    direction: DVec3,
    /// Which axis comes to be z.
    largest: usize,
    shear: DVec3,
}

impl Ray {
    fn new(origin: DVec3, direction: DVec3) -> Option<Self> {
        let largest = direction.abs().max_position();
        let z = direction[largest];
        if !(origin.is_finite() && direction.is_finite() && z != 0.0) {
            return None;
        }
        let axes = [(largest + 1) % 3, (largest + 2) % 3, largest];
        Some(Self {
            origin,
            direction,
            largest,
            shear: DVec3::new(direction[axes[0]] / z, direction[axes[1]] / z, 1.0 / z),
        })
    }

    /// Woop et al.: each edge function has exactly the opposite sign in the neighbour, and 0 counts as inside, so no
    /// ray passes between two triangles that share an edge. With `once`, a ray on an edge is moved beside it by a step
    /// along x and a much smaller one along y, both below any number, so that just one of the two has it.
    #[inline(always)]
    fn meets(&self, corners: &[DVec3; 3], triangle: u32, once: bool) -> Option<Hit> {
        // Three copies of the test, so that each knows where its numbers are.
        match self.largest {
            0 => self.meets_along(corners, triangle, once, |p| DVec3::new(p.y, p.z, p.x)),
            1 => self.meets_along(corners, triangle, once, |p| DVec3::new(p.z, p.x, p.y)),
            _ => self.meets_along(corners, triangle, once, |p| p),
        }
    }

    #[inline(always)]
    fn meets_along(
        &self,
        corners: &[DVec3; 3],
        triangle: u32,
        once: bool,
        permuted: impl Fn(DVec3) -> DVec3,
    ) -> Option<Hit> {
        let [a, b, c] = corners.map(|p| {
            let q = permuted(p - self.origin);
            DVec3::new(q.x - self.shear.x * q.z, q.y - self.shear.y * q.z, self.shear.z * q.z)
        });
        let edge = |p: DVec3, q: DVec3| p.x * q.y - p.y * q.x;
        let (u, v, w) = (edge(c, b), edge(a, c), edge(b, a));
        let side = |value: f64, p: DVec3, q: DVec3| match value {
            0.0 if once && p.y != q.y => q.y - p.y,
            0.0 if once => p.x - q.x,
            _ => value,
        };
        let (of_u, of_v, of_w) = (side(u, c, b), side(v, a, c), side(w, b, a));
        // Not one after the other: which of them is outside no processor guesses.
        let is_below = (of_u < 0.0) | (of_v < 0.0) | (of_w < 0.0);
        let is_above = (of_u > 0.0) | (of_v > 0.0) | (of_w > 0.0);
        if is_below & is_above {
            return None;
        }
        let determinant = u + v + w;
        if determinant == 0.0 {
            return None;
        }
        let t = (u * a.z + v * b.z + w * c.z) / determinant;
        if !(t >= 0.0 && t.is_finite()) {
            return None;
        }
        Some(Hit {
            t,
            triangle: triangle as usize,
            u: v / determinant,
            v: w / determinant,
            // The permutation keeps handedness; a ray that runs along -z sees the other winding.
            front: (determinant > 0.0) == (self.shear.z > 0.0),
        })
    }
}

/// A ray as the boxes see it: in single precision, of a direction of length 1, begun near the boxes.
///
/// Within [`NEAR`] of the unit box, what rounding moves a side by is a fraction of the boxes' padding, so no box is passed by
/// that holds a triangle which the ray meets, and none is entered later than that.
struct Line {
    slopes: Slopes,
    /// How far along the ray it begins, and how many of its own lengths the ray's direction has.
    start: f64,
    length: f64,
}

/// Rays that begin further away, in units of the scene's largest extent, are moved to the box first.
const NEAR: f64 = 2.0;
/// Instead of the inverse of 0: a ray within a slab meets it, and 0 times infinity is nowhere.
const INFINITE: f32 = 1e30;

impl Line {
    /// `None` where the ray begins far away and passes by all boxes.
    fn new(ray: &Ray, root: &Node) -> Option<Self> {
        // By the largest number first: a direction may have any length.
        let largest = ray.direction.abs().max_element();
        let direction = ray.direction / largest;
        let length = largest * direction.length();
        let direction = direction.normalize();
        let mut start = 0.0;
        if ray.origin.abs().max_element() > NEAR {
            start = enters_far(ray.origin, direction, root)?;
        }
        let inverse = direction.as_vec3a().recip().clamp(Vec3A::splat(-INFINITE), Vec3A::splat(INFINITE));
        let origin = (ray.origin + start * direction).as_vec3a();
        Some(Self { slopes: Slopes::new(origin, inverse), start, length })
    }

    /// How far the ray's parameter `t` is along the line, or a little further.
    fn way_to(&self, t: f64) -> f32 {
        let way = t * self.length - self.start;
        if way.is_nan() {
            return f32::INFINITY;
        }
        if way.is_finite() { (way + f64::from(BOX_PADDING) * way.abs()) as f32 } else { way as f32 }
    }
}

/// Where a ray from far away enters the root's box, a little before; `None` where it passes by.
#[cold]
fn enters_far(origin: DVec3, direction: DVec3, root: &Node) -> Option<f64> {
    let around = root.around();
    let (low, high) = (around.min.as_dvec3(), around.max.as_dvec3());
    let (mut enter, mut leave) = (0.0_f64, f64::INFINITY);
    for axis in 0..3 {
        let one = (low[axis] - origin[axis]) / direction[axis];
        let two = (high[axis] - origin[axis]) / direction[axis];
        // min and max pass over the NaN of 0 / 0: a ray within a side of the box is not shut out.
        enter = enter.max(one.min(two));
        leave = leave.min(one.max(two));
    }
    (enter <= leave).then_some(enter)
}

/// The closest point of a triangle with area, and its barycentric coordinates.
fn closest_on_triangle(p: DVec3, &[a, b, c]: &[DVec3; 3]) -> (DVec3, [f64; 3]) {
    let (ab, ac, ap) = (b - a, c - a, p - a);
    let (d1, d2) = (ab.dot(ap), ac.dot(ap));
    if d1 <= 0.0 && d2 <= 0.0 {
        return (a, [1.0, 0.0, 0.0]);
    }
    let bp = p - b;
    let (d3, d4) = (ab.dot(bp), ac.dot(bp));
    if d3 >= 0.0 && d4 <= d3 {
        return (b, [0.0, 1.0, 0.0]);
    }
    let cp = p - c;
    let (d5, d6) = (ab.dot(cp), ac.dot(cp));
    if d6 >= 0.0 && d5 <= d6 {
        return (c, [0.0, 0.0, 1.0]);
    }
    let vc = d1 * d4 - d3 * d2;
    if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        let t = d1 / (d1 - d3);
        return (a + t * ab, [1.0 - t, t, 0.0]);
    }
    let vb = d5 * d2 - d1 * d6;
    if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        let t = d2 / (d2 - d6);
        return (a + t * ac, [1.0 - t, 0.0, t]);
    }
    let va = d3 * d6 - d5 * d4;
    if va <= 0.0 && d4 >= d3 && d5 >= d6 {
        let t = (d4 - d3) / ((d4 - d3) + (d5 - d6));
        return (b + t * (c - b), [0.0, 1.0 - t, t]);
    }
    let sum = va + vb + vc;
    let (v, w) = (vb / sum, vc / sum);
    (a + v * ab + w * ac, [1.0 - v - w, v, w])
}

/// What is still to be visited, and how far away it is; only a tree of unusual depth needs memory of its own.
struct Stack {
    near: [(Child, f32); 48],
    count: usize,
    deep: Vec<(Child, f32)>,
}

impl Stack {
    fn new() -> Self {
        Self { near: [(ROOT, 0.0); 48], count: 0, deep: Vec::new() }
    }

    #[inline(always)]
    fn push(&mut self, child: Child, distance: f32) {
        match self.near.get_mut(self.count) {
            Some(place) => {
                *place = (child, distance);
                self.count += 1;
            }
            None => self.deep.push((child, distance)),
        }
    }

    /// These of a node's children, the nearest one last.
    #[inline(always)]
    fn push_all(&mut self, children: &[Child; LANES], distances: Vec4, these: BVec4A) {
        let distances = distances.to_array();
        let mut left = these.bitmask();
        while left != 0 {
            let mut furthest = left.trailing_zeros() as usize;
            let mut others = left & (left - 1);
            while others != 0 {
                let lane = others.trailing_zeros() as usize;
                if distances[lane & (LANES - 1)] > distances[furthest & (LANES - 1)] {
                    furthest = lane;
                }
                others &= others - 1;
            }
            left &= !(1 << furthest);
            self.push(children[furthest & (LANES - 1)], distances[furthest & (LANES - 1)]);
        }
    }

    #[inline(always)]
    fn pop(&mut self) -> Option<(Child, f32)> {
        if let Some(item) = self.deep.pop() {
            return Some(item);
        }
        self.count = self.count.checked_sub(1)?;
        Some(self.near[self.count])
    }
}

#[cfg(test)]
mod tests {
    //! Rays and closest points against every triangle, and on meshes that are closed.

    use super::*;
    use std::f64::consts::{PI, TAU};

    /// Numbers in 0..1, the same on every run.
    struct Random(u64);

    impl Random {
        fn next(&mut self) -> f64 {
            self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
            let mut z = self.0;
            z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
            z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
            ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
        }

        fn point(&mut self) -> DVec3 {
            DVec3::new(self.next(), self.next(), self.next()) * 2.0 - 1.0
        }
    }

    type Triangles = (Vec<DVec3>, Vec<[u32; 3]>);

    /// A closed tube round the y axis with poles: rings of (radius, height), from the bottom up.
    fn turned(bottom: f64, rings: &[(f64, f64)], top: f64, columns: usize) -> Triangles {
        let mut positions = vec![DVec3::Y * bottom];
        for &(radius, y) in rings {
            // Mirrored in x to the last bit, with vertices exactly on x = 0.
            positions.extend((0..columns).map(|column| {
                let angle = TAU * column as f64 / columns as f64;
                let quarter = columns / 4;
                let x = match column {
                    _ if column % (2 * quarter) == quarter => 0.0,
                    _ if column > quarter && column < 3 * quarter => -(PI - angle).abs().cos() * radius,
                    _ => angle.min(TAU - angle).cos() * radius,
                };
                DVec3::new(x, y, angle.sin() * radius)
            }));
        }
        positions.push(DVec3::Y * top);
        let at = |ring: usize, column: usize| (1 + ring * columns + column % columns) as u32;
        let last = positions.len() as u32 - 1;
        let mut triangles = Vec::new();
        for column in 0..columns {
            triangles.push([0, at(0, column), at(0, column + 1)]);
            for ring in 1..rings.len() {
                let [a, b] = [at(ring - 1, column), at(ring - 1, column + 1)];
                let [c, d] = [at(ring, column), at(ring, column + 1)];
                triangles.extend([[a, d, b], [a, c, d]]);
            }
            triangles.push([at(rings.len() - 1, column), last, at(rings.len() - 1, column + 1)]);
        }
        (positions, triangles)
    }

    fn sphere() -> Triangles {
        let rings: Vec<_> = (1..24)
            .map(|ring| PI * f64::from(ring) / 24.0)
            .map(|angle| (angle.sin(), -angle.cos()))
            .collect();
        turned(-1.0, &rings, 1.0, 32)
    }

    fn capsule() -> Triangles {
        let mut rings: Vec<_> = (1..=8)
            .map(|ring| PI * f64::from(ring) / 16.0)
            .map(|angle| (0.3 * angle.sin(), -0.7 - 0.3 * angle.cos()))
            .collect();
        rings.extend((1..20).map(|ring| (0.3, -0.7 + 1.4 * f64::from(ring) / 20.0)));
        let top: Vec<_> = rings[..8].iter().rev().map(|&(r, y)| (r, -y)).collect();
        rings.extend(top);
        turned(-1.0, &rings, 1.0, 24)
    }

    fn cube() -> Triangles {
        let positions = (0..8)
            .map(|i| DVec3::new(f64::from(i & 1), f64::from(i >> 1 & 1), f64::from(i >> 2 & 1)) * 2.0 - 1.0)
            .collect();
        let triangles = vec![
            [0, 2, 1],
            [1, 2, 3],
            [4, 5, 6],
            [5, 7, 6],
            [0, 1, 4],
            [1, 5, 4],
            [2, 6, 3],
            [3, 6, 7],
            [0, 4, 2],
            [2, 4, 6],
            [1, 3, 5],
            [3, 7, 5],
        ];
        (positions, triangles)
    }

    /// Rays at odd places are the easy ones: half of these start in the plane of symmetry and run within it, at
    /// vertices, along edges and along the axes.
    fn count_lost_rays(
        (positions, triangles): &Triangles,
        inside: impl Fn(&mut Random) -> DVec3,
        rays: usize,
    ) -> usize {
        let mut random = Random(7);
        let surface = Surface::new(positions, triangles);
        (0..rays)
            .filter(|ray| {
                let mut origin = inside(&mut random);
                let mut direction = random.point();
                match ray % 8 {
                    0 => (origin.x, direction.x) = (0.0, 0.0),
                    1 => (origin.x, direction) = (0.0, DVec3::Z),
                    2 => (origin.x, direction) = (-0.0, DVec3::NEG_Y),
                    3 => direction = positions[(random.next() * positions.len() as f64) as usize] - origin,
                    4 => {
                        let [a, b, _] = triangles[(random.next() * triangles.len() as f64) as usize];
                        let (a, b) = (positions[a as usize], positions[b as usize]);
                        direction = a.lerp(b, random.next()) - origin;
                    }
                    5 => (origin.x, direction) = (0.0, DVec3::X * random.point().x.signum()),
                    _ => {}
                }
                surface.first_hit(origin, direction, f64::INFINITY).is_none()
            })
            .count()
    }

    #[test]
    fn every_ray_from_inside_a_closed_mesh_hits() {
        for (shape, radius) in [(sphere(), 0.9), (cube(), 1.0), (capsule(), 0.25)] {
            for scale in [1e-3, 1.0, 1e3] {
                let (positions, triangles) = &shape;
                let scaled = (positions.iter().map(|&p| p * scale).collect(), triangles.clone());
                let inside = |random: &mut Random| random.point() * 0.57 * radius * scale;
                assert_eq!(count_lost_rays(&scaled, inside, 100_000), 0, "at scale {scale}");
            }
        }
    }

    /// A closed body of 13 380 vertices, where the development models are at hand.
    fn real_body() -> Option<Triangles> {
        let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../shared/models/makehuman_female_target.glb");
        let bytes = std::fs::read(path).ok()?;
        let file = gltf::Gltf::from_slice(&bytes).unwrap();
        let body = file.meshes().find(|mesh| mesh.name() == Some("body")).unwrap();
        let primitive = body.primitives().next().unwrap();
        let reader = primitive.reader(|_| file.blob.as_deref());
        let positions = reader.read_positions().unwrap();
        let positions: Vec<DVec3> = positions.map(|p| DVec3::from_array(p.map(f64::from))).collect();
        let indices: Vec<u32> = reader.read_indices().unwrap().into_u32().collect();
        let triangles: Vec<[u32; 3]> = indices.chunks_exact(3).map(|c| [c[0], c[1], c[2]]).collect();
        Some((positions, triangles))
    }

    #[test]
    fn every_ray_from_inside_a_real_body_hits() {
        let Some((positions, triangles)) = real_body() else {
            return;
        };
        for scale in [1e-3, 1.0, 1e3] {
            let body: Triangles = (positions.iter().map(|&p| p * scale).collect(), triangles.clone());
            let surface = Surface::new(&body.0, &body.1);
            // Points on the mirror plane between two hits of a line from the side are inside.
            let inside = |random: &mut Random| {
                loop {
                    let vertex = body.0[(random.next() * body.0.len() as f64) as usize];
                    let outside = DVec3::new(-scale, vertex.y, vertex.z * random.next());
                    let hits = surface.all_hits(outside, DVec3::X);
                    if hits.len() == 2 && hits[1].t - hits[0].t > 0.02 * scale {
                        return outside + DVec3::X * 0.5 * (hits[0].t + hits[1].t);
                    }
                }
            };
            assert_eq!(count_lost_rays(&body, inside, 100_000), 0, "at scale {scale}");
        }
    }

    #[test]
    fn hits_agree_with_a_test_of_every_triangle() {
        let mut random = Random(3);
        for soup in 0..20 {
            let count = [1, 2, 3, 10, 300][soup % 5];
            let scale = [1e-3, 1.0, 1e3][soup % 3];
            let mut positions = Vec::new();
            let mut triangles = Vec::new();
            for triangle in 0..count {
                let centre = random.point();
                positions.extend((0..3).map(|_| (centre + 0.4 * random.point()) * scale));
                triangles.push([0, 1, 2].map(|corner| 3 * triangle + corner));
            }
            let surface = Surface::new(&positions, &triangles);
            for _ in 0..500 {
                let (origin, direction) = (random.point() * 1.5 * scale, random.point());
                // Möller and Trumbore 1997: another formula, so that both are not wrong in the same way.
                let mut expected: Vec<f64> = triangles
                    .iter()
                    .filter_map(|t| {
                        let [a, b, c] = t.map(|vertex| positions[vertex as usize]);
                        let p = direction.cross(c - a);
                        let determinant = p.dot(b - a);
                        let u = p.dot(origin - a) / determinant;
                        let q = (origin - a).cross(b - a);
                        let v = q.dot(direction) / determinant;
                        let t = q.dot(c - a) / determinant;
                        (u >= 0.0 && v >= 0.0 && u + v <= 1.0 && t >= 0.0).then_some(t)
                    })
                    .collect();
                expected.sort_by(f64::total_cmp);
                let hits: Vec<f64> = surface.all_hits(origin, direction).iter().map(|hit| hit.t).collect();
                assert_eq!(hits.len(), expected.len());
                for (t, expected) in hits.iter().zip(&expected) {
                    assert!((t - expected).abs() < 1e-9 * scale.max(1.0));
                }
                let first = surface.first_hit(origin, direction, f64::INFINITY);
                assert_eq!(first.map(|hit| hit.t), hits.first().copied());
                if let Some(hit) = first {
                    let [a, b, c] = triangles[hit.triangle].map(|vertex| positions[vertex as usize]);
                    let point = a * (1.0 - hit.u - hit.v) + b * hit.u + c * hit.v;
                    assert!(point.distance(origin + hit.t * direction) < 1e-9 * scale);
                    assert_eq!(hit.front, (b - a).cross(c - a).dot(direction) < 0.0);
                    assert_eq!(surface.first_hit(origin, direction, 0.99 * hit.t), None);
                }
            }
        }
    }

    #[test]
    fn closest_points_agree_with_a_test_of_every_triangle() {
        let mut random = Random(5);
        for scale in [1e-3, 1.0, 1e3] {
            let (positions, triangles) = sphere();
            let positions: Vec<DVec3> = positions.iter().map(|&p| p * scale).collect();
            let surface = Surface::new(&positions, &triangles);
            for _ in 0..500 {
                let p = random.point() * 1.5 * scale;
                let closest = surface.closest_point(p).unwrap();
                let corners = |t: &[u32; 3]| t.map(|vertex| positions[vertex as usize]);
                let expected = triangles
                    .iter()
                    .map(|t| p.distance(closest_on_triangle(p, &corners(t)).0))
                    .fold(f64::INFINITY, f64::min);
                assert!((closest.distance - expected).abs() < 1e-12 * scale);
                let [a, b, c] = corners(&triangles[closest.triangle]);
                let [u, v, w] = closest.barycentric;
                assert!((a * u + b * v + c * w).distance(closest.point) < 1e-12 * scale);
                assert!((closest.point.distance(p) - closest.distance).abs() < 1e-12 * scale);
                assert!(surface.is_within(p, 1.001 * expected) && !surface.is_within(p, 0.999 * expected));
                let mut found = Vec::new();
                surface.points_within(p, 1.5 * expected, &mut found);
                let distances = triangles.iter().map(|t| p.distance(closest_on_triangle(p, &corners(t)).0));
                assert_eq!(found.len(), distances.filter(|&distance| distance <= 1.5 * expected).count());
                assert!(u.min(v).min(w) >= -1e-15 && (u + v + w - 1.0).abs() < 1e-12);
            }
        }
    }

    #[test]
    fn a_ray_through_edges_and_vertices_enters_once_and_leaves_once() {
        let (positions, triangles) = sphere();
        let surface = Surface::new(&positions, &triangles);
        for direction in [DVec3::X, DVec3::Y, DVec3::Z, DVec3::new(0.0, 0.3, -1.0)] {
            let hits = surface.all_hits(-3.0 * direction, direction);
            assert_eq!(hits.len(), 2, "{direction}");
            assert!(hits[0].front && !hits[1].front);
        }
    }

    #[test]
    fn a_line_leaves_a_closed_mesh_as_often_as_it_enters() {
        let mut random = Random(11);
        for (positions, triangles) in [sphere(), cube(), capsule()].into_iter().chain(real_body()) {
            let surface = Surface::new(&positions, &triangles);
            for ray in 0..20_000 {
                let mut through = random.point();
                let mut direction = random.point();
                match ray % 4 {
                    0 => (through.x, direction.x) = (0.0, 0.0),
                    1 => through = positions[(random.next() * positions.len() as f64) as usize],
                    2 => {
                        let [a, b, _] = triangles[(random.next() * triangles.len() as f64) as usize];
                        through = positions[a as usize].lerp(positions[b as usize], random.next());
                    }
                    _ => {}
                }
                let hits = surface.all_hits(through - 10.0 * direction.normalize(), direction);
                let entered = hits.iter().filter(|hit| hit.front).count();
                assert_eq!(2 * entered, hits.len(), "{through} {direction} {hits:?}");
            }
        }
    }

    #[test]
    fn an_empty_or_degenerate_surface_meets_nothing() {
        let p = [DVec3::ZERO, DVec3::X, 2.0 * DVec3::X, DVec3::Y, DVec3::NAN];
        for triangles in [vec![], vec![[0, 1, 2]], vec![[0, 0, 3]], vec![[0, 1, 4]]] {
            let surface = Surface::new(&p, &triangles);
            assert!(surface.is_empty());
            assert_eq!(surface.first_hit(DVec3::ZERO, DVec3::X, 10.0), None);
            assert!(surface.all_hits(DVec3::ZERO, DVec3::X).is_empty());
            assert_eq!(surface.closest_point(DVec3::ZERO), None);
        }
        let surface = Surface::new(&p, &[[0, 1, 2], [0, 1, 3], [1, 2, 4]]);
        assert_eq!(surface.triangle_count(), 1);
        let hit = surface.first_hit(DVec3::new(0.25, 0.25, 1.0), DVec3::NEG_Z, 10.0);
        assert_eq!(hit.map(|hit| (hit.triangle, hit.t)), Some((1, 1.0)));
        assert_eq!(surface.first_hit(DVec3::new(0.25, 0.25, 1.0), DVec3::ZERO, 10.0), None);
    }

    #[test]
    fn of_two_sheets_in_one_place_the_guess_is_found() {
        // Corners of which one lies a last digit nearer.
        let corners =
            |z: f64| [DVec3::new(-1.0, -1.0, z), DVec3::new(2.0, -1.0, z), DVec3::new(-1.0, 2.0, z)];
        let positions: Vec<DVec3> = [0.0, 1e-9, -1e-9].into_iter().flat_map(corners).collect();
        let triangles = [[0, 1, 2], [3, 5, 4], [6, 7, 8]];
        let surface = Surface::for_many(&positions, &triangles);
        let tree = Tree::of(&surface, triangles.len());
        for z in [-0.3, 0.3] {
            for guess in 0..3 {
                let found = surface.closest_point_near(DVec3::new(0.1, 0.1, z), Some(guess), &tree);
                assert_eq!(found.map(|closest| closest.triangle), Some(guess as usize));
            }
            // One that is further is not: the whole surface is searched.
            let mut moved = positions.clone();
            moved[..3].iter_mut().for_each(|p| p.z -= 0.01 * z.signum());
            let surface = Surface::with_tree(&moved, &triangles, &tree);
            let found = surface.closest_point_near(DVec3::new(0.1, 0.1, z), Some(0), &tree).unwrap();
            assert_ne!(found.triangle, 0);
        }
    }

    #[test]
    fn a_tree_that_stays_finds_what_a_new_one_finds() {
        let mut random = Random(5);
        let (mut positions, triangles) = turned(-1.0, &[(0.5, -0.6), (0.8, 0.0), (0.4, 0.7)], 1.0, 24);
        let tree = Tree::of(&Surface::for_many(&positions, &triangles), triangles.len());
        for _ in 0..4 {
            for p in &mut positions {
                *p = 1.3 * *p + 0.1 * random.point();
            }
            let new = Surface::new(&positions, &triangles);
            let moved = Surface::with_tree(&positions, &triangles, &tree);
            assert_eq!(moved.triangle_count(), new.triangle_count());
            for index in 0..300 {
                let (p, direction) = (3.0 * random.point(), random.point());
                assert_eq!(moved.all_hits(p, direction), new.all_hits(p, direction));
                let wanted = new.closest_point(p);
                for guess in [None, Some(u32::MAX)] {
                    assert_eq!(moved.closest_point_near(p, guess, &tree), wanted);
                }
                // A guess that is as near, across an edge, is as good.
                let guess = index % triangles.len() as u32;
                let found = moved.closest_point_near(p, Some(guess), &tree);
                let (found, wanted) = (found.unwrap(), wanted.unwrap());
                assert!((found.distance - wanted.distance).abs() < 1e-6 * wanted.distance);
                assert!(found == wanted || found.triangle == guess as usize, "{found:?} {wanted:?}");
            }
        }
        // A triangle without area, and one that has some again.
        positions[1] = positions[2];
        for (from, to) in [(0, 1), (1, 0)] {
            let mut other = positions.clone();
            other[1] += DVec3::Y * f64::from(from);
            let tree = Tree::of(&Surface::new(&other, &triangles), triangles.len());
            other[1] = positions[1] + DVec3::Y * f64::from(to);
            let (new, moved) =
                (Surface::new(&other, &triangles), Surface::with_tree(&other, &triangles, &tree));
            assert_eq!(moved.triangle_count(), new.triangle_count());
            let p = DVec3::new(0.3, -2.0, 0.1);
            assert_eq!(moved.closest_point_near(p, Some(3), &tree), new.closest_point(p));
        }
        let nothing = Tree::of(&Surface::default(), 0);
        assert!(Surface::with_tree(&[], &[], &nothing).is_empty());
    }
}
