//! From a body's own profile to the wanted one: how each slice is scaled and where its middle goes.

use super::wanted::BARE;
use super::{
    BothExtents, LEG_STATIONS, LegProfile, Profile, Row, STATIONS, TORSO_STATIONS, station_at, stations,
};
use crate::geometry::smoothstep;

/// A soft limit of ln S: of slices, hands and feet.
const MOST: f64 = 2.4;
/// A hand this much broader than thick lies flat; one as broad as thick is a fist.
const FLAT_HAND: f64 = 1.3;
/// The distance between legs is that of this part of them from the crotch; below it is stance.
const SPREAD_UP_TO: f64 = 0.4;
/// The torso goes over to the skirt below it by this much, up to this place.
const TO_SKIRT: (f64, f64) = (0.8, 0.55);
/// What a visible arm may lose and gain.
const ARM_LENGTH: (f64, f64) = (0.8, 1.05);
/// What a neck may.
const NECK: (f64, f64) = (0.7, 1.45);
/// Where a style's neck is thicker than this, in head lengths, and than what it is given to, it wears a scarf.
const STYLES_NECK: f64 = 0.18;
/// The slice of trunk and legs up to which what a reference wears at its crotch is left out.
const MIDDLE: usize = STATIONS / 2;

/// What a soft limit takes of a scale is told above this share of it.
const NOTED_ABOVE: f64 = 0.1;

/// A hand that becomes this much more thick than long, less 1, is a mitt. Seen: ±30 % changes no adult's hand of a body of 2
/// heads or of the rogue's, which become 1.0 to 1.6; at 3 heads, .2 to .6, a mitt is a third more or less of one.
const MITT: f64 = 0.5;

/// How much of the way to go, by chain and slice; 1 for all.
#[derive(Clone, Debug, PartialEq)]
pub struct Strengths {
    /// By slice, upwards.
    pub torso: f64,
    /// Downwards.
    pub leg: Row,
    /// Outwards.
    pub arm: Row,
    /// Of the hands, all that is measured of them.
    pub hand: f64,
    /// The same of the feet.
    pub foot: f64,
    /// Of the neck's radius.
    pub neck: f64,
    /// How far the legs stand from the middle.
    pub spread: f64,
    /// Lengths of the arms.
    pub arm_length: f64,
    /// Soft limits hold.
    pub is_limited: bool,
}

impl Strengths {
    /// `most`, where limits hold.
    fn limit(&self, most: f64) -> f64 {
        if self.is_limited { most } else { f64::INFINITY }
    }
}

/// Scales of two axes by slice.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SliceScales {
    /// Across.
    pub breadth: Row,
    /// Forward.
    pub depth: Row,
}

impl SliceScales {
    const NONE: Self = Self { breadth: [1.0; STATIONS], depth: [1.0; STATIONS] };
}

/// How a skirt is scaled, at those slices of the legs where there is one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SkirtScale {
    /// Of the legs.
    pub station: usize,
    /// The skirt's own half breadth and half depth, in head lengths.
    pub half: [f64; 2],
    /// How far forward its own middle is, in head lengths.
    pub forward: f64,
    /// Across, forward.
    pub scale: [f64; 2],
    /// How far its middle moves forward beside the legs' own.
    pub shift: f64,
}

