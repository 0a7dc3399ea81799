//! Hair that hangs below the chin: shorter with the body, laid down on it, parted before the eyes, and outside of it.

use super::head::{frame_after, growth};
use super::memo::View;
use crate::error::Result;
use crate::face::eyes::Pair;
use crate::face::head::HeadFrame;
use crate::options::Stage;
use crate::shape::Measured;
use crate::shape::field::{Binding, BodyField, Field};
use crate::shape::placement::{Body, Placement};
use crate::shape::product::hair::Hanging;
use crate::shape::product::head::head_frame;
use crate::shape::product::part::Part;
use crate::shape::product::parting::{Openings, Parting};
use crate::shape::product::strands::Strands;
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
        let hangs = |all: DVec3| {
            f64::from(binding.weight(Part::Hair)) * (all - beyond_head(&self.field, rest, binding))
        };
        self.joints[joint].map_or(DVec3::ZERO, hangs)
    }
}

/// How far `field` takes what is at `rest` beyond where it takes the head as one.
fn beyond_head(field: &Field, rest: DVec3, binding: &Binding) -> DVec3 {
    let BodyField::Parts(parts) = &*field.body else { return DVec3::ZERO };
    field.place(rest, binding) - parts.place_head_alone(rest)
}

/// How hair hangs on the body, before the head's own stages; `None` where none hangs, and in paper mode.
pub fn hanging(view: &View) -> Result<Option<Hanging>> {
    let body = view.body()?;
    let BodyField::Parts(parts) = &*body.field else { return Ok(None) };
    let strands = view.strands()?;
    Ok(strands.as_ref().as_ref().map(|strands| Hanging::of(strands, parts, view.options.hair_length)))
}

/// What is added to each vertex before the head's own stages: to clothes what keeps them out of the body, to hair what makes it
/// shorter; empty where nothing is.
pub fn offsets(view: &View) -> Result<Vec<DVec3>> {
    let pushed = view.pushed()?.dense(view.measured()?.figure.positions.len());
    Ok(match (view.strands()?.as_ref(), view.hanging()?.as_ref()) {
        (Some(strands), Some(hanging)) => added(strands, &pushed, view, |_, place| hanging.short[place])?,
        _ => pushed,
    })
}

/// `pushed`, and to each vertex of hair as much of what `of` gives for it and its place as it is hair.
fn added(
    strands: &Strands,
    pushed: &[DVec3],
    view: &View,
    of: impl Fn(usize, usize) -> DVec3,
) -> Result<Vec<DVec3>> {
    let mut all = pushed.to_vec();
    all.resize(view.measured()?.figure.positions.len(), DVec3::ZERO);
    for &(vertex, place, share) in &strands.vertices {
        all[vertex as usize] += share * of(vertex as usize, place as usize);
    }
    Ok(all)
}

/// Hair in the end; `None` where none hangs below the chin.
pub fn hair(view: &View) -> Result<Option<Hair>> {
    let (strands, hanging) = (view.strands()?, view.hanging()?);
    let (Some(strands), Some(hanging)) = (strands.as_ref(), hanging.as_ref()) else { return Ok(None) };
    let (body, measured, options) = (view.body()?, view.measured()?, &view.options);
    let is_laid = options.stage == Stage::Face;
    let lay = if is_laid { growth(&body, &measured) * options.hair_lay } else { 0.0 };
    // Before amount, whole and ground, as all of the head's stages.
    let of_head = view.field()?;
    let field = Field { finish: body.with_face(view.face()?.shape).finish, ..(*of_head).clone() };
    let pushed = view.pushed()?.dense(measured.figure.positions.len());
    let young = if field.young.is_some() { Some(view.young()?) } else { None };
    let young = young.as_ref().and_then(|young| Option::as_ref(young));
    let placement = Placement {
        hair_offsets: &pushed,
        ways: young.map(|young| &young.ways),
        ..body.placement(&measured.figure, &field, &body.placed, view.threads())
    };
    let now = placement.vertices(&strands.worn.vertices);
    let head = |vertex: u32| place_head(&body, measured.figure.positions[vertex as usize]);
    // What is hair in part goes as hair would.
    let as_hair = Binding::to(Part::Hair);
    let moved: Vec<DVec3> = (strands.worn.vertices.iter().zip(&now))
        .map(|(&vertex, &now)| match placement.bindings.vertices[vertex as usize].weight(Part::Hair) {
            1.0 => now - head(vertex),
            _ => beyond_head(&field, measured.figure.positions[vertex as usize], &as_hair),
        })
        .collect();
    let mut parted = moved.clone();
    if let (Some(sides), true) = (&strands.sides, lay > 0.0)
        && let Some(frame) = frame_after(&body, &measured)
        && let Some(openings) = openings(&measured, &field, frame)
    {
        let middle = frame.to_unit(field.place(measured.anatomy.head_centre, &Binding::to(Part::Head)));
        let points: Vec<DVec3> = now.iter().map(|&p| frame.to_unit(p)).collect();
        let parting = Parting::new(&points, middle, openings);
        for ((parted, &p), &side) in parted.iter_mut().zip(&points).zip(sides) {
            *parted += frame.length * (parting.place(p, side, lay) - p);
        }
    }
    let mut all = hanging.all(strands, lay, &parted);
    let heads: Vec<DVec3> = strands.worn.vertices.iter().map(|&vertex| head(vertex)).collect();
    let mut after = placement.all_vertices();
    for (&vertex, (&head, &all)) in strands.worn.vertices.iter().zip(heads.iter().zip(&all)) {
        after[vertex as usize] = head + all;
    }
    let points = heads.iter().zip(&all).map(|(&head, &all)| head + all).collect();
    let BodyField::Parts(parts) = &*body.field else { return Ok(None) };
    let layer = hanging.layer(strands, parts.after().sole);
    view.part(0.5, 0.5, |_| Ok(()))?;
    let pushes = strands.worn.kept_outside(points, &after, &measured.weld, &layer, view.threads());
    for (all, push) in all.iter_mut().zip(pushes.into_iter().flatten()) {
        *all += push;
    }
    let joints: Vec<Option<DVec3>> = (strands.joints.iter())
        .map(|places| {
            let sum = places.iter().map(|&(place, share)| share * all[place as usize]).sum();
            (!places.is_empty()).then_some(sum)
        })
        .collect();
    let mut hair = Hair {
        offsets: added(strands, &pushed, view, |_, place| all[place] - moved[place])?,
        joint_offsets: Vec::new(),
        joints,
        field: field.clone(),
    };
    let bindings = &body.bindings.joints;
    hair.joint_offsets = (0..bindings.len())
        .map(|joint| hair.offset(&bindings[joint], joint, measured.figure.joints[joint]))
        .collect();
    Ok(Some(hair))
}

fn place_head(body: &Body, p: DVec3) -> DVec3 {
    match &*body.field {
        BodyField::Parts(parts) => parts.place_head_alone(p),
        BodyField::Bones(_) => p,
    }
}

/// The eyes as they are after the face step, in lengths of the head at `frame`.
fn openings(measured: &Measured, field: &Field, frame: HeadFrame) -> Option<Openings> {
    let face = measured.face.as_ref()?;
    let before = head_frame(&measured.anatomy);
    let after = face.mapped(|p| frame.to_unit(field.place(before.from_unit(p), &Binding::to(Part::Head))));
    let (_, eyes) = after.eyes.as_ref()?;
    let pair = Pair::of(eyes);
    Some(Openings {
        height: pair.height,
        half_distance: pair.half_distance,
        half_width: pair.half_width,
        half_height: pair.half_height,
    })
}
