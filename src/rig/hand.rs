//! Fingers by ray casting.

use super::FoundJoint;
use crate::character::Role;
use crate::geometry::{Surface, components, neighbours, weld};
use glam::DVec3;
use std::cmp::Reverse;
use std::collections::{BTreeMap, BinaryHeap};

/// The fingers of one hand.
#[derive(Clone, Debug, Default)]
pub struct Hand {
    /// Joints by role, three a finger (left or right roles as asked for); a mitten has one chain, the middle finger's.
    pub joints: BTreeMap<Role, FoundJoint>,
    /// Where each finger ends, by the role of its distal joint.
    pub tips: BTreeMap<Role, DVec3>,
    /// How many fingers the hand shows, the thumb among them; 1 for a mitten or a fist, 0 where there is no hand.
    pub finger_count: usize,
}

/// The roles of each finger of the left hand, thumb first.
const FINGERS: [[Role; 3]; 5] = [
    [Role::LeftThumbMetacarpal, Role::LeftThumbProximal, Role::LeftThumbDistal],
    [Role::LeftIndexProximal, Role::LeftIndexIntermediate, Role::LeftIndexDistal],
    [Role::LeftMiddleProximal, Role::LeftMiddleIntermediate, Role::LeftMiddleDistal],
    [Role::LeftRingProximal, Role::LeftRingIntermediate, Role::LeftRingDistal],
    [Role::LeftLittleProximal, Role::LeftLittleIntermediate, Role::LeftLittleDistal],
];

/// Finds the fingers of the hand at `wrist`.
///
/// - `surface`: what the rays meet, layout space.
/// - `elbow`, `wrist`: joints of the arm, layout space.
/// - `left`: which side's roles to give.
pub fn find_fingers(
    surface: &Surface,
    positions: &[DVec3],
    triangles: &[[u32; 3]],
    elbow: DVec3,
    wrist: DVec3,
    left: bool,
) -> Hand {
    let Some(region) = Region::new(surface, positions, triangles, elbow, wrist) else {
        return Hand::default();
    };
    let fingers = region.fingers();
    if std::env::var_os("HAND_DEBUG").is_some() {
        println!("  {} vertices, length {:.3}, wrist radius {:.4}", region.points.len(), region.length, region.wrist_radius);
        for finger in &fingers {
            println!("    tip {:.3} web {:.3} share {:.2}", finger.tip_distance, finger.web_distance, (finger.tip_distance - finger.web_distance) / region.length);
        }
    }
    let mut hand = region.hand(fingers);
    if !left {
        hand.joints = std::mem::take(&mut hand.joints).into_iter().map(|(role, joint)| (role.mirrored(), joint)).collect();
        hand.tips = std::mem::take(&mut hand.tips).into_iter().map(|(role, tip)| (role.mirrored(), tip)).collect();
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
    web: u32,
}

/// A tip stands out by this share of the hand's length, at least ...
const LEAST_PERSISTENCE: f64 = 0.1;

/// ... and is this far from the wrist: cuffs are nearer.
const LEAST_REACH: f64 = 0.45;

impl Region {
    fn new(
        surface: &Surface,
        positions: &[DVec3],
        triangles: &[[u32; 3]],
        elbow: DVec3,
        wrist: DVec3,
    ) -> Option<Self> {
        let along = (wrist - elbow).try_normalize()?;
        let forearm = wrist.distance(elbow);
        let reach = (1.5 * forearm).clamp(0.12, 0.3);
        let wrist_radius = radius_at(surface, wrist, along).unwrap_or(0.2 * forearm).min(0.5 * forearm);
        // Rows of vertices may lie a little before the wrist.
        let start = -0.5 * wrist_radius;
        let is_near = |p: DVec3| {
            let from = p - wrist;
            from.dot(along) >= start && from.length_squared() <= reach * reach
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
        let weld = weld(&points, 1e-6);
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
        let mut region =
            Self { points, triangles, graph, distances: Vec::new(), length: 0.0, wrist, along, wrist_radius };
        region.bridge(&pieces, reach);
        region.measure();
        (region.length > 0.5 * wrist_radius).then_some(region)
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
            if vertices.iter().any(|&vertex| self.is_start(vertex)) {
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

    /// Whether a vertex is one of the wrist's.
    fn is_start(&self, vertex: u32) -> bool {
        let from = self.points[vertex as usize] - self.wrist;
        let ahead = from.dot(self.along);
        ahead <= 0.5 * self.wrist_radius && (from - ahead * self.along).length() <= 2.5 * self.wrist_radius
    }

    /// Distances from the wrist along edges.
    fn measure(&mut self) {
        self.distances = vec![f64::INFINITY; self.points.len()];
        let mut queue = BinaryHeap::new();
        for vertex in 0..self.points.len() as u32 {
            if self.is_start(vertex) {
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
                let further =
                    distance + self.points[vertex as usize].distance(self.points[next as usize]);
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
        let mut webs: BTreeMap<u32, (f64, u32)> = BTreeMap::new();
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
                    && self.distances[lesser as usize] >= LEAST_REACH * self.length;
                if stands_out {
                    webs.entry(lesser).or_insert((distance, vertex));
                    webs.entry(tip).or_insert((distance, vertex));
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
                let (web_distance, web) = webs.get(&tip).copied().unwrap_or((0.0, tip));
                Finger { tip, tip_distance: self.distances[tip as usize], web_distance, web }
            })
            .collect();
        fingers.sort_by(|a, b| b.tip_distance.total_cmp(&a.tip_distance).then(a.tip.cmp(&b.tip)));
        fingers
    }

    fn hand(&self, fingers: Vec<Finger>) -> Hand {
        let mut hand = Hand { finger_count: fingers.len(), ..Hand::default() };
        for (finger, roles) in fingers.iter().zip(FINGERS) {
            hand.tips.insert(roles[2], self.points[finger.tip as usize]);
        }
        hand
    }
}

/// The mean distance from `at` to the surface in the plane across `along`; `None` where fewer than half the rays meet it.
fn radius_at(surface: &Surface, at: DVec3, along: DVec3) -> Option<f64> {
    let one = along.any_orthonormal_vector();
    let other = along.cross(one);
    let hits: Vec<f64> = (0..12)
        .filter_map(|ray| {
            let (sin, cos) = (std::f64::consts::TAU * ray as f64 / 12.0).sin_cos();
            Some(surface.first_hit(at, cos * one + sin * other, f64::INFINITY)?.t)
        })
        .collect();
    let mut sorted = hits;
    sorted.sort_by(f64::total_cmp);
    (sorted.len() >= 6).then(|| sorted[sorted.len() / 2])
}
