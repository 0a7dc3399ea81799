//! Where the vertices go all the way, kept as floats: what is left for an apply is the same for all of them, and linear.
//!
//! The field of 64-bit numbers says where each vertex goes; what hangs on the vertex there (weights, slices, a younger face,
//! hair) changes only when the options do. So it is asked once for each change, for the vertices that the change can move,
//! and an apply reads a rest position and a displacement and writes a position: 36 bytes a vertex.

use super::Deformer;
use super::memo::View;
use crate::character::{Character, Frame};
use crate::error::Result;
use crate::parallel;
use crate::shape::field::{Field, Finish};
use crate::shape::placement::{Placement, renewed};
use glam::{DVec3, Vec3};
use std::sync::Arc;

/// How far the vertices go that the head's stages do not change; 0 for the others.
pub fn below_head(view: &View) -> Result<Vec<Vec3>> {
    let (measured, body, offsets) = (view.measured()?, view.body()?, view.offsets()?);
    let figure = &*measured.figure;
    let field = Field { finish: body.finish(figure, *view.whole()?), ..body.field() };
    let placement = body.placement(figure, &field, &body.placed, view.threads());
    let placement = Placement { hair_offsets: &offsets, ..placement };
    let is_of_head = body.bindings.is_of_head();
    Ok(parallel::collect(view.threads(), is_of_head.len(), parallel::FEW, |vertex| {
        if is_of_head[vertex] { Vec3::ZERO } else { displacement(&placement, vertex) }
    }))
}

/// How far every vertex goes.
pub fn all(view: &View) -> Result<Arc<Vec<Vec3>>> {
    let deformation = view.deformation()?;
    let placement = deformation.placement(&deformation.field, view.threads());
    let of_head = &placement.bindings.of_head;
    Ok(renewed(view.threads(), view.below_head()?, of_head, |vertex| displacement(&placement, vertex)))
}

fn displacement(placement: &Placement, vertex: usize) -> Vec3 {
    let figure = placement.figure;
    single(figure.frame.to_model(placement.vertex(vertex) - figure.positions[vertex]))
}

/// Where the vertices of `character` go, model space, mesh after mesh.
pub fn positions<'a>(
    character: &'a Character,
    displacements: &'a [Vec3],
    ending: Ending,
) -> impl Iterator<Item = Vec3> + 'a {
    let rest = character.meshes.iter().flat_map(|mesh| &mesh.positions);
    rest.zip(displacements).map(move |(&p, &displacement)| ending.place(p, displacement))
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

impl Deformer {
    /// Where the field of 64-bit numbers takes the vertices, model space, mesh after mesh: what an apply is held to.
    #[doc(hidden)]
    pub fn field_positions(&self) -> Vec<DVec3> {
        let placement = self.placement();
        placement.all_vertices().into_iter().map(|p| placement.figure.frame.to_model(p)).collect()
    }
}
