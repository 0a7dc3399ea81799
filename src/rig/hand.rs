//! The fingers of a hand: tips and roots from distances along its surface, joints in the middle of their sections.

use super::FoundJoint;
use crate::character::Role;
use crate::character::humanoid::LEFT_FINGERS;
use crate::geometry::{SEAM, Surface, components, neighbours, weld};
use glam::DVec3;
use std::cmp::Reverse;
use std::collections::{BTreeMap, BinaryHeap};
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
/// Confidence is 0.9 for joints within a finger that stands out clearly, 0.7 for its knuckle, 0.5 for a knuckle out of
/// place and for mittens, less where fingers are stubs or rays around a joint do not meet the surface.
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
    let mut fingers = region.fingers();
    if fingers.iter().any(|finger| !region.is_buried(surface, finger)) {
        fingers.retain(|finger| !region.is_buried(surface, finger));
    }
    let mut hand = region.hand(surface, fingers);
    if !left {
        hand.joints = std::mem::take(&mut hand.joints)
            .into_iter()
            .map(|(role, joint)| (role.mirrored(), joint))
            .collect();
        hand.tips =
            std::mem::take(&mut hand.tips).into_iter().map(|(role, tip)| (role.mirrored(), tip)).collect();
    }
    hand
}

/// The mesh beyond the wrist.
struct Region {
    /// Welded vertices.
    points: Vec<DVec3>,
    triangles: Vec<[u32; 3]>,
    /// Edges, and the shortest bridges between pieces.
    graph: Vec<Vec<u32>>,
    /// Whether an edge from here crosses the wrist.
    is_start: Vec<bool>,
    /// Distance from the wrist along the graph; infinite where it does not lead.
    distances: Vec<f64>,
    /// The greatest of them.
    length: f64,
    wrist: DVec3,
    /// The way the forearm points.
    along: DVec3,
    wrist_radius: f64,
}

/// A finger: the part of the hand around a tip that hangs on the rest by its root alone.
#[derive(Clone, Debug)]
struct Finger {
    tip: u32,
    tip_distance: f64,
    /// Where it meets its neighbour, as a distance from the wrist.
    web_distance: f64,
}

/// A tip stands out by this share of the hand's length, at least ...
const LEAST_PERSISTENCE: f64 = 0.1;

/// ... and is this far from the wrist: cuffs are nearer.
const LEAST_REACH: f64 = 0.35;

/// Fingers part further from the wrist than this share of the hand's length: what parts nearer is worn on the wrist.
const LEAST_WEB: f64 = 0.12;

/// Outlines below this share of the radius of one around the wrist are no arms.
const SLIVER: f64 = 0.3;

impl Region {
    fn new(positions: &[DVec3], triangles: &[[u32; 3]], elbow: DVec3, wrist: DVec3) -> Option<Self> {
        let along = (wrist - elbow).try_normalize()?;
        let forearm = wrist.distance(elbow);
        let reach = (1.5 * forearm).clamp(0.12, 0.3);
        let section = Section::new(positions, triangles, wrist, along, reach)?;
        let is_near = |p: DVec3| {
            // The section's middle lies in the plane through the wrist, which parts what is cut from what is not.
            (p - wrist).dot(along) > 0.0 && p.distance_squared(section.centre) <= reach * reach
        };
        let mut index = vec![u32::MAX; positions.len()];
        let mut points = Vec::new();
        for (vertex, &p) in positions.iter().enumerate() {
            if is_near(p) {
                index[vertex] = points.len() as u32;
                points.push(p);
            }
        }
        let near: Vec<[u32; 3]> = triangles
            .iter()
            .map(|corners| corners.map(|vertex| index[vertex as usize]))
            .filter(|corners| !corners.contains(&u32::MAX))
            .collect();
        let weld = weld(&points, SEAM);
        let pieces = components(&near, &weld);
        let around = neighbours(&near, &weld);
        let firsts = weld.first_vertices();
        let points: Vec<DVec3> = firsts.iter().map(|&vertex| points[vertex as usize]).collect();
        let triangles: Vec<[u32; 3]> = near
            .iter()
            .map(|&corners| weld.triangle(corners))
            .filter(|[a, b, c]| a != b && b != c && c != a)
            .collect();
        let graph: Vec<Vec<u32>> = (0..points.len()).map(|vertex| around.of(vertex).to_vec()).collect();
        let mut is_start = vec![false; points.len()];
        for vertex in section.ahead {
            if let Some(&near) = index.get(vertex as usize)
                && near != u32::MAX
            {
                is_start[weld.representative[near as usize] as usize] = true;
            }
        }
        let mut region = Self {
            points,
            triangles,
            graph,
            is_start,
            distances: Vec::new(),
            length: 0.0,
            wrist: section.centre,
            along,
            wrist_radius: section.radius,
        };
        region.bridge(&pieces, reach);
        region.measure();
        (region.length > 0.5 * region.wrist_radius).then_some(region)
    }

