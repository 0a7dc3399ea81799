//! Takes a character through the field: vertices, their directions, morph targets, joints.

use super::attach::LEAST_VERTICES;
use super::{Deformed, DeformedMesh, Deformer, MeshOutputs};
use crate::character::{Mesh, MorphTarget};
use crate::error::Result;
use crate::parallel;
use crate::progress::Progress;
use crate::shape::directions::{Gradients, RestTriangles, has_volume, normal_matrix};
use crate::shape::field::Binding;
use glam::{DVec3, Mat3A, Vec3, Vec3A};
use std::sync::Arc;

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
        progress.at(0.0)?;
        if self.field.finish.is_nothing() {
            // The way to the canonical frame and back costs a last digit.
            let meshes = meshes.iter().zip(outputs).map(|(mesh, &asked)| unchanged(mesh, asked)).collect();
            progress.at(1.0)?;
            return Ok(Deformed { meshes, joints: self.deformed_joints() });
        }
        let threads = self.options.thread_count;
        let after = self.placement().all_vertices();
        progress.at(0.3)?;
        let has_turns: Vec<bool> =
            meshes.iter().zip(outputs).map(|(mesh, &asked)| has_directions(mesh, asked)).collect();
        let rest = has_turns.contains(&true).then(|| self.rest_triangles());
        let gradients = rest.map(|rest| rest.gradients(&after, threads));
        progress.at(0.6)?;
        let turns: Vec<Turns> = (0..meshes.len())
            .map(|mesh| match &gradients {
                Some(gradients) if has_turns[mesh] => self.turns(mesh, outputs[mesh], gradients),
                _ => Turns::default(),
            })
            .collect();
        let mut targets = self.deform_targets(outputs, &after, &turns).into_iter();
        let deformed = turns
            .into_iter()
            .enumerate()
            .map(|(mesh, turns)| {
                let count = if outputs[mesh].morph_targets { meshes[mesh].morph_targets.len() } else { 0 };
                let morph_targets = targets.by_ref().take(count).collect();
                self.deformed_mesh(mesh, outputs[mesh], &after, turns, morph_targets)
            })
            .collect();
        progress.at(1.0)?;
        Ok(Deformed { meshes: deformed, joints: self.deformed_joints() })
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

    fn rest_triangles(&self) -> &RestTriangles {
        let figure = &self.target.measured.figure;
        self.target.rest_triangles.get_or_init(|| {
            Arc::new(RestTriangles::of(&figure.positions, &figure.triangles, &self.target.measured.weld))
        })
    }

    /// One mesh of the result, its vertices among those that are `after`.
    fn deformed_mesh(
        &self,
        index: usize,
        asked: MeshOutputs,
        after: &[DVec3],
        turns: Turns,
        morph_targets: Vec<MorphTarget>,
    ) -> DeformedMesh {
        let figure = &self.target.measured.figure;
        let mesh = &self.target.character.meshes[index];
        let start = figure.mesh_starts[index];
        let of_mesh = &after[start..start + mesh.positions.len()];
        let tangents = turns.tangents.iter().zip(&mesh.tangents);
        DeformedMesh {
            positions: of_mesh.iter().map(|&p| single(figure.frame.to_model(p))).collect(),
            tangents: if asked.tangents {
                tangents.map(|(tangent, old)| tangent.extend(old.w)).collect()
            } else {
                Vec::new()
            },
            normals: if asked.normals { turns.normals } else { Vec::new() },
            morph_targets,
        }
    }

    /// What the directions of a mesh turn into.
    fn turns(&self, index: usize, asked: MeshOutputs, gradients: &Gradients) -> Turns {
        let mesh = &self.target.character.meshes[index];
        let figure = &self.target.measured.figure;
        let (frame, weld) = (figure.frame.rotation(), &self.target.measured.weld);
        let back = frame.transpose();
        let start = figure.mesh_starts[index];
        let threads = self.options.thread_count;
        let turn = |vertex: usize| {
            let whole = start + vertex;
            let of_field = || {
                let binding = &self.deformation.bindings.vertices[whole];
                self.field.map(figure.positions[whole], binding).jacobian.as_mat3().into()
            };
            let welded = weld.representative[whole] as usize;
            let jacobian = gradients.jacobian(welded).filter(has_volume).unwrap_or_else(of_field);
            back * jacobian * frame
        };
        let has_targets = asked.morph_targets && !mesh.morph_targets.is_empty();
        if !(asked.tangents || has_targets) {
            // The turns themselves are not needed any more.
            let normals = parallel::collect(threads, mesh.normals.len(), LEAST_VERTICES, |vertex| {
                turned_normal(&turn(vertex), mesh.normals[vertex])
            });
            return Turns { normals, ..Turns::default() };
        }
        let turns = parallel::collect(threads, mesh.positions.len(), LEAST_VERTICES, turn);
        let mut turns = Turns { turns, normals: Vec::new(), tangents: Vec::new() };
        turns.normals = parallel::collect(threads, mesh.normals.len(), LEAST_VERTICES, |vertex| {
            turns.normal(vertex, mesh.normals[vertex])
        });
        turns.tangents = parallel::collect(threads, mesh.tangents.len(), LEAST_VERTICES, |vertex| {
            turns.tangent(vertex, mesh.tangents[vertex].truncate())
        });
        turns
    }

    /// The morph targets that are asked for, mesh by mesh.
    fn deform_targets(&self, outputs: &[MeshOutputs], after: &[DVec3], turns: &[Turns]) -> Vec<MorphTarget> {
        let meshes = &self.target.character.meshes;
        // One by one, whichever mesh they belong to: a face may hold them all.
        let targets: Vec<(usize, usize)> = (0..meshes.len())
            .filter(|&mesh| outputs[mesh].morph_targets)
            .flat_map(|mesh| (0..meshes[mesh].morph_targets.len()).map(move |target| (mesh, target)))
            .collect();
        let least = if after.len() < LEAST_VERTICES { usize::MAX } else { 1 };
        parallel::collect(self.options.thread_count, targets.len(), least, |index| {
            let (mesh, target) = targets[index];
            self.deform_target(mesh, target, after, &turns[mesh])
        })
    }

    fn deform_target(&self, mesh: usize, target: usize, after: &[DVec3], turns: &Turns) -> MorphTarget {
        let start = self.target.measured.figure.mesh_starts[mesh];
        let mesh = &self.target.character.meshes[mesh];
        let target = &mesh.morph_targets[target];
        let directions: Vec<Vec3> = if target.tangents.is_empty() {
            Vec::new()
        } else {
            mesh.tangents.iter().map(|tangent| tangent.truncate()).collect()
        };
        MorphTarget {
            name: target.name.clone(),
            positions: self.morph_positions(start, &target.positions, after),
            normals: morph_turns(&target.normals, &mesh.normals, &turns.normals, &|vertex, normal| {
                turns.normal(vertex, normal)
            }),
            tangents: morph_turns(&target.tangents, &directions, &turns.tangents, &|vertex, tangent| {
                turns.tangent(vertex, tangent)
            }),
        }
    }

    /// D(v + d) - D(v): exact, and zero where d is.
    fn morph_positions(&self, start: usize, deltas: &[Vec3], after: &[DVec3]) -> Vec<Vec3> {
        let placement = self.placement();
        let figure = placement.figure;
        let moved = |(vertex, &delta): (usize, &Vec3)| {
            if delta == Vec3::ZERO {
                return Vec3::ZERO;
            }
            let whole = start + vertex;
            let p = figure.positions[whole] + figure.frame.to_canonical(delta.as_dvec3());
            single(figure.frame.to_model(placement.beside(whole, p) - after[whole]))
        };
        deltas.iter().enumerate().map(moved).collect()
    }
}

