//! Gives a body the wanted profile: one map of slices for torso, legs, arms, hands, feet and neck, blended by the weights.
//!
//! Each map keeps the place along its own axis but for what an arm's length changes, and is monotone on the others: so one
//! chain alone cannot fold.

use super::chains::arm_share;
use super::curve::{Table, monotone_cubic};
use super::cuts::{BodyFrame, BodyLines};
use super::hand::{DigitMap, FADE, HandMap};
use super::relief::MOST_ROWS;
use super::slice_scales::Scales;
use super::{ARM_STATIONS, LEG_STATIONS, Profile, Row, TORSO_STATIONS, station_at, stations};
use crate::geometry::slice::Planes;
use crate::geometry::{Moved, outer, smoothstep, smoothstep_slope};
use crate::shape::product::part::{NECK, PART_COUNT, Part, PartWeights, TORSO};
use glam::{DMat3, DVec2, DVec3};

/// Up to this many half extents from the middle a slice is scaled as one: the surface itself is not quite at 1 everywhere.
const SURFACE: f64 = 1.1;
/// Rows of the tables: so many for a head length, and for an arm.
const ROWS_PER_HEAD: f64 = 100.0;
const ROWS_OF_ARM: usize = 200;
/// What is shorter than this, in head lengths, is smoothed out of the torso's functions: it joins torso and neck at the shoulder
/// line, and torso and legs so much below the crotch, where a jacket has its hem behind it.
const JOINING: f64 = 0.08;
/// A leg goes over from the torso's map to its own between these places from crotch (0) to ankle (1).
const LEG_FADE: (f64, f64) = (-0.10, 0.10);
/// A neck's surface, in its radii: collars lie on it.
const NECK_REACH: f64 = 1.2;
/// Half extents where a body has none that were measured, in head lengths; nothing is scaled there.
const ANY_HALF: f64 = 0.4;
/// The toe box begins behind the ankle, in head lengths, and is whole at this part of the way from ankle to toes.
const TOE_BOX: (f64, f64) = (0.05, 0.6);

const LEFT_ARM: usize = Part::LeftUpperArm as usize;
const RIGHT_ARM: usize = Part::RightUpperArm as usize;
const LEFT_HAND: usize = Part::LeftHand as usize;
const RIGHT_HAND: usize = Part::RightHand as usize;
const LEFT_LEG: usize = Part::LeftUpperLeg as usize;
const RIGHT_LEG: usize = Part::RightUpperLeg as usize;
const LEFT_FOOT: usize = Part::LeftFoot as usize;
const RIGHT_FOOT: usize = Part::RightFoot as usize;

/// By height, of the torso and what hangs from it below the crotch: scale, scale, half, half, forward, shift forward.
type TorsoTable = Table<6>;
/// By height, of a leg: outward, and the same.
type LegTable = Table<7>;

/// The map.
#[derive(Clone, Debug)]
pub struct BodyMap {
    frame: BodyFrame,
    torso: TorsoTable,
    leg: LegTable,
    spread: f64,
    arms: [Option<ArmMap>; 2],
    feet: [FootMap; 2],
    /// As a row of the torso's, the same at all heights.
    neck: [f64; 6],
}

