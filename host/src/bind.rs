//! The rest pose, read from the inverse bind matrices: the pose that the nodes stand in may be another one.
//!
//! A vertex v of a skinned mesh stands at sum_j w_j J_j B_j v. At rest the product J_j B_j is the same matrix M for
//! all joints of a skin, "mesh to model", and J_j = M B_j^-1.

use super::accessor::Reader;
use super::file::GltfFile;
use super::{array_at, bad_input, index_at, indices_at, text_at};
use glam::{DMat4, DQuat, DVec3};
use serde_json::Value;
use std::collections::BTreeSet;
use superdeform::Result;

/// Two matrices agree where they take a skin's box to the same place, within this share of its size.
const AGREEMENT: f64 = 1e-3;

/// Below this share of the size a difference is rounding in the file's 32-bit numbers.
const ROUNDING: f64 = 1e-6;

/// How many joints of a skin are asked for the common matrix; all are asked whether they agree with it.
const LARGEST_ELECTION: usize = 64;

/// The nodes of a file as a tree.
#[derive(Clone, Debug, Default)]
pub struct NodeTree {
    /// The node that each node hangs from.
    pub parents: Vec<Option<usize>>,
    /// The nodes of the scene and the joints of all skins, every parent before its children.
    pub order: Vec<usize>,
    /// Node space to its parent's, as the file poses it.
    pub local: Vec<DMat4>,
    /// Node space to model space, as the file poses it.
    pub world: Vec<DMat4>,
}

impl NodeTree {
    /// Reads the nodes of the default scene, the first scene where none is the default, or all where there is none.
    ///
    /// # Errors
    /// A node with two parents or within itself.
    pub fn read(file: &GltfFile) -> Result<Self> {
        let nodes = file.list("nodes");
        let label = |node: usize| node_label(&nodes[node], node);
        let mut parents: Vec<Option<usize>> = vec![None; nodes.len()];
        for (index, node) in nodes.iter().enumerate() {
            for child in indices_at(node, "children") {
                if child >= nodes.len() {
                    return Err(bad_input(format!(
                        "{}: node {index} has the child {child}, but there are {} nodes: export the file anew",
                        file.name,
                        nodes.len()
                    )));
                }
                if let Some(other) = parents[child].filter(|&other| other != index || child == index) {
                    return Err(bad_input(format!(
                        "{}: {} hangs from both {} and {}: export the file anew, with one parent a node",
                        file.name,
                        label(child),
                        label(other),
                        label(index)
                    )));
                }
                parents[child] = Some(index);
            }
        }
        // Walking from the nodes without a parent reaches each node once, but for those that run in a circle.
        let mut order = Vec::with_capacity(nodes.len());
        let mut reached = vec![false; nodes.len()];
        let mut stack: Vec<usize> = (0..nodes.len()).rev().filter(|&node| parents[node].is_none()).collect();
        while let Some(node) = stack.pop() {
            if std::mem::replace(&mut reached[node], true) {
                return Err(bad_input(format!(
                    "{}: {} stands twice among the children of a node: export the file anew",
                    file.name,
                    label(node)
                )));
            }
            order.push(node);
            let children = array_at(&nodes[node], "children").iter().rev();
            stack.extend(children.filter_map(|child| child.as_u64().map(|child| child as usize)));
        }
        if let Some(lost) = reached.iter().position(|&reached| !reached) {
            return Err(bad_input(format!(
                "{}: {} is its own ancestor: export the file anew",
                file.name,
                label(lost)
            )));
        }
        let local: Vec<DMat4> = nodes.iter().map(local_transform).collect();
        let mut world = local.clone();
        for &node in &order {
            if let Some(parent) = parents[node] {
                world[node] = world[parent] * local[node];
            }
        }

        let scenes = file.list("scenes");
        let scene = index_at(&file.json, "scene").unwrap_or(0);
        let mut shown = vec![scenes.is_empty(); nodes.len()];
        for root in scenes.get(scene).map_or(&[][..], |scene| array_at(scene, "nodes")) {
            if let Some(root) = root.as_u64().map(|root| root as usize).filter(|&root| root < nodes.len()) {
                shown[root] = true;
            }
        }
        for &node in &order {
            shown[node] |= parents[node].is_some_and(|parent| shown[parent]);
        }
        // Joints count wherever they are, with all that they hang from.
        for joint in file.list("skins").iter().flat_map(|skin| array_at(skin, "joints")) {
            let mut above = joint.as_u64().map(|joint| joint as usize);
            while let Some(node) = above.filter(|&node| node < nodes.len() && !shown[node]) {
                shown[node] = true;
                above = parents[node];
            }
        }
        order.retain(|&node| shown[node]);
        Ok(Self { parents, order, local, world })
    }
}

