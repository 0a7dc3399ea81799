//! From a deformed character back to its file.
//!
//! Numbers are written over the old ones where that is possible, so that the file keeps its layout; what is not
//! changed keeps its bits. Accessors and buffer views keep their numbers, since extensions may name them.

use super::accessor::{Layout, Reader};
use super::file::GltfFile;
use super::load::{Frame, Loaded, Placement};
use super::{array_at, bad_input, index_at, text_at, vrm};
use glam::{DMat4, DVec3, Vec3};
use serde_json::{Value, json};
use std::collections::{BTreeMap, BTreeSet};
use superdeform::{Deformed, Mapped, Result, Role};

/// Where the field takes a point (model space) that is attached to a joint.
pub type MapPoint<'a> = dyn Fn(usize, DVec3) -> Mapped + 'a;

/// A place in the JSON that names an accessor.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Place {
    Attribute { mesh: usize, primitive: usize, key: &'static str },
    Target { mesh: usize, primitive: usize, target: usize, key: &'static str },
    InverseBinds { skin: usize },
    Output { animation: usize, sampler: usize },
}

impl Place {
    fn pointer(&self) -> String {
        match self {
            Self::Attribute { mesh, primitive, key } => {
                format!("/meshes/{mesh}/primitives/{primitive}/attributes/{key}")
            }
            Self::Target { mesh, primitive, target, key } => {
                format!("/meshes/{mesh}/primitives/{primitive}/targets/{target}/{key}")
            }
            Self::InverseBinds { skin } => format!("/skins/{skin}/inverseBindMatrices"),
            Self::Output { animation, sampler } => {
                format!("/animations/{animation}/samplers/{sampler}/output")
            }
        }
    }

    fn set(&self, json: &mut Value, accessor: usize) {
        let pointer = self.pointer();
        let (holder, key) = pointer.rsplit_once('/').unwrap_or(("", ""));
        if let Some(holder) = json.pointer_mut(holder) {
            holder[key] = json!(accessor);
        }
    }

    fn needs_bounds(&self) -> bool {
        matches!(self, Self::Attribute { key: "POSITION", .. } | Self::Target { key: "POSITION", .. })
    }

    fn is_vertex_data(&self) -> bool {
        matches!(self, Self::Attribute { .. } | Self::Target { .. })
    }
}

/// The numbers that a place should lead to.
#[derive(Clone)]
struct Slot {
    place: Place,
    components: usize,
    numbers: Vec<f32>,
}

/// A bone length's worth of change in a joint, as its node sees it.
struct Shift {
    /// Local translation at rest before and after.
    before: DVec3,
    after: DVec3,
}

/// Puts a deformed character into its file and gives the file's bytes (GLB).
///
/// - `deformed`: one mesh for each of `loaded.character`; one joint for each of its joints, none without a rig.
/// - `map_point`: where the field takes a point that is attached to a joint: spring bones, colliders, viewpoint.
///
/// # Errors
/// Arrays of other lengths than the character's, numbers that are not finite, or a result of 2 GB or more.
pub fn write(loaded: &Loaded, deformed: &Deformed, map_point: &MapPoint) -> Result<Vec<u8>> {
    rewrite(loaded, deformed, map_point)?.to_bytes()
}

/// As [`write`], but gives the file itself.
///
/// # Errors
/// As [`write`].
pub fn rewrite(loaded: &Loaded, deformed: &Deformed, map_point: &MapPoint) -> Result<GltfFile> {
    check(loaded, deformed)?;
    let new_rest = new_rest(loaded, deformed);
    let mut file = loaded.file.clone();
    // A reader counts what it has read: each stage reads no more than loading did.
    let reader = || Reader::new(&loaded.file);
    let mut slots = Vec::new();
    mesh_slots(loaded, deformed, &new_rest, &reader(), &mut file.json, &mut slots)?;
    skin_slots(loaded, &new_rest, &reader(), &mut slots)?;
    let shifts = move_nodes(loaded, &new_rest, &mut file.json);
    let hip_ratio = hip_ratio(loaded, deformed);
    animation_slots(loaded, &shifts, hip_ratio, map_point, &reader(), &mut file.json, &mut slots)?;
    store(&reader(), &mut file, slots)?;
    let height_ratio = height_ratio(loaded, deformed);
    vrm::move_points(&mut file.json, loaded, &new_rest, map_point, height_ratio);
    Ok(file)
}

fn check(loaded: &Loaded, deformed: &Deformed) -> Result<()> {
    let name = &loaded.file.name;
    let meshes = &loaded.character.meshes;
    if deformed.meshes.len() != meshes.len() {
        return Err(bad_input(format!(
            "{name}: {} deformed meshes for {}: give one a mesh",
            deformed.meshes.len(),
            meshes.len()
        )));
    }
    if deformed.joints.len() < loaded.node_of_joint.len() {
        return Err(bad_input(format!(
            "{name}: {} deformed joints for {}: give one a joint",
            deformed.joints.len(),
            loaded.node_of_joint.len()
        )));
    }
    if let Some(joint) = deformed.joints.iter().position(|joint| !joint.is_finite()) {
        return Err(bad_input(format!(
            "{name}: joint {joint} would be at {}: joints must be finite",
            deformed.joints[joint]
        )));
    }
    for (index, (mesh, new)) in meshes.iter().zip(&deformed.meshes).enumerate() {
        if new.positions.len() != mesh.positions.len() {
            return Err(bad_input(format!(
                "{name}: mesh {index} ({}) came back with {} vertices for {}: give one a vertex",
                mesh.name,
                new.positions.len(),
                mesh.positions.len()
            )));
        }
        let stray = |list: &[Vec3]| list.iter().position(|v| !v.is_finite());
        let targets = new.morph_targets.iter().flat_map(|target| [&target.positions, &target.normals]);
        let lists = [&new.positions, &new.normals].into_iter().chain(targets);
        if let Some(vertex) = lists.into_iter().find_map(|list| stray(list)) {
            return Err(bad_input(format!(
                "{name}: mesh {index} ({}): vertex {vertex} would become a number that is not finite: use a milder style",
                mesh.name
            )));
        }
    }
    Ok(())
}

/// Where each node rests after the deformation: joints move and neither turn nor scale.
pub fn new_rest(loaded: &Loaded, deformed: &Deformed) -> Vec<DMat4> {
    let mut rest = loaded.pose.rest.clone();
    for (joint, &node) in loaded.node_of_joint.iter().enumerate() {
        rest[node].w_axis = deformed.joints[joint].extend(rest[node].w_axis.w);
    }
    rest
}

/// The numbers of all vertices; a mesh that two nodes show is doubled where they deform it differently.
fn mesh_slots(
    loaded: &Loaded,
    deformed: &Deformed,
    new_rest: &[DMat4],
    reader: &Reader,
    json: &mut Value,
    slots: &mut Vec<Slot>,
) -> Result<()> {
    let mut instances: BTreeMap<(usize, usize), Vec<usize>> = BTreeMap::new();
    for (index, binding) in loaded.bindings.iter().enumerate() {
        instances.entry((binding.mesh, binding.node)).or_default().push(index);
    }
    // The versions of each mesh so far: its number and its slots.
    let mut versions: BTreeMap<usize, Vec<(usize, Vec<Slot>)>> = BTreeMap::new();
    for ((mesh, node), indices) in instances {
        let mut local = Vec::new();
        for index in indices {
            primitive_slots(loaded, deformed, new_rest, reader, index, &mut local)?;
        }
        let known = versions.entry(mesh).or_default();
        let same = |other: &Vec<Slot>| {
            other.len() == local.len()
                && other.iter().zip(&local).all(|(one, two)| same_bits(&one.numbers, &two.numbers))
        };
        if let Some((number, _)) = known.iter().find(|(_, other)| same(other)) {
            if *number != mesh {
                json["nodes"][node]["mesh"] = json!(number);
            }
            continue;
        }
        let mut number = mesh;
        if !known.is_empty() {
            let copy = json["meshes"][mesh].clone();
            if let Some(meshes) = json["meshes"].as_array_mut() {
                number = meshes.len();
                meshes.push(copy);
            }
            json["nodes"][node]["mesh"] = json!(number);
            for slot in &mut local {
                match &mut slot.place {
                    Place::Attribute { mesh, .. } | Place::Target { mesh, .. } => *mesh = number,
                    _ => {}
                }
            }
        }
        known.push((number, local));
    }
    slots.extend(versions.into_values().flatten().flat_map(|(_, local)| local));
    Ok(())
}

fn same_bits(one: &[f32], two: &[f32]) -> bool {
    one.len() == two.len() && one.iter().zip(two).all(|(a, b)| a.to_bits() == b.to_bits())
}

/// The numbers of one primitive in the file's space.
fn primitive_slots(
    loaded: &Loaded,
    deformed: &Deformed,
    new_rest: &[DMat4],
    reader: &Reader,
    index: usize,
    slots: &mut Vec<Slot>,
) -> Result<()> {
    let binding = &loaded.bindings[index];
    let (old, new) = (&loaded.character.meshes[index], &deformed.meshes[index]);
    let (mesh, primitive) = (binding.mesh, binding.primitive);
    let json = &loaded.file.list("meshes")[mesh]["primitives"][primitive];
    let count = Some(old.positions.len());
    let placement = match binding.skin {
        Some(_) => binding.placement.clone(),
        None => Placement::Common(new_rest[binding.node]),
    };
    // Where the way back is the way that the vertex came, an unchanged vertex keeps its bits.
    let same_way = binding.skin.is_some() || new_rest[binding.node] == loaded.pose.rest[binding.node];
    let common = match &placement {
        Placement::Common(matrix) => Some(Frame::of(matrix.inverse())),
        Placement::PerVertex(_) => None,
    };
    let mut own;
    let mut normal_scales = vec![1.0; old.positions.len()];
    let mut tangent_scales = vec![1.0; old.positions.len()];
    macro_rules! frame {
        ($vertex:expr) => {
            match &common {
                Some(frame) => frame,
                None => {
                    own = Frame::of(placement.at($vertex).inverse());
                    &own
                }
            }
        };
    }

    if let Some(accessor) = index_at(&json["attributes"], "POSITION") {
        let mut numbers = reader.floats(accessor, 3, count)?;
        for (vertex, raw) in numbers.chunks_exact_mut(3).enumerate() {
            if !(same_way && new.positions[vertex] == old.positions[vertex]) {
                let point = frame!(vertex).point(new.positions[vertex].as_dvec3()).as_vec3();
                raw.copy_from_slice(&point.to_array());
            }
        }
        let place = Place::Attribute { mesh, primitive, key: "POSITION" };
        slots.push(Slot { place, components: 3, numbers });
    }
    if let Some(accessor) =
        index_at(&json["attributes"], "NORMAL").filter(|_| new.normals.len() == old.positions.len())
    {
        let mut numbers = reader.floats(accessor, 3, count)?;
        for (vertex, raw) in numbers.chunks_exact_mut(3).enumerate() {
            let (normal, scale) = frame!(vertex).normal(new.normals[vertex]);
            normal_scales[vertex] = scale;
            if !(same_way && new.normals[vertex] == old.normals[vertex]) {
                raw.copy_from_slice(&normal.to_array());
            }
        }
        let place = Place::Attribute { mesh, primitive, key: "NORMAL" };
        slots.push(Slot { place, components: 3, numbers });
    }
    if let Some(accessor) =
        index_at(&json["attributes"], "TANGENT").filter(|_| new.tangents.len() == old.positions.len())
    {
        let mut numbers = reader.floats(accessor, 4, count)?;
        for (vertex, raw) in numbers.chunks_exact_mut(4).enumerate() {
            let (tangent, scale) = frame!(vertex).tangent(new.tangents[vertex].truncate());
            tangent_scales[vertex] = scale;
            if !(same_way && new.tangents[vertex] == old.tangents[vertex]) {
                raw.copy_from_slice(&tangent.extend(new.tangents[vertex].w).to_array());
            }
        }
        let place = Place::Attribute { mesh, primitive, key: "TANGENT" };
        slots.push(Slot { place, components: 4, numbers });
    }
    for (target, (before, after)) in old.morph_targets.iter().zip(&new.morph_targets).enumerate() {
        let target_json = &json["targets"][target];
        for (key, before, after) in [
            ("POSITION", &before.positions, &after.positions),
            ("NORMAL", &before.normals, &after.normals),
            ("TANGENT", &before.tangents, &after.tangents),
        ] {
            if after.len() != old.positions.len() || before.len() != after.len() {
                continue;
            }
            let mut numbers = match index_at(target_json, key) {
                Some(accessor) => reader.floats(accessor, 3, count)?,
                None if after.iter().any(|delta| *delta != Vec3::ZERO) => vec![0.0; 3 * after.len()],
                None => continue,
            };
            for (vertex, raw) in numbers.chunks_exact_mut(3).enumerate() {
                // The normal's own length has a share in its delta, so both must be as they were.
                let kept = match key {
                    "NORMAL" => new.normals[vertex] == old.normals[vertex],
                    "TANGENT" => new.tangents[vertex] == old.tangents[vertex],
                    _ => true,
                };
                if same_way && kept && after[vertex] == before[vertex] {
                    continue;
                }
                let delta = match key {
                    "NORMAL" => frame!(vertex).normal_delta(after[vertex], normal_scales[vertex]),
                    "TANGENT" => frame!(vertex).delta(after[vertex], tangent_scales[vertex]),
                    _ => frame!(vertex).delta(after[vertex], 1.0),
                };
                // Adding 0 turns -0 into 0.
                raw.copy_from_slice(&(delta + Vec3::ZERO).to_array());
            }
            let place = Place::Target { mesh, primitive, target, key };
            slots.push(Slot { place, components: 3, numbers });
        }
    }
    Ok(())
}

/// New inverse bind matrices: J'_j B'_j stays what J_j B_j was, so that all weights keep their meaning.
fn skin_slots(loaded: &Loaded, new_rest: &[DMat4], reader: &Reader, slots: &mut Vec<Slot>) -> Result<()> {
    for (index, (skin, placement)) in loaded.skins.iter().zip(&loaded.pose.placements).enumerate() {
        let accessor = index_at(&loaded.file.list("skins")[index], "inverseBindMatrices");
        let mut numbers = match accessor {
            Some(accessor) => reader.floats(accessor, 16, None)?,
            None => DMat4::IDENTITY.as_mat4().to_cols_array().repeat(skin.joints.len()),
        };
        let mut moved = false;
        for (slot, &node) in skin.joints.iter().enumerate() {
            if new_rest[node] != loaded.pose.rest[node] && new_rest[node].determinant() != 0.0 {
                let mut bind = new_rest[node].inverse() * placement.by_joint[slot];
                // The last row is 0 0 0 1 exactly, whatever rounding says.
                for column in 0..4 {
                    bind.col_mut(column).w = if column == 3 { 1.0 } else { 0.0 };
                }
                numbers[slot * 16..slot * 16 + 16].copy_from_slice(&bind.as_mat4().to_cols_array());
                moved = true;
            }
        }
        if moved || accessor.is_some() {
            let place = Place::InverseBinds { skin: index };
            slots.push(Slot { place, components: 16, numbers });
        }
    }
    Ok(())
}

/// Moves nodes by what their joint moves relative to its parent at rest; rotation and scale stay.
fn move_nodes(loaded: &Loaded, new_rest: &[DMat4], json: &mut Value) -> BTreeMap<usize, Shift> {
    let rest = &loaded.pose.rest;
    let mut shifts = BTreeMap::new();
    for &node in &loaded.node_of_joint {
        let parent = loaded.tree.parents[node];
        let same_parent = parent.is_none_or(|parent| rest[parent] == new_rest[parent]);
        if same_parent && rest[node] == new_rest[node] {
            continue;
        }
        let local = |rest: &[DMat4]| match parent {
            Some(parent) => rest[parent].inverse().transform_point3(rest[node].w_axis.truncate()),
            None => rest[node].w_axis.truncate(),
        };
        let (before, after) = (local(rest), local(new_rest));
        let change = after - before;
        if !change.is_finite() || change.length() <= 1e-12 * before.length() {
            continue;
        }
        shifts.insert(node, Shift { before, after });
        let pose = loaded.tree.local[node].w_axis.truncate() + change;
        let pose = pose.as_vec3();
        let node_json = &mut json["nodes"][node];
        if let Some(matrix) =
            node_json.get_mut("matrix").and_then(Value::as_array_mut).filter(|m| m.len() == 16)
        {
            for axis in 0..3 {
                matrix[12 + axis] = json!(pose[axis]);
            }
        } else {
            node_json["translation"] = json!(pose.to_array());
        }
    }
    shifts
}

/// New over old height of the hips above the ground, which is as low as the lowest vertex.
fn hip_ratio(loaded: &Loaded, deformed: &Deformed) -> f64 {
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

/// New over old height of the figure.
pub fn height_ratio(loaded: &Loaded, deformed: &Deformed) -> f64 {
    let up = loaded.character.axes.up.as_dvec3().normalize_or(DVec3::Y);
    let (low, high) = extent(loaded.character.meshes.iter().map(|mesh| mesh.positions.as_slice()), up);
    let (new_low, new_high) = extent(deformed.meshes.iter().map(|mesh| mesh.positions.as_slice()), up);
    let ratio = (new_high - new_low) / (high - low);
    if ratio.is_finite() && ratio > 0.0 { ratio } else { 1.0 }
}

/// Least and greatest height along `up`.
pub fn extent<'a>(meshes: impl Iterator<Item = &'a [Vec3]>, up: DVec3) -> (f64, f64) {
    meshes
        .flatten()
        .map(|p| p.as_dvec3().dot(up))
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), height| (low.min(height), high.max(height)))
}

