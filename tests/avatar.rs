//! What keeps an avatar alive: its springs, its chains, its colliders, its expressions and its licence.
//!
//! The list of what must survive a conversion, line by line, and the tests that say so; those without a file are here.
//!
//! | Line | What | Test |
//! | --- | --- | --- |
//! | 1 | counts, order, texture coordinates, materials, names | `files.rs`: a_changed_character_keeps_all_but_its_shape |
//! | 2, 3, 4 | roles, hierarchy; no new turn or scale | line_02_to_04 |
//! | 5, 8 | finite numbers; skins shared as before | line_05_and_08; errors of a validator: `.ci/test` |
//! | 6 | the rest pose is the bind pose | `files.rs`: the_rest_pose_is_the_bind_pose_where_the_nodes_kick; `Run::closure` in `people.rs` |
//! | 7 | weights bit for bit | `files.rs`: a_changed_character_keeps_all_but_its_shape |
//! | 9 | chains move with their strands | line_09 |
//! | 10 | twist joints keep their share of the way | line_10 |
//! | 11, 12 | a morph target is D(v + d) - D(v), 0 where d is | line_11_and_12 |
//! | 13 | eyes and mouths close | `eyelids.rs` |
//! | 14, 17, 18, 19 | normals, seams, tangents | `product/models.rs`, `people.rs`; tangents' sides: `equations.rs` |
//! | 15 | two morph targets at once | line_15 |
//! | 16 | eyes, brows and teeth go with the face | `face.rs`: no_head_folds; `people.rs` |
//! | 20, 21, 22 | springs' radius, stiffness, gravity | `files.rs`: springs_and_colliders_of_vrm_1, springs_and_the_viewpoint_of_vrm_0 |
//! | 23, 24 | colliders as thick as the mesh; inside ones and planes | line_23; line_24_28_32_and_38 |
//! | 25 | last bones of VRM 0.x | line_25 |
//! | 26 | no spring starts inside a collider | line_26 |
//! | 27 | eye joints in their eyes; viewpoint | line_27; `files.rs`: springs_and_the_viewpoint_of_vrm_0 |
//! | 28 | range maps | line_24_28_32_and_38; `files.rs`: springs_and_the_viewpoint_of_vrm_0 |
//! | 29 | first-person flags | line_29 |
//! | 30 | VRChat's viewpoint | not here: it is a component of Unity's, tested in `unity/Tests~` |
//! | 31 | outlines in world units | `files.rs`: springs_and_the_viewpoint_of_vrm_0 |
//! | 32, 38 | textures, and all that nobody knows | line_24_28_32_and_38; `files.rs`: a_changed_character_keeps_all_but_its_shape |
//! | 33 | aims | line_33 |
//! | 34, 35 | soles on the ground; arms, symmetry | line_34; `laws`: mirroring_the_character_mirrors_the_result |
//! | 36 | soles in a walk | `clips.rs`: the file's own clips; walks from elsewhere have a figure in the report |
//! | 37 | licences | `host/src/licence.rs`, the command line's own tests |

#[path = "common/avatars.rs"]
mod avatars;
#[path = "common/models.rs"]
mod common;
#[allow(dead_code)]
mod made;
#[path = "common/people.rs"]
mod people;
#[path = "common/rich.rs"]
mod rich;

use common::{check_all, in_parallel, loaded, models};
use glam::DVec3;
use made::{figure, squash_point};
use serde_json::{Value, json};
use std::sync::{Arc, OnceLock};
use superdeform::internals::geometry::foot;
use superdeform::{Character, Deformed, Deformer, Options, Role, Style, Weights};
use superdeform_host::file::GltfFile;
use superdeform_host::leg_colliders::guard_legs;
use superdeform_host::load::Loaded;
use superdeform_host::write::colliders::{add_leaf_joints, aim_turn, findings};
use superdeform_host::write::rewrite;
use superdeform_host::{array_at, index_at};

/// A model at two and a half heads.
struct Run {
    name: &'static str,
    loaded: &'static Loaded,
    deformer: Deformer,
    deformed: Deformed,
}

impl Run {
    fn written(&self) -> GltfFile {
        let map = |joint: usize, point: DVec3| self.deformer.map(joint, point);
        let written = rewrite(self.loaded, &self.deformed, &map).unwrap();
        GltfFile::parse(self.name, &written.to_bytes().unwrap()).unwrap()
    }
}

