//! From a file to a character in rest pose, and what leads back from there.

use super::accessor::Reader;
use super::bind::{NodeTree, RestPose, Skin, rest_pose};
use super::file::GltfFile;
use super::{array_at, bad_input, index_at, roles, text_at};
use glam::{DMat3, DMat4, DVec3, Vec3, Vec4};
use regex::Regex;
use serde_json::Value;
use superdeform::{
    Axes, Character, Error, ErrorKind, Humanoid, Joint, Mesh, MeshKind, MorphTarget, Result, Role, Skeleton,
    Warning, Weights,
};

/// Finds roles from names and geometry: skeleton, meshes in rest pose, up.
pub type FindRoles<'a> = dyn Fn(&Skeleton, &[Mesh], Vec3) -> (Humanoid, Vec<Warning>) + 'a;

/// What the command line says about a file.
#[derive(Default)]
pub struct LoadOptions<'a> {
    /// Which way the character stands and looks.
    pub axes: Axes,
    /// MAP.json: role -> node name.
    pub humanoid_map: Option<&'a Value>,
    /// Kinds by pattern, matched against `node|mesh|material`; the first that matches counts.
    pub kinds: &'a [(MeshKind, Regex)],
    /// What finds the roles that neither the file nor the map give.
    pub find_roles: Option<&'a FindRoles<'a>>,
    /// Leaves the file's rig out, so that the character comes without joints and weights.
    pub without_rig: bool,
    /// Takes a rig in which required roles are not found, for a caller that will make another.
    pub incomplete_rig: bool,
}

/// Where a mesh of the character comes from.
#[derive(Clone, Debug)]
pub struct Binding {
    /// The node that shows it.
    pub node: usize,
    /// The glTF mesh.
    pub mesh: usize,
    /// The primitive within the mesh.
    pub primitive: usize,
    /// The skin, where it is skinned.
    pub skin: Option<usize>,
    /// The file's vertices to model space.
    pub placement: Placement,
}

/// What takes a file's vertices to model space.
#[derive(Clone, Debug)]
pub enum Placement {
    /// One matrix for all.
    Common(DMat4),
    /// A matrix a vertex, where two skins bind the same joints in different poses.
    PerVertex(Vec<DMat4>),
}

impl Placement {
    /// The matrix of one vertex.
    pub fn at(&self, vertex: usize) -> DMat4 {
        match self {
            Self::Common(matrix) => *matrix,
            Self::PerVertex(matrices) => matrices[vertex],
        }
    }
}

/// A character with what is needed to write it back.
#[derive(Clone, Debug)]
pub struct Loaded {
    /// The file as it came.
    pub file: GltfFile,
    /// The character, in rest pose and model space.
    pub character: Character,
    /// One for each mesh of the character.
    pub bindings: Vec<Binding>,
    /// The nodes.
    pub tree: NodeTree,
    /// The skins as the file has them.
    pub skins: Vec<Skin>,
    /// The rest pose of all nodes.
    pub pose: RestPose,
    /// The joint of the character that a node is, by node.
    pub joint_of_node: Vec<Option<usize>>,
    /// The node that a joint of the character is; empty for a character without a rig.
    pub node_of_joint: Vec<usize>,
    /// True where the file's own rig is kept; false where the character has neither joints nor weights.
    pub rigged: bool,
    /// What a person should know.
    pub warnings: Vec<Warning>,
}

/// One primitive as the file has it.
pub(super) struct RawMesh {
    name: String,
    label: String,
    pub(super) positions: Vec<Vec3>,
    normals: Vec<Vec3>,
    tangents: Vec<Vec4>,
    pub(super) morph_targets: Vec<MorphTarget>,
    triangles: Vec<[u32; 3]>,
    /// Slots of the skin's joints, a vertex; empty where it hangs rigidly.
    pub(super) rows: Vec<Vec<(u32, f32)>>,
}

