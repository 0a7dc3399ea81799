//! What is painted on a face follows its shape: shade that is painted into the sockets of an adult's eyes grows with the eyes,
//! and rings them. So it is evened to the colour of the cheeks, by the ratio of the cheeks' colour to the blurred one there:
//! lashes, brows and the edges of lids are finer than the blur and keep their contrast.
//!
//! The library says where ([`Deformer::painted`](superdeform::Deformer::painted)): a weight a vertex, carried to the texels of
//! the base colour's image. Texels that other triangles show stay.

use crate::appearance::Appearance;
use crate::image::{Image, TO_LINEAR, to_srgb};
use crate::load::Loaded;
use crate::materials::Texture;
use serde::Serialize;
use std::collections::{BTreeMap, BTreeSet};

/// How much of the shade goes where nobody says: 0 on faces that are drawn.
pub const EVEN_EYES: f64 = 0.8;

/// The blur's standard deviation, as a share of a socket's size (the root of its area).
const BLUR: f64 = 0.1;
/// Shade becomes at most so many times lighter, and glare darker by at most this factor.
const RATIOS: (f32, f32) = (0.8, 4.0);
/// Of a face that is drawn more than this part is as what is beside it: photos have .2 to .4, flat paint and airbrush .9 to 1.
const DRAWN: f64 = 0.6;
/// Skin that has fewer texels than this shows no shade that could be evened: a palette's.
const FEWEST: usize = 32;
/// Texels around the edge of a piece of the image that are made alike: viewers mix them in.
const GUTTER: usize = 3;

/// What was done about shade that is painted around eyes.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct EvenEyes {
    /// How much of it was taken away, 0 to 1.
    pub share: f64,
    /// How many texels changed.
    pub texels: usize,
    /// What the image around the eyes was taken for: `photo` or `drawn`; absent where there is none.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub taken_for: Option<&'static str>,
    /// Why no texel changed, a sentence.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub because: Option<&'static str>,
}

/// Images that became others, by number.
pub type Images = BTreeMap<usize, Image>;

/// The images of `target` with what is painted around its eyes evened, as far as they change.
///
/// - `weights`: as [`Deformer::painted`](superdeform::Deformer::painted) gives them.
/// - `share`: how much of it goes, 0 to 1; where it is not said, [`EVEN_EYES`] of a photo and nothing of a drawing.
pub fn even_eyes(
    target: &Loaded,
    appearance: &Appearance,
    weights: &[Vec<[f32; 2]>],
    share: Option<f64>,
) -> (Images, EvenEyes) {
    let mut images = Images::new();
    let mut told = EvenEyes::default();
    let nothing = |because| (Images::new(), EvenEyes { because: Some(because), ..EvenEyes::default() });
    if share == Some(0.0) {
        return nothing("it is not asked for");
    }
    let is_painted = |weights: &Vec<[f32; 2]>| weights.iter().any(|weight| weight[0] > 0.0);
    if !weights.iter().any(is_painted) {
        return nothing("no eyes grow");
    }
    told.because = Some("the skin around the eyes has no texture");
    let texture = |mesh: usize| {
        let surface = &appearance.surfaces[mesh];
        let texture = appearance.materials.get(surface.material?)?.texture.as_ref()?;
        (surface.uvs.len() == target.character.meshes[mesh].positions.len()).then_some(texture)
    };
    let painted = (0..weights.len()).filter(|&mesh| is_painted(&weights[mesh]));
    let sources: BTreeSet<usize> = painted.filter_map(|mesh| Some(texture(mesh)?.source)).collect();
    for source in sources {
        let shown = (0..weights.len()).filter_map(|mesh| {
            let texture = texture(mesh).filter(|texture| texture.source == source)?;
            Some((mesh, texture))
        });
        let shown: Vec<(usize, &Texture)> = shown.collect();
        if shown.iter().any(|(_, texture)| texture.has_other_format) {
            told.because = Some("the texture has its image in another format, too, which viewers show");
            continue;
        }
        let Some(image) = target.file.image(source).and_then(|bytes| Image::decode(&bytes)) else { continue };
        let mut canvas = Canvas::of(image);
        for (mesh, texture) in shown {
            let uvs = &appearance.surfaces[mesh].uvs;
            for corners in &target.character.meshes[mesh].triangles {
                let corners = corners.map(|corner| corner as usize);
                canvas.lay(
                    corners.map(|corner| uvs[corner]),
                    corners.map(|corner| weights[mesh][corner]),
                    texture,
                );
            }
        }
        let skin = match canvas.skin() {
            Ok(skin) => skin,
            Err(because) => {
                told.because = told.because.and(Some(because));
                continue;
            }
        };
        let is_drawn = canvas.is_drawn();
        told.taken_for = Some(if is_drawn { "drawn" } else { "photo" });
        let share = share.unwrap_or(if is_drawn { 0.0 } else { EVEN_EYES });
        if share == 0.0 {
            told.because = told.because.and(Some("the face is drawn: ask for it to have it evened"));
            continue;
        }
        let texels = canvas.even(skin, share as f32);
        (told.share, told.texels, told.because) = (share, told.texels + texels, None);
        images.insert(source, canvas.image);
    }
    (images, told)
}

