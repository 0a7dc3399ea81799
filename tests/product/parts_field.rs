//! `parts_field.rs`: the parts' maps, worked by hand, and where they meet.

use crate::people::Person;
use crate::tubes::{Tubes, blended, crowd, jacobian_error, mirrored_weights, numbers};
use glam::{DMat3, DVec3};
use std::sync::Arc;
use superdeform::internals::face::stage::FaceBinding;
use superdeform::internals::face::{FaceMap, FaceShape};
use superdeform::internals::geometry::Mapped;
use superdeform::internals::shape::field::{Binding, BodyField, Field, Finish};
use superdeform::internals::shape::product::anatomy::Anatomy;
use superdeform::internals::shape::product::binding::{PartBinding, PartBindings};
use superdeform::internals::shape::product::part::{PART_COUNT, Part};
use superdeform::internals::shape::product::parts_field::PartField;
use superdeform::internals::shape::product::pieces::{Attachment, Piece};
use superdeform::internals::shape::product::scales::{HeadScale, PartCoefficients, Scale};
use superdeform::{FaceCurve, Role};

fn scale(length: f64, thickness: f64) -> Scale {
    Scale { length, thickness }
}

/// A scale of its own for every part.
const SCALES: PartCoefficients = PartCoefficients {
    head: HeadScale { height: 1.5, width: 1.6, depth: 1.2 },
    neck: Scale { length: 0.5, thickness: 0.75 },
    torso: Scale { length: 0.6, thickness: 0.8 },
    shoulder_spread: 0.7,
    hip_spread: 0.65,
    upper_arm: Scale { length: 0.4, thickness: 0.45 },
    lower_arm: Scale { length: 0.42, thickness: 0.47 },
    upper_leg: Scale { length: 0.3, thickness: 0.35 },
    lower_leg: Scale { length: 0.32, thickness: 0.37 },
    hand: 0.9,
    foot: 0.95,
};

/// Every part, in the order of its number.
const PARTS: [Part; PART_COUNT] = [
    Part::Torso,
    Part::Neck,
    Part::Head,
    Part::LeftUpperArm,
    Part::LeftLowerArm,
    Part::LeftHand,
    Part::RightUpperArm,
    Part::RightLowerArm,
    Part::RightHand,
    Part::LeftUpperLeg,
    Part::LeftLowerLeg,
    Part::LeftFoot,
    Part::RightUpperLeg,
    Part::RightLowerLeg,
    Part::RightFoot,
    Part::Hair,
];

fn field_of(anatomy: &Anatomy, scales: PartCoefficients) -> PartField {
    PartField::new(anatomy, scales)
}

/// `field` and then `face`.
fn with_face(field: PartField, face: FaceShape) -> Field {
    let body = Field::of(Arc::new(BodyField::Parts(Box::new(field))));
    Field { finish: Finish { face, ..Finish::default() }, ..body }
}

fn by_part(field: &PartField, part: Part, p: DVec3) -> DVec3 {
    field.place(p, &PartBinding::to(part))
}

fn assert_near(what: &str, found: DVec3, expected: DVec3) {
    assert!(found.distance(expected) < 1e-9, "{what}: {found} instead of {expected}");
}

#[test]
fn scales_of_one_leave_everything_where_it_is() {
    for Tubes { person, figure, anatomy, bindings, .. } in crowd() {
        let field = PartField::new(anatomy, PartCoefficients::IDENTITY).with(None, &bindings.pieces);
        let height = figure.height();
        for (&p, binding) in figure.positions.iter().zip(&bindings.vertices) {
            let to = field.map(p, binding);
            assert!(to.position.distance(p) < 1e-9 * height, "{p} goes to {}: {person:?}", to.position);
            assert!((to.jacobian - DMat3::IDENTITY).to_cols_array().iter().all(|x| x.abs() < 1e-6));
        }
        for part in PARTS {
            let p = DVec3::new(0.1, 0.6, -0.05) * height;
            assert!(by_part(&field, part, p).distance(p) < 1e-9 * height, "{part:?}: {person:?}");
        }
    }
}

