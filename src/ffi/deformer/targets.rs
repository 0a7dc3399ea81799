//! Morph targets as hosts map them: where they change something, one after the other.

use crate::character::Mesh;
use crate::character::mesh::place;
use crate::error::Result;
use crate::ffi::arrays::{Input, Output};
use crate::ffi::basics::SDEF_ELEMENT_VERTEX;
use crate::ffi::guard::{Failure, Outcome};
use crate::pipeline::Deformer;
use crate::pipeline::morphs::GivenTarget;
use glam::Vec3;
use std::sync::Arc;

/// Positions, normals and tangents of all targets, which are read and written.
pub struct Deltas {
    given: [Vec<Vec3>; 3],
    results: [Output<Vec3>; 3],
}

impl Deltas {
    /// Checks and reads arrays of `count` vectors; those of normals and tangents may be NULL.
    ///
    /// # Safety
    /// Each is NULL or holds as many.
    pub unsafe fn new(arrays: [*mut f32; 3], count: usize) -> Outcome<Self> {
        let names = ["positions", "normals", "tangents"];
        let (mut given, mut results) = (<[Vec<Vec3>; 3]>::default(), [Output::none(); 3]);
        for (which, (name, array)) in names.into_iter().zip(arrays).enumerate() {
            if which > 0 && array.is_null() {
                continue;
            }
            given[which] = unsafe { Input::<Vec3>::new(name, array.cast(), count, 0) }?.to_vec(name)?;
            results[which] = unsafe { Output::new(name, array.cast(), count, count, 0) }?;
        }
        Ok(Self { given, results })
    }

    /// Checks that they are finite numbers, and `vertices` ascending ones of the mesh.
    pub fn check(&self, index: usize, mesh: &Mesh, counts: &[u32], vertices: &[u32]) -> Outcome {
        let mut rest = vertices;
        for (target, &count) in counts.iter().enumerate() {
            let (own, others) = rest.split_at(count as usize);
            let failed = |message: String, vertex: u32| {
                let message = format!("{}: morph target {target} {message}", place(index, &mesh.name));
                Failure::input(message).in_mesh(index).at(SDEF_ELEMENT_VERTEX, vertex as usize)
            };
            if let Some(pair) = own.windows(2).find(|pair| pair[0] >= pair[1]) {
                let message = format!("has vertex {} before {}: name each once, ascending", pair[0], pair[1]);
                return Err(failed(message, pair[1]));
            }
            let in_mesh = mesh.positions.len();
            if let Some(&last) = own.last().filter(|&&last| last as usize >= in_mesh) {
                let message = format!(
                    "moves vertex {last}, but the mesh has {in_mesh}: name indices from 0 to that less 1"
                );
                return Err(failed(message, last));
            }
            let first = vertices.len() - rest.len();
            for (at, &vertex) in own.iter().enumerate() {
                let of = |deltas: &Vec<Vec3>| deltas.get(first + at).is_some_and(|delta| !delta.is_finite());
                if self.given.iter().any(of) {
                    let message =
                        format!("moves vertex {vertex} by what is no number: deltas must be finite");
                    return Err(failed(message, vertex));
                }
            }
            rest = others;
        }
        Ok(())
    }

    /// Maps them, and writes them where they were read.
    pub fn map(&self, deformer: &Deformer, mesh: usize, counts: &[u32], vertices: &[u32]) -> Result<()> {
        let mut end = 0;
        let target = |&count: &u32| {
            let range = end..end + count as usize;
            end = range.end;
            let deltas = self.given.each_ref().map(|deltas| deltas.get(range.clone()).unwrap_or_default());
            GivenTarget { vertices: Arc::new(vertices[range].to_vec()), deltas, is_dense: false }
        };
        let given: Vec<GivenTarget> = counts.iter().map(target).collect();
        let mut first = 0;
        for target in deformer.map_targets(mesh, &given)? {
            for (result, deltas) in self.results.iter().zip(&target.deltas) {
                result.from(first).write_all(deltas.as_deref().unwrap_or_default());
            }
            first += target.vertices.len();
        }
        Ok(())
    }
}

/// Vertices of each target and of all together, copied and counted.
///
/// # Safety
/// The arrays are NULL or as long as they must be.
pub unsafe fn vertices_of(
    counts: *const u32,
    count: usize,
    vertices: *const u32,
) -> Outcome<(Vec<u32>, Vec<u32>)> {
    let counts = unsafe { Input::new("vertex_counts", counts, count, 0) }?.to_vec("vertex_counts")?;
    let all = counts.iter().map(|&count| count as usize).sum();
    let vertices = unsafe { Input::new("vertices", vertices, all, 0) }?.to_vec("vertices")?;
    Ok((counts, vertices))
}
