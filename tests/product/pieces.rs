//! `pieces.rs`: what keeps its shape.

use crate::people::{Person, Shape};
use crate::tubes::{Tubes, add_mesh, ellipsoid};
use glam::{DVec3, Vec3};
use std::sync::Arc;
use superdeform::internals::shape::product::part::Part;
use superdeform::internals::shape::product::pieces::Attachment;
use superdeform::{Character, Deformer, Joint, MeshKind, Options, Repair, Role, Style, Weights};

fn person() -> Person {
    Person { blended: true, ..Person::adult() }
}

fn joint(character: &Character, role: Role) -> usize {
    character.humanoid.joint(role).unwrap()
}

fn attachment(tubes: &Tubes, name: &str) -> Attachment {
    let attachments: Vec<Attachment> =
        tubes.mesh(name).map(|vertex| tubes.bindings.vertices[vertex].attachment).collect();
    assert!(attachments.iter().all(|other| *other == attachments[0]), "{name}: {attachments:?}");
    attachments[0]
}

/// The number of the piece that the whole mesh belongs to.
fn piece(tubes: &Tubes, name: &str) -> usize {
    match attachment(tubes, name) {
        Attachment::Piece(piece) => piece,
        other => panic!("{name}: {other:?}"),
    }
}

/// A ball of `radius` in front of the trunk, at this height.
fn ball(height: f64, radius: f64) -> Shape {
    ellipsoid(DVec3::new(0.0, height, 0.14), DVec3::splat(radius))
}

#[test]
fn buttons_keep_their_shape_and_what_is_larger_bends() {
    let mut character = person().build();
    let chest = joint(&character, Role::Chest);
    // 0.04 H is 6.6 cm.
    add_mesh(&mut character, "button", MeshKind::Garment, &ball(1.2, 0.02), chest);
    add_mesh(&mut character, "cushion", MeshKind::Garment, &ball(1.3, 0.04), chest);
    let tubes = Tubes::of_character(person(), character);
    let button = &tubes.bindings.pieces[piece(&tubes, "button")];
    assert!(button.anchor.distance(DVec3::new(0.0, 1.2, 0.14)) < 1e-6, "{button:?}");
    assert!((button.lowest - 1.18).abs() < 1e-6, "{button:?}");
    assert!(button.weights[Part::Torso as usize] > 0.99, "{button:?}");
    assert_eq!(attachment(&tubes, "cushion"), Attachment::Plain);
    assert_eq!(attachment(&tubes, "left_eye"), Attachment::Plain);
}

#[test]
fn hats_take_the_face_map_of_their_middle_and_hair_does_not() {
    let mut character = person().build();
    let head = joint(&character, Role::Head);
    let at = DVec3::new(0.01, person().crown(), -0.02);
    add_mesh(&mut character, "hat", MeshKind::Accessory, &ellipsoid(at, DVec3::new(0.15, 0.1, 0.15)), head);
    add_mesh(&mut character, "hair", MeshKind::Hair, &ellipsoid(at, DVec3::new(0.1, 0.08, 0.1)), head);
    let tubes = Tubes::of_character(person(), character);
    let Attachment::OnFace(centre) = attachment(&tubes, "hat") else { panic!() };
    assert!(centre.distance(at) < 1e-6, "{centre}");
    assert_eq!(attachment(&tubes, "hair"), Attachment::Plain);
}

#[test]
fn parts_of_a_bag_that_touch_are_one_piece_held_where_it_is_nearest_to_the_body() {
    let mut character = person().build();
    let hips = joint(&character, Role::Hips);
    // Beside the waist: the trunk's side is at x = 0.13. Two balls that overlap, and one on the other side.
    for (name, x, y) in [("bag", 0.26, 1.15), ("pocket", 0.38, 1.15), ("other bag", -0.26, 1.15)] {
        add_mesh(
            &mut character,
            name,
            MeshKind::Accessory,
            &ellipsoid(DVec3::new(x, y, 0.0), DVec3::splat(0.08)),
            hips,
        );
    }
    let tubes = Tubes::of_character(person(), character);
    let [bag, pocket, other] = ["bag", "pocket", "other bag"].map(|name| piece(&tubes, name));
    assert_eq!(bag, pocket);
    assert_ne!(bag, other);
    let held = &tubes.bindings.pieces[bag];
    // The nearest point of the ball is at x = 0.18; what is held lies within 0.005 H of that.
    assert!((0.18 - 1e-6..0.19).contains(&held.anchor.x) && (held.anchor.y - 1.15).abs() < 0.02, "{held:?}");
    assert!((held.lowest - 1.07).abs() < 1e-6, "{held:?}");
    assert!(held.weights[Part::Torso as usize] > 0.9, "{held:?}");
}

#[test]
fn a_bag_that_bends_between_two_joints_is_no_piece() {
    let mut character = person().build();
    let (hips, chest) = (joint(&character, Role::Hips), joint(&character, Role::Chest));
    let strap = ellipsoid(DVec3::new(0.0, 1.1, 0.2), DVec3::new(0.05, 0.2, 0.05));
    add_mesh(&mut character, "strap", MeshKind::Accessory, &strap, hips);
    let strap = character.meshes.last_mut().unwrap();
    let rows: Vec<[(u32, f32); 1]> =
        strap.positions.iter().map(|p: &Vec3| [(if p.y > 1.1 { chest } else { hips } as u32, 1.0)]).collect();
    strap.weights = Weights::from_rows(rows);
    let tubes = Tubes::of_character(person(), character);
    assert_eq!(attachment(&tubes, "strap"), Attachment::Plain);
}

