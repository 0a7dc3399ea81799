//! One test for each numbered equation of the paper, worked by hand; then what follows from several of them together.

#[path = "common/people.rs"]
mod people;

use glam::{DMat3, DVec3};
use people::{COLUMNS, Person, Shape};
use std::collections::{BTreeMap, BTreeSet};
use superdeform::internals::character::bones::{Bone, Group, HEAD_TOP, bones};
use superdeform::internals::face::{FaceMap, SphereMap, bearable_squash, f2, f2_slope, f4, f4_slope};
use superdeform::internals::geometry::Surface;
use superdeform::internals::shape::measure::radius;
use superdeform::internals::shape::paper::bone_field::{FieldBone, shares};
use superdeform::internals::shape::{BoneField, coefficients, head_top, measure, shorten};
use superdeform::{
    BodyShape, BoneShape, Coefficient, Error, ErrorKind, FaceCurve, GroupSettings, MeshKind, Role, Stage,
};

fn close(a: f64, b: f64) -> bool {
    (a - b).abs() < 1e-12 * a.abs().max(b.abs()).max(1.0)
}

fn near(a: DVec3, b: DVec3) -> bool {
    a.distance(b) < 1e-12
}

fn found(roles: impl IntoIterator<Item = Role>) -> Vec<Bone> {
    bones(&roles.into_iter().collect(), &BTreeMap::new())
}

fn scales(groups: &[(&str, f64, f64)]) -> BTreeMap<String, Coefficient> {
    let entry = |&(group, length_scale, thickness_scale): &(&str, f64, f64)| {
        let coefficient = Coefficient { length_scale, thickness_scale };
        (group.to_string(), coefficient)
    };
    groups.iter().map(entry).collect()
}

/// A body with these bones: key, length, radius.
fn body(bones: &[(&str, f64, Option<f64>)]) -> BodyShape {
    let bones: BTreeMap<String, BoneShape> =
        bones.iter().map(|&(key, length, radius)| (key.to_string(), BoneShape { length, radius })).collect();
    BodyShape { head_length: bones[HEAD_TOP].length, bones, ..BodyShape::default() }
}

fn settle(target: &BodyShape, reference: &BodyShape) -> superdeform::internals::shape::Coefficients {
    coefficients(target, reference, 1.5, &BTreeMap::new(), &BTreeMap::new()).unwrap()
}

/// A bone from the origin to (0, 2, 0) that keeps its parent and is halved.
fn halved(thickness_scale: f64) -> BoneField {
    BoneField {
        bones: vec![FieldBone {
            joint: Role::LeftLowerArm,
            parent: DVec3::ZERO,
            child: DVec3::new(0.0, 2.0, 0.0),
            new_parent: DVec3::ZERO,
            new_child: DVec3::new(0.0, 1.0, 0.0),
            thickness_scale,
        }],
    }
}

#[test]
fn eq_01_a_bone_is_scaled_from_its_parent() {
    let joints =
        BTreeMap::from([(Role::Hips, DVec3::new(0.0, 1.0, 0.0)), (Role::Spine, DVec3::new(0.5, 2.0, 0.25))]);
    let bones = found(joints.keys().copied());
    let result = shorten(&bones, &joints, DVec3::ZERO, &scales(&[("torso", 0.4, 1.0)]));
    assert!(near(result.joints[&Role::Hips], DVec3::new(0.0, 1.0, 0.0)));
    assert!(near(result.joints[&Role::Spine], DVec3::new(0.2, 1.4, 0.1)));
}

#[test]
fn eq_02_what_hangs_from_a_joint_moves_with_it() {
    let joints = BTreeMap::from([
        (Role::Hips, DVec3::ZERO),
        (Role::LeftUpperLeg, DVec3::new(0.1, 0.0, 0.0)),
        (Role::LeftLowerLeg, DVec3::new(0.1, -0.4, 0.0)),
        (Role::LeftFoot, DVec3::new(0.1, -0.8, 0.05)),
    ]);
    let bones = found(joints.keys().copied());
    let groups = scales(&[("hip", 1.0, 1.0), ("upper_leg", 0.5, 1.0), ("lower_leg", 1.0, 1.0)]);
    let result = shorten(&bones, &joints, DVec3::ZERO, &groups);
    // The knee rises by 0.2; the shin keeps its length, so the foot rises by as much.
    assert!(near(result.joints[&Role::LeftFoot], DVec3::new(0.1, -0.6, 0.05)));
}

#[test]
fn eq_03_displacements_add_up_along_a_chain() {
    let joints = BTreeMap::from([
        (Role::Hips, DVec3::ZERO),
        (Role::LeftUpperLeg, DVec3::new(0.1, 0.0, 0.0)),
        (Role::LeftLowerLeg, DVec3::new(0.1, -0.4, 0.0)),
        (Role::LeftFoot, DVec3::new(0.1, -0.8, 0.0)),
    ]);
    let bones = found(joints.keys().copied());
    let groups = scales(&[("hip", 0.5, 1.0), ("upper_leg", 0.5, 1.0), ("lower_leg", 0.25, 1.0)]);
    let result = shorten(&bones, &joints, DVec3::ZERO, &groups);
    let moved = |role: Role| result.joints[&role] - joints[&role];
    assert!(near(moved(Role::LeftUpperLeg), DVec3::new(-0.05, 0.0, 0.0)));
    assert!(near(moved(Role::LeftLowerLeg), DVec3::new(-0.05, 0.2, 0.0)));
    assert!(near(moved(Role::LeftFoot), DVec3::new(-0.05, 0.5, 0.0)));
}

