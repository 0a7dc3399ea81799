//! Puts the stages in order: what is known so far, what comes out, and what to redo when something changes.
//!
//! [`Deformer`] is the state. A mode ([`product`], [`paper`]) makes a [`Deformation`] of a measured target, a style and
//! options; amount, ground and face come last ([`finish`]); [`apply`] takes everything through the field; [`report`]
//! measures what came out. [`rigging`] puts IV-B in order.

mod apply;
mod attach;
mod displacement;
mod finish;
mod hair;
pub mod morphs;
mod paper;
pub mod places;
mod product;
mod product_target;
mod profile;
mod report;
mod result;
mod rig_weights;
pub mod rigging;
mod strands;
mod young;

pub use result::{Deformed, DeformedMesh, MeshOutputs};
pub use rigging::Rig;

use crate::character::{Character, Humanoid};
use crate::error::{Result, Warning};
use crate::face::FaceShape;
pub use crate::geometry::Mapped;
use crate::options::Repair;
pub use crate::options::{FaceCurve, GroupSettings, Mode, Options, Stage};
use crate::progress::Progress;
use crate::report::{RigReport, Timing};
use crate::shape::Coefficient;
use crate::shape::directions::RestTriangles;
use crate::shape::field::{BodyField, Field};
use crate::shape::figure::Figure;
use crate::shape::measured::Measured;
use crate::shape::product::repair::Pushed;
pub use crate::shape::style::Style;
use attach::{Bindings, Placement};
use displacement::Displacements;
use glam::DVec3;
use product_target::ProductTarget;
use std::collections::BTreeMap;
use std::sync::{Arc, OnceLock};
use std::time::Instant;

/// A target may be this many times as tall, in heads, as its style before it is called super-deformed already.
const ALREADY_SD: f64 = 1.2;

/// A character and a field made for it: made once, applied as often as something changes.
#[derive(Clone, Debug)]
pub struct Deformer {
    target: Target,
    rig: Option<AutoRig>,
    style: Style,
    options: Options,
    deformation: Deformation,
    /// The deformation's field with amount, ground and face as the options say.
    field: Field,
    /// Where the body's field takes the vertices, with the face of this shape.
    placed: Option<(FaceShape, Arc<Vec<DVec3>>)>,
    /// What the face step was last made of, and its ways.
    young: Option<young::Made>,
    /// The same of the options before, until it is made again.
    young_before: Option<young::Made>,
    /// How the head sits on it.
    sat: Option<young::Sat>,
    /// What hair does after the head's stages; without these the deformation's offsets are all.
    hair: Option<Arc<hair::Laid>>,
    /// That of the face as it was and of the youngest one.
    laid: Option<hair::Ends>,
    /// Where all of that takes the vertices; there once the options are done.
    displacements: Option<Displacements>,
    /// What morph targets add to that.
    morph_shifts: morphs::Shifts,
    warnings: Vec<Warning>,
    timing: Timing,
}

/// The character that is deformed, and what is found of it once.
#[derive(Clone, Debug)]
struct Target {
    character: Arc<Character>,
    measured: Arc<Measured>,
    /// Made when directions are first wanted.
    rest_triangles: OnceLock<Arc<RestTriangles>>,
    /// Found when morph targets are first wanted: by mesh.
    touched: OnceLock<Arc<Vec<morphs::Touched>>>,
}

/// What a mode makes of target, style and options, whatever amount and face are.
#[derive(Clone, Debug)]
struct Deformation {
    body: Arc<BodyField>,
    bindings: Bindings,
    /// Where the body takes the vertices without a younger face, canonical frame.
    placed: Arc<Vec<DVec3>>,
    /// What keeps clothes and locks of hair outside the body, added to each vertex at the end; empty where nothing does.
    hair_offsets: Vec<DVec3>,
    /// What keeps clothes outside of the body, a part of these.
    pushed: Pushed,
    /// What the whole shrinks by, so that nobody becomes taller (D31); at most 1.
    whole: f64,
    /// g of Eq. 9.
    head_ratio: f64,
    coefficients: BTreeMap<String, Coefficient>,
    warnings: Vec<Warning>,
    /// What is left of a head count that could not be reached.
    heads_left: Option<Warning>,
    /// What product mode found of the target, to be used again.
    product: Option<Arc<ProductTarget>>,
    /// The box of the face map, made when it is first wanted; none where there is no face.
    face_box: OnceLock<Option<(DVec3, DVec3)>>,
}

/// What is known from before, and need not be found again.
#[derive(Default)]
struct Known {
    product: Option<Arc<ProductTarget>>,
    pushed: Option<Pushed>,
    young: Option<young::Made>,
}

