//! What a character is (§III, §IV-A): meshes, joints, weights and the humanoid roles of its joints.

pub mod bones;
pub mod face_hints;
pub mod frame;
pub mod humanoid;
pub mod kinds;
pub mod mesh;
pub(crate) mod mesh_list;
pub mod naming;
pub mod roles;
pub mod shade;
pub mod skeleton;
pub mod tree_roles;
pub mod weights;

use crate::error::{Element, Error, ErrorKind, Result};
pub use face_hints::{EyeHint, FaceHints};
pub use frame::Frame;
use glam::Vec3;
pub use humanoid::{Humanoid, Role};
pub use kinds::MeshKind;
pub use mesh::{Mesh, MorphTarget};
pub use shade::{GreyImage, Shade};
pub use skeleton::{Joint, Skeleton};
pub use weights::Weights;

/// Which way a character stands and looks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Axes {
    /// From the feet to the head; any length but 0.
    pub up: Vec3,
    /// False where nobody said how the character stands: a rig is then made for the way in which it stands as people
    /// do, and `up` is only what is tried first.
    pub up_is_known: bool,
    /// The way the face looks; `None` finds it from the joints: at right angles to `up` and to the line
    /// from the right limbs to the left ones (right-handed axes).
    pub forward: Option<Vec3>,
}

impl Default for Axes {
    /// Y up unless an unrigged character stands another way, forward found from the joints.
    fn default() -> Self {
        Self { up: Vec3::Y, up_is_known: false, forward: None }
    }
}

/// A character in rest pose: everything in one space ("model space"), in any unit.
///
/// Vertices are where the rest pose puts them, so a vertex weighted wholly to a joint moves rigidly with it.
#[derive(Clone, Debug, Default)]
pub struct Character {
    /// Meshes; a character may have any number.
    pub meshes: Vec<Mesh>,
    /// All joints, including those without a humanoid role.
    pub skeleton: Skeleton,
    /// Which joint plays which humanoid role.
    pub humanoid: Humanoid,
    /// Which way it stands and looks.
    pub axes: Axes,
    /// Where its eyes are, where the host knows better than the geometry tells.
    pub face_hints: FaceHints,
}

impl Character {
    /// Checks every array against every other.
    ///
    /// # Errors
    /// `ErrorKind::BadInput` names the first mesh and element at fault, its value and the remedy.
    pub fn validate(&self) -> Result<()> {
        let bad = |message: String| Error::new(ErrorKind::BadInput, message);
        let Axes { up, forward, .. } = self.axes;
        if !up.is_finite() || up.length_squared() == 0.0 {
            return Err(bad(format!("up is {up}: give a direction of finite length above 0")));
        }
        if let Some(forward) = forward {
            let across = forward.reject_from(up);
            if !forward.is_finite() || across.length_squared() <= 1e-6 * forward.length_squared() {
                return Err(bad(format!("forward is {forward}: give a direction at an angle to up ({up})")));
            }
        }
        self.face_hints.validate()?;
        self.skeleton.validate()?;
        let joint_count = self.skeleton.joints.len();
        if let Some((role, joint)) = self.humanoid.iter().find(|&(_, joint)| joint >= joint_count) {
            let message = format!(
                "role {role} names joint {joint}, but there are {joint_count} joints: name one of them"
            );
            return Err(bad(message).at(Element::Joint(joint)));
        }
        for (index, mesh) in self.meshes.iter().enumerate() {
            mesh.validate(index, joint_count)?;
        }
        Ok(())
    }

    /// Vertices of all meshes together.
    pub fn vertex_count(&self) -> usize {
        self.meshes.iter().map(|mesh| mesh.positions.len()).sum()
    }

    /// Triangles of all meshes together.
    pub fn triangle_count(&self) -> usize {
        self.meshes.iter().map(|mesh| mesh.triangles.len()).sum()
    }
}
