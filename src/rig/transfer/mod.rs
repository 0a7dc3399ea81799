//! Cloth weights from the nearest body surface (§IV-B, Fig. 4e).
//!
//! Abdrashitov, Raichstat, Monsen and Hill. Robust skin weights transfer via weight inpainting. SIGGRAPH Asia 2023
//! Technical Communications. Departures: the fill is harmonic, not biharmonic, because a biharmonic one overshoots
//! (weights down to -0.09 on a skirt, which clamping turns into creases) and a harmonic one cannot; the thresholds are
//! ramps, so that a vertex near one does not jump.

mod fill;
mod rigid;
mod skin;

use super::{GarmentWeights, WeightSet};
use crate::character::Weights;
use crate::geometry::{
    Closest, ROUNDING, SEAM, Surface, Weld, bounds, bounds_by_group, components, neighbours, weld,
};
use crate::parallel;
use fill::{EdgeWeights, Fill, is_free};
use glam::DVec3;
pub use rigid::rigid_weights;
use skin::{Body, normals};
pub use skin::{Skin, Source};
use std::collections::BTreeMap;

/// A match may be this far away, in diagonals of the garment's box (Abdrashitov et al.) (seen: at -30 %, vertices move
/// up to 0.003 H; at +30 %, vertices move up to 0.002 H), ...
const MATCH_DISTANCE: f64 = 0.05;

/// ... but at least and at most this far, in heights: thick soles are still shoes, and what hangs a hand's width away
/// hangs freely (D20). Seen: ±30 % moves vertices by under 0.0005 H.
const MATCH_DISTANCE_RANGE: [f64; 2] = [0.015, 0.05];

/// Matches fade out up to this multiple of the greatest distance. Seen: at -30 %, vertices move up to 0.055 H, nine
/// more triangles turned over; at +30 %, vertices move up to 0.002 H.
const DISTANCE_RAMP: f64 = 1.25;

/// Cosines of the angles between normals at which a match counts fully (30 degrees) and no longer (40 degrees) (the
/// first as Abdrashitov et al.). Seen: at -30 %, vertices move up to 0.135 H, six more triangles turned over; at +30 %,
/// vertices move up to 0.012 H, twelve fewer triangles turned over.
const MATCH_COSINE: [f64; 2] = [0.866_025_403_784_438_6, 0.766_044_443_118_978];

/// Pieces of less extent than this keep their shape, in heights (D20). Seen: ±30 % moves vertices by under 0.0005 H.
const RIGID_EXTENT: f64 = 0.02;

/// How far a piece that nothing matches is smoothed, in heights: about a thigh's radius. Seen: ±30 % moves vertices by
/// under 0.0005 H.
const LOOSE_SMOOTHING: f64 = 0.05;

/// Weights by joint, ascending; they sum to 1.
type Row = Vec<(u32, f64)>;

/// A garment on a skin: where its vertices touch it and how what does not is filled in, which no weights change.
pub struct GarmentOnSkin {
    welded: Weld,
    points: Vec<DVec3>,
    touches: Vec<Touch>,
    /// For `Robust` alone.
    cloth: Option<Cloth>,
}

/// The places of a skin that are closest to a vertex.
struct Touch {
    /// With their shares.
    places: Vec<(Closest, f64)>,
    /// How well each matches the vertex, 0 to its share; for `Robust` alone.
    fits: Vec<f64>,
}

impl Touch {
    /// How well the places match, 0 to 1: 0, not to be trusted; 1, to be kept.
    fn fit(&self) -> f64 {
        let fit: f64 = self.fits.iter().sum();
        if fit > 0.0 { fit / self.places.iter().map(|(_, share)| share).sum::<f64>() } else { 0.0 }
    }
}

