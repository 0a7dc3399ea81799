//! What sticks out of a trunk, in whatever direction: branches of the distance through the solid from the trunk's core.
//!
//! Cells further from the core than some distance hang together in pieces. As that distance falls, a piece is born at each
//! end of something (a hand, a foot, a crown, a tail) and grows inwards until it meets another one, where the shorter of
//! the two ends: the merge tree of the distance (Carr, Snoeyink and Axen, Computing contour trees in all dimensions, 2003).
//! The rims of a piece, one after the other, are the sections of a limb, whatever way it bends.

use super::voxels::{Queue, Voxels};
use crate::geometry::{NONE, by_key, merge_tree};
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
/// The core is so many cells thick to either side of the plane: three layers of cells.
const CORE: f64 = 1.5;

/// A section of a branch.
#[derive(Clone, Copy, Debug)]
pub struct Rim {
    /// Its middle.
    pub middle: DVec3,
    /// The mean distance of its outer cells from that.
    pub radius: f64,
}

/// Something that sticks out: its sections from the tip inwards, down to where it meets another branch.
pub type Branch = Vec<Rim>;

/// The branches of `solid` around a core: the filled cells next to the plane at `axis` in a range of heights. Longest
/// first; empty where the solid is no figure's.
pub fn branches(voxels: &Voxels, axis: f64, heights: Range<f64>) -> Vec<Branch> {
    if voxels.cells.len() as f64 * voxels.solid.cell.powi(3) > MOST_FILLED {
        return Vec::new();
    }
    let far = distances(voxels, axis, heights);
    let pieces = merge(voxels, &far);
    let mut found: Vec<Branch> = pieces.iter().filter_map(|cells| measure(voxels, &far, cells)).collect();
    found.sort_by_key(|branch| std::cmp::Reverse(branch.len()));
    found
}

/// How far each cell is from the core through filled cells, in thirds of a cell; of what no way leads to, from the plane.
fn distances(voxels: &Voxels, axis: f64, heights: Range<f64>) -> Vec<u32> {
    let solid = &voxels.solid;
    let mut far = vec![NONE; voxels.cells.len()];
    // Few numbers, all whole: this takes a quarter of the time of `least_costs`.
    let mut queue = Queue::default();
    for slot in 0..far.len() as u32 {
        let at = solid.middle(voxels.place(slot));
        if (at.x - axis).abs() < CORE * solid.cell && heights.contains(&at.y) {
            far[slot as usize] = 0;
            queue.push(0, slot);
        }
    }
    spread(voxels, &mut far, &mut queue);
    // What hangs together with nothing of that begins where it is nearest to the plane: arms of dolls and robots.
    let off = |slot: u32| (solid.middle(voxels.place(slot)).x - axis).abs();
    let mut apart: Vec<u32> = (0..far.len() as u32).filter(|&slot| far[slot as usize] == NONE).collect();
    apart.sort_by(|&one, &other| off(one).total_cmp(&off(other)));
    for slot in apart {
        if far[slot as usize] == NONE {
            far[slot as usize] = (f64::from(STEPS[0]) * off(slot) / solid.cell) as u32;
            queue.push(far[slot as usize] as usize, slot);
            spread(voxels, &mut far, &mut queue);
        }
    }
    far
}

/// Goes on from what is in the queue until all that hangs together with it is reached.
fn spread(voxels: &Voxels, far: &mut [u32], queue: &mut Queue) {
    while let Some((at, slot)) = queue.pop() {
        if far[slot as usize] as usize != at {
            continue;
        }
        for (other, sides) in voxels.beside(slot) {
            let next = at as u32 + STEPS[sides - 1];
            if next < far[other as usize] {
                far[other as usize] = next;
                queue.push(next as usize, other);
            }
        }
    }
}

/// The pieces of the merge tree: of each its cells, from the tip inwards.
fn merge(voxels: &Voxels, far: &[u32]) -> Vec<Vec<u32>> {
    // The furthest first.
    let mut order: Vec<u32> = (0..far.len() as u32).collect();
    order.sort_by_key(|&slot| std::cmp::Reverse(far[slot as usize]));
    let beside = |slot: u32| voxels.beside(slot).map(|(other, _)| other);
    let tips = merge_tree(far.len(), &order, beside, |_, _, _| ());
    by_key(tips.into_iter().zip(order)).into_values().collect()
}

/// Cuts a piece into sections; `None` where it is too short.
fn measure(voxels: &Voxels, far: &[u32], piece: &[u32]) -> Option<Branch> {
    let solid = &voxels.solid;
    let from_tip = |slot: u32| far[piece[0] as usize] - far[slot as usize];
    if f64::from(from_tip(piece[piece.len() - 1])) / 3.0 * solid.cell < LEAST_BRANCH {
        return None;
    }
    let sections = piece.chunk_by(|&a, &b| from_tip(a) / BAND == from_tip(b) / BAND);
    let rims = sections.map(|cells| {
        let count = cells.len() as f64;
        let at = |slot: u32| solid.middle(voxels.place(slot));
        let middle = cells.iter().map(|&slot| at(slot)).sum::<DVec3>() / count;
        let outer: Vec<f64> = cells
            .iter()
            .filter(|&&slot| voxels.beside(slot).filter(|&(_, sides)| sides == 1).count() < 6)
            .map(|&slot| at(slot).distance(middle))
            .collect();
        let radius = outer.iter().sum::<f64>() / outer.len().max(1) as f64;
        Rim { middle, radius }
    });
    Some(rims.collect())
}
