//! What meshes look like: materials, texture coordinates and vertex colours, for the picture alone.

use super::materials::{Material, materials};
use serde_json::Value;

/// What a picture needs of a file beside the shape of its character.
#[derive(Clone, Debug, Default)]
pub struct Appearance {
    /// The file's materials.
    pub materials: Vec<Material>,
    /// One for each mesh of the character.
    pub surfaces: Vec<Surface>,
}

/// What a picture needs of a mesh beside its shape.
#[derive(Clone, Debug, Default)]
pub struct Surface {
    /// Texture coordinates, one a vertex, or empty.
    pub uvs: Vec<[f32; 2]>,
    /// Linear colours, one a vertex, or empty.
    pub colours: Vec<[f32; 4]>,
    /// Index into the file's materials.
    pub material: Option<usize>,
}

/// Reads the appearance of a file.
///
/// - `document`, `blob`: its JSON and its binary chunk.
/// - `primitives`: for each mesh of the character, its glTF mesh and the primitive within that.
/// - `floats`: the numbers of an accessor of so many components; `None` where it is damaged, and then the picture does
///   without, since the result does not depend on it.
pub fn read(
    document: &Value,
    blob: &[u8],
    primitives: impl IntoIterator<Item = (usize, usize)>,
    floats: impl Fn(usize, usize) -> Option<Vec<f32>>,
) -> Appearance {
    let materials = materials(document, blob);
    let surfaces = primitives
        .into_iter()
        .map(|(mesh, primitive)| {
            let primitive = &document["meshes"][mesh]["primitives"][primitive];
            let material = primitive["material"].as_u64().map(|index| index as usize);
            let uv_set =
                material.and_then(|index| materials.get(index)).map_or(0, |material| material.uv_set);
            let attribute = |name: &str| primitive["attributes"][name].as_u64().map(|index| index as usize);
            let uvs = attribute(&format!("TEXCOORD_{uv_set}")).and_then(|accessor| floats(accessor, 2));
            let colours = attribute("COLOR_0").and_then(|accessor| {
                let has_alpha = document["accessors"][accessor]["type"] == "VEC4";
                let numbers = floats(accessor, if has_alpha { 4 } else { 3 })?;
                Some(if has_alpha {
                    numbers.as_chunks::<4>().0.to_vec()
                } else {
                    let rows = numbers.as_chunks::<3>().0.iter();
                    rows.map(|&[red, green, blue]| [red, green, blue, 1.0]).collect()
                })
            });
            Surface {
                uvs: uvs.map_or(Vec::new(), |numbers| numbers.as_chunks::<2>().0.to_vec()),
                colours: colours.unwrap_or_default(),
                material,
            }
        })
        .collect();
    Appearance { materials, surfaces }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn colours_without_alpha_are_opaque_and_damaged_ones_left_out() {
        let document = json!({
            "meshes": [{"primitives": [{"attributes": {"COLOR_0": 0, "TEXCOORD_0": 1}, "material": 0}]}],
            "accessors": [{"type": "VEC3"}, {"type": "VEC2"}],
            "materials": [{}],
        });
        let floats = |accessor, components| (accessor == 0 && components == 3).then(|| vec![0.5, 0.25, 1.0]);
        let read = read(&document, &[], [(0, 0)], floats);
        assert_eq!(read.surfaces[0].colours, [[0.5, 0.25, 1.0, 1.0]]);
        assert!(read.surfaces[0].uvs.is_empty());
        assert_eq!(read.surfaces[0].material, Some(0));
    }
}
