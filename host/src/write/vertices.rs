//! Vertices back into the file's space.

use super::{Place, Slot, same_bits};
use crate::accessor::Reader;
use crate::frame::Frame;
use crate::index_at;
use crate::load::{Loaded, Placement};
use glam::{DMat4, Vec3};
use serde_json::{Value, json};
use std::collections::BTreeMap;
use superdeform::{Deformed, DeformedMesh, Mesh, Result};

/// The numbers of all vertices; a mesh that two nodes show is doubled where they deform it differently.
pub(super) fn mesh_slots(
    loaded: &Loaded,
    deformed: &Deformed,
    new_rest: &[DMat4],
    reader: &Reader,
    json: &mut Value,
    slots: &mut Vec<Slot>,
) -> Result<()> {
    let mut instances: BTreeMap<(usize, usize), Vec<usize>> = BTreeMap::new();
    for (index, binding) in loaded.bindings.iter().enumerate() {
        instances.entry((binding.mesh, binding.node)).or_default().push(index);
    }
    // The versions of each mesh so far: its number and its slots.
    let mut versions: BTreeMap<usize, Vec<(usize, Vec<Slot>)>> = BTreeMap::new();
    for ((mesh, node), indices) in instances {
        let mut local = Vec::new();
        for index in indices {
            primitive_slots(loaded, deformed, new_rest, reader, index, &mut local)?;
        }
        let known = versions.entry(mesh).or_default();
        let same = |other: &Vec<Slot>| {
            other.len() == local.len()
                && other.iter().zip(&local).all(|(one, two)| same_bits(&one.numbers, &two.numbers))
        };
        if let Some((number, _)) = known.iter().find(|(_, other)| same(other)) {
            if *number != mesh {
                json["nodes"][node]["mesh"] = json!(number);
            }
            continue;
        }
        let mut number = mesh;
        if !known.is_empty() {
            let copy = json["meshes"][mesh].clone();
            if let Some(meshes) = json["meshes"].as_array_mut() {
                number = meshes.len();
                meshes.push(copy);
            }
            json["nodes"][node]["mesh"] = json!(number);
            name_copy(json, mesh, number);
            for slot in &mut local {
                match &mut slot.place {
                    Place::Attribute { mesh, .. } | Place::Target { mesh, .. } => *mesh = number,
                    _ => {}
                }
            }
        }
        known.push((number, local));
    }
    slots.extend(versions.into_values().flatten().flat_map(|(_, local)| local));
    Ok(())
}

/// Whatever VRM 0.x says of a mesh it also says of its copy: expressions and what is seen from within. VRM 1.0 names nodes.
fn name_copy(json: &mut Value, mesh: usize, copy: usize) {
    let Some(vrm) = json.pointer_mut("/extensions/VRM") else { return };
    let repeat = |list: Option<&mut Value>| {
        let Some(list) = list.and_then(Value::as_array_mut) else { return };
        let of_mesh = list.iter().filter(|entry| index_at(entry, "mesh") == Some(mesh));
        let mut more: Vec<Value> = of_mesh.cloned().collect();
        more.iter_mut().for_each(|entry| entry["mesh"] = json!(copy));
        list.extend(more);
    };
    repeat(vrm.pointer_mut("/firstPerson/meshAnnotations"));
    let groups = vrm.pointer_mut("/blendShapeMaster/blendShapeGroups").and_then(Value::as_array_mut);
    for group in groups.into_iter().flatten() {
        repeat(group.get_mut("binds"));
    }
}

/// What leads from model space back to the file's, vertex by vertex.
enum Frames {
    Common(Box<Frame>),
    PerVertex(Vec<Frame>),
}

impl Frames {
    fn at(&self, vertex: usize) -> &Frame {
        match self {
            Self::Common(frame) => frame,
            Self::PerVertex(frames) => &frames[vertex],
        }
    }
}

/// One primitive on its way back to the file.
struct Primitive<'a> {
    mesh: usize,
    primitive: usize,
    json: &'a Value,
    old: &'a Mesh,
    new: &'a DeformedMesh,
    frames: Frames,
    /// Where the way back is the way that the vertex came, an unchanged vertex keeps its bits.
    same_way: bool,
}

/// The numbers of one primitive in the file's space.
fn primitive_slots(
    loaded: &Loaded,
    deformed: &Deformed,
    new_rest: &[DMat4],
    reader: &Reader,
    index: usize,
    slots: &mut Vec<Slot>,
) -> Result<()> {
    let binding = &loaded.bindings[index];
    let frames = match (binding.skin, &binding.placement) {
        (None, _) => Frames::Common(Box::new(Frame::of(new_rest[binding.node].inverse()))),
        (Some(_), Placement::Common(matrix)) => Frames::Common(Box::new(Frame::of(matrix.inverse()))),
        (Some(_), Placement::PerVertex(matrices)) => {
            Frames::PerVertex(matrices.iter().map(|matrix| Frame::of(matrix.inverse())).collect())
        }
    };
    let primitive = Primitive {
        mesh: binding.mesh,
        primitive: binding.primitive,
        json: &loaded.file.list("meshes")[binding.mesh]["primitives"][binding.primitive],
        old: &loaded.character.meshes[index],
        new: &deformed.meshes[index],
        frames,
        same_way: binding.skin.is_some() || new_rest[binding.node] == loaded.pose.rest[binding.node],
    };
    primitive.position_slot(reader, slots)?;
    let normal_scales = primitive.normal_slot(reader, slots)?;
    let tangent_scales = primitive.tangent_slot(reader, slots)?;
    for target in 0..primitive.old.morph_targets.len().min(primitive.new.morph_targets.len()) {
        primitive.target_slots(reader, target, &normal_scales, &tangent_scales, slots)?;
    }
    Ok(())
}