/// Every model that has a rig.
fn runs() -> &'static [Run] {
    static RUNS: OnceLock<Vec<Run>> = OnceLock::new();
    let all = models();
    RUNS.get_or_init(|| {
        let items: Vec<(&'static str, &'static Loaded)> =
            all.iter().map(|(name, loaded)| (name.as_str(), loaded)).collect();
        in_parallel(&items, |&(name, loaded)| {
            let style = Style::heads(2.5).unwrap();
            let options = Options { thread_count: 1, ..Options::default() };
            let deformer = Deformer::new(Arc::new(loaded.character.clone()), &style, &options)
                .unwrap_or_else(|error| panic!("{name}: {error}"));
            let deformed = deformer.apply();
            Run { name, loaded, deformer, deformed }
        })
    })
}

/// How far each joint without a role has left the mesh that it moves, as a share of the result's height, with its name.
///
/// Of the six nearest vertices that a joint moves, those joints count that have one within 2 % of the height. What is
/// around the joint is allowed to change as the field does there.
fn strayed(character: &Character, deformer: &Deformer, deformed: &Deformed) -> Vec<(f64, String)> {
    let height = |positions: &mut dyn Iterator<Item = f64>| {
        let (low, high) =
            positions.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), y| (low.min(y), high.max(y)));
        high - low
    };
    let up = character.axes.up.as_dvec3();
    let old = |mesh: usize, vertex: usize| character.meshes[mesh].positions[vertex].as_dvec3();
    let new = |mesh: usize, vertex: usize| deformed.meshes[mesh].positions[vertex].as_dvec3();
    let before =
        height(&mut character.meshes.iter().flat_map(|mesh| &mesh.positions).map(|p| p.as_dvec3().dot(up)));
    let after =
        height(&mut deformed.meshes.iter().flat_map(|mesh| &mesh.positions).map(|p| p.as_dvec3().dot(up)));
    let mut moved: Vec<Vec<(usize, usize)>> = vec![Vec::new(); character.skeleton.joints.len()];
    for (mesh, content) in character.meshes.iter().enumerate() {
        for (vertex, row) in content.weights.rows().enumerate() {
            for &(joint, _) in row.iter().filter(|influence| influence.1 > 0.05) {
                moved[joint as usize].push((mesh, vertex));
            }
        }
    }
    let mut found = Vec::new();
    for (joint, mut vertices) in moved.into_iter().enumerate() {
        if character.humanoid.iter().any(|(_, other)| other == joint) {
            continue;
        }
        let place = character.skeleton.joints[joint].position();
        vertices.sort_by(|&(a, b), &(c, d)| {
            old(a, b).distance_squared(place).total_cmp(&old(c, d).distance_squared(place))
        });
        vertices.truncate(6);
        let Some(&(mesh, vertex)) = vertices.first() else { continue };
        if old(mesh, vertex).distance(place) > 0.02 * before {
            continue;
        }
        let count = vertices.len() as f64;
        let from: DVec3 = vertices.iter().map(|&(mesh, vertex)| old(mesh, vertex)).sum::<DVec3>() / count;
        let to: DVec3 = vertices.iter().map(|&(mesh, vertex)| new(mesh, vertex)).sum::<DVec3>() / count;
        let around = deformer.map(joint, place).jacobian;
        let error = (deformed.joints[joint] - to - around * (place - from)).length() / after;
        found.push((error, character.skeleton.joints[joint].name.clone()));
    }
    found
}

fn deformed_person(character: Character) -> (Deformer, Deformed) {
    let style = Style::heads(2.5).unwrap();
    let deformer = Deformer::new(Arc::new(character), &style, &Options::default()).unwrap();
    let deformed = deformer.apply();
    (deformer, deformed)
}

#[test]
fn line_09_a_chain_stays_in_the_skirt_that_it_moves() {
    let (character, chains) = avatars::skirted();
    let (deformer, deformed) = deformed_person(character.clone());
    let strayed = strayed(&character, &deformer, &deformed);
    assert!(strayed.len() >= chains.len() * 3, "only {} joints stand in the cloth", strayed.len());
    for (error, name) in strayed {
        assert!(error <= 0.01, "{name} left the cloth by {error:.4} H");
    }
}

/// Half the breadth of the lowest ring of the skirt, and its height.
fn hem(character: &Character, deformed: &Deformed) -> (f64, f64) {
    let skirt = character.meshes.iter().position(|mesh| mesh.name == "skirt").unwrap();
    let rest = &character.meshes[skirt].positions;
    let lowest = rest.iter().map(|p| p.y).fold(f32::INFINITY, f32::min);
    let ring = rest.iter().zip(&deformed.meshes[skirt].positions).filter(|(p, _)| p.y < lowest + 1e-4);
    let ring: Vec<DVec3> = ring.map(|(_, to)| to.as_dvec3()).collect();
    let breadth = ring.iter().map(|p| p.x.abs()).fold(0.0, f64::max);
    (breadth, ring.iter().map(|p| p.y).sum::<f64>() / ring.len() as f64)
}

