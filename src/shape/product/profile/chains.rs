//! Which chains each vertex belongs to: what a body's slices are cut from and its ends are read from. Weights say so, not
//! places, so it is found once for all fields that are tried.
//! A skirt, a robe or the tails of a coat hang around both legs and follow neither: those the mesh tells.

use super::cuts::{BodyFrame, SKIRT_OVER_MIDDLE};
use crate::geometry::weld::{Weld, components, neighbours};
use crate::geometry::{bounds_by_group, triangles_where};
use crate::shape::figure::Figure;
use crate::shape::product::anatomy::Anatomy;
use crate::shape::product::part::{Part, PartWeights, fold_to_parts};

/// Torso and legs are what arms and head move less than this. Made weights reach so far that less leaves no whole slice of a
/// chest: a bust was then as steep as it had been.
const ARM_SHARE: f32 = 0.6;
const HEAD_SHARE: f32 = 0.5;
/// An arm is what it moves more than this; its relief is that of what the hand moves less than this.
const OWN_ARM_SHARE: f32 = 0.4;
const LESS_OF_HAND: f32 = 0.7;
/// A leg's relief is that of what it moves more than this, and the foot less than this.
const OWN_LEG_SHARE: f32 = 0.3;
const LESS_OF_FOOT: f32 = 0.6;
/// Hands and feet are what they move more than this.
const EXTREMITY_SHARE: f32 = 0.5;
/// From this part of the leg's length under the crotch on, trousers are two tubes.
const FORK: f64 = 0.08;
/// Heights at which pieces are looked at, as parts of the leg's length under the crotch.
const HEIGHTS: [f64; 6] = [FORK, 0.2, 0.35, 0.5, 0.65, 0.8];

/// What is measured together; left is side 0, right side 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Chain {
    /// Torso and legs.
    Trunk,
    /// A leg without the foot, for its relief.
    Leg(usize),
    /// An arm with its hand.
    Arm(usize),
    /// An arm without the hand, for its relief.
    Forearm(usize),
    /// What a hand moves.
    Hand(usize),
    /// What a foot moves.
    Foot(usize),
    /// Leg and foot: what lies below the ankle of a boot that the shin moves is a foot all the same.
    Boot(usize),
}

impl Chain {
    /// All of them, those of both sides one after the other.
    fn all() -> Vec<Self> {
        let of_sides: [fn(usize) -> Self; 6] =
            [Self::Leg, Self::Arm, Self::Forearm, Self::Hand, Self::Foot, Self::Boot];
        let of_sides = of_sides.into_iter().flat_map(|chain| [chain(0), chain(1)]);
        std::iter::once(Self::Trunk).chain(of_sides).collect()
    }

    fn bit(self) -> u16 {
        let number = match self {
            Self::Trunk => 0,
            Self::Leg(side) => 1 + side,
            Self::Arm(side) => 3 + side,
            Self::Forearm(side) => 5 + side,
            Self::Hand(side) => 7 + side,
            Self::Foot(side) => 9 + side,
            Self::Boot(side) => 11 + side,
        };
        1 << number
    }

    /// True for what these weights move.
    fn holds(self, row: &PartWeights) -> bool {
        let leg_sum = |side: usize, parts: usize| {
            let first = [Part::LeftUpperLeg, Part::RightUpperLeg][side] as usize;
            row[first..first + parts].iter().sum::<f32>()
        };
        let foot = |side: usize| row[[Part::LeftFoot, Part::RightFoot][side] as usize];
        let hand = |side: usize| row[[Part::LeftHand, Part::RightHand][side] as usize];
        match self {
            Self::Trunk => {
                arm_share(row, 0) + arm_share(row, 1) < ARM_SHARE && row[Part::Head as usize] < HEAD_SHARE
            }
            Self::Leg(side) => leg_sum(side, 3) > OWN_LEG_SHARE && foot(side) < LESS_OF_FOOT,
            Self::Arm(side) => arm_share(row, side) > OWN_ARM_SHARE,
            Self::Forearm(side) => arm_share(row, side) > OWN_ARM_SHARE && hand(side) < LESS_OF_HAND,
            Self::Hand(side) => hand(side) > EXTREMITY_SHARE,
            Self::Foot(side) => foot(side) > EXTREMITY_SHARE,
            Self::Boot(side) => leg_sum(side, 2) + foot(side) > EXTREMITY_SHARE,
        }
    }
}

