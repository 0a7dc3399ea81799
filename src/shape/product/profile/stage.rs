//! The stage of product mode that comes after the parts' maps: relief, and then the slices of the wanted profile.

use super::chains::Chains;
use super::measure::{BodyFrame, measure_profile};
use super::relief::Relief;
use super::scales::{Scales, Strengths, scales};
use super::{BodyMap, Profile, Row, STATIONS};
use crate::error::Result;
use crate::geometry::{Mapped, Weld, smoothstep};
use crate::parallel;
use crate::progress::Progress;
use crate::shape::figure::Figure;
use crate::shape::product::anatomy::Anatomy;
use crate::shape::product::binding::PartBinding;
use crate::shape::product::field::PartField;
use crate::shape::product::part::{Part, PartWeights};
use glam::{DMat3, DVec3};

/// What becomes this much stubbier (its length shrinks to .7 of what its thickness does) loses all of its relief.
const SMOOTH_FROM: f64 = 0.3;

/// The stage. Each of its maps is measured on what the one before gives.
#[derive(Clone, Debug)]
pub struct ProfileStage {
    relief: Relief,
    slices: BodyMap,
    /// What soft limits took: of what, the wanted scale and the one it got.
    limited: Vec<(&'static str, f64, f64)>,
}

/// What a stage is made of, beside the field before it.
pub struct Source<'a> {
    #[allow(missing_docs)]
    pub figure: &'a Figure,
    #[allow(missing_docs)]
    pub anatomy: &'a Anatomy,
    /// Which chains each vertex belongs to.
    pub chains: &'a Chains,
    /// The figure's vertices by position.
    pub weld: &'a Weld,
    /// The figure's own profile as it stands.
    pub rest: Option<&'a Profile>,
    /// How vertex number so-and-so is bound.
    pub binding: &'a (dyn Fn(usize) -> Option<&'a PartBinding> + Sync),
    /// At most this many, 0 for all cores.
    pub threads: usize,
}

/// How much more torso, legs and arms shrink in length than in thickness: the first over the second.
fn stubbiness(
    rest: &Profile,
    wanted: &Profile,
    before: &BodyFrame,
    after: &BodyFrame,
    grown: f64,
) -> [f64; 3] {
    let thicker = |own: Option<[&Row; 2]>, wanted: Option<[&Row; 2]>| match (own, wanted) {
        (Some(own), Some(wanted)) => {
            let log = |at: usize| 0.5 * (wanted[0][at] * wanted[1][at] / (own[0][at] * own[1][at])).ln();
            grown * ((0..STATIONS).map(log).sum::<f64>() / STATIONS as f64).exp()
        }
        _ => grown,
    };
    let torso = thicker(
        rest.torso.as_ref().map(|torso| [&torso.breadth, &torso.depth]),
        wanted.torso.as_ref().map(|torso| [&torso.breadth, &torso.depth]),
    );
    let leg = thicker(
        rest.leg.as_ref().map(|leg| [&leg.breadth, &leg.depth]),
        wanted.leg.as_ref().map(|leg| [&leg.breadth, &leg.depth]),
    );
    let arm = thicker(
        rest.arm.as_ref().map(|arm| [&arm.breadth, &arm.depth]),
        wanted.arm.as_ref().map(|arm| [&arm.breadth, &arm.depth]),
    );
    let arm_length = |frame: &BodyFrame| frame.arm_length(0) + frame.arm_length(1);
    [
        after.torso_length() / before.torso_length() / torso,
        after.leg_length() / before.leg_length() / leg,
        arm_length(after) / arm_length(before) / arm,
    ]
}