impl GarmentOnSkin {
    /// Looks where a garment's `positions` touch the skin of `positions` and `triangles`.
    ///
    /// All in one space in which the figure is about 1 high. `method` is `Robust` (which `Heat` falls to) or `Nearest`.
    ///
    /// O(vertices · log triangles), and sparse factorisations of the vertices without a match.
    pub fn new(
        skin: &Skin,
        skin_triangles: &[[u32; 3]],
        (positions, triangles): (&[DVec3], &[[u32; 3]]),
        method: GarmentWeights,
        thread_count: usize,
    ) -> Self {
        let welded = weld(positions, SEAM);
        let points = places(&welded, positions);
        if method == GarmentWeights::Nearest {
            let touches = parallel::collect(thread_count, welded.count, 256, |vertex| Touch {
                places: skin.places(points[vertex]),
                fits: Vec::new(),
            });
            return Self { welded, points, touches, cloth: None };
        }
        let corners: Vec<[u32; 3]> = triangles.iter().map(|&corners| welded.triangle(corners)).collect();
        let touch = || {
            let normals = normals(&points, &corners);
            let reach = reach(&points);
            parallel::collect(thread_count, welded.count, 256, |vertex| {
                let places = skin.places(points[vertex]);
                let fit = |(at, share): &(Closest, f64)| {
                    let near = (DISTANCE_RAMP - at.distance / reach) / (DISTANCE_RAMP - 1.0);
                    // Either side of double-sided cloth.
                    let cosine = skin.normal(skin_triangles, at).dot(normals[vertex]).abs();
                    let alike = (cosine - MATCH_COSINE[1]) / (MATCH_COSINE[0] - MATCH_COSINE[1]);
                    share * near.clamp(0.0, 1.0) * alike.clamp(0.0, 1.0)
                };
                Touch { fits: places.iter().map(fit).collect(), places }
            })
        };
        let (joined, touches) = parallel::both(thread_count, || Joined::new(&points, &corners), touch);
        let cloth = Some(Cloth::new(joined, corners, &touches));
        Self { welded, points, touches, cloth }
    }

    /// Weights of the garment after those of the skin under it, which is the one that it was made with.
    ///
    /// - `Nearest`: the barycentric blend at the closest surface point; where several places are equally far, to 1 %, all
    ///   of them. Nothing counts as fallback but `loose_vertex` and `no_source`.
    /// - `Robust`: the same where the closest point is near and the normals are alike, facing either way. The rest of
    ///   each connected piece is filled in smoothly (`inpainted`). A piece without a match follows the nearest surface,
    ///   be it the body or a piece that has its weights (`component_without_match`), and pieces below 2 % of the height
    ///   move as one (`rigid_piece`).
    ///
    /// A vertex in no triangle takes the closest point's weights (`loose_vertex`); without any source everything goes to
    /// joint 0 (`no_source`); `unsolved` counts what a failed solve left to the closest point.
    pub fn weights(&self, source: &Source, thread_count: usize) -> WeightSet {
        let body = Body::new(source);
        let count = self.welded.count;
        let mut rules: Vec<Option<&'static str>> = vec![None; count];
        let rows = match &self.cloth {
            _ if body.is_empty() => {
                rules.fill(Some("no_source"));
                vec![body.anything(); count]
            }
            None => parallel::collect(thread_count, count, 256, |vertex| {
                body.mixed(self.points[vertex], &self.touches[vertex].places)
            }),
            Some(cloth) => cloth.rows(&self.points, &body, &self.touches, &mut rules, thread_count),
        };
        finish(&self.welded, rows, &rules)
    }
}

/// What the body says about a vertex of the garment.
struct Match {
    row: Row,
    /// 0: not to be trusted; 1: to be kept.
    fit: f64,
    distance: f64,
}

impl Match {
    /// What `body` says about a vertex at `p`: the row of those places of `touch` that match the vertex at `p`, how
    /// well they do (0 to 1), and how far they are.
    /// Where none matches the row is that of the closest place all the same.
    fn of(body: &Body, p: DVec3, touch: &Touch) -> Self {
        let Touch { places, fits } = touch;
        let distance = places.first().map_or(f64::INFINITY, |(at, _)| at.distance);
        let fit = touch.fit();
        let fitting: Vec<_> = places.iter().zip(fits).map(|(&(at, _), &share)| (at, share)).collect();
        Match { row: body.mixed(p, if fit > 0.0 { &fitting } else { places }), fit, distance }
    }
}

/// How far a match may be, for a garment of `points`.
fn reach(points: &[DVec3]) -> f64 {
    let (low, high) = bounds(points.iter().copied().filter(|p| p.is_finite()));
    let [least, most] = MATCH_DISTANCE_RANGE;
    (MATCH_DISTANCE * (high - low).length()).clamp(least, most)
}

/// How the welded vertices of a garment hang together.
struct Joined {
    weights: EdgeWeights,
    /// The component of each vertex, and the greatest extent of each component.
    component: Vec<u32>,
    extents: Vec<f64>,
}

impl Joined {
    fn new(points: &[DVec3], triangles: &[[u32; 3]]) -> Self {
        let single = Weld::alone(points.len());
        let component = components(triangles, &single);
        let count = component.iter().max().map_or(0, |&last| last as usize + 1);
        let boxes = bounds_by_group(count, component.iter().map(|&c| c as usize).zip(points.iter().copied()));
        Self {
            weights: EdgeWeights::new(points, triangles, neighbours(triangles, &single)),
            component,
            extents: boxes.iter().map(|(low, high)| (*high - *low).max_element()).collect(),
        }
    }

