//! Rays and closest points against every triangle, and on meshes that are closed.

use super::*;
use std::f64::consts::{PI, TAU};

/// Numbers in 0..1, the same on every run.
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    }

    fn point(&mut self) -> DVec3 {
        DVec3::new(self.next(), self.next(), self.next()) * 2.0 - 1.0
    }
}

type Triangles = (Vec<DVec3>, Vec<[u32; 3]>);

/// A closed tube round the y axis with poles: rings of (radius, height), from the bottom up.
fn turned(bottom: f64, rings: &[(f64, f64)], top: f64, columns: usize) -> Triangles {
    let mut positions = vec![DVec3::Y * bottom];
    for &(radius, y) in rings {
        // Mirrored in x to the last bit, with vertices exactly on x = 0.
        positions.extend((0..columns).map(|column| {
            let angle = TAU * column as f64 / columns as f64;
            let quarter = columns / 4;
            let x = match column {
                _ if column % (2 * quarter) == quarter => 0.0,
                _ if column > quarter && column < 3 * quarter => -(PI - angle).abs().cos() * radius,
                _ => angle.min(TAU - angle).cos() * radius,
            };
            DVec3::new(x, y, angle.sin() * radius)
        }));
    }
    positions.push(DVec3::Y * top);
    let at = |ring: usize, column: usize| (1 + ring * columns + column % columns) as u32;
    let last = positions.len() as u32 - 1;
    let mut triangles = Vec::new();
    for column in 0..columns {
        triangles.push([0, at(0, column), at(0, column + 1)]);
        for ring in 1..rings.len() {
            let [a, b] = [at(ring - 1, column), at(ring - 1, column + 1)];
            let [c, d] = [at(ring, column), at(ring, column + 1)];
            triangles.extend([[a, d, b], [a, c, d]]);
        }
        triangles.push([at(rings.len() - 1, column), last, at(rings.len() - 1, column + 1)]);
    }
    (positions, triangles)
}

fn sphere() -> Triangles {
    let rings: Vec<_> =
        (1..24).map(|ring| PI * f64::from(ring) / 24.0).map(|angle| (angle.sin(), -angle.cos())).collect();
    turned(-1.0, &rings, 1.0, 32)
}

fn capsule() -> Triangles {
    let mut rings: Vec<_> = (1..=8)
        .map(|ring| PI * f64::from(ring) / 16.0)
        .map(|angle| (0.3 * angle.sin(), -0.7 - 0.3 * angle.cos()))
        .collect();
    rings.extend((1..20).map(|ring| (0.3, -0.7 + 1.4 * f64::from(ring) / 20.0)));
    let top: Vec<_> = rings[..8].iter().rev().map(|&(r, y)| (r, -y)).collect();
    rings.extend(top);
    turned(-1.0, &rings, 1.0, 24)
}

fn cube() -> Triangles {
    let positions = (0..8)
        .map(|i| DVec3::new(f64::from(i & 1), f64::from(i >> 1 & 1), f64::from(i >> 2 & 1)) * 2.0 - 1.0)
        .collect();
    let triangles = vec![
        [0, 2, 1],
        [1, 2, 3],
        [4, 5, 6],
        [5, 7, 6],
        [0, 1, 4],
        [1, 5, 4],
        [2, 6, 3],
        [3, 6, 7],
        [0, 4, 2],
        [2, 4, 6],
        [1, 3, 5],
        [3, 7, 5],
    ];
    (positions, triangles)
}

