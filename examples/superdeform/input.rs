//! The files that a command names, read.

use crate::cli::{Command, Reference};
use crate::samples::Sample;
use crate::words;
use glam::DVec3;
use serde_json::{Map, Value};
use std::borrow::Cow;
use std::cell::RefCell;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use superdeform::{BodyShape, Progress, RigOptions, Role};
use superdeform_host::beside;
use superdeform_host::conversion::{self as host, Clock, Conversion, OpenOptions, Source};
use superdeform_host::file::GltfFile;

/// Where a model is.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Model {
    /// In a file.
    File(PathBuf),
    /// In the program.
    Sample(&'static Sample),
}

impl Model {
    /// The path of a file.
    pub fn path(&self) -> Option<&PathBuf> {
        match self {
            Self::File(path) => Some(path),
            Self::Sample(_) => None,
        }
    }
}

/// A model's bytes.
struct File {
    name: String,
    bytes: Cow<'static, [u8]>,
    /// What names files beside it; a sample has all within.
    path: PathBuf,
}

impl File {
    /// Reads a model, not yet the files that it names.
    ///
    /// # Errors
    /// One sentence that begins with the file's name.
    fn read(model: &Model) -> Result<Self, String> {
        match model {
            Model::File(path) => {
                let (name, bytes) = GltfFile::read_bytes(path).map_err(|error| error.to_string())?;
                Ok(Self { name, bytes: bytes.into(), path: path.clone() })
            }
            Model::Sample(sample) => {
                Ok(Self { name: sample.name.to_string(), bytes: sample.bytes.into(), path: PathBuf::new() })
            }
        }
    }

    /// Gives it to `work`, with what lies beside it; and the paths of that.
    fn with<T>(&self, work: impl FnOnce(Source) -> T) -> (T, Vec<PathBuf>) {
        let (folder, named) = (beside::folder_of(&self.path), RefCell::new(Vec::new()));
        let beside = |path: &str| {
            named.borrow_mut().push(self.path.with_file_name(path));
            folder(path)
        };
        (work(Source { name: &self.name, bytes: &self.bytes, beside: &beside }), named.into_inner())
    }
}

/// The target of `command`, open; and the paths of the files that it names.
///
/// # Errors
/// One sentence that begins with the file's name.
pub fn target(command: &Command, clock: Clock) -> Result<(Conversion, Vec<PathBuf>), String> {
    let options = OpenOptions {
        axes: command.axes,
        humanoid_map: humanoid_map(command.humanoid.as_deref())?,
        kinds: command.kinds.clone(),
        face_hints: command.face_hints,
        rig: command.rig,
        rig_options: RigOptions { given: joints(command.joints.as_deref())?, ..command.rig_options.clone() },
        allow_prohibited: command.allow_prohibited,
        leg_colliders: command.leg_colliders,
        clock,
    };
    let file = File::read(&command.target)?;
    let (opened, named) = file.with(|source| Conversion::open(source, &options, &mut Progress::none()));
    Ok((opened.map_err(words::sentence)?, named))
}

/// The reference, where it is a model.
///
/// # Errors
/// One sentence that begins with the file's name.
pub fn reference(command: &Command) -> Result<Option<host::Reference>, String> {
    let Reference::Model(model) = &command.reference else {
        return Ok(None);
    };
    let map = humanoid_map(command.reference_humanoid.as_deref())?;
    let file = File::read(model)?;
    let (options, rig_options) = (&command.options, &command.rig_options);
    let (opened, _) = file.with(|source| host::Reference::open(source, map.as_ref(), options, rig_options));
    opened.map(Some).map_err(words::sentence_of_reference)
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
fn joints(path: Option<&Path>) -> Result<BTreeMap<Role, DVec3>, String> {
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
