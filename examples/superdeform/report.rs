//! The report as a few lines for a person.

use std::fmt::Write;
use std::path::PathBuf;
use superdeform::{Report, Warning};

/// Warnings that are told by themselves, those that matter most first: what may not be done with the result, what is wrong with the
/// input, what will be seen. The rest are notes.
const TOLD: [&str; 17] = [
    "modification_prohibited",
    "redistribution_prohibited",
    "already_super_deformed",
    "pose_not_rest",
    "up_guessed",
    "facing_guessed",
    "rig_fallback_auto",
    "roles_from_geometry",
    "crown_not_found",
    "trunk_kept",
    "face_not_found",
    "face_eyes_not_found",
    "clothes_pierced",
    "spring_in_collider",
    "heads_limited",
    "aim_turned",
    "open_body",
];

/// So many of them are told.
const MOST_TOLD: usize = 2;

/// What a person should know, a line each: two warnings, and how many notes there are beside; or `all`.
pub fn notes(warnings: &[Warning], all: bool) -> String {
    let rank = |warning: &Warning| TOLD.iter().position(|code| *code == warning.code);
    let mut told: Vec<&Warning> = warnings.iter().filter(|warning| all || rank(warning).is_some()).collect();
    told.sort_by_key(|warning| rank(warning).unwrap_or(TOLD.len()));
    if !all {
        told.truncate(MOST_TOLD);
    }
    let mut text = String::new();
    for warning in &told {
        let _ = writeln!(text, "warning: {} ({})", warning.message, warning.code);
    }
    match warnings.len() - told.len() {
        0 => {}
        1 => text.push_str("1 note: -v or --report shows it\n"),
        count => {
            let _ = writeln!(text, "{count} notes: -v or --report shows them");
        }
    }
    text
}

/// What a person wants to know: heads before and after, where the files are, how long it took.
///
/// `files` are names such as `model` with their paths.
pub fn summary(report: &Report, files: &[(&str, PathBuf)]) -> String {
    let mut text =
        format!("target {:.1} heads -> result {:.1} heads", report.target.heads, report.result.heads);
    if let Some(reference) = &report.reference {
        let _ = write!(text, ", reference {:.1} heads", reference.heads);
    }
    text.push('\n');
    for (name, path) in files {
        let _ = writeln!(text, "{name:8} {}", path.display());
    }
    let _ = writeln!(text, "{:.2} s", report.timing_ms.total / 1000.0);
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use superdeform::report::FigureReport;

    #[test]
    fn two_warnings_are_told_and_the_rest_counted() {
        let warning = |code| Warning::new(code, "words");
        let kinds = ["kind_guessed"; 3].map(warning);
        assert_eq!(notes(&[], false), "");
        assert_eq!(notes(&kinds, false), "3 notes: -v or --report shows them\n");
        let many =
            ["kind_guessed", "open_body", "coefficient_limited", "face_not_found", "modification_prohibited"];
        assert_eq!(
            notes(&many.map(warning), false),
            "warning: words (modification_prohibited)\nwarning: words (face_not_found)\n\
             3 notes: -v or --report shows them\n"
        );
        assert_eq!(notes(&many.map(warning), true).lines().count(), 5);
        assert_eq!(
            notes(&["open_body", "group_split"].map(warning), false).lines().last().unwrap(),
            "1 note: -v or --report shows it"
        );
    }

    #[test]
    fn the_summary_tells_heads_and_files() {
        let figure = |heads| FigureReport { heads, ..FigureReport::default() };
        let mut report = Report {
            target: figure(6.53),
            reference: Some(figure(2.5)),
            result: figure(2.61),
            ..Report::default()
        };
        report.timing_ms.total = 1234.0;
        assert_eq!(
            summary(&report, &[("model", "a.glb".into())]),
            "target 6.5 heads -> result 2.6 heads, reference 2.5 heads\n\
             model    a.glb\n1.23 s\n"
        );
    }
}
