//! `mirror.rs` and the joints of arms: a symmetric figure with a rig that is not, made super-deformed.

use crate::people::{Person, Shape};
use crate::tubes::{add_mesh, ellipsoid};
use glam::{DMat4, DVec3};
use std::sync::Arc;
use superdeform::internals::geometry::weld::{SEAM, weld};
use superdeform::internals::shape::figure::Figure;
use superdeform::internals::shape::product::mirror::Mirror;
use superdeform::{Character, Deformer, Joint, MeshKind, Options, Role, Style};

const STYLES: [f64; 2] = [2.0, 2.5];

fn person() -> Person {
    Person { blended: true, arm_angle: 20.0, ..Person::adult() }
}

fn joint(character: &Character, role: Role) -> usize {
    character.humanoid.joint(role).unwrap()
}

fn place(character: &Character, role: Role) -> DVec3 {
    character.skeleton.joints[joint(character, role)].position()
}

/// A person whose elbow, wrist and knee of one side lie a centimetre or two beside the middle of the limb.
fn askew() -> Character {
    let mut character = person().build();
    for (role, by) in [
        (Role::LeftLowerArm, DVec3::new(0.02, 0.012, 0.01)),
        (Role::LeftHand, DVec3::new(-0.01, 0.01, 0.0)),
        (Role::RightLowerLeg, DVec3::new(0.015, 0.01, -0.01)),
    ] {
        let joint = joint(&character, role);
        let rest = &mut character.skeleton.joints[joint].rest;
        *rest = DMat4::from_translation(by) * *rest;
    }
    character
}

fn deformed(character: &Character, heads: f64) -> (Vec<DVec3>, Vec<DVec3>) {
    let style = Style::heads(heads).unwrap();
    let deformed = Deformer::new(Arc::new(character.clone()), &style, &Options::default()).unwrap().apply();
    let vertices = deformed.meshes.iter().flat_map(|mesh| &mesh.positions).map(|p| p.as_dvec3()).collect();
    (vertices, deformed.joints)
}

fn rest(character: &Character) -> Vec<DVec3> {
    character.meshes.iter().flat_map(|mesh| &mesh.positions).map(|p| p.as_dvec3()).collect()
}

/// The furthest that the mirror image of any of `after` is from where the vertex goes that was at its image before, metres.
fn asymmetry(before: &[DVec3], after: &[DVec3]) -> f64 {
    let image = |p: DVec3| p.with_x(-p.x);
    let off = |(&p, &to): (&DVec3, &DVec3)| {
        let nearest = before
            .iter()
            .zip(after)
            .min_by(|one, other| one.0.distance(image(p)).total_cmp(&other.0.distance(image(p))));
        let (twin, twin_to) = nearest.unwrap();
        assert!(twin.distance(image(p)) < 1e-6, "{p} has no twin");
        image(to).distance(*twin_to)
    };
    before.iter().zip(after).map(off).fold(0.0, f64::max)
}

/// The first `count` vertices of `character` stay each other's image.
fn stay_symmetric(character: &Character, count: usize) {
    let before = rest(character);
    for heads in STYLES {
        let (after, _) = deformed(character, heads);
        let off = asymmetry(&before[..count], &after[..count]);
        // Twice what a float of a metre rounds.
        assert!(off < 1e-6, "{heads}: {off}");
    }
}

#[test]
fn a_symmetric_figure_with_a_rig_that_is_not_stays_symmetric() {
    let character = askew();
    stay_symmetric(&character, rest(&character).len());
}

/// The same with a pouch on one side.
fn with_pouch() -> Character {
    let mut character = askew();
    let hips = joint(&character, Role::Hips);
    let pouch = ellipsoid(DVec3::new(0.15, 1.0, 0.0), DVec3::new(0.03, 0.05, 0.04));
    add_mesh(&mut character, "pouch", MeshKind::Body, &pouch, hips);
    character
}

#[test]
fn what_hangs_on_one_side_goes_as_what_is_beside_it() {
    stay_symmetric(&with_pouch(), rest(&askew()).len());
}

#[test]
fn how_often_seams_repeat_a_vertex_does_not_matter() {
    let character = with_pouch();
    let mut split = character.clone();
    for mesh in &mut split.meshes {
        let corners: Vec<u32> = mesh.triangles.iter().flatten().copied().collect();
        let rows: Vec<Vec<(u32, f32)>> = mesh.weights.rows().map(<[(u32, f32)]>::to_vec).collect();
        mesh.weights = superdeform::Weights::from_rows(corners.iter().map(|&v| rows[v as usize].clone()));
        mesh.normals = corners.iter().map(|&v| mesh.normals[v as usize]).collect();
        mesh.positions = corners.iter().map(|&v| mesh.positions[v as usize]).collect();
        mesh.triangles = (0..corners.len() as u32 / 3).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect();
    }
    let (whole, apart) = (deformed(&character, 2.5).0, deformed(&split, 2.5).0);
    let mut start = (0, 0);
    for mesh in &character.meshes {
        for (at, &corner) in mesh.triangles.iter().flatten().enumerate() {
            let off = whole[start.0 + corner as usize].distance(apart[start.1 + at]);
            assert!(off < 1e-5 * person().head_top(), "{}: {off}", mesh.name);
        }
        start = (start.0 + mesh.positions.len(), start.1 + 3 * mesh.triangles.len());
    }
}

