//! A picture of characters side by side, front and side view, drawn without a graphics card.
//!
//! Orthographic, depth buffer, 2 by 2 samples a pixel. All figures stand on one line at one scale, but for those that
//! are drawn as tall as another; beside each stands a ruler of heads.

mod camera;
mod canvas;
mod lettering;
mod light;
mod surface;

pub use surface::PictureMesh;

use camera::Camera;
use canvas::{Canvas, Pass, SAMPLES};
use glam::Vec3;
use light::Light;
use superdeform_host::image::Sheet;
use superdeform_host::materials::Alpha;
use surface::Surface;

/// The tallest figure's height in pixels.
const FIGURE_HEIGHT: f32 = 560.0;
/// A sheet is not made wider than this; figures get smaller instead.
const LARGEST_WIDTH: f32 = 2600.0;
/// Pixels between the two views of a figure, where the ruler of heads stands.
const VIEW_GAP: f32 = 56.0;
/// Pixels between two figures, and around the sheet.
const FIGURE_GAP: f32 = 56.0;
const TOP: f32 = 40.0;
const BOTTOM: f32 = 108.0;

/// Pixels from the ruler to the side view that it measures.
const RULER_GAP: f32 = 12.0;
/// Half a tick's length in pixels.
const TICK: f32 = 5.0;

const BACKGROUND_TOP: [f32; 3] = [246.0, 247.0, 250.0];
const BACKGROUND_BOTTOM: [f32; 3] = [226.0, 230.0, 237.0];
/// A portrait's side, in heads as they are drawn.
const PORTRAIT_MARGIN: f32 = 1.2;

/// Rings around what was found of a face: their colour, and their radius in pixels.
const MARK_COLOUR: [u8; 3] = [230, 60, 60];
const MARK_RADIUS: f32 = 4.0;
/// Bones of a rig that was found: their colour, that of the doubted ones, and half the width of a bone and the radius of a
/// joint in pixels.
const BONE_COLOUR: [u8; 3] = [40, 96, 220];
const DOUBTED_COLOUR: [u8; 3] = [240, 130, 20];
const BONE_HALF_WIDTH: f32 = 1.2;
const JOINT_RADIUS: f32 = 3.2;
const TITLE_COLOUR: [u8; 3] = [58, 64, 78];
const NOTE_COLOUR: [u8; 3] = [124, 132, 148];
const RULER_COLOUR: [u8; 3] = [150, 158, 174];
const GROUND_COLOUR: [u8; 3] = [196, 202, 214];

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
    /// Heights along `up` for the ruler, model units; no ruler without them.
    pub heads: Option<Heads>,
    /// The view whose height this one is drawn at, by index; its own height where there is none.
    pub as_tall_as: Option<usize>,
    /// Points of the face that were found, ringed in the view from the front.
    pub marks: Vec<Vec3>,
    /// Bones that were found, drawn over both views.
    pub bones: Vec<Bone>,
}

/// A bone of a rig that was found, or a joint alone.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bone {
    /// From the joint above to the joint, model space.
    pub ends: [Vec3; 2],
    /// True where one of the joints is in doubt.
    pub doubted: bool,
}

/// What a ruler of heads is made from: heights along up, model units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Heads {
    /// The top of the head.
    pub crown: f32,
    /// One head below it.
    pub chin: f32,
    /// Where the ruler ends.
    pub sole: f32,
}

/// Most ticks that a ruler has; a figure with more heads gets none.
const MOST_HEADS: f32 = 20.0;

impl Heads {
    /// Heights of the ticks: the crown, each head below it, and the sole.
    fn ticks(&self) -> Vec<f32> {
        let head = self.crown - self.chin;
        let count = (self.crown - self.sole) / head;
        if !(head > 0.0 && count > 0.0 && count <= MOST_HEADS) {
            return Vec::new();
        }
        // A head that ends at the sole but for rounding ends there.
        let whole = (count - 0.02).floor() as usize;
        (0..=whole).map(|index| self.crown - index as f32 * head).chain([self.sole]).collect()
    }
}

