//! The scales of all parts (product mode), and what a user sets of them.

use super::part_settings::PartGroups;
use crate::character::bones::Group;
use crate::error::{Error, ErrorKind, Result};
use crate::geometry::by_key;
use crate::options::GroupSettings;
use crate::shape::group::Coefficient;
use std::collections::BTreeMap;

/// How much longer and thicker something becomes; 1 keeps it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scale {
    /// alpha.
    pub length: f64,
    /// beta.
    pub thickness: f64,
}

impl Scale {
    /// Leaves it as it is.
    pub const IDENTITY: Self = Self { length: 1.0, thickness: 1.0 };
}

/// How much the head grows along its three axes; 1 keeps it.
#[allow(missing_docs)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HeadScale {
    pub height: f64,
    pub width: f64,
    pub depth: f64,
}

/// The scales of all parts; 1 leaves a part as it is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PartCoefficients {
    /// The head.
    pub head: HeadScale,
    /// The neck.
    pub neck: Scale,
    /// The torso.
    pub torso: Scale,
    /// How far the shoulder joints stand from the middle.
    pub shoulder_spread: f64,
    /// How far the hip joints stand from the middle.
    pub hip_spread: f64,
    /// Both upper arms.
    pub upper_arm: Scale,
    /// Both lower arms.
    pub lower_arm: Scale,
    /// Both upper legs.
    pub upper_leg: Scale,
    /// Both lower legs.
    pub lower_leg: Scale,
    /// Size of the hands.
    pub hand: f64,
    /// Size of the feet.
    pub foot: f64,
}

impl PartCoefficients {
    /// Leaves everything as it is.
    pub const IDENTITY: Self = Self {
        head: HeadScale { height: 1.0, width: 1.0, depth: 1.0 },
        neck: Scale::IDENTITY,
        torso: Scale::IDENTITY,
        shoulder_spread: 1.0,
        hip_spread: 1.0,
        upper_arm: Scale::IDENTITY,
        lower_arm: Scale::IDENTITY,
        upper_leg: Scale::IDENTITY,
        lower_leg: Scale::IDENTITY,
        hand: 1.0,
        foot: 1.0,
    };

    /// By bone group, for the report: of a group with several kinds of parts, their mean.
    pub fn by_group(&self, groups: &PartGroups) -> BTreeMap<String, Coefficient> {
        let all = by_key(Group::ALL.map(|kind| (groups.name(kind).to_string(), self.of(kind))));
        let coefficient = |scales: Vec<Scale>| {
            let mean = |of: fn(&Scale) -> f64| scales.iter().map(of).sum::<f64>() / scales.len() as f64;
            Coefficient { length_scale: mean(|it| it.length), thickness_scale: mean(|it| it.thickness) }
        };
        all.into_iter().map(|(name, scales)| (name, coefficient(scales))).collect()
    }

    /// The scale of the parts of one kind.
    fn of(&self, kind: Group) -> Scale {
        let scale = |length: f64, thickness: f64| Scale { length, thickness };
        match kind {
            Group::Head => scale(self.head.height, self.head.width),
            Group::Neck => self.neck,
            Group::Torso => self.torso,
            Group::Shoulder => scale(self.shoulder_spread, self.torso.thickness),
            Group::UpperArm => self.upper_arm,
            Group::LowerArm => self.lower_arm,
            Group::Hand | Group::Finger => scale(self.hand, self.hand),
            Group::Hip => scale(self.hip_spread, self.torso.thickness),
            Group::UpperLeg => self.upper_leg,
            Group::LowerLeg => self.lower_leg,
            Group::Foot => scale(self.foot, self.foot),
        }
    }

    /// The same lengths; every thickness as it was (Fig. 6b).
    pub fn lengths_only(mut self) -> Self {
        let Self { neck, torso, upper_arm, lower_arm, upper_leg, lower_leg, .. } = &mut self;
        for scale in [neck, torso, upper_arm, lower_arm, upper_leg, lower_leg] {
            scale.thickness = 1.0;
        }
        (self.shoulder_spread, self.hip_spread) = (1.0, 1.0);
        self
    }

    /// Puts a user's settings in place of what was found.
    ///
    /// # Errors
    /// As [`PartGroups::check`].
    pub fn apply_settings(
        &mut self,
        settings: &BTreeMap<String, GroupSettings>,
        groups: &PartGroups,
    ) -> Result<()> {
        groups.check(settings)?;
        for kind in Group::ALL.into_iter().rev() {
            // Fingers and hands are one part, and one group's settings count once.
            let is_done = kind == Group::Hand && groups.name(Group::Finger) == groups.name(kind);
            if let Some(given) = settings.get(groups.name(kind)).filter(|_| !is_done) {
                self.apply_to(kind, given);
            }
        }
        Ok(())
    }

    fn apply_to(&mut self, group: Group, settings: &GroupSettings) {
        let blend = |found: f64, set: Option<f64>, transfer: Option<f64>| {
            set.unwrap_or_else(|| 1.0 + transfer.unwrap_or(1.0) * (found - 1.0))
        };
        let length = |found: f64| blend(found, settings.length_scale, settings.length_transfer);
        let thickness = |found: f64| blend(found, settings.thickness_scale, settings.thickness_transfer);
        let both =
            |found: Scale| Scale { length: length(found.length), thickness: thickness(found.thickness) };
        // Hands and feet keep their shape: one setting is for all of it.
        let size = |found: f64| {
            let set = settings.length_scale.or(settings.thickness_scale);
            blend(found, set, settings.length_transfer.or(settings.thickness_transfer))
        };
        match group {
            Group::Head => {
                let width = thickness(self.head.width);
                self.head.depth *= width / self.head.width;
                self.head.width = width;
                self.head.height = length(self.head.height);
            }
            Group::Neck => self.neck = both(self.neck),
            Group::Torso => self.torso = both(self.torso),
            Group::Shoulder => self.shoulder_spread = length(self.shoulder_spread),
            Group::Hip => self.hip_spread = length(self.hip_spread),
            Group::UpperArm => self.upper_arm = both(self.upper_arm),
            Group::LowerArm => self.lower_arm = both(self.lower_arm),
            Group::UpperLeg => self.upper_leg = both(self.upper_leg),
            Group::LowerLeg => self.lower_leg = both(self.lower_leg),
            Group::Hand | Group::Finger => self.hand = size(self.hand),
            Group::Foot => self.foot = size(self.foot),
        }
    }

    /// Checks that every scale is a number.
    ///
    /// # Errors
    /// `ErrorKind::NoGeometry` names the first group without.
    pub fn validate(&self) -> Result<()> {
        for kind in Group::ALL {
            let Scale { length, thickness } = self.of(kind);
            if !(length.is_finite() && thickness.is_finite()) {
                let message = format!(
                    "no scale can be found for the group {kind} ({length} and {thickness} came out): check \
                     that the joints of both characters lie inside their meshes and not on one another"
                );
                return Err(Error::new(ErrorKind::NoGeometry, message));
            }
        }
        Ok(())
    }
}
