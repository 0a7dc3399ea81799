//! Cloth weights from the body below.

#[path = "common/models.rs"]
mod models;
#[path = "common/people.rs"]
mod people;

use glam::DVec3;
use models::{model, style_of};
use people::Person;
use std::collections::HashMap;
use std::sync::Arc;
use superdeform::internals::geometry::Surface;
use superdeform::internals::rig::transfer::{GarmentOnSkin, Skin, Source, rigid_weights};
use superdeform::internals::rig::{UnitFigure, WeightSet};
use superdeform::{Character, Deformer, GarmentWeights, MeshKind, Options, Role, Weights};

/// A character laid out, with the body's skin and weights.
struct Dressed {
    figure: UnitFigure,
    skin: Skin,
    triangles: Vec<[u32; 3]>,
    weights: Weights,
}

/// Weights of a garment after those of the body under it.
fn transfer_weights(
    source: &Source,
    positions: &[DVec3],
    triangles: &[[u32; 3]],
    manner: GarmentWeights,
    threads: usize,
) -> WeightSet {
    GarmentOnSkin::new(source.skin, source.triangles, (positions, triangles), manner, threads)
        .weights(source, threads)
}

impl Dressed {
    /// `character` looks along z.
    fn new(character: &Character) -> Self {
        let figure = UnitFigure::of(character, DVec3::Z).unwrap();
        let triangles = figure.triangles_where(|mesh| figure.kinds[mesh] == Some(MeshKind::Body));
        let skin = Skin::new(&figure.positions, &triangles);
        let weights = Weights::from_rows(
            character.meshes.iter().flat_map(|mesh| mesh.weights.rows().map(|row| row.iter().copied())),
        );
        Self { figure, skin, triangles, weights }
    }

    fn source(&self) -> Source<'_> {
        Source {
            skin: &self.skin,
            positions: &self.figure.positions,
            triangles: &self.triangles,
            weights: &self.weights,
        }
    }

    /// Positions and triangles of one mesh.
    fn mesh(&self, mesh: usize) -> Shape {
        let vertices = self.figure.vertices(mesh);
        let start = vertices.start as u32;
        let triangles = self.figure.triangles_of(mesh);
        (
            self.figure.positions[vertices].to_vec(),
            triangles.iter().map(|corners| corners.map(|v| v - start)).collect(),
        )
    }

    fn transfer(&self, mesh: usize, manner: GarmentWeights, threads: usize) -> WeightSet {
        let (positions, triangles) = self.mesh(mesh);
        transfer_weights(&self.source(), &positions, &triangles, manner, threads)
    }

    fn garments(&self) -> Vec<usize> {
        (0..self.figure.mesh_count()).filter(|&m| self.figure.kinds[m] == Some(MeshKind::Garment)).collect()
    }
}

/// For each garment vertex whether it lies behind the closest body point by its normal, deeper than 1e-3 H and less
/// than 0.02 H.
fn inside(character: &Character, positions: &[Vec<DVec3>], height: f64) -> Vec<bool> {
    let mut points = Vec::new();
    let mut triangles = Vec::new();
    for (mesh, positions) in character.meshes.iter().zip(positions) {
        if mesh.kind == Some(MeshKind::Body) {
            let start = points.len() as u32;
            points.extend(positions.iter().copied());
            triangles.extend(mesh.triangles.iter().map(|corners| corners.map(|v| v + start)));
        }
    }
    let surface = Surface::new(&points, &triangles);
    let mut result = Vec::new();
    for (mesh, positions) in character.meshes.iter().zip(positions) {
        if mesh.kind == Some(MeshKind::Garment) {
            result.extend(positions.iter().map(|&p| {
                let near = surface.closest_point(p).unwrap();
                let [a, b, c] = triangles[near.triangle].map(|v| points[v as usize]);
                let behind = (p - near.point).dot((b - a).cross(c - a)) < 0.0;
                behind && (1e-3..0.02).contains(&(near.distance / height))
            }));
        }
    }
    result
}

const MANNERS: [GarmentWeights; 2] = [GarmentWeights::Nearest, GarmentWeights::Robust];

