//! Body weights through a voxel volume, for open bodies.
//!
//! Dionne and de Lasa. Geodesic voxel binding for production character meshes. SCA 2013 (reference 14).

use super::solid::geodesic::{Bone, Distances, Paths, place_bones};
use super::solid::{Solid, Voxels};
pub use super::wholeness::heat_would_be_poor;
use super::{WeightBone, WeightSet};
use crate::character::Weights;
use crate::error::Result;
use crate::geometry::{NONE, Rows, by_number, double_area};
use crate::parallel;
use crate::progress::Progress;
use crate::room::{self, Of};
use glam::{DVec3, IVec3};
use std::collections::BTreeMap;

/// What the volume can be told.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VoxelOptions {
    /// Voxels along the longest side, 16 to 512.
    pub resolution: usize,
    /// How fast weights fall off beyond a limb's radius, 0..1; up to there it makes no difference.
    pub falloff: f64,
    /// Threads to use; 0 means all cores.
    pub thread_count: usize,
}

impl Default for VoxelOptions {
    /// 128 voxels, a falloff of 0.2 (as the paper), all cores.
    fn default() -> Self {
        Self { resolution: 128, falloff: FALLOFF, thread_count: 0 }
    }
}

/// How fast weights fall off where nobody says. As Dionne and de Lasa, 2013.
const FALLOFF: f64 = 0.2;

/// A vertex in a part of the volume that no bone is in: it follows the nearest part that one is in.
pub const VOLUME_APART: &str = "volume_apart";

/// A vertex that no bone reaches follows the nearest.
pub const NEAREST_BONE: &str = "nearest_bone";

/// A weight is left out below this share of the vertex's largest, and all are lowered by it, so that none jumps. Seen:
/// at ±30 %, vertices move up to 0.001 H.
const LEAST_SHARE: f64 = 0.02;
/// How far the border between two bones is rounded off, in limb radii: distances of two bones grow apart with the
/// square of the way from the border on a limb, but with its root between two limbs; rounding makes both nearly
/// straight. Seen: at ±30 %, vertices move up to 0.001 H.
const ROUNDING: f64 = 0.3;
/// Radii and widths are at least this, in voxels. Seen: ±30 % moves no vertex.
const LEAST_RADIUS: f64 = 0.05;
/// How sharply the radius around a vertex is that of its nearest bone: a power of distance. Seen: at ±30 %, vertices
/// move up to 0.001 H.
const OWNERSHIP: i32 = 8;

