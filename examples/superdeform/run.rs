//! One run from files to files: load, deform, write; then the picture and the report.
//!
//! Everything is made in memory before the first file is written, so that bad input leaves no files.

use crate::cli::{self, Command, Reference};
use crate::progress::Progress;
use crate::words::{self, sentence};
use crate::{input, output, sheet};
use serde_json::json;
use std::path::PathBuf;
use std::sync::LazyLock;
use std::time::Instant;
use superdeform::internals::parallel;
use superdeform::internals::shape::style::BUILT_IN;
use superdeform::{BodyShape, Report, Style};
use superdeform_host::conversion::{self as host, WriteOptions};

/// Stages that the progress bar counts.
const STAGE_COUNT: u64 = 5;

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
    reference: Option<host::Reference>,
    style: Style,
}

impl Source {
    /// Reads and measures the reference of `command`.
    ///
    /// # Errors
    /// One sentence that begins with the reference's name.
    pub fn of(command: &Command) -> Result<Self, String> {
        let reference = input::reference(command)?;
        let style = style(command, reference.as_ref())?;
        Ok(Self { reference, style })
    }
}

/// Milliseconds since it was first asked.
fn clock() -> f64 {
    static START: LazyLock<Instant> = LazyLock::new(Instant::now);
    1000.0 * START.elapsed().as_secs_f64()
}

fn stages(command: &Command, in_batch: Option<(&Source, &str)>, progress: &Progress) -> Result<Done, String> {
    let start = clock();
    progress.stage("reading");
    let (own, target) = parallel::both(
        command.options.thread_count,
        || if in_batch.is_some() { None } else { Some(Source::of(command)) },
        || input::target(command, clock),
    );
    let ((mut conversion, named), own) = (target?, own.transpose()?);
    let Source { reference, style } = match (in_batch, &own) {
        (Some((source, _)), _) | (None, Some(source)) => source,
        (None, None) => unreachable!("a reference is read where there is no batch"),
    };

    progress.stage("deforming");
    conversion.set(style, &command.options, &mut superdeform::Progress::none()).map_err(sentence)?;
    let options = WriteOptions { even_eyes: command.even_eyes, leaf_joints: command.leaf_joints };
    let mut converted = conversion.write(reference.as_ref(), &options).map_err(sentence)?;
    converted.report.warnings.iter_mut().for_each(words::name_flag);

    progress.stage("drawing");
    let draw_start = clock();
    let picture = match &command.picture {
        Some(path) => Some((path, sheet::png(&conversion, reference.as_ref(), &converted)?)),
        None => None,
    };
    if command.thumbnail {
        converted.set_thumbnail(&sheet::thumbnail(&conversion, &converted)?);
    }
    let draw_time = clock() - draw_start;

    progress.stage("writing");
    let write_start = clock();
    let name = command.output.file_name().unwrap_or_default().to_string_lossy();
    let mut results = Vec::new();
    for (index, (part, bytes)) in converted.files(&name).map_err(sentence)?.into_iter().enumerate() {
        let path = if index == 0 { command.output.clone() } else { command.output.with_file_name(part) };
        if named.iter().any(|named| cli::same_file(named, &path)) {
            // An image of the target, beside which the result is written.
            if std::fs::read(&path).is_ok_and(|there| there == bytes) {
                continue;
            }
            let path = path.display();
            return Err(format!(
                "{path}, which the target needs, would be written over: give another path for the result"
            ));
        }
        results.push((if index == 0 { "model" } else { "with it" }, path, bytes));
    }
    if let Some(path) = &command.save_rigged {
        let rigged = conversion.rigged().and_then(|file| file.to_bytes()).map_err(sentence)?;
        results.push(("rigged target", path.clone(), rigged));
    }
    results.extend(picture.map(|(path, bytes)| ("picture", path.clone(), bytes)));
    if let (Some(path), Style::Shape(shape)) = (&command.save_style, style) {
        results.push(("style", path.clone(), shape.to_json().into_bytes()));
    }

    progress.stage("saving");
    for (_, path, bytes) in &results {
        output::write(path, bytes)?;
    }
    let size = results[0].2.len();
    let mut files: Vec<_> = results.into_iter().map(|(name, path, _)| (name, path)).collect();
    let timing = &mut converted.report.timing_ms;
    timing.write += clock() - write_start;
    // The picture is made beside the result.
    timing.total = clock() - start - draw_time;
    if let Some(path) = &command.report {
        let batch = in_batch.map(|(_, key)| json!({"key": key, "bytes": size}));
        let text = converted.report_text(batch).map_err(sentence)?;
        output::write(path, text.as_bytes())?;
        files.push(("report", path.clone()));
    }
    Ok(Done { report: converted.report, files })
}