#[test]
fn heights_stand_on_one_another_from_the_ground_up() {
    let Tubes { person, anatomy, .. } = blended();
    let (field, before) = (field_of(anatomy, SCALES), anatomy.landmarks.heights);
    let (knee, ankle) = (person.joints()[&Role::LeftLowerLeg].y, person.joints()[&Role::LeftFoot].y);
    let crotch = 0.3 * (before.crotch - knee) + 0.32 * (knee - ankle) + 0.95 * ankle;
    let shoulder_line = crotch + 0.6 * (before.shoulder_line - before.crotch);
    let chin = shoulder_line + 0.5 * (before.chin - before.shoulder_line);
    let crown = chin + 1.5 * (before.crown - before.chin);
    let after = field.after();
    for (what, found, expected) in [
        ("sole", after.sole, before.sole),
        ("crotch", after.crotch, crotch),
        ("shoulder line", after.shoulder_line, shoulder_line),
        ("chin", after.chin, chin),
        ("crown", after.crown, crown),
    ] {
        assert!((found - expected).abs() < 1e-6, "{what}: {found} instead of {expected}");
    }
    // And every part goes where its heights say.
    for (part, from, to) in [
        (Part::Torso, before.sole, after.sole),
        (Part::Torso, before.crotch, after.crotch),
        (Part::Torso, before.shoulder_line, after.shoulder_line),
        (Part::Neck, before.shoulder_line, after.shoulder_line),
        (Part::Neck, before.chin, after.chin),
        (Part::Head, before.chin, after.chin),
        (Part::Head, before.crown, after.crown),
        (Part::LeftFoot, before.sole, after.sole),
        (Part::RightFoot, before.sole, after.sole),
    ] {
        let found = by_part(&field, part, DVec3::new(0.02, from, 0.03)).y;
        assert!((found - to).abs() < 1e-9, "{part:?} at {from}: {found} instead of {to}");
    }
}

#[test]
fn the_torso_is_scaled_between_its_landmarks_and_about_its_centre_line() {
    // A centre line that leans forward by 1 in 10, from z = 0.02 at the crotch; its mean is at 0.02 + 0.05 of the torso.
    let mut anatomy = blended().anatomy.clone();
    let before = anatomy.landmarks.heights;
    let torso = before.shoulder_line - before.crotch;
    anatomy.centre_line = vec![(before.crotch, 0.02), (before.shoulder_line, 0.02 + 0.1 * torso)];
    let field = field_of(&anatomy, SCALES);
    let after = *field.after();
    let hip_z = 0.02 + 0.05 * torso;
    // Half-way up: 0.8 in x and z about the line, which itself is flattened by the smaller of 0.6 and 0.8.
    let p = DVec3::new(0.1, before.crotch + 0.25 * torso, 0.07);
    let line = 0.02 + 0.1 * 0.25 * torso;
    let z = hip_z + 0.6 * (line - hip_z) + 0.8 * (0.07 - line);
    assert_near("torso", by_part(&field, Part::Torso, p), DVec3::new(0.08, after.crotch + 0.15 * torso, z));
    // Above the shoulder line heights change by 1.5 times the neck's 0.5, which is less than the torso's 0.8.
    let p = DVec3::new(0.0, before.shoulder_line + 0.04, 0.02 + 0.1 * torso);
    let top = by_part(&field, Part::Torso, p);
    assert!((top.y - (after.shoulder_line + 0.03)).abs() < 1e-9, "{top}");
    let stubby = PartCoefficients { neck: scale(2.0, 1.0), torso: scale(0.6, 3.0), ..SCALES };
    let stubby = field_of(&anatomy, stubby);
    let top = by_part(&stubby, Part::Torso, p);
    // At most as they were.
    assert!((top.y - (stubby.after().shoulder_line + 0.04)).abs() < 1e-9, "{top}");
    // Below the crotch the way to the ground is divided evenly.
    let below = by_part(&field, Part::Torso, DVec3::new(0.0, 0.25 * before.crotch, 0.0));
    assert!((below.y - 0.25 * after.crotch).abs() < 1e-9, "{below}");
}

