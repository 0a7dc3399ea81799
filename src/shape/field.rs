//! What both modes' fields are: a point and how it is attached, to where it goes and the Jacobian there.
//!
//! Everything goes through one field: vertices, morph targets, joints, and any point a host attaches to a joint.

use super::part_weights::PartBinding;
use super::parts::PartField;
use glam::{DMat3, DVec3};

/// A deformation of space around a body.
#[derive(Clone, Debug)]
pub enum Field {
    /// Product mode's fifteen parts.
    Parts(PartField),
}

/// How a point is attached to the body.
#[derive(Clone, Debug, PartialEq)]
pub enum Binding {
    /// To parts.
    Parts(PartBinding),
    /// Not at all: the point stays (the nodes above the hips).
    Fixed,
}

impl Field {
    /// Where `p` goes, and the Jacobian there at fixed weights.
    pub fn map(&self, p: DVec3, binding: &Binding) -> (DVec3, DMat3) {
        match (self, binding) {
            (Field::Parts(field), Binding::Parts(binding)) => field.map(p, binding),
            _ => (p, DMat3::IDENTITY),
        }
    }

    /// Moves everything but what is fixed up by `shift`.
    pub fn set_ground(&mut self, shift: f64) {
        match self {
            Field::Parts(field) => field.set_ground(shift),
        }
    }
}
