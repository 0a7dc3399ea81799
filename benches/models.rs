//! What is measured on: a person of capsules, and two files where they are at hand.
//!
//! `superdeform_host::samples` says where files lie.

use glam::DVec3;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use superdeform::internals::character::bones::Group;
use superdeform::internals::rig::WeightBone;
use superdeform::internals::rig::weight_bones::weight_bones;
use superdeform::{Axes, Character, Deformed, Deformer, Role, Style, find_roles};
use superdeform_host::file::GltfFile;
use superdeform_host::load::{LoadOptions, Loaded};
use superdeform_host::samples;

#[path = "../tests/common/people.rs"]
mod people;

/// Files with as many vertices as hosts usually bring: 35,050 and 31,904.
const FILES: [&str; 2] = ["seedsan_vrm1.vrm", "valid_hispanic_f_2_casual.glb"];
/// How many heads tall results are: what a small reference has.
const HEADS: f64 = 2.5;

/// A character to measure on.
pub struct Model {
    /// What the figures stand beside.
    pub name: String,
    /// Where it was read from.
    pub path: Option<PathBuf>,
    /// The character.
    pub character: Character,
}

/// All that is at hand.
pub fn models() -> Vec<Model> {
    let capsules = people::Person::default().build();
    let mut models = vec![Model { name: "capsules".to_string(), path: None, character: capsules }];
    for name in FILES {
        let path = samples::folder().join(name);
        if path.is_file() {
            let character = load(&path).character;
            models.push(Model { name: name.to_string(), path: Some(path), character });
        }
    }
    models
}

/// A person of capsules whose tubes have so many columns.
pub fn capsules(columns: usize) -> Character {
    people::Person { columns, ..people::Person::default() }.build()
}

/// A body without clothes and its bones without fingers.
pub struct Body {
    /// What the figures stand beside.
    pub name: &'static str,
    /// One vertex a place.
    pub positions: Vec<DVec3>,
    /// Closed, in one piece.
    pub triangles: Vec<[u32; 3]>,
    /// One a role, without eyes and jaw.
    pub bones: Vec<WeightBone>,
}

/// A closed body around capsules, of about 14,000 vertices.
pub fn capsule_body() -> Body {
    body_in_cells(75.0)
}

/// The same of fewer than 3,000.
pub fn small_body() -> Body {
    body_in_cells(30.0)
}

fn body_in_cells(cells: f64) -> Body {
    let joints = people::Person::default().joints();
    let bones = body_bones(&joints);
    let radius = |role: Role| match role {
        Role::Hips | Role::Spine | Role::Chest | Role::UpperChest => 0.13,
        Role::Head => 0.1,
        _ => 0.05,
    };
    let roles: Vec<Role> = joints.keys().copied().collect();
    let capsules: Vec<([DVec3; 2], f64)> = bones
        .iter()
        .flat_map(|bone| bone.segments.iter().map(|&ends| (ends, radius(roles[bone.joint as usize]))))
        .collect();
    let (positions, triangles) = crate::body_of_capsules(&capsules, cells);
    Body { name: "capsules", positions, triangles, bones }
}

/// All bodies that are at hand: one around capsules, and MakeHuman's.
pub fn bodies() -> Vec<Body> {
    let mut bodies = vec![capsule_body()];
    let [target, rigged] = ["makehuman_female_target.glb", "makehuman_female_rigged.glb"]
        .map(|name| samples::folder().join(name));
    if target.is_file() && rigged.is_file() {
        let character = load(&target).character;
        let rigged = load(&rigged).character;
        let joints =
            rigged.humanoid.iter().map(|(role, joint)| (role, rigged.skeleton.joints[joint].position()));
        let mesh = character.meshes.iter().find(|mesh| mesh.name == "body").expect("the file has a body");
        let positions: Vec<DVec3> = mesh.positions.iter().map(|p| p.as_dvec3()).collect();
        let weld = superdeform::internals::geometry::weld(&positions, 1e-6);
        bodies.push(Body {
            name: "makehuman",
            positions: weld.first_vertices().iter().map(|&vertex| positions[vertex as usize]).collect(),
            triangles: mesh.triangles.iter().map(|&corners| weld.triangle(corners)).collect(),
            bones: body_bones(&joints.collect()),
        });
    }
    bodies
}

fn body_bones(joints: &BTreeMap<Role, DVec3>) -> Vec<WeightBone> {
    // The palm ends where the first joint of a finger is.
    let is_finger = |role: Role| matches!(Group::ending_at(role), Some(Group::Hand | Group::Finger));
    // Toes go on from the foot along the ground.
    let toes = |foot: Role, toes: Role| {
        let way = *joints.get(&toes)? - *joints.get(&foot)?;
        Some((toes, joints[&toes] + 0.4 * way.with_y(0.0)))
    };
    let mut tips: BTreeMap<Role, DVec3> = joints
        .iter()
        .filter_map(|(role, &at)| match role {
            Role::Head => Some((Role::Head, at + 0.15 * DVec3::Y)),
            Role::LeftMiddleProximal => Some((Role::LeftHand, at)),
            Role::RightMiddleProximal => Some((Role::RightHand, at)),
            _ => None,
        })
        .collect();
    tips.extend(toes(Role::LeftFoot, Role::LeftToes));
    tips.extend(toes(Role::RightFoot, Role::RightToes));
    let joints =
        joints.iter().filter(|&(&role, _)| !is_finger(role)).map(|(&role, &at)| (role, at)).collect();
    weight_bones(&joints, &tips, None)
}

/// The style that everything is given.
pub fn style() -> Style {
    Style::heads(HEADS).expect("a number of heads in range")
}

/// Reads a file as the command line does.
pub fn load(path: &Path) -> Loaded {
    let options = LoadOptions {
        axes: Axes::default(),
        humanoid_map: None,
        kinds: &[],
        find_roles: Some(&find_roles),
        without_rig: false,
        incomplete_rig: false,
    };
    let file = GltfFile::read(path).expect("the file can be read");
    superdeform_host::load::load(file, &options).expect("the file holds a character")
}

/// The file with the new shape, in memory.
pub fn write(loaded: &Loaded, deformer: &Deformer, deformed: &Deformed) -> Vec<u8> {
    superdeform_host::write::write(loaded, deformed, &|joint, point| deformer.map(joint, point))
        .expect("the result can be written")
}
