//! Where the vertices go all the way, kept as floats: what is left for an apply is the same for all of them, and linear.
//!
//! The field of 64-bit numbers says where each vertex goes; what hangs on the vertex there (weights, slices, a younger face,
//! hair) changes only when the options do. So it is asked once for each change, for the vertices that the change can move,
//! and an apply reads a rest position and a displacement and writes a position: 36 bytes a vertex.

use super::Deformer;
use super::attach::{LEAST_VERTICES, Placement, renewed};
use super::hair::Laid;
use super::morphs::Shifts;
use super::young::is_one;
use crate::character::Frame;
use crate::face::FaceShape;
use crate::face::seat::{Seat, SeatAmount};
use crate::face::stage::YoungFace;
use crate::parallel;
use crate::shape::field::{Field, Finish};
use glam::{DVec3, Vec3};
use std::sync::Arc;

/// How far each vertex goes all the way, model space, before amount, ground and height.
#[derive(Clone, Debug)]
pub struct Displacements {
    of: Arc<Vec<Vec3>>,
    head: HeadStages,
}

impl Displacements {
    /// One for each vertex of the figure.
    pub fn all(&self) -> &[Vec3] {
        &self.of
    }
}

/// What the displacements of the head's vertices are made of, beside the body's field.
#[derive(Clone, Debug)]
struct HeadStages {
    squash: FaceShape,
    young: Option<Arc<YoungFace>>,
    youth: f64,
    seat: Option<Arc<Seat>>,
    seat_amount: SeatAmount,
    hair: Option<Arc<Laid>>,
}

impl HeadStages {
    fn of(deformer: &Deformer) -> Self {
        let Field { young, youth, seat, seat_amount, finish, .. } = &deformer.field;
        Self {
            squash: finish.face,
            young: young.clone(),
            youth: *youth,
            seat: seat.clone(),
            seat_amount: *seat_amount,
            hair: deformer.hair.clone(),
        }
    }

    fn is_same(&self, other: &Self) -> bool {
        self.squash == other.squash
            && is_one(&self.young, &other.young)
            && self.youth == other.youth
            && is_one(&self.seat, &other.seat)
            && self.seat_amount == other.seat_amount
            && is_one(&self.hair, &other.hair)
    }
}

impl Deformer {
    /// Where the field of 64-bit numbers takes the vertices, model space, mesh after mesh: what an apply is held to.
    #[doc(hidden)]
    pub fn field_positions(&self) -> Vec<DVec3> {
        let placement = self.placement();
        placement.all_vertices().into_iter().map(|p| placement.figure.frame.to_model(p)).collect()
    }

    /// Asks the field where the vertices go that this change of options can move.
    pub(super) fn finish_displacements(&mut self) {
        let head = HeadStages::of(self);
        let known = self.displacements.take();
        if !known.as_ref().is_some_and(|known| known.head.is_same(&head)) {
            self.morph_shifts = Shifts::default();
        }
        let field = Field { finish: self.field.finish.all_the_way(), ..self.field.clone() };
        let placement = Placement { field: &field, ..self.placement() };
        let figure = placement.figure;
        let displacement = |vertex: usize| {
            single(figure.frame.to_model(placement.vertex(vertex) - figure.positions[vertex]))
        };
        let threads = self.options.thread_count;
        let of = match known {
            Some(known) if known.head.is_same(&head) => known.of,
            Some(known) => renewed(threads, known.of, &placement.bindings.of_head, displacement),
            None => {
                let count = figure.positions.len();
                Arc::new(parallel::collect(threads, count, LEAST_VERTICES, displacement))
            }
        };
        self.displacements = Some(Displacements { of, head });
    }
}

/// What is done last, for a vertex at `p` whose displacement is `d`: p + ((size - 1) (p - about) + size (amount d + ground)).
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
            share: (finish.size * finish.amount) as f32,
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
