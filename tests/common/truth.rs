//! Real characters without their rigs, and where their artists put the joints.
#![allow(dead_code)]

use super::models::{model, models};
use glam::DVec3;
use std::collections::BTreeMap;
use superdeform::internals::character::Frame;
use superdeform::{Character, Role};
use superdeform_host::file::GltfFile;
use superdeform_host::load::{LoadOptions, load};
use superdeform_host::samples;

/// A character without a rig.
pub struct Case {
    /// The file.
    pub name: String,
    /// Without joints and weights.
    pub character: Character,
    /// Where the artist put the joints, model space.
    pub joints: BTreeMap<Role, DVec3>,
    /// The way it looks, model space.
    pub forward: DVec3,
}

/// Every rigged model with its rig removed, and the files that come without one, with the rigs of their twins.
pub fn cases() -> Vec<Case> {
    let mut cases = Vec::new();
    for (name, loaded) in models() {
        let file = loaded.file.clone();
        cases.push(case(name, file, &loaded.character));
    }
    for (name, twin) in [
        ("makehuman_female_target.glb", "makehuman_female_rigged.glb"),
        ("seedsan_unrigged.glb", "seedsan_vrm1.vrm"),
        ("quaternius_female_dress_unrigged.glb", "quaternius_female_dress.glb"),
    ] {
        let Some((path, twin)) = samples::path(name).zip(model(twin)) else {
            continue;
        };
        cases.push(case(name, GltfFile::read(&path).unwrap(), &twin.character));
    }
    cases
}

fn case(name: &str, file: GltfFile, rigged: &Character) -> Case {
    let options = LoadOptions { without_rig: true, ..LoadOptions::default() };
    let character = load(file, &options).unwrap_or_else(|error| panic!("{name}: {error}")).character;
    let joints = rigged
        .humanoid
        .iter()
        .map(|(role, joint)| (role, rigged.skeleton.joints[joint].position()))
        .collect();
    let forward = Frame::of(rigged).unwrap().to_model(DVec3::Z);
    Case { name: name.to_string(), character, joints, forward }
}
