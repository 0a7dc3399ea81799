//! Pictures: PNG and JPEG in, PNG out.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::LazyLock;
use zune_jpeg::zune_core::bytestream::ZCursor;
use zune_jpeg::zune_core::colorspace::ColorSpace;
use zune_jpeg::zune_core::options::DecoderOptions;

/// A picture that would take more bytes than this is not decoded: a small file may claim any size.
const LARGEST: usize = 1 << 29;

/// sRGB bytes to linear light.
pub static TO_LINEAR: LazyLock<[f32; 256]> = LazyLock::new(|| {
    std::array::from_fn(|byte| {
        let value = byte as f32 / 255.0;
        if value <= 0.04045 { value / 12.92 } else { ((value + 0.055) / 1.055).powf(2.4) }
    })
});

/// Linear light to sRGB, 0 to 1.
pub fn to_srgb(value: f32) -> f32 {
    if value <= 0.003_130_8 { 12.92 * value } else { 1.055 * value.powf(1.0 / 2.4) - 0.055 }
}

/// Rows of pixels from the top; a pixel is red, green, blue (sRGB) and alpha.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Image {
    /// Pixels in a row.
    pub width: usize,
    /// `width` times the number of rows.
    pub pixels: Vec<[u8; 4]>,
}

impl Image {
    /// The picture in a PNG or JPEG file; `None` for other files, damaged ones, and larger ones than half a gigabyte.
    pub fn decode(bytes: &[u8]) -> Option<Self> {
        // A decoder that panics costs its picture, not the run.
        catch_unwind(AssertUnwindSafe(|| {
            if bytes.starts_with(b"\x89PNG") { decode_png(bytes) } else { decode_jpeg(bytes) }
        }))
        .ok()
        .flatten()
    }

    /// How many rows there are.
    pub fn height(&self) -> usize {
        self.pixels.len() / self.width.max(1)
    }

    /// The pixel in a column and a row.
    pub fn at(&self, column: usize, row: usize) -> [u8; 4] {
        self.pixels[row * self.width + column]
    }

    /// The picture with at most `longest` pixels a side: each the mean of a block.
    pub fn shrunk(self, longest: usize) -> Self {
        let (width, height) = (self.width, self.height());
        let block = width.max(height).div_ceil(longest.max(1)).max(1);
        if block == 1 {
            return self;
        }
        let starts = |length: usize| (0..length.div_ceil(block)).map(move |index| index * block);
        let mean = |row: usize, column: usize| {
            let rows = row..(row + block).min(height);
            let columns = column..(column + block).min(width);
            let mut sum = [0u32; 4];
            for (row, column) in rows.clone().flat_map(|row| columns.clone().map(move |column| (row, column)))
            {
                for (sum, value) in sum.iter_mut().zip(self.at(column, row)) {
                    *sum += u32::from(value);
                }
            }
            let count = (rows.len() * columns.len()) as u32;
            sum.map(|sum| ((sum + count / 2) / count) as u8)
        };
        let pixels = starts(height).flat_map(|row| starts(width).map(move |column| (row, column)));
        Self { width: width.div_ceil(block), pixels: pixels.map(|(row, column)| mean(row, column)).collect() }
    }

    /// The picture as PNG, without alpha where every pixel is opaque.
    ///
    /// # Errors
    /// One sentence with the encoder's reason.
    pub fn to_png(&self) -> Result<Vec<u8>, String> {
        let size = (self.width as u32, self.height() as u32);
        if self.pixels.iter().all(|pixel| pixel[3] == u8::MAX) {
            let opaque: Vec<u8> = self.pixels.iter().flat_map(|pixel| &pixel[..3]).copied().collect();
            encode_png(size, png::ColorType::Rgb, &opaque)
        } else {
            encode_png(size, png::ColorType::Rgba, self.pixels.as_flattened())
        }
    }
}

