//! Cloth weights from the nearest body surface (§IV-B, Fig. 4e).
//!
//! Abdrashitov, Raichstat, Monsen and Hill. Robust skin weights transfer via weight inpainting. SIGGRAPH Asia 2023
//! Technical Communications. Departures: the fill is harmonic, not biharmonic, because a biharmonic one overshoots
//! (weights down to -0.09 on a skirt, which clamping turns into creases) and a harmonic one cannot; the thresholds are
//! ramps, so that a vertex near one does not jump.

mod inpaint;
mod rigid;
mod skin;

use super::{GarmentWeights, WeightSet};
use crate::character::Weights;
use crate::geometry::{
    Closest, ROUNDING, SEAM, Surface, Weld, bounds, bounds_by_group, by_key, components, triangles_where,
    weld,
};
use crate::parallel;
use glam::DVec3;
use inpaint::{EdgeWeights, Fill, is_free};
pub use rigid::rigid_weights;
use skin::{Body, normals};
pub use skin::{Skin, Source};
use std::collections::BTreeMap;

/// A match may be this far away, in diagonals of the garment's box (Abdrashitov et al.). Seen: at -30 %, vertices move
/// up to 0.003 H; at +30 %, vertices move up to 0.002 H.
const MATCH_DISTANCE: f64 = 0.05;

/// A match may be at least and at most this far away, in heights, whatever the garment's size: thick soles are still
/// shoes, and what hangs a hand's width away hangs freely (D20). Seen: ±30 % moves vertices by under 0.0005 H.
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

    /// How far the closest place is.
    fn distance(&self) -> f64 {
        self.places.first().map_or(f64::INFINITY, |(at, _)| at.distance)
    }

    /// What `body` says about the vertex, which is at `p`: the row of those places that match, or of all where none does.
    fn row(&self, body: &Body, p: DVec3) -> Row {
        if self.fit() > 0.0 {
            let fitting: Vec<_> =
                self.places.iter().zip(&self.fits).map(|(&(at, _), &fit)| (at, fit)).collect();
            body.mixed(p, &fitting)
        } else {
            body.mixed(p, &self.places)
        }
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
        let alone = Weld::alone(welded.count);
        let weights = || EdgeWeights::new(&points, &corners, &alone);
        let (weights, touches) = parallel::both(thread_count, weights, touch);
        let cloth = Some(Cloth::new((&points, &alone), corners, weights, &touches));
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
        if body.is_empty() {
            return finish(&self.welded, vec![body.anything(); count], &vec![Some("no_source"); count]);
        }
        let mut rows = parallel::collect(thread_count, count, 256, |vertex| {
            self.touches[vertex].row(&body, self.points[vertex])
        });
        let Some(cloth) = &self.cloth else {
            return finish(&self.welded, rows, &vec![None; count]);
        };
        cloth.fill_in(self, &body, &mut rows, thread_count);
        finish(&self.welded, rows, &cloth.rules)
    }
}

/// How far a match may be, for a garment of `points`.
fn reach(points: &[DVec3]) -> f64 {
    let (low, high) = bounds(points.iter().copied().filter(|p| p.is_finite()));
    let [least, most] = MATCH_DISTANCE_RANGE;
    (MATCH_DISTANCE * (high - low).length()).clamp(least, most)
}

/// A garment between welded vertices, and what is to be filled in of it.
struct Cloth {
    triangles: Vec<[u32; 3]>,
    weights: EdgeWeights,
    /// Vertices of pieces with a match, and how much each is held to it.
    matched: Fill,
    /// Of pieces without one.
    unmatched: Fill,
    /// The vertices of each piece that moves as one.
    rigid: Vec<Vec<usize>>,
    /// By vertex, the rule by which it gets its row, where that is not what the body says.
    rules: Vec<Option<&'static str>>,
}

