//! A new rig in a file: joints as nodes, a skin, four influences a vertex.

use super::file::GltfFile;
use super::load::{Loaded, Placement};
use super::{array_at, bad_input, index_at, indices_at};
use glam::{DMat4, DVec3};
use serde_json::{Map, Value, json};
use std::collections::{BTreeMap, BTreeSet};
use superdeform::{Result, Skeleton, Weights};

/// Influences a vertex: what one pair of attributes holds, and what every engine reads.
pub const INFLUENCES: usize = 4;

const BYTE: u32 = 5121;
const SHORT: u32 = 5123;
const FLOAT: u32 = 5126;
const VERTEX_DATA: u32 = 34962;

/// Headers of avatars, which are about the joints of the old rig.
const AVATAR_HEADERS: [&str; 5] =
    ["VRM", "VRMC_vrm", "VRMC_springBone", "VRMC_vrm_animation", "VRMC_springBone_extended_collider"];

/// The target as it came, with a rig of its own in place of any that it had; headers of avatars go with the old rig.
///
/// # Errors
/// As [`add_rig`].
pub fn rerigged(loaded: &Loaded, skeleton: &Skeleton, weights: &[Weights]) -> Result<GltfFile> {
    let mut file = loaded.file.clone();
    if let Some(extensions) = file.json.get_mut("extensions").and_then(Value::as_object_mut) {
        extensions.retain(|name, _| !AVATAR_HEADERS.contains(&name.as_str()));
        if extensions.is_empty() {
            file.json.as_object_mut().map(|json| json.remove("extensions"));
        }
    }
    for list in ["extensionsUsed", "extensionsRequired"] {
        let Some(names) = file.json.get_mut(list).and_then(Value::as_array_mut) else { continue };
        names.retain(|name| !name.as_str().is_some_and(|name| AVATAR_HEADERS.contains(&name)));
        if names.is_empty() {
            file.json.as_object_mut().map(|json| json.remove(list));
        }
    }
    for node in file.json.get_mut("nodes").and_then(Value::as_array_mut).into_iter().flatten() {
        node.as_object_mut().map(|node| node.remove("skin"));
    }
    file.json.as_object_mut().map(|json| json.remove("skins"));
    let old = file.list("nodes").len();
    add_rig(&mut file, loaded, skeleton, weights)?;
    hide_empty(&mut file, old);
    Ok(file)
}

/// Takes those of the first `count` nodes that show nothing any more out of the scenes, with what animates them: joints
/// of a rig that is no longer there would be taken for the new one's.
fn hide_empty(file: &mut GltfFile, count: usize) {
    let nodes = file.list("nodes");
    let shows = |node: &Value| {
        ["mesh", "camera"].iter().any(|key| node.get(*key).is_some())
            || node["extensions"]["KHR_lights_punctual"].is_object()
    };
    let mut shown: Vec<bool> =
        nodes.iter().enumerate().map(|(index, node)| index >= count || shows(node)).collect();
    // What holds something that is shown stays too; a chain of nodes is no longer than there are nodes.
    loop {
        let holds = |node: &Value| indices_at(node, "children").any(|child| shown[child]);
        let more: Vec<usize> = (0..nodes.len()).filter(|&node| !shown[node] && holds(&nodes[node])).collect();
        if more.is_empty() {
            break;
        }
        more.into_iter().for_each(|node| shown[node] = true);
    }
    let is_shown = |node: &Value| node.as_u64().is_none_or(|node| shown[node as usize]);
    for list in file.json.get_mut("scenes").and_then(Value::as_array_mut).into_iter().flatten() {
        if let Some(nodes) = list.get_mut("nodes").and_then(Value::as_array_mut) {
            nodes.retain(is_shown);
        }
    }
    for node in file.json.get_mut("nodes").and_then(Value::as_array_mut).into_iter().flatten().take(count) {
        let Some(children) = node.get_mut("children").and_then(Value::as_array_mut) else { continue };
        children.retain(is_shown);
        if children.is_empty() {
            node.as_object_mut().map(|node| node.remove("children"));
        }
    }
    let Some(animations) = file.json.get_mut("animations").and_then(Value::as_array_mut) else { return };
    for animation in animations.iter_mut() {
        if let Some(channels) = animation.get_mut("channels").and_then(Value::as_array_mut) {
            channels.retain(|channel| is_shown(&channel["target"]["node"]));
        }
    }
    animations.retain(|animation| !array_at(animation, "channels").is_empty());
    if animations.is_empty() {
        file.json.as_object_mut().map(|json| json.remove("animations"));
    }
}

