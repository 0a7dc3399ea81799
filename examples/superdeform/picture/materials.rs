//! Base colours and their textures out of a glTF document: what a picture needs of a material, and no more.
//!
//! VRM's MToon keeps its lit colour and texture where core glTF has them; an old VRM 0.x may have them only in its
//! own list, and an old exporter only in the specular-glossiness extension, so these are read too.

use image::RgbaImage;
use image::imageops::thumbnail;
use serde_json::Value;
use std::collections::BTreeMap;
use std::sync::Arc;
use superdeform::GreyImage;

/// Longest side of a decoded texture: a figure in a picture is about this many pixels tall.
const TEXTURE_SIZE: u32 = 512;

/// How alpha is used.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Alpha {
    /// Not at all.
    #[default]
    Opaque,
    /// Below this value a point is not there.
    Mask(f32),
    /// As a share of the colour.
    Blend,
}

/// What happens outside 0..1.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Wrap {
    /// The image again.
    #[default]
    Repeat,
    /// Its edge.
    Clamp,
    /// The image and its mirror image in turn.
    Mirror,
}

/// A decoded image and how it is looked up.
#[derive(Clone, Debug)]
pub struct Texture {
    /// sRGB colours and alpha.
    pub image: Arc<RgbaImage>,
    /// How bright the whole image is, for the face step.
    pub grey: Arc<GreyImage>,
    /// Along u and along v.
    pub wrap: [Wrap; 2],
    /// `KHR_texture_transform` as two rows that take (u, v, 1).
    pub transform: [[f32; 3]; 2],
}

/// What a picture needs of a material.
#[derive(Clone, Debug)]
pub struct Material {
    /// Linear colour and alpha, multiplied onto the texture.
    pub base_colour: [f32; 4],
    /// The base-colour texture.
    pub texture: Option<Texture>,
    /// Which `TEXCOORD_n` the texture wants.
    pub uv_set: usize,
    /// How alpha is used.
    pub alpha: Alpha,
    /// False where triangles seen from behind are left out.
    pub double_sided: bool,
    /// True for materials that bring their own shading (unlit, MToon).
    pub unlit: bool,
}

impl Default for Material {
    /// glTF's default: opaque white.
    fn default() -> Self {
        Self {
            base_colour: [1.0; 4],
            texture: None,
            uv_set: 0,
            alpha: Alpha::Opaque,
            double_sided: false,
            unlit: false,
        }
    }
}

/// The materials of `document` (a glTF file's JSON) in its order; `blob` is the binary chunk.
///
/// An image that is not PNG or JPEG inside the file, or is damaged, is left out: its material is then plain.
pub fn materials(document: &Value, blob: &[u8]) -> Vec<Material> {
    let mut read: Vec<(Material, Option<usize>)> = list(document, "materials")
        .iter()
        .enumerate()
        .map(|(index, material)| one_material(document, material, index))
        .collect();
    let mut sources: Vec<usize> =
        read.iter().filter_map(|(_, texture)| image_index(document, (*texture)?)).collect();
    sources.sort_unstable();
    sources.dedup();
    let images = decode(document, blob, &sources);
    for (material, texture) in &mut read {
        let Some(texture) = *texture else { continue };
        let image = image_index(document, texture).and_then(|image| images.get(&image));
        match (image, &mut material.texture) {
            (Some((image, grey)), Some(place)) => {
                place.image = Arc::clone(image);
                place.grey = Arc::clone(grey);
            }
            (_, place) => *place = None,
        }
    }
    read.into_iter().map(|(material, _)| material).collect()
}

/// One material, with the index of its texture; the image itself comes later.
fn one_material(document: &Value, material: &Value, index: usize) -> (Material, Option<usize>) {
    let extensions = &material["extensions"];
    let metallic = &material["pbrMetallicRoughness"];
    let glossy = &extensions["KHR_materials_pbrSpecularGlossiness"];
    let mut factor = &metallic["baseColorFactor"];
    let mut info = &metallic["baseColorTexture"];
    if metallic.is_null() && !glossy.is_null() {
        factor = &glossy["diffuseFactor"];
        info = &glossy["diffuseTexture"];
    }
    let old = &document["extensions"]["VRM"]["materialProperties"][index];
    let mut texture = whole(&info["index"]);
    if info.is_null() {
        texture = whole(&old["textureProperties"]["_MainTex"]);
    }
    let mut base_colour = [1.0; 4];
    for (channel, value) in base_colour.iter_mut().enumerate() {
        *value = factor[channel].as_f64().unwrap_or(1.0) as f32;
    }
    let alpha = match material["alphaMode"].as_str() {
        Some("MASK") => Alpha::Mask(material["alphaCutoff"].as_f64().unwrap_or(0.5) as f32),
        Some("BLEND") => Alpha::Blend,
        _ => Alpha::Opaque,
    };
    let shader = old["shader"].as_str().unwrap_or_default();
    let unlit = !extensions["KHR_materials_unlit"].is_null()
        || !extensions["VRMC_materials_mtoon"].is_null()
        || shader.contains("MToon")
        || shader.contains("Unlit");
    let move_by = &info["extensions"]["KHR_texture_transform"];
    let uv_set = whole(&move_by["texCoord"]).or(whole(&info["texCoord"])).unwrap_or(0);
    let material = Material {
        base_colour,
        texture: texture.map(|texture| Texture {
            image: Arc::default(),
            grey: Arc::default(),
            wrap: wrap(document, texture),
            transform: transform(move_by),
        }),
        uv_set,
        alpha,
        double_sided: material["doubleSided"].as_bool().unwrap_or(false),
        unlit,
    };
    (material, texture)
}

