//! Base colours and their textures out of a glTF document: what the face step and a picture need of a material.
//!
//! VRM's MToon keeps its lit colour and texture where core glTF has them; an old VRM 0.x may have them only in its
//! own list, and an old exporter only in the specular-glossiness extension, so these are read too.

use crate::file::GltfFile;
use crate::image::Image;
use crate::{array_at, index_at};
use serde_json::Value;
use std::collections::BTreeMap;
use std::sync::Arc;
use superdeform::GreyImage;
use superdeform::internals::parallel;

/// Longest side of a decoded texture: a figure in a picture is about this many pixels tall.
pub(crate) const TEXTURE_SIZE: usize = 512;

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

impl Wrap {
    /// The texel that one of any number shows, of so many along an axis.
    pub fn texel(self, texel: i64, count: usize) -> usize {
        let count = count as i64;
        let inside = match self {
            Self::Repeat => texel.rem_euclid(count),
            Self::Clamp => texel.clamp(0, count - 1),
            Self::Mirror => {
                let twice = texel.rem_euclid(2 * count);
                twice.min(2 * count - 1 - twice)
            }
        };
        inside as usize
    }
}

/// A decoded image and how it is looked up.
#[derive(Clone, Debug)]
pub struct Texture {
    /// sRGB colours and alpha.
    pub image: Arc<Image>,
    /// The image's number in the file.
    pub source: usize,
    /// True where the texture also names the image in another format, which viewers that know it show.
    pub has_other_format: bool,
    /// How bright the whole image is, for the face step.
    pub grey: Arc<GreyImage>,
    /// Along u and along v.
    pub wrap: [Wrap; 2],
    /// `KHR_texture_transform` as two rows that take (u, v, 1).
    pub transform: [[f32; 3]; 2],
}

impl Texture {
    /// Where texture coordinates lie on the image, 0 to 1 along each side of it.
    pub fn place(&self, [u, v]: [f32; 2]) -> [f32; 2] {
        self.transform.map(|[by_u, by_v, shift]| by_u * u + by_v * v + shift)
    }
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

/// The materials of `file` in its order; its images are decoded by at most `threads` threads, 0 for all cores.
///
/// An image that is neither PNG nor JPEG, is damaged or not there, is left out: its material is then plain.
pub fn materials(file: &GltfFile, threads: usize) -> Vec<Material> {
    let document = &file.json;
    let mut read: Vec<(Material, Option<usize>)> = array_at(document, "materials")
        .iter()
        .enumerate()
        .map(|(index, material)| one_material(document, material, index))
        .collect();
    let mut sources: Vec<usize> =
        read.iter().filter_map(|(_, texture)| image_index(document, (*texture)?)).collect();
    sources.sort_unstable();
    sources.dedup();
    // This is most of what a picture costs.
    let images = parallel::collect(threads, sources.len(), 1, |index| decode(file, sources[index]));
    let images: BTreeMap<usize, Decoded> =
        sources.iter().zip(images).filter_map(|(&source, image)| Some((source, image?))).collect();
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
    let mut texture = index_at(info, "index");
    if info.is_null() {
        texture = index_at(&old["textureProperties"], "_MainTex");
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
    let uv_set = index_at(move_by, "texCoord").or(index_at(info, "texCoord")).unwrap_or(0);
    let material = Material {
        base_colour,
        texture: texture.map(|texture| Texture {
            image: Arc::default(),
            source: image_index(document, texture).unwrap_or_default(),
            has_other_format: document["textures"][texture]["extensions"]
                .as_object()
                .is_some_and(|held| held.values().any(|other| index_at(other, "source").is_some())),
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
    let Some(sampler) = index_at(texture, "sampler") else {
        return [Wrap::Repeat; 2];
    };
    ["wrapS", "wrapT"].map(|key| match document["samplers"][sampler][key].as_u64() {
        Some(33071) => Wrap::Clamp,
        Some(33648) => Wrap::Mirror,
        _ => Wrap::Repeat,
    })
}

fn image_index(document: &Value, texture: usize) -> Option<usize> {
    index_at(&document["textures"][texture], "source")
}

/// A decoded image, small, and how bright it is.
type Decoded = (Arc<Image>, Arc<GreyImage>);

fn decode(file: &GltfFile, source: usize) -> Option<Decoded> {
    let image = Image::decode(&file.image(source)?)?;
    let grey = Arc::new(grey(&image));
    Some((Arc::new(image.shrunk(TEXTURE_SIZE)), grey))
}

/// Luma of Rec. 709, of sRGB values.
fn grey(image: &Image) -> GreyImage {
    let luma = |row: usize, column: usize| {
        let [red, green, blue, _] = image.at(column, row).map(u32::from);
        ((54 * red + 183 * green + 19 * blue) / 256) as u8
    };
    GreyImage::new(image.width, image.height(), luma)
}
#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    fn file(json: Value, binary: &[u8]) -> GltfFile {
        GltfFile { json, binary: binary.to_vec(), ..GltfFile::default() }
    }

    #[test]
    fn a_plain_material_has_its_factor_and_alpha() {
        let document = json!({"materials": [
            {"pbrMetallicRoughness": {"baseColorFactor": [0.5, 0.25, 0, 1]}, "alphaMode": "MASK", "alphaCutoff": 0.3},
            {"doubleSided": true, "alphaMode": "BLEND", "extensions": {"KHR_materials_unlit": {}}},
        ]});
        let read = materials(&file(document, &[]), 1);
        assert_eq!(read[0].base_colour, [0.5, 0.25, 0.0, 1.0]);
        assert_eq!(read[0].alpha, Alpha::Mask(0.3));
        assert!(!read[0].double_sided && !read[0].unlit && read[0].texture.is_none());
        assert_eq!(read[1].alpha, Alpha::Blend);
        assert!(read[1].double_sided && read[1].unlit);
    }

    #[test]
    fn texels_outside_of_an_image_are_those_that_viewers_show() {
        let shown = |wrap: Wrap| (-3..6).map(|texel| wrap.texel(texel, 3)).collect::<Vec<_>>();
        assert_eq!(shown(Wrap::Repeat), [0, 1, 2, 0, 1, 2, 0, 1, 2]);
        assert_eq!(shown(Wrap::Clamp), [0, 0, 0, 0, 1, 2, 2, 2, 2]);
        assert_eq!(shown(Wrap::Mirror), [2, 1, 0, 0, 1, 2, 2, 1, 0]);
        let of_four = |wrap: Wrap| [-1, 0, 3, 4, 5].map(|texel| wrap.texel(texel, 4));
        assert_eq!(of_four(Wrap::Repeat), [3, 0, 3, 0, 1]);
        assert_eq!(of_four(Wrap::Clamp), [0, 0, 3, 3, 3]);
        assert_eq!(of_four(Wrap::Mirror), [0, 0, 3, 3, 2]);
    }

    #[test]
    fn a_damaged_image_leaves_its_material_plain() {
        let document = json!({
            "materials": [{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}],
            "textures": [{"source": 0}],
            "images": [{"bufferView": 0}],
            "bufferViews": [{"byteOffset": 2, "byteLength": 100}],
        });
        for bytes in [&[1, 2, 3][..], &[7; 200]] {
            assert!(materials(&file(document.clone(), bytes), 1)[0].texture.is_none());
        }
    }
}
