//! Hosts with left-handed axes hand over the mirror image of what a file holds: what comes out is the mirror image of
//! what comes out of the file.

#[path = "common/models.rs"]
mod models;
#[path = "common/truth.rs"]
mod truth;

use glam::{DMat4, DVec3, Vec3};
use models::{check_all, furthest, positions, present, style, style_of};
use std::sync::Arc;
use superdeform::internals::character::Frame;
use superdeform::{Character, Deformed, Deformer, Options, Rig, RigOptions, Style};

/// Characters with long hair, armour, one mesh or many, that look along +Z or another way.
const TARGETS: [&str; 8] = [
    "quaternius_female_dress.glb",
    "kaykit_rogue.glb",
    "seedsan_vrm1.vrm",
    "makehuman_female_rigged.glb",
    "godette.vrm",
    "quaternius_male_casual.glb",
    "valid_black_m_2_busi.glb",
    "cryptovoxels.vrm",
];

/// Parts of the height, and of a unit vector, by which a mirrored result may be off: twice what a float rounds, and the
/// same for directions, which cancel.
const NEAR: f64 = 1e-6;
/// The same where bodies are measured slice by slice: a ray that meets a corner of an outline meets either of its edges, and
/// the extents, medians of rays, differ in their sixth place; directions, slopes of what they make, in their third, and those
/// of a sliver of clothes (a hundred-thousandth of the height wide: Seed-san's) by 4.9e-3 where places differ by 4e-8.
const NEAR_BY_SLICES: [f64; 2] = [1e-5, 1e-2];

/// What a host with x the other way makes of the triangles.
#[derive(Clone, Copy, Debug)]
enum Winding {
    /// Front faces stay front faces where axes are left-handed, as Unity's importers do.
    Turned,
    /// The file's own numbers.
    Kept,
}

/// The way a rigged character looks.
fn forward(character: &Character) -> DVec3 {
    Frame::of(character).unwrap().to_model(DVec3::Z)
}

fn mirror(v: Vec3) -> Vec3 {
    Vec3::new(-v.x, v.y, v.z)
}

/// `character`, which looks along `forward`, with x the other way: its left is its left still, in left-handed axes.
fn mirrored(character: &Character, forward: DVec3, winding: Winding) -> Character {
    let flip = DMat4::from_diagonal(glam::DVec4::new(-1.0, 1.0, 1.0, 1.0));
    let mut image = character.clone();
    image.axes.up = mirror(character.axes.up);
    image.axes.forward = Some(mirror(forward.as_vec3()));
    for joint in &mut image.skeleton.joints {
        joint.rest = flip * joint.rest * flip;
    }
    for mesh in &mut image.meshes {
        mesh.positions.iter_mut().chain(&mut mesh.normals).for_each(|v| *v = mirror(*v));
        for tangent in &mut mesh.tangents {
            tangent.x = -tangent.x;
            tangent.w = -tangent.w;
        }
        for target in &mut mesh.morph_targets {
            let deltas = target.positions.iter_mut().chain(&mut target.normals).chain(&mut target.tangents);
            deltas.for_each(|v| *v = mirror(*v));
        }
        if let Winding::Turned = winding {
            mesh.triangles.iter_mut().for_each(|corners| corners.swap(1, 2));
        }
    }
    image
}

/// Normals, tangents and changes of normals of a result, one mesh after the other.
fn directions(deformed: &Deformed) -> Vec<DVec3> {
    let of_mesh = deformed.meshes.iter().flat_map(|mesh| {
        let tangents = mesh.tangents.iter().map(|tangent| tangent.truncate());
        let changes = mesh.morph_targets.iter().flat_map(|target| target.normals.iter().copied());
        mesh.normals.iter().copied().chain(tangents).chain(changes)
    });
    of_mesh.map(Vec3::as_dvec3).collect()
}

fn morph_positions(deformed: &Deformed) -> Vec<DVec3> {
    let targets = deformed.meshes.iter().flat_map(|mesh| &mesh.morph_targets);
    targets.flat_map(|target| &target.positions).map(|delta| delta.as_dvec3()).collect()
}

fn points_mirrored(mut points: Vec<DVec3>) -> Vec<DVec3> {
    points.iter_mut().for_each(|p| p.x = -p.x);
    points
}

