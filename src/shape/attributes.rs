//! Normals and tangents after a deformation: turned by the Jacobian, never recomputed from faces.
//!
//! The field's own Jacobian holds the weights fixed, but weights change along the surface and that turns it too. So
//! the Jacobian is fitted to what happened to the triangles around each welded vertex; authored normals (faces of
//! drawn characters have edited ones) keep what was edited, and vertices at one place turn alike.

use crate::geometry::weld::Weld;
use crate::parallel;
use glam::{DMat3, DVec3, Mat3};

/// Fewer triangles than this are not worth a thread.
const LEAST_TRIANGLES: usize = 4000;

/// What a mesh is at rest, to fit Jacobians to what happens to it.
///
#[derive(Clone, Debug, Default)]
pub struct RestTriangles {
    /// One for each triangle that has an area.
    triangles: Vec<RestTriangle>,
    /// Where each welded vertex's triangles start in `around`; one more than there are welded vertices.
    starts: Vec<u32>,
    /// Triangles around each welded vertex, ascending; twice where two of a triangle's corners are one vertex.
    around: Vec<u32>,
    /// From model units to mean edges of 1, so that no unit is out of a float's range.
    scale: f64,
}

#[derive(Clone, Debug)]
struct RestTriangle {
    corners: [u32; 3],
    /// Rows by which the two edges after, and a normal, make up the gradient, by area.
    rows: [DVec3; 3],
    /// Twice the triangle's.
    area: f64,
}

impl RestTriangles {
    /// The triangles between `positions`, around the vertices that `weld` makes one.
    pub fn of(positions: &[DVec3], triangles: &[[u32; 3]], weld: &Weld) -> Self {
        let has_area = |&corners: &[u32; 3]| {
            let (a, b) = edges(positions, corners);
            let longest = a.length_squared().max(b.length_squared()).max((b - a).length_squared());
            a.cross(b).length() > 1e-10 * longest
        };
        let triangles: Vec<[u32; 3]> = triangles.iter().copied().filter(has_area).collect();
        let total: f64 = triangles.iter().map(|&corners| edges(positions, corners).0.length()).sum();
        let scale = triangles.len() as f64 / total;
        let mut starts = vec![0u32; weld.count + 1];
        for corner in triangles.iter().flat_map(|&corners| weld.triangle(corners)) {
            starts[corner as usize + 1] += 1;
        }
        for vertex in 0..weld.count {
            starts[vertex + 1] += starts[vertex];
        }
        let mut next = starts.clone();
        let mut around = vec![0u32; 3 * triangles.len()];
        for (index, &corners) in triangles.iter().enumerate() {
            for corner in weld.triangle(corners) {
                let place = &mut next[corner as usize];
                around[*place as usize] = index as u32;
                *place += 1;
            }
        }
        let rest = |corners: [u32; 3]| {
            let (a, b) = edges(positions, corners);
            let (a, b) = (a * scale, b * scale);
            let cross = a.cross(b);
            let area = cross.length();
            let normal = cross / area;
            RestTriangle { corners, rows: [b.cross(normal), normal.cross(a), area * normal], area }
        };
        Self { triangles: triangles.into_iter().map(rest).collect(), starts, around, scale }
    }

    /// What happens to each triangle where all vertices go to `after`.
    ///
    /// The deformation gradient of its edges, with the normal as third axis scaled by the root of the change of area, so
    /// that a uniform scaling is fitted exactly.
    ///
    /// - `threads`: at most this many, 0 for all cores; the result does not depend on it.
    pub fn gradients(&self, after: &[DVec3], threads: usize) -> Gradients<'_> {
        let gradient = |index: usize| {
            let RestTriangle { corners, rows, area } = self.triangles[index];
            let (a, b) = edges(after, corners);
            let (a, b) = (a * self.scale, b * self.scale);
            let cross = a.cross(b);
            let area_after = cross.length();
            if area_after <= 0.0 {
                return (Mat3::ZERO, 0.0);
            }
            let normal = cross * ((area_after / area).sqrt() / area_after);
            let gradient = outer(a, rows[0]) + outer(b, rows[1]) + outer(normal, rows[2]);
            (gradient.as_mat3(), area as f32)
        };
        let by_area = parallel::collect(threads, self.triangles.len(), LEAST_TRIANGLES, gradient);
        Gradients { rest: self, by_area }
    }
}

/// What happens to each triangle of a mesh.
pub struct Gradients<'a> {
    rest: &'a RestTriangles,
    /// Times its area, and that area; 0 for a triangle that has lost its own. Directions come out as floats, so these are
    /// kept as such: half as much to read.
    by_area: Vec<(Mat3, f32)>,
}

impl Gradients<'_> {
    /// The Jacobian fitted to the triangles around a welded vertex, their mean by area; `None` where none has an area.
    pub fn jacobian(&self, welded: usize) -> Option<DMat3> {
        let around = self.rest.starts[welded] as usize..self.rest.starts[welded + 1] as usize;
        let (mut sum, mut total) = (Mat3::ZERO, 0.0);
        for &triangle in &self.rest.around[around] {
            let (gradient, area) = self.by_area[triangle as usize];
            sum += gradient;
            total += area;
        }
        (total > 0.0).then(|| (sum * (1.0 / total)).as_dmat3())
    }
}

fn outer(column: DVec3, row: DVec3) -> DMat3 {
    DMat3::from_cols(column * row.x, column * row.y, column * row.z)
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
