//! From found joints to a skeleton, and to the bones that weights start from.

use super::WeightBone;
use crate::character::{Humanoid, Joint, Role, Skeleton};
use glam::{DMat4, DVec3};
use std::collections::BTreeMap;

/// How far towards the chin the head's second segment goes (D13). Seen: at -30 %, vertices move up to 0.008 H; at
/// +30 %, vertices move up to 0.006 H.
const CHIN_SHARE: f64 = 0.8;

/// A skeleton whose joints are `joints`, in the order of their roles, each called by its role and hanging from the
/// nearest role above; no joint turns or scales.
pub fn skeleton_of(joints: &BTreeMap<Role, DVec3>) -> (Skeleton, Humanoid) {
    let mut humanoid = Humanoid::default();
    for (index, &role) in joints.keys().enumerate() {
        humanoid.set(role, index);
    }
    let joints = joints.iter().map(|(&role, &at)| Joint {
        name: role.to_string(),
        parent: humanoid.parent_of(role).and_then(|above| humanoid.joint(above)),
        rest: DMat4::from_translation(at),
    });
    (Skeleton { joints: joints.collect() }, humanoid)
}

/// The bones that weights start from, one for each of `joints` but eyes and jaw; `joint` counts in the order of roles.
///
/// A bone reaches from its joint to each child joint; the last of a chain to its tip (of `tips`, by role), or is a point
/// where none is known. A chest has no segments to shoulders, which have bones of their own. `chin` gives the head a
/// second segment, without which jaws are nearest to the neck.
pub fn weight_bones(
    joints: &BTreeMap<Role, DVec3>,
    tips: &BTreeMap<Role, DVec3>,
    chin: Option<DVec3>,
) -> Vec<WeightBone> {
    let (_, humanoid) = skeleton_of(joints);
    let is_bone = |role: Role| !matches!(role, Role::LeftEye | Role::RightEye | Role::Jaw);
    let mut bones = Vec::with_capacity(joints.len());
    for (joint, (&role, &at)) in joints.iter().enumerate() {
        if !is_bone(role) {
            continue;
        }
        let children = joints.iter().filter(|&(&child, _)| {
            is_bone(child)
                && !matches!(child, Role::LeftShoulder | Role::RightShoulder)
                && humanoid.parent_of(child) == Some(role)
        });
        let mut segments: Vec<[DVec3; 2]> = match role {
            Role::Head => Vec::new(),
            _ => children.map(|(_, &end)| [at, end]).collect(),
        };
        if segments.is_empty() {
            segments.push([at, tips.get(&role).copied().unwrap_or(at)]);
        }
        if let (Role::Head, Some(chin)) = (role, chin) {
            segments.push([at, at.lerp(chin, CHIN_SHARE)]);
        }
        bones.push(WeightBone { joint: joint as u32, segments });
    }
    bones
}
