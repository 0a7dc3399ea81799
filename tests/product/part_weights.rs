//! `part_weights.rs` and `binding.rs`: what moves each vertex of a person made of tubes.

use crate::people::{Person, Ring, Shape};
use crate::tubes::{Tubes, add_mesh, blended, crowd, ellipsoid, fine, mirrored_weights};
use glam::DVec3;
use std::collections::HashMap;
use superdeform::internals::shape::product::binding::{PartBinding, joint_binding};
use superdeform::internals::shape::product::part::Part;
use superdeform::{Character, Mesh, MeshKind, Role, Weights};

fn share(tubes: &Tubes, vertex: usize, part: Part) -> f32 {
    tubes.weights(vertex)[part as usize]
}

#[test]
fn weights_sum_to_one_and_none_is_negative() {
    for tubes in crowd() {
        for binding in &tubes.bindings.vertices {
            let sum: f32 = binding.weights.iter().sum();
            assert!((sum - 1.0).abs() < 1e-5, "{sum}: {:?}", tubes.person);
            assert!(
                binding.weights.iter().all(|&weight| (0.0..=1.0 + 1e-6).contains(&weight)),
                "{binding:?}"
            );
        }
    }
}

#[test]
fn the_middle_of_a_limb_moves_with_its_part_and_a_joint_with_both() {
    let tubes = Tubes::of(fine());
    for (index, limb) in tubes.anatomy.limbs.iter().enumerate() {
        let [first, second, last] = limb.parts;
        let mut rings = [0; 3];
        for (vertex, &p) in tubes.figure.positions.iter().enumerate() {
            // Around the limb: within 8 cm of its axis.
            let near = |q: DVec3, along: f64| {
                p.distance(q) < 0.08 && (p - q).dot(limb.end - limb.root).abs() < along
            };
            let weights = tubes.weights(vertex);
            if near(limb.root.lerp(limb.middle, 0.5), 0.005) && weights[first] > 0.1 {
                assert!(weights[first] > 0.95, "limb {index}: {weights:?}");
                rings[0] += 1;
            }
            if near(limb.middle.lerp(limb.end, 0.5), 0.005) && weights[second] > 0.1 {
                assert!(weights[second] > 0.95, "limb {index}: {weights:?}");
                rings[1] += 1;
            }
            if near(limb.middle, 0.002) && weights[first] + weights[second] > 0.5 {
                assert!((weights[first] - weights[second]).abs() < 0.2, "limb {index}: {weights:?}");
                rings[2] += 1;
            }
            assert!(
                p.distance(limb.end) < 0.15 || p.distance(limb.root) > 0.3 || weights[last] < 0.05,
                "{weights:?}"
            );
        }
        assert!(rings.iter().all(|&count| count >= 48), "limb {index}: {rings:?}");
    }
}

#[test]
fn head_face_and_hair_move_as_one_and_hold_what_they_touch() {
    let person = Person { blended: true, ..Person::adult() };
    let mut character = person.build();
    let head = character.humanoid.joint(Role::Head).unwrap();
    let hair = ellipsoid(DVec3::Y * (person.crown() - 0.02), DVec3::new(0.1, 0.07, 0.1));
    add_mesh(&mut character, "hair", MeshKind::Hair, &hair, head);
    let tubes = Tubes::of_character(person.clone(), character);
    for vertex in tubes.mesh("hair") {
        assert_eq!(*tubes.weights(vertex), Part::Hair.alone());
    }
    for vertex in tubes.mesh("left_eye") {
        assert_eq!(*tubes.weights(vertex), Part::Head.alone());
    }
    let is_skull = |p: DVec3| p.y > person.chin() + 0.02 && p.with_y(0.0).length() > 0.06;
    let mut skull = 0;
    for vertex in tubes.mesh("body").filter(|&vertex| is_skull(tubes.figure.positions[vertex])) {
        assert_eq!(*tubes.weights(vertex), Part::Head.alone());
        skull += 1;
    }
    assert!(skull > 500);
}

/// A tube from `bottom` to `top` around the vertical through (x, z), of `radius`, its rings weighted as `role` says of
/// their height; the lower end is the spine's, so that the head alone does not move it.
fn column([x, z]: [f64; 2], bottom: f64, top: f64, radius: f64, role: Role) -> Shape {
    let mut shape = Shape { columns: 24, ..Shape::default() };
    let count = 80;
    let rings: Vec<Ring> = (0..=count)
        .map(|ring| f64::from(ring) / f64::from(count))
        .map(|t| Ring {
            centre: DVec3::new(x, bottom + t * (top - bottom), z),
            radius: if t == 0.0 || t == 1.0 { 0.0 } else { radius },
            weights: vec![(if t < 0.1 { Role::Spine } else { role }, 1.0)],
        })
        .collect();
    shape.tube(DVec3::Y, &rings, true);
    shape
}

