//! A skeleton by ray casting (Lopez and Poirel, reference 12).

use super::{FoundJoint, Layout};
use crate::character::Role;
use crate::error::Warning;
use glam::DVec3;
use std::collections::BTreeMap;

/// What the rays found.
#[derive(Clone, Debug, Default)]
pub struct FoundJoints {
    /// By role: hips, spine, chest, neck, head, and of each side shoulder, arm, hand, leg, foot, toes, and fingers where
    /// they are seen.
    pub joints: BTreeMap<Role, FoundJoint>,
    /// Where chains end: the crown under `Head`, the tip of the foot under `LeftToes`, fingertips under their distal
    /// joints (or the tip of a hand without fingers under `LeftHand`).
    pub tips: BTreeMap<Role, DVec3>,
    /// The chin, on the front of the face.
    pub chin: DVec3,
    /// What a person should know.
    pub warnings: Vec<Warning>,
}

/// Finds the joints of the figure in `layout`. Never fails: what is not seen is placed by ratio.
///
/// `given` joints (layout space) stay where they are, with confidence 1, and the rest is found around them.
pub fn find_joints(
    _layout: &Layout,
    _given: &BTreeMap<Role, DVec3>,
    _fingers: bool,
    _thread_count: usize,
) -> FoundJoints {
    unimplemented!()
}