/// Gives `file`, which holds the meshes of `loaded` without a skin, the joints of `skeleton` and `weights` to them.
///
/// - `skeleton`: model space, at rest in the pose of the file's vertices.
/// - `weights`: one for each mesh of `loaded.character`, at most [`INFLUENCES`] a vertex.
///
/// Skinned meshes hang from the scene itself, since a skin sets aside the transform of a mesh's node.
///
/// # Errors
/// A mesh that two skins place differently.
pub fn add_rig(file: &mut GltfFile, loaded: &Loaded, skeleton: &Skeleton, weights: &[Weights]) -> Result<()> {
    for list in ["nodes", "accessors", "bufferViews", "skins"] {
        if !file.json[list].is_array() {
            file.json[list] = json!([]);
        }
    }
    let joint_nodes = add_joints(file, skeleton);
    let mut of_node: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    for (index, binding) in loaded.bindings.iter().enumerate() {
        of_node.entry(binding.node).or_default().push(index);
    }
    let mut skins: Vec<(DMat4, usize)> = Vec::new();
    let mut taken = BTreeSet::new();
    for (node, indices) in of_node {
        let placement = match loaded.bindings[indices[0]].skin {
            Some(_) => loaded.bindings[indices[0]].placement.clone(),
            None => Placement::Common(loaded.pose.rest[node]),
        };
        let Placement::Common(matrix) = placement else {
            return Err(bad_input(format!(
                "{}: mesh {} cannot get a new rig, for its joints are bound in two poses: apply the rest pose in a modelling program and export the file anew",
                file.name, loaded.bindings[indices[0]].mesh
            )));
        };
        let skin = match skins.iter().find(|(known, _)| *known == matrix) {
            Some(&(_, skin)) => skin,
            None => {
                let skin = add_skin(file, skeleton, &joint_nodes, matrix);
                skins.push((matrix, skin));
                skin
            }
        };
        let mut mesh =
            index_at(&file.json["nodes"][node], "mesh").unwrap_or(loaded.bindings[indices[0]].mesh);
        if !taken.insert(mesh) {
            // Another node shows this mesh elsewhere, where other joints move it.
            let copy = file.json["meshes"][mesh].clone();
            mesh = push(&mut file.json["meshes"], copy);
            taken.insert(mesh);
        }
        for index in indices {
            let primitive = loaded.bindings[index].primitive;
            let (joints, shares) = add_weights(file, &weights[index]);
            let attributes = &mut file.json["meshes"][mesh]["primitives"][primitive]["attributes"];
            if let Some(attributes) = attributes.as_object_mut() {
                attributes.retain(|key, _| !key.starts_with("JOINTS_") && !key.starts_with("WEIGHTS_"));
                attributes.insert("JOINTS_0".to_string(), json!(joints));
                attributes.insert("WEIGHTS_0".to_string(), json!(shares));
            }
        }
        show(file, loaded, node, mesh, skin);
    }
    if let Some(buffer) = file.json["buffers"].get_mut(0) {
        buffer["byteLength"] = json!(file.binary.len());
    } else {
        file.json["buffers"] = json!([{"byteLength": file.binary.len()}]);
    }
    Ok(())
}

/// Joints as nodes below one that stands for the rig; gives the nodes.
fn add_joints(file: &mut GltfFile, skeleton: &Skeleton) -> Vec<usize> {
    let first = file.list("nodes").len();
    let nodes: Vec<usize> = (first..first + skeleton.joints.len()).collect();
    let children = skeleton.children();
    for (joint, below) in skeleton.joints.iter().zip(&children) {
        let parent = joint.parent.map_or(DVec3::ZERO, |parent| skeleton.joints[parent].position());
        let mut node = json!({
            "name": joint.name,
            "translation": (joint.position() - parent).as_vec3().to_array(),
        });
        if !below.is_empty() {
            node["children"] = json!(below.iter().map(|&child| nodes[child]).collect::<Vec<_>>());
        }
        push(&mut file.json["nodes"], node);
    }
    let roots: Vec<usize> = skeleton
        .joints
        .iter()
        .zip(&nodes)
        .filter(|(joint, _)| joint.parent.is_none())
        .map(|(_, &node)| node)
        .collect();
    let rig = push(&mut file.json["nodes"], json!({"name": "rig", "children": roots}));
    add_to_scene(file, rig);
    nodes
}

fn add_to_scene(file: &mut GltfFile, node: usize) {
    let scene = index_at(&file.json, "scene").unwrap_or(0);
    if let Some(scene) = file.json["scenes"].get_mut(scene) {
        if !scene["nodes"].is_array() {
            scene["nodes"] = json!([]);
        }
        push(&mut scene["nodes"], json!(node));
    }
}

