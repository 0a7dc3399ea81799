//! Strands from the body to what is carried on it: a cord to its plug, a strap to its bag (product mode).
//!
//! What is carried moves as one piece, the body as its parts say. A component that belongs to both leads from the one map to
//! the other along itself, so that neither end tears off.

use crate::geometry::{Neighbours, Weld, distinct, least_costs, smoothstep};
use crate::shape::figure::Figure;
use glam::DVec3;
use std::collections::BTreeMap;

/// The part of a strand, from where the body holds it to its far end, over which it goes over to the piece. D26. Half: the
/// bend is spread over as much of the strand as can be, and the half beside the piece keeps its shape with it.
const GOING_OVER: f64 = 0.5;

/// For each of `members` how far it goes with the piece: 0 where `of_body` says that the body moves it, then more with the
/// distance from there along edges, 1 from half the greatest distance on.
///
/// What no edge joins to the body's vertices goes with the piece. O(vertices + members · log members).
pub fn shares(
    figure: &Figure,
    weld: &Weld,
    neighbours: &Neighbours,
    members: &[u32],
    of_body: impl Fn(u32) -> bool,
) -> Vec<f32> {
    let welded = |vertex: u32| weld.representative[vertex as usize];
    let place: BTreeMap<u32, DVec3> =
        members.iter().map(|&vertex| (welded(vertex), figure.positions[vertex as usize])).collect();
    let starts = distinct(members.iter().filter(|&&vertex| of_body(vertex)).map(|&vertex| welded(vertex)));
    let beside = |at: u32| {
        let near = neighbours.of(at as usize).iter().filter_map(|next| place.get_key_value(next));
        let from = place[&at];
        near.map(move |(&next, p)| (next, from.distance(*p)))
    };
    let distances = least_costs(weld.count, starts.into_iter().map(|start| (start, 0.0)), beside);
    let most = distances.iter().copied().filter(|distance| distance.is_finite()).fold(0.0, f64::max);
    let share = |&vertex: &u32| match distances[welded(vertex) as usize] {
        f64::INFINITY => 1.0,
        distance if most > 0.0 => smoothstep(distance / (GOING_OVER * most)) as f32,
        _ => 0.0,
    };
    members.iter().map(share).collect()
}
