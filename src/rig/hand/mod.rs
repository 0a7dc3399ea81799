//! The fingers of a hand: tips and roots from distances along its surface, joints in the middle of their sections.

pub mod pair;
mod region;
mod section;

use super::FoundJoint;
use crate::character::Role;
use crate::character::humanoid::LEFT_FINGERS;
use crate::geometry::Surface;
use crate::options::table::PAPER_RAYS;
use crate::rig::joints::{DERIVED, SEEN};
use crate::rig::placed::TRUSTED;
use glam::DVec3;
use region::{Finger, LEAST_PERSISTENCE, MITTEN_KNUCKLES, Region, SECTION_COUNT};
use std::collections::BTreeMap;
use std::f64::consts::TAU;

/// The fingers of one hand.
#[derive(Clone, Debug, Default)]
pub struct Hand {
    /// Joints by role, three a finger (left or right roles as asked for); a mitten has one chain, the middle finger's.
    pub joints: BTreeMap<Role, FoundJoint>,
    /// Where each finger ends, by the role of its distal joint.
    pub tips: BTreeMap<Role, DVec3>,
    /// How many fingers the hand shows, the thumb among them; 1 for a mitten or a fist, 2 for a mitten with a thumb, 0
    /// where there is no hand. May be above 5; the five freest have joints then.
    pub finger_count: usize,
}

/// Finds the fingers of the hand at `wrist`.
///
/// - `surface`: the same triangles, for rays.
/// - `positions`, `triangles`: what may belong to the hand, in the unit figure: body and gloves, better without hair and
///   things held.
/// - `elbow`, `wrist`: joints of the arm, in the unit figure; either may be off by a wrist's width.
/// - `left`: which side's roles to give.
///
/// The hand is what the plane across the forearm at the wrist cuts off. Fingers are the parts of it that hang on the
/// rest by their roots alone: tips are where distances from the wrist along the surface peak, roots where the parts meet
/// (the merge tree of the distances). Joints lie in the middles of a finger's sections, so curled and spread fingers are
/// followed: the knuckle a quarter of the free finger inside the palm, the others at 45 % and 72 % of the way from there
/// to the tip.
///
/// The thumb begins nearer the wrist and points another way than the others. Those are index, middle, ring and little
/// in this order from the thumb's side, as many as there are: a cartoon hand of four has no little finger. All fingers
/// in one have the middle one's roles, beside a thumb or alone. Without a thumb the front one is the index.
///
/// Confidence is that of what is seen for joints within a finger that stands out clearly, of what is derived for its knuckle, just
/// enough for a knuckle out of place and for mittens, and less where fingers are stubs or rays around a joint do not meet the surface.
///
/// Where nothing is cut at the wrist there is no hand. O(triangles + hand · log hand).
pub fn find_fingers(
    surface: &Surface,
    positions: &[DVec3],
    triangles: &[[u32; 3]],
    elbow: DVec3,
    wrist: DVec3,
    left: bool,
) -> Hand {
    let Some(region) = Region::new(positions, triangles, elbow, wrist) else {
        return Hand::default();
    };
    let (buried, free): (Vec<Finger>, Vec<Finger>) =
        region.fingers().into_iter().partition(|finger| region.is_buried(surface, finger));
    let hand = region.hand(surface, if free.is_empty() { buried } else { free });
    if left { hand } else { hand.of_other_side(|p| p) }
}

impl Hand {
    /// The same with the other side's roles, and its points moved.
    fn of_other_side(&self, moved: impl Fn(DVec3) -> DVec3) -> Self {
        let joint = |joint: &FoundJoint| FoundJoint { position: moved(joint.position), ..*joint };
        Self {
            joints: self.joints.iter().map(|(role, one)| (role.mirrored(), joint(one))).collect(),
            tips: self.tips.iter().map(|(role, &tip)| (role.mirrored(), moved(tip))).collect(),
            finger_count: self.finger_count,
        }
    }
}

/// A finger and the middles of its sections, from its web to its tip.
type Chain = (Finger, Vec<DVec3>);

impl Region {
    /// True where a tip lies within the rest of the hand, as the end of a forearm does in a hand that is a body of its
    /// own: rays from just beyond it, ahead and all around, meet the surface.
    fn is_buried(&self, surface: &Surface, finger: &Finger) -> bool {
        let path = self.path(finger);
        let tip = self.points[finger.tip as usize];
        let Some(way) = path.iter().rev().find_map(|&p| (tip - p).try_normalize()) else { return false };
        let beyond = tip + BEYOND_TIP * self.length * way;
        let reach = RAY_REACH * self.wrist_radius;
        surface.is_hit(beyond, way, self.length) && enclosed(surface, beyond, way, reach) >= 1.0
    }

