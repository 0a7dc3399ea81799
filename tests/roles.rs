//! Roles from names, from the tree, and from both: on made-up skeletons and on real characters.

#[path = "common/glb_joints.rs"]
mod glb_joints;

use std::collections::HashMap;
use std::path::{Path, PathBuf};
use superdeform::Role::{self, *};
use superdeform::character::naming::parse_role_map;
use superdeform::character::roles::find_roles;
use superdeform::character::tree_roles::roles_from_tree;
use superdeform::{Humanoid, Skeleton};

/// The roles that decide how a character is deformed.
const CORE: [Role; 19] = [
    Hips,
    Spine,
    Chest,
    Neck,
    Head,
    LeftShoulder,
    RightShoulder,
    LeftUpperArm,
    RightUpperArm,
    LeftLowerArm,
    RightLowerArm,
    LeftHand,
    RightHand,
    LeftUpperLeg,
    RightUpperLeg,
    LeftLowerLeg,
    RightLowerLeg,
    LeftFoot,
    RightFoot,
];

fn models() -> PathBuf {
    let set = std::env::var_os("SUPERDEFORM_MODELS").map(PathBuf::from);
    set.unwrap_or_else(|| Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/models"))
}

struct Real {
    name: String,
    file: glb_joints::File,
    truth: HashMap<Role, usize>,
}

/// Every rigged model with its true roles; empty where the models are not there.
fn real_characters() -> Vec<Real> {
    let folder = models();
    let Ok(entries) = std::fs::read_dir(&folder) else {
        println!("no models in {}: real characters are not compared", folder.display());
        return Vec::new();
    };
    let list = std::fs::read_to_string(folder.join("roles.json")).unwrap_or_else(|_| "{}".to_string());
    let list: HashMap<String, HashMap<String, String>> = serde_json::from_str(&list).expect("roles.json");
    let mut names: Vec<String> = entries
        .filter_map(|entry| entry.ok()?.file_name().into_string().ok())
        .filter(|name| name.ends_with(".glb") || name.ends_with(".vrm"))
        .collect();
    names.sort();
    let mut found = Vec::new();
    for name in names {
        let file = glb_joints::read(&folder.join(&name));
        if file.skeleton.joints.is_empty() {
            continue;
        }
        let mut truth = file.header.clone();
        if let Some(map) = list.get(&name) {
            let (_, roles) = parse_role_map(map.keys().map(String::as_str));
            for (role, joint_name) in roles.into_iter().zip(map.values()) {
                let joint = file.skeleton.joints.iter().position(|joint| joint.name == *joint_name);
                truth.extend(role.zip(joint));
            }
        }
        // Files of one maker share their names: the knight's VRM tells the other KayKit files' roles, and so on.
        found.push(Real { name, file, truth });
    }
    let known: Vec<HashMap<String, Role>> = found
        .iter()
        .filter(|real| !real.truth.is_empty())
        .map(|real| real.truth.iter().map(|(&role, &joint)| (real.file.skeleton.joints[joint].name.clone(), role)).collect())
        .collect();
    for real in found.iter_mut().filter(|real| real.truth.is_empty()) {
        let joints = &real.file.skeleton.joints;
        let twin = known.iter().find(|map| map.keys().all(|name| joints.iter().any(|joint| joint.name == *name)));
        if let Some(twin) = twin {
            let entry = |(joint, of): (usize, &superdeform::Joint)| Some((*twin.get(&of.name)?, joint));
            real.truth = joints.iter().enumerate().filter_map(entry).collect();
        }
    }
    found
}

/// Right, wrong, missed and extra among `roles`; a joint within 3 % of the height of the true one is right.
#[derive(Default)]
struct Agreement {
    right: usize,
    wrong: Vec<String>,
    missed: Vec<String>,
    extra: Vec<String>,
}

fn compare(real: &Real, found: &Humanoid, roles: &[Role], tolerance: f64) -> Agreement {
    let position = |joint: usize| real.file.skeleton.joints[joint].position();
    let name = |joint: usize| real.file.skeleton.joints[joint].name.as_str();
    let heights = real.file.meshes.iter().flat_map(|mesh| &mesh.positions).map(|point| f64::from(point.y));
    let (low, high) = heights.fold((f64::MAX, f64::MIN), |(low, high), y| (low.min(y), high.max(y)));
    let mut agreement = Agreement::default();
    for &role in roles {
        match (real.truth.get(&role), found.joint(role)) {
            (Some(&truth), Some(joint)) => {
                let near = position(truth).distance(position(joint)) <= tolerance * (high - low);
                if truth == joint || near && tolerance > 0.0 {
                    agreement.right += 1;
                } else {
                    agreement.wrong.push(format!("{role}: {} for {}", name(joint), name(truth)));
                }
            }
            (Some(_), None) => agreement.missed.push(role.to_string()),
            (None, Some(joint)) => agreement.extra.push(format!("{role}: {}", name(joint))),
            (None, None) => {}
        }
    }
    agreement
}

#[test]
fn names_tell_the_roles_of_real_characters() {
    for real in real_characters() {
        let (found, warnings) = find_roles(&real.file.skeleton, &real.file.meshes, glam::Vec3::Y);
        if real.truth.is_empty() {
            println!("{}: no truth; missing {:?} {:?}", real.name, found.missing(), warnings);
            for role in CORE {
                print!(" {role}={}", found.joint(role).map_or("-", |j| &real.file.skeleton.joints[j].name));
            }
            println!();
            assert!(found.missing().is_empty(), "{}", real.name);
            continue;
        }
        let all: Vec<Role> = Role::all().collect();
        let core = compare(&real, &found, &CORE, 0.0);
        let whole = compare(&real, &found, &all, 0.0);
        println!(
            "{}: core {} right, wrong {:?}, missed {:?}, extra {:?}; all {} right, wrong {:?}, missed {:?}; {:?}",
            real.name, core.right, core.wrong, core.missed, core.extra, whole.right, whole.wrong, whole.missed, warnings
        );
        assert!(core.wrong.is_empty(), "{}: {:?}", real.name, core.wrong);
        assert!(core.missed.is_empty(), "{}: {:?}", real.name, core.missed);
        assert!(found.missing().is_empty(), "{}", real.name);
    }
}

/// The same skeleton with names that tell nothing.
fn nameless(skeleton: &Skeleton) -> Skeleton {
    let mut skeleton = skeleton.clone();
    for (index, joint) in skeleton.joints.iter_mut().enumerate() {
        joint.name = format!("j{index}");
    }
    skeleton
}

#[test]
fn the_tree_tells_the_roles_of_real_characters_without_names() {
    let limbs: Vec<Role> = CORE
        .into_iter()
        .filter(|role| ![Spine, Chest, Neck, LeftShoulder, RightShoulder].contains(role))
        .collect();
    let (mut good, mut count) = (0, 0);
    for real in real_characters().into_iter().filter(|real| !real.truth.is_empty()) {
        let skeleton = nameless(&real.file.skeleton);
        let found = roles_from_tree(&skeleton, &real.file.meshes, glam::Vec3::Y);
        let limbs = compare(&real, &found, &limbs, 0.03);
        let core = compare(&real, &found, &CORE, 0.03);
        let all: Vec<Role> = Role::all().collect();
        let whole = compare(&real, &found, &all, 0.03);
        println!(
            "{}: core {} right, wrong {:?}, missed {:?}, extra {:?}; all {} right, {} wrong, {} missed",
            real.name, core.right, core.wrong, core.missed, core.extra, whole.right, whole.wrong.len(), whole.missed.len()
        );
        count += 1;
        good += usize::from(limbs.wrong.is_empty() && limbs.missed.is_empty());
    }
    println!("{good} of {count} characters have all required roles and limbs right without names");
    assert!(good * 100 >= count * 85, "{good} of {count}");
}
