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
/// What no edge joins to the body's vertices goes with the piece. O(members · log members).
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
    let (own, places): (Vec<u32>, Vec<DVec3>) = place.into_iter().unzip();
    let number = |welded: u32| own.binary_search(&welded).ok().map(|number| number as u32);
    let of_body = members.iter().filter(|&&vertex| of_body(vertex));
    let starts = distinct(of_body.filter_map(|&vertex| number(welded(vertex))));
    let beside = |at: u32| {
        let (at, places) = (at as usize, &places);
        let near = neighbours.of(own[at] as usize).iter().filter_map(|&next| number(next));
        near.map(move |next| (next, places[at].distance(places[next as usize])))
    };
    let distances = least_costs(own.len(), starts.into_iter().map(|start| (start, 0.0)), beside);
    let most = distances.iter().copied().filter(|distance| distance.is_finite()).fold(0.0, f64::max);
    let distance = |vertex: u32| number(welded(vertex)).map_or(f64::INFINITY, |at| distances[at as usize]);
    let share = |&vertex: &u32| match distance(vertex) {
        f64::INFINITY => 1.0,
        distance if most > 0.0 => smoothstep(distance / (GOING_OVER * most)) as f32,
        _ => 0.0,
    };
    members.iter().map(share).collect()
}
