//! Damaged and hostile files: each gives one clear sentence, never a panic and never a file.

#[allow(dead_code)]
mod made;

use made::{Made, bytes_of, container, figure, stay_point};
use serde_json::{Value, json};
use std::path::{Path, PathBuf};
use std::process::Command;
use superdeform_host::file::GltfFile;
use superdeform_host::load::{LoadOptions, load};

/// What is wrong, and the file.
type Case = (String, Vec<u8>);

/// The figure with its JSON changed.
fn changed(change: impl FnOnce(&mut Value)) -> Vec<u8> {
    let mut made = figure();
    change(&mut made.json);
    made.bytes()
}

fn accessor_of(made: &Made, key: &str) -> usize {
    made.json["meshes"][0]["primitives"][0]["attributes"][key].as_u64().unwrap() as usize
}

/// The first byte of an accessor in the binary.
fn start_of(made: &Made, accessor: usize) -> usize {
    let view = made.json["accessors"][accessor]["bufferView"].as_u64().unwrap() as usize;
    made.json["bufferViews"][view]["byteOffset"].as_u64().unwrap() as usize
}

fn damaged_containers() -> Vec<Case> {
    let good = figure().bytes();
    let text_length = u32::from_le_bytes(good[12..16].try_into().unwrap()) as usize;
    let mut cases = Vec::new();
    // Every length class: within the header, each chunk header, the JSON and the binary.
    let borders = [0, 4, 8, 12, 16, 20, 20 + text_length, 24 + text_length, 28 + text_length, good.len()];
    let mut lengths: Vec<usize> = borders.iter().flat_map(|&b| [b.saturating_sub(1), b, b + 1]).collect();
    lengths.extend((1..60).map(|step| good.len() * step / 60));
    lengths.sort_unstable();
    lengths.dedup();
    for length in lengths.into_iter().filter(|&length| length < good.len()) {
        cases.push((format!("cut to {length} bytes"), good[..length].to_vec()));
    }
    for (what, at, four) in [
        ("another magic", 0, *b"glTX"),
        ("version 1", 4, [1, 0, 0, 0]),
        ("version 2^32-1", 4, [255; 4]),
        ("a length beyond the end", 8, [255; 4]),
        ("a length of 0", 8, [0; 4]),
        ("a length of 19", 8, [19, 0, 0, 0]),
        ("a JSON chunk of 2^32-1 bytes", 12, [255; 4]),
        ("a JSON chunk of 0 bytes", 12, [0; 4]),
        ("a JSON chunk of 7 bytes", 12, [7, 0, 0, 0]),
        ("a JSON chunk that is longer than the file", 12, (good.len() as u32).to_le_bytes()),
        ("a JSON chunk of another kind", 16, *b"XXXX"),
        ("a binary chunk of 2^32-1 bytes", 20 + text_length, [255; 4]),
        ("a binary chunk of 0 bytes", 20 + text_length, [0; 4]),
        ("a binary chunk of 4 bytes", 20 + text_length, [4, 0, 0, 0]),
        ("a binary chunk of another kind", 24 + text_length, *b"XXXX"),
    ] {
        let mut bytes = good.clone();
        bytes[at..at + 4].copy_from_slice(&four);
        cases.push((what.to_string(), bytes));
    }
    cases.push(("no binary chunk".into(), {
        let mut bytes = good[..20 + text_length].to_vec();
        let length = bytes.len() as u32;
        bytes[8..12].copy_from_slice(&length.to_le_bytes());
        bytes
    }));
    for (what, bytes) in [
        ("a picture", b"\x89PNG\r\n\x1a\n0000000000000000".to_vec()),
        ("a text", b"Dear reader,\nthis is no model.".to_vec()),
        ("zeros", vec![0; 4096]),
        ("an FBX", b"Kaydara FBX Binary  \0\x1a\0".to_vec()),
        ("an empty object", b"{}".to_vec()),
        ("a list", b"[1, 2, 3]".to_vec()),
        ("JSON that stops", b"{\"asset\": {\"version\": \"2.0\"".to_vec()),
        ("half a magic", b"gl".to_vec()),
    ] {
        cases.push((what.to_string(), bytes));
    }
    cases
}

