//! One run from files to files: load, deform, write; then the picture and the report.
//!
//! Everything is made in memory before the first file is written, so that bad input leaves no files.

use crate::appearance::{self, Appearance};
use crate::cli::{Command, Reference};
use crate::host::accessor::Reader;
use crate::host::file::GltfFile;
use crate::host::load::{self as files, LoadOptions};
use crate::host::write;
use crate::materials::Material;
use crate::picture::{self, PictureMesh, View};
use crate::progress::Progress;
use crate::{output, report};
use glam::{DVec3, Vec3};
use regex::Regex;
use serde_json::Value;
use std::path::{Path, PathBuf};
use std::sync::{Arc, LazyLock};
use std::time::{Duration, Instant};
use superdeform::character::roles::find_roles;
use superdeform::pipeline::{Deformed, Deformer, Style};
use superdeform::report::Report;
use superdeform::shape::{BodyShape, Study};
use superdeform::{Axes, Character, MeshKind, Warning};

/// Stages that the progress bar counts.
const STAGE_COUNT: u64 = 5;

/// What a run leaves behind.
pub struct Done {
    /// The numbers.
    pub report: Report,
    /// What was written, by name.
    pub files: Vec<(&'static str, PathBuf)>,
}

/// A character as a file has it, with what a picture needs beside what the library needs.
struct Loaded {
    file: files::Loaded,
    character: Arc<Character>,
    appearance: Option<Appearance>,
}

/// How a file is to be read where it does not say itself.
struct Reading<'a> {
    /// Role to node name.
    humanoid_map: Option<Value>,
    kinds: &'a [(MeshKind, Regex)],
    axes: Axes,
    /// Whether a picture is to be drawn of it.
    to_be_drawn: bool,
    /// What a sentence about a role that is not found names as the remedy.
    map_option: &'static str,
}

/// Does what `command` says.
///
/// # Errors
/// One sentence; no file is left half-written.
pub fn run(command: &Command) -> Result<Done, String> {
    stages(command, &Progress::new(STAGE_COUNT, command.quiet))
}

fn stages(command: &Command, progress: &Progress) -> Result<Done, String> {
    let start = Instant::now();
    progress.stage("reading");
    let target = load_target(command)?;
    let reference = load_reference(command)?;
    let load_time = start.elapsed();

    progress.stage("deforming");
    let (style, reference_study) = style(command, reference.as_ref())?;
    let deformer = Deformer::new(Arc::clone(&target.character), &style, &command.options)
        .map_err(|error| about(&command.target, error))?;
    let deformed = deformer.apply();
    let mut report = deformer.report(&deformed).map_err(|error| about(&command.target, error))?;
    if let Some(study) = &reference_study {
        let shape = &study.shape;
        report.reference = Some(study.report(&shape.roles(), &command.options));
        if let Some(numbers) = &mut report.reference {
            // The groups of both are measured over the roles that both have.
            numbers.shape = deformer.group_shapes(shape);
        }
    }
    let mut warnings = target.file.warnings.clone();
    if let Some(reference) = &reference {
        warnings.extend(reference.file.warnings.iter().map(|warning| Warning {
            code: warning.code,
            message: format!("reference: {}", warning.message),
        }));
    }
    warnings.append(&mut report.warnings);
    report.warnings = warnings;

    let undrawn = start.elapsed();
    progress.stage("drawing");
    let sheet = command
        .picture
        .is_some()
        .then(|| sheet(&target, reference.as_ref(), &deformed, &report));
    let drawing = start.elapsed() - undrawn;

    progress.stage("writing");
    let write_start = Instant::now();
    let map = |joint: usize, point: DVec3| deformer.map(joint, point);
    let model = write::write(&target.file, &deformed, &map).map_err(|error| about(&command.target, error))?;

    progress.stage("saving");
    let mut files = Vec::new();
    output::write(&command.output, &model)?;
    files.push(("model", command.output.clone()));
    report.timing_ms.load = milliseconds(load_time);
    report.timing_ms.write = milliseconds(write_start.elapsed());
    // The picture is beside the point of the times.
    report.timing_ms.total = milliseconds(start.elapsed() - drawing);
    if let (Some(path), Some(sheet)) = (&command.picture, &sheet) {
        picture::save(sheet, path)?;
        files.push(("picture", path.clone()));
    }
    if let Some(path) = &command.report {
        report::write(&report, path)?;
        files.push(("report", path.clone()));
    }
    if let Some(path) = &command.save_style {
        let Style::Shape(shape) = &style else {
            return Err(format!(
                "{}: a style for N heads has no proportions of its own to save: give a reference",
                path.display()
            ));
        };
        output::write(path, shape.to_json().as_bytes())?;
        files.push(("style", path.clone()));
    }
    Ok(Done { report, files })
}

