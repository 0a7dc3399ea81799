//! Colliders of spring bones, VRM 0.x and 1.0, and the springs that they guard.

use super::numbers::{flipped_vector, multiply, number, put, put_flipped, vector};
use super::{MapPoint, new_rest};
use crate::load::Loaded;
use crate::{array_at, index_at, indices_at, text_at};
use glam::{DMat3, DMat4, DVec3};
use serde_json::{Value, json};
use std::collections::BTreeSet;
use superdeform::internals::shape::collider::{Collider, MappedCollider, Shape, SpringBall, map_collider};
use superdeform::{Deformed, Warning};

/// The share of its radius from which on it is told that a collider yields: what is less would be told as none.
const LEAST_TOLD: f64 = 0.005;

/// Every viewer of VRM 0.x takes the last bone of a chain to be so long, in metres, whatever its scale.
const LEAF_LENGTH: f64 = 0.07;

/// Leaves whose surroundings grow or shrink by more than this share are told.
const LEAF_TOLERANCE: f64 = 0.1;

/// A collider of a file.
pub struct FileCollider {
    /// Where its numbers stand: a JSON pointer.
    place: String,
    /// The node that it moves with.
    node: usize,
    /// True for VRM 0.x, whose vectors have z negated.
    flipped: bool,
    /// In model space.
    pub collider: Collider,
    /// The ends of the springs that it is for.
    pub springs: Vec<SpringBall>,
}

/// The colliders of `loaded` that move with a joint.
pub fn colliders(loaded: &Loaded) -> Vec<FileCollider> {
    let extensions = &loaded.file.json["extensions"];
    let mut found = vrm1(&extensions["VRMC_springBone"], loaded);
    found.extend(vrm0(&extensions["VRM"]["secondaryAnimation"], loaded));
    found
}

/// By how much lengths of a node's space are longer in model space.
pub(crate) fn node_scale(rest: &DMat4) -> f64 {
    let scale = DMat3::from_mat4(*rest).determinant().abs().cbrt();
    if scale > 0.0 { scale } else { 1.0 }
}

/// The ball at `node`, the end of a bone, with the radius that the bone's own node says.
fn ball(loaded: &Loaded, node: usize, radius: f64) -> Option<SpringBall> {
    let joint = loaded.joint_of_node.get(node).copied().flatten()?;
    let rest = &loaded.pose.rest[node];
    Some(SpringBall { joint, centre: rest.w_axis.truncate(), radius: radius * node_scale(rest) })
}

fn vrm1(springs: &Value, loaded: &Loaded) -> Vec<FileCollider> {
    // The springs of each collider, by way of groups.
    let mut guarded: Vec<Vec<SpringBall>> = vec![Vec::new(); array_at(springs, "colliders").len()];
    for spring in array_at(springs, "springs") {
        let joints = array_at(spring, "joints");
        let balls: Vec<SpringBall> = joints
            .windows(2)
            .filter_map(|pair| ball(loaded, index_at(&pair[1], "node")?, number(&pair[0], "hitRadius", 0.0)))
            .collect();
        let groups = indices_at(spring, "colliderGroups");
        let of_groups = groups.filter_map(|group| array_at(springs, "colliderGroups").get(group));
        let of_groups: BTreeSet<usize> = of_groups.flat_map(|group| indices_at(group, "colliders")).collect();
        for collider in of_groups {
            if let Some(list) = guarded.get_mut(collider) {
                list.extend(&balls);
            }
        }
    }
    let mut found = Vec::new();
    for ((index, collider), springs) in array_at(springs, "colliders").iter().enumerate().zip(&guarded) {
        let Some((node, joint)) = index_at(collider, "node").and_then(|node| joint_of(loaded, node)) else {
            continue;
        };
        let rest = &loaded.pose.rest[node];
        for shapes in ["shape", "extensions/VRMC_springBone_extended_collider/shape"] {
            for (kind, shape) in
                [("sphere", Shape::Sphere), ("capsule", Shape::Capsule), ("plane", Shape::Plane)]
            {
                let body = collider.pointer(&format!("/{shapes}/{kind}"));
                let Some(body) = body.filter(|body| body.is_object()) else { continue };
                let at = |key: &str| body.get(key).and_then(vector).unwrap_or(DVec3::ZERO);
                let end = match shape {
                    Shape::Plane => {
                        let normal = body.get("normal").and_then(vector).unwrap_or(DVec3::Z);
                        DMat3::from_mat4(*rest).inverse().transpose() * normal
                    }
                    _ => rest.transform_point3(at("tail")),
                };
                let collider = Collider {
                    shape,
                    inside: body.get("inside").and_then(Value::as_bool).unwrap_or(false),
                    joint,
                    offset: rest.transform_point3(at("offset")),
                    end,
                    radius: number(body, "radius", 0.0) * node_scale(rest),
                };
                let place = format!("/extensions/VRMC_springBone/colliders/{index}/{shapes}/{kind}");
                found.push(FileCollider { place, node, flipped: false, collider, springs: springs.clone() });
            }
        }
    }
    found
}

