//! Arms in whatever direction they are held: branches of the solid that end beside the trunk.

use super::arm_curve::{Arm, ArmCurve};
use super::solid::Solid;
use super::solid::branches::Rim;
use crate::geometry::{distinct, median};
use glam::{DVec2, DVec3};

/// A section this much thicker than the ones before it has trunk in it: two readings, for smooth arms and for others.
const WIDENS: [f64; 2] = [1.35, 1.9];
/// A section's thickness is compared with that of so many sections before it.
const BEFORE: usize = 8;
/// A section with trunk in it is thicker than this times the thickest one before it: a wrist is slimmer than the hand was.
const OF_THICKEST: f64 = 1.05;
/// A limb's tip, which grows thicker, has so many sections.
const TIP: usize = 5;
/// A limb has at least so many sections.
const LEAST_RIMS: usize = 10;
/// The line of the upper arm is fitted to this share of the arm's sections.
const UPPER: f64 = 0.4;
/// The line of the upper arm leaves out so many of the last sections, in which the shoulder begins.
const LAST: usize = 2;
/// The shoulder joint lies so many radii further in than the last section.
const SHOULDER_IN: f64 = 0.3;
/// An arm whose upper arm runs down by at least this share of its length may lie on the trunk further up.
const STEEP: f64 = 0.8;
/// The shoulder joint of an arm that runs down steeply lies so many radii under where the arm's line leaves the shoulder.
const UNDER_TOP: f64 = 1.15;
/// The line of an arm that runs down steeply leaves the shoulder within this distance, in heights.
const TOP_WITHIN: f64 = 0.35;

/// The arms that a branch may be, each with whether it is a left one: from its tip, or without a thing in the hand.
pub fn arms_of(branch: &[Rim], axis: f64) -> Vec<(bool, Arm)> {
    let limbs = distinct(WIDENS.into_iter().flat_map(|by| limbs(branch, by)));
    limbs.into_iter().filter_map(|(start, end)| arm_of(&branch[start..end], axis)).collect()
}

/// Half-open ranges of sections between jumps in thickness.
fn limbs(rims: &[Rim], widens: f64) -> Vec<(usize, usize)> {
    let mut limbs = Vec::new();
    let mut start = 0;
    for index in 1..=rims.len() {
        let ends = index == rims.len() || {
            let from = index.saturating_sub(BEFORE).max(start);
            let mut before: Vec<f64> = rims[from..index].iter().map(|rim| rim.radius).collect();
            let thickest = rims[start..index].iter().map(|rim| rim.radius).fold(0.0, f64::max);
            let radius = rims[index].radius;
            index - start >= TIP && radius > widens * median(&mut before) && radius > OF_THICKEST * thickest
        };
        if ends {
            if index - start >= LEAST_RIMS {
                limbs.push((start, index));
            }
            start = index;
        }
    }
    limbs
}

fn arm_of(rims: &[Rim], axis: f64) -> Option<(bool, Arm)> {
    let count = rims.len();
    let first = (count - LAST).saturating_sub(((UPPER * count as f64) as usize).max(3));
    let upper = &rims[first..count - LAST];
    let middle = upper.iter().map(|rim| rim.middle).sum::<DVec3>() / upper.len() as f64;
    let inwards = direction(upper, middle)?;
    let mut radii: Vec<f64> = upper.iter().map(|rim| rim.radius).collect();
    let radius = median(&mut radii);
    let root = middle + inwards * (rims[count - 1].middle - middle).dot(inwards);
    let shoulder = root + inwards * SHOULDER_IN * radius;
    // Where the last sections lie in the trunk, the arm begins at its shoulder.
    let off = |rim: &Rim| rim.middle.distance(shoulder);
    let begin = (count / 2..count).min_by(|&a, &b| off(&rims[a]).total_cmp(&off(&rims[b])))?;
    let within = if off(&rims[begin]) < radius { begin + 1 } else { count };
    let curve = ArmCurve::new(rims[..within].iter().rev().map(|rim| (rim.middle, 4.0 * rim.radius)), 1);
    let pit = DVec2::new((root.x - axis).abs(), root.y - radius);
    Some((shoulder.x > axis, curve.joints(shoulder, -inwards, pit)))
}

/// The line through middles, from the tip inwards: the mean of differences between halves.
fn direction(rims: &[Rim], middle: DVec3) -> Option<DVec3> {
    let half = 0.5 * (rims.len() as f64 - 1.0);
    let differences =
        rims.iter().enumerate().map(|(index, rim)| (index as f64 - half) * (rim.middle - middle));
    differences.sum::<DVec3>().try_normalize()
}

/// An arm that hangs along the trunk with its shoulder joint under the top of the shoulder; `None` where it is there, or the
/// arm does not hang.
pub fn raised(arm: &Arm, solid: &Solid) -> Option<Arm> {
    let inwards = (arm.shoulder - arm.elbow).try_normalize().filter(|way| way.y > STEEP)?;
    // How far the line goes on in the solid.
    let step = 0.5 * solid.cell;
    let steps = (TOP_WITHIN / step) as usize;
    let is_inside = |&index: &usize| solid.is_in(arm.shoulder + inwards * (index as f64 * step));
    let last = (0..steps).take_while(is_inside).count();
    let further = last as f64 * step - UNDER_TOP * arm.radius;
    (last < steps && further > 0.0).then(|| arm.with_shoulder(arm.shoulder + further * inwards))
}
