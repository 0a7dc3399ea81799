//! Many characters, one style: several runs at a time, a report each, a summary of all.
//!
//! What is finished is known by its report, which is written last and holds a hash of the input, the style and the
//! options: a batch that was ended in the middle goes on where it was, whatever ended it.

mod memory;
pub mod plan;
mod summary;

use crate::cli::Refusal;
use crate::cli::batch::Batch;
use crate::faults::without_panic;
use crate::{output, progress, run};
use memory::Memory;
use plan::Item;
use serde_json::Value;
use sha2::{Digest, Sha256};
use std::num::NonZero;
use std::path::Path;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};
use std::thread;
use std::time::Instant;
use summary::{Row, Status};

/// Stack of a worker, as that of the main thread: JSON nests.
const STACK: usize = 8 << 20;

/// What a batch came to.
pub struct Outcome {
    /// The table, for a person.
    pub table: String,
    /// What was found and not converted, a sentence each.
    pub left_out: Vec<String>,
    /// One line for each file that failed.
    pub failures: Vec<String>,
    /// How many files there were.
    pub count: usize,
}

/// Converts all that `batch` names; a file that fails is told and does not stop the others.
///
/// # Errors
/// One sentence where nothing can be begun: no inputs, a style that cannot be read, a folder that cannot be written.
pub fn run(batch: &Batch) -> Result<Outcome, String> {
    let start = Instant::now();
    let plan = plan::plan(&batch.inputs, batch.root.as_deref(), &batch.output)?;
    let items = plan.items;
    let first = command(batch, &items[0])?;
    let source = run::Source::of(&first)?;
    let settings = settings_hash(batch)?;
    let cores = thread::available_parallelism().map_or(1, NonZero::get);
    let jobs = batch.jobs.map_or(cores, usize::from).min(items.len());
    let threads = (cores / jobs).max(1);
    let memory = Memory::of(batch.memory.map(|gigabytes| (gigabytes * 1e9) as u64));
    let bar = progress::Bar::new(items.len() as u64, batch.settings.quiet);
    // Large ones first, so that none is left over for the end.
    let size = |item: &Item| std::fs::metadata(&item.input).map_or(0, |about| about.len());
    let mut order: Vec<usize> = (0..items.len()).collect();
    order.sort_by_key(|&index| std::cmp::Reverse(size(&items[index])));
    let next = AtomicUsize::new(0);
    let rows: Vec<Mutex<Option<Row>>> = items.iter().map(|_| Mutex::new(None)).collect();
    let work = || {
        while let Some(&index) = order.get(next.fetch_add(1, Ordering::Relaxed)) {
            let item = &items[index];
            let part = memory.take(size(item));
            let row = convert(batch, item, &source, &settings, threads);
            drop(part);
            bar.line(&row.line());
            *rows[index].lock().unwrap_or_else(PoisonError::into_inner) = Some(row);
        }
    };
    thread::scope(|scope| {
        for _ in 1..jobs {
            // Where the system starts no more threads, those that run do the work.
            let _ = thread::Builder::new().stack_size(STACK).spawn_scoped(scope, work);
        }
        work();
    });
    drop(bar);
    let rows: Vec<Row> =
        rows.into_iter().filter_map(|row| row.into_inner().unwrap_or_else(PoisonError::into_inner)).collect();
    let seconds = start.elapsed().as_secs_f64();
    if !batch.no_summary {
        let mut text = format!("{:#}", summary::json(&rows, seconds));
        text.push('\n');
        output::write(&batch.output.join("summary.json"), text.as_bytes())?;
    }
    let failed = rows.iter().filter(|row| row.status == Status::Failed);
    Ok(Outcome {
        left_out: plan.left_out,
        table: summary::table(&rows, seconds),
        failures: failed.map(Row::line).collect(),
        count: rows.len(),
    })
}

fn command(batch: &Batch, item: &Item) -> Result<crate::cli::Command, String> {
    batch.command(&item.input, &item.output, &item.report).map_err(|refusal| match refusal {
        Refusal::Answer(text) | Refusal::Usage(text) | Refusal::Input(text) => text,
    })
}

