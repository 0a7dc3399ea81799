//! Relief follows length: what stands out of a body is smoothed where the body has become shorter and not thinner.
//!
//! A torso that is .4 as long and .8 as thick has twice the slopes: a bust is a spike, a hem a shelf, calves are balls. So the
//! reach of the surface around torso and limbs is smoothed along them, and what lies on it moves along.

use super::chains::{Chain, Chains, arm_share};
use super::curve::{monotone_cubic, smoothed};
use super::cuts::{Body, BodyFrame};
use super::map::on_bones;
use super::radius_map::{RadiusMap, Ring, Spot, reaches_around};
use super::station::{centred, surface};
use super::{ARM_STATIONS, LEG_STATIONS, Row, STATIONS, TORSO_STATIONS, stations};
use crate::geometry::slice::{Outline, Planes, RAYS};
use crate::geometry::weld::Weld;
use crate::geometry::{Moved, outer, smoothstep, smoothstep_slope};
use crate::parallel;
use crate::shape::figure::Figure;
use crate::shape::product::binding::PartBinding;
use crate::shape::product::part::{Part, PartWeights};
use glam::{DMat3, DVec2, DVec3};

/// Rows of the torso and of limbs, in head lengths at rest: an adult's torso becomes a fifth to a half as long. Seen: at twice that
/// belts and folds of a trunk of two heads, which are then a row high, stay rolls.
const STEP: f64 = 0.02;
/// No map and no table has more rows, or few more: for heads that are tiny beside their bodies.
pub(super) const MOST_ROWS: f64 = 2000.0;
/// Widths of the bells that leave no relief, in heads of the result.
const TORSO_SIGMA: f64 = 0.16;
const LIMB_SIGMA: f64 = 0.20;
/// Width of the bell for the middles, in head lengths at rest: what the two above are there of an adult's arm. Seen: at .45
/// the front of a dress and its back, which hang differently far down, are drawn to different sides.
const MIDDLE_SIGMA: f64 = 0.7;
/// What the reach may be scaled by, or by the inverse of. Seen: where a waist may grow by a third alone, backs at two heads keep a
/// groove, whose trunks are so short below the shoulders; of 644 triangles that turn 13 fewer do at 1.3, 15 more at 1.8.
const BOUND: f64 = 1.5;
/// No reach falls off more steeply than this along its axis, at rest. Seen: without it hems stand out as fins and cuffs as lips, and
/// folds and a suit's back stay grooves; of 626 triangles that turn 5 fewer and 15 more do at ±30 %.
const STEEPEST: f64 = 1.0;
/// The torso's rows reach down by this part of the leg.
const TORSO_BOTTOM: f64 = 0.45;
/// Rows of a leg and of an arm, as parts of it: a leg ends at its ankle, an arm before its thumb begins.
const LEG_ROWS: (f64, f64) = (0.02, 1.0);
const ARM_ROWS: (f64, f64) = (0.05, 0.95);
/// Below these heights under the crotch, in torsos, the torso's relief ends; above these it does to the sides, and in the
/// middle.
const BOTTOM_FADE: (f64, f64) = (0.04, 0.22);
const TOP_FADE: (f64, f64) = (0.86, 1.0);
/// A skirt's relief ends further down, in parts of the leg. Seen: where it does as other cloth's does, a hem stands out as a fin all
/// around a low-poly dress of two heads.
const SKIRT_FADE: (f64, f64) = (0.25, 0.45);
/// What moves with an arm by the first of these still has all of the torso's relief smoothed, by the second none of it. Made
/// weights give a bust beside the arm pits .2 of the arms; where that counted, it stayed a spike.
const OF_ARM: (f64, f64) = (0.1, 0.5);

/// How far a body reaches around torso, legs and arms (left, right), as it stands.
#[derive(Clone, Debug)]
pub struct Reaches([Option<RadiusMap>; 5]);

/// Relief maps of a body: of torso, legs and arms.
#[derive(Clone, Debug)]
pub struct Relief {
    maps: [Option<RadiusMap>; 5],
    frame: BodyFrame,
}

