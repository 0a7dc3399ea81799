//! glTF files: raw JSON and one buffer, from GLB, VRM or `.gltf` with what lies beside it, to GLB or `.gltf` again.
//!
//! The `gltf` crate has a typed tree for this, which is used to check a file and for nothing else. A round trip through it
//! would lose what it does not know: extensions such as VRM's, members that glTF does not define, the spelling of numbers,
//! the difference between a member that is absent and one that has its default. What is not reshaped must come out as it
//! went in, so the JSON is kept raw and changed in place; and since every number is written back over the one that was
//! read, accessors are read here by the layout that the writer needs too (`accessor.rs`).

use super::beside::{self, Beside};
use super::{array_at, bad_input, index_at, text_at};
use gltf::json::validation::Validate;
use serde_json::{Value, json};
use std::borrow::Cow;
use std::collections::BTreeMap;
use std::fs;
use std::io::Write;
use std::path::Path;
use std::sync::Arc;
use superdeform::Result;

const MAGIC: &[u8; 4] = b"glTF";
const CHUNK_JSON: u32 = u32::from_le_bytes(*b"JSON");
const CHUNK_BIN: u32 = u32::from_le_bytes(*b"BIN\0");

/// Files of this size and above are refused, in bytes; a GLB holds its length in 32 bits.
const LARGEST_FILE: u64 = 1 << 31;

/// Extensions that may be required of a reader which does not touch what they are about.
const HARMLESS_PREFIXES: [&str; 4] = ["KHR_materials_", "VRM", "KHR_texture_", "EXT_texture_"];
const HARMLESS: [&str; 7] = [
    "KHR_mesh_quantization",
    "KHR_lights_punctual",
    "KHR_node_visibility",
    "KHR_xmp_json_ld",
    "MSFT_texture_dds",
    "EXT_lights_image_based",
    "MSFT_packing_occlusionRoughnessMetallic",
];

/// A glTF file with everything that it names.
#[derive(Clone, Debug, Default)]
pub struct GltfFile {
    /// The file's name, for messages.
    pub name: String,
    /// The JSON as it stands in the file, but for its buffers, which are one.
    pub json: Value,
    /// The one buffer.
    pub binary: Vec<u8>,
    /// The images that lie beside the file, by their address as the JSON spells it.
    pub images: BTreeMap<String, Arc<Vec<u8>>>,
}

impl GltfFile {
    /// Reads a GLB, a VRM, or a `.gltf` with the buffers and images beside it.
    ///
    /// # Errors
    /// One sentence that begins with the file's name: not readable, not glTF 2.0, damaged, a buffer is not there, or an
    /// extension is required that compresses the geometry.
    pub fn read(path: &Path) -> Result<Self> {
        let (name, bytes) = Self::read_bytes(path)?;
        Self::parse_with(&name, &bytes, &beside::folder_of(path))
    }

    /// The name of the file at `path`, and its bytes.
    ///
    /// # Errors
    /// One sentence that begins with the name: not readable, a folder, 2 GB or more.
    pub fn read_bytes(path: &Path) -> Result<(String, Vec<u8>)> {
        let name = path
            .file_name()
            .map_or_else(|| path.display().to_string(), |name| name.to_string_lossy().into_owned());
        let about =
            fs::metadata(path).map_err(|error| bad_input(format!("{name} cannot be read: {error}")))?;
        if about.is_dir() {
            return Err(bad_input(format!("{name} is a folder: give a GLB or VRM file")));
        }
        if about.len() >= LARGEST_FILE {
            return Err(bad_input(format!("{name} has {} bytes: files must be below 2 GB", about.len())));
        }
        let bytes = fs::read(path).map_err(|error| bad_input(format!("{name} cannot be read: {error}")))?;
        Ok((name, bytes))
    }

    /// The same from memory, of a file that has everything within; `name` is for messages.
    ///
    /// # Errors
    /// As [`GltfFile::read`].
    pub fn parse(name: &str, bytes: &[u8]) -> Result<Self> {
        Self::parse_with(name, bytes, &|_| None)
    }