/// Rays at odd places are the easy ones: half of these start in the plane of symmetry and run within it, at
/// vertices, along edges and along the axes.
fn count_lost_rays(
    (positions, triangles): &Triangles,
    inside: impl Fn(&mut Random) -> DVec3,
    rays: usize,
) -> usize {
    let mut random = Random(7);
    let surface = Surface::new(positions, triangles);
    (0..rays)
        .filter(|ray| {
            let mut origin = inside(&mut random);
            let mut direction = random.point();
            match ray % 8 {
                0 => (origin.x, direction.x) = (0.0, 0.0),
                1 => (origin.x, direction) = (0.0, DVec3::Z),
                2 => (origin.x, direction) = (-0.0, DVec3::NEG_Y),
                3 => direction = positions[(random.next() * positions.len() as f64) as usize] - origin,
                4 => {
                    let [a, b, _] = triangles[(random.next() * triangles.len() as f64) as usize];
                    let (a, b) = (positions[a as usize], positions[b as usize]);
                    direction = a.lerp(b, random.next()) - origin;
                }
                5 => (origin.x, direction) = (0.0, DVec3::X * random.point().x.signum()),
                _ => {}
            }
            surface.first_hit(origin, direction, f64::INFINITY).is_none()
        })
        .count()
}

#[test]
fn every_ray_from_inside_a_closed_mesh_hits() {
    for (shape, radius) in [(sphere(), 0.9), (cube(), 1.0), (capsule(), 0.25)] {
        for scale in [1e-3, 1.0, 1e3] {
            let (positions, triangles) = &shape;
            let scaled = (positions.iter().map(|&p| p * scale).collect(), triangles.clone());
            let inside = |random: &mut Random| random.point() * 0.57 * radius * scale;
            assert_eq!(count_lost_rays(&scaled, inside, 100_000), 0, "at scale {scale}");
        }
    }
}

/// A closed body of 13 380 vertices, where the development models are at hand.
fn real_body() -> Option<Triangles> {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../shared/models/makehuman_female_target.glb");
    let bytes = std::fs::read(path).ok()?;
    let file = gltf::Gltf::from_slice(&bytes).unwrap();
    let body = file.meshes().find(|mesh| mesh.name() == Some("body")).unwrap();
    let primitive = body.primitives().next().unwrap();
    let reader = primitive.reader(|_| file.blob.as_deref());
    let positions = reader.read_positions().unwrap();
    let positions: Vec<DVec3> = positions.map(|p| DVec3::from_array(p.map(f64::from))).collect();
    let indices: Vec<u32> = reader.read_indices().unwrap().into_u32().collect();
    let triangles: Vec<[u32; 3]> = indices.chunks_exact(3).map(|c| [c[0], c[1], c[2]]).collect();
    Some((positions, triangles))
}

#[test]
fn every_ray_from_inside_a_real_body_hits() {
    let Some((positions, triangles)) = real_body() else {
        return;
    };
    for scale in [1e-3, 1.0, 1e3] {
        let body: Triangles = (positions.iter().map(|&p| p * scale).collect(), triangles.clone());
        let surface = Surface::new(&body.0, &body.1);
        // Points on the mirror plane between two hits of a line from the side are inside.
        let inside = |random: &mut Random| {
            loop {
                let vertex = body.0[(random.next() * body.0.len() as f64) as usize];
                let outside = DVec3::new(-scale, vertex.y, vertex.z * random.next());
                let hits = surface.all_hits(outside, DVec3::X);
                if hits.len() == 2 && hits[1].t - hits[0].t > 0.02 * scale {
                    return outside + DVec3::X * 0.5 * (hits[0].t + hits[1].t);
                }
            }
        };
        assert_eq!(count_lost_rays(&body, inside, 100_000), 0, "at scale {scale}");
    }
}