impl Reaches {
    /// Measures a figure.
    ///
    /// - `threads`: at most this many, 0 for all cores.
    pub fn of(figure: &Figure, chains: &Chains, weld: &Weld, frame: &BodyFrame, threads: usize) -> Self {
        let positions = &figure.positions;
        let body = Body { figure, positions, chains, weld, frame, length: frame.head_length() };
        let mut maps = parallel::collect(body.worth(threads), 5, 1, |map| match map {
            0 => body.torso_reaches(),
            1 | 2 => body.leg_reaches(map - 1),
            _ => body.arm_reaches(map - 3),
        });
        Self(std::array::from_fn(|map| maps[map].take()))
    }

    /// Adds the spots of a point that is bound so, each with the number of its map: what maps that are yet to come need of what
    /// stays.
    pub fn add_spots(&self, spots: &mut Vec<(u8, Spot)>, frame: &BodyFrame, p: DVec3, by: &PartBinding) {
        shares(&self.0, frame, p, &by.weights, by.is_skirt, |number, map, share, _| {
            spots.push((number, map.spot(p, share)));
        });
    }

    /// What is to become of it.
    ///
    /// - `strength`: 0 leaves relief, 1 smooths all of it: at the slices of torso, legs and arms.
    /// - `place`: where heights along torso (0), legs (1) and arms (2) come to lie in the result, in its heads.
    pub fn relief(&self, frame: &BodyFrame, strength: [Row; 3], place: impl Fn(usize, f64) -> f64) -> Relief {
        let relief = |number: usize| {
            // Left and right are of one chain.
            let chain = number.div_ceil(2);
            let map = self.0[number].as_ref().filter(|_| strength[chain] != [0.0; STATIONS])?;
            let heights = (0..map.reaches.len()).map(|row| map.start + map.step * row as f64);
            let places: Vec<f64> = heights.clone().map(|height| place(chain, height)).collect();
            let (sigma, length, slices) = match number {
                0 => (TORSO_SIGMA, frame.torso_length(), TORSO_STATIONS),
                1 | 2 => (LIMB_SIGMA, frame.leg_length, LEG_STATIONS),
                arm => (LIMB_SIGMA, frame.arm_lengths[arm - 3], ARM_STATIONS),
            };
            let slices = stations(slices);
            let strength = heights.map(|height| monotone_cubic(&slices, &strength[chain], height / length));
            Some(scaled(map, &smoothed(&map.reaches, &places, sigma), strength))
        };
        Relief { maps: std::array::from_fn(relief), frame: frame.clone() }
    }
}

impl Relief {
    /// Which maps, of torso, legs and arms, do what those of the same body's relief `other` do.
    pub fn common(&self, other: &Self) -> [bool; 5] {
        std::array::from_fn(|map| match (&self.maps[map], &other.maps[map]) {
            (Some(own), Some(other)) => own.scales == other.scales,
            (own, other) => own.is_none() && other.is_none(),
        })
    }

    /// Where `p` goes that `weights` bind; a Jacobian is that at fixed weights.
    pub fn map<M: Moved>(&self, p: DVec3, weights: &PartWeights, is_skirt: bool) -> M {
        let mut to = p;
        let mut jacobian = DMat3::IDENTITY;
        shares(&self.maps, &self.frame, p, weights, is_skirt, |_, map, share, slope| {
            let shift: M = map.shift(p);
            to += share * shift.position();
            jacobian += shift.jacobian() * share + outer(shift.position(), slope);
        });
        M::of(to, || jacobian)
    }

    /// As [`Self::map`], of a point whose spots these are, as [`Reaches::add_spots`] gives them.
    pub fn map_known(&self, p: DVec3, spots: &[(u8, Spot)]) -> DVec3 {
        let shift = |(map, spot): &(u8, Spot)| Some(self.maps[usize::from(*map)].as_ref()?.shift_of(spot));
        p + spots.iter().filter_map(shift).sum::<DVec3>()
    }
}

