//! Morph targets after a deformation: each is made again at the vertices that it touches, and is zero at the others.

use super::Deformer;
use super::displacement::single;
use super::memo::View;
use crate::character::{Mesh, MorphTarget};
use crate::error::Result;
use crate::progress::Progress;
use crate::shape::directions::{RestTriangles, Room};
use crate::shape::placement::{LEAST_VERTICES, Placement};
use crate::shape::turn::Turn;
use glam::{DVec3, Vec3};
use std::ops::Range;
use std::sync::{Arc, Mutex, PoisonError};

/// The vertices of a mesh that its morph targets touch.
#[derive(Clone, Debug, Default)]
pub struct Touched {
    /// Of each target, ascending.
    targets: Vec<Arc<Vec<u32>>>,
    /// Of all that move something, ascending.
    moved: Vec<u32>,
}

impl Touched {
    /// Of `mesh`.
    pub fn of(mesh: &Mesh) -> Self {
        let is_changed =
            |deltas: &[Vec3], vertex: usize| deltas.get(vertex).is_some_and(|&d| d != Vec3::ZERO);
        let vertices = 0..mesh.positions.len();
        let touched = |target: &MorphTarget| {
            let arrays = [&target.positions, &target.normals, &target.tangents];
            let is_touched = |&vertex: &usize| arrays.iter().any(|deltas| is_changed(deltas, vertex));
            Arc::new(vertices.clone().filter(is_touched).map(|vertex| vertex as u32).collect())
        };
        let is_moved =
            |vertex: &usize| mesh.morph_targets.iter().any(|target| is_changed(&target.positions, *vertex));
        Self {
            targets: mesh.morph_targets.iter().map(touched).collect(),
            moved: vertices.clone().filter(is_moved).map(|vertex| vertex as u32).collect(),
        }
    }
}

/// A morph target where it changes something, of one mesh.
pub struct SparseTarget {
    /// The vertices, ascending.
    pub vertices: Arc<Vec<u32>>,
    /// Positions, normals and tangents there; `None` where the target has none.
    pub deltas: [Option<Vec<Vec3>>; 3],
}

impl SparseTarget {
    /// The same with a delta for each of `count` vertices.
    pub fn dense(&self, name: &str, count: usize) -> MorphTarget {
        let [positions, normals, tangents] = self.deltas.each_ref().map(|deltas| {
            let Some(deltas) = deltas else { return Vec::new() };
            let mut dense = vec![Vec3::ZERO; count];
            for (&vertex, &delta) in self.vertices.iter().zip(deltas) {
                dense[vertex as usize] = delta;
            }
            dense
        });
        MorphTarget { name: name.to_string(), positions, normals, tangents }
    }
}

/// How far morph targets go all the way beyond their own deltas, model space: of each mesh, once it is asked for, by target and
/// by the vertices that it moves. As a deformer's displacements they stay while amount and height change.
#[derive(Debug, Default)]
pub struct Shifts {
    of: Mutex<Vec<Option<ShiftsOfMesh>>>,
}

/// By target, then by the vertices that it touches.
type ShiftsOfMesh = Arc<Vec<Vec<Vec3>>>;

impl Shifts {
    fn get(&self, mesh: usize) -> Option<ShiftsOfMesh> {
        self.of.lock().unwrap_or_else(PoisonError::into_inner).get(mesh)?.clone()
    }

    fn keep(&self, mesh: usize, shifts: &ShiftsOfMesh) {
        let mut of = self.of.lock().unwrap_or_else(PoisonError::into_inner);
        if of.len() <= mesh {
            of.resize(mesh + 1, None);
        }
        of[mesh] = Some(Arc::clone(shifts));
    }
}

/// What is filled in mesh by mesh: none while what it is made of is the same.
pub fn shifts(view: &View) -> Result<Shifts> {
    view.deformation().map(|_| Shifts::default())
}

impl Deformer {
    /// What the directions of all of a mesh's vertices turn by.
    fn turns(&self, mesh: usize, rest: &RestTriangles) -> Vec<Turn> {
        let mut room = Room::default();
        let mut turns = Vec::with_capacity(self.vertices(mesh).len());
        for piece in rest.pieces(mesh) {
            let jacobians = rest.jacobians(piece, &self.moved(), &mut room);
            let of = |(index, vertex)| jacobians.of(index).unwrap_or_else(|| self.turn_of_field(vertex));
            turns.extend(rest.vertices(piece).enumerate().map(of));
        }
        turns
    }

