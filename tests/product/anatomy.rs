//! `anatomy.rs`: lengths and widths of people whose tubes are known.

use crate::people::{ADULT, Person};
use crate::tubes::{Tubes, blended};
use glam::{DVec3, Vec3};
use std::f64::consts::PI;
use superdeform::internals::shape::Measured;
use superdeform::internals::shape::product::anatomy::{Anatomy, Proportions};
use superdeform::internals::shape::product::part::Part;
use superdeform::{Character, MeshKind, Options, Role};

fn assert_near(what: &str, found: f64, expected: f64, tolerance: f64) {
    assert!((found - expected).abs() <= tolerance, "{what}: {found} instead of {expected} +- {tolerance}");
}

#[test]
fn limbs_run_along_their_joints() {
    let Tubes { person, anatomy, .. } = blended();
    let joints = person.joints();
    let near = |what: &str, found: DVec3, expected: DVec3| {
        assert!(found.distance(expected) < 1e-6, "{what}: {found} instead of {expected}");
    };
    let side = |role: Role, left: bool| joints[&if left { role } else { role.mirrored() }];
    for (index, left) in [true, false].into_iter().enumerate() {
        let arm = &anatomy.limbs[index];
        near("shoulder", arm.root, side(Role::LeftUpperArm, left));
        near("elbow", arm.middle, side(Role::LeftLowerArm, left));
        near("wrist", arm.end, side(Role::LeftHand, left));
        assert_near("arm", arm.length(), ADULT.upper_arm + ADULT.lower_arm, 1e-6);
        let first = if left { Part::LeftUpperArm } else { Part::RightUpperArm } as usize;
        assert_eq!((arm.parts, arm.end_is_joint), ([first, first + 1, first + 2], true));
        let leg = &anatomy.limbs[2 + index];
        let hip = side(Role::LeftUpperLeg, left);
        near("hip", leg.root, hip.with_y(anatomy.landmarks.heights.crotch));
        near("knee", leg.middle, side(Role::LeftLowerLeg, left));
        near("ankle", leg.end, side(Role::LeftFoot, left));
        let first = if left { Part::LeftUpperLeg } else { Part::RightUpperLeg } as usize;
        assert_eq!((leg.parts, leg.end_is_joint), ([first, first + 1, first + 2], true));
    }
    assert_near("middle", anatomy.middle_x, 0.0, 1e-9);
    assert_eq!(anatomy.warnings(), []);
}

#[test]
fn lengths_run_between_landmarks() {
    let Tubes { person, anatomy, .. } = blended();
    let (heights, found) = (&anatomy.landmarks.heights, &anatomy.proportions);
    assert_near("head", found.head_length, heights.crown - heights.chin, 0.0);
    assert_near("neck", found.neck, heights.chin - heights.shoulder_line, 0.0);
    assert_near("torso", found.torso, heights.shoulder_line - heights.crotch, 0.0);
    assert_near("leg", found.leg, heights.crotch - heights.sole, 0.0);
    assert_near("arm", found.arm, ADULT.upper_arm + ADULT.lower_arm, 1e-6);
    // The ankle lies the foot's own height of 7 cm over the ground.
    assert_near("ankle", found.ankle_height, 0.07, 1e-6);
    // Tubes end 15 % of their bone beyond it, rounded, at most 3 cm.
    assert_near("hand", found.hand.unwrap(), 1.15 * person.proportions.hand, 1e-6);
    let toes = person.joints()[&Role::LeftToes].z;
    let (heel_end, toe_end) = (0.03_f64.min(0.15 * (toes + 0.04)), 0.15 * 0.3 * person.proportions.foot);
    let foot = toes + 0.3 * person.proportions.foot + toe_end + 0.04 + heel_end;
    assert_near("foot", found.foot.unwrap(), foot, 1e-6);
}