/// A node by name, or by number where it has none.
pub fn node_label(node: &Value, index: usize) -> String {
    match text_at(node, "name") {
        "" => format!("node {index}"),
        name => format!("node {index} ({name})"),
    }
}

fn numbers<const COUNT: usize>(value: Option<&Value>) -> Option<[f64; COUNT]> {
    let values = value?.as_array()?;
    let numbers: Vec<f64> = values.iter().filter_map(Value::as_f64).collect();
    numbers.try_into().ok()
}

/// A node's transform relative to its parent.
pub fn local_transform(node: &Value) -> DMat4 {
    if let Some(matrix) = numbers::<16>(node.get("matrix")) {
        return DMat4::from_cols_array(&matrix);
    }
    let translation = numbers::<3>(node.get("translation")).unwrap_or([0.0; 3]);
    let rotation = numbers::<4>(node.get("rotation")).unwrap_or([0.0, 0.0, 0.0, 1.0]);
    let scale = numbers::<3>(node.get("scale")).unwrap_or([1.0; 3]);
    let rotation = DQuat::from_array(rotation);
    let rotation = if rotation.length_squared() > 0.0 { rotation.normalize() } else { DQuat::IDENTITY };
    DMat4::from_scale_rotation_translation(DVec3::from(scale), rotation, DVec3::from(translation))
}

/// One skin as the file has it.
#[derive(Clone, Debug, Default)]
pub struct Skin {
    /// Nodes.
    pub joints: Vec<usize>,
    /// Mesh space to joint space, a joint.
    pub inverse_binds: Vec<DMat4>,
    /// A box around the skin's vertices in mesh space: least and greatest corner.
    pub bounds: Option<(DVec3, DVec3)>,
    /// World matrix of the first node that uses the skin.
    pub mesh_world: Option<DMat4>,
}

/// Reads all skins.
///
/// # Errors
/// Joints or inverse bind matrices that are not there or not finite.
pub(super) fn read_skins(reader: &Reader) -> Result<Vec<Skin>> {
    let file = reader.file;
    let node_count = file.list("nodes").len();
    let mut skins = Vec::new();
    for (index, json) in file.list("skins").iter().enumerate() {
        let joints: Vec<usize> = array_at(json, "joints")
            .iter()
            .filter_map(|joint| joint.as_u64().map(|joint| joint as usize))
            .collect();
        if joints.is_empty() {
            return Err(bad_input(format!(
                "{}: skin {index} has no joints: export the file anew",
                file.name
            )));
        }
        if let Some(joint) = joints.iter().find(|&&joint| joint >= node_count) {
            return Err(bad_input(format!(
                "{}: skin {index} names node {joint} as a joint, but there are {node_count} nodes: export the file anew",
                file.name
            )));
        }
        let inverse_binds = match index_at(json, "inverseBindMatrices") {
            // Without matrices the specification says identity.
            None => vec![DMat4::IDENTITY; joints.len()],
            Some(accessor) => {
                let layout = reader.layout(accessor)?;
                if layout.count < joints.len() {
                    return Err(bad_input(format!(
                        "{}: skin {index} has {} joints, but {} inverse bind matrices: export the file anew",
                        file.name,
                        joints.len(),
                        layout.count
                    )));
                }
                let numbers = reader.floats(accessor, 16, None)?;
                let matrices = numbers.chunks_exact(16).take(joints.len());
                matrices.map(|m| DMat4::from_cols_array(&std::array::from_fn(|i| f64::from(m[i])))).collect()
            }
        };
        if let Some(slot) = inverse_binds.iter().position(|matrix| !matrix.is_finite()) {
            return Err(bad_input(format!(
                "{}: skin {index}: the inverse bind matrix of joint {slot} holds a number that is not finite: export the file anew",
                file.name
            )));
        }
        skins.push(Skin { joints, inverse_binds, ..Skin::default() });
    }
    Ok(skins)
}

/// What takes the vertices of a skin to model space.
#[derive(Clone, Debug, Default)]
pub struct SkinPlacement {
    /// Mesh space to model space.
    pub common: DMat4,
    /// J_j B_j, a joint; all are `common` where `uniform`.
    pub by_joint: Vec<DMat4>,
    /// True where the joints agree.
    pub uniform: bool,
}

