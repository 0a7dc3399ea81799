//! A young face as a flow: points follow a velocity field, so nothing folds, however much each feature grows or shrinks.
//!
//! Eyes grow outwards from the bridge of the nose and sink, the nose and the mouth shrink, cheeks, jaw and skull round,
//! ears come closer. The field and its constants were found by measuring and looking at what artists draw.
//!
//! A point's way is cut into [`STEPS`] straight pieces (the midpoint rule), so its place after any part of the way needs
//! no more than its places after whole pieces: these are kept for each vertex, and youth is how far along they go.
//! Each piece moves a point by less than its distance from its neighbours (step times the field's slope is below 1, see
//! the tests), so each is one to one, and so is the way.

use super::dual::{Dual, Number, step};
use super::iris::IrisFlow;
use glam::{DMat3, DVec3};

/// Straight pieces of a point's way.
pub const STEPS: usize = 12;

/// Where a point is after each piece of its way, in head lengths.
pub type Way = [DVec3; STEPS];

/// The square of a bump's reach, in its widths: there (1 - 1 / 4.52)^4 is 1 / e at one width, as a Gaussian's.
const BUMP_REACH: f64 = 4.52;

/// A bell about 0 of width 1, for the square of the distance: as a Gaussian, but of basic operations only, so that it is
/// the same on every machine, and 0 beyond 2.13.
fn bump<N: Number>(square: N) -> N {
    if square.value() >= BUMP_REACH {
        return N::constant(0.0);
    }
    let rest = square * (-1.0 / BUMP_REACH) + 1.0;
    let squared = rest * rest;
    squared * squared
}

/// A bell in y.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Bell {
    pub centre: f64,
    /// 1 over its width.
    pub per_width: f64,
}

impl Bell {
    fn at<N: Number>(&self, y: N) -> N {
        let t = (y - self.centre) * self.per_width;
        bump(t * t)
    }
}

/// A window with a flat top: 1 within the inner radii, 0 outside of the outer ones, which differ by side. All are kept as 1 over
/// them.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Window {
    pub centre: DVec3,
    pub per_inner: DVec3,
    /// Towards lower coordinates.
    pub per_low: DVec3,
    /// Towards higher ones.
    pub per_high: DVec3,
}

impl Window {
    fn at<N: Number>(&self, p: [N; 3]) -> N {
        let mut inner = N::constant(0.0);
        let mut outer = N::constant(0.0);
        for (axis, &along) in p.iter().enumerate() {
            let from = along - self.centre[axis];
            let per_reach = if from.value() < 0.0 { self.per_low[axis] } else { self.per_high[axis] };
            let (i, o) = (from * self.per_inner[axis], from * per_reach);
            inner = inner + i * i;
            outer = outer + o * o;
            if outer.value() >= 1.0 {
                return N::constant(0.0);
            }
        }
        if inner.value() <= 1.0 {
            return N::constant(1.0);
        }
        // How far it is from the inner to the outer border, along the ray from the centre.
        let (inner, outer) = (inner.root(), outer.root());
        let way = outer * (inner - 1.0) * (inner - outer).recip();
        -step(way) + 1.0
    }
}

/// A soft ball about a centre towards which a feature shrinks.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Shrink {
    pub centre: DVec3,
    /// Per unit of time, the centre's y.
    pub sinks: f64,
    /// 1 over its radii towards lower and higher coordinates.
    pub per_low: DVec3,
    pub per_high: DVec3,
    /// ln of the scales.
    pub rates: DVec3,
}

/// How far from its rim a soft ball has its full weight: within a radius of 1 - 1 / 1.6.
const SOFT: f64 = 1.6;

impl Shrink {
    fn weight<N: Number>(&self, p: [N; 3], t: f64) -> (N, [N; 3]) {
        let from = [p[0] - self.centre.x, p[1] - (self.centre.y + self.sinks * t), p[2] - self.centre.z];
        let mut square = N::constant(0.0);
        for (axis, &along) in from.iter().enumerate() {
            let per_reach = if along.value() < 0.0 { self.per_low[axis] } else { self.per_high[axis] };
            let share = along * per_reach;
            square = square + share * share;
            if square.value() >= 1.0 {
                return (N::constant(0.0), from);
            }
        }
        (step((-square.root() + 1.0) * SOFT), from)
    }

    fn add<N: Number>(&self, p: [N; 3], t: f64, velocity: &mut [N; 3]) {
        let (weight, from) = self.weight(p, t);
        if weight.value() > 0.0 {
            for axis in 0..3 {
                velocity[axis] = velocity[axis] + weight * from[axis] * self.rates[axis];
            }
        }
    }
}

