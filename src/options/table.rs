//! One truth about options: what each is called, what it may be, what it is unless set, and which mode honours it.
//!
//! [`Options::validate`](super::Options::validate) checks by this table, errors and warnings name an option as it does, and
//! hosts make or check their help, ranges and defaults by it; each spells the name its own way.

use super::{FaceCurve, GarmentWeights, Mode, Repair, Stage, WeightMethod};
use crate::error::{Error, ErrorKind, Result};
use std::fmt;

/// alpha_head. Paper, V-B1.
pub const HEAD_SCALE: f64 = 1.5;
/// Rays around each sample in paper mode. Paper, V-A; a radius changes by up to 16 % with their phase (D5).
pub const PAPER_RAYS: u32 = 12;
/// Rays around each sample in product mode: 12 change a radius by up to 16 % with their phase, 48 by 1.1 % (D5).
pub const PRODUCT_RAYS: u32 = 48;
/// Fewest rays that have a centroid.
pub const FEWEST_RAYS: u32 = 3;
/// gamma of product mode. D18, found by looking: 0 leaves an adult, 1.4 a pointed forehead.
pub const PRODUCT_FACE_SQUASH: f64 = 0.8;
/// More threads than this are of no use, and tens of thousands are more than a system can start.
pub const MOST_THREADS: u32 = 1024;
/// Fewest and most heads that a style may ask for: below, a head and a neck leave no room for a body; above, nothing is
/// super-deformed.
pub const HEADS: (f64, f64) = (1.8, 6.0);
/// c of the heat equation: spreads weights over about a limb's radius (D23).
pub const RIG_HEAT: f64 = 1.0;
/// Voxels along the longest side of the volume: time and memory against thin fingers (D23).
pub const RIG_VOXEL_RESOLUTION: u32 = 128;

/// Where an option is set.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scope {
    /// Once: [`Options`](super::Options).
    Plain,
    /// For one bone group: [`GroupSettings`](super::GroupSettings).
    Group,
    /// For the auto-rig: [`RigOptions`](super::RigOptions).
    Rig,
    /// With the style.
    Style,
    /// With the character.
    Character,
}

/// What an option may be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Values {
    /// A number in this range, its ends included.
    Number {
        /// The least.
        low: f64,
        /// The greatest.
        high: f64,
    },
    /// A whole number in this range, its ends included.
    Count {
        /// The least.
        low: u32,
        /// The greatest.
        high: u32,
    },
    /// Yes or no.
    Switch,
    /// One of these words.
    Choice(&'static [&'static str]),
    /// Something of its own kind: a direction, names by role.
    Other,
}

/// What an option is unless it is set.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Default {
    /// A number.
    Number(f64),
    /// A number for each mode.
    ByMode {
        /// In product mode.
        product: f64,
        /// In paper mode.
        paper: f64,
    },
    /// Yes or no.
    Switch(bool),
    /// A word.
    Choice(&'static str),
    /// What is measured or found.
    Found,
}

/// One option.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OptionInfo {
    /// Its name: lower case, words joined by `_`.
    pub name: &'static str,
    /// Where it is set.
    pub scope: Scope,
    /// What it may be.
    pub values: Values,
    /// What a number counts or measures; empty for plain factors.
    pub unit: &'static str,
    /// What it is unless set.
    pub default: Default,
    /// The modes that honour it.
    pub modes: &'static [Mode],
    /// What it does, in one line.
    pub text: &'static str,
}

impl OptionInfo {
    /// The name in words, for sentences: `head scale`.
    pub fn label(&self) -> String {
        self.name.trim_start_matches("rig_").replace('_', " ")
    }

    /// Checks a number against the range.
    ///
    /// # Errors
    /// `ErrorKind::BadOption` names the option, the number and the range.
    pub fn check(&self, value: f64) -> Result<()> {
        self.check_of(&self.label(), value)
    }

    /// As [`OptionInfo::check`], for the bone group `group`.
    ///
    /// # Errors
    /// As [`OptionInfo::check`].
    pub fn check_in_group(&self, group: &str, value: f64) -> Result<()> {
        self.check_of(&format!("{} of the group {group}", self.label()), value)
    }

