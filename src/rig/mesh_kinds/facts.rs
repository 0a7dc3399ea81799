//! What surrounds the meshes: samples with a ray inwards and one outwards.

use super::MOST;
use crate::error::Result;
use crate::geometry::{Hit, Surface, bounds, double_area};
use crate::parallel;
use crate::progress::Progress;
use crate::rig::UnitFigure;
use glam::DVec3;
use std::sync::OnceLock;

/// Points on all meshes together, and least and most on one. Seen: ±30 % changes no mesh.
const SAMPLES: (usize, usize, usize) = (12_000, 24, 400);

/// What is as near as this, in heights, lies on the same spot. Seen: ±30 % changes no mesh.
const SAME_SPOT: f64 = 1e-4;

/// Cloth lies over what its inward ray meets within this distance, in heights: a wide skirt, but not an arm over a leg.
/// Seen: ±30 % changes no mesh.
const LAYER_REACH: f64 = 0.12;

/// A layer may be thick itself, like a lump of hair; then what it covers begins right behind it. In heights. Seen:
/// ±30 % changes no mesh.
const LAYER_THICKNESS: f64 = 0.04;

/// How far what lies below a thick layer may be behind it, and from where on a layer is thick, in heights: more, and an arm that
/// hangs beside a trunk lies over that. Seen: ±30 % changes no mesh.
const LAYER_GAP: f64 = 0.02;

/// A mesh of which this share lies over another one covers it: a long coat does a chest. Seen: ±30 % changes no mesh.
const COVER_SHARE: f64 = 0.15;

/// What has less than this share of a mesh's area is a crumb beside it, which it does not lie over. Seen: at +30 %, one
/// more mesh misjudged.
const CRUMB: f64 = 0.1;

/// How far points of a sequence step along both sides of a triangle: the golden ratio of the plane spreads them evenly,
/// whatever triangles they fall on (Roberts, The unreasonable effectiveness of quasirandom sequences, 2018). Seen:
/// ±30 % changes no mesh.
const GOLDEN: (f64, f64) = (0.754_877_666_246_692_7, 0.569_840_290_998_053_3);

/// A point on a mesh, and what is around it.
#[derive(Clone, Debug)]
pub(super) struct Sample {
    pub(super) point: DVec3,
    /// The mesh right below.
    pub(super) over: Option<usize>,
    /// The mesh that the point lies within.
    pub(super) within: Option<usize>,
    /// Below is the far side of the mesh itself.
    pub(super) volume: bool,
}

/// What is known of a mesh.
#[derive(Clone, Debug)]
pub(super) struct Facts {
    pub(super) samples: Vec<Sample>,
    pub(super) area: f64,
    pub(super) low: DVec3,
    pub(super) high: DVec3,
}

impl Facts {
    pub(super) fn share(&self, count: impl Fn(&Sample) -> bool) -> f64 {
        let counted = self.samples.iter().filter(|sample| count(sample)).count();
        counted as f64 / self.samples.len().max(1) as f64
    }

    pub(super) fn middle(&self) -> DVec3 {
        self.samples.iter().map(|sample| sample.point).sum::<DVec3>() / self.samples.len().max(1) as f64
    }

    /// True of what has a far side of its own.
    pub(super) fn is_closed(&self) -> bool {
        self.share(|sample| sample.volume) >= MOST
    }

    pub(super) fn extent(&self) -> f64 {
        (self.high - self.low).max_element()
    }
}

/// What surrounds each mesh of a figure, found once, whatever the kinds.
#[derive(Clone, Debug, Default)]
pub struct Surroundings {
    pub(super) facts: Vec<Facts>,
    /// The plane in which the volumes mirror best, once it is found.
    pub(super) middle: OnceLock<f64>,
    /// Which meshes go on where others end.
    pub(super) seams: Vec<Vec<usize>>,
}

pub(super) struct Scene<'a> {
    pub(super) figure: &'a UnitFigure,
    pub(super) known: &'a Surroundings,
}