    /// The same of a file that names others, which `beside` gives.
    ///
    /// # Errors
    /// As [`GltfFile::read`].
    pub fn parse_with(name: &str, bytes: &[u8], beside: &Beside) -> Result<Self> {
        if bytes.is_empty() {
            return Err(bad_input(format!("{name} is empty: give a GLB or VRM file")));
        }
        let (text, binary) = if bytes.starts_with(MAGIC) {
            split_container(name, bytes)?
        } else if bytes.iter().find(|byte| !byte.is_ascii_whitespace()) == Some(&b'{') {
            (bytes, &[][..])
        } else {
            return Err(bad_input(format!(
                "{name} is neither GLB nor VRM, because it does not begin with glTF: export it as glTF 2.0 (Blender: File, Export, glTF)"
            )));
        };
        #[cfg_attr(not(feature = "meshopt"), allow(unused_mut))]
        let mut json: Value = serde_json::from_slice(text).map_err(|error| {
            bad_input(format!("{name} holds JSON that cannot be read, {error}: export it anew"))
        })?;
        if !json.is_object() {
            return Err(bad_input(format!(
                "{name} holds JSON that is no object: export it anew as glTF 2.0"
            )));
        }
        let version = text_at(&json["asset"], "version");
        if !version.starts_with("2.") {
            return Err(bad_input(format!(
                "{name} says it is glTF version \"{version}\": only version 2.0 can be read, so export it anew"
            )));
        }
        #[cfg(feature = "meshopt")]
        let unpacked = crate::meshopt::unpack(name, &mut json, binary)?;
        #[cfg(feature = "meshopt")]
        let binary = unpacked.as_deref().unwrap_or(binary);
        check_extensions(name, &json)?;
        check_types_and_indices(name, &json)?;
        let mut file = Self { name: name.to_string(), json, ..Self::default() };
        file.binary = file.embed_buffers(binary, beside)?;
        let addresses = array_at(&file.json, "images").iter().map(|image| text_at(image, "uri"));
        let found = addresses
            .filter_map(|address| Some((address.to_string(), Arc::new(beside(&beside::path_of(address)?)?))));
        file.images = found.collect();
        Ok(file)
    }

    /// Takes all buffers together into one, and moves the buffer views along.
    fn embed_buffers(&mut self, chunk: &[u8], beside: &Beside) -> Result<Vec<u8>> {
        let name = self.name.clone();
        let buffers = array_at(&self.json, "buffers").to_vec();
        let mut binary = Vec::new();
        let mut starts = Vec::new();
        for (index, buffer) in buffers.iter().enumerate() {
            let uri = buffer.get("uri").and_then(Value::as_str);
            let decoded;
            let data: &[u8] = match uri {
                None if index == 0 => chunk,
                None => {
                    return Err(bad_input(format!(
                        "{name}: buffer {index} has no data, because only buffer 0 may stand for the binary chunk: export the file anew"
                    )));
                }
                Some(uri) if uri.starts_with("data:") => {
                    decoded = beside::decode_base64(uri).ok_or_else(|| {
                        bad_input(format!(
                            "{name}: buffer {index} holds no valid base64: export the file anew"
                        ))
                    })?;
                    &decoded
                }
                Some(uri) => {
                    decoded = beside::path_of(uri).and_then(|path| beside(&path)).ok_or_else(|| {
                        let uri: String = uri.chars().take(80).collect();
                        bad_input(format!(
                            "{name} keeps its buffer {index} in another file ({uri}), which was not found beside it: give the two together, or export a GLB"
                        ))
                    })?;
                    &decoded
                }
            };
            let length = index_at(buffer, "byteLength").unwrap_or(0);
            if length > data.len() {
                return Err(bad_input(format!(
                    "{name}: buffer {index} should have {length} bytes, but {} are there: the file is cut short, so export or download it anew",
                    data.len()
                )));
            }
            binary.resize(binary.len().next_multiple_of(8), 0);
            starts.push(binary.len());
            // A chunk is padded to four bytes; what stands behind the buffer is no part of it.
            binary.extend_from_slice(&data[..length]);
        }
        let view_count = array_at(&self.json, "bufferViews").len();
        for index in 0..view_count {
            let view = &mut self.json["bufferViews"][index];
            let buffer = index_at(view, "buffer").unwrap_or(0);
            let offset = index_at(view, "byteOffset").unwrap_or(0);
            let length = index_at(view, "byteLength").unwrap_or(0);
            let size = buffers.get(buffer).and_then(|buffer| index_at(buffer, "byteLength"));
            let fits = offset.checked_add(length).is_some_and(|end| size.is_some_and(|size| end <= size));
            if !fits {
                return Err(bad_input(format!(
                    "{name}: buffer view {index} covers {length} bytes from byte {offset}, but buffer {buffer} has {} bytes: export the file anew",
                    size.unwrap_or(0)
                )));
            }
            if buffers.len() > 1 {
                view["buffer"] = json!(0);
                view["byteOffset"] = json!(starts[buffer] + offset);
            }
        }
        if buffers.len() > 1 || buffers.iter().any(|buffer| buffer.get("uri").is_some()) {
            let mut first = buffers[0].clone();
            first.as_object_mut().map(|buffer| buffer.remove("uri"));
            first["byteLength"] = json!(binary.len());
            self.json["buffers"] = json!([first]);
        }
        Ok(binary)
    }

