//! What unnamed meshes depict.

#[path = "common/models.rs"]
mod models;
#[path = "common/people.rs"]
mod people;
#[path = "common/truth.rs"]
mod truth;

use glam::{DVec3, Vec3};
use people::Person;
use std::collections::BTreeMap;
use std::sync::Arc;
use superdeform::internals::character::kinds::{MeshNames, kinds_from_names};
use superdeform::internals::rig::mesh_kinds::{body_is_whole, guess_kinds, refine_kinds};
use superdeform::internals::rig::placed::Placed;
use superdeform::internals::rig::{FoundJoint, UnitFigure};
use superdeform::{
    Character, Deformer, Mesh, MeshKind, Options, Progress, Rig, RigOptions, Role, Style, Weights,
};

use superdeform::MeshKind::{Accessory, Body, FacePart, Garment, Hair};

fn without_names(character: &Character) -> Character {
    let mut character = character.clone();
    character.meshes.iter_mut().for_each(|mesh| mesh.kind = None);
    character
}

/// Kinds with all names erased, looked at again with `joints` (model space).
fn guessed(
    character: &Character,
    forward: DVec3,
    joints: &BTreeMap<Role, DVec3>,
) -> (UnitFigure, Vec<MeshKind>, usize) {
    let figure = UnitFigure::of(&without_names(character), forward).unwrap();
    let (mut kinds, warnings, surroundings) = guess_kinds(&figure, 0, &mut Progress::none()).unwrap();
    let found = |&at: &DVec3| FoundJoint { position: figure.to_unit(at), confidence: 1.0 };
    let joints = joints.iter().map(|(&role, at)| (role, found(at))).collect();
    let more = refine_kinds(&figure, &surroundings, &mut kinds, &joints);
    assert_eq!(kinds.len(), figure.mesh_count());
    (figure, kinds, warnings.len() + more.len())
}

/// A file, and for some of its meshes the kinds that are right.
type Expected = (&'static str, &'static [(&'static str, &'static [MeshKind])]);