/// Reads a character out of a file.
///
/// # Errors
/// One sentence that begins with the file's name: damaged geometry (mesh, element, value), or a role without which
/// nothing can be deformed.
pub fn load(file: GltfFile, options: &LoadOptions) -> Result<Loaded> {
    let tree = NodeTree::read(&file)?;
    let mut joint_of_node = vec![None; tree.parents.len()];
    for (joint, &node) in tree.order.iter().enumerate() {
        joint_of_node[node] = Some(joint);
    }
    let reader = Reader::new(&file);
    let mut skins = read_skins(&reader)?;

    let mut bindings = Vec::new();
    let mut raw_meshes = Vec::new();
    for &node in &tree.order {
        let json = &file.list("nodes")[node];
        let Some(mesh) = index_at(json, "mesh") else {
            continue;
        };
        let Some(mesh_json) = file.list("meshes").get(mesh) else {
            return Err(bad_input(format!(
                "{}: node {node} shows mesh {mesh}, which is not there: export the file anew",
                file.name
            )));
        };
        for primitive in 0..array_at(mesh_json, "primitives").len() {
            let skin = index_at(json, "skin").filter(|&skin| skin < skins.len());
            let joint_count = skin.map(|skin| skins[skin].joints.len());
            let Some(raw) = read_primitive(&reader, node, mesh, primitive, joint_count)? else {
                continue;
            };
            let skin = skin.filter(|_| !raw.rows.is_empty());
            if let Some(skin) = skin {
                let skin = &mut skins[skin];
                skin.mesh_world.get_or_insert(tree.world[node]);
                for point in raw.positions.iter().map(|p| p.as_dvec3()).filter(|p| p.is_finite()) {
                    let (low, high) = skin.bounds.unwrap_or((point, point));
                    skin.bounds = Some((low.min(point), high.max(point)));
                }
            }
            bindings.push(Binding {
                node,
                mesh,
                primitive,
                skin,
                placement: Placement::Common(DMat4::IDENTITY),
            });
            raw_meshes.push(raw);
        }
    }
    if bindings.is_empty() {
        return Err(Error::new(
            ErrorKind::NoGeometry,
            format!(
                "{} shows no mesh with vertices: export the character together with its meshes",
                file.name
            ),
        ));
    }

    let pose = rest_pose(&tree, &skins);
    let mut warnings = Vec::new();
    if pose.differs {
        warnings.push(Warning::new(
            "pose_not_rest",
            format!("{} is posed: its rest pose was read from the inverse bind matrices", file.name),
        ));
    }
    let mut meshes = Vec::new();
    let mut labels = Vec::new();
    for (index, (raw, binding)) in raw_meshes.into_iter().zip(&mut bindings).enumerate() {
        check_finite(&file.name, index, &raw)?;
        labels.push(raw.label.clone());
        meshes.push(place(raw, binding, &skins, &pose, &joint_of_node));
    }
    let joints = tree.order.iter().map(|&node| Joint {
        name: text_at(&file.list("nodes")[node], "name").to_string(),
        parent: tree.parents[node].and_then(|parent| joint_of_node[parent]),
        rest: pose.rest[node],
    });
    let skeleton = Skeleton { joints: joints.collect() };

    let mut humanoid = Humanoid::default();
    let mut rigged = !options.without_rig;
    if rigged {
        humanoid = roles::roles_of_vrm(&file, &joint_of_node)?;
        if let Some(map) = options.humanoid_map {
            roles::apply_map(&file, &tree, &joint_of_node, map, &mut humanoid)?;
        }
        if let Some(find_roles) = options.find_roles.filter(|_| !humanoid.missing().is_empty()) {
            let (found, found_warnings) = find_roles(&skeleton, &meshes, options.axes.up);
            for (role, joint) in found.iter() {
                if !humanoid.has(role) && humanoid.iter().all(|(_, taken)| taken != joint) {
                    humanoid.set(role, joint);
                }
            }
            warnings.extend(found_warnings);
        }
        if let Some(role) = humanoid.missing().first() {
            // Without a skin the nodes may be nothing but places for meshes: a figure that has yet to get a rig.
            rigged = !skins.is_empty() || options.humanoid_map.is_some() || is_vrm(&file);
            if rigged && !options.incomplete_rig {
                let message = format!("{} shows no joint for the role {role}: name one", file.name);
                return Err(Error::new(ErrorKind::NoHumanoid, message).about("humanoid"));
            }
        }
    }
    if !rigged {
        // Nodes that only hold meshes may be called like joints.
        humanoid = Humanoid::default();
    }
    set_kinds(&mut meshes, &labels, options.kinds, &skeleton, &humanoid, &mut warnings);
    let mut character = Character { meshes, skeleton, humanoid, axes: options.axes };
    let mut node_of_joint = tree.order.clone();
    if !rigged {
        character.skeleton = Skeleton::default();
        character.meshes.iter_mut().for_each(|mesh| mesh.weights = Weights::default());
        node_of_joint.clear();
    }
    if text_at(&file.json["extensions"]["VRMC_vrm"]["meta"], "modification") == "prohibited"
        || (file.json["extensions"].get("VRMC_vrm").is_some()
            && file.json["extensions"]["VRMC_vrm"]["meta"].get("modification").is_none())
    {
        warnings.push(Warning::new(
            "modification_prohibited",
            format!("{}'s licence does not allow changes (meta.modification is prohibited): ask its author before sharing the result", file.name),
        ));
    }
    character
        .validate()
        .map_err(|error| Error { message: format!("{}: {}", file.name, error.message), ..error })?;
    Ok(Loaded {
        file,
        character,
        bindings,
        tree,
        skins,
        pose,
        joint_of_node,
        node_of_joint,
        rigged,
        warnings,
    })
}

