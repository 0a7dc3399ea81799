//! Strands from the body to what is carried on it: a cord to its plug, a strap to its bag (product mode).
//!
//! What is carried moves as one piece, the body as its parts say. A component that belongs to both leads from the one map to
//! the other along itself, so that neither end tears off.

use crate::geometry::{Neighbours, Weld, smoothstep};
use crate::shape::figure::Figure;
use std::cmp::Reverse;
use std::collections::{BTreeMap, BinaryHeap};

/// The part of a strand, from where the body holds it to its far end, over which it goes over to the piece. D26. Half: the
/// bend is spread over as much of the strand as can be, and the half beside the piece keeps its shape with it.
const GOING_OVER: f64 = 0.5;

/// For each of `members` how far it goes with the piece: 0 where `of_body` says that the body moves it, then more with the
/// distance from there along edges, 1 from half the greatest distance on.
///
/// What no edge joins to the body's vertices goes with the piece. O(members · log members).
pub fn shares(
    figure: &Figure,
    weld: &Weld,
    neighbours: &Neighbours,
    members: &[u32],
    of_body: impl Fn(u32) -> bool,
) -> Vec<f32> {
    let welded = |vertex: u32| weld.representative[vertex as usize];
    let mut place = BTreeMap::new();
    let mut distances: BTreeMap<u32, f64> = BTreeMap::new();
    let mut heap = BinaryHeap::new();
    for &vertex in members {
        place.insert(welded(vertex), figure.positions[vertex as usize]);
        if of_body(vertex) && distances.insert(welded(vertex), 0.0).is_none() {
            heap.push(Reverse((0u64, welded(vertex))));
        }
    }
    while let Some(Reverse((bits, at))) = heap.pop() {
        // Distances are 0 or more, whose bits are in order.
        let distance = f64::from_bits(bits);
        if distances.get(&at).is_some_and(|&least| least < distance) {
            continue;
        }
        for next in neighbours.of(at as usize) {
            let Some(p) = place.get(next) else { continue };
            let reached = distance + p.distance(place[&at]);
            if distances.get(next).is_none_or(|&least| reached < least) {
                distances.insert(*next, reached);
                heap.push(Reverse((reached.to_bits(), *next)));
            }
        }
    }
    let most = distances.values().copied().fold(0.0, f64::max);
    let share = |&vertex: &u32| match distances.get(&welded(vertex)) {
        Some(&distance) if most > 0.0 => smoothstep(distance / (GOING_OVER * most)) as f32,
        Some(_) => 0.0,
        None => 1.0,
    };
    members.iter().map(share).collect()
}
