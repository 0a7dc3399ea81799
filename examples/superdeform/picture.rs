//! A picture of characters side by side, front and side view, drawn without a graphics card.
//!
//! Orthographic, one scale for all figures, depth buffer, 2 by 2 samples a pixel.

use crate::lettering;
use crate::materials::{Alpha, Material, Texture, Wrap};
use glam::{Vec2, Vec3, Vec4};
use image::{Rgb, RgbImage, RgbaImage};
use std::io::Cursor;
use std::path::Path;

/// Samples along each side of a pixel.
const SAMPLES: usize = 2;
/// The tallest figure's height in pixels.
const FIGURE_HEIGHT: f32 = 560.0;
/// A sheet is not made wider than this; figures get smaller instead.
const LARGEST_WIDTH: f32 = 2600.0;
/// Pixels between the two views of a figure.
const VIEW_GAP: f32 = 26.0;
/// Pixels between two figures, and around the sheet.
const FIGURE_GAP: f32 = 56.0;
const TOP: f32 = 40.0;
const BOTTOM: f32 = 108.0;
/// A figure this many times taller or smaller than the first is in another unit, and is drawn at the first's height.
const OTHER_UNIT: f32 = 4.0;

const BACKGROUND_TOP: [f32; 3] = [246.0, 247.0, 250.0];
const BACKGROUND_BOTTOM: [f32; 3] = [226.0, 230.0, 237.0];
const TITLE_COLOUR: [u8; 3] = [58, 64, 78];
const NOTE_COLOUR: [u8; 3] = [124, 132, 148];

/// One mesh: vertices in model space and what they look like. Lists that are empty are not there.
#[derive(Clone, Debug)]
pub struct PictureMesh<'a> {
    /// Positions.
    pub positions: &'a [Vec3],
    /// Normals, one a vertex; made from the triangles where empty.
    pub normals: &'a [Vec3],
    /// Corners as indices into `positions`.
    pub triangles: &'a [[u32; 3]],
    /// Texture coordinates, one a vertex.
    pub uvs: &'a [[f32; 2]],
    /// Linear vertex colours, one a vertex.
    pub colours: &'a [[f32; 4]],
    /// The material.
    pub material: &'a Material,
}

/// One figure of the sheet.
#[derive(Clone, Debug)]
pub struct View<'a> {
    /// The caption.
    pub title: String,
    /// A second, paler line; may be empty.
    pub note: String,
    /// What is drawn.
    pub meshes: Vec<PictureMesh<'a>>,
    /// From feet to head.
    pub up: Vec3,
    /// The way the face looks.
    pub forward: Vec3,
}

/// Draws `views` from left to right, each from the front and from its left side, on one ground line.
pub fn draw(views: &[View]) -> RgbImage {
    let mut figures: Vec<Figure> = views.iter().map(Figure::new).collect();
    if let Some(first) = figures.first().map(Figure::height) {
        for figure in &mut figures {
            let ratio = figure.height() / first;
            if !(1.0 / OTHER_UNIT..=OTHER_UNIT).contains(&ratio) {
                figure.unit = 1.0 / ratio;
            }
        }
    }
    let scale = scale(&figures);
    let tallest = figures.iter().map(|figure| figure.height() * figure.unit).fold(0.0, f32::max);
    let ground = TOP + tallest * scale;
    let width = figures.iter().map(|figure| figure.width(scale) + FIGURE_GAP).sum::<f32>() + FIGURE_GAP;
    let mut sheet = background(width.ceil() as u32, (ground + BOTTOM).ceil() as u32, ground);
    let mut left = FIGURE_GAP;
    for (view, figure) in views.iter().zip(&figures) {
        let centre = left + figure.width(scale) / 2.0;
        let pixels = scale * figure.unit;
        for camera in &figure.cameras {
            let origin = [left - camera.low.x * pixels, ground + camera.low.y * pixels];
            shadow(
                &mut sheet,
                origin[0] + camera.foot_middle() * pixels,
                ground,
                camera.foot_width() * pixels,
            );
            draw_figure(&mut sheet, view, figure, camera, pixels, origin);
            left += camera.width() * pixels + VIEW_GAP;
        }
        lettering::draw(&mut sheet, &view.title, centre, ground + 52.0, 2.6, TITLE_COLOUR);
        lettering::draw(&mut sheet, &view.note, centre, ground + 82.0, 1.8, NOTE_COLOUR);
        left += FIGURE_GAP - VIEW_GAP;
    }
    sheet
}

