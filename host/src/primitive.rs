//! One primitive as the file has it: vertices, morph targets, triangles, weights.

use super::accessor::Reader;
use super::file::GltfFile;
use super::{array_at, bad_input, index_at, text_at};
use glam::{Vec3, Vec4};
use serde_json::Value;
use superdeform::internals::character::kinds::MeshNames;
use superdeform::{MorphTarget, Result};

/// One primitive as the file has it.
pub(super) struct RawMesh {
    /// What messages call it.
    pub(super) name: String,
    /// What says what it is.
    pub(super) names: MeshNames,
    pub(super) positions: Vec<Vec3>,
    pub(super) normals: Vec<Vec3>,
    pub(super) tangents: Vec<Vec4>,
    pub(super) morph_targets: Vec<MorphTarget>,
    pub(super) triangles: Vec<[u32; 3]>,
    /// Slots of the skin's joints, a vertex; empty where it hangs rigidly.
    pub(super) rows: Vec<Vec<(u32, f32)>>,
}

/// Reads a primitive; `None` where it has no vertices.
///
/// - `joint_count`: of the node's skin; `None` reads no weights.
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
    let attributes = &json["attributes"];
    let Some(accessor) = index_at(attributes, "POSITION") else {
        return Ok(None);
    };
    let names = names(file, node, mesh_json, json);
    let name = name(&names, array_at(mesh_json, "primitives").len());
    let place = || match name.as_str() {
        "" => format!("{}: mesh {mesh}", file.name),
        name => format!("{}: mesh {mesh} ({name})", file.name),
    };
    let positions = vec3s(reader, accessor, None)?;
    let count = Some(positions.len());
    let normals =
        index_at(attributes, "NORMAL").map_or(Ok(Vec::new()), |accessor| vec3s(reader, accessor, count))?;
    let tangents = match index_at(attributes, "TANGENT") {
        None => Vec::new(),
        Some(accessor) => reader.floats(accessor, 4, count)?.chunks_exact(4).map(Vec4::from_slice).collect(),
    };
    // What has no normals itself can have no changes of them.
    let keys = [("NORMAL", !normals.is_empty()), ("TANGENT", !tangents.is_empty())];
    // Some exporters write the names beside the primitive's targets.
    let target_names = match array_at(&mesh_json["extras"], "targetNames") {
        [] => array_at(&json["extras"], "targetNames"),
        names => names,
    };
    let mut morph_targets = Vec::new();
    for (index, target) in array_at(json, "targets").iter().enumerate() {
        let name = target_names.get(index).and_then(Value::as_str).unwrap_or("");
        morph_targets.push(read_target(reader, target, name, positions.len(), keys)?);
    }
    let triangles = read_triangles(reader, json, positions.len(), &place)?;
    let rows = match joint_count {
        Some(joint_count) if attributes.get("JOINTS_0").is_some() => {
            read_weights(reader, attributes, positions.len(), joint_count, &place)?
        }
        _ => Vec::new(),
    };
    Ok(Some(RawMesh { name, names, positions, normals, tangents, morph_targets, triangles, rows }))
}

fn names(file: &GltfFile, node: usize, mesh: &Value, primitive: &Value) -> MeshNames {
    let material = index_at(primitive, "material").and_then(|material| file.list("materials").get(material));
    MeshNames {
        node: text_at(&file.list("nodes")[node], "name").to_string(),
        mesh: text_at(mesh, "name").to_string(),
        material: material.map_or("", |material| text_at(material, "name")).to_string(),
    }
}

/// The mesh's name, else its node's; with the material's behind it where the mesh has several primitives.
fn name(MeshNames { node, mesh, material }: &MeshNames, primitive_count: usize) -> String {
    let name = if mesh.is_empty() { node } else { mesh };
    if primitive_count > 1 && !material.is_empty() { format!("{name}/{material}") } else { name.clone() }
}

fn vec3s(reader: &Reader, accessor: usize, count: Option<usize>) -> Result<Vec<Vec3>> {
    let numbers = reader.floats(accessor, 3, count)?;
    Ok(numbers.chunks_exact(3).map(Vec3::from_slice).collect())
}

/// One morph target; positions that it does not give are 0.
fn read_target(
    reader: &Reader,
    target: &Value,
    name: &str,
    vertex_count: usize,
    [normals, tangents]: [(&str, bool); 2],
) -> Result<MorphTarget> {
    let read = |key: &str| {
        index_at(target, key).map_or(Ok(Vec::new()), |accessor| vec3s(reader, accessor, Some(vertex_count)))
    };
    let read_where = |(key, wanted): (&str, bool)| if wanted { read(key) } else { Ok(Vec::new()) };
    let mut positions = read("POSITION")?;
    if positions.is_empty() {
        positions = vec![Vec3::ZERO; vertex_count];
    }
    let (normals, tangents) = (read_where(normals)?, read_where(tangents)?);
    Ok(MorphTarget { name: name.to_string(), positions, normals, tangents })
}

/// The triangles of a primitive; none where it draws points or lines.
fn read_triangles(
    reader: &Reader,
    json: &Value,
    vertex_count: usize,
    place: &dyn Fn() -> String,
) -> Result<Vec<[u32; 3]>> {
    let mode = json.get("mode").and_then(Value::as_u64).unwrap_or(4);
    if !(4..=6).contains(&mode) {
        return Ok(Vec::new());
    }
    let corners = match index_at(json, "indices") {
        Some(accessor) => reader.integers(accessor, 1, None)?,
        None => (0..vertex_count as u32).collect(),
    };
    if let Some(at) = corners.iter().position(|&corner| corner as usize >= vertex_count) {
        return Err(bad_input(format!(
            "{}: index {at} names vertex {}, but the mesh has {vertex_count} vertices (0 to {}): export the file anew",
            place(),
            corners[at],
            vertex_count - 1
        )));
    }
    Ok(triangles_of(mode, &corners))
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

/// Weights to slots of the skin, one row a vertex; each row's sum is 1, and one without weights follows slot 0.
fn read_weights(
    reader: &Reader,
    attributes: &Value,
    vertex_count: usize,
    joint_count: usize,
    place: &dyn Fn() -> String,
) -> Result<Vec<Vec<(u32, f32)>>> {
    let mut sets = Vec::new();
    for set in 0.. {
        let joints = index_at(attributes, &format!("JOINTS_{set}"));
        let weights = index_at(attributes, &format!("WEIGHTS_{set}"));
        let (Some(joints), Some(weights)) = (joints, weights) else {
            break;
        };
        let count = Some(vertex_count);
        sets.push((reader.integers(joints, 4, count)?, reader.floats(weights, 4, count)?));
    }
    let mut rows = Vec::with_capacity(vertex_count);
    for vertex in 0..vertex_count {
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
    Ok(rows)
}