/// True for files with a VRM header of either version.
pub fn is_vrm(file: &GltfFile) -> bool {
    let extensions = &file.json["extensions"];
    extensions.get("VRMC_vrm").is_some() || extensions.get("VRM").is_some()
}

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

/// Reads a primitive; `None` where it has no vertices.
pub(super) fn read_primitive(
    reader: &Reader,
    node: usize,
    mesh: usize,
    primitive: usize,
    joint_count: Option<usize>,
) -> Result<Option<RawMesh>> {
    let file = reader.file;
    let mesh_json = &file.list("meshes")[mesh];
    let json = &mesh_json["primitives"][primitive];
    let node_json = &file.list("nodes")[node];
    let attributes = &json["attributes"];
    let Some(accessor) = index_at(attributes, "POSITION") else {
        return Ok(None);
    };
    let material = index_at(json, "material").and_then(|material| file.list("materials").get(material));
    let material_name = material.map_or("", |material| text_at(material, "name"));
    let mut name = match text_at(mesh_json, "name") {
        "" => text_at(node_json, "name").to_string(),
        name => name.to_string(),
    };
    if array_at(mesh_json, "primitives").len() > 1 && !material_name.is_empty() {
        name = format!("{name}/{material_name}");
    }
    let label = format!("{}|{}|{material_name}", text_at(node_json, "name"), text_at(mesh_json, "name"));
    let place = || match name.as_str() {
        "" => format!("{}: mesh {mesh}", file.name),
        name => format!("{}: mesh {mesh} ({name})", file.name),
    };

    let vec3s = |accessor: usize, count: Option<usize>| -> Result<Vec<Vec3>> {
        let numbers = reader.floats(accessor, 3, count)?;
        Ok(numbers.chunks_exact(3).map(Vec3::from_slice).collect())
    };
    let positions = vec3s(accessor, None)?;
    let count = Some(positions.len());
    let normals = index_at(attributes, "NORMAL").map_or(Ok(Vec::new()), |accessor| vec3s(accessor, count))?;
    let tangents = match index_at(attributes, "TANGENT") {
        None => Vec::new(),
        Some(accessor) => reader.floats(accessor, 4, count)?.chunks_exact(4).map(Vec4::from_slice).collect(),
    };
    let target_names = array_at(&mesh_json["extras"], "targetNames");
    let mut morph_targets = Vec::new();
    for (index, target) in array_at(json, "targets").iter().enumerate() {
        let read =
            |key: &str| index_at(target, key).map_or(Ok(Vec::new()), |accessor| vec3s(accessor, count));
        let mut deltas = read("POSITION")?;
        if deltas.is_empty() {
            deltas = vec![Vec3::ZERO; positions.len()];
        }
        let name = target_names.get(index).and_then(Value::as_str).unwrap_or("").to_string();
        // What has no normals itself can have no changes of them.
        let normal_deltas = if normals.is_empty() { Vec::new() } else { read("NORMAL")? };
        let tangent_deltas = if tangents.is_empty() { Vec::new() } else { read("TANGENT")? };
        morph_targets.push(MorphTarget {
            name,
            positions: deltas,
            normals: normal_deltas,
            tangents: tangent_deltas,
        });
    }

    let mode = json.get("mode").and_then(Value::as_u64).unwrap_or(4);
    let triangles = if (4..=6).contains(&mode) {
        let corners = match index_at(json, "indices") {
            Some(accessor) => reader.integers(accessor, 1, None)?,
            None => (0..positions.len() as u32).collect(),
        };
        if let Some(at) = corners.iter().position(|&corner| corner as usize >= positions.len()) {
            return Err(bad_input(format!(
                "{}: index {at} names vertex {}, but the mesh has {} vertices (0 to {}): export the file anew",
                place(),
                corners[at],
                positions.len(),
                positions.len() - 1
            )));
        }
        triangles_of(mode, &corners)
    } else {
        Vec::new()
    };

    let mut rows = Vec::new();
    if let Some(joint_count) = joint_count.filter(|_| attributes.get("JOINTS_0").is_some()) {
        let mut sets = Vec::new();
        for set in 0.. {
            let joints = index_at(attributes, &format!("JOINTS_{set}"));
            let weights = index_at(attributes, &format!("WEIGHTS_{set}"));
            let (Some(joints), Some(weights)) = (joints, weights) else {
                break;
            };
            sets.push((reader.integers(joints, 4, count)?, reader.floats(weights, 4, count)?));
        }
        for vertex in 0..positions.len() {
            let mut row = Vec::new();
            let mut sum = 0.0;
            for (joints, weights) in &sets {
                for entry in vertex * 4..vertex * 4 + 4 {
                    let (slot, weight) = (joints[entry], weights[entry]);
                    if !weight.is_finite() || weight < 0.0 {
                        return Err(bad_input(format!(
                            "{}: vertex {vertex} has weight {weight} for joint {slot}: weights must be 0 or more, so mend them and export anew",
                            place()
                        )));
                    }
                    if weight == 0.0 {
                        continue;
                    }
                    if slot as usize >= joint_count {
                        return Err(bad_input(format!(
                            "{}: vertex {vertex} is weighted to joint {slot}, but its skin has {joint_count} joints: export the file anew",
                            place()
                        )));
                    }
                    sum += f64::from(weight);
                    row.push((slot, weight));
                }
            }
            for (_, weight) in &mut row {
                *weight = (f64::from(*weight) / sum) as f32;
            }
            if row.is_empty() {
                row.push((0, 1.0));
            }
            rows.push(row);
        }
    }
    Ok(Some(RawMesh { name, label, positions, normals, tangents, morph_targets, triangles, rows }))
}