fn encode_png(size: (u32, u32), colour: png::ColorType, data: &[u8]) -> Result<Vec<u8>, String> {
    let failed = |error: png::EncodingError| format!("the picture cannot be encoded: {error}");
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, size.0, size.1);
    encoder.set_color(colour);
    encoder.set_depth(png::BitDepth::Eight);
    let mut writer = encoder.write_header().map_err(failed)?;
    writer.write_image_data(data).map_err(failed)?;
    writer.finish().map_err(failed)?;
    Ok(bytes)
}

fn decode_png(bytes: &[u8]) -> Option<Image> {
    let limits = png::Limits { bytes: LARGEST };
    let mut decoder = png::Decoder::new_with_limits(std::io::Cursor::new(bytes), limits);
    decoder.set_transformations(png::Transformations::EXPAND);
    let mut reader = decoder.read_info().ok()?;
    let size = reader.output_buffer_size().filter(|&size| size <= LARGEST)?;
    let mut data = vec![0; size];
    let info = reader.next_frame(&mut data).ok()?;
    let (width, height) = (info.width as usize, info.height as usize);
    let channels = info.color_type.samples();
    if info.bit_depth == png::BitDepth::Sixteen {
        // Big-endian, rounded to 8 bits.
        let wide = data.as_chunks::<2>().0.iter().map(|&pair| u32::from(u16::from_be_bytes(pair)));
        data = wide.map(|value| ((value * 255 + 32767) / 65535) as u8).collect();
    }
    image_of(&data, width, height, channels)
}

fn decode_jpeg(bytes: &[u8]) -> Option<Image> {
    let options = || {
        DecoderOptions::default().set_strict_mode(false).set_max_width(usize::MAX).set_max_height(usize::MAX)
    };
    let mut header = zune_jpeg::JpegDecoder::new_with_options(ZCursor::new(bytes), options());
    header.decode_headers().ok()?;
    let (width, height) = header.dimensions()?;
    let (space, channels) = match header.input_colorspace()? {
        space @ ColorSpace::Luma => (space, 1),
        _ => (ColorSpace::RGB, 3),
    };
    width.checked_mul(height)?.checked_mul(4).filter(|&size| size <= LARGEST)?;
    let options = options().jpeg_set_out_colorspace(space);
    let data = zune_jpeg::JpegDecoder::new_with_options(ZCursor::new(bytes), options).decode().ok()?;
    image_of(&data, width, height, channels)
}

/// Of grey, grey and alpha, colours, or colours and alpha: one to four channels.
fn image_of(data: &[u8], width: usize, height: usize, channels: usize) -> Option<Image> {
    let pixel = |values: &[u8]| match *values {
        [grey] => [grey, grey, grey, u8::MAX],
        [grey, alpha] => [grey, grey, grey, alpha],
        [red, green, blue] => [red, green, blue, u8::MAX],
        [red, green, blue, alpha, ..] => [red, green, blue, alpha],
        [] => [0; 4],
    };
    let pixels: Vec<[u8; 4]> = data.chunks_exact(channels.max(1)).map(pixel).take(width * height).collect();
    (width > 0 && pixels.len() == width * height).then_some(Image { width, pixels })
}

/// A picture to draw on: rows of red, green and blue from the top.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Sheet {
    width: u32,
    height: u32,
    pixels: Vec<[u8; 3]>,
}

impl Sheet {
    /// A sheet whose pixel in a column and a row is as `colour` gives it.
    pub fn of(width: u32, height: u32, colour: impl Fn(u32, u32) -> [u8; 3]) -> Self {
        let rows = (0..height).flat_map(|row| (0..width).map(move |column| (column, row)));
        Self { width, height, pixels: rows.map(|(column, row)| colour(column, row)).collect() }
    }

    /// Pixels in a row.
    pub fn width(&self) -> u32 {
        self.width
    }

    /// How many rows there are.
    pub fn height(&self) -> u32 {
        self.height
    }