/// Kinds as pictures of the models show them, by file and mesh; several where nobody could tell from the shape.
const BY_EYE: &[Expected] = &[
    (
        "makehuman_female_target.glb",
        &[
            ("body", &[Body]),
            ("eyes", &[FacePart]),
            ("cloth_skirt", &[Garment]),
            ("cloth_tights", &[Garment]),
            ("hair", &[Hair]),
        ],
    ),
    ("makehuman_baby_reference.glb", &[("body", &[Body]), ("eyes", &[FacePart]), ("hair", &[Hair])]),
    ("makehuman_child_reference.glb", &[("body", &[Body]), ("eyes", &[FacePart]), ("hair", &[Hair])]),
    (
        "kaykit_rogue.glb",
        &[
            ("Cube.199", &[Body]),
            ("Cube.202", &[Body]),
            ("PrototypePete_body.025", &[Body]),
            ("Cube.210", &[Body]),
            ("Cube.194", &[Body]),
            ("Cube.187", &[Body]),
            ("Plane.007", &[Garment]),
        ],
    ),
    (
        "kaykit_barbarian.glb",
        &[
            ("Cube.160", &[Body]),
            ("Cube.161", &[Body]),
            ("PrototypePete_body.022", &[Body]),
            ("Cube.167", &[Body]),
            ("Cube.165", &[Body]),
            ("Cube.163", &[Body]),
            // A hat over the whole skull.
            ("Cube.166", &[Accessory, Hair]),
            ("Plane.006", &[Garment]),
        ],
    ),
    (
        "kaykit_knight.glb",
        &[
            ("Cube.125", &[Body]),
            ("Cube.126", &[Body]),
            ("PrototypePete_body.020", &[Body]),
            ("PrototypePete_head.001", &[Body]),
            ("Cube.128", &[Body]),
            ("Cube.127", &[Body]),
            // A helmet.
            ("Cube.124", &[Accessory, Hair]),
            ("Plane.004", &[Garment]),
        ],
    ),
    ("kenney_mini_female_a.glb", &[("body-mesh", &[Body]), ("head-mesh", &[Body])]),
    ("catbot.vrm", &[("vrm-mesh.baked", &[FacePart]), ("vrm-mesh_WithoutBlendShape.baked", &[Body])]),
    (
        "godette.vrm",
        &[("FaceMesh", &[Body]), ("BodyMesh/Body", &[Body]), ("BodyMesh/Backpack", &[Accessory])],
    ),
    ("gdquest_mannequiny.glb", &[("bony_body.002/Azul", &[Body]), ("bony_body.002/Blanco", &[Body])]),
    ("cesiumman.glb", &[("Cesium_Man", &[Body])]),
    ("tubbykun.vrm", &[("Ube.002.baked", &[Body])]),
    (
        "valid_aian_m_1_milit.glb",
        &[
            ("H_DDS_HighRes", &[Body]),
            ("h_L_eye", &[FacePart]),
            ("h_R_eye", &[FacePart]),
            ("h_TeethDown", &[FacePart]),
            ("h_TeethUp", &[FacePart]),
            ("h_wig", &[Hair]),
        ],
    ),
    (
        "valid_hispanic_f_2_casual.glb",
        &[
            ("H_DDS_HighRes", &[Body]),
            ("h_L_eye", &[FacePart]),
            ("h_R_eye", &[FacePart]),
            ("h_TeethDown", &[FacePart]),
            ("h_TeethUp", &[FacePart]),
        ],
    ),
    (
        "seedsan_unrigged.glb",
        &[
            ("hair/newhair", &[Hair]),
            ("hair_tail", &[Hair]),
            ("head/body_bake", &[Body]),
            ("head/eye", &[FacePart]),
            ("head/eye_trans", &[FacePart]),
            ("robo_arm/arm_plastic", &[Accessory]),
            ("robo_arm/arm_mat", &[Accessory]),
            ("wear/huku_bake", &[Garment]),
            ("wear/body_bake", &[Body]),
            ("wear/body_nm", &[Body]),
            ("wear/backpack_nm", &[Accessory]),
            ("wear/backpack_plastic", &[Accessory]),
            ("wear/backpack_metal", &[Accessory]),
        ],
    ),
    // The skin below the clothes was left out: the clothes carry the trunk.
    (
        "quaternius_female_casual.glb",
        &[
            ("Cylinder.005/Skin", &[Body]),
            ("Cylinder.005/Eyes", &[FacePart]),
            ("Cylinder.005/Hair", &[Hair]),
            ("Cylinder.005/Shirt", &[Body]),
            ("Cylinder.005/Pants", &[Body]),
        ],
    ),
];

#[test]
fn unnamed_meshes_are_what_they_look_like() {
    let cases = truth::cases();
    let (mut count, mut misses) = (0, Vec::new());
    for (file, meshes) in BY_EYE {
        let Some(case) = cases.iter().find(|case| case.name == *file) else {
            println!("left out: {file} is not there");
            continue;
        };
        let (figure, kinds, warning_count) = guessed(&case.character, case.forward, &case.joints);
        for (name, expected) in *meshes {
            let Some(mesh) = figure.names.iter().position(|other| other == name) else {
                panic!("{file} has no mesh {name}, but {:?}", figure.names);
            };
            count += 1;
            if !expected.contains(&kinds[mesh]) {
                misses.push(format!("{file} {name}: {:?} instead of {expected:?}", kinds[mesh]));
                assert!(warning_count > 0, "not told: {misses:?}");
            }
        }
    }
    println!("{} of {count} wrong:\n{}", misses.len(), misses.join("\n"));
    assert!(misses.len() * 20 <= count, "{} of {count} wrong:\n{}", misses.len(), misses.join("\n"));
}

