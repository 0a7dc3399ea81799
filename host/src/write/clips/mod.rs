//! A file's own clips on the new body: what stood on the floor stands on it.
//!
//! Turns stay as they are, and legs have other lengths: hips that are only carried by their height would let feet hover, dip
//! into the floor and slide. So clips are given to the new body as they would be to another one:
//!
//! 1. Everything that travels is scaled by the legs' length.
//! 2. Each foot keeps its height above the floor, in legs' lengths, and near the floor its way over the ground: hip, knee and
//!    ankle turn for it ([`leg`]). Feet that hang from no shin (baked from controls) are carried by theirs.
//! 3. Hips go up and down with the feet that stand, so that knees bend as they did, and are as high as the scaled clip has them
//!    where none does; over the ground they sway with these slowly ([`sway`]). They sink where a
//!    foot on the floor is out of reach, and rise where it is too near; where trunk or knees lie on the floor, these keep their
//!    height above it.
//!
//! What is set so is put into keys at every frame; a clip that needs none of this keeps its keys.

mod foot;
mod leg;
mod plan;
mod sway;
mod touch;
mod track;

use super::MapPoint;
use super::nodes::Shift;
use crate::accessor::Reader;
use crate::load::Loaded;
use foot::{Foot, Frame, Stance};
use glam::{DMat4, DQuat, DVec3};
use plan::{Limb, Plan};
use std::collections::BTreeMap;
use superdeform::{Deformed, Result};
use track::{Clip, Local, Posed};

/// What is less than this share of the figure's height is no change: single precision holds no more for long.
const NOTHING: f64 = 1e-4;

/// How often soles are looked at and set right. Seen: with none feet are off by 1 % of the height, with one by .3, with two by .1.
const CORRECTIONS: usize = 2;

/// How often the share of a turn is halved: down to a thousandth.
const HALVINGS: usize = 10;

/// The trunk rests on the floor below the first of these heights, in legs' lengths, and is free above the second. A chair's seat
/// is at .5.
const SEAT: [f64; 2] = [0.05, 0.2];

/// Keys of a clip that take the place of the file's.
#[derive(Clone, Debug, Default)]
pub(super) struct NewTracks {
    /// In seconds.
    pub(super) times: Vec<f32>,
    /// Whether values stay from key to key.
    pub(super) steps: bool,
    /// Places in the parent's space, by node.
    pub(super) places: BTreeMap<usize, Vec<DVec3>>,
    /// Turns in the parent's space, by node.
    pub(super) turns: BTreeMap<usize, Vec<DQuat>>,
}

/// How lengths of clips change.
pub(super) struct Retarget<'a> {
    loaded: &'a Loaded,
    map_point: &'a MapPoint<'a>,
    shifts: &'a BTreeMap<usize, Shift>,
    plan: Option<Plan>,
    /// By what all that travels is scaled: new over old length of the legs, or height of the hips where legs are not
    /// known.
    pub(super) stride: f64,
}

impl<'a> Retarget<'a> {
    /// What the clips of `loaded` need.
    pub(super) fn new(
        loaded: &'a Loaded,
        deformed: &Deformed,
        new_rest: &[DMat4],
        shifts: &'a BTreeMap<usize, Shift>,
        map_point: &'a MapPoint<'a>,
    ) -> Self {
        let wanted = loaded.rigged && !shifts.is_empty() && !loaded.file.list("animations").is_empty();
        let plan = if wanted { Plan::of(loaded, deformed, new_rest) } else { None };
        let stride = match &plan {
            Some(plan) => plan.stride,
            None => plan::hip_ratio(loaded, deformed),
        };
        let mut retarget = Self { loaded, map_point, shifts, plan: None, stride };
        if let Some(mut plan) = plan {
            plan.scales = (0..plan.locals.len()).map(|node| retarget.scale_of(node)).collect();
            retarget.plan = Some(plan);
        }
        retarget
    }

    /// By what a node's way from its place at rest is scaled: by the stride for the hips, for what does not hang from them (a root
    /// that travels, feet that a clip places by themselves) and for legs; by the field for what moves within the body (eyelids, a
    /// jaw).
    pub(super) fn scale_of(&self, node: usize) -> f64 {
        let hips = plan::hips_node(self.loaded);
        let within = hips.is_some_and(|hips| node != hips && plan::is_within(self.loaded, node, hips));
        match self.loaded.joint_of_node[node] {
            Some(joint) if within && !plan::is_of_leg(self.loaded, node) => {
                (self.map_point)(joint, self.loaded.character.skeleton.joints[joint].position()).local_scale()
            }
            _ => self.stride,
        }
    }