    /// The morph targets of each mesh of which they are asked for, where they change something.
    ///
    /// # Errors
    /// `Cancelled`.
    pub(crate) fn deformed_targets(
        &self,
        is_asked: impl Fn(usize) -> bool,
        progress: &mut Progress,
    ) -> Result<Vec<Vec<SparseTarget>>> {
        let count = self.inputs.character.meshes.len();
        let of_mesh = |mesh: usize| {
            let at = |mesh: usize| mesh as f32 / count as f32;
            progress.at(at(mesh))?;
            let part = &mut progress.part(at(mesh), at(mesh + 1));
            if is_asked(mesh) { self.targets_of_mesh(mesh, part) } else { Ok(Vec::new()) }
        };
        (0..count).map(of_mesh).collect()
    }

    fn targets_of_mesh(&self, mesh: usize, progress: &mut Progress) -> Result<Vec<SparseTarget>> {
        let Mesh { morph_targets, normals, tangents, .. } = &self.inputs.character.meshes[mesh];
        let touched = &self.view().touched()?[mesh].targets;
        if self.made.field.finish.is_nothing() || morph_targets.is_empty() {
            let same = |target: &MorphTarget, vertices: &[u32]| {
                [&target.positions, &target.normals, &target.tangents].map(|deltas| {
                    let of = |&vertex: &u32| deltas[vertex as usize];
                    (!deltas.is_empty()).then(|| vertices.iter().map(of).collect())
                })
            };
            let sparse = |(target, vertices): (&MorphTarget, &Arc<Vec<u32>>)| SparseTarget {
                vertices: Arc::clone(vertices),
                deltas: same(target, vertices),
            };
            return Ok(morph_targets.iter().zip(touched).map(sparse).collect());
        }
        let turn_normals =
            !normals.is_empty() && morph_targets.iter().any(|target| !target.normals.is_empty());
        let turn_tangents =
            !tangents.is_empty() && morph_targets.iter().any(|target| !target.tangents.is_empty());
        let turns = match turn_normals || turn_tangents {
            true => self.turns(mesh, &*self.view().rest_triangles()?),
            false => Vec::new(),
        };
        let new_normals: Vec<Vec3> =
            turns.iter().zip(normals).map(|(turn, &normal)| turn.normal(normal)).collect();
        let tangent =
            |vertex: usize, tangent: Vec3| turns[vertex].tangent(tangent, new_normals.get(vertex).copied());
        let directions: Vec<Vec3> = tangents.iter().map(|tangent| tangent.truncate()).collect();
        let shifts = self.morph_shifts(mesh, &mut progress.part(0.0, 0.7))?;
        let made = |index: usize| {
            let (target, vertices) = (&morph_targets[index], &touched[index]);
            let turn_normal = |vertex: usize, normal| turns[vertex].normal(normal);
            SparseTarget {
                vertices: Arc::clone(vertices),
                deltas: [
                    self.morph_positions(&target.positions, vertices, &shifts[index]),
                    morph_turns(&target.normals, normals, vertices, &turn_normal),
                    morph_turns(&target.tangents, &directions, vertices, &tangent),
                ],
            }
        };
        let least = if self.vertices(mesh).len() < LEAST_VERTICES { morph_targets.len() } else { 1 };
        let threads = self.inputs.options.thread_count;
        progress.part(0.7, 1.0).collect_with(
            threads,
            morph_targets.len(),
            least,
            || (),
            |(), index| made(index),
        )
    }

