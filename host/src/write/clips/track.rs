//! The tracks of an animation, read and looked up.

use crate::accessor::Reader;
use crate::load::Loaded;
use crate::{array_at, index_at, text_at};
use glam::{DMat4, DQuat, DVec3};
use serde_json::Value;
use std::collections::BTreeMap;
use superdeform::Result;

/// Between two keys that are further apart than this, in seconds, others are put: what is set right at keys alone would be off
/// between them. Thirty frames a second is what most clips are baked at.
const FRAME: f64 = 1.0 / 30.0;

/// Most keys of a clip that are put between others; a clip of an hour keeps its own.
const MOST_KEYS: f64 = 3000.0;

/// Keys nearer than this, in seconds, are one.
const SAME_KEY: f32 = 1e-5;

/// One property of a node over time.
#[derive(Clone, Debug)]
pub(super) struct Track {
    pub(super) times: Vec<f32>,
    /// Numbers of all keys; with three parts a key (in-tangent, value, out-tangent) where it is `cubic`.
    values: Vec<f32>,
    width: usize,
    pub(super) steps: bool,
    cubic: bool,
}

impl Track {
    /// The track of a sampler; `None` where it is damaged.
    fn read(sampler: &Value, width: usize, reader: &Reader) -> Result<Option<Self>> {
        let (Some(input), Some(output)) = (index_at(sampler, "input"), index_at(sampler, "output")) else {
            return Ok(None);
        };
        let interpolation = text_at(sampler, "interpolation");
        let cubic = interpolation == "CUBICSPLINE";
        let track = Self {
            times: reader.floats(input, 1, None)?,
            values: reader.floats(output, width, None)?,
            width,
            steps: interpolation == "STEP",
            cubic,
        };
        let numbers = track.times.len() * width * if cubic { 3 } else { 1 };
        let whole = !track.times.is_empty()
            && track.values.len() == numbers
            && track.times.windows(2).all(|pair| pair[0] <= pair[1])
            && track.values.iter().chain(&track.times).all(|number| number.is_finite());
        Ok(whole.then_some(track))
    }

    /// A part of a key: 0 its in-tangent, 1 its value, 2 its out-tangent.
    fn part(&self, key: usize, part: usize) -> [f64; 4] {
        let start = if self.cubic { (3 * key + part) * self.width } else { key * self.width };
        let mut numbers = [0.0; 4];
        for (to, &from) in numbers.iter_mut().zip(&self.values[start..start + self.width]) {
            *to = f64::from(from);
        }
        numbers
    }

    /// The keys around a moment, and how far it is from the first to the second.
    fn around(&self, time: f32) -> (usize, usize, f64) {
        let next = self.times.partition_point(|&key| key <= time);
        if next == 0 || next == self.times.len() {
            let key = next.saturating_sub(1).min(self.times.len() - 1);
            return (key, key, 0.0);
        }
        let (from, to) = (f64::from(self.times[next - 1]), f64::from(self.times[next]));
        (next - 1, next, if self.steps { 0.0 } else { (f64::from(time) - from) / (to - from) })
    }

    /// Its numbers at a moment, as glTF 2.0 interpolates them (appendix C); turns go the shorter way.
    fn at(&self, time: f32) -> [f64; 4] {
        let (last, next, share) = self.around(time);
        let (from, to) = (self.part(last, 1), self.part(next, 1));
        if last == next || share == 0.0 {
            return from;
        }
        if self.cubic {
            let gap = f64::from(self.times[next]) - f64::from(self.times[last]);
            let (leaving, arriving) = (self.part(last, 2), self.part(next, 0));
            let (s, s2, s3) = (share, share * share, share * share * share);
            return std::array::from_fn(|i| {
                (2.0 * s3 - 3.0 * s2 + 1.0) * from[i]
                    + gap * (s3 - 2.0 * s2 + s) * leaving[i]
                    + (3.0 * s2 - 2.0 * s3) * to[i]
                    + gap * (s3 - s2) * arriving[i]
            });
        }
        if self.width == 4 {
            return DQuat::from_array(from)
                .normalize()
                .slerp(DQuat::from_array(to).normalize(), share)
                .to_array();
        }
        std::array::from_fn(|i| from[i] + (to[i] - from[i]) * share)
    }

