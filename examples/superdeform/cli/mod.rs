//! The command line: every option with its range and its help, read into one plain [`Command`].

mod arguments;
pub mod batch;
pub mod pages;
mod values;

use crate::input::{self, Model};
use crate::samples;
use arguments::{Arguments, Single};
use clap::error::ErrorKind;
use clap::{CommandFactory, Parser, ValueEnum};
use regex_lite::Regex;
use std::collections::BTreeMap;
use std::ffi::OsString;
use std::path::{Path, PathBuf};
use superdeform::internals::character::bones::Group as BoneGroup;
use superdeform::internals::shape::style::BUILT_IN;
use superdeform::{Axes, FaceHints, GroupSettings, MeshKind, Options, RigOptions};
use superdeform_host::conversion::RigChoice;
use values::Group;

/// The folder for results when no output path is given.
const OUTPUT_FOLDER: &str = "superdeform-out";

/// Where the proportions come from.
#[derive(Clone, Debug, PartialEq)]
pub enum Reference {
    /// A rigged GLB or VRM.
    Model(Model),
    /// A style saved with `--save-style`.
    Style(PathBuf),
    /// One of the styles that the library brings along.
    BuiltIn(String),
    /// No model: a style for this many heads.
    Heads(f64),
}

/// What to do, with every default filled in.
#[derive(Clone, Debug)]
pub struct Command {
    /// The character to change.
    pub target: Model,
    /// Where the proportions come from.
    pub reference: Reference,
    /// The changed character; its format is the target's.
    pub output: PathBuf,
    /// The picture of target, reference and result.
    pub picture: Option<PathBuf>,
    /// The numbers of the run.
    pub report: Option<PathBuf>,
    /// The reference's proportions, for use without the model.
    pub save_style: Option<PathBuf>,
    /// What the library is told.
    pub options: Options,
    /// A second saved style, and how much of it there is (0 to 1).
    pub blend: Option<(PathBuf, f64)>,
    /// Kinds of meshes by `node|mesh|material`; the first pattern that matches decides.
    pub kinds: Vec<(MeshKind, Regex)>,
    /// Role to node name for the target.
    pub humanoid: Option<PathBuf>,
    /// Role to node name for the reference.
    pub reference_humanoid: Option<PathBuf>,
    /// Which way the target stands and looks.
    pub axes: Axes,
    /// Where the target's eyes are, as far as it is said.
    pub face_hints: FaceHints,
    /// Keep the target's rig or make one.
    pub rig: RigChoice,
    /// What the auto-rig is told, but for known joints.
    pub rig_options: RigOptions,
    /// Where joints of the target are known: role to position, in the file's units.
    pub joints: Option<PathBuf>,
    /// The target with its new rig, not deformed.
    pub save_rigged: Option<PathBuf>,
    /// Convert what its licence forbids to change.
    pub allow_prohibited: bool,
    /// How much of the shade around painted eyes is evened; `None` as the library thinks fit.
    pub even_eyes: Option<f64>,
    /// Give spring chains of VRM 0.x one joint more.
    pub leaf_joints: bool,
    /// Add colliders around the legs for a skirt that has none.
    pub leg_colliders: bool,
    /// Draw a VRM's thumbnail anew.
    pub thumbnail: bool,
    /// Print nothing but errors.
    pub quiet: bool,
    /// Print every note.
    pub verbose: bool,
}

/// Why there is no [`Command`].
#[derive(Debug)]
pub enum Refusal {
    /// Help or version was asked for: text for standard output, exit code 0.
    Answer(String),
    /// The arguments make no sense: text for standard error, exit code 2.
    Usage(String),
    /// A file that the arguments name is at fault, or a feature is not there: exit code 1.
    Input(String),
}

/// What to do with a target's rig.
#[allow(missing_docs)]
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Rig {
    Keep,
    Auto,
}

