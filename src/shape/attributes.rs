//! Normals and tangents after a deformation: turned by the Jacobian, never recomputed from faces.
//!
//! The field's own Jacobian holds the weights fixed, but weights change along the surface and that turns it too. So
//! the Jacobian is fitted to what happened to the triangles around each welded vertex; authored normals (faces of
//! drawn characters have edited ones) keep what was edited, and vertices at one place turn alike.

use crate::geometry::weld::Weld;
use crate::parallel;
use glam::{DMat3, DVec3};

/// Fewer triangles than this are not worth a thread.
const LEAST_TRIANGLES: usize = 4000;

/// What a mesh is at rest, to fit Jacobians to what happens to it.
#[derive(Clone, Debug, Default)]
pub struct RestTriangles {
    /// One for each triangle that has an area.
    triangles: Vec<RestTriangle>,
    /// Where each welded vertex's triangles start in `around`; one more than there are welded vertices.
    starts: Vec<u32>,
    /// Triangles around each welded vertex, ascending; twice where two of a triangle's corners are one vertex.
    around: Vec<u32>,
}

#[derive(Clone, Debug)]
struct RestTriangle {
    corners: [u32; 3],
    /// Rows by which the two edges after make up the gradient.
    rows: [DVec3; 2],
    normal: DVec3,
    /// Twice the triangle's.
    area: f64,
}

impl RestTriangles {
    /// The triangles between `positions`, around the vertices that `weld` makes one.
    pub fn of(positions: &[DVec3], triangles: &[[u32; 3]], weld: &Weld) -> Self {
        let triangles: Vec<RestTriangle> = triangles
            .iter()
            .filter_map(|&corners| {
                let (a, b) = edges(positions, corners);
                let cross = a.cross(b);
                let area = cross.length();
                let longest = a.length_squared().max(b.length_squared()).max((b - a).length_squared());
                if area <= 1e-10 * longest {
                    return None;
                }
                let normal = cross / area;
                Some(RestTriangle {
                    corners,
                    rows: [b.cross(normal) / area, normal.cross(a) / area],
                    normal,
                    area,
                })
            })
            .collect();
        let mut starts = vec![0u32; weld.count + 1];
        for corner in triangles.iter().flat_map(|triangle| weld.triangle(triangle.corners)) {
            starts[corner as usize + 1] += 1;
        }
        for vertex in 0..weld.count {
            starts[vertex + 1] += starts[vertex];
        }
        let mut next = starts.clone();
        let mut around = vec![0u32; 3 * triangles.len()];
        for (index, triangle) in triangles.iter().enumerate() {
            for corner in weld.triangle(triangle.corners) {
                let place = &mut next[corner as usize];
                around[*place as usize] = index as u32;
                *place += 1;
            }
        }
        Self { triangles, starts, around }
    }

    /// The fitted Jacobian of each welded vertex; `None` where no triangle with an area is around it.
    ///
    /// Per triangle the deformation gradient of its edges, with the normal as third axis scaled by the root of the
    /// change of area (so that a uniform scaling is fitted exactly); the mean of these by area.
    ///
    /// - `after`: where all vertices are now.
    /// - `threads`: at most this many, 0 for all cores; the result does not depend on it.
    pub fn fitted_jacobians(&self, after: &[DVec3], threads: usize) -> Vec<Option<DMat3>> {
        // By area; a triangle that has lost its own counts for nothing.
        let gradients: Vec<(DMat3, f64)> =
            parallel::collect(threads, self.triangles.len(), LEAST_TRIANGLES, |index| {
                let RestTriangle { corners, rows, normal, area } = self.triangles[index];
                let (a, b) = edges(after, corners);
                let cross = a.cross(b);
                let area_after = cross.length();
                if area_after <= 0.0 {
                    return (DMat3::ZERO, 0.0);
                }
                let normal_after = cross / area_after * (area_after / area).sqrt();
                let outer = |column: DVec3, row: DVec3| {
                    DMat3::from_cols(column * row.x, column * row.y, column * row.z)
                };
                ((outer(a, rows[0]) + outer(b, rows[1]) + outer(normal_after, normal)) * area, area)
            });
        parallel::collect(threads, self.starts.len() - 1, LEAST_TRIANGLES, |vertex| {
            let around = self.starts[vertex] as usize..self.starts[vertex + 1] as usize;
            let (mut sum, mut total) = (DMat3::ZERO, 0.0);
            for &triangle in &self.around[around] {
                let (gradient, area) = gradients[triangle as usize];
                sum += gradient;
                total += area;
            }
            (total > 0.0).then(|| sum * (1.0 / total))
        })
    }
}

/// From a triangle's first corner to the others.
fn edges(points: &[DVec3], [a, b, c]: [u32; 3]) -> (DVec3, DVec3) {
    let first = points[a as usize];
    (points[b as usize] - first, points[c as usize] - first)
}

/// The matrix that turns normals where `jacobian` moves points: its inverse transpose, up to a factor.
pub fn normal_matrix(jacobian: DMat3) -> DMat3 {
    let (x, y, z) = (jacobian.x_axis, jacobian.y_axis, jacobian.z_axis);
    let cofactors = DMat3::from_cols(y.cross(z), z.cross(x), x.cross(y));
    if jacobian.determinant() < 0.0 { cofactors * -1.0 } else { cofactors }
}