/// Weights of all `positions` to the joints of `bones`: `joint` 0 where there is no bone at all.
///
/// Positions and bones are in one space in which the figure is about 1 high. No edges are needed: equal positions have
/// equal weights.
///
/// With d the distance of a bone through the volume and r the limb's radius, a bone's weight falls with its lag behind
/// the nearest bone: sqrt(d^2 - d_nearest^2) / r, which on a limb is how far beyond the joint a vertex lies, in radii.
/// The paper's 1 / ((1 - a) d + a d^2)^2 of plain distances never gets near 0: every bone would move every vertex, and
/// a transition would be four radii wide. Here exp(-((1 - a) lag + a lag^2)) takes its place, which for a = 0 is what
/// heat does on a tube: half a radius around the joint.
///
/// # Errors
/// `Cancelled`, `OutOfMemory`.
///
/// O(voxels · bones in reach · log voxels), a few megabytes at 128 voxels.
pub fn voxel_weights(
    positions: &[DVec3],
    triangles: &[[u32; 3]],
    bones: &[WeightBone],
    options: &VoxelOptions,
    progress: &mut Progress,
) -> Result<WeightSet> {
    let with_segments = bones.iter().filter(|bone| !bone.segments.is_empty());
    let (joints, segments): (Vec<u32>, Vec<_>) =
        with_segments.map(|bone| (bone.joint, bone.segments.clone())).unzip();
    if joints.is_empty() || positions.is_empty() {
        let joint = bones.first().map_or(0, |bone| bone.joint);
        return Ok(WeightSet { weights: Weights::rigid(joint, positions.len()), fallback: BTreeMap::new() });
    }
    let resolution = options.resolution.clamp(16, 512);
    let volume = Voxels::of(Solid::of_body(positions, triangles, resolution)?);
    // The waves of all bones together, and those that threads make of one each.
    let waves = 1 + parallel::thread_count(options.thread_count).min(joints.len());
    room::ask(Of::Wave, waves * volume.cells.len())?;
    progress.at(0.3)?;
    let bones = place_bones(&volume, &segments);
    let paths = Paths::new(&volume, &bones)?;
    let falloff = if options.falloff.is_finite() { options.falloff.clamp(0.0, 1.0) } else { FALLOFF };
    let profile = Profile::new(falloff);

    let points: Vec<DVec3> =
        positions.iter().map(|&p| volume.solid.within(volume.solid.to_cells(p))).collect();
    let slots: Vec<u32> = points.iter().map(|&p| volume.slot(volume.solid.nearest(p))).collect();
    progress.at(0.4)?;
    let distances = &mut progress.part(0.4, 0.9);
    let rows = distance_rows(&paths, &bones, &points, &slots, &profile, options.thread_count, distances)?;
    let mut radii = radii(&points, triangles, &rows, bones.len());
    for (radius, bone) in radii.iter_mut().zip(&bones) {
        // Folds inside the body are no limb's surface; so what is filled around the bone counts as well.
        *radius = radius.max(bone.thickness(&volume));
        // Blended over more than half its length, a bone would nowhere move what is its own.
        if bone.length() > 0.0 {
            *radius = radius.min(bone.length() / 2.0);
        }
        *radius = radius.max(LEAST_RADIUS);
    }
    let weigh = |vertex: usize| -> Vec<(u32, f32)> {
        let row = rows.of(vertex);
        let mut weights: Vec<(u32, f32)> = Vec::with_capacity(row.len());
        if row.is_empty() {
            return vec![(joints[nearest_bone(&bones, points[vertex])], 1.0)];
        }
        for (bone, weight) in profile.weights(row, &radii) {
            // Two bones may move with one joint.
            let joint = joints[bone as usize];
            match weights.iter_mut().find(|(other, _)| *other == joint) {
                Some((_, sum)) => *sum += weight as f32,
                None => weights.push((joint, weight as f32)),
            }
        }
        weights
    };
    let weights = Weights::from_rows(parallel::collect(options.thread_count, points.len(), 1000, weigh));
    let apart = slots.iter().filter(|&&slot| paths.is_apart[slot as usize]).count();
    let unreached = (0..points.len()).filter(|&vertex| rows.of(vertex).is_empty()).count();
    let counts = [(VOLUME_APART, apart), (NEAREST_BONE, unreached)];
    let fallback = counts.into_iter().filter(|&(_, count)| count > 0).collect();
    progress.at(1.0)?;
    Ok(WeightSet { weights, fallback })
}

/// The bone that is closest to `p`, whatever lies between.
pub(super) fn nearest_bone(bones: &[Bone], p: DVec3) -> usize {
    let distance = |bone: usize| bones[bone].foot(p).distance_squared(p);
    (0..bones.len()).min_by(|&one, &other| distance(one).total_cmp(&distance(other))).unwrap_or(0)
}

