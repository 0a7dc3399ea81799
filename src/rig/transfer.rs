//! Cloth weights from the nearest body surface (§IV-B, Fig. 4e).
//!
//! Abdrashitov, Raichstat, Monsen and Hill. Robust skin weights transfer via weight inpainting. SIGGRAPH Asia 2023
//! Technical Communications. Departures: the fill is harmonic, not biharmonic, because a biharmonic one overshoots
//! (weights down to -0.09 on a skirt, which clamping turns into creases) and a harmonic one cannot; the thresholds are
//! ramps, so that a vertex near one does not jump.

use super::{GarmentWeights, WeightSet};
use crate::character::Weights;
use crate::geometry::laplacian::{Cholesky, cotangent_laplacian};
use crate::geometry::{
    Bounds, Closest, Neighbours, PointTree, SEAM, Surface, Weld, bounds, bounds_by_group, components,
    double_area, grown_clusters, neighbours, weld,
};
use crate::parallel;
use glam::DVec3;
use std::collections::BTreeMap;

/// Closest points this much further than the closest one, relatively, still have a share, which falls to 0 there: where
/// two legs are equally far, neither is the closest by chance.
const TIE: f64 = 0.01;

/// Closest points nearer to each other than this share of their distance lie in one place, of which one counts.
const SAME_PLACE: f64 = 0.5;

/// A match may be this far away, in diagonals of the garment's box (Abdrashitov et al.), ...
const MATCH_DISTANCE: f64 = 0.05;

/// ... but at least and at most this far, in heights: thick soles are still shoes, and what hangs a hand's width away
/// hangs freely.
const MATCH_DISTANCE_RANGE: [f64; 2] = [0.015, 0.05];

/// Matches fade out up to this multiple of the greatest distance.
const DISTANCE_RAMP: f64 = 1.25;

/// Cosines of the angles between normals at which a match counts fully (30 degrees) and no longer (40 degrees).
const MATCH_COSINE: [f64; 2] = [0.866_025_403_784_438_6, 0.766_044_443_118_978];

/// Pieces of less extent than this keep their shape, in heights.
const RIGID_EXTENT: f64 = 0.02;

/// Least weight of an edge with two triangles and greatest weight of any, beside the cotangents': no edge is cut, none
/// swallows the rest.
const EDGE_RANGE: [f64; 2] = [1e-2, 1e4];

/// How far a piece that nothing matches is smoothed, in heights: about a thigh's radius.
const LOOSE_SMOOTHING: f64 = 0.05;

/// Smoothing around the filled region (Abdrashitov et al.): steps, share of the neighbours, rings beyond the region.
const SMOOTHING: (usize, f64, usize) = (10, 0.2, 2);

/// Smaller weights are dropped.
const LEAST_WEIGHT: f64 = 1e-5;

/// Pieces of accessories nearer than this touch, in heights.
const TOUCH: f64 = 0.005;

/// What is within this distance of the attachment holds an accessory too, in heights.
const ATTACHMENT: f64 = 0.01;

/// An accessory hangs from as many joints at most.
const ATTACHMENT_JOINTS: usize = 2;

/// With more pieces than this, only those that touch are joined, not those whose boxes overlap.
const MOST_PIECES: usize = 500;

/// Columns solved together: fixed, so that results do not depend on the threads.
const BATCH: usize = 4;

/// A surface that weights are taken from, as far as it does not depend on them: made once for any number of weights.
pub struct Skin {
    surface: Surface,
    /// Unit normals by vertex, 0 where there is none.
    normals: Vec<DVec3>,
}

impl Skin {
    /// The skin of `positions` and `triangles`.
    pub fn new(positions: &[DVec3], triangles: &[[u32; 3]]) -> Self {
        let welded = weld(positions, SEAM);
        let points = places(&welded, positions);
        let corners: Vec<[u32; 3]> = triangles.iter().map(|&corners| welded.triangle(corners)).collect();
        let normals = normals(&points, &corners);
        Self {
            surface: Surface::new(positions, triangles),
            normals: welded.representative.iter().map(|&vertex| normals[vertex as usize]).collect(),
        }
    }