/// Reads the command line, the program's name first.
///
/// # Errors
/// [`Refusal`]: help or version, wrong usage, or a file of `--groups` that cannot be read.
pub fn parse(arguments: impl IntoIterator<Item = impl Into<OsString> + Clone>) -> Result<Command, Refusal> {
    command(parsed(arguments.into_iter().map(Into::into).collect())?)
}

/// Reads the words of a command; `--help` has all options, `-h` those that are used most.
fn parsed<T: Parser + CommandFactory>(mut words: Vec<OsString>) -> Result<T, Refusal> {
    if words.get(1).is_some_and(|word| word == "help") && words.len() == 2 {
        words[1] = "--help".into();
    }
    let all = words.iter().any(|word| word == "--help");
    let parsed = pages::command::<T>().try_get_matches_from(words);
    parsed.and_then(|matches| T::from_arg_matches(&matches)).map_err(|error| {
        if all && error.kind() == ErrorKind::DisplayHelp {
            Refusal::Answer(pages::help::<T>())
        } else {
            refusal(error)
        }
    })
}

fn refusal(error: clap::Error) -> Refusal {
    match error.kind() {
        ErrorKind::DisplayHelp | ErrorKind::DisplayVersion => Refusal::Answer(error.to_string()),
        // One sentence names the option, the value and the range; clap's hint below it adds nothing.
        ErrorKind::ValueValidation => {
            let text = error.to_string();
            let line = text.lines().next().unwrap_or_default();
            Refusal::Usage(line.trim_start_matches("error: ").to_string())
        }
        _ => Refusal::Usage(error.to_string().trim_start_matches("error: ").trim_end().to_string()),
    }
}

