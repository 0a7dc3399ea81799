//! Measures a profile: some seventy cuts, each read around the bones.

use super::chains::{Chain, Chains};
use super::curve::{smooth, smooth_lengths};
use super::hand::{DigitMap, HandBox, HandSizes};
use super::map::on_bones;
use super::station::{Slice, hits, slice_around};
use super::{
    ARM_STATIONS, ArmProfile, LEG_STATIONS, LegProfile, Profile, Row, STATIONS, SkirtProfile, TORSO_STATIONS,
    TorsoProfile, stations,
};
use crate::character::Role;
use crate::geometry::slice::{Outline, Planes, slices};
use crate::geometry::weld::Weld;
use crate::geometry::{mean, range, upper_median};
use crate::parallel;
use crate::shape::figure::Figure;
use crate::shape::heights::Heights;
use crate::shape::product::anatomy::{Anatomy, Limb, Proportions};
use crate::shape::product::part::digits;
use glam::{DVec2, DVec3};

/// What reaches further than this over the middle is no leg, in head lengths.
const OVER_MIDDLE: f64 = 0.012;
/// What reaches as far as this over it on both sides is a skirt.
pub(super) const SKIRT_OVER_MIDDLE: f64 = 0.05;
/// Beyond a wrist and under an ankle is what lies this much further, in head lengths: a ring of vertices at the joint itself is
/// not, whatever its last digits are.
pub(super) const BEYOND: f64 = 1e-3;
/// A neck is read at these heights between shoulder line and chin.
const NECK_HEIGHTS: [f64; 3] = [0.45, 0.6, 0.75];
/// A neck is no thicker than this, in head lengths, an adult's .27: what lies further out is a collar or a scarf.
const THICKEST_NECK: f64 = 0.29;
/// A knee further off the line from hip to ankle than this part of the leg's length is bent, and its slices are no leg's.
const BENT: f64 = 0.25;
/// The toes' height is this quantile of what lies in front of this part of the way from ankle to toe.
const TOES_TOP: f64 = 0.97;
const TOES_FROM: f64 = 0.4;

/// Where a body's chains lie: heights and joints.
#[derive(Clone, Debug)]
pub struct BodyFrame {
    /// The landmarks.
    pub heights: Heights,
    /// Left arm, right arm, left leg, right leg; legs begin at the height of the crotch.
    pub limbs: [Limb; 4],
    /// On which side of the middle each limb is: in left-handed axes the left is at negative x.
    pub signs: [f64; 4],
    /// From the crotch to the ankles, model units.
    pub leg_length: f64,
    /// Shoulder joint to wrist, straight, model units.
    pub arm_lengths: [f64; 2],
    /// The middle between the hip joints.
    pub hips: DVec3,
    /// The middle between the shoulder joints.
    pub shoulders: DVec3,
    /// The plane that halves the body.
    pub middle_x: f64,
    /// The first and the last joint of each finger, thumb first.
    pub digits: [[Option<[DVec3; 2]>; 5]; 2],
}

impl BodyFrame {
    /// The frame of a figure as it stands.
    pub fn of(figure: &Figure, anatomy: &Anatomy) -> Self {
        let limbs = anatomy.limbs;
        let middle = |p: DVec3| p.with_x(anatomy.middle_x);
        let hips: Vec<DVec3> = [Role::LeftUpperLeg, Role::RightUpperLeg]
            .iter()
            .filter_map(|&role| figure.role_position(role))
            .collect();
        let digit = |roles: [Role; 3]| {
            let [root, middle, end] = roles.map(|role| figure.role_position(role));
            let (root, end) = (root.or(middle)?, end.or(middle)?);
            (root.distance(end) > 0.0).then_some([root, end])
        };
        let digits_of = |side: usize| digits(side == 0).map(digit);
        let heights = anatomy.landmarks.heights;
        let sign = |limb: usize| if limbs[limb].end.x < limbs[limb ^ 1].end.x { -1.0 } else { 1.0 };
        Self {
            heights,
            limbs,
            signs: [0, 1, 2, 3].map(sign),
            leg_length: heights.crotch - (limbs[2].end.y + limbs[3].end.y) / 2.0,
            arm_lengths: [0, 1].map(|side| limbs[side].root.distance(limbs[side].end)),
            digits: [0, 1].map(digits_of),
            hips: middle(hips.iter().sum::<DVec3>() / hips.len().max(1) as f64),
            shoulders: middle((limbs[0].root + limbs[1].root) / 2.0),
            middle_x: anatomy.middle_x,
        }
    }

