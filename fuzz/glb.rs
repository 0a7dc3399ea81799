//! Bytes go through the example's loader, and what loads through the deformer and its writer.

use glam::DVec3;
use serde_json::{Map, Value, json};
use std::sync::Arc;
use superdeform::{
    Deformed, DeformedMesh, Deformer, Options, Rig, RigOptions, Style, WeightMethod, find_roles,
};
use superdeform_host::file::GltfFile;
use superdeform_host::load::LoadOptions;

/// Characters larger than this are loaded and written, but not deformed: that takes long.
const MOST_VERTICES: usize = 600;

pub fn run(data: &[u8]) {
    let Ok(file) = GltfFile::parse("fuzz.glb", data) else { return };
    let choice = data.last().copied().unwrap_or(0);
    let options = LoadOptions {
        find_roles: Some(&find_roles),
        without_rig: choice & 1 != 0,
        incomplete_rig: choice & 2 != 0,
        ..LoadOptions::default()
    };
    let Ok(loaded) = superdeform_host::load::load(file, &options) else { return };
    let character = &loaded.character;
    let same = Deformed {
        meshes: character
            .meshes
            .iter()
            .map(|mesh| DeformedMesh {
                positions: mesh.positions.clone(),
                normals: mesh.normals.clone(),
                tangents: mesh.tangents.clone(),
                morph_targets: mesh.morph_targets.clone(),
            })
            .collect(),
        joints: character.skeleton.joints.iter().map(|joint| joint.position()).collect(),
    };
    let stays =
        |_: usize, point: DVec3| superdeform::Mapped { position: point, jacobian: glam::DMat3::IDENTITY };
    if let Ok(written) = superdeform_host::write::write(&loaded, &same, &stays) {
        let again = GltfFile::parse("fuzz.glb", &written).expect("what was written can be read");
        let _ = superdeform_host::load::load(again, &options);
    }
    // Deforming takes long beside reading and writing.
    if character.vertex_count() > MOST_VERTICES || choice & 0xf8 != 0 {
        return;
    }
    let style = Style::heads(2.5).unwrap();
    let options = Options { thread_count: 1, rays: Some(3), ..Options::default() };
    if character.humanoid.missing().is_empty() {
        let Ok(deformer) = Deformer::new(Arc::new(character.clone()), &style, &options) else { return };
        let map = |joint: usize, point: DVec3| deformer.map(joint, point);
        let _ = superdeform_host::write::write(&loaded, &deformer.apply(), &map);
        return;
    }
    let rig_options = RigOptions {
        method: WeightMethod::Volume,
        voxel_resolution: 16,
        thread_count: 1,
        fingers: false,
        ..RigOptions::default()
    };
    let Ok(rig) = Rig::of(character, &rig_options) else { return };
    let limited: Vec<_> =
        rig.skin_weights.iter().map(|weights| weights.limited(superdeform_host::rig::INFLUENCES)).collect();
    if let Ok(file) = superdeform_host::rig::rerigged(&loaded, &rig.skeleton, &limited) {
        let bytes = file.to_bytes().expect("what was rigged can be written");
        GltfFile::parse("fuzz.glb", &bytes).expect("what was rigged can be read");
    }
}

/// JSON and binary chunk of a GLB, whatever its sizes say.
fn split(data: &[u8]) -> Option<(Value, Vec<u8>)> {
    let number = |at: usize| Some(u32::from_le_bytes(data.get(at..at + 4)?.try_into().ok()?) as usize);
    let size = number(12)?;
    let json = serde_json::from_slice(data.get(20..20usize.checked_add(size)?)?).ok()?;
    let binary = data.get(28 + size..).unwrap_or(&[]).to_vec();
    Some((json, binary))
}

fn join(json: &Value, binary: &[u8]) -> Vec<u8> {
    let mut text = serde_json::to_vec(json).unwrap_or_default();
    text.resize(text.len().next_multiple_of(4), b' ');
    let mut binary = binary.to_vec();
    binary.resize(binary.len().next_multiple_of(4), 0);
    let total = 28 + text.len() + binary.len();
    let mut bytes = b"glTF".to_vec();
    for number in [2, total as u32, text.len() as u32, u32::from_le_bytes(*b"JSON")] {
        bytes.extend(number.to_le_bytes());
    }
    bytes.extend(text);
    for number in [binary.len() as u32, u32::from_le_bytes(*b"BIN\0")] {
        bytes.extend(number.to_le_bytes());
    }
    bytes.extend(binary);
    bytes
}

/// Every place of a JSON value, as the way to it.
fn places(value: &Value, way: &str, all: &mut Vec<String>) {
    match value {
        Value::Array(items) => {
            items.iter().enumerate().for_each(|(index, item)| places(item, &format!("{way}/{index}"), all));
        }
        Value::Object(entries) => entries.iter().for_each(|(key, item)| {
            places(item, &format!("{way}/{}", key.replace('~', "~0").replace('/', "~1")), all);
        }),
        _ => {}
    }
    all.push(way.to_string());
}