/// Fills in defaults and checks options against each other.
fn command(single: Single) -> Result<Command, Refusal> {
    let arguments = single.settings;
    let axes = Axes {
        up: arguments.up.unwrap_or(Axes::default().up),
        up_is_known: arguments.up.is_some(),
        forward: arguments.forward,
    };
    if axes.forward.is_some_and(|forward| axes.up.dot(forward) != 0.0) {
        return Err(Refusal::Usage(
            "--up (+Y where it is not given) and --forward lie on one line: give two different axes"
                .to_string(),
        ));
    }
    let options = options(&arguments)?;
    let unset = RigOptions::default();
    let rig_options = RigOptions {
        method: arguments.body_weights.unwrap_or(unset.method),
        garments: arguments.garment_weights.unwrap_or(unset.garments),
        heat: arguments.rig_heat.unwrap_or(unset.heat),
        voxel_resolution: arguments.rig_voxel_resolution.unwrap_or(unset.voxel_resolution),
        fingers: !arguments.no_rig_fingers,
        thread_count: options.thread_count,
        ..unset
    };
    if single.joints.is_some() && arguments.rig == Some(Rig::Keep) {
        return Err(Refusal::Usage(
            "--joints is about a new rig, and --rig keep keeps the old one: leave one of them out"
                .to_string(),
        ));
    }
    if let Some(path) = single.save_rigged.as_ref().filter(|path| !has_extension(path, "glb")) {
        return Err(Refusal::Usage(format!(
            "--save-rigged {}: the rigged target is written as GLB, so give a name that ends in .glb",
            path.display()
        )));
    }
    let target = single.target.map_or(Model::Sample(&samples::TARGET), Model::File);
    let reference = match (arguments.heads, single.reference) {
        (Some(heads), _) => Reference::Heads(heads),
        (None, Some(path)) if path.to_str().is_some_and(|name| BUILT_IN.contains(&name)) => {
            Reference::BuiltIn(path.to_string_lossy().into_owned())
        }
        (None, Some(path)) if has_extension(&path, "json") => Reference::Style(path),
        (None, Some(path)) if is_misspelt(&path) => {
            return Err(Refusal::Usage(format!(
                "{} is neither a file nor a built-in style: give a GLB, a VRM, a saved style (.json) or one of {}",
                path.display(),
                BUILT_IN.join(", ")
            )));
        }
        (None, Some(path)) => Reference::Model(Model::File(path)),
        (None, None) => Reference::Model(Model::Sample(&samples::REFERENCE)),
    };
    if single.save_style.is_some() && !matches!(reference, Reference::Model(_)) {
        return Err(Refusal::Usage(
            "--save-style saves what is measured on a model: give a GLB or VRM as REFERENCE".to_string(),
        ));
    }
    if arguments.blend.is_some() && matches!(reference, Reference::Heads(_)) {
        return Err(Refusal::Usage(
            "--blend mixes two styles, and --heads has no second one: give a REFERENCE instead".to_string(),
        ));
    }
    let mut picture = single.picture;
    let mut report = single.report;
    let output = single.output.unwrap_or_else(|| {
        let base = default_output(&target);
        picture.get_or_insert(base.with_extension("png"));
        report.get_or_insert(base.with_extension("json"));
        base
    });
    let mut kinds = Vec::new();
    for (kind, patterns) in [
        (MeshKind::Body, arguments.body),
        (MeshKind::Garment, arguments.garment),
        (MeshKind::Hair, arguments.hair),
        (MeshKind::FacePart, arguments.face_part),
        (MeshKind::Eye, arguments.eye),
        (MeshKind::Accessory, arguments.accessory),
    ] {
        kinds.extend(patterns.into_iter().map(|pattern| (kind, pattern)));
    }
    let command = Command {
        target,
        reference,
        output,
        picture,
        report,
        save_style: single.save_style,
        options,
        blend: arguments.blend,
        face_hints: arguments.eyes.unwrap_or_default(),
        kinds,
        humanoid: arguments.humanoid,
        reference_humanoid: arguments.reference_humanoid,
        axes,
        rig: match arguments.rig {
            None => RigChoice::Found,
            Some(Rig::Keep) => RigChoice::Keep,
            Some(Rig::Auto) => RigChoice::New,
        },
        rig_options,
        joints: single.joints,
        save_rigged: single.save_rigged,
        allow_prohibited: arguments.allow_prohibited,
        even_eyes: arguments.even_eyes,
        leaf_joints: arguments.leaf_joints,
        leg_colliders: arguments.leg_colliders,
        thumbnail: arguments.thumbnail,
        quiet: arguments.quiet,
        verbose: arguments.verbose,
    };
    check_paths(&command)?;
    Ok(command)
}

/// The library's options; names of bone groups are checked here, because the library takes any.
fn options(arguments: &Arguments) -> Result<Options, Refusal> {
    let bone_groups = match &arguments.groups {
        Some(path) => input::bone_groups(path).map_err(Refusal::Input)?,
        None => BTreeMap::new(),
    };
    let mut groups: BTreeMap<String, GroupSettings> = BTreeMap::new();
    for Group { name, settings } in &arguments.group {
        if BoneGroup::from_name(name).is_none() && !bone_groups.values().any(|group| group == name) {
            return Err(Refusal::Usage(format!(
                "--group {name}: there is no such bone group: use one of {}, or a name from --groups",
                BoneGroup::ALL.map(BoneGroup::name).join(", ")
            )));
        }
        let entry = groups.entry(name.clone()).or_default();
        entry.length_scale = settings.length_scale.or(entry.length_scale);
        entry.thickness_scale = settings.thickness_scale.or(entry.thickness_scale);
        entry.length_transfer = settings.length_transfer.or(entry.length_transfer);
        entry.thickness_transfer = settings.thickness_transfer.or(entry.thickness_transfer);
    }
    Ok(Options { groups, bone_groups, ..arguments.options() })
}