/// The rest pose of all nodes.
#[derive(Clone, Debug, Default)]
pub struct RestPose {
    /// Node space to model space, a node.
    pub rest: Vec<DMat4>,
    /// A skin each.
    pub placements: Vec<SkinPlacement>,
    /// True where the file's nodes stand in another pose.
    pub differs: bool,
}

/// Finds the rest pose of all nodes, and what takes the vertices of each skin there.
pub fn rest_pose(tree: &NodeTree, skins: &[Skin]) -> RestPose {
    let mut of_joint: Vec<Option<DMat4>> = vec![None; tree.parents.len()];
    let mut differs = false;
    let mut placements = Vec::new();
    for skin in skins {
        let box_corners = corners(skin);
        let usable: Vec<usize> =
            (0..skin.joints.len()).filter(|&slot| invertible(&skin.inverse_binds[slot])).collect();
        let posed: Vec<DMat4> =
            usable.iter().map(|&slot| tree.world[skin.joints[slot]] * skin.inverse_binds[slot]).collect();
        // Joints that an earlier skin has placed bring this skin's mesh to where that one's is.
        let placed: Vec<DMat4> = usable
            .iter()
            .filter_map(|&slot| of_joint[skin.joints[slot]].map(|rest| rest * skin.inverse_binds[slot]))
            .collect();
        let common = if !placed.is_empty() {
            elect(&placed, &box_corners).0
        } else {
            let (elected, share) = elect(&posed, &box_corners);
            if share > 0.5 { elected } else { conventional(tree, skin, &usable, &posed, &box_corners) }
        };
        let common = tidy(common, &box_corners);
        differs |= posed.iter().any(|posed| !agree(posed, &common, &box_corners, AGREEMENT));
        for &slot in &usable {
            let rest = &mut of_joint[skin.joints[slot]];
            if rest.is_none() {
                *rest = Some(common * skin.inverse_binds[slot].inverse());
            }
        }
        placements.push(SkinPlacement { common, by_joint: Vec::new(), uniform: true });
    }
    let mut rest = tree.world.clone();
    for &node in &tree.order {
        rest[node] = of_joint[node].unwrap_or_else(|| {
            tree.parents[node].map_or(tree.world[node], |parent| rest[parent] * tree.local[node])
        });
    }
    for (skin, placement) in skins.iter().zip(&mut placements) {
        let box_corners = corners(skin);
        let by_joint: Vec<DMat4> =
            skin.joints.iter().zip(&skin.inverse_binds).map(|(&node, bind)| rest[node] * *bind).collect();
        placement.uniform =
            by_joint.iter().all(|joint| agree(joint, &placement.common, &box_corners, ROUNDING));
        placement.by_joint =
            if placement.uniform { vec![placement.common; by_joint.len()] } else { by_joint };
    }
    RestPose { rest, placements, differs }
}

fn invertible(matrix: &DMat4) -> bool {
    let determinant = matrix.determinant();
    matrix.is_finite() && determinant.is_finite() && determinant.abs() > 1e-30 && matrix.inverse().is_finite()
}

/// The corners of the box around the skin's vertices and its joints at rest, in mesh space.
fn corners(skin: &Skin) -> [DVec3; 8] {
    let mut bounds = skin.bounds;
    for bind in skin.inverse_binds.iter().filter(|bind| invertible(bind)) {
        let point = bind.inverse().w_axis.truncate();
        let (low, high) = bounds.unwrap_or((point, point));
        bounds = Some((low.min(point), high.max(point)));
    }
    let (low, mut high) = bounds.unwrap_or((DVec3::ZERO, DVec3::ONE));
    if (high - low).length_squared() == 0.0 {
        high = low + DVec3::ONE;
    }
    std::array::from_fn(|corner| {
        let pick = |axis: usize| {
            if corner >> axis & 1 == 1 { high[axis] } else { low[axis] }
        };
        DVec3::new(pick(0), pick(1), pick(2))
    })
}

fn agree(one: &DMat4, other: &DMat4, corners: &[DVec3; 8], tolerance: f64) -> bool {
    let size = other.transform_vector3(corners[7] - corners[0]).length();
    corners.iter().all(|&corner| {
        let apart = one.transform_point3(corner) - other.transform_point3(corner);
        apart.length() <= tolerance * size
    })
}

