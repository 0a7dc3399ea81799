//! Accessors: numbers out of the binary chunk, however they are laid out.

use super::file::GltfFile;
use super::{bad_input, index_at, text_at};
use serde_json::Value;
use std::cell::Cell;
use std::ops::Range;
use superdeform::Result;

/// How many bytes of numbers are taken out of one file at most, counted each time that an accessor is used: a small
/// file may name the same numbers any number of times.
const LARGEST_READ: u64 = 1 << 30;

/// Where the elements of an accessor lie.
#[derive(Clone, Debug)]
pub struct Layout {
    /// Number of elements.
    pub count: usize,
    /// Numbers an element.
    pub components: usize,
    /// glTF's number of the component type.
    pub component_type: u64,
    /// Whole numbers that stand for 0 to 1 or -1 to 1.
    pub normalized: bool,
    /// Byte of the first element in the file's binary; `None` where all elements are 0 unless `sparse` says otherwise.
    pub start: Option<usize>,
    /// Bytes from one element to the next.
    pub stride: usize,
    /// True where single elements are replaced.
    pub sparse: bool,
}

impl Layout {
    /// Bytes of one element.
    pub fn element_size(&self) -> usize {
        component_size(self.component_type) * self.components
    }

    /// The bytes from the first element to the end of the last.
    pub fn range(&self) -> Option<Range<usize>> {
        let length = (self.count.checked_sub(1)?) * self.stride + self.element_size();
        self.start.map(|start| start..start + length)
    }
}

fn component_size(component_type: u64) -> usize {
    match component_type {
        5120 | 5121 => 1,
        5122 | 5123 => 2,
        _ => 4,
    }
}

/// Reads accessors of one file and keeps count of how much was read.
pub struct Reader<'a> {
    /// The file.
    pub file: &'a GltfFile,
    read: Cell<u64>,
}

impl<'a> Reader<'a> {
    /// A reader that has read nothing yet.
    pub fn new(file: &'a GltfFile) -> Self {
        Self { file, read: Cell::new(0) }
    }

    fn error(&self, accessor: usize, message: impl std::fmt::Display) -> superdeform::Error {
        bad_input(format!("{}: accessor {accessor} {message}: export the file anew", self.file.name))
    }

    /// Where the elements of an accessor lie, checked against the file.
    ///
    /// # Errors
    /// Unknown types, elements beyond the buffer view, or a count that the file's size cannot justify.
    pub fn layout(&self, accessor: usize) -> Result<Layout> {
        let missing = || self.error(accessor, "is not there");
        let json = self.file.list("accessors").get(accessor).ok_or_else(missing)?;
        let components = match text_at(json, "type") {
            "SCALAR" => 1,
            "VEC2" => 2,
            "VEC3" => 3,
            "VEC4" | "MAT2" => 4,
            "MAT3" => 9,
            "MAT4" => 16,
            other => return Err(self.error(accessor, format!("has the unknown type \"{other}\""))),
        };
        let component_type = json.get("componentType").and_then(Value::as_u64).unwrap_or(0);
        if !matches!(component_type, 5120..=5123 | 5125 | 5126) {
            return Err(self.error(accessor, format!("has the unknown component type {component_type}")));
        }
        let count = index_at(json, "count").unwrap_or(0);
        if count == 0 {
            return Err(self.error(accessor, "has no elements"));
        }
        let mut layout = Layout {
            count,
            components,
            component_type,
            normalized: json.get("normalized").and_then(Value::as_bool).unwrap_or(false),
            start: None,
            stride: 0,
            sparse: json.get("sparse").is_some(),
        };
        let Some(view) = index_at(json, "bufferView") else {
            if count > self.file.binary.len() {
                let bytes = self.file.binary.len();
                return Err(self.error(
                    accessor,
                    format!("claims {count} elements without data, more than the file's {bytes} bytes"),
                ));
            }
            layout.stride = layout.element_size();
            return Ok(layout);
        };
        let offset = json.get("byteOffset").map_or(Some(0), |value| value.as_u64().map(|v| v as usize));
        let offset = offset.ok_or_else(|| self.error(accessor, "has a byteOffset that is not 0 or more"))?;
        let (start, stride) = self.span(accessor, view, offset, count, layout.element_size())?;
        layout.start = Some(start);
        layout.stride = stride;
        Ok(layout)
    }

