//! Memory is asked for before a call begins: where an allocation fails in its midst, Rust ends the process.
//!
//! What a call takes beyond what it gives back goes by vertices, triangles and voxels. The numbers here are upper bounds,
//! a quarter and more above what `tests/memory.rs` measures, which compares them; that also covers the sparse solver and
//! the tree of triangles, whose packages cannot fail. Another thread of the host may still take between asking and using.

use super::basics::SDEF_STATUS_OUT_OF_MEMORY;
use super::guard::{Failure, Outcome};
use crate::character::Character;
use crate::geometry::bounds;
use crate::options::{Options, RigOptions, table};
use crate::parallel;
use crate::pipeline::{Deformer, Kept};

/// Bytes that any of the larger calls takes, whatever the character: names, tables, text, the chart of its body.
const BASE: usize = 1 << 20;
/// Less than this is not asked for: so much is always assumed to be there.
const NOT_ASKED: usize = 1 << 18;
/// The stack of a thread (2 MiB by default) and what the system's allocator reserves for a thread of its own (64 MiB, twice
/// that while it looks for a place), of which nothing is used until it is.
const THREAD: usize = 136 << 20;

/// What the memory of calls goes by.
#[derive(Clone, Copy, Debug, Default)]
struct Size {
    vertices: usize,
    triangles: usize,
    /// Vertices of all morph targets.
    morphs: usize,
    weights: usize,
}

impl Size {
    fn of(character: &Character) -> Self {
        let mut size = Self::default();
        for mesh in &character.meshes {
            size.vertices += mesh.positions.len();
            size.triangles += mesh.triangles.len();
            size.morphs += mesh.positions.len() * mesh.morph_targets.len();
            size.weights += mesh.weights.rows().map(<[_]>::len).sum::<usize>();
        }
        size
    }

    fn bytes(&self, [vertex, triangle, morph, weight]: [usize; 4]) -> usize {
        let parts = [
            (self.vertices, vertex),
            (self.triangles, triangle),
            (self.morphs, morph),
            (self.weights, weight),
        ];
        parts.iter().fold(BASE, |sum, &(count, bytes)| sum.saturating_add(count.saturating_mul(bytes)))
    }
}

/// A copy of a character, as a change makes where a deformer keeps it.
pub fn to_copy(character: &Character) -> usize {
    Size::of(character).bytes([72, 12, 36, 8])
}

/// Measuring a body.
pub fn to_measure(character: &Character) -> usize {
    Size::of(character).bytes([680, 400, 0, 16])
}

/// Making a deformer.
pub fn to_deform(character: &Character) -> usize {
    Size::of(character).bytes([950, 320, 0, 16])
}

/// Changing a deformer's style: its target is not measured again.
pub fn to_change_style(character: &Character) -> usize {
    Size::of(character).bytes([450, 60, 0, 0])
}

/// Changing a deformer's options.
pub fn to_change_options(deformer: &Deformer, options: &Options) -> usize {
    let character = deformer.character();
    match deformer.kept_with(options) {
        Kept::Nothing => to_deform(character),
        Kept::Target => to_change_style(character),
        Kept::Field => Size::of(character).bytes([16, 0, 0, 0]),
    }
}

/// Deforming into the caller's arrays.
pub fn to_apply(character: &Character) -> usize {
    Size::of(character).bytes([170, 240, 60, 0])
}

/// Mapping morph targets of a character's mesh that change so many vertices together.
pub fn to_map_targets(character: &Character, vertices: usize) -> usize {
    let size = Size { weights: 0, morphs: vertices, ..Size::of(character) };
    size.bytes([170, 240, 60, 0])
}

/// Deforming and measuring the result.
pub fn to_report(character: &Character) -> usize {
    to_deform(character).saturating_add(to_apply(character))
}

/// Making a rig, and the character with it.
pub fn to_rig(character: &Character, options: &RigOptions) -> usize {
    let body = Size::of(character).bytes([1000, 600, 36, 8]);
    let bytes = |resolution: usize, voxel: usize, more_within: usize| {
        let [all, within] = voxels(character, resolution);
        all.saturating_mul(voxel).saturating_add(within.saturating_mul(more_within))
    };
    let solid = bytes(SOLID, SOLID_CELL, SOLID_CELL_WITHIN);
    body.saturating_add(solid.max(bytes(options.voxel_resolution, VOXEL, VOXEL_WITHIN)))
}

