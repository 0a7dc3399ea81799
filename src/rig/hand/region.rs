//! The mesh beyond the wrist, and the fingers that stand out of it: the merge tree of distances from the wrist.

use super::section::Section;
use crate::geometry::{
    NONE, PointTree, SEAM, by_key, components, least_costs, marked, merge_tree, neighbours, weld,
};
use glam::DVec3;
use std::collections::BTreeMap;

/// The mesh beyond the wrist.
pub(super) struct Region {
    /// Welded vertices.
    pub(super) points: Vec<DVec3>,
    pub(super) triangles: Vec<[u32; 3]>,
    /// Edges, and the shortest bridges between pieces.
    pub(super) graph: Vec<Vec<u32>>,
    /// Whether an edge from here crosses the wrist.
    pub(super) is_start: Vec<bool>,
    /// Distance from the wrist along the graph; infinite where it does not lead.
    pub(super) distances: Vec<f64>,
    /// The greatest of them.
    pub(super) length: f64,
    pub(super) wrist: DVec3,
    /// The way the forearm points.
    pub(super) along: DVec3,
    pub(super) wrist_radius: f64,
}

/// A finger: the part of the hand around a tip that hangs on the rest by its root alone.
#[derive(Clone, Copy, Debug)]
pub(super) struct Finger {
    pub(super) tip: u32,
    pub(super) tip_distance: f64,
    /// Where it meets its neighbour, as a distance from the wrist.
    pub(super) web_distance: f64,
}

/// A tip stands out by this share of the hand's length, at least. Seen: at ±30 %, two fewer of 46 hands with all fingers.
pub(super) const LEAST_PERSISTENCE: f64 = 0.1;

/// A hand is looked for within this many lengths of the forearm. Seen: ±30 % changes no finger.
const REACH: f64 = 1.5;

/// A hand is looked for within no less and no more than this, in heights, whatever the forearm's length: sleeves hide
/// elbows. Seen: ±30 % changes no finger.
const REACH_RANGE: (f64, f64) = (0.12, 0.3);

/// What ends within this share of that reach does not go on outside: it belongs to the hand. Seen: at -30 %, two fewer
/// of 46 hands with all fingers.
const ENDS_WITHIN: f64 = 0.95;

/// Fingers part further from the wrist than this share of the hand's length: what parts nearer is worn on the wrist.
/// Seen: at -30 %, one fewer of 46 hands with all fingers.
const LEAST_WEB: f64 = 0.12;

/// Where the knuckles are between wrist and tips. Seen: at -30 %, joints move up to 0.017 H (middle proximal); at
/// +30 %, joints move up to 0.026 H (middle proximal).
pub(super) const MITTEN_KNUCKLES: f64 = 0.5;

/// What reaches as far along the forearm as the furthest point, to within this share, is the end of a mitten. Seen: at
/// -30 %, joints move up to 0.008 H (middle distal); at +30 %, joints move up to 0.011 H (middle distal).
const BLUNT: f64 = 0.05;

/// Sections of a finger. Seen: ±30 % moves finger joints by under 0.0005 H.
pub(super) const SECTION_COUNT: usize = 8;

impl Region {
    pub(super) fn new(
        positions: &[DVec3],
        triangles: &[[u32; 3]],
        elbow: DVec3,
        wrist: DVec3,
    ) -> Option<Self> {
        let along = (wrist - elbow).try_normalize()?;
        let forearm = wrist.distance(elbow);
        let reach = (REACH * forearm).clamp(REACH_RANGE.0, REACH_RANGE.1);
        let section = Section::new(positions, triangles, wrist, along, reach)?;
        let is_near = |p: DVec3| {
            // The section's middle lies in the plane through the wrist, which parts what is cut from what is not.
            (p - wrist).dot(along) > 0.0 && p.distance_squared(section.centre) <= reach * reach
        };
        let mut index = vec![NONE; positions.len()];
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
            .filter(|corners| !corners.contains(&NONE))
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
        let starts =
            section.ahead.into_iter().map(|vertex| index[vertex as usize]).filter(|&near| near != NONE);
        let is_start = marked(points.len(), starts.map(|near| weld.representative[near as usize] as usize));
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
        region.distances = region.measured();
        region.length = region.distances.iter().copied().filter(|d| d.is_finite()).fold(0.0, f64::max);
        (region.length > 0.5 * region.wrist_radius).then_some(region)
    }