/// An eye's way: about a centre that moves evenly, by scales that grow evenly.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct EyeFlow {
    /// What it grows about, before and after.
    pub from: DVec3,
    pub to: DVec3,
    /// ln of the plateau's scales: width, height with what the lids open more, depth.
    pub rates: DVec3,
    /// ln of the eyeball's own scales.
    pub ball_rates: DVec3,
    /// How far the eyeball goes back behind its lids, so that it can turn.
    pub ball_back: f64,
    /// The plateau's radii before.
    pub inner: DVec3,
    /// What the lids open beyond the plateau, in a window of their own.
    pub lids: Option<Lids>,
    /// What its painted iris does.
    pub iris: Option<IrisFlow>,
}

/// Lids that open more than the eye grows.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Lids {
    /// The opening's middle before, from the eye's centre.
    pub middle: DVec3,
    /// Half its width and height before.
    pub half_width: f64,
    pub half_height: f64,
    /// ln of how much more they open.
    pub rate: f64,
    /// The ball's radius before: the lids stay on it.
    pub radius: f64,
}

/// Ears, as the right one would be on the left.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct EarFlow {
    /// How far aside they begin, before.
    pub root: f64,
    /// The middle of their box in y and z, and half its size.
    pub centre: DVec3,
    pub half: DVec3,
    /// Per unit of time, the middle's y.
    pub sinks: f64,
    /// ln of the scales.
    pub rates: DVec3,
}

/// The velocity field; all lengths in head lengths, rates per whole way.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Flow {
    pub(super) eyes: Option<[EyeFlow; 2]>,
    /// ln of the head's widening, and more of it at heights: (share of x, bell).
    pub(super) widening: f64,
    pub(super) widenings: Vec<(f64, Bell)>,
    /// Of the front, how far it moves at heights.
    pub(super) forward: Vec<(f64, Bell)>,
    /// The cheeks' apples: how far forward, their distance from the middle, the depth of their middle.
    pub(super) apples: Option<(f64, DVec3)>,
    /// The depth of the face's front.
    pub(super) front: f64,
    /// How far the face sinks at the eyes, and their height before.
    pub(super) sinks: f64,
    pub(super) eye_height: f64,
    pub(super) shrinks: Vec<Shrink>,
    /// The nose goes back: how far, in which window.
    pub(super) nose_back: Option<(f64, Shrink)>,
    /// The mouth's corners rise: by a middle's and a corner's share.
    pub(super) smile: Option<(f64, f64, Shrink)>,
    pub(super) ears: Option<EarFlow>,
    /// Brows that frown rise at their inner ends.
    pub(super) brows: Option<BrowFlow>,
}

/// How frowning brows rise.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct BrowFlow {
    /// How far their inner ends rise.
    pub rises: f64,
    /// Their line before and after: its height at the middle, and its slope aside.
    pub lines: [(f64, f64); 2],
    /// d, before and after.
    pub half_distances: [f64; 2],
    /// The height of the upper lids' edges, before and after: these stay.
    pub lids: [f64; 2],
}

/// The neck: nothing moves below the first height, all of the head above the second.
const NECK: (f64, f64) = (-0.14, 0.02);
/// The crown does not widen.
const CROWN: (f64, f64) = (1.05, 1.25);
/// What is this far behind the front is not the face's front at all, and this much nearer it is all.
const FRONT: (f64, f64) = (0.55, 0.45);
/// What is further from the middle is not the face's front.
const FRONT_WIDTH: f64 = 0.55;
/// The face sinks between these heights: below the chin's underside, and above the crown.
const SINKING: (f64, f64) = (-0.02, 1.02);
/// The cheeks' apples: how wide, high and deep.
const APPLE: DVec3 = DVec3::new(0.17, 0.13, 0.3);

/// The field at one time.
#[derive(Clone, Debug)]
struct Moment {
    time: f64,
    eyes: Option<[EyeMoment; 2]>,
    ear_root: f64,
}

#[derive(Clone, Debug)]
struct EyeMoment {
    window: Window,
    velocity: DVec3,
    rates: DVec3,
    lids: Option<(Window, Lids)>,
}

/// Outer radii of an eye's window, in inner ones, and what there is at least in head lengths: aside from the middle,
/// upwards, downwards at most, in depth.
const OUTER_ASIDE: f64 = 1.75;
const OUTER_UP: (f64, f64) = (1.9, 0.075);
const OUTER_DOWN: f64 = 0.10;
const OUTER_DEPTH: f64 = 2.2;
/// The same for lids: inner radii in half openings, the depth's in head lengths; outer ones.
const LIDS_INNER: DVec3 = DVec3::new(1.25, 1.15, 0.12);
const LIDS_OUTER: DVec3 = DVec3::new(2.1, 0.085, 0.30);
/// Nearer to a ball's edge than this part of its radius, lids do not follow it backwards any more.
const BALL_EDGE: f64 = 0.8;