/// Triangles of a list (mode 4), a strip (5) or a fan (6).
fn triangles_of(mode: u64, corners: &[u32]) -> Vec<[u32; 3]> {
    match mode {
        4 => corners.chunks_exact(3).map(|c| [c[0], c[1], c[2]]).collect(),
        // Every other triangle of a strip is wound the other way.
        5 => (corners.windows(3).enumerate())
            .map(|(index, c)| if index % 2 == 0 { [c[0], c[1], c[2]] } else { [c[0], c[2], c[1]] })
            .collect(),
        _ => match corners.split_first() {
            Some((&first, rest)) => rest.windows(2).map(|c| [c[0], c[1], first]).collect(),
            None => Vec::new(),
        },
    }
}

/// Refuses positions that are no numbers, before any transform can spread them.
fn check_finite(file: &str, index: usize, raw: &RawMesh) -> Result<()> {
    match raw.positions.iter().position(|p| !p.is_finite()) {
        Some(vertex) => Err(bad_input(format!(
            "{file}: mesh {index} ({}): vertex {vertex} is at {}: positions must be finite numbers, so mend the mesh and export anew",
            raw.name, raw.positions[vertex]
        ))
        .in_mesh(index)
        .at(vertex)),
        None => Ok(()),
    }
}

/// Brings a primitive into rest pose and model space.
fn place(
    raw: RawMesh,
    binding: &mut Binding,
    skins: &[Skin],
    pose: &RestPose,
    joint_of_node: &[Option<usize>],
) -> Mesh {
    let count = raw.positions.len();
    let joint_at = |node: usize| joint_of_node[node].unwrap_or(0) as u32;
    let weights = match binding.skin {
        None => {
            binding.placement = Placement::Common(pose.rest[binding.node]);
            Weights::rigid(joint_at(binding.node), count)
        }
        Some(skin) => {
            let placement = &pose.placements[skin];
            binding.placement = if placement.uniform {
                Placement::Common(placement.common)
            } else {
                let blend = |row: &Vec<(u32, f32)>| {
                    let sum: f64 = row.iter().map(|&(_, weight)| f64::from(weight)).sum();
                    let blended = row.iter().fold(DMat4::ZERO, |blended, &(slot, weight)| {
                        blended + placement.by_joint[slot as usize] * (f64::from(weight) / sum)
                    });
                    if blended.determinant().abs() > 1e-30 { blended } else { placement.common }
                };
                Placement::PerVertex(raw.rows.iter().map(blend).collect())
            };
            let joints = &skins[skin].joints;
            let rows = raw.rows.iter();
            Weights::from_rows(
                rows.map(|row| row.iter().map(|&(slot, weight)| (joint_at(joints[slot as usize]), weight))),
            )
        }
    };
    let mut mesh = Mesh {
        name: raw.name,
        kind: None,
        positions: raw.positions,
        triangles: raw.triangles,
        normals: raw.normals,
        tangents: raw.tangents,
        morph_targets: raw.morph_targets,
        weights,
    };
    for vertex in 0..count {
        let frame = Frame::of(binding.placement.at(vertex));
        mesh.positions[vertex] = frame.point(mesh.positions[vertex].as_dvec3()).as_vec3();
        let mut normal_scale = 1.0;
        let mut tangent_scale = 1.0;
        if let Some(normal) = mesh.normals.get_mut(vertex) {
            (*normal, normal_scale) = frame.normal(*normal);
        }
        if let Some(tangent) = mesh.tangents.get_mut(vertex) {
            let (direction, scale) = frame.tangent(tangent.truncate());
            (*tangent, tangent_scale) = (direction.extend(tangent.w), scale);
        }
        for target in &mut mesh.morph_targets {
            let delta = &mut target.positions[vertex];
            *delta = frame.delta(*delta, 1.0);
            if let Some(delta) = target.normals.get_mut(vertex) {
                *delta = frame.normal_delta(*delta, normal_scale);
            }
            if let Some(delta) = target.tangents.get_mut(vertex) {
                *delta = frame.delta(*delta, tangent_scale);
            }
        }
    }
    mesh
}