    /// L: chin to crown.
    pub fn head_length(&self) -> f64 {
        self.heights.head_length()
    }

    /// The torso's own axis, from the crotch (0) up; heights in model units.
    pub fn torso_planes(&self) -> Planes {
        let origin = DVec3::new(self.middle_x, self.heights.crotch, self.hips.z);
        Planes { origin, axis: DVec3::Y, across: DVec3::X, front: DVec3::Z }
    }

    /// The line through the middles of a torso's slices: (height, z), rising; without them the hips alone.
    pub fn centre_line(&self, torso: Option<&TorsoProfile>) -> Vec<(f64, f64)> {
        let Some(torso) = torso else { return vec![(self.hips.y, self.hips.z)] };
        let point = |(t, forward)| {
            (self.heights.crotch + t * self.torso_length(), self.hips.z + self.head_length() * forward)
        };
        stations(TORSO_STATIONS).into_iter().zip(torso.forward).map(point).collect()
    }

    /// The planes of both legs, from the crotch (0) down.
    pub fn leg_planes(&self) -> Planes {
        Planes { axis: DVec3::NEG_Y, ..self.torso_planes() }
    }

    /// The place in these planes of the bones of limb number `limb`, a leg, at `height`.
    pub(super) fn leg_bone(&self, limb: usize, height: f64) -> DVec2 {
        let planes = self.leg_planes();
        planes.locate(on_limb(&self.limbs[limb], planes.origin.y - height)).1
    }

    /// The planes of the arm on one side, from the shoulder joint (0) to the wrist; `None` where they coincide.
    pub fn arm_planes(&self, side: usize) -> Option<Planes> {
        let limb = &self.limbs[side];
        let axis = (limb.end - limb.root).try_normalize()?;
        // An arm that points forward has its front above.
        let front = DVec3::Z.reject_from_normalized(axis);
        let front = if front.length() > 0.1 { front } else { DVec3::Y.reject_from_normalized(axis) };
        let front = front.normalize();
        let up = front.cross(axis);
        let up = if up.dot(DVec3::Y) < 0.0 { -up } else { up };
        Some(Planes { origin: limb.root, axis, across: up, front })
    }

    /// Along the palm of one hand, from the wrist to the middle of the fingers' roots, and away from it, unit vectors; `None` where
    /// fewer than two fingers beside the thumb have joints.
    fn palm(&self, side: usize) -> Option<[DVec3; 2]> {
        let roots: Vec<DVec3> = self.digits[side][1..].iter().flatten().map(|[root, ..]| *root).collect();
        let along = roots.iter().sum::<DVec3>() / roots.len().max(1) as f64 - self.limbs[side].end;
        let along = along.try_normalize()?;
        Some([along, (roots.last()? - roots.first()?).cross(along).try_normalize()?])
    }

    /// What is done to the fingers of a hand that becomes `share` of a mitt, thumb first.
    pub(super) fn closed_digits(&self, side: usize, share: f64) -> [Option<DigitMap>; 5] {
        let palm = self.palm(side).filter(|_| share > 0.0);
        std::array::from_fn(|digit| Some(DigitMap::closed(digit, self.digits[side][digit]?, palm?, share)))
    }

    /// From the torso's bottom to its top, model units.
    pub fn torso_length(&self) -> f64 {
        self.heights.shoulder_line - self.heights.crotch
    }

    /// A number for each slice of a leg: `upper` above the knee, `lower` from there on.
    pub fn leg_row(&self, [upper, lower]: [f64; 2]) -> Row {
        let knees = (self.limbs[2].middle.y + self.limbs[3].middle.y) / 2.0;
        let knee = (self.heights.crotch - knees) / self.leg_length;
        stations(LEG_STATIONS).map(|t| if t < knee { upper } else { lower })
    }

    /// A number for each slice of an arm: `upper` before the elbow, `lower` from there on.
    pub fn arm_row(&self, [upper, lower]: [f64; 2]) -> Row {
        let to_elbow: f64 = self.limbs[..2].iter().map(|limb| limb.root.distance(limb.middle)).sum();
        let to_wrist: f64 = self.limbs[..2].iter().map(|limb| limb.middle.distance(limb.end)).sum();
        let elbow = to_elbow / (to_elbow + to_wrist);
        stations(ARM_STATIONS).map(|t| if t < elbow { upper } else { lower })
    }

