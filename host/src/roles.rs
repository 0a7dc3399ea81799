//! Which node plays which humanoid role, as files and maps say it: VRM 1.0, VRM 0.x, Unity.

use super::bind::{NodeTree, node_label};
use super::file::GltfFile;
use super::{array_at, bad_input, text_at};
use serde_json::Value;
use superdeform::internals::character::naming::{ThumbNames, parse_role_map};
use superdeform::{Humanoid, Result, Role};

/// The roles that a VRM file gives to nodes; empty for other files.
///
/// # Errors
/// A role given twice, a node with two roles, or a node that the file's scene does not show.
pub fn roles_of_vrm(file: &GltfFile, joint_of_node: &[Option<usize>]) -> Result<Humanoid> {
    let mut given = Vec::new();
    let extensions = &file.json["extensions"];
    let (vrm1, vrm0) = (&extensions["VRMC_vrm"], &extensions["VRM"]);
    if let Some(bones) = vrm1["humanoid"]["humanBones"].as_object() {
        for (name, bone) in bones {
            given.push((name.as_str(), bone["node"].as_i64(), ThumbNames::Vrm1));
        }
    } else {
        for bone in array_at(&vrm0["humanoid"], "humanBones") {
            given.push((text_at(bone, "bone"), bone["node"].as_i64(), ThumbNames::Vrm0OrUnity));
        }
    }
    let mut humanoid = Humanoid::default();
    for (name, node, thumbs) in given {
        // VRM 0.x writes -1 for a role that no node plays.
        let (Some(role), Some(node)) = (Role::parse_as(name, thumbs), node.filter(|&node| node >= 0)) else {
            continue;
        };
        let joint = joint_of_node.get(node as usize).copied().flatten().ok_or_else(|| {
            bad_input(format!(
                "{}: the role {role} names node {node}, which the scene does not have: export the file anew",
                file.name
            ))
        })?;
        give(file, &mut humanoid, role, joint, joint_of_node)?;
    }
    Ok(humanoid)
}

/// Gives the roles of a map (role -> node name) to nodes, over those that the file has given.
///
/// # Errors
/// Unknown roles and names, a name that several nodes have, one node for two roles.
pub fn apply_map(
    file: &GltfFile,
    tree: &NodeTree,
    joint_of_node: &[Option<usize>],
    map: &Value,
    humanoid: &mut Humanoid,
) -> Result<()> {
    let entries = map.as_object().ok_or_else(|| {
        bad_input("the humanoid map is no JSON object: write {\"hips\": \"JOINT NAME\", ...}".to_string())
    })?;
    let (_, roles) = parse_role_map(entries.keys().map(String::as_str));
    let mut given = Humanoid::default();
    for ((key, value), role) in entries.iter().zip(roles) {
        let role = role.ok_or_else(|| {
            bad_input(format!(
                "the humanoid map names the role \"{key}\", which does not exist: use names such as hips, leftUpperLeg, head"
            ))
        })?;
        let Some(name) = value.as_str() else {
            if value.is_null() {
                continue;
            }
            return Err(bad_input(format!(
                "the humanoid map gives {role} a value that is no joint name: write \"{role}\": \"JOINT NAME\""
            )));
        };
        let nodes = file.list("nodes");
        let nodes_named = |name: &str| -> Vec<usize> {
            let mut found = tree.order.clone();
            found.retain(|&node| text_at(&nodes[node], "name") == name);
            found.sort_unstable();
            found
        };
        let mut named = nodes_named(name);
        // Editors tell nodes of one name apart by a number, "head 1" beside "head": the joint of that name, or the
        // second in the file where several or none are joints.
        if named.is_empty()
            && let Some((stem, number)) = name.rsplit_once([' ', '.', '_'])
            && let Ok(number) = number.parse::<usize>()
        {
            named = nodes_named(stem);
            let of_skins = named.iter().filter(|&&node| is_skin_joint(file, node)).count();
            if of_skins != 1 {
                named = named.get(number).copied().into_iter().collect();
            }
        }
        let skinned: Vec<usize> = named.iter().copied().filter(|&node| is_skin_joint(file, node)).collect();
        let node = match (named.as_slice(), skinned.as_slice()) {
            ([node], _) | (_, [node]) => *node,
            ([], _) => {
                return Err(bad_input(format!(
                    "the humanoid map gives {role} the joint \"{name}\", which {} does not have: check the spelling",
                    file.name
                )));
            }
            _ => {
                return Err(bad_input(format!(
                    "the humanoid map gives {role} the joint \"{name}\", a name that {} nodes of {} have: rename them",
                    named.len(),
                    file.name
                )));
            }
        };
        if let Some(joint) = joint_of_node[node] {
            give(file, &mut given, role, joint, joint_of_node)?;
        }
    }
    for (role, joint) in given.iter() {
        let taken: Vec<Role> =
            humanoid.iter().filter(|&(_, other)| other == joint).map(|(role, _)| role).collect();
        for other in taken {
            humanoid.set(other, None);
        }
        humanoid.set(role, joint);
    }
    Ok(())
}

fn is_skin_joint(file: &GltfFile, node: usize) -> bool {
    let is_it = |joint: &Value| joint.as_u64() == Some(node as u64);
    file.list("skins").iter().any(|skin| array_at(skin, "joints").iter().any(is_it))
}

fn give(
    file: &GltfFile,
    humanoid: &mut Humanoid,
    role: Role,
    joint: usize,
    joint_of_node: &[Option<usize>],
) -> Result<()> {
    let label = |joint: usize| {
        let node = joint_of_node.iter().position(|&other| other == Some(joint)).unwrap_or(0);
        node_label(&file.list("nodes")[node], node)
    };
    if let Some(other) = humanoid.joint(role) {
        return Err(bad_input(format!(
            "{}: both {} and {} have the role {role}: leave it to one of them",
            file.name,
            label(other),
            label(joint)
        )));
    }
    if let Some((other, _)) = humanoid.iter().find(|&(_, taken)| taken == joint) {
        return Err(bad_input(format!(
            "{}: {} has two roles, {other} and {role}: leave it one of them",
            file.name,
            label(joint)
        )));
    }
    humanoid.set(role, joint);
    Ok(())
}
