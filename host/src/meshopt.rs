//! Buffer views that are compressed (EXT_meshopt_compression, KHR_meshopt_compression) become plain ones.
//!
//! The decoder is meshoptimizer's own, in C++: the only unsafe code here. It is safe for data that nobody trusts as long as the
//! sizes are right, which is checked before.

use crate::{array_at, bad_input, index_at, text_at};
use ::meshopt::ffi;
use serde_json::{Value, json};
use superdeform::Result;

const EXTENSIONS: [&str; 2] = ["EXT_meshopt_compression", "KHR_meshopt_compression"];
/// As much as a file may have in all.
const MOST_BYTES: usize = 1 << 31;

/// What a buffer view says of its compression.
struct Compressed<'a> {
    data: &'a [u8],
    count: usize,
    stride: usize,
    mode: &'a str,
    filter: &'a str,
}

impl Compressed<'_> {
    /// The view's bytes; `None` where they are damaged or no decoder would take them.
    fn decoded(&self) -> Option<Vec<u8>> {
        let Self { data, count, stride, mode, filter } = *self;
        let is_stride = match mode {
            "ATTRIBUTES" => stride > 0 && stride <= 256 && stride.is_multiple_of(4),
            "TRIANGLES" => (stride == 2 || stride == 4) && count.is_multiple_of(3),
            "INDICES" => stride == 2 || stride == 4,
            _ => false,
        };
        let is_filter = match filter {
            "" | "NONE" => true,
            _ if mode != "ATTRIBUTES" => false,
            "OCTAHEDRAL" | "COLOR" => stride == 4 || stride == 8,
            "QUATERNION" => stride == 8,
            "EXPONENTIAL" => true,
            _ => false,
        };
        let size = count.checked_mul(stride).filter(|&size| size <= MOST_BYTES)?;
        if !is_stride || !is_filter {
            return None;
        }
        // In words, so that the decoder finds them aligned.
        let mut words: Vec<u32> = Vec::new();
        words.try_reserve_exact(size.div_ceil(4)).ok()?;
        words.resize(size.div_ceil(4), 0);
        if count > 0 {
            decode(&mut words, data, count, stride, mode, filter)?;
        }
        let mut bytes: Vec<u8> = Vec::new();
        bytes.try_reserve_exact(4 * words.len()).ok()?;
        bytes.extend(words.iter().flat_map(|word| word.to_ne_bytes()));
        bytes.truncate(size);
        Some(bytes)
    }
}

/// Decodes into `words`, which hold `count` elements of `stride` bytes.
#[allow(unsafe_code)]
fn decode(
    words: &mut [u32],
    data: &[u8],
    count: usize,
    stride: usize,
    mode: &str,
    filter: &str,
) -> Option<()> {
    let to = words.as_mut_ptr().cast();
    // SAFETY: `to` has room for `count` times `stride` bytes and is aligned to four; strides and counts are those that the
    // decoder asks for; it reads no further than `data`.
    let status = unsafe {
        match mode {
            "ATTRIBUTES" => ffi::meshopt_decodeVertexBuffer(to, count, stride, data.as_ptr(), data.len()),
            "TRIANGLES" => ffi::meshopt_decodeIndexBuffer(to, count, stride, data.as_ptr(), data.len()),
            _ => ffi::meshopt_decodeIndexSequence(to, count, stride, data.as_ptr(), data.len()),
        }
    };
    // SAFETY: as above; a filter works in place.
    unsafe {
        match filter {
            "OCTAHEDRAL" => ffi::meshopt_decodeFilterOct(to, count, stride),
            "QUATERNION" => ffi::meshopt_decodeFilterQuat(to, count, stride),
            "EXPONENTIAL" => ffi::meshopt_decodeFilterExp(to, count, stride),
            "COLOR" => ffi::meshopt_decodeFilterColor(to, count, stride),
            _ => {}
        }
    }
    (status == 0).then_some(())
}

/// The extension that compresses `view`.
fn compression(view: &Value) -> Option<(&'static str, &Value)> {
    EXTENSIONS.into_iter().find_map(|name| Some((name, view["extensions"].get(name)?)))
}

