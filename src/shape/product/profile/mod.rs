//! A body's profile (D29): how broad and deep each slice of it is, in head lengths.
//!
//! Heads and lengths alone do not make a body: a waist, a bust and calves stay what they were where one girth serves a whole
//! part. So torso, legs and arms are measured in thirteen slices each, on target and reference alike, and each slice of the
//! one is given the breadth and the depth of the other.

pub mod canonical;
pub mod chains;
pub mod chart;
pub mod curve;
pub mod map;
pub mod radius_map;
pub mod relief;
pub mod skirts;
pub mod slab;
pub mod slice_scales;
pub mod smooth;
pub mod station;
pub mod wanted;

mod cuts;
mod hand;
mod numbers;

pub use chart::{Chart, Slices};
pub use cuts::{BodyFrame, BodyLines, measure_profile};
pub use map::BodyMap;
pub use numbers::CHAINS;
pub use slice_scales::{Scales, Strengths, flesh, scales};
pub use wanted::{profile_of, strengths, wanted_of};

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

/// One number for each slice.
pub type Row = [f64; STATIONS];

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