/// The chains of each vertex, none for what is carried.
#[derive(Clone, Debug)]
pub struct Chains {
    of_vertex: Vec<u16>,
}

impl Chains {
    /// As the rig's own weights say.
    pub fn of(figure: &Figure) -> Self {
        let all = Chain::all();
        let of_vertex = |vertex: usize| {
            if figure.is_carried(vertex) {
                return 0;
            }
            let row = fold_to_parts(&figure.role_weights[vertex]);
            all.iter().filter(|chain| chain.holds(&row)).map(|chain| chain.bit()).sum()
        };
        Self { of_vertex: (0..figure.positions.len()).map(of_vertex).collect() }
    }

    /// Whether `vertex` is of `chain`.
    pub fn hold(&self, vertex: usize, chain: Chain) -> bool {
        self.of_vertex[vertex] & chain.bit() != 0
    }

    /// The triangles of the figure with all corners in `chain`.
    pub fn triangles(&self, figure: &Figure, chain: Chain) -> Vec<[u32; 3]> {
        triangles_where(&figure.triangles, |vertex| self.hold(vertex, chain))
    }
}

/// What arm number `side` moves of a vertex: upper and lower arm, hand.
pub fn arm_share(row: &PartWeights, side: usize) -> f32 {
    let first = if side == 0 { Part::LeftUpperArm } else { Part::RightUpperArm } as usize;
    row[first..first + 3].iter().sum()
}

/// True for the vertices of pieces that below the crotch still join left and right; upwards to the crotch.
///
/// - `weld`: the figure's vertices by position.
///
/// O(triangles).
pub fn skirt_vertices(figure: &Figure, anatomy: &Anatomy, weld: &Weld) -> Vec<bool> {
    let frame = BodyFrame::of(figure, anatomy);
    let crotch = frame.heights.crotch;
    let height = |t: f64| crotch - t * frame.leg_length;
    let firsts = weld.first_vertices();
    let place = |welded: usize| figure.positions[firsts[welded] as usize];
    let (fork, reach) = (height(FORK), SKIRT_OVER_MIDDLE * frame.head_length());
    let hanging: Vec<[u32; 3]> = figure
        .triangles
        .iter()
        .filter(|corners| {
            corners.iter().any(|&vertex| figure.positions[vertex as usize].y < crotch)
                && !figure.is_carried(corners[0] as usize)
        })
        .copied()
        .collect();
    let mut is_skirt = vec![false; weld.count];
    for y in HEIGHTS.map(height) {
        let is_above = |vertex: u32| figure.positions[vertex as usize].y > y;
        let cut: Vec<[u32; 3]> = hanging
            .iter()
            .filter(|corners| corners.iter().any(|&v| is_above(v)) && !corners.iter().all(|&v| is_above(v)))
            .copied()
            .collect();
        let piece = components(&cut, weld);
        let corners = || cut.iter().flat_map(|&corners| weld.triangle(corners)).map(|welded| welded as usize);
        let placed = corners().map(|welded| (piece[welded] as usize, place(welded)));
        let boxes = bounds_by_group(weld.count, placed);
        for welded in corners() {
            let (low, high) = boxes[piece[welded] as usize];
            is_skirt[welded] |= low.x - frame.middle_x < -reach && high.x - frame.middle_x > reach;
        }
    }
    if is_skirt.iter().any(|&is_skirt| is_skirt) {
        // Down to the hem, and then up to the crotch, where legs may join it.
        let around = neighbours(&hanging, weld);
        for (bottom, top) in [(f64::NEG_INFINITY, fork), (fork, crotch)] {
            let mut next: Vec<usize> = (0..weld.count).filter(|&welded| is_skirt[welded]).collect();
            while let Some(welded) = next.pop() {
                for &other in around.of(welded) {
                    let (other, y) = (other as usize, place(other as usize).y);
                    if !is_skirt[other] && y >= bottom && y < top {
                        is_skirt[other] = true;
                        next.push(other);
                    }
                }
            }
        }
    }
    weld.representative.iter().map(|&welded| is_skirt[welded as usize]).collect()
}