/// Draws `views` from left to right, each from the front and from its left side, on one ground line.
pub fn draw(views: &[View]) -> Sheet {
    let mut figures: Vec<Figure> = views.iter().map(Figure::new).collect();
    for (index, view) in views.iter().enumerate() {
        if let Some(other) = view.as_tall_as {
            figures[index].scale = figures[other].height() / figures[index].height();
        }
    }
    let scale = scale(&figures);
    let tallest = figures.iter().map(|figure| figure.height() * figure.scale).fold(0.0, f32::max);
    let ground = TOP + tallest * scale;
    let width = figures.iter().map(|figure| figure.width(scale) + FIGURE_GAP).sum::<f32>() + FIGURE_GAP;
    let mut sheet = background(width.ceil() as u32, (ground + BOTTOM).ceil() as u32, ground);
    let mut left = FIGURE_GAP;
    for (view, figure) in views.iter().zip(&figures) {
        let centre = left + figure.width(scale) / 2.0;
        let pixels = scale * figure.scale;
        let start = left;
        for camera in &figure.cameras {
            let origin = [left - camera.low.x * pixels, ground + camera.low.y * pixels];
            shadow(
                &mut sheet,
                origin[0] + camera.foot_middle() * pixels,
                ground,
                camera.foot_width() * pixels,
            );
            draw_figure(&mut sheet, view, figure, camera, pixels, origin);
            draw_bones(&mut sheet, &view.bones, |p| {
                let seen = [p.dot(camera.right) - camera.low.x, p.dot(camera.up) - camera.low.y];
                [left + seen[0] * pixels, ground - seen[1] * pixels]
            });
            left += camera.width() * pixels + VIEW_GAP;
        }
        let front = &figure.cameras[0];
        for mark in &view.marks {
            let [right, up] = [mark.dot(front.right) - front.low.x, mark.dot(front.up) - front.low.y];
            ring(&mut sheet, [start + right * pixels, ground - up * pixels]);
        }
        if let Some(heads) = &view.heads {
            let [front, side] = &figure.cameras;
            let at = left - VIEW_GAP - side.width() * pixels - RULER_GAP;
            let rows: Vec<f32> =
                heads.ticks().iter().map(|height| ground - (height - front.low.y) * pixels).collect();
            ruler(&mut sheet, at, &rows);
        }
        lettering::draw(&mut sheet, &view.title, centre, ground + 52.0, 2.6, TITLE_COLOUR);
        lettering::draw(&mut sheet, &view.note, centre, ground + 82.0, 1.8, NOTE_COLOUR);
        left += FIGURE_GAP - VIEW_GAP;
    }
    sheet
}

/// Draws the head of `view` from the front, square, as large as fits into `size` pixels.
///
/// `chin`: its height along up; what is above it is the head, with hair and hat.
pub fn portrait(view: &View, chin: f32, size: u32) -> Sheet {
    let figure = Figure::new(view);
    let camera = &figure.cameras[0];
    let seen = |point: &Vec3| [point.dot(camera.right), point.dot(camera.up)];
    let of_head = view.meshes.iter().flat_map(|mesh| mesh.positions).filter(|point| point.is_finite());
    let [left, right] = of_head
        .map(seen)
        .filter(|[_, height]| *height >= chin)
        .fold([f32::INFINITY, f32::NEG_INFINITY], |[low, high], [x, _]| [low.min(x), high.max(x)]);
    let (left, right) = if left <= right { (left, right) } else { (camera.low.x, camera.high.x) };
    let tall = (camera.high.y - chin).max(1e-6);
    // Twice the head's height holds every hat; wings and raised arms are cut off.
    let side = PORTRAIT_MARGIN * (right - left).clamp(tall, 2.0 * tall);
    let pixels = size as f32 / side;
    // The whole figure is drawn, and the part around the head kept.
    let origin = [-camera.low.x * pixels, camera.high.y * pixels];
    let (width, height) = (camera.width() * pixels, figure.height() * pixels);
    let mut sheet = background(width.ceil() as u32 + 2 * size, height.ceil() as u32 + 2 * size, -FIGURE_GAP);
    let border = size as f32;
    draw_figure(&mut sheet, view, &figure, camera, pixels, [origin[0] + border, origin[1] + border]);
    let column = border + origin[0] + 0.5 * (left + right) * pixels - 0.5 * border;
    let row = border + origin[1] - 0.5 * (camera.high.y + chin) * pixels - 0.5 * border;
    sheet.part(column.max(0.0) as u32, row.max(0.0) as u32, size, size)
}

