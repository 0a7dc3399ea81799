//! Roles from names, from the tree, and from both: on made-up skeletons and on real characters.

#[path = "common/glb_joints.rs"]
mod glb_joints;

use std::collections::HashMap;
use superdeform::Role::{self, *};
use superdeform::internals::character::naming::parse_role_map;
use superdeform::internals::character::roles::complete;
use superdeform::internals::character::tree_roles::roles_from_tree;
use superdeform::{Humanoid, Mesh, Skeleton, find_roles};
use superdeform_host::samples;

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

/// Roles from the tree alone, completed.
fn by_tree(skeleton: &Skeleton, meshes: &[Mesh]) -> Humanoid {
    let mut found = roles_from_tree(skeleton, meshes, glam::Vec3::Y);
    complete(&mut found, skeleton);
    found
}

struct Real {
    name: String,
    file: glb_joints::File,
    truth: HashMap<Role, usize>,
}

fn bare(name: &str) -> String {
    name.strip_prefix("mixamorig:").unwrap_or(name).to_string()
}

/// Every rigged model with its true roles; empty where the models are not there.
fn real_characters(every_node: bool) -> Vec<Real> {
    let folder = samples::folder();
    let Ok(entries) = std::fs::read_dir(&folder) else {
        samples::skipped("models");
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
        let file = glb_joints::read(&folder.join(&name), every_node);
        if file.skeleton.joints.is_empty() {
            continue;
        }
        let mut truth = file.header.clone();
        if let Some(map) = list.get(&name) {
            let (_, roles) = parse_role_map(map.keys().map(String::as_str));
            for (role, joint_name) in roles.into_iter().zip(map.values()) {
                // Viewers number equal names ("head", "head 1"): the joint is the one farther down the tree.
                let plain = joint_name.strip_suffix(" 1").unwrap_or(joint_name);
                let joint = (0..file.skeleton.joints.len())
                    .filter(|&joint| file.skeleton.joints[joint].name == plain)
                    .max_by_key(|&joint| file.skeleton.ancestors(joint).count());
                truth.extend(role.zip(joint));
            }
        }
        // Files of one maker share their names: the knight's VRM tells the other KayKit files' roles, and so on.
        found.push(Real { name, file, truth });
    }
    let known: Vec<HashMap<String, Role>> = found
        .iter()
        .filter(|real| !real.truth.is_empty())
        .map(|real| {
            real.truth
                .iter()
                .map(|(&role, &joint)| (bare(&real.file.skeleton.joints[joint].name), role))
                .collect()
        })
        .collect();
    for real in found.iter_mut().filter(|real| real.truth.is_empty()) {
        let joints = &real.file.skeleton.joints;
        let twin = known
            .iter()
            .find(|map| map.keys().all(|name| joints.iter().any(|joint| bare(&joint.name) == *name)));
        if let Some(twin) = twin {
            let entry =
                |(joint, of): (usize, &superdeform::Joint)| Some((*twin.get(&bare(&of.name))?, joint));
            real.truth = joints.iter().enumerate().filter_map(entry).collect();
        }
    }
    found
}

/// Right, wrong, missed and extra among `roles`; a joint within `tolerance` heights of the true one is right.
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
    for real in real_characters(false).into_iter().chain(real_characters(true)) {
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
            real.name,
            core.right,
            core.wrong,
            core.missed,
            core.extra,
            whole.right,
            whole.wrong,
            whole.missed,
            warnings
        );
        assert!(core.wrong.is_empty(), "{}: {:?}", real.name, core.wrong);
        assert!(core.missed.is_empty(), "{}: {:?}", real.name, core.missed);
        assert!(found.missing().is_empty(), "{}", real.name);
    }
}

/// Of the height: a wrist joint right before a hand joint does as well as the hand.
const NEAR: f64 = 0.04;

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
    for real in
        real_characters(false).into_iter().chain(real_characters(true)).filter(|real| !real.truth.is_empty())
    {
        let skeleton = nameless(&real.file.skeleton);
        let found = by_tree(&skeleton, &real.file.meshes);
        let limbs = compare(&real, &found, &limbs, NEAR);
        let core = compare(&real, &found, &CORE, NEAR);
        let all: Vec<Role> = Role::all().collect();
        let whole = compare(&real, &found, &all, NEAR);
        println!(
            "{}: core {} right, wrong {:?}, missed {:?}, extra {:?}; all {} right, {} wrong, {} missed",
            real.name,
            core.right,
            core.wrong,
            core.missed,
            core.extra,
            whole.right,
            whole.wrong.len(),
            whole.missed.len()
        );
        count += 1;
        good += usize::from(limbs.wrong.is_empty() && limbs.missed.is_empty());
    }
    println!("{good} of {count} characters have all required roles and limbs right without names");
    assert!(good * 100 >= count * 85, "{good} of {count}");
}

