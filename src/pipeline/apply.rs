//! Takes a character through the field: vertices, their directions, morph targets, joints.

use super::attach::LEAST_VERTICES;
use super::displacement::{Displacements, Ending, single};
use super::places::{MeshPlaces, Place};
use super::{Deformed, DeformedMesh, Deformer, MeshOutputs};
use crate::character::{Mesh, MorphTarget};
use crate::error::Result;
use crate::parallel;
use crate::progress::Progress;
use crate::shape::Measured;
use crate::shape::directions::{Moved, PIECE, RestTriangles, Room, Turn};
use crate::shape::field::Binding;
use glam::{DVec3, Vec3, Vec4};
use std::ops::Range;
use std::sync::{Arc, Mutex, PoisonError};

/// Positions that are written together.
const BLOCK: usize = 256;
/// Fewer positions than this are not worth a thread: it takes longer to start than to write them.
const LEAST_POSITIONS: usize = 100_000;
/// Fewer pieces than this are not worth a thread.
const LEAST_PIECES: usize = 40;

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
        self.apply_to(&vec![MeshOutputs::ALL; self.target.character.meshes.len()], progress)
    }

    /// As [`Deformer::apply_with`], for what is asked of each mesh.
    ///
    /// # Errors
    /// `Cancelled`.
    ///
    /// # Panics
    /// `outputs` is not as long as the character has meshes.
    pub fn apply_to(&self, outputs: &[MeshOutputs], progress: &mut Progress) -> Result<Deformed> {
        let meshes = &self.target.character.meshes;
        assert_eq!(outputs.len(), meshes.len(), "one for each mesh");
        let made = |mesh: &Mesh, asked: &MeshOutputs| DeformedMesh {
            positions: vec![Vec3::ZERO; mesh.positions.len()],
            normals: vec![Vec3::ZERO; if asked.normals { mesh.normals.len() } else { 0 }],
            tangents: vec![Vec4::ZERO; if asked.tangents { mesh.tangents.len() } else { 0 }],
            morph_targets: Vec::new(),
        };
        let asked = |mesh: usize| outputs[mesh].morph_targets;
        let targets = self.deformed_targets(asked, &mut progress.part(0.0, 0.8))?;
        let mut deformed: Vec<DeformedMesh> =
            meshes.iter().zip(outputs).map(|(mesh, asked)| made(mesh, asked)).collect();
        let places = deformed.iter_mut().map(|mesh| MeshPlaces {
            positions: Some(&mut mesh.positions[..]),
            normals: (!mesh.normals.is_empty()).then_some(&mut mesh.normals[..]),
            tangents: (!mesh.tangents.is_empty()).then_some(&mut mesh.tangents[..]),
        });
        self.apply_into(places, &mut progress.part(0.8, 1.0))?;
        for (mesh, targets) in targets.into_iter().enumerate() {
            deformed[mesh].morph_targets = targets;
        }
        Ok(Deformed { meshes: deformed, joints: self.deformed_joints() })
    }

    /// Whether writing this allocates memory: morph targets do each time, directions the first time.
    pub(crate) fn apply_allocates(&self, asked: MeshOutputs) -> bool {
        let directions = asked.normals || asked.tangents;
        asked.morph_targets || directions && self.target.rest_triangles.get().is_none()
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
        let meshes = &self.target.character.meshes;
        for (index, mut places) in places.enumerate() {
            if self.field.finish.is_nothing() {
                write_unchanged(&meshes[index], places);
                continue;
            }
            if let Some(positions) = places.positions.take() {
                self.write_positions(index, positions);
            }
            if places.normals.is_some() || places.tangents.is_some() {
                self.write_directions(index, places);
            }
        }
        // All is written: it is too late to stop.
        let _ = progress.at(1.0);
        Ok(())
    }

    /// Where each joint is now, as in [`Deformed::joints`].
    pub fn deformed_joints(&self) -> Vec<DVec3> {
        let joints = &self.target.character.skeleton.joints;
        if self.field.finish.is_nothing() {
            return joints.iter().map(|joint| joint.position()).collect();
        }
        let placement = self.placement();
        let eyes = self.eye_joints();
        joints
            .iter()
            .enumerate()
            .map(|(index, joint)| match eyes.iter().find(|(eye, _)| *eye == index) {
                Some(&(_, at)) => placement.figure.frame.to_model(at),
                None => match placement.bindings.joints[index] {
                    Binding::Fixed => joint.position(),
                    _ => placement.figure.frame.to_model(placement.joint(index)),
                },
            })
            .collect()
    }

    /// Joints that play eyes, and where they are now, canonical frame: at the same place in the eye that they turn, which the
    /// field moves as it moves the face before it.
    fn eye_joints(&self) -> Vec<(usize, DVec3)> {
        let Some(product) = &self.deformation.product else { return Vec::new() };
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
        product.eyes.iter().filter_map(place).collect()
    }

    /// Where the vertices go, model space, mesh after mesh.
    pub(super) fn deformed_positions(&self) -> impl Iterator<Item = Vec3> + '_ {
        let ending = self.ending();
        let rest = self.target.character.meshes.iter().flat_map(|mesh| &mesh.positions);
        rest.zip(self.displacements()).map(move |(&p, &displacement)| ending.place(p, displacement))
    }

    fn displacements(&self) -> &[Vec3] {
        self.displacements.as_ref().map_or(&[], Displacements::all)
    }

    fn ending(&self) -> Ending {
        Ending::of(&self.field.finish, &self.target.measured.figure.frame)
    }

    /// The vertices of a mesh.
    fn vertices(&self, mesh: usize) -> Range<usize> {
        let starts = &self.target.measured.figure.mesh_starts;
        starts[mesh]..starts[mesh + 1]
    }

    /// Writes where the vertices of a mesh go.
    fn write_positions<V: Place<Vec3>>(&self, mesh: usize, place: V) {
        let rest = &self.target.character.meshes[mesh].positions;
        let displacements = &self.displacements()[self.vertices(mesh)];
        let ending = self.ending();
        let write = |first: usize, count: usize, mut place: V| {
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
        let threads = self.options.thread_count;
        in_shares(threads, rest.len(), LEAST_POSITIONS, place, Place::cut, write);
    }

    /// Writes what the directions of a mesh turn into.
    fn write_directions<V: Place<Vec3>, W: Place<Vec4>>(&self, mesh: usize, places: MeshPlaces<V, W>) {
        let rest = self.rest_triangles();
        let Mesh { normals, tangents, .. } = &self.target.character.meshes[mesh];
        let pieces = rest.pieces(mesh);
        let start = self.vertices(mesh).start;
        let cut = |places: MeshPlaces<V, W>, count: usize| places.cut(count * PIECE);
        let write = |first: usize, count: usize, mut places: MeshPlaces<V, W>| {
            let mut room = Room::default();
            let mut new_normals = [Vec3::ZERO; PIECE];
            let mut new_tangents = [Vec4::ZERO; PIECE];
            for (at, piece) in pieces.clone().skip(first).take(count).enumerate() {
                let jacobians = rest.jacobians(piece, &self.moved(), &mut room);
                let vertices = rest.vertices(piece);
                for (index, vertex) in vertices.clone().enumerate() {
                    let turn = jacobians.of(index).unwrap_or_else(|| self.turn_of_field(vertex));
                    let new_normal = normals.get(vertex - start).map(|&normal| turn.normal(normal));
                    if let Some(normal) = new_normal {
                        new_normals[index] = normal;
                    }
                    if places.tangents.is_some() {
                        let tangent = tangents[vertex - start];
                        let turned = turn.tangent(tangent.truncate(), new_normal);
                        new_tangents[index] = turned.extend(tangent.w);
                    }
                }
                if let Some(normals) = &mut places.normals {
                    normals.write(at * PIECE, &new_normals[..vertices.len()]);
                }
                if let Some(tangents) = &mut places.tangents {
                    tangents.write(at * PIECE, &new_tangents[..vertices.len()]);
                }
            }
        };
        let threads = self.options.thread_count;
        in_shares(threads, pieces.len(), LEAST_PIECES, places, cut, write);
    }

    fn rest_triangles(&self) -> &RestTriangles {
        let Measured { figure, weld, .. } = &*self.target.measured;
        self.target.rest_triangles.get_or_init(|| {
            let meshes = &self.target.character.meshes;
            let positions: Vec<Vec3> = meshes.iter().flat_map(|mesh| &mesh.positions).copied().collect();
            Arc::new(RestTriangles::of(&positions, &figure.triangles, &figure.mesh_starts, weld))
        })
    }

    fn moved(&self) -> Moved<'_> {
        let finish = &self.field.finish;
        let (share, size) = ((finish.size * finish.amount) as f32, finish.size as f32);
        Moved { displacements: self.displacements(), share, size }
    }

    /// The field's own Jacobian at a vertex around which no triangle has one; model space.
    #[cold]
    fn turn_of_field(&self, vertex: usize) -> Turn {
        let figure = &self.target.measured.figure;
        let binding = &self.deformation.bindings.vertices[vertex];
        let jacobian = self.field.map(figure.positions[vertex], binding).jacobian;
        Turn::of(figure.frame.jacobian_to_model(jacobian).as_mat3().into())
    }

    /// What the directions of all of a mesh's vertices turn by.
    fn turns(&self, mesh: usize) -> Vec<Turn> {
        let rest = self.rest_triangles();
        let mut room = Room::default();
        let mut turns = Vec::with_capacity(self.vertices(mesh).len());
        for piece in rest.pieces(mesh) {
            let jacobians = rest.jacobians(piece, &self.moved(), &mut room);
            let of = |(index, vertex)| jacobians.of(index).unwrap_or_else(|| self.turn_of_field(vertex));
            turns.extend(rest.vertices(piece).enumerate().map(of));
        }
        turns
    }

    /// The morph targets of each mesh of which they are asked for.
    ///
    /// # Errors
    /// `Cancelled`.
    pub(crate) fn deformed_targets(
        &self,
        is_asked: impl Fn(usize) -> bool,
        progress: &mut Progress,
    ) -> Result<Vec<Vec<MorphTarget>>> {
        let count = self.target.character.meshes.len();
        let of_mesh = |mesh: usize| {
            progress.at(mesh as f32 / count as f32)?;
            Ok(if is_asked(mesh) { self.targets_of_mesh(mesh) } else { Vec::new() })
        };
        (0..count).map(of_mesh).collect()
    }

    fn targets_of_mesh(&self, mesh: usize) -> Vec<MorphTarget> {
        let Mesh { morph_targets, normals, tangents, .. } = &self.target.character.meshes[mesh];
        if self.field.finish.is_nothing() {
            return morph_targets.clone();
        }
        let turn_normals =
            !normals.is_empty() && morph_targets.iter().any(|target| !target.normals.is_empty());
        let turn_tangents =
            !tangents.is_empty() && morph_targets.iter().any(|target| !target.tangents.is_empty());
        let turns = if turn_normals || turn_tangents { self.turns(mesh) } else { Vec::new() };
        let new_normals: Vec<Vec3> =
            turns.iter().zip(normals).map(|(turn, &normal)| turn.normal(normal)).collect();
        let tangent =
            |vertex: usize, tangent: Vec3| turns[vertex].tangent(tangent, new_normals.get(vertex).copied());
        let directions: Vec<Vec3> = tangents.iter().map(|tangent| tangent.truncate()).collect();
        let least = if self.vertices(mesh).len() < LEAST_VERTICES { usize::MAX } else { 1 };
        parallel::collect(self.options.thread_count, morph_targets.len(), least, |index| {
            let target = &morph_targets[index];
            MorphTarget {
                name: target.name.clone(),
                positions: self.morph_positions(self.vertices(mesh).start, &target.positions),
                normals: morph_turns(&target.normals, normals, &|vertex, normal| {
                    turns[vertex].normal(normal)
                }),
                tangents: morph_turns(&target.tangents, &directions, &tangent),
            }
        })
    }

    /// D(v + d) - D(v): exact, and zero where d is.
    fn morph_positions(&self, start: usize, deltas: &[Vec3]) -> Vec<Vec3> {
        let placement = self.placement();
        let figure = placement.figure;
        let moved = |(vertex, &delta): (usize, &Vec3)| {
            if delta == Vec3::ZERO {
                return Vec3::ZERO;
            }
            let whole = start + vertex;
            let p = figure.positions[whole] + figure.frame.to_canonical(delta.as_dvec3());
            single(figure.frame.to_model(placement.beside(whole, p) - placement.vertex(whole)))
        };
        deltas.iter().enumerate().map(moved).collect()
    }
}

