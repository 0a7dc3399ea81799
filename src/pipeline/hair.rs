//! Hair, last: strands that hide the eyes part, long ones lie down on the body that is there now, and none is inside it.

use super::attach::Placement;
use super::strands::{Strands, torso_axis};
use super::young::is_one;
use super::{Deformer, Target};
use crate::error::Result;
use crate::face::FaceShape;
use crate::face::eyes::Pair;
use crate::face::seat::{Seat, SeatAmount};
use crate::face::stage::YoungFace;
use crate::options::Stage;
use crate::progress::Progress;
use crate::shape::field::{Binding, BodyField, Field, Finish};
use crate::shape::product::binding::PartBinding;
use crate::shape::product::curtain::{Curtain, Openings};
use crate::shape::product::field::PartField;
use crate::shape::product::head::head_frame;
use crate::shape::product::long_hair::{Axis, Hanging};
use crate::shape::product::part::Part;
use glam::DVec3;
use std::sync::Arc;

/// Hair as it is laid for the youth that is asked for: between where it lies on the face as it was and on the youngest one.
#[derive(Clone, Debug)]
pub struct Laid {
    /// What is added to each vertex; empty where nothing is.
    pub offsets: Vec<DVec3>,
    /// What is added to each joint; empty where nothing is.
    pub joint_offsets: Vec<DVec3>,
    ends: Ends,
    youth: f64,
}

/// Hair as it is laid on the face as it was, and on the youngest one; and what these faces are made of.
#[derive(Clone, Debug)]
pub struct Ends {
    squash: FaceShape,
    young: Option<Arc<YoungFace>>,
    seat: Option<Arc<Seat>>,
    seat_amount: f64,
    amount: f64,
    of: [Option<Arc<End>>; 2],
}

/// Hair that is laid on one face.
#[derive(Debug)]
struct End {
    /// The face, before amount and ground.
    field: Field,
    offsets: Vec<DVec3>,
    joint_offsets: Vec<DVec3>,
    curtain: Option<Curtain>,
    hanging: Option<Hanging>,
    amount: f64,
}

impl End {
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
}

impl Ends {
    /// True where both are made of the same faces.
    fn are_of(&self, other: &Self) -> bool {
        self.squash == other.squash
            && is_one(&self.young, &other.young)
            && is_one(&self.seat, &other.seat)
            && self.seat_amount == other.seat_amount
            && self.amount == other.amount
    }
}

impl Laid {
    fn new(ends: Ends, youth: f64) -> Self {
        let between = |of: fn(&End) -> &Vec<DVec3>| match ends.of.each_ref().map(Option::as_ref) {
            [Some(old), Some(young)] => {
                let (old, young) = (of(old), of(young));
                let count = old.len().max(young.len());
                let at = |offsets: &[DVec3], index: usize| offsets.get(index).copied().unwrap_or(DVec3::ZERO);
                (0..count).map(|index| at(old, index).lerp(at(young, index), youth)).collect()
            }
            [Some(one), None] | [None, Some(one)] => of(one).clone(),
            [None, None] => Vec::new(),
        };
        let (offsets, joint_offsets) = (between(|end| &end.offsets), between(|end| &end.joint_offsets));
        Self { offsets, joint_offsets, ends, youth }
    }

    /// What is added to a point that was at `rest` and moves with `joint`, before the amount.
    pub fn offset(
        &self,
        product: &super::product_target::ProductTarget,
        target: &Target,
        binding: &Binding,
        joint: usize,
        rest: DVec3,
    ) -> DVec3 {
        let strands = product.strands(target);
        let Some(strand) = strands.of_joints[joint] else { return DVec3::ZERO };
        let of = |end: &Arc<End>| end.of_point(strands, strand, rest, end.field.place(rest, binding));
        match &self.ends.of {
            [Some(old), Some(young)] => of(old).lerp(of(young), self.youth),
            [Some(one), None] | [None, Some(one)] => of(one),
            [None, None] => DVec3::ZERO,
        }
    }
}

impl Deformer {
    /// Lays hair as the options ask for, and keeps it outside of the body.
    ///
    /// # Errors
    /// `Cancelled`, with some of it done.
    pub(super) fn finish_hair(&mut self, progress: &mut Progress) -> Result<()> {
        let known = self.hair.take();
        let amount = self.head_growth() * self.options.hair_lay;
        let lays = amount > 0.0 && self.options.stage == Stage::Face;
        let is_changed = lays || self.field.young.is_some() || self.field.seat.is_some();
        if !is_changed || self.deformation.product.is_none() {
            return Ok(());
        }
        let amount = if lays { amount } else { 0.0 };
        // While only youth changes, hair is between what was laid already.
        let made = self.young.as_ref().filter(|_| self.options.stage == Stage::Face);
        let young = made.map(|made| Arc::clone(&made.young));
        let youth = if young.is_some() { self.options.youth } else { 0.0 };
        let mut ends = Ends {
            squash: self.field.finish.face,
            young,
            seat: self.field.seat.clone(),
            seat_amount: self.field.seat_amount.back,
            amount,
            of: [None, None],
        };
        if let Some(laid) = self.laid.take().filter(|laid| laid.are_of(&ends)) {
            ends.of = laid.of;
        }
        for (end, is_seen) in [youth < 1.0, youth > 0.0].into_iter().enumerate() {
            if is_seen && ends.of[end].is_none() {
                let part = &mut progress.part(0.5 * end as f32, 0.5 + 0.5 * end as f32);
                ends.of[end] = self.end(&ends, end as f64, part)?.map(Arc::new);
            }
        }
        self.laid = Some(ends.clone());
        for (end, is_seen) in [youth < 1.0, youth > 0.0].into_iter().enumerate() {
            ends.of[end].take_if(|_| !is_seen);
        }
        let is_same = |laid: &Arc<Laid>| {
            let ends = laid.ends.of.iter().zip(&ends.of).all(|(known, new)| is_one(known, new));
            ends && laid.youth == youth
        };
        self.hair = known.filter(is_same).or_else(|| Some(Arc::new(Laid::new(ends, youth))));
        Ok(())
    }

