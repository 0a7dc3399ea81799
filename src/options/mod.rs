//! Everything a user can set, and the [`TABLE`] of what each option may be.

pub mod table;

pub use table::{HEADS, NUMBERS, OptionInfo, Scope, TABLE, Values, find};

use crate::character::Role;
use crate::error::{Error, ErrorKind, Result};
use glam::DVec3;
use std::collections::BTreeMap;
use table::option;

/// Gives the variants of an enumeration their names in options, files and reports.
macro_rules! names {
    ($type:ident { $($variant:ident: $name:literal),+ }) => {
        impl $type {
            /// All variants, the default first or in the order of the work.
            pub const ALL: &'static [Self] = &[$(Self::$variant),+];
            /// Their names.
            pub const NAMES: &'static [&'static str] = &[$($name),+];

            /// The name in options, files and reports.
            pub const fn name(self) -> &'static str {
                match self {
                    $(Self::$variant => $name),+
                }
            }
        }

        impl std::fmt::Display for $type {
            fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                f.write_str(self.name())
            }
        }

        impl std::str::FromStr for $type {
            type Err = Error;

            fn from_str(name: &str) -> Result<Self> {
                Self::ALL.iter().copied().find(|known| known.name() == name).ok_or_else(|| {
                    let message = format!("{name} is no choice here: give one of {}", Self::NAMES.join(", "));
                    Error::new(ErrorKind::BadOption, message)
                })
            }
        }
    };
}

/// Which field deforms.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Mode {
    /// Parts that meet at landmarks read from the geometry.
    #[default]
    Product,
    /// The paper's chain of bones, Eqs. 1-8, literally.
    Paper,
}

names!(Mode { Product: "product", Paper: "paper" });

/// The curve that makes a face younger (§VI, Fig. 7).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum FaceCurve {
    /// Eq. 13, the paper's choice.
    #[default]
    F4,
    /// Eq. 12.
    F2,
    /// The sphere approximation of Shen et al., reference 10, for comparison (Fig. 7f).
    Sphere,
}

names!(FaceCurve { F4: "f4", F2: "f2", Sphere: "sphere" });

/// How far to go (Fig. 6).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub enum Stage {
    /// Lengths only (Fig. 6b).
    Length,
    /// Lengths and thickness (Fig. 6c).
    Thickness,
    /// Everything.
    #[default]
    Face,
}

names!(Stage { Length: "length", Thickness: "thickness", Face: "face" });

/// Which rule gives the body its weights.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum WeightMethod {
    /// Heat where the body allows it, else the volume.
    #[default]
    Auto,
    /// Heat equilibrium on the surface (Baran and Popović, reference 11).
    Heat,
    /// Geodesic distances through a voxel volume (Dionne and de Lasa, reference 14).
    Volume,
}

names!(WeightMethod { Auto: "auto", Heat: "heat", Volume: "volume" });

/// Which rule gives clothes their weights (Fig. 4).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum GarmentWeights {
    /// Close surface points with like normals, the rest filled in smoothly.
    #[default]
    Robust,
    /// The closest surface point, whatever it is: the paper's rule (Fig. 4e).
    Nearest,
    /// Heat on the clothes themselves: the naive case (Fig. 4c).
    Heat,
}

names!(GarmentWeights { Robust: "robust", Nearest: "nearest", Heat: "heat" });

/// Whether clothes that were outside of the body are kept outside of it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Repair {
    /// They may end inside.
    Off,
    /// They are pushed out.
    #[default]
    On,
    /// As they were pushed last, whatever else has changed since; where nothing was pushed yet, as [`Repair::On`]. For while a
    /// slider moves: it saves the time to find out again, which [`Repair::On`] takes once the slider is let go.
    Kept,
}

names!(Repair { Off: "off", On: "on", Kept: "kept" });

/// How tall the result is. It grows or shrinks as a whole, about the ground below the hips.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Height {
    /// As the style makes it: a figure of fewer heads is shorter. In product mode nobody becomes taller than before.
    #[default]
    Style,
    /// As tall as the character was.
    Keep,
    /// This tall, in the character's units: above 0.
    Units(f64),
}

impl std::str::FromStr for Height {
    type Err = Error;