/// Gives the numbers of the maps that move `p`, which `weights` bind, with each how much of it does, and the slope of that.
#[inline(always)]
fn shares(
    maps: &[Option<RadiusMap>; 5],
    frame: &BodyFrame,
    p: DVec3,
    weights: &PartWeights,
    is_skirt: bool,
    mut give: impl FnMut(u8, &RadiusMap, f64, DVec3),
) {
    let arms = [0, 1].map(|side| f64::from(arm_share(weights, side)));
    let [torso, limbs @ ..] = maps;
    if let Some(map) = torso {
        let of_head = f64::from(
            weights[Part::Head as usize] + weights[Part::Hair as usize] + weights[Part::Neck as usize],
        );
        let bound = (1.0 - smoothstep((arms[0] + arms[1] - OF_ARM.0) / (OF_ARM.1 - OF_ARM.0)))
            * (1.0 - smoothstep(of_head / 0.5));
        let (share, slope) = torso_share(frame, p.y, is_skirt);
        if bound * share > 0.0 {
            give(0, map, bound * share, DVec3::Y * (bound * slope));
        }
    }
    for side in 0..2 {
        if let Some(map) = &limbs[side]
            && !is_skirt
        {
            let first = [Part::LeftUpperLeg, Part::RightUpperLeg][side] as usize;
            let bound = f64::from(weights[first] + weights[first + 1]);
            let t = (frame.heights.crotch - p.y) / frame.leg_length;
            let (share, slope) = smoothstep_slope(t / 0.22);
            if bound * share > 0.0 {
                let slope = DVec3::NEG_Y * (bound * slope / 0.22 / frame.leg_length);
                give(1 + side as u8, map, bound * share, slope);
            }
        }
        let bound = ((arms[side] - 0.1) / 0.8).clamp(0.0, 1.0);
        if let Some(map) = &limbs[2 + side]
            && bound > 0.0
        {
            let length = frame.arm_lengths[side];
            let t = map.planes.locate(p).0 / length;
            let (start, start_slope) = smoothstep_slope((t - 0.05) / 0.2);
            let (end, end_slope) = smoothstep_slope((t - 0.98) / 0.12);
            let share = bound * start * (1.0 - end);
            if share > 0.0 {
                let slope = bound * (start_slope / 0.2 * (1.0 - end) - end_slope / 0.12 * start) / length;
                give(3 + side as u8, map, share, map.planes.axis * slope);
            }
        }
    }
}

/// How much of the torso's relief is smoothed at height `y`, and the slope of that.
fn torso_share(frame: &BodyFrame, y: f64, is_skirt: bool) -> (f64, f64) {
    let torso_length = frame.torso_length();
    let t = (y - frame.heights.crotch) / torso_length;
    let to_leg = frame.leg_length / torso_length;
    let fade = if is_skirt { (SKIRT_FADE.0 * to_leg, SKIRT_FADE.1 * to_leg) } else { BOTTOM_FADE };
    let (top, top_slope) = smoothstep_slope((t - TOP_FADE.0) / (TOP_FADE.1 - TOP_FADE.0));
    let (bottom, bottom_slope) = smoothstep_slope((-t - fade.0) / (fade.1 - fade.0));
    let slope = bottom_slope / (fade.1 - fade.0) * (1.0 - top)
        - top_slope / (TOP_FADE.1 - TOP_FADE.0) * (1.0 - bottom);
    ((1.0 - top) * (1.0 - bottom), slope / torso_length)
}

