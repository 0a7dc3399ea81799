//! The face step beyond Eqs. 12 and 13: made of the target's face as they leave it, and kept while only youth changes.

use super::attach::Placement;
use super::{Deformer, milliseconds};
use crate::error::Warning;
use crate::face::FaceShape;
use crate::face::flow::Flow;
use crate::face::head::HeadFrame;
use crate::face::seat::{Seat, SeatAmount};
use crate::face::stage::{FaceBinding, Ways, YoungFace};
use crate::face::youth::{FaceAim, adultness};
use crate::options::{Features, Stage};
use crate::shape::field::{Binding, BodyField, Field, Finish};
use crate::shape::product::anatomy::Proportions;
use crate::shape::product::binding::PartBinding;
use crate::shape::product::field::PartField;
use crate::shape::product::head::head_frame;
use crate::shape::product::part::Part;
use crate::shape::style::Style;
use glam::DVec3;
use std::sync::Arc;
use std::time::Instant;

/// A face step, and what it was made of.
#[derive(Clone, Debug)]
pub struct Made {
    /// Eqs. 12 and 13 come before it.
    squash: FaceShape,
    features: Features,
    smile: f64,
    /// q: how adult the face was.
    adultness: f64,
    pub young: Arc<YoungFace>,
    /// The vertices' ways through it.
    pub ways: Arc<Ways>,
}

impl Made {
    /// The vertices' ways, where these begin with a face of this shape.
    pub fn ways_after(&self, squash: FaceShape) -> Option<&Ways> {
        (self.squash == squash).then_some(&*self.ways)
    }
}

/// A seat, and what it was measured on.
#[derive(Clone, Debug)]
pub struct Sat {
    squash: FaceShape,
    young: Option<Arc<YoungFace>>,
    seat: Option<Arc<Seat>>,
}

/// True where both are the same object, or none.
pub fn is_one<T>(a: &Option<Arc<T>>, b: &Option<Arc<T>>) -> bool {
    match (a, b) {
        (Some(a), Some(b)) => Arc::ptr_eq(a, b),
        (None, None) => true,
        _ => false,
    }
}

/// Steps of a head length that a face's landmarks are rounded to, after the stages before: 1e-9.
const LANDMARK_STEPS: f64 = (1u64 << 30) as f64;

/// All of the head's stages are done where a figure had this much more heads than it gets.
const HEADS_LOST: f64 = 0.2;

impl Deformer {
    /// Makes the face as young as the options ask for.
    pub(super) fn finish_youth(&mut self) {
        let (options, squash) = (&self.options, self.field.finish.face);
        self.field.young = None;
        let share = self.head_growth();
        if share == 0.0 || options.stage < Stage::Face || (options.youth == 0.0 && options.seat == 0.0) {
            return;
        }
        self.warnings.extend(self.eyes_not_found());
        let clock = Instant::now();
        let is_same = |made: &Made| {
            made.squash == squash && made.features == options.features && made.smile == options.smile
        };
        if !self.young.as_ref().is_some_and(is_same) {
            let known = self.young.take().or_else(|| self.young_before.take());
            self.young = self.make_young(squash, known);
        }
        self.field.youth = share * self.options.youth;
        if self.field.youth > 0.0 {
            self.field.young = self.young.as_ref().map(|made| Arc::clone(&made.young));
        }
        self.timing.face += milliseconds(clock);
    }

    /// A warning where a face is there, and no eyes are known that could grow.
    fn eyes_not_found(&self) -> Option<Warning> {
        let measured = &self.target.measured;
        let face = measured.face.as_ref()?;
        let are_wanted = self.options.youth * self.options.features.eye > 0.0;
        if !are_wanted || face.eyes.is_some() {
            return None;
        }
        let message = if self.target.character.face_hints.is_empty() {
            "no eyes were found on the face, so they keep their size: say where they are, or that their meshes are eyes"
        } else {
            "no eyes are where they are said to be, so they keep their size: give places on the face, left and right of its middle"
        };
        Some(Warning::new("face_eyes_not_found", message).about("eyes"))
    }

