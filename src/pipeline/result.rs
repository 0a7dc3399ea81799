//! What comes out: what changed of a character, in the input's order and space.

use crate::character::{Character, MorphTarget};
use glam::{DVec3, Vec3, Vec4};

/// One mesh as it came out; arrays the input lacked are empty here too.
#[derive(Clone, Debug, Default)]
pub struct DeformedMesh {
    /// New rest positions, model space.
    pub positions: Vec<Vec3>,
    /// New unit normals.
    pub normals: Vec<Vec3>,
    /// New unit tangents; `w` is kept.
    pub tangents: Vec<Vec4>,
    /// New morph deltas, in the input's order.
    pub morph_targets: Vec<MorphTarget>,
}

/// A super-deformed character: what changed, in the input's order and space.
#[derive(Clone, Debug, Default)]
pub struct Deformed {
    /// One for each input mesh.
    pub meshes: Vec<DeformedMesh>,
    /// Where each joint of the input's skeleton is now, model space. Joints move and do not turn or scale:
    /// the new rest transform is the old one with this translation.
    pub joints: Vec<DVec3>,
}

/// What is asked of one mesh beside its positions. What is not is left empty, and costs nothing.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct MeshOutputs {
    /// Normals.
    pub normals: bool,
    /// Tangents.
    pub tangents: bool,
    /// Morph targets: positions, normals and tangents.
    pub morph_targets: bool,
}

impl MeshOutputs {
    /// Everything that the mesh has.
    pub const ALL: Self = Self { normals: true, tangents: true, morph_targets: true };
}

impl Character {
    /// The same character as `deformed` leaves it.
    pub fn with(&self, deformed: &Deformed) -> Character {
        let mut character = self.clone();
        for (mesh, new) in character.meshes.iter_mut().zip(&deformed.meshes) {
            mesh.positions.clone_from(&new.positions);
            mesh.normals.clone_from(&new.normals);
            mesh.tangents.clone_from(&new.tangents);
            mesh.morph_targets.clone_from(&new.morph_targets);
        }
        for (joint, &position) in character.skeleton.joints.iter_mut().zip(&deformed.joints) {
            joint.rest.w_axis = position.extend(1.0);
        }
        character
    }
}