fn add_column(character: &mut Character, name: &str, shape: &Shape) {
    let rows: Vec<Vec<(u32, f32)>> = shape
        .weights
        .iter()
        .map(|row| {
            row.iter().map(|&(role, w)| (character.humanoid.joint(role).unwrap() as u32, w as f32)).collect()
        })
        .collect();
    character.meshes.push(Mesh {
        name: name.to_string(),
        kind: Some(MeshKind::Body),
        weights: Weights::from_rows(rows),
        normals: shape.normals().into_iter().map(|n| n.as_vec3()).collect(),
        positions: shape.positions.iter().map(|p| p.as_vec3()).collect(),
        triangles: shape.triangles.clone(),
        ..Mesh::default()
    });
}

#[test]
fn head_and_neck_part_at_a_plane_from_chin_to_nape_whatever_the_file_says() {
    let person = Person { blended: true, ..Person::adult() };
    let (low, high) = (person.shoulder_line() - 0.15, person.crown() - 0.01);
    for role in [Role::Neck, Role::Head] {
        let mut character = person.build();
        for (name, z) in [("front", 0.06), ("back", -0.09)] {
            add_column(&mut character, name, &column([0.0, z], low, high, 0.01, role));
        }
        let tubes = Tubes::of_character(person.clone(), character);
        let heights = tubes.anatomy.landmarks.heights;
        let length = heights.head_length();
        for (vertex, name) in
            ["front", "back"].into_iter().flat_map(|name| tubes.mesh(name).map(move |vertex| (vertex, name)))
        {
            let above = (tubes.figure.positions[vertex].y - heights.chin) / length;
            let head = share(&tubes, vertex, Part::Head);
            // At the front the plane passes just under the chin, at the back 0.22 L above it; weights go over within 0.2 L
            // below it, and smoothing adds a tenth of L or so.
            let (all, none) = if name == "front" { (0.2, -0.4) } else { (0.45, -0.15) };
            if above > all {
                assert!(head > 0.97, "{name} {above}: {:?}", tubes.weights(vertex));
            }
            if above < none {
                assert!(head < 0.03, "{name} {above}: {:?}", tubes.weights(vertex));
            }
        }
    }
}

#[test]
fn hair_of_one_mesh_with_the_body_is_known_by_how_far_out_it_hangs() {
    let person = Person { blended: true, ..Person::adult() };
    let (low, high) = (person.shoulder_line() - 0.5, person.crown() - 0.01);
    let mut character = person.build();
    // L is 0.23 or so: more than half of it out, behind and to the side; and before the neck, where the head moves what no hair is. All
    // further than the smoothing reaches from the trunk's 0.13 and the shoulders' 0.045.
    for (name, at) in [("side", [0.14, -0.2]), ("behind", [0.0, -0.25]), ("front", [0.05, 0.25])] {
        add_column(&mut character, name, &column(at, low, high, 0.01, Role::Head));
    }
    let tubes = Tubes::of_character(person.clone(), character);
    let heights = tubes.anatomy.landmarks.heights;
    for (name, part) in [("side", Part::Hair), ("behind", Part::Hair), ("front", Part::Neck)] {
        let mut count = 0;
        for vertex in tubes.mesh(name) {
            let y = tubes.figure.positions[vertex].y;
            if y < heights.chin - 0.15 && y > low + 0.25 {
                assert!(share(&tubes, vertex, part) > 0.95, "{name} {y}: {:?}", tubes.weights(vertex));
                count += 1;
            }
        }
        assert!(count > 24, "{name}: {count}");
    }
}

#[test]
fn a_piece_of_the_head_that_hangs_to_the_shoulders_is_hair() {
    let person = Person { blended: true, ..Person::adult() };
    let mut character = person.build();
    let head = character.humanoid.joint(Role::Head).unwrap();
    let plait = |bottom: f64| {
        let top = person.chin() + 0.1;
        ellipsoid(DVec3::new(0.0, 0.5 * (top + bottom), -0.12), DVec3::new(0.02, 0.5 * (top - bottom), 0.02))
    };
    add_mesh(&mut character, "long", MeshKind::Body, &plait(person.shoulder_line() - 0.1), head);
    let mut short = plait(person.shoulder_line() + 0.03);
    short.positions.iter_mut().for_each(|p| p.x += 0.1);
    add_mesh(&mut character, "short", MeshKind::Body, &short, head);
    let tubes = Tubes::of_character(person, character);
    assert!(tubes.mesh("long").all(|vertex| *tubes.weights(vertex) == Part::Hair.alone()));
    assert!(tubes.mesh("short").all(|vertex| *tubes.weights(vertex) == Part::Head.alone()));
}