    /// Hair on the face as it was (`youth` 0) or on the youngest one (1).
    fn end(&self, ends: &Ends, youth: f64, progress: &mut Progress) -> Result<Option<End>> {
        let (Some(product), BodyField::Parts(body)) = (&self.deformation.product, &*self.deformation.body)
        else {
            return Ok(None);
        };
        let share = self.head_growth();
        // Before amount and ground, as all of the head's stages.
        let field = Field {
            finish: Finish { face: ends.squash, ..Finish::default() },
            young: ends.young.clone().filter(|_| youth > 0.0),
            youth: share * youth,
            seat_amount: SeatAmount { back: ends.seat_amount, nape: ends.seat_amount * youth },
            ..self.field.clone()
        };
        // Over clothes as they are pushed out of the body.
        let repaired = self.deformation.pushed.dense(self.target.measured.figure.positions.len());
        let placement =
            Placement { field: &field, hair_offsets: &repaired, joint_offsets: &[], ..self.placement() };
        let mut end = End {
            field: field.clone(),
            offsets: repaired.clone(),
            joint_offsets: Vec::new(),
            curtain: None,
            hanging: None,
            amount: ends.amount,
        };
        let strands = product.strands(&self.target);
        progress.at(0.2)?;
        if ends.amount > 0.0 && (strands.sides.is_some() || strands.long.is_some()) {
            self.lay(&mut end, strands, body, &placement);
        }
        progress.at(0.5)?;
        let placement = Placement { hair_offsets: &end.offsets, ..placement };
        end.offsets = product.hair_offsets(&self.target, &placement);
        progress.at(1.0)?;
        Ok(Some(end))
    }

    /// Parts strands that hide the eyes, and lays long ones down on the body.
    fn lay(&self, end: &mut End, strands: &Strands, body: &PartField, placement: &Placement) {
        let field = placement.field;
        let figure = placement.figure;
        let frame = self.head_after(body, field);
        let now = placement.vertices(&strands.vertices);
        let on_head = Binding::Parts(PartBinding::to(Part::Head));
        let at_rest = |vertex: u32| figure.positions[vertex as usize];
        if strands.sides.is_some()
            && let Some(openings) = self.openings(field, frame)
        {
            let middle = field.place(self.target.measured.anatomy.head_centre, &on_head);
            let axis = Axis { frame, middle: [middle.x, middle.z] };
            end.curtain = Some(Curtain::new(&now, axis, openings));
        }
        let mut to: Vec<DVec3> = strands
            .of_vertices
            .iter()
            .zip(strands.vertices.iter().zip(&now))
            .map(|(&strand, (&vertex, &now))| now + end.of_point(strands, strand, at_rest(vertex), now))
            .collect();
        if let Some(long) = &strands.long {
            let torso = Binding::Parts(PartBinding::to(Part::Torso));
            let middle = field.place(torso_axis(&self.target.measured.anatomy), &torso);
            let axis = Axis { frame, middle: [middle.x, middle.z] };
            let index = |vertex: &u32| strands.vertices.binary_search(vertex).expect("all hair is listed");
            let lying: Vec<DVec3> = long.vertices.iter().map(|vertex| to[index(vertex)]).collect();
            let on_body = placement.vertices(&long.body_vertices);
            let hanging = long.hanging(&figure.positions, &lying, &on_body, axis);
            let of_hair: Vec<DVec3> = long
                .vertices
                .iter()
                .zip(&lying)
                .map(|(&vertex, &to)| end.amount * hanging.offset(at_rest(vertex), to))
                .collect();
            for (vertex, offset) in long.vertices.iter().zip(long.smoothed(&of_hair)) {
                to[index(vertex)] += offset;
            }
            end.hanging = Some(hanging);
        }
        end.offsets.resize(figure.positions.len(), DVec3::ZERO);
        for ((&vertex, &now), &to) in strands.vertices.iter().zip(&now).zip(&to) {
            end.offsets[vertex as usize] += to - now;
        }
        let of_joint = |(joint, strand): (usize, &Option<u32>)| match strand {
            Some(strand) => end.of_point(strands, *strand, figure.joints[joint], placement.joint(joint)),
            None => DVec3::ZERO,
        };
        end.joint_offsets = strands.of_joints.iter().enumerate().map(of_joint).collect();
    }

    /// The eyes as they are after the face step, in lengths of the head at `frame`.
    fn openings(&self, field: &Field, frame: crate::face::head::HeadFrame) -> Option<Openings> {
        let measured = &self.target.measured;
        let face = measured.face.as_ref()?;
        let on_head = Binding::Parts(PartBinding::to(Part::Head));
        let before = head_frame(&measured.anatomy);
        let after = face.mapped(|p| frame.to_unit(field.place(before.from_unit(p), &on_head)));
        let (_, eyes) = after.eyes.as_ref()?;
        let pair = Pair::of(eyes);
        Some(Openings {
            height: pair.height,
            half_distance: pair.half_distance,
            half_width: pair.half_width,
            half_height: pair.half_height,
        })
    }
}