/// Unpacks all compressed buffer views of a GLB whose binary chunk is `chunk`; gives the new chunk, `None` where nothing is
/// compressed.
///
/// # Errors
/// One sentence with the view: damaged data, or data outside of the binary chunk.
pub fn unpack(name: &str, json: &mut Value, chunk: &[u8]) -> Result<Option<Vec<u8>>> {
    let views = array_at(json, "bufferViews").to_vec();
    if views.iter().all(|view| compression(view).is_none()) {
        return Ok(None);
    }
    let mut binary: Vec<u8> = Vec::new();
    for (index, view) in views.iter().enumerate() {
        let damaged = |what: &str| {
            bad_input(format!(
                "{name}: buffer view {index} is compressed and {what}: export or download the file anew"
            ))
        };
        let slice = |holder: &Value| -> Option<&[u8]> {
            let start = index_at(holder, "byteOffset").unwrap_or(0);
            let end = start.checked_add(index_at(holder, "byteLength")?)?;
            if index_at(holder, "buffer")? == 0 { chunk.get(start..end) } else { None }
        };
        let compressed = compression(view);
        let decoded;
        let bytes = match compressed {
            Some((_, held)) => {
                let data =
                    slice(held).ok_or_else(|| damaged("its data is not in the file's binary chunk"))?;
                let number = |key: &str| index_at(held, key).unwrap_or(0);
                let (count, stride) = (number("count"), number("byteStride"));
                let (mode, filter) = (text_at(held, "mode"), text_at(held, "filter"));
                let whole = Compressed { data, count, stride, mode, filter };
                decoded = whole.decoded().ok_or_else(|| damaged("damaged"))?;
                &decoded
            }
            // What lies in another buffer stays there.
            None if index_at(view, "buffer") != Some(0) => continue,
            None => slice(view).ok_or_else(|| damaged("reaches beyond the binary chunk"))?,
        };
        binary.resize(binary.len().next_multiple_of(8), 0);
        if binary.len() + bytes.len() > MOST_BYTES {
            return Err(damaged("would have 2 GB and more"));
        }
        let view = &mut json["bufferViews"][index];
        view["buffer"] = json!(0);
        view["byteOffset"] = json!(binary.len());
        view["byteLength"] = json!(bytes.len());
        if let (Some((extension, _)), Some(held)) = (compressed, view["extensions"].as_object_mut()) {
            held.remove(extension);
            if held.is_empty()
                && let Some(view) = view.as_object_mut()
            {
                view.remove("extensions");
            }
        }
        binary.extend_from_slice(bytes);
    }
    drop_fallbacks(json);
    json["buffers"][0]["byteLength"] = json!(binary.len());
    for list in ["extensionsUsed", "extensionsRequired"] {
        let Some(names) = json.get_mut(list).and_then(Value::as_array_mut) else { continue };
        names.retain(|name| !EXTENSIONS.iter().any(|extension| name == extension));
        if names.is_empty()
            && let Some(json) = json.as_object_mut()
        {
            json.remove(list);
        }
    }
    Ok(Some(binary))
}

/// Leaves out buffers that only stood for what is unpacked now.
fn drop_fallbacks(json: &mut Value) {
    let buffers = array_at(json, "buffers").to_vec();
    let views = array_at(json, "bufferViews").to_vec();
    let is_used = |index: usize| {
        index == 0
            || buffers[index].get("uri").is_some()
            || views.iter().any(|view| index_at(view, "buffer") == Some(index))
    };
    let kept: Vec<usize> = (0..buffers.len()).filter(|&index| is_used(index)).collect();
    json["buffers"] = kept.iter().map(|&index| buffers[index].clone()).collect();
    for (index, view) in views.iter().enumerate() {
        let buffer = index_at(view, "buffer").and_then(|buffer| kept.iter().position(|&old| old == buffer));
        if let Some(buffer) = buffer {
            json["bufferViews"][index]["buffer"] = json!(buffer);
        }
    }
}

#[cfg(test)]
#[allow(unsafe_code)]
mod tests {
    use super::*;
    use crate::file::GltfFile;
    use crate::samples;

