//! The body of product mode: coefficients, corrected once where the number of heads is not right.

use super::anatomy::Proportions;
use super::binding::PartBindings;
use super::coefficients::{Goal, Limits, lost, part_coefficients};
use super::landmarks::{HeadPlacement, HeadSources};
use super::part_settings::PartGroups;
use super::parts_field::PartField;
use super::profile::{Profile, Slices, profile_of, strengths};
use super::scales::PartCoefficients;
use super::target::ProductTarget;
use crate::error::{Error, ErrorKind, Named, Result, Warning};
use crate::options::Options;
use crate::progress::Progress;
use crate::shape::field::{BodyField, Field};
use crate::shape::placement::{Body, Placement};
use crate::shape::style::Style;
use crate::shape::{BodyShape, Measured};
use std::sync::Arc;

/// A head count as near as this to the one asked for needs no correction. D27. Seen: ±30 % moves vertices by up to .004
/// H.
const HEADS_TOLERANCE: f64 = 5e-3;
/// The correction changes what is asked for below the head by no more than these factors. D27. Seen: tighter ones reach
/// fewer head counts.
const HEADS_CORRECTION: (f64, f64) = (0.8, 1.25);
/// A warning tells of what is left after that above this: a hundredth of a head count is not seen.
const HEADS_WARNED_ABOVE: f64 = 0.01;
/// A warning tells of hair that reaches further below the chin than this, in heads.
const HAIR_WARNED_ABOVE: f64 = 0.1;

/// The product's way to give a target the style.
///
/// - `heads`: what its head count is read from.
/// - `known`: what this gave before, of which that is taken that is the same.
///
/// # Errors
/// `BadStyle` for a style without proportions; as [`part_coefficients`]; `Cancelled`.
pub fn body(
    measured: &Measured,
    product: &ProductTarget,
    heads: &HeadSources,
    style: &Style,
    options: &Options,
    known: Option<&Body>,
    progress: &mut Progress,
) -> Result<Body> {
    let known = known.filter(|known| Arc::ptr_eq(&known.bindings, &product.bindings));
    let anatomy = &measured.anatomy;
    let head_length = anatomy.proportions.head_length;
    let (wanted, head_ratio) = match style {
        Style::Heads(heads) => (*heads, 1.0),
        Style::Shape(shape) => {
            let proportions = proportions_of(shape)?;
            (proportions.heads(), options.head_scale * head_length / proportions.head_length)
        }
    };
    let roles = measured.joints.keys().copied().collect();
    let (groups, split) = PartGroups::of(&roles, &options.bone_groups);
    let mut warnings = anatomy.warnings();
    warnings.extend(split);
    warnings.extend(hair_shortened(&product.parts, head_length));
    // Nobody gets more heads than there are, and what has as few keeps its proportions.
    let own = anatomy.proportions.heads();
    let limbs = (options.limits && anatomy.landmarks.trunk.is_some()).then(|| limbs_of(style)).flatten();
    let (asked, lost) = match limbs {
        _ if !options.limits => (wanted, 1.0),
        Some(_) => (wanted, 0.0),
        None => (wanted.min(own), lost(own, wanted)),
    };
    let is_itself = matches!(style, Style::Shape(shape) if shape.proportions == measured.shape.proportions);
    if limbs.is_some() {
        let message = "the target has neither neck nor chin: head and trunk stay as they are, and only limbs become shorter";
        warnings.push(Warning::new("trunk_kept", message).about("limits"));
    } else if !is_itself {
        warnings.extend(already_super_deformed(own, wanted, lost));
    }
    let limbs = limbs.as_ref();
    let attempts_before = known.map_or(&[][..], |known| &known.attempts);
    let groups = &groups;
    let request =
        Request { measured, product, heads, style, options, groups, asked, lost, limbs, attempts_before };
    let attempts = request.attempts(&mut progress.part(0.0, 0.5))?;
    let best = attempts.iter().min_by(|one, other| one.error.total_cmp(&other.error));
    let best = best.expect("there is a first attempt");
    warnings.extend(best.limits.warnings(best.measured, asked));
    let heads_left = request.heads_left(best);
    warnings.extend(best.limited.clone());
    progress.at(0.5)?;
    let placement = Placement::new(&measured.figure, &product.bindings, &best.field, options.thread_count);
    let stays = stays(&best.field, known.map(|known| &known.field), product);
    let placed = placement.collect(measured.figure.positions.len(), |vertex| {
        match (known, best.placed.positions.get(heads.slots[vertex] as usize)) {
            (Some(known), _) if stays(vertex) => known.placed[vertex],
            (_, Some(&placed)) => placed,
            _ => placement.by_body(vertex),
        }
    });
    Ok(Body {
        field: best.field.clone(),
        bindings: Arc::clone(&product.bindings),
        placed: Arc::new(placed),
        head_ratio,
        heads: Some(best.heads),
        coefficients: best.coefficients.by_group(groups),
        warnings,
        heads_left,
        attempts,
    })
}

