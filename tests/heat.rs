//! Heat weights: what analysis says of them, and that nothing is left without.

use glam::{DMat3, DVec3};
use std::collections::BTreeMap;
use superdeform::Progress;
use superdeform::internals::geometry::{Weld, weld};
use superdeform::internals::rig::heat::{HeatOptions, HeatSystem, heat_weights};
use superdeform::internals::rig::solid::{CELLS, Solid};
use superdeform::internals::rig::weight_bones::weight_bones;
use superdeform::internals::rig::{UnitFigure, WeightBone, WeightSet};

#[path = "common/models.rs"]
mod models;
#[path = "common/truth.rs"]
mod truth;

type Mesh = (Vec<DVec3>, Vec<[u32; 3]>);

fn heat(mesh: &Mesh, bones: &[WeightBone], heat: f64) -> WeightSet {
    heat_weights(&mesh.0, &mesh.1, bones, &HeatOptions { heat, thread_count: 2 })
}

fn bone(joint: u32, a: DVec3, b: DVec3) -> WeightBone {
    WeightBone { joint, segments: vec![[a, b]] }
}

/// The weight of `joint` in each row.
fn column(weighted: &WeightSet, joint: u32) -> Vec<f64> {
    let weight =
        |row: &[(u32, f32)]| row.iter().find(|entry| entry.0 == joint).map_or(0.0, |entry| entry.1.into());
    weighted.weights.rows().map(weight).collect()
}

/// Every vertex has weights between 0 and 1 that sum to 1, each joint once, and counts are of vertices.
fn check(weighted: &WeightSet, vertex_count: usize) {
    assert_eq!(weighted.weights.row_count(), vertex_count);
    for row in weighted.weights.rows() {
        let sum: f64 = row.iter().map(|&(_, weight)| f64::from(weight)).sum();
        assert!((sum - 1.0).abs() <= 1e-6, "{row:?}");
        assert!(row.iter().all(|&(_, weight)| weight > 0.0 && weight <= 1.0), "{row:?}");
        assert!(row.is_sorted_by(|a, b| a.0 < b.0), "{row:?}");
    }
    assert!(weighted.fallback.values().sum::<usize>() <= vertex_count);
}

/// The largest difference of any weight.
fn difference(one: &WeightSet, other: &WeightSet) -> f64 {
    assert_eq!(one.weights.row_count(), other.weights.row_count());
    let mut most = 0.0_f64;
    for (one, other) in one.weights.rows().zip(other.weights.rows()) {
        let mut all: BTreeMap<u32, f64> = BTreeMap::new();
        for &(joint, weight) in one {
            *all.entry(joint).or_default() += f64::from(weight);
        }
        for &(joint, weight) in other {
            *all.entry(joint).or_default() -= f64::from(weight);
        }
        most = all.values().fold(most, |most, difference| most.max(difference.abs()));
    }
    most
}

/// A tube along y from -`half_length` to `half_length`, open at both ends.
fn tube(radius: f64, half_length: f64, sides: u32, rings: u32) -> Mesh {
    let mut positions = Vec::new();
    let mut triangles = Vec::new();
    for ring in 0..=rings {
        let y = half_length * (2.0 * f64::from(ring) / f64::from(rings) - 1.0);
        for side in 0..sides {
            let angle = std::f64::consts::TAU * f64::from(side) / f64::from(sides);
            positions.push(DVec3::new(radius * angle.cos(), y, radius * angle.sin()));
            if ring > 0 {
                let next = (side + 1) % sides;
                let (below, above) = ((ring - 1) * sides, ring * sides);
                triangles.push([below + side, above + side, above + next]);
                triangles.push([below + side, above + next, below + next]);
            }
        }
    }
    (positions, triangles)
}

fn tube_bones(half_length: f64) -> [WeightBone; 2] {
    let end = half_length * DVec3::Y;
    [bone(4, DVec3::ZERO, -end), bone(7, DVec3::ZERO, end)]
}