    /// What takes the place of some tracks of an animation; `None` where its keys do.
    ///
    /// # Errors
    /// As [`Reader::floats`].
    pub(super) fn tracks(&self, animation: usize, reader: &Reader) -> Result<Option<NewTracks>> {
        let Some(plan) = &self.plan else { return Ok(None) };
        let clip = Clip::read(self.loaded, animation, reader)?;
        if !plan.moved_by(self.loaded, &clip) {
            return Ok(None);
        }
        let (times, steps) = clip.moments();
        let moments: Vec<Moment> = times.iter().map(|&time| self.moment(plan, &clip, time)).collect();
        let sways = sway::sways(plan, &times, &moments);
        let mut made = NewTracks { times, steps, ..NewTracks::default() };
        let mut most: f64 = 0.0;
        for (moment, sway) in moments.into_iter().zip(sways) {
            let frame = moment.frame(self.loaded, plan, sway);
            most = most.max(frame.change);
            for (node, place) in frame.places {
                made.places.entry(node).or_default().push(place);
            }
            for (node, turn) in frame.turns {
                let turns = made.turns.entry(node).or_default();
                // The same turn has two signs; neighbouring keys have one, so that nobody goes the long way.
                let same = turns.last().is_none_or(|last| last.dot(turn) >= 0.0);
                turns.push(if same { turn } else { -turn });
            }
        }
        Ok((most > NOTHING * plan.height).then_some(made))
    }

    /// The new body's nodes at a moment, each as the clip has it but for its length.
    fn plain(&self, clip: &Clip, plan: &Plan, time: f32) -> [Vec<Local>; 2] {
        let before: Vec<Local> =
            plan.locals.iter().enumerate().map(|(node, &rest)| clip.local(node, rest, time)).collect();
        let mut after = before.clone();
        for (node, (_, _, place)) in after.iter_mut().enumerate() {
            let (from, to) = match self.shifts.get(&node) {
                Some(shift) => (shift.before, shift.after),
                None => (plan.rest_places[node], plan.rest_places[node]),
            };
            if clip.places.contains_key(&node) {
                *place = to + (*place - from) * plan.scales[node];
            } else {
                *place += to - from;
            }
        }
        [before, after]
    }

    /// The new body at a moment as the clip has it, but for loose feet; and where its feet are to be.
    fn moment(&self, plan: &Plan, clip: &Clip, time: f32) -> Moment {
        let [before, mut local] = self.plain(clip, plan, time);
        let before = Posed::of(self.loaded, &before);
        let moves_before = moves(&before, &plan.rest_inverse);
        let stances: Vec<Stance> =
            plan.legs.iter().map(|leg| Stance::of(plan, leg, &before, &moves_before)).collect();
        let after = Posed::of(self.loaded, &local);
        let mut change: f64 = 0.0;
        for leg in plan.legs.iter().filter(|leg| leg.loose) {
            // Where its shin takes it, whatever its keys say, which are of another leg.
            local[leg.foot].2 = after.in_parent(self.loaded, leg.foot, leg.carried_to(plan, &before, &after));
            change = f64::INFINITY;
        }
        let posed = Posed::of(self.loaded, &local);
        let moves_after = moves(&posed, &plan.new_inverse);
        let legs = plan.legs.iter().zip(&stances);
        let feet =
            legs.map(|(leg, stance)| Foot::of(plan, leg, stance, &posed, [&moves_before, &moves_after]));
        let feet = feet.collect();
        let lowest = |side: usize, moves: &[DMat4]| {
            let heights = plan.trunk.iter().map(|point| point.at(side, moves).dot(plan.up));
            heights.fold(f64::INFINITY, f64::min) - plan.floor[side]
        };
        let was = lowest(0, &moves_before);
        let rests = 1.0 - smooth(was / plan.leg_length, SEAT);
        let seat = if rests > 0.0 { plan.stride * was - lowest(1, &moves_after) } else { 0.0 };
        Moment { local, posed, feet, rests, seat, change }
    }
}