#[test]
fn eq_04_only_the_head_is_enlarged() {
    let joints = BTreeMap::from([(Role::Hips, DVec3::ZERO), (Role::Head, DVec3::new(0.0, 0.6, 0.0))]);
    let bones = found(joints.keys().copied());
    let groups = scales(&[("torso", 0.5, 1.0), ("head", 1.5, 1.5)]);
    let result = shorten(&bones, &joints, DVec3::new(0.0, 0.8, 0.0), &groups);
    assert!(near(result.joints[&Role::Head], DVec3::new(0.0, 0.3, 0.0)));
    assert!(near(result.head_top, DVec3::new(0.0, 0.6, 0.0)));
}

#[test]
fn eq_05_a_vertex_follows_the_joints_of_its_bones() {
    let field = halved(1.0);
    let at = |y: f64| field.displace(DVec3::new(0.3, y, 0.0), &[(0, 1.0)], Stage::Length);
    assert!(near(at(1.0), DVec3::new(0.3, 0.5, 0.0)));
    assert!(near(at(0.5), DVec3::new(0.3, 0.25, 0.0)));
    // Beyond the ends a vertex moves rigidly with the joint.
    assert!(near(at(2.5), DVec3::new(0.3, 1.5, 0.0)));
    assert!(near(at(-0.5), DVec3::new(0.3, -0.5, 0.0)));
    // Half the weight, half the way.
    let half = field.displace(DVec3::new(0.3, 1.0, 0.0), &[(0, 0.5)], Stage::Length);
    assert!(near(half, DVec3::new(0.3, 0.75, 0.0)));
}

#[test]
fn eq_06_the_parent_joint_moves_its_vertices_fully() {
    let (parent, child) = (DVec3::ZERO, DVec3::new(0.0, 4.0, 0.0));
    assert_eq!(shares(DVec3::new(7.0, 0.0, 0.0), parent, child).0, 1.0);
    assert_eq!(shares(DVec3::new(7.0, 1.0, 0.0), parent, child).0, 0.75);
    assert_eq!(shares(DVec3::new(7.0, 9.0, 0.0), parent, child).0, 0.0);
    assert_eq!(shares(DVec3::ONE, parent, parent).0, 1.0);
}

#[test]
fn eq_07_the_child_joint_moves_its_vertices_fully() {
    let (parent, child) = (DVec3::ZERO, DVec3::new(0.0, 4.0, 0.0));
    assert_eq!(shares(DVec3::new(0.0, 4.0, 2.0), parent, child).1, 1.0);
    assert_eq!(shares(DVec3::new(0.0, 1.0, 2.0), parent, child).1, 0.25);
    assert_eq!(shares(DVec3::new(0.0, -1.0, 2.0), parent, child).1, 0.0);
    assert_eq!(shares(DVec3::ONE, parent, parent).1, 0.0);
}

#[test]
fn eq_08_a_vertex_moves_toward_the_foot_on_its_bone() {
    let field = halved(0.6);
    // Eq. 5 gives (0.5, 0.5, 0), whose foot is (0, 0.5, 0): 0.4 of the way toward it.
    let v = field.displace(DVec3::new(0.5, 1.0, 0.0), &[(0, 1.0)], Stage::Thickness);
    assert!(near(v, DVec3::new(0.3, 0.5, 0.0)));
    let v = field.displace(DVec3::new(0.5, 3.0, 0.0), &[(0, 1.0)], Stage::Thickness);
    assert!(near(v, DVec3::new(0.3, 1.6, 0.0)));
}

#[test]
fn eq_09_the_head_ratio_is_the_enlarged_head_over_the_reference_head() {
    let target = body(&[(HEAD_TOP, 0.24, None)]);
    assert!(close(settle(&target, &body(&[(HEAD_TOP, 0.5, None)])).head_ratio, 0.72));
    // The same reference in centimetres.
    assert!(close(settle(&target, &body(&[(HEAD_TOP, 50.0, None)])).head_ratio, 0.0072));
}

#[test]
fn eq_10_a_group_takes_the_reference_length_over_the_head() {
    let target = body(&[
        (HEAD_TOP, 0.2, None),
        ("leftUpperLeg", 0.1, None),
        ("leftLowerLeg", 0.4, None),
        ("rightUpperLeg", 0.1, None),
        ("rightLowerLeg", 0.5, None),
    ]);
    let reference = body(&[
        (HEAD_TOP, 0.3, None),
        ("leftUpperLeg", 0.05, None),
        ("leftLowerLeg", 0.1, None),
        ("rightUpperLeg", 0.05, None),
        ("rightLowerLeg", 0.17, None),
    ]);
    // g = 1; the group's total lengths are 0.27 and 0.9.
    let result = settle(&target, &reference);
    assert!(close(result.groups["upper_leg"].length_scale, 0.3));
    // eta = 0.2: 1 + 0.2 (0.5 - 1).
    assert!(close(result.groups["hip"].length_scale, 0.9));
    assert!(close(result.groups["hip"].thickness_scale, 1.0));
}

