//! What VRM files hold beside the meshes in model units: spring bones, colliders, viewpoint, outlines.
//!
//! A point is attached to a node and stands in its space: it is mapped like a vertex of that joint and then expressed
//! in the moved node's space. Lengths around a point (radii, stiffness, gravity) are multiplied by the local scale. Gravity
//! gives way where a chain stands off further than it did, so that it hangs at rest as it hung.

use super::numbers::{flipped_vector, multiply, number, put, put_flipped, vector};
use super::{MapPoint, colliders};
use crate::load::Loaded;
use crate::{array_at, index_at, text_at};
use glam::{DMat4, DVec3};
use serde_json::Value;
use superdeform::Role;

/// The field at nodes of one file.
struct Field<'a> {
    loaded: &'a Loaded,
    new_rest: &'a [DMat4],
    map_point: &'a MapPoint<'a>,
}

impl Field<'_> {
    fn joint(&self, node: usize) -> Option<usize> {
        self.loaded.joint_of_node.get(node).copied().flatten()
    }

    /// Where a point of a node's space goes (in the moved node's space), and the local scale.
    fn at(&self, node: usize, local: DVec3) -> Option<(DVec3, f64)> {
        let joint = self.joint(node)?;
        let mapped = (self.map_point)(joint, self.loaded.pose.rest[node].transform_point3(local));
        let back = self.new_rest[node].inverse().transform_point3(mapped.position);
        let scale = mapped.local_scale();
        (back.is_finite() && scale.is_finite()).then_some((back, scale))
    }

    fn scale(&self, node: usize) -> Option<f64> {
        self.at(node, DVec3::ZERO).map(|(_, scale)| scale)
    }

    /// The bone from a node to another, before and after.
    fn bone(&self, from: usize, to: usize) -> Option<[DVec3; 2]> {
        let between = |rest: &[DMat4]| Some((rest.get(to)?.w_axis - rest.get(from)?.w_axis).truncate());
        Some([between(&self.loaded.pose.rest)?, between(self.new_rest)?])
    }
}

/// A bone of a spring, before and after, and its gravity over its stiffness.
struct Pulled {
    bone: [DVec3; 2],
    down: DVec3,
    pull: f64,
}

/// The share of their gravity with which the bones of a chain bend at rest as far as they did, in the mean; at most 1.
///
/// Gravity and stiffness, r to 1 and at an angle a, balance where the bone is bent by atan(r sin a / (1 + r cos a)). At the
/// angle b, r' bends it as far where r' (sin b + r sin(b - a)) = r sin a. What is not stiff hangs straight down anyway.
fn gravity_kept(bones: impl Iterator<Item = Pulled>) -> f64 {
    let [mut before, mut after] = [0.0; 2];
    for Pulled { bone, down, pull } in bones {
        let [a, b] = bone.map(|bone| bone.angle_between(down));
        if (a + b + pull).is_finite() {
            before += a.sin();
            after += b.sin() + pull * (b - a).sin();
        }
    }
    if before < after { before / after } else { 1.0 }
}

/// Moves and scales everything of a VRM header, 0.x or 1.0, that stands in model units.
///
/// - `new_rest`: the rest transforms of the nodes after the deformation.
/// - `height_ratio`: new over old height of the figure, for outlines.
pub(super) fn move_points(
    json: &mut Value,
    loaded: &Loaded,
    new_rest: &[DMat4],
    map_point: &MapPoint,
    height_ratio: f64,
) {
    scale_outlines(json, height_ratio);
    if !loaded.rigged {
        return;
    }
    colliders::move_colliders(json, loaded, new_rest, map_point);
    let field = Field { loaded, new_rest, map_point };
    if let Some(vrm) = json.pointer_mut("/extensions/VRM") {
        vrm0(vrm, &field);
    }
    let head = loaded.character.humanoid.joint(Role::Head).map(|joint| loaded.node_of_joint[joint]);
    if let (Some(head), Some(offset)) =
        (head, json.pointer_mut("/extensions/VRMC_vrm/lookAt/offsetFromHeadBone"))
        && let Some(local) = vector(offset)
        && let Some((moved, _)) = field.at(head, local)
    {
        put(offset, local, moved);
    }
    if let Some(springs) = json.pointer_mut("/extensions/VRMC_springBone") {
        vrm1_springs(springs, &field);
    }
}

