//! The command line: every option with its range and its help, read into one plain [`Command`].

use clap::builder::ValueParser;
use clap::error::ErrorKind;
use clap::{Parser, ValueEnum};
use glam::Vec3;
use regex::Regex;
use std::collections::BTreeMap;
use std::ffi::OsString;
use std::path::{Path, PathBuf};
use superdeform::internals::character::bones::Group as BoneGroup;
use superdeform::internals::shape::style::BUILT_IN;
use superdeform::options::HEADS;
use superdeform::{
    Axes, FaceCurve, GarmentWeights, GroupSettings, MeshKind, Mode, Options, RigOptions, Role, Stage,
    WeightMethod,
};

/// The folder for results when no output path is given.
const OUTPUT_FOLDER: &str = "superdeform-out";

/// Where the proportions come from.
#[derive(Clone, Debug, PartialEq)]
pub enum Reference {
    /// A rigged GLB or VRM.
    Model(PathBuf),
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
    pub target: PathBuf,
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
    /// Keep the target's rig or make one; `None` keeps one that can be used.
    pub rig: Option<Rig>,
    /// What the auto-rig is told, but for known joints.
    pub rig_options: RigOptions,
    /// Where joints of the target are known: role to position, in the file's units.
    pub joints: Option<PathBuf>,
    /// The target with its new rig, not deformed.
    pub save_rigged: Option<PathBuf>,
    /// Print nothing but errors.
    pub quiet: bool,
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

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Curve {
    F4,
    F2,
    Sphere,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum LastStage {
    Length,
    Thickness,
    Face,
    All,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum GarmentWay {
    Robust,
    Nearest,
    Heat,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum BodyWay {
    Auto,
    Heat,
    Volume,
}

#[derive(Clone, Debug)]
struct Group {
    name: String,
    settings: GroupSettings,
}

/// Turns a 3D character into its super-deformed (SD, chibi) version.
#[derive(Debug, Parser)]
#[command(name = "superdeform", version, max_term_width = 100, after_help = EXAMPLES)]
struct Arguments {
    /// The character to change: GLB, or VRM 0.x or 1.0 [default: a sample]
    target: Option<PathBuf>,

    /// Where the proportions come from: a rigged GLB or VRM, a saved style (.json), or a built-in one (sd2, sd2.5, sd3, sd4) [default: a sample]
    #[arg(conflicts_with = "heads")]
    reference: Option<PathBuf>,

    /// Where the result goes, in the target's format [default: superdeform-out/NAME_sd.glb or .vrm, with
    /// picture and report beside it]
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,

    /// Draw target, reference and result, front and side
    #[arg(long, value_name = "FILE.png")]
    picture: Option<PathBuf>,

    /// Write the numbers of the run
    #[arg(long, value_name = "FILE.json")]
    report: Option<PathBuf>,

    /// Save the reference's proportions; the file can stand for REFERENCE later
    #[arg(long, value_name = "FILE.json")]
    save_style: Option<PathBuf>,

    /// A style for this many heads (1.8 to 6) instead of REFERENCE
    #[arg(long, value_name = "N", value_parser = number(HEADS.0, HEADS.1), help_heading = STYLE)]
    heads: Option<f64>,

    /// From the original (0) to the style (1)
    #[arg(long, value_name = "0..1", default_value = "1", value_parser = number(0.0, 1.0), help_heading = STYLE)]
    amount: f64,

    /// Mix in a second saved style, 0 to 1 of it
    #[arg(long, value_name = "STYLE.json:0.5", value_parser = ValueParser::new(blend), help_heading = STYLE)]
    blend: Option<(PathBuf, f64)>,

    /// Size of the head (alpha_head)
    #[arg(long, value_name = "X", default_value = "1.5", value_parser = number(0.1, 10.0), help_heading = STYLE)]
    head_scale: f64,

    /// How much younger the face gets; 0 leaves it (gamma) [default: 0.8, with --paper 0]
    #[arg(long, value_name = "X", value_parser = number(0.0, 10.0), help_heading = STYLE)]
    face_squash: Option<f64>,

    /// The curve for --face-squash
    #[arg(long, value_name = "CURVE", value_enum, default_value = "f4", help_heading = STYLE)]
    face_curve: Curve,

    /// Length of hair below the chin: 1 keeps where it ends on the body, 0 ends it at the chin
    #[arg(long, value_name = "0..1", default_value = "1", value_parser = number(0.0, 1.0), help_heading = STYLE)]
    hair_length: f64,

    /// Set a bone group, e.g. upper_leg:length=0.4,thickness=0.8: scales (length, thickness), or how much of
    /// the reference is taken, 0 to 1 (length_transfer, thickness_transfer); repeatable
    #[arg(long, value_name = "NAME:KEY=X,...", value_parser = ValueParser::new(group), help_heading = STYLE)]
    group: Vec<Group>,

    /// Your own bone groups: a JSON object, bone to group name; a bone is named by the role at its end
    #[arg(long, value_name = "FILE.json", help_heading = STYLE)]
    groups: Option<PathBuf>,

    /// The paper's equations and constants to the letter
    #[arg(long, help_heading = METHOD)]
    paper: bool,

    /// Take coefficients as measured, however small or large
    #[arg(long, help_heading = METHOD)]
    no_limits: bool,

    /// Rays around each sample of a bone, at least 3 [default: 48, with --paper 12]
    #[arg(long, value_name = "N", value_parser = count(3, 4096), help_heading = METHOD)]
    rays: Option<usize>,

    /// Stop after a stage
    #[arg(long, value_name = "STAGE", value_enum, default_value = "all", help_heading = METHOD)]
    stage: LastStage,

    /// Keep the target's rig, or make one [default: keep, where there is one with the roles that it takes]
    #[arg(long, value_name = "RIG", value_enum, help_heading = METHOD)]
    rig: Option<Rig>,

    /// Write the target with its rig, not deformed
    #[arg(long, value_name = "FILE.glb", help_heading = METHOD)]
    save_rigged: Option<PathBuf>,

    /// How the body gets weights with a new rig: along its surface, through its volume, or whichever suits it
    #[arg(long, value_name = "WAY", value_enum, default_value = "auto", help_heading = METHOD)]
    body_weights: BodyWay,

    /// How clothes get weights with a new rig: from close surface points alike, from the nearest, or like a body
    #[arg(long, value_name = "WAY", value_enum, default_value = "robust", help_heading = METHOD)]
    garment_weights: GarmentWay,

    /// Joints that a new rig is to have: a JSON object, role to [x, y, z] as in a report's target.joints
    #[arg(long, value_name = "FILE.json", help_heading = METHOD)]
    joints: Option<PathBuf>,

    /// Threads; 0 for all cores
    #[arg(long, value_name = "N", default_value = "0", value_parser = count(0, 1024), help_heading = METHOD)]
    threads: usize,

    /// Roles of the target's joints where they are not found: a JSON object, role to node name
    #[arg(long, value_name = "MAP.json", help_heading = READING)]
    humanoid: Option<PathBuf>,

    /// The same for the reference
    #[arg(long, value_name = "MAP.json", help_heading = READING)]
    reference_humanoid: Option<PathBuf>,

    /// Meshes that are skin; matched, like the four below, against node|mesh|material
    #[arg(long, value_name = "REGEX", value_parser = ValueParser::new(pattern), help_heading = READING)]
    body: Vec<Regex>,

    /// Meshes that are clothes
    #[arg(long, value_name = "REGEX", value_parser = ValueParser::new(pattern), help_heading = READING)]
    garment: Vec<Regex>,

    /// Meshes that are hair
    #[arg(long, value_name = "REGEX", value_parser = ValueParser::new(pattern), help_heading = READING)]
    hair: Vec<Regex>,

    /// Meshes that follow the face: eyes, brows, lashes, teeth
    #[arg(long, value_name = "REGEX", value_parser = ValueParser::new(pattern), help_heading = READING)]
    face_part: Vec<Regex>,

    /// Meshes that keep their shape: hats, glasses, bags
    #[arg(long, value_name = "REGEX", value_parser = ValueParser::new(pattern), help_heading = READING)]
    accessory: Vec<Regex>,

    /// The target's up axis [default: +Y]
    #[arg(long, value_name = "AXIS", allow_hyphen_values = true, value_parser = ValueParser::new(axis), help_heading = READING)]
    up: Option<Vec3>,

    /// The way the target looks [default: found from its joints]
    #[arg(long, value_name = "AXIS", allow_hyphen_values = true, value_parser = ValueParser::new(axis), help_heading = READING)]
    forward: Option<Vec3>,

    /// Print nothing but errors
    #[arg(short, long)]
    quiet: bool,
}

const STYLE: &str = "Style";
const METHOD: &str = "Method";
const READING: &str = "Reading the files";

const EXAMPLES: &str = "\
Examples:
  superdeform                                           the sample pair
  superdeform hero.vrm chibi.glb -o hero_sd.vrm
  superdeform hero.vrm --heads 2.5 -o hero_sd.vrm --picture hero.png
  superdeform hero.vrm chibi.glb --group upper_leg:length=0.4 --amount 0.8

Bone groups: head neck torso shoulder upper_arm lower_arm hand finger hip upper_leg lower_leg foot.
Exit codes: 0 done, 1 bad input (one sentence on standard error), 2 wrong usage.";

/// Reads the command line, the program's name first.
///
/// # Errors
/// [`Refusal`]: help or version, wrong usage, or a file of `--groups` that cannot be read.
pub fn parse(arguments: impl IntoIterator<Item = impl Into<OsString> + Clone>) -> Result<Command, Refusal> {
    match Arguments::try_parse_from(arguments) {
        Ok(arguments) => command(arguments),
        Err(error) => Err(match error.kind() {
            ErrorKind::DisplayHelp | ErrorKind::DisplayVersion => Refusal::Answer(error.to_string()),
            // One sentence names the option, the value and the range; clap's hint below it adds nothing.
            ErrorKind::ValueValidation => {
                let text = error.to_string();
                let line = text.lines().next().unwrap_or_default();
                Refusal::Usage(line.trim_start_matches("error: ").to_string())
            }
            _ => Refusal::Usage(error.to_string().trim_start_matches("error: ").trim_end().to_string()),
        }),
    }
}

/// Fills in defaults and checks options against each other.
fn command(arguments: Arguments) -> Result<Command, Refusal> {
    let axes = Axes { up: arguments.up.unwrap_or(Axes::default().up), forward: arguments.forward };
    if axes.forward.is_some_and(|forward| axes.up.dot(forward) != 0.0) {
        return Err(Refusal::Usage(
            "--up (+Y where it is not given) and --forward lie on one line: give two different axes"
                .to_string(),
        ));
    }
    let options = options(&arguments)?;
    let rig_options = RigOptions {
        method: match arguments.body_weights {
            BodyWay::Auto => WeightMethod::Auto,
            BodyWay::Heat => WeightMethod::Heat,
            BodyWay::Volume => WeightMethod::Volume,
        },
        garments: match arguments.garment_weights {
            GarmentWay::Robust => GarmentWeights::Robust,
            GarmentWay::Nearest => GarmentWeights::Nearest,
            GarmentWay::Heat => GarmentWeights::Heat,
        },
        thread_count: options.thread_count,
        ..RigOptions::default()
    };
    if arguments.joints.is_some() && arguments.rig == Some(Rig::Keep) {
        return Err(Refusal::Usage(
            "--joints is about a new rig, and --rig keep keeps the old one: leave one of them out"
                .to_string(),
        ));
    }
    if let Some(path) = arguments.save_rigged.as_ref().filter(|path| !has_extension(path, "glb")) {
        return Err(Refusal::Usage(format!(
            "--save-rigged {}: the rigged target is written as GLB, so give a name that ends in .glb",
            path.display()
        )));
    }
    let target = arguments.target.unwrap_or_else(|| sample("quaternius_female_dress_unrigged.glb"));
    let reference = match (arguments.heads, arguments.reference) {
        (Some(heads), _) => Reference::Heads(heads),
        (None, Some(path)) if path.to_str().is_some_and(|name| BUILT_IN.contains(&name)) => {
            Reference::BuiltIn(path.to_string_lossy().into_owned())
        }
        (None, Some(path)) if has_extension(&path, "json") => Reference::Style(path),
        (None, Some(path)) => Reference::Model(path),
        (None, None) => Reference::Model(sample("kaykit_rogue.glb")),
    };
    if arguments.save_style.is_some() && !matches!(reference, Reference::Model(_)) {
        return Err(Refusal::Usage(
            "--save-style saves what is measured on a model: give a GLB or VRM as REFERENCE".to_string(),
        ));
    }
    if arguments.blend.is_some() && matches!(reference, Reference::Heads(_)) {
        return Err(Refusal::Usage(
            "--blend mixes two styles, and --heads has no second one: give a REFERENCE instead".to_string(),
        ));
    }
    let mut picture = arguments.picture;
    let mut report = arguments.report;
    let output = arguments.output.unwrap_or_else(|| {
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
        save_style: arguments.save_style,
        options,
        blend: arguments.blend,
        kinds,
        humanoid: arguments.humanoid,
        reference_humanoid: arguments.reference_humanoid,
        axes,
        rig: arguments.rig,
        rig_options,
        joints: arguments.joints,
        save_rigged: arguments.save_rigged,
        quiet: arguments.quiet,
    };
    check_paths(&command)?;
    Ok(command)
}

/// The library's options; names of bone groups are checked here, because the library takes any.
fn options(arguments: &Arguments) -> Result<Options, Refusal> {
    let bone_groups = match &arguments.groups {
        Some(path) => read_bone_groups(path).map_err(Refusal::Input)?,
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
    Ok(Options {
        mode: if arguments.paper { Mode::Paper } else { Mode::Product },
        rays: arguments.rays,
        head_scale: arguments.head_scale,
        face_squash: arguments.face_squash,
        face_curve: match arguments.face_curve {
            Curve::F4 => FaceCurve::F4,
            Curve::F2 => FaceCurve::F2,
            Curve::Sphere => FaceCurve::Sphere,
        },
        groups,
        bone_groups,
        amount: arguments.amount,
        limits: !arguments.no_limits && !arguments.paper,
        hair_length: arguments.hair_length,
        stage: match arguments.stage {
            LastStage::Length => Stage::Length,
            LastStage::Thickness => Stage::Thickness,
            LastStage::Face | LastStage::All => Stage::Face,
        },
        thread_count: arguments.threads,
    })
}

/// Refuses to write over an input, or two results into one file.
fn check_paths(command: &Command) -> Result<(), Refusal> {
    let mut inputs = vec![&command.target];
    if let Reference::Model(path) | Reference::Style(path) = &command.reference {
        inputs.push(path);
    }
    inputs.extend(command.blend.as_ref().map(|(path, _)| path));
    inputs.extend(&command.humanoid);
    inputs.extend(&command.reference_humanoid);
    let mut outputs = vec![&command.output];
    outputs.extend(&command.picture);
    outputs.extend(&command.report);
    outputs.extend(&command.save_style);
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
fn same_file(first: &Path, second: &Path) -> bool {
    first == second
        || match (first.canonicalize(), second.canonicalize()) {
            (Ok(first), Ok(second)) => first == second,
            _ => false,
        }
}

/// One of the files in `tests/data`.
fn sample(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data").join(name)
}

fn default_output(target: &Path) -> PathBuf {
    let mut name = target.file_stem().unwrap_or_default().to_os_string();
    name.push(if has_extension(target, "vrm") { "_sd.vrm" } else { "_sd.glb" });
    Path::new(OUTPUT_FOLDER).join(name)
}

fn has_extension(path: &Path, wanted: &str) -> bool {
    path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case(wanted))
}

/// A number from `low` to `high`, both included.
fn number(low: f64, high: f64) -> impl Fn(&str) -> Result<f64, String> + Clone {
    move |text| number_in(text, low, high)
}

fn number_in(text: &str, low: f64, high: f64) -> Result<f64, String> {
    match text.trim().parse::<f64>() {
        Ok(value) if value >= low && value <= high => Ok(value),
        Ok(value) => Err(format!("{value} is out of range: give a number from {low} to {high}")),
        Err(_) => Err(format!("`{text}` is not a number: give one from {low} to {high}")),
    }
}

/// A whole number from `low` to `high`, both included.
fn count(low: usize, high: usize) -> impl Fn(&str) -> Result<usize, String> + Clone {
    move |text| match text.trim().parse::<usize>() {
        Ok(value) if (low..=high).contains(&value) => Ok(value),
        _ => Err(format!("{text} is out of range: give a whole number from {low} to {high}")),
    }
}

/// An axis such as `+Y`, `-z` or `x`.
fn axis(text: &str) -> Result<Vec3, String> {
    let (sign, letter) = match text.strip_prefix('-') {
        Some(rest) => (-1.0, rest),
        None => (1.0, text.strip_prefix('+').unwrap_or(text)),
    };
    let axis = match letter {
        "x" | "X" => Vec3::X,
        "y" | "Y" => Vec3::Y,
        "z" | "Z" => Vec3::Z,
        _ => return Err("give one of +X, -X, +Y, -Y, +Z, -Z".to_string()),
    };
    Ok(sign * axis)
}

/// A regular expression; the sentence is the last line of a longer drawing.
fn pattern(text: &str) -> Result<Regex, String> {
    Regex::new(text).map_err(|error| {
        let text = error.to_string();
        let line = text.lines().last().unwrap_or_default();
        line.trim_start_matches("error: ").to_string()
    })
}

/// `STYLE.json:0.5`; the last colon counts, because a path may hold others.
fn blend(text: &str) -> Result<(PathBuf, f64), String> {
    match text.rsplit_once(':') {
        Some((path, share)) if !path.is_empty() => Ok((PathBuf::from(path), number_in(share, 0.0, 1.0)?)),
        _ => Err("give a saved style and its share, as in STYLE.json:0.5".to_string()),
    }
}

/// `upper_leg:length=0.4,thickness=0.8`.
fn group(text: &str) -> Result<Group, String> {
    let Some((name, settings_text)) = text.split_once(':') else {
        return Err("give a group and its settings, as in upper_leg:length=0.4,thickness=0.8".to_string());
    };
    let mut settings = GroupSettings::default();
    for setting in settings_text.split(',') {
        let Some((key, value)) = setting.split_once('=') else {
            return Err(format!("`{setting}` has no value: write it as length=0.4"));
        };
        let (place, high, low) = match key.trim() {
            "length" => (&mut settings.length_scale, 10.0, 0.01),
            "thickness" => (&mut settings.thickness_scale, 10.0, 0.01),
            "length_transfer" => (&mut settings.length_transfer, 1.0, 0.0),
            "thickness_transfer" => (&mut settings.thickness_transfer, 1.0, 0.0),
            other => {
                return Err(format!(
                    "`{other}` is no setting: use length, thickness, length_transfer or thickness_transfer"
                ));
            }
        };
        *place = Some(number_in(value, low, high).map_err(|why| format!("{}: {why}", key.trim()))?);
    }
    Ok(Group { name: name.trim().to_string(), settings })
}

/// Reads `--groups`: an object from bones, named by the role at their end, to group names.
fn read_bone_groups(path: &Path) -> Result<BTreeMap<Role, String>, String> {
    let place = path.display();
    let text = std::fs::read_to_string(path).map_err(|error| format!("{place}: cannot be read ({error})"))?;
    let named: BTreeMap<String, String> = serde_json::from_str(&text).map_err(|error| {
        format!("{place}: must be a JSON object such as {{\"leftUpperLeg\": \"legs\"}} ({error})")
    })?;
    let mut groups = BTreeMap::new();
    for (bone, group) in named {
        let role = Role::all()
            .find(|role| role.name().eq_ignore_ascii_case(&bone))
            .ok_or_else(|| format!("{place}: `{bone}` is no role: use VRM 1.0 names such as leftUpperLeg"))?;
        if group.trim().is_empty() {
            return Err(format!("{place}: `{bone}` has an empty group name: give it one"));
        }
        groups.insert(role, group);
    }
    Ok(groups)
}

#[cfg(test)]
mod tests {
    use super::*;

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
        assert!(command.target.exists());
        assert!(matches!(&command.reference, Reference::Model(path) if path.exists()));
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
            (&["--rays", "2"], &["2", "3"]),
            (&["--group", "upper_leg:length=0"], &["length", "0.01"]),
            (&["--group", "tail:length=1"], &["tail", "upper_leg"]),
            (&["--group", "foot:girth=1"], &["girth", "thickness"]),
            (&["--blend", "x.json:2"], &["2", "0 to 1"]),
            (&["--body", "("], &["unclosed group"]),
            (&["--up", "w"], &["+X"]),
            (&["--forward", "-Y"], &["--up", "--forward"]),
            (&["a.glb", "b.glb", "-o", "a.glb"], &["a.glb"]),
            (&["a.glb", "-o", "c.glb", "--report", "r", "--picture", "r"], &["two results"]),
        ] {
            let (code, text) = refused(arguments);
            assert_eq!(code, 2, "{arguments:?}: {text}");
            assert_eq!(text.lines().count(), 1, "{text}");
            for word in words {
                assert!(text.contains(word), "{arguments:?}: {text}");
            }
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
        assert_eq!(command.rig, Some(Rig::Auto));
        assert_eq!(command.rig_options.method, WeightMethod::Volume);
        assert_eq!(command.rig_options.garments, GarmentWeights::Nearest);
        assert_eq!(command.rig_options.thread_count, 2);
        assert_eq!(command.save_rigged.unwrap(), Path::new("x.glb"));
        assert_eq!(command.joints.unwrap(), Path::new("joints.json"));
        let plain = parsed(&[]);
        assert_eq!((plain.rig, plain.rig_options), (None, RigOptions::default()));
        assert_eq!(refused(&["--rig", "keep", "--joints", "joints.json"]).0, 2);
        assert!(refused(&["--save-rigged", "x.vrm"]).1.contains("x.vrm"));
        assert_eq!(refused(&["--body-weights", "wool"]).0, 2);
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