/// What is done to a body, in its own head lengths.
#[derive(Clone, Debug, PartialEq)]
pub struct Scales {
    /// Of the torso, upwards.
    pub torso: SliceScales,
    /// How much broader and deeper the torso is at the shoulder line than by its last slice: none, until
    /// [`Chart::slices`](super::Chart::slices) says where the style's slices come to lie.
    pub torso_top: [f64; 2],
    /// Of both legs, downwards.
    pub leg: SliceScales,
    /// How far each leg moves outward.
    pub spread: f64,
    /// How far the middles of the legs' slices move forward: none, until [`Chart::slices`](super::Chart::slices) straightens them.
    pub leg_shift: Row,
    /// From shoulder to wrist.
    pub arm: SliceScales,
    /// Along the arm, from shoulder to wrist.
    pub arm_length: f64,
    /// Length, breadth, thickness.
    pub hand: [f64; 3],
    /// How much of a mitt it becomes: none, until [`Chart::slices`](super::Chart::slices) says so.
    pub mitt: f64,
    /// Length, breadth, height of the toes.
    pub foot: [f64; 3],
    /// Of the neck's radius.
    pub neck: f64,
    /// From the crotch down.
    pub skirt: Vec<SkirtScale>,
    /// Of what soft limits took more than a tenth, with the scale that was wanted and the one that it got, where most was
    /// taken.
    pub limited: Vec<(&'static str, f64, f64)>,
}

impl Scales {
    /// Notes what the limits took of the scale from `own` to `wanted`, `strength` of the way, where it is `got`.
    fn note(&mut self, what: &'static str, wanted: f64, own: f64, strength: f64, got: f64) {
        let wanted = (wanted / own).powf(strength);
        let taken = |wanted: f64, got: f64| (wanted / got).ln().abs();
        if taken(wanted, got) <= (1.0 + NOTED_ABOVE).ln() {
            return;
        }
        match self.limited.iter_mut().find(|known| known.0 == what) {
            Some(known) if taken(known.1, known.2) >= taken(wanted, got) => {}
            Some(known) => *known = (what, wanted, got),
            None => self.limited.push((what, wanted, got)),
        }
    }