#[test]
fn limbs_start_where_the_torso_puts_their_joints_and_grow_along_their_bones() {
    let tubes = Tubes::of(Person { arm_angle: 45.0, blended: true, ..Person::adult() });
    let anatomy = &tubes.anatomy;
    let field = field_of(anatomy, SCALES);
    for (index, limb) in anatomy.limbs.iter().enumerate() {
        let is_arm = index < 2;
        let [first, second, last] = limb.parts.map(|part| PARTS[part]);
        let (spread, upper, lower, size) = if is_arm {
            (0.7, SCALES.upper_arm, SCALES.lower_arm, 0.9)
        } else {
            (0.65, SCALES.upper_leg, SCALES.lower_leg, 0.95)
        };
        let root = by_part(&field, Part::Torso, limb.root).with_x(spread * limb.root.x);
        let middle = root + upper.length * (limb.middle - limb.root);
        let end = middle + lower.length * (limb.end - limb.middle);
        assert_near("root", by_part(&field, first, limb.root), root);
        assert_near("elbow or knee of the upper part", by_part(&field, first, limb.middle), middle);
        assert_near("elbow or knee of the lower part", by_part(&field, second, limb.middle), middle);
        assert_near("wrist or ankle of the lower part", by_part(&field, second, limb.end), end);
        assert_near("wrist or ankle of the last part", by_part(&field, last, limb.end), end);
        // Across the bone it is as thick as it should be: z lies across every bone here.
        for (part, from, to, thickness) in
            [(first, limb.root, root, upper), (second, limb.middle, middle, lower)]
        {
            let across = by_part(&field, part, from + 0.02 * DVec3::Z);
            assert_near("thickness", across, to + 0.02 * thickness.thickness * DVec3::Z);
        }
        // Hands and feet keep their shape.
        let away = DVec3::new(0.02, -0.05, 0.03);
        assert_near("hand or foot", by_part(&field, last, limb.end + away), end + size * away);
    }
}

#[test]
fn legs_of_unequal_length_both_stand_on_the_ground() {
    let mut anatomy = blended().anatomy.clone();
    anatomy.limbs[2].end.y += 0.06;
    anatomy.limbs[2].middle.y += 0.04;
    let field = field_of(&anatomy, SCALES);
    for part in [Part::LeftFoot, Part::RightFoot] {
        let sole = by_part(&field, part, DVec3::new(0.1, 0.0, 0.05));
        assert!(sole.y.abs() < 1e-9, "{part:?}: {sole}");
    }
}

#[test]
fn torso_neck_and_head_meet_on_their_axis() {
    let mut anatomy = blended().anatomy.clone();
    anatomy.head_centre.z = 0.03;
    anatomy.head_joint.z = 0.01;
    let field = field_of(&anatomy, SCALES);
    let heights = anatomy.landmarks.heights;
    let base = DVec3::new(0.0, heights.shoulder_line, anatomy.centre_z(heights.shoulder_line).0);
    assert_near("shoulder line", by_part(&field, Part::Neck, base), by_part(&field, Part::Torso, base));
    let chin = DVec3::new(0.0, heights.chin, anatomy.head_joint.z);
    assert_near("chin", by_part(&field, Part::Head, chin), by_part(&field, Part::Neck, chin));
    assert_near("hair", by_part(&field, Part::Hair, chin), by_part(&field, Part::Head, chin));
}