    /// The unit normal at a point of the surface; 0 where there is none.
    fn normal(&self, triangles: &[[u32; 3]], at: &Closest) -> DVec3 {
        let corners = triangles[at.triangle].into_iter().zip(at.barycentric);
        corners
            .map(|(vertex, share)| share * self.normals[vertex as usize])
            .sum::<DVec3>()
            .normalize_or_zero()
    }

    /// The places closest to `p` and their shares, most of all the closest.
    fn places(&self, p: DVec3) -> Vec<(Closest, f64)> {
        let Some(closest) = self.surface.closest_point(p) else {
            return Vec::new();
        };
        let mut places = vec![(closest, 1.0)];
        let slack = TIE * closest.distance;
        if slack > 0.0 {
            let mut near = Vec::new();
            self.surface.points_within(p, closest.distance + slack, &mut near);
            for other in near {
                let share = 1.0 - (other.distance - closest.distance) / slack;
                let apart = |(known, _): &(Closest, f64)| {
                    known.point.distance(other.point) > SAME_PLACE * closest.distance
                };
                if share > 0.0 && places.iter().all(apart) {
                    places.push((other, share.min(1.0)));
                }
            }
        }
        places
    }
}

/// A skin whose weights are known.
#[derive(Clone, Copy)]
pub struct Source<'a> {
    /// Made of `positions` and `triangles`.
    pub skin: &'a Skin,
    /// Its vertices.
    pub positions: &'a [DVec3],
    /// Its triangles.
    pub triangles: &'a [[u32; 3]],
    /// A row for each of `positions`.
    pub weights: &'a Weights,
}

/// Weights by joint, ascending; they sum to 1.
type Row = Vec<(u32, f64)>;

/// A garment on a skin: where its vertices touch it, which no weights change.
pub struct GarmentOnSkin {
    welded: Weld,
    points: Vec<DVec3>,
    corners: Vec<[u32; 3]>,
    touches: Vec<Touch>,
    method: GarmentWeights,
}

/// The places of a skin that are closest to a vertex.
struct Touch {
    /// With their shares.
    places: Vec<(Closest, f64)>,
    /// How well each matches the vertex, 0 to its share; for `Robust` alone.
    fits: Vec<f64>,
}