/// Linear red, green and blue.
type Colour = [f32; 3];

/// What shows a texel.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum Shown {
    /// Nothing.
    #[default]
    Not,
    /// The face around the eyes, and nothing else.
    Face,
    /// Nothing, but it lies beside what is of the face.
    Gutter,
    /// Something else, so that it stays.
    Elsewhere,
}

/// An image with what is shown of it.
struct Canvas {
    image: Image,
    /// For each texel.
    shown: Vec<Shown>,
    /// How much shade there is and how much skin, 0 to 255.
    weights: Vec<[u8; 2]>,
    /// Texels that the sockets take.
    socket_area: f64,
}

impl Canvas {
    fn of(image: Image) -> Self {
        let count = image.pixels.len();
        Self { image, shown: vec![Shown::Not; count], weights: vec![[0; 2]; count], socket_area: 0.0 }
    }

    /// Lays a triangle on the image.
    fn lay(&mut self, uvs: [[f32; 2]; 3], weights: [[f32; 2]; 3], texture: &Texture) {
        let size = [self.image.width as f64, self.image.height() as f64];
        let place = |uv: [f32; 2]| {
            let [x, y] = texture.place(uv).map(f64::from);
            [x * size[0], y * size[1]]
        };
        let [a, b, c] = uvs.map(place);
        let is_face = weights.iter().flatten().any(|&weight| weight > 0.0);
        let (mut first, mut last) = ([0i64; 2], [0i64; 2]);
        for axis in 0..2 {
            let (low, high) = (a[axis].min(b[axis]).min(c[axis]), a[axis].max(b[axis]).max(c[axis]));
            // What is laid over the whole image several times shows all of it.
            if !(high - low < 2.0 * size[axis] && low.abs() < 1e9) {
                if !is_face {
                    self.shown.fill(Shown::Elsewhere);
                }
                return;
            }
            // Texels whose middles are inside.
            (first[axis], last[axis]) = ((low - 0.5).ceil() as i64, (high - 0.5).floor() as i64);
        }
        let doubled = (b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1]);
        if doubled == 0.0 {
            return;
        }
        if is_face {
            let mean = weights.iter().map(|weight| f64::from(weight[0])).sum::<f64>() / 3.0;
            self.socket_area += mean * 0.5 * doubled.abs();
        }
        for y in first[1]..=last[1] {
            let row = texture.wrap[1].texel(y, self.image.height());
            for x in first[0]..=last[0] {
                let (px, py) = (x as f64 + 0.5, y as f64 + 0.5);
                let of_b = ((px - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (py - a[1])) / doubled;
                let of_c = ((b[0] - a[0]) * (py - a[1]) - (px - a[0]) * (b[1] - a[1])) / doubled;
                if of_b < 0.0 || of_c < 0.0 || of_b + of_c > 1.0 {
                    continue;
                }
                let texel = row * self.image.width + texture.wrap[0].texel(x, self.image.width);
                if !is_face {
                    self.shown[texel] = Shown::Elsewhere;
                } else if self.shown[texel] != Shown::Elsewhere {
                    self.shown[texel] = Shown::Face;
                    let shares = [1.0 - of_b - of_c, of_b, of_c];
                    for kind in 0..2 {
                        let weight: f64 = shares
                            .iter()
                            .zip(weights)
                            .map(|(share, weight)| share * f64::from(weight[kind]))
                            .sum();
                        let weight = (255.0 * weight.clamp(0.0, 1.0)).round() as u8;
                        self.weights[texel][kind] = self.weights[texel][kind].max(weight);
                    }
                }
            }
        }
    }

