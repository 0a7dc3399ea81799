//! From a file to a character in rest pose, and what leads back from there.

use super::accessor::Reader;
use super::bind::{NodeTree, RestPose, Skin, read_skins, rest_pose};
use super::file::GltfFile;
use super::frame::Frame;
use super::kinds::set_kinds;
use super::licence::Licence;
use super::primitive::{RawMesh, read_primitive};
use super::{array_at, bad_input, index_at, roles, text_at};
use glam::{DMat4, Vec3};
use regex_lite::Regex;
use serde_json::Value;
use std::collections::BTreeSet;
use superdeform::{
    Axes, Character, Element, Error, ErrorKind, Humanoid, Joint, Mesh, MeshKind, Result, Skeleton, Warning,
    Weights,
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
    /// What the file says of its licence.
    pub licence: Licence,
    /// What a person should know.
    pub warnings: Vec<Warning>,
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
    let (mut bindings, raw_meshes) = read_meshes(&reader, &tree, &mut skins)?;
    let pose = rest_pose(&tree, &skins);
    let mut warnings = Vec::new();
    if pose.differs {
        warnings.push(Warning::new(
            "pose_not_rest",
            format!("{} is posed: its rest pose was read from the inverse bind matrices", file.name),
        ));
    }
    let mut meshes = Vec::new();
    let mut names = Vec::new();
    for (index, (raw, binding)) in raw_meshes.into_iter().zip(&mut bindings).enumerate() {
        check_finite(&file.name, index, &raw)?;
        names.push(raw.names.clone());
        meshes.push(place(raw, binding, &skins, &pose, &joint_of_node));
    }
    let joints = tree.order.iter().map(|&node| Joint {
        name: text_at(&file.list("nodes")[node], "name").to_string(),
        parent: tree.parents[node].and_then(|parent| joint_of_node[parent]),
        rest: pose.rest[node],
    });
    let skeleton = Skeleton { joints: joints.collect() };
    let humanoid = find_humanoid(&file, options, &tree, &joint_of_node, &skeleton, &meshes, &mut warnings)?;
    let rigged = humanoid.is_some();
    let humanoid = humanoid.unwrap_or_default();
    let mut character = Character { meshes, skeleton, humanoid, axes: options.axes, ..Character::default() };
    set_kinds(&mut character, &names, options.kinds, &mut warnings);
    let mut node_of_joint = tree.order.clone();
    if !rigged {
        character.skeleton = Skeleton::default();
        character.meshes.iter_mut().for_each(|mesh| mesh.weights = Weights::default());
        node_of_joint.clear();
    }
    let licence = Licence::of(&file);
    warnings.extend(licence.warning(&file.name));
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
        licence,
        warnings,
    })
}

/// The primitives that the scene shows, in the order of its nodes; skins get to know their vertices' bounds.
fn read_meshes(reader: &Reader, tree: &NodeTree, skins: &mut [Skin]) -> Result<(Vec<Binding>, Vec<RawMesh>)> {
    let file = reader.file;
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
            let Some(raw) = read_primitive(reader, node, mesh, primitive, joint_count)? else {
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
            let placement = Placement::Common(DMat4::IDENTITY);
            bindings.push(Binding { node, mesh, primitive, skin, placement });
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
    Ok((bindings, raw_meshes))
}

/// The roles of the file's rig: by its header, the map, names and geometry; `None` where it has no rig or none is wanted.
///
/// # Errors
/// A map that does not fit the file, or a role that nothing can be deformed without.
fn find_humanoid(
    file: &GltfFile,
    options: &LoadOptions,
    tree: &NodeTree,
    joint_of_node: &[Option<usize>],
    skeleton: &Skeleton,
    meshes: &[Mesh],
    warnings: &mut Vec<Warning>,
) -> Result<Option<Humanoid>> {
    if options.without_rig {
        return Ok(None);
    }
    let mut humanoid = roles::roles_of_vrm(file, joint_of_node)?;
    if let Some(map) = options.humanoid_map {
        roles::apply_map(file, tree, joint_of_node, map, &mut humanoid)?;
    }
    if let Some(find_roles) = options.find_roles.filter(|_| !humanoid.missing().is_empty()) {
        let (found, found_warnings) = find_roles(skeleton, meshes, options.axes.up);
        for (role, joint) in found.iter() {
            if !humanoid.has(role) && humanoid.iter().all(|(_, taken)| taken != joint) {
                humanoid.set(role, joint);
            }
        }
        warnings.extend(found_warnings);
    }
    // Without a skin the nodes may be nothing but places for meshes, called like joints: a figure that has yet to get
    // a rig.
    let rigged = !file.list("skins").is_empty() || options.humanoid_map.is_some() || is_vrm(file);
    let Some(&role) = humanoid.missing().first() else {
        return Ok((rigged || hangs_from(&humanoid, skeleton, meshes)).then_some(humanoid));
    };
    if rigged && !options.incomplete_rig {
        let message = format!("{} shows no joint for the role {role}: name one", file.name);
        return Err(Error::new(ErrorKind::NoHumanoid, message).about("humanoid"));
    }
    Ok(rigged.then_some(humanoid))
}

/// True where most vertices hang from joints of `humanoid`, and not all from one: a figure of rigid pieces.
fn hangs_from(humanoid: &Humanoid, skeleton: &Skeleton, meshes: &[Mesh]) -> bool {
    let mut has_role = vec![false; skeleton.joints.len()];
    humanoid.iter().for_each(|(_, joint)| has_role[joint] = true);
    // A joint without a role hangs from the next one above it that has one.
    let hung: Vec<Option<usize>> = (0..skeleton.joints.len())
        .map(|joint| {
            std::iter::successors(Some(joint), |&joint| skeleton.joints[joint].parent)
                .take(skeleton.joints.len())
                .find(|&joint| has_role[joint])
        })
        .collect();
    let (mut moved, mut from) = (0, BTreeSet::new());
    for row in meshes.iter().flat_map(|mesh| mesh.weights.rows()) {
        let largest = row.iter().max_by(|a, b| a.1.total_cmp(&b.1));
        if let Some(joint) = largest.and_then(|&(joint, _)| hung[joint as usize]) {
            moved += 1;
            from.insert(joint);
        }
    }
    let all: usize = meshes.iter().map(|mesh| mesh.positions.len()).sum();
    2 * moved > all && from.len() > 1
}

/// True for files with a VRM header of either version.
pub fn is_vrm(file: &GltfFile) -> bool {
    let extensions = &file.json["extensions"];
    extensions.get("VRMC_vrm").is_some() || extensions.get("VRM").is_some()
}

/// Refuses positions that are no numbers, before any transform can spread them.
fn check_finite(file: &str, index: usize, raw: &RawMesh) -> Result<()> {
    match raw.positions.iter().position(|p| !p.is_finite()) {
        Some(vertex) => Err(bad_input(format!(
            "{file}: mesh {index} ({}): vertex {vertex} is at {}: positions must be finite numbers, so mend the mesh and export anew",
            raw.name, raw.positions[vertex]
        ))
        .in_mesh(index)
        .at(Element::Vertex(vertex))),
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
        shade: superdeform::internals::character::Shade::Unknown,
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