#[test]
fn eq_11_a_group_takes_the_reference_radius_over_the_head() {
    let target = body(&[
        (HEAD_TOP, 0.2, None),
        ("leftUpperLeg", 0.1, Some(0.2)),
        ("leftLowerLeg", 0.4, Some(0.08)),
        ("leftFoot", 0.4, None),
    ]);
    let reference = body(&[
        (HEAD_TOP, 0.3, None),
        ("leftUpperLeg", 0.1, Some(0.1)),
        ("leftLowerLeg", 0.1, Some(0.06)),
        ("leftFoot", 0.1, Some(0.05)),
    ]);
    let result = settle(&target, &reference);
    assert!(close(result.groups["upper_leg"].thickness_scale, 0.75));
    // phi = 0.
    assert!(close(result.groups["hip"].thickness_scale, 1.0));
    // Never measured on the target: as it was, and said so.
    assert!(close(result.groups["lower_leg"].thickness_scale, 1.0));
    let codes: Vec<&str> = result.warnings.iter().map(|warning| warning.code).collect();
    assert_eq!(codes, ["radius_missing"]);
}

#[test]
fn eq_12_f2_squashes_and_keeps_the_ends() {
    for squash in [-0.9, 0.0, 0.4, 0.8, 3.0] {
        assert!(close(f2(-0.5, squash), -0.5) && close(f2(0.5, squash), 0.5));
    }
    assert!(close(f2(0.0, 0.8), -0.2));
    assert!(close(f2(0.25, 0.8), 0.25 - 0.8 * 0.1875));
}

#[test]
fn eq_13_f4_squashes_less_and_keeps_the_ends() {
    for squash in [-1.9, 0.0, 0.8, 1.9, 3.0] {
        assert!(close(f4(-0.5, squash), -0.5) && close(f4(0.5, squash), 0.5));
    }
    assert!(close(f4(0.0, 0.8), -0.05));
    assert!(close(f4(0.25, 0.8), 0.25 - 0.8 * 0.05859375));
}

#[test]
fn the_proportions_of_the_reference_are_reached_exactly() {
    let legs = |head: f64, thigh: f64| {
        body(&[(HEAD_TOP, head, None), ("leftUpperLeg", 0.1, None), ("leftLowerLeg", thigh, None)])
    };
    let (target, reference) = (legs(0.24, 0.42), legs(0.50, 0.14));
    let result = settle(&target, &reference);
    let alpha = result.groups["upper_leg"].length_scale;
    assert!(close(result.head_ratio, 0.72));
    assert!(close(alpha, 0.24));
    assert!(close(alpha * 0.42, 0.1008));
    assert!(close(alpha * 0.42 / (1.5 * 0.24), 0.14 / 0.50));
    // Metres or centimetres, on either side.
    for (target, reference) in [(legs(24.0, 42.0), reference), (target, legs(50.0, 14.0))] {
        assert!(close(settle(&target, &reference).groups["upper_leg"].length_scale, alpha));
    }
}

#[test]
fn shoulders_hips_hands_and_feet_have_the_constants_of_the_paper() {
    let keys = [
        "leftUpperLeg",
        "leftLowerLeg",
        "leftFoot",
        "leftToes",
        "neck",
        "head",
        "leftShoulder",
        "leftUpperArm",
        "leftLowerArm",
        "leftHand",
        "leftIndexProximal",
        "leftIndexIntermediate",
    ];
    let all = |length: f64, radius: f64| {
        let mut bones: Vec<_> = keys.iter().map(|&key| (key, length, Some(radius))).collect();
        bones.push((HEAD_TOP, 0.3, None));
        body(&bones)
    };
    // g = 1.5: lengths ask for 0.6, radii for 0.3.
    let result = settle(&all(1.0, 1.0), &all(0.4, 0.2));
    let expected = [
        ("head", 1.5, 1.5),
        ("neck", 0.6, 0.3),
        ("torso", 0.6, 0.3),
        ("shoulder", 0.92, 1.0),
        ("upper_arm", 0.6, 0.3),
        ("lower_arm", 0.6, 0.3),
        ("hand", 0.5, 1.0),
        ("finger", 0.5, 1.0),
        ("hip", 0.92, 1.0),
        ("upper_leg", 0.6, 0.3),
        ("lower_leg", 0.6, 0.3),
        ("foot", 0.5, 1.0),
    ];
    assert_eq!(result.groups.len(), expected.len());
    for (group, length_scale, thickness_scale) in expected {
        let found = result.groups[group];
        assert!(
            close(found.length_scale, length_scale) && close(found.thickness_scale, thickness_scale),
            "{group}"
        );
    }
    assert!(result.warnings.is_empty());
}