/// The share of garment vertices that a deformation puts inside the body, where garments have the weights that `manner`
/// gives, or their own.
fn newly_inside(character: &Character, manner: Option<GarmentWeights>) -> f64 {
    let options = Options::default();
    let dressed = Dressed::new(character);
    let mut character = character.clone();
    if let Some(manner) = manner {
        for garment in dressed.garments() {
            character.meshes[garment].weights = dressed.transfer(garment, manner, 0).weights;
        }
    }
    let style = style_of("kaykit_rogue.glb", &options);
    let deformer = Deformer::new(Arc::new(character.clone()), &style, &options).unwrap();
    let deformed = deformer.apply();
    let height = deformer.target().figure.height();
    let points = |positions: &[glam::Vec3]| positions.iter().map(|p| p.as_dvec3()).collect::<Vec<_>>();
    let before: Vec<_> = character.meshes.iter().map(|mesh| points(&mesh.positions)).collect();
    let after: Vec<_> = deformed.meshes.iter().map(|mesh| points(&mesh.positions)).collect();
    let (was, is) = (inside(&character, &before, height), inside(&character, &after, height));
    let newly = was.iter().zip(&is).filter(|&(&was, &is)| is && !was).count();
    newly as f64 / was.len() as f64
}

#[test]
fn skirt_and_tights_stay_outside_the_body() {
    let (Some(target), Some(_)) = (model("makehuman_female_rigged.glb"), model("kaykit_rogue.glb")) else {
        println!("left out: the models are not there");
        return;
    };
    println!("newly inside with their own weights: {:.4}", newly_inside(&target.character, None));
    for manner in MANNERS {
        let share = newly_inside(&target.character, Some(manner));
        println!("newly inside, {manner:?}: {share:.4}");
        assert!(share <= 0.03, "{manner:?}: {share}");
    }
}

/// Positions and triangles.
type Shape = (Vec<DVec3>, Vec<[u32; 3]>);

/// A grid of `columns` x `rows` squares over x from `x.0` to `x.1` and z from -0.1 to 0.1 at height `y`.
fn grid(x: (f64, f64), y: f64, columns: u32, rows: u32) -> Shape {
    let mut positions = Vec::new();
    let mut triangles = Vec::new();
    for row in 0..=rows {
        for column in 0..=columns {
            let along = f64::from(column) / f64::from(columns);
            let across = f64::from(row) / f64::from(rows);
            positions.push(DVec3::new(x.0 + along * (x.1 - x.0), y, -0.1 + 0.2 * across));
            if row < rows && column < columns {
                let corner = row * (columns + 1) + column;
                let above = corner + columns + 1;
                triangles.extend([[corner, above, corner + 1], [corner + 1, above, above + 1]]);
            }
        }
    }
    (positions, triangles)
}

fn joined(one: Shape, other: Shape) -> Shape {
    let (mut positions, mut triangles) = one;
    let start = positions.len() as u32;
    positions.extend(other.0);
    triangles.extend(other.1.iter().map(|corners| corners.map(|vertex| vertex + start)));
    (positions, triangles)
}

fn weight(made: &WeightSet, vertex: usize, joint: u32) -> f64 {
    made.weights.row(vertex).iter().filter(|entry| entry.0 == joint).map(|entry| f64::from(entry.1)).sum()
}

/// Transfers from a body of two joints whose weight to joint 1 is `weight` of the position.
fn from_two_joints(
    body: &Shape,
    weight: impl Fn(DVec3) -> f64,
    garment: &Shape,
    manner: GarmentWeights,
) -> WeightSet {
    let skin = Skin::new(&body.0, &body.1);
    let rows = body.0.iter().map(|&p| [(0, 1.0 - weight(p) as f32), (1, weight(p) as f32)]);
    let weights = Weights::from_rows(rows);
    let source = Source { skin: &skin, positions: &body.0, triangles: &body.1, weights: &weights };
    transfer_weights(&source, &garment.0, &garment.1, manner, 1)
}

#[test]
fn cloth_close_to_the_body_takes_the_weights_of_the_points_below() {
    let body = grid((0.0, 1.0), 0.0, 7, 3);
    let garment = grid((0.1, 0.9), 0.01, 23, 9);
    for manner in MANNERS {
        let made = from_two_joints(&body, |p| p.x, &garment, manner);
        for (vertex, p) in garment.0.iter().enumerate() {
            assert!((weight(&made, vertex, 1) - p.x).abs() < 1e-6, "{manner:?} {p}");
        }
        assert!(made.fallback.is_empty());
    }
}