/// The style that the command line asks for, mixed with a second one where it says so.
fn style(command: &Command, reference: Option<&host::Reference>) -> Result<Style, String> {
    let shape = match (&command.reference, reference) {
        (Reference::Heads(heads), _) => return Style::heads(*heads).map_err(sentence),
        (Reference::Style(path), _) => input::style(path)?,
        (Reference::BuiltIn(name), _) => BodyShape::built_in(name).ok_or_else(|| {
            format!("there is no built-in style {name}: name one of {}", BUILT_IN.join(", "))
        })?,
        (Reference::Model(_), Some(reference)) => reference.shape().clone(),
        (Reference::Model(_), None) => unreachable!("a model is read before its style is asked for"),
    };
    let shape = match &command.blend {
        Some((path, share)) => shape.blended(&input::style(path)?, *share),
        None => shape,
    };
    Ok(Style::Shape(Box::new(shape)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;
    use serde_json::Value;
    use std::path::Path;
    use superdeform_host::file::GltfFile;
    use superdeform_host::samples;
    use superdeform_host::verify::closure;
    use superdeform_host::write::rewrite;

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
    fn a_gltf_and_what_lies_beside_it_is_read_written_and_never_written_over() {
        let folder = std::env::temp_dir().join(format!("superdeform-gltf-{}", std::process::id()));
        let mut file = GltfFile::read(&samples::data().join("kaykit_rogue.glb")).unwrap();
        file.images.insert("maps/skin.png".into(), std::sync::Arc::new(vec![1, 2, 3]));
        file.json["images"].as_array_mut().unwrap().push(json!({"uri": "maps/skin.png"}));
        for (name, bytes) in file.to_parts("a.gltf").unwrap() {
            output::write(&folder.join(name), &bytes).unwrap();
        }
        let path = |name: &str| folder.join(name).to_str().unwrap().to_string();
        let convert = |result: &str| {
            let words =
                ["superdeform", &path("a.gltf"), "sd2", "-q", "-o", &path(result)].map(str::to_string);
            run(&cli::parse(words).ok().unwrap())
        };
        let written = |result: &str| -> Vec<PathBuf> {
            convert(result).unwrap().files.into_iter().map(|(_, path)| path).collect()
        };
        let paths = |names: &[&str]| names.iter().map(|name| folder.join(name)).collect::<Vec<_>>();
        assert_eq!(written("b.glb"), paths(&["b.glb"]));
        // The image that both have stays.
        assert_eq!(written("b.gltf"), paths(&["b.gltf", "b.bin"]));
        assert_eq!(written("x/b.gltf"), paths(&["x/b.gltf", "x/b.bin", "x/maps/skin.png"]));
        for result in ["b.glb", "b.gltf", "x/b.gltf"] {
            let file = GltfFile::read(&folder.join(result)).unwrap();
            let last = file.list("images").len() - 1;
            assert!(file.image(last).unwrap() == [1, 2, 3].as_slice(), "{result}");
        }
        std::fs::rename(folder.join("a.gltf"), folder.join("c.gltf")).unwrap();
        let words = ["superdeform", &path("c.gltf"), "sd2", "-q", "-o", &path("a.gltf")].map(str::to_string);
        let refusal = run(&cli::parse(words).ok().unwrap()).err().unwrap();
        assert!(refusal.contains("a.bin") && !folder.join("a.gltf").exists(), "{refusal}");
        std::fs::remove_dir_all(&folder).unwrap();
    }

    #[test]
    fn the_sample_pair_is_written_where_the_field_takes_it() {
        let Ok(command) = crate::cli::parse(["superdeform", "--threads", "1"]) else {
            panic!("the sample pair was refused");
        };
        let (mut conversion, _) = input::target(&command, clock).unwrap();
        let source = Source::of(&command).unwrap();
        conversion.set(&source.style, &command.options, &mut superdeform::Progress::none()).unwrap();
        let converted = conversion.write(None, &WriteOptions::default()).unwrap();
        let deformer = conversion.deformer().unwrap();
        let map = |joint: usize, point: DVec3| deformer.map(joint, point);
        // As the file is but for its new joints, which `closure` does not know.
        let written = rewrite(conversion.target(), &converted.deformed, &map).unwrap();
        let closure = closure(&written, conversion.target(), &converted.deformed).unwrap();
        assert!(closure.rest < 1e-5, "{closure:?}");
        assert!(closure.nodes.is_none_or(|share| share < 1e-5), "{closure:?}");
    }
}