    /// The texels beside a texel.
    fn beside(&self, texel: usize) -> impl Iterator<Item = usize> + use<> {
        let (width, height) = (self.image.width, self.image.height());
        let (column, row) = (texel % width, texel / width);
        let left = (column > 0).then(|| texel - 1);
        let right = (column + 1 < width).then_some(texel + 1);
        let above = (row > 0).then(|| texel - width);
        let below = (row + 1 < height).then_some(texel + width);
        [left, right, above, below].into_iter().flatten()
    }

    /// The colour of the skin below the eyes; what is not in one piece with such skin (lashes, brows, the inside of the mouth) is
    /// left out.
    fn skin(&mut self) -> Result<Colour, &'static str> {
        let count = self.shown.len();
        let is_face =
            |texel: usize| self.shown[texel] == Shown::Face && self.image.pixels[texel][3] == u8::MAX;
        let mut reached = vec![false; count];
        let mut skin: Vec<[u8; 4]> = Vec::new();
        let mut left_out: Vec<usize> = Vec::new();
        for start in 0..count {
            if reached[start] || self.shown[start] != Shown::Face {
                continue;
            }
            let mut piece = vec![start];
            reached[start] = true;
            let mut at = 0;
            while at < piece.len() {
                for next in self.beside(piece[at]) {
                    if is_face(next) && !reached[next] {
                        reached[next] = true;
                        piece.push(next);
                    }
                }
                at += 1;
            }
            let weights = &self.weights;
            let most = |kind: usize| piece.iter().filter(move |&&texel| weights[texel][kind] > 127);
            if most(0).count() < FEWEST || most(1).count() < FEWEST {
                left_out.extend(piece);
            } else {
                skin.extend(most(1).map(|&texel| self.image.pixels[texel]));
            }
        }
        for texel in left_out {
            self.shown[texel] = Shown::Elsewhere;
        }
        if skin.is_empty() {
            return Err(
                "too few texels of the image are of the skin around the eyes, or other places show them, too",
            );
        }
        Ok([0, 1, 2].map(|channel| {
            let mut values: Vec<u8> = skin.iter().map(|pixel| pixel[channel]).collect();
            let middle = values.len() / 2;
            TO_LINEAR[usize::from(*values.select_nth_unstable(middle).1)]
        }))
    }

    /// How far what is finer than the shade reaches, in texels.
    fn deviation(&self) -> f64 {
        BLUR * (0.5 * self.socket_area).sqrt()
    }

    /// True where most of the face is as what is beside it, half of the blur away: photos have grain, at any size.
    fn is_drawn(&self) -> bool {
        let apart = ((0.5 * self.deviation()).round() as usize).max(1);
        let (mut same, mut all) = (0usize, 0usize);
        for texel in apart..self.shown.len() {
            if self.shown[texel] == Shown::Face && self.shown[texel - apart] == Shown::Face {
                let [pixel, beside] = [texel, texel - apart].map(|texel| self.image.pixels[texel]);
                all += 1;
                same += usize::from(pixel.iter().zip(beside).all(|(a, b)| a.abs_diff(b) <= 1));
            }
        }
        same as f64 > DRAWN * all as f64
    }

    /// Takes the share of what is not as `skin` away; gives how many texels changed.
    fn even(&mut self, skin: Colour, share: f32) -> usize {
        for _ in 0..GUTTER {
            self.widen();
        }
        let blurred = self.blurred();
        let mut changed = 0;
        for texel in 0..self.shown.len() {
            let weight = f32::from(self.weights[texel][0]) / 255.0;
            if weight == 0.0 || !matches!(self.shown[texel], Shown::Face | Shown::Gutter) {
                continue;
            }
            let (column, row) = (texel % self.image.width, texel / self.image.width);
            let Some(around) = blurred.at(column, row) else { continue };
            let pixel = &mut self.image.pixels[texel];
            let before = *pixel;
            for channel in 0..3 {
                let ratio = (skin[channel] / around[channel].max(1e-4)).clamp(RATIOS.0, RATIOS.1);
                pixel[channel] = shown(TO_LINEAR[usize::from(pixel[channel])] * ratio.powf(share * weight));
            }
            changed += usize::from(*pixel != before);
        }
        changed
    }

    /// Texels beside the face that nothing shows get the weights of those that it has.
    fn widen(&mut self) {
        let of_face = |shown: Shown| matches!(shown, Shown::Face | Shown::Gutter);
        let mut widened = Vec::new();
        for texel in 0..self.shown.len() {
            if self.shown[texel] == Shown::Not {
                let beside = self.beside(texel).filter(|&texel| of_face(self.shown[texel]));
                widened.extend(beside.map(|texel| self.weights[texel]).max().map(|weights| (texel, weights)));
            }
        }
        for (texel, weights) in widened {
            (self.shown[texel], self.weights[texel]) = (Shown::Gutter, weights);
        }
    }

    /// The face without what is finer than its shade.
    fn blurred(&self) -> Blurred {
        let mut blurred = Blurred::new(&self.image, self.deviation());
        for texel in (0..self.shown.len()).filter(|&texel| self.shown[texel] == Shown::Face) {
            let [red, green, blue, _] =
                self.image.pixels[texel].map(|channel| TO_LINEAR[usize::from(channel)]);
            blurred.add(texel % self.image.width, texel / self.image.width, [red, green, blue]);
        }
        blurred.smoothed()
    }
}

