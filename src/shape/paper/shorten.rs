//! Shortens the skeleton (§V-B1, Eqs. 1-4).

use crate::character::Role;
use crate::character::bones::Bone;
use crate::shape::Coefficient;
use glam::DVec3;
use std::collections::BTreeMap;

/// A shortened skeleton.
#[derive(Clone, Debug, PartialEq)]
pub struct Shortened {
    /// Where the joints are now; roles without a bone (eyes, jaw) are left out.
    pub joints: BTreeMap<Role, DVec3>,
    /// Where the head top is now.
    pub head_top: DVec3,
}

/// The joints after every bone has been scaled by its group's alpha, from the hips down; the hips stay.
///
/// Paper: §V-B1, Eqs. 1-4.
///
/// - `bones`: parents first. `joints`, `head_top`: the rest pose. Bones whose joints are not known are passed over.
/// - `coefficients`: by group name; a group without one keeps its length.
pub fn shorten(
    bones: &[Bone],
    joints: &BTreeMap<Role, DVec3>,
    head_top: DVec3,
    coefficients: &BTreeMap<String, Coefficient>,
) -> Shortened {
    let hips = joints.get_key_value(&Role::Hips).map(|(&role, &p)| (role, p));
    let mut shortened = Shortened { joints: hips.into_iter().collect(), head_top };
    for bone in bones {
        let (Some(&parent), Some(&new_parent)) =
            (joints.get(&bone.parent), shortened.joints.get(&bone.parent))
        else {
            continue;
        };
        let length_scale = coefficients.get(&bone.group).map_or(1.0, |coefficient| coefficient.length_scale);
        // Eq. 1 scales the bone; the parent has moved already, and Eqs. 2 and 3 move all that hangs from it along.
        match bone.child {
            Some(child) => {
                if let Some(&p) = joints.get(&child) {
                    shortened.joints.insert(child, new_parent + length_scale * (p - parent));
                }
            }
            // Eq. 4.
            None => shortened.head_top = new_parent + length_scale * (head_top - parent),
        }
    }
    shortened
}
