//! Soles in a file's own walks: hips are carried so that the lowest sole of a clip is as far from the floor as it was.
//!
//! Hips are scaled by their height, but feet keep more of their size than legs do: toes that point down would dip into the
//! floor.

use crate::accessor::Reader;
use crate::load::Loaded;
use crate::write::extent;
use crate::{array_at, index_at, text_at};
use glam::{DMat4, DQuat, DVec3, Vec3};
use std::collections::BTreeMap;
use superdeform::{Result, Role};

/// Vertices of legs and feet lower than this share of the height are a sole's.
const SOLE: f64 = 0.02;
/// Moments of a clip that are looked at.
const MOMENTS: usize = 24;
/// Clips in which the hips sink below this share of their height do not stand: their soles say nothing of the floor.
const STANDING: f64 = 0.8;
/// Hips are carried by at most this share of the height.
const FURTHEST: f64 = 0.1;

/// A track: its times, and numbers a key.
struct Track {
    times: Vec<f32>,
    values: Vec<f32>,
    width: usize,
    steps: bool,
}

impl Track {
    /// The two keys around a moment, and how far it is from the first to the second.
    fn at(&self, time: f32) -> (&[f32], &[f32], f64) {
        let next = self.times.partition_point(|&key| key <= time).min(self.times.len() - 1);
        let last = next.saturating_sub(1);
        let (from, to) = (self.times[last], self.times[next]);
        let share =
            if self.steps || to <= from { 0.0 } else { ((time - from) / (to - from)).clamp(0.0, 1.0) };
        let share = if time >= to && !self.steps { 1.0 } else { share };
        let key = |index: usize| &self.values[index * self.width..(index + 1) * self.width];
        (key(last), key(next), f64::from(share))
    }
}

/// A clip's tracks by node: translation, rotation.
struct Clip {
    translations: BTreeMap<usize, Track>,
    rotations: BTreeMap<usize, Track>,
    end: f32,
}

impl Clip {
    fn read(loaded: &Loaded, animation: usize, reader: &Reader) -> Result<Self> {
        let json = &loaded.file.list("animations")[animation];
        let samplers = array_at(json, "samplers");
        let mut clip = Self { translations: BTreeMap::new(), rotations: BTreeMap::new(), end: 0.0 };
        for channel in array_at(json, "channels") {
            let target = &channel["target"];
            let (width, tracks) = match text_at(target, "path") {
                "translation" => (3, &mut clip.translations),
                "rotation" => (4, &mut clip.rotations),
                _ => continue,
            };
            let sampler = index_at(channel, "sampler").and_then(|sampler| samplers.get(sampler));
            let (Some(node), Some(sampler)) = (index_at(target, "node"), sampler) else { continue };
            let (Some(input), Some(output)) = (index_at(sampler, "input"), index_at(sampler, "output"))
            else {
                continue;
            };
            let times = reader.floats(input, 1, None)?;
            let mut values = reader.floats(output, width, None)?;
            if text_at(sampler, "interpolation") == "CUBICSPLINE" {
                // In-tangent, value, out-tangent: the values alone are near enough.
                values =
                    values.chunks_exact(3 * width).flat_map(|key| key[width..2 * width].to_vec()).collect();
            }
            if times.is_empty() || values.len() != times.len() * width {
                continue;
            }
            clip.end = times.iter().copied().fold(clip.end, f32::max);
            let steps = text_at(sampler, "interpolation") == "STEP";
            tracks.insert(node, Track { times, values, width, steps });
        }
        Ok(clip)
    }

    /// All nodes' places in model space at a moment.
    fn world(&self, loaded: &Loaded, locals: &[(DVec3, DQuat, DVec3)], time: f32) -> Vec<DMat4> {
        let mut world = vec![DMat4::IDENTITY; locals.len()];
        for &node in &loaded.tree.order {
            let (scale, mut rotation, mut translation) = (locals[node].0, locals[node].1, locals[node].2);
            if let Some(track) = self.translations.get(&node) {
                let (from, to, share) = track.at(time);
                let [from, to] = [from, to].map(|key| Vec3::from_slice(key).as_dvec3());
                translation = from.lerp(to, share);
            }
            if let Some(track) = self.rotations.get(&node) {
                let (from, to, share) = track.at(time);
                let [from, to] =
                    [from, to].map(|key| DQuat::from_array([0, 1, 2, 3].map(|i| f64::from(key[i]))));
                let turned = from.normalize().slerp(to.normalize(), share);
                rotation = if turned.is_finite() { turned } else { rotation };
            }
            let local = DMat4::from_scale_rotation_translation(scale, rotation, translation);
            world[node] = match loaded.tree.parents[node] {
                Some(parent) => world[parent] * local,
                None => local,
            };
        }
        world
    }
}

