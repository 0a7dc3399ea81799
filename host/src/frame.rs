//! What a matrix does to points, displacements, normals and tangents.

use glam::{DMat3, DMat4, DVec3, Vec3};

/// An affine map with what it does to directions and normals.
pub struct Frame {
    matrix: DMat4,
    linear: DMat3,
    normals: DMat3,
    identity: bool,
}

impl Frame {
    /// The map of a matrix that can be inverted.
    pub fn of(matrix: DMat4) -> Self {
        let linear = DMat3::from_mat4(matrix);
        Self { matrix, linear, normals: linear.inverse().transpose(), identity: matrix == DMat4::IDENTITY }
    }

    /// Maps a point.
    pub fn point(&self, point: DVec3) -> DVec3 {
        self.matrix.transform_point3(point)
    }

    /// Maps a displacement, times `scale`; one of 0 stays exactly 0.
    pub fn delta(&self, delta: Vec3, scale: f64) -> Vec3 {
        Self::scaled(&self.linear, delta, scale, self.identity)
    }

    /// Maps the change of a normal whose length was divided by `scale`'s inverse.
    pub fn normal_delta(&self, delta: Vec3, scale: f64) -> Vec3 {
        Self::scaled(&self.normals, delta, scale, self.identity)
    }

    fn scaled(linear: &DMat3, delta: Vec3, scale: f64, identity: bool) -> Vec3 {
        if identity && scale == 1.0 || delta == Vec3::ZERO {
            return delta;
        }
        (*linear * delta.as_dvec3() * scale).as_vec3()
    }

    /// Maps a unit normal; also what its length was multiplied by to be 1 again.
    pub fn normal(&self, normal: Vec3) -> (Vec3, f64) {
        self.unit(&self.normals, normal)
    }

    /// Maps a unit tangent; also what its length was multiplied by to be 1 again.
    pub fn tangent(&self, tangent: Vec3) -> (Vec3, f64) {
        self.unit(&self.linear, tangent)
    }

    fn unit(&self, linear: &DMat3, direction: Vec3) -> (Vec3, f64) {
        // Unit but for rounding: left as it is, bit for bit.
        if self.identity && (direction.length_squared() - 1.0).abs() < 1e-4 {
            return (direction, 1.0);
        }
        let mapped = *linear * direction.as_dvec3();
        let length = mapped.length();
        if length > 0.0 && length.is_finite() {
            ((mapped / length).as_vec3(), 1.0 / length)
        } else {
            (direction, 1.0)
        }
    }
}