    /// The first byte and the stride of `count` elements of `size` bytes in a buffer view.
    fn span(
        &self,
        accessor: usize,
        view: usize,
        offset: usize,
        count: usize,
        size: usize,
    ) -> Result<(usize, usize)> {
        let json =
            self.file.list("bufferViews").get(view).ok_or_else(|| {
                self.error(accessor, format!("lies in buffer view {view}, which is not there"))
            })?;
        let view_start = index_at(json, "byteOffset").unwrap_or(0);
        let view_length = index_at(json, "byteLength").unwrap_or(0);
        let stride = index_at(json, "byteStride").filter(|&stride| stride != 0).unwrap_or(size);
        if stride < size {
            return Err(self.error(accessor, format!("has elements of {size} bytes in steps of {stride}")));
        }
        let end = count
            .saturating_sub(1)
            .checked_mul(stride)
            .and_then(|last| last.checked_add(size))
            .and_then(|length| length.checked_add(offset))
            .filter(|&end| end <= view_length && view_start + view_length <= self.file.binary.len());
        match end {
            Some(_) => Ok((view_start + offset, stride)),
            None => Err(self.error(
                accessor,
                format!(
                    "needs {count} elements of {size} bytes from byte {offset} on, but buffer view {view} has {view_length} bytes"
                ),
            )),
        }
    }

    /// All numbers of an accessor, element after element; normalised whole numbers as fractions.
    ///
    /// - `components`: how many numbers an element must have.
    /// - `count`: how many elements there must be, where that is known.
    ///
    /// # Errors
    /// What [`Reader::layout`] says, another count or type, or more numbers than can be held.
    pub fn floats(&self, accessor: usize, components: usize, count: Option<usize>) -> Result<Vec<f32>> {
        let layout = self.checked(accessor, components, count)?;
        let mut numbers = vec![0.0; layout.count * components];
        let size = component_size(layout.component_type);
        if let Some(start) = layout.start {
            for (element, out) in numbers.chunks_exact_mut(components).enumerate() {
                for (component, number) in out.iter_mut().enumerate() {
                    *number = self.float(&layout, start + element * layout.stride + component * size);
                }
            }
        }
        self.replace(accessor, &layout, |element, at| {
            for component in 0..components {
                numbers[element * components + component] = self.float(&layout, at + component * size);
            }
        })?;
        Ok(numbers)
    }

    /// All numbers of an accessor of unsigned whole numbers (8, 16 or 32 bits).
    ///
    /// # Errors
    /// As [`Reader::floats`], and for other component types.
    pub fn integers(&self, accessor: usize, components: usize, count: Option<usize>) -> Result<Vec<u32>> {
        let layout = self.checked(accessor, components, count)?;
        if !matches!(layout.component_type, 5121 | 5123 | 5125) {
            return Err(self.error(accessor, "should hold unsigned whole numbers, but does not"));
        }
        let size = component_size(layout.component_type);
        let mut numbers = vec![0; layout.count * components];
        if let Some(start) = layout.start {
            for (element, out) in numbers.chunks_exact_mut(components).enumerate() {
                for (component, number) in out.iter_mut().enumerate() {
                    *number = self
                        .integer(layout.component_type, start + element * layout.stride + component * size);
                }
            }
        }
        self.replace(accessor, &layout, |element, at| {
            for component in 0..components {
                numbers[element * components + component] =
                    self.integer(layout.component_type, at + component * size);
            }
        })?;
        Ok(numbers)
    }

