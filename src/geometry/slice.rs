//! Plane cuts of a mesh, joined into outlines, and how far these reach around a point.

use super::whole::{floor, round};
use super::{Groups, Weld, by_number, range};
use glam::{DVec2, DVec3};
use std::f64::consts::{FRAC_PI_2, PI, TAU};
use std::sync::LazyLock;

/// Rays around a point, 10 degrees apart.
pub const RAYS: usize = 36;

/// An outline of fewer segments than this is no body's: the corner of a button, a sliver of a seam.
const FEWEST_SEGMENTS: usize = 5;

/// A stack of parallel planes: a point on their axis, the axis, and two directions across it; all three of unit length and
/// at right angles.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Planes {
    /// Height 0 on the axis; the middle of each plane's own coordinates.
    pub origin: DVec3,
    /// Heights are along it.
    pub axis: DVec3,
    /// The first coordinate within a plane.
    pub across: DVec3,
    /// The second one.
    pub front: DVec3,
}

impl Planes {
    /// Height of `p`.
    pub fn height(&self, p: DVec3) -> f64 {
        (p - self.origin).dot(self.axis)
    }

    /// Height of `p`, and its place within the plane there.
    pub fn locate(&self, p: DVec3) -> (f64, DVec2) {
        let arm = p - self.origin;
        (arm.dot(self.axis), DVec2::new(arm.dot(self.across), arm.dot(self.front)))
    }

    /// The point at `height` and `place`.
    pub fn point(&self, height: f64, place: DVec2) -> DVec3 {
        self.origin + height * self.axis + place.x * self.across + place.y * self.front
    }
}

/// Segments of one cut that hang together: a closed outline, or an open one where the mesh has a rim.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Outline {
    /// Unordered.
    pub segments: Vec<[DVec2; 2]>,
}

impl Outline {
    /// Least and greatest first coordinate.
    pub fn breadth(&self) -> (f64, f64) {
        range(self.segments.iter().flatten().map(|p| p.x))
    }

    /// How far the outline reaches from `centre` along each of [`RAYS`] rays: the furthest hit, NaN where there is none. The
    /// first ray runs along the first coordinate, the others follow towards the second one.
    pub fn reaches(&self, centre: DVec2) -> [f64; RAYS] {
        let mut reaches = [f64::NAN; RAYS];
        let rays = ray_directions();
        for &[a, b] in &self.segments {
            let (a, b) = (a - centre, b - centre);
            if are_between_two_rays(a, b) {
                // As most segments are.
                continue;
            }
            let turn = a.perp_dot(b);
            // Counter-clockwise from the first to the last point; a segment that points at the centre meets no ray.
            let (first, last) = if turn > 0.0 { (a, b) } else { (b, a) };
            let turn = turn.abs();
            if turn <= 0.0 {
                continue;
            }
            // By each point's own angle, and without the first one: a ray through a corner meets one of the segments that share
            // it, whatever the last digits are.
            let [from, to] = [first, last].map(turns_of);
            let mut ray = floor(from) + 1.0;
            if ray == floor(to) + 1.0 {
                continue;
            }
            let to = if to < from { to + RAYS as f64 } else { to };
            while ray <= to {
                let index = (ray as i64).rem_euclid(RAYS as i64) as usize;
                let across = rays[index].perp_dot(last - first);
                if across > 0.0 {
                    // NaN is less than any reach.
                    reaches[index] = reaches[index].max(turn / across);
                }
                ray += 1.0;
            }
        }
        reaches
    }
}

/// The rays that [`Outline::reaches`] casts.
pub fn ray_directions() -> &'static [DVec2; RAYS] {
    static DIRECTIONS: LazyLock<[DVec2; RAYS]> =
        LazyLock::new(|| std::array::from_fn(|ray| DVec2::from_angle(TAU * ray as f64 / RAYS as f64)));
    &DIRECTIONS
}

const PER_RADIAN: f64 = RAYS as f64 / TAU;
/// Far more than [`nearly_atan2`] is off, in rays.
const NEAR_A_RAY: f64 = 1e-3;

/// True for most segments of which both ends lie between the same two rays from the origin, and for no other one.
#[inline(always)]
fn are_between_two_rays(a: DVec2, b: DVec2) -> bool {
    // From 0 on, where what comes after the point is cut off by what is no call.
    let turns = [a, b].map(|p| nearly_atan2(p.y, p.x) * PER_RADIAN + RAYS as f64 / 2.0);
    let rays = turns.map(|turns| turns as i32);
    let is_clear = |end: usize| {
        let beyond = turns[end] - f64::from(rays[end]);
        beyond > NEAR_A_RAY && beyond < 1.0 - NEAR_A_RAY
    };
    rays[0] == rays[1] && is_clear(0) && is_clear(1)
}

