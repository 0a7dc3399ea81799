//! Vertices that a fault has flung far away: they say nothing about a figure, but would be all of its size.

use crate::character::Character;
use crate::geometry::marked;
use glam::{DVec3, Vec3};
use std::borrow::Cow;
use std::collections::BTreeMap;

/// Vertices that lie this many times as far from the middle as all that are nearer are far away. A sword is as long as its
/// figure, from whose middle a foot is half as far: twice.
const JUMP: f32 = 4.0;
/// No more than this share of the vertices is far away, beside `COPIES`.
const MOST: f64 = 0.01;
/// So many copies of one vertex at a seam may be far away as well. What consists of fewer than `LEAST_VERTICES`
/// has no usual size.
const COPIES: usize = 4;
const LEAST_VERTICES: usize = 64;

/// `character` with each vertex that lies far away from all others moved between its neighbours, for measuring.
///
/// Borrowed where there is none. A vertex whose neighbours are all far away goes to the middle of the others.
///
/// O(vertices + triangles).
pub fn gathered(character: &Character) -> Cow<'_, Character> {
    let mut points: Vec<Vec3> = Vec::with_capacity(character.vertex_count());
    for mesh in &character.meshes {
        let corners = mesh.triangles.iter().flatten();
        let used = marked(mesh.positions.len(), corners.map(|&vertex| vertex as usize));
        points.extend(mesh.positions.iter().zip(used).filter(|&(_, used)| used).map(|(p, _)| p));
    }
    if points.len() < LEAST_VERTICES {
        return Cow::Borrowed(character);
    }
    let median = |axis: usize| {
        let mut values: Vec<f32> = points.iter().map(|p| p[axis]).collect();
        let half = values.len() / 2;
        *values.select_nth_unstable_by(half, f32::total_cmp).1
    };
    let middle = Vec3::new(median(0), median(1), median(2));
    let mut distances: Vec<f32> = points.iter().map(|p| p.distance(middle)).collect();
    let most = (MOST * distances.len() as f64) as usize + COPIES;
    let last = distances.len() - 1 - most;
    distances.select_nth_unstable_by(last, f32::total_cmp);
    distances[last..].sort_unstable_by(f32::total_cmp);
    let jump = distances[last..].windows(2).find(|pair| pair[0] > 0.0 && pair[1] > JUMP * pair[0]);
    let Some(reach) = jump.map(|pair| pair[0]) else { return Cow::Borrowed(character) };

    let is_far = |p: Vec3| p.distance(middle) > reach;
    let mut gathered = character.clone();
    for mesh in &mut gathered.meshes {
        // Of each vertex that is far away: the sum of its neighbours, and how many they are.
        let mut beside: BTreeMap<u32, (DVec3, f64)> = BTreeMap::new();
        for corners in &mesh.triangles {
            let places = corners.map(|vertex| mesh.positions[vertex as usize]);
            for (&vertex, _) in corners.iter().zip(places).filter(|&(_, p)| is_far(p)) {
                let entry = beside.entry(vertex).or_default();
                for p in places.into_iter().filter(|&p| !is_far(p)) {
                    *entry = (entry.0 + p.as_dvec3(), entry.1 + 1.0);
                }
            }
        }
        for (vertex, (sum, count)) in beside {
            mesh.positions[vertex as usize] = if count > 0.0 { (sum / count).as_vec3() } else { middle };
        }
    }
    Cow::Owned(gathered)
}
