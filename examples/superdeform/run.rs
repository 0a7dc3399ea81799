//! One run from files to files: load, deform, write; then the picture and the report.
//!
//! Everything is made in memory before the first file is written, so that bad input leaves no files.

use crate::cli::{Command, Reference};
use crate::materials::{self, Material};
use crate::picture::{self, PictureMesh, View};
use crate::progress::Progress;
use crate::{output, report};
use glam::Vec3;
use regex::Regex;
use std::path::{Path, PathBuf};
use std::time::Instant;
use superdeform::pipeline::Deformed;
use superdeform::report::Report;
use superdeform::{Character, MeshKind};

/// What a run leaves behind.
pub struct Done {
    /// The numbers.
    pub report: Report,
    /// What was written, by name.
    pub files: Vec<(&'static str, PathBuf)>,
}

/// A character as a file has it, with what a picture needs beside what the library needs.
struct Loaded {
    character: Character,
    /// One for each of the character's meshes.
    surfaces: Vec<Surface>,
    /// The file's materials.
    materials: Vec<Material>,
    /// The way it looks; found from the joints where the command line does not say.
    forward: Vec3,
}

/// What a picture needs of a mesh beside its shape.
struct Surface {
    uvs: Vec<[f32; 2]>,
    colours: Vec<[f32; 4]>,
    material: Option<usize>,
}

/// Does what `command` says.
///
/// # Errors
/// One sentence; no file is left half-written.
pub fn run(command: &Command) -> Result<Done, String> {
    let progress = Progress::new(5, command.quiet);
    let result = stages(command, &progress);
    progress.finish();
    result
}

fn stages(command: &Command, progress: &Progress) -> Result<Done, String> {
    let start = Instant::now();
    progress.stage("reading");
    let target = load(
        &command.target,
        &Reading {
            humanoid: command.humanoid.as_deref(),
            kinds: &command.kinds,
            up: command.up,
            forward: command.forward,
        },
    )?;
    let reference = match &command.reference {
        Reference::Model(path) => Some(load(
            path,
            &Reading {
                humanoid: command.reference_humanoid.as_deref(),
                kinds: &[],
                up: None,
                forward: None,
            },
        )?),
        Reference::Style(_) | Reference::Heads(_) => None,
    };
    let load_time = start.elapsed();

    progress.stage("deforming");
    let (deformed, mut report) = deform(command, &target, reference.as_ref())?;

    progress.stage("writing");
    let write_start = Instant::now();
    let bytes = encode(&target, &deformed)?;
    progress.stage("drawing");
    let sheet = command
        .picture
        .is_some()
        .then(|| sheet(&target, reference.as_ref(), &deformed, &report));

    progress.stage("saving");
    let mut files = Vec::new();
    output::write(&command.output, &bytes)?;
    files.push(("model", command.output.clone()));
    if let (Some(path), Some(sheet)) = (&command.picture, &sheet) {
        picture::save(sheet, path)?;
        files.push(("picture", path.clone()));
    }
    report.timing_ms.load = 1000.0 * load_time.as_secs_f64();
    report.timing_ms.write = 1000.0 * write_start.elapsed().as_secs_f64();
    report.timing_ms.total = 1000.0 * start.elapsed().as_secs_f64();
    if let Some(path) = &command.report {
        report::write(&report, path)?;
        files.push(("report", path.clone()));
    }
    Ok(Done { report, files })
}

/// How a file is to be read where it does not say itself.
struct Reading<'a> {
    humanoid: Option<&'a Path>,
    kinds: &'a [(MeshKind, Regex)],
    up: Option<Vec3>,
    forward: Option<Vec3>,
}

fn load(path: &Path, reading: &Reading) -> Result<Loaded, String> {
    let bytes =
        std::fs::read(path).map_err(|error| format!("{}: cannot be read ({error})", path.display()))?;
    let _reading = (reading.humanoid, reading.kinds, reading.up, reading.forward);
    let materials = materials::materials(&serde_json::Value::Null, &bytes);
    let _uv_sets = materials.iter().map(|material| material.uv_set);
    Err(format!("{}: reading characters is not wired", path.display()))
}

fn deform(
    command: &Command,
    _target: &Loaded,
    _reference: Option<&Loaded>,
) -> Result<(Deformed, Report), String> {
    let _options = &command.options;
    Err("deforming is not wired".to_string())
}

fn encode(_target: &Loaded, _deformed: &Deformed) -> Result<Vec<u8>, String> {
    Err("writing characters is not wired".to_string())
}

/// Target, reference and result side by side, with their heads.
fn sheet(
    target: &Loaded,
    reference: Option<&Loaded>,
    deformed: &Deformed,
    report: &Report,
) -> image::RgbImage {
    let note = |heads: f64| format!("{heads:.1} heads");
    let mut views = vec![view("target", note(report.target.heads), target, None)];
    if let Some(reference) = reference {
        let heads = report.reference.as_ref().map_or(0.0, |figure| figure.heads);
        views.push(view("reference", note(heads), reference, None));
    }
    views.push(view("result", note(report.result.heads), target, Some(deformed)));
    picture::draw(&views)
}

/// A figure for the picture; where `deformed` is given, with its shape in place of the file's.
fn view<'a>(title: &str, note: String, loaded: &'a Loaded, deformed: Option<&'a Deformed>) -> View<'a> {
    static PLAIN: std::sync::LazyLock<Material> = std::sync::LazyLock::new(Material::default);
    let meshes = loaded.character.meshes.iter().zip(&loaded.surfaces).enumerate();
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
                        .and_then(|material| loaded.materials.get(material))
                        .unwrap_or(&PLAIN),
                }
            })
            .collect(),
        up: loaded.character.axes.up,
        forward: loaded.forward,
    }
}
