//! Hair, last: strands that hide the eyes part, long ones lie down on the body that is there now, and none is inside it.

use super::attach::{Bindings, Placement};
use super::young::is_one;
use super::{Deformer, Target};
use crate::face::FaceShape;
use crate::face::eyes::Pair;
use crate::face::seat::{Seat, SeatAmount};
use crate::face::stage::YoungFace;
use crate::geometry::components;
use crate::options::Stage;
use crate::shape::field::{Binding, BodyField, Field, Finish};
use crate::shape::heights::Heights;
use crate::shape::product::anatomy::Anatomy;
use crate::shape::product::binding::PartBinding;
use crate::shape::product::curtain::{Curtain, Openings, sides};
use crate::shape::product::field::PartField;
use crate::shape::product::head::head_frame;
use crate::shape::product::long_hair::{Axis, Hanging, LongHair};
use crate::shape::product::part::Part;
use crate::shape::product::pieces::Attachment;
use glam::DVec3;
use std::collections::BTreeMap;
use std::sync::Arc;

/// A target's hair: strands are connected pieces.
#[derive(Debug)]
pub struct Strands {
    /// The hair's vertices, ascending, and the strand of each.
    vertices: Vec<u32>,
    of_vertices: Vec<u32>,
    /// The strand that a joint moves, or hangs from.
    of_joints: Vec<Option<u32>>,
    /// To which side each strand parts, where they do.
    sides: Option<Vec<f64>>,
    /// What lies on the body.
    long: Option<Arc<LongHair>>,
}

/// Where on the torso's axis long hair is measured about, from the crotch (0) to the shoulder line (1).
const AXIS_HEIGHT: f64 = 0.7;

/// A point of the torso's axis.
fn torso_axis(anatomy: &Anatomy) -> DVec3 {
    let Heights { crotch, shoulder_line, .. } = anatomy.landmarks.heights;
    let y = crotch + AXIS_HEIGHT * (shoulder_line - crotch);
    DVec3::new(anatomy.middle_x, y, anatomy.centre_z(y).0)
}

impl Strands {
    /// The hair of `target`, attached to parts by `bindings`.
    pub fn of(target: &Target, bindings: &Bindings) -> Self {
        let measured = &target.measured;
        let figure = &measured.figure;
        let weight = |vertex: usize, part: Part| match &bindings.vertices[vertex] {
            Binding::Parts(binding) => binding.weights[part as usize],
            _ => 0.0,
        };
        let is_hair = |vertex: usize| weight(vertex, Part::Hair) > 0.5;
        let triangles = figure.triangles_where(is_hair);
        let component = components(&triangles, &target.measured.weld);
        let mut strands: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
        for vertex in (0..figure.positions.len()).filter(|&vertex| is_hair(vertex)) {
            let welded = target.measured.weld.representative[vertex] as usize;
            strands.entry(component[welded]).or_default().push(vertex as u32);
        }
        let strands: Vec<Vec<u32>> = strands.into_values().collect();
        let mut of: Vec<(u32, u32)> = strands
            .iter()
            .enumerate()
            .flat_map(|(strand, vertices)| vertices.iter().map(move |&vertex| (vertex, strand as u32)))
            .collect();
        of.sort_unstable();
        let (vertices, of_vertices): (Vec<u32>, Vec<u32>) = of.into_iter().unzip();

        let frame = head_frame(&measured.anatomy);
        let points: Vec<Vec<DVec3>> = strands
            .iter()
            .map(|strand| {
                strand.iter().map(|&vertex| frame.to_unit(figure.positions[vertex as usize])).collect()
            })
            .collect();
        let covered = measured.face.as_ref().map_or(0.0, |face| face.covered);
        let is_body = |vertex: usize| {
            let Binding::Parts(binding) = &bindings.vertices[vertex] else { return false };
            let arms: f32 = binding.weights[Part::LeftUpperArm as usize..].iter().take(6).sum();
            let is_plain = binding.attachment == Attachment::Plain && !figure.is_carried(vertex);
            is_plain && arms < 0.5 && !is_hair(vertex)
        };
        let middle = torso_axis(&measured.anatomy);
        let axis = Axis { frame, middle: [middle.x, middle.z] };
        let long = if strands.is_empty() {
            None
        } else {
            let body = figure.triangles_where(is_body);
            LongHair::of(&figure.positions, &figure.triangles, &target.measured.weld, &strands, &body, axis)
        };
        let mut hair = Self {
            vertices,
            of_vertices,
            of_joints: Vec::new(),
            sides: sides(&points, covered),
            long: long.map(Arc::new),
        };
        hair.of_joints = hair.of_joints(target);
        hair
    }