/// How far the result of a mirrored target is from the mirrored result: what, and by how much.
fn differences(target: &Character, styles: [&Style; 2], winding: Winding) -> Vec<(&'static str, f64)> {
    let options = Options::default();
    let made =
        |character: Character, style: &Style| Deformer::new(Arc::new(character), style, &options).unwrap();
    let straight = made(target.clone(), styles[0]);
    let turned = made(mirrored(target, forward(target), winding), styles[1]);
    compared(&straight, &turned)
}

/// How far what `turned` gives is from the mirror image of what `straight` gives.
fn compared(straight: &Deformer, turned: &Deformer) -> Vec<(&'static str, f64)> {
    let height = straight.target().figure.height();
    let (one, other) = (straight.apply(), turned.apply());
    vec![
        ("vertices", furthest(&positions(&one), &points_mirrored(positions(&other))) / height),
        ("joints", furthest(&one.joints, &points_mirrored(other.joints.clone())) / height),
        (
            "morph targets",
            furthest(&morph_positions(&one), &points_mirrored(morph_positions(&other))) / height,
        ),
        ("directions", furthest(&directions(&one), &points_mirrored(directions(&other)))),
    ]
}

/// What of `differences` is above [`NEAR_BY_SLICES`]; all of it is printed.
fn failures(name: &str, differences: Vec<(&'static str, f64)>) -> Vec<String> {
    println!("{name}: {differences:?}");
    let [places, slopes] = NEAR_BY_SLICES;
    let near = |what: &str| if what == "directions" { slopes } else { places };
    let far = differences.into_iter().filter(|&(what, difference)| difference > near(what));
    far.map(|(what, difference)| format!("{name}: {what} differ by {difference:e}")).collect()
}

#[test]
fn a_mirrored_character_of_so_many_heads_is_the_mirrored_result() {
    let style = Style::Heads(2.5);
    check_all(&present(&TARGETS), |&name| {
        let target = &models::model(name).unwrap().character;
        [Winding::Turned, Winding::Kept]
            .into_iter()
            .flat_map(|winding| {
                let name = format!("{name}, winding {winding:?}, 2.5 heads");
                failures(&name, differences(target, [&style; 2], winding))
            })
            .collect()
    });
}

#[test]
fn a_mirrored_reference_is_the_same_style() {
    let options = Options::default();
    let reference = &models::model("kaykit_rogue.glb").unwrap().character;
    let own = style_of("kaykit_rogue.glb", &options);
    check_all(&present(&TARGETS), |&name| {
        let target = &models::model(name).unwrap().character;
        [Winding::Turned, Winding::Kept]
            .into_iter()
            .flat_map(|winding| {
                let of_image = style(&mirrored(reference, forward(reference), winding), &options);
                let name = format!("{name}, winding {winding:?}, like the rogue");
                failures(&name, differences(target, [&own, &of_image], winding))
            })
            .collect()
    });
}

#[test]
fn a_rig_made_in_left_handed_axes_calls_left_what_is_left() {
    let case =
        truth::cases().into_iter().find(|case| case.name == "quaternius_female_dress_unrigged.glb").unwrap();
    let mut straight = case.character;
    straight.axes.forward = Some(case.forward.as_vec3());
    let image = mirrored(&straight, case.forward, Winding::Turned);
    let made = |character: &Character, left_handed: bool| {
        let options = RigOptions { left_handed, voxel_resolution: 64, ..RigOptions::default() };
        Rig::of(character, &options).unwrap()
    };
    let rigs = [made(&straight, false), made(&image, true)];
    let joints = |rig: &Rig| -> Vec<DVec3> {
        rig.humanoid.iter().map(|(_, joint)| rig.skeleton.joints[joint].position()).collect()
    };
    assert_eq!(rigs[0].humanoid, rigs[1].humanoid);
    let apart = furthest(&joints(&rigs[0]), &points_mirrored(joints(&rigs[1])));
    let height = rigs[0].skeleton.joints.iter().map(|joint| joint.position().y).fold(0.0, f64::max);
    assert!(apart <= NEAR * height, "joints differ by {apart:e}");
    let (style, options) = (Style::Heads(2.5), Options::default());
    let straight = Deformer::with_rig(&straight, &rigs[0], &style, &options).unwrap();
    let turned = Deformer::with_rig(&image, &rigs[1], &style, &options).unwrap();
    let failures = failures("with a made rig", compared(&straight, &turned));
    assert!(failures.is_empty(), "{}", failures.join("\n"));
}
