//! How much each part moves a vertex (product mode).
//!
//! The file's weights are made for animation: creases where they bend, borders where an artist put a joint, another
//! set for each garment. Parts that shrink by different amounts tear such borders open. So the weights are folded
//! into parts, head and neck are parted by the geometry, and then all is smoothed along the surface and across
//! layers of cloth; the file's own weights stay as they are.

use super::anatomy::Anatomy;
use super::part::{Part, PartWeights, TINY, fold_to_parts};
use super::skirt_weights::follow_legs;
use super::smoothing::{Fork, smooth};
use crate::character::{MeshKind, Role};
use crate::error::Result;
use crate::geometry::{Weld, smoothstep};
use crate::progress::Progress;
use crate::shape::figure::Figure;
use glam::DVec3;

/// A component whose mean head weight is above this moves with the head alone, unless [`BODY_DUST`] speaks against it. D26.
const HEAD_ONLY: f32 = 0.6;
/// A component with a vertex that has this much weight of torso or limbs is not the head's alone: what rounding leaves is
/// less.
const BODY_DUST: f32 = 0.01;
/// Where hands (feet) without a joint begin, the weights go over from the lower arm (leg) within this share of the
/// distance on both sides. D26.
const EXTREMITY_BAND: f64 = 0.1;
/// The head begins this far under the chin at the face, and this far above it behind the head joint, as shares of L.
/// D26. Seen: less behind pulls napes down (54 triangles turn over), more leaves them to the neck.
const HEAD_PLANE: (f64, f64) = (-0.02, 0.22);
/// How far behind the head joint the plane has risen, as a share of L. D26. Seen: ±30 % moves napes by up to .007 H.
const HEAD_PLANE_BACK: f64 = 0.35;
/// The neck's weights go over into the head's within half the neck, but at least and at most these shares of L. D26.
/// Seen: the lower one acts on none.
const HEAD_BAND: (f64, f64) = (0.06, 0.2);
/// Below the first of these heights, as shares of the ankle's, leg vertices are the foot's alone; above the second
/// their weights stay. D26. Seen: without the band soles bend by up to .008 H.
const SOLE_BAND: (f64, f64) = (0.15, 0.7);
/// Between these distances from the neck's axis, to the side or behind, what the head moves is hair, as shares of L.
/// D26, for hair that is one mesh with the body. Seen: nearer, necks count as hair.
const HAIR_REACH: (f64, f64) = (0.36, 0.5);
/// From this part of the legs' length under the crotch on, left and right leg have weights of their own. D26. Wide
/// enough for some rows of triangles to lie in between.
const FORK: f64 = 0.15;

/// Each vertex's weights to the parts, and whether the head alone moves it.
///
/// - `members`: the vertices of each connected component of the figure, by `weld`.
/// - `threads`: at most this many, 0 for all cores; the result does not depend on it.
///
/// # Errors
/// `Cancelled`.
pub fn part_weights(
    figure: &Figure,
    anatomy: &Anatomy,
    weld: &Weld,
    members: &[Vec<u32>],
    threads: usize,
    progress: &mut Progress,
) -> Result<(Vec<PartWeights>, Vec<bool>)> {
    let mut parts: Vec<PartWeights> = figure.role_weights.iter().map(|row| fold_to_parts(row)).collect();
    let head_only = head_only(figure, &parts, members);
    let mut fixed = head_only.clone();
    for vertex in 0..parts.len() {
        if anatomy.landmarks.trunk.as_ref().is_some_and(|of_trunk| of_trunk[vertex]) {
            fixed[vertex] = true;
            parts[vertex] = Part::Torso.alone();
        } else if head_only[vertex] {
            let part = if figure.kind(vertex) == MeshKind::Hair { Part::Hair } else { Part::Head };
            parts[vertex] = part.alone();
        } else {
            split_head(&mut parts[vertex], figure.positions[vertex], anatomy);
            split_limbs(&mut parts[vertex], figure.positions[vertex], figure, anatomy);
        }
    }
    mark_hanging_hair(figure, anatomy, members, &head_only, &mut parts);
    let crotch = anatomy.landmarks.heights.crotch;
    let ankles = 0.5 * (anatomy.limbs[2].end.y + anatomy.limbs[3].end.y);
    let fork = Fork { crotch, apart: FORK * (crotch - ankles) };
    follow_legs(figure, fork, &mut parts);
    progress.at(0.1)?;
    smooth(figure, weld, &fixed, fork, &mut parts, threads, &mut progress.part(0.1, 1.0))?;
    for (row, &p) in parts.iter_mut().zip(&figure.positions) {
        settle_soles(row, p, anatomy);
    }
    Ok((parts, head_only))
}

