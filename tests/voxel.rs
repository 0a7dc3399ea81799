//! Weights through a volume: on a tube, where the answer is known; on what no artist would make; on real characters.

#[path = "common/models.rs"]
mod models;
#[path = "common/people.rs"]
mod people;
#[path = "common/truth.rs"]
mod truth;

use glam::{DMat3, DVec3};
use std::collections::BTreeMap;
use std::f64::consts::TAU;
use superdeform::internals::rig::voxel::{
    NEAREST_BONE, VOLUME_APART, VoxelOptions, heat_would_be_poor, voxel_weights,
};
use superdeform::internals::rig::weight_bones::weight_bones;
use superdeform::internals::rig::{UnitFigure, WeightBone, WeightSet};
use superdeform::{Progress, Role, Weights};
use truth::Case;

type Soup = (Vec<DVec3>, Vec<[u32; 3]>);

fn options(thread_count: usize) -> VoxelOptions {
    VoxelOptions { thread_count, ..VoxelOptions::default() }
}

fn bone(joint: u32, from: DVec3, to: DVec3) -> WeightBone {
    WeightBone { joint, segments: vec![[from, to]] }
}

/// A closed tube of radius `radius` along y from 0 to 1, and two bones that meet in its middle.
fn tube(radius: f64, closed: bool) -> (Soup, Vec<WeightBone>) {
    let (rings, sides) = (100, 24);
    let mut positions = Vec::new();
    let mut triangles = Vec::new();
    for ring in 0..=rings {
        for side in 0..sides {
            let (sin, cos) = (TAU * f64::from(side) / f64::from(sides)).sin_cos();
            positions.push(DVec3::new(radius * cos, f64::from(ring) / f64::from(rings), radius * sin));
        }
    }
    for ring in 0..rings as u32 {
        for side in 0..sides as u32 {
            let [a, b] = [side, (side + 1) % sides as u32].map(|side| side + ring * sides as u32);
            triangles.extend([[a, b + sides as u32, b], [a, a + sides as u32, b + sides as u32]]);
        }
    }
    if closed {
        for (first, y) in [(0, 0.0), (rings as u32 * sides as u32, 1.0)] {
            let middle = positions.len() as u32;
            positions.push(DVec3::Y * y);
            triangles.extend((0..sides as u32).map(|i| [first + i, first + (i + 1) % sides as u32, middle]));
        }
    }
    let bones = vec![bone(0, DVec3::ZERO, DVec3::Y * 0.5), bone(1, DVec3::Y * 0.5, DVec3::Y)];
    ((positions, triangles), bones)
}

/// A sphere of `radius` around `centre`.
fn sphere(centre: DVec3, radius: f64) -> Soup {
    let (rings, sides) = (12, 24);
    let mut positions = Vec::new();
    let mut triangles = Vec::new();
    for ring in 0..=rings {
        for side in 0..sides {
            let (sin, cos) = (TAU * f64::from(side) / f64::from(sides)).sin_cos();
            let (across, up) = (TAU / 2.0 * f64::from(ring) / f64::from(rings)).sin_cos();
            positions.push(centre + radius * DVec3::new(across * cos, up, across * sin));
        }
    }
    for ring in 0..rings as u32 {
        for side in 0..sides as u32 {
            let [a, b] = [side, (side + 1) % sides as u32].map(|side| side + ring * sides as u32);
            triangles.extend([[a, b + sides as u32, b], [a, a + sides as u32, b + sides as u32]]);
        }
    }
    (positions, triangles)
}

fn join(parts: &[Soup]) -> Soup {
    let mut all: Soup = Default::default();
    for (positions, triangles) in parts {
        let start = all.0.len() as u32;
        all.0.extend(positions);
        all.1.extend(triangles.iter().map(|corners| corners.map(|vertex| vertex + start)));
    }
    all
}

/// How much of a row goes to `joint`.
fn share(weights: &Weights, vertex: usize, joint: u32) -> f64 {
    weights.row(vertex).iter().filter(|entry| entry.0 == joint).map(|entry| f64::from(entry.1)).sum()
}

