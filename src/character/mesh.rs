//! Meshes of a character: vertices, triangles, normals, tangents, morph targets, and what the mesh depicts.

use super::Weights;
use crate::error::{Error, ErrorKind, Result};
use glam::{Vec3, Vec4};

/// What a mesh depicts. Hosts give it, or guess it with [`MeshKind::guess`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum MeshKind {
    /// Skin, or skin fused with clothes.
    #[default]
    Body,
    /// Clothes.
    Garment,
    /// Hair that belongs to the head.
    Hair,
    /// Eyes, brows, lashes, teeth, tongue: parts that follow the face.
    FacePart,
    /// Hats, glasses, bags, weapons: things that keep their shape.
    Accessory,
}

/// A morph target (blend shape): what is added to each vertex at weight 1.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MorphTarget {
    /// The target's name; may be empty.
    pub name: String,
    /// Displacements, one a vertex, model units.
    pub positions: Vec<Vec3>,
    /// Changes of the normals: one a vertex, or empty.
    pub normals: Vec<Vec3>,
    /// Changes of the tangents' directions: one a vertex, or empty.
    pub tangents: Vec<Vec3>,
}

/// One mesh in rest pose, in model space.
#[derive(Clone, Debug, Default)]
pub struct Mesh {
    /// The mesh's name, for messages.
    pub name: String,
    /// What it depicts.
    pub kind: MeshKind,
    /// Positions, model units.
    pub positions: Vec<Vec3>,
    /// Corners of each triangle, as indices into `positions`; the winding is never changed.
    pub triangles: Vec<[u32; 3]>,
    /// Unit normals: one a vertex, or empty.
    pub normals: Vec<Vec3>,
    /// Unit tangents with the handedness in `w`: one a vertex, or empty.
    pub tangents: Vec<Vec4>,
    /// Morph targets, any number.
    pub morph_targets: Vec<MorphTarget>,
    /// Skin weights: one row a vertex. A mesh that hangs rigidly from a joint has weight 1 to it throughout.
    /// No rows at all means that the mesh has no rig.
    pub weights: Weights,
}

impl Mesh {
    /// Checks the arrays of mesh number `index` against each other and against `joint_count`.
    ///
    /// # Errors
    /// `ErrorKind::BadInput` with the mesh, the element, the value and the remedy.
    pub fn validate(&self, index: usize, joint_count: usize) -> Result<()> {
        let place = if self.name.is_empty() {
            format!("mesh {index}")
        } else {
            format!("mesh {index} ({})", self.name)
        };
        let bad = |element: Option<usize>, message: String| {
            let error = Error::new(ErrorKind::BadInput, format!("{place}: {message}")).in_mesh(index);
            Err(match element {
                Some(element) => error.at(element),
                None => error,
            })
        };
        let count = self.positions.len();
        for (vertex, p) in self.positions.iter().enumerate() {
            if !p.is_finite() {
                return bad(
                    Some(vertex),
                    format!("vertex {vertex} is at {p}: positions must be finite numbers"),
                );
            }
        }
        for (triangle, corners) in self.triangles.iter().enumerate() {
            if let Some(vertex) = corners.iter().find(|&&vertex| vertex as usize >= count) {
                return bad(
                    Some(triangle),
                    format!(
                        "triangle {triangle} uses vertex {vertex}, but the mesh has {count} vertices; indices start at 0"
                    ),
                );
            }
        }
        let lengths = [("normals", self.normals.len()), ("tangents", self.tangents.len())];
        for (what, length) in lengths {
            if length != 0 && length != count {
                return bad(
                    None,
                    format!("{length} {what} for {count} vertices: give one a vertex, or none"),
                );
            }
        }
        if let Some(vertex) = self.normals.iter().position(|n| !n.is_finite()) {
            return bad(
                Some(vertex),
                format!(
                    "the normal of vertex {vertex} is {}: normals must be finite",
                    self.normals[vertex]
                ),
            );
        }
        if let Some(vertex) = self.tangents.iter().position(|t| !t.is_finite()) {
            return bad(
                Some(vertex),
                format!(
                    "the tangent of vertex {vertex} is {}: tangents must be finite",
                    self.tangents[vertex]
                ),
            );
        }
        for (target, morph) in self.morph_targets.iter().enumerate() {
            for (what, deltas, may_be_empty) in [
                ("position", &morph.positions, false),
                ("normal", &morph.normals, true),
                ("tangent", &morph.tangents, true),
            ] {
                if deltas.len() != count && !(may_be_empty && deltas.is_empty()) {
                    return bad(
                        None,
                        format!(
                            "morph target {target} ({}) has {} {what} deltas for {count} vertices: give one a vertex",
                            morph.name,
                            deltas.len()
                        ),
                    );
                }
                if let Some(vertex) = deltas.iter().position(|d| !d.is_finite()) {
                    return bad(
                        Some(vertex),
                        format!(
                            "morph target {target} ({}) moves the {what} of vertex {vertex} by {}: deltas must be finite",
                            morph.name, deltas[vertex]
                        ),
                    );
                }
            }
        }
        self.weights
            .validate(count, joint_count)
            .or_else(|(element, message)| bad(element, message))
    }
}
