//! Does a written file put its vertices where they should be? Skinned anew, in 64 bits.

use super::accessor::Reader;
use super::bind::{NodeTree, read_skins};
use super::file::GltfFile;
use super::load::Loaded;
use super::primitive::read_primitive;
use super::write::{extent, new_rest};
use super::{array_at, index_at};
use glam::{DMat4, DVec3};
use superdeform::{Deformed, Result};

/// How far vertices are from where they should be, as a share of the figure's height before.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Closure {
    /// By the new rest transforms and the written inverse bind matrices; morph targets included.
    pub rest: f64,
    /// By the written nodes; `None` where the file's nodes stand in another pose.
    pub nodes: Option<f64>,
}

/// The vertices of all meshes of a file, skinned by its nodes as they stand, in the order of its nodes.
///
/// # Errors
/// When the file cannot be read.
pub fn skinned(file: &GltfFile) -> Result<Vec<DVec3>> {
    let tree = NodeTree::read(file)?;
    let reader = Reader::new(file);
    let skins = read_skins(&reader)?;
    let mut places = Vec::new();
    for &node in &tree.order {
        let json = &file.list("nodes")[node];
        let Some(mesh) = index_at(json, "mesh") else { continue };
        let skin = index_at(json, "skin").map(|skin| &skins[skin]);
        for primitive in 0..array_at(&file.list("meshes")[mesh], "primitives").len() {
            let joint_count = skin.map(|skin| skin.joints.len());
            let Some(raw) = read_primitive(&reader, node, mesh, primitive, joint_count)? else { continue };
            for (vertex, place) in raw.positions.iter().enumerate() {
                let matrix = match skin {
                    None => tree.world[node],
                    Some(skin) => raw.rows[vertex].iter().fold(DMat4::ZERO, |sum, &(slot, weight)| {
                        let slot = slot as usize;
                        sum + tree.world[skin.joints[slot]] * skin.inverse_binds[slot] * f64::from(weight)
                    }),
                };
                places.push(matrix.transform_point3(place.as_dvec3()));
            }
        }
    }
    Ok(places)
}

/// Reads a written file and skins it at rest.
///
/// # Errors
/// When the file cannot be read.
pub fn closure(written: &GltfFile, loaded: &Loaded, deformed: &Deformed) -> Result<Closure> {
    let tree = NodeTree::read(written)?;
    let reader = Reader::new(written);
    let skins = read_skins(&reader)?;
    let rest = new_rest(loaded, deformed);
    let up = loaded.character.axes.up.as_dvec3().normalize_or(DVec3::Y);
    let (low, high) = extent(loaded.character.meshes.iter().map(|mesh| mesh.positions.as_slice()), up);
    let height = (high - low).max(f64::MIN_POSITIVE);
    let mut by_rest = 0.0f64;
    let mut by_nodes = 0.0f64;
    for (index, (binding, wanted)) in loaded.bindings.iter().zip(&deformed.meshes).enumerate() {
        let node_json = &written.list("nodes")[binding.node];
        let mesh = index_at(node_json, "mesh").unwrap_or(binding.mesh);
        let skin = binding.skin.map(|skin| &skins[skin]);
        let joint_count = skin.map(|skin| skin.joints.len());
        let raw = read_primitive(&reader, binding.node, mesh, binding.primitive, joint_count)?;
        let Some(raw) = raw else { continue };
        let matrix = |nodes: &[DMat4], vertex: usize| match skin {
            None => nodes[binding.node],
            Some(skin) => {
                let row = &raw.rows[vertex];
                let sum: f64 = row.iter().map(|&(_, weight)| f64::from(weight)).sum();
                row.iter().fold(DMat4::ZERO, |blended, &(slot, weight)| {
                    let slot = slot as usize;
                    let joint = nodes[skin.joints[slot]] * skin.inverse_binds[slot];
                    blended + joint * (f64::from(weight) / sum)
                })
            }
        };
        for vertex in 0..raw.positions.len() {
            let at_rest = matrix(&rest, vertex);
            let at_nodes = matrix(&tree.world, vertex);
            let place = raw.positions[vertex].as_dvec3();
            let wish = wanted.positions[vertex].as_dvec3();
            by_rest = by_rest.max(at_rest.transform_point3(place).distance(wish));
            by_nodes = by_nodes.max(at_nodes.transform_point3(place).distance(wish));
            for (target, wanted) in raw.morph_targets.iter().zip(&wanted.morph_targets) {
                let delta = at_rest.transform_vector3(target.positions[vertex].as_dvec3());
                by_rest = by_rest.max(delta.distance(wanted.positions[vertex].as_dvec3()));
            }
        }
        debug_assert_eq!(raw.positions.len(), loaded.character.meshes[index].positions.len());
    }
    Ok(Closure { rest: by_rest / height, nodes: (!loaded.pose.differs).then_some(by_nodes / height) })
}