/// Whether directions of `mesh` are asked for.
fn has_directions(mesh: &Mesh, asked: MeshOutputs) -> bool {
    (asked.normals || asked.tangents || asked.morph_targets)
        && !(mesh.normals.is_empty() && mesh.tangents.is_empty())
}

/// The mesh as it came, of it what is asked for.
fn unchanged(mesh: &Mesh, asked: MeshOutputs) -> DeformedMesh {
    let mut all = DeformedMesh { positions: mesh.positions.clone(), ..DeformedMesh::default() };
    if asked.normals {
        all.normals.clone_from(&mesh.normals);
    }
    if asked.tangents {
        all.tangents.clone_from(&mesh.tangents);
    }
    if asked.morph_targets {
        all.morph_targets.clone_from(&mesh.morph_targets);
    }
    all
}

/// As floats. What lies beyond their range, which takes a model of over 1e30 units, ends there instead of at infinity.
fn single(p: DVec3) -> Vec3 {
    p.clamp(DVec3::splat(f32::MIN.into()), DVec3::splat(f32::MAX.into())).as_vec3()
}

/// How the directions at each vertex of a mesh turn, and what its own turn into; all empty where nothing of it is asked for.
#[derive(Default)]
struct Turns {
    /// Model space; empty where normals alone are asked for.
    turns: Vec<Mat3A>,
    normals: Vec<Vec3>,
    tangents: Vec<Vec3>,
}

impl Turns {
    fn normal(&self, vertex: usize, normal: Vec3) -> Vec3 {
        turned_normal(&self.turns[vertex], normal)
    }

    fn tangent(&self, vertex: usize, tangent: Vec3) -> Vec3 {
        let turned = Vec3::from(self.turns[vertex] * Vec3A::from(tangent));
        let flat = match self.normals.get(vertex) {
            Some(&normal) => turned.reject_from_normalized(normal),
            None => turned,
        };
        flat.normalize_or(tangent)
    }
}

/// What `normal` becomes where the surface turns by `turn`.
fn turned_normal(turn: &Mat3A, normal: Vec3) -> Vec3 {
    (normal_matrix(turn) * Vec3A::from(normal)).normalize_or(normal.into()).into()
}

/// Changes of unit vectors: what the changed vector turns into, less what the unchanged one did.
fn morph_turns(
    deltas: &[Vec3],
    before: &[Vec3],
    after: &[Vec3],
    turn: &dyn Fn(usize, Vec3) -> Vec3,
) -> Vec<Vec3> {
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
            turn(vertex, changed) * (changed.length() / length) - after[vertex]
        })
        .collect()
}
