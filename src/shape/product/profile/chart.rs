//! The chart of a body (D29): what is measured of it once, as it stands, and what a style makes of that. Relief and slices act
//! where they were measured, before the parts' lengths, so that nothing is measured on what is deformed.

use super::curve::{monotone_cubic, smooth, smooth_lengths};
use super::cuts::{BodyFrame, BodyLines, on_limb};
use super::hand::size_at;
use super::radius_map::Spot;
use super::relief::{Reaches, Relief};
use super::slice_scales::{Scales, Strengths, mitt, scales};
use super::{
    ARM_STATIONS, BodyMap, LEG_STATIONS, Profile, Row, STATIONS, TORSO_STATIONS, TorsoProfile, stations,
};
use crate::error::Warning;
use crate::geometry::slice::Planes;
use crate::geometry::{self, Rows, smoothstep};
use crate::shape::Measured;
use crate::shape::figure::Figure;
use crate::shape::product::binding::PartBinding;
use crate::shape::product::part::{PART_COUNT, Part, TINY};
use crate::shape::product::parts_field::{PartField, Yoke, is_of_head};
use crate::shape::product::scales::{PartCoefficients, Scale};
use glam::DVec2;

/// What becomes this much stubbier (its length shrinks to .7 of what its thickness does) loses all of its relief.
const SMOOTH_FROM: f64 = 0.3;

/// What is measured of a body as it stands.
#[derive(Clone, Debug)]
pub struct Chart {
    frame: BodyFrame,
    own: Profile,
    lines: BodyLines,
    reaches: Reaches,
}

/// What a style makes of a chart: maps at rest.
#[derive(Clone, Debug)]
pub struct Slices {
    /// First.
    pub relief: Relief,
    /// Then, before each part.
    pub map: BodyMap,
    /// How much longer and thicker parts become by these maps and their own together, in the mean of their slices.
    pub coefficients: PartCoefficients,
    /// Of what soft limits took more than a tenth, the scale that was wanted and the one that it got.
    limited: Vec<(&'static str, f64, f64)>,
}

impl Chart {
    /// Measures a target.
    ///
    /// - `threads`: at most this many, 0 for all cores.
    pub fn of(measured: &Measured, threads: usize) -> Self {
        let Measured { figure, anatomy, chains, weld, shape, lines, .. } = measured;
        let frame = BodyFrame::of(figure, anatomy);
        let reaches = Reaches::of(figure, chains, weld, &frame, threads);
        Self { own: shape.profile.clone().unwrap_or_default(), lines: lines.clone(), frame, reaches }
    }

    /// The spots of every vertex of `figure` that slices move from where it is at rest.
    pub fn spots(&self, figure: &Figure, bindings: &[PartBinding]) -> Rows<(u8, Spot)> {
        let mut spots = Rows { starts: vec![0], things: Vec::new() };
        for (binding, &p) in bindings.iter().zip(&figure.positions) {
            if binding.is_plain() && !is_of_head(&binding.weights) {
                self.reaches.add_spots(&mut spots.things, &self.frame, p, binding);
            }
            spots.starts.push(spots.things.len() as u32);
        }
        spots
    }

    /// The frame that it was measured in.
    pub fn frame(&self) -> &BodyFrame {
        &self.frame
    }

