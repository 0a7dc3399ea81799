//! How light falls on a surface, and from linear light to a picture's colours.

use super::camera::Camera;
use glam::Vec3;
use superdeform_host::image::to_srgb;

/// A key light over the eye's left shoulder, light from sky and floor, and a rim from behind.
pub struct Light {
    key: Vec3,
    up: Vec3,
    toward: Vec3,
}

impl Light {
    pub fn new(camera: &Camera) -> Self {
        Self {
            key: (-0.45 * camera.right + 0.6 * camera.up + 0.75 * camera.toward).normalize(),
            up: camera.up,
            toward: camera.toward,
        }
    }

    /// The linear colour that a surface of colour `paint` shows.
    pub fn on(&self, paint: Vec3, normal: Vec3, unlit: bool) -> Vec3 {
        const SKY: Vec3 = Vec3::new(0.42, 0.45, 0.50);
        const FLOOR: Vec3 = Vec3::new(0.30, 0.27, 0.25);
        const KEY: Vec3 = Vec3::new(0.68, 0.66, 0.62);
        let normal = normal.normalize_or(self.toward);
        // Light that wraps around: characters are drawn with soft edges of shade.
        let facing = (0.5 + 0.5 * normal.dot(self.key)).max(0.0);
        let above = 0.5 + 0.5 * normal.dot(self.up);
        let mut light = KEY * facing * facing + FLOOR.lerp(SKY, above);
        if unlit {
            light = light.lerp(Vec3::splat(0.98), 0.55);
        }
        let edge = 1.0 - normal.dot(self.toward).clamp(0.0, 1.0);
        let rim = 0.35 * edge * edge * edge * above;
        paint * (light + rim) + Vec3::splat(0.05 * rim)
    }
}

/// Linear light to sRGB, 0 to 1; what is bright nears white without reaching it, so that white clothes keep their folds.
pub fn to_display(value: f32) -> f32 {
    const EXPOSURE: f32 = 1.06;
    const SHOULDER: f32 = 0.55;
    let above = (EXPOSURE * value - SHOULDER).max(0.0) / (1.0 - SHOULDER);
    let value = (EXPOSURE * value).clamp(0.0, SHOULDER) + (1.0 - SHOULDER) * (1.0 - (-above).exp());
    to_srgb(value)
}