/// One file, converted where it is not finished.
fn convert(batch: &Batch, item: &Item, source: &run::Source, settings: &str, threads: usize) -> Row {
    let start = Instant::now();
    let mut row = Row {
        input: item.input.clone(),
        output: item.output.clone(),
        report: item.report.clone(),
        status: Status::Failed,
        heads: None,
        warnings: Vec::new(),
        licence: Value::Null,
        seconds: 0.0,
        error: None,
    };
    let done = without_panic(|| {
        let key = key(&item.input, settings)?;
        if !batch.force
            && let Some(report) = finished(batch, item, &key)
        {
            row.read(&report);
            return Ok(Status::Skipped);
        }
        let mut command = command(batch, item)?;
        command.quiet = true;
        if batch.settings.threads.is_none() {
            command.options.thread_count = threads;
            command.rig_options.thread_count = threads;
        }
        remove_left_overs(item);
        run::run_with(&command, source, &key)?;
        let text = std::fs::read(&item.report).map_err(|error| error.to_string())?;
        row.read(&serde_json::from_slice(&text).map_err(|error| error.to_string())?);
        Ok(Status::Done)
    });
    match done {
        Ok(status) => row.status = status,
        Err(error) => {
            row.error = Some(error);
            row.seconds = start.elapsed().as_secs_f64();
        }
    }
    row
}

/// What all runs of a batch have in common, as a hash: version, style, options, and the files that they name.
fn settings_hash(batch: &Batch) -> Result<String, String> {
    let mut settings = batch.settings.clone();
    // Neither changes a result.
    (settings.threads, settings.quiet, settings.allow_prohibited) = (None, false, false);
    let mut hash = Sha256::new();
    hash.update(format!("{}\n{settings:?}\n{:?}\n", env!("CARGO_PKG_VERSION"), batch.style));
    let blended = settings.blend.as_ref().map(|(path, _)| path);
    let named = [&settings.groups, &settings.humanoid, &settings.reference_humanoid];
    let named = named.into_iter().flatten().chain(blended);
    for path in named.chain(batch.style.iter().filter(|path| path.is_file())) {
        hash.update(Sha256::digest(read(path)?));
    }
    Ok(hex(&hash.finalize()))
}

/// What a finished result must have been made from.
fn key(input: &Path, settings: &str) -> Result<String, String> {
    let mut hash = Sha256::new();
    hash.update(settings);
    hash.update(Sha256::digest(read(input)?));
    Ok(hex(&hash.finalize()))
}

fn read(path: &Path) -> Result<Vec<u8>, String> {
    std::fs::read(path).map_err(|error| format!("{}: cannot be read ({error})", path.display()))
}

fn hex(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02x}")).collect()
}

/// The report of a run that was made from the same file, style and options, and whose results are there.
fn finished(batch: &Batch, item: &Item, key: &str) -> Option<Value> {
    let report: Value = serde_json::from_slice(&std::fs::read(&item.report).ok()?).ok()?;
    let result = std::fs::metadata(&item.output).ok()?;
    let made = &report["batch"];
    let whole = made["key"] == key && made["bytes"] == result.len();
    let drawn = !batch.pictures || plan::with_ending(&item.output, ".png").is_file();
    (whole && drawn).then_some(report)
}

/// Removes what a worker that was killed left beside its result: `.NAME.PID.part`.
fn remove_left_overs(item: &Item) {
    for path in [&item.output, &item.report] {
        let (Some(folder), Some(name)) = (path.parent(), path.file_name()) else { continue };
        let start = format!(".{}.", name.to_string_lossy());
        for entry in std::fs::read_dir(folder).into_iter().flatten().flatten() {
            let other = entry.file_name();
            let other = other.to_string_lossy();
            let pid = other.strip_prefix(&start).and_then(|rest| rest.strip_suffix(".part"));
            if pid.is_some_and(|pid| pid.bytes().all(|digit| digit.is_ascii_digit())) {
                // One that cannot be removed does no harm.
                let _ = std::fs::remove_file(entry.path());
            }
        }
    }
}

#[cfg(test)]
mod tests;