    /// Joins pieces that do not begin at the wrist to what does, each where it is nearest.
    fn bridge(&mut self, pieces: &[u32], reach: f64) {
        let members = by_key(pieces.iter().copied().zip(0u32..));
        let at = |vertex: u32| self.points[vertex as usize];
        let ends = |&vertex: &u32| at(vertex).distance(self.wrist) < ENDS_WITHIN * reach;
        // Pieces that go on outside are something else: a leg, the ground.
        let mut waiting: Vec<Vec<u32>> = Vec::new();
        let mut joined: Vec<u32> = Vec::new();
        for vertices in members.into_values() {
            if vertices.iter().any(|&vertex| self.is_start[vertex as usize]) {
                joined.extend(vertices);
            } else if vertices.len() > 3 && vertices.iter().all(ends) {
                waiting.push(vertices);
            }
        }
        while !waiting.is_empty() && !joined.is_empty() {
            let tree = PointTree::new(&joined.iter().map(|&vertex| at(vertex)).collect::<Vec<_>>());
            let mut best: Option<(f64, usize, u32, u32)> = None;
            let mut found = Vec::new();
            for (slot, vertices) in waiting.iter().enumerate() {
                for &vertex in vertices {
                    let limit = best.map_or(self.wrist_radius, |best| best.0);
                    tree.nearest(at(vertex), 1, limit, &mut found);
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
            joined.extend(waiting.remove(slot));
        }
    }

    /// Distances from the wrist along edges.
    fn measured(&self) -> Vec<f64> {
        let ahead = |v: u32| (v, (self.points[v as usize] - self.wrist).dot(self.along).max(0.0));
        let starts = (0..self.points.len() as u32).filter(|&v| self.is_start[v as usize]).map(ahead);
        let beside = |at: u32| {
            let here = self.points[at as usize];
            let way = move |&next: &u32| (next, here.distance(self.points[next as usize]));
            self.graph[at as usize].iter().map(way)
        };
        least_costs(self.points.len(), starts, beside)
    }

    /// Tips that stand out, furthest first: the merge tree of the distances, swept from the far end.
    pub(super) fn fingers(&self) -> Vec<Finger> {
        let mut order: Vec<u32> =
            (0..self.points.len() as u32).filter(|&v| self.distances[v as usize].is_finite()).collect();
        order.sort_by(|&a, &b| {
            self.distances[b as usize].total_cmp(&self.distances[a as usize]).then(a.cmp(&b))
        });
        let mut webs: BTreeMap<u32, f64> = BTreeMap::new();
        let mut fingers = Vec::new();
        let least = LEAST_PERSISTENCE * self.length;
        let beside = |vertex: u32| self.graph[vertex as usize].iter().copied();
        merge_tree(self.points.len(), &order, beside, |tip, lesser, at| {
            let (distance, reach) = (self.distances[at as usize], self.distances[lesser as usize]);
            let stands_out = reach - distance >= least && distance >= LEAST_WEB * self.length;
            if stands_out {
                webs.entry(lesser).or_insert(distance);
                webs.entry(tip).or_insert(distance);
                fingers.push(lesser);
            }
        });
        fingers.extend(order.first());
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
    pub(super) fn path(&self, finger: &Finger) -> Vec<DVec3> {
        // The vertices of the finger alone: where ways lead from its tip that do not pass its web.
        let further = |at: u32| {
            let beside = self.graph[at as usize].iter().map(|&next| (next, 0.0));
            beside.filter(|&(next, _)| self.distances[next as usize] > finger.web_distance)
        };
        let ways = least_costs(self.points.len(), std::iter::once((finger.tip, 0.0)), further);
        let is_own = |vertex: usize| ways[vertex].is_finite();
        let own: Vec<[u32; 3]> = self
            .triangles
            .iter()
            .filter(|corners| corners.iter().any(|&v| is_own(v as usize)))
            .copied()
            .collect();
        let mut path = Vec::new();
        let free = finger.tip_distance - finger.web_distance;
        for step in 0..SECTION_COUNT {
            let level = finger.web_distance + free * (step as f64 + 0.5) / SECTION_COUNT as f64;
            let (mut sum, mut weight) = (DVec3::ZERO, 0.0);
            for corners in &own {
                let cut = |edge: usize| {
                    let [a, b] = [corners[edge], corners[(edge + 1) % 3]].map(|v| v as usize);
                    let (low, high) = (self.distances[a], self.distances[b]);
                    let is_cut = (low > level) != (high > level) && low.is_finite() && high.is_finite();
                    // What is above the level must be the finger's.
                    (is_cut && is_own(if low > level { a } else { b }))
                        .then(|| self.points[a].lerp(self.points[b], (level - low) / (high - low)))
                };
                let mut ends = (0..3).filter_map(cut);
                if let (Some(one), Some(other)) = (ends.next(), ends.next()) {
                    let length = one.distance(other);
                    sum += length * (one + other) / 2.0;
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
    pub(super) fn mitten(&self) -> Vec<DVec3> {
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
}