    /// Joins pieces that do not begin at the wrist to what does, each where it is nearest.
    fn bridge(&mut self, pieces: &[u32], reach: f64) {
        let count = pieces.iter().max().map_or(0, |&last| last as usize + 1);
        let mut members: Vec<Vec<u32>> = vec![Vec::new(); count];
        for (vertex, &piece) in pieces.iter().enumerate() {
            members[piece as usize].push(vertex as u32);
        }
        // Pieces that go on outside are something else: a leg, the ground.
        let mut waiting = Vec::new();
        let mut joined: Vec<u32> = Vec::new();
        for (piece, vertices) in members.iter().enumerate() {
            if vertices.iter().any(|&vertex| self.is_start[vertex as usize]) {
                joined.extend(vertices);
            } else if vertices.len() > 3
                && vertices.iter().all(|&v| self.points[v as usize].distance(self.wrist) < 0.95 * reach)
            {
                waiting.push(piece);
            }
        }
        while !waiting.is_empty() && !joined.is_empty() {
            let tree_points: Vec<DVec3> = joined.iter().map(|&vertex| self.points[vertex as usize]).collect();
            let tree = crate::geometry::PointTree::new(&tree_points);
            let mut best: Option<(f64, usize, u32, u32)> = None;
            let mut found = Vec::new();
            for (slot, &piece) in waiting.iter().enumerate() {
                for &vertex in &members[piece] {
                    let limit = best.map_or(self.wrist_radius, |best| best.0);
                    tree.nearest(self.points[vertex as usize], 1, limit, &mut found);
                    if let Some(near) = found.first()
                        && best.is_none_or(|best| near.distance() < best.0)
                    {
                        best = Some((near.distance(), slot, vertex, joined[near.index() as usize]));
                    }
                }
            }
            let Some((_, slot, one, other)) = best else { break };
            self.graph[one as usize].push(other);
            self.graph[other as usize].push(one);
            joined.extend(&members[waiting.remove(slot)]);
        }
    }

    /// Distances from the wrist along edges.
    fn measure(&mut self) {
        self.distances = vec![f64::INFINITY; self.points.len()];
        let mut queue = BinaryHeap::new();
        for vertex in 0..self.points.len() as u32 {
            if self.is_start[vertex as usize] {
                let ahead = (self.points[vertex as usize] - self.wrist).dot(self.along).max(0.0);
                self.distances[vertex as usize] = ahead;
                queue.push(Reverse((ahead.to_bits(), vertex)));
            }
        }
        while let Some(Reverse((bits, vertex))) = queue.pop() {
            let distance = f64::from_bits(bits);
            if distance > self.distances[vertex as usize] {
                continue;
            }
            for &next in &self.graph[vertex as usize] {
                let further = distance + self.points[vertex as usize].distance(self.points[next as usize]);
                if further < self.distances[next as usize] {
                    self.distances[next as usize] = further;
                    queue.push(Reverse((further.to_bits(), next)));
                }
            }
        }
        self.length = self.distances.iter().copied().filter(|d| d.is_finite()).fold(0.0, f64::max);
    }

