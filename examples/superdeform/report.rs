//! The report as a file, and as a few lines for a person.

use serde::Serialize;
use serde_json::Value;
use std::fmt::Write;
use std::path::{Path, PathBuf};
use superdeform::Report;
use superdeform_host::licence::Licence;

/// What stands in the file: the library's report, and what the host knows of the target's file.
#[derive(Serialize)]
struct FileReport<'a> {
    #[serde(flatten)]
    report: &'a Report,
    licence: Value,
    /// By how many degrees the aim constraint that turns most does at rest.
    #[serde(skip_serializing_if = "Option::is_none")]
    aim_degrees: Option<f64>,
    /// What a batch knows a finished run by.
    #[serde(skip_serializing_if = "Option::is_none")]
    batch: Option<Value>,
}

/// Writes `report` as indented JSON, with the licence of the target, its aim that turns most, and what a batch knows the run by.
///
/// # Errors
/// One sentence with the path and the reason.
pub fn write(
    report: &Report,
    licence: &Licence,
    aim_degrees: Option<f64>,
    batch: Option<Value>,
    path: &Path,
) -> Result<(), String> {
    let report = FileReport { report, licence: licence.to_json(), aim_degrees, batch };
    let mut text =
        serde_json::to_string_pretty(&report).map_err(|error| format!("{}: {error}", path.display()))?;
    text.push('\n');
    crate::output::write(path, text.as_bytes())
}

/// What a person wants to know: heads before and after, warnings, where the files are, how long it took.
///
/// `files` are names such as `model` with their paths.
pub fn summary(report: &Report, files: &[(&str, PathBuf)]) -> String {
    let mut text =
        format!("target {:.1} heads -> result {:.1} heads", report.target.heads, report.result.heads);
    if let Some(reference) = &report.reference {
        let _ = write!(text, ", reference {:.1} heads", reference.heads);
    }
    text.push('\n');
    for warning in &report.warnings {
        let _ = writeln!(text, "warning: {} ({})", warning.message, warning.code);
    }
    for (name, path) in files {
        let _ = writeln!(text, "{name:8} {}", path.display());
    }
    let _ = writeln!(text, "{:.2} s", report.timing_ms.total / 1000.0);
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use superdeform::Warning;
    use superdeform::report::FigureReport;

    #[test]
    fn the_summary_tells_heads_warnings_and_files() {
        let figure = |heads| FigureReport { heads, ..FigureReport::default() };
        let mut report = Report {
            target: figure(6.53),
            reference: Some(figure(2.5)),
            result: figure(2.61),
            warnings: vec![Warning::new("kind_guessed", "mesh 2 (Cap) counts as hair")],
            ..Report::default()
        };
        report.timing_ms.total = 1234.0;
        assert_eq!(
            summary(&report, &[("model", "a.glb".into())]),
            "target 6.5 heads -> result 2.6 heads, reference 2.5 heads\n\
             warning: mesh 2 (Cap) counts as hair (kind_guessed)\n\
             model    a.glb\n1.23 s\n"
        );
    }
}
