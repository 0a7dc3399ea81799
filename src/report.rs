//! The numbers of a run, under the names that tools rely on.

use crate::character::Role;
use crate::error::Warning;
use crate::face::face_landmarks::FaceLandmarks;
use crate::options::{Mode, Options};
use crate::shape::group::{Coefficient, GroupShape, group_shapes};
use crate::shape::product::face_input::head_frame;
use crate::shape::product::profile::{CHAINS, Profile, wanted_of};
use crate::shape::style::Style;
use crate::shape::{BodyShape, Heights, Measured};
use glam::DVec3;
use serde::Serialize;
use std::collections::{BTreeMap, BTreeSet};

/// By the names of the roles.
pub(crate) fn by_name<T>(values: impl Iterator<Item = (Role, T)>) -> BTreeMap<String, T> {
    values.map(|(role, value)| (role.name().to_string(), value)).collect()
}

/// What was measured on one character.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct FigureReport {
    /// Extent of the rest pose along up, all meshes.
    pub height: f64,
    /// l_head of Eq. 4 in the mode used.
    pub head_length: f64,
    /// (crown - sole) / (crown - chin).
    pub heads: f64,
    /// By group name.
    pub shape: BTreeMap<String, GroupShape>,
    /// Joints used for the deformation, by role, model space.
    pub joints: BTreeMap<String, [f64; 3]>,
    /// The file's own joints, by role, model space.
    pub file_joints: BTreeMap<String, [f64; 3]>,
    /// Read from the geometry.
    pub landmarks: Heights,
    /// The face; absent where no chin is seen.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub face: Option<FaceReport>,
}

/// What was found of a face, in head lengths.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct FaceReport {
    /// How the eyes were found: `hints`, `pieces`, `blink`, `joints`, `twins` or `none`.
    pub source: &'static str,
    /// How sure that is, 0 to 1.
    pub confidence: f64,
    /// Height of the eyes above the chin.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub ye: Option<f64>,
    /// Half the distance between them.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub d: Option<f64>,
    /// Half the width of an opening.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub a: Option<f64>,
    /// Half its height.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub b: Option<f64>,
    /// The eyeballs' radius.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub radius: Option<f64>,
    /// Height of the nose's tip, and how far it stands out.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub nose: Option<[f64; 2]>,
    /// How far aside the head is where the ears begin, and how far they stick out.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub ears: Option<[f64; 2]>,
    /// Half the width of the face at the eyes.
    pub half_width: f64,
    /// Half the width of the skull.
    pub skull_half_width: f64,
    /// Where all that is: the eyes and the tip of the nose, model space.
    pub points: BTreeMap<&'static str, [f64; 3]>,
}

impl FaceReport {
    /// Of `face`, whose points `place` takes to model space.
    pub fn of(face: &FaceLandmarks, place: impl Fn(DVec3) -> DVec3) -> Self {
        let eyes = face.eyes.iter().flat_map(|(_, eyes)| ["left_eye", "right_eye"].into_iter().zip(eyes));
        let eyes = eyes.map(|(name, eye)| (name, eye.middle()));
        let points = eyes.chain(face.nose.map(|nose| ("nose", nose.tip)));
        let (source, confidence) =
            face.eyes.as_ref().map_or(("none", 0.0), |(source, _)| source.name_and_confidence());
        let pair = face.pair();
        Self {
            source,
            confidence,
            ye: pair.map(|pair| pair.height),
            d: pair.map(|pair| pair.half_distance),
            a: pair.map(|pair| pair.half_width),
            b: pair.map(|pair| pair.half_height),
            radius: face.eyes.as_ref().map(|(_, eyes)| 0.5 * (eyes[0].radius() + eyes[1].radius())),
            nose: face.nose.map(|nose| [nose.tip.y, nose.protrusion()]),
            ears: face.ears.map(|ears| [ears.root, ears.reach()]),
            half_width: face.half_width,
            skull_half_width: face.skull_half_width,
            points: points.map(|(name, p)| (name, place(p).to_array())).collect(),
        }
    }
}

/// How broad and deep the bodies are, in head lengths; what could not be measured is absent.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct ProfileReport {
    /// Before.
    pub target: Option<Profile>,
    /// What the style wants; that of a body of so many heads where it has none of its own.
    pub reference: Option<Profile>,
    /// Measured anew on what came out.
    pub result: Option<Profile>,
    /// The result's size over the reference's, the mean over its slices: torso, hips, legs, arms, hand, foot.
    pub ratios: BTreeMap<&'static str, f64>,
}

impl ProfileReport {
    /// The profiles of `target` and `result`, and what `style` wants of a body.
    pub fn of(target: &Measured, style: &Style, result: &Measured) -> Self {
        let wanted = wanted_of(style).map(|(wanted, _)| wanted);
        let (target, result) = (target.shape.profile.clone(), result.shape.profile.clone());
        let both = wanted.iter().zip(&result);
        let ratios = both.flat_map(|(wanted, result)| CHAINS.into_iter().zip(result.ratios(wanted)));
        let ratios = ratios.filter(|(_, ratio)| ratio.is_finite()).collect();
        Self { target, reference: wanted, result, ratios }
    }
}