/// What the mode transfers of a style's body.
fn proportions_of(shape: &BodyShape) -> Result<&Proportions> {
    shape.proportions.as_ref().ok_or_else(|| {
        let message = format!(
            "the style {} holds no proportions, which product mode transfers: save it again from its model, or choose the paper's mode",
            Named(&shape.name)
        );
        Error::new(ErrorKind::BadStyle, message).about("mode")
    })
}

/// What limbs `style` gives to a figure whose head and trunk are one: for a number of heads, the built-in bodies'.
fn limbs_of(style: &Style) -> Option<Proportions> {
    match style {
        Style::Shape(shape) => shape.proportions.clone(),
        Style::Heads(heads) => BodyShape::built_in("sd2.5")?.with_heads(*heads).proportions,
    }
}

/// A warning where the style has hardly fewer heads than the target, or more.
fn already_super_deformed(own: f64, wanted: f64, lost: f64) -> Option<Warning> {
    let what = match lost {
        1.0 => return None,
        0.0 => "keeps its proportions".to_string(),
        share => format!("takes {:.0} % of the style", 100.0 * share),
    };
    let message = format!("the target is {own:.1} heads tall and the style {wanted:.1}, so it {what}");
    Some(Warning::new("already_super_deformed", message).about("limits"))
}

fn hair_shortened(parts: &PartBindings, head_length: f64) -> Option<Warning> {
    let depth = parts.hair_depth / head_length;
    (depth > HAIR_WARNED_ABOVE).then(|| {
        let message = format!(
            "hair reaches {depth:.2} head lengths below the chin: there it follows the body instead of the head"
        );
        Warning::new("hair_shortened", message).about("hair_length")
    })
}

/// Whether a vertex goes where the field `before` took it.
fn stays<'a>(
    now: &Field,
    before: Option<&Field>,
    product: &'a ProductTarget,
) -> impl Fn(usize) -> bool + use<'a> {
    let changes = before.and_then(|before| Some(now.parts()?.changes(before.parts()?)));
    let bindings = &product.bindings.vertices;
    move |vertex| {
        let binding = bindings[vertex].parts();
        changes.as_ref().zip(binding).is_some_and(|(changes, binding)| binding.stays(changes))
    }
}

/// A field that was tried.
#[derive(Debug)]
pub struct Attempt {
    field: Field,
    /// Of parts and slices together.
    coefficients: PartCoefficients,
    /// The bounds that acted, and the profile's own warning.
    limits: Limits,
    limited: Option<Warning>,
    /// The head count that is asked for, or can be reached.
    heads: f64,
    /// The one measured on the result.
    measured: f64,
    /// |ln| of how far the head count is from what can be reached: of the one measured, or, for a target without a chin, of
    /// that of its parts' lengths.
    error: f64,
    /// Where the field puts what the head count is read from.
    placed: HeadPlacement,
}

/// What is asked for, of whom.
struct Request<'a> {
    measured: &'a Measured,
    product: &'a ProductTarget,
    heads: &'a HeadSources,
    style: &'a Style,
    options: &'a Options,
    groups: &'a PartGroups,
    /// The head count that is asked for.
    asked: f64,
    /// How much of the style the target takes.
    lost: f64,
    /// The limbs that a target gets whose head and trunk are one.
    limbs: Option<&'a Proportions>,
    /// What was tried when other things were asked for.
    attempts_before: &'a [Attempt],
}