impl Surroundings {
    pub(super) fn of(figure: &UnitFigure, threads: usize, progress: &mut Progress) -> Result<Self> {
        let surface = Surface::for_many(&figure.positions, &figure.triangles);
        let mesh_of = |hit: &Hit| figure.mesh_of(hit.triangle);
        let (all, least, most) = SAMPLES;
        let count = (all / figure.mesh_count().max(1)).clamp(least, most);
        let meshes = 0..figure.mesh_count();
        let on_mesh = |mesh: usize| {
            points_on(figure, mesh, count).into_iter().map(move |(point, normal)| (mesh, point, normal))
        };
        let points: Vec<(usize, DVec3, DVec3)> = meshes.clone().flat_map(on_mesh).collect();
        // Both rays first: which side is out is known once a mesh's own hits are counted.
        let shoot = |(): &mut (), index: usize| {
            let (_, point, normal) = points[index];
            [normal, -normal].map(|direction| {
                let mut hits = surface.all_hits(point, direction);
                hits.retain(|hit| hit.t > SAME_SPOT);
                hits
            })
        };
        progress.at(0.1)?;
        let part = &mut progress.part(0.1, 1.0);
        let shots = part.collect_with(threads, points.len(), parallel::FEW_RAYS, || (), shoot)?;
        let mut own = vec![[0; 2]; figure.mesh_count()];
        for (&(mesh, ..), shots) in points.iter().zip(&shots) {
            for (own, hits) in own[mesh].iter_mut().zip(shots) {
                *own += hits.iter().filter(|hit| mesh_of(hit) == mesh).count();
            }
        }
        let is_turned = |mesh: usize| own[mesh][0] > own[mesh][1];
        let enters = |hit: &Hit| hit.front != is_turned(mesh_of(hit));
        let without_samples = meshes.map(|mesh| {
            let corners = figure.triangles_of(mesh).iter().flatten();
            let (low, high) = bounds(corners.map(|&vertex| figure.positions[vertex as usize]));
            Facts { samples: Vec::new(), area: mesh_area(figure, mesh), low, high }
        });
        let mut facts: Vec<Facts> = without_samples.collect();
        for (&(mesh, point, _), [out, inwards]) in points.iter().zip(&shots) {
            let (out, inwards) = if is_turned(mesh) { (inwards, out) } else { (out, inwards) };
            let first_other = out.iter().find(|hit| mesh_of(hit) != mesh);
            let within = first_other.filter(|hit| !enters(hit)).map(mesh_of);
            let far_side = inwards.iter().find(|hit| mesh_of(hit) == mesh && !enters(hit));
            let below = inwards.iter().find(|hit| mesh_of(hit) != mesh && enters(hit));
            let over = below.filter(|below| {
                let thickness = far_side.map_or(f64::INFINITY, |hit| hit.t);
                if below.t <= thickness || thickness <= LAYER_GAP / 2.0 {
                    below.t <= LAYER_REACH
                } else {
                    thickness <= LAYER_THICKNESS && below.t - thickness <= LAYER_GAP
                }
            });
            let over = over.map(mesh_of);
            facts[mesh].samples.push(Sample { point, over, within, volume: far_side.is_some() });
        }
        Ok(Self { facts, ..Self::default() })
    }
}

impl Scene<'_> {
    /// The share of a mesh that lies over others that are no crumbs beside it.
    pub(super) fn layer_share(&self, mesh: usize) -> f64 {
        let facts = &self.known.facts[mesh];
        let is_no_crumb = |below: usize| self.known.facts[below].area > CRUMB * facts.area;
        facts.share(|sample| sample.over.is_some_and(is_no_crumb))
    }

    /// The share of a mesh that lies within others larger than itself.
    pub(super) fn enclosed_share(&self, mesh: usize) -> f64 {
        let (all, facts) = (&self.known.facts, &self.known.facts[mesh]);
        // What lies over this mesh does not enclose it: skin is below clothes, not inside them.
        let lies_over = |around: &Facts| around.share(|sample| sample.over == Some(mesh)) >= COVER_SHARE;
        let encloses: Vec<bool> =
            all.iter().map(|around| around.area > facts.area && !lies_over(around)).collect();
        facts.share(|sample| sample.within.is_some_and(|around| encloses[around]))
    }
}

/// The normal of a triangle, as long as its area.
fn area_of(figure: &UnitFigure, corners: [u32; 3]) -> DVec3 {
    0.5 * double_area(&figure.positions, corners)
}

pub(super) fn mesh_area(figure: &UnitFigure, mesh: usize) -> f64 {
    figure.triangles_of(mesh).iter().map(|&corners| area_of(figure, corners).length()).sum()
}

/// Points evenly over the area of a mesh, with the unit normals of their triangles.
pub(super) fn points_on(figure: &UnitFigure, mesh: usize, count: usize) -> Vec<(DVec3, DVec3)> {
    let step = mesh_area(figure, mesh) / count as f64;
    if !(step.is_finite() && step > 0.0) {
        return Vec::new();
    }
    let mut points = Vec::with_capacity(count);
    let (mut passed, mut next) = (0.0, 0.5 * step);
    for &corners in figure.triangles_of(mesh) {
        let normal = area_of(figure, corners);
        passed += normal.length();
        while next < passed && points.len() < count {
            let turn = points.len() as f64 + 0.5;
            let (u, v) = ((turn * GOLDEN.0).fract(), (turn * GOLDEN.1).fract());
            let (u, v) = if u + v > 1.0 { (1.0 - u, 1.0 - v) } else { (u, v) };
            let [a, b, c] = corners.map(|vertex| figure.positions[vertex as usize]);
            points.push((a + u * (b - a) + v * (c - a), normal.normalize_or_zero()));
            next += step;
        }
    }
    points.retain(|&(_, normal)| normal != DVec3::ZERO);
    points
}