/// VRM 1.0 springs.
fn vrm1_springs(springs: &mut Value, field: &Field) {
    for spring in list(springs, "springs") {
        let pulled = |pair: &[Value]| {
            let bone = field.bone(index_at(&pair[0], "node")?, index_at(&pair[1], "node")?)?;
            let down = pair[0].get("gravityDir").and_then(vector).unwrap_or(DVec3::NEG_Y);
            let pull = number(&pair[0], "gravityPower", 0.0) / number(&pair[0], "stiffness", 1.0);
            Some(Pulled { bone, down, pull })
        };
        let kept = gravity_kept(array_at(spring, "joints").windows(2).filter_map(pulled));
        for joint in list(spring, "joints") {
            let Some(scale) = index_at(joint, "node").and_then(|node| field.scale(node)) else {
                continue;
            };
            // The step of a spring is stiffness and gravity in model units: only scaled does it swing the same.
            multiply(joint, "hitRadius", 0.0, scale);
            multiply(joint, "stiffness", 1.0, scale);
            multiply(joint, "gravityPower", 0.0, scale * kept);
        }
    }
}

fn list<'a>(value: &'a mut Value, key: &str) -> impl Iterator<Item = &'a mut Value> {
    value.get_mut(key).and_then(Value::as_array_mut).into_iter().flatten()
}

/// VRM 0.x: `firstPerson` and `secondaryAnimation`.
///
/// Vectors of VRM 0.x stand as the left-handed engine of its first exporter has them, nodes as glTF has them, and the
/// importer turns the one into the other by negating z: the offsets of colliders and of the viewpoint therefore have z
/// negated against the node's own space (so do the readers of UniVRM and three-vrm: "z is opposite in VRM0.0").
fn vrm0(vrm: &mut Value, field: &Field) {
    if let Some(first_person) = vrm.get_mut("firstPerson") {
        let bone = first_person.get("firstPersonBone").and_then(Value::as_i64).filter(|&node| node >= 0);
        let head =
            field.loaded.character.humanoid.joint(Role::Head).map(|joint| field.loaded.node_of_joint[joint]);
        if let Some(node) = bone.map(|node| node as usize).or(head)
            && let Some(offset) = first_person.get_mut("firstPersonBoneOffset")
        {
            let before = flipped_vector(offset);
            if let Some((moved, _)) = field.at(node, before) {
                put_flipped(offset, before, moved);
            }
        }
    }
    let Some(animation) = vrm.get_mut("secondaryAnimation") else {
        return;
    };
    let tree = &field.loaded.tree;
    for group in list(animation, "boneGroups") {
        // One set of numbers for several chains: the mean scale of all their joints.
        let chain: Vec<usize> = colliders::chain(field.loaded, group)
            .into_iter()
            .filter(|&node| field.joint(node).is_some())
            .collect();
        let scales: Vec<f64> = chain.iter().filter_map(|&node| field.scale(node)).collect();
        if scales.is_empty() {
            continue;
        }
        let scale = scales.iter().sum::<f64>() / scales.len() as f64;
        let pull = number(group, "gravityPower", 0.0) / number(group, "stiffiness", 0.0);
        let down = group.get("gravityDir").map_or(DVec3::NEG_Y, flipped_vector);
        let pulled = |&node: &usize| {
            let parent = tree.parents[node].filter(|parent| chain.contains(parent))?;
            Some(Pulled { bone: field.bone(parent, node)?, down, pull })
        };
        let kept = gravity_kept(chain.iter().filter_map(pulled));
        multiply(group, "hitRadius", 0.0, scale);
        // VRM 0.x spells it so.
        multiply(group, "stiffiness", 0.0, scale);
        multiply(group, "gravityPower", 0.0, scale * kept);
    }
}

/// Outlines whose width is a length, not a share of the picture, keep their look on a smaller figure.
fn scale_outlines(json: &mut Value, height_ratio: f64) {
    for material in list(json, "materials") {
        if let Some(toon) = material.pointer_mut("/extensions/VRMC_materials_mtoon")
            && text_at(toon, "outlineWidthMode") == "worldCoordinates"
        {
            multiply(toon, "outlineWidthFactor", 0.0, height_ratio);
        }
    }
    if let Some(vrm) = json.pointer_mut("/extensions/VRM") {
        for material in list(vrm, "materialProperties") {
            let Some(floats) = material.get_mut("floatProperties") else {
                continue;
            };
            // 0 none, 1 world coordinates, 2 screen coordinates.
            if floats.get("_OutlineWidthMode").and_then(Value::as_f64) == Some(1.0) {
                multiply(floats, "_OutlineWidth", 0.0, height_ratio);
            }
        }
    }
}