#[test]
fn widths_are_those_of_the_tubes() {
    let Tubes { anatomy, character, .. } = blended();
    // Of a circle's outline 3 % lie beyond the cosine of 3 % of half a turn. A nose lies on the middle of the outline and adds to
    // its length: 3 % begin a little further in.
    let half = ADULT.head_half_width;
    assert_near("head", anatomy.proportions.head_half_width, (0.03 * PI).cos() * half, 0.015 * half);
    let found = measured(character);
    // Rays meet sides of 48 columns between their corners and their middles, .2 % further in; slices are smoothed along limbs, of
    // which the next part differs by a third.
    for (what, found, radius) in [
        ("torso", found.torso_half_width, ADULT.torso_radius),
        ("upper arm", found.upper_arm_radius, ADULT.upper_arm_radius),
        ("lower arm", found.lower_arm_radius, ADULT.lower_arm_radius),
        ("upper leg", found.upper_leg_radius, ADULT.upper_leg_radius),
        ("lower leg", found.lower_leg_radius, ADULT.lower_leg_radius),
    ] {
        assert_near(what, found.unwrap(), radius, 0.04 * radius);
    }
}

/// The proportions that a style made of `character` has.
fn measured(character: &Character) -> Proportions {
    Measured::of(character, &Options::default()).unwrap().shape.proportions.unwrap()
}

#[test]
fn a_heads_depth_is_that_of_its_skin_and_of_its_hair_where_the_skin_ends_under_it() {
    let half = ADULT.head_half_width;
    let depth = |without_back: bool, hair: Option<f64>| {
        let Tubes { person, character, anatomy, .. } = blended();
        let mut character = character.clone();
        let chin = anatomy.landmarks.heights.chin;
        let skin = &mut character.meshes[0];
        let head: Vec<bool> = skin.positions.iter().map(|p| f64::from(p.y) > chin).collect();
        let shell: Vec<_> = skin
            .triangles
            .iter()
            .filter(|corners| corners.iter().all(|&vertex| head[vertex as usize]))
            .copied()
            .collect();
        if let Some(scale) = hair {
            let mut hair = skin.clone();
            hair.kind = Some(MeshKind::Hair);
            hair.triangles = shell;
            for (p, _) in hair.positions.iter_mut().zip(&head).filter(|(_, of_head)| **of_head) {
                p.z *= scale as f32;
            }
            character.meshes.push(hair);
        }
        if without_back {
            let skin = &mut character.meshes[0];
            let positions = skin.positions.clone();
            let is_back = |vertex: u32| head[vertex as usize] && positions[vertex as usize].z < 0.0;
            skin.triangles.retain(|corners| !corners.iter().any(|&vertex| is_back(vertex)));
        }
        Tubes::of_character(person.clone(), character).anatomy.proportions.head_half_depth
    };
    let is_near = |what: &str, found: Option<f64>, expected: f64| {
        // As far out as on a circle, 55 % up an ellipsoid; a nose begins below.
        let inner = (0.03 * PI).cos() * (1.0 - 0.1_f64.powi(2)).sqrt();
        assert_near(what, found.unwrap(), inner * expected, 0.03 * half);
    };
    is_near("skin", depth(false, None), half);
    is_near("skin under hair", depth(false, Some(1.2)), half);
    is_near("skin that ends under hair", depth(true, Some(1.2)), 1.2 * half);
    assert_eq!(depth(true, None), None, "half a head");
}

/// The person of [`blended`] with its points moved by `map`, joints too.
fn moved(map: impl Fn(DVec3) -> DVec3) -> Tubes {
    let Tubes { person, character, .. } = blended();
    let mut character = character.clone();
    for mesh in &mut character.meshes {
        mesh.positions.iter_mut().for_each(|p: &mut Vec3| *p = map(p.as_dvec3()).as_vec3());
    }
    for joint in &mut character.skeleton.joints {
        joint.rest.w_axis = map(joint.position()).extend(1.0);
    }
    Tubes::of_character(person.clone(), character)
}

