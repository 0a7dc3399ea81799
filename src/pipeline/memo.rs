//! What each stage made last and what it looked at: the one place that decides what is done again.
//!
//! A [`Stage`] is a row of the list in [`stages`](super::stages): a function of what its [`View`] shows it. That is the
//! character, the style, stages above it, and the options that its row names; all others have their defaults in what it sees.
//! The memo keeps what a stage made beside what it looked at, and gives it back as long as that is the same. So an option
//! cannot be forgotten: what does not name it cannot read it, and what names it is made again when it changes.

use super::AutoRig;
use super::stages::STAGES;
use crate::character::Character;
use crate::clock::Moment;
use crate::error::{Result, Warning};
use crate::options::Options;
use crate::parallel::lock;
use crate::progress::Progress;
use crate::shape::style::Style;
use std::any::Any;
use std::cell::RefCell;
use std::fmt;
use std::sync::{Arc, Mutex};

/// What a stage makes.
pub type Value = Arc<dyn Any + Send + Sync>;

/// The time of the report that a stage counts to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Phase {
    /// Reading the target.
    Measure,
    /// Making its field.
    Deform,
    /// The younger face, which is a part of that.
    Face,
}

/// A row of the list of stages.
pub struct Stage {
    /// What it is called.
    pub name: &'static str,
    /// What its time counts to.
    pub phase: Phase,
    /// Its part of the work of a new deformer, of [`ALL_WORK`].
    pub work: u32,
    /// The options that it reads; the others at their defaults.
    pub options: fn(&Options) -> Options,
    /// Makes it.
    pub make: fn(&View) -> Result<Value>,
}

/// The work of all stages together.
pub const ALL_WORK: u32 = 100;

/// What is given: everything else follows from it.
#[derive(Clone, Debug)]
pub struct Inputs {
    /// The character that is deformed.
    pub character: Arc<Character>,
    /// The rig that was made for it, where one was.
    pub rig: Option<Arc<AutoRig>>,
    /// What it becomes like.
    pub style: Arc<Style>,
    /// What is set.
    pub options: Options,
}

/// A value, and what the stage looked at that made it.
struct Made {
    value: Value,
    options: Options,
    looked_at: Looks,
    milliseconds: f64,
}

#[derive(Default)]
struct Slot {
    made: Option<Arc<Made>>,
    /// True where it was found to hold for what is given.
    holds: bool,
}

/// What all stages made last.
pub struct Memo {
    slots: Vec<Mutex<Slot>>,
}

impl Default for Memo {
    fn default() -> Self {
        Self { slots: STAGES.iter().map(|_| Mutex::default()).collect() }
    }
}

impl Clone for Memo {
    /// Of a copy every value is looked at again before it is given back: something else may be given.
    fn clone(&self) -> Self {
        let copy = |slot: &Mutex<Slot>| Mutex::new(Slot { made: lock(slot).made.clone(), holds: false });
        Self { slots: self.slots.iter().map(copy).collect() }
    }
}

impl fmt::Debug for Memo {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_set().entries(self.made().map(|(stage, _)| stage.name)).finish()
    }
}

impl Memo {
    /// The stages that were made, and what they made last.
    fn made(&self) -> impl Iterator<Item = (&'static Stage, Arc<Made>)> {
        let slots = STAGES.iter().zip(&self.slots);
        slots.filter_map(|(stage, slot)| Some((stage, lock(slot).made.clone()?)))
    }

    /// True where nothing was made yet.
    pub fn is_empty(&self) -> bool {
        self.made().next().is_none()
    }

    /// Milliseconds that what is kept of a phase took.
    pub fn milliseconds(&self, is_of: impl Fn(Phase) -> bool) -> f64 {
        self.made().filter(|(stage, _)| is_of(stage.phase)).map(|(_, made)| made.milliseconds).sum()
    }

    /// The names of the stages that had been made, and were made again since `before` was a copy of this.
    pub fn made_again_since(&self, before: &Self) -> Vec<&'static str> {
        let is_kept = |made: &Arc<Made>| self.made().any(|(_, now)| Arc::ptr_eq(&now, made));
        before.made().filter(|(_, made)| !is_kept(made)).map(|(stage, _)| stage.name).collect()
    }
}

/// What a stage is shown.
pub struct View<'a> {
    inputs: &'a Inputs,
    memo: &'a Memo,
    progress: Option<&'a RefCell<Progress<'a>>>,
    stage: usize,
    /// The options that it reads; the others have their defaults. How many threads there are is told to all: it changes no
    /// result.
    pub options: Options,
    /// What was made last; nothing but time and [`Repair::Kept`](crate::options::Repair::Kept) may depend on it.
    before: Option<Value>,
    looked_at: RefCell<Looks>,
}

