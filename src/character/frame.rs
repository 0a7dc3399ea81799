//! The canonical frame: x towards the character's left, y up, z the way the face looks, in the units of the model.

use super::{Character, Role};
use crate::error::{Error, ErrorKind, Result};
use glam::{DMat3, DVec3, Mat3A};

/// Model space to the canonical frame: a rotation, or a mirrored one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    /// Rows are the character's left, up and forward in model space.
    to_canonical: DMat3,
}

impl Frame {
    /// The frame of `character`. Forward comes from its axes, else from the line between right and left limbs.
    ///
    /// # Errors
    /// `ErrorKind::NoHumanoid` where forward is neither given nor to be had from the joints.
    pub fn of(character: &Character) -> Result<Self> {
        let up = character.axes.up.as_dvec3().normalize();
        let forward = match character.axes.forward {
            Some(forward) => forward.as_dvec3().reject_from_normalized(up),
            None => {
                let position = |role| {
                    character.humanoid.joint(role).map(|joint| character.skeleton.joints[joint].position())
                };
                let mut left = DVec3::ZERO;
                for role in [Role::LeftUpperArm, Role::LeftUpperLeg] {
                    if let (Some(l), Some(r)) = (position(role), position(role.mirrored())) {
                        left += (l - r).reject_from_normalized(up).normalize_or_zero();
                    }
                }
                left.cross(up)
            }
        };
        let forward = forward.normalize_or_zero();
        if forward == DVec3::ZERO {
            let message = "the way the character looks cannot be told from its joints, as left and right limbs coincide along up: give it";
            return Err(Error::new(ErrorKind::NoHumanoid, message).about("forward"));
        }
        Ok(Self::new(up, forward))
    }

    /// The frame of a character that stands along `up` and looks along `forward`, which need not be at right angles to
    /// it but at an angle.
    pub fn new(up: DVec3, forward: DVec3) -> Self {
        let up = up.normalize();
        let forward = forward.reject_from_normalized(up).normalize();
        Self { to_canonical: DMat3::from_cols(up.cross(forward), up, forward).transpose() }
    }

    /// The same, x the other way: in left-handed axes the character's left is there.
    pub fn mirrored(self) -> Self {
        Self { to_canonical: DMat3::from_diagonal(DVec3::new(-1.0, 1.0, 1.0)) * self.to_canonical }
    }

    /// Model space to the canonical frame.
    pub fn to_canonical(&self, v: DVec3) -> DVec3 {
        self.to_canonical * v
    }

    /// The canonical frame to model space.
    pub fn to_model(&self, v: DVec3) -> DVec3 {
        self.to_canonical.transpose() * v
    }

    /// Model space to the canonical frame, for directions.
    pub fn rotation(&self) -> Mat3A {
        self.to_canonical.as_mat3().into()
    }

    /// A Jacobian of the canonical frame, in model space.
    pub fn jacobian_to_model(&self, jacobian: DMat3) -> DMat3 {
        self.to_canonical.transpose() * jacobian * self.to_canonical
    }
}
