//! Humanoid roles from the joint tree and its geometry, where names do not tell.
//!
//! Legs are the two like branches that reach the ground, arms the two like branches beside the column above
//! them, the head ends the branch between the arms. Branches that move no vertex (end joints, helpers) are left
//! out where the meshes have weights.

mod arm_roles;
mod joint_tree;
mod leg_roles;

use super::humanoid::{LEFT_ARM, LEFT_FINGERS, LEFT_LEG};
use super::{Humanoid, Mesh, Role, Skeleton};
use glam::{DVec3, Vec3};
use joint_tree::Tree;

/// The head is the first joint above the arms that moves at least this share of what the heaviest one moves. Seen:
/// ±30 % changes no role.
const HEAVY: f64 = 0.4;

impl Tree<'_> {
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
        let chain = self.follow(start, |tree, child| tree.carried[child]);
        let most = chain.iter().map(|&joint| self.own[joint]).fold(0.0, f64::max);
        let place = if self.weighted {
            let heavy = chain.iter().position(|&joint| self.own[joint] >= HEAVY * most)?;
            // A thick neck: what follows it lies below the next joint, which moves more.
            let neck = chain.get(heavy + 1).is_some_and(|&next| {
                let center = self.middle(chain[heavy]);
                self.own[next] > self.own[chain[heavy]] && (center - self.position[next]).dot(self.up) < 0.0
            });
            heavy + usize::from(neck)
        } else {
            // Without weights: the first fork (eyes, hair), else what has one end joint above it, if so many.
            let fork = chain.iter().position(|&joint| self.live(joint).len() >= 2);
            fork.unwrap_or(if chain.len() >= 3 { chain.len() - 2 } else { chain.len() - 1 })
        };
        Some((chain[..place].first().copied(), chain[place]))
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
        sum.try_normalize()
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
                let mut line = self.follow(start, |tree, child| tree.reach[child]);
                // A joint of the palm leads some of the lines.
                lines.push(line.split_off(line.len().saturating_sub(3)));
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
    let mut arms = [tree.split_arm(c), tree.split_arm(d)];
    let head = tree.head([c, d], [a, b], middle, across);
    // Right-handed axes: left = up × forward.
    let forward = tree.forward(&legs).unwrap_or_else(|| {
        // What exporters do by default: glTF looks along +Z, programs in which Z is up along -Y.
        let usual = [DVec3::Z, DVec3::NEG_Y].map(|ahead| ahead.reject_from(up));
        usual.into_iter().find(|ahead| ahead.length() > 0.5).unwrap_or_default()
    });
    if up.cross(forward).dot(across) < 0.0 {
        legs.swap(0, 1);
        arms.swap(0, 1);
    }
    let mut humanoid = Humanoid::default();
    for (side, (leg, arm)) in legs.into_iter().zip(arms).enumerate() {
        let left = side == 0;
        humanoid.set_on_side(left, LEFT_LEG, leg);
        humanoid.set_on_side(left, LEFT_ARM, arm);
        let lines = arm[3].map(|hand| tree.fingers(hand)).unwrap_or_default();
        for (roles, line) in LEFT_FINGERS.into_iter().zip(lines) {
            humanoid.set_on_side(left, roles, line);
        }
    }
    if let Some((neck, head)) = head {
        humanoid.set(Role::Neck, neck);
        humanoid.set(Role::Head, head);
    }
    Some(humanoid)
}