#[test]
fn a_group_that_the_reference_lacks_follows_the_bone_that_stands_for_it() {
    let target = body(&[
        (HEAD_TOP, 0.2, None),
        ("chest", 0.3, Some(0.1)),
        ("neck", 0.2, Some(0.1)),
        ("head", 0.1, Some(0.05)),
        ("leftUpperLeg", 0.1, None),
        ("leftToes", 0.1, None),
    ]);
    let reference = body(&[(HEAD_TOP, 0.3, None), ("chest", 0.1, Some(0.1)), ("head", 0.2, Some(0.1))]);
    let result = settle(&target, &reference);
    // chest -> head is torso in the reference, and so it is here: 0.3 over 0.6.
    assert!(close(result.groups["torso"].length_scale, 0.5));
    assert_eq!(result.groups["neck"], result.groups["torso"]);
    assert!(close(result.groups["hip"].length_scale, 1.0));
    assert!(close(result.groups["hip"].thickness_scale, 1.0));
    let missing: Vec<_> = result.warnings.iter().filter(|warning| warning.code == "group_missing").collect();
    assert_eq!(missing.len(), 3, "{missing:?}");
}

#[test]
fn settings_replace_coefficients_and_transfers() {
    let legs = |thigh: f64, radius: f64| {
        body(&[
            ("head", 1.0, None),
            (HEAD_TOP, 0.3, Some(radius)),
            ("leftUpperLeg", 0.1, None),
            ("leftLowerLeg", thigh, Some(radius)),
            ("leftFoot", 0.4, None),
            ("leftToes", thigh, Some(radius)),
        ])
    };
    let run = |group: &str, settings: GroupSettings| {
        let settings = BTreeMap::from([(group.to_string(), settings)]);
        coefficients(&legs(1.0, 1.0), &legs(0.4, 0.2), 1.5, &settings, &BTreeMap::new())
    };
    let given =
        GroupSettings { length_scale: Some(0.7), thickness_transfer: Some(0.5), ..GroupSettings::default() };
    let thigh = run("upper_leg", given).unwrap().groups["upper_leg"];
    assert!(close(thigh.length_scale, 0.7) && close(thigh.thickness_scale, 0.65));
    let given =
        GroupSettings { length_transfer: Some(1.0), thickness_scale: Some(1.2), ..GroupSettings::default() };
    let foot = run("foot", given).unwrap().groups["foot"];
    assert!(close(foot.length_scale, 0.6) && close(foot.thickness_scale, 1.2));
    let given = GroupSettings { thickness_transfer: Some(1.0), ..GroupSettings::default() };
    let head = run("head", given).unwrap().groups["head"];
    assert!(close(head.length_scale, 1.5) && close(head.thickness_scale, 0.3));
    let unknown = run("thigh", GroupSettings::default()).unwrap_err();
    assert_eq!(unknown.kind, ErrorKind::BadOption);
    assert!(unknown.message.contains("thigh") && unknown.message.contains("upper_leg"), "{unknown}");
    let negative = GroupSettings { length_scale: Some(-1.0), ..GroupSettings::default() };
    assert_eq!(run("foot", negative).unwrap_err().kind, ErrorKind::BadOption);
}

#[test]
fn the_users_own_groups_pool_their_bones() {
    let legs = |thigh: f64, shin: f64| {
        body(&[
            (HEAD_TOP, 0.3, None),
            ("leftUpperLeg", 0.1, None),
            ("leftLowerLeg", thigh, None),
            ("leftFoot", shin, None),
        ])
    };
    let groups =
        BTreeMap::from([(Role::LeftLowerLeg, "leg".to_string()), (Role::LeftFoot, "leg".to_string())]);
    let result = coefficients(&legs(1.0, 1.0), &legs(0.2, 0.4), 1.0, &BTreeMap::new(), &groups).unwrap();
    assert!(close(result.groups["leg"].length_scale, 0.3));
    assert!(!result.groups.contains_key("upper_leg") && !result.groups.contains_key("lower_leg"));
}

#[test]
fn a_bone_that_would_grow_is_reported_and_not_limited() {
    let legs = |thigh: f64| {
        body(&[(HEAD_TOP, 0.3, None), ("leftUpperLeg", 0.1, None), ("leftLowerLeg", thigh, None)])
    };
    let result = settle(&legs(0.2), &legs(0.3));
    assert!(close(result.groups["upper_leg"].length_scale, 2.25));
    assert!(result.warnings.iter().any(|warning| warning.code == "coefficient_limited"));
}

#[test]
fn the_head_is_scaled_about_its_joint() {
    let head = DVec3::new(0.1, 1.4, -0.05);
    let top = head + DVec3::Y * 0.22;
    let joints = BTreeMap::from([(Role::Hips, DVec3::Y * 0.9), (Role::Head, head)]);
    let bones = found(joints.keys().copied());
    let groups = scales(&[("torso", 1.0, 1.0), ("head", 1.5, 1.5)]);
    let shortened = shorten(&bones, &joints, top, &groups);
    let field = BoneField::new(&bones, &joints, top, &shortened, &groups);
    for offset in sprinkle(200) {
        let v = head + 0.4 * offset;
        let weights = field.bone_weights(v, &[(Role::Head, 1.0)]);
        assert!(near(field.displace(v, &weights, Stage::Face), head + 1.5 * (v - head)));
        let jacobian = field.jacobian(v, &weights, Stage::Face);
        assert!((jacobian - 1.5 * DMat3::IDENTITY).abs_diff_eq(DMat3::ZERO, 1e-12));
    }
}

/// Points in the cube from -1 to 1, the same on every run.
fn sprinkle(count: usize) -> Vec<DVec3> {
    let mut state = 1_u64;
    let mut next = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    };
    (0..count).map(|_| DVec3::new(next(), next(), next())).collect()
}