/// A ball of `rings` rings, the same when it is mirrored at x = 0.
fn ball(centre: DVec3, radius: f64, rings: u32) -> Mesh {
    let sides = 2 * rings;
    let mut positions = vec![centre - radius * DVec3::Y, centre + radius * DVec3::Y];
    let mut triangles = Vec::new();
    for ring in 1..rings {
        let polar = std::f64::consts::PI * f64::from(ring) / f64::from(rings);
        for side in 0..sides {
            let angle = std::f64::consts::TAU * f64::from(side) / f64::from(sides);
            let (sin, cos) = polar.sin_cos();
            positions.push(centre + radius * DVec3::new(sin * angle.cos(), -cos, sin * angle.sin()));
            let at = |ring: u32, side: u32| 2 + (ring - 1) * sides + side % sides;
            if ring == 1 {
                triangles.push([0, at(1, side), at(1, side + 1)]);
            } else {
                let [a, b] = [at(ring - 1, side), at(ring - 1, side + 1)];
                let [c, d] = [at(ring, side), at(ring, side + 1)];
                // Diagonals mirror each other.
                let is_left =
                    (std::f64::consts::TAU * (f64::from(side) + 0.5) / f64::from(sides)).cos() > 0.0;
                triangles.extend(if is_left { [[a, c, d], [a, d, b]] } else { [[a, c, b], [b, c, d]] });
            }
            if ring == rings - 1 {
                triangles.push([1, at(ring, side + 1), at(ring, side)]);
            }
        }
    }
    (positions, triangles)
}

fn together(meshes: &[Mesh]) -> Mesh {
    let mut all = Mesh::default();
    for (positions, triangles) in meshes {
        let start = all.0.len() as u32;
        all.0.extend(positions);
        all.1.extend(triangles.iter().map(|corners| corners.map(|vertex| vertex + start)));
    }
    all
}

/// A symmetric figure of one piece: a rounded box with five arms, by pulling the vertices of a ball along its bones.
fn figure() -> (Mesh, Vec<WeightBone>) {
    let ways = [
        DVec3::new(1.0, 0.2, 0.0),
        DVec3::new(-1.0, 0.2, 0.0),
        DVec3::new(0.45, -1.0, 0.0),
        DVec3::new(-0.45, -1.0, 0.0),
        DVec3::Y,
    ]
    .map(DVec3::normalize);
    let (mut positions, triangles) = ball(DVec3::ZERO, 1.0, 48);
    for p in &mut positions {
        let pull: f64 = ways.iter().map(|way| 1.6 * (30.0 * (p.dot(*way) - 1.0)).exp()).sum();
        *p *= 0.25 * (1.0 + pull);
    }
    let mut bones = vec![bone(0, -0.1 * DVec3::Y, 0.1 * DVec3::Y)];
    bones.extend((1..).zip(ways).map(|(joint, way)| bone(joint, 0.15 * way, 0.6 * way)));
    ((positions, triangles), bones)
}

struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }

    fn below(&mut self, count: usize) -> usize {
        (self.next() * count as f64) as usize
    }

    fn point(&mut self) -> DVec3 {
        DVec3::new(self.next() - 0.5, self.next() - 0.5, self.next() - 0.5)
    }
}

#[test]
fn on_a_tube_the_weight_falls_off_as_analysis_says() {
    // Around the axis all is constant, so that the equation is -w'' + (c / r²) (w - p) = 0 along it.
    for (radius, half_length, sides, rings) in [
        (0.1, 1.0, 24, 160),
        (0.1, 1.0, 48, 400),
        (0.05, 0.5, 32, 200),
        (0.03, 1.0, 40, 600),
        (0.2, 2.0, 16, 120),
    ] {
        let mesh = tube(radius, half_length, sides, rings);
        let system =
            HeatSystem::new(&mesh.0, &mesh.1, &tube_bones(half_length), 2, &mut Progress::none()).unwrap();
        for c in [1.0_f64, 4.0] {
            let weighted = system.weights(c, &mut Progress::none()).unwrap();
            check(&weighted, mesh.0.len());
            assert!(weighted.fallback.is_empty());
            for (p, weight) in mesh.0.iter().zip(column(&weighted, 7)) {
                let beyond = 0.5 * (-c.sqrt() * p.y.abs() / radius).exp();
                let expected = if p.y >= 0.0 { 1.0 - beyond } else { beyond };
                assert!((weight - expected).abs() < 5e-3, "{radius} {rings} c {c} {p}: {weight} {expected}");
            }
        }
    }
}