/// The adult with an arm of a machine on the back: two joints without roles, one on the other, a ball on each.
fn machine(kind: MeshKind, blend: bool) -> Tubes {
    let mut character = person().build();
    let chest = joint(&character, Role::Chest);
    let at = [DVec3::new(0.0, 1.2, -0.2), DVec3::new(0.0, 1.3, -0.4)];
    let mut parent = chest;
    let mut joints = Vec::new();
    for (index, at) in at.into_iter().enumerate() {
        character.skeleton.joints.push(Joint {
            name: format!("machine {index}"),
            parent: Some(parent),
            rest: glam::DMat4::from_translation(at),
        });
        parent = character.skeleton.joints.len() - 1;
        joints.push(parent);
    }
    for (name, index) in [("root", 0), ("tip", 1)] {
        let ball = ellipsoid(at[index], DVec3::new(0.06, 0.08, 0.06));
        add_mesh(&mut character, name, kind, &ball, joints[index]);
        if blend {
            let mesh = character.meshes.last_mut().unwrap();
            let half = [(joints[0] as u32, 0.5), (joints[1] as u32, 0.5)];
            mesh.weights = Weights::from_rows(vec![half; mesh.positions.len()]);
        }
    }
    Tubes::of_character(person(), character)
}

#[test]
fn what_hangs_from_a_joint_without_a_role_is_one_piece_held_at_that_joint() {
    let tubes = machine(MeshKind::Garment, false);
    let [root, tip] = ["root", "tip"].map(|name| piece(&tubes, name));
    assert_eq!(root, tip);
    let held = &tubes.bindings.pieces[root];
    assert!(held.anchor.distance(DVec3::new(0.0, 1.2, -0.2)) < 1e-6, "{held:?}");
    assert!((held.lowest - 1.12).abs() < 1e-6, "{held:?}");
    assert_eq!(held.weights, Part::Torso.alone());
    let count = tubes.figure.joints.len();
    let pieces = &tubes.bindings.joint_pieces;
    assert_eq!(pieces[count - 2..], [Some(root), Some(root)]);
    assert!(pieces[..count - 2].iter().all(Option::is_none));
}

#[test]
fn what_a_twist_joint_carries_stays_where_it_is_worn() {
    for [from, to] in [[Role::LeftLowerArm, Role::LeftHand], [Role::LeftLowerLeg, Role::LeftFoot]] {
        let mut character = person().build();
        let ends = [from, to].map(|role| joint(&character, role));
        let place = |of: &[DVec3]| [of[ends[0]], of[ends[1]]];
        let rest: Vec<DVec3> = character.skeleton.joints.iter().map(Joint::position).collect();
        let [first, last] = place(&rest);
        character.skeleton.joints.push(Joint {
            name: "twist".to_string(),
            parent: Some(ends[0]),
            rest: glam::DMat4::from_translation(first.midpoint(last)),
        });
        let twist = rest.len();
        let guard = ellipsoid(first.lerp(last, 0.85), DVec3::splat(0.06));
        add_mesh(&mut character, "guard", MeshKind::Garment, &guard, twist);
        let deformer = Deformer::new(Arc::new(character), &Style::Heads(2.5), &Options::default()).unwrap();
        let deformed = deformer.apply();
        let [first, last] = place(&deformed.joints);
        let share = |p: DVec3| (p - first).dot(last - first) / (last - first).length_squared();
        let points = &deformed.meshes.last().unwrap().positions;
        let middle = points.iter().map(|p| p.as_dvec3()).sum::<DVec3>() / points.len() as f64;
        assert!((share(middle) - 0.85).abs() < 0.1, "{from:?}: {}", share(middle));
        let of_joint = share(deformed.joints[twist]);
        assert!((of_joint - 0.5).abs() < 0.02, "{from:?}: {of_joint}");
    }
}

#[test]
fn what_bends_between_joints_without_roles_is_none() {
    let tubes = machine(MeshKind::Garment, true);
    assert_eq!(attachment(&tubes, "root"), Attachment::Plain);
    assert!(tubes.bindings.joint_pieces.iter().all(Option::is_none));
}

#[test]
fn pieces_come_out_similar_to_what_they_were() {
    let mut character = person().build();
    let (hips, chest) = (joint(&character, Role::Hips), joint(&character, Role::Chest));
    let bag = ellipsoid(DVec3::new(0.3, 0.95, 0.05), DVec3::new(0.1, 0.15, 0.08));
    add_mesh(&mut character, "bag", MeshKind::Accessory, &bag, hips);
    add_mesh(&mut character, "button", MeshKind::Garment, &ball(1.2, 0.02), chest);
    // The map alone: what keeps clothes out of the body pushes a button as it pushes cloth.
    let options = Options { repair: Repair::Off, ..Options::default() };
    let deformer = Deformer::new(Arc::new(character.clone()), &Style::Heads(2.5), &options).unwrap();
    let deformed = deformer.apply();
    for (mesh, result) in character.meshes.iter().zip(&deformed.meshes) {
        if !["bag", "button"].contains(&mesh.name.as_str()) {
            continue;
        }
        let [before, after] = [&mesh.positions, &result.positions]
            .map(|points| points.iter().map(|p| p.as_dvec3()).collect::<Vec<DVec3>>());
        let furthest = before
            .iter()
            .zip(&after)
            .max_by(|a, b| a.0.distance(before[0]).total_cmp(&b.0.distance(before[0])));
        let (from, to) = furthest.unwrap();
        let scale = to.distance(after[0]) / from.distance(before[0]);
        assert!(scale > 0.2 && scale < 1.0, "{}: {scale}", mesh.name);
        for (p, q) in before.iter().zip(&after) {
            let expected = after[0] + scale * (*p - before[0]);
            assert!(q.distance(expected) < 1e-6, "{}: {q} instead of {expected}", mesh.name);
        }
    }
}
