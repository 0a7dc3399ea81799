//! What is outside of a body and what inside, and where its surface ends.

use crate::geometry::{Closest, Surface, Tree, Weld, distinct, double_area, rim_edges};
use glam::DVec3;

/// The outside of a body.
pub struct Outside<'a> {
    surface: Surface,
    normals: Vec<DVec3>,
    triangles: &'a [[u32; 3]],
    weld: &'a Weld,
    /// 1, or -1 for a body that is wound to look inwards, as mirrored ones are.
    outwards: f64,
    /// That of the same body at rest, for one that has moved.
    tree: Option<&'a Tree>,
}

impl<'a> Outside<'a> {
    /// Of `triangles` between `points`; `outwards`: 1, or -1 where they are wound to look inwards.
    ///
    /// - `rims`: the triangles' own.
    /// - `tree`: that of the same triangles at rest, for a body that has moved.
    pub fn new(
        points: &[DVec3],
        triangles: &'a [[u32; 3]],
        rims: &[u32],
        weld: &'a Weld,
        outwards: f64,
        tree: Option<&'a Tree>,
    ) -> Self {
        let normals = vertex_normals(points, triangles, rims, weld);
        let surface = match tree {
            Some(tree) => Surface::with_tree(points, triangles, tree),
            None => Surface::for_many(points, triangles),
        };
        Self { surface, normals, triangles, weld, outwards, tree }
    }

    /// The tree of the body's surface, for when it has moved.
    pub fn tree(&self) -> Tree {
        Tree::of(&self.surface, self.triangles.len())
    }

    /// The closest point to `p`, how far outside of the body `p` is along the way out, below 0 inside, and that way; `None` where
    /// there is no inside: beyond a rim, where the closest point is on it, and where there is no surface.
    ///
    /// `guess`: a triangle that may be near, which saves time.
    pub fn at(&self, p: DVec3, guess: Option<u32>) -> Option<(Closest, f64, DVec3)> {
        let closest = match self.tree {
            Some(tree) => self.surface.closest_point_near(p, guess, tree)?,
            None => self.surface.closest_point(p)?,
        };
        let corners = self.weld.triangle(self.triangles[closest.triangle]);
        // A corner at a rim has no normal: the others say where outside is. What is nearest to an edge is so to all its triangles,
        // and whichever is found, the third corner has no share.
        let shares = corners.into_iter().zip(closest.barycentric);
        let blend: DVec3 = shares.map(|(corner, share)| share * self.normals[corner as usize]).sum();
        if blend == DVec3::ZERO {
            return None;
        }
        let normal = self.outwards * blend.normalize_or_zero();
        // Along the way out: where that is no way to the closest point, as in a crease, last digits tell the side.
        Some((closest, (p - closest.point).dot(normal), normal))
    }
}

/// Six times the volume within `triangles`, below 0 where they are wound to look inwards.
pub fn volume(points: &[DVec3], triangles: &[[u32; 3]]) -> f64 {
    let corners = || triangles.iter().flatten().map(|&vertex| points[vertex as usize]);
    // About its own middle, or the holes of an open body would count.
    let middle = corners().sum::<DVec3>() / (3 * triangles.len()) as f64;
    triangles
        .iter()
        .map(|corners| {
            let [a, b, c] = corners.map(|vertex| points[vertex as usize] - middle);
            a.dot(b.cross(c))
        })
        .sum()
}

/// The welded vertices at rims, where a surface ends.
pub fn rims(triangles: &[[u32; 3]], weld: &Weld) -> Vec<u32> {
    distinct(rim_edges(triangles, weld).into_flattened())
}

/// Normals of the welded vertices that `triangles` use, by area; zero elsewhere and at their [`rims`].
fn vertex_normals(points: &[DVec3], triangles: &[[u32; 3]], rims: &[u32], weld: &Weld) -> Vec<DVec3> {
    let mut normals = vec![DVec3::ZERO; weld.count];
    for corners in triangles {
        let normal = double_area(points, *corners);
        for corner in weld.triangle(*corners) {
            normals[corner as usize] += normal;
        }
    }
    for &vertex in rims {
        normals[vertex as usize] = DVec3::ZERO;
    }
    normals.iter().map(|normal| normal.normalize_or_zero()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::weld::weld;

    #[test]
    fn around_a_sharp_edge_the_distance_does_not_jump() {
        // A blade: one face of the edge is three times as large as the other, so the way out there is nearly that face's.
        let points = [
            DVec3::new(0.0, 0.0, -1.0),
            DVec3::new(0.0, 0.0, 1.0),
            DVec3::new(-1.0, 0.0, 0.0),
            DVec3::new(-0.3, -0.02, 0.0),
        ];
        let triangles = [[0, 1, 2], [1, 0, 3], [2, 3, 0], [3, 2, 1]];
        let weld = weld(&points, 1e-9);
        let outwards = volume(&points, &triangles).signum();
        let outside = Outside::new(&points, &triangles, &rims(&triangles, &weld), &weld, outwards, None);
        let around = |step: i32| {
            let angle = std::f64::consts::PI * (0.5 - f64::from(step) / 1000.0);
            let p = 0.1 * DVec3::new(angle.cos(), angle.sin(), 0.0);
            (p, outside.at(p, None).unwrap().1)
        };
        let (mut before, mut least) = (around(0), f64::INFINITY);
        for step in 1..1000 {
            let now = around(step);
            assert!(
                (now.1 - before.1).abs() <= 1.001 * now.0.distance(before.0),
                "{step}: {before:?} {now:?}"
            );
            (before, least) = (now, least.min(now.1.abs()));
        }
        assert!(least < 1e-3, "the way out is everywhere that of the closest point: {least}");
    }
}
