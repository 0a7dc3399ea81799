//! A very small reader of GLB and VRM files: joints in bind pose, vertices and weights. Nothing else.

use glam::{DMat4, Mat4, Vec3};
use std::collections::HashMap;
use std::path::Path;
use superdeform::internals::character::naming::parse_role_map;
use superdeform::{Joint, Mesh, Role, Skeleton, Weights};

/// What the tests read from a file.
pub struct File {
    pub skeleton: Skeleton,
    pub meshes: Vec<Mesh>,
    /// Roles that a VRM header gives.
    pub header: HashMap<Role, usize>,
}

/// Reads the joints of all skins and the nodes above them, or every node, with the meshes that follow them.
pub fn read(path: &Path, every_node: bool) -> File {
    let bytes = std::fs::read(path).expect("the file can be read");
    let gltf = gltf::Gltf::from_slice_without_validation(&bytes).expect("the file is glTF");
    let blob = gltf.blob.as_deref().unwrap_or_default();
    let nodes: Vec<gltf::Node> = gltf.nodes().collect();
    let mut parent = vec![None; nodes.len()];
    for node in &nodes {
        for child in node.children() {
            parent[child.index()] = Some(node.index());
        }
    }
    let local = |node: usize| Mat4::from_cols_array_2d(&nodes[node].transform().matrix()).as_dmat4();
    let world = |node: usize| {
        std::iter::successors(Some(node), |&node| parent[node])
            .fold(DMat4::IDENTITY, |below, above| local(above) * below)
    };

    // Bind pose: the inverse of a joint's inverse bind matrix, taken from the mesh's space to the model's by the
    // root joint of the skin.
    let mut bind: HashMap<usize, DMat4> = HashMap::new();
    let mut mesh_to_model = Vec::new();
    for skin in gltf.skins() {
        let joints: Vec<usize> = skin.joints().map(|joint| joint.index()).collect();
        let reader = skin.reader(|_| Some(blob));
        let inverse: Vec<DMat4> = match reader.read_inverse_bind_matrices() {
            Some(matrices) => matrices.map(|m| Mat4::from_cols_array_2d(&m).as_dmat4()).collect(),
            None => vec![DMat4::IDENTITY; joints.len()],
        };
        let root = (0..joints.len())
            .find(|&joint| parent[joints[joint]].is_none_or(|above| !joints.contains(&above)))
            .unwrap_or(0);
        let to_model = world(joints[root]) * inverse[root];
        mesh_to_model.push(to_model);
        for (&joint, matrix) in joints.iter().zip(&inverse) {
            bind.entry(joint).or_insert(to_model * matrix.inverse());
        }
    }

    let mut kept: Vec<usize> = Vec::new();
    for node in 0..nodes.len() {
        let chain: Vec<usize> = std::iter::successors(Some(node), |&node| parent[node]).collect();
        if bind.contains_key(&node) || every_node && !bind.is_empty() {
            kept.extend(chain);
        }
    }
    kept.sort_unstable();
    kept.dedup();
    let joint_of: HashMap<usize, usize> =
        kept.iter().enumerate().map(|(joint, &node)| (node, joint)).collect();
    let joints = kept
        .iter()
        .map(|&node| Joint {
            name: nodes[node].name().unwrap_or_default().to_string(),
            parent: parent[node].and_then(|above| joint_of.get(&above).copied()),
            rest: bind.get(&node).copied().unwrap_or_else(|| world(node)),
        })
        .collect();

    let mut meshes = Vec::new();
    for node in &nodes {
        let Some(mesh) = node.mesh() else { continue };
        let carrier = std::iter::successors(Some(node.index()), |&node| parent[node])
            .find_map(|node| joint_of.get(&node).copied());
        for primitive in mesh.primitives() {
            let reader = primitive.reader(|_| Some(blob));
            let Some(points) = reader.read_positions() else {
                continue;
            };
            let to_model = match node.skin() {
                Some(skin) => mesh_to_model[skin.index()],
                None => world(node.index()),
            };
            let positions: Vec<Vec3> = points
                .map(|point| to_model.transform_point3(Vec3::from(point).as_dvec3()).as_vec3())
                .collect();
            let weights = match (node.skin(), reader.read_joints(0), reader.read_weights(0)) {
                (Some(skin), Some(joints), Some(weights)) => {
                    let list: Vec<usize> = skin.joints().map(|joint| joint_of[&joint.index()]).collect();
                    Weights::from_rows(joints.into_u16().zip(weights.into_f32()).map(|(joints, weights)| {
                        let joints = joints.map(|joint| list[usize::from(joint)] as u32);
                        joints.into_iter().zip(weights)
                    }))
                }
                _ => carrier
                    .map_or_else(Weights::default, |joint| Weights::rigid(joint as u32, positions.len())),
            };
            meshes.push(Mesh { positions, weights, ..Mesh::default() });
        }
    }

    let named: Vec<(String, usize)> = if let Some(vrm) = gltf.extension_value("VRMC_vrm") {
        let bones = vrm["humanoid"]["humanBones"].as_object().expect("bones");
        let entry = |(role, bone): (&String, &serde_json::Value)| {
            (role.clone(), bone["node"].as_u64().unwrap() as usize)
        };
        bones.iter().map(entry).collect()
    } else if let Some(vrm) = gltf.extension_value("VRM") {
        let bones = vrm["humanoid"]["humanBones"].as_array().expect("bones");
        let entry = |bone: &serde_json::Value| {
            (bone["bone"].as_str().unwrap().to_string(), bone["node"].as_u64().unwrap() as usize)
        };
        bones.iter().map(entry).collect()
    } else {
        Vec::new()
    };
    let (_, roles) = parse_role_map(named.iter().map(|(name, _)| name.as_str()));
    let header = roles
        .into_iter()
        .zip(&named)
        .filter_map(|(role, (_, node))| Some((role?, *joint_of.get(node)?)))
        .collect();
    File { skeleton: Skeleton { joints }, meshes, header }
}