    /// The file with all its vertex data and indices compressed by meshoptimizer.
    fn packed(file: &GltfFile) -> GltfFile {
        let mut packed = file.clone();
        packed.binary.clear();
        let accessors = file.list("accessors");
        let of_view =
            |view: usize| accessors.iter().find(|accessor| index_at(accessor, "bufferView") == Some(view));
        for (index, view) in file.list("bufferViews").iter().enumerate() {
            let start = index_at(view, "byteOffset").unwrap_or(0);
            let bytes = &file.binary[start..start + index_at(view, "byteLength").unwrap()];
            let target = view["target"].as_u64();
            let stride = match (target, of_view(index).map(|accessor| text_at(accessor, "type"))) {
                (Some(34962), Some("VEC3")) => 12,
                (Some(34962), Some("VEC2")) => 8,
                _ => 0,
            };
            let count = if stride > 0 { bytes.len() / stride } else { 0 };
            let held = &mut packed.json["bufferViews"][index];
            packed.binary.resize(packed.binary.len().next_multiple_of(8), 0);
            let at = packed.binary.len();
            if stride == 0 || count * stride != bytes.len() {
                held["byteOffset"] = json!(at);
                packed.binary.extend_from_slice(bytes);
                continue;
            }
            let mut room = vec![0u8; unsafe { ffi::meshopt_encodeVertexBufferBound(count, stride) }];
            let length = unsafe {
                ffi::meshopt_encodeVertexBuffer(
                    room.as_mut_ptr(),
                    room.len(),
                    bytes.as_ptr().cast(),
                    count,
                    stride,
                )
            };
            packed.binary.extend_from_slice(&room[..length]);
            held["buffer"] = json!(1);
            held["extensions"]["EXT_meshopt_compression"] = json!({
                "buffer": 0, "byteOffset": at, "byteLength": length, "byteStride": stride, "count": count, "mode": "ATTRIBUTES",
            });
        }
        let fallback = json!({"byteLength": file.binary.len(), "extensions": {"EXT_meshopt_compression": {"fallback": true}}});
        packed.json["buffers"] = json!([{"byteLength": packed.binary.len()}, fallback]);
        packed.json["extensionsUsed"] = json!(["EXT_meshopt_compression"]);
        packed.json["extensionsRequired"] = json!(["EXT_meshopt_compression"]);
        packed
    }

    #[test]
    fn what_meshoptimizer_packed_is_unpacked_bit_for_bit() {
        let file = GltfFile::read(&samples::data().join("quaternius_female_dress.glb")).unwrap();
        let packed = packed(&file);
        assert!(packed.binary.len() < file.binary.len(), "nothing was packed");
        let again = GltfFile::parse("packed.glb", &packed.to_bytes().unwrap()).unwrap();
        assert_eq!(again.json.get("extensionsRequired"), None);
        assert_eq!(again.list("buffers").len(), 1);
        let bytes = |file: &GltfFile, view: &Value| -> Vec<u8> {
            let start = index_at(view, "byteOffset").unwrap_or(0);
            file.binary[start..start + index_at(view, "byteLength").unwrap()].to_vec()
        };
        for (one, other) in file.list("bufferViews").iter().zip(again.list("bufferViews")) {
            assert_eq!(bytes(&file, one), bytes(&again, other));
        }
    }

    #[test]
    fn damaged_data_is_refused_and_no_count_is_taken_on_trust() {
        let file = GltfFile::read(&samples::data().join("quaternius_female_dress.glb")).unwrap();
        let packed = packed(&file);
        let view = packed.list("bufferViews").iter().position(|view| compression(view).is_some()).unwrap();
        for (key, value) in [
            ("count", json!(1u64 << 40)),
            ("count", json!(3)),
            ("byteStride", json!(7)),
            ("byteStride", json!(0)),
            ("byteLength", json!(5)),
            ("byteOffset", json!(u64::MAX)),
            ("buffer", json!(1)),
            ("mode", json!("TRIANGLES")),
            ("mode", json!("OTHER")),
            ("filter", json!("QUATERNION")),
        ] {
            let mut damaged = packed.clone();
            damaged.json["bufferViews"][view]["extensions"]["EXT_meshopt_compression"][key] = value.clone();
            let error = GltfFile::parse("damaged.glb", &damaged.to_bytes().unwrap()).unwrap_err();
            assert!(
                error.message.contains(&format!("buffer view {view}")),
                "{key} {value}: {}",
                error.message
            );
        }
    }
}
