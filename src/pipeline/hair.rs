//! Hair, last: strands that hide the eyes part, long ones lie down on the body that is there now, and none is inside it.

use super::head::{frame_after, growth};
use super::memo::View;
use crate::error::Result;
use crate::face::eyes::Pair;
use crate::face::head::HeadFrame;
use crate::options::{Options, Stage};
use crate::shape::Measured;
use crate::shape::field::{Binding, Field};
use crate::shape::figure::extent;
use crate::shape::placement::{Body, Placement};
use crate::shape::product::curtain::{Curtain, Openings};
use crate::shape::product::hair::HairOnBody;
use crate::shape::product::head::head_frame;
use crate::shape::product::long_hair::{Axis, Hanging};
use crate::shape::product::part::Part;
use crate::shape::product::strands::{Strands, torso_axis};
use glam::DVec3;
use std::sync::Arc;

/// Hair as it is laid for the youth that is asked for.
#[derive(Debug)]
pub struct Hair {
    /// What is added to each vertex; empty where nothing is.
    pub offsets: Vec<DVec3>,
    /// What is added to each joint; empty where nothing is.
    pub joint_offsets: Vec<DVec3>,
    /// It is so far from the first of these to the second.
    between: [Arc<Keyframe>; 2],
    youth: f64,
}

/// Hair that is laid on one face.
#[derive(Debug)]
pub struct Keyframe {
    /// The face, before amount and ground.
    field: Field,
    offsets: Vec<DVec3>,
    joint_offsets: Vec<DVec3>,
    /// Found where hair is laid.
    strands: Option<Arc<Strands>>,
    curtain: Option<Curtain>,
    hanging: Option<Hanging>,
    amount: f64,
}

impl Keyframe {
    /// What is added to a point of `strand` that was at `rest` and is at `now`.
    fn of_point(&self, strands: &Strands, strand: u32, rest: DVec3, now: DVec3) -> DVec3 {
        let mut to = now;
        if let (Some(curtain), Some(side)) = (&self.curtain, strands.side(strand)) {
            to = curtain.place(to, side, self.amount);
        }
        if let Some(hanging) = self.hanging.as_ref().filter(|_| strands.lies(strand)) {
            to += self.amount * hanging.offset(rest, to);
        }
        to - now
    }

    /// What is added to a point that was at `rest` and moves with `joint`.
    fn of_joint(&self, binding: &Binding, joint: usize, rest: DVec3) -> DVec3 {
        let strand = self.strands.as_ref().and_then(|strands| Some((strands, strands.of_joints[joint]?)));
        strand.map_or(DVec3::ZERO, |(strands, strand)| {
            self.of_point(strands, strand, rest, self.field.place(rest, binding))
        })
    }
}

impl Hair {
    /// What is added to a point that was at `rest` and moves with `joint`, before the amount.
    pub fn offset(&self, binding: &Binding, joint: usize, rest: DVec3) -> DVec3 {
        let [old, young] = self.between.each_ref().map(|keyframe| keyframe.of_joint(binding, joint, rest));
        mix(old, young, self.youth)
    }
}

/// From one to the other; at the ends these, to the bit.
fn mix(old: DVec3, young: DVec3, youth: f64) -> DVec3 {
    match youth {
        0.0 => old,
        1.0 => young,
        _ => old.lerp(young, youth),
    }
}

/// Hair on the face as it was.
pub fn before(view: &View) -> Result<Keyframe> {
    keyframe(view, 0.0)
}

/// Hair on the youngest face.
pub fn after(view: &View) -> Result<Keyframe> {
    keyframe(view, 1.0)
}

/// Hair between the two, for the youth that is asked for; `None` where nothing has changed since the body's own stages.
pub fn between(view: &View) -> Result<Option<Hair>> {
    let (body, field) = (view.body()?, view.field()?);
    let lays = lay_amount(view, &body)? > 0.0;
    if !body.is_of_parts() || !(lays || field.young.is_some() || field.seat.is_some()) {
        return Ok(None);
    }
    // While only youth changes, hair is between what was laid already.
    let youth = if field.young.is_some() { view.options.youth } else { 0.0 };
    let between = match youth {
        0.0 => [view.hair_before()?, view.hair_before()?],
        1.0 => [view.hair_after()?, view.hair_after()?],
        _ => [view.hair_before()?, view.hair_after()?],
    };
    let all = |of: fn(&Keyframe) -> &Vec<DVec3>| -> Vec<DVec3> {
        let [old, young] = between.each_ref().map(|keyframe| of(keyframe));
        let at = |offsets: &[DVec3], index: usize| offsets.get(index).copied().unwrap_or(DVec3::ZERO);
        (0..old.len().max(young.len())).map(|index| mix(at(old, index), at(young, index), youth)).collect()
    };
    let (offsets, joint_offsets) =
        (all(|keyframe| &keyframe.offsets), all(|keyframe| &keyframe.joint_offsets));
    Ok(Some(Hair { offsets, joint_offsets, between, youth }))
}

/// True where long hair lies down.
pub fn is_laid(options: &Options) -> bool {
    options.stage == Stage::Face && options.hair_lay > 0.0
}

/// How far long hair lies down.
fn lay_amount(view: &View, body: &Body) -> Result<f64> {
    Ok(if is_laid(&view.options) { growth(body, &*view.measured()?) * view.options.hair_lay } else { 0.0 })
}

