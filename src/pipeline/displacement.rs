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
use crate::shape::Measured;
use crate::shape::field::{Field, Finish};
use crate::shape::product::turned::Triangles;
use glam::{DVec3, Vec3};
use std::sync::Arc;

/// How far each vertex goes all the way, model space, before amount, ground and height.
#[derive(Clone, Debug)]
pub struct Displacements {
    of: Arc<Vec<Vec3>>,
    head: HeadStages,
    righted: Arc<Righted>,
}

/// Vertices that were moved on so that triangles which the field turns over, but nearly not, look where they looked.
#[derive(Debug, Default)]
struct Righted {
    /// Ascending; what was added to each, canonical frame, before amount and size.
    offsets: Vec<(u32, DVec3)>,
    /// What their displacements were without it.
    plain: Vec<Vec3>,
    asked: Arc<Asked>,
}

/// Triangles by what can turn them.
#[derive(Debug, Default)]
struct Asked {
    /// With a vertex of the head.
    of_head: Vec<u32>,
    /// Without one: those that the body's field turns over, but nearly not.
    below_head: Vec<u32>,
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
        let mut positions = placement.all_vertices();
        let finish = self.field.finish;
        for &(vertex, offset) in self.displacements.iter().flat_map(|all| &all.righted.offsets) {
            positions[vertex as usize] += finish.size * finish.amount * offset;
        }
        positions.into_iter().map(|p| placement.figure.frame.to_model(p)).collect()
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
        let (mut of, asked) = match known {
            Some(known) if known.head.is_same(&head) => {
                self.displacements = Some(known);
                return;
            }
            Some(Displacements { mut of, righted, .. }) => {
                if !righted.offsets.is_empty() {
                    let of = Arc::make_mut(&mut of);
                    for (&(vertex, _), &plain) in righted.offsets.iter().zip(&righted.plain) {
                        of[vertex as usize] = plain;
                    }
                }
                let of = renewed(threads, of, &placement.bindings.of_head, displacement);
                (of, Some(Arc::clone(&righted.asked)))
            }
            None => {
                let count = figure.positions.len();
                (Arc::new(parallel::collect(threads, count, LEAST_VERTICES, displacement)), None)
            }
        };
        let righted = self.righted(&mut of, asked);
        self.displacements = Some(Displacements { of, head, righted: Arc::new(righted) });
    }

    /// Puts right, in the displacements `of`, triangles that are nearly right.
    ///
    /// `asked`: what the head's stages do not change, where it is known.
    fn righted(&self, of: &mut Arc<Vec<Vec3>>, asked: Option<Arc<Asked>>) -> Righted {
        // The paper's equations stay to the letter.
        if self.deformation.product.is_none() {
            return Righted::default();
        }
        let threads = self.options.thread_count;
        let Measured { figure, weld, .. } = &*self.target.measured;
        let (offsets, asked) = {
            let of = &**of;
            let after =
                |vertex: usize| figure.positions[vertex] + figure.frame.to_canonical(of[vertex].as_dvec3());
            let triangles = Triangles {
                rest: &figure.positions,
                after,
                corners: &figure.triangles,
                weld,
                height: figure.height(),
            };
            let asked = asked.unwrap_or_else(|| {
                let (of_head, below) = self.triangles_of_head();
                Arc::new(Asked { of_head, below_head: triangles.nearly_right(&below, threads) })
            });
            let mut wrong = triangles.nearly_right(&asked.of_head, threads);
            wrong.extend(&asked.below_head);
            wrong.sort_unstable();
            (triangles.righted(&wrong), asked)
        };
        if offsets.is_empty() {
            return Righted { asked, ..Righted::default() };
        }
        let of = Arc::make_mut(of);
        let plain = offsets
            .iter()
            .map(|&(vertex, offset)| {
                let displacement = &mut of[vertex as usize];
                let plain = *displacement;
                *displacement = single(plain.as_dvec3() + figure.frame.to_model(offset));
                plain
            })
            .collect();
        Righted { offsets, plain, asked }
    }

    /// The triangles with a vertex of the head, and those without.
    fn triangles_of_head(&self) -> (Vec<u32>, Vec<u32>) {
        let figure = &self.target.measured.figure;
        let mut is_of_head = vec![false; figure.positions.len()];
        for &vertex in &*self.deformation.bindings.of_head {
            is_of_head[vertex as usize] = true;
        }
        let touches = |&triangle: &u32| {
            figure.triangles[triangle as usize].iter().any(|&corner| is_of_head[corner as usize])
        };
        (0..figure.triangles.len() as u32).partition(touches)
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
