//! One run from files to files: load, deform, write; then the picture and the report.
//!
//! Everything is made in memory before the first file is written, so that bad input leaves no files.

use crate::appearance::{self, Appearance};
use crate::cli::{self, Command, Reference};
use crate::materials::Material;
use crate::picture::{self, PictureMesh, View};
use crate::progress::Progress;
use crate::words::{self, sentence};
use crate::{output, report};
use glam::{DVec3, Vec3};
use regex::Regex;
use serde_json::Value;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::{Arc, LazyLock};
use std::time::{Duration, Instant};
use superdeform::internals::shape::measured::Measured;
use superdeform::internals::shape::style::BUILT_IN;
use superdeform::report::FigureReport;
use superdeform::{
    Axes, BodyShape, Character, Deformed, Deformer, Error, MeshKind, Report, Rig, RigOptions, Role, Style,
    Warning, Weights, find_roles,
};
use superdeform_host::{self as host, accessor::Reader, file::GltfFile, load::LoadOptions, rig::INFLUENCES};

/// Stages that the progress bar counts.
const STAGE_COUNT: u64 = 7;

/// What a run leaves behind.
pub struct Done {
    /// The numbers.
    pub report: Report,
    /// What was written, by name.
    pub files: Vec<(&'static str, PathBuf)>,
}

/// A character as a file has it, with what a picture needs beside what the library needs.
struct Loaded {
    host: host::load::Loaded,
    appearance: Appearance,
}

/// How a file is to be read where it does not say itself.
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
    let mut target = load_target(command)?;
    let mut reference = load_reference(command)?;
    let load_time = start.elapsed();

    progress.stage("measuring");
    let study = match &reference {
        Some(reference) => Some(measure(reference, command)?),
        None => None,
    };
    let style = style(command, study.as_ref())?;

    progress.stage("rigging");
    let rig = rig(&mut target.host, command)?;

    progress.stage("deforming");
    let deformer = match &rig {
        Some(rig) => Deformer::with_rig(&target.host.character, rig, &style, &command.options),
        None => Deformer::new(Arc::new(target.host.character.clone()), &style, &command.options),
    };
    let deformer = deformer.map_err(sentence)?;
    let deformed = deformer.apply();
    let mut report = deformer.report(&deformed).map_err(sentence)?;
    if let Some(study) = &study {
        // Measured over the roles of both, so that the two figures can be compared group by group.
        let of_target = &deformer.target().joints;
        let roles = study.joints.keys().copied().filter(|role| of_target.contains_key(role)).collect();
        report.reference = Some(FigureReport::of(study, &roles, &command.options));
    }
    let mut warnings = target.host.warnings.clone();
    if let Some(reference) = &reference {
        warnings.extend(
            reference
                .host
                .warnings
                .iter()
                .map(|warning| Warning::new(warning.code, format!("in the reference, {}", warning.message))),
        );
    }
    report.warnings.splice(0..0, warnings);
    report.warnings.iter_mut().for_each(words::name_flag);

    progress.stage("drawing");
    let draw_start = Instant::now();
    if command.picture.is_some() {
        target.appearance = appearance(&target.host);
        if let Some(reference) = &mut reference {
            reference.appearance = appearance(&reference.host);
        }
    }
    let sheet = command.picture.is_some().then(|| sheet(&target, reference.as_ref(), &deformed, &report));

    let draw_time = draw_start.elapsed();

    progress.stage("writing");
    let write_start = Instant::now();
    let map = |joint: usize, point: DVec3| deformer.map(joint, point);
    let model = match &rig {
        // What came without joints goes out with them.
        Some(rig) if !target.host.rigged => rigged_model(&target.host, &deformed, &map, rig),
        _ => host::write::write(&target.host, &deformed, &map),
    };
    let model = model.map_err(|error| error.to_string())?;
    let rigged = match (&command.save_rigged, &rig) {
        (Some(path), Some(rig)) => Some((
            path,
            host::rig::rerigged(&target.host, &rig.skeleton, &limited(rig)).and_then(|file| file.to_bytes()),
        )),
        (Some(path), None) => Some((path, target.host.file.to_bytes())),
        (None, _) => None,
    };
    let rigged = match rigged {
        Some((path, bytes)) => Some((path, bytes.map_err(|error| error.to_string())?)),
        None => None,
    };