fn damaged_json() -> Vec<Case> {
    let made = figure();
    let text = serde_json::to_vec(&made.json).unwrap();
    let mut cases = Vec::new();
    // Pieces of the text cut out or replaced.
    for step in 1..20 {
        let at = text.len() * step / 20;
        cases.push((format!("JSON cut at {at}"), container(&text[..at], &made.binary)));
    }
    for (what, piece) in [
        ("a nest of lists", "[".repeat(100_000)),
        ("not UTF-8", String::new()),
        ("nothing", " ".to_string()),
        ("null", "null".to_string()),
        ("a number", "17".to_string()),
        ("a list", "[]".to_string()),
        ("a number too large", "{\"asset\": {\"version\": \"2.0\", \"x\": 1e999}}".to_string()),
        ("NaN", "{\"asset\": {\"version\": \"2.0\", \"x\": NaN}}".to_string()),
    ] {
        let piece = if what == "not UTF-8" {
            vec![b'{', b'"', 0xFF, 0xFE, b'"', b':', b'1', b'}']
        } else {
            piece.into_bytes()
        };
        cases.push((format!("JSON is {what}"), container(&piece, &made.binary)));
    }
    // One value at a time, by pointer.
    let primitive = "/meshes/0/primitives/0";
    let at = |rest: &str| format!("{primitive}{rest}");
    let position = accessor_of(&made, "POSITION");
    let joints = accessor_of(&made, "JOINTS_0");
    let weights = accessor_of(&made, "WEIGHTS_0");
    let normal = accessor_of(&made, "NORMAL");
    let indices = made.json["meshes"][0]["primitives"][0]["indices"].as_u64().unwrap();
    let target = made.json["meshes"][0]["primitives"][0]["targets"][0]["POSITION"].as_u64().unwrap();
    let binds = made.json["skins"][0]["inverseBindMatrices"].as_u64().unwrap();
    let mut values: Vec<(String, Value)> = vec![
        ("/asset/version".into(), json!("1.0")),
        ("/asset/version".into(), json!(2)),
        ("/asset".into(), json!(null)),
        ("/nodes".into(), json!(7)),
        ("/nodes/3/children".into(), json!([99])),
        ("/nodes/3/children".into(), json!([-1])),
        ("/nodes/3/children".into(), json!([3])),
        ("/nodes/3/children".into(), json!([0])),
        ("/nodes/3/children".into(), json!([10, 10])),
        ("/nodes/3/children".into(), json!([4])),
        ("/nodes/11/children".into(), json!([10])),
        ("/nodes/11/children".into(), json!([1])),
        ("/nodes/12/mesh".into(), json!(5)),
        ("/nodes/12/mesh".into(), json!("Figure")),
        ("/nodes/12/skin".into(), json!(1)),
        ("/nodes/1/translation".into(), json!("up")),
        ("/nodes/1/translation".into(), json!([1.0])),
        ("/nodes/1/rotation".into(), json!([0, 0, 1])),
        ("/nodes/1/matrix".into(), json!([1, 2, 3])),
        ("/scene".into(), json!(4)),
        ("/scenes/0/nodes".into(), json!([99])),
        ("/scenes/0/nodes".into(), json!([])),
        ("/meshes".into(), json!([])),
        ("/meshes/0/primitives".into(), json!([])),
        ("/meshes/0/primitives".into(), json!(null)),
        (at("/attributes"), json!({})),
        (at("/attributes/POSITION"), json!(99)),
        (at("/attributes/POSITION"), json!(-1)),
        (at("/attributes/POSITION"), json!("POSITION")),
        (at("/attributes/POSITION"), json!(weights)),
        (at("/attributes/POSITION"), json!(indices)),
        (at("/attributes/NORMAL"), json!(joints)),
        (at("/attributes/NORMAL"), json!(99)),
        (at("/attributes/JOINTS_0"), json!(weights)),
        (at("/attributes/JOINTS_0"), json!(99)),
        (at("/attributes/WEIGHTS_0"), json!(position)),
        (at("/attributes/TANGENT"), json!(position)),
        (at("/indices"), json!(99)),
        (at("/indices"), json!(position)),
        (at("/indices"), json!(weights)),
        (at("/targets/0/POSITION"), json!(weights)),
        (at("/targets/0/POSITION"), json!(99)),
        (at("/material"), json!(3)),
        ("/skins/0/joints".into(), json!([])),
        ("/skins/0/joints".into(), json!([99])),
        ("/skins/0/joints".into(), json!([0])),
        ("/skins/0/joints".into(), json!(null)),
        ("/skins/0/inverseBindMatrices".into(), json!(99)),
        ("/skins/0/inverseBindMatrices".into(), json!(position)),
        ("/skins/0/skeleton".into(), json!(99)),
        ("/extensionsRequired".into(), json!(["KHR_draco_mesh_compression"])),
        ("/extensionsRequired".into(), json!(["EXT_meshopt_compression"])),
        ("/extensionsRequired".into(), json!(["KHR_meshopt_compression"])),
        ("/extensionsRequired".into(), json!(["ACME_secret_geometry"])),
        (at("/extensions"), json!({"KHR_draco_mesh_compression": {"bufferView": 0, "attributes": {}}})),
        (
            "/bufferViews/0/extensions".into(),
            json!({"EXT_meshopt_compression": {"buffer": 0, "count": 1, "byteStride": 12, "byteLength": 12, "mode": "ATTRIBUTES"}}),
        ),
        ("/buffers/0".into(), json!({"byteLength": 100, "uri": "elsewhere.bin"})),
        ("/buffers/0".into(), json!({"byteLength": 100, "uri": "data:application/octet-stream;base64,!!!!"})),
        ("/buffers/0".into(), json!({"byteLength": 100, "uri": "data:application/octet-stream;base64,AAAA"})),
        ("/extensions/VRMC_vrm/humanoid/humanBones/head/node".into(), json!(99)),
        ("/extensions/VRMC_vrm/humanoid/humanBones/head/node".into(), json!(1)),
        ("/extensions/VRMC_vrm/humanoid/humanBones/head/node".into(), json!(-5)),
        ("/extensions/VRMC_vrm/humanoid/humanBones/head".into(), json!({})),
        ("/extensions/VRMC_vrm/humanoid/humanBones".into(), json!({})),
        ("/extensions/VRMC_vrm/humanoid".into(), json!("biped")),
        ("/extensions".into(), json!({})),
    ];
    for accessor in [position, joints, weights, normal, indices as usize, target as usize, binds as usize] {
        let at = |key: &str| format!("/accessors/{accessor}/{key}");
        values.extend([
            (at("count"), json!(u64::MAX)),
            (at("count"), json!(1u64 << 40)),
            (at("count"), json!(-3)),
            (at("count"), json!(0)),
            (at("count"), json!(4_294_967_295u32)),
            (at("count"), json!(1.5)),
            (at("byteOffset"), json!(u64::MAX)),
            (at("byteOffset"), json!(1u64 << 31)),
            (at("byteOffset"), json!(-4)),
            (at("type"), json!("VEC9")),
            (at("componentType"), json!(5124)),
            (at("bufferView"), json!(99)),
        ]);
        let view = made.json["accessors"][accessor]["bufferView"].as_u64().unwrap();
        let at = |key: &str| format!("/bufferViews/{view}/{key}");
        values.extend([
            (at("byteOffset"), json!(u64::MAX)),
            (at("byteOffset"), json!(made.binary.len())),
            (at("byteOffset"), json!(-8)),
            (at("byteLength"), json!(u64::MAX)),
            (at("byteLength"), json!(1)),
            (at("byteLength"), json!(made.binary.len() + 1)),
            (at("buffer"), json!(1)),
        ]);
    }
    for (pointer, value) in values {
        let bytes = changed(|json| {
            let (holder, key) = pointer.rsplit_once('/').unwrap();
            match json.pointer_mut(holder).unwrap() {
                Value::Array(list) => list[key.parse::<usize>().unwrap()] = value.clone(),
                holder => holder[key] = value.clone(),
            }
        });
        let short: String = value.to_string().chars().take(60).collect();
        cases.push((format!("{pointer} = {short}"), bytes));
    }
    cases
}

