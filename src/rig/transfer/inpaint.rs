//! Rows of a cloth's vertices filled in smoothly between those that are kept.

use super::{Row, normalised};
use crate::geometry::laplacian::{COLUMNS, Cholesky, cotangent_laplacian};
use crate::geometry::{NONE, Neighbours, ROUNDING, Weld, by_key, neighbours, slots};
use crate::parallel;
use glam::DVec3;

/// Least weight of an edge with two triangles and greatest weight of any, beside the cotangents': no edge is cut, none
/// swallows the rest. Seen: ±30 % moves no vertex.
const EDGE_RANGE: [f64; 2] = [1e-2, 1e4];

/// Smoothing around the filled region takes so many steps (Abdrashitov et al.). Seen: ±30 % moves vertices by under 0.0005 H.
const SMOOTHING_STEPS: usize = 10;
/// In each step of smoothing, a vertex takes this share of its neighbours' mean (Abdrashitov et al.). Seen: ±30 % moves
/// vertices by under 0.0005 H.
const SMOOTHING_SHARE: f64 = 0.2;
/// Smoothing reaches so many rings of vertices beyond the filled region. Seen: at -30 %, vertices move up to 0.006 H.
const SMOOTHING_RINGS: usize = 2;

/// How much the two ends of each edge pull at each other, above 0.
pub(super) struct EdgeWeights {
    /// Which vertices have edges to which.
    around: Neighbours,
    /// In the order of the neighbours.
    edges: Vec<f64>,
    /// By vertex, the sum over its edges.
    pub(super) sums: Vec<f64>,
    /// A third of the area of each vertex's triangles.
    pub(super) areas: Vec<f64>,
}

impl EdgeWeights {
    /// Cotangents, kept above 0 (obtuse triangles) and away from infinity (slivers), so that the fill stays between the
    /// values around it and edges of triangles without area still join their ends.
    pub(super) fn new(points: &[DVec3], triangles: &[[u32; 3]], alone: &Weld) -> Self {
        let around = neighbours(triangles, alone);
        let laplacian = cotangent_laplacian(points, triangles);
        let [least, most] = EDGE_RANGE;
        let place = |vertex: u32, other: u32| {
            let found = around.of(vertex as usize).binary_search(&other).ok();
            found.map(|place| around.range(vertex as usize).start + place)
        };
        let mut edges = vec![0.0f64; around.things.len()];
        for &[a, b, c] in triangles {
            for (one, two) in [(a, b), (b, c), (c, a)] {
                for place in [place(one, two), place(two, one)].into_iter().flatten() {
                    edges[place] += least / 2.0;
                }
            }
        }
        for &(one, two, value) in &laplacian.off_diagonal {
            for place in [place(one, two), place(two, one)].into_iter().flatten() {
                // max passes over what is no number.
                edges[place] = edges[place].max((-value).min(most));
            }
        }
        let sums = (0..around.count()).map(|vertex| edges[around.range(vertex)].iter().sum()).collect();
        let mut areas = laplacian.areas;
        areas.iter_mut().filter(|area| !area.is_finite()).for_each(|area| *area = 0.0);
        Self { around, edges, sums, areas }
    }

    /// True of a vertex in no triangle.
    pub(super) fn is_loose(&self, vertex: usize) -> bool {
        self.around.of(vertex).is_empty()
    }

    /// The neighbours of a vertex with the weights of the edges to them.
    fn of(&self, vertex: usize) -> impl Iterator<Item = (u32, f64)> + '_ {
        let edges = &self.edges[self.around.range(vertex)];
        self.around.of(vertex).iter().copied().zip(edges.iter().copied())
    }
}

/// The system of vertices that are filled in together.
pub(super) struct Fill {
    /// How much each vertex is held to the row of its match, 0 to 1; `None` where it is not asked about.
    pub(super) pulls: Vec<Option<f64>>,
    /// The vertices that are solved for.
    free: Vec<u32>,
    /// Each vertex's place among those that are solved for, or `NONE`.
    slots: Vec<u32>,
    /// `None` where there is nothing to do or the system cannot be solved.
    pub(super) factor: Option<Cholesky>,
}

impl Fill {
    /// That of vertices with these `pulls`.
    pub(super) fn new(weights: &EdgeWeights, pulls: Vec<Option<f64>>) -> Self {
        let free: Vec<u32> =
            (0..pulls.len()).filter(|&vertex| is_free(pulls[vertex])).map(|vertex| vertex as u32).collect();
        let slots = slots(pulls.len(), &free);
        let mut diagonal = Vec::with_capacity(free.len());
        let mut lower = Vec::new();
        for (slot, &vertex) in free.iter().enumerate() {
            let vertex = vertex as usize;
            diagonal.push(weights.sums[vertex] + pull_weight(&pulls, weights, vertex));
            for (other, weight) in weights.of(vertex) {
                let other = slots[other as usize];
                if other < slot as u32 {
                    lower.push((slot as u32, other, -weight));
                }
            }
        }
        let factor = if free.is_empty() { None } else { Cholesky::new(&diagonal, &lower) };
        Self { pulls, free, slots, factor }
    }