/// Does `write` of so many items from one of them on, in shares side by side where there is enough to do.
///
/// `cut`: a place for the items before one of them, and for the rest.
fn in_shares<P: Send>(
    threads: usize,
    count: usize,
    least: usize,
    place: P,
    cut: impl Fn(P, usize) -> (P, P),
    write: impl Fn(usize, usize, P) + Sync,
) {
    let share_count = parallel::share_count(threads, count, least);
    if share_count == 1 {
        return write(0, count, place);
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
            write(first, share.min(count - first), place);
        }
    });
}

/// The mesh as it came, of it what there is a place for.
fn write_unchanged<V: Place<Vec3>, W: Place<Vec4>>(mesh: &Mesh, mut places: MeshPlaces<V, W>) {
    if let Some(positions) = &mut places.positions {
        positions.write(0, &mesh.positions);
    }
    if let Some(normals) = &mut places.normals {
        normals.write(0, &mesh.normals);
    }
    if let Some(tangents) = &mut places.tangents {
        tangents.write(0, &mesh.tangents);
    }
}

/// Changes of unit vectors: what the changed vector turns into, less what the unchanged one does.
fn morph_turns(deltas: &[Vec3], before: &[Vec3], turn: &dyn Fn(usize, Vec3) -> Vec3) -> Vec<Vec3> {
    if before.len() != deltas.len() {
        // Without base vectors there is nothing that the deltas change.
        return deltas.to_vec();
    }
    deltas
        .iter()
        .enumerate()
        .map(|(vertex, &delta)| {
            if delta == Vec3::ZERO {
                return Vec3::ZERO;
            }
            let changed = before[vertex] + delta;
            // What comes out is of unit length, whatever came in.
            let length = if before[vertex] == Vec3::ZERO { 1.0 } else { before[vertex].length() };
            turn(vertex, changed) * (changed.length() / length) - turn(vertex, before[vertex])
        })
        .collect()
}