    fn from_str(text: &str) -> Result<Self> {
        let height = match (text, text.parse()) {
            ("style", _) => Self::Style,
            ("keep", _) => Self::Keep,
            (_, Ok(units)) => Self::Units(units),
            _ => return Err(Self::refused(text)),
        };
        height.check().map(|()| height)
    }
}

impl Height {
    fn check(self) -> Result<()> {
        match self {
            Self::Units(units) if !(units > 0.0 && units.is_finite()) => Err(Self::refused(units)),
            _ => Ok(()),
        }
    }

    fn refused(given: impl std::fmt::Display) -> Error {
        let message =
            format!("height is {given}: give style, keep, or a number above 0 in the character's units");
        Error::new(ErrorKind::BadOption, message).about("height")
    }
}

/// What a user sets for one bone group; `None` leaves the measured or the default value.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct GroupSettings {
    /// alpha_b: 1 keeps the length of the group's bones.
    pub length_scale: Option<f64>,
    /// beta_b: 1 keeps the thickness.
    pub thickness_scale: Option<f64>,
    /// eta_b: 0 keeps the target's length, 1 takes all of the reference's.
    pub length_transfer: Option<f64>,
    /// phi_b: 0 keeps the target's thickness, 1 takes all of the reference's.
    pub thickness_transfer: Option<f64>,
}

