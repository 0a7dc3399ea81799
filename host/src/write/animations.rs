//! Tracks of animations: those that are made anew, and those that keep their keys.

use super::clips::{NewTracks, Retarget};
use super::nodes::Shift;
use super::{Place, Slot, same_bits};
use crate::accessor::Reader;
use crate::load::Loaded;
use crate::{array_at, bad_input, index_at, text_at};
use glam::{DVec3, Vec3};
use serde_json::{Value, json};
use std::collections::{BTreeMap, BTreeSet};
use superdeform::Result;

/// The tracks of all animations: what a clip's retargeting sets, and the places of all other nodes, of which a key is as far
/// from the new rest as it was from the old one, scaled. A track that keeps a joint at its old rest keeps it at its new rest.
pub(super) fn animation_slots(
    loaded: &Loaded,
    retarget: &Retarget,
    shifts: &BTreeMap<usize, Shift>,
    reader: &Reader,
    json: &mut Value,
    slots: &mut Vec<Slot>,
) -> Result<()> {
    for animation in 0..loaded.file.list("animations").len() {
        let mut made = Vec::new();
        if let Some(tracks) = retarget.tracks(animation, reader)? {
            made = new_tracks(&tracks, animation, &mut json["animations"][animation], slots);
        }
        scaled_tracks(
            loaded,
            retarget,
            shifts,
            reader,
            &mut json["animations"][animation],
            slots,
            (animation, &made),
        )?;
    }
    Ok(())
}

/// Puts tracks into an animation, in the place of those that are there or as new ones; gives the channels that have them.
fn new_tracks(tracks: &NewTracks, animation: usize, json: &mut Value, slots: &mut Vec<Slot>) -> Vec<usize> {
    let floats =
        |numbers: &mut dyn Iterator<Item = f64>| numbers.map(|number| number as f32).collect::<Vec<f32>>();
    let places = tracks.places.iter().map(|(&node, places)| {
        (node, "translation", 3, floats(&mut places.iter().flat_map(|place| place.to_array())))
    });
    let turns = tracks.turns.iter().map(|(&node, turns)| {
        (node, "rotation", 4, floats(&mut turns.iter().flat_map(|turn| turn.to_array())))
    });
    let mut made = Vec::new();
    for (node, path, components, numbers) in places.chain(turns).collect::<Vec<_>>() {
        let (channel, sampler) = own_sampler(json, node, path);
        json["samplers"][sampler]["interpolation"] = json!(if tracks.steps { "STEP" } else { "LINEAR" });
        let input = Place::Input { animation, sampler };
        slots.push(Slot { place: input, components: 1, numbers: tracks.times.clone() });
        slots.push(Slot { place: Place::Output { animation, sampler }, components, numbers });
        made.push(channel);
    }
    made
}

/// The channel of a property of a node, with a sampler that no other channel has.
fn own_sampler(json: &mut Value, node: usize, path: &str) -> (usize, usize) {
    let channels = array_at(json, "channels");
    let is_it = |channel: &&Value| {
        index_at(&channel["target"], "node") == Some(node) && text_at(&channel["target"], "path") == path
    };
    let channel = channels.iter().position(|channel| is_it(&channel));
    let sampler = channel.and_then(|channel| index_at(&channels[channel], "sampler"));
    let users = |sampler: usize| {
        channels.iter().filter(|channel| index_at(channel, "sampler") == Some(sampler)).count()
    };
    if let (Some(channel), Some(sampler)) = (channel, sampler.filter(|&sampler| users(sampler) == 1)) {
        return (channel, sampler);
    }
    // The moments of another sampler, so that those of all new ones become one accessor.
    let input = array_at(json, "samplers").iter().find_map(|sampler| index_at(sampler, "input"));
    let mut new = json!({});
    if let Some(input) = input {
        new["input"] = json!(input);
    }
    let sampler = push(&mut json["samplers"], new);
    let channel = match channel {
        Some(channel) => channel,
        None => push(&mut json["channels"], json!({"target": {"node": node, "path": path}})),
    };
    json["channels"][channel]["sampler"] = json!(sampler);
    (channel, sampler)
}

