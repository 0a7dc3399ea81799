//! Kernels: what one row of the head's table does to space, and the flow that all of them make together.
//!
//! Points follow the sum of the kernels' velocities for one unit of time. A flow of a smooth field does not fold, however
//! strong, where added displacements do. A point's way is cut into [`STEPS`] straight pieces, each with the velocity in its
//! middle, which is foretold from the piece before: second order, for one velocity a piece. In none of them do neighbours
//! meet (see the tests). The places after whole pieces are kept for each vertex: youth is how far along them it goes.

use super::dual::{Dual, Eight, Number, step};
use glam::{DMat3, DVec3, Vec3};

/// Straight pieces of a point's way.
pub const STEPS: usize = 6;

/// Where a point is after each piece of its way, in head lengths.
pub type Way = [DVec3; STEPS];

/// A part of space that moves: about a centre, as far as it reaches, fully within its plateau. Head lengths; rates per whole
/// way.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Kernel {
    /// What it acts around, at first.
    pub centre: DVec3,
    /// How far that moves.
    pub drift: DVec3,
    /// 1 over its reach towards lower coordinates, at first; 0 has no end.
    pub per_low: DVec3,
    /// Towards higher ones.
    pub per_high: DVec3,
    /// The part of its reach within which it acts fully, 0 (a bell) to below 1.
    pub plateau: f64,
    /// ln of the scales about its centre.
    pub rates: DVec3,
    /// How far it moves what is in it.
    pub shift: DVec3,
    /// How much it bends what is in it: upwards, over the square of the distance from the middle.
    pub bend: f64,
    /// A ramp of depth: where it begins, and 1 over how much further on it is whole; 0 for none, below 0 towards the back.
    pub ramp: [f64; 2],
    /// True where what comes after it in the table takes only what it leaves: its plateau moves as one.
    pub holds: bool,
}

impl Kernel {
    /// About `centre`, as far as `reach` on both sides; `f64::INFINITY` has no end.
    pub fn about(centre: DVec3, reach: DVec3) -> Self {
        Self { centre, per_low: reach.recip(), per_high: reach.recip(), ..Self::default() }
    }

    /// About the height `y`, as far down and up, and without end aside and in depth.
    pub fn level(y: f64, down: f64, up: f64) -> Self {
        Self::about(DVec3::Y * y, DVec3::INFINITY).between(down, up)
    }

    /// The same with another reach upwards and downwards.
    pub fn between(mut self, down: f64, up: f64) -> Self {
        (self.per_low.y, self.per_high.y) = (1.0 / down, 1.0 / up);
        self
    }

    /// The same, that begins at the depth `from` and is whole at `to`.
    pub fn ramp(self, from: f64, to: f64) -> Self {
        Self { ramp: [from, 1.0 / (to - from)], ..self }
    }

    /// The same on the other side of the middle.
    pub fn mirrored(&self) -> Self {
        let mirror = DVec3::new(-1.0, 1.0, 1.0);
        let mut other = *self;
        (other.centre, other.drift, other.shift) =
            (mirror * self.centre, mirror * self.drift, mirror * self.shift);
        (other.per_low.x, other.per_high.x) = (self.per_high.x, self.per_low.x);
        other
    }

    /// The same at `time`, 0 to 1. What holds grows with what is in it, and never reaches over the middle.
    fn at(&self, time: f64) -> Self {
        let mut now = Self { centre: self.centre + time * self.drift, ..*self };
        if self.holds {
            let grown = DVec3::from((-time * self.rates).to_array().map(f64::exp));
            (now.per_low, now.per_high) = (self.per_low * grown, self.per_high * grown);
            // What is about the middle itself reaches to both sides.
            let to_middle = now.centre.x.abs().recip();
            match now.centre.x {
                x if x > 0.0 => now.per_low.x = now.per_low.x.max(to_middle),
                x if x < 0.0 => now.per_high.x = now.per_high.x.max(to_middle),
                _ => {}
            }
        }
        now
    }

    /// How much of it acts at `p`, 0 to 1.
    pub fn weight<N: Number>(&self, p: [N; 3]) -> N {
        let within = self.within(p);
        if self.ramp[1] == 0.0 || !within.is_above(0.0) {
            return within;
        }
        within * step((p[2] - self.ramp[0]) * self.ramp[1])
    }

    /// How much of it would act at `p` without its ramp.
    fn within<N: Number>(&self, p: [N; 3]) -> N {
        let mut square = N::constant(0.0);
        // Heights tell most of them apart.
        for axis in [1, 0, 2] {
            let share = (p[axis] - self.centre[axis]).by_side(self.per_low[axis], self.per_high[axis]);
            square = square + share * share;
            if !square.is_below(1.0) {
                return N::constant(0.0);
            }
        }
        let within = if self.plateau == 0.0 {
            bell(square.root())
        } else if square.is_above(self.plateau * self.plateau) {
            // 1 within the plateau.
            step((-square.root() + 1.0) * (1.0 / (1.0 - self.plateau)))
        } else {
            return N::constant(1.0);
        };
        square.below(1.0, within, N::constant(0.0))
    }

