//! The places that the search considered for a joint, for a person who looks at a doubted one.

use super::FoundJoint;
use super::arm_curve::Arm;
use super::legs::{Leg, LegGap};
use crate::character::Role;
use crate::character::humanoid::LEFT_LEG;
use glam::DVec3;
use std::collections::BTreeMap;

/// A joint has so many places at most.
const MOST: usize = 4;
/// Places nearer than this to one another, in heights, are one: it is how far a joint that is right may be off.
const SAME: f64 = 0.03;
/// A place that is less likely than this beside the one that was taken is no help.
const LEAST_SCORE: f64 = 1e-3;
/// Where nothing tells front from back, left is as likely to be right.
const SWAPPED: f64 = 0.5;
/// The crotch's height as a share of the shoulders' (Winter, table 4.1: .48 of .818 H), and what is no surprise.
const CROTCH: (f64, f64) = (0.58, 0.12);

/// A place where a joint may be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Place {
    /// It, in the unit figure.
    pub position: DVec3,
    /// How likely it is beside the place that was taken, 0..1; 1 for that.
    pub score: f64,
}

/// All places that were considered, by role.
#[derive(Clone, Debug, Default)]
pub struct Candidates(BTreeMap<Role, Vec<Place>>);

impl Candidates {
    /// Another place of a joint.
    pub fn add(&mut self, role: Role, position: DVec3, score: f64) {
        if position.is_finite() && score >= LEAST_SCORE {
            self.0.entry(role).or_default().push(Place { position, score: score.min(1.0) });
        }
    }

    /// Arms of one side, each with what the best pair costs that has it: a sum of squared surprises, like twice a
    /// logarithm of likelihood. They take the place of what was considered for this side before.
    pub fn set_arms<'a>(&mut self, left: bool, arms: impl Iterator<Item = (&'a Arm, f64)> + Clone) {
        use Role::{LeftHand, LeftLowerArm, LeftUpperArm};
        let roles = [LeftUpperArm, LeftLowerArm, LeftHand].map(|role| role.on_side(left));
        roles.iter().for_each(|role| drop(self.0.remove(role)));
        let least = arms.clone().map(|(_, cost)| cost).fold(f64::INFINITY, f64::min);
        for (arm, cost) in arms {
            let score = (-0.5 * (cost - least)).exp();
            for (role, position) in roles.into_iter().zip([arm.shoulder, arm.elbow, arm.wrist]) {
                self.add(role, position, score);
            }
        }
    }

    /// A leg that divides from the other one at a share of the shoulders' height, as likely by itself as `score`.
    pub fn add_leg(&mut self, left: bool, leg: &Leg, score: f64) {
        for (role, position) in LEFT_LEG.into_iter().zip([leg.hip, leg.knee, leg.ankle, leg.toes]) {
            self.add(role.on_side(left), position, score);
        }
    }

    /// What is known where left may be right: each limb joint's place is one of its image's as well.
    pub fn swap_sides(&mut self, joints: &BTreeMap<Role, FoundJoint>) {
        for (&role, joint) in joints.iter().filter(|(role, _)| role.mirrored() != **role) {
            self.add(role.mirrored(), joint.position, SWAPPED);
        }
    }

    /// The places of each joint that is doubted, where there is more than one: the one that was taken, then the likeliest,
    /// no two of them the same.
    pub fn of_doubted(
        &self,
        joints: &BTreeMap<Role, FoundJoint>,
        trusted: f64,
    ) -> BTreeMap<Role, Vec<Place>> {
        let doubted = joints.iter().filter(|(_, joint)| joint.confidence < trusted);
        let several = |(&role, joint): (&Role, &FoundJoint)| {
            let mut others = self.0.get(&role)?.clone();
            others.sort_by(|a, b| b.score.total_cmp(&a.score));
            let mut places = vec![Place { position: joint.position, score: 1.0 }];
            for place in others {
                let is_new = places.iter().all(|one| one.position.distance(place.position) > SAME);
                if is_new && places.len() < MOST {
                    places.push(place);
                }
            }
            (places.len() > 1).then_some((role, places))
        };
        doubted.filter_map(several).collect()
    }
}

/// How likely legs are that were seen so and divide at a share of the shoulders' height, not normed.
pub fn likelihood(seen: LegGap, share: f64) -> f64 {
    let by_rule = match seen {
        LegGap::Open => 1.0,
        LegGap::Inside => 0.75,
        LegGap::Hem => 0.5,
        LegGap::Unseen => 0.25,
    };
    by_rule * (-0.5 * ((share - CROTCH.0) / CROTCH.1).powi(2)).exp()
}