    /// The maps that give the body so much of the profile `wanted`, and `parts` as they are to follow them: about the line that
    /// relief leaves of the torso.
    pub fn slices(&self, parts: &PartField, wanted: &Profile, strengths: &Strengths) -> (Slices, PartField) {
        let frame = &self.frame;
        let parts = &parts.from_yoke(self.yoke(parts, wanted, strengths).unwrap_or(Yoke::NONE));
        let (wanted, torso_top) = &self.where_parts_put_slices(wanted, parts);
        let grows = Grows::of(parts, frame);
        let thicker = self.thicker(wanted).map(|row| mean(row.into_iter().map(f64::ln)).exp());
        let strength = [[strengths.torso; STATIONS], strengths.leg, strengths.arm];
        let strength: [Row; 3] = std::array::from_fn(|chain| {
            let stubbier = smoothstep((1.0 - grows.lengths[chain] / thicker[chain]) / SMOOTH_FROM);
            strength[chain].map(|strength| strength * stubbier)
        });
        let torso_place = |y: f64| parts.body_height(y) / parts.after().head_length();
        let place = |chain: usize, height: f64| match chain {
            0 => torso_place(frame.heights.crotch + height),
            _ => grows.lengths[chain] / frame.head_length() * height,
        };
        let relief = self.reaches.relief(frame, strength, place);
        let (mut smooth, lines) = self.smoothed(&relief);
        let mut share = 0.0;
        if let (Some(hand), Some(wanted), Some(sizes)) = (&mut smooth.hand, wanted.hand, lines.hand_sizes) {
            // What becomes a mitt is as large as that leaves it.
            share = mitt(std::array::from_fn(|axis| (wanted[axis] / hand[axis]).powf(strengths.hand)));
            *hand = size_at(&sizes, share);
        }
        // The torso's own curve goes with its relief: parts that flattened it would put it back.
        let about = parts.about(frame.centre_line(smooth.torso.as_ref()));
        let grows = Grows { parts: &about, ..grows };
        let straight = grows.straightened(&smooth, &strengths.leg);
        let mut scales = scales(&grows.after(&straight), wanted, strengths);
        scales.mitt = share;
        scales.torso_top = torso_top.map(|top| top.powf(strengths.torso));
        grows.back(&mut scales, &smooth, &straight);
        // Where none is asked for, what spreads there from beside does not count.
        let mut relieved = self.thicker(&smooth);
        for (thicker, strength) in relieved.iter_mut().flatten().zip(strength.iter().flatten()) {
            *thicker = if *strength > 0.0 { *thicker } else { 1.0 };
        }
        let slices = Slices {
            coefficients: self.coefficients(parts.coefficients(), &scales, &relieved),
            relief,
            map: BodyMap::new(&smooth, &lines, frame, &scales, torso_place),
            limited: scales.limited,
        };
        (slices, about)
    }

    /// How high arms are, and become, where they leave the torso.
    fn yoke(&self, parts: &PartField, wanted: &Profile, strengths: &Strengths) -> Option<Yoke> {
        let length = self.frame.head_length();
        let own = length * self.own.arm.as_ref()?.breadth[0];
        let wanted = parts.after().head_length() * wanted.arm.as_ref()?.breadth[0];
        let thickness = parts.coefficients().upper_arm.thickness;
        let scale = thickness * (wanted / (own * thickness)).powf(strengths.arm[0]);
        let across = (0..2).filter_map(|side| Some(1.0 - self.frame.arm_planes(side)?.axis.y.powi(2)));
        Some(Yoke { half: own, scale, level: mean(across) })
    }

    /// The profile `wanted`, with the torso's slices of where `parts` put this body's, and how much broader and deeper its last one
    /// is than that: where arms become so thick that the torso's last slice comes to lie lower than in the style.
    fn where_parts_put_slices(&self, wanted: &Profile, parts: &PartField) -> (Profile, [f64; 2]) {
        let (mut wanted, mut top) = (wanted.clone(), [1.0; 2]);
        let heights = &self.frame.heights;
        let [low, high] = [heights.crotch, heights.shoulder_line].map(|y| parts.body_height(y));
        let of_torso = stations(TORSO_STATIONS);
        let to = of_torso.map(|t| {
            (parts.body_height(heights.crotch + t * self.frame.torso_length()) - low) / (high - low).max(TINY)
        });
        if let Some(TorsoProfile { breadth, depth, forward }) = &mut wanted.torso {
            let last = STATIONS - 1;
            let ends = [breadth[last], depth[last]];
            for row in [&mut *breadth, &mut *depth, forward] {
                *row = to.map(|t| monotone_cubic(&of_torso, row, t));
            }
            top = [ends[0] / breadth[last], ends[1] / depth[last]];
        }
        (wanted, top)
    }

    /// How much thicker the slices of torso, legs and arms are in the profile `other`, in its heads.
    fn thicker(&self, other: &Profile) -> [Row; 3] {
        self.own.both_extents(other).map(|both| {
            let Some((own, other)) = both else { return [1.0; STATIONS] };
            std::array::from_fn(|at| (other[0][at] * other[1][at] / (own[0][at] * own[1][at])).sqrt())
        })
    }

