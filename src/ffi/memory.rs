//! What calls ask for before they begin; their large stages ask for themselves, see `room.rs`.
//!
//! What a call takes beyond what it gives back goes by vertices and triangles. The numbers here are upper bounds,
//! a quarter and more above what `tests/memory.rs` measures, which compares them; that also covers the sparse solver and
//! the tree of triangles, whose packages cannot fail.

use super::guard::Outcome;
use crate::character::Character;
use crate::options::{Options, table};
use crate::parallel;
use crate::pipeline::{Deformer, Kept};
use crate::room::Room;

/// Bytes that any of the larger calls takes, whatever the character: names, tables, text, the chart of its body.
const BASE: usize = 1 << 20;
/// Bytes that a style's profile takes besides, on the chart of a body.
const CHARTED: usize = 1 << 19;
/// Bytes that a rig takes for its view of a figure from the front, whatever the figure.
const VIEW: usize = 7 << 20;
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
    Size::of(character).bytes([100, 640, 0, 16])
}

/// Making a deformer.
pub fn to_deform(character: &Character) -> usize {
    Size::of(character).bytes([470, 560, 0, 16])
}

/// Changing a deformer's style: its target is not measured again. Young faces, hair and clothes ask for themselves.
pub fn to_change_style(character: &Character) -> usize {
    CHARTED.saturating_add(Size::of(character).bytes([145, 0, 0, 0]))
}

/// Changing a deformer's options.
pub fn to_change_options(deformer: &Deformer, options: &Options) -> usize {
    let character = deformer.character();
    match deformer.kept_with(options) {
        Kept::Nothing => to_deform(character),
        Kept::Target => to_change_style(character),
        Kept::Body => Size::of(character).bytes([64, 0, 0, 0]),
        Kept::Field => Size::of(character).bytes([16, 0, 0, 0]),
    }
}

/// Deforming into the caller's arrays.
pub fn to_apply(character: &Character) -> usize {
    Size::of(character).bytes([136, 192, 48, 0])
}

/// Mapping morph targets of a character's mesh that change so many vertices together.
pub fn to_map_targets(character: &Character, vertices: usize) -> usize {
    let size = Size { weights: 0, morphs: vertices, ..Size::of(character) };
    size.bytes([170, 240, 60, 0])
}

/// Deforming and measuring the result.
pub fn to_report(character: &Character) -> usize {
    Size::of(character).bytes([200, 640, 60, 16])
}

/// Making a rig, and the character with it, but for its solids and its weights, which ask for themselves.
pub fn to_rig(character: &Character) -> usize {
    VIEW.saturating_add(Size::of(character).bytes([540, 250, 36, 8]))
}

/// Runs `work` where there are `bytes` of memory, on one thread where there is not enough for more.
pub fn with<T>(bytes: usize, threads: usize, work: impl FnOnce() -> Outcome<T>) -> Outcome<T> {
    if bytes == 0 {
        return work();
    }
    let held = Room::of(bytes)?;
    let others = match threads {
        1 => 0,
        _ if parallel::jobs().is_some() => 0,
        threads => parallel::thread_count(threads).min(table::MOST_THREADS as usize) - 1,
    };
    let stacks: Result<Vec<Room>, _> = (0..others).map(|_| Room::of(THREAD)).collect();
    drop(held);
    if stacks.is_err() { parallel::alone(work) } else { work() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ffi::basics::SDEF_STATUS_OUT_OF_MEMORY;

    #[test]
    fn more_than_there_is_is_a_status_and_the_work_is_not_begun() {
        let failure = with(usize::MAX / 4, 1, || -> Outcome { panic!("begun") }).unwrap_err();
        assert_eq!(failure.status, SDEF_STATUS_OUT_OF_MEMORY);
        assert_eq!(with(1 << 20, 4, || Ok(7)).unwrap(), 7);
    }
}
