//! Which chains each vertex belongs to: what a body's slices are cut from and its ends are read from. Weights say so, not
//! places, so it is found once for all fields that are tried.

use crate::geometry::triangles_where;
use crate::shape::figure::Figure;
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