#[test]
fn line_09_a_skirt_on_chains_hangs_like_one_with_weights_to_the_legs() {
    let (on_chains, _) = avatars::skirted();
    let mut on_legs = on_chains.clone();
    let joint = |role| on_chains.humanoid.joint(role).unwrap();
    let (left, right) = (joint(Role::LeftUpperLeg), joint(Role::RightUpperLeg));
    let (hip, apart) =
        (on_chains.skeleton.joints[left].position(), on_chains.skeleton.joints[left].position().x.abs());
    let skirt = on_legs.meshes.iter_mut().find(|mesh| mesh.name == "skirt").unwrap();
    let rows = skirt.positions.iter().map(|p| {
        let of_legs = ((hip.y as f32 - p.y) / 0.1).clamp(0.0, 1.0);
        // Left is +x, as the left hip says.
        let of_left = (0.5 + 0.5 * p.x * hip.x.signum() as f32 / apart as f32).clamp(0.0, 1.0);
        vec![
            (joint(Role::Hips) as u32, 1.0 - of_legs),
            (left as u32, of_legs * of_left),
            (right as u32, of_legs * (1.0 - of_left)),
        ]
    });
    skirt.weights = Weights::from_rows(rows.collect::<Vec<_>>());
    let (_, chained) = deformed_person(on_chains.clone());
    let (_, legged) = deformed_person(on_legs.clone());
    let ((breadth, height), (wanted, at)) = (hem(&on_chains, &chained), hem(&on_legs, &legged));
    assert!(
        (breadth / wanted - 1.0).abs() < 0.1,
        "the hem is {breadth:.4} to each side instead of {wanted:.4}"
    );
    assert!((height / at - 1.0).abs() < 0.1, "the hem is {height:.4} high instead of {at:.4}");
}

#[test]
fn line_09_a_plug_stays_on_its_cord() {
    let (character, _) = avatars::plugged();
    let (deformer, deformed) = deformed_person(character.clone());
    let mesh = |name: &str| character.meshes.iter().position(|mesh| mesh.name == name).unwrap();
    let gap = |of: &dyn Fn(usize, usize) -> DVec3| {
        let points =
            |mesh: usize| (0..character.meshes[mesh].positions.len()).map(move |vertex| of(mesh, vertex));
        points(mesh("cord"))
            .flat_map(|p| points(mesh("plug")).map(move |q| p.distance(q)))
            .fold(f64::INFINITY, f64::min)
    };
    let before = gap(&|mesh, vertex| character.meshes[mesh].positions[vertex].as_dvec3());
    let after = gap(&|mesh, vertex| deformed.meshes[mesh].positions[vertex].as_dvec3());
    // The gap is part of the thing that keeps its shape: it grows as that does, here by less than 1.
    assert!(after <= 1.01 * before, "{before} became {after}");
    for (error, name) in strayed(&character, &deformer, &deformed) {
        assert!(error <= 0.01, "{name} left the cord by {error:.4} H");
    }
    // The cord's upper end stays on the chest: it goes where the chest's joint takes it.
    let cord = mesh("cord");
    let chest = character.humanoid.joint(superdeform::Role::Chest).unwrap();
    for (vertex, row) in character.meshes[cord].weights.rows().enumerate() {
        if row.iter().any(|&(joint, _)| joint as usize == chest) {
            let p = character.meshes[cord].positions[vertex].as_dvec3();
            let away =
                deformer.map(chest, p).position.distance(deformed.meshes[cord].positions[vertex].as_dvec3());
            assert!(away < 0.01, "vertex {vertex} left the chest by {away}");
        }
    }
}

#[test]
fn line_09_every_chain_of_every_model_stays_on_its_strand() {
    check_all(runs(), |run| {
        let all = strayed(&run.loaded.character, &run.deformer, &run.deformed);
        let worst = all.iter().map(|(error, _)| *error).fold(0.0, f64::max);
        println!("{}: {} joints, {:.2} % H at most", run.name, all.len(), 100.0 * worst);
        let off = all.iter().filter(|(error, _)| *error > 0.01);
        off.map(|(error, name)| format!("{}: {name} is {:.2} % H off", run.name, 100.0 * error)).collect()
    });
}