    /// Fingers, which of them is the thumb, and joints (of the left hand).
    fn hand(&self, surface: &Surface, mut fingers: Vec<Finger>) -> Hand {
        let mut hand = Hand { finger_count: fingers.len(), ..Hand::default() };
        // Of more than five the freest.
        let free = |finger: &Finger| finger.tip_distance - finger.web_distance;
        fingers.sort_by(|a, b| free(b).total_cmp(&free(a)).then(a.tip.cmp(&b.tip)));
        fingers.truncate(5);
        let mut chains: Vec<Chain> = fingers.into_iter().map(|finger| (finger, self.path(&finger))).collect();
        let thumb = self.order(&mut chains);
        let roles: Vec<usize> = match (thumb, chains.len()) {
            (true, 2) => vec![0, 2],
            (false, 1) => vec![2],
            (true, count) => (0..count).collect(),
            (false, count) => (1..=count.min(4)).collect(),
        };
        for ((mut finger, mut path), role) in chains.into_iter().zip(roles) {
            // Alone, or alone beside a thumb: all fingers in one, whose knuckles are half way.
            let is_mitten = hand.finger_count <= 2 && role == 2;
            if is_mitten {
                finger.web_distance = finger.web_distance.max(MITTEN_KNUCKLES * finger.tip_distance);
                path = self.mitten();
            }
            let shares = match role {
                0 => THUMB_JOINTS,
                _ if is_mitten => MITTEN_JOINTS,
                _ => FINGER_JOINTS,
            };
            let (joints, kept) = self.joints(&path, shares, role == 0);
            let tip = path[path.len() - 1];
            let ways = [joints[1] - joints[0], tip - joints[1], tip - joints[2]];
            let seen = ((finger.tip_distance - finger.web_distance)
                / (2.0 * LEAST_PERSISTENCE * self.length))
                .clamp(0.5, 1.0);
            for (number, (role, position)) in LEFT_FINGERS[role].into_iter().zip(joints).enumerate() {
                let sure = match number {
                    _ if is_mitten => TRUSTED,
                    0 if kept => DERIVED,
                    0 => TRUSTED,
                    _ => SEEN,
                };
                let within = enclosed(surface, position, ways[number], RAY_REACH * self.wrist_radius);
                hand.joints.insert(role, FoundJoint { position, confidence: sure * seen * within });
            }
            hand.tips.insert(LEFT_FINGERS[role][2], tip);
        }
        hand
    }

    /// Puts fingers in order from the thumb's side; true where the first of them is a thumb.
    fn order(&self, chains: &mut Vec<Chain>) -> bool {
        if chains.len() < 2 {
            return false;
        }
        // A thumb begins and ends nearer to the wrist than the others and points another way. All fingers in one begin
        // in the middle of the palm.
        let way = |chain: &Chain| (chain.1[chain.1.len() - 1] - chain.1[0]).normalize_or_zero();
        let mitten = chains.len() == 2;
        let near = |chain: &Chain| {
            let root = if mitten { 0.0 } else { chain.1[0].distance(self.wrist) };
            (root + chain.1[chain.1.len() - 1].distance(self.wrist)) / self.length
        };
        let unlike = |index: usize| {
            let others = || chains[..index].iter().chain(&chains[index + 1..]);
            let mean_way = others().map(way).sum::<DVec3>().normalize_or_zero();
            let mean_near = others().map(near).sum::<f64>() / (chains.len() - 1) as f64;
            1.0 - way(&chains[index]).dot(mean_way) + mean_near - near(&chains[index])
        };
        let most = (0..chains.len()).rev().max_by(|&a, &b| unlike(a).total_cmp(&unlike(b)));
        let thumb = most.filter(|&index| unlike(index) > LEAST_THUMB).map(|index| chains.remove(index));
        // Where the others stand side by side, a little way out.
        let middle = |chain: &Chain| (chain.1[0] + chain.1[chain.1.len() / 2]) / 2.0;
        let centre = chains.iter().map(middle).sum::<DVec3>() / chains.len() as f64;
        let ahead = (centre - self.wrist).try_normalize().unwrap_or(self.along);
        let aside = |chain: &Chain| (middle(chain) - centre).reject_from_normalized(ahead);
        let furthest = chains.iter().rev().map(aside);
        let furthest = furthest.max_by(|a, b| a.length_squared().total_cmp(&b.length_squared()));
        let mut across = furthest.map_or(DVec3::ZERO, DVec3::normalize_or_zero);
        for _ in 0..8 {
            let next: DVec3 = chains.iter().map(|chain| across.dot(aside(chain)) * aside(chain)).sum();
            across = next.try_normalize().unwrap_or(across);
        }
        // The index is next to the thumb; where that stands opposite, or is not, it is in front: palms look down or in.
        let width = chains.iter().map(|chain| aside(chain).dot(across).abs()).fold(0.0, f64::max);
        let side = thumb.as_ref().map_or(0.0, |thumb| aside(thumb).dot(across));
        if (if side.abs() > 0.5 * width { side } else { across.z }) > 0.0 {
            across = -across;
        }
        let key = |chain: &Chain| aside(chain).dot(across);
        chains.sort_by(|a, b| key(a).total_cmp(&key(b)).then(a.0.tip.cmp(&b.0.tip)));
        let has_thumb = thumb.is_some();
        chains.splice(0..0, thumb);
        has_thumb
    }

