//! Figures whose head and trunk are one: a drop with limbs, a ball, an egg and a column, generated.

use crate::people::{Person, Ring, Shape};
use glam::{DVec3, Vec3};
use std::collections::BTreeMap;
use std::f64::consts::PI;
use std::sync::Arc;
use superdeform::{Character, Deformer, Mesh, MeshKind, Options, Role, Style, Weights};

/// Half the breadth at a share of the height, in halves of the greatest.
type Outline = fn(f64) -> f64;

const OUTLINES: [(&str, Outline); 4] = [
    ("drop", |t| (1.0 - t).sqrt() * (8.0 * t).min(1.0)),
    ("ball", |t| (PI * t).sin().sqrt()),
    ("egg", |t| (PI * t.powf(0.8)).sin().powf(0.6)),
    ("column", |t| (20.0 * t.min(1.0 - t)).min(1.0)),
];

/// A person's limbs on a trunk of such an outline, which its spine, neck and head move.
fn mascot(person: &Person, outline: Outline) -> Character {
    let mut character = person.build();
    let joints = &character.humanoid;
    let is_limb = |joint: u32| {
        let role = joints.iter().find(|&(_, of)| of == joint as usize).unwrap().0;
        role.chain().any(|role| {
            use Role::*;
            matches!(role, LeftUpperArm | RightUpperArm | LeftUpperLeg | RightUpperLeg)
        })
    };
    let mut body = character.meshes.swap_remove(0);
    let of_limb: Vec<bool> =
        (0..body.positions.len()).map(|vertex| is_limb(body.weights.row(vertex)[0].0)).collect();
    body.triangles.retain(|corners| corners.iter().all(|&vertex| of_limb[vertex as usize]));
    body.name = "limbs".to_string();
    let at = person.joints();
    let (low, high) = (at[&Role::LeftUpperLeg].y - 0.03, person.crown());
    let spine = [Role::Hips, Role::Spine, Role::Chest, Role::UpperChest, Role::Neck, Role::Head];
    let weights = |y: f64| -> Vec<(Role, f64)> {
        let above = spine.iter().position(|role| at[role].y > y).unwrap_or(spine.len());
        match above {
            0 => vec![(Role::Hips, 1.0)],
            _ if above == spine.len() => vec![(Role::Head, 1.0)],
            _ => {
                let [below, above] = [spine[above - 1], spine[above]];
                let share = (y - at[&below].y) / (at[&above].y - at[&below].y);
                vec![(below, 1.0 - share), (above, share)]
            }
        }
    };
    let rings: Vec<Ring> = (0..=48)
        .map(|ring| f64::from(ring) / 48.0)
        .map(|t| Ring {
            centre: DVec3::Y * (low + t * (high - low)),
            radius: if t == 0.0 || t == 1.0 { 0.0 } else { 0.28 * outline(t) },
            weights: weights(low + t * (high - low)),
        })
        .collect();
    let mut trunk = Shape::default();
    trunk.tube(DVec3::Y, &rings, true);
    let rows = trunk.weights.iter().map(|row| {
        let joint = |role: Role| joints.joint(role).unwrap() as u32;
        row.iter().map(|&(role, weight)| (joint(role), weight as f32)).collect::<BTreeMap<_, _>>()
    });
    let trunk = Mesh {
        name: "trunk".to_string(),
        kind: Some(MeshKind::Body),
        weights: Weights::from_rows(rows),
        normals: trunk.normals().into_iter().map(|n| n.as_vec3()).collect(),
        positions: trunk.positions.iter().map(|p| p.as_vec3()).collect(),
        triangles: trunk.triangles,
        ..Mesh::default()
    };
    character.meshes = vec![trunk, body];
    character
}

fn styles() -> Vec<Style> {
    let chibi = Style::of(&Person::chibi().build(), &Options::default()).unwrap();
    vec![chibi, Style::heads(2.0).unwrap(), Style::heads(2.5).unwrap(), Style::heads(4.0).unwrap()]
}

#[test]
fn head_and_trunk_stay_as_they_are_and_limbs_become_shorter() {
    let person = Person { eyes: false, blended: true, ..Person::adult() };
    for (name, outline) in OUTLINES {
        let character = Arc::new(mascot(&person, outline));
        let height = person.crown();
        for style in styles() {
            let deformer = Deformer::new(Arc::clone(&character), &style, &Options::default()).unwrap();
            let is_told = deformer.warnings().iter().any(|warning| warning.code == "trunk_kept");
            assert!(is_told, "{name}: {:?}", deformer.warnings());
            let result = deformer.apply();
            let [trunk, limbs] = [&character.meshes[0], &character.meshes[1]];
            let went: Vec<Vec3> = (result.meshes[0].positions.iter().zip(&trunk.positions))
                .map(|(to, from)| *to - *from)
                .collect();
            let off = went.iter().map(|way| f64::from(way.distance(went[0]))).fold(0.0, f64::max);
            assert!(off < 1e-5 * height, "{name}: the trunk changes by {off}");
            // It stands on shorter legs: of those of a chibi, a fifth to a half of what is above them.
            assert!(f64::from(-went[0].y) > 0.1 * height, "{name}: it comes down by {}", -went[0].y);
            let to = &result.meshes[1].positions;
            for corners in &limbs.triangles {
                let normal = |points: &[Vec3]| {
                    let [a, b, c] = corners.map(|vertex| points[vertex as usize]);
                    (b - a).cross(c - a)
                };
                let turn = normal(&limbs.positions).dot(normal(to));
                assert!(turn > -1e-12, "{name}: a triangle of a limb turned over: {corners:?}");
            }
        }
    }
}

#[test]
fn what_has_a_chin_or_a_neck_is_no_mascot() {
    for person in [Person::adult(), Person::chibi()] {
        let deformer =
            Deformer::new(Arc::new(person.build()), &Style::heads(2.0).unwrap(), &Options::default());
        let warnings = deformer.unwrap().warnings().to_vec();
        assert!(warnings.iter().all(|warning| warning.code != "trunk_kept"), "{warnings:?}");
    }
    // A peanut: no chin, and a waist between what is head and what is trunk.
    let person = Person { eyes: false, blended: true, ..Person::adult() };
    let peanut: Outline = |t| (PI * t).sin().sqrt() * (1.0 - 0.5 * (-((t - 0.72) / 0.06).powi(2)).exp());
    let deformer =
        Deformer::new(Arc::new(mascot(&person, peanut)), &Style::heads(2.0).unwrap(), &Options::default());
    let warnings = deformer.unwrap().warnings().to_vec();
    assert!(warnings.iter().all(|warning| warning.code != "trunk_kept"), "{warnings:?}");
}
