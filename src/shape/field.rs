//! What both modes' fields are: a point and how it is attached, to where it goes and the Jacobian there.
//!
//! Everything goes through one field: vertices, morph targets, joints, and any point a host attaches to a joint. A field
//! is a chain of stages, each a map of the place that the one before gives, at a binding that stays; Jacobians multiply
//! ([`Mapped::then`]). What is done last is the same in both modes: [`Finish`].

use super::paper::bone_field::{BoneBinding, PaperField};
use super::product::binding::PartBinding;
use super::product::part::Part;
use super::product::parts_field::PartField;
use crate::character::Frame;
use crate::face::FaceShape;
use crate::face::seat::Seat;
use crate::face::stage::{FaceBinding, YoungFace};
use crate::geometry::{Mapped, Moved};
use glam::{DMat3, DVec3, Vec3};
use std::sync::Arc;

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

impl Binding {
    /// To one part alone.
    pub fn to(part: Part) -> Self {
        Self::Parts(PartBinding::to(part))
    }

    /// The binding to parts; `None` in paper mode, and for what stays.
    pub fn parts(&self) -> Option<&PartBinding> {
        match self {
            Self::Parts(binding) => Some(binding),
            _ => None,
        }
    }

    /// The weight of `part`.
    pub fn weight(&self, part: Part) -> f32 {
        self.parts().map_or(0.0, |binding| binding.weights[part as usize])
    }

    /// The weight of both arms and hands.
    pub fn arms_weight(&self) -> f32 {
        let arms =
            |binding: &PartBinding| binding.weights[Part::LeftUpperArm as usize..].iter().take(6).sum();
        self.parts().map_or(0.0, arms)
    }

    /// How much of the face map it takes, 0 to 1; what keeps its shape takes that of its middle, which is at rest there.
    pub fn of_face(&self) -> (f64, Option<DVec3>) {
        match self {
            Self::Parts(binding) => binding.of_face(),
            Self::Bones(binding) => (binding.head, binding.on_face),
            Self::Fixed => (0.0, None),
        }
    }

    /// See [`PartBinding::of_head_and_neck`].
    pub fn of_head_and_neck(&self) -> f64 {
        self.parts().map_or(0.0, PartBinding::of_head_and_neck)
    }
}

/// What gives the body its shape, all the way and with the face that is asked for.
#[derive(Debug)]
pub enum BodyField {
    /// Product mode's parts.
    Parts(Box<PartField>),
    /// The paper's chain of bones.
    Bones(PaperField),
}

/// What is done after the body: the face map, how far to go, and where the ground is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Finish {
    /// Eqs. 12 and 13.
    pub face: FaceShape,
    /// All the way, the body is this many times as large as its field makes it.
    pub whole: f64,
    /// 0 leaves everything where it is, 1 goes all the way.
    pub amount: f64,
    /// Added to all heights in the end.
    pub ground: f64,
    /// Then everything grows by this.
    pub size: f64,
    /// What stays where it is when everything grows or shrinks.
    pub about: DVec3,
}

impl Default for Finish {
    /// All the way, without a younger face, from where the field puts the ground.
    fn default() -> Self {
        Self { face: FaceShape::None, whole: 1.0, amount: 1.0, ground: 0.0, size: 1.0, about: DVec3::ZERO }
    }
}

impl Finish {
    /// Part of the way from `p` to where the body's field takes it.
    #[inline(always)]
    fn apply<M: Moved>(&self, p: DVec3, to: M) -> M {
        let to = self.grown(to, self.whole);
        // Written so that amount 0 gives p itself, bit for bit.
        let position = p + self.amount * (to.position() - p) + DVec3::Y * self.ground;
        let jacobian = || DMat3::IDENTITY + (to.jacobian() - DMat3::IDENTITY) * self.amount;
        self.grown(M::of(position, jacobian), self.size)
    }

    #[inline(always)]
    fn grown<M: Moved>(&self, to: M, size: f64) -> M {
        if size == 1.0 {
            return to;
        }
        M::of(self.about + size * (to.position() - self.about), || to.jacobian() * size)
    }

    /// How much of the whole way is left.
    pub fn share(&self) -> f64 {
        self.size * self.amount
    }

    /// How much of an offset is left that is added to where the body's field takes a point.
    pub fn share_of_offsets(&self) -> f64 {
        self.share() * self.whole
    }

    /// True where everything stays.
    pub fn is_nothing(&self) -> bool {
        self.amount == 0.0 && self.size == 1.0
    }
}

/// What a [`Finish`] does, as floats, to a vertex at `p` whose displacement is `d`:
/// p + ((size - 1) (p - about) + size (amount d + ground)).
///
/// Written so that nothing as large as `p` is rounded twice: far from the origin only the sum is.
#[derive(Clone, Copy, Debug)]
pub struct Ending {
    /// size - 1.
    grows: f32,
    about: Vec3,
    /// amount size.
    share: f32,
    /// The ground's shift, size times.
    lift: Vec3,
}

