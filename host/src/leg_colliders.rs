//! Colliders around the legs of a VRM whose skirt hangs from springs that none keeps out of them.
//!
//! Legs that become short and stout step through such a skirt where longer ones had passed below it.

use crate::load::Loaded;
use crate::write::colliders::{chain, node_scale};
use crate::write::numbers::FLIPPED;
use crate::{array_at, index_at, indices_at};
use glam::DVec3;
use serde_json::{Value, json};
use superdeform::internals::geometry::foot;
use superdeform::{Role, Warning};

/// What ends nearer to a thigh than this share of its length hangs beside it: a skirt as wide as the thigh is long.
const BESIDE: f64 = 0.5;
/// Spheres along a bone, for VRM 0.x, which has no capsules.
const SPHERES: u32 = 4;

/// A bone of a leg, in model space.
struct Bone {
    joint: usize,
    node: usize,
    from: DVec3,
    to: DVec3,
    is_thigh: bool,
}

/// Which springs hang beside the legs and go by no collider of theirs: pointers to them in the file.
fn unguarded(loaded: &Loaded, legs: &[Bone]) -> Vec<String> {
    use Role::*;
    let json = &loaded.file.json;
    let is_of_leg = |node: usize| legs.iter().any(|leg| leg.node == node);
    let hangs = |nodes: &[usize]| {
        let Some(&root) = nodes.first() else { return false };
        let hangs_from_leg_or_hips = std::iter::successors(Some(root), |&node| loaded.tree.parents[node])
            .find_map(|node| {
                let joint = loaded.joint_of_node[node]?;
                loaded.character.humanoid.iter().find(|&(_, of_role)| of_role == joint)
            })
            .is_some_and(|(role, _)| matches!(role, Hips | LeftUpperLeg | RightUpperLeg));
        hangs_from_leg_or_hips
            && nodes.iter().any(|&node| {
                let p = loaded.pose.rest[node].w_axis.truncate();
                legs.iter().filter(|leg| leg.is_thigh).any(|thigh| {
                    let (nearest, share) = foot(p, thigh.from, thigh.to);
                    share > 0.0 && p.distance(nearest) < BESIDE * thigh.from.distance(thigh.to)
                })
            })
    };
    let mut found = Vec::new();
    let springs = &json["extensions"]["VRMC_springBone"];
    for (index, spring) in array_at(springs, "springs").iter().enumerate() {
        let nodes: Vec<usize> =
            array_at(spring, "joints").iter().filter_map(|joint| index_at(joint, "node")).collect();
        let mut guards = indices_at(spring, "colliderGroups")
            .filter_map(|group| array_at(springs, "colliderGroups").get(group))
            .flat_map(|group| indices_at(group, "colliders"))
            .filter_map(|collider| index_at(array_at(springs, "colliders").get(collider)?, "node"));
        if !guards.any(is_of_leg) && hangs(&nodes) {
            found.push(format!("/extensions/VRMC_springBone/springs/{index}"));
        }
    }
    let animation = &json["extensions"]["VRM"]["secondaryAnimation"];
    for (index, group) in array_at(animation, "boneGroups").iter().enumerate() {
        let mut guards = indices_at(group, "colliderGroups")
            .filter_map(|group| index_at(array_at(animation, "colliderGroups").get(group)?, "node"));
        if !guards.any(is_of_leg) && hangs(&chain(loaded, group)) {
            found.push(format!("/extensions/VRM/secondaryAnimation/boneGroups/{index}"));
        }
    }
    found
}

/// Thigh and shin of either side, as far as they are there.
fn legs(loaded: &Loaded) -> Vec<Bone> {
    use Role::*;
    let character = &loaded.character;
    let place = |role: Role| {
        let joint = character.humanoid.joint(role)?;
        Some((joint, character.skeleton.joints[joint].position()))
    };
    let bone = |(role, next, is_thigh): (Role, Role, bool)| {
        let ((joint, from), (_, to)) = (place(role)?, place(next)?);
        Some(Bone { joint, node: loaded.node_of_joint[joint], from, to, is_thigh })
    };
    let left = [(LeftUpperLeg, LeftLowerLeg, true), (LeftLowerLeg, LeftFoot, false)];
    let right = left.map(|(role, next, is_thigh)| (role.mirrored(), next.mirrored(), is_thigh));
    left.into_iter().chain(right).filter_map(bone).collect()
}

