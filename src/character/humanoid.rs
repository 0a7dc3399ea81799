//! Humanoid roles: the 55 of Unity's `HumanBodyBones` (same numbers), under the names of VRM 1.0.
//!
//! Two skeletons need not have the same joints (§IV-A asks for the same structure): both are read through their
//! roles, and a role that one of them lacks is skipped over in its chain.

use std::fmt;

/// The roles in Unity's order, each with its VRM 1.0 name and the role above it in the humanoid hierarchy.
macro_rules! roles {
    ($($role:ident: $name:literal, $above:expr;)+) => {
        /// A humanoid role. The discriminants are those of Unity's `HumanBodyBones`.
        #[allow(missing_docs)]
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
        #[repr(u8)]
        pub enum Role {
            $($role),+
        }

        const ROLES: [(Role, &str, Option<Role>); Role::COUNT] = [$((Role::$role, $name, $above)),+];
    };
}

roles! {
    Hips: "hips", None;
    LeftUpperLeg: "leftUpperLeg", Some(Hips);
    RightUpperLeg: "rightUpperLeg", Some(Hips);
    LeftLowerLeg: "leftLowerLeg", Some(LeftUpperLeg);
    RightLowerLeg: "rightLowerLeg", Some(RightUpperLeg);
    LeftFoot: "leftFoot", Some(LeftLowerLeg);
    RightFoot: "rightFoot", Some(RightLowerLeg);
    Spine: "spine", Some(Hips);
    Chest: "chest", Some(Spine);
    Neck: "neck", Some(UpperChest);
    Head: "head", Some(Neck);
    LeftShoulder: "leftShoulder", Some(UpperChest);
    RightShoulder: "rightShoulder", Some(UpperChest);
    LeftUpperArm: "leftUpperArm", Some(LeftShoulder);
    RightUpperArm: "rightUpperArm", Some(RightShoulder);
    LeftLowerArm: "leftLowerArm", Some(LeftUpperArm);
    RightLowerArm: "rightLowerArm", Some(RightUpperArm);
    LeftHand: "leftHand", Some(LeftLowerArm);
    RightHand: "rightHand", Some(RightLowerArm);
    LeftToes: "leftToes", Some(LeftFoot);
    RightToes: "rightToes", Some(RightFoot);
    LeftEye: "leftEye", Some(Head);
    RightEye: "rightEye", Some(Head);
    Jaw: "jaw", Some(Head);
    LeftThumbMetacarpal: "leftThumbMetacarpal", Some(LeftHand);
    LeftThumbProximal: "leftThumbProximal", Some(LeftThumbMetacarpal);
    LeftThumbDistal: "leftThumbDistal", Some(LeftThumbProximal);
    LeftIndexProximal: "leftIndexProximal", Some(LeftHand);
    LeftIndexIntermediate: "leftIndexIntermediate", Some(LeftIndexProximal);
    LeftIndexDistal: "leftIndexDistal", Some(LeftIndexIntermediate);
    LeftMiddleProximal: "leftMiddleProximal", Some(LeftHand);
    LeftMiddleIntermediate: "leftMiddleIntermediate", Some(LeftMiddleProximal);
    LeftMiddleDistal: "leftMiddleDistal", Some(LeftMiddleIntermediate);
    LeftRingProximal: "leftRingProximal", Some(LeftHand);
    LeftRingIntermediate: "leftRingIntermediate", Some(LeftRingProximal);
    LeftRingDistal: "leftRingDistal", Some(LeftRingIntermediate);
    LeftLittleProximal: "leftLittleProximal", Some(LeftHand);
    LeftLittleIntermediate: "leftLittleIntermediate", Some(LeftLittleProximal);
    LeftLittleDistal: "leftLittleDistal", Some(LeftLittleIntermediate);
    RightThumbMetacarpal: "rightThumbMetacarpal", Some(RightHand);
    RightThumbProximal: "rightThumbProximal", Some(RightThumbMetacarpal);
    RightThumbDistal: "rightThumbDistal", Some(RightThumbProximal);
    RightIndexProximal: "rightIndexProximal", Some(RightHand);
    RightIndexIntermediate: "rightIndexIntermediate", Some(RightIndexProximal);
    RightIndexDistal: "rightIndexDistal", Some(RightIndexIntermediate);
    RightMiddleProximal: "rightMiddleProximal", Some(RightHand);
    RightMiddleIntermediate: "rightMiddleIntermediate", Some(RightMiddleProximal);
    RightMiddleDistal: "rightMiddleDistal", Some(RightMiddleIntermediate);
    RightRingProximal: "rightRingProximal", Some(RightHand);
    RightRingIntermediate: "rightRingIntermediate", Some(RightRingProximal);
    RightRingDistal: "rightRingDistal", Some(RightRingIntermediate);
    RightLittleProximal: "rightLittleProximal", Some(RightHand);
    RightLittleIntermediate: "rightLittleIntermediate", Some(RightLittleProximal);
    RightLittleDistal: "rightLittleDistal", Some(RightLittleIntermediate);
    UpperChest: "upperChest", Some(Chest);
}

use Role::*;

