//! The auto-rig on people of which everything is known, and on figures that no artist made.

#[path = "common/people.rs"]
mod people;

use glam::{DMat3, DVec3, Vec3};
use people::Person;
use std::sync::Arc;
use superdeform::internals::rig::UnitFigure;
use superdeform::internals::rig::placed::Placed;
use superdeform::internals::rig::solid::{CELLS, Solid};
use superdeform::{
    Axes, Character, Deformer, ErrorKind, GarmentWeights, Humanoid, Mesh, MeshKind, Options, Progress, Rig,
    RigOptions, Role, Skeleton, Style, WeightMethod, Weights,
};

/// `character` as a modelling program without a rig would give it.
fn bare(mut character: Character) -> Character {
    character.skeleton = Skeleton::default();
    character.humanoid = Humanoid::default();
    for mesh in &mut character.meshes {
        mesh.weights = Weights::default();
        mesh.kind = None;
    }
    character
}

/// A person's height: from the soles to the crown.
fn height(person: &Person) -> f64 {
    person.crown() * person.unit
}

fn rig(character: &Character) -> Rig {
    Rig::of(character, &RigOptions::default()).unwrap()
}

fn distance(rig: &Rig, truth: &Character, role: Role) -> f64 {
    let at = rig.skeleton.joints[rig.humanoid.joint(role).unwrap()].position();
    at.distance(truth.skeleton.joints[truth.humanoid.joint(role).unwrap()].position())
}

/// Limbs and how far off they may be, in heights.
///
/// Tubes have no creases, and a hand that is a stump of 0.10 m does not show: with the ratio for an arm without a seen
/// hand the wrist comes 0.73 down an arm of 0.63 m instead of 0.84, which is 0.041 H, and the elbow moves by half of
/// that. The trunk ends above the hip joints, so hips are looked for as far above them, and the knee moves by half. A shin without a slim place has its ankle by ratio
/// as well, at 0.092 m instead of 0.07 m.
const LIMBS: [(Role, f64); 8] = [
    (Role::LeftLowerArm, 0.05),
    (Role::RightLowerArm, 0.05),
    (Role::LeftHand, 0.05),
    (Role::RightHand, 0.05),
    (Role::LeftLowerLeg, 0.05),
    (Role::RightLowerLeg, 0.05),
    (Role::LeftFoot, 0.04),
    (Role::RightFoot, 0.04),
];

fn people() -> Vec<(&'static str, Person)> {
    let adult = Person::adult;
    vec![
        ("T-pose", adult()),
        ("A-pose of 30 degrees", Person { arm_angle: 30.0, ..adult() }),
        ("A-pose of 45 degrees", Person { arm_angle: 45.0, ..adult() }),
        ("A-pose of 60 degrees", Person { arm_angle: 60.0, ..adult() }),
        ("skirt", Person { skirt: true, ..adult() }),
        ("open tubes", Person { holes: true, ..adult() }),
        ("fingers", Person { fingers: true, ..adult() }),
        ("one tube a limb", Person { blended: true, arm_angle: 45.0, ..adult() }),
        ("chibi", Person::chibi()),
        ("looks along -z", Person { facing: 180.0, ..adult() }),
        ("looks along x", Person { facing: 90.0, ..adult() }),
        ("looks between the axes", Person { facing: 37.0, ..adult() }),
        ("in centimetres", Person { unit: 100.0, ..adult() }),
    ]
}

#[test]
fn limbs_are_found_where_they_are() {
    let mut failures = Vec::new();
    for (name, person) in people() {
        let truth = person.build();
        let rig = rig(&bare(truth.clone()));
        for (role, bound) in LIMBS {
            let off = distance(&rig, &truth, role) / height(&person);
            if off > bound {
                failures.push(format!("{name}: {role} is {off:.3} H off"));
            }
        }
        for (role, bound) in [(Role::LeftUpperArm, 0.05), (Role::RightUpperLeg, 0.055), (Role::Head, 0.06)] {
            let off = distance(&rig, &truth, role) / height(&person);
            if off > bound {
                failures.push(format!("{name}: {role} is {off:.3} H off"));
            }
        }
    }
    assert!(failures.is_empty(), "{}", failures.join("\n"));
}