#[derive(Clone, Debug, PartialEq)]
struct ArmMap {
    planes: Planes,
    /// Where the shoulder joint goes, less where it was.
    base: DVec3,
    length: f64,
    /// By the place along the arm, model units: how much further it goes, scales, halves, middles.
    table: Table<7>,
    /// Where along and beside it the elbow is, and how much longer the bones become.
    elbow: (f64, DVec2),
    bone_scale: f64,
    /// What is done to each finger before all else, thumb first.
    digits: [Option<DigitMap>; 5],
    /// What is done to the hand in place of what is done to the arm, from this place along it on.
    hand: Option<(f64, HandMap)>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct FootMap {
    ankle: DVec3,
    to: DVec3,
    /// Forward, across, and how much higher the toes' surface becomes.
    scale: [f64; 3],
    /// Of that surface, and the toe box.
    toe_height: f64,
    toe_box: (f64, f64),
    sole: f64,
}

/// The first part of the chain that part number `part` goes with: those of one chain go one way.
pub fn chain_of(part: usize, is_skirt: bool) -> usize {
    match part {
        LEFT_LEG..=RIGHT_FOOT if is_skirt => TORSO,
        LEFT_HAND | RIGHT_HAND => part,
        LEFT_ARM..RIGHT_ARM => LEFT_ARM,
        RIGHT_ARM..LEFT_LEG => RIGHT_ARM,
        LEFT_LEG..LEFT_FOOT => LEFT_LEG,
        RIGHT_LEG..RIGHT_FOOT => RIGHT_LEG,
        _ => part,
    }
}

impl BodyMap {
    /// The map that does what `scales` say to a body of profile `own` in `frame`.
    ///
    /// - `place`: where heights come to lie in the result, in its heads.
    pub fn new(
        own: &Profile,
        lines: &BodyLines,
        frame: &BodyFrame,
        scales: &Scales,
        place: impl Fn(f64) -> f64,
    ) -> Self {
        let length = frame.head_length();
        let (torso, leg) = level_tables(own, frame, scales, place);
        let neck_half = NECK_REACH * own.neck.unwrap_or(ANY_HALF / 2.0) * length;
        let mut map = Self {
            frame: frame.clone(),
            torso,
            leg,
            spread: if own.leg.is_some() { scales.spread * length } else { 0.0 },
            arms: [None, None],
            feet: [0, 1].map(|side| FootMap::still(frame.limbs[2 + side].end, frame.heights.sole)),
            neck: [scales.neck, scales.neck, neck_half, neck_half, frame.shoulders.z, 0.0],
        };
        if let Some(foot) = own.foot {
            map.feet = [0, 1].map(|side| map.foot(side, foot, scales));
        }
        map.arms = [0, 1].map(|side| map.arm(side, own, lines, scales));
        map
    }

    /// By part, whether [`Self::part`] does what the same body's map `other` does.
    pub fn common(&self, other: &Self) -> [bool; PART_COUNT] {
        // Limbs begin with the torso's map, and skirts keep to it.
        let torso = self.torso == other.torso;
        let own = |part: usize| match chain_of(part, false) {
            NECK => self.neck == other.neck,
            LEFT_ARM | LEFT_HAND => self.arms[0] == other.arms[0],
            RIGHT_ARM | RIGHT_HAND => self.arms[1] == other.arms[1],
            LEFT_LEG | RIGHT_LEG => self.leg == other.leg && self.spread == other.spread,
            LEFT_FOOT | RIGHT_FOOT => self.feet == other.feet,
            _ => true,
        };
        std::array::from_fn(|part| torso && own(part))
    }

    /// Where `p` goes before the map of part number `part`.
    ///
    /// - `is_skirt`: what the legs move of it follows the torso's map, as skirts do.
    #[inline(always)]
    pub fn part<M: Moved>(&self, part: usize, p: DVec3, is_skirt: bool) -> M {
        match chain_of(part, is_skirt) {
            TORSO => self.torso(p),
            NECK => level(p, [self.frame.middle_x; 2], self.neck, || (0.0, [0.0; 6])),
            LEFT_ARM | RIGHT_ARM => self.arm_or_torso(usize::from(part >= RIGHT_ARM), p),
            LEFT_HAND | RIGHT_HAND => self.hand_or_arm(usize::from(part >= RIGHT_HAND), p),
            LEFT_LEG | RIGHT_LEG => self.leg_or_torso(usize::from(part >= RIGHT_LEG), p),
            LEFT_FOOT => self.feet[0].map(p),
            RIGHT_FOOT => self.feet[1].map(p),
            _ => M::of(p, || DMat3::IDENTITY),
        }
    }

