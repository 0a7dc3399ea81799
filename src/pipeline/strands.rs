//! Hair, last: strands that hide the eyes part, long ones lie down on the body that is there now, and none is inside it.

use super::attach::{Bindings, Placement};
use super::{Deformer, Target};
use crate::face::eyes::Pair;
use crate::geometry::components;
use crate::options::Stage;
use crate::shape::field::{Binding, BodyField, Field, Finish};
use crate::shape::heights::Heights;
use crate::shape::product::anatomy::Anatomy;
use crate::shape::product::binding::PartBinding;
use crate::shape::product::curtain::{Curtain, Openings, sides};
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

/// Hair as it was laid.
#[derive(Clone, Debug)]
pub struct Laid {
    /// What is added to each vertex; empty where nothing is.
    pub offsets: Vec<DVec3>,
    /// What is added to each joint; empty where nothing is.
    pub joint_offsets: Vec<DVec3>,
    curtain: Option<Curtain>,
    hanging: Option<Hanging>,
    amount: f64,
}

impl Laid {
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

    /// What is added to a point that was at `rest` and moves with `joint`, before the amount.
    pub fn offset(
        &self,
        product: &super::product::ProductTarget,
        target: &Target,
        field: &Field,
        binding: &Binding,
        joint: usize,
        rest: DVec3,
    ) -> DVec3 {
        let strands = product.strands(target);
        match strands.of_joints[joint] {
            Some(strand) => {
                let field = Field {
                    finish: Finish { face: field.finish.face, ..Finish::default() },
                    ..field.clone()
                };
                self.of_point(strands, strand, rest, field.place(rest, binding))
            }
            None => DVec3::ZERO,
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
        let (Some(product), BodyField::Parts(body)) = (&self.deformation.product, &*self.deformation.body)
        else {
            return;
        };
        if !is_changed {
            return;
        }
        let strands = product.strands(&self.target);
        let figure = &self.target.measured.figure;
        // Before amount and ground, as all of the head's stages.
        let finish = Finish { face: self.field.finish.face, ..Finish::default() };
        let field = Field { finish, ..self.field.clone() };
        let placement =
            Placement { field: &field, hair_offsets: &[], joint_offsets: &[], ..self.placement() };
        let mut laid =
            Laid { offsets: Vec::new(), joint_offsets: Vec::new(), curtain: None, hanging: None, amount };
        if lays && (strands.sides.is_some() || strands.long.is_some()) {
            let frame = self.head_after(body, &field);
            let now = placement.vertices(&strands.vertices);
            let on_head = Binding::Parts(PartBinding::to(Part::Head));
            let at_rest = |vertex: u32| figure.positions[vertex as usize];
            if strands.sides.is_some()
                && let Some(openings) = self.openings(&field, frame)
            {
                let middle = field.place(self.target.measured.anatomy.head_centre, &on_head);
                let axis = Axis { frame, middle: [middle.x, middle.z] };
                laid.curtain = Some(Curtain::new(&now, axis, openings));
            }
            let mut to: Vec<DVec3> = strands
                .of_vertices
                .iter()
                .zip(strands.vertices.iter().zip(&now))
                .map(|(&strand, (&vertex, &now))| now + laid.of_point(strands, strand, at_rest(vertex), now))
                .collect();
            if let Some(long) = &strands.long {
                let torso = Binding::Parts(PartBinding::to(Part::Torso));
                let middle = field.place(torso_axis(&self.target.measured.anatomy), &torso);
                let axis = Axis { frame, middle: [middle.x, middle.z] };
                let index =
                    |vertex: &u32| strands.vertices.binary_search(vertex).expect("all hair is listed");
                let lying: Vec<DVec3> = long.vertices.iter().map(|vertex| to[index(vertex)]).collect();
                let on_body = placement.vertices(&long.body_vertices);
                let hanging = long.hanging(&figure.positions, &lying, &on_body, axis);
                let of_hair: Vec<DVec3> = long
                    .vertices
                    .iter()
                    .zip(&lying)
                    .map(|(&vertex, &to)| laid.amount * hanging.offset(at_rest(vertex), to))
                    .collect();
                for (vertex, offset) in long.vertices.iter().zip(long.smoothed(&of_hair)) {
                    to[index(vertex)] += offset;
                }
                laid.hanging = Some(hanging);
            }
            laid.offsets = vec![DVec3::ZERO; figure.positions.len()];
            for ((&vertex, &now), &to) in strands.vertices.iter().zip(&now).zip(&to) {
                laid.offsets[vertex as usize] = to - now;
            }
            laid.joint_offsets = strands
                .of_joints
                .iter()
                .enumerate()
                .map(|(joint, strand)| match strand {
                    Some(strand) => {
                        laid.of_point(strands, *strand, figure.joints[joint], placement.joint(joint))
                    }
                    None => DVec3::ZERO,
                })
                .collect();
        }
        let placement = Placement { hair_offsets: &laid.offsets, ..placement };
        laid.offsets = product.hair_offsets(&self.target, &placement);
        self.hair = Some(laid);
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