/// The greatest difference of any weight.
fn difference(one: &Weights, other: &Weights) -> f64 {
    assert_eq!(one.row_count(), other.row_count());
    let mut most = 0.0f64;
    for vertex in 0..one.row_count() {
        for &(joint, _) in one.row(vertex).iter().chain(other.row(vertex)) {
            most = most.max((share(one, vertex, joint) - share(other, vertex, joint)).abs());
        }
    }
    most
}

fn check_rows(name: &str, weighted: &WeightSet, vertex_count: usize, bones: &[WeightBone]) -> Vec<String> {
    let weights = &weighted.weights;
    let mut faults = Vec::new();
    if weights.row_count() != vertex_count {
        faults.push(format!("{name}: {} rows of {vertex_count}", weights.row_count()));
    }
    for (vertex, row) in weights.rows().enumerate() {
        let sum: f64 = row.iter().map(|&(_, weight)| f64::from(weight)).sum();
        let is_good =
            |&(joint, weight): &(u32, f32)| weight > 0.0 && bones.iter().any(|bone| bone.joint == joint);
        if (sum - 1.0).abs() > 1e-5 || !row.iter().all(is_good) {
            faults.push(format!("{name}: vertex {vertex} has {row:?}"));
            break;
        }
    }
    faults
}

#[test]
fn on_a_tube_bones_meet_at_the_joint_and_blend_over_its_radius() {
    for (radius, closed) in [(0.1, true), (0.05, true), (0.1, false)] {
        let ((positions, triangles), bones) = tube(radius, closed);
        let made = voxel_weights(&positions, &triangles, &bones, &options(0), &mut Progress::none()).unwrap();
        assert_eq!(check_rows("tube", &made, positions.len(), &bones), [""; 0]);
        assert!(made.fallback.is_empty());
        let upper = |vertex: usize| share(&made.weights, vertex, 1);
        for side in 0..24 {
            let along: Vec<f64> = (0..=100).map(|ring| upper(24 * ring + side)).collect();
            assert!((along[50] - 0.5).abs() < 1e-5, "{}", along[50]);
            for ring in 0..100 {
                assert!(along[ring] <= along[ring + 1] + 1e-6);
                assert!((along[ring] + along[100 - ring] - 1.0).abs() < 1e-5);
            }
            // Heat gives 1 - exp(-s / r) / 2.
            for (ring, &made) in along.iter().enumerate().skip(50) {
                let s = (ring as f64 - 50.0) / 100.0 / radius;
                let heat = 1.0 - (-s).exp() / 2.0;
                assert!((made - heat).abs() < 0.12, "{s} radii: {made} {heat}");
                assert!(s < 2.5 || made > 0.999);
            }
        }
    }
}

#[test]
fn a_larger_falloff_is_rigid_sooner() {
    let ((positions, triangles), bones) = tube(0.1, true);
    let at = |falloff: f64, ring: usize| {
        let options = VoxelOptions { falloff, ..VoxelOptions::default() };
        share(
            &voxel_weights(&positions, &triangles, &bones, &options, &mut Progress::none()).unwrap().weights,
            24 * ring,
            1,
        )
    };
    for falloff in [0.0, 0.2, 0.5, 1.0] {
        assert!((at(falloff, 50) - 0.5).abs() < 1e-5);
        assert!((at(falloff, 60) - at(0.2, 60)).abs() < 0.01, "a radius away all agree");
    }
    assert!(at(0.0, 68) < at(0.2, 68) && at(0.2, 68) < at(1.0, 68));
}

#[test]
fn limbs_side_by_side_do_not_move_each_other() {
    // Two tubes a few voxels apart that hang from a bar: the bones are as near through the air as along their own tube.
    let ((positions, triangles), _) = tube(0.05, true);
    let place =
        |x: f64| -> Soup { (positions.iter().map(|p| *p + DVec3::X * x).collect(), triangles.clone()) };
    let turned = positions.iter().map(|p| DVec3::new((p.y - 0.5) * 0.4, 1.0 + p.z, p.x)).collect();
    let (positions, triangles) = join(&[place(-0.08), place(0.08), (turned, triangles.clone())]);
    let bones = [
        bone(0, DVec3::new(-0.08, 1.0, 0.0), DVec3::new(0.08, 1.0, 0.0)),
        bone(1, DVec3::new(-0.08, 1.0, 0.0), DVec3::new(-0.08, 0.0, 0.0)),
        bone(2, DVec3::new(0.08, 1.0, 0.0), DVec3::new(0.08, 0.0, 0.0)),
    ];
    let made = voxel_weights(&positions, &triangles, &bones, &options(0), &mut Progress::none()).unwrap();
    for (vertex, p) in positions.iter().enumerate() {
        if p.y < 0.8 {
            let own = if p.x < 0.0 { 1 } else { 2 };
            assert!(share(&made.weights, vertex, own) > 0.999, "{p}: {:?}", made.weights.row(vertex));
        }
    }
}