fn damaged_numbers() -> Vec<Case> {
    let good = figure();
    let mut cases = Vec::new();
    let mut poke = |what: &str, accessor: usize, offset: usize, bytes: &[u8]| {
        let mut made = good.clone();
        let start = start_of(&made, accessor) + offset;
        made.binary[start..start + bytes.len()].copy_from_slice(bytes);
        cases.push((what.to_string(), made.bytes()));
    };
    let primitive = &good.json["meshes"][0]["primitives"][0];
    let indices = primitive["indices"].as_u64().unwrap() as usize;
    let target = primitive["targets"][0]["POSITION"].as_u64().unwrap() as usize;
    let binds = good.json["skins"][0]["inverseBindMatrices"].as_u64().unwrap() as usize;
    for (name, value) in [("NaN", f32::NAN), ("infinity", f32::INFINITY), ("-infinity", f32::NEG_INFINITY)] {
        let value = bytes_of(&[value]);
        poke(&format!("a position of {name}"), accessor_of(&good, "POSITION"), 40, &value);
        poke(&format!("a normal of {name}"), accessor_of(&good, "NORMAL"), 40, &value);
        poke(&format!("a weight of {name}"), accessor_of(&good, "WEIGHTS_0"), 32, &value);
        poke(&format!("a delta of {name}"), target, 80, &value);
        poke(&format!("a bind matrix of {name}"), binds, 64 + 48, &value);
    }
    poke("a weight below 0", accessor_of(&good, "WEIGHTS_0"), 16, &bytes_of(&[-0.5]));
    poke("joint 200 of 12", accessor_of(&good, "JOINTS_0"), 4, &[200]);
    poke("joint 12 of 12", accessor_of(&good, "JOINTS_0"), 4, &[12]);
    poke("vertex 65535", indices, 10, &65535u16.to_le_bytes());
    poke("vertex 96 of 96", indices, 0, &96u16.to_le_bytes());

    let mut sparse = |what: &str, sparse: fn(usize, usize) -> Value| {
        let mut made = good.clone();
        let indices = made.view(&500u16.to_le_bytes());
        let values = made.view(&bytes_of(&[1.0, 0.0, 0.0]));
        made.json["accessors"][target]["sparse"] = sparse(indices, values);
        cases.push((format!("sparse: {what}"), made.bytes()));
    };
    sparse(
        "element 500",
        |i, v| json!({"count": 1, "indices": {"bufferView": i, "componentType": 5123}, "values": {"bufferView": v}}),
    );
    sparse("no values", |i, _| json!({"count": 1, "indices": {"bufferView": i, "componentType": 5123}}));
    sparse(
        "too many",
        |i, v| json!({"count": 1u64 << 60, "indices": {"bufferView": i, "componentType": 5123}, "values": {"bufferView": v}}),
    );
    sparse(
        "views that are not there",
        |_, _| json!({"count": 1, "indices": {"bufferView": 77, "componentType": 5123}, "values": {"bufferView": 78}}),
    );
    sparse(
        "indices as floats",
        |i, v| json!({"count": 1, "indices": {"bufferView": i, "componentType": 5126}, "values": {"bufferView": v}}),
    );

    let mut without_data = good.clone();
    for (list, count) in
        [("zeros without end", 1u64 << 50), ("more zeros than bytes", without_data.binary.len() as u64 + 99)]
    {
        without_data.json["accessors"][accessor_of(&good, "POSITION")] =
            json!({"componentType": 5126, "type": "VEC3", "count": count});
        cases.push((list.into(), without_data.bytes()));
    }
    let mut many = Made::empty();
    let size = 3 << 20;
    many.binary = vec![0; size];
    many.push("accessors", json!({"componentType": 5126, "type": "VEC3", "count": size}));
    let primitives: Vec<Value> = (0..100_000).map(|_| json!({"attributes": {"POSITION": 0}})).collect();
    many.push("meshes", json!({"primitives": primitives}));
    many.push("nodes", json!({"mesh": 0}));
    many.json["scenes"][0]["nodes"] = json!([0]);
    cases.push(("the same vertices a hundred thousand times".into(), many.bytes()));

    let mut stride = good.clone();
    stride.json["bufferViews"][0]["byteStride"] = json!(4);
    cases.push(("a stride below the element".into(), stride.bytes()));
    let mut stride = good.clone();
    stride.json["bufferViews"][0]["byteStride"] = json!(252);
    cases.push(("a stride beyond the view".into(), stride.bytes()));
    cases
}

