//! Weights of things that keep their shape.

use super::skin::{Body, Source};
use super::{Row, blended, finish, normalised, places};
use crate::geometry::{
    Bounds, Closest, SEAM, Weld, bounds_by_group, by_key, components, grown_clusters, weld,
};
use crate::rig::WeightSet;
use glam::DVec3;

/// Pieces of accessories nearer than this touch, in heights. Seen: ±30 % moves vertices by under 0.0005 H.
const TOUCH: f64 = 0.005;

/// What is within this distance of the attachment holds an accessory too, in heights. Seen: at -30 %, vertices move up
/// to 0.001 H.
const ATTACHMENT: f64 = 0.01;

/// An accessory hangs from as many joints at most. Seen: at -30 %, vertices move up to 0.004 H; at +30 %, vertices move
/// up to 0.043 H.
const ATTACHMENT_JOINTS: usize = 2;

/// With more pieces than this, only those that touch are joined, not those whose boxes overlap. Seen: ±30 % moves no
/// vertex.
const MOST_PIECES: usize = 500;

/// Weights of things that keep their shape: each connected piece, or cluster of pieces that touch, has one row, taken
/// from the body where the piece is nearest to it and sharpened to two joints at most, so that no sword bends.
///
/// All in one space in which the figure is about 1 high. Every vertex counts as `rigid_piece`, or as `no_source`.
pub fn rigid_weights(source: &Source, positions: &[DVec3], triangles: &[[u32; 3]]) -> WeightSet {
    let body = Body::new(source);
    let welded = weld(positions, SEAM);
    if body.is_empty() {
        return finish(&welded, vec![body.anything(); welded.count], &vec![Some("no_source"); welded.count]);
    }
    let points = places(&welded, positions);
    let mut rows = vec![Row::new(); welded.count];
    for piece in things(&points, &welded, triangles) {
        let closest = |&vertex: &u32| source.skin.surface.closest_point(points[vertex as usize]);
        let near: Vec<Closest> = piece.iter().filter_map(closest).collect();
        let least = near.iter().map(|near| near.distance).fold(f64::INFINITY, f64::min);
        let shares = near.iter().map(|near| (1.0 - (near.distance - least) / ATTACHMENT, near));
        let held = shares.filter(|&(share, _)| share > 0.0).map(|(share, near)| (share, body.blend(near)));
        let row = sharpened(blended(held));
        let row = if row.is_empty() { body.anything() } else { row };
        for vertex in piece {
            rows[vertex as usize] = row.clone();
        }
    }
    finish(&welded, rows, &vec![Some("rigid_piece"); welded.count])
}

/// Welded vertices by cluster: components that touch, or whose boxes do.
fn things(points: &[DVec3], welded: &Weld, triangles: &[[u32; 3]]) -> Vec<Vec<u32>> {
    let corners: Vec<[u32; 3]> = triangles.iter().map(|&corners| welded.triangle(corners)).collect();
    let near = weld(points, TOUCH);
    let component = components(&corners, &near);
    let component = |vertex: usize| component[near.representative[vertex] as usize] as usize;
    let count = (0..points.len()).map(|vertex| component(vertex) + 1).max().unwrap_or(0);
    let boxes = bounds_by_group(count, (0..points.len()).map(|vertex| (component(vertex), points[vertex])));
    let wider = |(low, high): Bounds| (low - TOUCH / 2.0, high + TOUCH / 2.0);
    let boxes: Vec<Bounds> = boxes.into_iter().map(wider).collect();
    // Crumbs by the thousand are left as they are.
    let clusters = if count <= MOST_PIECES { grown_clusters(&boxes) } else { (0..count).collect() };
    let members = (0..points.len()).map(|vertex| (clusters[component(vertex)], vertex as u32));
    by_key(members).into_values().collect()
}

/// The two strongest joints, the stronger the more.
fn sharpened(mut row: Row) -> Row {
    row.sort_by(|a, b| b.1.total_cmp(&a.1).then(a.0.cmp(&b.0)));
    row.truncate(ATTACHMENT_JOINTS);
    normalised(row.into_iter().map(|(joint, weight)| (joint, weight * weight)).collect())
}
