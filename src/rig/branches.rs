//! What sticks out of a trunk, in whatever direction: branches of the distance through the solid from the trunk's core.
//!
//! Cells further from the core than some distance hang together in pieces. As that distance falls, a piece is born at each
//! end of something (a hand, a foot, a crown, a tail) and grows inwards until it meets another one, where the shorter of
//! the two ends: the merge tree of the distance (Carr, Snoeyink and Axen, Computing contour trees in all dimensions, 2003).
//! The rims of a piece, one after the other, are the sections of a limb, whatever way it bends.

use super::solid::Solid;
use crate::geometry::Groups;
use glam::DVec3;
use std::ops::Range;

/// Steps between neighbours of a cell that share a face, an edge, a corner, in thirds of a cell: no way is off by more than
/// 6 % (Borgefors, Distance transformations in digital images, 1986).
const STEPS: [u32; 3] = [3, 4, 5];
/// A section is so many thirds of a cell thick: two cells.
const BAND: u32 = 6;
/// What is shorter than this, in heights, is no limb but a finger or a fold.
const LEAST_BRANCH: f64 = 0.1;
/// What fills more than this, in cubed heights, has no limbs: people fill .013, a ball of two heads .3.
const MOST_FILLED: f64 = 0.4;
/// No branch.
const NONE: u32 = u32::MAX;

/// A section of a branch.
#[derive(Clone, Copy, Debug)]
pub struct Rim {
    /// Its middle.
    pub middle: DVec3,
    /// The mean distance of its outer cells from that.
    pub radius: f64,
}

/// Something that sticks out.
#[derive(Clone, Debug)]
pub struct Branch {
    /// Its sections from the tip inwards, down to where it meets another branch.
    pub rims: Vec<Rim>,
}

/// The branches of `solid` around a core: the filled cells next to the plane at `axis` in a range of heights. Longest
/// first; empty where no cell is there, or where the solid is no figure's.
pub fn branches(solid: &Solid, axis: f64, heights: Range<f64>) -> Vec<Branch> {
    let cells = Cells::of(solid);
    if cells.index.len() as f64 * solid.cell.powi(3) > MOST_FILLED {
        return Vec::new();
    }
    let distances = cells.distances(solid, axis, heights);
    let mut branches = cells.merge(&distances);
    branches.retain_mut(|branch| cells.measure(solid, &distances, branch));
    let mut found: Vec<Branch> = branches.into_iter().map(|piece| Branch { rims: piece.rims }).collect();
    found.sort_by_key(|branch| std::cmp::Reverse(branch.rims.len()));
    found
}

/// The filled cells of a solid.
struct Cells {
    /// Which ones, ascending.
    index: Vec<u32>,
    /// Their slots by cell, `NONE` where it is empty.
    slot: Vec<u32>,
    /// What is added to a cell's index for each neighbour, and how far that is.
    around: Vec<(isize, u32)>,
}

/// One piece of the merge tree.
struct Piece {
    far: u32,
    /// Its cells, from the tip inwards.
    cells: Vec<u32>,
    rims: Vec<Rim>,
}

/// Slots by how far they are, the furthest first, those that are as far in their order; without what no way leads to.
fn furthest_first(far: &[u32]) -> Vec<u32> {
    let reached = || far.iter().copied().filter(|&far| far != NONE);
    let most = reached().max().unwrap_or(0);
    let mut starts = vec![0usize; most as usize + 2];
    reached().for_each(|far| starts[(most - far) as usize + 1] += 1);
    for at in 1..starts.len() {
        starts[at] += starts[at - 1];
    }
    let mut order = vec![0u32; starts[most as usize + 1]];
    for (slot, &far) in far.iter().enumerate().filter(|&(_, &far)| far != NONE) {
        let next = &mut starts[(most - far) as usize];
        order[*next] = slot as u32;
        *next += 1;
    }
    order
}

impl Cells {
    fn of(solid: &Solid) -> Self {
        let count = solid.size[0] * solid.size[1] * solid.size[2];
        let mut slot = vec![NONE; count];
        let mut index = Vec::new();
        for (cell, slot) in slot.iter_mut().enumerate() {
            if solid.holds(cell) {
                *slot = index.len() as u32;
                index.push(cell as u32);
            }
        }
        let mut around = Vec::new();
        let (row, layer) = (solid.size[0] as isize, (solid.size[0] * solid.size[1]) as isize);
        for z in -1..=1isize {
            for y in -1..=1isize {
                for x in -1..=1isize {
                    let sides = (x.abs() + y.abs() + z.abs()) as usize;
                    if sides > 0 {
                        around.push((z * layer + y * row + x, STEPS[sides - 1]));
                    }
                }
            }
        }
        Self { index, slot, around }
    }