/// The roles without which nothing can be deformed.
pub const REQUIRED_ROLES: [Role; 6] = [Hips, Head, LeftUpperLeg, RightUpperLeg, LeftUpperArm, RightUpperArm];

/// The roles of the left leg from the hip joint down.
pub const LEFT_LEG: [Role; 4] = [LeftUpperLeg, LeftLowerLeg, LeftFoot, LeftToes];

/// The roles of the left arm from the collarbone on.
pub const LEFT_ARM: [Role; 4] = [LeftShoulder, LeftUpperArm, LeftLowerArm, LeftHand];

/// The roles of each finger of the left hand from its root to its tip, thumb first.
pub const LEFT_FINGERS: [[Role; 3]; 5] = [
    [LeftThumbMetacarpal, LeftThumbProximal, LeftThumbDistal],
    [LeftIndexProximal, LeftIndexIntermediate, LeftIndexDistal],
    [LeftMiddleProximal, LeftMiddleIntermediate, LeftMiddleDistal],
    [LeftRingProximal, LeftRingIntermediate, LeftRingDistal],
    [LeftLittleProximal, LeftLittleIntermediate, LeftLittleDistal],
];

impl Role {
    /// How many roles there are. VRM 1.0 and Unity's `HumanBodyBones`.
    pub const COUNT: usize = 55;

    /// All roles in Unity's order.
    pub fn all() -> impl Iterator<Item = Role> {
        ROLES.iter().map(|&(role, _, _)| role)
    }

    /// The role with Unity's number `number`.
    pub fn from_number(number: usize) -> Option<Role> {
        ROLES.get(number).map(|&(role, _, _)| role)
    }

    /// The VRM 1.0 name, such as `leftUpperLeg`.
    pub fn name(self) -> &'static str {
        ROLES[self as usize].1
    }

    /// The role above this one in the humanoid hierarchy; `None` for the hips.
    pub fn parent(self) -> Option<Role> {
        ROLES[self as usize].2
    }

    /// The role itself, the one above it, and so on up to the hips.
    pub fn chain(self) -> impl Iterator<Item = Role> {
        std::iter::successors(Some(self), |role| role.parent())
    }

    /// The same role on the other side; itself for roles in the middle.
    pub fn mirrored(self) -> Role {
        let name = self.name();
        let other = match (name.strip_prefix("left"), name.strip_prefix("right")) {
            (Some(rest), _) => format!("right{rest}"),
            (_, Some(rest)) => format!("left{rest}"),
            _ => return self,
        };
        ROLES.iter().find(|(_, name, _)| *name == other).map_or(self, |&(role, _, _)| role)
    }

    /// True for roles on the left side.
    pub fn is_left(self) -> bool {
        self.name().starts_with("left")
    }

    /// True for the head and what moves with it: eyes and jaw.
    pub fn is_head(self) -> bool {
        matches!(self, Head | LeftEye | RightEye | Jaw)
    }

    /// True for arms and legs, from upper arm and upper leg to the tips of fingers and toes.
    pub fn is_limb(self) -> bool {
        let is_trunk =
            matches!(self, Hips | Spine | Chest | UpperChest | LeftShoulder | RightShoulder | Neck);
        !(is_trunk || self.is_head())
    }

    /// This role where `left`, else the one on the other side; for roles of the left side.
    pub(crate) fn on_side(self, left: bool) -> Role {
        if left { self } else { self.mirrored() }
    }
}

impl fmt::Display for Role {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// Which joint plays which role.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Humanoid {
    joints: [Option<usize>; Role::COUNT],
}

impl Default for Humanoid {
    fn default() -> Self {
        Self { joints: [None; Role::COUNT] }
    }
}

impl Humanoid {
    /// The joint of `role`.
    pub fn joint(&self, role: Role) -> Option<usize> {
        self.joints[role as usize]
    }

    /// True where a joint plays `role`.
    pub fn has(&self, role: Role) -> bool {
        self.joint(role).is_some()
    }

    /// Gives `role` to `joint`, or takes it from every joint.
    pub fn set(&mut self, role: Role, joint: impl Into<Option<usize>>) {
        self.joints[role as usize] = joint.into();
    }

    /// Does the same for several roles of the left side, or their twins unless `left`; for as many as there are joints.
    pub(crate) fn set_on_side<Joint: Into<Option<usize>>>(
        &mut self,
        left: bool,
        roles: impl IntoIterator<Item = Role>,
        joints: impl IntoIterator<Item = Joint>,
    ) {
        roles.into_iter().zip(joints).for_each(|(role, joint)| self.set(role.on_side(left), joint));
    }

    /// The roles that a joint plays, with their joints, in Unity's order.
    pub fn iter(&self) -> impl Iterator<Item = (Role, usize)> + '_ {
        Role::all().filter_map(|role| self.joint(role).map(|joint| (role, joint)))
    }

    /// The nearest role above `role` that a joint plays.
    pub fn parent_of(&self, role: Role) -> Option<Role> {
        role.chain().skip(1).find(|&above| self.has(above))
    }

    /// The required roles (hips, head, upper legs, upper arms) that no joint plays.
    pub fn missing(&self) -> Vec<Role> {
        REQUIRED_ROLES.into_iter().filter(|&role| !self.has(role)).collect()
    }
}
