//! What became of a batch: a line for each file while it runs, a table and `summary.json` at its end.

use serde::Serialize;
use serde_json::{Value, json};
use std::fmt::Write;
use std::path::PathBuf;

/// What became of one file.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Status {
    /// Converted in this run.
    Done,
    /// Finished before: same file, same style, same options.
    Skipped,
    /// Not converted.
    Failed,
}

/// A row of the table.
#[derive(Clone, Debug, Serialize)]
pub struct Row {
    /// The file.
    pub input: PathBuf,
    /// Its result.
    pub output: PathBuf,
    /// The numbers of its run.
    pub report: PathBuf,
    /// What became of it.
    pub status: Status,
    /// Heads before and after; none where it failed.
    pub heads: Option<[f64; 2]>,
    /// Codes of its warnings.
    pub warnings: Vec<String>,
    /// What its file says of its licence.
    pub licence: Value,
    /// How long its run took.
    pub seconds: f64,
    /// Why it failed, in one sentence.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub error: Option<String>,
}

impl Row {
    /// Fills in what stands in the `report` of a finished run.
    pub fn read(&mut self, report: &Value) {
        let heads = |figure: &str| report[figure]["heads"].as_f64();
        self.heads = heads("target").zip(heads("result")).map(|(before, after)| [before, after]);
        let warnings = report["warnings"].as_array().into_iter().flatten();
        self.warnings = warnings.filter_map(|warning| warning["code"].as_str()).map(str::to_string).collect();
        self.licence = report["licence"].clone();
        self.seconds = report["timing_ms"]["total"].as_f64().unwrap_or(0.0) / 1000.0;
    }

    fn heads_text(&self) -> String {
        self.heads.map_or_else(String::new, |[before, after]| format!("{before:.1} -> {after:.1}"))
    }

    /// The line that is printed when the file is through.
    pub fn line(&self) -> String {
        let name = self.input.display();
        match (self.status, &self.error) {
            (Status::Failed, Some(error)) => format!("failed   {name}: {error}"),
            (status, _) => {
                let word = if status == Status::Skipped { "skipped" } else { "done" };
                let warnings = match self.warnings.len() {
                    0 => String::new(),
                    1 => ", 1 warning".to_string(),
                    count => format!(", {count} warnings"),
                };
                format!("{word:8} {name}: {} heads, {:.2} s{warnings}", self.heads_text(), self.seconds)
            }
        }
    }
}

/// How many rows have `status`.
pub fn count(rows: &[Row], status: Status) -> usize {
    rows.iter().filter(|row| row.status == status).count()
}

/// The table: file, heads, warnings, licence, seconds.
pub fn table(rows: &[Row], seconds: f64) -> String {
    let mut lines = vec![["file", "", "heads", "warnings", "licence", "seconds"].map(str::to_string)];
    for row in rows {
        let status = match row.status {
            Status::Done => "done",
            Status::Skipped => "skipped",
            Status::Failed => "failed",
        };
        lines.push([
            row.input.display().to_string(),
            status.to_string(),
            row.heads_text(),
            row.warnings.join(" "),
            row.licence["changes"].as_str().unwrap_or("").to_string(),
            format!("{:.2}", row.seconds),
        ]);
    }
    let width = |column: usize| lines.iter().map(|line| line[column].chars().count()).max().unwrap_or(0);
    let widths: [usize; 6] = std::array::from_fn(width);
    let mut text = String::new();
    for line in &lines {
        let cells: Vec<String> =
            line.iter().zip(widths).map(|(cell, width)| format!("{cell:width$}")).collect();
        let _ = writeln!(text, "{}", cells.join("  ").trim_end());
    }
    let _ = writeln!(
        text,
        "{} done, {} skipped, {} failed in {seconds:.1} s",
        count(rows, Status::Done),
        count(rows, Status::Skipped),
        count(rows, Status::Failed)
    );
    text
}

/// `summary.json`: the counts, how long it took, and all rows.
pub fn json(rows: &[Row], seconds: f64) -> Value {
    json!({
        "done": count(rows, Status::Done),
        "skipped": count(rows, Status::Skipped),
        "failed": count(rows, Status::Failed),
        "seconds": seconds,
        "files": rows,
    })
}