impl EyeFlow {
    fn centre(&self, time: f64) -> DVec3 {
        self.from + time * (self.to - self.from)
    }

    fn at(&self, time: f64) -> EyeMoment {
        let centre = self.centre(time);
        let inner = self.inner * exp(time * self.rates);
        let inward = centre.x.abs();
        let aside = OUTER_ASIDE * inner.x;
        let up = (OUTER_UP.0 * inner.y).max(inner.y + OUTER_UP.1);
        let down = up.min(inner.y + OUTER_DOWN);
        let depth = OUTER_DEPTH * inner.z;
        let x = |is_low: bool| if (centre.x > 0.0) == is_low { inward } else { aside };
        let window = Window {
            centre,
            per_inner: inner.recip(),
            per_low: DVec3::new(x(true), down, depth).recip(),
            per_high: DVec3::new(x(false), up, depth).recip(),
        };
        let lids = self.lids.map(|lids| {
            let grown = exp(time * self.rates);
            let half_height = lids.half_height * grown.y * (time * lids.rate).exp();
            let half_width = lids.half_width * grown.x;
            let middle = centre + lids.middle * grown;
            let inner = LIDS_INNER * DVec3::new(half_width, half_height, 1.0);
            let up = half_height + LIDS_OUTER.y;
            let aside = LIDS_OUTER.x * half_width;
            let inward = middle.x.abs();
            let x = |is_low: bool| if (middle.x > 0.0) == is_low { inward } else { aside };
            let window = Window {
                centre: middle,
                per_inner: inner.recip(),
                per_low: DVec3::new(x(true), up, LIDS_OUTER.z).recip(),
                per_high: DVec3::new(x(false), up, LIDS_OUTER.z).recip(),
            };
            (window, Lids { radius: lids.radius * grown.x, ..lids })
        });
        EyeMoment { window, velocity: self.to - self.from, rates: self.rates, lids }
    }

    /// Where a point of the eyeball itself is at `time`: an exact scaling about the eye's centre.
    pub fn ball(&self, p: DVec3, time: f64) -> (DVec3, DMat3) {
        let scale = exp(time * self.ball_rates);
        let p = self.iris.map_or(p, |iris| DVec3::from_array(iris.map(p.to_array(), time)));
        let centre = self.centre(time) - DVec3::Z * (time * self.ball_back);
        (centre + scale * (p - self.from), DMat3::from_diagonal(scale))
    }
}

fn exp(rates: DVec3) -> DVec3 {
    DVec3::new(rates.x.exp(), rates.y.exp(), rates.z.exp())
}

impl EyeMoment {
    /// The eye's share of the velocity at `p`, and what it gives.
    fn add<N: Number>(&self, p: [N; 3], velocity: &mut [N; 3]) -> N {
        let weight = self.window.at(p);
        if weight.value() > 0.0 {
            for axis in 0..3 {
                let from = p[axis] - self.window.centre[axis];
                velocity[axis] = velocity[axis] + weight * (from * self.rates[axis] + self.velocity[axis]);
            }
        }
        if let Some((window, lids)) = &self.lids {
            let opens = window.at(p);
            if opens.value() > 0.0 {
                let up = p[1] - window.centre.y;
                let rise = opens * up * lids.rate;
                // Along the ball: z falls as its circle does.
                let edge = BALL_EDGE * lids.radius;
                let height = if up.distance().value() < edge { up } else { N::constant(edge) };
                let depth = (-(height * height) + lids.radius * lids.radius).root();
                velocity[1] = velocity[1] + rise;
                velocity[2] = velocity[2] - opens * up * rise * depth.recip();
            }
        }
        weight
    }
}

impl Flow {
    /// The same for hair: it stays where lids open and brows rise, or eyes would come through a fringe.
    pub fn of_hair(&self) -> Self {
        let mut flow = Self { brows: None, ..self.clone() };
        for eye in flow.eyes.iter_mut().flatten() {
            eye.lids = None;
        }
        flow
    }

    /// True where it moves nothing.
    pub fn is_identity(&self) -> bool {
        *self == Self::default()
    }

    fn at(&self, time: f64) -> Moment {
        let eyes = self.eyes.as_ref().map(|eyes| eyes.each_ref().map(|eye| eye.at(time)));
        let ear_root = self.ears.map_or(0.0, |ears| ears.root * (time * self.widening).exp());
        Moment { time, eyes, ear_root }
    }
}