    /// Tips that stand out, furthest first: the merge tree of the distances, swept from the far end.
    fn fingers(&self) -> Vec<Finger> {
        let mut order: Vec<u32> =
            (0..self.points.len() as u32).filter(|&v| self.distances[v as usize].is_finite()).collect();
        order.sort_by(|&a, &b| {
            self.distances[b as usize].total_cmp(&self.distances[a as usize]).then(a.cmp(&b))
        });
        let mut parents = vec![u32::MAX; self.points.len()];
        fn root(parents: &mut [u32], mut vertex: u32) -> u32 {
            while parents[vertex as usize] != vertex {
                parents[vertex as usize] = parents[parents[vertex as usize] as usize];
                vertex = parents[vertex as usize];
            }
            vertex
        }
        // Every tree's root is its tip.
        let mut webs: BTreeMap<u32, f64> = BTreeMap::new();
        let mut fingers = Vec::new();
        let least = LEAST_PERSISTENCE * self.length;
        for &vertex in &order {
            let distance = self.distances[vertex as usize];
            parents[vertex as usize] = vertex;
            for &next in &self.graph[vertex as usize] {
                if parents[next as usize] == u32::MAX {
                    continue;
                }
                let (one, other) = (root(&mut parents, vertex), root(&mut parents, next));
                if one == other {
                    continue;
                }
                let is_further = self.distances[one as usize] > self.distances[other as usize]
                    || self.distances[one as usize] == self.distances[other as usize] && one < other;
                let (tip, lesser) = if is_further { (one, other) } else { (other, one) };
                let stands_out = self.distances[lesser as usize] - distance >= least
                    && self.distances[lesser as usize] >= LEAST_REACH * self.length
                    && distance >= LEAST_WEB * self.length;
                if stands_out {
                    webs.entry(lesser).or_insert(distance);
                    webs.entry(tip).or_insert(distance);
                    fingers.push(lesser);
                }
                parents[lesser as usize] = tip;
            }
        }
        if let Some(&furthest) = order.first() {
            fingers.push(furthest);
        }
        let mut fingers: Vec<Finger> = fingers
            .into_iter()
            .map(|tip| {
                let web_distance = webs.get(&tip).copied().unwrap_or(0.0);
                Finger { tip, tip_distance: self.distances[tip as usize], web_distance }
            })
            .collect();
        fingers.sort_by(|a, b| b.tip_distance.total_cmp(&a.tip_distance).then(a.tip.cmp(&b.tip)));
        fingers
    }

    /// The middle of a finger's sections, from its web to its tip.
    fn path(&self, finger: &Finger) -> Vec<DVec3> {
        // The vertices of the finger alone.
        let mut is_own = vec![false; self.points.len()];
        is_own[finger.tip as usize] = true;
        let mut stack = vec![finger.tip];
        while let Some(vertex) = stack.pop() {
            for &next in &self.graph[vertex as usize] {
                if !is_own[next as usize] && self.distances[next as usize] > finger.web_distance {
                    is_own[next as usize] = true;
                    stack.push(next);
                }
            }
        }
        let own: Vec<[u32; 3]> = self
            .triangles
            .iter()
            .filter(|corners| corners.iter().any(|&v| is_own[v as usize]))
            .copied()
            .collect();
        let mut path = Vec::new();
        let free = finger.tip_distance - finger.web_distance;
        for step in 0..SECTION_COUNT {
            let level = finger.web_distance + free * (step as f64 + 0.5) / SECTION_COUNT as f64;
            let (mut sum, mut weight) = (DVec3::ZERO, 0.0);
            for corners in &own {
                let mut ends = [DVec3::ZERO; 2];
                let mut count = 0;
                for edge in 0..3 {
                    let [a, b] = [corners[edge], corners[(edge + 1) % 3]].map(|v| v as usize);
                    let (low, high) = (self.distances[a], self.distances[b]);
                    if (low > level) == (high > level) || !low.is_finite() || !high.is_finite() {
                        continue;
                    }
                    // What is above the level must be the finger's.
                    if !is_own[if low > level { a } else { b }] {
                        continue;
                    }
                    ends[count.min(1)] = self.points[a].lerp(self.points[b], (level - low) / (high - low));
                    count += 1;
                }
                if count >= 2 {
                    let length = ends[0].distance(ends[1]);
                    sum += length * (ends[0] + ends[1]) / 2.0;
                    weight += length;
                }
            }
            if weight > 0.0 {
                path.push(sum / weight);
            }
        }
        path.push(self.points[finger.tip as usize]);
        path
    }

