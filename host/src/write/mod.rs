//! From a deformed character back to its file.
//!
//! Numbers are written over the old ones where that is possible, so that the file keeps its layout; what is not
//! changed keeps its bits. Accessors and buffer views keep their numbers, since extensions may name them.

mod animations;
mod clips;
pub mod colliders;
mod nodes;
pub(crate) mod numbers;
mod store;
mod thumbnail;
mod vertices;
mod vrm;

use super::accessor::Reader;
use super::file::GltfFile;
use super::load::Loaded;
use super::rig::add_floats;
use super::{array_at, bad_input};
use animations::animation_slots;
use clips::Retarget;
use glam::{DMat4, DVec3, Vec3};
use nodes::{move_nodes, skin_slots};
use serde_json::{Value, json};
use store::store;
use superdeform::{Deformed, Mapped, Result};
pub use thumbnail::{set_image, set_thumbnail};
use vertices::mesh_slots;

/// Where the field takes a point (model space) that is attached to a joint.
pub type MapPoint<'a> = dyn Fn(usize, DVec3) -> Mapped + 'a;

/// A place in the JSON that names an accessor.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Place {
    Attribute { mesh: usize, primitive: usize, key: &'static str },
    Target { mesh: usize, primitive: usize, target: usize, key: &'static str },
    InverseBinds { skin: usize },
    Input { animation: usize, sampler: usize },
    Output { animation: usize, sampler: usize },
}

impl Place {
    fn pointer(&self) -> String {
        match self {
            Self::Attribute { mesh, primitive, key } => {
                format!("/meshes/{mesh}/primitives/{primitive}/attributes/{key}")
            }
            Self::Target { mesh, primitive, target, key } => {
                format!("/meshes/{mesh}/primitives/{primitive}/targets/{target}/{key}")
            }
            Self::InverseBinds { skin } => format!("/skins/{skin}/inverseBindMatrices"),
            Self::Input { animation, sampler } => {
                format!("/animations/{animation}/samplers/{sampler}/input")
            }
            Self::Output { animation, sampler } => {
                format!("/animations/{animation}/samplers/{sampler}/output")
            }
        }
    }

    fn set(&self, json: &mut Value, accessor: usize) {
        let pointer = self.pointer();
        let (holder, key) = pointer.rsplit_once('/').unwrap_or(("", ""));
        if let Some(holder) = json.pointer_mut(holder) {
            holder[key] = json!(accessor);
        }
    }

    fn needs_bounds(&self) -> bool {
        matches!(
            self,
            Self::Attribute { key: "POSITION", .. }
                | Self::Target { key: "POSITION", .. }
                | Self::Input { .. }
        )
    }

    fn is_vertex_data(&self) -> bool {
        matches!(self, Self::Attribute { .. } | Self::Target { .. })
    }
}

/// The numbers that a place should lead to.
struct Slot {
    place: Place,
    components: usize,
    numbers: Vec<f32>,
}

/// Puts a deformed character into its file and gives the file's bytes (GLB).
///
/// - `deformed`: one mesh for each of `loaded.character`; one joint for each of its joints, none without a rig.
/// - `map_point`: where the field takes a point that is attached to a joint: spring bones, colliders, viewpoint.
///
/// # Errors
/// Arrays of other lengths than the character's, numbers that are not finite, or a result of 2 GB or more.
pub fn write(loaded: &Loaded, deformed: &Deformed, map_point: &MapPoint) -> Result<Vec<u8>> {
    rewrite(loaded, deformed, map_point)?.to_bytes()
}

/// As [`write()`], but gives the file itself.
///
/// # Errors
/// As [`write()`].
pub fn rewrite(loaded: &Loaded, deformed: &Deformed, map_point: &MapPoint) -> Result<GltfFile> {
    check(loaded, deformed)?;
    let new_rest = new_rest(loaded, deformed);
    let mut file = loaded.file.clone();
    // A reader counts what it has read: each stage reads no more than loading did.
    let reader = || Reader::new(&loaded.file);
    let mut slots = Vec::new();
    mesh_slots(loaded, deformed, &new_rest, &reader(), &mut file.json, &mut slots)?;
    skin_slots(loaded, &new_rest, &reader(), &mut slots)?;
    let shifts = move_nodes(loaded, &new_rest, &mut file.json);
    let retarget = Retarget::new(loaded, deformed, &new_rest, &shifts, map_point);
    animation_slots(loaded, &retarget, &shifts, &reader(), &mut file.json, &mut slots)?;
    store(&reader(), &mut file, slots)?;
    let height_ratio = height_ratio(loaded, deformed);
    vrm::move_points(&mut file.json, loaded, &new_rest, map_point, height_ratio);
    Ok(file)
}

/// Vertices and nodes alone, for who has the rest: nodes, meshes, primitives and skins under their numbers in the file, and of
/// each what [`rewrite()`] would change, as packed floats. No indices, morph targets, materials, images or animations.
///
/// # Errors
/// As [`write()`].
pub fn at_rest(loaded: &Loaded, deformed: &Deformed) -> Result<GltfFile> {
    check(loaded, deformed)?;
    let new_rest = new_rest(loaded, deformed);
    let reader = Reader::new(&loaded.file);
    let mut file = bare(&loaded.file);
    let mut slots = Vec::new();
    mesh_slots(loaded, deformed, &new_rest, &reader, &mut file.json, &mut slots)?;
    skin_slots(loaded, &new_rest, &reader, &mut slots)?;
    move_nodes(loaded, &new_rest, &mut file.json);
    for Slot { place, components, numbers } in slots {
        let bytes = numbers.iter().flat_map(|number| number.to_le_bytes()).collect();
        let accessor = add_floats(&mut file, bytes, numbers.len() / components, type_of(components));
        place.set(&mut file.json, accessor);
    }
    file.json["buffers"] = json!([{"byteLength": file.binary.len()}]);
    Ok(file)
}

/// The file without its numbers: nodes as they are, meshes and skins empty.
fn bare(file: &GltfFile) -> GltfFile {
    let primitives = |mesh| array_at(mesh, "primitives").iter().map(|_| json!({"attributes": {}})).collect();
    let meshes = |mesh| json!({"primitives": Value::Array(primitives(mesh))});
    let json = json!({
        "asset": file.json["asset"],
        "scene": file.json["scene"],
        "scenes": file.json["scenes"],
        "nodes": file.json["nodes"],
        "meshes": file.list("meshes").iter().map(meshes).collect::<Value>(),
        "skins": file.list("skins").iter().map(|skin| json!({"joints": skin["joints"]})).collect::<Value>(),
        "accessors": [],
        "bufferViews": [],
    });
    GltfFile { name: file.name.clone(), json, ..GltfFile::default() }
}

/// What glTF calls a float accessor of so many numbers an element.
fn type_of(components: usize) -> &'static str {
    match components {
        1 => "SCALAR",
        4 => "VEC4",
        16 => "MAT4",
        _ => "VEC3",
    }
}