impl ProfileStage {
    /// The stage that gives a body whose vertices `field` takes to `positions` the profile `wanted`.
    ///
    /// - `strengths`: how much of it each chain takes, given where the field puts the body.
    /// - Returns, beside it, where its relief alone takes the vertices.
    ///
    /// # Errors
    /// `Cancelled`.
    pub fn of(
        source: &Source,
        field: &PartField,
        positions: &[DVec3],
        wanted: &Profile,
        strengths: impl Fn(&BodyFrame) -> Strengths,
        progress: &mut Progress,
    ) -> Result<(Self, Vec<DVec3>)> {
        let Source { figure, anatomy, weld, chains, .. } = *source;
        let place_limb = |limb| field.place_limb(limb);
        let place_torso = |p| field.place_torso(p);
        let frame = BodyFrame::placed(figure, anatomy, *field.after(), place_limb, place_torso);
        let strengths = strengths(&frame);
        let stubbier = source.rest.map_or([1.0; 3], |rest| {
            let grown = frame.head_length() / anatomy.landmarks.heights.head_length();
            stubbiness(rest, wanted, &BodyFrame::of(figure, anatomy), &frame, grown)
        });
        let mean = |row: &Row| row.iter().sum::<f64>() / STATIONS as f64;
        let of_chains = [strengths.torso, mean(&strengths.leg), mean(&strengths.arm)];
        let relief_strength =
            std::array::from_fn(|chain| of_chains[chain] * smoothstep((1.0 - stubbier[chain]) / SMOOTH_FROM));
        let relief = Relief::of(figure, positions, chains, weld, &frame, relief_strength, source.threads);
        progress.at(0.5)?;
        let smooth = parallel::collect(source.threads, positions.len(), parallel::FEW, |vertex| {
            let p = positions[vertex];
            match (source.binding)(vertex) {
                Some(binding) if !is_of_head(&binding.weights) => {
                    relief.map(p, &binding.weights, binding.is_skirt)
                }
                _ => p,
            }
        });
        progress.at(0.7)?;
        let (own, lines) = measure_profile(figure, &smooth, chains, weld, &frame, source.threads);
        let scales = scales(&own, wanted, &strengths);
        let slices = BodyMap::new(&own, &lines, &frame, &scales);
        let Scales { limited, .. } = scales;
        progress.at(1.0)?;
        Ok((Self { relief, slices, limited }, smooth))
    }

    /// Where `p`, as the parts leave it, goes. It stays where a body of next to no length gives no number.
    pub fn place(&self, p: DVec3, binding: &PartBinding) -> DVec3 {
        if binding.is_on_bone() {
            return finite_or(self.slices.on_bones(p, &binding.weights), p);
        }
        let PartBinding { weights, is_skirt, .. } = binding;
        self.place_smooth(p, || self.relief.map(p, weights, *is_skirt), binding)
    }

    /// The same for what hangs on no bones, where the relief alone takes `p` to `smooth`.
    pub fn place_smooth(&self, p: DVec3, smooth: impl FnOnce() -> DVec3, binding: &PartBinding) -> DVec3 {
        if is_of_head(&binding.weights) {
            return p;
        }
        finite_or(self.slices.map(smooth(), &binding.weights, binding.is_skirt), p)
    }

    /// The same and the Jacobian there.
    pub fn map(&self, p: DVec3, binding: &PartBinding) -> Mapped {
        let PartBinding { weights, is_skirt, .. } = binding;
        let to = if binding.is_on_bone() {
            self.slices.on_bones(p, weights)
        } else {
            let smooth: Mapped = self.relief.map(p, weights, *is_skirt);
            smooth.then(|p| self.slices.map(p, weights, *is_skirt))
        };
        if to.position.is_finite() { to } else { Mapped { position: p, jacobian: DMat3::IDENTITY } }
    }

    /// Of what soft limits took more than a tenth: the wanted scale and the one that it got.
    pub fn limited(&self) -> &[(&'static str, f64, f64)] {
        &self.limited
    }
}

fn finite_or(to: DVec3, p: DVec3) -> DVec3 {
    if to.is_finite() { to } else { p }
}

/// True for what head and hair alone move: no slice of the body does.
fn is_of_head(weights: &PartWeights) -> bool {
    let head = [Part::Head as usize, Part::Hair as usize];
    weights.iter().enumerate().all(|(part, &weight)| weight == 0.0 || head.contains(&part))
}