    /// D(v + d) - D(v) - d of all vertices that a mesh's targets move, all the way, before amount, ground and height.
    ///
    /// Lids that the face step opens are mapped as deep as they begin: before the ball, the field opens less than on it,
    /// and a lid that shuts beyond the other one's edge would be half-way too early. They go on along the ball, so the
    /// straight way between two places leads through it: ends are put forward until half of the way is where the field
    /// takes half of the way.
    ///
    /// # Errors
    /// `Cancelled`.
    fn morph_shifts(&self, mesh: usize, progress: &mut Progress) -> Result<ShiftsOfMesh> {
        let kept = self.view().shifts()?;
        if let Some(known) = kept.get(mesh) {
            return Ok(known);
        }
        let morph_targets = &self.inputs.character.meshes[mesh].morph_targets;
        let Touched { targets: touched, moved } = &self.view().touched()?[mesh];
        let (deformation, threads) = (&self.made.deformation, self.inputs.options.thread_count);
        let field = &deformation.field;
        let placement = deformation.placement(field, threads);
        let figure = placement.figure;
        let placed = self.placed_of(mesh, moved, &placement);
        let start = self.vertices(mesh).start;
        let shift = |target: usize, vertex: usize| {
            let delta = match morph_targets[target].positions.get(vertex) {
                Some(&delta) if delta != Vec3::ZERO => figure.frame.to_canonical(delta.as_dvec3()),
                _ => return Vec3::ZERO,
            };
            let from = figure.positions[start + vertex];
            let mut to = placement.beside(start + vertex, from + delta);
            let share = field.opens_lids(from, &placement.bindings.vertices[start + vertex]);
            if share > 0.0 {
                let half = placement.beside(start + vertex, from + 0.5 * delta);
                let z = to.z + 2.0 * (half.z - 0.5 * (placed[vertex].z + to.z)).max(0.0);
                to = to.lerp(placement.beside(start + vertex, from + delta.with_z(0.0)).with_z(z), share);
            }
            single(figure.frame.to_model(to - placed[vertex] - delta))
        };
        // Cut where there are as many of all targets together, whatever each touches.
        let ends: Vec<usize> = touched
            .iter()
            .scan(0, |end, touched| {
                *end += touched.len();
                Some(*end)
            })
            .collect();
        let all = ends.last().copied().unwrap_or(0);
        let shift = |_: &mut (), index: usize| {
            let target = ends.partition_point(|&end| end <= index);
            let first = ends[target] - touched[target].len();
            shift(target, touched[target][index - first] as usize)
        };
        let flat = progress.collect_with(threads, all, LEAST_SHIFTS, || (), shift)?;
        let mut rest = &flat[..];
        let by_target = |touched: &Arc<Vec<u32>>| {
            let (own, others) = rest.split_at(touched.len());
            rest = others;
            own.to_vec()
        };
        let shifts = Arc::new(touched.iter().map(by_target).collect());
        kept.keep(mesh, &shifts);
        Ok(shifts)
    }

    /// Where `placement` puts the vertices of a mesh, canonical frame: those that are `moved`.
    fn placed_of(&self, mesh: usize, moved: &[u32], placement: &Placement) -> Vec<DVec3> {
        let Range { start, end } = self.vertices(mesh);
        let all: Vec<u32> = moved.iter().map(|&vertex| start as u32 + vertex).collect();
        let mut placed = vec![DVec3::ZERO; end - start];
        for (&vertex, to) in moved.iter().zip(placement.vertices(&all)) {
            placed[vertex as usize] = to;
        }
        placed
    }

    /// D(v + d) - D(v) of the `touched` vertices: exact, and zero where d is.
    ///
    /// `shifts`: as [`Self::morph_shifts`] gives them.
    fn morph_positions(&self, deltas: &[Vec3], touched: &[u32], shifts: &[Vec3]) -> Option<Vec<Vec3>> {
        let finish = &self.made.field.finish;
        let (size, amount) = (finish.size as f32, finish.amount as f32);
        let moved = |(&vertex, &shift): (&u32, &Vec3)| {
            let to = size * (deltas[vertex as usize] + amount * shift);
            to.clamp(Vec3::splat(f32::MIN), Vec3::splat(f32::MAX))
        };
        (!deltas.is_empty()).then(|| touched.iter().zip(shifts).map(moved).collect())
    }
}

/// Fewer vertices of morph targets than this are not worth a thread.
const LEAST_SHIFTS: usize = 2000;

/// Changes of unit vectors at the `touched` vertices: what the changed vector turns into, less what the unchanged one does.
fn morph_turns(
    deltas: &[Vec3],
    before: &[Vec3],
    touched: &[u32],
    turn: &dyn Fn(usize, Vec3) -> Vec3,
) -> Option<Vec<Vec3>> {
    let turned = |&vertex: &u32| {
        let vertex = vertex as usize;
        let delta = deltas[vertex];
        // Without base vectors there is nothing that the deltas change.
        if delta == Vec3::ZERO || before.len() != deltas.len() {
            return delta;
        }
        let before = before[vertex];
        let changed = before + delta;
        // What comes out is of unit length, whatever came in.
        let length = if before == Vec3::ZERO { 1.0 } else { before.length() };
        turn(vertex, changed) * (changed.length() / length) - turn(vertex, before)
    };
    (!deltas.is_empty()).then(|| touched.iter().map(turned).collect())
}