#[test]
fn skirts_and_eyes_of_made_people_are_told_from_the_body() {
    let adult = || Person { skirt: true, columns: 24, ..Person::adult() };
    for person in [
        adult(),
        Person { blended: true, ..adult() },
        Person { arm_angle: 45.0, blended: true, ..adult() },
        Person { fingers: true, unit: 100.0, ..adult() },
        Person { skirt: true, columns: 24, ..Person::chibi() },
    ] {
        let character = person.build();
        let named: Vec<MeshKind> = character.meshes.iter().map(|mesh| mesh.kind.unwrap()).collect();
        let joints = person.joints().into_iter().map(|(role, at)| (role, at * person.unit)).collect();
        let (figure, kinds, _) = guessed(&character, DVec3::Z, &joints);
        assert_eq!(kinds, named, "{:?} {person:?}", figure.names);
        assert!(body_is_whole(&figure, &kinds));
    }
}

#[test]
fn given_kinds_stay() {
    let character = Person { skirt: true, columns: 12, ..Person::adult() }.build();
    for kind in [Body, Garment, Hair, FacePart, Accessory] {
        let mut character = without_names(&character);
        for mesh in [0, character.meshes.len() - 1] {
            character.meshes[mesh].kind = Some(kind);
        }
        let figure = UnitFigure::of(&character, DVec3::Z).unwrap();
        let (mut kinds, _, surroundings) = guess_kinds(&figure, 0, &mut Progress::none()).unwrap();
        let head = FoundJoint { position: DVec3::Y * 0.85, confidence: 1.0 };
        refine_kinds(&figure, &surroundings, &mut kinds, &BTreeMap::from([(Role::Head, head)]));
        assert_eq!([kinds[0], kinds[character.meshes.len() - 1]], [kind; 2]);
    }
}

#[test]
fn a_body_without_a_trunk_is_not_whole() {
    let person = Person { blended: true, columns: 24, ..Person::adult() };
    let mut character = person.build();
    let figure = UnitFigure::of(&character, DVec3::Z).unwrap();
    assert!(body_is_whole(&figure, &guess_kinds(&figure, 0, &mut Progress::none()).unwrap().0));
    // The trunk becomes a shirt.
    let body = &mut character.meshes[0];
    let mut shirt = Mesh { name: "shirt".into(), kind: Some(Garment), ..body.clone() };
    let of_trunk = |corners: &[u32; 3]| {
        let middle = corners.iter().map(|&vertex| body.positions[vertex as usize]).sum::<Vec3>() / 3.0;
        middle.y > 0.95 && middle.y < 1.4 && middle.x.abs() < 0.15
    };
    shirt.triangles.retain(of_trunk);
    let rest = body.triangles.iter().copied().filter(|corners| !of_trunk(corners)).collect();
    body.triangles = rest;
    character.meshes.push(shirt);
    let figure = UnitFigure::of(&character, DVec3::Z).unwrap();
    assert!(!body_is_whole(&figure, &guess_kinds(&figure, 0, &mut Progress::none()).unwrap().0));
    // Where nobody says that it is a shirt, it is what carries the arms and the head.
    let figure = UnitFigure::of(&without_names(&character), DVec3::Z).unwrap();
    let kinds = guess_kinds(&figure, 0, &mut Progress::none()).unwrap().0;
    assert_eq!(kinds.last(), Some(&Body));
    assert!(body_is_whole(&figure, &kinds));
}

#[test]
fn models_whose_clothes_carry_the_trunk_are_not_whole() {
    for case in truth::cases() {
        let hollow = case.name.starts_with("quaternius") && !case.name.contains("man_2017");
        let dressed = case.name.starts_with("makehuman") || case.name.starts_with("seedsan");
        if hollow || dressed {
            let figure = UnitFigure::of(&case.character, case.forward).unwrap();
            assert_eq!(
                body_is_whole(&figure, &guess_kinds(&figure, 0, &mut Progress::none()).unwrap().0),
                dressed,
                "{}",
                case.name
            );
        }
    }
}