#[test]
fn a_system_gives_what_single_calls_give() {
    let (mesh, bones) = figure();
    let system = HeatSystem::new(&mesh.0, &mesh.1, &bones, 1, &mut Progress::none()).unwrap();
    for c in [3.0, 1.0] {
        let weighted = system.weights(c, &mut Progress::none()).unwrap();
        assert!(weighted.weights == heat(&mesh, &bones, c).weights);
    }
    let (soft, sharp) = (
        system.weights(1.0, &mut Progress::none()).unwrap(),
        system.weights(3.0, &mut Progress::none()).unwrap(),
    );
    let blended =
        |weighted: &WeightSet| column(weighted, 1).iter().filter(|&&w| w > 0.05 && w < 0.95).count();
    assert!(blended(&sharp) < blended(&soft));
}

#[test]
fn the_unit_does_not_matter() {
    let (mesh, bones) = figure();
    let one = heat(&mesh, &bones, 1.0);
    check(&one, mesh.0.len());
    for scale in [1e-3, 1e3, 1e-9, 1e9] {
        for offset in [DVec3::ZERO, DVec3::new(3.0, -2.0, 1.0)] {
            let place = |p: DVec3| (p + offset) * scale;
            let scaled = (mesh.0.iter().map(|&p| place(p)).collect(), mesh.1.clone());
            let bones: Vec<WeightBone> = bones
                .iter()
                .map(|bone| WeightBone {
                    joint: bone.joint,
                    segments: bone.segments.iter().map(|ends| ends.map(place)).collect(),
                })
                .collect();
            assert!(difference(&one, &heat(&scaled, &bones, 1.0)) < 1e-4, "{scale}");
        }
    }
}

#[test]
fn order_and_winding_do_not_matter() {
    let (mesh, bones) = figure();
    let one = heat(&mesh, &bones, 1.0);
    let mut random = Random(5);
    // Vertices in another order.
    let count = mesh.0.len();
    let mut order: Vec<usize> = (0..count).collect();
    for i in (1..count).rev() {
        order.swap(i, random.below(i + 1));
    }
    let mut place = vec![0; count];
    for (new, &old) in order.iter().enumerate() {
        place[old] = new as u32;
    }
    let mut triangles: Vec<[u32; 3]> =
        mesh.1.iter().map(|corners| corners.map(|vertex| place[vertex as usize])).collect();
    // Triangles in another order, corners as well, each with any winding.
    for i in (1..triangles.len()).rev() {
        let other = random.below(i + 1);
        triangles.swap(i, other);
        let first = random.below(3);
        triangles[i].rotate_left(first);
        if random.below(2) == 0 {
            triangles[i].swap(0, 1);
        }
    }
    let shuffled = heat(&(order.iter().map(|&old| mesh.0[old]).collect(), triangles), &bones, 1.0);
    let back = WeightSet {
        weights: superdeform::Weights::from_rows(
            place.iter().map(|&new| shuffled.weights.row(new as usize).iter().copied()),
        ),
        ..WeightSet::default()
    };
    assert!(difference(&one, &back) < 1e-6);
    let flipped = mesh.1.iter().map(|&[a, b, c]| [a, c, b]).collect();
    assert!(difference(&one, &heat(&(mesh.0.clone(), flipped), &bones, 1.0)) < 1e-6);
}