/// An affine map with what it does to directions and normals.
pub struct Frame {
    matrix: DMat4,
    linear: DMat3,
    normals: DMat3,
    identity: bool,
}

impl Frame {
    /// The map of a matrix that can be inverted.
    pub fn of(matrix: DMat4) -> Self {
        let linear = DMat3::from_mat4(matrix);
        Self { matrix, linear, normals: linear.inverse().transpose(), identity: matrix == DMat4::IDENTITY }
    }

    /// Maps a point.
    pub fn point(&self, point: DVec3) -> DVec3 {
        self.matrix.transform_point3(point)
    }

    /// Maps a displacement, times `scale`; one of 0 stays exactly 0.
    pub fn delta(&self, delta: Vec3, scale: f64) -> Vec3 {
        Self::scaled(&self.linear, delta, scale, self.identity)
    }

    /// Maps the change of a normal whose length was divided by `scale`'s inverse.
    pub fn normal_delta(&self, delta: Vec3, scale: f64) -> Vec3 {
        Self::scaled(&self.normals, delta, scale, self.identity)
    }

    fn scaled(linear: &DMat3, delta: Vec3, scale: f64, identity: bool) -> Vec3 {
        if identity && scale == 1.0 || delta == Vec3::ZERO {
            return delta;
        }
        (*linear * delta.as_dvec3() * scale).as_vec3()
    }