/// The soles of a character: vertices by mesh.
fn soles(loaded: &Loaded) -> Vec<(usize, usize)> {
    let character = &loaded.character;
    let legs = [Role::LeftUpperLeg, Role::RightUpperLeg].map(|role| character.humanoid.joint(role));
    let of_leg: Vec<bool> = (0..character.skeleton.joints.len())
        .map(|joint| character.skeleton.ancestors(joint).any(|above| legs.contains(&Some(above))))
        .collect();
    let up = character.axes.up.as_dvec3().normalize_or(DVec3::Y);
    let (low, high) = extent(character.meshes.iter().map(|mesh| mesh.positions.as_slice()), up);
    let mut found = Vec::new();
    for (index, mesh) in character.meshes.iter().enumerate() {
        for (vertex, row) in mesh.weights.rows().enumerate() {
            let is_low = mesh.positions[vertex].as_dvec3().dot(up) < low + SOLE * (high - low);
            let main = row.iter().max_by(|a, b| a.1.total_cmp(&b.1));
            if is_low && main.is_some_and(|&(joint, _)| of_leg[joint as usize]) {
                found.push((index, vertex));
            }
        }
    }
    found
}

/// How far the lowest sole is above the floor at most moments of a clip, below 0 where it dips in; `None` where the clip does
/// not stand, or there are no soles.
///
/// # Errors
/// As [`Reader::floats`].
pub fn lowest_sole(loaded: &Loaded, animation: usize, reader: &Reader) -> Result<Option<f64>> {
    let character = &loaded.character;
    let soles = soles(loaded);
    let Some(hips) = character.humanoid.joint(Role::Hips).filter(|_| !soles.is_empty()) else {
        return Ok(None);
    };
    let clip = Clip::read(loaded, animation, reader)?;
    let rest = &loaded.pose.rest;
    let local = |node: usize| {
        let matrix = match loaded.tree.parents[node] {
            Some(parent) => rest[parent].inverse() * rest[node],
            None => rest[node],
        };
        matrix.to_scale_rotation_translation()
    };
    let locals: Vec<(DVec3, DQuat, DVec3)> = (0..rest.len()).map(local).collect();
    let inverse: Vec<DMat4> = rest.iter().map(DMat4::inverse).collect();
    let up = character.axes.up.as_dvec3().normalize_or(DVec3::Y);
    let (floor, _) = extent(character.meshes.iter().map(|mesh| mesh.positions.as_slice()), up);
    let hips_node = loaded.node_of_joint[hips];
    let standing = rest[hips_node].w_axis.truncate().dot(up) - floor;
    let mut lowest = f64::INFINITY;
    for moment in 0..=MOMENTS {
        let world = clip.world(loaded, &locals, clip.end * moment as f32 / MOMENTS as f32);
        let height = world[hips_node].w_axis.truncate().dot(up) - floor;
        if height < STANDING * standing {
            return Ok(None);
        }
        for &(mesh, vertex) in &soles {
            let p = character.meshes[mesh].positions[vertex].as_dvec3();
            let row = character.meshes[mesh].weights.row(vertex);
            let total: f64 = row.iter().map(|&(_, weight)| f64::from(weight)).sum();
            let place: DVec3 = row
                .iter()
                .map(|&(joint, weight)| {
                    let node = loaded.node_of_joint[joint as usize];
                    (world[node] * inverse[node]).transform_point3(p) * (f64::from(weight) / total)
                })
                .sum();
            lowest = lowest.min(place.dot(up) - floor);
        }
    }
    Ok(lowest.is_finite().then_some(lowest))
}

/// By how much the hips' keys of each animation are to be carried, in the space of the hips' parent.
///
/// `after`: the character with its file as they come out, the hips scaled by `hip_ratio` alone.
///
/// # Errors
/// As [`Reader::floats`].
pub(super) fn carries(loaded: &Loaded, after: &Loaded, hip_ratio: f64) -> Result<Vec<DVec3>> {
    let up = loaded.character.axes.up.as_dvec3().normalize_or(DVec3::Y);
    let count = loaded.file.list("animations").len();
    let Some(hips) = loaded.character.humanoid.joint(Role::Hips) else { return Ok(vec![DVec3::ZERO; count]) };
    let node = loaded.node_of_joint[hips];
    let (low, high) = extent(after.character.meshes.iter().map(|mesh| mesh.positions.as_slice()), up);
    let furthest = FURTHEST * (high - low);
    let (before_reader, after_reader) = (Reader::new(&loaded.file), Reader::new(&after.file));
    let mut carries = Vec::with_capacity(count);
    for animation in 0..count {
        let is_carried =
            array_at(&loaded.file.list("animations")[animation], "channels").iter().any(|channel| {
                text_at(&channel["target"], "path") == "translation"
                    && index_at(&channel["target"], "node") == Some(node)
            });
        let mut carry = DVec3::ZERO;
        if is_carried
            && let Some(was) = lowest_sole(loaded, animation, &before_reader)?
            && let Some(is) = lowest_sole(after, animation, &after_reader)?
        {
            let by = (was * hip_ratio - is).clamp(-furthest, furthest);
            let parent = loaded.tree.parents[node].map_or(DMat4::IDENTITY, |parent| after.pose.rest[parent]);
            carry = parent.inverse().transform_vector3(by * up);
        }
        carries.push(if carry.is_finite() { carry } else { DVec3::ZERO });
    }
    Ok(carries)
}