impl Primitive<'_> {
    fn vertex_count(&self) -> usize {
        self.old.positions.len()
    }

    /// The accessor of an attribute, and a slot for what becomes of its numbers.
    fn attribute(&self, reader: &Reader, key: &'static str, components: usize) -> Result<Option<Slot>> {
        let Some(accessor) = index_at(&self.json["attributes"], key) else {
            return Ok(None);
        };
        let numbers = reader.floats(accessor, components, Some(self.vertex_count()))?;
        let place = Place::Attribute { mesh: self.mesh, primitive: self.primitive, key };
        Ok(Some(Slot { place, components, numbers }))
    }

    fn position_slot(&self, reader: &Reader, slots: &mut Vec<Slot>) -> Result<()> {
        let Some(mut slot) = self.attribute(reader, "POSITION", 3)? else {
            return Ok(());
        };
        for (vertex, raw) in slot.numbers.chunks_exact_mut(3).enumerate() {
            let position = self.new.positions[vertex];
            if !(self.same_way && position == self.old.positions[vertex]) {
                let point = self.frames.at(vertex).point(position.as_dvec3()).as_vec3();
                raw.copy_from_slice(&point.to_array());
            }
        }
        slots.push(slot);
        Ok(())
    }

    /// Gives what each normal's length was multiplied by, which its changes must be multiplied by too.
    fn normal_slot(&self, reader: &Reader, slots: &mut Vec<Slot>) -> Result<Vec<f64>> {
        let mut scales = vec![1.0; self.vertex_count()];
        if self.new.normals.len() != self.vertex_count() {
            return Ok(scales);
        }
        let Some(mut slot) = self.attribute(reader, "NORMAL", 3)? else {
            return Ok(scales);
        };
        for (vertex, raw) in slot.numbers.chunks_exact_mut(3).enumerate() {
            let (normal, scale) = self.frames.at(vertex).normal(self.new.normals[vertex]);
            scales[vertex] = scale;
            if !(self.same_way && self.new.normals[vertex] == self.old.normals[vertex]) {
                raw.copy_from_slice(&normal.to_array());
            }
        }
        slots.push(slot);
        Ok(scales)
    }

    /// As [`Primitive::normal_slot`], for tangents.
    fn tangent_slot(&self, reader: &Reader, slots: &mut Vec<Slot>) -> Result<Vec<f64>> {
        let mut scales = vec![1.0; self.vertex_count()];
        if self.new.tangents.len() != self.vertex_count() {
            return Ok(scales);
        }
        let Some(mut slot) = self.attribute(reader, "TANGENT", 4)? else {
            return Ok(scales);
        };
        for (vertex, raw) in slot.numbers.chunks_exact_mut(4).enumerate() {
            let (tangent, scale) = self.frames.at(vertex).tangent(self.new.tangents[vertex].truncate());
            scales[vertex] = scale;
            if !(self.same_way && self.new.tangents[vertex] == self.old.tangents[vertex]) {
                raw.copy_from_slice(&tangent.extend(self.new.tangents[vertex].w).to_array());
            }
        }
        slots.push(slot);
        Ok(scales)
    }

    /// One morph target; a list that the file does not have is added where it has become other than 0.
    fn target_slots(
        &self,
        reader: &Reader,
        target: usize,
        normal_scales: &[f64],
        tangent_scales: &[f64],
        slots: &mut Vec<Slot>,
    ) -> Result<()> {
        let (before, after) = (&self.old.morph_targets[target], &self.new.morph_targets[target]);
        for (key, before, after) in [
            ("POSITION", &before.positions, &after.positions),
            ("NORMAL", &before.normals, &after.normals),
            ("TANGENT", &before.tangents, &after.tangents),
        ] {
            if after.len() != self.vertex_count() || before.len() != after.len() {
                continue;
            }
            let mut numbers = match index_at(&self.json["targets"][target], key) {
                Some(accessor) => reader.floats(accessor, 3, Some(self.vertex_count()))?,
                None if after.iter().any(|delta| *delta != Vec3::ZERO) => vec![0.0; 3 * after.len()],
                None => continue,
            };
            for (vertex, raw) in numbers.chunks_exact_mut(3).enumerate() {
                // The normal's own length has a share in its delta, so both must be as they were.
                let kept = match key {
                    "NORMAL" => self.new.normals[vertex] == self.old.normals[vertex],
                    "TANGENT" => self.new.tangents[vertex] == self.old.tangents[vertex],
                    _ => true,
                };
                if self.same_way && kept && after[vertex] == before[vertex] {
                    continue;
                }
                let frame = self.frames.at(vertex);
                let delta = match key {
                    "NORMAL" => frame.normal_delta(after[vertex], normal_scales[vertex]),
                    "TANGENT" => frame.delta(after[vertex], tangent_scales[vertex]),
                    _ => frame.delta(after[vertex], 1.0),
                };
                // Adding 0 turns -0 into 0.
                raw.copy_from_slice(&(delta + Vec3::ZERO).to_array());
            }
            let place = Place::Target { mesh: self.mesh, primitive: self.primitive, target, key };
            slots.push(Slot { place, components: 3, numbers });
        }
        Ok(())
    }
}
