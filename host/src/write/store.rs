//! Numbers into accessors: over the old ones where nothing else reads them, else into new ones.

use super::{Slot, same_bits, type_of};
use crate::accessor::{Layout, Reader};
use crate::file::GltfFile;
use crate::{array_at, index_at};
use serde_json::{Value, json};
use std::collections::{BTreeMap, BTreeSet};
use superdeform::Result;

/// An accessor that gets numbers of its own.
struct Definition {
    accessor: usize,
    numbers: Vec<f32>,
    components: usize,
    bounds: bool,
    vertex_data: bool,
    sparse: bool,
}

/// Puts the numbers of all slots into the file.
pub(super) fn store(reader: &Reader, file: &mut GltfFile, slots: Vec<Slot>) -> Result<()> {
    let uses = accessor_uses(&file.json);
    let places: BTreeSet<String> = slots.iter().map(|slot| slot.place.pointer()).collect();
    // Accessors that also stand in places which keep their numbers.
    let foreign: BTreeSet<usize> = uses
        .iter()
        .filter(|(pointer, _)| !places.contains(*pointer))
        .map(|(_, &accessor)| accessor)
        .collect();
    let mut by_accessor: BTreeMap<Option<usize>, Vec<Slot>> = BTreeMap::new();
    for slot in slots {
        let accessor = uses.get(&slot.place.pointer()).copied();
        by_accessor.entry(accessor).or_default().push(slot);
    }
    let overlaps = Overlaps::of(reader);
    let mut definitions: Vec<Definition> = Vec::new();
    for (accessor, slots) in by_accessor {
        // The versions of this accessor: the numbers, and which accessor holds them.
        let mut versions: Vec<(Vec<f32>, usize)> = Vec::new();
        let mut free = accessor.filter(|accessor| !foreign.contains(accessor));
        if let Some(accessor) = accessor {
            let old = reader.floats(accessor, slots[0].components, None)?;
            if slots.iter().any(|slot| same_bits(&slot.numbers, &old)) {
                free = None;
            }
            versions.push((old, accessor));
        }
        for slot in slots {
            let known =
                versions.iter().find(|(numbers, _)| accessor.is_some() && same_bits(numbers, &slot.numbers));
            if let Some(&(_, holder)) = known {
                slot.place.set(&mut file.json, holder);
                continue;
            }
            let bounds = slot.place.needs_bounds();
            let holder = match free.take() {
                Some(accessor) => accessor,
                None => {
                    let new = match accessor {
                        Some(accessor) => file.json["accessors"][accessor].clone(),
                        None => {
                            json!({"componentType": 5126, "type": type_of(slot.components)})
                        }
                    };
                    let Some(accessors) = file.json["accessors"].as_array_mut() else {
                        continue;
                    };
                    accessors.push(new);
                    accessors.len() - 1
                }
            };
            let layout = accessor.map(|accessor| reader.layout(accessor)).transpose()?;
            let in_place = accessor == Some(holder)
                && layout.as_ref().is_some_and(|layout| {
                    let same_size = layout.count * layout.components == slot.numbers.len();
                    layout.component_type == 5126 && !layout.sparse && same_size
                })
                && !overlaps.disturbs(holder);
            if let (true, Some(layout)) = (in_place, &layout) {
                overwrite(&mut file.binary, layout, &slot.numbers);
                set_bounds(&mut file.json["accessors"][holder], &slot.numbers, slot.components, bounds);
            } else {
                definitions.push(Definition {
                    accessor: holder,
                    numbers: slot.numbers.clone(),
                    components: slot.components,
                    bounds,
                    vertex_data: slot.place.is_vertex_data(),
                    sparse: layout.as_ref().is_some_and(|layout| layout.sparse),
                });
            }
            slot.place.set(&mut file.json, holder);
            versions.push((slot.numbers, holder));
        }
    }
    if !definitions.is_empty() {
        define(file, definitions);
    }
    Ok(())
}

/// Every place of the JSON that names an accessor, by pointer.
fn accessor_uses(json: &Value) -> BTreeMap<String, usize> {
    let mut uses = BTreeMap::new();
    let mut note = |pointer: String, value: &Value| {
        if let Some(accessor) = value.as_u64() {
            uses.insert(pointer, accessor as usize);
        }
    };
    for (mesh, mesh_json) in array_at(json, "meshes").iter().enumerate() {
        for (primitive, primitive_json) in array_at(mesh_json, "primitives").iter().enumerate() {
            let place = format!("/meshes/{mesh}/primitives/{primitive}");
            note(format!("{place}/indices"), &primitive_json["indices"]);
            for (key, value) in primitive_json["attributes"].as_object().into_iter().flatten() {
                note(format!("{place}/attributes/{key}"), value);
            }
            for (target, target_json) in array_at(primitive_json, "targets").iter().enumerate() {
                for (key, value) in target_json.as_object().into_iter().flatten() {
                    note(format!("{place}/targets/{target}/{key}"), value);
                }
            }
        }
    }
    for (skin, skin_json) in array_at(json, "skins").iter().enumerate() {
        note(format!("/skins/{skin}/inverseBindMatrices"), &skin_json["inverseBindMatrices"]);
    }
    for (animation, animation_json) in array_at(json, "animations").iter().enumerate() {
        for (sampler, sampler_json) in array_at(animation_json, "samplers").iter().enumerate() {
            for key in ["input", "output"] {
                note(format!("/animations/{animation}/samplers/{sampler}/{key}"), &sampler_json[key]);
            }
        }
    }
    uses
}

