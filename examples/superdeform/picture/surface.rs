//! The surface of a mesh: normals, and its colour at any point before light.

use glam::{Vec2, Vec3, Vec4};
use superdeform_host::image::{Image, TO_LINEAR};
use superdeform_host::materials::{Material, Texture};

/// One mesh: vertices in model space and what they look like. Lists that are empty are not there.
#[derive(Clone, Debug)]
pub struct PictureMesh<'a> {
    /// Positions.
    pub positions: &'a [Vec3],
    /// Normals, one a vertex; made from the triangles where empty.
    pub normals: &'a [Vec3],
    /// Corners as indices into `positions`.
    pub triangles: &'a [[u32; 3]],
    /// Texture coordinates, one a vertex.
    pub uvs: &'a [[f32; 2]],
    /// Linear vertex colours, one a vertex.
    pub colours: &'a [[f32; 4]],
    /// The material.
    pub material: &'a Material,
}

/// What is found out once about a mesh and used from every side.
pub struct Surface {
    /// One a vertex.
    pub normals: Vec<Vec3>,
    /// True where triangles run the other way round than their normals say (mirrored nodes).
    pub mirrored: bool,
}

impl Surface {
    pub fn new(mesh: &PictureMesh) -> Self {
        let face_normal = |corners: &[u32; 3]| {
            let [a, b, c] = corners.map(|corner| mesh.positions[corner as usize]);
            (b - a).cross(c - a)
        };
        if mesh.normals.len() != mesh.positions.len() {
            let mut normals = vec![Vec3::ZERO; mesh.positions.len()];
            for corners in mesh.triangles {
                for &corner in corners {
                    normals[corner as usize] += face_normal(corners);
                }
            }
            return Self { normals, mirrored: false };
        }
        let agreeing = mesh
            .triangles
            .iter()
            .filter(|corners| {
                let normal: Vec3 = corners.iter().map(|&corner| mesh.normals[corner as usize]).sum();
                normal.dot(face_normal(corners)) > 0.0
            })
            .count();
        Self { normals: mesh.normals.to_vec(), mirrored: 2 * agreeing < mesh.triangles.len() }
    }
}

impl PictureMesh<'_> {
    /// Linear colour and alpha at a point of a triangle, before light.
    pub fn paint(&self, corners: &[u32; 3], share: Vec3) -> Vec4 {
        let mut paint = Vec4::from(self.material.base_colour);
        let shares = || corners.iter().map(|&corner| corner as usize).zip(share.to_array());
        if self.colours.len() == self.positions.len() {
            paint *= shares().map(|(corner, share)| share * Vec4::from(self.colours[corner])).sum::<Vec4>();
        }
        if let Some(texture) = &self.material.texture
            && self.uvs.len() == self.positions.len()
        {
            let uv = shares().map(|(corner, share)| share * Vec2::from(self.uvs[corner])).sum::<Vec2>();
            paint *= look_up(texture, uv);
        }
        paint
    }
}

/// The texture's linear colour and alpha at `uv`, mixed from the four texels around it.
fn look_up(texture: &Texture, uv: Vec2) -> Vec4 {
    let image: &Image = &texture.image;
    let [u, v] = texture.place(uv.into());
    if image.pixels.is_empty() || !u.is_finite() || !v.is_finite() {
        return Vec4::ONE;
    }
    let (x, y) = (u * image.width as f32 - 0.5, v * image.height() as f32 - 0.5);
    let (left, top) = (x.floor(), y.floor());
    let mut mixed = Vec4::ZERO;
    for (right, down) in [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (1.0, 1.0)] {
        let column = texture.wrap[0].texel((left + right) as i64, image.width);
        let row = texture.wrap[1].texel((top + down) as i64, image.height());
        let share = (1.0 - (left + right - x).abs()) * (1.0 - (top + down - y).abs());
        let [red, green, blue, alpha] = image.at(column, row);
        let linear = [red, green, blue].map(|channel| TO_LINEAR[channel as usize]);
        mixed += share * Vec3::from(linear).extend(f32::from(alpha) / 255.0);
    }
    mixed
}