    /// `parts` times what `scales`, and relief, which makes slices of torso, legs and arms so much thicker, make of each part, in
    /// the mean of its slices.
    fn coefficients(&self, parts: &PartCoefficients, scales: &Scales, relief: &[Row; 3]) -> PartCoefficients {
        let frame = &self.frame;
        // Of the slices whose number in `row` is `of`.
        let thicker = |number: usize, row: &Row, of: f64| {
            let chain = [&scales.torso, &scales.leg, &scales.arm][number];
            let log = |at: usize| (chain.breadth[at] * chain.depth[at]).sqrt().ln() + relief[number][at].ln();
            mean((0..STATIONS).filter(|&at| row[at] == of).map(log)).exp()
        };
        let (legs, arms) = (frame.leg_row([0.0, 1.0]), frame.arm_row([0.0, 1.0]));
        let times = |part: Scale, length: f64, thickness: f64| Scale {
            length: part.length * length,
            thickness: part.thickness * thickness,
        };
        let size = |scales: [f64; 3]| mean(scales.into_iter().map(f64::ln)).exp();
        let hips = mean((2..4).map(|leg| (frame.limbs[leg].root.x - frame.middle_x).abs()));
        let spread = scales.spread * frame.head_length();
        PartCoefficients {
            neck: times(parts.neck, 1.0, scales.neck),
            torso: times(parts.torso, 1.0, thicker(0, &[0.0; STATIONS], 0.0)),
            hip_spread: parts.hip_spread * if hips > 0.0 { (hips + spread) / hips } else { 1.0 },
            upper_arm: times(parts.upper_arm, scales.arm_length, thicker(2, &arms, 0.0)),
            lower_arm: times(parts.lower_arm, scales.arm_length, thicker(2, &arms, 1.0)),
            upper_leg: times(parts.upper_leg, 1.0, thicker(1, &legs, 0.0)),
            lower_leg: times(parts.lower_leg, 1.0, thicker(1, &legs, 1.0)),
            hand: parts.hand * size(scales.hand),
            foot: parts.foot * size(scales.foot),
            ..*parts
        }
    }

