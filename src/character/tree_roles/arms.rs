//! Arms in a tree of joints: a pair of like branches beside what rises between them.

use super::tree::{POINTS_OF_HALVES, POINTS_OF_STUMP, STUMP, TINY, Tree};
use glam::DVec3;

/// Points against an arm for each joint between shoulder, elbow and wrist that is left out. Seen: ±30 % changes no
/// role.
const POINTS_OF_ARM_GAP: f64 = 0.2;

/// An arm reaches at least this far, in heights. Seen: ±30 % changes no role.
const LEAST_ARM: f64 = 0.06;

/// What rises between the arms is neck or head where it carries more than this share of all weights. Seen: ±30 %
/// changes no role.
const LEAST_HEAD: f64 = 0.01;

/// A pair of arms has the points of the share of weights that it carries, up to this. Seen: ±30 % changes no role.
const ARMS_CARRY: f64 = 0.3;
/// Points of a pair of arms for a head between them. Seen: ±30 % changes no role.
const POINTS_OF_HEAD: f64 = 0.5;
/// Points against a pair of arms, times how unlike their ends are. Seen: ±30 % changes no role.
const POINTS_OF_ENDS: f64 = 0.5;
/// Points against a pair of arms for each joint above it: of two pairs the one nearer to the root wins. Seen: ±30 %
/// changes no role.
const POINTS_OF_DEPTH: f64 = 0.05;

/// A collarbone begins nearer to the middle than this share of the next joint's distance. Seen: at -30 %, 52 fewer
/// roles.
const COLLAR_ASIDE: f64 = 0.65;
/// A collarbone is shorter than this share of the upper arm. Seen: at -30 %, 20 fewer roles.
const COLLAR_LENGTH: f64 = 0.65;

/// A forearm whose hand has no joint reaches further than this share of the upper arm. Seen: ±30 % changes no role.
const FOREARM_REACH: f64 = 0.6;

/// Points against an upper arm that begins with a collarbone. Seen: ±30 % changes no role.
const POINTS_OF_COLLAR: f64 = 0.4;
/// Points against an upper arm that begins without one, but a joint later. Seen: ±30 % changes no role.
const POINTS_OF_SECOND: f64 = 0.3;
/// Points against an upper arm that begins later still. Seen: ±30 % changes no role.
const POINTS_OF_THIRD: f64 = 0.5;

/// What hangs from the wrist reaches between these shares of the arm. Seen: at -30 %, four fewer roles; at +30 %, 16
/// fewer roles.
const HAND_RANGE: (f64, f64) = (0.12, 0.6);
/// Points against a wrist, times how far what hangs from it reaches beyond. Seen: ±30 % changes no role.
const POINTS_OF_HAND: f64 = 2.0;

/// Points for a wrist from which fingers fork. Seen: ±30 % changes no role.
const POINTS_OF_FINGERS: f64 = 0.2;
/// Points against a wrist for each fork before it. Seen: ±30 % changes no role.
const POINTS_OF_FORK: f64 = 0.3;

/// A hand that moves nothing lies between these lengths of the upper arm beyond the elbow. Seen: ±30 % changes no role.
const STILL_HAND_RANGE: (f64, f64) = (0.5, 1.6);

