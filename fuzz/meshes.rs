//! Bytes become small meshes, with or without joints and weights, and go through rig, deformer, apply and report.

use super::{Bytes, figure, rest, shape, weights};
use std::sync::Arc;
use superdeform::internals::shape::Measured;
use superdeform::{
    BodyShape, Character, Deformer, FaceCurve, GarmentWeights, Joint, MeshKind, Mode, MorphTarget, Options,
    Repair, Rig, RigOptions, Role, Stage, Style, WeightMethod,
};

fn character(bytes: &mut Bytes) -> Character {
    let mut character = match bytes.byte() {
        0..90 => {
            let (columns, rings) = (3 + bytes.below(5), 2 + bytes.below(3));
            figure(columns, rings, bytes.chance(128), bytes.chance(128))
        }
        _ => Character::default(),
    };
    if bytes.chance(100) {
        for _ in 0..bytes.below(8) {
            let count = character.skeleton.joints.len();
            let parent = (count > 0 && bytes.chance(200)).then(|| bytes.below(count));
            let name = String::from_utf8_lossy(&bytes.text(12)).into_owned();
            character.skeleton.joints.push(Joint { name, parent, rest: rest(bytes) });
        }
    }
    let joint_count = character.skeleton.joints.len();
    if joint_count > 0 {
        for _ in 0..bytes.below(8).saturating_sub(3) {
            let role = Role::from_number(bytes.below(Role::COUNT)).unwrap();
            let joint = bytes.chance(200).then(|| bytes.below(joint_count));
            character.humanoid.set(role, joint);
        }
        for _ in 0..bytes.below(8).saturating_sub(5) {
            let joint = bytes.below(joint_count);
            character.skeleton.joints[joint].rest = rest(bytes);
        }
    }
    let kinds = [MeshKind::Body, MeshKind::Garment, MeshKind::Hair, MeshKind::FacePart, MeshKind::Accessory];
    for _ in 0..bytes.below(5) {
        let mut mesh = shape(bytes);
        let count = mesh.positions.len();
        mesh.kind = bytes.chance(160).then(|| bytes.of(&kinds));
        mesh.weights = weights(bytes, count, joint_count);
        if bytes.chance(40) {
            mesh.normals = (0..count).map(|_| bytes.point()).collect();
        }
        if bytes.chance(20) {
            mesh.tangents = (0..count).map(|_| bytes.point().extend(1.0)).collect();
        }
        if bytes.chance(30) {
            let positions = (0..count).map(|_| bytes.point()).collect();
            mesh.morph_targets.push(MorphTarget { positions, ..MorphTarget::default() });
        }
        character.meshes.push(mesh);
    }
    match bytes.byte() {
        0..200 => {}
        200..220 => character.axes.forward = Some(bytes.point()),
        220..240 => character.axes.up = bytes.point(),
        _ => {
            character.axes.up = [(); 3].map(|()| bytes.finite()).into();
            character.axes.forward = Some([(); 3].map(|()| bytes.finite()).into());
        }
    }
    if bytes.chance(30) {
        // All of it in another unit.
        let by = bytes.of(&[1e-40, 1e-12, 1e-6, 1e6, 1e12, 1e29]);
        for mesh in &mut character.meshes {
            mesh.positions.iter_mut().for_each(|p| *p *= by);
        }
        for joint in &mut character.skeleton.joints {
            joint.rest.w_axis = (joint.position() * f64::from(by)).extend(1.0);
        }
    }
    character
}

