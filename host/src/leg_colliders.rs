//! Colliders around the legs of a VRM whose skirt hangs from springs that none keeps out of them.
//!
//! Legs that become short and stout step through such a skirt where longer ones had passed below it.

use crate::load::Loaded;
use crate::write::colliders::chain;
use crate::{array_at, index_at};
use glam::{DMat3, DVec3};
use serde_json::{Value, json};
use std::collections::BTreeSet;
use superdeform::internals::geometry::foot;
use superdeform::{Role, Warning};

/// What ends nearer to a thigh than this share of its length hangs beside it: a skirt as wide as the thigh is long.
const BESIDE: f64 = 0.5;
/// Spheres along a bone, for VRM 0.x, which has no capsules.
const SPHERES: u32 = 4;

/// A bone of a leg: its node, model space and the mean thickness of what it moves.
struct Bone {
    node: usize,
    from: DVec3,
    to: DVec3,
    radius: f64,
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
                legs.iter().step_by(2).any(|thigh| {
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
        let guards = named(spring, "colliderGroups")
            .filter_map(|group| array_at(springs, "colliderGroups").get(group))
            .flat_map(|group| named(group, "colliders"))
            .filter_map(|collider| index_at(array_at(springs, "colliders").get(collider)?, "node"));
        if !guards.collect::<BTreeSet<usize>>().into_iter().any(is_of_leg) && hangs(&nodes) {
            found.push(format!("/extensions/VRMC_springBone/springs/{index}"));
        }
    }
    let animation = &json["extensions"]["VRM"]["secondaryAnimation"];
    for (index, group) in array_at(animation, "boneGroups").iter().enumerate() {
        let guards = named(group, "colliderGroups")
            .filter_map(|group| index_at(array_at(animation, "colliderGroups").get(group)?, "node"));
        if !guards.collect::<BTreeSet<usize>>().into_iter().any(is_of_leg) && hangs(&chain(loaded, group)) {
            found.push(format!("/extensions/VRM/secondaryAnimation/boneGroups/{index}"));
        }
    }
    found
}

fn named<'a>(value: &'a Value, key: &str) -> impl Iterator<Item = usize> + use<'a> {
    array_at(value, key).iter().filter_map(Value::as_u64).map(|index| index as usize)
}

/// Thigh and shin of either side, as far as they are there.
fn legs(loaded: &Loaded) -> Vec<Bone> {
    use Role::*;
    let character = &loaded.character;
    let place = |role: Role| {
        let joint = character.humanoid.joint(role)?;
        Some((joint, character.skeleton.joints[joint].position()))
    };
    let bones = [LeftUpperLeg, LeftLowerLeg, LeftFoot, RightUpperLeg, RightLowerLeg, RightFoot];
    let bone = |pair: &[Role]| {
        let ((joint, from), (_, to)) = (place(pair[0])?, place(pair[1])?);
        let mut away: Vec<f64> = character
            .meshes
            .iter()
            .flat_map(|mesh| mesh.weights.rows().zip(&mesh.positions))
            .filter(|(row, _)| row.iter().any(|&(by, weight)| by as usize == joint && weight > 0.5))
            .map(|(_, p)| p.as_dvec3().distance(foot(p.as_dvec3(), from, to).0))
            .collect();
        away.sort_by(f64::total_cmp);
        let radius = *away.get(away.len() / 2)?;
        Some(Bone { node: loaded.node_of_joint[joint], from, to, radius })
    };
    [0, 1, 3, 4].into_iter().filter_map(|first| bone(&bones[first..first + 2])).collect()
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
    let name = &loaded.file.name;
    if !adds {
        let message = format!(
            "{name}: {} spring chains hang beside the legs, and no collider keeps them out: legs that walk go through them unless leg colliders are added",
            springs.len()
        );
        loaded.warnings.push(Warning::new("skirt_without_colliders", message).about("leg_colliders"));
        return;
    }
    let message = format!(
        "{name}: colliders around {} bones of the legs guard {} spring chains",
        legs.len(),
        springs.len()
    );
    loaded.warnings.push(Warning::new("leg_colliders_added", message).about("leg_colliders"));
    let groups: Vec<usize> = legs.iter().map(|leg| add(loaded, leg)).collect();
    for spring in springs {
        let Some(spring) = loaded.file.json.pointer_mut(&spring) else { continue };
        let mut all: Vec<Value> = array_at(spring, "colliderGroups").to_vec();
        all.extend(groups.iter().map(|&group| json!(group)));
        spring["colliderGroups"] = json!(all);
    }
}

/// Adds a bone's collider; the number of its group.
fn add(loaded: &mut Loaded, leg: &Bone) -> usize {
    let rest = loaded.pose.rest[leg.node];
    let local = |p: DVec3| rest.inverse().transform_point3(p);
    let scale = DMat3::from_mat4(rest).determinant().abs().cbrt().max(f64::MIN_POSITIVE);
    let radius = (leg.radius / scale) as f32;
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
        return push(&mut springs["colliderGroups"], json!({"colliders": [collider]}));
    }
    let sphere = |index: u32| {
        let at = local(leg.from.lerp(leg.to, (f64::from(index) + 0.5) / f64::from(SPHERES))).as_vec3();
        // Vectors of VRM 0.x have z the other way.
        json!({"offset": {"x": at.x, "y": at.y, "z": -at.z}, "radius": radius})
    };
    let spheres: Vec<Value> = (0..SPHERES).map(sphere).collect();
    let groups = &mut extensions["VRM"]["secondaryAnimation"]["colliderGroups"];
    push(groups, json!({"node": leg.node, "colliders": spheres}))
}
