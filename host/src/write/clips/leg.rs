//! A leg of two bones that reaches for a point, and how far it can.

use glam::{DQuat, DVec3};

/// A leg is not stretched beyond this share of its length: it would snap straight.
const STRAIGHTEST: f64 = 0.999;

/// A leg is not folded below this share of its length: a knee that is bent by 145 degrees, as far as a person's goes.
const FOLDED: f64 = 0.3;

/// How much the side of the body says of the way that a knee bends, beside the pose: it decides for a straight leg alone.
const SIDE: f64 = 0.02;

/// Hip, knee and ankle in a pose, model space.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bones {
    pub(super) hip: DVec3,
    pub(super) knee: DVec3,
    pub(super) ankle: DVec3,
    /// From the body's right to its left, as the thigh is turned: what a knee turns about.
    pub(super) side: DVec3,
}

/// What turns a leg: thigh and shin, in model space, and where its ankle is then.
#[derive(Clone, Copy, Debug)]
pub(super) struct Reached {
    pub(super) thigh: DQuat,
    pub(super) shin: DQuat,
    pub(super) ankle: DVec3,
}

impl Bones {
    fn lengths(&self) -> [f64; 2] {
        [self.hip.distance(self.knee), self.knee.distance(self.ankle)]
    }

    /// How near to the hip and how far from it the ankle can be.
    pub(super) fn range(&self) -> [f64; 2] {
        let [thigh, shin] = self.lengths();
        let whole = thigh + shin;
        [((thigh - shin).abs() + (1.0 - STRAIGHTEST) * whole).max(FOLDED * whole), STRAIGHTEST * whole]
    }

    /// Turns the leg so that its ankle is at `goal`, or as near as it can be: the knee bends in the plane that it bends in now,
    /// then all of it turns the shortest way.
    pub(super) fn reach(&self, goal: DVec3) -> Reached {
        let still = Reached { thigh: DQuat::IDENTITY, shin: DQuat::IDENTITY, ankle: self.ankle };
        let [thigh, shin] = self.lengths();
        let (down, further) = (self.knee - self.hip, self.ankle - self.knee);
        let [nearest, furthest] = self.range();
        // A leg that the clip itself stretches or folds beyond these may stay so.
        let now = self.ankle.distance(self.hip);
        let distance = goal.distance(self.hip).clamp(nearest.min(now), furthest.max(now));
        let axis = down.cross(further) / (thigh * shin) + SIDE * self.side;
        let axis = axis.normalize_or_zero();
        if axis == DVec3::ZERO || !distance.is_finite() {
            return still;
        }
        let bent = |distance: f64| {
            let cosine = (thigh * thigh + shin * shin - distance * distance) / (2.0 * thigh * shin);
            std::f64::consts::PI - cosine.clamp(-1.0, 1.0).acos()
        };
        let knee = DQuat::from_axis_angle(axis, bent(distance) - bent(now));
        let to = down + knee * further;
        let way = (goal - self.hip).normalize_or_zero();
        if way == DVec3::ZERO || to == DVec3::ZERO {
            return still;
        }
        let whole = DQuat::from_rotation_arc(to.normalize(), way);
        Reached { thigh: whole, shin: whole * knee, ankle: self.hip + whole * to }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn leg(knee: DVec3, ankle: DVec3) -> Bones {
        Bones { hip: DVec3::Y, knee, ankle, side: DVec3::X }
    }

    #[test]
    fn an_ankle_reaches_every_point_that_it_can_and_bones_keep_their_lengths() {
        let leg = leg(DVec3::new(0.0, 0.5, 0.1), DVec3::new(0.0, 0.0, 0.0));
        let [nearest, furthest] = leg.range();
        for goal in [[0.0, 0.1, 0.0], [0.1, 0.05, -0.2], [0.0, 0.4, 0.3], [-0.3, 0.2, 0.2]] {
            let goal = DVec3::from_array(goal);
            assert!((nearest..=furthest).contains(&goal.distance(leg.hip)), "{goal} is out of reach");
            let Reached { thigh, shin, ankle } = leg.reach(goal);
            assert!(ankle.distance(goal) < 1e-9, "{ankle} instead of {goal}");
            let knee = leg.hip + thigh * (leg.knee - leg.hip);
            assert!((knee + shin * (leg.ankle - leg.knee)).distance(goal) < 1e-9);
        }
    }

    #[test]
    fn a_straight_leg_bends_its_knee_forward_and_one_that_cannot_reach_is_straight() {
        let leg = leg(0.5 * DVec3::Y, DVec3::ZERO);
        let Reached { thigh, .. } = leg.reach(0.2 * DVec3::Y);
        // Forward is +z where left is +x and up is +y.
        assert!((thigh * (leg.knee - leg.hip)).z > 0.1);
        let far = leg.reach(-DVec3::Y);
        assert!(far.ankle.distance(DVec3::ZERO) < 2e-3, "{}", far.ankle);
    }

    #[test]
    fn a_straight_leg_that_is_pushed_up_becomes_two_sides_of_an_isosceles_triangle() {
        let leg = leg(0.5 * DVec3::Y, DVec3::ZERO);
        for step in 1..25 {
            let distance = 1.0 - 0.02 * f64::from(step);
            let knee = leg.hip + leg.reach((1.0 - distance) * DVec3::Y).thigh * (leg.knee - leg.hip);
            let expected = DVec3::new(0.0, 1.0 - distance / 2.0, (0.25 - distance * distance / 4.0).sqrt());
            assert!(knee.distance(expected) < 1e-9, "{knee} instead of {expected}");
        }
    }
}
