//! Translation tracks of animations.

use super::nodes::Shift;
use super::{MapPoint, Place, Slot, extent, same_bits};
use crate::accessor::Reader;
use crate::load::Loaded;
use crate::{array_at, bad_input, index_at, text_at};
use glam::{DVec3, Vec3};
use serde_json::{Value, json};
use std::collections::BTreeMap;
use superdeform::{Deformed, Result, Role};

/// New over old height of the hips above the ground, which is as low as the lowest vertex.
pub(super) fn hip_ratio(loaded: &Loaded, deformed: &Deformed) -> f64 {
    let up = loaded.character.axes.up.as_dvec3().normalize_or(DVec3::Y);
    let Some(hips) = loaded.character.humanoid.joint(Role::Hips) else {
        return 1.0;
    };
    let (low, high) = extent(loaded.character.meshes.iter().map(|mesh| mesh.positions.as_slice()), up);
    let (new_low, _) = extent(deformed.meshes.iter().map(|mesh| mesh.positions.as_slice()), up);
    let before = loaded.character.skeleton.joints[hips].position().dot(up) - low;
    let after = deformed.joints[hips].dot(up) - new_low;
    let ratio = after / before;
    // Hips at or below the soles tell nothing.
    if before > 1e-3 * (high - low) && ratio.is_finite() && ratio > 0.0 { ratio } else { 1.0 }
}

/// What translation tracks are scaled by, beside the field.
#[derive(Clone, Copy)]
pub(super) struct ClipScales<'a> {
    /// As [`hip_ratio`] gives it.
    pub(super) hip_ratio: f64,
    /// Added to the hips' keys of each animation; empty where nothing is.
    pub(super) carries: &'a [DVec3],
}

/// Translation tracks: how far a key lies from the rest is scaled, and the rest is the new one.
///
/// The scale is that of the hips' height for the hips and for what does not hang from them (a root that travels, feet
/// that an animation places by themselves), and the field's own for what moves within the body (eyelids, a jaw). A track
/// that keeps a joint at its old rest keeps it at its new rest.
pub(super) fn animation_slots(
    loaded: &Loaded,
    shifts: &BTreeMap<usize, Shift>,
    scales: ClipScales,
    map_point: &MapPoint,
    reader: &Reader,
    json: &mut Value,
    slots: &mut Vec<Slot>,
) -> Result<()> {
    let hips = loaded.character.humanoid.joint(Role::Hips).map(|joint| loaded.node_of_joint[joint]);
    for (animation, animation_json) in loaded.file.list("animations").iter().enumerate() {
        let channels = array_at(animation_json, "channels");
        let samplers = array_at(animation_json, "samplers");
        // What each sampler gives by now: several channels may share one.
        let mut given: BTreeMap<usize, Option<Vec<f32>>> = BTreeMap::new();
        for channel in channels.iter().filter(|channel| text_at(&channel["target"], "path") != "translation")
        {
            if let Some(sampler) = index_at(channel, "sampler") {
                given.insert(sampler, None);
            }
        }
        for (index, channel) in channels.iter().enumerate() {
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
            let Some(sampler_json) = samplers.get(sampler) else {
                continue;
            };
            let Some(accessor) = index_at(sampler_json, "output") else {
                continue;
            };
            let old = reader.floats(accessor, 3, None)?;
            let mut numbers = old.clone();
            let cubic = text_at(sampler_json, "interpolation") == "CUBICSPLINE";
            let shift = shifts.get(&node);
            let (before, after) = match shift {
                Some(shift) => (shift.before, shift.after),
                None => (loaded.pose_translation(node), loaded.pose_translation(node)),
            };
            let below_hips =
                std::iter::successors(loaded.tree.parents[node], |&above| loaded.tree.parents[above])
                    .any(|above| Some(above) == hips);
            let scale = match loaded.joint_of_node[node] {
                Some(joint) if below_hips => {
                    map_point(joint, loaded.character.skeleton.joints[joint].position()).local_scale()
                }
                _ => scales.hip_ratio,
            };
            let carry = match scales.carries.get(animation) {
                Some(&carry) if Some(node) == hips => carry,
                _ => DVec3::ZERO,
            };
            if shift.is_some() || scale != 1.0 || carry != DVec3::ZERO {
                for (key, raw) in numbers.chunks_exact_mut(3).enumerate() {
                    let value = Vec3::from_slice(raw).as_dvec3();
                    // In-tangent, value, out-tangent: tangents are differences.
                    let value = if cubic && key % 3 != 1 {
                        value * scale
                    } else {
                        after + (value - before) * scale + carry
                    };
                    raw.copy_from_slice(&value.as_vec3().to_array());
                }
            }
            let mut place = Place::Output { animation, sampler };
            match given.get(&sampler) {
                None => {
                    given.insert(sampler, Some(numbers.clone()));
                }
                Some(Some(other)) if same_bits(other, &numbers) => continue,
                // Another channel keeps the old numbers: nothing to do where this one does, too.
                Some(None) if same_bits(&old, &numbers) => continue,
                Some(_) => {
                    let list = json["animations"][animation]["samplers"].as_array_mut();
                    let Some(list) = list else { continue };
                    list.push(sampler_json.clone());
                    let copy = list.len() - 1;
                    json["animations"][animation]["channels"][index]["sampler"] = json!(copy);
                    place = Place::Output { animation, sampler: copy };
                }
            }
            slots.push(Slot { place, components: 3, numbers });
        }
    }
    Ok(())
}

impl Loaded {
    /// The local translation of a node in rest pose.
    fn pose_translation(&self, node: usize) -> DVec3 {
        let place = self.pose.rest[node].w_axis.truncate();
        self.tree.parents[node]
            .map_or(place, |parent| self.pose.rest[parent].inverse().transform_point3(place))
    }
}