/// Cloth over a gap of length 1 between two flat bodies.
fn over_a_gap() -> (Shape, Shape) {
    let body = joined(grid((-0.5, 0.0), 0.0, 10, 4), grid((1.0, 1.5), 0.0, 10, 4));
    (body, grid((-0.4, 1.4), 0.01, 180, 10))
}

#[test]
fn between_two_bodies_weights_run_straight_from_one_to_the_other() {
    let (body, garment) = over_a_gap();
    let made = from_two_joints(&body, |p| f64::from(p.x > 0.5), &garment, GarmentWeights::Robust);
    for (vertex, p) in garment.0.iter().enumerate() {
        // A harmonic function on a strip; matches reach 0.05 beyond the bodies.
        let expected = ((p.x - 0.05) / 0.9).clamp(0.0, 1.0);
        assert!((weight(&made, vertex, 1) - expected).abs() < 0.02, "{p}");
    }
    let filled = garment.0.iter().filter(|p| p.x > 0.07 && p.x < 0.93).count();
    assert!(made.fallback["inpainted"] >= filled);
}

#[test]
fn the_side_that_cloth_faces_does_not_matter() {
    let (body, garment) = over_a_gap();
    let made = from_two_joints(&body, |p| f64::from(p.x > 0.5), &garment, GarmentWeights::Robust);
    let turned: Vec<[u32; 3]> = garment.1.iter().map(|&[a, b, c]| [a, c, b]).collect();
    let both = garment.1.iter().chain(&turned).copied().collect();
    for triangles in [turned.clone(), both] {
        let other = (garment.0.clone(), triangles);
        let other = from_two_joints(&body, |p| f64::from(p.x > 0.5), &other, GarmentWeights::Robust);
        for vertex in 0..garment.0.len() {
            assert!((weight(&made, vertex, 1) - weight(&other, vertex, 1)).abs() < 1e-4);
        }
    }
}

#[test]
fn a_button_moves_as_one() {
    let body = grid((0.0, 1.0), 0.0, 7, 3);
    let garment = grid((0.1, 0.9), 0.01, 23, 9);
    let button = Person { columns: 12, ..Person::adult() };
    let mut shape = people::Shape { columns: button.columns, ..people::Shape::default() };
    shape.ellipsoid(DVec3::new(0.3, 0.02, 0.0), DVec3::splat(0.008), Role::Hips);
    let start = garment.0.len();
    let count = shape.positions.len();
    let made = from_two_joints(
        &body,
        |p| p.x,
        &joined(garment, (shape.positions, shape.triangles)),
        GarmentWeights::Robust,
    );
    assert_eq!(made.fallback["rigid_piece"], count);
    for vertex in start..start + count {
        assert_eq!(made.weights.row(vertex), made.weights.row(start));
    }
    assert!((weight(&made, start, 1) - 0.3).abs() < 0.01);
}

#[test]
fn a_piece_that_nothing_matches_follows_the_cloth_it_hangs_from() {
    let body = grid((0.0, 1.0), 0.0, 7, 3);
    let garment = grid((0.1, 0.9), 0.01, 23, 9);
    // A ruffle that stands up from the cloth, away from the body.
    let ruffle = grid((0.2, 0.6), 0.0, 20, 4);
    let stands = ruffle.0.iter().map(|p| DVec3::new(p.x, 0.15 + p.z, 0.0)).collect();
    let start = garment.0.len();
    let all = joined(garment, (stands, ruffle.1));
    let made = from_two_joints(&body, |p| p.x, &all, GarmentWeights::Robust);
    assert_eq!(made.fallback["component_without_match"], all.0.len() - start);
    for vertex in start..all.0.len() {
        let x = all.0[vertex].x;
        assert!((weight(&made, vertex, 1) - x).abs() < 0.06, "{x}: {}", weight(&made, vertex, 1));
    }
}

fn same(one: &WeightSet, other: &WeightSet) -> bool {
    one.weights == other.weights && one.fallback == other.fallback
}

/// The largest difference of a weight.
fn difference(one: &[(u32, f32)], other: &[(u32, f32)]) -> f32 {
    let of =
        |row: &[(u32, f32)], joint| row.iter().filter(|entry| entry.0 == joint).map(|e| e.1).sum::<f32>();
    let joints = one.iter().chain(other).map(|entry| entry.0);
    joints.map(|joint| (of(one, joint) - of(other, joint)).abs()).fold(0.0, f32::max)
}

