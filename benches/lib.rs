//! Characters to measure on: made here, so that a number means the same on every machine.

pub mod models;

use glam::{DMat4, DVec3, Vec3};
use superdeform::{Character, Humanoid, Joint, Mesh, Role, Skeleton, Weights};

/// A tube of `ring_count` rings of `side_count` vertices that stands on a chain of hips, spine and head, its
/// weights blended from joint to joint.
pub fn tube(ring_count: usize, side_count: usize) -> Character {
    let heights = [0.0, 0.6, 1.2];
    let roles = [Role::Hips, Role::Spine, Role::Head];
    let mut humanoid = Humanoid::default();
    let mut skeleton = Skeleton::default();
    for (index, (&height, role)) in heights.iter().zip(roles).enumerate() {
        humanoid.set(role, index);
        skeleton.joints.push(Joint {
            name: role.name().to_string(),
            parent: index.checked_sub(1),
            rest: DMat4::from_translation(DVec3::new(0.0, height, 0.0)),
        });
    }
    let mut mesh = Mesh { name: "tube".to_string(), ..Mesh::default() };
    let mut rows = Vec::new();
    for ring in 0..ring_count {
        let height = 1.6 * ring as f32 / (ring_count - 1) as f32;
        for side in 0..side_count {
            let (sin, cos) = (std::f32::consts::TAU * side as f32 / side_count as f32).sin_cos();
            mesh.positions.push(Vec3::new(0.2 * cos, height, 0.2 * sin));
            mesh.normals.push(Vec3::new(cos, 0.0, sin));
            let along = (height / 0.6).min(1.999);
            let (lower, share) = (along as u32, along.fract());
            rows.push([(lower, 1.0 - share), (lower + 1, share)]);
        }
    }
    for ring in 1..ring_count as u32 {
        for side in 0..side_count as u32 {
            let next = (side + 1) % side_count as u32;
            let [below, above] = [(ring - 1) * side_count as u32, ring * side_count as u32];
            mesh.triangles.push([below + side, above + side, above + next]);
            mesh.triangles.push([below + side, above + next, below + next]);
        }
    }
    mesh.weights = Weights::from_rows(rows);
    Character { meshes: vec![mesh], skeleton, humanoid, ..Character::default() }
}

/// A closed body in one piece around capsules (two ends and a radius each), of about 14,000 vertices where the capsules
/// are a person 1 high: the surface of `cells` cells a unit, smoothed.
pub fn body_of_capsules(capsules: &[([DVec3; 2], f64)], cells: f64) -> (Vec<DVec3>, Vec<[u32; 3]>) {
    let (mut low, mut high) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    for &([a, b], radius) in capsules {
        low = low.min(a.min(b) - radius);
        high = high.max(a.max(b) + radius);
    }
    let low = low - 2.0 / cells;
    let size = ((high - low) * cells).ceil().as_i64vec3() + 2;
    let is_inside = |x: i64, y: i64, z: i64| {
        let p = low + DVec3::new(x as f64 + 0.5, y as f64 + 0.5, z as f64 + 0.5) / cells;
        capsules
            .iter()
            .any(|&([a, b], radius)| superdeform::internals::geometry::foot(p, a, b).0.distance(p) < radius)
    };
    let slot = |[x, y, z]: [i64; 3]| ((z * size.y + y) * size.x + x) as usize;
    let mut inside = vec![false; (size.x * size.y * size.z) as usize];
    let cells_of = || {
        (1..size.z - 1)
            .flat_map(move |z| (1..size.y - 1).flat_map(move |y| (1..size.x - 1).map(move |x| [x, y, z])))
    };
    for [x, y, z] in cells_of() {
        inside[slot([x, y, z])] = is_inside(x, y, z);
    }
    let mut numbers = std::collections::BTreeMap::new();
    let mut positions: Vec<DVec3> = Vec::new();
    let mut triangles = Vec::new();
    for cell in cells_of().filter(|&cell| inside[slot(cell)]) {
        for axis in 0..3 {
            for side in [0, 1] {
                let mut next = cell;
                next[axis] += 2 * side - 1;
                if inside[slot(next)] {
                    continue;
                }
                let corners = [[0, 0], [1, 0], [1, 1], [0, 1]].map(|[u, v]| {
                    let mut corner = cell;
                    corner[axis] += side;
                    corner[(axis + 1) % 3] += u;
                    corner[(axis + 2) % 3] += v;
                    *numbers.entry(corner).or_insert_with(|| {
                        let [x, y, z] = corner.map(|x| x as f64);
                        positions.push(low + DVec3::new(x, y, z) / cells);
                        positions.len() as u32 - 1
                    })
                });
                let [a, b, c, d] = corners;
                triangles.extend(if side == 1 { [[a, b, c], [a, c, d]] } else { [[a, c, b], [a, d, c]] });
            }
        }
    }
    for _ in 0..6 {
        let mut sums = vec![(DVec3::ZERO, 0.0); positions.len()];
        for corners in &triangles {
            let middle = corners.iter().map(|&vertex| positions[vertex as usize]).sum::<DVec3>() / 3.0;
            for &vertex in corners {
                sums[vertex as usize].0 += middle;
                sums[vertex as usize].1 += 1.0;
            }
        }
        positions = sums.into_iter().map(|(sum, count)| sum / count).collect();
    }
    (positions, triangles)
}