/// Refuses to write over an input, or two results into one file.
fn check_paths(command: &Command) -> Result<(), Refusal> {
    let mut inputs: Vec<&PathBuf> = command.target.path().into_iter().collect();
    match &command.reference {
        Reference::Model(model) => inputs.extend(model.path()),
        Reference::Style(path) => inputs.push(path),
        Reference::BuiltIn(_) | Reference::Heads(_) => {}
    }
    inputs.extend(command.blend.as_ref().map(|(path, _)| path));
    inputs.extend(&command.humanoid);
    inputs.extend(&command.reference_humanoid);
    inputs.extend(&command.joints);
    let mut outputs = vec![&command.output];
    outputs.extend(&command.picture);
    outputs.extend(&command.report);
    outputs.extend(&command.save_style);
    outputs.extend(&command.save_rigged);
    for (index, output) in outputs.iter().enumerate() {
        if inputs.iter().any(|input| same_file(input, output)) {
            return Err(Refusal::Usage(format!(
                "{} would be written over: give another path for the result",
                output.display()
            )));
        }
        if outputs[..index].iter().any(|other| same_file(other, output)) {
            return Err(Refusal::Usage(format!(
                "{} is named for two results: give each its own path",
                output.display()
            )));
        }
    }
    Ok(())
}

/// True where both paths lead to one file, whether by spelling or by links.
pub fn same_file(first: &Path, second: &Path) -> bool {
    first == second
        || match (first.canonicalize(), second.canonicalize()) {
            (Ok(first), Ok(second)) => first == second,
            _ => false,
        }
}

/// True for a name that is no file's, and does not look like a model's.
fn is_misspelt(path: &Path) -> bool {
    !path.exists() && !["glb", "vrm", "gltf"].iter().any(|ending| has_extension(path, ending))
}

fn default_output(target: &Model) -> PathBuf {
    let target = match target {
        Model::File(path) => path,
        Model::Sample(sample) => Path::new(sample.name),
    };
    let mut name = target.file_stem().unwrap_or_default().to_os_string();
    name.push(if has_extension(target, "vrm") { "_sd.vrm" } else { "_sd.glb" });
    Path::new(OUTPUT_FOLDER).join(name)
}