/// The field of an adult with chibi-like coefficients, or with 1 throughout.
fn person_field(identity: bool) -> (Person, BoneField) {
    let person = Person { fingers: true, ..Person::default() };
    let joints = person.joints();
    let top = DVec3::Y * person.crown();
    let bones = found(joints.keys().copied());
    let groups: BTreeMap<String, Coefficient> = Group::ALL
        .into_iter()
        .enumerate()
        .map(|(index, group)| {
            let varied = |least: f64| {
                if identity { 1.0 } else { least + 0.05 * index as f64 }
            };
            let coefficient = Coefficient { length_scale: varied(0.3), thickness_scale: varied(0.5) };
            (group.name().to_string(), coefficient)
        })
        .collect();
    let shortened = shorten(&bones, &joints, top, &groups);
    let field = BoneField::new(&bones, &joints, top, &shortened, &groups);
    (person, field)
}

#[test]
fn coefficients_of_one_leave_every_point() {
    let (person, field) = person_field(true);
    let roles: Vec<Role> = person.joints().into_keys().collect();
    for (index, p) in sprinkle(500).into_iter().enumerate() {
        let v = DVec3::Y + p;
        let weights = field.bone_weights(v, &[(roles[index % roles.len()], 0.7), (Role::Hips, 0.3)]);
        assert!(close(weights.iter().map(|&(_, weight)| weight).sum(), 1.0));
        assert!(near(field.displace(v, &weights, Stage::Face), v));
        assert!(field.jacobian(v, &weights, Stage::Face).abs_diff_eq(DMat3::IDENTITY, 1e-12));
    }
}

#[test]
fn the_jacobian_agrees_with_differences() {
    let (person, field) = person_field(false);
    let roles: Vec<Role> = person.joints().into_keys().collect();
    let step = 1e-6;
    for stage in [Stage::Length, Stage::Thickness] {
        let mut compared = 0;
        for (index, p) in sprinkle(400).into_iter().enumerate() {
            let v = DVec3::Y + p;
            let (one, two) = (roles[index % roles.len()], roles[(7 * index + 3) % roles.len()]);
            let weights = field.bone_weights(v, &[(one, 0.6), (two, 0.4)]);
            let at = |v: DVec3| field.displace(v, &weights, stage);
            let column = |axis: DVec3| (at(v + step * axis) - at(v - step * axis)) / (2.0 * step);
            let differences = DMat3::from_cols(column(DVec3::X), column(DVec3::Y), column(DVec3::Z));
            compared += usize::from(field.jacobian(v, &weights, stage).abs_diff_eq(differences, 1e-7));
        }
        // Feet jump from the segment to its end, so a difference may straddle two pieces.
        assert!(compared >= 399, "{compared} of 400");
    }
}

#[test]
fn a_joint_with_several_bones_shares_its_weight_by_inverse_squared_distance() {
    let bone = |child: DVec3| FieldBone {
        joint: Role::Hips,
        parent: DVec3::ZERO,
        child,
        new_parent: DVec3::ZERO,
        new_child: child,
        thickness_scale: 1.0,
    };
    let field = BoneField { bones: vec![bone(DVec3::X), bone(DVec3::Y)] };
    // Distances 1 and 2.
    let weights = field.bone_weights(DVec3::new(2.0, 1.0, 0.0), &[(Role::Hips, 1.0)]);
    let expected = 2.0 / (2.0 + 4.0);
    assert!(close(weights[1].1, expected) && close(weights[0].1, 1.0 - expected), "{weights:?}");
    // On a bone, all of it; a role without bones hands its weight up.
    assert_eq!(field.bone_weights(DVec3::X * 0.5, &[(Role::LeftToes, 1.0)]), [(0, 1.0)]);
}

#[test]
fn a_joint_without_bones_still_moves_and_scales() {
    let joints = BTreeMap::from([
        (Role::Hips, DVec3::ZERO),
        (Role::LeftUpperLeg, DVec3::new(0.1, 0.0, 0.0)),
        (Role::LeftLowerLeg, DVec3::new(0.1, -0.4, 0.0)),
    ]);
    let bones = found(joints.keys().copied());
    let groups = scales(&[("hip", 1.0, 1.0), ("upper_leg", 0.5, 0.8)]);
    let shortened = shorten(&bones, &joints, DVec3::ZERO, &groups);
    let field = BoneField::new(&bones, &joints, DVec3::ZERO, &shortened, &groups);
    let v = DVec3::new(0.2, -0.6, 0.1);
    let weights = field.bone_weights(v, &[(Role::LeftLowerLeg, 1.0)]);
    let expected = DVec3::new(0.1, -0.2, 0.0) + 0.8 * (v - joints[&Role::LeftLowerLeg]);
    assert!(near(field.displace(v, &weights, Stage::Face), expected));
}

