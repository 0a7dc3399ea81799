//! Nodes and skins: joints move, and inverse bind matrices follow them.

use super::{Place, Slot};
use crate::accessor::Reader;
use crate::index_at;
use crate::load::Loaded;
use glam::{DMat4, DVec3};
use serde_json::{Value, json};
use std::collections::BTreeMap;
use superdeform::Result;

/// A bone length's worth of change in a joint, as its node sees it.
pub(super) struct Shift {
    /// Local translation at rest before and after.
    pub(super) before: DVec3,
    pub(super) after: DVec3,
}

/// New inverse bind matrices: J'_j B'_j stays what J_j B_j was, so that all weights keep their meaning.
pub(super) fn skin_slots(
    loaded: &Loaded,
    new_rest: &[DMat4],
    reader: &Reader,
    slots: &mut Vec<Slot>,
) -> Result<()> {
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
pub(super) fn move_nodes(loaded: &Loaded, new_rest: &[DMat4], json: &mut Value) -> BTreeMap<usize, Shift> {
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