fn has_extension(path: &Path, wanted: &str) -> bool {
    path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case(wanted))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::words;
    use clap::CommandFactory;
    use glam::Vec3;
    use superdeform::options::TABLE;
    use superdeform::{FaceCurve, GarmentWeights, Repair, Stage, WeightMethod};

    fn parsed(arguments: &[&str]) -> Command {
        parse(std::iter::once(&"superdeform").chain(arguments)).expect("a command")
    }

    fn refused(arguments: &[&str]) -> (u8, String) {
        match parse(std::iter::once(&"superdeform").chain(arguments)) {
            Ok(_) => panic!("{arguments:?} was taken"),
            Err(Refusal::Answer(text)) => (0, text),
            Err(Refusal::Input(text)) => (1, text),
            Err(Refusal::Usage(text)) => (2, text),
        }
    }

    #[test]
    fn no_arguments_mean_the_sample_pair_and_three_results() {
        let command = parsed(&[]);
        assert_eq!(command.target, Model::Sample(&samples::TARGET));
        assert_eq!(command.reference, Reference::Model(Model::Sample(&samples::REFERENCE)));
        assert_eq!(command.output, Path::new("superdeform-out/quaternius_female_dress_unrigged_sd.glb"));
        assert_eq!(
            command.picture.unwrap(),
            Path::new("superdeform-out/quaternius_female_dress_unrigged_sd.png")
        );
        assert_eq!(
            command.report.unwrap(),
            Path::new("superdeform-out/quaternius_female_dress_unrigged_sd.json")
        );
        assert_eq!(command.options, Options::default());
    }

    #[test]
    fn a_vrm_stays_a_vrm_and_a_given_output_brings_no_picture() {
        assert_eq!(parsed(&["a.VRM"]).output, Path::new("superdeform-out/a_sd.vrm"));
        let command = parsed(&["a.glb", "b.json", "-o", "c.glb"]);
        assert_eq!(command.reference, Reference::Style("b.json".into()));
        assert!(command.picture.is_none() && command.report.is_none());
    }

    #[test]
    fn settings_of_a_group_add_up() {
        let command = parsed(&[
            "--group",
            "upper_leg:length=0.4,thickness=0.8",
            "--group",
            "upper_leg:length_transfer=0.5",
        ]);
        let settings = command.options.groups["upper_leg"];
        assert_eq!(settings.length_scale, Some(0.4));
        assert_eq!(settings.thickness_scale, Some(0.8));
        assert_eq!(settings.length_transfer, Some(0.5));
        assert_eq!(settings.thickness_transfer, None);
    }

    #[test]
    fn axes_are_read_in_every_spelling() {
        let command = parsed(&["--up", "z", "--forward", "-Y"]);
        assert_eq!(command.axes.up, Vec3::Z);
        assert_eq!(command.axes.forward, Some(-Vec3::Y));
        assert_eq!(parsed(&["--forward=+x"]).axes.forward, Some(Vec3::X));
    }

    #[test]
    fn wrong_usage_names_the_value_and_the_range_in_one_line() {
        for (arguments, words) in [
            (&["--heads", "7"][..], &["7", "1.8", "6"][..]),
            (&["--heads", "NaN"], &["NaN", "1.8"]),
            (&["--amount", "1.5"], &["1.5", "0 to 1"]),
            (&["--face-squash", "-11"], &["-11", "-10 to 10"]),
            (&["--rig-voxel-resolution", "8"], &["8", "16 to 512"]),
            (&["--rays", "2"], &["2", "3"]),
            (&["--group", "upper_leg:length=0"], &["length", "0.01"]),
            (&["--group", "upper_leg:length_transfer=2"], &["length_transfer", "0 to 1"]),
            (&["--group", "tail:length=1"], &["tail", "upper_leg"]),
            (&["--group", "foot:girth=1"], &["girth", "thickness"]),
            (&["--blend", "x.json:2"], &["2", "0 to 1"]),
            (&["--body", "("], &["open group"]),
            (&["--up", "w"], &["+X"]),
            (&["--forward", "-Y"], &["--up", "--forward"]),
            (&["a.glb", "b.glb", "-o", "a.glb"], &["a.glb"]),
            (&["a.glb", "-o", "c.glb", "--report", "r", "--picture", "r"], &["two results"]),
            (&["a.glb", "-o", "c.glb", "--save-rigged", "c.glb"], &["two results"]),
            (&["a.glb", "-o", "c.glb", "--joints", "j", "--report", "j"], &["written over"]),
        ] {
            let (code, text) = refused(arguments);
            assert_eq!(code, 2, "{arguments:?}: {text}");
            assert_eq!(text.lines().count(), 1, "{text}");
            for word in words {
                assert!(text.contains(word), "{arguments:?}: {text}");
            }
        }
        for style in ["sd7", "sd2.7", "chibi"] {
            let (code, text) = refused(&["a.glb", style]);
            assert!(code == 2 && text.contains(style) && text.contains("sd2, sd2.5, sd3, sd4"), "{text}");
        }
        assert_eq!(refused(&["a.glb", "b.glb", "--heads", "2"]).0, 2);
        assert_eq!(refused(&["--unknown"]).0, 2);
    }

    #[test]
    fn a_new_rig_is_told_what_to_do() {
        let command = parsed(&[
            "--rig",
            "auto",
            "--body-weights",
            "volume",
            "--garment-weights",
            "nearest",
            "--threads",
            "2",
            "--save-rigged",
            "x.glb",
            "--joints",
            "joints.json",
        ]);
        assert_eq!(command.rig, RigChoice::New);
        assert_eq!(command.rig_options.method, WeightMethod::Volume);
        assert_eq!(command.rig_options.garments, GarmentWeights::Nearest);
        assert_eq!(command.rig_options.thread_count, 2);
        assert_eq!(command.save_rigged.unwrap(), Path::new("x.glb"));
        assert_eq!(command.joints.unwrap(), Path::new("joints.json"));
        let plain = parsed(&[]);
        assert_eq!((plain.rig, plain.rig_options), (RigChoice::Found, RigOptions::default()));
        assert_eq!(refused(&["--rig", "keep", "--joints", "joints.json"]).0, 2);
        assert!(refused(&["--save-rigged", "x.vrm"]).1.contains("x.vrm"));
        assert_eq!(refused(&["--body-weights", "wool"]).0, 2);
    }

    #[test]
    fn what_the_library_can_be_told_can_be_given() {
        let command = parsed(&[
            "--face-squash=-0.5",
            "--face-curve",
            "sphere",
            "--stage",
            "length",
            "--rays",
            "24",
            "--no-limits",
            "--repair",
            "0",
            "--rig-voxel-resolution",
            "64",
            "--rig-heat",
            "2",
            "--no-rig-fingers",
        ]);
        let options = command.options;
        assert_eq!((options.face_squash, options.face_curve), (Some(-0.5), FaceCurve::Sphere));
        assert_eq!((options.stage, options.rays, options.limits), (Stage::Length, Some(24), false));
        assert_eq!(options.repair, Repair::Off);
        let rig = command.rig_options;
        assert_eq!((rig.voxel_resolution, rig.heat, rig.fingers), (64, 2.0, false));
    }

    #[test]
    fn how_much_paint_is_evened_is_a_share() {
        assert_eq!(parsed(&[]).even_eyes, None);
        assert_eq!(parsed(&["--even-eyes", "0.5"]).even_eyes, Some(0.5));
        for wrong in ["2", "-0.1", "much", "NaN"] {
            let (code, text) = refused(&[&format!("--even-eyes={wrong}")]);
            assert!(code == 2 && text.contains(wrong) && text.contains("0 to 1"), "{text}");
        }
    }

    #[test]
    fn every_option_of_the_library_has_its_flag() {
        let arguments = Single::command();
        // glTF's axes are right-handed.
        for info in TABLE.iter().filter(|info| info.name != "rig_left_handed") {
            for flag in words::flag(info.name).split(", ") {
                let name = flag.trim_start_matches("--").split(' ').next();
                assert!(arguments.get_arguments().any(|argument| argument.get_long() == name), "{flag}");
            }
        }
    }

    #[test]
    fn help_gives_ranges_defaults_and_choices() {
        let text = refused(&["--help"]).1.split_whitespace().collect::<Vec<_>>().join(" ");
        for words in [
            "where height is set, that counts [0.1 to 10; default: 1.5]",
            "[default: f4] [possible values: f4, f2, sphere]",
            "[1.8 to 6]",
        ] {
            assert!(text.contains(words), "{words}: {text}");
        }
    }

    #[test]
    fn short_help_has_a_dozen_options_on_a_screen_and_help_has_all() {
        let screen = |text: &str| text.lines().map(|line| line.chars().count().div_ceil(100).max(1)).sum();
        let flags = |text: &str| text.lines().filter(|line| line.trim_start().starts_with('-')).count();
        let (short, long) = (refused(&["-h"]).1, refused(&["--help"]).1);
        // A dozen, help and version.
        assert_eq!(flags(&short), 14, "{short}");
        let rows: usize = screen(&short);
        assert!(rows <= 36, "{rows} rows: {short}");
        let all = Single::command().get_arguments().filter(|argument| argument.get_long().is_some()).count();
        assert_eq!(flags(&long), all + 2, "{long}");
        assert_eq!(refused(&["help"]), (0, long));
    }

    #[test]
    fn help_is_an_answer() {
        let (code, text) = refused(&["--help"]);
        assert_eq!(code, 0);
        for group in BoneGroup::ALL {
            assert!(text.contains(group.name()));
        }
    }
}