#[test]
fn a_hand_without_fingers_keeps_its_girth_unless_told() {
    let arm = body(&[(HEAD_TOP, 0.3, None), ("leftUpperArm", 0.2, None), ("leftHand", 0.5, Some(0.1))]);
    assert_eq!(settle(&arm, &arm).groups["hand"].thickness_scale, 1.0);
    let given = GroupSettings { thickness_scale: Some(0.8), ..GroupSettings::default() };
    let settings = BTreeMap::from([("hand".to_string(), given)]);
    let result = coefficients(&arm, &arm, 1.5, &settings, &BTreeMap::new()).unwrap();
    let joints = BTreeMap::from([
        (Role::Hips, DVec3::ZERO),
        (Role::LeftUpperArm, DVec3::X * 0.2),
        (Role::LeftHand, DVec3::X * 0.7),
    ]);
    let bones = found(joints.keys().copied());
    let shortened = shorten(&bones, &joints, DVec3::ZERO, &result.groups);
    let field = BoneField::new(&bones, &joints, DVec3::ZERO, &shortened, &result.groups);
    let hand = field.bones.iter().find(|bone| bone.joint == Role::LeftHand).unwrap();
    assert_eq!(hand.thickness_scale, 0.8);
}

#[test]
fn a_capsule_around_a_bone_has_its_radius() {
    for (a, b) in [
        (DVec3::ZERO, DVec3::X),
        (DVec3::Y, DVec3::new(0.3, -1.0, 0.7)),
        (DVec3::ONE, DVec3::new(-1.0, 1.0, 1.0)),
    ] {
        for scale in [1e-3, 1.0, 1e3] {
            let shape = Shape::capsule(a * scale, b * scale, 0.2 * scale);
            let surface = Surface::new(&shape.positions, &shape.triangles);
            for rays in [12, 48] {
                let found = radius(a * scale, b * scale, &[&surface], rays).unwrap();
                assert!((found / (0.2 * scale) - 1.0).abs() < 1e-9, "{found} with {rays} rays");
            }
            // 7 rays miss the columns' vertices: the tube's own corners are the only error.
            let found = radius(a * scale, b * scale, &[&surface], 7).unwrap() / (0.2 * scale);
            let flat = (std::f64::consts::PI / COLUMNS as f64).cos();
            assert!(found < 1.0 && found > flat * flat);
        }
    }
}

#[test]
fn a_bone_off_the_middle_measures_a_little_less() {
    // Rays at equal angles crowd on the near side, so the centroid of the hits lies halfway between bone and axis, and
    // the mean distance to it is R (1 - 3/16 (e/R)^2) up to (e/R)^4, for a bone at distance e from the axis.
    let shape = Shape::capsule(DVec3::NEG_Y, DVec3::Y, 1.0);
    let surface = Surface::new(&shape.positions, &shape.triangles);
    for off in [0.1, 0.2, 0.4_f64] {
        let shift = DVec3::new(off, 0.0, 0.0);
        let found = radius(shift - DVec3::Y, shift + DVec3::Y, &[&surface], 48).unwrap();
        let expected = 1.0 - 3.0 / 16.0 * off * off;
        assert!((found - expected).abs() < 0.3 * off.powi(4) + 0.002, "{found} {expected}");
    }
}

#[test]
fn a_ray_through_a_hole_is_left_out() {
    // A quarter of the tube is gone: 3 of 12 rays leave, 9 remain.
    let whole = Shape::capsule(DVec3::NEG_Y, DVec3::Y, 1.0);
    let open = |share: f64| -> Surface {
        let triangles: Vec<[u32; 3]> = whole
            .triangles
            .iter()
            .copied()
            .filter(|corners| {
                let middle = corners.iter().map(|&vertex| whole.positions[vertex as usize]).sum::<DVec3>();
                middle.z.atan2(middle.x).abs() < (1.0 - share) * std::f64::consts::PI
            })
            .collect();
        Surface::new(&whole.positions, &triangles)
    };
    let wide = {
        let shape = Shape::capsule(DVec3::NEG_Y, DVec3::Y, 1.5);
        Surface::new(&shape.positions, &shape.triangles)
    };
    let found = |narrow: &Surface| radius(DVec3::NEG_Y, DVec3::Y, &[narrow, &wide], 12).unwrap();
    assert!((0.9..1.0).contains(&found(&open(0.2))));
    // Half of it gone: the body no longer surrounds the bone, and the wider set is taken.
    assert!((found(&open(0.5)) - 1.5).abs() < 1e-9);
    // Alone it is still measured by what is left of it; two hits are too few.
    assert!(radius(DVec3::NEG_Y, DVec3::Y, &[&open(0.5)], 12).is_some());
    assert_eq!(radius(DVec3::NEG_Y, DVec3::Y, &[&open(0.9)], 12), None);
    assert_eq!(radius(DVec3::Y, DVec3::Y, &[&wide], 12), None);
}

#[test]
fn a_person_measures_as_built() {
    let options = [0.0, 45.0].into_iter().flat_map(|arm_angle| {
        [false, true].map(|blended| Person { arm_angle, blended, fingers: true, ..Person::default() })
    });
    let open = Person { holes: true, ..Person::chibi() };
    for person in options.chain([Person::chibi(), open]) {
        let character = person.build();
        character.validate().unwrap();
        let surface = person_surface(&person);
        let joints = person.joints();
        let bones = found(joints.keys().copied());
        let top =
            head_top(&surface, joints[&Role::Head], person.proportions.head_half_width, 2.0 * person.crown());
        assert_eq!(top.hit_count, 7);
        let top = top.point.unwrap();
        assert!((top.y - person.head_top()).abs() < 0.005, "{top} {}", person.head_top());
        for rays in [12, 48] {
            let shape = measure(&bones, &joints, top, &[&surface], rays).unwrap();
            assert!(close(shape.head_length, top.y - joints[&Role::Head].y));
            assert!(close(shape.bones["leftLowerLeg"].length, person.proportions.upper_leg));
            assert!(close(shape.bones["rightHand"].length, person.proportions.lower_arm));
            for bone in &bones {
                let Some(expected) = person.radius(bone.kind) else {
                    continue;
                };
                let found = shape.bones[bone.key()].radius.unwrap();
                assert!((found / expected - 1.0).abs() < 1e-5, "{} {found} {expected}", bone.key());
            }
        }
    }
}