impl GarmentOnSkin {
    /// Looks where a garment's `positions` touch the skin of `positions` and `triangles`.
    ///
    /// All in one space in which the figure is about 1 high. `method` is `Robust` (which `Heat` falls to) or `Nearest`.
    ///
    /// O(vertices · log triangles).
    pub fn new(
        skin: &Skin,
        skin_triangles: &[[u32; 3]],
        (positions, triangles): (&[DVec3], &[[u32; 3]]),
        method: GarmentWeights,
        thread_count: usize,
    ) -> Self {
        let welded = weld(positions, SEAM);
        let points = places(&welded, positions);
        let corners: Vec<[u32; 3]> = triangles.iter().map(|&corners| welded.triangle(corners)).collect();
        let touches = if method == GarmentWeights::Nearest {
            parallel::collect(thread_count, welded.count, 256, |vertex| Touch {
                places: skin.places(points[vertex]),
                fits: Vec::new(),
            })
        } else {
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
        Self { welded, points, corners, touches, method }
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
    ///
    /// One sparse factorisation of the vertices without a match.
    pub fn weights(&self, source: &Source, thread_count: usize) -> WeightSet {
        let body = Body::new(source);
        let count = self.welded.count;
        let mut rules: Vec<Option<&'static str>> = vec![None; count];
        let rows = if body.is_empty() {
            rules.fill(Some("no_source"));
            vec![body.anything(); count]
        } else if self.method == GarmentWeights::Nearest {
            parallel::collect(thread_count, count, 256, |vertex| {
                body.mixed(self.points[vertex], &self.touches[vertex].places)
            })
        } else {
            Cloth::new(&self.points, &self.corners).robust(&body, &self.touches, &mut rules, thread_count)
        };
        finish(&self.welded, rows, &rules)
    }
}

/// Weights of things that keep their shape: each connected piece, or cluster of pieces that touch, has one row, taken
/// from the body where the piece is nearest to it and sharpened to two joints at most, so that no sword bends.
///
/// All in one space in which the figure is about 1 high. Every vertex counts as `rigid_piece`, or as `no_source`.
pub fn rigid_weights(source: &Source, positions: &[DVec3], triangles: &[[u32; 3]]) -> WeightSet {
    let body = Body::new(source);
    let welded = weld(positions, SEAM);
    if body.is_empty() {
        return finish(&welded, vec![body.anything(); welded.count], &vec![Some("no_source"); welded.count]);
    }
    let points = places(&welded, positions);
    let mut rows = vec![Row::new(); welded.count];
    for piece in things(&points, &welded, triangles) {
        let near: Vec<Option<Closest>> =
            piece.iter().map(|&vertex| source.skin.surface.closest_point(points[vertex as usize])).collect();
        let least = near.iter().flatten().map(|near| near.distance).fold(f64::INFINITY, f64::min);
        let mut row = Row::new();
        for near in near.into_iter().flatten() {
            let share = 1.0 - (near.distance - least) / ATTACHMENT;
            if share > 0.0 {
                row.extend(body.blend(&near).into_iter().map(|(joint, weight)| (joint, share * weight)));
            }
        }
        let row = sharpened(normalised(row));
        let row = if row.is_empty() { body.anything() } else { row };
        for vertex in piece {
            rows[vertex as usize] = row.clone();
        }
    }
    finish(&welded, rows, &vec![Some("rigid_piece"); welded.count])
}

/// Welded vertices by cluster: components that touch, or whose boxes do.
fn things(points: &[DVec3], welded: &Weld, triangles: &[[u32; 3]]) -> Vec<Vec<u32>> {
    let corners: Vec<[u32; 3]> = triangles.iter().map(|&corners| welded.triangle(corners)).collect();
    let near = weld(points, TOUCH);
    let component = components(&corners, &near);
    let component = |vertex: usize| component[near.representative[vertex] as usize] as usize;
    let count = (0..points.len()).map(|vertex| component(vertex) + 1).max().unwrap_or(0);
    let boxes: Vec<Bounds> =
        bounds_by_group(count, points.iter().enumerate().map(|(v, &p)| (component(v), p)))
            .into_iter()
            .map(|(low, high)| (low - TOUCH / 2.0, high + TOUCH / 2.0))
            .collect();
    // Crumbs by the thousand are left as they are.
    let clusters = if count <= MOST_PIECES { grown_clusters(&boxes) } else { (0..count).collect() };
    let mut members: BTreeMap<usize, Vec<u32>> = BTreeMap::new();
    for vertex in 0..points.len() {
        members.entry(clusters[component(vertex)]).or_default().push(vertex as u32);
    }
    members.into_values().collect()
}

/// The two strongest joints, the stronger the more.
fn sharpened(mut row: Row) -> Row {
    row.sort_by(|a, b| b.1.total_cmp(&a.1).then(a.0.cmp(&b.0)));
    row.truncate(ATTACHMENT_JOINTS);
    normalised(row.into_iter().map(|(joint, weight)| (joint, weight * weight)).collect())
}

/// Where the welded vertices are; the origin where that is no number.
fn places(welded: &Weld, positions: &[DVec3]) -> Vec<DVec3> {
    let at = |vertex: u32| Some(positions[vertex as usize]).filter(|p| p.is_finite()).unwrap_or_default();
    welded.first_vertices().into_iter().map(at).collect()
}

/// Sorted by joint, repeats summed, sum 1; empty where there is nothing to sum.
fn normalised(mut row: Row) -> Row {
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

/// Rows of the vertices from those of the welded ones, and how many each rule gave.
fn finish(welded: &Weld, rows: Vec<Row>, rules: &[Option<&'static str>]) -> WeightSet {
    let rows: Vec<Vec<(u32, f32)>> = rows
        .into_iter()
        .map(|row| {
            let most = row.iter().map(|&(_, weight)| weight).fold(0.0, f64::max);
            let least = LEAST_WEIGHT.min(most);
            let row = normalised(row.into_iter().filter(|&(_, weight)| weight >= least).collect());
            row.into_iter().map(|(joint, weight)| (joint, weight as f32)).collect()
        })
        .collect();
    let mut fallback = BTreeMap::new();
    for rule in welded.representative.iter().filter_map(|&vertex| rules[vertex as usize]) {
        *fallback.entry(rule).or_default() += 1;
    }
    let rows = welded.representative.iter().map(|&vertex| rows[vertex as usize].iter().copied());
    WeightSet { weights: Weights::from_rows(rows), fallback }
}

/// A source made ready.
struct Body<'a> {
    source: Source<'a>,
    /// Vertices that have weights, and where they are.
    weighted: (PointTree, Vec<u32>),
}

impl<'a> Body<'a> {
    fn new(source: &Source<'a>) -> Self {
        let vertices: Vec<u32> = (0..source.positions.len().min(source.weights.row_count()))
            .filter(|&vertex| {
                source.positions[vertex].is_finite()
                    && source.weights.row(vertex).iter().any(|&(_, weight)| weight > 0.0)
            })
            .map(|vertex| vertex as u32)
            .collect();
        let places: Vec<DVec3> = vertices.iter().map(|&vertex| source.positions[vertex as usize]).collect();
        Self { source: *source, weighted: (PointTree::new(&places), vertices) }
    }

    /// True where there is nothing to take weights from.
    fn is_empty(&self) -> bool {
        self.weighted.1.is_empty()
    }

    /// Some row that is never empty.
    fn anything(&self) -> Row {
        let first = self.weighted.1.first().map(|&vertex| self.row(vertex)).unwrap_or_default();
        if first.is_empty() { vec![(0, 1.0)] } else { first }
    }

    fn row(&self, vertex: u32) -> Row {
        let weights = self.source.weights;
        if vertex as usize >= weights.row_count() {
            return Row::new();
        }
        normalised(
            weights.row(vertex as usize).iter().map(|&(joint, weight)| (joint, weight.into())).collect(),
        )
    }

    /// The barycentric blend; empty where no corner has weights.
    fn blend(&self, at: &Closest) -> Row {
        let corners = self.source.triangles[at.triangle].into_iter().zip(at.barycentric);
        normalised(
            corners
                .flat_map(|(vertex, share)| {
                    self.row(vertex).into_iter().map(move |(joint, weight)| (joint, share * weight))
                })
                .collect(),
        )
    }

    /// The row of the closest place or places; never empty.
    fn closest(&self, p: DVec3) -> Row {
        self.mixed(p, &self.source.skin.places(p))
    }

    /// Rows of several places by their shares; never empty.
    fn mixed(&self, p: DVec3, places: &[(Closest, f64)]) -> Row {
        let mut row = Row::new();
        for &(ref at, share) in places {
            row.extend(self.blend(at).into_iter().map(|(joint, weight)| (joint, share * weight)));
        }
        let row = normalised(row);
        if !row.is_empty() {
            return row;
        }
        // Bare vertices: the nearest one that has weights.
        let mut found = Vec::new();
        if p.is_finite() {
            self.weighted.0.nearest(p, 1, f64::INFINITY, &mut found);
        }
        found.first().map_or_else(|| self.anything(), |near| self.row(self.weighted.1[near.index() as usize]))
    }

    /// The row of those places of `touch` that match the vertex at `p`, how well they do (0 to 1), and how far they are.
    /// Where none matches the row is that of the closest place all the same.
    fn matched(&self, p: DVec3, touch: &Touch) -> Match {
        let Touch { places, fits } = touch;
        let distance = places.first().map_or(f64::INFINITY, |(at, _)| at.distance);
        let fit: f64 = fits.iter().sum();
        if fit > 0.0 {
            let all: f64 = places.iter().map(|(_, share)| share).sum();
            let fitting: Vec<_> = places.iter().zip(fits).map(|(&(at, _), &share)| (at, share)).collect();
            return Match { row: self.mixed(p, &fitting), fit: fit / all, distance };
        }
        Match { row: self.mixed(p, places), fit: 0.0, distance }
    }
}

/// What the body says about a vertex of the garment.
struct Match {
    row: Row,
    /// 0: not to be trusted; 1: to be kept.
    fit: f64,
    distance: f64,
}

/// Unit normals of welded vertices: means over the triangles, weighted by area; where two sides of one cloth cancel out,
/// all are turned to the side of the largest triangle. 0 where there is no triangle with an area.
fn normals(points: &[DVec3], triangles: &[[u32; 3]]) -> Vec<DVec3> {
    let mut sums = vec![(DVec3::ZERO, 0.0, DVec3::ZERO); points.len()];
    for corners in triangles {
        let normal = double_area(points, *corners);
        for &vertex in corners {
            let (sum, total, largest) = &mut sums[vertex as usize];
            *sum += normal;
            *total += normal.length();
            if normal.length_squared() > largest.length_squared() {
                *largest = normal;
            }
        }
    }
    let cancels = |&(sum, total, _): &(DVec3, f64, DVec3)| sum.length() < 0.2 * total;
    let mut one_sided = vec![DVec3::ZERO; points.len()];
    if sums.iter().any(cancels) {
        for corners in triangles {
            let normal = double_area(points, *corners);
            for &vertex in corners {
                let side = normal.dot(sums[vertex as usize].2);
                one_sided[vertex as usize] += if side < 0.0 { -normal } else { normal };
            }
        }
    }
    sums.iter()
        .zip(one_sided)
        .map(|(sums, one_sided)| if cancels(sums) { one_sided } else { sums.0 }.normalize_or_zero())
        .collect()
}

/// How far a match may be, for a garment of `points`.
fn reach(points: &[DVec3]) -> f64 {
    let (low, high) = bounds(points.iter().copied().filter(|p| p.is_finite()));
    let [least, most] = MATCH_DISTANCE_RANGE;
    (MATCH_DISTANCE * (high - low).length()).clamp(least, most)
}

/// A garment between welded vertices.
struct Cloth<'a> {
    points: &'a [DVec3],
    triangles: &'a [[u32; 3]],
    around: Neighbours,
    /// The component of each vertex, and the greatest extent of each component.
    component: Vec<u32>,
    extents: Vec<f64>,
}

impl<'a> Cloth<'a> {
    fn new(points: &'a [DVec3], triangles: &'a [[u32; 3]]) -> Self {
        let single = Weld { representative: (0..points.len() as u32).collect(), count: points.len() };
        let component = components(triangles, &single);
        let count = component.iter().max().map_or(0, |&last| last as usize + 1);
        let boxes = bounds_by_group(count, component.iter().map(|&c| c as usize).zip(points.iter().copied()));
        Self {
            points,
            triangles,
            around: neighbours(triangles, &single),
            component,
            extents: boxes.iter().map(|(low, high)| (*high - *low).max_element()).collect(),
        }
    }

    fn robust(
        &self,
        body: &Body,
        touches: &[Touch],
        rules: &mut [Option<&'static str>],
        threads: usize,
    ) -> Vec<Row> {
        let mut matches = parallel::collect(threads, self.points.len(), 256, |vertex| {
            body.matched(self.points[vertex], &touches[vertex])
        });
        let is_loose = |vertex: usize| self.around.of(vertex).is_empty();
        let is_small = |vertex: usize| self.extents[self.component[vertex] as usize] < RIGID_EXTENT;
        let mut best = vec![0.0f64; self.extents.len()];
        for (found, &component) in matches.iter().zip(&self.component) {
            let best = &mut best[component as usize];
            *best = best.max(found.fit);
        }
        let is_matched = |vertex: usize| best[self.component[vertex] as usize] >= 0.5;

        // Pieces with a match first: what hangs from them can follow them then.
        let weights = EdgeWeights::new(self);
        let large: Vec<bool> =
            (0..matches.len()).map(|vertex| !is_loose(vertex) && !is_small(vertex)).collect();
        let pull = |vertex: usize| matches[vertex].fit;
        let pulls: Vec<Option<f64>> = (0..matches.len())
            .map(|vertex| (large[vertex] && is_matched(vertex)).then(|| pull(vertex)))
            .collect();
        let filled = self.fill(&weights, &pulls, &matches, threads);
        for (vertex, pull) in pulls.iter().enumerate() {
            if pull.is_some_and(|pull| pull < 1.0) {
                rules[vertex] = Some(if filled.is_some() { "inpainted" } else { "unsolved" });
            }
        }
        let mut done: Vec<bool> = pulls.iter().map(Option::is_some).collect();
        for (vertex, row) in filled.into_iter().flatten() {
            matches[vertex as usize].row = row;
        }

        // Pieces without a match: after the body or after the cloth that has its weights, whichever is nearer.
        if (0..matches.len()).any(|vertex| large[vertex] && !is_matched(vertex)) {
            self.follow_cloth(&mut matches, &done, |vertex| large[vertex] && !is_matched(vertex), threads);
            let pulls: Vec<Option<f64>> = (0..matches.len())
                .map(|vertex| {
                    let loose = weights.areas[vertex] / LOOSE_SMOOTHING.powi(2);
                    let around = weights.sum(vertex);
                    // As a share of what the neighbours say, which is what a fit is.
                    (large[vertex] && !is_matched(vertex)).then_some(loose / (loose + around))
                })
                .collect();
            let filled = self.fill(&weights, &pulls, &matches, threads);
            for (vertex, row) in filled.into_iter().flatten() {
                matches[vertex as usize].row = row;
            }
            for (vertex, pull) in pulls.iter().enumerate() {
                if pull.is_some() {
                    rules[vertex] = Some("component_without_match");
                    done[vertex] = true;
                }
            }
        }

        self.rigid_pieces(body, &mut matches, rules, &done, &is_small);
        for (vertex, rule) in rules.iter_mut().enumerate() {
            if is_loose(vertex) {
                *rule = Some("loose_vertex");
            }
        }
        matches.into_iter().map(|found| found.row).collect()
    }

    /// The triangles between vertices that are `done`, and their surface.
    fn made_of(&self, done: &[bool]) -> (Vec<[u32; 3]>, Surface) {
        let is_done = |corners: &&[u32; 3]| corners.iter().all(|&vertex| done[vertex as usize]);
        let triangles: Vec<[u32; 3]> = self.triangles.iter().filter(is_done).copied().collect();
        let surface = Surface::new(self.points, &triangles);
        (triangles, surface)
    }

    /// Gives the vertices that `choose` accepts the row of the closest cloth that is `done`, where that is nearer than
    /// the body.
    fn follow_cloth(
        &self,
        matches: &mut [Match],
        done: &[bool],
        choose: impl Fn(usize) -> bool + Sync,
        threads: usize,
    ) {
        let (triangles, surface) = self.made_of(done);
        if surface.is_empty() {
            return;
        }
        let known: &[Match] = matches;
        let rows = parallel::collect(threads, known.len(), 256, |vertex| {
            let near = choose(vertex).then(|| surface.closest_point(self.points[vertex])).flatten()?;
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
        body: &Body,
        matches: &mut [Match],
        rules: &mut [Option<&'static str>],
        done: &[bool],
        is_small: &dyn Fn(usize) -> bool,
    ) {
        let mut pieces: BTreeMap<u32, Vec<usize>> = BTreeMap::new();
        for vertex in 0..matches.len() {
            if is_small(vertex) && !self.around.of(vertex).is_empty() {
                pieces.entry(self.component[vertex]).or_default().push(vertex);
            }
        }
        if pieces.is_empty() {
            return;
        }
        let (triangles, surface) = self.made_of(done);
        for piece in pieces.into_values() {
            let middle = piece.iter().map(|&vertex| self.points[vertex]).sum::<DVec3>() / piece.len() as f64;
            let to_body = piece.iter().map(|&vertex| matches[vertex].distance).fold(f64::INFINITY, f64::min);
            let cloth = surface.closest_point(middle).filter(|near| near.distance < to_body);
            let row = cloth.map(|near| blend_rows(matches, &triangles, &near)).unwrap_or_else(|| {
                let fitting = piece.iter().flat_map(|&vertex| {
                    let Match { row, fit, .. } = &matches[vertex];
                    row.iter().map(move |&(joint, weight)| (joint, fit * weight))
                });
                normalised(fitting.collect())
            });
            let row = if row.is_empty() { body.closest(middle) } else { row };
            for vertex in piece {
                matches[vertex].row = row.clone();
                rules[vertex] = Some("rigid_piece");
            }
        }
    }

    /// Rows of all vertices that have a pull, smooth between them; in order of the vertices.
    ///
    /// A vertex of pull 1 keeps the row of its match, one of pull 0 is the mean of its neighbours, one in between a blend
    /// of both. `None` where there is nothing to do or the system cannot be solved.
    fn fill(
        &self,
        weights: &EdgeWeights,
        pulls: &[Option<f64>],
        matches: &[Match],
        threads: usize,
    ) -> Option<Vec<(u32, Row)>> {
        let is_free = |vertex: usize| pulls[vertex].is_some_and(|pull| pull < 1.0);
        let free: Vec<u32> =
            (0..pulls.len()).filter(|&vertex| is_free(vertex)).map(|vertex| vertex as u32).collect();
        if free.is_empty() {
            return None;
        }
        let mut slots = vec![u32::MAX; pulls.len()];
        for (slot, &vertex) in free.iter().enumerate() {
            slots[vertex as usize] = slot as u32;
        }
        // A share p of the target's beside the neighbours' 1 - p.
        let pull_weight = |vertex: usize| {
            let pull = pulls[vertex].unwrap_or(0.0).min(1.0 - 1e-6);
            pull / (1.0 - pull) * weights.sum(vertex)
        };
        let mut diagonal = Vec::with_capacity(free.len());
        let mut lower = Vec::new();
        for (slot, &vertex) in free.iter().enumerate() {
            let vertex = vertex as usize;
            diagonal.push(weights.sum(vertex) + pull_weight(vertex));
            for (other, weight) in weights.of(&self.around, vertex) {
                let other = slots[other as usize];
                if other < slot as u32 {
                    lower.push((slot as u32, other, -weight));
                }
            }
        }
        let factor = Cholesky::new(&diagonal, &lower)?;

        // What is smoothed afterwards: the free vertices and a few rings.
        let (steps, share, rings) = SMOOTHING;
        let mut smoothed: Vec<bool> = (0..pulls.len()).map(is_free).collect();
        for _ in 0..rings {
            let wider: Vec<bool> = (0..pulls.len())
                .map(|vertex| {
                    smoothed[vertex] || self.around.of(vertex).iter().any(|&other| smoothed[other as usize])
                })
                .collect();
            smoothed = wider;
        }
        let region: Vec<u32> =
            (0..pulls.len()).filter(|&vertex| smoothed[vertex]).map(|vertex| vertex as u32).collect();

        // The matches' weights by joint.
        let mut columns: BTreeMap<u32, Vec<(u32, f64)>> = BTreeMap::new();
        for (vertex, found) in matches.iter().enumerate().filter(|&(vertex, _)| pulls[vertex].is_some()) {
            for &(joint, weight) in &found.row {
                columns.entry(joint).or_default().push((vertex as u32, weight));
            }
        }
        let columns: Vec<(u32, Vec<(u32, f64)>)> = columns.into_iter().collect();
        let batches: Vec<_> = columns.chunks(BATCH).collect();
        let solved = parallel::collect(threads, batches.len(), 1, |batch| {
            let batch = batches[batch];
            let mut sides = vec![0.0; free.len() * batch.len()];
            for ((_, column), side) in batch.iter().zip(sides.chunks_mut(free.len())) {
                for &(vertex, weight) in column {
                    let vertex = vertex as usize;
                    if slots[vertex] != u32::MAX {
                        side[slots[vertex] as usize] += pull_weight(vertex) * weight;
                        continue;
                    }
                    for (other, edge) in weights.of(&self.around, vertex) {
                        let slot = slots[other as usize];
                        if slot != u32::MAX {
                            side[slot as usize] += edge * weight;
                        }
                    }
                }
            }
            factor.solve(&mut sides, batch.len());
            let mut values = vec![0.0; pulls.len()];
            let mut next = vec![0.0; region.len()];
            let mut made: Vec<Vec<f64>> = Vec::with_capacity(batch.len());
            for ((_, column), side) in batch.iter().zip(sides.chunks(free.len())) {
                values.fill(0.0);
                for &(vertex, weight) in column {
                    values[vertex as usize] = weight;
                }
                for (&vertex, &value) in free.iter().zip(side) {
                    values[vertex as usize] = value;
                }
                for _ in 0..steps {
                    for (&vertex, next) in region.iter().zip(&mut next) {
                        let around = self.around.of(vertex as usize);
                        let sum: f64 = around.iter().map(|&other| values[other as usize]).sum();
                        let mean = sum / around.len().max(1) as f64;
                        *next = (1.0 - share) * values[vertex as usize] + share * mean;
                    }
                    for (&vertex, &next) in region.iter().zip(&next) {
                        values[vertex as usize] = next;
                    }
                }
                made.push(region.iter().map(|&vertex| values[vertex as usize]).collect());
            }
            made
        });
        let solved: Vec<Vec<f64>> = solved.into_iter().flatten().collect();
        let rows = region.iter().enumerate().filter_map(|(slot, &vertex)| {
            let entries = columns.iter().zip(&solved).map(|((joint, _), values)| (*joint, values[slot]));
            let row = normalised(entries.filter(|&(_, weight)| weight >= LEAST_WEIGHT).collect());
            (!row.is_empty()).then_some((vertex, row))
        });
        Some(rows.collect())
    }
}

/// The barycentric blend of rows of the cloth itself.
fn blend_rows(matches: &[Match], triangles: &[[u32; 3]], at: &Closest) -> Row {
    let corners = triangles[at.triangle].into_iter().zip(at.barycentric);
    normalised(
        corners
            .flat_map(|(vertex, share)| {
                matches[vertex as usize].row.iter().map(move |&(joint, weight)| (joint, share * weight))
            })
            .collect(),
    )
}

/// How much the two ends of each edge pull at each other, above 0.
struct EdgeWeights {
    /// In the order of the neighbours.
    edges: Vec<f64>,
    sums: Vec<f64>,
    areas: Vec<f64>,
}

impl EdgeWeights {
    /// Cotangents, kept above 0 (obtuse triangles) and away from infinity (slivers), so that the fill stays between the
    /// values around it and edges of triangles without area still join their ends.
    fn new(cloth: &Cloth) -> Self {
        let laplacian = cotangent_laplacian(cloth.points, cloth.triangles);
        let [least, most] = EDGE_RANGE;
        let around = &cloth.around;
        let place = |vertex: u32, other: u32| {
            let found = around.of(vertex as usize).binary_search(&other).ok();
            found.map(|place| around.starts[vertex as usize] as usize + place)
        };
        let mut edges = vec![0.0f64; around.vertices.len()];
        for &[a, b, c] in cloth.triangles {
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
        let range =
            |vertex: usize| cloth.around.starts[vertex] as usize..cloth.around.starts[vertex + 1] as usize;
        let sums = (0..cloth.points.len()).map(|vertex| edges[range(vertex)].iter().sum()).collect();
        let mut areas = laplacian.areas;
        areas.resize(cloth.points.len(), 0.0);
        areas.iter_mut().filter(|area| !area.is_finite()).for_each(|area| *area = 0.0);
        Self { edges, sums, areas }
    }

    /// The neighbours of a vertex with the weights of the edges to them.
    fn of<'b>(&'b self, around: &'b Neighbours, vertex: usize) -> impl Iterator<Item = (u32, f64)> + 'b {
        let start = around.starts[vertex] as usize;
        around.of(vertex).iter().enumerate().map(move |(place, &other)| (other, self.edges[start + place]))
    }

    fn sum(&self, vertex: usize) -> f64 {
        self.sums[vertex]
    }
}
