//! The command line of a batch: `superdeform batch INPUTS... --style STYLE -o FOLDER`.

use super::arguments::{Arguments, Single};
use super::{Command, Refusal, command, parsed};
use crate::batch::plan::with_ending;
use clap::Parser;
use std::ffi::OsString;
use std::path::{Path, PathBuf};

/// Turns many 3D characters into their super-deformed versions, several at a time.
#[derive(Clone, Debug, Parser)]
#[command(name = "superdeform batch", version, max_term_width = 100, after_help = SHORT, after_long_help = EXAMPLES)]
pub struct Batch {
    /// The characters: files, folders (.vrm, .glb and .gltf in them, to the bottom), or patterns such as 'in/*.vrm'
    #[arg(required = true)]
    pub inputs: Vec<PathBuf>,

    /// Where the proportions come from: a rigged GLB or VRM, a saved style (.json), or a built-in one (sd2, sd2.5, sd3, sd4)
    #[arg(long, value_name = "STYLE|MODEL", conflicts_with = "heads", required_unless_present = "heads")]
    pub style: Option<PathBuf>,

    /// The folder for the results, their reports and summary.json
    #[arg(short, long, value_name = "FOLDER")]
    pub output: PathBuf,

    /// Results keep the path that their inputs have below this folder [default: each folder of INPUTS]
    #[arg(long, value_name = "FOLDER")]
    pub root: Option<PathBuf>,

    /// How many are converted at a time [default: as many as there are cores]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    pub jobs: Option<u16>,

    /// Gigabytes of memory that all of them together may take [default: three quarters of what is free]
    #[arg(long, value_name = "GB", value_parser = gigabytes)]
    pub memory: Option<f64>,

    /// Convert again what is finished
    #[arg(long)]
    pub force: bool,

    /// Draw target, reference and result of each
    #[arg(long)]
    pub pictures: bool,

    /// Write no summary.json, because other workers fill the same folder
    #[arg(long)]
    pub no_summary: bool,

    #[command(flatten)]
    pub settings: Arguments,
}

impl Batch {
    /// Reads the command line; the program's name first, `batch` second.
    ///
    /// # Errors
    /// [`Refusal`]: help or version, or wrong usage.
    pub fn parse_from_words(words: impl IntoIterator<Item = OsString>) -> Result<Self, Refusal> {
        let mut words = words.into_iter();
        let name = words.next().unwrap_or_default();
        let batch: Self = parsed(std::iter::once(name).chain(words.skip(1)).collect())?;
        // What each file would refuse is refused before the first.
        batch.command(Path::new("a.glb"), Path::new("a_sd.glb"), Path::new("a_sd.glb.json"))?;
        Ok(batch)
    }

    /// What converts the file at `target` alone.
    ///
    /// # Errors
    /// [`Refusal`]: as for one file; a result that would be written over an input, for instance.
    pub fn command(&self, target: &Path, output: &Path, report: &Path) -> Result<Command, Refusal> {
        command(Single {
            target: Some(target.to_path_buf()),
            reference: self.style.clone(),
            output: Some(output.to_path_buf()),
            picture: self.pictures.then(|| with_ending(output, ".png")),
            report: Some(report.to_path_buf()),
            save_style: None,
            save_rigged: None,
            joints: None,
            settings: self.settings.clone(),
        })
    }
}

fn gigabytes(text: &str) -> Result<f64, String> {
    match text.trim().parse::<f64>() {
        Ok(number) if number > 0.0 && number.is_finite() => Ok(number),
        _ => Err(format!("`{text}` is no amount of memory: give gigabytes above 0")),
    }
}

const SHORT: &str = "\
Example: superdeform batch avatars --style sd2.5 -o avatars_sd
All options, those of a single run too: superdeform batch --help.";

const EXAMPLES: &str = "\
Examples:
  superdeform batch avatars --style sd2.5 -o avatars_sd
  superdeform batch a.vrm more/*.vrm --heads 3 -o out --jobs 4 --pictures

Results are called NAME_sd.vrm or .glb, their reports NAME_sd.vrm.json. What is finished is skipped when the batch is
started again: same file, same style, same options. Exit codes: 0 all done, 1 some failed (listed), 2 wrong usage.";