fn person_surface(person: &Person) -> Surface {
    let character = person.build();
    let body = character.meshes.iter().find(|mesh| mesh.kind == Some(MeshKind::Body)).unwrap();
    let positions: Vec<DVec3> = body.positions.iter().map(|p| p.as_dvec3()).collect();
    Surface::new(&positions, &body.triangles)
}

#[test]
fn a_person_stands_where_its_landmarks_say() {
    for person in [Person::adult(), Person::chibi()] {
        let character = person.build();
        let body = &character.meshes[0];
        let heights = || body.positions.iter().map(|p| f64::from(p.y));
        assert!(heights().fold(f64::INFINITY, f64::min).abs() < 1e-6);
        assert!((heights().fold(0.0, f64::max) - person.crown()).abs() < 1e-6);
        let surface = person_surface(&person);
        let up =
            surface.first_hit(DVec3::Y * person.joints()[&Role::LeftLowerLeg].y, DVec3::Y, 10.0).unwrap();
        assert!((up.t + person.joints()[&Role::LeftLowerLeg].y - person.crotch()).abs() < 1e-6);
        // The front profile steps back under the chin.
        let depth = |y: f64| {
            surface.first_hit(DVec3::new(0.0, y, 9.0), DVec3::NEG_Z, 9.0).map_or(0.0, |hit| 9.0 - hit.t)
        };
        let head = person.proportions.head;
        let step = depth(person.chin() + 0.05 * head) - depth(person.chin() - 0.01 * head);
        assert!(step > 0.04 * (person.crown() - person.shoulder_line()), "{step}");
    }
}

#[test]
fn people_are_closed_unless_they_have_holes() {
    for blended in [false, true] {
        for holes in [false, true] {
            let person =
                Person { blended, holes, fingers: true, skirt: true, arm_angle: 30.0, ..Person::default() };
            let body = &person.build().meshes[0];
            let mut edges: BTreeMap<(u32, u32), i32> = BTreeMap::new();
            for &[a, b, c] in &body.triangles {
                for (from, to) in [(a, b), (b, c), (c, a)] {
                    *edges.entry((from.min(to), from.max(to))).or_default() += if from < to { 1 } else { -1 };
                }
            }
            assert_eq!(edges.values().any(|&sum| sum != 0), holes, "blended {blended}");
            let positions: Vec<DVec3> = body.positions.iter().map(|p| p.as_dvec3()).collect();
            let corners = body.triangles.iter().map(|t| t.map(|vertex| positions[vertex as usize]));
            let volume: f64 = corners.map(|[a, b, c]| a.cross(b).dot(c) / 6.0).sum();
            assert!(volume > 0.0, "faces look inwards");
            for row in body.weights.rows() {
                assert!((row.iter().map(|&(_, weight)| weight).sum::<f32>() - 1.0).abs() < 1e-6);
            }
        }
    }
}

#[test]
fn a_turned_person_in_another_unit_is_the_same_person() {
    let plain =
        Person { without: vec![Role::Neck, Role::LeftShoulder, Role::RightShoulder], ..Person::chibi() };
    let turned = Person { facing: 90.0, unit: 100.0, ..plain.clone() };
    let (one, two) = (plain.build(), turned.build());
    two.validate().unwrap();
    assert_eq!(one.meshes[0].weights, two.meshes[0].weights);
    for (a, b) in one.skeleton.joints.iter().zip(&two.skeleton.joints) {
        let (a, b) = (a.position(), b.position());
        // Facing +x, the left hand is at -z.
        assert!((b - 100.0 * DVec3::new(a.z, a.y, -a.x)).length() < 1e-9);
        assert!((a == DVec3::ZERO) == (b == DVec3::ZERO));
    }
    assert_eq!(two.humanoid.parent_of(Role::Head), Some(Role::UpperChest));
}

#[test]
fn a_model_without_triangles_or_with_two_rays_is_refused() {
    let bones = found([Role::Hips, Role::Head]);
    let joints = BTreeMap::from([(Role::Hips, DVec3::ZERO), (Role::Head, DVec3::Y)]);
    let kind = |result: Result<BodyShape, Error>| result.unwrap_err().kind;
    let empty = Surface::default();
    assert_eq!(kind(measure(&bones, &joints, DVec3::Y, &[&empty], 12)), ErrorKind::NoGeometry);
    assert_eq!(kind(measure(&bones, &joints, DVec3::Y, &[&empty], 2)), ErrorKind::BadOption);
}

