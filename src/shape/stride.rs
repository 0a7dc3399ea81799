//! How far soles are from the floor in a walk that was made for ordinary legs.
//!
//! A walk turns hips, knees and ankles by its own angles and carries the hips as high as legs of ordinary proportions need.
//! Legs that are shorter against their feet dip into the floor then, whatever carries the hips by their height.
//!
//! Angles: Perry and Burnfield. Gait Analysis: Normal and Pathological Function. 2nd edition, 2010. Proportions of ordinary legs:
//! Winter. Biomechanics and Motor Control of Human Movement. 4th edition, 2009, Fig. 4.1.

use super::figure::Figure;
use crate::character::Role;
use crate::character::humanoid::LEFT_LEG;
use glam::{DMat3, DVec3};

/// A leg in the canonical frame, at rest.
#[derive(Clone, Debug, PartialEq)]
pub struct Leg {
    /// Where it turns: hip, knee, ankle.
    pub joints: [DVec3; 3],
    /// Points of the foot.
    pub foot: Vec<DVec3>,
}

/// Degrees by which thigh, knee and ankle are bent forward, backward and upward, from one contact of the heel to the next.
const PHASES: usize = 8;
/// The thigh against the vertical. Perry.
const THIGH: [f64; PHASES] = [20.0, 20.0, 0.0, -20.0, -10.0, 15.0, 25.0, 20.0];
/// The knee. Perry.
const KNEE: [f64; PHASES] = [5.0, 20.0, 5.0, 5.0, 40.0, 60.0, 25.0, 5.0];
/// The ankle. Perry.
const ANKLE: [f64; PHASES] = [0.0, -5.0, 5.0, 10.0, -15.0, -5.0, 0.0, 0.0];

/// Ordinary thigh, shank and ankle's height, shares of the whole height. Winter.
const ORDINARY_LEG: [f64; 3] = [0.245, 0.246, 0.039];
/// How far an ordinary foot reaches behind its ankle and before it, shares of the whole height: its length is 0.152 (Winter), a
/// quarter of it heel.
const ORDINARY_FOOT: [f64; 2] = [-0.038, 0.114];

impl Leg {
    /// The leg of ordinary proportions, whose whole height is 1, on ground at 0.
    fn ordinary() -> Self {
        let [thigh, shank, ankle] = ORDINARY_LEG;
        let heights = [thigh + shank + ankle, shank + ankle, ankle];
        Self {
            joints: heights.map(|y| DVec3::new(0.0, y, 0.0)),
            foot: ORDINARY_FOOT.map(|z| DVec3::new(0.0, 0.0, z)).to_vec(),
        }
    }

    /// The leg of `figure` on one side; none where a joint is missing or nothing is its foot's.
    fn of(figure: &Figure, [upper, lower, foot, toes]: [Role; 4]) -> Option<Self> {
        let joint = |role: Role| figure.role_position(role);
        let joints = [joint(upper)?, joint(lower)?, joint(foot)?];
        let is_of_foot =
            |vertex: &usize| figure.weight_of(*vertex, |role| role == foot || role == toes) > 0.5;
        let of_foot = (0..figure.positions.len()).filter(is_of_foot);
        let leg = Self { joints, foot: of_foot.map(|vertex| figure.positions[vertex]).collect() };
        (!leg.foot.is_empty()).then_some(leg)
    }

    /// The lowest point of the foot in a phase of the walk, the hip staying where it is.
    fn lowest(&self, phase: usize) -> f64 {
        let turn = |degrees: f64| DMat3::from_rotation_x(degrees.to_radians());
        let [hip, knee, ankle] = self.joints;
        let thigh = -THIGH[phase];
        let shank = thigh + KNEE[phase];
        let foot = turn(shank - ANKLE[phase]);
        let to = hip + turn(thigh) * (knee - hip) + turn(shank) * (ankle - knee);
        self.foot.iter().map(|&p| to.y + (foot * (p - ankle)).y).fold(f64::INFINITY, f64::min)
    }

    /// How far the hip is above `ground`.
    fn height(&self, ground: f64) -> f64 {
        self.joints[0].y - ground
    }
}

/// The phase of the other leg: half a cycle later, as near as eight phases of unequal length have it.
fn other(phase: usize) -> usize {
    (phase + PHASES / 2) % PHASES
}

/// How far the lowest sole is above `ground` in a walk, below 0 where it dips into it.
///
/// The hips are carried so that ordinary legs, scaled to this hip's height, just touch the ground in each phase.
pub fn sole_clearance(legs: &[Leg; 2], ground: f64) -> f64 {
    let ordinary = Leg::ordinary();
    let height = 0.5 * (legs[0].height(ground) + legs[1].height(ground));
    (0..PHASES)
        .map(|phase| {
            let down = ordinary.lowest(phase).min(ordinary.lowest(other(phase))) / ordinary.height(0.0);
            let lowest = legs[0].lowest(phase).min(legs[1].lowest(other(phase)));
            lowest - ground - down * height
        })
        .fold(f64::INFINITY, f64::min)
}

/// The same of `figure`, as a share of its height; none where a leg is not complete.
pub fn clearance_of(figure: &Figure, ground: f64) -> Option<f64> {
    let [left, right] = [true, false].map(|left| Leg::of(figure, LEFT_LEG.map(|role| role.on_side(left))));
    let clearance = sole_clearance(&[left?, right?], ground) / figure.height();
    clearance.is_finite().then_some(clearance)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ordinary_legs_of_any_size_just_touch_the_floor() {
        for size in [0.01, 1.0, 170.0] {
            let leg = Leg::ordinary();
            let leg = Leg {
                joints: leg.joints.map(|p| size * p + DVec3::Y),
                foot: leg.foot.iter().map(|&p| size * p + DVec3::Y).collect(),
            };
            assert!(sole_clearance(&[leg.clone(), leg], 1.0).abs() < 1e-12 * size.max(1.0));
        }
    }

    #[test]
    fn longer_feet_dip_in_by_what_their_toes_reach_further_down() {
        let mut leg = Leg::ordinary();
        leg.foot[1].z *= 2.0;
        let dips = sole_clearance(&[leg.clone(), leg.clone()], 0.0);
        // Where the toes of one leg point down most, the ordinary foot touches with them: phase 4, 45 degrees.
        let angle = (10.0 + 40.0 + 15.0_f64).to_radians();
        let ordinary = Leg::ordinary();
        let touches = ordinary.lowest(4) <= ordinary.lowest(0);
        let expected = -ORDINARY_FOOT[1] * angle.sin();
        assert!(dips < 0.0 && dips >= expected - 1e-12, "{dips}, at most {expected}");
        assert!(!touches || (dips - expected).abs() < 1e-12, "{dips}, not {expected}");
    }
}