/// What a stage looked at beside its options.
#[derive(Default)]
struct Looks {
    style: Option<Arc<Style>>,
    stages: Vec<(usize, Value)>,
    /// Milliseconds that stages above took meanwhile.
    waited: f64,
}

impl<'a> View<'a> {
    /// For who is no stage: sees all options, and may ask for every stage.
    pub fn of_all(inputs: &'a Inputs, memo: &'a Memo, progress: Option<&'a RefCell<Progress<'a>>>) -> Self {
        let options = inputs.options.clone();
        let looked_at = RefCell::default();
        Self { inputs, memo, progress, stage: STAGES.len(), options, before: None, looked_at }
    }

    /// The character that is deformed.
    pub fn character(&self) -> &'a Character {
        &self.inputs.character
    }

    /// What there is to say of the rig that was made for it.
    pub fn notes(&self) -> impl Iterator<Item = &'a Warning> {
        self.inputs.rig.iter().flat_map(|rig| &rig.warnings)
    }

    /// What the character becomes like.
    pub fn style(&self) -> &'a Style {
        self.looked_at.borrow_mut().style = Some(Arc::clone(&self.inputs.style));
        &self.inputs.style
    }

    /// Threads to use, 0 for all cores.
    pub fn threads(&self) -> usize {
        self.options.thread_count
    }

    /// What this stage made last.
    pub fn before<T: Send + Sync + 'static>(&self) -> Option<Arc<T>> {
        self.before.clone()?.downcast().ok()
    }

    /// Does a part of the stage's work, which takes it from `from` to `to` of it, and reports how far it is.
    ///
    /// # Errors
    /// As `work`; `Cancelled`.
    pub fn part<T>(&self, from: f32, to: f32, work: impl FnOnce(&mut Progress) -> Result<T>) -> Result<T> {
        let Some(progress) = self.progress else { return work(&mut Progress::none()) };
        let done: u32 = STAGES[..self.stage].iter().map(|stage| stage.work).sum();
        let own = STAGES.get(self.stage).map_or(0, |stage| stage.work);
        let at = |share: f32| (done as f32 + share * own as f32) / ALL_WORK as f32;
        let mut progress = progress.borrow_mut();
        let mut part = progress.part(at(from), at(to));
        let made = work(&mut part)?;
        part.at(1.0)?;
        Ok(made)
    }

    /// What a stage of the list makes: as it was kept, or new.
    ///
    /// # Errors
    /// As the stage.
    pub fn stage<T: Send + Sync + 'static>(&self, stage: usize) -> Result<Arc<T>> {
        assert!(stage < self.stage, "a stage reads those above it: {}", STAGES[stage].name);
        let clock = Moment::now();
        let value = self.value(stage)?;
        if self.stage < STAGES.len() {
            let mut looked_at = self.looked_at.borrow_mut();
            looked_at.stages.push((stage, Arc::clone(&value)));
            looked_at.waited += clock.milliseconds();
        }
        Ok(value.downcast().expect("the list gives each stage its type"))
    }

    fn value(&self, stage: usize) -> Result<Value> {
        let mut slot = lock(&self.memo.slots[stage]);
        if let Some(made) = &slot.made
            && (slot.holds || self.holds(made, stage)?)
        {
            let value = Arc::clone(&made.value);
            slot.holds = true;
            return Ok(value);
        }
        let before = slot.made.as_ref().map(|made| Arc::clone(&made.value));
        let options = (STAGES[stage].options)(&self.inputs.options);
        let shown = Options { thread_count: self.inputs.options.thread_count, ..options.clone() };
        let view = View { stage, options: shown, before, looked_at: RefCell::default(), ..*self };
        let clock = Moment::now();
        let value = (STAGES[stage].make)(&view)?;
        view.part(1.0, 1.0, |_| Ok(()))?;
        let looked_at = view.looked_at.into_inner();
        let milliseconds = clock.milliseconds() - looked_at.waited;
        let made = Made { value: Arc::clone(&value), options, looked_at, milliseconds };
        *slot = Slot { made: Some(Arc::new(made)), holds: true };
        Ok(value)
    }

    /// True where the stage is made, and holds; what it looked at is made where it must be.
    pub fn is_made(&self, stage: usize) -> bool {
        let made = lock(&self.memo.slots[stage]).made.clone();
        made.is_some_and(|made| self.holds(&made, stage).unwrap_or(false))
    }

    /// True where all that it looked at is the same; what that is, is made where it must be.
    fn holds(&self, made: &Made, stage: usize) -> Result<bool> {
        let Looks { style, stages, .. } = &made.looked_at;
        if made.options != (STAGES[stage].options)(&self.inputs.options)
            || style.as_ref().is_some_and(|style| *style != self.inputs.style)
        {
            return Ok(false);
        }
        for (stage, value) in stages {
            if !Arc::ptr_eq(&self.value(*stage)?, value) {
                return Ok(false);
            }
        }
        Ok(true)
    }
}
