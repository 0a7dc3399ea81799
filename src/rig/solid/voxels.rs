//! The filled cells of a solid, one after the other, and their neighbours.

use super::Solid;
use crate::geometry::{NONE, slots};
use glam::IVec3;

/// The filled cells of a solid by slots.
#[derive(Clone, Debug)]
pub struct Voxels {
    /// The grid.
    pub solid: Solid,
    /// For each cell of the grid its slot, or `NONE`.
    pub slots: Vec<u32>,
    /// For each slot its cell, ascending.
    pub cells: Vec<u32>,
    /// Offsets of the 26 neighbours in memory, and how many sides of theirs lie elsewhere: 1 across a face, 2 across an edge,
    /// 3 across a corner.
    around: Vec<(isize, usize)>,
}

/// The offsets of the 26 neighbours.
pub fn neighbourhood() -> impl Iterator<Item = IVec3> {
    (0..27).filter(|&i| i != 13).map(|i| IVec3::new(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1))
}

impl Voxels {
    /// The filled cells of `solid`.
    pub fn of(solid: Solid) -> Self {
        let cells: Vec<u32> =
            (0..solid.layers.len() as u32).filter(|&cell| solid.layers[cell as usize] > 0).collect();
        let slots = slots(solid.layers.len(), &cells);
        let around = neighbourhood().map(|at| (solid.stride(at), at.abs().element_sum() as usize)).collect();
        Self { solid, slots, cells, around }
    }

    /// The slot of the cell at `at`, or `NONE`.
    pub fn slot(&self, at: IVec3) -> u32 {
        if self.solid.has(at) { self.slots[self.solid.index(at)] } else { NONE }
    }

    /// The cell of a slot.
    pub fn place(&self, slot: u32) -> IVec3 {
        self.solid.place(self.cells[slot as usize] as usize)
    }

    /// The slots beside one, and across how many sides. No filled cell is at the grid's end.
    pub fn beside(&self, slot: u32) -> impl Iterator<Item = (u32, usize)> + '_ {
        let cell = self.cells[slot as usize] as isize;
        let near = self.around.iter().map(move |&(step, sides)| (self.slots[(cell + step) as usize], sides));
        near.filter(|&(next, _)| next != NONE)
    }
}

/// Things in order of whole numbers: those of one number come in no particular order.
#[derive(Clone, Debug, Default)]
pub(super) struct Queue {
    buckets: Vec<Vec<u32>>,
    current: usize,
}

impl Queue {
    /// What comes too late is next.
    pub(super) fn push(&mut self, number: usize, item: u32) {
        let bucket = number.max(self.current);
        if bucket >= self.buckets.len() {
            self.buckets.resize(bucket + 1, Vec::new());
        }
        self.buckets[bucket].push(item);
    }

    /// The next item, and its number; after the last one the queue is as new.
    pub(super) fn pop(&mut self) -> Option<(usize, u32)> {
        while let Some(bucket) = self.buckets.get_mut(self.current) {
            if let Some(item) = bucket.pop() {
                return Some((self.current, item));
            }
            self.current += 1;
        }
        self.current = 0;
        None
    }
}
