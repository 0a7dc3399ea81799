//! Cloth that hangs from the hips by joints of its own, as spring skirts do, follows the legs under it (product mode).
//!
//! Such joints play no role, so what they move folds into the torso, whose map knows nothing of what lies below the crotch:
//! a hem became a third wider than that of the same skirt with weights to the legs, and longer or shorter than the legs.

use super::part::{Part, PartWeights, TINY, add};
use super::smoothing::{Fork, LAYER_NEIGHBOURS};
use crate::character::MeshKind;
use crate::geometry::point_tree::PointTree;
use crate::geometry::smoothstep;
use crate::shape::figure::Figure;
use glam::DVec3;

/// A vertex hangs where joints without a role have more than this weight. D26.
const HANGS: f64 = 0.5;

/// Gives cloth that hangs below the crotch the weights of the body under it, for the torso's: by and by, as far down as left
/// and right leg take to part.
pub fn follow_legs(figure: &Figure, fork: Fork, parts: &mut [PartWeights]) {
    let Fork { crotch, apart } = fork;
    let hangs = |vertex: usize| {
        figure.kind(vertex) == MeshKind::Garment
            && figure.extra_weight[vertex] > HANGS
            && figure.positions[vertex].y < crotch
    };
    let hanging: Vec<usize> = (0..parts.len()).filter(|&vertex| hangs(vertex)).collect();
    if hanging.is_empty() || apart <= 0.0 {
        return;
    }
    // The feet stand apart from the legs; a hem over them still follows the legs.
    let of_legs = |row: &PartWeights| {
        let mut legs = [0.0; super::part::PART_COUNT];
        for [upper, lower, foot] in [
            [Part::LeftUpperLeg, Part::LeftLowerLeg, Part::LeftFoot],
            [Part::RightUpperLeg, Part::RightLowerLeg, Part::RightFoot],
        ] {
            legs[upper as usize] = row[upper as usize];
            legs[lower as usize] = row[lower as usize] + row[foot as usize];
        }
        legs
    };
    let is_under = |vertex: usize| {
        figure.extra_weight[vertex] <= HANGS && of_legs(&parts[vertex]).iter().sum::<f32>() as f64 > HANGS
    };
    let under: Vec<usize> = (0..parts.len()).filter(|&vertex| is_under(vertex)).collect();
    let points: Vec<DVec3> = under.iter().map(|&vertex| figure.positions[vertex]).collect();
    let rows: Vec<PartWeights> = under.iter().map(|&vertex| of_legs(&parts[vertex])).collect();
    let tree = PointTree::new(&points);
    let mut found = Vec::new();
    for vertex in hanging {
        let p = figure.positions[vertex];
        tree.nearest(p, LAYER_NEIGHBOURS, f64::INFINITY, &mut found);
        let Some(width) = found.first().map(|near| near.distance().max(TINY)) else {
            return;
        };
        let mut legs = [0.0; super::part::PART_COUNT];
        for near in &found {
            let off = near.distance() / width;
            add(&mut legs, &rows[near.index() as usize], (-0.5 * off * off).exp() as f32);
        }
        let total: f32 = legs.iter().sum();
        let share = smoothstep((crotch - p.y) / apart) as f32 * parts[vertex][Part::Torso as usize];
        if total > 0.0 && share > 0.0 {
            parts[vertex][Part::Torso as usize] -= share;
            add(&mut parts[vertex], &legs, share / total);
        }
    }
}