#[test]
fn no_part_jumps_anywhere() {
    let Tubes { anatomy, .. } = blended();
    let mut bindings = PartBindings::default();
    bindings.pieces.push(Piece {
        anchor: DVec3::new(0.1, 1.0, 0.1),
        lowest: 0.9,
        weights: Part::Torso.alone(),
    });
    let field = PartField::new(anatomy, SCALES).with(None, &bindings.pieces);
    // A mixture of torso, neck and hair stands for blended weights.
    let mut mixed = Part::Torso.alone();
    (mixed[0], mixed[1], mixed[15]) = (0.5, 0.25, 0.25);
    let mixed = PartBinding {
        weights: mixed,
        attachment: Attachment::Plain,
        face: FaceBinding::None,
        is_skirt: false,
    };
    const STEP: f64 = 1e-4;
    let norm = |jacobian: DMat3| jacobian.to_cols_array().iter().map(|x| x * x).sum::<f64>().sqrt();
    for binding in PARTS.map(PartBinding::to).into_iter().chain([mixed]) {
        for from in [DVec3::new(0.03, -0.1, 0.06), DVec3::new(-0.2, -0.1, -0.1)] {
            let mut last: Option<(DVec3, Mapped)> = None;
            for step in 0..20_000 {
                // Upwards, and a little forward.
                let p = from + STEP * f64::from(step) * DVec3::new(0.0, 1.0, 0.05);
                let to = field.map(p, &binding);
                if let Some((before, last)) = last {
                    let stretch = norm(to.jacobian).max(norm(last.jacobian));
                    let jump = to.position.distance(last.position);
                    let most = 1.001 * stretch * p.distance(before);
                    assert!(jump <= most, "{binding:?}: {jump} over {most} at {p}");
                }
                last = Some((p, to));
            }
        }
    }
}

#[test]
fn jacobians_are_those_of_central_differences() {
    let mut anatomy = blended().anatomy.clone();
    let heights = anatomy.landmarks.heights;
    anatomy.centre_line =
        vec![(heights.crotch, 0.0), (heights.crotch + 0.2, 0.03), (heights.shoulder_line, -0.02)];
    anatomy.head_centre.z = 0.03;
    let mut bindings = PartBindings::default();
    let anchor = DVec3::new(0.1, 1.1, 0.1);
    bindings.pieces.push(Piece { anchor, lowest: 0.9, weights: Part::Torso.alone() });
    let parts = PartField::new(&anatomy, SCALES).with(None, &bindings.pieces);
    let chin = parts.after().chin;
    let curve = FaceMap { bottom: chin, top: chin + 0.3, squash: 0.8, curve: FaceCurve::F4 };
    let mut next = numbers(3);
    for face in [FaceShape::None, FaceShape::Curve(curve)] {
        let field = with_face(parts.clone(), face);
        for round in 0..4000 {
            let mut weights = [0.0; PART_COUNT];
            match round % 3 {
                0 => weights[round / 3 % PART_COUNT] = 1.0,
                _ => weights.iter_mut().for_each(|weight| *weight = (next() as f32 - 0.6).max(0.0)),
            }
            weights[0] += 0.01;
            let attachment = match round % 7 {
                0 => Attachment::OnFace(DVec3::new(0.0, heights.crown, 0.1)),
                1 => Attachment::Piece(0),
                _ => Attachment::Plain,
            };
            let binding =
                Binding::Parts(PartBinding { weights, attachment, face: FaceBinding::None, is_skirt: false });
            let p = DVec3::new(0.8 * next() - 0.4, 2.0 * next() - 0.1, 0.4 * next() - 0.2);
            let map = |p: DVec3| field.map(p, &binding);
            let step = 1e-6;
            // A corner within the step (a landmark) has two Jacobians.
            let (up, down) = (map(p + step * DVec3::Y).jacobian, map(p - step * DVec3::Y).jacobian);
            if (up - down).to_cols_array().iter().any(|x| x.abs() > 1e-4) {
                continue;
            }
            let error = jacobian_error(map, p, step);
            assert!(error < 1e-5, "{error} at {p}: {binding:?}");
            assert_eq!(field.place(p, &binding), map(p).position);
        }
    }
}