    /// The file as GLB, with the images from beside it.
    ///
    /// # Errors
    /// When it would be 2 GB or more.
    pub fn to_bytes(&self) -> Result<Vec<u8>> {
        if !self.images.is_empty() {
            return self.with_images_within().to_bytes();
        }
        let mut text = self.text(serde_json::to_vec)?;
        text.resize(text.len().next_multiple_of(4), b' ');
        let padded = self.binary.len().next_multiple_of(4);
        let total = 12 + 8 + text.len() + if self.binary.is_empty() { 0 } else { 8 + padded };
        if total as u64 >= LARGEST_FILE {
            return Err(bad_input(format!(
                "{} would have {total} bytes: a GLB must be below 2 GB",
                self.name
            )));
        }
        let mut bytes = Vec::with_capacity(total);
        bytes.extend_from_slice(MAGIC);
        for number in [2, total as u32, text.len() as u32, CHUNK_JSON] {
            bytes.extend_from_slice(&number.to_le_bytes());
        }
        bytes.extend_from_slice(&text);
        if !self.binary.is_empty() {
            for number in [padded as u32, CHUNK_BIN] {
                bytes.extend_from_slice(&number.to_le_bytes());
            }
            bytes.extend_from_slice(&self.binary);
            bytes.resize(total, 0);
        }
        Ok(bytes)
    }

    fn text(&self, write: impl Fn(&Value) -> serde_json::Result<Vec<u8>>) -> Result<Vec<u8>> {
        write(&self.json)
            .map_err(|error| bad_input(format!("{} cannot be written as JSON: {error}", self.name)))
    }

    /// The file with the images from beside it in its buffer.
    fn with_images_within(&self) -> Self {
        let mut file = self.clone();
        let images = std::mem::take(&mut file.images);
        for index in 0..file.list("images").len() {
            let Some(bytes) = images.get(text_at(&file.json["images"][index], "uri")) else { continue };
            file.binary.resize(file.binary.len().next_multiple_of(4), 0);
            let view = json!({"buffer": 0, "byteOffset": file.binary.len(), "byteLength": bytes.len()});
            file.binary.extend_from_slice(bytes);
            if !file.json["bufferViews"].is_array() {
                file.json["bufferViews"] = json!([]);
            }
            if file.list("buffers").is_empty() {
                file.json["buffers"] = json!([{}]);
            }
            file.json["buffers"][0]["byteLength"] = json!(file.binary.len());
            let Some(views) = file.json["bufferViews"].as_array_mut() else { continue };
            views.push(view);
            let view = views.len() - 1;
            let image = &mut file.json["images"][index];
            let kind = beside::kind_of_image(bytes, text_at(image, "mimeType")).to_string();
            image["bufferView"] = json!(view);
            image["mimeType"] = json!(kind);
            image.as_object_mut().map(|image| image.remove("uri"));
        }
        file
    }

    /// The file as `.gltf`: its JSON, its buffer as `NAME.bin` and its images, each with its path beside the JSON.
    ///
    /// - `name`: the file's own, `hero.gltf` for instance.
    ///
    /// # Errors
    /// As [`GltfFile::to_bytes`].
    pub fn to_parts(&self, name: &str) -> Result<Vec<(String, Vec<u8>)>> {
        let stem = name.rsplit_once('.').map_or(name, |(stem, _)| stem);
        let binary = format!("{stem}.bin");
        let mut file = Self { json: self.json.clone(), name: self.name.clone(), ..Self::default() };
        if !self.binary.is_empty() {
            file.json["buffers"][0]["uri"] = json!(beside::address_of(&binary));
        }
        let mut text = file.text(serde_json::to_vec_pretty)?;
        text.push(b'\n');
        let mut parts = vec![(name.to_string(), text)];
        if !self.binary.is_empty() {
            parts.push((binary, self.binary.clone()));
        }
        for (address, bytes) in &self.images {
            parts.extend(beside::path_of(address).map(|path| (path, bytes.to_vec())));
        }
        Ok(parts)
    }