fn vrm0(animation: &Value, loaded: &Loaded) -> Vec<FileCollider> {
    let mut guarded: Vec<Vec<SpringBall>> = vec![Vec::new(); array_at(animation, "colliderGroups").len()];
    for group in array_at(animation, "boneGroups") {
        let radius = number(group, "hitRadius", 0.0);
        let roots: BTreeSet<usize> = indices_at(group, "bones").collect();
        // The end of a bone is the next joint; a chain's first joint is the end of none.
        let balls: Vec<SpringBall> = chain(loaded, group)
            .into_iter()
            .filter(|node| !roots.contains(node))
            .filter_map(|node| ball(loaded, node, radius))
            .collect();
        for index in indices_at(group, "colliderGroups") {
            if let Some(list) = guarded.get_mut(index) {
                list.extend(&balls);
            }
        }
    }
    let mut found = Vec::new();
    for ((index, group), springs) in array_at(animation, "colliderGroups").iter().enumerate().zip(&guarded) {
        let Some((node, joint)) = index_at(group, "node").and_then(|node| joint_of(loaded, node)) else {
            continue;
        };
        let rest = &loaded.pose.rest[node];
        for (ball, sphere) in array_at(group, "colliders").iter().enumerate() {
            let offset = rest.transform_point3(flipped_vector(&sphere["offset"]));
            let radius = number(sphere, "radius", 0.0) * node_scale(rest);
            let shape = Shape::Sphere;
            let collider = Collider { shape, inside: false, joint, offset, end: DVec3::ZERO, radius };
            let place = format!("/extensions/VRM/secondaryAnimation/colliderGroups/{index}/colliders/{ball}");
            found.push(FileCollider { place, node, flipped: true, collider, springs: springs.clone() });
        }
    }
    found
}

fn joint_of(loaded: &Loaded, node: usize) -> Option<(usize, usize)> {
    Some((node, loaded.joint_of_node.get(node).copied().flatten()?))
}

/// The nodes of a group's chains: its bones and all below them, parents first.
pub(crate) fn chain(loaded: &Loaded, group: &Value) -> Vec<usize> {
    let mut within = vec![false; loaded.tree.parents.len()];
    for root in indices_at(group, "bones") {
        if let Some(within) = within.get_mut(root) {
            *within = true;
        }
    }
    let mut found = Vec::new();
    for &node in &loaded.tree.order {
        within[node] |= loaded.tree.parents[node].is_some_and(|parent| within[parent]);
        if within[node] {
            found.push(node);
        }
    }
    found
}

fn map(found: &FileCollider, map_point: &MapPoint) -> Option<MappedCollider> {
    let mapped = map_collider(&found.collider, &found.springs, map_point);
    let Collider { offset, end, radius, .. } = mapped.collider;
    (offset.is_finite() && end.is_finite() && radius.is_finite()).then_some(mapped)
}