/// A skeleton from lines of "indent name x y z"; two spaces of indent a generation.
///
/// Limbs of the left side are given; every name with `left` in it is repeated with `right`, x turned round.
fn made_up(text: &str, left: &str, right: &str) -> Skeleton {
    let mut skeleton = Skeleton::default();
    let lines: Vec<&str> = text.lines().filter(|line| !line.trim().is_empty()).collect();
    for mirror in [false, true] {
        let mut above: Vec<usize> = Vec::new();
        for line in &lines {
            let depth = (line.len() - line.trim_start().len()) / 2;
            let (name, place) = line.trim().rsplit_once('@').expect("name @ x y z");
            let place: Vec<f64> = place.split_whitespace().map(|number| number.parse().unwrap()).collect();
            let name = name.trim();
            above.truncate(depth);
            let sided = name.contains(left);
            let known = skeleton.joints.iter().position(|joint| joint.name == name);
            if let Some(known) = known.filter(|_| mirror && !sided) {
                above.push(known);
                continue;
            }
            let (name, x) = if mirror {
                (name.replacen(left, right, 1), -place[0])
            } else {
                (name.to_string(), place[0])
            };
            let rest = glam::DMat4::from_translation(glam::DVec3::new(x, place[1], place[2]));
            skeleton.joints.push(superdeform::Joint { name, parent: above.last().copied(), rest });
            above.push(skeleton.joints.len() - 1);
        }
    }
    skeleton
}

/// Finds the roles of a made-up skeleton and compares them with pairs "role name"; right sides follow from left.
fn expect(text: &str, left: &str, right: &str, roles: &[(Role, &str)]) {
    let skeleton = made_up(text, left, right);
    let (found, warnings) = find_roles(&skeleton, &[], glam::Vec3::Y);
    let name = |role: Role| found.joint(role).map(|joint| skeleton.joints[joint].name.clone());
    for &(role, joint) in roles {
        let wanted = (!joint.is_empty()).then(|| joint.to_string());
        assert_eq!(name(role), wanted, "{role}; {warnings:?}");
        let mirrored =
            wanted.map(|name| if role.mirrored() == role { name } else { name.replacen(left, right, 1) });
        assert_eq!(name(role.mirrored()), mirrored, "{role}");
    }
    assert!(found.missing().is_empty());
}

/// A person of 1.7: names in the order hips, column (any number), neck, head, shoulder, upper arm, lower arm, hand,
/// upper leg, lower leg, foot, toes. An empty name leaves the joint out.
fn person(hips: &str, column: &[&str], top: [&str; 2], arm: [&str; 4], leg: [&str; 4]) -> String {
    let mut text = String::new();
    let mut depth = 0;
    let mut line = |depth: &mut usize, name: &str, place: &str| {
        if !name.is_empty() {
            text += &format!("{}{name} @ {place}\n", "  ".repeat(*depth));
            *depth += 1;
        }
    };
    line(&mut depth, hips, "0 0.95 0");
    let base = depth;
    for (name, place) in leg.iter().zip(["0.1 0.9 0", "0.1 0.5 0.01", "0.1 0.09 0", "0.1 0.02 0.12"]) {
        line(&mut depth, name, place);
    }
    depth = base;
    for (place, name) in column.iter().enumerate() {
        line(&mut depth, name, &format!("0 {} 0", 1.05 + 0.3 * place as f64 / column.len() as f64));
    }
    let chest = depth;
    for (name, place) in arm.iter().zip(["0.03 1.4 0", "0.18 1.4 0", "0.45 1.4 -0.01", "0.7 1.4 0"]) {
        line(&mut depth, name, place);
    }
    depth = chest;
    for (name, place) in top.iter().zip(["0 1.45 0", "0 1.55 0"]) {
        line(&mut depth, name, place);
    }
    text
}

fn expect_person(
    hips: &str,
    column: &[&str],
    top: [&str; 2],
    arm: [&str; 4],
    leg: [&str; 4],
    sides: [&str; 2],
) {
    let text = person(hips, column, top, arm, leg);
    let mut roles = vec![(Hips, hips), (Neck, top[0]), (Head, top[1])];
    roles.extend([LeftShoulder, LeftUpperArm, LeftLowerArm, LeftHand].into_iter().zip(arm));
    roles.extend([LeftUpperLeg, LeftLowerLeg, LeftFoot, LeftToes].into_iter().zip(leg));
    if column.len() <= 3 {
        roles.extend([Spine, Chest, UpperChest].into_iter().zip(column.iter().copied()));
    } else {
        roles.extend([(Spine, column[0]), (UpperChest, column[column.len() - 1])]);
    }
    expect(&text, sides[0], sides[1], &roles);
}

#[test]
fn mixamo_names_are_known_with_and_without_a_namespace() {
    for space in ["mixamorig:", "mixamorig1:", "mixamorig", ""] {
        let names = |names: [&str; 4]| names.map(|name| format!("{space}{name}"));
        let column = ["Spine", "Spine1", "Spine2"].map(|name| format!("{space}{name}"));
        let arm = names(["LeftShoulder", "LeftArm", "LeftForeArm", "LeftHand"]);
        let leg = names(["LeftUpLeg", "LeftLeg", "LeftFoot", "LeftToeBase"]);
        expect_person(
            &format!("{space}Hips"),
            &column.each_ref().map(String::as_str),
            [&format!("{space}Neck"), &format!("{space}Head")],
            arm.each_ref().map(String::as_str),
            leg.each_ref().map(String::as_str),
            ["Left", "Right"],
        );
    }
}

#[test]
fn unity_chan_and_other_rig_names_before_the_joint_are_set_aside() {
    for rig in ["Character1_", "UnityChan_", "My_Hero_", "chr01:"] {
        let arm = ["LeftShoulder", "LeftArm", "LeftForeArm", "LeftHand"].map(|name| format!("{rig}{name}"));
        let leg = ["LeftUpLeg", "LeftLeg", "LeftFoot", "LeftToeBase"].map(|name| format!("{rig}{name}"));
        let column = ["Spine", "Spine1"].map(|name| format!("{rig}{name}"));
        expect_person(
            &format!("{rig}Hips"),
            &column.each_ref().map(String::as_str),
            [&format!("{rig}Neck"), &format!("{rig}Head")],
            arm.each_ref().map(String::as_str),
            leg.each_ref().map(String::as_str),
            ["Left", "Right"],
        );
    }
}