    /// `proportions` with the widths that the profile `own` has, in model units: half the torso's breadth and the limbs' radii,
    /// each the median of its slices.
    pub fn with_widths(&self, own: &Profile, proportions: &Proportions) -> Proportions {
        let length = self.head_length();
        let radius = |extents: Option<[&Row; 2]>, row: Row| {
            let [breadth, depth] = extents?;
            let slices = (0..STATIONS).filter(|&at| row[at] > 0.0);
            upper_median(slices.map(|at| length * (breadth[at] * depth[at]).sqrt()))
        };
        let arm = own.arm.as_ref().map(|arm| [&arm.breadth, &arm.depth]);
        let leg = own.leg.as_ref().map(|leg| [&leg.breadth, &leg.depth]);
        let torso = own.torso.as_ref();
        Proportions {
            torso_half_width: torso.and_then(|torso| upper_median(torso.breadth.map(|half| length * half))),
            upper_arm_radius: radius(arm, self.arm_row([1.0, 0.0])),
            lower_arm_radius: radius(arm, self.arm_row([0.0, 1.0])),
            upper_leg_radius: radius(leg, self.leg_row([1.0, 0.0])),
            lower_leg_radius: radius(leg, self.leg_row([0.0, 1.0])),
            ..proportions.clone()
        }
    }
}

/// What a map needs of its own figure beside the profile: the middles of its arms' slices and hands, in each arm's planes.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct BodyLines {
    /// Left, right; smoothed, model units.
    pub arm_middles: [Option<[Row; 2]>; 2],
    /// What hands fill whose fingers are closed as a mitt's, model units.
    pub hands: [Option<HandBox>; 2],
    /// See there.
    pub hand_sizes: Option<HandSizes>,
}

/// Measures the profile of a figure whose vertices are at `positions`.
///
/// - `chains`: which of them each vertex belongs to. `weld`: the vertices by position.
/// - `threads`: at most this many, 0 for all cores.
///
/// O(triangles), some seventy cuts.
pub fn measure_profile(
    figure: &Figure,
    positions: &[DVec3],
    chains: &Chains,
    weld: &Weld,
    frame: &BodyFrame,
    threads: usize,
) -> (Profile, BodyLines) {
    let body = Body { figure, positions, chains, weld, frame, length: frame.head_length() };
    let trunk = || {
        let triangles = body.triangles(Chain::Trunk);
        (body.torso(&triangles), body.legs(&triangles), body.neck(&triangles))
    };
    let limbs = || {
        // One vertex at each place: quantiles must not depend on how often seams repeat it.
        let places = weld.first_vertices();
        (body.arms(), body.hands(&places), body.foot(&places))
    };
    let ((torso, (leg, skirt), neck), ((arm, arm_middles), (hands, hand_sizes), foot)) =
        parallel::both(body.worth(threads), trunk, limbs);
    let length = body.length;
    let profile = Profile {
        torso,
        leg,
        arm,
        skirt,
        hand: hand_sizes.map(|[open, ..]| open),
        foot,
        neck,
        shoulder: (0..2).map(|side| (frame.limbs[side].root.x - frame.middle_x).abs()).sum::<f64>()
            / (2.0 * length),
        arm_length: (frame.arm_lengths[0] + frame.arm_lengths[1]) / (2.0 * length),
    };
    (profile.sound(), BodyLines { arm_middles, hands, hand_sizes })
}

/// A body to be measured, as it is now.
pub(super) struct Body<'a> {
    pub(super) figure: &'a Figure,
    pub(super) positions: &'a [DVec3],
    pub(super) chains: &'a Chains,
    pub(super) weld: &'a Weld,
    pub(super) frame: &'a BodyFrame,
    /// L.
    pub(super) length: f64,
}