/// A skin for meshes that `matrix` takes to model space.
fn add_skin(file: &mut GltfFile, skeleton: &Skeleton, nodes: &[usize], matrix: DMat4) -> usize {
    let mut bytes = Vec::with_capacity(64 * nodes.len());
    for joint in &skeleton.joints {
        let mut bind = DMat4::from_translation(-joint.position()) * matrix;
        // The last row is 0 0 0 1 exactly, whatever rounding says.
        for column in 0..4 {
            bind.col_mut(column).w = if column == 3 { 1.0 } else { 0.0 };
        }
        bytes.extend(bind.as_mat4().to_cols_array().iter().flat_map(|number| number.to_le_bytes()));
    }
    let binds = add_floats(file, bytes, nodes.len(), "MAT4");
    push(&mut file.json["skins"], json!({"name": "rig", "joints": nodes, "inverseBindMatrices": binds}))
}

/// Joints and weights of one primitive as accessors.
fn add_weights(file: &mut GltfFile, weights: &Weights) -> (usize, usize) {
    let wide = weights.rows().flatten().any(|&(joint, _)| joint > u32::from(u8::MAX));
    let mut joints = Vec::new();
    let mut shares = Vec::new();
    for row in weights.rows() {
        for influence in 0..INFLUENCES {
            let (joint, share) = row.get(influence).copied().unwrap_or((0, 0.0));
            if wide {
                joints.extend((joint as u16).to_le_bytes());
            } else {
                joints.push(joint as u8);
            }
            shares.extend(share.to_le_bytes());
        }
    }
    let count = weights.row_count();
    let kind = if wide { SHORT } else { BYTE };
    let joints = add_accessor(file, joints, count, kind, "VEC4", Some(VERTEX_DATA));
    let shares = add_accessor(file, shares, count, FLOAT, "VEC4", Some(VERTEX_DATA));
    (joints, shares)
}

/// Adds an accessor of floats and gives its number.
pub(crate) fn add_floats(file: &mut GltfFile, bytes: Vec<u8>, count: usize, shape: &str) -> usize {
    add_accessor(file, bytes, count, FLOAT, shape, None)
}

fn add_accessor(
    file: &mut GltfFile,
    bytes: Vec<u8>,
    count: usize,
    component: u32,
    shape: &str,
    target: Option<u32>,
) -> usize {
    file.binary.resize(file.binary.len().next_multiple_of(4), 0);
    let mut view = json!({"buffer": 0, "byteOffset": file.binary.len(), "byteLength": bytes.len()});
    if let Some(target) = target {
        view["target"] = json!(target);
    }
    file.binary.extend(bytes);
    let view = push(&mut file.json["bufferViews"], view);
    let accessor = json!({"bufferView": view, "componentType": component, "count": count, "type": shape});
    push(&mut file.json["accessors"], accessor)
}

/// Shows `mesh` with `skin` where `node` showed it: by the node itself where it stands at the root of the scene and
/// moves nothing, else by a new one there.
fn show(file: &mut GltfFile, loaded: &Loaded, node: usize, mesh: usize, skin: usize) {
    let plain = loaded.tree.parents[node].is_none()
        && loaded.tree.local[node] == DMat4::IDENTITY
        && array_at(&file.json["nodes"][node], "children").is_empty();
    if plain {
        file.json["nodes"][node]["mesh"] = json!(mesh);
        file.json["nodes"][node]["skin"] = json!(skin);
        return;
    }
    let mut shown = Map::new();
    if let Some(old) = file.json["nodes"][node].as_object_mut() {
        old.remove("mesh");
        if let Some(name) = old.get("name") {
            shown.insert("name".to_string(), name.clone());
        }
        if let Some(weights) = old.remove("weights") {
            shown.insert("weights".to_string(), weights);
        }
    }
    shown.insert("mesh".to_string(), json!(mesh));
    shown.insert("skin".to_string(), json!(skin));
    let new = push(&mut file.json["nodes"], Value::Object(shown));
    add_to_scene(file, new);
    // Expressions that an animation plays are the mesh's.
    for animation in file.json.get_mut("animations").and_then(Value::as_array_mut).into_iter().flatten() {
        for channel in animation.get_mut("channels").and_then(Value::as_array_mut).into_iter().flatten() {
            let Some(target) = channel.get_mut("target") else { continue };
            if target["path"] == "weights" && index_at(target, "node") == Some(node) {
                target["node"] = json!(new);
            }
        }
    }
}

/// Adds `value` to a list of the JSON and gives its number.
fn push(list: &mut Value, value: Value) -> usize {
    let Some(list) = list.as_array_mut() else {
        return 0;
    };
    list.push(value);
    list.len() - 1
}