/// Cells along the longest side of a figure where its limbs are looked for, a quarter more for what is wider than high.
const SOLID: usize = 200;
/// Bytes a cell of the box around a figure takes there: 17 where 160 cells are as long as the figure is high.
const SOLID_CELL: usize = 16;
/// Bytes more a cell within the figure, 32 and half as much again.
const SOLID_CELL_WITHIN: usize = 48;

/// Bytes a voxel of the box around a figure, 5 and a fifth as much again; what filling takes beside them is gone before
/// the voxels within the figure take theirs.
const VOXEL: usize = 6;
/// Bytes more a voxel within the figure, 160 and half as much again.
const VOXEL_WITHIN: usize = 240;
/// Columns on each side of the grid that [`voxels`] looks through.
const COLUMNS: usize = 64;

/// How many voxels the box around a figure has, and how many of them are within it at most: between the nearest and the
/// furthest triangle of each of a grid of columns along the box's shortest side.
fn voxels(character: &Character, resolution: usize) -> [usize; 2] {
    let positions = character.meshes.iter().flat_map(|mesh| &mesh.positions).map(|p| p.as_dvec3());
    let (low, high) = bounds(positions.filter(|p| p.is_finite()));
    let extent = high - low;
    let longest = extent.max_element();
    if longest <= 0.0 || !longest.is_finite() {
        return [0; 2];
    }
    let resolution = resolution.min(1 << 10) as f64;
    // Two voxels of edge on each side, and one for rounding.
    let sides = extent / longest * resolution + 5.0;
    let depth = (0..3).min_by(|&a, &b| extent[a].total_cmp(&extent[b])).unwrap_or(2);
    let (across, up) = ((depth + 1) % 3, (depth + 2) % 3);
    let mut columns = vec![(f64::INFINITY, f64::NEG_INFINITY); COLUMNS * COLUMNS];
    let column = |p: f64, axis: usize| {
        let share = (p - low[axis]) / extent[axis].max(f64::MIN_POSITIVE);
        ((share * COLUMNS as f64) as usize).min(COLUMNS - 1)
    };
    for mesh in &character.meshes {
        for corners in &mesh.triangles {
            let corners = corners.map(|corner| mesh.positions[corner as usize].as_dvec3());
            let (from, to) = bounds(corners);
            for row in column(from[up], up)..=column(to[up], up) {
                for place in column(from[across], across)..=column(to[across], across) {
                    let seen = &mut columns[row * COLUMNS + place];
                    *seen = (seen.0.min(from[depth]), seen.1.max(to[depth]));
                }
            }
        }
    }
    // The surface's own voxels count too, on either side.
    let through = |&(from, to): &(f64, f64)| (to - from) / longest * resolution + 3.0;
    let seen: f64 = columns.iter().filter(|(from, to)| from <= to).map(through).sum();
    let all = sides.element_product();
    let within = seen * sides[across] * sides[up] / (COLUMNS * COLUMNS) as f64;
    [all as usize, within.min(all) as usize]
}

/// Runs `work` where there are `bytes` of memory, on one thread where there is not enough for more.
pub fn with<T>(bytes: usize, threads: usize, work: impl FnOnce() -> Outcome<T>) -> Outcome<T> {
    if bytes < NOT_ASKED {
        return work();
    }
    let mut held = reserve(bytes);
    if held.is_empty() {
        return Err(Failure::new(
            SDEF_STATUS_OUT_OF_MEMORY,
            format!(
                "there are no {} MiB of memory for this call: give less, or free some",
                bytes.div_ceil(1 << 20)
            ),
        ));
    }
    let others = match threads {
        1 => 0,
        _ if parallel::jobs().is_some() => 0,
        threads => parallel::thread_count(threads).min(table::MOST_THREADS as usize) - 1,
    };
    for _ in 0..others {
        let more = reserve(THREAD);
        if more.is_empty() {
            drop(held);
            return parallel::alone(work);
        }
        held.extend(more);
    }
    drop(held);
    work()
}

/// Memory that is there, in pieces that are given back when they are dropped; empty where it is not.
fn reserve(bytes: usize) -> Vec<Vec<u8>> {
    let mut piece = Vec::new();
    let mut pieces = Vec::new();
    if piece.try_reserve_exact(bytes).is_ok() && pieces.try_reserve_exact(1).is_ok() {
        pieces.push(piece);
    }
    pieces
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn more_than_there_is_is_a_status_and_the_work_is_not_begun() {
        let failure = with(usize::MAX / 4, 1, || -> Outcome { panic!("begun") }).unwrap_err();
        assert_eq!(failure.status, SDEF_STATUS_OUT_OF_MEMORY);
        assert_eq!(with(1 << 20, 4, || Ok(7)).unwrap(), 7);
    }
}
