//! Morph targets after a deformation: each is made again at the vertices that it touches, and is zero at the others.

use super::Deformer;
use super::displacement::single;
use super::memo::View;
use crate::character::{Mesh, MorphTarget};
use crate::error::Result;
use crate::geometry::distinct;
use crate::parallel;
use crate::progress::Progress;
use crate::shape::directions::{RestTriangles, Room};
use crate::shape::placement::Placement;
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

/// A morph target before a deformation, where it changes something.
pub struct GivenTarget<'a> {
    /// The vertices, ascending.
    pub vertices: Arc<Vec<u32>>,
    /// Positions, normals and tangents; empty where it has none.
    pub deltas: [&'a [Vec3]; 3],
    /// Whether these are of all vertices of the mesh, else of `vertices` alone.
    pub is_dense: bool,
}

impl<'a> GivenTarget<'a> {
    fn of((target, vertices): (&'a MorphTarget, &Arc<Vec<u32>>)) -> Self {
        let deltas = [&target.positions[..], &target.normals, &target.tangents];
        Self { vertices: Arc::clone(vertices), deltas, is_dense: true }
    }

    /// One of `vertices` with what is added to it.
    fn at(&self, which: usize, index: usize) -> Option<(usize, Vec3)> {
        let vertex = self.vertices[index] as usize;
        Some((vertex, *self.deltas[which].get(if self.is_dense { vertex } else { index })?))
    }

    /// All of them; `None` where the target has no such changes.
    fn each(&self, which: usize) -> Option<impl Iterator<Item = (usize, Vec3)>> {
        let of = move |index: usize| self.at(which, index);
        (!self.deltas[which].is_empty()).then(|| (0..self.vertices.len()).filter_map(of))
    }

    /// With other deltas.
    fn with(&self, deltas: [Option<Vec<Vec3>>; 3]) -> SparseTarget {
        SparseTarget { vertices: Arc::clone(&self.vertices), deltas }
    }

    fn same(&self) -> SparseTarget {
        self.with([0, 1, 2].map(|which| Some(self.each(which)?.map(|(_, delta)| delta).collect())))
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
        let touched = self.view().touched()?;
        let of_mesh = &self.inputs.character.meshes[mesh].morph_targets;
        let given: Vec<GivenTarget> =
            of_mesh.iter().zip(&touched[mesh].targets).map(GivenTarget::of).collect();
        let kept = self.view().shifts()?;
        let shifts = match kept.get(mesh) {
            Some(known) => known,
            None if self.made.field.finish.is_nothing() => Arc::default(),
            None => {
                let part = &mut progress.part(0.0, 0.7);
                let shifts = Arc::new(self.shifts_of(mesh, &given, &touched[mesh].moved, part)?);
                kept.keep(mesh, &shifts);
                shifts
            }
        };
        self.shifted(mesh, &given, &shifts, &mut progress.part(0.7, 1.0))
    }

    /// Morph targets of a mesh, those of the character or others, as [`Self::deformed_targets`] has them.
    pub(crate) fn map_targets(&self, mesh: usize, given: &[GivenTarget]) -> Result<Vec<SparseTarget>> {
        let progress = &mut Progress::none();
        if self.made.field.finish.is_nothing() {
            return self.shifted(mesh, given, &[], progress);
        }
        let is_moved = |(_, delta): &(usize, Vec3)| *delta != Vec3::ZERO;
        let of = |target| GivenTarget::each(target, 0).into_iter().flatten().filter(is_moved);
        let moved = distinct(given.iter().flat_map(of).map(|(vertex, _)| vertex as u32));
        let shifts = self.shifts_of(mesh, given, &moved, progress)?;
        self.shifted(mesh, given, &shifts, progress)
    }

    /// The targets after the deformation.
    ///
    /// `shifts`: as [`Self::shifts_of`] gives them.
    fn shifted(
        &self,
        mesh: usize,
        given: &[GivenTarget],
        shifts: &[Vec<Vec3>],
        progress: &mut Progress,
    ) -> Result<Vec<SparseTarget>> {
        if self.made.field.finish.is_nothing() || given.is_empty() {
            return Ok(given.iter().map(GivenTarget::same).collect());
        }
        let Mesh { normals, tangents, .. } = &self.inputs.character.meshes[mesh];
        let changes = |which: usize| given.iter().any(|target| !target.deltas[which].is_empty());
        let turn_normals = !normals.is_empty() && changes(1);
        let turn_tangents = !tangents.is_empty() && changes(2);
        let turns = match turn_normals || turn_tangents {
            true => self.turns(mesh, &*self.view().rest_triangles()?),
            false => Vec::new(),
        };
        let new_normals: Vec<Vec3> =
            turns.iter().zip(normals).map(|(turn, &normal)| turn.normal(normal)).collect();
        let turn_normal = |vertex: usize, normal| turns[vertex].normal(normal);
        let tangent =
            |vertex: usize, tangent: Vec3| turns[vertex].tangent(tangent, new_normals.get(vertex).copied());
        let directions: Vec<Vec3> = tangents.iter().map(|tangent| tangent.truncate()).collect();
        let made = |index: usize| {
            let target = &given[index];
            target.with([
                self.morph_positions(target, &shifts[index]),
                morph_turns(target, 1, normals, &turn_normal),
                morph_turns(target, 2, &directions, &tangent),
            ])
        };
        let least = if self.vertices(mesh).len() < parallel::FEW { given.len() } else { 1 };
        let threads = self.inputs.options.thread_count;
        progress.collect_with(threads, given.len(), least, || (), |(), index| made(index))
    }

    /// D(v + d) - D(v) - d of all vertices that targets move, all the way, before amount, ground and height.
    ///
    /// Lids that the face step opens are mapped as deep as they begin: before the ball, the field opens less than on it,
    /// and a lid that shuts beyond the other one's edge would be half-way too early. They go on along the ball, so the
    /// straight way between two places leads through it: ends are put forward until half of the way is where the field
    /// takes half of the way.
    ///
    /// `moved`: the vertices with a change of place, ascending.
    ///
    /// # Errors
    /// `Cancelled`.
    fn shifts_of(
        &self,
        mesh: usize,
        given: &[GivenTarget],
        moved: &[u32],
        progress: &mut Progress,
    ) -> Result<Vec<Vec<Vec3>>> {
        let (deformation, threads) = (&self.made.deformation, self.inputs.options.thread_count);
        let field = &deformation.field;
        let placement = deformation.placement(field, threads);
        let figure = placement.figure;
        let placed = self.placed_of(mesh, moved, &placement);
        let start = self.vertices(mesh).start;
        let shift = |vertex: usize, delta: Vec3| {
            if delta == Vec3::ZERO {
                return Vec3::ZERO;
            }
            let delta = figure.frame.to_canonical(delta.as_dvec3());
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
        let ends: Vec<usize> = given
            .iter()
            .scan(0, |end, target| {
                *end += target.vertices.len();
                Some(*end)
            })
            .collect();
        let all = ends.last().copied().unwrap_or(0);
        let shift = |_: &mut (), index: usize| {
            let target = ends.partition_point(|&end| end <= index);
            let first = ends[target] - given[target].vertices.len();
            given[target].at(0, index - first).map_or(Vec3::ZERO, |(vertex, delta)| shift(vertex, delta))
        };
        let flat = progress.collect_with(threads, all, parallel::FEW, || (), shift)?;
        let mut rest = &flat[..];
        let by_target = |target: &GivenTarget| {
            let (own, others) = rest.split_at(target.vertices.len());
            rest = others;
            own.to_vec()
        };
        Ok(given.iter().map(by_target).collect())
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

    /// D(v + d) - D(v) of the vertices of a target: exact, and zero where d is.
    ///
    /// `shifts`: as [`Self::shifts_of`] gives them.
    fn morph_positions(&self, target: &GivenTarget, shifts: &[Vec3]) -> Option<Vec<Vec3>> {
        let finish = &self.made.field.finish;
        let (size, amount) = (finish.size as f32, finish.amount as f32);
        let moved = |((_, delta), &shift): ((usize, Vec3), &Vec3)| {
            let to = size * (delta + amount * shift);
            to.clamp(Vec3::splat(f32::MIN), Vec3::splat(f32::MAX))
        };
        Some(target.each(0)?.zip(shifts).map(moved).collect())
    }
}

/// Changes of unit vectors: what the changed vector turns into, less what the unchanged one does.
///
/// `before`: of all vertices of the mesh; without them there is nothing that a target changes.
fn morph_turns(
    target: &GivenTarget,
    which: usize,
    before: &[Vec3],
    turn: &dyn Fn(usize, Vec3) -> Vec3,
) -> Option<Vec<Vec3>> {
    let turned = |(vertex, delta): (usize, Vec3)| {
        if delta == Vec3::ZERO || before.is_empty() {
            return delta;
        }
        let before = before[vertex];
        let changed = before + delta;
        // What comes out is of unit length, whatever came in.
        let length = if before == Vec3::ZERO { 1.0 } else { before.length() };
        turn(vertex, changed) * (changed.length() / length) - turn(vertex, before)
    };
    Some(target.each(which)?.map(turned).collect())
}