    /// Scales half breadth and half depth of a chain, slice by slice, where both profiles have it, and notes what the limits
    /// took of them.
    fn extents(
        &mut self,
        what: &'static str,
        extents: Option<BothExtents<'_>>,
        strengths: &Row,
        most: f64,
    ) -> SliceScales {
        let Some((own, wanted)) = extents else { return SliceScales::NONE };
        let [breadth, depth] = [0, 1].map(|axis| {
            std::array::from_fn(|at| {
                let (wanted, own, strength) = (wanted[axis][at], own[axis][at], strengths[at]);
                let got = soft_scale(wanted, own, strength, most);
                self.note(what, wanted, own, strength, got);
                got
            })
        });
        SliceScales { breadth, depth }
    }
}

/// What makes a body of profile `own` one of profile `wanted`; what either lacks stays as it is.
pub fn scales(own: &Profile, wanted: &Profile, strengths: &Strengths) -> Scales {
    let wanted = flesh(wanted, own);
    let mut result = Scales {
        torso: SliceScales::NONE,
        torso_top: [1.0; 2],
        leg: SliceScales::NONE,
        spread: 0.0,
        leg_shift: [0.0; STATIONS],
        arm: SliceScales::NONE,
        arm_length: 1.0,
        hand: [1.0; 3],
        mitt: 0.0,
        foot: [1.0; 3],
        neck: 1.0,
        skirt: Vec::new(),
        limited: Vec::new(),
    };
    let [torso, legs, arms] = own.both_extents(&wanted);
    let (torso_row, most) = ([strengths.torso; STATIONS], strengths.limit(MOST));
    result.leg = result.extents("legs", legs, &strengths.leg, most);
    result.torso = result.extents("torso", torso, &torso_row, most);
    result.arm = result.extents("arms", arms, &strengths.arm, most);
    if let (Some(own), Some(wanted)) = (&own.leg, &wanted.leg) {
        result.spread = spread(&result.leg, own, wanted, strengths.spread);
    }
    skirt(&mut result, own);
    if arms.is_some() {
        arm_length(&mut result, own, &wanted, strengths.arm_length);
    }
    if let (Some(own), Some(wanted)) = (own.hand, wanted.hand) {
        // Palms may look down or forward: what is broader is the breadth.
        let sorted = |[length, one, other]: [f64; 3]| [length, one.max(other), one.min(other)];
        // A fist is neither, and takes the mean: last digits must not tell which way it lies.
        let lies = lies_flat(own[1], own[2]);
        let (wanted, own, strength) = (sorted(wanted), sorted(own), strengths.hand);
        let [length, broad, thin] = [0, 1, 2].map(|axis| {
            let got = soft_scale(wanted[axis], own[axis], strength, most);
            result.note("hands", wanted[axis], own[axis], strength, got);
            got
        });
        let along = |share: f64| (share * broad.ln() + (1.0 - share) * thin.ln()).exp();
        result.hand = [length, along((1.0 + lies) / 2.0), along((1.0 - lies) / 2.0)];
    }
    if let (Some(own), Some(wanted)) = (own.foot, wanted.foot) {
        foot(&mut result, own, wanted, strengths);
    }
    if let (Some(own), Some(wanted)) = (own.neck, wanted.neck) {
        result.neck = (wanted.min(own.max(STYLES_NECK)) / own).clamp(NECK.0, NECK.1).powf(strengths.neck);
    }
    result
}

/// How flat a hand lies, from -1, where it stands, to 1: by its breadth to the front and across. A fist does neither.
pub fn lies_flat(front: f64, across: f64) -> f64 {
    ((front / across).ln() / FLAT_HAND.ln()).clamp(-1.0, 1.0)
}

/// How much of a mitt, 0 to 1, a hand becomes whose length, breadth and thickness are scaled so.
pub fn mitt([length, broad, thin]: [f64; 3]) -> f64 {
    smoothstep(((broad * thin).sqrt() / length - 1.0) / MITT)
}

/// A reference's shorts and tunic are no flesh: by what its thighs and its trunk widen more towards the crotch than those of `own`
/// do, and than bare ones, they become slimmer, and where its trunk stands further off its legs, it ends in a hem, and both go over
/// into each other, each by half. Who wears such things too keeps them.
pub fn flesh(wanted: &Profile, own: &Profile) -> Profile {
    let mut result = wanted.clone();
    let (Some(torso), Some(leg), Some(own_torso), Some(own_leg)) =
        (&mut result.torso, &mut result.leg, &own.torso, &own.leg)
    else {
        return result;
    };
    let beyond = |wanted: f64, own: f64, bare: f64| (wanted / own.max(bare)).max(1.0);
    let flare = |row: &Row| row[0] / row[MIDDLE];
    let slimmer = |row: &Row, by: f64| -> Row {
        let share = |station: usize| 1.0 - smoothstep(station as f64 / MIDDLE as f64);
        std::array::from_fn(|station| row[station] / by.powf(share(station)))
    };
    let thigh = |row: &Row, own: &Row| slimmer(row, beyond(flare(row), flare(own), BARE.leg_flare));
    let breadth = thigh(&leg.breadth, &own_leg.breadth);
    // The gap between the legs stays.
    leg.outward = std::array::from_fn(|at| leg.outward[at] - (leg.breadth[at] - breadth[at]));
    (leg.breadth, leg.depth) = (breadth, thigh(&leg.depth, &own_leg.depth));
    // A leg beyond the body's middle reaches out as far as it is broad.
    let edges = |leg: &LegProfile| -> [Row; 2] {
        [std::array::from_fn(|at| leg.outward[at].max(0.0) + leg.breadth[at]), leg.depth]
    };
    let (own_edges, edges) = (edges(own_leg), edges(leg));
    let trunks = [(&mut torso.breadth, &own_torso.breadth), (&mut torso.depth, &own_torso.depth)];
    for (axis, (trunk, own)) in trunks.into_iter().enumerate() {
        let step = trunk[0] / edges[axis][0];
        let by = beyond(flare(trunk), flare(own), BARE.torso_flares[axis]).min(step.max(1.0));
        let hem = beyond(step / by, own[0] / own_edges[axis][0], BARE.steps[axis]).sqrt();
        *trunk = slimmer(trunk, by * hem);
        let (edge, broader) = (edges[axis], slimmer(&edges[axis], 1.0 / hem));
        let row = if axis == 0 { &mut leg.breadth } else { &mut leg.depth };
        *row = std::array::from_fn(|at| row[at] + (broader[at] - edge[at]));
    }
    result
}

/// How far each leg moves outward whose slices are scaled by `leg`.
fn spread(leg: &SliceScales, own: &LegProfile, wanted: &LegProfile, strength: f64) -> f64 {
    let upper = (0..STATIONS).filter(|&station| station_at(LEG_STATIONS, station) < SPREAD_UP_TO);
    let mean =
        |number: &dyn Fn(usize) -> f64| upper.clone().map(number).sum::<f64>() / upper.clone().count() as f64;
    let new_breadth = |station: usize| leg.breadth[station] * own.breadth[station];
    let gap = |leg: &LegProfile| mean(&|station| leg.outward[station] - leg.breadth[station]);
    let delta = strength * mean(&|station| wanted.outward[station] - own.outward[station]);
    let roomy = gap(own).max((gap(own) + gap(wanted)) / 2.0);
    let most = mean(&|station| new_breadth(station) - own.outward[station]) + roomy;
    delta.min(most)
}

/// A skirt follows the hips, keeps its distance from the legs, and is no further from them than that, or halfway from there to
/// hanging straight down.
fn skirt(result: &mut Scales, own: &Profile) {
    let (Some(skirt), Some(leg)) = (&own.skirt, &own.leg) else { return };
    let hips = [result.torso.breadth[0], result.torso.depth[0]];
    let straight =
        own.torso.as_ref().map_or([0.0; 2], |torso| [torso.breadth[0] * hips[0], torso.depth[0] * hips[1]]);
    for station in 0..STATIONS {
        let Some((half, forward)) = skirt.at(station) else { continue };
        let off = (leg.forward[station] - forward).abs();
        let new = [
            result.leg.breadth[station] * leg.breadth[station],
            result.leg.depth[station] * leg.depth[station],
        ];
        let legs = [leg.outward[station] + leg.breadth[station], off + leg.depth[station]];
        let new_legs = [leg.outward[station] + result.spread + new[0], off + new[1]];
        let scale = [0, 1].map(|axis| {
            let near = new_legs[axis] + half[axis] - legs[axis];
            let most = near.max((near * straight[axis]).sqrt());
            (half[axis] * hips[axis]).min(most).max(near) / half[axis]
        });
        result.skirt.push(SkirtScale { station, half, forward, scale, shift: 0.0 });
    }
    if let Some(first) = result.skirt.first() {
        let (share, reach) = TO_SKIRT;
        for (station, t) in stations(TORSO_STATIONS).into_iter().enumerate() {
            let share = share * (1.0 - smoothstep(t / reach));
            for (row, scale) in
                [&mut result.torso.breadth, &mut result.torso.depth].into_iter().zip(first.scale)
            {
                row[station] *= (scale / row[station]).powf(share);
            }
        }
    }
}

/// What is seen of an arm begins where the torso ends.
fn arm_length(result: &mut Scales, own: &Profile, wanted: &Profile, strength: f64) {
    let (Some(own_torso), Some(wanted_torso)) = (&own.torso, &wanted.torso) else { return };
    let hidden = |breadth: f64, shoulder: f64| (breadth - shoulder).max(0.0);
    let top = STATIONS - 1;
    let scale = result.torso.breadth[top];
    let visible = wanted.arm_length - hidden(wanted_torso.breadth[top], wanted.shoulder);
    let own_visible = own.arm_length - scale * hidden(own_torso.breadth[top], own.shoulder);
    if own_visible > 0.0 && visible > 0.0 {
        result.arm_length = (visible / own_visible).clamp(ARM_LENGTH.0, ARM_LENGTH.1).powf(strength);
    }
}

/// Along z by length, along x by breadth; heights of the toes.
fn foot(result: &mut Scales, own: [f64; 5], wanted: [f64; 5], strengths: &Strengths) {
    let strength = strengths.foot;
    let sizes = |[toes, heel, breadth, ..]: [f64; 5]| [toes + heel, breadth];
    let (before, after) = (sizes(own), sizes(wanted));
    let most = strengths.limit(MOST);
    let [length, breadth] = [0, 1].map(|axis| soft_scale(after[axis], before[axis], strength, most));
    let toes = (wanted[4] / own[4]).clamp(1.0, 1.8).powf(strength);
    result.foot = [length, breadth, toes];
    for axis in 0..2 {
        result.note("feet", after[axis], before[axis], strength, result.foot[axis]);
    }
}

/// e^(A m tanh(ln(wanted / own) / m)): the scale from `own` to `wanted`, `strength` of the way, with a soft limit: none of a
/// ratio is cut off, but of a ratio of 4 some 2.8 are left where m is 1.3. An infinite m is no limit.
pub fn soft_scale(wanted: f64, own: f64, strength: f64, most: f64) -> f64 {
    let log = (wanted / own).ln();
    (strength * if most.is_finite() { most * (log / most).tanh() } else { log }).exp()
}

#[cfg(test)]
mod tests {
    use super::super::wanted::canonical;
    use super::*;