fn check(loaded: &Loaded, deformed: &Deformed) -> Result<()> {
    let name = &loaded.file.name;
    let meshes = &loaded.character.meshes;
    if deformed.meshes.len() != meshes.len() {
        return Err(bad_input(format!(
            "{name}: {} deformed meshes for {}: give one a mesh",
            deformed.meshes.len(),
            meshes.len()
        )));
    }
    if deformed.joints.len() < loaded.node_of_joint.len() {
        return Err(bad_input(format!(
            "{name}: {} deformed joints for {}: give one a joint",
            deformed.joints.len(),
            loaded.node_of_joint.len()
        )));
    }
    if let Some(joint) = deformed.joints.iter().position(|joint| !joint.is_finite()) {
        return Err(bad_input(format!(
            "{name}: joint {joint} would be at {}: joints must be finite",
            deformed.joints[joint]
        )));
    }
    for (index, (mesh, new)) in meshes.iter().zip(&deformed.meshes).enumerate() {
        if new.positions.len() != mesh.positions.len() {
            return Err(bad_input(format!(
                "{name}: mesh {index} ({}) came back with {} vertices for {}: give one a vertex",
                mesh.name,
                new.positions.len(),
                mesh.positions.len()
            )));
        }
        let stray = |list: &[Vec3]| list.iter().position(|v| !v.is_finite());
        let targets = new.morph_targets.iter().flat_map(|target| [&target.positions, &target.normals]);
        let lists = [&new.positions, &new.normals].into_iter().chain(targets);
        if let Some(vertex) = lists.into_iter().find_map(|list| stray(list)) {
            return Err(bad_input(format!(
                "{name}: mesh {index} ({}): vertex {vertex} would become a number that is not finite: use a milder style",
                mesh.name
            )));
        }
    }
    Ok(())
}

/// Where each node rests after the deformation: joints move and neither turn nor scale.
pub fn new_rest(loaded: &Loaded, deformed: &Deformed) -> Vec<DMat4> {
    let mut rest = loaded.pose.rest.clone();
    for (joint, &node) in loaded.node_of_joint.iter().enumerate() {
        rest[node].w_axis = deformed.joints[joint].extend(rest[node].w_axis.w);
    }
    rest
}

/// New over old height of the figure.
pub fn height_ratio(loaded: &Loaded, deformed: &Deformed) -> f64 {
    let up = loaded.character.axes.up.as_dvec3().normalize_or(DVec3::Y);
    let (low, high) = extent(loaded.character.meshes.iter().map(|mesh| mesh.positions.as_slice()), up);
    let (new_low, new_high) = extent(deformed.meshes.iter().map(|mesh| mesh.positions.as_slice()), up);
    let ratio = (new_high - new_low) / (high - low);
    if ratio.is_finite() && ratio > 0.0 { ratio } else { 1.0 }
}

/// Least and greatest height along `up`.
pub fn extent<'a>(meshes: impl Iterator<Item = &'a [Vec3]>, up: DVec3) -> (f64, f64) {
    meshes
        .flatten()
        .map(|p| p.as_dvec3().dot(up))
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), height| (low.min(height), high.max(height)))
}

fn same_bits(one: &[f32], two: &[f32]) -> bool {
    one.len() == two.len() && one.iter().zip(two).all(|(a, b)| a.to_bits() == b.to_bits())
}
