//! Bone groups (§IV-A, §V-B3): what is measured of one, and how much it shrinks.

use super::BodyShape;
use crate::character::Role;
use crate::character::bones::bones;
use crate::geometry::mean;
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
    let common: BTreeSet<Role> = shape.roles();
    let mut radii: BTreeMap<String, Vec<f64>> = BTreeMap::new();
    let mut groups: BTreeMap<String, GroupShape> = BTreeMap::new();
    for bone in bones(&common, &options.bone_groups) {
        let Some(measured) = shape.bones.get(bone.key()) else {
            continue;
        };
        groups.entry(bone.group.clone()).or_default().length += measured.length;
        radii.entry(bone.group).or_default().extend(measured.radius);
    }
    for (name, group) in &mut groups {
        group.radius = mean(radii[name].iter().copied());
    }
    groups
}