#[test]
fn the_other_side_moves_like_this_one() {
    let Tubes { figure, anatomy, bindings, .. } = blended();
    // To the last bit symmetric: what was read has the noise of floats.
    let mut anatomy = anatomy.clone();
    let mirror = |p: DVec3| DVec3::new(-p.x, p.y, p.z);
    anatomy.middle_x = 0.0;
    anatomy.head_centre.x = 0.0;
    for (left, right) in [(0, 1), (2, 3)] {
        let limb = anatomy.limbs[left];
        let other = &mut anatomy.limbs[right];
        (other.root, other.middle, other.end) = (mirror(limb.root), mirror(limb.middle), mirror(limb.end));
    }
    let field = field_of(&anatomy, SCALES);
    for (&p, binding) in figure.positions.iter().zip(&bindings.vertices).step_by(7) {
        let other = PartBinding { weights: mirrored_weights(&binding.weights), ..*binding };
        let (here, there) = (field.place(p, binding), field.place(mirror(p), &other));
        assert!(there.distance(mirror(here)) < 1e-12, "{p}: {here} and {there}");
    }
}

#[test]
fn a_piece_is_moved_and_scaled_as_one_and_does_not_sink_into_the_ground() {
    let Tubes { anatomy, .. } = blended();
    let before = anatomy.landmarks.heights;
    let piece = |anchor: DVec3, lowest: f64| Piece { anchor, lowest, weights: Part::Torso.alone() };
    let anchors = [DVec3::new(0.2, before.crotch + 0.2, 0.1), DVec3::new(0.2, 0.5 * before.crotch, 0.1)];
    let pieces = vec![
        piece(anchors[0], anchors[0].y - 0.1),
        // Down to the ground, and under it.
        piece(anchors[1], before.sole),
        piece(anchors[1], before.sole - 0.1),
    ];
    let field = PartField::new(anatomy, SCALES).with(None, &pieces);
    let on_torso = |p: DVec3| by_part(&field, Part::Torso, p);
    let slope = field.after().crotch / before.crotch;
    // The mean, in logarithms, of how the torso's map stretches along the axes.
    let free = [0.6, slope].map(|up: f64| (0.8 * 0.8 * up).cbrt());
    let away = DVec3::new(0.01, -0.02, 0.03);
    for (index, anchor, size) in [
        (0, anchors[0], free[0]),
        (1, anchors[1], free[1].min(on_torso(anchors[1]).y / anchors[1].y)),
        (2, anchors[1], free[1]),
    ] {
        let binding = PartBinding {
            weights: Part::Head.alone(),
            attachment: Attachment::Piece(index),
            face: FaceBinding::None,
            is_skirt: false,
        };
        let place = |p: DVec3| field.place(p, &binding);
        assert_near("anchor", place(anchor), on_torso(anchor));
        assert_near("size", place(anchor + away) - place(anchor), size * away);
    }
    let on_ground = PartBinding {
        weights: Part::Torso.alone(),
        attachment: Attachment::Piece(1),
        face: FaceBinding::None,
        is_skirt: false,
    };
    let lowest = field.place(anchors[1].with_y(before.sole), &on_ground);
    assert!(lowest.y > -1e-9, "{lowest}");
}

#[test]
fn what_sits_on_the_face_takes_the_face_map_of_one_point() {
    let Tubes { anatomy, .. } = blended();
    let field = field_of(anatomy, SCALES);
    let (chin, crown) = (field.after().chin, field.after().crown);
    let curve = FaceMap { bottom: chin, top: crown, squash: 0.8, curve: FaceCurve::F4 };
    let with_face = with_face(field.clone(), FaceShape::Curve(curve));
    let heights = anatomy.landmarks.heights;
    let centre = DVec3::new(0.0, heights.chin + 0.4 * heights.head_length(), 0.08);
    let binding = PartBinding {
        weights: Part::Head.alone(),
        attachment: Attachment::OnFace(centre),
        face: FaceBinding::None,
        is_skirt: false,
    };
    let shift = curve.map(by_part(&field, Part::Head, centre).y) - by_part(&field, Part::Head, centre).y;
    assert!(shift < -0.001, "{shift}");
    for away in [DVec3::ZERO, DVec3::new(0.05, 0.03, 0.02), DVec3::new(0.0, 0.3, 0.0)] {
        let expected = by_part(&field, Part::Head, centre + away) + shift * DVec3::Y;
        assert_near("on the face", with_face.place(centre + away, &Binding::Parts(binding)), expected);
    }
}
