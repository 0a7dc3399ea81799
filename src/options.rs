//! Everything a user can set.

use crate::character::Role;
use crate::error::{Error, ErrorKind, Result};
use std::collections::BTreeMap;

/// Which field deforms.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Mode {
    /// 15 parts that meet at landmarks read from the geometry.
    #[default]
    Product,
    /// The paper's chain of bones, Eqs. 1-8, literally.
    Paper,
}

impl Mode {
    /// The name in options and reports.
    pub fn name(self) -> &'static str {
        match self {
            Mode::Product => "product",
            Mode::Paper => "paper",
        }
    }
}

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

/// Everything a user can set.
#[derive(Clone, Debug, PartialEq)]
pub struct Options {
    /// Which field deforms.
    pub mode: Mode,
    /// Rays around each sample of a bone (§V-A); `None`: 12 in paper mode, 48 in product mode. At least 3.
    pub rays: Option<usize>,
    /// alpha_head (Eq. 4), above 0.
    pub head_scale: f64,
    /// gamma (Eqs. 12, 13); `None`: 0 in paper mode, 0.8 in product mode.
    pub face_squash: Option<f64>,
    /// Which curve `face_squash` is for.
    pub face_curve: FaceCurve,
    /// Settings by the name of the bone group.
    pub groups: BTreeMap<String, GroupSettings>,
    /// The user's own bone groups (§IV-A, Fig. 3): the role at a bone's end to a group name.
    pub bone_groups: BTreeMap<Role, String>,
    /// 0 gives the original back, 1 the style.
    pub amount: f64,
    /// Product mode's bounds on coefficients.
    pub limits: bool,
    /// Length of hair below the chin: 1 ends it at the part of the body where it ended, 0 at the chin.
    pub hair_length: f64,
    /// Stop after this stage.
    pub stage: Stage,
    /// Threads to use; 0 means all cores.
    pub thread_count: usize,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            mode: Mode::Product,
            rays: None,
            head_scale: HEAD_SCALE,
            face_squash: None,
            face_curve: FaceCurve::F4,
            groups: BTreeMap::new(),
            bone_groups: BTreeMap::new(),
            amount: 1.0,
            limits: true,
            hair_length: 1.0,
            stage: Stage::Face,
            thread_count: 0,
        }
    }
}

impl Options {
    /// Rays around each sample of a bone: as set, else the mode's own.
    pub fn ray_count(&self) -> usize {
        self.rays.unwrap_or(match self.mode {
            Mode::Paper => PAPER_RAYS,
            Mode::Product => PRODUCT_RAYS,
        })
    }

    /// Checks every number against its range.
    ///
    /// # Errors
    /// `ErrorKind::BadOption` names the option, its value and its range.
    pub fn validate(&self) -> Result<()> {
        let in_range = |name: &str, value: f64, low: f64, high: f64| {
            if (low..=high).contains(&value) {
                return Ok(());
            }
            Err(Error::new(
                ErrorKind::BadOption,
                format!("{name} is {value}: give a number from {low} to {high}"),
            ))
        };
        in_range("head_scale", self.head_scale, 0.1, 10.0)?;
        in_range("amount", self.amount, 0.0, 1.0)?;
        in_range("hair_length", self.hair_length, 0.0, 1.0)?;
        in_range("rays", self.ray_count() as f64, 3.0, 4096.0)?;
        if let Some(squash) = self.face_squash {
            in_range("face_squash", squash, -10.0, 10.0)?;
        }
        for (name, group) in &self.groups {
            for (what, value) in [("length", group.length_scale), ("thickness", group.thickness_scale)] {
                if let Some(value) = value {
                    in_range(&format!("{what} of group {name}"), value, 0.01, 100.0)?;
                }
            }
            for (what, value) in
                [("length_transfer", group.length_transfer), ("thickness_transfer", group.thickness_transfer)]
            {
                if let Some(value) = value {
                    in_range(&format!("{what} of group {name}"), value, -10.0, 10.0)?;
                }
            }
        }
        Ok(())
    }
}

/// alpha_head. Paper, V-B1.
pub const HEAD_SCALE: f64 = 1.5;
/// Rays around each sample in paper mode. Paper, V-A.
pub const PAPER_RAYS: usize = 12;
/// Rays around each sample in product mode: 12 change a radius by up to 16 % with their phase, 48 by 1 %.
pub const PRODUCT_RAYS: usize = 48;