#[test]
fn a_symmetric_figure_has_symmetric_weights() {
    let (mesh, bones) = figure();
    let mirror = DMat3::from_diagonal(DVec3::new(-1.0, 1.0, 1.0));
    let joints = [0, 2, 1, 4, 3, 5];
    let weighted = heat(&mesh, &bones, 1.0);
    for (vertex, &p) in mesh.0.iter().enumerate() {
        let nearest = |other: &usize| (mesh.0[*other].distance(mirror * p) * 1e12) as u64;
        let other = (0..mesh.0.len()).min_by_key(nearest).unwrap();
        assert!(mesh.0[other].distance(mirror * p) < 1e-12);
        let mut row: Vec<(u32, f32)> = weighted
            .weights
            .row(other)
            .iter()
            .map(|&(joint, weight)| (joints[joint as usize], weight))
            .collect();
        row.sort_by_key(|entry| entry.0);
        for (one, two) in weighted.weights.row(vertex).iter().zip(&row) {
            assert!(
                one.0 == two.0 && (one.1 - two.1).abs() < 1e-5,
                "{p} {:?} {row:?}",
                weighted.weights.row(vertex)
            );
        }
    }
}

#[test]
fn any_number_of_threads_gives_the_same_bits() {
    let (mesh, bones) = figure();
    let options = |thread_count| HeatOptions { heat: 1.0, thread_count };
    let alone = heat_weights(&mesh.0, &mesh.1, &bones, &options(1));
    for thread_count in [2, 3, 8] {
        let other = heat_weights(&mesh.0, &mesh.1, &bones, &options(thread_count));
        assert!(alone.weights == other.weights && alone.fallback == other.fallback, "{thread_count}");
    }
}

#[test]
fn another_component_hides_nothing() {
    // A ball between two bones, one of which lies behind a wall, which is a component of its own.
    let mesh = ball(DVec3::ZERO, 0.3, 12);
    let bones =
        [bone(0, DVec3::new(-0.5, 0.0, 0.0), DVec3::new(-0.5, 0.1, 0.0)), bone(1, DVec3::X, 2.0 * DVec3::X)];
    let wall = tube(0.4, 0.6, 24, 6);
    let alone = heat(&mesh, &bones, 1.0);
    let both = heat(&together(&[mesh.clone(), wall]), &bones, 1.0);
    for (vertex, row) in alone.weights.rows().enumerate() {
        for (one, two) in row.iter().zip(both.weights.row(vertex)) {
            assert!(one.0 == two.0 && (one.1 - two.1).abs() < 1e-5);
        }
    }
}

#[test]
fn a_hidden_bone_gives_no_heat() {
    // Two legs' tubes joined by a bridge; the left bone is nearest to part of the right tube, but behind both walls.
    let (mut positions, mut triangles) = tube(0.1, 0.5, 16, 20);
    let count = positions.len() as u32;
    let other: Vec<DVec3> = positions.iter().map(|&p| p + 0.3 * DVec3::X).collect();
    positions.extend(other);
    triangles.extend(triangles.clone().iter().map(|corners| corners.map(|vertex| vertex + count)));
    triangles.push([0, 8, count + 8]);
    triangles.push([0, count + 8, count]);
    let ends = |x: f64| (DVec3::new(x, -0.5, 0.0), DVec3::new(x, 0.5, 0.0));
    let (left, right) = (ends(0.0), ends(0.36));
    let mesh = (positions, triangles);
    let weighted = heat(&mesh, &[bone(0, left.0, left.1), bone(1, right.0, right.1)], 1.0);
    check(&weighted, mesh.0.len());
    // The right tube's near side is 0.16 from its own bone's axis and 0.2 from the left one's; its own wins. Move the
    // right bone out of its tube's middle and the near side is nearer to the left bone, which it cannot see.
    let far = ends(0.395);
    let hidden = heat(&mesh, &[bone(0, left.0, left.1), bone(1, far.0, far.1)], 1.0);
    let near_side: Vec<usize> = (count as usize..mesh.0.len())
        .filter(|&vertex| mesh.0[vertex].x < 0.2 + 1e-9 && mesh.0[vertex].y > 0.2)
        .collect();
    assert!(!near_side.is_empty());
    for vertex in near_side {
        let right: f32 =
            hidden.weights.row(vertex).iter().filter(|entry| entry.0 == 1).map(|entry| entry.1).sum();
        assert!(right > 0.9, "{}: {right}", mesh.0[vertex]);
    }
}

