//! Files through the example host: read, deformed, written, read again.

#[allow(dead_code)]
mod made;

use glam::{DVec3, Vec3};
use made::{
    JOINTS, Made, boxes, bytes_of, deformed, figure, squash, squash_jacobian, squash_point, stay_point,
};
use serde_json::{Value, json};
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use superdeform::{MeshKind, Options, Progress, Style};
use superdeform_host::accessor::Reader;
use superdeform_host::appearance::Appearance;
use superdeform_host::conversion::{Conversion, OpenOptions, Source, WriteOptions};
use superdeform_host::file::{GltfFile, write_atomically};
use superdeform_host::image::Image;
use superdeform_host::load::{LoadOptions, Loaded, load};
use superdeform_host::paint::EvenEyes;
use superdeform_host::samples;
use superdeform_host::verify::closure;
use superdeform_host::write::rewrite;

fn loaded(made: &Made) -> Loaded {
    load(GltfFile::parse("made.glb", &made.bytes()).unwrap(), &LoadOptions::default()).unwrap()
}

/// Deforms, writes to bytes, and reads those again.
fn squashed(loaded: &Loaded) -> GltfFile {
    let result = deformed(&loaded.character, Some(squash));
    let written = rewrite(loaded, &result, &squash_point).unwrap();
    let written = GltfFile::parse("written.glb", &written.to_bytes().unwrap()).unwrap();
    let closure = closure(&written, loaded, &result).unwrap();
    assert!(closure.rest < 1e-6, "{}: rest {}", loaded.file.name, closure.rest);
    if let Some(nodes) = closure.nodes {
        assert!(nodes < 1e-5, "{}: nodes {nodes}", loaded.file.name);
    }
    written
}

fn unchanged(loaded: &Loaded) -> GltfFile {
    let result = deformed(&loaded.character, None);
    let written = rewrite(loaded, &result, &stay_point).unwrap();
    GltfFile::parse("written.glb", &written.to_bytes().unwrap()).unwrap()
}

/// The files to test with, and the roles of those that do not say.
fn models() -> Vec<(PathBuf, Option<Value>)> {
    let mut folders = vec![samples::data()];
    let shared = samples::folder();
    if shared.is_dir() {
        folders.push(shared.clone());
    } else {
        samples::skipped("models");
    }
    let roles: Value = std::fs::read(shared.join("roles.json"))
        .ok()
        .and_then(|text| serde_json::from_slice(&text).ok())
        .unwrap_or_else(|| json!({}));
    let mut files = Vec::new();
    for folder in folders {
        let entries = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
        for path in entries.filter(|p| p.extension().is_some_and(|e| e == "glb" || e == "vrm")) {
            let map = roles.get(path.file_name().unwrap().to_str().unwrap()).cloned();
            files.push((path, map));
        }
    }
    files.sort_by(|one, other| one.0.cmp(&other.0));
    files
}

/// Stands in for the guess by names: the first six joints, so that files without roles load.
fn any_roles(
    skeleton: &superdeform::Skeleton,
    _: &[superdeform::Mesh],
    _: Vec3,
) -> (superdeform::Humanoid, Vec<superdeform::Warning>) {
    let mut humanoid = superdeform::Humanoid::default();
    if skeleton.joints.len() >= 6 {
        for (joint, role) in
            superdeform::internals::character::humanoid::REQUIRED_ROLES.into_iter().enumerate()
        {
            humanoid.set(role, joint);
        }
    }
    (humanoid, Vec::new())
}