fn keyframe(view: &View, youth: f64) -> Result<Keyframe> {
    let (body, measured, shape) = (view.body()?, view.measured()?, view.face()?.shape);
    let (options, growth) = (&view.options, growth(&body, &measured));
    let young = if options.stage == Stage::Face && youth > 0.0 { Some(view.young()?) } else { None };
    let young = young.as_ref().and_then(|young| Option::as_ref(young));
    let back = growth * options.seat;
    let seat = if options.stage == Stage::Face && back > 0.0 { Some(view.seat()?) } else { None };
    // Before amount and ground, as all of the head's stages.
    let field = Field {
        young: young.map(|young| Arc::clone(&young.face)),
        youth: growth * youth,
        seat: seat.and_then(|seat| (*seat).clone()).map(Arc::new),
        seat_amount: back,
        ..body.with_face(shape)
    };
    // Over clothes as they are pushed out of the body.
    let pushed = view.pushed()?.dense(measured.figure.positions.len());
    let placement = Placement {
        hair_offsets: &pushed,
        ways: young.map(|young| &young.ways),
        ..body.placement(&measured.figure, &field, &body.placed, view.threads())
    };
    let mut keyframe = Keyframe {
        field: field.clone(),
        offsets: pushed.clone(),
        joint_offsets: Vec::new(),
        strands: None,
        curtain: None,
        hanging: None,
        amount: lay_amount(view, &body)?,
    };
    if keyframe.amount > 0.0 {
        let strands = view.strands()?;
        if (strands.sides.is_some() || strands.long.is_some())
            && let Some(frame) = frame_after(&body, &measured)
        {
            lay(&mut keyframe, &strands, &measured, frame, &placement);
            keyframe.strands = Some(strands);
        }
    }
    view.part(0.5, 0.5, |_| Ok(()))?;
    let placement = Placement { hair_offsets: &keyframe.offsets, ..placement };
    keyframe.offsets = kept_outside(&*view.hair_on_body()?, &measured, &placement);
    Ok(keyframe)
}

/// What is added to each vertex so that locks which lay on the body still do; empty where nothing is.
pub fn kept_outside(hair: &HairOnBody, measured: &Measured, placement: &Placement) -> Vec<DVec3> {
    let mut all = placement.hair_offsets.to_vec();
    if hair.is_empty() {
        return all;
    }
    let after = placement.all_vertices();
    let (low, high) = extent(&after);
    let offsets = hair.kept_outside(&after, &measured.weld, high - low, placement.threads);
    if !offsets.is_empty() {
        all.resize(after.len(), DVec3::ZERO);
    }
    for (vertex, offset) in offsets {
        all[vertex] += offset;
    }
    all
}

/// Parts strands that hide the eyes, and lays long ones down on the body.
fn lay(
    keyframe: &mut Keyframe,
    strands: &Strands,
    measured: &Measured,
    frame: HeadFrame,
    placement: &Placement,
) {
    let (field, figure) = (placement.field, placement.figure);
    let now = placement.vertices(&strands.vertices);
    let at_rest = |vertex: u32| figure.positions[vertex as usize];
    if strands.sides.is_some()
        && let Some(openings) = openings(measured, field, frame)
    {
        let middle = field.place(measured.anatomy.head_centre, &Binding::to(Part::Head));
        let axis = Axis { frame, middle: [middle.x, middle.z] };
        keyframe.curtain = Some(Curtain::new(&now, axis, openings));
    }
    let mut to: Vec<DVec3> = strands
        .of_vertices
        .iter()
        .zip(strands.vertices.iter().zip(&now))
        .map(|(&strand, (&vertex, &now))| now + keyframe.of_point(strands, strand, at_rest(vertex), now))
        .collect();
    if let Some(long) = &strands.long {
        let middle = field.place(torso_axis(&measured.anatomy), &Binding::to(Part::Torso));
        let axis = Axis { frame, middle: [middle.x, middle.z] };
        let index = |vertex: &u32| strands.vertices.binary_search(vertex).expect("all hair is listed");
        let lying: Vec<DVec3> = long.vertices.iter().map(|vertex| to[index(vertex)]).collect();
        let on_body = placement.vertices(&long.body_vertices);
        let hanging = long.hanging(&figure.positions, &lying, &on_body, axis);
        let of_hair: Vec<DVec3> = long
            .vertices
            .iter()
            .zip(&lying)
            .map(|(&vertex, &to)| keyframe.amount * hanging.offset(at_rest(vertex), to))
            .collect();
        for (vertex, offset) in long.vertices.iter().zip(long.smoothed(&of_hair)) {
            to[index(vertex)] += offset;
        }
        keyframe.hanging = Some(hanging);
    }
    keyframe.offsets.resize(figure.positions.len(), DVec3::ZERO);
    for ((&vertex, &now), &to) in strands.vertices.iter().zip(&now).zip(&to) {
        keyframe.offsets[vertex as usize] += to - now;
    }
    let of_joint = |(joint, strand): (usize, &Option<u32>)| match strand {
        Some(strand) => keyframe.of_point(strands, *strand, figure.joints[joint], placement.joint(joint)),
        None => DVec3::ZERO,
    };
    keyframe.joint_offsets = strands.of_joints.iter().enumerate().map(of_joint).collect();
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