/// A figure's head of radius 0.25, and arms held out 0.05 below it, in capsules' stead one bone each.
fn head_over_arms() -> (Mesh, Vec<WeightBone>) {
    let head = ball(0.72 * DVec3::Y, 0.25, 16);
    let arm = |side: f64| (DVec3::new(0.1 * side, 0.42, 0.0), DVec3::new(0.5 * side, 0.42, 0.0));
    let bones = vec![
        bone(0, DVec3::new(0.0, 0.55, 0.0), DVec3::new(0.0, 0.95, 0.0)),
        bone(1, arm(1.0).0, arm(1.0).1),
        bone(2, arm(-1.0).0, arm(-1.0).1),
    ];
    (head, bones)
}

/// The share of vertices of which arms have more than 0.3.
fn stuck_to_arms(weighted: &WeightSet) -> f64 {
    let arms = column(weighted, 1).into_iter().zip(column(weighted, 2));
    let count = weighted.weights.row_count() as f64;
    arms.filter(|(left, right)| left + right > 0.3).count() as f64 / count
}

#[test]
fn a_head_does_not_stick_to_the_arms_below_it() {
    let (head, bones) = head_over_arms();
    // All of the head is around its own bone, and the arms are outside.
    let stuck = stuck_to_arms(&heat(&head, &bones, 1.0));
    assert!(stuck < 0.02, "{stuck:.3}");
    // Every triangle there twice, once either way round: nothing tells the outside, but air lies below the head.
    let mut doubled = head.clone();
    doubled.1.extend(head.1.iter().map(|&[a, b, c]| [a, c, b]));
    let solid = Solid::new(&head.0, &head.1, |_| true, 0.0, CELLS).unwrap();
    let none = &mut Progress::none();
    let system =
        HeatSystem::in_body(&doubled.0, &doubled.1, &bones, (Some(&solid), &Vec::new), 1, none).unwrap();
    let stuck = stuck_to_arms(&system.weights(1.0, none).unwrap());
    assert!(stuck < 0.02, "{stuck:.3}");
}

#[test]
fn the_end_of_an_arm_within_the_trunk_moves_with_the_arm() {
    // A closed tube along y whose lower end is nearer to the trunk's bone, across its way, than to its own.
    let (mut positions, mut triangles) = tube(0.1, 0.5, 24, 40);
    let last = positions.len() as u32 - 24;
    for (y, ring) in [(-0.5, 0), (0.5, last)] {
        let middle = positions.len() as u32;
        assert!((positions[ring as usize].y - y).abs() < 1e-12, "{y}");
        positions.push(y * DVec3::Y);
        triangles.extend((0..24).map(|side| [ring + side, ring + (side + 1) % 24, middle]));
    }
    let arm = bone(0, DVec3::new(0.0, -0.3, 0.0), DVec3::new(0.0, 0.5, 0.0));
    let trunk = bone(1, DVec3::new(-0.3, -0.55, 0.0), DVec3::new(0.3, -0.55, 0.0));
    let weighted = heat(&(positions.clone(), triangles), &[arm, trunk], 1.0);
    check(&weighted, positions.len());
    for (p, weight) in positions.iter().zip(column(&weighted, 0)) {
        assert!(weight > 0.9, "{p}: {weight}");
    }
}

#[test]
fn coincident_bones_share_alike() {
    let mesh = tube(0.1, 1.0, 24, 400);
    let end = DVec3::Y;
    let mut bones = vec![bone(1, DVec3::ZERO, end), bone(2, DVec3::ZERO, end), bone(3, end, DVec3::ZERO)];
    bones.push(bone(0, DVec3::ZERO, -end));
    let weighted = heat(&mesh, &bones, 1.0);
    check(&weighted, mesh.0.len());
    let columns: Vec<Vec<f64>> = (1..4).map(|joint| column(&weighted, joint)).collect();
    for other in &columns[1..] {
        assert!(columns[0].iter().zip(other).all(|(one, other)| (one - other).abs() < 1e-6));
    }
    assert!((columns[0].last().unwrap() - 1.0 / 3.0).abs() < 5e-3);
    // Three bones warm their side three times as much, so that the weight falls off √3 times as fast there; at the
    // joint it and its slope are continuous.
    let root = 3.0_f64.sqrt();
    let at_joint = 1.0 / (1.0 + root);
    for (p, weight) in mesh.0.iter().zip(column(&weighted, 0)) {
        let s = p.y / 0.1;
        let expected = if s > 0.0 { at_joint * (-root * s).exp() } else { 1.0 - (1.0 - at_joint) * s.exp() };
        assert!((weight - expected).abs() < 1e-2, "{p}: {weight} {expected}");
    }
}

