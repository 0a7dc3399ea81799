//! All meshes of a character in one list of vertices and one of triangles.

use super::Character;
use crate::error::{Error, ErrorKind};
use glam::DVec3;

/// The meshes of a character, one after the other.
#[derive(Clone, Debug, Default)]
pub(crate) struct MeshList {
    /// Vertices.
    pub positions: Vec<DVec3>,
    /// Triangles, as indices into `positions`.
    pub triangles: Vec<[u32; 3]>,
    /// Where each mesh's vertices start; one more than there are meshes.
    pub mesh_starts: Vec<usize>,
    /// Where each mesh's triangles start; one more than there are meshes.
    pub triangle_starts: Vec<usize>,
}

impl MeshList {
    /// The meshes of `character`, whose vertices `place` takes from model space to another one.
    pub fn of(character: &Character, place: impl Fn(DVec3) -> DVec3) -> Self {
        let mut list = Self {
            positions: Vec::with_capacity(character.vertex_count()),
            triangles: Vec::with_capacity(character.triangle_count()),
            mesh_starts: vec![0],
            triangle_starts: vec![0],
        };
        for mesh in &character.meshes {
            let start = list.positions.len() as u32;
            list.positions.extend(mesh.positions.iter().map(|p| place(p.as_dvec3())));
            list.triangles.extend(mesh.triangles.iter().map(|corners| corners.map(|vertex| vertex + start)));
            list.mesh_starts.push(list.positions.len());
            list.triangle_starts.push(list.triangles.len());
        }
        list
    }

    /// The error for a list of nothing that stands.
    pub fn no_extent() -> Error {
        Error::new(
            ErrorKind::NoGeometry,
            "the character has no triangles with an extent along up: give at least one mesh of its body",
        )
    }
}
