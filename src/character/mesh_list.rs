//! All meshes of a character in one list of vertices and one of triangles.

use super::Character;
use super::mesh::place;
use crate::error::{Element, Error, ErrorKind};
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

    /// The error for a character none of whose triangles has an area: one vertex that lies far astray is enough.
    pub fn no_area(character: &Character) -> Error {
        let corners = character.meshes.iter().enumerate().flat_map(|(index, mesh)| {
            mesh.triangles.iter().flatten().map(move |&vertex| (index, vertex as usize))
        });
        let position = |&(mesh, vertex): &(usize, usize)| character.meshes[mesh].positions[vertex];
        let size = |corner: &(usize, usize)| position(corner).abs().max_element();
        let Some((mesh, vertex)) = corners.max_by(|a, b| size(a).total_cmp(&size(b))) else {
            return Self::no_extent();
        };
        let at = position(&(mesh, vertex));
        let place = place(mesh, &character.meshes[mesh].name);
        let message = format!(
            "{place}: no triangle of the character has an area beside its furthest vertex, {vertex} at {at}: move that if it lies astray, else give triangles of corners in three places"
        );
        Error::new(ErrorKind::NoGeometry, message).in_mesh(mesh).at(Element::Vertex(vertex))
    }

    /// The error for a list of nothing that stands.
    pub fn no_extent() -> Error {
        Error::new(
            ErrorKind::NoGeometry,
            "the character has no triangles with an extent along up: give at least one mesh of its body",
        )
    }
}
