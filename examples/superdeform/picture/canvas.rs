//! Triangles into samples: depth, light, shade in folds; samples into pixels.

use super::light::{Light, to_display};
use super::surface::{PictureMesh, Surface};
use glam::{Vec2, Vec3, Vec4};
use superdeform_host::image::Sheet;
use superdeform_host::materials::Alpha;

/// Samples along each side of a pixel.
pub const SAMPLES: usize = 2;

/// Colour and depth of every sample of one view.
pub struct Canvas {
    width: usize,
    height: usize,
    /// Linear colour times alpha, and alpha.
    colours: Vec<Vec4>,
    /// Along the way to the eye; larger is nearer.
    depths: Vec<f32>,
}

#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Pass {
    /// What hides what is behind it.
    Solid,
    /// What is seen through.
    Clear,
}

impl Canvas {
    /// An empty canvas, in samples.
    pub fn new(width: usize, height: usize) -> Self {
        Self {
            width,
            height,
            colours: vec![Vec4::ZERO; width * height],
            depths: vec![f32::NEG_INFINITY; width * height],
        }
    }

    /// Draws what belongs to `pass`; `place` gives columns, rows and depth of a point.
    pub fn draw_mesh(
        &mut self,
        mesh: &PictureMesh,
        surface: &Surface,
        place: &impl Fn(Vec3) -> Vec3,
        light: &Light,
        pass: Pass,
    ) {
        let placed: Vec<Vec3> = mesh.positions.iter().map(|&point| place(point)).collect();
        for corners in mesh.triangles {
            let [a, b, c] = corners.map(|corner| placed[corner as usize]);
            let area = (b - a).truncate().perp_dot((c - a).truncate());
            if !area.is_finite() || area.abs() < 1e-6 {
                continue;
            }
            // Rows run down, so a triangle that is counter-clockwise to the eye has a negative area here.
            let from_behind = (area > 0.0) != surface.mirrored;
            if from_behind && !mesh.material.double_sided {
                continue;
            }
            let low = a.min(b).min(c);
            let high = a.max(b).max(c);
            let first_row = (low.y - 0.5).ceil().max(0.0) as usize;
            let last_row = ((high.y + 0.5).floor().max(0.0) as usize).min(self.height);
            let first_column = (low.x - 0.5).ceil().max(0.0) as usize;
            let last_column = ((high.x + 0.5).floor().max(0.0) as usize).min(self.width);
            for row in first_row..last_row {
                for column in first_column..last_column {
                    let point = Vec2::new(column as f32 + 0.5, row as f32 + 0.5);
                    let to = [a, b, c].map(|corner| corner.truncate() - point);
                    let share =
                        Vec3::new(to[1].perp_dot(to[2]), to[2].perp_dot(to[0]), to[0].perp_dot(to[1])) / area;
                    if share.min_element() < 0.0 {
                        continue;
                    }
                    let depth = share.dot(Vec3::new(a.z, b.z, c.z));
                    let sample = row * self.width + column;
                    if depth <= self.depths[sample] {
                        continue;
                    }
                    let paint = mesh.paint(corners, share);
                    let solid = match mesh.material.alpha {
                        Alpha::Opaque => true,
                        Alpha::Mask(cutoff) if paint.w < cutoff => continue,
                        Alpha::Mask(_) => true,
                        Alpha::Blend => paint.w >= 0.5,
                    };
                    if solid != (pass == Pass::Solid) {
                        continue;
                    }
                    let mut normal = Vec3::ZERO;
                    for (&corner, share) in corners.iter().zip(share.to_array()) {
                        normal += share * surface.normals[corner as usize];
                    }
                    if from_behind {
                        normal = -normal;
                    }
                    let lit = light.on(paint.truncate(), normal, mesh.material.unlit);
                    let alpha = if solid { 1.0 } else { paint.w };
                    let under = self.colours[sample];
                    self.colours[sample] = (lit * alpha).extend(alpha) + under * (1.0 - alpha);
                    if solid {
                        self.depths[sample] = depth;
                    }
                }
            }
        }
    }

    /// Darkens samples that have nearer ones around them: folds, and what lies under something.
    pub fn darken_corners(&mut self, reach: f32) {
        const DIRECTIONS: usize = 8;
        // Four turns of the star, one for each sample of a pixel, so that its rays do not show.
        let stars: Vec<[(isize, isize, f32); DIRECTIONS]> = (0..SAMPLES * SAMPLES)
            .map(|turn| {
                std::array::from_fn(|index| {
                    let part = index as f32 + turn as f32 / (SAMPLES * SAMPLES) as f32;
                    let angle = part * std::f32::consts::TAU / DIRECTIONS as f32;
                    let length = reach * (0.35 + 0.65 * ((index * 5 + turn * 3) % DIRECTIONS) as f32 / 7.0);
                    let offset = Vec2::from_angle(angle) * length;
                    (offset.x.round() as isize, offset.y.round() as isize, length)
                })
            })
            .collect();
        for row in 0..self.height {
            for column in 0..self.width {
                let sample = row * self.width + column;
                let depth = self.depths[sample];
                if depth == f32::NEG_INFINITY {
                    continue;
                }
                let star = &stars[row % SAMPLES * SAMPLES + column % SAMPLES];
                let mut hidden = 0.0;
                for &(right, down, length) in star {
                    let (Some(x), Some(y)) = (column.checked_add_signed(right), row.checked_add_signed(down))
                    else {
                        continue;
                    };
                    if x >= self.width || y >= self.height {
                        continue;
                    }
                    let nearer = self.depths[y * self.width + x] - depth;
                    // What is much nearer is another part far in front, and casts no such shade.
                    let slope = (nearer / length - 0.35).clamp(0.0, 1.0);
                    hidden += slope * (1.0 - nearer / (3.0 * reach)).clamp(0.0, 1.0);
                }
                let keep = 1.0 - 0.75 * hidden / DIRECTIONS as f32;
                let colour = &mut self.colours[sample];
                *colour = (colour.truncate() * keep).extend(colour.w);
            }
        }
    }

    /// Averages the samples of each pixel and lays them over the sheet.
    pub fn lay_on(&self, sheet: &mut Sheet, left: u32, top: u32) {
        for y in 0..self.height / SAMPLES {
            for x in 0..self.width / SAMPLES {
                let mut sum = Vec4::ZERO;
                for sample in 0..SAMPLES * SAMPLES {
                    let row = y * SAMPLES + sample / SAMPLES;
                    let colour = self.colours[row * self.width + x * SAMPLES + sample % SAMPLES];
                    if colour.w > 0.0 {
                        let display = (colour.truncate() / colour.w).map(to_display);
                        sum += (display * colour.w).extend(colour.w);
                    }
                }
                let (column, row) = (left + x as u32, top + y as u32);
                if sum.w == 0.0 || column >= sheet.width() || row >= sheet.height() {
                    continue;
                }
                let sum = sum / (SAMPLES * SAMPLES) as f32;
                let under = sheet.at_mut(column, row);
                for (channel, value) in under.iter_mut().enumerate() {
                    let below = f32::from(*value) * (1.0 - sum.w);
                    *value = (255.0 * sum[channel] + below).round().clamp(0.0, 255.0) as u8;
                }
            }
        }
    }
}