/// Vertices that move with the head alone: components without torso or limb weight whose mean head weight is above
/// [`HEAD_ONLY`], and what is known to be hair or part of the face.
fn head_only(figure: &Figure, parts: &[PartWeights], members: &[Vec<u32>]) -> Vec<bool> {
    let of_head = |vertex: u32| parts[vertex as usize][Part::Head as usize];
    let of_body = |vertex: u32| 1.0 - of_head(vertex) - parts[vertex as usize][Part::Neck as usize];
    let mut head_only: Vec<bool> =
        figure.kinds.iter().map(|&kind| kind == MeshKind::Hair || kind.is_of_face()).collect();
    for members in members {
        let mean = members.iter().map(|&vertex| of_head(vertex)).sum::<f32>() / members.len().max(1) as f32;
        if mean > HEAD_ONLY && members.iter().all(|&vertex| of_body(vertex) < BODY_DUST) {
            members.iter().for_each(|&vertex| head_only[vertex as usize] = true);
        }
    }
    head_only
}

/// A piece of the head that hangs down to the shoulders is hair.
fn mark_hanging_hair(
    figure: &Figure,
    anatomy: &Anatomy,
    members: &[Vec<u32>],
    head_only: &[bool],
    parts: &mut [PartWeights],
) {
    let shoulder_line = anatomy.landmarks.heights.shoulder_line;
    let hangs = |members: &&Vec<u32>| {
        members.iter().all(|&vertex| head_only[vertex as usize])
            && members.iter().any(|&vertex| figure.positions[vertex as usize].y < shoulder_line)
    };
    for members in members.iter().filter(hangs) {
        for &vertex in members {
            if matches!(figure.kind(vertex as usize), MeshKind::Body | MeshKind::Garment) {
                parts[vertex as usize] = Part::Hair.alone();
            }
        }
    }
}

/// Head and neck by a plane through the chin that rises to the nape, not by the rig's weights.
fn split_head(parts: &mut PartWeights, p: DVec3, anatomy: &Anatomy) {
    let both = parts[Part::Head as usize] + parts[Part::Neck as usize];
    if both <= 0.0 {
        return;
    }
    let heights = anatomy.landmarks.heights;
    let chin = heights.chin;
    let length = heights.head_length();
    let back = anatomy.head_joint.z - HEAD_PLANE_BACK * length;
    let front = anatomy.head_centre.z.max(anatomy.head_joint.z) + HEAD_PLANE_BACK * length;
    let rise = ((front - p.z) / (front - back)).clamp(0.0, 1.0);
    let plane = chin + length * (HEAD_PLANE.0 + rise * (HEAD_PLANE.1 - HEAD_PLANE.0));
    let band = ((chin - heights.shoulder_line) / 2.0).clamp(HEAD_BAND.0 * length, HEAD_BAND.1 * length);
    let share = smoothstep((p.y - plane) / band + 1.0) as f32;
    // Hair that is one mesh with the body: what the file gives to the head and what hangs beside or behind the neck,
    // further out than a neck reaches.
    let neck_z = anatomy.centre_z(heights.shoulder_line).0.min(anatomy.head_joint.z);
    let out = DVec3::new(p.x - anatomy.middle_x, 0.0, (p.z - neck_z).min(0.0)).length() / length;
    let of_head = (parts[Part::Head as usize] / both)
        * smoothstep((out - HAIR_REACH.0) / (HAIR_REACH.1 - HAIR_REACH.0)) as f32;
    let below = both * (1.0 - share);
    parts[Part::Head as usize] = both * share;
    parts[Part::Neck as usize] = below * (1.0 - of_head);
    parts[Part::Hair as usize] = below * of_head;
}

/// Lower arms, hands, shins and feet that the rig has no joint for take their weights from the geometry.
fn split_limbs(parts: &mut PartWeights, p: DVec3, figure: &Figure, anatomy: &Anatomy) {
    for (number, limb) in anatomy.limbs.iter().enumerate() {
        let is_arm = number < 2;
        let roles =
            if is_arm { [Role::LeftLowerArm, Role::LeftHand] } else { [Role::LeftLowerLeg, Role::LeftFoot] };
        let joints = [(limb.root, limb.middle), (limb.middle, limb.end)];
        for (index, (from, to)) in joints.into_iter().enumerate() {
            let role = roles[index].on_side(number % 2 == 0);
            let weight = parts[limb.parts[index]];
            if figure.humanoid.has(role) || weight <= 0.0 {
                continue;
            }
            let along = to - from;
            let past = (p - to).dot(along) / along.length_squared().max(TINY);
            let share = smoothstep(past / (2.0 * EXTREMITY_BAND) + 0.5) as f32;
            parts[limb.parts[index]] = weight * (1.0 - share);
            parts[limb.parts[index + 1]] += weight * share;
        }
    }
}

/// Near the ground a leg is foot and nothing else: what smoothing left of the shin in the heels would bend the soles.
fn settle_soles(parts: &mut PartWeights, p: DVec3, anatomy: &Anatomy) {
    for leg in &anatomy.limbs[2..] {
        let ankle = leg.end.y - anatomy.landmarks.heights.sole;
        let low = (p.y - anatomy.landmarks.heights.sole) / ankle.max(TINY);
        let share = smoothstep((SOLE_BAND.1 - low) / (SOLE_BAND.1 - SOLE_BAND.0)) as f32;
        if share > 0.0 {
            let [upper, lower, foot] = leg.parts;
            let moved = share * (parts[upper] + parts[lower]);
            parts[upper] *= 1.0 - share;
            parts[lower] *= 1.0 - share;
            parts[foot] += moved;
        }
    }
}