/// The median of how far what a bone moves is from it; `None` where it moves nothing.
fn radius(loaded: &Loaded, bone: &Bone) -> Option<f64> {
    let mut away: Vec<f64> = loaded
        .character
        .meshes
        .iter()
        .flat_map(|mesh| mesh.weights.rows().zip(&mesh.positions))
        .filter(|(row, _)| row.iter().any(|&(by, weight)| by as usize == bone.joint && weight > 0.5))
        .map(|(_, p)| p.as_dvec3().distance(foot(p.as_dvec3(), bone.from, bone.to).0))
        .collect();
    away.sort_by(f64::total_cmp);
    away.get(away.len() / 2).copied()
}

/// Whether springs hang beside legs that no collider keeps them out of: told, or where `adds`, mended in the file.
///
/// - `skirt_without_colliders`: how many there are; with colliders that are added, `leg_colliders_added`.
pub fn guard_legs(loaded: &mut Loaded, adds: bool) {
    if !loaded.rigged {
        return;
    }
    let legs = legs(loaded);
    let springs = unguarded(loaded, &legs);
    if springs.is_empty() {
        return;
    }
    if !adds {
        let message = format!(
            "{}: {} spring chains hang beside the legs, and no collider keeps them out: legs that walk go through them unless leg colliders are added",
            loaded.file.name,
            springs.len()
        );
        loaded.warnings.push(Warning::new("skirt_without_colliders", message).about("leg_colliders"));
        return;
    }
    let groups: Vec<usize> = legs.iter().filter_map(|leg| add(loaded, leg)).collect();
    let message = format!(
        "{}: colliders around {} bones of the legs guard {} spring chains",
        loaded.file.name,
        groups.len(),
        springs.len()
    );
    loaded.warnings.push(Warning::new("leg_colliders_added", message).about("leg_colliders"));
    for spring in springs {
        let Some(spring) = loaded.file.json.pointer_mut(&spring) else { continue };
        let mut all: Vec<Value> = array_at(spring, "colliderGroups").to_vec();
        all.extend(groups.iter().map(|&group| json!(group)));
        spring["colliderGroups"] = json!(all);
    }
}

/// Adds a bone's collider; the number of its group, `None` where the bone moves nothing.
fn add(loaded: &mut Loaded, leg: &Bone) -> Option<usize> {
    let rest = loaded.pose.rest[leg.node];
    let local = |p: DVec3| rest.inverse().transform_point3(p);
    let radius = (radius(loaded, leg)? / node_scale(&rest)) as f32;
    let push = |list: &mut Value, value: Value| {
        if !list.is_array() {
            *list = json!([]);
        }
        let list = list.as_array_mut().expect("it is one now");
        list.push(value);
        list.len() - 1
    };
    let extensions = &mut loaded.file.json["extensions"];
    if extensions.get("VRMC_springBone").is_some() {
        let (offset, tail) = (local(leg.from).as_vec3().to_array(), local(leg.to).as_vec3().to_array());
        let capsule = json!({"capsule": {"offset": offset, "tail": tail, "radius": radius}});
        let springs = &mut extensions["VRMC_springBone"];
        let collider = push(&mut springs["colliders"], json!({"node": leg.node, "shape": capsule}));
        return Some(push(&mut springs["colliderGroups"], json!({"colliders": [collider]})));
    }
    let sphere = |index: u32| {
        let along = (f64::from(index) + 0.5) / f64::from(SPHERES);
        let at = (local(leg.from.lerp(leg.to, along)) * FLIPPED).as_vec3();
        json!({"offset": {"x": at.x, "y": at.y, "z": at.z}, "radius": radius})
    };
    let spheres: Vec<Value> = (0..SPHERES).map(sphere).collect();
    let groups = &mut extensions["VRM"]["secondaryAnimation"]["colliderGroups"];
    Some(push(groups, json!({"node": leg.node, "colliders": spheres})))
}
