//! Which side of a surface is its outside, whatever way its triangles face.

use crate::geometry::{Groups, by_number, double_area};
use glam::DVec3;

/// The volume of a thing over its area to the power of 1.5 up to which it is a sheet without an outside (a coat 0.005 H
/// thick has 0.004), and from which on it has one (a person has 0.027, a limb as long as 60 radii 0.026, a ball 0.094).
const FULLNESS: [f64; 2] = [0.004, 0.008];

/// How a triangle faces.
#[derive(Clone, Copy, Debug)]
pub struct Side {
    /// True where it faces inwards.
    pub is_inward: bool,
    /// 0..1: how sure that is.
    pub sure: f64,
}

/// How each triangle faces.
///
/// Triangles are turned alike where two of them share an edge; what hangs together so has its outside where that makes
/// its volume positive, holes closed from its middle. What has none faces as the rest of the file does.
///
/// O(triangles).
pub fn sides(points: &[DVec3], triangles: &[[u32; 3]]) -> Vec<Side> {
    let patch_of = patches(points.len(), triangles);
    let doubles: Vec<DVec3> = triangles.iter().map(|&corners| double_area(points, corners)).collect();
    let middle =
        |corners: &[u32; 3]| corners.iter().map(|&vertex| points[vertex as usize]).sum::<DVec3>() / 3.0;
    let mut sums = vec![(0.0, DVec3::ZERO); triangles.len()];
    for ((corners, &(patch, _)), double) in triangles.iter().zip(&patch_of).zip(&doubles) {
        let (area, moment) = &mut sums[patch];
        *area += double.length();
        *moment += double.length() * middle(corners);
    }
    // Of each patch, as if it faced as its first triangle does; and of the file as it is.
    let mut volumes = vec![0.0; triangles.len()];
    let mut as_wound = 0.0;
    for ((corners, &(patch, is_turned)), double) in triangles.iter().zip(&patch_of).zip(&doubles) {
        let (area, moment) = sums[patch];
        let cone = (middle(corners) - moment / area).dot(*double) / 6.0;
        if cone.is_finite() {
            volumes[patch] += if is_turned { -cone } else { cone };
            as_wound += cone;
        }
    }
    let side = |&(patch, is_turned): &(usize, bool)| {
        let volume: f64 = volumes[patch];
        let fullness = volume.abs() / (0.5 * sums[patch].0).powf(1.5);
        let sure = ((fullness - FULLNESS[0]) / (FULLNESS[1] - FULLNESS[0])).clamp(0.0, 1.0);
        let is_inward = if sure > 0.0 { is_turned == (volume > 0.0) } else { as_wound < 0.0 };
        // No area, no volume.
        Side { is_inward, sure: if sure.is_nan() { 0.0 } else { sure } }
    };
    patch_of.iter().map(side).collect()
}

/// Outward unit normals of the vertices, shorter where it is in doubt which side is the outside, 0 where nothing tells.
///
/// O(triangles).
pub fn outward(points: &[DVec3], triangles: &[[u32; 3]]) -> Vec<DVec3> {
    let mut sums = vec![(DVec3::ZERO, 0.0, 0.0); points.len()];
    for (corners, side) in triangles.iter().zip(sides(points, triangles)) {
        let double = double_area(points, *corners);
        for &vertex in corners {
            let (normal, known, all) = &mut sums[vertex as usize];
            *normal += if side.is_inward { -side.sure * double } else { side.sure * double };
            *known += side.sure * double.length();
            *all += double.length();
        }
    }
    let share = |known: f64, all: f64| if all > 0.0 { known / all } else { 0.0 };
    sums.into_iter().map(|(normal, known, all)| share(known, all) * normal.normalize_or_zero()).collect()
}

