//! What a plane through the wrist cuts off.

use crate::geometry::{SEAM, components, weld};
use glam::DVec3;
use std::collections::BTreeMap;
use std::f64::consts::TAU;

/// Outlines below this share of the radius of one around the wrist are no arms. Seen: ±30 % changes no finger.
const SLIVER: f64 = 0.3;

/// What a plane through the wrist cuts.
pub(super) struct Section {
    pub(super) centre: DVec3,
    pub(super) radius: f64,
    /// Vertices ahead of the plane whose edges it cuts.
    pub(super) ahead: Vec<u32>,
}

/// An outline in the plane.
#[derive(Clone, Copy)]
struct Outline {
    sum: DVec3,
    length: f64,
    distance: f64,
}

impl Outline {
    fn centre(&self) -> DVec3 {
        self.sum / self.length
    }

    fn radius(&self) -> f64 {
        self.length / TAU
    }
}

impl Section {
    /// The section of the mesh across `along` that is nearest to `at`, within `reach`, with what it lies in or around:
    /// an arm in its sleeve, a ball in its socket.
    pub(super) fn new(
        positions: &[DVec3],
        triangles: &[[u32; 3]],
        at: DVec3,
        along: DVec3,
        reach: f64,
    ) -> Option<Self> {
        let height = |vertex: u32| (positions[vertex as usize] - at).dot(along);
        // A triangle's part of the section.
        let part_of = |&corners: &[u32; 3]| {
            let heights = corners.map(height);
            let above = heights.map(|height| height > 0.0);
            let lone = (0..3).find(|&c| above[c] != above[(c + 1) % 3] && above[c] != above[(c + 2) % 3])?;
            let ends = [1, 2].map(|step| {
                let other = (lone + step) % 3;
                let share = heights[lone] / (heights[lone] - heights[other]);
                positions[corners[lone] as usize].lerp(positions[corners[other] as usize], share)
            });
            (ends[0].distance_squared(at) <= reach * reach).then_some((ends, corners))
        };
        let (pieces, cut): (Vec<[DVec3; 2]>, Vec<[u32; 3]>) = triangles.iter().filter_map(part_of).unzip();
        // Ends of neighbours lie on one edge.
        let weld = weld(pieces.as_flattened(), SEAM);
        let lines: Vec<[u32; 3]> =
            (0..pieces.len() as u32).map(|piece| [2 * piece, 2 * piece + 1, 2 * piece]).collect();
        let outline_of_end = components(&lines, &weld);
        let first_ends = weld.representative.iter().step_by(2);
        let outline_of: Vec<u32> = first_ends.map(|&end| outline_of_end[end as usize]).collect();
        let mut outlines: BTreeMap<u32, Outline> = BTreeMap::new();
        for (&[a, b], &outline) in pieces.iter().zip(&outline_of) {
            let none = Outline { sum: DVec3::ZERO, length: 0.0, distance: f64::INFINITY };
            let outline = outlines.entry(outline).or_insert(none);
            outline.sum += a.distance(b) * (a + b) / 2.0;
            outline.length += a.distance(b);
            outline.distance = outline.distance.min(a.distance(at)).min(b.distance(at));
        }
        // Slivers of folds and bolts say nothing beside what goes round the wrist.
        let around = outlines
            .values()
            .filter(|outline| outline.length > 0.0 && outline.centre().distance(at) < outline.radius())
            .map(Outline::radius)
            .fold(0.0, f64::max);
        outlines.retain(|_, outline| outline.length > 0.0 && outline.radius() >= SLIVER * around);
        let nearest = *outlines.values().min_by(|one, other| one.distance.total_cmp(&other.distance))?;
        outlines.retain(|_, outline| {
            outline.centre().distance(nearest.centre()) < outline.radius().max(nearest.radius())
        });
        let radius = outlines.values().map(Outline::radius).fold(0.0, f64::max);
        let length: f64 = outlines.values().map(|outline| outline.length).sum();
        let centre = outlines.values().map(|outline| outline.sum).sum::<DVec3>() / length;
        let chosen = cut.iter().zip(&outline_of).filter(|(_, outline)| outlines.contains_key(outline));
        let ahead =
            chosen.flat_map(|(corners, _)| corners).copied().filter(|&vertex| height(vertex) > 0.0).collect();
        Some(Self { centre, radius, ahead })
    }
}