/// Moves the colliders of a file, as thick as the mesh around them.
pub(super) fn move_colliders(json: &mut Value, loaded: &Loaded, new_rest: &[DMat4], map_point: &MapPoint) {
    for found in colliders(loaded) {
        let (Some(mapped), Some(body)) = (map(&found, map_point), json.pointer_mut(&found.place)) else {
            continue;
        };
        let (rest, moved) = (&loaded.pose.rest[found.node], &new_rest[found.node]);
        let local = |matrix: &DMat4, p: DVec3| matrix.inverse().transform_point3(p);
        let (before, after) = (local(rest, found.collider.offset), local(moved, mapped.collider.offset));
        if found.flipped {
            if let Some(offset) = body.get_mut("offset") {
                put_flipped(offset, before, after);
            }
        } else {
            put_point(body, "offset", before, after);
        }
        match found.collider.shape {
            Shape::Capsule => {
                put_point(body, "tail", local(rest, found.collider.end), local(moved, mapped.collider.end));
            }
            Shape::Plane => {
                let axes = |matrix: &DMat4, normal: DVec3| DMat3::from_mat4(*matrix).transpose() * normal;
                let before = axes(rest, found.collider.end);
                let after = axes(moved, mapped.collider.end).normalize_or(before) * before.length();
                if (after - before).length() > 1e-9 {
                    put(&mut body["normal"], before, after);
                }
            }
            Shape::Sphere => {}
        }
        if found.collider.radius > 0.0 {
            multiply(body, "radius", 0.0, mapped.collider.radius / found.collider.radius);
        }
    }
}

/// A point that is not there is at 0.
fn put_point(body: &mut Value, key: &str, before: DVec3, after: DVec3) {
    // Rounding on the way to model space and back is no change.
    if (after - before).length() <= 1e-9 * after.length().max(1.0) {
        return;
    }
    put(&mut body[key], before, after);
}

/// What a person should know of springs, colliders and aims after the deformation.
///
/// - `spring_in_collider`: a spring starts inside a collider that it was outside of, though the collider yields.
/// - `collider_yields`: colliders are thinner than the mesh around them, so that no spring starts nearer, or deeper.
/// - `spring_leaf_length`: the last bones of VRM 0.x chains keep their 7 cm.
/// - `aim_turned`: an aim constraint looks another way at rest, by more than a degree.
pub fn findings(
    loaded: &Loaded,
    deformed: &Deformed,
    map_point: &MapPoint,
    leaf_joints: bool,
) -> Vec<Warning> {
    if !loaded.rigged {
        return Vec::new();
    }
    let mapped: Vec<MappedCollider> =
        colliders(loaded).iter().filter_map(|found| map(found, map_point)).collect();
    let mut warnings = Vec::new();
    let name = &loaded.file.name;
    let inside: usize = mapped.iter().map(|mapped| mapped.newly_inside).sum();
    if inside > 0 {
        warnings.push(Warning::new(
            "spring_in_collider",
            format!("{name}: {inside} springs start inside a collider that they were outside of, deeper than the collider yields: make that collider smaller in the result"),
        ));
    }
    let most = mapped.iter().map(|mapped| mapped.yielded).fold(0.0, f64::max);
    if most >= LEAST_TOLD {
        let count = mapped.iter().filter(|mapped| mapped.yielded >= LEAST_TOLD).count();
        warnings.push(Warning::new(
            "collider_yields",
            format!(
                "{name}: {count} colliders yield by up to {:.0} % of their radius, so that springs start no nearer to them, and no deeper, than they were",
                (100.0 * most).ceil()
            ),
        ));
    }
    let leaves = leaves(loaded, map_point);
    let worst = leaves.iter().map(|leaf| leaf.scale).filter(|scale| (scale - 1.0).abs() > LEAF_TOLERANCE);
    let worst = worst.max_by(|one, two| (one - 1.0).abs().total_cmp(&(two - 1.0).abs()));
    if let Some(scale) = worst.filter(|_| !leaf_joints) {
        warnings.push(
            Warning::new(
                "spring_leaf_length",
                format!(
                    "{name}: viewers of VRM 0.x take the last bone of a spring chain to be 7 cm long, where {:.1} cm would now be right: it swings stiffer or softer than before unless each chain gets one joint more",
                    100.0 * LEAF_LENGTH * scale
                ),
            )
            .about("leaf_joints"),
        );
    }
    warnings.extend(aims(loaded, deformed));
    warnings
}