impl Body<'_> {
    fn torso_reaches(&self) -> Option<RadiusMap> {
        let planes = self.frame.torso_planes();
        let ends = (-TORSO_BOTTOM * self.frame.leg_length, self.frame.torso_length());
        let shoulders = planes.locate(self.frame.shoulders);
        let bone = |height: f64| DVec2::new(0.0, shoulders.1.y * (height / shoulders.0).max(0.0));
        self.reaches(Chain::Trunk, planes, ends, bone)
    }

    fn leg_reaches(&self, side: usize) -> Option<RadiusMap> {
        let length = self.frame.leg_length;
        let ends = (LEG_ROWS.0 * length, LEG_ROWS.1 * length);
        let bone = |height: f64| self.frame.leg_bone(2 + side, height);
        self.reaches(Chain::Leg(side), self.frame.leg_planes(), ends, bone)
    }

    fn arm_reaches(&self, side: usize) -> Option<RadiusMap> {
        let planes = self.frame.arm_planes(side)?;
        let length = self.frame.arm_lengths[side];
        let ends = (ARM_ROWS.0 * length, ARM_ROWS.1 * length);
        let elbow = planes.locate(self.frame.limbs[side].middle);
        self.reaches(Chain::Forearm(side), planes, ends, |height| on_bones(elbow, length, height)[0])
    }

    /// The reaches of `chain` in rows from `start` to `end` or a little beyond, further apart where there would be too many;
    /// `None` where nothing is met anywhere. What reaches over the middle is no leg.
    ///
    /// - `bone`: where its bones are at a height, which is where the middle is looked for.
    fn reaches(
        &self,
        chain: Chain,
        planes: Planes,
        (start, end): (f64, f64),
        bone: impl Fn(f64) -> DVec2,
    ) -> Option<RadiusMap> {
        let step = (STEP * self.length).max((end - start) / MOST_ROWS);
        let count = ((end - start) / step).ceil().clamp(1.0, MOST_ROWS) as usize + 1;
        let ways: Vec<f64> = (0..count).map(|row| step * row as f64).collect();
        let heights: Vec<f64> = ways.iter().map(|way| start + way).collect();
        let mut cuts = self.cut(&self.triangles(chain), &planes, &heights);
        if let Chain::Leg(side) = chain {
            cuts.iter_mut().for_each(|outlines| outlines.retain(|outline| !self.is_over(2 + side, outline)));
        }
        let middle = |(outlines, height): (&Vec<Outline>, f64)| {
            let extents = |middle: DVec2| {
                let reaches = surface(outlines.iter(), middle);
                [0, 1, 2, 3].map(|quarter| reaches[quarter * RAYS / 4])
            };
            centred(bone(height), chain == Chain::Trunk, extents).into()
        };
        let middles: Vec<[f64; 2]> = cuts.iter().zip(heights.iter().copied()).map(middle).collect();
        let middles = smoothed(&middles, &ways, MIDDLE_SIGMA * self.length);
        let middles: Vec<DVec2> = middles.into_iter().map(DVec2::from).collect();
        let (first, mut reaches) = reaches_around(&cuts, &middles)?;
        let count = reaches.len();
        // What lies under a hem is within its reach: else the hem's lip would go the way of what it hangs over.
        let (down, up) = ((1..count).map(|row| (row, row - 1)), (1..count).rev().map(|row| (row - 1, row)));
        for (row, beside) in down.chain(up) {
            let least = reaches[beside].map(|reach| reach - STEEPEST * step);
            reaches[row] = std::array::from_fn(|ray| reaches[row][ray].max(least[ray]));
        }
        let (middles, reaches) = (middles[first..first + count].into(), reaches.into());
        Some(RadiusMap { planes, start: heights[first], step, middles, reaches, scales: Vec::new() })
    }
}

/// `map` with so much of the scales from its reaches to smooth reaches.
fn scaled(map: &RadiusMap, smooth: &[Ring], strength: impl Iterator<Item = f64>) -> RadiusMap {
    let scale = |((reach, smooth), strength): ((&Ring, &Ring), f64)| -> Ring {
        let whole = |ray: usize| (smooth[ray] / reach[ray]).clamp(1.0 / BOUND, BOUND);
        // A power of 1 takes as long as any other.
        std::array::from_fn(|ray| if strength == 1.0 { whole(ray) } else { whole(ray).powf(strength) })
    };
    let scales = map.reaches.iter().zip(smooth).zip(strength).map(scale).collect();
    RadiusMap { scales, ..map.clone() }
}
