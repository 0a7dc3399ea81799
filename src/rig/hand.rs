//! Fingers by ray casting.

use super::FoundJoint;
use crate::character::Role;
use crate::geometry::Surface;
use glam::DVec3;
use std::collections::BTreeMap;

/// The fingers of one hand.
#[derive(Clone, Debug, Default)]
pub struct Hand {
    /// Joints by role, three a finger (left or right roles as asked for); a mitten has one chain, the middle finger's.
    pub joints: BTreeMap<Role, FoundJoint>,
    /// Where each finger ends, by the role of its distal joint.
    pub tips: BTreeMap<Role, DVec3>,
    /// How many fingers the hand shows, the thumb among them; 1 for a mitten or a fist, 0 where there is no hand.
    pub finger_count: usize,
}

/// Finds the fingers of the hand at `wrist`.
///
/// - `surface`: what the rays meet, layout space.
/// - `elbow`, `wrist`: joints of the arm, layout space.
/// - `left`: which side's roles to give.
pub fn find_fingers(
    _surface: &Surface,
    _positions: &[DVec3],
    _triangles: &[[u32; 3]],
    _elbow: DVec3,
    _wrist: DVec3,
    _left: bool,
) -> Hand {
    unimplemented!()
}
