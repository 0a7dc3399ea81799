//! Hair that hangs below the chin: shorter with the body, laid down on it, parted before the eyes, and outside of it.

use super::head_stages::{frame_after, growth, head_map};
use super::memo::View;
use crate::error::Result;
use crate::shape::field::{Binding, BodyField, Field, Finish};
use crate::shape::product::hanging::Hanging;
use crate::shape::product::part::Part;
use crate::shape::product::parting::Parting;
use glam::DVec3;

/// Hair as it hangs in the end.
#[derive(Debug)]
pub struct Hair {
    /// What is added to each vertex.
    pub offsets: Vec<DVec3>,
    /// What is added to each joint.
    pub joint_offsets: Vec<DVec3>,
    /// How far each joint of hair goes beyond where the head takes it.
    joints: Vec<Option<DVec3>>,
    field: Field,
}

impl Hair {
    /// What is added to a point that was at `rest` and moves with `joint`, before the amount.
    pub fn offset(&self, binding: &Binding, joint: usize, rest: DVec3) -> DVec3 {
        let (Some(all), BodyField::Parts(parts)) = (self.joints[joint], &*self.field.body) else {
            return DVec3::ZERO;
        };
        let beyond_head = self.field.place(rest, binding) - parts.place_head_alone(rest);
        f64::from(binding.weight(Part::Hair)) * (all - beyond_head)
    }
}

/// How hair hangs on the body, before the head's own stages; `None` where none hangs, and in paper mode.
pub fn hanging(view: &View) -> Result<Option<Hanging>> {
    let body = view.body()?;
    let Some(parts) = body.parts() else { return Ok(None) };
    let strands = view.strands()?;
    Ok(strands.as_ref().as_ref().map(|strands| Hanging::of(strands, parts, view.options.hair_length)))
}

/// What is added to each vertex before the head's own stages: to clothes what keeps them out of the body, to hair what makes it
/// shorter; empty where nothing is.
pub fn offsets(view: &View) -> Result<Vec<DVec3>> {
    let count = view.measured()?.figure.positions.len();
    let mut all = view.pushed()?.dense(count);
    if let (Some(strands), Some(hanging)) = (view.strands()?.as_ref(), view.hanging()?.as_ref()) {
        all.resize(count, DVec3::ZERO);
        strands.add(&mut all, |place| hanging.short[place]);
    }
    Ok(all)
}

/// Hair in the end; `None` where none hangs below the chin.
pub fn hair(view: &View) -> Result<Option<Hair>> {
    let (strands, hanging, body) = (view.strands()?, view.hanging()?, view.body()?);
    let (Some(strands), Some(hanging), Some(parts)) = (strands.as_ref(), hanging.as_ref(), body.parts())
    else {
        return Ok(None);
    };
    let (measured, options, vertices) = (view.measured()?, &view.options, &strands.worn.vertices);
    let lay = growth(view)? * options.hair_lay;
    // Before amount, whole and ground, as all of the head's stages.
    let finish = Finish { face: view.face()?.shape, ..Finish::default() };
    let field = Field { finish, ..(*view.field()?).clone() };
    let mut offsets = view.pushed()?.dense(measured.figure.positions.len());
    let placement = body.placement(&measured.figure, &field, &offsets, view.threads());
    let mut after = placement.all_vertices();
    let at_rest = |vertex: u32| measured.figure.positions[vertex as usize];
    let heads: Vec<DVec3> = vertices.iter().map(|&vertex| parts.place_head_alone(at_rest(vertex))).collect();
    // What is hair in part goes as hair would.
    let as_hair = Binding::to(Part::Hair);
    let moved: Vec<DVec3> = (vertices.iter().zip(&heads))
        .map(|(&vertex, &head)| match placement.bindings.vertices[vertex as usize].weight(Part::Hair) {
            1.0 => after[vertex as usize] - head,
            _ => field.place(at_rest(vertex), &as_hair) - head,
        })
        .collect();
    let mut parted = moved.clone();
    if let (Some(sides), true) = (&strands.sides, lay > 0.0)
        && let Some(frame) = frame_after(&body, &measured)
        && let Some(face) = &measured.face
        && let Some(eyes) = face.mapped(head_map(&measured, &field, frame)).pair()
    {
        let middle = frame.to_unit(field.place(measured.anatomy.head_centre, &Binding::to(Part::Head)));
        let points: Vec<DVec3> =
            vertices.iter().map(|&vertex| frame.to_unit(after[vertex as usize])).collect();
        let parting = Parting::new(&points, middle, eyes);
        for ((parted, &p), &side) in parted.iter_mut().zip(&points).zip(sides) {
            *parted += frame.length * (parting.place(p, side, lay) - p);
        }
    }
    let mut all = hanging.all(strands, lay, &parted);
    let points: Vec<DVec3> = heads.iter().zip(&all).map(|(&head, &all)| head + all).collect();
    for (&vertex, &point) in vertices.iter().zip(&points) {
        after[vertex as usize] = point;
    }
    let layer = hanging.layer(strands, parts.after().sole);
    view.part(0.5, 0.5, |_| Ok(()))?;
    let pushes = strands.worn.kept_outside(points, &after, &measured.weld, &layer, view.threads())?;
    for (all, push) in all.iter_mut().zip(pushes.into_iter().flatten()) {
        *all += push;
    }
    offsets.resize(after.len(), DVec3::ZERO);
    strands.add(&mut offsets, |place| all[place] - moved[place]);
    let joints: Vec<Option<DVec3>> = (strands.joints.iter())
        .map(|places| {
            let sum = places.iter().map(|&(place, share)| share * all[place as usize]).sum();
            (!places.is_empty()).then_some(sum)
        })
        .collect();
    let mut hair = Hair { offsets, joint_offsets: Vec::new(), joints, field };
    let bound = body.bindings.joints.iter().zip(&measured.figure.joints).enumerate();
    hair.joint_offsets = bound.map(|(joint, (binding, &rest))| hair.offset(binding, joint, rest)).collect();
    Ok(Some(hair))
}