#[test]
fn hits_agree_with_a_test_of_every_triangle() {
    let mut random = Random(3);
    for soup in 0..20 {
        let count = [1, 2, 3, 10, 300][soup % 5];
        let scale = [1e-3, 1.0, 1e3][soup % 3];
        let mut positions = Vec::new();
        let mut triangles = Vec::new();
        for triangle in 0..count {
            let centre = random.point();
            positions.extend((0..3).map(|_| (centre + 0.4 * random.point()) * scale));
            triangles.push([0, 1, 2].map(|corner| 3 * triangle + corner));
        }
        let surface = Surface::new(&positions, &triangles);
        for _ in 0..500 {
            let (origin, direction) = (random.point() * 1.5 * scale, random.point());
            // Möller and Trumbore 1997: another formula, so that both are not wrong in the same way.
            let mut expected: Vec<f64> = triangles
                .iter()
                .filter_map(|t| {
                    let [a, b, c] = t.map(|vertex| positions[vertex as usize]);
                    let p = direction.cross(c - a);
                    let determinant = p.dot(b - a);
                    let u = p.dot(origin - a) / determinant;
                    let q = (origin - a).cross(b - a);
                    let v = q.dot(direction) / determinant;
                    let t = q.dot(c - a) / determinant;
                    (u >= 0.0 && v >= 0.0 && u + v <= 1.0 && t >= 0.0).then_some(t)
                })
                .collect();
            expected.sort_by(f64::total_cmp);
            let hits: Vec<f64> = surface.all_hits(origin, direction).iter().map(|hit| hit.t).collect();
            assert_eq!(hits.len(), expected.len());
            for (t, expected) in hits.iter().zip(&expected) {
                assert!((t - expected).abs() < 1e-9 * scale.max(1.0));
            }
            let first = surface.first_hit(origin, direction, f64::INFINITY);
            assert_eq!(first.map(|hit| hit.t), hits.first().copied());
            if let Some(hit) = first {
                let [a, b, c] = triangles[hit.triangle].map(|vertex| positions[vertex as usize]);
                let point = a * (1.0 - hit.u - hit.v) + b * hit.u + c * hit.v;
                assert!(point.distance(origin + hit.t * direction) < 1e-9 * scale);
                assert_eq!(hit.front, (b - a).cross(c - a).dot(direction) < 0.0);
                assert_eq!(surface.first_hit(origin, direction, 0.99 * hit.t), None);
            }
        }
    }
}

#[test]
fn closest_points_agree_with_a_test_of_every_triangle() {
    let mut random = Random(5);
    for scale in [1e-3, 1.0, 1e3] {
        let (positions, triangles) = sphere();
        let positions: Vec<DVec3> = positions.iter().map(|&p| p * scale).collect();
        let surface = Surface::new(&positions, &triangles);
        for _ in 0..500 {
            let p = random.point() * 1.5 * scale;
            let closest = surface.closest_point(p).unwrap();
            let corners = |t: &[u32; 3]| t.map(|vertex| positions[vertex as usize]);
            let expected = triangles
                .iter()
                .map(|t| p.distance(closest_on_triangle(p, &corners(t)).0))
                .fold(f64::INFINITY, f64::min);
            assert!((closest.distance - expected).abs() < 1e-12 * scale);
            let [a, b, c] = corners(&triangles[closest.triangle]);
            let [u, v, w] = closest.barycentric;
            assert!((a * u + b * v + c * w).distance(closest.point) < 1e-12 * scale);
            assert!((closest.point.distance(p) - closest.distance).abs() < 1e-12 * scale);
            assert!(surface.is_within(p, 1.001 * expected) && !surface.is_within(p, 0.999 * expected));
            let mut found = Vec::new();
            surface.points_within(p, 1.5 * expected, &mut found);
            let distances = triangles.iter().map(|t| p.distance(closest_on_triangle(p, &corners(t)).0));
            assert_eq!(found.len(), distances.filter(|&distance| distance <= 1.5 * expected).count());
            assert!(u.min(v).min(w) >= -1e-15 && (u + v + w - 1.0).abs() < 1e-12);
        }
    }
}

#[test]
fn a_ray_through_edges_and_vertices_enters_once_and_leaves_once() {
    let (positions, triangles) = sphere();
    let surface = Surface::new(&positions, &triangles);
    for direction in [DVec3::X, DVec3::Y, DVec3::Z, DVec3::new(0.0, 0.3, -1.0)] {
        let hits = surface.all_hits(-3.0 * direction, direction);
        assert_eq!(hits.len(), 2, "{direction}");
        assert!(hits[0].front && !hits[1].front);
    }
}