    progress.stage("saving");
    let mut files = Vec::new();
    output::write(&command.output, &model)?;
    files.push(("model", command.output.clone()));
    if let Some((path, bytes)) = rigged {
        output::write(path, &bytes)?;
        files.push(("rigged target", path.clone()));
    }
    if let (Some(path), Some(sheet)) = (&command.picture, &sheet) {
        picture::save(sheet, path)?;
        files.push(("picture", path.clone()));
    }
    if let (Some(path), Style::Shape(shape)) = (&command.save_style, &style) {
        output::write(path, shape.to_json().as_bytes())?;
        files.push(("style", path.clone()));
    }
    report.timing_ms.load = milliseconds(load_time);
    report.timing_ms.write = milliseconds(write_start.elapsed());
    // The picture is made beside the result.
    report.timing_ms.total = milliseconds(start.elapsed() - draw_time);
    if let Some(path) = &command.report {
        report::write(&report, path)?;
        files.push(("report", path.clone()));
    }
    Ok(Done { report, files })
}

/// The rig to deform by where the target's own is not kept: it has none, it is not wanted, or it does not say which
/// joint is which.
fn rig(target: &mut host::load::Loaded, command: &Command) -> Result<Option<Rig>, String> {
    let given = read_joints(command.joints.as_deref())?;
    let missing = target.character.humanoid.missing();
    let keep = target.rigged && command.rig != Some(cli::Rig::Auto);
    if keep && missing.is_empty() {
        if command.joints.is_some() {
            return Err("--joints is about a new rig, and the target has one: add --rig auto".to_string());
        }
        return Ok(None);
    }
    if keep {
        let message = format!(
            "{} shows no joint for the role {}, so a new rig was found for the deformation and the file's own joints ride along: name roles to use the file's rig",
            target.file.name, missing[0]
        );
        target.warnings.push(Warning::new("rig_fallback_auto", message).about("humanoid"));
    }
    let options = RigOptions { given, ..command.rig_options.clone() };
    let rig = Rig::of(&target.character, &options).map_err(sentence)?;
    target.character.axes.forward = Some(rig.forward.as_vec3());
    Ok(Some(rig))
}

/// Reads known joints: an object of role -> [x, y, z].
fn read_joints(path: Option<&Path>) -> Result<BTreeMap<Role, DVec3>, String> {
    let Some(path) = path else {
        return Ok(BTreeMap::new());
    };
    let place = path.display();
    let text = std::fs::read_to_string(path).map_err(|error| format!("{place}: cannot be read ({error})"))?;
    let joints: BTreeMap<String, [f64; 3]> = serde_json::from_str(&text).map_err(|error| {
        format!("{place}: must be a JSON object such as {{\"leftHand\": [0.5, 1.2, 0]}} ({error})")
    })?;
    joints
        .into_iter()
        .map(|(name, at)| {
            let role = Role::parse(&name).ok_or_else(|| format!("{place}: {name} is no humanoid role"))?;
            Ok((role, DVec3::from_array(at)))
        })
        .collect()
}

/// The weights that a file holds.
fn limited(rig: &Rig) -> Vec<Weights> {
    rig.skin_weights.iter().map(|weights| weights.limited(INFLUENCES)).collect()
}

/// The deformed target with the joints of its new rig, where the field takes them.
fn rigged_model(
    target: &host::load::Loaded,
    deformed: &Deformed,
    map: &host::write::MapPoint,
    rig: &Rig,
) -> superdeform::Result<Vec<u8>> {
    let mut file = host::write::rewrite(target, deformed, map)?;
    let mut skeleton = rig.skeleton.clone();
    for (joint, &at) in skeleton.joints.iter_mut().zip(&deformed.joints) {
        joint.rest.w_axis = at.extend(1.0);
    }
    host::rig::add_rig(&mut file, target, &skeleton, &limited(rig))?;
    file.to_bytes()
}

fn load_target(command: &Command) -> Result<Loaded, String> {
    let reading = Reading {
        humanoid_map: read_map(command.humanoid.as_deref())?,
        kinds: &command.kinds,
        axes: command.axes,
        sentence: words::sentence,
        incomplete_rig: command.rig != Some(cli::Rig::Keep),
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
        sentence: words::sentence_of_reference,
        incomplete_rig: false,
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
        incomplete_rig: reading.incomplete_rig,
    };
    let host =
        GltfFile::read(path).and_then(|file| host::load::load(file, &options)).map_err(reading.sentence)?;
    Ok(Loaded { host, appearance: Appearance::default() })
}