/// The matrix that most agree with, number by number the median of those, and the share that agree.
fn elect(matrices: &[DMat4], corners: &[DVec3; 8]) -> (DMat4, f64) {
    let step = matrices.len().div_ceil(LARGEST_ELECTION).max(1);
    let voters = |candidate: &DMat4| {
        matrices.iter().filter(|matrix| agree(matrix, candidate, corners, AGREEMENT)).count()
    };
    let mut best: Option<(&DMat4, usize)> = None;
    for candidate in matrices.iter().step_by(step) {
        let votes = voters(candidate);
        if best.is_none_or(|(_, most)| votes > most) {
            best = Some((candidate, votes));
        }
    }
    let Some((winner, votes)) = best else {
        return (DMat4::IDENTITY, 0.0);
    };
    let agreeing: Vec<[f64; 16]> = matrices
        .iter()
        .filter(|matrix| agree(matrix, winner, corners, AGREEMENT))
        .map(DMat4::to_cols_array)
        .collect();
    let median = std::array::from_fn(|entry| {
        let mut values: Vec<f64> = agreeing.iter().map(|matrix| matrix[entry]).collect();
        values.sort_by(f64::total_cmp);
        values[values.len() / 2]
    });
    let median = if agreeing.is_empty() { *winner } else { DMat4::from_cols_array(&median) };
    (median, votes as f64 / matrices.len() as f64)
}

/// Where the nodes are posed: what takes the mesh to model space by the conventions of exporters, the one that most
/// joints agree with, or else the first that lets the figure stand as the posed one does.
fn conventional(
    tree: &NodeTree,
    skin: &Skin,
    usable: &[usize],
    posed: &[DMat4],
    corners: &[DVec3; 8],
) -> DMat4 {
    let of_skin: BTreeSet<usize> = skin.joints.iter().copied().collect();
    let top_most = usable.iter().zip(posed).filter(|&(&slot, _)| {
        tree.parents[skin.joints[slot]].is_none_or(|parent| !of_skin.contains(&parent))
    });
    let mut candidates: Vec<DMat4> = skin.mesh_world.into_iter().collect();
    candidates.push(DMat4::IDENTITY);
    candidates.extend(top_most.map(|(_, posed)| *posed).take(8));

    let share = |candidate: &DMat4| {
        let agreeing = posed.iter().filter(|posed| agree(posed, candidate, corners, AGREEMENT)).count();
        agreeing as f64 / posed.len().max(1) as f64
    };
    let bind_places: Vec<DVec3> =
        usable.iter().map(|&slot| skin.inverse_binds[slot].inverse().w_axis.truncate()).collect();
    let node_places: Vec<DVec3> =
        usable.iter().map(|&slot| tree.world[skin.joints[slot]].w_axis.truncate()).collect();
    let likeness = |candidate: &DMat4| {
        let places: Vec<DVec3> = bind_places.iter().map(|&place| candidate.transform_point3(place)).collect();
        likeness(&places, &node_places)
    };
    let by_share =
        candidates.iter().map(|candidate| (candidate, share(candidate))).filter(|&(_, share)| share >= 0.25);
    if let Some((candidate, _)) = by_share.max_by(|one, other| one.1.total_cmp(&other.1)) {
        return *candidate;
    }
    let standing = candidates.iter().find(|candidate| likeness(candidate) >= 0.6);
    let most_alike = || candidates.iter().max_by(|one, other| likeness(one).total_cmp(&likeness(other)));
    standing.or_else(most_alike).copied().unwrap_or(DMat4::IDENTITY)
}

/// 1 where two sets of points are the same but for where they are, 0 where one has nothing of the other; less where
/// one is more than three times as large.
fn likeness(places: &[DVec3], others: &[DVec3]) -> f64 {
    let mean = |points: &[DVec3]| points.iter().sum::<DVec3>() / points.len().max(1) as f64;
    let (middle, other_middle) = (mean(places), mean(others));
    let (mut product, mut square, mut other_square) = (0.0, 0.0, 0.0);
    for (&place, &other) in places.iter().zip(others) {
        let (place, other) = (place - middle, other - other_middle);
        product += place.dot(other);
        square += place.length_squared();
        other_square += other.length_squared();
    }
    if square <= 0.0 || other_square <= 0.0 {
        return 0.0;
    }
    let ratio = (square / other_square).sqrt();
    let oversize = (ratio.max(1.0 / ratio) / 3.0).max(1.0);
    product / (square * other_square).sqrt() / oversize
}

/// The identity where a matrix is that but for rounding, so that vertices keep their bits.
fn tidy(matrix: DMat4, corners: &[DVec3; 8]) -> DMat4 {
    if agree(&matrix, &DMat4::IDENTITY, corners, ROUNDING) { DMat4::IDENTITY } else { matrix }
}