    /// The strand of each joint that no role is of: the one that it moves most of, else its parent's.
    fn of_joints(&self, target: &Target) -> Vec<Option<u32>> {
        let skeleton = &target.character.skeleton;
        let figure = &target.measured.figure;
        let mut moved: Vec<BTreeMap<u32, f32>> = vec![BTreeMap::new(); skeleton.joints.len()];
        for (mesh, &start) in target.character.meshes.iter().zip(&figure.mesh_starts) {
            for (vertex, row) in mesh.weights.rows().enumerate() {
                if let Ok(index) = self.vertices.binary_search(&((start + vertex) as u32)) {
                    for &(joint, weight) in row {
                        *moved[joint as usize].entry(self.of_vertices[index]).or_default() += weight;
                    }
                }
            }
        }
        let mut of = vec![None; skeleton.joints.len()];
        for joint in skeleton.parents_first() {
            let has_role = figure.humanoid.iter().any(|(_, of_role)| of_role == joint);
            let most = moved[joint].iter().max_by(|a, b| a.1.total_cmp(b.1).then(b.0.cmp(a.0)));
            let parent = skeleton.joints[joint].parent.and_then(|parent| of[parent]);
            of[joint] = if has_role { None } else { most.map(|(&strand, _)| strand).or(parent) };
        }
        of
    }

    fn side(&self, strand: u32) -> Option<f64> {
        self.sides.as_ref().map(|sides| sides[strand as usize])
    }

    fn lies(&self, strand: u32) -> bool {
        self.long.as_ref().is_some_and(|long| long.lies[strand as usize])
    }
}

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
        product: &super::product::ProductTarget,
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
    pub(super) fn finish_hair(&mut self) {
        self.hair = None;
        let amount = self.head_growth() * self.options.hair_lay;
        let lays = amount > 0.0 && self.options.stage == Stage::Face;
        let is_changed = lays || self.field.young.is_some() || self.field.seat.is_some();
        if !is_changed || self.deformation.product.is_none() {
            return;
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
                ends.of[end] = self.end(&ends, end as f64).map(Arc::new);
            }
        }
        self.laid = Some(ends.clone());
        for (end, is_seen) in [youth < 1.0, youth > 0.0].into_iter().enumerate() {
            ends.of[end].take_if(|_| !is_seen);
        }
        self.hair = Some(Laid::new(ends, youth));
    }

    /// Hair on the face as it was (`youth` 0) or on the youngest one (1).
    fn end(&self, ends: &Ends, youth: f64) -> Option<End> {
        let (Some(product), BodyField::Parts(body)) = (&self.deformation.product, &*self.deformation.body)
        else {
            return None;
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
        let placement =
            Placement { field: &field, hair_offsets: &[], joint_offsets: &[], ..self.placement() };
        let mut end = End {
            field: field.clone(),
            offsets: Vec::new(),
            joint_offsets: Vec::new(),
            curtain: None,
            hanging: None,
            amount: ends.amount,
        };
        let strands = product.strands(&self.target);
        if ends.amount > 0.0 && (strands.sides.is_some() || strands.long.is_some()) {
            self.lay(&mut end, strands, body, &placement);
        }
        let placement = Placement { hair_offsets: &end.offsets, ..placement };
        end.offsets = product.hair_offsets(&self.target, &placement);
        Some(end)
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
        end.offsets = vec![DVec3::ZERO; figure.positions.len()];
        for ((&vertex, &now), &to) in strands.vertices.iter().zip(&now).zip(&to) {
            end.offsets[vertex as usize] = to - now;
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