#[test]
fn hands_and_feet_without_a_joint_begin_where_wrist_and_ankle_are_placed() {
    use Role::*;
    let without = vec![LeftHand, RightHand, LeftFoot, RightFoot, LeftToes, RightToes];
    let tubes = Tubes::of(Person { without, ..fine() });
    for (index, limb) in tubes.anatomy.limbs.iter().enumerate() {
        let [_, second, last] = limb.parts;
        let along = limb.end - limb.middle;
        let (mut before, mut after) = (0, 0);
        for (vertex, &p) in tubes.figure.positions.iter().enumerate() {
            let weights = tubes.weights(vertex);
            if weights[second] + weights[last] < 0.9 {
                continue;
            }
            // In lengths of the lower part; weights go over within a tenth of it on both sides, and smoothing adds 8 cm.
            let past = (p - limb.end).dot(along) / along.length_squared();
            let far = 0.1 + 0.08 / along.length();
            if past > far {
                assert!(weights[last] > 0.93, "{past}: {weights:?}");
                after += 1;
            } else if past < -far {
                assert!(weights[last] < 0.07, "{past}: {weights:?}");
                before += 1;
            } else if past.abs() < 0.01 {
                assert!((weights[last] - 0.5).abs() < 0.25, "{past}: {weights:?}");
            }
        }
        // Feet turn forward: they reach no further than the ankle's height past it.
        assert!(before > 100 && (after > 20 || index >= 2), "{before} {after}");
    }
}

#[test]
fn near_the_ground_a_leg_is_foot_alone() {
    // Boots that the file gives to the shins.
    let person = fine();
    let mut character = person.build();
    let joint = |role: Role| character.humanoid.joint(role).unwrap() as u32;
    let boots = HashMap::from([
        (joint(Role::LeftFoot), joint(Role::LeftLowerLeg)),
        (joint(Role::LeftToes), joint(Role::LeftLowerLeg)),
        (joint(Role::RightFoot), joint(Role::RightLowerLeg)),
        (joint(Role::RightToes), joint(Role::RightLowerLeg)),
    ]);
    let body = &mut character.meshes[0];
    let rows: Vec<Vec<(u32, f32)>> = (0..body.positions.len())
        .map(|vertex| {
            body.weights.row(vertex).iter().map(|&(j, w)| (*boots.get(&j).unwrap_or(&j), w)).collect()
        })
        .collect();
    body.weights = Weights::from_rows(rows);
    let tubes = Tubes::of_character(person, character);
    let (mut soles, mut uppers) = (0, 0);
    for (vertex, &p) in tubes.figure.positions.iter().enumerate() {
        let (foot, shin) = match p.x > 0.0 {
            true => (Part::LeftFoot, Part::LeftLowerLeg),
            false => (Part::RightFoot, Part::RightLowerLeg),
        };
        // The ankles are 7 cm high: below 0.15 of that all is foot, above 0.7 the file's weights stay.
        if p.y < 0.15 * 0.07 {
            assert!((share(&tubes, vertex, foot) - 1.0).abs() < 1e-5, "{p}: {:?}", tubes.weights(vertex));
            soles += 1;
        } else if p.y > 0.7 * 0.07 && p.y < 0.15 {
            assert!(share(&tubes, vertex, shin) > 0.99, "{p}: {:?}", tubes.weights(vertex));
            uppers += 1;
        }
    }
    assert!(soles > 50 && uppers > 50, "{soles} {uppers}");
}

#[test]
fn the_other_side_weighs_the_same() {
    let tubes = blended();
    let key = |p: DVec3| (p * 1e5).round().to_array().map(|x| x as i64);
    let vertices: HashMap<[i64; 3], usize> =
        tubes.figure.positions.iter().enumerate().map(|(vertex, &p)| (key(p), vertex)).collect();
    let mut pairs = 0;
    for (vertex, &p) in tubes.figure.positions.iter().enumerate() {
        let Some(&other) = vertices.get(&key(DVec3::new(-p.x, p.y, p.z))) else { continue };
        let expected = mirrored_weights(tubes.weights(vertex));
        let off = tubes.weights(other).iter().zip(expected).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
        assert!(off < 0.02, "{p}: {off}");
        pairs += 1;
    }
    assert!(2 * pairs > tubes.figure.positions.len(), "{pairs}");
}

#[test]
fn joints_without_a_role_fold_into_their_part_and_those_of_the_head_into_hair() {
    let person = Person::adult();
    let mut character = person.build();
    let mut add = |parent: Role| {
        let parent = character.humanoid.joint(parent).unwrap();
        let rest = character.skeleton.joints[parent].rest;
        character.skeleton.joints.push(superdeform::Joint {
            name: "helper".into(),
            parent: Some(parent),
            rest,
        });
        character.skeleton.joints.len() - 1
    };
    let (twist, plait) = (add(Role::LeftLowerArm), add(Role::Head));
    let tubes = Tubes::of_character(person, character);
    let binding = |joint: usize| joint_binding(&tubes.figure, &tubes.bindings, joint);
    assert_eq!(binding(twist), PartBinding::to(Part::LeftLowerArm));
    assert_eq!(binding(plait), PartBinding::to(Part::Hair));
    let head = tubes.figure.humanoid.joint(Role::Head).unwrap();
    assert_eq!(binding(head), PartBinding::to(Part::Head));
}