#[test]
fn what_floats_follows_what_it_floats_over() {
    let (tube, bones) = tube(0.1, true);
    let count = tube.0.len();
    let button = sphere(DVec3::new(0.16, 0.9, 0.0), 0.01);
    let (positions, triangles) = join(&[tube, button]);
    let made = voxel_weights(&positions, &triangles, &bones, &options(0), &mut Progress::none()).unwrap();
    assert_eq!(made.fallback, BTreeMap::from([(VOLUME_APART, positions.len() - count)]));
    for vertex in count..positions.len() {
        assert!(share(&made.weights, vertex, 1) > 0.999);
    }
}

#[test]
fn a_head_whose_top_nobody_knows_is_the_heads() {
    let ((mut positions, mut triangles), _) = tube(0.05, true);
    positions.iter_mut().for_each(|p| p.y *= 0.6);
    (positions, triangles) = join(&[(positions, triangles), sphere(DVec3::Y * 0.8, 0.2)]);
    let joints = [DVec3::ZERO, DVec3::Y * 0.3, DVec3::Y * 0.6];
    let bones = [bone(0, joints[0], joints[1]), bone(1, joints[1], joints[2]), bone(2, joints[2], joints[2])];
    let made = voxel_weights(&positions, &triangles, &bones, &options(0), &mut Progress::none()).unwrap();
    for (vertex, p) in positions.iter().enumerate().filter(|(_, p)| p.y > 0.75) {
        assert!(share(&made.weights, vertex, 2) >= 0.97, "{p}: {:?}", made.weights.row(vertex));
    }
}

#[test]
fn neither_unit_nor_order_nor_pose_matter() {
    let ((positions, triangles), bones) = tube(0.1, true);
    let made =
        voxel_weights(&positions, &triangles, &bones, &options(0), &mut Progress::none()).unwrap().weights;
    let moved = |map: &dyn Fn(DVec3) -> DVec3| {
        let positions: Vec<DVec3> = positions.iter().map(|&p| map(p)).collect();
        let bones: Vec<WeightBone> = bones
            .iter()
            .map(|bone| WeightBone {
                joint: bone.joint,
                segments: bone.segments.iter().map(|ends| ends.map(map)).collect(),
            })
            .collect();
        voxel_weights(&positions, &triangles, &bones, &options(0), &mut Progress::none()).unwrap().weights
    };
    for scale in [1e-3, 1e3] {
        assert!(difference(&made, &moved(&|p| p * scale)) < 1e-4);
    }
    assert!(difference(&made, &moved(&|p| p + DVec3::new(3.0, -7.0, 0.1))) < 1e-4);
    let turn = DMat3::from_rotation_z(0.4) * DMat3::from_rotation_x(0.7);
    assert!(difference(&made, &moved(&|p| turn * p)) < 0.05);

    let count = positions.len() as u32;
    let reversed: Vec<DVec3> = positions.iter().rev().copied().collect();
    let mut backwards: Vec<[u32; 3]> =
        triangles.iter().map(|corners| corners.map(|v| count - 1 - v)).collect();
    backwards.reverse();
    backwards.iter_mut().step_by(2).for_each(|corners| corners.swap(0, 2));
    let other =
        voxel_weights(&reversed, &backwards, &bones, &options(0), &mut Progress::none()).unwrap().weights;
    let other = Weights::from_rows((0..positions.len()).rev().map(|vertex| other.row(vertex).to_vec()));
    assert!(difference(&made, &other) < 1e-5);
}

