//! Pieces of a head: what hangs together, or what a crease goes around, as around a ball that is sewn to the skin.

use super::head::Head;
use crate::geometry::{Groups, bounds, distinct, double_area, weld};
use glam::{DVec2, DVec3};

/// A connected piece of one side of the head.
pub struct Piece {
    /// Its vertices, ascending, in the figure's numbers.
    pub vertices: Vec<u32>,
    /// Its triangles.
    pub triangles: Vec<[u32; 3]>,
    /// The box around it.
    pub low: DVec3,
    /// See `low`.
    pub high: DVec3,
}

impl Piece {
    /// The piece of these triangles.
    pub fn new(head: &Head, triangles: Vec<[u32; 3]>) -> Self {
        let vertices = distinct(triangles.iter().flatten().copied());
        let (low, high) = bounds(vertices.iter().map(|&vertex| head.points[vertex as usize]));
        Self { vertices, triangles, low, high }
    }

    /// The middle of its box.
    pub fn middle(&self) -> DVec3 {
        0.5 * (self.low + self.high)
    }

    /// The size of its box.
    pub fn extent(&self) -> DVec3 {
        self.high - self.low
    }
}

/// The skin turns inwards by more than this cosine, 30 degrees, where a ball's rim is sewn to it.
const CREASE: f64 = 0.866;

/// Pieces of `triangles` on the left (`side` 1) or the right (-1) that hang together by edges; where it is so `split`, but
/// for creases.
pub fn pieces(head: &Head, triangles: &[[u32; 3]], side: f64, split: bool) -> Vec<Piece> {
    let x = |corners: &[u32; 3]| corners.iter().map(|&corner| head.points[corner as usize].x).sum::<f64>();
    let own: Vec<[u32; 3]> = triangles.iter().filter(|corners| side * x(corners) > 0.0).copied().collect();
    // Only their own vertices are welded: an eye in its socket often touches the lids.
    let used = distinct(own.iter().flatten().copied());
    let points: Vec<DVec3> = used.iter().map(|&vertex| head.points[vertex as usize]).collect();
    let welded = weld(&points, head.parts.seam / head.frame.length).representative;
    let place = |vertex: u32| welded[used.binary_search(&vertex).expect("all are listed")];
    // (edge, triangle, one of its ends, the corner off it)
    let mut edges: Vec<([u32; 2], usize, u32, u32)> = Vec::with_capacity(3 * own.len());
    for (index, corners) in own.iter().enumerate() {
        for turn in 0..3 {
            let [a, b, off] = [0, 1, 2].map(|corner| corners[(turn + corner) % 3]);
            let (from, to) = (place(a), place(b));
            edges.push(([from.min(to), from.max(to)], index, a, off));
        }
    }
    edges.sort_unstable();
    let outwards = if split { outwards(head) } else { 1.0 };
    let normal = |index: usize| outwards * double_area(&head.points, own[index]).normalize_or_zero();
    let mut groups = Groups::new(own.len());
    for same in edges.chunk_by(|a, b| a.0 == b.0) {
        for pair in same.windows(2) {
            let (&(_, one, end, _), &(_, other, _, off)) = (&pair[0], &pair[1]);
            let rises = (head.points[off as usize] - head.points[end as usize]).dot(normal(one)) > 0.0;
            if !(split && rises && normal(one).dot(normal(other)) < CREASE) {
                groups.join(one, other);
            }
        }
    }
    let mut found: Vec<Vec<[u32; 3]>> = vec![Vec::new(); own.len()];
    for (index, &corners) in own.iter().enumerate() {
        found[groups.least(index)].push(corners);
    }
    found.into_iter().filter(|own| !own.is_empty()).map(|own| Piece::new(head, own)).collect()
}

/// 1 where triangles look outwards by their order, -1 where a mirrored file winds them the other way: what is seen from the
/// front looks there.
fn outwards(head: &Head) -> f64 {
    let seen = head.front.squares().filter_map(|(column, row)| head.front.triangle(column, row));
    seen.map(|triangle| double_area(&head.points, head.bare[triangle]).z.signum()).sum::<f64>().signum()
}

/// What lies off the sphere through a ball's vertices by more than this part of its radius, root mean square, is none; of
/// fewer vertices anything is a sphere.
const SPHERE: (f64, usize) = (0.1, 9);
/// The radius of that sphere, in the ball's widths.
const SPHERE_RADIUS: std::ops::Range<f64> = 0.4..0.8;

/// True for a cap of a sphere that bulges to the front.
pub fn is_ball(head: &Head, piece: &Piece) -> bool {
    let points: Vec<DVec3> = piece.vertices.iter().map(|&vertex| head.points[vertex as usize]).collect();
    let firsts = weld(&points, head.parts.seam / head.frame.length).first_vertices();
    let points: Vec<DVec3> = firsts.iter().map(|&first| points[first as usize]).collect();
    let (extent, middle) = (piece.extent(), piece.middle().truncate());
    if points.len() < SPHERE.1 {
        return false;
    }
    let Some((centre, radius)) = sphere(&points, middle) else { return false };
    let square_error: f64 = points.iter().map(|p| (p.distance(centre) - radius).powi(2)).sum();
    let error = (square_error / points.len() as f64).sqrt();
    error < SPHERE.0 * radius && SPHERE_RADIUS.contains(&(radius / extent.x)) && centre.z < piece.high.z
}

/// The sphere nearest to `points` whose middle is seen at `middle`: |p - middle|^2 + z^2 = 2 z c + k, least squares.
fn sphere(points: &[DVec3], middle: DVec2) -> Option<(DVec3, f64)> {
    let count = points.len() as f64;
    let square = |p: &DVec3| (p.truncate() - middle).length_squared() + p.z * p.z;
    let mean = |of: &dyn Fn(&DVec3) -> f64| points.iter().map(of).sum::<f64>() / count;
    let (z, s) = (mean(&|p| p.z), mean(&square));
    let spread = mean(&|p| (p.z - z) * (p.z - z));
    let centre = 0.5 * mean(&|p| (p.z - z) * (square(p) - s)) / spread;
    let radius = (s - 2.0 * centre * z + centre * centre).sqrt();
    (radius.is_finite() && radius > 0.0).then_some((middle.extend(centre), radius))
}
