//! The report as a few lines for a person.

use std::fmt::Write;
use std::path::PathBuf;
use superdeform::Report;

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
