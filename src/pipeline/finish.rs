//! Amount, ground, face and height: what is done last, in this order, and anew for every change of these alone.

use super::attach::{Placement, renewed};
use super::{Deformer, milliseconds, product};
use crate::character::{MeshKind, Role};
use crate::error::Result;
use crate::face::FaceShape;
use crate::geometry::bounds;
use crate::geometry::range;
use crate::options::{Height, Mode, Stage};
use crate::progress::Progress;
use crate::shape::field::{BodyField, Finish};
use crate::shape::measured::is_of_head;
use glam::DVec3;
use std::sync::Arc;
use std::time::Instant;

impl Deformer {
    /// Makes the field of the amount and the face that the options ask for, and the warnings with it.
    ///
    /// `ground`: the shift that puts the feet on the ground, where it is known already.
    ///
    /// # Errors
    /// `Cancelled`, with some of it done.
    pub(super) fn finish(&mut self, ground: Option<f64>, progress: &mut Progress) -> Result<()> {
        let amount = self.options.amount;
        self.warnings.clone_from(&self.deformation.warnings);
        if amount == 1.0 {
            self.warnings.extend(self.deformation.heads_left.clone());
        }
        let hips = self.target.measured.figure.role_position(Role::Hips).unwrap_or_default();
        let about = hips.with_y(self.deformation.bindings.ground.height);
        let finish = Finish { whole: self.deformation.whole, amount, about, ..Finish::default() };
        let ground = ground.unwrap_or_else(|| self.ground_shift(finish));
        self.field.finish = Finish { ground, ..finish };
        progress.at(0.1)?;
        self.finish_face();
        self.finish_placed();
        progress.at(0.2)?;
        self.finish_youth();
        progress.at(0.5)?;
        self.finish_seat();
        progress.at(0.7)?;
        self.finish_hair(&mut progress.part(0.7, 0.8))?;
        progress.at(0.8)?;
        self.finish_displacements();
        progress.at(0.9)?;
        self.finish_height();
        Ok(())
    }

    /// Feet stand where they stood: the lowest vertex that touches the ground keeps its height.
    fn ground_shift(&self, finish: Finish) -> f64 {
        let field = self.field.with(finish);
        let ground = &self.deformation.bindings.ground;
        let placed = Some(&self.deformation.placed[..]);
        let placement = Placement { field: &field, placed, ways: None, ..self.placement() };
        let after = placement.vertices(&ground.vertices);
        let lowest = after.iter().map(|p| p.y).min_by(f64::total_cmp);
        lowest.map_or(0.0, |lowest| ground.height - lowest)
    }

    /// Makes the face younger. A squash that would fold it is bounded, with the warning `face_squash_clamped`.
    fn finish_face(&mut self) {
        let clock = Instant::now();
        let squash = self.face_squash();
        if self.options.stage < Stage::Face || squash == 0.0 {
            return;
        }
        let Some((low, high)) = *self.deformation.face_box.get_or_init(|| self.face_box()) else {
            return;
        };
        let (face, warning) = FaceShape::in_box(low, high, self.options.face_curve, squash);
        self.warnings.extend(warning);
        self.field.finish.face = face;
        self.timing.face = milliseconds(clock);
    }

    /// Asks the body's field where it takes the vertices that the face moves.
    fn finish_placed(&mut self) {
        let squash = self.field.finish.face;
        if self.placed.as_ref().is_some_and(|(face, _)| *face == squash) {
            return;
        }
        let mut placed = Arc::clone(&self.deformation.placed);
        if squash != FaceShape::None {
            let Placement { figure, bindings, threads, .. } = self.placement();
            placed = renewed(threads, placed, &bindings.of_head, |vertex| {
                self.field.place_body(figure.positions[vertex], &bindings.vertices[vertex])
            });
        }
        self.placed = Some((squash, placed));
    }

    /// Makes everything as tall as the options say, about the ground below the hips.
    fn finish_height(&mut self) {
        let figure = &self.target.measured.figure;
        let height = match self.options.height {
            Height::Style => return,
            Height::Keep => figure.height(),
            Height::Units(units) => units,
        };
        let up = figure.frame.to_model(DVec3::Y);
        let (low, high) = range(self.deformed_positions().map(|p| p.as_dvec3().dot(up)));
        if low < high {
            self.field.finish.size = height / (high - low);
        }
    }

    /// gamma as set, else the mode's own.
    fn face_squash(&self) -> f64 {
        let by_mode = match self.options.mode {
            Mode::Product => product::face_squash(&self.target.measured),
            Mode::Paper => 0.0,
        };
        self.options.face_squash.unwrap_or(by_mode)
    }

    /// The box of the face map: around what the head moves, in body or face meshes, as the whole field leaves it; the
    /// mode may know its height.
    fn face_box(&self) -> Option<(DVec3, DVec3)> {
        let figure = &self.target.measured.figure;
        let whole = self.field.with(Finish::default());
        let placed = Some(&self.deformation.placed[..]);
        let placement = Placement { field: &whole, placed, ways: None, ..self.placement() };
        let is_of_face = |&vertex: &usize| {
            let kind = figure.kind(vertex);
            (kind == MeshKind::Body || kind.is_of_face()) && is_of_head(figure, vertex)
        };
        let vertices = (0..figure.positions.len()).filter(is_of_face);
        let (low, high) = bounds(vertices.map(|vertex| placement.vertex(vertex)));
        let around = (low.x <= high.x).then_some((low, high));
        match &*self.deformation.body {
            BodyField::Parts(field) => Some(product::face_box(field, around)),
            BodyField::Bones(_) => around,
        }
    }
}
