//! Normals and tangents after a deformation: turned by the Jacobian, never recomputed from faces.
//!
//! The field's own Jacobian holds the weights fixed, but weights change along the surface and that turns it too. So
//! the Jacobian is fitted to what happened to the triangles around each welded vertex; authored normals (faces of
//! drawn characters have edited ones) keep what was edited, and vertices at one place turn alike.

use crate::geometry::weld::Weld;
use crate::parallel;
use glam::{DVec3, Mat3A, Vec3, Vec3A, Vec4};

/// Triangles of less than this share of their longest edge's square have no direction: rounding to 32 bits alone would
/// turn them.
const LEAST_AREA: f64 = 1e-10;
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
    /// From model units to edges of about 1, so that no unit is out of a float's range. A power of two, by which nothing is
    /// rounded: a mirrored mesh, wound the other way, may have another one.
    scale: f64,
}

/// Directions come out as floats, so these numbers are kept as such: half as much to read.
#[derive(Clone, Debug)]
struct RestTriangle {
    corners: [u32; 3],
    /// Rows by which the two edges after, and a normal, make up the gradient, by area.
    rows: [Vec3; 3],
    /// Twice the triangle's.
    area: f32,
}

impl RestTriangles {
    /// The triangles between `positions`, around the vertices that `weld` makes one.
    pub fn of(positions: &[DVec3], triangles: &[[u32; 3]], weld: &Weld) -> Self {
        let has_area = |&corners: &[u32; 3]| {
            let (a, b) = edges(positions, corners);
            let longest = a.length_squared().max(b.length_squared()).max((b - a).length_squared());
            a.cross(b).length() > LEAST_AREA * longest
        };
        let triangles: Vec<[u32; 3]> = triangles.iter().copied().filter(has_area).collect();
        let total: f64 = triangles.iter().map(|&corners| edges(positions, corners).0.length()).sum();
        let scale = 2f64.powi((triangles.len() as f64 / total).log2().round() as i32);
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
            let rows = [b.cross(normal), normal.cross(a), area * normal].map(|row| row.as_vec3());
            RestTriangle { corners, rows, area: area as f32 }
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
            let RestTriangle { corners, rows, area } = &self.triangles[index];
            let (a, b) = edges(after, *corners);
            let [a, b] = [a, b].map(|edge| (edge * self.scale).as_vec3a());
            let cross = a.cross(b);
            let area_after = cross.length();
            if area_after <= 0.0 || !area_after.is_finite() {
                return [Vec4::ZERO; 3];
            }
            let normal = cross * ((area_after / area).sqrt() / area_after);
            let column = |axis: usize| a * rows[0][axis] + b * rows[1][axis] + normal * rows[2][axis];
            [column(0).extend(*area), column(1).extend(0.0), column(2).extend(0.0)]
        };
        let by_area = parallel::collect(threads, self.triangles.len(), LEAST_TRIANGLES, gradient);
        Gradients { rest: self, by_area }
    }
}

/// What happens to each triangle of a mesh.
pub struct Gradients<'a> {
    rest: &'a RestTriangles,
    /// Columns times the triangle's area, and that area as the first one's w; all 0 for a triangle that has lost its own.
    by_area: Vec<[Vec4; 3]>,
}

impl Gradients<'_> {
    /// The Jacobian fitted to the triangles around a welded vertex, their mean by area; `None` where none has an area.
    pub fn jacobian(&self, welded: usize) -> Option<Mat3A> {
        let around = self.rest.starts[welded] as usize..self.rest.starts[welded + 1] as usize;
        let mut sum = [Vec4::ZERO; 3];
        for &triangle in &self.rest.around[around] {
            for (sum, column) in sum.iter_mut().zip(&self.by_area[triangle as usize]) {
                *sum += *column;
            }
        }
        let total = sum[0].w;
        let [x, y, z] = sum.map(|column| Vec3A::from_vec4(column) * total.recip());
        (total > 0.0).then(|| Mat3A::from_cols(x, y, z))
    }
}

/// From a triangle's first corner to the others.
fn edges(points: &[DVec3], [a, b, c]: [u32; 3]) -> (DVec3, DVec3) {
    let first = points[a as usize];
    (points[b as usize] - first, points[c as usize] - first)
}

/// Below this determinant a Jacobian has no volume left, and turns nothing.
const LEAST_VOLUME: f32 = 1e-12;

/// Whether normals can be turned by `jacobian`.
pub fn has_volume(jacobian: &Mat3A) -> bool {
    jacobian.determinant().abs() > LEAST_VOLUME
}

/// The matrix that turns normals where `jacobian` moves points: its inverse transpose, up to a factor.
pub fn normal_matrix(jacobian: &Mat3A) -> Mat3A {
    let (x, y, z) = (jacobian.x_axis, jacobian.y_axis, jacobian.z_axis);
    let volume = y.cross(z);
    let cofactors = Mat3A::from_cols(volume, z.cross(x), x.cross(y));
    if volume.dot(x) < 0.0 { -cofactors } else { cofactors }
}