    /// Where `p` goes first, so much of which is of each finger, thumb first, on the side that `weights` tell.
    #[inline(never)]
    pub fn digits<M: Moved>(&self, p: DVec3, weights: &PartWeights, shares: [f32; 5]) -> M {
        let side = usize::from(arm_share(weights, 1) > arm_share(weights, 0));
        let digits = self.arms[side].iter().flat_map(|arm| &arm.digits).zip(shares);
        let counts = digits.filter(|&(_, share)| share > 0.0);
        let of = || counts.clone().filter_map(|(digit, share)| Some((digit.as_ref()?, f64::from(share))));
        let moved = of().map(|(digit, share)| share * digit.way(p).0).sum::<DVec3>();
        M::of(p + moved, || of().fold(DMat3::IDENTITY, |sum, (digit, share)| sum + digit.way(p).1 * share))
    }

    /// As [`Self::part`], for what hangs on the bones of the arm on side `side`: what lies on a bone goes along it, so that
    /// the arm keeps its angles.
    pub fn on_bones<M: Moved>(&self, p: DVec3, side: usize) -> M {
        match &self.arms[side] {
            Some(arm) => arm.map(p, true),
            None => self.torso(p),
        }
    }

    /// What the torso, and what hangs from it, is mapped by.
    pub fn torso<M: Moved>(&self, p: DVec3) -> M {
        let at = self.torso.at(p.y);
        level(p, [self.frame.middle_x; 2], at.values(), || (0.0, at.slopes()))
    }

    fn leg<M: Moved>(&self, side: usize, p: DVec3) -> M {
        let at = self.leg.at(p.y);
        let sign = self.frame.signs[2 + side];
        let [outward, row @ ..] = at.values();
        let middle = self.frame.middle_x + sign * outward;
        level(p, [middle, middle + sign * self.spread], row, || {
            let [outward, row @ ..] = at.slopes();
            (sign * outward, row)
        })
    }

    /// Near the crotch a leg's map is the torso's, so that hips agree whatever the weights say.
    fn leg_or_torso<M: Moved>(&self, side: usize, p: DVec3) -> M {
        let BodyFrame { heights, leg_length, .. } = self.frame;
        let t = (heights.crotch - p.y) / leg_length;
        let (share, slope) = smoothstep_slope((t - LEG_FADE.0) / (LEG_FADE.1 - LEG_FADE.0));
        let slope = DVec3::NEG_Y * (slope / (LEG_FADE.1 - LEG_FADE.0) / leg_length);
        mix(share, slope, || self.torso(p), || self.leg(side, p))
    }

    fn arm_or_torso<M: Moved>(&self, side: usize, p: DVec3) -> M {
        self.arms[side].as_ref().map_or_else(|| self.torso(p), |arm| arm.map(p, false))
    }

    /// Before the wrist what a hand moves goes over to the arm's map, as soft weights reach far.
    fn hand_or_arm<M: Moved>(&self, side: usize, p: DVec3) -> M {
        let on_arm = || self.arm_or_torso(side, p);
        let Some((arm, (from, hand))) = self.arms[side].as_ref().and_then(|arm| Some((arm, arm.hand?)))
        else {
            return on_arm();
        };
        let fade = FADE * hand.length();
        let (share, slope) = smoothstep_slope((arm.planes.locate(p).0 - from) / fade + 1.0);
        mix(share, arm.planes.axis * (slope / fade), on_arm, || hand.map(p))
    }

    fn foot(&self, side: usize, [toe, .., height]: [f64; 5], scales: &Scales) -> FootMap {
        let (ankle, length) = (self.frame.limbs[2 + side].end, self.frame.head_length());
        let to = self.leg_or_torso(side, ankle);
        let toe_box = (ankle.z + TOE_BOX.0 * length, ankle.z + TOE_BOX.1 * toe * length);
        FootMap { to, scale: scales.foot, toe_height: height * length, toe_box, ..self.feet[side] }
    }