#[test]
fn a_warning_names_what_was_guessed() {
    let character = Person { holes: true, skirt: true, columns: 12, ..Person::adult() }.build();
    let mut character = without_names(&character);
    // Something beside the figure.
    let at = |x: f32, y: f32| Vec3::new(x, y, 0.0);
    character.meshes.push(Mesh {
        name: "kite".into(),
        positions: vec![at(0.5, 0.2), at(0.9, 0.2), at(0.7, 0.6)],
        triangles: vec![[0, 1, 2]],
        ..Mesh::default()
    });
    let figure = UnitFigure::of(&character, DVec3::Z).unwrap();
    let (kinds, warnings, _) = guess_kinds(&figure, 0, &mut Progress::none()).unwrap();
    assert_eq!(kinds.last(), Some(&Accessory));
    assert_eq!(warnings[0].code, "kind_guessed");
    assert!(warnings[0].message.contains("kite (accessory)"), "{}", warnings[0].message);
    assert_eq!(warnings[0].option, Some("kinds"));
}

#[test]
fn hostile_layouts_get_kinds_too() {
    let triangle = |offset: f32| Mesh {
        positions: vec![Vec3::splat(offset), Vec3::new(offset, 1.0, 0.0), Vec3::new(1.0, offset, 0.3)],
        triangles: vec![[0, 1, 2]],
        ..Mesh::default()
    };
    let empty = Mesh::default;
    let point = || Mesh { positions: vec![Vec3::ONE; 3], triangles: vec![[0, 1, 2]; 5], ..Mesh::default() };
    let needle = || Mesh {
        positions: vec![Vec3::ZERO, Vec3::Y * 1e20, Vec3::Y],
        triangles: vec![[0, 1, 2], [0, 0, 0]],
        ..Mesh::default()
    };
    let many = (0..200).map(|mesh| triangle(mesh as f32 * 1e-3)).collect();
    let scenes: Vec<Vec<Mesh>> = vec![
        vec![triangle(0.0)],
        vec![triangle(0.0), empty()],
        vec![empty(), point(), triangle(0.0), triangle(0.0)],
        vec![needle(), triangle(0.1), point()],
        vec![needle(), needle()],
        many,
    ];
    for meshes in scenes {
        for kind in [None, Some(Garment), Some(Body)] {
            let mut character = Character { meshes: meshes.clone(), ..Character::default() };
            character.meshes[0].kind = kind;
            let Ok(figure) = UnitFigure::of(&character, DVec3::Z) else { continue };
            let (mut kinds, _, surroundings) = guess_kinds(&figure, 0, &mut Progress::none()).unwrap();
            assert_eq!(kinds.len(), meshes.len());
            for at in [DVec3::ZERO, DVec3::Y * 5.0, DVec3::splat(f64::NAN), DVec3::splat(-1e300)] {
                let head = FoundJoint { position: at, confidence: 0.1 };
                refine_kinds(&figure, &surroundings, &mut kinds, &BTreeMap::from([(Role::Head, head)]));
                body_is_whole(&figure, &kinds);
            }
            body_is_whole(&figure, &[]);
        }
    }
}

/// A mesh of some triangles of others, by mesh, with the vertices that they have.
fn part(meshes: &[Mesh], kept: impl Fn(usize, usize) -> bool, name: &str) -> Mesh {
    let mut made = Mesh { name: name.to_string(), ..Mesh::default() };
    let mut rows: Vec<Vec<(u32, f32)>> = Vec::new();
    for (index, mesh) in meshes.iter().enumerate() {
        let mut new = BTreeMap::new();
        for corners in &mesh.triangles {
            if !corners.iter().all(|&vertex| kept(index, vertex as usize)) {
                continue;
            }
            made.triangles.push(corners.map(|vertex| {
                *new.entry(vertex).or_insert_with(|| {
                    made.positions.push(mesh.positions[vertex as usize]);
                    rows.push(mesh.weights.row(vertex as usize).to_vec());
                    made.positions.len() as u32 - 1
                })
            }));
        }
    }
    made.weights = Weights::from_rows(rows);
    made
}