#[test]
fn bones_without_length_or_of_one_joint_are_bones() {
    let mesh = tube(0.1, 0.5, 16, 40);
    let points: Vec<WeightBone> =
        [-0.4, 0.0, 0.4].iter().map(|&y| bone(3, y * DVec3::Y, y * DVec3::Y)).collect();
    let weighted = heat(&mesh, &points, 1.0);
    check(&weighted, mesh.0.len());
    assert!(weighted.weights.rows().all(|row| row == [(3, 1.0)]));
    // Inside a vertex, and on the surface.
    let on: Vec<WeightBone> =
        (0..5).map(|joint| bone(joint, mesh.0[joint as usize * 100], mesh.0[joint as usize * 100])).collect();
    check(&heat(&mesh, &on, 1.0), mesh.0.len());
}

#[test]
fn whatever_the_mesh_every_vertex_has_weights() {
    let bones = [
        bone(2, DVec3::ZERO, 0.5 * DVec3::Y),
        bone(5, 0.5 * DVec3::Y, DVec3::Y),
        bone(9, DVec3::X, DVec3::X),
    ];
    let p = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
    let mut random = Random(3);
    let soup: Vec<DVec3> = (0..300).map(|_| random.point()).collect();
    let thousand = |triangles: &mut Random| -> Vec<[u32; 3]> {
        (0..1000).map(|_| [0; 3].map(|_: i32| triangles.below(300) as u32)).collect()
    };
    let meshes: Vec<Mesh> = vec![
        (vec![], vec![]),
        (p.to_vec(), vec![]),
        (p.to_vec(), vec![[0, 1, 2]]),
        (p.to_vec(), vec![[0, 0, 0], [1, 1, 2]]),
        (p.to_vec(), vec![[0, 1, 2], [0, 1, 2], [2, 1, 0]]),
        (p.to_vec(), vec![[0, 1, 7]]),
        (vec![DVec3::splat(3.0); 50], (0..48).map(|i| [i, i + 1, i + 2]).collect()),
        ((0..50).map(|i| f64::from(i) * DVec3::X).collect(), (0..48).map(|i| [i, i + 1, i + 2]).collect()),
        // Needles and caps down to no height.
        (
            (0..60)
                .flat_map(|i| {
                    let height = 10f64.powi(-i / 3);
                    [
                        DVec3::X * f64::from(i),
                        DVec3::X * (f64::from(i) + 1.0),
                        DVec3::new(f64::from(i) + 0.5, height, 0.0),
                    ]
                })
                .collect(),
            (0..60).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect(),
        ),
        // Components down to no size, beside a large one.
        together(&(0..20).map(|i| ball(f64::from(i) * DVec3::X, 10f64.powi(-i), 4)).collect::<Vec<_>>()),
        (soup.clone(), thousand(&mut random)),
        (soup.iter().map(|p| p * DVec3::new(1.0, 1e-7, 1.0)).collect(), thousand(&mut random)),
        (soup.iter().map(|p| (p * 3.0).round()).collect(), thousand(&mut random)),
        (vec![DVec3::MAX, DVec3::MIN, DVec3::ZERO], vec![[0, 1, 2]]),
        (vec![DVec3::splat(1e-300), DVec3::X * 1e-300, DVec3::ZERO], vec![[0, 1, 2]]),
    ];
    for (index, mesh) in meshes.iter().enumerate() {
        for c in [1.0, 3.0, 0.0, -1.0, f64::NAN, f64::INFINITY, 1e-30, 1e30] {
            check(&heat(mesh, &bones, c), mesh.0.len());
        }
        for bones in [vec![], vec![WeightBone { joint: 3, segments: vec![] }]] {
            let weighted = heat(mesh, &bones, 1.0);
            check(&weighted, mesh.0.len());
            assert_eq!(weighted.fallback.values().sum::<usize>(), mesh.0.len(), "mesh {index}");
        }
        let far = [bone(0, 1e9 * DVec3::X, 1e9 * DVec3::Y), bone(1, DVec3::MAX, DVec3::MIN)];
        check(&heat(mesh, &far, 1.0), mesh.0.len());
    }
}

