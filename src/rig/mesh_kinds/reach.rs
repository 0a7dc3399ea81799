//! How far meshes reach over the figure, and where its plane of symmetry is.

use super::PART_GAP;
use super::facts::{mesh_area, points_on};
use crate::geometry::{Surface, bounds, range};
use crate::rig::UnitFigure;
use crate::rig::front_view::image;
use glam::DVec3;

/// Points on each mesh by which planes of symmetry are compared. Seen: ±30 % changes no mesh.
const PLANE_SAMPLES: usize = 100;

/// So many of the largest meshes are tried as what the plane of symmetry is the middle of. Seen: ±30 % changes no mesh.
const PLANE_CANDIDATES: usize = 6;

/// Slices for the reach of the body, along the height and to each side. One is 0.025 H; `WHOLE_SHARE` says how many may
/// be missing.
pub(super) const SLICES: usize = 40;

/// Half the width in which legs and trunk are looked for, in heights; arms begin beyond. Seen: ±30 % changes no mesh.
pub(super) const TRUNK_HALF_WIDTH: f64 = 0.12;

/// An arm reaches at least this far beyond the trunk, in heights: a trunk that is wider than usual is no arm. Seen:
/// ±30 % changes no mesh.
const LEAST_ARM: f64 = 0.05;

/// The middle of the figure is the plane of symmetry unless another plane scores more than this times as much. Seen:
/// ±30 % changes no mesh.
const CLEARLY_BETTER: f64 = 1.05;

/// The share of slices in which a whole body shows. Seen: at -30 %, six more meshes misjudged; at +30 %, one fewer mesh
/// misjudged before joints are known.
const WHOLE_SHARE: f64 = 0.9;

/// True where those meshes that `some` accepts show in nearly all slices in which those that `whole` accepts do.
pub(super) fn reaches_over(
    figure: &UnitFigure,
    middle: f64,
    some: &dyn Fn(usize) -> bool,
    whole: &dyn Fn(usize) -> bool,
) -> bool {
    let (some, whole) = (slices(figure, middle, some), slices(figure, middle, whole));
    // Each side's half of the trunk and leg, and each arm for itself.
    let shows = some.iter().flatten().any(|&shown| shown);
    shows
        && some.iter().zip(&whole).all(|(some, whole)| {
            let shown = whole.iter().filter(|&&shown| shown).count();
            let both = some.iter().zip(whole).filter(|&(&some, &whole)| some && whole).count();
            both as f64 >= WHOLE_SHARE * shown as f64
        })
}

/// Where triangles are: slices along the height near the middle, and along x beyond; right, then left.
pub(super) type Slices = [[bool; SLICES]; 4];

pub(super) fn slices(figure: &UnitFigure, middle: f64, choose: &dyn Fn(usize) -> bool) -> Slices {
    let widest = figure.positions.iter().map(|p| (p.x - middle).abs()).fold(0.0, f64::max);
    let arm = widest - TRUNK_HALF_WIDTH;
    let mut shown = [[false; SLICES]; 4];
    let slice = |share: f64| ((share * SLICES as f64).max(0.0) as usize).min(SLICES - 1);
    for corners in figure.triangles_where(choose) {
        let corners = corners.map(|vertex| figure.positions[vertex as usize]);
        let (low, high) = bounds(corners);
        let (left, right) = (low.x - middle, high.x - middle);
        for (side, (from, to)) in [(-right, -left), (left, right)].into_iter().enumerate() {
            if to >= 0.0 && from <= TRUNK_HALF_WIDTH {
                shown[side][slice(low.y)..=slice(high.y).max(slice(low.y))].fill(true);
            }
            if to > TRUNK_HALF_WIDTH && arm > LEAST_ARM {
                let from = slice((from - TRUNK_HALF_WIDTH) / arm);
                shown[side + 2][from..=slice((to - TRUNK_HALF_WIDTH) / arm).max(from)].fill(true);
            }
        }
    }
    shown
}

/// The x of the plane in which those meshes that `choose` accepts mirror best: a thing on one side moves the middle of
/// the unit figure, but not the body's.
pub(super) fn middle_plane(figure: &UnitFigure, choose: &dyn Fn(usize) -> bool) -> f64 {
    let meshes: Vec<usize> = (0..figure.mesh_count()).filter(|&mesh| choose(mesh)).collect();
    let surface = Surface::new(&figure.positions, &figure.triangles_where(choose));
    let points: Vec<Vec<(DVec3, DVec3)>> =
        meshes.iter().map(|&mesh| points_on(figure, mesh, PLANE_SAMPLES)).collect();
    let areas: Vec<f64> = meshes.iter().map(|&mesh| mesh_area(figure, mesh)).collect();
    let mut order: Vec<usize> = (0..meshes.len()).collect();
    order.sort_by(|&a, &b| areas[b].total_cmp(&areas[a]).then(a.cmp(&b)));
    let score = |middle: f64| -> f64 {
        let shares = points.iter().zip(&areas).map(|(points, area)| {
            let mirrored =
                points.iter().filter(|(p, _)| surface.is_within(image(*p, middle), PART_GAP / 2.0));
            area * mirrored.count() as f64 / points.len().max(1) as f64
        });
        shares.sum()
    };
    let mut best = (CLEARLY_BETTER * score(0.0), 0.0);
    for &largest in order.iter().take(PLANE_CANDIDATES) {
        let corners = figure.triangles_of(meshes[largest]).iter().flatten();
        let (low, high) = range(corners.map(|&vertex| figure.positions[vertex as usize].x));
        let middle = (low + high) / 2.0;
        let score = score(middle);
        if middle.is_finite() && score > best.0 {
            best = (score, middle);
        }
    }
    best.1
}

/// In how many slices there is something.
pub(super) fn shown_count(slices: &Slices) -> usize {
    slices.iter().flatten().filter(|&&shown| shown).count()
}
