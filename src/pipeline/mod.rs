//! Puts the stages in order: [`stages`] lists them, [`memo`] knows which to do again when something changes.
//!
//! [`Deformer`] is the state: what is given, and the memo. [`apply`] and [`morphs`] write what came out; [`reporting`] measures it.
//! [`rigging`] puts IV-B in order.

mod apply;
mod displacement;
mod hair;
mod head_stages;
mod memo;
pub mod morphs;
pub mod places;
mod reporting;
mod result;
mod rig_weights;
pub mod rigging;
mod stages;

pub use result::{Deformed, DeformedMesh, MeshOutputs};
pub use rigging::Rig;

use crate::character::{Character, Humanoid};
use crate::error::{Result, Warning};
use crate::face::stage::FaceBinding;
use crate::geometry::Mapped;
use crate::options::{Mode, Options, Repair};
use crate::parallel;
use crate::progress::Progress;
use crate::report::{RigReport, Timing};
use crate::shape::Coefficient;
use crate::shape::field::Field;
use crate::shape::measured::Measured;
use crate::shape::placement::Placement;
use crate::shape::product::target::on_head;
use crate::shape::style::Style;
use displacement::Displacements;
use glam::DVec3;
use memo::{Inputs, Memo, Phase, View};
use stages::{Deformation, Number, STAGES};
use std::cell::RefCell;
use std::collections::BTreeMap;
use std::sync::Arc;

/// A character and a field made for it: made once, applied as often as something changes.
#[derive(Clone, Debug)]
pub struct Deformer {
    inputs: Inputs,
    memo: Memo,
    deformation: Arc<Deformation>,
    /// How far everything goes all the way.
    displacements: Arc<Displacements>,
    /// The deformation's field with what is done last.
    field: Field,
    warnings: Arc<Vec<Warning>>,
}

/// What of a deformer holds when its options change.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kept {
    /// Not even what was read of the target.
    Nothing,
    /// What was read of the target.
    Target,
    /// The body, too.
    Body,
    /// The field, too: what changes is done last, for all vertices alike.
    Field,
}

/// What there is to say of a rig that was made.
#[derive(Debug)]
pub struct AutoRig {
    warnings: Vec<Warning>,
    report: RigReport,
    /// Roles of the character's own joints, which ride along.
    own: Humanoid,
    own_count: usize,
    /// Milliseconds for joints, weights and clothes.
    times: [f64; 3],
}