struct Figure {
    /// Front and left side.
    cameras: [Camera; 2],
    /// What its lengths are multiplied by to be drawn at the sheet's scale.
    scale: f32,
    surfaces: Vec<Surface>,
}

impl Figure {
    fn new(view: &View) -> Self {
        let up = view.up.normalize_or(Vec3::Y);
        let front = view.forward.reject_from_normalized(up).normalize_or(up.any_orthonormal_vector());
        let side = up.cross(front);
        Self {
            cameras: [Camera::new(view, up, front), Camera::new(view, up, side)],
            scale: 1.0,
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
        self.cameras.iter().map(|camera| camera.width() * scale * self.scale).sum::<f32>() + VIEW_GAP
    }
}

/// Pixels for the first figure's unit of length.
fn scale(figures: &[Figure]) -> f32 {
    let tallest =
        figures.iter().map(|figure| figure.height() * figure.scale).fold(f32::MIN_POSITIVE, f32::max);
    let by_height = FIGURE_HEIGHT / tallest;
    let drawn: f32 = figures.iter().map(|figure| figure.width(by_height) - VIEW_GAP).sum();
    let gaps = FIGURE_GAP + figures.len() as f32 * (FIGURE_GAP + VIEW_GAP);
    by_height * ((LARGEST_WIDTH - gaps) / drawn.max(1.0)).clamp(0.0, 1.0)
}

/// A small ring around a point of the sheet.
fn ring(sheet: &mut Sheet, at: [f32; 2]) {
    ink(sheet, [at, at], MARK_RADIUS + 1.0, MARK_COLOUR, |away| 1.0 - (away - MARK_RADIUS).abs());
}

/// Bones with a dot at their joints; `place` gives where a point is on the sheet. Doubted ones lie over the others.
fn draw_bones(sheet: &mut Sheet, bones: &[Bone], place: impl Fn(Vec3) -> [f32; 2]) {
    for doubted in [false, true] {
        let colour = if doubted { DOUBTED_COLOUR } else { BONE_COLOUR };
        for bone in bones.iter().filter(|bone| bone.doubted == doubted) {
            let [from, to] = bone.ends.map(&place);
            if from.iter().chain(&to).all(|value| value.is_finite()) {
                ink(sheet, [from, to], BONE_HALF_WIDTH + 0.5, colour, |away| BONE_HALF_WIDTH + 0.5 - away);
                ink(sheet, [to, to], JOINT_RADIUS + 0.5, colour, |away| JOINT_RADIUS + 0.5 - away);
            }
        }
    }
}

/// Inks what lies within `reach` pixels of a line on the sheet, as much as `share` says of how far away it is, 0..1.
fn ink(
    sheet: &mut Sheet,
    [from, to]: [[f32; 2]; 2],
    reach: f32,
    colour: [u8; 3],
    share: impl Fn(f32) -> f32,
) {
    let pixels = |a: f32, b: f32, end: u32| {
        (a.min(b) - reach).max(0.0) as u32..((a.max(b) + reach + 1.0).max(0.0) as u32).min(end)
    };
    let along = [to[0] - from[0], to[1] - from[1]];
    let length = (along[0] * along[0] + along[1] * along[1]).max(f32::MIN_POSITIVE);
    for row in pixels(from[1], to[1], sheet.height()) {
        for column in pixels(from[0], to[0], sheet.width()) {
            let off = [column as f32 + 0.5 - from[0], row as f32 + 0.5 - from[1]];
            let way = ((off[0] * along[0] + off[1] * along[1]) / length).clamp(0.0, 1.0);
            let away = (off[0] - way * along[0]).hypot(off[1] - way * along[1]);
            let share = share(away).clamp(0.0, 1.0);
            let under = sheet.at_mut(column, row);
            for (channel, value) in under.iter_mut().enumerate() {
                *value = (f32::from(*value) * (1.0 - share) + f32::from(colour[channel]) * share) as u8;
            }
        }
    }
}

fn background(width: u32, height: u32, ground: f32) -> Sheet {
    let mut sheet = Sheet::of(width, height, |_, y| {
        let share = y as f32 / height as f32;
        [0, 1, 2].map(|channel| {
            let (from, to) = (BACKGROUND_TOP[channel], BACKGROUND_BOTTOM[channel]);
            (from + (to - from) * share).round() as u8
        })
    });
    let margin = FIGURE_GAP / 2.0;
    fill(&mut sheet, [margin, width as f32 - margin], [ground, ground + 2.0], GROUND_COLOUR);
    sheet
}

/// Fills a rectangle, from and to along each side in pixels; what is outside the sheet is left out.
fn fill(sheet: &mut Sheet, columns: [f32; 2], rows: [f32; 2], colour: [u8; 3]) {
    let range = |[from, to]: [f32; 2], size: u32| {
        (from.round().max(0.0) as u32)..(to.round().max(0.0) as u32).min(size)
    };
    for y in range(rows, sheet.height()) {
        for x in range(columns, sheet.width()) {
            *sheet.at_mut(x, y) = colour;
        }
    }
}

/// A line down from the first of `rows` to the last with a tick at each, and the number of every whole head.
fn ruler(sheet: &mut Sheet, column: f32, rows: &[f32]) {
    let [first, .., last] = rows else { return };
    fill(sheet, [column, column + 1.0], [*first, *last], RULER_COLOUR);
    for (index, &row) in rows.iter().enumerate() {
        fill(sheet, [column - TICK, column + TICK + 1.0], [row, row + 1.0], RULER_COLOUR);
        if (1..rows.len() - 1).contains(&index) {
            let number = index.to_string();
            lettering::draw(sheet, &number, column - TICK - 12.0, row + 5.0, 1.6, NOTE_COLOUR);
        }
    }
}

/// A soft patch under the feet.
fn shadow(sheet: &mut Sheet, centre: f32, ground: f32, foot_width: f32) {
    let (half_width, half_height) = (0.62 * foot_width + 14.0, 9.0);
    for y in (ground - half_height).max(0.0) as u32..((ground + half_height) as u32).min(sheet.height()) {
        let last = ((centre + half_width).max(0.0) as u32).min(sheet.width());
        for x in (centre - half_width).max(0.0) as u32..last {
            let across = (x as f32 - centre) / half_width;
            let down = (y as f32 - ground) / half_height;
            let depth = (1.0 - across * across - down * down).max(0.0);
            let keep = 1.0 - 0.32 * depth * depth;
            let under = sheet.at_mut(x, y);
            *under = under.map(|channel| (f32::from(channel) * keep) as u8);
        }
    }
}

fn draw_figure(
    sheet: &mut Sheet,
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
    let mut canvas = Canvas::new(width, height);
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

#[cfg(test)]
mod tests {
    use super::*;
    use superdeform_host::materials::Material;

    const FRONT: [[u32; 3]; 2] = [[0, 1, 2], [0, 2, 3]];

    /// A square of side 2 that faces +Z.
    fn square(z: f32) -> [Vec3; 4] {
        [[-1.0, 0.0], [1.0, 0.0], [1.0, 2.0], [-1.0, 2.0]].map(|[x, y]| Vec3::new(x, y, z))
    }

    fn coloured(base_colour: [f32; 4]) -> Material {
        Material { base_colour, ..Material::default() }
    }

    type Part<'a> = (&'a [Vec3], &'a [[u32; 3]], &'a Material);

    fn view<'a>(meshes: &[Part<'a>]) -> View<'a> {
        View {
            title: "target".to_string(),
            marks: Vec::new(),
            bones: Vec::new(),
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
            heads: None,
            as_tall_as: None,
        }
    }

    fn drawn(meshes: &[Part]) -> Sheet {
        draw(&[view(meshes)])
    }

    /// The middle of the front view.
    fn middle(sheet: &Sheet) -> [u8; 3] {
        let half = FIGURE_HEIGHT / 2.0;
        sheet.at((FIGURE_GAP + half) as u32, (TOP + half) as u32)
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
    fn bones_are_drawn_in_both_views_and_doubted_ones_in_another_colour() {
        let white = coloured([1.0; 4]);
        let (near, up) = (square(0.0), [Vec3::new(0.0, 0.5, 0.0), Vec3::new(0.0, 1.5, 0.0)]);
        let count = |bones: Vec<Bone>, colour: [u8; 3]| {
            let sheet = draw(&[View { bones, ..view(&[(&near, &FRONT, &white)]) }]);
            let columns: Vec<u32> = (0..sheet.width())
                .filter(|&x| (0..sheet.height()).filter(|&y| sheet.at(x, y) == colour).count() > 50)
                .collect();
            // Neighbouring columns are one line.
            columns.iter().enumerate().filter(|&(i, x)| i == 0 || columns[i - 1] + 1 != *x).count()
        };
        let bone = |doubted| vec![Bone { ends: up, doubted }];
        assert_eq!([count(bone(false), BONE_COLOUR), count(bone(false), DOUBTED_COLOUR)], [2, 0]);
        assert_eq!([count(bone(true), BONE_COLOUR), count(bone(true), DOUBTED_COLOUR)], [0, 2]);
        assert_eq!(count(Vec::new(), BONE_COLOUR), 0);
        let nowhere = vec![Bone { ends: [Vec3::NAN; 2], doubted: false }];
        assert_eq!(count(nowhere, BONE_COLOUR), 0);
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
    fn a_figure_can_be_drawn_as_tall_as_another() {
        let white = Material::default();
        let (small, large) = (square(0.0), square(0.0).map(|point| 10.0 * point));
        let figure = |positions, as_tall_as| View { as_tall_as, ..view(&[(positions, &FRONT, &white)]) };
        // 560 pixels are the height of the tallest: 2 as it is, and 2 after it has been made a tenth of its size.
        let alone = draw(&[figure(&small, None)]);
        let both = draw(&[figure(&small, None), figure(&large, Some(0))]);
        assert_eq!(both.height(), alone.height());
        assert_eq!(both.width(), 2 * alone.width() - FIGURE_GAP as u32);
    }

    #[test]
    fn a_ruler_has_a_tick_for_each_head_and_one_for_the_sole() {
        let heads = |crown, chin, sole| Heads { crown, chin, sole }.ticks();
        assert_eq!(heads(5.0, 4.0, 2.5), [5.0, 4.0, 3.0, 2.5]);
        // Three heads and a hundredth: a tick more would lie on the one before.
        assert_eq!(heads(3.0, 2.0, -0.01), [3.0, 2.0, 1.0, -0.01]);
        for strange in
            [[1.0, 1.0, 0.0], [1.0, 2.0, 0.0], [1.0, 0.99, 0.0], [f32::NAN, 0.5, 0.0], [1.0, 0.5, 2.0]]
        {
            assert!(heads(strange[0], strange[1], strange[2]).is_empty(), "{strange:?}");
        }
    }
}