/// Sums of colours, and how many, by cells of texels.
struct Blurred {
    /// Texels along a cell.
    cell: usize,
    /// Cells in a row.
    columns: usize,
    cells: Vec<[f32; 4]>,
    /// Of the blur, in cells.
    deviation: f64,
}

impl Blurred {
    fn new(image: &Image, deviation: f64) -> Self {
        let cell = ((0.5 * deviation) as usize).max(1);
        let (columns, rows) = (image.width.div_ceil(cell), image.height().div_ceil(cell));
        Self { cell, columns, cells: vec![[0.0; 4]; columns * rows], deviation: deviation / cell as f64 }
    }

    fn add(&mut self, column: usize, row: usize, [red, green, blue]: Colour) {
        let sum = &mut self.cells[row / self.cell * self.columns + column / self.cell];
        for (sum, value) in sum.iter_mut().zip([red, green, blue, 1.0]) {
            *sum += value;
        }
    }

    /// With a Gaussian along both axes.
    fn smoothed(mut self) -> Self {
        let reach = (3.0 * self.deviation).ceil() as usize;
        let of = |off: usize| (-0.5 * (off as f64 / self.deviation.max(1e-3)).powi(2)).exp() as f32;
        let kernel: Vec<f32> = (0..=reach).map(of).collect();
        let rows = self.cells.len() / self.columns;
        for (count, step, lines, apart) in
            [(self.columns, 1, rows, self.columns), (rows, self.columns, self.columns, 1)]
        {
            for line in 0..lines {
                let own: Vec<[f32; 4]> =
                    (0..count).map(|index| self.cells[line * apart + index * step]).collect();
                if own.iter().all(|sum| sum[3] == 0.0) {
                    continue;
                }
                for index in 0..count {
                    let mut sum = [0.0; 4];
                    for other in index.saturating_sub(reach)..(index + reach + 1).min(count) {
                        for (sum, value) in sum.iter_mut().zip(own[other]) {
                            *sum += kernel[other.abs_diff(index)] * value;
                        }
                    }
                    self.cells[line * apart + index * step] = sum;
                }
            }
        }
        self
    }

    /// The mean colour around a texel, between the four nearest cells.
    fn at(&self, column: usize, row: usize) -> Option<Colour> {
        let rows = self.cells.len() / self.columns;
        let along = |texel: usize, count: usize| {
            let place = ((texel as f32 + 0.5) / self.cell as f32 - 0.5).clamp(0.0, count as f32 - 1.0);
            let first = place as usize;
            (first, (first + 1).min(count - 1), place - first as f32)
        };
        let ((left, right, x), (upper, lower, y)) = (along(column, self.columns), along(row, rows));
        let mut sum = [0.0; 4];
        for (row, of_row) in [(upper, 1.0 - y), (lower, y)] {
            for (column, of_column) in [(left, 1.0 - x), (right, x)] {
                for (sum, value) in sum.iter_mut().zip(self.cells[row * self.columns + column]) {
                    *sum += of_row * of_column * value;
                }
            }
        }
        let [red, green, blue, count] = sum;
        (count > 1e-6).then(|| [red / count, green / count, blue / count])
    }
}

