//! Every argument with its help, for clap. What is a number or a word to the library has its help, its range and its default
//! from the library's table of options; help written here says how files and switches are spelt, which the table cannot.

use super::{Rig, values};
use clap::builder::ValueParser;
use clap::{Args, Parser};
use glam::Vec3;
use regex_lite::Regex;
use std::path::PathBuf;
use superdeform::{FaceCurve, FaceHints, GarmentWeights, Height, Mode, Options, Repair, Stage, WeightMethod};
use values::{choice, count, help, number};

/// Turns a 3D character into its super-deformed (SD, chibi) version.
#[derive(Debug, Parser)]
#[command(name = "superdeform", version, max_term_width = 100, after_help = SHORT, after_long_help = EXAMPLES)]
pub struct Single {
    /// The character to change: GLB, or VRM 0.x or 1.0 [default: a sample]
    pub target: Option<PathBuf>,

    /// Where the proportions come from: a rigged GLB or VRM, a saved style (.json), or a built-in one (sd2, sd2.5, sd3, sd4) [default: a sample]
    #[arg(conflicts_with = "heads")]
    pub reference: Option<PathBuf>,

    /// Where the result goes, in the target's format [default: superdeform-out/NAME_sd.glb or .vrm, with
    /// picture and report beside it]
    #[arg(short, long, value_name = "FILE")]
    pub output: Option<PathBuf>,

    /// Draw target, reference and result, front and side
    #[arg(long, value_name = "FILE.png")]
    pub picture: Option<PathBuf>,

    /// Write the numbers of the run
    #[arg(long, value_name = "FILE.json")]
    pub report: Option<PathBuf>,

    /// Save the reference's proportions; the file can stand for REFERENCE later
    #[arg(long, value_name = "FILE.json")]
    pub save_style: Option<PathBuf>,

    /// Write the target with its rig, not deformed
    #[arg(long, value_name = "FILE.glb", help_heading = NEW_RIG)]
    pub save_rigged: Option<PathBuf>,

    /// Joints that are known: a JSON object, role to [x, y, z] as in a report's target.joints
    #[arg(long, value_name = "FILE.json", help_heading = NEW_RIG)]
    pub joints: Option<PathBuf>,

    #[command(flatten)]
    pub settings: Arguments,
}

/// How to convert, whatever is converted.
#[derive(Clone, Debug, Args)]
pub struct Arguments {
    #[command(flatten)]
    pub numbers: Numbers,

    #[arg(long, value_name = "N", value_parser = number("heads"), help = help("heads"), help_heading = STYLE)]
    pub heads: Option<f64>,

    /// Mix in a second saved style, 0 to 1 of it
    #[arg(long, value_name = "STYLE.json:0.5", value_parser = ValueParser::new(values::blend), help_heading = STYLE)]
    pub blend: Option<(PathBuf, f64)>,