fn skirts() -> Vec<Character> {
    let adult = || Person { skirt: true, columns: 24, ..Person::adult() };
    vec![
        adult().build(),
        Person { blended: true, ..adult() }.build(),
        Person { holes: true, ..adult() }.build(),
    ]
}

#[test]
fn a_symmetric_skirt_gets_symmetric_weights() {
    for character in skirts() {
        let dressed = Dressed::new(&character);
        let skirt = dressed.garments()[0];
        let (positions, _) = dressed.mesh(skirt);
        let cell = |p: DVec3| (p * 1e5).round().as_i64vec3();
        let at: HashMap<_, usize> = positions.iter().enumerate().map(|(v, &p)| (cell(p), v)).collect();
        let mirrored = |joint: u32| {
            let (role, _) = character.humanoid.iter().find(|&(_, other)| other == joint as usize).unwrap();
            character.humanoid.joint(role.mirrored()).unwrap() as u32
        };
        for manner in MANNERS {
            let made = dressed.transfer(skirt, manner, 0);
            let mut pairs = 0;
            for (vertex, &p) in positions.iter().enumerate() {
                let Some(&other) = at.get(&cell(DVec3::new(-p.x, p.y, p.z))) else { continue };
                let row: Vec<(u32, f32)> = made
                    .weights
                    .row(other)
                    .iter()
                    .map(|&(joint, weight)| (mirrored(joint), weight))
                    .collect();
                let off = difference(made.weights.row(vertex), &row);
                assert!(off <= 1e-4, "{manner:?} {p}: {off} {:?} {row:?}", made.weights.row(vertex));
                pairs += 1;
            }
            assert!(pairs > positions.len() * 9 / 10, "{pairs} pairs of {}", positions.len());
        }
    }
}

#[test]
fn any_number_of_threads_makes_the_same() {
    for character in skirts() {
        let dressed = Dressed::new(&character);
        let skirt = dressed.garments()[0];
        for manner in MANNERS {
            let alone = dressed.transfer(skirt, manner, 1);
            assert!(same(&alone, &dressed.transfer(skirt, manner, 2)));
            assert!(same(&alone, &dressed.transfer(skirt, manner, 8)));
        }
    }
}

#[test]
fn the_unit_does_not_matter() {
    for character in skirts() {
        let dressed = Dressed::new(&character);
        let skirt = dressed.garments()[0];
        for factor in [1e-3, 1e3] {
            let other = Dressed::new(&models::scaled(&character, factor));
            for manner in MANNERS {
                let (one, other) = (dressed.transfer(skirt, manner, 0), other.transfer(skirt, manner, 0));
                for (one, other) in one.weights.rows().zip(other.weights.rows()) {
                    assert!(difference(one, other) <= 1e-4, "{manner:?} x {factor}: {one:?} {other:?}");
                }
            }
        }
    }
}

#[test]
fn renumbering_the_vertices_renumbers_the_weights() {
    for character in skirts() {
        let dressed = Dressed::new(&character);
        let (positions, triangles) = dressed.mesh(dressed.garments()[0]);
        let last = positions.len() as u32 - 1;
        let reversed: Vec<DVec3> = positions.iter().rev().copied().collect();
        let turned: Vec<[u32; 3]> = triangles.iter().rev().map(|corners| corners.map(|v| last - v)).collect();
        for manner in MANNERS {
            let one = transfer_weights(&dressed.source(), &positions, &triangles, manner, 0);
            let other = transfer_weights(&dressed.source(), &reversed, &turned, manner, 0);
            for vertex in 0..positions.len() {
                let off = difference(one.weights.row(vertex), other.weights.row(last as usize - vertex));
                assert!(off <= 1e-4, "{manner:?}: {off}");
            }
        }
    }
}

