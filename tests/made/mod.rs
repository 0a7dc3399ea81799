//! Small made-up files, and a deformation with known results, for the tests of the example host.

mod container;

pub use container::container;

use glam::{DMat3, DVec3, Vec3};
use serde_json::{Value, json};
use superdeform::{Character, Deformed, DeformedMesh, Mapped, MorphTarget};

/// A GLB in the making.
#[derive(Clone)]
pub struct Made {
    pub json: Value,
    pub binary: Vec<u8>,
}

/// Joints of the figure: name, role, parent, place in model space.
pub const JOINTS: [(&str, &str, Option<usize>, [f32; 3]); 12] = [
    ("root", "", None, [0.0, 0.0, 0.0]),
    ("pelvis", "hips", Some(0), [0.0, 0.9, 0.0]),
    ("back", "spine", Some(1), [0.0, 1.1, 0.0]),
    ("skull", "head", Some(2), [0.0, 1.5, 0.0]),
    ("arm.L", "leftUpperArm", Some(2), [0.2, 1.4, 0.0]),
    ("arm.R", "rightUpperArm", Some(2), [-0.2, 1.4, 0.0]),
    ("thigh.L", "leftUpperLeg", Some(1), [0.1, 0.85, 0.0]),
    ("thigh.R", "rightUpperLeg", Some(1), [-0.1, 0.85, 0.0]),
    ("shin.L", "leftLowerLeg", Some(6), [0.1, 0.45, 0.02]),
    ("shin.R", "rightLowerLeg", Some(7), [-0.1, 0.45, 0.02]),
    ("strand", "", Some(3), [0.0, 1.6, -0.1]),
    ("strand end", "", Some(10), [0.0, 1.3, -0.15]),
];

impl Made {
    pub fn empty() -> Self {
        let json = json!({
            "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": []}], "nodes": [], "meshes": [],
            "accessors": [], "bufferViews": [], "buffers": [{"byteLength": 0}],
        });
        Self { json, binary: Vec::new() }
    }

    pub fn push(&mut self, list: &str, value: Value) -> usize {
        let list = self.json[list].as_array_mut().unwrap();
        list.push(value);
        list.len() - 1
    }

    pub fn view(&mut self, bytes: &[u8]) -> usize {
        self.binary.resize(self.binary.len().next_multiple_of(4), 0);
        let offset = self.binary.len();
        self.binary.extend_from_slice(bytes);
        self.push("bufferViews", json!({"buffer": 0, "byteOffset": offset, "byteLength": bytes.len()}))
    }

    pub fn accessor(&mut self, bytes: &[u8], component_type: u32, kind: &str, count: usize) -> usize {
        let view = self.view(bytes);
        self.push(
            "accessors",
            json!({"bufferView": view, "componentType": component_type, "type": kind, "count": count}),
        )
    }

    pub fn floats(&mut self, kind: &str, components: usize, numbers: &[f32]) -> usize {
        self.accessor(&bytes_of(numbers), 5126, kind, numbers.len() / components)
    }

    pub fn indices(&mut self, indices: &[u16]) -> usize {
        let bytes: Vec<u8> = indices.iter().flat_map(|i| i.to_le_bytes()).collect();
        self.accessor(&bytes, 5123, "SCALAR", indices.len())
    }

    /// The file's bytes.
    pub fn bytes(&self) -> Vec<u8> {
        let mut json = self.json.clone();
        json["buffers"][0]["byteLength"] = json!(self.binary.len());
        container(&serde_json::to_vec(&json).unwrap(), &self.binary)
    }
}

pub fn bytes_of(numbers: &[f32]) -> Vec<u8> {
    numbers.iter().flat_map(|n| n.to_le_bytes()).collect()
}

/// A small box around each joint of the figure: positions, the joint of each vertex, triangles.
pub fn boxes() -> (Vec<f32>, Vec<usize>, Vec<u16>) {
    let (mut positions, mut joints, mut triangles) = (Vec::new(), Vec::new(), Vec::new());
    for (joint, (.., place)) in JOINTS.iter().enumerate() {
        let first = (positions.len() / 3) as u16;
        for corner in 0..8 {
            for (axis, middle) in place.iter().enumerate() {
                let side = if corner >> axis & 1 == 1 { 0.05 } else { -0.05 };
                positions.push(middle + side);
            }
            joints.push(joint);
        }
        let faces = [[0, 2, 1], [1, 2, 3], [4, 5, 6], [5, 7, 6], [0, 1, 4], [1, 5, 4], [2, 6, 3], [3, 6, 7]];
        triangles.extend(faces.iter().flatten().map(|corner| first + corner));
    }
    (positions, joints, triangles)
}

