//! The way an unrigged figure looks.

#[path = "common/models.rs"]
mod models;
#[path = "common/people.rs"]
mod people;
#[path = "common/truth.rs"]
mod truth;

use glam::{DMat3, DVec3, Vec3};
use models::check_all;
use people::Person;
use superdeform::internals::rig::facing::find_forward;
use superdeform::{Axes, Character, Mesh};

/// Figures whose front and back their shape does not tell, having it painted on: a robot with a screen for a face and a
/// cat and a box on legs without feet. They are warned of instead.
const UNCLEAR: [&str; 3] = ["catbot.vrm", "cool_loops.vrm", "tubbykun.vrm"];

/// Degrees by which a way found may be wrong.
const NEAR: f64 = 5.0;

/// The character turned, up and all.
fn turned(character: &Character, turn: DMat3) -> Character {
    let mut character = character.clone();
    let apply = |v: Vec3| (turn * v.as_dvec3()).as_vec3();
    for mesh in &mut character.meshes {
        mesh.positions.iter_mut().for_each(|p| *p = apply(*p));
    }
    character.axes.up = apply(character.axes.up);
    character.axes.forward = character.axes.forward.map(apply);
    character
}

fn is_warned(character: &Character) -> bool {
    find_forward(character)[0].1.iter().any(|warning| warning.code == "facing_guessed")
}

/// What is wrong with the way found for `character`, which looks along `forward`.
fn faults(name: &str, character: &Character, forward: DVec3, clear: bool) -> Vec<String> {
    let (found, warnings) = find_forward(character).swap_remove(0);
    let angle = found.angle_between(forward).to_degrees();
    let mut faults = Vec::new();
    if (found.length() - 1.0).abs() > 1e-9 || found.dot(character.axes.up.as_dvec3()).abs() > 1e-6 {
        faults.push(format!("{name}: {found} is no direction at right angles to up"));
    }
    if clear && angle > NEAR {
        faults.push(format!("{name}: {angle:.1} degrees wrong"));
    }
    // Wrong only with a warning, and then by half a turn: left and right are never mixed with front and back.
    if angle > NEAR && (warnings.is_empty() || 180.0 - angle > NEAR) {
        faults.push(format!("{name}: {angle:.1} degrees wrong, {} warnings", warnings.len()));
    }
    faults
}

#[test]
fn real_characters_look_the_way_their_joints_say() {
    check_all(&truth::cases(), |case| {
        let mut all = Vec::new();
        let clear = !UNCLEAR.contains(&case.name.as_str());
        let up = case.character.axes.up.as_dvec3().normalize();
        for degrees in [0.0, 90.0, 180.0, 270.0, 37.0, 118.0, 201.0, 323.0_f64] {
            let turn = DMat3::from_axis_angle(up, degrees.to_radians());
            let name = format!("{} turned by {degrees}", case.name);
            all.extend(faults(&name, &turned(&case.character, turn), turn * case.forward, clear));
        }
        for (how, turn) in [
            ("lying on its back", DMat3::from_rotation_x(-90_f64.to_radians())),
            ("lying on its face", DMat3::from_rotation_x(90_f64.to_radians())),
            ("lying on its side", DMat3::from_rotation_z(90_f64.to_radians())),
            ("on its head", DMat3::from_rotation_z(180_f64.to_radians())),
            ("aslant", DMat3::from_axis_angle(DVec3::new(1.0, 2.0, -1.5).normalize(), 1.1)),
        ] {
            let name = format!("{} {how}", case.name);
            all.extend(faults(&name, &turned(&case.character, turn), turn * case.forward, clear));
        }
        all
    });
}

#[test]
fn figures_without_a_front_are_warned_of() {
    for case in truth::cases() {
        if UNCLEAR.contains(&case.name.as_str()) {
            assert!(is_warned(&case.character), "{}", case.name);
        }
    }
}

#[test]
fn people_of_tubes_look_where_their_feet_point() {
    let mut people = Vec::new();
    for facing in [0.0, 45.0, 90.0, 133.0, 180.0, 271.0] {
        for (name, person) in [
            ("adult", Person::adult()),
            ("A-pose", Person { arm_angle: 50.0, ..Person::adult() }),
            ("arms down", Person { arm_angle: 80.0, ..Person::adult() }),
            ("chibi", Person::chibi()),
            ("skirt", Person { skirt: true, ..Person::adult() }),
            ("holes", Person { holes: true, fingers: true, ..Person::adult() }),
            ("centimetres", Person { unit: 100.0, ..Person::adult() }),
        ] {
            people.push((format!("{name} facing {facing}"), Person { facing, columns: 24, ..person }));
        }
    }
    check_all(&people, |(name, person)| {
        let forward = DMat3::from_rotation_y(person.facing.to_radians()) * DVec3::Z;
        faults(name, &person.build(), forward, true)
    });
}

#[test]
fn a_given_way_is_taken_as_it_is() {
    let mut character = Person::adult().build();
    character.axes.forward = Some(Vec3::new(3.0, 4.0, 0.0));
    assert_eq!(find_forward(&character), [(DVec3::X, Vec::new())]);
}

/// Things that look no way.
#[test]
fn things_without_a_front_are_warned_of() {
    let mut sphere = people::Shape::default();
    sphere.ellipsoid(DVec3::new(0.3, 5.0, -2.0), DVec3::ONE, superdeform::Role::Head);
    let square = [Vec3::ZERO, Vec3::X, Vec3::X + Vec3::Z, Vec3::Z];
    let mesh = |positions: &[Vec3], triangles: &[[u32; 3]]| Mesh {
        positions: positions.to_vec(),
        triangles: triangles.to_vec(),
        ..Mesh::default()
    };
    let things = [
        ("nothing", Mesh::default()),
        (
            "sphere",
            Mesh {
                positions: sphere.positions.iter().map(|p| p.as_vec3()).collect(),
                triangles: sphere.triangles,
                ..Mesh::default()
            },
        ),
        ("ground", mesh(&square, &[[0, 1, 2], [0, 2, 3]])),
        ("wall", mesh(&[Vec3::ZERO, Vec3::X, Vec3::Y], &[[0, 1, 2]])),
        ("sliver", mesh(&[Vec3::ZERO, Vec3::Y, 2.0 * Vec3::Y], &[[0, 1, 2]])),
        ("point", mesh(&[Vec3::ONE; 3], &[[0, 1, 2]])),
        ("loose points", mesh(&square, &[])),
        ("huge", mesh(&[Vec3::ZERO, 1e30 * Vec3::X, 1e30 * Vec3::Y], &[[0, 1, 2]])),
        ("tiny", mesh(&[Vec3::ZERO, 1e-30 * Vec3::X, 1e-30 * Vec3::Y], &[[0, 1, 2]])),
    ];
    for (name, mesh) in things {
        for up in [Vec3::Y, Vec3::Z, Vec3::NEG_X, Vec3::new(1.0, -2.0, 0.3)] {
            let axes = Axes { up, up_is_known: true, forward: None };
            let character = Character { meshes: vec![mesh.clone()], axes, ..Character::default() };
            let (found, warnings) = find_forward(&character).swap_remove(0);
            assert!((found.length() - 1.0).abs() < 1e-9, "{name}, up {up}: {found}");
            assert!(found.dot(up.as_dvec3()).abs() < 1e-6, "{name}, up {up}: {found}");
            let warned = warnings.iter().any(|warning| warning.code == "facing_guessed");
            // Flat things aslant have a plane of symmetry, and an end that is lower.
            assert!(warned || up.to_array().iter().all(|&c| c != 0.0), "{name}, up {up}");
        }
    }
}