/// The angle of `point`, in rays, from -18 to 18: to the last digit near a ray, elsewhere good enough to tell the two rays
/// beside it.
fn turns_of(point: DVec2) -> f64 {
    let turns = nearly_atan2(point.y, point.x) * PER_RADIAN;
    let is_between = (turns - round(turns)).abs() > NEAR_A_RAY;
    // Not a number is near everything.
    if is_between { turns } else { point.y.atan2(point.x) / (TAU / RAYS as f64) }
}

/// As `atan2`, within 1.2e-5, in a few multiplications: Abramowitz and Stegun 4.4.49.
#[inline(always)]
fn nearly_atan2(y: f64, x: f64) -> f64 {
    let (less, more) = if x.abs() < y.abs() { (x.abs(), y.abs()) } else { (y.abs(), x.abs()) };
    let t = less / more;
    let t2 = t * t;
    let series = 0.999866 + t2 * (-0.3302995 + t2 * (0.180141 + t2 * (-0.085133 + t2 * 0.0208351)));
    let eighth = t * series;
    let quarter = if x.abs() < y.abs() { FRAC_PI_2 - eighth } else { eighth };
    let half = if x < 0.0 { PI - quarter } else { quarter };
    if y < 0.0 { -half } else { half }
}

/// Cuts `triangles` by the planes at `heights`, which rise: the outlines of each cut.
///
/// Segments are one outline where they share an edge of the mesh, welded; outlines of less than five segments are left out.
///
/// - `positions`: by vertex. `weld`: these vertices by position.
///
/// O(triangles · cuts of each).
pub fn slices(
    positions: &[DVec3],
    triangles: &[[u32; 3]],
    weld: &Weld,
    planes: &Planes,
    heights: &[f64],
) -> Vec<Vec<Outline>> {
    let mut cuts: Vec<Cut> = heights.iter().map(|_| Cut::default()).collect();
    for &corners in triangles {
        let [a, b, c] = corners.map(|vertex| planes.height(positions[vertex as usize]));
        let (low, high) = (a.min(b).min(c), a.max(b).max(c));
        // A corner counts as above a plane where it is higher than it: so a plane is met from `low` on, below `high`.
        let first = heights.partition_point(|&height| height < low);
        if heights.get(first).is_none_or(|&height| height >= high) {
            continue;
        }
        let welded = weld.triangle(corners);
        let places = corners.map(|vertex| planes.locate(positions[vertex as usize]));
        for (cut, &height) in cuts[first..].iter_mut().zip(&heights[first..]) {
            if height >= high {
                break;
            }
            cut.add(welded, &places, height);
        }
    }
    cuts.into_iter().map(Cut::outlines).collect()
}

/// One cut in the making.
#[derive(Default)]
struct Cut {
    segments: Vec<[DVec2; 2]>,
    /// Edges that the segments end on, with the segment: in one number, which is sorted faster than three.
    ends: Vec<u128>,
}

impl Cut {
    /// Where the triangle of welded `corners` at `places` meets the plane at `height`.
    fn add(&mut self, corners: [u32; 3], places: &[(f64, DVec2); 3], height: f64) {
        let mut points = [DVec2::ZERO; 2];
        let mut edges = [0; 2];
        let mut count = 0;
        for (one, other) in [(0, 1), (1, 2), (2, 0)] {
            if (places[one].0 > height) != (places[other].0 > height) && count < 2 {
                // From the lower number to the higher one, so that both triangles at an edge meet at one point.
                let (one, other) = if corners[one] < corners[other] { (one, other) } else { (other, one) };
                let ((from, a), (to, b)) = (places[one], places[other]);
                points[count] = a + (b - a) * ((height - from) / (to - from));
                edges[count] = u64::from(corners[one]) << 32 | u64::from(corners[other]);
                count += 1;
            }
        }
        if count == 2 {
            let segment = self.segments.len() as u32;
            self.segments.push(points);
            self.ends.extend(edges.map(|edge| u128::from(edge) << 32 | u128::from(segment)));
        }
    }

