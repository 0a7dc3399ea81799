//! Takes a character through the field: vertices, their directions, joints.

use super::displacement::Ending;
use super::morphs::SparseTarget;
use super::places::{MeshPlaces, Place};
use super::stages::Number;
use super::{Deformed, DeformedMesh, Deformer, MeshOutputs};
use crate::character::{Joint, Mesh, MorphTarget};
use crate::error::Result;
use crate::parallel;
use crate::progress::Progress;
use crate::shape::directions::{Jacobians, Moved, PIECE, RestTriangles, Room};
use crate::shape::field::Binding;
use crate::shape::turn::{LANES, Turn, each_of, four_at, four_of, transposed};
use glam::{DVec3, Vec3, Vec4};
use std::ops::Range;
use std::sync::{Mutex, PoisonError};

/// Positions that are written together.
const BLOCK: usize = 256;
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
        let eyes = self.eye_joints();
        let frame = &placement.figure.frame;
        let place = |index: usize, joint: &Joint| match eyes.iter().find(|(eye, _)| *eye == index) {
            Some(&(_, at)) => frame.to_model(at + self.joint_correction(index)),
            None => match placement.bindings.joints[index] {
                Binding::Fixed => joint.position(),
                _ => frame.to_model(placement.joint(index) + self.joint_correction(index)),
            },
        };
        joints.iter().enumerate().map(|(index, joint)| place(index, joint)).collect()
    }

    /// What is added to where the field takes a joint, canonical frame.
    pub(super) fn joint_correction(&self, joint: usize) -> DVec3 {
        let whole = self.displacements.joints.get(joint).copied().unwrap_or_default();
        self.field.finish.share() * whole
    }

    /// Joints that play eyes, and where they are now, canonical frame: at the same place in the eye that they turn, which the
    /// field moves as it moves the face before it.
    fn eye_joints(&self) -> Vec<(usize, DVec3)> {
        let placement = self.placement();
        let figure = placement.figure;
        let place = |(joint, vertices): &(usize, Vec<u32>)| {
            let before: Vec<DVec3> =
                vertices.iter().map(|&vertex| figure.positions[vertex as usize]).collect();
            let after = placement.vertices(vertices);
            let middle = |points: &[DVec3]| points.iter().sum::<DVec3>() / points.len() as f64;
            let (from, to) = (middle(&before), middle(&after));
            let size = |points: &[DVec3], middle: DVec3| {
                points.iter().map(|p| p.distance_squared(middle)).sum::<f64>().sqrt()
            };
            let scale = size(&after, to) / size(&before, from);
            scale.is_finite().then(|| (*joint, to + scale * (figure.joints[*joint] - from)))
        };
        placement.bindings.eyes.iter().filter_map(place).collect()
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
        let write = |(): &mut (), first: usize, count: usize, mut place: V| {
            let mut block = [Vec3::ZERO; BLOCK];
            for start in (first..first + count).step_by(BLOCK) {
                let end = (start + BLOCK).min(first + count);
                let from = rest[start..end].iter().zip(&displacements[start..end]);
                for (to, (&p, &displacement)) in block.iter_mut().zip(from) {
                    *to = ending.place(p, displacement);
                }
                place.write(start - first, &block[..end - start]);
            }
        };
        let threads = self.inputs.options.thread_count;
        in_shares(threads, rest.len(), LEAST_POSITIONS, &mut (), place, Place::cut, write);
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
        let pieces = rest.pieces(mesh);
        let start = self.vertices(mesh).start;
        let cut = |(normals, tangents): (Option<V>, Option<W>), pieces: usize| {
            let (normals, tangents) = (normals.cut(pieces * PIECE), tangents.cut(pieces * PIECE));
            ((normals.0, tangents.0), (normals.1, tangents.1))
        };
        let write = |room: &mut Room, first: usize, count: usize, to: (Option<V>, Option<W>)| {
            let (mut to_normals, mut to_tangents) = to;
            let mut block = Directions { normals: [Vec3::ZERO; BLOCK], tangents: [Vec4::ZERO; BLOCK] };
            for (at, piece) in pieces.clone().skip(first).take(count).enumerate() {
                let jacobians = rest.jacobians(piece, &self.moved(), room);
                let vertices = rest.vertices(piece);
                for from in (0..vertices.len()).step_by(BLOCK) {
                    let count = BLOCK.min(vertices.len() - from);
                    let of_mesh = vertices.start - start + from..vertices.start - start + from + count;
                    let normals = normals.get(of_mesh.clone()).unwrap_or_default();
                    let tangents = tangents.get(of_mesh).filter(|_| to_tangents.is_some());
                    let of_field = |index| self.turn_of_field(vertices.start + from + index);
                    block.turn(&jacobians, from, normals, tangents.unwrap_or_default(), of_field);
                    to_normals.write(at * PIECE + from, &block.normals[..count]);
                    to_tangents.write(at * PIECE + from, &block.tangents[..count]);
                }
            }
        };
        let threads = self.inputs.options.thread_count;
        in_shares(threads, pieces.len(), LEAST_PIECES, room, places, cut, write);
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

/// Directions that are written together.
struct Directions {
    normals: [Vec3; BLOCK],
    tangents: [Vec4; BLOCK],
}

impl Directions {
    /// Turns those of the vertices of a piece that follow `from`, none of a kind that is not there.
    ///
    /// `of_field`: for a vertex that has no Jacobian.
    fn turn(
        &mut self,
        jacobians: &Jacobians,
        from: usize,
        normals: &[Vec3],
        tangents: &[Vec4],
        of_field: impl Fn(usize) -> Turn,
    ) {
        let count = normals.len().max(tangents.len());
        for four in (0..count).step_by(LANES) {
            let (turns, are_sound) = jacobians.of_four(from + four);
            let new = (!normals.is_empty()).then(|| turns.normals(four_of(four_at(normals, four))));
            if let Some(new) = new {
                let to = each_of(new, Vec4::ZERO).map(Vec4::truncate);
                self.normals[four..four + LANES].copy_from_slice(&to);
            }
            if !tangents.is_empty() {
                let [x, y, z, sides] = transposed(four_at(tangents, four));
                let to = each_of(turns.tangents([x, y, z], new), sides);
                self.tangents[four..four + LANES].copy_from_slice(&to);
            }
            if !are_sound.all() {
                for index in (four..count.min(four + LANES)).filter(|index| !are_sound.test(index - four)) {
                    self.turn_one(index, &of_field(index), normals, tangents);
                }
            }
        }
    }

    /// Turns those of one vertex.
    fn turn_one(&mut self, index: usize, turn: &Turn, normals: &[Vec3], tangents: &[Vec4]) {
        let normal = normals.get(index).map(|&normal| turn.normal(normal));
        self.normals[index] = normal.unwrap_or_default();
        if let Some(tangent) = tangents.get(index) {
            self.tangents[index] = turn.tangent(tangent.truncate(), normal).extend(tangent.w);
        }
    }
}

/// Does `write` of so many items from one of them on, in shares side by side where there is enough to do.
///
/// - `room`: what it works in, where there is one share; each of several gets its own.
/// - `cut`: a place for the items before one of them, and for the rest.
fn in_shares<R: Default, P: Send>(
    threads: usize,
    count: usize,
    least: usize,
    room: &mut R,
    place: P,
    cut: impl Fn(P, usize) -> (P, P),
    write: impl Fn(&mut R, usize, usize, P) + Sync,
) {
    let share_count = parallel::share_count(threads, count, least);
    if share_count == 1 {
        return write(room, 0, count, place);
    }
    let share = count.div_ceil(share_count);
    let mut shares = Vec::with_capacity(share_count);
    let mut rest = place;
    for _ in 1..count.div_ceil(share) {
        let (first, others) = cut(rest, share);
        shares.push(Mutex::new(Some(first)));
        rest = others;
    }
    shares.push(Mutex::new(Some(rest)));
    parallel::collect(threads, shares.len(), 1, |index| {
        if let Some(place) = shares[index].lock().unwrap_or_else(PoisonError::into_inner).take() {
            let first = index * share;
            write(&mut R::default(), first, share.min(count - first), place);
        }
    });
}
