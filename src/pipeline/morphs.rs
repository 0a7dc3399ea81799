//! Morph targets after a deformation: each is made again at the vertices that it touches, and is zero at the others.

use super::Deformer;
use super::memo::View;
use crate::character::{Mesh, MorphTarget};
use crate::error::Result;
use crate::geometry::marked;
use crate::parallel;
use crate::progress::Progress;
use crate::shape::field::single;
use glam::{DVec3, Vec3};
use std::ops::Range;
use std::sync::{Arc, OnceLock};

/// The vertices that each morph target of a mesh touches, ascending.
pub type Touched = Vec<Arc<Vec<u32>>>;

/// Those of each mesh.
pub fn touched(view: &View) -> Result<Vec<Touched>> {
    let touched = |mesh: &Mesh, target: &MorphTarget| {
        let arrays = [&target.positions, &target.normals, &target.tangents];
        let is_touched = |&vertex: &u32| {
            arrays.iter().any(|deltas| deltas.get(vertex as usize).is_some_and(|&d| d != Vec3::ZERO))
        };
        Arc::new((0..mesh.positions.len() as u32).filter(is_touched).collect())
    };
    let of_mesh = |mesh: &Mesh| mesh.morph_targets.iter().map(|target| touched(mesh, target)).collect();
    Ok(view.character().meshes.iter().map(of_mesh).collect())
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

    /// Each of `vertices` with what is added to it; `None` where the target has no such changes.
    fn each(&self, which: usize) -> Option<impl Iterator<Item = (u32, Vec3)>> {
        let deltas = self.deltas[which];
        let at = |index: usize, vertex: u32| if self.is_dense { vertex as usize } else { index };
        let of = move |(index, &vertex): (usize, &u32)| (vertex, deltas[at(index, vertex)]);
        (!deltas.is_empty()).then(|| self.vertices.iter().enumerate().map(of))
    }

    /// The same of places; none where it moves nothing.
    fn moves(&self) -> impl Iterator<Item = (u32, Vec3)> {
        self.each(0).into_iter().flatten()
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
pub type Shifts = Vec<OnceLock<Vec<Vec<Vec3>>>>;

/// What is filled in mesh by mesh: none while what it is made of is the same.
pub fn shifts(view: &View) -> Result<Shifts> {
    view.deformation()?;
    Ok(vec![OnceLock::new(); view.character().meshes.len()])
}

impl Deformer {
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
        let given: Vec<GivenTarget> = of_mesh.iter().zip(&touched[mesh]).map(GivenTarget::of).collect();
        self.shifted(mesh, &given, &self.view().shifts()?[mesh], progress)
    }

    /// Morph targets of a mesh, those of the character or others, as [`Self::deformed_targets`] has them.
    pub(crate) fn map_targets(&self, mesh: usize, given: &[GivenTarget]) -> Result<Vec<SparseTarget>> {
        self.shifted(mesh, given, &OnceLock::new(), &mut Progress::none())
    }

    /// The targets after the deformation.
    ///
    /// `kept`: what [`Self::shifts_of`] gives, where it is known; it is from then on.
    fn shifted(
        &self,
        mesh: usize,
        given: &[GivenTarget],
        kept: &OnceLock<Vec<Vec<Vec3>>>,
        progress: &mut Progress,
    ) -> Result<Vec<SparseTarget>> {
        if self.field.finish.is_nothing() || given.is_empty() {
            return Ok(given.iter().map(GivenTarget::same).collect());
        }
        let shifts = match kept.get() {
            Some(known) => known,
            None => {
                let shifts = self.shifts_of(mesh, given, &mut progress.part(0.0, 0.7))?;
                kept.get_or_init(|| shifts)
            }
        };
        let progress = &mut progress.part(0.7, 1.0);
        let Mesh { normals, tangents, .. } = &self.inputs.character.meshes[mesh];
        let changes = |which: usize| given.iter().any(|target| !target.deltas[which].is_empty());
        let turns = match !normals.is_empty() && changes(1) || !tangents.is_empty() && changes(2) {
            true => {
                let rest = self.view().rest_triangles()?;
                rest.turns(mesh, &self.moved(), |vertex| self.turn_of_field(vertex))
            }
            false => Vec::new(),
        };
        let new_normals: Vec<Vec3> =
            turns.iter().zip(normals).map(|(turn, &normal)| turn.normal(normal)).collect();
        let turn_normal = |vertex: usize, normal| turns[vertex].normal(normal);
        let tangent =
            |vertex: usize, tangent: Vec3| turns[vertex].tangent(tangent, new_normals.get(vertex).copied());
        let directions: Vec<Vec3> = tangents.iter().map(|tangent| tangent.truncate()).collect();
        let (size, amount) = (self.field.finish.size as f32, self.field.finish.amount as f32);
        // D(v + d) - D(v): exact, and zero where d is.
        let moved = |((_, delta), &shift): ((u32, Vec3), &Vec3)| {
            (size * (delta + amount * shift)).clamp(Vec3::splat(f32::MIN), Vec3::splat(f32::MAX))
        };
        let made = |index: usize| {
            let target = &given[index];
            target.with([
                target.each(0).map(|moves| moves.zip(&shifts[index]).map(moved).collect()),
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
    /// # Errors
    /// `Cancelled`.
    fn shifts_of(
        &self,
        mesh: usize,
        given: &[GivenTarget],
        progress: &mut Progress,
    ) -> Result<Vec<Vec<Vec3>>> {
        let (deformation, threads) = (&self.deformation, self.inputs.options.thread_count);
        let field = &deformation.field;
        let placement = deformation.placement(field, threads);
        let figure = placement.figure;
        let Range { start, end } = self.vertices(mesh);
        let moves: Vec<(u32, Vec3)> = given.iter().flat_map(GivenTarget::moves).collect();
        let moved = moves.iter().filter(|(_, delta)| *delta != Vec3::ZERO);
        let is_moved = marked(end - start, moved.map(|&(vertex, _)| vertex as usize));
        let placed = parallel::collect(threads, is_moved.len(), parallel::FEW, |vertex| {
            if is_moved[vertex] { placement.vertex(start + vertex) } else { DVec3::ZERO }
        });
        let shift = |(vertex, delta): (u32, Vec3)| {
            if delta == Vec3::ZERO {
                return Vec3::ZERO;
            }
            let (before, vertex) = (placed[vertex as usize], start + vertex as usize);
            let delta = figure.frame.to_canonical(delta.as_dvec3());
            let from = figure.positions[vertex];
            let mut to = placement.beside(vertex, from + delta);
            let share = field.opens_lids(from, &placement.bindings.vertices[vertex]);
            if share > 0.0 {
                let half = placement.beside(vertex, from + 0.5 * delta);
                let z = to.z + 2.0 * (half.z - 0.5 * (before.z + to.z)).max(0.0);
                to = to.lerp(placement.beside(vertex, from + delta.with_z(0.0)).with_z(z), share);
            }
            single(figure.frame.to_model(to - before - delta))
        };
        // Those of all targets in one list: threads have as much to do, whatever each touches.
        let shift = |(): &mut (), index: usize| shift(moves[index]);
        let mut all = progress.collect_with(threads, moves.len(), parallel::FEW, || (), shift)?.into_iter();
        Ok(given.iter().map(|target| all.by_ref().take(target.moves().count()).collect()).collect())
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
    let turned = |(vertex, delta): (u32, Vec3)| {
        if delta == Vec3::ZERO || before.is_empty() {
            return delta;
        }
        let vertex = vertex as usize;
        let before = before[vertex];
        let changed = before + delta;
        // What comes out is of unit length, whatever came in.
        let length = if before == Vec3::ZERO { 1.0 } else { before.length() };
        turn(vertex, changed) * (changed.length() / length) - turn(vertex, before)
    };
    Some(target.each(which)?.map(turned).collect())
}