/// For each vertex the distances of the bones in reach, in voxels.
fn distance_rows(
    paths: &Paths,
    bones: &[Bone],
    points: &[DVec3],
    slots: &[u32],
    profile: &Profile,
    thread_count: usize,
    progress: &mut Progress,
) -> Result<Rows<(u32, f32)>> {
    let volume = paths.volume;
    let mut nearest = Distances::new(volume.cells.len());
    nearest.spread(paths, bones, 0..bones.len(), |_| f32::INFINITY);
    // How wide each bone's part of the volume is at most: a bound for how far others must look.
    let mut widest = vec![0.0f32; bones.len()];
    for slot in 0..volume.cells.len() as u32 {
        if nearest.is_reached(slot) {
            let width = &mut widest[nearest.bones[slot as usize] as usize];
            *width = width.max(nearest.lengths[slot as usize]);
        }
    }
    let bound = |bone: usize| {
        let half = bones[bone].length() as f32 / 2.0;
        let widest = widest[bone].max(1.0);
        if half > 0.0 { half.min(widest) } else { widest }
    };
    // A thin neck must be known wherever the chest below it is, for it narrows the chest's reach.
    let touching = |bone: usize| {
        (0..bones.len()).filter(move |&other| bones[other].touches(&bones[bone], crate::geometry::ROUNDING))
    };
    let bounds: Vec<f32> =
        (0..bones.len()).map(|bone| touching(bone).map(bound).fold(bound(bone), f32::max)).collect();
    progress.at(0.2)?;
    let columns = progress.part(0.2, 0.9).collect_with(
        thread_count,
        bones.len(),
        1,
        || Distances::new(volume.cells.len()),
        |distances, bone| {
            let radius = bounds[bone];
            let limit = |slot: u32| {
                let least = nearest.lengths[slot as usize];
                // A bone's radius is seldom less than a quarter of how wide its part is.
                let own = widest[nearest.bones[slot as usize] as usize] / 4.0;
                let spread = (least / own.max(1.0)).max(1.0).sqrt();
                let beyond = profile.reach as f32 * radius * spread;
                (least * least + beyond * beyond).sqrt() + 2.0
            };
            distances.spread(paths, bones, std::iter::once(bone), limit);
            let reached =
                (0u32..).zip(slots).zip(points).filter(|&((_, &slot), _)| distances.is_reached(slot));
            let length = |p: DVec3| distance_at(volume, distances, &bones[bone], p);
            reached.map(|((vertex, _), &p)| (vertex, length(p))).collect::<Vec<(u32, f32)>>()
        },
    )?;
    let entries = (0u32..)
        .zip(&columns)
        .flat_map(|(bone, column)| column.iter().map(move |&(vertex, length)| (vertex, (bone, length))));
    Ok(by_number(points.len(), entries))
}

/// The distance of a bone from `p`: of the voxels around it those that see the bone give the straight distance from `p`
/// itself, the others their own.
fn distance_at(volume: &Voxels, distances: &Distances, bone: &Bone, p: DVec3) -> f32 {
    let straight = p.distance(bone.foot(p));
    let corner = p.floor();
    let share = p - corner;
    let (mut sum, mut total) = (0.0, 0.0);
    for i in 0..8 {
        let offset = IVec3::new(i & 1, i >> 1 & 1, i >> 2);
        let slot = volume.slot(corner.as_ivec3() + offset);
        if slot == NONE || !distances.is_reached(slot) {
            continue;
        }
        let far = offset.as_dvec3();
        let share = (far * share + (1.0 - far) * (1.0 - share)).element_product();
        let length = f64::from(distances.lengths[slot as usize]);
        sum += share * if distances.is_straight(slot) { straight } else { length };
        total += share;
    }
    // p lies in the middle of the voxel that was reached, or within an eighth's share of it.
    (sum / total) as f32
}

/// For each bone how far away, in voxels, the surface is on which it is the nearest: the median over the area as seen from
/// the bone, so that neither a wing nor a joint under the skin counts for more than the limb itself.
fn radii(points: &[DVec3], triangles: &[[u32; 3]], rows: &Rows<(u32, f32)>, bone_count: usize) -> Vec<f64> {
    let mut areas = vec![0.0; points.len()];
    for triangle in triangles {
        let third = double_area(points, *triangle).length() / 6.0;
        for &vertex in triangle {
            areas[vertex as usize] += third;
        }
    }
    // Where nothing has an area, vertices count alike.
    let least = 1e-9 * areas.iter().sum::<f64>().max(1e-9) / points.len() as f64;
    let mut samples: Vec<Vec<(f32, f64)>> = vec![Vec::new(); bone_count];
    for (vertex, area) in areas.iter().enumerate() {
        let row = rows.of(vertex);
        let nearest = nearest_length(row);
        for &(bone, length) in row {
            // Seen from the bone an area is the smaller the further away it is; a voxel away, it fills the view.
            let view = (area + least) / (1.0 + f64::from(length)).powi(2);
            samples[bone as usize].push((length, view * ownership(nearest, f64::from(length))));
        }
    }
    samples.into_iter().map(median_by_share).collect()
}