/// What the report says of a rig that was made.
#[derive(Clone, Debug)]
struct AutoRig {
    report: RigReport,
    warnings: Vec<Warning>,
    /// Roles of the character's own joints, which ride along.
    own: Humanoid,
    own_count: usize,
}

impl Deformer {
    /// Measures the target and makes the field that gives it the style.
    ///
    /// # Errors
    /// What [`Character::validate`] and [`Figure::of`] refuse; `BadOption` for options
    /// out of their range and for a style of N heads in paper mode; `BadStyle` for a style without what the mode transfers.
    pub fn new(character: Arc<Character>, style: &Style, options: &Options) -> Result<Self> {
        Self::with_progress(character, style, options, &mut Progress::none())
    }

    /// As [`Deformer::new`], and reports how far it is.
    ///
    /// # Errors
    /// As [`Deformer::new`]; `Cancelled`.
    pub fn with_progress(
        character: Arc<Character>,
        style: &Style,
        options: &Options,
        progress: &mut Progress,
    ) -> Result<Self> {
        Self::build(character, None, style, options, progress)
    }

    /// As [`Deformer::new`], by a rig that was made for `character`: its own joints, if any, ride along and come first in
    /// [`Deformed::joints`].
    ///
    /// # Errors
    /// As [`Deformer::new`].
    pub fn with_rig(character: &Character, rig: &Rig, style: &Style, options: &Options) -> Result<Self> {
        let rigged = Arc::new(rig.applied_to(character));
        Self::with_rigged(rigged, character, rig, style, options, &mut Progress::none())
    }

    /// As [`Deformer::with_rig`], with `rigged`, what [`Rig::applied_to`] gave for `character`.
    ///
    /// # Errors
    /// As [`Deformer::with_progress`].
    pub fn with_rigged(
        rigged: Arc<Character>,
        character: &Character,
        rig: &Rig,
        style: &Style,
        options: &Options,
        progress: &mut Progress,
    ) -> Result<Self> {
        let auto_rig = AutoRig {
            report: rig.report(),
            warnings: rig.warnings.clone(),
            own: character.humanoid.clone(),
            own_count: character.skeleton.joints.len(),
        };
        let mut deformer = Self::build(rigged, Some(auto_rig), style, options, progress)?;
        let [rig_joints, rig_weights, transfer] = rig.timing_ms;
        deformer.timing = Timing { rig_joints, rig_weights, transfer, ..deformer.timing };
        Ok(deformer)
    }

    fn build(
        character: Arc<Character>,
        rig: Option<AutoRig>,
        style: &Style,
        options: &Options,
        progress: &mut Progress,
    ) -> Result<Self> {
        options.validate()?;
        if let Style::Heads(heads) = style {
            Style::heads(*heads)?;
        }
        progress.at(0.0)?;
        let clock = Instant::now();
        let figure = Figure::of(&character)?;
        progress.at(0.05)?;
        let part = &mut progress.part(0.05, 0.25);
        let measured = Arc::new(Measured::of_figure(figure, &character, options, part)?);
        let timing = Timing { measure: milliseconds(clock), ..Timing::default() };
        progress.at(0.25)?;
        let target =
            Target { character, measured, rest_triangles: OnceLock::new(), touched: OnceLock::new() };
        let known = Known::default();
        Self::deform(target, rig, style.clone(), options.clone(), known, timing, &mut progress.part(0.3, 1.0))
    }

    /// Changes the options, with the same result as a deformer made anew; only what depends on the change is done
    /// again. Where it fails the deformer is as it was.
    ///
    /// # Errors
    /// As [`Deformer::with_progress`].
    pub fn set_options(&mut self, options: &Options, progress: &mut Progress) -> Result<()> {
        options.validate()?;
        progress.at(0.0)?;
        // The field of another amount, face, height or number of threads, as it is now.
        let same_shape = Options {
            amount: self.options.amount,
            face_squash: self.options.face_squash,
            face_curve: self.options.face_curve,
            youth: self.options.youth,
            features: self.options.features,
            smile: self.options.smile,
            seat: self.options.seat,
            hair_lay: self.options.hair_lay,
            height: self.options.height,
            repair: if options.repair == Repair::Kept { self.options.repair } else { options.repair },
            thread_count: self.options.thread_count,
            ..options.clone()
        };
        if same_shape == self.options {
            let same_amount = options.amount == self.options.amount;
            self.options = options.clone();
            let ground = same_amount.then_some(self.field.finish.ground);
            self.finish(ground, &mut Progress::none())?;
            return Ok(());
        }
        let (mut target, mut timing) = (self.target.clone(), self.timing);
        let measures_anew = options.ray_count() != self.options.ray_count()
            || options.bone_groups != self.options.bone_groups;
        if measures_anew {
            let clock = Instant::now();
            let figure = target.measured.figure.clone();
            let part = &mut progress.part(0.0, 0.4);
            target.measured = Arc::new(Measured::of_figure(figure, &target.character, options, part)?);
            timing.measure = milliseconds(clock);
        }
        let known = Known {
            product: self.deformation.product.clone().filter(|_| !measures_anew),
            pushed: (options.repair == Repair::Kept).then(|| self.deformation.pushed.clone()),
            young: self.young.clone().or_else(|| self.young_before.clone()).filter(|_| !measures_anew),
        };
        let (rig, style) = (self.rig.clone(), self.style.clone());
        let progress = &mut progress.part(0.4, 1.0);
        *self = Self::deform(target, rig, style, options.clone(), known, timing, progress)?;
        Ok(())
    }