#[test]
fn unreal_names_are_known_and_twist_joints_play_no_role() {
    let text = "
root @ 0 0 0
  pelvis @ 0 0.95 0
    spine_01 @ 0 1.05 0
      spine_02 @ 0 1.2 0
        spine_03 @ 0 1.35 0
          neck_01 @ 0 1.45 0
            head @ 0 1.55 0
          clavicle_l @ 0.03 1.4 0
            upperarm_l @ 0.18 1.4 0
              upperarm_twist_01_l @ 0.3 1.4 0
              lowerarm_l @ 0.45 1.4 0
                lowerarm_twist_01_l @ 0.6 1.4 0
                hand_l @ 0.7 1.4 0
                  index_metacarpal_l @ 0.72 1.4 0
                    index_01_l @ 0.75 1.4 0
                      index_02_l @ 0.78 1.4 0
                        index_03_l @ 0.8 1.4 0
                  thumb_01_l @ 0.72 1.4 0.02
                    thumb_02_l @ 0.74 1.4 0.04
                      thumb_03_l @ 0.76 1.4 0.05
    thigh_l @ 0.1 0.9 0
      thigh_twist_01_l @ 0.1 0.7 0
      calf_l @ 0.1 0.5 0
        calf_twist_01_l @ 0.1 0.3 0
        foot_l @ 0.1 0.09 0
          ball_l @ 0.1 0.02 0.12
  ik_foot_root @ 0 0 0
    ik_foot_l @ 0.1 0.09 0
  ik_hand_root @ 0 0 0
    ik_hand_l @ 0.7 1.4 0
";
    let roles = [
        (Hips, "pelvis"),
        (Spine, "spine_01"),
        (Chest, "spine_02"),
        (UpperChest, "spine_03"),
        (Neck, "neck_01"),
        (Head, "head"),
        (LeftShoulder, "clavicle_l"),
        (LeftUpperArm, "upperarm_l"),
        (LeftLowerArm, "lowerarm_l"),
        (LeftHand, "hand_l"),
        (LeftUpperLeg, "thigh_l"),
        (LeftLowerLeg, "calf_l"),
        (LeftFoot, "foot_l"),
        (LeftToes, "ball_l"),
        (LeftIndexProximal, "index_01_l"),
        (LeftIndexDistal, "index_03_l"),
        (LeftThumbMetacarpal, "thumb_01_l"),
        (LeftThumbDistal, "thumb_03_l"),
    ];
    let text = text.replace("_l @", "_l. @");
    let roles = roles
        .map(|(role, name)| (role, if name.ends_with("_l") { format!("{name}.") } else { name.to_string() }));
    let roles: Vec<(Role, &str)> = roles.iter().map(|(role, name)| (*role, name.as_str())).collect();
    expect(&text, "_l.", "_r.", &roles);
}

#[test]
fn rigify_columns_end_in_the_head_and_second_halves_play_no_role() {
    let text = "
DEF-spine @ 0 0.95 0
  DEF-pelvis.L @ 0.02 0.95 0
  DEF-thigh.L @ 0.1 0.9 0
    DEF-thigh.L.001 @ 0.1 0.7 0
      DEF-shin.L @ 0.1 0.5 0
        DEF-shin.L.001 @ 0.1 0.3 0
          DEF-foot.L @ 0.1 0.09 0
            DEF-toe.L @ 0.1 0.02 0.12
  DEF-spine.001 @ 0 1.05 0
    DEF-spine.002 @ 0 1.2 0
      DEF-spine.003 @ 0 1.35 0
        DEF-spine.004 @ 0 1.45 0
          DEF-spine.005 @ 0 1.5 0
            DEF-spine.006 @ 0 1.55 0
        DEF-shoulder.L @ 0.03 1.4 0
          DEF-upper_arm.L @ 0.18 1.4 0
            DEF-upper_arm.L.001 @ 0.3 1.4 0
              DEF-forearm.L @ 0.45 1.4 0
                DEF-forearm.L.001 @ 0.6 1.4 0
                  DEF-hand.L @ 0.7 1.4 0
        ORG-upper_arm.L @ 0.18 1.4 0
        upper_arm_ik.L @ 0.18 1.4 0
";
    let roles = [
        (Hips, "DEF-spine"),
        (Spine, "DEF-spine.001"),
        (Chest, "DEF-spine.002"),
        (UpperChest, "DEF-spine.003"),
        (Neck, "DEF-spine.004"),
        (Head, "DEF-spine.006"),
        (LeftUpperArm, "DEF-upper_arm.L"),
        (LeftLowerArm, "DEF-forearm.L"),
        (LeftHand, "DEF-hand.L"),
        (LeftUpperLeg, "DEF-thigh.L"),
        (LeftLowerLeg, "DEF-shin.L"),
        (LeftFoot, "DEF-foot.L"),
        (LeftToes, "DEF-toe.L"),
    ];
    expect(text, ".L", ".R", &roles);
}