    #[arg(long, value_name = "X", allow_negative_numbers = true, value_parser = number("face_squash"),
        help = help("face_squash"), help_heading = STYLE)]
    pub face_squash: Option<f64>,

    #[arg(long, value_name = "CURVE", value_parser = choice::<FaceCurve>("face_curve"),
        help = help("face_curve"), help_heading = STYLE)]
    pub face_curve: Option<FaceCurve>,

    #[arg(long, value_name = "X", value_parser = ValueParser::new(values::height), help = help("height"), help_heading = STYLE)]
    pub height: Option<Height>,

    /// Push clothes out of the body that were outside of it before: 1, or 0 to leave them [default: 1]
    #[arg(long, value_name = "0|1", value_parser = ValueParser::new(values::repair), help_heading = FACE)]
    pub repair: Option<Repair>,

    /// Where the left eye is, in the target's space, or both eyes: where they are not found, or not well
    #[arg(long, value_name = "X,Y,Z", allow_hyphen_values = true, value_parser = ValueParser::new(values::eyes), help_heading = FACE)]
    pub eyes: Option<FaceHints>,

    /// How much of the shade that is painted around the eyes goes, as they grow: a copy of the face's image is evened to the
    /// cheeks' colour [0 to 1; default: 0.8 for photos, 0 for drawn faces]
    #[arg(long, value_name = "X", value_parser = ValueParser::new(values::share), help_heading = FACE)]
    pub even_eyes: Option<f64>,

    /// Set a bone group, e.g. upper_leg:length=0.4,thickness=0.8: scales (length, thickness), or how much of
    /// the reference is taken, 0 to 1 (length_transfer, thickness_transfer); repeatable
    #[arg(long, value_name = "NAME:KEY=X,...", value_parser = ValueParser::new(values::group), help_heading = STYLE)]
    pub group: Vec<values::Group>,

    /// Your own bone groups: a JSON object, bone to group name; a bone is named by the role at its end
    #[arg(long, value_name = "FILE.json", help_heading = STYLE)]
    pub groups: Option<PathBuf>,

    /// The paper's equations and constants to the letter
    #[arg(long, help_heading = METHOD)]
    pub paper: bool,

    /// Take coefficients as measured, however small or large
    #[arg(long, help_heading = METHOD)]
    pub no_limits: bool,

    #[arg(long, value_name = "N", value_parser = count("rays"), help = help("rays"), help_heading = METHOD)]
    pub rays: Option<usize>,

    #[arg(long, value_name = "STAGE", value_parser = choice::<Stage>("stage"), help = help("stage"), help_heading = METHOD)]
    pub stage: Option<Stage>,

    /// Keep the target's rig, or make one [default: keep, where there is one with the roles that it takes]
    #[arg(long, value_name = "RIG", value_enum, help_heading = NEW_RIG)]
    pub rig: Option<Rig>,

    #[arg(long, value_name = "N", value_parser = count("thread_count"), help = help("thread_count"), help_heading = METHOD)]
    pub threads: Option<usize>,

    #[arg(long, value_name = "WAY", value_parser = choice::<WeightMethod>("rig_weights"),
        help = help("rig_weights"), help_heading = NEW_RIG)]
    pub body_weights: Option<WeightMethod>,

    #[arg(long, value_name = "WAY", value_parser = choice::<GarmentWeights>("rig_garments"),
        help = help("rig_garments"), help_heading = NEW_RIG)]
    pub garment_weights: Option<GarmentWeights>,

    #[arg(long, value_name = "N", value_parser = count("rig_voxel_resolution"),
        help = help("rig_voxel_resolution"), help_heading = NEW_RIG)]
    pub rig_voxel_resolution: Option<usize>,

    #[arg(long, value_name = "X", value_parser = number("rig_heat"), help = help("rig_heat"), help_heading = NEW_RIG)]
    pub rig_heat: Option<f64>,

    /// Give hands no finger joints
    #[arg(long, help_heading = NEW_RIG)]
    pub no_rig_fingers: bool,

    /// Roles of the target's joints where they are not found: a JSON object, role to node name
    #[arg(long, value_name = "MAP.json", help_heading = READING)]
    pub humanoid: Option<PathBuf>,

    /// The same for the reference
    #[arg(long, value_name = "MAP.json", help_heading = READING)]
    pub reference_humanoid: Option<PathBuf>,

    /// Meshes that are skin; matched, like the five below, against node|mesh|material
    #[arg(long, value_name = "REGEX", value_parser = ValueParser::new(values::pattern), help_heading = READING)]
    pub body: Vec<Regex>,

    /// Meshes that are clothes
    #[arg(long, value_name = "REGEX", value_parser = ValueParser::new(values::pattern), help_heading = READING)]
    pub garment: Vec<Regex>,

    /// Meshes that are hair
    #[arg(long, value_name = "REGEX", value_parser = ValueParser::new(values::pattern), help_heading = READING)]
    pub hair: Vec<Regex>,

    /// Meshes that follow the face: brows, lashes, teeth
    #[arg(long, value_name = "REGEX", value_parser = ValueParser::new(values::pattern), help_heading = READING)]
    pub face_part: Vec<Regex>,

    /// Meshes that are eyes: eyeballs, irises, pupils
    #[arg(long, value_name = "REGEX", value_parser = ValueParser::new(values::pattern), help_heading = READING)]
    pub eye: Vec<Regex>,

    /// Meshes that keep their shape: hats, glasses, bags
    #[arg(long, value_name = "REGEX", value_parser = ValueParser::new(values::pattern), help_heading = READING)]
    pub accessory: Vec<Regex>,

    /// The target's up axis [default: +Y]
    #[arg(long, value_name = "AXIS", allow_hyphen_values = true, value_parser = ValueParser::new(values::axis), help_heading = READING)]
    pub up: Option<Vec3>,

    /// The way the target looks [default: found from its joints]
    #[arg(long, value_name = "AXIS", allow_hyphen_values = true, value_parser = ValueParser::new(values::axis), help_heading = READING)]
    pub forward: Option<Vec3>,

    /// Convert what its licence forbids to change, because you are its author or have been allowed to
    #[arg(long, help_heading = READING)]
    pub allow_prohibited: bool,

    /// Give each spring chain of a VRM 0.x one joint more, so that its last bone keeps its proportion
    #[arg(long)]
    pub leaf_joints: bool,

    /// Add colliders around a VRM's legs where its skirt hangs from springs that none keeps out of them
    #[arg(long)]
    pub leg_colliders: bool,

    /// Draw a VRM's thumbnail anew from the result
    #[arg(long)]
    pub thumbnail: bool,

    /// Print every note, not only how many there are
    #[arg(short, long)]
    pub verbose: bool,

    /// Print nothing but errors
    #[arg(short, long)]
    pub quiet: bool,
}