    /// Everything that follows from the measured target, the style and the options.
    fn deform(
        target: Target,
        rig: Option<AutoRig>,
        style: Style,
        options: Options,
        mut known: Known,
        timing: Timing,
        progress: &mut Progress,
    ) -> Result<Self> {
        let young_before = known.young.take();
        progress.at(0.0)?;
        let clock = Instant::now();
        let mut deformation = match options.mode {
            Mode::Product => product::deform(&target, known, &style, &options, &mut progress.part(0.0, 0.8))?,
            Mode::Paper => paper::deform(&target, &style, &options)?,
        };
        let mut warnings = rig.as_ref().map(|rig| rig.warnings.clone()).unwrap_or_default();
        warnings.extend(target.measured.anatomy.landmarks.warnings("target"));
        warnings.extend(report::already_super_deformed(&target.measured.shape, &style));
        warnings.append(&mut deformation.warnings);
        deformation.warnings = warnings;
        let field = Field::of(Arc::clone(&deformation.body));
        let mut deformer = Self {
            target,
            rig,
            style,
            options,
            deformation,
            field,
            young: None,
            young_before,
            sat: None,
            hair: None,
            laid: None,
            displacements: None,
            morph_shifts: morphs::Shifts::default(),
            placed: None,
            warnings: Vec::new(),
            timing,
        };
        progress.at(0.8)?;
        deformer.finish(None, &mut progress.part(0.8, 1.0))?;
        deformer.timing.deform = milliseconds(clock);
        progress.at(1.0)?;
        Ok(deformer)
    }

    /// Where the target's points go.
    fn placement(&self) -> Placement<'_> {
        Placement {
            figure: &self.target.measured.figure,
            bindings: &self.deformation.bindings,
            field: &self.field,
            hair_offsets: self.hair.as_ref().map_or(&self.deformation.hair_offsets, |hair| &hair.offsets),
            joint_offsets: self.hair.as_ref().map_or(&[], |hair| &hair.joint_offsets),
            placed: self
                .placed
                .as_ref()
                .filter(|(face, _)| *face == self.field.finish.face)
                .map(|(_, placed)| &placed[..]),
            ways: self.young.as_ref().and_then(|young| young.ways_after(self.field.finish.face)),
            threads: self.options.thread_count,
        }
    }

    /// Where the field takes `point`, attached to `joint`; both in model space.
    pub fn map(&self, joint: usize, point: DVec3) -> Mapped {
        let measured = &self.target.measured;
        let frame = &measured.figure.frame;
        let p = frame.to_canonical(point);
        let on_head = match self.options.mode {
            Mode::Product => product_target::on_head(measured, joint, p),
            Mode::Paper => None,
        };
        let binding = on_head.as_ref().unwrap_or(&self.deformation.bindings.joints[joint]);
        let Mapped { mut position, jacobian } = self.field.map(p, binding);
        if let (Some(hair), Some(product)) = (&self.hair, &self.deformation.product) {
            let offset = hair.offset(product, &self.target, binding, joint, p);
            position += self.field.finish.share_of_offsets() * offset;
        }
        Mapped { position: frame.to_model(position), jacobian: frame.jacobian_to_model(jacobian) }
    }

    /// The character that is deformed: with the rig in place, where one was made.
    pub fn character(&self) -> &Arc<Character> {
        &self.target.character
    }

    /// What is set.
    pub fn options(&self) -> &Options {
        &self.options
    }

    /// What the style is.
    pub fn style(&self) -> &Style {
        &self.style
    }

    /// alpha and beta by group.
    pub fn coefficients(&self) -> &BTreeMap<String, Coefficient> {
        &self.deformation.coefficients
    }

    /// The target as it was measured.
    #[doc(hidden)]
    pub fn target(&self) -> &Measured {
        &self.target.measured
    }

    /// What a person should know so far.
    pub fn warnings(&self) -> &[Warning] {
        &self.warnings
    }
}

fn milliseconds(since: Instant) -> f64 {
    since.elapsed().as_secs_f64() * 1e3
}