    /// The outer part of the line from the wrist to the end of the hand. A blunt end has many tips, of which rounding
    /// would choose one: its middle is the end.
    fn mitten(&self) -> Vec<DVec3> {
        let out = |p: &DVec3| (*p - self.wrist).dot(self.along);
        let furthest = self.points.iter().map(out).fold(0.0, f64::max);
        let ends: Vec<DVec3> =
            self.points.iter().filter(|p| out(p) >= (1.0 - BLUNT) * furthest).copied().collect();
        let end = ends.iter().sum::<DVec3>() / ends.len().max(1) as f64;
        (0..=SECTION_COUNT)
            .map(|step| {
                let part = (step as f64 + 0.5).min(SECTION_COUNT as f64) / SECTION_COUNT as f64;
                self.wrist.lerp(end, MITTEN_KNUCKLES + (1.0 - MITTEN_KNUCKLES) * part)
            })
            .collect()
    }

    /// True where a tip lies within the rest of the hand, as the end of a forearm does in a hand that is a body of its
    /// own: rays from just beyond it, ahead and all around, meet the surface.
    fn is_buried(&self, surface: &Surface, finger: &Finger) -> bool {
        let path = self.path(finger);
        let tip = self.points[finger.tip as usize];
        let Some(way) = path.iter().rev().find_map(|&p| (tip - p).try_normalize()) else { return false };
        let beyond = tip + BEYOND_TIP * self.length * way;
        let reach = 3.0 * self.wrist_radius;
        surface.first_hit(beyond, way, self.length).is_some() && enclosed(surface, beyond, way, reach) >= 1.0
    }