#[test]
fn hostile_surfaces_have_weights_everywhere() {
    let ((positions, triangles), bones) = tube(0.1, true);
    let mut cases: Vec<(&str, Soup, Vec<WeightBone>)> = Vec::new();
    let holes: Vec<[u32; 3]> =
        triangles.iter().copied().enumerate().filter(|(i, _)| i % 7 != 0).map(|t| t.1).collect();
    cases.push(("holes", (positions.clone(), holes), bones.clone()));
    let shells: Vec<Soup> = (0..20)
        .map(|shell| {
            let part = triangles.iter().copied().skip(shell * 240).take(240).collect();
            let grow = 1.0 + 0.02 * shell as f64;
            (positions.iter().map(|p| DVec3::new(p.x * grow, p.y, p.z)).collect(), part)
        })
        .collect();
    cases.push(("twenty open shells", join(&shells), bones.clone()));
    let mut fins = triangles.clone();
    fins.extend((0..1000).map(|i| [i, i + 1, (i * 7919) % positions.len() as u32]));
    cases.push(("non-manifold", (positions.clone(), fins), bones.clone()));
    let corner = vec![DVec3::ZERO, DVec3::X, DVec3::Y];
    cases.push(("one triangle", (corner.clone(), vec![[0, 1, 2]]), bones.clone()));
    cases.push(("no triangle", (corner.clone(), vec![]), bones.clone()));
    cases.push(("one point", (vec![DVec3::ONE; 4], vec![[0, 1, 2], [1, 2, 3]]), bones.clone()));
    let same = vec![bones[0].clone(), WeightBone { joint: 5, ..bones[0].clone() }];
    cases.push(("bones on each other", (positions.clone(), triangles.clone()), same));
    let outside = vec![
        bone(0, DVec3::new(5.0, 0.0, 0.0), DVec3::new(5.0, 1.0, 0.0)),
        bone(1, DVec3::splat(-9.0), DVec3::splat(-9.0)),
        bone(2, DVec3::splat(1e12), DVec3::splat(-1e12)),
    ];
    cases.push(("bones outside", (positions.clone(), triangles.clone()), outside));
    let empty = vec![WeightBone { joint: 3, segments: vec![] }, bones[1].clone()];
    cases.push(("a bone without segments", (positions.clone(), triangles.clone()), empty));
    let mut loose = positions.clone();
    loose.extend([DVec3::splat(1e9), DVec3::splat(-2.0), DVec3::Y * 0.5]);
    cases.push(("loose vertices", (loose, triangles.clone()), bones.clone()));
    let mut seed = 1u64;
    let mut random = || {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
        (seed >> 40) as f64 / f64::from(1 << 24)
    };
    let soup: Vec<DVec3> = (0..900).map(|_| DVec3::new(random(), random(), random())).collect();
    cases.push(("a soup", (soup, (0..300).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect()), bones.clone()));
    for (name, (positions, triangles), bones) in cases {
        let made = voxel_weights(&positions, &triangles, &bones, &options(0), &mut Progress::none()).unwrap();
        assert_eq!(check_rows(name, &made, positions.len(), &bones), [""; 0]);
        assert!(!made.fallback.contains_key(NEAREST_BONE), "{name}");
        heat_would_be_poor(&positions, &triangles, &bones);
    }
    let none = voxel_weights(&[], &[], &bones, &options(0), &mut Progress::none()).unwrap();
    assert_eq!(none.weights.row_count(), 0);
    assert_eq!(
        voxel_weights(&positions, &triangles, &[], &options(0), &mut Progress::none())
            .unwrap()
            .weights
            .row_count(),
        positions.len()
    );
    assert_eq!(heat_would_be_poor(&[], &[], &[]), None);
}

#[test]
fn coincident_bones_share_evenly() {
    let ((positions, triangles), bones) = tube(0.1, true);
    let same = [bones[0].clone(), WeightBone { joint: 1, ..bones[0].clone() }];
    let made =
        voxel_weights(&positions, &triangles, &same, &options(0), &mut Progress::none()).unwrap().weights;
    for vertex in 0..positions.len() {
        assert!((share(&made, vertex, 0) - 0.5).abs() < 1e-6);
    }
}