    fn is_loose(&self, vertex: usize) -> bool {
        self.weights.around.of(vertex).is_empty()
    }

    fn is_small(&self, vertex: usize) -> bool {
        self.extents[self.component[vertex] as usize] < RIGID_EXTENT
    }
}

/// A garment between welded vertices, and what is to be filled in of it.
struct Cloth {
    triangles: Vec<[u32; 3]>,
    joined: Joined,
    /// Vertices of pieces with a match, and how much each is held to it.
    matched: Fill,
    /// Of pieces without one.
    unmatched: Fill,
}

impl Cloth {
    fn new(joined: Joined, triangles: Vec<[u32; 3]>, touches: &[Touch]) -> Self {
        let fits: Vec<f64> = touches.iter().map(Touch::fit).collect();
        let mut best = vec![0.0f64; joined.extents.len()];
        for (&fit, &component) in fits.iter().zip(&joined.component) {
            let best = &mut best[component as usize];
            *best = best.max(fit);
        }
        let is_large = |vertex: usize| !joined.is_loose(vertex) && !joined.is_small(vertex);
        let is_matched = |vertex: usize| best[joined.component[vertex] as usize] >= 0.5;
        let to_match = |vertex: usize| (is_large(vertex) && is_matched(vertex)).then_some(fits[vertex]);
        let to_closest = |vertex: usize| {
            let loose = joined.weights.areas[vertex] / LOOSE_SMOOTHING.powi(2);
            // As a share of what the neighbours say, which is what a fit is.
            let share = || loose / (loose + joined.weights.sums[vertex]);
            (is_large(vertex) && !is_matched(vertex)).then(share)
        };
        let matched = Fill::new(&joined.weights, (0..fits.len()).map(to_match).collect());
        let unmatched = Fill::new(&joined.weights, (0..fits.len()).map(to_closest).collect());
        Self { triangles, joined, matched, unmatched }
    }

