//! Rigged characters in other poses, without their rigs: what is known of a pose is where its joints are.
#![allow(dead_code)]

use glam::{DQuat, DVec3};
use std::collections::BTreeMap;
use superdeform::Role::{self, *};
use superdeform::internals::character::Frame;
use superdeform::{Character, Humanoid, Skeleton, Weights};
use superdeform_host::write::extent;

/// The ways some bones run, each from a joint to the next of its limb: left, up, ahead of the character.
pub type Pose = Vec<(Role, DVec3)>;

/// Both sides alike: `bones` are of the left side.
fn mirrored(bones: &[(Role, [f64; 3])]) -> Pose {
    let both = bones.iter().flat_map(|&(role, [x, y, z])| {
        [(role, DVec3::new(x, y, z)), (role.mirrored(), DVec3::new(-x, y, z))]
    });
    both.collect()
}

/// Straight arms so many degrees under the horizontal.
pub fn arms(degrees: f64) -> Pose {
    let (sin, cos) = degrees.to_radians().sin_cos();
    mirrored(&[(LeftUpperArm, [cos, -sin, 0.0]), (LeftLowerArm, [cos, -sin, 0.0])])
}

/// Someone who sits on a chair, hands on the lap.
pub fn sitting() -> Pose {
    mirrored(&[
        (LeftUpperArm, [0.37, -0.93, 0.25]),
        (LeftLowerArm, [0.12, -0.45, 0.85]),
        (LeftUpperLeg, [0.18, -0.08, 1.0]),
        (LeftLowerLeg, [0.05, -1.0, 0.05]),
    ])
}

/// Hands on the hips, elbows out.
pub fn hands_on_hips() -> Pose {
    mirrored(&[(LeftUpperArm, [0.75, -0.62, -0.2]), (LeftLowerArm, [-0.72, -0.6, 0.35])])
}

/// Legs so many degrees aside.
pub fn legs_apart(degrees: f64) -> Pose {
    let (sin, cos) = degrees.to_radians().sin_cos();
    let mut pose = arms(30.0);
    pose.extend(mirrored(&[(LeftUpperLeg, [sin, -cos, 0.0]), (LeftLowerLeg, [sin, -cos, 0.0])]));
    pose
}

/// A step, arms swinging.
pub fn walking() -> Pose {
    [
        (LeftUpperArm, [0.3, -0.85, -0.45]),
        (LeftLowerArm, [0.2, -0.9, -0.2]),
        (RightUpperArm, [-0.3, -0.85, 0.45]),
        (RightLowerArm, [-0.15, -0.6, 0.75]),
        (LeftUpperLeg, [0.05, -0.87, 0.5]),
        (LeftLowerLeg, [0.05, -0.98, 0.15]),
        (RightUpperLeg, [-0.05, -0.95, -0.3]),
        (RightLowerLeg, [-0.05, -0.77, -0.64]),
    ]
    .map(|(role, way)| (role, DVec3::from_array(way)))
    .to_vec()
}

/// The joint that a bone of a limb leads to.
fn next(role: Role) -> Option<Role> {
    Some(match role {
        LeftUpperArm => LeftLowerArm,
        RightUpperArm => RightLowerArm,
        LeftLowerArm => LeftHand,
        RightLowerArm => RightHand,
        LeftUpperLeg => LeftLowerLeg,
        RightUpperLeg => RightLowerLeg,
        LeftLowerLeg => LeftFoot,
        RightLowerLeg => RightFoot,
        _ => return None,
    })
}

/// `character` in a pose, without joints and weights, and where its joints are then. `None` where a bone of the pose does
/// not hang from the one before it.
pub fn posed(character: &Character, pose: &Pose) -> Option<(Character, BTreeMap<Role, DVec3>)> {
    let frame = Frame::of(character).ok()?;
    let skeleton = &character.skeleton;
    let rest: Vec<DVec3> = skeleton.joints.iter().map(|joint| joint.position()).collect();
    let mut turns = vec![DQuat::IDENTITY; rest.len()];
    let mut at = rest.clone();
    for joint in skeleton.parents_first() {
        if let Some(parent) = skeleton.joints[joint].parent {
            turns[joint] = turns[parent];
            at[joint] = at[parent] + turns[parent] * (rest[joint] - rest[parent]);
        }
        let Some(&(role, way)) = pose.iter().find(|(role, _)| character.humanoid.joint(*role) == Some(joint))
        else {
            continue;
        };
        let end = character.humanoid.joint(next(role)?)?;
        if skeleton.ancestors(end).all(|above| above != joint) {
            return None;
        }
        let before = (turns[joint] * (rest[end] - rest[joint])).normalize();
        turns[joint] = DQuat::from_rotation_arc(before, frame.to_model(way).normalize()) * turns[joint];
    }
    let mut result = character.clone();
    for mesh in &mut result.meshes {
        for (p, row) in mesh.positions.iter_mut().zip(mesh.weights.rows()) {
            let moved = |&(joint, weight): &(u32, f32)| {
                let joint = joint as usize;
                f64::from(weight) * (at[joint] + turns[joint] * (p.as_dvec3() - rest[joint]))
            };
            let sum: f64 = row.iter().map(|&(_, weight)| f64::from(weight)).sum();
            if sum > 0.0 {
                *p = (row.iter().map(moved).sum::<DVec3>() / sum).as_vec3();
            }
        }
        mesh.weights = Weights::default();
        mesh.normals.clear();
        mesh.tangents.clear();
        mesh.morph_targets.clear();
    }
    let joints = character.humanoid.iter().map(|(role, joint)| (role, at[joint])).collect();
    result.skeleton = Skeleton::default();
    result.humanoid = Humanoid::default();
    result.axes.forward = None;
    Some((result, joints))
}

/// The height of a character along its up.
pub fn height(character: &Character) -> f64 {
    let meshes = character.meshes.iter().map(|mesh| mesh.positions.as_slice());
    let (low, high) = extent(meshes, character.axes.up.as_dvec3().normalize());
    high - low
}