#[test]
fn controls_of_rigify_beside_what_deforms_play_no_role() {
    let deform = person(
        "DEF-spine",
        &["DEF-spine.001", "DEF-spine.002", "DEF-spine.003"],
        ["DEF-spine.004", "DEF-spine.005"],
        ["DEF-shoulder.L", "DEF-upper_arm.L", "DEF-forearm.L", "DEF-hand.L"],
        ["DEF-thigh.L", "DEF-shin.L", "DEF-foot.L", "DEF-toe.L"],
    );
    // Controls stand first in the file, where they are.
    let controls = "
hips @ 0 0.95 0
  chest @ 0 1.3 0
    neck @ 0 1.45 0
      head @ 0 1.55 0
    shoulder.L @ 0.03 1.4 0
    hand.L @ 0.7 1.4 0
  foot.L @ 0.1 0.09 0
";
    let roles = [
        (Hips, "DEF-spine"),
        (Neck, "DEF-spine.004"),
        (Head, "DEF-spine.005"),
        (LeftShoulder, "DEF-shoulder.L"),
        (LeftUpperArm, "DEF-upper_arm.L"),
        (LeftHand, "DEF-hand.L"),
        (LeftFoot, "DEF-foot.L"),
    ];
    expect(&format!("{controls}{deform}"), ".L", ".R", &roles);
}

#[test]
fn auto_rig_pro_stretches_arms_and_legs() {
    let game = person(
        "root.x",
        &["spine_01.x", "spine_02.x", "spine_03.x"],
        ["neck.x", "head.x"],
        ["shoulder.l", "arm_stretch.l", "forearm_stretch.l", "hand.l"],
        ["thigh_stretch.l", "leg_stretch.l", "foot.l", "toes_01.l"],
    );
    let roles = [
        (Hips, "root.x"),
        (Spine, "spine_01.x"),
        (UpperChest, "spine_03.x"),
        (Neck, "neck.x"),
        (Head, "head.x"),
        (LeftShoulder, "shoulder.l"),
        (LeftUpperArm, "arm_stretch.l"),
        (LeftLowerArm, "forearm_stretch.l"),
        (LeftHand, "hand.l"),
        (LeftUpperLeg, "thigh_stretch.l"),
        (LeftLowerLeg, "leg_stretch.l"),
        (LeftFoot, "foot.l"),
        (LeftToes, "toes_01.l"),
    ];
    expect(&game, ".l", ".r", &roles);
    // Its own rig has what is bent beside what stretches, and twists.
    let whole = game.replace(
        "          arm_stretch.l @",
        "          arm.l @ 0.18 1.4 0\n          arm_twist.l @ 0.2 1.4 0\n          arm_stretch.l @",
    );
    assert_ne!(whole, game);
    expect(&whole, ".l", ".r", &roles);
}

#[test]
fn names_that_blender_addons_give_are_known() {
    // CATS, when it has fixed a model.
    expect_person(
        "Hips",
        &["Spine", "Chest"],
        ["Neck", "Head"],
        ["Left shoulder", "Left arm", "Left elbow", "Left wrist"],
        ["Left leg", "Left knee", "Left ankle", "Left toe"],
        ["Left", "Right"],
    );
    // MikuMikuDance's bones as mmd_tools imports them, sides behind, and as it translates them.
    expect_person(
        "腰",
        &["上半身", "上半身2"],
        ["首", "頭"],
        ["肩.L", "腕.L", "ひじ.L", "手首.L"],
        ["足.L", "ひざ.L", "足首.L", "つま先.L"],
        [".L", ".R"],
    );
    expect_person(
        "waist",
        &["upper body", "upper body2"],
        ["neck", "head"],
        ["shoulder.L", "arm.L", "elbow.L", "wrist.L"],
        ["leg.L", "knee.L", "ankle.L", "toe.L"],
        [".L", ".R"],
    );
}

#[test]
fn legs_that_deform_beside_those_that_are_posed_play_the_roles() {
    // MikuMikuDance: 足 is posed and has no vertices, 足D follows it and has them.
    let text = "
腰 @ 0 0.95 0
  下半身 @ 0 1.0 0
    左足 @ 0.1 0.9 0
      左ひざ @ 0.1 0.5 0
        左足首 @ 0.1 0.09 0
          左つま先 @ 0.1 0.02 0.12
    左足D @ 0.1 0.9 0
      左ひざD @ 0.1 0.5 0
        左足首D @ 0.1 0.09 0
          左足先EX @ 0.1 0.03 0.1
  上半身 @ 0 1.0 0
    上半身2 @ 0 1.2 0
      首 @ 0 1.45 0
        頭 @ 0 1.55 0
      左肩 @ 0.03 1.4 0
        左腕 @ 0.18 1.4 0
          左ひじ @ 0.45 1.4 0
            左手首 @ 0.7 1.4 0
";
    let roles = [
        (Hips, "腰"),
        (Head, "頭"),
        (LeftHand, "左手首"),
        (LeftUpperLeg, "左足D"),
        (LeftLowerLeg, "左ひざD"),
        (LeftFoot, "左足首D"),
        (LeftToes, "左足先EX"),
    ];
    expect(text, "左", "右", &roles);
}

