//! Strands of hair: connected pieces, which of them part before the eyes and which lie on the body, and what moves them.

use super::Target;
use super::attach::Bindings;
use crate::geometry::components;
use crate::shape::field::Binding;
use crate::shape::heights::Heights;
use crate::shape::product::anatomy::Anatomy;
use crate::shape::product::curtain::sides;
use crate::shape::product::head::head_frame;
use crate::shape::product::long_hair::{Axis, LongHair};
use crate::shape::product::part::Part;
use crate::shape::product::pieces::Attachment;
use glam::DVec3;
use std::collections::BTreeMap;
use std::sync::Arc;

/// A target's hair: strands are connected pieces.
#[derive(Debug)]
pub struct Strands {
    /// The hair's vertices, ascending, and the strand of each.
    pub(super) vertices: Vec<u32>,
    pub(super) of_vertices: Vec<u32>,
    /// The strand that a joint moves, or hangs from.
    pub(super) of_joints: Vec<Option<u32>>,
    /// To which side each strand parts, where they do.
    pub(super) sides: Option<Vec<f64>>,
    /// What lies on the body.
    pub(super) long: Option<Arc<LongHair>>,
}

/// Where on the torso's axis long hair is measured about, from the crotch (0) to the shoulder line (1).
const AXIS_HEIGHT: f64 = 0.7;

/// A point of the torso's axis.
pub(super) fn torso_axis(anatomy: &Anatomy) -> DVec3 {
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
        let mut hair = self.vertices.iter().zip(&self.of_vertices).peekable();
        for (mesh, &start) in target.character.meshes.iter().zip(&figure.mesh_starts) {
            for (vertex, row) in mesh.weights.rows().enumerate() {
                let here = (start + vertex) as u32;
                // Past what no weights are of.
                while hair.next_if(|(hair, _)| **hair < here).is_some() {}
                if let Some((_, &strand)) = hair.next_if(|(hair, _)| **hair == here) {
                    for &(joint, weight) in row {
                        *moved[joint as usize].entry(strand).or_default() += weight;
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

    pub(super) fn side(&self, strand: u32) -> Option<f64> {
        self.sides.as_ref().map(|sides| sides[strand as usize])
    }

    pub(super) fn lies(&self, strand: u32) -> bool {
        self.long.as_ref().is_some_and(|long| long.lies[strand as usize])
    }
}
