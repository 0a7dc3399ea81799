//! Laws of the auto-rig, on people without one.

use glam::{DMat3, DQuat, DVec3};
use people::{ADULT, Person, Proportions};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;
use std::collections::BTreeMap;
use superdeform::{Axes, Character, Humanoid, MeshKind, Rig, RigOptions, Role, Skeleton, Weights};

#[path = "../common/people.rs"]
mod people;

/// What rounding to 32 bits may change, in heights.
const CLOSE: f64 = 1e-4;

/// Few cases, the same ones on every run; `PROPTEST_RNG_SEED` draws others.
fn few() -> ProptestConfig {
    let mut config = ProptestConfig {
        cases: 8,
        failure_persistence: None,
        max_shrink_iters: 16,
        ..ProptestConfig::default()
    };
    if config.rng_seed == RngSeed::Random {
        config.rng_seed = RngSeed::Fixed(0);
    }
    config
}

/// Anyone built about like an adult, arms at any angle from T-pose to A-pose.
fn people() -> impl Strategy<Value = Person> {
    let build = (0.85..1.2f64, 0.85..1.2f64, 0.85..1.2f64, 0.8..1.2f64);
    (build, 0.0..60.0f64, any::<[bool; 2]>()).prop_map(
        |((trunk, arms, legs, girth), arm_angle, [skirt, holes])| {
            let p = ADULT;
            Person {
                proportions: Proportions {
                    torso: trunk * p.torso,
                    upper_arm: arms * p.upper_arm,
                    lower_arm: arms * p.lower_arm,
                    upper_leg: legs * p.upper_leg,
                    lower_leg: legs * p.lower_leg,
                    upper_arm_radius: girth * p.upper_arm_radius,
                    lower_arm_radius: girth * p.lower_arm_radius,
                    ..p
                },
                arm_angle,
                skirt,
                holes,
                blended: true,
                columns: 12,
                ..Person::default()
            }
        },
    )
}

/// The meshes alone, looking along z, with every kind known.
fn bare(person: &Person) -> Character {
    let mut character = person.build();
    character.skeleton = Skeleton::default();
    character.humanoid = Humanoid::default();
    character.axes = Axes { forward: Some(glam::Vec3::Z), up_is_known: true, ..Axes::default() };
    for mesh in &mut character.meshes {
        mesh.weights = Weights::default();
        mesh.normals.clear();
    }
    character
}

fn rig(character: &Character) -> Rig {
    Rig::of(character, &RigOptions { thread_count: 1, ..RigOptions::default() }).unwrap()
}

fn joints(rig: &Rig) -> BTreeMap<Role, DVec3> {
    rig.humanoid.iter().map(|(role, joint)| (role, rig.skeleton.joints[joint].position())).collect()
}

/// Every point at another place.
fn placed(character: &Character, place: impl Fn(DVec3) -> DVec3) -> Character {
    let mut character = character.clone();
    for p in character.meshes.iter_mut().flat_map(|mesh| &mut mesh.positions) {
        *p = place(p.as_dvec3()).as_vec3();
    }
    character
}

/// The furthest that a joint is from where `place` takes its counterpart, in units of `height`; infinite where roles
/// differ.
fn off(
    one: &BTreeMap<Role, DVec3>,
    other: &BTreeMap<Role, DVec3>,
    height: f64,
    place: impl Fn(DVec3) -> DVec3,
) -> f64 {
    if !one.keys().eq(other.keys()) {
        return f64::INFINITY;
    }
    let apart: Vec<(f64, Role)> =
        one.iter().map(|(&role, &at)| (place(at).distance(other[&role]) / height, role)).collect();
    let far: Vec<String> =
        apart.iter().filter(|(off, _)| *off > CLOSE).map(|(off, role)| format!("{role} {off:.1e}")).collect();
    if !far.is_empty() {
        println!("{}", far.join(", "));
    }
    apart.into_iter().map(|(off, _)| off).fold(0.0, f64::max)
}

/// The greatest difference between two weights of one vertex to one joint.
fn heavier(one: &[Weights], other: &[Weights]) -> f32 {
    let mut most = 0.0f32;
    for (a, b) in one.iter().zip(other).flat_map(|(one, other)| one.rows().zip(other.rows())) {
        let at = |row: &[(u32, f32)], joint: u32| {
            row.iter().filter(|entry| entry.0 == joint).map(|entry| entry.1).sum::<f32>()
        };
        for &(joint, _) in a.iter().chain(b) {
            most = most.max((at(a, joint) - at(b, joint)).abs());
        }
    }
    most
}