#[test]
fn someone_who_lies_down_is_found_too() {
    let person = Person { arm_angle: 30.0, ..Person::adult() };
    let mut truth = person.build();
    // Up becomes -x, and forward z stays: a turn by 90 degrees about z.
    let turn = DMat3::from_rotation_z(std::f64::consts::FRAC_PI_2);
    for mesh in &mut truth.meshes {
        for p in &mut mesh.positions {
            *p = (turn * p.as_dvec3()).as_vec3();
        }
        mesh.normals.clear();
    }
    for joint in &mut truth.skeleton.joints {
        joint.rest.w_axis = (turn * joint.position()).extend(1.0);
    }
    truth.axes = Axes { up: Vec3::NEG_X, up_is_known: true, forward: None };
    let rig = rig(&bare(truth.clone()));
    for (role, bound) in LIMBS {
        let off = distance(&rig, &truth, role) / height(&person);
        assert!(off < bound, "{role} is {off:.3} H off");
    }
}

#[test]
fn a_symmetric_person_gets_a_symmetric_rig() {
    for (name, person) in people().into_iter().filter(|(_, person)| person.facing == 0.0) {
        let rig = rig(&bare(person.build()));
        for (role, joint) in rig.humanoid.iter() {
            let at = rig.skeleton.joints[joint].position();
            let Some(other) = rig.humanoid.joint(role.mirrored()) else {
                panic!("{name}: {role} has no counterpart");
            };
            let other = rig.skeleton.joints[other].position();
            let off = DVec3::new(-at.x, at.y, at.z).distance(other) / height(&person);
            assert!(off < 1e-4, "{name}: {role} is {off:.1e} H from its mirror image");
        }
    }
}

#[test]
fn fingers_are_found_where_there_are_some() {
    let with = rig(&bare(Person { fingers: true, ..Person::adult() }.build()));
    let without = rig(&bare(Person::adult().build()));
    for role in [Role::LeftIndexProximal, Role::LeftLittleDistal, Role::RightThumbProximal] {
        assert!(with.humanoid.has(role), "{role}");
        assert!(!without.humanoid.has(role), "{role}");
    }
}

#[test]
fn a_skirt_follows_the_legs_and_eyes_the_head() {
    let person = Person { skirt: true, ..Person::adult() };
    let character = bare(person.build());
    let rig = rig(&character);
    let role_of = |joint: u32| rig.humanoid.iter().find(|&(_, own)| own == joint as usize).unwrap().0;
    for (mesh, weights) in character.meshes.iter().zip(&rig.weights) {
        for (p, row) in mesh.positions.iter().zip(weights.rows()) {
            let share = |roles: &[Role]| -> f32 {
                row.iter().filter(|entry| roles.contains(&role_of(entry.0))).map(|entry| entry.1).sum()
            };
            match mesh.name.as_str() {
                "left_eye" | "right_eye" => {
                    assert!(
                        share(&[Role::Head, Role::LeftEye, Role::RightEye]) > 0.99,
                        "{}: {row:?}",
                        mesh.name
                    );
                }
                "skirt" => {
                    let lower = [
                        Role::Hips,
                        Role::Spine,
                        Role::LeftUpperLeg,
                        Role::RightUpperLeg,
                        Role::LeftLowerLeg,
                        Role::RightLowerLeg,
                    ];
                    assert!(share(&lower) > 0.95, "skirt at {p}: {row:?}");
                }
                _ => {}
            }
        }
    }
}

/// Every vertex has weights that sum to 1, and what is deformed by them stays finite.
fn is_rigged(name: &str, character: &Character, options: &RigOptions) -> Rig {
    let rig = Rig::of(character, options).unwrap_or_else(|error| panic!("{name}: {error}"));
    for (mesh, weights) in character.meshes.iter().zip(&rig.weights) {
        assert_eq!(weights.row_count(), mesh.positions.len(), "{name}: {}", mesh.name);
        for (vertex, row) in weights.rows().enumerate() {
            let sum: f32 = row.iter().map(|&(_, weight)| weight).sum();
            assert!(row.iter().all(|&(_, weight)| weight > 0.0), "{name}: vertex {vertex}: {row:?}");
            assert!((sum - 1.0).abs() < 1e-5, "{name}: vertex {vertex}: {row:?}");
        }
    }
    for joint in &rig.skeleton.joints {
        assert!(joint.position().is_finite(), "{name}: {} is at {}", joint.name, joint.position());
    }
    assert!(rig.confidence.iter().all(|confidence| (0.0..=1.0).contains(confidence)), "{name}");
    let style = Style::heads(2.5).unwrap();
    if let Ok(deformer) = Deformer::with_rig(character, &rig, &style, &Options::default()) {
        let deformed = deformer.apply();
        let finite = deformed.meshes.iter().flat_map(|mesh| &mesh.positions).all(|p| p.is_finite());
        assert!(finite, "{name}: a vertex went astray");
    }
    rig
}