    fn arm(&self, side: usize, own: &Profile, lines: &BodyLines, scales: &Scales) -> Option<ArmMap> {
        let frame = &self.frame;
        let planes = frame.arm_planes(side)?;
        let (profile, middles) = (own.arm.as_ref()?, lines.arm_middles[side].as_ref()?);
        let (head, length) = (frame.head_length(), frame.arm_lengths[side]);
        let places = stations(ARM_STATIONS);
        let [long, broad, thin] = scales.hand;
        let table = Table::sample(-0.2 * length, 2.0 * length, ROWS_OF_ARM, |s| {
            let at = |row: &Row| monotone_cubic(&places, row, s / length);
            [
                (scales.arm_length - 1.0) * s.clamp(0.0, length) + (long - 1.0) * (s - length).max(0.0),
                at(&scales.arm.breadth),
                at(&scales.arm.depth),
                head * at(&profile.breadth),
                head * at(&profile.depth),
                at(&middles[0]),
                at(&middles[1]),
            ]
        });
        let base = self.torso::<DVec3>(planes.origin) - planes.origin;
        let elbow = planes.locate(frame.limbs[side].middle);
        let bone_scale = scales.arm_length;
        let digits = frame.closed_digits(side, scales.mitt);
        let mut arm = ArmMap { planes, base, length, table, elbow, bone_scale, digits, hand: None };
        arm.hand = lines.hands[side].map(|hand| {
            let to = arm.map(hand.planes.origin, false);
            // No later than its thumb: the joint of some hands lies in the palm.
            let from = frame.digits[side][0].map_or(length, |[root, _]| planes.locate(root).0.min(length));
            (from, HandMap { hand, scale: DVec3::new(long, thin, broad), share: scales.mitt, to })
        });
        Some(arm)
    }
}

/// Where an arm's bones are at `s` from shoulder joint (0) to wrist, by where its elbow is, and the slope there.
pub(super) fn on_bones((bend, elbow): (f64, DVec2), length: f64, s: f64) -> [DVec2; 2] {
    let (away, slope) =
        if s < bend { (s, 1.0 / bend) } else { (length - s, -1.0 / (length - bend).max(1e-30)) };
    if away > 0.0 { [away * slope.abs() * elbow, slope * elbow] } else { [DVec2::ZERO; 2] }
}

impl ArmMap {
    /// `about_bones`: slices grow about the bones in place of their own middles.
    fn map<M: Moved>(&self, p: DVec3, about_bones: bool) -> M {
        let (s, place) = self.planes.locate(p);
        let at = self.table.at(s);
        let row = at.values();
        let [bone, bone_slope] = on_bones(self.elbow, self.length, s);
        let middles =
            if about_bones { [bone, self.bone_scale * bone] } else { [DVec2::new(row[5], row[6]); 2] };
        let across = slab(place.x - middles[0].x, row[1], row[3]);
        let front = slab(place.y - middles[0].y, row[2], row[4]);
        let to = middles[1] + DVec2::new(across.to, front.to);
        M::of(self.base + self.planes.point(s + row[0], to), || {
            let slopes = at.slopes();
            let line = DVec2::new(slopes[5], slopes[6]);
            let leans = if about_bones { [bone_slope, self.bone_scale * bone_slope] } else { [line; 2] };
            let across_slope = across.by_scale * slopes[1] + across.by_half * slopes[3] + leans[1].x
                - across.by_place * leans[0].x;
            let front_slope = front.by_scale * slopes[2] + front.by_half * slopes[4] + leans[1].y
                - front.by_place * leans[0].y;
            let axes = DMat3::from_cols(self.planes.axis, self.planes.across, self.planes.front);
            let local = DMat3::from_cols(
                DVec3::new(1.0 + slopes[0], across_slope, front_slope),
                DVec3::new(0.0, across.by_place, 0.0),
                DVec3::new(0.0, 0.0, front.by_place),
            );
            axes * local * axes.transpose()
        })
    }
}

impl FootMap {
    /// The map of a foot that stays as it is.
    fn still(ankle: DVec3, sole: f64) -> Self {
        Self { ankle, to: ankle, scale: [1.0; 3], toe_height: 1.0, toe_box: (0.0, 1.0), sole }
    }