#[test]
fn a_figure_that_leans_is_not_symmetric() {
    let mut character = person().build();
    let is_symmetric = |character: &Character| {
        let figure = Figure::of(character).unwrap();
        let weld = weld(&figure.positions, SEAM * figure.height());
        Mirror::of(&figure, &weld, |_| None::<u32>, 1).is_some()
    };
    assert!(is_symmetric(&character));
    for p in character.meshes.iter_mut().flat_map(|mesh| &mut mesh.positions) {
        p.x += 0.05 * p.y;
    }
    assert!(!is_symmetric(&character));
}

#[test]
fn arms_keep_their_angles_and_twist_bones_their_share_of_the_way() {
    let mut character = askew();
    let (elbow, wrist) = (place(&character, Role::LeftLowerArm), place(&character, Role::LeftHand));
    let share = 0.4;
    character.skeleton.joints.push(Joint {
        name: "twist".into(),
        parent: Some(joint(&character, Role::LeftLowerArm)),
        rest: DMat4::from_translation(elbow.lerp(wrist, share)),
    });
    // It turns the half of the forearm that is next to the hand.
    let twist = character.skeleton.joints.len() as u32 - 1;
    let lower = joint(&character, Role::LeftLowerArm) as u32;
    let body = &mut character.meshes[0];
    let rows: Vec<Vec<(u32, f32)>> = body
        .weights
        .rows()
        .zip(&body.positions)
        .map(|(row, p)| {
            let far = (p.as_dvec3() - elbow).dot(wrist - elbow) > 0.5 * (wrist - elbow).length_squared();
            row.iter()
                .map(|&(joint, weight)| (if far && joint == lower { twist } else { joint }, weight))
                .collect()
        })
        .collect();
    body.weights = superdeform::Weights::from_rows(rows);
    for heads in STYLES {
        let (_, joints) = deformed(&character, heads);
        let at = |role: Role| joints[joint(&character, role)];
        for left in [true, false] {
            let side = |role: Role| if left { role } else { role.mirrored() };
            for (from, to) in [(Role::LeftUpperArm, Role::LeftLowerArm), (Role::LeftLowerArm, Role::LeftHand)]
            {
                let before = place(&character, side(to)) - place(&character, side(from));
                let degrees = before.angle_between(at(side(to)) - at(side(from))).to_degrees();
                assert!(degrees < 0.1, "{heads}: {} turns by {degrees}", side(from));
            }
        }
        let bone = at(Role::LeftHand) - at(Role::LeftLowerArm);
        let along = joints[twist as usize] - at(Role::LeftLowerArm);
        let off = along - share * bone;
        assert!(off.length() < 0.01 * bone.length(), "{heads}: {off}");
    }
}

/// Extents along the axes.
fn size(points: &[DVec3]) -> DVec3 {
    let (low, high) = points
        .iter()
        .fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), &p| (low.min(p), high.max(p)));
    high - low
}

/// The person with a mesh of no kind that one joint moves, and how much its extents differ in how they grow.
fn stretched(shape: &Shape, role: Role, heads: f64) -> f64 {
    let mut character = person().build();
    let joint = joint(&character, role);
    let body = rest(&character).len();
    add_mesh(&mut character, "thing", MeshKind::Body, shape, joint);
    let (before, after) = (rest(&character), deformed(&character, heads).0);
    let grown = size(&after[body..]) / size(&before[body..]);
    grown.max_element() / grown.min_element()
}

#[test]
fn a_backpack_and_a_plate_keep_their_shape_and_what_goes_round_a_bone_does_not() {
    let person = person();
    let back = ellipsoid(DVec3::new(0.0, 1.25, -0.22), DVec3::new(0.12, 0.16, 0.08));
    let elbow = person.joints()[&Role::LeftLowerArm];
    let plate = ellipsoid(elbow + DVec3::new(-0.08, 0.08, 0.0), DVec3::new(0.06, 0.02, 0.05));
    let ring = ellipsoid(DVec3::new(0.0, 1.1, 0.0), DVec3::new(0.16, 0.06, 0.16));
    for heads in STYLES {
        for (name, shape, role) in [("backpack", &back, Role::Chest), ("plate", &plate, Role::LeftUpperArm)] {
            let stretched = stretched(shape, role, heads);
            assert!(stretched < 1.001, "{heads}: {name} {stretched}");
        }
        let ring = stretched(&ring, Role::Spine, heads);
        assert!(ring > 1.2, "{heads}: {ring}");
    }
}