#[test]
fn a_sword_does_not_bend() {
    let person = Person { blended: true, columns: 24, ..Person::adult() };
    let character = person.build();
    let dressed = Dressed::new(&character);
    let hand = character.humanoid.joint(Role::LeftHand).unwrap();
    let at = dressed.figure.to_unit(character.skeleton.joints[hand].position());
    // Blade, guard and grip, which touch; and an ear ring on either side of the head.
    let tube = |a: DVec3, b: DVec3, radius: f64| {
        let shape = people::Shape::capsule(a, b, radius);
        (shape.positions, shape.triangles)
    };
    let grip = at + DVec3::X * 0.03;
    let sword = joined(
        tube(grip - DVec3::Z * 0.05, grip + DVec3::Z * 0.05, 0.01),
        tube(grip + DVec3::Z * 0.06, grip + DVec3::Z * 0.6, 0.01),
    );
    let head = dressed
        .figure
        .to_unit(character.skeleton.joints[character.humanoid.joint(Role::Head).unwrap()].position());
    let ring = |side: f64| {
        let ear = head + DVec3::new(0.06 * side, 0.03, 0.0);
        tube(ear, ear - DVec3::Y * 0.02, 0.003)
    };
    let count = sword.0.len();
    let (positions, triangles) = joined(joined(sword, ring(1.0)), ring(-1.0));
    let made = rigid_weights(&dressed.source(), &positions, &triangles);
    assert_eq!(made.fallback["rigid_piece"], positions.len());
    let row = made.weights.row(0);
    assert!(row.len() <= 2);
    assert!(weight(&made, 0, hand as u32) > 0.5, "{row:?}");
    assert!((0..count).all(|vertex| made.weights.row(vertex) == row));
    let head = character.humanoid.joint(Role::Head).unwrap() as u32;
    assert!((count..positions.len()).all(|vertex| weight(&made, vertex, head) > 0.9));
}

#[test]
fn no_input_leaves_a_row_empty() {
    let nan = DVec3::splat(f64::NAN);
    let fan: Vec<[u32; 3]> = (2..60).map(|vertex| [0, 1, vertex]).collect();
    let spread: Vec<DVec3> =
        (0..60).map(|i| DVec3::new(f64::from(i % 7), f64::from(i % 5), f64::from(i % 3))).collect();
    let shapes: Vec<Shape> = vec![
        (vec![], vec![]),
        (vec![DVec3::ZERO], vec![]),
        (vec![DVec3::ZERO, DVec3::X, DVec3::Y], vec![[0, 1, 2]]),
        (vec![DVec3::ONE; 9], vec![[0, 1, 2], [3, 4, 5], [6, 7, 8]]),
        (vec![DVec3::ZERO, DVec3::X, DVec3::X * 2.0], vec![[0, 1, 2], [0, 0, 1], [2, 2, 2]]),
        (vec![nan, DVec3::X, DVec3::Y, DVec3::splat(f64::INFINITY)], vec![[0, 1, 2], [1, 2, 3]]),
        (
            vec![DVec3::ZERO, DVec3::X * 1e150, DVec3::Y * 1e-150, DVec3::Z * 1e300],
            vec![[0, 1, 2], [1, 2, 3]],
        ),
        (spread.clone(), fan),
        (spread.iter().map(|&p| p * 1e-3).collect(), (0..58).map(|v| [v, v + 1, v + 2]).collect()),
        grid((0.0, 1.0), 0.0, 5, 5),
        grid((0.0, 1.0), 0.6, 5, 5),
    ];
    for body in &shapes {
        let count = body.0.len();
        let sources = [
            Weights::from_rows(Vec::<Vec<(u32, f32)>>::new()),
            Weights::from_rows((0..count).map(|_| Vec::<(u32, f32)>::new())),
            Weights::from_rows(
                (0..count).map(|v| if v % 2 == 0 { vec![(3, 0.25), (1, 0.5)] } else { vec![] }),
            ),
        ];
        let skin = Skin::new(&body.0, &body.1);
        for weights in &sources {
            let source = Source { skin: &skin, positions: &body.0, triangles: &body.1, weights };
            for garment in &shapes {
                let rigid = rigid_weights(&source, &garment.0, &garment.1);
                let transferred =
                    MANNERS.map(|manner| transfer_weights(&source, &garment.0, &garment.1, manner, 2));
                for made in transferred.iter().chain([&rigid]) {
                    assert_eq!(made.weights.row_count(), garment.0.len());
                    for row in made.weights.rows() {
                        let sum: f32 = row.iter().map(|entry| entry.1).sum();
                        assert!(
                            (sum - 1.0).abs() < 1e-5 && row.iter().all(|entry| entry.1 >= 0.0),
                            "{row:?}"
                        );
                    }
                }
            }
        }
    }
}
