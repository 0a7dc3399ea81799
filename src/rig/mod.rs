//! From a mesh to a rig (§IV-B): a skeleton by ray casting, weights by heat or through a volume, clothes by transfer.
//!
//! Every stage works on a [`Layout`]: x towards the character's left, y up, z forward, soles at 0, the whole figure 1
//! high, so that no threshold depends on the unit of a file.

pub mod arms;
pub mod eyes;
pub mod facing;
pub mod front_view;
pub mod geodesic;
pub mod hand;
pub mod head_line;
pub mod heat;
pub mod joints;
pub mod legs;
pub mod mesh_kinds;
pub mod silhouette;
pub mod skeleton;
pub mod transfer;
pub mod unit_figure;
pub mod volume;
pub mod voxel;
pub mod wholeness;

use crate::character::{Role, Weights};
use glam::DVec3;
use std::collections::BTreeMap;
pub use unit_figure::Layout;

/// Which rule gives the body its weights.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum WeightMethod {
    /// Heat where the body allows it, else the volume.
    #[default]
    Auto,
    /// Heat equilibrium on the surface (Baran and Popović, reference 11).
    Heat,
    /// Geodesic distances through a voxel volume (Dionne and de Lasa, reference 14).
    Volume,
}

/// Which rule gives clothes their weights (Fig. 4).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum GarmentWeights {
    /// Close surface points with like normals, the rest filled in smoothly.
    #[default]
    Robust,
    /// The closest surface point, whatever it is: the paper's rule (Fig. 4e).
    Nearest,
    /// Heat on the clothes themselves: the naive case (Fig. 4c).
    Heat,
}

/// What the auto-rig can be told.
#[derive(Clone, Debug, PartialEq)]
pub struct RigOptions {
    /// Which rule gives the body its weights.
    pub method: WeightMethod,
    /// Which rule gives clothes their weights.
    pub garments: GarmentWeights,
    /// c of the heat equation, above 0: 1 spreads weights over about a limb's radius; larger is sharper.
    pub heat: f64,
    /// Gives the head bone a second segment towards the chin, without which jaws stick to the neck.
    pub chin_segment: bool,
    /// Voxels along the longest side of the volume, 16 to 512.
    pub voxel_resolution: usize,
    /// Joints that are known, model space; the rest is found.
    pub given: BTreeMap<Role, DVec3>,
    /// Looks for fingers.
    pub fingers: bool,
    /// The axes of model space are left-handed, as Unity's: which of two sides is the left one depends on it.
    pub left_handed: bool,
    /// Threads to use; 0 means all cores.
    pub thread_count: usize,
}

impl Default for RigOptions {
    fn default() -> Self {
        Self {
            method: WeightMethod::Auto,
            garments: GarmentWeights::Robust,
            heat: 1.0,
            chin_segment: true,
            voxel_resolution: 128,
            given: BTreeMap::new(),
            fingers: true,
            left_handed: false,
            thread_count: 0,
        }
    }
}

/// A joint that was found, given or placed by ratio.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FoundJoint {
    /// Where it is, in the layout.
    pub position: DVec3,
    /// 0..1: 1 for given joints; below 0.5 where a rule failed and a ratio stands in, or where the reading is doubtful.
    pub confidence: f64,
}

/// What moves with one joint: the segments that heat and distances start from.
#[derive(Clone, Debug, PartialEq)]
pub struct WeightBone {
    /// Index of the joint that moves it, as it goes into the weights.
    pub joint: u32,
    /// Both ends of each segment, in the layout; the ends may coincide.
    pub segments: Vec<[DVec3; 2]>,
}

/// Weights of a list of vertices, with what was not weighted by the rule itself.
#[derive(Clone, Debug, Default)]
pub struct Weighted {
    /// One row a vertex: sum 1, none negative, never empty.
    pub weights: Weights,
    /// How many vertices took their weights by another rule, by the rule's name.
    pub fallback: BTreeMap<&'static str, usize>,
}