#[test]
fn heat_is_poor_for_pieces_and_patches_alone() {
    let ((positions, triangles), bones) = tube(0.1, true);
    assert_eq!(heat_would_be_poor(&positions, &triangles, &bones), None);
    // A hole in a tenth of a closed body is a neck under a collar.
    let ((open, with_ends), _) = tube(0.1, false);
    assert_eq!(heat_would_be_poor(&open, &with_ends, &bones), None);
    // Cut in two at the joint.
    let halves: Vec<[u32; 3]> =
        triangles.iter().copied().filter(|t| !t.iter().all(|&v| (49 * 24..52 * 24).contains(&v))).collect();
    assert!(heat_would_be_poor(&positions, &halves, &bones).unwrap().contains("pieces"));
    let patches: Vec<[u32; 3]> =
        triangles.iter().copied().enumerate().filter(|(i, _)| i % 3 != 0).map(|t| t.1).collect();
    assert!(heat_would_be_poor(&positions, &patches, &bones).is_some());
}

/// A real character laid out, with bones from its artist's joints; head top and chin from its landmarks.
struct Real {
    figure: UnitFigure,
    joints: BTreeMap<Role, DVec3>,
    bones: Vec<WeightBone>,
    made: WeightSet,
}

fn real(case: &Case, options: &VoxelOptions) -> Real {
    let figure = UnitFigure::of(&case.character, case.forward).unwrap();
    let joints: BTreeMap<Role, DVec3> =
        case.joints.iter().map(|(&role, &at)| (role, figure.to_unit(at))).collect();
    let bones = weight_bones(&joints, &BTreeMap::new(), None);
    let made =
        voxel_weights(&figure.positions, &figure.triangles, &bones, options, &mut Progress::none()).unwrap();
    Real { figure, joints, bones, made }
}

#[test]
fn every_vertex_of_every_model_has_weights() {
    let cases = truth::cases();
    if cases.is_empty() {
        println!("no models");
        return;
    }
    models::check_all(&cases, |case| {
        let real = real(case, &options(1));
        check_rows(&case.name, &real.made, real.figure.positions.len(), &real.bones)
    });
}

#[test]
fn threads_change_no_bit() {
    let cases = truth::cases();
    for case in
        cases.iter().filter(|case| ["seedsan_unrigged.glb", "kaykit_rogue.glb"].contains(&&*case.name))
    {
        let one = real(case, &options(1)).made;
        for threads in [2, 8] {
            assert!(real(case, &options(threads)).made.weights == one.weights, "{}", case.name);
        }
    }
}

/// The artist's weights of each vertex, by the role that each joint hangs from; nothing where one hangs from none.
fn artists(case: &Case) -> Option<Vec<BTreeMap<Role, f64>>> {
    let character = &models::model(&case.name)?.character;
    let is_bone = |role: &Role| !matches!(role, Role::LeftEye | Role::RightEye | Role::Jaw);
    let role_of = |joint: usize| {
        let mut above = Some(joint);
        while let Some(joint) = above {
            if let Some((role, _)) = character.humanoid.iter().find(|&(_, other)| other == joint) {
                return role.chain().find(is_bone);
            }
            above = character.skeleton.joints[joint].parent;
        }
        None
    };
    let roles: Vec<Option<Role>> = (0..character.skeleton.joints.len()).map(role_of).collect();
    let rows = character.meshes.iter().flat_map(|mesh| {
        (0..mesh.positions.len()).map(|vertex| {
            let mut row = BTreeMap::new();
            for &(joint, weight) in if mesh.weights.is_empty() { &[] } else { mesh.weights.row(vertex) } {
                if let Some(role) = roles[joint as usize] {
                    *row.entry(role).or_insert(0.0) += f64::from(weight);
                }
            }
            row
        })
    });
    Some(rows.collect())
}

