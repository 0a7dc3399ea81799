//! Humanoid roles from the joint tree and its geometry, where names do not tell.
//!
//! Legs are the two like branches that reach the ground, arms the two like branches beside the column above
//! them, the head ends the branch between the arms. Branches that move no vertex (end joints, helpers) are left
//! out where the meshes have weights.

use super::humanoid::LEFT_FINGERS;
use super::{Humanoid, Mesh, Role, Skeleton};
use glam::{DVec3, Vec3};

/// What the search knows of each joint.
struct Tree<'a> {
    skeleton: &'a Skeleton,
    children: Vec<Vec<usize>>,
    position: Vec<DVec3>,
    up: DVec3,
    ground: f64,
    /// From the ground to the highest point.
    height: f64,
    /// Sum of the weights to the joint itself, over the sum of all.
    own: Vec<f64>,
    /// The same, with everything below it.
    carried: Vec<f64>,
    /// Lowest and highest point of what hangs from the joint, itself included, along up.
    low: Vec<f64>,
    high: Vec<f64>,
    /// The distance from the joint to the farthest point of what hangs from it.
    reach: Vec<f64>,
    /// Mean of the vertices that follow the joint itself most, where there are any.
    center: Vec<Option<DVec3>>,
    weighted: bool,
}

impl<'a> Tree<'a> {
    fn new(skeleton: &'a Skeleton, meshes: &[Mesh], up: DVec3) -> Option<Self> {
        let count = skeleton.joints.len();
        let position: Vec<DVec3> = skeleton.joints.iter().map(|joint| joint.position()).collect();
        let mut own = vec![0.0; count];
        let mut low: Vec<f64> = position.iter().map(|p| p.dot(up)).collect();
        let mut high = low.clone();
        let mut reach = vec![0.0_f64; count];
        let mut sums = vec![(DVec3::ZERO, 0.0); count];
        let (mut ground, mut top) = (f64::INFINITY, f64::NEG_INFINITY);
        let order = skeleton.parents_first();
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
        if !weighted {
            own = vec![1.0 / count as f64; count];
        } else {
            own.iter_mut().for_each(|weight| *weight /= total);
        }
        let mut carried = own.clone();
        for &joint in order.iter().rev() {
            if let Some(parent) = skeleton.joints[joint].parent {
                carried[parent] += carried[joint];
            }
        }
        if !weighted {
            ground = low.iter().copied().fold(f64::INFINITY, f64::min);
            top = high.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        }
        for &joint in order.iter().rev() {
            if let Some(parent) = skeleton.joints[joint].parent {
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
    fn level(&self, joint: usize) -> f64 {
        (self.position[joint].dot(self.up) - self.ground) / self.height
    }

    fn moves(&self, joint: usize) -> bool {
        self.carried[joint] > 1e-7
    }

    /// Children that move something, or all where there are no weights.
    fn live(&self, joint: usize) -> Vec<usize> {
        self.children[joint].iter().copied().filter(|&child| self.moves(child)).collect()
    }

    fn within(&self, joint: usize, above: usize) -> bool {
        joint == above || self.skeleton.is_below(joint, above)
    }

    /// The two children of one joint that look most like a pair of legs.
    fn legs(&self) -> Option<(usize, usize)> {
        let lowest = |joint: usize| (self.low[joint] - self.ground) / self.height;
        let mut best: Option<(f64, usize, usize)> = None;
        for children in (0..self.position.len()).map(|joint| self.live(joint)) {
            for (place, &a) in children.iter().enumerate() {
                for &b in &children[place + 1..] {
                    let high_enough = self.level(a) >= 0.08 && self.level(b) >= 0.08;
                    let grounded = lowest(a) < 0.3 && lowest(b) < 0.3;
                    let apart = self.lower_ends_distance(a, b) > 0.02 * self.height;
                    if !(high_enough && grounded && apart) {
                        continue;
                    }
                    let start = self.level(a) - self.level(b);
                    let segments = |joint| f64::from(u8::from(!self.live(joint).is_empty()));
                    let score = (self.carried[a] + self.carried[b]).min(0.4)
                        - 2.0 * (lowest(a) + lowest(b))
                        - 2.0 * start.abs()
                        - 2.0 * (lowest(a) - lowest(b)).abs()
                        - (self.reach[a] - self.reach[b]).abs() / self.height
                        + 0.1 * (segments(a) + segments(b))
                        // Capes and long hair reach the ground from above.
                        - 0.5 * (self.level(a) - 0.5).max(0.0);
                    if best.is_none_or(|(known, _, _)| score > known) {
                        best = Some((score, a, b));
                    }
                }
            }
        }
        best.map(|(_, a, b)| (a, b))
    }

    /// How far apart the lower ends of two branches are across up.
    fn lower_ends_distance(&self, a: usize, b: usize) -> f64 {
        let end = |top: usize| {
            let path = self.downward(top);
            let last = path.last().copied().unwrap_or(top);
            self.center[last].unwrap_or(self.position[last])
        };
        (end(a) - end(b)).reject_from(self.up).length()
    }

    /// From the top of a leg, always to the child that reaches lowest and moves most.
    fn downward(&self, top: usize) -> Vec<usize> {
        self.follow(top, |tree, child| {
            tree.carried[child] / tree.carried[top].max(1e-9) - (tree.low[child] - tree.ground) / tree.height
        })
    }

    /// From `start` on to the best of the live children, down to the last one.
    fn follow(&self, start: usize, worth: impl Fn(&Self, usize) -> f64) -> Vec<usize> {
        let mut path = vec![start];
        let mut joint = start;
        while let Some(next) =
            self.live(joint).into_iter().max_by(|&a, &b| worth(self, a).total_cmp(&worth(self, b)))
        {
            path.push(next);
            joint = next;
        }
        path
    }

    /// Upper leg, lower leg, foot and toes along the way down from `top`; `other` is the other leg's top.
    fn split_leg(&self, top: usize, other: usize) -> [Option<usize>; 4] {
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
        let pelvis_first = aside(0) < 0.4 * aside(1) && point(0).distance(point(1)) < 0.12 * self.height;
        let mut best = (f64::INFINITY, [0, 1, 2]);
        for hip in 0..2.min(chain.len() - 2) {
            for knee in hip + 1..chain.len() - 1 {
                for ankle in knee + 1..chain.len() {
                    let upper = point(hip).distance(point(knee));
                    let lower = point(knee).distance(point(ankle));
                    let whole = (upper + lower).max(1e-9);
                    let stump = upper.min(lower) < 0.15 * whole;
                    let ankle_level = along(ankle) / along(hip).max(1e-9);
                    let score = 1.5 * (upper / whole - 0.5).abs()
                        + 2.0 * ((ankle_level - 0.15).abs() - 0.1).max(0.0)
                        + (1.0 - (along(hip) - along(ankle)) / whole)
                        + if (hip > 0) == pelvis_first { 0.0 } else { 0.4 }
                        + if stump { 1.0 } else { 0.0 }
                        + 0.25 * (ankle - hip - 2) as f64;
                    if score < best.0 {
                        best = (score, [hip, knee, ankle]);
                    }
                }
            }
        }
        let [hip, knee, ankle] = best.1;
        let toes = chain.get(ankle + 1).copied();
        [Some(chain[hip]), Some(chain[knee]), Some(chain[ankle]), toes]
    }

    /// A foot that hangs elsewhere, near the end of a leg that has none (rigs with IK).
    fn loose_foot(&self, upper: usize, lower: usize) -> Option<usize> {
        let shin = self.position[lower] - self.position[upper];
        let end = self.children[lower]
            .iter()
            .map(|&child| self.position[child])
            .max_by(|a, b| {
                let along = |p: &DVec3| (*p - self.position[lower]).dot(shin);
                along(a).total_cmp(&along(b))
            })
            .unwrap_or(self.position[lower] + shin);
        let parent = self.skeleton.joints[upper].parent;
        let leg = 2.0 * shin.length();
        (0..self.position.len())
            .filter(|&joint| {
                self.moves(joint)
                    && parent.is_none_or(|parent| !self.within(joint, parent))
                    && !self.within(lower, joint)
                    && self.position[joint].distance(end) < 0.35 * leg
                    && self.position[joint].dot(self.up) < self.position[lower].dot(self.up)
            })
            .min_by(|&a, &b| self.position[a].distance(end).total_cmp(&self.position[b].distance(end)))
    }

    /// How far what hangs from `joint` reaches along `across`.
    fn reach_aside(&self, joint: usize, middle: DVec3, across: DVec3) -> f64 {
        let path = self.follow(joint, |tree, child| tree.reach[child]);
        let end = path.last().copied().unwrap_or(joint);
        (self.center[end].unwrap_or(self.position[end]) - middle).dot(across)
    }

    /// The two children of one joint that look most like a pair of arms beside a head.
    fn arms(&self, legs: [usize; 2], middle: DVec3, across: DVec3) -> Option<(usize, usize)> {
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
                        || reach < 0.06
                    {
                        continue;
                    }
                    // Something must rise between the arms that is neither: the neck or the head.
                    let head_between = children.iter().any(|&c| {
                        c != a
                            && c != b
                            && self.high[c] - self.ground > self.level(a) * self.height
                            && self.carried[c] > 0.01
                    });
                    let start =
                        (self.level(a) - self.level(b)).abs() + (aside(a) + aside(b)).abs() / self.height;
                    let ends = (end_a + end_b).abs() / self.height;
                    let score = reach
                        + (end_a - end_b).abs() / self.height
                        + (self.carried[a] + self.carried[b]).min(0.3)
                        + if head_between { 0.5 } else { 0.0 }
                        - start
                        - 0.5 * ends
                        - (self.reach[a] - self.reach[b]).abs() / self.height
                        - 0.05 * depth;
                    if best.is_none_or(|(known, _, _)| score > known) {
                        best = Some((score, a, b));
                    }
                }
            }
        }
        best.map(|(_, a, b)| (a, b))
    }

