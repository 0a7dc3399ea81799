//! Bone groups (§IV-A, §V-B3): what is measured of one, and how much it shrinks.

use super::{BodyShape, BoneShape};
use crate::character::Role;
use crate::character::bones::{Bone, bones};
use crate::geometry::{by_key, mean};
use crate::options::Options;
use serde::Serialize;
use std::collections::{BTreeMap, BTreeSet};

/// Length and radius of a bone group, model units.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct GroupShape {
    /// Sum over the group's bones, left and right.
    pub length: f64,
    /// Mean surrounding-mesh radius of the group's bones; absent where no ray met a surface.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub radius: Option<f64>,
}

/// alpha and beta of a group.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Coefficient {
    /// alpha_b.
    pub length_scale: f64,
    /// beta_b.
    pub thickness_scale: f64,
}

/// Length and radius of every bone group, measured over `roles` alone, so that two bodies can be compared.
pub fn group_shapes(
    shape: &BodyShape,
    roles: &BTreeSet<Role>,
    options: &Options,
) -> BTreeMap<String, GroupShape> {
    let shape = shape.restricted_to(roles);
    let measured = |bone: Bone| shape.bones.get(bone.key()).map(|&measured| (bone.group, measured));
    let groups = by_key(bones(&shape.roles(), &options.bone_groups).into_iter().filter_map(measured));
    let of_group = |bones: Vec<BoneShape>| GroupShape {
        length: bones.iter().fold(0.0, |sum, bone| sum + bone.length),
        radius: mean(bones.iter().filter_map(|bone| bone.radius)),
    };
    groups.into_iter().map(|(name, bones)| (name, of_group(bones))).collect()
}