/// The length that half of the shares lie below; 0 where there is none.
fn median_by_share(mut samples: Vec<(f32, f64)>) -> f64 {
    samples.sort_by(|one, other| one.0.total_cmp(&other.0).then(one.1.total_cmp(&other.1)));
    let half = samples.iter().map(|(_, share)| share).sum::<f64>() / 2.0;
    let mut below = 0.0;
    for (length, share) in samples {
        below += share;
        if below >= half {
            return f64::from(length);
        }
    }
    0.0
}

fn nearest_length(row: &[(u32, f32)]) -> f64 {
    row.iter().fold(f64::INFINITY, |least, &(_, length)| least.min(f64::from(length)))
}

/// 1 for the nearest bone, less for the others.
fn ownership(nearest: f64, length: f64) -> f64 {
    ((nearest + 1e-6) / (length + 1e-6)).powi(OWNERSHIP)
}

/// How a weight falls with the lag.
struct Profile {
    falloff: f64,
    /// This far beyond the border, in radii, a weight is 0.
    reach: f64,
}

impl Profile {
    fn new(falloff: f64) -> Self {
        // (1 - a) lag + a lag^2 at which the share is the least.
        let exponent = ((1.0 + LEAST_SHARE) / (2.0 * LEAST_SHARE)).ln();
        let straight = 1.0 - falloff;
        let lag = if falloff > 0.0 {
            ((straight * straight + 4.0 * falloff * exponent).sqrt() - straight) / (2.0 * falloff)
        } else {
            exponent
        };
        let way = lag * Self::scale() + ROUNDING;
        let reach = (way * way - ROUNDING * ROUNDING).sqrt();
        Self { falloff, reach }
    }

    /// Makes the lag 1 at one radius from the border.
    fn scale() -> f64 {
        (1.0 + ROUNDING * ROUNDING).sqrt() - ROUNDING
    }

    /// A bone's weight against that of the nearest.
    fn share(&self, nearest: f64, length: f64, radius: f64) -> f64 {
        let beyond = ((length - nearest) * (length + nearest)).max(0.0) / (radius * radius);
        let lag = ((beyond + ROUNDING * ROUNDING).sqrt() - ROUNDING) / Self::scale();
        let heat = (-((1.0 - self.falloff) * lag + self.falloff * lag * lag)).exp();
        (heat / (2.0 - heat) - LEAST_SHARE).max(0.0) / (1.0 - LEAST_SHARE)
    }

    /// The weights of a vertex, sum 1, from its distances.
    fn weights<'a>(
        &'a self,
        row: &'a [(u32, f32)],
        radii: &'a [f64],
    ) -> impl Iterator<Item = (u32, f64)> + 'a {
        let nearest = nearest_length(row);
        let (mut sum, mut total) = (0.0, 0.0);
        for &(bone, length) in row {
            let share = ownership(nearest, f64::from(length));
            sum += share * radii[bone as usize];
            total += share;
        }
        // Far from every bone it is wider, by so much that weights stay what they are along a thing whose only way to all
        // bones leads through one place: there the distances differ by a constant c, and the lag is sqrt(2 c d) / radius.
        let spread = (nearest / (sum / total)).max(1.0).sqrt();
        let share = move |&(bone, length): &(u32, f32)| {
            // A transition is as wide as the thinnest limb on the way, which is one of those that are nearer: a head as
            // large as a trunk begins at a thin neck.
            let radius = row.iter().fold(f64::INFINITY, |least, &(other, before)| {
                least.min(radii[other as usize] / ownership(f64::from(length), f64::from(before.max(length))))
            });
            (bone, self.share(nearest, f64::from(length), radius * spread))
        };
        let total: f64 = row.iter().map(|entry| share(entry).1).sum();
        row.iter().map(share).map(move |(bone, weight)| (bone, weight / total))
    }
}
