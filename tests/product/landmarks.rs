//! `landmarks.rs`: crown, chin, shoulder line, crotch and soles of people whose heights are known.

use crate::people::Person;
use crate::tubes::{Tubes, add_mesh, ellipsoid};
use glam::DVec3;
use superdeform::internals::shape::figure::Figure;
use superdeform::internals::shape::product::landmarks::{
    CrownSource, HeadPlacement, HeadSources, Landmarks, landmarks,
};
use superdeform::{Character, MeshKind, Role};

fn of(character: &Character) -> Landmarks {
    landmarks(&Figure::of(character).unwrap())
}

fn joint(character: &Character, role: Role) -> usize {
    character.humanoid.joint(role).unwrap()
}

#[test]
fn heights_are_those_that_a_person_was_built_with() {
    for person in [
        Person::adult(),
        Person::chibi(),
        Person { blended: true, unit: 100.0, facing: 90.0, ..Person::adult() },
    ] {
        let Landmarks { heights, chin_seen, trunk, crotch_seen, crown_source, head_top } =
            of(&person.build());
        assert_eq!((chin_seen, crotch_seen, crown_source), (true, true, CrownSource::Skull));
        assert_eq!(trunk, None);
        assert_eq!(head_top, heights.crown);
        let p = &person.proportions;
        let height = person.crown();
        // Rows of rays that look for the chin, and for the crotch from the knees to above the hips.
        let chin_row = 0.75 / 120.0 * (person.crown() - person.shoulder_line());
        let crotch_row = (p.upper_leg + 0.05 * height) / 200.0;
        for (what, found, expected, tolerance) in [
            ("sole", heights.sole, 0.0, 1e-6),
            ("crotch", heights.crotch, person.crotch(), crotch_row),
            ("shoulder line", heights.shoulder_line, person.shoulder_line(), 1e-6),
            ("chin", heights.chin, person.chin(), 2.0 * chin_row),
            ("crown", heights.crown, person.head_top(), 0.002 * height),
        ] {
            let found = found / person.unit;
            assert!(
                (found - expected).abs() <= tolerance,
                "{what}: {found} instead of {expected}: {person:?}"
            );
        }
    }
}

#[test]
fn a_skirt_hides_the_crotch_and_a_ratio_stands_in() {
    let person = Person { skirt: true, ..Person::adult() };
    let character = person.build();
    let figure = Figure::of(&character).unwrap();
    let marks = landmarks(&figure);
    assert!(!marks.crotch_seen);
    // 3 % of H below the hip joints.
    let expected = person.joints()[&Role::LeftUpperLeg].y - 0.03 * figure.height();
    assert!((marks.heights.crotch - expected).abs() < 1e-6, "{marks:?}");
}

#[test]
fn a_head_that_does_not_step_back_to_the_neck_has_its_chin_by_ratio() {
    // A neck as thick as the head, up into it.
    let person = Person::adult();
    let mut character = person.build();
    let column = crate::people::Shape::capsule(
        DVec3::new(0.0, person.shoulder_line() - 0.1, 0.05),
        DVec3::new(0.0, person.crown() - 0.02, 0.05),
        2.0 * person.proportions.head_half_width,
    );
    let neck = joint(&character, Role::Neck);
    add_mesh(&mut character, "column", MeshKind::Body, &column, neck);
    let marks = of(&character);
    assert!(!marks.chin_seen);
    let Landmarks { heights, .. } = marks;
    let expected = heights.shoulder_line + 0.22 * (heights.crown - heights.shoulder_line);
    assert!((heights.chin - expected).abs() < 1e-9, "{heights:?}");
    let codes: Vec<&str> = marks.warnings("target").iter().map(|warning| warning.code).collect();
    assert_eq!(codes, ["face_not_found"]);
}

