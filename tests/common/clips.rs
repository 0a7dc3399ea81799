//! Clips that are made for any rigged figure: a walk, a run, a jump, and sitting down; and what a viewer would show of them.
//!
//! Hips are as high as the lowest sole needs, so that a figure stands on the floor in its own clips, whatever its proportions.
#![allow(dead_code)]

use glam::{DMat4, DQuat, DVec3};
use serde_json::{Value, json};
use std::collections::BTreeMap;
use superdeform::Role;
use superdeform_host::accessor::Reader;
use superdeform_host::bind::NodeTree;
use superdeform_host::file::GltfFile;
use superdeform_host::load::Loaded;
use superdeform_host::verify::skinned;
use superdeform_host::{array_at, index_at, text_at};

/// Degrees by which a thigh swings forward, a knee bends back and an ankle bends up; and how high the lowest sole is, in legs'
/// lengths.
type Key = ([f64; 3], [f64; 3], f64);

/// Name, seconds, and keys of the left leg, the right one and the height.
pub type Motion = (&'static str, f32, Vec<Key>);

/// Walking. Perry and Burnfield. Gait Analysis: Normal and Pathological Function. 2nd edition, 2010.
const WALK: [[f64; 3]; 8] = [
    [20.0, 5.0, 0.0],
    [20.0, 20.0, -5.0],
    [0.0, 5.0, 5.0],
    [-20.0, 5.0, 10.0],
    [-10.0, 40.0, -15.0],
    [15.0, 60.0, -5.0],
    [25.0, 25.0, 0.0],
    [20.0, 5.0, 0.0],
];
/// Running: made up, with heels that are thrown far up behind.
const RUN: [[f64; 3]; 8] = [
    [35.0, 20.0, 0.0],
    [20.0, 40.0, 15.0],
    [-5.0, 25.0, 10.0],
    [-30.0, 25.0, -20.0],
    [-20.0, 80.0, -20.0],
    [20.0, 110.0, -10.0],
    [50.0, 90.0, 0.0],
    [45.0, 40.0, 0.0],
];
const AIRBORNE: [f64; 8] = [0.0, 0.0, 0.0, 0.12, 0.0, 0.0, 0.0, 0.12];

/// A walk, a run, a jump, sitting down on a chair and on the floor.
pub fn motions() -> Vec<Motion> {
    let cycle = |angles: &[[f64; 3]; 8], heights: &[f64; 8]| {
        (0..=8).map(|key| (angles[key % 8], angles[(key + 4) % 8], heights[key % 8])).collect()
    };
    let both = |key: &([f64; 3], f64)| (key.0, key.0, key.1);
    let jump = [
        ([0.0, 0.0, 0.0], 0.0),
        ([60.0, 90.0, 30.0], 0.0),
        ([0.0, 5.0, -30.0], 0.0),
        ([10.0, 20.0, -30.0], 0.7),
        ([20.0, 30.0, -10.0], 0.0),
        ([70.0, 110.0, 35.0], 0.0),
        ([0.0, 0.0, 0.0], 0.0),
    ];
    let chair = [([0.0, 0.0, 0.0], 0.0), ([90.0, 90.0, 0.0], 0.0), ([95.0, 80.0, 0.0], 0.0)];
    let floor = [([0.0, 0.0, 0.0], 0.0), ([90.0, 100.0, 10.0], 0.0), ([88.0, 5.0, 0.0], 0.0)];
    vec![
        ("walk", 1.1, cycle(&WALK, &[0.0; 8])),
        ("run", 0.7, cycle(&RUN, &AIRBORNE)),
        ("jump", 1.5, jump.iter().map(both).collect()),
        ("sit", 1.0, chair.iter().map(both).collect()),
        ("sit on the floor", 1.0, floor.iter().map(both).collect()),
    ]
}

/// A leg's joints.
#[derive(Clone, Copy)]
pub struct Leg {
    pub upper: usize,
    pub lower: usize,
    pub foot: usize,
    pub toes: Option<usize>,
}

/// Nodes of hips and legs, left first, and the axes of a figure.
pub struct Body {
    pub hips: usize,
    pub legs: [Leg; 2],
    pub up: DVec3,
    pub side: DVec3,
}

impl Body {
    pub fn of(loaded: &Loaded) -> Option<Self> {
        use Role::*;
        let node = |role: Role| Some(loaded.node_of_joint[loaded.character.humanoid.joint(role)?]);
        let leg = |[upper, lower, foot, toes]: [Role; 4]| {
            Some(Leg { upper: node(upper)?, lower: node(lower)?, foot: node(foot)?, toes: node(toes) })
        };
        let legs = [
            leg([LeftUpperLeg, LeftLowerLeg, LeftFoot, LeftToes])?,
            leg([RightUpperLeg, RightLowerLeg, RightFoot, RightToes])?,
        ];
        let up = loaded.character.axes.up.as_dvec3();
        let place = |node: usize| loaded.pose.rest[node].w_axis.truncate();
        let side = (place(legs[0].upper) - place(legs[1].upper)).reject_from(up).normalize();
        Some(Self { hips: node(Hips)?, legs, up, side })
    }

    /// Thigh and shin, the mean of both legs, by the nodes' places at rest.
    pub fn leg_length(&self, rest: &[DMat4]) -> f64 {
        let place = |node: usize| rest[node].w_axis.truncate();
        let of = |leg: &Leg| {
            place(leg.upper).distance(place(leg.lower)) + place(leg.lower).distance(place(leg.foot))
        };
        self.legs.iter().map(of).sum::<f64>() / 2.0
    }
}

/// True where a node is `above` or hangs from it.
fn is_within(loaded: &Loaded, node: usize, above: usize) -> bool {
    std::iter::successors(Some(node), |&node| loaded.tree.parents[node]).any(|node| node == above)
}

/// The indices that [`skinned`] gives a file's vertices: those of the left foot and of the right one, by the joint that moves
/// them most; and edges between a foot and its shin.
pub fn feet(loaded: &Loaded, body: &Body) -> ([Vec<usize>; 2], Vec<[usize; 2]>) {
    let within = |node: usize, above: usize| is_within(loaded, node, above);
    let (mut feet, mut edges, mut first) = ([Vec::new(), Vec::new()], Vec::new(), 0);
    for mesh in &loaded.character.meshes {
        let main: Vec<usize> = mesh
            .weights
            .rows()
            .map(|row| {
                let most = row.iter().max_by(|a, b| a.1.total_cmp(&b.1));
                most.map_or(0, |&(joint, _)| loaded.node_of_joint[joint as usize])
            })
            .collect();
        for (side, leg) in body.legs.iter().enumerate() {
            let of_foot = |vertex: usize| {
                within(main[vertex], leg.foot) || leg.toes.is_some_and(|toes| within(main[vertex], toes))
            };
            feet[side].extend((0..main.len()).filter(|&vertex| of_foot(vertex)).map(|vertex| first + vertex));
            for corners in &mesh.triangles {
                for [a, b] in [[0, 1], [1, 2], [2, 0]].map(|ends| ends.map(|end| corners[end] as usize)) {
                    if of_foot(a) != of_foot(b) {
                        edges.push([first + a, first + b]);
                    }
                }
            }
        }
        first += main.len();
    }
    (feet, edges)
}

/// The file with its nodes as an animation has them at a moment: linear keys, as made here and as they are written.
pub fn posed(file: &GltfFile, animation: usize, time: f32) -> GltfFile {
    let mut posed = file.clone();
    let reader = Reader::new(file);
    let json = &file.list("animations")[animation];
    for channel in array_at(json, "channels") {
        let (node, path) =
            (index_at(&channel["target"], "node").unwrap(), text_at(&channel["target"], "path"));
        let width = match path {
            "translation" | "scale" => 3,
            "rotation" => 4,
            _ => continue,
        };
        let sampler = &json["samplers"][index_at(channel, "sampler").unwrap()];
        assert_eq!(sampler.get("interpolation").and_then(Value::as_str).unwrap_or("LINEAR"), "LINEAR");
        let times = reader.floats(index_at(sampler, "input").unwrap(), 1, None).unwrap();
        let values = reader.floats(index_at(sampler, "output").unwrap(), width, None).unwrap();
        let next = times.partition_point(|&key| key <= time).clamp(1, times.len() - 1);
        let share = ((time - times[next - 1]) / (times[next] - times[next - 1])).clamp(0.0, 1.0);
        let key = |index: usize| &values[index * width..(index + 1) * width];
        let (from, to) = (key(next - 1), key(next));
        let value: Vec<f64> = if width == 4 {
            let turn = |key: &[f32]| DQuat::from_array(std::array::from_fn(|i| f64::from(key[i])));
            turn(from).slerp(turn(to), f64::from(share)).to_array().to_vec()
        } else {
            from.iter().zip(to).map(|(&from, &to)| f64::from(from + (to - from) * share)).collect()
        };
        posed.json["nodes"][node].as_object_mut().unwrap().remove("matrix");
        posed.json["nodes"][node][path] = json!(value);
    }
    posed
}

/// Where all vertices are at a moment.
pub fn shown(file: &GltfFile, animation: usize, time: f32) -> Vec<DVec3> {
    skinned(&posed(file, animation, time)).unwrap()
}

/// The file of `loaded`, which stands at rest, with the clips of [`motions`] in the place of any.
pub fn with_clips(loaded: &Loaded) -> GltfFile {
    let body = Body::of(loaded).expect("a figure with legs");
    let (feet, _) = feet(loaded, &body);
    let mut file = loaded.file.clone();
    file.json["animations"] = json!([]);
    let places = skinned(&file).unwrap();
    let height = |place: &DVec3| place.dot(body.up);
    let floor = places.iter().map(height).fold(f64::INFINITY, f64::min);
    let leg = body.leg_length(&loaded.pose.rest);
    for (name, seconds, keys) in motions() {
        let times: Vec<f32> =
            (0..keys.len()).map(|key| seconds * key as f32 / (keys.len() - 1) as f32).collect();
        let mut tracks: BTreeMap<(usize, &str), Vec<f64>> = BTreeMap::new();
        for (left, right, above) in &keys {
            let turned = turned(loaded, &body, [left, right]);
            let lowest = |lift: f64| {
                let mut posed = file.clone();
                for (&node, (turn, place)) in &set(loaded, &body, &turned, lift) {
                    put(&mut posed, node, *turn, *place);
                }
                let places = skinned(&posed).unwrap();
                feet.iter().flatten().map(|&v| height(&places[v])).fold(f64::INFINITY, f64::min) - floor
            };
            let lift = above * leg - lowest(0.0);
            for (node, (turn, place)) in set(loaded, &body, &turned, lift) {
                if let Some(turn) = turn {
                    let track = tracks.entry((node, "rotation")).or_default();
                    let last = track.last_chunk::<4>().map(|last| DQuat::from_array(*last));
                    let same = last.is_none_or(|last| last.dot(turn) >= 0.0);
                    track.extend((if same { turn } else { -turn }).to_array());
                }
                if let Some(place) = place {
                    tracks.entry((node, "translation")).or_default().extend(place.to_array());
                }
            }
        }
        add_animation(&mut file, name, &times, &tracks);
    }
    GltfFile::parse(&loaded.file.name, &file.to_bytes().unwrap()).unwrap()
}

/// By how much thigh, shin and foot of each leg are turned in model space.
fn turned(loaded: &Loaded, body: &Body, angles: [&[f64; 3]; 2]) -> BTreeMap<usize, DQuat> {
    let turn = |degrees: f64| DQuat::from_axis_angle(body.side, degrees.to_radians());
    let mut turned = BTreeMap::new();
    for (leg, [thigh, knee, ankle]) in body.legs.iter().zip(angles) {
        turned.insert(leg.upper, turn(-thigh));
        turned.insert(leg.lower, turn(knee - thigh));
        turned.insert(leg.foot, turn(knee - thigh - ankle));
        if let Some(toes) = leg.toes.filter(|&toes| loaded.tree.parents[toes] != Some(leg.foot)) {
            turned.insert(toes, turn(knee - thigh - ankle));
        }
    }
    turned
}

type Set = BTreeMap<usize, (Option<DQuat>, Option<DVec3>)>;

/// The nodes that a pose sets, each in its parent's space: legs by their turns, hips by `lift`, loose feet at their shins' ends.
fn set(loaded: &Loaded, body: &Body, turned: &BTreeMap<usize, DQuat>, lift: f64) -> Set {
    let rest = &loaded.pose.rest;
    let parents = &loaded.tree.parents;
    let rest_turn = |node: usize| rest[node].to_scale_rotation_translation().1;
    let above = |node: usize| {
        let mut above = std::iter::successors(parents[node], |&node| parents[node]);
        above.find_map(|node| turned.get(&node)).copied().unwrap_or(DQuat::IDENTITY)
    };
    let in_parent = |node: usize, place: DVec3| match parents[node] {
        Some(parent) => rest[parent].inverse().transform_point3(place),
        None => place,
    };
    let place = |node: usize| rest[node].w_axis.truncate();
    let mut set = Set::new();
    for (&node, &turn) in turned {
        let of_parent = parents[node].map_or(DQuat::IDENTITY, rest_turn);
        let local = (above(node) * of_parent).inverse() * (turn * rest_turn(node));
        set.insert(node, (Some(local.normalize()), None));
    }
    for leg in &body.legs {
        if !is_within(loaded, leg.foot, leg.lower) {
            let knee = place(leg.upper) + turned[&leg.upper] * (place(leg.lower) - place(leg.upper));
            let ankle = knee + turned[&leg.lower] * (place(leg.foot) - place(leg.lower)) + lift * body.up;
            set.get_mut(&leg.foot).unwrap().1 = Some(in_parent(leg.foot, ankle));
        }
    }
    set.entry(body.hips).or_default().1 = Some(in_parent(body.hips, place(body.hips) + lift * body.up));
    set
}

fn put(file: &mut GltfFile, node: usize, turn: Option<DQuat>, place: Option<DVec3>) {
    let json = &mut file.json["nodes"][node];
    if let Some(turn) = turn {
        json["rotation"] = json!(turn.to_array());
    }
    if let Some(place) = place {
        json["translation"] = json!(place.to_array());
    }
}

fn add_animation(file: &mut GltfFile, name: &str, times: &[f32], tracks: &BTreeMap<(usize, &str), Vec<f64>>) {
    let input = add_floats(file, times, "SCALAR", 1);
    let bounds = [times[0], times[times.len() - 1]].map(|time| json!([time]));
    file.json["accessors"][input]["min"] = bounds[0].clone();
    file.json["accessors"][input]["max"] = bounds[1].clone();
    let (mut channels, mut samplers) = (Vec::new(), Vec::new());
    for (&(node, path), numbers) in tracks {
        let numbers: Vec<f32> = numbers.iter().map(|&number| number as f32).collect();
        let (kind, width) = if path == "rotation" { ("VEC4", 4) } else { ("VEC3", 3) };
        let output = add_floats(file, &numbers, kind, width);
        channels.push(json!({"sampler": samplers.len(), "target": {"node": node, "path": path}}));
        samplers.push(json!({"input": input, "output": output}));
    }
    let animation = json!({"name": name, "channels": channels, "samplers": samplers});
    file.json["animations"].as_array_mut().unwrap().push(animation);
}

fn add_floats(file: &mut GltfFile, numbers: &[f32], kind: &str, width: usize) -> usize {
    file.binary.resize(file.binary.len().next_multiple_of(4), 0);
    let view = json!({"buffer": 0, "byteOffset": file.binary.len(), "byteLength": 4 * numbers.len()});
    file.binary.extend(numbers.iter().flat_map(|number| number.to_le_bytes()));
    file.json["buffers"][0]["byteLength"] = json!(file.binary.len());
    let views = file.json["bufferViews"].as_array_mut().unwrap();
    views.push(view);
    let view = views.len() - 1;
    let accessors = file.json["accessors"].as_array_mut().unwrap();
    accessors.push(
        json!({"bufferView": view, "componentType": 5126, "type": kind, "count": numbers.len() / width}),
    );
    accessors.len() - 1
}

/// The file with the feet hung from the shins, where they were loose; else loose ones, hung from what the hips hang from.
pub fn with_feet_moved(loaded: &Loaded) -> GltfFile {
    let body = Body::of(loaded).expect("a figure with legs");
    let mut file = loaded.file.clone();
    let tree = NodeTree::read(&file).unwrap();
    for leg in &body.legs {
        let parent = tree.parents[leg.foot].unwrap();
        let new = if parent == leg.lower { tree.parents[body.hips].unwrap() } else { leg.lower };
        let local = tree.world[new].inverse() * tree.world[leg.foot];
        let (scale, turn, place) = local.to_scale_rotation_translation();
        let children = file.json["nodes"][parent]["children"].as_array_mut().unwrap();
        children.retain(|child| child.as_u64() != Some(leg.foot as u64));
        if children.is_empty() {
            file.json["nodes"][parent].as_object_mut().unwrap().remove("children");
        }
        let node = &mut file.json["nodes"][new];
        if node.get("children").is_none() {
            node["children"] = json!([]);
        }
        node["children"].as_array_mut().unwrap().push(json!(leg.foot));
        let foot = file.json["nodes"][leg.foot].as_object_mut().unwrap();
        foot.remove("matrix");
        foot.insert("translation".into(), json!(place.to_array()));
        foot.insert("rotation".into(), json!(turn.to_array()));
        foot.insert("scale".into(), json!(scale.to_array()));
    }
    file
}