#[test]
fn line_02_to_04_the_hierarchy_the_roles_and_all_turns_and_scales_stay() {
    check_all(runs(), |run| {
        let written = run.written();
        let mut wrong = Vec::new();
        for (node, before) in run.loaded.file.list("nodes").iter().enumerate() {
            for key in ["name", "children", "rotation", "scale", "skin"] {
                if before.get(key) != written.list("nodes")[node].get(key) {
                    wrong.push(format!("{}: {key} of node {node} changed", run.name));
                }
            }
        }
        for roles in ["/extensions/VRM/humanoid", "/extensions/VRMC_vrm/humanoid"] {
            if run.loaded.file.json.pointer(roles) != written.json.pointer(roles) {
                wrong.push(format!("{}: roles changed", run.name));
            }
        }
        wrong
    });
}

#[test]
fn line_05_and_08_numbers_are_finite_and_skins_keep_their_joints() {
    check_all(runs(), |run| {
        let written = run.written();
        let again = loaded(written.clone());
        let finite = again.character.meshes.iter().flat_map(|mesh| &mesh.positions).all(|p| p.is_finite());
        let joints = |file: &GltfFile| -> Vec<Value> {
            file.list("skins").iter().map(|skin| skin["joints"].clone()).collect()
        };
        let mut wrong = Vec::new();
        if !finite {
            wrong.push(format!("{}: a position is no number", run.name));
        }
        if joints(&run.loaded.file) != joints(&written) {
            wrong.push(format!("{}: a skin has other joints", run.name));
        }
        wrong
    });
}

#[test]
fn line_34_the_soles_stay_on_their_ground() {
    check_all(runs(), |run| {
        let report = run.deformer.report(&run.deformed).unwrap();
        let (before, after) = (report.target.landmarks.sole, report.result.landmarks.sole);
        let off = (after - before).abs() / report.result.height;
        if off <= 1e-3 { Vec::new() } else { vec![format!("{}: soles moved by {off} H", run.name)] }
    });
}

/// The made figure with a VRM 1.0 spring from its strand and one collider.
fn with_collider(shape: &Value) -> Loaded {
    let mut made = figure();
    made.json["extensionsUsed"] = json!(["VRMC_vrm", "VRMC_springBone"]);
    made.json["extensions"]["VRMC_springBone"] = json!({
        "specVersion": "1.0",
        "colliders": [{"node": 2, "shape": shape}],
        "colliderGroups": [{"colliders": [0]}],
        "springs": [{"joints": [{"node": 10, "hitRadius": 0.02}, {"node": 11}], "colliderGroups": [0]}],
    });
    loaded(GltfFile::parse("made.vrm", &made.bytes()).unwrap())
}

/// The written collider's shape under the squash, and the codes of what is told.
fn squashed_collider(shape: &Value) -> (Value, Vec<&'static str>) {
    let loaded = with_collider(shape);
    let result = made::deformed(&loaded.character, Some(made::squash));
    let written = rewrite(&loaded, &result, &squash_point).unwrap();
    let told = findings(&loaded, &result, &squash_point, false);
    let shape = written.json["extensions"]["VRMC_springBone"]["colliders"][0]["shape"].clone();
    (shape, told.iter().map(|warning| warning.code).collect())
}

#[test]
fn line_23_a_capsule_is_as_thick_as_the_mesh_across_it() {
    let shape = json!({"capsule": {"offset": [0.0, 0.0, 0.0], "tail": [0.0, 0.2, 0.0], "radius": 0.01}});
    let (after, told) = squashed_collider(&shape);
    // The squash widens x and z by 1 + 0.2 y at the axis: at the ends, whose heights are 1.1 and 1.3.
    let expected = 0.01 * ((1.0 + 0.2 * 1.1) * (1.0 + 0.2 * 1.3_f64)).sqrt();
    let radius = after["capsule"]["radius"].as_f64().unwrap();
    assert!((radius - expected).abs() < 1e-6, "{radius}, not {expected}");
    assert!(told.is_empty(), "{told:?}");
}

#[test]
fn line_26_a_spring_that_would_start_inside_makes_its_collider_yield() {
    // The end of the spring is at (0, 1.3, -0.15), 0.02 thick; the joint of the sphere at (0, 1.1, 0).
    let away = DVec3::new(0.0, 0.2, -0.15).length();
    let sphere = |radius: f64| json!({"sphere": {"offset": [0.0, 0.0, 0.0], "radius": radius}});
    let centre = made::squash(DVec3::new(0.0, 1.1, 0.0));
    let end = DVec3::new(0.0, 1.3, -0.15);
    let scale = made::squash_jacobian(end).determinant().cbrt();
    // 0.001 outside, and touching by all of its radius: no nearer and no deeper than that at its new size.
    for apart in [0.001, -0.02] {
        let (after, told) = squashed_collider(&sphere(away - 0.02 - apart));
        assert_eq!(told, ["collider_yields"]);
        let radius = after["sphere"]["radius"].as_f64().unwrap();
        let left = made::squash(end).distance(centre) - 0.02 * scale - radius;
        assert!(
            (left - apart * scale).abs() < 1e-6,
            "the spring is {left} from the sphere that yields to it"
        );
    }
}