fn shuffled(count: usize, seed: u64) -> Vec<usize> {
    let mut order: Vec<usize> = (0..count).collect();
    // A bijection of 64 bits as sorting key.
    order.sort_by_key(|&index| (index as u64 ^ seed).wrapping_mul(0x9E37_79B9_7F4A_7C15).rotate_left(17));
    order
}

proptest! {
    #![proptest_config(few())]

    #[test]
    fn moving_the_person_moves_the_rig(person in people(), turn in any::<[i8; 4]>(), shift in any::<[i8; 3]>()) {
        let [x, y, z, w] = turn.map(f64::from);
        let turn = DMat3::from_quat(DQuat::from_xyzw(x, y, z, w + 0.5).normalize());
        let shift = DVec3::from_array(shift.map(|x| f64::from(x) / 64.0));
        let still = bare(&person);
        let mut moved = placed(&still, |p| turn * p + shift);
        moved.axes = Axes { up: (turn * DVec3::Y).as_vec3(), up_is_known: true, forward: Some((turn * DVec3::Z).as_vec3()) };
        let (one, other) = (rig(&still), rig(&moved));
        let off = off(&joints(&one), &joints(&other), person.crown(), |p| turn * p + shift);
        prop_assert!(off < CLOSE, "{off:.1e} H");
        let heavier = heavier(&one.weights, &other.weights);
        prop_assert!(heavier < 0.01, "weights differ by {heavier}");
    }

    #[test]
    fn the_unit_of_the_person_is_the_unit_of_the_rig(person in people(), power in -3.0..3.0f64) {
        let scale = 10f64.powf(power);
        let plain = bare(&person);
        let (one, other) = (rig(&plain), rig(&placed(&plain, |p| p * scale)));
        let off = off(&joints(&one), &joints(&other), person.crown() * scale, |p| p * scale);
        prop_assert!(off < CLOSE, "{off:.1e} H");
        let heavier = heavier(&one.weights, &other.weights);
        prop_assert!(heavier < 1e-3, "weights differ by {heavier}");
    }

    #[test]
    fn the_order_of_vertices_and_triangles_does_not_matter(person in people(), seed in any::<u64>()) {
        let plain = bare(&person);
        let mut other = plain.clone();
        let mut orders = Vec::new();
        for mesh in &mut other.meshes {
            let old = shuffled(mesh.positions.len(), seed);
            let mut new = vec![0; old.len()];
            for (number, &vertex) in old.iter().enumerate() {
                new[vertex] = number as u32;
            }
            mesh.positions = old.iter().map(|&vertex| mesh.positions[vertex]).collect();
            for vertex in mesh.triangles.iter_mut().flatten() {
                *vertex = new[*vertex as usize];
            }
            let order = shuffled(mesh.triangles.len(), seed);
            mesh.triangles = order.into_iter().map(|triangle| mesh.triangles[triangle]).collect();
            orders.push(old);
        }
        let (mut one, other) = (rig(&plain), rig(&other));
        let off = off(&joints(&one), &joints(&other), person.crown(), |p| p);
        prop_assert!(off < CLOSE, "{off:.1e} H");
        for (weights, order) in one.weights.iter_mut().zip(&orders) {
            *weights = Weights::from_rows(order.iter().map(|&vertex| weights.row(vertex).to_vec()));
        }
        let heavier = heavier(&one.weights, &other.weights);
        prop_assert!(heavier < 1e-3, "weights differ by {heavier}");
    }

    #[test]
    fn mirroring_the_person_mirrors_the_rig(person in people(), lean in -0.02..0.02) {
        let mirror = |p: DVec3| DVec3::new(-p.x, p.y, p.z);
        let leaning = placed(&bare(&person), |p| p + DVec3::X * lean * p.y * p.y);
        let mut mirrored = placed(&leaning, mirror);
        for corners in mirrored.meshes.iter_mut().flat_map(|mesh| &mut mesh.triangles) {
            corners.swap(1, 2);
        }
        let one: BTreeMap<Role, DVec3> =
            joints(&rig(&leaning)).into_iter().map(|(role, at)| (role.mirrored(), at)).collect();
        let off = off(&one, &joints(&rig(&mirrored)), person.crown(), mirror);
        prop_assert!(off < CLOSE, "{off:.1e} H");
    }

    #[test]
    fn confidence_is_a_share_and_kinds_stay(person in people()) {
        let character = bare(&person);
        let rig = rig(&character);
        prop_assert!(rig.confidence.iter().all(|confidence| (0.0..=1.0).contains(confidence)));
        let kinds: Vec<Option<MeshKind>> = rig.kinds.iter().copied().map(Some).collect();
        let given: Vec<Option<MeshKind>> = character.meshes.iter().map(|mesh| mesh.kind).collect();
        prop_assert_eq!(kinds, given);
    }
}
