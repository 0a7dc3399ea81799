//! What one triangle tells, and which of them are chosen.

use glam::DVec3;

/// Those of `triangles` all of whose corners `choose` accepts.
pub fn triangles_where(triangles: &[[u32; 3]], choose: impl Fn(usize) -> bool) -> Vec<[u32; 3]> {
    let is_chosen = |corners: &&[u32; 3]| corners.iter().all(|&corner| choose(corner as usize));
    triangles.iter().filter(is_chosen).copied().collect()
}

/// Where the plane of height `y` cuts a triangle; `None` where it does not. A corner is above it where it is higher.
pub fn cut_at([a, b, c]: [DVec3; 3], y: f64) -> Option<[DVec3; 2]> {
    let mut ends = [[a, b], [b, c], [c, a]]
        .into_iter()
        .filter(|[a, b]| (a.y > y) != (b.y > y))
        .map(|[a, b]| a.lerp(b, (y - a.y) / (b.y - a.y)));
    Some([ends.next()?, ends.next()?])
}

/// The normal of a triangle of `points`, twice as long as its area; 0 where it is no number.
pub fn double_area(points: &[DVec3], corners: [u32; 3]) -> DVec3 {
    let [a, b, c] = corners.map(|vertex| points[vertex as usize]);
    let normal = (b - a).cross(c - a);
    if normal.is_finite() { normal } else { DVec3::ZERO }
}
