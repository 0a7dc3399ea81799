//! What meshes look like: materials, texture coordinates and vertex colours. By it the face step sees irises and brows
//! that are painted, and a picture is drawn.

use crate::accessor::Reader;
use crate::image::Image;
use crate::index_at;
use crate::load::Loaded;
use crate::materials::{Material, TEXTURE_SIZE, materials};
use crate::paint::Images;
use std::collections::BTreeMap;
use std::sync::Arc;

/// What a file says of a character beside its shape.
#[derive(Clone, Debug, Default)]
pub struct Appearance {
    /// The file's materials.
    pub materials: Vec<Material>,
    /// One for each mesh of the character.
    pub surfaces: Vec<Surface>,
}

/// What a file says of a mesh beside its shape.
#[derive(Clone, Debug, Default)]
pub struct Surface {
    /// Texture coordinates, one a vertex, or empty.
    pub uvs: Vec<[f32; 2]>,
    /// Linear colours, one a vertex, or empty.
    pub colours: Vec<[f32; 4]>,
    /// Index into the file's materials.
    pub material: Option<usize>,
}

impl Appearance {
    /// Reads the appearance of a character; its images are decoded by at most `threads` threads, 0 for all cores.
    ///
    /// What is damaged is left out, since nothing that is written depends on it but a painted face.
    pub fn of(loaded: &Loaded, threads: usize) -> Self {
        let materials = materials(&loaded.file, threads);
        let reader = Reader::new(&loaded.file);
        let primitives = loaded.bindings.iter().map(|binding| (binding.mesh, binding.primitive));
        let surfaces =
            primitives.map(|(mesh, primitive)| Surface::of(&reader, mesh, primitive, &materials)).collect();
        Self { materials, surfaces }
    }

    /// Its materials, with other images in the place of those with these numbers.
    pub fn materials_with(&self, images: Images) -> Vec<Material> {
        let images: BTreeMap<usize, Arc<Image>> = images
            .into_iter()
            .map(|(source, image)| (source, Arc::new(image.shrunk(TEXTURE_SIZE))))
            .collect();
        let mut materials = self.materials.clone();
        for texture in materials.iter_mut().filter_map(|material| material.texture.as_mut()) {
            if let Some(image) = images.get(&texture.source) {
                texture.image = Arc::clone(image);
            }
        }
        materials
    }
}

impl Surface {
    fn of(reader: &Reader, mesh: usize, primitive: usize, materials: &[Material]) -> Self {
        let json = &reader.file.json["meshes"][mesh]["primitives"][primitive];
        let material = index_at(json, "material");
        let uv_set = material.and_then(|index| materials.get(index)).map_or(0, |material| material.uv_set);
        let attribute = |name: &str| index_at(&json["attributes"], name);
        let floats = |accessor: usize, components: usize| reader.floats(accessor, components, None).ok();
        let uvs = attribute(&format!("TEXCOORD_{uv_set}")).and_then(|accessor| floats(accessor, 2));
        let colours = attribute("COLOR_0").and_then(|accessor| {
            let has_alpha = reader.file.json["accessors"][accessor]["type"] == "VEC4";
            let numbers = floats(accessor, if has_alpha { 4 } else { 3 })?;
            Some(if has_alpha {
                numbers.as_chunks::<4>().0.to_vec()
            } else {
                let rows = numbers.as_chunks::<3>().0.iter();
                rows.map(|&[red, green, blue]| [red, green, blue, 1.0]).collect()
            })
        });
        Self {
            uvs: uvs.map_or(Vec::new(), |numbers| numbers.as_chunks::<2>().0.to_vec()),
            colours: colours.unwrap_or_default(),
            material,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::file::GltfFile;
    use serde_json::json;

    #[test]
    fn colours_without_alpha_are_opaque_and_damaged_ones_left_out() {
        let json = json!({
            "meshes": [{"primitives": [{"attributes": {"COLOR_0": 0, "TEXCOORD_0": 1}, "material": 0}]}],
            "accessors": [
                {"type": "VEC3", "componentType": 5126, "count": 1, "bufferView": 0},
                {"type": "VEC2", "componentType": 5126, "count": 9, "bufferView": 0},
            ],
            "bufferViews": [{"buffer": 0, "byteLength": 12}],
            "materials": [{}],
        });
        let binary = [0.5f32, 0.25, 1.0].iter().flat_map(|number| number.to_le_bytes()).collect();
        let file = GltfFile { json, binary, ..GltfFile::default() };
        let surface = Surface::of(&Reader::new(&file), 0, 0, &[Material::default()]);
        assert_eq!(surface.colours, [[0.5, 0.25, 1.0, 1.0]]);
        assert!(surface.uvs.is_empty());
        assert_eq!(surface.material, Some(0));
    }
}
