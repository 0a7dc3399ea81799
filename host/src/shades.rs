//! How bright meshes are, told to the library: by it the face step sees painted irises and brows.

use crate::appearance::Appearance;
use crate::load::Loaded;
use glam::Vec2;
use std::sync::Arc;
use superdeform::{Character, Shade};

/// The character of `loaded` with the shades of its textures.
pub fn painted(loaded: &Loaded) -> Character {
    let mut character = loaded.character.clone();
    shade(&mut character, &Appearance::of(loaded, 1));
    character
}

/// Gives textured meshes of `character` the shade of their base colour; others keep none.
pub fn shade(character: &mut Character, seen: &Appearance) {
    for (mesh, surface) in character.meshes.iter_mut().zip(&seen.surfaces) {
        let Some(material) = surface.material else { continue };
        let texture = seen.materials.get(material).and_then(|material| material.texture.as_ref());
        if let Some(texture) = texture
            && surface.uvs.len() == mesh.positions.len()
        {
            let uvs: Vec<Vec2> = surface.uvs.iter().map(|&uv| texture.place(uv).into()).collect();
            let shade = Shade::Image { uvs, image: Arc::clone(&texture.grey) };
            if shade.fits(mesh.positions.len()) {
                mesh.shade = shade;
            }
        }
    }
}
