//! Bones as pairs of humanoid roles, and the groups that deform alike (§IV-A, Fig. 3).
//!
//! The paper asks for two skeletons of the same structure. Bones between roles give that for any two skeletons: a role
//! that a skeleton lacks is skipped over, and one bone then stands for the two that it joins.

use super::Role;
use Role::*;
use std::collections::{BTreeMap, BTreeSet};
use std::fmt;

/// The built-in bone groups, from the head down, with their names.
macro_rules! groups {
    ($($(#[doc = $text:literal])+ $group:ident: $name:literal;)+) => {
        /// The built-in bone groups; left and right belong together.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
        pub enum Group {
            $($(#[doc = $text])+ $group),+
        }

        impl Group {
            /// All groups, from the head down.
            pub const ALL: [Group; [$($name),+].len()] = [$(Group::$group),+];

            /// The name in options and reports, such as `upper_arm`.
            pub fn name(self) -> &'static str {
                [$($name),+][self as usize]
            }
        }
    };
}

groups! {
    /// Head joint to head top.
    Head: "head";
    /// Neck joint to head joint.
    Neck: "neck";
    /// Hips to neck joint.
    Torso: "torso";
    /// Chest to upper arm.
    Shoulder: "shoulder";
    /// Upper arm to elbow.
    UpperArm: "upper_arm";
    /// Elbow to wrist.
    LowerArm: "lower_arm";
    /// Wrist to the first joint of each finger: the palm.
    Hand: "hand";
    /// Between the joints of a finger.
    Finger: "finger";
    /// Hips to upper leg.
    Hip: "hip";
    /// Upper leg to knee.
    UpperLeg: "upper_leg";
    /// Knee to ankle.
    LowerLeg: "lower_leg";
    /// Ankle to toes.
    Foot: "foot";
}

impl Group {
    /// The group named `name`.
    pub fn from_name(name: &str) -> Option<Group> {
        Group::ALL.into_iter().find(|group| group.name() == name)
    }

    /// The group of the bone that ends at `child` in a complete skeleton; `None` where no bone ends: hips, eyes, jaw.
    pub fn ending_at(child: Role) -> Option<Group> {
        Some(match child {
            Hips | LeftEye | RightEye | Jaw => return None,
            Spine | Chest | UpperChest | Neck => Group::Torso,
            Head => Group::Neck,
            LeftShoulder | RightShoulder | LeftUpperArm | RightUpperArm => Group::Shoulder,
            LeftLowerArm | RightLowerArm => Group::UpperArm,
            LeftHand | RightHand => Group::LowerArm,
            LeftUpperLeg | RightUpperLeg => Group::Hip,
            LeftLowerLeg | RightLowerLeg => Group::UpperLeg,
            LeftFoot | RightFoot => Group::LowerLeg,
            LeftToes | RightToes => Group::Foot,
            finger if matches!(finger.parent(), Some(LeftHand | RightHand)) => Group::Hand,
            _ => Group::Finger,
        })
    }

    /// The group of the limb that begins at `joint`, for a joint at which a skeleton ends: `hand` for a hand without
    /// fingers, `finger` for a finger's last joint.
    pub fn beginning_at(joint: Role) -> Group {
        match joint {
            Head => Group::Head,
            LeftToes | RightToes => Group::Foot,
            LeftShoulder | RightShoulder => Group::Shoulder,
            LeftHand | RightHand => Group::Hand,
            Hips | LeftEye | RightEye | Jaw => Group::Torso,
            _ => Role::all()
                .find(|child| child.parent() == Some(joint))
                .and_then(Group::ending_at)
                .or(Group::ending_at(joint))
                .unwrap_or(Group::Torso),
        }
    }
}

impl fmt::Display for Group {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// The name of the head bone's end, which is no joint: [`Bone::key`] of the bone from the head joint to the head top.
pub const HEAD_TOP: &str = "headTop";

/// A bone.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Bone {
    /// The role at its beginning.
    pub parent: Role,
    /// The role at its end; `None` for the head bone, which ends at the head top.
    pub child: Option<Role>,
    /// The built-in group, whose constants apply.
    pub kind: Group,
    /// The group's name: the built-in one, or the user's own.
    pub group: String,
}

impl Bone {
    /// The bone's name: that of the role at its end, or [`HEAD_TOP`].
    pub fn key(&self) -> &'static str {
        self.child.map_or(HEAD_TOP, Role::name)
    }
}

/// The bones between `roles`, parents first: each runs to a role from the nearest role above it; last comes the head
/// bone, from the head joint to the head top. Eyes and jaw are no bones.
///
/// A bone that stands for several bones of a complete skeleton has the group of the first of them, at its beginning:
/// chest to head without a neck joint is torso. A bone from spine or chest to an arm is a shoulder.
///
/// - `groups`: the user's own groups (§IV-A): the role at a bone's end (in a complete skeleton) to a group name. The
///   head bone ends at no role and is always `head`; `Role::Head` names the bone from neck to head.
pub fn bones(roles: &BTreeSet<Role>, groups: &BTreeMap<Role, String>) -> Vec<Bone> {
    let mut ends: Vec<Role> =
        roles.iter().copied().filter(|&role| Group::ending_at(role).is_some()).collect();
    // Unity numbers the upper chest last, so numbers alone do not put parents first.
    ends.sort_by_key(|role| (role.chain().count(), *role));
    let mut bones: Vec<Bone> = ends
        .into_iter()
        .filter_map(|child| {
            let parent = child.chain().skip(1).find(|above| roles.contains(above))?;
            let first = first_of(parent, child)?;
            let kind = Group::ending_at(first)?;
            let group = groups.get(&first).cloned().unwrap_or_else(|| kind.name().to_string());
            Some(Bone { parent, child: Some(child), kind, group })
        })
        .collect();
    if roles.contains(&Head) {
        bones.push(Bone {
            parent: Head,
            child: None,
            kind: Group::Head,
            group: Group::Head.name().to_string(),
        });
    }
    bones
}

/// The end of the first of those bones of a complete skeleton for which the bone from `parent` to `child` stands. From
/// the trunk to an arm it is the shoulder's: without an upper chest, chest to shoulder is no torso.
fn first_of(parent: Role, child: Role) -> Option<Role> {
    let is_of_trunk = matches!(parent, Spine | Chest | UpperChest);
    let is_arm = |role: &Role| is_of_trunk && Group::ending_at(*role) == Some(Group::Shoulder);
    let path = || child.chain().take_while(|&role| role != parent);
    path().filter(is_arm).last().or_else(|| path().last())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn found(roles: &[Role]) -> Vec<(Role, Option<Role>, Group)> {
        let bones = bones(&roles.iter().copied().collect(), &BTreeMap::new());
        bones.iter().map(|bone| (bone.parent, bone.child, bone.kind)).collect()
    }

    #[test]
    fn a_complete_skeleton_has_a_bone_for_every_role_but_hips_eyes_and_jaw() {
        let bones = bones(&Role::all().collect(), &BTreeMap::new());
        assert_eq!(bones.len(), Role::COUNT - 4 + 1);
        for (index, bone) in bones.iter().enumerate() {
            let above = bones[..index].iter().any(|other| other.child == Some(bone.parent));
            assert!(above || bone.parent == Hips, "{bone:?}");
            assert_eq!(Group::from_name(&bone.group), Some(bone.kind));
        }
    }

    #[test]
    fn a_missing_role_is_skipped_over_and_the_first_bone_names_the_group() {
        assert_eq!(
            found(&[Hips, Chest, Head, LeftUpperLeg, LeftFoot]),
            [
                (Hips, Some(LeftUpperLeg), Group::Hip),
                (Hips, Some(Chest), Group::Torso),
                (LeftUpperLeg, Some(LeftFoot), Group::UpperLeg),
                (Chest, Some(Head), Group::Torso),
                (Head, None, Group::Head),
            ]
        );
        assert_eq!(found(&[Hips, Neck]), [(Hips, Some(Neck), Group::Torso)]);
    }

    #[test]
    fn a_shoulder_on_the_chest_or_the_spine_is_no_torso() {
        let shoulder = (Chest, Some(LeftShoulder), Group::Shoulder);
        assert!(found(&[Hips, Chest, LeftShoulder, LeftUpperArm]).contains(&shoulder));
        assert!(found(&[Hips, Spine, LeftUpperArm]).contains(&(Spine, Some(LeftUpperArm), Group::Shoulder)));
        assert!(found(&[Hips, LeftUpperArm]).contains(&(Hips, Some(LeftUpperArm), Group::Torso)));
    }

    #[test]
    fn palms_and_fingers_are_told_apart() {
        assert_eq!(Group::ending_at(LeftThumbMetacarpal), Some(Group::Hand));
        assert_eq!(Group::ending_at(RightLittleProximal), Some(Group::Hand));
        assert_eq!(Group::ending_at(RightLittleIntermediate), Some(Group::Finger));
        assert_eq!(Group::beginning_at(LeftHand), Group::Hand);
        assert_eq!(Group::beginning_at(LeftFoot), Group::Foot);
        assert_eq!(Group::beginning_at(LeftIndexDistal), Group::Finger);
        assert_eq!(Group::beginning_at(LeftUpperArm), Group::UpperArm);
    }

    #[test]
    fn a_user_renames_groups_and_the_head_stays() {
        let groups = BTreeMap::from([(LeftLowerLeg, "legs".to_string()), (Head, "throat".to_string())]);
        let bones = bones(&Role::all().collect(), &groups);
        let group = |child| bones.iter().find(|bone| bone.child == child).unwrap().group.clone();
        assert_eq!(group(Some(LeftLowerLeg)), "legs");
        assert_eq!(group(Some(RightLowerLeg)), "upper_leg");
        assert_eq!(group(Some(Head)), "throat");
        assert_eq!(group(None), "head");
    }
}
