//! Morph targets after a deformation: each is made anew at the vertices that it touches, and is zero at the others.

use super::Deformer;
use super::attach::LEAST_VERTICES;
use super::displacement::single;
use crate::character::{Mesh, MorphTarget};
use crate::error::Result;
use crate::parallel;
use crate::progress::Progress;
use crate::shape::directions::Room;
use crate::shape::turn::Turn;
use glam::{DVec3, Vec3};
use std::ops::Range;
use std::sync::Arc;

/// The vertices of a mesh that its morph targets touch.
#[derive(Clone, Debug, Default)]
pub struct Touched {
    /// Of each target, ascending.
    targets: Vec<Vec<u32>>,
    /// Of all that move something, ascending.
    moved: Vec<u32>,
}

impl Touched {
    fn of(mesh: &Mesh) -> Self {
        let is_changed =
            |deltas: &[Vec3], vertex: usize| deltas.get(vertex).is_some_and(|&d| d != Vec3::ZERO);
        let vertices = 0..mesh.positions.len();
        let touched = |target: &MorphTarget| {
            let arrays = [&target.positions, &target.normals, &target.tangents];
            let is_touched = |&vertex: &usize| arrays.iter().any(|deltas| is_changed(deltas, vertex));
            vertices.clone().filter(is_touched).map(|vertex| vertex as u32).collect()
        };
        let is_moved =
            |vertex: &usize| mesh.morph_targets.iter().any(|target| is_changed(&target.positions, *vertex));
        Self {
            targets: mesh.morph_targets.iter().map(touched).collect(),
            moved: vertices.clone().filter(is_moved).map(|vertex| vertex as u32).collect(),
        }
    }
}

impl Deformer {
    fn touched(&self) -> &[Touched] {
        let meshes = &self.target.character.meshes;
        self.target.touched.get_or_init(|| Arc::new(meshes.iter().map(Touched::of).collect()))
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
        if self.field.finish.is_nothing() || morph_targets.is_empty() {
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
        let Touched { targets: touched, moved } = &self.touched()[mesh];
        let placed = self.placed_of(mesh, moved);
        let least = if self.vertices(mesh).len() < LEAST_VERTICES { usize::MAX } else { 1 };
        parallel::collect(self.options.thread_count, morph_targets.len(), least, |index| {
            let (target, touched) = (&morph_targets[index], &touched[index]);
            MorphTarget {
                name: target.name.clone(),
                positions: self.morph_positions(mesh, &target.positions, touched, &placed),
                normals: morph_turns(&target.normals, normals, touched, &|vertex, normal| {
                    turns[vertex].normal(normal)
                }),
                tangents: morph_turns(&target.tangents, &directions, touched, &tangent),
            }
        })
    }

    /// Where the vertices of a mesh go, canonical frame: those that are `moved`.
    fn placed_of(&self, mesh: usize, moved: &[u32]) -> Vec<DVec3> {
        let Range { start, end } = self.vertices(mesh);
        let all: Vec<u32> = moved.iter().map(|&vertex| start as u32 + vertex).collect();
        let mut placed = vec![DVec3::ZERO; end - start];
        for (&vertex, to) in moved.iter().zip(self.placement().vertices(&all)) {
            placed[vertex as usize] = to;
        }
        placed
    }

    /// D(v + d) - D(v): exact, and zero where d is.
    ///
    /// `placed`: D(v) of each vertex that moves.
    fn morph_positions(&self, mesh: usize, deltas: &[Vec3], touched: &[u32], placed: &[DVec3]) -> Vec<Vec3> {
        let start = self.vertices(mesh).start;
        let placement = self.placement();
        let figure = placement.figure;
        let mut moved = vec![Vec3::ZERO; deltas.len()];
        for &vertex in touched {
            let vertex = vertex as usize;
            if let Some(&delta) = deltas.get(vertex).filter(|&&delta| delta != Vec3::ZERO) {
                let p = figure.positions[start + vertex] + figure.frame.to_canonical(delta.as_dvec3());
                let to = placement.beside(start + vertex, p);
                moved[vertex] = single(figure.frame.to_model(to - placed[vertex]));
            }
        }
        moved
    }
}

/// Changes of unit vectors: what the changed vector turns into, less what the unchanged one does.
fn morph_turns(
    deltas: &[Vec3],
    before: &[Vec3],
    touched: &[u32],
    turn: &dyn Fn(usize, Vec3) -> Vec3,
) -> Vec<Vec3> {
    if deltas.is_empty() || before.len() != deltas.len() {
        // Without base vectors there is nothing that the deltas change.
        return deltas.to_vec();
    }
    let mut turned = vec![Vec3::ZERO; deltas.len()];
    for vertex in touched.iter().map(|&vertex| vertex as usize) {
        let (delta, before) = (deltas[vertex], before[vertex]);
        if delta == Vec3::ZERO {
            continue;
        }
        let changed = before + delta;
        // What comes out is of unit length, whatever came in.
        let length = if before == Vec3::ZERO { 1.0 } else { before.length() };
        turned[vertex] = turn(vertex, changed) * (changed.length() / length) - turn(vertex, before);
    }
    turned
}