    /// Puts the head over the chest as far as the options ask for.
    pub(super) fn finish_seat(&mut self) {
        self.field.seat = None;
        let options = &self.options;
        let (Some(product), BodyField::Parts(body)) = (&self.deformation.product, &*self.deformation.body)
        else {
            return;
        };
        let share = self.head_growth();
        if options.stage < Stage::Face || options.seat * share == 0.0 {
            return;
        }
        let amount = SeatAmount { back: share * options.seat, nape: share * options.seat * options.youth };
        let young = self.young.as_ref().map(|made| Arc::clone(&made.young));
        let squash = self.field.finish.face;
        if let Some(sat) = self.sat.as_ref().filter(|sat| sat.squash == squash && is_one(&sat.young, &young))
        {
            self.field.seat.clone_from(&sat.seat);
            self.field.seat_amount = amount;
            return;
        }
        let measured = &self.target.measured;
        let sources = product.seat_sources(measured);
        // Before amount and ground, as the seat comes before these; of the youngest face, whose nape fills most.
        let field = Field {
            finish: Finish { face: squash, ..Finish::default() },
            youth: share,
            young: young.clone(),
            ..self.field.clone()
        };
        let placement =
            Placement { field: &field, hair_offsets: &[], joint_offsets: &[], ..self.placement() };
        let points = placement.vertices(&sources.vertices);
        let on_head = Binding::Parts(PartBinding::to(Part::Head));
        let heights = body.after();
        let frame = self.head_after(body, &field);
        let joint = field.place(measured.anatomy.head_joint, &on_head);
        let fill = self.young.as_ref().map_or(0.0, |made| made.adultness);
        let seat = Seat::new(sources, &points, frame, heights.shoulder_line, joint, fill).map(Arc::new);
        self.field.seat.clone_from(&seat);
        self.field.seat_amount = amount;
        self.sat = Some(Sat { squash, young, seat });
    }

    /// How much of the head's own stages is done, 0 where the figure keeps its number of heads, which leaves a character made
    /// like itself as it is, to 1.
    pub(super) fn head_growth(&self) -> f64 {
        let BodyField::Parts(body) = &*self.deformation.body else { return 0.0 };
        let before = self.target.measured.anatomy.landmarks.heights.heads();
        ((before / body.after().heads() - 1.0) / HEADS_LOST).clamp(0.0, 1.0)
    }

    /// Where `body` puts the head, whatever comes after it in `field`.
    pub(super) fn head_after(&self, body: &PartField, field: &Field) -> HeadFrame {
        let chin = head_frame(&self.target.measured.anatomy).origin;
        let field = field.with(field.finish);
        let origin = field.place(chin, &Binding::Parts(PartBinding::to(Part::Head)));
        HeadFrame { origin, length: body.after().head_length() }
    }

    fn make_young(&self, squash: FaceShape, known: Option<Made>) -> Option<Made> {
        let measured = &self.target.measured;
        let face = measured.face.as_ref()?;
        let BodyField::Parts(body) = &*self.deformation.body else { return None };
        let field = self.field.with(Finish { face: squash, ..Finish::default() });
        let on_head = Binding::Parts(PartBinding::to(Part::Head));
        let before = head_frame(&measured.anatomy);
        let heights = body.after();
        let frame = self.head_after(body, &field);
        // A head that is only moved or made larger has the same face, to the bit.
        let rounded = |p: DVec3| (p * LANDMARK_STEPS).round() / LANDMARK_STEPS;
        let face = face.mapped(|p| rounded(frame.to_unit(field.place(before.from_unit(p), &on_head))));
        let (eyes, head) = match &self.style {
            Style::Shape(shape) => (
                shape.face.map(|face| (face.eye_size, face.eye_height)),
                shape.proportions.as_ref().map(Proportions::head_width),
            ),
            Style::Heads(_) => (None, None),
        };
        let aim = FaceAim::new(heights.heads(), eyes, head);
        let flow = Flow::new(&face, &aim, &self.options.features, self.options.smile);
        if flow.is_identity() {
            return None;
        }
        let (young, ways) = self.ways(&field, frame, flow, known.as_ref());
        let (features, smile) = (self.options.features, self.options.smile);
        Some(Made {
            squash,
            features,
            smile,
            adultness: adultness(&face, &aim),
            young: Arc::new(young),
            ways: Arc::new(ways),
        })
    }

    /// The step that moves the head by `flow` after `field`, and what it does to the vertices.
    ///
    /// `known`: what was made before, of which what is the same is taken.
    fn ways(&self, field: &Field, frame: HeadFrame, flow: Flow, known: Option<&Made>) -> (YoungFace, Ways) {
        let placement =
            Placement { field, ways: None, hair_offsets: &[], joint_offsets: &[], ..self.placement() };
        let things: Vec<Vec<DVec3>> = match &self.deformation.product {
            Some(product) => product.things().iter().map(|vertices| placement.vertices(vertices)).collect(),
            None => Vec::new(),
        };
        let young = YoungFace::new(frame, flow, &things, known.map(|known| &*known.young));
        let known = known.map(|known| (&*known.young, &*known.ways));
        let binding = |binding: &Binding| match binding {
            Binding::Parts(binding) => binding.face,
            _ => FaceBinding::None,
        };
        let bindings: Vec<FaceBinding> = self.deformation.bindings.vertices.iter().map(binding).collect();
        let ways = match &self.placed {
            Some((_, placed)) => young.ways(placed, &bindings, known, self.options.thread_count),
            None => young.ways(&placement.all_placed(), &bindings, known, self.options.thread_count),
        };
        (young, ways)
    }
}