/// A field ready to follow points along it.
#[derive(Clone, Debug)]
pub struct Follower {
    flow: Flow,
    /// At the start and in the middle of each piece of the way.
    moments: Vec<[Moment; 2]>,
}

impl Follower {
    /// Ready to follow `flow`.
    pub fn new(flow: Flow) -> Self {
        let time = |piece: usize| piece as f64 / STEPS as f64;
        let moments = (0..STEPS)
            .map(|piece| [flow.at(time(piece)), flow.at(time(piece) + 0.5 / STEPS as f64)])
            .collect();
        Self { flow, moments }
    }

    /// The field.
    pub fn flow(&self) -> &Flow {
        &self.flow
    }

    /// How much `p` takes part where lids open, 0 to 1.
    pub(super) fn opens_lids(&self, p: DVec3) -> f64 {
        let eyes = self.moments[0][0].eyes.iter().flatten();
        eyes.filter_map(|eye| eye.lids).map(|(window, _)| window.at(p.to_array())).fold(0.0, f64::max)
    }

    /// The way of `p`.
    pub fn way(&self, p: DVec3) -> Way {
        let mut place = p.to_array();
        std::array::from_fn(|piece| {
            place = self.piece(place, piece, 1.0);
            DVec3::from_array(place)
        })
    }

    /// Where `p` is after the share `youth` of its way.
    pub fn place(&self, p: DVec3, youth: f64) -> DVec3 {
        DVec3::from_array(self.follow(p.to_array(), youth))
    }

    /// As [`Follower::place`], with the Jacobian.
    pub fn map(&self, p: DVec3, youth: f64) -> (DVec3, DMat3) {
        Dual::split(self.follow(Dual::point(p), youth))
    }

    fn follow<N: Number>(&self, mut place: [N; 3], youth: f64) -> [N; 3] {
        let (whole, rest) = pieces(youth);
        for piece in 0..whole {
            place = self.piece(place, piece, 1.0);
        }
        if rest > 0.0 { self.piece(place, whole, rest) } else { place }
    }

    fn piece<N: Number>(&self, p: [N; 3], piece: usize, share: f64) -> [N; 3] {
        let [start, middle] = &self.moments[piece];
        const STEP: f64 = 1.0 / STEPS as f64;
        let first = self.flow.velocity(start, p);
        let half = [0, 1, 2].map(|axis| p[axis] + first[axis] * (0.5 * STEP));
        let velocity = self.flow.velocity(middle, half);
        [0, 1, 2].map(|axis| p[axis] + velocity[axis] * (share * STEP))
    }

    /// The field's velocity and slope at the start of a piece.
    pub fn slope(&self, p: DVec3, piece: usize) -> DMat3 {
        Dual::split(self.flow.velocity(&self.moments[piece][0], Dual::point(p))).1
    }
}

