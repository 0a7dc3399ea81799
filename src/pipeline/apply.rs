//! Takes a character through the field: vertices, their directions, joints.

use super::morphs::SparseTarget;
use super::places::{MeshPlaces, Place};
use super::stages::Number;
use super::{Deformed, DeformedMesh, Deformer, MeshOutputs};
use crate::character::{Joint, Mesh, MorphTarget};
use crate::error::Result;
use crate::parallel;
use crate::progress::Progress;
use crate::shape::directions::{BLOCK, Moved, PIECE, RestTriangles, Room};
use crate::shape::field::{Binding, Ending};
use crate::shape::placement::Placement;
use crate::shape::turn::Turn;
use glam::{DVec3, Vec3, Vec4};
use std::ops::Range;

/// Fewer positions than this are not worth a thread: it takes longer to start than to write them.
const LEAST_POSITIONS: usize = 100_000;
/// Fewer pieces than this are not worth a thread.
const LEAST_PIECES: usize = 10;

impl Deformer {
    /// The whole result.
    pub fn apply(&self) -> Deformed {
        self.apply_with(&mut Progress::none()).unwrap_or_default()
    }

    /// As [`Deformer::apply`], and reports how far it is.
    ///
    /// # Errors
    /// `Cancelled`.
    pub fn apply_with(&self, progress: &mut Progress) -> Result<Deformed> {
        self.apply_to(&vec![MeshOutputs::ALL; self.inputs.character.meshes.len()], progress)
    }

    /// As [`Deformer::apply_with`], for what is asked of each mesh.
    ///
    /// # Errors
    /// `Cancelled`.
    ///
    /// # Panics
    /// `outputs` is not as long as the character has meshes.
    pub fn apply_to(&self, outputs: &[MeshOutputs], progress: &mut Progress) -> Result<Deformed> {
        let meshes = &self.inputs.character.meshes;
        assert_eq!(outputs.len(), meshes.len(), "one for each mesh");
        let made = |(mesh, asked): (&Mesh, &MeshOutputs)| DeformedMesh {
            positions: vec![Vec3::ZERO; mesh.positions.len()],
            normals: vec![Vec3::ZERO; if asked.normals { mesh.normals.len() } else { 0 }],
            tangents: vec![Vec4::ZERO; if asked.tangents { mesh.tangents.len() } else { 0 }],
            morph_targets: Vec::new(),
        };
        let asked = |mesh: usize| outputs[mesh].morph_targets;
        let targets = self.deformed_targets(asked, &mut progress.part(0.0, 0.8))?;
        let mut deformed: Vec<DeformedMesh> = meshes.iter().zip(outputs).map(made).collect();
        let places = deformed.iter_mut().map(|mesh| MeshPlaces {
            positions: Some(&mut mesh.positions[..]),
            normals: (!mesh.normals.is_empty()).then_some(&mut mesh.normals[..]),
            tangents: (!mesh.tangents.is_empty()).then_some(&mut mesh.tangents[..]),
        });
        self.apply_into(places, &mut progress.part(0.8, 1.0))?;
        for ((mesh, of), targets) in meshes.iter().zip(&mut deformed).zip(targets) {
            let dense = |(target, sparse): (&MorphTarget, SparseTarget)| {
                sparse.dense(&target.name, mesh.positions.len())
            };
            of.morph_targets = mesh.morph_targets.iter().zip(targets).map(dense).collect();
        }
        Ok(Deformed { meshes: deformed, joints: self.deformed_joints() })
    }

    /// Whether writing this allocates memory: morph targets do each time, directions the first time.
    pub(crate) fn apply_allocates(&self, asked: MeshOutputs) -> bool {
        let directions = asked.normals || asked.tangents;
        asked.morph_targets || directions && !self.view().is_made(Number::REST_TRIANGLES)
    }

    /// Writes the vertices of each mesh, and what else there is a place for.
    ///
    /// # Errors
    /// `Cancelled`, with nothing written.
    pub(crate) fn apply_into<V: Place<Vec3>, W: Place<Vec4>>(
        &self,
        places: impl Iterator<Item = MeshPlaces<V, W>>,
        progress: &mut Progress,
    ) -> Result<()> {
        progress.at(0.0)?;
        let mut room = None;
        for (index, (mesh, mut places)) in self.inputs.character.meshes.iter().zip(places).enumerate() {
            if self.field.finish.is_nothing() {
                places.positions.write(0, &mesh.positions);
                places.normals.write(0, &mesh.normals);
                places.tangents.write(0, &mesh.tangents);
                continue;
            }
            if let Some(positions) = places.positions.take() {
                self.write_positions(index, positions);
            }
            if places.normals.is_some() || places.tangents.is_some() {
                let rest = self.view().rest_triangles()?;
                let places = (places.normals, places.tangents);
                self.write_directions(index, places, &rest, room.get_or_insert_default());
            }
        }
        // All is written: it is too late to stop.
        let _ = progress.at(1.0);
        Ok(())
    }

