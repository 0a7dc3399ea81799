//! Legs in a tree of joints: a pair of like branches that reach the ground.

use super::joint_tree::Tree;
use glam::DVec3;

/// A leg begins above this height, in heights of the figure. Seen: ±30 % changes no role.
const LEG_BEGINS_ABOVE: f64 = 0.08;
/// A pair of legs has the points of the share of weights that it carries, up to this. Seen: ±30 % changes no role.
const LEGS_CARRY: f64 = 0.4;
/// Points against a pair of legs, times how far both end over the ground, how unlike their beginnings and how unlike
/// their ends are. Seen: ±30 % changes no role.
const POINTS_OF_GROUND: f64 = 2.0;
/// A joint of the pelvis, not of the leg, is a first joint nearer to the middle than this share of the next one's
/// distance. Seen: ±30 % changes no role.
const PELVIS_ASIDE: f64 = 0.4;
/// A joint of the pelvis is nearer to the next joint than this, in heights of the figure. Seen: ±30 % changes no role.
const PELVIS_REACH: f64 = 0.12;
/// Points against a leg for each joint between hip joint, knee and ankle that is left out. Seen: ±30 % changes no role.
const POINTS_OF_LEG_GAP: f64 = 0.25;
/// An ankle lies at this share of the hip joint's height. Seen: ±30 % changes no role.
const ANKLE_LEVEL: f64 = 0.15;
/// Points against an ankle, times how far it lies beyond. Seen: ±30 % changes no role.
const POINTS_OF_ANKLE: f64 = 2.0;
/// Points against a hip joint that is a joint of the pelvis, or is not beside one. Seen: ±30 % changes no role.
const POINTS_OF_PELVIS: f64 = 0.4;
/// A foot that hangs elsewhere is no further from a leg's end than this share of the leg. Seen: ±30 % changes no role.
const LOOSE_FOOT_REACH: f64 = 0.35;

impl Tree<'_> {
    /// The two children of one joint that look most like a pair of legs.
    pub(super) fn legs(&self) -> Option<(usize, usize)> {
        let lowest = |joint: usize| (self.low[joint] - self.ground) / self.height;
        self.best_pair(0..self.position.len(), |a, b| {
            let high_enough = self.level(a) >= LEG_BEGINS_ABOVE && self.level(b) >= LEG_BEGINS_ABOVE;
            if !high_enough || self.lower_ends_distance(a, b) <= 0.0 {
                return None;
            }
            let start = self.level(a) - self.level(b);
            let unlike = (self.reach[a] - self.reach[b]).abs() / self.height;
            let over_ground = lowest(a) + lowest(b) + (lowest(a) - lowest(b)).abs();
            let carried = (self.carried[a] + self.carried[b]).min(LEGS_CARRY);
            Some(carried - POINTS_OF_GROUND * (over_ground + start.abs()) - unlike)
        })
    }

    /// How far apart the lower ends of two branches are across up.
    pub(super) fn lower_ends_distance(&self, a: usize, b: usize) -> f64 {
        let end = |top: usize| {
            let path = self.downward(top);
            self.middle(path.last().copied().unwrap_or(top))
        };
        (end(a) - end(b)).reject_from(self.up).length()
    }

    /// From the top of a leg, always to the child that reaches lowest and moves most.
    pub(super) fn downward(&self, top: usize) -> Vec<usize> {
        self.follow(top, |tree, child| {
            tree.carried[child] / tree.carried[top].max(f64::MIN_POSITIVE)
                - (tree.low[child] - tree.ground) / tree.height
        })
    }

    /// Upper leg, lower leg, foot and toes along the way down from `top`; `other` is the other leg's top.
    pub(super) fn split_leg(&self, top: usize, other: usize) -> [Option<usize>; 4] {
        let chain = self.downward(top);
        match chain[..] {
            [upper] => return [Some(upper), None, None, None],
            [upper, lower] => return [Some(upper), Some(lower), self.loose_foot(upper, lower), None],
            _ => {}
        }
        let point = |place: usize| self.position[chain[place]];
        let along = |place: usize| point(place).dot(self.up) - self.ground;
        // A joint of the pelvis lies nearer to the middle than the hip joint does.
        let middle = (self.position[top] + self.position[other]) / 2.0;
        let aside = |place: usize| (point(place) - middle).reject_from(self.up).length();
        let pelvis_first =
            aside(0) < PELVIS_ASIDE * aside(1) && point(0).distance(point(1)) < PELVIS_REACH * self.height;
        let [hip, knee, ankle] = self.split(&chain, 2, |[hip, _, ankle], unlike, whole| {
            let ankle_level = along(ankle) / along(hip).max(f64::MIN_POSITIVE);
            unlike
                + POINTS_OF_ANKLE * (ankle_level - ANKLE_LEVEL).abs()
                + (1.0 - (along(hip) - along(ankle)) / whole)
                + if (hip > 0) == pelvis_first { 0.0 } else { POINTS_OF_PELVIS }
                + POINTS_OF_LEG_GAP * (ankle - hip - 2) as f64
        });
        let toes = chain.get(ankle + 1).copied();
        [Some(chain[hip]), Some(chain[knee]), Some(chain[ankle]), toes]
    }

    /// A foot that hangs elsewhere, near the end of a leg that has none (rigs with IK).
    pub(super) fn loose_foot(&self, upper: usize, lower: usize) -> Option<usize> {
        let shin = self.position[lower] - self.position[upper];
        let along = |p: &DVec3| (*p - self.position[lower]).dot(shin);
        let ends = self.children[lower].iter().map(|&child| self.position[child]);
        let end = ends.max_by(|a, b| along(a).total_cmp(&along(b))).unwrap_or(self.position[lower] + shin);
        let parent = self.skeleton.joints[upper].parent;
        let leg = 2.0 * shin.length();
        (0..self.position.len())
            .filter(|&joint| {
                self.moves(joint)
                    && parent.is_none_or(|parent| !self.within(joint, parent))
                    && !self.within(lower, joint)
                    && self.position[joint].distance(end) < LOOSE_FOOT_REACH * leg
                    && self.position[joint].dot(self.up) < self.position[lower].dot(self.up)
            })
            .min_by(|&a, &b| self.position[a].distance(end).total_cmp(&self.position[b].distance(end)))
    }
}