impl Cloth {
    /// The cloth of `triangles` between `points`, which are all `alone`.
    fn new(
        (points, alone): (&[DVec3], &Weld),
        triangles: Vec<[u32; 3]>,
        weights: EdgeWeights,
        touches: &[Touch],
    ) -> Self {
        let component = components(&triangles, alone);
        let component = |vertex: usize| component[vertex] as usize;
        let vertices = || 0..points.len();
        let count = vertices().map(component).max().map_or(0, |last| last + 1);
        let boxes = bounds_by_group(count, vertices().map(|vertex| (component(vertex), points[vertex])));
        let is_small = |vertex: usize| {
            let (low, high) = boxes[component(vertex)];
            (high - low).max_element() < RIGID_EXTENT
        };
        let fits: Vec<f64> = touches.iter().map(Touch::fit).collect();
        let mut best = vec![0.0f64; count];
        for (vertex, &fit) in fits.iter().enumerate() {
            best[component(vertex)] = best[component(vertex)].max(fit);
        }
        let is_large = |vertex: usize| !weights.is_loose(vertex) && !is_small(vertex);
        let is_matched = |vertex: usize| best[component(vertex)] >= 0.5;
        let to_match = |vertex: usize| (is_large(vertex) && is_matched(vertex)).then_some(fits[vertex]);
        let to_closest = |vertex: usize| {
            let loose = weights.areas[vertex] / LOOSE_SMOOTHING.powi(2);
            // As a share of what the neighbours say, which is what a fit is.
            let share = || loose / (loose + weights.sums[vertex]);
            (is_large(vertex) && !is_matched(vertex)).then(share)
        };
        let matched = Fill::new(&weights, vertices().map(to_match).collect());
        let unmatched = Fill::new(&weights, vertices().map(to_closest).collect());
        let small = vertices().filter(|&vertex| is_small(vertex) && !weights.is_loose(vertex));
        let rigid = by_key(small.map(|vertex| (component(vertex), vertex))).into_values().collect();
        let filled_in = if matched.factor.is_some() { "inpainted" } else { "unsolved" };
        let rule = |vertex: usize| match (matched.pulls[vertex], unmatched.pulls[vertex]) {
            (None, None) if weights.is_loose(vertex) => Some("loose_vertex"),
            (None, None) => Some("rigid_piece"),
            (None, Some(_)) => Some("component_without_match"),
            (pull, _) => is_free(pull).then_some(filled_in),
        };
        let rules = vertices().map(rule).collect();
        Self { triangles, weights, matched, unmatched, rigid, rules }
    }

    /// Gives new rows to the vertices of `garment`, whose cloth this is, that the body says too little about.
    fn fill_in(&self, garment: &GarmentOnSkin, body: &Body, rows: &mut [Row], threads: usize) {
        // Pieces with a match first: what hangs from them can follow them then.
        let Self { weights, matched, unmatched, .. } = self;
        matched.fill_in(weights, rows, threads);
        // Pieces without a match: after the body or after the cloth that has its weights, whichever is nearer.
        if unmatched.pulls.iter().any(Option::is_some) {
            self.follow_cloth(garment, rows, threads);
            unmatched.fill_in(weights, rows, threads);
        }
        self.rigid_pieces(garment, body, rows);
    }

    /// Gives the vertices of pieces without a match the row of the closest cloth with one, where that is nearer than the body.
    fn follow_cloth(&self, garment: &GarmentOnSkin, rows: &mut [Row], threads: usize) {
        let GarmentOnSkin { points, touches, .. } = garment;
        let triangles = triangles_where(&self.triangles, |vertex| self.matched.pulls[vertex].is_some());
        let surface = Surface::new(points, &triangles);
        if surface.is_empty() {
            return;
        }
        let known: &[Row] = rows;
        let nearer = parallel::collect(threads, known.len(), 256, |vertex| {
            let near = self.unmatched.pulls[vertex].and_then(|_| surface.closest_point(points[vertex]))?;
            (near.distance < touches[vertex].distance()).then(|| blend_rows(known, &triangles, &near))
        });
        for (row, nearer) in rows.iter_mut().zip(nearer) {
            if let Some(nearer) = nearer.filter(|nearer| !nearer.is_empty()) {
                *row = nearer;
            }
        }
    }

    /// One row for each small piece: the mean of what matches, else what is nearest to its middle, be it cloth that is large
    /// or the body.
    fn rigid_pieces(&self, garment: &GarmentOnSkin, body: &Body, rows: &mut [Row]) {
        let GarmentOnSkin { points, touches, .. } = garment;
        if self.rigid.is_empty() {
            return;
        }
        let is_large = |vertex: usize| self.matched.pulls[vertex].or(self.unmatched.pulls[vertex]).is_some();
        let triangles = triangles_where(&self.triangles, is_large);
        let surface = Surface::new(points, &triangles);
        for piece in &self.rigid {
            let middle = piece.iter().map(|&vertex| points[vertex]).sum::<DVec3>() / piece.len() as f64;
            let to_body =
                piece.iter().map(|&vertex| touches[vertex].distance()).fold(f64::INFINITY, f64::min);
            let cloth = surface.closest_point(middle).filter(|near| near.distance < to_body);
            let row = cloth.map(|near| blend_rows(rows, &triangles, &near)).unwrap_or_else(|| {
                blended(piece.iter().map(|&vertex| (touches[vertex].fit(), rows[vertex].iter().copied())))
            });
            let row = if row.is_empty() { body.closest(middle) } else { row };
            for &vertex in piece {
                rows[vertex] = row.clone();
            }
        }
    }
}

/// The barycentric blend of rows of the cloth itself.
fn blend_rows(rows: &[Row], triangles: &[[u32; 3]], at: &Closest) -> Row {
    let corners = triangles[at.triangle].into_iter().zip(at.barycentric);
    blended(corners.map(|(vertex, share)| (share, rows[vertex as usize].iter().copied())))
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