    /// The pixel in a column and a row.
    pub fn at(&self, column: u32, row: u32) -> [u8; 3] {
        self.pixels[self.index(column, row)]
    }

    /// The same, to paint it.
    pub fn at_mut(&mut self, column: u32, row: u32) -> &mut [u8; 3] {
        let index = self.index(column, row);
        &mut self.pixels[index]
    }

    fn index(&self, column: u32, row: u32) -> usize {
        assert!(column < self.width, "column {column} of {}", self.width);
        row as usize * self.width as usize + column as usize
    }

    /// The part of a width and a height whose first pixel is in a column and a row; less where the sheet ends.
    pub fn part(&self, column: u32, row: u32, width: u32, height: u32) -> Self {
        let width = width.min(self.width.saturating_sub(column));
        let height = height.min(self.height.saturating_sub(row));
        Self::of(width, height, |x, y| self.at(column + x, row + y))
    }

    /// The sheet as PNG.
    ///
    /// # Errors
    /// One sentence with the encoder's reason.
    pub fn to_png(&self) -> Result<Vec<u8>, String> {
        encode_png((self.width, self.height), png::ColorType::Rgb, self.pixels.as_flattened())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn encoded(colour: png::ColorType, depth: png::BitDepth, data: &[u8]) -> Vec<u8> {
        let mut bytes = Vec::new();
        let mut encoder = png::Encoder::new(&mut bytes, 2, 1);
        encoder.set_color(colour);
        encoder.set_depth(depth);
        encoder.write_header().unwrap().write_image_data(data).unwrap();
        bytes
    }

    #[test]
    fn png_of_any_depth_becomes_eight_bits_with_alpha() {
        use png::{BitDepth, ColorType};
        for (colour, depth, data, pixels) in [
            (ColorType::Rgb, BitDepth::Eight, &[1, 2, 3, 4, 5, 6][..], [[1, 2, 3, 255], [4, 5, 6, 255]]),
            (ColorType::GrayscaleAlpha, BitDepth::Eight, &[9, 8, 7, 6], [[9, 9, 9, 8], [7, 7, 7, 6]]),
            // 65535 is white; 0x0180 is 1.49 of 255.
            (ColorType::Grayscale, BitDepth::Sixteen, &[255, 255, 1, 128], [[255; 4], [1, 1, 1, 255]]),
            (ColorType::Grayscale, BitDepth::One, &[0b0100_0000], [[0, 0, 0, 255], [255; 4]]),
        ] {
            let image = Image::decode(&encoded(colour, depth, data)).unwrap();
            assert_eq!((image.width, image.height()), (2, 1));
            assert_eq!(image.pixels, pixels, "{colour:?} {depth:?}");
        }
    }

    #[test]
    fn what_is_written_is_read_again_and_what_is_damaged_is_not() {
        let bytes = Sheet::of(1, 2, |_, row| [[1, 2, 3], [4, 5, 6]][row as usize]).to_png().unwrap();
        assert_eq!(Image::decode(&bytes).unwrap().pixels, [[1, 2, 3, 255], [4, 5, 6, 255]]);
        assert!(Image::decode(&bytes[..bytes.len() / 2]).is_none());
        assert!(Image::decode(b"\xff\xd8\xff\xe0no picture").is_none());
        assert!(Image::decode(&[]).is_none());
        // A header that claims 60,000 pixels a side.
        let mut giant = bytes;
        giant[16..24].copy_from_slice(&[0, 0, 0xea, 0x60, 0, 0, 0xea, 0x60]);
        assert!(Image::decode(&giant).is_none());
    }

    #[test]
    fn a_shrunk_picture_holds_the_means_of_blocks() {
        let pixels = [0, 100, 10, 200].map(|value| [value; 4]).to_vec();
        let image = Image { width: 4, pixels };
        assert_eq!(image.clone().shrunk(2).pixels, [[50; 4], [105; 4]]);
        assert_eq!(image.clone().shrunk(4), image);
    }
}