    /// Adds its share of what is `left` to the velocity at `p`, where it acts by `weight`.
    fn add<N: Number>(&self, weight: N, p: [N; 3], left: &mut N, velocity: &mut [N; 3]) {
        if !weight.is_above(0.0) {
            return;
        }
        // What is used up is: of eight points, for some of them.
        let share = weight * left.below(0.0, N::constant(0.0), *left);
        for axis in 0..3 {
            let moves = (p[axis] - self.centre[axis]) * self.rates[axis] + self.shift[axis];
            velocity[axis] = velocity[axis] + share * moves;
        }
        velocity[1] = velocity[1] + share * p[0] * p[0] * self.bend;
        if self.holds {
            *left = *left - share;
        }
    }
}

/// A cubic B-spline: 1 at 0, 0 from 1 on. Bells half their reach apart add up to 1.5, and follow what changes evenly without
/// steps.
fn bell<N: Number>(t: N) -> N {
    let rest = -t + 1.0;
    let far = rest * rest * rest * 2.0;
    if t.is_below(0.5) { t.below(0.5, t * t * rest * -6.0 + 1.0, far) } else { far }
}

/// The velocity of all `kernels` at `p`.
pub fn velocity<N: Number>(kernels: &[Kernel], p: [N; 3]) -> [N; 3] {
    let mut velocity = [N::constant(0.0); 3];
    let mut left = N::constant(1.0);
    for kernel in kernels {
        kernel.add(kernel.weight(p), p, &mut left, &mut velocity);
        if !left.is_above(0.0) {
            break;
        }
    }
    velocity
}

/// Kernels ready for points to follow them.
#[derive(Clone, Debug)]
pub struct Follower {
    /// In the middle of each piece of the way.
    moments: [Vec<Kernel>; STEPS],
}

impl Follower {
    /// Ready to follow `kernels`, in the order of the table.
    pub fn new(kernels: &[Kernel]) -> Self {
        let moments = std::array::from_fn(|piece| {
            let time = (piece as f64 + 0.5) / STEPS as f64;
            kernels.iter().map(|kernel| kernel.at(time)).collect()
        });
        Self { moments }
    }

    /// The way of `p`.
    pub fn way(&self, p: DVec3) -> Way {
        let mut way = Way::default();
        self.pieces(p.to_array(), 1.0, |piece, p| way[piece] = p.into());
        way
    }

    /// How far eight points go on their ways, sooner than one after the other the nearer they are to each other.
    pub fn ways(&self, points: [Vec3; 8]) -> [[Vec3; STEPS]; 8] {
        let start = [0, 1, 2].map(|axis| Eight(points.map(|p| p[axis]).into()));
        let mut ways = [[Vec3::ZERO; STEPS]; 8];
        self.pieces(start, 1.0, |piece, p| {
            let [x, y, z] = p.map(|of_all| of_all.0.to_array());
            for (of, way) in ways.iter_mut().enumerate() {
                way[piece] = Vec3::new(x[of], y[of], z[of]) - points[of];
            }
        });
        ways
    }

    /// Where `p` is after the share `youth` of its way.
    pub fn place(&self, p: DVec3, youth: f64) -> DVec3 {
        DVec3::from_array(self.follow(p.to_array(), youth))
    }

    /// As [`Follower::place`], with the Jacobian.
    pub fn map(&self, p: DVec3, youth: f64) -> (DVec3, DMat3) {
        Dual::split(self.follow(Dual::point(p), youth))
    }

    fn follow<N: Number>(&self, mut p: [N; 3], youth: f64) -> [N; 3] {
        self.pieces(p, youth, |_, next| p = next);
        p
    }

    /// Gives the places after the pieces of the way of `p` up to the share `youth`, the last of them cut off there.
    fn pieces<N: Number>(&self, mut p: [N; 3], youth: f64, mut give: impl FnMut(usize, [N; 3])) {
        let (whole, rest) = pieces(youth);
        let step = 1.0 / STEPS as f64;
        let after = |p: [N; 3], moves: [N; 3], time: f64| [0, 1, 2].map(|axis| p[axis] + moves[axis] * time);
        let mut moves = velocity(&self.moments[0], p);
        for piece in 0..whole + usize::from(rest > 0.0) {
            moves = velocity(&self.moments[piece], after(p, moves, 0.5 * step));
            p = after(p, moves, step * if piece < whole { 1.0 } else { rest });
            give(piece, p);
        }
    }

    /// The slope of the velocity in the middle of a piece.
    pub fn slope(&self, p: DVec3, piece: usize) -> DMat3 {
        Dual::split(velocity(&self.moments[piece], Dual::point(p))).1
    }
}

/// Whole pieces of the way, and what part of the next one.
pub(super) fn pieces(youth: f64) -> (usize, f64) {
    let along = youth.clamp(0.0, 1.0) * STEPS as f64;
    let whole = (along as usize).min(STEPS);
    (whole, along - whole as f64)
}

/// Where a point that starts at `p` is after the share `youth` of its way.
pub fn along(p: DVec3, way: &Way, youth: f64) -> DVec3 {
    let (whole, rest) = pieces(youth);
    let last = if whole == 0 { p } else { way[whole - 1] };
    if rest > 0.0 { last + rest * (way[whole] - last) } else { last }
}