#[test]
fn plain_conventions_are_known() {
    // VRoid.
    expect_person(
        "J_Bip_C_Hips",
        &["J_Bip_C_Spine", "J_Bip_C_Chest", "J_Bip_C_UpperChest"],
        ["J_Bip_C_Neck", "J_Bip_C_Head"],
        ["J_Bip_L_Shoulder", "J_Bip_L_UpperArm", "J_Bip_L_LowerArm", "J_Bip_L_Hand"],
        ["J_Bip_L_UpperLeg", "J_Bip_L_LowerLeg", "J_Bip_L_Foot", "J_Bip_L_ToeBase"],
        ["_L_", "_R_"],
    );
    // Biped of 3ds Max, with space and two ways to number the rig.
    for rig in ["Bip01", "Bip001"] {
        let arm = ["Clavicle", "UpperArm", "Forearm", "Hand"].map(|part| format!("{rig} L {part}"));
        let leg = ["Thigh", "Calf", "Foot", "Toe0"].map(|part| format!("{rig} L {part}"));
        let column = ["Spine", "Spine1", "Spine2"].map(|part| format!("{rig} {part}"));
        expect_person(
            &format!("{rig} Pelvis"),
            &column.each_ref().map(String::as_str),
            [&format!("{rig} Neck"), &format!("{rig} Head")],
            arm.each_ref().map(String::as_str),
            leg.each_ref().map(String::as_str),
            [" L ", " R "],
        );
    }
    // ValveBiped.
    expect_person(
        "ValveBiped.Bip01_Pelvis",
        &[
            "ValveBiped.Bip01_Spine",
            "ValveBiped.Bip01_Spine1",
            "ValveBiped.Bip01_Spine2",
            "ValveBiped.Bip01_Spine4",
        ],
        ["ValveBiped.Bip01_Neck1", "ValveBiped.Bip01_Head1"],
        [
            "ValveBiped.Bip01_L_Clavicle",
            "ValveBiped.Bip01_L_UpperArm",
            "ValveBiped.Bip01_L_Forearm",
            "ValveBiped.Bip01_L_Hand",
        ],
        [
            "ValveBiped.Bip01_L_Thigh",
            "ValveBiped.Bip01_L_Calf",
            "ValveBiped.Bip01_L_Foot",
            "ValveBiped.Bip01_L_Toe0",
        ],
        ["_L_", "_R_"],
    );
    // Character Creator and ActorCore.
    expect_person(
        "CC_Base_Hip",
        &["CC_Base_Waist", "CC_Base_Spine01", "CC_Base_Spine02"],
        ["CC_Base_NeckTwist01", "CC_Base_Head"],
        ["CC_Base_L_Clavicle", "CC_Base_L_Upperarm", "CC_Base_L_Forearm", "CC_Base_L_Hand"],
        ["CC_Base_L_Thigh", "CC_Base_L_Calf", "CC_Base_L_Foot", "CC_Base_L_ToeBase"],
        ["_L_", "_R_"],
    );
    // Daz Genesis.
    expect_person(
        "hip",
        &["abdomenLower", "abdomenUpper", "chestLower", "chestUpper"],
        ["neckLower", "head"],
        ["lCollar", "lShldrBend", "lForearmBend", "lHand"],
        ["lThighBend", "lShin", "lFoot", "lToe"],
        ["l", "r"],
    );
    // Side words for the hip joint, and joints named after the joint, not after the bone.
    expect_person(
        "Pelvis",
        &["Spine", "Chest"],
        ["Neck", "Head"],
        ["LeftCollar", "LeftShoulder", "LeftElbow", "LeftWrist"],
        ["LeftHip", "LeftKnee", "LeftAnkle", "LeftToe"],
        ["Left", "Right"],
    );
    expect_person(
        "Hips",
        &["Spine"],
        ["Neck", "Head"],
        ["", "leftarm", "leftforearm", "lefthand"],
        ["leftleg", "leftknee", "leftfoot", ""],
        ["left", "right"],
    );
    expect_person(
        "bone-hips",
        &["bone-spine"],
        ["bone-neck", "bone-head"],
        ["bone-clavicle-l", "bone-upper-arm-l", "bone-lower-arm-l", "bone-hand-l"],
        ["bone-upper-leg-l", "bone-lower-leg-l", "bone-foot-l", "bone-toe-l"],
        ["-l", "-r"],
    );
}

#[test]
fn japanese_names_are_known() {
    let text = "
全ての親 @ 0 0 0
  センター @ 0 0.7 0
    グルーブ @ 0 0.75 0
      腰 @ 0 0.95 0
        下半身 @ 0 1.0 0
          左足 @ 0.1 0.9 0
            左ひざ @ 0.1 0.5 0
              左足首 @ 0.1 0.09 0
                左つま先 @ 0.1 0.02 0.12
        上半身 @ 0 1.0 0
          上半身2 @ 0 1.2 0
            首 @ 0 1.45 0
              頭 @ 0 1.55 0
                左目 @ 0.03 1.6 0.08
            左肩 @ 0.03 1.4 0
              左腕 @ 0.18 1.4 0
                左腕捩 @ 0.3 1.4 0
                左ひじ @ 0.45 1.4 0
                  左手捩 @ 0.6 1.4 0
                  左手首 @ 0.7 1.4 0
                    左親指０ @ 0.72 1.4 0.02
                      左親指１ @ 0.74 1.4 0.04
                        左親指２ @ 0.76 1.4 0.05
                    左人指１ @ 0.78 1.4 0.02
                      左人指２ @ 0.8 1.4 0.02
                        左人指３ @ 0.82 1.4 0.02
  左足ＩＫ @ 0.1 0.09 0
    左つま先ＩＫ @ 0.1 0.02 0.12
";
    let roles = [
        (Hips, "腰"),
        (Spine, "上半身"),
        (Chest, "上半身2"),
        (Neck, "首"),
        (Head, "頭"),
        (LeftEye, "左目"),
        (LeftShoulder, "左肩"),
        (LeftUpperArm, "左腕"),
        (LeftLowerArm, "左ひじ"),
        (LeftHand, "左手首"),
        (LeftThumbMetacarpal, "左親指０"),
        (LeftThumbDistal, "左親指２"),
        (LeftIndexIntermediate, "左人指２"),
        (LeftUpperLeg, "左足"),
        (LeftLowerLeg, "左ひざ"),
        (LeftFoot, "左足首"),
        (LeftToes, "左つま先"),
    ];
    expect(text, "左", "右", &roles);
}