    fn check_of(&self, what: &str, value: f64) -> Result<()> {
        let (low, high) = match self.values {
            Values::Number { low, high } => (low, high),
            Values::Count { low, high } => (low.into(), high.into()),
            _ => return Ok(()),
        };
        if (low..=high).contains(&value) {
            return Ok(());
        }
        let message = format!("{what} is {value}: give a number from {low} to {high}");
        Err(Error::new(ErrorKind::BadOption, message).about(self.name))
    }
}

impl fmt::Display for Values {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Values::Number { low, high } => write!(f, "{low} to {high}"),
            Values::Count { low, high } => write!(f, "{low} to {high}"),
            Values::Switch => f.write_str("on or off"),
            Values::Choice(names) => f.write_str(&names.join(", ")),
            Values::Other => Ok(()),
        }
    }
}

impl fmt::Display for Default {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Default::Number(number) => write!(f, "{number}"),
            Default::ByMode { product, paper } => write!(f, "{product}, in paper mode {paper}"),
            Default::Switch(on) => f.write_str(if *on { "on" } else { "off" }),
            Default::Choice(name) => f.write_str(name),
            Default::Found => Ok(()),
        }
    }
}

const BOTH: &[Mode] = &[Mode::Product, Mode::Paper];
const PRODUCT: &[Mode] = &[Mode::Product];

const fn number(low: f64, high: f64) -> Values {
    Values::Number { low, high }
}

const fn count(low: u32, high: u32) -> Values {
    Values::Count { low, high }
}

const fn by_mode(product: f64, paper: f64) -> Default {
    Default::ByMode { product, paper }
}

/// Bones of a hundredth of their length are a matter of rounding, and no figure has one of ten times its length.
const SCALES: Values = number(0.01, 10.0);
/// eta and phi of the paper, which knows no other range. Beyond 1 the transfer is a straight line that soon runs through
/// 0 and turns a limb inside out (a leg of .4 ends at -.2 with 2); who wants more than the reference sets the scale.
const TRANSFERS: Values = number(0.0, 1.0);
/// The curves fold long before the ends and are bounded there, with a warning; below 0 a face gets older.
const SQUASHES: Values = number(-10.0, 10.0);

/// The options that are one number, each with its text, range and default, the modes that honour it and the command line's heading:
/// what a host, a check or a file needs to know of an option of this kind is made from its row here.
///
/// `$then`: a macro that gets all rows. New ones go to the end, which is the end of the C interface's struct; its `first`
/// stand among others there.
#[doc(hidden)]
#[macro_export]
macro_rules! number_options {
    ($then:ident) => {
        $then! {
            first {
                /// how many times as large as the character's own the head becomes; 1.5 is the paper's. The number of heads is the
                /// style's, so the whole figure grows and shrinks with the head; where height is set, that counts
                head_scale: 0.1..=10.0 = $crate::options::table::HEAD_SCALE, BOTH, STYLE;
                /// from the original (0) to the style (1)
                amount: 0.0..=1.0 = 1.0, BOTH, STYLE;
                /// 1 makes every slice of the body as broad and deep as the style's, 0 gives each part one thickness
                profile: 0.0..=1.0 = 1.0, PRODUCT, STYLE;
                /// hair below the chin: 1 ends it where it ended on the body, 0 at the chin
                hair_length: 0.0..=1.0 = 1.0, PRODUCT, STYLE;
            }
            later {
                /// from the face's own age (0) to a child's, or the reference's (1)
                youth: 0.0..=1.0 = 1.0, PRODUCT, FACE;
                /// of youth: eyes grow, lids open
                youth_eye: 0.0..=1.0 = 1.0, PRODUCT, FACE;
                /// of youth: eyes and all beside them sink
                youth_lower: 0.0..=1.0 = 1.0, PRODUCT, FACE;
                /// of youth: the nose shrinks
                youth_nose: 0.0..=1.0 = 1.0, PRODUCT, FACE;
                /// of youth: cheeks fill
                youth_cheek: 0.0..=1.0 = 1.0, PRODUCT, FACE;
                /// of youth: chin and mouth become smaller and rounder
                youth_jaw: 0.0..=1.0 = 1.0, PRODUCT, FACE;
                /// of youth: the skull becomes as wide and deep as the reference's
                youth_skull: 0.0..=1.0 = 1.0, PRODUCT, FACE;
                /// of youth: ears come closer and become smaller
                youth_ear: 0.0..=1.0 = 1.0, PRODUCT, FACE;
                /// lifts the corners of the mouth
                smile: 0.0..=1.0 = 0.0, PRODUCT, FACE;
                /// moves the head back over the chest
                seat: 0.0..=1.0 = 1.0, PRODUCT, FACE;
                /// lays long hair on the body instead of letting it flare
                hair_lay: 0.0..=1.0 = 1.0, PRODUCT, FACE;
            }
        }
    };
}