fn wrong_figures() -> Vec<Case> {
    let vrm0 = |bones: Value| {
        changed(|json| json["extensions"] = json!({"VRM": {"humanoid": {"humanBones": bones}}}))
    };
    let bone = |name: &str, node: i64| json!({"bone": name, "node": node});
    let mut cases = vec![
        ("no meshes".to_string(), Made::empty().bytes()),
        ("two heads".into(), vrm0(json!([bone("head", 3), bone("head", 2)]))),
        ("one node as head and hips".into(), vrm0(json!([bone("head", 3), bone("hips", 3)]))),
        ("a role for a node that is not there".into(), vrm0(json!([bone("head", 3000)]))),
        ("no roles".into(), vrm0(json!([]))),
        ("only unknown roles".into(), vrm0(json!([bone("tail", 3)]))),
        ("roles of no nodes".into(), vrm0(json!([bone("head", -1), bone("hips", -1)]))),
    ];
    for role in ["hips", "head", "leftUpperLeg", "rightUpperLeg", "leftUpperArm", "rightUpperArm"] {
        let bytes = changed(|json| {
            json["extensions"]["VRMC_vrm"]["humanoid"]["humanBones"].as_object_mut().unwrap().remove(role);
        });
        cases.push((format!("no {role}"), bytes));
    }
    cases
}