#[test]
fn the_makehuman_default_rig_has_its_hips_at_the_root_and_fingers_by_number() {
    let text = "
root @ 0 0.95 0
  pelvis.L @ 0.01 0.94 0
    upperleg01.L @ 0.1 0.9 0
      upperleg02.L @ 0.1 0.7 0
        lowerleg01.L @ 0.1 0.5 0
          lowerleg02.L @ 0.1 0.3 0
            foot.L @ 0.1 0.09 0
              toe1-1.L @ 0.09 0.02 0.12
              toe2-1.L @ 0.11 0.02 0.12
  spine05 @ 0 1.0 0
    spine04 @ 0 1.1 0
      spine03 @ 0 1.2 0
        spine02 @ 0 1.3 0
          spine01 @ 0 1.35 0
            clavicle.L @ 0.03 1.4 0
              shoulder01.L @ 0.15 1.4 0
                upperarm01.L @ 0.18 1.4 0
                  upperarm02.L @ 0.3 1.4 0
                    lowerarm01.L @ 0.45 1.4 0
                      lowerarm02.L @ 0.55 1.4 0
                        wrist.L @ 0.7 1.4 0
                          finger1-1.L @ 0.72 1.4 0.03
                            finger1-2.L @ 0.74 1.4 0.05
                              finger1-3.L @ 0.76 1.4 0.06
                          finger2-1.L @ 0.78 1.4 0.02
                            finger2-2.L @ 0.8 1.4 0.02
                              finger2-3.L @ 0.82 1.4 0.02
            neck01 @ 0 1.45 0
              neck02 @ 0 1.48 0
                neck03 @ 0 1.51 0
                  head @ 0 1.55 0
                    eye.L @ 0.03 1.6 0.08
";
    let roles = [
        (Hips, "root"),
        (Spine, "spine05"),
        (Chest, "spine03"),
        (UpperChest, "spine01"),
        (Neck, "neck01"),
        (Head, "head"),
        (LeftEye, "eye.L"),
        (LeftShoulder, "clavicle.L"),
        (LeftUpperArm, "upperarm01.L"),
        (LeftLowerArm, "lowerarm01.L"),
        (LeftHand, "wrist.L"),
        (LeftThumbMetacarpal, "finger1-1.L"),
        (LeftIndexProximal, "finger2-1.L"),
        (LeftIndexDistal, "finger2-3.L"),
        (LeftUpperLeg, "upperleg01.L"),
        (LeftLowerLeg, "lowerleg01.L"),
        (LeftFoot, "foot.L"),
        (LeftToes, "toe1-1.L"),
    ];
    expect(text, ".L", ".R", &roles);
}

#[test]
fn a_finger_is_of_the_arm_that_it_hangs_from_beside_the_hand_and_by_another_sides_name() {
    let arm = ["Shoulder.L", "UpperArm.L", "LowerArm.L", "Palm.L"];
    let leg = ["UpperLeg.L", "LowerLeg.L", "Foot.L", ""];
    let text = person("Hips", &["Torso"], ["Neck", "Head"], arm, leg);
    let hand = text.lines().find(|line| line.contains("Palm.L")).unwrap();
    let indent = &hand[..hand.len() - hand.trim_start().len()];
    let thumb = format!("{hand}\n{indent}Thumb1.L @ 0.7 1.38 0.03\n{indent}  Thumb2.L @ 0.72 1.36 0.05");
    let mut skeleton = made_up(&text.replace(hand, &thumb), ".L", ".R");
    let sides: Vec<(usize, bool)> = (0..skeleton.joints.len())
        .filter(|&joint| skeleton.joints[joint].name.starts_with("Thumb"))
        .map(|joint| (joint, skeleton.joints[joint].name.ends_with(".L")))
        .collect();
    assert_eq!(sides.len(), 4);
    let (found, _) = find_roles(&skeleton, &[], glam::Vec3::Y);
    for &(joint, left) in &sides {
        let name = &mut skeleton.joints[joint].name;
        *name = if left { name.replace(".L", ".R") } else { name.replace(".R", ".L") };
    }
    let (by_other_names, _) = find_roles(&skeleton, &[], glam::Vec3::Y);
    for found in [found, by_other_names] {
        for (side, metacarpal, distal) in
            [(true, LeftThumbMetacarpal, LeftThumbDistal), (false, RightThumbMetacarpal, RightThumbDistal)]
        {
            let mut own = sides.iter().filter(|(_, left)| *left == side).map(|(joint, _)| *joint);
            assert_eq!([found.joint(metacarpal), found.joint(distal)], [own.next(), own.next()]);
        }
    }
}

