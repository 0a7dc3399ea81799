//! Which vertices are a skirt's, a robe's or the tails' of a coat: they hang around both legs and follow neither.

use super::cuts::{BodyFrame, SKIRT_OVER_MIDDLE};
use crate::geometry::bounds_by_group;
use crate::geometry::weld::{Weld, components, neighbours};
use crate::shape::figure::Figure;
use crate::shape::product::anatomy::Anatomy;

/// From this part of the leg's length under the crotch on, trousers are two tubes.
const FORK: f64 = 0.08;
/// Heights at which pieces are looked at, as parts of the leg's length under the crotch.
const HEIGHTS: [f64; 6] = [FORK, 0.2, 0.35, 0.5, 0.65, 0.8];

/// True for the vertices of pieces that below the crotch still join left and right; upwards to the crotch.
///
/// - `weld`: the figure's vertices by position.
///
/// O(triangles).
pub fn skirt_vertices(figure: &Figure, anatomy: &Anatomy, weld: &Weld) -> Vec<bool> {
    let frame = BodyFrame::of(figure, anatomy);
    let crotch = frame.heights.crotch;
    let height = |t: f64| crotch - t * frame.leg_length;
    let firsts = weld.first_vertices();
    let place = |welded: usize| figure.positions[firsts[welded] as usize];
    let (fork, reach) = (height(FORK), SKIRT_OVER_MIDDLE * frame.head_length());
    let hanging: Vec<[u32; 3]> = figure
        .triangles
        .iter()
        .filter(|corners| {
            corners.iter().any(|&vertex| figure.positions[vertex as usize].y < crotch)
                && !figure.is_carried(corners[0] as usize)
        })
        .copied()
        .collect();
    let mut is_skirt = vec![false; weld.count];
    for y in HEIGHTS.map(height) {
        let is_above = |vertex: u32| figure.positions[vertex as usize].y > y;
        let cut: Vec<[u32; 3]> = hanging
            .iter()
            .filter(|corners| corners.iter().any(|&v| is_above(v)) && !corners.iter().all(|&v| is_above(v)))
            .copied()
            .collect();
        let piece = components(&cut, weld);
        let corners = || cut.iter().flat_map(|&corners| weld.triangle(corners)).map(|welded| welded as usize);
        let placed = corners().map(|welded| (piece[welded] as usize, place(welded)));
        let boxes = bounds_by_group(weld.count, placed);
        for welded in corners() {
            let (low, high) = boxes[piece[welded] as usize];
            is_skirt[welded] |= low.x - frame.middle_x < -reach && high.x - frame.middle_x > reach;
        }
    }
    if is_skirt.iter().any(|&is_skirt| is_skirt) {
        // Down to the hem, and then up to the crotch, where legs may join it.
        let around = neighbours(&hanging, weld);
        for (bottom, top) in [(f64::NEG_INFINITY, fork), (fork, crotch)] {
            let mut next: Vec<usize> = (0..weld.count).filter(|&welded| is_skirt[welded]).collect();
            while let Some(welded) = next.pop() {
                for &other in around.of(welded) {
                    let (other, y) = (other as usize, place(other as usize).y);
                    if !is_skirt[other] && y >= bottom && y < top {
                        is_skirt[other] = true;
                        next.push(other);
                    }
                }
            }
        }
    }
    weld.representative.iter().map(|&welded| is_skirt[welded as usize]).collect()
}
