//! How bright meshes are, told to the library: by it the face step sees painted irises and brows.

use crate::picture::{Appearance, Texture};
use glam::Vec2;
use std::sync::Arc;
use superdeform::Character;
use superdeform::internals::character::{GreyImage, Shade};

/// Gives textured meshes of `character` the shade of their base colour; others keep none.
pub fn shade(character: &mut Character, seen: &Appearance) {
    let images: Vec<Option<Arc<GreyImage>>> =
        seen.materials.iter().map(|material| material.texture.as_ref().map(grey)).collect();
    for (mesh, surface) in character.meshes.iter_mut().zip(&seen.surfaces) {
        let Some(material) = surface.material else { continue };
        let texture = seen.materials.get(material).and_then(|material| material.texture.as_ref());
        if let (Some(texture), Some(Some(image))) = (texture, images.get(material))
            && surface.uvs.len() == mesh.positions.len()
        {
            let [u, v] = texture.transform;
            let place =
                |&[x, y]: &[f32; 2]| Vec2::new(u[0] * x + u[1] * y + u[2], v[0] * x + v[1] * y + v[2]);
            let uvs: Vec<Vec2> = surface.uvs.iter().map(place).collect();
            let shade = Shade::Image { uvs, image: Arc::clone(image) };
            if shade.fits(mesh.positions.len()) {
                mesh.shade = shade;
            }
        }
    }
}

/// Luma of Rec. 709, of sRGB values.
fn grey(texture: &Texture) -> Arc<GreyImage> {
    let image = &texture.image;
    let luma = |pixel: &image::Rgba<u8>| {
        let [red, green, blue, _] = pixel.0.map(u32::from);
        ((54 * red + 183 * green + 19 * blue) / 256) as u8
    };
    let pixels = image.pixels().map(luma).collect();
    Arc::new(GreyImage { width: image.width() as usize, height: image.height() as usize, pixels })
}
