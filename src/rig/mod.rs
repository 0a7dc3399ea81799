//! From a mesh to a rig (§IV-B): a skeleton by ray casting, weights by heat or through a volume, clothes by transfer.
//!
//! Every stage but the first works on a [`UnitFigure`]: x towards the character's left, y up, z forward, soles at 0, the
//! whole figure 1 high, so that no threshold depends on the unit of a file. The files in the order of the work:
//!
//! | File | What it gives |
//! | --- | --- |
//! | `far` | vertices that say nothing |
//! | `facing` | the way the figure looks; `front_votes`: what tells front from back |
//! | `unit_figure` | all meshes in one space, 1 high |
//! | `mesh_kinds` | what each mesh depicts, from where it lies: `facts` about samples on it, `reach` over the figure |
//! | `silhouette` | a grid of parallel rays and all that they meet |
//! | `front_view` | the figure seen from the front: which meshes, its axis, its runs |
//! | `legs` | crotch, hip joints, knees, ankles, toes |
//! | `solid` | the figure as filled cells: what it encloses, its slices, its `branches`, ways through it (`geodesic`) |
//! | `arm_branch`, `arms` | arms as branches show them, and rays at right angles to these |
//! | `arm_curve` | the joints that an arm's sections show |
//! | `arm_choice` | which of several arms a body has |
//! | `head_line` | neck, chin, crown |
//! | `hand` | fingers: the `section` at the wrist, the `region` beyond it |
//! | `joints` | all of these put together, sides made alike, what is not seen by ratio |
//! | `candidates` | where else a doubted joint may be |
//! | `placed` | the above in order: the way a character looks, kinds, joints |
//! | `eyeballs` | eyeballs |
//! | `weight_bones` | joints as a tree, and the bones that weights start from |
//! | `wholeness` | whether the surface is whole enough for heat |
//! | `parts` | what is one skin with the body and moves otherwise: long hair |
//! | `heat` | weights of a whole body; `nearest` bones and whether they are seen |
//! | `voxel` | weights of an open body by distances through its solid |
//! | `transfer` | weights of clothes from the `skin` below, `inpaint` where it says nothing, `rigid` things |
//!
//! Constants say what was *seen* when they alone were changed by 30 %, on 23 rigged figures whose rigs were taken away,
//! in the joints' distance from the artists' (`docs/constants.md`, `benches/constants.py`).

pub mod arm_branch;
pub mod arm_choice;
pub mod arm_curve;
pub mod arms;
pub mod candidates;
pub mod eyeballs;
pub mod facing;
pub mod far;
pub mod front_view;
pub mod front_votes;
pub mod hand;
pub mod head_line;
pub mod heat;
pub mod joints;
pub mod legs;
pub mod mesh_kinds;
pub mod parts;
pub mod placed;
pub mod silhouette;
pub mod solid;
pub mod transfer;
pub mod unit_figure;
pub mod voxel;
pub mod weight_bones;
pub mod wholeness;

use crate::character::Weights;
pub use crate::options::{GarmentWeights, RigOptions, WeightMethod};
use glam::DVec3;
use std::collections::BTreeMap;
pub use unit_figure::UnitFigure;

/// A joint that was found, given or placed by ratio.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FoundJoint {
    /// Where it is, in the unit figure.
    pub position: DVec3,
    /// 0..1: 1 for given joints; below 0.5 where a rule failed and a ratio stands in, or where the reading is doubtful.
    pub confidence: f64,
}

/// What moves with one joint: the segments that heat and distances start from.
#[derive(Clone, Debug, PartialEq)]
pub struct WeightBone {
    /// Index of the joint that moves it, as it goes into the weights.
    pub joint: u32,
    /// Both ends of each segment, in the unit figure; the ends may coincide.
    pub segments: Vec<[DVec3; 2]>,
}

/// Weights of a list of vertices, with what was not weighted by the rule itself.
#[derive(Clone, Debug, Default)]
pub struct WeightSet {
    /// One row a vertex: sum 1, none negative, never empty.
    pub weights: Weights,
    /// How many vertices took their weights by another rule, by the rule's name.
    pub fallback: BTreeMap<&'static str, usize>,
}
