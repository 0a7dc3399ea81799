//! What comes after the parts: the body that the style wants, slice by slice.

use super::field::PartField;
use super::groups::PartGroups;
use super::profile::{Profile, ProfileStage, Source, strengths, wanted_of};
use super::target::ProductTarget;
use crate::error::{Result, Warning};
use crate::options::{Options, Stage};
use crate::parallel;
use crate::progress::Progress;
use crate::shape::Measured;
use crate::shape::field::{Binding, BodyField, Field};
use crate::shape::placement::Placement;
use crate::shape::style::Style;
use glam::DVec3;
use std::sync::Arc;

/// The profile that `style` and `options` ask for, and how much of it; `None` where they ask for none.
///
/// `lost`: how much of the style the target takes.
pub fn profile_of(style: &Style, options: &Options, lost: f64) -> Option<(Profile, f64)> {
    let (wanted, share) = wanted_of(style)?;
    let share = share * lost * options.profile;
    (share > 0.0 && options.stage != Stage::Length).then_some((wanted, share))
}

/// A field with the profile that a style wants.
pub struct Sliced {
    /// The field.
    pub field: Field,
    /// Where it takes all vertices; `None` where it is the parts' own.
    pub placed: Option<Vec<DVec3>>,
    /// What soft limits took.
    pub limited: Option<Warning>,
}

impl Sliced {
    /// The parts' own field.
    pub fn unchanged(field: Field) -> Self {
        Self { field, placed: None, limited: None }
    }
}

/// `field`, the parts' own, and then so much of the profile that is wanted.
///
/// # Errors
/// `Cancelled`.
#[allow(clippy::too_many_arguments)]
pub fn with_profile(
    measured: &Measured,
    product: &ProductTarget,
    field: Field,
    (wanted, share): &(Profile, f64),
    options: &Options,
    groups: &PartGroups,
    progress: &mut Progress,
) -> Result<Sliced> {
    let BodyField::Parts(parts) = &*field.body else { return Ok(Sliced::unchanged(field)) };
    let positions =
        Placement::new(&measured.figure, &product.bindings, &field, options.thread_count).all_placed();
    progress.at(0.3)?;
    let source = Source {
        figure: &measured.figure,
        anatomy: &measured.anatomy,
        chains: &measured.chains,
        weld: &measured.weld,
        rest: measured.shape.profile.as_ref(),
        binding: &|vertex| product.bindings.vertices[vertex].parts(),
        threads: options.thread_count,
    };
    let strengths = |frame: &_| strengths(*share, options, groups, frame);
    let (stage, smooth) =
        ProfileStage::of(&source, parts, &positions, wanted, strengths, &mut progress.part(0.3, 0.8))?;
    progress.at(1.0)?;
    let limited = limited(&stage);
    let parts = PartField::clone(parts).with_profile(stage, &product.parts.pieces);
    let place = |vertex: usize| match &product.bindings.vertices[vertex] {
        Binding::Parts(binding) => {
            parts.place_smooth(measured.figure.positions[vertex], positions[vertex], smooth[vertex], binding)
        }
        _ => positions[vertex],
    };
    let placed = parallel::collect(options.thread_count, positions.len(), parallel::FEW, place);
    let field = Field::of(Arc::new(BodyField::Parts(Box::new(parts))));
    Ok(Sliced { field, placed: Some(placed), limited })
}

fn limited(stage: &ProfileStage) -> Option<Warning> {
    let items: Vec<String> =
        stage.limited().iter().map(|(what, wanted, got)| format!("{what} {wanted:.2} to {got:.2}")).collect();
    (!items.is_empty()).then(|| {
        let message = format!("limited slices that the style wants thicker or thinner: {}", items.join(", "));
        Warning::new("coefficient_limited", message).about("profile")
    })
}