/// Loads, and writes what could be loaded; the error's sentence.
fn outcome(bytes: &[u8]) -> Result<(), String> {
    let file = GltfFile::parse("bad.glb", bytes).map_err(|error| error.message)?;
    let loaded = load(file, &LoadOptions::default()).map_err(|error| error.message)?;
    let result = made::deformed(&loaded.character, Some(made::squash));
    let written = superdeform_host::write::write(&loaded, &result, &made::squash_point)
        .map_err(|error| error.message)?;
    GltfFile::parse("written.glb", &written).map_err(|error| error.message)?;
    let same = made::deformed(&loaded.character, None);
    superdeform_host::write::write(&loaded, &same, &stay_point).map_err(|error| error.message)?;
    Ok(())
}

fn is_one_sentence(message: &str) -> bool {
    let sentences = message.split(". ").count();
    !message.is_empty()
        && !message.contains('\n')
        && sentences == 1
        && message.len() < 500
        && message.contains(' ')
}

/// Cases that are no error: what is wrong there does not touch the shape, or is what the format allows.
const FINE: [&str; 3] = ["/nodes/1/rotation = [0,0,1]", "/skins/0/skeleton = 99", "/scenes/0/nodes = []"];

#[test]
fn every_damaged_file_gives_one_sentence() {
    let cases: Vec<Case> = [damaged_containers(), damaged_json(), damaged_numbers(), wrong_figures()]
        .into_iter()
        .flatten()
        .collect();
    println!("{} cases", cases.len());
    assert!(cases.len() >= 200);
    let mut wrong = Vec::new();
    for (what, bytes) in &cases {
        match std::panic::catch_unwind(|| outcome(bytes)) {
            Err(_) => wrong.push(format!("{what}: panicked")),
            Ok(Ok(())) if !FINE.contains(&what.as_str()) => wrong.push(format!("{what}: accepted")),
            Ok(Err(message)) if !is_one_sentence(&message) => wrong.push(format!("{what}: {message}")),
            Ok(outcome) => println!("{what}: {outcome:?}"),
        }
    }
    assert!(wrong.is_empty(), "{} of {}:\n{}", wrong.len(), cases.len(), wrong.join("\n"));
}