/// The made figure as VRM 0.x with springs from its strand; `nodes` are added.
fn vrm0(extension: Value, change: impl Fn(&mut made::Made)) -> Loaded {
    let mut made = figure();
    let bones: Vec<Value> = (made::JOINTS.iter().enumerate())
        .filter(|(_, joint)| !joint.1.is_empty())
        .map(|(node, joint)| json!({"bone": joint.1, "node": node}))
        .collect();
    made.json["extensionsUsed"] = json!(["VRM"]);
    made.json["extensions"] = json!({"VRM": extension});
    made.json["extensions"]["VRM"]["humanoid"] = json!({"humanBones": bones});
    made.json["extensions"]["VRM"]["meta"] = json!({"licenseName": "CC0"});
    change(&mut made);
    loaded(GltfFile::parse("made.vrm", &made.bytes()).unwrap())
}

#[test]
fn line_25_the_last_bone_of_a_vrm_0_chain_is_told_or_gets_its_end() {
    let springs = json!({"secondaryAnimation": {"boneGroups": [{"bones": [10], "hitRadius": 0.02}]}});
    let loaded = vrm0(springs, |_| {});
    let half = |_: usize, point: DVec3| superdeform::Mapped {
        position: 0.5 * point,
        jacobian: glam::DMat3::IDENTITY * 0.5,
    };
    let result = made::deformed(&loaded.character, Some(|p| 0.5 * p));
    let told = findings(&loaded, &result, &half, false);
    assert_eq!(told.len(), 1);
    assert_eq!((told[0].code, told[0].option), ("spring_leaf_length", Some("leaf_joints")));
    assert!(told[0].message.contains("3.5 cm"), "{}", told[0].message);
    assert!(findings(&loaded, &result, &half, true).is_empty());
    let mut written = rewrite(&loaded, &result, &half).unwrap();
    assert_eq!(add_leaf_joints(&mut written, &loaded, &result, &half), 1);
    let end = index_at(&json!({"node": written.list("nodes")[11]["children"][0]}), "node").unwrap();
    let local: Vec<f64> =
        array_at(&written.list("nodes")[end], "translation").iter().filter_map(Value::as_f64).collect();
    assert!((DVec3::from_slice(&local).length() - 0.035).abs() < 1e-6, "{local:?}");
    assert_eq!(array_at(&written.list("nodes")[11], "children").len(), 1);
}

/// A chain of two nodes that hangs from the hips beside the left thigh; their numbers are 13 and 14.
fn hang_a_skirt(made: &mut made::Made) {
    let end = made.push("nodes", json!({"name": "skirt end", "translation": [0.02, -0.3, 0.0]}));
    assert_eq!(end, 13);
    let root =
        made.push("nodes", json!({"name": "skirt", "translation": [0.18, 0.0, 0.0], "children": [end]}));
    made.json["nodes"][1]["children"].as_array_mut().unwrap().push(json!(root));
}

