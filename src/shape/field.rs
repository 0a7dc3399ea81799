//! What both modes' fields are: a point and how it is attached, to where it goes and the Jacobian there.
//!
//! Everything goes through one field: vertices, morph targets, joints, and any point a host attaches to a joint.

use super::paper::field::BoneField;
use super::product::binding::PartBinding;
use super::product::field::PartField;
use crate::face::FaceShape;
use crate::options::Stage;
use glam::{DMat3, DVec3};

/// A deformation of space around a body.
#[derive(Clone, Debug)]
pub enum Field {
    /// Product mode's fifteen parts.
    Parts(Box<PartField>),
    /// The paper's chain of bones.
    Bones(PaperField),
}

/// How a point is attached to the body.
#[derive(Clone, Debug, PartialEq)]
pub enum Binding {
    /// To parts.
    Parts(PartBinding),
    /// To bones.
    Bones(BoneBinding),
    /// Not at all: the point stays (the nodes above the hips).
    Fixed,
}

/// How a point is attached to the paper's bones.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct BoneBinding {
    /// w_ki by bone of the field.
    pub weights: Vec<(u16, f64)>,
    /// The weight of the head, by which the face map acts.
    pub head: f64,
    /// For hats and glasses: the point of the rest pose whose face map moves the whole piece.
    pub on_face: Option<DVec3>,
}

/// The paper's field with its face map.
#[derive(Clone, Debug)]
pub struct PaperField {
    /// Eqs. 5 and 8.
    pub bones: BoneField,
    /// How far to go.
    pub stage: Stage,
    /// Eqs. 12 and 13.
    pub face: FaceShape,
    /// 0 leaves everything where it is, 1 goes all the way.
    pub amount: f64,
    /// Added to all heights in the end.
    pub ground: f64,
}

impl PaperField {
    fn place(&self, p: DVec3, binding: &BoneBinding) -> DVec3 {
        let mut to = self.bones.displace(p, &binding.weights, self.stage);
        if binding.head > 0.0 && self.face != FaceShape::None {
            let from = match binding.on_face {
                Some(centre) => self.bones.displace(centre, &binding.weights, self.stage),
                None => to,
            };
            to += binding.head * (self.face.map(from).0 - from);
        }
        p + self.amount * (to - p) + DVec3::Y * self.ground
    }

    fn map(&self, p: DVec3, binding: &BoneBinding) -> (DVec3, DMat3) {
        let mut jacobian = self.bones.jacobian(p, &binding.weights, self.stage);
        if binding.head > 0.0 && self.face != FaceShape::None && binding.on_face.is_none() {
            let on_face = self.bones.displace(p, &binding.weights, self.stage);
            jacobian += (self.face.map(on_face).1 - DMat3::IDENTITY) * binding.head * jacobian;
        }
        let jacobian = DMat3::IDENTITY + (jacobian - DMat3::IDENTITY) * self.amount;
        (self.place(p, binding), jacobian)
    }
}

impl Field {
    /// Where `p` goes.
    pub fn place(&self, p: DVec3, binding: &Binding) -> DVec3 {
        match (self, binding) {
            (Field::Parts(field), Binding::Parts(binding)) => field.place(p, binding),
            (Field::Bones(field), Binding::Bones(binding)) => field.place(p, binding),
            _ => p,
        }
    }

    /// Where `p` goes, and the Jacobian there at fixed weights.
    pub fn map(&self, p: DVec3, binding: &Binding) -> (DVec3, DMat3) {
        match (self, binding) {
            (Field::Parts(field), Binding::Parts(binding)) => field.map(p, binding),
            (Field::Bones(field), Binding::Bones(binding)) => field.map(p, binding),
            _ => (p, DMat3::IDENTITY),
        }
    }

    /// Moves everything but what is fixed up by `shift`.
    pub fn set_ground(&mut self, shift: f64) {
        match self {
            Field::Parts(field) => field.set_ground(shift),
            Field::Bones(field) => field.ground = shift,
        }
    }

    /// Changes the face alone; nothing else is done again.
    pub fn set_face(&mut self, face: FaceShape) {
        match self {
            Field::Parts(field) => field.set_face(face),
            Field::Bones(field) => field.face = face,
        }
    }

    /// See [`Field::set_amount`].
    pub fn amount(&self) -> f64 {
        match self {
            Field::Parts(field) => field.amount(),
            Field::Bones(field) => field.amount,
        }
    }

    /// 0 leaves everything where it is, 1 goes all the way.
    pub fn set_amount(&mut self, amount: f64) {
        match self {
            Field::Parts(field) => field.set_amount(amount),
            Field::Bones(field) => field.amount = amount,
        }
    }
}