/// A rigged figure with a VRM 1.0 header: node 0 to 11 are its joints, node 12 shows mesh 0 with skin 0.
pub fn figure() -> Made {
    let mut made = Made::empty();
    for (joint, (name, _, parent, place)) in JOINTS.iter().enumerate() {
        let from = parent.map_or([0.0; 3], |parent| JOINTS[parent].3);
        let local: Vec<f32> = (0..3).map(|axis| place[axis] - from[axis]).collect();
        let children: Vec<usize> =
            (0..JOINTS.len()).filter(|&other| JOINTS[other].2 == Some(joint)).collect();
        let mut node = json!({"name": name, "translation": local});
        if !children.is_empty() {
            node["children"] = json!(children);
        }
        made.push("nodes", node);
    }
    made.push("nodes", json!({"name": "figure", "mesh": 0, "skin": 0}));
    made.json["scenes"][0]["nodes"] = json!([0, 12]);
    let (positions, of_vertex, triangles) = boxes();
    let count = of_vertex.len();
    let position = made.floats("VEC3", 3, &positions);
    made.json["accessors"][position]["min"] = json!([-0.25, -0.05, -0.2]);
    made.json["accessors"][position]["max"] = json!([0.25, 1.65, 0.07]);
    let normals: Vec<f32> = (0..count).flat_map(|_| [0.0, 0.6, 0.8]).collect();
    let normal = made.floats("VEC3", 3, &normals);
    let joints: Vec<u8> =
        of_vertex.iter().flat_map(|&joint| [joint as u8, JOINTS[joint].2.unwrap_or(0) as u8, 0, 0]).collect();
    let joints = made.accessor(&joints, 5121, "VEC4", count);
    let weights: Vec<f32> = (0..count)
        .flat_map(|v| [0.75 + 0.02 * (v % 8) as f32, 0.25 - 0.02 * (v % 8) as f32, 0.0, 0.0])
        .collect();
    let weights = made.floats("VEC4", 4, &weights);
    let indices = made.indices(&triangles);
    let mut deltas = vec![0.0; count * 3];
    deltas[72..78].copy_from_slice(&[0.01, 0.02, 0.0, -0.01, 0.0, 0.01]);
    let target = made.floats("VEC3", 3, &deltas);
    let binds: Vec<f32> = JOINTS
        .iter()
        .flat_map(|(.., p)| {
            [1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, -p[0], -p[1], -p[2], 1.0]
        })
        .collect();
    let binds = made.floats("MAT4", 16, &binds);
    made.json["skins"] =
        json!([{"joints": (0..JOINTS.len()).collect::<Vec<_>>(), "inverseBindMatrices": binds}]);
    made.push(
        "meshes",
        json!({"name": "Figure", "extras": {"targetNames": ["smile"]}, "primitives": [{
            "attributes": {"POSITION": position, "NORMAL": normal, "JOINTS_0": joints, "WEIGHTS_0": weights},
            "indices": indices, "targets": [{"POSITION": target}],
        }]}),
    );
    let bones: serde_json::Map<String, Value> = (JOINTS.iter().enumerate())
        .filter(|(_, joint)| !joint.1.is_empty())
        .map(|(node, joint)| (joint.1.to_string(), json!({"node": node})))
        .collect();
    made.json["extensionsUsed"] = json!(["VRMC_vrm"]);
    made.json["extensions"] = json!({"VRMC_vrm": {
        "specVersion": "1.0", "humanoid": {"humanBones": bones},
        "meta": {"name": "Made", "authors": ["nobody"], "licenseUrl": "https://vrm.dev/licenses/1.0/", "modification": "allowModificationRedistribution"},
    }});
    made
}

/// A smooth map of space: shorter, wider above.
pub fn squash(p: DVec3) -> DVec3 {
    let wide = 1.0 + 0.2 * p.y;
    DVec3::new(p.x * wide, 0.4 * p.y + 0.1 * p.y * p.y, p.z * wide)
}

/// Its Jacobian, by differences.
pub fn squash_jacobian(p: DVec3) -> DMat3 {
    let step = 1e-5;
    let column = |axis: DVec3| (squash(p + axis * step) - squash(p - axis * step)) / (2.0 * step);
    DMat3::from_cols(column(DVec3::X), column(DVec3::Y), column(DVec3::Z))
}

/// As a host's callback.
pub fn squash_point(_: usize, p: DVec3) -> Mapped {
    Mapped { position: squash(p), jacobian: squash_jacobian(p) }
}

/// Leaves every point.
pub fn stay_point(_: usize, position: DVec3) -> Mapped {
    Mapped { position, jacobian: DMat3::IDENTITY }
}

/// A character under `map`; `None` leaves it as it is.
pub fn deformed(character: &Character, map: Option<fn(DVec3) -> DVec3>) -> Deformed {
    let at = |p: Vec3| map.map_or(p, |map| map(p.as_dvec3()).as_vec3());
    let meshes = character.meshes.iter().map(|mesh| DeformedMesh {
        positions: mesh.positions.iter().map(|&p| at(p)).collect(),
        normals: mesh.normals.clone(),
        tangents: mesh.tangents.clone(),
        morph_targets: (mesh.morph_targets.iter())
            .map(|target| MorphTarget {
                positions: (mesh.positions.iter().zip(&target.positions))
                    .map(|(&p, &d)| if d == Vec3::ZERO || map.is_none() { d } else { at(p + d) - at(p) })
                    .collect(),
                ..target.clone()
            })
            .collect(),
    });
    Deformed {
        meshes: meshes.collect(),
        joints: character
            .skeleton
            .joints
            .iter()
            .map(|j| map.map_or(j.position(), |map| map(j.position())))
            .collect(),
    }
}