#[test]
fn a_skirt_that_nothing_keeps_out_of_the_legs_is_told_or_gets_colliders() {
    for version in [0, 1] {
        let mut loaded = if version == 0 {
            let springs = json!({"secondaryAnimation": {"boneGroups": [
                {"bones": [14], "hitRadius": 0.02}, {"bones": [10], "hitRadius": 0.02}]}});
            vrm0(springs, hang_a_skirt)
        } else {
            let mut made = figure();
            hang_a_skirt(&mut made);
            made.json["extensionsUsed"] = json!(["VRMC_vrm", "VRMC_springBone"]);
            made.json["extensions"]["VRMC_springBone"] = json!({"specVersion": "1.0", "springs": [
                {"joints": [{"node": 14, "hitRadius": 0.02}, {"node": 13}]},
                {"joints": [{"node": 10, "hitRadius": 0.02}, {"node": 11}]}]});
            loaded(GltfFile::parse("made.vrm", &made.bytes()).unwrap())
        };
        let mut told = loaded.clone();
        guard_legs(&mut told, false);
        let warning = told.warnings.last().unwrap();
        assert_eq!((warning.code, warning.option), ("skirt_without_colliders", Some("leg_colliders")));
        // Hair on the head is no skirt.
        assert!(warning.message.contains(" 1 spring chains"), "{}", warning.message);
        assert_eq!(told.file.json, loaded.file.json);
        guard_legs(&mut loaded, true);
        let json = &loaded.file.json["extensions"];
        let (springs, groups, list) = if version == 0 {
            let all = &json["VRM"]["secondaryAnimation"];
            (array_at(all, "boneGroups"), array_at(all, "colliderGroups"), &[] as &[Value])
        } else {
            let all = &json["VRMC_springBone"];
            (array_at(all, "springs"), array_at(all, "colliderGroups"), array_at(all, "colliders"))
        };
        // The thighs alone: this figure has no feet for its shins to end at.
        let of_group = |group: &Value| match version {
            0 => vec![(index_at(group, "node").unwrap(), array_at(group, "colliders").len())],
            _ => array_at(group, "colliders")
                .iter()
                .map(|collider| (index_at(&list[collider.as_u64().unwrap() as usize], "node").unwrap(), 1))
                .collect(),
        };
        let guards: Vec<(usize, usize)> = groups.iter().flat_map(of_group).collect();
        assert_eq!(guards, if version == 0 { [(6, 4), (7, 4)] } else { [(6, 1), (7, 1)] });
        assert_eq!(springs[0]["colliderGroups"], json!([0, 1]));
        assert!(springs[1].get("colliderGroups").is_none(), "{}", springs[1]);
        let found = superdeform_host::write::colliders::colliders(&loaded);
        assert_eq!(found.len(), if version == 0 { 8 } else { 2 });
        for found in &found {
            let (hip, knee) = (DVec3::new(0.1, 0.85, 0.0), DVec3::new(0.1, 0.45, 0.02));
            let on_left = |p: DVec3| p.with_x(p.x.abs());
            let (nearest, share) = foot(on_left(found.collider.offset), hip, knee);
            assert!((0.0..1.0).contains(&share) && nearest.distance(on_left(found.collider.offset)) < 1e-6);
            // Corners of the boxes around the joints are up to .0866 away.
            assert!((0.03..0.09).contains(&found.collider.radius), "{}", found.collider.radius);
            assert_eq!(found.springs.len(), 1);
        }
        // Once is enough.
        let before = loaded.file.json.clone();
        guard_legs(&mut loaded, true);
        assert_eq!(loaded.file.json, before);
    }
}

#[test]
fn line_29_a_mesh_that_is_doubled_keeps_its_expressions_and_annotations() {
    let extension = json!({
        "blendShapeMaster": {"blendShapeGroups": [{"name": "Joy", "binds": [{"mesh": 1, "index": 0, "weight": 100}]}]},
        "firstPerson": {"meshAnnotations": [{"mesh": 0, "firstPersonFlag": "Auto"}, {"mesh": 1, "firstPersonFlag": "ThirdPersonOnly"}]},
    });
    // A jewel that two joints show, high and low: the squash deforms them differently.
    let loaded = vrm0(extension, |made| {
        let corners = [0.0, 0.0, 0.0, 0.1, 0.0, 0.0, 0.0, 0.1, 0.0];
        let position = made.floats("VEC3", 3, &corners);
        let target = made.floats("VEC3", 3, &[0.01; 9]);
        made.json["accessors"][position]["min"] = json!([0.0, 0.0, 0.0]);
        made.json["accessors"][position]["max"] = json!([0.1, 0.1, 0.0]);
        let indices = made.indices(&[0, 1, 2]);
        made.push(
            "meshes",
            json!({"name": "Jewel", "primitives": [{"attributes": {"POSITION": position}, "indices": indices, "targets": [{"POSITION": target}]}]}),
        );
        for parent in [1, 3] {
            let node = made.push("nodes", json!({"name": "jewel", "mesh": 1}));
            made.json["nodes"][parent]["children"].as_array_mut().unwrap().push(json!(node));
        }
    });
    let result = made::deformed(&loaded.character, Some(made::squash));
    let written = rewrite(&loaded, &result, &squash_point).unwrap();
    let shown: Vec<usize> = written
        .list("nodes")
        .iter()
        .filter(|node| node["name"] == "jewel")
        .filter_map(|node| index_at(node, "mesh"))
        .collect();
    assert_eq!(shown.len(), 2);
    assert_ne!(shown[0], shown[1], "the jewel is doubled");
    let vrm = &written.json["extensions"]["VRM"];
    let meshes = |list: &Value| -> Vec<u64> {
        list.as_array().unwrap().iter().filter_map(|entry| entry["mesh"].as_u64()).collect()
    };
    let binds = meshes(&vrm["blendShapeMaster"]["blendShapeGroups"][0]["binds"]);
    let annotations = &vrm["firstPerson"]["meshAnnotations"];
    for mesh in shown {
        assert!(binds.contains(&(mesh as u64)), "no bind of mesh {mesh}: {binds:?}");
        let own = annotations.as_array().unwrap().iter().find(|entry| entry["mesh"] == mesh).unwrap();
        assert_eq!(own["firstPersonFlag"], "ThirdPersonOnly");
    }
    assert_eq!(binds.len(), 2);
}