fn any_value(numbers: &mut impl FnMut() -> u64) -> Value {
    match numbers() % 24 {
        0 => Value::Null,
        1 => json!(true),
        2 => json!([]),
        3 => json!({}),
        4 => json!(-1),
        5 => json!(u32::MAX),
        6 => json!(u64::MAX),
        7 => json!(i64::MAX),
        8 => json!(1e300),
        9 => json!(1e-320),
        10 => json!(0.5),
        11 => json!(numbers() % 8),
        12 => json!(numbers() % 300),
        13 => json!([5120, 5121, 5122, 5123, 5125, 5126][numbers() as usize % 6]),
        14 => json!(["SCALAR", "VEC2", "VEC3", "VEC4", "MAT4"][numbers() as usize % 5]),
        15 => json!([0.0, 0.0, 0.0]),
        16 => json!(vec![numbers() % 4; numbers() as usize % 20]),
        17 => json!([1e30, -1e30, 0.0]),
        18 => json!(["hips", "head", "leftUpperArm", "", "J_Bip_C_Head", "\u{0}"][numbers() as usize % 6]),
        19 => json!({"JOINTS_0": numbers() % 8, "WEIGHTS_0": numbers() % 8, "POSITION": numbers() % 8}),
        20 => json!({"count": numbers() % 9, "indices": {"bufferView": 0, "componentType": 5123},
            "values": {"bufferView": 0}}),
        21 => json!(1u64 << 31),
        22 => json!(0),
        _ => json!(numbers() % 3),
    }
}

const KEYS: &[&str] = &[
    "byteOffset",
    "byteStride",
    "byteLength",
    "bufferView",
    "count",
    "normalized",
    "sparse",
    "indices",
    "mode",
    "targets",
    "skin",
    "mesh",
    "matrix",
    "translation",
    "rotation",
    "scale",
    "children",
    "joints",
    "inverseBindMatrices",
    "skeleton",
    "min",
    "max",
    "weights",
    "extensions",
    "extras",
    "JOINTS_1",
    "WEIGHTS_1",
    "NORMAL",
    "TANGENT",
    "KHR_draco_mesh_compression",
    "VRM",
    "VRMC_vrm",
    "nodes",
    "scene",
];

/// How the fuzzer changes bytes of which it knows nothing: the bytes, how many are used, how many may be.
pub type Plain<'a> = &'a mut dyn FnMut(&mut [u8], usize, usize) -> usize;

/// Changes the JSON where there is some, and now and then the bytes as they are.
pub fn mutate(data: &mut [u8], size: usize, max_size: usize, seed: u32, plain: Plain) -> usize {
    let mut state = u64::from(seed) << 16 | 1;
    let mut numbers = move || {
        state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        state >> 33
    };
    let parts = if numbers() % 5 == 0 { None } else { split(&data[..size]) };
    let Some((mut json, mut binary)) = parts else { return plain(data, size, max_size) };
    if numbers() % 5 == 0 && !binary.is_empty() {
        let length = binary.len();
        let new = plain(&mut binary, length, length);
        binary.truncate(new);
    } else {
        for _ in 0..1 + numbers() % 3 {
            let mut all = Vec::new();
            places(&json, "", &mut all);
            let at = &all[numbers() as usize % all.len()];
            let other = json.pointer(&all[numbers() as usize % all.len()]).cloned();
            let Some(value) = json.pointer_mut(at) else { continue };
            match (numbers() % 8, &mut *value) {
                (0, Value::Array(items)) if !items.is_empty() => {
                    let index = numbers() as usize % items.len();
                    items.remove(index);
                }
                (1 | 2, Value::Array(items)) if !items.is_empty() => {
                    let item = items[numbers() as usize % items.len()].clone();
                    items.push(item);
                }
                (0, Value::Object(entries)) if !entries.is_empty() => {
                    let key = entries.keys().nth(numbers() as usize % entries.len()).cloned().unwrap();
                    entries.remove(&key);
                }
                (1 | 2, Value::Object(entries)) => {
                    let key = KEYS[numbers() as usize % KEYS.len()];
                    entries.insert(key.to_string(), any_value(&mut numbers));
                }
                (3, _) => *value = other.unwrap_or(Value::Null),
                (4 | 5, Value::Number(number)) => {
                    let number = number.as_i64().unwrap_or(0);
                    *value = json!(number.wrapping_add(numbers() as i64 % 5 - 2));
                }
                (6, Value::Number(_)) => *value = any_value(&mut numbers),
                (6, Value::Object(_)) if at.is_empty() => {}
                _ if at.is_empty() => {}
                (7, Value::Object(_)) => *value = Value::Object(Map::new()),
                (7, _) => *value = any_value(&mut numbers),
                _ => {}
            }
        }
    }
    let bytes = join(&json, &binary);
    if bytes.len() > max_size {
        return plain(data, size, max_size);
    }
    data[..bytes.len()].copy_from_slice(&bytes);
    bytes.len()
}