    /// Shoulder, upper arm, lower arm and hand along the way out from `top`.
    fn split_arm(&self, top: usize, middle: DVec3, across: DVec3) -> [Option<usize>; 4] {
        let chain = self.follow(top, |tree, child| {
            tree.reach[child] + tree.carried[child] / tree.carried[top].max(1e-9) * tree.reach[top]
        });
        let point = |place: usize| self.position[chain[place]];
        let aside = |place: usize| (point(place) - middle).dot(across).abs();
        let beyond = |place: usize| self.reach[chain[place]];
        // A collarbone is short and starts near the middle.
        let collar_first = chain.len() > 2
            && aside(0) < 0.65 * aside(1)
            && point(0).distance(point(1)) < 0.65 * point(1).distance(point(2));
        match chain[..] {
            [upper] => return [None, Some(upper), None, None],
            [upper, lower] => return [None, Some(upper), Some(lower), self.still_hand(upper, lower)],
            [shoulder, upper, lower]
                if collar_first && self.reach[lower] > 0.6 * point(1).distance(point(2)) =>
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
                    let whole = (upper + lower).max(1e-9);
                    let rest = beyond(wrist) / whole;
                    let stump = upper.min(lower) < 0.15 * whole;
                    let collar = match shoulder {
                        0 if collar_first => 0.4,
                        0 => 0.0,
                        1 if collar_first => 0.0,
                        1 => 0.3,
                        _ => 0.5,
                    };
                    let beyond_a_fork = (shoulder..wrist).filter(|&place| branches(place)).count();
                    let score = 1.5 * (upper / whole - 0.5).abs()
                        + 2.0 * (0.12 - rest).max(0.0)
                        + 2.0 * (rest - 0.6).max(0.0)
                        + collar
                        + if stump { 1.0 } else { 0.0 }
                        + if branches(wrist) { -0.2 } else { 0.0 }
                        + 0.3 * beyond_a_fork as f64
                        + 0.2 * (wrist - shoulder - 2) as f64;
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
    fn still_hand(&self, upper: usize, lower: usize) -> Option<usize> {
        let arm = self.position[upper].distance(self.position[lower]);
        let length = |joint: usize| self.position[joint].distance(self.position[lower]);
        self.children[lower]
            .iter()
            .copied()
            .filter(|&joint| (0.5..1.6).contains(&(length(joint) / arm.max(1e-9))))
            .max_by(|&a, &b| length(a).total_cmp(&length(b)))
    }

    /// Neck and head, above the joint from which the arms hang.
    fn head(
        &self,
        arms: [usize; 2],
        legs: [usize; 2],
        middle: DVec3,
        across: DVec3,
    ) -> Option<(Option<usize>, usize)> {
        let limbs = [arms[0], arms[1], legs[0], legs[1]];
        let chest = self.skeleton.joints[arms[0]].parent?;
        let shoulders = (self.level(arms[0]) + self.level(arms[1])) / 2.0;
        let worth = |joint: usize| {
            (self.high[joint] - self.ground) / self.height + self.carried[joint]
                - 2.0 * ((self.position[joint] - middle).dot(across) / self.height).abs()
        };
        // Where nothing rises from the arms' own joint, the head hangs from one below it.
        let start = self.skeleton.ancestors(chest).find_map(|joint| {
            self.live(joint)
                .into_iter()
                .filter(|child| limbs.iter().all(|limb| !self.within(*limb, *child)))
                .filter(|&child| (self.high[child] - self.ground) / self.height > shoulders)
                .max_by(|&a, &b| worth(a).total_cmp(&worth(b)))
        })?;
        let chain = self.follow(start, |tree, child| {
            tree.carried[child] + 0.2 * (tree.high[child] - tree.ground) / tree.height
        });
        let most = chain.iter().map(|&joint| self.own[joint]).fold(0.0, f64::max);
        let place = if self.weighted {
            let heavy = chain.iter().position(|&joint| self.own[joint] >= 0.4 * most)?;
            // A thick neck: what follows it lies below the next joint, which moves more.
            let neck = chain.get(heavy + 1).is_some_and(|&next| {
                let center = self.center[chain[heavy]].unwrap_or(self.position[chain[heavy]]);
                self.own[next] > self.own[chain[heavy]] && (center - self.position[next]).dot(self.up) < 0.0
            });
            heavy + usize::from(neck)
        } else {
            // Without weights: the first fork (eyes, hair), else what has one end joint above it, if so many.
            let fork = chain.iter().position(|&joint| self.live(joint).len() >= 2);
            fork.unwrap_or(if chain.len() >= 3 { chain.len() - 2 } else { chain.len() - 1 })
        };
        let neck = chain[..place]
            .iter()
            .copied()
            .find(|&joint| self.level(joint) >= shoulders - 0.02)
            .or(place.checked_sub(1).map(|place| chain[place]));
        Some((neck, chain[place]))
    }

    /// The way the feet point, across up; `None` where they do not tell.
    fn forward(&self, legs: &[[Option<usize>; 4]; 2]) -> Option<DVec3> {
        let mut sum = DVec3::ZERO;
        for &[upper, lower, foot, toes] in legs {
            let ankle = foot.or(lower).or(upper)?;
            let toward = match (toes, foot) {
                (Some(toes), _) => self.position[toes],
                // The foot's mesh reaches farther forward of the ankle than back.
                (None, Some(foot)) => self.center[foot]?,
                (None, None) => continue,
            };
            sum += (toward - self.position[ankle]).reject_from(self.up);
        }
        (sum.length() > 0.005 * self.height).then(|| sum.normalize())
    }

    /// The fingers of one hand, thumb first, as lines of joints; empty where their order is not clear.
    fn fingers(&self, hand: usize) -> Vec<Vec<usize>> {
        // Down through palms and end joints until the hand forks.
        let mut starts = self.live(hand);
        while let [only] = starts[..] {
            starts = self.live(only);
        }
        let mut lines: Vec<Vec<usize>> = Vec::new();
        let mut stack = starts;
        while let Some(start) = stack.pop() {
            let children = self.live(start);
            if children.len() > 1 {
                stack.extend(children);
            } else {
                lines.push(self.follow(start, |tree, child| tree.reach[child]));
            }
        }
        // A joint of the palm leads some of the lines.
        for line in &mut lines {
            if line.len() > 3 {
                line.drain(..line.len() - 3);
            }
        }
        if lines.len() != 5 || lines.iter().any(|line| line.len() < 2) {
            return Vec::new();
        }
        let wrist = self.position[hand];
        let start = |line: &Vec<usize>| self.position[line[0]];
        let mean = lines.iter().map(start).sum::<DVec3>() / 5.0 - wrist;
        let off = |line: &Vec<usize>| {
            let along = self.position[line[line.len() - 1]] - start(line);
            along.angle_between(mean) + (start(line) - wrist).angle_between(mean)
        };
        lines.sort_by(|a, b| off(b).total_cmp(&off(a)));
        if off(&lines[0]) < 1.2 * off(&lines[1]) {
            return Vec::new();
        }
        let thumb = start(&lines[0]);
        lines[1..].sort_by(|a, b| start(a).distance(thumb).total_cmp(&start(b).distance(thumb)));
        lines
    }
}

/// Roles as far as the tree and the geometry tell them; names are not read.
///
/// - `meshes`: their weights tell which joints move something, and how far limbs reach beyond their last joint.
///   Without weights every joint counts.
/// - `up`: from the feet to the head, any length; a direction of length 0 gives no roles.
/// - Returns neck, head and limbs, fingers where five of them are clearly in order; or an empty map where no legs or no
///   arms are found. Hips and column are left to [`complete`](super::roles::complete).
///
/// Left and right follow from the feet, which point forward; where they do not tell, from +Z as forward.
///
/// O(vertices · depth + joints · children²).
pub fn roles_from_tree(skeleton: &Skeleton, meshes: &[Mesh], up: Vec3) -> Humanoid {
    find(skeleton, meshes, up.as_dvec3().normalize_or_zero()).unwrap_or_default()
}

fn find(skeleton: &Skeleton, meshes: &[Mesh], up: DVec3) -> Option<Humanoid> {
    use Role::*;
    skeleton.validate().ok()?;
    if up == DVec3::ZERO {
        return None;
    }
    let tree = Tree::new(skeleton, meshes, up)?;
    let (a, b) = tree.legs()?;
    let mut legs = [tree.split_leg(a, b), tree.split_leg(b, a)];
    let at = |joint: Option<usize>, otherwise: usize| tree.position[joint.unwrap_or(otherwise)];
    let (hip_a, hip_b) = (at(legs[0][0], a), at(legs[1][0], b));
    let middle = (hip_a + hip_b) / 2.0;
    let mut across = (hip_a - hip_b).reject_from(up).normalize_or_zero();
    if across == DVec3::ZERO {
        let (end_a, end_b) = (legs[0].iter().flatten().last(), legs[1].iter().flatten().last());
        across = (at(end_a.copied(), a) - at(end_b.copied(), b)).reject_from(up).normalize_or_zero();
    }
    let (c, d) = tree.arms([a, b], middle, across)?;
    // The first of each pair is the one toward `across`.
    let aside = |joint: usize| tree.reach_aside(joint, middle, across);
    let (c, d) = if aside(c) >= aside(d) { (c, d) } else { (d, c) };
    let mut arms = [tree.split_arm(c, middle, across), tree.split_arm(d, middle, across)];
    let head = tree.head([c, d], [a, b], middle, across);
    // Right-handed axes: left = up × forward.
    let forward = tree.forward(&legs).unwrap_or({
        let ahead = if up.z.abs() > 0.9 { DVec3::NEG_Y } else { DVec3::Z };
        ahead.reject_from(up)
    });
    if up.cross(forward).dot(across) < 0.0 {
        legs.swap(0, 1);
        arms.swap(0, 1);
    }
    let mut humanoid = Humanoid::default();
    for (side, (leg, arm)) in legs.into_iter().zip(arms).enumerate() {
        let role = |left: Role| left.on_side(side == 0);
        for (left, joint) in [LeftUpperLeg, LeftLowerLeg, LeftFoot, LeftToes].into_iter().zip(leg) {
            humanoid.set(role(left), joint);
        }
        for (left, joint) in [LeftShoulder, LeftUpperArm, LeftLowerArm, LeftHand].into_iter().zip(arm) {
            humanoid.set(role(left), joint);
        }
        let lines = arm[3].map(|hand| tree.fingers(hand)).unwrap_or_default();
        for (roles, line) in LEFT_FINGERS.into_iter().zip(lines) {
            for (left, joint) in roles.into_iter().zip(line) {
                humanoid.set(role(left), joint);
            }
        }
    }
    if let Some((neck, head)) = head {
        humanoid.set(Neck, neck);
        humanoid.set(Head, head);
    }
    Some(humanoid)
}