impl Ending {
    /// As `finish` says, in the model space of `frame`.
    pub fn of(finish: &Finish, frame: &Frame) -> Self {
        Self {
            grows: (finish.size - 1.0) as f32,
            about: single(frame.to_model(finish.about)),
            share: finish.share() as f32,
            lift: single(frame.to_model(DVec3::Y * (finish.size * finish.ground))),
        }
    }

    /// Where a vertex ends.
    #[inline(always)]
    pub fn place(&self, p: Vec3, displacement: Vec3) -> Vec3 {
        let to = p + (self.grows * (p - self.about) + (self.share * displacement + self.lift));
        // What lies beyond the range of floats, which takes a model of over 1e30 units, ends there instead of at infinity.
        to.clamp(Vec3::splat(f32::MIN), Vec3::splat(f32::MAX))
    }
}

/// As floats; what lies beyond their range ends there.
pub fn single(p: DVec3) -> Vec3 {
    p.clamp(DVec3::splat(f32::MIN.into()), DVec3::splat(f32::MAX.into())).as_vec3()
}

/// A deformation of space around a body.
#[derive(Clone, Debug)]
pub struct Field {
    /// What gives the body its shape.
    pub body: Arc<BodyField>,
    /// What makes the face younger, beyond Eqs. 12 and 13.
    pub young: Option<Arc<YoungFace>>,
    /// How far along it goes, 0 to 1.
    pub youth: f64,
    /// How the head sits over the chest.
    pub seat: Option<Arc<Seat>>,
    /// How much of that is done, 0 to 1.
    pub seat_amount: f64,
    /// What is done last.
    pub finish: Finish,
}

impl Field {
    /// The field of `body`, all the way.
    pub fn of(body: Arc<BodyField>) -> Self {
        Self { body, young: None, youth: 0.0, seat: None, seat_amount: 0.0, finish: Finish::default() }
    }

    /// Product mode's parts; `None` in paper mode.
    pub fn parts(&self) -> Option<&PartField> {
        match &*self.body {
            BodyField::Parts(parts) => Some(parts),
            BodyField::Bones(_) => None,
        }
    }

    /// Where `p` goes.
    pub fn place(&self, p: DVec3, binding: &Binding) -> DVec3 {
        self.place_from(p, self.place_body(p, binding), binding, None)
    }

    /// As [`Self::place`], for a point, which may be a vertex, that is at `p` and that the body's field takes to `placed`.
    pub fn place_from(&self, p: DVec3, placed: DVec3, binding: &Binding, vertex: Option<usize>) -> DVec3 {
        let squashed = self.squash(placed, binding);
        let to = match binding {
            Binding::Parts(binding) => {
                let to = match &self.young {
                    Some(young) if binding.face != FaceBinding::None => {
                        young.place(squashed, binding.face, self.youth, vertex)
                    }
                    _ => squashed,
                };
                match &self.seat {
                    Some(seat) => seat.place(to, self.seat_amount * binding.of_head_and_neck()),
                    None => to,
                }
            }
            Binding::Bones(_) => squashed,
            Binding::Fixed => return p,
        };
        self.finish.apply(p, to)
    }

    /// Where the body's field alone takes `p`.
    pub fn place_body(&self, p: DVec3, binding: &Binding) -> DVec3 {
        match (&*self.body, binding) {
            (BodyField::Parts(field), Binding::Parts(binding)) => field.place(p, binding),
            (BodyField::Bones(field), Binding::Bones(binding)) => field.place(p, binding),
            _ => p,
        }
    }

    /// How much `p` takes part where the face step opens lids more than the ball between them grows, 0 to 1.
    pub fn opens_lids(&self, p: DVec3, binding: &Binding) -> f64 {
        match (&self.young, binding) {
            (Some(young), Binding::Parts(PartBinding { face: FaceBinding::Skin(_), .. })) => {
                young.opens_lids(self.squash(self.place_body(p, binding), binding))
            }
            _ => 0.0,
        }
    }

    /// The head's first row: where the face map (Eqs. 12 and 13) takes what the body's field takes `to`.
    pub fn squash<M: Moved>(&self, to: M, binding: &Binding) -> M {
        if self.finish.face == FaceShape::None {
            return to;
        }
        let (share, middle) = binding.of_face();
        self.finish.face.apply(to, share, middle.map(|middle| self.place_body(middle, binding)))
    }

    /// Where `p` goes, and the Jacobian there at fixed weights.
    pub fn map(&self, p: DVec3, binding: &Binding) -> Mapped {
        let to = match (&*self.body, binding) {
            (BodyField::Parts(field), Binding::Parts(parts)) => {
                let to = self.squash(field.map(p, parts), binding);
                let to = match &self.young {
                    Some(young) => to.then(|to| young.map(to, parts.face, self.youth)),
                    None => to,
                };
                match &self.seat {
                    Some(seat) => to.then(|to| seat.map(to, self.seat_amount * parts.of_head_and_neck())),
                    None => to,
                }
            }
            (BodyField::Bones(field), Binding::Bones(bones)) => self.squash(field.map(p, bones), binding),
            _ => return Mapped::unmoved(p),
        };
        self.finish.apply(p, to)
    }
}