    /// Maps a unit normal; also what its length was multiplied by to be 1 again.
    pub fn normal(&self, normal: Vec3) -> (Vec3, f64) {
        self.unit(&self.normals, normal)
    }

    /// Maps a unit tangent; also what its length was multiplied by to be 1 again.
    pub fn tangent(&self, tangent: Vec3) -> (Vec3, f64) {
        self.unit(&self.linear, tangent)
    }

    fn unit(&self, linear: &DMat3, direction: Vec3) -> (Vec3, f64) {
        // Unit but for rounding: left as it is, bit for bit.
        if self.identity && (direction.length_squared() - 1.0).abs() < 1e-4 {
            return (direction, 1.0);
        }
        let mapped = *linear * direction.as_dvec3();
        let length = mapped.length();
        if length > 0.0 && length.is_finite() {
            ((mapped / length).as_vec3(), 1.0 / length)
        } else {
            (direction, 1.0)
        }
    }
}

/// Kinds by pattern, else by name; only what hangs from the head is hair or part of a face.
fn set_kinds(
    meshes: &mut [Mesh],
    labels: &[String],
    patterns: &[(MeshKind, Regex)],
    skeleton: &Skeleton,
    humanoid: &Humanoid,
    warnings: &mut Vec<Warning>,
) {
    let head = humanoid.joint(Role::Head);
    let mut of_head = vec![false; skeleton.joints.len()];
    for joint in skeleton.parents_first() {
        let parent = skeleton.joints[joint].parent;
        of_head[joint] = Some(joint) == head || parent.is_some_and(|parent| of_head[parent]);
    }
    let mut guessed = Vec::new();
    for (mesh, label) in meshes.iter_mut().zip(labels) {
        if let Some((kind, _)) = patterns.iter().find(|(_, pattern)| pattern.is_match(label)) {
            mesh.kind = Some(*kind);
            continue;
        }
        // The material says most about a single primitive, then the mesh, then the node.
        let Some(kind) = label.rsplit('|').find_map(MeshKind::guess) else {
            continue;
        };
        let share_of_head = head.map(|_| {
            let rows = mesh.weights.rows();
            let held: f64 = rows
                .flat_map(|row| row.iter().filter(|&&(joint, _)| of_head[joint as usize]))
                .map(|&(_, weight)| f64::from(weight))
                .sum();
            held / mesh.weights.row_count().max(1) as f64
        });
        let needed = match kind {
            MeshKind::Hair => 0.5,
            MeshKind::FacePart => 0.9,
            _ => 0.0,
        };
        if share_of_head.is_none_or(|share| share >= needed) {
            mesh.kind = Some(kind);
            if kind != MeshKind::Body {
                guessed.push(format!("{} ({kind})", mesh.name));
            }
        }
    }
    if !guessed.is_empty() {
        let message = format!("kinds were guessed from names, so check them: {}", guessed.join(", "));
        warnings.push(Warning::new("kind_guessed", message).about("kinds"));
    }
}