    /// Three joints of a finger whose sections' middles are `path`, by their distances from the tip in lengths of the
    /// free finger; and whether the first is where these say.
    fn joints(&self, path: &[DVec3], shares: [f64; 3], thumb: bool) -> ([DVec3; 3], bool) {
        let tip = path[path.len() - 1];
        // Inside of the palm, straight on from the finger's lower half.
        let way = (path[path.len() / 2] - path[0]).normalize_or(self.along);
        let seen = path.windows(2).fold(0.0, |sum, pair| sum + pair[0].distance(pair[1]));
        // The first section is half a step from the web.
        let free = seen * (SECTION_COUNT as f64 / (SECTION_COUNT as f64 - 0.5));
        let at = |distance: f64| {
            let mut left = distance;
            for pair in path.windows(2).rev() {
                let step = pair[0].distance(pair[1]);
                if left <= step && step > 0.0 {
                    return pair[1].lerp(pair[0], left / step);
                }
                left -= step;
            }
            path[0] - left * way
        };
        let [least, most] = if thumb { THUMB_RANGE } else { KNUCKLE_RANGE };
        let reach = tip - self.wrist;
        let place = |scale: f64| {
            (at(shares[0] * scale * free) - self.wrist).dot(reach) / reach.length_squared().max(1e-18)
        };
        let (mut scale, mut kept) = (1.0, true);
        for (bound, other) in [(least, 0.0), (most, 2.0)] {
            if (place(1.0) - bound) * (other - 1.0) > 0.0 {
                let (mut within, mut beyond) = (other, 1.0);
                for _ in 0..20 {
                    scale = (within + beyond) / 2.0;
                    if (place(scale) - bound) * (other - 1.0) > 0.0 { beyond = scale } else { within = scale }
                }
                kept = false;
            }
        }
        (shares.map(|share| at(share * scale * free)), kept)
    }
}

/// Joints of a finger from its tip, in lengths of its free part: the knuckle lies a quarter of that inside the palm,
/// the others at 45 % and 72 % of the way from there. Seen: at -30 %, finger joints lie 0.0021 H further off; at +30 %,
/// finger joints lie 0.0023 H further off.
const FINGER_JOINTS: [f64; 3] = [1.25, 0.55 * 1.25, 0.28 * 1.25];

/// Joints of a thumb from its tip, in lengths of its free part: a thumb's web reaches up to its last bone but one.
/// Seen: ±30 % moves finger joints by under 0.0005 H.
const THUMB_JOINTS: [f64; 3] = [2.2, 1.55, 0.75];

/// Joints of a mitten from its tip. Seen: at -30 %, joints move up to 0.026 H (middle proximal); at +30 %, joints move
/// up to 0.017 H (middle proximal).
const MITTEN_JOINTS: [f64; 3] = [1.0, 0.55, 0.28];

/// A finger's knuckle lies between these shares of the way from wrist to tip, even if fingers are cut too deep or not deep
/// enough. Seen: at -30 %, finger joints lie 0.0009 H further off; at +30 %, finger joints lie 0.0005 H further off.
const KNUCKLE_RANGE: [f64; 2] = [0.4, 0.66];

/// A thumb's knuckle lies between these shares of the way from wrist to tip, however deep it is cut. Seen: ±30 % moves
/// finger joints by under 0.0005 H.
const THUMB_RANGE: [f64; 2] = [0.15, 0.5];

/// Rays around a joint reach this many radii of the wrist. Seen: ±30 % changes no finger.
const RAY_REACH: f64 = 3.0;

/// Just beyond a tip, as a share of the hand's length. Seen: ±30 % changes no finger.
const BEYOND_TIP: f64 = 0.02;

/// A finger less unlike the others than this is no thumb. Seen: ±30 % changes no finger.
const LEAST_THUMB: f64 = 0.12;

/// The share of the rays across `way` that meet the surface within `reach`: 1 inside a finger.
fn enclosed(surface: &Surface, at: DVec3, way: DVec3, reach: f64) -> f64 {
    let Some(way) = way.try_normalize() else { return 0.0 };
    // Y or Z, so that the other hand has the same rays.
    let axis = if way.y.abs() < 0.8 { DVec3::Y } else { DVec3::Z };
    let one = axis.reject_from_normalized(way).normalize();
    let other = way.cross(one);
    let met = (0..PAPER_RAYS).filter(|&ray| {
        let (sin, cos) = (TAU * f64::from(ray) / f64::from(PAPER_RAYS)).sin_cos();
        surface.is_hit(at, cos * one + sin * other, reach)
    });
    met.count() as f64 / f64::from(PAPER_RAYS)
}
