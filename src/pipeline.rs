//! Puts the stages in order: what is known so far, and what comes out.

use crate::character::{MorphTarget, Role};
use glam::{DMat3, DVec3, Vec3, Vec4};
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

/// The curve that makes a face younger (§VI, Fig. 7).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum FaceCurve {
    /// Eq. 13, the paper's choice.
    #[default]
    F4,
    /// Eq. 12.
    F2,
    /// The sphere approximation of Shen et al. [10], for comparison (Fig. 7f).
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
    /// beta_b: 1 keeps the girth.
    pub thickness_scale: Option<f64>,
    /// eta_b: 0 keeps the target's length, 1 takes all of the reference's.
    pub length_transfer: Option<f64>,
    /// phi_b: 0 keeps the target's girth, 1 takes all of the reference's.
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
    /// Product mode's bounds on coefficients (D27).
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
            head_scale: 1.5,
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

/// One mesh as it came out; arrays the input lacked are empty here too.
#[derive(Clone, Debug, Default)]
pub struct DeformedMesh {
    /// New rest positions, model space.
    pub positions: Vec<Vec3>,
    /// New unit normals.
    pub normals: Vec<Vec3>,
    /// New unit tangents; `w` is kept.
    pub tangents: Vec<Vec4>,
    /// New morph deltas, in the input's order.
    pub morph_targets: Vec<MorphTarget>,
}

/// A super-deformed character: what changed, in the input's order and space.
#[derive(Clone, Debug, Default)]
pub struct Deformed {
    /// One for each input mesh.
    pub meshes: Vec<DeformedMesh>,
    /// Where each joint of the input's skeleton is now, model space. Joints move and do not turn or scale:
    /// the new rest transform is the old one with this translation.
    pub joints: Vec<DVec3>,
}

/// Where the field takes a point, and what it does around it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mapped {
    /// The point's new place, model space.
    pub position: DVec3,
    /// The field's Jacobian there, at fixed weights.
    pub jacobian: DMat3,
}

impl Mapped {
    /// The scale of small things at this point: the cube root of the Jacobian's determinant.
    pub fn local_scale(&self) -> f64 {
        self.jacobian.determinant().abs().cbrt()
    }
}
