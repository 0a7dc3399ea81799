//! The parts of a body that product mode moves by one map each, and a vertex's weights to them.

use crate::character::Role;
use crate::character::humanoid::LEFT_FINGERS;

/// One of the parts of a body that move by one map each: fifteen, and hair, whose map is the head's above the chin.
#[allow(missing_docs)]
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[repr(u8)]
pub enum Part {
    Torso,
    Neck,
    Head,
    LeftUpperArm,
    LeftLowerArm,
    LeftHand,
    RightUpperArm,
    RightLowerArm,
    RightHand,
    LeftUpperLeg,
    LeftLowerLeg,
    LeftFoot,
    RightUpperLeg,
    RightLowerLeg,
    RightFoot,
    /// What moves with the head, but below the chin follows the heights of the body.
    Hair,
}

/// The numbers of parts.
pub const TORSO: usize = Part::Torso as usize;
/// See [`TORSO`].
pub const NECK: usize = Part::Neck as usize;
/// See [`TORSO`].
pub const HEAD: usize = Part::Head as usize;
/// See [`TORSO`].
pub const HAIR: usize = Part::Hair as usize;

/// Divides in place of a length that may be 0.
pub const TINY: f64 = 1e-30;

/// How many parts there are, hair included.
pub const PART_COUNT: usize = 16;

impl Part {
    /// The part that the role's joint moves.
    pub fn of(role: Role) -> Part {
        use Role::*;
        match role {
            Hips | Spine | Chest | UpperChest | LeftShoulder | RightShoulder => Part::Torso,
            Neck => Part::Neck,
            Head | LeftEye | RightEye | Jaw => Part::Head,
            LeftUpperArm => Part::LeftUpperArm,
            LeftLowerArm => Part::LeftLowerArm,
            RightUpperArm => Part::RightUpperArm,
            RightLowerArm => Part::RightLowerArm,
            LeftUpperLeg => Part::LeftUpperLeg,
            LeftLowerLeg => Part::LeftLowerLeg,
            LeftFoot | LeftToes => Part::LeftFoot,
            RightUpperLeg => Part::RightUpperLeg,
            RightLowerLeg => Part::RightLowerLeg,
            RightFoot | RightToes => Part::RightFoot,
            // The rest are hands and fingers.
            other if other.is_left() => Part::LeftHand,
            _ => Part::RightHand,
        }
    }

    /// The weights of what this part alone moves.
    pub fn alone(self) -> PartWeights {
        let mut weights = [0.0; PART_COUNT];
        weights[self as usize] = 1.0;
        weights
    }
}

/// Weights to the parts, in the order of [`Part`].
pub type PartWeights = [f32; PART_COUNT];

/// A vertex's role weights summed by part.
pub fn fold_to_parts(role_weights: &[(Role, f64)]) -> PartWeights {
    let mut parts = [0.0; PART_COUNT];
    for &(role, weight) in role_weights {
        parts[Part::of(role) as usize] += weight as f32;
    }
    parts
}

/// The roles of the bones of each finger, thumb first, whose first bone lies in the palm.
pub fn digits(left: bool) -> [[Role; 3]; 5] {
    LEFT_FINGERS.map(|finger| finger.map(|role| role.on_side(left)))
}

/// Adds `factor` times `row` to `sum`.
pub fn add(sum: &mut PartWeights, row: &PartWeights, factor: f32) {
    for (sum, weight) in sum.iter_mut().zip(row) {
        *sum += weight * factor;
    }
}
