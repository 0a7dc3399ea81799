//! What is measured on: a person of capsules, and two files where they are at hand.
//!
//! `SUPERDEFORM_MODELS` names the folder of the files, `../shared/models` beside the repository where it is not set.
//! The target that uses this file brings the example's `host`.

use crate::host::file::GltfFile;
use crate::host::load::{LoadOptions, Loaded};
use std::path::{Path, PathBuf};
use superdeform::character::roles::find_roles;
use superdeform::pipeline::{Deformed, Deformer, Style};
use superdeform::{Axes, Character};

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
    let folder = std::env::var_os("SUPERDEFORM_MODELS")
        .map_or_else(|| Path::new(env!("CARGO_MANIFEST_DIR")).join("../../shared/models"), PathBuf::from);
    for name in FILES {
        let path = folder.join(name);
        if path.is_file() {
            let character = load(&path).character;
            models.push(Model { name: name.to_string(), path: Some(path), character });
        }
    }
    models
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
    };
    let file = GltfFile::read(path).expect("the file can be read");
    crate::host::load::load(file, &options).expect("the file holds a character")
}

/// The file with the new shape, in memory.
pub fn write(loaded: &Loaded, deformer: &Deformer, deformed: &Deformed) -> Vec<u8> {
    crate::host::write::write(loaded, deformed, &|joint, point| deformer.map(joint, point))
        .expect("the result can be written")
}