    /// The rows of all vertices at `points`.
    fn rows(
        &self,
        points: &[DVec3],
        body: &Body,
        touches: &[Touch],
        rules: &mut [Option<&'static str>],
        threads: usize,
    ) -> Vec<Row> {
        let mut matches = parallel::collect(threads, points.len(), 256, |vertex| {
            Match::of(body, points[vertex], &touches[vertex])
        });
        // Pieces with a match first: what hangs from them can follow them then.
        let Self { joined, matched, unmatched, .. } = self;
        for (vertex, &pull) in matched.pulls.iter().enumerate() {
            if is_free(pull) {
                rules[vertex] = Some(if matched.factor.is_some() { "inpainted" } else { "unsolved" });
            }
        }
        matched.fill_in(&joined.weights, &mut matches, threads);
        let mut done: Vec<bool> = matched.pulls.iter().map(Option::is_some).collect();

        // Pieces without a match: after the body or after the cloth that has its weights, whichever is nearer.
        let pulls = &unmatched.pulls;
        if pulls.iter().any(Option::is_some) {
            self.follow_cloth(points, &mut matches, &done, threads);
            unmatched.fill_in(&joined.weights, &mut matches, threads);
            for (vertex, pull) in pulls.iter().enumerate() {
                if pull.is_some() {
                    rules[vertex] = Some("component_without_match");
                    done[vertex] = true;
                }
            }
        }

        self.rigid_pieces(points, body, &mut matches, rules, &done);
        for (vertex, rule) in rules.iter_mut().enumerate() {
            if joined.is_loose(vertex) {
                *rule = Some("loose_vertex");
            }
        }
        matches.into_iter().map(|found| found.row).collect()
    }

    /// The triangles between vertices that are `done`, and their surface.
    fn made_of(&self, points: &[DVec3], done: &[bool]) -> (Vec<[u32; 3]>, Surface) {
        let is_done = |corners: &&[u32; 3]| corners.iter().all(|&vertex| done[vertex as usize]);
        let triangles: Vec<[u32; 3]> = self.triangles.iter().filter(is_done).copied().collect();
        let surface = Surface::new(points, &triangles);
        (triangles, surface)
    }

    /// Gives the vertices of pieces without a match the row of the closest cloth that is `done`, where that is nearer than
    /// the body.
    fn follow_cloth(&self, points: &[DVec3], matches: &mut [Match], done: &[bool], threads: usize) {
        let (triangles, surface) = self.made_of(points, done);
        if surface.is_empty() {
            return;
        }
        let known: &[Match] = matches;
        let rows = parallel::collect(threads, known.len(), 256, |vertex| {
            let near = self.unmatched.pulls[vertex].and_then(|_| surface.closest_point(points[vertex]))?;
            (near.distance < known[vertex].distance).then(|| blend_rows(known, &triangles, &near))
        });
        for (found, row) in matches.iter_mut().zip(rows) {
            if let Some(row) = row.filter(|row| !row.is_empty()) {
                found.row = row;
            }
        }
    }

    /// One row for each small piece: the mean of what matches, else what is nearest to its middle, be it cloth that is
    /// `done` or the body.
    fn rigid_pieces(
        &self,
        points: &[DVec3],
        body: &Body,
        matches: &mut [Match],
        rules: &mut [Option<&'static str>],
        done: &[bool],
    ) {
        let mut pieces: BTreeMap<u32, Vec<usize>> = BTreeMap::new();
        for vertex in 0..matches.len() {
            if self.joined.is_small(vertex) && !self.joined.is_loose(vertex) {
                pieces.entry(self.joined.component[vertex]).or_default().push(vertex);
            }
        }
        if pieces.is_empty() {
            return;
        }
        let (triangles, surface) = self.made_of(points, done);
        for piece in pieces.into_values() {
            let middle = piece.iter().map(|&vertex| points[vertex]).sum::<DVec3>() / piece.len() as f64;
            let to_body = piece.iter().map(|&vertex| matches[vertex].distance).fold(f64::INFINITY, f64::min);
            let cloth = surface.closest_point(middle).filter(|near| near.distance < to_body);
            let row = cloth.map(|near| blend_rows(matches, &triangles, &near)).unwrap_or_else(|| {
                let fitting = piece.iter().map(|&vertex| &matches[vertex]);
                blended(fitting.map(|found| (found.fit, found.row.iter().copied())))
            });
            let row = if row.is_empty() { body.closest(middle) } else { row };
            for vertex in piece {
                matches[vertex].row = row.clone();
                rules[vertex] = Some("rigid_piece");
            }
        }
    }
}

/// The barycentric blend of rows of the cloth itself.
fn blend_rows(matches: &[Match], triangles: &[[u32; 3]], at: &Closest) -> Row {
    let corners = triangles[at.triangle].into_iter().zip(at.barycentric);
    blended(corners.map(|(vertex, share)| (share, matches[vertex as usize].row.iter().copied())))
}

/// Where the welded vertices are; the origin where that is no number.
fn places(welded: &Weld, positions: &[DVec3]) -> Vec<DVec3> {
    let at = |vertex: u32| Some(positions[vertex as usize]).filter(|p| p.is_finite()).unwrap_or_default();
    welded.first_vertices().into_iter().map(at).collect()
}

/// One row of several, each by its share.
fn blended<Entries: IntoIterator<Item = (u32, f64)>>(rows: impl Iterator<Item = (f64, Entries)>) -> Row {
    let by_share =
        |(share, row): (f64, Entries)| row.into_iter().map(move |(joint, weight)| (joint, share * weight));
    normalised(rows.flat_map(by_share).collect())
}

/// Sorted by joint, repeats summed, sum 1; empty where there is nothing to sum.
pub(super) fn normalised(mut row: Row) -> Row {
    row.retain(|&(_, weight)| weight > 0.0 && weight.is_finite());
    row.sort_by_key(|&(joint, _)| joint);
    row.dedup_by(|next, kept| {
        let same = next.0 == kept.0;
        if same {
            kept.1 += next.1;
        }
        same
    });
    let sum: f64 = row.iter().map(|&(_, weight)| weight).sum();
    row.iter_mut().for_each(|(_, weight)| *weight /= sum);
    row
}

/// Weights of the vertices from rows of the welded ones, without what is next to nothing.
fn finish(welded: &Weld, rows: Vec<Row>, rules: &[Option<&'static str>]) -> WeightSet {
    let kept = |row: Row| {
        let most = row.iter().map(|&(_, weight)| weight).fold(0.0, f64::max);
        let least = ROUNDING.min(most);
        normalised(row.into_iter().filter(|&(_, weight)| weight >= least).collect())
    };
    let rows: Vec<Row> = rows.into_iter().map(kept).collect();
    of_welded(welded, &rows, rules)
}

/// Rows of the vertices from those of the welded ones, and how many each rule gave.
pub(super) fn of_welded(welded: &Weld, rows: &[Row], rules: &[Option<&'static str>]) -> WeightSet {
    let mut fallback = BTreeMap::new();
    for rule in welded.representative.iter().filter_map(|&vertex| rules[vertex as usize]) {
        *fallback.entry(rule).or_default() += 1;
    }
    let rows = welded.representative.iter().map(|&vertex| &rows[vertex as usize]);
    let rounded = rows.map(|row| row.iter().map(|&(joint, weight)| (joint, weight as f32)));
    WeightSet { weights: Weights::from_rows(rounded), fallback }
}