fn load_model(path: &Path, map: &Option<Value>) -> Loaded {
    let file = GltfFile::read(path).unwrap();
    let rigged = !file.list("skins").is_empty();
    let options = LoadOptions {
        humanoid_map: map.as_ref().filter(|_| rigged),
        find_roles: Some(&any_roles),
        ..LoadOptions::default()
    };
    load(GltfFile::read(path).unwrap(), &options)
        .unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

#[test]
fn a_character_that_is_not_changed_gives_its_file_back() {
    for (path, map) in models() {
        let loaded = load_model(&path, &map);
        let written = unchanged(&loaded);
        assert!(written.json == loaded.file.json, "{}", path.display());
        assert!(written.binary == loaded.file.binary, "{}", path.display());
        let result = deformed(&loaded.character, None);
        let closure = closure(&written, &loaded, &result).unwrap();
        println!("{}: rest {:.1e}, nodes {:?}", path.display(), closure.rest, closure.nodes);
        assert!(closure.rest <= 1e-6, "{}: {closure:?}", path.display());
        assert!(closure.nodes.is_none_or(|nodes| nodes <= 1e-5), "{}: {closure:?}", path.display());
    }
}

#[test]
fn a_changed_character_keeps_all_but_its_shape() {
    for (path, map) in models() {
        let loaded = load_model(&path, &map);
        let result = deformed(&loaded.character, Some(squash));
        let written = squashed(&loaded);
        let closure = closure(&written, &loaded, &result).unwrap();
        println!("{}: rest {:.1e}, nodes {:?}", path.display(), closure.rest, closure.nodes);
        // Weights, indices, texture coordinates and all else that is not shape: bit for bit.
        let (old, new) = (Reader::new(&loaded.file), Reader::new(&written));
        for (mesh, mesh_json) in loaded.file.list("meshes").iter().enumerate() {
            for (primitive, primitive_json) in
                superdeform_host::array_at(mesh_json, "primitives").iter().enumerate()
            {
                let after = &written.list("meshes")[mesh]["primitives"][primitive];
                for (key, accessor) in primitive_json["attributes"].as_object().unwrap() {
                    if ["POSITION", "NORMAL", "TANGENT"].contains(&key.as_str()) {
                        continue;
                    }
                    let accessor = accessor.as_u64().unwrap() as usize;
                    let components = old.layout(accessor).unwrap().components;
                    let one = old.floats(accessor, components, None).unwrap();
                    let other = superdeform_host::index_at(&after["attributes"], key).unwrap();
                    let other = new.floats(other, components, None).unwrap();
                    assert!(one.iter().zip(&other).all(|(a, b)| a.to_bits() == b.to_bits()));
                }
            }
        }
        let mut before = loaded.file.json.clone();
        let mut after = written.json.clone();
        for json in [&mut before, &mut after] {
            for node in json["nodes"].as_array_mut().unwrap() {
                node.as_object_mut().unwrap().remove("translation");
                if let Some(matrix) = node.get_mut("matrix").and_then(Value::as_array_mut) {
                    matrix.drain(12..15);
                }
            }
            for accessor in json["accessors"].as_array_mut().unwrap() {
                accessor.as_object_mut().unwrap().remove("min");
                accessor.as_object_mut().unwrap().remove("max");
            }
            // Springs, viewpoint and outlines have tests of their own.
            json.as_object_mut().unwrap().remove("extensions");
            json.as_object_mut().unwrap().remove("materials");
        }
        if !loaded.file.list("animations").is_empty() {
            // Keys that are made anew (`clips.rs`) have accessors of another length, and what they took is cut out.
            let samplers = loaded
                .file
                .list("animations")
                .iter()
                .flat_map(|clip| superdeform_host::array_at(clip, "samplers").to_vec());
            let keys: BTreeSet<usize> = samplers
                .flat_map(|sampler| ["input", "output"].map(|key| superdeform_host::index_at(&sampler, key)))
                .flatten()
                .collect();
            let count = loaded.file.list("accessors").len();
            for json in [&mut before, &mut after] {
                let accessors = json["accessors"].as_array().unwrap()[..count].iter().enumerate();
                let others = accessors.filter(|(index, _)| !keys.contains(index));
                json["accessors"] = others.map(|(_, accessor)| accessor.clone()).collect();
                for list in ["animations", "bufferViews", "buffers"] {
                    json.as_object_mut().unwrap().remove(list);
                }
            }
        }
        assert!(before == after, "{}", path.display());
    }
}

#[test]
fn the_rest_pose_is_the_bind_pose_where_the_nodes_kick() {
    let Some((path, map)) = models().into_iter().find(|(path, _)| path.ends_with("gdquest_mannequiny.glb"))
    else {
        return println!("no gdquest_mannequiny.glb: not tested");
    };
    let loaded = load_model(&path, &map);
    assert!(loaded.warnings.iter().any(|warning| warning.code == "pose_not_rest"));
    let mut boundary = [Vec3::INFINITY, Vec3::NEG_INFINITY];
    for p in loaded.character.meshes.iter().flat_map(|mesh| &mesh.positions) {
        boundary = [boundary[0].min(*p), boundary[1].max(*p)];
    }
    println!("{boundary:?}");
    // Standing: left and right reach as far, and the soles are on the ground.
    assert!((boundary[0].x + boundary[1].x).abs() < 0.02 * (boundary[1].x - boundary[0].x));
    assert!(boundary[0].y.abs() < 0.02 * (boundary[1].y - boundary[0].y));
}

#[test]
fn weights_are_normalised_and_rows_of_nothing_go_to_the_first_joint() {
    let mut made = figure();
    let count = boxes().1.len();
    for (component_type, bytes) in [
        (5121, (0..count).flat_map(|v| if v == 5 { [0; 4] } else { [100u8, 50, 0, 0] }).collect::<Vec<u8>>()),
        (
            5123,
            (0..count)
                .flat_map(|v| if v == 5 { [0; 4] } else { [40000u16, 20000, 0, 0] })
                .flat_map(u16::to_le_bytes)
                .collect(),
        ),
    ] {
        let weights = made.accessor(&bytes, component_type, "VEC4", count);
        made.json["accessors"][weights]["normalized"] = json!(true);
        made.json["meshes"][0]["primitives"][0]["attributes"]["WEIGHTS_0"] = json!(weights);
        let loaded = loaded(&made);
        let rows = &loaded.character.meshes[0].weights;
        assert_eq!(rows.row(5), &[(0, 1.0)]);
        let [(_, large), (_, small)] = rows.row(40) else { panic!("{:?}", rows.row(40)) };
        assert!((large - 2.0 / 3.0).abs() < 1e-6 && (small - 1.0 / 3.0).abs() < 1e-6);
        squashed(&loaded);
    }
}

#[test]
fn any_number_of_influences_is_read() {
    let mut made = figure();
    let count = boxes().1.len();
    let joints = made.accessor(&[1u8, 2, 3, 4].repeat(count), 5121, "VEC4", count);
    let weights = made.floats("VEC4", 4, &[0.25f32, 0.25, 0.25, 0.25].repeat(count));
    let attributes = &mut made.json["meshes"][0]["primitives"][0]["attributes"];
    attributes["JOINTS_1"] = json!(joints);
    attributes["WEIGHTS_1"] = json!(weights);
    let loaded = loaded(&made);
    let row = loaded.character.meshes[0].weights.row(30);
    assert_eq!(row.len(), 6);
    assert!((row.iter().map(|&(_, weight)| weight).sum::<f32>() - 1.0).abs() < 1e-6);
    squashed(&loaded);
}

#[test]
fn interleaved_vertices_are_written_where_they_stand() {
    let mut made = figure();
    let (positions, of_vertex, _) = boxes();
    let mut bytes = Vec::new();
    for (vertex, place) in positions.chunks(3).enumerate() {
        bytes.extend(bytes_of(place));
        bytes.extend(bytes_of(&[0.0, 1.0, 0.0]));
        bytes.extend(bytes_of(&[vertex as f32, 0.5]));
    }
    let view = made.view(&bytes);
    made.json["bufferViews"][view]["byteStride"] = json!(32);
    for (key, kind, offset) in [("POSITION", "VEC3", 0), ("NORMAL", "VEC3", 12), ("TEXCOORD_0", "VEC2", 24)] {
        let accessor = json!({"bufferView": view, "byteOffset": offset, "componentType": 5126, "type": kind, "count": of_vertex.len()});
        let accessor = made.push("accessors", accessor);
        made.json["meshes"][0]["primitives"][0]["attributes"][key] = json!(accessor);
    }
    let loaded = loaded(&made);
    let written = squashed(&loaded);
    assert_eq!(written.binary.len(), loaded.file.binary.len());
    let accessor =
        superdeform_host::index_at(&written.json["meshes"][0]["primitives"][0]["attributes"], "TEXCOORD_0")
            .unwrap();
    let coordinates = Reader::new(&written).floats(accessor, 2, None).unwrap();
    assert!(coordinates.chunks(2).enumerate().all(|(vertex, uv)| uv == [vertex as f32, 0.5]));
}

#[test]
fn sparse_morph_targets_stay_sparse_and_their_zeros_stay_zero() {
    let mut made = figure();
    let count = boxes().1.len();
    let indices: Vec<u8> = [24u16, 25].iter().flat_map(|i| i.to_le_bytes()).collect();
    let indices = made.view(&indices);
    let values = made.view(&bytes_of(&[0.0, 0.03, 0.0, 0.01, 0.0, 0.02]));
    let accessor = json!({"componentType": 5126, "type": "VEC3", "count": count, "sparse": {
        "count": 2, "indices": {"bufferView": indices, "componentType": 5123}, "values": {"bufferView": values}}});
    let accessor = made.push("accessors", accessor);
    made.json["meshes"][0]["primitives"][0]["targets"][0]["POSITION"] = json!(accessor);
    let loaded = loaded(&made);
    let deltas = &loaded.character.meshes[0].morph_targets[0].positions;
    assert_eq!(deltas[24], Vec3::new(0.0, 0.03, 0.0));
    assert_eq!(loaded.character.meshes[0].morph_targets[0].name, "smile");
    let written = squashed(&loaded);
    assert_eq!(written.json["accessors"][accessor]["sparse"]["count"], json!(2));
    let deltas = Reader::new(&written).floats(accessor, 3, None).unwrap();
    let moved: Vec<usize> =
        (0..count).filter(|v| deltas[3 * v..3 * v + 3].iter().any(|d| *d != 0.0)).collect();
    assert_eq!(moved, [24, 25]);
    assert!(written.binary.len() <= loaded.file.binary.len() + 16);
}

#[test]
fn quantised_positions_are_read_and_written_as_floats() {
    let mut made = figure();
    let (positions, of_vertex, _) = boxes();
    let bytes: Vec<u8> = positions
        .chunks(3)
        .flat_map(|p| [p[0], p[1], p[2], 0.0])
        .flat_map(|x| ((x / 2.0 * 32767.0) as i16).to_le_bytes())
        .collect();
    let accessor = made.accessor(&bytes, 5122, "VEC3", of_vertex.len());
    let view = superdeform_host::index_at(&made.json["accessors"][accessor], "bufferView").unwrap();
    made.json["bufferViews"][view]["byteStride"] = json!(8);
    made.json["accessors"][accessor]["normalized"] = json!(true);
    made.json["meshes"][0]["primitives"][0]["attributes"]["POSITION"] = json!(accessor);
    made.json["extensionsRequired"] = json!(["KHR_mesh_quantization"]);
    // The mesh is half as large; the inverse bind matrices make up for it.
    let mut binds = Vec::new();
    for (.., p) in JOINTS {
        binds.extend([2.0, 0.0, 0.0, 0.0, 0.0, 2.0, 0.0, 0.0, 0.0, 0.0, 2.0, 0.0, -p[0], -p[1], -p[2], 1.0]);
    }
    let binds = made.floats("MAT4", 16, &binds);
    made.json["skins"][0]["inverseBindMatrices"] = json!(binds);
    let loaded = loaded(&made);
    let place = loaded.character.meshes[0].positions[8 * 3];
    assert!(place.distance(Vec3::new(-0.05, 1.45, -0.05)) < 1e-3, "{place}");
    let size = loaded.file.binary.len();
    let written = squashed(&loaded);
    assert_eq!(written.json["accessors"][accessor]["componentType"], json!(5126));
    assert!(written.json["accessors"][accessor].get("normalized").is_none());
    assert!(written.json["accessors"][accessor].get("min").is_some());
    // The old bytes are gone: 12 bytes a vertex for 8.
    assert!(written.binary.len() <= size + 4 * of_vertex.len() + 16, "{size} {}", written.binary.len());
    // Nothing changed: nothing written.
    assert!(unchanged(&loaded).json == loaded.file.json);
}

#[test]
fn strips_and_fans_become_triangles_and_lines_are_deformed_too() {
    for (mode, wanted) in
        [(5, vec![[0, 1, 2], [1, 3, 2], [2, 3, 4]]), (6, vec![[1, 2, 0], [2, 3, 0], [3, 4, 0]]), (1, vec![])]
    {
        let mut made = figure();
        let indices = made.indices(&[0, 1, 2, 3, 4]);
        let primitive = &mut made.json["meshes"][0]["primitives"][0];
        primitive["mode"] = json!(mode);
        primitive["indices"] = json!(indices);
        let loaded = loaded(&made);
        assert_eq!(loaded.character.meshes[0].triangles, wanted);
        squashed(&loaded);
    }
}

#[test]
fn two_skins_that_bind_the_same_joints_in_different_poses_meet_in_one_rest_pose() {
    let mut made = figure();
    // The second skin has the figure's arms a quarter turn down and everything ten centimetres higher.
    let mut binds = Vec::new();
    for (joint, (.., p)) in JOINTS.iter().enumerate() {
        let lifted = [p[0], p[1] + 0.1, p[2]];
        if joint == 4 {
            // Inverse of a turn by -90 degrees about z at the shoulder: x -> y.
            binds.extend([
                0.0, 1.0, 0.0, 0.0, -1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, lifted[1], -lifted[0],
                -lifted[2], 1.0,
            ]);
        } else {
            binds.extend([
                1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, -lifted[0], -lifted[1],
                -lifted[2], 1.0,
            ]);
        }
    }
    let binds = made.floats("MAT4", 16, &binds);
    let mut skin = made.json["skins"][0].clone();
    skin["inverseBindMatrices"] = json!(binds);
    made.push("skins", skin);
    let mesh = made.json["meshes"][0].clone();
    made.push("meshes", mesh);
    made.push("nodes", json!({"name": "sleeves", "mesh": 1, "skin": 1}));
    made.json["scenes"][0]["nodes"] = json!([0, 12, 13]);
    // Both meshes name the same accessors, but come from different poses: they part on writing.
    let loaded = loaded(&made);
    assert!(loaded.warnings.iter().any(|warning| warning.code == "pose_not_rest"));
    let (first, second) = (&loaded.character.meshes[0], &loaded.character.meshes[1]);
    assert!((first.positions[0] - second.positions[0] - Vec3::new(0.0, 0.1, 0.0)).length() < 1e-5);
    let result = deformed(&loaded.character, Some(squash));
    let written = rewrite(&loaded, &result, &squash_point).unwrap();
    let closure = closure(&written, &loaded, &result).unwrap();
    assert!(closure.rest < 1e-6, "{closure:?}");
    let position =
        |mesh: usize| written.json["meshes"][mesh]["primitives"][0]["attributes"]["POSITION"].clone();
    assert_ne!(position(0), position(1));
    assert!(unchanged(&loaded).json == loaded.file.json);
}

#[test]
fn accessors_that_were_shared_stay_shared() {
    let mut made = figure();
    let copy = made.json["meshes"][0]["primitives"][0].clone();
    made.json["meshes"][0]["primitives"].as_array_mut().unwrap().push(copy);
    let second = made.json["skins"][0].clone();
    made.push("skins", second);
    let mesh = made.json["meshes"][0].clone();
    made.push("meshes", mesh);
    made.push("nodes", json!({"name": "twin", "mesh": 1, "skin": 1}));
    made.push("nodes", json!({"name": "instance", "mesh": 0, "skin": 0}));
    made.json["scenes"][0]["nodes"] = json!([0, 12, 13, 14]);
    let loaded = loaded(&made);
    assert_eq!(loaded.character.meshes.len(), 6);
    let written = squashed(&loaded);
    assert_eq!(written.json["meshes"], loaded.file.json["meshes"]);
    assert_eq!(written.json["skins"], loaded.file.json["skins"]);
    assert_eq!(written.list("accessors").len(), loaded.file.list("accessors").len());
    assert_eq!(written.binary.len(), loaded.file.binary.len());
}

#[test]
fn a_rigid_mesh_that_two_nodes_show_is_doubled_where_they_differ() {
    let mut made = figure();
    let lamp = made.floats("VEC3", 3, &[0.0, 0.0, 0.0, 0.1, 0.0, 0.0, 0.0, 0.1, 0.0]);
    made.push("meshes", json!({"name": "Lamp", "primitives": [{"attributes": {"POSITION": lamp}}]}));
    for (parent, name) in [(3, "on the head"), (8, "on the shin")] {
        let node = made.push("nodes", json!({"name": name, "mesh": 1, "scale": [1.0, 2.0, 1.0]}));
        let children = &mut made.json["nodes"][parent]["children"];
        match children.as_array_mut() {
            Some(children) => children.push(json!(node)),
            None => *children = json!([node]),
        }
    }
    let loaded = loaded(&made);
    assert_eq!(loaded.character.meshes.len(), 3);
    let written = squashed(&loaded);
    assert_eq!(written.list("meshes").len(), 3);
    assert_ne!(written.json["nodes"][13]["mesh"], written.json["nodes"][14]["mesh"]);
    assert_eq!(written.json["meshes"][2]["name"], json!("Lamp"));
}

#[test]
fn a_node_with_a_matrix_keeps_it_but_for_where_it_is() {
    let mut made = figure();
    let node = made.json["nodes"][8].as_object_mut().unwrap();
    let at: Vec<f64> =
        node.remove("translation").unwrap().as_array().unwrap().iter().map(|x| x.as_f64().unwrap()).collect();
    node.insert(
        "matrix".into(),
        json!([1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, at[0], at[1], at[2], 1.0]),
    );
    let loaded = loaded(&made);
    let written = squashed(&loaded);
    let matrix = written.json["nodes"][8]["matrix"].as_array().unwrap();
    assert_eq!(matrix[0..12], loaded.file.json["nodes"][8]["matrix"].as_array().unwrap()[0..12]);
    assert_ne!(matrix[13], loaded.file.json["nodes"][8]["matrix"][13]);
    assert!(written.json["nodes"][8].get("translation").is_none());
}

#[test]
fn a_skin_without_matrices_has_identities_and_gets_matrices_where_it_moves() {
    let mut made = figure();
    made.json["skins"][0].as_object_mut().unwrap().remove("inverseBindMatrices");
    let result = load(GltfFile::parse("made.glb", &made.bytes()).unwrap(), &LoadOptions::default()).unwrap();
    let written =
        rewrite(&result, &deformed(&result.character, Some(|p| p + DVec3::X)), &stay_point).unwrap();
    assert!(superdeform_host::index_at(&written.json["skins"][0], "inverseBindMatrices").is_some());
}

#[test]
fn the_hips_track_is_scaled_with_their_height_and_others_move_with_their_rest() {
    let mut made = figure();
    let times = made.floats("SCALAR", 1, &[0.0, 1.0]);
    let hips = made.floats("VEC3", 3, &[0.0, 0.9, 0.0, 0.0, 0.5, 1.0]);
    // Shared by two joints: they part.
    let shared = made.floats("VEC3", 3, &[0.0, -0.4, 0.02, 0.1, -0.4, 0.02]);
    let turns = made.floats("VEC4", 4, &[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0]);
    let cubic = made.floats(
        "VEC3",
        3,
        &[1.0, 1.0, 1.0, 0.0, 0.2, 0.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 0.0, 0.2, 0.0, 1.0, 1.0, 1.0],
    );
    let channel = |sampler: usize, node: usize, path: &str| json!({"sampler": sampler, "target": {"node": node, "path": path}});
    made.json["animations"] = json!([{
        "samplers": [
            {"input": times, "output": hips}, {"input": times, "output": shared}, {"input": times, "output": turns},
            {"input": times, "output": cubic, "interpolation": "CUBICSPLINE"},
        ],
        "channels": [
            channel(0, 1, "translation"), channel(1, 8, "translation"), channel(1, 0, "scale"),
            channel(2, 1, "rotation"), channel(3, 2, "translation"),
        ],
    }]);
    let loaded = loaded(&made);
    let written = squashed(&loaded);
    let animation = &written.json["animations"][0];
    let output = |channel: usize| {
        let sampler = superdeform_host::index_at(&animation["channels"][channel], "sampler").unwrap();
        let accessor = superdeform_host::index_at(&animation["samplers"][sampler], "output").unwrap();
        Reader::new(&written).floats(accessor, if channel == 3 { 4 } else { 3 }, None).unwrap()
    };
    let moved = squash(DVec3::new(0.0, 0.9, 0.0));
    // The lowest vertex was at -0.05.
    let ratio = (moved.y - squash(DVec3::new(0.0, -0.05, 0.0)).y) / (0.9 + 0.05);
    let hips = output(0);
    assert!((f64::from(hips[1]) - moved.y).abs() < 1e-6);
    assert!((f64::from(hips[4]) - (moved.y - 0.4 * ratio)).abs() < 1e-6);
    assert!((f64::from(hips[5]) - ratio).abs() < 1e-6);
    let rest: Vec<f64> = written.json["nodes"][8]["translation"]
        .as_array()
        .unwrap()
        .iter()
        .map(|x| x.as_f64().unwrap())
        .collect();
    let shin = output(1);
    for axis in 0..3 {
        assert!((f64::from(shin[axis]) - rest[axis]).abs() < 1e-6);
    }
    // How far a key of a leg lies from the rest is scaled as the hips are; that of another joint takes the field's scale there.
    assert!((f64::from(shin[3] - shin[0]) - 0.1 * ratio).abs() < 1e-6);
    assert_eq!(output(2), [0.0, -0.4, 0.02, 0.1, -0.4, 0.02]);
    assert_eq!(output(3), [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0]);
    let back = output(4);
    let joint = loaded.joint_of_node[2].unwrap();
    let scale = squash_jacobian(loaded.character.skeleton.joints[joint].position()).determinant().cbrt();
    for tangent in &back[0..3] {
        assert!((f64::from(*tangent) - scale).abs() < 1e-6);
    }
    assert!((f64::from(back[4]) - written.json["nodes"][2]["translation"][1].as_f64().unwrap()).abs() < 1e-6);
}

#[test]
fn an_animation_channel_without_a_node_moves_nothing_and_is_kept() {
    let mut made = figure();
    let times = made.floats("SCALAR", 1, &[0.0, 1.0]);
    let places = made.floats("VEC3", 3, &[0.0, 0.9, 0.0, 0.0, 0.5, 1.0]);
    let others = made.floats("VEC3", 3, &[0.0, 1.0, 0.0, 0.0, 2.0, 1.0]);
    // The second is glTF's own way to leave a channel to an extension; the third names no node either.
    made.json["animations"] = json!([{
        "samplers": [{"input": times, "output": places}, {"input": times, "output": others}],
        "channels": [
            {"sampler": 0, "target": {"node": 1, "path": "translation"}},
            {"sampler": 1, "target": {"path": "pointer", "extensions":
                {"KHR_animation_pointer": {"pointer": "/materials/0/emissiveFactor"}}}},
            {"sampler": 1, "target": {"path": "translation"}},
        ],
    }]);
    let loaded = loaded(&made);
    let written = squashed(&loaded);
    let (before, after) = (&made.json["animations"][0], &written.json["animations"][0]);
    for channel in [1, 2] {
        assert_eq!(after["channels"][channel], before["channels"][channel]);
    }
    assert_eq!(after["samplers"][1], before["samplers"][1]);
    assert_eq!(Reader::new(&written).floats(others, 3, None).unwrap(), [0.0, 1.0, 0.0, 0.0, 2.0, 1.0]);
    let moved = Reader::new(&written).floats(places, 3, None).unwrap();
    assert!((f64::from(moved[1]) - squash(DVec3::new(0.0, 0.9, 0.0)).y).abs() < 1e-6);
}

fn vec3(value: &Value) -> DVec3 {
    DVec3::from_array(std::array::from_fn(|axis| value[axis].as_f64().unwrap()))
}

#[test]
fn springs_and_colliders_of_vrm_1_move_and_scale_and_constraints_stay() {
    let mut made = figure();
    made.json["extensions"]["VRMC_vrm"]["lookAt"] =
        json!({"type": "bone", "offsetFromHeadBone": [0.0, 0.06, 0.1]});
    made.json["extensions"]["VRMC_springBone"] = json!({
        "specVersion": "1.0",
        "colliders": [
            {"node": 3, "shape": {"sphere": {"offset": [0.0, 0.1, 0.05], "radius": 0.1}}},
            {"node": 2, "shape": {"capsule": {"offset": [0.0, 0.0, 0.0], "radius": 0.1, "tail": [0.0, 0.2, 0.0]}},
             "extensions": {"VRMC_springBone_extended_collider": {"specVersion": "1.0", "shape": {
                "plane": {"offset": [0.0, 0.1, 0.0], "normal": [0.0, 1.0, 0.0]}}}}},
        ],
        "colliderGroups": [{"colliders": [0, 1]}],
        "springs": [{"joints": [{"node": 10, "hitRadius": 0.02, "gravityPower": 0.5}, {"node": 11}], "colliderGroups": [0]}],
    });
    made.json["nodes"][11]["extensions"] = json!({"VRMC_node_constraint": {"specVersion": "1.0", "constraint": {"roll": {"source": 10, "rollAxis": "X"}}}});
    made.json["materials"] = json!([{"extensions": {"VRMC_materials_mtoon": {"outlineWidthMode": "worldCoordinates", "outlineWidthFactor": 0.01}}},
        {"extensions": {"VRMC_materials_mtoon": {"outlineWidthMode": "screenCoordinates", "outlineWidthFactor": 0.01}}}]);
    let loaded = loaded(&made);
    assert!(unchanged(&loaded).json == loaded.file.json);
    let written = squashed(&loaded);
    let springs = &written.json["extensions"]["VRMC_springBone"];
    let head = DVec3::new(0.0, 1.5, 0.0);
    let centre = head + DVec3::new(0.0, 0.1, 0.05);
    let sphere = &springs["colliders"][0]["shape"]["sphere"];
    assert!((vec3(&sphere["offset"]) - (squash(centre) - squash(head))).length() < 1e-6);
    let scale = squash_jacobian(centre).determinant().cbrt();
    assert!((sphere["radius"].as_f64().unwrap() - 0.1 * scale).abs() < 1e-6);
    let capsule = &springs["colliders"][1]["shape"]["capsule"];
    let back = DVec3::new(0.0, 1.1, 0.0);
    assert!((vec3(&capsule["tail"]) - (squash(back + DVec3::Y * 0.2) - squash(back))).length() < 1e-6);
    let plane = &springs["colliders"][1]["extensions"]["VRMC_springBone_extended_collider"]["shape"]["plane"];
    assert!((vec3(&plane["normal"]) - DVec3::Y).length() < 1e-6);
    assert!((vec3(&plane["offset"]) - (squash(back + DVec3::Y * 0.1) - squash(back))).length() < 1e-6);
    let strand = squash_jacobian(DVec3::new(0.0, 1.6, -0.1)).determinant().cbrt();
    let joint = &springs["springs"][0]["joints"][0];
    for (key, before) in [("hitRadius", 0.02), ("stiffness", 1.0)] {
        assert!((joint[key].as_f64().unwrap() - before * strand).abs() < 1e-6, "{key}");
    }
    let pulls = [0.5, joint["gravityPower"].as_f64().unwrap() / joint["stiffness"].as_f64().unwrap()];
    bends_as_before(pulls);
    assert_eq!(
        springs["colliderGroups"],
        loaded.file.json["extensions"]["VRMC_springBone"]["colliderGroups"]
    );
    assert_eq!(written.json["nodes"][11]["extensions"], loaded.file.json["nodes"][11]["extensions"]);
    let eyes = head + DVec3::new(0.0, 0.06, 0.1);
    let offset = vec3(&written.json["extensions"]["VRMC_vrm"]["lookAt"]["offsetFromHeadBone"]);
    assert!((offset - (squash(eyes) - squash(head))).length() < 1e-6);
    assert_eq!(
        written.json["extensions"]["VRMC_vrm"]["meta"],
        loaded.file.json["extensions"]["VRMC_vrm"]["meta"]
    );
    let width = |material: usize| {
        written.json["materials"][material]["extensions"]["VRMC_materials_mtoon"]["outlineWidthFactor"]
            .as_f64()
            .unwrap()
    };
    let (low, high) = (squash(DVec3::Y * -0.05).y, squash(DVec3::Y * 1.65).y);
    assert!((width(0) - 0.01 * (high - low) / 1.7).abs() < 1e-6);
    assert_eq!(width(1), 0.01);
}

/// The strand comes to stand off further: gravity over stiffness, before and after, bend it by the same angle where they balance.
fn bends_as_before(pulls: [f64; 2]) {
    let [start, end] = [DVec3::new(0.0, 1.6, -0.1), DVec3::new(0.0, 1.3, -0.15)];
    let bones = [end - start, squash(end) - squash(start)].map(DVec3::normalize);
    assert!(bones[1].angle_between(DVec3::NEG_Y) > bones[0].angle_between(DVec3::NEG_Y) + 0.05);
    let [before, after] = [0, 1].map(|at| bones[at].angle_between(bones[at] + pulls[at] * DVec3::NEG_Y));
    assert!((before - after).abs() < 1e-6, "{before} {after}");
    assert!(pulls[1] < 0.9 * pulls[0]);
}

#[test]
fn springs_and_the_viewpoint_of_vrm_0_have_z_negated() {
    let mut made = figure();
    let bones: Vec<Value> = (JOINTS.iter().enumerate())
        .filter(|(_, joint)| !joint.1.is_empty())
        .map(|(node, joint)| json!({"bone": joint.1, "node": node}))
        .chain([json!({"bone": "jaw", "node": -1})])
        .collect();
    made.json["extensions"] = json!({"VRM": {
        "humanoid": {"humanBones": bones},
        "firstPerson": {"firstPersonBone": 3, "firstPersonBoneOffset": {"x": 0.0, "y": 0.06, "z": 0.1}},
        "secondaryAnimation": {
            "boneGroups": [{"bones": [10], "hitRadius": 0.02, "stiffiness": 1.0, "gravityPower": 0.1, "dragForce": 0.4, "colliderGroups": [0]}],
            "colliderGroups": [{"node": 3, "colliders": [{"offset": {"x": 0.02, "y": 0.1, "z": 0.05}, "radius": 0.1}]}],
        },
        "materialProperties": [
            {"floatProperties": {"_OutlineWidthMode": 1, "_OutlineWidth": 0.5}},
            {"floatProperties": {"_OutlineWidthMode": 2, "_OutlineWidth": 0.5}},
        ],
        "meta": {"title": "Made"},
    }});
    let loaded = loaded(&made);
    assert_eq!(
        loaded.character.humanoid.joint(superdeform::Role::Head).map(|joint| loaded.node_of_joint[joint]),
        Some(3)
    );
    assert!(unchanged(&loaded).json == loaded.file.json);
    let written = squashed(&loaded);
    let vrm = &written.json["extensions"]["VRM"];
    let head = DVec3::new(0.0, 1.5, 0.0);
    let moved = |x: f64, y: f64, z: f64| {
        (squash(head + DVec3::new(x, y, -z)) - squash(head)) * DVec3::new(1.0, 1.0, -1.0)
    };
    let read = |value: &Value| {
        DVec3::new(value["x"].as_f64().unwrap(), value["y"].as_f64().unwrap(), value["z"].as_f64().unwrap())
    };
    assert!((read(&vrm["firstPerson"]["firstPersonBoneOffset"]) - moved(0.0, 0.06, 0.1)).length() < 1e-6);
    let collider = &vrm["secondaryAnimation"]["colliderGroups"][0]["colliders"][0];
    assert!((read(&collider["offset"]) - moved(0.02, 0.1, 0.05)).length() < 1e-6);
    let scale = |p: DVec3| squash_jacobian(p).determinant().cbrt();
    assert!(
        (collider["radius"].as_f64().unwrap() - 0.1 * scale(head + DVec3::new(0.02, 0.1, -0.05))).abs()
            < 1e-6
    );
    let chain = (scale(DVec3::new(0.0, 1.6, -0.1)) + scale(DVec3::new(0.0, 1.3, -0.15))) / 2.0;
    let group = &vrm["secondaryAnimation"]["boneGroups"][0];
    assert!((group["stiffiness"].as_f64().unwrap() - chain).abs() < 1e-6);
    bends_as_before([0.1, group["gravityPower"].as_f64().unwrap() / group["stiffiness"].as_f64().unwrap()]);
    assert_eq!(group["dragForce"], json!(0.4));
    assert!(vrm["materialProperties"][0]["floatProperties"]["_OutlineWidth"].as_f64().unwrap() < 0.4);
    assert_eq!(vrm["materialProperties"][1]["floatProperties"]["_OutlineWidth"], json!(0.5));
    assert_eq!(vrm["meta"], loaded.file.json["extensions"]["VRM"]["meta"]);
}

#[test]
fn a_licence_that_prohibits_changes_is_told() {
    let mut made = figure();
    made.json["extensions"]["VRMC_vrm"]["meta"].as_object_mut().unwrap().remove("modification");
    assert!(loaded(&made).warnings.iter().any(|warning| warning.code == "modification_prohibited"));
    assert!(loaded(&figure()).warnings.is_empty());
    // Changes for oneself alone.
    made.json["extensions"]["VRMC_vrm"]["meta"]["modification"] = json!("allowModification");
    assert!(loaded(&made).warnings.iter().any(|warning| warning.code == "redistribution_prohibited"));
}

#[test]
fn a_map_names_roles_in_three_spellings() {
    let mut made = figure();
    made.json.as_object_mut().unwrap().remove("extensions");
    let file = GltfFile::parse("made.glb", &made.bytes()).unwrap();
    let error = load(file.clone(), &LoadOptions::default()).unwrap_err();
    assert_eq!(error.message, "made.glb shows no joint for the role hips: name one");
    assert_eq!(error.option, Some("humanoid"));
    let map = json!({"hips": "pelvis", "HEAD": "skull", "Left Upper Leg": "thigh.L", "RightUpperLeg": "thigh.R",
        "leftUpperArm": "arm.L", "rightUpperArm": "arm.R", "Left Thumb Proximal": "strand", "LeftThumbIntermediate": "strand end"});
    let options = LoadOptions { humanoid_map: Some(&map), ..LoadOptions::default() };
    let loaded = load(file.clone(), &options).unwrap();
    let node = |role| loaded.character.humanoid.joint(role).map(|joint| loaded.node_of_joint[joint]);
    assert_eq!(node(superdeform::Role::LeftUpperLeg), Some(6));
    assert_eq!(node(superdeform::Role::LeftThumbMetacarpal), Some(10));
    assert_eq!(node(superdeform::Role::LeftThumbProximal), Some(11));
    let map = json!({"hips": "pelvi"});
    let options = LoadOptions { humanoid_map: Some(&map), ..LoadOptions::default() };
    assert!(load(file, &options).unwrap_err().message.contains("\"pelvi\""));
}

/// Nodes that are called like joints, where nothing hangs from most of them, are no rig; pieces that hang from them are moved by
/// it.
#[test]
fn without_skins_a_rig_is_what_moves_something() {
    let mut file = GltfFile::read(&samples::data().join("kaykit_rogue.glb")).unwrap();
    let options = LoadOptions { find_roles: Some(&superdeform::find_roles), ..LoadOptions::default() };
    assert!(load(file.clone(), &options).unwrap().rigged);
    file.json.as_object_mut().unwrap().remove("skins");
    let nodes = file.json["nodes"].as_array_mut().unwrap();
    nodes.iter_mut().for_each(|node| drop(node.as_object_mut().unwrap().remove("skin")));
    let loaded = load(file.clone(), &options).unwrap();
    assert!(!loaded.rigged && loaded.character.skeleton.joints.is_empty());
    // The same meshes, now children of joints, two here and two there.
    let nodes = file.json["nodes"].as_array_mut().unwrap();
    let named = |nodes: &[Value], name: &str| nodes.iter().position(|node| node["name"] == name).unwrap();
    let shown: Vec<usize> = (0..nodes.len()).filter(|&node| nodes[node].get("mesh").is_some()).collect();
    for node in nodes.iter_mut() {
        if let Some(children) = node["children"].as_array_mut() {
            children.retain(|child| !shown.contains(&(child.as_u64().unwrap() as usize)));
        }
        if node["children"].as_array().is_none_or(|children| children.is_empty()) {
            node.as_object_mut().unwrap().remove("children");
        }
    }
    for (index, shown) in shown.iter().enumerate() {
        let joint = named(nodes, ["upperarm.l", "head"][index % 2]);
        let mut children = nodes[joint]["children"].as_array().cloned().unwrap_or_default();
        children.push(json!(shown));
        nodes[joint]["children"] = json!(children);
    }
    assert!(load(file, &options).unwrap().rigged);
}

#[test]
fn a_map_may_number_nodes_of_one_name() {
    let mut made = figure();
    made.json.as_object_mut().unwrap().remove("extensions");
    made.json["nodes"][12]["name"] = json!("skull");
    let map = json!({"hips": "pelvis", "head": "skull 1", "leftUpperLeg": "thigh.L", "rightUpperLeg": "thigh.R",
        "leftUpperArm": "arm.L", "rightUpperArm": "arm.R"});
    let options = LoadOptions { humanoid_map: Some(&map), ..LoadOptions::default() };
    let loaded = load(GltfFile::parse("made.glb", &made.bytes()).unwrap(), &options).unwrap();
    let head = loaded.character.humanoid.joint(superdeform::Role::Head).unwrap();
    assert_eq!(loaded.node_of_joint[head], 3);
}

#[test]
fn kinds_come_from_patterns_first_and_hair_hangs_from_the_head() {
    let mut made = figure();
    made.json["meshes"][0]["name"] = json!("Hair");
    // The boxes of all joints: not a matter of the head.
    assert_eq!(loaded(&made).character.meshes[0].kind, None);
    let count = boxes().1.len();
    let joints = made.accessor(&[3u8, 0, 0, 0].repeat(count), 5121, "VEC4", count);
    made.json["meshes"][0]["primitives"][0]["attributes"]["JOINTS_0"] = json!(joints);
    assert_eq!(loaded(&made).character.meshes[0].kind, Some(MeshKind::Hair));
    let patterns = [(MeshKind::Accessory, regex_lite::Regex::new("(?i)^figure\\|hair").unwrap())];
    let options = LoadOptions { kinds: &patterns, ..LoadOptions::default() };
    let file = GltfFile::parse("made.glb", &made.bytes()).unwrap();
    assert_eq!(load(file, &options).unwrap().character.meshes[0].kind, Some(MeshKind::Accessory));
}

#[test]
fn a_material_called_body_that_all_meshes_share_says_nothing_of_teeth_and_hair_bands() {
    let mut made = figure();
    let count = boxes().1.len();
    made.json["materials"] = json!([{"name": "Avatar_Body"}]);
    made.json["meshes"][0]["primitives"][0]["material"] = json!(0);
    // Node and mesh, the joint that holds it (3 is the head), and what it is.
    let things = [
        ("teeth", "teeth", 3, MeshKind::FacePart),
        ("Cube.001", "hair_band", 3, MeshKind::Accessory),
        ("ponytail", "Plane", 3, MeshKind::Hair),
        // Shoes of a material for eyes, say: no part of a face, whatever their name is.
        ("eyes", "eyes", 0, MeshKind::Body),
    ];
    for (node, mesh, joint, _) in things {
        let joints = made.accessor(&[joint; 4].repeat(count), 5121, "VEC4", count);
        let mut copy = made.json["meshes"][0].clone();
        copy["name"] = json!(mesh);
        copy["primitives"][0]["attributes"]["JOINTS_0"] = json!(joints);
        let mesh = made.push("meshes", copy);
        let node = made.push("nodes", json!({"name": node, "mesh": mesh, "skin": 0}));
        made.json["scenes"][0]["nodes"].as_array_mut().unwrap().push(json!(node));
    }
    let loaded = loaded(&made);
    let kinds: Vec<Option<MeshKind>> = loaded.character.meshes.iter().map(|mesh| mesh.kind).collect();
    let wanted = things.map(|(.., kind)| Some(kind));
    assert_eq!(kinds[0], Some(MeshKind::Body));
    assert_eq!(kinds[1..], wanted);
    let told = loaded.warnings.iter().find(|warning| warning.code == "kind_guessed").unwrap();
    assert!(
        told.message.ends_with("teeth (face part), hair_band (accessory), Plane (hair)"),
        "{}",
        told.message
    );
}

#[test]
fn gltf_with_embedded_buffers_becomes_one_buffer() {
    let made = figure();
    let mut json = made.json.clone();
    let letters = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut text = String::new();
    for three in made.binary.chunks(3) {
        let bits =
            three.iter().fold(0u32, |bits, &byte| bits << 8 | u32::from(byte)) << (8 * (3 - three.len()));
        for place in 0..=three.len() {
            text.push(letters[(bits >> (18 - 6 * place) & 63) as usize] as char);
        }
    }
    json["buffers"] = json!([{"byteLength": made.binary.len(), "uri": format!("data:application/octet-stream;base64,{text}")}]);
    let file = GltfFile::parse("made.gltf", &serde_json::to_vec(&json).unwrap()).unwrap();
    assert_eq!(file.binary, made.binary);
    squashed(&load(file, &LoadOptions::default()).unwrap());
}

#[test]
fn pictures_that_only_an_extension_names_are_no_hindrance() {
    let mut made = figure();
    let picture = made.view(b"RIFF");
    made.json["images"] = json!([{"bufferView": picture, "mimeType": "image/webp"}]);
    made.json["textures"] = json!([{"extensions": {"EXT_texture_webp": {"source": 0}}}]);
    made.push("scenes", json!({"name": "empty"}));
    made.json["extensionsRequired"] = json!(["EXT_texture_webp"]);
    let written = squashed(&loaded(&made));
    assert_eq!(written.json["textures"], made.json["textures"]);
}

#[test]
fn a_file_is_written_whole_or_not_at_all() {
    let folder = std::env::temp_dir().join(format!("superdeform-files-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    write_atomically(&folder.join("a.glb"), b"whole").unwrap();
    assert!(write_atomically(&folder, b"whole").is_err());
    assert!(write_atomically(&folder.join("missing/a.glb"), b"whole").is_err());
    let left: BTreeMap<_, _> =
        std::fs::read_dir(&folder).unwrap().map(|e| (e.unwrap().file_name(), ())).collect();
    assert_eq!(left.len(), 1);
    std::fs::remove_dir_all(&folder).unwrap();
}

/// What is written of a file at two and a half heads, and what its report says of the paint around its eyes.
fn evened(file: &GltfFile, even_eyes: Option<f64>) -> (GltfFile, EvenEyes) {
    let bytes = file.to_bytes().unwrap();
    let source = Source { name: &file.name, bytes: &bytes, beside: &|_| None };
    let mut conversion = Conversion::open(source, &OpenOptions::default(), &mut Progress::none()).unwrap();
    conversion.set(&Style::heads(2.5).unwrap(), &Options::default(), &mut Progress::none()).unwrap();
    let options = WriteOptions { even_eyes, ..WriteOptions::default() };
    let converted = conversion.write(None, &options).unwrap();
    (GltfFile::parse("written.glb", &converted.file.to_bytes().unwrap()).unwrap(), converted.even_eyes)
}

fn images(file: &GltfFile) -> Vec<Vec<u8>> {
    (0..file.list("images").len()).map(|index| file.image(index).unwrap().into_owned()).collect()
}

#[test]
fn paint_around_the_eyes_of_a_photo_is_evened_and_all_else_on_its_image_stays() {
    let Some(path) = samples::path("valid_hispanic_f_2_casual.glb") else { return };
    let file = GltfFile::read(&path).unwrap();
    let (none, told) = evened(&file, Some(0.0));
    assert!(images(&none) == images(&file) && told.texels == 0 && told.because.is_some(), "{told:?}");
    let (written, told) = evened(&file, None);
    assert_eq!((told.share, told.taken_for, told.because), (0.8, Some("photo"), None));
    // Image 0 is the normal map.
    assert!(images(&written)[0] == images(&file)[0]);
    let picture = |file: &GltfFile| Image::decode(&file.image(1).unwrap()).unwrap();
    let (before, after) = (picture(&file), picture(&written));
    assert!(
        written.image(1).unwrap().starts_with(b"\x89PNG")
            && written.list("images")[1]["mimeType"] == "image/png"
    );
    assert_eq!((before.width, before.height()), (after.width, after.height()));
    let changed = before.pixels.iter().zip(&after.pixels).filter(|(before, after)| before != after).count();
    // Two ellipses of half a width of .2 and half a height of .12, on 190 texels a head length, are 5,400.
    assert!(changed == told.texels && (2000..6500).contains(&changed), "{changed}");
    // What other meshes show of it: eyes, teeth.
    let source = loaded_file(&file);
    let seen = Appearance::of(&source, 1);
    for (mesh, surface) in source.character.meshes.iter().zip(&seen.surfaces) {
        if mesh.name.contains("H_DDS") {
            continue;
        }
        for corners in &mesh.triangles {
            let [u, v] =
                [0, 1].map(|axis| corners.iter().map(|&c| surface.uvs[c as usize][axis]).sum::<f32>() / 3.0);
            let (x, y) = ((u * before.width as f32) as usize, (v * before.height() as f32) as usize);
            assert_eq!(before.at(x, y), after.at(x, y), "{}", mesh.name);
        }
    }
    // Two materials that share an image, and a texture for each.
    let mut shared = file.clone();
    let mut material = shared.json["materials"][0].clone();
    material["pbrMetallicRoughness"]["baseColorTexture"]["index"] = json!(shared.list("textures").len());
    let number = shared.list("materials").len();
    shared.json["materials"].as_array_mut().unwrap().push(material);
    shared.json["textures"].as_array_mut().unwrap().push(json!({"source": 1}));
    for mesh in 1..shared.list("meshes").len() {
        shared.json["meshes"][mesh]["primitives"][0]["material"] = json!(number);
    }
    let (both, of_both) = evened(&shared, None);
    assert!(images(&both) == images(&written) && of_both == told);
    // Another format of the same image would be shown in its place.
    shared.json["textures"][0]["extensions"] = json!({"EXT_texture_webp": {"source": 1}});
    let (other, told) = evened(&shared, None);
    assert!(images(&other) == images(&file) && told.because.unwrap().contains("format"), "{told:?}");
}

#[test]
fn drawn_faces_and_plain_ones_keep_their_images() {
    let names = [
        "kaykit_rogue.glb",
        "godette.vrm",
        "seedsan_vrm1.vrm",
        "quaternius_knight.glb",
        "makehuman_female_vrm1.vrm",
    ];
    for path in names.iter().filter_map(|name| samples::path(name)) {
        let file = GltfFile::read(&path).unwrap();
        for share in [None, Some(1.0)] {
            let (written, told) = evened(&file, share);
            assert!(images(&written) == images(&file), "{}", file.name);
            assert!(told.texels == 0 && told.because.is_some(), "{}: {told:?}", file.name);
        }
    }
}

fn loaded_file(file: &GltfFile) -> Loaded {
    let options = LoadOptions { find_roles: Some(&superdeform::find_roles), ..LoadOptions::default() };
    load(file.clone(), &options).unwrap()
}
