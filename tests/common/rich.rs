//! A VRM 1.0 header with all that one may hold and few files do: every kind of collider, constraint, bind and look-at.
#![allow(dead_code)]

use crate::made::{Made, figure};
use serde_json::json;

/// The made figure with it; `look_at`: `bone` or `expression`.
pub fn rich(look_at: &str) -> Made {
    let mut made = figure();
    made.json["materials"] =
        json!([{"name": "Skin", "extensions": {"VRMC_materials_mtoon": {"specVersion": "1.0"}}}]);
    made.json["meshes"][0]["primitives"][0]["material"] = json!(0);
    made.json["extensionsUsed"] = json!([
        "VRMC_vrm",
        "VRMC_springBone",
        "VRMC_springBone_extended_collider",
        "VRMC_node_constraint",
        "VRMC_materials_mtoon",
        "ACME_secret"
    ]);
    let range = |output: f64| json!({"inputMaxValue": 90.0, "outputScale": output});
    let vrm = &mut made.json["extensions"]["VRMC_vrm"];
    vrm["meta"] = json!({"name": "Rich", "authors": ["Nobody"], "modification": "allowModification", "licenseUrl": "https://vrm.dev/licenses/1.0/"});
    vrm["lookAt"] = json!({
        "type": look_at, "offsetFromHeadBone": [0.0, 0.06, 0.0],
        "rangeMapHorizontalInner": range(8.0), "rangeMapHorizontalOuter": range(9.0),
        "rangeMapVerticalDown": range(7.0), "rangeMapVerticalUp": range(6.0),
    });
    vrm["firstPerson"] = json!({"meshAnnotations": [{"node": 12, "type": "thirdPersonOnly"}]});
    vrm["expressions"] = json!({
        "preset": {"happy": {
            "morphTargetBinds": [{"node": 12, "index": 0, "weight": 0.75}],
            "materialColorBinds": [{"material": 0, "type": "emissionColor", "targetValue": [1.0, 0.5, 0.0, 1.0]}],
            "textureTransformBinds": [{"material": 0, "scale": [1.0, 2.0], "offset": [0.25, 0.0]}],
            "isBinary": true, "overrideBlink": "block", "overrideLookAt": "blend", "overrideMouth": "none",
        }},
        "custom": {"wink": {"morphTargetBinds": [{"node": 12, "index": 0, "weight": 1.0}]}},
    });
    vrm["extras"] = json!({"deep": [1, {"empty": []}, 9_007_199_254_740_993_u64]});
    let extended = |shape: serde_json::Value| json!({"specVersion": "1.0", "shape": shape});
    let collider = |node: usize, shape: serde_json::Value| json!({"node": node, "shape": shape});
    let mut inside_sphere = collider(2, json!({"sphere": {"offset": [0.0, 0.0, 0.0], "radius": 0.01}}));
    inside_sphere["extensions"]["VRMC_springBone_extended_collider"] =
        extended(json!({"sphere": {"offset": [0.0, 0.1, 0.0], "radius": 0.9, "inside": true}}));
    let mut inside_capsule = collider(2, json!({"sphere": {"offset": [0.0, 0.0, 0.0], "radius": 0.01}}));
    inside_capsule["extensions"]["VRMC_springBone_extended_collider"] = extended(
        json!({"capsule": {"offset": [0.0, 0.0, 0.0], "tail": [0.0, 0.3, 0.0], "radius": 0.8, "inside": true}}),
    );
    let mut plane = collider(3, json!({"sphere": {"offset": [0.0, 0.0, 0.0], "radius": 0.0}}));
    plane["extensions"]["VRMC_springBone_extended_collider"] =
        extended(json!({"plane": {"offset": [0.0, -0.5, 0.0], "normal": [0.0, 1.0, 0.0]}}));
    made.json["extensions"]["VRMC_springBone"] = json!({
        "specVersion": "1.0",
        "colliders": [
            collider(2, json!({"sphere": {"offset": [0.0, 0.05, 0.0], "radius": 0.02}})),
            collider(1, json!({"capsule": {"offset": [0.0, 0.0, 0.0], "tail": [0.0, 0.1, 0.0], "radius": 0.02}})),
            inside_sphere, inside_capsule, plane,
        ],
        "colliderGroups": [{"name": "all", "colliders": [0, 1, 2, 3, 4]}],
        "springs": [{
            "name": "strand", "center": 3, "colliderGroups": [0],
            "joints": [{"node": 10, "hitRadius": 0.02, "stiffness": 0.7, "gravityPower": 0.1, "gravityDir": [0.0, -1.0, 0.0], "dragForce": 0.3}, {"node": 11}],
        }],
    });
    let constraint = |constraint: serde_json::Value| json!({"specVersion": "1.0", "constraint": constraint});
    for (node, held) in [
        (4, json!({"roll": {"source": 5, "rollAxis": "X", "weight": 0.5}})),
        (5, json!({"rotation": {"source": 4, "weight": 0.25}})),
        (8, json!({"aim": {"source": 6, "aimAxis": "PositiveY", "weight": 1.0}})),
    ] {
        made.json["nodes"][node]["extensions"]["VRMC_node_constraint"] = constraint(held);
    }
    made.json["nodes"][9]["extensions"]["ACME_secret"] = json!({"keep": "me"});
    made
}

/// Places in `after` whose value is another than in `before`, as JSON pointers.
pub fn changed(before: &serde_json::Value, after: &serde_json::Value, at: &str, found: &mut Vec<String>) {
    use serde_json::Value::{Array, Object};
    match (before, after) {
        (Object(one), Object(other)) => {
            for key in one.keys().chain(other.keys().filter(|key| !one.contains_key(*key))) {
                changed(&before[key], &after[key], &format!("{at}/{key}"), found);
            }
        }
        (Array(one), Array(other)) if one.len() == other.len() => {
            for (index, (one, other)) in one.iter().zip(other).enumerate() {
                changed(one, other, &format!("{at}/{index}"), found);
            }
        }
        _ if before == after => {}
        _ => found.push(at.to_string()),
    }
}