#[test]
fn messages_name_the_place_the_value_and_the_remedy() {
    let cases: Vec<Case> = [damaged_json(), damaged_numbers()].into_iter().flatten().collect();
    let message = |what: &str| {
        let (_, bytes) = cases.iter().find(|(name, _)| name == what).unwrap();
        outcome(bytes).unwrap_err()
    };
    assert_eq!(
        message("vertex 65535"),
        "bad.glb: mesh 0 (Figure): index 5 names vertex 65535, but the mesh has 96 vertices (0 to 95): export the file anew"
    );
    assert_eq!(
        message("a position of NaN"),
        "bad.glb: mesh 0 (Figure): vertex 3 is at [0.05, NaN, -0.05]: positions must be finite numbers, so mend the mesh and export anew"
    );
    assert_eq!(
        message("a weight below 0"),
        "bad.glb: mesh 0 (Figure): vertex 1 has weight -0.5 for joint 0: weights must be 0 or more, so mend them and export anew"
    );
    assert!(
        message("/extensionsRequired = [\"KHR_draco_mesh_compression\"]")
            .contains("KHR_draco_mesh_compression")
    );
}

#[test]
fn files_that_are_not_there_give_one_sentence() {
    let folder = std::env::temp_dir();
    for path in [folder.join("superdeform-no-such-file.glb"), folder.clone()] {
        let message = GltfFile::read(&path).unwrap_err().message;
        assert!(is_one_sentence(&message), "{message}");
    }
}

/// The example beside this test's own program, where it has been built.
fn example() -> Option<PathBuf> {
    let own = std::env::current_exe().ok()?;
    let path =
        own.parent()?.parent()?.join("examples").join(format!("superdeform{}", std::env::consts::EXE_SUFFIX));
    path.is_file().then_some(path)
}

#[test]
fn the_program_ends_with_1_and_one_sentence_and_leaves_no_file() {
    let Some(program) = example() else {
        return println!("the example superdeform is not built: not tested");
    };
    let folder = std::env::temp_dir().join(format!("superdeform-bad-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let pick = |cases: Vec<Case>, count: usize| {
        let step = cases.len() / count;
        cases.into_iter().step_by(step).take(count).collect::<Vec<_>>()
    };
    let sample = [
        pick(damaged_containers(), 4),
        pick(damaged_json(), 4),
        pick(damaged_numbers(), 3),
        vec![("no meshes".to_string(), Made::empty().bytes())],
    ];
    let output = folder.join("out.glb");
    let check = |what: &str, input: &Path| {
        let run = Command::new(&program).arg(input).arg("-o").arg(&output).output().unwrap();
        let message = String::from_utf8(run.stderr).unwrap();
        assert_eq!(run.status.code(), Some(1), "{what}: {message}");
        assert!(is_one_sentence(message.trim_end()), "{what}: {message}");
    };
    for (what, bytes) in sample.into_iter().flatten().filter(|(what, _)| !FINE.contains(&what.as_str())) {
        let input = folder.join("in.glb");
        std::fs::write(&input, bytes).unwrap();
        check(&what, &input);
        std::fs::remove_file(input).unwrap();
    }
    check("a folder", &folder);
    check("nothing", &folder.join("missing.glb"));
    assert_eq!(std::fs::read_dir(&folder).unwrap().count(), 0, "a file was left behind");
    std::fs::remove_dir_all(&folder).unwrap();
}