/// For each triangle the first one of those that hang together with it over edges of two, and whether it faces another way than
/// that one.
fn patches(vertex_count: usize, triangles: &[[u32; 3]]) -> Vec<(usize, bool)> {
    // Edges by their lesser end.
    let edges = (0..).zip(triangles).flat_map(|(triangle, &[a, b, c])| {
        [(a, b), (b, c), (c, a)].map(|(one, other)| (one.min(other), (one.max(other), triangle, one < other)))
    });
    let mut edges = by_number(vertex_count, edges);
    // Each triangle as it is, 2 of its number, and turned over, 1 more.
    let mut groups = Groups::new(2 * triangles.len());
    for vertex in 0..vertex_count {
        let around = edges.of_mut(vertex);
        around.sort_unstable();
        for edge in around.chunk_by(|one, other| one.0 == other.0) {
            if let &[(_, one, rises), (_, other, rises_too)] = edge {
                let (one, other): (usize, usize) = (2 * one, 2 * other);
                // What hangs together already stays as it is: a surface may have one side only.
                if groups.least(one) / 2 != groups.least(other) / 2 {
                    let differ = usize::from(rises == rises_too);
                    groups.join(one, other + differ);
                    groups.join(one + 1, other + 1 - differ);
                }
            }
        }
    }
    let firsts = (0..triangles.len()).map(|triangle| groups.least(2 * triangle));
    firsts.map(|first| (first / 2, first % 2 == 1)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A ball of `sides` columns and rows around `middle`.
    fn ball(middle: DVec3, radius: f64, sides: u32) -> (Vec<DVec3>, Vec<[u32; 3]>) {
        let mut positions = Vec::new();
        let mut triangles = Vec::new();
        for row in 0..=sides {
            for column in 0..sides {
                let (across, up) = (std::f64::consts::PI * f64::from(row) / f64::from(sides)).sin_cos();
                let (sin, cos) = (std::f64::consts::TAU * f64::from(column) / f64::from(sides)).sin_cos();
                positions.push(middle + radius * DVec3::new(across * cos, up, across * sin));
            }
        }
        for row in 1..sides - 1 {
            for column in 0..sides {
                let [a, b] = [column, (column + 1) % sides].map(|column| row * sides + column);
                triangles.extend([[a, b, b + sides], [a, b + sides, a + sides]]);
            }
        }
        (positions, triangles)
    }

    #[test]
    fn the_outside_of_a_ball_is_away_from_its_middle_whatever_way_triangles_face() {
        let middle = DVec3::new(0.3, -0.2, 0.1);
        let (positions, mut triangles) = ball(middle, 0.2, 24);
        // Open at both ends; every third triangle turned over.
        triangles.iter_mut().step_by(3).for_each(|corners| corners.swap(0, 1));
        let mut seen = 0;
        for (normal, p) in outward(&positions, &triangles).into_iter().zip(&positions) {
            if normal != DVec3::ZERO {
                assert!((normal.length() - 1.0).abs() < 1e-12);
                assert!(normal.dot((p - middle).normalize()) > 0.95, "{p} {normal}");
                seen += 1;
            }
        }
        assert_eq!(seen, 24 * 23);
    }

    #[test]
    fn a_sheet_has_no_outside() {
        // A box 1 by 1 by 0.005: 0.005 / (2.02)^1.5 = 0.0017.
        let corner =
            |i: u32| DVec3::new(f64::from(i & 1), f64::from(i >> 1 & 1), 0.005 * f64::from(i >> 2 & 1));
        let faces = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]];
        let triangles: Vec<[u32; 3]> =
            faces.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
        let thin: Vec<DVec3> = (0..8).map(corner).collect();
        assert!(outward(&thin, &triangles).iter().all(|&normal| normal == DVec3::ZERO));
        let thick: Vec<DVec3> = thin.iter().map(|&p| p * DVec3::new(1.0, 1.0, 100.0)).collect();
        let middle = DVec3::new(0.5, 0.5, 0.25);
        for (normal, p) in outward(&thick, &triangles).into_iter().zip(&thick) {
            assert!(normal.dot(p - middle) > 0.0, "{p} {normal}");
        }
    }
}
