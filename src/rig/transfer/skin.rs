//! The surface that weights are taken from, and what it says about a point.

use super::{Row, blended, normalised, places};
use crate::character::Weights;
use crate::geometry::{Closest, PointTree, SEAM, Surface, double_area, weld};
use glam::DVec3;
use std::sync::OnceLock;

/// Closest points this much further than the closest one, relatively, still have a share, which falls to 0 there: where
/// two legs are equally far, neither is the closest by chance (D20). Seen: ±30 % moves no vertex.
const TIE: f64 = 0.01;

/// Closest points nearer to each other than this share of their distance lie in one place, of which one counts. Seen:
/// ±30 % moves no vertex.
const SAME_PLACE: f64 = 0.5;

/// Where the normals around a vertex leave less than this share of their sum, they are those of two sides of one cloth.
/// Seen: ±30 % moves no vertex.
const CANCELLED: f64 = 0.2;

/// A surface that weights are taken from, as far as it does not depend on them: made once for any number of weights.
pub struct Skin {
    pub(super) surface: Surface,
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
            surface: Surface::for_many(positions, triangles),
            normals: welded.representative.iter().map(|&vertex| normals[vertex as usize]).collect(),
        }
    }

    /// The unit normal at a point of the surface; 0 where there is none.
    pub(super) fn normal(&self, triangles: &[[u32; 3]], at: &Closest) -> DVec3 {
        let corners = triangles[at.triangle].into_iter().zip(at.barycentric);
        let sum: DVec3 = corners.map(|(vertex, share)| share * self.normals[vertex as usize]).sum();
        sum.normalize_or_zero()
    }

    /// The places closest to `p` and their shares, most of all the closest.
    pub(super) fn places(&self, p: DVec3) -> Vec<(Closest, f64)> {
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

/// A source made ready.
pub(super) struct Body<'a> {
    source: Source<'a>,
    /// Vertices that have weights.
    weighted: Vec<u32>,
    /// Where they are: made where a vertex has none, which few bodies have.
    places: OnceLock<PointTree>,
}

impl<'a> Body<'a> {
    pub(super) fn new(source: &Source<'a>) -> Self {
        let weighted: Vec<u32> = (0..source.positions.len().min(source.weights.row_count()))
            .filter(|&vertex| {
                source.positions[vertex].is_finite()
                    && source.weights.row(vertex).iter().any(|&(_, weight)| weight > 0.0)
            })
            .map(|vertex| vertex as u32)
            .collect();
        Self { source: *source, weighted, places: OnceLock::new() }
    }

    /// True where there is nothing to take weights from.
    pub(super) fn is_empty(&self) -> bool {
        self.weighted.is_empty()
    }

    /// Some row that is never empty.
    pub(super) fn anything(&self) -> Row {
        let first = self.weighted.first().map(|&vertex| self.row(vertex)).unwrap_or_default();
        if first.is_empty() { vec![(0, 1.0)] } else { first }
    }

    fn places(&self) -> &PointTree {
        self.places.get_or_init(|| {
            let at = |&vertex: &u32| self.source.positions[vertex as usize];
            PointTree::new(&self.weighted.iter().map(at).collect::<Vec<DVec3>>())
        })
    }

    fn row(&self, vertex: u32) -> Row {
        let (weights, vertex) = (self.source.weights, vertex as usize);
        let row = if vertex < weights.row_count() { weights.row(vertex) } else { &[] };
        normalised(row.iter().map(|&(joint, weight)| (joint, weight.into())).collect())
    }

    /// The barycentric blend; empty where no corner has weights.
    pub(super) fn blend(&self, at: &Closest) -> Row {
        let corners = self.source.triangles[at.triangle].into_iter().zip(at.barycentric);
        blended(corners.map(|(vertex, share)| (share, self.row(vertex))))
    }

    /// The row of the closest place or places; never empty.
    pub(super) fn closest(&self, p: DVec3) -> Row {
        self.mixed(p, &self.source.skin.places(p))
    }

    /// Rows of several places by their shares; never empty.
    pub(super) fn mixed(&self, p: DVec3, places: &[(Closest, f64)]) -> Row {
        let row = blended(places.iter().map(|(at, share)| (*share, self.blend(at))));
        if !row.is_empty() {
            return row;
        }
        // Bare vertices: the nearest one that has weights.
        let mut found = Vec::new();
        if p.is_finite() {
            self.places().nearest(p, 1, f64::INFINITY, &mut found);
        }
        found.first().map_or_else(|| self.anything(), |near| self.row(self.weighted[near.index() as usize]))
    }
}

/// Unit normals of welded vertices: means over the triangles, weighted by area; where two sides of one cloth cancel out,
/// all are turned to the side of the largest triangle. 0 where there is no triangle with an area.
pub(super) fn normals(points: &[DVec3], triangles: &[[u32; 3]]) -> Vec<DVec3> {
    let corners = || {
        triangles.iter().flat_map(|&corners| {
            let normal = double_area(points, corners);
            corners.map(|vertex| (vertex as usize, normal))
        })
    };
    let mut sums = vec![(DVec3::ZERO, 0.0, DVec3::ZERO); points.len()];
    for (vertex, normal) in corners() {
        let (sum, total, largest) = &mut sums[vertex];
        *sum += normal;
        *total += normal.length();
        if normal.length_squared() > largest.length_squared() {
            *largest = normal;
        }
    }
    let cancels = |&(sum, total, _): &(DVec3, f64, DVec3)| sum.length() < CANCELLED * total;
    let mut one_sided = vec![DVec3::ZERO; points.len()];
    for (vertex, normal) in corners().filter(|&(vertex, _)| cancels(&sums[vertex])) {
        one_sided[vertex] += if normal.dot(sums[vertex].2) < 0.0 { -normal } else { normal };
    }
    sums.iter()
        .zip(one_sided)
        .map(|(sums, one_sided)| if cancels(sums) { one_sided } else { sums.0 }.normalize_or_zero())
        .collect()
}