    /// Where each joint is now, as in [`Deformed::joints`].
    pub fn deformed_joints(&self) -> Vec<DVec3> {
        let joints = &self.inputs.character.skeleton.joints;
        if self.field.finish.is_nothing() {
            return joints.iter().map(|joint| joint.position()).collect();
        }
        let placement = self.placement();
        let place = |(index, joint): (usize, &Joint)| {
            let to = match (eye_joint(&placement, index), &placement.bindings.joints[index]) {
                (Some(eye), _) => eye,
                (None, Binding::Fixed) => return joint.position(),
                (None, Binding::Parts(_) | Binding::Bones(_)) => placement.joint(index),
            };
            placement.figure.frame.to_model(to + self.joint_correction(index))
        };
        joints.iter().enumerate().map(place).collect()
    }

    /// What is added to where the field takes a joint, canonical frame.
    pub(super) fn joint_correction(&self, joint: usize) -> DVec3 {
        let whole = self.displacements.joints.get(joint).copied().unwrap_or_default();
        self.field.finish.share() * whole
    }

    /// The vertices of a mesh.
    pub(super) fn vertices(&self, mesh: usize) -> Range<usize> {
        let starts = &self.target().figure.mesh_starts;
        starts[mesh]..starts[mesh + 1]
    }

    /// Writes where the vertices of a mesh go.
    fn write_positions<V: Place<Vec3>>(&self, mesh: usize, place: V) {
        let rest = &self.inputs.character.meshes[mesh].positions;
        let displacements = &self.displacements.vertices[self.vertices(mesh)];
        let ending = Ending::of(&self.field.finish, &self.target().figure.frame);
        let write = |(): &mut (), vertices: Range<usize>, mut place: V| {
            let mut block = [Vec3::ZERO; BLOCK];
            for start in vertices.clone().step_by(BLOCK) {
                let end = (start + BLOCK).min(vertices.end);
                let from = rest[start..end].iter().zip(&displacements[start..end]);
                for (to, (&p, &displacement)) in block.iter_mut().zip(from) {
                    *to = ending.place(p, displacement);
                }
                place.write(start - vertices.start, &block[..end - start]);
            }
        };
        let threads = self.inputs.options.thread_count;
        parallel::in_shares(threads, rest.len(), LEAST_POSITIONS, &mut (), place, Place::cut, write);
    }

    /// Writes what the directions of a mesh turn into.
    fn write_directions<V: Place<Vec3>, W: Place<Vec4>>(
        &self,
        mesh: usize,
        places: (Option<V>, Option<W>),
        rest: &RestTriangles,
        room: &mut Room,
    ) {
        let Mesh { normals, tangents, .. } = &self.inputs.character.meshes[mesh];
        let directions = (&normals[..], if places.1.is_some() { &tangents[..] } else { &[] });
        let cut = |(normals, tangents): (Option<V>, Option<W>), pieces: usize| {
            let (normals, tangents) = (normals.cut(pieces * PIECE), tangents.cut(pieces * PIECE));
            ((normals.0, tangents.0), (normals.1, tangents.1))
        };
        let write = |room: &mut Room,
                     pieces: Range<usize>,
                     (mut to_normals, mut to_tangents): (Option<V>, Option<W>)| {
            let of_field = |vertex| self.turn_of_field(vertex);
            rest.turn(
                (mesh, pieces),
                &self.moved(),
                of_field,
                directions,
                room,
                |first, normals, tangents| {
                    to_normals.write(first, normals);
                    to_tangents.write(first, tangents);
                },
            );
        };
        let (threads, pieces) = (self.inputs.options.thread_count, rest.piece_count(mesh));
        parallel::in_shares(threads, pieces, LEAST_PIECES, room, places, cut, write);
    }

    pub(super) fn moved(&self) -> Moved<'_> {
        let finish = &self.field.finish;
        let (share, size) = (finish.share() as f32, finish.size as f32);
        Moved { displacements: &self.displacements.vertices, share, size }
    }

    /// The field's own Jacobian at a vertex around which no triangle has one; model space.
    #[cold]
    pub(super) fn turn_of_field(&self, vertex: usize) -> Turn {
        let figure = &self.target().figure;
        let binding = &self.deformation.body.bindings.vertices[vertex];
        let jacobian = self.field.map(figure.positions[vertex], binding).jacobian;
        Turn::of(figure.frame.jacobian_to_model(jacobian).as_mat3().into())
    }
}

/// Where a joint that plays an eye is now, canonical frame: at the same place in the eye that it turns, which the field moves as
/// it moves the face before it. `None` for every other joint.
fn eye_joint(placement: &Placement, joint: usize) -> Option<DVec3> {
    let figure = placement.figure;
    let middle_and_size = |points: Vec<DVec3>| {
        let middle = points.iter().sum::<DVec3>() / points.len() as f64;
        (middle, points.iter().map(|p| p.distance_squared(middle)).sum::<f64>().sqrt())
    };
    let place = |(_, vertices): &(usize, Vec<u32>)| {
        let at_rest = vertices.iter().map(|&vertex| figure.positions[vertex as usize]);
        let (from, before) = middle_and_size(at_rest.collect());
        let (to, after) = middle_and_size(placement.vertices(vertices));
        let scale = after / before;
        scale.is_finite().then(|| to + scale * (figure.joints[joint] - from))
    };
    placement.bindings.eyes.iter().filter(|(eye, _)| *eye == joint).find_map(place)
}
