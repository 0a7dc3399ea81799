//! Whose settings each part follows: those of a built-in bone group, or of the user's own (§IV-A, Fig. 3).

use crate::character::Role;
use crate::character::bones::{Group, bones};
use crate::error::{Error, ErrorKind, Result, Warning};
use crate::options::GroupSettings;
use std::collections::{BTreeMap, BTreeSet};

/// The name of the bone group that each part belongs to.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct PartGroups {
    /// Where it is not the built-in one's.
    own: BTreeMap<Group, String>,
}

impl PartGroups {
    /// The groups of a figure of these `roles`, and a warning for each part whose bones are in several: `group_split`.
    ///
    /// `own`: the user's own groups, the role at a bone's end to a name. A part moves as one, so it follows the group that
    /// holds most of its bones; of several, an own one.
    pub fn of(roles: &BTreeSet<Role>, own: &BTreeMap<Role, String>) -> (Self, Vec<Warning>) {
        let (of_figure, of_all) = (bones(roles, own), bones(&Role::all().collect(), own));
        let mut groups = Self::default();
        let mut warnings = Vec::new();
        for kind in Group::ALL {
            // Hands without fingers and feet without toes have no bones of their own, but are parts.
            let has_bones = of_figure.iter().any(|bone| bone.kind == kind);
            let bones = if has_bones { &of_figure } else { &of_all };
            let mut counts: BTreeMap<&str, usize> = BTreeMap::new();
            for bone in bones.iter().filter(|bone| bone.kind == kind) {
                *counts.entry(&bone.group).or_default() += 1;
            }
            let rank = |(name, count): &(&&str, &usize)| (**count, **name != kind.name());
            let Some((&name, _)) = counts.iter().rev().max_by_key(rank) else { continue };
            if counts.len() > 1 {
                let names: Vec<&str> = counts.keys().copied().collect();
                let message = format!(
                    "the bones of {kind} are in the groups {}: product mode scales them as one, as {name} says",
                    names.join(" and ")
                );
                warnings.push(Warning::new("group_split", message).about("bone_groups"));
            }
            if name != kind.name() {
                groups.own.insert(kind, name.to_string());
            }
        }
        (groups, warnings)
    }

    /// The group that the parts of `kind` belong to.
    pub fn name(&self, kind: Group) -> &str {
        self.own.get(&kind).map_or(kind.name(), String::as_str)
    }

    /// Checks that every group that is set is one.
    ///
    /// # Errors
    /// `ErrorKind::BadOption` names the first that is not, and all that are.
    pub fn check(&self, settings: &BTreeMap<String, GroupSettings>) -> Result<()> {
        let known: BTreeSet<&str> =
            Group::ALL.map(Group::name).into_iter().chain(self.own.values().map(String::as_str)).collect();
        let Some(unknown) = settings.keys().find(|name| !known.contains(name.as_str())) else {
            return Ok(());
        };
        let known: Vec<&str> = known.into_iter().collect();
        let message = format!("there is no bone group {unknown}: give one of {}", known.join(", "));
        Err(Error::new(ErrorKind::BadOption, message).about("groups"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::character::Role::*;

    fn own(groups: &[(Role, &str)]) -> BTreeMap<Role, String> {
        groups.iter().map(|&(role, name)| (role, name.to_string())).collect()
    }

    #[test]
    fn parts_belong_to_the_built_in_groups_unless_a_user_says_otherwise() {
        let (groups, warnings) = PartGroups::of(&Role::all().collect(), &BTreeMap::new());
        assert_eq!((groups, warnings), (PartGroups::default(), Vec::new()));
    }

    #[test]
    fn a_part_belongs_to_the_group_of_its_bones() {
        let legs = [LeftLowerLeg, RightLowerLeg, LeftFoot, RightFoot].map(|role| (role, "legs"));
        let (groups, warnings) = PartGroups::of(&Role::all().collect(), &own(&legs));
        assert_eq!([groups.name(Group::UpperLeg), groups.name(Group::LowerLeg)], ["legs", "legs"]);
        assert_eq!(groups.name(Group::Foot), "foot");
        assert_eq!(warnings, []);
    }

    #[test]
    fn a_foot_without_toes_belongs_to_the_group_of_the_bone_that_it_would_have() {
        let roles = BTreeSet::from([Hips, LeftUpperLeg, LeftLowerLeg, LeftFoot]);
        let (groups, warnings) = PartGroups::of(&roles, &own(&[(LeftToes, "feet"), (RightToes, "feet")]));
        assert_eq!(groups.name(Group::Foot), "feet");
        assert_eq!(warnings, []);
    }

    #[test]
    fn a_part_whose_bones_are_in_several_groups_is_warned_of() {
        let (groups, warnings) = PartGroups::of(&Role::all().collect(), &own(&[(LeftLowerLeg, "left")]));
        assert_eq!(groups.name(Group::UpperLeg), "left");
        assert_eq!(warnings.len(), 1);
        assert_eq!((warnings[0].code, warnings[0].option), ("group_split", Some("bone_groups")));
        assert!(warnings[0].message.contains("left and upper_leg"), "{}", warnings[0].message);
        // Of spine, chest, upper chest and neck, one goes its own way.
        let (groups, warnings) = PartGroups::of(&Role::all().collect(), &own(&[(Neck, "chest")]));
        assert_eq!(groups.name(Group::Torso), "torso");
        assert_eq!(warnings.len(), 1);
    }

    #[test]
    fn an_unknown_group_is_refused_with_all_that_are_known() {
        let (groups, _) =
            PartGroups::of(&Role::all().collect(), &own(&[(LeftToes, "feet"), (RightToes, "feet")]));
        let settings = |name: &str| BTreeMap::from([(name.to_string(), GroupSettings::default())]);
        assert_eq!(groups.check(&settings("feet")), Ok(()));
        assert_eq!(groups.check(&settings("upper_leg")), Ok(()));
        let error = groups.check(&settings("tail")).unwrap_err();
        assert_eq!(error.option, Some("groups"));
        assert!(error.message.contains("tail") && error.message.contains("feet"), "{}", error.message);
    }
}
