//! Measures a body: bone lengths and surrounding-mesh radii by rays (§V-A, Fig. 5).
//!
//! Lopez and Poirel. Raycast based auto-rigging method for humanoid meshes. SIGGRAPH 2013 Posters.

use super::{BodyShape, BoneShape};
use crate::character::Role;
use crate::character::bones::{Bone, HEAD_TOP};
use crate::error::{Error, ErrorKind, Result};
use crate::geometry::{Surface, mean, median};
use crate::options::table::{FEWEST_RAYS, PAPER_RAYS};
use glam::DVec3;
use std::collections::BTreeMap;
use std::f64::consts::{FRAC_PI_3, TAU};

/// Axes that tie but for rounding must tie, or the left and the right arm's rays would begin differently.
const TIE: f64 = 1e-9;
/// Where along a bone the samples lie: the paper's "three points at a uniform interval" (V-A), away from the joints,
/// where limbs meet. D4.
pub const SAMPLES: [f64; 3] = [0.25, 0.5, 0.75];

/// A sample with fewer hits than this has no centroid worth the name.
const LEAST_HITS: usize = FEWEST_RAYS as usize;

/// A set of meshes surrounds a bone where this share of each sample's rays meets it. D5: 9 of the paper's 12.
const ENOUGH_HITS: f64 = 0.75;

/// Measures a body: the length of every bone and the radius of the mesh around it.
///
/// Paper: §V-A, Fig. 5.
///
/// - `joints`: where the roles of `bones` are; `head_top`: the head bone's end. Any unit.
/// - `surfaces`: sets of meshes in rest pose, from narrow to wide (body; body and garments). Each bone takes the first
///   set that surrounds it, else the last one.
/// - `rays`: around each sample, at least 3; the paper's 12, or more against the phase of the ring.
/// - Returns one length and one radius per bone, in the units of the joints; no name, landmarks or parts.
///
/// Rays that meet nothing are left out; a bone without a valid sample, or of length 0, has no radius.
///
/// # Errors
/// `BadOption` for fewer than 3 rays; `NoGeometry` where all surfaces are empty; `NoHumanoid` where a joint is missing.
pub fn measure(
    bones: &[Bone],
    joints: &BTreeMap<Role, DVec3>,
    head_top: DVec3,
    surfaces: &[&Surface],
    rays: usize,
) -> Result<BodyShape> {
    if rays < LEAST_HITS {
        let message =
            format!("{rays} rays around a bone: at least {LEAST_HITS} are needed; {PAPER_RAYS} is usual");
        return Err(Error::new(ErrorKind::BadOption, message).about("rays"));
    }
    if surfaces.iter().all(|surface| surface.is_empty()) {
        let message = "there are no triangles to measure: give at least one mesh";
        return Err(Error::new(ErrorKind::NoGeometry, message));
    }
    let joint = |role: Role| {
        joints.get(&role).copied().ok_or_else(|| {
            let message = format!("a bone ends at the role {role}, but no joint is known for it: name one");
            Error::new(ErrorKind::NoHumanoid, message)
        })
    };
    let mut shapes = BTreeMap::new();
    for bone in bones {
        let parent = joint(bone.parent)?;
        let child = bone.child.map_or(Ok(head_top), joint)?;
        let shape =
            BoneShape { length: parent.distance(child), radius: radius(parent, child, surfaces, rays) };
        shapes.insert(bone.key().to_string(), shape);
    }
    Ok(BodyShape {
        head_length: shapes.get(HEAD_TOP).map_or(0.0, |head| head.length),
        bones: shapes,
        ..BodyShape::default()
    })
}

/// r_i: the mean over the bone's samples of the mean distance between the hits around a sample and their centroid.
///
/// `surfaces` and the result as in [`measure`].
pub fn radius(parent: DVec3, child: DVec3, surfaces: &[&Surface], rays: usize) -> Option<f64> {
    let ring = ring(child - parent, rays)?;
    let mut measured = None;
    for surface in surfaces {
        let samples = SAMPLES.map(|t| sample(surface, parent.lerp(child, t), &ring));
        measured = mean(samples.iter().filter_map(|sample| sample.1));
        let surrounded = |hit_count: usize| hit_count as f64 >= ENOUGH_HITS * rays as f64;
        if samples.iter().all(|&(hit_count, _)| surrounded(hit_count)) {
            break;
        }
    }
    measured
}

/// Directions orthogonal to `along`, equiangular. `None` where `along` has no direction.
///
/// They begin at the world axis least parallel to the bone, crossed with the bone: 12 rays see a radius that changes by
/// up to 16 % with the phase of the ring, so the phase must not depend on chance.
fn ring(along: DVec3, rays: usize) -> Option<Vec<DVec3>> {
    let along = along.try_normalize()?;
    let least = along.abs().min_element();
    let axis = DVec3::AXES.into_iter().find(|axis| axis.dot(along).abs() <= least + TIE)?;
    let start = axis.cross(along).normalize();
    let side = along.cross(start);
    let turn = TAU / rays as f64;
    let angles = (0..rays).map(|ray| (turn * ray as f64).sin_cos());
    Some(angles.map(|(sin, cos)| cos * start + sin * side).collect())
}

/// The number of hits around `point`, and their mean distance to their centroid.
fn sample(surface: &Surface, point: DVec3, ring: &[DVec3]) -> (usize, Option<f64>) {
    let met = |&direction: &DVec3| {
        surface.first_hit(point, direction, f64::INFINITY).map(|hit| point + hit.t * direction)
    };
    let hits: Vec<DVec3> = ring.iter().filter_map(met).collect();
    let count = hits.len() as f64;
    let centroid = hits.iter().sum::<DVec3>() / count;
    let mean = hits.iter().map(|hit| hit.distance(centroid)).sum::<f64>() / count;
    (hits.len(), (hits.len() >= LEAST_HITS).then_some(mean))
}

/// Where the head ends, straight above its joint.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HeadTop {
    /// The head top; `None` where no ray met the surface.
    pub point: Option<DVec3>,
    /// How many of the 7 rays met the surface.
    pub hit_count: usize,
}

/// The head top: straight above the head joint, at the median height of what 7 rays from above meet first: one over the
/// joint and a ring of 6 at a quarter of the head's half width.
///
/// No rig standard has this joint, which l_head of Eq. 4 needs. Rays from above see the skull or the hair, not the face mesh
/// inside; the median passes over a horn or a parting.
///
/// - `surface`: the meshes of the head. Few hits tell that the skull is in another mesh, such as the hair: try again
///   with it.
/// - `head`: the head joint, y up; hits below it do not count. `half_width`: half the width of the head, in the same units.
/// - `above`: a height above all of the head.
pub fn head_top(surface: &Surface, head: DVec3, half_width: f64, above: f64) -> HeadTop {
    let mut heights: Vec<f64> = (0..7)
        .filter_map(|ray| {
            let reach = if ray == 0 { 0.0 } else { half_width / 4.0 };
            let (sin, cos) = (FRAC_PI_3 * f64::from(ray)).sin_cos();
            let origin = DVec3::new(head.x + reach * cos, above, head.z + reach * sin);
            surface.first_hit(origin, DVec3::NEG_Y, f64::INFINITY).map(|hit| above - hit.t)
        })
        .filter(|&y| y > head.y)
        .collect();
    let hit_count = heights.len();
    let point = (hit_count > 0).then(|| head.with_y(median(&mut heights)));
    HeadTop { point, hit_count }
}