/// Linear light as a byte of sRGB.
fn shown(value: f32) -> u8 {
    (255.0 * to_srgb(value).clamp(0.0, 1.0)).round() as u8
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::materials::Wrap;
    use std::sync::Arc;

    const SIZE: usize = 256;
    const SKIN: [f64; 3] = [205.0, 165.0, 140.0];
    /// The ring's middle, radius and width, in texels.
    const RING: ([f64; 2], f64, f64) = ([128.0, 110.0], 30.0, 8.0);
    /// The ring leaves this part of the light.
    const DARK: f64 = 0.5;
    /// A line across the ring, a texel wide, has this part of the light around it.
    const LINE: f64 = 0.4;
    const LINE_ROW: usize = 82;

    fn texture(transform: [[f32; 3]; 2]) -> Texture {
        Texture {
            image: Arc::default(),
            source: 0,
            has_other_format: false,
            grey: Arc::default(),
            wrap: [Wrap::Repeat; 2],
            transform,
        }
    }

    const PLAIN: [[f32; 3]; 2] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];

    fn from_middle(x: f64, y: f64) -> f64 {
        (x - RING.0[0]).hypot(y - RING.0[1])
    }

    /// Skin with grain, where there is some, with a dark ring and a line in it.
    fn face(grain: i32) -> Image {
        let pixel = |column: usize, row: usize| {
            let off = (from_middle(column as f64 + 0.5, row as f64 + 0.5) - RING.1) / RING.2;
            let line = row == LINE_ROW && (96..160).contains(&column);
            let light = (1.0 - (1.0 - DARK) * (-0.5 * off * off).exp()) * if line { LINE } else { 1.0 };
            let noise = ((column * 7919 + row * 104_729) % 13) as i32 - 6;
            let of = |value: f64| {
                let value = i32::from(shown((f64::from(TO_LINEAR[value as usize]) * light) as f32));
                (value + noise * grain / 6).clamp(0, 255) as u8
            };
            [of(SKIN[0]), of(SKIN[1]), of(SKIN[2]), 255]
        };
        let texels = (0..SIZE).flat_map(|row| (0..SIZE).map(move |column| (column, row)));
        Image { width: SIZE, pixels: texels.map(|(column, row)| pixel(column, row)).collect() }
    }

    /// All shade within 50 texels of the ring's middle, none beyond 70; skin below.
    fn weights([u, v]: [f32; 2]) -> [f32; 2] {
        let (x, y) = (f64::from(u) * SIZE as f64, f64::from(v) * SIZE as f64);
        let socket = ((70.0 - from_middle(x, y)) / 20.0).clamp(0.0, 1.0) as f32;
        [socket, f32::from(u8::from(y > 185.0 && y < 215.0 && (x - 128.0).abs() < 60.0))]
    }

    /// The image with the triangles of a face over 16 to 240 of 256 texels, eight texels a side.
    fn laid(image: Image, texture: &Texture, place: impl Fn([f32; 2]) -> [f32; 2]) -> Canvas {
        let mut canvas = Canvas::of(image);
        let cell = 8.0 / SIZE as f32;
        for (row, column) in (2..30).flat_map(|row| (2..30).map(move |column| (row, column))) {
            let corner = |x: i32, y: i32| [(column + x) as f32 * cell, (row + y) as f32 * cell];
            for corners in
                [[corner(0, 0), corner(1, 0), corner(1, 1)], [corner(0, 0), corner(1, 1), corner(0, 1)]]
            {
                canvas.lay(corners.map(&place), corners.map(weights), texture);
            }
        }
        canvas
    }

    fn light(image: &Image, x: f64, y: f64) -> f64 {
        f64::from(TO_LINEAR[usize::from(image.at(x as usize, y as usize)[1])])
    }

    /// ln of how much darker the ring is than skin, the mean around it.
    fn darkness(image: &Image) -> f64 {
        let skin = f64::from(TO_LINEAR[SKIN[1] as usize]);
        let around = (0..64).map(|index| f64::from(index) * std::f64::consts::TAU / 64.0);
        let logs = around.map(|turn: f64| {
            let (x, y) = (RING.0[0] + RING.1 * turn.cos(), RING.0[1] + RING.1 * turn.sin());
            (skin / light(image, x, y)).ln()
        });
        logs.sum::<f64>() / 64.0
    }

    #[test]
    fn a_painted_ring_loses_most_of_itself_and_lines_stay() {
        let before = face(6);
        let mut canvas = laid(before.clone(), &texture(PLAIN), |uv| uv);
        let skin = canvas.skin().unwrap();
        assert!(!canvas.is_drawn());
        assert!(canvas.even(skin, 0.8) > 5000);
        let after = &canvas.image;
        // A blur as broad as the ring sees w / sqrt(w^2 + s^2) of it, and .8 of that goes; s is a tenth of the root of pi 60^2 / 2.
        let deviation = BLUR * (0.5 * std::f64::consts::PI * 60.0 * 60.0).sqrt();
        let left = 1.0 - 0.8 * RING.2 / RING.2.hypot(deviation);
        let (was, is) = (darkness(&before), darkness(after));
        assert!((was / -DARK.ln() - 1.0).abs() < 0.1, "{was}");
        assert!(is < (left + 0.1) * was && is > 0.1 * was, "{is} of {was}, {left} expected");
        // The line is as much darker than what is beside it as before.
        let contrast = |image: &Image| {
            let mean = |row: usize| (100..156).map(|x| light(image, f64::from(x), row as f64)).sum::<f64>();
            mean(LINE_ROW) / (0.5 * (mean(LINE_ROW - 2) + mean(LINE_ROW + 2)))
        };
        assert!(
            (contrast(after) / contrast(&before) - 1.0).abs() < 0.1,
            "{} {}",
            contrast(&before),
            contrast(after)
        );
        // Nothing changes where the triangles have no weight.
        for (index, (pixel, old)) in after.pixels.iter().zip(&before.pixels).enumerate() {
            let away = from_middle((index % SIZE) as f64 + 0.5, (index / SIZE) as f64 + 0.5);
            assert!(pixel == old || away < 70.0 + 8.0, "{index}");
        }
    }

    #[test]
    fn texels_that_something_else_shows_stay() {
        let before = face(6);
        let mut canvas = laid(before.clone(), &texture(PLAIN), |uv| uv);
        let eye =
            [[100.0f32, 80.0], [156.0, 80.0], [128.0, 130.0]].map(|corner| corner.map(|x| x / SIZE as f32));
        canvas.lay(eye, [[0.0; 2]; 3], &texture(PLAIN));
        let skin = canvas.skin().unwrap();
        assert!(canvas.even(skin, 0.8) > 3000);
        for y in 81..125 {
            // Well inside of the triangle.
            let half = (130.0 - y as f64) * 28.0 / 50.0 - 1.0;
            for x in (128.0 - half) as usize..(128.0 + half) as usize {
                assert_eq!(canvas.image.at(x, y), before.at(x, y), "{x} {y}");
            }
        }
        // What is laid over the whole image more than once shows all of it.
        let mut canvas = laid(before, &texture(PLAIN), |uv| uv);
        canvas.lay([[0.0, 0.0], [9.0, 0.0], [0.0, 9.0]], [[0.0; 2]; 3], &texture(PLAIN));
        assert!(canvas.skin().is_err());
    }

    #[test]
    fn moved_mirrored_and_repeated_images_are_evened_alike() {
        let even = |canvas: &mut Canvas| {
            let skin = canvas.skin().unwrap();
            canvas.even(skin, 0.8);
            canvas.image.clone()
        };
        let plain = even(&mut laid(face(6), &texture(PLAIN), |uv| uv));
        // A texture's own transform, undone by the coordinates; whole images further.
        let half = texture([[0.5, 0.0, 0.25], [0.0, 0.5, 0.0]]);
        let moved = even(&mut laid(face(6), &half, |[u, v]| [2.0 * u - 0.5, 2.0 * v]));
        let repeated = even(&mut laid(face(6), &texture(PLAIN), |[u, v]| [u - 3.0, v + 2.0]));
        let differ = |image: &Image| image.pixels.iter().zip(&plain.pixels).filter(|(a, b)| a != b).count();
        // Rounding decides which triangle a texel between two is of.
        assert!(differ(&moved) < 200, "{}", differ(&moved));
        assert!(differ(&repeated) < 200, "{}", differ(&repeated));
        // Both halves of a face on one: laid twice, once mirrored about the ring's middle.
        let mut twice = laid(face(6), &texture(PLAIN), |uv| uv);
        let cell = 8.0 / SIZE as f32;
        for column in 2..30 {
            let corner = |x: i32, y: i32| [(column + x) as f32 * cell, (10 + y) as f32 * cell];
            let corners = [corner(0, 0), corner(1, 0), corner(1, 1)];
            twice.lay(
                [corners[0], corners[2], corners[1]],
                [corners[0], corners[2], corners[1]].map(weights),
                &texture(PLAIN),
            );
        }
        assert!(differ(&even(&mut twice)) < 3000);
    }

    #[test]
    fn a_palette_or_a_flat_face_is_drawn() {
        assert!(laid(face(0), &texture(PLAIN), |uv| uv).is_drawn());
        // All of a face on one texel.
        let spot = texture([[0.001, 0.0, 0.5], [0.0, 0.001, 0.5]]);
        assert!(laid(face(6), &spot, |uv| uv).skin().is_err());
    }
}
