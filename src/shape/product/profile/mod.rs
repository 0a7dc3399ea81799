//! A body's profile (D29): how broad and deep each slice of it is, in head lengths.
//!
//! Heads and lengths alone do not make a body: a waist, a bust and calves stay what they were where one girth serves a whole
//! part. So torso, legs and arms are measured in thirteen slices each, on target and reference alike, and each slice of the
//! one is given the breadth and the depth of the other.

pub mod chains;
pub mod chart;
pub mod curve;
pub mod map;
pub mod radius_map;
pub mod relief;
pub mod slice_scales;
pub mod station;
pub mod wanted;

mod cuts;
mod hand;

pub use chart::{Chart, Slices};
pub use cuts::{BodyFrame, BodyLines, measure_profile};
pub use map::BodyMap;
pub use slice_scales::{Scales, Strengths, flesh, scales};
pub use wanted::{profile_of, strengths, wanted_of};

use crate::shape::body_shape::either;
use serde::{Deserialize, Serialize};

/// Slices of a chain: enough to cancel a waist, a bust and a calf.
pub const STATIONS: usize = 13;
/// Where the first and the last slice of the torso are, from the crotch (0) to the shoulder line (1). Outside of these, and
/// of the limbs' below, joints blend into their neighbours.
pub const TORSO_STATIONS: (f64, f64) = (0.04, 0.80);
/// Of a leg, from the crotch (0) to the ankle (1).
pub const LEG_STATIONS: (f64, f64) = (0.10, 0.95);
/// Of an arm, from the shoulder joint (0) to the wrist (1).
pub const ARM_STATIONS: (f64, f64) = (0.16, 0.95);

/// What [`Profile::ratios`] compares.
pub const CHAINS: [&str; 6] = ["torso", "hips", "legs", "arms", "hand", "foot"];
/// No slice is thinner or thicker than this, in head lengths, and nothing is further from where it is measured.
const LEAST: f64 = 1e-3;
const MOST: f64 = 20.0;

/// One number for each slice.
pub type Row = [f64; STATIONS];

/// Half breadths and half depths of a chain, of two profiles.
type BothExtents<'a> = ([&'a Row; 2], [&'a Row; 2]);

/// Where slice number `station` of a chain is.
pub fn station_at((first, last): (f64, f64), station: usize) -> f64 {
    first + (last - first) * station as f64 / (STATIONS - 1) as f64
}

/// Where all slices of a chain are.
pub fn stations(ends: (f64, f64)) -> Row {
    std::array::from_fn(|station| station_at(ends, station))
}

/// The torso, slice by slice.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct TorsoProfile {
    /// Half the breadth.
    #[serde(rename = "w")]
    pub breadth: Row,
    /// Half the depth.
    #[serde(rename = "d")]
    pub depth: Row,
    /// How far forward the middle is, from the hip joints.
    #[serde(rename = "c")]
    pub forward: Row,
}

/// A leg, slice by slice: the mean of left and right.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct LegProfile {
    /// How far outward of the body's middle its own middle is.
    #[serde(rename = "x")]
    pub outward: Row,
    /// Half the breadth.
    #[serde(rename = "w")]
    pub breadth: Row,
    /// Half the depth.
    #[serde(rename = "d")]
    pub depth: Row,
    /// How far forward its middle is, from the hip joints.
    #[serde(rename = "c")]
    pub forward: Row,
}

/// An arm, slice by slice: the mean of left and right.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ArmProfile {
    /// Half the height of an arm held out.
    #[serde(rename = "w")]
    pub breadth: Row,
    /// Half the depth.
    #[serde(rename = "d")]
    pub depth: Row,
}

/// A skirt, a robe or the tails of a coat, at the slices of the legs.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SkirtProfile {
    /// Half the breadth, where there is a skirt.
    #[serde(rename = "w")]
    pub breadth: [Option<f64>; STATIONS],
    /// Half the depth.
    #[serde(rename = "d")]
    pub depth: [Option<f64>; STATIONS],
    /// How far forward the middle is, from the hip joints.
    #[serde(rename = "c")]
    pub forward: [Option<f64>; STATIONS],
}

impl SkirtProfile {
    /// Half breadth and half depth, and how far forward the middle is, at slice number `station`, where there is a skirt.
    fn at(&self, station: usize) -> Option<([f64; 2], f64)> {
        Some(([self.breadth[station]?, self.depth[station]?], self.forward[station]?))
    }
}

/// How broad and deep a body is, in head lengths; what cannot be measured is absent.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Profile {
    /// From the crotch up to the shoulder line.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub torso: Option<TorsoProfile>,
    /// From the crotch down to the ankle.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub leg: Option<LegProfile>,
    /// From the shoulder joint out to the wrist.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub arm: Option<ArmProfile>,
    /// What hangs around both legs.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub skirt: Option<SkirtProfile>,
    /// Length beyond the wrist, half breadth, half thickness.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub hand: Option<[f64; 3]>,
    /// From the ankle to the toes and to the heel, half breadth, how far outward of the body's middle, height of the toes.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub foot: Option<[f64; 5]>,
    /// The neck's radius.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub neck: Option<f64>,
    /// How far outward of the middle the shoulder joint is.
    pub shoulder: f64,
    /// Shoulder joint to wrist, straight.
    pub arm_length: f64,
}