macro_rules! numbers {
    ($($_block:ident { $(
        $(#[doc = $text:literal])+
        $name:ident: $low:literal..=$high:literal = $default:expr, $modes:ident, $_heading:ident;
    )+ })+) => {
        /// The options that are one number.
        pub const NUMBERS: &[OptionInfo] = &[$($(OptionInfo {
            name: stringify!($name),
            scope: Scope::Plain,
            values: number($low, $high),
            unit: "",
            default: Default::Number($default),
            modes: $modes,
            text: concat!($($text),+).trim_ascii(),
        },)+)+];
    };
}
number_options!(numbers);

/// All options.
pub const TABLE: &[OptionInfo] = &joined::<{ NUMBERS.len() + OTHERS.len() }>(NUMBERS, OTHERS);

const fn joined<const COUNT: usize>(first: &[OptionInfo], then: &[OptionInfo]) -> [OptionInfo; COUNT] {
    let mut all = [first[0]; COUNT];
    let mut index = 1;
    while index < COUNT {
        all[index] = if index < first.len() { first[index] } else { then[index - first.len()] };
        index += 1;
    }
    all
}

macro_rules! rows {
    ($($name:literal, $scope:ident, $values:expr, $unit:literal, $default:expr, $modes:ident, $text:literal;)+) => {
        &[$(OptionInfo {
            name: $name,
            scope: Scope::$scope,
            values: $values,
            unit: $unit,
            default: $default,
            modes: $modes,
            text: $text,
        }),+]
    };
}

/// The options that are something else.
#[rustfmt::skip]
const OTHERS: &[OptionInfo] = rows! {
    "mode", Plain, Values::Choice(Mode::NAMES), "", Default::Choice(Mode::Product.name()), BOTH,
        "what deforms: parts that meet at landmarks (product), or the paper's chain of bones (paper)";
    "stage", Plain, Values::Choice(Stage::NAMES), "", Default::Choice(Stage::Face.name()), BOTH,
        "the last stage: lengths alone, lengths and thickness, or everything up to the face";
    "rays", Plain, count(FEWEST_RAYS, 4096), "rays", by_mode(PRODUCT_RAYS as f64, PAPER_RAYS as f64), BOTH,
        "rays around each sample of a bone";
    "limits", Plain, Values::Switch, "", Default::Switch(true), PRODUCT,
        "bounds what may be done to a body, where measured scales would fold it";
    "height", Plain, Values::Other, "", Default::Choice("style"), BOTH,
        "how tall the result is: as the style makes it, at most as before (style), as tall as before (keep), or a number in the character's units";
    "face_squash", Plain, SQUASHES, "", by_mode(PRODUCT_FACE_SQUASH, 0.0), BOTH,
        "how much younger the face gets; 0 leaves it";
    "face_curve", Plain, Values::Choice(FaceCurve::NAMES), "", Default::Choice(FaceCurve::F4.name()), BOTH,
        "the curve that makes the face younger: the paper's f4 or f2, or a sphere";
    "repair", Plain, Values::Choice(Repair::NAMES), "", Default::Choice(Repair::On.name()), PRODUCT,
        "pushes clothes out of the body that were outside of it before; kept: as it did last, for while a slider moves";
    "thread_count", Plain, count(0, MOST_THREADS), "threads", Default::Number(0.0), BOTH,
        "threads to use; 0 means all cores";
    "groups", Plain, Values::Other, "", Default::Found, BOTH,
        "settings by bone group";
    "bone_groups", Plain, Values::Other, "", Default::Found, BOTH,
        "bone groups of your own: a bone's end to a group's name";
    "length_scale", Group, SCALES, "", Default::Found, BOTH,
        "1 keeps the length of the group's bones, 0.5 halves it";
    "thickness_scale", Group, SCALES, "", Default::Found, BOTH,
        "1 keeps the thickness of the group, 0.5 halves it";
    "length_transfer", Group, TRANSFERS, "", Default::Found, BOTH,
        "0 keeps the target's length, 1 takes all of the reference's";
    "thickness_transfer", Group, TRANSFERS, "", Default::Found, BOTH,
        "0 keeps the target's thickness, 1 takes all of the reference's";
    "rig_weights", Rig, Values::Choice(WeightMethod::NAMES), "", Default::Choice(WeightMethod::Auto.name()), BOTH,
        "how the body gets weights: along its surface (heat), through its volume, or whichever suits it (auto)";
    "rig_garments", Rig, Values::Choice(GarmentWeights::NAMES), "", Default::Choice(GarmentWeights::Robust.name()), BOTH,
        "how clothes get weights: from close surface points alike (robust), from the nearest, or like a body (heat)";
    "rig_voxel_resolution", Rig, count(16, 512), "voxels", Default::Number(RIG_VOXEL_RESOLUTION as f64), BOTH,
        "voxels along the longest side of the body's volume";
    "rig_fingers", Rig, Values::Switch, "", Default::Switch(true), BOTH,
        "looks for fingers";
    "rig_heat", Rig, number(0.01, 1000.0), "", Default::Number(RIG_HEAT), BOTH,
        "how sharp weights by heat are: 1 spreads them over about a limb's radius, more is sharper";
    "rig_joints", Rig, Values::Other, "", Default::Found, BOTH,
        "joints that are known: a role to its place; the rest is found";
    "rig_left_handed", Rig, Values::Switch, "", Default::Switch(false), BOTH,
        "the axes are left-handed: which of two sides is the left one depends on it";
    "heads", Style, number(HEADS.0, HEADS.1), "heads", Default::Found, BOTH,
        "a style for this many heads instead of a reference";
    "blend", Style, TRANSFERS, "", Default::Number(0.0), BOTH,
        "how much of a second style there is";
    "up", Character, Values::Other, "", Default::Found, BOTH,
        "from the feet to the head";
    "forward", Character, Values::Other, "", Default::Found, BOTH,
        "the way the character looks";
    "humanoid", Character, Values::Other, "", Default::Found, BOTH,
        "which joint plays which humanoid role";
    "kinds", Character, Values::Other, "", Default::Found, BOTH,
        "what each mesh depicts: body, garment, hair, part of the face, eye, accessory";
    "eyes", Character, Values::Other, "", Default::Found, BOTH,
        "where the eyes are, where they are not found";
};

/// The option named `name`.
pub const fn find(name: &str) -> Option<&'static OptionInfo> {
    let mut index = 0;
    while index < TABLE.len() {
        if is_same(TABLE[index].name, name) {
            return Some(&TABLE[index]);
        }
        index += 1;
    }
    None
}

/// The option named `name`, which stands in the table.
pub(crate) const fn option(name: &str) -> &'static OptionInfo {
    find(name).expect("every option of the library stands in the table")
}

const fn is_same(one: &str, other: &str) -> bool {
    let (one, other) = (one.as_bytes(), other.as_bytes());
    let mut index = 0;
    while index < one.len() && index < other.len() && one[index] == other[index] {
        index += 1;
    }
    one.len() == other.len() && index == one.len()
}