/// The end of a VRM 0.x chain.
struct Leaf {
    node: usize,
    /// Where viewers take its end to be, model space.
    end: DVec3,
    scale: f64,
}

fn leaves(loaded: &Loaded, map_point: &MapPoint) -> Vec<Leaf> {
    let mut found = Vec::new();
    let groups = array_at(&loaded.file.json["extensions"]["VRM"]["secondaryAnimation"], "boneGroups");
    let nodes: BTreeSet<usize> = groups.iter().flat_map(|group| chain(loaded, group)).collect();
    for &node in &nodes {
        let (Some(parent), Some(joint)) = (loaded.tree.parents[node], loaded.joint_of_node[node]) else {
            continue;
        };
        if !array_at(&loaded.file.list("nodes")[node], "children").is_empty() {
            continue;
        }
        let at = |node: usize| loaded.pose.rest[node].w_axis.truncate();
        let end = at(node) + LEAF_LENGTH * (at(node) - at(parent)).normalize_or(DVec3::NEG_Y);
        let scale = map_point(joint, at(node)).local_scale();
        if scale.is_finite() {
            found.push(Leaf { node, end, scale });
        }
    }
    found
}

/// Gives each chain of VRM 0.x springs a joint more where the field takes the end of its last bone, so that this bone is
/// as long as its surroundings are; gives how many.
pub fn add_leaf_joints(
    file: &mut crate::file::GltfFile,
    loaded: &Loaded,
    deformed: &Deformed,
    map_point: &MapPoint,
) -> usize {
    let leaves = leaves(loaded, map_point);
    let new_rest = new_rest(loaded, deformed);
    for leaf in &leaves {
        let Some(joint) = loaded.joint_of_node[leaf.node] else { continue };
        let end = map_point(joint, leaf.end).position;
        let local = new_rest[leaf.node].inverse().transform_point3(end);
        let name = format!("{}_end", text_at(&loaded.file.list("nodes")[leaf.node], "name"));
        let Some(nodes) = file.json["nodes"].as_array_mut() else { continue };
        nodes.push(json!({"name": name, "translation": local.as_vec3().to_array()}));
        let number = nodes.len() - 1;
        nodes[leaf.node]["children"] = json!([number]);
    }
    leaves.len()
}

/// Aims are told in degrees from here on.
const AIM_TOLERANCE: f64 = 1.0;

/// The aim constraint that turns most at rest: by how many degrees the way from its node to what it aims at does, and the
/// node; `None` for a file without aims.
pub fn aim_turn(loaded: &Loaded, deformed: &Deformed) -> Option<(f64, usize)> {
    let after = new_rest(loaded, deformed);
    let mut worst: Option<(f64, usize)> = None;
    for (node, json) in loaded.file.list("nodes").iter().enumerate() {
        let aim = json.pointer("/extensions/VRMC_node_constraint/constraint/aim");
        let Some(source) = aim.and_then(|aim| index_at(aim, "source")).filter(|&source| source < after.len())
        else {
            continue;
        };
        let way = |rest: &[DMat4]| (rest[source].w_axis - rest[node].w_axis).truncate();
        let degrees = way(&loaded.pose.rest).angle_between(way(&after)).to_degrees();
        if worst.is_none_or(|(most, _)| degrees > most) {
            worst = Some((degrees, node));
        }
    }
    worst
}

/// Aim constraints that look another way at rest than before.
fn aims(loaded: &Loaded, deformed: &Deformed) -> Option<Warning> {
    aim_turn(loaded, deformed).filter(|&(degrees, _)| degrees > AIM_TOLERANCE).map(|(degrees, node)| {
        Warning::new(
            "aim_turned",
            format!(
                "{}: the aim constraint of node {node} ({}) looks {degrees:.1} degrees another way at rest, as what it aims at has moved: set its weight or its rest rotation anew if that shows",
                loaded.file.name,
                text_at(&loaded.file.list("nodes")[node], "name")
            ),
        )
    })
}