#[test]
fn skipping_a_role_in_one_model_skips_it_in_both() {
    let person = Person::adult();
    let joints = person.joints();
    let surface = person_surface(&person);
    let top = DVec3::Y * person.crown();
    let bones = found(joints.keys().copied());
    let shape = measure(&bones, &joints, top, &[&surface], 12).unwrap();
    let mut roles: BTreeSet<Role> = joints.keys().copied().collect();
    roles.remove(&Role::LeftLowerLeg);
    let restricted = shape.restricted_to(&roles);
    let p = &person.proportions;
    assert!(close(restricted.bones["leftFoot"].length, p.upper_leg + p.lower_leg));
    let expected =
        (p.upper_leg * p.upper_leg_radius + p.lower_leg * p.lower_leg_radius) / (p.upper_leg + p.lower_leg);
    assert!((restricted.bones["leftFoot"].radius.unwrap() - expected).abs() < 1e-6);
    assert_eq!(restricted.bones["rightFoot"], shape.bones["rightFoot"]);
}

#[test]
fn a_reference_of_chibi_proportions_gives_chibi_proportions() {
    let shape_of = |person: &Person| {
        let joints = person.joints();
        let top = DVec3::Y * person.crown();
        let bones = found(joints.keys().copied());
        (measure(&bones, &joints, top, &[&person_surface(person)], 48).unwrap(), bones, joints, top)
    };
    let (target, bones, joints, top) = shape_of(&Person::adult());
    let (reference, ..) = shape_of(&Person::chibi());
    let result = settle(&target, &reference);
    let shortened = shorten(&bones, &joints, top, &result.groups);
    let length = |a: Role, b: Role| shortened.joints[&a].distance(shortened.joints[&b]);
    let head = shortened.head_top.distance(shortened.joints[&Role::Head]);
    for (parent, child) in [
        (Role::LeftUpperLeg, Role::LeftLowerLeg),
        (Role::RightLowerLeg, Role::RightFoot),
        (Role::LeftUpperArm, Role::LeftLowerArm),
        (Role::Neck, Role::Head),
    ] {
        let expected = reference.bones[child.name()].length / reference.head_length;
        assert!(close(length(parent, child) / head, expected), "{child}");
    }
}

#[test]
fn the_face_maps_have_the_slopes_they_say() {
    let step = 1e-6;
    for y in [-0.49, -0.2, 0.0, 0.3, 0.49] {
        for squash in [-0.9, 0.5, 1.9] {
            assert!(
                ((f2(y + step, squash) - f2(y - step, squash)) / (2.0 * step) - f2_slope(y, squash)).abs()
                    < 1e-8
            );
            assert!(
                ((f4(y + step, squash) - f4(y - step, squash)) / (2.0 * step) - f4_slope(y, squash)).abs()
                    < 1e-8
            );
        }
    }
    let map = FaceMap { bottom: 1.2, top: 1.6, squash: 0.8, curve: FaceCurve::F4 };
    assert!(close(map.map(1.4), 1.4 - 0.05 * 0.4));
    for y in [0.0, 1.2, 1.6, 3.0] {
        assert!(close(map.map(y), y));
    }
    assert_eq!((map.slope(1.1), map.slope(1.7)), (1.0, 1.0));
    for y in [1.25, 1.4, 1.55] {
        assert!(((map.map(y + step) - map.map(y - step)) / (2.0 * step) - map.slope(y)).abs() < 1e-8);
    }
    assert_eq!(FaceMap { squash: 0.0, ..map }.map(1.3333), 1.3333);
}

#[test]
fn a_bearable_squash_never_folds() {
    for (curve, limit) in [(FaceCurve::F4, 1.9), (FaceCurve::F2, 0.95)] {
        let (squash, warning) = bearable_squash(curve, 5.0);
        assert_eq!((squash, warning.unwrap().code), (limit, "face_squash_clamped"));
        assert_eq!(bearable_squash(curve, -0.5), (-0.5, None));
        for sign in [-1.0, 1.0] {
            let map = FaceMap { bottom: 0.0, top: 1.0, squash: sign * limit, curve };
            let heights: Vec<f64> = (0..=1000).map(|i| map.map(f64::from(i) / 1000.0)).collect();
            assert!(heights.windows(2).all(|pair| pair[0] < pair[1]));
        }
    }
}

#[test]
fn the_sphere_takes_points_to_the_sphere() {
    let map = SphereMap::in_box(DVec3::new(-1.0, 0.0, -1.5), DVec3::new(1.0, 4.0, 1.5), 1.0);
    assert!(close(map.radius, 1.5) && near(map.centre, DVec3::new(0.0, 2.0, 0.0)));
    let step = 1e-6;
    for p in sprinkle(100) {
        let p = map.centre + 2.0 * p;
        assert!(close(map.map(p).distance(map.centre), 1.5));
        let half = SphereMap { amount: 0.5, ..map };
        assert!(near(half.map(p), 0.5 * (p + map.map(p))));
        assert!(near(SphereMap { amount: 0.0, ..map }.map(p), p));
        let column = |axis: DVec3| (half.map(p + step * axis) - half.map(p - step * axis)) / (2.0 * step);
        let differences = DMat3::from_cols(column(DVec3::X), column(DVec3::Y), column(DVec3::Z));
        assert!(half.jacobian(p).abs_diff_eq(differences, 1e-6));
    }
    assert_eq!(map.map(map.centre), map.centre);
}