impl Body<'_> {
    /// As many of these threads as are worth it.
    pub(super) fn worth(&self, threads: usize) -> usize {
        if self.positions.len() < parallel::FEW { 1 } else { threads }
    }

    /// Triangles of the body and its clothes that are of `chain`.
    pub(super) fn triangles(&self, chain: Chain) -> Vec<[u32; 3]> {
        self.chains.triangles(self.figure, chain)
    }

    /// What `planes` at `heights` cut out of `triangles`.
    pub(super) fn cut(&self, triangles: &[[u32; 3]], planes: &Planes, heights: &[f64]) -> Vec<Vec<Outline>> {
        slices(self.positions, triangles, self.weld, planes, heights)
    }

    /// Whether an outline reaches further over the middle than that of limb number `limb`, a leg, does.
    pub(super) fn is_over(&self, limb: usize, outline: &Outline) -> bool {
        let (low, high) = outline.breadth();
        (if self.frame.signs[limb] > 0.0 { -low } else { high }) > OVER_MIDDLE * self.length
    }

    /// Middle across, middle in depth, half breadth, half depth of what `counts` of each cut, in head lengths; see
    /// [`slice_around`].
    fn rows(
        &self,
        cuts: &[Vec<Outline>],
        heights: &Row,
        counts: impl Fn(&Outline) -> bool,
        start: impl Fn(f64) -> DVec2,
        keeps_across: bool,
    ) -> [Row; 4] {
        let mut rows = [[f64::NAN; STATIONS]; 4];
        for (at, (outlines, &height)) in cuts.iter().zip(heights).enumerate() {
            let counted: Vec<&Outline> = outlines.iter().filter(|outline| counts(outline)).collect();
            let slice = slice_around(counted.into_iter(), start(height), keeps_across);
            if let Some(Slice { middle, half }) = slice {
                let numbers = [middle.x, middle.y, half.x, half.y];
                rows.iter_mut().zip(numbers).for_each(|(row, number)| row[at] = number / self.length);
            }
        }
        rows
    }

    fn torso(&self, triangles: &[[u32; 3]]) -> Option<TorsoProfile> {
        let planes = self.frame.torso_planes();
        let heights = stations(TORSO_STATIONS).map(|t| t * self.frame.torso_length());
        let shoulders = planes.locate(self.frame.shoulders);
        let cuts = self.cut(triangles, &planes, &heights);
        let start = |height: f64| DVec2::new(0.0, shoulders.1.y * height / shoulders.0);
        let rows = self.rows(&cuts, &heights, |_| true, start, true);
        smooth_rows(&rows).map(|[_, forward, breadth, depth]| TorsoProfile { breadth, depth, forward })
    }

    fn legs(&self, triangles: &[[u32; 3]]) -> (Option<LegProfile>, Option<SkirtProfile>) {
        let planes = self.frame.leg_planes();
        let heights = stations(LEG_STATIONS).map(|t| t * self.frame.leg_length);
        let cuts = self.cut(triangles, &planes, &heights);
        let mut sides: Vec<[Row; 4]> = Vec::new();
        for side in 2..4 {
            let sign = self.frame.signs[side];
            let limb = &self.frame.limbs[side];
            if bend(limb) > BENT * limb.root.distance(limb.end) {
                continue;
            }
            let bone = |height: f64| self.frame.leg_bone(side, height);
            let mut rows = self.rows(&cuts, &heights, |outline| !self.is_over(side, outline), bone, false);
            rows[0] = rows[0].map(|x| sign * x);
            sides.push(rows);
        }
        let rows = smooth_rows(&mean_rows(&sides));
        let leg =
            rows.map(|[outward, forward, breadth, depth]| LegProfile { outward, breadth, depth, forward });
        (leg, self.skirt(&cuts, &heights))
    }

    fn skirt(&self, cuts: &[Vec<Outline>], heights: &Row) -> Option<SkirtProfile> {
        let reach = SKIRT_OVER_MIDDLE * self.length;
        let is_skirt = |outline: &Outline| {
            let (low, high) = outline.breadth();
            low < -reach && high > reach
        };
        let start = |height: f64| {
            let forward = |leg: usize| self.frame.leg_bone(leg, height).y;
            DVec2::new(0.0, (forward(2) + forward(3)) / 2.0)
        };
        let rows = self.rows(cuts, heights, is_skirt, start, true);
        let [_, forward, breadth, depth] = rows.map(|row| row.map(|x| (!x.is_nan()).then_some(x)));
        breadth.iter().any(Option::is_some).then_some(SkirtProfile { breadth, depth, forward })
    }

    fn arms(&self) -> (Option<ArmProfile>, [Option<[Row; 2]>; 2]) {
        let mut sides: Vec<[Row; 4]> = Vec::new();
        let mut middles = [None, None];
        for (side, middle) in middles.iter_mut().enumerate() {
            let Some(planes) = self.frame.arm_planes(side) else { continue };
            let length = self.frame.arm_lengths[side];
            let heights = stations(ARM_STATIONS).map(|t| t * length);
            let elbow = planes.locate(self.frame.limbs[side].middle);
            let cuts = self.cut(&self.triangles(Chain::Arm(side)), &planes, &heights);
            let bone = |height: f64| on_bones(elbow, length, height)[0];
            let rows = self.rows(&cuts, &heights, |_| true, bone, false);
            let line = |row: &Row| smooth(row).map(|line| line.map(|x| x * self.length));
            *middle = line(&rows[0]).zip(line(&rows[1])).map(Into::into);
            sides.push(rows);
        }
        let [_, _, breadth, depth] = mean_rows(&sides);
        let arm =
            (|| Some(ArmProfile { breadth: smooth_lengths(&breadth)?, depth: smooth_lengths(&depth)? }))();
        (arm, middles)
    }

    /// To the toes, to the heel, half breadth, how far outward, height of the toes.
    fn foot(&self, places: &[u32]) -> Option<[f64; 5]> {
        let sides: Vec<[f64; 5]> = (2..4)
            .filter_map(|side| {
                let limb = &self.frame.limbs[side];
                let sign = self.frame.signs[side];
                let under = limb.end.y - BEYOND * self.length;
                let points: Vec<DVec3> = places
                    .iter()
                    .map(|&vertex| vertex as usize)
                    .filter(|&vertex| {
                        let is_of = |chain: Chain| self.chains.hold(vertex, chain);
                        is_of(Chain::Foot(side - 2))
                            || (is_of(Chain::Boot(side - 2)) && self.positions[vertex].y < under)
                    })
                    .map(|vertex| self.positions[vertex])
                    .collect();
                let (back, front) = range(points.iter().map(|p| p.z));
                let (toe, heel) = (front - limb.end.z, limb.end.z - back);
                let (inner, outer) = range(points.iter().filter(|p| p.y < under).map(|p| p.x));
                let toes = points.iter().filter(|p| p.z > limb.end.z + TOES_FROM * toe).map(|p| p.y);
                let height = quantile(toes, TOES_TOP)? - self.frame.heights.sole;
                let outward = sign * ((inner + outer) / 2.0 - self.frame.middle_x);
                (toe > 0.0 && inner <= outer).then_some([toe, heel, (outer - inner) / 2.0, outward, height])
            })
            .collect();
        mean_numbers(&sides, self.length)
    }

    fn neck(&self, triangles: &[[u32; 3]]) -> Option<f64> {
        let Heights { shoulder_line, chin, .. } = self.frame.heights;
        let planes = self.frame.torso_planes();
        let heights = NECK_HEIGHTS.map(|t| shoulder_line + t * (chin - shoulder_line) - planes.origin.y);
        let start = planes.locate(self.frame.shoulders).1;
        let cuts = self.cut(triangles, &planes, &heights);
        let slices = cuts.iter().filter_map(|outlines| slice_around(outlines.iter(), start, true));
        let radius = upper_median(slices.map(|slice| (slice.half.x + slice.half.y) / 2.0))?;
        Some((radius / self.length).min(THICKEST_NECK))
    }
}

