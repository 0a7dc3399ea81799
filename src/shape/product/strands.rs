//! Strands of hair: connected pieces, which of them part before the eyes and which lie on the body, and what moves them.

use super::anatomy::Anatomy;
use super::curtain::sides;
use super::head::head_frame;
use super::long_hair::{Axis, LongHair};
use super::part::Part;
use super::pieces::Attachment;
use crate::character::Character;
use crate::geometry::components;
use crate::shape::Measured;
use crate::shape::field::Binding;
use crate::shape::figure::Figure;
use crate::shape::heights::Heights;
use glam::DVec3;
use std::collections::BTreeMap;
use std::sync::Arc;

/// A target's hair: strands are connected pieces.
#[derive(Debug)]
pub struct Strands {
    /// The hair's vertices, ascending, and the strand of each.
    pub vertices: Vec<u32>,
    /// See `vertices`.
    pub of_vertices: Vec<u32>,
    /// The strand that a joint moves, or hangs from.
    pub of_joints: Vec<Option<u32>>,
    /// To which side each strand parts, where they do.
    pub sides: Option<Vec<f64>>,
    /// What lies on the body.
    pub long: Option<Arc<LongHair>>,
}

/// Where on the torso's axis long hair is measured about, from the crotch (0) to the shoulder line (1).
const AXIS_HEIGHT: f64 = 0.7;

/// A point of the torso's axis.
pub fn torso_axis(anatomy: &Anatomy) -> DVec3 {
    let Heights { crotch, shoulder_line, .. } = anatomy.landmarks.heights;
    let y = crotch + AXIS_HEIGHT * (shoulder_line - crotch);
    DVec3::new(anatomy.middle_x, y, anatomy.centre_z(y).0)
}

impl Strands {
    /// The hair of `character`, whose vertices are attached to parts by `bindings`.
    pub fn of(character: &Character, measured: &Measured, bindings: &[Binding]) -> Self {
        let figure = &measured.figure;
        let is_hair = |vertex: usize| bindings[vertex].weight(Part::Hair) > 0.5;
        let triangles = figure.triangles_where(is_hair);
        let component = components(&triangles, &measured.weld);
        let mut strands: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
        for vertex in (0..figure.positions.len()).filter(|&vertex| is_hair(vertex)) {
            let welded = measured.weld.representative[vertex] as usize;
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
            let Binding::Parts(binding) = &bindings[vertex] else { return false };
            let arms = bindings[vertex].arms_weight();
            let is_plain = binding.attachment == Attachment::Plain && !figure.is_carried(vertex);
            is_plain && arms < 0.5 && !is_hair(vertex)
        };
        let middle = torso_axis(&measured.anatomy);
        let axis = Axis { frame, middle: [middle.x, middle.z] };
        let long = if strands.is_empty() {
            None
        } else {
            let body = figure.triangles_where(is_body);
            LongHair::of(&figure.positions, &figure.triangles, &measured.weld, &strands, &body, axis)
        };
        let mut hair = Self {
            vertices,
            of_vertices,
            of_joints: Vec::new(),
            sides: sides(&points, covered),
            long: long.map(Arc::new),
        };
        hair.of_joints = hair.of_joints(character, figure);
        hair
    }

    /// The strand of each joint that no role is of: the one that it moves most of, else its parent's.
    fn of_joints(&self, character: &Character, figure: &Figure) -> Vec<Option<u32>> {
        let skeleton = &character.skeleton;
        let mut moved: Vec<BTreeMap<u32, f32>> = vec![BTreeMap::new(); skeleton.joints.len()];
        let mut hair = self.vertices.iter().zip(&self.of_vertices).peekable();
        for (mesh, &start) in character.meshes.iter().zip(&figure.mesh_starts) {
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

    /// The side that a strand parts to.
    pub fn side(&self, strand: u32) -> Option<f64> {
        self.sides.as_ref().map(|sides| sides[strand as usize])
    }

    /// True for a strand that lies on the body.
    pub fn lies(&self, strand: u32) -> bool {
        self.long.as_ref().is_some_and(|long| long.lies[strand as usize])
    }
}