/// Which accessors have bytes in common.
struct Overlaps {
    /// First byte, end, stride, element size, accessor; by first byte.
    ranges: Vec<(usize, usize, usize, usize, usize)>,
    /// The furthest end up to each entry of `ranges`.
    furthest: Vec<usize>,
}

impl Overlaps {
    fn of(reader: &Reader) -> Self {
        let mut ranges: Vec<_> = (0..reader.file.list("accessors").len())
            .filter_map(|accessor| {
                let layout = reader.layout(accessor).ok()?;
                let range = layout.range()?;
                Some((range.start, range.end, layout.stride, layout.element_size(), accessor))
            })
            .collect();
        ranges.sort_unstable();
        let mut furthest = Vec::with_capacity(ranges.len());
        for &(_, end, ..) in &ranges {
            furthest.push(end.max(furthest.last().copied().unwrap_or(0)));
        }
        Self { ranges, furthest }
    }

    /// True where writing over an accessor would change another.
    fn disturbs(&self, accessor: usize) -> bool {
        let Some(&(start, end, stride, size, _)) = self.ranges.iter().find(|range| range.4 == accessor)
        else {
            return true;
        };
        let before = self.ranges.partition_point(|range| range.0 < end);
        for at in (0..before).rev() {
            if self.furthest[at] <= start {
                break;
            }
            let (other_start, other_end, other_stride, other_size, other) = self.ranges[at];
            if other == accessor || other_end <= start {
                continue;
            }
            // Interleaved: the same steps, and different bytes within each.
            let ahead = (other_start as i64 - start as i64).rem_euclid(stride as i64) as usize;
            let apart = stride == other_stride && ahead >= size && ahead + other_size <= stride;
            if !apart {
                return true;
            }
        }
        false
    }
}

fn overwrite(binary: &mut [u8], layout: &Layout, numbers: &[f32]) {
    let Some(start) = layout.start else { return };
    for (element, values) in numbers.chunks_exact(layout.components).enumerate() {
        for (component, value) in values.iter().enumerate() {
            let at = start + element * layout.stride + component * 4;
            binary[at..at + 4].copy_from_slice(&value.to_le_bytes());
        }
    }
}

/// Writes least and greatest values where there were some or `always`.
fn set_bounds(accessor: &mut Value, numbers: &[f32], components: usize, always: bool) {
    if !always && accessor.get("min").is_none() && accessor.get("max").is_none() {
        return;
    }
    let mut low = vec![f32::INFINITY; components];
    let mut high = vec![f32::NEG_INFINITY; components];
    for values in numbers.chunks_exact(components) {
        for (component, &value) in values.iter().enumerate() {
            low[component] = low[component].min(value);
            high[component] = high[component].max(value);
        }
    }
    accessor["min"] = json!(low);
    accessor["max"] = json!(high);
}

