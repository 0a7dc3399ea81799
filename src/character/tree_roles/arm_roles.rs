//! Arms in a tree of joints: a pair of like branches beside what rises between them.

use super::joint_tree::Tree;
use glam::DVec3;

/// Points against an arm for each joint between shoulder, elbow and wrist that is left out. Seen: ±30 % changes no
/// role.
const POINTS_OF_ARM_GAP: f64 = 0.2;

/// A collarbone is shorter than this share of the upper arm. Seen: at -30 %, 20 fewer roles.
const COLLAR_LENGTH: f64 = 0.65;

/// Points against an upper arm that begins later still. Seen: ±30 % changes no role.
const POINTS_OF_THIRD: f64 = 0.5;

/// What hangs from the wrist reaches up to this share of the arm. Seen: at -30 %, four fewer roles; at +30 %, 16 fewer roles.
const HAND_REACH: f64 = 0.6;

/// Points for a wrist from which fingers fork. Seen: ±30 % changes no role.
const POINTS_OF_FINGERS: f64 = 0.2;

impl Tree<'_> {
    /// How far what hangs from `joint` reaches along `across`.
    pub(super) fn reach_aside(&self, joint: usize, middle: DVec3, across: DVec3) -> f64 {
        let path = self.follow(joint, |tree, child| tree.reach[child]);
        let end = path.last().copied().unwrap_or(joint);
        (self.middle(end) - middle).dot(across)
    }

    /// The two children of one joint that look most like a pair of arms beside a head.
    pub(super) fn arms(&self, legs: [usize; 2], middle: DVec3, across: DVec3) -> Option<(usize, usize)> {
        let aside = |joint: usize| (self.position[joint] - middle).dot(across);
        let outward = |joint: usize| self.reach_aside(joint, middle, across);
        let hips = (self.level(legs[0]) + self.level(legs[1])) / 2.0;
        let outside = |joint: usize| legs.iter().all(|&leg| !self.within(joint, leg));
        let no_arm = |joint: usize| {
            !outside(joint) || legs.iter().any(|&leg| self.within(leg, joint)) || self.level(joint) < hips
        };
        self.best_pair((0..self.position.len()).filter(|&joint| outside(joint)), |a, b| {
            let reach = self.reach[a].min(self.reach[b]) / self.height;
            let (end_a, end_b) = (outward(a), outward(b));
            if no_arm(a) || no_arm(b) || end_a * end_b >= 0.0 {
                return None;
            }
            let start = (self.level(a) - self.level(b)).abs() + (aside(a) + aside(b)).abs() / self.height;
            let unlike = (self.reach[a] - self.reach[b]).abs() / self.height;
            Some(reach + (end_a - end_b).abs() / self.height - start - unlike)
        })
    }

    /// Shoulder, upper arm, lower arm and hand along the way out from `top`.
    pub(super) fn split_arm(&self, top: usize) -> [Option<usize>; 4] {
        let chain = self.follow(top, |tree, child| {
            tree.reach[child]
                + tree.carried[child] / tree.carried[top].max(f64::MIN_POSITIVE) * tree.reach[top]
        });
        let point = |place: usize| self.position[chain[place]];
        let beyond = |place: usize| self.reach[chain[place]];
        let collar_first =
            chain.len() > 2 && point(0).distance(point(1)) < COLLAR_LENGTH * point(1).distance(point(2));
        match chain[..] {
            [upper] => return [None, Some(upper), None, None],
            [upper, lower] => return [None, Some(upper), Some(lower), self.still_hand(lower)],
            [shoulder, upper, lower] if collar_first => {
                return [Some(shoulder), Some(upper), Some(lower), self.still_hand(lower)];
            }
            _ => {}
        }
        let branches = |place: usize| {
            let long = |&child: &usize| self.reach[child] > 0.0;
            self.live(chain[place]).iter().filter(|child| long(child)).count() >= 2
        };
        let [upper, elbow, wrist] = self.split(&chain, 3, |[shoulder, _, wrist], unlike, whole| {
            let rest = beyond(wrist) / whole;
            let late = if shoulder > 1 { POINTS_OF_THIRD } else { 0.0 };
            unlike
                + (rest - HAND_REACH).max(0.0)
                + late
                + if branches(wrist) { -POINTS_OF_FINGERS } else { 0.0 }
                + POINTS_OF_ARM_GAP * (wrist - shoulder - 2) as f64
        });
        let collar = upper.checked_sub(1).map(|place| chain[place]);
        [collar, Some(chain[upper]), Some(chain[elbow]), Some(chain[wrist])]
    }

    /// A hand that moves no vertex: the joint below the lower arm that is furthest from it.
    pub(super) fn still_hand(&self, lower: usize) -> Option<usize> {
        let length = |&joint: &usize| self.position[joint].distance(self.position[lower]);
        self.children[lower].iter().copied().max_by(|a, b| length(a).total_cmp(&length(b)))
    }
}