    fn checked(&self, accessor: usize, components: usize, count: Option<usize>) -> Result<Layout> {
        let layout = self.layout(accessor)?;
        if layout.components != components {
            return Err(self.error(
                accessor,
                format!("has {} numbers an element where {components} are needed", layout.components),
            ));
        }
        if let Some(count) = count.filter(|&count| count != layout.count) {
            return Err(
                self.error(accessor, format!("has {} elements where {count} are needed", layout.count))
            );
        }
        let bytes = (layout.count as u64).saturating_mul(4 * components as u64);
        let read = self.read.get().saturating_add(bytes);
        if read > LARGEST_READ {
            return Err(bad_input(format!(
                "{} would take more than 1 GB of vertices: leave out meshes or share them less often",
                self.file.name
            )));
        }
        self.read.set(read);
        Ok(layout)
    }

    /// Calls `put` with each element that the accessor's `sparse` part replaces, and where its new value stands.
    fn replace(&self, accessor: usize, layout: &Layout, mut put: impl FnMut(usize, usize)) -> Result<()> {
        if !layout.sparse {
            return Ok(());
        }
        let sparse = &self.file.list("accessors")[accessor]["sparse"];
        let (indices, values) = (&sparse["indices"], &sparse["values"]);
        let wrong = || self.error(accessor, "has a sparse part without indices and values");
        let count = index_at(sparse, "count").ok_or_else(wrong)?;
        if count == 0 {
            return Ok(());
        }
        let index_type = indices.get("componentType").and_then(Value::as_u64).unwrap_or(0);
        if !matches!(index_type, 5121 | 5123 | 5125) {
            return Err(self.error(accessor, format!("has sparse indices of component type {index_type}")));
        }
        let index_view = index_at(indices, "bufferView").ok_or_else(wrong)?;
        let value_view = index_at(values, "bufferView").ok_or_else(wrong)?;
        let index_offset = index_at(indices, "byteOffset").unwrap_or(0);
        let value_offset = index_at(values, "byteOffset").unwrap_or(0);
        let index_size = component_size(index_type);
        let value_size = layout.element_size();
        let (index_start, _) = self.span(accessor, index_view, index_offset, count, index_size)?;
        let (value_start, _) = self.span(accessor, value_view, value_offset, count, value_size)?;
        for entry in 0..count {
            let element = self.integer(index_type, index_start + entry * index_size) as usize;
            if element >= layout.count {
                return Err(self.error(
                    accessor,
                    format!("replaces element {element}, but has {} elements", layout.count),
                ));
            }
            put(element, value_start + entry * value_size);
        }
        Ok(())
    }

    // `span` has checked that `at` and what follows lie in the binary.
    fn integer(&self, component_type: u64, at: usize) -> u32 {
        let bytes = &self.file.binary;
        match component_type {
            5121 => u32::from(bytes[at]),
            5123 => u32::from(u16::from_le_bytes([bytes[at], bytes[at + 1]])),
            _ => u32::from_le_bytes([bytes[at], bytes[at + 1], bytes[at + 2], bytes[at + 3]]),
        }
    }

    fn float(&self, layout: &Layout, at: usize) -> f32 {
        let bytes = &self.file.binary;
        let signed = |value: f32, largest: f32| {
            if layout.normalized { (value / largest).max(-1.0) } else { value }
        };
        match layout.component_type {
            5120 => signed(f32::from(bytes[at] as i8), 127.0),
            5121 => signed(f32::from(bytes[at]), 255.0),
            5122 => signed(f32::from(i16::from_le_bytes([bytes[at], bytes[at + 1]])), 32767.0),
            5123 => signed(f32::from(u16::from_le_bytes([bytes[at], bytes[at + 1]])), 65535.0),
            5125 => self.integer(5125, at) as f32,
            _ => f32::from_bits(self.integer(5126, at)),
        }
    }
}