/// Whole pieces of the way, and what part of the next one.
fn pieces(youth: f64) -> (usize, f64) {
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

impl Flow {
    fn velocity<N: Number>(&self, moment: &Moment, p: [N; 3]) -> [N; 3] {
        let flow = self;
        let mut of_eyes = [N::constant(0.0); 3];
        let mut rest = N::constant(1.0);
        if let Some([left, right]) = &moment.eyes {
            // Neither reaches over the middle.
            let eye = if p[0].value() > 0.0 { left } else { right };
            rest = rest - eye.add(p, &mut of_eyes);
        }
        if rest.value() <= 0.0 || p[1].value() <= NECK.0 {
            return of_eyes;
        }
        let [x, y, z] = p;
        let neck = step((y - NECK.0) * (1.0 / (NECK.1 - NECK.0)));
        let mut v = [N::constant(0.0); 3];

        let mut widening = step((-y + CROWN.1) * (1.0 / (CROWN.1 - CROWN.0))) * flow.widening;
        for (share, bell) in &flow.widenings {
            widening = widening + bell.at(y) * *share;
        }
        v[0] = x * neck * widening;

        if flow.sinks != 0.0 {
            let end = if y.value() > flow.eye_height { SINKING.1 } else { SINKING.0 };
            let t = (y - flow.eye_height) * (1.0 / (end - flow.eye_height));
            let inside = -(t * t) + 1.0;
            if inside.value() > 0.0 {
                v[1] = v[1] - inside * inside * flow.sinks;
            }
        }

        let aside = x * (1.0 / FRONT_WIDTH);
        let inside = -(aside * aside) + 1.0;
        if inside.value() > 0.0 {
            let front = step((z - (flow.front - FRONT.0)) * (1.0 / FRONT.1)) * neck * inside;
            for (forward, bell) in &flow.forward {
                v[2] = v[2] + front * bell.at(y) * *forward;
            }
        }
        if let Some((forward, centre)) = &flow.apples {
            let from = [x.distance() - centre.x, y - centre.y, z - centre.z];
            let mut square = N::constant(0.0);
            for axis in 0..3 {
                let share = from[axis] * (1.0 / APPLE[axis]);
                square = square + share * share;
            }
            v[2] = v[2] + bump(square) * neck * *forward;
        }
        for shrink in &flow.shrinks {
            shrink.add(p, moment.time, &mut v);
        }
        if let Some((back, window)) = &flow.nose_back {
            v[2] = v[2] - window.weight(p, moment.time).0 * *back;
        }
        if let Some((middle, corner, window)) = &flow.smile {
            let (weight, from) = window.weight(p, moment.time);
            if weight.value() > 0.0 {
                let aside = from[0] * (1.0 / CORNER);
                let square = aside * aside;
                let rise = if square.value() < CORNER_MOST { square } else { N::constant(CORNER_MOST) };
                v[1] = v[1] + weight * (rise * *corner + *middle);
            }
        }
        self.move_ears(moment, p, &mut v);
        self.move_brows(moment.time, p, neck, &mut of_eyes);
        [0, 1, 2].map(|axis| of_eyes[axis] + rest * v[axis])
    }

    /// The whole brow takes part, and less and less above it; the lids below it do not.
    fn move_brows<N: Number>(&self, time: f64, [x, y, z]: [N; 3], neck: N, v: &mut [N; 3]) {
        let Some(brows) = &self.brows else { return };
        let between = |[before, after]: [f64; 2]| before + time * (after - before);
        let aside = x.distance() * (1.0 / (BROW_REACH * between(brows.half_distances)));
        if aside.value() >= 1.0 {
            return;
        }
        let [before, after] = brows.lines;
        let line = x.distance() * between([before.1, after.1]) + between([before.0, after.0]);
        let lids = between(brows.lids);
        let gap = line - lids;
        let reach = if gap.value() > LEAST_BELOW { gap } else { N::constant(LEAST_BELOW) };
        let rises = step((y - lids) * reach.recip() * SOFT);
        let fades = rises * step((y - line) * (-1.0 / BROW_FADES) + 1.25);
        if fades.value() <= 0.0 {
            return;
        }
        let front = step((z - (self.front - FRONT.0)) * (1.0 / FRONT.1)) * neck;
        v[1] = v[1] + front * fades * (-aside + 1.0) * (brows.rises / BROW_INNER);
    }

    fn move_ears<N: Number>(&self, moment: &Moment, p: [N; 3], v: &mut [N; 3]) {
        let Some(ears) = &self.ears else { return };
        let over = p[0].distance() - moment.ear_root;
        let (y, z) = (p[1] - (ears.centre.y + ears.sinks * moment.time), p[2] - ears.centre.z);
        let within = |from: N, half: f64| step(from.distance() * (-EAR_RIM / half) + EAR_SOFT);
        let weight =
            step((over + EAR_ROOT.0) * (1.0 / EAR_ROOT.1)) * within(y, ears.half.y) * within(z, ears.half.z);
        if weight.value() <= 0.0 {
            return;
        }
        let outwards = if p[0].value() < 0.0 { -1.0 } else { 1.0 };
        if over.value() > 0.0 {
            v[0] = v[0] + weight * over * (outwards * ears.rates.x);
        }
        v[1] = v[1] + weight * y * ears.rates.y;
        v[2] = v[2] + weight * z * ears.rates.z;
    }
}

/// How far aside brows rise, in half distances of the eyes, and what is left of it at their inner ends (at 0.5).
const BROW_REACH: f64 = 1.6;
const BROW_INNER: f64 = 1.0 - 0.5 / BROW_REACH;
/// The rise of brows fades towards the lids within at least this.
const LEAST_BELOW: f64 = 0.05;
/// Above the brows the rise fades within this.
const BROW_FADES: f64 = 0.16;
/// A mouth's corner, from the middle; beyond so many squares of that it rises no more.
const CORNER: f64 = 0.13;
const CORNER_MOST: f64 = 1.2;
/// An ear begins this far below its root, within so much.
const EAR_ROOT: (f64, f64) = (0.02, 0.035);
/// Within its box an ear has its full weight, and none beyond 1.83 of it.
const EAR_SOFT: f64 = 2.2;
const EAR_RIM: f64 = 1.2;
