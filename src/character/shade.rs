//! How bright a mesh's surface is, where a host knows: by it the face step sees irises and brows that are painted.

use glam::Vec2;
use std::sync::Arc;

/// How bright a mesh is, from black (0) to white (255) as screens show it.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum Shade {
    /// Nobody knows.
    #[default]
    Unknown,
    /// One value a vertex.
    Vertices(Vec<u8>),
    /// An image, and where each vertex lies on it.
    Image {
        /// One a vertex; (0, 0) is the image's first pixel, (1, 1) its last; it repeats beyond.
        uvs: Vec<Vec2>,
        /// What is seen there.
        image: Arc<GreyImage>,
    },
}

/// Images are kept no larger than this: where a face has a quarter of an image for itself an iris is still some ten pixels
/// wide.
pub const LONGEST_SIDE: usize = 512;

/// A small picture without colours, at most [`LONGEST_SIDE`] pixels a side.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct GreyImage {
    /// Pixels in a row; above 0.
    pub width: usize,
    /// Rows; above 0.
    pub height: usize,
    /// `width` * `height` values, the row of v = 0 first.
    pub pixels: Vec<u8>,
}

impl Shade {
    /// True where it says something for each of `vertex_count` vertices.
    pub fn fits(&self, vertex_count: usize) -> bool {
        match self {
            Shade::Unknown => true,
            Shade::Vertices(values) => values.len() == vertex_count,
            Shade::Image { uvs, image } => {
                uvs.len() == vertex_count
                    && !image.pixels.is_empty()
                    && image.pixels.len() == image.width * image.height
                    && uvs.iter().all(|uv| uv.is_finite())
            }
        }
    }

    /// How bright it is within a triangle of the mesh, 0 to 1, at the point of these barycentric coordinates.
    pub fn at(&self, corners: [usize; 3], shares: [f64; 3]) -> Option<f64> {
        let weighted = |value: &dyn Fn(usize) -> f64| -> f64 {
            corners.iter().zip(shares).map(|(&corner, share)| share * value(corner)).sum()
        };
        match self {
            Shade::Unknown => None,
            Shade::Vertices(values) => Some(weighted(&|vertex| f64::from(values[vertex])) / 255.0),
            Shade::Image { uvs, image } => {
                let u = weighted(&|vertex| f64::from(uvs[vertex].x));
                let v = weighted(&|vertex| f64::from(uvs[vertex].y));
                Some(image.at(u, v))
            }
        }
    }
}

impl GreyImage {
    /// The image of these rows, in blocks of as many pixels as make it small enough. An image without pixels has none.
    ///
    /// - `pixel`: the brightness in a row and a column.
    pub fn new(width: usize, height: usize, pixel: impl Fn(usize, usize) -> u8) -> Self {
        let block = width.max(height).div_ceil(LONGEST_SIDE).max(1);
        let (small_width, small_height) = (width.div_ceil(block), height.div_ceil(block));
        let mut pixels = Vec::with_capacity(small_width * small_height);
        for row in 0..small_height {
            let rows = row * block..((row + 1) * block).min(height);
            for column in 0..small_width {
                let columns = column * block..((column + 1) * block).min(width);
                let sum: usize = rows
                    .clone()
                    .map(|row| columns.clone().map(|column| usize::from(pixel(row, column))).sum::<usize>())
                    .sum();
                let count = rows.len() * columns.len();
                pixels.push(((sum + count / 2) / count) as u8);
            }
        }
        Self { width: small_width, height: small_height, pixels }
    }

    /// The brightness at (u, v), 0 to 1, between the four nearest pixels.
    fn at(&self, u: f64, v: f64) -> f64 {
        let cell = |along: f64, count: usize| {
            let place = along * count as f64 - 0.5;
            let first = place.floor();
            let wrapped = |index: f64| index.rem_euclid(count as f64) as usize % count;
            (wrapped(first), wrapped(first + 1.0), place - first)
        };
        let (left, right, x) = cell(u, self.width);
        let (upper, lower, y) = cell(v, self.height);
        let pixel = |row: usize, column: usize| f64::from(self.pixels[row * self.width + column]) / 255.0;
        let row = |row: usize| pixel(row, left) + x * (pixel(row, right) - pixel(row, left));
        row(upper) + y * (row(lower) - row(upper))
    }
}