    /// The slots beside one. The margin of the solid is empty: no neighbour is beyond the grid.
    fn beside(&self, slot: u32) -> impl Iterator<Item = (u32, u32)> {
        let cell = self.index[slot as usize] as isize;
        self.around.iter().filter_map(move |&(offset, step)| {
            let other = *self.slot.get((cell + offset) as usize)?;
            (other != NONE).then_some((other, step))
        })
    }

    /// How far each cell is from the core through filled cells, in thirds of a cell; `NONE` where no way leads.
    fn distances(&self, solid: &Solid, axis: f64, heights: Range<f64>) -> Vec<u32> {
        let mut far = vec![NONE; self.index.len()];
        // A ring of buckets: no step is longer than the last one is ahead.
        let mut buckets: [Vec<u32>; 6] = Default::default();
        for (slot, far) in far.iter_mut().enumerate() {
            let at = solid.middle_of(self.index[slot] as usize);
            if (at.x - axis).abs() < solid.cell && heights.contains(&at.y) {
                *far = 0;
                buckets[0].push(slot as u32);
            }
        }
        let mut at = 0u32;
        while buckets.iter().any(|bucket| !bucket.is_empty()) {
            for slot in std::mem::take(&mut buckets[(at % 6) as usize]) {
                if far[slot as usize] != at {
                    continue;
                }
                for (other, step) in self.beside(slot) {
                    let next = at + step;
                    if next < far[other as usize] {
                        far[other as usize] = next;
                        buckets[(next % 6) as usize].push(other);
                    }
                }
            }
            at += 1;
        }
        far
    }

    /// The pieces of the merge tree that are long enough.
    fn merge(&self, far: &[u32]) -> Vec<Piece> {
        let order = furthest_first(far);
        let mut groups = Groups::new(far.len());
        // Of each group's least slot the piece that goes on there.
        let mut owner = vec![NONE; far.len()];
        let mut pieces: Vec<Piece> = Vec::new();
        for slot in order {
            let at = |slot: u32| (std::cmp::Reverse(far[slot as usize]), slot);
            let mut own = slot as usize;
            for (other, _) in self.beside(slot).filter(|&(other, _)| at(other) < at(slot)) {
                let (a, b) = (own, groups.least(other as usize));
                if a == b {
                    continue;
                }
                // The longer one goes on.
                let (one, two) = (owner[a], owner[b]);
                let goes_on = match (one, two) {
                    (NONE, two) => two,
                    (one, NONE) => one,
                    (one, two) if pieces[one as usize].far >= pieces[two as usize].far => one,
                    (_, two) => two,
                };
                groups.join(a, b);
                own = a.min(b);
                owner[own] = goes_on;
            }
            if owner[own] == NONE {
                owner[own] = pieces.len() as u32;
                pieces.push(Piece { far: far[slot as usize], cells: Vec::new(), rims: Vec::new() });
            }
            pieces[owner[own] as usize].cells.push(slot);
        }
        pieces
    }

    /// Cuts a piece into sections; false where it is too short.
    fn measure(&self, solid: &Solid, far: &[u32], piece: &mut Piece) -> bool {
        let last = piece.cells.last().map_or(0, |&slot| far[slot as usize]);
        if f64::from(piece.far - last) / 3.0 * solid.cell < LEAST_BRANCH {
            return false;
        }
        let band = |slot: u32| (piece.far - far[slot as usize]) / BAND;
        for cells in piece.cells.chunk_by(|&a, &b| band(a) == band(b)) {
            let count = cells.len() as f64;
            let at = |slot: u32| solid.middle_of(self.index[slot as usize] as usize);
            let middle = cells.iter().map(|&slot| at(slot)).sum::<DVec3>() / count;
            let outer: Vec<f64> = cells
                .iter()
                .filter(|&&slot| self.beside(slot).filter(|&(_, step)| step == STEPS[0]).count() < 6)
                .map(|&slot| at(slot).distance(middle))
                .collect();
            let radius = outer.iter().sum::<f64>() / outer.len().max(1) as f64;
            piece.rims.push(Rim { middle, radius });
        }
        true
    }
}