/// The new body at a moment, before its hips and legs are set.
struct Moment {
    local: Vec<Local>,
    posed: Posed,
    feet: Vec<Foot>,
    /// 1 where the trunk rests on the floor, and how far up it is to go then.
    rests: f64,
    seat: f64,
    /// How far something is by now from where its own keys have it, model units.
    change: f64,
}

impl Moment {
    /// What is set; `sway`: how far the hips go over the ground from where the scaled clip has them.
    fn frame(mut self, loaded: &Loaded, plan: &Plan, sway: DVec3) -> Frame {
        self.feet.iter_mut().for_each(|foot| foot.carry(sway));
        let shift = self.lift(plan) * plan.up;
        self.feet.iter_mut().for_each(|foot| foot.carry(shift));
        let shift = sway + shift;
        let mut frame = Frame::of(loaded, plan, &self.posed, shift, &self.feet);
        for _ in 0..CORRECTIONS {
            // What hangs between shin and foot moves with both: how high that has left the soles is seen.
            frame.put(&mut self.local);
            let moves = moves(&Posed::of(loaded, &self.local), &plan.new_inverse);
            for (foot, leg) in self.feet.iter_mut().zip(&plan.legs) {
                foot.goal += (foot.height - leg.lowest(plan, 1, &moves)) * plan.up;
            }
            frame = Frame::of(loaded, plan, &self.posed, shift, &self.feet);
        }
        frame.put(&mut self.local);
        for (foot, leg) in self.feet.iter().zip(&plan.legs) {
            if let Some(turn) = self.levelled(loaded, plan, leg, foot.height) {
                frame.turns.iter_mut().filter(|(node, _)| *node == leg.foot).for_each(|set| set.1 = turn);
                frame.change = f64::INFINITY;
            }
        }
        Frame { change: frame.change.max(self.change), ..frame }
    }

    /// The turn of a foot in its parent's space that is too low where its knee bends no further: as little towards level as lifts its
    /// lowest point to `height`. `None` where it is high enough.
    fn levelled(&self, loaded: &Loaded, plan: &Plan, leg: &Limb, height: f64) -> Option<DQuat> {
        let posed = Posed::of(loaded, &self.local);
        let turn =
            |share: f64| posed.turned_in_parent(loaded, leg.foot, leg.towards_level(plan, &posed, share));
        let is_low = |share: f64| {
            let mut local = self.local.clone();
            local[leg.foot].1 = turn(share);
            let lowest = leg.lowest(plan, 1, &moves(&Posed::of(loaded, &local), &plan.new_inverse));
            lowest < height - NOTHING * plan.height
        };
        if !is_low(0.0) {
            return None;
        }
        let (mut low, mut high) = (0.0, 1.0);
        for _ in 0..HALVINGS {
            let middle = 0.5 * (low + high);
            if is_low(middle) { low = middle } else { high = middle }
        }
        Some(turn(high))
    }

    /// How far the hips go up from where the scaled clip has them: with the feet that stand, so that knees bend as they did; with
    /// the trunk where that rests on the floor.
    fn lift(&self, plan: &Plan) -> f64 {
        let stand: f64 = self.feet.iter().map(|foot| foot.stands).sum();
        let rise = |foot: &Foot| foot.stands * (foot.goal - foot.bones.ankle).dot(plan.up);
        let mut lift = self.feet.iter().map(rise).sum::<f64>() / stand.max(1.0);
        lift += self.rests * (self.seat - lift);
        // One after the other: a foot that pushes the hips up pushes them less where they are up already; what sinks them is
        // last, because a foot above the floor is worse than a knee that is bent far.
        for rises in [true, false] {
            let needs = self.feet.iter().map(|foot| foot.stands * foot.room(plan.up, lift, rises));
            lift += if rises { needs.fold(0.0, f64::max) } else { needs.fold(0.0, f64::min) };
        }
        lift
    }
}

/// What takes each node's surroundings from rest to a pose.
fn moves(posed: &Posed, inverse: &[DMat4]) -> Vec<DMat4> {
    posed.world.iter().zip(inverse).map(|(world, inverse)| *world * *inverse).collect()
}

/// 0 up to the first of two numbers, 1 from the second on, smooth between.
fn smooth(x: f64, [from, to]: [f64; 2]) -> f64 {
    let share = ((x - from) / (to - from)).clamp(0.0, 1.0);
    share * share * (3.0 - 2.0 * share)
}