    /// The bytes of an image, wherever they are; `None` where they are not.
    pub fn image(&self, index: usize) -> Option<Cow<'_, [u8]>> {
        let image = self.list("images").get(index)?;
        if let Some(view) = index_at(image, "bufferView") {
            let view = self.list("bufferViews").get(view)?;
            let start = index_at(view, "byteOffset").unwrap_or(0);
            let end = start.checked_add(index_at(view, "byteLength")?)?;
            return self.binary.get(start..end).map(Cow::Borrowed);
        }
        let address = text_at(image, "uri");
        match self.images.get(address) {
            Some(bytes) => Some(Cow::Borrowed(bytes.as_slice())),
            None => beside::decode_base64(address).map(Cow::Owned),
        }
    }

    /// The array of the JSON called `name`; empty where there is none.
    pub fn list(&self, name: &str) -> &[Value] {
        array_at(&self.json, name)
    }
}

/// Writes a file whole or not at all: beside its place first, then renamed.
///
/// # Errors
/// One sentence with the path; nothing is left behind.
pub fn write_atomically(path: &Path, bytes: &[u8]) -> Result<()> {
    let failed = |error: std::io::Error| bad_input(format!("{} cannot be written: {error}", path.display()));
    let Some(name) = path.file_name().filter(|_| !path.is_dir()) else {
        return Err(bad_input(format!("{} is a folder: give the name of a file", path.display())));
    };
    let mut beside = std::ffi::OsString::from(".");
    beside.push(name);
    beside.push(format!(".{}.part", std::process::id()));
    let beside = path.with_file_name(beside);
    let written = fs::File::create(&beside)
        .and_then(|mut file| file.write_all(bytes).and_then(|()| file.sync_all()))
        .and_then(|()| fs::rename(&beside, path));
    written.map_err(|error| {
        // What went wrong is the error above; a left-over that cannot be removed adds nothing to it.
        let _ = fs::remove_file(&beside);
        failed(error)
    })
}

/// The JSON and the binary chunk of a GLB.
fn split_container<'a>(name: &str, bytes: &'a [u8]) -> Result<(&'a [u8], &'a [u8])> {
    let number = |at: usize| {
        let bytes = bytes.get(at..at.checked_add(4)?)?;
        Some(u32::from_le_bytes(bytes.try_into().ok()?))
    };
    let cut =
        || bad_input(format!("{name} is cut short after {} bytes: export or download it anew", bytes.len()));
    let version = number(4).ok_or_else(cut)?;
    if version != 2 {
        return Err(bad_input(format!(
            "{name} is a GLB of version {version}: only version 2 can be read, so export it anew"
        )));
    }
    let length = number(8).ok_or_else(cut)? as usize;
    if length > bytes.len() {
        return Err(bad_input(format!(
            "{name} should have {length} bytes, but has {}: it is cut short, so export or download it anew",
            bytes.len()
        )));
    }
    let mut text = None;
    let mut binary = None;
    let mut at = 12;
    while at + 8 <= length {
        let size = number(at).ok_or_else(cut)? as usize;
        let kind = number(at + 4).ok_or_else(cut)?;
        let end = (at + 8).checked_add(size).filter(|&end| end <= length).ok_or_else(|| {
            bad_input(format!(
                "{name}: a chunk of {size} bytes at byte {at} runs past the end of the file at byte {length}: export or download it anew"
            ))
        })?;
        let data = &bytes[at + 8..end];
        match kind {
            CHUNK_JSON if text.is_none() => text = Some(data),
            CHUNK_BIN if binary.is_none() => binary = Some(data),
            _ => {}
        }
        at = end;
    }
    let text =
        text.ok_or_else(|| bad_input(format!("{name} holds no JSON chunk: export or download it anew")))?;
    Ok((text, binary.unwrap_or(&[])))
}