/// The library's sentence, with the file that it is about.
fn about(path: &Path, error: superdeform::Error) -> String {
    let name = path.display().to_string();
    let message = error.message;
    if message.contains(&name) { message } else { format!("{name}: {message}") }
}

/// The style that the command line asks for, and the study of its model where there is one.
fn style(command: &Command, reference: Option<&Loaded>) -> Result<(Style, Option<Study>), String> {
    let mut study = None;
    let style = match (&command.reference, reference) {
        (Reference::Model(path), Some(reference)) => {
            let measured =
                Study::of(&reference.character, &command.options).map_err(|error| about(path, error))?;
            let mut shape = measured.shape.clone();
            shape.name = path.file_stem().map_or(String::new(), |stem| stem.to_string_lossy().into_owned());
            study = Some(measured);
            Style::Shape(Box::new(shape))
        }
        (Reference::Style(path), _) => match Style::built_in(&path.to_string_lossy()) {
            Some(style) => style,
            None => Style::Shape(Box::new(read_style(path)?)),
        },
        (Reference::Heads(heads), _) => Style::heads(*heads).map_err(|error| error.message)?,
        (Reference::Model(path), None) => return Err(format!("{}: was not read", path.display())),
    };
    let Some((path, amount)) = &command.blend else { return Ok((style, study)) };
    let other = read_style(path)?;
    match style {
        Style::Shape(shape) => Ok((Style::Shape(Box::new(shape.blended(&other, *amount))), None)),
        Style::Heads(_) => {
            Err(format!("{}: a style for N heads cannot be blended: give a reference", path.display()))
        }
    }
}

fn read_style(path: &Path) -> Result<BodyShape, String> {
    let text = std::fs::read_to_string(path)
        .map_err(|error| format!("{}: cannot be read ({error})", path.display()))?;
    BodyShape::from_json(&text).map_err(|error| about(path, error))
}

fn load_target(command: &Command) -> Result<Loaded, String> {
    let reading = Reading {
        humanoid_map: read_map(command.humanoid.as_deref())?,
        kinds: &command.kinds,
        axes: command.axes,
        to_be_drawn: command.picture.is_some(),
        map_option: "--humanoid",
    };
    load(&command.target, &reading)
}

fn load_reference(command: &Command) -> Result<Option<Loaded>, String> {
    let Reference::Model(path) = &command.reference else {
        return Ok(None);
    };
    let reading = Reading {
        humanoid_map: read_map(command.reference_humanoid.as_deref())?,
        kinds: &[],
        axes: Axes::default(),
        to_be_drawn: command.picture.is_some(),
        map_option: "--reference-humanoid",
    };
    load(path, &reading).map(Some)
}

/// Reads a humanoid map; whether its roles and nodes exist is for the loader to say.
fn read_map(path: Option<&Path>) -> Result<Option<Value>, String> {
    let Some(path) = path else {
        return Ok(None);
    };
    let place = path.display();
    let text = std::fs::read_to_string(path).map_err(|error| format!("{place}: cannot be read ({error})"))?;
    match serde_json::from_str(&text) {
        Ok(map @ Value::Object(_)) => Ok(Some(map)),
        Ok(_) => Err(format!("{place}: must be a JSON object such as {{\"hips\": \"NODE NAME\"}}")),
        Err(error) => Err(format!("{place}: is no JSON ({error})")),
    }
}

