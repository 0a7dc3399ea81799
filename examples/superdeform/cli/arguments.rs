//! Every argument with its range and its help, for clap.

use super::{Rig, values};
use clap::builder::ValueParser;
use clap::{Parser, ValueEnum};
use glam::Vec3;
use regex::Regex;
use std::path::PathBuf;
use superdeform::options::HEADS;

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Curve {
    F4,
    F2,
    Sphere,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum LastStage {
    Length,
    Thickness,
    Face,
    All,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum GarmentWay {
    Robust,
    Nearest,
    Heat,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum BodyWay {
    Auto,
    Heat,
    Volume,
}

/// Turns a 3D character into its super-deformed (SD, chibi) version.
#[derive(Debug, Parser)]
#[command(name = "superdeform", version, max_term_width = 100, after_help = EXAMPLES)]
pub struct Arguments {
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

    /// A style for this many heads (1.8 to 6) instead of REFERENCE
    #[arg(long, value_name = "N", value_parser = values::number(HEADS.0, HEADS.1), help_heading = STYLE)]
    pub heads: Option<f64>,

    /// From the original (0) to the style (1)
    #[arg(long, value_name = "0..1", default_value = "1", value_parser = values::number(0.0, 1.0), help_heading = STYLE)]
    pub amount: f64,

    /// Mix in a second saved style, 0 to 1 of it
    #[arg(long, value_name = "STYLE.json:0.5", value_parser = ValueParser::new(values::blend), help_heading = STYLE)]
    pub blend: Option<(PathBuf, f64)>,

    /// Size of the head (alpha_head)
    #[arg(long, value_name = "X", default_value = "1.5", value_parser = values::number(0.1, 10.0), help_heading = STYLE)]
    pub head_scale: f64,

    /// How much younger the face gets; 0 leaves it (gamma) [default: 0.8, with --paper 0]
    #[arg(long, value_name = "X", value_parser = values::number(0.0, 10.0), help_heading = STYLE)]
    pub face_squash: Option<f64>,

    /// The curve for --face-squash
    #[arg(long, value_name = "CURVE", value_enum, default_value = "f4", help_heading = STYLE)]
    pub face_curve: Curve,

    /// Length of hair below the chin: 1 keeps where it ends on the body, 0 ends it at the chin
    #[arg(long, value_name = "0..1", default_value = "1", value_parser = values::number(0.0, 1.0), help_heading = STYLE)]
    pub hair_length: f64,

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

    /// Rays around each sample of a bone, at least 3 [default: 48, with --paper 12]
    #[arg(long, value_name = "N", value_parser = values::count(3, 4096), help_heading = METHOD)]
    pub rays: Option<usize>,

    /// Stop after a stage
    #[arg(long, value_name = "STAGE", value_enum, default_value = "all", help_heading = METHOD)]
    pub stage: LastStage,

    /// Keep the target's rig, or make one [default: keep, where there is one with the roles that it takes]
    #[arg(long, value_name = "RIG", value_enum, help_heading = METHOD)]
    pub rig: Option<Rig>,

    /// Write the target with its rig, not deformed
    #[arg(long, value_name = "FILE.glb", help_heading = METHOD)]
    pub save_rigged: Option<PathBuf>,

    /// How the body gets weights with a new rig: along its surface, through its volume, or whichever suits it
    #[arg(long, value_name = "WAY", value_enum, default_value = "auto", help_heading = METHOD)]
    pub body_weights: BodyWay,

    /// How clothes get weights with a new rig: from close surface points alike, from the nearest, or like a body
    #[arg(long, value_name = "WAY", value_enum, default_value = "robust", help_heading = METHOD)]
    pub garment_weights: GarmentWay,

    /// Joints that a new rig is to have: a JSON object, role to [x, y, z] as in a report's target.joints
    #[arg(long, value_name = "FILE.json", help_heading = METHOD)]
    pub joints: Option<PathBuf>,

    /// Threads; 0 for all cores
    #[arg(long, value_name = "N", default_value = "0", value_parser = values::count(0, 1024), help_heading = METHOD)]
    pub threads: usize,

    /// Roles of the target's joints where they are not found: a JSON object, role to node name
    #[arg(long, value_name = "MAP.json", help_heading = READING)]
    pub humanoid: Option<PathBuf>,

    /// The same for the reference
    #[arg(long, value_name = "MAP.json", help_heading = READING)]
    pub reference_humanoid: Option<PathBuf>,

    /// Meshes that are skin; matched, like the four below, against node|mesh|material
    #[arg(long, value_name = "REGEX", value_parser = ValueParser::new(values::pattern), help_heading = READING)]
    pub body: Vec<Regex>,

    /// Meshes that are clothes
    #[arg(long, value_name = "REGEX", value_parser = ValueParser::new(values::pattern), help_heading = READING)]
    pub garment: Vec<Regex>,

    /// Meshes that are hair
    #[arg(long, value_name = "REGEX", value_parser = ValueParser::new(values::pattern), help_heading = READING)]
    pub hair: Vec<Regex>,

    /// Meshes that follow the face: eyes, brows, lashes, teeth
    #[arg(long, value_name = "REGEX", value_parser = ValueParser::new(values::pattern), help_heading = READING)]
    pub face_part: Vec<Regex>,

    /// Meshes that keep their shape: hats, glasses, bags
    #[arg(long, value_name = "REGEX", value_parser = ValueParser::new(values::pattern), help_heading = READING)]
    pub accessory: Vec<Regex>,

    /// The target's up axis [default: +Y]
    #[arg(long, value_name = "AXIS", allow_hyphen_values = true, value_parser = ValueParser::new(values::axis), help_heading = READING)]
    pub up: Option<Vec3>,

    /// The way the target looks [default: found from its joints]
    #[arg(long, value_name = "AXIS", allow_hyphen_values = true, value_parser = ValueParser::new(values::axis), help_heading = READING)]
    pub forward: Option<Vec3>,

    /// Print nothing but errors
    #[arg(short, long)]
    pub quiet: bool,
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
