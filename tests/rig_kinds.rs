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
use superdeform::internals::rig::mesh_kinds::{body_is_whole, guess_kinds, refine_kinds};
use superdeform::internals::rig::{FoundJoint, UnitFigure};
use superdeform::{Character, Mesh, MeshKind, Progress, Role};

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
