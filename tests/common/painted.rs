//! How bright the models' textures are, as the command line tells the library: by this painted irises and brows are seen.
#![allow(dead_code)]

#[path = "../../examples/superdeform/picture/appearance.rs"]
mod appearance;
#[path = "../../examples/superdeform/picture/materials.rs"]
mod materials;

use glam::Vec2;
use std::sync::Arc;
use superdeform::{Character, Shade};
use superdeform_host::accessor::Reader;
use superdeform_host::load::Loaded;

/// The character of `loaded` with the shade of its base colours.
pub fn painted(loaded: &Loaded) -> Character {
    let reader = Reader::new(&loaded.file);
    let primitives = loaded.bindings.iter().map(|binding| (binding.mesh, binding.primitive));
    let seen =
        appearance::read(&loaded.file.json, &loaded.file.binary, primitives, |accessor, components| {
            reader.floats(accessor, components, None).ok()
        });
    let mut character = loaded.character.clone();
    for (mesh, surface) in character.meshes.iter_mut().zip(&seen.surfaces) {
        let texture = surface.material.and_then(|material| seen.materials[material].texture.as_ref());
        let Some(texture) = texture.filter(|_| surface.uvs.len() == mesh.positions.len()) else { continue };
        let [u, v] = texture.transform;
        let place = |&[x, y]: &[f32; 2]| Vec2::new(u[0] * x + u[1] * y + u[2], v[0] * x + v[1] * y + v[2]);
        let uvs = surface.uvs.iter().map(place).collect();
        let shade = Shade::Image { uvs, image: Arc::clone(&texture.grey) };
        if shade.fits(mesh.positions.len()) {
            mesh.shade = shade;
        }
    }
    character
}