fn every_way() -> Vec<RigOptions> {
    let mut ways = Vec::new();
    for method in [WeightMethod::Auto, WeightMethod::Heat, WeightMethod::Volume] {
        for garments in [GarmentWeights::Robust, GarmentWeights::Nearest, GarmentWeights::Heat] {
            // A coarse volume is as hostile as a fine one, and quicker.
            ways.push(RigOptions { method, garments, voxel_resolution: 40, ..RigOptions::default() });
        }
    }
    ways
}

/// The person in `count` pieces that do not touch, with open edges all around.
fn in_pieces(person: &Person, count: usize) -> Character {
    let mut character = bare(person.build());
    let slab = person.crown() / (count as f64 / 2.0);
    let piece = |p: Vec3| (((f64::from(p.y) / slab) as i64) << 1) | i64::from(p.x > 0.0);
    for mesh in &mut character.meshes {
        let positions = mesh.positions.clone();
        mesh.triangles.retain(|corners| {
            let [a, b, c] = corners.map(|vertex| piece(positions[vertex as usize]));
            a == b && b == c
        });
    }
    character
}

#[test]
fn a_patchwork_of_twenty_open_shells_is_rigged_whole() {
    let person = Person { blended: true, ..Person::adult() };
    let character = in_pieces(&person, 20);
    for options in every_way() {
        is_rigged("twenty shells", &character, &options);
    }
}

#[test]
fn a_thousand_bad_edges_do_no_harm() {
    let mut character = bare(Person { blended: true, ..Person::adult() }.build());
    let mesh = &mut character.meshes[0];
    let count = mesh.triangles.len();
    for fin in 0..1000 {
        // A third triangle on an edge, to a vertex of its own.
        let [a, b, _] = mesh.triangles[fin * 7 % count];
        let (p, q) = (mesh.positions[a as usize], mesh.positions[b as usize]);
        let tip = mesh.positions.len() as u32;
        mesh.positions.push((p + q) / 2.0 + Vec3::Z * 0.003);
        if !mesh.normals.is_empty() {
            mesh.normals.push(Vec3::Z);
        }
        mesh.triangles.push([a, b, tip]);
    }
    mesh.tangents.clear();
    for options in every_way() {
        is_rigged("a thousand fins", &character, &options);
    }
}

/// A character of one mesh.
fn soup(positions: Vec<Vec3>, triangles: Vec<[u32; 3]>) -> Character {
    Character {
        meshes: vec![Mesh { name: "soup".to_string(), positions, triangles, ..Mesh::default() }],
        // Nothing here stands: no other way up need be tried, nine times a shape.
        axes: Axes { up_is_known: true, ..Axes::default() },
        ..Character::default()
    }
}

/// A ball of `rings` rings.
fn ball(centre: Vec3, radius: f32, rings: u32) -> (Vec<Vec3>, Vec<[u32; 3]>) {
    let columns = 2 * rings;
    let mut positions = Vec::new();
    for ring in 0..=rings {
        let (sin, cos) = (std::f32::consts::PI * ring as f32 / rings as f32).sin_cos();
        for column in 0..columns {
            let (s, c) = (std::f32::consts::TAU * column as f32 / columns as f32).sin_cos();
            positions.push(centre + radius * Vec3::new(sin * c, cos, sin * s));
        }
    }
    let mut triangles = Vec::new();
    for ring in 0..rings {
        for column in 0..columns {
            let [a, b] = [column, (column + 1) % columns].map(|column| ring * columns + column);
            triangles.extend([[a, b, a + columns], [b, b + columns, a + columns]]);
        }
    }
    (positions, triangles)
}

