//! Meshes of a character: vertices, triangles, normals, tangents, morph targets, and what the mesh depicts.

use super::{MeshKind, Shade, Weights};
use crate::error::{Element, Error, ErrorKind, Named, Result};
use glam::{Vec3, Vec4};

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

impl MorphTarget {
    /// Checks target number `target` against the number of vertices.
    pub(crate) fn check(&self, target: usize, vertex_count: usize) -> std::result::Result<(), Fault> {
        let name = Named(&self.name);
        for (what, deltas, may_be_empty) in [
            ("position", &self.positions, false),
            ("normal", &self.normals, true),
            ("tangent", &self.tangents, true),
        ] {
            let count = deltas.len();
            if count != vertex_count && !(may_be_empty && deltas.is_empty()) {
                let message = format!(
                    "morph target {target} ({name}) has {count} {what} deltas for {vertex_count} vertices: give one a vertex"
                );
                return Err((None, message));
            }
            if let Some(vertex) = deltas.iter().position(|d| !d.is_finite()) {
                let message = format!(
                    "morph target {target} ({name}) moves the {what} of vertex {vertex} by {}: deltas must be finite",
                    deltas[vertex]
                );
                return Err((Some(Element::Vertex(vertex)), message));
            }
        }
        Ok(())
    }
}

/// What is wrong with a mesh: where, and a sentence.
pub(crate) type Fault = (Option<Element>, String);

/// A mesh in sentences: its index, and its name where it has one.
pub(crate) fn place(index: usize, name: &str) -> String {
    if name.is_empty() { format!("mesh {index}") } else { format!("mesh {index} ({})", Named(name)) }
}

/// One mesh in rest pose, in model space.
#[derive(Clone, Debug, Default)]
pub struct Mesh {
    /// The mesh's name, for messages.
    pub name: String,
    /// What it depicts, as the host says or guesses from names; `None` where nobody knows: a rigged mesh counts as body
    /// then, and the auto-rig looks at where the mesh lies.
    pub kind: Option<MeshKind>,
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
    /// How bright it is, for the face step; nothing need be known.
    pub shade: Shade,
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
        self.check(joint_count).map_err(|fault| self.error(index, fault))
    }

    /// The error for what is wrong with it, which is mesh number `index`.
    pub(crate) fn error(&self, index: usize, (element, message): Fault) -> Error {
        let message = format!("{}: {message}", place(index, &self.name));
        Error { element, ..Error::new(ErrorKind::BadInput, message).in_mesh(index) }
    }

    /// See [`Mesh::validate`].
    fn check(&self, joint_count: usize) -> std::result::Result<(), Fault> {
        let at = |vertex: usize, message: String| Err((Some(Element::Vertex(vertex)), message));
        let count = self.positions.len();
        if let Some(vertex) = self.positions.iter().position(|p| !p.is_finite()) {
            let p = self.positions[vertex];
            return at(vertex, format!("vertex {vertex} is at {p}: positions must be finite numbers"));
        }
        for (triangle, corners) in self.triangles.iter().enumerate() {
            if let Some(vertex) = corners.iter().find(|&&vertex| vertex as usize >= count) {
                let message = format!(
                    "triangle {triangle} uses vertex {vertex}, but the mesh has {count} vertices: give indices from 0 to that less 1"
                );
                return Err((Some(Element::Triangle(triangle)), message));
            }
        }
        for (what, length) in [("normals", self.normals.len()), ("tangents", self.tangents.len())] {
            if length != 0 && length != count {
                let message = format!("{length} {what} for {count} vertices: give one a vertex, or none");
                return Err((None, message));
            }
        }
        if let Some(vertex) = self.normals.iter().position(|n| !n.is_finite()) {
            let n = self.normals[vertex];
            return at(vertex, format!("the normal of vertex {vertex} is {n}: normals must be finite"));
        }
        if let Some(vertex) = self.tangents.iter().position(|t| !t.is_finite()) {
            let t = self.tangents[vertex];
            return at(vertex, format!("the tangent of vertex {vertex} is {t}: tangents must be finite"));
        }
        for (target, morph) in self.morph_targets.iter().enumerate() {
            morph.check(target, count)?;
        }
        self.weights.check(count, joint_count)
    }
}