    /// Fingers, which of them is the thumb, and joints (of the left hand).
    fn hand(&self, surface: &Surface, mut fingers: Vec<Finger>) -> Hand {
        let mut hand = Hand { finger_count: fingers.len(), ..Hand::default() };
        // Of more than five the freest.
        let free = |finger: &Finger| finger.tip_distance - finger.web_distance;
        fingers.sort_by(|a, b| free(b).total_cmp(&free(a)).then(a.tip.cmp(&b.tip)));
        fingers.truncate(5);
        let mut chains: Vec<(Finger, Vec<DVec3>)> = fingers
            .into_iter()
            .map(|finger| {
                let path = self.path(&finger);
                (finger, path)
            })
            .collect();
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
                    _ if is_mitten => 0.5,
                    0 if kept => 0.7,
                    0 => 0.5,
                    _ => 0.9,
                };
                let within = enclosed(surface, position, ways[number], 3.0 * self.wrist_radius);
                hand.joints.insert(role, FoundJoint { position, confidence: sure * seen * within });
            }
            hand.tips.insert(LEFT_FINGERS[role][2], path[path.len() - 1]);
        }
        hand
    }

    /// Puts fingers in order from the thumb's side; true where the first of them is a thumb.
    fn order(&self, chains: &mut Vec<(Finger, Vec<DVec3>)>) -> bool {
        if chains.len() < 2 {
            return false;
        }
        // A thumb begins and ends nearer to the wrist than the others and points another way. All fingers in one begin
        // in the middle of the palm.
        let way =
            |chain: &(Finger, Vec<DVec3>)| (chain.1[chain.1.len() - 1] - chain.1[0]).normalize_or_zero();
        let near = |chain: &(Finger, Vec<DVec3>), mitten: bool| {
            let root = if mitten { 0.0 } else { chain.1[0].distance(self.wrist) };
            (root + chain.1[chain.1.len() - 1].distance(self.wrist)) / self.length
        };
        let mitten = chains.len() == 2;
        let mut thumb = (0, f64::NEG_INFINITY);
        for (index, chain) in chains.iter().enumerate() {
            let others =
                || chains.iter().enumerate().filter(|&(other, _)| other != index).map(|(_, other)| other);
            let mean_way = others().map(way).sum::<DVec3>().normalize_or_zero();
            let mean_near =
                others().map(|other| near(other, mitten)).sum::<f64>() / (chains.len() - 1) as f64;
            let unlike = 1.0 - way(chain).dot(mean_way) + mean_near - near(chain, mitten);
            if unlike > thumb.1 {
                thumb = (index, unlike);
            }
        }
        let thumb = (thumb.1 > LEAST_THUMB).then(|| chains.remove(thumb.0));
        // Where the others stand side by side, a little way out.
        let middle = |chain: &(Finger, Vec<DVec3>)| (chain.1[0] + chain.1[chain.1.len() / 2]) / 2.0;
        let centre = chains.iter().map(middle).sum::<DVec3>() / chains.len() as f64;
        let ahead = (centre - self.wrist).try_normalize().unwrap_or(self.along);
        let aside = |chain: &(Finger, Vec<DVec3>)| (middle(chain) - centre).reject_from_normalized(ahead);
        let furthest = chains.iter().map(aside).fold(DVec3::ZERO, |one, other| {
            if other.length_squared() > one.length_squared() { other } else { one }
        });
        let mut across = furthest.normalize_or_zero();
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
        let key = |chain: &(Finger, Vec<DVec3>)| aside(chain).dot(across);
        chains.sort_by(|a, b| key(a).total_cmp(&key(b)).then(a.0.tip.cmp(&b.0.tip)));
        let has_thumb = thumb.is_some();
        chains.splice(0..0, thumb);
        has_thumb
    }

    /// Three joints of a finger whose sections' middles are `path`, by their distances from the tip in lengths of the
    /// free finger; and whether the first is where these say.
    fn joints(&self, path: &[DVec3], shares: [f64; 3], thumb: bool) -> ([DVec3; 3], bool) {
        let tip = path[path.len() - 1];
        // Straight on from the finger's lower half, with a bend towards the wrist, where all bones of the hand begin.
        let straight = (path[path.len() / 2] - path[0]).normalize_or(self.along);
        let from_wrist = (path[0] - self.wrist).normalize_or_zero();
        let way = (straight + WRIST_BEND * from_wrist).normalize_or(straight);
        let mut free = 0.0;
        for pair in path.windows(2) {
            free += pair[0].distance(pair[1]);
        }
        // The first section is half a step from the web.
        free *= SECTION_COUNT as f64 / (SECTION_COUNT as f64 - 0.5);
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
        // The knuckle lies where knuckles do, even if the fingers are cut too deep or not deep enough.
        let [least, most] = if thumb { [0.15, 0.5] } else { [0.4, 0.66] };
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

/// Joints of a finger from its tip, in lengths of its free part: the knuckle lies a quarter of that inside the palm, the
/// others at 45 % and 72 % of the way from there.
const FINGER_JOINTS: [f64; 3] = [1.25, 0.55 * 1.25, 0.28 * 1.25];

/// Joints of a thumb from its tip, in lengths of its free part: a thumb's web reaches up to its last bone but one.
const THUMB_JOINTS: [f64; 3] = [2.2, 1.55, 0.75];

/// Joints of a mitten from its tip.
const MITTEN_JOINTS: [f64; 3] = [1.0, 0.55, 0.28];

/// How much the way to the wrist counts beside the finger's own for what lies inside the palm.
const WRIST_BEND: f64 = 0.5;

/// Where the knuckles are between wrist and tips.
const MITTEN_KNUCKLES: f64 = 0.5;

/// What reaches as far along the forearm as the furthest point, to within this share, is the end of a mitten.
const BLUNT: f64 = 0.05;

/// Just beyond a tip, as a share of the hand's length.
const BEYOND_TIP: f64 = 0.02;

/// A finger less unlike the others than this is no thumb.
const LEAST_THUMB: f64 = 0.12;

/// Sections of a finger.
const SECTION_COUNT: usize = 8;

/// The share of the rays across `way` that meet the surface within `reach`: 1 inside a finger.
fn enclosed(surface: &Surface, at: DVec3, way: DVec3, reach: f64) -> f64 {
    let Some(way) = way.try_normalize() else { return 0.0 };
    // Y or Z, so that the other hand has the same rays.
    let axis = if way.y.abs() < 0.8 { DVec3::Y } else { DVec3::Z };
    let one = axis.reject_from_normalized(way).normalize();
    let other = way.cross(one);
    let met = (0..RAY_COUNT).filter(|&ray| {
        let (sin, cos) = (TAU * ray as f64 / RAY_COUNT as f64).sin_cos();
        surface.first_hit(at, cos * one + sin * other, reach).is_some()
    });
    met.count() as f64 / RAY_COUNT as f64
}

/// Rays around a joint.
const RAY_COUNT: usize = 12;

/// What a plane through the wrist cuts.
struct Section {
    centre: DVec3,
    radius: f64,
    /// Vertices ahead of the plane whose edges it cuts.
    ahead: Vec<u32>,
}

/// An outline in the plane.
#[derive(Clone, Copy)]
struct Outline {
    sum: DVec3,
    length: f64,
    distance: f64,
}

impl Outline {
    fn centre(&self) -> DVec3 {
        self.sum / self.length
    }

    fn radius(&self) -> f64 {
        self.length / TAU
    }
}

impl Section {
    /// The section of the mesh across `along` that is nearest to `at`, within `reach`, with what it lies in or around:
    /// an arm in its sleeve, a ball in its socket.
    fn new(positions: &[DVec3], triangles: &[[u32; 3]], at: DVec3, along: DVec3, reach: f64) -> Option<Self> {
        let height = |vertex: u32| (positions[vertex as usize] - at).dot(along);
        // Each triangle's part of the section.
        let mut pieces: Vec<[DVec3; 2]> = Vec::new();
        let mut cut: Vec<[u32; 3]> = Vec::new();
        for &corners in triangles {
            let heights = corners.map(height);
            let above = heights.map(|height| height > 0.0);
            let Some(lone) =
                (0..3).find(|&c| above[c] != above[(c + 1) % 3] && above[c] != above[(c + 2) % 3])
            else {
                continue;
            };
            let ends = [1, 2].map(|step| {
                let other = (lone + step) % 3;
                let share = heights[lone] / (heights[lone] - heights[other]);
                positions[corners[lone] as usize].lerp(positions[corners[other] as usize], share)
            });
            if ends[0].distance_squared(at) <= reach * reach {
                pieces.push(ends);
                cut.push(corners);
            }
        }
        // Ends of neighbours lie on one edge.
        let weld = weld(pieces.as_flattened(), SEAM);
        let lines: Vec<[u32; 3]> =
            (0..pieces.len() as u32).map(|piece| [2 * piece, 2 * piece + 1, 2 * piece]).collect();
        let outline_of_end = components(&lines, &weld);
        let outline_of: Vec<u32> =
            (0..pieces.len()).map(|piece| outline_of_end[weld.representative[2 * piece] as usize]).collect();
        let mut outlines: BTreeMap<u32, Outline> = BTreeMap::new();
        for (&[a, b], &outline) in pieces.iter().zip(&outline_of) {
            let none = Outline { sum: DVec3::ZERO, length: 0.0, distance: f64::INFINITY };
            let outline = outlines.entry(outline).or_insert(none);
            outline.sum += a.distance(b) * (a + b) / 2.0;
            outline.length += a.distance(b);
            outline.distance = outline.distance.min(a.distance(at)).min(b.distance(at));
        }
        // Slivers of folds and bolts say nothing beside what goes round the wrist.
        let around = outlines
            .values()
            .filter(|outline| outline.length > 0.0 && outline.centre().distance(at) < outline.radius())
            .map(Outline::radius)
            .fold(0.0, f64::max);
        outlines.retain(|_, outline| outline.length > 0.0 && outline.radius() >= SLIVER * around);
        let nearest = outlines
            .values()
            .copied()
            .reduce(|one, other| if other.distance < one.distance { other } else { one })?;
        outlines.retain(|_, outline| {
            let apart = outline.centre().distance(nearest.centre());
            apart < 0.7 * outline.radius().max(nearest.radius())
        });
        let radius = outlines.values().map(Outline::radius).fold(0.0, f64::max);
        let length: f64 = outlines.values().map(|outline| outline.length).sum();
        let centre = outlines.values().map(|outline| outline.sum).sum::<DVec3>() / length;
        let chosen = cut.iter().zip(&outline_of).filter(|(_, outline)| outlines.contains_key(outline));
        let ahead =
            chosen.flat_map(|(corners, _)| corners).copied().filter(|&vertex| height(vertex) > 0.0).collect();
        Some(Self { centre, radius, ahead })
    }
}