    /// The profile, and the lines, that `relief` leaves: as smooth as what is measured is.
    fn smoothed(&self, relief: &Relief) -> (Profile, BodyLines) {
        let (frame, length) = (&self.frame, self.frame.head_length());
        let (mut now, mut lines) = (self.own.clone(), self.lines.clone());
        // Middle and half extents of a slice, in head lengths.
        let slice = |planes: &Planes, height: f64, [middle, half]: [DVec2; 2], part: Part| {
            let to = |x: f64, z: f64| {
                let p = planes.point(height, length * (middle + half * DVec2::new(x, z)));
                planes.locate(relief.map(p, &part.alone(), false)).1 / length
            };
            let ends = |sign: f64| DVec2::new(to(sign, 0.0).x, to(0.0, sign).y);
            [(ends(1.0) + ends(-1.0)) / 2.0, (ends(1.0) - ends(-1.0)).abs() / 2.0]
        };
        if let Some(torso) = &mut now.torso {
            for (at, t) in stations(TORSO_STATIONS).into_iter().enumerate() {
                let from =
                    [DVec2::new(0.0, torso.forward[at]), DVec2::new(torso.breadth[at], torso.depth[at])];
                let [middle, half] =
                    slice(&frame.torso_planes(), t * frame.torso_length(), from, Part::Torso);
                (torso.forward[at], torso.breadth[at], torso.depth[at]) = (middle.y, half.x, half.y);
            }
        }
        let planes = frame.leg_planes();
        for (at, t) in stations(LEG_STATIONS).into_iter().enumerate() {
            let height = t * frame.leg_length;
            if let Some(leg) = &mut now.leg {
                let [mut middle, mut half] = [DVec2::ZERO; 2];
                for (side, part) in [Part::LeftUpperLeg, Part::RightUpperLeg].into_iter().enumerate() {
                    let sign = DVec2::new(frame.signs[2 + side], 1.0);
                    let from = [
                        sign * DVec2::new(leg.outward[at], leg.forward[at]),
                        DVec2::new(leg.breadth[at], leg.depth[at]),
                    ];
                    let to = slice(&planes, height, from, part);
                    middle += sign * to[0] / 2.0;
                    half += to[1] / 2.0;
                }
                (leg.outward[at], leg.forward[at]) = middle.into();
                (leg.breadth[at], leg.depth[at]) = half.into();
            }
        }
        let sides = [Part::LeftUpperArm, Part::RightUpperArm].into_iter().enumerate();
        let mut arms: Vec<_> = sides
            .zip(&mut lines.arm_middles)
            .filter_map(|((side, part), line)| Some((side, part, frame.arm_planes(side)?, line.as_mut()?)))
            .collect();
        let share = 1.0 / arms.len() as f64;
        if let Some(arm) = &mut now.arm {
            for (at, t) in stations(ARM_STATIONS).into_iter().enumerate() {
                let from = DVec2::new(arm.breadth[at], arm.depth[at]);
                let mut half = DVec2::ZERO;
                for (side, part, planes, line) in &mut arms {
                    let middle = DVec2::new(line[0][at], line[1][at]) / length;
                    let to = slice(planes, t * frame.arm_lengths[*side], [middle, from], *part);
                    (line[0][at], line[1][at]) = (length * to[0]).into();
                    half += share * to[1];
                }
                if !arms.is_empty() {
                    (arm.breadth[at], arm.depth[at]) = half.into();
                }
            }
        }
        // Relief has gaps and folds that a profile has not.
        if let (Some(now), Some(own)) = (&mut now.torso, &self.own.torso) {
            even_lengths(&mut now.breadth, &own.breadth);
            even_lengths(&mut now.depth, &own.depth);
            even_places(&mut now.forward, &own.forward);
        }
        if let (Some(now), Some(own)) = (&mut now.leg, &self.own.leg) {
            even_lengths(&mut now.breadth, &own.breadth);
            even_lengths(&mut now.depth, &own.depth);
            even_places(&mut now.outward, &own.outward);
            even_places(&mut now.forward, &own.forward);
        }
        if let (Some(now), Some(own)) = (&mut now.arm, &self.own.arm) {
            even_lengths(&mut now.breadth, &own.breadth);
            even_lengths(&mut now.depth, &own.depth);
        }
        (now, lines)
    }
}

/// 0 of nothing.
fn mean(numbers: impl Iterator<Item = f64>) -> f64 {
    geometry::mean(numbers).unwrap_or(0.0)
}

/// Makes places `now` as smooth as their `own` ones were.
fn even_places(now: &mut Row, own: &Row) {
    if let Some(even) = smooth(&std::array::from_fn(|at| now[at] - own[at])) {
        *now = std::array::from_fn(|at| own[at] + even[at]);
    }
}

/// The same of lengths.
fn even_lengths(now: &mut Row, own: &Row) {
    if let Some(even) = smooth_lengths(&std::array::from_fn(|at| now[at] / own[at])) {
        *now = std::array::from_fn(|at| own[at] * even[at]);
    }
}

/// What the parts make of a body: what a head length at rest becomes in heads of the result.
struct Grows<'a> {
    parts: &'a PartField,
    frame: &'a BodyFrame,
    /// How much the head's length grows.
    grown: f64,
    /// Along torso, legs and arms.
    lengths: [f64; 3],
    /// Across, slice by slice.
    torso: f64,
    leg: Row,
    arm: Row,
}

impl<'a> Grows<'a> {
    fn of(parts: &'a PartField, frame: &'a BodyFrame) -> Self {
        let scales = parts.coefficients();
        let grown = parts.after().head_length() / frame.head_length();
        let across = |upper: Scale, lower: Scale| [upper.thickness / grown, lower.thickness / grown];
        Self {
            lengths: parts.lengths().map(|length| length / grown),
            torso: scales.torso.thickness / grown,
            leg: frame.leg_row(across(scales.upper_leg, scales.lower_leg)),
            arm: frame.arm_row(across(scales.upper_arm, scales.lower_arm)),
            parts,
            frame,
            grown,
        }
    }

    /// `own`, where legs and skirts are curved as much less as legs become shorter than thinner.
    fn straightened(&self, own: &Profile, strengths: &Row) -> Profile {
        let frame = self.frame;
        let mut straight = own.clone();
        for (at, t) in stations(LEG_STATIONS).into_iter().enumerate() {
            let y = frame.heights.crotch - t * frame.leg_length;
            let bones = (2..4).map(|limb| on_limb(&frame.limbs[limb], y).z).sum::<f64>() / 2.0;
            let bones = (bones - frame.hips.z) / frame.head_length();
            let flat = 1.0 + strengths[at] * ((self.lengths[1] / self.leg[at]).min(1.0) - 1.0);
            let flattened = |forward: f64| bones + flat * (forward - bones);
            if let Some(leg) = &mut straight.leg {
                leg.forward[at] = flattened(leg.forward[at]);
            }
            if let Some(skirt) = &mut straight.skirt {
                skirt.forward[at] = skirt.forward[at].map(flattened);
            }
        }
        straight
    }