#[test]
fn any_shape_is_rigged_or_refused_in_a_sentence() {
    let (sphere, sphere_faces) = ball(Vec3::Y, 1.0, 12);
    let mut two = sphere.clone();
    two.extend(sphere.iter().map(|p| *p + Vec3::X * 5.0));
    let mut two_faces = sphere_faces.clone();
    two_faces.extend(sphere_faces.iter().map(|corners| corners.map(|vertex| vertex + sphere.len() as u32)));
    let shapes = [
        ("a triangle", vec![Vec3::ZERO, Vec3::Y, Vec3::X], vec![[0, 1, 2]]),
        ("a sliver", vec![Vec3::ZERO, Vec3::Y, Vec3::Y * 2.0], vec![[0, 1, 2]]),
        ("a plane", vec![Vec3::ZERO, Vec3::Y, Vec3::X, Vec3::X + Vec3::Y], vec![[0, 1, 2], [1, 3, 2]]),
        ("a sphere", sphere.clone(), sphere_faces.clone()),
        ("two spheres", two, two_faces),
        ("a stick", sphere.iter().map(|p| *p * Vec3::new(0.01, 10.0, 0.01)).collect(), sphere_faces.clone()),
        (
            "a sphere and loose points",
            [sphere.clone(), vec![Vec3::splat(9.0); 5]].concat(),
            sphere_faces.clone(),
        ),
        ("far from the origin", sphere.iter().map(|p| *p + Vec3::splat(3e4)).collect(), sphere_faces),
    ];
    for (name, positions, triangles) in shapes {
        let character = soup(positions, triangles);
        for options in every_way() {
            is_rigged(name, &character, &options);
        }
    }
    for (name, positions, triangles) in [
        ("nothing", vec![], vec![]),
        ("points", vec![Vec3::ZERO, Vec3::Y], vec![]),
        ("one point", vec![Vec3::ONE; 9], vec![[0, 1, 2], [3, 4, 5]]),
        ("lies flat", vec![Vec3::ZERO, Vec3::Z, Vec3::X], vec![[0, 1, 2]]),
    ] {
        let error = Rig::of(&soup(positions, triangles), &RigOptions::default()).unwrap_err();
        assert_eq!(error.kind, ErrorKind::NoGeometry, "{name}: {error}");
        assert!(!error.message.is_empty());
    }
}

#[test]
fn a_vertex_that_is_flung_far_away_moves_no_joint_and_takes_no_more_cells() {
    let person = Person { columns: 24, ..Person::adult() };
    let placed = |character: &Character| {
        let options = RigOptions { fingers: false, ..RigOptions::default() };
        Placed::of(character, &options, &mut Progress::none()).unwrap()
    };
    let cells = |placed: &Placed| {
        let UnitFigure { positions, triangles, .. } = &placed.figure;
        Solid::new(positions, triangles, |_| true, 0.0, CELLS).unwrap().count()
    };
    let mut as_it_is = bare(person.build());
    as_it_is.axes.forward = Some(Vec3::Z);
    let usual = placed(&as_it_is);
    let count = as_it_is.meshes[0].positions.len();
    for (step, way) in [Vec3::X, Vec3::NEG_X, Vec3::Y, Vec3::NEG_Y, Vec3::Z, Vec3::new(0.5, 1.0, -0.5)]
        .into_iter()
        .enumerate()
    {
        let mut flung = as_it_is.clone();
        let vertex = (2 * step + 1) * count / 12;
        flung.meshes[0].positions[vertex] += 1000.0 * person.crown() as f32 * way;
        let found = placed(&flung);
        let grown = cells(&found) as f64 / cells(&usual) as f64;
        assert!(grown < 1.05, "{grown} times as many cells with vertex {vertex} along {way}");
        for (role, joint) in &usual.found.joints {
            let p = found.figure.to_model(found.found.joints[role].position);
            let off = p.distance(usual.figure.to_model(joint.position)) / person.crown();
            assert!(off <= 1e-3, "{role} moves by {off} heights with vertex {vertex} along {way}");
        }
    }
}