/// What the picture needs beside the shape: read only where there is to be a picture.
fn appearance(host: &host::load::Loaded) -> Appearance {
    let primitives = host.bindings.iter().map(|binding| (binding.mesh, binding.primitive));
    let reader = Reader::new(&host.file);
    appearance::read(&host.file.json, &host.file.binary, primitives, |accessor, components| {
        reader.floats(accessor, components, None).ok()
    })
}

/// Measures a reference; its errors begin with the file's name.
fn measure(reference: &Loaded, command: &Command) -> Result<Measured, String> {
    let name = &reference.host.file.name;
    let rigged = match reference.host.rigged {
        true => None,
        false => Some(Rig::of(&reference.host.character, &command.rig_options)),
    };
    let rigged =
        rigged.transpose().map_err(|error| format!("{name}: {}", words::sentence_of_reference(error)))?;
    let rigged = rigged.map(|rig| rig.applied_to(&reference.host.character));
    let character = rigged.as_ref().unwrap_or(&reference.host.character);
    let mut study = Measured::of(character, &command.options)
        .map_err(|error| format!("{name}: {}", words::sentence_of_reference(error)))?;
    study.shape.name = name.rsplit_once('.').map_or(name.as_str(), |(stem, _)| stem).to_string();
    Ok(study)
}

/// The style that the command line asks for, mixed with a second one where it says so.
fn style(command: &Command, study: Option<&Measured>) -> Result<Style, String> {
    let shape = match (&command.reference, study) {
        (Reference::Heads(heads), _) => return Style::heads(*heads).map_err(sentence),
        (Reference::Style(path), _) => read_style(path)?,
        (Reference::BuiltIn(name), _) => BodyShape::built_in(name).ok_or_else(|| {
            format!("there is no built-in style {name}: name one of {}", BUILT_IN.join(", "))
        })?,
        (Reference::Model(_), Some(study)) => study.shape.clone(),
        (Reference::Model(path), None) => return Err(format!("{}: was not measured", path.display())),
    };
    let shape = match &command.blend {
        Some((path, share)) => shape.blended(&read_style(path)?, *share),
        None => shape,
    };
    Ok(Style::Shape(Box::new(shape)))
}

fn read_style(path: &Path) -> Result<BodyShape, String> {
    let place = path.display();
    let text = std::fs::read_to_string(path).map_err(|error| format!("{place}: cannot be read ({error})"))?;
    BodyShape::from_json(&text).map_err(|error| format!("{place}: {error}"))
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
        let note = report.reference.as_ref().map_or(String::new(), |figure| heads(figure.heads));
        views.push(view("reference", note, reference, None));
    }
    views.push(view("result", heads(report.result.heads), target, Some(deformed)));
    picture::draw(&views)
}

/// A figure for the picture; where `deformed` is given, with its shape in place of the file's.
fn view<'a>(title: &str, note: String, loaded: &'a Loaded, deformed: Option<&'a Deformed>) -> View<'a> {
    static PLAIN: LazyLock<Material> = LazyLock::new(Material::default);
    let Loaded { host, appearance } = loaded;
    let character = &host.character;
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
    fn the_sample_pair_is_written_where_the_field_takes_it() {
        let Ok(command) = crate::cli::parse(["superdeform", "--threads", "1"]) else {
            panic!("the sample pair was refused");
        };
        let target = load_target(&command).unwrap();
        let reference = load_reference(&command).unwrap().unwrap();
        let study = measure(&reference, &command).unwrap();
        let style = style(&command, Some(&study)).unwrap();
        let rig = Rig::of(&target.host.character, &command.rig_options).unwrap();
        let deformer = Deformer::with_rig(&target.host.character, &rig, &style, &command.options).unwrap();
        let deformed = deformer.apply();
        let map = |joint: usize, point: DVec3| deformer.map(joint, point);
        let written = host::write::rewrite(&target.host, &deformed, &map).unwrap();
        let closure = host::verify::closure(&written, &target.host, &deformed).unwrap();
        assert!(closure.rest < 1e-5, "{closure:?}");
        assert!(closure.nodes.is_none_or(|share| share < 1e-5), "{closure:?}");
    }

    #[test]
    fn a_character_looks_where_its_limbs_say() {
        let mut character = Character::default();
        for (index, (role, x)) in
            [(Role::LeftUpperArm, -1.0), (Role::RightUpperArm, 1.0)].into_iter().enumerate()
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