/// Eyes and feet of one material called Eyes: what of it the head does not carry is no face, in a rig that is there and in
/// one that is made.
#[test]
fn eyes_and_shoes_of_one_material_leave_the_feet_on_the_legs() {
    let person = Person { columns: 24, ..Person::adult() };
    let built = person.build();
    let is_foot = |joint: usize| {
        let feet = [Role::LeftFoot, Role::LeftToes, Role::RightFoot, Role::RightToes];
        feet.iter().any(|&role| built.humanoid.joint(role) == Some(joint))
    };
    let of_foot = |mesh: usize, vertex: usize| is_foot(built.meshes[mesh].weights.row(vertex)[0].0 as usize);
    let feet = part(&built.meshes, of_foot, "Shoes");
    let body = part(&built.meshes, |mesh, vertex| mesh == 0 && !of_foot(mesh, vertex), "Body");
    let eyes = part(&built.meshes, |mesh, _| mesh > 0, "Eyes");
    let both = part(&built.meshes, |mesh, vertex| of_foot(mesh, vertex) || mesh > 0, "Eyes");
    assert_eq!(both.positions.len(), feet.positions.len() + eyes.positions.len());
    let named = |meshes: Vec<Mesh>, rigged: bool| {
        let mut character = Character { meshes, ..built.clone() };
        if !rigged {
            character.meshes.iter_mut().for_each(|mesh| mesh.weights = Weights::default());
            character = Character { meshes: character.meshes, ..Character::default() };
        }
        let names: Vec<MeshNames> =
            character.meshes.iter().map(|mesh| MeshNames::of_path(&mesh.name)).collect();
        let kinds = kinds_from_names(&character, &names);
        character.meshes.iter_mut().zip(kinds).for_each(|(mesh, kind)| mesh.kind = kind);
        character
    };
    let apart = || vec![body.clone(), feet.clone(), eyes.clone()];
    let joined = || vec![body.clone(), both.clone()];
    // The rig that is there: feet become what they become by themselves.
    let style = Style::heads(3.0).unwrap();
    let deformed = |meshes| {
        let character = Arc::new(named(meshes, true));
        Deformer::new(character, &style, &Options::default()).unwrap().apply()
    };
    let (one, other) = (deformed(apart()), deformed(joined()));
    for (index, (a, b)) in one.meshes[1].positions.iter().zip(&other.meshes[1].positions).enumerate() {
        let off = f64::from(a.distance(*b)) / person.crown();
        assert!(off < 0.005, "vertex {index} of the feet lies {off:.3} H off where eyes share their mesh");
    }
    // A rig that is made: legs move the feet, and the head does not.
    let character = named(joined(), false);
    let rig = Rig::of(&character, &RigOptions { fingers: false, ..RigOptions::default() }).unwrap();
    let head = rig.humanoid.joint(Role::Head).unwrap() as u32;
    for vertex in 0..feet.positions.len() {
        let of_head: f32 = rig.weights[1]
            .row(vertex)
            .iter()
            .filter(|(joint, _)| *joint == head)
            .map(|(_, weight)| weight)
            .sum();
        assert!(of_head < 0.01, "the head moves {of_head} of vertex {vertex} of the feet");
    }
    let truth = person.joints();
    for role in [Role::LeftFoot, Role::RightFoot, Role::LeftLowerLeg, Role::RightLowerLeg] {
        let at = rig.skeleton.joints[rig.humanoid.joint(role).unwrap()].rest.w_axis.truncate();
        let off = at.distance(truth[&role]) / person.crown();
        assert!(off <= 0.06, "{role} lies {off:.3} H off");
    }
}