#[test]
fn a_line_leaves_a_closed_mesh_as_often_as_it_enters() {
    let mut random = Random(11);
    for (positions, triangles) in [sphere(), cube(), capsule()].into_iter().chain(real_body()) {
        let surface = Surface::new(&positions, &triangles);
        for ray in 0..20_000 {
            let mut through = random.point();
            let mut direction = random.point();
            match ray % 4 {
                0 => (through.x, direction.x) = (0.0, 0.0),
                1 => through = positions[(random.next() * positions.len() as f64) as usize],
                2 => {
                    let [a, b, _] = triangles[(random.next() * triangles.len() as f64) as usize];
                    through = positions[a as usize].lerp(positions[b as usize], random.next());
                }
                _ => {}
            }
            let hits = surface.all_hits(through - 10.0 * direction.normalize(), direction);
            let entered = hits.iter().filter(|hit| hit.front).count();
            assert_eq!(2 * entered, hits.len(), "{through} {direction} {hits:?}");
        }
    }
}

#[test]
fn an_empty_or_degenerate_surface_meets_nothing() {
    let p = [DVec3::ZERO, DVec3::X, 2.0 * DVec3::X, DVec3::Y, DVec3::NAN];
    for triangles in [vec![], vec![[0, 1, 2]], vec![[0, 0, 3]], vec![[0, 1, 4]]] {
        let surface = Surface::new(&p, &triangles);
        assert!(surface.is_empty());
        assert_eq!(surface.first_hit(DVec3::ZERO, DVec3::X, 10.0), None);
        assert!(surface.all_hits(DVec3::ZERO, DVec3::X).is_empty());
        assert_eq!(surface.closest_point(DVec3::ZERO), None);
    }
    let surface = Surface::new(&p, &[[0, 1, 2], [0, 1, 3], [1, 2, 4]]);
    assert_eq!(surface.triangle_count(), 1);
    let hit = surface.first_hit(DVec3::new(0.25, 0.25, 1.0), DVec3::NEG_Z, 10.0);
    assert_eq!(hit.map(|hit| (hit.triangle, hit.t)), Some((1, 1.0)));
    assert_eq!(surface.first_hit(DVec3::new(0.25, 0.25, 1.0), DVec3::ZERO, 10.0), None);
}

#[test]
fn a_tree_that_stays_finds_what_a_new_one_finds() {
    let mut random = Random(5);
    let (mut positions, triangles) = turned(-1.0, &[(0.5, -0.6), (0.8, 0.0), (0.4, 0.7)], 1.0, 24);
    let tree = Tree::of(&Surface::for_many(&positions, &triangles), triangles.len());
    for _ in 0..4 {
        for p in &mut positions {
            *p = 1.3 * *p + 0.1 * random.point();
        }
        let new = Surface::new(&positions, &triangles);
        let moved = Surface::with_tree(&positions, &triangles, &tree);
        assert_eq!(moved.triangle_count(), new.triangle_count());
        for index in 0..300 {
            let (p, direction) = (3.0 * random.point(), random.point());
            assert_eq!(moved.all_hits(p, direction), new.all_hits(p, direction));
            let wanted = new.closest_point(p);
            for guess in [None, Some(index % triangles.len() as u32), Some(u32::MAX)] {
                assert_eq!(moved.closest_point_near(p, guess, &tree), wanted);
            }
        }
    }
    // A triangle without area, and one that has some again.
    positions[1] = positions[2];
    for (from, to) in [(0, 1), (1, 0)] {
        let mut other = positions.clone();
        other[1] += DVec3::Y * f64::from(from);
        let tree = Tree::of(&Surface::new(&other, &triangles), triangles.len());
        other[1] = positions[1] + DVec3::Y * f64::from(to);
        let (new, moved) = (Surface::new(&other, &triangles), Surface::with_tree(&other, &triangles, &tree));
        assert_eq!(moved.triangle_count(), new.triangle_count());
        let p = DVec3::new(0.3, -2.0, 0.1);
        assert_eq!(moved.closest_point_near(p, Some(3), &tree), new.closest_point(p));
    }
    let nothing = Tree::of(&Surface::default(), 0);
    assert!(Surface::with_tree(&[], &[], &nothing).is_empty());
}