/// How far a limb's middle joint lies off the line between its ends.
fn bend(limb: &Limb) -> f64 {
    let along = (limb.end - limb.root).normalize_or_zero();
    (limb.middle - limb.root).reject_from(along).length()
}

/// The point of a leg's bones at height `y`.
pub(super) fn on_limb(limb: &Limb, y: f64) -> DVec3 {
    let (a, b) = if y > limb.middle.y { (limb.root, limb.middle) } else { (limb.middle, limb.end) };
    let t = (a.y - y) / (a.y - b.y).max(1e-30);
    a.lerp(b, t.clamp(0.0, 1.0))
}

/// The mean of both sides, slice by slice; of one where the other is missing.
fn mean_rows(sides: &[[Row; 4]]) -> [Row; 4] {
    std::array::from_fn(|row| {
        std::array::from_fn(|station| {
            mean(hits(sides.iter().map(|side| side[row][station]))).unwrap_or(f64::NAN)
        })
    })
}

/// Rows as [`Body::rows`] gives them, smoothed: middles as places, extents as lengths.
fn smooth_rows([across, forward, breadth, depth]: &[Row; 4]) -> Option<[Row; 4]> {
    Some([smooth(across)?, smooth(forward)?, smooth_lengths(breadth)?, smooth_lengths(depth)?])
}

pub(super) fn mean_numbers<const N: usize>(sides: &[[f64; N]], length: f64) -> Option<[f64; N]> {
    let count = sides.len() as f64;
    (!sides.is_empty()).then(|| {
        std::array::from_fn(|which| sides.iter().map(|side| side[which]).sum::<f64>() / count / length)
    })
}

/// The value below which `share` of `values` lie; `None` for none.
pub(super) fn quantile(values: impl Iterator<Item = f64>, share: f64) -> Option<f64> {
    let mut values: Vec<f64> = values.collect();
    values.sort_by(f64::total_cmp);
    let at = share * values.len().checked_sub(1)? as f64;
    let (low, high) = (values[at as usize], values[at.ceil() as usize]);
    Some(low + (high - low) * at.fract())
}