/// The mesh with edges halved, the longest first, until it has `vertex_count` vertices; a closed mesh stays closed.
pub fn refined(
    positions: &[DVec3],
    triangles: &[[u32; 3]],
    vertex_count: usize,
) -> (Vec<DVec3>, Vec<[u32; 3]>) {
    let (mut positions, mut triangles) = (positions.to_vec(), triangles.to_vec());
    let key = |a: u32, b: u32| (a.min(b), a.max(b));
    let mut at_edge = std::collections::BTreeMap::<(u32, u32), Vec<usize>>::new();
    let mut longest = std::collections::BinaryHeap::new();
    let length = |positions: &[DVec3], (a, b): (u32, u32)| {
        // Floats that are 0 or more are ordered as their bits.
        positions[a as usize].distance(positions[b as usize]).to_bits()
    };
    for (triangle, &[a, b, c]) in triangles.iter().enumerate() {
        for edge in [key(a, b), key(b, c), key(c, a)] {
            let at_edge = at_edge.entry(edge).or_default();
            if at_edge.is_empty() {
                longest.push((length(&positions, edge), edge));
            }
            at_edge.push(triangle);
        }
    }
    while positions.len() < vertex_count {
        let Some((_, (a, b))) = longest.pop() else {
            break;
        };
        let Some(around) = at_edge.remove(&(a, b)) else {
            continue;
        };
        let middle = positions.len() as u32;
        positions.push(positions[a as usize].midpoint(positions[b as usize]));
        let mut new_edges = vec![key(a, middle), key(b, middle)];
        for triangle in around {
            let old = triangles[triangle];
            let new = triangles.len();
            triangles[triangle] = old.map(|vertex| if vertex == b { middle } else { vertex });
            triangles.push(old.map(|vertex| if vertex == a { middle } else { vertex }));
            if let Some(&apex) = old.iter().find(|&&vertex| vertex != a && vertex != b) {
                at_edge.entry(key(a, middle)).or_default().push(triangle);
                at_edge.entry(key(b, middle)).or_default().push(new);
                at_edge.entry(key(apex, middle)).or_default().extend([triangle, new]);
                new_edges.push(key(apex, middle));
                for other in at_edge.get_mut(&key(b, apex)).into_iter().flatten() {
                    if *other == triangle {
                        *other = new;
                    }
                }
            }
        }
        longest.extend(new_edges.into_iter().map(|edge| (length(&positions, edge), edge)));
    }
    (positions, triangles)
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    #[test]
    fn a_tube_is_a_valid_character() {
        let character = super::tube(100, 30);
        character.validate().unwrap();
        assert_eq!(character.vertex_count(), 3000);
        assert_eq!(character.triangle_count(), 2 * 99 * 30);
    }

    #[test]
    fn bodies_are_closed_at_any_number_of_vertices() {
        let capsules = [([DVec3::ZERO, DVec3::Y], 0.2), ([0.8 * DVec3::Y, DVec3::new(0.6, 0.8, 0.1)], 0.1)];
        let (positions, triangles) = super::body_of_capsules(&capsules, 30.0);
        for vertex_count in [positions.len(), 3000, 10_000] {
            let (positions, triangles) = super::refined(&positions, &triangles, vertex_count);
            assert_eq!(positions.len(), vertex_count);
            let mut balance = std::collections::BTreeMap::new();
            for [a, b, c] in triangles {
                for (a, b) in [(a, b), (b, c), (c, a)] {
                    *balance.entry((a.min(b), a.max(b))).or_insert(0) += if a < b { 1 } else { -1 };
                }
            }
            assert!(balance.values().all(|&balance| balance == 0));
        }
    }
}