#[test]
fn line_33_an_aim_that_looks_another_way_is_told_in_degrees() {
    let mut made = figure();
    let aim = json!({"specVersion": "1.0", "constraint": {"aim": {"source": 4, "aimAxis": "PositiveX"}}});
    made.json["nodes"][11]["extensions"] = json!({"VRMC_node_constraint": aim});
    let loaded = loaded(GltfFile::parse("made.vrm", &made.bytes()).unwrap());
    let told = |map: fn(DVec3) -> DVec3| {
        let result = made::deformed(&loaded.character, Some(map));
        findings(&loaded, &result, &squash_point, false)
    };
    // All the same size: the way to the source keeps its direction.
    assert!(told(|p| 0.5 * p).is_empty());
    let warnings = told(made::squash);
    assert_eq!(warnings.len(), 1);
    assert_eq!(warnings[0].code, "aim_turned");
    assert_eq!(aim_turn(&loaded, &made::deformed(&loaded.character, Some(|p| p))).unwrap().0, 0.0);
    let [from, to] = [11, 4].map(|joint| DVec3::from_array(made::JOINTS[joint].3.map(f64::from)));
    let degrees = (to - from).angle_between(made::squash(to) - made::squash(from)).to_degrees();
    assert!(warnings[0].message.contains(&format!("{degrees:.1} degrees")), "{}", warnings[0].message);
}

#[test]
fn line_10_twist_joints_keep_their_share_of_the_way() {
    // A joint between a limb's ends that has no role of its own and hangs from the limb.
    check_all(runs(), |run| {
        let character = &run.loaded.character;
        let place = |joint: usize| character.skeleton.joints[joint].position();
        let mut wrong = Vec::new();
        for (role, joint) in character.humanoid.iter() {
            // Arms and legs; what lies between a hand and its fingers turns no limb.
            use Role::*;
            let ends = [LeftLowerArm, LeftHand, LeftLowerLeg, LeftFoot];
            if !ends.iter().any(|&end| role == end || role == end.mirrored()) {
                continue;
            }
            let Some(above) = character.humanoid.parent_of(role) else { continue };
            let Some(start) = character.humanoid.joint(above) else { continue };
            let way = place(joint) - place(start);
            let share = |p: DVec3, from: DVec3, way: DVec3| (p - from).dot(way) / way.length_squared();
            for (twist, candidate) in character.skeleton.joints.iter().enumerate() {
                let p = candidate.position();
                let before = share(p, place(start), way);
                let off_axis = (p - place(start) - before * way).length();
                let is_twist = candidate.parent == Some(start)
                    && character.humanoid.iter().all(|(_, other)| other != twist)
                    && (0.1..=0.9).contains(&before)
                    && off_axis < 0.02 * way.length();
                if !is_twist {
                    continue;
                }
                let (new, from) = (run.deformed.joints[twist], run.deformed.joints[start]);
                let after = share(new, from, run.deformed.joints[joint] - from);
                println!("{}: {} {before:.3} -> {after:.3}", run.name, candidate.name);
                if (after - before).abs() > 0.02 {
                    wrong.push(format!(
                        "{}: {} was at {before:.3} and is at {after:.3}",
                        run.name, candidate.name
                    ));
                }
            }
        }
        wrong
    });
}

#[test]
fn line_11_and_12_a_morph_target_is_what_the_field_makes_of_the_way_there() {
    // The made figure's squash is known everywhere.
    let mut made = figure();
    made.json["extensions"]["VRMC_vrm"]["meta"] = json!({});
    let loaded = loaded(GltfFile::parse("made.vrm", &made.bytes()).unwrap());
    let result = made::deformed(&loaded.character, Some(made::squash));
    let written = common::loaded(rewrite(&loaded, &result, &squash_point).unwrap());
    let mut moved = 0;
    for (before, after) in loaded.character.meshes.iter().zip(&written.character.meshes) {
        for (target, new) in before.morph_targets.iter().zip(&after.morph_targets) {
            for (vertex, (delta, got)) in target.positions.iter().zip(&new.positions).enumerate() {
                let p = before.positions[vertex].as_dvec3();
                let expected = made::squash(p + delta.as_dvec3()) - made::squash(p);
                assert!(got.as_dvec3().distance(expected) < 1e-6, "{vertex}: {got}, not {expected}");
                if *delta == glam::Vec3::ZERO {
                    assert_eq!(*got, glam::Vec3::ZERO);
                } else {
                    moved += 1;
                }
            }
        }
    }
    assert!(moved >= 2, "{moved} vertices have deltas");
}