/// A mouth that is cut out of the face, a mesh of its own without a name: taken for hair, it would leave a hole that the
/// chin is read beside.
#[test]
fn a_mouth_of_its_own_is_no_hair_and_moves_no_chin() {
    let person = Person { columns: 48, eyes: false, ..Person::adult() };
    let p = &person.proportions;
    let body = person.build().meshes[0].clone();
    let is_mouth = |vertex: usize| {
        let at = body.positions[vertex].as_dvec3();
        let over_chin = (at.y - person.chin()) / p.head;
        at.z > 0.0 && at.x.abs() < 0.6 * p.head_half_width && (-0.01..0.35).contains(&over_chin)
    };
    let all = [body.clone()];
    let mouth = part(&all, |_, vertex| is_mouth(vertex), "");
    // Triangles across the rim go with the face.
    let mut face = body.clone();
    face.triangles.retain(|corners| !corners.iter().all(|&vertex| is_mouth(vertex as usize)));
    assert!(
        mouth.triangles.len() > 20 && face.triangles.len() + mouth.triangles.len() == body.triangles.len()
    );
    let chin = |meshes: Vec<Mesh>, kind: Option<MeshKind>| {
        let mut character = without_names(&Character { meshes, ..Character::default() });
        character.meshes.iter_mut().for_each(|mesh| mesh.weights = Weights::default());
        if let Some(last) = character.meshes.last_mut() {
            last.kind = kind;
        }
        character.axes.forward = Some(Vec3::Z);
        let options = RigOptions { fingers: false, ..RigOptions::default() };
        let placed = Placed::of(&character, &options, &mut Progress::none()).unwrap();
        (placed.figure.to_model(placed.found.chin).y / person.crown(), placed.kinds)
    };
    let (whole, _) = chin(vec![body.clone()], None);
    let (cut, kinds) = chin(vec![face.clone(), mouth.clone()], None);
    assert_ne!(kinds[1], Hair);
    assert!((cut - whole).abs() < 0.005, "the chin moves from {whole:.3} to {cut:.3} H");
    let (hairy, _) = chin(vec![face, mouth], Some(Hair));
    assert!((hairy - whole).abs() > 0.02, "{hairy:.3} and {whole:.3} H: this mouth makes no difference");
}

/// Eyes and shoes of one material are one mesh, and a name or an earlier rig may have called it eyes.
#[test]
fn eyes_and_shoes_of_one_mesh_follow_head_and_feet() {
    let mut character = Person::adult().build();
    let points: Vec<Vec3> = character.meshes.iter().flat_map(|mesh| &mesh.positions).copied().collect();
    let ends = |of: fn(&Vec3) -> f32| {
        let values = points.iter().map(of);
        values.fold((f32::INFINITY, f32::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)))
    };
    let ((bottom, top), height) = (ends(|p| p.y), ends(|p| p.y).1 - ends(|p| p.y).0);
    // Around what lies at these heights, a hair's breadth further out.
    let mut mesh = Mesh { name: "eyes".to_string(), kind: Some(MeshKind::Eye), ..Mesh::default() };
    let is_shoe = |p: &Vec3| p.y < bottom + 0.03 * height;
    let is_eye = |p: &Vec3| p.y > top - 0.06 * height;
    for part in &character.meshes {
        for corners in &part.triangles {
            let corners = corners.map(|corner| part.positions[corner as usize]);
            if corners.iter().all(is_shoe) || corners.iter().all(is_eye) {
                let first = mesh.positions.len() as u32;
                mesh.positions.extend(corners.map(|p| p + Vec3::Z * 0.002 * height));
                mesh.triangles.push([first, first + 1, first + 2]);
            }
        }
    }
    let (shoes, eyes) = mesh.positions.iter().partition::<Vec<&Vec3>, _>(|p| p.y < bottom + 0.5 * height);
    assert!(shoes.len() > 50 && eyes.len() > 50, "{} {}", shoes.len(), eyes.len());
    mesh.weights = Weights::rigid(0, mesh.positions.len());
    character.meshes.push(mesh);
    let rig = Rig::of(&character, &RigOptions::default()).unwrap();
    let (mesh, weights) = (character.meshes.last().unwrap(), rig.weights.last().unwrap());
    use Role::*;
    let legs = [LeftFoot, RightFoot, LeftToes, RightToes, LeftLowerLeg, RightLowerLeg];
    for (p, row) in mesh.positions.iter().zip(weights.rows()) {
        let of = |roles: &[Role]| -> f32 {
            let joints: Vec<_> = roles.iter().filter_map(|&role| rig.humanoid.joint(role)).collect();
            row.iter()
                .filter(|(joint, _)| joints.contains(&(*joint as usize)))
                .map(|&(_, weight)| weight)
                .sum()
        };
        let held = if is_shoe(&(*p - Vec3::Z * 0.002 * height)) { of(&legs) } else { of(&[Role::Head]) };
        assert!(held > 0.9, "{p}: {held}");
    }
}