fn load(path: &Path, reading: &Reading) -> Result<Loaded, String> {
    let options = LoadOptions {
        axes: reading.axes,
        humanoid_map: reading.humanoid_map.as_ref(),
        kinds: reading.kinds,
        find_roles: Some(&find_roles),
        without_rig: false,
    };
    let read = || -> superdeform::Result<files::Loaded> { files::load(GltfFile::read(path)?, &options) };
    let file = read().map_err(|error| about(path, error).replace("--humanoid", reading.map_option))?;
    let appearance = reading.to_be_drawn.then(|| {
        let reader = Reader::new(&file.file);
        let primitives: Vec<(usize, usize)> =
            file.bindings.iter().map(|binding| (binding.mesh, binding.primitive)).collect();
        appearance::read(&file.file.json, &file.file.binary, primitives, |accessor, components| {
            reader.floats(accessor, components, None).ok()
        })
    });
    Ok(Loaded { character: Arc::new(file.character.clone()), file, appearance })
}

/// Target, reference and result side by side, with their heads.
fn sheet(
    target: &Loaded,
    reference: Option<&Loaded>,
    deformed: &Deformed,
    report: &Report,
) -> image::RgbImage {
    let heads = |heads: f64| format!("{heads:.1} heads");
    let mut views = vec![view("target", heads(report.target.heads), target, None)];
    if let Some(reference) = reference {
        let note = report
            .reference
            .as_ref()
            .map_or(String::new(), |figure| heads(figure.heads));
        views.push(view("reference", note, reference, None));
    }
    views.push(view("result", heads(report.result.heads), target, Some(deformed)));
    picture::draw(&views)
}

/// A figure for the picture; where `deformed` is given, with its shape in place of the file's.
fn view<'a>(title: &str, note: String, loaded: &'a Loaded, deformed: Option<&'a Deformed>) -> View<'a> {
    static PLAIN: LazyLock<Material> = LazyLock::new(Material::default);
    static NOTHING: LazyLock<Appearance> = LazyLock::new(Appearance::default);
    let character = &loaded.character;
    let appearance = loaded.appearance.as_ref().unwrap_or(&NOTHING);
    let meshes = character.meshes.iter().zip(&appearance.surfaces).enumerate();
    View {
        title: title.to_string(),
        note,
        meshes: meshes
            .map(|(index, (mesh, surface))| {
                let shape = deformed.map(|deformed| &deformed.meshes[index]);
                PictureMesh {
                    positions: shape.map_or(&mesh.positions, |shape| &shape.positions),
                    normals: shape.map_or(&mesh.normals, |shape| &shape.normals),
                    triangles: &mesh.triangles,
                    uvs: &surface.uvs,
                    colours: &surface.colours,
                    material: surface
                        .material
                        .and_then(|material| appearance.materials.get(material))
                        .unwrap_or(&PLAIN),
                }
            })
            .collect(),
        up: character.axes.up,
        forward: facing(character),
    }
}

/// The way a character looks: as its axes say, else at right angles to up and to the line from its right limbs to
/// its left ones.
fn facing(character: &Character) -> Vec3 {
    if let Some(forward) = character.axes.forward {
        return forward;
    }
    let place = |joint: usize| character.skeleton.joints[joint].position();
    let leftward: DVec3 = character
        .humanoid
        .iter()
        .filter(|(role, _)| role.is_left())
        .filter_map(|(role, joint)| Some(place(joint) - place(character.humanoid.joint(role.mirrored())?)))
        .sum();
    leftward.as_vec3().cross(character.axes.up).normalize_or(Vec3::Z)
}

fn milliseconds(duration: Duration) -> f64 {
    1000.0 * duration.as_secs_f64()
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DMat4;
    use superdeform::{Joint, Role};

    #[test]
    fn a_character_looks_where_its_limbs_say() {
        let mut character = Character::default();
        for (index, (role, x)) in [(Role::LeftUpperArm, -1.0), (Role::RightUpperArm, 1.0)]
            .into_iter()
            .enumerate()
        {
            character.humanoid.set(role, index);
            character.skeleton.joints.push(Joint {
                name: role.to_string(),
                parent: None,
                rest: DMat4::from_translation(DVec3::new(x, 1.0, 0.0)),
            });
        }
        assert_eq!(facing(&character), -Vec3::Z);
        character.axes.forward = Some(Vec3::X);
        assert_eq!(facing(&character), Vec3::X);
        assert_eq!(facing(&Character::default()), Vec3::Z);
    }
}