#[test]
fn the_centre_line_runs_through_the_torso() {
    let anatomy = |tubes: &Tubes| Measured::of(&tubes.character, &Options::default()).unwrap().anatomy;
    let straight = anatomy(blended());
    for y in [0.0, 0.95, 1.2, 1.5] {
        let (z, slope) = straight.centre_z(y);
        assert!(z.abs() < 1e-4 && slope.abs() < 5e-3, "{y}: {z}, {slope}");
    }
    // Leaning forward by 1 in 5.
    let leaning = anatomy(&moved(|p| DVec3::new(p.x, p.y, p.z + 0.2 * p.y)));
    let heights = leaning.landmarks.heights;
    let middle = 0.5 * (heights.crotch + heights.shoulder_line);
    let (z, slope) = leaning.centre_z(middle);
    assert_near("z", z, 0.2 * middle, 1e-3);
    assert_near("slope", slope, 0.2, 0.01);
    // Beyond its ends it stays.
    let Anatomy { centre_line, .. } = &leaning;
    let (first, last) = (centre_line[0], centre_line[centre_line.len() - 1]);
    assert_eq!(leaning.centre_z(first.0 - 1.0), (first.1, 0.0));
    assert_eq!(leaning.centre_z(last.0 + 1.0), (last.1, 0.0));
}

#[test]
fn a_person_twice_as_large_has_twice_the_lengths() {
    let (one, two) = (measured(&blended().character), measured(&moved(|p| 2.0 * p).character));
    for (what, one, two) in [
        ("head", one.head_length, two.head_length),
        ("head width", one.head_half_width, two.head_half_width),
        ("neck", one.neck, two.neck),
        ("torso", one.torso, two.torso),
        ("arm", one.arm, two.arm),
        ("leg", one.leg, two.leg),
        ("hand", one.hand.unwrap(), two.hand.unwrap()),
        ("foot", one.foot.unwrap(), two.foot.unwrap()),
        ("torso width", one.torso_half_width.unwrap(), two.torso_half_width.unwrap()),
        ("arm radius", one.upper_arm_radius.unwrap(), two.upper_arm_radius.unwrap()),
        ("leg radius", one.lower_leg_radius.unwrap(), two.lower_leg_radius.unwrap()),
    ] {
        assert_near(what, two / one, 2.0, 1e-5);
    }
}

#[test]
fn wrists_and_ankles_without_a_joint_are_placed_by_ratio_and_warned_of() {
    use Role::*;
    let without = vec![LeftHand, RightHand, LeftFoot, RightFoot];
    let Tubes { person, anatomy, .. } = Tubes::of(Person { without, ..Person::adult() });
    let [arm, _, leg, _] = &anatomy.limbs;
    assert!(!arm.end_is_joint && !leg.end_is_joint);
    // 62 % from the elbow to the tip of the hand's tube, whose rim within a thousandth of the height counts as tip, too.
    let tip = ADULT.lower_arm + 1.15 * person.proportions.hand;
    let rim = 1e-3 * anatomy.landmarks.heights.crown;
    assert_near("wrist", arm.middle.distance(arm.end), 0.62 * tip, 0.62 * rim);
    assert_near("wrist's height", arm.end.y, person.shoulder_line(), 1e-6);
    // A tenth of the leg over the ground, below the knee.
    assert_near("ankle", leg.end.y, 0.1 * anatomy.landmarks.heights.crotch, 1e-6);
    assert_near("ankle's x", leg.end.x, person.joints()[&LeftLowerLeg].x, 1e-6);
    let warnings = anatomy.warnings();
    assert_eq!(warnings.iter().map(|warning| warning.code).collect::<Vec<_>>(), ["joint_by_ratio"; 2]);
    assert!(warnings[0].message.contains("hands") && warnings[1].message.contains("feet"), "{warnings:?}");
}

#[test]
fn elbows_and_knees_without_a_joint_lie_half_way() {
    use Role::*;
    let without = vec![LeftLowerArm, RightLowerArm, LeftLowerLeg, RightLowerLeg];
    let Tubes { person, anatomy, .. } = Tubes::of(Person { without, ..Person::adult() });
    let joints = Person { without: Vec::new(), ..person }.joints();
    let [arm, _, leg, _] = &anatomy.limbs;
    let elbow = joints[&LeftUpperArm].lerp(joints[&LeftHand], 0.5);
    assert!(arm.middle.distance(elbow) < 1e-6, "{} {elbow}", arm.middle);
    let hip = joints[&LeftUpperLeg].with_y(anatomy.landmarks.heights.crotch);
    let knee = hip.lerp(joints[&LeftFoot], 0.5);
    assert!(leg.middle.distance(knee) < 1e-6, "{} {knee}", leg.middle);
}