#[test]
fn line_15_two_morph_targets_at_once_have_their_error_in_the_report() {
    let mut with_pairs = 0;
    for run in runs() {
        let report = run.deformer.report(&run.deformed).unwrap();
        let error = report.morph_pair_error;
        let most = run.loaded.character.meshes.iter().map(|mesh| mesh.morph_targets.len()).max().unwrap_or(0);
        println!("{}: {error:.1e} H, up to {most} targets", run.name);
        with_pairs += usize::from(error > 0.0);
        assert!(most > 1 || error == 0.0, "{}: {error} without two targets", run.name);
        // Catbot's targets move its whole face; two of them are never on at once.
        assert!(error < 1e-2, "{}: {error}", run.name);
    }
    assert!(with_pairs > 0 || !superdeform_host::samples::folder().is_dir(), "no pair bends");
}

#[test]
fn line_27_eye_joints_stay_in_their_eyes() {
    check_all(runs(), |run| {
        let character = &run.loaded.character;
        let mut wrong = Vec::new();
        for role in [Role::LeftEye, Role::RightEye] {
            let Some(joint) = character.humanoid.joint(role) else { continue };
            let of = |point: &dyn Fn(usize, usize) -> DVec3| -> Vec<DVec3> {
                let meshes = character.meshes.iter().enumerate();
                meshes
                    .flat_map(|(index, mesh)| {
                        mesh.weights.rows().enumerate().map(move |(vertex, row)| (index, vertex, row))
                    })
                    .filter(|(.., row)| row.iter().any(|&(of, weight)| of as usize == joint && weight > 0.5))
                    .map(|(index, vertex, _)| point(index, vertex))
                    .collect()
            };
            // How far the joint is from the middle of what it turns, in sizes of that.
            let away = |points: &[DVec3], at: DVec3| {
                let middle = points.iter().sum::<DVec3>() / points.len() as f64;
                let squares: f64 = points.iter().map(|p| p.distance_squared(middle)).sum();
                at.distance(middle) / (squares / points.len() as f64).sqrt()
            };
            let before = of(&|mesh, vertex| character.meshes[mesh].positions[vertex].as_dvec3());
            if before.len() < 8 {
                continue;
            }
            let after = of(&|mesh, vertex| run.deformed.meshes[mesh].positions[vertex].as_dvec3());
            let old = away(&before, character.skeleton.joints[joint].position());
            let new = away(&after, run.deformed.joints[joint]);
            println!("{}: {role} {old:.3} -> {new:.3} of an eye's size", run.name);
            if (new - old).abs() > 0.01 * old.max(1.0) {
                wrong
                    .push(format!("{}: {role} was {old:.3} from its eye's middle and is {new:.3}", run.name));
            }
        }
        wrong
    });
}

#[test]
fn line_24_28_32_and_38_all_but_places_and_sizes_stays_in_a_file_that_holds_everything() {
    for look_at in ["bone", "expression"] {
        let loaded = loaded(GltfFile::parse("rich.vrm", &rich::rich(look_at).bytes()).unwrap());
        let result = made::deformed(&loaded.character, Some(made::squash));
        let written = rewrite(&loaded, &result, &squash_point).unwrap();
        let mut found = Vec::new();
        rich::changed(&loaded.file.json, &written.json, "", &mut found);
        let may_change = |place: &str| {
            let is_layout =
                ["/accessors/", "/bufferViews/", "/buffers/"].iter().any(|list| place.starts_with(list));
            let is_place = ["/translation", "/offset", "/tail", "/offsetFromHeadBone"]
                .iter()
                .any(|key| place.contains(key));
            let is_size = ["/radius", "/hitRadius", "/stiffness", "/gravityPower"]
                .iter()
                .any(|key| place.ends_with(key));
            is_layout || ((is_place || is_size) && !place.contains("/expressions/"))
        };
        let strange: Vec<&String> = found.iter().filter(|place| !may_change(place)).collect();
        assert!(strange.is_empty(), "{look_at}: {strange:?}");
        // Every collider has moved or grown, the viewpoint too.
        for collider in 0..5 {
            let place = format!("/extensions/VRMC_springBone/colliders/{collider}/");
            assert!(found.iter().any(|changed| changed.starts_with(&place)), "{place} is as it was");
        }
        assert!(found.iter().any(|place| place.contains("/offsetFromHeadBone")), "{found:?}");
        // A plane looks where it did.
        let plane = &written.json["extensions"]["VRMC_springBone"]["colliders"][4]["extensions"];
        assert_eq!(
            plane["VRMC_springBone_extended_collider"]["shape"]["plane"]["normal"],
            json!([0.0, 1.0, 0.0])
        );
    }
}