impl GroupSettings {
    /// What is set, with the names of the options.
    pub fn numbers(&self) -> [(&'static str, Option<f64>); 4] {
        [
            ("length_scale", self.length_scale),
            ("thickness_scale", self.thickness_scale),
            ("length_transfer", self.length_transfer),
            ("thickness_transfer", self.thickness_transfer),
        ]
    }

    /// Checks every number against its range, for the bone group `group`.
    pub(crate) fn check(&self, group: &str) -> Result<()> {
        check_all(self.numbers(), |option, value| option.check_in_group(group, value))
    }
}

macro_rules! options {
    ($($_block:ident { $(
        $(#[doc = $text:literal])+
        $name:ident: $_low:literal..=$_high:literal = $default:expr, $_modes:ident, $_heading:ident;
    )+ })+) => {
        /// Everything a user can set.
        #[derive(Clone, Debug, PartialEq)]
        pub struct Options {
            $($($(#[doc = $text])+ pub $name: f64,)+)+
            /// Which field deforms.
            pub mode: Mode,
            /// Rays around each sample of a bone (§V-A); `None`: the mode's own.
            pub rays: Option<usize>,
            /// gamma (Eqs. 12, 13); `None`: the mode's own.
            pub face_squash: Option<f64>,
            /// Which curve `face_squash` is for.
            pub face_curve: FaceCurve,
            /// Settings by the name of the bone group.
            pub groups: BTreeMap<String, GroupSettings>,
            /// The user's own bone groups (§IV-A, Fig. 3): the role at a bone's end to a group name.
            pub bone_groups: BTreeMap<Role, String>,
            /// Product mode's bounds on coefficients.
            pub limits: bool,
            /// Whether clothes that the body would pierce are pushed out of it; product mode alone.
            pub repair: Repair,
            /// How tall the result is.
            pub height: Height,
            /// Stop after this stage.
            pub stage: Stage,
            /// Threads to use; 0 means all cores.
            pub thread_count: usize,
        }

        impl Default for Options {
            fn default() -> Self {
                Self {
                    $($($name: $default,)+)+
                    mode: Mode::Product,
                    rays: None,
                    face_squash: None,
                    face_curve: FaceCurve::F4,
                    groups: BTreeMap::new(),
                    bone_groups: BTreeMap::new(),
                    limits: true,
                    repair: Repair::On,
                    height: Height::Style,
                    stage: Stage::Face,
                    thread_count: 0,
                }
            }
        }

        impl Options {
            /// What is set of the options that are numbers, with their names.
            pub fn numbers(&self) -> Vec<(&'static str, Option<f64>)> {
                vec![
                    $($((stringify!($name), Some(self.$name)),)+)+
                    ("rays", self.rays.map(|rays| rays as f64)),
                    ("face_squash", self.face_squash),
                    ("thread_count", Some(self.thread_count as f64)),
                ]
            }
        }
    };
}
crate::number_options!(options);

/// How much of youth each feature of a face takes, 0 to 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Features {
    /// Eyes grow and lids open.
    pub eye: f64,
    /// Eyes and all beside them sink.
    pub lower: f64,
    /// The nose shrinks.
    pub nose: f64,
    /// Cheeks fill.
    pub cheek: f64,
    /// Chin and mouth become smaller and rounder.
    pub jaw: f64,
    /// The skull becomes as wide and deep as the reference's, the forehead rounder.
    pub skull: f64,
    /// Ears come closer and become smaller.
    pub ear: f64,
}

impl Default for Features {
    /// All of each.
    fn default() -> Self {
        Self { eye: 1.0, lower: 1.0, nose: 1.0, cheek: 1.0, jaw: 1.0, skull: 1.0, ear: 1.0 }
    }
}

impl Options {
    /// Rays around each sample of a bone: as set, else the mode's own.
    pub fn ray_count(&self) -> usize {
        self.rays.unwrap_or(match self.mode {
            Mode::Paper => table::PAPER_RAYS as usize,
            Mode::Product => table::PRODUCT_RAYS as usize,
        })
    }

    /// How much of youth each feature of the face takes.
    pub fn features(&self) -> Features {
        Features {
            eye: self.youth_eye,
            lower: self.youth_lower,
            nose: self.youth_nose,
            cheek: self.youth_cheek,
            jaw: self.youth_jaw,
            skull: self.youth_skull,
            ear: self.youth_ear,
        }
    }

    /// Checks every number against its range in the table.
    ///
    /// # Errors
    /// `ErrorKind::BadOption` names the option, its value and its range.
    pub fn validate(&self) -> Result<()> {
        check_all(self.numbers(), OptionInfo::check)?;
        self.height.check()?;
        let mut groups = self.groups.iter();
        groups.try_for_each(|(group, settings)| settings.check(group))
    }
}

/// What the auto-rig can be told.
#[derive(Clone, Debug, PartialEq)]
pub struct RigOptions {
    /// Which rule gives the body its weights.
    pub method: WeightMethod,
    /// Which rule gives clothes their weights.
    pub garments: GarmentWeights,
    /// c of the heat equation: 1 spreads weights over about a limb's radius; larger is sharper.
    pub heat: f64,
    /// Voxels along the longest side of the volume.
    pub voxel_resolution: usize,
    /// Joints that are known, model space; the rest is found.
    pub given: BTreeMap<Role, DVec3>,
    /// Looks for fingers.
    pub fingers: bool,
    /// The axes of model space are left-handed, as Unity's: which of two sides is the left one depends on it.
    pub left_handed: bool,
    /// Threads to use; 0 means all cores.
    pub thread_count: usize,
}

impl Default for RigOptions {
    fn default() -> Self {
        Self {
            method: WeightMethod::Auto,
            garments: GarmentWeights::Robust,
            heat: table::RIG_HEAT,
            voxel_resolution: table::RIG_VOXEL_RESOLUTION as usize,
            given: BTreeMap::new(),
            fingers: true,
            left_handed: false,
            thread_count: 0,
        }
    }
}

impl RigOptions {
    /// What is set of the options that are numbers, with their names.
    pub fn numbers(&self) -> [(&'static str, Option<f64>); 3] {
        [
            ("rig_heat", Some(self.heat)),
            ("rig_voxel_resolution", Some(self.voxel_resolution as f64)),
            ("thread_count", Some(self.thread_count as f64)),
        ]
    }

    /// Checks every number against its range in the table, and that known joints are somewhere.
    ///
    /// # Errors
    /// `ErrorKind::BadOption` names the option, its value and its range.
    pub fn validate(&self) -> Result<()> {
        check_all(self.numbers(), OptionInfo::check)?;
        if let Some((role, at)) = self.given.iter().find(|(_, at)| !at.is_finite()) {
            let message = format!("the given joint {role} is at {at}: positions must be finite numbers");
            return Err(Error::new(ErrorKind::BadOption, message).about("rig_joints"));
        }
        Ok(())
    }
}

/// Has `check` check those of `numbers` that are set.
fn check_all(
    numbers: impl IntoIterator<Item = (&'static str, Option<f64>)>,
    check: impl Fn(&OptionInfo, f64) -> Result<()>,
) -> Result<()> {
    let mut set = numbers.into_iter().filter_map(|(name, value)| Some((option(name), value?)));
    set.try_for_each(|(option, value)| check(option, value))
}

#[cfg(test)]
mod tests {
    use super::*;
    use table::Default as Unset;

    fn names_of(scope: Scope) -> Vec<&'static str> {
        let is_number = |info: &&OptionInfo| {
            info.scope == scope && matches!(info.values, Values::Number { .. } | Values::Count { .. })
        };
        TABLE.iter().filter(is_number).map(|info| info.name).collect()
    }

    #[test]
    fn every_number_of_the_table_is_checked() {
        let plain: Vec<&str> = Options::default().numbers().iter().map(|(name, _)| *name).collect();
        let group = GroupSettings::default().numbers().map(|(name, _)| name);
        let rig = RigOptions::default().numbers().map(|(name, _)| name);
        for (scope, checked) in [(Scope::Plain, &plain[..]), (Scope::Group, &group), (Scope::Rig, &rig)] {
            let names = names_of(scope);
            assert!(!names.is_empty());
            assert!(names.iter().all(|name| checked.contains(name)), "{names:?} {checked:?}");
        }
    }

    #[test]
    fn the_defaults_are_those_of_the_table() {
        let (options, rig) = (Options::default(), RigOptions::default());
        for (name, value) in options.numbers().into_iter().chain(rig.numbers()) {
            match find(name).unwrap().default {
                Unset::Number(default) => assert_eq!(value, Some(default), "{name}"),
                Unset::ByMode { .. } => assert_eq!(value, None, "{name}"),
                other => panic!("{name} is a number and has the default {other:?}"),
            }
        }
        let words = [
            ("mode", options.mode.name()),
            ("stage", options.stage.name()),
            ("face_curve", options.face_curve.name()),
            ("rig_weights", rig.method.name()),
            ("rig_garments", rig.garments.name()),
        ];
        for (name, word) in words {
            assert_eq!(find(name).unwrap().default, Unset::Choice(word));
        }
        let switches =
            [("limits", options.limits), ("rig_fingers", rig.fingers), ("rig_left_handed", rig.left_handed)];
        for (name, on) in switches {
            assert_eq!(find(name).unwrap().default, Unset::Switch(on));
        }
    }

    #[test]
    fn what_is_out_of_range_is_refused_by_name() {
        for head_scale in [0.05, 11.0, f64::NAN] {
            let error = Options { head_scale, ..Options::default() }.validate().unwrap_err();
            assert_eq!((error.kind, error.option), (ErrorKind::BadOption, Some("head_scale")));
            assert_eq!(error.message, format!("head scale is {head_scale}: give a number from 0.1 to 10"));
        }
        let settings = GroupSettings { length_transfer: Some(1.5), ..GroupSettings::default() };
        let groups = BTreeMap::from([("legs".to_string(), settings)]);
        let error = Options { groups, ..Options::default() }.validate().unwrap_err();
        assert_eq!(error.option, Some("length_transfer"));
        assert_eq!(error.message, "length transfer of the group legs is 1.5: give a number from 0 to 1");
        let error = RigOptions { voxel_resolution: 8, ..RigOptions::default() }.validate().unwrap_err();
        assert_eq!(error.message, "voxel resolution is 8: give a number from 16 to 512");
    }

    #[test]
    fn a_height_is_a_word_or_a_number_above_0() {
        assert_eq!("style".parse(), Ok(Height::Style));
        assert_eq!("keep".parse(), Ok(Height::Keep));
        assert_eq!("1.25".parse(), Ok(Height::Units(1.25)));
        for bad in ["0", "-1", "NaN", "inf", "tall", ""] {
            let error = bad.parse::<Height>().unwrap_err();
            assert_eq!((error.kind, error.option), (ErrorKind::BadOption, Some("height")), "{bad}");
        }
        let options = Options { height: Height::Units(0.0), ..Options::default() };
        assert!(options.validate().unwrap_err().message.starts_with("height is 0: give"));
    }

    #[test]
    fn names_are_read_back() {
        for &curve in FaceCurve::ALL {
            assert_eq!(curve.name().parse(), Ok(curve));
        }
        let error = "f3".parse::<FaceCurve>().unwrap_err();
        assert_eq!(error.message, "f3 is no choice here: give one of f4, f2, sphere");
    }
}