    fn outlines(mut self) -> Vec<Outline> {
        let mut groups = Groups::new(self.segments.len());
        self.ends.sort_unstable();
        for pair in self.ends.windows(2) {
            if pair[0] >> 32 == pair[1] >> 32 {
                groups.join(pair[0] as u32 as usize, pair[1] as u32 as usize);
            }
        }
        let least: Vec<u32> = (0..self.segments.len()).map(|segment| groups.least(segment) as u32).collect();
        let rows = by_number(least.len(), least.iter().copied().zip(self.segments.iter().copied()));
        let outlines = (0..rows.count()).map(|group| rows.of(group));
        let outlines = outlines.filter(|segments| segments.len() >= FEWEST_SEGMENTS);
        outlines.map(|segments| Outline { segments: segments.to_vec() }).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::weld;

    const UPRIGHT: Planes = Planes { origin: DVec3::ZERO, axis: DVec3::Y, across: DVec3::X, front: DVec3::Z };

    /// An open tube of half axes `a` and `b` about (x, z), from height 0 to 1, each quad's corners its own vertices.
    fn tube(x: f64, z: f64, a: f64, b: f64) -> (Vec<DVec3>, Vec<[u32; 3]>) {
        let side = |index: usize, y: f64| {
            let (sin, cos) = (std::f64::consts::TAU * index as f64 / 72.0).sin_cos();
            DVec3::new(x + a * cos, y, z + b * sin)
        };
        let mut positions = Vec::new();
        let mut triangles = Vec::new();
        for index in 0..72 {
            let first = positions.len() as u32;
            let next = (index + 1) % 72;
            positions.extend([side(index, 0.0), side(next, 0.0), side(next, 1.0), side(index, 1.0)]);
            triangles.extend([[first, first + 1, first + 2], [first, first + 2, first + 3]]);
        }
        (positions, triangles)
    }

    #[test]
    fn a_tube_is_one_outline_that_reaches_its_half_axes() {
        let (positions, triangles) = tube(0.3, -0.1, 0.4, 0.2);
        let cuts = slices(&positions, &triangles, &weld(&positions, 1e-9), &UPRIGHT, &[-0.5, 0.3, 0.7, 1.5]);
        assert_eq!(cuts.iter().map(Vec::len).collect::<Vec<_>>(), [0, 1, 1, 0]);
        let reaches = cuts[1][0].reaches(DVec2::new(0.3, -0.1));
        // 72 sides have a corner on every ray.
        for (ray, wanted) in [(0, 0.4), (9, 0.2), (18, 0.4), (27, 0.2)] {
            assert!((reaches[ray] - wanted).abs() < 1e-9, "ray {ray}: {}", reaches[ray]);
        }
        let aside = cuts[1][0].reaches(DVec2::new(0.5, -0.1));
        assert!((aside[0] - 0.2).abs() < 1e-9 && (aside[18] - 0.6).abs() < 1e-9);
    }

    #[test]
    fn a_point_is_between_the_rays_that_its_angle_is_between() {
        for index in 0..100_000 {
            let angle = 1e-4 * f64::from(index);
            for (scale, off) in [(1.0, 0.0), (1e-9, 0.0), (3.0, 1e-13), (0.2, -1e-13)] {
                let point = scale * DVec2::from_angle(angle + off);
                let wanted = point.y.atan2(point.x);
                assert!((nearly_atan2(point.y, point.x) - wanted).abs() < 1.2e-5, "{angle}");
                assert_eq!(turns_of(point).floor(), (wanted / (TAU / RAYS as f64)).floor(), "{angle}");
                for beside in [0.01, -0.05, 0.3, PI] {
                    let other = DVec2::from_angle(angle + off + beside);
                    let is_between = turns_of(point).floor() == turns_of(other).floor();
                    assert!(is_between || !are_between_two_rays(point, other), "{angle} {beside}");
                }
            }
        }
        assert!(are_between_two_rays(DVec2::from_angle(0.05), DVec2::from_angle(0.1)));
        for ray in ray_directions() {
            for point in [*ray, 0.3 * *ray, -*ray] {
                assert_eq!(turns_of(point), point.y.atan2(point.x) / (TAU / RAYS as f64));
            }
        }
        assert!(turns_of(DVec2::NAN).is_nan());
    }

    #[test]
    fn what_does_not_touch_is_another_outline() {
        let (mut positions, mut triangles) = tube(0.0, 0.0, 0.4, 0.4);
        let (more, others) = tube(2.0, 0.0, 0.1, 0.1);
        triangles.extend(others.iter().map(|corners| corners.map(|vertex| vertex + positions.len() as u32)));
        positions.extend(more);
        let cuts = slices(&positions, &triangles, &weld(&positions, 1e-9), &UPRIGHT, &[0.5]);
        assert_eq!(cuts[0].len(), 2);
        assert!((cuts[0][1].breadth().0 - 1.9).abs() < 1e-9);
        // From afar an outline is met on the few rays that point to it.
        let hits = cuts[0][1].reaches(DVec2::ZERO).iter().filter(|reach| !reach.is_nan()).count();
        assert_eq!(hits, 1);
    }

    #[test]
    fn a_plane_through_vertices_cuts_once() {
        let (positions, triangles) = tube(0.0, 0.0, 1.0, 1.0);
        // Corners at the plane's height are below it.
        let cuts = slices(&positions, &triangles, &weld(&positions, 1e-9), &UPRIGHT, &[0.0, 1.0]);
        assert_eq!((cuts[0].len(), cuts[1].len()), (1, 0));
        assert_eq!(cuts[0][0].segments.len(), 144 / 2 + 72);
    }
}
