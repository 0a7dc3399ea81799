//! The files that a command names, read.

use crate::cli::{self, Command, Reference};
use crate::words;
use glam::DVec3;
use regex::Regex;
use serde_json::{Map, Value};
use std::collections::BTreeMap;
use std::path::Path;
use superdeform::{Axes, BodyShape, Error, MeshKind, Role, find_roles};
use superdeform_host::file::GltfFile;
use superdeform_host::load::{LoadOptions, Loaded, load};

/// How a model is to be read where it does not say itself.
struct Reading<'a> {
    /// Role to node name.
    humanoid_map: Option<Value>,
    kinds: &'a [(MeshKind, Regex)],
    axes: Axes,
    /// How the command line says what is wrong with it.
    sentence: fn(Error) -> String,
    /// Whether a rig will do in which roles are missing.
    incomplete_rig: bool,
}

/// The character to change.
///
/// # Errors
/// One sentence that begins with the file's name.
pub fn target(command: &Command) -> Result<Loaded, String> {
    let reading = Reading {
        humanoid_map: humanoid_map(command.humanoid.as_deref())?,
        kinds: &command.kinds,
        axes: command.axes,
        sentence: words::sentence,
        incomplete_rig: command.rig != Some(cli::Rig::Keep),
    };
    model(&command.target, &reading)
}

/// The reference, where it is a model.
///
/// # Errors
/// One sentence that begins with the file's name.
pub fn reference(command: &Command) -> Result<Option<Loaded>, String> {
    let Reference::Model(path) = &command.reference else {
        return Ok(None);
    };
    let reading = Reading {
        humanoid_map: humanoid_map(command.reference_humanoid.as_deref())?,
        kinds: &[],
        axes: Axes::default(),
        sentence: words::sentence_of_reference,
        incomplete_rig: false,
    };
    model(path, &reading).map(Some)
}

fn model(path: &Path, reading: &Reading) -> Result<Loaded, String> {
    let options = LoadOptions {
        axes: reading.axes,
        humanoid_map: reading.humanoid_map.as_ref(),
        kinds: reading.kinds,
        find_roles: Some(&find_roles),
        without_rig: false,
        incomplete_rig: reading.incomplete_rig,
    };
    GltfFile::read(path).and_then(|file| load(file, &options)).map_err(reading.sentence)
}

/// A humanoid map; whether its roles and nodes exist is for the loader to say.
fn humanoid_map(path: Option<&Path>) -> Result<Option<Value>, String> {
    let Some(path) = path else {
        return Ok(None);
    };
    let map: Map<String, Value> = json(path, r#"{"hips": "NODE NAME"}"#)?;
    Ok(Some(Value::Object(map)))
}

/// Known joints: an object of role -> [x, y, z]; none without a path.
///
/// # Errors
/// One sentence that begins with the path.
pub fn joints(path: Option<&Path>) -> Result<BTreeMap<Role, DVec3>, String> {
    let Some(path) = path else {
        return Ok(BTreeMap::new());
    };
    let joints: BTreeMap<String, [f64; 3]> = json(path, r#"{"leftHand": [0.5, 1.2, 0]}"#)?;
    joints
        .into_iter()
        .map(|(name, at)| {
            let role = Role::parse(&name)
                .ok_or_else(|| format!("{}: {name} is no humanoid role", path.display()))?;
            Ok((role, DVec3::from_array(at)))
        })
        .collect()
}

/// Bone groups: an object from bones, named by the role at their end, to group names.
///
/// # Errors
/// One sentence that begins with the path.
pub fn bone_groups(path: &Path) -> Result<BTreeMap<Role, String>, String> {
    let named: BTreeMap<String, String> = json(path, r#"{"leftUpperLeg": "legs"}"#)?;
    let place = path.display();
    let mut groups = BTreeMap::new();
    for (bone, group) in named {
        let role = Role::all()
            .find(|role| role.name().eq_ignore_ascii_case(&bone))
            .ok_or_else(|| format!("{place}: `{bone}` is no role: use VRM 1.0 names such as leftUpperLeg"))?;
        if group.trim().is_empty() {
            return Err(format!("{place}: `{bone}` has an empty group name: give it one"));
        }
        groups.insert(role, group);
    }
    Ok(groups)
}

/// A saved style.
///
/// # Errors
/// One sentence that begins with the path.
pub fn style(path: &Path) -> Result<BodyShape, String> {
    BodyShape::from_json(&text(path)?).map_err(|error| format!("{}: {error}", path.display()))
}

/// A JSON object such as `example`.
fn json<T: serde::de::DeserializeOwned>(path: &Path, example: &str) -> Result<T, String> {
    serde_json::from_str(&text(path)?)
        .map_err(|error| format!("{}: must be a JSON object such as {example} ({error})", path.display()))
}

fn text(path: &Path) -> Result<String, String> {
    std::fs::read_to_string(path).map_err(|error| format!("{}: cannot be read ({error})", path.display()))
}