    /// Its place or scale at a moment.
    pub(super) fn vector(&self, time: f32) -> DVec3 {
        let [x, y, z, _] = self.at(time);
        DVec3::new(x, y, z)
    }

    /// Its turn at a moment; none where it is no turn.
    fn turn(&self, time: f32) -> Option<DQuat> {
        let turn = DQuat::from_array(self.at(time));
        (turn.length_squared() > 1e-12).then(|| turn.normalize())
    }
}

/// Scale, turn and place of a node in its parent's space.
pub(super) type Local = (DVec3, DQuat, DVec3);

/// The tracks of an animation by node.
#[derive(Clone, Debug, Default)]
pub(super) struct Clip {
    pub(super) places: BTreeMap<usize, Track>,
    pub(super) turns: BTreeMap<usize, Track>,
    pub(super) scales: BTreeMap<usize, Track>,
}

impl Clip {
    /// Reads an animation.
    ///
    /// # Errors
    /// As [`Reader::floats`].
    pub(super) fn read(loaded: &Loaded, animation: usize, reader: &Reader) -> Result<Self> {
        let json = &loaded.file.list("animations")[animation];
        let samplers = array_at(json, "samplers");
        let mut clip = Self::default();
        for channel in array_at(json, "channels") {
            let target = &channel["target"];
            let (width, tracks) = match text_at(target, "path") {
                "translation" => (3, &mut clip.places),
                "rotation" => (4, &mut clip.turns),
                "scale" => (3, &mut clip.scales),
                _ => continue,
            };
            let sampler = index_at(channel, "sampler").and_then(|sampler| samplers.get(sampler));
            if let (Some(node), Some(sampler)) = (index_at(target, "node"), sampler)
                && let Some(track) = Track::read(sampler, width, reader)?
            {
                tracks.insert(node, track);
            }
        }
        Ok(clip)
    }

    fn tracks(&self) -> impl Iterator<Item = &Track> {
        self.places.values().chain(self.turns.values()).chain(self.scales.values())
    }

    /// The moments of all keys of all tracks, and others where these are further apart than a frame; and whether everything
    /// steps from key to key.
    pub(super) fn moments(&self) -> (Vec<f32>, bool) {
        let mut keys: Vec<f32> = self.tracks().flat_map(|track| &track.times).copied().collect();
        keys.sort_by(f32::total_cmp);
        keys.dedup_by(|next, last| *next - *last < SAME_KEY);
        let steps = self.tracks().all(|track| track.steps);
        let (Some(&first), Some(&last)) = (keys.first(), keys.last()) else { return (Vec::new(), steps) };
        if steps {
            return (keys, steps);
        }
        let gap = FRAME.max(f64::from(last - first) / MOST_KEYS);
        let mut moments = vec![first];
        for pair in keys.windows(2) {
            let (from, to) = (f64::from(pair[0]), f64::from(pair[1]));
            // A little more than a frame, as rounding makes it, is a frame.
            let parts = ((to - from) / gap - 0.1).ceil().max(1.0) as usize;
            moments.extend((1..=parts).map(|part| (from + (to - from) * part as f64 / parts as f64) as f32));
        }
        (moments, steps)
    }

    /// What stands in the place of a node's own scale, turn and place at a moment.
    pub(super) fn local(&self, node: usize, rest: Local, time: f32) -> Local {
        let (scale, turn, place) = rest;
        (
            self.scales.get(&node).map_or(scale, |track| track.vector(time)),
            self.turns.get(&node).and_then(|track| track.turn(time)).unwrap_or(turn),
            self.places.get(&node).map_or(place, |track| track.vector(time)),
        )
    }
}

