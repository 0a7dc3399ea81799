//! Numbers and vectors as VRM files write them. What changes by rounding alone stays as it is written.

use glam::DVec3;
use serde_json::{Value, json};

/// A vector written as an array (VRM 1.0).
pub(super) fn vector(value: &Value) -> Option<DVec3> {
    let numbers: Vec<f64> = value.as_array()?.iter().filter_map(Value::as_f64).collect();
    <[f64; 3]>::try_from(numbers).ok().map(DVec3::from)
}

/// True for a change beyond rounding.
fn differs(before: f64, after: f64) -> bool {
    (after - before).abs() > 1e-9 * before.abs().max(1e-6)
}

pub(super) fn put(value: &mut Value, before: DVec3, after: DVec3) {
    if (0..3).any(|axis| differs(before[axis], after[axis])) {
        *value = json!(after.as_vec3().to_array());
    }
}

/// The number at `key`; one that is not there has the value `default`.
pub(super) fn number(holder: &Value, key: &str, default: f64) -> f64 {
    holder.get(key).and_then(Value::as_f64).unwrap_or(default)
}

/// Multiplies the number at `key`; one that is not there has the value `default`.
pub(super) fn multiply(holder: &mut Value, key: &str, default: f64, factor: f64) {
    let before = number(holder, key, default);
    let after = before * factor;
    if holder.is_object() && differs(before, after) {
        holder[key] = json!(after as f32);
    }
}

/// VRM 0.x writes z negated against the node's own space.
pub(crate) const FLIPPED: DVec3 = DVec3::new(1.0, 1.0, -1.0);

/// A vector {x, y, z} of VRM 0.x in its node's space.
pub(super) fn flipped_vector(value: &Value) -> DVec3 {
    DVec3::from(["x", "y", "z"].map(|key| number(value, key, 0.0))) * FLIPPED
}

/// Writes `after`, in the node's space, over such a vector.
pub(super) fn put_flipped(value: &mut Value, before: DVec3, after: DVec3) {
    if value.is_object() && (0..3).any(|axis| differs(before[axis], after[axis])) {
        for (axis, key) in ["x", "y", "z"].into_iter().enumerate() {
            value[key] = json!((after * FLIPPED)[axis] as f32);
        }
    }
}