#[test]
fn what_the_equation_has_no_answer_for_is_counted() {
    let (mut mesh, bones) = figure();
    let count = mesh.0.len();
    // In no triangle; in one without an area; in a component that is hardly there.
    mesh.0.push(DVec3::new(0.6, 0.1, 0.0));
    mesh.0.extend([DVec3::Y, 1.1 * DVec3::Y, 1.2 * DVec3::Y]);
    mesh.1.push([count as u32 + 1, count as u32 + 2, count as u32 + 3]);
    let speck = DVec3::new(0.6, 0.3, 0.0);
    mesh.0.extend([speck, speck + 4e-6 * DVec3::X, speck + 4e-6 * DVec3::Z]);
    mesh.1.push([count as u32 + 4, count as u32 + 5, count as u32 + 6]);
    let weighted = heat(&mesh, &bones, 1.0);
    check(&weighted, mesh.0.len());
    let counts = BTreeMap::from([("vertex_without_triangle", 4), ("component_too_small", 3)]);
    assert_eq!(weighted.fallback, counts);
    assert_eq!(weighted.weights.row(count + 5), [(1, 1.0)]);
    assert_eq!(weighted.weights.row(count), [(1, 1.0)]);
    assert_eq!(weighted.weights.row(count + 3), [(5, 1.0)]);
}

#[test]
fn a_component_that_sees_no_bone_takes_the_nearest() {
    // A crate of six plates that reach beyond each other's planes: from no corner is the middle seen.
    let mut crate_of_plates = Mesh::default();
    for axis in 0..3 {
        for side in [-1.0, 1.0] {
            let start = crate_of_plates.0.len() as u32;
            for [u, v] in [[-3.0, -3.0], [3.0, -3.0], [3.0, 3.0], [-3.0, 3.0]] {
                let mut corner = DVec3::ZERO;
                corner[axis] = side;
                corner[(axis + 1) % 3] = u;
                corner[(axis + 2) % 3] = v;
                crate_of_plates.0.push(corner);
            }
            crate_of_plates.1.extend([[start, start + 1, start + 2], [start, start + 2, start + 3]]);
            if start > 0 {
                crate_of_plates.1.push([start, start - 4, start - 3]);
            }
        }
    }
    let middle = bone(3, DVec3::ZERO, DVec3::ZERO);
    let weighted = heat(&crate_of_plates, &[middle.clone(), bone(4, 50.0 * DVec3::X, 60.0 * DVec3::X)], 1.0);
    check(&weighted, 24);
    assert_eq!(weighted.fallback, BTreeMap::from([("component_without_visible_bone", 24)]));
    assert!(weighted.weights.rows().all(|row| row == [(3, 1.0)]));
    // Plates that are components of their own hide nothing from each other.
    crate_of_plates.1.retain(|&[a, b, _]| a < b);
    assert!(heat(&crate_of_plates, &[middle], 1.0).fallback.is_empty());
}