impl Deformer {
    /// Measures the target and makes the field that gives it the style.
    ///
    /// # Errors
    /// What [`Character::validate`] and [`Figure::of`](crate::shape::figure::Figure::of) refuse; `BadOption` for options
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
        let (style, options) = (Arc::new(style.clone()), options.clone());
        Self::build(Inputs { character, rig: None, style, options }, Memo::default(), progress)
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
        let rig = Some(Arc::new(AutoRig {
            warnings: rig.warnings.clone(),
            report: rig.report(),
            own: character.humanoid.clone(),
            own_count: character.skeleton.joints.len(),
            times: rig.timing_ms,
        }));
        let (style, options) = (Arc::new(style.clone()), options.clone());
        Self::build(Inputs { character: rigged, rig, style, options }, Memo::default(), progress)
    }

    /// Makes all stages, but for what `memo` holds that is still the same with `inputs`; those that need nothing of each other
    /// side by side the first time.
    fn build(inputs: Inputs, memo: Memo, progress: &mut Progress) -> Result<Self> {
        inputs.options.validate()?;
        if let Style::Heads(heads) = *inputs.style {
            Style::heads(heads)?;
        }
        let mut reached = 0.0_f32;
        let mut never_back = |done: f32| {
            reached = reached.max(done);
            progress.at(reached).is_ok()
        };
        let progress = RefCell::new(Progress::new(&mut never_back));
        let view = View::of_all(&inputs, &memo, Some(&progress));
        progress.borrow_mut().at(0.0)?;
        let Options { mode, repair, thread_count, .. } = inputs.options;
        let is_first = memo.is_empty();
        view.measured()?;
        if is_first && mode == Mode::Product && parallel::thread_count(thread_count) > 1 {
            let beside = || View::of_all(&inputs, &memo, None);
            let worn = || repair != Repair::Off && beside().worn().is_ok();
            parallel::both(thread_count, worn, || view.parts()).1?;
            let hair_and_twins = || beside().strands().is_ok() && beside().mirror().is_ok();
            parallel::both(thread_count, hair_and_twins, || view.pushed()).1?;
        }
        let (deformation, displacements) = (view.deformation()?, view.displacements()?);
        let field = Field { finish: *view.finish()?, ..(*deformation.field).clone() };
        let warnings = view.warnings()?;
        progress.borrow_mut().at(1.0)?;
        Ok(Self { inputs, memo, deformation, displacements, field, warnings })
    }

    /// Changes the options, with the same result as a new deformer gives; only what depends on the change is done
    /// again. Where it fails the deformer is as it was.
    ///
    /// # Errors
    /// As [`Deformer::with_progress`].
    pub fn set_options(&mut self, options: &Options, progress: &mut Progress) -> Result<()> {
        self.change(Inputs { options: options.clone(), ..self.inputs.clone() }, progress)
    }

    /// What a change to these options keeps of what was made.
    pub fn kept_with(&self, options: &Options) -> Kept {
        let same = |stage: &memo::Stage| (stage.options)(&self.inputs.options) == (stage.options)(options);
        match STAGES.iter().position(|stage| !same(stage)) {
            Some(first) if first < Number::BODY => Kept::Nothing,
            Some(Number::BODY) => Kept::Target,
            Some(first) if first < Number::FINISH => Kept::Body,
            _ => Kept::Field,
        }
    }

    /// [`Deformer::set_style`] and [`Deformer::set_options`] at once: both are changed, or where it fails neither.
    ///
    /// # Errors
    /// As [`Deformer::with_progress`].
    pub fn set(&mut self, style: &Style, options: &Options, progress: &mut Progress) -> Result<()> {
        let (style, options) = (Arc::new(style.clone()), options.clone());
        self.change(Inputs { style, options, ..self.inputs.clone() }, progress)
    }

    /// Changes the style, with the same result as a new deformer gives; the target is not measured again. Where it fails
    /// the deformer is as it was.
    ///
    /// # Errors
    /// As [`Deformer::with_progress`].
    pub fn set_style(&mut self, style: &Style, progress: &mut Progress) -> Result<()> {
        self.change(Inputs { style: Arc::new(style.clone()), ..self.inputs.clone() }, progress)
    }

    fn change(&mut self, inputs: Inputs, progress: &mut Progress) -> Result<()> {
        *self = Self::build(inputs, self.memo.clone(), progress)?;
        Ok(())
    }

    /// The names of the stages that were done again since `before` was a copy of this.
    #[doc(hidden)]
    pub fn made_again_since(&self, before: &Self) -> Vec<&'static str> {
        self.memo.made_again_since(&before.memo)
    }

    fn view(&self) -> View<'_> {
        View::of_all(&self.inputs, &self.memo, None)
    }

    /// The target as it was measured.
    #[doc(hidden)]
    pub fn target(&self) -> &Measured {
        &self.deformation.measured
    }

    /// Where the target's points go.
    fn placement(&self) -> Placement<'_> {
        self.deformation.placement(&self.field, self.inputs.options.thread_count)
    }

    /// Where the field takes `point`, attached to `joint`; both in model space.
    pub fn map(&self, joint: usize, point: DVec3) -> Mapped {
        let Self { deformation, field, .. } = self;
        let frame = &deformation.measured.figure.frame;
        let p = frame.to_canonical(point);
        let on_head = match self.inputs.options.mode {
            Mode::Product => on_head(&deformation.measured, joint, p),
            Mode::Paper => None,
        };
        let binding = on_head.as_ref().unwrap_or(&deformation.body.bindings.joints[joint]);
        let Mapped { mut position, jacobian } = field.map(p, binding);
        position += self.joint_correction(joint);
        if let Some(hair) = &*deformation.hair {
            position += field.finish.share_of_offsets() * hair.offset(binding, joint, p);
        }
        Mapped { position: frame.to_model(position), jacobian: frame.jacobian_to_model(jacobian) }
    }

    /// Where a painted face changes: for each vertex of each mesh how much of what is painted there is shade of an eye's socket,
    /// which grew with the eye, and how much of it is the skin below, which that is evened to; 0 to 1 each, by as much as eyes
    /// grow. Empty where they do not: drawn eyes, no eyes, a youth of 0, paper mode.
    pub fn painted(&self) -> Vec<Vec<[f32; 2]>> {
        let (Deformation { measured, body, .. }, field) = (&*self.deformation, &self.field);
        let (Some(young), starts) = (&field.young, &measured.figure.mesh_starts) else { return Vec::new() };
        let share = (field.youth * field.finish.amount).clamp(0.0, 1.0);
        let weights = |vertex: usize| {
            let binding = &body.bindings.vertices[vertex];
            let at = field.squash(body.placed[vertex], binding);
            let face = binding.parts().map_or(FaceBinding::None, |parts| parts.face);
            young.painted(at, face).map(|weight| (share * weight) as f32)
        };
        starts.windows(2).map(|ends| (ends[0]..ends[1]).map(weights).collect()).collect()
    }

    /// The character that is deformed: with the rig in place, where one was made.
    pub fn character(&self) -> &Arc<Character> {
        &self.inputs.character
    }

    /// What is set.
    pub fn options(&self) -> &Options {
        &self.inputs.options
    }

    /// What the style is.
    pub fn style(&self) -> &Style {
        &self.inputs.style
    }

    /// alpha and beta by group.
    pub fn coefficients(&self) -> &BTreeMap<String, Coefficient> {
        &self.deformation.body.coefficients
    }

    /// What a person should know so far.
    pub fn warnings(&self) -> &[Warning] {
        &self.warnings
    }

    fn timing(&self) -> Timing {
        let [rig_joints, rig_weights, transfer] = self.inputs.rig.as_ref().map_or([0.0; 3], |rig| rig.times);
        Timing {
            rig_joints,
            rig_weights,
            transfer,
            measure: self.memo.milliseconds(|phase| phase == Phase::Measure),
            deform: self.memo.milliseconds(|phase| phase != Phase::Measure),
            face: self.memo.milliseconds(|phase| phase == Phase::Face),
            ..Timing::default()
        }
    }
}