#[test]
fn hair_and_hats_are_no_crown_where_there_is_a_skull() {
    let person = Person::adult();
    let bare = person.build();
    let mut dressed = bare.clone();
    let head = joint(&dressed, Role::Head);
    let above = DVec3::Y * (person.crown() + 0.02);
    add_mesh(&mut dressed, "hair", MeshKind::Hair, &ellipsoid(above, DVec3::new(0.12, 0.1, 0.12)), head);
    add_mesh(&mut dressed, "hat", MeshKind::Accessory, &ellipsoid(above, DVec3::new(0.2, 0.2, 0.2)), head);
    let (bare, dressed) = (of(&bare), of(&dressed));
    assert_eq!(dressed.crown_source, CrownSource::Skull);
    // The head bone ends at the hat's top: its centre, 0.02 above the crown, and half height; 8 rings of flat facets.
    let top = person.crown() + 0.02 + 0.2;
    assert!((top - 0.01..=top + 1e-6).contains(&dressed.head_top), "{}", dressed.head_top);
    assert!((bare.heights.crown - dressed.heights.crown).abs() < 1e-9, "{bare:?} {dressed:?}");
    assert!((bare.heights.chin - dressed.heights.chin).abs() < 1e-9, "{bare:?} {dressed:?}");
}

#[test]
fn where_hair_is_all_there_is_its_top_is_the_crown() {
    let person = Person::adult();
    let mut character = person.build();
    let head = joint(&character, Role::Head);
    let hair = ellipsoid(DVec3::Y * (person.chin() + 0.11), DVec3::new(0.1, 0.15, 0.1));
    // The body without its head: what the head moves is left out.
    let body = &mut character.meshes[0];
    let is_head: Vec<bool> =
        (0..body.positions.len()).map(|vertex| body.weights.row(vertex)[0].0 as usize == head).collect();
    body.triangles.retain(|corners| !corners.iter().any(|&vertex| is_head[vertex as usize]));
    character.meshes.truncate(1);
    add_mesh(&mut character, "hair", MeshKind::Hair, &hair, head);
    let marks = of(&character);
    assert_eq!(marks.crown_source, CrownSource::Hair);
    assert!(marks.warnings("target").iter().any(|warning| warning.code == "crown_with_hair"));
    // Six rays around the axis at a quarter of the half width of 0.1, and one on it: their median is the ring's height.
    let expected = person.chin() + 0.11 + 0.15 * (1.0 - 0.25_f64.powi(2)).sqrt();
    // 8 rings of flat facets.
    assert!((marks.heights.crown - expected).abs() < 0.005, "{} {expected}", marks.heights.crown);
}

#[test]
fn where_nothing_moves_with_the_head_the_highest_point_is_the_crown() {
    let mut character = Person { eyes: false, ..Person::adult() }.build();
    let head = joint(&character, Role::Head);
    let body = &mut character.meshes[0];
    let is_head: Vec<bool> =
        (0..body.positions.len()).map(|vertex| body.weights.row(vertex)[0].0 as usize == head).collect();
    body.triangles.retain(|corners| !corners.iter().any(|&vertex| is_head[vertex as usize]));
    let figure = Figure::of(&character).unwrap();
    let marks = landmarks(&figure);
    assert_eq!((marks.crown_source, marks.heights.crown), (CrownSource::Figure, figure.extent.1));
    let warnings = marks.warnings("target");
    let warning = warnings.iter().find(|warning| warning.code == "crown_not_found").unwrap();
    assert_eq!(warning.option, Some("humanoid"));
}

#[test]
fn the_soles_are_those_of_feet_and_shins_whatever_hangs_lower() {
    let person = Person::adult();
    let mut character = person.build();
    let hips = joint(&character, Role::Hips);
    let tail = ellipsoid(DVec3::new(0.0, 0.2, -0.5), DVec3::new(0.05, 0.4, 0.05));
    add_mesh(&mut character, "tail", MeshKind::Body, &tail, hips);
    assert!(of(&character).heights.sole.abs() < 1e-6);
}

#[test]
fn heads_are_the_same_with_and_without_the_rest_of_the_landmarks() {
    for person in [Person::adult(), Person { blended: true, ..Person::chibi() }] {
        let Tubes { figure, anatomy, .. } = Tubes::of(person);
        let sources = HeadSources::of(&figure);
        let positions = sources.vertices.iter().map(|&vertex| figure.positions[vertex as usize]).collect();
        let placed = HeadPlacement::of(&figure, positions, |joint| figure.joints[joint]);
        assert_eq!(sources.heads(&placed), anatomy.landmarks.heights.heads());
    }
}