#[test]
fn patchwork_and_bad_edges_are_weighted() {
    let (mesh, bones) = figure();
    let one = heat(&mesh, &bones, 1.0);
    // Twenty open shells: triangles by the angle around the figure, each with vertices of its own, slightly apart.
    let mut patches: Vec<Mesh> = vec![Mesh::default(); 20];
    for corners in &mesh.1 {
        let middle = corners.iter().map(|&vertex| mesh.0[vertex as usize]).sum::<DVec3>() / 3.0;
        let turn = (middle.z.atan2(middle.x) / std::f64::consts::TAU + 0.5).clamp(0.0, 0.999);
        let patch = (turn * 10.0) as usize + if middle.y > 0.0 { 10 } else { 0 };
        let (positions, triangles) = &mut patches[patch];
        let start = positions.len() as u32;
        positions.extend(corners.map(|vertex| mesh.0[vertex as usize] * (1.0 + 1e-3 * patch as f64)));
        triangles.push([start, start + 1, start + 2]);
    }
    let patchwork = together(&patches);
    let weighted = heat(&patchwork, &bones, 1.0);
    check(&weighted, patchwork.0.len());
    let welded: Weld = weld(&patchwork.0, 1e-9);
    assert!(welded.count < patchwork.0.len() / 3);

    // A thousand edges with a third triangle, a fin to the outside.
    let mut finned = mesh.clone();
    for edge in 0..1000 {
        let [a, b, _] = mesh.1[edge * mesh.1.len() / 1000];
        let tip = mesh.0[a as usize].lerp(mesh.0[b as usize], 0.5) * 1.02;
        finned.1.push([a, b, finned.0.len() as u32]);
        finned.0.push(tip);
    }
    let weighted = heat(&finned, &bones, 1.0);
    check(&weighted, finned.0.len());
    assert!(weighted.fallback.is_empty());
    // Fins leave the rest nearly as it was.
    let body = WeightSet {
        weights: superdeform::Weights::from_rows(
            (0..mesh.0.len()).map(|vertex| weighted.weights.row(vertex).iter().copied()),
        ),
        ..WeightSet::default()
    };
    assert!(difference(&one, &body) < 0.1, "{}", difference(&one, &body));
}

#[test]
fn seams_do_not_matter() {
    let (mesh, bones) = figure();
    let one = heat(&mesh, &bones, 1.0);
    // Every triangle with vertices of its own.
    let torn: Mesh = (
        mesh.1.iter().flatten().map(|&vertex| mesh.0[vertex as usize]).collect(),
        (0..mesh.1.len() as u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect(),
    );
    let weighted = heat(&torn, &bones, 1.0);
    assert!(weighted.fallback.is_empty());
    let expected = WeightSet {
        weights: superdeform::Weights::from_rows(
            mesh.1.iter().flatten().map(|&vertex| one.weights.row(vertex as usize).iter().copied()),
        ),
        ..WeightSet::default()
    };
    assert!(difference(&weighted, &expected) < 1e-6);
}

#[test]
fn a_million_triangles_are_weighted() {
    let mesh = tube(0.1, 1.0, 500, 1000);
    assert_eq!(mesh.1.len(), 1_000_000);
    let weighted = heat(&mesh, &tube_bones(1.0), 1.0);
    check(&weighted, mesh.0.len());
    for (p, weight) in mesh.0.iter().zip(column(&weighted, 7)) {
        let beyond = 0.5 * (-p.y.abs() / 0.1).exp();
        let expected = if p.y >= 0.0 { 1.0 - beyond } else { beyond };
        assert!((weight - expected).abs() < 5e-3, "{p}: {weight} {expected}");
    }
}

#[test]
fn real_characters_are_weighted_whole() {
    for case in truth::cases() {
        let figure = UnitFigure::of(&case.character, case.forward).unwrap();
        let joints: BTreeMap<_, _> =
            case.joints.iter().map(|(&role, &at)| (role, figure.to_unit(at))).collect();
        let bones = weight_bones(&joints, &BTreeMap::new(), None);
        let weighted = heat(&(figure.positions.clone(), figure.triangles.clone()), &bones, 1.0);
        check(&weighted, figure.positions.len());
        println!("{:45} {:6} vertices {:?}", case.name, figure.positions.len(), weighted.fallback);
        assert!(!weighted.fallback.contains_key("system_raised"), "{}", case.name);
        assert!(!weighted.fallback.contains_key("vertex_without_heat"), "{}", case.name);
    }
}
