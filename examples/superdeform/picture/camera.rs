//! Where a figure is looked at from.

use super::View;
use glam::{Vec2, Vec3};

/// A direction to look from, and how far the figure reaches as seen from there.
pub struct Camera {
    pub right: Vec3,
    pub up: Vec3,
    /// From the figure to the eye.
    pub toward: Vec3,
    /// Least and greatest coordinates along `right` and `up`, model units.
    pub low: Vec2,
    pub high: Vec2,
    /// Reach of what stands near the ground.
    feet: [f32; 2],
}

impl Camera {
    pub fn new(view: &View, up: Vec3, toward: Vec3) -> Self {
        let right = up.cross(toward);
        let mut camera = Self {
            right,
            up,
            toward,
            low: Vec2::splat(f32::INFINITY),
            high: Vec2::splat(f32::NEG_INFINITY),
            feet: [f32::INFINITY, f32::NEG_INFINITY],
        };
        let seen = |point: &Vec3| Vec2::new(point.dot(right), point.dot(up));
        for point in drawn_points(view) {
            camera.low = camera.low.min(seen(point));
            camera.high = camera.high.max(seen(point));
        }
        if !camera.low.is_finite() {
            camera.low = Vec2::ZERO;
            camera.high = Vec2::ONE;
            camera.feet = [0.0, 1.0];
            return camera;
        }
        let ankle = camera.low.y + 0.1 * (camera.high.y - camera.low.y);
        for point in drawn_points(view).map(seen).filter(|point| point.y < ankle) {
            camera.feet = [camera.feet[0].min(point.x), camera.feet[1].max(point.x)];
        }
        camera
    }

    pub fn width(&self) -> f32 {
        self.high.x - self.low.x
    }

    pub fn foot_middle(&self) -> f32 {
        (self.feet[0] + self.feet[1]) / 2.0
    }

    pub fn foot_width(&self) -> f32 {
        (self.feet[1] - self.feet[0]).clamp(0.0, self.width())
    }
}

fn drawn_points<'a>(view: &'a View) -> impl Iterator<Item = &'a Vec3> {
    view.meshes.iter().flat_map(|mesh| {
        mesh.triangles
            .iter()
            .flatten()
            .filter_map(|&vertex| mesh.positions.get(vertex as usize))
            .filter(|point| point.is_finite())
    })
}