impl FigureReport {
    /// What was measured, with the groups measured over `roles` alone.
    pub fn of(measured: &Measured, roles: &BTreeSet<Role>, options: &Options) -> Self {
        let heights = measured.anatomy.landmarks.heights;
        let frame = &measured.figure.frame;
        let joints = by_name(measured.joints.iter().map(|(&role, &p)| (role, frame.to_model(p).to_array())));
        Self {
            height: measured.figure.height(),
            head_length: match options.mode {
                Mode::Paper => measured.shape.head_length,
                Mode::Product => heights.head_length(),
            },
            heads: heights.heads(),
            shape: group_shapes(&measured.shape, roles, options),
            file_joints: joints.clone(),
            joints,
            landmarks: heights,
            face: measured.face.as_ref().map(|face| {
                let head = head_frame(&measured.anatomy);
                FaceReport::of(face, |p| frame.to_model(head.from_unit(p)))
            }),
        }
    }

    /// A style's numbers, where its model is not at hand.
    pub fn of_style(shape: &BodyShape, roles: &BTreeSet<Role>, options: &Options) -> Self {
        let heights = shape.landmarks.unwrap_or_default();
        let proportions = shape.proportions.clone().unwrap_or_default();
        Self {
            height: heights.crown - heights.sole,
            head_length: match options.mode {
                Mode::Paper => shape.head_length,
                Mode::Product => proportions.head_length,
            },
            heads: shape.heads().unwrap_or(f64::NAN),
            shape: group_shapes(shape, roles, options),
            landmarks: heights,
            ..Self::default()
        }
    }
}

/// Where the rig came from and how sure it is.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct RigReport {
    /// `kept` or `auto`.
    pub source: &'static str,
    /// By role; 1 for kept joints.
    pub confidence: BTreeMap<String, f64>,
    /// By role, for doubted joints with more than one place: at most four, the one that was taken first.
    pub candidates: BTreeMap<String, Vec<JointCandidate>>,
    /// Vertices left without weights: always 0.
    pub unreached_vertices: usize,
    /// Vertices weighted by another rule than heat or volume, by rule.
    pub fallback_vertices: BTreeMap<String, usize>,
}

/// A place where a joint may be.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct JointCandidate {
    /// It, model space.
    pub position: [f64; 3],
    /// How likely it is beside the one that was taken, 0..1.
    pub score: f64,
}

/// How far the lowest sole is above the floor in a walk that was made for ordinary legs, as a share of the figure's height; below
/// 0 it dips in. Absent where a leg is not complete.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct SoleClearance {
    /// Before.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub target: Option<f64>,
    /// After.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub result: Option<f64>,
}

/// How clothes were kept outside of the body.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct RepairReport {
    /// Vertices that were pushed.
    pub pushed: usize,
    /// How far at most, as a share of the result's height.
    pub furthest: f64,
    /// Of all places of the clothes, the share that is inside the body and was not before: at rest, in the widest stride of a
    /// walk, and sitting.
    pub newly_inside: NewlyInside,
}

/// See [`RepairReport`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
#[allow(missing_docs)]
pub struct NewlyInside {
    pub rest: f64,
    pub walk: f64,
    pub sit: f64,
}

/// How much of what.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
#[allow(missing_docs)]
pub struct Counts {
    pub vertices: usize,
    pub triangles: usize,
    pub meshes: usize,
    pub morph_targets: usize,
    pub joints: usize,
}

/// Milliseconds by stage; the host fills in `load`, `write` and `total`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
#[allow(missing_docs)]
pub struct Timing {
    pub load: f64,
    pub rig_joints: f64,
    pub rig_weights: f64,
    pub transfer: f64,
    pub measure: f64,
    pub deform: f64,
    pub face: f64,
    pub write: f64,
    pub total: f64,
}

/// A whole run.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Report {
    /// The target before.
    pub target: FigureReport,
    /// The reference, or the saved style's numbers; absent with a style for N heads.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub reference: Option<FigureReport>,
    /// Measured anew on what came out.
    pub result: FigureReport,
    /// `paper` or `product`.
    pub mode: &'static str,
    /// Eq. 9.
    pub g: f64,
    /// By group name.
    pub coefficients: BTreeMap<String, Coefficient>,
    /// The bodies slice by slice.
    pub profile: ProfileReport,
    /// The rig.
    pub rig: RigReport,
    /// The clothes; absent in paper mode and where nothing is known to be worn.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub repair: Option<RepairReport>,
    /// Soles and the floor in a walk.
    pub sole_clearance: SoleClearance,
    /// How far a vertex is at most from where it should be when two morph targets are on at once, as a share of the result's
    /// height: the field bends, and targets add up straight.
    pub morph_pair_error: f64,
    /// How much of what.
    pub counts: Counts,
    /// Milliseconds by stage.
    pub timing_ms: Timing,
    /// What a person should know.
    pub warnings: Vec<Warning>,
}
