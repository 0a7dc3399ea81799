//! Normals and tangents after a deformation: turned by the Jacobian, never recomputed from faces.
//!
//! The field's own Jacobian holds the weights fixed, but weights change along the surface and that turns it too. So
//! the Jacobian is fitted to what happened to the triangles around each welded vertex; authored normals (faces of
//! drawn characters have edited ones) keep what was edited, and vertices at one place turn alike.

use crate::geometry::weld::Weld;
use glam::{DMat3, DVec3};

/// The fitted Jacobian of each welded vertex; `None` where no triangle with an area is around it.
///
/// Per triangle the deformation gradient of its edges, with the normal as third axis scaled by the root of the change
/// of area (so that a uniform scaling is fitted exactly); the mean of these by area.
pub fn fitted_jacobians(
    before: &[DVec3],
    after: &[DVec3],
    triangles: &[[u32; 3]],
    weld: &Weld,
) -> Vec<Option<DMat3>> {
    let mut sums = vec![(DMat3::ZERO, 0.0); weld.count];
    for corners in triangles {
        let corner = |points: &[DVec3], index: usize| points[corners[index] as usize];
        let edges =
            |points: &[DVec3]| (corner(points, 1) - corner(points, 0), corner(points, 2) - corner(points, 0));
        let (a, b) = edges(before);
        let (a_after, b_after) = edges(after);
        let cross = a.cross(b);
        let cross_after = a_after.cross(b_after);
        let (area, area_after) = (cross.length(), cross_after.length());
        let longest = a.length_squared().max(b.length_squared()).max((b - a).length_squared());
        if area <= 1e-10 * longest || area_after <= 0.0 {
            continue;
        }
        let normal = cross / area;
        let normal_after = cross_after / area_after * (area_after / area).sqrt();
        let outer =
            |column: DVec3, row: DVec3| DMat3::from_cols(column * row.x, column * row.y, column * row.z);
        let gradient = outer(a_after, b.cross(normal) / area)
            + outer(b_after, normal.cross(a) / area)
            + outer(normal_after, normal);
        let welded = corners.map(|vertex| weld.representative[vertex as usize]);
        for vertex in welded {
            let (sum, total) = &mut sums[vertex as usize];
            *sum += gradient * area;
            *total += area;
        }
    }
    sums.into_iter().map(|(sum, total)| (total > 0.0).then(|| sum * (1.0 / total))).collect()
}

/// The matrix that turns normals where `jacobian` moves points: its inverse transpose, up to a factor.
pub fn normal_matrix(jacobian: DMat3) -> DMat3 {
    let (x, y, z) = (jacobian.x_axis, jacobian.y_axis, jacobian.z_axis);
    let cofactors = DMat3::from_cols(y.cross(z), z.cross(x), x.cross(y));
    if jacobian.determinant() < 0.0 { cofactors * -1.0 } else { cofactors }
}
