//! Hips over the ground: how they give way to feet that stand where the new legs, of other thighs and shins, would not take them.
//!
//! Somebody who sits down on longer thighs moves the hips further back and keeps the feet. Within a step the same would make hips jerk
//! to and fro twice: there legs give way.

use super::Moment;
use super::plan::Plan;
use glam::DVec3;

/// What hips follow is smoothed over so many seconds (the standard deviation of a bell). Steps take .3 s in a run and .5 in a walk.
const SLOW: f64 = 0.12;

/// A moment at which no foot stands counts so much for staying where the scaled clip has the hips.
const STAY: f64 = 0.05;

/// Two poses are one where no joint of a leg is further off than this share of the height.
const SAME_POSE: f64 = 5e-3;

/// The way of the hips over the ground at each moment.
pub(super) fn sways(plan: &Plan, times: &[f32], moments: &[Moment]) -> Vec<DVec3> {
    let wanted: Vec<(DVec3, f64)> = moments.iter().map(|moment| wanted(plan, moment)).collect();
    let time = |index: usize| f64::from(times[index]);
    let (Some(first), Some(last)) = (moments.first(), moments.last()) else { return Vec::new() };
    let length = time(times.len() - 1) - time(0);
    let loops = length > 0.0 && same_pose(plan, first, last);
    let apart = |one: usize, other: usize| {
        let apart = (time(one) - time(other)).abs();
        if loops { apart.min(length - apart) } else { apart }
    };
    // The last key of a loop is its first one.
    let count = if loops { moments.len() - 1 } else { moments.len() };
    let at = |index: usize| {
        let (mut sum, mut whole) = (DVec3::ZERO, 0.0);
        for (other, (way, stand)) in wanted[..count].iter().enumerate() {
            let near = (-0.5 * (apart(index, other) / SLOW).powi(2)).exp();
            sum += near * stand * *way;
            whole += near * stand.max(STAY);
        }
        sum / whole
    };
    (0..moments.len()).map(at).collect()
}

/// How far the feet that stand would have the hips go, and how much they stand, 0 to 1.
fn wanted(plan: &Plan, moment: &Moment) -> (DVec3, f64) {
    let stand: f64 = moment.feet.iter().map(|foot| foot.stands).sum();
    let way = moment.feet.iter().map(|foot| foot.stands * (foot.goal - foot.bones.ankle)).sum::<DVec3>();
    if stand > 0.0 {
        ((way / stand).reject_from_normalized(plan.up), stand.min(1.0))
    } else {
        (DVec3::ZERO, 0.0)
    }
}

/// True where the legs of two moments are one beside their hips, and these are as high.
fn same_pose(plan: &Plan, first: &Moment, last: &Moment) -> bool {
    let hips = |moment: &Moment| moment.posed.place(plan.hips);
    let legs = |moment: &Moment| {
        let from = hips(moment).reject_from_normalized(plan.up);
        let joints = moment.feet.iter().flat_map(|foot| [foot.bones.hip, foot.bones.knee, foot.bones.ankle]);
        joints.map(|joint| joint - from).collect::<Vec<DVec3>>()
    };
    let pairs = legs(first).into_iter().zip(legs(last));
    pairs.map(|(one, other)| one.distance(other)).all(|apart| apart < SAME_POSE * plan.height)
}