/// Translation tracks: how far a key lies from the rest is scaled, and the rest is the new one.
///
/// The scale is that of the hips' height for the hips and for what does not hang from them (a root that travels, feet
/// that an animation places by themselves), and the field's own for what moves within the body (eyelids, a jaw). A track
/// that keeps a joint at its old rest keeps it at its new rest.
fn animation_slots(
    loaded: &Loaded,
    shifts: &BTreeMap<usize, Shift>,
    hip_ratio: f64,
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
                _ => hip_ratio,
            };
            if shift.is_some() || scale != 1.0 {
                for (key, raw) in numbers.chunks_exact_mut(3).enumerate() {
                    let value = Vec3::from_slice(raw).as_dvec3();
                    // In-tangent, value, out-tangent: tangents are differences.
                    let value =
                        if cubic && key % 3 != 1 { value * scale } else { after + (value - before) * scale };
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

/// An accessor that gets numbers of its own.
struct Definition {
    accessor: usize,
    numbers: Vec<f32>,
    components: usize,
    bounds: bool,
    vertex_data: bool,
    sparse: bool,
}

/// Puts the numbers of all slots into the file.
fn store(reader: &Reader, file: &mut GltfFile, slots: Vec<Slot>) -> Result<()> {
    let uses = accessor_uses(&file.json);
    let places: BTreeSet<String> = slots.iter().map(|slot| slot.place.pointer()).collect();
    // Accessors that also stand in places which keep their numbers.
    let foreign: BTreeSet<usize> = uses
        .iter()
        .filter(|(pointer, _)| !places.contains(*pointer))
        .map(|(_, &accessor)| accessor)
        .collect();
    let mut by_accessor: BTreeMap<Option<usize>, Vec<Slot>> = BTreeMap::new();
    for slot in slots {
        let accessor = uses.get(&slot.place.pointer()).copied();
        by_accessor.entry(accessor).or_default().push(slot);
    }
    let overlaps = Overlaps::of(reader);
    let mut definitions: Vec<Definition> = Vec::new();
    for (accessor, slots) in by_accessor {
        // The versions of this accessor: the numbers, and which accessor holds them.
        let mut versions: Vec<(Vec<f32>, usize)> = Vec::new();
        let mut free = accessor.filter(|accessor| !foreign.contains(accessor));
        if let Some(accessor) = accessor {
            let old = reader.floats(accessor, slots[0].components, None)?;
            if slots.iter().any(|slot| same_bits(&slot.numbers, &old)) {
                free = None;
            }
            versions.push((old, accessor));
        }
        for slot in slots {
            let known =
                versions.iter().find(|(numbers, _)| accessor.is_some() && same_bits(numbers, &slot.numbers));
            if let Some(&(_, holder)) = known {
                slot.place.set(&mut file.json, holder);
                continue;
            }
            let bounds = slot.place.needs_bounds();
            let holder = match free.take() {
                Some(accessor) => accessor,
                None => {
                    let new = match accessor {
                        Some(accessor) => file.json["accessors"][accessor].clone(),
                        None => {
                            json!({"componentType": 5126, "type": if slot.components == 16 { "MAT4" } else { "VEC3" }})
                        }
                    };
                    let Some(accessors) = file.json["accessors"].as_array_mut() else {
                        continue;
                    };
                    accessors.push(new);
                    accessors.len() - 1
                }
            };
            let layout = accessor.map(|accessor| reader.layout(accessor)).transpose()?;
            let in_place = accessor == Some(holder)
                && layout.as_ref().is_some_and(|layout| layout.component_type == 5126 && !layout.sparse)
                && !overlaps.disturbs(holder);
            if let (true, Some(layout)) = (in_place, &layout) {
                overwrite(&mut file.binary, layout, &slot.numbers);
                set_bounds(&mut file.json["accessors"][holder], &slot.numbers, slot.components, bounds);
            } else {
                definitions.push(Definition {
                    accessor: holder,
                    numbers: slot.numbers.clone(),
                    components: slot.components,
                    bounds,
                    vertex_data: slot.place.is_vertex_data(),
                    sparse: layout.as_ref().is_some_and(|layout| layout.sparse),
                });
            }
            slot.place.set(&mut file.json, holder);
            versions.push((slot.numbers, holder));
        }
    }
    if !definitions.is_empty() {
        define(file, definitions);
    }
    Ok(())
}

/// Every place of the JSON that names an accessor, by pointer.
fn accessor_uses(json: &Value) -> BTreeMap<String, usize> {
    let mut uses = BTreeMap::new();
    let mut note = |pointer: String, value: &Value| {
        if let Some(accessor) = value.as_u64() {
            uses.insert(pointer, accessor as usize);
        }
    };
    for (mesh, mesh_json) in array_at(json, "meshes").iter().enumerate() {
        for (primitive, primitive_json) in array_at(mesh_json, "primitives").iter().enumerate() {
            let place = format!("/meshes/{mesh}/primitives/{primitive}");
            note(format!("{place}/indices"), &primitive_json["indices"]);
            for (key, value) in primitive_json["attributes"].as_object().into_iter().flatten() {
                note(format!("{place}/attributes/{key}"), value);
            }
            for (target, target_json) in array_at(primitive_json, "targets").iter().enumerate() {
                for (key, value) in target_json.as_object().into_iter().flatten() {
                    note(format!("{place}/targets/{target}/{key}"), value);
                }
            }
        }
    }
    for (skin, skin_json) in array_at(json, "skins").iter().enumerate() {
        note(format!("/skins/{skin}/inverseBindMatrices"), &skin_json["inverseBindMatrices"]);
    }
    for (animation, animation_json) in array_at(json, "animations").iter().enumerate() {
        for (sampler, sampler_json) in array_at(animation_json, "samplers").iter().enumerate() {
            for key in ["input", "output"] {
                note(format!("/animations/{animation}/samplers/{sampler}/{key}"), &sampler_json[key]);
            }
        }
    }
    uses
}

/// Which accessors have bytes in common.
struct Overlaps {
    /// First byte, end, stride, element size, accessor; by first byte.
    ranges: Vec<(usize, usize, usize, usize, usize)>,
    /// The furthest end up to each entry of `ranges`.
    furthest: Vec<usize>,
}

impl Overlaps {
    fn of(reader: &Reader) -> Self {
        let mut ranges: Vec<_> = (0..reader.file.list("accessors").len())
            .filter_map(|accessor| {
                let layout = reader.layout(accessor).ok()?;
                let range = layout.range()?;
                Some((range.start, range.end, layout.stride, layout.element_size(), accessor))
            })
            .collect();
        ranges.sort_unstable();
        let mut furthest = Vec::with_capacity(ranges.len());
        for &(_, end, ..) in &ranges {
            furthest.push(end.max(furthest.last().copied().unwrap_or(0)));
        }
        Self { ranges, furthest }
    }

    /// True where writing over an accessor would change another.
    fn disturbs(&self, accessor: usize) -> bool {
        let Some(&(start, end, stride, size, _)) = self.ranges.iter().find(|range| range.4 == accessor)
        else {
            return true;
        };
        let before = self.ranges.partition_point(|range| range.0 < end);
        for at in (0..before).rev() {
            if self.furthest[at] <= start {
                break;
            }
            let (other_start, other_end, other_stride, other_size, other) = self.ranges[at];
            if other == accessor || other_end <= start {
                continue;
            }
            // Interleaved: the same steps, and different bytes within each.
            let ahead = (other_start as i64 - start as i64).rem_euclid(stride as i64) as usize;
            let apart = stride == other_stride && ahead >= size && ahead + other_size <= stride;
            if !apart {
                return true;
            }
        }
        false
    }
}

fn overwrite(binary: &mut [u8], layout: &Layout, numbers: &[f32]) {
    let Some(start) = layout.start else { return };
    for (element, values) in numbers.chunks_exact(layout.components).enumerate() {
        for (component, value) in values.iter().enumerate() {
            let at = start + element * layout.stride + component * 4;
            binary[at..at + 4].copy_from_slice(&value.to_le_bytes());
        }
    }
}

/// Writes least and greatest values where there were some or `always`.
fn set_bounds(accessor: &mut Value, numbers: &[f32], components: usize, always: bool) {
    if !always && accessor.get("min").is_none() && accessor.get("max").is_none() {
        return;
    }
    let mut low = vec![f32::INFINITY; components];
    let mut high = vec![f32::NEG_INFINITY; components];
    for values in numbers.chunks_exact(components) {
        for (component, &value) in values.iter().enumerate() {
            low[component] = low[component].min(value);
            high[component] = high[component].max(value);
        }
    }
    accessor["min"] = json!(low);
    accessor["max"] = json!(high);
}

/// Gives accessors buffer views of their own; the bytes of views that nothing names any more are dropped.
fn define(file: &mut GltfFile, definitions: Vec<Definition>) {
    let named_before = named_views(&file.json);
    for definition in &definitions {
        if let Some(accessor) = file.json["accessors"][definition.accessor].as_object_mut() {
            for key in ["bufferView", "byteOffset", "sparse", "normalized"] {
                accessor.remove(key);
            }
        }
    }
    let named = named_views(&file.json);
    // Numbers of views that are free now are given again first.
    let mut free: Vec<usize> = named_before.difference(&named).copied().collect();
    let dropped = !free.is_empty();
    if !file.json["bufferViews"].is_array() {
        file.json["bufferViews"] = json!([]);
    }
    if array_at(&file.json, "buffers").is_empty() {
        file.json["buffers"] = json!([{"byteLength": 0}]);
    }
    if dropped {
        keep_named(file, &named);
    }
    let mut add_view = |file: &mut GltfFile, bytes: Vec<u8>, vertex_data: bool| {
        file.binary.resize(file.binary.len().next_multiple_of(4), 0);
        let mut view = json!({"buffer": 0, "byteOffset": file.binary.len(), "byteLength": bytes.len()});
        if vertex_data {
            view["target"] = json!(34962);
        }
        file.binary.extend_from_slice(&bytes);
        let views = file.json["bufferViews"].as_array_mut();
        match (free.pop(), views) {
            (Some(number), Some(views)) => {
                views[number] = view;
                number
            }
            (None, Some(views)) => {
                views.push(view);
                views.len() - 1
            }
            _ => 0,
        }
    };
    for definition in definitions {
        let count = definition.numbers.len() / definition.components.max(1);
        let mut accessor = file.json["accessors"][definition.accessor].clone();
        accessor["componentType"] = json!(5126);
        accessor["count"] = json!(count);
        set_bounds(&mut accessor, &definition.numbers, definition.components, definition.bounds);
        let elements = definition.numbers.chunks_exact(definition.components);
        let set: Vec<usize> = elements
            .enumerate()
            .filter(|(_, values)| values.iter().any(|&v| v != 0.0))
            .map(|(at, _)| at)
            .collect();
        let bytes_of =
            |values: &[f32]| values.iter().flat_map(|value| value.to_le_bytes()).collect::<Vec<u8>>();
        let element_size = 4 * definition.components;
        if definition.sparse && set.len() * (element_size + 4) < count * element_size {
            if !set.is_empty() {
                let indices = set.iter().flat_map(|&at| (at as u32).to_le_bytes()).collect();
                let index_view = add_view(file, indices, false);
                let values: Vec<f32> = set
                    .iter()
                    .flat_map(|&at| {
                        &definition.numbers[at * definition.components..(at + 1) * definition.components]
                    })
                    .copied()
                    .collect();
                let value_view = add_view(file, bytes_of(&values), false);
                accessor["sparse"] = json!({
                    "count": set.len(),
                    "indices": {"bufferView": index_view, "componentType": 5125},
                    "values": {"bufferView": value_view},
                });
            }
        } else {
            let view = add_view(file, bytes_of(&definition.numbers), definition.vertex_data);
            accessor["bufferView"] = json!(view);
        }
        file.json["accessors"][definition.accessor] = accessor;
    }
    // A number that stays free: the last ones go, others become as small as a view can be.
    if let Some(views) = file.json["bufferViews"].as_array_mut() {
        free.sort_unstable();
        while free.last().is_some_and(|&last| last + 1 == views.len()) {
            free.pop();
            views.pop();
        }
        for number in free {
            views[number] = json!({"buffer": 0, "byteOffset": 0, "byteLength": 4});
        }
    }
    file.json["buffers"][0]["byteLength"] = json!(file.binary.len());
}

/// The buffer views that anything in the JSON names under `bufferView`.
fn named_views(json: &Value) -> BTreeSet<usize> {
    let mut named = BTreeSet::new();
    let mut stack = vec![json];
    while let Some(value) = stack.pop() {
        match value {
            Value::Array(values) => stack.extend(values),
            Value::Object(entries) => {
                for (key, value) in entries {
                    if key == "bufferView" {
                        named.extend(value.as_u64().map(|view| view as usize));
                    }
                    stack.push(value);
                }
            }
            _ => {}
        }
    }
    named
}

/// Keeps those bytes of the binary that the views `named` cover, and moves the views along.
fn keep_named(file: &mut GltfFile, named: &BTreeSet<usize>) {
    let span = |view: &Value| {
        let start = index_at(view, "byteOffset").unwrap_or(0);
        (start, start + index_at(view, "byteLength").unwrap_or(0))
    };
    let mut spans: Vec<(usize, usize)> = file
        .list("bufferViews")
        .iter()
        .enumerate()
        .filter(|(view, _)| named.contains(view))
        .map(|(_, v)| span(v))
        .collect();
    spans.sort_unstable();
    // Views may share bytes: pieces are runs of bytes that belong together. Each: old start, end, new start.
    let mut pieces: Vec<(usize, usize, usize)> = Vec::new();
    for (start, end) in spans {
        match pieces.last_mut().filter(|piece| start < piece.1) {
            Some(piece) => piece.1 = piece.1.max(end),
            None => pieces.push((start, end, 0)),
        }
    }
    let mut binary = Vec::new();
    for (start, end, new_start) in &mut pieces {
        // The same place within eight bytes, so that what was aligned stays so.
        let gap = (*start + 8 - binary.len() % 8) % 8;
        binary.resize(binary.len() + gap, 0);
        *new_start = binary.len();
        binary.extend_from_slice(&file.binary[*start..*end]);
    }
    for &number in named {
        let Some(view) = file.json["bufferViews"].get_mut(number) else {
            continue;
        };
        let start = index_at(view, "byteOffset").unwrap_or(0);
        let at = pieces.partition_point(|piece| piece.0 <= start);
        if let Some(piece) = at.checked_sub(1).map(|at| pieces[at]) {
            view["byteOffset"] = json!(piece.2 + (start - piece.0));
        }
    }
    file.binary = binary;
}