    /// Gives new rows to all vertices that have a pull and to a few around them; `rows` are those of their matches.
    ///
    /// A vertex of pull 1 keeps the row of its match, one of pull 0 is the mean of its neighbours, one in between a blend
    /// of both; then all is smoothed a little.
    ///
    /// - `weights`: what it was made of.
    pub(super) fn fill_in(&self, weights: &EdgeWeights, rows: &mut [Row], threads: usize) {
        let Some(factor) = &self.factor else { return };
        // The matches' weights by joint.
        let matched = (0u32..).zip(&*rows).filter(|&(vertex, _)| self.pulls[vertex as usize].is_some());
        let entries = matched
            .flat_map(|(vertex, row)| row.iter().map(move |&(joint, weight)| (joint, (vertex, weight))));
        let columns: Vec<(u32, Vec<(u32, f64)>)> = by_key(entries).into_iter().collect();
        let region = self.region(&weights.around);
        let batches: Vec<_> = columns.chunks(COLUMNS).collect();
        let solved = parallel::collect(threads, batches.len(), 1, |batch| {
            self.solve(factor, weights, batches[batch], &region)
        });
        let solved: Vec<Vec<f64>> = solved.into_iter().flatten().collect();
        for (slot, &vertex) in region.iter().enumerate() {
            let entries = columns.iter().zip(&solved).map(|((joint, _), values)| (*joint, values[slot]));
            let row = normalised(entries.filter(|&(_, weight)| weight >= ROUNDING).collect());
            if !row.is_empty() {
                rows[vertex as usize] = row;
            }
        }
    }

    /// For each joint of a batch the weights of the vertices of `region`, from those of the matches.
    fn solve(
        &self,
        factor: &Cholesky,
        weights: &EdgeWeights,
        batch: &[(u32, Vec<(u32, f64)>)],
        region: &[u32],
    ) -> Vec<Vec<f64>> {
        let size = self.free.len();
        let mut sides = vec![0.0; size * batch.len()];
        for ((_, column), side) in batch.iter().zip(sides.chunks_mut(size)) {
            self.add_known(weights, column, side);
        }
        factor.solve(&mut sides, batch.len());
        let mut values = vec![0.0; self.slots.len()];
        let mut next = vec![0.0; region.len()];
        let mut solved = Vec::with_capacity(batch.len());
        for ((_, column), side) in batch.iter().zip(sides.chunks(size)) {
            values.fill(0.0);
            for &(vertex, weight) in column {
                values[vertex as usize] = weight;
            }
            for (&vertex, &value) in self.free.iter().zip(side) {
                values[vertex as usize] = value;
            }
            for _ in 0..SMOOTHING_STEPS {
                for (&vertex, next) in region.iter().zip(&mut next) {
                    let around = weights.around.of(vertex as usize);
                    let sum: f64 = around.iter().map(|&other| values[other as usize]).sum();
                    let mean = sum / around.len().max(1) as f64;
                    *next = (1.0 - SMOOTHING_SHARE) * values[vertex as usize] + SMOOTHING_SHARE * mean;
                }
                for (&vertex, &next) in region.iter().zip(&next) {
                    values[vertex as usize] = next;
                }
            }
            solved.push(region.iter().map(|&vertex| values[vertex as usize]).collect());
        }
        solved
    }

    /// Adds what the known weights of one joint say to the right-hand side.
    fn add_known(&self, weights: &EdgeWeights, column: &[(u32, f64)], side: &mut [f64]) {
        for &(vertex, weight) in column {
            let vertex = vertex as usize;
            if self.slots[vertex] != NONE {
                side[self.slots[vertex] as usize] += pull_weight(&self.pulls, weights, vertex) * weight;
                continue;
            }
            for (other, edge) in weights.of(vertex) {
                let slot = self.slots[other as usize];
                if slot != NONE {
                    side[slot as usize] += edge * weight;
                }
            }
        }
    }

    /// What is smoothed: the free vertices and a few rings.
    fn region(&self, around: &Neighbours) -> Vec<u32> {
        let mut smoothed: Vec<bool> = self.slots.iter().map(|&slot| slot != NONE).collect();
        for _ in 0..SMOOTHING_RINGS {
            let is_near = |&vertex: &u32| smoothed[vertex as usize];
            let wider = |vertex: usize| smoothed[vertex] || around.of(vertex).iter().any(is_near);
            smoothed = (0..smoothed.len()).map(wider).collect();
        }
        (0..smoothed.len()).filter(|&vertex| smoothed[vertex]).map(|vertex| vertex as u32).collect()
    }
}

/// True of vertices that are solved for: what is held fully keeps its row.
pub(super) fn is_free(pull: Option<f64>) -> bool {
    pull.is_some_and(|pull| pull < 1.0)
}

/// The weight of a vertex's match beside its edges: a share p of the match's beside the neighbours' 1 - p.
fn pull_weight(pulls: &[Option<f64>], weights: &EdgeWeights, vertex: usize) -> f64 {
    // A pull of 1 would leave nothing to solve for.
    let pull = pulls[vertex].unwrap_or(0.0).min(1.0 - ROUNDING);
    pull / (1.0 - pull) * weights.sums[vertex]
}
