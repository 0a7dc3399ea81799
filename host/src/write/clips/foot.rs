//! A foot at a moment: how it stood, and where it is to be.

use super::leg::Bones;
use super::plan::{Limb, Plan};
use super::smooth;
use super::track::{Local, Posed};
use crate::load::Loaded;
use glam::{DMat4, DQuat, DVec3};

/// A foot this high above its place at rest, in legs' lengths, keeps its way over the ground no more: it steps through the air.
/// Seen: heels of walks rise to .2, knees of runs lift feet to .5.
const AIR: [f64; 2] = [0.1, 0.35];

/// A foot that is higher than this above its place at rest, in legs' lengths, does not stand any more; hips need not mind it.
const STANDS: [f64; 2] = [0.02, 0.1];

/// How much higher than the lowest point of a foot, in legs' lengths, another may be to count half as much for where it stands.
const CONTACT: f64 = 0.02;

/// How a foot stood in the old body's clip.
#[derive(Clone, Copy, Debug)]
pub(super) struct Stance {
    /// How high its lowest point was above the floor.
    was: f64,
    /// The turn about up from the way that the body faces at rest to the way that it faced.
    facing: DQuat,
    /// 1 near the floor, 0 in the air.
    near: f64,
    /// 1 where it stood, 0 where it stepped.
    stands: f64,
}

impl Stance {
    pub(super) fn of(plan: &Plan, leg: &Limb, before: &Posed, moves: &[DMat4]) -> Self {
        let was = leg.lowest(plan, 0, moves);
        let above = (was - leg.rest_height[0]) / plan.leg_length;
        let (facing, upright) = plan.facing(before);
        Self { was, facing, near: upright * (1.0 - smooth(above, AIR)), stands: 1.0 - smooth(above, STANDS) }
    }
}

/// A foot at a moment, and where it is to be.
pub(super) struct Foot {
    pub(super) bones: Bones,
    pub(super) goal: DVec3,
    /// How high its lowest point is to be above the floor.
    pub(super) height: f64,
    /// 1 where it stands, 0 where it steps.
    pub(super) stands: f64,
}

impl Foot {
    pub(super) fn of(plan: &Plan, leg: &Limb, stance: &Stance, after: &Posed, moves: [&[DMat4]; 2]) -> Self {
        let up = plan.up;
        let places = |side: usize| leg.foot_points.iter().map(move |point| point.at(side, moves[side]));
        let &Stance { was, facing, near, stands } = stance;
        let height = leg.rest_height[1] + plan.stride * (was - leg.rest_height[0]);
        let bones = leg.bones(plan, after);
        let mut goal = bones.ankle + (height - leg.lowest(plan, 1, moves[1])) * up;
        if near > 0.0 {
            // Where the points stand that are nearest to the floor, before and after, in the pose and at rest.
            let weight = |place: DVec3| {
                let above = (place.dot(up) - plan.floor[0] - was) / (CONTACT * plan.leg_length);
                (-above * std::f64::consts::LN_2).exp()
            };
            let weights: Vec<f64> = places(0).map(weight).collect();
            let whole: f64 = weights.iter().sum();
            let mean = |places: &mut dyn Iterator<Item = DVec3>| -> DVec3 {
                places.zip(&weights).map(|(place, weight)| place * (weight / whole)).sum()
            };
            let (stood, is) = (mean(&mut places(0)), mean(&mut places(1)));
            let at_rest = |side: usize| mean(&mut leg.foot_points.iter().map(|point| point.rest[side]));
            let (rested, rests) = (at_rest(0), at_rest(1));
            let [hips_were, hips_are] = plan.rest_hips;
            let apart = (rests - hips_are) - plan.stride * (rested - hips_were);
            let wanted = hips_are + plan.stride * (stood - hips_were) + facing * apart;
            goal += near * (wanted - is).reject_from_normalized(up);
        }
        Self { bones, goal, height, stands }
    }

    /// By how much the hips must go up from `lift` for this foot to have room enough (0 or more), or down to reach (0 or less).
    pub(super) fn room(&self, up: DVec3, lift: f64, rises: bool) -> f64 {
        let [nearest, furthest] = self.bones.range();
        let away = self.bones.hip + lift * up - self.goal;
        let height = away.dot(up);
        let aside = away.reject_from_normalized(up).length();
        if rises {
            ((nearest * nearest - aside * aside).max(0.0).sqrt() - height).max(0.0)
        } else {
            ((furthest * furthest - aside * aside).max(0.0).sqrt() - height).min(0.0)
        }
    }

    /// Carries the leg along with the hips; its goal stays.
    pub(super) fn carry(&mut self, by: DVec3) {
        for joint in [&mut self.bones.hip, &mut self.bones.knee, &mut self.bones.ankle] {
            *joint += by;
        }
    }
}

/// What is set at a moment.
pub(super) struct Frame {
    pub(super) places: Vec<(usize, DVec3)>,
    pub(super) turns: Vec<(usize, DQuat)>,
    /// How far anything goes at most from where its own keys have it, model units.
    pub(super) change: f64,
}

impl Frame {
    /// Sets nodes, each in its parent's space.
    pub(super) fn put(&self, local: &mut [Local]) {
        self.places.iter().for_each(|&(node, place)| local[node].2 = place);
        self.turns.iter().for_each(|&(node, turn)| local[node].1 = turn);
    }

    pub(super) fn of(loaded: &Loaded, plan: &Plan, after: &Posed, shift: DVec3, feet: &[Foot]) -> Self {
        let mut frame = Self { places: Vec::new(), turns: Vec::new(), change: shift.length() };
        let parents = &loaded.tree.parents;
        let turn_of_parent = |node: usize| parents[node].map_or(DQuat::IDENTITY, |parent| after.turn[parent]);
        let hips = after.place(plan.hips) + shift;
        frame.places.push((plan.hips, after.in_parent(loaded, plan.hips, hips)));
        for (leg, foot) in plan.legs.iter().zip(feet) {
            let reached = foot.bones.reach(foot.goal);
            let moved = reached.ankle - (foot.bones.ankle - shift);
            frame.change = frame.change.max(moved.length());
            let turned = |turn: DQuat, node: usize| turn * turn_of_parent(node);
            let upper =
                turned(DQuat::IDENTITY, leg.upper).inverse() * (reached.thigh * after.turn[leg.upper]);
            let lower = turned(reached.thigh, leg.lower).inverse() * (reached.shin * after.turn[leg.lower]);
            frame.turns.extend([(leg.upper, upper.normalize()), (leg.lower, lower.normalize())]);
            if leg.loose {
                let with_hips = if leg.carried { shift } else { DVec3::ZERO };
                let place = after.in_parent(loaded, leg.foot, reached.ankle - with_hips);
                frame.places.push((leg.foot, place));
                frame.turns.push((leg.foot, after.turned_in_parent(loaded, leg.foot, DQuat::IDENTITY)));
            } else {
                let ankle = turned(reached.shin, leg.foot).inverse() * after.turn[leg.foot];
                frame.turns.push((leg.foot, ankle.normalize()));
            }
        }
        frame
    }
}