impl Arguments {
    /// The library's options, but for bone groups, which need files to be read.
    pub fn options(&self) -> Options {
        let unset = Options::default();
        Options {
            mode: if self.paper { Mode::Paper } else { Mode::Product },
            rays: self.rays,
            face_squash: self.face_squash,
            face_curve: self.face_curve.unwrap_or(unset.face_curve),
            limits: !self.no_limits && !self.paper,
            repair: self.repair.unwrap_or(unset.repair),
            height: self.height.unwrap_or(unset.height),
            stage: self.stage.unwrap_or(unset.stage),
            thread_count: self.threads.unwrap_or(unset.thread_count),
            ..self.numbers.options()
        }
    }
}

macro_rules! numbers {
    ($($_block:ident { $(
        $(#[doc = $_text:literal])+
        $name:ident: $_low:literal..=$_high:literal = $_default:expr, $_modes:ident, $heading:ident;
    )+ })+) => {
        /// The options that are one number.
        #[derive(Clone, Debug, Args)]
        pub struct Numbers {
            $($(
                #[arg(long, value_name = "X", value_parser = number(stringify!($name)),
                    help = help(stringify!($name)), help_heading = $heading)]
                pub $name: Option<f64>,
            )+)+
        }

        impl Numbers {
            /// The defaults, and the numbers that are given.
            fn options(&self) -> Options {
                let unset = Options::default();
                Options { $($($name: self.$name.unwrap_or(unset.$name),)+)+ ..unset }
            }
        }
    };
}
superdeform::number_options!(numbers);

const STYLE: &str = "Style";
const FACE: &str = "Face, hair and clothes";
const METHOD: &str = "Method";
const NEW_RIG: &str = "Rig";
const READING: &str = "Reading the files";

const SHORT: &str = "\
Example: superdeform hero.vrm --heads 2.5 --picture hero.png -o hero_sd.vrm
All options: superdeform --help. Many files at a time: superdeform batch -h.";

const EXAMPLES: &str = "\
Examples:
  superdeform                                           the sample pair
  superdeform hero.vrm chibi.glb -o hero_sd.vrm
  superdeform hero.vrm --heads 2.5 -o hero_sd.vrm --picture hero.png
  superdeform hero.vrm chibi.glb --group upper_leg:length=0.4 --amount 0.8
  superdeform batch avatars --style sd2.5 -o avatars_sd     many at a time; see superdeform batch --help
  superdeform completions bash                          bash, zsh, fish, powershell, elvish
  superdeform man                                       this as a manual page; superdeform man batch

Bone groups: head neck torso shoulder upper_arm lower_arm hand finger hip upper_leg lower_leg foot.
Exit codes: 0 done, 1 bad input (one sentence on standard error), 2 wrong usage.";