fn push(list: &mut Value, value: Value) -> usize {
    let Some(list) = list.as_array_mut() else { return 0 };
    list.push(value);
    list.len() - 1
}

/// The places of nodes in an animation, scaled; but for the channels that are `made` anew.
fn scaled_tracks(
    loaded: &Loaded,
    retarget: &Retarget,
    shifts: &BTreeMap<usize, Shift>,
    reader: &Reader,
    json: &mut Value,
    slots: &mut Vec<Slot>,
    (animation, made): (usize, &[usize]),
) -> Result<()> {
    let made: BTreeSet<usize> = made.iter().copied().collect();
    let channels = array_at(json, "channels").to_vec();
    let samplers = array_at(json, "samplers").to_vec();
    // What each sampler gives by now: several channels may share one.
    let mut given: BTreeMap<usize, Option<Vec<f32>>> = BTreeMap::new();
    for channel in channels.iter().filter(|channel| text_at(&channel["target"], "path") != "translation") {
        if let Some(sampler) = index_at(channel, "sampler") {
            given.insert(sampler, None);
        }
    }
    for (index, channel) in channels.iter().enumerate().filter(|(index, _)| !made.contains(index)) {
        let (Some(sampler), Some(node)) =
            (index_at(channel, "sampler"), index_at(&channel["target"], "node"))
        else {
            continue;
        };
        if text_at(&channel["target"], "path") != "translation" {
            continue;
        }
        let node_count = loaded.pose.rest.len();
        if node >= node_count {
            return Err(bad_input(format!(
                "{}: channel {index} of animation {animation} moves node {node}, but there are {node_count} nodes: export the file anew",
                loaded.file.name
            )));
        }
        let Some(accessor) = samplers.get(sampler).and_then(|sampler| index_at(sampler, "output")) else {
            continue;
        };
        let old = reader.floats(accessor, 3, None)?;
        let cubic = text_at(&samplers[sampler], "interpolation") == "CUBICSPLINE";
        let numbers =
            scaled(&old, cubic, shifts.get(&node), loaded.pose_translation(node), retarget.scale_of(node));
        let mut place = Place::Output { animation, sampler };
        match given.get(&sampler) {
            None => {
                given.insert(sampler, Some(numbers.clone()));
            }
            Some(Some(other)) if same_bits(other, &numbers) => continue,
            // Another channel keeps the old numbers: nothing to do where this one does, too.
            Some(None) if same_bits(&old, &numbers) => continue,
            Some(_) => {
                let copy = push(&mut json["samplers"], samplers[sampler].clone());
                json["channels"][index]["sampler"] = json!(copy);
                place = Place::Output { animation, sampler: copy };
            }
        }
        slots.push(Slot { place, components: 3, numbers });
    }
    Ok(())
}

/// The keys of a node's place: as far from its new rest as they were from its old one, times `scale`.
fn scaled(old: &[f32], cubic: bool, shift: Option<&Shift>, rest: DVec3, scale: f64) -> Vec<f32> {
    let mut numbers = old.to_vec();
    if shift.is_none() && scale == 1.0 {
        return numbers;
    }
    let (before, after) = shift.map_or((rest, rest), |shift| (shift.before, shift.after));
    for (key, raw) in numbers.chunks_exact_mut(3).enumerate() {
        let value = Vec3::from_slice(raw).as_dvec3();
        // In-tangent, value, out-tangent: tangents are differences.
        let value = if cubic && key % 3 != 1 { value * scale } else { after + (value - before) * scale };
        raw.copy_from_slice(&value.as_vec3().to_array());
    }
    numbers
}

impl Loaded {
    /// The place of a node in its parent's space at rest.
    pub(super) fn pose_translation(&self, node: usize) -> DVec3 {
        let place = self.pose.rest[node].w_axis.truncate();
        self.tree.parents[node]
            .map_or(place, |parent| self.pose.rest[parent].inverse().transform_point3(place))
    }
}
