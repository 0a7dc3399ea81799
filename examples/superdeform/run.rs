//! One run from files to files: load, deform, write; then the picture and the report.
//!
//! Everything is made in memory before the first file is written, so that bad input leaves no files.

use crate::cli::{self, Command, Reference};
use crate::progress::Progress;
use crate::words::{self, sentence, sentence_of_reference};
use crate::{input, output, report, shades, sheet};
use glam::DVec3;
use serde_json::json;
use std::path::PathBuf;
use std::sync::Arc;
use std::time::{Duration, Instant};
use superdeform::internals::parallel;
use superdeform::internals::shape::measured::Measured;
use superdeform::internals::shape::style::BUILT_IN;
use superdeform::report::FigureReport;
use superdeform::{BodyShape, Deformed, Deformer, Error, Report, Rig, RigOptions, Style, Warning, Weights};
use superdeform_host::file::GltfFile;
use superdeform_host::load::Loaded;
use superdeform_host::rig::{INFLUENCES, add_rig, rerigged};
use superdeform_host::write;

/// Stages that the progress bar counts.
const STAGE_COUNT: u64 = 7;

/// What a run leaves behind.
pub struct Done {
    /// The numbers.
    pub report: Report,
    /// What was written, by name.
    pub files: Vec<(&'static str, PathBuf)>,
}

/// Does what `command` says.
///
/// # Errors
/// One sentence; no file is left half-written.
pub fn run(command: &Command) -> Result<Done, String> {
    stages(command, None, &Progress::new(STAGE_COUNT, command.quiet))
}

/// The same with a reference that has been measured; the report holds `key`, by which a batch knows the run.
///
/// # Errors
/// As [`run`].
pub fn run_with(command: &Command, source: &Source, key: &str) -> Result<Done, String> {
    stages(command, Some((source, key)), &Progress::new(STAGE_COUNT, command.quiet))
}

/// Where proportions come from: the same for every target.
pub struct Source {
    reference: Option<Loaded>,
    measured: Option<Measured>,
    style: Style,
}

impl Source {
    /// Reads and measures the reference of `command`.
    ///
    /// # Errors
    /// One sentence that begins with the reference's name.
    pub fn of(command: &Command) -> Result<Self, String> {
        let reference = input::reference(command)?;
        let measured = reference.as_ref().map(|reference| measure(reference, command)).transpose()?;
        let style = style(command, measured.as_ref())?;
        Ok(Self { reference, measured, style })
    }
}

fn stages(command: &Command, in_batch: Option<(&Source, &str)>, progress: &Progress) -> Result<Done, String> {
    let start = Instant::now();
    let threads = command.options.thread_count;

    progress.stage("reading");
    let (own, (target, load_time)) = parallel::both(
        threads,
        || if in_batch.is_some() { None } else { Some(Source::of(command)) },
        || (read_target(command), start.elapsed()),
    );
    let mut target = target?;

    progress.stage("measuring");
    let own = own.transpose()?;
    let Source { reference, measured, style } = match (in_batch, &own) {
        (Some((source, _)), _) | (None, Some(source)) => source,
        (None, None) => unreachable!("a reference is read where there is no batch"),
    };

    progress.stage("rigging");
    let rig = rig(&mut target, command)?;

    progress.stage("deforming");
    let deformer = match &rig {
        Some(rig) => Deformer::with_rig(&target.character, rig, style, &command.options),
        None => Deformer::new(Arc::new(target.character.clone()), style, &command.options),
    };
    let deformer = deformer.map_err(sentence)?;
    let deformed = deformer.apply();
    let map_point = |joint: usize, point: DVec3| deformer.map(joint, point);
    let (made, report) = parallel::both(
        threads,
        || {
            let start = Instant::now();
            (model(&target, &deformer, &deformed, rig.as_ref()), start.elapsed())
        },
        || deformer.report(&deformed),
    );
    let mut report = report.map_err(sentence)?;
    if let Some(measured) = measured {
        // Measured over the roles of both, so that the two figures can be compared group by group.
        let of_target = &deformer.target().joints;
        let roles = measured.joints.keys().copied().filter(|role| of_target.contains_key(role)).collect();
        report.reference = Some(FigureReport::of(measured, &roles, &command.options));
    }
    report.warnings.splice(0..0, warnings_of_files(&target, reference.as_ref()));
    report.warnings.extend(write::colliders::findings(&target, &deformed, &map_point, command.leaf_joints));
    report.warnings.iter_mut().for_each(words::name_flag);

    progress.stage("drawing");
    let draw_start = Instant::now();
    let picture = match &command.picture {
        Some(path) => {
            Some((path, sheet::png(&target, reference.as_ref(), rig.as_ref(), &deformed, &report)?))
        }
        None => None,
    };
    let thumbnail = command.thumbnail.then(|| sheet::thumbnail(&target, &deformed, &report)).transpose()?;
    let draw_time = draw_start.elapsed();

    progress.stage("writing");
    let write_start = Instant::now();
    let (model, model_time) = made;
    let mut model = model.map_err(sentence)?;
    if command.leaf_joints {
        write::colliders::add_leaf_joints(&mut model, &target, &deformed, &map_point);
    }
    if let Some(png) = thumbnail {
        // What is no VRM has no thumbnail.
        write::set_thumbnail(&mut model, &png);
    }
    let model = model.to_bytes().map_err(sentence)?;
    let mut results = vec![("model", &command.output, model)];
    if let Some(path) = &command.save_rigged {
        results.push(("rigged target", path, rigged_target(&target, rig.as_ref()).map_err(sentence)?));
    }
    results.extend(picture.map(|(path, bytes)| ("picture", path, bytes)));
    if let (Some(path), Style::Shape(shape)) = (&command.save_style, style) {
        results.push(("style", path, shape.to_json().into_bytes()));
    }

    progress.stage("saving");
    for (_, path, bytes) in &results {
        output::write(path, bytes)?;
    }
    let mut files: Vec<_> = results.iter().map(|&(name, path, _)| (name, path.clone())).collect();
    report.timing_ms.load = milliseconds(load_time);
    report.timing_ms.write = milliseconds(model_time + write_start.elapsed());
    // The picture is made beside the result.
    report.timing_ms.total = milliseconds(start.elapsed() - draw_time);
    if let Some(path) = &command.report {
        let bytes = results[0].2.len();
        let batch = in_batch.map(|(_, key)| json!({"key": key, "bytes": bytes}));
        let aim = write::colliders::aim_turn(&target, &deformed).map(|(degrees, _)| degrees);
        report::write(&report, &target.licence, aim, batch, path)?;
        files.push(("report", path.clone()));
    }
    Ok(Done { report, files })
}

/// The target, its paint and what is said of its face.
fn read_target(command: &Command) -> Result<Loaded, String> {
    let mut target = input::target(command)?;
    check_licence(&target, command)?;
    let seen = sheet::appearance(&target);
    shades::shade(&mut target.character, &seen);
    target.character.face_hints = command.face_hints;
    Ok(target)
}

/// Refuses a target that may not be changed.
fn check_licence(target: &Loaded, command: &Command) -> Result<(), String> {
    let licence = &target.licence;
    if licence.is_prohibited() && !command.allow_prohibited {
        return Err(format!(
            "{}'s licence does not allow changes ({}): ask its author, or add --allow-prohibited if you are the author or may change it",
            target.file.name, licence.because
        ));
    }
    Ok(())
}

/// What was found while the files were read.
fn warnings_of_files(target: &Loaded, reference: Option<&Loaded>) -> Vec<Warning> {
    // To take a reference's proportions is no change of it.
    let about_licence = |code: &str| matches!(code, "modification_prohibited" | "redistribution_prohibited");
    let of_reference = reference.iter().flat_map(|reference| &reference.warnings);
    let of_reference = of_reference
        .filter(|warning| !about_licence(warning.code))
        .map(|warning| Warning::new(warning.code, format!("in the reference, {}", warning.message)));
    target.warnings.iter().cloned().chain(of_reference).collect()
}

/// The rig to deform by where the target's own is not kept: it has none, it is not wanted, or it does not say which
/// joint is which.
fn rig(target: &mut Loaded, command: &Command) -> Result<Option<Rig>, String> {
    let given = input::joints(command.joints.as_deref())?;
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

/// The weights that a file holds.
fn limited(rig: &Rig) -> Vec<Weights> {
    rig.skin_weights.iter().map(|weights| weights.limited(INFLUENCES)).collect()
}

/// The deformed target as a file; what came without joints goes out with those of its new rig.
fn model(
    target: &Loaded,
    deformer: &Deformer,
    deformed: &Deformed,
    rig: Option<&Rig>,
) -> superdeform::Result<GltfFile> {
    let mut file = write::rewrite(target, deformed, &|joint, point: DVec3| deformer.map(joint, point))?;
    if let Some(rig) = rig.filter(|_| !target.rigged) {
        let mut skeleton = rig.skeleton.clone();
        for (joint, &at) in skeleton.joints.iter_mut().zip(&deformed.joints) {
            joint.rest.w_axis = at.extend(1.0);
        }
        add_rig(&mut file, target, &skeleton, &limited(rig))?;
    }
    Ok(file)
}

/// The target with the rig that it was deformed by, not deformed.
fn rigged_target(target: &Loaded, rig: Option<&Rig>) -> superdeform::Result<Vec<u8>> {
    match rig {
        Some(rig) => rerigged(target, &rig.skeleton, &limited(rig))?.to_bytes(),
        None => target.file.to_bytes(),
    }
}

/// Measures a reference; its errors begin with the file's name.
fn measure(reference: &Loaded, command: &Command) -> Result<Measured, String> {
    let name = &reference.file.name;
    let failed = |error: Error| format!("{name}: {}", sentence_of_reference(error));
    let rigged = if reference.rigged {
        None
    } else {
        let rig = Rig::of(&reference.character, &command.rig_options).map_err(failed)?;
        Some(rig.applied_to(&reference.character))
    };
    let character = rigged.as_ref().unwrap_or(&reference.character);
    let mut measured = Measured::of(character, &command.options).map_err(failed)?;
    measured.shape.name = name.rsplit_once('.').map_or(name.as_str(), |(stem, _)| stem).to_string();
    Ok(measured)
}

/// The style that the command line asks for, mixed with a second one where it says so.
fn style(command: &Command, measured: Option<&Measured>) -> Result<Style, String> {
    let shape = match (&command.reference, measured) {
        (Reference::Heads(heads), _) => return Style::heads(*heads).map_err(sentence),
        (Reference::Style(path), _) => input::style(path)?,
        (Reference::BuiltIn(name), _) => BodyShape::built_in(name).ok_or_else(|| {
            format!("there is no built-in style {name}: name one of {}", BUILT_IN.join(", "))
        })?,
        (Reference::Model(_), Some(measured)) => measured.shape.clone(),
        (Reference::Model(path), None) => return Err(format!("{}: was not measured", path.display())),
    };
    let shape = match &command.blend {
        Some((path, share)) => shape.blended(&input::style(path)?, *share),
        None => shape,
    };
    Ok(Style::Shape(Box::new(shape)))
}

fn milliseconds(duration: Duration) -> f64 {
    1000.0 * duration.as_secs_f64()
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::Value;
    use std::path::Path;
    use superdeform_host::samples;
    use superdeform_host::verify::closure;

    #[test]
    fn what_may_not_be_changed_is_converted_for_its_author_alone() {
        let folder = std::env::temp_dir().join(format!("superdeform-licence-{}", std::process::id()));
        let (source, result) = (folder.join("a.glb"), folder.join("b.glb"));
        let report = folder.join("b.json");
        let mut file = GltfFile::read(&samples::data().join("kaykit_rogue.glb")).unwrap();
        let licence = "CC-BY-ND-4.0 (http://creativecommons.org/licenses/by-nd/4.0/)";
        file.json["asset"]["extras"] = json!({"license": licence});
        output::write(&source, &file.to_bytes().unwrap()).unwrap();
        let text = |path: &Path| path.to_str().unwrap().to_string();
        let mut arguments = ["superdeform", "", "sd2", "-q", "-o", "", "--report", ""].map(str::to_string);
        (arguments[1], arguments[5], arguments[7]) = (text(&source), text(&result), text(&report));
        let refusal = run(&cli::parse(&arguments).ok().unwrap()).err().unwrap();
        assert!(refusal.contains("by-nd") && refusal.contains("--allow-prohibited"), "{refusal}");
        assert!(!result.exists() && !report.exists());
        let allowed = arguments.iter().cloned().chain(["--allow-prohibited".to_string()]);
        let done = run(&cli::parse(allowed).ok().unwrap()).unwrap();
        assert!(done.report.warnings.iter().any(|warning| warning.code == "modification_prohibited"));
        let written: Value = serde_json::from_slice(&std::fs::read(&report).unwrap()).unwrap();
        assert_eq!(written["licence"]["changes"], "prohibited");
        assert!(written["result"]["heads"].is_f64());
        std::fs::remove_dir_all(&folder).unwrap();
    }

    #[test]
    fn the_sample_pair_is_written_where_the_field_takes_it() {
        let Ok(command) = crate::cli::parse(["superdeform", "--threads", "1"]) else {
            panic!("the sample pair was refused");
        };
        let target = input::target(&command).unwrap();
        let reference = input::reference(&command).unwrap().unwrap();
        let measured = measure(&reference, &command).unwrap();
        let style = style(&command, Some(&measured)).unwrap();
        let rig = Rig::of(&target.character, &command.rig_options).unwrap();
        let deformer = Deformer::with_rig(&target.character, &rig, &style, &command.options).unwrap();
        let deformed = deformer.apply();
        let map = |joint: usize, point: DVec3| deformer.map(joint, point);
        let written = write::rewrite(&target, &deformed, &map).unwrap();
        let closure = closure(&written, &target, &deformed).unwrap();
        assert!(closure.rest < 1e-5, "{closure:?}");
        assert!(closure.nodes.is_none_or(|share| share < 1e-5), "{closure:?}");
    }
}