/// Gives accessors buffer views of their own; the bytes of views that nothing names any more are dropped.
fn define(file: &mut GltfFile, definitions: Vec<Definition>) {
    let named_before = named_views(&file.json);
    for definition in &definitions {
        if let Some(accessor) = file.json["accessors"][definition.accessor].as_object_mut() {
            for key in ["bufferView", "byteOffset", "sparse", "normalized"] {
                accessor.remove(key);
            }
        }
    }
    let named = named_views(&file.json);
    // Numbers of views that are free now are given again first.
    let mut free: Vec<usize> = named_before.difference(&named).copied().collect();
    let dropped = !free.is_empty();
    if !file.json["bufferViews"].is_array() {
        file.json["bufferViews"] = json!([]);
    }
    if array_at(&file.json, "buffers").is_empty() {
        file.json["buffers"] = json!([{"byteLength": 0}]);
    }
    if dropped {
        keep_named(file, &named);
    }
    let mut add_view = |file: &mut GltfFile, bytes: Vec<u8>, vertex_data: bool| {
        file.binary.resize(file.binary.len().next_multiple_of(4), 0);
        let mut view = json!({"buffer": 0, "byteOffset": file.binary.len(), "byteLength": bytes.len()});
        if vertex_data {
            view["target"] = json!(34962);
        }
        file.binary.extend_from_slice(&bytes);
        let views = file.json["bufferViews"].as_array_mut();
        match (free.pop(), views) {
            (Some(number), Some(views)) => {
                views[number] = view;
                number
            }
            (None, Some(views)) => {
                views.push(view);
                views.len() - 1
            }
            _ => 0,
        }
    };
    for definition in definitions {
        let count = definition.numbers.len() / definition.components.max(1);
        let mut accessor = file.json["accessors"][definition.accessor].clone();
        accessor["componentType"] = json!(5126);
        accessor["count"] = json!(count);
        set_bounds(&mut accessor, &definition.numbers, definition.components, definition.bounds);
        let elements = definition.numbers.chunks_exact(definition.components);
        let set: Vec<usize> = elements
            .enumerate()
            .filter(|(_, values)| values.iter().any(|&v| v != 0.0))
            .map(|(at, _)| at)
            .collect();
        let bytes_of =
            |values: &[f32]| values.iter().flat_map(|value| value.to_le_bytes()).collect::<Vec<u8>>();
        let element_size = 4 * definition.components;
        if definition.sparse && set.len() * (element_size + 4) < count * element_size {
            if !set.is_empty() {
                let indices = set.iter().flat_map(|&at| (at as u32).to_le_bytes()).collect();
                let index_view = add_view(file, indices, false);
                let values: Vec<f32> = set
                    .iter()
                    .flat_map(|&at| {
                        &definition.numbers[at * definition.components..(at + 1) * definition.components]
                    })
                    .copied()
                    .collect();
                let value_view = add_view(file, bytes_of(&values), false);
                accessor["sparse"] = json!({
                    "count": set.len(),
                    "indices": {"bufferView": index_view, "componentType": 5125},
                    "values": {"bufferView": value_view},
                });
            }
        } else {
            let view = add_view(file, bytes_of(&definition.numbers), definition.vertex_data);
            accessor["bufferView"] = json!(view);
        }
        file.json["accessors"][definition.accessor] = accessor;
    }
    // A number that stays free: the last ones go, others become as small as a view can be.
    if let Some(views) = file.json["bufferViews"].as_array_mut() {
        free.sort_unstable();
        while free.last().is_some_and(|&last| last + 1 == views.len()) {
            free.pop();
            views.pop();
        }
        for number in free {
            views[number] = json!({"buffer": 0, "byteOffset": 0, "byteLength": 4});
        }
    }
    file.json["buffers"][0]["byteLength"] = json!(file.binary.len());
}

/// The buffer views that anything in the JSON names under `bufferView`.
pub(super) fn named_views(json: &Value) -> BTreeSet<usize> {
    let mut named = BTreeSet::new();
    let mut stack = vec![json];
    while let Some(value) = stack.pop() {
        match value {
            Value::Array(values) => stack.extend(values),
            Value::Object(entries) => {
                for (key, value) in entries {
                    if key == "bufferView" {
                        named.extend(value.as_u64().map(|view| view as usize));
                    }
                    stack.push(value);
                }
            }
            _ => {}
        }
    }
    named
}

/// Keeps those bytes of the binary that the views `named` cover, and moves the views along.
pub(super) fn keep_named(file: &mut GltfFile, named: &BTreeSet<usize>) {
    let span = |view: &Value| {
        let start = index_at(view, "byteOffset").unwrap_or(0);
        (start, start + index_at(view, "byteLength").unwrap_or(0))
    };
    let mut spans: Vec<(usize, usize)> = file
        .list("bufferViews")
        .iter()
        .enumerate()
        .filter(|(view, _)| named.contains(view))
        .map(|(_, v)| span(v))
        .collect();
    spans.sort_unstable();
    // Views may share bytes: pieces are runs of bytes that belong together. Each: old start, end, new start.
    let mut pieces: Vec<(usize, usize, usize)> = Vec::new();
    for (start, end) in spans {
        match pieces.last_mut().filter(|piece| start < piece.1) {
            Some(piece) => piece.1 = piece.1.max(end),
            None => pieces.push((start, end, 0)),
        }
    }
    let mut binary = Vec::new();
    for (start, end, new_start) in &mut pieces {
        // The same place within eight bytes, so that what was aligned stays so.
        let gap = (*start + 8 - binary.len() % 8) % 8;
        binary.resize(binary.len() + gap, 0);
        *new_start = binary.len();
        binary.extend_from_slice(&file.binary[*start..*end]);
    }
    for &number in named {
        let Some(view) = file.json["bufferViews"].get_mut(number) else {
            continue;
        };
        let start = index_at(view, "byteOffset").unwrap_or(0);
        let at = pieces.partition_point(|piece| piece.0 <= start);
        if let Some(piece) = at.checked_sub(1).map(|at| pieces[at]) {
            view["byteOffset"] = json!(piece.2 + (start - piece.0));
        }
    }
    file.binary = binary;
}