/// The nodes of a file in a pose.
#[derive(Clone, Debug, Default)]
pub(super) struct Posed {
    /// Node space to model space.
    pub(super) world: Vec<DMat4>,
    /// The turn of that.
    pub(super) turn: Vec<DQuat>,
}

impl Posed {
    /// The nodes by what each is in its parent's space.
    pub(super) fn of(loaded: &Loaded, local: &[Local]) -> Self {
        let mut posed =
            Self { world: vec![DMat4::IDENTITY; local.len()], turn: vec![DQuat::IDENTITY; local.len()] };
        for &node in &loaded.tree.order {
            let (scale, turn, place) = local[node];
            let matrix = DMat4::from_scale_rotation_translation(scale, turn, place);
            (posed.world[node], posed.turn[node]) = match loaded.tree.parents[node] {
                Some(parent) => (posed.world[parent] * matrix, posed.turn[parent] * turn),
                None => (matrix, turn),
            };
        }
        posed
    }

    /// A place of model space in the space of a node's parent.
    pub(super) fn in_parent(&self, loaded: &Loaded, node: usize, place: DVec3) -> DVec3 {
        match loaded.tree.parents[node] {
            Some(parent) => self.world[parent].inverse().transform_point3(place),
            None => place,
        }
    }

    /// The turn of a node, in its parent's space, that is turned in model space by `turn` beside how it is.
    pub(super) fn turned_in_parent(&self, loaded: &Loaded, node: usize, turn: DQuat) -> DQuat {
        let parent = loaded.tree.parents[node].map_or(DQuat::IDENTITY, |parent| self.turn[parent]);
        (parent.inverse() * turn * self.turn[node]).normalize()
    }

    /// Where a node is.
    pub(super) fn place(&self, node: usize) -> DVec3 {
        self.world[node].w_axis.truncate()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn track(times: &[f32], values: &[f32], width: usize) -> Track {
        Track { times: times.to_vec(), values: values.to_vec(), width, steps: false, cubic: false }
    }

    #[test]
    fn a_track_stays_before_its_first_key_and_after_its_last() {
        let track = track(&[1.0, 2.0], &[0.0, 0.0, 0.0, 4.0, 2.0, 0.0], 3);
        for (time, x) in [(0.0, 0.0), (1.0, 0.0), (1.25, 1.0), (2.0, 4.0), (3.0, 4.0)] {
            assert_eq!(track.vector(time).x, x, "at {time}");
        }
        let steps = Track { steps: true, ..track };
        assert_eq!([1.9, 2.0].map(|time| steps.vector(time).x), [0.0, 4.0]);
    }

    #[test]
    fn a_cubic_track_leaves_and_arrives_by_its_tangents() {
        // x(s) = s^2 over two seconds: it leaves level and arrives with 2 / 2 a second.
        let values = [0.0, 0.0, 0.0, 1.0, 1.0, 0.0].map(|x| [x, 0.0, 0.0]);
        let track = Track { cubic: true, ..track(&[0.0, 2.0], values.as_flattened(), 3) };
        for share in [0.0, 0.25, 0.5, 1.0] {
            assert!((track.vector(2.0 * share).x - f64::from(share * share)).abs() < 1e-12);
        }
    }

    #[test]
    fn keys_that_are_far_apart_get_others_between_them() {
        let mut clip = Clip::default();
        clip.turns.insert(0, track(&[0.0, 0.1], &[0.0; 8], 4));
        clip.places.insert(0, track(&[0.0, 1.0 / 30.0], &[0.0; 6], 3));
        let (moments, steps) = clip.moments();
        assert_eq!((moments.len(), steps), (4, false));
        assert!(moments.windows(2).all(|pair| pair[0] < pair[1]));
    }
}