    /// Linear about the ankle, so that the instep of a high heel is not sheared over; the toe box grows up from the sole, which
    /// stays as flat as it was: from the sole to the toes' top what is added grows by a smooth step.
    fn map<M: Moved>(&self, p: DVec3) -> M {
        let arm = p - self.ankle;
        let [length, breadth, toes] = self.scale;
        let (share, slope) = smoothstep_slope((p.z - self.toe_box.0) / (self.toe_box.1 - self.toe_box.0));
        let slope = slope / (self.toe_box.1 - self.toe_box.0);
        let (up, up_slope) = smoothstep_slope((p.y - self.sole) / self.toe_height);
        let added = (toes - 1.0) * self.toe_height;
        let (x, z) = (self.to.x + breadth * arm.x, self.to.z + length * arm.z);
        M::of(DVec3::new(x, p.y + added * share * up, z), || {
            DMat3::from_cols(
                DVec3::X * breadth,
                DVec3::Y * (1.0 + (toes - 1.0) * share * up_slope),
                DVec3::new(0.0, added * slope * up, length),
            )
        })
    }
}

/// `share` of the second map and the rest of the first, where the share changes by `slope`.
fn mix<M: Moved>(share: f64, slope: DVec3, first: impl Fn() -> M, second: impl Fn() -> M) -> M {
    if share <= 0.0 {
        return first();
    }
    if share >= 1.0 {
        return second();
    }
    let (first, second) = (first(), second());
    let apart = second.position() - first.position();
    M::of(first.position() + share * apart, || {
        first.jacobian() * (1.0 - share) + second.jacobian() * share + outer(apart, slope)
    })
}

/// Where `p` goes, at its height, by the slice there: its middle across, and where that goes, and the row of a [`TorsoTable`].
///
/// - `slopes`: by height, of that middle and of the row.
#[inline(always)]
fn level<M: Moved>(
    p: DVec3,
    [middle, to]: [f64; 2],
    [x_scale, z_scale, x_half, z_half, forward, shift]: [f64; 6],
    slopes: impl FnOnce() -> (f64, [f64; 6]),
) -> M {
    let x = slab(p.x - middle, x_scale, x_half);
    let z = slab(p.z - forward, z_scale, z_half);
    M::of(DVec3::new(to + x.to, p.y, forward + shift + z.to), || {
        let (middle, [x_scale, z_scale, x_half, z_half, forward, shift]) = slopes();
        let x_slope = x.by_scale * x_scale + x.by_half * x_half + (1.0 - x.by_place) * middle;
        let z_slope = z.by_scale * z_scale + z.by_half * z_half + (1.0 - z.by_place) * forward + shift;
        DMat3::from_cols(DVec3::X * x.by_place, DVec3::new(x_slope, 1.0, z_slope), DVec3::Z * z.by_place)
    })
}

/// Torso and legs by height, model units.
fn level_tables(
    own: &Profile,
    frame: &BodyFrame,
    scales: &Scales,
    place: impl Fn(f64) -> f64,
) -> (TorsoTable, LegTable) {
    let length = frame.head_length();
    let planes = frame.torso_planes();
    let (torso_length, leg_length) = (frame.torso_length(), frame.leg_length);
    let (crotch, shoulder_line, chin) =
        (frame.heights.crotch, frame.heights.shoulder_line, frame.heights.chin);
    let torso_places = stations(TORSO_STATIONS);
    let leg_places = stations(LEG_STATIONS);
    let of_leg = |y: f64| -> [f64; 7] {
        let t = (crotch - y) / leg_length;
        let Some(leg) = &own.leg else {
            let half = ANY_HALF / 2.0 * length;
            return [half, 1.0, 1.0, half, half, planes.origin.z, 0.0];
        };
        let at = |row: &Row| monotone_cubic(&leg_places, row, t);
        [
            length * at(&leg.outward),
            at(&scales.leg.breadth),
            at(&scales.leg.depth),
            length * at(&leg.breadth),
            length * at(&leg.depth),
            planes.origin.z + length * at(&leg.forward),
            length * at(&scales.leg_shift),
        ]
    };
    let of_torso = |y: f64| -> [f64; 6] {
        let t = (y - crotch) / torso_length;
        let neck = smoothstep((y - shoulder_line) / (chin - shoulder_line).max(1e-3 * length));
        let at = |row: &Row| monotone_cubic(&torso_places, row, t);
        let top = smoothstep((t - TORSO_STATIONS.1) / (1.0 - TORSO_STATIONS.1));
        let scale = |row: &Row, axis: usize| at(row) * scales.torso_top[axis].powf(top);
        let to_neck = |scale: f64| scale * (scales.neck / scale).powf(neck);
        let half = |row: Option<&Row>| length * row.map_or(ANY_HALF, at);
        let torso = own.torso.as_ref();
        [
            to_neck(scale(&scales.torso.breadth, 0)),
            to_neck(scale(&scales.torso.depth, 1)),
            half(torso.map(|torso| &torso.breadth)),
            half(torso.map(|torso| &torso.depth)),
            planes.origin.z + length * torso.map_or(0.0, |torso| at(&torso.forward)),
            0.0,
        ]
    };
    // Below the crotch: the hull of both legs, or the skirt.
    let below = |y: f64| -> [f64; 6] {
        let [outward, scale_x, scale_z, half_x, half_z, forward, shift] = of_leg(y);
        if own.leg.is_none() {
            return of_torso(crotch);
        }
        if scales.skirt.is_empty() {
            let hull = outward + half_x;
            let new_hull = outward + scales.spread * length + scale_x * half_x;
            return [new_hull / hull, scale_z, hull, half_z, forward, shift];
        }
        let t = (crotch - y) / leg_length;
        let places: Vec<f64> =
            scales.skirt.iter().map(|skirt| station_at(LEG_STATIONS, skirt.station)).collect();
        let at = |number: &dyn Fn(&super::slice_scales::SkirtScale) -> f64| {
            let knots: Vec<f64> = scales.skirt.iter().map(number).collect();
            monotone_cubic(&places, &knots, t)
        };
        [
            at(&|skirt| skirt.scale[0]),
            at(&|skirt| skirt.scale[1]),
            length * at(&|skirt| skirt.half[0]),
            length * at(&|skirt| skirt.half[1]),
            planes.origin.z + length * at(&|skirt| skirt.forward),
            length * at(&|skirt| skirt.shift),
        ]
    };
    // Just below the crotch: as broad as the torso's lowest slice, or as what is below where that is more.
    let hem = |y: f64| -> [f64; 6] {
        let (mut row, under) = (of_torso(y), below(y));
        for (scale, half) in [(0, 2), (1, 3)] {
            let wider = row[half].max(under[half]);
            row[scale] = (row[scale] * row[half]).max(under[scale] * under[half]) / wider;
            row[half] = wider;
        }
        row
    };
    let (up, down) = (chin - crotch, crotch - frame.heights.sole);
    let step = (length / ROWS_PER_HEAD).max(up.max(down) / MOST_ROWS);
    // The torso begins halfway between two rows: where it lay on one, last digits would tell to which side that belongs.
    let rows = |way: f64| ((way + 0.3 * length) / step).ceil().max(1.0) + 0.5;
    let (below_crotch, above) = (rows(down), rows(up));
    let (start, end) = (crotch - below_crotch * step, crotch + above * step);
    let count = (below_crotch + above) as usize + 1;
    let lowest = place(crotch) - JOINING;
    let torso = Table::sample(start, end, count, |y| match y {
        _ if y >= crotch => of_torso(y),
        _ if place(y) >= lowest => hem(y),
        _ => below(y),
    });
    (torso.smoothed(JOINING, place), Table::sample(start, end, count, of_leg))
}

/// Where a scale takes a place, and its partial derivatives.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Slab {
    /// The new place.
    pub to: f64,
    /// By the place; above 0.
    pub by_place: f64,
    /// By the scale.
    pub by_scale: f64,
    /// By the half extent.
    pub by_half: f64,
}

