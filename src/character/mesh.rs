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
    /// Checks target number `target` against the number of vertices; the error is the vertex and a sentence.
    pub(crate) fn validate(
        &self,
        target: usize,
        vertex_count: usize,
    ) -> std::result::Result<(), (Option<usize>, String)> {
        for (what, deltas, may_be_empty) in [
            ("position", &self.positions, false),
            ("normal", &self.normals, true),
            ("tangent", &self.tangents, true),
        ] {
            if deltas.len() != vertex_count && !(may_be_empty && deltas.is_empty()) {
                return Err((
                    None,
                    format!(
                        "morph target {target} ({}) has {} {what} deltas for {vertex_count} vertices: give one a vertex",
                        Named(&self.name),
                        deltas.len()
                    ),
                ));
            }
            if let Some(vertex) = deltas.iter().position(|d| !d.is_finite()) {
                return Err((
                    Some(vertex),
                    format!(
                        "morph target {target} ({}) moves the {what} of vertex {vertex} by {}: deltas must be finite",
                        Named(&self.name),
                        deltas[vertex]
                    ),
                ));
            }
        }
        Ok(())
    }
}

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
        let place = place(index, &self.name);
        let bad = |element: Option<Element>, message: String| {
            let error = Error::new(ErrorKind::BadInput, format!("{place}: {message}")).in_mesh(index);
            Err(Error { element, ..error })
        };
        let count = self.positions.len();
        for (vertex, p) in self.positions.iter().enumerate() {
            if !p.is_finite() {
                return bad(
                    Some(Element::Vertex(vertex)),
                    format!("vertex {vertex} is at {p}: positions must be finite numbers"),
                );
            }
        }
        for (triangle, corners) in self.triangles.iter().enumerate() {
            if let Some(vertex) = corners.iter().find(|&&vertex| vertex as usize >= count) {
                return bad(
                    Some(Element::Triangle(triangle)),
                    format!(
                        "triangle {triangle} uses vertex {vertex}, but the mesh has {count} vertices: give indices from 0 to that less 1"
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
                Some(Element::Vertex(vertex)),
                format!("the normal of vertex {vertex} is {}: normals must be finite", self.normals[vertex]),
            );
        }
        if let Some(vertex) = self.tangents.iter().position(|t| !t.is_finite()) {
            return bad(
                Some(Element::Vertex(vertex)),
                format!(
                    "the tangent of vertex {vertex} is {}: tangents must be finite",
                    self.tangents[vertex]
                ),
            );
        }
        for (target, morph) in self.morph_targets.iter().enumerate() {
            morph
                .validate(target, count)
                .or_else(|(vertex, message)| bad(vertex.map(Element::Vertex), message))?;
        }
        self.weights
            .validate(count, joint_count)
            .or_else(|(vertex, message)| bad(vertex.map(Element::Vertex), message))
    }
}
