//! Where the vertices go all the way, kept as floats: what is left for an apply is the same for all of them, and linear.
//!
//! The field of 64-bit numbers says where each vertex goes; what hangs on the vertex there (weights, slices, a younger face,
//! hair) changes only when the options do. So it is asked once for each change, for the vertices that the change can move,
//! and an apply reads a rest position and a displacement and writes a position: 36 bytes a vertex.

use super::Deformer;
use super::memo::View;
use crate::error::Result;
use crate::parallel;
use crate::shape::field::{Binding, Field, single};
use crate::shape::figure::Figure;
use crate::shape::placement::{Placement, is_of_head, renewed};
use glam::{DVec3, Vec3};
use std::sync::Arc;

/// How far the vertices go that the head's stages do not change; 0 for the others.
pub fn below_head(view: &View) -> Result<Vec<Vec3>> {
    let (measured, body, offsets) = (view.measured()?, view.body()?, view.offsets()?);
    let figure = &*measured.figure;
    let field = Field { finish: body.finish(figure, *view.whole()?), ..body.field.clone() };
    let placement = body.placement(figure, &field, &offsets, view.threads());
    let bindings = &body.bindings.vertices;
    Ok(parallel::collect(view.threads(), bindings.len(), parallel::FEW, |vertex| {
        if is_of_head(&bindings[vertex]) { Vec3::ZERO } else { displacement(&placement, vertex) }
    }))
}

/// How far everything goes all the way, before amount, ground and height.
#[derive(Debug)]
pub struct Displacements {
    /// The vertices, model space.
    pub vertices: Arc<Vec<Vec3>>,
    /// How much further each joint goes than the field takes it, canonical frame; empty where none does.
    pub joints: Vec<DVec3>,
}

/// How far every vertex goes.
pub fn all(view: &View) -> Result<Displacements> {
    let deformation = view.deformation()?;
    let placement = deformation.placement(&deformation.field, view.threads());
    let of_head = &placement.bindings.of_head;
    let mut vertices =
        renewed(view.threads(), view.below_head()?, of_head, |vertex| displacement(&placement, vertex));
    let frame = &placement.figure.frame;
    let way = |vertex: usize| frame.to_canonical(vertices[vertex].as_dvec3());
    let mut corrections = corrections(view, &placement, way)?;
    let joints = corrections.split_off(vertices.len().min(corrections.len()));
    for (vertex, correction) in Arc::make_mut(&mut vertices).iter_mut().zip(corrections) {
        *vertex += single(frame.to_model(correction));
    }
    Ok(Displacements { vertices, joints })
}

/// What makes the halves alike: added to the vertices, which go these ways, and then to the joints; canonical frame. Empty where
/// nothing is symmetric, and in paper mode.
fn corrections(view: &View, placement: &Placement, way: impl Fn(usize) -> DVec3) -> Result<Vec<DVec3>> {
    if view.body()?.parts().is_none() {
        return Ok(Vec::new());
    }
    let mirror = view.mirror()?;
    let Some(mirror) = &*mirror else { return Ok(Vec::new()) };
    let Figure { positions, joints, .. } = placement.figure;
    let mut all = mirror.corrections(|point| match point.checked_sub(positions.len()) {
        Some(joint) => placement.joint(joint) - joints[joint],
        None => way(point),
    });
    for (correction, binding) in all[positions.len()..].iter_mut().zip(&placement.bindings.joints) {
        if *binding == Binding::Fixed {
            *correction = DVec3::ZERO;
        }
    }
    Ok(all)
}

fn displacement(placement: &Placement, vertex: usize) -> Vec3 {
    let figure = placement.figure;
    single(figure.frame.to_model(placement.vertex(vertex) - figure.positions[vertex]))
}

impl Deformer {
    /// Where the field of 64-bit numbers takes the vertices, model space, mesh after mesh: what an apply is held to.
    #[doc(hidden)]
    pub fn field_positions(&self) -> Vec<DVec3> {
        let placement = self.placement();
        let mut positions = placement.all_vertices();
        let whole = self.deformation.placement(&self.deformation.field, 1);
        let way = |vertex: usize| whole.vertex(vertex) - placement.figure.positions[vertex];
        let corrections = corrections(&self.view(), &whole, way).unwrap_or_default();
        for (p, correction) in positions.iter_mut().zip(corrections) {
            *p += self.field.finish.share() * correction;
        }
        positions.into_iter().map(|p| placement.figure.frame.to_model(p)).collect()
    }
}