impl Tree<'_> {
    /// How far what hangs from `joint` reaches along `across`.
    pub(super) fn reach_aside(&self, joint: usize, middle: DVec3, across: DVec3) -> f64 {
        let path = self.follow(joint, |tree, child| tree.reach[child]);
        let end = path.last().copied().unwrap_or(joint);
        (self.center[end].unwrap_or(self.position[end]) - middle).dot(across)
    }

    /// The two children of one joint that look most like a pair of arms beside a head.
    pub(super) fn arms(&self, legs: [usize; 2], middle: DVec3, across: DVec3) -> Option<(usize, usize)> {
        let aside = |joint: usize| (self.position[joint] - middle).dot(across);
        let outward = |joint: usize| self.reach_aside(joint, middle, across);
        let hips = (self.level(legs[0]) + self.level(legs[1])) / 2.0;
        let outside = |joint: usize| legs.iter().all(|&leg| !self.within(joint, leg));
        let mut best: Option<(f64, usize, usize)> = None;
        for parent in (0..self.position.len()).filter(|&joint| outside(joint)) {
            let children = self.live(parent);
            let depth = self.skeleton.ancestors(parent).count() as f64;
            for (place, &a) in children.iter().enumerate() {
                for &b in &children[place + 1..] {
                    let reach = self.reach[a].min(self.reach[b]) / self.height;
                    let (end_a, end_b) = (outward(a), outward(b));
                    if !outside(a)
                        || !outside(b)
                        || legs.iter().any(|&leg| self.within(leg, a) || self.within(leg, b))
                        || self.level(a) < hips
                        || self.level(b) < hips
                        || end_a * end_b >= 0.0
                        || reach < LEAST_ARM
                    {
                        continue;
                    }
                    // Something must rise between the arms that is neither: the neck or the head.
                    let head_between = children.iter().any(|&c| {
                        c != a
                            && c != b
                            && self.high[c] - self.ground > self.level(a) * self.height
                            && self.carried[c] > LEAST_HEAD
                    });
                    let start =
                        (self.level(a) - self.level(b)).abs() + (aside(a) + aside(b)).abs() / self.height;
                    let ends = (end_a + end_b).abs() / self.height;
                    let score = reach
                        + (end_a - end_b).abs() / self.height
                        + (self.carried[a] + self.carried[b]).min(ARMS_CARRY)
                        + if head_between { POINTS_OF_HEAD } else { 0.0 }
                        - start
                        - POINTS_OF_ENDS * ends
                        - (self.reach[a] - self.reach[b]).abs() / self.height
                        - POINTS_OF_DEPTH * depth;
                    if best.is_none_or(|(known, _, _)| score > known) {
                        best = Some((score, a, b));
                    }
                }
            }
        }
        best.map(|(_, a, b)| (a, b))
    }

    /// Shoulder, upper arm, lower arm and hand along the way out from `top`.
    pub(super) fn split_arm(&self, top: usize, middle: DVec3, across: DVec3) -> [Option<usize>; 4] {
        let chain = self.follow(top, |tree, child| {
            tree.reach[child] + tree.carried[child] / tree.carried[top].max(TINY) * tree.reach[top]
        });
        let point = |place: usize| self.position[chain[place]];
        let aside = |place: usize| (point(place) - middle).dot(across).abs();
        let beyond = |place: usize| self.reach[chain[place]];
        // A collarbone is short and starts near the middle.
        let collar_first = chain.len() > 2
            && aside(0) < COLLAR_ASIDE * aside(1)
            && point(0).distance(point(1)) < COLLAR_LENGTH * point(1).distance(point(2));
        match chain[..] {
            [upper] => return [None, Some(upper), None, None],
            [upper, lower] => return [None, Some(upper), Some(lower), self.still_hand(upper, lower)],
            [shoulder, upper, lower]
                if collar_first && self.reach[lower] > FOREARM_REACH * point(1).distance(point(2)) =>
            {
                return [Some(shoulder), Some(upper), Some(lower), self.still_hand(upper, lower)];
            }
            _ => {}
        }
        let branches = |place: usize| {
            let long = |&child: &usize| self.reach[child] > 0.0;
            self.live(chain[place]).iter().filter(|child| long(child)).count() >= 2
        };
        let mut best = (f64::INFINITY, [0, 1, 2]);
        for shoulder in 0..3.min(chain.len() - 2) {
            for elbow in shoulder + 1..chain.len() - 1 {
                for wrist in elbow + 1..chain.len() {
                    let upper = point(shoulder).distance(point(elbow));
                    let lower = point(elbow).distance(point(wrist));
                    let whole = (upper + lower).max(TINY);
                    let rest = beyond(wrist) / whole;
                    let stump = upper.min(lower) < STUMP * whole;
                    let collar = match shoulder {
                        0 if collar_first => POINTS_OF_COLLAR,
                        0 => 0.0,
                        1 if collar_first => 0.0,
                        1 => POINTS_OF_SECOND,
                        _ => POINTS_OF_THIRD,
                    };
                    let beyond_a_fork = (shoulder..wrist).filter(|&place| branches(place)).count();
                    let score = POINTS_OF_HALVES * (upper / whole - 0.5).abs()
                        + POINTS_OF_HAND * (HAND_RANGE.0 - rest).max(0.0)
                        + POINTS_OF_HAND * (rest - HAND_RANGE.1).max(0.0)
                        + collar
                        + if stump { POINTS_OF_STUMP } else { 0.0 }
                        + if branches(wrist) { -POINTS_OF_FINGERS } else { 0.0 }
                        + POINTS_OF_FORK * beyond_a_fork as f64
                        + POINTS_OF_ARM_GAP * (wrist - shoulder - 2) as f64;
                    if score < best.0 {
                        best = (score, [shoulder, elbow, wrist]);
                    }
                }
            }
        }
        let [upper, elbow, wrist] = best.1;
        let collar = upper.checked_sub(1).map(|place| chain[place]);
        [collar, Some(chain[upper]), Some(chain[elbow]), Some(chain[wrist])]
    }

    /// A hand that moves no vertex: the joint below the lower arm that is about as far from it as the elbow is
    /// from the shoulder.
    pub(super) fn still_hand(&self, upper: usize, lower: usize) -> Option<usize> {
        let arm = self.position[upper].distance(self.position[lower]);
        let length = |joint: usize| self.position[joint].distance(self.position[lower]);
        self.children[lower]
            .iter()
            .copied()
            .filter(|&joint| {
                (STILL_HAND_RANGE.0..STILL_HAND_RANGE.1).contains(&(length(joint) / arm.max(TINY)))
            })
            .max_by(|&a, &b| length(a).total_cmp(&length(b)))
    }
}
