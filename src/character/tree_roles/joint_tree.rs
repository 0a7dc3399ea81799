//! A tree of joints with what hangs from each.

use crate::character::{Mesh, Skeleton};
use glam::DVec3;

/// Points against a limb whose halves differ, times how much. Seen: ±30 % changes no role.
const POINTS_OF_HALVES: f64 = 1.5;

/// What the search knows of each joint.
pub(super) struct Tree<'a> {
    pub(super) skeleton: &'a Skeleton,
    pub(super) children: Vec<Vec<usize>>,
    pub(super) position: Vec<DVec3>,
    pub(super) up: DVec3,
    pub(super) ground: f64,
    /// From the ground to the highest point.
    pub(super) height: f64,
    /// Sum of the weights to the joint itself, over the sum of all.
    pub(super) own: Vec<f64>,
    /// The same, with everything below it.
    pub(super) carried: Vec<f64>,
    /// Lowest and highest point of what hangs from the joint, itself included, along up.
    pub(super) low: Vec<f64>,
    pub(super) high: Vec<f64>,
    /// The distance from the joint to the farthest point of what hangs from it.
    pub(super) reach: Vec<f64>,
    /// Mean of the vertices that follow the joint itself most, where there are any.
    pub(super) center: Vec<Option<DVec3>>,
    pub(super) weighted: bool,
}

impl<'a> Tree<'a> {
    pub(super) fn new(skeleton: &'a Skeleton, meshes: &[Mesh], up: DVec3) -> Option<Self> {
        let count = skeleton.joints.len();
        let position: Vec<DVec3> = skeleton.joints.iter().map(|joint| joint.position()).collect();
        let mut own = vec![0.0; count];
        let mut low: Vec<f64> = position.iter().map(|p| p.dot(up)).collect();
        let mut high = low.clone();
        let mut reach = vec![0.0_f64; count];
        let mut sums = vec![(DVec3::ZERO, 0.0); count];
        let (mut ground, mut top) = (f64::INFINITY, f64::NEG_INFINITY);
        for mesh in meshes {
            for (point, row) in mesh.positions.iter().zip(mesh.weights.rows()) {
                let point = point.as_dvec3();
                if !point.is_finite() {
                    continue;
                }
                let row = || row.iter().filter(|&&(joint, _)| (joint as usize) < count);
                for &(joint, weight) in row() {
                    own[joint as usize] += f64::from(weight).max(0.0);
                }
                let Some(&(joint, _)) = row().max_by(|a, b| a.1.total_cmp(&b.1)) else {
                    continue;
                };
                let joint = joint as usize;
                let along = point.dot(up);
                ground = ground.min(along);
                top = top.max(along);
                low[joint] = low[joint].min(along);
                high[joint] = high[joint].max(along);
                sums[joint].0 += point;
                sums[joint].1 += 1.0;
                for above in skeleton.ancestors(joint) {
                    reach[above] = reach[above].max(point.distance(position[above]));
                }
            }
        }
        let total: f64 = own.iter().sum();
        let weighted = total > 0.0;
        if weighted {
            own.iter_mut().for_each(|weight| *weight /= total);
        } else {
            own = vec![1.0 / count as f64; count];
            ground = low.iter().copied().fold(f64::INFINITY, f64::min);
            top = high.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        }
        let mut carried = own.clone();
        for joint in skeleton.parents_first().into_iter().rev() {
            if let Some(parent) = skeleton.joints[joint].parent {
                carried[parent] += carried[joint];
                // Joints that carry nothing may be handles far away from the body; near ends still tell a limb's
                // length.
                if carried[joint] > 0.0 {
                    low[parent] = low[parent].min(low[joint]);
                    high[parent] = high[parent].max(high[joint]);
                }
            }
            if carried[joint] > 0.0 {
                for above in skeleton.ancestors(joint) {
                    reach[above] = reach[above].max(position[joint].distance(position[above]));
                }
            }
        }
        let height = top - ground;
        (height.is_finite() && height > 0.0).then(|| Self {
            skeleton,
            children: skeleton.children(),
            position,
            up,
            ground,
            height,
            own,
            carried,
            low,
            high,
            reach,
            center: sums.into_iter().map(|(sum, number)| (number > 0.0).then(|| sum / number)).collect(),
            weighted,
        })
    }

    /// Height over the ground, over the height of the whole.
    pub(super) fn level(&self, joint: usize) -> f64 {
        (self.position[joint].dot(self.up) - self.ground) / self.height
    }

    pub(super) fn moves(&self, joint: usize) -> bool {
        self.carried[joint] > 0.0
    }

    /// Children that move something, or all where there are no weights.
    pub(super) fn live(&self, joint: usize) -> Vec<usize> {
        self.children[joint].iter().copied().filter(|&child| self.moves(child)).collect()
    }

    pub(super) fn within(&self, joint: usize, above: usize) -> bool {
        joint == above || self.skeleton.is_below(joint, above)
    }

    /// Where the vertices are that follow the joint most, else the joint.
    pub(super) fn middle(&self, joint: usize) -> DVec3 {
        self.center[joint].unwrap_or(self.position[joint])
    }

    /// The two children of one of these joints that have the most points; `points` are none for what is no pair.
    pub(super) fn best_pair(
        &self,
        parents: impl Iterator<Item = usize>,
        points: impl Fn(usize, usize) -> Option<f64>,
    ) -> Option<(usize, usize)> {
        let mut best: Option<(f64, usize, usize)> = None;
        for children in parents.map(|joint| self.live(joint)) {
            for (place, &a) in children.iter().enumerate() {
                for &b in &children[place + 1..] {
                    if let Some(points) = points(a, b)
                        && best.is_none_or(|(known, _, _)| points > known)
                    {
                        best = Some((points, a, b));
                    }
                }
            }
        }
        best.map(|(_, a, b)| (a, b))
    }

    /// Places along the chain of a limb where its two halves begin and the second one ends: those with the fewest points
    /// against them. The first is one of the first `firsts`.
    ///
    /// `points`: of three places, beside those for unlike halves, which it adds to; and of the length of both halves.
    pub(super) fn split(
        &self,
        chain: &[usize],
        firsts: usize,
        points: impl Fn([usize; 3], f64, f64) -> f64,
    ) -> [usize; 3] {
        let point = |place: usize| self.position[chain[place]];
        let mut best = (f64::INFINITY, [0, 1, 2]);
        for first in 0..firsts.min(chain.len() - 2) {
            for middle in first + 1..chain.len() - 1 {
                for last in middle + 1..chain.len() {
                    let upper = point(first).distance(point(middle));
                    let lower = point(middle).distance(point(last));
                    let whole = (upper + lower).max(f64::MIN_POSITIVE);
                    let unlike = POINTS_OF_HALVES * (upper / whole - 0.5).abs();
                    let points = points([first, middle, last], unlike, whole);
                    if points < best.0 {
                        best = (points, [first, middle, last]);
                    }
                }
            }
        }
        best.1
    }

    /// From `start` on to the best of the live children, down to the last one.
    pub(super) fn follow(&self, start: usize, worth: impl Fn(&Self, usize) -> f64) -> Vec<usize> {
        let best = |&joint: &usize| {
            self.live(joint).into_iter().max_by(|&a, &b| worth(self, a).total_cmp(&worth(self, b)))
        };
        std::iter::successors(Some(start), best).collect()
    }
}