/// Hands that are stumps do not show: a wrist is off by 0.04 H without help. One that is given stays, its elbow lies
/// between (`ELBOW_SHARE` is .53 of the way, a person's elbow .5 or so), and the other arm is found as well as without.
#[test]
fn one_given_wrist_stays_and_the_rest_of_its_arm_is_found_around_it() {
    for person in [Person::adult(), Person { arm_angle: 40.0, ..Person::adult() }] {
        let person = Person { columns: 24, ..person };
        let truth = person.build();
        let at = |role: Role| truth.skeleton.joints[truth.humanoid.joint(role).unwrap()].position();
        let given = [(Role::LeftHand, at(Role::LeftHand))].into();
        let options = RigOptions { given, fingers: false, ..RigOptions::default() };
        let helped = Rig::of(&bare(person.build()), &options).unwrap();
        let alone = Rig::of(&bare(person.build()), &RigOptions { fingers: false, ..RigOptions::default() });
        let alone = alone.unwrap();
        assert!(distance(&helped, &truth, Role::LeftHand) < 1e-6);
        let sure = helped.confidence[helped.humanoid.joint(Role::LeftHand).unwrap()];
        assert_eq!(sure, 1.0);
        let off = |rig: &Rig, role: Role| distance(rig, &truth, role) / height(&person);
        assert!(off(&helped, Role::LeftLowerArm) < 0.03, "{} of 0.03", off(&helped, Role::LeftLowerArm));
        for role in [Role::RightUpperArm, Role::RightLowerArm, Role::RightHand] {
            assert!(off(&helped, role) <= off(&alone, role) + 0.01, "{role}: {}", off(&helped, role));
        }
    }
}

#[test]
fn options_out_of_their_range_are_refused() {
    let character = bare(Person { columns: 12, ..Person::adult() }.build());
    for options in [
        RigOptions { heat: 0.0, ..RigOptions::default() },
        RigOptions { heat: f64::NAN, ..RigOptions::default() },
        RigOptions { voxel_resolution: 4, ..RigOptions::default() },
        RigOptions { given: [(Role::Head, DVec3::NAN)].into(), ..RigOptions::default() },
    ] {
        assert_eq!(Rig::of(&character, &options).unwrap_err().kind, ErrorKind::BadOption, "{options:?}");
    }
    // Given joints may lie anywhere.
    let given = [(Role::Head, DVec3::splat(1e9)), (Role::LeftHand, DVec3::ZERO)].into();
    is_rigged("a head far away", &character, &RigOptions { given, ..RigOptions::default() });
}

#[test]
fn kinds_that_the_host_gives_are_kept() {
    let mut character = bare(Person { skirt: true, ..Person::adult() }.build());
    let last = character.meshes.len() - 1;
    character.meshes[last].kind = Some(MeshKind::Accessory);
    assert_eq!(rig(&character).kinds[last], MeshKind::Accessory);
}

#[test]
fn own_joints_come_first_and_ride_along() {
    let truth = Person::adult().build();
    let rig = rig(&truth);
    let rigged = rig.applied_to(&truth);
    let own = truth.skeleton.joints.len();
    assert_eq!(rigged.skeleton.joints.len(), own + rig.skeleton.joints.len());
    for (joint, was) in rigged.skeleton.joints.iter().zip(&truth.skeleton.joints) {
        assert_eq!((&joint.name, joint.rest), (&was.name, was.rest));
    }
    assert!(rigged.validate().is_ok());
    assert!(rigged.humanoid.iter().all(|(_, joint)| joint >= own));
    // Each joint with a role hangs from the joint that was found for it.
    let elbow = truth.humanoid.joint(Role::LeftLowerArm).unwrap();
    assert_eq!(rigged.skeleton.joints[elbow].parent, rigged.humanoid.joint(Role::LeftLowerArm));
    let style = Style::heads(2.5).unwrap();
    let deformed = Deformer::new(Arc::new(rigged), &style, &Options::default()).unwrap().apply();
    assert_eq!(deformed.joints.len(), own + rig.skeleton.joints.len());
}

#[test]
fn a_hundred_thousand_triangles_are_rigged() {
    let mut positions = Vec::new();
    let mut triangles = Vec::new();
    // A snowman of three balls: 3 x 2 x 130 x 260 triangles.
    for (height, radius) in [(0.5, 0.5), (1.3, 0.4), (1.9, 0.3)] {
        let (points, faces) = ball(Vec3::Y * height, radius, 130);
        let start = positions.len() as u32;
        positions.extend(points);
        triangles.extend(faces.into_iter().map(|corners| corners.map(|vertex| vertex + start)));
    }
    assert!(triangles.len() > 100_000);
    is_rigged("a hundred thousand triangles", &soup(positions, triangles), &RigOptions::default());
}