impl Profile {
    /// Half breadths and half depths of torso, legs and arms, of this profile and of `other`, where both have the chain.
    fn both_extents<'a>(&'a self, other: &'a Self) -> [Option<BothExtents<'a>>; 3] {
        let [own, others] = [self, other].map(|profile| {
            [
                profile.torso.as_ref().map(|torso| [&torso.breadth, &torso.depth]),
                profile.leg.as_ref().map(|leg| [&leg.breadth, &leg.depth]),
                profile.arm.as_ref().map(|arm| [&arm.breadth, &arm.depth]),
            ]
        });
        std::array::from_fn(|chain| own[chain].zip(others[chain]))
    }

    /// What is out of range, with its value: extents must be between .001 and 20 head lengths, and places within 20.
    pub(crate) fn out_of_range(&self) -> Option<(&'static str, f64)> {
        let torso = self.torso.as_ref();
        let leg = self.leg.as_ref();
        let arm = self.arm.as_ref();
        let foot = self
            .foot
            .map(|[toes, heel, breadth, outward, height]| ([toes, breadth, height], [heel, outward]));
        // Each with the least that it may be.
        let numbers: [(&'static str, f64, Option<&[f64]>); 15] = [
            ("torso.w", LEAST, torso.map(|torso| &torso.breadth[..])),
            ("torso.d", LEAST, torso.map(|torso| &torso.depth[..])),
            ("leg.w", LEAST, leg.map(|leg| &leg.breadth[..])),
            ("leg.d", LEAST, leg.map(|leg| &leg.depth[..])),
            ("arm.w", LEAST, arm.map(|arm| &arm.breadth[..])),
            ("arm.d", LEAST, arm.map(|arm| &arm.depth[..])),
            ("hand", LEAST, self.hand.as_ref().map(|hand| &hand[..])),
            ("neck", LEAST, self.neck.as_ref().map(std::slice::from_ref)),
            ("foot", LEAST, foot.as_ref().map(|foot| &foot.0[..])),
            ("torso.c", -MOST, torso.map(|torso| &torso.forward[..])),
            ("leg.x", -MOST, leg.map(|leg| &leg.outward[..])),
            ("leg.c", -MOST, leg.map(|leg| &leg.forward[..])),
            ("foot", -MOST, foot.as_ref().map(|foot| &foot.1[..])),
            ("shoulder", -MOST, Some(std::slice::from_ref(&self.shoulder))),
            ("arm_length", -MOST, Some(std::slice::from_ref(&self.arm_length))),
        ];
        numbers.iter().find_map(|&(name, least, values)| {
            let bad = values?.iter().find(|value| !(least..=MOST).contains(*value))?;
            Some((name, *bad))
        })
    }

    /// Without the chains that are out of range: a mesh may hold anything.
    pub(crate) fn sound(mut self) -> Self {
        while let Some((name, _)) = self.out_of_range() {
            match name.split('.').next() {
                Some("torso") => self.torso = None,
                Some("leg") => self.leg = None,
                Some("arm") => self.arm = None,
                Some("hand") => self.hand = None,
                Some("foot") => self.foot = None,
                Some("neck") => self.neck = None,
                Some("shoulder") => self.shoulder = 0.0,
                _ => self.arm_length = 0.0,
            }
        }
        self
    }

    /// This profile (0) to `other` (1): places in equal steps, extents in equal ratios. What only one of them has is taken
    /// from that one; of skirts, what both have.
    pub(crate) fn blended(&self, other: &Self, amount: f64) -> Self {
        let place = |a: f64, b: f64| a + amount * (b - a);
        let extent = |a: f64, b: f64| a * (b / a).powf(amount);
        let places = |a: &Row, b: &Row| -> Row { std::array::from_fn(|at| place(a[at], b[at])) };
        let extents = |a: &Row, b: &Row| -> Row { std::array::from_fn(|at| extent(a[at], b[at])) };
        let known =
            |a: &[Option<f64>; STATIONS], b: &[Option<f64>; STATIONS], mix: &dyn Fn(f64, f64) -> f64| {
                std::array::from_fn(|at| a[at].zip(b[at]).map(|(a, b)| mix(a, b)))
            };
        Self {
            torso: either(&self.torso, &other.torso, |a, b| TorsoProfile {
                breadth: extents(&a.breadth, &b.breadth),
                depth: extents(&a.depth, &b.depth),
                forward: places(&a.forward, &b.forward),
            }),
            leg: either(&self.leg, &other.leg, |a, b| LegProfile {
                outward: places(&a.outward, &b.outward),
                breadth: extents(&a.breadth, &b.breadth),
                depth: extents(&a.depth, &b.depth),
                forward: places(&a.forward, &b.forward),
            }),
            arm: either(&self.arm, &other.arm, |a, b| ArmProfile {
                breadth: extents(&a.breadth, &b.breadth),
                depth: extents(&a.depth, &b.depth),
            }),
            skirt: self.skirt.as_ref().zip(other.skirt.as_ref()).map(|(a, b)| SkirtProfile {
                breadth: known(&a.breadth, &b.breadth, &extent),
                depth: known(&a.depth, &b.depth, &extent),
                forward: known(&a.forward, &b.forward, &place),
            }),
            hand: either(&self.hand, &other.hand, |a, b| std::array::from_fn(|at| extent(a[at], b[at]))),
            foot: either(&self.foot, &other.foot, |a, b| std::array::from_fn(|at| place(a[at], b[at]))),
            neck: either(&self.neck, &other.neck, |&a, &b| extent(a, b)),
            shoulder: place(self.shoulder, other.shoulder),
            arm_length: place(self.arm_length, other.arm_length),
        }
    }

    /// This profile over `wanted`, by the names of [`CHAINS`]; NaN for what either lacks.
    ///
    /// Torso, legs and arms: the mean over the slices of the root of breadth and depth. Hips: the legs' outer edge at their
    /// first slice. Hand: the cube root of its box. Foot: the root of length and breadth.
    pub fn ratios(&self, wanted: &Self) -> [f64; CHAINS.len()] {
        let mean = |(got, wanted): BothExtents<'_>| {
            let ratio = |at: usize| ((got[0][at] * got[1][at]) / (wanted[0][at] * wanted[1][at])).sqrt();
            (0..STATIONS).map(ratio).sum::<f64>() / STATIONS as f64
        };
        let over = |ratio: Option<f64>| ratio.unwrap_or(f64::NAN);
        let [torso, legs, arms] = self.both_extents(wanted).map(|both| over(both.map(mean)));
        let both_legs = self.leg.as_ref().zip(wanted.leg.as_ref());
        let outer = |leg: &LegProfile| leg.outward[0] + leg.breadth[0];
        let volume = |[length, breadth, depth]: [f64; 3]| (length * breadth * depth).cbrt();
        let area = |[toes, heel, breadth, ..]: [f64; 5]| ((toes + heel) * breadth).sqrt();
        [
            torso,
            over(both_legs.map(|(a, b)| outer(a) / outer(b))),
            legs,
            arms,
            over(self.hand.zip(wanted.hand).map(|(a, b)| volume(a) / volume(b))),
            over(self.foot.zip(wanted.foot).map(|(a, b)| area(a) / area(b))),
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::wanted::canonical;
    use super::*;

    #[test]
    fn half_of_two_profiles_is_between_them() {
        let (small, tall) = (canonical(2.2), canonical(4.5));
        let half = small.blended(&tall, 0.5);
        let legs = [&small, &half, &tall].map(|profile| profile.leg.clone().unwrap());
        for station in 0..STATIONS {
            let [a, b, c] = [0, 1, 2].map(|which: usize| legs[which].breadth[station]);
            assert!((b - (a * c).sqrt()).abs() < 1e-12);
            let [a, b, c] = [0, 1, 2].map(|which: usize| legs[which].outward[station]);
            assert!((b - (a + c) / 2.0).abs() < 1e-12);
        }
        assert_eq!(small.blended(&tall, 0.0), small);
        assert_eq!(Profile { torso: None, ..small.clone() }.blended(&tall, 0.5).torso, tall.torso);
    }

    #[test]
    fn ratios_are_those_of_sizes() {
        let one = canonical(3.0);
        let mut other = one.clone();
        let torso = other.torso.as_mut().unwrap();
        torso.breadth = torso.breadth.map(|w| 2.0 * w);
        torso.depth = torso.depth.map(|d| 0.5 * d);
        other.hand = other.hand.map(|hand| hand.map(|size| 1.5 * size));
        other.arm = None;
        let ratios = other.ratios(&one);
        for (chain, wanted) in [(0, 1.0), (1, 1.0), (2, 1.0), (4, 1.5), (5, 1.0)] {
            assert!((ratios[chain] - wanted).abs() < 1e-12, "{}: {ratios:?}", CHAINS[chain]);
        }
        assert!(ratios[3].is_nan());
    }

    #[test]
    fn what_is_no_size_is_named() {
        let mut profile = canonical(3.0);
        assert_eq!(profile.out_of_range(), None);
        profile.leg.as_mut().unwrap().breadth[4] = 0.0;
        assert_eq!(profile.out_of_range(), Some(("leg.w", 0.0)));
        assert_eq!(profile.sound(), Profile { leg: None, ..canonical(3.0) });
        let far = Profile { arm_length: 1e9, ..canonical(3.0) };
        assert_eq!(far.out_of_range(), Some(("arm_length", 1e9)));
    }
}