#[test]
fn feet_may_hang_from_the_root_and_a_spine_may_be_called_hips() {
    let text = "
Bone @ 0 0 0
  Foot.L @ 0.1 0.09 0
    Foot.L_end @ 0.1 0.02 0.1
  PoleTarget.L @ 0.1 0.5 1
  Body @ 0 0.95 0
    Hips @ 0 1.0 0
      Abdomen @ 0 1.1 0
        Torso @ 0 1.25 0
          Neck @ 0 1.45 0
            Head @ 0 1.55 0
              Head_end @ 0 1.7 0
          Shoulder.L @ 0.03 1.4 0
            UpperArm.L @ 0.18 1.4 0
              LowerArm.L @ 0.45 1.4 0
                Palm.L @ 0.7 1.4 0
                  MiddleHand.L @ 0.75 1.4 0
                    Fingers.L @ 0.8 1.4 0
                  Thumb1.L @ 0.72 1.4 0.03
                    Thumb2.L @ 0.74 1.4 0.05
    UpperLeg.L @ 0.1 0.9 0
      LowerLeg.L @ 0.1 0.5 0
        LowerLeg.L_end @ 0.1 0.1 0
";
    let roles = [
        (Hips, "Body"),
        (Spine, "Hips"),
        (Chest, "Abdomen"),
        (UpperChest, "Torso"),
        (LeftShoulder, "Shoulder.L"),
        (LeftHand, "Palm.L"),
        (LeftThumbMetacarpal, "Thumb1.L"),
        (LeftThumbDistal, "Thumb2.L"),
        (LeftMiddleProximal, "Fingers.L"),
        (LeftLowerLeg, "LowerLeg.L"),
        (LeftFoot, "Foot.L"),
    ];
    expect(text, ".L", ".R", &roles);
}

#[test]
fn twists_skirts_tails_and_hair_do_not_hide_the_limbs() {
    // No name tells anything and there is no mesh: "l" marks what is mirrored.
    let text = "
a @ 0 0.95 0
  tail1 @ 0 0.9 -0.1
    tai2 @ 0 0.6 -0.2
      tai3 @ 0 0.4 -0.3
  skirt1-l @ 0.12 0.9 0.1
    skirt2-l @ 0.15 0.75 0.12
      skirt3-l @ 0.16 0.6 0.14
  b-l @ 0.1 0.9 0
    c-l @ 0.1 0.5 0.01
      d-l @ 0.1 0.09 0
        e-l @ 0.1 0.02 0.12
  f @ 0 1.05 0
    g @ 0 1.25 0
      zero @ 0 1.25 0
        h-l @ 0.03 1.4 0
          i-l @ 0.18 1.4 0
            twist-l @ 0.32 1.4 0
            k-l @ 0.45 1.4 -0.01
              m-l @ 0.7 1.4 0
                n-l @ 0.8 1.4 0
        o @ 0 1.45 0
          p @ 0 1.55 0
            hair1-l @ 0.08 1.68 0
              hair2-l @ 0.12 1.5 -0.05
                hair3-l @ 0.13 1.3 -0.05
            hair1 @ 0 1.7 0.05
";
    let skeleton = made_up(text, "-l", "-r");
    let nameless = nameless(&skeleton);
    for turn in [0.0_f64, 1.0, 2.5] {
        // Whichever way it faces.
        let mut turned = nameless.clone();
        for joint in &mut turned.joints {
            joint.rest = glam::DMat4::from_rotation_y(turn) * joint.rest;
        }
        let found = by_tree(&turned, &[]);
        let name = |role: Role| found.joint(role).map(|joint| skeleton.joints[joint].name.as_str());
        let roles = [
            (Hips, "a"),
            (Spine, "f"),
            (Neck, "o"),
            (Head, "p"),
            (LeftShoulder, "h-l"),
            (LeftUpperArm, "i-l"),
            (RightUpperArm, "i-r"),
            (LeftLowerArm, "k-l"),
            (LeftHand, "m-l"),
            (LeftUpperLeg, "b-l"),
            (RightUpperLeg, "b-r"),
            (LeftLowerLeg, "c-l"),
            (LeftFoot, "d-l"),
            (LeftToes, "e-l"),
        ];
        for (role, joint) in roles {
            assert_eq!(name(role), Some(joint), "{role}, turned by {turn}");
        }
    }
}

#[test]
fn a_gap_in_the_names_is_filled_from_the_tree_with_a_warning() {
    let text = person(
        "Hips",
        &["Spine", "Chest"],
        ["Neck", "Head"],
        ["Shoulder_L", "UpperArm_L", "LowerArm_L", "Hand_L"],
        ["Thing1_L", "Thing2_L", "Thing3_L", "Thing4_L"],
    );
    let skeleton = made_up(&text, "_L", "_R");
    let (found, warnings) = find_roles(&skeleton, &[], glam::Vec3::Y);
    let name = |role: Role| found.joint(role).map(|joint| skeleton.joints[joint].name.as_str());
    assert_eq!(name(LeftUpperLeg), Some("Thing1_L"));
    assert_eq!(name(RightLowerLeg), Some("Thing2_R"));
    assert_eq!(name(LeftFoot), Some("Thing3_L"));
    assert_eq!(name(LeftUpperArm), Some("UpperArm_L"));
    assert_eq!(warnings.len(), 1);
    assert_eq!(warnings[0].code, "roles_from_geometry");
    assert!(warnings[0].message.contains("leftUpperLeg (Thing1_L)"), "{}", warnings[0].message);
}

#[test]
fn a_shin_above_its_thigh_loses_its_role() {
    let text = person(
        "Hips",
        &["Spine"],
        ["Neck", "Head"],
        ["", "UpperArm_L", "LowerArm_L", "Hand_L"],
        ["UpperLeg_L", "LowerLeg_L", "Foot_L", ""],
    );
    let mut skeleton = made_up(&text, "_L", "_R");
    let shin = skeleton.joints.iter().position(|joint| joint.name == "LowerLeg_L").unwrap();
    skeleton.joints[shin].rest.w_axis.y = 1.2;
    let (found, _) = find_roles(&skeleton, &[], glam::Vec3::Y);
    assert_eq!(found.joint(LeftLowerLeg), None);
    assert!(found.has(RightLowerLeg));
}

