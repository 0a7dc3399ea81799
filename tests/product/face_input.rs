//! `face_input.rs`: where a figure's head is, and what its face and its seat are read from.

use crate::people::Person;
use crate::tubes::{Tubes, add_mesh, crowd, ellipsoid};
use superdeform::internals::shape::field::Binding;
use superdeform::internals::shape::product::face_input::{head, head_frame, outline_sources};
use superdeform::internals::shape::product::part::Part;
use superdeform::{MeshKind, Role};

#[test]
fn the_frame_stands_on_the_chin_and_is_as_high_as_the_head() {
    for tubes in crowd() {
        let person = &tubes.person;
        let frame = head_frame(&tubes.anatomy);
        let unit = person.unit;
        // Landmarks are read to two rows of rays, 0.75 / 120 of the way from the shoulder line to the crown each.
        let near = 1.5 / 120.0 * (person.crown() - person.shoulder_line()) * unit;
        assert!((frame.origin.y - person.chin() * unit).abs() < near, "{frame:?}: {}", person.chin() * unit);
        let length = (person.head_top() - person.chin()) * unit;
        assert!((frame.length - length).abs() < 2.0 * near, "{frame:?}: {length}");
        assert!(frame.origin.x.abs() < 1e-3 * unit, "{frame:?}");
        let p = glam::DVec3::new(0.3, 0.4, -0.2);
        assert!(frame.to_unit(frame.from_unit(p)).distance(p) < 1e-12);
    }
}

#[test]
fn a_head_is_what_the_head_moves_and_says_what_of_it_is_hair_or_eye() {
    let person = Person { blended: true, ..Person::adult() };
    let mut character = person.build();
    let crown = glam::DVec3::new(0.0, person.crown(), 0.0);
    let on_head = character.humanoid.joint(Role::Head).unwrap();
    let wig = ellipsoid(crown, glam::DVec3::splat(0.1));
    add_mesh(&mut character, "wig", MeshKind::Hair, &wig, on_head);
    let tubes = Tubes::of_character(person, character);
    let found = head(&tubes.character, &tubes.figure, &tubes.anatomy);
    let parts = &found.parts;
    let eyes = [tubes.mesh("left_eye"), tubes.mesh("right_eye")];
    let wig = tubes.mesh("wig");
    for vertex in 0..tubes.figure.positions.len() {
        let is_eye = eyes.iter().any(|eye| eye.contains(&vertex));
        assert_eq!(parts.is_eye[vertex], is_eye, "{vertex}");
        assert_eq!(parts.is_hair[vertex], wig.contains(&vertex), "{vertex}");
        let y = tubes.figure.positions[vertex].y;
        // The neck ends inside the head.
        let upper = tubes.person.chin() + 0.5 * tubes.person.proportions.head;
        if is_eye || y > upper {
            assert!(parts.of_head[vertex], "{vertex}");
        }
        if y < tubes.person.shoulder_line() {
            assert!(!parts.of_head[vertex], "{vertex}");
        }
    }
}

#[test]
fn eyes_are_told_by_their_side_not_by_their_names() {
    let person = Person { blended: true, ..Person::adult() };
    let mut character = person.build();
    let joints = [Role::LeftEye, Role::RightEye].map(|role| character.humanoid.joint(role));
    let [Some(left), Some(right)] = joints else {
        panic!("the people of these tests have eyes: {joints:?}");
    };
    assert_eq!(Tubes::of(person.clone()).figure.eye_roles(), [Role::LeftEye, Role::RightEye]);
    // Left-handed axes: what is called left lies towards -x.
    character.humanoid.set(Role::LeftEye, right);
    character.humanoid.set(Role::RightEye, left);
    let mirrored = Tubes::of_character(person, character);
    assert_eq!(mirrored.figure.eye_roles(), [Role::RightEye, Role::LeftEye]);
}

#[test]
fn an_outline_is_measured_on_head_neck_and_trunk_without_arms() {
    for tubes in crowd() {
        let (figure, frame) = (&tubes.figure, head_frame(&tubes.anatomy));
        let bindings: Vec<Binding> = tubes.bindings.vertices.iter().copied().map(Binding::Parts).collect();
        let sources = outline_sources(figure, &tubes.anatomy, &bindings);
        assert!(sources.bare.len() > 100);
        let mut hair = sources.hair.iter().flatten();
        assert!(hair.all(|&corner| figure.kind(sources.vertices[corner as usize] as usize).is_carried()));
        assert!(sources.trunk.len() > 10);
        let vertex = |corner: u32| sources.vertices[corner as usize] as usize;
        let of_head = |vertex: usize| tubes.bindings.vertices[vertex].of_head_and_neck();
        let heads = sources.bare.iter().chain(&sources.hair).flatten();
        assert!(heads.into_iter().all(|&corner| of_head(vertex(corner)) > 0.5));
        assert!(sources.trunk.iter().flatten().all(|&corner| of_head(vertex(corner)) <= 0.5));
        for &vertex in &sources.vertices {
            let p = frame.to_unit(figure.positions[vertex as usize]);
            assert!(p.x.abs() < 0.66 && p.y > -1.2, "{p}");
            let weights = tubes.weights(vertex as usize);
            let arms: f32 = (Part::LeftUpperArm as usize..).take(6).map(|part| weights[part]).sum();
            assert!(arms < 0.5, "{weights:?}");
        }
    }
}