    #[test]
    fn shorts_and_a_tunic_are_left_out_unless_who_takes_them_wears_such() {
        let bare = canonical(3.4);
        // A tunic as broad all the way down.
        let mut tunic = bare.clone();
        let torso = tunic.torso.as_mut().unwrap();
        (torso.breadth, torso.depth) = ([0.6; STATIONS], [0.5; STATIONS]);
        let mut shorts = bare.clone();
        let leg = shorts.leg.as_mut().unwrap();
        for station in 0..4 {
            leg.depth[station] *= 1.4;
        }
        // Nothing to leave out, whose own it is, and nobody to leave it out for.
        let nobody = Profile::default();
        for (wanted, own) in [(&bare, &tunic), (&tunic, &tunic), (&shorts, &shorts), (&tunic, &nobody)] {
            assert_eq!(&flesh(wanted, own), wanted);
        }
        let [dressed, left] = [tunic.clone(), flesh(&tunic, &bare)];
        let leg = |profile: &Profile| profile.leg.clone().unwrap();
        let torso = |profile: &Profile| profile.torso.clone().unwrap();
        // Trunk and legs meet halfway, as far apart as a bare body's.
        let steps = |profile: &Profile| {
            let (torso, leg) = (torso(profile), leg(profile));
            [torso.breadth[0] / (leg.outward[0] + leg.breadth[0]), torso.depth[0] / leg.depth[0]]
        };
        for axis in 0..2 {
            assert!((steps(&left)[axis] / steps(&bare)[axis] - 1.0).abs() < 1e-9, "{:?}", steps(&left));
        }
        let (thinner, thicker) =
            (torso(&dressed).depth[0] / torso(&left).depth[0], leg(&left).depth[0] / leg(&dressed).depth[0]);
        assert!((thinner / thicker - 1.0).abs() < 1e-9, "{thinner} {thicker}");
        // Thighs without shorts are a bare body's.
        let without = leg(&flesh(&shorts, &bare)).depth[0];
        assert!((without / leg(&bare).depth[0] - 1.0).abs() < 1e-9, "{without}");
        // From the middle on nothing is left out.
        assert_eq!(torso(&left).depth[MIDDLE..], torso(&dressed).depth[MIDDLE..]);
        assert_eq!(leg(&left).breadth[MIDDLE..], leg(&dressed).breadth[MIDDLE..]);
    }

    #[test]
    fn a_ratio_of_two_is_nearly_met_and_one_of_four_is_not() {
        assert!((soft_scale(2.0, 1.0, 1.0, 1.3) - 1.89).abs() < 5e-3);
        assert!((soft_scale(4.0, 1.0, 1.0, 1.3) - 2.79).abs() < 5e-3);
        assert_eq!(soft_scale(2.0, 1.0, 0.0, 1.3), 1.0);
        assert!((soft_scale(4.0, 1.0, 1.0, f64::INFINITY) - 4.0).abs() < 1e-12);
    }
}