pub fn run(data: &[u8]) {
    let bytes = &mut Bytes(data);
    let mut options = Options {
        mode: bytes.of(&[Mode::Product, Mode::Paper]),
        stage: bytes.of(&[Stage::Face, Stage::Thickness, Stage::Length]),
        face_curve: bytes.of(&[FaceCurve::F4, FaceCurve::F2, FaceCurve::Sphere]),
        rays: Some(3 + bytes.below(6)),
        limits: bytes.chance(200),
        repair: bytes.of(&[Repair::On, Repair::Off, Repair::Kept]),
        thread_count: 1,
        ..Options::default()
    };
    if bytes.chance(60) {
        options.amount = f64::from(bytes.byte()) / 255.0;
        options.hair_length = f64::from(bytes.byte()) / 255.0;
        options.head_scale = 0.1 + f64::from(bytes.byte()) / 26.0;
        options.face_squash = Some(bytes.tame());
        options.youth = f64::from(bytes.byte()) / 255.0;
        options.seat = f64::from(bytes.byte()) / 255.0;
        options.hair_lay = f64::from(bytes.byte()) / 255.0;
        options.smile = f64::from(bytes.byte()) / 255.0;
    }
    let style = match bytes.below(4) {
        0 => Style::heads(2.0).unwrap(),
        1 => Style::heads(1.8 + f64::from(bytes.byte()) / 64.0).unwrap(),
        _ => Style::Shape(Box::new(BodyShape::built_in(bytes.of(&["sd2", "sd2.5", "sd4"])).unwrap())),
    };
    let given = bytes.below(6).saturating_sub(3);
    let mut rig_options = RigOptions {
        method: bytes.of(&[WeightMethod::Auto, WeightMethod::Heat, WeightMethod::Volume]),
        garments: bytes.of(&[GarmentWeights::Robust, GarmentWeights::Nearest, GarmentWeights::Heat]),
        heat: bytes.of(&[1.0, 0.01, 1000.0, 3.0]),
        left_handed: bytes.chance(128),
        voxel_resolution: bytes.of(&[16, 17, 32]),
        fingers: bytes.chance(128),
        thread_count: 1,
        ..RigOptions::default()
    };
    for _ in 0..given {
        let role = Role::from_number(bytes.below(Role::COUNT)).unwrap();
        rig_options.given.insert(role, [(); 3].map(|()| f64::from(bytes.finite())).into());
    }
    let make_rig = bytes.chance(128);
    let character = character(bytes);
    let deformer = match make_rig {
        true => {
            let Ok(rig) = Rig::of(&character, &rig_options) else { return };
            check(&rig, &character);
            Deformer::with_rig(&character, &rig, &style, &options)
        }
        false => Deformer::new(Arc::new(character), &style, &options),
    };
    let Ok(deformer) = deformer else { return };
    let deformed = deformer.apply();
    for (index, mesh) in deformed.meshes.iter().enumerate() {
        let deltas = mesh.morph_targets.iter().flat_map(|target| &target.positions);
        for p in mesh.positions.iter().chain(&mesh.normals).chain(deltas) {
            assert!(p.is_finite(), "mesh {index} has {p}");
        }
    }
    for (joint, p) in deformed.joints.iter().enumerate() {
        assert!(p.is_finite(), "joint {joint} is at {p}");
    }
    let _ = deformer.report(&deformed);
    let _ = Measured::of(&deformer.character().with(&deformed), &options);
}

/// What every made rig holds.
fn check(rig: &Rig, character: &Character) {
    let joints = &rig.skeleton.joints;
    assert_eq!(rig.confidence.len(), joints.len());
    for (joint, confidence) in joints.iter().zip(&rig.confidence) {
        assert!(joint.rest.is_finite(), "{} is at {}", joint.name, joint.position());
        assert!((0.0..=1.0).contains(confidence), "{} is sure by {confidence}", joint.name);
    }
    for weights in [&rig.weights, &rig.skin_weights] {
        assert_eq!(weights.len(), character.meshes.len());
        for (index, (weights, mesh)) in weights.iter().zip(&character.meshes).enumerate() {
            assert_eq!(weights.row_count(), mesh.positions.len());
            for (vertex, row) in weights.rows().enumerate() {
                let sum: f32 = row.iter().map(|&(_, weight)| weight).sum();
                let fit = row.iter().all(|&(joint, weight)| (joint as usize) < joints.len() && weight >= 0.0);
                assert!(fit && (sum - 1.0).abs() < 1e-3, "mesh {index}, vertex {vertex}: {row:?}");
            }
        }
    }
}