    /// What the parts make of the profile `own`, in heads of the result.
    fn after(&self, own: &Profile) -> Profile {
        let Self { parts, frame, grown, .. } = *self;
        let scales = parts.coefficients();
        let (length, new_length) = (frame.head_length(), parts.after().head_length());
        let mut now = own.clone();
        if let Some(torso) = &mut now.torso {
            for at in 0..STATIONS {
                torso.breadth[at] *= self.torso;
                torso.depth[at] *= self.torso;
            }
        }
        let planes = frame.leg_planes();
        if let Some(leg) = &mut now.leg {
            for (at, t) in stations(LEG_STATIONS).into_iter().enumerate() {
                leg.breadth[at] *= self.leg[at];
                leg.depth[at] *= self.leg[at];
                let outward = |side: usize| {
                    let (sign, limb) = (frame.signs[2 + side], &frame.limbs[2 + side]);
                    let off = length * DVec2::new(sign * leg.outward[at], leg.forward[at]);
                    let p = planes.point(t * frame.leg_length, off);
                    let to = parts.place_part(limb.parts[usize::from(p.y < limb.middle.y)], p);
                    sign * (to.x - frame.middle_x)
                };
                leg.outward[at] = (outward(0) + outward(1)) / (2.0 * new_length);
                leg.forward[at] *= self.torso;
            }
        }
        if let Some(skirt) = &mut now.skirt {
            for row in [&mut skirt.breadth, &mut skirt.depth, &mut skirt.forward] {
                *row = row.map(|x| x.map(|x| x * self.torso));
            }
        }
        if let Some(arm) = &mut now.arm {
            for at in 0..STATIONS {
                arm.breadth[at] *= self.arm[at];
                arm.depth[at] *= self.arm[at];
            }
        }
        now.hand = own.hand.map(|hand| hand.map(|size| size * scales.hand / grown));
        now.foot = own.foot.map(|foot| foot.map(|size| size * scales.foot / grown));
        now.neck = own.neck.map(|neck| neck * scales.neck.thickness / grown);
        now.shoulder = own.shoulder * scales.shoulder_spread / grown;
        now.arm_length = own.arm_length * self.lengths[2];
        now
    }

    /// Turns places of the result, in its heads, into places at rest, in heads there.
    fn back(&self, scales: &mut Scales, own: &Profile, straight: &Profile) {
        scales.spread *= self.grown / self.parts.coefficients().upper_leg.thickness;
        if let (Some(own), Some(straight)) = (&own.leg, &straight.leg) {
            scales.leg_shift = std::array::from_fn(|at| straight.forward[at] - own.forward[at]);
        }
        if let (Some(skirt), Some(straight)) = (&own.skirt, &straight.skirt) {
            for scale in &mut scales.skirt {
                let at = scale.station;
                if let (Some((half, forward)), Some(to)) = (skirt.at(at), straight.forward[at]) {
                    (scale.half, scale.forward, scale.shift) = (half, forward, to - forward);
                }
            }
        }
    }
}

impl Slices {
    /// By part, whether what is done to what it moves is what the same body's slices `other` do.
    pub fn common(&self, other: &Self) -> [bool; PART_COUNT] {
        let [torso, left_leg, right_leg, left_arm, right_arm] = self.relief.common(&other.relief);
        let (limbs, of_map) = ([left_arm, right_arm, left_leg, right_leg], self.map.common(&other.map));
        std::array::from_fn(|part| {
            let limb = part.checked_sub(Part::LeftUpperArm as usize).and_then(|part| limbs.get(part / 3));
            torso && limb.is_none_or(|same| *same) && of_map[part]
        })
    }

    /// A warning that names what soft limits took more than a tenth of.
    pub fn limited(&self) -> Option<Warning> {
        let item = |(what, wanted, got): &(&str, f64, f64)| format!("{what} {wanted:.2} to {got:.2}");
        let items: Vec<String> = self.limited.iter().map(item).collect();
        (!items.is_empty()).then(|| {
            let message =
                format!("limited slices that the style wants thicker or thinner: {}", items.join(", "));
            Warning::new("coefficient_limited", message).about("profile")
        })
    }
}