impl Request<'_> {
    /// A warning of a head count measured on the `best` field that is not the one asked for.
    fn heads_left(&self, best: &Attempt) -> Option<Warning> {
        let &Attempt { measured, heads, .. } = best;
        let is_misread = (measured / heads).ln().abs() > HEADS_WARNED_ABOVE;
        let is_missed = self.lost > 0.0 && is_misread && !best.limits.act_on_heads();
        is_missed.then(|| {
            let why = if self.options.groups.values().any(|group| group.length_scale.is_some()) {
                "the lengths set for groups leave no other"
            } else {
                "its chin or crown reads differently from the target's"
            };
            let asked = self.asked;
            let message =
                format!("{measured:.2} heads are measured on the result instead of {asked:.2}: {why}");
            Warning::new("heads_limited", message)
        })
    }

    /// One field or two: one that aims at as many heads as are asked for, and, where that misses them, one that aims as much
    /// further. What that leaves is less than the row of rays that a chin is read by.
    fn attempts(&self, progress: &mut Progress) -> Result<Vec<Attempt>> {
        let profile = profile_of(self.style, self.options, self.lost);
        let first = self.attempt(self.asked, profile.as_ref(), self.attempts_before.first())?;
        if first.error <= HEADS_TOLERANCE || first.limits.act_on_heads() || self.lost == 0.0 {
            return Ok(vec![first]);
        }
        progress.at(0.5)?;
        let (least, most) = HEADS_CORRECTION;
        let further = ((self.asked - 1.0) / (first.measured - 1.0)).clamp(least, most);
        let aim = (self.asked - 1.0) * further + 1.0;
        let second = self.attempt(aim, profile.as_ref(), self.attempts_before.get(1))?;
        Ok(vec![first, second])
    }

    /// One field, for a style with everything below the head stretched by what makes the result `aim` heads tall.
    ///
    /// - `before`: another one, of which that is taken that is the same.
    fn attempt(
        &self,
        aim: f64,
        profile: Option<&(Profile, f64)>,
        before: Option<&Attempt>,
    ) -> Result<Attempt> {
        let &Self { measured: target, product, heads, style, options, groups, asked, lost, limbs, .. } = self;
        let anatomy = &target.anatomy;
        let stretched;
        let goal = match (style, limbs) {
            (_, Some(limbs)) => Goal::Limbs(limbs),
            (Style::Heads(_), _) => Goal::Heads(aim),
            (Style::Shape(shape), _) if aim == proportions_of(shape)?.heads() => {
                Goal::Reference(proportions_of(shape)?)
            }
            (Style::Shape(shape), _) => {
                stretched = shape.with_heads(aim);
                Goal::Reference(proportions_of(&stretched)?)
            }
        };
        let has_legs = target.shape.profile.as_ref().is_some_and(|own| own.leg.is_some());
        let sliced = profile.filter(|_| has_legs).map_or(0.0, |(_, share)| share.clamp(0.0, 1.0));
        let (scales, limits) = part_coefficients(&anatomy.proportions, goal, lost, sliced, options, groups)?;
        let parts = PartField::new(anatomy, scales);
        let charted = profile.map(|(wanted, share)| {
            let chart = &product.chart;
            chart.slices(&parts, wanted, &strengths(*share, options, groups, chart.frame()))
        });
        let (parts, slices) = charted.map_or((parts, None), |(slices, about)| (about, Some(slices)));
        let coefficients = slices.as_ref().map_or(scales, |slices| slices.coefficients);
        let limited = slices.as_ref().and_then(Slices::limited);
        let field = parts.with(slices, &product.parts.pieces);
        let field = Field::of(Arc::new(BodyField::Parts(Box::new(field))));
        let placement = Placement::new(&target.figure, &product.bindings, &field, options.thread_count);
        let stays = stays(&field, before.map(|before| &before.field), product);
        let of_head = |index: usize| {
            let vertex = heads.vertices[index] as usize;
            match before {
                Some(before) if stays(vertex) => before.placed.positions[index],
                _ => placement.by_body(vertex),
            }
        };
        let positions = placement.collect(heads.vertices.len(), of_head);
        let placed = HeadPlacement::of(&target.figure, positions, |joint| placement.joint(joint));
        let same = before.filter(|before| before.placed == placed);
        let measured = same.map_or_else(|| heads.heads(&placed), |before| before.measured);
        let heads = if limits.act_on_heads() { limits.heads } else { asked };
        // A chin that the target does not show is no more to be believed where the result shows one: a ball's underside
        // steps back here or there, as last digits say. So it corrects nothing, and is only warned of.
        let read = if anatomy.landmarks.chin_seen { measured } else { limits.heads };
        let error = (read / heads).ln().abs();
        Ok(Attempt { field, coefficients, limits, limited, heads, measured, error, placed })
    }
}