/// What to do with a file that is compressed with `extension`.
fn remedy(extension: &str) -> &'static str {
    if extension == "KHR_draco_mesh_compression" {
        "export it without compression, or unpack it first (gltf-transform copy, Blender)"
    } else {
        "export it without compression, unpack it first (gltf-transform copy), or use a build with the feature meshopt"
    }
}

/// Refuses what is required and cannot be honoured.
fn check_extensions(name: &str, json: &Value) -> Result<()> {
    let compressed = |extension: &str| {
        matches!(
            extension,
            "EXT_meshopt_compression" | "KHR_meshopt_compression" | "KHR_draco_mesh_compression"
        )
    };
    for extension in array_at(json, "extensionsRequired").iter().filter_map(Value::as_str) {
        if compressed(extension) {
            return Err(bad_input(format!("{name} is compressed with {extension}: {}", remedy(extension))));
        }
        let harmless = HARMLESS.contains(&extension)
            || HARMLESS_PREFIXES.iter().any(|prefix| extension.starts_with(prefix));
        if !harmless {
            return Err(bad_input(format!(
                "{name} requires the extension {extension}, which is not known here: export it without this extension"
            )));
        }
    }
    // Compression may also stand beside an uncompressed fallback; then the two would no longer agree.
    let in_views = array_at(json, "bufferViews").iter();
    let in_primitives = array_at(json, "meshes").iter().flat_map(|mesh| array_at(mesh, "primitives"));
    for holder in in_views.chain(in_primitives) {
        let extensions = holder.get("extensions").and_then(Value::as_object);
        if let Some(extension) = extensions.and_then(|held| held.keys().find(|key| compressed(key))) {
            return Err(bad_input(format!("{name} is compressed with {extension}: {}", remedy(extension))));
        }
    }
    Ok(())
}

/// Reads the JSON by the glTF schema, and checks that every index leads somewhere.
fn check_types_and_indices(name: &str, json: &Value) -> Result<()> {
    // The reader takes this one index on trust.
    let accessor_count = array_at(json, "accessors").len();
    for (mesh, mesh_json) in array_at(json, "meshes").iter().enumerate() {
        for primitive in array_at(mesh_json, "primitives") {
            let accessor = index_at(&primitive["attributes"], "POSITION").unwrap_or(0);
            if accessor > 0 && accessor >= accessor_count || accessor_count == 0 {
                return Err(bad_input(format!(
                    "{name}: mesh {mesh} has its positions in accessor {accessor}, but there are {accessor_count} accessors: export the file anew"
                )));
            }
        }
    }
    let root: gltf::json::Root = serde_json::from_value(filled(json))
        .map_err(|error| bad_input(format!("{name} departs from glTF 2.0, {error}: export it anew")))?;
    let mut astray = None;
    // Other findings (a missing minimum, an unknown word) do not keep the geometry from being read.
    root.validate(&root, gltf::json::Path::new, &mut |path: &dyn Fn() -> gltf::json::Path, error| {
        if matches!(error, gltf::json::validation::Error::IndexOutOfBounds) && astray.is_none() {
            astray = Some(path().to_string());
        }
    });
    match astray {
        Some(place) => Err(bad_input(format!(
            "{name}: {place} names something that the file does not have: export it anew"
        ))),
        None => Ok(()),
    }
}

/// The JSON with what the specification lets be absent and the reader does not, for the check alone: the source of a
/// texture whose picture is named by an extension, the nodes of an empty scene, and the node of an animation channel,
/// which without one moves nothing or is an extension's.
fn filled(json: &Value) -> Value {
    let mut filled = json.clone();
    let fill = |holder: Option<&mut Value>, key: &str, value: Value| {
        if let Some(holder) = holder.and_then(Value::as_object_mut) {
            holder.entry(key).or_insert(value);
        }
    };
    for texture in array_at_mut(&mut filled, "textures") {
        fill(Some(texture), "source", json!(0));
    }
    for scene in array_at_mut(&mut filled, "scenes") {
        fill(Some(scene), "nodes", json!([]));
    }
    for animation in array_at_mut(&mut filled, "animations") {
        for channel in array_at_mut(animation, "channels") {
            fill(channel.get_mut("target"), "node", json!(0));
        }
    }
    filled
}

/// The entries of the array at `key`; none where there is none.
fn array_at_mut<'a>(value: &'a mut Value, key: &str) -> impl Iterator<Item = &'a mut Value> + use<'a> {
    value.get_mut(key).and_then(Value::as_array_mut).into_iter().flatten()
}