/// Writes a sheet as PNG; the file is there whole or not at all.
///
/// # Errors
/// One sentence with the path and the reason.
pub fn save(sheet: &RgbImage, path: &Path) -> Result<(), String> {
    let mut bytes = Cursor::new(Vec::new());
    sheet
        .write_to(&mut bytes, image::ImageFormat::Png)
        .map_err(|error| format!("{}: cannot be written ({error})", path.display()))?;
    crate::output::write(path, bytes.get_ref())
}

/// A direction to look from, and how far the figure reaches as seen from there.
struct Camera {
    right: Vec3,
    up: Vec3,
    /// From the figure to the eye.
    toward: Vec3,
    low: Vec2,
    high: Vec2,
    /// Reach of what stands near the ground.
    feet: [f32; 2],
}

impl Camera {
    fn new(view: &View, up: Vec3, toward: Vec3) -> Self {
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

    fn width(&self) -> f32 {
        self.high.x - self.low.x
    }

    fn foot_middle(&self) -> f32 {
        (self.feet[0] + self.feet[1]) / 2.0
    }

    fn foot_width(&self) -> f32 {
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

struct Figure {
    cameras: [Camera; 2],
    /// What its lengths are multiplied by to be in the first figure's unit.
    unit: f32,
    surfaces: Vec<Surface>,
}

/// What is found out once about a mesh and used from every side.
struct Surface {
    normals: Vec<Vec3>,
    /// True where triangles run the other way round than their normals say (mirrored nodes).
    mirrored: bool,
}

impl Figure {
    fn new(view: &View) -> Self {
        let up = view.up.normalize_or(Vec3::Y);
        let front = view.forward.reject_from_normalized(up).normalize_or(up.any_orthonormal_vector());
        let side = up.cross(front);
        Self {
            cameras: [Camera::new(view, up, front), Camera::new(view, up, side)],
            unit: 1.0,
            surfaces: view.meshes.iter().map(Surface::new).collect(),
        }
    }

    /// Above 0 even for a figure without extent.
    fn height(&self) -> f32 {
        let camera = &self.cameras[0];
        let height = (camera.high.y - camera.low.y).max(1e-3 * camera.width());
        if height > 0.0 { height } else { 1.0 }
    }

    fn width(&self, scale: f32) -> f32 {
        self.cameras.iter().map(|camera| camera.width() * scale * self.unit).sum::<f32>() + VIEW_GAP
    }
}

impl Surface {
    fn new(mesh: &PictureMesh) -> Self {
        let face_normal = |corners: &[u32; 3]| {
            let [a, b, c] = corners.map(|corner| mesh.positions[corner as usize]);
            (b - a).cross(c - a)
        };
        if mesh.normals.len() != mesh.positions.len() {
            let mut normals = vec![Vec3::ZERO; mesh.positions.len()];
            for corners in mesh.triangles {
                for &corner in corners {
                    normals[corner as usize] += face_normal(corners);
                }
            }
            return Self { normals, mirrored: false };
        }
        let agreeing = mesh
            .triangles
            .iter()
            .filter(|corners| {
                let normal: Vec3 = corners.iter().map(|&corner| mesh.normals[corner as usize]).sum();
                normal.dot(face_normal(corners)) > 0.0
            })
            .count();
        Self { normals: mesh.normals.to_vec(), mirrored: 2 * agreeing < mesh.triangles.len() }
    }
}

/// Pixels per unit, and every figure's own unit.
fn scale(figures: &[Figure]) -> f32 {
    let tallest =
        figures.iter().map(|figure| figure.height() * figure.unit).fold(f32::MIN_POSITIVE, f32::max);
    let by_height = FIGURE_HEIGHT / tallest;
    let drawn: f32 = figures.iter().map(|figure| figure.width(by_height) - VIEW_GAP).sum();
    let gaps = FIGURE_GAP + figures.len() as f32 * (FIGURE_GAP + VIEW_GAP);
    by_height * ((LARGEST_WIDTH - gaps) / drawn.max(1.0)).clamp(0.0, 1.0)
}

fn background(width: u32, height: u32, ground: f32) -> RgbImage {
    let mut sheet = RgbImage::from_fn(width, height, |_, y| {
        let share = y as f32 / height as f32;
        Rgb([0, 1, 2].map(|channel| {
            let (from, to) = (BACKGROUND_TOP[channel], BACKGROUND_BOTTOM[channel]);
            (from + (to - from) * share).round() as u8
        }))
    });
    let line = ground.round() as u32;
    for x in (FIGURE_GAP / 2.0) as u32..width.saturating_sub((FIGURE_GAP / 2.0) as u32) {
        for y in line..(line + 2).min(height) {
            sheet.put_pixel(x, y, Rgb([196, 202, 214]));
        }
    }
    sheet
}

/// A soft patch under the feet.
fn shadow(sheet: &mut RgbImage, centre: f32, ground: f32, foot_width: f32) {
    let (half_width, half_height) = (0.62 * foot_width + 14.0, 9.0);
    for y in (ground - half_height).max(0.0) as u32..((ground + half_height) as u32).min(sheet.height()) {
        let last = ((centre + half_width).max(0.0) as u32).min(sheet.width());
        for x in (centre - half_width).max(0.0) as u32..last {
            let across = (x as f32 - centre) / half_width;
            let down = (y as f32 - ground) / half_height;
            let depth = (1.0 - across * across - down * down).max(0.0);
            let keep = 1.0 - 0.32 * depth * depth;
            let Rgb(under) = sheet.get_pixel_mut(x, y);
            *under = under.map(|channel| (f32::from(channel) * keep) as u8);
        }
    }
}

/// Colour and depth of every sample of one view.
struct Canvas {
    width: usize,
    height: usize,
    /// Linear colour times alpha, and alpha.
    colours: Vec<Vec4>,
    /// Along the way to the eye; larger is nearer.
    depths: Vec<f32>,
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Pass {
    /// What hides what is behind it.
    Solid,
    /// What is seen through.
    Clear,
}

fn draw_figure(
    sheet: &mut RgbImage,
    view: &View,
    figure: &Figure,
    camera: &Camera,
    pixels: f32,
    origin: [f32; 2],
) {
    let margin = 3.0;
    let corner = [
        (origin[0] + camera.low.x * pixels - margin).floor().max(0.0),
        (origin[1] - camera.high.y * pixels - margin).floor().max(0.0),
    ];
    let width = (camera.width() * pixels + 2.0 * margin).ceil() as usize * SAMPLES;
    let height = ((camera.high.y - camera.low.y) * pixels + 2.0 * margin).ceil() as usize * SAMPLES;
    let mut canvas = Canvas {
        width,
        height,
        colours: vec![Vec4::ZERO; width * height],
        depths: vec![f32::NEG_INFINITY; width * height],
    };
    let samples = SAMPLES as f32;
    let place = |point: Vec3| {
        Vec3::new(
            (origin[0] - corner[0] + point.dot(camera.right) * pixels) * samples,
            (origin[1] - corner[1] - point.dot(camera.up) * pixels) * samples,
            point.dot(camera.toward) * pixels * samples,
        )
    };
    let light = Light::new(camera);
    for pass in [Pass::Solid, Pass::Clear] {
        for (mesh, surface) in view.meshes.iter().zip(&figure.surfaces) {
            if pass == Pass::Solid || mesh.material.alpha == Alpha::Blend {
                canvas.draw_mesh(mesh, surface, &place, &light, pass);
            }
        }
        if pass == Pass::Solid {
            let reach = 0.022 * figure.height() * pixels * samples;
            canvas.darken_corners(reach);
        }
    }
    canvas.lay_on(sheet, corner[0] as u32, corner[1] as u32);
}

impl Canvas {
    fn draw_mesh(
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
    fn darken_corners(&mut self, reach: f32) {
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
    fn lay_on(&self, sheet: &mut RgbImage, left: u32, top: u32) {
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
                let Rgb(under) = sheet.get_pixel_mut(column, row);
                for (channel, value) in under.iter_mut().enumerate() {
                    let below = f32::from(*value) * (1.0 - sum.w);
                    *value = (255.0 * sum[channel] + below).round().clamp(0.0, 255.0) as u8;
                }
            }
        }
    }
}

impl PictureMesh<'_> {
    /// Linear colour and alpha at a point of a triangle, before light.
    fn paint(&self, corners: &[u32; 3], share: Vec3) -> Vec4 {
        let mut paint = Vec4::from(self.material.base_colour);
        let shares = || corners.iter().map(|&corner| corner as usize).zip(share.to_array());
        if self.colours.len() == self.positions.len() {
            paint *= shares().map(|(corner, share)| share * Vec4::from(self.colours[corner])).sum::<Vec4>();
        }
        if let Some(texture) = &self.material.texture
            && self.uvs.len() == self.positions.len()
        {
            let uv = shares().map(|(corner, share)| share * Vec2::from(self.uvs[corner])).sum::<Vec2>();
            paint *= look_up(texture, uv);
        }
        paint
    }
}

/// The texture's linear colour and alpha at `uv`, mixed from the four texels around it.
fn look_up(texture: &Texture, uv: Vec2) -> Vec4 {
    let image: &RgbaImage = &texture.image;
    let [u, v] = texture.transform.map(|[by_u, by_v, offset]| by_u * uv.x + by_v * uv.y + offset);
    if image.is_empty() || !u.is_finite() || !v.is_finite() {
        return Vec4::ONE;
    }
    let (x, y) = (u * image.width() as f32 - 0.5, v * image.height() as f32 - 0.5);
    let (left, top) = (x.floor(), y.floor());
    let mut mixed = Vec4::ZERO;
    for (right, down) in [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (1.0, 1.0)] {
        let column = texel(left + right, image.width(), texture.wrap[0]);
        let row = texel(top + down, image.height(), texture.wrap[1]);
        let share = (1.0 - (left + right - x).abs()) * (1.0 - (top + down - y).abs());
        let [red, green, blue, alpha] = image.get_pixel(column, row).0;
        let linear = [red, green, blue].map(|channel| TO_LINEAR[channel as usize]);
        mixed += share * Vec3::from(linear).extend(f32::from(alpha) / 255.0);
    }
    mixed
}

fn texel(position: f32, size: u32, wrap: Wrap) -> u32 {
    let count = size as f32;
    let inside = match wrap {
        Wrap::Clamp => position,
        Wrap::Repeat => position.rem_euclid(count),
        Wrap::Mirror => {
            let there = position.rem_euclid(2.0 * count);
            if there < count { there } else { 2.0 * count - 1.0 - there }
        }
    };
    (inside.max(0.0) as u32).min(size - 1)
}

/// A key light over the eye's left shoulder, light from sky and floor, and a rim from behind.
struct Light {
    key: Vec3,
    up: Vec3,
    toward: Vec3,
}

impl Light {
    fn new(camera: &Camera) -> Self {
        Self {
            key: (-0.45 * camera.right + 0.6 * camera.up + 0.75 * camera.toward).normalize(),
            up: camera.up,
            toward: camera.toward,
        }
    }

    /// The linear colour that a surface of colour `paint` shows.
    fn on(&self, paint: Vec3, normal: Vec3, unlit: bool) -> Vec3 {
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

/// sRGB bytes to linear light.
static TO_LINEAR: std::sync::LazyLock<[f32; 256]> = std::sync::LazyLock::new(|| {
    std::array::from_fn(|byte| {
        let value = byte as f32 / 255.0;
        if value <= 0.04045 { value / 12.92 } else { ((value + 0.055) / 1.055).powf(2.4) }
    })
});

/// Linear light to sRGB, 0 to 1; what is bright nears white without reaching it, so that white clothes keep their folds.
fn to_display(value: f32) -> f32 {
    const EXPOSURE: f32 = 1.06;
    const SHOULDER: f32 = 0.55;
    let above = (EXPOSURE * value - SHOULDER).max(0.0) / (1.0 - SHOULDER);
    let value = (EXPOSURE * value).clamp(0.0, SHOULDER) + (1.0 - SHOULDER) * (1.0 - (-above).exp());
    if value <= 0.0031308 { value * 12.92 } else { 1.055 * value.powf(1.0 / 2.4) - 0.055 }
}

#[cfg(test)]
mod tests {
    use super::*;

    const FRONT: [[u32; 3]; 2] = [[0, 1, 2], [0, 2, 3]];

    /// A square of side 2 that faces +Z.
    fn square(z: f32) -> [Vec3; 4] {
        [[-1.0, 0.0], [1.0, 0.0], [1.0, 2.0], [-1.0, 2.0]].map(|[x, y]| Vec3::new(x, y, z))
    }

    fn coloured(base_colour: [f32; 4]) -> Material {
        Material { base_colour, ..Material::default() }
    }

    type Part<'a> = (&'a [Vec3], &'a [[u32; 3]], &'a Material);

    fn drawn(meshes: &[Part]) -> RgbImage {
        draw(&[View {
            title: "target".to_string(),
            note: String::new(),
            meshes: meshes
                .iter()
                .map(|&(positions, triangles, material)| PictureMesh {
                    positions,
                    normals: &[],
                    triangles,
                    uvs: &[],
                    colours: &[],
                    material,
                })
                .collect(),
            up: Vec3::Y,
            forward: Vec3::Z,
        }])
    }

    /// The middle of the front view.
    fn middle(sheet: &RgbImage) -> [u8; 3] {
        let half = FIGURE_HEIGHT / 2.0;
        sheet.get_pixel((FIGURE_GAP + half) as u32, (TOP + half) as u32).0
    }

    #[test]
    fn the_nearer_mesh_hides_the_farther_one_in_any_order() {
        let (red, green) = (coloured([1.0, 0.0, 0.0, 1.0]), coloured([0.0, 1.0, 0.0, 1.0]));
        let (near, far) = (square(0.5), square(-0.5));
        let meshes: [Part; 2] = [(&near, &FRONT, &red), (&far, &FRONT, &green)];
        for sheet in [drawn(&meshes), drawn(&[meshes[1], meshes[0]])] {
            let [red, green, _] = middle(&sheet);
            assert!(red > 180 && green < 80, "{red} {green}");
        }
    }

    #[test]
    fn backs_are_left_out_unless_a_material_has_two_sides() {
        let positions = square(0.0);
        let back = FRONT.map(|[a, b, c]| [a, c, b]);
        let mut blue = coloured([0.0, 0.0, 1.0, 1.0]);
        assert!(middle(&drawn(&[(&positions, &back, &blue)]))[0] > 200);
        blue.double_sided = true;
        assert!(middle(&drawn(&[(&positions, &back, &blue)]))[0] < 80);
    }

    #[test]
    fn what_is_half_clear_shows_what_is_behind() {
        let mut glass = coloured([0.0, 0.0, 1.0, 0.3]);
        glass.alpha = Alpha::Blend;
        let red = coloured([1.0, 0.0, 0.0, 1.0]);
        let (near, far) = (square(0.5), square(-0.5));
        let [red, _, blue] = middle(&drawn(&[(&near, &FRONT, &glass), (&far, &FRONT, &red)]));
        assert!(red > 100 && blue > 100, "{red} {blue}");
    }

    #[test]
    fn figures_without_extent_or_with_too_much_still_make_a_sheet() {
        let white = Material::default();
        assert!(drawn(&[]).width() > 0);
        let point = [Vec3::ONE; 4];
        assert!(drawn(&[(&point, &FRONT, &white)]).width() > 0);
        let far = [Vec3::ZERO, 1e6 * Vec3::X, Vec3::Y, Vec3::NAN];
        let sheet = drawn(&[(&far, &FRONT, &white)]);
        assert!(sheet.width() <= LARGEST_WIDTH as u32 + 1, "{}", sheet.width());
    }

    #[test]
    fn a_texel_outside_the_image_follows_the_wrapping() {
        let wrapped = |wrap| [-1.0, 0.0, 3.0, 4.0, 5.0].map(|position| texel(position, 4, wrap));
        assert_eq!(wrapped(Wrap::Repeat), [3, 0, 3, 0, 1]);
        assert_eq!(wrapped(Wrap::Clamp), [0, 0, 3, 3, 3]);
        assert_eq!(wrapped(Wrap::Mirror), [0, 0, 3, 3, 2]);
    }
}