#[test]
fn hands_beside_thighs_do_not_follow_the_legs() {
    let cases = truth::cases();
    let names = ["makehuman_female_rigged.glb", "seedsan_vrm1.vrm", "makehuman_baby_reference.glb"];
    for case in cases.iter().filter(|case| names.contains(&&*case.name)) {
        let real = real(case, &options(0));
        let roles: Vec<Role> = real.joints.keys().copied().collect();
        let mut seen = 0;
        for (vertex, row) in artists(case).unwrap().iter().enumerate() {
            let of_hand: f64 = [Role::LeftHand, Role::RightHand, Role::LeftLowerArm, Role::RightLowerArm]
                .iter()
                .filter_map(|role| row.get(role))
                .sum();
            if of_hand > 0.99 {
                seen += 1;
                let is_leg = |role: Role| {
                    use Role::*;
                    matches!(role, LeftUpperLeg | RightUpperLeg | LeftLowerLeg | RightLowerLeg | Hips)
                };
                let made = real.made.weights.row(vertex);
                let of_leg: f32 = made.iter().filter(|e| is_leg(roles[e.0 as usize])).map(|e| e.1).sum();
                assert!(of_leg < 0.01, "{}: vertex {vertex} has {of_leg}", case.name);
            }
        }
        assert!(seen > 100);
    }
}

#[test]
fn blended_weights_are_nearer_to_the_artists_than_the_strongest_joint_alone() {
    let names = ["cesiumman.glb", "makehuman_female_rigged.glb", "quaternius_female_dress.glb"];
    for case in truth::cases().iter().filter(|case| names.contains(&&*case.name)) {
        let real = real(case, &options(0));
        let roles: Vec<Role> = real.joints.keys().copied().collect();
        let (mut ours, mut rigid, mut count) = (0.0, 0.0, 0.0);
        for (vertex, row) in artists(case).unwrap().iter().enumerate().filter(|(_, row)| !row.is_empty()) {
            let half_l1 = |made: &[(u32, f32)]| {
                let mut rest = row.clone();
                for &(joint, weight) in made {
                    *rest.entry(roles[joint as usize]).or_default() -= f64::from(weight);
                }
                rest.values().map(|x| x.abs()).sum::<f64>() / 2.0
            };
            let made = real.made.weights.row(vertex);
            let strongest = made.iter().max_by(|one, other| one.1.total_cmp(&other.1)).unwrap();
            ours += half_l1(made);
            rigid += half_l1(&[(strongest.0, 1.0)]);
            count += 1.0;
        }
        println!("{}: half-L1 {:.3}, strongest alone {:.3}", case.name, ours / count, rigid / count);
        assert!(ours < rigid, "{}", case.name);
    }
}

#[test]
fn a_symmetric_person_has_symmetric_weights() {
    for arm_angle in [0.0, 50.0] {
        let person = people::Person { arm_angle, ..people::Person::default() };
        let character = person.build();
        let figure = UnitFigure::of(&character, DVec3::Z).unwrap();
        let joints: BTreeMap<Role, DVec3> =
            person.joints().into_iter().map(|(role, at)| (role, figure.to_unit(at))).collect();
        let bones = weight_bones(&joints, &BTreeMap::new(), None);
        let made =
            voxel_weights(&figure.positions, &figure.triangles, &bones, &options(0), &mut Progress::none())
                .unwrap()
                .weights;
        let roles: Vec<Role> = joints.keys().copied().collect();
        let key = |p: DVec3| [p.x, p.y, p.z].map(|x| (x * 1e6).round() as i64);
        let at: BTreeMap<[i64; 3], usize> =
            figure.positions.iter().enumerate().map(|(vertex, &p)| (key(p), vertex)).collect();
        let mut pairs = 0;
        for (vertex, &p) in figure.positions.iter().enumerate() {
            let Some(&twin) = at.get(&key(DVec3::new(-p.x, p.y, p.z))) else { continue };
            pairs += 1;
            for (joint, role) in roles.iter().enumerate() {
                let mirrored = roles.iter().position(|other| *other == role.mirrored()).unwrap();
                let (one, other) = (share(&made, vertex, joint as u32), share(&made, twin, mirrored as u32));
                assert!((one - other).abs() < 1e-4, "{arm_angle}: {p} {role}: {one} {other}");
            }
        }
        assert!(2 * pairs > figure.positions.len(), "{pairs} of {}", figure.positions.len());
    }
}