fn transform(extension: &Value) -> [[f32; 3]; 2] {
    let pair = |key: &str, otherwise: f32| {
        [0, 1].map(|index| extension[key][index].as_f64().map_or(otherwise, |value| value as f32))
    };
    let offset = pair("offset", 0.0);
    let scale = pair("scale", 1.0);
    let (sin, cos) = (extension["rotation"].as_f64().unwrap_or(0.0) as f32).sin_cos();
    [[cos * scale[0], sin * scale[1], offset[0]], [-sin * scale[0], cos * scale[1], offset[1]]]
}

fn wrap(document: &Value, texture: usize) -> [Wrap; 2] {
    let texture = &document["textures"][texture];
    let Some(sampler) = whole(&texture["sampler"]) else {
        return [Wrap::Repeat; 2];
    };
    ["wrapS", "wrapT"].map(|key| match document["samplers"][sampler][key].as_u64() {
        Some(33071) => Wrap::Clamp,
        Some(33648) => Wrap::Mirror,
        _ => Wrap::Repeat,
    })
}

fn image_index(document: &Value, texture: usize) -> Option<usize> {
    whole(&document["textures"][texture]["source"])
}

/// A decoded image, small, and how bright it is.
type Decoded = (Arc<RgbaImage>, Arc<GreyImage>);

/// Decodes the images with these indices, several at a time: this is most of what a picture costs.
fn decode(document: &Value, blob: &[u8], sources: &[usize]) -> BTreeMap<usize, Decoded> {
    let thread_count = std::thread::available_parallelism().map_or(1, usize::from);
    let chunk = sources.len().div_ceil(thread_count).max(1);
    std::thread::scope(|scope| {
        let workers: Vec<_> = sources
            .chunks(chunk)
            .map(|part| {
                scope.spawn(move || {
                    part.iter()
                        .filter_map(|&source| Some((source, one_image(document, blob, source)?)))
                        .collect::<Vec<_>>()
                })
            })
            .collect();
        // A decoder that panics costs its images, not the run.
        workers.into_iter().filter_map(|worker| worker.join().ok()).flatten().collect()
    })
}

fn one_image(document: &Value, blob: &[u8], source: usize) -> Option<Decoded> {
    let view = &document["bufferViews"][whole(&document["images"][source]["bufferView"])?];
    let start = whole(&view["byteOffset"]).unwrap_or(0);
    let end = start.checked_add(whole(&view["byteLength"])?)?;
    let image = image::load_from_memory(blob.get(start..end)?).ok()?.into_rgba8();
    let grey = Arc::new(grey(&image));
    let longest = image.width().max(image.height());
    if longest <= TEXTURE_SIZE {
        return Some((Arc::new(image), grey));
    }
    let side = |length: u32| (u64::from(length) * u64::from(TEXTURE_SIZE) / u64::from(longest)).max(1) as u32;
    Some((Arc::new(thumbnail(&image, side(image.width()), side(image.height()))), grey))
}

/// Luma of Rec. 709, of sRGB values.
fn grey(image: &RgbaImage) -> GreyImage {
    let luma = |row: usize, column: usize| {
        let [red, green, blue, _] = image.get_pixel(column as u32, row as u32).0.map(u32::from);
        ((54 * red + 183 * green + 19 * blue) / 256) as u8
    };
    GreyImage::new(image.width() as usize, image.height() as usize, luma)
}

fn list<'a>(document: &'a Value, key: &str) -> &'a [Value] {
    document[key].as_array().map_or(&[], Vec::as_slice)
}

fn whole(value: &Value) -> Option<usize> {
    value.as_u64().map(|number| number as usize)
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn a_plain_material_has_its_factor_and_alpha() {
        let document = json!({"materials": [
            {"pbrMetallicRoughness": {"baseColorFactor": [0.5, 0.25, 0, 1]}, "alphaMode": "MASK", "alphaCutoff": 0.3},
            {"doubleSided": true, "alphaMode": "BLEND", "extensions": {"KHR_materials_unlit": {}}},
        ]});
        let read = materials(&document, &[]);
        assert_eq!(read[0].base_colour, [0.5, 0.25, 0.0, 1.0]);
        assert_eq!(read[0].alpha, Alpha::Mask(0.3));
        assert!(!read[0].double_sided && !read[0].unlit && read[0].texture.is_none());
        assert_eq!(read[1].alpha, Alpha::Blend);
        assert!(read[1].double_sided && read[1].unlit);
    }

    #[test]
    fn a_damaged_image_leaves_its_material_plain() {
        let document = json!({
            "materials": [{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}],
            "textures": [{"source": 0}],
            "images": [{"bufferView": 0}],
            "bufferViews": [{"byteOffset": 2, "byteLength": 100}],
        });
        assert!(materials(&document, &[1, 2, 3])[0].texture.is_none());
        assert!(materials(&document, &[7; 200])[0].texture.is_none());
    }
}