/// Where `place`, from the middle of a slice of half extent `half`, above 0, goes where that is scaled by `scale`, above 0.
///
/// Within the surface by `scale`; beyond it with a slope that goes over to 1 (to `scale`, where that is less) within one half
/// extent: cloth, straps and backpacks move with the surface and are not inflated. The slope is above 0 everywhere, so nothing
/// folds. With q = |place| / half and x = q - 1.1 > 0: half (1.1 S + k x + (S - k) h(x)), k = min(S, 1),
/// h = x - x^3 + x^4 / 2 up to x = 1 and 1 / 2 beyond.
#[inline]
pub fn slab(place: f64, scale: f64, half: f64) -> Slab {
    let q = place.abs() / half;
    if q <= SURFACE {
        return Slab { to: scale * place, by_place: scale, by_scale: place, by_half: 0.0 };
    }
    let x = q - SURFACE;
    let (h, h_slope) = if x < 1.0 {
        let x2 = x * x;
        (x - x2 * x + 0.5 * x2 * x2, 1.0 - 3.0 * x2 + 2.0 * x2 * x)
    } else {
        (0.5, 0.0)
    };
    let k = scale.min(1.0);
    let outside = SURFACE * scale + k * x + (scale - k) * h;
    let slope = k + (scale - k) * h_slope;
    let by_scale = if scale > 1.0 { SURFACE + h } else { q };
    let sign = place.signum();
    Slab {
        to: sign * half * outside,
        by_place: slope,
        by_scale: sign * half * by_scale,
        by_half: sign * (outside - q * slope),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_surface_is_scaled_and_what_lies_on_it_moves_along() {
        // Worked by hand from the formula, to its last digits.
        for (scale, places, wanted) in [
            (1.5, vec![0.5, 1.0, 1.2, 1.6, 2.1, 3.0], vec![0.75, 1.5, 1.79954, 2.35313, 2.9, 3.8]),
            (0.7, vec![0.5, 1.2, 2.0], vec![0.35, 0.84, 1.4]),
        ] {
            for (place, wanted) in places.into_iter().zip(wanted) {
                for sign in [-1.0, 1.0] {
                    let to = slab(sign * place, scale, 1.0).to;
                    assert!((to - sign * wanted).abs() < 1e-4, "{place} {scale}: {to}");
                    let doubled = slab(2.0 * sign * place, scale, 2.0).to;
                    assert!((doubled - 2.0 * to).abs() < 1e-12);
                }
            }
        }
    }

    #[test]
    fn derivatives_are_those_of_the_place() {
        let h = 1e-6;
        for place in [-2.7, -1.3, -0.4, 0.2, 1.05, 1.15, 1.9, 2.4] {
            for scale in [0.6, 1.0, 1.7] {
                for half in [0.8, 1.3] {
                    let at = slab(place, scale, half);
                    let slope = |f: &dyn Fn(f64) -> f64| (f(h) - f(-h)) / (2.0 * h);
                    for (found, wanted) in [
                        (at.by_place, slope(&|d| slab(place + d, scale, half).to)),
                        // At a scale of 1 the limit of what lies outside has a kink; both sides' mean is taken.
                        (at.by_half, slope(&|d| slab(place, scale, half + d).to)),
                    ] {
                        assert!((found - wanted).abs() < 1e-5, "{place} {scale} {half}: {found} {wanted}");
                    }
                    assert!(at.by_place > 0.0);
                    if scale != 1.0 {
                        let wanted = slope(&|d| slab(place, scale + d, half).to);
                        assert!((at.by_scale - wanted).abs() < 1e-5, "{place} {scale}");
                    }
                }
            }
        }
    }
}