#[test]
fn any_tree_is_survived() {
    let words = [
        "Hips",
        "LeftArm",
        "arm.R",
        "leg_l",
        "Head",
        "spine",
        "",
        "左",
        "_end",
        "Bip01",
        "Finger0",
        "L Finger①",
        "x9",
        "L",
        "thumb.L",
    ];
    let mut state = 1_u64;
    let mut random = |below: usize| {
        state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (state >> 33) as usize % below
    };
    for case in 0..3000 {
        let count = random(24);
        let mut skeleton = Skeleton::default();
        for joint in 0..count {
            let place = glam::DVec3::new(random(5) as f64 - 2.0, random(5) as f64, random(3) as f64 - 1.0);
            let place = if case % 7 == 0 { glam::DVec3::ZERO } else { place };
            // Now and then a circle or a parent that is not there, which `validate` refuses.
            let parent = match random(40) {
                0 => Some(random(count + 2)),
                1 | 2 => None,
                _ => (joint > 0).then(|| random(joint.max(1))),
            };
            let name = words[random(words.len())].to_string();
            skeleton.joints.push(superdeform::Joint {
                name,
                parent,
                rest: glam::DMat4::from_translation(place),
            });
        }
        let up = [glam::Vec3::Y, glam::Vec3::Z, glam::Vec3::ZERO][random(3)];
        let mesh = Mesh {
            positions: vec![glam::Vec3::ONE; 4],
            weights: superdeform::Weights::from_rows((0..4).map(|_| [(random(30) as u32, 1.0)])),
            ..Default::default()
        };
        let meshes = if case % 2 == 0 { vec![mesh] } else { Vec::new() };
        let (found, _) = find_roles(&skeleton, &meshes, up);
        assert!(found.iter().all(|(_, joint)| joint < count));
        let mut joints: Vec<usize> = found.iter().map(|(_, joint)| joint).collect();
        joints.sort_unstable();
        joints.dedup();
        assert_eq!(joints.len(), found.iter().count(), "no joint plays two roles");
        roles_from_tree(&skeleton, &meshes, up);
    }
}

#[test]
fn roles_are_read_in_every_spelling() {
    for name in ["leftUpperLeg", "LeftUpperLeg", "Left Upper Leg", "left_upper_leg", "LEFT-UPPER-LEG"] {
        assert_eq!(Role::parse(name), Some(LeftUpperLeg));
    }
    for role in Role::all() {
        assert_eq!(Role::parse(role.name()), Some(role));
    }
    assert_eq!(Role::parse("leftElbow"), None);
}

#[test]
fn thumbs_are_read_as_the_whole_map_means_them() {
    use superdeform::internals::character::naming::ThumbNames;
    let (thumbs, roles) =
        parse_role_map(["leftThumbMetacarpal", "leftThumbProximal", "leftThumbDistal"].into_iter());
    assert_eq!(thumbs, ThumbNames::Vrm1);
    assert_eq!(roles, [Some(LeftThumbMetacarpal), Some(LeftThumbProximal), Some(LeftThumbDistal)]);
    let unity = ["Left Thumb Proximal", "Left Thumb Intermediate", "Left Thumb Distal", "Tail"];
    let (thumbs, roles) = parse_role_map(unity.into_iter());
    assert_eq!(thumbs, ThumbNames::Vrm0OrUnity);
    assert_eq!(roles, [Some(LeftThumbMetacarpal), Some(LeftThumbProximal), Some(LeftThumbDistal), None]);
    let (_, roles) = parse_role_map(["rightThumbProximal", "rightThumbDistal"].into_iter());
    assert_eq!(roles, [Some(RightThumbMetacarpal), Some(RightThumbDistal)]);
}

#[test]
fn handles_and_slots_of_game_rigs_play_no_role() {
    // KayKit.
    let text = "
root @ 0 0 0
  hips @ 0 0.41 0
    spine @ 0 0.6 0
      chest @ 0 0.97 0
        head @ 0 1.24 0
        upperarm.l @ 0.21 1.11 0
          lowerarm.l @ 0.45 1.11 -0.01
            wrist.l @ 0.71 1.11 0
              hand.l @ 0.79 1.11 0
                handslot.l @ 0.88 1.05 0
    upperleg.l @ 0.17 0.52 0
      lowerleg.l @ 0.17 0.29 0.01
        foot.l @ 0.17 0.14 -0.02
          toes.l @ 0.17 0.03 0.1
  kneeIK.l @ 0.17 0.29 0.58
  control-toe-roll.l @ 0.17 0.03 0.25
    control-foot-roll.l @ 0.17 0.03 0.1
      IK-foot.l @ 0.17 0.14 -0.02
  handIK.l @ 0.71 1.11 0
";
    let roles = [
        (Hips, "hips"),
        (Spine, "spine"),
        (Chest, "chest"),
        (UpperChest, ""),
        (Neck, ""),
        (Head, "head"),
        (LeftShoulder, ""),
        (LeftUpperArm, "upperarm.l"),
        (LeftLowerArm, "lowerarm.l"),
        (LeftHand, "hand.l"),
        (LeftUpperLeg, "upperleg.l"),
        (LeftLowerLeg, "lowerleg.l"),
        (LeftFoot, "foot.l"),
        (LeftToes, "toes.l"),
    ];
    expect(text, ".l", ".r", &roles);
}
