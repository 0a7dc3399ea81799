//! What one triangle tells.

use glam::DVec3;

/// The normal of a triangle of `points`, twice as long as its area; 0 where it is no number.
pub fn double_area(points: &[DVec3], corners: [u32; 3]) -> DVec3 {
    let [a, b, c] = corners.map(|vertex| points[vertex as usize]);
    let normal = (b - a).cross(c - a);
    if normal.is_finite() { normal } else { DVec3::ZERO }
}
